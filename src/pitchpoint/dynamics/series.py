"""Integration of linear equations of motion between neighbouring nodes by power series."""

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import ExcitationCourse
from pitchpoint.dynamics.maps import Map, compose, identity, inverse_matrix, matrix_product, on_last

__all__ = ["by_series"]

TERMS = 13
"""Terms of the series: exact to 1e-13 up to 0.7 rad of vibration on either side of its middle, the
most that `PeriodGrid.resolving` leaves."""

LAST = 1e-9
"""Largest last term, of states of order one."""

Carry = tuple[tuple[Array, ...], Array, tuple[Map, Map]]
"""Latest places first, as many as the stiffness has powers; the latest speed; sums of every other
term, those with the latest one first."""


def by_series(
    equations: Equations, course: ExcitationCourse, period: Float[Array, ""]
) -> tuple[Float[Array, "state state+1 element interval"], Bool[Array, ""]]:
    """Affine maps of the state from each node to the next, for teeth that never part.

    Between neighbouring nodes stiffness and load are polynomials, and the coefficients of the motion
    follow from them by recursion. With the state in the middle given, the series gives that at both
    ends, so it has to reach half the length only. Without steps to choose it is faster than `by_steps`,
    more exact, and differentiable both ways.

    Args:
        equations: of the motion.
        course: excitation at the nodes.
        period: of the mesh [s].

    Returns:
        Fundamental matrices and, last, the states reached from rest; whether the last terms are small.

    From equal powers of time on both sides of z'' + C z' + K z = f.
    """
    grid = course.grid
    stiffness, load, half = (
        values.reshape(*values.shape[:-2], -1)  # one long row is quicker than many short ones
        for values in (
            grid.local(equations.total_stiffness, grid.stiffness_degree),
            grid.local(equations.total_load),
            equations.steps(course, period),
        )
    )
    load = jnp.concatenate([load, jnp.zeros((TERMS - load.shape[0], *load.shape[1:]))])
    damping = equations.damping[:, :, None]
    size = equations.load.shape[0]
    middle = identity(size, half.shape)

    def term(carry: Carry, at: tuple[Array, Array]) -> tuple[Carry, None]:
        places, speed, (extended, waiting) = carry
        scale = half / at[1]
        force = matrix_product(damping, speed) - on_last(at[0], 2 * size + 1)
        # A product of two series: as many earlier places count as the stiffness has powers.
        for power, before in zip(stiffness, places, strict=True):
            force = force + matrix_product(power, before)
        place, speed = scale * speed, -scale * force
        new_term = jnp.concatenate([place, speed])
        return ((place, *places[:-1]), speed, (waiting + new_term, extended)), None

    none = jnp.zeros_like(middle)
    places = (middle[:size], *(none[:size] for _ in stiffness[1:]))
    start = (places, middle[size:], (middle, none))
    (places, speed, sums), _ = jax.lax.scan(term, start, (load, jnp.arange(1.0, TERMS + 1.0)))
    # Even terms are alike at both ends and odd ones opposite, so two sums give the state at either end.
    odd, even = sums if TERMS % 2 else sums[::-1]
    maps = compose(even + odd, _inverse(even - odd))
    last_term = jnp.maximum(jnp.max(jnp.abs(places[0])), jnp.max(jnp.abs(speed)))
    return maps.reshape(*maps.shape[:2], *course.length.shape, -1), last_term < LAST


def _inverse(ahead: Map) -> Map:
    """The affine map that undoes another."""
    matrix = inverse_matrix(ahead[:, :-1])
    return jnp.concatenate([matrix, -matrix_product(matrix, ahead[:, -1:])], axis=1)
