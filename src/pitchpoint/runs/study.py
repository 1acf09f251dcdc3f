"""Studies from Python: many designs of a case in one dataset with a dimension for each key."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.analyses.designs import TOGETHER
from pitchpoint.analyses.studies import demand_films, demand_one
from pitchpoint.analyses.summaries import balance_codes, few
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.schema import Sweep
from pitchpoint.cases.variant import Variant
from pitchpoint.doubts import stored
from pitchpoint.errors import InputError
from pitchpoint.results.chosen_units import shown_in, unit_choice
from pitchpoint.results.labelled import Units, demand_units, in_units, showing
from pitchpoint.results.pieces import ALONG, StudyPieces, Summary, as_whole, summary_of
from pitchpoint.results.store import make_folder, sole_writer, sweep
from pitchpoint.runs.case import Case, CaseLike, as_case
from pitchpoint.runs.described import StudyDescription
from pitchpoint.runs.layouts import How, StudyAxis, StudyLayout, layout_of
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import FrictionChoice, Progress, own_law
from pitchpoint.runs.workers import pieces_of_workers
from pitchpoint.status import told

__all__ = ["PIECE", "drawn_values", "study"]

PIECE = 16 * TOGETHER
"""Designs that are kept together: a loss of a minute or less, and a file of a megabyte or two."""

MOST_REASONS = 20
"""Sentences on designs without figures that are counted, the most frequent first."""

MOST_IN_MEMORY = 100_000
"""Designs of a study without a folder."""


@double_precision()
def study(
    case: CaseLike,
    over: Mapping[str, Any],
    how: How = "grid",
    *,
    n: int | None = None,
    seed: int = 0,
    units: Units = "si",
    variant: str | None = None,
    friction: FrictionChoice | None = None,
    folder: str | Path | None = None,
    piece: int = PIECE,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Main figures of many designs of a case, from a few to millions.

    Args:
        case: a `Case`, or what makes one.
        over: values by key, SI numbers or texts with a unit, or names; for "latin_hypercube" and "sobol" the
            lowest and the highest one.
        how: "grid" takes every value with every other, "zip" the first ones together, then the second
            ones, "latin_hypercube" draws designs that fill the ranges evenly, "sobol" those of a scrambled
            Sobol' sequence.
        n: number of designs to draw, of those two ways alone; a power of two of a Sobol' sequence.
        seed: the same one draws the same designs.
        units: of the result, "si", those in which values are "shown", or some by kind of quantity,
            {"angle": "arcmin"}, and the others as shown.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run`.
        folder: where pieces are kept as soon as they are computed, each a NetCDF file that is whole or not
            there, so that the same call goes on from them. Whoever computes them, in whatever order and after
            whatever was killed, the files are the same bit for bit.
        piece: designs that are computed and kept together.
        workers: processes of this machine that compute pieces, by `dask.distributed`; this one by default.
        scheduler: in their place the address of a scheduler of `dask.distributed`, "tcp://host:8786", whose
            workers have this version of the package, and need share no disk with this process.
        progress: told about pieces.

    Returns:
        Figures over `law` and a dimension for each key of a grid, named as the key; otherwise over
        `design`, along which the keys are coordinates. A design that cannot be computed is NaN, and
        `reason` says why. Values of several pieces in a folder stay there and are read when asked for.

    Raises:
        InputError: no such key, one whose values cannot be changed by design, values that it cannot take,
            none of the designs can be computed, or workers that cannot be had.

    Example:
        >>> import pitchpoint as pp
        >>> found = pp.study("tian2024", {"operation.torque": [20.0, 60.0]}, variant="physical")
        >>> dict(found.sizes)["operation.torque"]
        2
    """
    demand_units(units)
    demand_arguments(over=over, how=how, n=n, seed=seed, variant=variant, friction=friction)
    demand_arguments(folder=folder, piece=piece, workers=workers, scheduler=scheduler)
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    base = chosen.held[0] if friction is None else own_law(chosen.held[0], friction)
    layout = layout_of(base, _whole_keys(chosen, over), how, n, seed)
    _demand_meant(base, layout)
    _demand_place(layout, base, folder, workers, scheduler)
    values = {key: axis.values for key, axis in layout.axes.items()}
    asked = StudyDescription(base.computed, values, how, n, seed, piece)
    where = None if folder is None else Path(folder)
    pieces = StudyPieces(where, f"designs_{asked.mark[:8]}", asked.mark, layout.count, piece)
    with ExitStack() as stack:
        if where is not None:
            stack.enter_context(_alone(where))
        _compute(asked, pieces, workers, scheduler, progress or Progress())
    choice = unit_choice(base.document().tree.get(OUTPUT, {}).get("units", {}))
    return _opened(pieces, layout, base.name, choice, units)


def drawn_values(
    case: CaseLike, over: Mapping[str, Any], shares: np.ndarray, variant: str | None = None
) -> dict[str, list[Any]]:
    """Values by whole key at shares of their ranges, as a study by "zip" takes them.

    Args:
        case: see `study`.
        over: lowest and highest value by key.
        shares: of the ranges, shape (design, key).
        variant: of the case, the first one by default.

    Raises:
        InputError: see `study`; a key without two numbers.
    """
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    ranges = _whole_keys(chosen, over).items()
    return {
        key: StudyAxis.of(chosen.held[0], key, values).drawn(shares[:, at])
        for at, (key, values) in enumerate(ranges)
    }


def _whole_keys(case: Case, over: Mapping[str, Any]) -> dict[str, Any]:
    """Values by whole key."""
    if not over:
        raise InputError("a study needs the values of one key at least")
    return {case.key(name): values for name, values in over.items()}


def _demand_meant(base: Variant, layout: StudyLayout) -> None:
    """InputError where one number would stand for two different ones, or changes nothing."""
    built = base.built({})
    for key, axis in layout.axes.items():
        demand_one(base, Sweep(key=key, values=tuple(axis.values[:1])), "study")
        demand_films(built, base, key, "study")


def _demand_place(
    layout: StudyLayout, base: Variant, folder: object, workers: int | None, scheduler: str | None
) -> None:
    """InputError for designs that would fill the memory, and for workers that cannot do them."""
    if folder is None and layout.count > MOST_IN_MEMORY:
        told = f"{layout.count} designs need a folder to be kept in"
        raise InputError(f"{told}; {MOST_IN_MEMORY} at most go without one", key="folder")
    if workers is not None and scheduler is not None:
        raise InputError("goes with workers of this machine; give it or a scheduler", key="workers")
    if base.own and (workers or scheduler):
        raise InputError(
            "laws of the user's own are functions of this process, and its workers have none of them; leave "
            "workers and scheduler out",
            key="friction",
        )


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Keep others out of a folder, after what killed ones left half written is removed."""
    make_folder(folder)
    with sole_writer(folder) as alone:
        if alone:
            sweep(folder)
        yield


def _compute(
    asked: StudyDescription,
    pieces: StudyPieces,
    workers: int | None,
    scheduler: str | None,
    progress: Progress,
) -> None:
    """Keep every piece that is not there yet, in whatever order they come."""
    missing = pieces.missing()
    progress.part(asked.variant.variant, "designs", not missing)
    pace = Pace(pieces, missing, progress)
    if workers is None and scheduler is None:
        for number in missing:
            pieces.keep(number, asked.computed(*pieces.range(number), pace.within))
            pace.landed(number)
    elif missing:
        # Closed before an error goes on: its processes end with it.
        with closing(pieces_of_workers(asked, pieces, missing, workers, scheduler)) as landing:
            for number, image in landing:
                pieces.keep(number, image)
                pace.landed(number)


class Pace:
    """How many designs are there, at which rate they come, and when the last one will.

    Args:
        pieces: of the study.
        missing: pieces that are computed now.
        progress: that is told.
    """

    def __init__(self, pieces: StudyPieces, missing: Sequence[int], progress: Progress) -> None:
        self.pieces, self.progress, self.begun = pieces, progress, monotonic()
        self.left = sum(map(self._designs, missing))
        self.done = 0

    def _designs(self, number: int) -> int:
        first, stop = self.pieces.range(number)
        return stop - first

    def landed(self, number: int) -> None:
        """A piece is kept."""
        self.done += self._designs(number)
        self.within(0)

    def within(self, done: int, doing: str = "") -> None:
        """So many designs of the next piece are computed."""
        there = self.pieces.count - self.left + self.done + done
        computed, seconds = self.done + done, monotonic() - self.begun
        if not computed or not seconds:
            return self.progress.points(there, f"of {self.pieces.count}")
        rate = computed / seconds
        left = _duration((self.left - computed) / rate)
        self.progress.points(there, f"of {self.pieces.count}, {rate:.3g} a second, {left} left")
        return None


def _duration(seconds: float) -> str:
    """A time as one reads it.

    Example:
        >>> _duration(50.0), _duration(600.0), _duration(9000.0)
        ('50 s', '10 min', '2.5 h')
    """
    if seconds < 90.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 5400.0 else f"{seconds / 3600.0:.1f} h"


def _opened(
    pieces: StudyPieces, layout: StudyLayout, name: str, choice: Mapping[str, str], units: Units
) -> xr.Dataset:
    """All pieces as one dataset in some units; one piece, and what no folder keeps, in memory."""

    def shown(part: xr.Dataset) -> xr.Dataset:
        with shown_in(choice), showing(units):
            return _keys_in(in_units(part, units), layout, units)

    summary = summary_of(pieces, balance_codes)
    if not summary.attributes:
        first = next(iter(summary.reasons), "")
        told = f"none of {pieces.count} designs can be computed; the first one: {first}"
        raise InputError(told, file=name)
    data = as_whole(pieces, summary, layout.dims, shown).assign_attrs(_attributes(summary))
    if ALONG in layout.dims:
        data = data.assign_coords({ALONG: np.arange(pieces.count)})
    else:
        axes = (axis.coordinate() for axis in layout.axes.values())
        data = data.assign_coords(shown(xr.Dataset(coords=dict(axes))).coords)
    return data.load() if pieces.folder is None or len(pieces) == 1 else data


def _keys_in(part: xr.Dataset, layout: StudyLayout, units: Units) -> xr.Dataset:
    """A part of a study whose keys are in the units in which they are shown."""
    for key, axis in layout.axes.items():
        if key in part.variables and (unit := axis.unit_in(units)):
            values, attributes = axis.shown(part[key].values, units), part[key].attrs
            part = part.assign_coords(
                {key: (part[key].dims, values, {**attributes, "units": unit})}
            )
    return part


def _attributes(summary: Summary) -> dict[str, Any]:
    """Attributes of all designs: how their solves ended, and what is doubtful."""
    codes = np.repeat([*summary.codes], [*summary.codes.values()])
    most = {"residual": summary.residual, "iterations": summary.iterations}
    solve = json.dumps({**told(codes), **most})
    reasons = dict([*summary.reasons.items()][:MOST_REASONS])
    doubts = stored(few([*summary.warnings]))
    return {**summary.attributes, **doubts, "solve": solve, "reasons": json.dumps(reasons)}
