"""Steady state of a mesh by integration over one period."""

from collections.abc import Callable

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS, ContactLaw
from pitchpoint.dynamics.equations import Equations, equations
from pitchpoint.dynamics.excitation import Excitation, ExcitationCourse
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.integration import interval_coefficients
from pitchpoint.dynamics.maps import Map, chain, inverse_matrix
from pitchpoint.dynamics.response import Response, response_from_states
from pitchpoint.dynamics.series import by_series
from pitchpoint.dynamics.shooting import Shot, shoot
from pitchpoint.dynamics.system import System

__all__ = ["respond_to", "resting", "scaled_start", "separating_steady_state", "steady_state"]

State = Float[Array, " state"]
Integrator = Callable[[Equations, ExcitationCourse, Float[Array, ""]], tuple[Map, Bool[Array, ""]]]


def steady_state(
    system: System,
    excitation: Excitation,
    grid: PeriodGrid | None = None,
    *,
    integrator: Integrator = by_series,
) -> Response:
    """Steady state of a mesh whose teeth never part.

    The fundamental matrix and the particular solution are integrated between all neighbouring nodes;
    hand-overs are ends of intervals. The periodic state is the solution of a linear system, so it is
    exact in one period whatever the damping, and its Floquet multipliers come with it.

    Args:
        system: mass, damping, load, period.
        excitation: stiffness, arms, errors.
        grid: static; `PeriodGrid.resolving` the ratio of natural and mesh frequency.
        integrator: `by_series`, differentiable in both modes, or `by_steps`, which is diffrax with an
            explicit method of order eight, in reverse unless it is given another adjoint.

    Returns:
        The response; its status says where teeth would separate or the state cannot be reached. The
        numbers of an unstable solution are those of the balance that is not reached.

    From z(T) = z(0): (1 - monodromy) z(0) is the state reached from rest.
    """
    course = excitation.on(grid or PeriodGrid())
    scaled = equations(system, course)
    maps, resolved = integrator(scaled, course, system.period)
    linked = chain(maps)
    monodromy, reached = linked.period
    # Marching would take as many periods as the damping needs, and would not find what is unstable.
    start = inverse_matrix(jnp.eye(monodromy.shape[0]) - monodromy) @ reached
    residual = _distance(monodromy @ start + reached, start)
    return response_from_states(
        course,
        scaled,
        CONTACT_LAWS["linear"],
        jnp.asarray(jnp.inf),
        linked.states(start),
        monodromy,
        residual,
        residual < 1e-6,
        resolved,
    )


def separating_steady_state(
    system: System,
    excitation: Excitation,
    grid: PeriodGrid | None = None,
    *,
    law: ContactLaw | None = None,
    backlash: Float[Array, ""] | float = jnp.inf,
    start: State | None = None,
) -> Response:
    """Steady state that a mesh reaches from a given state, teeth free to part.

    Newton's method on the state at the start of the period, with the derivatives of the period's end
    integrated beside it; where that finds nothing stable, the motion marches from the state. It is
    not differentiable in reverse.

    Args:
        system: mass, damping, load, period.
        excitation: stiffness, arms, errors.
        grid: static; forces bend where teeth part, so take more elements than without.
        law: of the contact, `CONTACT_LAWS["separating"]` if None.
        backlash: free motion along the normal [m]; infinite if back flanks never meet.
        start: displacement and velocity [m, m/s]; at rest in the mean balance if None.

    Returns:
        The response; not a number where no stable motion with the period of the mesh was found.

    Source: Nayfeh and Balachandran (1995), chapter 6, shooting.
    """
    law = law or CONTACT_LAWS["separating"]
    course = excitation.on(grid or PeriodGrid())
    scaled = equations(system, course)
    begin = resting(scaled, course) if start is None else scaled_start(scaled, start)
    intervals = interval_coefficients(scaled, course, system.period)
    shot = shoot(scaled, intervals, law, jnp.asarray(backlash) / scaled.unit, begin)
    return respond_to(shot, course, scaled, law, jnp.asarray(backlash))


def respond_to(
    shot: Shot,
    course: ExcitationCourse,
    scaled: Equations,
    law: ContactLaw,
    backlash: Float[Array, ""],
) -> Response:
    """Response of the motion that a search found."""
    states = shot.nodes(course.length.shape[0])
    orbit = states, shot.monodromy, shot.residual, shot.found
    return response_from_states(
        course, scaled, law, backlash, *orbit, iterations=shot.marched + shot.tries
    )


def resting(scaled: Equations, course: ExcitationCourse) -> State:
    """Balance with the mean stiffness, at rest.

    From k z = f with the mean stiffness.
    """
    stiffness, load = course.mean(scaled.total_stiffness), course.mean(scaled.total_load)
    place = jnp.linalg.solve(stiffness, load)
    return jnp.concatenate([jnp.where(scaled.finite, place, 0.0), jnp.zeros_like(place)])


def scaled_start(scaled: Equations, start: State) -> State:
    """Displacement and velocity without dimensions."""
    size = scaled.load.shape[0]
    to_scaled = jnp.linalg.inv(scaled.scale)
    return jnp.concatenate([to_scaled @ start[:size], to_scaled @ start[size:] / scaled.frequency])


def _distance(end: State, start: State) -> Float[Array, ""]:
    return jnp.max(jnp.abs(end - start)) / (1.0 + jnp.max(jnp.abs(start)))
