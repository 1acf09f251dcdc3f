"""Printed numbers against computed ones."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint import units
from pitchpoint.cases.study_tables import Target
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.registry import nearest
from pitchpoint.results.reductions import (
    INVERSE_SLOPE,
    OF_TWO_LAWS,
    PLAIN,
    REDUCTIONS,
    RISES,
    SLOPE,
    SPANS,
)
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.results.variables import VARIABLES, places_of

__all__ = ["compare", "demand_parts"]

OF_VIBRATION = ("mean_transmission_error", "transmission_error_range", "largest_dynamic_factor")
"""Variables whose numbers count only where the vibration is a steady one."""


def compare(
    targets: Sequence[Target], results: Mapping[str, xr.Dataset], name: str = ""
) -> list[TargetRow]:
    """A row for every target.

    Args:
        targets: of the case.
        results: datasets by name of the part.
        name: of the file, for messages.

    Raises:
        InputError: a target that names no part, variable or law of the results, or no place on an axis.
            A place beyond the axis makes a row that misses.
    """
    rows = []
    for position, target in enumerate(targets):
        try:
            rows.append(_row(target, results))
        except InputError as error:
            key = ".".join(filter(None, (f"targets.{position}", error.key or "unit")))
            raise error.at(file=name, key=key) from None
    return rows


class _OutsideError(InputError):
    """A place beyond what was computed: with a smaller torque, say, the part ends before it."""


def _row(target: Target, results: Mapping[str, xr.Dataset]) -> TargetRow:
    reason, unsolved = target.missed or target.reason, False
    try:
        left_out = target.kind == "excluded"
        computed = None if left_out else _computed(target, results) - target.less
    except _OutsideError as error:
        # Nothing that was computed is lost for it: the row misses and says why.
        computed, reason = float("nan"), f"not computed: {error.message}. {reason}"
    else:
        unsolved = computed is not None and bool(np.isnan(computed))
        if unsolved:
            reason = f"not computed: no solution was found there. {reason}".strip()
    return TargetRow(
        quantity=target.quantity,
        where=target.where,
        printed=target.printed,
        computed=computed,
        unit=target.unit,
        tolerance=target.tolerance,
        kind=target.kind,
        verdict=_verdict(target, computed),
        reason=reason,
        bound=_bound(target),
        expected_miss=bool(target.missed) and not unsolved,
    )


def _bound(target: Target) -> str:
    side = {"above": "> ", "below": "< "}.get(target.expect, "")
    return f"{side}{target.times:g} x " if target.times != 1.0 else side


def _verdict(target: Target, computed: float | None) -> str:
    if computed is None:
        return "excluded"
    bound = target.times * target.printed
    beyond = {"above": computed - bound, "below": bound - computed}
    if target.expect in beyond:
        return "pass" if beyond[target.expect] > 0.0 else "miss"
    return "pass" if abs(computed - target.printed) <= target.tolerance else "miss"


def _computed(target: Target, results: Mapping[str, xr.Dataset]) -> float:
    data = _part(target, results)
    variable = VARIABLES[target.variable]
    values, axis = _read(target, data)
    wanted = _laws(target, len(values))
    if target.variable in OF_VIBRATION and _unsteady(data, wanted):
        return float(
            "nan"
        )  # a balance that is not reached, or that pulls on teeth, meets no target
    with np.errstate(divide="ignore", invalid="ignore"):
        number = REDUCTIONS[target.reduce](values[wanted], axis.places)
    if target.unit == "1":
        return number
    if target.reduce in (SLOPE, INVERSE_SLOPE):
        return _of_slope(number, target, variable.kind, axis.kind)
    kind = "dimensionless" if target.reduce in PLAIN else variable.kind
    return float(units.convert(number, target.unit, kind))


def demand_parts(targets: Sequence[Target], parts: Sequence[str], name: str) -> None:
    """InputError if a target reads a part that the case will not have."""
    for position, target in enumerate(targets):
        if target.kind != "excluded" and target.reads not in parts:
            error = _absent(target, parts)
            raise error.at(file=name, key=f"targets.{position}.{error.key}")


def _absent(target: Target, parts: Iterable[str]) -> InputError:
    if not target.part:
        return InputError(f"there is no study {shown(target.study)}", key="study")
    present = [part for part in parts if not part.startswith("study_")]
    sentence = f"this case computes no part {shown(target.part)}{nearest(target.part, present)}"
    return InputError(sentence, key="part")


def _part(target: Target, results: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Part that a target reads; it holds the variable."""
    if target.reads not in results:
        raise _absent(target, results)
    data = results[target.reads]
    if target.variable not in data:
        raise InputError(
            f"there is no quantity '{target.variable}'{nearest(target.variable, _names(data))}",
            key="variable",
        )
    return data


@dataclass(frozen=True)
class _Axis:
    """What a variable runs over: its name, places in SI, their kind and the unit to show them in."""

    name: str
    places: np.ndarray
    kind: str = ""
    unit: str = "1"

    def at(self, given: Sequence[Any]) -> np.ndarray:
        """Places in SI; InputError if one lies outside."""
        if not self.kind or not np.isfinite(self.places).all():
            raise InputError("has no axis of numbers to be read at", key="at")
        return np.array([self._one(place) for place in given])

    def _one(self, given: Any) -> float:
        try:
            place = units.parse(given, self.kind)
        except InputError as error:
            raise InputError(error.message, key="at") from None
        low, high = self.places.min(), self.places.max()
        if not low - (margin := 1e-9 * (high - low)) <= place <= high + margin:
            show = Quantity(self.kind, low, high, self.unit).show
            low, high = (0.0 if abs(end) < 1e-6 * (high - low) else end for end in (low, high))
            span = f"{self.name} runs from {show(low)} to {show(high)}"
            raise _OutsideError(f"{shown(given)} lies outside; {span}", key="at")
        return place


def _read(target: Target, data: xr.Dataset) -> tuple[np.ndarray, _Axis]:
    """Values [law, place] of a target's variable, and the axis."""
    array = data[target.variable]
    over = [str(dim) for dim in array.dims if dim != "law"]
    several = [dim for dim in over if array.sizes[dim] > 1]
    if len(several) > 1 or array.dtype.kind not in "biuf":
        reason = f"runs over {' and '.join(several)}" if several[1:] else "is no number"
        raise InputError(
            f"{target.variable} {reason}; it must be one over one axis", key="variable"
        )
    dim = (several or over or ["place"])[0]
    array = array.squeeze([name for name in over if name != dim])
    missing = {"law": data.sizes.get("law", 1)} if "law" not in array.dims else {}
    array = array.expand_dims({**missing, **({} if over else {dim: 1})})
    values, axis = array.transpose("law", dim).values.astype(float), _axis(data, dim)
    _demand_places(target, axis)
    if not target.at:
        return values, axis
    places, order = axis.at(target.at), np.argsort(axis.places)
    values = np.stack([np.interp(places, axis.places[order], row[order]) for row in values])
    return values, replace(axis, places=places)


def _axis(data: xr.Dataset, dim: str) -> _Axis:
    """Axis of a study, or that of another part by the name of its dimension."""
    if dim == "point" and "axis" in data:
        attributes = data.attrs
        places = data["axis"].values
        return _Axis(
            attributes["sweep_key"], places, attributes["axis_kind"], attributes["axis_unit"]
        )
    if dim not in data.coords or dim not in VARIABLES:
        return _along(dim, data)
    variable = VARIABLES[dim]
    return _Axis(dim, data[dim].values, variable.kind, variable.usual)


def _along(dim: str, data: xr.Dataset) -> _Axis:
    """Places of a course of a publication at one point, by their variable; unknown of any other dimension."""
    name = places_of(dim)
    if not name or name not in data or data.sizes.get("point") != 1:
        return _Axis(dim, np.full(data.sizes.get(dim, 1), np.nan))
    variable = VARIABLES[name]
    return _Axis(name, data[name].values[0], variable.kind, variable.usual)


def _demand_places(target: Target, axis: _Axis) -> None:
    """InputError if a reduction has not the places that it needs."""
    count, spans = len(target.at), target.reduce in SPANS
    coincide = np.ptp(axis.at(target.at)) == 0.0 if count else axis.places.size < 2
    if spans and coincide and (count or target.reduce in RISES):
        raise InputError(f"{target.reduce} takes two places of the axis", key="at")
    several = count > 1 or (target.part and not count and axis.places.size > 1)
    if several and target.reduce == "value":
        raise InputError("value takes one place of the axis", key="at")
    if target.reduce in (SLOPE, INVERSE_SLOPE) and not abs(axis.places[-1] - axis.places[0]) > 0.0:
        raise InputError(f"{target.reduce} needs an axis; this part has none", key="reduce")


def _unsteady(data: xr.Dataset, laws: list[int]) -> bool:
    status = data.get("vibration_status")
    return status is not None and bool(status.values[laws].any())


def _laws(target: Target, count: int) -> list[int]:
    """Positions of the laws that a target reads."""
    wanted = [int(position) for position in target.law]
    needed = 2 if target.reduce in OF_TWO_LAWS else 1
    if max(wanted, default=-1) >= count or len(wanted) < needed:
        raise InputError(
            f"{shown(wanted)} does not fit; this {'part' if target.part else 'study'} has {count} "
            f"friction laws, counted from 0, and {target.reduce} takes {needed}",
            key="law",
        )
    return wanted


def _of_slope(number: float, target: Target, variable: str, axis: str) -> float:
    """A change over a change in the unit of the target, which must have their dimension."""
    above, below = (variable, axis) if target.reduce == SLOPE else (axis, variable)
    kind = units.kind_of(target.unit)
    if not units.is_quotient(kind, above, below):
        raise InputError(
            f"{shown(target.unit)} is no unit of {target.reduce}, {above} over {below}", key="unit"
        )
    return float(units.convert(number, target.unit, kind))


def _names(data: xr.Dataset) -> list[str]:
    return [str(name) for name in data.data_vars]
