"""How one number is read out of the values of a study."""

from collections.abc import Callable

import numpy as np

__all__ = ["PLAIN", "REDUCTIONS"]

REDUCTIONS: dict[str, Callable[[np.ndarray], float]] = {
    "value": lambda v: float(v[0, 0]),
    "first": lambda v: float(v[0, 0]),
    "last": lambda v: float(v[0, -1]),
    "min": lambda v: float(v[0].min()),
    "max": lambda v: float(v[0].max()),
    "drop": lambda v: float(v[0, 0] - v[0, -1]),
    "gain": lambda v: float(v[0, -1] - v[0, 0]),
    "relative_drop": lambda v: float(1.0 - v[0, -1] / v[0, 0]),
    "ratio": lambda v: float(v[0, -1] / v[0, 0]),
    "max_difference": lambda v: float(np.abs(v[0] - v[1]).max()),
}
"""One number out of values [law, point]."""

PLAIN = ("relative_drop", "ratio")
"""Reductions whose result has no unit."""
