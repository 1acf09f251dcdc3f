"""Life of rolling bearings and of wave generators over a load history."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, nan, sqrt
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pitchpoint.duty_cycle.energy import mean_load
from pitchpoint.duty_cycle.history import LoadHistory
from pitchpoint.errors import InputError

__all__ = ["BALL", "ROLLER", "RatedBearing", "RatedLife", "system_life"]

Floats = NDArray[np.float64]

BALL, ROLLER = 3.0, 10.0 / 3.0
"""Exponents of the life over load of ball and of roller bearings: ISO 281:2007."""

SCATTER = {BALL: 10.0 / 9.0, ROLLER: 9.0 / 8.0}
"""Weibull slope of the life of bearings by the exponent of their load."""


@dataclass(frozen=True)
class RatedLife:
    """What a catalogue says of a bearing or wave generator whose load grows with that of the output.

    Attributes:
        torque: of the output at which the life was stated [N m].
        revolutions: of the output that it bears at this load, L10 with 90 % unharmed [1].
        exponent: of the life over load, 3 of balls, 10/3 of rollers.

    Raises:
        InputError: not above zero.

    Source: ISO 281:2007, L10 = (C/P)^p.

    Example:
        >>> wave_generator = RatedLife(torque=67.0, revolutions=7000.0 * 60.0 * 2000.0 / 100.0)
        >>> round(wave_generator.revolutions)
        8400000
    """

    torque: float
    revolutions: float
    exponent: float = BALL

    count: ClassVar[int] = 1

    def __post_init__(self) -> None:
        for name in ("torque", "revolutions", "exponent"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{getattr(self, name)} was given; it is above 0", key=name)

    def life(self, history: LoadHistory) -> float:
        """Time until one in ten has failed, the load history over and over [s]; infinite where nothing moves.

        Args:
            history: of the output.

        Source: ISO 281:2007, L10 = (C/P)^p; the mean load over revolutions is Miner's rule with the same p.
        """
        revolved = float(history.duration @ np.abs(history.speed)) / (2.0 * np.pi)
        if not revolved > 0.0:
            return float("inf")
        load = mean_load(history, self.exponent)
        turns = (
            float("inf")
            if load == 0.0
            else self.revolutions * (self.torque / load) ** self.exponent
        )
        return turns / revolved * float(history.duration.sum())


@dataclass(frozen=True)
class RatedBearing:
    """A rolling bearing of a drive by its dynamic load rating, under teeth whose load goes with the output.

    Attributes:
        rating: basic dynamic load rating C [N].
        exponent: p of the life over the load, 3 of balls, 10/3 of rollers.
        turning: rate of its rings against each other for a unit rate of the output [1 or rad/m].
        teeth: force of the teeth for a unit load of the output, outwards, along the circle of the axis and
            along the axis [1 or 1/m].
        pull: force outwards by turning about another axis, over the square of the rate of the output
            [N s2 or N s2/m2].
        preload: without any load [N].
        count: of equal ones, as of planets.
        static_rating: basic static load rating C_0 [N]; NaN where it is not known.

    Source: ISO 281:2007, L10 = 1e6 (C/P)^p turns.

    Example:
        >>> bearing = RatedBearing(rating=1e4, turning=5.0, teeth=(0.0, 20.0, 0.0))
        >>> round(float(bearing.load(torque=50.0, speed=10.0)), 9)
        1000.0
        >>> round(bearing.torque_under(1000.0, speed=10.0), 9)
        50.0
    """

    rating: float
    turning: float
    teeth: tuple[float, float, float]
    pull: float = 0.0
    preload: float = 0.0
    exponent: float = BALL
    count: int = 1
    static_rating: float = nan

    def load(self, torque: ArrayLike, speed: ArrayLike) -> Floats:
        """Load on the bearing [N], shape (n,) or ().

        Args:
            torque, speed: of the output, shape (n,) or () [N m or N, rad/s or m/s].

        The load on a bearing across and along its axis is taken as one force, P of ISO 281 with X = Y = 1.
        """
        outward, along, axial = np.multiply.outer(self.teeth, np.abs(torque))
        outward = outward + self.pull * np.square(speed)
        return np.asarray(self.preload + np.sqrt(outward**2 + along**2 + axial**2))

    def torque_under(self, load: float, speed: float) -> float:
        """Torque of the output under which the bearing bears a load [N m or N]: that for which `load` is it.

        Args:
            load: on the bearing [N].
            speed: of the output [rad/s or m/s].

        Returns:
            Infinite where the teeth put nothing on the bearing, NaN where it bears more without them.
        """
        outward, along, axial = self.teeth
        size, pull = outward**2 + along**2 + axial**2, self.pull * speed**2
        left = load - self.preload
        if not left >= abs(pull):
            return nan
        if size == 0.0:
            return inf
        inwards = -outward * pull
        return (inwards + sqrt(inwards**2 + size * (left**2 - pull**2))) / size

    def load_for(self, life: float, speed: float) -> float:
        """Load under which the bearing has a life [N]; infinite where it does not turn.

        Args:
            life: L10 [s].
            speed: of the output [rad/s or m/s].

        Source: ISO 281:2007, L10 = 1e6 (C/P)^p turns.
        """
        turns = life * abs(speed) * self.turning / (2.0 * np.pi)
        return self.rating * float((1e6 / turns) ** (1.0 / self.exponent)) if turns > 0.0 else inf

    def life(self, history: LoadHistory) -> float:
        """Time until one in ten has failed, the load history over and over [s]; infinite where nothing moves.

        Args:
            history: of the output.

        Source: ISO 281:2007, L10 = 1e6 (C/P)^p turns; loads one after the other by Miner's rule.
        """
        turns = history.duration * np.abs(history.speed) * self.turning / (2.0 * np.pi)
        load = self.load(history.torque, history.speed)
        used = float(turns @ (load / self.rating) ** self.exponent) / 1e6
        return float(history.duration.sum()) / used if used != 0.0 else float("inf")


def system_life(lives: Iterable[float], slope: float = SCATTER[BALL]) -> float:
    """Life that all of several parts survive as each alone survives its own, (sum L_i^-e)^(-1/e).

    Args:
        lives: in one unit, at least one.
        slope: e of the Weibull distribution, 10/9 of ball, 9/8 of roller bearings.

    Source: Lundberg and Palmgren (1947); ISO 281:2007 has it for rows of a bearing.

    Example:
        >>> round(system_life([20.0, 35.0, 12.0]), 2)
        6.83
    """
    return float((np.array([*lives]) ** -slope).sum() ** (-1.0 / slope))
