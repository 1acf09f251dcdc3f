"""Loss of a drive and torque of its driver at any torque and speed of its output, from a table.

Nothing but the standard library is used: an export hands these lines over with the table.
"""

import argparse
import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any, NamedTuple

__all__ = ["LOCKED", "LossTable", "Point", "Rest", "main"]

LOCKED = -1.0
"""Stands in a table where friction locks the drive; what is lost is never negative."""


class Point(NamedTuple):
    """State of a drive at one torque and speed of its output.

    Attributes:
        loss: power lost [W]; NaN where it is not known.
        efficiency: power out over power in, whichever way it goes; NaN where none comes out.
        input_torque: of the driver, positive along a positive speed of the output; NaN where the loss is,
            and at rest, where it may have any value of a band, see `LossTable.at_rest`.
        locked: True where friction locks the drive against its output, or does so at a node beside.
        outside: True beyond the table; the torque that is lost is that of the nearest point in it.
    """

    loss: float
    efficiency: float
    input_torque: float
    locked: bool
    outside: bool


class Rest(NamedTuple):
    """Torques of the driver under which a drive stands still with a load at its output.

    Attributes:
        lowest: below it the output begins to move backwards; NaN where it is not known.
        highest: above it the output begins to move forwards; likewise.
        locked: True where friction locks the drive against a load at its output: it holds without a driver.
        outside: True beyond the table; friction is that of the nearest point in it.
        lowest_low: the lowest with as much as the spread gives of what holds bearings and seals at rest.
        lowest_high: the lowest with as little; from there to `highest_low` the drive surely holds.
        highest_low: the highest with as little.
        highest_high: the highest with as much. Without a spread these are the lowest and the highest.
    """

    lowest: float
    highest: float
    locked: bool
    outside: bool
    lowest_low: float
    lowest_high: float
    highest_low: float
    highest_high: float


class LossTable(NamedTuple):
    """Torque that a drive loses, over torque, speed and temperature of its output.

    Attributes:
        torques: of the output along its motion, ascending: positive where it drives its load, negative where
            the load drives it.
        speeds: of the output, ascending from zero, where friction is that which starts the drive from rest.
        temperatures: of the oil, ascending [degC].
        loss_torques: power lost over speed of the output, by law over torque, speed and temperature; `LOCKED`
            or NaN where there is none.
        speed_ratio: speed of the output over that of the driver, positive.
        units: of torque and speed of the output, and of torque of the driver.
        rest_bounds: torques that are lost at rest with as little and as much as the spread gives of what
            holds bearings and seals there, by law over torque and temperature; None without a spread.

    Example:
        >>> lost = {"own": (((0.0,), (-1.0,)), ((0.25,), (0.125,)), ((0.5,), (0.25,)))}
        >>> table = LossTable((-2.0, 0.0, 2.0), (0.0, 10.0), (40.0,), lost, 0.125)
        >>> table.at(1.0, 5.0, 40.0)
        Point(loss=0.9375, efficiency=0.8421052631578947, input_torque=0.1484375, locked=False, outside=False)
        >>> table.at(1.0, -5.0, 40.0).locked, table.at(3.0, 5.0, 40.0).outside
        (True, True)
        >>> table.at_rest(2.0, 40.0)[:4]
        (0.25, 0.3125, False, False)
    """

    torques: Sequence[float]
    speeds: Sequence[float]
    temperatures: Sequence[float]
    loss_torques: Mapping[str, Sequence[Sequence[Sequence[float]]]]
    speed_ratio: float
    units: Sequence[str] = ("N m", "rad/s", "N m")
    rest_bounds: "Mapping[str, Sequence[Sequence[Sequence[float]]]] | None" = None

    def at(self, torque: float, speed: float, temperature: float, law: str = "") -> Point:
        """Loss, efficiency and torque of the driver.

        Args:
            torque: of the output on its load, positive along positive speeds.
            speed: of the output.
            temperature: of the oil [degC].
            law: of friction; the first one by default.

        Returns:
            The state. The torque that is lost is linear between nodes over torque, temperature and the
            logarithm of the speed; below the lowest speed that is not zero it stays as it is there. Torque of
            the driver and efficiency follow from the balance of power; at a speed of zero they are NaN, since
            the drive stands under any torque of the band that `at_rest` gives.

        Raises:
            ValueError: there is no such law.
        """
        along = torque if speed >= 0.0 else -torque
        outside = self._outside(along, abs(speed), temperature)
        lost = self.lost(along, abs(speed), temperature, law)
        if lost < 0.0:
            return Point(math.nan, math.nan, math.nan, True, outside)
        loss = lost * abs(speed)
        if speed == 0.0:
            return Point(loss, math.nan, math.nan, False, outside)
        driving = (along + lost) * self.speed_ratio
        return Point(
            loss,
            _efficiency(along, along + lost),
            math.copysign(1.0, speed) * driving,
            False,
            outside,
        )

    def at_many(self, torque: Any, speed: Any, temperature: Any, law: str = "") -> Point:
        """The same at many points, as arrays of NumPy, which this asks for.

        Args:
            torque, speed, temperature: in any shapes that broadcast.
            law: of friction; the first one by default.

        Returns:
            Arrays of their common shape.

        Raises:
            ValueError: there is no such law.

        Example:
            >>> lost = {"own": (((0.0,), (-1.0,)), ((0.25,), (0.125,)), ((0.5,), (0.25,)))}
            >>> table = LossTable((-2.0, 0.0, 2.0), (0.0, 10.0), (40.0,), lost, 0.125)
            >>> table.at_many([1.0, 1.0], [5.0, -5.0], 40.0).loss.tolist()
            [0.9375, nan]
        """
        return _at_many(self, torque, speed, temperature, law)

    def at_rest(self, torque: float, temperature: float, law: str = "") -> Rest:
        """Torques of the driver between which the drive stands still, in the mean over the phases.

        Args:
            torque: of the output on its load, of either sign.
            temperature: of the oil [degC].
            law: of friction; the first one by default.

        Returns:
            The band. The drive holds a load without a driver where the band has zero in it.

        Raises:
            ValueError: there is no such law.
        """
        values = _named(self.loss_torques, law)
        usual = [column[0] for column in values]
        bounds = (usual, usual) if self.rest_bounds is None else _named(self.rest_bounds, law)
        outside = any(self._outside(load, 0.0, temperature) for load in (torque, -torque))
        lowest, highest, locked = self._held(usual, torque, temperature)
        least, most = (self._held(bound, torque, temperature) for bound in bounds)
        return Rest(lowest, highest, locked, outside, most[0], least[0], least[1], most[1])

    def _held(
        self, lost: "Sequence[Sequence[float]]", torque: float, temperature: float
    ) -> "tuple[float, float, bool]":
        """Band that holds a load, by losses over torque and temperature, and whether friction locks."""
        cold, warm, warmer = _cell(self.temperatures, temperature)
        cells = (_cell(self.torques, load) for load in (torque, -torque))
        forwards, back = (
            _mixed(
                _mixed(lost[light][cold], lost[light][warm], warmer),
                _mixed(lost[heavy][cold], lost[heavy][warm], warmer),
                heavier,
            )
            for light, heavy, heavier in cells
        )
        highest = math.nan if forwards < 0.0 else (torque + forwards) * self.speed_ratio
        lowest = math.nan if back < 0.0 else (torque - back) * self.speed_ratio
        return lowest, highest, forwards < 0.0 or back < 0.0

    def lost(self, torque: float, speed: float, temperature: float, law: str = "") -> float:
        """Torque that is lost at a place of the table, or at the nearest; `LOCKED` beside a node that is.

        Args:
            torque: of the output along its motion.
            speed: of the output, not negative; at zero the torque is that which starts it.
            temperature: of the oil [degC].
            law: of friction; the first one by default.
        """
        values = _named(self.loss_torques, law)

        light, heavy, heavier = _cell(self.torques, torque)
        cold, warm, warmer = _cell(self.temperatures, temperature)

        def at(column: int) -> float:
            at_light, at_heavy = values[light][column], values[heavy][column]
            return _mixed(
                _mixed(at_light[cold], at_light[warm], warmer),
                _mixed(at_heavy[cold], at_heavy[warm], warmer),
                heavier,
            )

        if speed == 0.0 or len(self.speeds) == 2:
            return at(0 if speed == 0.0 else 1)
        slow, fast, faster = _cell(self.speeds[1:], max(speed, self.speeds[1]))
        if 0.0 < faster < 1.0:
            low, high = self.speeds[slow + 1], self.speeds[fast + 1]
            faster = math.log(speed / low) / math.log(high / low)
        return _mixed(at(slow + 1), at(fast + 1), faster)

    def _outside(self, torque: float, speed: float, temperature: float) -> bool:
        place = (torque, self.torques), (speed, self.speeds), (temperature, self.temperatures)
        return not all(axis[0] <= value <= axis[-1] for value, axis in place)


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
    parser.add_argument(
        "--law", choices=[*table.loss_torques], default=next(iter(table.loss_torques))
    )
    options = parser.parse_args(arguments)
    point = table.at(options.torque, options.speed, options.temperature, options.law)
    for name, value, unit in zip(Point._fields, point, ("W", "", driver, "", ""), strict=False):
        print((name + ": " + repr(value) + " " + unit).rstrip())
    if options.speed == 0.0:
        band = table.at_rest(options.torque, options.temperature, options.law)
        print("holds from: " + repr(band.lowest) + " to " + repr(band.highest) + " " + driver)
        if table.rest_bounds is not None:
            surely, most = band.lowest_high, band.highest_low
            print("surely from: " + repr(surely) + " to " + repr(most) + " " + driver)
    return 0


CHUNK = 16384
"""Points whose arrays stay in the cache of a processor, and outweigh what calls cost."""

EVEN = 1e-12
"""Part by which steps of an axis may differ that counts as even: no cell is looked up there."""

BINS = 4096
"""Most equal parts of an axis by which its cells are looked up; of more they are searched."""


def _at_many(table: LossTable, torque: Any, speed: Any, temperature: Any, law: str) -> Point:
    import numpy as np

    corners, terms, axes = _prepared(table, _named(table.loss_torques, law))
    places = np.broadcast_arrays(
        *(np.asarray(values, float) for values in (torque, speed, temperature))
    )
    every = [np.ascontiguousarray(place).reshape(-1) for place in places]
    kinds = float, float, float, bool, bool
    results = [np.empty(every[0].size, kind) for kind in kinds]
    # What a chunk needs besides is kept for the next: memory that is taken anew costs more than the sums.
    space = np.empty((17, min(CHUNK, every[0].size)))
    cell_space = np.empty((4, space.shape[1]), np.intp)

    def fill(part: slice) -> None:
        torque, speed, degree = (values[part] for values in every)
        loss, efficiency, turning, locked, outside = (values[part] for values in results)
        work, cells = space[:, : torque.size], cell_space[:, : torque.size]
        sign, pace, along, logarithm = work[8:12]
        np.copysign(1.0, speed + 0.0, out=sign)
        np.abs(speed, out=pace)
        np.multiply(torque, sign, out=along)
        np.log(pace, out=logarithm)
        weights = work[12:15]
        outside[:] = ~(pace <= table.speeds[-1])  # of what is not a number too
        for place, axis, weight, low in zip(
            (along, logarithm, degree), axes, weights, cells, strict=False
        ):
            near = axis(place, weight, low, work[15:], cells[3])
            if place is not logarithm:
                outside |= place != near
        still = pace == 0.0
        resting = still.any()
        cells[1] += 1
        if resting:
            cells[1][still] = 0
        cell = cells[0]
        for low, count in zip(cells[1:3], corners.shape[2:], strict=True):
            cell *= count
            cell += low
        lost = _sum(terms, cell, weights, work[:8])
        locked[:] = False
        if (missing := np.isnan(lost)).any():
            beside = [axis_weights[missing] for axis_weights in weights]
            lost[missing], locked[missing] = _beside(corners, cell[missing], beside)
        np.multiply(lost, pace, out=loss)
        driving = np.add(along, lost, out=lost)
        share = np.divide(along, driving, out=along)
        np.minimum(share, np.divide(1.0, share, out=logarithm), out=efficiency)
        efficiency[~(share > 0.0)] = math.nan
        np.multiply(driving, sign, out=turning)
        turning *= table.speed_ratio
        if resting:
            efficiency[still] = turning[still] = math.nan

    with np.errstate(all="ignore"):
        for start in range(0, every[0].size, CHUNK):
            fill(slice(start, start + CHUNK))
    return Point._make(values.reshape(places[0].shape) for values in results)


_KEPT: "dict[int, tuple[Any, ...]]" = {}
"""What arrays ask of a table, by the identity of its values, which stand first so that it stays theirs."""


def _prepared(table: LossTable, values: "Sequence") -> "tuple[Any, Any, Any]":  # type: ignore[type-arg]
    import numpy as np

    if id(values) not in _KEPT:
        corners = _corners(np.array(values, float))
        moving = [math.log(speed) for speed in table.speeds[1:]]
        axes = [_finder(nodes) for nodes in (table.torques, moving, table.temperatures)]
        if len(_KEPT) > 8:
            _KEPT.clear()
        _KEPT[id(values)] = values, corners, _terms(corners), axes
    return _KEPT[id(values)][1:]


def _corners(values: Any) -> Any:
    """Values at the corners of every cell [corner, torque, speed, temperature]; the first speed is rest."""
    import numpy as np

    torques, speeds, degrees = values.shape

    def ends(count: int) -> "tuple[list[int], list[int]]":
        lower = [*range(max(count - 1, 1))]
        return lower, [min(node + 1, count - 1) for node in lower]

    slow, fast = ([0, *(node + 1 for node in side)] for side in ends(speeds - 1))
    sides = ends(torques), (slow, fast), ends(degrees)
    return np.stack([values[np.ix_(*corner)] for corner in product(*sides)])


def _terms(corners: Any) -> Any:
    """Factors of 1, w, v, v w, u, ... in every cell, of the parts u, v, w of torque, speed, temperature."""
    import numpy as np

    cube = np.where(corners < 0.0, math.nan, corners).reshape(2, 2, 2, -1)
    for axis in range(3):
        low, high = np.split(cube, 2, axis)
        cube = np.concatenate([low, high - low], axis)
    return cube.reshape(8, -1)


def _sum(terms: Any, cell: Any, weights: Any, space: Any) -> Any:
    """Sum of the terms of its cell at every point, in the first row of a space with one for each term."""
    for term, value in zip(terms, space, strict=True):
        term.take(cell, mode="clip", out=value)
    values = [*space]
    for weight in weights[::-1]:
        for base, slope in zip(values[::2], values[1::2], strict=True):
            slope *= weight
            base += slope
        values = values[::2]
    return values[0]


def _finder(nodes: Sequence[float]) -> Any:
    """Function of places on an axis that writes parts of the way through their cells, and these cells.

    It gives the places kept within the axis, in the first of two rows of numbers that are free, beside one of
    whole numbers.
    """
    import numpy as np

    ends = np.array([*nodes, *([nodes[0] + 1.0] if len(nodes) == 1 else [])])
    steps, upper = 1.0 / np.diff(ends), np.append(ends[1:-1], math.inf)
    count = math.ceil((ends[-1] - ends[0]) * steps.max())
    finer = count / (ends[-1] - ends[0])
    lowest = ends[0] + (np.arange(count + 1 if count < BINS else 0) - 1e-9) / finer
    cell_of_bin = np.searchsorted(ends[1:-1], lowest, "right")
    even = np.ptp(steps) < EVEN * steps.max()

    def find(place: Any, weight: Any, low: Any, free: Any, bins: Any) -> Any:
        near, scratch = free
        np.minimum(np.maximum(place, nodes[0], out=near), nodes[-1], out=near)
        np.subtract(near, ends[0], out=weight)
        if even:
            weight *= steps[0]
            low[:] = np.fmin(weight, steps.size - 0.5, out=scratch)
            weight -= low
            return near
        if cell_of_bin.size:
            weight *= finer
            bins[:] = weight
            cell_of_bin.take(bins, mode="clip", out=low)
            low += near >= upper.take(low, out=scratch)
        else:
            low[:] = np.searchsorted(ends[1:-1], near, "right")
            low[np.isnan(near)] = 0
        np.subtract(near, ends.take(low, out=scratch), out=weight)
        weight *= steps.take(low, out=scratch)
        return near

    return find


def _beside(corners: Any, cell: Any, weights: Any) -> "tuple[Any, Any]":
    """Torque that is lost and whether friction locks the drive, where not every corner has a value."""
    import numpy as np

    def ends(weight: Any) -> "tuple[Any, Any]":
        near = np.rint(weight)
        snapped = np.where(abs(weight - near) < 1e-9, near, weight)
        return 1.0 - snapped, snapped

    parts = np.stack([u * v * w for u, v, w in product(*map(ends, weights))])
    values = corners.reshape(8, -1)[:, cell]
    counts = parts > 0.0
    locked = (counts & (values < 0.0)).any(axis=0)
    lost = np.where(counts, parts * values, 0.0 * parts).sum(axis=0)
    return np.where(locked, math.nan, lost), locked


def _efficiency(delivered: float, taken: float) -> float:
    """Power out over power in, from torques of the output and of the driver along the motion."""
    if delivered > 0.0 and taken > 0.0:
        return delivered / taken
    return taken / delivered if delivered < 0.0 and taken < 0.0 else math.nan


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
