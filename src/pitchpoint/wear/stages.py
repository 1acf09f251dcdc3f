"""Stages of wear over the life of a drive: run-in, steady and severe, by a stated criterion."""

import numpy as np
from jaxtyping import Float

__all__ = ["NEAR", "SEVERE", "run_in_end", "severe_start"]

NEAR = 1.1
"""Rate of wear over its least up to which it counts as steady."""

SEVERE = 1.5
"""Rate of wear over its least from which on wear counts as severe."""

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


def severe_start(cycles: Course, rate: Course) -> float:
    """Cycles at which the rate of wear has grown to severe ones after its least; NaN if it never does.

    Args:
        cycles: rising, shape (step,).
        rate: of wear there, positive, shape (step,).
    """
    least = int(np.argmin(rate))
    beyond = rate[least:] - SEVERE * rate[least]
    if beyond.max() < 0.0:
        return float("nan")
    return _crossing(cycles[least:], -beyond)


def _crossing(cycles: Course, values: Course) -> float:
    """Where values have come down to zero; the first place if they have passed it there."""
    below = np.flatnonzero(values <= 0.0)
    at = int(below[0])
    if at == 0:
        return float(cycles[0])
    part = values[at - 1] / (values[at - 1] - values[at])
    return float(cycles[at - 1] + part * (cycles[at] - cycles[at - 1]))
