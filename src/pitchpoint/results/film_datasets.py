"""Solved films as labelled datasets, and back from them as a start for the next ones."""

import json
from collections.abc import Iterator, Sequence
from typing import Any, Final

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import doubts_of
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.fields import LineFilm
from pitchpoint.lubrication.ehl.heat import Temperatures
from pitchpoint.lubrication.ehl.patch.fields import END_DISTANCES, FIELDS, VECTORS, PatchFilm
from pitchpoint.lubrication.ehl.patch.heat import TEMPERATURES
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms
from pitchpoint.lubrication.ehl.patch.transient import PatchMoment
from pitchpoint.lubrication.ehl.solve import Ended, Films
from pitchpoint.results.store import dataset, describe_variables
from pitchpoint.results.variable import (
    Variable,
    deviation,
    dimensionless,
    length,
    percent,
    pressure,
    time,
)

__all__ = ["film_dataset", "films_of_dataset", "march_dataset", "patch_dataset"]


def _on_line(long_name: str, symbol: str) -> Variable:
    return Variable(long_name=long_name, symbol=symbol, unit="N/m")


def _force(long_name: str, symbol: str) -> Variable:
    return Variable(long_name=long_name, symbol=symbol, unit="N")


def _power(long_name: str, symbol: str) -> Variable:
    return Variable(long_name=long_name, symbol=symbol, unit="W/m")


def _rise(long_name: str, symbol: str) -> Variable:
    return Variable(long_name=long_name, symbol=symbol, unit="K")


def _flux(long_name: str, symbol: str) -> Variable:
    return Variable(long_name=long_name, symbol=symbol, unit="W/m2")


_FILM: Final = {
    "x": length("place across the contact, along positive surface speeds", "x"),
    "pressure": pressure("pressure that oil and asperities carry together", "p"),
    "asperity_pressure": pressure("pressure that asperities carry", "p_a"),
    "gap": deviation("gap of the mean planes", "h"),
    "film": deviation("mean gap that is open to the oil", "h_T"),
    "filled": percent("part of that gap that oil fills", "θ"),
    "shear_stress": pressure("shear stress of the oil on member 0, half way across", "τ"),
    "central_film": deviation("film in the middle of the contact", "h_c"),
    "minimum_film": deviation("smallest film", "h_min"),
    "minimum_place": length("place of the smallest film", "x_min"),
    "mean_film": deviation("mean film over the width of the dry contact", "h_m"),
    "largest_pressure": pressure("largest pressure", "p_max"),
    "spike_pressure": pressure("height of the pressure spike", "p_s"),
    "spike_place": length("place of the pressure spike", "x_s"),
    "asperity_share": percent("part of the load on asperities", "L_a"),
    "rolling": _on_line("rolling resistance of each surface", "F_r/l"),
    "shear_force": _on_line("shear of the oil on member 0", "F_s/l"),
    "boundary_force": _on_line("friction of asperities on member 0", "F_b/l"),
    "friction": dimensionless("friction coefficient of oil and asperities", "μ"),
    "film_ratio": dimensionless("smallest film over composite Rq", "Λ"),
    "stiffness": Variable(
        long_name="stiffness of the film, by the mean film, for a length", symbol="k/l", unit="N/m2"
    ),
    "damping": Variable(
        long_name="squeeze damping of the film, for a length", symbol="c/l", unit="N s/m2"
    ),
    "pumping_power": _power("heat of the flow under pressure", "P_p/l"),
    "half_width": length("half-width of the dry contact", "b"),
    "hertz_pressure": pressure("largest pressure of the dry contact", "p_H"),
}
_HEAT: Final = {
    "film": _rise("mean temperature of the film above the inlet", "ΔT"),
    "surface_a": _rise("temperature of surface 0 above the inlet", "ΔT_0"),
    "surface_b": _rise("temperature of surface 1 above the inlet", "ΔT_1"),
    "flux_a": _flux("heat into surface 0", "q_0"),
    "flux_b": _flux("heat into surface 1", "q_1"),
    "heat": _flux("heat that film and asperities make", "q"),
    "largest_film": _rise("largest mean temperature of the film above the inlet", "ΔT max"),
    "largest_a": _rise("flash temperature of member 0", "ΔT_0 max"),
    "largest_b": _rise("flash temperature of member 1", "ΔT_1 max"),
    "power_a": _power("heat into member 0", "P_0/l"),
    "power_b": _power("heat into member 1", "P_1/l"),
    "expansion_power": _power("work of the oil as it expands", "P_e/l"),
    "peclet_a": dimensionless("Peclet number of member 0", "Pe_0"),
    "peclet_b": dimensionless("Peclet number of member 1", "Pe_1"),
}
_ENDED: Final = {
    "code": dimensionless("status of the film"),
    "reynolds": dimensionless("defect of the balance of a cell, over Hertz's pressure"),
    "load": dimensionless("defect of the load over it"),
    "gap": dimensionless("defect of the gap over the smallest one"),
    "iterations": dimensionless("iterations of Newton's method"),
    "grid": dimensionless("estimated error of the film in the middle by the grid"),
    "grid_minimum": dimensionless("estimated error of the smallest film by the grid"),
    "temperature": dimensionless("defect of the temperature over the largest rise"),
    "turns": dimensionless("turns between pressure and temperature"),
}
_PARTS: Final = {"": _FILM, "heat_": _HEAT, "ended_": _ENDED}
"""Variables of the film, of its heat and of how its solve ended, by the beginning of their names."""

_NODES: Final = {
    *("x", "pressure", "asperity_pressure", "gap", "film", "filled", "shear_stress"),
    *("heat_film", "heat_surface_a", "heat_surface_b", "heat_flux_a", "heat_flux_b", "heat_heat"),
}
"""Names of the fields across the contact."""

_PATCH: Final = {
    "x": length("place along the contact, with positive surface speeds", "x"),
    "y": length("place across it, along the contact line", "y"),
    **{
        name: _FILM[name]
        for name in (
            *("pressure", "asperity_pressure", "gap", "film", "filled", "central_film"),
            *("minimum_film", "mean_film", "largest_pressure", "asperity_share", "friction"),
            *("film_ratio", "half_width", "hertz_pressure"),
        )
    },
    "dry_pressure": pressure("pressure without oil", "p_d"),
    "deflection": deviation("deflection of both bodies together", "u"),
    "heights": deviation("heights of both surfaces that the cells see", "z"),
    "shear_x": pressure("shear stress of the oil on member 0 along x, half way across", "τ_x"),
    "shear_y": pressure("shear stress of the oil on member 0 along y, half way across", "τ_y"),
    "traction_x": pressure("stress of oil and asperities on member 0 along x", "t_x"),
    "traction_y": pressure("stress of oil and asperities on member 0 along y", "t_y"),
    "minimum_place": length("place of the smallest film", "x_min, y_min"),
    "largest_place": length("place of the largest pressure", "x_max, y_max"),
    "near_ends": pressure("largest pressure across, near the ends of the line", "p_e"),
    "shear_force": _force("shear of the oil on member 0", "F_s"),
    "boundary_force": _force("friction of asperities on member 0", "F_b"),
    "friction_magnitude": dimensionless(
        "integral of the magnitude of the traction over the load", "μ_t"
    ),
    "boundary_magnitude": dimensionless("its part by asperities", "μ_b"),
    "rolling": _force("rolling resistance of each surface", "F_r"),
    "sliding_power": Variable(long_name="heat by sliding", symbol="P_s", unit="W"),
    "pumping_power": Variable(long_name="heat of the flow under pressure", symbol="P_p", unit="W"),
    "separation": deviation("by which the bodies are further apart than without oil", "h_s"),
    "stiffness": Variable(
        long_name="stiffness of the film, in series with the dry contact", symbol="k", unit="N/m"
    ),
    "damping": Variable(long_name="squeeze damping of the film", symbol="c", unit="N s/m"),
}
_PATCH_HEAT: Final = {
    **{f"heat_{name}": one for name, one in _HEAT.items()},
    "heat_power_a": Variable(long_name="heat into member 0", symbol="P_0", unit="W"),
    "heat_power_b": Variable(long_name="heat into member 1", symbol="P_1", unit="W"),
    "heat_expansion_power": Variable(
        long_name="work of the oil as it expands", symbol="P_e", unit="W"
    ),
}
_MARCH: Final = {
    "time": time("time", "t", shown="ms"),
    "time_steps": dimensionless("steps of time since the time before"),
    "newton_steps": dimensionless("steps of Newton's method since the time before"),
}
_OWN: Final = {
    f"{start}{name}": one for start, part in _PARTS.items() for name, one in part.items()
}
_OWN["domain"] = dimensionless("first and last place, over the half-width", "x/b")


def film_dataset(films: Films, dims: Sequence[str] | None = None) -> xr.Dataset:
    """Films as a dataset: a variable for each field of the film, `heat_` and `ended_` before others' names.

    Args:
        films: with or without profiles.
        dims: names of the axes of the contacts; "contact" unless given, or "contact_1", "contact_2", ... of
            more than one.

    Returns:
        Dataset on (contact, node) with the coordinate `x` [m]. Every variable has `units` and `long_name`;
        the status has its sentences and the dataset its warnings, as JSON.

    Raises:
        InputError: more or fewer names than axes.
    """
    axes = _axes(np.ndim(films.ended.code), dims)
    values = {
        name: ((*axes, "node") if name in _NODES else axes, field) for name, field in _values(films)
    }
    code = np.asarray(films.ended.code)
    data = dataset(
        {**values, "domain": (("end", *axes), films.domain)},
        {},
        title="films",
        nodes=films.nodes,
        warnings=list(films.warnings),
        solve=solve_summary(
            code, np.asarray(films.ended.reynolds), np.asarray(films.ended.iterations)
        ),
    )
    describe_variables(data, _OWN)
    sentences = {int(number): Code(int(number)).sentence for number in np.unique(code)}
    data["ended_code"].attrs["sentences"] = json.dumps(sentences)
    return data.set_coords("x")


def patch_dataset(films: PatchFilms) -> xr.Dataset:
    """Film over the patch of one contact as a dataset.

    Args:
        films: of `solve_patch`.

    Returns:
        Dataset on (y, x) with these as coordinates [m], `direction` of forces and places, and `distance` from
        the ends of a line [half-widths]; `heat_` before the names of temperatures where there are any.
        Every variable has `units` and `long_name`; the dataset has its status and its warnings, as JSON.
    """
    return _over_patch([films], (), {}, "film over a patch")


def march_dataset(moments: Sequence[PatchMoment]) -> xr.Dataset:
    """Films over a patch at several times as a dataset.

    Args:
        moments: of `march_patches`, of one march.

    Returns:
        Dataset as of `patch_dataset` with `time` [s] before all other axes, and the number of steps of time
        and of Newton's method since the time before. Warnings are those of all times.

    Raises:
        InputError: no moments.
    """
    if not moments:
        raise InputError("a dataset of a march takes at least one of its moments", key="moments")
    times = {"time": ("time", np.array([moment.time for moment in moments]))}
    data = _over_patch(moments, ("time",), times, "films over a patch at several times")
    counts = {
        "time_steps": [moment.time_steps for moment in moments],
        "newton_steps": [moment.ended.steps for moment in moments],
    }
    data = data.assign({name: ("time", np.array(values)) for name, values in counts.items()})
    describe_variables(data, _MARCH)
    return data


def _over_patch(
    films: Sequence[PatchFilms] | Sequence[PatchMoment],
    dims: tuple[str, ...],
    coordinates: dict[str, Any],
    title: str,
) -> xr.Dataset:
    """Films on one grid, one without axes of their own or several along one."""
    names = [name for name in _PATCH if name not in ("x", "y")]
    leading_film = films[0].film

    def values(name: str) -> Any:
        by_film = [np.asarray(_of_patch(patch.film, name)) for patch in films]
        return np.stack(by_film) if dims else by_film[0]

    if leading_film.heat is not None:
        names += _PATCH_HEAT
    data = dataset(
        {name: ((*dims, *_patch_dims(name)), values(name)) for name in names},
        {
            **coordinates,
            "x": ("x", np.asarray(leading_film.x)),
            "y": ("y", np.asarray(leading_film.y)),
            "direction": ["x", "y"],
            "end": ["first", "last"],
            "distance": ("distance", END_DISTANCES),
        },
        title=title,
        warnings=list(
            dict.fromkeys(warning for patch_film in films for warning in patch_film.warnings)
        ),
        solve=solve_summary(
            *(
                np.array([getattr(patch_film.ended, name) for patch_film in films])
                for name in ("code", "reynolds", "steps")
            )
        ),
    )
    describe_variables(data, _PATCH | _PATCH_HEAT)
    return data


def _of_patch(film: PatchFilm, name: str) -> Any:
    """What a film over a patch has by the name of a variable."""
    if name.startswith("heat_"):
        return getattr(film.heat, name.removeprefix("heat_"))
    return getattr(film, name)


def _patch_dims(name: str) -> tuple[str, ...]:
    if name in FIELDS or name.removeprefix("heat_") in TEMPERATURES:
        return "y", "x"
    if name == "near_ends":
        return "end", "distance"
    return ("direction",) if name in VECTORS else ()


def films_of_dataset(data: xr.Dataset) -> Films:
    """Films that a dataset was made of, such as one that was saved: a start for `solve_lines`.

    Args:
        data: of `film_dataset`.

    Raises:
        InputError: it lacks a variable of films.
    """
    needed = (*_FILM, "ended_code", "ended_grid_minimum", "domain")
    lacks = [name for name in needed if name not in data.variables]
    if lacks:
        raise InputError(f"a dataset without '{lacks[0]}' is none of solved films")
    heat = Temperatures(**_part(data, "heat_")) if "heat_film" in data else None
    ended: dict[str, Any] = {"temperature": None, "turns": None} | _part(data, "ended_")
    return Films(
        film=LineFilm(**_part(data, ""), heat=heat),
        ended=Ended(**ended),
        nodes=int(data.attrs["nodes"]),
        domain=data["domain"].values,
        warnings=tuple(doubts_of(data.attrs)),
    )


def _axes(count: int, dims: Sequence[str] | None) -> tuple[str, ...]:
    usual = ["contact"] if count == 1 else [f"contact_{k + 1}" for k in range(count)]
    axes = tuple(usual if dims is None else dims)
    if len(axes) != count:
        raise InputError(f"{len(axes)} names for the {count} axes of the contacts", key="dims")
    return axes


def _values(films: Films) -> Iterator[tuple[str, Any]]:
    """Names and arrays of all that films have."""
    for start, part in (("", films.film), ("heat_", films.film.heat), ("ended_", films.ended)):
        for name in _PARTS[start]:
            value = getattr(part, name, None)
            if value is not None:
                yield f"{start}{name}", value


def _part(data: xr.Dataset, start: str) -> dict[str, Any]:
    names = (name for name in _PARTS[start] if f"{start}{name}" in data)
    return {name: data[f"{start}{name}"].values for name in names}
