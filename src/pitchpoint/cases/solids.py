"""Materials of a case as they are used: at the temperature of the gears, with where they come from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import tan
from typing import Any, cast, get_args

import numpy as np

from pitchpoint._jax import array
from pitchpoint.cases.document import Document
from pitchpoint.cases.schema import CaseFile
from pitchpoint.core.doubts import GUESSED, LEFT_OUT, REMARKED, Doubt, fails
from pitchpoint.efficiency.efficiency_registry import TOOTH_TEMPERATURE
from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.efficiency.tooth_temperature import modulus_at
from pitchpoint.efficiency.warm_teeth import ToothHeating
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.input.remembered import remembering
from pitchpoint.materials import solids
from pitchpoint.materials.data import Datum, Status
from pitchpoint.materials.material_tables import Materials, SolidValues
from pitchpoint.materials.solids import Solid, SolidRecord, celsius, heat_failure

__all__ = [
    "SolidInUse",
    "datum",
    "failures",
    "fitted_on_steel",
    "grown",
    "heating",
    "solids_at_root_temperature",
    "solids_in_use",
    "surrounded",
]

BY_VALUE = "by value"
_PLASTIC_BELOW = 30e9  # Pa; no metal for gears is as soft, no plastic without fibres as stiff
_STEEL_ABOVE = 150e9  # Pa; given by value, a stiffer material is taken to bear what steel bears
_KEYS = ("gear_1", "gear_2")


@dataclass(frozen=True, eq=False)
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

    @property
    def hottest(self) -> float:
        """Highest temperature of the teeth [K]."""
        return self.temperature if self.flank is None else max(self.flank, self.temperature)

    @property
    def bears(self) -> Datum | None:
        """Largest Hertz pressure [Pa]; None where it is not known."""
        if self.record.title == BY_VALUE and self.record.young.value > _STEEL_ABOVE:
            return solids.find("steel").contact_limit
        return self.record.contact_limit


Used = tuple[SolidInUse, SolidInUse]


def failures(used: Used) -> list[str]:
    """Gears that are hotter than their material bears."""
    failing = (heat_failure(solid.record, solid.hottest) for solid in used)
    return [
        fails(
            f"the teeth of gear {gear} are at {celsius(solid.hottest)}; {text}.",
            f"gear {gear} is at {celsius(solid.hottest)}; {text.removesuffix(' for long')}.",
        )
        for gear, (solid, text) in enumerate(zip(used, failing, strict=True), 1)
        if text
    ]


def fitted_on_steel(laws: Sequence[str], plastic: Sequence[int]) -> Doubt:
    """That laws of friction know nothing of plastics.

    Args:
        laws: names of those that were fitted to steel in oil.
        plastic: numbers of the gears that are of plastic.
    """
    gears = " and ".join(f"gear {number}" for number in plastic)
    are = "are" if len(plastic) > 1 else "is"
    return Doubt(
        f"Friction by {' and '.join(laws)} was fitted to steel on steel in oil, and {gears} {are} plastic: "
        "loss and efficiency are those of a steel pair under this load; where the friction of the pair is "
        'measured, name "constant" with its coefficient.',
        moves=GUESSED,
        about=("mean_efficiency",),
        brief=f"Friction is that of steel; {gears} {are} plastic.",
    )


EXPANSION = 1e-4
"""Thermal expansion of unfilled plastics [1/K]: a round figure, no data of one of them."""

ROOM = 293.15
"""Temperature at which gears are measured [K], ISO 1."""

_SLIGHT = 0.005
"""Backlash over module below which what growth takes is not told."""


def grown(
    used: Used, teeth: tuple[float, float], pressure_angle: float, centre_distance: float
) -> list[str]:
    """That the growth of warm plastic takes backlash, where it is more than slight.

    Args:
        used: materials of both gears at their temperature.
        teeth: z1 and z2, negative for a ring.
        pressure_angle: of the rack [rad].
        centre_distance: [m].

    Validity: spur gears that grow evenly, to first order in the growth e: teeth of the same angle reach
    further out, so that they are thicker by 2 r_w tan(alpha) e at the pitch circle.
    """
    taken, hottest = 0.0, ROOM
    for number, solid in zip(teeth, used, strict=True):
        if solid.plastic:
            radius = centre_distance * number / abs(sum(teeth))
            growth = EXPANSION * (solid.temperature - ROOM)
            taken += growth * 2.0 * radius * tan(pressure_angle)
            hottest = max(hottest, solid.temperature)
    if taken < _SLIGHT * 2.0 * centre_distance / abs(sum(teeth)):
        return []
    lost = float(f"{1e6 * taken:.2g}")  # um
    return [
        Doubt(
            f"Plastic at {celsius(hottest)} has grown since it was measured at {celsius(ROOM)}, which is "
            f"left out: with {EXPANSION:g} 1/K, about that of unfilled plastics, some {lost:g} um "
            "of the circumferential backlash are taken; water that it takes up takes more, a housing that "
            "grows gives some back.",
            brief=f"Warm plastic grows: some {lost:g} um of the backlash go, left out.",
        )
    ]


def solids_in_use(materials: Materials, document: Document, temperature: float) -> Used:
    """Materials of both gears at a temperature.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    wrong = Complaints(document.name)
    gear_1 = wrong.tried(_of_gear, materials.gear_1, "gear_1", document, temperature)
    if gear_1 is None and materials.gear_1 == materials.gear_2:
        raise wrong.error  # of the other gear too
    gear_2 = wrong.tried(_of_gear, materials.gear_2, "gear_2", document, temperature)
    if gear_1 is None or gear_2 is None:
        raise wrong.error
    return gear_1, gear_2


def _of_gear(
    given: SolidValues | str, key: str, document: Document, temperature: float
) -> SolidInUse:
    return _in_use(_record(given, key, document), key, temperature)


def surrounded(used: Used, temperature: float) -> Used:
    """The same materials at the temperature of their surroundings.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    gear_1, gear_2 = (
        _in_use(solid.record, key, temperature) for solid, key in zip(used, _KEYS, strict=True)
    )
    return gear_1, gear_2


def solids_at_root_temperature(
    case: CaseFile, design: Design, used: Used, found: Mapping[str, float]
) -> Used:
    """Materials with plastic gears at the temperature of their tooth roots.

    The tooth yields most in its root and body, so the temperature there sets its modulus.

    Args:
        case: operating point, housing, and the name of the thermal model.
        mesh: of the gears.
        used: materials at the temperature of the surroundings.
        found: mean_friction and loss_factor at the operating point, by the first friction law.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    gear_1, gear_2 = (
        _warm(case, design, used, gear, found) if used[gear].plastic else used[gear]
        for gear in (0, 1)
    )
    return gear_1, gear_2


def heating(case: CaseFile, used: Used) -> ToothHeating:
    """What decides how warm the teeth of a case get.

    Args:
        case: gears, housing, and the name of the thermal model.
        used: materials at the temperature of the surroundings.
    """
    gears, housing = case.gears, case.housing
    tables = [_table(solid) for solid in used]
    length = max(len(places) for places, _ in tables)
    known_at, moduli = (
        np.stack([np.pad(part, (0, length - len(part)), "edge") for part in parts])
        for parts in zip(*tables, strict=True)
    )
    return ToothHeating(
        plastic=array([solid.plastic for solid in used]),
        known=array(known_at),
        moduli=array(moduli),
        teeth=array(gears.tooth_numbers, float),
        module=array(gears.normal_module),
        housing=array((housing.thermal_resistance or 0.0) / (housing.area or 1.0)),
        duty=array(housing.duty),
        mates=_mates(used),
        function=TOOTH_TEMPERATURE[case.models.tooth_temperature].function,
    )


def _mates(used: Used) -> tuple[str, str]:
    """Materials of the mates of both gears, as the thermal model tells them apart."""
    mate_of_1, mate_of_2 = ("plastic" if solid.plastic else "steel" for solid in reversed(used))
    return mate_of_1, mate_of_2


def _table(used: SolidInUse) -> tuple[list[float], list[float]]:
    """Temperatures and moduli of a material; one modulus at all where no more are known."""
    points = used.record.young_at
    if not points:
        return [0.0, 1.0], [float(used.solid.young)] * 2
    return [point.temperature for point in points], [point.young.value for point in points]


def datum(value: float, key: str, document: Document) -> Datum:
    """Value of the case file with the mark that it carries there."""
    mark = document.provenance.get(key)
    if mark is None or mark.status not in get_args(Status):
        return Datum(value=value)
    return Datum(value=value, status=cast("Status", mark.status), note=mark.note)


def _warm(
    case: CaseFile, design: Design, used: Used, gear: int, found: Mapping[str, float]
) -> SolidInUse:
    pair, point, gears = pitch_point(design.mesh, design.driver), case.operation, case.gears
    temperature = TOOTH_TEMPERATURE[case.models.tooth_temperature].function(
        ambient=point.temperature,
        power=point.load * abs(float(design.loaded @ design.motion)) * point.speed,
        friction=found["mean_friction"],
        loss_factor=found["loss_factor"],
        face_width=pair.width,
        teeth=gears.tooth_numbers[gear],
        pitch_speed=pair.pitch_line_speed * point.speed,
        normal_module=gears.normal_module,
        mate=_mates(used)[gear],
        housing_resistance=case.housing.thermal_resistance or None,
        housing_area=case.housing.area,
        duty=case.housing.duty,
    )
    root, flank = float(temperature.root), float(temperature.flank)
    record = used[gear].record
    warm = _in_use(record, _KEYS[gear], root)
    modulus = f"modulus {float(warm.solid.young) / 1e9:.3g} GPa"
    warning = (
        f"The teeth of gear {gear + 1} reach {celsius(flank)} at the flank and {celsius(root)} at the "
        f"root; {modulus}."
    )
    brief, moved = f"Gear {gear + 1} is warm: root at {celsius(root)}, {modulus}.", REMARKED
    if not heat_failure(record, max(flank, root)):
        status = modulus_at(record, root).status
        warning += f" {status[:1].upper()}{status[1:]}."
        if record.young_at and flank > record.young_at[-1].temperature:
            warning += f" No modulus is known at the temperature of the flank of gear {gear + 1}."
            brief = f"Gear {gear + 1}: no modulus is known at the {celsius(flank)} of its flank."
            moved = LEFT_OUT
    return replace(warm, told=Doubt(warning, moves=moved, brief=brief), flank=flank)


@remembering
def _in_use(record: SolidRecord, key: str, temperature: float) -> SolidInUse:
    try:
        solid = _solid(record, temperature if record.young_at else None)
    except InputError as error:
        raise error.at(key=f"materials.{key}") from None
    return SolidInUse(record, solid, temperature)


@remembering
def _solid(record: SolidRecord, temperature: float | None) -> Solid:
    return record.build(temperature)


def _record(given: SolidValues | str, key: str, document: Document) -> SolidRecord:
    if isinstance(given, str):
        return solids.find(given)
    values: dict[str, Any] = {
        name: datum(value, f"materials.{key}.{name}", document)
        for name in SolidValues.model_fields
        if (value := getattr(given, name)) is not None
    }
    return SolidRecord(name=f"material of gear {key[-1]}", title=BY_VALUE, **values)
