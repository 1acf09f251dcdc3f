"""The table [duty] of a case file: a load over time, the motor, what is rated, and where heat goes."""

from typing import Annotated

from pydantic import Field

from pitchpoint.input.kinds import LIFE_EXPONENT, Text
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import Table

__all__ = [
    "LARGEST",
    "DutyTable",
    "HeatTable",
    "MotorTable",
    "RatedLifeTable",
    "ResistanceTable",
    "WarmBody",
]


TORQUE_CONSTANT = Quantity("torque constant", 0.0, 1e6, "N m/A", open_low=True)
OHMS = Quantity("electrical resistance", 0.0, 1e6, "ohm", open_low=True)
ROTOR = Quantity("moment of inertia", 0.0, 1e9, "kg m2")
IRON = Quantity("power", 0.0, 1e6, "W")
IRON_EXPONENT = Quantity("dimensionless", 1.0, 2.0)
LARGEST_TORQUE = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
LARGEST_SPEED = Quantity("rotational speed", 0.0, 1e6, "rpm", open_low=True)
TURNS = Quantity("dimensionless", 0.0, 1e15, open_low=True)
CAPACITY = Quantity("heat capacity", 0.0, 1e12, "J/K", open_low=True)
TO_HEAT = Quantity("resistance to heat", 0.0, 1e9, "K/W", open_low=True)
WARM = Quantity("temperature", 150.0, 600.0, "degC")

MOST_PARTS = 20
"""Largest number of bearings, of bodies and of resistances."""


class MotorTable(Table):
    """The motor that drives, by values of its data sheet, all at its own shaft.

    The current of the torque constant loses R i^2 in the resistance; with three phases in field orientation
    that is 1.5 times the resistance of a phase for the amplitude of the phase current.
    """

    torque_constant: Annotated[float, TORQUE_CONSTANT]
    """Torque over current."""
    resistance: Annotated[float, OHMS]
    """Resistance at 20 degC; that of copper grows with the temperature of the winding."""
    inertia: Annotated[float, ROTOR] = 0.0
    """Moment of inertia of the rotor with what turns beside it before the gears."""
    iron_loss: Annotated[float, IRON] = 0.0
    """Loss by turning alone at 1 rad/s; it grows with the speed to the power of iron_exponent."""
    iron_exponent: Annotated[float, IRON_EXPONENT] = 1.5
    """Exponent of the speed, from 1 of hysteresis alone to 2 of eddy currents alone."""
    largest_torque: Annotated[float, LARGEST_TORQUE] | None = None
    """Largest torque that it gives for a moment; not asked unless given."""
    largest_speed: Annotated[float, LARGEST_SPEED] | None = None
    """Largest speed; not asked unless given."""


class RatedLifeTable(Table):
    """What a catalogue says of the life of a bearing or a wave generator."""

    torque: Annotated[float, LARGEST_TORQUE]
    """Torque of the output at which the life is stated."""
    revolutions: Annotated[float, TURNS]
    """Turns of the output that it bears under this torque, with 90 % unharmed."""
    exponent: Annotated[float, LIFE_EXPONENT] = 3.0
    """Exponent of the life over the load, 3 of balls, 10/3 of rollers."""


class WarmBody(Table):
    """A body of one temperature that stores heat."""

    heat_capacity: Annotated[float, CAPACITY]
    """Its mass times its specific heat."""
    largest_temperature: Annotated[float, WARM] | None = None
    """Temperature that it bears; a body that gets hotter fails first. Not asked unless given."""


class ResistanceTable(Table):
    """A resistance to the heat between two bodies, or a body and the air around."""

    between: Annotated[tuple[Text, Text], Field(examples=[["gears", "ambient"]])]
    """The two bodies; one of them may be ambient."""
    resistance: Annotated[float, TO_HEAT]
    """Difference of their temperatures over the power that passes."""


class HeatTable(Table):
    """Where losses go as heat: bodies and resistances, by names of one's own.

    Temperatures are those of a cycle that repeats for ever; the oil has that of the body `gears`.
    """

    gears: Text
    """Body that the loss of the drive heats, whose temperature is that of the oil."""
    motor: Text = ""
    """Body that the loss of the motor heats, its winding; that of the gears unless given."""
    ambient: Annotated[float, WARM] = 293.15
    """Temperature of the air around."""
    bodies: Annotated[dict[str, WarmBody], Field(min_length=1, max_length=MOST_PARTS)]
    """Bodies by names of one's own."""
    resistances: Annotated[dict[str, ResistanceTable], Field(min_length=1, max_length=MOST_PARTS)]
    """Resistances by names of one's own."""


class DutyTable(Table):
    """A duty cycle: torque and speed of the output over time, over and over.

    `file` has comma separated values beside the case, with heads as `time [s]` or `duration [s]`,
    `torque [N m]`, `speed [rpm]`, and `temperature [degC]` where the oil is not always that of the operating
    point. Torque is that of the output on its load, positive along positive speeds. It asks for
    `loss_map.quadrants = 4`, and the loss map has to hold it. Teeth are rated by ISO 6336 at each load, where
    it rates them.
    """

    file: Text
    """File of comma separated values beside the case file, with units in its heads."""
    law: Text = ""
    """Friction law of the cycle by name; unless given the first one, with the spread of all beside it."""
    motor: MotorTable | None = None
    """Motor by value, whose losses count; none unless given."""
    lives: Annotated[dict[str, RatedLifeTable], Field(max_length=MOST_PARTS)] = Field(
        default_factory=dict
    )
    """Bearings and wave generators with their rated life, by names of one's own; none unless given."""
    heat: HeatTable | None = None
    """Bodies and resistances that give temperatures; those of the file unless given."""


LARGEST = 1 << 28
"""Bytes of a file; ten million samples have some 200 MB."""
