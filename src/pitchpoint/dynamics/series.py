"""Integration of linear equations of motion between neighbouring nodes by power series."""

from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.dynamics.equations import Equations
from pitchpoint.dynamics.excitation import Course
from pitchpoint.dynamics.maps import Map, compose, identity, product

__all__ = ["by_series"]

TERMS = 16
"""Terms of the series: exact to rounding up to 1 rad of vibration on either side of its centre."""

LAST = 1e-9
"""Largest last term, of states of order one."""


def by_series(
    equations: Equations, course: Course, period: Float[Array, ""]
) -> tuple[Float[Array, "state state+1 element interval"], Bool[Array, ""]]:
    """Affine maps of the state from each node to the next, for teeth that never part.

    Between neighbouring nodes stiffness and load are polynomials, and the coefficients of the motion
    follow from them by recursion. With the state in the middle given, the series gives that at both
    ends; so it needs half the length. It has no steps and no loop: three times as fast as `by_steps`
    at an error below its own, and differentiable both ways.

    Args:
        equations: of the motion.
        course: excitation at the nodes.
        period: of the mesh [s].

    Returns:
        Fundamental matrices and, last, the states reached from rest; whether the last terms are small.
    """
    stiffness = course.grid.local(equations.total_stiffness)
    load = course.grid.local(equations.total_load)
    damping = equations.damping[:, :, None, None]
    half = equations.steps(course, period)
    size = equations.load.shape[0]
    middle = identity(size, half.shape)
    places, speeds = [middle[:size]], [middle[size:]]
    for k in range(TERMS):
        force = product(damping, speeds[k])
        for j in range(min(k + 1, stiffness.shape[0])):
            force = force + product(stiffness[j], places[k - j])
        if k < load.shape[0]:
            force = force.at[:, -1].add(-load[k])
        places.append(half / (k + 1.0) * speeds[k])
        speeds.append(-half / (k + 1.0) * force)
    terms = [jnp.concatenate(pair) for pair in zip(places, speeds, strict=True)]
    even, odd = sum(terms[2::2], terms[0]), sum(terms[3::2], terms[1])
    last = jnp.max(jnp.abs(terms[-1]))
    return compose(even + odd, _inverse(even - odd)), last < LAST


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
    return jnp.stack([jnp.stack([d, -b]), jnp.stack([-c, a])]) / (a * d - b * c)
