"""Modifications that all teeth of a gear have: reliefs of profile and ends, crowning, slope of the lead."""

from dataclasses import replace
from typing import Self

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.surface import FlankEnds, Lanes, Spot, Surface

__all__ = ["Crowning", "EndRelief", "LeadSlope", "LogRelief", "Relief"]

_BASE = 1e-9
"""Least arc length, over that of a relief's far end: the root of less has no finite slope."""


class Relief(Surface):
    """Relief of a profile towards its tip or its root.

    It grows over the roll length, the root of 2 r_b s, over which profile diagrams are drawn.

    Attributes:
        amount: C_αa or C_αf at its end, along the normal [m].
        length: roll length over which it grows [m].
        start, end: arc lengths on the flank where it begins and where it has that amount [m].
        power: static; 1 for a linear relief, 2 for a parabolic one.
        at_tip: static; False for the relief of a root.

    Source: ISO 21771:2007, tip and root relief.
    """

    amount: Float[Array, ""]
    length: Float[Array, ""]
    start: Float[Array, ""]
    end: Float[Array, ""]
    power: int = eqx.field(static=True, default=1)
    at_tip: bool = eqx.field(static=True, default=True)

    @classmethod
    def over(
        cls,
        amount: Float[Array, ""],
        length: Float[Array, ""],
        flank: FlankEnds,
        power: int = 1,
        at_tip: bool = True,
    ) -> Self:
        """Relief at one end of a flank; arguments as the attributes."""
        end, opposite = (flank.tip, flank.root) if at_tip else (flank.root, flank.tip)
        start = end + jnp.sign(opposite - end) * length
        return cls(amount, length, start**2 / flank.arcs, end**2 / flank.arcs, power, at_tip)

    def fitted(self, flank: FlankEnds) -> Self:
        """The same at the end of another flank."""
        return self.over(self.amount, self.length, flank, self.power, self.at_tip)

    def missing(self, spot: Spot) -> Lanes:
        """Nothing up to the start, the amount at the end, and more beyond."""
        start, end = jnp.sqrt(self.start), jnp.sqrt(self.end)
        roll = jnp.sqrt(jnp.maximum(spot.flank, _BASE * jnp.maximum(self.start, self.end)))
        return self.amount * jnp.maximum((roll - start) / (end - start), 0.0) ** self.power


class Crowning(Surface):
    """A flank that is highest in the middle of the face: a parabola.

    Attributes:
        amount: C_β at both ends of the face, along the normal [m].
        width: of the face [m].

    Source: ISO 21771:2007, lead crowning.
    """

    amount: Float[Array, ""]
    width: Float[Array, ""]

    def fitted(self, flank: FlankEnds) -> Self:
        """The same on a face of another width."""
        return replace(self, width=flank.width)

    def missing(self, spot: Spot) -> Lanes:
        """Grows with the square of the distance from the middle."""
        return self.amount * (2.0 * spot.across / self.width) ** 2


class EndRelief(Surface):
    """Relief towards both ends of the face.

    Attributes:
        amount: C_βI and C_βII at the ends, along the normal [m].
        length: of each of them along the face [m].
        width: of the face [m].
        power: static; 1 for a linear relief, 2 for a parabolic one.

    Source: ISO 21771:2007, end relief.
    """

    amount: Float[Array, ""]
    length: Float[Array, ""]
    width: Float[Array, ""]
    power: int = eqx.field(static=True, default=1)

    def fitted(self, flank: FlankEnds) -> Self:
        """The same on a face of another width."""
        return replace(self, width=flank.width)

    def missing(self, spot: Spot) -> Lanes:
        """Nothing in the middle, the amount at the ends."""
        inside = jnp.abs(spot.across) - (self.width / 2.0 - self.length)
        return self.amount * jnp.maximum(inside / self.length, 0.0) ** self.power


class LogRelief(Surface):
    """Relief that grows as a logarithm over the whole face, little in the middle and steeply at the ends.

    Attributes:
        amount: A, A ln(1/(1 - (1 - exp(-d/A)) (2 y/b)^2)) is missing along the normal [m].
        drop: d, at both ends; may be infinite, where the face itself has no point [m].
        width: b, of the face [m].

    With an infinite drop the profile of Lundberg (1939).
    """

    amount: Float[Array, ""]
    drop: Float[Array, ""]
    width: Float[Array, ""]

    def fitted(self, flank: FlankEnds) -> Self:
        """The same on a face of another width."""
        return replace(self, width=flank.width)

    def missing(self, spot: Spot) -> Lanes:
        """Nothing in the middle, the drop at the ends."""
        share = -jnp.expm1(-self.drop / self.amount)
        relief: Lanes = -self.amount * jnp.log1p(-share * (2.0 * spot.across / self.width) ** 2)
        return relief


class LeadSlope(Surface):
    """A flank that leans: misalignment of the axes, or a slope of the helix.

    Attributes:
        amount: f_Σβ or f_Hβ over the whole face, along the normal; positive where material is missing at
            the end of the face towards which z of the frame points [m].
        width: of the face [m].

    Source: ISO 6336-1:2019, misalignment in the plane of action over the face.
    """

    amount: Float[Array, ""]
    width: Float[Array, ""]

    def fitted(self, flank: FlankEnds) -> Self:
        """The same on a face of another width."""
        return replace(self, width=flank.width)

    def missing(self, spot: Spot) -> Lanes:
        """Nothing in the middle of the face, half the amount at its end."""
        return self.amount * spot.across / self.width
