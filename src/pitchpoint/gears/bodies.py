"""Masses and moments of inertia of the bodies of a mesh, as discs, rings and tubes."""

from collections.abc import Iterable
from functools import singledispatch
from math import pi
from typing import Any

from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["MassInertia", "as_one", "disc", "plain_inertia"]

MassInertia = tuple[float, float]
"""Mass [kg] and moment of inertia about the axis [kg m2] of a body; not a number where one is not known."""


def disc(*, density: float, width: float, outer: float, inner: float) -> tuple[float, float]:
    """Mass [kg] and moment of inertia about its axis [kg m2] of a ring-shaped disc.

    Args:
        density: [kg/m3].
        width: along the axis [m].
        outer, inner: radii, in either order [m].

    Example:
        >>> mass, inertia = disc(density=7850.0, width=0.02, outer=0.05, inner=0.0)
        >>> round(mass, 4), round(1e4 * inertia, 3)
        (1.2331, 15.413)
    """
    mass = pi * density * width * abs(outer**2 - inner**2)
    return mass, mass * (outer**2 + inner**2) / 2.0


def as_one(bodies: Iterable[MassInertia]) -> MassInertia:
    """Mass and moment of inertia of bodies that turn as one.

    Example:
        >>> as_one([(1.0, 0.5), (2.0, 0.25)])
        (3.0, 0.75)
    """
    masses, inertias = zip(*bodies, strict=True)
    return sum(masses), sum(inertias)


@singledispatch
def plain_inertia(mesh: Any, density: Float[Array, "2"]) -> Float[Array, " dof"]:
    """Moments of inertia of plain bodies about their axes [kg m2], masses of those that travel [kg].

    Not a number where gears say nothing of one.

    Args:
        mesh: any family.
        density: of both members [kg/m3].
    """
    return jnp.full(len(mesh.coordinates), jnp.nan)
