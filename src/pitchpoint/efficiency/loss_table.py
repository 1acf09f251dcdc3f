"""Loss of a drive and torque of its driver at any torque and speed of its output, from a table.

Nothing but the standard library is used: an export hands these lines over with the table.
"""

import argparse
import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from typing import NamedTuple

__all__ = ["LOCKED", "LossTable", "Point", "main"]

LOCKED = -1.0
"""Stands in a table where friction locks the drive; a loss is never negative."""


class Point(NamedTuple):
    """State of a drive at one torque and speed of its output.

    Attributes:
        loss: power lost [W]; NaN where it is not known.
        efficiency: power out over power in, whichever way it goes; NaN where none comes out.
        input_torque: of the driver, positive along a positive speed of the output; NaN where the loss is,
            and at rest, where friction takes what is less than the torques of `LossTable.at_rest`.
        locked: True where friction locks the drive against its output, or does so at a node beside.
        outside: True beyond the table; the loss is that of the nearest point in it.
    """

    loss: float
    efficiency: float
    input_torque: float
    locked: bool
    outside: bool


class LossTable(NamedTuple):
    """Losses over torque, speed and temperature, and torques that start the drive from rest.

    Attributes:
        torques: of the output along its motion, ascending: positive where it drives its load, negative where
            the load drives it.
        speeds: of the output, ascending from zero.
        temperatures: of the oil, ascending [degC].
        losses: by law over torque, speed and temperature [W]; `LOCKED` or NaN where there is none.
        speed_ratio: speed of the output over that of the driver, positive.
        rest: temperatures of the torques that start the drive from rest, ascending [degC].
        starting: torque of the driver that starts it without load, by law over these temperatures.
        back_driving: torque of the output that starts it backwards, likewise; NaN where none does.
        units: of torque and speed of the output, and of torque of the driver.

    Example:
        >>> losses = {"own": (((0.0,), (-1.0,)), ((0.0,), (1.0,)), ((0.0,), (2.0,)))}
        >>> table = LossTable((-2.0, 0.0, 2.0), (0.0, 10.0), (40.0,), losses, 0.1)
        >>> table.at(1.0, 5.0, 40.0)
        Point(loss=0.75, efficiency=0.8695652173913043, input_torque=0.115, locked=False, outside=False)
        >>> table.at(1.0, -5.0, 40.0).locked, table.at(3.0, 5.0, 40.0).outside
        (True, True)
    """

    torques: Sequence[float]
    speeds: Sequence[float]
    temperatures: Sequence[float]
    losses: Mapping[str, Sequence[Sequence[Sequence[float]]]]
    speed_ratio: float
    rest: Sequence[float] = ()
    starting: Mapping[str, Sequence[float]] = {}
    back_driving: Mapping[str, Sequence[float]] = {}
    units: Sequence[str] = ("N m", "rad/s", "N m")

    def at(self, torque: float, speed: float, temperature: float, law: str = "") -> Point:
        """Loss, efficiency and torque of the driver.

        Args:
            torque: of the output on its load, positive along positive speeds.
            speed: of the output.
            temperature: of the oil [degC].
            law: of friction; the first one by default.

        Returns:
            The state. The loss is linear between nodes; below the lowest speed that is not zero it goes with
            the power of the speed that leads to the next node, the first power at least. Torque and
            efficiency follow from the balance of power.

        Raises:
            ValueError: there is no such law.
        """
        along = torque if speed >= 0.0 else -torque
        place = (along, self.torques), (abs(speed), self.speeds), (temperature, self.temperatures)
        outside = not all(axis[0] <= value <= axis[-1] for value, axis in place)
        loss = self._loss(_named(self.losses, law), along, abs(speed), temperature)
        if loss < 0.0:
            return Point(math.nan, math.nan, math.nan, True, outside)
        if speed == 0.0:
            return Point(loss, math.nan, math.nan, False, outside)
        given = torque * speed
        taken = given + loss
        turning = taken / (speed / self.speed_ratio)
        return Point(loss, _efficiency(given, taken), turning, False, outside)

    def at_rest(self, temperature: float, law: str = "") -> "tuple[float, float]":
        """Torque of the driver that starts the drive from rest without load, and that of the output.

        Args:
            temperature: of the oil [degC]; beyond the table its end counts.
            law: of friction; the first one by default.

        Returns:
            Both torques; NaN where the table has none, and where friction holds the drive whatever they are.
        """
        if not self.rest:
            return math.nan, math.nan
        low, high, weight = _cell(self.rest, temperature)
        first, second = _named(self.starting, law), _named(self.back_driving, law)
        return (
            _mixed(first[low], first[high], weight),
            _mixed(second[low], second[high], weight),
        )

    def _loss(
        self,
        losses: Sequence[Sequence[Sequence[float]]],
        torque: float,
        speed: float,
        temperature: float,
    ) -> float:
        """Loss at a place of the table, or at the nearest one; `LOCKED` beside a node that is."""
        few, many, more = _cell(self.torques, torque)
        cold, warm, warmer = _cell(self.temperatures, temperature)

        def at(column: int) -> float:
            first, second = losses[few][column], losses[many][column]
            return _mixed(
                _mixed(first[cold], first[warm], warmer),
                _mixed(second[cold], second[warm], warmer),
                more,
            )

        slow, fast, faster = _cell(self.speeds, speed)
        if slow > 0 or faster in (0.0, 1.0) or len(self.speeds) == 2:
            return _mixed(at(slow), at(fast), faster)
        loss, beyond = at(1), at(2)
        if not (0.0 < loss < beyond):
            return _mixed(at(0), loss, faster)
        power = math.log(beyond / loss) / math.log(self.speeds[2] / self.speeds[1])
        return float(loss * faster ** max(power, 1.0))


def main(table: LossTable, about: str = "", arguments: "Sequence[str] | None" = None) -> int:
    """Print the state at a torque, speed and temperature.

    Args:
        table: of the drive.
        about: what `--help` says.
        arguments: of the command line; those of the process by default.

    Returns:
        Exit status.
    """
    torque, speed, driver = table.units
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=about, formatter_class=form)
    parser.add_argument("--torque", type=float, required=True, help="of the output, " + torque)
    parser.add_argument("--speed", type=float, required=True, help="of the output, " + speed)
    parser.add_argument("--temperature", type=float, required=True, help="of the oil, degC")
    parser.add_argument("--law", choices=[*table.losses], default=next(iter(table.losses)))
    asked = parser.parse_args(arguments)
    found = table.at(asked.torque, asked.speed, asked.temperature, asked.law)
    for name, value, unit in zip(Point._fields, found, ("W", "", driver, "", ""), strict=False):
        print((name + ": " + repr(value) + " " + unit).rstrip())
    return 0


def _efficiency(given: float, taken: float) -> float:
    """Power out over power in from power at the output and at the driver, both along the drive."""
    if given > 0.0 and taken > 0.0:
        return given / taken
    return taken / given if given < 0.0 and taken < 0.0 else math.nan


def _cell(axis: Sequence[float], value: float) -> "tuple[int, int, float]":
    """Nodes on either side of a value, and how far it is from the first to the second."""
    low = min(max(bisect_right(axis, value) - 1, 0), max(len(axis) - 2, 0))
    high = min(low + 1, len(axis) - 1)
    if low == high or value <= axis[low]:
        return low, high, 0.0
    return low, high, min((value - axis[low]) / (axis[high] - axis[low]), 1.0)


def _mixed(first: float, second: float, weight: float) -> float:
    """Value between two nodes; locked where one of them is that counts."""
    if weight in (0.0, 1.0):
        return first if weight == 0.0 else second
    return LOCKED if first < 0.0 or second < 0.0 else first + weight * (second - first)


def _named(values: "Mapping[str, Sequence]", law: str) -> "Sequence":  # type: ignore[type-arg]
    name = law or next(iter(values))
    if name not in values:
        raise ValueError("law: there is no " + repr(name) + ", but " + ", ".join(values))
    return values[name]
