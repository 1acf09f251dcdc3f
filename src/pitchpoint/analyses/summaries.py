"""Figures of operating points, under each of some friction laws."""

import json
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import PieceProgress, silent
from pitchpoint.analyses.caveats import (
    demand_agreement,
    demand_convergence,
    demand_motion,
    faces_warning,
    films_lost,
    why_not_at,
)
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Acting, Ready
from pitchpoint.core.doubts import GUESSED, WITHHELD, Doubt, doubts_of, stored
from pitchpoint.core.status import locked_or_lost, solve_summary, withheld
from pitchpoint.efficiency.profile import FINE, profile
from pitchpoint.efficiency.quasi_static import Models
from pitchpoint.efficiency.rows import NODES
from pitchpoint.efficiency.summary import groups_alike, joined_parts, summarise
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has
from pitchpoint.gears.pairs import touching
from pitchpoint.lubrication.lubrication_registry import FrictionLaw
from pitchpoint.results.rounding import difference
from pitchpoint.results.store import dataset

__all__ = [
    "AT_CONTACT",
    "at_contact",
    "balance_codes",
    "figures_beside_cycle",
    "first_warnings",
    "joined_points",
    "profiles",
    "single_meshes",
    "summaries",
    "tooth_temperatures",
    "vibrations",
]


AT_CONTACT = ("film_thickness", "lambda_ratio", "pressure", "entrainment", "sliding_velocity")
"""Figures of a test rig, whose contact stays as it is."""

OF_STAGE_DRIVERS = ("stage_input_torque", "stage_speed")
"""Figures of the drivers of stages, which have one unit only where all of these turn."""

_SHOWN = 3

_ENDS = ("lowest_", "highest_")
"""What names begin with of values that decide whether laws hold."""

_WITH_FRICTION = {
    "largest_contact_force_ratio",
    "min_lambda_ratio",
    "latent_power",
    "stage_latent_power",
} | {
    f"{kind}_{name}{ending}"
    for kind in ("mean", "min", "max")
    for name in ("loss", "efficiency", "input_torque", "friction")
    for ending in ("", "_path")
}
"""Figures that are undefined where friction locks the mesh."""


def _dims(name: str, values: np.ndarray) -> tuple[str, ...]:
    """Dimensions of a figure; the last one of three is that of the places, or of the stages."""
    axis = "place" if name == "bearing_load" else "stage"
    return ("law", "point", axis)[: values.ndim]


def single_meshes(points: Sequence[Ready]) -> list[Built]:
    """Points of one mesh; none where they are drives of stages."""
    return [mesh for point in points if not point.numbers for mesh in point.meshes]


def summaries(
    points: Sequence[Ready],
    under: Sequence[Models | Acting],
    extra: Mapping[str, Any],
    progress: PieceProgress = silent,
    *,
    title: str,
    may_lock: bool = False,
    several: bool = False,
) -> xr.Dataset:
    """Figures of points under several laws; among several, or with `may_lock`, locked ones are NaN.

    With `several`, which points of a study have even if there is one alone, they tell the range of the laws
    that hold at each of them, and why others do not.
    """
    names = [models.law.name for models in under]
    travels = points[0].travels
    runs = [_grouped(points, models, progress) for models in under]
    turns = _turns(runs)
    unsure = [run.pop("outside_films", np.full(run["locked"].shape, "")) for run in runs]
    lost = films_lost(turns["turns_code"])
    out = {name: np.array([run[name] for run in runs]) for name in runs[0]}
    carrying, slices = (out.pop(name, None) for name in ("carrying_slices", "slices"))
    extremes = {name: out.pop(name) for name in [*out] if name.startswith(_ENDS)}
    if points[0].transmits and "lowest_lambda_ratio" in extremes:
        out["min_lambda_ratio"] = extremes["lowest_lambda_ratio"]
    if not may_lock and len(points) == 1:
        demand_agreement(turns["turns_code"], points, names)
        ends = (out["nearest_friction"], out["nearest_jamming_coefficient"])
        demand_motion(out["locked"], *ends, points, names)
    for name, values in out.items():
        if values.dtype.kind == "f" and name in _WITH_FRICTION:
            values[out["locked"]] = np.nan
    residual = np.where(out["locked"] | lost, 0.0, out["residual"])
    demand_convergence(residual, points, names)
    if points[0].case.models.averaging == "path":
        for name in ("mean_loss", "mean_efficiency", "mean_input_torque"):
            out[name] = out[f"{name}_path"]
    out = {name: values for name, values in out.items() if not name.endswith("_path")}
    if "driver" in travels:
        out = {name: values for name, values in out.items() if name not in OF_STAGE_DRIVERS}
    out["efficiency_fluctuation"] = difference(out["max_efficiency"], out["min_efficiency"])
    out["torque_ripple"] = difference(out["max_input_torque"], out["min_input_torque"])
    laws = [models.law for models in under]
    reasons = _why_not(laws, points, extremes, unsure) if extremes else None
    if reasons is not None and several and len(under) > 1:
        out |= _of_laws_in_range(out["mean_efficiency"], reasons == "")
    if "loss_factor" in out and touching(points[0].meshes[0].design.mesh):
        out["loss_factor_efficiency"] = 1.0 - out["mean_friction"] * out["loss_factor"]
    else:
        out.pop("loss_factor", None)  # of the shares of one load: no figure of the gears alone
    sentences = dict.fromkeys(text for point in points for text in point.warnings)
    warnings = first_warnings([*sentences]) if len(points) > 1 else [*sentences]
    if "vibration_status" in extra:
        from pitchpoint.analyses.vibration import status_sentences

        warnings += status_sentences(extra["vibration_status"][1][0])
    if carrying is not None and slices is not None:
        carried = np.where(out["locked"], np.nan, carrying)
        warnings += faces_warning(single_meshes(points), carried, slices[0])
    for models, code in zip(under, turns["turns_code"], strict=True):
        warnings += _lost_warning(models.law, code)
    if reasons is not None and len(points) > 1:
        warnings += _range_warnings(names, reasons)
    if not may_lock:
        for models, locked in zip(under, out["locked"], strict=True):
            warnings += _lock_warning(models.law, locked)
    if any(models.law.films is not None for models in under):
        out |= {name: turns[name] for name in ("turns", "turns_change")}
    data = dataset(
        {
            **{name: (_dims(name, values), values) for name, values in out.items()},
            **(
                {}
                if reasons is None or not several
                else {"out_of_range": (("law", "point"), reasons)}
            ),
            **extra,
        },
        {"law": names, **_labels(points[0])},
        title=title,
        warnings=warnings,
        solve=_balances(out),
        travels=travels,
        **_warming(points),
    )
    data["mean_efficiency"].attrs.update(points[0].covers)
    if not points[0].transmits:
        data["mean_efficiency"].attrs["note"] = "undefined (NaN): no power goes through a test rig"
    return data


def _why_not(
    laws: Sequence[FrictionLaw],
    points: Sequence[Ready],
    extremes: Mapping[str, np.ndarray],
    unsure: Sequence[np.ndarray],
) -> np.ndarray:
    """Why a law does not hold [law, point], in words; empty where it does.

    Args:
        laws: of friction.
        points: of one mesh.
        extremes: see `why_not_at`, each [law, point].
        unsure: of each law what there is to be wary of about the films that it solves [point].
    """
    reasons = [
        [
            "; ".join(
                [
                    *filter(None, [str(unsure[k][at])]),
                    *why_not_at(
                        point, law, {name: values[k, at] for name, values in extremes.items()}
                    ),
                ]
            )
            for at, point in enumerate(single_meshes(points))
        ]
        for k, law in enumerate(laws)
    ]
    return np.array(reasons, dtype=str)


def _of_laws_in_range(efficiency: np.ndarray, holds: np.ndarray) -> dict[str, np.ndarray]:
    """Ends of the mean efficiency [law, point] by the laws that hold, the same under each; NaN by none."""
    in_range = np.where(holds & ~np.isnan(efficiency), efficiency, np.nan)
    lowest, highest = (
        np.broadcast_to(end(in_range, axis=0), in_range.shape) for end in (_fmin, _fmax)
    )
    return {"lowest_efficiency_in_range": lowest, "highest_efficiency_in_range": highest}


_fmin, _fmax = np.fmin.reduce, np.fmax.reduce


def _range_warnings(laws: Sequence[str], reasons: np.ndarray) -> Iterator[Doubt]:
    """How many points are out of the range of a law, and why the first one is."""
    for law, why in zip(laws, reasons, strict=True):
        outside = why[why != ""]
        if outside.size:
            beyond = f"{law}: out of its range at {outside.size} of {why.size} points"
            part = outside.size / why.size
            yield Doubt(f"{beyond}; {outside[0]}.", moves=GUESSED * part, brief=f"{beyond}.")


def _turns(runs: Sequence[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """What became of the turns of films and forces [law, point], taken out; formulas have none."""
    none = np.zeros(runs[0]["locked"].shape)
    return {
        name: np.stack([run.pop(name, none) for run in runs])
        for name in ("turns_code", "turns_change", "turns")
    }


def _warming(points: Sequence[Ready]) -> dict[str, Any]:
    """What became of the balances of heat, modulus and friction; nothing where no teeth warm up."""
    warmings = [point.warming for point in single_meshes(points)]
    balances = [
        (warming.code, warming.residual, warming.iterations)
        for warming in warmings
        if warming is not None
    ]
    return (
        {"warming": solve_summary(*map(np.array, zip(*balances, strict=True)))} if balances else {}
    )


def _balances(values: Mapping[str, Any]) -> dict[str, Any]:
    """What became of the balances behind the figures [law, point]."""
    arrays = (np.asarray(values[name]) for name in ("locked", "residual", "iterations"))
    locked, residual, iterations = arrays
    lost = np.isnan(residual)
    return solve_summary(locked_or_lost(locked.astype(bool), lost), residual, iterations)


def balance_codes(data: xr.Dataset) -> np.ndarray:
    """How the balances of designs ended, see `Code`, those left out that were never tried."""
    tried = ~np.isnan(data["iterations"].values)
    lost = np.isnan(data["residual"].values)
    codes = locked_or_lost(data["locked"].values.astype(bool), lost)
    return np.asarray(codes[tried])


def _labels(built: Ready) -> dict[str, Any]:
    """Places beside the teeth where power is lost, where there are some, and numbers of stages."""
    places = {"place": built.places} if built.places else {}
    stages = {"stage": [*built.numbers]} if built.numbers else {}
    return {**places, **stages}


def joined_points(pieces: Sequence[xr.Dataset]) -> xr.Dataset:
    """Pieces of a sweep as one; their warnings too."""
    if len(pieces) == 1:
        return pieces[0]
    data = xr.concat(pieces, "point", combine_attrs="override")
    sentences = dict.fromkeys(text for piece in pieces for text in doubts_of(piece.attrs))
    data.attrs.update(stored(first_warnings([*sentences])))
    data.attrs["solve"] = json.dumps(
        _balances({str(name): values for name, values in data.items()})
    )
    return data


def first_warnings(sentences: list[str]) -> list[str]:
    """The first warnings of a sweep, and how many more there are."""
    left_out = len(sentences) - _SHOWN
    notice = (
        [f"... and {left_out} more warnings of this kind in the sweep."] if left_out > 0 else []
    )
    return sentences[:_SHOWN] + notice


def _lock_warning(law: FrictionLaw, locked: np.ndarray) -> list[str]:
    if not locked.any():
        return []
    sentence = f"{law.title}: friction locks the mesh at {locked.sum()} of {locked.size} points."
    brief = f"{law.name}: locks at {locked.sum()} of {locked.size} points."
    return [Doubt(sentence, moves=WITHHELD, brief=brief)]


def _lost_warning(law: FrictionLaw, code: np.ndarray) -> list[Doubt]:
    return withheld(
        code[films_lost(code)],
        lambda count, why: (
            f"{law.title}: at {count} of {code.size} points {why}; their figures are withheld.",
            f"{law.name}: no result at {count} of {code.size} points.",
        ),
    )


def _grouped(
    points: Sequence[Ready], models: Models | Acting, progress: PieceProgress
) -> dict[str, np.ndarray]:
    """Summaries in order, points of equal static structure computed together."""
    if models.law.films is not None:
        return _by_films(single_meshes(points), models.law.name, progress)

    def of(group: Sequence[int]) -> dict[str, np.ndarray]:
        kind: Any = points[group[0]]
        states = [(points[k].design, points[k].operation) for k in group]
        figures: dict[str, np.ndarray] = kind.figures_of(states, models, progress)
        return figures

    groups = groups_alike([_design(point) for point in points])
    return joined_parts([*map(of, groups)], groups)


def _design(point: Ready) -> Any:
    return point.design


def _by_films(points: Sequence[Built], law: str, progress: PieceProgress) -> dict[str, np.ndarray]:
    """Summaries of points whose films are solved, each by the choices of its own case."""
    runs = []
    for done, point in enumerate(points, 1):
        (models,) = (candidate for candidate in point.models if candidate.law.name == law)
        runs.append(summarise([(point.design, point.operation)], models))
        progress(done)
    return {name: np.concatenate([run[name] for run in runs]) for name in runs[0]}


def profiles(
    built: Built, under: Sequence[Models], progress: PieceProgress | None = None
) -> list[dict[str, np.ndarray]]:
    """The mesh cycle under each of some models; where films are solved, at the nodes of all other figures."""
    point, engaged, asperities = (built.design, built.operation), built.engaged, built.asperities
    solved = any(models.law.films is not None for models in (*built.models, *under))
    nodes = NODES if solved else FINE
    return [
        profile(*point, models, built.film, nodes, engaged, asperities, progress)
        for models in under
    ]


def figures_beside_cycle(points: Sequence[Ready]) -> dict[str, Any]:
    """Figures of points beside those of their cycle: vibration, temperatures, the contact of a rig."""
    meshes = single_meshes(points)
    if not meshes:
        return {}
    under = meshes[0].models
    return {
        **vibrations(meshes, len(under)),
        **tooth_temperatures(meshes, len(under)),
        **at_contact(meshes, under),
    }


def at_contact(points: Sequence[Built], under: Sequence[Models]) -> dict[str, Any]:
    """Pressure, film and speeds at the one contact of a rig, which transmits nothing."""
    if points[0].transmits:
        return {}
    runs = [profiles(point, under) for point in points]
    return {
        name: (
            ("law", "point"),
            np.array([[run[name][0, 0, 0] for run in of_laws] for of_laws in runs]).T,
        )
        for name in AT_CONTACT
    }


def tooth_temperatures(points: Sequence[Built], laws: int) -> dict[str, Any]:
    """Temperatures and moduli of the teeth where a model says that they warm up."""
    if points[0].case.models.tooth_temperature == "isothermal":
        return {}
    values: dict[str, list[float]] = {}
    for point in points:
        for gear, used in enumerate(point.solids, 1):
            flank = used.temperature if used.flank is None else used.flank
            values.setdefault(f"flank_temperature_{gear}", []).append(flank)
            values.setdefault(f"root_temperature_{gear}", []).append(used.temperature)
            values.setdefault(f"young_{gear}", []).append(float(used.solid.young))
    return {
        name: (("law", "point"), np.array([by_point] * laws)) for name, by_point in values.items()
    }


def vibrations(points: Sequence[Built], laws: int) -> dict[str, Any]:
    """Figures of stiffness and vibration, the same under every friction law."""
    if points[0].case.dynamics is None or not has(points[0].design.mesh, line_of_action):
        return {}
    from pitchpoint.analyses.vibration import figures_of

    groups = groups_alike([_design(point) for point in points])
    figures = joined_parts([figures_of([points[k] for k in group]) for group in groups], groups)
    return {name: (("law", "point"), np.stack([values] * laws)) for name, values in figures.items()}
