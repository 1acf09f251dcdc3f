"""Steady states along a list of speeds, each continued from the one before."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS, ContactLaw
from pitchpoint.dynamics.equations import equations
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.integration import interval_coefficients
from pitchpoint.dynamics.response import Response
from pitchpoint.dynamics.shooting import shoot
from pitchpoint.dynamics.steady_state import respond_to, resting, scaled_start
from pitchpoint.dynamics.system import System

__all__ = ["speed_sweep"]


def speed_sweep(
    system: System,
    excitation: Excitation,
    periods: Float[Array, " speed"],
    grid: PeriodGrid | None = None,
    *,
    law: ContactLaw | None = None,
    backlash: Float[Array, ""] | float = jnp.inf,
    start: Float[Array, " state"] | None = None,
) -> Response:
    """Steady states at speeds in the given order, rising or falling.

    Each begins from the state of the one before, so that a branch is followed for as long as it is
    stable; a gear system whose teeth part softens, and the rising and the falling branch then differ
    between two jumps. Designs and loads batch by `jax.vmap`.

    Args:
        system: mass, damping, load; its period is not used.
        excitation: stiffness, arms, errors.
        periods: of the mesh at each speed [s].
        grid: static; must resolve the slowest speed.
        law: of the contact, teeth that part by default.
        backlash: free motion along the normal [m]; infinite if back flanks never meet.
        start: displacement and velocity before the first speed; at rest in the mean balance if None.

    Returns:
        Responses, the speed as first axis of every array.

    Source: Nayfeh and Balachandran (1995), chapter 6, sequential continuation.
    """
    law = law or CONTACT_LAWS["separating"]
    course = excitation.on(grid or PeriodGrid())
    scaled = equations(system, course)
    unit = interval_coefficients(scaled, course, jnp.asarray(1.0))
    free = jnp.asarray(backlash) / scaled.unit

    def at(
        state: Float[Array, " state"], period: Float[Array, ""]
    ) -> tuple[Float[Array, " state"], Response]:
        intervals = eqx.tree_at(lambda p: p.half, unit, unit.half * period)
        shot = shoot(scaled, intervals, law, free, state)
        response = respond_to(shot, course, scaled, law, jnp.asarray(backlash))
        return jnp.where(shot.found, shot.start, _finite(shot.end, state)), response

    begin = resting(scaled, course) if start is None else scaled_start(scaled, start)
    _, responses = jax.lax.scan(at, begin, periods)
    return responses


def _finite(
    values: Float[Array, " state"], other: Float[Array, " state"]
) -> Float[Array, " state"]:
    return jnp.where(jnp.all(jnp.isfinite(values)), values, other)
