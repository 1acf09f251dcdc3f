"""How the film of a line contact gives way to more load, and to an approach of its surfaces."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.ehl.heat import warmed_line
from pitchpoint.lubrication.ehl.line import LineContact, LineProblem, problem_of
from pitchpoint.lubrication.ehl.line_grid import LineGrid
from pitchpoint.lubrication.ehl.newton import residual, step

__all__ = ["load_and_approach_change", "pushed_rest", "solution_response", "stiffness_and_damping"]


def load_and_approach_change(
    contact: LineContact, problem: LineProblem, at: LineGrid
) -> LineProblem:
    """Changes of a problem with the load of its contact, as a part of it, and with the approach [s/m].

    They are the last axis of every number. The film stays as warm as it is.

    Args:
        contact: one.
        problem: the same in units of its own.
        at: the grid.
    """

    def changed(change: Array) -> LineProblem:
        load, approach = contact.line_load * (1.0 + change[0]), contact.approach + change[1]
        load_and_approach: Any = load, approach
        changed_contact = eqx.tree_at(
            lambda tree: (tree.line_load, tree.approach), contact, load_and_approach
        )
        return warmed_line(problem_of(changed_contact, at), problem.flow.temperature_rise)

    push: LineProblem = jax.jacfwd(changed)(jnp.zeros(2))
    return push


def _both(
    function: Callable[..., Array], primals: tuple[Any, ...], along: tuple[Any, ...]
) -> Array:
    """Derivatives along two directions, which are the last axis of what they are told as."""
    derivative = lambda tangents: jax.jvp(function, primals, tangents)[1]  # noqa: E731
    derivatives: Callable[..., Array] = jax.vmap(derivative, in_axes=-1, out_axes=-1)
    return derivatives(along)


def pushed_rest(
    problem: LineProblem, push: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> Float[Array, "rest 2"]:
    """Changes of what is left of all balances at a pressure.

    Args:
        problem: the contact.
        push: its changes.
        pressure: of the nodes, shape (node,).
        level: of the surfaces.
        at: the grid.
    """
    return _both(lambda tree: residual(tree, pressure, level, at), (problem,), (push,))


def solution_response(
    problem: LineProblem, push: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> Float[Array, "rest 2"]:
    """Changes of pressures and level of a solution, by the implicit function theorem, see `pushed_rest`.

    From the implicit function theorem at the solution.
    """
    _, matrix = step(problem, pressure, level, at)
    changes: Array = jnp.linalg.solve(matrix, -pushed_rest(problem, push, pressure, level, at))
    return changes


def stiffness_and_damping(
    contact: LineContact,
    problem: LineProblem,
    push: LineProblem,
    pressure: Array,
    level: Array,
    answers: Array,
    at: LineGrid,
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Load that a thinner mean film carries more, and load by an approach that holds it.

    Args:
        contact: one.
        problem: the same in units of its own.
        push: its changes.
        pressure: of the nodes, shape (node,).
        level: of the surfaces.
        answers: their changes, see `solution_response`.
        at: the grid.

    Returns:
        -dw/dh [N/m2] and dw/dV [N s/m2]; the latter is not a number where surfaces stand still on each other.

    From the derivatives of the mean film to load and approach.
    """
    film = lambda tree, *state: tree.mean_film(*state, at) * tree.flow.height  # noqa: E731
    moved = jnp.pad(answers[:-1], ((1, 1), (0, 0)))
    by_load, by_approach = _both(film, (problem, pressure, level), (push, moved, answers[-1]))
    stiffness = -contact.line_load / by_load
    still = (contact.entrainment == 0.0) & (contact.approach == 0.0)
    return stiffness, jnp.where(still, jnp.nan, stiffness * by_approach)
