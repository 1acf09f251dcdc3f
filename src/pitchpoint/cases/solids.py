"""Materials of a case as they are used: at the temperature of the gears, with where they come from."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import cos
from typing import cast, get_args

from pitchpoint.cases.document import Document
from pitchpoint.cases.schema import Case, Materials, SolidValues
from pitchpoint.efficiency.tooth_temperature import TOOTH_TEMPERATURE, modulus_at
from pitchpoint.errors import InputError
from pitchpoint.materials import solids
from pitchpoint.materials._leaves import Datum, Status
from pitchpoint.materials.solids import Solid, SolidRecord, celsius

__all__ = ["SolidInUse", "datum", "heated", "solids_in_use"]

_PLASTIC_BELOW = 30e9  # Pa; no metal for gears is as soft, no plastic without fibres as stiff
_KEYS = ("gear_1", "gear_2")


@dataclass(frozen=True)
class SolidInUse:
    """Material of one gear.

    Attributes:
        record: values with their origin.
        solid: bare numbers at the temperature.
        temperature: of the teeth [K].
        told: sentence on temperature and modulus; empty where nothing follows from it.
        flank: temperature of the flanks [K], None where it is that of the teeth.
    """

    record: SolidRecord
    solid: Solid
    temperature: float
    told: str = ""
    flank: float | None = None

    @property
    def plastic(self) -> bool:
        """True for a material as soft as plastics are."""
        return float(self.solid.young) < _PLASTIC_BELOW


def solids_in_use(
    materials: Materials, document: Document, temperature: float
) -> tuple[SolidInUse, SolidInUse]:
    """Materials of both gears at a temperature.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    first, second = (
        _in_use(_record(getattr(materials, key), key, document), key, document, temperature)
        for key in _KEYS
    )
    return first, second


def heated(
    case: Case,
    used: tuple[SolidInUse, SolidInUse],
    *,
    found: Mapping[str, float],
    document: Document,
) -> tuple[SolidInUse, SolidInUse]:
    """Materials with plastic gears at the temperature of their tooth roots.

    The tooth yields most in its root and body, so the temperature there sets its modulus.

    Args:
        case: gears, operating point, housing, and the name of the thermal model.
        used: materials at the temperature of the surroundings.
        found: mean_friction and loss_factor at the operating point.
        document: for messages.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    first, second = (
        _warm(case, used, gear, found, document) if used[gear].plastic else used[gear]
        for gear in (0, 1)
    )
    return first, second


def datum(value: float, key: str, document: Document) -> Datum:
    """Value of the case file with the mark that it carries there."""
    mark = document.provenance.get(key)
    if mark is None or mark.status not in get_args(Status):
        return Datum(value=value)
    return Datum(value=value, status=cast("Status", mark.status), note=mark.note)


def _warm(
    case: Case,
    used: tuple[SolidInUse, SolidInUse],
    gear: int,
    found: Mapping[str, float],
    document: Document,
) -> SolidInUse:
    gears, point, housing = case.gears, case.operation, case.housing
    driver = 1 if point.driver == "gear 2" else 0
    ratio = abs(gears.teeth[1 - driver] / gears.teeth[driver])
    torque, resistance = point.torque / ratio, housing.thermal_resistance or None
    working = _working_radius(case, driver)
    temperature = TOOTH_TEMPERATURE[case.models.tooth_temperature].function(
        ambient=point.temperature,
        power=torque * point.speed,
        friction=found["mean_friction"],
        loss_factor=found["loss_factor"],
        face_width=gears.face_width,
        teeth=abs(gears.teeth[gear]),
        pitch_speed=working * point.speed,
        normal_module=gears.module,
        mate="plastic" if used[1 - gear].plastic else "steel",
        housing_resistance=resistance,
        housing_area=housing.area,
        duty=housing.duty,
    )
    root, flank = float(temperature.root), float(temperature.flank)
    warm = _in_use(used[gear].record, _KEYS[gear], document, root)
    young, status = modulus_at(used[gear].record, root)
    told = (
        f"The teeth of gear {gear + 1} reach {celsius(flank)} at the flank and {celsius(root)} at the "
        f"root; modulus {float(young) / 1e9:.3g} GPa. {status[:1].upper()}{status[1:]}."
    )
    return replace(warm, told=told, flank=flank)


def _working_radius(case: Case, gear: int) -> float:
    """Radius of the reference circle [m]: near enough to the pitch circle for a temperature."""
    gears = case.gears
    return abs(gears.teeth[gear]) * gears.module / (2.0 * cos(gears.helix_angle))


def _in_use(record: SolidRecord, key: str, document: Document, temperature: float) -> SolidInUse:
    try:
        return SolidInUse(record, record.build(temperature), temperature)
    except InputError as error:
        raise error.at(file=document.name, key=f"materials.{key}") from None


def _record(given: SolidValues | str, key: str, document: Document) -> SolidRecord:
    if isinstance(given, str):
        return solids.find(given)
    young, poisson, density = (
        datum(getattr(given, name), f"materials.{key}.{name}", document)
        for name in ("young", "poisson", "density")
    )
    name = f"material of gear {key[-1]}"
    return SolidRecord(name=name, title="by value", young=young, poisson=poisson, density=density)
