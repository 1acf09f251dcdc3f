"""Studies from Python: many designs of a case in one dataset with a dimension for each key."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from itertools import product
from math import prod
from pathlib import Path
from typing import Any, Literal, get_args

import numpy as np
import xarray as xr
from jaxtyping import Float

from pitchpoint import units as units_of_numbers
from pitchpoint._jax import double_precision
from pitchpoint.analyses.designs import Designs
from pitchpoint.analyses.studies import SWEPT, demand_films, demand_one
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.schema import COUNT, Sweep, quantity_at
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.results.chosen_units import shown_in, unit_choice, unit_in_use
from pitchpoint.results.labelled import Units, demand_units, in_units, showing
from pitchpoint.results.store import fingerprint, make_folder, sole_writer
from pitchpoint.runs.case import Case, CaseLike, as_case, written
from pitchpoint.runs.python_values import demand_arguments
from pitchpoint.runs.run import FrictionChoice, Progress, compute_alone, own_law

__all__ = ["drawn_values", "sobol_shares", "study"]

How = Literal["grid", "zip", "latin_hypercube", "sobol"]


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
    progress: Progress | None = None,
) -> xr.Dataset:
    """Main figures of many designs of a case, computed together.

    Args:
        case: a `Case`, or what makes one.
        over: values by key, SI numbers or texts with a unit, or names; for "latin_hypercube" and "sobol" the
            lowest and the highest one.
        how: "grid" takes every value with every other, "zip" the first ones together, then the second
            ones, "latin_hypercube" draws designs that fill the ranges evenly, "sobol" those of a scrambled
            Sobol' sequence.
        n: number of designs to draw; a power of two of a Sobol' sequence.
        seed: the same one draws the same designs.
        units: of the result, "si", those in which values are "shown", or some by kind of quantity,
            {"angle": "arcmin"}, and the others as shown.
        variant: of the case, the first one by default.
        friction: laws of one's own, see `run`.
        folder: where pieces of 256 designs are kept as soon as they are computed, so that the same call
            goes on from there.
        progress: told about pieces.

    Returns:
        Figures over `law` and a dimension for each key of a grid, named as the key; otherwise over
        `design`, along which the keys are coordinates. A design that cannot be computed is NaN, and
        `reason` says why.

    Raises:
        InputError: no such key, one whose values cannot be changed by design, values that it cannot take,
            or none of the designs can be computed.

    Example:
        >>> found = study("tian2024", {"operation.torque": [20.0, 60.0]}, variant="physical")
        >>> dict(found.sizes)["operation.torque"]
        2
    """
    demand_units(units)
    demand_arguments(
        over=over, how=how, n=n, seed=seed, variant=variant, friction=friction, folder=folder
    )
    chosen = as_case(case) if variant is None else Case(case, variant=variant)
    base = chosen.held[0] if friction is None else own_law(chosen.held[0], friction)
    axes = {key: _Axis.of(chosen, key, values) for key, values in _whole(chosen, over).items()}
    dims, columns = _LAID_OUT[_known(how)](axes, n, seed)
    changes = [dict(zip(axes, row, strict=True)) for row in zip(*columns, strict=True)]
    for key, axis in axes.items():
        _demand_meant(base, key, axis)
    tree = base.document().tree
    told = [{key: table for key, table in tree.items() if key != OUTPUT}, changes]
    designs = Designs(f"designs_{fingerprint(*told)[:8]}", base, changes)
    with nullcontext() if folder is None else _alone(Path(folder)):
        data = compute_alone(
            designs.analysis,
            base,
            told=told,
            folder=None if folder is None else Path(folder),
            progress=progress or Progress(),
        )
    with shown_in(unit_choice(tree.get(OUTPUT, {}).get("units", {}))), showing(units):
        return _laid_out(in_units(data, units), axes, dims, columns, units)


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
    ranges = _whole(chosen, over).items()
    return {
        key: _Axis.of(chosen, key, values).drawn(shares[:, at])
        for at, (key, values) in enumerate(ranges)
    }


class _Axis:
    """Values of one key.

    Attributes:
        key: dotted.
        quantity: what its values are; None for names.
        values: as a case file has them.
    """

    def __init__(self, key: str, quantity: Quantity | None, values: Sequence[Any]) -> None:
        self.key, self.quantity, self.values = key, quantity, values

    @classmethod
    def of(cls, case: Case, key: str, values: Any) -> "_Axis":
        """Axis of a case; InputError for a key or values that are none."""
        try:
            quantity = quantity_at(key, case.held[0].document().tree)
            if key.partition(".")[0] not in SWEPT:
                raise InputError(f"cannot be studied; keys of {', '.join(SWEPT)} can")
            given = written(key, values)
            if not isinstance(given, list) or not given:
                raise InputError(f"{shown(given)} was given where a list of values belongs")
            for one in given:
                _demand_value(one, quantity)
        except InputError as error:
            raise error.at(file=case.name, key=key) from None
        return cls(key, quantity, given)

    def numbers(self, values: Sequence[Any], unit: Units) -> tuple[Any, dict[str, str]]:
        """Values as a coordinate, and its attributes."""
        quantity = self.quantity
        if quantity is None:
            return np.array([str(value) for value in values]), {"long_name": self.key}
        si = np.array([quantity.si(value) for value in values])
        name = units_of_numbers.si_unit(quantity.kind) or "1"
        if unit != "si" and quantity.unit != "1":
            name = unit_in_use(quantity.kind, quantity.unit)
            si = units_of_numbers.convert(si, name, quantity.kind)
        return si, {"units": name, "long_name": self.key}

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
        """Values at shares of the range, whole ones for a count."""
        low, high = self.ends
        si = low + share * (high - low)
        whole = self.quantity is not None and self.quantity.whole
        return [*written(self.key, np.round(si) if whole else si)]


def _demand_value(value: Any, quantity: Quantity | None) -> None:
    if isinstance(value, list | dict):
        told = "was given as one value; each design takes one number, those of two gears by key.1 and key.2"
        raise InputError(f"{shown(value)} {told}")
    if quantity is not None:
        quantity.si(value)


def _whole(case: Case, over: Mapping[str, Any]) -> dict[str, Any]:
    """Values by whole key."""
    if not over:
        raise InputError("a study needs the values of one key at least")
    return {case.key(name): values for name, values in over.items()}


def _known(how: str) -> How:
    if how not in get_args(How):
        known = ", ".join(f'"{name}"' for name in get_args(How))
        raise InputError(f"{shown(how)} is no way to lay out a study; use one of {known}")
    return how  # type: ignore[return-value]


_Axes = Mapping[str, _Axis]
_Layout = tuple[dict[str, int], list[list[Any]]]


def _grid(axes: _Axes, _: int | None, __: int) -> _Layout:
    _demand_count(prod(len(axis.values) for axis in axes.values()))
    rows = product(*(axis.values for axis in axes.values()))
    dims = {key: len(axis.values) for key, axis in axes.items()}
    return dims, [list(column) for column in zip(*rows, strict=True)]


def _zip(axes: _Axes, _: int | None, __: int) -> _Layout:
    lengths = {key: len(axis.values) for key, axis in axes.items()}
    if len({*lengths.values()}) > 1:
        told = ", ".join(f"{count} of {key}" for key, count in lengths.items())
        raise InputError(f"values that go together are equally many; given were {told}")
    count = next(iter(lengths.values()))
    _demand_count(count)
    return {"design": count}, [list(axis.values) for axis in axes.values()]


def _latin_hypercube(axes: _Axes, n: int | None, seed: int) -> _Layout:
    from scipy.stats import qmc

    if n is None:
        raise InputError("a Latin hypercube needs the number of designs, n")
    _demand_count(n)
    shares = qmc.LatinHypercube(d=len(axes), rng=np.random.default_rng(seed)).random(n)
    return {"design": n}, [axis.drawn(shares[:, k]) for k, axis in enumerate(axes.values())]


def sobol_shares(
    n: int | None, keys: int, seed: int, least: int = 1
) -> Float[np.ndarray, "design key"]:
    """Shares of ranges by a scrambled Sobol' sequence.

    Args:
        n: of designs, a power of two.
        keys: that change.
        seed: the same one draws the same designs.
        least: of designs.

    Raises:
        InputError: n is no power of two, less than the least, or more than a study has.
    """
    from scipy.stats import qmc

    if n is None or n < least or n & (n - 1):
        told = "no number of designs was given" if n is None else f"{n} designs were asked for"
        most = f", {least} at least" if least > 1 else ""
        raise InputError(f"{told}; a Sobol' sequence is even with a power of two of them{most}")
    _demand_count(n)
    return np.asarray(qmc.Sobol(d=keys, rng=np.random.default_rng(seed)).random(n))


def _sobol(axes: _Axes, n: int | None, seed: int) -> _Layout:
    shares = sobol_shares(n, len(axes), seed)
    columns = [axis.drawn(shares[:, k]) for k, axis in enumerate(axes.values())]
    return {"design": len(shares)}, columns


_LAID_OUT: dict[How, Callable[[_Axes, int | None, int], _Layout]] = {
    "grid": _grid,
    "zip": _zip,
    "latin_hypercube": _latin_hypercube,
    "sobol": _sobol,
}


def _demand_count(count: int) -> None:
    if not 1 <= count <= COUNT.high:
        raise InputError(f"{count} designs were asked for; {COUNT.allowed}")


def _demand_meant(base: Variant, key: str, axis: _Axis) -> None:
    """InputError where one number would stand for two different ones, or changes nothing."""
    demand_one(base, Sweep(key=key, values=tuple(axis.values[:1])), "study")
    demand_films(base.built({}), base, key, "study")


def _alone(folder: Path) -> Any:
    make_folder(folder)
    return sole_writer(folder)


def _laid_out(
    data: xr.Dataset,
    axes: _Axes,
    dims: Mapping[str, int],
    columns: Sequence[Sequence[Any]],
    unit: Units,
) -> xr.Dataset:
    """The dataset with its designs along the dimensions of the study."""
    variables = {
        str(name): (_dims(one.dims, dims), _shaped(one, dims), one.attrs)
        for name, one in data.variables.items()
    }
    made = xr.Dataset(variables, attrs=data.attrs).set_coords([*map(str, data.coords)])
    if "design" in dims:
        labels: dict[str, Any] = {
            key: ("design", *axis.numbers(column, unit))
            for (key, axis), column in zip(axes.items(), columns, strict=True)
        }
        return made.assign_coords(design=np.arange(dims["design"]), **labels)
    return made.assign_coords(
        {key: (key, *axis.numbers(axis.values, unit)) for key, axis in axes.items()}
    )


def _dims(old: Sequence[Any], dims: Mapping[str, int]) -> list[str]:
    return [name for one in old for name in (dims if one == "point" else [str(one)])]


def _shaped(one: xr.Variable, dims: Mapping[str, int]) -> np.ndarray:
    """Values with the designs along so many dimensions."""
    sizes = [
        size
        for name, length in zip(one.dims, one.shape, strict=True)
        for size in (dims.values() if name == "point" else [length])
    ]
    return np.reshape(one.values, sizes)
