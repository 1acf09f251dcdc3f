"""Results as tables: a column for each variable with its unit, a row for each place."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
import xarray as xr

from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import variable_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views.inputs import printed_input_rows

__all__ = ["INPUTS", "Column", "Sheet", "exported", "sheets", "table_of_inputs"]

INPUTS = "inputs"
"""Name of the table of the inputs."""

_DRAWING = "layer_"
"""Begins the names of what pictures of the teeth are drawn from."""


@dataclass(frozen=True)
class Column:
    """What stands in a column.

    Attributes:
        head: its name with the unit.
        name: of the variable.
        words: what it is.
    """

    head: str
    name: str
    words: str


@dataclass(frozen=True)
class Sheet:
    """A table of a result.

    Attributes:
        name: of the part, with what its rows run over where the part has several tables.
        frame: its columns, each headed by name and unit.
        columns: what they are.
    """

    name: str
    frame: pd.DataFrame
    columns: tuple[Column, ...]


def exported(data: xr.Dataset, *, si: bool = False) -> xr.Dataset:
    """A part with its values as they are given to others.

    Args:
        data: as computed.
        si: True for SI units, else those of report and screen.

    Returns:
        The part without what only pictures need; values are NaN where no pair touches, and each variable
        has attributes `units` and `long_name`.
    """
    undrawn = data.drop_vars([name for name in data.variables if str(name).startswith(_DRAWING)])
    variables = {str(name): _given(undrawn, str(name), si) for name in undrawn.variables}
    coordinates = {name: variable for name, variable in variables.items() if name in undrawn.coords}
    others = {name: variable for name, variable in variables.items() if name not in coordinates}
    return xr.Dataset(others, coordinates, undrawn.attrs)


def _given(data: xr.Dataset, name: str, si: bool) -> xr.Variable:
    """A variable in the unit in which it is given, NaN where no pair touches."""
    array, description = data[name].variable, _registered(data, name)
    values = np.asarray(array.values)
    if array.dtype.kind == "f":
        if "active" in data and set(data["active"].dims) <= set(array.dims):
            values = data[name].where(data["active"]).transpose(*array.dims).values
        if description is not None and not si:
            values = _shown(values, description)
    if description is None:
        long_name = array.attrs.get("long_name", name.replace("_", " "))
        unit = array.attrs.get("units", "1")
    else:
        long_name, unit = description.long_name, description.unit if si else description.display
    words = {"long_name": long_name, "units": "" if unit == "1" else unit}
    return xr.Variable(array.dims, values, words)


def _shown(values: np.ndarray, variable: Variable) -> np.ndarray:
    """Values in the unit of report and screen."""
    if variable.display == variable.unit:
        return values
    return np.asarray(variable.displayed(values))


def _registered(data: xr.Dataset, name: str) -> Variable | None:
    """What a variable is; None for that of a publication, which describes its own in the data."""
    try:
        return variable_of(data, name)
    except KeyError:
        return None


def sheets(outcome: Outcome, *, si: bool = False) -> Iterator[Sheet]:
    """Tables of a result: its inputs, then those of each part, one for whatever its variables run over.

    Args:
        outcome: of one variant.
        si: True for SI units, else those of report and screen.
    """
    yield table_of_inputs(outcome)
    for part, data in outcome.parts.items():
        converted = exported(data, si=si)
        groups = _by_dimensions(converted)
        for dims, names in groups.items():
            name = part if len(groups) == 1 else "_".join((part, *dims)) if dims else part
            yield _sheet(name, converted, dims, names)


def table_of_inputs(outcome: Outcome) -> Sheet:
    """Inputs as resolved, in words."""
    frame = pd.DataFrame(printed_input_rows(outcome.manifest))
    words = {
        "table": "table of the case file, or what follows from it",
        "key": "key in the table",
        "value": "value with its unit",
        "status": "how it was come by",
        "where": "place in its source",
        "note": "remark",
    }
    return Sheet(INPUTS, frame, tuple(Column(key, key, words[key]) for key in frame.columns))


def _by_dimensions(data: xr.Dataset) -> dict[tuple[str, ...], list[str]]:
    """Names of the variables by what they run over; those of a dimension alone go with the others of it."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for name, array in data.data_vars.items():
        groups.setdefault(tuple(map(str, array.dims)), []).append(str(name))
    wide = {dim for dims in groups if len(dims) > 1 for dim in dims}
    return {
        dims: names
        for dims, names in groups.items()
        if not (len(dims) == 1 and dims[0] in wide and dims[0] not in data.coords)
    }


def _sheet(name: str, data: xr.Dataset, dims: tuple[str, ...], names: list[str]) -> Sheet:
    if not dims:
        return _of_single_values(name, data, names)
    places = [
        str(variable)
        for variable, array in data.data_vars.items()
        if len(array.dims) == 1 and array.dims[0] in dims and array.dims[0] not in data.coords
    ]
    heads = {variable: _head(data, variable) for variable in (*dims, *places, *names)}
    frame = data[[*dict.fromkeys((*places, *names))]].to_dataframe(dim_order=[*dims]).reset_index()
    frame = frame[[*heads]].rename(columns=heads)
    columns = (Column(heads[variable], variable, _words(data, variable)) for variable in heads)
    return Sheet(name, frame, tuple(columns))


def _of_single_values(name: str, data: xr.Dataset, names: list[str]) -> Sheet:
    rows = [
        {
            "variable": variable,
            "value": data[variable].values.item(),
            "unit": data[variable].attrs["units"],
            "meaning": _words(data, variable),
        }
        for variable in names
    ]
    words = {"variable": "its name", "value": "in its unit", "unit": "of the value"}
    frame = pd.DataFrame(rows)
    return Sheet(
        name,
        frame,
        tuple(Column(key, key, words.get(key, "what it is")) for key in frame.columns),
    )


def _head(data: xr.Dataset, name: str) -> str:
    attributes: Mapping[str, str] = data[name].attrs if name in data.variables else {}
    words = attributes["long_name"] if name == "axis" and "sweep_key" in data.attrs else name
    return f"{words} [{attributes['units']}]" if attributes.get("units") else words


def _words(data: xr.Dataset, name: str) -> str:
    if name not in data.variables:
        return f"number of the {name.replace('_', ' ')}, from 0"
    return str(data[name].attrs["long_name"])
