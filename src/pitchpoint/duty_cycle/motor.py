"""A motor by values of its data sheet: current, losses and electrical power."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pitchpoint.errors import InputError

__all__ = ["COPPER", "Motor"]

COPPER = 0.00393
"""Rise of the resistance of copper with temperature, of that at 20 degC [1/K]: IEC 60028."""

_REFERENCE = 293.15
"""Temperature at which resistances are stated, 20 degC [K]."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Motor:
    """A motor by value; all torques and speeds are those of its own shaft.

    Attributes:
        torque_constant: torque over current [N m/A].
        resistance: at 20 degC, on which the current of `torque_constant` loses R i^2 [ohm].
        inertia: of the rotor with what turns beside it before the gears [kg m2].
        iron_loss: at 1 rad/s; it goes with the speed to the power of iron_exponent [W].
        iron_exponent: 1 of hysteresis alone to 2 of eddy currents alone [1].
        largest_torque: that it gives for a moment; not asked where infinite [N m].
        largest_speed: likewise [rad/s].

    For a motor with three phases in field orientation the amplitude of the phase current and its torque
    constant go with 1.5 times the resistance of a phase; that of line to line is 2 R of a phase.

    Raises:
        InputError: a constant that is not above zero, or negative inertia or loss.

    From torque in proportion to current, and R i^2 lost in the resistance.

    Example:
        >>> import numpy as np
        >>> motor = Motor(torque_constant=0.1, resistance=0.5)
        >>> motor.copper_loss(np.array([0.2]), 293.15).tolist()
        [2.0]
    """

    torque_constant: float
    resistance: float
    inertia: float = 0.0
    iron_loss: float = 0.0
    iron_exponent: float = 1.5
    largest_torque: float = math.inf
    largest_speed: float = math.inf

    def __post_init__(self) -> None:
        for name in ("torque_constant", "resistance", "largest_torque", "largest_speed"):
            if not getattr(self, name) > 0.0:
                raise InputError(
                    f"{getattr(self, name)} was given; it is above 0", key=f"motor.{name}"
                )
        for name in ("torque_constant", "resistance"):
            if math.isinf(getattr(self, name)):
                raise InputError("inf was given; it is finite", key=f"motor.{name}")
        for name in ("inertia", "iron_loss"):
            if not 0.0 <= getattr(self, name) < math.inf:
                raise InputError(
                    f"{getattr(self, name)} was given; it is not negative", key=f"motor.{name}"
                )
        if not 1.0 <= self.iron_exponent <= 2.0:
            raise InputError(
                f"{self.iron_exponent} was given; allowed is 1 to 2", key="motor.iron_exponent"
            )

    def copper_loss(self, torque: Floats, temperature: Floats | float) -> Floats:
        """R i^2 of the current that gives a torque, R = R_20 (1 + 0.00393/K (T - 20 degC)) [W].

        Args:
            torque: shape (...) [N m].
            temperature: of the winding, shape (...) [K].
        """
        warm = self.resistance * (1.0 + COPPER * (np.asarray(temperature) - _REFERENCE))
        return warm * (torque / self.torque_constant) ** 2

    def iron_losses(self, speed: Floats) -> Floats:
        """Loss by turning alone [W].

        Args:
            speed: shape (...) [rad/s].
        """
        return self.iron_loss * np.abs(speed) ** self.iron_exponent
