"""A thin ring that carries the teeth of one member, and how tooth forces act on it."""

import equinox as eqx
from jaxtyping import Array, Float

__all__ = ["FlexibleRing", "RingLoads"]


class FlexibleRing(eqx.Module):
    """Rim of a flexspline, held round by the bearing inside it and against turning by its cup.

    Attributes:
        radius: of the neutral line [m].
        thickness: of the rim, without teeth [m].
        width: of the toothed ring along the axis [m].
        wall_thickness: of the cup [m].
        cup_length: from the toothed ring to the flange [m].
        support_stiffness: radial force that the bearing inside bears for one metre of approach and
            one metre of the ring's circumference [N/m2]; infinite for a rigid one.
    """

    radius: Float[Array, ""]
    thickness: Float[Array, ""]
    width: Float[Array, ""]
    wall_thickness: Float[Array, ""]
    cup_length: Float[Array, ""]
    support_stiffness: Float[Array, ""]


class RingLoads(eqx.Module):
    """Where contacts act on a ring, and the components of a unit normal force on its tooth there.

    Attributes:
        angle: of each contact around the ring [rad].
        tangential: component in the sense in which the angle grows.
        radial: outward component; teeth press their ring inwards, so it is negative.
        height: of the contact above the neutral line [m].
    """

    angle: Float[Array, "pair slice *#b"]
    tangential: Float[Array, "pair slice *#b"]
    radial: Float[Array, "pair slice *#b"]
    height: Float[Array, "pair slice *#b"]
