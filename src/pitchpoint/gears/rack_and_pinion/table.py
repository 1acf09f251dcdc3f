"""The table [gears] of a rack and pinion."""

from math import cos, pi
from typing import Annotated, ClassVar, Literal

from pitchpoint.gears.gears_table import (
    ANGLE,
    BORE,
    COMMON_WIDTH,
    DISTANCE,
    FILLET,
    HELIX,
    MASS,
    MODULE,
    RACK,
    SHIFT,
    GearsTable,
    Load,
)
from pitchpoint.gears.rack_and_pinion import MEMBERS
from pitchpoint.input.quantities import Pair, Quantity

__all__ = ["RackAndPinionGears"]

TEETH = Quantity("dimensionless", 2, 10_000, whole=True)


class RackAndPinionGears(GearsTable):
    """A pinion that drives a rack. Gear 1 is the pinion, gear 2 the rack, in all lists of two.

    The mounting distance is that from the pinion's axis to the reference line of the rack, without backlash
    if it is not given. The mass is that of the rack and of all that moves with it; a vibration asks for it.
    """

    members: ClassVar[tuple[str, ...]] = MEMBERS
    load: ClassVar[Load] = "force"
    carries: ClassVar[str] = "a rack carries a force"
    friction: ClassVar[str] = "iso_tr_14179_2"
    explored: ClassVar[tuple[str, float]] = ("profile_shift", 0.2)

    family: Literal["rack_and_pinion"] = "rack_and_pinion"
    """Family of these gears: a pinion that drives a rack."""
    teeth: Annotated[float, TEETH]
    """Number of teeth z of the pinion."""
    module: Annotated[float, MODULE]
    """Normal module m_n."""
    face_width: Annotated[float, COMMON_WIDTH]
    """Common face width b, also as a list of that of each gear, of which the smaller one counts."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Normal pressure angle α_n of the rack."""
    helix_angle: Annotated[float, HELIX] = 0.0
    """Helix angle β on the reference cylinder of the pinion; 0 for spur teeth."""
    profile_shift: Annotated[float, SHIFT] = 0.0
    """Profile shift coefficient x of the pinion."""
    addendum: Annotated[tuple[float, float], Pair(RACK)] = (1.0, 1.0)
    """Addendum of the pinion's basic rack and of the rack, in modules."""
    dedendum: Annotated[tuple[float, float], Pair(RACK)] | None = None
    """Dedendum of the pinion's basic rack and of the rack; the mate's addendum + 0.25 unless given."""
    fillet_radius: Annotated[tuple[float, float], Pair(FILLET)] | None = None
    """Fillet radius of the pinion's basic rack and of the rack in modules; 0.38 if it fits, unless given."""
    mounting_distance: Annotated[float, DISTANCE] | None = None
    """From the pinion's axis to the rack's reference line; without backlash unless given."""
    bore_diameter: Annotated[float, BORE] | None = None
    """Bore diameter of the pinion; 0.3 root diameters unless given."""
    mass: Annotated[float, MASS] | None = None
    """Mass of the rack and of all that moves with it; needed for a vibration."""
    flank: Literal["left", "right"] = "left"
    """Flanks that touch, as seen with the tooth's tip up."""

    @property
    def designation(self) -> str:
        """With the number of teeth of the pinion."""
        return f"{super().designation}, {self.teeth:g} teeth"

    @property
    def opposed(self) -> "RackAndPinionGears":
        """The same gears pressing their other flanks."""
        return self.model_copy(update={"flank": "right" if self.flank == "left" else "left"})

    @property
    def relative_torques(self) -> dict[str, float]:
        """Torque of the pinion [N m] for a unit force of the rack [N]."""
        radius = self.teeth * self.module / (2.0 * cos(self.helix_angle))
        return dict(zip(self.members, (radius, 1.0), strict=True))

    @property
    def drivers(self) -> tuple[str, ...]:
        """The pinion; a speed is that of a rotation."""
        return MEMBERS[:1]

    @property
    def shafts(self) -> tuple[str, ...]:
        """A rack travels."""
        return MEMBERS[:1]
