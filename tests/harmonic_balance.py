"""Steady state of a mesh by harmonic balance: linear, and independent of any integration."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Complex, Float

from pitchpoint._jax import jnp
from pitchpoint.core.status import Code
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.equations import Equations, equations
from pitchpoint.dynamics.excitation import Excitation, ExcitationCourse
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.response import Response, response_from_states
from pitchpoint.dynamics.system import System

__all__ = ["harmonic_balance"]

Coefficients = Complex[Array, "harmonic coordinate"]


def harmonic_balance(
    system: System, excitation: Excitation, harmonics: int, grid: PeriodGrid | None = None
) -> Response:
    """Steady state of a mesh whose teeth never part, as a sum of harmonics of the mesh frequency.

    The motion converges as 1/H^3 where the stiffness jumps, the dynamic factor, which jumps with it,
    only as 1/H near the hand-overs (Gibbs). Stability is not known to this method: the multipliers
    are not a number, and the residual is that of the linear solve.

    Args:
        system: mass, damping, load, period.
        excitation: stiffness, arms, errors.
        harmonics: H, static; a few times the ratio of natural and mesh frequency.
        grid: where the response is wanted; by default one that resolves all harmonics.

    Returns:
        The response, in the same form as that of `steady_state`.

    Source: Nayfeh and Mook (1979), section 2.3.4; here of a linear system with periodic stiffness.
    """
    course = excitation.on(grid or PeriodGrid.resolving(harmonics))
    scaled = equations(system, course)
    orders = np.arange(-harmonics, harmonics + 1)
    matrix, load = _balance(scaled, course, system.period, orders)
    found = jnp.linalg.solve(matrix, load)
    residual = jnp.max(jnp.abs(matrix @ found - load)) / (1.0 + jnp.max(jnp.abs(load)))
    coefficients = found.reshape(orders.size, -1)
    states = _states(coefficients, course, orders, scaled.frequency * system.period)
    size = 2 * scaled.load.shape[0]
    response: Response = response_from_states(
        course,
        scaled,
        CONTACT_LAWS["linear"],
        jnp.asarray(jnp.inf),
        states,
        jnp.zeros((size, size)),
        residual,
        residual < 1e-8,
    )
    unknown = jnp.full_like(response.multipliers, jnp.nan)
    code = response.status.code
    code = jnp.where(code == int(Code.SOLVED), int(Code.STABILITY_UNKNOWN), code)
    known: Response = eqx.tree_at(
        lambda r: (r.multipliers, r.status.code), response, (unknown, code)
    )
    return known


def _balance(
    equations: Equations, course: ExcitationCourse, period: Float[Array, ""], orders: np.ndarray
) -> tuple[Complex[Array, "unknown unknown"], Complex[Array, " unknown"]]:
    """Equations of the coefficients, harmonics outside, coordinates inside."""
    size = equations.load.shape[0]
    # A block depends on the difference of its two orders alone: each is transformed once.
    difference = orders[:, None] - orders
    span = np.arange(difference.min(), difference.max() + 1)
    fourier = course.grid.fourier
    stiffness = fourier(equations.total_stiffness, course.bounds, span)[difference - span[0]]
    load = fourier(equations.total_load, course.bounds, orders)
    rate = 2j * jnp.pi * orders / jnp.where(equations.finite, equations.frequency * period, 1.0)
    own = rate[:, None, None] ** 2 * jnp.eye(size) + rate[:, None, None] * equations.damping
    blocks = stiffness + jnp.eye(orders.size)[:, :, None, None] * own
    matrix = jnp.moveaxis(blocks, 1, 2).reshape(orders.size * size, -1)
    # Without finite inputs the matrix is singular; the status tells it, not a solve that fails.
    return jnp.where(equations.finite, matrix, jnp.eye(orders.size * size)), load.ravel()


def _states(
    coefficients: Coefficients,
    course: ExcitationCourse,
    orders: np.ndarray,
    duration: Float[Array, ""],
) -> Float[Array, "state element node"]:
    """Displacement and velocity at the nodes."""
    harmonic = jnp.exp(2j * jnp.pi * orders[:, None, None] * course.phase)
    rate = 2j * jnp.pi * orders[:, None] / duration
    both = jnp.concatenate([coefficients, rate * coefficients], axis=1)
    return jnp.einsum("hs,hen->sen", both, harmonic).real
