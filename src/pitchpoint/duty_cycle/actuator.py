"""A drive with its motor: electrical power and efficiency over torque and speed of the output."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pitchpoint.duty_cycle.history import ICE_POINT
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.efficiency.loss_table import LossTable

__all__ = ["ActuatorMap", "actuator_efficiency", "actuator_map"]

Floats = NDArray[np.float64]


class ActuatorMap(NamedTuple):
    """What an actuator takes in steady motion; NaN at rest, where friction locks it, and beyond the motor.

    Where the load is none the efficiency is not a number either.

    Attributes:
        torque: of the output on its load, shape (t,) [N m or N].
        speed: of the output, of both signs, shape (s,) [rad/s or m/s].
        power: electrical, negative where it is given back, shape (t, s) [W].
        efficiency: power out over power in, whichever way it goes, shape (t, s) [1].
    """

    torque: Floats
    speed: Floats
    power: Floats
    efficiency: Floats


def actuator_map(
    table: LossTable, motor: Motor, *, law: str, temperature: float, winding: float
) -> ActuatorMap:
    """Electrical power and efficiency at the nodes of a loss map.

    Args:
        table: loss map of the drive.
        motor: that drives it.
        law: of friction.
        temperature: of the oil [K].
        winding: temperature of the winding [K].

    From the power of the driver and what the motor loses.

    Example:
        >>> from pitchpoint.duty_cycle.motor import Motor
        >>> from pitchpoint.efficiency.loss_table import LossTable
        >>> lost = {"own": (((0.1,), (0.1,)), ((0.1,), (0.1,)), ((0.1,), (0.1,)))}
        >>> table = LossTable((-2.0, 0.0, 2.0), (0.0, 5.0), (40.0,), lost, 0.1)
        >>> motor = Motor(torque_constant=0.1, resistance=0.5)
        >>> found = actuator_map(table, motor, law="own", temperature=313.15, winding=293.15)
        >>> found.power[2].round(3).tolist()  # 2 N m at -5, 0 and 5 rad/s
        [-7.695, nan, 12.705]
        >>> found.efficiency[2].round(3).tolist()
        [0.77, nan, 0.787]
    """
    torque = np.asarray(table.torques)
    speed = np.array(
        sorted({sign * pace_size for pace_size in table.speeds for sign in (-1.0, 1.0)})
    )
    load, pace = torque[:, None], speed[None, :]
    motor_torque = np.asarray(table.at_many(load, pace, temperature - ICE_POINT, law).input_torque)
    turning = pace / table.speed_ratio + 0.0 * load
    beyond = (np.abs(motor_torque) > motor.largest_torque) | (np.abs(turning) > motor.largest_speed)
    power = (
        motor_torque * turning
        + motor.copper_loss(motor_torque, winding)
        + motor.iron_losses(turning)
    )
    power = np.where(beyond, np.nan, power)
    output = np.where(load * pace == 0.0, np.nan, load * pace)
    return ActuatorMap(torque, speed, power, actuator_efficiency(output, power))


def actuator_efficiency(output: Floats, electrical: Floats) -> Floats:
    """Power out over power in: electrical to the load, or from the load back; 0 where both go in.

    Args:
        output: power of the output on its load [W].
        electrical: power that the motor takes [W].

    Returns:
        NaN where nothing goes in.
    """
    out = np.maximum(output, 0.0) + np.maximum(-electrical, 0.0)
    into = np.maximum(electrical, 0.0) + np.maximum(-output, 0.0)
    return np.asarray(out / np.where(into > 0.0, into, np.nan), float)
