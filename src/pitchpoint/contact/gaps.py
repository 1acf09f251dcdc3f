"""Gaps between two bodies that just touch, on the grid of a contact."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.half_space import HalfSpace
from pitchpoint.contact.surface import Spot, Surface, missing
from pitchpoint.core.factored import Arrays, Numbers

__all__ = ["elliptic_gap", "line_gap", "missing_along"]


def elliptic_gap(
    bodies: HalfSpace, radius: Numbers, transverse_radius: Numbers
) -> Float[Arrays, "y x"]:
    """Gap of two bodies with curvatures along x and y, shape (y, x) [m].

    Args:
        bodies: on their grid, which touch at x = y = 0.
        radius: relative radius along x [m].
        transverse_radius: relative radius along y [m].

    Source: Johnson, Contact Mechanics (1985), eq. 4.3.
    """
    return bodies.x**2 / (2.0 * radius) + bodies.y[:, None] ** 2 / (2.0 * transverse_radius)


def line_gap(
    bodies: HalfSpace, radius: Float[Numbers, "*#y"], relief: Float[Numbers, "*#y"]
) -> Float[Arrays, "y x"]:
    """Gap of two bodies along a contact line, shape (y, x) [m].

    Args:
        bodies: on their grid, which touch at x = 0 where there is no relief.
        radius: relative radius along x at every row, or one for all, shape (y,) or () [m].
        relief: by which the bodies lie apart at every row, shape (y,) or () [m]; see `missing_along`.

    From the parabola of the relative radius, x^2/(2 R).
    """
    gap: Arrays = bodies.x**2 / (2.0 * _column(radius)) + _column(relief)
    return gap + 0.0 * bodies.y[:, None]


def _column(values: Numbers) -> Numbers:
    column: Numbers = values[:, None] if jnp.ndim(values) else values
    return column


def missing_along(surfaces: tuple[Surface, ...], y: Float[Arrays, " y"]) -> Float[Array, " y"]:
    """Height that is missing along a contact line, which is what surfaces do across the face, shape (y,) [m].

    Args:
        surfaces: that change across the face alone, as those of `end_profiles`.
        y: places, from the middle of the face [m].
    """
    still = jnp.zeros(jnp.shape(y))
    return missing(surfaces, Spot(still, y, still, still.astype(int), still))
