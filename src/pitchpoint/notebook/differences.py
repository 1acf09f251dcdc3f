"""Derivatives of any figure of a study by differences: of several meshes too, of stresses and safeties."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.analyses.strength import why_no_safety
from pitchpoint.cases.document import leaves
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.registry import nearest
from pitchpoint.runs.case import case_value
from pitchpoint.runs.sought_figures import NO_FIGURES

__all__ = [
    "MADE",
    "OTHER_FORM",
    "STILL",
    "CaseNumber",
    "Differences",
    "by_differences",
    "continuous",
    "derivative_of",
    "numbers_of_file",
    "setting_of",
]

STEP = 1e-4
"""Larger step over the value, or over the unit in which it is shown for a value of zero."""

ZERO = 1e-9
"""Value, in the unit in which it is shown, up to which it is zero with what rounding leaves."""

SMOOTH = 0.02
"""How far, over the larger one, both differences of a smooth figure may lie apart."""

ROUNDING = 1e-9
"""Change of a figure over its value that is left to solvers."""

LEFT = 1e-13
"""The same of a figure that is zero, in whatever SI unit: a backlash of teeth that fit, say."""

TABLES = (
    *("gears", "stages", "materials", "lubricant", "roughness", "operation", "losses"),
    *("strength", "dynamics", "train"),
)
"""Tables whose numbers are differentiated by."""

MADE = ("gears.deviations.", "gears.inspection.")
"""Keys of gears as they are made and measured, which move no figure of a cycle or a rating."""

OTHER_FORM = "has no derivative here: any change of it makes gears of another form, or none"
STILL = "does not move it"
"""Why a key has no derivative."""


@dataclass(frozen=True)
class CaseNumber:
    """A number of a case file.

    Attributes:
        key: dotted, of one of two gears with its number.
        value: [SI].
        quantity: kind and range.
        setting: key and value as a file has them, for another number [SI].
    """

    key: str
    value: float
    quantity: Quantity
    setting: Callable[[float], tuple[str, Any]]

    @property
    def step(self) -> float:
        """Change of the number by which differences are taken [SI]."""
        one, none = (self.quantity.si(f"{k} {self.quantity.unit}") for k in (1, 0))
        size = one - none  # of a temperature too, whose zero is not that of its unit
        return STEP * (abs(self.value) if abs(self.value) > ZERO * size else size)


@dataclass(frozen=True)
class Differences:
    """A figure and its derivatives.

    Attributes:
        value: of the case [SI].
        unit: of the figure.
        by_key: derivatives by key [SI].
        without: sentences on keys that have none.
    """

    value: float
    unit: str
    by_key: Mapping[str, float]
    without: Mapping[str, str]


def continuous(key: str, tree: Mapping[str, Any] | None = None) -> Quantity | None:
    """What the number at a key is; None for counts and where there is none.

    Args:
        key: dotted.
        tree: plain values of the case.
    """
    try:
        quantity = quantity_at(key, tree)
    except InputError:
        return None
    return None if quantity is None or quantity.whole else quantity


def numbers_of_file(base: Variant) -> Iterator[CaseNumber]:
    """Numbers that a case states, those of two gears apart.

    Args:
        base: the case.
    """
    tree = base.document().tree
    for key, value in leaves({name: tree[name] for name in TABLES if name in tree}):
        quantity = continuous(key, tree)
        if quantity is None or any(part in key for part in MADE):
            continue
        try:
            if not isinstance(value, list | tuple):
                yield CaseNumber(key, quantity.si(value), quantity, setting_of(key))
                continue
            every = [quantity.si(one) for one in value]
        except InputError:
            continue  # a name in the place of a number
        for place, one in enumerate(every):
            setting = setting_of(key, every, place)
            yield CaseNumber(f"{key}.{place + 1}", one, quantity, setting)


def setting_of(
    key: str, every: Sequence[float] = (), place: int = 0
) -> Callable[[float], tuple[str, Any]]:
    """What sets a number, see `CaseNumber`.

    Args:
        key: dotted.
        every: numbers of a list; none where it is one number.
        place: of the number in the list.
    """

    def setting(value: float) -> tuple[str, Any]:
        if not every:
            return key, case_value(key, value)
        return key, case_value(key, [*every[:place], value, *every[place + 1 :]])

    return setting


def by_differences(
    base: Variant, of: str, numbers: Sequence[CaseNumber], law: str | None = None
) -> Differences:
    """Derivatives of a figure of a study, extrapolated from differences with two steps.

    At the end of a range they are one-sided.

    Args:
        base: the case.
        of: name of the figure.
        numbers: by which to differentiate.
        law: friction law of the case, the first one by default.

    Raises:
        InputError: no such figure or law, or a case that has no figures.
    """
    steps = [one.step for one in numbers]
    changes: list[dict[str, Any]] = [{}]
    for one, step in zip(numbers, steps, strict=True):
        changes += [dict([one.setting(one.value + part * step)]) for part in _PARTS]
    data = CaseDesigns(base.computed, changes).compute()
    figure = _figure(data, of, law)
    values = figure.values
    if not np.isfinite(values[0]):
        why = str(data["reason"].sel(law=figure["law"]).values[0])
        if not why and of.endswith("_safety"):
            why = why_no_safety(base.built({}))
        raise InputError(
            f"{of} is not known of the case itself{why and f': {why}'}", file=base.name
        )
    by_key: dict[str, float] = {}
    without: dict[str, str] = {}
    rows = values[1:].reshape(-1, len(_PARTS))
    for one, step, row in zip(numbers, steps, rows, strict=True):
        derivative = derivative_of(row, values[0], step)
        if isinstance(derivative, str):
            without[one.key] = derivative
        else:
            by_key[one.key] = derivative
    return Differences(float(values[0]), str(figure.attrs["units"]), by_key, without)


_PARTS = (-1.0, -0.5, 0.5, 1.0)
"""Places at which a figure is computed, in steps."""


def derivative_of(row: np.ndarray, value: float, step: float) -> float | str:
    """The derivative out of a figure at four places; a sentence where there is none.

    Args:
        row: the figure a step below the number, half a step below, half a step above, a step above; NaN
            where it is not known.
        value: the figure at the number itself.
        step: the larger one.
    """
    both_ways = np.isfinite(row)
    if not (both_ways[:2].all() or both_ways[2:].all()):
        return OTHER_FORM
    if both_ways.all():
        wide, narrow, order = (row[3] - row[0]) / 2.0, row[2] - row[1], 2
    elif both_ways[2:].all():
        wide, narrow, order = row[3] - value, 2.0 * (row[2] - value), 1
    else:
        wide, narrow, order = value - row[0], 2.0 * (value - row[1]), 1
    rounded = max(ROUNDING * abs(value), LEFT)
    if max(abs(wide), abs(narrow)) <= rounded:
        return STILL
    if abs(wide - narrow) > SMOOTH * max(abs(wide), abs(narrow)) + rounded:
        told = f"{wide / step:.4g} and {narrow / step:.4g}"
        return f"has no derivative here: differences over two steps give {told}"
    above, below = row[3] - value, value - row[0]
    if (
        both_ways.all()
        and abs(above - below) > SMOOTH * max(abs(above), abs(below)) + 100.0 * rounded
    ):
        return f"has no derivative here: {above / step:.4g} above it and {below / step:.4g} below"
    return float((2.0**order * narrow - wide) / (2.0**order - 1.0) / step)


def _figure(data: xr.Dataset, of: str, law: str | None) -> xr.DataArray:
    laws = [str(name) for name in data["law"].values]
    if law is not None and law not in laws:
        raise InputError(f"{shown(law)} is no friction law of the case{nearest(law, laws)}")
    figures = [
        str(name)
        for name, values in data.data_vars.items()
        if {*values.dims} == {"law", "point"}
        and np.issubdtype(values.dtype, np.floating)
        and name not in NO_FIGURES
    ]
    if of not in figures:
        raise InputError(f"{shown(of)} has no derivatives here{nearest(of, figures)}")
    return data[of].sel(law=laws[0] if law is None else law)
