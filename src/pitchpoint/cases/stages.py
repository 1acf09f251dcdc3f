"""From a validated case of several meshes to one built case a stage, and the drive that they make."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise
from math import gcd, pi
from typing import Any, TypeVar

import numpy as np

from pitchpoint._jax import array
from pitchpoint.brief import brief
from pitchpoint.cases.build import (
    BEARING_FREE,
    TEETH_ALONE,
    Built,
    build,
    covered,
    drags,
    gears_of,
    operation_at,
    without_bearing,
)
from pitchpoint.cases.document import STAGES, Document, Provenance, Tree
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.schema import TEMPERATURE, Case, DriveCase, Operating, StageTable, validated
from pitchpoint.cases.strength import UNRATED
from pitchpoint.doubts import in_stage
from pitchpoint.drive.kinematics import Ends, Link, body_rates
from pitchpoint.efficiency.drive import Drive, Stage, chained, owner
from pitchpoint.efficiency.drive_summary import drive_figures
from pitchpoint.efficiency.quasi_static import Models, Operation
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.input.quantities import Quantity, SIValue
from pitchpoint.lubrication.registry import ChosenLaws, FrictionLaw
from pitchpoint.results.variable import End

__all__ = ["Acting", "BuiltDrive", "Ready", "ready"]

T = TypeVar("T")

_SHARED = ("materials", "models", "strength")
"""Tables that stages share key by key; of the others a stage has its own or that of the drive."""

_OF_STAGE = ("lubricant", "roughness", "housing")

SEVERAL_MEETINGS = 10
"""Meshes of one gear of a shaft, over the common divisor, from which on nearly all phases meet."""


@dataclass(frozen=True)
class Acting:
    """Laws that act together in all stages, under one friction law of the case.

    Attributes:
        law: friction law by which it is named: that of the case, or those of the stages.
        stages: models of each stage.
    """

    law: FrictionLaw
    stages: tuple[Models, ...]

    def __repr__(self) -> str:
        return brief(self)


@dataclass(frozen=True, eq=False)
class BuiltDrive:
    """A case of several meshes ready to compute.

    Attributes:
        case: as validated.
        stages: each built as a case of its own, at the load and speed that it has without losses.
        numbers: of the stages in the file, in the order of the power.
        documents: each stage came from, in the same order.
        design: the drive.
        operation: torque at the output, speed of the input.
        told: sentences about the drive.
    """

    case: DriveCase
    stages: tuple[Built, ...]
    numbers: tuple[int, ...]
    documents: tuple[Document, ...]
    design: Drive
    operation: Operation
    told: tuple[str, ...]

    def __repr__(self) -> str:
        return brief(self)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences about the drive, and about each of its stages."""
        of_stages = (
            in_stage(number, text)
            for number, one in zip(self.numbers, self.stages, strict=True)
            for text in one.warnings
            if text not in (TEETH_ALONE, BEARING_FREE)
        )
        return (*self.told, *of_stages)

    @property
    def heated(self) -> list[str]:
        """Sentences on teeth that their own loss warms, by stage."""
        each = zip(self.numbers, self.stages, strict=True)
        return [in_stage(number, text) for number, one in each for text in one.heated]

    @cached_property
    def models(self) -> tuple[Acting, ...]:
        """Laws that act together, once under each friction law of the case."""
        count = max(len(one.models) for one in self.stages)
        each = [one.models * count if len(one.models) == 1 else one.models for one in self.stages]
        return tuple(self._acting(models) for models in zip(*each, strict=True))

    def under(self, laws: Sequence[FrictionLaw]) -> tuple[Acting, ...]:
        """The models of the case under other friction laws; stages with one of their own keep it."""
        each = [
            one.models[:1] * len(laws) if own else one.under(laws)
            for one, own in zip(self.stages, self.own_friction, strict=True)
        ]
        return tuple(self._acting(models) for models in zip(*each, strict=True))

    def _acting(self, models: Sequence[Models]) -> Acting:
        own = self.own_friction
        each = sorted(zip(self.numbers, models, own, strict=True), key=lambda one: one[0])
        free = [one.law for _, one, mine in each if all(own) or not mine]
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
        each = [one.applicable for one, own in pairs if not own]
        return [law for law in (each[0] if each else []) if all(law in other for other in each)]

    @property
    def temperatures(self) -> tuple[float, float]:
        """Lowest and highest temperature of all oils [K]."""
        low, high = zip(*(one.temperatures for one in self.stages), strict=True)
        return max(low), min(high)

    @property
    def meshes(self) -> tuple[Built, ...]:
        """Meshes that the case has: its stages."""
        return self.stages

    @property
    def travels(self) -> frozenset[End]:
        """Those of driver and loaded shaft that travel in place of turning."""
        ends: dict[End, Built] = {"driver": self.stages[0], "loaded": self.stages[-1]}
        return frozenset(end for end, one in ends.items() if end in one.travels)

    @property
    def carried(self) -> Quantity:
        """What the output takes, torque or force."""
        return self.stages[-1].carried

    @property
    def driver(self) -> str:
        """Name of the shaft that drives."""
        return f"shaft {self.design.links[0][0] + 1}"

    @property
    def loaded(self) -> str:
        """Name of the shaft that carries the load."""
        return f"shaft {self.design.links[-1][1] + 1}"

    @property
    def transmits(self) -> bool:
        """True: power goes through every drive."""
        return True

    @property
    def covers(self) -> dict[str, str]:
        """What the efficiency is of, see `Built.covers`."""
        return covered(self.places, lacks_bearing=self.lacks_bearing)

    @property
    def lacks_bearing(self) -> bool:
        """True where no loss stands for a bearing inside one of the stages, see `Built.lacks_bearing`."""
        between_shafts = any("housing" not in loss.between for loss in self.case.losses.values())
        return not between_shafts and any(one.lacks_bearing for one in self.stages)

    @property
    def places(self) -> list[str]:
        """Names of the places beside the teeth where power is lost: of the drive, then of its stages."""
        own = [
            f"stage {number} {name}"
            for number, one in zip(self.numbers, self.stages, strict=True)
            for name in one.case.losses
        ]
        return [*self.case.losses, *own]

    @cached_property
    def at_work(self) -> tuple[Built, ...]:
        """Meshes under the mean torques that they carry with all losses, by the first friction law.

        Where friction locks the drive they are those without losses.
        """
        figures = drive_figures([(self.design, self.operation)], self.models[0].stages)
        driving = figures["stage_input_torque"][0]
        if np.isnan(driving).any():
            return self.stages
        pairs = zip(self.stages[:-1], driving[1:].tolist(), strict=True)
        return (*(mesh.carrying(torque) for mesh, torque in pairs), self.stages[-1])

    @cached_property
    def motion(self) -> list[float]:
        """Rates of the shafts for a radian of the input."""
        shafts = [
            f"shaft {number + 1}" for first, last in self.design.links for number in (first, last)
        ]
        links = [
            Link(stage.design.mesh, tuple(f"shaft {number + 1}" for number in stage.shafts))
            for stage in self.design.stages
        ]
        held = {body for link in links for body in link.bodies} - {*shafts}
        rates = body_rates(
            links, Ends({shafts[0]: _ends(self.stages[0].design.mesh)[0]}, tuple(held))
        )
        return [rates[shaft] for shaft in dict.fromkeys(shafts)]

    @cached_property
    def backwards(self) -> "BuiltDrive":
        """The same drive with its output driving, see `Built.backwards`."""
        step = float(np.abs(self.motion[-1] / self.motion[0]))
        point = self.case.operation
        stages = tuple(one.backwards for one in reversed(self.stages))
        load = {"torque": None, "force": None, stages[-1].carried.kind: point.load * step}
        changed = point.model_copy(update={**load, "speed": point.speed * step})
        turned = self.design.driven_backwards()
        warm = [
            replace(place, design=replace(place.design, solids=one.design.solids))
            for place, one in zip(turned.stages, stages, strict=True)
        ]
        return replace(
            self,
            case=self.case.model_copy(update={"operation": changed}),
            stages=stages,
            numbers=self.numbers[::-1],
            documents=self.documents[::-1],
            design=replace(turned, stages=tuple(warm)),
            operation=operation_at(changed),
        )


Ready = Built | BuiltDrive


def ready(case: Case | DriveCase, document: Document, own: ChosenLaws = ()) -> Ready:
    """A case of one mesh or of several, ready to compute.

    Raises:
        InputError: see `build`; stages that do not follow each other.
    """
    if isinstance(case, Case):
        return _warm(case, document, own)
    try:
        return _built(case, document, own)
    except InputError as error:
        raise error.at(file=document.name) from None


def _warm(case: Case, document: Document, own: ChosenLaws) -> Built:
    """One mesh with its teeth as warm as their loss makes them."""
    cold = build(case, document, own)
    try:
        return cold.warmed
    except InputError as error:
        raise error.at(file=document.name) from None


def _built(case: DriveCase, document: Document, own: ChosenLaws) -> BuiltDrive:
    numbers = range(1, len(case.stages) + 1)
    documents = [_of_stage(case, document, number) for number in numbers]
    wrong = Complaints()
    alone: list[Case] = []
    for number, inside in zip(numbers, documents, strict=True):
        read = partial(validated, Case, inside)
        alone += filter(None, [wrong.tried(_in_stage, document, number, read)])
    wrong.demand_none()
    for number, one in zip(numbers, alone, strict=True):
        wrong.tried(_mesh, one, number, document)
    wrong.demand_none()
    _check_laws(alone)
    _check_rated(case, alone)
    alone = _following(alone, document)
    points = _points(case.operation, alone, document)
    built: list[Built] = []
    for number, one, point in zip(numbers, alone, points, strict=True):
        loaded = one.model_copy(update={"operation": point})
        warmed = partial(_warm, loaded, documents[number - 1], own)
        built += filter(None, [wrong.tried(_in_stage, document, number, warmed)])
    wrong.demand_none()
    drive = _drive(case, built)
    made = BuiltDrive(
        case,
        tuple(built),
        tuple(numbers),
        tuple(documents),
        drive,
        operation_at(case.operation),
        (*_few_meetings(built), *_adding_thrusts(built)),
    )
    _check_map(made)
    return replace(made, told=(*made.told, *without_bearing(made)))


def _check_map(made: BuiltDrive) -> None:
    """InputError if the loss map runs over temperatures at which an oil of the drive is not known."""
    low, high = made.temperatures
    for asked in (made.case.loss_map and made.case.loss_map.temperatures) or ():
        if not low <= asked <= high:
            allowed = replace(TEMPERATURE, low=low, high=high).allowed
            raise InputError(
                f"{TEMPERATURE.show(asked)} is outside the range of the oil; {allowed}",
                key="loss_map.temperatures",
            )


def _of_stage(case: DriveCase, document: Document, number: int) -> Document:
    """A stage as a case of its own: its tables, and those of the drive for what it leaves out."""
    whole, stage = document.tree, document.tree[STAGES][str(number)]
    tree: Tree = {key: stage.get(key, whole[key]) for key in _OF_STAGE if key in {*stage, *whole}}
    gears = case.stages[str(number)].gears
    shared = {key: whole.get(key, {}) for key in _SHARED if gears.rated or key != "strength"}
    both = {key: {**shared.get(key, {}), **stage.get(key, {})} for key in _SHARED}
    tree |= {key: table for key, table in both.items() if table}
    tree |= {key: stage[key] for key in ("gears", "losses", "film", "wear") if key in stage}
    kept = {key: whole["operation"][key] for key in ("speed", "temperature")}
    tree["operation"] = {**kept, gears.load: SIValue(case.operation.load)}
    if "driver" in stage:
        tree["operation"]["driver"] = stage["driver"]
    return Document(document.name, tree, _marks(document.provenance, number, stage))


def _marks(given: Mapping[str, Provenance], number: int, stage: Tree) -> dict[str, Provenance]:
    """Where values of a stage come from, by its own keys."""
    inside = f"{STAGES}.{number}."
    replaced = [key for key in stage if key not in _SHARED]
    found = {
        key: mark
        for key, mark in given.items()
        if not key.startswith(f"{STAGES}.") and key.partition(".")[0] not in replaced
    }
    own = {key.removeprefix(inside): mark for key, mark in given.items() if key.startswith(inside)}
    return {**found, **own}


def _in_stage(document: Document, number: int, make: Callable[[], T]) -> T:
    """What a function makes of a stage; what is wrong there is told under its key in the file."""
    try:
        return make()
    except InputError as error:
        wrong = Complaints()
        for one in error.every:
            if isinstance(one, InputError):
                wrong.add(_of_the_drive(one, document, number))
        raise wrong.error from None


def _of_the_drive(error: InputError, document: Document, number: int) -> InputError:
    """An error of a stage with the key that it has in the file of the drive."""
    key = error.key or ""
    if key == "operation.driver":
        return error.at(key=_key(number, "driver"))
    node: Any = document.tree[STAGES][str(number)]
    for part in key.split(".")[: 2 if key.partition(".")[0] in _SHARED else 1]:
        node = node.get(part) if isinstance(node, Mapping) else None
    if node is not None:
        return error.at(key=_key(number, key))
    message = f"stage {number}: {error.message}"
    return InputError(message, file=error.file, key=error.key, value=error.value)


def _key(number: int, key: str) -> str:
    return f"{STAGES}.{number}.{key}"


def _check_laws(alone: Sequence[Case]) -> None:
    """InputError if stages have several friction laws, but not as many as the others."""
    counts = [len(one.models.friction) for one in alone]
    for number, count in enumerate(counts, 1):
        for choice in alone[number - 1].models.friction:
            if FRICTION[choice.name].films is not None:
                raise InputError(
                    f"'{choice.name}' solves films in turns with the forces of one mesh; stages take "
                    "formulas",
                    key=_key(number, "models.friction"),
                )
        if count not in (1, max(counts)):
            raise InputError(
                f"{count} friction laws were given where another stage has {max(counts)}; give one, which "
                "stands beside each of them, or as many",
                key=_key(number, "models.friction"),
            )


def _check_rated(case: DriveCase, alone: Sequence[Case]) -> None:
    """InputError for a table on strength that no stage has a use for."""
    if case.strength is not None and not any(one.gears.rated for one in alone):
        raise InputError(UNRATED, key="strength")


def _following(alone: Sequence[Case], document: Document) -> list[Case]:
    """Stages with the flanks by which each turns its first shaft as the one before it does.

    Raises:
        InputError: no choice of those that were left open does so.
    """
    found: list[Case] = []
    for number, one in enumerate(alone, 1):
        first, _ = _ends(_mesh(one, number, document))
        last = _ends(_mesh(found[-1], number - 1, document))[1] if found else first
        if first * last < 0.0:
            if _open(one):
                one = _turned(one)
            elif all(map(_open, alone[: number - 1])):
                found = [*map(_turned, found)]
            else:
                raise _against(one, number)
        found.append(one)
    return found


def _open(one: Case) -> bool:
    """True if the flanks are left to the reader."""
    return one.gears.opposed is not None and "flank" not in one.gears.model_fields_set


def _turned(one: Case) -> Case:
    """The stage with its other flanks in contact, so that all turns the other way."""
    return one.model_copy(update={"gears": one.gears.opposed})


def _against(one: Case, number: int) -> InputError:
    if one.gears.opposed is None:
        told = (
            f"these gears carry on the flanks for one sense of rotation alone, and shaft {number} turns "
            "the other way; leave the flanks of the stages before them open"
        )
        return InputError(told, key=_key(number, "gears"))
    told = (
        f"with these flanks in contact shaft {number} turns against the stage before it; leave flank out, or "
        "take the others"
    )
    return InputError(told, key=_key(number, "gears.flank"))


def _mesh(one: Case, number: int, document: Document) -> Mesh:
    return _in_stage(document, number, partial(_mesh_alone, one))


def _mesh_alone(one: Case) -> Mesh:
    gears = gears_of(one, wrong := Complaints())
    if gears is None:
        raise wrong.error
    return gears[0]


def _ends(mesh: Mesh) -> tuple[float, float]:
    """Rates of the driver and of the loaded member."""
    motion = np.asarray(mesh.motion)
    return float(np.asarray(mesh.driver) @ motion), float(np.asarray(mesh.loaded) @ motion)


def _points(point: Operating, alone: Sequence[Case], document: Document) -> list[Operating]:
    """Operating point of each stage where nothing is lost."""
    ends = [_ends(_mesh(one, number, document)) for number, one in enumerate(alone, 1)]
    steps = np.array([abs(last / first) for first, last in ends])
    speeds = point.speed * np.cumprod([1.0, *steps[:-1]])
    loads = point.load * np.cumprod([1.0, *steps[:0:-1]])[::-1]
    return [
        one.operation.model_copy(update={one.gears.load: float(load), "speed": float(speed)})
        for one, load, speed in zip(alone, loads, speeds, strict=True)
    ]


def _drive(case: DriveCase, built: Sequence[Built]) -> Drive:
    """The stages on their shafts, with what brakes these."""
    count = len(built) + 1
    held = 0
    stages, inner = [], set()
    for first, (one, table) in enumerate(zip(built, case.stages.values(), strict=True)):
        names = _on_shafts(one, first, count + held)
        held += len(names) - 2
        stages.append(_stage(one, table, tuple(names.values())))
        bearing = [f"shaft {names[body] + 1}" for body in one.design.mesh.inner_bearing]
        inner.add(frozenset(bearing))
    still = [f"held {number}" for number in range(held)]
    bodies = (*case.bodies, *still)
    placed = drags(case.losses, bodies, inner - {frozenset()})
    for name, drag in zip(case.losses, placed, strict=True):
        try:
            owner(drag, stages)
        except InputError as error:
            raise error.at(key=f"losses.{name}.between") from None
    return chained(stages, placed)


def _on_shafts(one: Built, first: int, free: int) -> dict[str, int]:
    """Shaft of each member of a stage; a member that is held has a number of its own."""
    found: dict[str, int] = {}
    for number, name in enumerate(one.case.gears.members):
        drives, loaded = (one.nominal[end][number] for end in ("driver", "loaded"))
        found[name] = first if drives else first + 1 if loaded else free
        free += not (drives or loaded)
    return found


def _stage(one: Built, table: StageTable, shafts: tuple[int, ...]) -> Stage:
    return Stage(one.design, shafts, array(table.turn), array(table.place))


def _few_meetings(built: Sequence[Built]) -> Iterator[str]:
    """Shafts on which few phases of two meshes meet, where all are assumed to."""
    for shaft, (before, behind) in enumerate(pairwise(built), 2):
        meshes = [_per_turn(before, "loaded"), _per_turn(behind, "driver")]
        first, second = (round(count) for count in meshes)
        common = gcd(first, second)
        if min(first, second) // common < SEVERAL_MEETINGS:
            yield (
                f"On shaft {shaft} {first} and {second} teeth mesh in a turn, with the common divisor "
                f"{common}: few of their phases meet. The ripple shown is that of the worst meeting of "
                "phases, and means are those over all of them."
            )


def _per_turn(one: Built, end: str) -> float:
    """Mesh periods in a turn of the driver or of the loaded member of a stage."""
    rate = abs(float(one.nominal[end] @ one.nominal["motion"]))
    return 2.0 * pi / (float(one.nominal["period"]) * rate)


def _adding_thrusts(built: Sequence[Built]) -> Iterator[str]:
    """Shafts on which two helical gears press the same way along the axis.

    The frame of a mesh gives its two members opposite hands, and other flanks turn both over.
    """
    for shaft, (before, behind) in enumerate(pairwise(built), 2):
        helical = [float(one.design.mesh.overlap_ratio) > 0.0 for one in (before, behind)]
        members = np.argmax(before.nominal["loaded"]), np.argmax(behind.nominal["driver"])
        if all(helical) and members[0] == members[1]:
            gear = before.case.gears.members[members[0]]
            yield (
                f"On shaft {shaft} the helical {gear}s of stages {shaft - 1} and {shaft} have opposite "
                "hands: their axial forces add up. Those of a gear 2 and a gear 1 counteract."
            )
