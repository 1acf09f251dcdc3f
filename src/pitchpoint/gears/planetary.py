"""The table [gears] of a planetary gear set: the meshes for which its numbers stand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, isfinite, pi
from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import BeforeValidator, ConfigDict, Field, GetJsonSchemaHandler, model_validator
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema

from pitchpoint.errors import RUNS_WITH, Cure, InputError
from pitchpoint.gears.cylindrical.drawing_dimensions import (
    Toothing,
    distance_without_backlash,
    profile_shift_sum,
)
from pitchpoint.gears.cylindrical.table import (
    ALLOWANCE,
    CUTTER_TEETH,
    FROM_CENTRE_DISTANCE,
    LEAST_TIP,
    TIP,
    TOLERANCE_CLASS,
    CentreField,
    Inspection,
    read_field,
)
from pitchpoint.gears.gears_table import (
    ANGLE,
    DEVIATION,
    DISTANCE,
    FILLET,
    HELIX,
    MODULE,
    RACK,
    SHIFT,
    STIFFNESS,
    WIDTH,
    Load,
)
from pitchpoint.input.quantities import Pair, Quantity, SIValue, count_of, shown
from pitchpoint.input.tables import Table

__all__ = [
    "BODIES",
    "PLANETARY",
    "PLANETS",
    "OfThree",
    "PinErrors",
    "PlanetAngles",
    "PlanetaryGears",
    "in_words_of_set",
]

PLANETARY = "planetary"
"""The family by name."""

BODIES = ("sun", "carrier", "ring")
"""Bodies that may be turned, loaded or held."""

SECOND = "second ring"
"""Body of a set whose planets have two gears, beside the others."""

Body = Literal["sun", "carrier", "ring", "second ring"]

MOST_PLANETS = 24

TEETH = Quantity("dimensionless", 5, 2_000, whole=True)
PLANETS = Quantity("dimensionless", 1, MOST_PLANETS, whole=True)

_OF_SHARING = (
    "pin_tolerance",
    "thickness_tolerance",
    "planet_runout",
    "central_runout",
    "pin_stiffness",
)
"""Keys of how planets share a load that the table [train] has too."""


@dataclass(frozen=True)
class OfPins(Quantity):
    """A length of which most of a list are zero, which needs no unit."""

    def read(self, value: Any) -> float:
        """SI value; see `Quantity.read`."""
        return super().read(f"0 {self.unit}" if str(value).strip() in ("0", "0.0") else value)


PIN_ERROR = OfPins("length", -1e-2, 1e-2, "um")
PinErrors = Annotated[tuple[Annotated[float, PIN_ERROR], ...], Field(max_length=MOST_PLANETS)]

PLANET_ANGLE = Quantity("angle", -2.0 * pi, 2.0 * pi, "deg")
PlanetAngles = Annotated[tuple[Annotated[float, PLANET_ANGLE], ...], Field(max_length=MOST_PLANETS)]

_LISTS = ("teeth", "profile_shift", "addendum", "dedendum", "fillet_radius", "tip_alteration")
"""Keys that hold a value for each of sun, planet and ring."""

_WITHOUT_RING = ("teeth", "face_width", "profile_shift", "tip_alteration")
"""Keys that hold values of sun and planet alone where the ring meshes with second gears of the planets."""

_OF_ALL = ("module", "pressure_angle", "helix_angle", "least_tip_thickness")
"""Keys whose value all gears have."""

Three = tuple[float, float, float]
TwoOrThree = tuple[float, ...]
Tree = dict[str, Any]


@dataclass(frozen=True)
class OfThree(Pair):
    """A value for each of sun, planet and ring, or one for all; that of the ring may follow from the rest.

    Attributes:
        follows: True if the ring may have the text of what follows, or be left out.
        stepped: True if sun and planet alone have one where the ring meshes with second gears.
    """

    follows: bool = False
    stepped: bool = False

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """What editors know of the values."""
        single = self.each.json_schema
        item = {"anyOf": [single, {"const": FROM_CENTRE_DISTANCE}]} if self.follows else single
        least = 2 if self.follows or self.stepped else 3
        every = {"type": "array", "items": item, "minItems": least, "maxItems": 3}
        return {"anyOf": [single, every], "description": self.told}

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        open_ring = (
            f'; "{FROM_CENTRE_DISTANCE}" for the ring, or those of sun and planet alone'
            if self.follows
            else ""
        )
        return f"{self.each.told}; a list of sun, planet and ring, or one value for all{open_ring}"

    def read(self, value: Any) -> Any:
        """SI values of sun, planet and ring; the text where that of the ring is to follow."""
        every = list(value) if isinstance(value, list | tuple) else [value] * 3
        if self.each is TEETH and any(isinstance(part, int | float) and part < 0 for part in every):
            raise InputError(
                f"{shown(value)} has numbers below zero; teeth of a set are positive, those of the ring too",
                value=value,
            )
        if len(every) == 2 and self.follows:
            every.append(FROM_CENTRE_DISTANCE)
        if len(every) == 2 and self.stepped:
            return tuple(map(self.each.read, every))
        if len(every) != 3:
            raise InputError(
                f"{shown(value)} has {count_of(every)}; give those of sun, planet and ring, or one for "
                f"all; {self.each.allowed}"
            )
        follows = self.follows and every[2] == FROM_CENTRE_DISTANCE
        ring = FROM_CENTRE_DISTANCE if follows else self.each.read(every[2])
        return self.each.read(every[0]), self.each.read(every[1]), ring


_USUAL_SHIFTS: Any = 0.0, 0.0, FROM_CENTRE_DISTANCE
"""None of sun and planet; that of the ring follows."""


@dataclass(frozen=True)
class OfPlanetAndRing(Pair):
    """A value for the second gear of the planets and one for its ring, or one for both."""

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """What editors know of the values: shifts may be the text of what follows."""
        single = self.each.json_schema
        item = (
            {"anyOf": [single, {"const": FROM_CENTRE_DISTANCE}]} if self.each is SHIFT else single
        )
        both = {"type": "array", "items": item, "minItems": 2, "maxItems": 2}
        return {"anyOf": [single, both], "description": self.told}

    def read(self, value: Any) -> Any:
        """SI values of both; the text where that of the ring is to follow."""
        every = list(value) if isinstance(value, list | tuple) else [value] * 2
        if len(every) != 2:
            raise InputError(
                f"{shown(value)} has {count_of(every)}; give those of the second gear of the planets and "
                f"of its ring, or one for both; {self.each.allowed}"
            )
        if self.each is TEETH and any(isinstance(part, int | float) and part < 0 for part in every):
            raise InputError(
                f"{shown(value)} has numbers below zero; teeth of a set are positive, those of the ring too",
                value=value,
            )
        return tuple(
            part if self.each is SHIFT and part == FROM_CENTRE_DISTANCE else self.each.read(part)
            for part in every
        )


def _fields_of_each(value: Any) -> tuple[str, ...]:
    """Fields of sun, planet and ring, of sun and planet, or one for all."""
    every = list(value) if isinstance(value, list | tuple) else [value] * 3
    if len(every) not in (2, 3):
        raise InputError(
            f"{shown(value)} has {count_of(every)}; give those of sun, planet and ring, or one for all"
        )
    return tuple(map(read_field, every))


def _spelt(value: Any) -> Any:
    """A value of a table as a file has it."""
    if isinstance(value, tuple):
        return [*map(_spelt, value)]
    return value if isinstance(value, str) else SIValue(value)


class InspectionOfSet(Table):
    """What the drawing of each gear of a set says of its teeth, as the table of the same name of a pair does.

    Lists are of sun, planet and ring, or of sun and planet of a stepped set; second gears have a table
    of their own. The gears that are computed stay the nominal ones.
    """

    upper_thickness_allowance: Annotated[TwoOrThree, OfThree(ALLOWANCE, stepped=True)] | None = None
    """Upper allowances of the normal tooth thickness; needed with the lower ones."""
    lower_thickness_allowance: Annotated[TwoOrThree, OfThree(ALLOWANCE, stepped=True)] | None = None
    """Lower allowances of the normal tooth thickness; needed with the upper ones."""
    thickness_field: Annotated[tuple[str, ...], BeforeValidator(_fields_of_each)] | None = None
    """Fields of the tooth thickness by DIN 3967, in place of allowances."""
    centre_distance_deviation: Annotated[float, DEVIATION] | None = None
    """Deviation of the centre distance to either side; none unless given."""
    centre_distance_field: CentreField | None = None
    """Tolerance field of the centre distance by ISO 286, in place of a deviation."""
    iso_class: Annotated[TwoOrThree, OfThree(TOLERANCE_CLASS, stepped=True)] | None = None
    """Class of the tolerances by ISO 1328-1; none unless given."""

    def of_pair(self, first: int) -> Tree:
        """Table of two neighbours among sun, planet and ring, of which this is the first."""
        entries = {key: value for key, value in self if value is not None}
        return {
            key: _spelt(value[first : first + 2] if isinstance(value, tuple) else value)
            for key, value in entries.items()
        }

    @property
    def of_distance(self) -> Tree:
        """What it says of the centre distance, which all meshes have."""
        return {key: value for key, value in self.of_pair(0).items() if key.startswith("centre")}


class SecondGears(Table):
    """A second gear on every planet, and the ring that it meshes with: of a stepped set, or a 3K (Wolfrom).

    Pressure angle, helix and racks are those of planet and ring; the centre distance is that of the set.
    """

    teeth: Annotated[tuple[float, float], OfPlanetAndRing(TEETH), Field(examples=[[34, 88]])]
    """Numbers of teeth of the second gear of the planets and of its ring, both positive."""
    module: Annotated[float, MODULE] | None = None
    """Normal module of both; that of the set unless given."""
    face_width: Annotated[tuple[float, float], OfPlanetAndRing(WIDTH)]
    """Face widths of both, of which the smaller one counts."""
    profile_shift: Annotated[tuple[float, float], OfPlanetAndRing(SHIFT)] = (
        0.0,
        FROM_CENTRE_DISTANCE,  # type: ignore[assignment]
    )
    """Profile shift coefficients of both; that of the ring as follows unless given."""
    tip_alteration: Annotated[tuple[float, float], OfPlanetAndRing(TIP)] | None = None
    """Tip alteration coefficients; those that keep the tip clearance unless given."""
    inspection: Inspection | None = None
    """Allowances, tolerances and measuring dimensions of both; none unless given."""


def _is_two(value: Any) -> bool:
    return isinstance(value, list | tuple) and len(value) == 2


_DOES = {
    "input": "is turned",
    "output": "takes the load",
    "held": "is held; with two of them held nothing moves",
    "floating": "floats; the others bear the load",
}
"""What bodies do of which there is one, by key."""


_EVERY = ("all", "both", "everything", "every")
"""Words for several bodies."""


class PlanetaryGears(Table):
    """A planetary gear set: a sun, planets on a carrier, and a ring around them, of one module.

    One of sun, carrier and ring is turned, one takes the load, one is held. All planets are alike and stand
    at equal angles unless `planet_angles` has others. Meshes of sun and planet, and of planet and ring, have
    the same centre distance. With `second` gears on the planets, and `teeth` of sun and planet alone, it is a
    stepped set: its ring meshes with the second gears. With `teeth` of a ring as well, second gears and their
    ring make a 3K set: sun and both rings are turned, loaded and held, and the carrier bears the planets
    alone.
    """

    # A table without its family is of a pair: schemas say so too.
    model_config = ConfigDict(
        json_schema_extra=lambda schema: schema["required"].insert(0, "family")
    )

    explored: ClassVar[tuple[str, float]] = ("profile_shift.2", 0.2)
    members: ClassVar[tuple[str, ...]] = BODIES
    load: ClassVar[Load] = "torque"
    carries: ClassVar[str] = "gears carry a torque"
    transmits: ClassVar[bool] = True
    rated: ClassVar[bool] = True

    family: Literal["planetary"] = "planetary"
    """Family of these gears: a planetary set."""
    teeth: Annotated[TwoOrThree, OfThree(TEETH, stepped=True), Field(examples=[[24, 30, 84]])]
    """Numbers of teeth of sun, planet and ring, all positive; of sun and planet alone for a stepped set."""
    planets: Annotated[float, PLANETS] = 3.0
    """Number of planets."""
    planet_angles: PlanetAngles = ()
    """Angle at which each planet stands on the carrier; equal ones all around unless given."""
    module: Annotated[float, MODULE]
    """Normal module m_n of all gears."""
    face_width: Annotated[TwoOrThree, OfThree(WIDTH, stepped=True)]
    """Face widths of sun, planet and ring; of two in mesh the smaller one counts."""
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    """Normal pressure angle α_n of the basic racks."""
    helix_angle: Annotated[float, HELIX] = 0.0
    """Helix angle β on the reference cylinders; 0 for spur gears."""
    profile_shift: Annotated[TwoOrThree, OfThree(SHIFT, follows=True)] = _USUAL_SHIFTS
    """Profile shift coefficients of sun, planet and ring; that of the ring as follows unless given."""
    addendum: Annotated[Three, OfThree(RACK)] = (1.0, 1.0, 1.0)
    """Addendum of the basic racks, in modules."""
    dedendum: Annotated[Three, OfThree(RACK)] | None = None
    """Dedendum of the basic racks, in modules; addendum of the mate + 0.25 unless given."""
    fillet_radius: Annotated[Three, OfThree(FILLET)] = (0.38, 0.2, 0.2)
    """Fillet radius ρ_fP of the racks in modules; 0.38 of the sun, 0.2 where a ring meshes, unless given."""
    cutter_teeth: Annotated[float, CUTTER_TEETH] | None = None
    """Teeth z_0 of the pinion cutter of the (first) ring; unless given it has arcs as fillets."""
    cutter_profile_shift: Annotated[float, SHIFT] | None = None
    """Profile shift x_0 of that cutter, as it is ground; 0 unless given."""
    tip_alteration: Annotated[TwoOrThree, OfThree(TIP, stepped=True)] | None = None
    """Tip alteration coefficients; those that keep the tip clearance of each mesh unless given."""
    least_tip_thickness: Annotated[float, LEAST_TIP] | None = None
    """Tip thickness that shortening keeps, in modules; helical 0.25, spur 0, unless given."""
    centre_distance: Annotated[float, DISTANCE] | None = None
    """Centre distance of both meshes; that of sun and planet without backlash unless given."""
    inspection: InspectionOfSet | None = None
    """Allowances and tolerances of the drawings of the gears; none unless given."""
    second: SecondGears | None = None
    """Second gears of the planets and their ring, for a stepped set or a 3K; none unless given."""
    input: Body = "sun"
    """Body that drives."""
    output: Body = "carrier"
    """Body that takes the load; the second ring where there is one, unless given."""
    held: Body = "ring"
    """Body that stands still."""
    floating: Body | None = None
    """Body that is free to move sideways, so that planets share alike; none unless given."""
    pin_errors: PinErrors = ()
    """How far each pin is ahead along its circle, to where its planet pushes it, so that it bears less."""
    pin_tolerance: Annotated[float, DEVIATION] | None = None
    """Diameter of the circle in which each pin lies by tolerance."""
    thickness_tolerance: Annotated[float, DEVIATION] | None = None
    """Width of the field in which the normal tooth thickness of the planets lies."""
    planet_runout: Annotated[float, DEVIATION] | None = None
    """Runout F_r of the teeth of each planet about its bearing, twice the eccentricity."""
    central_runout: Annotated[float, DEVIATION] | None = None
    """Runout F_r of sun and ring, each about the axis of the carrier."""
    pin_stiffness: Annotated[float, STIFFNESS] | None = None
    """Stiffness of a pin and its bearing along the circle, for sharing and torsion; rigid unless given."""

    @model_validator(mode="before")
    @classmethod
    def _one_body_each(cls, table: Any) -> Any:
        """The table; InputError for several bodies where one is turned, loaded, held or floats."""
        for key, does in _DOES.items() if isinstance(table, Mapping) else ():
            value = table.get(key)
            several = isinstance(value, list | tuple)
            if several or value in _EVERY:
                complaint = f"has {count_of(value)}" if several else "is more than one body"
                raise InputError(
                    f"{shown(value)} {complaint}, and one body alone {does}; write one of "
                    f"{', '.join(get_args(Body))}",
                    key=key,
                )
        return table

    @model_validator(mode="before")
    @classmethod
    def _values_of_ring(cls, table: Any) -> Any:
        """The table; InputError for values of a ring beside sun and planet of a stepped set."""
        if (
            not isinstance(table, Mapping)
            or "second" not in table
            or not _is_two(table.get("teeth"))
        ):
            return table
        of_drawing = table.get("inspection")
        inside = of_drawing if isinstance(of_drawing, Mapping) else {}
        values_of_set = {key: table.get(key) for key in _WITHOUT_RING[1:]}
        for key, value in (
            values_of_set | {f"inspection.{key}": entry for key, entry in inside.items()}
        ).items():
            if isinstance(value, list | tuple) and len(value) == 3:
                raise InputError(
                    f"{shown(value)} has 3 values, and {shown(table['teeth'])} are teeth of sun and planet; "
                    "give those of these two here and that of the ring in the table second",
                    key=key,
                )
        return table

    @property
    def stepped(self) -> bool:
        """True if the ring meshes with second gears of the planets, and there is no other ring."""
        return len(self.teeth) == 2 and self.second is not None

    @property
    def three_k(self) -> bool:
        """True if second gears of the planets mesh with a second ring."""
        return self.second is not None and not self.stepped

    @model_validator(mode="after")
    def _whole(self) -> "PlanetaryGears":
        given_keys = {*self.model_fields_set}
        self._check_lengths()
        if self.three_k and "output" not in given_keys:
            return self.model_copy(update={"output": SECOND})._checked(given_keys)
        return self._checked(given_keys)

    def _check_lengths(self) -> None:
        """InputError for values of sun and planet alone, where a ring meshes with the same planets."""
        if self.stepped:
            return
        for key in _WITHOUT_RING:
            values = getattr(self, key)
            if values is not None and len(values) == 2:
                of_two = "second = { teeth = [planet, ring], face_width = ... } for stepped planets"
                alternative = of_two if key == "teeth" else "one for all"
                raise InputError(
                    f"the list has 2 values; give those of sun, planet and ring, or {alternative}",
                    key=key,
                )
        for key, values in self.inspection or ():
            if isinstance(values, tuple) and len(values) == 2:
                raise InputError(
                    "the list has 2 values; give those of sun, planet and ring, or one for all",
                    key=f"inspection.{key}",
                )

    def _checked(self, given: set[str]) -> "PlanetaryGears":
        """The set; InputError unless its bodies have three different parts, and rings are around planets."""
        roles = {"input": self.input, "output": self.output, "held": self.held}
        ends = ("sun", "ring", SECOND) if self.three_k else BODIES
        missing = [body for body in ends if body not in roles.values()]
        if missing:
            wrong = [name for name in roles if name in given]
            roles_text = ", ".join(f"{name} = {body}" for name, body in roles.items())
            of_two = "; of a 3K set the carrier bears planets alone" if self.three_k else ""
            raise InputError(
                f"{roles_text}: input, output and held are three different ones of {', '.join(ends)}; "
                f"none of them is the {missing[0]} here{of_two}",
                key=wrong[-1],
            )
        sun, planet = self.teeth[:2]
        if not self.stepped and (ring := self.teeth[2]) <= max(sun, planet):
            around = f"planet of {planet:.0f}; with a sun of {sun:.0f} teeth"
            if ring > planet:
                around = f"sun of {sun:.0f}; with planets of {planet:.0f} teeth"
            raise InputError(
                f"a ring of {ring:.0f} teeth is not around a {around} it has some {sun + 2.0 * planet:.0f}",
                key="teeth",
            )
        if self.second is not None and self.second.teeth[1] <= self.second.teeth[0]:
            planet, ring = self.second.teeth
            raise InputError(
                f"a ring of {ring:.0f} teeth is not around a gear of {planet:.0f} teeth",
                key="second.teeth",
            )
        return self

    @model_validator(mode="after")
    def _shift_of_ring(self) -> "PlanetaryGears":
        """The shift of the ring that leaves no backlash at the centre distance of sun and planet."""
        shifts: Any = self.profile_shift  # that of the ring may be the text still
        sun, planet = shifts[:2]
        if not isfinite(self.distance):
            raise InputError(
                f"sun and planet with {sun:g} and {planet:g} always have backlash; give larger ones, or a "
                "centre distance",
                key="profile_shift",
            )
        changes: Tree = {}
        if self.stepped:
            changes["profile_shift"] = sun, planet
        elif shifts[2] == FROM_CENTRE_DISTANCE:
            changes["profile_shift"] = sun, planet, self._shift_of_first_ring(planet)
        if self.second is not None:
            changes["second"] = self._second_with_shift(self.second)
        return self.model_copy(update=changes) if changes else self

    def _shift_of_first_ring(self, planet: float) -> float:
        """Shift of the ring around the planets with this one; InputError for one that no ring has."""
        z_sun, z_planet, z_ring = self.teeth
        try:
            ring = self._follows(self.teeth[1:], self.module, planet)
            wrong = f"asks for a profile shift of {ring:.3g}"
        except InputError:  # no shift makes such a ring
            ring, wrong = SHIFT.high + 1.0, "does not go around the planets with any profile shift"
        if SHIFT.low <= ring <= SHIFT.high:
            return ring
        nominal = z_planet + 2.0 * self.distance * cos(self.helix_angle) / self.module
        raise InputError(
            f"a ring of {z_ring:.0f} teeth at the centre distance {1e3 * self.distance:.6g} mm of sun "
            f"and planet {wrong}; with {z_sun:.0f} and {z_planet:.0f} teeth it has some {nominal:.0f}",
            key="teeth",
        )

    def _second_with_shift(self, second: SecondGears) -> SecondGears:
        """The second gears with their module, and the shift of the ring that leaves no backlash."""
        module = second.module or self.module
        shifts: Any = second.profile_shift
        planet, ring = second.teeth
        if shifts[1] == FROM_CENTRE_DISTANCE:
            try:
                shifts = shifts[0], self._follows(second.teeth, module, shifts[0])
            except InputError:  # no shift makes such a ring
                shifts = shifts[0], SHIFT.high + 1.0
        if not SHIFT.low <= shifts[1] <= SHIFT.high:
            some = planet + 2.0 * self.distance / module * cos(self.helix_angle)
            raise InputError(
                f"no profile shift from {SHIFT.low:g} to {SHIFT.high:g} makes a ring of {ring:.0f} teeth fit "
                f"around gears of {planet:.0f} with the module {1e3 * module:.6g} mm at the centre distance "
                f"{1e3 * self.distance:.6g} mm of sun and planet; it has some {some:.0f}",
                key="second.teeth",
            )
        return second.model_copy(update={"profile_shift": shifts, "module": module})

    def _follows(self, teeth: Sequence[float], module: float, shift: float) -> float:
        """Shift of a ring without backlash around a gear of the planets that has this one."""
        both = profile_shift_sum(
            teeth=(teeth[0], -teeth[1]),
            module=module,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            centre_distance=self.distance,
        )
        return float(round(both - shift, 12) + 0.0)

    @property
    def distance(self) -> float:
        """Centre distance of both meshes [m]; NaN where there is none without backlash."""
        if self.centre_distance is not None:
            return self.centre_distance
        gears = [
            Toothing(teeth, self.module, self.pressure_angle, self.helix_angle, shift)
            for teeth, shift in zip(self.teeth[:2], self.profile_shift[:2], strict=True)
        ]
        return distance_without_backlash(*gears)

    def train(self) -> Tree:
        """Table [train]."""
        of_each = {
            name: [*map(SIValue, getattr(self, name))] for name in ("planet_angles", "pin_errors")
        }
        values = {name: getattr(self, name) for name in _OF_SHARING}
        return {
            "input": self.input,
            "output": self.output,
            "held": self.held,
            "planets": self.planets,
            **({"floating": self.floating} if self.floating else {}),
            **{name: listed for name, listed in of_each.items() if listed},
            **{name: SIValue(value) for name, value in values.items() if value is not None},
        }

    def meshes(self) -> list[Tree]:
        """Tables [[stages]] of sun and planet, of planet and ring, and of a second ring."""
        sun, planet, *rings = self.teeth
        tables: list[Tree] = [{"bodies": ["sun", "planet"], "gears": self._pair(0, [sun, planet])}]
        tables += [
            {"bodies": ["planet", "ring"], "gears": self._pair(1, [planet, -ring])}
            for ring in rings
        ]
        if self.second is not None:
            ring = "ring" if self.stepped else SECOND
            gears = self._second_pair(self.second)
            tables.append({"bodies": ["planet", ring], "planet_gear": 2, "gears": gears})
        return tables

    def _second_pair(self, second: SecondGears) -> Tree:
        """Table [gears] of the second gears and their ring, racks as those of planet and ring."""
        planet, ring = second.teeth
        of_set = self._pair(1, [planet, -ring])
        of_first = () if self.stepped else ("cutter_teeth", "cutter_profile_shift")
        own_keys = ("tip_alteration", "inspection", *of_first)
        pair = {key: value for key, value in of_set.items() if key not in own_keys}
        inspection = self.inspection.of_distance if self.inspection else {}
        if second.inspection is not None:
            second_inspection = second.inspection
            inspection |= {
                key: _spelt(getattr(second_inspection, key))
                for key in second_inspection.model_fields_set
            }
        second_values = {
            "profile_shift": second.profile_shift,
            "tip_alteration": second.tip_alteration,
        }
        return {
            **pair,
            "module": SIValue(second.module or self.module),
            "face_width": SIValue(min(second.face_width)),
            **({"inspection": inspection} if inspection else {}),
            **{
                key: [*map(SIValue, values)]
                for key, values in second_values.items()
                if values is not None
            },
        }

    def _pair(self, first: int, teeth: Sequence[float]) -> Tree:
        """Table [gears] of two neighbours among sun, planet and ring."""

        def both(values: TwoOrThree) -> list[float]:
            return [*values[first : first + 2]]

        pairs = {name: getattr(self, name) for name in _LISTS[1:]}
        table: Tree = {
            "teeth": [*map(SIValue, teeth)],
            "face_width": SIValue(min(both(self.face_width))),
            **{
                name: [*map(SIValue, both(values))]
                for name, values in pairs.items()
                if values is not None
            },
        }
        of_ring = ("cutter_teeth", "cutter_profile_shift") if first else ()
        for name in (*_OF_ALL, *of_ring):
            if (value := getattr(self, name)) is not None:
                table[name] = SIValue(value)
        if self.inspection is not None:
            table["inspection"] = self.inspection.of_pair(first)
        if self.centre_distance is not None or first:
            table["centre_distance"] = SIValue(self.distance)
        return table


def in_words_of_set(error: InputError, gears: PlanetaryGears) -> InputError:
    """An error of a mesh, or of the train, with the key that it has in the table of the set; its cures too.

    Args:
        error: with a key of [[stages]] or [train].
        gears: for which these stand.
    """
    table, _, inside = (error.key or "").partition(".")
    if table == "train":
        return error.at(key=".".join(filter(None, ("gears", inside))))
    number, _, key = inside.partition(".")
    if key.startswith(("film", "wear")) and "gear" not in error.message:
        return error.at(key=key)  # a table that all meshes have alike
    if table != "stages" or number not in ("1", "2", "3"):
        return error
    mesh_index = int(number) - 1
    second = mesh_index == (1 if gears.stepped else 2)
    if second:
        words = "the second gear of the planets (gear 1) and its ring (gear 2)"
        is_second_key = key.removeprefix("gears.").partition(".")[0] in SecondGears.model_fields
        key = f"gears.second.{key.removeprefix('gears.')}" if is_second_key else key
    else:
        words = "{} (gear 1) and {} (gear 2)".format(
            *("sun", "planet", "ring")[mesh_index : mesh_index + 2]
        )
    sentence = f"in the mesh of {words}: {error.message.partition(RUNS_WITH)[0]}"
    located = InputError(sentence, file=error.file, key=key or None, value=error.value)
    cures = (_cure_of_set(cure, gears, mesh_index, second) for cure in error.cures)
    located.cures = tuple(cure for cure in cures if cure)
    return located


def _cure_of_set(cure: Cure, gears: PlanetaryGears, first: int, second: bool) -> Cure | None:
    """A change of the gears of a mesh as one of the set; None where the set has no such key.

    Args:
        cure: with keys of [[stages]].
        gears: of the set.
        first: which mesh of the set it is.
        second: True for the mesh of second gears and their ring.
    """
    changes: Cure = {}
    for dotted, value in cure.items():
        key = dotted.rpartition("gears.")[2]
        if second and key in SecondGears.model_fields:
            changes[f"gears.second.{key}"] = value
        elif key not in _LISTS or (gears.stepped and key in _WITHOUT_RING):
            changes[f"gears.{key}"] = value
        elif isinstance(value, list):
            set_values = getattr(gears, key) or (value[1], *value, value[0])
            third_value = (
                set_values[0]
                if first
                else FROM_CENTRE_DISTANCE
                if key == "profile_shift"
                else set_values[-1]
            )
            changes[f"gears.{key}"] = [third_value, *value] if first else [*value, third_value]
        elif first and key == "profile_shift":
            changes[f"gears.{key}"] = [*gears.profile_shift[:2], value]
        else:
            return None
    return changes
