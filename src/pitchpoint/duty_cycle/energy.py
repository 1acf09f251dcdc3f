"""Power, energy and means of a drive over a load history, by its loss map."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pitchpoint.core.doubts import Doubt
from pitchpoint.duty_cycle.history import ICE_POINT, LoadHistory
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError

__all__ = [
    "DriverCourse",
    "at_the_edge",
    "demand_inside",
    "driver_course",
    "duty_energies",
    "mean_load",
]

Floats = NDArray[np.float64]

# Turns a minute of one radian a second.
_RPM = 30.0 / np.pi


class DriverCourse(NamedTuple):
    """What the driver of a drive gives and the drive loses, sample by sample, shape (n,) each.

    Attributes:
        speed: of the driver [rad/s].
        torque: of the driver on the drive, with what speeds a rotor up; at rest the least that holds the
            load, 0 where friction holds it [N m].
        power: of the driver on the drive, negative where the load drives it [W].
        loss: of the drive [W].
        motor_loss: of the motor, zero without one [W].
    """

    speed: Floats
    torque: Floats
    power: Floats
    loss: Floats
    motor_loss: Floats


def driver_course(
    table: LossTable,
    history: LoadHistory,
    *,
    law: str = "",
    motor: Motor | None = None,
    winding_temperature: Floats | float | None = None,
    inside: bool = True,
) -> DriverCourse:
    """Torque of the driver and losses at every sample.

    Args:
        table: loss map of the drive.
        history: of its output.
        law: of friction, the first one of the map by default.
        motor: whose rotor is sped up and whose losses count; none by default.
        winding_temperature: of the motor, that of the oil by default, shape (n,) or () [K].
        inside: all samples have to lie in the map; beyond it the torque that is lost is that of its edge.

    Raises:
        InputError: samples beyond the map, where friction locks the drive against the load that is to drive
            it, or above the limits of the motor.

    From the balance of power, with the torque that speeds the rotor up.
    """
    if inside:
        demand_inside(table, history)
    degrees = history.temperature - ICE_POINT
    point = table.at_many(history.torque, history.speed, degrees, law)
    _demand_free(np.asarray(point.locked), history)
    moving = history.speed != 0.0
    steady = np.where(moving, point.input_torque, 0.0)
    steady[~moving] = _holding(table, history.torque[~moving], degrees[~moving], law)
    speed = history.speed / table.speed_ratio
    rotor = 0.0 if motor is None else motor.inertia
    torque = steady + rotor * history.acceleration / table.speed_ratio
    heat = 0.0 * speed
    if motor is not None:
        _demand_limits(motor, torque, speed, history)
        warm = history.temperature if winding_temperature is None else winding_temperature
        heat = motor.copper_loss(torque, warm) + motor.iron_losses(speed)
    return DriverCourse(speed, torque, torque * speed, np.asarray(point.loss), heat)


def _holding(table: LossTable, torques: Floats, degrees: Floats, law: str) -> Floats:
    """Torque of least size that holds each load at rest; of equal loads once."""
    loads, places = np.unique(np.stack([torques, degrees]), axis=1, return_inverse=True)
    holding = []
    for load, degree in loads.T.tolist():
        at_rest = table.at_rest(load, degree, law)
        low, high = (-np.inf if np.isnan(at_rest.lowest) else at_rest.lowest), at_rest.highest
        holding.append(min(max(0.0, low), np.inf if np.isnan(high) else high))
    return np.array(holding)[places.ravel()] if holding else torques


def demand_inside(table: LossTable, history: LoadHistory, *, warm: bool = True) -> None:
    """InputError unless all samples lie in a map, with what lies outside by how much.

    Args:
        table: the map.
        history: of its output.
        warm: also by their temperatures.
    """
    along = np.where(history.speed >= 0.0, 1.0, -1.0) * history.torque
    degrees = history.temperature - ICE_POINT
    torque, speed, _ = table.units
    turns = speed == "rad/s"
    scale, unit = (_RPM, "rpm") if turns else (1.0, speed)
    paces = np.array(table.speeds) * scale
    rows = (
        ("torque", along, np.array(table.torques), torque),
        ("speed", np.abs(history.speed) * scale, paces, unit),
        ("temperature", degrees, np.array(table.temperatures), "degC"),
    )
    for name, values, axis, shown in rows if warm else rows[:2]:
        room = 1e-9 * (axis[-1] - axis[0])  # of converted units
        beyond = (values < axis[0] - room) | (values > axis[-1] + room)
        if beyond.any():
            at = int(np.argmax(beyond))
            raise InputError(
                f"{np.count_nonzero(beyond)} of {values.size} samples lie beyond the loss map, the first at "
                f"{history.time[at]:.6g} s with {values[at]:.6g} {shown}; the map has {axis[0]:.6g} to "
                f"{axis[-1]:.6g} {shown}; {_wider(history, table, name)} in the case holds it",
                key=name,
            )


def at_the_edge(table: LossTable, history: LoadHistory) -> list[Doubt]:
    """What to say of oil beyond the temperatures of a map, whose losses are those of its edge.

    Args:
        table: the map.
        history: of its output.

    Returns:
        A sentence, or none.
    """
    degrees, axis = history.temperature - ICE_POINT, np.array(table.temperatures)
    out = np.maximum(axis[0] - degrees, degrees - axis[-1])
    at = int(np.argmax(out))
    if not out[at] > 1e-6:
        return []
    edge = axis[0] if degrees[at] < axis[0] else axis[-1]
    sentence = (
        f"The loss of the drive with oil at {degrees[at]:.4g} degC is taken at {edge:.4g} degC, the edge of "
        f"the loss map; {_wider(history, table, 'temperature')} in the case holds it."
    )
    brief = f"Losses with oil at {degrees[at]:.4g} degC are those at {edge:.4g} degC."
    return [Doubt(sentence, "edge of the map", out[at], brief=brief)]


def _wider(history: LoadHistory, table: LossTable, beyond: str) -> str:
    """Setting of a map that holds what lies beyond."""
    if beyond == "torque":
        key, unit = ("force", "N") if table.units[0] == "N" else ("torque", "N m")
        return f'loss_map.{key} = "{_at_least(float(np.abs(history.torque).max()))} {unit}"'
    if beyond == "speed":
        driver = float(np.abs(history.speed).max()) / table.speed_ratio * _RPM
        return f'loss_map.speed = "{_at_least(driver)} rpm" of the driver'
    degrees = history.temperature - ICE_POINT
    low = min(np.floor(degrees.min()), table.temperatures[0])
    high = max(np.ceil(degrees.max()), table.temperatures[-1])
    return f'loss_map.temperatures = ["{low:g} degC", "{high:g} degC"]'


def _at_least(value: float) -> str:
    """A number of three digits, not below a value."""
    step = 10.0 ** (np.floor(np.log10(value)) - 2.0)
    return f"{np.ceil(value / step * (1.0 - 1e-12)) * step:.6g}"


def _demand_free(locked: NDArray[np.bool_], history: LoadHistory) -> None:
    if not locked.any():
        return
    at = int(np.argmax(locked))
    raise InputError(
        f"at {np.count_nonzero(locked)} of {locked.size} samples, the first at {history.time[at]:.6g} s, the "
        "load is to drive and friction locks the drive against it: what its driver has to add there is not "
        "in the loss map",
        key="torque",
    )


def _demand_limits(motor: Motor, torque: Floats, speed: Floats, history: LoadHistory) -> None:
    for name, values, most, unit in (
        ("largest_torque", torque, motor.largest_torque, "N m"),
        ("largest_speed", speed, motor.largest_speed, "rad/s"),
    ):
        at = int(np.argmax(np.abs(values)))
        if abs(values[at]) > most:
            raise InputError(
                f"the duty cycle asks the motor for {abs(values[at]):.6g} {unit} at "
                f"{history.time[at]:.6g} s, and {most:.6g} {unit} is the most that it has",
                key=f"motor.{name}",
            )


def duty_energies(history: LoadHistory, driver: DriverCourse) -> dict[str, float]:
    """Energies [J] and means over the cycle.

    Args:
        history: of the output.
        driver: at the same samples.

    Returns:
        By name. Power balances at each sample but for what speeds the rotor up, which a cycle gives back:
        input_energy - recovered_energy = output_energy - returned_energy + lost_energy + rotor_energy. An
        efficiency is what comes out at either end over what goes in at either: that of the drive without what
        speeds the rotor up before it, that of the actuator with it. Without a motor both are the same.

    From the integral of power over time.
    """
    seconds = history.duration
    out, drawn = history.power, driver.power
    total = float(seconds.sum())

    def whole(power: Floats) -> float:
        return float(seconds @ power)

    def of(what: Floats, base: Floats) -> float:
        """Energy out over energy in, both of power out of the one and into the other end."""
        into = whole(np.maximum(base, 0.0) + np.maximum(-what, 0.0))
        left = whole(np.maximum(what, 0.0) + np.maximum(-base, 0.0))
        return left / into if into > 0.0 else float("nan")

    def rms(values: Floats) -> float:
        return float(np.sqrt(seconds @ values**2 / total))

    electrical = drawn + driver.motor_loss
    return {
        "duration": total,
        "output_energy": whole(np.maximum(out, 0.0)),
        "returned_energy": whole(np.maximum(-out, 0.0)),
        "lost_energy": whole(driver.loss),
        "input_energy": whole(np.maximum(drawn, 0.0)),
        "recovered_energy": whole(np.maximum(-drawn, 0.0)),
        "rotor_energy": whole(drawn - out - driver.loss),
        "motor_lost_energy": whole(driver.motor_loss),
        "electrical_energy": whole(np.maximum(electrical, 0.0)),
        "electrical_recovered_energy": whole(np.maximum(-electrical, 0.0)),
        "drive_efficiency": of(out, out + driver.loss),
        "actuator_efficiency": of(out, electrical),
        "mean_electrical_power": whole(electrical) / total,
        "peak_electrical_power": float(np.abs(electrical).max()),
        "mean_loss": whole(driver.loss) / total,
        "rms_output_torque": rms(history.torque),
        "peak_output_torque": float(np.abs(history.torque).max()),
        "peak_output_speed": float(np.abs(history.speed).max()),
        "mean_output_speed": whole(np.abs(history.speed)) / total,
        "rms_input_torque": rms(driver.torque),
        "peak_input_torque": float(np.abs(driver.torque).max()),
        "peak_input_power": float(np.abs(drawn).max()),
    }


def mean_load(history: LoadHistory, exponent: float) -> float:
    """Constant load that uses up as much life over the same way, (sum n t |T|^p / sum n t)^(1/p) [N m or N].

    Args:
        history: of the output; what stands still uses up nothing.
        exponent: p of the life, 3 of ball bearings, 10/3 of roller bearings [1].

    Returns:
        The load; NaN where nothing moves.

    Source: ISO 281:2007 with Miner's rule; means over revolutions, not over time, in which heat goes.
    """
    travel = history.duration * np.abs(history.speed)
    if not travel.sum() > 0.0:
        return float("nan")
    return float((travel @ np.abs(history.torque) ** exponent / travel.sum()) ** (1.0 / exponent))
