"""Pair of cylindrical gears, external or internal, spur or helical, and its contact lines."""

import dataclasses
from math import pi
from typing import Self

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.gears.rated_pair import RatedPair

__all__ = ["CylindricalPair"]

_RING_TANGENT = pi / 3.0
"""Angle between the middle of a ring's tooth and the tangents to its fillets in the critical section."""


class CylindricalPair(InvolutePair):
    """Two gears on fixed parallel axes that touch along lines, see `InvolutePair`.

    A contact line enters the plane of action at one end face and leaves at the other; a spur pair has
    one slice, a line over the whole face, unless its surfaces change across the face.
    """

    @property
    def bare(self) -> Self:
        """Without what neither circles nor roots depend on; its path of contact ends at the tip circles."""
        return dataclasses.replace(
            self,
            undercut=(False, False),
            shortened=(False, False),
            follows=(False, False),
            helical=True,
            lanes=2,
            slices=1,
            surfaces=((), ()),
        )

    @property
    def ends_at_tips(self) -> bool:
        """Undercuts end it before."""
        return not any(self.undercut)

    @property
    def rated_pair(self) -> RatedPair:
        """What standards for the strength of cylindrical gears ask."""
        line, gears = self.line, self.gears
        roots = jnp.stack([gear.root_radius for gear in gears])
        outside = jnp.asarray([False, self.internal])
        rim = jnp.where(outside, self.rim_ratio - 1.0, 1.0 - 1.0 / self.rim_ratio)
        ring = gears[1].virtual_spur_gear
        return RatedPair(
            teeth=self.teeth,
            module=self.module,
            pressure_angle=self.pressure_angle,
            helix_angle=self.helix_angle,
            base_helix_angle=self.base_helix_angle,
            transverse_pressure_angle=line.transverse_pressure_angle,
            working_pressure_angle=self.working_pressure_angle,
            profile_shift=self.profile_shift + self.infeed,
            dedendum=self.dedendum,
            fillet_radius=self.fillet_radius,
            reference_radii=jnp.stack([gear.reference_radius for gear in gears]),
            base_radii=line.base_radii,
            working_radii=line.working_radii,
            tip_radii=self.tip_radii,
            root_radii=roots,
            path_ends=line.limits,
            overlap_ratio=line.overlap_ratio,
            face_width=self.face_width,
            rim_thickness=jnp.abs(roots) * rim,
            ring_section=ring.ring_tangent(_RING_TANGENT) if self.internal else jnp.zeros(3),
            cutter=self._cutter,
        )

    @property
    def _cutter(self) -> Float[Array, "2"]:
        if self.cutter_teeth is None or self.cutter_shift is None:
            return jnp.full(2, jnp.nan)
        return jnp.stack([jnp.asarray(self.cutter_teeth), jnp.asarray(self.cutter_shift)])

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of all pairs in mesh; phase 0 is the entry of a pair at A [base pitches]."""
        line, entered = self.line, self.entered(phase)
        across, share = line.lines(entered, helical=self.helical, slices=self.slices)
        path = jnp.broadcast_to(entered, jnp.shape(across))
        if self.helical:
            path = entered - line.overlap_ratio * across
        return self.contacts_at(
            path,
            active=entered <= line.contact_ratio,
            width=self.face_width * (across - 0.5),
            weight=self.face_width * share / line.slope,
            tilt=self.base_helix_angle,
            across=jnp.zeros(2),
        )
