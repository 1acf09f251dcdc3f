"""The table [gears] of a pair of cylindrical gears."""

from dataclasses import dataclass
from math import ceil, cos, hypot, isnan, nan, pi
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, GetJsonSchemaHandler, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical import MEMBERS, din_3967, iso_286
from pitchpoint.gears.cylindrical.drawing_dimensions import (
    Toothing,
    allowance_for,
    backlash,
    distance_without_backlash,
    profile_shift_sum,
)
from pitchpoint.gears.cylindrical.iso_1328 import flank_tolerances
from pitchpoint.gears.gears_table import (
    ANGLE,
    BORE,
    COMMON_WIDTH,
    DEVIATION,
    DISTANCE,
    FILLET,
    HELIX,
    MODULE,
    RACK,
    SHIFT,
    GearsTable,
    PairDeviations,
)
from pitchpoint.input.quantities import Pair, Quantity, for_both, named
from pitchpoint.input.tables import Table

__all__ = [
    "FROM_CENTRE_DISTANCE",
    "CylindricalGears",
    "FlankModifications",
    "GearDeviations",
    "Inspection",
]

TEETH = Quantity("dimensionless", -10_000, 10_000, whole=True)
TIP = Quantity("dimensionless", -2.0, 2.0)
LEAST_TIP = Quantity("dimensionless", 0.0, 1.5)
RELIEF = Quantity("length", 0.0, 1e-2, "um")
RELIEF_LENGTH = Quantity("length", 0.0, 1.0, "mm", open_low=True)
MISALIGNMENT = Quantity("length", -1e-2, 1e-2, "um")
TOLERANCE_CLASS = Quantity("dimensionless", 1, 11, whole=True)
SEED = Quantity("dimensionless", 0, 1_000_000, whole=True)
SHARE = Quantity("dimensionless", 0.0, 1.0)
ALLOWANCE = Quantity("length", -1e-2, 1e-2, "um")
SPAN = Quantity("dimensionless", 1, 1_000, whole=True)

CUTTER_TEETH = Quantity("dimensionless", 5, 1_000, whole=True)

_ROUNDED = 1e-9
"""Thickness that is left to rounding [modules]."""

FEWEST_TEETH = 2
FEWEST_RING_TEETH = 10


def _teeth(value: tuple[float, float]) -> tuple[float, float]:
    pinion_teeth, wheel_teeth = value
    if pinion_teeth < FEWEST_TEETH:
        raise InputError(
            f"gear 1 was given {pinion_teeth:.0f} teeth; allowed are {FEWEST_TEETH} or more, and only gear 2 "
            "may be a ring, with its number of teeth negative"
        )
    if -FEWEST_RING_TEETH < wheel_teeth < FEWEST_TEETH:
        raise InputError(
            f"gear 2 was given {wheel_teeth:.0f} teeth; allowed are {FEWEST_TEETH} or more, or for a ring "
            f"with internal teeth -{FEWEST_RING_TEETH} or less"
        )
    return value


FROM_CENTRE_DISTANCE = "from centre distance"
"""In the place of a profile shift: the one that leaves no backlash at the centre distance."""

_LENGTHS = ("tip_relief", "root_relief", "end_relief")


@dataclass(frozen=True)
class _Shifts(Pair):
    """Profile shifts by value, or NaN where they are to follow from the centre distance."""

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """What editors know of the values."""
        either = {"anyOf": [self.each.json_schema, {"const": FROM_CENTRE_DISTANCE}]}
        both = {"type": "array", "items": either, "minItems": 2, "maxItems": 2}
        return {"anyOf": [*either["anyOf"], both], "description": self.told}

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        return f'{super().told}; "{FROM_CENTRE_DISTANCE}" for both or for one of them'

    def read(self, value: Any) -> tuple[float, float]:
        """Coefficients of gear 1 and gear 2."""
        every = list(value) if isinstance(value, list | tuple) else [value, value]
        if len(every) != 2 or FROM_CENTRE_DISTANCE not in every:
            return super().read(value)
        pinion_shift, wheel_shift = (
            nan if part == FROM_CENTRE_DISTANCE else self.each.read(part) for part in every
        )
        return pinion_shift, wheel_shift


class FlankModifications(Table):
    """Modifications that all teeth of a gear have, along the normal; one value for both gears or two.

    Lengths of tip and root relief are roll lengths, from the tip circle and from the start of the active
    profile; without them a relief ends where one pair less is in contact. That of an end relief is along
    the face, by default a module and at most a tenth of the face.
    """

    tip_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    """Tip relief C_αa at the tip circle; none unless given."""
    tip_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None
    """Roll length of the tip relief; up to where one pair less is in contact unless given."""
    root_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    """Root relief C_αf at the start of the active profile; none unless given."""
    root_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None
    """Roll length of the root relief; up to where one pair less is in contact unless given."""
    relief_shape: Literal["linear", "parabolic"] = "linear"
    """How all reliefs grow towards their ends."""
    crowning: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    """Lead crowning C_β at the ends of the face; none unless given."""
    end_relief: Annotated[tuple[float, float], Pair(RELIEF)] | None = None
    """End relief C_βI = C_βII at both ends of the face; none unless given."""
    end_relief_length: Annotated[tuple[float, float], Pair(RELIEF_LENGTH)] | None = None
    """Length of each end relief; a module, at most a tenth of the face, unless given."""

    @property
    def amounts(self) -> dict[str, tuple[float, float]]:
        """Amounts that are given, by key."""
        by_key = {key: getattr(self, key) for key in (*_LENGTHS, "crowning")}
        return {key: value for key, value in by_key.items() if value is not None}

    @model_validator(mode="after")
    def _together(self) -> "FlankModifications":
        for key in _LENGTHS:
            if getattr(self, f"{key}_length") is not None and getattr(self, key) is None:
                raise InputError(
                    f"was given without {key}, to which it belongs", key=f"{key}_length"
                )
        return self


class GearDeviations(PairDeviations):
    """How far flanks lie behind their places, differently from tooth to tooth.

    As waves around each gear, and as gears at the limits of a class of ISO 1328-1 that a seed draws at
    random. They make the kinematic error; loads, losses and stiffness are those of teeth without them.
    """

    iso_class: Annotated[tuple[float, float], Pair(TOLERANCE_CLASS)] | None = None
    """Flank tolerance class of ISO 1328-1 at whose limits gears are drawn; none unless given."""
    seed: Annotated[float, SEED] = 1.0
    """Number from which gears at the limits of the class are drawn; the same one gives the same gears."""
    share_of_tolerance: Annotated[tuple[float, float], Pair(SHARE)] | None = None
    """Part of these limits that each gear reaches, helix slopes left to misalignment; 1 unless given."""


Limits = tuple[float, float]

_FIELD = named(lambda: din_3967.FIELDS, "tolerance field of the tooth thickness")


def read_field(value: Any) -> str:
    """A field of DIN 3967, also with its numbers first, as drawings have it."""
    text = value.strip() if isinstance(value, str) else value
    numbers = text[:2] if isinstance(text, str) and text[:2].isdigit() else ""
    return _FIELD(f"{text[2:].strip()}{numbers}" if numbers else text)


CentreField = Annotated[
    str, BeforeValidator(named(lambda: iso_286.FIELDS, "symmetrical tolerance field"))
]
"""Field of a centre distance by ISO 286."""


class Inspection(Table):
    """What the drawing of each gear says of its teeth; the gears that are computed stay the nominal ones.

    Allowances are those of the tooth thickness in the normal section, negative ones make teeth thinner, by
    value or by a field of DIN 3967 such as cd25. The centre distance deviates to either side, by value or
    by a field of ISO 286. A span is over the number of teeth that has it touch nearest to the middle of the
    active flank, and a ball touches there, unless they are given. Tolerances are those of a class of ISO
    1328-1, that of the deviations where it is left out.
    """

    upper_thickness_allowance: Annotated[tuple[float, float], Pair(ALLOWANCE)] | None = None
    """Upper allowance of the normal tooth thickness; needed with the lower one."""
    lower_thickness_allowance: Annotated[tuple[float, float], Pair(ALLOWANCE)] | None = None
    """Lower allowance of the normal tooth thickness; needed with the upper one."""
    thickness_field: Annotated[tuple[str, str], BeforeValidator(for_both(read_field))] | None = None
    """Fields of the tooth thickness by DIN 3967, one or a list of two, in place of allowances."""
    centre_distance_deviation: Annotated[float, DEVIATION] | None = None
    """Deviation of the centre distance to either side; none unless given."""
    centre_distance_field: CentreField | None = None
    """Tolerance field of the centre distance by ISO 286, in place of a deviation."""
    span_teeth: Annotated[tuple[float, float], Pair(SPAN)] | None = None
    """Teeth k under a span; those that touch nearest to mid-flank unless given."""
    ball_diameter: Annotated[tuple[float, float], Pair(BORE)] | None = None
    """Diameter D_M of the measuring balls; one that touches near mid-flank unless given."""
    iso_class: Annotated[tuple[float, float], Pair(TOLERANCE_CLASS)] | None = None
    """Class of the tolerances by ISO 1328-1; that of the deviations unless given."""

    def allowances(self, diameters: Limits) -> tuple[Limits, Limits] | None:
        """Upper and lower allowances of both gears [m]; None where none are given.

        Args:
            diameters: of the reference circles of both gears, which a field goes by [m].
        """
        if self.thickness_field is not None:
            pinion_limits, wheel_limits = (
                din_3967.thickness_allowances(field=field, diameter=diameter)
                for field, diameter in zip(self.thickness_field, diameters, strict=True)
            )
            return (pinion_limits[0], wheel_limits[0]), (pinion_limits[1], wheel_limits[1])
        upper, lower = self.upper_thickness_allowance, self.lower_thickness_allowance
        return None if upper is None or lower is None else (upper, lower)

    def deviation(self, distance: float) -> float | None:
        """Deviation of the centre distance to either side [m]; None where none is given.

        Args:
            distance: nominal centre distance [m].
        """
        if self.centre_distance_field is not None:
            return iso_286.symmetrical_deviation(self.centre_distance_field, distance)
        return self.centre_distance_deviation

    @model_validator(mode="after")
    def _limits(self) -> "Inspection":
        upper, lower = self.upper_thickness_allowance, self.lower_thickness_allowance
        if (upper is None) != (lower is None):
            present, missing = ("upper", "lower") if lower is None else ("lower", "upper")
            raise InputError(
                f"was given without {missing}_thickness_allowance; a tooth thickness has both",
                key=f"{present}_thickness_allowance",
            )
        if upper is not None and self.thickness_field is not None:
            raise InputError(
                "allowances of the tooth thickness and thickness_field were both given; give one",
                key="thickness_field",
            )
        for number, (high, low) in enumerate(zip(upper or (), lower or (), strict=True), 1):
            if low > high:
                raise InputError(
                    f"{ALLOWANCE.show(low)} of gear {number} is above its upper allowance, "
                    f"{ALLOWANCE.show(high)}",
                    key="lower_thickness_allowance",
                )
        if None not in (self.centre_distance_deviation, self.centre_distance_field):
            raise InputError(
                "centre_distance_deviation and centre_distance_field were both given; give one",
                key="centre_distance_field",
            )
        return self


def _allowed(gears: "CylindricalGears") -> dict[str, float]:
    """Largest allowance by key."""
    limits = gears.thickness_allowances or ()
    keys = ("upper_thickness_allowance", "lower_thickness_allowance")
    if gears.inspection is not None and gears.inspection.thickness_field is not None:
        keys = ("thickness_field", "thickness_field")
    return {
        f"inspection.{key}": max(map(abs, pair)) for key, pair in zip(keys, limits, strict=False)
    }


class CylindricalGears(GearsTable):
    """A pair of involute gears on parallel axes, spur or helical; gear 2 may be a ring.

    The root of a ring is what a pinion cutter leaves whose tip corners have the fillet radius of gear 2,
    ρ_a0, and whose tip reaches the root circle; without `cutter_teeth` its fillets are arcs. A misalignment
    counts over the face, positive where the flanks part at the end that a contact line reaches last.
    """

    members: ClassVar[tuple[str, ...]] = MEMBERS
    rated: ClassVar[bool] = True
    friction: ClassVar[str] = "iso_tr_14179_2"
    explored: ClassVar[tuple[str, float]] = ("profile_shift.1", 0.2)

    family: Literal["cylindrical"] = "cylindrical"
    """Family of these gears: a pair of cylindrical gears on parallel axes."""
    teeth: Annotated[tuple[float, float], Pair(TEETH), AfterValidator(_teeth)]
    """Numbers of teeth z1, z2; negative for a ring as gear 2."""
    module: Annotated[float, MODULE]
    """Normal module m_n; for spur gears a key diametral_pitch = 20 may stand in its place."""
    face_width: Annotated[float, COMMON_WIDTH]
    """Common face width b, also as a list of that of each gear, of which the smaller one counts."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Normal pressure angle α_n of the basic rack."""
    helix_angle: Annotated[float, HELIX] = 0.0
    """Helix angle β on the reference cylinder; 0 for spur gears."""
    profile_shift: Annotated[tuple[float, float], _Shifts(SHIFT)] = (0.0, 0.0)
    """Profile shift coefficients x1, x2; "from centre distance" for both, in halves, or for one."""
    addendum: Annotated[tuple[float, float], Pair(RACK)] = (1.0, 1.0)
    """Addendum of both basic racks, in modules."""
    dedendum: Annotated[tuple[float, float], Pair(RACK)] | None = None
    """Dedendum of both basic racks, in modules; addendum of the mate + 0.25 unless given."""
    fillet_radius: Annotated[tuple[float, float], Pair(FILLET)] | None = None
    """Fillet radius ρ_fP of both racks in modules; 0.38, of a ring 0.2, or what fits, unless given."""
    cutter_teeth: Annotated[float, CUTTER_TEETH] | None = None
    """Teeth z_0 of the pinion cutter of a ring; unless given the ring has arcs as fillets."""
    cutter_profile_shift: Annotated[float, SHIFT] = 0.0
    """Profile shift x_0 of that cutter, as it is ground."""
    tip_alteration: Annotated[tuple[float, float], Pair(TIP)] | None = None
    """Tip alteration coefficients k1, k2; those that keep the tip clearance unless given."""
    least_tip_thickness: Annotated[float, LEAST_TIP] | None = None
    """Tip thickness that shortening keeps, in modules; helical 0.25, spur 0, unless given."""
    centre_distance: Annotated[float, DISTANCE] | None = None
    """Centre distance a; that without backlash, of teeth that are not thinned, unless given."""
    backlash: Annotated[float, DEVIATION] | None = None
    """Backlash j_wt on the pitch circles, for which both teeth are thinned alike; that of a unless given."""
    thickness_allowance: Annotated[tuple[float, float], Pair(ALLOWANCE)] | None = None
    """Allowance A_sn of the normal tooth thickness as made; none, or that of backlash, unless given."""
    bore_diameter: Annotated[tuple[float, float], Pair(BORE)] | None = None
    """Bore diameters, of a ring its outer one; 0.3, of a ring 1.2, root diameters unless given."""
    flank: Literal["left", "right"] = "left"
    """Flanks that touch, as seen with the tooth's tip up."""
    misalignment: Annotated[float, MISALIGNMENT] | None = None
    """Misalignment f_Σβ over the face, positive where flanks part at the end z > 0; none unless given."""
    modifications: FlankModifications | None = None
    """Modifications of the flanks; none unless given."""
    deviations: GearDeviations | None = None
    """Deviations from tooth to tooth, which make the kinematic error; none unless given."""
    inspection: Inspection | None = None
    """Allowances, tolerances and measuring dimensions of the drawing; none unless given."""

    @property
    def opposed(self) -> "CylindricalGears":
        """The same gears pressing their other flanks."""
        return self.model_copy(update={"flank": "right" if self.flank == "left" else "left"})

    @property
    def designation(self) -> str:
        """Spur or helical, of gears or with a ring."""
        pinion_teeth, wheel_teeth = self.tooth_numbers
        kind = "Helical" if self.helix_angle else "Spur"
        return f"{kind} {'pair' if self.teeth[1] > 0 else 'gear in a ring'} {pinion_teeth:g}/{wheel_teeth:g}"

    @property
    def tooth_numbers(self) -> tuple[float, float]:
        """Of both members, in magnitude."""
        pinion_teeth, wheel_teeth = self.teeth
        return pinion_teeth, abs(wheel_teeth)

    @property
    def normal_module(self) -> float:
        """Normal module [m]."""
        return self.module

    @property
    def thickness_allowances(self) -> tuple[Limits, Limits] | None:
        """Upper and lower allowances of the normal tooth thickness of both gears [m]; None without any.

        Raises:
            InputError: a gear that is larger than its field covers.
        """
        if self.inspection is None:
            return None
        pinion_diameter, wheel_diameter = (
            abs(teeth) * self.module / cos(self.helix_angle) for teeth in self.teeth
        )
        try:
            return self.inspection.allowances((pinion_diameter, wheel_diameter))
        except InputError as error:
            raise error.at(key="inspection.thickness_field") from None

    @property
    def limits_by_key(self) -> dict[str, Limits]:
        """Lowest and highest value that the tolerances of `inspection` allow, by key of this table [SI].

        The misalignment is that of both helix slopes within their class, which are independent of each other.
        All other deviations of the class reach a share of their limits, of teeth that a seed draws.

        Raises:
            InputError: a gear or a centre distance that is larger than its field covers.
        """
        if self.inspection is None:
            return {}
        limits: dict[str, Limits] = {}
        if self.thickness_allowances is not None:
            upper, lower = self.thickness_allowances
            limits |= {f"thickness_allowance.{k + 1}": (lower[k], upper[k]) for k in (0, 1)}
        distance = self.operating_distance
        if (deviation := self.inspection.deviation(distance)) is not None:
            limits["centre_distance"] = distance - deviation, distance + deviation
        if self.inspection.iso_class is not None:
            slopes = (
                flank_tolerances(
                    tolerance_class=int(grade),
                    diameter=abs(teeth) * self.module / cos(self.helix_angle),
                    module=self.module,
                    face_width=self.face_width,
                ).helix_slope
                for grade, teeth in zip(self.inspection.iso_class, self.teeth, strict=True)
            )
            middle, slope = self.misalignment or 0.0, hypot(*slopes)
            limits["misalignment"] = middle - slope, middle + slope
            shares = dict.fromkeys(
                (f"deviations.share_of_tolerance.{k}" for k in (1, 2)), (SHARE.low, SHARE.high)
            )
            limits |= {**shares, "deviations.seed": (SEED.low, SEED.high)}
        return limits

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography for what is given."""
        modified = self.modifications is not None or self.misalignment is not None
        inspected = self.inspection is not None
        by_field = self.inspection is not None and self.inspection.centre_distance_field is not None
        thickness = self.inspection is not None and self.inspection.thickness_field is not None
        return (
            *("iso_21771_2007",) * (modified or inspected),
            *("iso_1328_1_2013",) * (self.tolerance_class is not None),
            *("iso_286_1_2010",) * by_field,
            *("din_3967_1978",) * thickness,
        )

    @property
    def tolerance_class(self) -> tuple[float, float] | None:
        """Class of the flank tolerances of both gears, by inspection or by deviations; None without one."""
        if self.inspection is not None and self.inspection.iso_class is not None:
            return self.inspection.iso_class
        return None if self.deviations is None else self.deviations.iso_class

    @property
    def load_sharing(self) -> str:
        """Flanks with modifications share the load as they yield."""
        modified = self.modifications is not None and self.modifications.amounts
        return "from_stiffness" if modified or self.misalignment is not None else "equal"

    @model_validator(mode="after")
    def _smaller_than_teeth(self) -> "CylindricalGears":
        amounts = self.modifications.amounts if self.modifications is not None else {}
        amount_by_key = {f"modifications.{key}": max(pair) for key, pair in amounts.items()}
        amount_by_key["misalignment"] = abs(self.misalignment or 0.0)
        amount_by_key["backlash"] = self.backlash or 0.0
        amount_by_key["thickness_allowance"] = max(map(abs, self.thickness_allowance or (0.0,)))
        amount_by_key |= _allowed(self)
        for key, most in amount_by_key.items():
            if most > self.module / 2.0:
                raise InputError(
                    f"{RELIEF.show(most)} is more than a tooth allows; allowed is half a module, "
                    f"{RELIEF.show(self.module / 2.0)}",
                    key=key,
                )
        if self.deviations is not None:
            self.deviations.check(self.tooth_numbers, self.module)
            if self.deviations.share_of_tolerance is not None and self.deviations.iso_class is None:
                raise InputError(
                    "was given without iso_class, of whose limits it is a part",
                    key="deviations.share_of_tolerance",
                )
        return self

    def shifts_from_distance(self, shifts: tuple[float, float]) -> tuple[float, float]:
        """Profile shifts that leave no backlash at the centre distance.

        Args:
            shifts: x1, x2; NaN where one is open. Two open ones are alike.

        Raises:
            InputError: without a centre distance, or where they are out of range.
        """
        if self.centre_distance is None:
            raise InputError(
                f'"{FROM_CENTRE_DISTANCE}" was given without a centre_distance', key="profile_shift"
            )
        total = profile_shift_sum(
            teeth=self.teeth,
            module=self.module,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            centre_distance=self.centre_distance,
        )
        left = [shift for shift in shifts if not isnan(shift)]
        remaining_shift = (total - sum(left)) / (2 - len(left))
        pinion_shift, wheel_shift = (remaining_shift if isnan(shift) else shift for shift in shifts)
        for number, shift in enumerate((pinion_shift, wheel_shift), 1):
            if not SHIFT.low <= shift <= SHIFT.high:
                raise InputError(
                    f"the centre distance {DISTANCE.show(self.centre_distance)} asks for profile shifts that "
                    f"sum to {total:.4g}, with {shift:.4g} of gear {number}; {SHIFT.allowed}",
                    key="profile_shift",
                )
        return pinion_shift, wheel_shift

    @model_validator(mode="after")
    def _shifts(self) -> "CylindricalGears":
        if any(map(isnan, self.profile_shift)):
            # The table is fixed once it is read, and it is not yet.
            self.__dict__["profile_shift"] = self.shifts_from_distance(self.profile_shift)
        return self

    @property
    def toothings(self) -> tuple[Toothing, Toothing]:
        """Both gears as they are measured, without allowances."""
        common = self.module, self.pressure_angle, self.helix_angle
        (pinion_teeth, wheel_teeth), (pinion_shift, wheel_shift) = self.teeth, self.profile_shift
        return Toothing(pinion_teeth, *common, pinion_shift), Toothing(
            wheel_teeth, *common, wheel_shift
        )

    @property
    def operating_distance(self) -> float:
        """Centre distance a [m]; NaN where none is given and none fits."""
        return self.centre_distance or distance_without_backlash(*self.toothings)

    @property
    def infeed(self) -> tuple[float, float]:
        """Profile shifts x_E - x by which gears are cut deeper for backlash or allowance; zero without them.

        Raises:
            InputError: a backlash that is smaller than that of teeth as they are.
        """
        if self.thickness_allowance is not None:
            thinner = zip(self.toothings, self.thickness_allowance, strict=True)
            pinion_infeed, wheel_infeed = (gear.infeed(allowance) for gear, allowance in thinner)
            return pinion_infeed, wheel_infeed
        if self.backlash is None:
            return 0.0, 0.0
        (pinion, wheel), distance = self.toothings, self.operating_distance
        if not distance > abs(pinion.base_radius + wheel.base_radius):
            return 0.0, 0.0  # gears that do not mesh are refused as those without a backlash
        allowance = allowance_for(pinion, wheel, distance, self.backlash)
        if allowance > _ROUNDED * self.module:
            least = ceil(1e7 * backlash(pinion, wheel, distance).circumferential) * 1e-7
            advice = f"{DEVIATION.show(least)} or more, or " if least <= self.module / 2.0 else ""
            raise InputError(
                f"was given {DEVIATION.show(self.backlash)}, and at the centre distance "
                f"{DISTANCE.show(distance)} teeth that are not thinned have more; give {advice}a centre "
                f"distance nearer to {DISTANCE.show(distance_without_backlash(pinion, wheel))}",
                key="backlash",
            )
        return pinion.infeed(allowance), wheel.infeed(allowance)

    @model_validator(mode="after")
    def _one_thickness(self) -> "CylindricalGears":
        if self.backlash is not None and self.thickness_allowance is not None:
            raise InputError(
                "was given beside backlash; each of them says how thin the teeth are, give one",
                key="thickness_allowance",
            )
        if self.backlash is not None and self.thickness_allowances is not None:
            raise InputError(
                "was given beside allowances of the tooth thickness in gears.inspection; each of them says "
                "how thin the teeth are, give one",
                key="backlash",
            )
        if self.backlash is not None:
            _ = self.infeed
        return self

    @model_validator(mode="after")
    def _of_cutter(self) -> "CylindricalGears":
        if self.cutter_teeth is None:
            if "cutter_profile_shift" in self.model_fields_set:
                raise InputError(
                    "was given without cutter_teeth; give both, or leave it out",
                    key="cutter_profile_shift",
                )
        elif self.teeth[1] > 0:
            raise InputError(
                "was given for two external gears, whose roots are those of their basic racks; only a ring, "
                "gear 2 with a negative number of teeth, has a pinion cutter; leave it out",
                key="cutter_teeth",
            )
        elif self.cutter_teeth >= -self.teeth[1]:
            raise InputError(
                f"the cutter was given {self.cutter_teeth:g} teeth; it cuts inside the ring and has fewer "
                f"than its {-self.teeth[1]:g}",
                key="cutter_teeth",
            )
        return self

    @model_validator(mode="after")
    def _one_tip(self) -> "CylindricalGears":
        if self.tip_alteration is not None and self.least_tip_thickness:
            raise InputError(
                "tip_alteration and least_tip_thickness were both given; a tip alteration by value is "
                "kept as it is",
                key="least_tip_thickness",
            )
        return self
