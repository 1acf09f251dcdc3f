"""The tables [operation], [housing] and [loss_map] of a case file."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from pitchpoint.errors import InputError
from pitchpoint.input.kinds import FORCE, MAP_SPEED, RATIO, SPEED, TEMPERATURE, TORQUE, Text
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.input.tables import Table

__all__ = ["Housing", "LossMap", "Operating"]


THERMAL_RESISTANCE = Quantity("thermal resistance", 0.0, 10.0, "K m2/W")
AREA = Quantity("area", 1e-8, 1e4, "m2")
MAP_COUNT = Quantity("dimensionless", 2, 200, whole=True)


class Operating(Table):
    """Torque on the driven member, speed of the driving one, temperature of the oil.

    The driver, where it is not given, is the first member of the gears that is not fixed. Test rigs
    take the normal force in place of the torque.
    """

    torque: Annotated[float, TORQUE] | None = None
    """Torque on the driven member; needed unless the gears take a force."""
    force: Annotated[float, FORCE] | None = None
    """Force on a rack, or normal force on a ball, in place of a torque."""
    speed: Annotated[float, SPEED]
    """Rotational speed of the driving member."""
    temperature: Annotated[float, TEMPERATURE]
    """Temperature of the oil and around the gears."""
    driver: Text = ""
    """Member that drives; the first one that is not fixed unless given."""

    @property
    def load(self) -> float:
        """Torque or force, whichever the case has [N m or N]."""
        return (self.torque if self.force is None else self.force) or 0.0


class Housing(Table):
    """How a plastic gear gets rid of its heat, for models of the tooth temperature."""

    thermal_resistance: Annotated[float, THERMAL_RESISTANCE] = 0.0
    """Resistance of the housing to the passage of heat R; 0 of an open drive."""
    area: Annotated[float, AREA] | None = None
    """Outer surface of the housing A; needed with a thermal resistance."""
    duty: Annotated[float, RATIO] = 1.0
    """Share of the time under load ED."""

    @model_validator(mode="after")
    def _both(self) -> "Housing":
        if (self.thermal_resistance > 0.0) != (self.area is not None):
            raise InputError("thermal_resistance and area of a housing belong together")
        return self


def _quadrants(value: Any) -> Any:
    """The value, unless it is a flag, which Python counts among the numbers."""
    if isinstance(value, bool):
        raise InputError(f"{shown(value)} is not allowed; use 1 or 4")
    return value


class LossMap(Table):
    """Axes of the loss map; zero torque and zero speed are allowed. A force stands for a torque of travel.

    `count` is that of both axes, `torque_count` or `force_count` and `speed_count` are those of one. With
    `quadrants` of 4 there is a map of the output too, over its torque and speed with their signs: there
    the output also drives, and loads are held at rest.
    """

    torque: Annotated[float, TORQUE] | None = None
    """Largest torque; 1.5 times that of the operating point unless given."""
    force: Annotated[float, FORCE] | None = None
    """Largest force, where gears take one; 1.5 times that of the operating point unless given."""
    speed: Annotated[float, MAP_SPEED] | None = None
    """Largest speed of the driver; 1.5 times that of the operating point unless given."""
    lowest_speed: Annotated[float, SPEED] | None = None
    """Speed of the driver from which a map of four quadrants goes up in equal ratios; 1 rpm unless given."""
    temperatures: (
        Annotated[tuple[Annotated[float, TEMPERATURE], ...], Field(max_length=50)] | None
    ) = None
    """Temperatures of the oil; that of the operating point and 20 K less and more unless given."""
    count: Annotated[float, MAP_COUNT] = 9.0
    """Points of both axes, from zero on."""
    torque_count: Annotated[float, MAP_COUNT] | None = None
    """Points of the torque axis; count unless given."""
    force_count: Annotated[float, MAP_COUNT] | None = None
    """Points of the force axis; count unless given."""
    speed_count: Annotated[float, MAP_COUNT] | None = None
    """Points of the speed axis; count unless given."""
    quadrants: Annotated[Literal[1, 4], BeforeValidator(_quadrants)] = 1
    """Quadrants of torque and speed; with 4 there is a map of the output too."""
