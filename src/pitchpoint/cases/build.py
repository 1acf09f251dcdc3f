"""From a validated case to the design, the operating point and the laws that compute it."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import cos, isfinite, pi, sin, tan
from typing import Any

import equinox as eqx

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.document import Document
from pitchpoint.cases.laws import CASE_LAWS, FRICTION
from pitchpoint.cases.schema import TEMPERATURE, Case, Gears, Oil, Surface
from pitchpoint.cases.solids import SolidInUse, datum, heated, solids_in_use
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.efficiency.summary import heat
from pitchpoint.errors import InputError
from pitchpoint.gears.checks import check_cylindrical
from pitchpoint.gears.cylindrical import CylindricalPair, build_cylindrical_pair
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.tooth_section import ToothSection
from pitchpoint.loading.sharing import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import TOOTH_COMPLIANCE
from pitchpoint.lubrication.friction_coefficient import LAWS, FrictionLaw
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants
from pitchpoint.materials.surfaces import Roughness

__all__ = ["Built", "build", "laws_of"]

_AVAILABLE_FILLET = 0.38
USUAL_TIP = 0.25
"""Tip thickness of helical teeth that is kept where none is given, in normal modules."""
_RING_FILLET = 0.2  # fits the narrow spaces of most rings


@dataclass(frozen=True)
class Built:
    """A case ready to compute.

    Attributes:
        case: as validated.
        design, operation: what the kernels take.
        lubricant: record of the oil with the origin of its values.
        solids: of both gears, with the temperature at which they are taken.
        warnings: sentences about the design.
        own: friction law of the user's own that takes the place of those of the case.
    """

    case: Case
    design: Design
    operation: Operation
    lubricant: lubricants.LubricantRecord
    solids: tuple[SolidInUse, SolidInUse]
    warnings: tuple[str, ...]
    own: FrictionLaw | None = None

    @property
    def dimensions(self) -> dict[str, Any]:
        """Main dimensions of the mesh as plain numbers."""
        found: dict[str, Any] = jax.device_get(_dimensions(self.design.mesh))
        return found

    @property
    def pair(self) -> CylindricalPair:
        """The gear pair."""
        assert isinstance(self.design.mesh, CylindricalPair)
        return self.design.mesh


def build(case: Case, document: Document, own: FrictionLaw | None = None) -> Built:
    """Design and operating point of a case.

    Raises:
        InputError: a gear pair that cannot run, a temperature outside the oil's range, a law that
            does not hold for this pair; with file and key.
    """
    try:
        pair, warnings = _checked(case.gears, case.operation.driver, int(case.models.slices))
    except InputError as error:
        inside = (
            error.key if not error.key or error.key.startswith("gears") else f"gears.{error.key}"
        )
        raise error.at(file=document.name, key=inside or "gears") from None
    used = solids_in_use(case.materials, document, case.operation.temperature)
    record = _oil(case.lubricant, document)
    _check_temperature(case.operation.temperature, record, document, "operation.temperature")
    for temperature in (case.loss_map and case.loss_map.temperatures) or ():
        _check_temperature(temperature, record, document, "loss_map.temperatures")
    try:
        LOAD_SHARING[case.models.load_sharing].check(pair)
    except InputError as error:
        raise error.at(file=document.name, key="models.load_sharing") from None
    design = Design(
        mesh=pair,
        solids=(used[0].solid, used[1].solid),
        lubricant=_built_oil(record),
        roughness=_roughness(case.roughness),
    )
    operation = Operation(
        load=jnp.asarray(case.operation.torque),
        speed=jnp.asarray(case.operation.speed),
        temperature=jnp.asarray(case.operation.temperature),
    )
    built = Built(case, design, operation, record, used, warnings + _yielding(case, pair), own)
    return built if case.models.tooth_temperature == "isothermal" else warmed(built, document)


def warmed(built: Built, document: Document) -> Built:
    """The case with its gears at the temperature that their own loss gives them.

    Raises:
        InputError: the temperature is outside what is known of a material.
    """
    if not any(used.plastic for used in built.solids):
        text = "No gear is of plastic: the tooth temperature changes nothing."
        return replace(built, warnings=(*built.warnings, text))
    models, _ = laws_of(built)
    found = jax.device_get(heat(built.design, built.operation, models))
    figures = {name: float(value) for name, value in found.items()}
    if not all(map(isfinite, figures.values())):
        return built  # friction locks the mesh, which the computation says
    used = heated(built.case, built.design.mesh, built.solids, figures, document)
    design = replace(built.design, solids=(used[0].solid, used[1].solid))
    return replace(built, design=design, solids=used)


def laws_of(built: Built) -> tuple[Models, tuple[int, ...]]:
    """Models with every law compiled in, the first law of the case acting, and the indices of its laws.

    The laws of the library are always among them, so that cases share one compiled program: the
    spread of the fitted ones is shown beside every efficiency.
    """
    case = built.case
    chosen = [FRICTION[choice.name] for choice in case.models.friction]
    published = case.source in {law.sources[0] for law in CASE_LAWS}
    extra = CASE_LAWS if published or any(law in CASE_LAWS for law in chosen) else ()
    laws: tuple[FrictionLaw, ...] = (*LAWS, *extra)
    if built.own is not None:
        chosen, laws = [built.own], (*laws, built.own)
    indices = tuple(laws.index(law) for law in chosen)
    models = Models(
        friction=laws,
        choice=jnp.asarray(indices[0]),
        parameters=_parameters(case, laws),
        sharing=LOAD_SHARING[case.models.load_sharing],
        rolling=ROLLING_RESISTANCE[case.models.rolling_resistance],
        compliance=TOOTH_COMPLIANCE[case.models.tooth_compliance].terms,
    )
    return models, indices


def _parameters(case: Case, laws: tuple[FrictionLaw, ...]) -> dict[str, dict[str, jnp.ndarray]]:
    from pitchpoint.lubrication.conditions import arguments

    given = {choice.name: choice.parameters for choice in case.models.friction}
    return {
        law.name: {
            key: jnp.asarray(given.get(law.name, {}).get(key, default), dtype=float)
            for key, default in arguments(law.function)[1].items()
        }
        for law in laws
    }


@lru_cache(maxsize=64)
def _built_oil(record: lubricants.LubricantRecord) -> lubricants.Lubricant:
    return record.build()


@lru_cache(maxsize=256)
def _checked(gears: Gears, driver: str, slices: int) -> tuple[CylindricalPair, tuple[str, ...]]:
    """Pair and its warnings; a sweep that leaves the gears alone builds them once."""
    pair = _pair(gears, driver=2 if driver == "gear 2" else 1, slices=slices)
    return pair, (*check_cylindrical(pair), *_shortened(pair, gears))


def _least_tip(gears: Gears) -> float:
    """Tip thickness that is kept, in modules: helical teeth are few more often, and then pointed."""
    if gears.least_tip_thickness is not None:
        return gears.least_tip_thickness
    return USUAL_TIP if gears.helix_angle > 0.0 else 0.0


def _shortened(pair: CylindricalPair, gears: Gears) -> list[str]:
    """What was taken off tips that nobody asked to shorten."""
    if gears.least_tip_thickness is not None:
        return []
    kept = float(pair.clearance_keeping_tip_alteration)
    return [
        f"The tip of gear {number} would be thinner than {USUAL_TIP:g} modules and is shortened by "
        f"{kept - float(pair.tip_alteration[number - 1]):.3g} modules; least_tip_thickness sets the limit."
        for number, short in enumerate(pair.shortened, 1)
        if short
    ]


def _yielding(case: Case, pair: CylindricalPair) -> tuple[str, ...]:
    """What the model of tooth compliance does not cover, where it is used."""
    sharing = LOAD_SHARING[case.models.load_sharing]
    if case.dynamics is None and not sharing.by_stiffness:
        return ()
    return TOOTH_COMPLIANCE[case.models.tooth_compliance].warnings(_sections(pair))


@eqx.filter_jit
def _dimensions(mesh: Mesh) -> dict[str, Any]:
    return mesh.dimensions()


@eqx.filter_jit
def _sections(pair: CylindricalPair) -> tuple[ToothSection, ToothSection]:
    return pair.sections


def _pair(gears: Gears, driver: int, slices: int) -> CylindricalPair:
    dedendum = gears.dedendum or (gears.addendum[0] + 0.25, gears.addendum[1] + 0.25)
    fillet = gears.fillet_radius or tuple(
        _RING_FILLET
        if teeth < 0
        else min(_AVAILABLE_FILLET, _largest_fillet(depth, gears.pressure_angle))
        for teeth, depth in zip(gears.teeth, dedendum, strict=True)
    )
    pair = build_cylindrical_pair(
        teeth=(int(gears.teeth[0]), int(gears.teeth[1])),
        module=gears.module,
        pressure_angle=gears.pressure_angle,
        helix_angle=gears.helix_angle,
        face_width=gears.face_width,
        profile_shift=gears.profile_shift,
        addendum=gears.addendum,
        dedendum=dedendum,
        fillet_radius=(fillet[0], fillet[1]),
        tip_alteration=gears.tip_alteration,
        least_tip=_least_tip(gears),
        centre_distance=gears.centre_distance,
        driver=driver,
        right_flank=gears.flank == "right",
        slices=slices,
    )
    if gears.bore_diameter is None:
        return pair
    return replace(pair, rim_ratio=jnp.asarray(_rim_ratios(pair, gears.bore_diameter)))


def _rim_ratios(pair: CylindricalPair, bores: tuple[float, float]) -> list[float]:
    """Root over bore radius of each gear; of a ring its outer radius over the root radius."""
    found = []
    for number, (gear, bore) in enumerate(zip(pair.gears, bores, strict=True), 1):
        root = 2.0 * abs(float(gear.root_radius))
        ratio = bore / root if gear.internal else root / bore
        if ratio <= 1.0:
            side = "larger" if gear.internal else "smaller"
            raise InputError(
                f"the bore diameter of gear {number} is {1e3 * bore:.6g} mm; it must be {side} than "
                f"its root circle, {1e3 * root:.6g} mm",
                key="bore_diameter",
            )
        found.append(ratio)
    return found


def _largest_fillet(dedendum: float, angle: float) -> float:
    """Corner rounding of the rack that leaves no flat on its tip, in modules (ISO 53)."""
    return max((pi / 4 - dedendum * tan(angle)) * cos(angle) / (1.0 - sin(angle)), 0.0)


def _oil(oil: Oil, document: Document) -> lubricants.LubricantRecord:
    values = {
        "nu_1": oil.viscosity_40,
        "nu_2": oil.viscosity_100,
        "density_15": oil.density,
        "density_slope": oil.density_slope,
        "lubricant_factor": oil.lubricant_factor,
        "T_min": oil.temperature_min,
        "T_max": oil.temperature_max,
    }
    if oil.pressure_viscosity is not None:
        values["gold_s"], values["gold_t"] = lubricants.constant_alpha(oil.pressure_viscosity)
    given = {
        key: datum(value, f"lubricant.{_OIL_KEYS[key]}", document)
        for key, value in values.items()
        if value is not None
    }
    try:
        if oil.name is not None:
            found: dict[str, Any] = dict(given)
            return replace(lubricants.find(oil.name), **found)
        assert oil.base is not None
        data = {**lubricants.base_oils()[oil.base], **given}
        return lubricants.LubricantRecord(
            name="oil by value", title=f"{oil.base} oil by value", base=oil.base, **data
        )
    except InputError as error:
        key = _OIL_KEYS.get((error.key or "").rsplit(".", 1)[-1], "")
        message = error.message
        for name, word in _OIL_KEYS.items():
            message = message.replace(name, word)
        where = f"lubricant.{key}".rstrip(".")
        raise InputError(message, file=document.name, key=where) from None


_OIL_KEYS = {
    "nu_1": "viscosity_40",
    "nu_2": "viscosity_100",
    "density_15": "density",
    "density_slope": "density_slope",
    "gold_s": "pressure_viscosity",
    "gold_t": "pressure_viscosity",
    "lubricant_factor": "lubricant_factor",
    "T_min": "temperature_min",
    "T_max": "temperature_max",
}


def _check_temperature(
    temperature: float, oil: lubricants.LubricantRecord, document: Document, key: str
) -> None:
    low, high = oil.T_min.value, oil.T_max.value
    if not low <= temperature <= high:
        allowed = replace(TEMPERATURE, low=low, high=high).allowed
        raise InputError(
            f"{TEMPERATURE.show(temperature)} is outside the range of {oil.name}; {allowed}",
            file=document.name,
            key=key,
        )


def _roughness(surface: Surface) -> Roughness:
    if surface.ra is not None:
        return Roughness.from_ra(*surface.ra)
    if surface.rq is not None:
        return Roughness.from_rq(*surface.rq)
    assert surface.composite_rq is not None
    return Roughness.from_composite_rq(surface.composite_rq)
