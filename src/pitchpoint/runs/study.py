"""Studies from Python: many designs of a case in one dataset with a dimension for each key."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.analyses.design_batch import TOGETHER
from pitchpoint.analyses.studies import demand_one, refuse_film_sweep
from pitchpoint.analyses.summaries import balance_codes, first_warnings
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.study_tables import StudyTable, Sweep
from pitchpoint.cases.validation import validate, with_meshes
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import stored
from pitchpoint.core.status import solve_summary
from pitchpoint.errors import InputError
from pitchpoint.input.remembered import remembering
from pitchpoint.results.chosen_units import shown_in, unit_choice
from pitchpoint.results.labelled import Units, demand_units, in_units, showing
from pitchpoint.results.pieces import ALONG, StudyPieces, Summary, joined_pieces, summary_of
from pitchpoint.results.store import make_folder, sole_writer, sweep
from pitchpoint.runs.case import Case, CaseLike, as_case
from pitchpoint.runs.described import StudyDescription
from pitchpoint.runs.layouts import How, StudyLayout, layout_of
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import FrictionChoice, Progress, with_user_law
from pitchpoint.runs.tolerances import with_tolerances
from pitchpoint.runs.workers import pieces_of_workers

__all__ = [
    "PIECE",
    "StudyPlan",
    "demand_study",
    "folder_of_table",
    "study",
    "table_of_study",
]

PIECE = 16 * TOGETHER
"""Designs that are kept together: a loss of a minute or less, and a file of a megabyte or two."""

MOST_REASONS = 20
"""Sentences on designs without figures that are counted, the most frequent first."""

MOST_IN_MEMORY = 100_000
"""Designs of a study without a folder."""


@double_precision()
def study(
    case: CaseLike,
    over: Mapping[str, Any] | None = None,
    how: How | None = None,
    *,
    n: int | None = None,
    seed: int | None = None,
    tolerances: str | None = None,
    units: Units = "si",
    variant: str | None = None,
    friction: FrictionChoice | None = None,
    folder: str | Path | None = None,
    piece: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Main figures of many designs of a case, from a few to millions.

    What is not given is that of the table `[study]` of the case; with `over` or `tolerances` the study is
    that of the call alone, whatever the table says.

    Args:
        case: a `Case`, or what makes one.
        over: values by key, SI numbers or texts with a unit, or names; for designs that are drawn the lowest
            and the highest one, or {"start": ..., "stop": ..., "distribution": "normal"}, whose ends are
            three standard deviations from its middle.
        how: "grid" takes every value with every other, "zip" the first ones together, then the second
            ones, "latin_hypercube" draws designs that fill the ranges evenly, "sobol" those of a scrambled
            Sobol' sequence, "saltelli" those from which `sobol_indices` follow. A grid, with tolerances
            "sobol", by default.
        n: number of designs to draw, of the last three ways alone; a power of two of a Sobol' sequence, and
            of each of both samples of "saltelli", which has (keys + 2) n designs.
        seed: the same one draws the same designs; 0 by default.
        tolerances: "uniform" or "normal" draws what `[gears.inspection]` of a cylindrical pair allows between
            its limits, see `pitchpoint.runs.tolerances`; beside `over`, if that is given.
        units: of the result, "si", those in which values are "shown", or some by kind of quantity,
            {"angle": "arcmin"}, and the others as shown.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run`.
        folder: where pieces are kept as soon as they are computed, each a NetCDF file that is whole or not
            there, so that the same call goes on from them. Whoever computes them, in whatever order and after
            whatever was killed, the files are the same bit for bit.
        piece: designs that are computed and kept together; 4096 by default.
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
    demand_arguments(tolerances=tolerances)
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    given: dict[str, Any] = {
        "over": over,
        "how": how,
        "n": n,
        "seed": seed,
        "tolerances": tolerances,
    }
    given |= {"folder": folder, "piece": piece, "workers": workers, "scheduler": scheduler}
    plan = StudyPlan(**_completed(given, chosen))
    base = chosen.held[0] if friction is None else with_user_law(chosen.held[0], friction)
    base, layout = _laid_out(chosen, base, plan)
    where = None if plan.folder is None else Path(plan.folder)
    _demand_place(layout, base, where, plan.workers, plan.scheduler)
    described = {key: axis.described for key, axis in layout.axes.items()}
    asked = StudyDescription(base.computed, described, plan.way, plan.n, plan.seed, plan.piece)
    pieces = StudyPieces(where, f"designs_{asked.mark[:8]}", asked.mark, layout.count, plan.piece)
    with ExitStack() as stack:
        if where is not None:
            stack.enter_context(_alone(where))
        _compute(asked, pieces, plan.workers, plan.scheduler, progress or Progress())
    choice = unit_choice(base.document().tree.get(OUTPUT, {}).get("units", {}))
    data = _opened(pieces, layout, base.name, choice, units)
    of_layout = {"how": plan.way, "n": plan.n, "seed": plan.seed, "keys": [*layout.axes]}
    return data.assign_attrs(layout=json.dumps(of_layout), tolerances=plan.tolerances or "")


@dataclass(frozen=True)
class StudyPlan:
    """What a study is asked for; None where it is left open, see `study`."""

    over: Mapping[str, Any]
    how: str | None = None
    n: int | None = None
    seed: int = 0
    tolerances: str | None = None
    folder: str | Path | None = None
    piece: int = PIECE
    workers: int | None = None
    scheduler: str | None = None

    @property
    def way(self) -> str:
        """How designs are laid out."""
        return self.how or ("grid" if self.tolerances is None else "sobol")


def table_of_study(case: Case) -> StudyTable | None:
    """The table `[study]` of the first variant of a case; None where it has none.

    Raises:
        InputError: the case cannot be read.
    """
    return _table_of_variant(case.held[0])


@remembering
def _table_of_variant(variant: Variant) -> StudyTable | None:
    """The same of a variant; a command asks for it, and then the study that it computes."""
    document = variant.document()
    return validate(with_meshes(document)).study if "study" in document.tree else None


def demand_study(case: Case) -> None:
    """InputError for what is wrong with the table `[study]` of the first variant of a case, if it has one."""
    if "study" in case.held[0].document().tree:
        plan = StudyPlan(**_completed({}, case))
        _demand_some(*_laid_out(case, case.held[0], plan))


TRIED = 16
"""Designs that are built to see whether a study has any."""


def _demand_some(base: Variant, layout: StudyLayout) -> None:
    """InputError where none of some designs from the first to the last one can be built."""
    numbers = np.unique(np.linspace(0, layout.count - 1, TRIED).round().astype(int)).tolist()
    changes = [layout.changes(number, number + 1)[0] for number in numbers]
    refusals = [one for one in base.computed.built_each(changes) if isinstance(one, InputError)]
    if len(refusals) == len(numbers):
        told = f"none of {len(numbers)} designs that were tried can be computed; the first one"
        key = f"{refusals[0].key}: " if refusals[0].key else ""
        raise InputError(f"{told}: {key}{refusals[0].message}", file=base.name, key="study")


def _laid_out(case: Case, base: Variant, plan: StudyPlan) -> tuple[Variant, StudyLayout]:
    """Designs of a study, and the case that they are changes of."""
    values = _whole_keys(case, plan.over)
    if plan.tolerances is not None:
        base, drawn = with_tolerances(base, plan.tolerances)
        values = {**drawn, **values}
    if not values:
        raise InputError("a study needs the values of one key at least", key="over")
    try:
        layout = layout_of(base, values, plan.way, plan.n, plan.seed)
    except InputError as error:
        raise error.at(file=error.file or base.name) from None
    _demand_meant(base, layout)
    return base, layout


def folder_of_table(table: StudyTable | None, case: Case) -> Path | None:
    """Folder of a study as its table says, from that of the case file on; None where it says none."""
    if table is None or not table.folder:
        return None
    return (case.held[0].folder or Path()) / table.folder


def _completed(given: Mapping[str, Any], case: Case) -> dict[str, Any]:
    """Arguments that are given, and those of the table of the case where they leave the designs to it."""
    stated = {name: value for name, value in given.items() if value is not None}
    if stated.keys() & {"over", "tolerances"}:
        return {"over": {}, **stated}
    table = table_of_study(case)
    if table is None:
        raise InputError(
            "a study needs the values of one key at least, as over, or a table [study] in the case",
            file=case.name,
        )
    of_table: dict[str, Any] = {"over": table.by_key, "seed": int(table.seed)}
    of_table |= {"how": table.how, "tolerances": table.tolerances}
    for name in ("n", "piece", "workers"):
        number = getattr(table, name)
        of_table[name] = None if number is None else int(number)
    of_table["scheduler"] = table.scheduler or None
    of_table["folder"] = folder_of_table(table, case)
    if stated.keys() & {"workers", "scheduler"}:
        of_table |= {"workers": None, "scheduler": None}
    left_open = {name: value for name, value in of_table.items() if value is not None}
    return {**left_open, **stated}


def _whole_keys(case: Case, over: Mapping[str, Any]) -> dict[str, Any]:
    """Values by whole key."""
    return {case.key(name): values for name, values in over.items()}


def _demand_meant(base: Variant, layout: StudyLayout) -> None:
    """InputError where one number would stand for two different ones, or changes nothing."""
    built = base.built({})
    for key, axis in layout.axes.items():
        demand_one(base, Sweep(key=key, values=tuple(axis.values[:1])), "study")
        refuse_film_sweep(built, base, key, "study")


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
    data = joined_pieces(pieces, summary, layout.dims, shown).assign_attrs(_attributes(summary))
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
    solve = json.dumps({**solve_summary(codes), **most})
    reasons = dict([*summary.reasons.items()][:MOST_REASONS])
    doubts = stored(first_warnings([*summary.warnings]))
    return {**summary.attributes, **doubts, "solve": solve, "reasons": json.dumps(reasons)}
