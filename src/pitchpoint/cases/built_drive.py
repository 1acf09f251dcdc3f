"""A case of several meshes ready to compute: stages one behind the other, or a train that turns together."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from pitchpoint._jax import array
from pitchpoint.cases.built import (
    BEARING_FREE,
    TEETH_ALONE,
    Built,
    MemberMotion,
    MeshPeriod,
    coverage_attributes,
    operation_at,
)
from pitchpoint.cases.document import STAGES, Document
from pitchpoint.cases.drive_schema import DriveCase, StageTable
from pitchpoint.core.brief import brief
from pitchpoint.core.doubts import in_stage
from pitchpoint.drive.kinematics import HOUSING, Ends
from pitchpoint.efficiency.drag import Drag, held_by
from pitchpoint.efficiency.drive import Drive
from pitchpoint.efficiency.drive_summary import drive_figures
from pitchpoint.efficiency.quasi_static import Models, Operation
from pitchpoint.efficiency.running_torque import torques_at_rest_of_drive
from pitchpoint.input.quantities import Quantity
from pitchpoint.lubrication.lubrication_registry import FrictionLaw
from pitchpoint.registry import code_at
from pitchpoint.results.variable import End
from pitchpoint.strength.strength_table import MESH_LOAD

if TYPE_CHECKING:
    from pitchpoint.drive.torques import TrainTorques
    from pitchpoint.efficiency.train import Train, TrainMesh
    from pitchpoint.efficiency.train_state import TrainLink

__all__ = [
    "MEETINGS",
    "TRAIN_PERIOD",
    "Acting",
    "BuiltDrive",
    "BuiltTrain",
    "Ready",
]

_BY_METHOD_B = (
    "K_v by method B takes each mesh by itself, with one planet and a ring that swings: more planets on a "
    "sun make the mass that vibrates smaller, a ring that is held fast makes it larger."
)

MEETINGS, TRAIN_PERIOD = "all meetings of phases", "period of the train"
"""What averages run over where there are several meshes: stages in a row, or a train."""


@dataclass(frozen=True)
class Acting:
    """Laws that act together in all stages, under one friction law of the case.

    Attributes:
        law: friction law by which it is named: that of the case, or those of the stages.
        of_stages: models of each stage, of a planetary set as they act together in it.
    """

    law: FrictionLaw
    of_stages: "tuple[Models | Acting, ...]"

    @property
    def stages(self) -> tuple[Any, ...]:
        """Models of each stage as kernels take them, of a planetary set those of its meshes."""
        return tuple(
            acting.stages if isinstance(acting, Acting) else acting for acting in self.of_stages
        )

    @property
    def of_meshes(self) -> tuple[Models, ...]:
        """Models of each mesh."""
        return tuple(models for stage in self.of_stages for models in stage.of_meshes)

    def __repr__(self) -> str:
        return brief(self)


@dataclass(frozen=True, eq=False)
class BuiltDrive:
    """A case of several stages ready to compute.

    Attributes:
        case: as validated.
        stages: each built as a case of its own, at the load and speed that it has without losses; a planetary
            set is a train.
        numbers: of the stages in the file, in the order of the power.
        documents: each stage came from, in the same order.
        design: the drive.
        operation: torque at the output, speed of the input.
        told: sentences about the drive.
    """

    case: DriveCase
    stages: "tuple[Built | BuiltTrain, ...]"
    numbers: tuple[int, ...]
    documents: tuple[Document, ...]
    design: Drive
    operation: Operation
    told: tuple[str, ...]

    fitted: ClassVar[None] = None
    film_model: ClassVar[None] = None
    following: ClassVar[Mapping[str, Any]] = {}
    inner_bearing: ClassVar[frozenset[str]] = frozenset()
    """Each mesh has its own, see `Built`."""

    def __repr__(self) -> str:
        return brief(self)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about the drive, and about each of its stages."""
        of_meshes = zip(self.mesh_labels, self.meshes, strict=True)
        labelled = (
            *(
                (number, text)
                for number, stage in zip(self.numbers, self.stages, strict=True)
                for train in stage.trains.values()
                for text in train.told
            ),
            *((label, text) for label, mesh in of_meshes for text in mesh.warnings),
        )
        left_out = TEETH_ALONE, BEARING_FREE
        return (
            *self.told,
            *(in_stage(label, text) for label, text in labelled if text not in left_out),
        )

    @property
    def heated(self) -> list[str]:
        """Sentences on teeth that their own loss warms, by stage."""
        labelled = zip(self.mesh_labels, self.meshes, strict=True)
        return [in_stage(label, text) for label, mesh in labelled for text in mesh.heated]

    @cached_property
    def models(self) -> tuple[Acting, ...]:
        """Laws that act together, once under each friction law of the case."""
        count = max(len(stage.models) for stage in self.stages)
        laws = [
            stage.models * count if len(stage.models) == 1 else stage.models
            for stage in self.stages
        ]
        return tuple(self._acting(models) for models in zip(*laws, strict=True))

    def under(self, laws: Sequence[FrictionLaw]) -> tuple[Acting, ...]:
        """The models of the case under other friction laws; stages with one of their own keep it."""
        of_stages = [
            stage.models[:1] * len(laws) if own_friction else stage.under(laws)
            for stage, own_friction in zip(self.stages, self.own_friction, strict=True)
        ]
        return tuple(self._acting(models) for models in zip(*of_stages, strict=True))

    def _acting(self, models: "Sequence[Models | Acting]") -> Acting:
        own_friction = self.own_friction
        ordered = sorted(
            zip(self.numbers, models, own_friction, strict=True), key=lambda one: one[0]
        )
        free = [one.law for _, one, mine in ordered if all(own_friction) or not mine]
        named = list(dict.fromkeys(free))
        if len(named) == 1:
            return Acting(named[0], tuple(models))
        name, title = (" + ".join(getattr(law, key) for law in named) for key in ("name", "title"))
        sources = tuple(dict.fromkeys(key for law in named for key in law.sources))
        joined = replace(named[0], name=name, title=title, sources=sources)
        return Acting(joined, tuple(models))

    @property
    def own_friction(self) -> tuple[bool, ...]:
        """For each stage whether it has a friction law of its own."""
        tables = (self.case.stages[str(number)].models for number in self.numbers)
        return tuple("friction" in table.model_fields_set for table in tables)

    @property
    def mesh_own_friction(self) -> tuple[bool, ...]:
        """For each mesh whether its stage has a friction law of its own."""
        stages = zip(self.stages, self.own_friction, strict=True)
        return tuple(own_friction for stage, own_friction in stages for _ in stage.meshes)

    @property
    def laws(self) -> list[FrictionLaw]:
        """Friction laws of the case, in order."""
        return [models.law for models in self.models]

    @property
    def law_names(self) -> list[str]:
        """Names of the friction laws."""
        return [law.name for law in self.laws]

    @property
    def applicable(self) -> list[FrictionLaw]:
        """Fitted friction laws of the library that hold for all stages without one of their own."""
        pairs = zip(self.stages, self.own_friction, strict=True)
        of_stages = [stage.applicable for stage, own_friction in pairs if not own_friction]
        return [
            law
            for law in (of_stages[0] if of_stages else [])
            if all(law in laws for laws in of_stages)
        ]

    @property
    def temperatures(self) -> tuple[float, float]:
        """Lowest and highest temperature of all oils [K]."""
        low, high = zip(*(stage.temperatures for stage in self.stages), strict=True)
        return max(low), min(high)

    @property
    def meshes(self) -> tuple[Built, ...]:
        """Meshes that the case has: its stages, and those of its planetary sets."""
        return tuple(mesh for stage in self.stages for mesh in stage.meshes)

    @property
    def mesh_numbers(self) -> tuple[int, ...]:
        """Number of the stage that each mesh is in, see `meshes`."""
        numbered = zip(self.numbers, self.stages, strict=True)
        return tuple(number for number, stage in numbered for _ in stage.meshes)

    @property
    def mesh_labels(self) -> list[int | str]:
        """Number of the stage of each mesh, with its bodies where it is one of several, see `meshes`."""
        labels: list[int | str] = []
        for number, stage in zip(self.numbers, self.stages, strict=True):
            labels += [f"{number} ({bodies})" for bodies in stage.stage_bodies] or [number]
        return labels

    @property
    def trains(self) -> "dict[int, BuiltTrain]":
        """Sets of meshes that turn together, by number of the stage, in the order of the power."""
        numbered = zip(self.numbers, self.stages, strict=True)
        return {number: train for number, stage in numbered for train in stage.trains.values()}

    @property
    def pin_compliances(self) -> Mapping[int, float]:
        """Turn of the output for a unit on it by which pins of each set yield, by stage [rad/(N m)].

        A unit at the output is a torque on each stage, and what turns there turns the output as much less.
        """
        onward = dict(zip(self.numbers, self.onward, strict=True))
        return {
            number: float(onward[number] ** 2 * train.pin_compliance)
            for number, train in self.trains.items()
        }

    @property
    def planets(self) -> int:
        """How many planets share the load of the drive: none of stages in a row, whose sets have theirs."""
        return 0

    @property
    def travels(self) -> frozenset[End]:
        """Those of driver and loaded shaft that travel in place of turning."""
        ends: dict[End, Built | BuiltTrain] = {"driver": self.stages[0], "loaded": self.stages[-1]}
        return frozenset(end for end, stage in ends.items() if end in stage.travels)

    @property
    def carried(self) -> Quantity:
        """What the output takes, torque or force."""
        return self.stages[-1].carried

    @property
    def driver(self) -> str:
        """Name of the shaft that drives."""
        return f"shaft {self.design.ends[0][0] + 1}"

    @property
    def loaded(self) -> str:
        """Name of the shaft that carries the load."""
        return f"shaft {self.design.ends[-1][1] + 1}"

    @property
    def transmits(self) -> bool:
        """True: power goes through every drive."""
        return True

    @property
    def covers(self) -> dict[str, str]:
        """What the efficiency is of, see `Built.covers`."""
        return coverage_attributes(self.places, lacks_bearing=self.lacks_bearing)

    @property
    def lacks_bearing(self) -> bool:
        """True where no loss stands for a bearing inside one of the stages, see `Built.lacks_bearing`."""
        between_shafts = any("housing" not in loss.between for loss in self.case.losses.values())
        return not between_shafts and any(stage.lacks_bearing for stage in self.stages)

    @property
    def places(self) -> list[str]:
        """Names of the places beside the teeth where power is lost: of the drive, then of its stages."""
        of_stages = [
            f"stage {number} {name}"
            for number, stage in zip(self.numbers, self.stages, strict=True)
            for name in stage.case.losses
        ]
        return [*self.case.losses, *of_stages]

    @property
    def rates_bearings(self) -> bool:
        """True if a bearing of the drive or of a stage has its dynamic load rating."""
        every = (loss for holder in self.with_losses for loss in holder.case.losses.values())
        return any(loss.dynamic_load_rating is not None for loss in every)

    @property
    def with_losses(self) -> "tuple[Built | BuiltDrive, ...]":
        """The drive and its stages, which have losses beside the teeth in the order of `places`."""
        return (self, *self.stages)

    @property
    def planet_bodies(self) -> tuple[str, ...]:
        """Bodies of which there are several: none of shafts."""
        return ()

    @property
    def explored(self) -> tuple[str, Any]:
        """Table of gears by which an explorer changes the case, with its key: of the first stage."""
        return f"{STAGES}.{self.numbers[0]}.gears", self.stages[0].case.gears

    @property
    def averaging(self) -> str:
        """What averages run over."""
        return MEETINGS

    @property
    def stage_bodies(self) -> list[str]:
        """Bodies of each stage in words, where stages are meshes of a train; none of stages in a row."""
        named = (self.case.stages[str(number)].bodies for number in self.numbers)
        return [" and ".join(bodies) for bodies in named if bodies]

    @property
    def on_strength(self) -> tuple[str, ...]:
        """Sentences on what a rating takes where there are several meshes."""
        sentence = (
            "Forces and stresses are those without friction and losses, for the load at the output."
        )
        return sentence, *self.on_load_factors

    @property
    def on_load_factors(self) -> tuple[str, ...]:
        """Those of them on load factors of its sets."""
        numbered = zip(self.numbers, self.stages, strict=True)
        return tuple(
            in_stage(number, text) for number, stage in numbered for text in stage.on_load_factors
        )

    @property
    def drags(self) -> tuple[Drag, ...]:
        """Places beside the teeth where power is lost: of the drive, then of its stages."""
        inside = (drag for link in self.design.links for drag in link.design.drag)
        return (*self.design.drag, *inside)

    def held_otherwise(self, way: float) -> "BuiltDrive":
        """The drive with what holds it at rest at one end of its spread, see `Built.held_otherwise`."""
        drag = held_by(self.design.drag, self.case.losses, way)
        links = []
        for link, built in zip(self.design.links, self.stages, strict=True):
            held = held_by(link.design.drag, built.case.losses, way)
            links.append(replace(link, design=replace(link.design, drag=held)))
        return replace(self, design=replace(self.design, drag=drag, links=tuple(links)))

    @staticmethod
    def figures_of(
        points: Sequence[tuple[Any, Operation]],
        models: Acting,
        progress: Callable[[int], None] | None = None,
    ) -> dict[str, np.ndarray]:
        """Figures of operating points of drives of equal static structure, see `drive_figures`."""
        return drive_figures(points, models.stages, progress)

    def no_load_torques(self, points: Operation) -> list[np.ndarray]:
        """Torque of the input that runs without load [*b], by each friction law."""
        every = zip(points.speed.ravel(), points.temperature.ravel(), strict=True)
        running = [(self.design, Operation(*map(array, (0.0, *one)))) for one in every]
        figures = [self.figures_of(running, one) for one in self.models]
        torques = [np.where(one["locked"], np.nan, one["mean_input_torque"]) for one in figures]
        return [one.reshape(points.speed.shape) for one in torques]

    def torques_at_rest(self, points: Operation) -> list[tuple[np.ndarray, np.ndarray]]:
        """Mean and largest torque of the input that starts the drive [*b], by each friction law."""
        torques = [self._at_rest(points, models.stages) for models in self.models]
        return [(np.asarray(mean), np.asarray(largest)) for mean, largest in torques]

    def _at_rest(self, points: Operation, models: tuple[Any, ...]) -> tuple[Any, Any]:
        return torques_at_rest_of_drive(self.design, points, models)

    @property
    def copies(self) -> tuple[int, ...]:
        """How many there are of each mesh."""
        return tuple(count for stage in self.stages for count in stage.copies)

    @property
    def steps(self) -> np.ndarray:
        """Torque on the loaded member of each mesh, all its copies together, for a unit at the output.

        Without losses; the output turns as much for a unit turn of that member alone.
        """
        return np.hstack(
            [step * stage.steps for step, stage in zip(self.onward, self.stages, strict=True)]
        )

    @property
    def onward(self) -> np.ndarray:
        """Torque at the output of each stage for a unit at that of the drive, without losses."""
        return np.abs(self.motion[-1] / np.array(self.motion[1:]))

    @cached_property
    def _carried(self) -> list[float]:
        """Mean torque that each stage carries with all losses, by the first law; none if it locks."""
        figures = self.figures_of([(self.design, self.operation)], self.models[0])
        carried = self.carried_by_meshes({name: values[0] for name, values in figures.items()})
        # Without load there is no efficiency of a train to go by, and nothing to carry.
        idle = self.case.operation.load == 0.0
        return [] if np.isnan(carried).any() and not idle else np.nan_to_num(carried).tolist()

    @property
    def locked(self) -> bool:
        """True if friction locks the drive under the first law."""
        return not self._carried

    @cached_property
    def at_work(self) -> tuple[Built, ...]:
        """Meshes under the mean torques that they carry with all losses, by the first friction law.

        Where friction locks the drive they are those without losses.
        """
        if self.locked:
            return self.meshes
        return tuple(mesh for stage in self._loaded_stages for mesh in stage.at_work)

    @property
    def trains_at_work(self) -> "dict[int, BuiltTrain]":
        """See `trains`: under the mean torques that they carry with all losses, as `at_work`."""
        numbered = zip(self.numbers, self._loaded_stages, strict=True)
        return {number: train for number, stage in numbered for train in stage.trains.values()}

    @cached_property
    def _loaded_stages(self) -> "tuple[Built | BuiltTrain, ...]":
        """Stages under the mean torques that they carry; without losses where friction locks the drive."""
        if self.locked:
            return self.stages
        loaded = zip(self.stages, self._carried, strict=True)
        return tuple(stage.carrying(torque) for stage, torque in loaded)

    def carried_by_meshes(self, figures: Mapping[str, np.ndarray]) -> np.ndarray:
        """Torque on the loaded member of each mesh with all losses: what drives the stage behind it.

        Args:
            figures: `stage_input_torque` and `stage_efficiency` at one operating point [stage].
        """
        output_torque = self.stages[-1].case.operation.load
        return np.append(figures["stage_input_torque"][1:], output_torque)

    @cached_property
    def motion(self) -> list[float]:
        """Rates of the shafts for a radian of the input."""
        rates, sense = [1.0], 1.0
        for stage in self.stages:
            # In which the flanks that touch turn the input; a set turns either way.
            sense = stage.sense * float(np.sign(rates[-1])) or sense
            rates.append(rates[-1] * stage.step)
        return [sense * rate for rate in rates]

    @property
    def output_rate(self) -> float:
        """Rate of the output for a radian of the input, without sign."""
        return abs(self.motion[-1] / self.motion[0])

    @property
    def member_motions(self) -> tuple[tuple[MemberMotion, ...], ...]:
        """Motion of the members of each mesh, in the order of its coordinates."""
        stages = zip(self.numbers, self.stages, self.motion[:-1], strict=True)
        return tuple(
            tuple(member.in_stage(number, entering) for member in members)
            for number, stage, entering in stages
            for members in stage.member_motions
        )

    @cached_property
    def backwards(self) -> "BuiltDrive":
        """The same drive with its output driving, see `Built.backwards`."""
        step, point = self.output_rate, self.case.operation
        stages = tuple(stage.backwards for stage in reversed(self.stages))
        load = {"torque": None, "force": None, stages[-1].carried.kind: point.load * step}
        changed = point.model_copy(update={**load, "speed": point.speed * step})
        turned = self.design.driven_backwards()
        linked = zip(turned.links, stages, strict=True)
        warm = [replace(link, design=stage.design) for link, stage in linked]
        return replace(
            self,
            case=self.case.model_copy(update={"operation": changed}),
            stages=stages,
            numbers=self.numbers[::-1],
            documents=self.documents[::-1],
            design=replace(turned, links=tuple(warm)),
            operation=operation_at(changed),
        )


@dataclass(frozen=True, eq=False, repr=False)
class BuiltTrain(BuiltDrive):
    """A case of meshes that turn together, as a planetary set.

    Each mesh is a stage, built at the load of one of its copies and at the speed against its carrier.
    """

    stages: tuple[Built, ...]
    design: "Train"  # type: ignore[assignment]

    @property
    def driver(self) -> str:
        """Name of the body that drives."""
        return self.design.turned

    @property
    def loaded(self) -> str:
        """Name of the body that carries the load."""
        return self.design.loaded

    @property
    def explored(self) -> tuple[str, Any]:
        """Table of gears by which an explorer changes the case, with its key: of the set, if it is one."""
        return super().explored if self.case.gears is None else ("gears", self.case.gears)

    @property
    def averaging(self) -> str:
        """What averages run over."""
        return TRAIN_PERIOD

    @property
    def with_losses(self) -> "tuple[BuiltTrain]":
        """Itself: its losses stand between its bodies."""
        return (self,)

    @property
    def planet_bodies(self) -> tuple[str, ...]:
        """Bodies of which there are several."""
        return self.design.planets

    @property
    def trains(self) -> "dict[int, BuiltTrain]":
        """Sets of meshes that turn together: itself, which is no stage."""
        return {0: self}

    @property
    def trains_at_work(self) -> "dict[int, BuiltTrain]":
        """Itself: it carries its load."""
        return self.trains

    @property
    def planets(self) -> int:
        """How many planets share the load."""
        return max(self.copies)

    @property
    def on_load_factors(self) -> tuple[str, ...]:
        """Sentences on the load factors that a rating takes."""
        count = self.planets
        share = (
            f"K_γ is at least {MESH_LOAD[count]}, for {count} planets by IEC 61400-4"
            if count in MESH_LOAD
            else "K_γ = 1"
        )
        by_method_b = any(stage.rated.table.dynamic_method == "B" for stage in self.stages)
        return (
            *[_BY_METHOD_B] * by_method_b,
            f"Where [strength] says nothing else, {share}, teeth that two mates load both ways have "
            f"Y_M = 0.7, and a gear that meets all planets has {count} load cycles in a turn against the "
            "carrier.",
        )

    @property
    def drags(self) -> tuple[Drag, ...]:
        """Places beside the teeth where power is lost."""
        return self.design.drag

    def held_otherwise(self, way: float) -> "BuiltTrain":
        """The train with what holds it at rest at one end of its spread, see `Built.held_otherwise`."""
        drag = held_by(self.design.drag, self.case.losses, way)
        return replace(self, design=replace(self.design, drag=drag))

    @staticmethod
    def figures_of(
        points: Sequence[tuple[Any, Operation]],
        models: Acting,
        progress: Callable[[int], None] | None = None,
    ) -> dict[str, np.ndarray]:
        """Figures of operating points of trains of equal static structure, see `train_figures`."""
        from pitchpoint.efficiency.train_summary import train_figures

        return train_figures(points, models.stages, progress)

    def _at_rest(self, points: Operation, models: tuple[Any, ...]) -> tuple[Any, Any]:
        from pitchpoint.efficiency.train_summary import torques_at_rest_of_train

        return torques_at_rest_of_train(self.design, points, models)

    @property
    def copies(self) -> tuple[int, ...]:
        """How many there are of each mesh."""
        return tuple(mesh.copies for mesh in self.design.meshes)

    @cached_property
    def ideal_torques(self) -> "TrainTorques":
        """Torques of the bodies for a unit at the output, without losses."""
        train = self.design
        train_torques = code_at("pitchpoint.drive.torques:train_torques")
        links = [mesh.link for mesh in train.meshes]
        ends = Ends({train.turned: float(train.rates[train.turned])}, train.held, train.loaded)
        torques: TrainTorques = train_torques(links, ends, 1.0, [1.0] * len(links))
        return torques

    @cached_property
    def pin_step(self) -> float:
        """Force on all pins of the planets along their circle for a unit at the output [1/m].

        Zero where the carrier is free: the meshes of a planet then hold each other in balance.
        """
        table, places = self.case.train, self.design.meshes
        assert table is not None
        shares = self.ideal_torques.shares
        on_planets = [k for k, place in enumerate(places) if place.carrier != HOUSING]
        if table.carrier in self.design.free or not on_planets:
            return 0.0
        radius = float(self.meshes[on_planets[0]].dimensions["centre_distance"])
        return abs(sum(shares[k][table.carrier] for k in on_planets)) / radius

    @property
    def pin_compliances(self) -> Mapping[int, float]:
        """That of its own pins, under 0: it is no stage."""
        return {0: self.pin_compliance}

    @property
    def pin_compliance(self) -> float:
        """Turn of the output for a unit on it by which pins of the planets yield [rad/(N m)].

        From virtual work: pins are springs side by side, each with its part of the load.
        """
        table = self.case.train
        assert table is not None
        if table.pin_stiffness is None:
            return 0.0
        return float(self.pin_step**2 / (self.planets * table.pin_stiffness))

    @property
    def steps(self) -> np.ndarray:
        """Torque on the driven member of each mesh, all its copies together, for a unit at the output."""
        return np.array([float(mesh.carried) for mesh in self.design.meshes])

    def carrying(self, load: float) -> "BuiltTrain":
        """The same train under another load, see `Built.carrying`.

        Args:
            load: torque at the output [N m].
        """
        point = self.case.operation
        if load == point.load:
            return self
        point = point.model_copy(update={"torque": load})
        loads = load * self.steps / np.array(self.copies)
        stages = tuple(
            stage.carrying(mesh_load) for stage, mesh_load in zip(self.stages, loads, strict=True)
        )
        placed = zip(self.design.meshes, stages, strict=True)
        meshes = tuple(replace(place, design=stage.design) for place, stage in placed)
        return replace(
            self,
            case=self.case.model_copy(update={"operation": point}),
            stages=stages,
            design=replace(self.design, meshes=meshes),
            operation=operation_at(point),
        )

    def carried_by_meshes(self, figures: Mapping[str, np.ndarray]) -> np.ndarray:
        """Torque on the driven member of one copy of each mesh with all losses, see `BuiltDrive`."""
        ends = np.abs([stage.ends for stage in self.stages])
        driving = (
            figures["stage_input_torque"] * figures["stage_efficiency"] / np.array(self.copies)
        )
        return np.asarray(driving * ends[:, 0] / ends[:, 1])

    @cached_property
    def motion(self) -> list[float]:
        """Rates of the bodies for a radian of the one that drives."""
        rates = {body: float(rate) for body, rate in self.design.rates.items()}
        return [rates[body] / rates[self.driver] for body in self.case.bodies]

    @property
    def step(self) -> float:
        """Rate of the output for a radian of the input."""
        rates = self.design.rates
        return float(rates[self.design.loaded]) / float(rates[self.design.turned])

    @property
    def output_rate(self) -> float:
        """Rate of the output for a radian of the input, without sign."""
        return abs(self.step)

    @property
    def sense(self) -> float:
        """Sense of the input by which the flanks touch that do: it turns either way alike."""
        return 0.0

    @property
    def period(self) -> MeshPeriod:
        """After what the train is as it was."""
        return MeshPeriod(float(self.design.period), TRAIN_PERIOD)

    def periods_per_turn(self, end: End) -> float:
        """Mesh periods in a turn of the input or of the output."""
        turns = 1.0 if end == "driver" else self.output_rate
        return 2.0 * pi * float(self.design.meshes[0].periods) / (float(self.design.period) * turns)

    def on_shafts(self, first: int, _: int) -> dict[str, int]:
        """Shaft of a drive for each of its ends, see `Built.on_shafts`."""
        return {self.driver: first, self.loaded: first + 1}

    def link(self, shafts: tuple[int, ...], _: StageTable) -> "TrainLink":
        """The train as a link of a drive, see `Built.link`; it has no place along its shafts."""
        from pitchpoint.efficiency.train_state import TrainLink

        return TrainLink(self.design, shafts)

    @property
    def member_motions(self) -> tuple[tuple[MemberMotion, ...], ...]:
        """Motion of the members of each mesh; planets move about their axis and with it."""
        rates = dict(zip(self.case.bodies, self.motion, strict=True))
        gears = {gear for place in self.design.meshes for gear in place.link.gears}

        def named(body: str, teeth: float, number: int) -> str:
            others = {gear for gear in gears if gear[0] == body} - {(body, teeth, number)}
            alike = any(gear[1] == teeth for gear in others)
            toothing = f"gear {number} of " * alike + f"{teeth:.0f} teeth"
            return f"{body}, {toothing}" if others else body

        def moving(
            mesh: Built, place: "TrainMesh", body: str, count: float, number: int
        ) -> MemberMotion:
            name = named(body, count, number)
            rate = rates.get(body, 0.0)
            if body not in self.design.planets:
                return MemberMotion(name, rate)
            orbit = rates[place.carrier] * float(mesh.dimensions["centre_distance"])
            return MemberMotion(name, rate, place.copies, orbit, place.carrier)

        return tuple(
            tuple(moving(mesh, place, *gear) for gear in place.link.gears)
            for mesh, place in zip(self.stages, self.design.meshes, strict=True)
        )

    @cached_property
    def backwards(self) -> "BuiltTrain":
        """The same train with its output driving, see `Built.backwards`."""
        step, point = self.output_rate, self.case.operation
        changed = point.model_copy(
            update={"torque": point.load * step, "speed": point.speed * step}
        )
        stages = tuple(stage.backwards for stage in self.stages)
        turned = self.design.driven_backwards([stage.design for stage in stages])
        case = self.case.model_copy(update={"operation": changed})
        return replace(
            self, case=case, stages=stages, design=turned, operation=operation_at(changed)
        )


Ready = Built | BuiltDrive
