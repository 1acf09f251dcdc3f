"""A case explored: its figures over a few inputs, computed beforehand for a page that has sliders."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from itertools import product
from math import prod
from typing import Any, Generic, TypeVar

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.main_figures import main_figures
from pitchpoint.analyses.studies import sweep_values
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.study_tables import Sweep
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError, PitchpointError
from pitchpoint.input.quantities import Quantity
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.runs.case import Case, CaseLike, case_value
from pitchpoint.runs.jobs import Job
from pitchpoint.runs.run import Outcome, Progress, run_variant
from pitchpoint.runs.study import study

__all__ = ["MOST", "Axis", "Explored", "explore", "usual_keys"]

MOST = 600
"""Points of a grid that one page holds."""

SHARES = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5)
"""Loads and speeds over those of the case."""

FEW_SHARES = (0.5, 1.0, 1.5)
"""The same where films are solved at every point."""

VALUES = 5
"""Values of the key of the gears."""

PARTS = ("teeth", "cycle", "stiffness")
"""Parts of a result that are computed at every point, where they exist."""

TEETH = ("teeth",)
"""The same of a stage."""

WITHOUT_CYCLE = ("operation",)
"""The same of a case that has no mesh cycle of its own: what is said of it stands there."""

T = TypeVar("T")


@dataclass(frozen=True)
class Axis:
    """Values of one key, for a slider.

    Attributes:
        key: dotted.
        quantity: what its values are.
        values: rising, at least two [SI].
        own: of the case, or the end next to it where that lies beyond; among the values [SI].
    """

    key: str
    quantity: Quantity
    values: np.ndarray
    own: float

    @property
    def between(self) -> np.ndarray:
        """Places half way between values; the values themselves where only whole ones count [SI]."""
        if self.quantity.whole:
            return self.values
        middles: np.ndarray = 0.5 * (self.values[1:] + self.values[:-1])
        return middles


@dataclass(frozen=True)
class Explored(Generic[T]):
    """What was computed of a case over a grid.

    Attributes:
        own: the case itself, with the parts `PARTS`.
        axes: in the order of the dimensions of the figures.
        figures: of a `study` of the grid.
        seen: what was read of the parts at every point, the last axis running fastest; None where they
            could not be computed.
        refused: why not, by number of the point.
        errors: of linear interpolation, by main figure: the largest at the midpoints over the value there.
        midpoints: number of places between points where figures were computed to tell.
    """

    own: Outcome
    axes: tuple[Axis, ...]
    figures: xr.Dataset
    seen: Sequence[T | None]
    refused: Mapping[int, str]
    errors: Mapping[str, float]
    midpoints: int


def explore(
    case: CaseLike,
    over: Sequence[Sweep] = (),
    *,
    read: Callable[[Outcome, Mapping[int, Outcome]], T],
    variant: str | None = None,
    settings: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> Explored[T]:
    """Compute a case over a grid of a few inputs.

    Args:
        case: a `Case`, or what makes one.
        over: keys and their values, to which that of the case is added where it lies between them; by default
            load and speed, and the key that the table of the gears names.
        read: what is kept of the parts at a point, which are too large to be kept whole, and of the teeth of
            each stage by its number; no stages where the case is one mesh.
        variant: of the case, the first one by default.
        settings: values by dotted key that replace those of the case.
        progress: told about points.

    Raises:
        InputError: anything wrong with the case, a key without numbers, too many points, or none that can be
            computed.
        ConvergenceError: the case itself has no balance.
    """
    reporter = progress or Progress()
    whole_case = Case(case, variant=variant) if not isinstance(case, Case) or variant else case
    chosen = whole_case.set(settings or {})
    base = chosen.held[0].computed
    axes = tuple(_given(chosen, over) if over else usual_keys(base))
    count = prod(len(axis.values) for axis in axes)
    if not axes or count > MOST:
        raise InputError(
            f"{count} points, with the values of the case among them; a page holds {MOST} at most",
            file=base.name,
            key="--over",
        )
    reporter.expect(4)
    reporter.part("", "the case itself", False)
    own_design, _ = _computed(base)
    reporter.part("", f"{count} designs", False)
    figures = study(chosen, {axis.key: axis.values for axis in axes})
    reporter.part("", "places between them", False)
    errors, midpoints = _errors(chosen, axes, figures)
    reporter.part("", "teeth and mesh cycles", False)
    refused: dict[int, str] = {}
    seen = list(_seen(base, axes, read, refused, reporter))
    return Explored(own_design, axes, figures, seen, refused, errors, midpoints)


def usual_keys(variant: Variant) -> Iterator[Axis]:
    """Keys that are explored where none are given, those that change the gears first.

    Neighbours of one design have its contacts in common, so that the speed runs fastest.
    """
    built = variant.built({})
    solved = any(law.films is not None for law in built.laws)
    yield from _of_gears(built, 3 if solved else VALUES)
    point, shares = built.case.operation, np.array(FEW_SHARES if solved else SHARES)
    for name, value in ((built.carried.kind, point.load), ("speed", point.speed)):
        quantity = quantity_at(key := f"operation.{name}")
        if value and quantity is not None:
            yield Axis(key, quantity, value * shares, value)


def _of_gears(built: Ready, count: int) -> Iterator[Axis]:
    """The key that the table of the gears, of the first stage, names; none where its value is left open."""
    table, gears = built.explored
    if gears.explored is None:
        return
    inside, reach = gears.explored
    key = f"{table}.{inside}"
    quantity = quantity_at(key)
    of_case: Any = reduce(_at, inside.split("."), gears)
    if quantity is None or of_case is None:
        return
    values = np.clip(of_case + reach * np.linspace(-1.0, 1.0, count), quantity.low, quantity.high)
    yield Axis(key, quantity, np.unique(values.round(12)), float(of_case))


def _at(node: Any, part: str) -> Any:
    return node[int(part) - 1] if part.isdecimal() else getattr(node, part)


def _given(case: Case, over: Sequence[Sweep]) -> Iterator[Axis]:
    variant = case.held[0]
    keys = [sweep.key for sweep in over]
    for sweep in over:
        if keys.count(sweep.key) > 1:
            raise InputError(f"{sweep.key} is given twice", file=variant.name, key="--over")
        values, quantity = sweep_values(sweep, "--over", variant.name, variant.document().tree)
        if quantity is None:
            message = f"{sweep.key} takes names; a slider needs numbers"
            raise InputError(message, file=variant.name, key="--over")
        several = np.unique(np.array(values, float))
        if len(several) < 2:
            raise InputError(
                f"{sweep.key} was given {len(several)} value; a slider needs two at least",
                file=variant.name,
                key="--over",
            )
        of_case = case[sweep.key]
        number = (
            float(of_case)
            if isinstance(of_case, float | int)
            else float(several[len(several) // 2])
        )
        number = float(np.clip(number, several[0], several[-1]))
        if not np.isclose(several, number, rtol=ROUNDING).any():
            several = np.unique([*several, number])
        yield Axis(sweep.key, quantity, several, number)


def _computed(
    variant: Variant, changes: Mapping[str, Any] | None = None
) -> tuple[Outcome, dict[int, Outcome]]:
    """A case at one point of the grid, with those of the parts that exist, and the teeth of its stages."""
    one = replace(variant, settings={**variant.settings, **(changes or {})})
    built = one.built({})
    there = _there(built, PARTS)
    if all(one.name != "cycle" for one in there):
        there += _there(built, WITHOUT_CYCLE)
    work = [Job(each, built) for each in there]
    outcome = run_variant(one, work, folder=None, studies={}, progress=Progress())
    return outcome, _of_stages(one, built)


def _of_stages(variant: Variant, drive: Ready) -> dict[int, Outcome]:
    """Teeth of each stage that is one mesh by its number, in the order of the power."""
    outcomes = {}
    for number, stage, inside in zip(drive.numbers, drive.stages, drive.documents, strict=True):
        alone = Variant(inside.tree, inside.name, variant.variant, folder=variant.folder)
        if work := [Job(teeth, stage) for teeth in _there(stage, TEETH)]:
            outcomes[number] = run_variant(
                alone, work, folder=None, studies={}, progress=Progress(), whole=False
            )
    return outcomes


def _there(built: Ready, names: Sequence[str]) -> list[Analysis]:
    """Analyses among some that a case has; of a drive none of those of its meshes."""
    every = [ANALYSES[name] for name in names]
    alone = len(built.meshes) == 1
    return [
        part
        for part in every
        if isinstance(part, Analysis)
        and part.why_not(built) is None
        and (alone or part.of != "mesh")
    ]


def _seen(
    variant: Variant,
    axes: Sequence[Axis],
    read: Callable[[Outcome, Mapping[int, Outcome]], T],
    refused: dict[int, str],
    progress: Progress,
) -> Iterator[T | None]:
    """What is read at every point; the sentence of those that cannot be computed goes into `refused`."""
    texts = [[*case_value(axis.key, axis.values)] for axis in axes]
    for number, row in enumerate(product(*texts)):
        try:
            design = read(*_computed(variant, dict(zip((a.key for a in axes), row, strict=True))))
        except PitchpointError as error:
            refused[number] = getattr(error, "message", str(error))
            design = None
        yield design
        progress.points(number + 1)


def _errors(case: Case, axes: Sequence[Axis], figures: xr.Dataset) -> tuple[dict[str, float], int]:
    """Largest relative errors of linear interpolation at places between points, and how many there are."""
    from scipy.interpolate import RegularGridInterpolator

    cells = _outermost(axes, figures)
    rows = np.stack([axis.between[cells[:, k]] for k, axis in enumerate(axes)], axis=-1)
    if not len(rows):
        return {}, 0
    columns = {axis.key: rows[:, k] for k, axis in enumerate(axes)}
    try:
        true = study(case, columns, how="zip")
    except InputError:  # none of them can be computed
        return {}, 0
    errors: dict[str, float] = {}
    comparable = np.zeros(len(rows), bool)
    for name in main_figures(figures):
        for law in range(figures.sizes["law"]):
            over = RegularGridInterpolator([a.values for a in axes], figures[name].values[law])
            expected = true[name].values[law]
            off = np.abs(over(rows) - expected)
            least = ROUNDING * np.nanmax(np.abs(figures[name].values[law]), initial=0.0)
            counts = np.isfinite(off) & (np.abs(expected) > least)
            comparable |= counts
            worst = np.max(off[counts] / np.abs(expected[counts]), initial=0.0)
            errors[name] = max(errors.get(name, 0.0), float(worst))
    return errors, int(comparable.sum())


def _outermost(axes: Sequence[Axis], figures: xr.Dataset) -> np.ndarray:
    """Cells of the grid with figures at all corners [cell, axis]: those farthest out, and a middle one."""
    computed = np.all(figures["reason"].values == "", axis=0)
    for k, axis in enumerate(axes):
        if not axis.quantity.whole:
            count = len(axis.values) - 1
            computed = np.take(computed, range(count), k) & np.take(
                computed, range(1, count + 1), k
            )
    cells = np.argwhere(computed)
    if not len(cells):
        return cells
    place = cells / np.maximum(np.array(computed.shape) - 1, 1)
    ways = np.array([*product((-1.0, 1.0), repeat=len(axes))])
    middle = np.argmin(np.sum((place - 0.5) ** 2, axis=1))
    chosen: np.ndarray = cells[np.unique([*np.argmax(place @ ways.T, axis=0), middle])]
    return chosen
