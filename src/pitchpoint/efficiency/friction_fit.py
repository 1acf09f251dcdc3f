"""Loss torque of a drive as simulators take it: constant, with the load, viscous, and how far that is off."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares, lsq_linear

from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
from pitchpoint.units import degrees_celsius

__all__ = ["FrictionFit", "LawError", "MapRange", "fit_friction", "law_errors", "loss_nodes"]

LossLaw = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque that is lost over torque along the motion, speed, temperature."""

WAYS = {"I, III": "driver drives", "II, IV": "load drives"}
"""Quadrants that mirror each other, and which end drives there."""

STEPS = 17
"""Torques and speeds at which a law is compared in a range that somebody names."""

ROUNDING = 1e-12
"""Part of the largest torque below which an error is that of arithmetic."""

SPEEDS = 40
"""Speeds of Stribeck that are tried before the nearest is made better."""


@dataclass(frozen=True)
class FrictionFit:
    """Loss torque L = constant + share |T| + viscous |w| + stribeck exp(-|w|/stribeck_speed).

    Attributes:
        constant: torque that is lost at any load and speed [torque of the output].
        driving_share: lost torque over the torque T of the output where the driver drives [1].
        driven_share: the same where the load drives; from 1 on the drive locks [1].
        viscous: over the speed w of the output [torque over speed].
        stribeck: what is lost beside it towards rest [torque of the output].
        stribeck_speed: at which that has fallen to the e-th part [speed of the output].
        largest_error, mean_error: between it and what it was fitted to [torque of the output].

    Source: Armstrong-Hélouvry, Dupont and Canudas de Wit (1994), Coulomb, viscous and Stribeck friction.
    """

    constant: float
    driving_share: float
    driven_share: float
    viscous: float
    stribeck: float = 0.0
    stribeck_speed: float = 1.0
    largest_error: float = 0.0
    mean_error: float = 0.0

    def lost(self, torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
        """Torque that is lost.

        Args:
            torque: of the output along its motion, negative where the load drives.
            speed: of the output, of either sign.

        Example:
            >>> import numpy as np
            >>> from pitchpoint.efficiency.friction_fit import FrictionFit
            >>> fit = FrictionFit(0.5, 0.01, 0.02, 0.25)
            >>> fit.lost(np.array([10.0, -10.0]), np.array([2.0, 2.0])).round(9).tolist()
            [1.1, 1.2]
        """
        values = self.constant, self.driving_share, self.driven_share, self.viscous, self.stribeck
        loss: np.ndarray = _columns(torque, np.abs(speed), self.stribeck_speed) @ np.array(values)
        return loss


class LawError(NamedTuple):
    """How far a law is off the map in two quadrants.

    Attributes:
        quadrants: "I, III", where the driver drives, or "II, IV", where the load does.
        largest: of the torque of the driver [torque of the driver].
        mean: likewise.
        share: the largest one over the largest torque of the driver there [1].
        points: at which they were compared; those at which friction locks the drive are not.
        locked: points at which friction locks the drive, of which no torque is known.
    """

    quadrants: str
    largest: float
    mean: float
    share: float
    points: int
    locked: int


@dataclass(frozen=True)
class MapRange:
    """Part of a map: least and largest amount of torque and speed of the output, and temperatures.

    Attributes:
        torque: without sign [torque of the output].
        speed: without sign, above zero [speed of the output].
        temperature: [K].
    """

    torque: tuple[float, float]
    speed: tuple[float, float]
    temperature: tuple[float, float]


class MapNodes(NamedTuple):
    """Points of a map, each with what is lost there; NaN where friction locks the drive."""

    torque: np.ndarray
    speed: np.ndarray
    temperature: np.ndarray
    lost: np.ndarray


def fit_friction(
    torque: np.ndarray, speed: np.ndarray, lost: np.ndarray, *, stribeck: bool = False
) -> FrictionFit:
    """Constants of a loss torque by least squares; none of them is negative.

    Args:
        torque: of the output along its motion, negative where the load drives [point].
        speed: of the output, above zero [point].
        lost: torque of the output that is lost [point]; points with NaN are left out.
        stribeck: True for a part that falls with speed too.

    Returns:
        The fit, with its largest and mean error at the points.

    Raises:
        InputError: fewer points than constants.

    Torques of films fall with speed, which no viscous damping does: its coefficient is then 0, its bound. The
    part that falls does so exponentially, as is usual in controllers; no source fixes its form for gears.

    Source: Stark and Parker (1995), least squares with bounds, as SciPy has it.

    Example:
        >>> import numpy as np
        >>> from pitchpoint.efficiency.friction_fit import fit_friction
        >>> torque, speed = (v.ravel() for v in np.meshgrid([-8.0, -1.0, 1.0, 8.0], [0.5, 2.0, 4.0]))
        >>> lost = 0.3 + np.where(torque < 0.0, 0.05, 0.02) * abs(torque) + 0.1 * speed
        >>> fit = fit_friction(torque, speed, lost)
        >>> round(fit.constant, 9), round(fit.driving_share, 9), round(fit.driven_share, 9)
        (0.3, 0.02, 0.05)
    """
    finite = np.isfinite(lost)
    torque, speed, lost = (np.asarray(values, float)[finite] for values in (torque, speed, lost))
    if lost.size < (6 if stribeck else 4):
        raise InputError(f"{lost.size} points with a known loss are too few for a fit of friction")
    return _fitted(torque, speed, lost, *_constants(torque, speed, lost, stribeck))


def _constants(
    torque: np.ndarray, speed: np.ndarray, lost: np.ndarray, stribeck: bool
) -> tuple[np.ndarray, float]:
    """Factors of the columns, and the speed of Stribeck."""
    plain = _bounded(_columns(torque, speed, 1.0)[:, :4], lost)
    if not stribeck:
        return np.append(plain, 0.0), 1.0
    tried = np.geomspace(speed.min(), speed.max(), SPEEDS)
    fits = [_bounded(_columns(torque, speed, falls), lost) for falls in tried]
    off = [
        np.sum((_columns(torque, speed, v) @ f - lost) ** 2)
        for v, f in zip(tried, fits, strict=True)
    ]
    best = int(np.argmin(off))
    start, scale = np.append(fits[best], tried[best]), np.abs(lost).max() or 1.0

    def errors(values: np.ndarray) -> np.ndarray:
        return np.asarray(_columns(torque, speed, values[5]) @ values[:5] - lost) / scale

    low = np.append(np.zeros(5), tried[0])
    high = np.append(np.full(5, np.inf), tried[-1])
    inside = np.clip(start, low + 1e-12 * scale, high)
    tight = {"ftol": 1e-15, "xtol": 1e-15, "gtol": 1e-15}
    better = least_squares(errors, inside, bounds=(low, high), x_scale="jac", **tight)
    factors = better.x if 2.0 * better.cost < off[best] / scale**2 else start
    return factors[:5], float(factors[5])


def _fitted(
    torque: np.ndarray, speed: np.ndarray, lost: np.ndarray, factors: np.ndarray, falls: float
) -> FrictionFit:
    off = np.abs(_columns(torque, speed, falls) @ factors - lost)
    constant, driving, driven, viscous, stribeck = map(float, factors)
    speed_and_errors = falls, float(off.max()), float(off.mean())
    return FrictionFit(constant, driving, driven, viscous, stribeck, *speed_and_errors)


def _columns(torque: np.ndarray, speed: np.ndarray, falls: float) -> np.ndarray:
    """What each constant multiplies [..., constant]."""
    torque, speed = np.broadcast_arrays(np.asarray(torque, float), np.asarray(speed, float))
    drives = np.maximum(torque, 0.0), np.maximum(-torque, 0.0)
    return np.stack([np.ones(torque.shape), *drives, speed, np.exp(-speed / falls)], axis=-1)


def _bounded(columns: np.ndarray, lost: np.ndarray) -> np.ndarray:
    """Factors of columns by least squares, none below zero; zero for a column of nothing."""
    size = np.abs(columns).max(axis=0)
    there = size > 0.0
    solution = lsq_linear(
        columns[:, there] / size[there], lost, (0.0, np.inf), method="bvls", tol=1e-15
    )
    factors = np.zeros(size.size)
    factors[there] = np.maximum(solution.x, 0.0) / size[there]
    return factors


def loss_nodes(
    table: LossTable,
    law: str = "",
    *,
    within: MapRange | None = None,
    temperature: float | None = None,
) -> MapNodes:
    """Points of a map at which a law of a simulator is held against it.

    Args:
        table: the map.
        law: of friction; the first one by default.
        within: for even steps over a part of it; all values of the table by default, without those at rest.
        temperature: for this one alone [K]; points have degC as the table.
    """
    torques, speeds, degrees = table.torques, table.speeds[1:], table.temperatures
    if within is not None:
        amounts = np.linspace(*within.torque, STEPS)
        torques = sorted({*amounts.tolist(), *(-amounts).tolist()})
        speeds = np.geomspace(*within.speed, STEPS).tolist()
        degrees = sorted({*degrees_celsius(np.linspace(*within.temperature, 3)).tolist()})
    if temperature is not None:
        degrees = [float(degrees_celsius(np.asarray(temperature)))]
    torque, speed, degree = (
        coordinate.ravel() for coordinate in np.meshgrid(torques, speeds, degrees, indexing="ij")
    )
    loss = np.asarray(table.at_many(torque, speed, degree, law).loss)
    return MapNodes(torque, speed, degree, loss / speed)


def law_errors(table: LossTable, nodes: MapNodes, law: LossLaw) -> list[LawError]:
    """How far the torque of the driver by a law is off that of the map, where the driver and the load drives.

    Args:
        table: the map.
        nodes: of it, at which they are compared.
        law: lost torque over torque along the motion, speed, temperature.
    """
    off = np.abs(law(*nodes[:3]) - nodes.lost) * table.speed_ratio
    driving = np.abs(nodes.torque + nodes.lost) * table.speed_ratio
    off = np.where(off > ROUNDING * table.torques[-1] * table.speed_ratio, off, 0.0 * off)
    errors = []
    for quadrants, there in zip(WAYS, (nodes.torque >= 0.0, nodes.torque < 0.0), strict=True):
        finite = there & np.isfinite(off)
        largest, mean = (
            (float(off[finite].max()), float(off[finite].mean())) if finite.any() else (0.0, 0.0)
        )
        most = float(driving[finite].max(initial=0.0))
        share = largest / most if most > 0.0 else 0.0
        errors.append(
            LawError(
                quadrants, largest, mean, share, int(finite.sum()), int((there & ~finite).sum())
            )
        )
    return errors
