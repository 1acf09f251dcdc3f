"""The schema of a case file: one table a class, every value with kind and allowed range."""

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from itertools import count
from math import pi
from typing import Annotated, Any, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    Field,
    Tag,
    ValidationError,
    ValidationInfo,
    model_validator,
)
from pydantic.fields import FieldInfo

from pitchpoint import units
from pitchpoint.cases.document import STAGES, Document, at_most, too_many
from pitchpoint.cases.laws import Choices, FrictionChoice
from pitchpoint.cases.loss_sets import expanded, named_set
from pitchpoint.cases.optimise_table import OptimiseTable
from pitchpoint.cases.study_tables import Issues, Studies, Study, StudyTable, Sweep, Target, Targets
from pitchpoint.duty_cycle.table import DutyTable
from pitchpoint.dynamics.vibration_tables import Dynamics
from pitchpoint.efficiency.drag_tables import Loss, check_losses
from pitchpoint.efficiency.operation_tables import Housing, LossMap, Operating
from pitchpoint.errors import CollectedInputError, Complaints, InputError, shorten
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.families import Gears, GearsOfStage
from pitchpoint.gears.planetary import (
    PLANETARY,
    PLANETS,
    PinErrors,
    PlanetAngles,
    PlanetaryGears,
)
from pitchpoint.gears.table import DEVIATION, STIFFNESS, GearsTable
from pitchpoint.input.kinds import (
    COEFFICIENT,
    MOST_STAGES,
    PLACE,
    SPEED,
    Text,
)
from pitchpoint.input.quantities import Quantity, shown, text
from pitchpoint.input.tables import (
    DECIDING,
    Numbered,
    Table,
    alternatives,
    by,
    fields_at,
    forms,
    holds_named_tables,
    is_stated,
    quantity_of,
)
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.materials.material_tables import (
    OF_SET,
    DriveMaterials,
    Materials,
    Oil,
    RoughnessTable,
    of_set,
)
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.liu_xiong_torus.table import TorusFormulas
from pitchpoint.published.registry import publication_of
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.zhao2022.table import ConjugateWear, FlankWear
from pitchpoint.registry import alike, letters, listed, nearest
from pitchpoint.results.chosen_units import Output
from pitchpoint.results.variables import VARIABLES, places_of
from pitchpoint.strength.strength_table import StrengthTable
from pitchpoint.wear.wear_tables import WearTable, WornTable

__all__ = [
    "CaseFile",
    "DriveCase",
    "StageTable",
    "in_form",
    "keys",
    "quantity_at",
    "usual_at",
    "validate",
    "validated",
]
TURN = Quantity("angle", -2 * pi, 2 * pi, "deg")

BodyName = Annotated[str, BeforeValidator(lambda value: _name_of_body(value))]
Source = Annotated[Text, AfterValidator(lambda source: _with_its_variables(source))]


def _name_of_body(value: Any) -> str:
    name = text(value)
    if not (letters(name) and name.isprintable() and len(name) <= 40):
        raise InputError(f"{shown(name)} is not a name; use 1 to 40 signs, one a letter or a digit")
    return name


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
        wrong.tried(check_losses, self.losses, self.gears.shafts, self.bodies)
        for check in (_check_meant, _check_formulas, _check_driver, _check_quadrants):
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
        raise InputError(too_many(len(stages), MOST_STAGES))
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
    """Stiffness of a pin and its bearing along the circle, for sharing and torsion; rigid unless given."""

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
    stages: Annotated[dict[str, StageTable], BeforeValidator(_stages), Numbered()]
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
            wrong.tried(check_losses, self.losses, turning, self.bodies, sets)
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
    if train.floating and not (train.pin_errors or train.by_tolerance):
        message = (
            "counts where pins are out of place; give pin_errors, pin_tolerance or the like, or leave it "
            "out"
        )
        wrong.add(InputError(message, key="train.floating"))


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
    if is_stated(case.operation, "driver") and driver not in gears.drivers:
        fixed = (
            "is fixed and cannot drive" if driver == getattr(gears, "fixed", "") else "cannot drive"
        )
        why = fixed if driver in gears.members else "is not in this drive"
        raise InputError(
            f"{shown(driver)} {why}; use {' or '.join(gears.drivers)}",
            key="operation.driver",
        )


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
        named = holds_named_tables(holding[0])
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
        what, fields = (
            "table" if isinstance(stated, dict) else "key",
            fields_at(detail["loc"], model),
        )
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
        return too_many(len(stated), context["max_length"])
    return f"{shown(stated)} is not allowed: {detail['msg'].lower()}"


def _as_list(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a list of quantities: what to write."""
    info = fields_at(location, model).get(str(location[-1]))
    quantity = None if info is None else quantity_of(info)
    return "" if quantity is None else f"; write [{quantity.example}]; {quantity.allowed}"


def _inner(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a table of the user's own: where it belongs."""
    *above, key = map(str, location)
    if key in fields_at((*location, ""), model):
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
        (f"{above}{name}" + f".{_ANY_NAME}" * holds_named_tables(info), form, _inside(tree, name))
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
    info = fields_at(tuple(above), model).get(above[-1]) if above else None
    sets = [PLANETARY] * (above == ["gears"])
    names = [*alternatives(info.annotation), *sets] if info else []
    return " or ".join(f"'{name}'" for name in names)


def _needed(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    fields = fields_at(location, model)
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
