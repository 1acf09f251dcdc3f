"""The schema of a case file: one table a class, every value with kind and allowed range."""

import json
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import count, pairwise
from math import inf, pi
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    Tag,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic.fields import FieldInfo

from pitchpoint import units
from pitchpoint.cases.document import STAGES, Document, check_name
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.loss_sets import expanded, named_set
from pitchpoint.contact.registry import (
    ELLIPTIC_CONTACT,
    END_PROFILES,
    SUMMITS,
    USUAL_SUMMITS,
    SummitConstants,
)
from pitchpoint.duty_cycle.table import LIFE_EXPONENT, DutyTable
from pitchpoint.dynamics.registry import CONTACT_LAWS
from pitchpoint.efficiency.registry import BEARING_LOSS, BREAKAWAY, TOOTH_TEMPERATURE
from pitchpoint.errors import CollectedInputError, Complaints, InputError, shorten
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.families import Gears, GearsOfStage
from pitchpoint.gears.planetary import (
    BODIES,
    PLANETARY,
    PLANETS,
    PinErrors,
    PlanetAngles,
    PlanetaryGears,
)
from pitchpoint.gears.table import BORE, DEVIATION, MASS, PHASE, STIFFNESS, Deviation, GearsTable
from pitchpoint.input.quantities import Pair, Quantity, for_both, named, shown, text
from pitchpoint.input.tables import DECIDING, Table, alternatives, by, forms
from pitchpoint.loading.registry import LINE_STIFFNESS, LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.lubrication.ehl.registry import (
    ASPERITIES,
    MOST_LINE_NODES,
    MOST_PATCH_NODES,
    SMOOTH,
    THERMAL,
)
from pitchpoint.lubrication.registry import (
    ASPERITY_LOAD,
    FILM_THICKNESS,
    INLET_HEATING,
    ROLLING_RESISTANCE,
)
from pitchpoint.materials.data import base_names, oil_names, solid_names
from pitchpoint.materials.registry import DENSITY as LAWS_OF_DENSITY
from pitchpoint.materials.registry import SHEAR_STRESS, USUAL_SHEAR_STRESS, USUAL_VISCOSITY
from pitchpoint.materials.registry import VISCOSITY as LAWS_OF_VISCOSITY
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.liu_xiong_torus.table import TorusFormulas
from pitchpoint.published.registry import PUBLICATIONS, publication_of
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.zhao2022.table import ConjugateWear, FlankWear
from pitchpoint.registry import alike, letters, listed, nearest
from pitchpoint.results.chosen_units import unit_choice
from pitchpoint.results.reductions import REDUCTIONS
from pitchpoint.results.variables import VARIABLES, places_of
from pitchpoint.strength.treatments import TREATMENTS
from pitchpoint.wear.registry import WEAR_LAWS

__all__ = [
    "UNRATED",
    "CaseFile",
    "DriveCase",
    "StageTable",
    "bearings_of",
    "in_form",
    "keys",
    "marks",
    "measure_of",
    "quantity_at",
    "quantity_of",
    "usual_at",
    "usual_words",
    "validate",
    "validated",
]

_ZERO_CELSIUS = 273.15

INERTIA = Quantity("moment of inertia", 0.0, 1e9, "kg m2", open_low=True)
RATIO = Quantity("dimensionless", 0.0, 1.0, open_low=True)
ORDER = Quantity("dimensionless", 0, 40, whole=True)
SLICES = Quantity("dimensionless", 1, 400, whole=True)
THERMAL_RESISTANCE = Quantity("thermal resistance", 0.0, 10.0, "K m2/W")
AREA = Quantity("area", 1e-8, 1e4, "m2")
MODULUS = Quantity("pressure", 1e6, 1e13, "GPa")
HARDNESS = Quantity("hardness", 1e6, 1e11, "GPa")
SOLID_CONDUCTIVITY = Quantity("thermal conductivity", 0.01, 1000.0, "W/m/K")
SPECIFIC_HEAT = Quantity("specific heat", 50.0, 5000.0, "J/kg/K")
POISSON = Quantity("dimensionless", 0.0, 0.5)
DENSITY = Quantity("density", 100.0, 30_000.0, "kg/m3")
SLOPE = Quantity("density slope", 0.0, 5.0, "kg/m3/K")
FALL = Quantity("temperature coefficient", 0.0, 0.05, "1/K")
VISCOSITY = Quantity("kinematic viscosity", 2e-6, 0.1, "mm2/s")
COLD_VISCOSITY = Quantity("kinematic viscosity", 2e-6, 10.0, "mm2/s")
ALPHA = Quantity("pressure-viscosity coefficient", 1e-10, 1e-6, "1/GPa")
FACTOR = Quantity("dimensionless", 0.0, 10.0, open_low=True)
CONDUCTIVITY = Quantity("thermal conductivity", 0.01, 10.0, "W/m/K")
ROUGHNESS = Quantity("length", 0.0, 1e-4, "um")
TORQUE = Quantity("torque", 0.0, 1e8, "N m")
LOADED = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
MAP_SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm")
TEMPERATURE = Quantity("temperature", 150.0, 600.0, "degC")
COEFFICIENT = Quantity("dimensionless", 0.0, 2.0)
SPREAD = Quantity("dimensionless", 1.0, 10.0)
COUNT = Quantity("dimensionless", 1, 100_000, whole=True)
MAP_COUNT = Quantity("dimensionless", 2, 200, whole=True)
DESIGNS = Quantity("dimensionless", 1, 10_000_000, whole=True)
STARTS = Quantity("dimensionless", 1, 4096, whole=True)
DESIGN_SEED = Quantity("dimensionless", 0, 1_000_000, whole=True)
WORKERS = Quantity("dimensionless", 1, 1000, whole=True)
BEARING_FACTOR = Quantity("dimensionless", 0.0, 100.0)
FORCE = Quantity("force", 0.0, 1e7, "N")
RATING = Quantity("force", 0.0, 1e9, "N", open_low=True)
PRESSED = Quantity("force", 0.0, 1e7, "N", open_low=True)
PLACE = Quantity("length", -10.0, 10.0, "mm")
TURN = Quantity("angle", -2 * pi, 2 * pi, "deg")
OVER_SQUARE = Quantity("line load", 0.0, 1e6, "N/m")
PRELOAD_RATIO = Quantity("dimensionless", 0.0, 100.0)
EXPONENT = Quantity("dimensionless", 0.0, 3.0, open_low=True)
ANY = Quantity("dimensionless", -inf, inf)

DAMPING = Quantity("viscous damping", 0.0, 1e9, "N s/m")
DURATION = Quantity("time", 0.0, 1e4, "s", open_low=True)
RISE = Quantity("time", 0.0, 1e4, "s")
CYCLES = Quantity("dimensionless", 1, 8, whole=True)
FILM_NODES = Quantity("dimensionless", 33, MOST_LINE_NODES, whole=True)
FILM_CELLS = Quantity("dimensionless", 32, 256, whole=True)
END_LENGTH = Quantity("length", 0.0, 1.0, "mm", open_low=True)
END_RADIUS = Quantity("length", 0.0, 1e5, "mm", open_low=True)
END_ANGLE = Quantity("angle", 0.0, pi / 2.0, "deg", open_low=True)
LINE_LOAD = Quantity("line load", 0.0, 1e9, "N/mm", open_low=True)
FILM_PHASES = Quantity("dimensionless", 3, 400, whole=True)
STRESS = Quantity("pressure", 1e3, 1e10, "MPa")
MCEWEN_EXPONENT = Quantity("dimensionless", 0.0, 1000.0, open_low=True)
PALUCH_SHARE = Quantity("dimensionless", 0.0, 1.0)
DIVERGENCE = Quantity("pressure", 1e8, 1e12, "GPa")
REFRACTIVE_INDEX = Quantity("dimensionless", 1.0, 2.0, open_low=True)
OF_SUMMITS = Quantity("dimensionless", 0.0, 10.0, open_low=True)
PATTERN = Quantity("dimensionless", 1 / 9, 9.0)
INLET = Quantity("length", 0.0, 10.0, "mm", open_low=True)
FILM_MOMENTS = Quantity("dimensionless", 2, 400, whole=True)
MAP_STEP = Quantity("length", 0.0, 0.1, "um", open_low=True)
MAP_UNIT = Quantity("length", 0.0, 1.0, "um", open_low=True)
MAP_PLACE = Quantity("length", -1.0, 1.0, "mm")
WEAR_TURNS = Quantity("dimensionless", 0.0, 1e15, open_low=True)
WORN_TURNS = Quantity("dimensionless", 0.0, 1e15)
MOST_STAGES = 5
"""Stages of a drive: the meetings of their phases multiply."""

WORN_STAGE = Quantity("dimensionless", 1, MOST_STAGES, whole=True)
WEAR_COEFFICIENT = Quantity("dimensionless", 0.0, 1.0)
WEAR_RATE = Quantity("specific wear rate", 0.0, 1e-6, "mm3/(N m)")
WEAR_DEPTH = Quantity("length", 1e-8, 0.1, "um")
WEAR_LAND = Quantity("length", 0.0, 0.1, "mm")
WEAR_CELLS = Quantity("dimensionless", 8, 400, whole=True)
WEAR_PHASES = Quantity("dimensionless", 4, 400, whole=True)
WEAR_ERROR = Quantity("dimensionless", 1e-8, 0.1)
WEAR_PRESSURE = Quantity("dimensionless", 1.0, 1000.0, open_low=True)
ADSORPTION_HEAT = Quantity("molar energy", 0.0, 1e6, "kJ/mol")
MOLECULE = Quantity("length", 1e-11, 1e-7, "nm")
VIBRATION = Quantity("time", 1e-15, 1e-6, "s")
LOAD_FACTOR = Quantity("dimensionless", 1.0, 10.0)
ACCURACY = Quantity("dimensionless", 3, 8, whole=True)
OFFSET = Quantity("length", -100.0, 100.0, "mm")
LIFE = Quantity("time", 0.0, 4e9, "h", open_low=True)
ENDURED = Quantity("pressure", 1e6, 2.5e9, "MPa")
HARDENING = Quantity("dimensionless", 0.5, 2.0)
REVERSED = Quantity("dimensionless", 0.1, 1.0)
PEAK_TO_VALLEY = Quantity("length", 0.0, 4e-4, "um", open_low=True)
INSTANTS = Quantity("dimensionless", 2, 20_000, whole=True)
ON_PATH = Quantity("dimensionless", 0.0, 40.0)

TIMES = Quantity("dimensionless", 0.0, 1000.0, open_low=True)
NOT_NEGATIVE = Quantity("dimensionless", 0.0, inf)
POSITION = Quantity("dimensionless", 0, 11, whole=True)

Text = Annotated[str, BeforeValidator(text)]

BodyName = Annotated[str, BeforeValidator(lambda value: _name_of_body(value))]
Unit = Annotated[str, BeforeValidator(lambda value: _unit(value))]
Source = Annotated[Text, AfterValidator(lambda source: _with_its_variables(source))]


def _name_of_body(value: Any) -> str:
    name = text(value)
    if not (letters(name) and name.isprintable() and len(name) <= 40):
        raise InputError(f"{shown(name)} is not a name; use 1 to 40 signs, one a letter or a digit")
    return name


def _unit(value: Any) -> str:
    if text(value) != "1":
        units.kind_of(value)
    return str(value)


def _places(value: Any) -> tuple[Any, ...]:
    several = value if isinstance(value, list | tuple) else [value]
    for place in several:
        if isinstance(place, bool) or not isinstance(place, str | int | float):
            raise InputError(f"{shown(place)} was given where a place of the axis belongs")
    if not 1 <= len(several) <= 12:
        raise InputError(f"{len(several)} places were given; allowed are 1 to 12")
    return tuple(several)


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError(f"{shown(value)} was given; allowed are true and false")
    return value


def _variables() -> list[str]:
    return list(
        dict.fromkeys(name for variables in (VARIABLES, *_published()) for name in variables)
    )


def _published() -> Iterator[Iterable[str]]:
    return (publication.variables for publication in PUBLICATIONS.values())


def _with_its_variables(source: str) -> str:
    """Key of a publication, whose variables may be read from now on."""
    publication_of(source)
    return source


def _asperities() -> list[str]:
    return [SMOOTH, *ASPERITIES]


class SolidValues(Table):
    """A material by value.

    Laws that ask for the hardness of its flanks, or for what conducts the heat of a contact, say so.
    """

    young: Annotated[float, MODULUS]
    """Young's modulus E."""
    poisson: Annotated[float, POISSON]
    """Poisson's ratio ν."""
    density: Annotated[float, DENSITY] = 7830.0
    """Density."""
    hardness: Annotated[float, HARDNESS] | None = None
    """Indentation hardness, as 200 HV, 200 HB or a pressure; for laws that ask for it."""
    conductivity: Annotated[float, SOLID_CONDUCTIVITY] | None = None
    """Thermal conductivity, for the heat of contacts; not known unless given."""
    specific_heat: Annotated[float, SPECIFIC_HEAT] | None = None
    """Specific heat, for the heat of contacts; not known unless given."""


SolidName = Annotated[str, BeforeValidator(named(solid_names, "material"))]


class Materials(Table):
    """Materials of both gears, by name or by value.

    Gear 1 of a strain wave gear is the flexspline, that of a ball on disc the disc.
    """

    gear_1: SolidValues | SolidName = "steel"
    """Material of gear 1, by name or by value."""
    gear_2: SolidValues | SolidName = "steel"
    """Material of gear 2, by name or by value."""


class DriveMaterials(Materials):
    """Materials of gears 1 and 2 of meshes, or of the gears of planetary sets, by name or by value.

    Where a set has one of its own, those that are left out are steel, and gear_1 and gear_2 are not its.
    """

    sun: SolidValues | SolidName | None = None
    """Material of the sun of a planetary set; as gears 1 and 2 unless a gear of the set has its own."""
    planet: SolidValues | SolidName | None = None
    """Material of the planets, of all their gears; see sun."""
    ring: SolidValues | SolidName | None = None
    """Material of the ring; see sun."""
    second_ring: SolidValues | SolidName | None = None
    """Material of the second ring of a 3K set; see sun."""

    @property
    def of_set(self) -> set[str]:
        """Keys that were given of gears of planetary sets."""
        return of_set(self.model_fields_set)


OF_SET = ("sun", "planet", "ring", "second_ring")
"""Keys of [materials] for gears of planetary sets."""


def of_set(keys: Iterable[str]) -> set[str]:
    """Keys of [materials] that are of gears of planetary sets."""
    return {*keys} & {*OF_SET}


class Oil(Table):
    """An oil of the catalogue, by value, or a catalogue oil with some values of one's own.

    With a thickener or a consistency (NLGI number) it is a grease, and the values are those of its base oil.
    With its viscosity at -40 degC it goes down to there, and between -40 and 40 degC its viscosity follows
    the line through that one and the one at 40 degC: it changes at 25 degC too.
    """

    name: Annotated[str, BeforeValidator(named(oil_names, "lubricant"))] | None = None
    """Oil of the catalogue; values beside it take the place of its own."""
    base: Annotated[str, BeforeValidator(named(base_names, "class of base oil"))] | None = None
    """Class of base oil, for what an oil by value leaves open; needed without a name."""
    viscosity_40: Annotated[float, VISCOSITY] | None = None
    """Kinematic viscosity at 40 degC; that of the named oil unless given, needed without one."""
    viscosity_100: Annotated[float, VISCOSITY] | None = None
    """Kinematic viscosity at 100 degC; that of the named oil unless given, needed without one."""
    viscosity_minus_40: Annotated[float, COLD_VISCOSITY] | None = None
    """Kinematic viscosity at -40 degC, down to which the oil then goes."""
    density: Annotated[float, DENSITY] | None = None
    """Density at 15 degC; that of the named oil, or usual for the base, unless given."""
    density_slope: Annotated[float, SLOPE] | None = None
    """Fall of the density per kelvin; that of the named oil, or usual for the base, unless given."""
    pressure_viscosity: Annotated[float, ALPHA] | None = None
    """Pressure-viscosity coefficient α_p at all temperatures; of oil or base unless given."""
    lubricant_factor: Annotated[float, FACTOR] | None = None
    """Lubricant factor X_L of mean friction laws; of the named oil or the base unless given."""
    conductivity: Annotated[float, CONDUCTIVITY] | None = None
    """Thermal conductivity of the oil; 0.14 W/m/K unless given."""
    temperature_min: Annotated[float, TEMPERATURE] | None = None
    """Lowest temperature of use; that of the named oil, by value 0 degC, unless given."""
    temperature_max: Annotated[float, TEMPERATURE] | None = None
    """Highest temperature of use; that of the named oil, by value 120 degC, unless given."""
    thickener: Text = ""
    """Thickener of a grease, in words; the other values are those of its base oil."""
    consistency: Text = ""
    """Consistency of a grease, its NLGI number as text."""

    @model_validator(mode="after")
    def _known(self) -> "Oil":
        if self.name is None and (self.viscosity_40 is None or self.viscosity_100 is None):
            raise InputError(
                "an oil needs a name of the catalogue, or viscosity_40 and viscosity_100 by value"
            )
        if self.name is None and self.base is None:
            raise InputError(
                f"an oil by value needs its base, one of {', '.join(base_names())}, for density, "
                "pressure-viscosity coefficient and lubricant factor where they are not given"
            )
        return self


class RoughnessTable(Table):
    """Roughness: Ra, Rq or both of one flank (taken for both) or of each, or the composite Rq.

    With both, each law takes its own; with one, the other follows for Gaussian heights.
    """

    ra: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    """Arithmetic mean roughness Ra of the flanks; by rq, for Gaussian heights, unless given."""
    rq: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    """Root mean square roughness Rq of the flanks; by ra, for Gaussian heights, unless given."""
    composite_rq: Annotated[float, ROUGHNESS] | None = None
    """Composite Rq of both flanks, sqrt(Rq1^2 + Rq2^2), in place of ra and rq."""

    @model_validator(mode="after")
    def _enough(self) -> "RoughnessTable":
        stated = [name for name in ("ra", "rq", "composite_rq") if getattr(self, name) is not None]
        if not stated or ("composite_rq" in stated and len(stated) > 1):
            raise InputError(
                f"{' and '.join(stated) or 'no roughness'} "
                f"{'were' if len(stated) > 1 else 'was'} given; give ra, rq or both (one flank or a list of "
                "two), or composite_rq alone"
            )
        for number, (ra, rq) in enumerate(zip(self.ra or (), self.rq or (), strict=False), 1):
            if rq < ra:
                raise InputError(
                    f"Rq of gear {number}, {ROUGHNESS.show(rq)}, is below its Ra, {ROUGHNESS.show(ra)}; "
                    "the root of the mean square is at least the mean",
                    key="rq",
                )
        return self


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


class FrictionChoice(BaseModel):
    """A friction law with values for its own parameters."""

    model_config = ConfigDict(extra="allow", frozen=True, defer_build=True)

    name: Annotated[str, BeforeValidator(named(FRICTION.keys, "friction law"))]
    """Friction law; parameters of its own may stand beside it."""

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the law's own parameters."""
        return {key: COEFFICIENT.read(value) for key, value in (self.model_extra or {}).items()}

    @model_validator(mode="after")
    def _own(self) -> "FrictionChoice":
        if not self.model_extra:
            return self
        from pitchpoint.lubrication.conditions import arguments

        _, constants = arguments(FRICTION[self.name].function)
        for key, value in self.model_extra.items():
            if key not in constants:
                has = nearest(key, constants) if constants else "; it has none"
                raise InputError(f"is no parameter of {self.name}{has}", key=shorten(key))
            try:
                COEFFICIENT.read(value)
            except InputError as error:
                raise error.at(key=key) from None
        return self


def _choices(value: Any) -> Any:
    several = value if isinstance(value, list | tuple) else [value]
    if not 1 <= len(several) <= 12:
        raise InputError(f"{len(several)} friction laws were given; allowed are 1 to 12")
    tables = [
        choice if isinstance(choice, dict | FrictionChoice) else {"name": choice}
        for choice in several
    ]
    names = [str(choice.get("name")) for choice in tables if isinstance(choice, dict)]
    plain = [letters(name) for name in names]
    for name in names:
        if plain.count(letters(name)) > 1:
            raise InputError(f"{shown(name)} was given twice; name each friction law once")
    return tables


def _slices(value: float) -> float:
    if value != 1.0 and value % 2.0:
        raise InputError(
            f"{value:.0f} slices were given; allowed is an even number, half of them on each side of the "
            "pitch line, or 1 for the middle of each contact line alone"
        )
    return value


class Choices(Table):
    """Which law stands for which effect; friction and load sharing, where not given, by the gears."""

    friction: Annotated[tuple[FrictionChoice, ...], BeforeValidator(_choices)] = (
        FrictionChoice(name="iso_tr_14179_2"),
    )
    """Friction laws, a name or a list, the first one leading; that usual for the family unless given."""
    load_sharing: Annotated[
        str, BeforeValidator(named(LOAD_SHARING.keys, "load sharing model"))
    ] = "equal"
    """How pairs share the load; from_stiffness where the family or modified flanks ask for it."""
    rolling_resistance: Annotated[
        str, BeforeValidator(named(ROLLING_RESISTANCE.keys, "rolling resistance"))
    ] = "none"
    """Law of the rolling resistance of the contacts."""
    film_thickness: Annotated[
        str, BeforeValidator(named(FILM_THICKNESS.keys, "film thickness law"))
    ] = "dowson_higginson_1959"
    """Law of the film thickness; hamrock_dowson_1977 for contacts that are ellipses."""
    inlet_heating: Annotated[str, BeforeValidator(named(INLET_HEATING.keys, "inlet heating"))] = (
        "none"
    )
    """How the heat of shear in the inlet thins films and lowers rolling resistance."""
    asperity_load: Annotated[
        str, BeforeValidator(named(ASPERITY_LOAD.keys, "asperity load law"))
    ] = "none"
    """Law of the part of the load that asperities carry L_a."""
    elliptic_contact: Annotated[
        str, BeforeValidator(named(ELLIPTIC_CONTACT.keys, "elliptic contact"))
    ] = "hertz_1881"
    """How axes and pressure of an elliptic contact follow from its load."""
    tooth_compliance: Annotated[
        str, BeforeValidator(named(TOOTH_COMPLIANCE.keys, "tooth compliance model"))
    ] = "beam_foundation_weber"
    """Model by which teeth yield under load."""
    line_stiffness: Annotated[
        str, BeforeValidator(named(LINE_STIFFNESS.keys, "stiffness of a contact line"))
    ] = "integrated"
    """Whether teeth yield at each place of an inclined contact line, or all along it as in its middle."""
    tooth_temperature: Annotated[
        str, BeforeValidator(named(TOOTH_TEMPERATURE.keys, "tooth temperature model"))
    ] = "isothermal"
    """Model of the temperature that their own loss gives plastic teeth."""
    tooth_contact: Annotated[
        str, BeforeValidator(named(CONTACT_LAWS.keys, "law of tooth contact"))
    ] = "linear"
    """Whether teeth in a vibration never part, or part and meet their back flanks."""
    slices: Annotated[float, SLICES, AfterValidator(_slices)] = 12.0
    """Slices of each contact line: an even number, or 1 for its middle alone."""
    averaging: Literal["base_pitch", "path"] = "base_pitch"
    """Whether mean loss and efficiency are those of a mesh cycle, or over the path of one pair."""


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


class Loss(Table):
    """A place beside the teeth where two bodies brake each other, or one of them and the housing.

    Torques are those between the two bodies. A bearing between a body and the housing bears, beside its
    preload, what the teeth put on that body: all of it where it stands for all bearings of the body, its
    part where two are given with their positions along the axis, counted from the middle of the face
    towards the end that a contact line reaches last. The one that is locating takes the axial force. A
    bearing between wave generator and flexspline bears the radial load of the teeth in both zones.
    In a train a place that names the planet is at every planet, and a bearing stands for all of its body:
    of a planet in its carrier, or of a body in the housing; between two others it bears its preload.
    A bearing with its dynamic load rating has a life by ISO 281 at the speed between its bodies, and with a
    static one a static safety; those of planets bear K_γ times an equal share of the teeth, and the
    centrifugal force of the planet.
    A breakaway model and its torque by value hold the bodies at rest, beside the bearing and the seal.
    """

    between: Annotated[tuple[Text, Text], Field(examples=[["gear 1", "housing"]])]
    """The two bodies that brake each other; one of them may be the housing."""
    bearing: Annotated[str, BeforeValidator(named(BEARING_LOSS.keys, "bearing loss model"))] = (
        "none"
    )
    """Model of a rolling bearing between them."""
    mean_diameter: Annotated[float, BORE] | None = None
    """Mean diameter d_m of bearing or seal lip; needed by models of bearing and breakaway."""
    f0: Annotated[float, BEARING_FACTOR] | None = None
    """Factor of the lubricant f0 of the bearing model, as the maker has it."""
    f1: Annotated[float, BEARING_FACTOR] | None = None
    """Factor of the load f1 of the bearing model, as the maker has it."""
    preload: Annotated[float, FORCE] = 0.0
    """Load on the bearing without any on the teeth, which adds to theirs."""
    dynamic_load_rating: Annotated[float, RATING] | None = None
    """Basic dynamic load rating C of the bearing by its maker; gives its life by ISO 281."""
    static_load_rating: Annotated[float, RATING] | None = None
    """Basic static load rating C_0 of the bearing by its maker, which limits the torque by ISO 76."""
    life_exponent: Annotated[float, LIFE_EXPONENT] | None = None
    """Exponent of that life over the load, 3 of balls, 10/3 of rollers and needles; 3 unless given."""
    position: Annotated[float, PLACE] | None = None
    """Place of one of two bearings along the axis, from the middle of the face; of stages, as their place."""
    locating: Annotated[bool, BeforeValidator(_flag)] | None = None
    """Whether this one of two bearings takes the axial force; the first one unless either says."""
    seal_torque: Annotated[float, TORQUE] = 0.0
    """Torque of sliding seals, the same at every speed."""
    churning_torque: Annotated[float, TORQUE] = 0.0
    """Torque of the lubricant that is displaced, at churning_speed."""
    churning_speed: Annotated[float, SPEED] | None = None
    """Relative speed to which churning_torque belongs; needed with it."""
    churning_exponent: Annotated[float, EXPONENT] = 1.0
    """Exponent of the relative speed in the churning torque."""
    breakaway_torque: Annotated[float, TORQUE] = 0.0
    """Torque that holds the bodies at rest, beside bearing and seal; for starting alone."""
    breakaway: Annotated[str, BeforeValidator(named(BREAKAWAY.keys, "breakaway model"))] = "none"
    """Model of a torque that holds the bodies at rest, which adds to breakaway_torque."""
    breakaway_dry: Annotated[float, OVER_SQUARE] | None = None
    """Dry part of that model at a preload of 1, over the square of mean_diameter."""
    breakaway_viscous: Annotated[float, OVER_SQUARE] | None = None
    """Viscous part of that model at 100 mm2/s, over the square of mean_diameter."""
    breakaway_preload: Annotated[float, PRELOAD_RATIO] | None = None
    """Preload over that to which breakaway_dry belongs; 1 unless given."""
    breakaway_spread: Annotated[float, SPREAD] = 1.0
    """Factor by which what holds at rest may be more or less; makes a band of the torques from rest."""

    @property
    def factors(self) -> dict[str, float]:
        """Factors of the bearing model by name."""
        factors = {"f0": self.f0, "f1": self.f1}
        return {name: value for name, value in factors.items() if value is not None}

    @property
    def breakaway_factors(self) -> dict[str, float]:
        """Factors of the breakaway model by name."""
        factors = {"dry": self.breakaway_dry, "viscous": self.breakaway_viscous}
        named = {name: value for name, value in factors.items() if value is not None}
        if self.breakaway == "none" and self.breakaway_preload is None:
            return named
        ratio = 1.0 if self.breakaway_preload is None else self.breakaway_preload
        return {**named, "preload": ratio}

    @model_validator(mode="after")
    def _complete(self) -> "Loss":
        moving = self._asked(self.bearing, BEARING_LOSS[self.bearing].factors, self.factors)
        holding = [f"breakaway_{name}" for name in self.breakaway_factors]
        wanted = [f"breakaway_{name}" for name in BREAKAWAY[self.breakaway].factors]
        held = self._asked(self.breakaway, wanted, holding)
        if not (moving or held) and self.mean_diameter is not None:
            raise InputError(
                "was given, and without a bearing nothing asks for it: a seal takes its torque by value; "
                "leave it out, or name a model in bearing or breakaway",
                key="mean_diameter",
            )
        if self.churning_torque > 0.0 and self.churning_speed is None:
            raise InputError(
                "is missing; churning_torque is that at this speed", key="churning_speed"
            )
        of_bearing = dict.fromkeys(
            ("preload", "dynamic_load_rating", "static_load_rating", "position", "locating"),
            "a bearing",
        )
        alone = of_bearing if self.bearing == "none" else {}
        if not _given(self, "dynamic_load_rating"):
            alone |= {"life_exponent": "dynamic_load_rating"}
            alone = {"static_load_rating": "dynamic_load_rating"} | alone
        if not _given(self, "churning_torque"):
            alone |= dict.fromkeys(("churning_speed", "churning_exponent"), "churning_torque")
        if not (held or _given(self, "breakaway_torque")):
            alone |= {"breakaway_spread": "a breakaway model or breakaway_torque"}
        for name in (key for key in alone if _given(self, key)):
            raise InputError(f"was given without {alone[name]}, to which it belongs", key=name)
        beside = (self.seal_torque, self.churning_torque, self.breakaway_torque)
        parts = (self.breakaway_dry, self.breakaway_viscous)
        if not any((*self.factors.values(), *beside, *parts)):
            raise InputError(
                "all torques and factors are zero: nothing is lost; leave the table out, or write "
                '"none" in place of one that a set has'
            )
        return self

    def _asked(self, model: str, wanted: Sequence[str], given: Collection[str]) -> Sequence[str]:
        """What a model asks for; InputError if something of it is missing, or more was given."""
        needed = () if model == "none" else ("mean_diameter", *wanted)
        there = {*given, *(["mean_diameter"] if self.mean_diameter is not None else [])}
        for name in (*needed, *sorted(given)):
            if (name in needed) != (name in there):
                if not needed:
                    kind = name.partition("_")[0] if name.startswith("breakaway") else "bearing"
                    raise InputError(
                        f'was given, and no model asks for it: {kind} is "none"; name one, or leave this out',
                        key=name,
                    )
                complaint = "is missing" if name in needed else "was given"
                raise InputError(f"{complaint}; {model} asks for {', '.join(needed)}", key=name)
        return needed


class ProfileError(Deviation):
    """One order of the composite profile error, repeated with every mesh period; order 0 is constant."""

    order: Annotated[float, ORDER]
    """Order of the mesh frequency; 0 is a constant error."""
    amplitude: Annotated[float, DEVIATION]
    """Amplitude along the line of action; a positive error parts the flanks."""
    phase: Annotated[float, PHASE] = 0.0
    """Angle of the wave at the beginning of the mesh cycle."""


class Speeds(Table):
    """Driver speeds through which resonances are looked for, upwards and downwards."""

    start: Annotated[float, SPEED]
    """Lowest speed of the driver."""
    stop: Annotated[float, SPEED]
    """Highest speed of the driver."""
    count: Annotated[float, Quantity("dimensionless", 2, 2000, whole=True)] = 60.0
    """Number of speeds, equally apart."""

    @model_validator(mode="after")
    def _rising(self) -> "Speeds":
        if self.start >= self.stop:
            raise InputError(
                f"speeds run from {SPEED.show(self.start)} to {SPEED.show(self.stop)}; stop must be "
                "the larger"
            )
        return self


class StartUp(Table):
    """A start from rest, or from a speed: the load comes up over the rise, and a torque drives.

    The torque is constant, or that of the motor of the same table.
    """

    duration: Annotated[float, DURATION]
    """Time over which the motion is followed."""
    torque: Annotated[float, TORQUE] | None = None
    """Constant torque that drives; needed unless a motor or a prescribed speed does."""
    rise: Annotated[float, RISE] = 0.0
    """Time over which the load comes up; 0 has it there at once."""
    speed: Annotated[float, MAP_SPEED] = 0.0
    """Speed of the driver at the start; 0 is rest."""
    count: Annotated[float, INSTANTS] = 2001.0
    """Number of instants that are kept, equally apart."""

    @model_validator(mode="after")
    def _inside(self) -> "StartUp":
        if self.rise >= self.duration:
            message = f"{RISE.show(self.rise)} was given; it is shorter than the duration"
            raise InputError(f"{message}, {DURATION.show(self.duration)}", key="rise")
        return self


class MotionTable(Table):
    """Motion with the friction of the teeth in it, of two gears that turn and shift on their bearings.

    It takes inertia, damping ratio, profile error, backlash and speeds from the table around it.
    """

    bearing_stiffness: Annotated[tuple[float, float], Pair(STIFFNESS)] | None = None
    """Stiffness of the bearings of each gear, along and across the line of action; else rigid."""
    bearing_damping: Annotated[tuple[float, float], Pair(DAMPING)] | None = None
    """Damping of the bearings of each gear; by damping_ratio and mass unless given."""
    mass: Annotated[tuple[float, float], Pair(MASS)] | None = None
    """Mass of each gear; needed with bearing_stiffness."""
    mesh_damping: Annotated[float, DAMPING] | None = None
    """Damping along the line of action; by damping_ratio and mean stiffness unless given."""
    pair_path: Annotated[tuple[Annotated[float, ON_PATH], ...], Field(max_length=400)] = ()
    """Places of a table of pair stiffness, in base pitches, growing from 0 at the entry of a pair."""
    pair_stiffness: Annotated[tuple[Annotated[float, STIFFNESS], ...], Field(max_length=400)] = ()
    """Stiffness of a pair at these places; that of the tooth compliance unless given."""
    prescribed_speed: Annotated[bool, BeforeValidator(_flag)] = False
    """Whether the speed of the driver is held; else it has its inertia and a torque."""
    stall_torque: Annotated[float, LOADED] | None = None
    """Torque of a motor at rest, which falls to 0 at no_load_speed; no motor unless given."""
    no_load_speed: Annotated[float, SPEED] | None = None
    """Speed at which the motor has no torque; needed with stall_torque."""
    cycles: Annotated[float, CYCLES] = 1.0
    """Mesh cycles after which the steady motion repeats."""
    start_up: StartUp | None = None
    """Asks for the motion from a start in time."""

    @model_validator(mode="after")
    def _complete(self) -> "MotionTable":
        for key, needed, why in _TOGETHER:
            if _given(self, key) and not _given(self, needed):
                raise InputError(f"is missing; {why}", key=needed)
        if self.prescribed_speed and self.stall_torque is not None:
            message = (
                "was given; a driver of prescribed speed needs no motor, leave one of them out"
            )
            raise InputError(message, key="stall_torque")
        if len(self.pair_path) != len(self.pair_stiffness):
            message = (
                f"{len(self.pair_stiffness)} values are given for {len(self.pair_path)} places"
            )
            raise InputError(f"{message} of pair_path; give as many", key="pair_stiffness")
        _check_path(self.pair_path)
        self._check_start()
        return self

    def _check_start(self) -> None:
        start = self.start_up
        if start is None:
            return
        motor = self.stall_torque is not None
        if motor and start.torque is not None:
            message = "was given; the motor of stall_torque drives, leave one of them out"
            raise InputError(message, key="start_up.torque")
        if not motor and start.torque is None and not self.prescribed_speed:
            message = "is missing; a start asks for a torque that drives, or for the motor of stall_torque"
            raise InputError(message, key="start_up.torque")
        if self.prescribed_speed and start.torque is not None:
            message = (
                "was given; a driver of prescribed speed needs no torque, leave one of them out"
            )
            raise InputError(message, key="start_up.torque")
        if self.prescribed_speed and start.speed == 0.0:
            message = (
                "is missing; a driver of prescribed speed keeps the speed with which it starts"
            )
            raise InputError(message, key="start_up.speed")


_TOGETHER = (
    ("bearing_stiffness", "mass", "gears that shift on their bearings ask for their masses"),
    ("bearing_damping", "bearing_stiffness", "it belongs to bearing_damping"),
    ("mass", "bearing_stiffness", "masses move only on bearings that yield"),
    ("stall_torque", "no_load_speed", "a motor has a torque at rest and a speed without load"),
    ("no_load_speed", "stall_torque", "a motor has a torque at rest and a speed without load"),
    ("pair_path", "pair_stiffness", "a table of stiffness has places and values"),
    ("pair_stiffness", "pair_path", "a table of stiffness has places and values"),
)
"""Keys that ask for others, and why."""


def _check_path(places: Sequence[float]) -> None:
    """InputError unless the places of a table of stiffness grow from the entry of a pair on."""
    if not places:
        return
    if len(places) < 2 or places[0] != 0.0 or any(b <= a for a, b in pairwise(places)):
        stated = f"{', '.join(f'{place:g}' for place in places)} was given"
        raise InputError(
            f"{stated}; places of a pair grow from 0, where it enters, in base pitches, at least two of them",
            key="pair_path",
        )


class Dynamics(Table):
    """Vibration of a pair along its line of action, or of a joint about the axis of its drive."""

    damping_ratio: Annotated[float, RATIO] = 0.1
    """Damping ratio ξ; 0.03 of strain wave gears unless given."""
    inertia: Annotated[tuple[float, float], Pair(INERTIA)] | None = None
    """Moments of inertia of both gears, discs unless given; of a joint motor and load, needed."""
    profile_error: Annotated[tuple[ProfileError, ...], Field(max_length=41)] = ()
    """Orders of the composite profile error of the pair; none unless given."""
    backlash: Annotated[float, DEVIATION] | None = None
    """Free way along the line of action before back flanks meet; endless unless given."""
    torques: Annotated[tuple[Annotated[float, LOADED], ...], Field(max_length=50)] = ()
    """Torques of the vibration; that of the operating point unless given."""
    forces: Annotated[tuple[Annotated[float, PRESSED], ...], Field(max_length=50)] = ()
    """Forces of the vibration of a rack; that of the operating point unless given."""
    speeds: Speeds | None = None
    """Speeds of the driver beside the operating one; none, of a joint its own choice, unless given."""
    motion: MotionTable | None = None
    """Asks for the motion with the friction of the teeth in it; may be empty."""


def _nodes(value: float) -> float:
    from pitchpoint.lubrication.ehl.grid import fewer

    fewer(int(value))
    return value


def _cells(value: float) -> float:
    if int(value) & (int(value) - 1):
        raise InputError(f"{value:g} cells along a contact line; allowed are 32, 64, 128 and 256")
    return value


class HeightTable(Table):
    """Measured heights of a surface in a file: rows across the contact, columns along it.

    One column of heights is a profile, and so are two, of places and heights: it was measured along the
    surface speeds, or across them as `direction` says, and is the same everywhere the other way. A profile
    takes the step of its own way alone; places are evenly apart, in any unit of length. Files x3p
    (ISO 25178-72) say steps and unit themselves.

    `unit` is what a height of one in the file is. The middle of the map lies in that of the contact unless
    `middle_along` and `middle_across` say otherwise. It has to cover the contact unless it is `periodic`: one
    that repeats, whose last row and column are the first ones of the next period, with the same heights.
    """

    file: Text
    """File of the heights beside the case file: .csv, .txt, .npy or .x3p."""
    step_along: Annotated[float, MAP_STEP] | None = None
    """Distance between columns, along the surface speeds; needed by maps and by profiles along them."""
    step_across: Annotated[float, MAP_STEP] | None = None
    """Distance between rows, across the surface speeds; needed by maps and by profiles across them."""
    direction: Literal["along", "across"] = "along"
    """Way along which a profile was measured; a map has both."""
    unit: Annotated[float, MAP_UNIT] = 1e-6
    """What a height of one in the file is."""
    middle_along: Annotated[float, MAP_PLACE] = 0.0
    """Middle of the map from that of the contact, along the surface speeds."""
    middle_across: Annotated[float, MAP_PLACE] = 0.0
    """Middle of the map from that of the contact, across the surface speeds."""
    periodic: Annotated[bool, BeforeValidator(_flag)] = False
    """Whether the map repeats; else it has to cover the contact."""


class HeightTables(Table):
    """Height maps of the surfaces in contact, or of both together, which stays where it is."""

    gear_1: HeightTable | None = None
    """Height map of gear 1, which moves along with its surface in films with squeeze."""
    gear_2: HeightTable | None = None
    """Height map of gear 2, which moves along with its surface in films with squeeze."""
    both: HeightTable | None = None
    """Height map of both together, which stays where it is."""


class FilmTable(Table):
    """Films of the contacts solved over the mesh cycle; what is left out is as `FilmModel` has it.

    `phases` are the least number of states over a mesh cycle; `in_series` asks what the films take from the
    torsional stiffness. With the `time` "squeeze" one pair is followed through its engagement as well, at no
    more than `moments`. The parameters are those of the shear law, and
    of the profile of the ends.
    """

    solver: Literal["line", "finite_line", "elliptic"]
    """Contacts that are solved: lines without ends, lines as long as they are, or ellipses."""
    phases: Annotated[float, FILM_PHASES] = 24.0
    """Least number of states over a mesh cycle."""
    in_series: Annotated[bool, BeforeValidator(_flag)] = False
    """Whether to tell what films in series take from the torsional stiffness."""
    nodes: Annotated[float, FILM_NODES, AfterValidator(_nodes)] | None = None
    """Nodes along the motion: 33, 65, ...; unless given 129, or 65 over patches, doubled above M = 100."""
    cells: Annotated[float, FILM_CELLS, AfterValidator(_cells)] | None = None
    """Cells across the motion: 32, 64, 128 or 256; one less than nodes unless given."""
    time: Literal["steady", "squeeze"] | None = None
    """Steady films alone, or one pair followed with squeeze as well; steady unless given."""
    moments: Annotated[float, FILM_MOMENTS] | None = None
    """Most moments of the engagement with squeeze; 40 unless given."""
    heights: HeightTables | None = None
    """Measured heights of the surfaces; none unless given."""
    ends: Literal["half_space", "mirrored"] | None = None
    """Whether bodies go on beyond a line or both end with it; half_space unless given."""
    end_profile: Annotated[str, BeforeValidator(named(END_PROFILES.keys, "end profile"))] | None = (
        None
    )
    """Profile of the ends of contact lines; none unless given."""
    end_length: Annotated[float, END_LENGTH] | None = None
    """Length of each end along the face, of chamfered and dub_off ends."""
    end_radius: Annotated[float, END_RADIUS] | None = None
    """Radius of the arc of crowned and dub_off ends."""
    end_angle: Annotated[float, END_ANGLE] | None = None
    """Angle between bevel and face of chamfered ends."""
    end_line_load: Annotated[float, LINE_LOAD] | None = None
    """Line load for which log_relieved ends make the pressure even."""
    end_drop: Annotated[float, END_LENGTH] | None = None
    """Largest drop of log_relieved ends; without bound unless given."""
    viscosity_law: (
        Annotated[
            str, BeforeValidator(named(LAWS_OF_VISCOSITY.keys, "law of viscosity under pressure"))
        ]
        | None
    ) = None
    """Law of the viscosity under pressure; roelands_1966 unless given."""
    density_law: (
        Annotated[
            str, BeforeValidator(named(LAWS_OF_DENSITY.keys, "law of density under pressure"))
        ]
        | None
    ) = None
    """Law of the density under pressure; dowson_higginson_1966 unless given."""
    shear_law: (
        Annotated[str, BeforeValidator(named(SHEAR_STRESS.keys, "law of shear stress"))] | None
    ) = None
    """Law of the shear stress; ree_eyring_1955 unless given."""
    mcewen_exponent: Annotated[float, MCEWEN_EXPONENT] | None = None
    """Exponent q of bair_2015; 3 unless given, assumed."""
    paluch_share: Annotated[float, PALUCH_SHARE] | None = None
    """Part of the pressure-viscosity coefficient by the Paluch term of bair_2015; 0.36 unless given."""
    divergence_pressure: Annotated[float, DIVERGENCE] | None = None
    """Pressure at which that term goes to infinity; 4.7 GPa unless given, assumed."""
    eyring_stress: Annotated[float, STRESS] | None = None
    """Eyring stress of ree_eyring_1955; 5 MPa unless given, assumed."""
    critical_stress: Annotated[float, STRESS] | None = None
    """Shear stress from which on carreau_1972 thins; 7 MPa unless given, recalled of thin hydrocarbons."""
    shear_exponent: Annotated[float, RATIO] | None = None
    """Exponent n of carreau_1972; 0.45 unless given, assumed."""
    limiting_coefficient: Annotated[float, COEFFICIENT] | None = None
    """Rise of the limiting shear stress with pressure, where the law has one; 0.08 unless given, assumed."""
    limiting_stress: Annotated[float, STRESS] | None = None
    """Limiting shear stress without pressure, where the law has one; 2 MPa unless given, assumed."""
    limiting_fall: Annotated[float, FALL] | None = None
    """Relative fall of the limiting shear stress per kelvin; none unless given, no figure was found."""
    asperities: (
        Annotated[str, BeforeValidator(named(_asperities, "law of asperity contact"))] | None
    ) = None
    """Law of asperity contact, or none for smooth flanks; greenwood_tripp_1970 unless given."""
    summits: Annotated[str, BeforeValidator(named(SUMMITS.keys, "set of summits"))] | None = None
    """Set of constants of the summits of asperities; textbooks unless given, all sets are assumed."""
    eta_beta_sigma: Annotated[float, OF_SUMMITS] | None = None
    """Summits per area times their radius times Rq; that of the set of summits unless given, 0.05."""
    sigma_over_beta: Annotated[float, OF_SUMMITS] | None = None
    """Rq over the radius of summits; that of the set of summits unless given, 0.01."""
    pattern: Annotated[float, PATTERN] | None = None
    """Peklenik's number γ of the roughness; 1, without a direction, unless given."""
    boundary_friction: Annotated[float, COEFFICIENT] | None = None
    """Friction coefficient of asperities that touch; 0.1 unless given, assumed."""
    refractive_index: Annotated[float, REFRACTIVE_INDEX] | None = None
    """Index of the oil at ambient pressure, with which interferometry reads films; none unless given."""
    inlet: Annotated[float, INLET] | None = None
    """Distance ahead of a contact at which oil begins; a module, without teeth flooded, unless given."""
    thermal: (
        Annotated[str, BeforeValidator(named(THERMAL.keys, "thermal effect of a film"))] | None
    ) = None
    """Heat in the film; isothermal unless given."""

    @property
    def shear_parameters(self) -> dict[str, float]:
        """Parameters of the shear law that were given, by name [SI]."""
        return self._named(_OF_SHEAR)

    @property
    def viscosity_parameters(self) -> dict[str, float]:
        """Parameters of the law of viscosity that were given, by name [SI]."""
        return self._named(OF_VISCOSITY)

    def _named(self, names: tuple[str, ...]) -> dict[str, float]:
        values = {name: getattr(self, name) for name in names}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def set_of_summits(self) -> SummitConstants:
        """Constants of summits of which nothing else is given."""
        return SUMMITS[self.summits or USUAL_SUMMITS]

    @property
    def over_patch(self) -> bool:
        """True if films are solved over the whole patch of a contact, not as those of lines without ends."""
        return self.solver != "line"

    @property
    def squeezes(self) -> bool:
        """True if the film of a pair is followed through its engagement, with squeeze."""
        return self.time == "squeeze"

    @property
    def profile_parameters(self) -> dict[str, float]:
        """Parameters of the profile of the ends that were given, by the names that it has for them [SI]."""
        stated = {name.removeprefix("end_"): getattr(self, name) for name in _OF_ENDS}
        return {name: value for name, value in stated.items() if value is not None}

    @model_validator(mode="after")
    def _of_solver(self) -> "FilmTable":
        for key, why in _NOT_OF[self.solver].items():
            if getattr(self, key) is not None:
                raise InputError(f"was given; {why}", key=key)
        if self.over_patch:
            _check_patch(self)
        else:
            _check_line(self)
        if self.squeezes and self.thermal not in (None, "isothermal"):
            message = f'"{self.thermal}" was given; films with squeeze are isothermal: leave it or time out'
            raise InputError(message, key="thermal")
        if self.moments is not None and not self.squeezes:
            message = 'was given without time = "squeeze", to which it belongs'
            raise InputError(message, key="moments")
        return self

    @model_validator(mode="after")
    def _of_profile(self) -> "FilmTable":
        stated = self.profile_parameters
        if self.end_profile is None:
            for name in stated:
                raise InputError(
                    "was given without end_profile, to which it belongs", key=f"end_{name}"
                )
            return self
        needed, parameters = END_PROFILES[self.end_profile].parameters
        for name in stated:
            if name not in parameters:
                has = ", ".join(f"end_{parameter}" for parameter in parameters) or "none"
                message = f"is no parameter of {self.end_profile}; it has {has}"
                raise InputError(message, key=f"end_{name}")
        for name in needed:
            if name not in stated:
                raise InputError(f"is missing; {self.end_profile} asks for it", key=f"end_{name}")
        return self

    @model_validator(mode="after")
    def _own(self) -> "FilmTable":
        laws = (
            (SHEAR_STRESS[self.shear_law or USUAL_SHEAR_STRESS], self.shear_parameters),
            (LAWS_OF_VISCOSITY[self.viscosity_law or USUAL_VISCOSITY], self.viscosity_parameters),
        )
        for law, named_here in laws:
            has = [name for name in law.parameters if name in FilmTable.model_fields]
            for key in named_here.keys() - {*has}:
                message = f"is no parameter of {law.name}; it has {', '.join(has) or 'none'}"
                raise InputError(message, key=key)
        for key in _OF_ROUGH if self.asperities == SMOOTH else ():
            if getattr(self, key) is not None:
                message = "was given without asperities, to which it belongs"
                raise InputError(message, key=key)
        if None not in (self.summits, self.eta_beta_sigma, self.sigma_over_beta):
            message = "was given with both constants of a set: leave out it or one of them"
            raise InputError(message, key="summits")
        return self


_OF_SHEAR = (
    "eyring_stress",
    "critical_stress",
    "shear_exponent",
    "limiting_coefficient",
    "limiting_stress",
    "limiting_fall",
)
OF_VISCOSITY = ("mcewen_exponent", "paluch_share", "divergence_pressure")
"""Keys of `[film]` that are parameters of a law of viscosity under pressure."""
_OF_ROUGH = ("summits", "eta_beta_sigma", "sigma_over_beta", "pattern", "boundary_friction")
_OF_ENDS = ("end_length", "end_radius", "end_angle", "end_line_load", "end_drop")

_NO_ENDS = 'lines of this solver have no ends; take solver = "finite_line", or leave it out'
_STEADY = (
    'films of this solver are steady; take solver = "finite_line" or "elliptic", or leave it out'
)
_EVEN = (
    '"across" was given; lines of this solver are the same all along, and take profiles along the surface '
    'speeds; take solver = "finite_line", or leave it out'
)
_NOT_READ = 'films that are read by interferometry are those of solver = "elliptic"; leave it out'
_ELLIPSE = "an ellipse ends by itself; leave it out"
_NOT_OF: Mapping[str, Mapping[str, str]] = {
    "line": {
        **{key: _NO_ENDS for key in ("cells", "ends", "end_profile", *_OF_ENDS)},
        **dict.fromkeys(("time", "moments"), _STEADY),
        "refractive_index": _NOT_READ,
    },
    "finite_line": {"refractive_index": _NOT_READ},
    "elliptic": {key: _ELLIPSE for key in ("ends", "end_profile", *_OF_ENDS)},
}
"""Keys that a solver of films has nothing to do with, and why."""


def _check_line(table: FilmTable) -> None:
    """InputError for profiles that lines without ends do not take."""
    for name, heights in table.heights or ():
        if heights is not None and heights.direction == "across":
            raise InputError(_EVEN, key=f"heights.{name}.direction")


def _check_patch(table: FilmTable) -> None:
    """InputError for what solvers over a patch do not take."""
    if table.nodes is not None and table.nodes > MOST_PATCH_NODES:
        message = (
            f"{table.nodes:g} nodes along a patch; allowed are 33, 65, 129 and {MOST_PATCH_NODES}"
        )
        raise InputError(message, key="nodes")
    if table.pattern not in (None, 1.0):
        message = "over a patch oil flows both ways, and only the pattern 1 is the same for both"
        raise InputError(f"{table.pattern:g} was given; {message}", key="pattern")


def one_value(start: Any, stop: Any) -> str:
    """Why a sweep of a single value has no two ends."""
    return f"1 value cannot be both {shown(start)} and {shown(stop)}; write 2 or more"


class Sweep(Table):
    """Values of one key: from start to stop in equal steps, or a list."""

    key: Text
    """Dotted key whose value is swept, as gears.profile_shift.1."""
    start: Any = None
    """First value; with stop in place of values."""
    stop: Any = None
    """Last value; with start in place of values."""
    count: Annotated[float, COUNT] = 19.0
    """Number of values from start to stop, equally apart."""
    values: tuple[Any, ...] | None = None
    """List of values in place of start and stop."""

    @model_validator(mode="after")
    def _complete(self) -> "Sweep":
        if (self.values is None) == (self.start is None or self.stop is None):
            raise InputError("a sweep needs either start and stop, or values")
        if self.values is not None and not 1 <= len(self.values) <= COUNT.high:
            raise InputError(f"{len(self.values)} values were given; {COUNT.allowed}", key="values")
        if self.values is None and self.count < 2 and self.start != self.stop:
            raise InputError(one_value(self.start, self.stop), key="count")
        return self


class Study(Table):
    """One computation of the case: its operating point with changes, swept or not."""

    title: Text = ""
    """Title on screen and in the report; the name of the study unless given."""
    change: dict[str, Any] = Field(default_factory=dict)
    """What differs from the case, by its tables and keys; nothing unless given."""
    sweep: Sweep | None = None
    """Values over which one key is swept; one point unless given."""


class StudyTable(Table):
    """Many designs of the case, which the command `study` computes; `run` leaves them out.

    `over` has the values of each key: a list, or { start = ..., stop = ..., count = ... } in equal steps;
    where designs are drawn two ends, or { start = ..., stop = ..., distribution = "normal" }, whose ends are
    three standard deviations from its middle. `tolerances` draws what [gears.inspection] allows: both tooth
    thicknesses, the centre distance, by a class of ISO 1328-1 the misalignment by helix slopes.
    """

    over: dict[str, Any] = Field(
        default_factory=dict, examples=[{"operation.torque": ["20 N m", "90 N m"]}]
    )
    """Values by dotted key; may be left out with tolerances."""
    how: Literal["grid", "zip", "latin_hypercube", "sobol", "saltelli"] | None = None
    """How designs are laid out, by saltelli for Sobol' indices; grid, with tolerances sobol, unless given."""
    n: Annotated[float, DESIGNS] | None = None
    """Designs to draw; of sobol, and of each of both samples of saltelli, a power of two."""
    seed: Annotated[float, DESIGN_SEED] = 0.0
    """Number from which designs are drawn; the same one draws the same designs."""
    tolerances: Literal["uniform", "normal"] | None = None
    """Distribution of tolerances between their limits; gears are the nominal ones unless given."""
    folder: Text = ""
    """Folder of the files, from that of the case file on; results/CASE/study unless given."""
    piece: Annotated[float, DESIGNS] | None = None
    """Designs that are computed and kept together; 4096 unless given."""
    workers: Annotated[float, WORKERS] | None = None
    """Processes of this machine that compute; the one of the command unless given."""
    scheduler: Text = ""
    """Address of a scheduler of dask.distributed whose workers compute, in place of workers."""

    @model_validator(mode="after")
    def _of_something(self) -> "StudyTable":
        if not self.over and self.tolerances is None:
            raise InputError(
                'a study needs the values of one key at least, "operation.torque" = ["20 N m", "90 N m"], or '
                "tolerances",
                key="over",
            )
        if self.workers is not None and self.scheduler:
            raise InputError(
                "goes with workers of this machine; give it or a scheduler", key="workers"
            )
        return self

    @property
    def by_key(self) -> dict[str, Any]:
        """Values by dotted key, also of keys that were written as tables within tables."""
        return dict(_values_by_key(self.over))


class OptimiseTable(Table):
    """Keys to vary until one result is least or largest, for the command `optimise`; `run` leaves it out.

    `vary` has of each key the ends between which it may lie, "10 mm:30 mm", or a list of values of which each
    is tried. Results have the names that they have in a study or a run: mean_loss, least_root_safety.
    """

    vary: dict[str, Any] = Field(
        default_factory=dict, examples=[{"gears.profile_shift.1": "0:0.6"}]
    )
    """Ends or list of values by dotted key."""
    minimise: Text = ""
    """Result that is to be as small as can be; this or maximise."""
    maximise: Text = ""
    """Result that is to be as large as can be."""
    subject_to: tuple[Text, ...] = ()
    """What is kept, each a result, >=, <= or =, and a value, "root_safety >= 1.5"; nothing unless given."""
    law: Text = ""
    """Friction law under which results are meant; the first one unless given."""
    starts: Annotated[float, STARTS] | None = None
    """Evenly spread designs to begin with; 16 for each key with two ends, 256 at most, unless given."""
    folder: Text = ""
    """Folder of the files, from that of the case file on; results/CASE/optimum unless given."""

    @model_validator(mode="after")
    def _one_aim(self) -> "OptimiseTable":
        if not self.vary:
            told = 'an optimiser needs a key to vary, "gears.profile_shift.1" = "0:0.6"'
            raise InputError(told, key="vary")
        if bool(self.minimise) == bool(self.maximise):
            told = 'one result is the aim, minimise = "mean_loss" or maximise = "mean_efficiency"'
            raise InputError(told, key="minimise")
        return self

    @property
    def by_key(self) -> dict[str, Any]:
        """What varies by dotted key, also of keys that were written as tables within tables."""
        return dict(_values_by_key(self.vary))


def _values_by_key(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and value and not {"start", "stop", "values"} & value.keys():
            yield from _values_by_key(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


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


class Target(Table):
    """A printed number and how it is computed from a study, or from another part of the result.

    `at` names one place of the axis of that part or several; values there are interpolated between
    those that were computed, and `reduce` makes one number of them. `slope` is the change of the
    variable over that of the axis from the first place to the last, `inverse_slope` its inverse:
    with the wind-up of the part `torsion`, which runs over torque, the stiffness between two torques.
    A number to be exceeded or not reached, `expect`, is `times` the printed one.
    """

    quantity: Text
    """What the number is, in words."""
    where: Text
    """Place of the number in its source."""
    kind: Literal[
        "predicted", "fitted", "calibrated", "trend", "definition", "reference", "excluded"
    ]
    """What agreement with the number would show, and whether it is left out."""
    printed: Annotated[float, ANY]
    """The printed number, in its unit."""
    unit: Unit = "1"
    """Unit of the printed number; 1 for none."""
    tolerance: Annotated[float, NOT_NEGATIVE] = 0.0
    """Largest deviation that passes, in the unit of the number."""
    expect: Literal["within", "above", "below"] = "within"
    """Whether the number is to be met within the tolerance, exceeded or not reached."""
    times: Annotated[float, TIMES] = 1.0
    """Factor on the printed number of a bound."""
    study: Text = ""
    """Study that is read; this or a part."""
    part: Text = ""
    """Part of the result that is read; this or a study."""
    variable: Annotated[str, BeforeValidator(named(_variables, "quantity", VARIABLES))] = ""
    """Result variable that is read."""
    at: Annotated[tuple[Any, ...], BeforeValidator(_places)] = ()
    """Places on the axis that are read, one or a list; all that were computed unless given."""
    reduce: Annotated[str, BeforeValidator(named(REDUCTIONS.keys, "reduction"))] = "value"
    """How one number is made of the values at these places."""
    law: tuple[Annotated[float, POSITION], ...] = (0.0,)
    """Positions of the friction laws that are read, from 0."""
    less: Annotated[float, ANY] = 0.0
    """Number that is taken off the computed one before both are compared, in the unit of the print."""
    reason: Text = ""
    """Why the number deviates, or is left out."""
    missed: Text = ""
    """Why the number is known to be missed; a number that is met all the same fails the comparison."""

    @property
    def reads(self) -> str:
        """Name of the part that it reads."""
        return self.part or f"study_{self.study}"

    @model_validator(mode="after")
    def _one(self) -> "Target":
        if self.study and self.part:
            raise InputError(
                "study and part were both given; a target reads one of them", key="part"
            )
        if self.missed and self.kind == "excluded":
            raise InputError("a number that is left out is not missed; give a reason", key="missed")
        if self.missed and self.reason:
            raise InputError(
                "reason and missed were both given; a known miss has one", key="reason"
            )
        if self.times != 1.0 and self.expect == "within":
            raise InputError('belongs to a bound, expect = "above" or "below"', key="times")
        return self


class Issue(Table):
    """A misprint or a questionable point of the publication."""

    where: Text
    """Place in the publication."""
    issue: Text
    """What is wrong or questionable there."""
    verdict: Text
    """What is taken in its place, or what follows."""


def _at_most(most: int) -> Callable[[Any], Any]:
    """Validator of tables under names of the user's own, which are counted before they are read."""

    def check(value: Any) -> Any:
        entries = value if isinstance(value, dict) else {}
        if len(entries) > most:
            raise InputError(_too_many(len(entries), most))
        for name in entries:
            check_name(name, "")
        return value

    return check


def _too_many(count: int, most: int) -> str:
    return f"{count} were given; allowed are at most {most}"


def _of_set(value: Any, info: ValidationInfo) -> Any:
    """Losses of one mesh with those of the set that they name."""
    return expanded(value, info.data.get("gears"))


def _of_no_set(value: Any) -> Any:
    """InputError if the losses of a drive of several meshes name a set."""
    if named_set(value):
        message = "a set belongs to one mesh; name it under the stage, losses = { set = ... }"
        raise InputError(message, key="set")
    return value


Losses = Annotated[dict[str, Loss], BeforeValidator(_at_most(20)), BeforeValidator(_of_set)]
"""Losses of one mesh, by value or by the name of a set."""
DriveLosses = Annotated[dict[str, Loss], BeforeValidator(_at_most(20)), BeforeValidator(_of_no_set)]
Formulas = Annotated[
    Annotated[TorusFormulas, Tag("motion")]
    | Annotated[ZoneFilms, Tag("films")]
    | Annotated[FlankWear, Tag("wear")]
    | Annotated[ConjugateWear, Tag("conjugate wear")]
    | Annotated[PairInMotion, Tag("pair in motion")]
    | Annotated[PairOnPath, Tag("pair on path")],
    Field(
        discriminator=by(
            "form", TorusFormulas, ZoneFilms, FlankWear, ConjugateWear, PairInMotion, PairOnPath
        )
    ),
]
_SOURCE_OF = {
    TorusFormulas: "liu_xiong_2017",
    ZoneFilms: "xu_2021",
    FlankWear: "zhao_2022",
    ConjugateWear: "zhao_2022",
    PairInMotion: "atanasiu_2011",
    PairOnPath: "tian_2024",
}
"""Bibliography entries of the papers whose equations take inputs of their own."""


class WearTable(Table):
    """Wear of the flanks at the operating point, over the life of the drive.

    `cycles` are turns of the driver, of the meshes of a train those of its input. A `profile` that is
    "updated" gives worn flanks back to load sharing, pressure and film; one that is "kept" goes on as with
    new ones. The load on asperities is that of `models.asperity_load`, the "formula", or that of the solved
    "film". The march ends before at a limit of the depth, of the largest pressure over that at the start,
    of the thickness that is left of a tooth at its tip, or of the normal backlash that wear adds, and where
    the pressure reaches the hardness of the softer flank. `severe_by` names what tells that wear is severe.
    `cells` lie along each flank, `phases` are those between two events of the mesh cycle, and `tolerance` is
    the error of a step over the largest depth. Without `sensitivities` those of the life to all inputs are
    told where they take seconds: not of teeth on a ring that share their load by its stiffness.
    """

    law: Annotated[str, BeforeValidator(named(WEAR_LAWS.keys, "wear law"))]
    """Law of the specific wear rate."""
    cycles: Annotated[float, WEAR_TURNS]
    """Turns of the driver over which flanks wear."""
    coefficient: Annotated[tuple[float, float], Pair(WEAR_COEFFICIENT)] | None = None
    """Wear coefficient K of Archard's law, of dry sliding; 1e-5 unless given."""
    engagements: Annotated[tuple[float, float], Pair(PLANETS)] | None = None
    """Mates that wear the flanks in use of each gear alike; of a train the planets on what they mesh with."""
    hardness: Annotated[tuple[float, float], Pair(HARDNESS)] | None = None
    """Hardness H of the flanks; that of the materials unless given."""
    rate: Annotated[tuple[float, float], Pair(WEAR_RATE)] | None = None
    """Specific wear rate k of the flanks, for a law that takes it by value."""
    adsorption_heat: Annotated[float, ADSORPTION_HEAT] | None = None
    """Heat of adsorption E_a of the oil on the flanks; 49 kJ/mol unless given."""
    molecule_diameter: Annotated[float, MOLECULE] | None = None
    """Diameter X of an adsorbed molecule; 0.3 nm unless given."""
    vibration_period: Annotated[float, VIBRATION] | None = None
    """Period t_0 of vibration of an adsorbed molecule; 3e-12 s unless given."""
    profile: Literal["updated", "kept"] = "updated"
    """Whether load sharing, pressure and film follow the worn flanks, or stay as new."""
    load_ratio: Literal["formula", "film"] = "formula"
    """Where the load on asperities is from: models.asperity_load, or solved films."""
    depth_limit: Annotated[float, WEAR_DEPTH] | None = None
    """Depth at which the march ends; 0.2 modules of teeth, at the latest, unless given."""
    pressure_limit: Annotated[float, WEAR_PRESSURE] | None = None
    """Largest pressure over that at the start at which the march ends; none unless given."""
    tip_land_limit: Annotated[float, WEAR_LAND] | None = None
    """Tip thickness that is left where the march ends; none unless given."""
    backlash_limit: Annotated[float, WEAR_DEPTH] | None = None
    """Normal backlash that wear adds until the march ends; none unless given."""
    severe_by: Literal["rate", "pressure"] = "rate"
    """What tells severe wear: half as much again as the least rate, or as the first pressure."""
    cells: Annotated[float, WEAR_CELLS] = 40.0
    """Cells along each flank."""
    phases: Annotated[float, WEAR_PHASES] = 24.0
    """Phases between two events of the mesh cycle."""
    tolerance: Annotated[float, WEAR_ERROR] = 3e-4
    """Error of a step over the largest depth."""
    sensitivities: Annotated[bool, BeforeValidator(_flag)] | None = None
    """Whether to tell what the life depends on; where it takes seconds unless given."""


class WornTable(Table):
    """Flanks that are worn, from a result with wear of the same gears.

    `cycles` of the driver, of a set of its input, are those up to which they are worn; all that the result
    has by default. Of a result of several meshes that of the same gears counts.
    """

    file: Text
    """File wear.nc of a result with wear of the same gears, beside the case file."""
    cycles: Annotated[float, WORN_TURNS] | None = None
    """Turns of the driver up to which flanks are worn; all that the file has unless given."""
    stage: Annotated[float, WORN_STAGE] | None = None
    """Number of the stage of that result, where several of its stages have such gears."""
    _of_driver: float = PrivateAttr(default=1.0)

    @property
    def of_driver(self) -> float:
        """Turns of the driver for one of those that `cycles` counts."""
        return self._of_driver

    def counted(self, of_driver: float) -> "WornTable":
        """The same with `cycles` of the input of a train, for one of which the driver makes so many."""
        copied = self.model_copy()
        copied._of_driver = of_driver
        return copied


_TREATMENT = named(TREATMENTS.keys, "heat treatment")
_MOST_OFFSET = 0.3  # of the span: ISO 6336-1:2006, arrangements a and b
_SHAFT = ("bearing_span", "pinion_offset", "pinion_shaft_diameter")


def _year(value: Any) -> Any:
    """An edition as text, also of a number."""
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else value


UNRATED = "was given; ISO 6336 rates pairs of cylindrical gears, not these; leave it out"


class StrengthTable(Table):
    """What the strength of a pair of cylindrical gears depends on beside its dimensions and its load.

    Load factors are at least 1: `application_factor` K_A, `mesh_load_factor` K_gamma, `dynamic_factor` K_v,
    `face_load_factor` K_Hbeta, `transverse_load_factor` K_Halpha, and those of the root. Without a K_v it
    follows for gears of `accuracy_class` of ISO 1328-1, by method C or by the `dynamic_method` that is named;
    K_Hbeta follows by method C where `bearing_span`, `pinion_offset` and `pinion_shaft_diameter` are given,
    for a pinion between two bearings without modifications of its helix. `sigma_hlim` and `sigma_flim` take
    the place of those of the materials, for plastics at the temperature and life of the case; steels then say
    their `treatment`. Without a `life` the teeth are to endure. `mean_stress_factor` is below 1 for teeth
    that are loaded both ways, 0.7 for the same load. Roughness is Rz.
    """

    edition: Annotated[Literal["2006", "2019"], BeforeValidator(_year)] = "2019"
    """Edition of ISO 6336-2 and ISO 6336-3 by which the pair is rated."""
    application_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Application factor K_A; 1 unless given."""
    mesh_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Mesh load factor K_γ of planets; by IEC 61400-4 for 3 to 7, else 1, or by their pins, unless given."""
    dynamic_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Dynamic factor K_v; by ISO 6336-1, of plastics 1, unless given."""
    dynamic_method: Literal["B", "C"] = "C"
    """Method of ISO 6336-1 by which K_v follows."""
    face_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Face load factor K_Hβ; by method C where the shaft is given, else 1, unless given."""
    bearing_span: Annotated[float, BORE] | None = None
    """Distance l between the bearings of the pinion; unknown unless given."""
    pinion_offset: Annotated[float, OFFSET] | None = None
    """Offset s of the pinion from mid-span, positive towards the torque's end; unknown unless given."""
    pinion_shaft_diameter: Annotated[float, BORE] | None = None
    """Diameter d_sh of the pinion's shaft; unknown unless given."""
    transverse_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Transverse load factor K_Hα; 1 unless given."""
    root_face_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Face load factor of the root K_Fβ; by K_Hβ unless given."""
    root_transverse_load_factor: Annotated[float, LOAD_FACTOR] | None = None
    """Transverse load factor of the root K_Fα; K_Hα unless given."""
    accuracy_class: Annotated[float, ACCURACY] | None = None
    """Class of ISO 1328-1 for K_v; that of gears.deviations, without it 7, unless given."""
    profile_correction: Annotated[float, LOAD_FACTOR] | None = None
    """Factor f_ZCa for the profile modification of helical gears; 1.2, none, unless given."""
    life: Annotated[float, LIFE] | None = None
    """Time under load; the teeth are to endure unless given."""
    sigma_hlim: Annotated[tuple[float, float], Pair(ENDURED)] | None = None
    """Allowable stress number for contact σ_Hlim; that of the materials unless given."""
    sigma_flim: Annotated[tuple[float, float], Pair(ENDURED)] | None = None
    """Nominal stress number for bending σ_Flim; that of the materials unless given."""
    treatment: Annotated[tuple[str, str], BeforeValidator(for_both(_TREATMENT))] | None = None
    """Heat treatment, one name or a list of two; that of the materials unless given."""
    work_hardening: Annotated[tuple[float, float], Pair(HARDENING)] | None = None
    """Work hardening factor Z_W; 1 unless given."""
    mean_stress_factor: Annotated[tuple[float, float], Pair(REVERSED)] | None = None
    """Mean stress factor Y_M of teeth loaded both ways; in trains 0.7 with two mates, else 1."""
    engagements: Annotated[tuple[float, float], Pair(PLANETS)] | None = None
    """Engagements of a tooth in a turn of its gear; of sun and ring one a planet, else 1, unless given."""
    flank_roughness: Annotated[tuple[float, float], Pair(PEAK_TO_VALLEY)] | None = None
    """Mean peak-to-valley roughness Rz of the flanks; 6 Ra unless given."""
    root_roughness: Annotated[tuple[float, float], Pair(PEAK_TO_VALLEY)] | None = None
    """Mean peak-to-valley roughness Rz of the roots; 10 um unless given."""

    @property
    def shaft(self) -> tuple[float, float, float] | None:
        """Span, offset and diameter of the pinion's shaft [m]; None where they are not known."""
        span, offset, diameter = self.bearing_span, self.pinion_offset, self.pinion_shaft_diameter
        return (
            None if span is None or offset is None or diameter is None else (span, offset, diameter)
        )

    @model_validator(mode="after")
    def _by_one_way(self) -> "StrengthTable":
        stated = self.model_fields_set
        if self.dynamic_factor is not None and "dynamic_method" in stated:
            raise InputError(
                "was given beside dynamic_factor, which is K_v itself; give one",
                key="dynamic_method",
            )
        if self.engagements is not None and self.life is None:
            raise InputError(
                "was given without life, whose load cycles it counts", key="engagements"
            )
        if self.edition == "2006" and self.profile_correction is not None:
            raise InputError(
                "was given with edition = 2006, which has no f_ZCa; leave it out, or rate by 2019",
                key="profile_correction",
            )
        return self

    @model_validator(mode="after")
    def _whole_shaft(self) -> "StrengthTable":
        stated = [key for key in _SHAFT if getattr(self, key) is not None]
        missing = [key for key in _SHAFT if getattr(self, key) is None]
        if stated and missing:
            raise InputError(
                f"was given without {' and '.join(missing)}; K_Hβ by method C takes all three",
                key=stated[0],
            )
        if stated and self.face_load_factor is not None:
            raise InputError(
                f"was given beside face_load_factor, which is K_Hβ itself; give it or {', '.join(_SHAFT)}",
                key="bearing_span",
            )
        if self.shaft is not None:
            span, offset, _ = self.shaft
            if abs(offset) > _MOST_OFFSET * span:
                raise InputError(
                    f"{OFFSET.show(offset)} is outside {_MOST_OFFSET:g} of the bearing_span, "
                    f"{BORE.show(span)}, up to which K_Hβ by method C is known for a pinion between "
                    f"bearings; allowed is at most {OFFSET.show(_MOST_OFFSET * span)} to either side",
                    key="pinion_offset",
                )
        return self


Studies = Annotated[dict[str, Study], BeforeValidator(_at_most(200))]
Targets = Annotated[tuple[Target, ...], Field(max_length=2000)]
Issues = Annotated[tuple[Issue, ...], Field(max_length=500)]


class Output(Table):
    """How results are shown; numbers that are computed and kept are SI whatever it says.

    `units` are those of tables, figures and exports by kind of quantity: angle, torque, torsional_stiffness,
    rotational_speed and so on. A unit of small angles, lengths or times (arcmin, um, ms) is for these; the
    kinds `small_angle`, `small_length` and `small_time` give them a unit of any size.
    """

    units: Annotated[dict[str, str], BeforeValidator(unit_choice)] = Field(
        default_factory=dict, examples=[{"angle": "arcmin", "torsional stiffness": "N m/arcmin"}]
    )
    """Unit by kind of quantity; usual ones unless given."""


class CaseFile(Table):
    """A whole case file, one variant of it."""

    title: Text = ""
    """Title of the case."""
    summary: Text = ""
    """What the case is, in a sentence or two."""
    source: Source = ""
    """Key of the publication that the case is from, in the bibliography."""
    gears: Gears
    """Gears of the mesh; their family decides what keys the table has."""
    materials: Materials = Materials()
    """Materials of both gears; steel unless given."""
    lubricant: Oil
    """Oil, or base oil of a grease, by name or by value."""
    roughness: RoughnessTable
    """Roughness of the flanks."""
    operation: Operating
    """Operating point: load, speed, temperature, and what drives."""
    models: Choices = Choices()
    """Laws by which the case is computed, by name."""
    housing: Housing = Housing()
    """How heat leaves the housing, for the temperature of plastic teeth."""
    losses: Losses = Field(default_factory=dict)
    """Losses beside the teeth, by names of one's own or a named set; none unless given."""
    dynamics: Dynamics | None = None
    """Asks for vibration; none unless given."""
    film: FilmTable | None = None
    """Asks for films solved over the mesh cycle; none unless given."""
    wear: WearTable | None = None
    """Asks for wear over the life of the drive; none unless given."""
    worn: WornTable | None = None
    """Flanks worn by an earlier result; as new unless given."""
    strength: StrengthTable | None = None
    """Load factors and limits for the strength by ISO 6336; what is left out is assumed, and told."""
    studies: Studies = Field(default_factory=dict)
    """Further computations with changed inputs, by names of one's own."""
    study: StudyTable | None = None
    """Many designs of the case, for the command `study`; none unless given."""
    optimise: OptimiseTable | None = None
    """Keys to vary until one result is best, for the command `optimise`; none unless given."""
    loss_map: LossMap | None = None
    """Axes of the loss map; up to 1.5 times the operating point unless given."""
    duty: DutyTable | None = None
    """Asks for energy, torques, lives and heat over a duty cycle of the output; none unless given."""
    output: Output | None = None
    """Units in which results are shown; usual ones unless given."""
    formulas: Formulas | None = None
    """Inputs that only the equations of one paper take."""
    targets: Targets = ()
    """Printed numbers that computed ones are compared with."""
    issues: Issues = ()
    """Misprints and questionable points of the publication."""

    @property
    def bodies(self) -> tuple[str, ...]:
        """Bodies that move or are held, one for each coordinate."""
        return self.gears.members

    @model_validator(mode="after")
    def _of_family(self) -> "CaseFile":
        """What is not given stands as is usual for the family; bodies are those that it has."""
        wrong = Complaints()
        wrong.tried(_check_aims, self.targets, self.studies, self.source)
        wrong.tried(_check_load, self, self.gears)
        wrong.tried(_check_losses, self.losses, self.gears.shafts, self.bodies)
        for check in (_check_meant, _check_formulas, _check_driver, _check_quadrants):
            wrong.tried(check, self)
        wrong.demand_none()
        operation, models = self.operation, self.models
        driver = operation.driver if _given(operation, "driver") else self.gears.drivers[0]
        usual: dict[str, Any] = {
            "friction": (FrictionChoice(name=self.gears.friction),),
            "load_sharing": self.gears.load_sharing,
            "film_thickness": self.gears.film_thickness,
        }
        left = {name: value for name, value in usual.items() if not _given(models, name)}
        return self.model_copy(
            update={
                "operation": operation.model_copy(update={"driver": driver}),
                "models": models.model_copy(update=left),
                "dynamics": _damped(self.dynamics, self.gears.damping_ratio),
            }
        )


def _damped(dynamics: Dynamics | None, usual: float) -> Dynamics | None:
    """The table with the damping ratio that is usual for the gears where it gives none."""
    if dynamics is None or _given(dynamics, "damping_ratio"):
        return dynamics
    return dynamics.model_copy(update={"damping_ratio": usual})


PLANET_GEAR = Quantity("dimensionless", 1, MOST_STAGES, whole=True)


class StageTable(Table):
    """One mesh or planetary set of a drive; what it leaves out is as the tables of the same name say for all.

    Its losses are those between two of its own bodies; those of shafts against the housing are the
    drive's.
    """

    gears: GearsOfStage
    """Gears of the stage, a mesh or a planetary set; their family decides what keys the table has."""
    driver: Text = ""
    """Member that the stage before drives; the first one that is not fixed unless given."""
    bodies: Annotated[tuple[BodyName, ...], Field(max_length=3)] = ()
    """Bodies of a [train] that its members are, in their order; a stage of a chain has none."""
    planet_gear: Annotated[float, PLANET_GEAR] = 1.0
    """Which gear of the planets meshes; 2 for a second one, where it has as many teeth as the first."""
    materials: DriveMaterials = DriveMaterials()
    """Materials of its gears; those of the drive unless given."""
    lubricant: Oil | None = None
    """Oil of the stage; that of the drive unless given."""
    roughness: RoughnessTable | None = None
    """Roughness of its flanks; that of the drive unless given."""
    models: Choices = Choices()
    """Laws of the stage, key by key; those of the drive unless given."""
    strength: StrengthTable | None = None
    """Load factors and limits of the stage, key by key; those of the drive unless given."""
    losses: Losses = Field(default_factory=dict)
    """Losses between two of its own bodies; none unless given."""
    film: FilmTable | None = None
    """Asks for films solved over the mesh cycle of the stage, of a set of each mesh; none unless given."""
    wear: WearTable | None = None
    """Asks for wear of the stage, of a set of each mesh, over turns of what drives it; none unless given."""
    worn: WornTable | None = None
    """Flanks of the stage, of a set of each mesh, worn by an earlier result; as new unless given."""
    dynamics: Dynamics | None = None
    """Asks for vibration of the stage by itself, speeds being those of its own driver; none unless given."""
    place: Annotated[float, PLACE] = 0.0
    """Place of the middle of its face along the shafts."""
    turn: Annotated[float, TURN] = 0.0
    """Angle of its line of centres about the shafts, counter-clockwise."""


def _listed(value: Any) -> Any:
    """One text as a list of it."""
    return [value] if isinstance(value, str) else value


class _Numbered:
    """Annotation of tables by number, 1, 2, ..., in a table or a list."""


def _stages(value: Any) -> Any:
    """Stages by number, from a list or a table of them."""
    stages = value if isinstance(value, dict) else {}
    if not stages:
        complaint = "no stage was given" if value in ([], {}) else f"{shown(value)} was given"
        raise InputError(f"{complaint}; write a table [[stages]] for each mesh, input first")
    numbers = {str(number) for number in range(1, len(stages) + 1)}
    if strange := [key for key in stages if key not in numbers]:
        raise _no_stage(strange[0], stages)
    if len(stages) > MOST_STAGES:
        raise InputError(_too_many(len(stages), MOST_STAGES))
    return dict(sorted(stages.items()))


def _no_stage(key: str, given: Mapping[str, Any]) -> InputError:
    """What is wrong with the number of a stage."""
    highest = next(number for number in count() if str(number + 1) not in given)
    allowed = f"stages.1 to stages.{highest}" if highest > 1 else "stages.1"
    before = f"{highest + 1} before " if key.isdecimal() and not key.startswith("0") else ""
    listed = "" if key.isdecimal() else ", or a table [[stages]] for each mesh"
    return InputError(f"there is no stage {before}{shown(key)}; use {allowed}{listed}")


class TrainTable(Table):
    """Which bodies of a train of meshes are turned, loaded and held, and where its planets are.

    Every stage then names the `bodies` that it joins. Those that are on the planets have as many copies as
    there are planets, at equal angles on the carrier unless `planet_angles` has others.
    """

    input: Text
    """Body that drives."""
    output: Text
    """Body that takes the load."""
    held: Annotated[
        tuple[Text, ...],
        BeforeValidator(_listed, json_schema_input_type=str | tuple[Text, ...]),
        Field(max_length=4),
    ] = ()
    """Bodies that stand still, one or a list."""
    carrier: BodyName = "carrier"
    """Body that carries the axes of the planets."""
    planet: Text = "planet"
    """Body that the planets are."""
    planets: Annotated[float, PLANETS] = 3.0
    """Number of planets."""
    planet_angles: PlanetAngles = ()
    """Angle at which each planet stands on the carrier; equal ones all around unless given."""
    floating: Text = ""
    """Sun, ring or carrier that is free to move sideways, so that planets share alike; none unless given."""
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
    """Stiffness of a pin and its bearing along the circle; rigid unless given."""

    @property
    def by_tolerance(self) -> bool:
        """True where sets are drawn by tolerance."""
        return any(
            (self.pin_tolerance, self.thickness_tolerance, self.planet_runout, self.central_runout)
        )


class DriveCase(Table):
    """A case file of a drive of several meshes on common shafts.

    Torque is that at the output, speed that of the input. Shaft 1 is the input, shaft 2 carries the last
    gear of the first stage and the first one of the second, and so on.
    """

    title: Text = ""
    """Title of the case."""
    summary: Text = ""
    """What the case is, in a sentence or two."""
    source: Source = ""
    """Key of the publication that the case is from, in the bibliography."""
    gears: PlanetaryGears | None = None
    """Gears of a planetary set, in the place of the stages and the train that follow from them."""
    stages: Annotated[dict[str, StageTable], BeforeValidator(_stages), _Numbered()]
    """Meshes and planetary sets from the input to the output, each a table [[stages]]; at most 5."""
    film: FilmTable | None = None
    """Asks for films solved over the cycle of each mesh of a planetary set; stages have their own."""
    wear: WearTable | None = None
    """Asks for wear of each mesh of a planetary set; stages have their own."""
    worn: WornTable | None = None
    """Flanks of each mesh of a planetary set worn by an earlier result; stages have their own."""
    train: TrainTable | None = None
    """Bodies of a train whose meshes turn together; stages follow each other unless given."""
    materials: DriveMaterials = DriveMaterials()
    """Materials of both gears; steel unless given."""
    lubricant: Oil
    """Oil, or base oil of a grease, by name or by value."""
    roughness: RoughnessTable
    """Roughness of the flanks."""
    operation: Operating
    """Operating point: load of the output, speed of the input, temperature."""
    models: Choices = Choices()
    """Laws by which the case is computed, by name."""
    housing: Housing = Housing()
    """How heat leaves the housing, for the temperature of plastic teeth."""
    losses: DriveLosses = Field(default_factory=dict)
    """Losses between shafts, or of shafts against the housing; none unless given."""
    strength: StrengthTable | None = None
    """Load factors and limits for the strength by ISO 6336; what is left out is assumed, and told."""
    studies: Studies = Field(default_factory=dict)
    """Further computations with changed inputs, by names of one's own."""
    study: StudyTable | None = None
    """Many designs of the case, for the command `study`; none unless given."""
    optimise: OptimiseTable | None = None
    """Keys to vary until one result is best, for the command `optimise`; none unless given."""
    loss_map: LossMap | None = None
    """Axes of the loss map; up to 1.5 times the operating point unless given."""
    duty: DutyTable | None = None
    """Asks for energy, torques, lives and heat over a duty cycle of the output; none unless given."""
    output: Output | None = None
    """Units in which results are shown; usual ones unless given."""
    targets: Targets = ()
    """Printed numbers that computed ones are compared with."""
    issues: Issues = ()
    """Misprints and questionable points of the publication."""

    @property
    def bodies(self) -> tuple[str, ...]:
        """Shafts from the input to the output, of which the last one may travel; bodies of a train."""
        if self.train is not None:
            named = [body for stage in self.stages.values() for body in stage.bodies]
            carrier = [self.train.carrier] * (self.train.planet in named)
            return tuple(dict.fromkeys((*named, *carrier)))
        return tuple(f"shaft {number}" for number in range(1, len(self.stages) + 2))

    @property
    def last(self) -> GearsTable | PlanetaryGears:
        """Gears of the stage that carries the load."""
        return self.stages[str(len(self.stages))].gears

    @model_validator(mode="after")
    def _whole(self) -> "DriveCase":
        wrong = Complaints()
        wrong.tried(_check_passing, self.stages)
        wrong.tried(_check_sets, self.stages)
        wrong.tried(_check_train, self)
        wrong.tried(_check_materials, self)
        if not wrong:  # what the drive carries, and what turns, follows from its stages
            travels = self.last.load == "force"
            turning = self.bodies[: len(self.bodies) - travels]
            wrong.tried(_check_load, self, self.last)
            wrong.tried(_check_quadrants, self)
            sets = [
                n for n, stage in self.stages.items() if isinstance(stage.gears, PlanetaryGears)
            ]
            wrong.tried(_check_losses, self.losses, turning, self.bodies, sets)
        if self.operation.driver:
            message = (
                "that is the input of the train, a key beside its held and output"
                if self.train is not None
                else "the first stage drives; the member that drives a stage is its own key, "
                'driver = "gear 2" under [[stages]]'
            )
            wrong.add(InputError(message, key="operation.driver"))
        tables = {f"stages.{number}.models": stage.models for number, stage in self.stages.items()}
        for key, models in {"models": self.models, **tables}.items():
            if models.averaging != "base_pitch":
                message = "the path of one pair does not stand for several meshes; leave it out"
                wrong.add(InputError(message, key=f"{key}.averaging"))
        wrong.tried(_check_aims, self.targets, self.studies, self.source)
        wrong.demand_none()
        return self


def _check_train(case: DriveCase) -> None:
    """InputError unless stages name their bodies just where there is a train, and it its own among them."""
    train, wrong = case.train, Complaints()
    for number, stage in case.stages.items():
        key, members = f"stages.{number}.bodies", len(stage.gears.members)
        if train is None and stage.bodies:
            message = "was given without a table [train], which says who is turned, loaded and held"
            wrong.add(InputError(message, key=key))
        if "planet_gear" in stage.model_fields_set and (
            train is None or train.planet not in stage.bodies
        ):
            message = "was given for a mesh without planets; leave it out"
            wrong.add(InputError(message, key=f"stages.{number}.planet_gear"))
        if train is not None and not isinstance(stage.gears, CylindricalGears):
            message = (
                "meshes of a train are pairs of cylindrical gears; gears of another family before or behind "
                "them are not computed together with them"
            )
            wrong.add(InputError(message, key=f"stages.{number}.gears.family"))
        elif train is not None and len(stage.bodies) != members:
            complaint = f"{shown([*stage.bodies])} was given" if stage.bodies else "is missing"
            message = (
                f"{complaint}; name the {members} bodies that {', '.join(stage.gears.members)} are"
            )
            wrong.add(InputError(message, key=key))
    wrong.demand_none()
    if train is None:
        return
    ends = {"input": [train.input], "output": [train.output], "held": train.held}
    for key, bodies in ends.items():
        for body in bodies:
            if body not in case.bodies:
                message = f"{shown(body)} is no body of this train{nearest(body, case.bodies)}"
                wrong.add(InputError(message, key=f"train.{key}"))
    if train.planet not in case.bodies:
        message = (
            f"no stage has a body {shown(train.planet)}{nearest(train.planet, case.bodies)}; stages that "
            "follow each other have no table [train]"
        )
        wrong.add(InputError(message, key="train.planet"))
    for key, bodies in ends.items():
        if train.planet in bodies:
            message = "planets are neither turned nor loaded nor held; their carrier may be"
            wrong.add(InputError(message, key=f"train.{key}"))
    if "housing" in (train.carrier, *case.bodies):
        message = "the housing is no body of a train; one that stands still is held"
        wrong.add(
            InputError(message, key="train.carrier" if train.carrier == "housing" else "stages")
        )
    for number, stage in case.stages.items():
        for key in ("driver", "place", "turn"):
            if key in stage.model_fields_set:
                message = "follows from the train; leave it out"
                wrong.add(InputError(message, key=f"stages.{number}.{key}"))
        if stage.dynamics is not None:
            wrong.add(InputError(_NO_VIBRATION, key=f"stages.{number}.dynamics"))
        for name in stage.losses:
            message = "losses of a train stand between its bodies; give this one under [losses]"
            wrong.add(InputError(message, key=f"stages.{number}.losses.{name}"))
        if case.losses and stage.lubricant is not None:
            message = (
                "was given beside [losses]; a train that has them has one oil, that of the case"
            )
            wrong.add(InputError(message, key=f"stages.{number}.lubricant"))
    _check_pins(train, [meshing.bodies for meshing in case.stages.values()], wrong)
    _check_bearings(case.losses, train, wrong)
    wrong.demand_none()


def _check_pins(train: TrainTable, meshes: Sequence[tuple[str, ...]], wrong: Complaints) -> None:
    """Complain of what is said of pins of other planets, or floats that are not around them."""
    around = [body for bodies in meshes if train.planet in bodies for body in bodies]
    central = [body for body in dict.fromkeys((*around, train.carrier)) if body != train.planet]
    if train.floating and train.floating not in central:
        message = f"{shown(train.floating)} does not float; {', '.join(central)} may"
        wrong.add(InputError(message, key="train.floating"))
    count = round(train.planets)
    for key, what in (("pin_errors", "error"), ("planet_angles", "angle")):
        places = len(getattr(train, key))
        if places not in (0, count):
            message = f"{places} were given for {count} planets; give the {what} of each"
            wrong.add(InputError(message, key=f"train.{key}"))
    if not (train.pin_errors or train.by_tolerance):
        for key in ("floating", "pin_stiffness"):
            if getattr(train, key):
                message = (
                    "counts where pins are out of place; give pin_errors, pin_tolerance or the like, or "
                    "leave it out"
                )
                wrong.add(InputError(message, key=f"train.{key}"))


def _check_bearings(losses: Mapping[str, Loss], train: TrainTable, wrong: Complaints) -> None:
    """Complaints on bearings of a train whose load would not be known."""
    seen: dict[frozenset[str], str] = {}
    for name, loss in losses.items():
        for key in ("position", "locating"):
            if key in loss.model_fields_set:
                message = "was given; a bearing of a train stands for all bearings of its body"
                wrong.add(InputError(message, key=f"losses.{name}.{key}"))
        if loss.bearing == "none":
            continue
        bodies = frozenset(loss.between)
        if train.planet in bodies and bodies != {train.planet, train.carrier}:
            message = (
                f'bearings of planets sit in their carrier: ["{train.planet}", "{train.carrier}"]'
            )
            wrong.add(InputError(message, key=f"losses.{name}.between"))
        before = seen.setdefault(bodies, name)
        if before != name:
            message = (
                f"{before} is a bearing between the same two; one of a train stands for all bearings of its "
                "body: add their factors f0, and leave one out"
            )
            wrong.add(InputError(message, key=f"losses.{name}.between"))


def _check_passing(stages: Mapping[str, StageTable]) -> None:
    """InputError if a stage passes no torque on, or has losses that are those of a shaft."""
    for number, stage in stages.items():
        message = None
        if not stage.gears.transmits:
            message = "a test rig transmits nothing and is no stage of a drive"
        elif stage.gears.load != "torque" and number != str(len(stages)):
            message = f"{stage.gears.carries} and turns no shaft; such gears are the last stage of a drive"
        if message is not None:
            raise InputError(message, key=f"stages.{number}.gears.family")
        for name, loss in stage.losses.items():
            if "housing" in loss.between:
                raise InputError(
                    "a shaft in the housing may carry two meshes; give this loss under [losses], "
                    'between = ["shaft 2", "housing"], say',
                    key=f"stages.{number}.losses.{name}.between",
                )


_NO_VIBRATION = (
    "vibration is computed of one mesh, not of sets; leave this out: the stiffness k of the output, by "
    'load_sharing = "from_stiffness" in [models], and a load of inertia J on it have a natural '
    "frequency of sqrt(k/J)/2pi while the motor holds its speed"
)
_OF_NO_SET = {
    "driver": "is that of a mesh; what drives a planetary set is input, a key of its gears",
    **dict.fromkeys(
        ("place", "turn"),
        "counts for bearings that teeth of one mesh press; a planetary set stands around the axis of its "
        "shafts: leave it out",
    ),
    "dynamics": _NO_VIBRATION,
}


def _check_sets(stages: Mapping[str, StageTable]) -> None:
    """InputError for what a stage that is a planetary set does not take."""
    wrong = Complaints()
    for number, stage in stages.items():
        if isinstance(stage.gears, PlanetaryGears):
            for key, message in _OF_NO_SET.items():
                if key in stage.model_fields_set:
                    wrong.add(InputError(message, key=f"stages.{number}.{key}"))
    wrong.demand_none()


def _check_materials(case: DriveCase) -> None:
    """InputError for materials of gears of planetary sets where there is no set."""
    sets = [
        number for number, stage in case.stages.items() if isinstance(stage.gears, PlanetaryGears)
    ]
    wrong = Complaints()
    tables = {
        f"stages.{number}.": stage.materials
        for number, stage in case.stages.items()
        if number not in sets
    }
    if not sets and case.gears is None:
        tables[""] = case.materials
    for place, materials in tables.items():
        for key in sorted(materials.of_set):
            message = "is the material of a gear of a planetary set, which this is not; use gear_1 and gear_2"
            wrong.add(InputError(message, key=f"{place}materials.{key}"))
    wrong.demand_none()


def bearings_of(losses: Mapping[str, Loss], body: str) -> dict[str, Loss]:
    """Bearings between a body and the housing, by name of their loss."""
    return {
        name: loss
        for name, loss in losses.items()
        if loss.bearing != "none" and {*loss.between} == {body, "housing"}
    }


def _check_aims(targets: Sequence[Target], studies: Mapping[str, Study], source: str) -> None:
    """InputError if a target reads a study that does not exist, or no place of its axis."""
    wrong = Complaints()
    for position, target in enumerate(targets):
        if target.kind == "excluded" or target.part:
            continue
        if target.study not in studies:
            message = f"there is no study {shown(target.study)}{nearest(target.study, studies)}"
            wrong.add(InputError(message, key=f"targets.{position}.study"))
            continue
        try:
            _check_places(target, studies[target.study].sweep, source)
        except InputError as error:
            wrong.add(InputError(error.message, key=f"targets.{position}.at"))
    wrong.demand_none()


def _check_places(target: Target, sweep: Sweep | None, source: str) -> None:
    """InputError if places are no values of the key that is swept."""
    if not target.at:
        return
    if sweep is None and (kind := _along(target.variable, source)):
        for place in target.at:
            units.parse(place, kind)
        return
    try:
        quantity = quantity_at(sweep.key) if sweep is not None else None
    except InputError:
        return  # told with the study
    if quantity is None:
        raise InputError(f"{shown(target.study)} has no axis of numbers to be read at")
    for place in target.at:
        quantity.read(place)


def _along(variable: str, source: str) -> str:
    """Kind of the places that a course of the publication runs over; empty for what is none."""
    publication = publication_of(source)
    courses = publication.courses if publication else {}
    places = places_of(courses.get(variable, ""))
    return VARIABLES[places].kind if places else ""


def _given(table: Table, key: str) -> bool:
    return key in table.model_fields_set


def _check_load(case: CaseFile | DriveCase, gears: GearsTable | PlanetaryGears) -> None:
    """InputError unless the load is given that the driven member takes, and no table asks for the other."""
    point, wanted = case.operation, gears.load
    unwanted = "force" if wanted == "torque" else "torque"
    loads = {
        f"operation.{unwanted}": getattr(point, unwanted),
        f"dynamics.{unwanted}s": getattr(getattr(case, "dynamics", None), f"{unwanted}s", ())
        or None,
        f"loss_map.{unwanted}": getattr(case.loss_map, unwanted, None),
        f"loss_map.{unwanted}_count": getattr(case.loss_map, f"{unwanted}_count", None),
    }
    for key in (key for key, load in loads.items() if load is not None):
        name = key.rpartition(".")[2]
        message = f"{gears.carries}; give {name.replace(unwanted, wanted)} in place of {name}"
        raise InputError(message, key=key)
    if getattr(point, wanted) is None:
        missing = f"is missing{_needed(('operation', wanted), CaseFile)}"
        raise InputError(missing, key=f"operation.{wanted}")
    if not gears.transmits and case.loss_map is not None:
        raise InputError(
            "a loss map runs over the torque of an output, which a test rig does not have; leave this "
            "table out",
            key="loss_map",
        )


def _check_quadrants(case: CaseFile | DriveCase) -> None:
    """InputError unless a duty cycle has its map, and a map of four quadrants speeds between its ends."""
    loss_map = case.loss_map
    if case.duty is not None and (loss_map is None or loss_map.quadrants != 4):
        message = "asks for the loss map of the output; give [loss_map] with quadrants = 4 too"
        raise InputError(message, key="duty")
    if loss_map is None or loss_map.quadrants != 4:
        return
    largest = 1.5 * case.operation.speed if loss_map.speed is None else loss_map.speed
    if largest == 0.0:
        message = "0 was given; a map of four quadrants asks for a speed above standstill"
        raise InputError(message, key="loss_map.speed")
    if loss_map.lowest_speed is not None and loss_map.lowest_speed >= largest:
        raise InputError(
            f"{SPEED.show(loss_map.lowest_speed)} was given; allowed is less than the largest speed of the "
            f"map, {SPEED.show(largest)}",
            key="loss_map.lowest_speed",
        )


def _check_formulas(case: CaseFile) -> None:
    """InputError if inputs of formulas are given to a case whose source has none."""
    if case.formulas is not None and case.source != (source := _SOURCE_OF[type(case.formulas)]):
        raise InputError(
            "these are inputs of the equations of one paper; they belong to a case with its source, "
            f'source = "{source}"',
            key="formulas",
        )


def _check_meant(case: CaseFile) -> None:
    """InputError if a model is chosen that means nothing for the gears."""
    for key, why in case.gears.meaningless.items():
        usual = Choices.model_fields[key].default
        if getattr(case.models, key) != usual:
            allowed = f"{usual:g}" if isinstance(usual, float) else shown(usual)
            raise InputError(f"{why}; leave it at {allowed}", key=f"models.{key}")


def _check_driver(case: CaseFile) -> None:
    """InputError if the member that is to drive is fixed, or none of these gears."""
    driver, gears = case.operation.driver, case.gears
    if _given(case.operation, "driver") and driver not in gears.drivers:
        fixed = (
            "is fixed and cannot drive" if driver == getattr(gears, "fixed", "") else "cannot drive"
        )
        why = fixed if driver in gears.members else "is not in this drive"
        raise InputError(
            f"{shown(driver)} {why}; use {' or '.join(gears.drivers)}",
            key="operation.driver",
        )


def _check_losses(
    losses: Mapping[str, Loss],
    turning: Sequence[str],
    bodies: Sequence[str],
    sets: Sequence[str] = (),
) -> None:
    """InputError if losses arise between bodies that do not turn, or bearings have no span."""
    wrong = Complaints()
    for name, loss in losses.items():
        wrong.under(f"losses.{name}").tried(_check_bodies, loss, turning, bodies, sets)
    for body in turning:
        wrong.tried(_check_span, body, bearings_of(losses, body))
    wrong.demand_none()


def _check_bodies(
    loss: Loss, turning: Sequence[str], bodies: Sequence[str], sets: Sequence[str]
) -> None:
    """InputError if a loss arises between bodies that the drive does not have, or that travel."""
    allowed = (*turning, "housing")
    inner, outer = loss.between
    strange = next((body for body in loss.between if body not in allowed), None)
    message = (
        f"{shown(strange)} travels, and losses are torques between bodies that turn; name two of "
        f"{', '.join(allowed)}"
        if strange in bodies
        else f"{shown(strange)} is no body of this drive{nearest(strange, allowed)}"
        + _within_set(strange, sets)
        if strange is not None
        else f"{shown(inner)} was given twice; name two bodies of {', '.join(dict.fromkeys(allowed))}"
    )
    if strange is not None or inner == outer:
        raise InputError(message, key="between")


def _within_set(body: str, sets: Sequence[str]) -> str:
    """Where losses at a body of planetary sets stand that are stages of these numbers, as a clause."""
    tables = [f"stages.{number}.losses" for number in sets if body in ("planet", *BODIES)]
    return f"; losses within a set stand in its stage, {' or '.join(tables)}" if tables else ""


def _check_span(body: str, bearings: Mapping[str, Loss]) -> None:
    """InputError if the loads on the bearings of a body do not follow from their places."""
    placed = [name for name, bearing in bearings.items() if bearing.position is not None]
    for name, bearing in bearings.items():
        wrong = _out_of_place(
            body, bearing, [mate for mate in bearings.values() if mate is not bearing]
        )
        if wrong is not None:
            raise InputError(wrong[1], key=f"losses.{name}.{wrong[0]}")
        if placed and bearing.position is None:
            message = (
                f"is missing; {placed[0]} has one, and the load of two bearings on {body} follows"
            )
            raise InputError(f"{message} from the places of both", key=f"losses.{name}.position")


def _out_of_place(body: str, one: Loss, others: Sequence[Loss]) -> tuple[str, str] | None:
    """Key and sentence on a bearing whose load does not follow from its place and those of the others."""
    if len(others) > 1:
        count = f"{len(others) + 1} bearings hold {body}"
        return "between", f"{count}; the loads of more than two do not follow from their places"
    for key in ("position", "locating"):
        if not others and getattr(one, key) is not None:
            message = f"was given for the only bearing of {body}, which takes all load"
            return key, f"{message}; give the second bearing too, or leave it out"
    if others and one.position is None and others[0].position is None:
        return "position", (
            f"is missing; the load of two bearings on {body} follows from the places of both: give "
            "position to each, or one bearing alone that stands for both"
        )
    if others and one.position == others[0].position:
        return "position", (
            f"{PLACE.show(one.position or 0.0)} is where the other bearing of {body} sits too; two "
            "bearings need a span between them"
        )
    if others and one.locating is not None and one.locating == others[0].locating:
        return (
            "locating",
            f"is {str(one.locating).lower()} for both bearings of {body}; one is locating",
        )
    return None


def validate(document: Document) -> CaseFile | DriveCase:
    """Case out of a document.

    Raises:
        InputError: what is wrong, with file, key, value and what is allowed; a
            `CollectedInputError` of several things.
    """
    document = with_meshes(document)
    if STAGES not in document.tree:
        return validated(CaseFile, document)
    of_set = is_planetary(document.tree)
    for key, why in (_OF_SETS if of_set else _OF_ONE_MESH).items():
        if key in document.tree:
            table = document.tree[key]
            why = why if isinstance(table, Mapping) else f"{shown(table)} {why}"
            if key == "gears" and isinstance(table, Mapping) and table:
                why += f": write stages.1.gears.{next(iter(table))} for those of the first one"
            raise InputError(why, file=document.name, key=key)
    return validated(DriveCase, document)


_OF_SETS = {
    "dynamics": _NO_VIBRATION,
}
_OF_EACH_MESH = ("film", "wear", "worn")
"""Tables of a planetary set that each of its meshes has."""


def is_planetary(tree: Mapping[str, Any]) -> bool:
    """True if the gears of a case are a planetary set."""
    gears = tree.get("gears")
    return isinstance(gears, Mapping) and gears.get("family") == PLANETARY


def form_of(tree: Mapping[str, Any]) -> "type[CaseFile] | type[DriveCase]":
    """The tables that a case has, of one mesh or of several."""
    return DriveCase if STAGES in tree or is_planetary(tree) else CaseFile


_OF_ONE_MESH = {
    "gears": "was given with [[stages]], each of which has gears of its own",
    "dynamics": "vibration is that of a mesh; give a stage the table, [stages.dynamics] under its [[stages]]",
    "film": "films are those of a mesh; give a stage the table, film = { ... } under its [[stages]]",
    "wear": "wear is that of a mesh; give a stage the table, wear = { ... } under its [[stages]]",
    "worn": "worn flanks are those of a mesh; give a stage the table, worn = { ... } under its [[stages]]",
}


def planetary_of(document: Document) -> PlanetaryGears:
    """Table [gears] of a planetary set out of a document; InputError as from `validate`."""
    gears = document.tree["gears"]
    try:
        return PlanetaryGears.model_validate(gears)
    except ValidationError as error:
        wrong = Complaints(document.name)
        wrong.under("gears").add(_complaint(error, Document(document.name, gears), PlanetaryGears))
        raise wrong.error from None


class _Followed(dict[str, Any]):
    """A table that follows from another one."""


def with_meshes(document: Document) -> Document:
    """The same with the stages and the train for which a planetary set stands; any other as it is.

    Raises:
        InputError: what is wrong with the set, or stages given beside it.
    """
    tree = document.tree
    if not is_planetary(tree) or isinstance(tree.get("train"), _Followed):
        return document
    for key in (STAGES, "train"):
        if key in tree:
            raise InputError(
                'was given with gears of the family "planetary", which have their own; leave one of them out',
                file=document.name,
                key=key,
            )
    gears = planetary_of(document)
    _demand_one_for_all(document)
    of_each = {key: tree[key] for key in _OF_EACH_MESH if key in tree}
    meshes = _with_materials(gears.meshes(), document)
    stages = {str(number): {**mesh, **of_each} for number, mesh in enumerate(meshes, 1)}
    return replace(document, tree={**tree, STAGES: stages, "train": _Followed(gears.train())})


_OF_MEMBERS = {"film": ("heights",), "wear": ("coefficient", "engagements", "hardness", "rate")}
"""Keys of those tables with a value for each of the two gears of a mesh."""


def _demand_one_for_all(document: Document) -> None:
    """InputError for values of two gears, of which a planetary set has three or more kinds."""
    for table, keys in _OF_MEMBERS.items():
        stated = document.tree.get(table)
        held = stated if isinstance(stated, Mapping) else {}
        for key in keys:
            value = held.get(key)
            unlike = isinstance(value, list) and any(element != value[0] for element in value)
            if unlike or isinstance(value, Mapping):
                raise InputError(
                    "is one value for sun, planets and rings of a planetary set; for different ones write "
                    "its meshes as [[stages]]",
                    file=document.name,
                    key=f"{table}.{key}",
                )


def _is_sound(materials: Mapping[str, Any]) -> bool:
    """True unless the validation of the case will refuse a table of materials."""
    try:
        DriveMaterials.model_validate(materials)
    except ValidationError:
        return False
    return True


def _with_materials(meshes: list[dict[str, Any]], document: Document) -> list[dict[str, Any]]:
    """Meshes of a set with the materials that its gears have; as they are where none has its own.

    Raises:
        InputError: gears that the set does not have, materials of gears 1 and 2 beside those of its own.
    """
    materials = document.tree.get("materials", {})
    of_gears = of_set(materials)
    if not of_gears or not _is_sound(materials):
        return meshes
    bodies = {body.replace(" ", "_") for mesh in meshes for body in mesh["bodies"]}
    for key in materials:
        if key in of_gears - bodies or key in Materials.model_fields:
            every = ", ".join(gear for gear in OF_SET if gear in bodies)
            message = f"the gears of this set are {every}; leave it out"
            raise InputError(message, file=document.name, key=f"materials.{key}")
    return [
        {
            **mesh,
            "materials": {
                f"gear_{number}": materials.get(body.replace(" ", "_"), "steel")
                for number, body in enumerate(mesh["bodies"], 1)
            },
        }
        for mesh in meshes
    ]


Whole = TypeVar("Whole", CaseFile, DriveCase)


def validated(model: type[Whole], document: Document) -> Whole:
    """Case of one mesh or of several out of a document; InputError as from `validate`."""
    try:
        return model.model_validate(in_form(document))
    except ValidationError as error:
        raise _complaint(error, document, model) from None


def in_form(document: Document) -> dict[str, Any]:
    """Tables as they are meant where a setting or a study changes the form of one.

    The values of the former form do not belong to the new one: those that it does not have are left out.
    """
    tree = document.tree
    for key, mark in document.provenance.items():
        *above, decided = key.split(".")
        if decided in DECIDING and mark.status == "set":
            tree = _without_former(tree, above, document)
    return tree


def _without_former(tree: dict[str, Any], above: list[str], document: Document) -> dict[str, Any]:
    """Copy in which one table has lost the keys that its form does not have, unless they were set too."""
    model: type[BaseModel] = form_of(tree)
    copied = table = dict(tree)
    for part in above:
        if part.isdecimal() and isinstance(table.get(part), dict):
            table[part] = table = dict(table[part])
            continue
        info, inner = model.model_fields.get(part), table.get(part)
        meant = forms(info.annotation, inner) if info is not None else []
        if not meant or not isinstance(inner, dict):
            return tree  # what is wrong there is told by the schema
        model, table[part] = meant[0], dict(inner)
        table = table[part]
    for key in [*table]:
        mark = document.provenance.get(".".join((*above, key)))
        if key not in model.model_fields and (mark is None or mark.status != "set"):
            del table[key]
    return copied


def quantity_at(key: str, tree: Any = None) -> Quantity | None:
    """Kind and range of the value at a dotted key, None where it is no quantity.

    Args:
        key: in a case file; a last part 1 or 2 is one of two values.
        tree: plain values of the case; without them every family has its keys.

    Raises:
        InputError: there is no such key.
    """
    if not isinstance(tree, Mapping):
        return _quantity_anywhere(key)
    _check_stage(key, tree.get(STAGES))
    return _quantity(key, tree, [form_of(tree)])


@cache
def _quantity_anywhere(key: str) -> Quantity | None:
    return _quantity(key, None, [CaseFile, DriveCase])


def _quantity(key: str, tree: Any, models: list[type[BaseModel]]) -> Quantity | None:
    parts = [part for part in key.split(".") if not part.isdigit()]
    named, root, document = False, models[0], tree
    for position, part in enumerate(parts):
        if named:  # a name of the user's own
            named = False
            continue
        fields = [model.model_fields for model in models]
        holding = [allowed[part] for allowed in fields if part in allowed]
        if not holding and FrictionChoice in models:
            return COEFFICIENT  # a law's own parameter
        if not holding:
            keys = dict.fromkeys(name for allowed in fields for name in allowed)
            from pitchpoint.cases.wishes import answer

            advice = answer(parts[: position + 1], None, {}, keys) or _meant(
                parts[: position + 1], keys, root, document
            )
            raise InputError(f"there is no such key{advice}", key=key)
        if position == len(parts) - 1:
            return quantity_of(holding[0])
        tree = tree.get(part, {}) if isinstance(tree, Mapping) else None
        if part == STAGES:
            tree = None
        models = [model for info in holding for model in forms(info.annotation, tree)]
        named = _named_tables(holding[0])
        if not models:
            raise InputError(f"{shown(part)} is a value, not a table", key=key)
    return None


def usual_at(key: str, tree: Mapping[str, Any]) -> Any:
    """Default of the value at a dotted key; None where there is none, or no such key.

    Args:
        key: in a case file.
        tree: values of the case, which decide what form a table has.
    """
    models: list[type[BaseModel]] = [form_of(tree)]
    info: FieldInfo | None = None
    node: Any = tree
    for part in key.split("."):
        node = node.get(part) if isinstance(node, Mapping) else None
        if part.isdigit():
            continue
        info = next(
            (table.model_fields[part] for table in models if part in table.model_fields), None
        )
        models = forms(info.annotation, node) if info is not None else []
    return None if info is None or info.is_required() else info.default


def _check_stage(key: str, stages: Any) -> None:
    """InputError if a key of a stage does not begin with the number of one that the case has."""
    table, *inside = key.split(".")
    if table == STAGES and inside and isinstance(stages, Mapping) and inside[0] not in stages:
        raise _no_stage(inside[0], stages).at(key=key)


def keys(table: type[BaseModel] = CaseFile) -> Iterator[str]:
    """Dotted keys that take one value or a list, those of every family and form of a table."""
    for name, info in table.model_fields.items():
        inner, kind = alternatives(info.annotation), get_origin(info.annotation)
        options = get_args(info.annotation) or (info.annotation,)
        if kind is not dict and len(options) > len(inner):
            yield name
        if kind not in (dict, tuple):
            below = (f"{name}.{key}" for inside in inner.values() for key in keys(inside))
            yield from dict.fromkeys(below)


def _named_tables(info: FieldInfo) -> bool:
    """True if a field holds tables under names of the user's own."""
    numbered = any(isinstance(mark, _Numbered) for mark in info.metadata)
    return get_origin(info.annotation) is dict and not numbered


def quantity_of(info: FieldInfo) -> Quantity | None:
    """Kind and range of the values of a field, None where they are no quantities."""
    measure = measure_of(info)
    return measure.each if isinstance(measure, Pair) else measure


def measure_of(info: FieldInfo) -> Quantity | Pair | None:
    """The same, of both gears together where a field holds a value for each."""
    every = (*info.metadata, *marks(info.annotation))
    return next((mark for mark in every if isinstance(mark, Quantity | Pair)), None)


def usual_words(info: FieldInfo) -> str:
    """The value that a quantity has where none is given, in words; empty where there is none."""
    quantity, usual = quantity_of(info), info.default
    if quantity is None or usual is None or info.is_required():
        return ""
    values = usual if isinstance(usual, tuple) else (usual,)
    shown_values = dict.fromkeys(
        quantity.show(value) for value in values if isinstance(value, float)
    )
    return f"default {' / '.join(shown_values)}" if shown_values else ""


def marks(annotation: Any) -> Iterator[Any]:
    """What is said of the values that a field may hold, alone or in a list."""
    for option in getattr(annotation, "__args__", ()):
        yield from getattr(option, "__metadata__", ())
        yield from marks(option)


_MOST_TOLD = 20
"""Sentences on one file."""


def _complaint(error: ValidationError, document: Document, model: type[BaseModel]) -> InputError:
    """The complaints of pydantic in gear words, the clearest one first, each thing once."""
    details = error.errors(include_url=False)[:1000]  # of a hostile file, the first ones
    causes = [_clearest(details), *_causes(details, document)]
    faults = {str(fault): fault for cause in causes for fault in _sentences(cause, document, model)}
    every = list({fault.key: fault for fault in reversed(faults.values())}.values())[::-1]
    if len(every) > _MOST_TOLD:
        ending = InputError("more is wrong; these first", file=document.name)
        every = [*every[:_MOST_TOLD], ending]
    return every[0] if len(every) == 1 else CollectedInputError(every)


def _causes(details: Sequence[Any], document: Document) -> list[Any]:
    """What is wrong, each thing once: without what follows from a misspelt key or form.

    Of several complaints about one value the clearest one stands, and none about a value stands beside
    one about something in it, as a name that was given as a table has it.
    """
    places: dict[tuple[str, ...], list[Any]] = {}
    for detail in details:
        places.setdefault(_place_of(detail, document), []).append(detail)
    inside = {place[:end] for place in places for end in range(len(place))}
    forms_of = {place[:-1] for place, at_place in places.items() if _misspelt_form(at_place)}
    unknown = [
        place for place, at_place in places.items() if at_place[0]["type"] == "extra_forbidden"
    ]
    return [
        _clearest(at_place)
        for place, at_place in places.items()
        if place not in inside
        and (
            _misspelt_form(at_place)
            or not any(place[:end] in forms_of for end in range(len(place)))
        )
        and not _left_missing(place, at_place, unknown, document.tree)
        and not _told_with_another(place, at_place, places)
    ]


def _told_with_another(
    place: tuple[str, ...], same: Sequence[Any], places: Mapping[tuple[str, ...], Any]
) -> bool:
    """True for a missing table whose sentence stands with the first one, and the rest of a wrong list."""
    if same[0]["type"] != "missing":
        return False
    beside = [
        sibling for sibling in places if sibling[:-1] == place[:-1] and len(sibling) == len(place)
    ]
    if len(place) == 1:
        lacking = (sibling for sibling in beside if places[sibling][0]["type"] == "missing")
        return place != next(lacking)
    return place[-1].isdigit() and len(beside) > 1


def _place_of(detail: Any, document: Document) -> tuple[str, ...]:
    words = _words(document, detail)
    return tuple(str(part) for part in detail["loc"] if str(part) in words)


def _misspelt_form(same: Sequence[Any]) -> bool:
    """True for complaints about a key that decides what the others may be."""
    return any(
        detail["type"] == "literal_error" and detail["loc"][-1] in DECIDING for detail in same
    )


def _left_missing(
    place: tuple[str, ...],
    same: Sequence[Any],
    unknown: Sequence[tuple[str, ...]],
    tree: Mapping[str, Any],
) -> bool:
    """True for a missing key that stands there in another spelling."""
    from pitchpoint.cases.wishes import answered

    beside = (sibling for sibling in unknown if sibling[:-1] == place[:-1])
    return same[0]["type"] == "missing" and any(
        place[-1] in answered(sibling, tree) or alike(sibling[-1], place[-1:]) for sibling in beside
    )


def _sentences(detail: Any, document: Document, model: type[BaseModel]) -> Sequence[InputError]:
    """A complaint of pydantic in gear words, or several that one check of our own has."""
    words = _words(document, detail)
    key = ".".join(shorten(str(part)) for part in detail["loc"] if str(part) in words)
    cause = detail.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        from pitchpoint.cases.wishes import value_advice

        errors = cause.errors if isinstance(cause, CollectedInputError) else (cause,)
        places = [".".join(filter(None, (key, complaint.key))) for complaint in errors]
        return [
            complaint.at(file=document.name, key=place).followed_by(
                value_advice(place, detail["input"])
            )
            for complaint, place in zip(errors, places, strict=True)
        ]
    return [InputError(_message(detail, document, model), file=document.name, key=key)]


def _clearest(details: list[Any]) -> Any:
    """A misspelt key before the one it left missing.

    For a value that may be a name or a table, the complaint about the form that was given.
    """
    for item in details:  # a misspelt form makes its own keys unknown
        if item["type"] == "literal_error" and item["loc"][-1] in DECIDING:
            return item
    unknown = [item for item in details if item["type"] == "extra_forbidden"]
    foremost = (unknown or details)[0]
    at_place = [item for item in details if item["loc"][:2] == foremost["loc"][:2]]
    fitting = [
        item for item in at_place if item["type"] not in ("model_type", "model_attributes_type")
    ]
    return unknown[0] if unknown else (fitting or at_place)[0]


def _words(document: Document, detail: Any) -> set[str]:
    """Parts of a location that stand in the file, without pydantic's names of alternatives."""
    words: set[str] = set()
    node: Any = document.tree
    for part in detail["loc"]:
        if (isinstance(node, dict) and part in node) or (
            isinstance(node, list | tuple) and isinstance(part, int) and part < len(node)
        ):
            node = node[part]
        elif part != detail["loc"][-1] or detail["type"] not in ("missing", "extra_forbidden"):
            continue
        words.add(str(part))
    return words


def _message(detail: Any, document: Document, model: type[BaseModel]) -> str:
    kind, stated, context = detail["type"], detail.get("input"), detail.get("ctx", {})
    if kind == "missing":
        return f"is missing{_needed(detail['loc'], model)}"
    if kind == "extra_forbidden":
        what, fields = "table" if isinstance(stated, dict) else "key", _fields(detail["loc"], model)
        from pitchpoint.cases.wishes import answer

        place = _place_of(detail, document)
        advice = answer(place, stated, document.tree, fields) or _meant(
            place, fields, model, document.tree
        )
        return f"is not a known {what}{advice}"
    if kind == "literal_error":
        allowed = _options(detail["loc"], model) or context["expected"]
        if detail["loc"][-1] == "family" and isinstance(stated, str):
            from pitchpoint.cases.wishes import no_family

            return f"{shown(stated)} is no family of gears{no_family(stated, _quoted(allowed))}"
        return f"{shown(stated)} is not allowed; use {allowed}"
    if isinstance(stated, list) and stated and all(isinstance(entry, dict) for entry in stated):
        table = ".".join(_place_of(detail, document))
        both = "; a list in it has a value for each gear" if table == "gears" else ""
        return f"tables [[{table}]] were given where one table [{table}] belongs{both}"
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return f"{shown(stated)} was given where a table belongs{_inner(detail['loc'], model)}"
    if kind in ("tuple_type", "list_type"):
        return f"{shown(stated)} was given where a list belongs{_as_list(detail['loc'], model)}"
    if kind == "too_long":
        return _too_many(len(stated), context["max_length"])
    return f"{shown(stated)} is not allowed: {detail['msg'].lower()}"


def _as_list(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a list of quantities: what to write."""
    info = _fields(location, model).get(str(location[-1]))
    quantity = None if info is None else quantity_of(info)
    return "" if quantity is None else f"; write [{quantity.example}]; {quantity.allowed}"


def _inner(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a table of the user's own: where it belongs."""
    *above, key = map(str, location)
    if key in _fields((*location, ""), model):
        table = ".".join(above)
        return f"; {key} is a key of each table in [{table}], such as {table}.{_ANY_NAME}.{key}"
    return ""


def _quoted(options: str) -> list[str]:
    """Names between the quotation marks of a list in words."""
    return options.split("'")[1::2]


def _of_stage(place: Sequence[str]) -> tuple[str, Sequence[str]]:
    """Beginning of the keys of the stage of a place, and the place in it; nothing of other places."""
    if place[0] != STAGES:
        return "", ()
    numbered = len(place) > 1 and place[1].isdigit()
    return ".".join(place[: 1 + numbered]) + ".", place[1 + numbered :]


_SLIP = 0.8
"""Likeness of two spellings of one key: "temperatures" and "temperature" agree by 0.96."""


def _meant(place: Sequence[str], known: Collection[str], model: type[BaseModel], tree: Any) -> str:
    """End of a sentence on a key that its table does not have: its neighbours, or the tables that have it.

    Only a slip of the pen comes before a table that has the very key: "force" is not "source".
    """
    key = place[-1]
    stage, inside = _of_stage(place)
    if inside:
        tree = _inside(_inside(tree, STAGES), place[1])
        place, model = inside, StageTable
    # Gears of a set are in the place of stages, and not offered beside these.
    beside = {"gears"} if not stage and STAGES in _keys_of(tree) else set()
    every = [name for name in _holding(key, model, tree) if name not in beside]
    if STAGES in model.model_fields:
        of_stage = _holding(key, StageTable, _inside(_inside(tree, STAGES), "1"))
        every += [f"{STAGES}.1.{name}" for name in of_stage if name not in every]
    above = ".".join(place[:-1])
    every = [name for name in every if name != above]  # of another family
    near = [name for name in every if above and name.startswith(f"{above}.")]
    flat = [name for name in every if "." not in name.removeprefix(f"{STAGES}.1.")]
    tables = [f"[{stage}{name}]" for name in (near or flat or every)[:_FEW_TABLES]]
    if key in model.model_fields and forms(model.model_fields[key].annotation):
        return f"; [{key}] is a table of its own"
    from pitchpoint.cases.wishes import elsewhere

    if alike(key, known, _SLIP) or not tables:
        return ("" if alike(key, known) else elsewhere(key)) or nearest(key, known)
    return f"; {' and '.join(tables)} {'has' if len(tables) == 1 else 'have'} that key"


def _keys_of(tree: Any) -> Collection[str]:
    """Keys of a table; none where nothing is known of one, or it is that of a planetary set."""
    return tree.keys() if isinstance(tree, Mapping) and not is_planetary(tree) else ()


_FEW_TABLES = 3
"""Tables that a sentence names of those that have a key."""


def _inside(tree: Any, key: str) -> Any:
    """What stands at a key of a table; None where nothing does, or the table is none."""
    return tree.get(key) if isinstance(tree, Mapping) else None


def _holding(key: str, model: type[BaseModel], tree: Any, above: str = "") -> Iterator[str]:
    """Dotted names of the tables in a table that have a key, those nearest to it first.

    Of a table with several forms only the form that the tree has counts, or all where it has none.
    """
    inner = [
        (f"{above}{name}" + f".{_ANY_NAME}" * _named_tables(info), form, _inside(tree, name))
        for name, info in model.model_fields.items()
        if name not in ("formulas", STAGES)
        for form in forms(info.annotation, _inside(tree, name))
    ]
    names = [name for name, form, _ in inner if key in form.model_fields]
    deeper = (name for at, form, node in inner for name in _holding(key, form, node, f"{at}."))
    yield from dict.fromkeys((*names, *deeper))


_ANY_NAME = "NAME"
"""Stands for a name of the user's own in the key of a table."""


def _options(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """Forms that a deciding key may name, those of all tables that stand there; else nothing."""
    if len(location) < 2:
        return ""
    *above, _, key = location
    if key not in DECIDING:
        return ""
    info = _fields(tuple(above), model).get(above[-1]) if above else None
    sets = [PLANETARY] * (above == ["gears"])
    names = [*alternatives(info.annotation), *sets] if info else []
    return " or ".join(f"'{name}'" for name in names)


def _fields(location: tuple[Any, ...], model: type[BaseModel]) -> Mapping[str, FieldInfo]:
    """Fields of the table in which the last part of a location stands."""
    fields: Mapping[str, FieldInfo] = model.model_fields
    tables: Mapping[str, type[BaseModel]] = {}
    named = False
    for part in location[:-1]:
        if named:
            named = False
        elif part in tables:
            fields, tables = tables[part].model_fields, {}
        elif isinstance(part, str) and part in fields:
            named = _named_tables(fields[part])
            tables = alternatives(fields[part].annotation)
            fields = next(iter(tables.values())).model_fields if tables else {}
    return fields


def _needed(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    fields = _fields(location, model)
    info = fields.get(str(location[-1]))
    if info is None:
        return ""
    if info.examples and get_origin(info.annotation) is tuple:
        return f"; write a list such as {json.dumps(info.examples[0])}"
    quantity = quantity_of(info)
    if quantity is not None:
        return f"; write {quantity.example}; {quantity.allowed}"
    if len(location) == 1:
        needed = [name for name, field in fields.items() if field.is_required()]
        begin = "; pitchpoint new spur writes a file to begin with"
        return f"; a case file needs the tables {', '.join(needed)}{begin}"
    if get_origin(info.annotation) is tuple:
        return "; write a list"
    if alternatives(info.annotation):
        return "; write a table"
    options = getattr(info.annotation, "__args__", ())
    names = [
        how.func.known() for how in info.metadata if hasattr(getattr(how, "func", None), "known")
    ]
    if options or names:
        return f"; use one of {listed(options or names[0])}"
    return "; write text"
