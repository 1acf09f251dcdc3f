"""How the designs of a study are laid out: values of any of them out of a description of a few numbers."""

import warnings
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod
from typing import Any, Literal, get_args

import numpy as np
from jaxtyping import Float

from pitchpoint import units as units_of_numbers
from pitchpoint.analyses.studies import SWEPT
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.study_tables import COUNT, one_value
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.registry import nearest
from pitchpoint.results.chosen_units import unit_in_use
from pitchpoint.results.labelled import Units
from pitchpoint.runs.case import case_value

__all__ = [
    "DRAWN",
    "FEWEST",
    "MOST_DESIGNS",
    "How",
    "StudyAxis",
    "StudyLayout",
    "layout_of",
    "sobol_shares",
]

How = Literal["grid", "zip", "latin_hypercube", "sobol", "saltelli"]

DRAWN = ("latin_hypercube", "sobol", "saltelli")
"""Ways whose designs are drawn, by SciPy."""

MOST_DESIGNS = 10_000_000
"""Designs of a study."""

FEWEST = 16
"""Designs of each sample below which Sobol' indices say nothing."""

DEVIATIONS = 3.0
"""Standard deviations from the middle of a normal distribution to its ends, where it is cut off."""

_DISTRIBUTIONS = ("uniform", "normal")


@dataclass(frozen=True)
class StudyAxis:
    """Values of one key.

    Attributes:
        key: dotted.
        quantity: what its values are; None for names.
        values: as a case file has them.
        distribution: of what is drawn between two ends, "uniform" or "normal".
    """

    key: str
    quantity: Quantity | None
    values: Sequence[Any]
    distribution: str = "uniform"

    @classmethod
    def of(cls, variant: Variant, key: str, values: Any) -> "StudyAxis":
        """Axis of a case; InputError for a key or values that are none."""
        try:
            quantity = quantity_at(key, variant.document().tree)
            if key.partition(".")[0] not in SWEPT:
                raise InputError(f"cannot be studied; keys of {', '.join(SWEPT)} can")
            listed, distribution = case_value(key, values), "uniform"
            if isinstance(listed, dict):
                listed, distribution = _of_range(listed, quantity)
                listed = case_value(key, listed)
            if not isinstance(listed, list) or not listed:
                raise InputError(
                    f"{shown(listed)} was given where a list of values belongs, or a table of start and stop"
                )
            for value in listed:
                _demand_value(value, quantity)
        except InputError as error:
            raise error.at(file=variant.name, key=key) from None
        return cls(key, quantity, listed, distribution)

    @property
    def described(self) -> Any:
        """What makes it again."""
        if self.distribution == "uniform":
            return [*self.values]
        start, stop = self.values
        return {"start": start, "stop": stop, "distribution": self.distribution}

    def stored(self, values: Sequence[Any]) -> tuple[np.ndarray, dict[str, str]]:
        """Values as a coordinate in SI, and its attributes."""
        if self.quantity is None:
            return np.array([str(value) for value in values]), {"long_name": self.key}
        si = np.array([self.quantity.si(value) for value in values])
        unit = units_of_numbers.si_unit(self.quantity.kind) or "1"
        return si, {"units": unit, "long_name": self.key}

    def coordinate(self) -> tuple[str, tuple[str, np.ndarray, dict[str, str]]]:
        """The key, and its values as a dimension."""
        return self.key, (self.key, *self.stored(self.values))

    def unit_in(self, units: Units) -> str:
        """Unit in which its values are shown; empty where they stay as they are stored."""
        if self.quantity is None or units == "si" or self.quantity.unit == "1":
            return ""
        return unit_in_use(self.quantity.kind, self.quantity.unit)

    def shown(self, si: np.ndarray, units: Units) -> np.ndarray:
        """Values in the unit in which they are shown."""
        unit = self.unit_in(units)
        if not unit or self.quantity is None:
            return si
        return np.asarray(units_of_numbers.convert(si, unit, self.quantity.kind))

    @property
    def ends(self) -> tuple[float, float]:
        """Lowest and highest value in SI; InputError if there are no two numbers."""
        if self.quantity is None or len(self.values) != 2:
            raise InputError(
                f"{shown(self.values)} was given where the lowest and the highest number belong",
                key=self.key,
            )
        low, high = sorted(self.quantity.si(value) for value in self.values)
        return low, high

    def drawn(self, share: np.ndarray) -> list[Any]:
        """Values at shares of the range; of a count whole ones, each with the same part of it."""
        low, high = self.ends
        if self.distribution == "normal":
            from scipy.special import ndtr, ndtri

            least = ndtr(-DEVIATIONS)
            share = 0.5 + ndtri(least + share * (1.0 - 2.0 * least)) / (2.0 * DEVIATIONS)
        if self.quantity is not None and self.quantity.whole:
            return [
                *case_value(self.key, np.minimum(low + np.floor(share * (high - low + 1.0)), high))
            ]
        return [*case_value(self.key, low + share * (high - low))]


_OF_RANGE = ("start", "stop", "count", "distribution")


def _of_range(table: Mapping[str, Any], quantity: Quantity | None) -> tuple[list[Any], str]:
    """Values in equal steps, or two ends between which a distribution draws them."""
    for name in table:
        if name not in _OF_RANGE:
            raise InputError(
                f"{shown(name)} is no key of a range{nearest(name, _OF_RANGE)}; it has {', '.join(_OF_RANGE)}"
            )
    start, stop, count = (table.get(name) for name in _OF_RANGE[:3])
    distribution = table.get("distribution", "uniform")
    if start is None or stop is None or quantity is None:
        raise InputError(f"{shown(dict(table))} was given where start and stop of numbers belong")
    if distribution not in _DISTRIBUTIONS:
        raise InputError(
            f"{shown(distribution)} is no distribution; use one of {', '.join(map(shown, _DISTRIBUTIONS))}"
        )
    if count is None:
        return [start, stop], distribution
    if "distribution" in table:
        raise InputError(
            "count and distribution were both given; values in equal steps have no distribution, give one"
        )
    steps = round(COUNT.read(count))
    if steps < 2:
        raise InputError(one_value(start, stop))
    even = np.linspace(quantity.read(start), quantity.read(stop), steps)
    return (np.round(even) if quantity.whole else even).tolist(), "uniform"


def _demand_value(value: Any, quantity: Quantity | None) -> None:
    if isinstance(value, list | dict):
        told = "was given as one value; each design takes one number, those of two gears by key.1 and key.2"
        raise InputError(f"{shown(value)} {told}")
    if quantity is not None:
        quantity.si(value)


@dataclass(frozen=True)
class StudyLayout(ABC):
    """Designs of a study, of which any range is made without the others.

    Attributes:
        axes: by key.
        n: asked for, see `study`.
        seed: of what is drawn.
    """

    axes: Mapping[str, StudyAxis]
    n: int | None
    seed: int

    @property
    @abstractmethod
    def count(self) -> int:
        """Of designs; InputError where values and number of designs do not go together."""

    @property
    def dims(self) -> dict[str, int]:
        """Dimensions of the result and their lengths."""
        return {"design": self.count}

    @abstractmethod
    def columns(self, first: int, stop: int) -> dict[str, list[Any]]:
        """Values of a range of designs by key, as a case file has them."""

    def changes(self, first: int, stop: int) -> list[dict[str, Any]]:
        """The same by design."""
        columns = self.columns(first, stop)
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    def _demand_no_number(self, what: str) -> None:
        if self.n is not None:
            told = f"{self.n} was given, and {what} has as many designs as its values make; leave it out"
            raise InputError(f"{told}, or draw by latin_hypercube or sobol", key="n")

    def _demand_ranges(self) -> None:
        for axis in self.axes.values():
            _ = axis.ends


class _Grid(StudyLayout):
    @cached_property
    def count(self) -> int:
        self._demand_no_number("a grid")
        return prod(self.dims.values())

    @property
    def dims(self) -> dict[str, int]:
        return {key: len(axis.values) for key, axis in self.axes.items()}

    def columns(self, first: int, stop: int) -> dict[str, list[Any]]:
        places = np.unravel_index(np.arange(first, stop), [*self.dims.values()])
        return {
            key: [axis.values[at] for at in place]
            for (key, axis), place in zip(self.axes.items(), places, strict=True)
        }


class _Zip(StudyLayout):
    @cached_property
    def count(self) -> int:
        self._demand_no_number("a zip")
        lengths = {key: len(axis.values) for key, axis in self.axes.items()}
        if len({*lengths.values()}) > 1:
            told = ", ".join(f"{count} of {key}" for key, count in lengths.items())
            raise InputError(f"values that go together are equally many; given were {told}")
        return next(iter(lengths.values()))

    def columns(self, first: int, stop: int) -> dict[str, list[Any]]:
        return {key: [*axis.values[first:stop]] for key, axis in self.axes.items()}


class _Drawn(StudyLayout):
    @abstractmethod
    def shares(self, first: int, stop: int) -> Float[np.ndarray, "design key"]:
        """Shares of the ranges of a range of designs."""

    def columns(self, first: int, stop: int) -> dict[str, list[Any]]:
        shares = self.shares(first, stop)
        return {key: axis.drawn(shares[:, at]) for at, (key, axis) in enumerate(self.axes.items())}


class _LatinHypercube(_Drawn):
    @cached_property
    def count(self) -> int:
        if self.n is None:
            raise InputError("a Latin hypercube needs the number of designs; give n", key="n")
        self._demand_ranges()
        return self.n

    @cached_property
    def _whole(self) -> Float[np.ndarray, "design key"]:
        from scipy.stats import qmc

        rng = np.random.default_rng(self.seed)
        return np.asarray(qmc.LatinHypercube(d=len(self.axes), rng=rng).random(self.count))

    def shares(self, first: int, stop: int) -> Float[np.ndarray, "design key"]:
        return self._whole[first:stop]  # strata are permuted over all designs: no part stands alone


class _Sobol(_Drawn):
    @cached_property
    def count(self) -> int:
        count = _power_of_two(self.n)
        self._demand_ranges()
        return count

    def shares(self, first: int, stop: int) -> Float[np.ndarray, "design key"]:
        return sobol_shares(self.count, len(self.axes), self.seed, first=first, stop=stop)


class _Saltelli(_Drawn):
    """Two samples, and the first one with each key in turn from the second, one after the other."""

    @cached_property
    def count(self) -> int:
        base = _power_of_two(self.n, FEWEST)
        self._demand_ranges()
        return base * (len(self.axes) + 2)

    def shares(self, first: int, stop: int) -> Float[np.ndarray, "design key"]:
        assert self.n is not None
        numbers, keys = np.arange(first, stop), len(self.axes)
        sample, place = np.divmod(numbers, self.n)
        both = sobol_shares(self.n, 2 * keys, self.seed, FEWEST)[place]
        second = (sample == 1)[:, None] | (sample[:, None] == 2 + np.arange(keys))
        return np.where(second, both[:, keys:], both[:, :keys])


_LAYOUTS: dict[str, type[StudyLayout]] = {
    "grid": _Grid,
    "zip": _Zip,
    "latin_hypercube": _LatinHypercube,
    "sobol": _Sobol,
    "saltelli": _Saltelli,
}


def layout_of(
    variant: Variant, over: Mapping[str, Any], how: str, n: int | None, seed: int
) -> StudyLayout:
    """Designs of a study, see there.

    Args:
        variant: the case.
        over: values by whole key.
        how, n, seed: see `study`.

    Raises:
        InputError: no such key or way, values that a key does not take, a number of designs that cannot be.
    """
    axes = {key: StudyAxis.of(variant, key, values) for key, values in over.items()}
    _demand_way(how)
    layout = _LAYOUTS[how](axes, n, seed)
    _possible(layout.count)
    return layout


def _demand_way(how: str) -> None:
    if how not in get_args(How):
        known = ", ".join(f'"{name}"' for name in get_args(How))
        raise InputError(
            f"{shown(how)} is no way to lay out a study; use one of {known}", key="how"
        )


def _possible(count: int) -> int:
    if not 1 <= count <= MOST_DESIGNS:
        raise InputError(f"{count} designs were asked for; allowed is 1 to {MOST_DESIGNS}")
    return count


def sobol_shares(
    n: int | None,
    keys: int,
    seed: int,
    least: int = 1,
    *,
    first: int = 0,
    stop: int | None = None,
) -> Float[np.ndarray, "design key"]:
    """Shares of ranges by a scrambled Sobol' sequence.

    Args:
        n: of designs, a power of two.
        keys: that change.
        seed: the same one draws the same designs.
        least: of designs.
        first, stop: range of designs; all by default.

    Raises:
        InputError: n is no power of two, less than the least, or more than a study has.

    Example:
        >>> import numpy as np
        >>> part = sobol_shares(8, 2, 1, first=3, stop=5)
        >>> bool(np.all(part == sobol_shares(8, 2, 1)[3:5]))
        True
    """
    from scipy.stats import qmc

    count = _power_of_two(n, least)
    sequence = qmc.Sobol(d=keys, rng=np.random.default_rng(seed))
    if first:
        sequence.fast_forward(first)
    with warnings.catch_warnings():
        # The whole is even; a range of it needs no power of two.
        warnings.simplefilter("ignore", UserWarning)
        return np.asarray(sequence.random((count if stop is None else stop) - first))


def _power_of_two(n: int | None, least: int = 1) -> int:
    """The number of designs of a Sobol' sequence."""
    if n is None or n < least or n & (n - 1):
        told = "no number of designs was given" if n is None else f"{n} designs were asked for"
        most = f", {least} at least" if least > 1 else ""
        raise InputError(
            f"{told}; a Sobol' sequence is even with a power of two of them{most}; give n = 1024, say",
            key="n",
        )
    return _possible(n)
