"""Integration of linear equations of motion between neighbouring nodes by power series."""

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import Course
from pitchpoint.dynamics.maps import Map, compose, identity, product

__all__ = ["by_series"]

TERMS = 16
"""Terms of the series: exact to rounding up to 1 rad of vibration on either side of its middle."""

LAST = 1e-9
"""Largest last term, of states of order one."""


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

    def term(
        carry: tuple[Array, Array], at: tuple[Array, Array]
    ) -> tuple[tuple[Array, Array], Map]:
        places, speed = carry  # the latest place first, as many as the stiffness has powers
        load, scale = at[0], half / at[1]
        elastic = jnp.sum(stiffness[:, :, :, None] * places[:, None], axis=(0, 2))
        force = (elastic + product(damping, speed)).at[:, -1].add(-load)
        place, speed = scale * speed, -scale * force
        places = jnp.concatenate([place[None], places[:-1]])
        return (places, speed), jnp.concatenate([place, speed])

    before = jnp.zeros((stiffness.shape[0] - 1, size, 2 * size + 1, *half.shape))
    start = (jnp.concatenate([middle[None, :size], before]), middle[size:])
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
