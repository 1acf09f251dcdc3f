"""Stiffness in three slopes, lost motion and hysteresis loss, as makers of strain wave gears define them."""

from typing import Any

import numpy as np
from jaxtyping import Float

__all__ = ["LIMITS", "PARTS", "as_in_catalogues", "torques_of_catalogues"]

PARTS = ("K1", "K2", "K3")

LIMITS = (0.2, 0.7)
"""T1 and T2 over the torque of the operating point where a case gives none: about those of catalogues."""

SMALL = 0.04
"""Torque of the lost motion over that of the operating point, which stands for the rated one."""

_NEAR_ZERO = (0.005, 0.01, 0.02, SMALL, 0.06)

Torques = Float[np.ndarray, " torque"]
ByLaw = Float[np.ndarray, "law torque"]


def torques_of_catalogues(rated: float, limits: tuple[float, float] | None) -> np.ndarray:
    """Torques at which the wind-up is needed, beside those of an even grid [N m].

    Args:
        rated: torque of the operating point [N m].
        limits: T1 and T2 of the case, None for those of `LIMITS` [N m].
    """
    return np.concatenate([rated * np.array(_NEAR_ZERO), _ends(rated, limits)])


def _ends(rated: float, limits: tuple[float, float] | None) -> np.ndarray:
    """Torques at which the three slopes end; the last one at the rated torque, or beyond T2 by half of it."""
    low, high = limits or tuple(part * rated for part in LIMITS)
    return np.array([low, high, rated if high < rated else 1.5 * high])


def as_in_catalogues(
    torque: Torques,
    wind_up: Torques,
    held: ByLaw,
    play: float,
    rated: float,
    limits: tuple[float, float] | None,
) -> dict[str, tuple[tuple[str, ...], Any]]:
    """Variables of a result by name, with their dimensions.

    Args:
        torque: rising from zero [N m].
        wind_up: without friction from first touch [rad].
        held: torque that friction holds at each of them, by law [N m].
        play: rotation between both flanks without load [rad].
        rated, limits: see `torques_of_catalogues`.

    Returns:
        `slope_stiffness` K1 = T1/phi(T1), K2 = (T2 - T1)/(phi(T2) - phi(T1)), K3 beyond T2, with their ends
        `slope_torque`; `catalogue_lost_motion` between plus and minus `SMALL` of the rated torque, on the
        mean of both branches of the loop; `hysteresis_loss`, the width of the loop at no torque.

    Source: Harmonic Drive AG (2014), section 4.2 for the slopes, glossary for the others.
    """
    ends = _ends(rated, limits)
    finite = np.isfinite(wind_up)
    if np.count_nonzero(finite) < 2:
        finite = np.array([True, True] + [False] * (finite.size - 2))  # NaN throughout
    # Beyond what was found there is no figure.
    at = np.interp(ends, torque[finite], wind_up[finite], right=np.nan)
    stiffness = np.diff(ends, prepend=0.0) / np.diff(at, prepend=0.0)
    loops = [
        _loop(torque[finite], wind_up[finite], held_torque[finite], play, rated)
        for held_torque in held
    ]
    lost, loss = np.transpose(loops)
    return {
        "slope_stiffness": (("slope",), stiffness),
        "slope_torque": (("slope",), ends),
        "catalogue_lost_motion": (("law",), lost),
        "hysteresis_loss": (("law",), loss),
    }


def _loop(
    torque: Torques, wind_up: Torques, held: Torques, play: float, rated: float
) -> tuple[float, float]:
    """Lost motion and hysteresis loss of a loop over both flanks [rad]."""
    if not np.isfinite(held).all():
        return np.nan, np.nan
    load = np.concatenate([-torque[::-1], torque])
    place = np.concatenate([-wind_up[::-1] - play / 2.0, wind_up + play / 2.0])
    # At no load the flanks may be anywhere in their play, which both branches then cross.
    friction = np.concatenate([held[::-1], held]) + (play > 0.0) * np.finfo(float).tiny

    def branch(sense: float, at: float) -> float:
        """Rotation while the torque grows (1) or shrinks (-1) through a value."""
        return float(np.interp(at, load + sense * friction, place))

    def middle(at: float) -> float:
        return (branch(1.0, at) + branch(-1.0, at)) / 2.0

    lost = middle(SMALL * rated) - middle(-SMALL * rated)
    return lost, branch(-1.0, 0.0) - branch(1.0, 0.0)
