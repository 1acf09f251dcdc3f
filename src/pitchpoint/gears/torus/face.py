"""Faces of torus-involute gears: how the profile shift varies across them."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.core.roots import find_root

__all__ = ["TorusFace", "nearest_across_face"]

_FARTHEST = 0.9
"""Part of the smaller radius beyond which no place is looked for: no face is that wide."""

Place = Float[Numbers, "..."]


class TorusFace(eqx.Module):
    """Face of a gear whose pitch surface is a torus: its axial section is an arc.

    Attributes:
        radius: of the arc; positive where the gear is convex, negative where it is concave [m].
        pressure_angle: of the basic rack [rad].

    Source: Liu and Xiong (`liu_xiong_2017`), section 2: profile shift
    of the second order across the face.
    """

    radius: Float[Array, ""]
    pressure_angle: Float[Array, ""]

    def shift(self, across: Place) -> Place:
        """Profile shift times the module at a place across the face, over that in the middle [m].

        Args:
            across: from the middle plane, less than the radius [m].
        """
        return -(across**2) / (self.radius + jnp.sign(self.radius) * self._rest(across))

    def missing(self, across: Place) -> Place:
        """Height missing from the flank along its normal, against that of the middle [m].

        Args:
            across: from the middle plane [m].

        From the base tangent, along which a shift moves an involute by its sine of the pressure angle.
        """
        return -jnp.sin(self.pressure_angle) * self.shift(across)

    def slope(self, across: Place) -> Place:
        """How the missing height grows across the face [1]."""
        return jnp.sin(self.pressure_angle) * jnp.sign(self.radius) * across / self._rest(across)

    def curvature(self, across: Place) -> Place:
        """Curvature of the flank across the face, negative where it is concave [1/m]."""
        cubed = jnp.sign(self.radius) * self._rest(across) ** 3
        return jnp.sin(self.pressure_angle) * self.radius**2 / cubed

    def _rest(self, across: Place) -> Place:
        """Height of the arc over its centre [m]."""
        return jnp.sqrt(self.radius**2 - across**2)


@eqx.filter_jit
def nearest_across_face(
    first: TorusFace,
    second: TorusFace,
    *,
    axial_offset: Float[Array, ""],
    inclination: Float[Array, ""],
) -> tuple[Float[Array, ""], Float[Array, ""]]:
    """Where across the face two flanks are nearest to each other, and how far they are apart there.

    Args:
        first, second: faces of which the convex one has the smaller radius.
        axial_offset: of the middle plane of the second from that of the first [m].
        inclination: angle by which the flanks part along the face, in the plane of action [rad].

    Returns:
        Place from the middle plane of the first [m], and the separation [m]: not positive, what the gears
        come nearer to each other than without misalignment. The last step carries derivatives.

    For small angles z = -(gamma + d/R_y2) R_y with 1/R_y = sin(alpha) (1/R_1 + 1/R_2).
    """
    farthest = _FARTHEST * jnp.minimum(jnp.abs(first.radius), jnp.abs(second.radius))

    def parting(way: Float[Array, ""]) -> Float[Array, ""]:
        at = way - farthest
        return first.slope(at) + second.slope(at - axial_offset) + inclination

    at = find_root(parting, farthest, 2.0 * farthest)[0] - farthest
    return at, first.missing(at) + second.missing(at - axial_offset) + inclination * at
