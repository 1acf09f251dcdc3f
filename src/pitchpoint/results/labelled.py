"""Parts of a result as people of xarray expect them: labelled, in the units asked for, NaN off contact."""

import json
from collections.abc import Mapping
from contextlib import AbstractContextManager, nullcontext, suppress
from typing import Any, Literal

import numpy as np
import xarray as xr

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.results.chosen_units import UnitsByKind, shown_in, unit_choice
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import SWEPT, VARIABLES, variable_of

__all__ = ["Units", "attributes", "demand_units", "in_units", "labelled", "showing"]

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
    made = _off_contact(data)
    if made.sizes.get("point") == 1:
        made = made.squeeze("point", drop=True)
    for name in [*made.dims]:
        if name not in made.coords:
            made = _labelled(made, str(name))
    lists = {name: value for name, value in attributes(made).items() if _plain_list(value)}
    return in_units(made.assign_attrs(lists), unit)


def attributes(data: xr.Dataset) -> dict[str, Any]:
    """Attributes as data: lists and mappings, which the files hold as JSON, and what is no JSON as it is."""
    return {str(name): _data(value) for name, value in data.attrs.items()}


def _data(value: Any) -> Any:
    if isinstance(value, str) and value.startswith(("[", "{")):
        with suppress(json.JSONDecodeError):
            return json.loads(value)
    return value


def _plain_list(value: Any) -> bool:
    """True for texts alone or numbers alone, one at least, which attributes of NetCDF may be."""
    if not isinstance(value, list) or not value:
        return False
    return len({isinstance(one, str) for one in value}) == 1 and all(
        isinstance(one, str | int | float) for one in value
    )


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
    made = data.copy()
    for name in [*map(str, data.variables)]:
        if (name in VARIABLES or name == SWEPT) and data[name].dtype.kind == "f":
            known = variable_of(data, name)
            if known.display != known.unit:
                made[name] = _as_shown(data, name, known)
    return made


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
        name: one.where(active).transpose(*one.dims).assign_attrs(one.attrs)
        for name, one in data.data_vars.items()
        if set(active.dims) <= set(one.dims) and one.dtype.kind == "f"
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
