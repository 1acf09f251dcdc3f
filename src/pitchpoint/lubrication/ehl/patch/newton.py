"""Newton's method on a patch: pressure of every cell and the load at once, rows as the preconditioner."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np
from jaxtyping import Array, Bool, Float
from numpy.typing import NDArray

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import fast_program
from pitchpoint.lubrication.ehl.patch.balance import ALONG, Stencil, flow_balance, stencil
from pitchpoint.lubrication.ehl.patch.layout import PatchProblem

__all__ = [
    "CAREFUL",
    "ENOUGH",
    "MOST",
    "TOLERANCE",
    "Linear",
    "Manner",
    "PatchIterate",
    "Progress",
    "Rows",
    "by_rows",
    "inverted_rows",
    "jacobian_product",
    "linearised",
    "newton_on_patch",
]

Progress = Callable[[int, float], None]

TOLERANCE: Final = 1e-8
"""Residual at which an iteration ends, in units of the largest dry pressure."""

ENOUGH: Final = 1e-6
"""Residual of a solution that rounding keeps from coming closer."""

SHORTEST: Final = 0.5**8
"""Least part of a step that is tried."""

# By trial, on the contacts of `INEXACT`: with 0.5 they take 4 % fewer steps, and all are found.
MENDED: Final = 0.1
"""Part of the balances that a step has to mend, over its own part."""

# By trial, on the contacts of `INEXACT`: with a tenth of it 1 % fewer steps, so it is no matter of digits.
SHRINKING: Final = 0.2
"""Least room for oil after a step in the other manner, over that before."""

# A mark more than a number: after such a step the time neither grows, as after a whole one, nor shrinks, as
# after one that was cut, half of it at most.
NEARLY: Final = 0.99
"""Part that counts for a step in which a pressure changed by the longest step."""

# By trial, on the contacts of `INEXACT`: with 1.0 they take 13 % more steps, and one is lost.
SHORTER: Final = 2.0
"""Power of its part by which the time shrinks after a step that was cut."""

FASTEST: Final = 100.0
"""One over the shortest time of a step."""

MOST: Final = 40
"""Steps after which an attempt is given up."""

PATIENCE: Final = 15
"""Steps over which the lowest residual has to fall in a careful attempt."""

STUCK: Final = 3
"""Steps in turn of which hardly anything is taken, after which an attempt is given up."""

FALLING: Final = 0.5
"""Factor by which it has to."""

# Of no account for `solve`, whose starts have times of their own.
FIRST_TIME: Final = 1.0
"""Time over which the first step lets oil flow, in which surfaces pass a half-width."""

# By trial, on the contacts of `INEXACT`: with 5 as many steps, without `MUCH_LONGER` 4 % more.
LONGER: Final = 2.5
"""Factor by which that time grows with each full step."""

SURE: Final = 0.1
"""What a step leaves of the balances of its time from which on the next time grows more."""

MUCH_LONGER: Final = 5.0
"""Factor by which it grows then."""

# By trial, on the contacts of `INEXACT`: 1e-2 takes 7 % fewer steps and finds them all.
STEADY: Final = 1e-4
"""Residual from which on oil has all the time that it needs, and one over the time below which it has."""

# By trial, on 12 contacts of `tests/long/many_patch_films.py` with 65 x 64 nodes, 563 steps in all: 0.1 takes
# 12 % more steps; 1e-4 takes 6 % more, with more directions in each, and loses one contact.
INEXACT: Final = 1e-2
"""What a linear solve leaves of its right-hand side."""

EVEN: Final = 1e-9
"""Largest difference of rows that are images of each other, over the largest value in them."""

# By trial, on the same contacts: with 15 they take 35 % more steps, and one is lost.
DIRECTIONS: Final = 60
"""Directions of a linear solve after which its result is taken as it is."""

# By trial, on the contacts of `INEXACT`: 374 inversions; inverting in every step takes 531 and saves no step,
# an age of 8 takes 334 and 66 steps more.
AGE: Final = 3
"""Steps for which rows that were inverted once do, near a solution."""

NEAR: Final = 0.05
"""Residual from which on they are not inverted anew in each step."""


class PatchIterate(NamedTuple):
    """Where an iteration stands.

    Attributes:
        pressure: that oil and asperities carry, shape (y, x).
        level: of the surfaces.
        residual: largest one.
        load: defect of the load over it.
        steps: of Newton's method, on all grids.
    """

    pressure: Any
    level: Any
    residual: float
    load: float
    steps: int


class Linear(NamedTuple):
    """The balance of every cell and of the load near a pressure.

    Attributes:
        rest: what is left of the balance of the inner cells, shape (y, inner).
        load: of the load, over it.
        by_pressure: derivatives of the rest to pressures.
        by_gap: to deflections.
        by_level: to the level of the surfaces, shape (y, inner).
        share: of the load by a pressure of one on a cell of each row, shape (y,).
        full: cells that are full of oil, shape (y, inner).
        scale: what turns a defect of their balances into one of pressures, shape (y, inner).
        problem: the contact.
    """

    rest: Float[Array, "y inner"]
    load: Float[Array, ""]
    by_pressure: Stencil
    by_gap: Stencil
    by_level: Float[Array, "y inner"]
    share: Float[Array, " y"]
    full: Bool[Array, "y inner"]
    scale: Float[Array, "y inner"]
    problem: PatchProblem


class Rows(NamedTuple):
    """Every row solved as if it stood alone, with the load they carry together.

    Attributes:
        inverse: of the derivatives of a row to its own pressures, shape (row, inner, inner); of all rows, or
            of those up to the middle where the others are their images.
        lifted: pressures by which these rows answer to a level of one, shape (row, inner).
        carried: load of these of all rows.
    """

    inverse: Float[Array, "row inner inner"]
    lifted: Float[Array, "row inner"]
    carried: Float[Array, ""]


class _LinearSearch(NamedTuple):
    """Where a linear solve stands.

    Attributes:
        change: so far.
        left: of the rest.
        moves: directions, shape (directions, unknowns).
        effects: what they do to the balances, orthogonal and of length one.
        number: of them.
    """

    change: Float[Array, " unknown"]
    left: Float[Array, " unknown"]
    moves: Float[Array, "directions unknown"]
    effects: Float[Array, "directions unknown"]
    number: Array


def linearised(problem: PatchProblem, pressure: Array, level: Array, rate: Array) -> Linear:
    """Balances and their derivatives at a pressure.

    A cell is full of oil, and balanced, or its oil is without pressure, as in a line. Cells at the first and
    the last node of each row are without pressure.
    """
    gap = problem.gap(pressure, level)
    carried, softer = jax.jvp(problem.flow.asperity_pressure, (gap,), (jnp.ones_like(gap),))
    oil = pressure - carried
    gain, diagonal, by_oil, by_gap = stencil(problem, oil, gap, rate)
    scale = diagonal + jnp.asarray(problem.bodies.areas)[:, None]
    defect = -gain / scale
    full = oil[:, 1:-1] > defect
    residuals = jnp.where(full, defect, oil[:, 1:-1])
    own_row = jnp.where(full, -by_oil.along / scale, 0.0).at[2].add(~full * 1.0)
    by_pressure = Stencil(own_row, jnp.where(full, -by_oil.across / scale, 0.0))
    by_height = Stencil(
        *(jnp.where(full, -derivative / scale, 0.0) for derivative in (by_gap.along, by_gap.across))
    )
    softened = _softened(by_pressure, softer)
    to_gap = jax.tree.map(lambda direct, softening: direct - softening, by_height, softened)
    areas = jnp.asarray(problem.bodies.areas) / problem.load
    return Linear(
        residuals,
        areas @ jnp.sum(pressure, axis=1) - 1.0,
        by_pressure,
        to_gap,
        jnp.sum(to_gap.along, axis=0) + jnp.sum(to_gap.across, axis=0),
        areas,
        full,
        scale,
        problem,
    )


def _softened(by_pressure: Stencil, softer: Array) -> Stencil:
    """What gaps change by the pressure that asperities take from the oil."""
    along, across = _around(softer)
    return Stencil(by_pressure.along * along, by_pressure.across * across)


def _around(field: Array) -> tuple[Array, Array]:
    """Values at the cells that each inner cell knows: of its row, and of its column."""
    rows, nodes = field.shape
    inner = nodes - 2
    row = jnp.pad(field, ((0, 0), (1, 0)), mode="edge")
    column = jnp.pad(field[:, 1:-1], ((2, 1), (0, 0)))
    return (
        jnp.stack([row[:, k : k + inner] for k in range(ALONG)]),
        jnp.stack([column[k : k + rows] for k in (0, 1, 3)]),
    )


def _times(derivatives: Stencil, field: Array) -> Array:
    along, across = _around(field)
    return jnp.sum(derivatives.along * along, axis=0) + jnp.sum(derivatives.across * across, axis=0)


def jacobian_product(at: Linear, change: Array) -> Array:
    """Change of all balances, the load at last, with that of inner pressures, the level at last."""
    inner = change[:-1].reshape(at.rest.shape)
    pressure = jnp.pad(inner, ((0, 0), (1, 1)))
    sinks = at.problem.bodies.deflection(pressure, 1.0 / at.problem.yielding)
    residuals = (
        _times(at.by_pressure, pressure) + _times(at.by_gap, sinks) + at.by_level * change[-1]
    )
    return jnp.append(residuals, at.share @ jnp.sum(inner, axis=1))


def inverted_rows(at: Linear, even: bool = False) -> Rows:
    """Rows inverted: what they do to themselves by flow and by deflection.

    Args:
        at: balances.
        even: whether rows are images of each other about the middle of the grid; half of them do then.
    """
    inner = at.rest.shape[1]
    some = slice(at.rest.shape[0] // 2 if even else None)
    lines = at.problem.yielding * at.problem.bodies.lines()[some]
    reached = jnp.concatenate((lines[:, :1], lines), axis=1)[:, :, 1:-1]
    by_gap, by_pressure = at.by_gap.along[:, some], at.by_pressure.along[:, some]
    matrix = sum(by_gap[k][:, :, None] * reached[:, k : k + inner] for k in range(ALONG))
    row, column, which = _bands(inner)
    system = jnp.asarray(matrix).at[:, row, column].add(by_pressure[which, :, row].T)
    inverse = jnp.linalg.inv(system)
    lifted = jnp.einsum("yij,yj->yi", inverse, at.by_level[some])
    return Rows(inverse, lifted, at.share @ jnp.sum(_with_images(lifted, at.share), axis=1))


def _with_images(by_row: Array, share: Array) -> Array:
    """Values of all rows, from those of all or of those up to the middle."""
    every: Array = by_row if len(by_row) == len(share) else jnp.concatenate((by_row, by_row[::-1]))
    return every


def _even(problem: PatchProblem) -> bool:
    """Whether the rows of a contact are images of each other; cells across are even in number."""
    warm = np.atleast_1d(problem.flow.temperature_rise)
    across = [np.diff(problem.bodies.edges), problem.along, problem.apart, problem.before, warm]
    sizes = map(np.asarray, across)
    alike = all(
        np.max(np.abs(field - field[::-1])) <= EVEN * np.max(np.abs(field)) for field in sizes
    )
    return alike and float(problem.across) == 0.0


def _bands(inner: int) -> tuple[NDArray[np.int_], NDArray[np.int_], NDArray[np.int_]]:
    """Rows and columns of the band of a matrix, and which diagonal each entry is on."""
    row = np.tile(np.arange(inner), (ALONG, 1))
    column = row + np.arange(ALONG)[:, None] - 2
    inside = (column >= 0) & (column < inner)
    return row[inside], column[inside], np.nonzero(inside)[0]


def by_rows(alone: Rows, share: Array, rest: Array) -> Array:
    """Change that would mend what is left, if rows felt each other by the load alone.

    From the rows solved one by one and one equation for the load that they carry together.
    """
    by_row = rest[:-1].reshape(share.size, -1)
    count = len(alone.inverse)
    if count == share.size:
        change = jnp.einsum("yij,yj->yi", alone.inverse, by_row)
    else:
        # A row and its image at once: so every inverse is read once.
        both = jnp.einsum(
            "yij,yjc->yic", alone.inverse, jnp.stack((by_row[:count], by_row[: count - 1 : -1]), -1)
        )
        change = jnp.concatenate((both[..., 0], both[::-1, :, 1]))
    level = (share @ jnp.sum(change, axis=1) - rest[-1]) / alone.carried
    return jnp.append(change - _with_images(alone.lifted, share) * level, level)


def newton_correction(at: Linear, alone: Rows, rest: Array) -> Array:
    """Change of inner pressures, the level at last, that takes a rest away from all balances.

    Args:
        at: balances.
        alone: rows inverted, there or nearby.
        rest: of all inner cells, the load at last.

    Source: Eisenstat, Elman and Schultz (1983), generalised conjugate residuals.
    """
    size = rest.shape[0]
    directions = jnp.zeros((DIRECTIONS, size))
    begin = _LinearSearch(jnp.zeros(size), rest, directions, directions, jnp.zeros((), int))
    enough = INEXACT * jnp.linalg.norm(rest)

    def unfinished(search: _LinearSearch) -> Array:
        going: Array = (search.number < DIRECTIONS) & (jnp.linalg.norm(search.left) > enough)
        return going

    def onward(search: _LinearSearch) -> _LinearSearch:
        return _searched(at, alone, search)

    change: Array = jax.lax.while_loop(unfinished, onward, begin).change
    return change


def _searched(at: Linear, alone: Rows, search: _LinearSearch) -> _LinearSearch:
    """The best change along one more direction: rows mended alone, less what is known to do nothing new."""
    move = by_rows(alone, at.share, search.left)
    effect = jacobian_product(at, move)
    for _ in range(2):  # twice is enough for rounding
        projections = search.effects @ effect
        effect, move = effect - projections @ search.effects, move - projections @ search.moves
    size = jnp.linalg.norm(effect)
    effect, move = effect / size, move / size
    length = effect @ search.left
    return _LinearSearch(
        search.change + length * move,
        search.left - length * effect,
        search.moves.at[search.number].set(move),
        search.effects.at[search.number].set(effect),
        search.number + 1,
    )


class Manner(NamedTuple):
    """How steps are taken.

    Attributes:
        careful: whether they are cut until they mend the balances of the time that they let oil flow; else
            only where the room for oil would shrink too much.
        longest: change of a pressure in a step.
    """

    careful: Any
    longest: Any


class Moved(NamedTuple):
    """What became of a step.

    Attributes:
        pressure: after it, shape (y, x).
        level: of the surfaces.
        part: of the step that was taken; one where nothing had to be cut, nearly one where a pressure was.
        left: what it leaves of the balances of its time, over what it found.
    """

    pressure: Float[Array, "y x"]
    level: Float[Array, ""]
    part: Float[Array, ""]
    left: Float[Array, ""]


def newton_step(
    at: Linear, pressure: Array, level: Array, change: Array, rate: Array, manner: Manner
) -> Moved:
    """A step in one manner or the other.

    Every pressure changes by no more than the longest step.
    """
    problem, longest = at.problem, manner.longest
    inner = jnp.clip(change[:-1], -longest, longest).reshape(pressure.shape[0], -1)
    step, rise = jnp.pad(inner, ((0, 0), (1, 1))), change[-1]
    gap = problem.gap(pressure, level)
    grows = problem.gap(pressure + step, level + rise) - gap
    mass, begin = _mass(problem, pressure, gap), jnp.linalg.norm(at.rest)
    least = SHRINKING * problem.flow.room(gap)

    def tried(part: Array) -> tuple[Array, Array, Array]:
        there = gap + part * grows
        residuals = _rest_in_time(at, pressure + part * step, there, mass, rate)
        left = jnp.linalg.norm(residuals) / begin
        roomy = jnp.all(problem.flow.room(there) > least)
        fits = jnp.where(manner.careful, left <= 1.0 - MENDED * part, roomy)
        return part, left, fits

    def unfit(search: tuple[Array, Array, Array]) -> Array:
        return (search[0] > SHORTEST) & ~search[2]

    fitting = jax.lax.while_loop(unfit, lambda search: tried(0.5 * search[0]), tried(jnp.ones(())))
    part, left, _ = fitting
    unclipped = jnp.all(jnp.abs(change[:-1]) <= longest)
    cut = jnp.where(unclipped, part, NEARLY * part)
    return Moved(pressure + part * step, level + part * rise, cut, left)


CAREFUL: Final = Manner(True, 1.0)

USUAL: Final = Manner(False, 1.0)


def _mass(problem: PatchProblem, pressure: Array, gap: Array) -> Array:
    """Mass of the oil under each cell."""
    oil = pressure - problem.flow.asperity_pressure(gap)
    mass, _ = problem.flow.mass_and_ease(oil, gap)
    return jnp.asarray(mass)


def _rest_in_time(at: Linear, pressure: Array, gap: Array, mass: Array, rate: Array) -> Array:
    """What is left of all balances at another pressure, if the oil was another mass before."""
    problem = at.problem
    oil = pressure - problem.flow.asperity_pressure(gap)
    gain, _ = flow_balance(problem, oil, gap, jnp.zeros(()))
    stored = (_mass(problem, pressure, gap) - mass) * jnp.asarray(problem.bodies.areas)[:, None]
    residuals: Array = jnp.minimum((rate * stored[:, 1:-1] - gain) / at.scale, oil[:, 1:-1])
    return residuals


_linear, _rows = fast_program(linearised), fast_program(inverted_rows)
_mended, _moved = fast_program(newton_correction), fast_program(newton_step)


def newton_on_patch(
    problem: PatchProblem,
    pressure: Any,
    level: Any,
    time: float = FIRST_TIME,
    told: Progress | None = None,
    manner: Manner = USUAL,
    most: int = MOST,
    enough: float = TOLERANCE,
) -> PatchIterate:
    """Newton's iteration from a guess, with the time that oil has to flow growing as it goes.

    Args:
        problem: the contact.
        pressure: guess, shape (y, x).
        level: of the surfaces.
        time: of the first step; the shorter, the closer each step stays to the film before.
        told: called with the number of steps and the residual after each of them.
        manner: in which steps are taken.
        most: steps after which an attempt is given up.
        enough: residual at which the iteration ends.

    Source: Kelley and Keyes (1998), pseudo-transient continuation; how its time grows is by trial.
    """
    state = PatchIterate(pressure, level, np.inf, np.inf, 0)
    rate, alone, age = 1.0 / time, None, 0
    lowest: list[float] = []
    stuck = 0
    held = Manner(*map(array, manner))
    even = _even(problem)
    for step in range(most + 1):
        at = _linear(problem, state.pressure, state.level, array(rate))
        residual = float(jnp.max(jnp.abs(at.rest)))
        state = state._replace(residual=residual, load=float(at.load), steps=step)
        if told is not None:
            told(step, residual)
        lowest.append(min([residual, *lowest[-1:]]))
        done = rate == 0.0 and _done(max(residual, abs(state.load)), lowest, enough)
        hopeless = stuck == STUCK or (manner.careful and _hopeless(lowest))
        if not np.isfinite(residual) or step == most or done or hopeless:
            break
        if alone is None or residual > NEAR or age >= AGE:
            alone, age = _rows(at, even), 0
        age += 1
        residuals = np.append(np.ravel(at.rest), float(at.load))
        change = _mended(at, alone, array(-residuals))
        arguments = at, state.pressure, state.level, change, array(rate), held
        after = _moved(*arguments)
        state = state._replace(pressure=after.pressure, level=after.level)
        stuck = stuck + 1 if float(after.part) <= SHORTEST else 0
        rate = _rate(rate, float(after.part), float(after.left), residual)
    return state


def _done(worst: float, lowest: list[float], enough: float) -> bool:
    """Whether balances are close enough, or nearly so and come no closer for rounding."""
    stalls = len(lowest) > 1 and lowest[-1] > FALLING * lowest[-2]
    return worst < enough or (worst < TOLERANCE and stalls)


def _hopeless(lowest: list[float]) -> bool:
    """Whether the lowest residual so far hardly falls."""
    return len(lowest) > PATIENCE and lowest[-1] > FALLING * lowest[-1 - PATIENCE]


def _rate(rate: float, part: float, left: float, residual: float) -> float:
    """One over the time of the next step: longer after whole steps, shorter after those that were cut."""
    if part < NEARLY:
        rate = min(rate / part**SHORTER, FASTEST)
    elif part == 1.0:
        rate = rate / (LONGER if left > SURE else MUCH_LONGER)
    return 0.0 if rate < STEADY or residual < STEADY else rate
