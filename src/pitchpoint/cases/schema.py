"""The schema of a case file: one table a class, every value with kind and allowed range."""

from collections.abc import Iterator, Mapping
from math import inf, pi
from typing import Annotated, Any, Literal

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ValidationError,
    model_validator,
)
from pydantic.fields import FieldInfo

from pitchpoint import units
from pitchpoint.cases.document import Document, check_name
from pitchpoint.cases.quantities import Pair, Quantity, named, shorten, shown
from pitchpoint.errors import InputError
from pitchpoint.registry import nearest

__all__ = ["Case", "quantity_at", "validate"]

_ZERO_CELSIUS = 273.15

TEETH = Quantity("dimensionless", -10_000, 10_000, whole=True)
MODULE = Quantity("length", 1e-5, 0.1, "mm")
WIDTH = Quantity("length", 1e-5, 10.0, "mm")
DISTANCE = Quantity("length", 1e-4, 100.0, "mm")
HELIX = Quantity("angle", 0.0, 60 * pi / 180, "deg")
ANGLE = Quantity("angle", 5 * pi / 180, 45 * pi / 180, "deg")
SHIFT = Quantity("dimensionless", -2.0, 3.0)
RACK = Quantity("dimensionless", 0.1, 4.0)
FILLET = Quantity("dimensionless", 0.0, 1.0)
TIP = Quantity("dimensionless", -2.0, 2.0)
LEAST_TIP = Quantity("dimensionless", 0.0, 1.5)
BORE = Quantity("length", 1e-5, 100.0, "mm")
INERTIA = Quantity("moment of inertia", 0.0, 1e9, "kg m2", open_low=True)
RATIO = Quantity("dimensionless", 0.0, 1.0, open_low=True)
DEVIATION = Quantity("length", 0.0, 1e-2, "um")
PHASE = Quantity("angle", -4 * pi, 4 * pi, "deg")
ORDER = Quantity("dimensionless", 0, 40, whole=True)
SLICES = Quantity("dimensionless", 1, 400, whole=True)
THERMAL_RESISTANCE = Quantity("thermal resistance", 0.0, 10.0, "K m2/W")
AREA = Quantity("area", 1e-8, 1e4, "m2")
MODULUS = Quantity("pressure", 1e6, 1e13, "GPa")
POISSON = Quantity("dimensionless", 0.0, 0.5)
DENSITY = Quantity("density", 100.0, 30_000.0, "kg/m3")
SLOPE = Quantity("density slope", 0.0, 5.0, "kg/m3/K")
VISCOSITY = Quantity("kinematic viscosity", 2e-6, 0.1, "mm2/s")
ALPHA = Quantity("pressure-viscosity coefficient", 1e-10, 1e-6, "1/GPa")
FACTOR = Quantity("dimensionless", 0.0, 10.0, open_low=True)
ROUGHNESS = Quantity("length", 0.0, 1e-4, "um")
TORQUE = Quantity("torque", 0.0, 1e8, "N m")
LOADED = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
MAP_SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm")
TEMPERATURE = Quantity("temperature", 150.0, 600.0, "degC")
COEFFICIENT = Quantity("dimensionless", 0.0, 2.0)
COUNT = Quantity("dimensionless", 1, 100_000, whole=True)
ANY = Quantity("dimensionless", -inf, inf)

NOT_NEGATIVE = Quantity("dimensionless", 0.0, inf)
POSITION = Quantity("dimensionless", 0, 11, whole=True)

Text = Annotated[str, BeforeValidator(lambda value: _text(value))]
Unit = Annotated[str, BeforeValidator(lambda value: _unit(value))]


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"{shown(value)} was given where text belongs")
    return value


def _unit(value: Any) -> str:
    if _text(value) != "1":
        units.kind_of(value)
    return str(value)


def _reductions() -> list[str]:
    from pitchpoint.cases.reductions import REDUCTIONS

    return list(REDUCTIONS)


def _variables() -> list[str]:
    from pitchpoint.results.variables import VARIABLES

    return list(VARIABLES)


def _friction_laws() -> list[str]:
    from pitchpoint.cases.laws import FRICTION

    return list(FRICTION)


def _sharings() -> list[str]:
    from pitchpoint.loading.sharing import LOAD_SHARING

    return list(LOAD_SHARING)


def _compliances() -> list[str]:
    from pitchpoint.loading.tooth_compliance import TOOTH_COMPLIANCE

    return list(TOOTH_COMPLIANCE)


def _contact_laws() -> list[str]:
    from pitchpoint.dynamics.contact_law import CONTACT_LAWS

    return list(CONTACT_LAWS)


def _tooth_temperatures() -> list[str]:
    from pitchpoint.efficiency.tooth_temperature import TOOTH_TEMPERATURE

    return list(TOOTH_TEMPERATURE)


def _rollings() -> list[str]:
    from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE

    return list(ROLLING_RESISTANCE)


def _films() -> list[str]:
    from pitchpoint.lubrication.film_thickness import FILM_THICKNESS

    return [name for name, law in FILM_THICKNESS.items() if law.shape == "line"]


def _oils() -> list[str]:
    from pitchpoint.materials.lubricants import catalogue

    return list(catalogue())


def _solids() -> list[str]:
    from pitchpoint.materials.solids import catalogue

    return list(catalogue())


def _bases() -> list[str]:
    from pitchpoint.materials.lubricants import base_oils

    return list(base_oils())


class Table(BaseModel):
    """A table of a case file: no unknown keys, values fixed once read."""

    model_config = ConfigDict(extra="forbid", frozen=True)


FEWEST_TEETH = 2
FEWEST_RING_TEETH = 10


def _teeth(value: tuple[float, float]) -> tuple[float, float]:
    first, second = value
    if first < FEWEST_TEETH:
        raise InputError(
            f"gear 1 was given {first:.0f} teeth; allowed are {FEWEST_TEETH} or more, and only gear 2 "
            "may be a ring, with its number of teeth negative"
        )
    if -FEWEST_RING_TEETH < second < FEWEST_TEETH:
        raise InputError(
            f"gear 2 was given {second:.0f} teeth; allowed are {FEWEST_TEETH} or more, or for a ring "
            f"with internal teeth -{FEWEST_RING_TEETH} or less"
        )
    return value


class Gears(Table):
    """A pair of involute gears on parallel axes, spur or helical; gear 2 may be a ring."""

    family: Literal["cylindrical"] = "cylindrical"
    teeth: Annotated[tuple[float, float], Pair(TEETH), AfterValidator(_teeth)]
    module: Annotated[float, MODULE]
    face_width: Annotated[float, WIDTH]
    pressure_angle: Annotated[float, ANGLE] = pi / 9
    helix_angle: Annotated[float, HELIX] = 0.0
    profile_shift: Annotated[tuple[float, float], Pair(SHIFT)] = (0.0, 0.0)
    addendum: Annotated[tuple[float, float], Pair(RACK)] = (1.0, 1.0)
    dedendum: Annotated[tuple[float, float], Pair(RACK)] | None = None
    fillet_radius: Annotated[tuple[float, float], Pair(FILLET)] | None = None
    tip_alteration: Annotated[tuple[float, float], Pair(TIP)] | None = None
    least_tip_thickness: Annotated[float, LEAST_TIP] | None = None
    centre_distance: Annotated[float, DISTANCE] | None = None
    bore_diameter: Annotated[tuple[float, float], Pair(BORE)] | None = None
    flank: Literal["left", "right"] = "left"

    @model_validator(mode="after")
    def _one_tip(self) -> "Gears":
        if self.tip_alteration is not None and self.least_tip_thickness:
            raise InputError(
                "tip_alteration and least_tip_thickness were both given; a tip alteration by value is "
                "kept as it is",
                key="least_tip_thickness",
            )
        return self


class SolidValues(Table):
    """A material by value."""

    young: Annotated[float, MODULUS]
    poisson: Annotated[float, POISSON]
    density: Annotated[float, DENSITY] = 7830.0


SolidName = Annotated[str, BeforeValidator(named(_solids, "material"))]


class Materials(Table):
    """Materials of both gears, by name or by value."""

    gear_1: SolidValues | SolidName = "steel"
    gear_2: SolidValues | SolidName = "steel"


class Oil(Table):
    """An oil of the catalogue, by value, or a catalogue oil with some values of one's own."""

    name: Annotated[str, BeforeValidator(named(_oils, "lubricant"))] | None = None
    base: Annotated[str, BeforeValidator(named(_bases, "class of base oil"))] | None = None
    viscosity_40: Annotated[float, VISCOSITY] | None = None
    viscosity_100: Annotated[float, VISCOSITY] | None = None
    density: Annotated[float, DENSITY] | None = None
    density_slope: Annotated[float, SLOPE] | None = None
    pressure_viscosity: Annotated[float, ALPHA] | None = None
    lubricant_factor: Annotated[float, FACTOR] | None = None
    temperature_min: Annotated[float, TEMPERATURE] | None = None
    temperature_max: Annotated[float, TEMPERATURE] | None = None

    @model_validator(mode="after")
    def _known(self) -> "Oil":
        if self.name is None and (self.viscosity_40 is None or self.viscosity_100 is None):
            raise InputError(
                "an oil needs a name of the catalogue, or viscosity_40 and viscosity_100 by value"
            )
        if self.name is None and self.base is None:
            raise InputError(
                f"an oil by value needs its base, one of {', '.join(_bases())}, for density, "
                "pressure-viscosity coefficient and lubricant factor where they are not given"
            )
        return self


class Surface(Table):
    """Roughness: Ra or Rq of one flank (taken for both) or of each, or the composite Rq."""

    ra: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    rq: Annotated[tuple[float, float], Pair(ROUGHNESS)] | None = None
    composite_rq: Annotated[float, ROUGHNESS] | None = None

    @model_validator(mode="after")
    def _one(self) -> "Surface":
        given = [name for name in ("ra", "rq", "composite_rq") if getattr(self, name) is not None]
        if len(given) != 1:
            raise InputError(
                f"{len(given) or 'no'} roughness values were given; give exactly one of ra, rq "
                "(one flank or a list of two) and composite_rq"
            )
        return self


class Operating(Table):
    """Torque on the driven gear, speed of the driving one, temperature of the oil."""

    torque: Annotated[float, TORQUE]
    speed: Annotated[float, SPEED]
    temperature: Annotated[float, TEMPERATURE]
    driver: Literal["gear 1", "gear 2"] = "gear 1"


class FrictionChoice(BaseModel):
    """A friction law with values for its own parameters."""

    model_config = ConfigDict(extra="allow", frozen=True)

    name: Annotated[str, BeforeValidator(named(_friction_laws, "friction law"))]

    @property
    def parameters(self) -> dict[str, float]:
        """Values of the law's own parameters."""
        return {key: COEFFICIENT.read(value) for key, value in (self.model_extra or {}).items()}

    @model_validator(mode="after")
    def _own(self) -> "FrictionChoice":
        from pitchpoint.cases.laws import FRICTION
        from pitchpoint.lubrication.conditions import arguments

        _, known = arguments(FRICTION[self.name].function)
        for key, value in (self.model_extra or {}).items():
            if key not in known:
                has = nearest(key, known) if known else "; it has none"
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
    tables = [one if isinstance(one, dict | FrictionChoice) else {"name": one} for one in several]
    names = [str(one.get("name")) for one in tables if isinstance(one, dict)]
    for name in names:
        if names.count(name) > 1:
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
    """Which law stands for which effect."""

    friction: Annotated[tuple[FrictionChoice, ...], BeforeValidator(_choices)] = (
        FrictionChoice(name="iso_tr_14179_2"),
    )
    load_sharing: Annotated[str, BeforeValidator(named(_sharings, "load sharing model"))] = "equal"
    rolling_resistance: Annotated[str, BeforeValidator(named(_rollings, "rolling resistance"))] = (
        "none"
    )
    film_thickness: Annotated[str, BeforeValidator(named(_films, "film thickness law"))] = (
        "dowson_higginson_1959"
    )
    tooth_compliance: Annotated[
        str, BeforeValidator(named(_compliances, "tooth compliance model"))
    ] = "beam_foundation_weber"
    tooth_temperature: Annotated[
        str, BeforeValidator(named(_tooth_temperatures, "tooth temperature model"))
    ] = "isothermal"
    tooth_contact: Annotated[str, BeforeValidator(named(_contact_laws, "law of tooth contact"))] = (
        "linear"
    )
    slices: Annotated[float, SLICES, AfterValidator(_slices)] = 12.0
    averaging: Literal["base_pitch", "path"] = "base_pitch"


class Housing(Table):
    """How a plastic gear gets rid of its heat, for models of the tooth temperature."""

    thermal_resistance: Annotated[float, THERMAL_RESISTANCE] = 0.0
    area: Annotated[float, AREA] | None = None
    duty: Annotated[float, RATIO] = 1.0

    @model_validator(mode="after")
    def _both(self) -> "Housing":
        if (self.thermal_resistance > 0.0) != (self.area is not None):
            raise InputError("thermal_resistance and area of a housing belong together")
        return self


class Deviation(Table):
    """One order of the composite profile error, repeated with every mesh period; order 0 is constant."""

    order: Annotated[float, ORDER]
    amplitude: Annotated[float, DEVIATION]
    phase: Annotated[float, PHASE] = 0.0


class Speeds(Table):
    """Driver speeds through which resonances are looked for, upwards and downwards."""

    start: Annotated[float, SPEED]
    stop: Annotated[float, SPEED]
    count: Annotated[float, Quantity("dimensionless", 2, 2000, whole=True)] = 60.0

    @model_validator(mode="after")
    def _rising(self) -> "Speeds":
        if self.start >= self.stop:
            raise InputError(
                f"speeds run from {SPEED.show(self.start)} to {SPEED.show(self.stop)}; stop must be "
                "the larger"
            )
        return self


class Dynamics(Table):
    """Vibration of the pair along its line of action."""

    damping_ratio: Annotated[float, RATIO] = 0.1
    inertia: Annotated[tuple[float, float], Pair(INERTIA)] | None = None
    profile_error: tuple[Deviation, ...] = ()
    backlash: Annotated[float, DEVIATION] | None = None
    torques: tuple[Annotated[float, LOADED], ...] = ()
    speeds: Speeds | None = None


class Sweep(Table):
    """Values of one key: from start to stop in equal steps, or a list."""

    key: Text
    start: Any = None
    stop: Any = None
    count: Annotated[float, COUNT] = 19.0
    values: tuple[Any, ...] | None = None

    @model_validator(mode="after")
    def _complete(self) -> "Sweep":
        if (self.values is None) == (self.start is None or self.stop is None):
            raise InputError("a sweep needs either start and stop, or values")
        if self.values is not None and not 1 <= len(self.values) <= COUNT.high:
            raise InputError(f"{len(self.values)} values were given; {COUNT.allowed}", key="values")
        return self


class Study(Table):
    """One computation of the case: its operating point with changes, swept or not."""

    title: Text = ""
    change: dict[str, Any] = {}
    sweep: Sweep | None = None


class LossMap(Table):
    """Axes of the loss map; zero torque and zero speed are allowed."""

    torque: Annotated[float, TORQUE] | None = None
    speed: Annotated[float, MAP_SPEED] | None = None
    temperatures: tuple[Annotated[float, TEMPERATURE], ...] | None = None
    count: Annotated[float, Quantity("dimensionless", 2, 200, whole=True)] = 9.0


class Target(Table):
    """A printed number and how it is computed from a study."""

    quantity: Text
    where: Text
    kind: Literal["predicted", "fitted", "calibrated", "trend", "reference", "excluded"]
    printed: Annotated[float, ANY]
    unit: Unit = "1"
    tolerance: Annotated[float, NOT_NEGATIVE] = 0.0
    expect: Literal["within", "above", "below"] = "within"
    study: Text = ""
    variable: Annotated[str, BeforeValidator(named(_variables, "quantity"))] = ""
    reduce: Annotated[str, BeforeValidator(named(_reductions, "reduction"))] = "value"
    law: tuple[Annotated[float, POSITION], ...] = (0.0,)
    reason: Text = ""


class Issue(Table):
    """A misprint or a questionable point of the publication."""

    where: Text
    issue: Text
    verdict: Text


def _named(value: Any) -> Any:
    for name in value if isinstance(value, dict) else ():
        check_name(name, "")
    return value


class Case(Table):
    """A whole case file, one variant of it."""

    title: Text = ""
    summary: Text = ""
    source: Text = ""
    gears: Gears
    materials: Materials = Materials()
    lubricant: Oil
    roughness: Surface
    operation: Operating
    models: Choices = Choices()
    housing: Housing = Housing()
    dynamics: Dynamics | None = None
    studies: Annotated[dict[str, Study], BeforeValidator(_named)] = {}
    loss_map: LossMap | None = None
    targets: tuple[Target, ...] = ()
    issues: tuple[Issue, ...] = ()

    @model_validator(mode="after")
    def _aimed(self) -> "Case":
        for position, target in enumerate(self.targets):
            if target.kind != "excluded" and target.study not in self.studies:
                raise InputError(
                    f"there is no study {shown(target.study)}{nearest(target.study, self.studies)}",
                    key=f"targets.{position}.study",
                )
        return self


def validate(document: Document) -> Case:
    """Case out of a document.

    Raises:
        InputError: the first value that is wrong, with file, key, value and what is allowed.
    """
    try:
        return Case.model_validate(document.tree)
    except ValidationError as error:
        raise _sentence(error, document) from None


def quantity_at(key: str) -> Quantity | None:
    """Kind and range of the value at a dotted key, None where it is no quantity."""
    fields: Mapping[str, FieldInfo] = Case.model_fields
    parts = [part for part in key.split(".") if not part.isdigit()]
    for position, part in enumerate(parts):
        if part not in fields:
            raise InputError(f"there is no such key{nearest(part, fields)}", key=key)
        tables = list(_tables(fields[part].annotation))
        if position == len(parts) - 1:
            return _quantity(fields[part])
        if not tables:
            raise InputError(f"'{part}' is a value, not a table", key=key)
        fields = tables[0].model_fields
    return None


def _quantity(info: FieldInfo) -> Quantity | None:
    for mark in _marks(info):
        if isinstance(mark, Pair):
            return mark.each
        if isinstance(mark, Quantity):
            return mark
    return None


def _marks(info: FieldInfo) -> Iterator[Any]:
    yield from info.metadata
    for option in getattr(info.annotation, "__args__", ()):
        yield from getattr(option, "__metadata__", ())


def _tables(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for option in getattr(annotation, "__args__", ()):
        yield from _tables(option)


def _sentence(error: ValidationError, document: Document) -> InputError:
    """The first complaint of pydantic in gear words."""
    detail = _clearest(error.errors())
    words = _words(document, detail)
    key = ".".join(shorten(str(part)) for part in detail["loc"] if str(part) in words)
    cause = detail.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        return cause.at(file=document.name, key=".".join(filter(None, (key, cause.key))))
    return InputError(_message(detail), file=document.name, key=key)


def _clearest(details: list[Any]) -> Any:
    """A misspelt key before the one it left missing.

    For a value that may be a name or a table, the complaint about the form that was given.
    """
    unknown = [item for item in details if item["type"] == "extra_forbidden"]
    first = (unknown or details)[0]
    same = [item for item in details if item["loc"][:2] == first["loc"][:2]]
    fitting = [item for item in same if item["type"] not in ("model_type", "model_attributes_type")]
    return unknown[0] if unknown else (fitting or same)[0]


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


def _message(detail: Any) -> str:
    kind, given, context = detail["type"], detail.get("input"), detail.get("ctx", {})
    if kind == "missing":
        return f"is missing{_needed(detail['loc'])}"
    if kind == "extra_forbidden":
        what = "table" if isinstance(given, dict) else "key"
        known = _siblings(detail["loc"])
        return f"is not a known {what}{nearest(str(detail['loc'][-1]), known)}"
    if kind == "literal_error":
        return f"{shown(given)} is not allowed; use {context['expected']}"
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return f"{shown(given)} was given where a table belongs"
    if kind in ("tuple_type", "list_type"):
        return f"{shown(given)} was given where a list belongs"
    return f"{shown(given)} is not allowed: {detail['msg'].lower()}"


def _siblings(location: tuple[Any, ...]) -> dict[str, None]:
    return dict.fromkeys(_fields(location))


def _fields(location: tuple[Any, ...]) -> Mapping[str, FieldInfo]:
    """Fields of the table in which the last part of a location stands."""
    fields: Mapping[str, FieldInfo] = Case.model_fields
    for part in location[:-1]:
        if isinstance(part, str) and part in fields:
            tables = list(_tables(fields[part].annotation))
            fields = tables[0].model_fields if tables else {}
    return fields


def _needed(location: tuple[Any, ...]) -> str:
    fields = _fields(location)
    info = fields.get(str(location[-1]))
    if info is None:
        return ""
    quantity = _quantity(info)
    if quantity is not None:
        return f"; write {quantity.example}; {quantity.allowed}"
    if len(location) == 1:
        needed = [name for name, field in fields.items() if field.is_required()]
        return f"; a case file needs the tables {', '.join(needed)}"
    options = getattr(info.annotation, "__args__", ())
    return f"; use one of {', '.join(options)}" if options else "; write text"
