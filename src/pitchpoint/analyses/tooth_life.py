"""Life of teeth over a load history: Miner's rule on the lines of ISO 6336, by flank and by root."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from pitchpoint._jax import double_precision
from pitchpoint.analyses.strength import rated_rows, rating_inputs
from pitchpoint.cases.built_drive import Ready
from pitchpoint.duty_cycle.history import LoadHistory
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import nominal_motion
from pitchpoint.results.store import dataset

__all__ = ["LoadClasses", "cycles_to_failure", "load_classes", "tooth_life"]

Floats = NDArray[np.float64]

TORQUE_CLASSES, SPEED_CLASSES = 48, 6
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
    """

    torque: Floats
    speed: Floats
    way: Floats


def load_classes(history: LoadHistory) -> LoadClasses:
    """The collective of a history, what stands still or has no load left out.

    Different loads stay apart where there are few; of many those in a class are one, with the power mean of
    their torques over the way and the mean of their speeds over time.

    Args:
        history: of an output.
    """
    size, speed = np.abs(history.torque), np.abs(history.speed)
    way = history.duration * speed
    counts = (way > 0.0) & (size > _LEAST * size.max())
    torque, size, speed, way, time = (
        values[counts] for values in (history.torque, size, speed, way, history.duration)
    )
    pairs = np.stack([torque, speed])
    rows, place = np.unique(pairs, axis=1, return_inverse=True)
    if rows.shape[1] > TORQUE_CLASSES * SPEED_CLASSES:
        bins = np.minimum(TORQUE_CLASSES * size / size.max(), TORQUE_CLASSES - 1).astype(int)
        paces = np.minimum(SPEED_CLASSES * speed / speed.max(), SPEED_CLASSES - 1).astype(int)
        keys = (bins * SPEED_CLASSES + paces) * 2 + (torque > 0.0)
        _, place = np.unique(keys, return_inverse=True)
    place = place.ravel()

    def whole(values: Floats) -> Floats:
        return np.bincount(place, values).astype(float)

    ways, times = whole(way), whole(time)
    mean = (whole(way * size**_POWER) / ways) ** (1.0 / _POWER)
    return LoadClasses(np.sign(whole(torque)) * mean, whole(time * speed) / times, ways)


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


@double_precision()
def tooth_life(built: Ready, history: LoadHistory) -> xr.Dataset:
    """Damage of the teeth of each mesh in one cycle, and the time until it is one.

    Args:
        built: the drive, whose load and speed each class scales.
        history: of its output.

    Returns:
        Over `mesh` and `gear`: damage of the working and of the back flank, of the root, which both load, and
        lives; NaN for plastics, whose lines are others. Load factors are those at the load and speed of each
        class, K_A is left as the case has it: 1 where the history is the whole load. The attribute `unrated`
        counts the meshes whose teeth ISO 6336 does not rate.

    Raises:
        InputError: the drive has no teeth that ISO 6336 rates, or nothing moves under load.

    Source: Palmgren (1924), Miner (1945); ISO 6336-6:2019.
    """
    classes = load_classes(history)
    if not classes.way.size:
        raise InputError(
            "nothing moves under load in the duty cycle, so that teeth have no load cycles"
        )
    every = rating_inputs(built)
    if not every:
        raise InputError("ISO 6336 rates pairs of cylindrical gears, and the drive has none")
    labels = [str(label) for label, _ in every]
    damage = np.stack([_damage(inputs, built, classes) for _, inputs in every])
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
    return dataset(data, coordinates, unrated=len(built.meshes) - len(every))


def _damage(inputs: tuple[Any, ...], built: Ready, classes: LoadClasses) -> Floats:
    """Of working flank, back flank and root of both gears of a mesh in one cycle, shape (2, 3)."""
    mesh, _, duty, _, strengths, _ = inputs
    rows = rated_rows([*_rows(inputs, built, classes)])
    count = classes.way.size

    def of(name: str) -> Floats:
        return np.broadcast_to(rows[name].reshape(3, count, -1), (3, count, 2))

    output_rate = float(built.operation.speed) * built.output_rate
    # Turns of the driver of this mesh for a way of the output, at the ratio of the operating point.
    turns = classes.way * float(duty.speed) / abs(output_rate) / (2.0 * np.pi)
    own = np.abs(np.asarray(nominal_motion(mesh, duty.driver, 1.0 - duty.driver))) * np.asarray(
        duty.engagements
    )
    cycles = turns[:, None] * own
    working = classes.torque[:, None] > 0.0
    parts = []
    for part, constants in (
        ("flank", strengths.constants.flank),
        ("root", strengths.constants.root),
    ):
        stress, limit = (
            ("contact_stress", "contact_limit")
            if part == "flank"
            else ("root_stress", "root_limit")
        )
        _, few, many = np.asarray(constants)
        places = np.stack([few, many, np.full(2, LONG)])[:, None, :]
        bears = cycles_to_failure(of(stress)[0], np.broadcast_to(places, (3, count, 2)), of(limit))
        with np.errstate(divide="ignore"):
            parts.append(np.where(cycles > 0.0, cycles / bears, 0.0))
    flank, root = parts
    either = [np.where(side, flank, 0.0).sum(axis=0) for side in (working, ~working)]
    return np.stack([*either, root.sum(axis=0)], axis=1)


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
