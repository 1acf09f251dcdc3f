"""The design of a case whose numbers make one result least or largest, with others kept within limits."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from pitchpoint._jax import double_precision
from pitchpoint.analyses.strength import STRENGTH
from pitchpoint.cases.handed_over import write_case_copy
from pitchpoint.cases.record import CASE
from pitchpoint.cases.study_tables import OptimiseTable
from pitchpoint.cases.validation import validate, with_meshes
from pitchpoint.errors import ConvergenceError, InputError, shorten
from pitchpoint.registry import enumerated
from pitchpoint.results.store import make_folder
from pitchpoint.runs.case import Case, CaseLike, as_case
from pitchpoint.runs.layouts import StudyAxis
from pitchpoint.runs.optimum_search import (
    AT_LIMIT,
    ConstrainedSearch,
    Multipliers,
    even_shares,
    multipliers_of,
)
from pitchpoint.runs.optimum_task import (
    DESIGNS_FILE,
    NEW_DESIGNS,
    OptimiserTask,
    ResultLimit,
    VariedKey,
    optimiser_task,
)
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import FrictionChoice, Progress, run_case, with_user_law
from pitchpoint.runs.sought_figures import SoughtFigure, value_in

__all__ = ["Optimum", "demand_optimiser", "folder_of_optimum", "optimise", "table_of_optimiser"]

IMPROVED = 3
"""Starting points that are improved where nothing but ranges varies; one of each combination of lists."""

EQUAL = 1e-6
"""Part of a figure by which a run of the design may differ from the search, and miss an equality."""

UNBALANCED = 0.01
"""Of the spread of the aim over the designs, by a whole range: beyond it multipliers say nothing."""

ROUNDED = 1e-8
"""Part of a bound by which the digits of the case file may move a limit."""


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """The best design of a case, as a run of its file has it.

    Attributes:
        case: the design.
        title: of the case that was varied.
        aim: the result that was to be least or largest.
        largest: True if it was to be as large as can be.
        law: friction law under which results are meant.
        varied: keys between ends.
        listed: lists of values by key, of which each was tried.
        limits: constraints.
        start, best: values by key and by name of a result, of the case as given and of the design [SI], texts
            of names; not numbers where the case as given has none.
        multipliers: what limits cost; None where derivatives were not taken.
        derived: results whose derivatives are by automatic differentiation; the others are by differences.
        designs, refused: how many were computed, and how many of them have no figures.
        reasons: why, with how many there are of each, the most frequent first.
        interrupted: True if the search was ended by hand: the best design so far.
        warnings: of the run of the design, what cannot be first.
        folder: of the files; None where there are none.
    """

    case: Case
    title: str
    aim: SoughtFigure
    largest: bool
    law: str
    varied: tuple[VariedKey, ...]
    listed: Mapping[str, Sequence[Any]]
    limits: tuple[ResultLimit, ...]
    start: Mapping[str, Any]
    best: Mapping[str, Any]
    multipliers: Multipliers | None
    derived: tuple[str, ...]
    designs: int
    refused: int
    reasons: Mapping[str, int]
    interrupted: bool
    warnings: tuple[str, ...]
    folder: Path | None

    @property
    def value(self) -> float:
        """The aim at the design [SI]."""
        return float(self.best[self.aim.name])

    def share(self, varied: VariedKey) -> float:
        """Where a key lies between its ends, from 0 to 1."""
        return (float(self.best[varied.key]) - varied.low) / (varied.high - varied.low)

    def kept_as_given(self, limit: ResultLimit) -> bool:
        """True for a constraint that the case as given keeps, or has no figure for."""
        over = float(limit.kept(np.array([self.start[limit.figure.name]]))[0])
        return not (abs(over) > EQUAL if limit.way == "=" else over < -EQUAL)

    def active(self, limit: ResultLimit) -> bool:
        """True for a constraint that holds the design where it is."""
        off = abs(float(limit.kept(np.array([self.best[limit.figure.name]]))[0]))
        return limit.way == "=" or off < AT_LIMIT


@double_precision()
def optimise(
    case: CaseLike,
    vary: Mapping[str, Any] | None = None,
    *,
    minimise: str | None = None,
    maximise: str | None = None,
    subject_to: str | Sequence[str] | None = None,
    law: str | None = None,
    starts: int | None = None,
    variant: str | None = None,
    friction: FrictionChoice | None = None,
    folder: str | Path | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Optimum:
    """The values of some keys of a case that make a result least or largest, with others within limits.

    What is not given is that of the table `[optimise]` of the case; with `vary` the task is that of the call
    alone, whatever the table says.

    Args:
        case: a `Case`, or what makes one.
        vary: by key the ends between which a number may lie, "10 mm:30 mm", (0.0, 0.6) in SI, or
            {"start": ..., "stop": ...}; or a list of values, or {"values": [...]}, of which each is tried
            with each of the others, 200 combinations at most: numbers of teeth, modules of a series, oils.
        minimise, maximise: one of both, a result of a study or a main figure of a run by its name,
            "mean_loss", "root_safety", "drive_mass", of one of several with its number, "disc_mass.1".
        subject_to: what is kept, each a result, >=, <= or =, and a value with its unit: "root_safety >= 1.5",
            "centre_distance = 84 mm".
        law: friction law of the case under which results are meant, the first one by default.
        starts: evenly spread designs to begin with; 16 for each key between ends, 256 at most, by default.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run_case`.
        folder: where the best design goes as a case file, and every design that is computed as a line of a
            table, as soon as it is; nothing is written by default. Under a law of one's own there is no case
            file, which could not hold it.
        overwrite: True to replace both files, when the design is there; until then designs of the search are
            in `designs.new.csv` beside them.
        progress: told about designs.

    Returns:
        The best design. Its figures are those of a run of its case file.

    Raises:
        InputError: a key, range, result or limit that is none; no design can be computed, or none keeps the
            limits, with which of them the nearest one misses, and by how much.
        ConvergenceError: a run of the design does not say what the search did.

    Designs are computed together as those of a study. The best of the evenly spread ones are improved by
    SLSQP (Kraft 1988) with derivatives by automatic differentiation of the mesh cycle where an aim or a limit
    has them (mean loss, efficiency, input torque and torque ripple of one mesh under formulas of friction),
    and by differences otherwise; a search around the end follows limits beyond which designs are refused. An
    optimum is one among designs near those that were tried; nothing proves that there is no better one.

    Example:
        >>> import pitchpoint as pp
        >>> pp.optimise("tian2024", {"gears.profile_shift": "0.6:0"}, minimise="mean_loss")
        Traceback (most recent call last):
            ...
        pitchpoint.errors.InputError: tian2024: gears.profile_shift: from 0.6 to 0 is no range; write "0:0.6"
    """
    given: dict[str, Any] = {
        "vary": vary,
        "minimise": minimise,
        "maximise": maximise,
        "subject_to": subject_to,
    }
    demand_arguments(**given, law=law, starts=starts, variant=variant)
    demand_arguments(friction=friction, folder=folder, overwrite=overwrite)
    held = as_case(case)
    chosen = Case(held, variant=held.variants[0] if variant is None else variant)
    base = chosen.held[0] if friction is None else with_user_law(chosen.held[0], friction)
    stated = {name: value for name, value in given.items() if value is not None}
    table = table_of_optimiser(chosen)
    if vary is None and table is None:
        told = "an optimiser needs keys to vary, as vary, or a table [optimise] in the case"
        raise InputError(told, file=chosen.name)
    if vary is None and table is not None:
        aimed = {"minimise", "maximise"} & stated.keys()
        of_table: dict[str, Any] = {"vary": table.by_key, "subject_to": table.subject_to}
        aims = {} if aimed else {"minimise": table.minimise, "maximise": table.maximise}
        stated = {**of_table, **aims, **stated}
        law, starts = law or table.law or None, starts or int(table.starts or 0) or None
        folder = folder or folder_of_optimum(table, chosen)
    task = optimiser_task(chosen, base, stated, law, starts, friction)
    return _solved(
        task, None if folder is None else Path(folder), overwrite, progress or Progress()
    )


def table_of_optimiser(case: Case) -> OptimiseTable | None:
    """The table `[optimise]` of the first variant of a case; None where it has none.

    Raises:
        InputError: the case cannot be read.
    """
    document = case.held[0].document()
    return validate(with_meshes(document)).optimise if "optimise" in document.tree else None


def folder_of_optimum(table: OptimiseTable | None, case: Case) -> Path | None:
    """Folder of an optimum as its table says, from that of the case file on; None where it says none."""
    if table is None or not table.folder:
        return None
    return (case.held[0].folder or Path()) / table.folder


def demand_optimiser(case: Case) -> None:
    """InputError for what is wrong with the table `[optimise]` of the first variant of a case, if any."""
    table = table_of_optimiser(case)
    if table is not None:
        stated = table.model_dump(include={"minimise", "maximise", "subject_to"})
        optimiser_task(
            case, case.held[0], {"vary": table.by_key, **stated}, table.law or None, None, None
        )


def _solved(
    task: OptimiserTask, folder: Path | None, overwrite: bool, progress: Progress
) -> Optimum:
    """Search, then run what was found."""
    if folder is not None:
        make_folder(folder)
        _demand_free(task, folder, overwrite)
    start = {name: float(values[0]) for name, values in task.values([{}])[0].items()}
    task.file.rows.clear()
    if folder is not None:
        earlier = any((folder / name).exists() for name in (CASE, DESIGNS_FILE))
        task.file.path = folder / (NEW_DESIGNS if earlier else DESIGNS_FILE)
        task.file.path.unlink(missing_ok=True)
    searches: list[tuple[dict[str, Any], ConstrainedSearch]] = []
    interrupted = False
    try:
        _search_all(task, searches, progress)
    except KeyboardInterrupt:
        interrupted = True
    reached = [(combination, search, search.best) for combination, search in searches]
    tried = [
        (combination, search, *best) for combination, search, best in reached if best is not None
    ]
    if not tried:
        if interrupted:
            raise KeyboardInterrupt
        raise _none(task)
    order = searches[0][1].order(np.array([columns for *_, columns in tried]))
    combination, search, point, columns = tried[int(order[0])]
    missed = search.missed(columns[None])[0]
    if missed.any():
        raise _infeasible(task, combination, point, columns, missed, interrupted)
    multipliers = None
    if task.varied and not interrupted:
        with suppress(KeyboardInterrupt):
            multipliers = multipliers_of(search.slopes(point), columns, point, search.equal)
            if multipliers.unbalanced > UNBALANCED * search.spread:
                multipliers = None
    changes = _written_out(task, combination, point)
    best, warnings = _ran(task, changes, columns, search.spread)
    if folder is not None and task.file.path is not None:
        # No case file holds a law of one's own, least of all that of another design.
        if task.base.own:
            (folder / CASE).unlink(missing_ok=True)
        else:
            document = task.base.computed.document(**changes)
            title = _title_of_best(task, document.tree)
            write_case_copy(replace(document, tree={**document.tree, "title": title}), folder)
        task.file.path.replace(folder / DESIGNS_FILE)
    return _optimum(
        task,
        changes=changes,
        start=start,
        best=best,
        multipliers=multipliers,
        interrupted=interrupted,
        warnings=warnings,
        folder=folder,
    )


def _demand_free(task: OptimiserTask, folder: Path, overwrite: bool) -> None:
    """InputError where results would take the place of the case that is varied, or of others unasked."""
    varied, design = (task.base.folder or Path()) / CASE, folder / CASE
    of_case = Path(task.base.name).name == CASE and task.base.folder is not None
    if of_case and design.exists() and varied.exists() and design.samefile(varied):
        raise InputError(
            "is the case that is varied; name another folder for the design", file=str(design)
        )
    for path in (design, folder / DESIGNS_FILE):
        if path.exists() and not overwrite:
            raise InputError("is there already; name another folder, or overwrite", file=str(path))


def _search_all(
    task: OptimiserTask,
    searches: list[tuple[dict[str, Any], ConstrainedSearch]],
    progress: Progress,
) -> None:
    """Search among the designs of each combination of lists, those that begin best first."""
    combinations = task.combinations
    several = len(combinations) > 1
    spread = (
        even_shares(
            max(task.starts // len(combinations), 4) if several else task.starts, len(task.varied)
        )
        if task.varied
        else np.zeros((1, 0))
    )
    here = _shares_of_case(task)
    begun: list[tuple[ConstrainedSearch, list[np.ndarray]]] = []
    progress.part(task.base.variant, "starting designs", False)
    for combination in combinations:
        search = task.search(combination)
        searches.append((combination, search))
        points = spread if here is None else np.vstack([here[None], spread])
        begun.append((search, search.starts(points, 1 if several else IMPROVED)))
        progress.points(len(task.file.rows), "starting designs")
    if not task.varied:
        return
    firsts = np.array(
        [np.full(1 + len(task.limits), np.nan) if s.best is None else s.best[1] for s, _ in begun]
    )
    for number in begun[0][0].order(firsts):
        search, points = begun[number]
        for point in points:
            progress.points(len(task.file.rows), _so_far(task, searches))
            search.improve(point)
    best = min(searches, key=lambda entry: _rank(entry[1]))[1]
    progress.points(len(task.file.rows), _so_far(task, searches))
    best.look_around()


def _rank(search: ConstrainedSearch) -> tuple[float, float]:
    if search.best is None:
        return np.inf, np.inf
    columns = search.best[1]
    return float(search.missed(columns[None]).max(initial=0.0)), float(columns[0])


def _so_far(
    task: OptimiserTask, searches: Sequence[tuple[Mapping[str, Any], ConstrainedSearch]]
) -> str:
    """The best design so far, for progress."""
    off, aim = min(_rank(search) for _, search in searches)
    if off or not np.isfinite(aim):
        return "none keeps all limits yet"
    return f"{task.aim.name} {task.aim.told(-aim if task.largest else aim)} so far"


def _shares_of_case(task: OptimiserTask) -> np.ndarray | None:
    """Where the case as given lies in the ranges; None where it lies outside, or gives no number."""
    shares = []
    for one in task.varied:
        value = _value_of_case(task, one.axis)
        if not isinstance(value, float) or not one.low <= value <= one.high:
            return None
        shares.append((value - one.low) / (one.high - one.low))
    return np.array(shares) if shares else None


def _value_of_case(task: OptimiserTask, axis: StudyAxis) -> Any:
    """Value of a key as given [SI], or its text; None where the case leaves it open."""
    try:
        value = task.case[axis.key]
    except InputError:
        value = None
    if not isinstance(value, int | float | str):  # of gears that stand for several meshes
        value = task.base.document().tree
        for part in axis.key.split("."):
            value = value.get(part) if isinstance(value, Mapping) else None
    if isinstance(value, str) and axis.quantity is not None:
        return axis.quantity.si(value)
    if isinstance(value, int | float):
        return float(value)
    return value if isinstance(value, str) else None


def _none(task: OptimiserTask) -> InputError:
    count, reasons = len(task.file.rows), task.file.reasons
    told = f"none of {count} designs has figures"
    if reasons:
        why, of = next(iter(reasons.items()))
        return InputError(f"{told}; {of} of them: {shorten(why, 300)}", file=task.case.name)
    lacking = [
        name
        for name in task.file.rows[0][1]
        if all(np.isnan(values[name]) for _, values, _ in task.file.rows)
    ]
    told = f"{enumerated(lacking)} is not a number in any of {count} designs"
    return InputError(told, file=task.case.name)


def _infeasible(
    task: OptimiserTask,
    combination: Mapping[str, Any],
    point: np.ndarray,
    columns: np.ndarray,
    missed: np.ndarray,
    interrupted: bool,
) -> InputError:
    """Which limits the nearest design misses, and by how much."""
    at = ", ".join(
        f"{key} = {value}" for key, value in _written_out(task, combination, point).items()
    )
    words = []
    for limit, kept, off in zip(task.limits, columns[1:], missed, strict=True):
        if off:
            over = -kept if limit.way == "<=" else kept
            value = limit.bound + over * (abs(limit.bound) or 1.0)
            words.append(f"{limit.text} by {100.0 * off:.3g} %, with {limit.figure.told(value)}")
    ended = " before it was ended by hand" if interrupted else ""
    told = (
        f"none of {len(task.file.rows)} designs keeps all limits{ended}; the nearest, {at}, misses"
    )
    return InputError(f"{told} {'; '.join(words)}", file=task.case.name, key="subject_to")


def _written_out(
    task: OptimiserTask, combination: Mapping[str, Any], point: np.ndarray
) -> dict[str, Any]:
    """Values of a design by key as its case file has them."""
    ranges = {
        one.key: one.rounded(float(share)) for one, share in zip(task.varied, point, strict=True)
    }
    return {**combination, **ranges}


def _ran(
    task: OptimiserTask, changes: Mapping[str, Any], columns: np.ndarray, spread: float
) -> tuple[dict[str, float], tuple[str, ...]]:
    """Figures of a run of the file of a design, and what warns of it; ConvergenceError where they differ.

    Args:
        task: what is asked.
        changes: values of the design by key.
        columns: its aim and constraints as the search had them.
        spread: of the aim over all designs.
    """
    parts = ["operation", *(["strength"] if STRENGTH.why_not(task.built) is None else [])]
    parts += [one.part_of_run for one in task.figures if one.part_of_run]
    with TemporaryDirectory() as place:
        write_case_copy(task.base.computed.document(**changes), Path(place))
        file = str(Path(place) / CASE)
        ran = run_case(file, analyses=[*dict.fromkeys(parts)], friction=task.friction)
    (outcome,) = ran.values()
    best = {one.name: value_in(outcome, one, task.law) for one in task.figures}
    again = task.columns({name: np.array([value]) for name, value in best.items()})[0]
    scale = np.concatenate([[max(abs(columns[0]), spread)], np.ones(len(task.limits))])
    inside = np.where(task.equal, 2.0 * EQUAL - np.abs(again[1:]), again[1:] + ROUNDED)
    if not np.all(inside >= 0.0) or not np.all(np.abs(again - columns) <= EQUAL * scale):
        gives = task.aim.told(best[task.aim.name])
        expected = task.aim.told(-columns[0] if task.largest else columns[0])
        design = "; ".join(f"{key} = {value}" for key, value in changes.items())
        raise ConvergenceError(
            f"a run of the best design ({design}) gives {task.aim.name} {gives} where the search had "
            f"{expected}, or misses a limit; nothing is returned"
        )
    return best, (*outcome.manifest["implausible"], *outcome.manifest["briefs"])


def _title_of_best(task: OptimiserTask, tree: Mapping[str, Any]) -> str:
    """By the name of the file where there is one: the title of a sized design has the figures of before."""
    name = str(tree.get("title", "")) if task.base.folder is None else Path(task.case.name).stem
    best = f"{'largest' if task.largest else 'least'} {task.aim.quantity.long_name}"
    return f"{name}, {best}" if name else best.capitalize()


def _optimum(
    task: OptimiserTask,
    *,
    changes: Mapping[str, Any],
    start: Mapping[str, float],
    best: Mapping[str, float],
    **named: Any,
) -> Optimum:
    """What is returned.

    Args:
        task: what was asked.
        changes: values of the design by key.
        start, best: figures of the case as given and of the design.
        named: the other attributes.
    """
    axes = [*(one.axis for one in task.varied), *task.listed]
    of_keys = {
        axis.key: axis.quantity.si(changes[axis.key]) if axis.quantity else changes[axis.key]
        for axis in axes
    }
    return Optimum(
        case=task.case.set(changes),
        title=str(task.base.document().tree.get("title", task.case.name)),
        aim=task.aim,
        largest=task.largest,
        law=task.law,
        varied=task.varied,
        listed={axis.key: axis.values for axis in task.listed},
        limits=task.limits,
        start={**{axis.key: _value_of_case(task, axis) for axis in axes}, **start},
        best={**of_keys, **best},
        derived=task.derived,
        designs=len(task.file.rows),
        refused=sum(bool(why) for _, _, why in task.file.rows),
        reasons=task.file.reasons,
        **named,
    )
