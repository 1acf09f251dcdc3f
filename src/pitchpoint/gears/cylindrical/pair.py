"""Pair of cylindrical gears, external or internal, spur or helical, and its contact lines."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.gears.cylindrical.involute_pair import InvolutePair

__all__ = ["CylindricalPair"]


class CylindricalPair(InvolutePair):
    """Two gears on fixed parallel axes that touch along lines, see `InvolutePair`.

    A contact line enters the plane of action at one end face and leaves at the other; a spur pair has
    one slice, a line over the whole face, unless its surfaces change across the face.
    """

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
