"""Newton's method for a line contact: oil pressure, asperities, cavitation and load at once."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Array, Float, Int
from numpy.typing import NDArray

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.ehl.line import LineProblem
from pitchpoint.lubrication.ehl.line_grid import LineGrid, prolongation
from pitchpoint.lubrication.ehl.reynolds import REACH, banded

__all__ = [
    "ENOUGH",
    "TOLERANCE",
    "LineIterate",
    "from_coarse",
    "polished_line",
    "residual",
    "solved_films",
    "step",
]

TOLERANCE: Final = 1e-10
"""Residual at which an iteration ends, in units of Hertz's pressure; one more step follows."""

ENOUGH: Final = 1e-8
"""Residual of a solution that rounding keeps from coming closer."""

# By trial, on 128 contacts of `tests/long/many_line_films.py`: 89 steps at most, 227 with 2.0, 94 with 0.1.
# The median, 17, hardly changes; but contacts that are solved together wait for the slowest.
LONGEST_STEP: Final = 0.3
"""Largest change of a pressure in a step, in units of Hertz's pressure."""

MOST: Final = 40
"""Steps after which an attempt on a grid is given up."""

# By trial, on the same contacts: 1 takes 148 steps at most, 6 takes 77 and two more in the median.
THICK: Final = 2.5
"""First guess of the film over the one that a regression gives."""

# By trial, on the same contacts: these take 89 steps at most, a second attempt at the same speed 125.
FASTER: Final = (1.0, 8.0, 4.0, 2.0, 1.0)
"""Speeds, over the given one, at which films are found one after the other where the first attempt fails:
from a thick film, which every guess leads to, down to the thin one."""


class LineIterate(NamedTuple):
    """Where an iteration stands, of one contact, in units of the contact.

    Attributes:
        pressure: at the nodes.
        level: of the surfaces.
        speed: number of that in `FASTER` at which it is.
        steps: since the last start.
        total: all steps.
        residual: largest one.
        coarse: films of `LineProblem.films` on the grid before and on the one before that, shape (2, 3); NaN
            where there is no such grid, or no solution on it.
    """

    pressure: Float[Array, " node"]
    level: Float[Array, ""]
    speed: Int[Array, ""]
    steps: Int[Array, ""]
    total: Int[Array, ""]
    residual: Float[Array, ""]
    coarse: Float[Array, "2 3"]


def residual(problem: LineProblem, pressure: Array, level: Array, at: LineGrid) -> Array:
    """What is left of the balance of every inner cell, and of the load at last, shape (node - 1,).

    A cell is full of oil, and balanced, or its oil is without pressure: the smaller of the oil pressure and
    of the defect of its balance is zero, the defect measured by the pressure that mends it.

    Source: Reynolds (1886); where the film ends pressure and its slope are zero, Swift (1932) and Stieber
    (1933).
    """
    gap = problem.gap(pressure, level, at)
    oil = pressure - problem.flow.asperity_pressure(gap)
    gain, diagonal = problem.flow.balance(oil, gap, at)
    return _rest(problem, pressure, oil, gain, _scale(diagonal, at), at)[0]


def _scale(diagonal: Array, at: LineGrid) -> Array:
    """What turns a defect of balances into one of pressures; no part of derivatives."""
    return jax.lax.stop_gradient(diagonal + at.widths[1:-1])


def _rest(
    problem: LineProblem, pressure: Array, oil: Array, gain: Array, scale: Array, at: LineGrid
) -> tuple[Array, Array]:
    """What is left of balances and load, and which cells are full of oil."""
    defect = -gain / scale
    full = (oil[1:-1] > defect) & problem.wet(at)
    residuals = jnp.where(full, defect, oil[1:-1])
    return jnp.append(residuals, at.widths @ pressure - problem.load), full


def step(problem: LineProblem, pressure: Array, level: Array, at: LineGrid) -> tuple[Array, Array]:
    """Residual, and its derivatives to what is unknown, shape (node - 1, node - 1).

    Unknown are the pressures at the inner nodes, which oil and asperities carry together, and the level of
    the surfaces.
    """
    gap = problem.gap(pressure, level, at)
    carried, softer = jax.jvp(problem.flow.asperity_pressure, (gap,), (jnp.ones_like(gap),))
    oil = pressure - carried
    balance = banded(problem.flow, oil, gap, at)
    scale = _scale(balance.own, at)
    residuals, full = _rest(problem, pressure, oil, balance.gain, scale, at)
    by_pressure = jnp.where(full, -balance.by_pressure / scale, 0.0).at[2].add(~full * 1.0)
    by_gap = jnp.where(full, -balance.by_gap / scale, 0.0) - by_pressure * _shifted(softer)
    matrix = _matrix(problem.yielding * by_gap, by_pressure, jnp.sum(by_gap, axis=0), at)
    return residuals, matrix


def _shifted(values: Array) -> Array:
    """Values at the REACH nodes that each inner cell knows, shape (reach, inner)."""
    padded = jnp.concatenate((values[:1], values))
    inner = values.shape[0] - 2
    return jnp.stack([padded[k : k + inner] for k in range(REACH)])


def _matrix(by_deflection: Array, by_pressure: Array, by_level: Array, at: LineGrid) -> Array:
    """Derivatives of all balances to pressures and level, shape (node - 1, node - 1)."""
    inner = by_level.shape[0]
    block = sum(by_deflection[k][:, None] * at.reached[k : k + inner] for k in range(REACH))
    rows, columns, inside = _bands(inner)
    every, border = np.arange(inner), np.full(inner, inner)
    # One scatter: each of them copies the whole matrix.
    values = jnp.concatenate((by_pressure.reshape(-1)[inside], by_level, at.widths[1:-1]))
    where = np.concatenate((rows, every, border)), np.concatenate((columns, border, every))
    return jnp.pad(block, (0, 1)).at[where].add(values)


def _bands(inner: int) -> tuple[NDArray[np.int_], NDArray[np.int_], NDArray[np.int_]]:
    """Rows and columns of what is known of each cell, and which of it is inside the matrix."""
    rows = np.tile(np.arange(inner), (REACH, 1))
    columns = rows + np.arange(REACH)[:, None] - 2
    inside = np.flatnonzero((columns >= 0) & (columns < inner))
    return rows.reshape(-1)[inside], columns.reshape(-1)[inside], inside


def dry(problem: LineProblem, at: LineGrid, factor: Array | float = 1.0) -> tuple[Array, Array]:
    """Pressure without oil, and the level at which the film in the middle is as guessed.

    Args:
        problem: the contact.
        at: the grid.
        factor: speed over the given one.
    """
    half_width = jnp.maximum(problem.yielding, 0.5)
    inside = jnp.maximum(1.0 - (at.x / half_width) ** 2, 0.0)
    return problem.carrying(jnp.sqrt(inside), THICK * problem.film * factor**0.7, at)


def newton_on_line(
    problem: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> LineIterate:
    """Newton's iteration on one grid, from a guess; from thick films where that fails."""
    faster = jnp.asarray(FASTER)
    last_speed = len(FASTER) - 1

    def unfinished(state: LineIterate) -> Array:
        return state.speed <= last_speed

    def onward(state: LineIterate) -> LineIterate:
        factor = faster[state.speed]
        residuals, matrix = step(problem.at_speed(factor), state.pressure, state.level, at)
        size = jnp.max(jnp.abs(residuals))
        tolerance = jnp.where(factor == 1.0, TOLERANCE, 1e-3)
        state = state._replace(residual=size, total=state.total + 1, steps=state.steps + 1)
        ended = (size < tolerance) | ~jnp.isfinite(size) | (state.steps > MOST)
        lost = ~(size < jnp.maximum(tolerance, ENOUGH))
        ways = lambda: _next(state, lost), lambda: _moved(state, residuals, matrix)
        advanced: LineIterate = jax.lax.cond(ended, *ways)
        return advanced

    def _next(state: LineIterate, lost: Array) -> LineIterate:
        solved = ~lost & (faster[state.speed] == 1.0)
        give_up = lost & (state.speed > 0)
        speed = jnp.where(solved | give_up, last_speed + 1, state.speed + 1)
        again = dry(problem, at, faster[jnp.minimum(speed, last_speed)])
        pressure = jnp.where(lost & ~give_up, again[0], state.pressure)
        level = jnp.where(lost & ~give_up, again[1], state.level)
        return state._replace(pressure=pressure, level=level, speed=speed, steps=jnp.asarray(0))

    def _moved(state: LineIterate, residuals: Array, matrix: Array) -> LineIterate:
        change = jnp.linalg.solve(matrix, -residuals)
        limit = jnp.minimum(1.0, LONGEST_STEP / jnp.max(jnp.abs(change[:-1])))
        return state._replace(
            pressure=state.pressure.at[1:-1].add(limit * change[:-1]),
            level=state.level + limit * change[-1],
        )

    zero = jnp.asarray(0)
    begin = LineIterate(
        pressure, level, zero, zero, zero, jnp.asarray(jnp.inf), jnp.full((2, 3), jnp.nan)
    )
    end: LineIterate = jax.lax.while_loop(unfinished, onward, begin)
    return end


def from_coarse(problem: LineProblem, grids: Sequence[LineGrid]) -> LineIterate:
    """Solution on the last of some grids, on each of them started from that on the one before.

    Args:
        problem: the contact.
        grids: from coarse to fine.
    """
    state = newton_on_line(problem, *dry(problem, grids[0]), grids[0])
    total = state.total
    for before, at in pairwise(grids):
        finer = prolongation(before.x.shape[0], at.x.shape[0])
        pressure = jnp.maximum(finer @ state.pressure, 0.0).at[jnp.array([0, -1])].set(0.0)
        coarse = jnp.stack((solved_films(problem, state, before), state.coarse[0]))
        state = newton_on_line(problem, pressure, state.level, at)._replace(coarse=coarse)
        total = total + state.total
    return state._replace(total=total)


def solved_films(problem: LineProblem, state: LineIterate, at: LineGrid) -> Array:
    """Films of `LineProblem.films`, shape (3,); NaN where the iteration found no solution."""
    films = problem.films(state.pressure, state.level, at)
    return jnp.where(state.residual < ENOUGH, films, jnp.nan)


def polished_line(
    problem: LineProblem, state: LineIterate, at: LineGrid, pushed: Array | None = None
) -> tuple[Array, Array, Array]:
    """Pressure and level of a solution, with their derivatives to all that the problem is made of.

    A last step from the solution carries them (implicit function theorem), with the cells that are full and
    those that are not as they are.

    Args:
        problem: the contact.
        state: at which its iteration ended.
        at: the grid.
        pushed: changes of the residual, shape (node - 1, any).

    Returns:
        Pressure, level, and what pressures and level answer to what is pushed, shape (node - 1, any).

    From the implicit function theorem at the solution.
    """
    frozen, pressure, level = jax.lax.stop_gradient((problem, state.pressure, state.level))
    _, matrix = step(frozen, pressure, level, at)
    residuals = residual(problem, pressure, level, at)
    also = jnp.zeros((residuals.shape[0], 0)) if pushed is None else pushed
    # One factorisation: it is what a step takes most of its time for.
    change = jnp.linalg.solve(matrix, -jnp.column_stack((residuals, also)))
    moved = change[:, 0]
    return pressure.at[1:-1].add(moved[:-1]), level + moved[-1], change[:, 1:]
