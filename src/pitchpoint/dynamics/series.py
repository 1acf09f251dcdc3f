"""Integration of linear equations of motion between neighbouring nodes by power series."""

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import Course
from pitchpoint.dynamics.maps import Map, compose, identity, on_last, product

__all__ = ["by_series"]

TERMS = 16
"""Terms of the series: exact to rounding up to 1 rad of vibration on either side of its middle."""

LAST = 1e-9
"""Largest last term, of states of order one."""

Carry = tuple[tuple[Array, ...], Array]
"""Latest places first, as many as the stiffness has powers; and the latest speed."""


def by_series(
    equations: Equations, course: Course, period: Float[Array, ""]
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
    """
    stiffness = course.grid.local(equations.total_stiffness)
    load = course.grid.local(equations.total_load)
    load = jnp.concatenate([load, jnp.zeros((TERMS - load.shape[0], *load.shape[1:]))])
    damping = equations.damping[:, :, None, None]
    half = equations.steps(course, period)
    size = equations.load.shape[0]
    middle = identity(size, half.shape)

    def term(carry: Carry, at: tuple[Array, Array]) -> tuple[Carry, Map]:
        places, speed = carry
        scale = half / at[1]
        force = product(damping, speed) - on_last(at[0], 2 * size + 1)
        for power, before in zip(stiffness, places, strict=True):
            force = force + product(power, before)
        place, speed = scale * speed, -scale * force
        return ((place, *places[:-1]), speed), jnp.concatenate([place, speed])

    none = jnp.zeros_like(middle[:size])
    start = ((middle[:size], *(none for _ in stiffness[1:])), middle[size:])
    _, terms = jax.lax.scan(term, start, (load, jnp.arange(1.0, TERMS + 1.0)))
    odd, even = jnp.sum(terms[::2], axis=0), middle + jnp.sum(terms[1::2], axis=0)
    return compose(even + odd, _inverse(even - odd)), jnp.max(jnp.abs(terms[-1])) < LAST


def _inverse(ahead: Map) -> Map:
    """The affine map that undoes another."""
    matrix = _inverse_matrix(ahead[:, :-1])
    return jnp.concatenate([matrix, -product(matrix, ahead[:, -1:])], axis=1)


def _inverse_matrix(matrix: Float[Array, "state state *b"]) -> Float[Array, "state state *b"]:
    """Inverse with the batch last, in closed form for a single coordinate."""
    if matrix.shape[0] > 2:
        inverse: Array = jnp.linalg.inv(jnp.moveaxis(matrix, (0, 1), (-2, -1)))
        return jnp.moveaxis(inverse, (-2, -1), (0, 1))
    (a, b), (c, d) = matrix
    adjugate = jnp.stack([jnp.stack([d, -b]), jnp.stack([-c, a])])
    return jnp.divide(adjugate, a * d - b * c)
