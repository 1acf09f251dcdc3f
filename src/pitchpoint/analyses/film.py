"""Films of the contacts of a mesh solved over its cycle, beside film laws and friction laws."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.film_contacts import (
    LEAST,
    Done,
    contact_states,
    distinct_contacts,
    film_model_of,
    film_table,
)
from pitchpoint.analyses.film_cycle import cycle_films
from pitchpoint.cases.built import Built
from pitchpoint.cases.height_maps import height_maps
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import tooth_size
from pitchpoint.lubrication.ehl.doubts import UNSOLVED
from pitchpoint.lubrication.ehl.fields import LineFilm
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.solve import Films, solve_lines
from pitchpoint.results.store import dataset

__all__ = [
    "GRID_ERRORS",
    "OF_LINES",
    "film_part",
    "films_of_lines",
    "joined",
    "over_rough",
    "pieces",
    "values_of_lines",
]

GRID_ERRORS = ("central_film_error", "minimum_film_error")
"""Estimates of the error that the grid makes of film in the middle and smallest film."""

TOGETHER = 6
"""Phases of a piece, so that little is lost when a run is stopped."""

SHOWN_ALIKE = 6
"""Digits to which pairs carry alike and one of them is shown."""

SHOWN = 4
"""Pairs whose profiles are kept: those that carry most."""

_LANES = ("phase", "pair", "slice")
_OF_PIECE = ("point", "pair", "slice")
_OF_PROFILE = ("point", "shown", "node")
_PROFILES = {
    "profile_place": "x",
    "profile_film": "gap",
    "profile_pressure": "pressure",
    "profile_asperity_pressure": "asperity_pressure",
}
_WARM_PROFILES = {
    "profile_rise": "film",
    "profile_surface_rise_1": "surface_a",
    "profile_surface_rise_2": "surface_b",
}
"""Profiles of films that are solved with their heat, which are along the same places."""


# ---- pieces


def pieces(built: Built) -> Iterator[Piece]:
    """Ranges of phases."""
    every = contact_states(built)["phase"].size
    for start in range(0, every, TOGETHER):
        yield {"first": start, "count": min(TOGETHER, every - start)}


def film_part(built: Built, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """Films of all contacts at some phases."""
    cycle_states = contact_states(built)
    taken = slice(piece["first"], piece["first"] + piece["count"])
    some = {name: cycle_states[name][taken] for name in OF_LINES}
    start, count = piece["first"], piece["count"]
    done = lambda part, every: progress(start + count * part // every)  # noqa: E731
    films, codes, back = films_of_lines(built, some, done)
    values = values_of_lines(films.film, some, back)
    values["minimum_lambda"] = over_rough(built, values["minimum_film"])
    for name, error in zip(GRID_ERRORS, (films.ended.grid, films.ended.grid_minimum), strict=True):
        values[name] = np.where(back < 0, np.nan, error[back])
    profiles = _kept(films.film, cycle_states, some, back)
    # Contacts that have no film are counted over the whole cycle.
    doubts = [doubt for doubt in films.warnings if doubt.kind != UNSOLVED]
    return dataset(
        {
            **{name: (_OF_PIECE, array) for name, array in values.items()},
            "film_status": (_OF_PIECE, codes),
            **{name: (_OF_PROFILE[: array.ndim], array) for name, array in profiles.items()},
        },
        {},
        warnings=doubts,
        residual=_largest(films.ended.reynolds, films.solved),
        iterations=int(np.max(films.ended.iterations, initial=0)),
    )


def _largest(values: Any, solved: np.ndarray) -> float:
    return float(np.max(np.asarray(values)[solved], initial=0.0))


def over_rough(built: Built, film: np.ndarray) -> np.ndarray:
    """Film over composite Rq; infinite over smooth flanks."""
    rq = float(built.design.roughness.composite_rq)
    return film / rq if rq > 0.0 else film * np.inf


_GIVEN = ("line_load", "radius", "speed_a", "speed_b")
"""What tells one contact of a mesh from another."""

OF_LINES = (*_GIVEN, "loaded", "load", "weight_of_line")
"""What is asked of the contacts of a cycle for their films as lines."""


def films_of_lines(
    built: Built, some: Mapping[str, np.ndarray], done: Done | None = None
) -> tuple[Films, np.ndarray, np.ndarray]:
    """Films of the contacts that differ, codes [phase, pair, slice], and which film belongs to each lane.

    Each may have an inlet of its own.
    """
    loaded, names = some["loaded"], [name for name in (*_GIVEN, "inlet") if name in some]
    every = np.stack([some[name][loaded] for name in names], axis=-1)
    if not every.size:
        every = np.array([[0.0, 1.0, 0.0, 0.0, 1.0][: len(names)]])
    where, inverse = distinct_contacts(every, np.max(np.abs(every), axis=0))
    conditions = dict(zip(names, every[where].T, strict=True))
    films = _films(built, conditions, done, film_model_of(built))
    back = np.full(loaded.shape, -1)
    back[loaded] = inverse[: loaded.sum()]
    codes = np.where(back < 0, int(Code.UNLOADED), np.asarray(films.ended.code)[back])
    return films, codes, back


def _films(
    built: Built, given: Mapping[str, np.ndarray], done: Done | None, model: FilmModel
) -> Films:
    design = built.design
    contacts = model.contacts(
        **given,
        modulus=float(design.modulus),
        oil=design.lubricant,
        temperature=float(built.operation.temperature),
        roughness_rq=float(design.roughness.composite_rq),
        heights=_heights(film_table(built)),
    )
    size = tooth_size(design.mesh)
    try:
        return solve_lines(contacts, nodes=model.nodes, size=size, progress=done)
    except InputError as error:
        raise InputError(error.message, key=f"film.{error.key}") from None


def _heights(table: FilmTable) -> tuple[HeightMap, ...]:
    """Profiles of the surfaces of lines; those of patches are not of the lines beside them."""
    return () if table.over_patch else height_maps(table)


def values_of_lines(
    film: LineFilm, some: Mapping[str, np.ndarray], back: np.ndarray
) -> dict[str, np.ndarray]:
    """What follows from the films, for every lane; not a number where there is none."""

    def lane(values: Any) -> np.ndarray:
        return np.where(back < 0, np.nan, np.asarray(values)[back])

    sliding = some["speed_b"] - some["speed_a"]
    rolling = lane(film.rolling) * some["weight_of_line"]
    drawn = lane(film.shear_force + film.boundary_force)
    load = np.where(back < 0, np.nan, some["line_load"])
    return {
        "central_film": lane(film.central_film),
        "minimum_film": lane(film.minimum_film),
        "film_pressure": lane(film.largest_pressure),
        "asperity_share": lane(film.asperity_share),
        "film_rise": lane(0.0 * film.rolling if film.heat is None else film.heat.largest_film),
        "film_friction": lane(film.friction),
        "flash_rise": lane(_flash(film)),
        "boundary_part": np.abs(lane(film.boundary_force)) / load,
        "rolling_resistance": rolling,
        "film_sliding_loss": drawn * sliding * some["weight_of_line"],
        "film_rolling_loss": rolling * (some["speed_a"] + some["speed_b"]),
        "film_stiffness": lane(film.stiffness) * some["weight_of_line"],
        "film_damping": lane(film.damping) * some["weight_of_line"],
    }


def _flash(film: LineFilm) -> np.ndarray:
    """Flash temperature of the warmer surface [K]; none of isothermal films."""
    heat = film.heat
    if heat is None:
        return 0.0 * np.asarray(film.rolling)
    warmer: np.ndarray = np.maximum(np.asarray(heat.largest_a), np.asarray(heat.largest_b))
    return warmer


def _kept(
    film: LineFilm,
    states: Mapping[str, np.ndarray],
    some: Mapping[str, np.ndarray],
    back: np.ndarray,
) -> dict[str, np.ndarray]:
    """Profiles [phase, shown pair, node] and half-width of the slice of each pair that carries most."""
    pairs = _shown(states)
    highest = np.argmax(some["load"][:, pairs], axis=-1)[..., None]
    which = np.take_along_axis(back[:, pairs], highest, axis=-1)
    fields = {name: getattr(film, attribute) for name, attribute in _PROFILES.items()}
    if film.heat is not None:
        fields |= {
            name: getattr(film.heat, attribute) for name, attribute in _WARM_PROFILES.items()
        }
    profiles = {
        name: np.where(which < 0, np.nan, np.asarray(profile)[which[..., 0]])
        for name, profile in fields.items()
    }
    width = np.where(which < 0, np.nan, np.asarray(film.half_width)[which])
    return {**profiles, "profile_half_width": width[..., 0]}


def _shown(states: Mapping[str, np.ndarray]) -> np.ndarray:
    """Numbers of the pairs that carry most over the cycle, in order; of pairs that are alike the first."""
    load = states["load"].sum(axis=-1)
    carried = load.T @ states["weight"]
    rounded = np.round(load.T / np.max(load, initial=LEAST), SHOWN_ALIKE)
    _, distinct = np.unique(rounded, axis=0, return_index=True)
    most = distinct[np.argsort(-carried[distinct], kind="stable")[:SHOWN]]
    return np.sort(most)


# ---- the whole


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Films of the cycle, with those by film laws and friction by the laws of the case beside them."""
    cycle_states = contact_states(built)
    shown = {"shown_pair": (("shown",), _shown(cycle_states))}

    def again(lane: tuple[int, ...], eta_beta_sigma: float) -> tuple[float, float]:
        contact = {name: cycle_states[name][lane][None] for name in _GIVEN}
        model = replace(film_model_of(built), eta_beta_sigma=eta_beta_sigma)
        film = _films(built, contact, None, model).film
        return float(film.asperity_share[0]), float(film.friction[0])

    return cycle_films(built, cycle_states, parts, _LANES, shown, again, title="films")
