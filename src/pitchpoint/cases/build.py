"""From a validated case to the design, the operating point and the laws that compute it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from pitchpoint.cases.built import (
    Built,
    driver_and_loaded,
    operation_at,
    without_bearing,
)
from pitchpoint.cases.document import STAGES, Document
from pitchpoint.cases.laws import Choices
from pitchpoint.cases.loss_sets import loss_sets, named_set
from pitchpoint.cases.models import (
    check_hardness,
    check_models,
    check_shapes,
    model_of_films,
    models_of,
)
from pitchpoint.cases.oils import (
    built_oil,
    check_temperature,
    half_of_a_line,
    lubricant_of,
    oil_doubts,
)
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import (
    SolidInUse,
    solids_in_use,
)
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT
from pitchpoint.core.doubts import GUESSED, Doubt, as_doubt
from pitchpoint.core.programs import bound_programs, program
from pitchpoint.efficiency.drag import drags
from pitchpoint.efficiency.quasi_static import Design
from pitchpoint.errors import Complaints
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.families import Gears, built_gears
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.input.kinds import TEMPERATURE
from pitchpoint.loading.loading_registry import LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.loading.tooth_compliance import uncovered
from pitchpoint.lubrication.lubrication_registry import (
    ChosenLaws,
)
from pitchpoint.materials import lubricants
from pitchpoint.materials.material_tables import Oil
from pitchpoint.materials.surfaces import roughness_of
from pitchpoint.registry import code_at

__all__ = ["build", "check_alone", "gears_of"]

T = TypeVar("T")
OF_STIFFNESS = ("mesh_stiffness", "mean_stiffness", "transmission_error")
"""Variables of parts for which the compliance of teeth is asked even where it shares no load."""
NO_PLASTIC = "No gear is of plastic: the tooth temperature changes nothing."


def build(case: CaseFile, document: Document, own: ChosenLaws = ()) -> Built:
    """Design and operating point of a case.

    Raises:
        InputError: a gear pair that cannot run, a temperature outside the oil's range, a law that
            does not hold for this pair; with file and key.
    """
    bound_programs()
    wrong = Complaints(document.name)
    gears = gears_of(case, wrong)
    if gears is not None and case.worn is not None:
        gears = wrong.tried(_worn, case, gears)
    used = wrong.tried(solids_in_use, case.materials, document, case.operation.temperature)
    oil = wrong.tried(lubricant_of, case.lubricant, document)
    _check_parts(case, wrong, oil, None if gears is None else gears[0], used, own)
    if wrong or oil is None or gears is None or used is None:
        raise wrong.error
    mesh, warnings = gears
    driver, loaded = driver_and_loaded(case, mesh)
    design = Design(
        mesh=mesh,
        solids=(used[0].solid, used[1].solid),
        lubricant=built_oil(oil),
        roughness=roughness_of(case.roughness),
        drag=drags(case.losses, case.bodies, {mesh.body.inner_bearing}),
        elliptic=ELLIPTIC_CONTACT[case.models.elliptic_contact],
        driver=driver,
        loaded=loaded,
    )
    doubts = [*warnings, *_yielding(case, mesh), *oil_doubts(oil)]
    doubts += half_of_a_line(case.lubricant)
    if case.dynamics is not None and not has(mesh, line_of_action):
        doubts += code_at("pitchpoint.cases.vibration_checks:inertia_of_both")(document)
    models = models_of(case, own, used, mesh)
    name = named_set(document.tree.get("losses"))
    fitted = loss_sets()[name].fitted if name else None
    point = operation_at(case.operation)
    built = Built(case, design, point, models, oil, used, tuple(doubts), fitted=fitted)
    records = [solid.record for solid in used]
    of_materials = built.family.of_materials(design.mesh, design.solids, records)
    return replace(built, told=(*doubts, *of_materials, *_left_out(built), *_extrapolated(built)))


def gears_of(case: CaseFile, wrong: Complaints) -> tuple[Mesh, tuple[str, ...]] | None:
    """Mesh of a case and what is to be said of it; None, with a complaint, where it cannot be built."""
    return wrong.under("gears").tried(built_gears, case.gears, int(case.models.slices))


def check_alone(document: Document, wrong: Complaints) -> None:
    """Complains of gears and oil that are wrong by themselves, in a file whose other tables are wrong.

    Args:
        document: with its marks.
        wrong: what is wrong with other tables; of those told already nothing more is.
    """
    tables = {"gears": document.tree.get("gears")}
    stages = document.tree.get(STAGES)
    if isinstance(stages, Mapping):
        tables |= {
            f"{STAGES}.{number}.gears": stage.get("gears")
            for number, stage in stages.items()
            if isinstance(stage, Mapping)
        }
    for key, table in tables.items():
        gears = None if wrong.of(key) else _sound(_GEARS, table)
        if gears is not None:
            wrong.under(key).tried(built_gears, gears, int(Choices().slices))
    oil = None if wrong.of("lubricant") else _sound(_OIL, document.tree.get("lubricant"))
    if oil is not None:
        wrong.tried(lubricant_of, oil, document)


_GEARS: TypeAdapter[Gears] = TypeAdapter(Gears)
_OIL = TypeAdapter(Oil)


def _sound(model: TypeAdapter[T], table: Any) -> T | None:
    """A table as the schema has it; None where it has something against it."""
    try:
        return model.validate_python(table)
    except ValidationError:
        return None


def _worn(case: CaseFile, gears: tuple[Mesh, tuple[str, ...]]) -> tuple[Mesh, tuple[str, ...]]:
    """Gears with the wear of their flanks, and what is to be said of them."""
    with_wear = code_at("pitchpoint.cases.worn:with_wear")
    mesh, warning = with_wear(gears[0], case.gears, case.worn)
    return mesh, (*gears[1], warning)


def _check_parts(
    case: CaseFile,
    wrong: Complaints,
    oil: lubricants.LubricantRecord | None,
    mesh: Mesh | None,
    used: tuple[SolidInUse, SolidInUse] | None,
    own: ChosenLaws,
) -> None:
    """Complains of what does not fit together, as far as its parts are sound.

    Args:
        case: whole.
        wrong: that has been found already.
        oil, mesh, used: None for what could not be built.
        own: friction laws in place of those of the case, if any is the user's own.
    """
    if oil is not None:
        wrong.tried(check_temperature, case.operation.temperature, oil, "operation.temperature")
        for temperature in (case.loss_map and case.loss_map.temperatures) or ():
            wrong.tried(check_temperature, temperature, oil, "loss_map.temperatures")
    if mesh is not None:
        check_shapes(case, mesh, own, wrong)
        check_models(case, mesh, wrong)
    if case.dynamics is not None and mesh is not None:
        code_at(TABLE_CHECKS["dynamics"])(case, mesh, wrong)
    if used is not None:
        wrong.tried(check_hardness, case, used)
    if case.duty is not None:
        travels = case.gears.load == "force"
        duty_inputs = code_at(TABLE_CHECKS["duty"])
        wrong.tried(duty_inputs, case.duty, case.operation.temperature, travels=travels)
    if case.strength is not None and used is not None:
        wrong.tried(code_at(TABLE_CHECKS["strength"]), case, used)
    if case.film is not None:
        wrong.tried(code_at(TABLE_CHECKS["film"]), case.film)
        if used is not None:
            wrong.tried(model_of_films, case.film, [solid.record for solid in used], None)
    if case.wear is not None and mesh is not None and used is not None:
        wrong.tried(code_at(TABLE_CHECKS["wear"]), case, mesh, used)


TABLE_CHECKS = {
    "dynamics": "pitchpoint.cases.vibration_checks:check_vibration",
    "duty": "pitchpoint.cases.built_duty:duty_inputs",
    "strength": "pitchpoint.cases.strength_choices:check_strength",
    "film": "pitchpoint.cases.height_maps:height_maps",
    "wear": "pitchpoint.cases.wear_choices:check_wear",
}
"""Places of what has something against a table that few cases have; loaded for these."""


def _extrapolated(built: Built) -> list[str]:
    """Temperatures of a case beyond those to which its set of losses was fitted."""
    if built.fitted is None:
        return []
    low, high = built.fitted
    temperatures = [built.case.operation.temperature]
    temperatures += (built.case.loss_map and built.case.loss_map.temperatures) or ()
    beyond = [
        TEMPERATURE.show(degree) for degree in sorted({*temperatures}) if not low <= degree <= high
    ]
    if not beyond:
        return []
    return [
        Doubt(
            f"The losses of the set were fitted from {TEMPERATURE.show(low)} to {TEMPERATURE.show(high)}; at "
            f"{' and '.join(beyond)} they are an extrapolation.",
            moves=GUESSED,
            about=("mean_efficiency",),
            brief=f"Losses of the set end at {TEMPERATURE.show(low)} and {TEMPERATURE.show(high)}.",
        )
    ]


def _left_out(built: Built) -> list[str]:
    """What a model leaves out, or changes nothing of."""
    heats = built.case.models.tooth_temperature != "isothermal"
    idle = heats and not any(used.plastic for used in built.solids)
    return [*without_bearing(built.places, lacks_bearing=built.lacks_bearing), *[NO_PLASTIC] * idle]


_sections = program(tooth_sections)


def _yielding(case: CaseFile, mesh: Mesh) -> tuple[str, ...]:
    """What the model of tooth compliance does not cover, where it is used."""
    sharing = LOAD_SHARING[case.models.load_sharing]
    if mesh.body.couples or (case.dynamics is None and not sharing.by_stiffness):
        return ()
    sections, model = _sections(mesh), TOOTH_COMPLIANCE[case.models.tooth_compliance]
    doubts = map(as_doubt, uncovered(model, sections, case.gears.members))
    about = () if sharing.by_stiffness else OF_STIFFNESS
    return tuple(
        Doubt(doubt, moves=doubt.moves, about=about, brief=doubt.brief) for doubt in doubts
    )
