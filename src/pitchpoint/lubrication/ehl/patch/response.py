"""How the pressure over a patch answers to small changes of what it is made of."""

from __future__ import annotations

from typing import Final

from jax.scipy.sparse.linalg import gmres
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.ehl.patch.balance import balance
from pitchpoint.lubrication.ehl.patch.layout import Problem
from pitchpoint.lubrication.ehl.patch.newton import Linear, Rows, by_rows, linear, product, rows

__all__ = ["polished", "stiffness_and_damping"]

LEFT: Final = 1e-12
"""What a linear solve leaves of its right-hand side."""

DIRECTIONS: Final = 30
"""Directions of a linear solve that are known at once."""

RESTARTS: Final = 10
"""Times that these are looked for."""


def polished(problem: Problem, pressure: Array, level: Array) -> tuple[Array, Array]:
    """Pressure and level of a solution, with their derivatives to all that the problem is made of.

    A last step from the solution carries them (implicit function theorem), with the cells that are full and
    those that are not as they are.

    Args:
        problem: the contact.
        pressure: solution, shape (y, x).
        level: of the surfaces.
    """
    frozen, pressure, level = jax.lax.stop_gradient((problem, pressure, level))
    at = linear(frozen, pressure, level, jnp.zeros(()))
    change = answered(at, rows(at), -_rest(problem, at, pressure, level))
    inner = change[:-1].reshape(at.rest.shape)
    return pressure.at[:, 1:-1].add(inner), level + change[-1]


def _rest(problem: Problem, at: Linear, pressure: Array, level: Array) -> Array:
    """What is left of all balances, as those of the solution but for the problem, see `linear`."""
    gap = problem.gap(pressure, level)
    oil = pressure - problem.flow.asperity_pressure(gap)
    gain, _ = balance(problem, oil, gap, jnp.zeros(()))
    rest = jnp.where(at.full, -gain / at.scale, oil[:, 1:-1])
    return jnp.append(rest, problem.bodies.load(pressure) / problem.load - 1.0)


def answered(at: Linear, alone: Rows, rest: Array) -> Array:
    """Change of inner pressures, the level at last, for changes of all balances; can be differentiated."""

    def there(times: object, one: Array) -> Array:
        return _solved(lambda v: product(at, v), lambda v: by_rows(alone, at.share, v), one)

    def back(times: object, one: Array) -> Array:
        mirrored = (
            jax.linear_transpose(lambda v: product(at, v), one),
            jax.linear_transpose(lambda v: by_rows(alone, at.share, v), one),
        )
        return _solved(*(lambda v, f=f: f(v)[0] for f in mirrored), one)  # type: ignore[misc]

    found: Array = jax.lax.custom_linear_solve(lambda v: product(at, v), rest, there, back)
    return found


def _solved(times: object, nearly: object, rest: Array) -> Array:
    found: Array
    found, _ = gmres(
        times,
        rest,
        M=nearly,
        tol=LEFT,
        restart=DIRECTIONS,
        maxiter=RESTARTS,
        solve_method="batched",
    )
    return found


def stiffness_and_damping(
    problem: Problem, pressure: Array, level: Array, held: Float[Array, "y x"]
) -> tuple[Array, Array]:
    """Load that a thinner mean film carries more, and load by an approach that holds it, in own units.

    Args:
        problem: the contact.
        pressure: solution, shape (y, x).
        level: of the surfaces.
        held: one on the cells over which films are meant, shape (y, x).

    Returns:
        -dF/dh over load by film, and dF/dV over the same by the unit of `flow.approach`.
    """
    at = linear(problem, pressure, level, jnp.zeros(()))
    alone = rows(at)
    more = jnp.zeros(at.rest.size + 1).at[-1].set(1.0)
    dense = problem.flow.density(
        pressure - problem.flow.asperity_pressure(problem.gap(pressure, level))
    )
    areas = jnp.asarray(problem.bodies.areas)[:, None]
    closing = jnp.where(at.full, (dense * areas)[:, 1:-1] / at.scale, 0.0)
    by_load = _film(problem, held, answered(at, alone, more), at)
    by_approach = _film(problem, held, answered(at, alone, jnp.append(closing, 0.0)), at)
    return -1.0 / by_load, -by_approach / by_load


def _film(problem: Problem, held: Array, change: Array, at: Linear) -> Array:
    """Change of the mean film with pressures and level."""
    pressure = jnp.pad(change[:-1].reshape(at.rest.shape), ((0, 0), (1, 1)))
    sinks = problem.bodies.deflection(pressure, 1.0 / problem.yielding) + change[-1]
    return problem.mean(sinks, held)
