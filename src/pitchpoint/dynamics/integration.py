"""Integration of the equations of motion between neighbouring nodes of a period, by diffrax."""

from collections.abc import Callable

import diffrax
import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.dynamics_registry import ContactLaw
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import ExcitationCourse
from pitchpoint.dynamics.maps import horner, identity, matrix_product

__all__ = ["Pieces", "by_steps", "interval_coefficients", "travel"]

TOLERANCE = 1e-9
"""Largest estimated error of a step, of states of order one."""

MOST_STEPS = 256
"""Largest number of steps between two nodes."""


def by_steps(
    equations: Equations,
    course: ExcitationCourse,
    period: Float[Array, ""],
    adjoint: diffrax.AbstractAdjoint | None = None,
) -> tuple[Float[Array, "state state+1 element interval"], Bool[Array, ""]]:
    """Affine maps of the state from each node to the next, for teeth that never part.

    All intervals are one system of equations with common steps: they do not wait for each other.

    Args:
        equations: of the motion.
        course: excitation at the nodes.
        period: of the mesh [s].
        adjoint: how derivatives go through the steps; by default in reverse (`jax.grad`), with
            `diffrax.ForwardMode()` forwards.

    Returns:
        Fundamental matrices and, last, the states reached from rest; whether all were found.

    Source: Prince and Dormand (1981), their method of order eight, as diffrax has it.
    """
    grid = course.grid
    stiffness = grid.local(equations.total_stiffness)
    load = grid.local(equations.total_load)
    damping = equations.damping[:, :, None, None]
    half = equations.steps(course, period)
    size = equations.load.shape[0]
    through = adjoint or diffrax.RecursiveCheckpointAdjoint()

    def rate(time: Array, state: tuple[Array, Array], _: None) -> tuple[Array, Array]:
        place, speed = state
        force = matrix_product(horner(stiffness, time), place) + matrix_product(damping, speed)
        driven = -force[:, -1] + horner(load, time)
        return half * speed, half * jnp.concatenate([-force[:, :-1], driven[:, None]], axis=1)

    start = identity(size, half.shape)
    maps, done = _solve(rate, (start[:size], start[size:]), 1.0, TOLERANCE, through, _largest)
    return jnp.concatenate(maps), done


class Pieces(eqx.Module):
    """Coefficients of the equations between all nodes in turn, the interval first.

    Attributes:
        stiffness, arm, error: polynomials of the pairs.
        half: half the duration.
    """

    stiffness: Float[Array, "interval degree pair"]
    arm: Float[Array, "interval degree coordinate pair"]
    error: Float[Array, "interval degree pair"]
    half: Float[Array, " interval"]


def interval_coefficients(
    equations: Equations, course: ExcitationCourse, period: Float[Array, ""]
) -> Pieces:
    """Coefficients of all intervals; `half` is proportional to the period."""

    def in_turn(values: Float[Array, "*b element node"]) -> Float[Array, "interval degree *b"]:
        local = course.grid.local(values)
        return jnp.moveaxis(local.reshape(*local.shape[:-2], -1), -1, 0)

    half = equations.steps(course, period).ravel()
    return Pieces(
        stiffness=in_turn(equations.stiffness),
        arm=in_turn(equations.arm),
        error=in_turn(equations.error),
        half=half,
    )


def travel(
    equations: Equations,
    pieces: Pieces,
    law: ContactLaw,
    backlash: Float[Array, ""],
    start: Float[Array, " state"],
) -> tuple[Float[Array, "node state"], Float[Array, "state state"], Bool[Array, ""]]:
    """States at all nodes of a period that begins at a given state, teeth free to part.

    Args:
        equations: of the motion.
        pieces: its coefficients between the nodes.
        law: force between the teeth.
        backlash: free motion in units of stretch.
        start: displacement and velocity.

    Returns:
        States after each interval, derivative of the last one with respect to the start, and
        whether all were found.

    Source: Prince and Dormand (1981), their method of order eight, as diffrax has it; derivatives follow
    the equations of variation.
    """
    size = equations.load.shape[0]

    def interval(carry: tuple[Array, Array], piece: Pieces) -> tuple[tuple[Array, Array], Array]:
        state, fine = carry
        maps, done = _solve(
            _rate(equations, piece, law, backlash),
            (state[:size], state[size:]),
            2.0,
            TOLERANCE,
            diffrax.RecursiveCheckpointAdjoint(),
            _largest_of_last,
        )
        after = jnp.concatenate(maps)
        return (after, fine & done), after[:, -1]

    begin = identity(size, ()).at[:, -1].set(start)
    (end, fine), states = jax.lax.scan(interval, (begin, jnp.asarray(True)), pieces)
    return states, end[:, :-1], fine


def _rate(
    equations: Equations, piece: Pieces, law: ContactLaw, backlash: Float[Array, ""]
) -> Callable[[Array, tuple[Array, Array], None], tuple[Array, Array]]:
    """Right-hand side: the state in the last column, its derivatives with respect to the start."""

    def rate(time: Array, state: tuple[Array, Array], _: None) -> tuple[Array, Array]:
        place, speed = state
        stiffness, arm, error = (
            horner(value, time) for value in (piece.stiffness, piece.arm, piece.error)
        )
        stretch = arm.T @ place
        force, slope = law.function(stretch[:, -1] - error, backlash)
        column = jnp.concatenate([slope[:, None] * stretch[:, :-1], force[:, None]], axis=1)
        pushed = arm @ (stiffness[:, None] * column) + equations.damping @ speed
        return piece.half * speed, piece.half * (-pushed).at[:, -1].add(equations.load)

    return rate


def _solve(
    rate: Callable[..., tuple[Array, Array]],
    start: tuple[Array, Array],
    first: float,
    tolerance: float,
    adjoint: diffrax.AbstractAdjoint,
    norm: Callable[[tuple[Array, Array]], Array],
) -> tuple[tuple[Array, Array], Bool[Array, ""]]:
    """State at 1 from that at -1."""
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(rate),
        diffrax.Dopri8(),
        t0=-1.0,
        t1=1.0,
        dt0=first,
        y0=start,
        stepsize_controller=diffrax.PIDController(rtol=tolerance, atol=tolerance, norm=norm),
        adjoint=adjoint,
        max_steps=MOST_STEPS,
        throw=False,
    )
    assert solution.ys is not None
    place, speed = solution.ys
    return (place[0], speed[0]), solution.result == diffrax.RESULTS.successful


def _largest(error: tuple[Array, Array]) -> Array:
    # A mean over all intervals, the usual norm, would not see that one of them is wrong.
    return jnp.max(jnp.abs(jnp.stack(error)))


def _largest_of_last(error: tuple[Array, Array]) -> Array:
    # Derivatives jump where teeth part, which would take many short steps for digits that nothing needs.
    return jnp.max(jnp.abs(jnp.stack(error)[..., -1]))
