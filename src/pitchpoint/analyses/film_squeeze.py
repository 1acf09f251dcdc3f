"""Squeeze of films: the film of one pair over its engagement, beside the steady film of every moment."""

import json
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.engagement import KEY, course_of
from pitchpoint.analyses.film_contacts import film_table
from pitchpoint.analyses.finite_film import FIELDS
from pitchpoint.analyses.whole_contacts import whole_contacts
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import course_grid
from pitchpoint.core.doubts import WITHHELD, Doubt, doubts_of, reworded, worst_of_kinds
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.layout import Layout
from pitchpoint.lubrication.ehl.patch.patch_films import ENDS, Turned
from pitchpoint.lubrication.ehl.patch.plan import placed_contacts
from pitchpoint.lubrication.ehl.patch.transient import (
    MarchState,
    PatchMoment,
    march_patches,
    steady_beside,
)
from pitchpoint.results.store import dataset

__all__ = ["further", "joined", "pieces", "squeeze_part"]

TOGETHER = 8
"""Moments of a piece, so that little is lost when a run is stopped."""

ERROR = 5e-3
"""Error of a step of time, of the mass under the contact over the mean.

Steps are chosen by it, as phases of a mesh cycle lie closer where nothing happens than where load comes on.
"""

_OF_FILM = {
    "minimum_film": "minimum_film",
    "central_film": "central_film",
    "film_pressure": "largest_pressure",
    "asperity_share": "asperity_share",
}
"""Values at every moment, and what they are of a film over a patch."""

_STEADY = {name: f"steady_{name}" for name in ("minimum_film", "central_film", "film_pressure")}
"""Those that stand beside the same of the steady film."""

_KEPT = {
    **dict.fromkeys(FIELDS, ("kept", "y", "x")),
    "kept_x": ("kept", "x"),
    "kept_y": ("kept", "y"),
    "kept_moment": ("kept",),
}
"""Axes of what is kept of the moment with the thinnest film."""

_STATE = "state_"
"""Beginning of the names of what a march goes on from."""


def pieces(built: Built) -> Iterator[Piece]:
    """The first moments; a march makes the others."""
    yield {"first": 0, "count": min(TOGETHER, course_of(built).times.size)}


def squeeze_part(built: Built, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """Films of the first moments of the engagement."""
    return _some(built, piece["first"], None, progress)


def further(built: Built, last: xr.Dataset, progress: PieceProgress) -> xr.Dataset | None:
    """Films of the moments after those of the last piece; None at the end."""
    start = int(last.attrs["first"]) + last.sizes["point"]
    if start >= course_of(built).times.size:
        return None
    return _some(built, start, _state_of(last), progress, lost=bool(last.attrs["lost"]))


def _some(
    built: Built,
    first: int,
    after: MarchState | None,
    progress: PieceProgress,
    *,
    lost: bool = False,
) -> xr.Dataset:
    """Films of some moments, from the first one or after a march that stands before it.

    Steady films go on where the film with squeeze was lost.
    """
    count = min(TOGETHER, course_of(built).times.size - first)
    notes: list[str] = []
    marched = [] if lost else _marched(built, first, after, progress, notes)
    solved = [one for one in marched if one.solved]
    stands = solved[-1].course if solved else after
    course = course_of(built)
    contacts = placed_contacts(course.contacts, course.times)[first : first + count]
    moments = [*solved, *[None] * (count - len(solved))]
    steady = [
        steady_beside(
            contact,
            stands if one is None else one.course,
            progress=_heard(
                built, first + count, f"steady film of moment {first + k + 1}", progress
            ),
        )
        for k, (contact, one) in enumerate(zip(contacts, moments, strict=True))
        if stands is not None
    ]
    ended = [_why_lost(one.ended.code) for one in marched if not one.solved]
    values = _values(count, solved, marched, steady)
    return dataset(
        {
            **{name: (("point",), one) for name, one in values.items()},
            **_kept(built, first, solved),
            **({} if stands is None else _state(stands)),
        },
        {},
        first=first,
        lost=int(len(solved) < count),
        warnings=[*notes, *ended, *_doubts([*solved, *steady])],
        grid=json.dumps(course_grid(film_table(built))),
    )


def _marched(
    built: Built, first: int, after: MarchState | None, progress: PieceProgress, told: list[str]
) -> list[PatchMoment]:
    """Moments of the march, up to one whose film is not found."""
    course = course_of(built)
    nodes, cells = course_grid(film_table(built))
    count = min(TOGETHER, course.times.size - first)
    moments: list[PatchMoment] = []

    def step(number: int, residual: float) -> None:
        done = first + len(moments)
        _heard(built, done, f"moment {done + 1}", progress)(number, residual)

    try:
        march = march_patches(
            course.contacts,
            course.times,
            steps="by_error",
            tolerance=ERROR,
            nodes=nodes,
            cells=cells,
            after=after,
            progress=step,
        )
        for moment in islice(march, count):
            moments.append(moment)
            progress(first + len(moments))
    except InputError as error:
        if after is None and not moments:  # wrong from the start: no film to show
            raise InputError(error.message, key=KEY) from None
        told.append(f"the engagement was not taken: {error.message}")
    return moments


def _heard(built: Built, done: int, what: str, progress: PieceProgress) -> Any:
    """What tells the steps of Newton's method of a moment."""
    every = course_of(built).times.size

    def step(number: int, residual: float) -> None:
        progress(done, f"{what} of {every}, Newton step {number}, residual {residual:.0e}")

    return step


def _why_lost(code: Code) -> Doubt:
    return Doubt(
        f"the film of the engagement was lost ({code.sentence}), and nothing is told of what follows",
        moves=WITHHELD,
        brief="the film was lost, and what follows is withheld",
    )


def _doubts(moments: Sequence[PatchMoment]) -> list[Doubt]:
    """What to be wary of, of each kind the worst."""
    solved = [one for one in moments if one.solved]
    every = worst_of_kinds(text for one in solved for text in one.warnings)
    lost = Doubt(
        "some of the steady films beside were not found: there is no difference to tell there",
        moves=WITHHELD,
        brief="some of the steady films beside were not found",
    )
    return [*(one for one in every if one.kind != ENDS), *[lost] * (len(solved) < len(moments))]


def _values(
    count: int,
    found: Sequence[PatchMoment],
    marched: Sequence[PatchMoment],
    steady: Sequence[PatchMoment],
) -> dict[str, np.ndarray]:
    """Values of every moment; not a number where there is no film."""

    def filled(values: Sequence[Any]) -> np.ndarray:
        every = np.full(count, np.nan)
        every[: len(values)] = values
        return every

    codes = np.full(count, int(Code.FILM_LOST))
    codes[: len(marched)] = [int(moment.ended.code) for moment in marched]
    return {
        **{
            name: filled([getattr(moment.film, quantity) for moment in found])
            for name, quantity in _OF_FILM.items()
        },
        **{
            name: filled([getattr(moment.film, _OF_FILM[quantity]) for moment in steady])
            for quantity, name in _STEADY.items()
        },
        "film_status": codes,
        "film_defect": filled([moment.ended.reynolds for moment in marched]),
        "time_steps": filled([moment.time_steps for moment in marched]),
        "newton_steps": filled([moment.ended.steps for moment in marched]),
    }


# ---- the moment with the thinnest film


def _kept(
    built: Built, first: int, found: Sequence[PatchMoment]
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Fields of the moment with the thinnest film of some."""
    nodes, cells = course_grid(film_table(built))
    fields = {name: np.full((1, cells, nodes), np.nan) for name in FIELDS}
    fields |= {"kept_x": np.full((1, nodes), np.nan), "kept_y": np.full((1, cells), np.nan)}
    at = np.full(1, -1)
    if found:
        least = int(np.argmin([one.film.minimum_film for one in found]))
        film = found[least].film
        attributes = {**FIELDS, "kept_x": "x", "kept_y": "y"}
        fields = {name: np.asarray(getattr(film, one))[None] for name, one in attributes.items()}
        at = np.array([first + least])
    return {name: (_KEPT[name], one) for name, one in (fields | {"kept_moment": at}).items()}


def _thinnest(
    parts: Sequence[xr.Dataset], film: np.ndarray
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Fields of the moment with the thinnest film of all."""
    at = [int(part["kept_moment"].values[0]) for part in parts]
    rank = [film[moment] if moment >= 0 else np.inf for moment in at]
    part = parts[int(np.argmin(rank))]
    return {name: (dims, part[name].values) for name, dims in _KEPT.items()}


# ---- what a march goes on from


def _state(course: MarchState) -> dict[str, tuple[tuple[str, ...], Any]]:
    """A course as variables."""
    numbers = [np.nan if one is None else one for one in course.layout]
    step = np.nan if course.step is None else course.step
    lies = [course.lies.swapped, course.lies.along, course.lies.across]
    variables: dict[str, tuple[tuple[str, ...], Any]] = {
        "layout": (("of_layout",), np.array(numbers)),
        "lies": (("of_lies",), np.array(lies)),
        "pressure": (("row", "column"), course.pressure),
        "level": ((), course.level),
        "times": (("before",), np.array(course.times)),
        "masses": (("before", "row", "column"), np.stack(course.masses)),
        "step": ((), step),
    }
    return {f"{_STATE}{name}": one for name, one in variables.items()}


def _state_of(piece: xr.Dataset) -> MarchState | None:
    """The last course of which a piece has a film; None without one."""
    if f"{_STATE}layout" not in piece:
        return None
    variables = {name: piece[f"{_STATE}{name}"].values for name in MarchState._fields}
    numbers = {name: float(v) for name, v in zip(Layout._fields, variables["layout"], strict=True)}
    layout = Layout(**numbers)
    step = float(variables["step"])
    return MarchState(
        layout=layout._replace(end=None) if np.isnan(numbers["end"]) else layout,
        lies=Turned(*map(bool, variables["lies"])),
        pressure=variables["pressure"],
        level=float(variables["level"]),
        times=tuple(map(float, variables["times"])),
        masses=tuple(variables["masses"]),
        step=None if np.isnan(step) else step,
    )


# ---- the whole


def joined(built: Built, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The film of the engagement with squeeze, and the steady films beside it."""
    course = course_of(built)
    names = [str(name) for name, variable in parts[0].items() if variable.dims == ("point",)]
    values = {name: np.concatenate([part[name].values for part in parts]) for name in names}
    values["film_change"] = _change(values["central_film"], values["steady_central_film"])
    codes, steps = values["film_status"], values["newton_steps"]
    iterations = np.nan_to_num(steps).astype(int)
    data = dataset(
        {
            **{name: (("moment",), variable) for name, variable in values.items()},
            **_conditions(built),
            **_thinnest(parts, values["minimum_film"]),
            **{name: ((), variable) for name, variable in _figures(values).items()},
        },
        {"time": ("moment", course.times)},
        title="squeeze of films over the engagement",
        solver=film_table(built).solver,
        grid=parts[0].attrs["grid"],
        tolerance=ERROR,
        travels=built.travels,
        warnings=[*_told(parts), *(f"Squeeze: {text}." for text in course.told)],
        solve=solve_summary(codes, np.nan_to_num(values["film_defect"]), iterations),
    )
    data["path"].attrs.update(built.way)
    return data


def _conditions(built: Built) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """What the contact carries at every moment, how it moves, and where it is in the mesh cycle."""
    course, states = course_of(built), whole_contacts(built).states
    named = {name: course.values(states[name]) for name in ("load", "radius", "path", "pressure")}
    speeds = [course.values(states[name]) for name in ("speed_a", "speed_b")]
    phase, pair, line = course.places.T
    named |= {
        "entrainment": np.abs(speeds[0] + speeds[1]) / 2.0,
        "sliding_velocity": speeds[0] - speeds[1],
        "phase": states["phase"][phase],
        "pair": pair,
        "line": line,
    }
    return {name: (("moment",), condition) for name, condition in named.items()}


def _figures(values: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Thinnest films, and how far squeeze takes the film in the middle from the steady one."""
    change = values["film_change"]
    least = {
        "smallest_film": "minimum_film",
        "steady_smallest_film": "steady_minimum_film",
        "smallest_central_film": "central_film",
        "steady_smallest_central_film": "steady_central_film",
    }
    return {
        **{name: _least(values[variable]) for name, variable in least.items()},
        "squeeze_change": change[np.argmax(np.abs(np.nan_to_num(change)))],
        "loaded_moments": np.array(change.size),
        "solved_moments": np.sum(values["film_status"] == int(Code.SOLVED)),
    }


def _change(film: np.ndarray, steady: np.ndarray) -> np.ndarray:
    """Part by which a film is thicker than the steady one; not a number where mean planes overlap."""
    apart = (film > 0.0) & (steady > 0.0)
    return np.where(apart, film, np.nan) / np.where(apart, steady, 1.0) - 1.0


def _least(values: np.ndarray) -> np.ndarray:
    finite = values[np.isfinite(values)]
    return np.array(finite.min() if finite.size else np.nan)


def _told(parts: Sequence[xr.Dataset]) -> list[Doubt]:
    """Warnings of all pieces: of a kind the worst one."""
    every = (doubt for part in parts for doubt in doubts_of(part.attrs))
    return [reworded(doubt, "Squeeze: {}.".format) for doubt in worst_of_kinds(every)]
