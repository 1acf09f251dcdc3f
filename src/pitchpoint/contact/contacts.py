"""The contact type: where teeth touch and how they move there, the same for every gear family."""

from typing import Literal

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp

__all__ = ["Contacts", "Shape"]

Shape = Literal["line", "ellipse"]


class Contacts(eqx.Module):
    """Travelling contacts of one mesh, per radian of the driver so that speeds and loads broadcast over them.

    Axes: `*b` any batch (phases, designs), `pair` of teeth, `slice` along the contact line, `member`
    (the two bodies that touch), `dof` (coordinates of the bodies, rotations counter-clockwise).
    Inactive lanes hold harmless finite values; `active` masks them.

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
        shape: a line contact or an elliptic one; a line is not the limit of an ellipse.
    """

    active: Bool[Array, "*b pair slice"]
    path: Float[Array, "*b pair slice"]
    width: Float[Array, "*b pair slice"]
    weight: Float[Array, "*b pair slice"]
    curvature: Float[Array, "*b pair slice member 2"]
    surface: Float[Array, "*b pair slice member dof"]
    normal: Float[Array, "*b pair slice dof"]
    gap: Float[Array, "*b pair slice"]
    flank: Float[Array, "*b pair slice member"]
    shape: Shape = eqx.field(static=True)

    @property
    def slip_arm(self) -> Float[Array, "*b pair slice dof"]:
        """Sliding velocity of member 0 over member 1 for a unit rate of each coordinate [m/rad or 1]."""
        return self.surface[..., 0, :] - self.surface[..., 1, :]

    @property
    def roll_arm(self) -> Float[Array, "*b pair slice dof"]:
        """Sum of the two surface velocities for a unit rate of each coordinate [m/rad or 1]."""
        return self.surface[..., 0, :] + self.surface[..., 1, :]

    @property
    def relative_curvature(self) -> Float[Array, "*b pair slice 2"]:
        """Sum of the members' curvatures: second derivative of the separation [1/m]."""
        return jnp.sum(self.curvature, axis=-2)

    @property
    def radius(self) -> Float[Array, "*b pair slice"]:
        """Relative radius of curvature in the rolling direction [m]."""
        return 1.0 / self.relative_curvature[..., 0]

    def speeds(self, motion: Float[Array, " dof"]) -> Float[Array, "*b pair slice member"]:
        """Surface speeds relative to the contact for the coordinate rates `motion` [m/s for rad/s]."""
        return self.surface @ motion
