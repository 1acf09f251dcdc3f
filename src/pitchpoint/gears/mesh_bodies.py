"""Bodies of a mesh: dimensions for tables and a drawing, masses and moments of inertia of discs and rings.

Gears that have dimensions register them here.
"""

from collections.abc import Iterable
from functools import singledispatch
from math import pi
from typing import Any

from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = [
    "MassInertia",
    "combined_inertia",
    "completed",
    "disc",
    "drawing",
    "independent",
    "main_dimensions",
    "plain_inertia",
]

MassInertia = tuple[float, float]
"""Mass [kg] and moment of inertia about the axis [kg m2] of a body; not a number where one is not known."""


def disc(*, density: float, width: float, outer: float, inner: float) -> tuple[float, float]:
    """Mass [kg] and moment of inertia about its axis [kg m2] of a ring-shaped disc.

    Args:
        density: [kg/m3].
        width: along the axis [m].
        outer, inner: radii, in either order [m].

    From the integral of r^2 over the mass of a ring, J = m (r_o^2 + r_i^2)/2.

    Example:
        >>> mass, inertia = disc(density=7850.0, width=0.02, outer=0.05, inner=0.0)
        >>> round(mass, 4), round(1e4 * inertia, 3)
        (1.2331, 15.413)
    """
    mass = pi * density * width * abs(outer**2 - inner**2)
    return mass, mass * (outer**2 + inner**2) / 2.0


def combined_inertia(bodies: Iterable[MassInertia]) -> MassInertia:
    """Mass and moment of inertia of bodies that turn as one.

    From the sum over bodies on one axis.

    Example:
        >>> combined_inertia([(1.0, 0.5), (2.0, 0.25)])
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


@singledispatch
def main_dimensions(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """Main dimensions by name [SI], one value or one for each member; for results and tables."""
    return {}


@singledispatch
def drawing(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """What a drawing of the teeth to scale needs [SI], see `Family.drawing`; empty where there is none."""
    return {}


@singledispatch
def independent(mesh: Any) -> tuple[str, ...]:
    """Fields of a mesh whose numbers are chosen one by one; what follows from them is `completed`."""
    return ()


@singledispatch
def completed(mesh: Any) -> Any:
    """The same mesh with dimensions that follow from others computed from them again.

    Derivatives with respect to one dimension then see what follows from it.
    """
    return mesh
