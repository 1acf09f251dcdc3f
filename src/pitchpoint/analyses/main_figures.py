"""Main figures of the parts of a result as JSON has them."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.summaries import AT_CONTACT
from pitchpoint.core.doubts import in_percent
from pitchpoint.results.store import without_nan

__all__ = [
    "CAMPBELL",
    "CONTACT",
    "ERRORS",
    "HOLDING",
    "HOLDING_BANDS",
    "MAIN",
    "OF_COURSE",
    "OF_CROSSING",
    "OF_LAWS",
    "OF_MOTION",
    "OF_START",
    "RATING",
    "REACTIONS",
    "STAGES",
    "TEMPERATURES",
    "VIBRATION",
    "WIND_UP",
    "bearing_loads_by_name",
    "by_law",
    "by_torque",
    "coverage_sentences",
    "efficiency_coverage",
    "error_ranges",
    "error_words",
    "held_at_operation",
    "json_figures",
    "laws_hold",
    "main_figures",
    "numbers",
    "of_contact",
    "of_operation",
    "out_of_range",
    "point_by_valid_laws",
    "standstill_figures",
    "why_not",
]

Parts = Mapping[str, xr.Dataset]

MAIN = (
    "mean_efficiency",
    "min_efficiency",
    "max_efficiency",
    "mean_loss",
    "mean_input_torque",
    "torque_ripple",
    "mean_friction",
)

CONTACT = (*AT_CONTACT, "mean_friction", "mean_loss", "mean_input_torque")
"""Main figures of a test rig, which transmits nothing."""


def of_contact(data: Any) -> bool:
    """True for an operating point or a study of a test rig, whose figures are those of its contact."""
    return AT_CONTACT[0] in data


def main_figures(data: Any) -> tuple[str, ...]:
    """Names of the figures that are shown first of an operating point, or of a study."""
    return CONTACT if of_contact(data) else tuple(name for name in MAIN if name in data)


def json_figures(data: Any) -> tuple[str, ...]:
    """The same, film ratio and range of the laws, and those of each stage of a drive."""
    return (*main_figures(data), *(name for name in (*OF_LAWS, *STAGES) if name in data))


OF_COURSE = (
    "mean_transmission_error",
    "transmission_error_rms",
    "transmission_error_range",
    "largest_mesh_force",
    "smallest_mesh_force",
    "largest_bearing_force",
)
"""Figures of the course of a steady motion with friction."""

OF_MOTION = (
    "mean_efficiency",
    "quasi_static_efficiency",
    "efficiency_difference",
    *OF_COURSE,
    "natural_frequency",
    "modal_damping_ratio",
    "mesh_frequency",
    "energy_closure",
)
"""Main figures of a motion with friction."""

OF_START = ("largest_mesh_force", "largest_bearing_force", "energy_closure")
"""Main figures of a start."""

OF_CROSSING = ("critical_speed", "critical_order", "half_power_width")
"""Figures of every order that crosses a natural frequency."""

CAMPBELL = 8
"""Orders of the mesh frequency whose crossings count as critical speeds."""

VIBRATION = (
    "mean_stiffness",
    "stiffness_variation",
    "mean_transmission_error",
    "transmission_error_range",
    "largest_dynamic_factor",
    "natural_frequency",
    "mesh_frequency",
)


TEMPERATURES = tuple(
    f"{name}_{gear}"
    for gear in (1, 2)
    for name in ("flank_temperature", "root_temperature", "young")
)

RATING = (
    "largest_contact_stress",
    "largest_root_stress",
    "least_flank_safety",
    "least_root_safety",
)
"""Largest stresses and least safeties of all gears that are rated."""

REACTIONS = tuple(f"{way}_reaction_{gear}" for gear in (1, 2) for way in ("radial", "axial"))

OF_LAWS = ("min_lambda_ratio", "lowest_efficiency_in_range", "highest_efficiency_in_range")
"""Smallest film ratio of a cycle, and what friction laws that hold make of its efficiency."""

STAGES = (
    "stage_loss",
    "stage_drag_loss",
    "stage_efficiency",
    "stage_friction",
    "stage_input_torque",
    "stage_speed",
    "stage_latent_power",
)
"""Figures of each stage of a drive."""

WIND_UP = ("wind_up", "angular_transmission_error_range", "torsional_stiffness", "loaded_pairs")


def numbers(values: Any) -> Any:
    """Values as JSON has them, None for NaN; one alone without a list."""
    listed = np.atleast_1d(values).tolist()
    plain = [None if isinstance(v, float) and np.isnan(v) else v for v in listed]
    return plain if len(plain) > 1 else plain[0]


def by_law(data: xr.Dataset, names: Sequence[str]) -> dict[str, Any]:
    """Figures under each law, with those of vibration, temperature and strength, and the axis of a sweep."""
    every = [name for name in (*names, *VIBRATION, *TEMPERATURES, *RATING) if name in data]
    result: dict[str, Any] = {
        str(law): {name: numbers(data[name].values[position]) for name in every}
        for position, law in enumerate(data["law"].values)
    }
    if "axis" in data:
        result["axis"] = {
            "key": data.attrs["sweep_key"],
            "unit": data["axis"].attrs.get("units", ""),
            "values": numbers(data["axis"].values),
        }
    return result


def by_torque(data: xr.Dataset | None, names: Sequence[str]) -> dict[str, Any]:
    """Figures over torque; none of a part that does not exist."""
    if data is None:
        return {}
    return {n: numbers(data[n].values) for n in ("torque", *names) if n in data}


def of_operation(parts: Parts) -> dict[str, Any]:
    """Figures of the operating point."""
    data = parts["operation"]
    return {
        "headline": by_law(point_by_valid_laws(parts), main_figures(data)[:1]),
        "operation": by_law(data, json_figures(data)),
        "efficiency_of": efficiency_coverage(data),
        "reactions": by_law(data, REACTIONS),
        "bearing_load": {
            str(law): dict(bearing_loads_by_name(data, k))
            for k, law in enumerate(data["law"].values)
        },
        **_lives(data),
    }


def efficiency_coverage(data: xr.Dataset) -> str:
    """What the efficiency is of, where that is less than the whole drive; empty without efficiencies."""
    return str(data["mean_efficiency"].attrs.get("covers", "")) if "mean_efficiency" in data else ""


def coverage_sentences(every: Iterable[Parts]) -> str:
    """The same as sentences for some results, each once; empty where whole drives are meant."""
    scopes = dict.fromkeys(
        efficiency_coverage(parts["operation"]) for parts in every if "operation" in parts
    )
    return " ".join(f"Efficiencies are those of the {of}." for of in scopes if of)


def out_of_range(laws: xr.Dataset) -> list[dict[str, Any]]:
    """Laws of the library that do not hold at the operating point, with their efficiency and the reasons."""
    outside: list[dict[str, Any]] = json.loads(laws.attrs.get("outside", "[]"))
    return outside


def why_not(parts: Parts) -> dict[str, list[str]]:
    """Laws that do not hold at the operating point, and the reasons; none where that is not known."""
    outside = out_of_range(parts["laws"]) if "laws" in parts else []
    return {str(law["law"]): law["reasons"] for law in outside}


def laws_hold(parts: Parts) -> list[bool]:
    """For each friction law of a case whether it holds at the operating point."""
    outside = why_not(parts)
    return [str(law) not in outside for law in parts["operation"]["law"].values]


def point_by_valid_laws(parts: Parts) -> xr.Dataset:
    """The operating point by the laws of the case that hold there; by those of the library where none does.

    Where no law holds at all, those of the case are all there is.
    """
    data, holds = parts["operation"], laws_hold(parts)
    if any(holds):
        return data.isel(law=np.flatnonzero(holds))
    others = parts.get("laws")
    return data if others is None or not others.sizes["law"] else others


def bearing_loads_by_name(data: Any, law: int) -> list[tuple[str, float]]:
    """Bearings by name and what they bear [N]."""
    if "bearing_load" not in data:
        return []
    loads = data["bearing_load"].values[:, 0]
    bears = loads.any(axis=0)
    return [(str(place), loads[law, k]) for k, place in enumerate(data["place"].values) if bears[k]]


def _lives(data: xr.Dataset) -> dict[str, Any]:
    """Lives of bearings by law and name [s]; nothing where none is rated."""
    if "bearing_life" not in data:
        return {}
    names = [str(place) for place in data["place"].values]
    rows = zip(data["law"].values, data["bearing_life"].values[:, 0], strict=True)
    lives = {
        str(law): {n: float(life) for n, life in zip(names, row, strict=True) if not np.isnan(life)}
        for law, row in rows
    }
    return {"bearing_life": without_nan(lives)}


def error_ranges(data: xr.Dataset | None) -> Iterator[tuple[str, list[str], Any]]:
    """Name of each curve of the kinematic error, and its peak to peak by what causes it."""
    if data is None:
        return
    causes = [str(cause) for cause in data["cause"].values]
    for curve, values in zip(
        data["curve"].values, data["kinematic_error_range"].values, strict=True
    ):
        yield str(curve), causes, values


HOLDING = (
    "least_holding_torque",
    "largest_holding_torque",
    "moving_back_torque",
    "moving_on_torque",
)
"""Torques of the driver that hold a load, and those beyond which it moves at every phase."""

HOLDING_BANDS = {
    name: (f"{name}_low", f"{name}_high")
    for name in ("least_holding_torque", "largest_holding_torque")
}
"""Ends of the bands of the two that hold, where a loss says how uncertain it is at rest."""

ERRORS = ("interpolation_error", "light_load_error", "creeping_error")
"""Largest errors: between loads and speeds of the map, below its least load, below its lowest speed."""


def error_words(data: xr.Dataset, law: int, words: Callable[[str, float], str]) -> str:
    """How near the map comes to direct computation under one law, in words.

    Args:
        data: the map.
        law: place of the law.
        words: a load or speed of the map by its name, value [SI] to text.
    """
    names = (*ERRORS, "mean_interpolation_error")
    most, light, creeping, mean = (f"{in_percent(float(data[name][law]))}" for name in names)
    torque, speed = (
        words(name, float(values[values > 0.0].min()))
        for name in ("output_torque", "output_speed")
        for values in [data[name].values]
    )
    return (
        f"{data['law'].values[law]} {most} at most and {mean} in the mean half way between nodes, {light} at "
        f"torques below {torque}, {creeping} at a tenth of {speed}, the lowest speed of the output"
    )


def held_at_operation(data: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Torques of the driver that hold the load of the operating point at rest, by law; None where not known.

    Args:
        data: the map, between whose nodes of load and temperature they are linear.
    """
    load, degree = data.attrs["load"], data.attrs["degree"]
    names = [*HOLDING, *(n for ends in HOLDING_BANDS.values() for n in ends if n in data)]
    there = data[[*names, "self_locking"]].astype(float).interp(output_torque=load)
    if data.sizes["temperature"] > 1:
        ends = data["temperature"].values[[0, -1]]
        there = there.interp(temperature=np.clip(degree, *ends))
    else:
        there = there.isel(temperature=0)
    locked = there["self_locking"] > 0.0
    return {
        law: {
            **{n: without_nan(float(there[n].sel(law=law))) for n in names},
            "self_locking": bool(locked.sel(law=law)),
        }
        for law in data["law"].values.tolist()
    }


def duty_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Energies, torques and lives over the duty cycle, and which part fails first.

    Args:
        parts: of a result.
    """
    data = parts.get("duty")
    if data is None:
        return {}
    numbers = {str(n): without_nan(float(data[n])) for n in data if data[n].ndim == 0}
    return {"duty": {**numbers, **{n: data.attrs[n] for n in ("first_to_fail", "left_out")}}}


def standstill_figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Torques that hold the load of the operating point at rest, and how near the map is, by law.

    Args:
        parts: of a result.
    """
    data = parts.get("four_quadrants")
    if data is None or HOLDING[0] not in data:
        return {}
    errors = (*ERRORS, "mean_interpolation_error")
    return {
        "four_quadrants": {
            law: held | {name: float(data[name][k]) for name in errors}
            for k, (law, held) in enumerate(held_at_operation(data).items())
        }
    }
