"""Parts of a result as people of xarray expect them: labelled, in the units asked for, NaN off contact."""

import json
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, nullcontext, suppress
from typing import Any, Literal

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import DOUBT_FIELDS
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.results.by_stage import OF_STAGES
from pitchpoint.results.chosen_units import UnitsByKind, shown_in, unit_choice
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import SWEEP_AXIS, VARIABLES, variable_of

__all__ = [
    "Units",
    "attributes",
    "demand_units",
    "flat_attributes",
    "in_units",
    "labelled",
    "showing",
]

Units = Literal["si", "shown"] | UnitsByKind
"""Units of a dataset: SI, those in which tables and figures show each variable, or a choice by kind."""

_BY_NAME = ("si", "shown")
_ACTIVE = "active"

_ALONG = ("phase", "axis", "cycles", "time", "speed", "torque")
"""Variables that label the dimension along which alone they run, the first one there is."""


def labelled(data: xr.Dataset, unit: Units = "si") -> xr.Dataset:
    """The dataset with a coordinate on each dimension and no numbers where no teeth touch.

    Args:
        data: a part of a result.
        unit: "si", "shown", or units by kind of quantity, the others as shown.

    Dimensions without a coordinate take the variable that runs along them (`phase` along the nodes of a
    cycle), else count from 1; a single operating point is no dimension.
    """
    table = _off_contact(data)
    if table.sizes.get("point") == 1:
        table = table.squeeze("point", drop=True)
    for name in [*table.dims]:
        if name not in table.coords:
            table = _labelled(table, str(name))
    table = table.copy()
    table.attrs = flat_attributes(data)
    return in_units(table, unit)


def attributes(data: xr.Dataset) -> dict[str, Any]:
    """Attributes as data: lists and mappings, which the files hold as JSON, and what is no JSON as it is."""
    return {str(name): _data(value) for name, value in data.attrs.items()}


def _data(value: Any) -> Any:
    if isinstance(value, str) and value.startswith(("[", "{")):
        with suppress(json.JSONDecodeError):
            return json.loads(value)
    return value


def flat_attributes(data: xr.Dataset) -> dict[str, Any]:
    """Attributes as those of a NetCDF file may be: texts, numbers, and lists of either.

    Of a mapping each value has its own name, `solve_residual` say, NaN where there is none; of a list of
    mappings or of lists each column, `outside_law` say, whose own lists are texts with "; " between. What the
    stages of a drive keep apart is in the variables.
    """
    nested = attributes(data)
    if _DOUBTS in nested:
        nested[_DOUBTS] = [dict(zip(DOUBT_FIELDS, doubt, strict=True)) for doubt in nested[_DOUBTS]]
    return {
        name: value
        for attribute, inside in nested.items()
        if attribute != OF_STAGES
        for name, value in _flat(attribute, inside)
    }


_DOUBTS = "doubts"


def _flat(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for key, inside in value.items():
            yield from _flat(f"{name}_{key}", inside)
    elif isinstance(value, list) and value and isinstance(value[0], Mapping | list):
        every = [
            entry if isinstance(entry, Mapping) else dict(enumerate(entry, 1)) for entry in value
        ]
        for key in dict.fromkeys(key for entry in every for key in entry):
            yield f"{name}_{key}", [_plain(entry.get(key)) for entry in every]
    else:
        yield name, [*map(_plain, value)] if isinstance(value, list) else _plain(value)


def _plain(value: Any) -> Any:
    """A text or a number; a list as a text, nothing as what is not a number."""
    if isinstance(value, list):
        return "; ".join(map(str, value))
    return np.nan if value is None else value


def demand_units(unit: Any) -> None:
    """InputError for units that are no choice."""
    if isinstance(unit, str) and unit in _BY_NAME:
        return
    if not isinstance(unit, Mapping) and not (isinstance(unit, str) and "=" in unit):
        raise InputError(
            f'{shown(unit)} was given as units; use "si", "shown", or units by kind, {{"angle": "arcmin"}}'
        )
    unit_choice(unit)


def in_units(data: xr.Dataset, unit: Units) -> xr.Dataset:
    """The dataset in SI, as it is, or in the units in which its variables are shown."""
    if unit == "si":
        return data
    with showing(unit):
        return _displayed(data)


def showing(unit: Units) -> AbstractContextManager[None]:
    """Within it variables are shown in units by kind; in those that hold where it begins for "shown"."""
    return nullcontext() if unit in _BY_NAME else shown_in(unit_choice(unit))


def _displayed(data: xr.Dataset) -> xr.Dataset:
    displayed = data.copy()
    for name in [*map(str, data.variables)]:
        if (name in VARIABLES or name == SWEEP_AXIS) and data[name].dtype.kind == "f":
            quantity = variable_of(data, name)
            if quantity.display != quantity.unit:
                displayed[name] = _as_shown(data, name, quantity)
    return displayed


def _as_shown(data: xr.Dataset, name: str, known: Variable) -> Any:
    """A variable in the unit in which it is shown."""
    values = known.displayed(np.asarray(data[name].values))
    attributes = {**data[name].attrs, "units": known.display}
    return (data[name].dims, values, attributes)


def _off_contact(data: xr.Dataset) -> xr.Dataset:
    """The dataset with NaN where a pair is out of contact; solvers hold harmless numbers there."""
    if _ACTIVE not in data:
        return data
    active = data[_ACTIVE].astype(bool)
    lanes = {
        name: values.where(active).transpose(*values.dims).assign_attrs(values.attrs)
        for name, values in data.data_vars.items()
        if set(active.dims) <= set(values.dims) and values.dtype.kind == "f"
    }
    return data.assign(lanes)


def _labelled(data: xr.Dataset, dim: str) -> xr.Dataset:
    along = [name for name in _ALONG if name in data.data_vars and data[name].dims == (dim,)]
    if along:
        return data.swap_dims({dim: along[0]})
    counted = np.arange(1, data.sizes[dim] + 1)
    return data.assign_coords(
        {dim: (dim, counted, {"units": "1", "long_name": f"number of {dim}"})}
    )
