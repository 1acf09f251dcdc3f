"""The schema of a case file: one table a class, every value with kind and allowed range."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    Field,
    Tag,
    ValidationInfo,
    model_validator,
)

from pitchpoint import units
from pitchpoint.cases.document import at_most
from pitchpoint.cases.laws import Choices, FrictionChoice
from pitchpoint.cases.loss_sets import expanded, named_set
from pitchpoint.cases.study_tables import (
    Issues,
    OptimiseTable,
    Studies,
    Study,
    StudyTable,
    Sweep,
    Target,
    Targets,
)
from pitchpoint.duty_cycle.duty_table import DutyTable
from pitchpoint.dynamics.vibration_tables import Dynamics
from pitchpoint.efficiency.drag_tables import Loss, check_losses
from pitchpoint.efficiency.operation_tables import Housing, LossMap, Operating
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.families import Gears
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.gears.planetary import (
    PlanetaryGears,
)
from pitchpoint.input.kinds import (
    SPEED,
    Text,
)
from pitchpoint.input.quantities import shown
from pitchpoint.input.tables import (
    Table,
    field_quantity,
    is_stated,
    quantity_of_any,
    table_by_key,
)
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.materials.material_tables import (
    Materials,
    Oil,
    RoughnessTable,
)
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.liu_xiong_torus.table import TorusFormulas
from pitchpoint.published.publication_registry import publication_of
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.zhao2022.table import ConjugateWear, FlankWear
from pitchpoint.registry import nearest
from pitchpoint.results.chosen_units import Output
from pitchpoint.results.variables import VARIABLES, places_of
from pitchpoint.strength.strength_table import StrengthTable
from pitchpoint.wear.wear_tables import WearTable, WornTable

if TYPE_CHECKING:
    from pitchpoint.cases.drive_schema import DriveCase

__all__ = ["CaseFile"]
Source = Annotated[Text, AfterValidator(lambda source: _with_its_variables(source))]


def _with_its_variables(source: str) -> str:
    """Key of a publication, whose variables may be read from now on."""
    publication_of(source)
    return source


def _of_set(value: Any, info: ValidationInfo) -> Any:
    """Losses of one mesh with those of the set that they name."""
    return expanded(value, info.data.get("gears"))


def _of_no_set(value: Any) -> Any:
    """InputError if the losses of a drive of several meshes name a set."""
    if named_set(value):
        message = "a set belongs to one mesh; name it under the stage, losses = { set = ... }"
        raise InputError(message, key="set")
    return value


Losses = Annotated[dict[str, Loss], BeforeValidator(at_most(20)), BeforeValidator(_of_set)]
"""Losses of one mesh, by value or by the name of a set."""
DriveLosses = Annotated[dict[str, Loss], BeforeValidator(at_most(20)), BeforeValidator(_of_no_set)]
Formulas = Annotated[
    Annotated[TorusFormulas, Tag("motion")]
    | Annotated[ZoneFilms, Tag("films")]
    | Annotated[FlankWear, Tag("wear")]
    | Annotated[ConjugateWear, Tag("conjugate wear")]
    | Annotated[PairInMotion, Tag("pair in motion")]
    | Annotated[PairOnPath, Tag("pair on path")],
    Field(
        discriminator=table_by_key(
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
        wrong.tried(check_aims, self.targets, self.studies, self.source, (CaseFile,))
        wrong.tried(check_load, self, self.gears)
        wrong.tried(check_losses, self.losses, self.gears.shafts, self.bodies)
        for check in (_check_meant, _check_formulas, _check_driver, check_quadrants):
            wrong.tried(check, self)
        wrong.demand_none()
        operation, models = self.operation, self.models
        driver = operation.driver if is_stated(operation, "driver") else self.gears.drivers[0]
        usual: dict[str, Any] = {
            "friction": (FrictionChoice(name=self.gears.friction),),
            "load_sharing": self.gears.load_sharing,
            "film_thickness": self.gears.film_thickness,
        }
        left = {name: value for name, value in usual.items() if not is_stated(models, name)}
        return self.model_copy(
            update={
                "operation": operation.model_copy(update={"driver": driver}),
                "models": models.model_copy(update=left),
                "dynamics": _damped(self.dynamics, self.gears.damping_ratio),
            }
        )


def _damped(dynamics: Dynamics | None, usual: float) -> Dynamics | None:
    """The table with the damping ratio that is usual for the gears where it gives none."""
    if dynamics is None or is_stated(dynamics, "damping_ratio"):
        return dynamics
    return dynamics.model_copy(update={"damping_ratio": usual})


def check_aims(
    targets: Sequence[Target],
    studies: Mapping[str, Study],
    source: str,
    models: tuple[type[BaseModel], ...],
) -> None:
    """InputError if a target reads a study that does not exist, or no place of its axis.

    Args:
        targets: of the case.
        studies: of the case by name.
        source: key of its publication.
        models: tables that have the keys which studies sweep.
    """
    wrong = Complaints()
    for position, target in enumerate(targets):
        if target.kind == "excluded" or target.part:
            continue
        if target.study not in studies:
            message = f"there is no study {shown(target.study)}{nearest(target.study, studies)}"
            wrong.add(InputError(message, key=f"targets.{position}.study"))
            continue
        try:
            _check_places(target, studies[target.study].sweep, source, models)
        except InputError as error:
            wrong.add(InputError(error.message, key=f"targets.{position}.at"))
    wrong.demand_none()


def _check_places(
    target: Target, sweep: Sweep | None, source: str, models: tuple[type[BaseModel], ...]
) -> None:
    """InputError if places are no values of the key that is swept."""
    if not target.at:
        return
    if sweep is None and (kind := _along(target.variable, source)):
        for place in target.at:
            units.parse(place, kind)
        return
    try:
        quantity = quantity_of_any(sweep.key, models) if sweep is not None else None
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


def check_load(case: "CaseFile | DriveCase", gears: GearsTable | PlanetaryGears) -> None:
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
        quantity = field_quantity(Operating.model_fields[wanted])
        assert quantity is not None
        missing = f"is missing; write {quantity.example}; {quantity.allowed}"
        raise InputError(missing, key=f"operation.{wanted}")
    if not gears.transmits and case.loss_map is not None:
        raise InputError(
            "a loss map runs over the torque of an output, which a test rig does not have; leave this "
            "table out",
            key="loss_map",
        )


def check_quadrants(case: "CaseFile | DriveCase") -> None:
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
    if is_stated(case.operation, "driver") and driver not in gears.drivers:
        fixed = (
            "is fixed and cannot drive" if driver == getattr(gears, "fixed", "") else "cannot drive"
        )
        why = fixed if driver in gears.members else "is not in this drive"
        raise InputError(
            f"{shown(driver)} {why}; use {' or '.join(gears.drivers)}",
            key="operation.driver",
        )
