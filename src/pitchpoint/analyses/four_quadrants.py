"""The loss map of the output over its torque and speed with their signs: the output drives too."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.analyses.finer_map import finer_map
from pitchpoint.analyses.loss_map import film_interpolation_sentence, map_axes, maps
from pitchpoint.analyses.main_figures import ERRORS, HOLDING, HOLDING_BANDS
from pitchpoint.analyses.running import creeping_speed, from_rest, has_spread
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.doubts import Doubt, doubts_of, in_percent
from pitchpoint.core.status import locked_or_lost, solve_summary
from pitchpoint.efficiency.loss_table import LOCKED, LossTable
from pitchpoint.efficiency.operation_tables import LossMap
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.results.store import dataset
from pitchpoint.units import degrees_celsius

__all__ = [
    "both_signs",
    "loss_beside",
    "loss_of_output",
    "mirrored",
    "output_speed_ratio",
    "pieces",
    "quadrant_axes",
    "table_of",
]

FORWARDS, BACKWARDS = "forwards", "backwards"
"""Way of the power: from the driver of the case to its output, and from the output to the driver."""

CREEPING = 0.1
"""Part of the lowest speed at which the error is measured that comes of friction held below it."""

CREEPS = 1
"""Place of that speed among those half way, behind rest."""

SLOWEST = 0.01
"""Most that the lowest speed is of the largest one, where a drive is slow itself."""

LIGHT = 0.25
"""Part of the first load of the map that is computed too."""

LIGHTER = 0.35
"""Part of the least load at which the error under lighter ones is measured, between two of the table."""

COARSE = 0.1
"""Largest error of the loss between nodes from which on a map is told to be coarse."""

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
_AT_REST = ("law", "temperature")
_HELD = ("law", "output_torque", "temperature")
_BAND = HOLDING_BANDS["largest_holding_torque"]
_OF_BANDS = (
    "least_holding_torque_low",
    "largest_holding_torque_high",
    "least_holding_torque_high",
    "largest_holding_torque_low",
)
"""Ends with most that holds at rest, least and largest torque, then those with least of it."""

_DIMS = ("law", "output_torque", "output_speed", "temperature")

Values = np.ndarray
"""Over law, torque, speed, temperature."""


def pieces(built: Ready) -> list[Piece]:
    """One for each load: forwards and backwards, at the nodes of the map and half way between them."""
    return [
        {"way": direction, "between": between, "torque": float(load)}
        for direction in (FORWARDS, BACKWARDS)
        for between in (False, True)
        for load in _axes(built, direction, between=between)[0]
    ]


def quadrant_axes(built: Ready) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torques and temperatures of the loss map, and speeds of the driver: standstill, then in equal ratios.

    A light load is added, for what a load adds to the loss follows a power of it that changes towards none.

    Args:
        built: the case.
    """
    loads, speeds, degrees = map_axes(built)
    loss_map, top = built.case.loss_map, float(speeds[-1])
    lowest = (loss_map and loss_map.lowest_speed) or min(creeping_speed(built), SLOWEST * top)
    if any(law.films is not None for law in built.laws):
        lowest = max(lowest, float(speeds[1]))
    moving = np.geomspace(lowest, top, speeds.size - 1) if speeds.size > 2 else speeds[1:]
    return np.insert(loads, 1, LIGHT * loads[1]), np.append(0.0, moving), degrees


def _axes(built: Ready, way: str, *, between: bool) -> tuple[np.ndarray, ...]:
    """Loads, speeds of the driver and temperatures; half way the last is there twice, for the programs.

    The first load between is a light one, and the first speed between one below the lowest.
    """
    loads, speeds, degrees = quadrant_axes(_driven(built, way))
    if not between:
        return loads, speeds, degrees
    others = np.append(CREEPING * speeds[1], _of_ratio(speeds[1:])), _half_way(degrees)
    light = np.append(LIGHTER * loads[1], _of_ratio(loads[1:]))
    return light, *(np.append(axis, axis[-1]) if axis.size > 1 else axis for axis in others)


def _half_way(values: np.ndarray) -> np.ndarray:
    return (values[1:] + values[:-1]) / 2.0 if values.size > 1 else values


def _of_ratio(values: np.ndarray) -> np.ndarray:
    between: np.ndarray = np.sqrt(values[1:] * values[:-1])
    return between


def _driven(built: Ready, way: str) -> Ready:
    return built if way == FORWARDS else _driven_back(built)


@lru_cache(maxsize=2)
def _driven_back(built: Ready) -> Ready:
    """The drive with its output driving, over the speeds of the map and the torques that it takes there."""
    loads, speeds, degrees = quadrant_axes(built)
    step, back = output_speed_ratio(built), built.backwards
    ends = {"torque": float(loads[-1] * step), "force": None}
    ends |= {"speed": float(speeds[-1] * step), "lowest_speed": float(speeds[1] * step)}
    loss_map = (back.case.loss_map or LossMap()).model_copy(
        update={**ends, "temperatures": tuple(map(float, degrees))}
    )
    changed: Any = back.case.model_copy(update={"loss_map": loss_map})
    return replace(back, case=changed)


def output_speed_ratio(built: Ready) -> float:
    """Speed of the output over that of the driver, not negative [1, m/rad or rad/m]."""
    return float(built.backwards.operation.speed) / float(built.operation.speed)


def quadrants_of(built: Ready, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """Loss under one load, and torque of the end that drives which starts the drive under it."""
    way, load = str(piece["way"]), float(piece["torque"])
    driven = _driven(built, way)
    _, speeds, degrees = _axes(built, way, between=bool(piece["between"]))
    outcomes = []
    for count, (loss, _, locked) in enumerate(maps(driven, load, speeds, degrees), 1):
        outcomes.append((loss, locked))
        progress(count * loss.size)
    losses, locked = (np.stack(of_laws) for of_laws in zip(*outcomes, strict=True))
    # Laws of friction know no rest; a map of few speeds may have none that is slow.
    creeping = creeping_speed(built) * (1.0 if way == FORWARDS else output_speed_ratio(built))
    slowest = min(float(quadrant_axes(driven)[1][1]), creeping)
    mean, largest = from_rest(driven, load, slowest, degrees)
    bands = {
        name: (_AT_REST, from_rest(driven.held_otherwise(way), load, slowest, degrees)[0])
        for name, way in (zip(_BAND, (-1.0, 1.0), strict=True) if has_spread(built) else ())
    }
    return dataset(
        {
            **bands,
            "mean_loss": (_EACH, losses),
            "locked": (_EACH, locked),
            "largest_holding_torque": (_AT_REST, mean),
            "moving_on_torque": (_AT_REST, largest),
        },
        {"law": built.law_names},
        warnings=film_interpolation_sentence(driven),
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
        losses: in the drive then [load] [W], or torques that are lost; NaN where there is no balance.
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
    there = _rising(driving, losses, locked)
    carried = driving[there]
    # A torque lies between two loads; where one in between is missing, so is what the torque does.
    gaps = [*pairwise([-1, *there, driving.size])]
    missing = np.array([*(high - low > 1 for low, high in gaps[:-1]), True])
    held = np.array([bool(locked[low + 1 : high].any()) for low, high in gaps])
    place = np.searchsorted(carried * (1.0 + FALLS_SHORT), torque)
    loss = _between_loads(torque, no_load, carried, losses[there])
    return np.where(missing[place], np.nan, loss), held[place]


Curve = tuple[float, np.ndarray, np.ndarray, np.ndarray]
"""Arguments of `loss_of_output` but the torques."""


def loss_beside(
    torque: np.ndarray,
    usual: Curve,
    other: Curve,
) -> tuple[np.ndarray, np.ndarray]:
    """The same of a bound: what it loses beside the usual loss goes straight from load to load.

    Each on a cubic of its own, a bound and what it bounds cross between loads where they lie close together.

    Args:
        torque: see `loss_of_output`.
        usual: what is bounded, the other arguments of `loss_of_output`.
        other: the same of the bound, which loses more under every load, or less under every one.

    Returns:
        As `loss_of_output`; never on the other side of the usual loss.

    Example:
        >>> import numpy as np
        >>> load, free = np.array([0.0, 5.0, 10.0]), np.zeros(3, bool)
        >>> usual, other = ((1.0, load + k, np.full(3, k), free) for k in (2.0, 2.5))
        >>> loss_beside(np.array([3.0, 9.0]), usual, other)[0].tolist()
        [2.5, 2.5]
    """
    loss, held = loss_of_output(torque, *other)
    (idle, *usual_loads), (no_load, driving, losses, locked) = usual, other
    carried, there = _rising(*usual_loads), _rising(driving, losses, locked)

    def bounded(at: np.ndarray) -> np.ndarray:
        return _between_loads(at, idle, usual_loads[0][carried], usual_loads[1][carried])

    nodes = np.append(0.0, driving[there])
    apart = np.append(no_load - idle, losses[there] - bounded(driving[there]))
    begin = int(nodes.size > 1 and nodes[1] <= 0.0)
    apart = np.clip(apart, 0.0, None) if np.nansum(apart) > 0.0 else np.clip(apart, None, 0.0)
    beside = bounded(torque) + np.interp(torque, nodes[begin:], apart[begin:])
    return np.where(np.isnan(beside) | np.isnan(loss), loss, beside), held


def _rising(driving: np.ndarray, losses: np.ndarray, locked: np.ndarray) -> np.ndarray:
    """Places of the loads that the output carries, each by a larger torque than those before it."""
    there = np.flatnonzero(np.isfinite(driving + losses) & ~locked)
    rising: np.ndarray = there[
        [bool(np.all(driving[there[:k]] < driving[place])) for k, place in enumerate(there)]
    ]
    return rising


def _between_loads(
    torque: np.ndarray, no_load: float, known: np.ndarray, losses: np.ndarray
) -> np.ndarray:
    """Loss between the torques where it is known, and below them."""
    below = known.size > 0 and known[0] > 0.0
    xs, values = ([0.0, *known[:1]], [no_load, *losses[:1]]) if below else (known[:1], losses[:1])
    if known.size < 2:
        return np.interp(torque, xs, values) if known.size else np.full(torque.shape, np.nan)
    curve = PchipInterpolator(known, losses)(np.clip(torque, known[0], known[-1]))
    loss: np.ndarray = np.where(torque < known[0], np.interp(torque, xs, values), curve)
    return loss


def joined_quadrants(built: Ready, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """The whole map, with how near values between its nodes are, and what there is to say about it."""
    (loads, _, degrees), (_, speeds, _) = quadrant_axes(built), quadrant_axes(_driven_back(built))
    ratio, torques = output_speed_ratio(built), both_signs(loads)
    lost, stuck = _over_output(built, parts)
    surely, _ = _over_output(built, parts, "moving_on_torque")
    axes = {
        "law": built.law_names,
        "output_torque": torques,
        "output_speed": both_signs(speeds),
        "temperature": degrees,
    }
    errors = _errors(built, parts, _table(axes, np.where(stuck, LOCKED, lost), ratio))
    moves = (speeds > 0.0)[:, None]
    loss = mirrored(np.where(moves, lost * speeds[:, None], 0.0))
    figures = _figures(loss, torques[:, None, None], both_signs(speeds)[:, None], ratio)
    held, stuck = stuck[:, :, 0], mirrored(stuck & moves)
    at_rest = {HOLDING: (lost, surely)}
    if has_spread(built):
        low, high = (_over_output(built, parts, name)[0] for name in _BAND)
        at_rest[_OF_BANDS] = (high, low)
    unknown = np.isnan(loss) & ~stuck
    loss_map = dataset(
        {
            "mean_loss": (_DIMS, loss),
            **{name: (_DIMS, values) for name, values in figures.items()},
            "locked": (_DIMS, stuck),
            **{
                name: (_HELD, values)
                for names, bounds in at_rest.items()
                for name, values in zip(names, _ends(bounds, torques, ratio), strict=True)
            },
            "self_locking": (_HELD, held[:, ::-1]),
            **{name: (("law",), values) for name, values in errors.items()},
        },
        axes,
        title="loss map of the output",
        travels=built.travels,
        warnings=[*_told(built, stuck, unknown, parts), *_coarse(built, errors)],
        solve=solve_summary(locked_or_lost(stuck, unknown)),
        note=f"{BOTH_FLANKS} {BETWEEN}",
        speed_ratio=ratio,
        load=float(built.operation.load),
        degree=float(built.operation.temperature),
    )
    loss_map["mean_efficiency"].attrs.update(built.covers)
    return loss_map


def _ends(each: Sequence[Values], torques: np.ndarray, ratio: float) -> Iterator[np.ndarray]:
    """Least and largest torque of the driver that holds each load, from what is lost at rest."""
    for lost in each:
        highest = (torques[:, None] + lost[:, :, 0]) * ratio
        yield from (-highest[:, ::-1], highest)


def both_signs(values: np.ndarray) -> np.ndarray:
    """Values from zero on, with the same ones negative before them.

    Example:
        >>> import numpy as np
        >>> both_signs(np.array([0.0, 1.0, 3.0])).tolist()
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


_USUAL = "largest_holding_torque"
"""Torque at rest that the others are bounds of, as it starts the drive in the mean over its phases."""


def _over_output(
    built: Ready, parts: Sequence[xr.Dataset], start: str = _USUAL
) -> tuple[Values, Values]:
    """Torque that is lost over torques of either sign and speeds from rest on, and where friction locks."""
    lost, locked, driving = {}, {}, {}
    for direction in (FORWARDS, BACKWARDS):
        moving, stuck = _lost(built, direction, parts, between=False)
        standstill = _lost_at_rest(built, direction, parts, start, between=False)
        formulas = np.array([law.films is None for law in built.laws])[:, None, None]
        lost[direction] = np.concatenate([standstill[:, :, None], moving[:, :, 1:]], axis=2)
        held = np.isnan(standstill) & formulas
        locked[direction] = np.concatenate([held[:, :, None], stuck[:, :, 1:]], axis=2)
        driving[direction] = _ideal(built, direction, between=False) + lost[direction]
    torques = quadrant_axes(built)[0][1:]
    curves = lost[FORWARDS][:, 0], driving[BACKWARDS], lost[BACKWARDS], locked[BACKWARDS]
    turned, held = _turned(torques, *curves)
    if start != _USUAL:
        no_load, driven, back, stuck = (curve[..., 0, :] for curve in curves)
        at_rest = no_load, driven, back, stuck
        turned[:, :, 0] = _bound(torques, at_rest, _usual_at_rest(built, parts))
    loaded = (quadrant_axes(built)[0] > 0.0)[:, None, None]
    return (
        np.concatenate([turned[:, ::-1], lost[FORWARDS]], axis=1),
        np.concatenate([held[:, ::-1], locked[FORWARDS] & loaded], axis=1),
    )


def _own(
    built: Ready, way: str, parts: Sequence[xr.Dataset], name: str, *, between: bool
) -> Values:
    """Values of a variable under every load one way [law, load, ...]."""
    pairs = zip(pieces(built), parts, strict=True)
    return np.stack(
        [
            part[name].values
            for piece, part in pairs
            if (piece["way"], piece["between"]) == (way, between)
        ],
        axis=1,
    )


def _ideal(built: Ready, way: str, *, between: bool) -> np.ndarray:
    """Torque of the output without losses under each load of a way [load, 1, 1]."""
    loads = _axes(built, way, between=between)[0]
    return (loads if way == FORWARDS else loads / output_speed_ratio(built))[:, None, None]


def _lost(
    built: Ready, way: str, parts: Sequence[xr.Dataset], *, between: bool
) -> tuple[Values, Values]:
    """Torque of the output that is lost under every load, NaN at rest, and where friction locks the drive."""
    speeds = _axes(built, way, between=between)[1]
    at_output = speeds * (output_speed_ratio(built) if way == FORWARDS else 1.0)
    moving = np.where(at_output > 0.0, at_output, np.nan)[:, None]
    loss, locked = (_own(built, way, parts, n, between=between) for n in ("mean_loss", "locked"))
    return loss / moving, locked


def _lost_at_rest(
    built: Ready, way: str, parts: Sequence[xr.Dataset], name: str, *, between: bool
) -> Values:
    """Torque of the output that is lost where the drive starts under every load [law, load, temperature]."""
    torque = _own(built, way, parts, name, between=between)
    at_output = torque / output_speed_ratio(built) if way == FORWARDS else torque
    return np.asarray(at_output - _ideal(built, way, between=between)[:, 0])


def _turned(
    torques: np.ndarray, no_load: Values, driving: Values, lost: Values, locked: Values
) -> tuple[Values, Values]:
    """Torque that is lost over torques that turn the output, and where friction locks the drive."""
    shape = (lost.shape[0], torques.size, *lost.shape[2:])
    turned, held = np.zeros(shape), np.zeros(shape, bool)
    for law, speed, degree in np.ndindex(no_load.shape):
        at = (law, slice(None), speed, degree)
        start = float(no_load[law, speed, degree])
        turned[at], held[at] = loss_of_output(torques, start, driving[at], lost[at], locked[at])
    return turned, held


Curves = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Arguments of `loss_of_output` but the torques, each [law, ..., temperature]."""


def _usual_at_rest(built: Ready, parts: Sequence[xr.Dataset]) -> Curves:
    """What the mean over the phases loses at rest, backwards under every load."""
    forth, back = (
        _lost_at_rest(built, direction, parts, _USUAL, between=False)
        for direction in (FORWARDS, BACKWARDS)
    )
    ideal = _ideal(built, BACKWARDS, between=False)[:, 0]
    return forth[:, 0], ideal + back, back, np.zeros(back.shape, bool)


def _bound(torques: np.ndarray, bound: Curves, usual: Curves) -> Values:
    """Torque that is lost at rest by a bound over torques that turn the output [law, torque, temperature]."""
    lost = np.zeros((bound[0].shape[0], torques.size, bound[0].shape[1]))
    for law, degree in np.ndindex(bound[0].shape):
        both_curves = (_at(curves, law, degree) for curves in (usual, bound))
        lost[law, :, degree], _ = loss_beside(torques, *both_curves)
    return lost


def _at(curves: Curves, law: int, degree: int) -> Curve:
    start, driving, lost, locked = curves
    lane = (law, slice(None), degree)
    return float(start[law, degree]), driving[lane], lost[lane], locked[lane]


def _figures(
    loss: Values, torque: np.ndarray, speed: np.ndarray, ratio: float
) -> dict[str, Values]:
    """Torque of the driver and efficiency, from the balance of power; NaN where none is passed on."""
    power = torque * speed
    taken = power + loss
    moving = np.broadcast_to(speed != 0.0, loss.shape)
    turning = np.where(moving, taken, np.nan) / np.where(moving, speed / ratio, 1.0)
    ways = [(power > 0.0) & (taken > 0.0), (power < 0.0) & (taken < 0.0)]
    over = np.select(ways, [taken, np.broadcast_to(power, loss.shape)], np.nan)
    out = np.select(ways, [np.broadcast_to(power, loss.shape), taken], np.nan)
    return {"mean_efficiency": out / over, "mean_input_torque": turning}


def _errors(built: Ready, parts: Sequence[xr.Dataset], table: LossTable) -> dict[str, np.ndarray]:
    """How far what the table loses is off between its nodes, and below the lowest ones [law]."""
    lightest = float(quadrant_axes(built)[0][1])
    kinds: dict[str, list[np.ndarray]] = {name: [] for name in ERRORS}
    for direction in (FORWARDS, BACKWARDS):
        off, torque = _off_half_way(built, direction, parts, table)
        creeping, between = np.arange(off.shape[2]) == CREEPS, np.abs(torque) >= lightest
        for name, where in zip(
            ERRORS,
            (between & ~creeping[:, None], ~between & ~creeping[:, None], creeping[:, None]),
            strict=True,
        ):
            kinds[name].append(np.where(where, off, np.nan).reshape(len(off), -1))
    errors = {
        name: [row[np.isfinite(row)] for row in np.concatenate(errors_of_kind, axis=1)]
        for name, errors_of_kind in kinds.items()
    }
    return {
        **{
            name: np.array([e.max(initial=0.0) for e in errors_of_kind])
            for name, errors_of_kind in errors.items()
        },
        "mean_interpolation_error": np.array(
            [e.sum() / max(e.size, 1) for e in errors["interpolation_error"]]
        ),
    }


def _off_half_way(
    built: Ready, way: str, parts: Sequence[xr.Dataset], table: LossTable
) -> tuple[Values, Values]:
    """Errors half way between nodes one way, at rest and below the lowest speed first, and torques there."""
    speeds, degrees = _axes(built, way, between=True)[1:]
    speeds = np.append(0.0, speeds[: max(speeds.size - 1, 1)])
    moving, _ = _lost(built, way, parts, between=True)
    standstill = _lost_at_rest(built, way, parts, "largest_holding_torque", between=True)
    lost = np.concatenate([standstill[:, :, None], moving[:, :, : speeds.size - 1]], axis=2)
    torque = _ideal(built, way, between=True)
    if way == FORWARDS:
        speeds = speeds * output_speed_ratio(built)
    else:
        torque = -(torque + lost)
    places = (
        np.broadcast_to(coordinate, lost.shape)
        for coordinate in (torque, speeds[:, None], degrees_celsius(degrees))
    )
    torque, speed, degree = places
    return _off(table, lost, torque, speed, degree), torque


def _off(
    table: LossTable, lost: Values, torque: Values, speed: Values, degree: Values
) -> np.ndarray:
    """Errors of the table over what is lost, NaN beyond it and where nothing is known."""
    errors = np.full(lost.shape, np.nan)
    torques = table.torques
    for at in zip(*np.nonzero(lost > ROUNDING * torques[-1]), strict=True):
        if torques[0] <= torque[at] <= torques[-1]:
            place = float(torque[at]), float(speed[at]), float(degree[at])
            loss = table.lost(*place, [*table.loss_torques][at[0]])
            errors[at] = np.nan if loss < 0.0 else abs(loss / lost[at] - 1.0)
    return errors


def table_of(data: xr.Dataset) -> LossTable:
    """The map as a table that needs no library.

    Args:
        data: the map.
    """
    ratio, speeds = float(data.attrs["speed_ratio"]), data["output_speed"].values
    moves = data.transpose(*_DIMS, ...).isel(output_speed=speeds > 0.0)
    lost = moves["mean_loss"].values / speeds[speeds > 0.0][:, None]
    lost = np.where(moves["locked"].values, LOCKED, lost)
    held = data.transpose(*_HELD, ...)
    stuck = held["self_locking"].values[:, ::-1]

    def at_rest(name: str) -> np.ndarray:
        holding = held[name].values / ratio - data["output_torque"].values[:, None]
        return np.where(stuck, LOCKED, np.maximum(holding, 0.0))[:, :, None]

    units = [
        data[name].attrs["units"] for name in ("output_torque", "output_speed", "mean_input_torque")
    ]
    table = _table(data, np.concatenate([at_rest("largest_holding_torque"), lost], axis=2), ratio)
    table = table._replace(units=units)
    if _BAND[0] not in data:
        return table
    bounds = [
        _table(data, np.concatenate([at_rest(name), lost], axis=2), ratio).loss_torques
        for name in _BAND
    ]
    return table._replace(
        rest_bounds={
            law: [[column[0] for column in bound[law]] for bound in bounds]
            for law in table.loss_torques
        }
    )


def _table(axes: Mapping[Any, Any], lost: Values, ratio: float) -> LossTable:
    torques, speeds, degrees = (np.asarray(axes[name], float) for name in _DIMS[1:])
    # In degC: values between even ones are even too, where those of rounded kelvins are not.
    torques, speeds, degrees, lost = finer_map(
        torques, speeds[speeds >= 0.0], degrees_celsius(degrees), lost
    )
    return LossTable(
        torques=torques.tolist(),
        speeds=speeds.tolist(),
        temperatures=degrees.tolist(),
        loss_torques=dict(zip(map(str, np.asarray(axes["law"])), lost.tolist(), strict=True)),
        speed_ratio=ratio,
    )


def _coarse(built: Ready, errors: Mapping[str, np.ndarray]) -> Iterator[Doubt]:
    """That nodes of the map are far from each other, where loss between them is off."""
    most, mean = errors[ERRORS[0]], errors["mean_interpolation_error"]
    for law, worst, moved in zip(built.laws, most.tolist(), mean.tolist(), strict=True):
        if worst > COARSE:
            yield Doubt(
                f"{law.title}: between its nodes the map of the output is off by up to {in_percent(worst)}, "
                f"{in_percent(moved)} in the mean, of the loss; more temperatures and speeds in [loss_map] "
                "bring it nearer.",
                "coarse map",
                worst,
                moves=moved,
                brief=f"{law.name}: map off by up to {in_percent(worst)} of the loss between nodes.",
            )


def _told(built: Ready, stuck: Values, lost: Values, parts: Sequence[xr.Dataset]) -> list[str]:
    """Where there is no number, and why, in sentences."""
    locks = (
        "friction locks the drive against its output at {} of {} points: there the driver has to turn the "
        "load along, and its torque is not known"
    )
    doubts = [
        Doubt(
            f"{law.title}: {words.format(where[k].sum(), where[k].size)}.",
            brief=f"{law.name}: no torque at {where[k].sum()} of {where[k].size} points.",
        )
        for words, where in ((locks, stuck), ("no balance was found at {} of {} points", lost))
        for k, law in enumerate(built.laws)
        if where[k].any()
    ]
    return [*doubts, *dict.fromkeys(t for part in parts for t in doubts_of(part.attrs))]
