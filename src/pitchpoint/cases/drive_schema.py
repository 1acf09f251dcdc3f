"""The schema of a case file of several meshes: stages in a row, or a train of meshes that turn together."""

from collections.abc import Mapping, Sequence
from itertools import count
from math import pi
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from pitchpoint.cases.document import STAGES, too_many
from pitchpoint.cases.laws import Choices
from pitchpoint.cases.schema import (
    CaseFile,
    DriveLosses,
    Losses,
    Source,
    check_aims,
    check_load,
    check_quadrants,
)
from pitchpoint.cases.study_tables import Issues, OptimiseTable, Studies, StudyTable, Targets
from pitchpoint.duty_cycle.duty_table import DutyTable
from pitchpoint.dynamics.vibration_tables import Dynamics
from pitchpoint.efficiency.drag_tables import Loss, check_losses
from pitchpoint.efficiency.operation_tables import Housing, LossMap, Operating
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.cylindrical.table import CylindricalGears
from pitchpoint.gears.families import GearsOfStage
from pitchpoint.gears.gears_table import DEVIATION, STIFFNESS, GearsTable
from pitchpoint.gears.planetary import PLANETARY, PLANETS, PinErrors, PlanetAngles, PlanetaryGears
from pitchpoint.input.kinds import MOST_STAGES, PLACE, Text
from pitchpoint.input.quantities import Quantity, shown, text
from pitchpoint.input.tables import Numbered, Table
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.materials.material_tables import DriveMaterials, Oil, RoughnessTable
from pitchpoint.registry import letters, nearest
from pitchpoint.results.chosen_units import Output
from pitchpoint.strength.strength_table import StrengthTable
from pitchpoint.wear.wear_tables import WearTable, WornTable

__all__ = [
    "NO_VIBRATION",
    "DriveCase",
    "StageTable",
    "TrainTable",
    "check_stage",
    "form_of",
    "is_planetary",
]


TURN = Quantity("angle", -2 * pi, 2 * pi, "deg")
BodyName = Annotated[str, BeforeValidator(lambda value: _name_of_body(value))]


def _name_of_body(value: Any) -> str:
    name = text(value)
    if not (letters(name) and name.isprintable() and len(name) <= 40):
        raise InputError(f"{shown(name)} is not a name; use 1 to 40 signs, one a letter or a digit")
    return name


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
        raise no_stage(strange[0], stages)
    if len(stages) > MOST_STAGES:
        raise InputError(too_many(len(stages), MOST_STAGES))
    return dict(sorted(stages.items()))


def no_stage(key: str, given: Mapping[str, Any]) -> InputError:
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
            wrong.tried(check_load, self, self.last)
            wrong.tried(check_quadrants, self)
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
        wrong.tried(check_aims, self.targets, self.studies, self.source, (CaseFile, DriveCase))
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
            wrong.add(InputError(NO_VIBRATION, key=f"stages.{number}.dynamics"))
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


NO_VIBRATION = (
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
    "dynamics": NO_VIBRATION,
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


def is_planetary(tree: Mapping[str, Any]) -> bool:
    """True if the gears of a case are a planetary set."""
    gears = tree.get("gears")
    return isinstance(gears, Mapping) and gears.get("family") == PLANETARY


def form_of(tree: Mapping[str, Any]) -> "type[CaseFile] | type[DriveCase]":
    """The tables that a case has, of one mesh or of several."""
    return DriveCase if STAGES in tree or is_planetary(tree) else CaseFile


def check_stage(key: str, stages: Any) -> None:
    """InputError if a key of a stage does not begin with the number of one that the case has."""
    table, *inside = key.split(".")
    if table == STAGES and inside and isinstance(stages, Mapping) and inside[0] not in stages:
        raise no_stage(inside[0], stages).at(key=key)
