"""Pair of cylindrical gears, external or internal, spur or helical, and its contact lines."""

import dataclasses
from math import pi

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair
from pitchpoint.gears.pairs import since_entry
from pitchpoint.gears.rated_pair import (
    RatedPair,
    StandardPair,
    bare_pair,
    ends_at_tips,
    rated_pair,
    standard_pair,
)

__all__ = ["CylindricalPair"]

_RING_TANGENT = pi / 3.0
"""Angle between the middle of a ring's tooth and the tangents to its fillets in the critical section."""


class CylindricalPair(InvolutePair):
    """Two gears on fixed parallel axes that touch along lines, see `InvolutePair`.

    A contact line enters the plane of action at one end face and leaves at the other; a spur pair has
    one slice, a line over the whole face, unless its surfaces change across the face.

    Source: ISO 21771:2007, contact lines in the plane of action.
    """

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of all pairs in mesh; phase 0 is the entry of a pair at A [base pitches]."""
        line, entered = self.line, since_entry(phase, self.lanes)
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


@bare_pair.register
def _bare(pair: CylindricalPair) -> CylindricalPair:
    """Without what neither circles nor roots depend on; its path of contact ends at the tip circles."""
    return dataclasses.replace(
        pair,
        undercut=(False, False),
        shortened=(False, False),
        follows=(False, False),
        helical=True,
        lanes=2,
        slices=1,
        surfaces=((), ()),
    )


@ends_at_tips.register
def _ends_at_tips(pair: CylindricalPair) -> bool:
    """Undercuts end it before."""
    return not any(pair.undercut)


@standard_pair.register
def _standard_pair(pair: CylindricalPair) -> StandardPair | None:
    """The standard is for external gears."""
    if pair.internal:
        return None
    gears = pair.gears
    radii = jnp.abs(jnp.stack([gear.reference_radius for gear in gears]))
    return StandardPair(
        virtual_teeth=jnp.abs(jnp.stack([gear.virtual_spur_gear.teeth for gear in gears])),
        profile_shift=pair.profile_shift,
        dedendum=pair.dedendum,
        pressure_angle=pair.pressure_angle,
        helix_angle=pair.helix_angle,
        transverse_contact_ratio=pair.transverse_contact_ratio,
        face_width=pair.face_width,
        reference_radii=radii,
    )


@rated_pair.register
def _rated_pair(pair: CylindricalPair) -> RatedPair:
    """Radii, path and roots of both gears."""
    line, gears = pair.line, pair.gears
    roots = jnp.stack([gear.root_radius for gear in gears])
    outside = jnp.asarray([False, pair.internal])
    rim = jnp.where(outside, pair.rim_ratio - 1.0, 1.0 - 1.0 / pair.rim_ratio)
    ring = gears[1].virtual_spur_gear
    has_cutter = pair.cutter_teeth is not None and pair.cutter_shift is not None
    cutter = (
        jnp.stack([*map(jnp.asarray, (pair.cutter_teeth, pair.cutter_shift))])
        if has_cutter
        else None
    )
    return RatedPair(
        teeth=pair.teeth,
        module=pair.module,
        pressure_angle=pair.pressure_angle,
        helix_angle=pair.helix_angle,
        base_helix_angle=pair.base_helix_angle,
        transverse_pressure_angle=line.transverse_pressure_angle,
        working_pressure_angle=pair.working_pressure_angle,
        profile_shift=pair.profile_shift + pair.infeed,
        dedendum=pair.dedendum,
        fillet_radius=pair.fillet_radius,
        reference_radii=jnp.stack([gear.reference_radius for gear in gears]),
        base_radii=line.base_radii,
        working_radii=line.working_radii,
        tip_radii=pair.tip_radii,
        root_radii=roots,
        path_ends=line.limits,
        overlap_ratio=line.overlap_ratio,
        face_width=pair.face_width,
        rim_thickness=jnp.abs(roots) * rim,
        ring_section=ring.ring_tangent(_RING_TANGENT) if pair.internal else jnp.zeros(3),
        cutter=jnp.full(2, jnp.nan) if cutter is None else cutter,
    )
