"""From a validated case of several meshes to one built case a stage, and the drive that they make."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import gcd, pi
from typing import Any, TypeVar

import numpy as np

from pitchpoint._jax import array
from pitchpoint.cases.build import (
    Built,
    build,
    drags,
    gears_of,
    operation_at,
    without_bearing,
)
from pitchpoint.cases.built_drive import BuiltDrive, BuiltTrain, Ready, ends_of
from pitchpoint.cases.document import STAGES, Document, Provenance, Tree
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.schema import (
    TEMPERATURE,
    UNRATED,
    Case,
    DriveCase,
    Operating,
    StageTable,
    validated,
)
from pitchpoint.doubts import LEFT_OUT, REMARKED, Doubt
from pitchpoint.efficiency.drive import Drive, Stage, chained, owner
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.input.quantities import SIValue
from pitchpoint.lubrication.registry import ChosenLaws

__all__ = ["ready"]

T = TypeVar("T")

_SHARED = ("materials", "models", "strength")
"""Tables that stages share key by key; of the others a stage has its own or that of the drive."""

_OF_STAGE = ("lubricant", "roughness", "housing")

SEVERAL_MEETINGS = 10
"""Meshes of one gear of a shaft, over the common divisor, from which on nearly all phases meet."""


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
    meshes = [_mesh(one, number, document) for number, one in zip(numbers, alone, strict=True)]
    if case.train is None:
        alone = _following(alone, document)
        points = _points(case.operation, alone, document)
    else:
        # Only now: a pair or a chain does not load what trains take.
        from pitchpoint.cases.trains import turning_together

        alone, points = turning_together(case, alone, meshes)
    built: list[Built] = []
    for number, one, point in zip(numbers, alone, points, strict=True):
        loaded = one.model_copy(update={"operation": point})
        warmed = partial(_warm, loaded, documents[number - 1], own)
        built += filter(None, [wrong.tried(_in_stage, document, number, warmed)])
    wrong.demand_none()
    made = _together(case, built, documents)
    _check_map(made)
    return replace(made, told=(*made.told, *without_bearing(made)))


def _together(case: DriveCase, built: Sequence[Built], documents: Sequence[Document]) -> BuiltDrive:
    """The meshes of a case as one drive."""
    numbers, point = tuple(range(1, len(built) + 1)), operation_at(case.operation)
    parts = case, tuple(built), numbers, tuple(documents)
    if case.train is not None:
        from pitchpoint.cases.trains import about_trains, train_of

        return BuiltTrain(*parts, train_of(case, built), point, about_trains(case, built))
    told = (*_few_meetings(built), *_adding_thrusts(built), *_on_one_place(case, built))
    return BuiltDrive(*parts, _drive(case, built), point, told)


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
        first, _ = ends_of(_mesh(one, number, document))
        last = ends_of(_mesh(found[-1], number - 1, document))[1] if found else first
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


def _points(point: Operating, alone: Sequence[Case], document: Document) -> list[Operating]:
    """Operating point of each stage where nothing is lost."""
    ends = [ends_of(_mesh(one, number, document)) for number, one in enumerate(alone, 1)]
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
        bearing = [f"shaft {names[body] + 1}" for body in one.design.mesh.body.inner_bearing]
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
            yield Doubt(
                f"On shaft {shaft} {first} and {second} teeth mesh in a turn, with the common divisor "
                f"{common}: few of their phases meet. The ripple shown is that of the worst meeting of "
                "phases, and means are those over all of them.",
                moves=REMARKED,
                about=("torque_ripple",),
                brief=f"Shaft {shaft}: the ripple is that of the worst meeting of phases.",
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
        helical = [
            float(one.dimensions.get("overlap_ratio", 0.0)) > 0.0 for one in (before, behind)
        ]
        members = np.argmax(before.nominal["loaded"]), np.argmax(behind.nominal["driver"])
        if all(helical) and members[0] == members[1]:
            gear = before.case.gears.members[members[0]]
            yield (
                f"On shaft {shaft} the helical {gear}s of stages {shaft - 1} and {shaft} have opposite "
                "hands: their axial forces add up. Those of a gear 2 and a gear 1 counteract."
            )


def _on_one_place(case: DriveCase, built: Sequence[Built]) -> Iterator[str]:
    """Shafts on which faces of two gears lie over each other along the axis, where a case says any places."""
    tables = [*case.stages.values()]
    if not any("place" in table.model_fields_set for table in tables):
        return
    for shaft, (first, second) in enumerate(pairwise(zip(tables, built, strict=True)), 2):
        apart = abs(second[0].place - first[0].place)
        widths = (getattr(one.case.gears, "face_width", 0.0) for _, one in (first, second))
        half = [float(np.max(width)) / 2.0 for width in widths]
        if over := max(sum(half) - apart, 0.0):
            yield Doubt(
                f"On shaft {shaft} the gears of stages {shaft - 1} and {shaft} lie {1e3 * over:.4g} mm over "
                f"each other: their places are {1e3 * apart:.4g} mm apart and half their face widths sum to "
                f"{1e3 * sum(half):.4g} mm. Loads of bearings are those of these places; write a place "
                "for each stage.",
                moves=LEFT_OUT,
                brief=f"Gears on shaft {shaft} lie {1e3 * over:.4g} mm over each other.",
            )
