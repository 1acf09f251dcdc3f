"""A case of one mesh ready to compute: its design, its operating point, its laws."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from pitchpoint._jax import array, jax
from pitchpoint.cases.drive_schema import StageTable
from pitchpoint.cases.models import inlet_law, model_of_films, under_laws
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.solids import (
    SolidInUse,
    failures,
    fitted_on_steel,
    grown,
    heating,
    solids_at_root_temperature,
    surrounded,
)
from pitchpoint.contact.surface import Surfaces
from pitchpoint.core.brief import brief
from pitchpoint.core.doubts import GUESSED, Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.efficiency.drag import Drag, held_by
from pitchpoint.efficiency.operation_tables import Operating
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation
from pitchpoint.efficiency.running_torque import no_load_torque, torques_at_rest
from pitchpoint.efficiency.summary import engaged, summarise
from pitchpoint.efficiency.warm_teeth import warm_teeth_program
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.families import family_of
from pitchpoint.gears.family import Family, Followed
from pitchpoint.gears.mesh import Mesh, coordinates_of
from pitchpoint.gears.nominal_motion import mesh_ends, mesh_numbers, nominal_motion, tooth_size
from pitchpoint.gears.pairs import way_of_pairs
from pitchpoint.input.kinds import FORCE, TORQUE
from pitchpoint.input.quantities import Quantity
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.lubrication.applicability import why_inapplicable
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.lubrication_registry import (
    ASPERITY_LOAD,
    BOUNDARY,
    FILM_THICKNESS,
    LAWS,
    AsperityLoad,
    FilmThickness,
    FrictionLaw,
)
from pitchpoint.materials import lubricants
from pitchpoint.materials.solids import reduced_modulus
from pitchpoint.registry import code_at
from pitchpoint.results.variable import End

if TYPE_CHECKING:
    from pitchpoint.cases.strength_choices import Rated
    from pitchpoint.efficiency.mesh_link import MeshLink
    from pitchpoint.lubrication.ehl.model import FilmModel

__all__ = [
    "ALONE",
    "BEARING_FREE",
    "TEETH_ALONE",
    "Built",
    "MemberMotion",
    "MeshPeriod",
    "coverage_attributes",
    "ends_of",
    "operation_at",
    "without_bearing",
]


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
UNSETTLED = Doubt(
    "Heat, modulus and friction of the teeth found no balance: their temperatures are those of the last "
    "pass.",
    brief="The temperature of the teeth found no balance.",
)


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
    pin_compliances: ClassVar[Mapping[int, float]] = {}
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
        balanced = jax.device_get(warm_teeth_program(*arguments))
        warmed = replace(cold, warming=balanced.status)
        if int(balanced.status.code) == Code.LOCKED:
            return warmed  # friction locks the mesh, which the computation says
        loss = {name: float(getattr(balanced, name)) for name in ("mean_friction", "loss_factor")}
        return _of_solids(warmed, solids_at_root_temperature(case, cold.design, cool, loss))

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
        return inlet_law(FILM_THICKNESS[self.case.models.film_thickness], self.case.models)

    @cached_property
    def film_model(self) -> "FilmModel | None":
        """How films of the contacts are solved; None where no table, law or wear asks for them."""
        table, wear = self.case.film, self.case.wear
        if table is None and (wear is None or wear.load_ratio == "formula"):
            return next((law.films for law in self.laws if law.films is not None), None)
        solids = [used.record for used in self.solids]
        usual = FilmTable(solver="line")
        return model_of_films(table or usual, solids, tooth_size(self.design.mesh))

    @property
    def asperities(self) -> AsperityLoad | None:
        """The law of the load on asperities; None without one."""
        law = ASPERITY_LOAD[self.case.models.asperity_load]
        return None if law.name == "none" else law

    @property
    def rated(self) -> "Rated":
        """The case as a rating of its strength takes it."""
        rated_case = code_at("pitchpoint.cases.strength_choices:rated_case")
        rated: Rated = rated_case(self.case, self.solids, self.lubricant, self.design.roughness)
        return rated

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
        return [
            law for law in LAWS if law.sources and why_inapplicable(law, self.design.mesh) is None
        ]

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
        return under_laws(laws, self.models[0], {})

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
            np.asarray, mesh_numbers(self.design.mesh, self.design.driver, self.design.loaded)
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
        words, backwards = way_of_pairs(self.design.mesh), self.nominal["onward"] < 0.0
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
        # Loaded here: one mesh alone is no link.
        mesh_link = code_at("pitchpoint.efficiency.mesh_link:MeshLink")
        link: MeshLink = mesh_link(self.design, shafts, array(table.turn), array(table.place))
        return link

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
        return way_of_pairs(self.design.mesh).attributes(touching)

    @property
    def carried(self) -> Quantity:
        """What the loaded member takes, torque or force."""
        return FORCE if "loaded" in self.travels else TORQUE

    @property
    def covers(self) -> dict[str, str]:
        """What the efficiency is of, as an attribute, where it is less than a whole drive."""
        if not self.case.gears.transmits:
            return {}
        return coverage_attributes(self.places, lacks_bearing=self.lacks_bearing)

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
    ends = jax.device_get(driver_and_loaded(case, mesh))
    motion = np.asarray(nominal_motion(jax.device_get(mesh), *ends))
    driver_rate, loaded_rate = (float(end @ motion) for end in ends)
    return driver_rate, loaded_rate


def driver_and_loaded(case: CaseFile, mesh: Mesh) -> tuple[jax.Array, jax.Array]:
    """Who drives and who is loaded, see `mesh_ends`."""
    driver, gears = case.operation.driver, case.gears
    return mesh_ends(mesh, driver, gears.loaded_member(driver), gears.members)


def operation_at(point: Operating) -> Operation:
    """Operating point as the kernels take it."""
    return Operation(array(point.load), array(point.speed), array(point.temperature))


def coverage_attributes(places: Sequence[str], *, lacks_bearing: bool) -> dict[str, str]:
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


_modulus = program(reduced_modulus)
