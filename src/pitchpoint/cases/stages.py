"""From a validated case of several stages to one built case a stage, and the drive that they make."""

import copy
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np

from pitchpoint.cases.build import build, gears_of
from pitchpoint.cases.built import Built, ends_of, operation_at, without_bearing
from pitchpoint.cases.built_drive import BuiltDrive, BuiltTrain, Ready
from pitchpoint.cases.document import STAGES, Document, Provenance, Tree, setting
from pitchpoint.cases.drive_schema import DriveCase, is_planetary
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.validation import planetary_of, validate, with_meshes
from pitchpoint.core.doubts import LEFT_OUT, REMARKED, Doubt
from pitchpoint.efficiency.drag import drags
from pitchpoint.efficiency.drive import Drive, chained, loss_owner
from pitchpoint.efficiency.operation_tables import Operating
from pitchpoint.errors import Complaints, InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.planetary import PlanetaryGears, in_words_of_set
from pitchpoint.input.kinds import TEMPERATURE
from pitchpoint.input.quantities import SIValue
from pitchpoint.lubrication.lubrication_registry import ChosenLaws
from pitchpoint.materials.material_tables import OF_SET, of_set
from pitchpoint.strength.strength_table import UNRATED

__all__ = ["as_spelt", "ready"]

T = TypeVar("T")

_SHARED = ("materials", "models", "strength")
"""Tables that stages share key by key; of the others a stage has its own or that of the drive."""

_OF_STAGE = ("lubricant", "roughness", "housing")

SEVERAL_MEETINGS = 10
"""Meshes of one gear of a shaft, over the common divisor, from which on nearly all phases meet."""

MOST_TEETH = 10_000
"""Teeth that mesh in a turn, up to which the ratio of two such numbers is taken as that of whole ones."""


def ready(
    case: CaseFile | DriveCase, document: Document, own: ChosenLaws = (), *, advised: bool = True
) -> Ready:
    """A case of one mesh or of several, ready to compute.

    Args:
        case: as validated.
        document: that it came from.
        own: friction laws in place of those of the case.
        advised: False to leave out, as for points of a sweep, what changes would mend a set that is refused.

    Raises:
        InputError: see `build`; stages that do not follow each other.
    """
    if isinstance(case, CaseFile):
        return _warm(case, document, own)
    with _spelt(document, advised):
        return _built(case, document, own, advised=advised)


def _warm(case: CaseFile, document: Document, own: ChosenLaws) -> Built:
    """One mesh with its teeth as warm as their loss makes them."""
    cold = build(case, document, own)
    try:
        return cold.warmed
    except InputError as error:
        raise error.at(file=document.name) from None


@contextmanager
def _spelt(document: Document, advised: bool = False) -> Iterator[None]:
    """What is wrong inside is told with the file and the keys that it has."""
    try:
        yield
    except InputError as error:
        raise as_spelt(error, document, advised=advised).at(file=document.name) from None


def as_spelt(
    error: InputError, document: Document, *, advised: bool = False, further: bool = True
) -> InputError:
    """An error with the keys that the file has, where a planetary set stands for its meshes.

    Args:
        error: of the meshes.
        document: of the set.
        advised: True for changes that mend it: those of one mesh that do so for the set, which is tried.
        further: True for changes that need those of another mesh beside them.
    """
    if not is_planetary(document.tree):
        return error
    try:
        gears = planetary_of(document)
    except InputError:  # which is the error itself
        return error
    wrong = Complaints()
    keys = [input_error.key for input_error in error.every if isinstance(input_error, InputError)]
    for complaint in error.every:
        if isinstance(complaint, InputError):
            spelt = in_words_of_set(complaint, gears)
            if spelt.cures and (complaint.key or "").startswith(STAGES):
                others = {key for key in keys if key != complaint.key}
                every = spelt.cures if advised else ()
                mended = (_mended(change, document, others, further) for change in every)
                spelt = _ended_with_cures(spelt, [*filter(None, mended)])
            wrong.add(spelt)
    return wrong.error if wrong else error


def _mended(
    change: Tree, document: Document, others: set[str | None], further: bool
) -> Tree | None:
    """A change after which a set runs, but for what is wrong with other keys; None where it does not.

    What such a change leaves wrong with one of its own keys, in another mesh, is mended beside it.
    """
    try:
        _changed_drive(document, change)
    except InputError as left:
        keys = {complaint.key for complaint in left.every if isinstance(complaint, InputError)}
        if not keys <= others:
            return None
        leaves = {(key or "").rpartition(".")[2] for key in keys}
        if leaves.isdisjoint(key.rpartition(".")[2] for key in change):
            return change
        if not further:
            return None
        rest = as_spelt(left, _changed(document, change), advised=True, further=False)
        cures = (
            cure
            for complaint in rest.every
            if isinstance(complaint, InputError)
            for cure in complaint.cures
        )
        return next(({**change, **cure} for cure in cures), None)
    return change


def _ended_with_cures(error: InputError, sound: Sequence[Tree]) -> InputError:
    """An error of a mesh of a set with changes that mend it."""
    from pitchpoint.gears.cylindrical.cures import error_with_cures

    longer = copy.copy(error)
    bare = [{key.removeprefix("gears."): value for key, value in cure.items()} for cure in sound]
    longer.message, longer.cures = error_with_cures(error.message, bare), tuple(sound)
    return longer


def _changed_drive(document: Document, change: Tree) -> BuiltDrive:
    """The drive of a document with other values."""
    changed = with_meshes(_changed(document, change))
    case = validate(changed)
    assert isinstance(case, DriveCase)
    return _built(case, changed, (), advised=False)


class _Stage(NamedTuple):
    """A stage of a drive as a case of its own.

    Attributes:
        number: in the file.
        case: of one mesh, or of a planetary set with the meshes for which it stands.
        document: that it came from.
    """

    number: int
    case: CaseFile | DriveCase
    document: Document


def _alone(case: DriveCase, document: Document, *, advised: bool = False) -> list[_Stage]:
    """Each stage as a case of its own, at the load and speed of the drive; `advised` as in `ready`."""
    wrong = Complaints()
    stages: list[_Stage] = []
    for number in range(1, len(case.stages) + 1):
        inside = _of_stage(case, document, number)

        def read(inside: Document = inside, number: int = number) -> _Stage:
            spelt_out = with_meshes(inside)
            with _spelt(inside, advised):
                return _Stage(number, validate(spelt_out), spelt_out)

        stages += filter(None, [wrong.tried(_in_stage, document, number, read)])
    wrong.demand_none()
    for stage in stages:
        wrong.tried(_turns, stage, document, advised=advised)
    wrong.demand_none()
    return stages


def _built(
    case: DriveCase, document: Document, own: ChosenLaws, *, advised: bool = True
) -> BuiltDrive:
    """A drive of several meshes.

    Args:
        case, document, own: see `ready`.
        advised: True if it is told of planets that do not fit in which ones do.
    """
    alone = _alone(case, document, advised=advised)
    _check_laws(alone)
    _check_rated(case)
    if case.train is None:
        alone = _following(alone, document)
        points = _points(case.operation, alone, document)
        cases: Sequence[CaseFile | DriveCase] = [stage.case for stage in alone]
    else:
        # Only now: a pair or a chain does not load what trains take.
        from pitchpoint.cases.trains import turning_together

        cases, points = turning_together(case, *_of_train(alone, document))
    wrong = Complaints()
    built: list[Any] = []  # each a mesh or a set
    for stage, stage_case, point in zip(alone, cases, points, strict=True):
        loaded = stage_case.model_copy(update={"operation": point})
        warmed = partial(ready, loaded, stage.document, own, advised=advised)
        built += filter(None, [wrong.tried(_in_stage, document, stage.number, warmed)])
    wrong.demand_none()
    try:
        drive = _together(case, built, [stage.document for stage in alone])
    except InputError as error:
        if advised and error.key in OF_PLANETS:
            raise _with_fitting(error, case, document, built) from None
        raise
    _check_map(drive)
    if case.duty is not None:
        from pitchpoint.cases.built_duty import duty_inputs

        duty_inputs(case.duty, case.operation.temperature, travels="loaded" in drive.travels)
    bearing = without_bearing(drive.places, lacks_bearing=drive.lacks_bearing)
    return replace(drive, told=(*drive.told, *bearing))


OF_PLANETS = ("train.planets", "train.planet_angles")
"""Keys of planets that do not fit in."""


def _with_fitting(
    error: InputError, case: DriveCase, document: Document, built: Sequence[Built]
) -> InputError:
    """An error of planets that do not fit in, with teeth and angles that do."""
    from pitchpoint.cases.planet_fit import with_fitting
    from pitchpoint.cases.trains import rates_of

    def attempt(change: Tree) -> float:
        return float(_changed_drive(document, change).trains[0].design.ratio)

    train = case.train
    assert train is not None
    rates = rates_of(case, [stage.design.mesh for stage in built])
    return with_fitting(error, case, rates[train.input] / rates[train.output], attempt)


def _changed(document: Document, change: Tree) -> Document:
    """A document with other values; a planetary set has its meshes to be made anew."""
    of_set = (STAGES, "train") if is_planetary(document.tree) else ()
    tree = {key: table for key, table in document.tree.items() if key not in of_set}
    for key, value in change.items():
        tree = setting(tree, key, value)
    return replace(document, tree=tree)


def _of_train(alone: Sequence[_Stage], document: Document) -> tuple[list[CaseFile], list[Mesh]]:
    """Cases and meshes of the stages of a train."""
    cases = [stage.case for stage in alone if isinstance(stage.case, CaseFile)]
    return cases, [_mesh(stage, number, document) for number, stage in enumerate(cases, 1)]


def _together(
    case: DriveCase, built: Sequence[Built | BuiltTrain], documents: Sequence[Document]
) -> BuiltDrive:
    """The stages of a case as one drive."""
    numbers, point = tuple(range(1, len(built) + 1)), operation_at(case.operation)
    if case.train is not None:
        from pitchpoint.cases.trains import about_trains, train_of

        meshes = tuple(mesh for stage in built for mesh in stage.meshes)
        warnings = about_trains(case, meshes)
        return BuiltTrain(
            case, meshes, numbers, tuple(documents), train_of(case, meshes), point, warnings
        )
    warnings = (
        *_few_meetings(built),
        *_adding_thrusts(built),
        *_on_one_place(case, built),
        *_on_vibration(case),
    )
    drive = _drive(case, built)
    return BuiltDrive(case, tuple(built), numbers, tuple(documents), drive, point, warnings)


def _check_map(made: BuiltDrive) -> None:
    """InputError if the loss map runs over temperatures at which an oil of the drive is not known."""
    low, high = made.temperatures
    for temperature in (made.case.loss_map and made.case.loss_map.temperatures) or ():
        if not low <= temperature <= high:
            allowed = replace(TEMPERATURE, low=low, high=high).allowed
            raise InputError(
                f"{TEMPERATURE.show(temperature)} is outside the range of the oil; {allowed}",
                key="loss_map.temperatures",
            )


def _of_stage(case: DriveCase, document: Document, number: int) -> Document:
    """A stage as a case of its own: its tables, and those of the drive for what it leaves out."""
    drive, stage = document.tree, document.tree[STAGES][str(number)]
    tree: Tree = {key: stage.get(key, drive[key]) for key in _OF_STAGE if key in {*stage, *drive}}
    gears = case.stages[str(number)].gears
    shared = {key: drive.get(key, {}) for key in _SHARED if gears.rated or key != "strength"}
    shared["materials"] = _materials(shared["materials"], stage.get("materials", {}), gears)
    both = {key: {**shared.get(key, {}), **stage.get(key, {})} for key in _SHARED}
    tree |= {key: table for key, table in both.items() if table}
    tree |= {
        key: stage[key]
        for key in ("gears", "losses", "film", "wear", "worn", "dynamics")
        if key in stage
    }
    conditions = {key: drive["operation"][key] for key in ("speed", "temperature")}
    tree["operation"] = {**conditions, gears.load: SIValue(case.operation.load)}
    if "driver" in stage:
        tree["operation"]["driver"] = stage["driver"]
    return Document(document.name, tree, _marks(document.provenance, number, stage))


def _materials(whole: Tree, stage: Tree, gears: Any) -> Tree:
    """Materials of the drive that count for a stage: of the gears of a set where it is one with its own."""
    of_gears = of_set((*whole, *stage)) and isinstance(gears, PlanetaryGears)
    return {key: value for key, value in whole.items() if (key in OF_SET) == bool(of_gears)}


def _marks(given: Mapping[str, Provenance], number: int, stage: Tree) -> dict[str, Provenance]:
    """Where values of a stage come from, by its own keys."""
    inside = f"{STAGES}.{number}."
    replaced = [key for key in stage if key not in _SHARED]
    inherited = {
        key: mark
        for key, mark in given.items()
        if not key.startswith(f"{STAGES}.") and key.partition(".")[0] not in replaced
    }
    stated = {
        key.removeprefix(inside): mark for key, mark in given.items() if key.startswith(inside)
    }
    return {**inherited, **stated}


def _in_stage(document: Document, number: int, make: Callable[[], T]) -> T:
    """What a function makes of a stage; what is wrong there is told under its key in the file."""
    try:
        return make()
    except InputError as error:
        wrong = Complaints()
        for complaint in error.every:
            if isinstance(complaint, InputError):
                wrong.add(_of_the_drive(complaint, document, number))
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


def _check_laws(alone: Sequence[_Stage]) -> None:
    """InputError if stages have several friction laws, but not as many as the others."""
    counts = [len(stage.case.models.friction) for stage in alone]
    for number, count in enumerate(counts, 1):
        for choice in alone[number - 1].case.models.friction:
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


def _check_rated(case: DriveCase) -> None:
    """InputError for a table on strength that no stage has a use for."""
    if case.strength is not None and not any(stage.gears.rated for stage in case.stages.values()):
        raise InputError(UNRATED, key="strength")


def _following(alone: Sequence[_Stage], document: Document) -> list[_Stage]:
    """Stages with the flanks by which each turns its first shaft as the one before it does.

    A planetary set turns either way alike.

    Raises:
        InputError: no choice of those that were left open does so.
    """
    stages: list[_Stage] = []
    incoming = 0.0
    for stage in alone:
        driver_rate, loaded = _turns(stage, document)
        mesh = stage.case
        if not isinstance(mesh, CaseFile):
            incoming *= np.sign(driver_rate * loaded)
            stages.append(stage)
            continue
        if driver_rate * incoming < 0.0:
            if _open(stage):
                stage, loaded = _turned(stage), -loaded
            elif all(
                not isinstance(before.case, CaseFile) or _open(before)
                for before in alone[: len(stages)]
            ):
                stages = [*map(_turned, stages)]
            else:
                raise _against(mesh, stage.number)
        incoming = loaded
        stages.append(stage)
    return stages


def _open(stage: _Stage) -> bool:
    """True if the flanks of a mesh are left to the reader."""
    assert isinstance(stage.case, CaseFile)
    gears = stage.case.gears
    return gears.opposed is not None and "flank" not in gears.model_fields_set


def _turned(stage: _Stage) -> _Stage:
    """The stage with its other flanks in contact, so that all turns the other way."""
    if not isinstance(stage.case, CaseFile):
        return stage
    return stage._replace(case=stage.case.model_copy(update={"gears": stage.case.gears.opposed}))


def _against(one: CaseFile, number: int) -> InputError:
    if one.gears.opposed is None:
        message = (
            f"these gears carry on the flanks for one sense of rotation alone, and shaft {number} turns "
            "the other way; leave the flanks of the stages before them open"
        )
        return InputError(message, key=_key(number, "gears"))
    message = (
        f"with these flanks in contact shaft {number} turns against the stage before it; leave flank out, or "
        "take the others"
    )
    return InputError(message, key=_key(number, "gears.flank"))


def _mesh(one: CaseFile, number: int, document: Document) -> Mesh:
    return _in_stage(document, number, partial(_mesh_alone, one))


def _mesh_alone(one: CaseFile) -> Mesh:
    gears = gears_of(one, wrong := Complaints())
    if gears is None:
        raise wrong.error
    return gears[0]


def _turns(stage: _Stage, document: Document, *, advised: bool = False) -> tuple[float, float]:
    """Rates of the driver and of the loaded end of a stage; of a set of bodies for one of its input.

    Args:
        stage, document: of the drive.
        advised: see `ready`.
    """
    if isinstance(stage.case, CaseFile):
        return ends_of(stage.case, _mesh(stage.case, stage.number, document))
    rate = partial(_rate_of_output, stage.case, stage.document, advised=advised)
    return 1.0, _in_stage(document, stage.number, rate)


def _rate_of_output(case: DriveCase, document: Document, *, advised: bool) -> float:
    """Rate of the output of a set for one of its input."""
    from pitchpoint.cases.trains import rates_of

    assert case.train is not None
    with _spelt(document, advised):
        _, meshes = _of_train(_alone(case, document), document)
        rates = rates_of(case, meshes)
    return rates[case.train.output] / rates[case.train.input]


def _points(point: Operating, alone: Sequence[_Stage], document: Document) -> list[Operating]:
    """Operating point of each stage where nothing is lost."""
    ends = [_turns(stage, document) for stage in alone]
    steps = np.array([abs(loaded_rate / driver_rate) for driver_rate, loaded_rate in ends])
    speeds = point.speed * np.cumprod([1.0, *steps[:-1]])
    loads = point.load * np.cumprod([1.0, *steps[:0:-1]])[::-1]
    return [
        stage.case.operation.model_copy(
            update={_load_of(stage): float(load), "speed": float(speed)}
        )
        for stage, load, speed in zip(alone, loads, speeds, strict=True)
    ]


def _load_of(stage: _Stage) -> str:
    """What the loaded member of a stage takes, torque or force."""
    return stage.case.gears.load if isinstance(stage.case, CaseFile) else "torque"


def _drive(case: DriveCase, built: Sequence[Built | BuiltTrain]) -> Drive:
    """The stages on their shafts, with what brakes these."""
    count = len(built) + 1
    held = 0
    links, inner = [], set()
    for shaft, (stage, table) in enumerate(zip(built, case.stages.values(), strict=True)):
        names = stage.on_shafts(shaft, count + held)
        held += len(names) - 2
        links.append(stage.link(tuple(names.values()), table))
        inner.add(frozenset(f"shaft {names[body] + 1}" for body in stage.inner_bearing))
    still = [f"held {number}" for number in range(held)]
    bodies = (*case.bodies, *still)
    placed = drags(case.losses, bodies, inner - {frozenset()})
    for (name, loss), drag in zip(case.losses.items(), placed, strict=True):
        try:
            overcome_by = links[loss_owner(drag, links)]
        except InputError as error:
            raise error.at(key=f"losses.{name}.between") from None
        placed_along = {"position", "locating"} & loss.model_fields_set
        if placed_along and not overcome_by.presses_bearings:
            raise InputError(
                "was given; a planetary set presses the bearings of its shafts by what does not cancel "
                "around them: one bearing stands for all of such a shaft, without a place",
                key=f"losses.{name}.{min(placed_along)}",
            )
    return chained(links, placed)


def _few_meetings(built: Sequence[Built | BuiltTrain]) -> Iterator[str]:
    """Shafts on which few phases of two stages meet, where all are assumed to."""
    for shaft, (before, behind) in enumerate(pairwise(built), 2):
        meshes = [before.periods_per_turn("loaded"), behind.periods_per_turn("driver")]
        # Meshes of a set go by in fractions of a tooth for a turn against the housing.
        often = Fraction(meshes[0] / meshes[1]).limit_denominator(MOST_TEETH)
        if min(often.numerator, often.denominator) < SEVERAL_MEETINGS:
            first, second = (f"{count:.6g}" for count in meshes)
            ratio = (
                f"as {often.numerator} to {often.denominator}"
                if before.trains or behind.trains
                else f"with the common divisor {meshes[0] / often.numerator:.0f}"
            )
            yield Doubt(
                f"On shaft {shaft} {first} and {second} teeth mesh in a turn, {ratio}: few of their phases "
                "meet. The ripple shown is that of the worst meeting of phases, and means are those over all "
                "of them.",
                moves=REMARKED,
                about=("torque_ripple",),
                brief=f"Shaft {shaft}: the ripple is that of the worst meeting of phases.",
            )


def _on_vibration(case: DriveCase) -> Iterator[str]:
    """Stages that vibrate, of which each is computed by itself."""
    if any(table.dynamics is not None for table in case.stages.values()):
        yield Doubt(
            "Each stage vibrates by itself, under the torque that it carries with all losses: shafts between "
            "stages, and what turns on them beside its own gears, are not in it.",
            moves=LEFT_OUT,
            about=("transmission_error", "natural_frequency"),
            brief="Each stage vibrates by itself: shafts between stages are not in it.",
        )


def _adding_thrusts(built: Sequence[Built | BuiltTrain]) -> Iterator[str]:
    """Shafts on which helical gears of two meshes press the same way along the axis.

    The frame of a mesh gives its two members opposite hands, and other flanks turn both over.
    """
    for shaft, (before, behind) in enumerate(pairwise(built), 2):
        if before.trains or behind.trains:
            continue
        (mesh_in,), (mesh_out,) = before.meshes, behind.meshes
        helical = [
            float(mesh.dimensions.get("overlap_ratio", 0.0)) > 0.0 for mesh in (mesh_in, mesh_out)
        ]
        members = np.argmax(mesh_in.nominal["loaded"]), np.argmax(mesh_out.nominal["driver"])
        if all(helical) and members[0] == members[1]:
            gear = mesh_in.case.gears.members[members[0]]
            yield (
                f"On shaft {shaft} the helical {gear}s of stages {shaft - 1} and {shaft} have opposite "
                "hands: their axial forces add up. Those of a gear 2 and a gear 1 counteract."
            )


def _on_one_place(case: DriveCase, built: Sequence[Built | BuiltTrain]) -> Iterator[str]:
    """Shafts on which faces of two gears lie over each other along the axis, where a case says any places."""
    tables = [*case.stages.values()]
    if not any("place" in table.model_fields_set for table in tables):
        return
    for shaft, (stage_before, stage_behind) in enumerate(
        pairwise(zip(tables, built, strict=True)), 2
    ):
        if stage_before[1].trains or stage_behind[1].trains:
            continue
        apart = abs(stage_behind[0].place - stage_before[0].place)
        widths = (
            getattr(stage.case.gears, "face_width", 0.0)
            for _, stage in (stage_before, stage_behind)
        )
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
