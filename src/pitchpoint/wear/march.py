"""The march of wear over the life of a drive: steps as long as their error allows, whatever the cycles."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import inf
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import RK23
from scipy.optimize import brentq

from pitchpoint.wear.history import DriverTurn

__all__ = ["FIRST", "End", "Limit", "Rate", "Reached", "unworn_flanks", "wear_step"]

Values = NDArray[np.float64]
End = Literal[
    "",
    "turns",
    "depth",
    "pressure",
    "hardness",
    "tip land",
    "backlash",
    "outgrown",
    "lost",
    "no wear",
]

FIRST = 1e-9
"""Depth that the first step takes off [m]; no less counts as depth when errors are judged."""


@dataclass(frozen=True)
class Rate:
    """What a turn does to flanks in a state.

    Attributes:
        depth: worn off every cell and place by a turn [member, cell, strip] [m].
        pressure: largest one [Pa].
        conforming: True where flanks were flatter than contacts are taken for.
        outgrown: True where contacts reach beyond the cells across the face.
        lost: True where the equilibrium of the contacts was not found, or a film.
    """

    depth: Values
    pressure: float
    conforming: bool
    outgrown: bool
    lost: bool

    @classmethod
    def of(cls, turn: DriverTurn) -> Self:
        """What a turn does, on the host."""
        return cls(
            depth=np.asarray(turn.depth),
            pressure=float(turn.pressure),
            conforming=bool(turn.conforming),
            outgrown=bool(turn.outgrown),
            lost=bool(turn.lost),
        )


@dataclass(frozen=True)
class Limit:
    """Where a march ends.

    Attributes:
        turns: of the driver.
        depth: on either member [m].
        pressure: largest one over that with flanks as new.
        hardness: of the softer flank, which no pressure exceeds: beyond it surfaces yield [Pa].
        teeth: measures of the depth that stay below zero, each with the end that it makes.
        deepest: depths among which the largest is, see `Cells`.
    """

    turns: float
    depth: float = inf
    pressure: float = inf
    hardness: float = inf
    teeth: tuple[tuple[End, Callable[[Values], float]], ...] = ()
    deepest: slice = field(default_factory=lambda: slice(None))


@dataclass(frozen=True)
class Reached:
    """Flanks after a step of the march.

    Attributes:
        turns: of the driver, so far.
        depth: worn off every cell and place [member, cell, strip] [m].
        rate: what a turn does there.
        error: of the depth, of each member: what steps and grid may be wrong by in every step, added up [m].
        step: turns of the next step, as its error is expected to allow.
        end: what ended the march; empty as long as it goes on.
    """

    turns: float
    depth: Values
    rate: Rate
    error: Values
    step: float
    end: End = ""

    @property
    def deepest(self) -> Values:
        """Largest depth of each member [m]."""
        largest: Values = self.depth.max(axis=(1, 2))
        return largest


def unworn_flanks(rate: Callable[[Values], Rate], shape: tuple[int, int, int]) -> Reached:
    """Flanks from which nothing is gone.

    Args:
        rate: of flanks that have lost so much already.
        shape: of depths.
    """
    none = np.zeros(shape)
    rate_as_new = rate(none)
    largest = float(rate_as_new.depth.max())
    end: End = "lost" if rate_as_new.lost else "" if largest > 0.0 else "no wear"
    step = FIRST / largest if largest > 0.0 else inf
    return Reached(0.0, none, rate_as_new, np.zeros(2), step, end)


def wear_step(
    before: Reached,
    rate: Callable[[Values], Rate],
    limit: Limit,
    *,
    start: float,
    tolerance: float,
    coarser: Callable[[Values], Rate] | None = None,
) -> Reached:
    """Flanks one step later, at a limit at the most.

    The same state gives the same step to the last bit, whether it was computed or read.

    Args:
        before: a state that is not at an end.
        rate: of flanks that have lost so much already.
        limit: where the march ends.
        start: largest pressure with flanks as new [Pa].
        tolerance: error of a step, over the largest depth.
        coarser: the rate on a coarser grid, for an estimate of what the grid does; none on grids of tests.

    Source: Bogacki and Shampine (1989), by SciPy.
    """
    shape, seen = before.depth.shape, {before.depth.tobytes(): before.rate}

    def seen_at(depth: Values) -> Rate:
        key = depth.tobytes()
        if key not in seen:
            state_rate = rate(depth.reshape(shape))
            if state_rate.lost:
                raise _LostError
            seen[key] = state_rate
        return seen[key]

    deepest = max(float(before.depth.max()), FIRST)
    try:
        march = RK23(
            lambda _, depth: seen_at(depth).depth.ravel(),
            before.turns,
            before.depth.ravel(),
            limit.turns,
            first_step=min(before.step, limit.turns - before.turns),
            rtol=tolerance,
            atol=tolerance * deepest,
        )
        march.step()
        if march.status == "failed":
            return replace(before, end="lost")
        turns, end = _ends(march, limit, seen_at, start, shape)
        depth = march.y if turns == march.t else march.dense_output()(turns)
        depth = np.maximum(depth, before.depth.ravel())  # a polynomial between two states may fall
        end_rate = seen_at(depth)
        apart = (
            np.zeros(2)
            if coarser is None
            else _of_grid(depth.reshape(shape), limit.deepest, end_rate, coarser)
        )
    except _LostError:
        return replace(before, end="lost")
    depth = depth.reshape(shape)
    estimated = march.step_size * np.abs(march.K.T @ march.E).reshape(shape).max(axis=(1, 2))
    # Where pairs come to carry within a long step the estimate is too small.
    allowed = tolerance * depth.max(axis=(1, 2))
    return Reached(
        turns=turns,
        depth=depth,
        rate=end_rate,
        error=before.error + np.maximum(estimated, allowed) + (turns - before.turns) * apart,
        step=march.h_abs,
        end="outgrown" if end_rate.outgrown and not end else end,
    )


def _of_grid(depth: Values, rows: slice, found: Rate, coarser: Callable[[Values], Rate]) -> Values:
    """What a coarser grid changes of a turn's wear where each member is deepest [m]."""
    coarse_rate = coarser(depth)
    if coarse_rate.lost:
        raise _LostError
    apart = np.abs(coarse_rate.depth - found.depth)[:, rows].reshape(2, -1)
    return np.asarray(apart[np.arange(2), depth[:, rows].reshape(2, -1).argmax(axis=1)])


class _LostError(Exception):
    """The equilibrium of the contacts was not found, or a film."""


def _ends(
    march: RK23,
    limit: Limit,
    rate: Callable[[Values], Rate],
    start: float,
    shape: tuple[int, ...],
) -> tuple[float, End]:
    """Turns at the end of a step, or where a limit is passed within it, and which."""
    inside = march.dense_output()

    def beyond_depth(turns: float) -> float:
        return float(inside(turns).reshape(shape)[:, limit.deepest].max()) - limit.depth

    def pressure(turns: float) -> float:
        return rate(march.y if turns == march.t else inside(turns)).pressure

    def beyond_pressure(turns: float) -> float:
        return pressure(turns) / start - limit.pressure

    def beyond_hardness(turns: float) -> float:
        return pressure(turns) / limit.hardness - 1.0

    def beyond(measure: Callable[[Values], float]) -> Callable[[float], float]:
        return lambda turns: measure(inside(turns).reshape(shape))

    ends: list[tuple[float, End]] = []
    if beyond_depth(march.t) >= 0.0:
        ends.append((brentq(beyond_depth, march.t_old, march.t), "depth"))
    if beyond_pressure(march.t) >= 0.0:
        ends.append((_first(beyond_pressure, march.t_old, march.t), "pressure"))
    if beyond_hardness(march.t) >= 0.0:
        ends.append((_first(beyond_hardness, march.t_old, march.t), "hardness"))
    for end, gap_of_teeth in limit.teeth:
        if (measure := beyond(gap_of_teeth))(march.t) >= 0.0:
            ends.append((_first(measure, march.t_old, march.t), end))
    if ends:
        return min(ends)
    return march.t, "turns" if march.status == "finished" else ""


def _first(beyond: Callable[[float], float], low: float, high: float) -> float:
    """Where a limit is passed between two places; the first one if it is passed there already."""
    if beyond(low) >= 0.0:
        return low
    return float(brentq(beyond, low, high, xtol=1e-4 * (high - low)))
