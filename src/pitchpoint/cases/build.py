"""From a validated case to the design, the operating point and the laws that compute it."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache, reduce
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeVar

import numpy as np
from pydantic import TypeAdapter, ValidationError

from pitchpoint._jax import array, jax, jnp
from pitchpoint.brief import brief
from pitchpoint.cases.document import STAGES, Document
from pitchpoint.cases.drive_schema import StageTable
from pitchpoint.cases.laws import FRICTION, Choices
from pitchpoint.cases.loss_sets import loss_sets, named_set
from pitchpoint.cases.remembered import remembering
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import (
    SolidInUse,
    datum,
    failures,
    fitted_on_steel,
    grown,
    heated,
    heating,
    solids_in_use,
    surrounded,
)
from pitchpoint.contact.contacts import TOUCH, Shape
from pitchpoint.contact.registry import ELLIPTIC_CONTACT, USUAL_ELLIPSE
from pitchpoint.contact.surface import Surfaces
from pitchpoint.doubts import GUESSED, Doubt, as_doubt
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.dynamics.vibration_tables import Dynamics
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.drag_tables import Loss, bearings_of
from pitchpoint.efficiency.operation_tables import Operating
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation
from pitchpoint.efficiency.registry import BEARING_LOSS, BREAKAWAY
from pitchpoint.efficiency.running_torque import no_load_torque, torques_at_rest
from pitchpoint.efficiency.summary import engaged, summarise
from pitchpoint.efficiency.warm_teeth import balance
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.bodies import main_dimensions, plain_inertia
from pitchpoint.gears.contact_lines import line_of_action, pitch_point
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.families import Gears, built_gears, family_of
from pitchpoint.gears.family import Family, Followed
from pitchpoint.gears.mesh import Mesh, coordinates_of, has
from pitchpoint.gears.nominal_motion import (
    mesh_ends,
    nominal_motion,
    nominal_period,
    phase_sense,
    ratio_dimension,
)
from pitchpoint.gears.pairs import touching, way
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.input.kinds import FORCE, TEMPERATURE, TORQUE
from pitchpoint.input.quantities import Quantity
from pitchpoint.loading.reactions import Bearing, InnerBearing
from pitchpoint.loading.registry import LOAD_SHARING, TOOTH_COMPLIANCE
from pitchpoint.loading.sharing import demand_sharing
from pitchpoint.loading.tooth_compliance import Terms, terms_of, uncovered
from pitchpoint.lubrication.applicability import applies
from pitchpoint.lubrication.conditions import FILM, Law, arguments, demand_shape
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.inlet_heating import Inlet, with_inlet_heating
from pitchpoint.lubrication.registry import (
    ASPERITY_LOAD,
    BOUNDARY,
    FILM_THICKNESS,
    INLET_HEATING,
    LAWS,
    ROLLING_RESISTANCE,
    AsperityLoad,
    ChosenLaws,
    FilmThickness,
    FrictionLaw,
)
from pitchpoint.materials import lubricants
from pitchpoint.materials.data import Datum
from pitchpoint.materials.material_tables import Oil, RoughnessTable
from pitchpoint.materials.solids import SolidRecord, reduced_modulus
from pitchpoint.materials.surfaces import Roughness
from pitchpoint.programs import bound_programs, program
from pitchpoint.results.variable import End
from pitchpoint.status import Code, Status

if TYPE_CHECKING:
    from pitchpoint.cases.strength import Rated
    from pitchpoint.efficiency.mesh_link import MeshLink
    from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = [
    "ALONE",
    "BEARING_FREE",
    "FILM_SOLVERS",
    "TEETH_ALONE",
    "Built",
    "MemberMotion",
    "MeshPeriod",
    "build",
    "check_alone",
    "covered",
    "drags",
    "ends_of",
    "gears_of",
    "held_by",
    "operation_at",
    "without_bearing",
]

T = TypeVar("T")

ALONE = "teeth alone: bearings, seals and grease are not in it"
"""What an efficiency is of where a case has no losses beside the teeth."""

LACKING = "bearing of the wave generator"
"""What an efficiency lacks to be that of a drive where no loss stands for the bearing inside it."""

TEETH_ALONE = Doubt(
    "The efficiency is that of the teeth alone: the case has no [losses], by which bearings, seals and "
    'churning take their part; losses = { set = "strain_wave_component" } has those of such a drive.',
    moves=GUESSED,
    about=("mean_efficiency",),
    brief="The efficiency is that of the teeth alone: the case has no [losses].",
)
BEARING_FREE = Doubt(
    "The efficiency leaves out the bearing on which the teeth press inside the drive: no place of [losses] "
    "is between its two bodies.",
    moves=GUESSED,
    about=("mean_efficiency",),
    brief="The efficiency leaves out the bearing on which the teeth press.",
)
OF_STIFFNESS = ("mesh_stiffness", "mean_stiffness", "transmission_error")
"""Variables of parts for which the compliance of teeth is asked even where it shares no load."""

UNSETTLED = Doubt(
    "Heat, modulus and friction of the teeth found no balance: their temperatures are those of the last "
    "pass.",
    brief="The temperature of the teeth found no balance.",
)
NO_PLASTIC = "No gear is of plastic: the tooth temperature changes nothing."


class MeshPeriod(NamedTuple):
    """After what a stage is as it was.

    Attributes:
        period: angle of its driver, or of the phase of a train [rad, or m of what travels].
        pitch: what the period is called.
        against: why time runs against the phase; empty where it does not.
    """

    period: float
    pitch: str
    against: str = ""


class MemberMotion(NamedTuple):
    """How a member of a mesh moves in its drive, for a radian of the input in a second.

    Attributes:
        body: its name in the drive; members of several meshes that are one gear have one name.
        rate: about its axis, or of what travels along it, from the housing [rad/s or m/s].
        copies: how many of it there are.
        orbit: speed of its axis about that of its carrier [m/s].
        carrier: that bears its axis, or the housing.
    """

    body: str
    rate: float
    copies: int = 1
    orbit: float = 0.0
    carrier: str = HOUSING

    def in_stage(self, number: int, rate: float) -> "MemberMotion":
        """The member as that of a stage of a drive whose driver turns at this rate [rad/s]."""
        of_stage = f"stage {number}: "
        return MemberMotion(
            of_stage + self.body,
            self.rate * rate,
            self.copies,
            self.orbit * abs(rate),
            HOUSING if self.carrier == HOUSING else of_stage + self.carrier,
        )


@dataclass(frozen=True, eq=False)
class Built:
    """A case ready to compute.

    Attributes:
        case: as validated.
        design, operation: what the kernels take.
        models: laws that act together, once under each friction law of the case; they share programs.
        lubricant: record of the oil with the origin of its values.
        solids: of both gears, with the temperature at which they are taken.
        told: sentences about the design.
        warming: what became of the balance of heat, modulus and friction; None where nothing warms up.
        fitted: temperatures between which the named set of losses was fitted [K]; None without one.
    """

    case: CaseFile
    design: Design
    operation: Operation
    models: tuple[Models, ...]
    lubricant: lubricants.LubricantRecord
    solids: tuple[SolidInUse, SolidInUse]
    told: tuple[str, ...]
    warming: Status | None = None
    fitted: tuple[float, float] | None = None

    numbers: ClassVar[tuple[int, ...]] = ()
    stages: ClassVar[tuple[()]] = ()
    documents: ClassVar[tuple[()]] = ()
    stage_bodies: ClassVar[tuple[()]] = ()
    trains: ClassVar[Mapping[int, Any]] = {}
    planets: ClassVar[int] = 0
    on_strength: ClassVar[tuple[()]] = ()
    on_load_factors: ClassVar[tuple[()]] = ()
    """Its file has no stages, and so nothing that is of several meshes, see `BuiltDrive`."""
    mesh_numbers: ClassVar[tuple[int, ...]] = (0,)
    mesh_labels: ClassVar[tuple[int | str, ...]] = ("",)
    mesh_own_friction: ClassVar[tuple[bool, ...]] = (False,)
    copies: ClassVar[tuple[int, ...]] = (1,)
    """Its only mesh needs no label, and its friction law is that of the case."""

    def __repr__(self) -> str:
        return brief(self)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about gears that are too hot, and about the design."""
        lost = self.warming is not None and int(self.warming.code) == Code.NOT_CONVERGED
        return (*failures(self.solids), *[UNSETTLED] * lost, *self.told)

    @cached_property
    def warmed(self) -> "Built":
        """The case with its gears at the temperature that their own loss gives them.

        Raises:
            InputError: the temperature is outside what is known of a material.
        """
        case = self.case
        cool = surrounded(self.solids, case.operation.temperature)
        if case.models.tooth_temperature == "isothermal" or not any(used.plastic for used in cool):
            return self
        cold = _of_solids(self, cool)
        arguments = cold.design, cold.operation, cold.models[0], heating(case, cool)
        balanced = jax.device_get(balance(*arguments))
        warmed = replace(cold, warming=balanced.status)
        if int(balanced.status.code) == Code.LOCKED:
            return warmed  # friction locks the mesh, which the computation says
        loss = {name: float(getattr(balanced, name)) for name in ("mean_friction", "loss_factor")}
        return _of_solids(warmed, heated(case, cold.design, cool, loss))

    @property
    def heated(self) -> list[str]:
        """Sentences on teeth that their own loss warms, and on what is left out of teeth of plastic."""
        plastic = [number for number, used in enumerate(self.solids, 1) if used.plastic]
        warnings: list[str] = [used.told for used in self.solids if used.told]
        if not plastic:
            return warnings
        names = [law.name for law in self.laws if law.largest == BOUNDARY]
        warnings += [fitted_on_steel(names, plastic)] if names else []
        if {"circumferential_backlash", "centre_distance"} <= {*self.dimensions}:
            angle, teeth = (getattr(self.case.gears, key) for key in ("pressure_angle", "teeth"))
            distance = float(self.dimensions["centre_distance"])
            warnings += grown(self.solids, tuple(teeth), float(angle), distance)
        return warnings

    @property
    def laws(self) -> list[FrictionLaw]:
        """Friction laws of the case, in order."""
        return [models.law for models in self.models]

    @property
    def film(self) -> FilmThickness:
        """The film law of the case, with the heat in the inlet."""
        return _inlet(FILM_THICKNESS[self.case.models.film_thickness], self.case.models)

    @cached_property
    def film_model(self) -> "FilmModel | None":
        """How films of the contacts are solved; None where no table, law or wear asks for them."""
        table, wear = self.case.film, self.case.wear
        if table is None and (wear is None or wear.load_ratio == "formula"):
            return next((law.films for law in self.laws if law.films is not None), None)
        solids = [used.record for used in self.solids]
        usual = FilmTable(solver="line")
        return _film_model(table or usual, solids, tooth_size(self.design.mesh))

    @property
    def asperities(self) -> AsperityLoad | None:
        """The law of the load on asperities; None without one."""
        law = ASPERITY_LOAD[self.case.models.asperity_load]
        return None if law.name == "none" else law

    @property
    def rated(self) -> "Rated":
        """The case as a rating of its strength takes it."""
        from pitchpoint.cases.strength import rated_case

        return rated_case(self.case, self.solids, self.lubricant, self.design.roughness)

    @property
    def law_names(self) -> list[str]:
        """Names of the friction laws."""
        return [law.name for law in self.laws]

    @property
    def meshes(self) -> "tuple[Built, ...]":
        """Meshes that the case has: itself."""
        return (self,)

    @property
    def driver(self) -> str:
        """Name of the member that drives."""
        return self.case.operation.driver

    @property
    def motion(self) -> list[float]:
        """Rates of the members for a radian of the driver."""
        rates: list[float] = self.nominal["motion"].tolist()
        return rates

    @property
    def places(self) -> list[str]:
        """Names of the places beside the teeth where power is lost."""
        return [*self.case.losses]

    @property
    def rates_bearings(self) -> bool:
        """True if a bearing has its dynamic load rating, by which its life is known."""
        return any(loss.dynamic_load_rating is not None for loss in self.case.losses.values())

    @property
    def with_losses(self) -> "tuple[Built, ...]":
        """Itself: all that has losses beside the teeth, see `BuiltDrive.with_losses`."""
        return (self,)

    @property
    def planet_bodies(self) -> tuple[str, ...]:
        """Bodies of which there are several: none."""
        return ()

    @property
    def explored(self) -> tuple[str, Any]:
        """Table of gears by which an explorer changes the case, with its key."""
        return "gears", self.case.gears

    @property
    def averaging(self) -> str:
        """What averages run over."""
        return self.case.models.averaging

    @property
    def steps(self) -> np.ndarray:
        """Torque on the loaded member of its mesh for a unit at the output."""
        return np.ones(1)

    @property
    def at_work(self) -> "tuple[Built, ...]":
        """Meshes under the torques that they carry with all losses: itself."""
        return (self,)

    def carried_by_meshes(self, _: Mapping[str, np.ndarray]) -> np.ndarray:
        """Torque on the loaded member of its mesh with all losses: its load."""
        return np.array([self.case.operation.load])

    @staticmethod
    def figures_of(
        points: "Sequence[tuple[Design, Operation]]",
        models: Models,
        progress: Callable[[int], None] | None = None,
    ) -> dict[str, np.ndarray]:
        """Figures of operating points of designs of equal static structure, see `summarise`."""
        return summarise(points, models, progress)

    def no_load_torques(self, points: Operation) -> list[np.ndarray]:
        """Torque of the driver that runs without load [*b], by each friction law, see `no_load_torque`."""
        unloaded = self._engaged_under(0.0)
        return [
            np.asarray(no_load_torque(self.design, points, models, unloaded))
            for models in self.models
        ]

    def torques_at_rest(self, points: Operation) -> list[tuple[np.ndarray, np.ndarray]]:
        """Mean and largest torque of the driver that starts the mesh, by each law, see `torques_at_rest`.

        Args:
            points: operating points [*b] under one load; laws that solve films have NaN there.
        """
        unloaded, nothing = (
            self._engaged_under(points.load.ravel()[0]),
            np.full(points.load.shape, np.nan),
        )
        torques = [
            (nothing, nothing)
            if models.law.films
            else torques_at_rest(self.design, points, models, unloaded)
            for models in self.models
        ]
        return [(np.asarray(mean), np.asarray(largest)) for mean, largest in torques]

    def _engaged_under(self, load: Any) -> Engagement | None:
        return engaged(self.design, replace(self.operation, load=array(load)), self.models[0])

    @property
    def drags(self) -> tuple[Drag, ...]:
        """Places beside the teeth where power is lost."""
        return self.design.drag

    def held_otherwise(self, way: float) -> "Built":
        """The drive with what holds it at rest at the upper end (1) or the lower one (-1) of its spread."""
        drag = held_by(self.design.drag, self.case.losses, way)
        return replace(self, design=replace(self.design, drag=drag))

    @property
    def applicable(self) -> list[FrictionLaw]:
        """Fitted friction laws of the library that hold for these contacts."""
        return [law for law in LAWS if law.sources and applies(law, self.design.mesh) is None]

    @property
    def temperatures(self) -> tuple[float, float]:
        """Lowest and highest temperature of the oil [K]."""
        return self.lubricant.T_min.value, self.lubricant.T_max.value

    @property
    def terms(self) -> Terms:
        """Terms of the model by which teeth yield."""
        return self.models[0].compliance

    def under(self, laws: Sequence[FrictionLaw]) -> tuple[Models, ...]:
        """The models of the case under other friction laws, with the parameters of their formulas."""
        return _under(laws, self.models[0], {})

    @property
    def dimensions(self) -> dict[str, Any]:
        """Main dimensions of the mesh as plain numbers."""
        return self._of_mesh["dimensions"]

    @property
    def nominal(self) -> dict[str, Any]:
        """Nominal motion, driver, loaded member, period, sense and events of the mesh, as plain numbers.

        The speed of its pitch circles, zero where it has none, is for a unit rate of the driver.
        """
        return self._of_mesh["nominal"]

    @cached_property
    def modulus(self) -> float:
        """Reduced modulus E' of the solids [Pa]."""
        return float(_modulus(*self.design.solids))

    @cached_property
    def _of_mesh(self) -> dict[str, dict[str, Any]]:
        figures: dict[str, dict[str, Any]] = jax.tree.map(
            np.asarray, _numbers(self.design.mesh, self.design.driver, self.design.loaded)
        )
        return figures

    @property
    def family(self) -> Family:
        """What a case asks of the family of its gears."""
        return family_of(type(self.case.gears))

    @property
    def following(self) -> dict[str, Any]:
        """Values that the table of the gears leaves open, by key inside it."""
        return self.family.following(self.case.gears, self.design.mesh)

    @property
    def assumed(self) -> dict[str, Followed]:
        """Those of them that rest on assumed proportions."""
        followed = self.following.items()
        return {
            key: source
            for key, source in followed
            if isinstance(source, Followed) and source.status == "assumed" and self._open(key)
        }

    def _open(self, key: str) -> bool:
        """True if the table of the gears leaves a value open."""
        return reduce(getattr, key.split("."), self.case.gears) is None

    @cached_property
    def deviations(self) -> Surfaces:
        """Deviations of the teeth around both members, which make the kinematic error."""
        return self.family.deviations(self.case.gears, self.design.mesh)

    @cached_property
    def engaged(self) -> Engagement | None:
        """Contacts and shares at the operating point of a mesh whose own take long, for all that ask."""
        return engaged(self.design, self.operation, self.models[0])

    @property
    def transmits(self) -> bool:
        """True if the loaded coordinate moves, so that power goes through; False for a test rig."""
        return bool(self.nominal["loaded"] @ self.nominal["motion"])

    @property
    def output_rate(self) -> float:
        """Rate of the loaded member for a unit rate of the driver, without sign."""
        return abs(float(self.nominal["loaded"] @ self.nominal["motion"]))

    @cached_property
    def ends(self) -> tuple[float, float]:
        """Rates of the driver and of the loaded member, in the sense that presses the flanks that touch."""
        driver_rate, loaded_rate = (
            float(self.nominal[end] @ self.nominal["motion"]) for end in _ENDS
        )
        return driver_rate, loaded_rate

    @property
    def step(self) -> float:
        """Rate of the loaded member for a unit rate of the driver."""
        return self.ends[1] / self.ends[0]

    @property
    def sense(self) -> float:
        """Sense of the driver by which the flanks touch that do."""
        return float(np.sign(self.ends[0]))

    @property
    def member_motions(self) -> tuple[tuple[MemberMotion, ...], ...]:
        """Motion of the members of its mesh, in the order of its coordinates."""
        rates = (self.nominal["motion"] / self.ends[0]).tolist()
        coordinates = zip(self.bodies, rates, strict=True)
        return (tuple(MemberMotion(coordinate.body, rate) for coordinate, rate in coordinates),)

    @property
    def period(self) -> MeshPeriod:
        """After what the mesh is as it was."""
        words, backwards = way(self.design.mesh), self.nominal["onward"] < 0.0
        against = words.against.format(self.driver) if backwards else ""
        return MeshPeriod(float(self.nominal["period"]), words.pitch, against)

    def periods_per_turn(self, end: End) -> float:
        """Mesh periods in a turn of the driver or of the loaded member."""
        rate = abs(float(self.nominal[end] @ self.nominal["motion"]))
        return 2.0 * pi / (float(self.nominal["period"]) * rate)

    def on_shafts(self, first: int, free: int) -> dict[str, int]:
        """Shaft of a drive for each member; one that is held has a number of its own.

        Args:
            first: number of the shaft that drives; that which it loads is the next one.
            free: number of the first member that is held.
        """
        coordinates: dict[str, int] = {}
        for number, name in enumerate(self.case.gears.members):
            drives, loaded = (self.nominal[end][number] for end in _ENDS)
            coordinates[name] = first if drives else first + 1 if loaded else free
            free += not (drives or loaded)
        return coordinates

    def link(self, shafts: tuple[int, ...], table: StageTable) -> "MeshLink":
        """The mesh as a link of a drive, see `on_shafts`, where the table of its stage places it."""
        from pitchpoint.efficiency.mesh_link import MeshLink  # which one mesh alone is not

        return MeshLink(self.design, shafts, array(table.turn), array(table.place))

    @property
    def inner_bearing(self) -> frozenset[str]:
        """Bodies between which a bearing is on which the teeth press inside the drive; none of most."""
        return frozenset(self.design.mesh.body.inner_bearing)

    @cached_property
    def bodies(self) -> tuple[Coordinate, ...]:
        """Coordinates of the mesh without their places."""
        return coordinates_of(self.design.mesh)

    @cached_property
    def travels(self) -> frozenset[End]:
        """Those of driver and loaded member that travel in place of turning."""
        return frozenset(
            end for end in _ENDS if not self.bodies[int(self.nominal[end].argmax())].turns
        )

    @property
    def way(self) -> dict[str, str | float]:
        """Words of the way of a pair, as attributes of places on it."""
        touching = [body.body for body in self.bodies if body.member is not None]
        return way(self.design.mesh).attributes(touching)

    @property
    def carried(self) -> Quantity:
        """What the loaded member takes, torque or force."""
        return FORCE if "loaded" in self.travels else TORQUE

    @property
    def covers(self) -> dict[str, str]:
        """What the efficiency is of, as an attribute, where it is less than a whole drive."""
        if not self.case.gears.transmits:
            return {}
        return covered(self.places, lacks_bearing=self.lacks_bearing)

    @property
    def lacks_bearing(self) -> bool:
        """True where teeth press on a bearing inside the drive, and no loss of the case stands for it."""
        inner = self.inner_bearing
        spans = (frozenset(loss.between) for loss in self.case.losses.values())
        return bool(inner) and inner not in spans

    @property
    def loaded(self) -> str:
        """Name of the member that carries the load."""
        return self.case.gears.members[int(self.nominal["loaded"].argmax())]

    @cached_property
    def backwards(self) -> "Built":
        """The same drive with its loaded member driving at its own speed.

        It carries the power to the former driver that the drive takes without loss. What follows from
        the operating point, such as the temperature of plastic teeth, follows from this one.
        """
        driver, loaded = (self.nominal[name] @ self.nominal["motion"] for name in _ENDS)
        step = abs(float(driver / loaded))
        point = self.case.operation
        load = "force" if "driver" in self.travels else "torque"
        changes: dict[str, Any] = {"driver": self.loaded, "torque": None, "force": None}
        changes |= {load: point.load / step, "speed": point.speed / step}
        point = point.model_copy(update=changes)
        turned = replace(
            self,
            case=self.case.model_copy(update={"operation": point}),
            design=self.design.backwards,
            operation=operation_at(point),
        )
        return turned.warmed

    def carrying(self, load: float) -> "Built":
        """The same under another load, with what follows from it, such as the temperature of plastic teeth.

        Args:
            load: torque or force that the loaded member carries [N m or N].
        """
        if load == self.case.operation.load:
            return self
        point = self.case.operation.model_copy(update={self.case.gears.load: load})
        case = self.case.model_copy(update={"operation": point})
        return replace(self, case=case, operation=operation_at(point)).warmed


_ENDS: tuple[End, ...] = ("driver", "loaded")


def ends_of(case: CaseFile, mesh: Mesh) -> tuple[float, float]:
    """Rates of the driver and of the loaded member of a mesh."""
    ends = jax.device_get(_ends(case, mesh))
    motion = np.asarray(nominal_motion(jax.device_get(mesh), *ends))
    driver_rate, loaded_rate = (float(end @ motion) for end in ends)
    return driver_rate, loaded_rate


def _ends(case: CaseFile, mesh: Mesh) -> tuple[jax.Array, jax.Array]:
    """Who drives and who is loaded, see `mesh_ends`."""
    driver, gears = case.operation.driver, case.gears
    return mesh_ends(mesh, driver, gears.loaded_member(driver), gears.members)


def operation_at(point: Operating) -> Operation:
    """Operating point as the kernels take it."""
    return Operation(array(point.load), array(point.speed), array(point.temperature))


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
    oil = wrong.tried(_lubricant, case.lubricant, document)
    _check_parts(case, wrong, oil, None if gears is None else gears[0], used, own)
    if wrong or oil is None or gears is None or used is None:
        raise wrong.error
    mesh, warnings = gears
    driver, loaded = _ends(case, mesh)
    design = Design(
        mesh=mesh,
        solids=(used[0].solid, used[1].solid),
        lubricant=_built_oil(oil),
        roughness=_roughness(case.roughness),
        drag=drags(case.losses, case.bodies, {mesh.body.inner_bearing}),
        elliptic=ELLIPTIC_CONTACT[case.models.elliptic_contact],
        driver=driver,
        loaded=loaded,
    )
    doubts = [*warnings, *_yielding(case, mesh), *_of_oil(oil)]
    doubts += _half_of_a_line(case.lubricant)
    if case.dynamics is not None and not has(mesh, line_of_action):
        doubts += _inertia_of_both(document)
    models = _models(case, own, used, mesh)
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
        wrong.tried(_lubricant, oil, document)


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
    from pitchpoint.cases.worn import with_wear

    assert case.worn is not None
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
        wrong.tried(_check_temperature, case.operation.temperature, oil, "operation.temperature")
        for temperature in (case.loss_map and case.loss_map.temperatures) or ():
            wrong.tried(_check_temperature, temperature, oil, "loss_map.temperatures")
    if mesh is not None:
        _check_shapes(case, mesh, own, wrong)
        _check_models(case, mesh, wrong)
    if used is not None:
        wrong.tried(_check_hardness, case, used)
    if case.duty is not None:
        from pitchpoint.cases.duty import duty_inputs

        travels = case.gears.load == "force"
        wrong.tried(duty_inputs, case.duty, case.operation.temperature, travels=travels)
    if case.strength is not None and used is not None:
        from pitchpoint.cases.strength import check_strength

        wrong.tried(check_strength, case, used)
    if case.film is not None:
        _check_films(case.film, used, wrong)
    if case.wear is not None and mesh is not None and used is not None:
        from pitchpoint.cases.wear import check_wear

        wrong.tried(check_wear, case, mesh, used)


def _check_films(
    table: FilmTable, used: tuple[SolidInUse, SolidInUse] | None, wrong: Complaints
) -> None:
    from pitchpoint.cases.height_maps import height_maps

    wrong.tried(height_maps, table)
    if used is not None:
        wrong.tried(_film_model, table, [solid.record for solid in used], None)


def _film_model(table: FilmTable, solids: Sequence[SolidRecord], size: float | None) -> "FilmModel":
    """How films are solved; loaded with what solves them, which few cases ask for."""
    from pitchpoint.cases.films import film_model

    return film_model(table, solids, size)


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


def covered(places: Sequence[str], *, lacks_bearing: bool) -> dict[str, str]:
    """Attributes on what an efficiency is of, and on what it lacks; none where it is of a whole drive.

    Args:
        places: beside the teeth where power is lost, by name.
        lacks_bearing: True if the bearing inside a drive is none of them.
    """
    lacks = {"lacks": LACKING} if lacks_bearing else {}
    if not places:
        return {"covers": ALONE, **lacks}
    some = f"teeth, {', '.join(places)}: the bearing inside the drive is not in it".replace(
        "_", " "
    )
    return {"covers": some, **lacks} if lacks_bearing else {}


def without_bearing(places: Sequence[str], *, lacks_bearing: bool) -> list[str]:
    """Sentence on a drive, of one mesh or several, whose inner bearing loses nothing."""
    return [BEARING_FREE if places else TEETH_ALONE] * lacks_bearing


def _of_solids(built: Built, used: tuple[SolidInUse, SolidInUse]) -> Built:
    """The case with its gears of these solids."""
    design = replace(built.design, solids=(used[0].solid, used[1].solid))
    return replace(built, design=design, solids=used)


def _models(
    case: CaseFile, own: ChosenLaws, used: Sequence[SolidInUse], mesh: Mesh
) -> tuple[Models, ...]:
    """Models under each law of the case, or under those among which the user's own are."""
    laws = [
        _beside_film(law, case) if isinstance(law, FrictionLaw) else _law(law, case, used, mesh)
        for law in own or [choice.name for choice in case.models.friction]
    ]
    if any(law.films is not None for law in laws):
        return _under(laws, _common(case.models), _given(case.models))
    return _under_formulas(tuple(laws), case.models)


def _beside_film(own: FrictionLaw, case: CaseFile) -> FrictionLaw:
    """A law of the user's own, with the film law of the case where it asks for a film."""
    wanted, _ = arguments(own.function)
    if own.film is not None or not {*FILM} & {*wanted}:
        return own
    return _of_film(own, _inlet(FILM_THICKNESS[case.models.film_thickness], case.models))


@lru_cache(maxsize=64)
def _of_film(own: FrictionLaw, film: FilmThickness) -> FrictionLaw:
    """One record for each pair: another one of the same content would be another program."""
    return replace(own, film=film)


@remembering
def _under_formulas(laws: tuple[FrictionLaw, ...], choices: Choices) -> tuple[Models, ...]:
    return _under(laws, _common(choices), _given(choices))


def _given(choices: Choices) -> dict[str, Mapping[str, float]]:
    """Parameters of friction laws that the case gives, by name of the law."""
    return {choice.name: choice.parameters for choice in choices.friction}


def _common(choices: Choices) -> Models:
    """Models without a friction law."""
    return Models(
        friction=(),
        choice=array(0),
        parameters={},
        sharing=LOAD_SHARING[choices.load_sharing],
        rolling=_inlet(ROLLING_RESISTANCE[choices.rolling_resistance], choices),
        compliance=terms_of(choices.tooth_compliance, choices.line_stiffness),
        film=_inlet(FILM_THICKNESS[choices.film_thickness], choices),
    )


def _inlet(law: Inlet, choices: Choices) -> Inlet:
    """A law of film or of rolling resistance with the heat in the inlet that the case asks for."""
    return with_inlet_heating(law, INLET_HEATING[choices.inlet_heating])


def _under(
    laws: Sequence[FrictionLaw], models: Models, given: Mapping[str, Mapping[str, float]]
) -> tuple[Models, ...]:
    """Models under each of some laws, with the parameters that are given of them.

    Formulas share programs; a law that solves films is in none.
    """
    formulas = tuple(law for law in laws if law.films is None)
    parameters = {law.name: _parameters(law, given.get(law.name, {})) for law in formulas}
    sharing = iter(replace(models, friction=formulas, parameters=parameters).each)
    alone = replace(models.without_friction, film=models.film)
    return tuple(
        next(sharing) if law.films is None else replace(alone, friction=(law,)) for law in laws
    )


def tooth_size(mesh: Mesh) -> float | None:
    """Module of the teeth [m], which is about the height that their flanks have; None without teeth."""
    module = jax.device_get(_numbers(mesh, *mesh_ends(mesh))["dimensions"]).get("module")
    return None if module is None else float(module)


def _law(name: str, case: CaseFile, used: Sequence[SolidInUse], mesh: Mesh) -> FrictionLaw:
    """A friction law; one that solves films does so by the choices of the case."""
    law = FRICTION[name]
    if law.films is None:
        return law
    size = tooth_size(mesh)
    if case.film is not None:
        return replace(law, films=_film_model(case.film, [solid.record for solid in used], size))
    return law if size is None else replace(law, films=replace(law.films, inlet=size))


def _parameters(law: FrictionLaw, given: Mapping[str, float]) -> dict[str, jax.Array]:
    """Values of a law's own parameters, by default those of its formula."""
    _, defaults = arguments(law.function)
    return {key: array(given.get(key, default), jnp.float64) for key, default in defaults.items()}


FILM_SOLVERS: Mapping[Shape, tuple[str, ...]] = {
    "line": ("line", "finite_line"),
    "ellipse": ("elliptic",),
}
"""Solvers of films for contacts of a shape, by their names in `[film]`."""

_WHY_NOT: Mapping[Shape, str] = {
    "line": "lines have no elliptic solver",
    "ellipse": "ellipses have no line solver",
}
"""What contacts of a shape are not solved by."""


def _check_shapes(case: CaseFile, mesh: Mesh, own: ChosenLaws, wrong: Complaints) -> None:
    """Complains of a film, a rolling law or a user's own law that hold for contacts of another shape."""
    models = case.models
    chosen: dict[str, Law] = {
        "models.film_thickness": FILM_THICKNESS[models.film_thickness],
        "models.rolling_resistance": ROLLING_RESISTANCE[models.rolling_resistance],
        "models.asperity_load": ASPERITY_LOAD[models.asperity_load],
    }
    for key, law in chosen.items():
        wrong.under(key).tried(demand_shape, law, mesh.shape)
    for friction in own:
        if isinstance(friction, FrictionLaw):
            wrong.tried(demand_shape, friction, mesh.shape)
    if case.film is not None and case.film.solver not in FILM_SOLVERS[mesh.shape]:
        message = (
            f"these gears touch {TOUCH[mesh.shape]}, and {_WHY_NOT[mesh.shape]}; take "
            f"{' or '.join(FILM_SOLVERS[mesh.shape])}, or leave the table out"
        )
        wrong.add(InputError(message, key="film.solver"))
    if mesh.shape == "line" and models.elliptic_contact != USUAL_ELLIPSE:
        message = f"these gears touch along lines; leave it at {USUAL_ELLIPSE}"
        wrong.add(InputError(message, key="models.elliptic_contact"))


def _check_hardness(case: CaseFile, used: Sequence[SolidInUse]) -> None:
    """InputError if a law asks for the hardness of a gear whose material has none."""
    law = ASPERITY_LOAD[case.models.asperity_load]
    if "hardness" not in arguments(law.function)[0]:
        return
    for gear, solid in enumerate(used, 1):
        if solid.record.hardness is None:
            raise InputError(
                f"'{law.name}' asks for the hardness of both gears, and that of gear {gear} is not known; "
                "give its material by value, with its hardness",
                key=f"materials.gear_{gear}",
            )


def _check_models(case: CaseFile, mesh: Mesh, wrong: Complaints) -> None:
    """Complains of models of the case that do not hold for these gears."""
    models = case.models
    for place, choice in enumerate(models.friction):
        if why_not := applies(FRICTION[choice.name], mesh):
            others = ", ".join(law.name for law in LAWS if applies(law, mesh) is None)
            message = f"{why_not}; choose one of {others}"
            wrong.add(InputError(message, key="models.friction", value=place))
    wrong.under("models.load_sharing").tried(
        demand_sharing, LOAD_SHARING[models.load_sharing], mesh
    )
    wrong.tried(_check_map, case, mesh)
    if models.tooth_temperature != "isothermal":
        wrong.tried(_check_heat, case, mesh)
    if case.dynamics is not None and has(mesh, line_of_action):
        wrong.tried(_check_masses, case, mesh)
        wrong.tried(_check_motion, case, mesh)
    elif case.dynamics is not None:
        wrong.tried(_check_joint, case, case.dynamics)


def _check_map(case: CaseFile, mesh: Mesh) -> None:
    """InputError for a loss map whose friction is that of films between teeth with gaps."""
    solved = [
        choice.name for choice in case.models.friction if FRICTION[choice.name].films is not None
    ]
    if case.loss_map is not None and solved and not touching(mesh):
        raise InputError(
            f"teeth with gaps share each load in another way, and '{solved[0]}' solves the films of every "
            "operating point; leave the table out, or name formulas alone in models.friction",
            key="loss_map",
        )


def _check_heat(case: CaseFile, mesh: Mesh) -> None:
    """InputError for gears that a model of the tooth temperature is not for."""
    missing = (
        "a pitch point, which these gears do not have"
        if not has(mesh, pitch_point)
        else "two gears that turn, each with its number of teeth"
    )
    if not has(mesh, pitch_point) or not case.gears.tooth_numbers:
        raise InputError(
            f"'{case.models.tooth_temperature}' asks for {missing}; use isothermal",
            key="models.tooth_temperature",
        )
    if reason := _solved_first(case):
        raise InputError(f"the heat of the teeth {reason}", key="models.friction")


def _solved_first(case: CaseFile) -> str | None:
    """What is wrong with a first friction law that solves films, where a formula is asked for."""
    formula = FRICTION[case.models.friction[0].name]
    if formula.films is None:
        return None
    return (
        f"follows from the first friction law of a case, and '{formula.name}' is no formula; name a formula "
        "before it"
    )


def _check_masses(case: CaseFile, mesh: Mesh) -> None:
    """InputError for a vibration if a body that travels has no mass, or a moment of inertia."""
    travelling = [name for name in case.gears.members if name not in case.gears.shafts]
    if not travelling:
        return
    assert case.dynamics is not None
    if case.dynamics.inertia is not None:
        raise InputError(
            f"the {travelling[0]} travels and has no moment of inertia; give gears.mass, the other body "
            "counts as a plain disc",
            key="dynamics.inertia",
        )
    if not np.isfinite(np.asarray(_inertia(mesh))).all():
        raise InputError(
            f"is missing; a vibration asks for the mass of the {travelling[0]} and of all that moves with it",
            key="gears.mass",
        )


def _check_motion(case: CaseFile, mesh: Mesh) -> None:
    """InputError for gears whose motion with friction cannot be computed."""
    assert case.dynamics is not None
    motion = case.dynamics.motion
    if motion is None:
        return
    if reason := _solved_first(case):
        raise InputError(f"a motion {reason}", key="models.friction")
    if mesh.body.couples:
        raise InputError(
            "motion with friction takes each pair of teeth as a spring of its own, and the rim of these "
            "gears couples them; leave this table out",
            key="dynamics.motion",
        )
    travelling = [name for name in case.gears.members if name not in case.gears.shafts]
    if travelling and motion.bearing_stiffness is not None:
        raise InputError(
            f"was given, and the {travelling[0]} travels; bearings that yield are those of gears that turn",
            key="dynamics.motion.bearing_stiffness",
        )
    if case.operation.load == 0.0:
        reason = (
            f"0 was given; a motion asks for a {case.gears.load} above 0, which presses the teeth"
        )
        raise InputError(reason, key=f"operation.{case.gears.load}")
    ratio = float(mesh.contact_ratio) if motion.pair_path else 0.0
    if motion.pair_path and motion.pair_path[-1] < ratio - 1e-6:
        raise InputError(
            f"ends at {motion.pair_path[-1]:g}; the path of a pair is {ratio:.6g} base pitches long",
            key="dynamics.motion.pair_path",
        )
    if motion.mesh_damping == 0.0 and not any(motion.bearing_damping or ()):
        raise InputError(
            "0 N s/m leaves nothing that damps the vibration, so that it never becomes steady",
            key="dynamics.motion.mesh_damping",
        )


def _check_joint(case: CaseFile, asked: Dynamics) -> None:
    """InputError for what the torsional vibration of a joint does not take, or lacks."""
    if not case.gears.transmits:
        raise InputError(
            "vibration is computed along a line of action, which these gears do not have; leave this "
            "table out",
            key="dynamics",
        )
    strange = [key for key in _ALONG_ACTION if getattr(asked, key) != _usual(key)]
    if strange:
        raise InputError(
            "was given; it is for vibration along a line of action, which these gears do not have, and a "
            f"joint takes {', '.join(_OF_JOINT)}",
            key=f"dynamics.{strange[0]}",
        )
    if asked.inertia is None:
        ends = f"the motor at the {case.operation.driver} and the load at the output"
        raise InputError(
            f"is missing; a joint vibrates between two moments of inertia, a list of those of {ends}",
            key="dynamics.inertia",
        )


def _inertia_of_both(document: Document) -> list[str]:
    """That one moment of inertia counts for motor and load alike; nothing where each has its own."""
    if isinstance(document.tree["dynamics"].get("inertia"), list):
        return []
    warning = (
        "The motor and the load have the same moment of inertia, since dynamics.inertia was given as one "
        "value; a list has that of the motor, then that of the load."
    )
    return [Doubt(warning, brief="Motor and load have the one inertia that was given.")]


_ALONG_ACTION = ("profile_error", "backlash", "torques", "forces", "motion")
_OF_JOINT = ("inertia", "damping_ratio", "speeds")


def _usual(key: str) -> object:
    """Value of a key of [dynamics] where none is given."""
    return Dynamics.model_fields[key].default


@remembering
def drags(
    losses: Mapping[str, Loss], bodies: Sequence[str], inner: Collection[frozenset[str]]
) -> tuple[Drag, ...]:
    """Places beside the teeth where power is lost.

    Args:
        losses: by name.
        bodies: of each coordinate, by name.
        inner: pairs of bodies with a bearing between them on which a wave of teeth presses.
    """
    return tuple(_drag(loss, losses, bodies, inner) for loss in losses.values())


def held_by(drags: Sequence[Drag], losses: Mapping[str, Loss], way: float) -> tuple[Drag, ...]:
    """Places with what holds bodies at rest at one end of its spread.

    Args:
        drags: the places.
        losses: of which they are, in the same order.
        way: 1 for the upper end, -1 for the lower one.
    """
    pairs = zip(drags, losses.values(), strict=True)
    return tuple(drag.held_times(loss.breakaway_spread**way) for drag, loss in pairs)


def _drag(
    loss: Loss,
    losses: Mapping[str, Loss],
    bodies: Sequence[str],
    inner: Collection[frozenset[str]],
) -> Drag:
    between = np.zeros(len(bodies))
    for body, side in zip(loss.between, (1.0, -1.0), strict=True):
        if body in bodies:
            between[bodies.index(body)] = side
    bearing = BEARING_LOSS[loss.bearing]
    return Drag(
        between=array(between),
        bearing=bearing,
        mean_diameter=array(loss.mean_diameter or 0.0),
        factors={name: array(value) for name, value in loss.factors.items()},
        preload=array(loss.preload),
        seat=InnerBearing() if _inside(loss, inner) else _seat(loss, losses, bodies),
        seal_torque=array(loss.seal_torque),
        churning_torque=array(loss.churning_torque),
        churning_speed=array(loss.churning_speed or 1.0),
        churning_exponent=array(loss.churning_exponent),
        breakaway_torque=array(loss.breakaway_torque),
        breakaway=BREAKAWAY[loss.breakaway],
        breakaway_factors={name: array(value) for name, value in loss.breakaway_factors.items()},
    )


def _inside(loss: Loss, inner: Collection[frozenset[str]]) -> bool:
    """True for the bearing inside a drive on which a wave of teeth presses."""
    return loss.bearing != "none" and frozenset(loss.between) in inner


def _seat(loss: Loss, losses: Mapping[str, Loss], bodies: Sequence[str]) -> Bearing | None:
    """Where a bearing sits; None for a place without one, or between bodies that nothing holds apart."""
    if loss.bearing == "none" or "housing" not in loss.between:
        return None
    body = next(name for name in loss.between if name != "housing")
    coordinate = bodies.index(body)
    bearing, *others = bearings_of(losses, body).values()
    if not others:
        return Bearing(coordinate)
    opposite = others[0] if loss is bearing else bearing
    assert loss.position is not None and opposite.position is not None
    thrust = _locates(loss, opposite, usual=loss is bearing)
    return Bearing(coordinate, array(loss.position), array(opposite.position), thrust)


def _locates(loss: Loss, other: Loss, *, usual: bool) -> bool:
    """True if a bearing takes the thrust: as either of the two says, else the first one."""
    if loss.locating is not None:
        return loss.locating
    return usual if other.locating is None else not other.locating


@lru_cache(maxsize=64)
def _built_oil(record: lubricants.LubricantRecord) -> lubricants.Lubricant:
    return record.build()


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


@program
def _numbers(mesh: Mesh, driver: jax.Array, loaded: jax.Array) -> dict[str, dict[str, Any]]:
    """Dimensions and nominal motion, which every case asks for."""
    motion = nominal_motion(mesh, driver, loaded)
    nominal = {
        "motion": motion,
        "driver": driver,
        "loaded": loaded,
        "period": nominal_period(mesh, motion),
        "onward": phase_sense(mesh, motion),
        "events": mesh.events(),
        "pitch_line_speed": pitch_point(mesh, driver).pitch_line_speed
        if has(mesh, pitch_point)
        else jnp.zeros(()),
    }
    dimensions = main_dimensions(mesh) | ratio_dimension(mesh, driver, loaded)
    return {"dimensions": dimensions, "nominal": nominal}


_modulus, _sections = program(reduced_modulus), program(tooth_sections)


@program
def _inertia(mesh: Mesh) -> jax.Array:
    return plain_inertia(mesh, jnp.ones(2))


def _lubricant(oil: Oil, document: Document) -> lubricants.LubricantRecord:
    record = _oil(oil, document)
    if not (oil.thickener or oil.consistency):
        return record
    return record.thickened(thickener=oil.thickener, consistency=oil.consistency)


def _oil(oil: Oil, document: Document) -> lubricants.LubricantRecord:
    values = {
        "nu_1": oil.viscosity_40,
        "nu_2": oil.viscosity_100,
        "nu_0": oil.viscosity_minus_40,
        "density_15": oil.density,
        "density_slope": oil.density_slope,
        "lubricant_factor": oil.lubricant_factor,
        "conductivity": oil.conductivity,
        "T_min": oil.temperature_min,
        "T_max": oil.temperature_max,
    }
    if oil.pressure_viscosity is not None:
        values["gold_s"], values["gold_t"] = lubricants.constant_alpha(oil.pressure_viscosity)
    overridden = {
        key: datum(value, f"lubricant.{_OIL_KEYS[key]}", document)
        for key, value in values.items()
        if value is not None
    }
    try:
        record = _of_values(oil, overridden)
        if overridden:
            lubricants.demand_plausible_cold(record)
        return record
    except InputError as error:
        key = _OIL_KEYS.get((error.key or "").rsplit(".", 1)[-1], "")
        message = error.message
        for name, word in _OIL_KEYS.items():
            message = message.replace(name, word)
        where = f"lubricant.{key}".rstrip(".")
        raise InputError(message, file=document.name, key=where) from None


def _of_values(oil: Oil, given: Mapping[str, Datum]) -> lubricants.LubricantRecord:
    """An oil by value, or one of the catalogue with some values of the case file."""
    cold = lubricants.known_cold(given["nu_0"]) if "nu_0" in given else {}
    if oil.name is not None:
        following = {**cold, **lubricants.without_free_volume(given)}
        return _with_own(lubricants.find(oil.name), given, following)
    assert oil.base is not None
    data: dict[str, Any] = {**lubricants.base_oils()[oil.base], **cold, **given}
    return lubricants.LubricantRecord(
        name="oil by value", title=f"{oil.base} oil by value", base=oil.base, **data
    )


def _with_own(
    oil: lubricants.LubricantRecord, given: Mapping[str, Datum], following: Mapping[str, Any]
) -> lubricants.LubricantRecord:
    """An oil of the catalogue with values of the case file, which say so, and what follows from them."""
    if not given:
        return oil
    beside = f"of the case file; the other values are those of {oil.name} in the catalogue"
    values: dict[str, Any] = {
        key: replace(value, note="; ".join(filter(None, [value.note, beside])))
        for key, value in given.items()
    }
    replaced = ", ".join(dict.fromkeys(_OIL_KEYS[key] for key in given))
    title = f"{oil.title or oil.name} with {replaced} of the case file"
    return replace(oil, title=title, **{**following, **values})


def _of_oil(oil: lubricants.LubricantRecord) -> list[str]:
    """What is assumed of it."""
    return (
        [Doubt(oil.note, brief=f"Grease ({oil.name}) as its base oil: the thickener does nothing.")]
        if oil.note
        else []
    )


def _half_of_a_line(oil: Oil) -> list[str]:
    """One of two viscosities given beside the other one of the catalogue."""
    stated = [oil.viscosity_40 is not None, oil.viscosity_100 is not None]
    if oil.name is None or all(stated) or not any(stated):
        return []
    key, partner = (
        ("viscosity_40", "viscosity_100") if stated[0] else ("viscosity_100", "viscosity_40")
    )
    return [
        Doubt(
            f"The oil has the {key} of the case file and the {partner} of {oil.name}: together they make the "
            "line of viscosity over temperature; give both.",
            brief=f"The oil has the {partner} of {oil.name}; give it too.",
        )
    ]


_OIL_KEYS = {
    "nu_1": "viscosity_40",
    "nu_2": "viscosity_100",
    "nu_0": "viscosity_minus_40",
    "density_15": "density",
    "density_slope": "density_slope",
    "gold_s": "pressure_viscosity",
    "gold_t": "pressure_viscosity",
    "lubricant_factor": "lubricant_factor",
    "conductivity": "conductivity",
    "T_min": "temperature_min",
    "T_max": "temperature_max",
}


def _check_temperature(temperature: float, oil: lubricants.LubricantRecord, key: str) -> None:
    low, high = oil.T_min.value, oil.T_max.value
    if not low <= temperature <= high:
        allowed = replace(TEMPERATURE, low=low, high=high).allowed
        raise InputError(
            f"{TEMPERATURE.show(temperature)} is outside the range of {oil.name}; {allowed}",
            key=key,
            value=temperature,
        )


@remembering
def _roughness(surface: RoughnessTable) -> Roughness:
    if surface.ra is not None and surface.rq is not None:
        (ra_1, ra_2), (rq_1, rq_2) = surface.ra, surface.rq
        return Roughness(ra_1=ra_1, ra_2=ra_2, rq_1=rq_1, rq_2=rq_2)
    if surface.ra is not None:
        return Roughness.from_ra(*surface.ra)
    if surface.rq is not None:
        return Roughness.from_rq(*surface.rq)
    assert surface.composite_rq is not None
    return Roughness.from_composite_rq(surface.composite_rq)
