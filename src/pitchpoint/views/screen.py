"""Cells of the tables that the command line prints."""

from typing import Any

import numpy as np

from pitchpoint.analyses.main_figures import efficiency_coverage
from pitchpoint.views.show import axis_title, described, displayed, number_text

__all__ = ["cell", "efficiency_of", "head", "screen_value"]


def head(name: str, of: Any = None) -> str:
    """Long name and unit of a variable: a screen has no room for a list of symbols."""
    return axis_title(name, of)


def cell(data: Any, name: str, position: int) -> str:
    """Value of a variable under the friction law at a position, at the first point."""
    return screen_value(name, float(data[name].values[position, 0]), data)


def efficiency_of(data: Any) -> dict[str, str]:
    """Column on what an efficiency is of; none where it is of the whole drive."""
    of = efficiency_coverage(data).partition(":")[0]
    return {"efficiency of": of} if of else {}


def screen_value(name: str, value: float, of: Any = None) -> str:
    """Value of a variable in its display unit, without the unit [SI in], see `show.described`."""
    variable = described(name, of)
    if np.isnan(value):
        return "undefined"
    if np.isinf(value):
        return "none"
    return number_text(float(displayed(variable, value)))
