"""How one number is read out of values over an axis."""

from collections.abc import Callable

import numpy as np

__all__ = ["INVERSE_SLOPE", "PLAIN", "REDUCTIONS", "SLOPE", "SPANS"]

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
    "max_difference": lambda v, x: float(np.abs(v[0] - v[1]).max()),
    SLOPE: lambda v, x: float((v[0, -1] - v[0, 0]) / (x[-1] - x[0])),
    INVERSE_SLOPE: lambda v, x: float((x[-1] - x[0]) / (v[0, -1] - v[0, 0])),
}
"""One number out of values [law, place] over an axis [place]."""

PLAIN = ("relative_drop", "ratio")
"""Reductions whose result has no unit."""

SPANS = ("drop", "gain", "relative_drop", "ratio", SLOPE, INVERSE_SLOPE)
"""Reductions between two places of the axis."""
