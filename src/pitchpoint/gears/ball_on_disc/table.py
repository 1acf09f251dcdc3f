"""The table [gears] of a ball on a disc."""

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from pitchpoint.gears.ball_on_disc import MEMBERS
from pitchpoint.gears.gears_table import GearsTable, Load
from pitchpoint.input.quantities import Quantity

__all__ = ["BallOnDiscRig"]

BALL = Quantity("length", 1e-4, 1.0, "mm")
TRACK = Quantity("length", 1e-3, 10.0, "mm")
SLIDE_ROLL = Quantity("dimensionless", -1.9, 2.0)


class BallOnDiscRig(GearsTable):
    """A test rig: a ball, or a barrel of two radii, pressed on the flat face of a disc; both are driven.

    Gear 1 is the disc, gear 2 the ball, in the tables of materials and roughness. The slide-roll ratio
    is positive where the disc is the faster one, 2 with the ball at rest.
    """

    members: ClassVar[tuple[str, ...]] = MEMBERS
    load: ClassVar[Load] = "force"
    carries: ClassVar[str] = "a test rig is loaded by a normal force"
    transmits: ClassVar[bool] = False
    film_thickness: ClassVar[str] = "hamrock_dowson_1977"
    explored: ClassVar[tuple[str, float]] = ("slide_roll_ratio", 0.1)
    meaningless: ClassVar[Mapping[str, str]] = {
        "slices": "the contact of a ball is not divided into slices",
        "averaging": "the contact of a ball does not travel along a path",
    }

    family: Literal["ball_on_disc"] = "ball_on_disc"
    """Family of these gears: a test rig with a ball on a disc."""
    ball_radius: Annotated[float, BALL]
    """Radius of the ball along the track."""
    transverse_radius: Annotated[float, BALL] | None = None
    """Radius across the track, which makes a barrel; that along it unless given."""
    track_radius: Annotated[float, TRACK]
    """Radius of the track on the disc."""
    slide_roll_ratio: Annotated[float, SLIDE_ROLL] = 0.0
    """Sliding over mean surface speed, positive where the disc is faster; 0 is pure rolling."""

    @property
    def drivers(self) -> tuple[str, ...]:
        """The disc sets the speed."""
        return ("disc",)
