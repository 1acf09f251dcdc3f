"""The contact type: where teeth touch and how they move there, the same for every gear family."""

from collections.abc import Mapping
from typing import Literal

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays

__all__ = ["KINDS", "TOUCH", "Contacts", "Shape", "contact_velocity", "total"]

Shape = Literal["line", "ellipse"]

KINDS: Mapping[Shape, str] = {"line": "line contacts", "ellipse": "elliptic contacts"}
"""Contacts of a shape in words."""

TOUCH: Mapping[Shape, str] = {"line": "along lines", "ellipse": "in an ellipse"}
"""How flanks of a shape touch, in words."""


class Contacts(eqx.Module):
    """Travelling contacts of one mesh, per radian of the driver: speeds and loads broadcast over them.

    Axes: `member` (the two bodies that touch), `dof` (coordinates of the bodies, rotations
    counter-clockwise), `pair` of teeth, `slice` along the contact line, and last `*b`, any batch
    (phases). With the batch last, values of the whole mesh broadcast over the contacts as they are,
    and sums over contacts run along long rows. Inactive lanes hold harmless finite values; `active`
    masks them.

    Attributes:
        active: True where the pair touches.
        path: position from the start of contact [base pitches, circular pitches or turns].
        width: position across the face [m].
        weight: length of contact line that the slice stands for [m].
        curvature: signed curvature of each member in rolling and transverse direction [1/m].
        surface: velocity of each member's surface along the tangent, relative to the moving contact,
            for a unit rate of each coordinate [m/rad or 1]. Speeds, sliding and their arms follow from it.
        normal: closing velocity along the normal for a unit rate of each coordinate [m/rad or 1].
        gap: separation of the unloaded flanks [m]; zero where rigid teeth touch.
        flank: arc length on each profile [m], growing along the path on one member and falling on the other
            or growing on both, as they roll.
        point: where it lies in the frame of the mesh [m].
        direction: unit normal there, out of member 0 towards member 1: the force on member 1 acts along it.
        tangent: unit vector along which `surface` counts, at right angles to the normal and to a contact
            line.
        felt: relative curvature in the rolling direction that a contact feels over its width, where that at
            the point jumps on its way [1/m]; None where it is that at the point.
        shape: a line contact or an elliptic one; a line is not the limit of an ellipse.
    """

    active: Bool[Array, "pair slice *b"]
    path: Float[Array, "pair slice *b"]
    width: Float[Array, "pair slice *b"]
    weight: Float[Array, "pair slice *b"]
    curvature: Float[Array, "member 2 pair slice *b"]
    surface: Float[Array, "member dof pair slice *b"]
    normal: Float[Array, "dof pair slice *b"]
    gap: Float[Array, "pair slice *b"]
    flank: Float[Array, "member pair slice *b"]
    point: Float[Array, "3 pair slice *b"]
    direction: Float[Array, "3 pair slice *b"]
    tangent: Float[Array, "3 pair slice *b"]
    shape: Shape = eqx.field(static=True)
    felt: Float[Array, "pair slice *b"] | None = None

    @property
    def slip_arm(self) -> Float[Arrays, "dof pair slice *b"]:
        """Sliding velocity of member 0 over member 1 for a unit rate of each coordinate [m/rad or 1].

        Source: Johnson, Contact Mechanics (1985), section 1.2, sliding.
        """
        return self.surface[0] - self.surface[1]

    @property
    def roll_arm(self) -> Float[Arrays, "dof pair slice *b"]:
        """Sum of the two surface velocities for a unit rate of each coordinate [m/rad or 1].

        Source: Johnson, Contact Mechanics (1985), section 1.2, rolling.
        """
        return self.surface[0] + self.surface[1]

    @property
    def relative_curvature(self) -> Float[Arrays, "2 pair slice *b"]:
        """Sum of the members' curvatures: second derivative of the separation [1/m].

        Source: Johnson, Contact Mechanics (1985), section 4.1.
        """
        return self.curvature[0] + self.curvature[1]

    @property
    def radius(self) -> Float[Arrays, "pair slice *b"]:
        """Relative radius of curvature in the rolling direction [m], as the contact feels it."""
        return 1.0 / (self.relative_curvature[0] if self.felt is None else self.felt)


def contact_velocity(
    arms: Float[Arrays, "dof *b"], rates: Float[Arrays, "dof ..."]
) -> Float[Arrays, "*b"]:
    """Velocity at each contact for given rates of the coordinates: sum of arms times rates."""
    return sum((rates[k] * arms[k] for k in range(1, arms.shape[0])), rates[0] * arms[0])


def total(values: Float[Arrays, "pair slice *b"]) -> Float[Array, "*b"]:
    """Sum over all contacts of a mesh."""
    return jnp.sum(values, axis=(0, 1))
