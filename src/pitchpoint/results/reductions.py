"""How one number is read out of values over an axis."""

from collections.abc import Callable

import numpy as np

__all__ = ["INVERSE_SLOPE", "OF_TWO_LAWS", "PLAIN", "REDUCTIONS", "RISES", "SLOPE", "SPANS"]

SLOPE, INVERSE_SLOPE = "slope", "inverse_slope"

REDUCTIONS: dict[str, Callable[[np.ndarray, np.ndarray], float]] = {
    "value": lambda v, x: float(v[0, 0]),
    "first": lambda v, x: float(v[0, 0]),
    "last": lambda v, x: float(v[0, -1]),
    "min": lambda v, x: float(v[0].min()),
    "max": lambda v, x: float(v[0].max()),
    "drop": lambda v, x: float(v[0, 0] - v[0, -1]),
    "gain": lambda v, x: float(v[0, -1] - v[0, 0]),
    "relative_drop": lambda v, x: float(1.0 - v[0, -1] / v[0, 0]),
    "ratio": lambda v, x: float(v[0, -1] / v[0, 0]),
    "least_rise": lambda v, x: float(np.diff(v[0]).min()),
    "largest_rise": lambda v, x: float(np.diff(v[0]).max()),
    "max_difference": lambda v, x: float(np.abs(v[0] - v[1]).max()),
    "least_excess": lambda v, x: float((v[0] - v[1]).min()),
    SLOPE: lambda v, x: float((v[0, -1] - v[0, 0]) / (x[-1] - x[0])),
    INVERSE_SLOPE: lambda v, x: float((x[-1] - x[0]) / (v[0, -1] - v[0, 0])),
}
"""One number out of values [law, place] over an axis [place]."""

PLAIN = ("relative_drop", "ratio")
"""Reductions whose result has no unit."""

OF_TWO_LAWS = ("max_difference", "least_excess")
"""Reductions of what one law gives less another."""

RISES = ("least_rise", "largest_rise")
"""Reductions of the changes from each place to the next."""

SPANS = ("drop", "gain", "relative_drop", "ratio", *RISES, SLOPE, INVERSE_SLOPE)
"""Reductions between places of the axis, two at least."""
