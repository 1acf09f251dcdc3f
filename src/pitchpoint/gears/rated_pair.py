"""What the standards for the strength of cylindrical gears ask about a pair."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["RatedPair"]


class RatedPair(eqx.Module):
    """Dimensions of a pair of cylindrical gears; number of teeth and radii of a ring are negative.

    Attributes:
        teeth: z.
        module: normal module m_n [m].
        pressure_angle: normal one of the basic racks [rad].
        helix_angle: on the reference cylinders [rad].
        base_helix_angle: on the base cylinders [rad].
        transverse_pressure_angle, working_pressure_angle: alpha_t and alpha_wt [rad].
        profile_shift: coefficients x.
        dedendum, fillet_radius: of the basic racks, in normal modules.
        reference_radii, base_radii, working_radii, tip_radii, root_radii: [m].
        path_ends: A and E on the line of action, from N1; where an undercut takes the flank away, there [m].
        overlap_ratio: eps_beta.
        face_width: common to both [m].
        rim_thickness: from the root circle to the bore, or to the outside of a ring [m].
        ring_section: half chord, distance from the axis and radius of the fillet of a ring where tangents to
            it make 60 degrees with the middle of a tooth, in the normal section [m]; zeros without a ring.
        cutter: teeth z_0 and profile shift x_0 of the pinion cutter of a ring; not numbers without one.
    """

    teeth: Float[Array, "2"]
    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    helix_angle: Float[Array, ""]
    base_helix_angle: Float[Array, ""]
    transverse_pressure_angle: Float[Array, ""]
    working_pressure_angle: Float[Array, ""]
    profile_shift: Float[Array, "2"]
    dedendum: Float[Array, "2"]
    fillet_radius: Float[Array, "2"]
    reference_radii: Float[Array, "2"]
    base_radii: Float[Array, "2"]
    working_radii: Float[Array, "2"]
    tip_radii: Float[Array, "2"]
    root_radii: Float[Array, "2"]
    path_ends: Float[Array, "2"]
    overlap_ratio: Float[Array, ""]
    face_width: Float[Array, ""]
    rim_thickness: Float[Array, "2"]
    ring_section: Float[Array, "3"]
    cutter: Float[Array, "2"]

    @property
    def transverse_contact_ratio(self) -> Float[Array, ""]:
        """Transverse contact ratio eps_alpha, of the path as it ends."""
        base_pitch = 2.0 * jnp.pi * self.base_radii[0] / self.teeth[0]
        return (self.path_ends[1] - self.path_ends[0]) / base_pitch

    @property
    def end_slopes(self) -> Float[Array, "2"]:
        """sqrt((d/d_b)^2 - 1) of both gears where their path of contact ends nearest to the tip."""
        tangent_length = jnp.sum(self.base_radii) * jnp.tan(self.working_pressure_angle)
        start, end = self.path_ends
        return jnp.stack([end, tangent_length - start]) / self.base_radii

    @property
    def end_radii(self) -> Float[Array, "2"]:
        """Radii there [m]; those of the tips unless the mate is undercut."""
        return self.base_radii * jnp.sqrt(1.0 + self.end_slopes**2)
