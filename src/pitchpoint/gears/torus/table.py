"""The table [gears] of a torus-involute pair."""

from math import pi
from typing import Annotated, ClassVar, Literal

from pydantic import model_validator

from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import (
    ANGLE,
    BORE,
    DISTANCE,
    FILLET,
    MODULE,
    RACK,
    SHIFT,
    WIDTH,
    GearsTable,
    PairDeviations,
)
from pitchpoint.gears.torus import MEMBERS
from pitchpoint.input.quantities import Pair, Quantity

__all__ = ["TorusGears"]

TEETH = Quantity("dimensionless", 5, 10_000, whole=True)
RADIUS = Quantity("length", 1e-4, 100.0, "mm")
OFFSET = Quantity("length", -100.0, 100.0, "mm")
SLIDE = Quantity("length", -0.1, 0.1, "mm")
INCLINATION = Quantity("angle", -0.1, 0.1, "mrad")

# Shift and torus offset say the same twice where both are given: what rounding parts is no contradiction.
_ROUNDED_SHIFT = 1e-6


class TorusGears(GearsTable):
    """A torus-involute pair: spur gears whose profile shift varies across the face, one convex, one concave.

    The reference surface of each gear is a torus: in the axial section an arc with the torus radius, whose
    centre lies beside the axis by the torus offset. A centre between axis and reference circle makes a convex
    gear, one beyond that circle a concave one; radius and offset together make the profile shift in the
    middle of the face. Without offsets gear 1 is convex and gear 2 concave. The convex radius is the smaller
    one. The narrower face counts where one width is asked for; each tooth bends over its own.
    """

    members: ClassVar[tuple[str, ...]] = MEMBERS
    friction: ClassVar[str] = "xu_2007"
    film_thickness: ClassVar[str] = "hamrock_dowson_1977"
    explored: ClassVar[tuple[str, float]] = ("inclination", 5e-3)

    family: Literal["torus"] = "torus"
    """Family of these gears: a torus-involute pair."""
    teeth: Annotated[tuple[float, float], Pair(TEETH)]
    """Numbers of teeth z1, z2."""
    module: Annotated[float, MODULE]
    """Module m."""
    face_width: Annotated[tuple[float, float], Pair(WIDTH)]
    """Face widths b1, b2."""
    torus_radius: Annotated[tuple[float, float], Pair(RADIUS)]
    """Radius of the arc that each reference surface is in the axial section."""
    torus_offset: Annotated[tuple[float, float], Pair(OFFSET)] | None = None
    """From each axis to the centre of its arc; by profile shift and torus radius unless given."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Pressure angle α of the basic rack."""
    profile_shift: Annotated[tuple[float, float], Pair(SHIFT)] | None = None
    """Profile shift coefficients in mid-face; by the torus offset, without it 0, unless given."""
    addendum: Annotated[tuple[float, float], Pair(RACK)] = (1.0, 1.0)
    """Addendum of both basic racks, in modules."""
    dedendum: Annotated[tuple[float, float], Pair(RACK)] | None = None
    """Dedendum of both basic racks, in modules; addendum of the mate + 0.25 unless given."""
    fillet_radius: Annotated[tuple[float, float], Pair(FILLET)] | None = None
    """Fillet radius ρ_fP of both basic racks in modules; 0.38 if it fits, unless given."""
    centre_distance: Annotated[float, DISTANCE] | None = None
    """Centre distance a; that without backlash unless given."""
    bore_diameter: Annotated[tuple[float, float], Pair(BORE)] | None = None
    """Bore diameters; 0.3 root diameters unless given."""
    flank: Literal["left", "right"] = "left"
    """Flanks that touch, as seen with the tooth's tip up."""
    axial_offset: Annotated[float, SLIDE] = 0.0
    """Middle plane of gear 2 from that of gear 1, along the axis z."""
    inclination: Annotated[float, INCLINATION] = 0.0
    """Tilt of the axes along the line of action; positive parts flanks towards positive z."""
    deviations: PairDeviations | None = None
    """Deviations from tooth to tooth, which make the kinematic error; none unless given."""

    @property
    def opposed(self) -> "TorusGears":
        """The same gears pressing their other flanks, which lean the other way."""
        opposite_flank = "right" if self.flank == "left" else "left"
        return self.model_copy(update={"flank": opposite_flank, "inclination": -self.inclination})

    @property
    def designation(self) -> str:
        """With the numbers of teeth of both gears."""
        pinion_teeth, wheel_teeth = self.teeth
        return f"Torus-involute pair {pinion_teeth:g}/{wheel_teeth:g}"

    @property
    def tooth_numbers(self) -> tuple[float, float]:
        """Of both members."""
        return self.teeth

    @property
    def normal_module(self) -> float:
        """Normal module [m]."""
        return self.module

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography for what is given."""
        return ("liu_xiong_2017",)

    @property
    def load_sharing(self) -> str:
        """Pairs share the load as they yield."""
        return "from_stiffness"

    @property
    def concave(self) -> tuple[bool, bool]:
        """True for a gear whose torus has its centre beyond the reference circle."""
        if self.torus_offset is None:
            return False, True
        pinion_beyond, wheel_beyond = self._beyond
        return pinion_beyond > 0.0, wheel_beyond > 0.0

    @property
    def middle_shift(self) -> tuple[float, float]:
        """Profile shift coefficients in the middle of the face."""
        if self.torus_offset is None:
            return self.profile_shift or (0.0, 0.0)
        pinion_shift, wheel_shift = (
            (beyond - radius if concave else beyond + radius) / self.module
            for beyond, radius, concave in zip(
                self._beyond, self.torus_radius, self.concave, strict=True
            )
        )
        return pinion_shift, wheel_shift

    @property
    def _beyond(self) -> tuple[float, float]:
        """How far the centre of each torus lies beyond the reference circle [m]."""
        offsets = self.torus_offset or (0.0, 0.0)
        pinion_beyond, wheel_beyond = (
            offset - z * self.module / 2.0 for offset, z in zip(offsets, self.teeth, strict=True)
        )
        return pinion_beyond, wheel_beyond

    @model_validator(mode="after")
    def _one_of_each(self) -> "TorusGears":
        self._check_shifts()
        if self.concave[0] == self.concave[1]:
            form, side = ("concave", "beyond") if self.concave[0] else ("convex", "within")
            raise InputError(
                f"both gears are {form}: the centres of both tori lie {side} the reference circles; allowed "
                "is one of each",
                key="torus_offset",
            )
        self._check_radii()
        if self.deviations is not None:
            self.deviations.check(self.teeth, self.module)
        return self

    def _check_shifts(self) -> None:
        """Radius and offset of a torus make the shift in the middle of the face; another one is refused."""
        pairs = zip(self.middle_shift, self.profile_shift or self.middle_shift, strict=True)
        for number, (shift, chosen) in enumerate(pairs, 1):
            if abs(shift - chosen) > _ROUNDED_SHIFT:
                raise InputError(
                    f"radius and offset of the torus of gear {number} make a profile shift of {shift:.6g} in "
                    f"the middle of its face, and {chosen:.6g} was given; leave one of the two out",
                    key="profile_shift",
                )

    def _check_radii(self) -> None:
        convex = self.concave.index(False)
        small, large = self.torus_radius[convex], self.torus_radius[1 - convex]
        if small >= large:
            raise InputError(
                f"the torus radius of the convex gear is {RADIUS.show(small)} and that of the concave gear "
                f"{RADIUS.show(large)}; the flanks do not cross where the convex one is the smaller",
                key="torus_radius",
            )
        for number, (radius, width) in enumerate(
            zip(self.torus_radius, self.face_width, strict=True), 1
        ):
            if width >= radius:
                raise InputError(
                    f"the face of gear {number} is {WIDTH.show(width)} wide; allowed is less than its torus "
                    f"radius, {RADIUS.show(radius)}",
                    key="face_width",
                )
        for key, shift in zip((1, 2), self.middle_shift, strict=True):
            if not SHIFT.low <= shift <= SHIFT.high:
                raise InputError(
                    f"radius and offset of the torus of gear {key} make a profile shift of {shift:.4g} in "
                    f"the middle of its face; allowed are {SHIFT.low:g} to {SHIFT.high:g}",
                    key="torus_offset",
                )
