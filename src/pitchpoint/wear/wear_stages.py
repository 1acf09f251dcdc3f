"""Stages of wear over the life of a drive: run-in, steady and severe, by stated criteria."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from jaxtyping import Float

__all__ = ["NEAR", "SEVERE", "SEVERE_BY", "run_in_end", "severe_start"]

NEAR = 1.1
"""Rate of wear over its least up to which it counts as steady."""

SEVERE = 1.5
"""Rate of wear over its least, or pressure over that at the start, from which on wear counts as severe."""

SEVERE_BY: Mapping[str, str] = MappingProxyType(
    {"rate": "times the least rate", "pressure": "times the largest pressure at the start"}
)
"""What tells that wear is severe, by name: the curvature of the depth over the cycles, or the pressure."""

Course = Float[np.ndarray, " step"]


def run_in_end(cycles: Course, rate: Course) -> float:
    """Cycles at which the rate of wear has come down to near its least; zero if it begins there.

    Args:
        cycles: rising, shape (step,).
        rate: of wear there, positive, shape (step,).

    From the curvature of depth over cycles: in run-in the depth grows ever more slowly.
    """
    least = int(np.argmin(rate))
    return _crossing(cycles[: least + 1], rate[: least + 1] - NEAR * rate[least])


def severe_start(cycles: Course, course: Course, by: str = "rate") -> float:
    """Cycles at which wear becomes severe; NaN if it never does.

    By the rate of wear it does so where the rate has grown to `SEVERE` times its least after that; by the
    pressure where this has first grown to as many times its value at the start.

    Args:
        cycles: rising, shape (step,).
        course: of what tells it, positive, shape (step,).
        by: what that is, a name of `SEVERE_BY`.
    """
    start = 0 if by == "pressure" else int(np.argmin(course))
    beyond = course[start:] - SEVERE * course[start]
    if beyond.max() < 0.0:
        return float("nan")
    return _crossing(cycles[start:], -beyond)


def _crossing(cycles: Course, values: Course) -> float:
    """Where values have come down to zero; the first place if they have passed it there."""
    below = np.flatnonzero(values <= 0.0)
    at = int(below[0])
    if at == 0:
        return float(cycles[0])
    part = values[at - 1] / (values[at - 1] - values[at])
    return float(cycles[at - 1] + part * (cycles[at] - cycles[at - 1]))
