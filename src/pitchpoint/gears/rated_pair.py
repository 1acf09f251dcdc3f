"""What standards ask about a pair of cylindrical gears; whose gears have it registers it here."""

from functools import singledispatch
from typing import Any

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["RatedPair", "StandardPair", "bare_pair", "ends_at_tips", "rated_pair", "standard_pair"]


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

    Source: ISO 21771:2007, symbols, and negative numbers of teeth of internal gears.
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


class StandardPair(eqx.Module):
    """What the standard for the stiffness of cylindrical gears asks about a pair.

    Attributes:
        virtual_teeth: z_n of the normal sections, in magnitude.
        profile_shift: coefficients.
        dedendum: of the basic racks, in normal modules.
        pressure_angle: normal one of the basic racks [rad].
        helix_angle: [rad].
        transverse_contact_ratio: eps_alpha.
        face_width: [m].
        reference_radii: of the reference circles, positive [m].

    Source: ISO 6336-1:2006, method B, see `iso_6336_stiffness`.
    """

    virtual_teeth: Float[Array, "2"]
    profile_shift: Float[Array, "2"]
    dedendum: Float[Array, "2"]
    pressure_angle: Float[Array, ""]
    helix_angle: Float[Array, ""]
    transverse_contact_ratio: Float[Array, ""]
    face_width: Float[Array, ""]
    reference_radii: Float[Array, "2"]


@singledispatch
def standard_pair(mesh: Any) -> StandardPair | None:
    """What the standard for stiffness asks about a mesh; None where it does not apply."""
    return None


@singledispatch
def rated_pair(mesh: Any) -> RatedPair:
    """What the standards for strength ask about a mesh, see `GearsTable.rated`.

    Raises:
        TypeError: they do not apply to its gears.
    """
    raise TypeError(f"{type(mesh).__name__} has no teeth that a standard rates")


@singledispatch
def bare_pair(mesh: Any) -> Any:
    """The same gears with their dimensions alone, so that many share a program that asks no more."""
    return mesh


@singledispatch
def ends_at_tips(mesh: Any) -> bool:
    """True if contact ends at tip circles, so that a bare mesh has the path of this one."""
    return True
