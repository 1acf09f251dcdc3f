"""The loss map of the output over its torque and speed with their signs: the output drives too."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from pitchpoint import units
from pitchpoint.analyses.analysis import Piece, Progress
from pitchpoint.analyses.loss_map import map_axes, maps, told_of_films
from pitchpoint.cases.schema import LossMap
from pitchpoint.cases.stages import Ready
from pitchpoint.doubts import Doubt, doubts_of
from pitchpoint.efficiency.loss_table import LOCKED, LossTable
from pitchpoint.results.store import dataset
from pitchpoint.status import locked_or_lost, told

__all__ = [
    "both",
    "loss_of_output",
    "mirrored",
    "pieces",
    "speed_ratio",
    "table_of",
]

FORWARDS, BACKWARDS = "forwards", "backwards"
"""Way of the power: from the driver of the case to its output, and from the output to the driver."""

FALLS_SHORT = 1e-9
"""Part of a torque by which rounding may leave the largest that was computed behind that of the map."""

BOTH_FLANKS = (
    "Negative speeds mirror the positive ones: the flanks on either side of the teeth are taken to be alike, "
    "as the case describes those that it loads."
)
BETWEEN = (
    "Where the load turns the output with less than the drive takes to be driven backwards, both ends put "
    "power in; the loss is taken there as a straight line between that without torque at the output and "
    "that without torque at the driver."
)

_EACH = ("law", "speed", "temperature")
_DIMS = ("law", "output_torque", "output_speed", "temperature")

Values = np.ndarray
"""Over law, torque, speed, temperature."""


def pieces(built: Ready) -> list[Piece]:
    """One for each load: forwards and backwards, at the nodes of the map and half way between them."""
    return [
        {"way": way, "between": between, "torque": float(load)}
        for way in (FORWARDS, BACKWARDS)
        for between in (False, True)
        for load in _axes(built, way, between=between)[0]
    ]


def _axes(built: Ready, way: str, *, between: bool) -> tuple[np.ndarray, ...]:
    """Loads, speeds of the driver and temperatures; half way the last is there twice, for the programs."""
    axes = map_axes(_driven(built, way))
    if not between:
        return axes
    loads, *others = map(_half_way, axes)
    return loads, *(np.append(one, one[-1]) if one.size > 1 else one for one in others)


def _half_way(values: np.ndarray) -> np.ndarray:
    return (values[1:] + values[:-1]) / 2.0 if values.size > 1 else values


def _driven(built: Ready, way: str) -> Ready:
    return built if way == FORWARDS else _driven_back(built)


@lru_cache(maxsize=2)
def _driven_back(built: Ready) -> Ready:
    """The drive with its output driving, over the speeds of the map and the torques that it takes there."""
    loads, speeds, degrees = map_axes(built)
    step, back = speed_ratio(built), built.backwards
    ends = {"torque": float(loads[-1] * step), "speed": float(speeds[-1] * step), "force": None}
    asked = (back.case.loss_map or LossMap()).model_copy(
        update={**ends, "temperatures": tuple(map(float, degrees))}
    )
    changed: Any = back.case.model_copy(update={"loss_map": asked})
    return replace(back, case=changed)


def speed_ratio(built: Ready) -> float:
    """Speed of the output over that of the driver, not negative [1, m/rad or rad/m]."""
    return float(built.backwards.operation.speed) / float(built.operation.speed)


def quadrants_of(built: Ready, piece: Piece, progress: Progress) -> xr.Dataset:
    """Loss under one load."""
    driven = _driven(built, str(piece["way"]))
    _, speeds, degrees = _axes(built, str(piece["way"]), between=bool(piece["between"]))
    each = []
    for count, (loss, _, locked) in enumerate(
        maps(driven, float(piece["torque"]), speeds, degrees), 1
    ):
        each.append((loss, locked))
        progress(count * loss.size)
    losses, locked = (np.stack(one) for one in zip(*each, strict=True))
    return dataset(
        {"mean_loss": (_EACH, losses), "locked": (_EACH, locked)},
        {"law": built.law_names},
        warnings=told_of_films(driven),
    )


def loss_of_output(
    torque: np.ndarray,
    no_load: float,
    driving: np.ndarray,
    losses: np.ndarray,
    locked: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Loss in a drive whose output is turned by a torque, from that under loads at the driver.

    Args:
        torque: that turns the output, positive [torque] [N m or N].
        no_load: loss of the drive turned by its driver without load [W].
        driving: torque of the output that carries each load at the driver, the first one none [load].
        losses: in the drive then [load] [W]; NaN where there is no balance.
        locked: True where friction locks it then [load].

    Returns:
        Loss [torque] [W], NaN where it is not known, and where that is because friction locks the drive.

    Between loads by a monotone cubic of the torque; below the first one see `BETWEEN`.

    Example:
        >>> import numpy as np
        >>> torque, load = np.array([1.0, 6.0, 9.0]), np.array([0.0, 5.0, 10.0])
        >>> free = np.zeros(3, bool)
        >>> loss_of_output(torque, 1.0, load + 2.0, 3.0 + load, free)[0].tolist()
        [2.0, 7.0, 10.0]
        >>> loss, held = loss_of_output(torque, 1.0, load + 2.0, 3.0 + load, np.array([False, False, True]))
        >>> loss.tolist(), held.tolist()
        ([2.0, 7.0, nan], [False, False, True])
    """
    there = np.flatnonzero(np.isfinite(driving + losses) & ~locked)
    there = there[[bool(np.all(driving[there[:k]] < driving[one])) for k, one in enumerate(there)]]
    known = driving[there]
    # A torque lies between two loads; where one in between is missing, so is what the torque does.
    gaps = [*pairwise([-1, *there, driving.size])]
    missing = np.array([*(last - first > 1 for first, last in gaps[:-1]), True])
    held = np.array([bool(locked[first + 1 : last].any()) for first, last in gaps])
    place = np.searchsorted(known * (1.0 + FALLS_SHORT), torque)
    found = _between_loads(torque, no_load, known, losses[there])
    return np.where(missing[place], np.nan, found), held[place]


def _between_loads(
    torque: np.ndarray, no_load: float, known: np.ndarray, losses: np.ndarray
) -> np.ndarray:
    """Loss between the torques where it is known, and below them."""
    below = known.size > 0 and known[0] > 0.0
    xs, values = ([0.0, *known[:1]], [no_load, *losses[:1]]) if below else (known[:1], losses[:1])
    if known.size < 2:
        return np.interp(torque, xs, values) if known.size else np.full(torque.shape, np.nan)
    curve = PchipInterpolator(known, losses)(np.clip(torque, known[0], known[-1]))
    found: np.ndarray = np.where(torque < known[0], np.interp(torque, xs, values), curve)
    return found


def joined_quadrants(built: Ready, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The whole map, with how near values between its nodes are, and what there is to say about it."""
    (loads, _, degrees), (_, speeds, _) = map_axes(built), map_axes(_driven_back(built))
    ratio = speed_ratio(built)
    forwards, back = (_stacked(built, way, parts, between=False) for way in (FORWARDS, BACKWARDS))
    turned, held = _turned(built, forwards[0][:, 0], *back)
    loss = np.concatenate([turned[:, ::-1], forwards[0]], axis=1)
    stuck = np.concatenate([held[:, ::-1], forwards[1] & (loads > 0.0)[:, None, None]], axis=1)
    torques = both(loads)
    axes = {
        "law": built.law_names,
        "output_torque": torques,
        "output_speed": both(speeds),
        "temperature": degrees,
    }
    errors = _errors(built, parts, _table(axes, np.where(stuck, LOCKED, loss), ratio))
    loss, stuck = mirrored(loss), mirrored(stuck & (speeds > 0.0)[:, None])
    figures = _figures(loss, torques[:, None, None], both(speeds)[:, None], ratio)
    lost = np.isnan(loss) & ~stuck
    found = dataset(
        {
            "mean_loss": (_DIMS, loss),
            **{name: (_DIMS, values) for name, values in figures.items()},
            "locked": (_DIMS, stuck),
            **{name: (("law",), values) for name, values in errors.items()},
        },
        axes,
        title="loss map of the output",
        travels=built.travels,
        warnings=_told(built, stuck, lost, parts),
        solve=told(locked_or_lost(stuck, lost)),
        note=f"{BOTH_FLANKS} {BETWEEN}",
        speed_ratio=ratio,
    )
    found["mean_efficiency"].attrs.update(built.covers)
    return found


def both(values: np.ndarray) -> np.ndarray:
    """Values from zero on, with the same ones negative before them.

    Example:
        >>> import numpy as np
        >>> both(np.array([0.0, 1.0, 3.0])).tolist()
        [-3.0, -1.0, 0.0, 1.0, 3.0]
    """
    return np.concatenate([-values[:0:-1], values])


def mirrored(values: Values) -> Values:
    """Values over torques of either sign and speeds from zero on, with those at negative speeds.

    Example:
        >>> import numpy as np
        >>> torque, speed = np.array([[-1.0], [0.0], [1.0]]), np.array([0.0, 2.0])
        >>> power = (torque * speed)[None, :, :, None]
        >>> mirrored(power)[0, :, :, 0].tolist()
        [[2.0, -0.0, -2.0], [0.0, 0.0, 0.0], [-2.0, 0.0, 2.0]]
    """
    return np.concatenate([values[:, ::-1, :0:-1], values], axis=2)


def _stacked(
    built: Ready, way: str, parts: Sequence[xr.Dataset], *, between: bool
) -> tuple[Values, Values]:
    """Loss, and where friction locks the drive, under every load one way."""
    own = [
        part
        for piece, part in zip(pieces(built), parts, strict=True)
        if (piece["way"], piece["between"]) == (way, between)
    ]
    loss, locked = (np.stack([one[n].values for one in own], 1) for n in ("mean_loss", "locked"))
    return loss, locked


def _turning(built: Ready, losses: Values, *, between: bool) -> Values:
    """Torque of the output that turns the driver under each load; NaN at rest."""
    loads, speeds, _ = _axes(built, BACKWARDS, between=between)
    ratio = speed_ratio(built)
    speed = np.where(speeds > 0.0, speeds, np.nan)[:, None]
    torque: Values = (loads[:, None, None] * (speed / ratio) + losses) / speed
    return torque


def _turned(built: Ready, no_load: Values, losses: Values, locked: Values) -> tuple[Values, Values]:
    """Loss over torques that turn the output, and where friction locks the drive; nothing is lost at rest."""
    torques = map_axes(built)[0][1:]
    driving = _turning(built, losses, between=False)
    shape = (losses.shape[0], torques.size, *losses.shape[2:])
    loss, held = np.zeros(shape), np.zeros(shape, bool)
    for law, speed, degree in np.ndindex(no_load.shape):
        if speed > 0:
            at = (law, slice(None), speed, degree)
            start = float(no_load[law, speed, degree])
            loss[at], held[at] = loss_of_output(torques, start, driving[at], losses[at], locked[at])
    return loss, held


def _figures(
    loss: Values, torque: np.ndarray, speed: np.ndarray, ratio: float
) -> dict[str, Values]:
    """Torque of the driver and efficiency, from the balance of power; NaN where none is passed on."""
    given = torque * speed
    taken = given + loss
    moving = np.broadcast_to(speed != 0.0, loss.shape)
    turning = np.where(moving, taken, np.nan) / np.where(moving, speed / ratio, 1.0)
    ways = [(given > 0.0) & (taken > 0.0), (given < 0.0) & (taken < 0.0)]
    over = np.select(ways, [taken, np.broadcast_to(given, loss.shape)], np.nan)
    out = np.select(ways, [np.broadcast_to(given, loss.shape), taken], np.nan)
    return {"mean_efficiency": out / over, "mean_input_torque": turning}


def _errors(built: Ready, parts: Sequence[xr.Dataset], table: LossTable) -> dict[str, np.ndarray]:
    """How far the loss of the table is off half way between its nodes, largest and mean [law]."""
    off = []
    for way in (FORWARDS, BACKWARDS):
        found, _ = _stacked(built, way, parts, between=True)
        loads, speeds, degrees = _axes(built, way, between=True)
        if way == BACKWARDS:
            torque = -_turning(built, found, between=True)
        else:
            torque, speeds = loads[:, None, None], speeds * speed_ratio(built)
        places = torque, speeds[:, None], celsius(degrees)
        each = (np.broadcast_to(one, found.shape)[:, :, : len(table.speeds) - 1] for one in places)
        off.append(_off(table, found[:, :, : len(table.speeds) - 1], *each))
    errors = [one[np.isfinite(one)] for one in np.concatenate(off, axis=1)]
    return {
        "interpolation_error": np.array([one.max(initial=0.0) for one in errors]),
        "mean_interpolation_error": np.array([one.sum() / max(one.size, 1) for one in errors]),
    }


def _off(
    table: LossTable, loss: Values, torque: Values, speed: Values, degree: Values
) -> np.ndarray:
    """Errors of the table over the loss, NaN beyond it and where there is none [law, place]."""
    errors = np.full(loss.shape, np.nan)
    for at in zip(*np.nonzero(loss > 0.0), strict=True):
        law = [*table.losses][at[0]]
        found = table.at(float(torque[at]), float(speed[at]), float(degree[at]), law)
        errors[at] = np.nan if found.outside else abs(found.loss / loss[at] - 1.0)
    return errors.reshape(loss.shape[0], -1)


def table_of(data: xr.Dataset, running: xr.Dataset | None = None) -> LossTable:
    """The map as a table that needs no library.

    Args:
        data: the map.
        running: torques of the same case that start the drive from rest.
    """
    speeds = data["output_speed"].values
    held = data.transpose(*_DIMS, ...).isel(output_speed=speeds >= 0.0)
    losses = np.where(held["locked"].values, LOCKED, held["mean_loss"].values)
    units = [
        data[name].attrs["units"] for name in ("output_torque", "output_speed", "mean_input_torque")
    ]
    made = _table(data, losses, float(data.attrs["speed_ratio"]))._replace(units=units)
    if running is None:
        return made
    names = running["law"].values.tolist()
    starting, back = (
        dict(zip(names, running[name].values.tolist(), strict=True))
        for name in ("starting_torque", "back_driving_torque")
    )
    rest = celsius(running["temperature"].values).tolist()
    return made._replace(rest=rest, starting=starting, back_driving=back)


def _table(axes: Mapping[Any, Any], losses: Values, ratio: float) -> LossTable:
    torques, speeds, degrees = (np.asarray(axes[name]) for name in _DIMS[1:])
    return LossTable(
        torques=torques.tolist(),
        speeds=speeds[speeds >= 0.0].tolist(),
        temperatures=celsius(degrees).tolist(),
        losses=dict(zip(map(str, np.asarray(axes["law"])), losses.tolist(), strict=True)),
        speed_ratio=ratio,
    )


def celsius(degrees: np.ndarray) -> np.ndarray:
    """Temperatures [K] in degC, without the rounding of the difference.

    Example:
        >>> import numpy as np
        >>> celsius(np.array([313.15, 333.15])).tolist()
        [40.0, 60.0]
    """
    return np.round(units.convert(degrees, "degC", "temperature"), 9)


def _told(built: Ready, stuck: Values, lost: Values, parts: Sequence[xr.Dataset]) -> list[str]:
    """Where there is no number, and why, in sentences."""
    locks = (
        "friction locks the drive against its output at {} of {} points: there the driver has to turn the "
        "load along, and its torque is not known"
    )
    found = [
        Doubt(
            f"{law.title}: {words.format(where[k].sum(), where[k].size)}.",
            brief=f"{law.name}: no torque at {where[k].sum()} of {where[k].size} points.",
        )
        for words, where in ((locks, stuck), ("no balance was found at {} of {} points", lost))
        for k, law in enumerate(built.laws)
        if where[k].any()
    ]
    return [*found, *dict.fromkeys(t for part in parts for t in doubts_of(part.attrs))]
