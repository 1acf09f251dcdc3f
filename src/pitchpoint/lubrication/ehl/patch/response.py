"""How the pressure over a patch answers to small changes of what it is made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, NamedTuple

from jax.scipy.sparse.linalg import gmres
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.ehl.patch.balance import flow_balance
from pitchpoint.lubrication.ehl.patch.heat import ContactHeat, patch_temperature_rise, warmed_patch
from pitchpoint.lubrication.ehl.patch.layout import PatchProblem
from pitchpoint.lubrication.ehl.patch.newton import (
    Linear,
    Rows,
    by_rows,
    inverted_rows,
    jacobian_product,
    linearised,
)
from pitchpoint.lubrication.ehl.strips import LEAST_RISE

__all__ = ["PolishedSolution", "polished_patch", "polished_solution", "polished_warm"]

Map = Callable[[Array], Array]

LEFT: Final = 1e-12
"""What a linear solve leaves of its right-hand side."""

DIRECTIONS: Final = 30
"""Directions of a linear solve that are known at once."""

RESTARTS: Final = 10
"""Times that these are looked for."""


def polished_patch(problem: PatchProblem, pressure: Array, level: Array) -> tuple[Array, Array]:
    """Pressure and level of a solution, with their derivatives to all that the problem is made of.

    A last step from the solution carries them (implicit function theorem), with the cells that are full and
    those that are not as they are.

    Args:
        problem: the contact.
        pressure: solution, shape (y, x).
        level: of the surfaces.

    From the implicit function theorem at the solution.
    """
    frozen, pressure, level = jax.lax.stop_gradient((problem, pressure, level))
    at = linearised(frozen, pressure, level, jnp.zeros(()))
    change = inner_response(at, inverted_rows(at), -_rest(problem, at, pressure, level))
    inner = change[:-1].reshape(at.rest.shape)
    return pressure.at[:, 1:-1].add(inner), level + change[-1]


def polished_warm(
    heats: ContactHeat, problem: PatchProblem, pressure: Array, level: Array
) -> tuple[PatchProblem, Array, Array]:
    """Contact as warm as it is, pressure and level, with their derivatives to all that it is made of.

    As `polished_patch`, with pressure, level and temperature together.

    Args:
        heats: what decides about the heat.
        problem: the contact, as warm as in the solution.
        pressure: solution, shape (y, x).
        level: of the surfaces.

    From the implicit function theorem at the solution.
    """
    rise = problem.flow.temperature_rise
    frozen, still, pressure, level, rise = jax.lax.stop_gradient(
        (problem, heats, pressure, level, rise)
    )
    at = linearised(frozen, pressure, level, jnp.zeros(()))
    alone, size, unit = inverted_rows(at), at.rest.size + 1, jnp.max(rise) + LEAST_RISE

    def parts(change: Array) -> tuple[Array, Array, Array]:
        inner = change[: size - 1].reshape(at.rest.shape)
        there = pressure + jnp.pad(inner, ((0, 0), (1, 1))), level + change[size - 1]
        return *there, rise + unit * change[size:].reshape(rise.shape)

    def rest(heats: ContactHeat, problem: PatchProblem, change: Array) -> Array:
        there, risen_to = parts(change)[:2], parts(change)[2]
        warm = warmed_patch(problem, risen_to)
        off = (risen_to - patch_temperature_rise(heats, warm, *there)) / unit
        return jnp.append(_rest(warm, at, *there), jnp.ravel(off))

    none = jnp.zeros(size + rise.size)
    _, times = jax.linearize(lambda change: rest(still, frozen, change), none)

    def nearly(right_side: Array) -> Array:
        return jnp.append(by_rows(alone, at.share, right_side[:size]), right_side[size:])

    pressure, level, rise = parts(inverted(times, nearly, -rest(heats, problem, none)))
    return warmed_patch(problem, rise), pressure, level


def _rest(problem: PatchProblem, at: Linear, pressure: Array, level: Array) -> Array:
    """What is left of all balances, as those of the solution but for the problem, see `linearised`."""
    gap = problem.gap(pressure, level)
    oil = pressure - problem.flow.asperity_pressure(gap)
    gain, _ = flow_balance(problem, oil, gap, jnp.zeros(()))
    residuals = jnp.where(at.full, -gain / at.scale, oil[:, 1:-1])
    return jnp.append(residuals, problem.bodies.load(pressure) / problem.load - 1.0)


def inner_response(at: Linear, alone: Rows, rest: Array) -> Array:
    """Change of inner pressures, the level at last, for changes of all balances; can be differentiated."""
    return inverted(
        lambda change: jacobian_product(at, change),
        lambda right_side: by_rows(alone, at.share, right_side),
        rest,
    )


def inverted(times: Map, nearly: Map, rest: Array) -> Array:
    """What a linear map takes to a rest; can be differentiated.

    Args:
        times: the map.
        nearly: what almost takes it back.
        rest: shape (unknown,).
    """
    times_back = jax.linear_transpose(times, rest)
    nearly_back = jax.linear_transpose(nearly, rest)
    solution: Array = jax.lax.custom_linear_solve(
        times,
        rest,
        lambda _, right_side: _solved(times, nearly, right_side),
        lambda _, right_side: _solved(
            lambda v: times_back(v)[0], lambda v: nearly_back(v)[0], right_side
        ),
    )
    return solution


def _solved(times: Map, nearly: Map, right_side: Array) -> Array:
    solution: Array
    solution, _ = gmres(
        times,
        right_side,
        M=nearly,
        tol=LEFT,
        restart=DIRECTIONS,
        maxiter=RESTARTS,
        solve_method="batched",
    )
    return solution


class PolishedSolution(NamedTuple):
    """A solution after a last step, in own units.

    Attributes:
        pressure: shape (y, x).
        level: of the surfaces.
        rest: largest defect of the balance of a cell.
        load: defect of the load over it.
        by_load: change of the level with the load, as a part of it.
        by_approach: with the speed of approach.
    """

    pressure: Float[Array, "y x"]
    level: Float[Array, ""]
    rest: Float[Array, ""]
    load: Float[Array, ""]
    by_load: Float[Array, ""]
    by_approach: Float[Array, ""]


def polished_solution(problem: PatchProblem, pressure: Array, level: Array) -> PolishedSolution:
    """A last step from a solution, whose linear solve leaves nothing, and what the level answers there.

    Args:
        problem: the contact.
        pressure: solution, shape (y, x).
        level: of the surfaces.
    """
    pressure, level = polished_patch(problem, pressure, level)
    end = linearised(problem, pressure, level, jnp.zeros(()))
    alone = inverted_rows(end)
    load_step = jnp.zeros(end.rest.size + 1).at[-1].set(1.0)
    closing = _closing(problem, end, pressure, level)
    by_load, by_approach = (inner_response(end, alone, push)[-1] for push in (load_step, closing))
    largest = jnp.max(jnp.abs(end.rest))
    return PolishedSolution(pressure, level, largest, end.load, by_load, by_approach)


def _closing(problem: PatchProblem, at: Linear, pressure: Array, level: Array) -> Array:
    """Change of all balances, taken away, with an approach of one."""
    asperities = problem.flow.asperity_pressure(problem.gap(pressure, level))
    oil = problem.flow.density(pressure - asperities)
    gained = (oil * jnp.asarray(problem.bodies.areas)[:, None])[:, 1:-1]
    return jnp.append(jnp.where(at.full, gained / at.scale, 0.0), 0.0)
