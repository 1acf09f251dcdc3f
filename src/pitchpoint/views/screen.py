"""Cells of the tables that the command line prints."""

from typing import Any

import numpy as np

from pitchpoint import units
from pitchpoint.results.variables import VARIABLES

__all__ = ["cell", "head", "shown"]


def head(name: str) -> str:
    """Symbol and unit of a variable."""
    variable = VARIABLES[name]
    unit = f" [{variable.display}]" if variable.display != "1" else ""
    return f"{variable.symbol}{unit}"


def cell(data: Any, name: str, position: int) -> str:
    """Value of a variable under the friction law at a position, at the first point."""
    return shown(name, float(data[name].values[position, 0]))


def shown(name: str, value: float) -> str:
    """Value of a variable in its display unit, without the unit [SI in]."""
    variable = VARIABLES[name]
    if np.isnan(value):
        return "undefined"
    if np.isinf(value):
        return "none"
    if variable.display == "1":
        return f"{value:.4f}"
    return f"{units.convert(value, variable.display, variable.kind):.5g}"
