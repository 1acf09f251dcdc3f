"""Deviations by which the teeth of a gear differ from each other."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.surface import Lanes, Spot, Surface

__all__ = ["ToothDeviations"]


class ToothDeviations(Surface):
    """Pitch, slope and form of the flank of every tooth of one member.

    Slopes and forms are counted over the whole profile and the whole face, slopes from their middle;
    a form is one wave over that length.

    Attributes:
        pitch: how far each flank lies behind its place, along the normal [m].
        profile_slope, lead_slope: rise of the missing height over profile and face [m].
        profile_form, lead_form: height of the wave from trough to crest, of either sign [m].
        root, tip: arc lengths on the flank between which the profile is counted [m].
        width: of the face [m].

    Source: ISO 1328-1:2013, deviations of pitch, and of slope and form of profile and helix; that a form
    is one wave is a choice.
    """

    pitch: Float[Array, " tooth"]
    profile_slope: Float[Array, " tooth"]
    lead_slope: Float[Array, " tooth"]
    profile_form: Float[Array, " tooth"]
    lead_form: Float[Array, " tooth"]
    root: Float[Array, ""]
    tip: Float[Array, ""]
    width: Float[Array, ""]

    def missing(self, spot: Spot) -> Lanes:
        """That of the tooth at each contact."""
        tooth = spot.tooth
        up = (jnp.sqrt(spot.flank) - jnp.sqrt(self.root)) / (
            jnp.sqrt(self.tip) - jnp.sqrt(self.root)
        )
        over = spot.across / self.width
        return (
            self.pitch[tooth]
            + self.profile_slope[tooth] * (up - 0.5)
            + self.lead_slope[tooth] * over
            + self.profile_form[tooth] * jnp.cos(2.0 * jnp.pi * up) / 2.0
            + self.lead_form[tooth] * jnp.cos(2.0 * jnp.pi * over) / 2.0
        )
