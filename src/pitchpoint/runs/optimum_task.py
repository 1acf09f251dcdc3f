"""What an optimiser is asked, checked, and the figures of its designs, each kept as soon as it is there."""

import csv
import io
import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Bool, Float

from pitchpoint import units
from pitchpoint._jax import jax
from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.analyses.strength import why_no_safety
from pitchpoint.analyses.studies import demand_one
from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.study_tables import STARTS, Sweep
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.gradients import figure_gradient
from pitchpoint.errors import Complaints, ConvergenceError, InputError, PitchpointError
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest
from pitchpoint.runs.case import Case, case_value
from pitchpoint.runs.layouts import StudyAxis
from pitchpoint.runs.optimum_search import STEP, ConstrainedSearch
from pitchpoint.runs.run import FrictionChoice, Outcome, run_case
from pitchpoint.runs.sought_figures import SoughtFigure, value_in, values_of_study

__all__ = [
    "DESIGNS_FILE",
    "NEW_DESIGNS",
    "OptimiserTask",
    "ResultLimit",
    "VariedKey",
    "optimiser_task",
]

MOST_COMBINATIONS = 200
"""Products of lists of values that are tried one by one."""

OF_EACH_KEY, MOST_STARTS = 16, 256
"""Evenly spread designs to begin with for each key that varies, and of all, unless a number is given."""

DIGITS = 10
"""Of varied numbers in the case file."""

DIFFERENTIABLE = {
    "mean_loss": "mean_loss",
    "mean_efficiency": "mean_efficiency",
    "mean_input_torque": "mean_input_torque",
    "torque_ripple": "ripple",
}
"""Figures of the mesh cycle with derivatives by automatic differentiation, and their names there."""

DESIGNS_FILE = "designs.csv"
"""File in the folder with every design that was computed."""

NEW_DESIGNS = "designs.new.csv"
"""The same as long as results of an earlier search stand beside it."""

_LIMIT = re.compile(r"\s*([\w.]{1,200}?)\s*(>=|<=|==|=|≥|≤|>|<)\s*([^<>=]{1,100}?)\s*")
_STRENGTH = re.compile(r"(?:^|\.)(?:materials|strength)\.")
"""Keys that decide which limits of materials are known."""

_WAYS = {">": ">=", "≥": ">=", "<": "<=", "≤": "<=", "==": "="}


@dataclass(frozen=True)
class VariedKey:
    """A key between two ends.

    Attributes:
        axis: of the key, with its ends.
        low, high: ends [SI].
    """

    axis: StudyAxis
    low: float
    high: float

    @property
    def key(self) -> str:
        """Dotted, of the case file."""
        return self.axis.key

    def value(self, share: float) -> float:
        """Value at a share of the range [SI]."""
        return self.low + share * (self.high - self.low)

    def rounded(self, share: float) -> Any:
        """The same as a case file has it, in the unit in which it is shown."""
        value, quantity = self.value(share), self.axis.quantity
        assert quantity is not None
        number = (
            value if quantity.unit == "1" else units.convert(value, quantity.unit, quantity.kind)
        )
        text = f"{number:.{DIGITS}g}"
        return float(text) if quantity.unit == "1" else f"{text} {quantity.unit}"


@dataclass(frozen=True)
class ResultLimit:
    """A constraint on a result.

    Attributes:
        text: as it was given.
        figure: the result.
        way: ">=", "<=" or "=".
        bound: its value [SI].
    """

    text: str
    figure: SoughtFigure
    way: str
    bound: float

    def kept(self, values: Float[np.ndarray, " design"]) -> Float[np.ndarray, " design"]:
        """By what part of the bound it is kept, negative where it is not."""
        over = (values - self.bound) / (abs(self.bound) or 1.0)
        return -over if self.way == "<=" else over


@dataclass(frozen=True, eq=False)
class OptimiserTask:
    """What is asked of an optimiser, and how its designs are computed.

    Attributes:
        case, base: as given, and its variant with laws of friction.
        built: the case.
        law: name of the friction law.
        varied: keys between ends.
        listed: axes of lists of values.
        aim, largest, limits: see `Optimum`.
        starts: evenly spread designs.
        friction: laws of one's own.
        file: every design that was computed.
    """

    case: Case
    base: Variant
    built: Ready
    law: str
    varied: tuple[VariedKey, ...]
    listed: tuple[StudyAxis, ...]
    aim: SoughtFigure
    largest: bool
    limits: tuple[ResultLimit, ...]
    starts: int
    friction: FrictionChoice | None
    file: "_DesignsTable" = field(default_factory=lambda: _DesignsTable())

    @property
    def figures(self) -> list[SoughtFigure]:
        """Aim and constrained results, each once."""
        return [
            *{one.name: one for one in (self.aim, *(lim.figure for lim in self.limits))}.values()
        ]

    @property
    def equal(self) -> Bool[np.ndarray, " constraint"]:
        """Which limits are equalities."""
        return np.array([limit.way == "=" for limit in self.limits], bool)

    @property
    def combinations(self) -> list[dict[str, Any]]:
        """Values of the lists, each with each of the others."""
        keys = [axis.key for axis in self.listed]
        return [
            dict(zip(keys, row, strict=True)) for row in product(*(a.values for a in self.listed))
        ]

    def changes(self, combination: Mapping[str, Any], shares: np.ndarray) -> list[dict[str, Any]]:
        """Values by key of designs at shares of the ranges."""
        return [
            {
                **combination,
                **{
                    one.key: case_value(one.key, one.value(float(share)))
                    for one, share in zip(self.varied, row, strict=True)
                },
            }
            for row in shares
        ]

    def values(
        self, changes: Sequence[Mapping[str, Any]]
    ) -> tuple[dict[str, np.ndarray], list[str]]:
        """Figures of designs by name, and why they have none; each is a line of the file at once."""
        study = CaseDesigns(self.base.computed, changes).compute()
        reasons = study["reason"].sel(law=self.law).values.astype(str).tolist()
        figures = {
            one.name: values_of_study(study, one, self.law, len(changes))
            for one in self.figures
            if not one.part
        }
        beside = [one for one in self.figures if one.part]
        for number, change in enumerate(changes) if beside else ():
            outcome = None
            try:
                outcome = self.outcome(change, [one.part for one in beside])
            except PitchpointError as error:
                reasons[number] = reasons[number] or str(getattr(error, "message", error))
            for one in beside:
                column = figures.setdefault(one.name, np.full(len(changes), np.nan))
                if outcome is not None:
                    column[number] = value_in(outcome, one, self.law)
        self.file.add(changes, figures, reasons)
        return figures, reasons

    def outcome(self, change: Mapping[str, Any], parts: Sequence[str]) -> Outcome:
        """A run of a design, of some of its parts."""
        names = [self.base.variant]
        ran = run_case(
            self.case, only=names, analyses=parts, settings={**change}, friction=self.friction
        )
        return ran[self.base.variant]

    def columns(self, figures: Mapping[str, np.ndarray]) -> Float[np.ndarray, "design column"]:
        """Aim, less is better, and by what part each limit is kept; not numbers where one is not."""
        sign = -1.0 if self.largest else 1.0
        rows = [
            sign * figures[self.aim.name],
            *(lim.kept(figures[lim.figure.name]) for lim in self.limits),
        ]
        columns = np.stack(rows, axis=1)
        return np.where(np.isnan(columns).any(axis=1, keepdims=True), np.nan, columns)

    def search(self, combination: Mapping[str, Any]) -> ConstrainedSearch:
        """The search among designs of one combination of lists."""

        def evaluate(shares: np.ndarray) -> np.ndarray:
            return self.columns(self.values(self.changes(combination, shares))[0])

        def derive(point: np.ndarray) -> np.ndarray:
            return self._derivatives(combination, point)

        return ConstrainedSearch(evaluate, derive, self.equal)

    @cached_property
    def derived(self) -> tuple[str, ...]:
        """Figures with derivatives by automatic differentiation: those of a mesh cycle under formulas."""
        plain = not self.built.numbers and self.built.case.models.averaging != "path"
        formulas = plain and self._models(self.built).law.films is None
        return tuple(
            one.name
            for one in self.figures
            if formulas and not one.part and one.variable in DIFFERENTIABLE
        )

    def _models(self, built: Ready) -> Any:
        return next(models for models in built.models if models.law.name == self.law)

    def _derivatives(self, combination: Mapping[str, Any], point: np.ndarray) -> np.ndarray:
        """Derivatives [column, key] by shares; not numbers where differences have to do.

        What a key does to the numbers of the design, which is built on the host, is by differences.
        """
        slopes = np.full((1 + len(self.limits), len(point)), np.nan)
        by_name = self._automatic(combination, point) if self.derived else {}
        if self.aim.name in by_name:
            slopes[0] = -by_name[self.aim.name] if self.largest else by_name[self.aim.name]
        for row, limit in enumerate(self.limits, 1):
            if limit.figure.name in by_name:
                over = by_name[limit.figure.name] / (abs(limit.bound) or 1.0)
                slopes[row] = -over if limit.way == "<=" else over
        return slopes

    def _automatic(
        self, combination: Mapping[str, Any], point: np.ndarray
    ) -> dict[str, Float[np.ndarray, " key"]]:
        """Derivatives of figures by shares; none where a design beside is refused or of another form."""
        keys = np.eye(len(point), dtype=bool)
        low, high = (np.clip(point + way * STEP, 0.0, 1.0) for way in (-1.0, 1.0))
        beside = [np.where(key, end, point) for key in keys for end in (low, high)]
        built = self.base.built_each(self.changes(combination, np.vstack([point, *beside])))
        meshes = [one.meshes[0] for one in built if not isinstance(one, InputError)]
        forms, numbers = zip(*map(_numbers_of, meshes), strict=True) if meshes else ((), ())
        if len(meshes) < len(built) or any(form != forms[0] for form in forms):
            return {}
        per_key = zip(numbers[1::2], numbers[2::2], high - low, strict=True)
        by_key = [[(b - a) / width for a, b in zip(*ends, strict=True)] for *ends, width in per_key]
        by_name = {}
        for figure in (one for one in self.figures if one.name in self.derived):
            name, models = DIFFERENTIABLE[figure.variable], self._models(meshes[0])
            with suppress(ConvergenceError):
                _, inputs = figure_gradient(meshes[0].design, meshes[0].operation, models, name)
                leaves = [np.asarray(leaf) for leaf in jax.tree.leaves(inputs)]
                by_name[figure.name] = np.array(
                    [sum(np.sum(a * b) for a, b in zip(leaves, of, strict=True)) for of in by_key]
                )
        return by_name


def _numbers_of(mesh: Built) -> tuple[Any, list[np.ndarray]]:
    """Form of a design and its operating point, and its continuous numbers; zero where one is not known."""
    held = eqx.filter((mesh.design, mesh.operation), eqx.is_inexact_array)
    leaves = [np.nan_to_num(np.asarray(leaf), nan=0.0) for leaf in jax.tree.leaves(held)]
    return (jax.tree.structure(held), [leaf.shape for leaf in leaves]), leaves


@dataclass(eq=False)
class _DesignsTable:
    """Every design that was computed, in memory and as lines of a table on disk."""

    path: Path | None = None
    rows: list[tuple[Mapping[str, Any], dict[str, float], str]] = field(default_factory=list)

    def add(
        self,
        changes: Sequence[Mapping[str, Any]],
        figures: Mapping[str, np.ndarray],
        reasons: Sequence[str],
    ) -> None:
        """Keep designs; lines are whole, and on disk before the next designs are computed."""
        begun = len(self.rows)
        for number, (change, why) in enumerate(zip(changes, reasons, strict=True)):
            values = {name: float(column[number]) for name, column in figures.items()}
            self.rows.append((change, values, why))
        if self.path is None:
            return
        text = io.StringIO()
        lines = csv.writer(text, lineterminator="\n")
        if not begun and self.rows:
            lines.writerow([*self.rows[0][0], *(f"{name} [SI]" for name in figures), "reason"])
        for change, values, why in self.rows[begun:]:
            cells = ("" if np.isnan(value) else repr(value) for value in values.values())
            lines.writerow([*change.values(), *cells, why])
        with self.path.open("a", encoding="utf-8") as file:
            file.write(text.getvalue())

    @property
    def reasons(self) -> dict[str, int]:
        """Why designs have no figures, the most frequent reason first."""
        counted: dict[str, int] = {}
        for _, _, why in self.rows:
            if why:
                counted[why] = counted.get(why, 0) + 1
        return dict(sorted(counted.items(), key=lambda entry: -entry[1]))


def optimiser_task(
    case: Case,
    base: Variant,
    stated: Mapping[str, Any],
    law: str | None,
    starts: int | None,
    friction: FrictionChoice | None,
) -> OptimiserTask:
    """What is asked, checked; InputError for all that is wrong."""
    if starts is not None:
        try:
            STARTS.read(starts)
        except InputError as error:
            raise error.at(key="starts") from None
    built = base.built({})
    laws = [models.law.name for models in built.models]
    if law is not None and law not in laws:
        raise InputError(
            f"{shown(law)} is no friction law of the case{nearest(law, laws)}", key="law"
        )
    study = CaseDesigns(base.computed, [{}]).compute()
    if "mean_loss" not in study and (why := study["reason"].values.ravel().tolist()):
        study = study.drop_vars("reason")
        told = f"the case as given has no figures ({why[0]}); begin from one that has"
        raise InputError(told, file=case.name)
    wrong = Complaints(case.name)
    keys = [wrong.tried(_varied, base, case, *entry) for entry in dict(stated["vary"]).items()]
    names = {key: stated.get(key) or None for key in ("minimise", "maximise")}
    if (names["minimise"] is None) == (names["maximise"] is None):
        wrong.add(
            InputError(
                'give one result, minimise "mean_loss" or maximise "mean_efficiency"',
                key="minimise",
            )
        )
    largest = names["maximise"] is not None
    aim = wrong.tried(_aimed_at, str(names["maximise"] or names["minimise"]), study, built, largest)
    texts = stated.get("subject_to") or ()
    limits = [
        wrong.tried(_limit, text, study, built)
        for text in ([texts] if isinstance(texts, str) else texts)
    ]
    if not keys:
        wrong.add(InputError('names no key; write "gears.profile_shift.1" = "0:0.6"', key="vary"))
    wrong.demand_none()
    assert aim is not None
    law = law or laws[0]
    if not any(_STRENGTH.search(one.key) for one in keys if one is not None):
        asked = {"maximise" if largest else "minimise": aim}
        asked |= {f"subject_to {limit.text}": limit.figure for limit in limits if limit is not None}
        for place, figure in asked.items():
            lack = _why_no_figure(figure, study, built, law)
            if lack:
                raise InputError(f"{figure.name} is not known: {lack}", file=case.name, key=place)
    varied = tuple(one for one in keys if isinstance(one, VariedKey))
    listed = tuple(one for one in keys if isinstance(one, StudyAxis))
    count = int(np.prod([len(axis.values) for axis in listed], initial=1))
    if count > MOST_COMBINATIONS:
        told = f"lists of values make {count} combinations; at most {MOST_COMBINATIONS} are tried one by one"
        raise InputError(f"{told}: shorten them, or draw by pitchpoint study", key="vary")
    usual = min(OF_EACH_KEY * max(len(varied), 1), MOST_STARTS)
    return OptimiserTask(
        case=case,
        base=base,
        built=built,
        law=law,
        varied=varied,
        listed=listed,
        aim=aim,
        largest=largest,
        limits=tuple(limit for limit in limits if limit is not None),
        starts=(starts or usual) if varied else 0,
        friction=friction,
    )


def _why_no_figure(figure: SoughtFigure, study: Any, built: Ready, law: str) -> str:
    """Why no design has a safety that the case as given lacks; empty where some may have it."""
    if figure.part or not figure.variable.endswith("_safety"):
        return ""
    return why_no_safety(built) if np.isnan(values_of_study(study, figure, law, 1)[0]) else ""


def _aimed_at(name: str, study: Any, built: Ready, largest: bool) -> SoughtFigure:
    try:
        return SoughtFigure.named(name, study, built)
    except InputError as error:
        raise error.at(key="maximise" if largest else "minimise") from None


def _limit(text: Any, study: Any, built: Ready) -> ResultLimit:
    match = _LIMIT.fullmatch(text) if isinstance(text, str) else None
    if match is None:
        told = f'{shown(text)} is no limit; write a result, >=, <= or =, and a value: "root_safety >= 1.5"'
        raise InputError(told, key="subject_to", value=text)
    name, way, value = match.groups()
    try:
        figure = SoughtFigure.named(name, study, built)
        plain = (
            value.removesuffix(f" {figure.quantity.unit}") if figure.quantity.unit != "1" else value
        )
        bound = units.parse(
            value if figure.quantity.kind != "dimensionless" else plain, figure.quantity.kind
        )
    except InputError as error:
        raise InputError(error.message, key=f"subject_to {text.strip()}", value=text) from None
    return ResultLimit(text.strip(), figure, _WAYS.get(way, way), bound)


def _varied(base: Variant, case: Case, name: str, stated: Any) -> VariedKey | StudyAxis:
    """A key between ends, or with a list of values; InputError for what is neither."""
    key = case.key(name)
    values, between = _ends_or_values(stated)
    axis = StudyAxis.of(base, key, values)
    try:
        _demand_one_gear(base, axis)
        if between is None:
            between = False
            if axis.quantity is not None and not axis.quantity.whole and len(values) == 2:
                first, second = (str(shown(value)).strip('"') for value in axis.values)
                told = f'"{first}:{second}" for all values between, or {{ values = [...] }} for these two'
                raise InputError(f"{shown(values)} may be two ends or two values; write {told}")
        if axis.quantity is not None:
            for value in axis.values:
                axis.quantity.read(value)
        if not between:
            return axis
        if axis.quantity is None:
            raise InputError(
                f'{shown(stated)} has no numbers between; give names as a list, ["a", "b"]'
            )
        if axis.quantity.whole:
            low, high = axis.ends
            few = ", ".join(f"{number:g}" for number in np.arange(low, high + 1.0)[:3])
            raise InputError(
                f"is a count, of which values are tried one by one; write a list, [{few}]"
            )
        low, high = (axis.quantity.si(value) for value in axis.values)
        if not high > low:
            ends = [str(value) for value in axis.values]
            told = "is no range" + (
                f'; write "{ends[1]}:{ends[0]}"' if high < low else "; give two ends"
            )
            raise InputError(f"from {ends[0]} to {ends[1]} {told}")
    except InputError as error:
        raise error.at(key=key) from None
    return VariedKey(axis, low, high)


def _demand_one_gear(base: Variant, axis: StudyAxis) -> None:
    """InputError where one number would set both gears, to which the case gives different ones."""
    try:
        demand_one(base, Sweep(key=axis.key, values=tuple(axis.values[:1])), "vary")
    except InputError as error:
        raise InputError(error.message.replace("; sweep ", "; vary "), file=error.file) from None


def _ends_or_values(stated: Any) -> tuple[list[Any], bool | None]:
    """Two ends, True, or values to try, False; None where a list of two may be either."""
    if isinstance(stated, str):
        ends = [end.strip() for end in stated.split(":")]
        if len(ends) == 2 and all(ends):
            return [*ends], True
        raise InputError(
            f'{shown(stated)} is neither two ends, "10 mm:30 mm", nor a list of values'
        )
    if isinstance(stated, Mapping):
        if set(stated) == {"values"} and isinstance(stated["values"], list | tuple):
            return [*stated["values"]], False
        if set(stated) == {"start", "stop"}:
            return [stated["start"], stated["stop"]], True
        raise InputError(f"{shown(dict(stated))} has neither start and stop nor values alone")
    if isinstance(stated, tuple) and len(stated) == 2:
        return [*stated], True
    if isinstance(stated, list) and stated:
        return stated, None
    raise InputError(f'{shown(stated)} is neither two ends, "10 mm:30 mm", nor a list of values')
