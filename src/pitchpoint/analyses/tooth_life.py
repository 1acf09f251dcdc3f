"""Life of teeth over a load history: Miner's rule on lines of ISO 6336 and VDI 2736, by flank and root."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from pitchpoint._jax import double_precision
from pitchpoint.analyses.strength import rated_rows, rating_inputs
from pitchpoint.cases.built_drive import TRAIN_PERIOD, Ready
from pitchpoint.cases.solids import SolidInUse
from pitchpoint.duty_cycle.history import LoadHistory
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import nominal_motion
from pitchpoint.results.by_stage import Label
from pitchpoint.results.store import dataset
from pitchpoint.strength.treatments import PLASTIC_CYCLES

__all__ = [
    "LoadClasses",
    "cycles_on_curve",
    "cycles_to_failure",
    "load_classes",
    "mesh_member_names",
    "tooth_life",
]

Floats = NDArray[np.float64]

TORQUE_CLASSES, SPEED_CLASSES, TEMPERATURE_CLASSES = 48, 6, 6
"""Classes of a history with more different loads than these: with twice as many lives move by below 1 %."""

_POWER = 8.0
"""Power of the mean load of a class: near that of the damage of steel, 6.6 of flanks to 8.7 of roots."""

_LEAST = 1e-3
"""Part of the largest torque below which a load does no damage."""

LONG = 1e10
"""Load cycles at which the lines of ISO 6336 end."""


class LoadClasses(NamedTuple):
    """A load history as a collective of constant loads.

    Attributes:
        torque: of the output, of either sign, shape (k,) [N m or N].
        speed: of the output, positive, shape (k,) [rad/s or m/s].
        way: that the output makes in the class, shape (k,) [rad or m].
        temperature: of the oil, mean over the way, shape (k,) [K].
    """

    torque: Floats
    speed: Floats
    way: Floats
    temperature: Floats


def load_classes(history: LoadHistory, *, warm: bool = False) -> LoadClasses:
    """The collective of a history, what stands still or has no load left out.

    Different loads stay apart where there are few; of many those in a class are one, with the power mean of
    their torques over the way and the mean of their speeds over time.

    Args:
        history: of an output.
        warm: temperatures make classes too, as the lines of plastics hang on them.
    """
    size, speed = np.abs(history.torque), np.abs(history.speed)
    travel = history.duration * speed
    counts = (travel > 0.0) & (size > _LEAST * size.max())
    torque, size, speed, travel, time, degree = (
        values[counts]
        for values in (history.torque, size, speed, travel, history.duration, history.temperature)
    )
    loads = np.stack([torque, speed, *[degree] * warm])
    rows, place = np.unique(loads, axis=1, return_inverse=True)
    if rows.shape[1] > TORQUE_CLASSES * SPEED_CLASSES:
        keys = _class_of(size, TORQUE_CLASSES) * SPEED_CLASSES + _class_of(speed, SPEED_CLASSES)
        if warm:
            keys = keys * TEMPERATURE_CLASSES + _class_of(
                degree - degree.min(), TEMPERATURE_CLASSES
            )
        _, place = np.unique(keys * 2 + (torque > 0.0), return_inverse=True)
    place = place.ravel()

    def whole(values: Floats) -> Floats:
        return np.bincount(place, values).astype(float)

    ways, times = whole(travel), whole(time)
    mean = (whole(travel * size**_POWER) / ways) ** (1.0 / _POWER)
    sides = np.sign(whole(torque))
    return LoadClasses(
        sides * mean, whole(time * speed) / times, ways, whole(travel * degree) / ways
    )


def _class_of(values: Floats, count: int) -> NDArray[np.int_]:
    """Number of the class among equal ones from zero to the largest value."""
    most = max(float(values.max(initial=0.0)), 1e-300)
    return np.minimum(count * values / most, count - 1).astype(int)


def cycles_to_failure(stress: Floats, cycles: Floats, limits: Floats) -> Floats:
    """Load cycles that teeth bear, on lines in the logarithms of stress and cycles, shape (...).

    Args:
        stress: shape (...) [Pa].
        cycles: where the lines begin, bend and end, shape (3, ...).
        limits: permissible stresses there, not rising, shape (3, ...) [Pa].

    Returns:
        0 above the first limit, infinite below the last.

    Source: ISO 6336-6:2019, 4.3, with the lines of ISO 6336-2 and 6336-3.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.log(limits[:2] / stress) / np.log(limits[:2] / limits[1:])
        numbers = cycles[:2] * (cycles[1:] / cycles[:2]) ** part
    number = np.where(stress >= limits[1], numbers[0], numbers[1])
    number = np.where(stress > limits[0], 0.0, np.where(stress < limits[2], np.inf, number))
    return np.where(np.isnan(stress) | np.isnan(limits[1]), np.nan, number)


def cycles_on_curve(stress: Floats, curve: Floats) -> Floats:
    """Load cycles that plastic roots bear under s_0 + s_N/N^r, at most s_1, shape (...).

    Args:
        stress: nominal, that of test gears, shape (...) [Pa].
        curve: s_0, s_N [Pa], r [1], s_1 [Pa], shape (4, ...).

    Returns:
        0 above what a single load breaks, infinite where it bears more than `LONG`.

    Source: VDI 2736 Part 2 (2014), eq. 13 and the strengths behind it, solved for N.
    """
    endless, of_cycles, power, most = curve
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        number = (of_cycles / (stress - endless)) ** (1.0 / power)
    number = np.where((stress <= endless) | (number > LONG), np.inf, number)
    number = np.where(stress > np.minimum(most, endless + of_cycles), 0.0, number)
    return np.where(np.isnan(stress) | np.isnan(endless + of_cycles), np.nan, number)


@double_precision()
def tooth_life(built: Ready, history: LoadHistory) -> xr.Dataset:
    """Damage of the teeth of each mesh in one cycle, and the time until it is one.

    Args:
        built: the drive, whose load and speed each class scales.
        history: of its output.

    Returns:
        Over `mesh` and `gear`: damage of the working and of the back flank, of the root, which both load, and
        lives. Roots of plastic have the line of their material at the temperature of each class, their teeth
        warmer than the oil by as much as at the operating point; NaN stands for flanks of plastic, and roots
        without such a line. Load factors are those at the load and speed of each class, K_A is left as the
        case has it: 1 where the history is the whole load. The attribute `unrated` counts the meshes whose
        teeth ISO 6336 does not rate, `members` names the gears of each mesh.

    Raises:
        InputError: the drive has no teeth that ISO 6336 rates, or nothing moves under load.

    Source: Palmgren (1924), Miner (1945); ISO 6336-6:2019; VDI 2736 Part 2 (2014).
    """
    every = rating_inputs(built)
    plastic = any(np.asarray(inputs[4].plastic).any() for _, inputs in every)
    classes = load_classes(history, warm=plastic)
    if not classes.way.size:
        raise InputError(
            "nothing moves under load in the duty cycle, so that teeth have no load cycles"
        )
    if not every:
        raise InputError("ISO 6336 rates pairs of cylindrical gears, and the drive has none")
    labels = [str(label) for label, _ in every]
    curves = _curves(built, classes.temperature)
    damage = np.stack([_damage(inputs, built, classes, curves[label]) for label, inputs in every])
    names = ("flank_damage", "back_flank_damage", "root_damage")
    seconds = float(history.duration.sum())
    with np.errstate(divide="ignore"):
        lives = seconds / damage
    data = {name: (("mesh", "gear"), damage[:, :, at]) for at, name in enumerate(names)}
    data |= {
        name.replace("damage", "life"): (("mesh", "gear"), lives[:, :, at])
        for at, name in enumerate(names)
    }
    coordinates = {"mesh": labels, "gear": ["gear 1", "gear 2"]}
    return dataset(
        data,
        coordinates,
        unrated=len(built.meshes) - len(every),
        members=mesh_member_names(built, [label for label, _ in every]),
    )


def mesh_member_names(built: Ready, labels: Sequence[Label]) -> list[str]:
    """Names of both gears of each mesh: of a set its bodies, a planet with what it meshes with.

    Args:
        built: the drive.
        labels: of the meshes.
    """
    named = dict(zip(built.mesh_labels, _bodies(built), strict=True))
    names: list[str] = []
    for label in labels:
        number, bodies = named[label]
        where = f", stage {number}" if number else ""
        if bodies:
            names += [f"{name}{where}" for name in _parted(bodies, [b for _, b in named.values()])]
        else:
            names += [f"gear {at}{where}" for at in (1, 2)]
    return names


def _bodies(built: Ready) -> list[tuple[int, tuple[str, ...]]]:
    """Stage of each mesh, 0 where there is one alone, and the two bodies of a mesh of a set."""
    if built.averaging == TRAIN_PERIOD:
        return [(0, tuple(words.split(" and "))) for words in built.stage_bodies]
    numbered_bodies: list[tuple[int, tuple[str, ...]]] = []
    for number, stage in zip(built.numbers or (0,), built.stages or (built,), strict=True):
        sets = [tuple(words.split(" and ")) for words in stage.stage_bodies]
        numbered_bodies += [(number, bodies) for bodies in sets or [()]]
    return numbered_bodies


def _parted(bodies: Sequence[str], every: Sequence[Sequence[str]]) -> list[str]:
    """Names of both, with the mate where a body has several."""
    often = [
        sum(name in set(mesh_bodies) for mesh_bodies in {*map(tuple, every)}) > 1 for name in bodies
    ]
    return [
        f"{name} on {mate}" if several else name
        for name, mate, several in zip(bodies, reversed(bodies), often, strict=True)
    ]


def _curves(built: Ready, temperature: Floats) -> dict[Label, Floats]:
    """Lines of plastic roots of each mesh at temperatures of the oil, shape (4, k, 2); NaN for others."""
    curves = {}
    for label, mesh in zip(built.mesh_labels, built.meshes, strict=True):
        if not mesh.case.gears.rated:
            continue
        root_strengths = np.asarray(mesh.rated.strengths.root)
        columns = [
            _curve(used, temperature + used.temperature - float(mesh.operation.temperature), limit)
            for used, limit in zip(mesh.solids, root_strengths, strict=True)
        ]
        curves[label] = np.stack(columns, axis=-1)
    return curves


def _curve(used: SolidInUse, degrees: Floats, given: float) -> Floats:
    """Of a gear at temperatures of its teeth, shape (4, k)."""
    strength, tensile = used.record.root_strength, used.record.tensile_strength
    if strength is None or not used.plastic or not np.isnan(given):
        return np.full((4, degrees.size), np.nan)
    most = np.inf if tensile is None else tensile.value
    return np.array([(*strength.at(float(degree)), most) for degree in degrees]).T


def _damage(inputs: tuple[Any, ...], built: Ready, classes: LoadClasses, curves: Floats) -> Floats:
    """Of working flank, back flank and root of both gears of a mesh in one cycle, shape (2, 3)."""
    mesh, _, duty, _, strengths, _ = inputs
    rows = rated_rows([*_rows(inputs, built, classes)])
    count = classes.way.size

    def of(name: str) -> Floats:
        return np.broadcast_to(rows[name].reshape(3, count, -1), (3, count, 2))

    output_rate = float(built.operation.speed) * built.output_rate
    # Turns of the driver of this mesh for a way of the output, at the ratio of the operating point.
    turns = classes.way * float(duty.speed) / abs(output_rate) / (2.0 * np.pi)
    motion = np.asarray(nominal_motion(mesh, duty.driver, 1.0 - duty.driver))
    cycles_per_turn = np.abs(motion) * np.asarray(duty.engagements)
    cycles = turns[:, None] * cycles_per_turn
    working = classes.torque[:, None] > 0.0
    flank = _bears(of("contact_stress"), of("contact_limit"), strengths.constants.flank)
    root = _bears(of("root_stress"), of("root_limit"), strengths.constants.root)
    plastic = np.asarray(strengths.plastic)
    flank = np.where(plastic, np.nan, flank)
    root = np.where(
        plastic, _plastic_roots(of("root_stress")[0], of("root_limit")[1], strengths, curves), root
    )
    with np.errstate(divide="ignore"):
        flank, root = (np.where(cycles > 0.0, cycles / bears, 0.0) for bears in (flank, root))
    either = [np.where(side, flank, 0.0).sum(axis=0) for side in (working, ~working)]
    return np.stack([*either, root.sum(axis=0)], axis=1)


def _bears(stress: Floats, limit: Floats, constants: Any) -> Floats:
    """Load cycles that both gears bear in each class on the lines of steel, shape (k, 2)."""
    _, low_cycles, high_cycles = np.asarray(constants)
    places = np.stack([low_cycles, high_cycles, np.full(2, LONG)])[:, None, :]
    return cycles_to_failure(stress[0], np.broadcast_to(places, limit.shape), limit)


def _plastic_roots(stress: Floats, limit: Floats, strengths: Any, curves: Floats) -> Floats:
    """Load cycles of roots on the lines of plastics, shape (k, 2).

    Args:
        stress: at the root, shape (k, 2) [Pa].
        limit: permissible at `PLASTIC_CYCLES` and the temperature of the operating point, shape (k, 2) [Pa].
        strengths: of both gears.
        curves: at the temperatures of the classes, shape (4, k, 2).
    """
    endless, of_cycles, power, most = np.asarray(strengths.over_cycles)
    nominal = np.minimum(endless + of_cycles / PLASTIC_CYCLES**power, most)
    return cycles_on_curve(stress * nominal / limit, curves)


def _rows(inputs: tuple[Any, ...], built: Ready, classes: LoadClasses) -> Iterator[tuple[Any, ...]]:
    """What the rating takes at each class, at the cycles where the lines begin, bend and end."""
    mesh, ends, duty, factors, strengths, finish = inputs
    load, speed = float(built.operation.load), float(built.operation.speed) * built.output_rate
    lines = strengths.constants.flank, strengths.constants.root
    for place in (1, 2, None):
        flank, root = (
            np.full(2, LONG) if place is None else np.asarray(line[place]) for line in lines
        )
        for torque, pace in zip(classes.torque, classes.speed, strict=True):
            here = replace(
                duty,
                load=np.array(float(duty.load) * abs(torque) / load),
                speed=np.array(float(duty.speed) * pace / abs(speed)),
                cycles_flank=flank,
                cycles_root=root,
                life=np.array(np.nan),
            )
            yield mesh, ends, here, factors, strengths, finish
