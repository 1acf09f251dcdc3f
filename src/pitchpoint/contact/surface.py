"""Surfaces of flanks: by how much they lie below their design, and how that changes gap and curvature."""

import abc
from dataclasses import replace
from typing import ClassVar, Self

import equinox as eqx
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.core.factored import Arrays

__all__ = [
    "FlankEnds",
    "Lanes",
    "Offset",
    "Spot",
    "Surface",
    "Surfaces",
    "Waves",
    "missing",
    "other_side",
    "with_surfaces",
]

Lanes = Float[Arrays, "*#b"]


class Spot(eqx.Module):
    """Where contacts lie on one member.

    Attributes:
        flank: arc length on the profile, see `Contacts.flank` [m].
        across: position across the face from its middle [m].
        angle: around the member, growing in the sense of positive rotation [rad].
        tooth: number of the tooth, counted in the same sense.
        leaning: part of a tooth's displacement along the circumference that counts along the normal,
            one where that part is largest.
    """

    flank: Lanes
    across: Lanes
    angle: Lanes
    tooth: Int[Arrays, "*#b"]
    leaning: Lanes


class FlankEnds(eqx.Module):
    """Where the flanks of a member end.

    Attributes:
        root, tip: roll lengths at the ends of the active profile [m].
        arcs: arc length on the flank is the square of the roll length over it, 2 r_b [m].
        width: of the face [m].
    """

    root: Float[Array, ""]
    tip: Float[Array, ""]
    arcs: Float[Array, ""]
    width: Float[Array, ""]


class Surface(eqx.Module):
    """One way in which flanks of a member differ from their design; those of a member add up.

    Attributes:
        both: of the class; True if the flanks on the other side of the teeth differ likewise.
    """

    both: ClassVar[bool] = True

    @abc.abstractmethod
    def missing(self, spot: Spot) -> Lanes:
        """Height that is missing along the normal [m]; negative where there is more material.

        Args:
            spot: where on the member.
        """

    def bent(self, spot: Spot) -> Float[Array, "2 *#b"]:
        """Second derivatives of the missing height along the flank and across it, as felt [1/m].

        Args:
            spot: where on the member.
        """
        return jnp.stack([_second(self, spot, name) for name in ("flank", "across")])

    def fitted(self, flank: FlankEnds) -> Self:
        """The same on flanks that end elsewhere: amounts and lengths stay as they are.

        Args:
            flank: of the member.
        """
        return self


Surfaces = tuple[tuple[Surface, ...], tuple[Surface, ...]]
"""Of both members."""


class Offset(Surface):
    """Flanks that lie deeper all over.

    Attributes:
        depth: along the normal [m].
    """

    depth: Float[Array, ""]

    def missing(self, spot: Spot) -> Lanes:
        """The same everywhere."""
        return jnp.broadcast_to(self.depth, spot.flank.shape)


class Waves(Surface):
    """Teeth that lie behind their places, as waves around the member.

    Attributes:
        order: waves around the member; 1 is an eccentricity.
        amplitude: along the normal of the flank, where it stands upright most [m].
        phase: angle of each wave where the member's angle is zero [rad].

    From a Fourier series of the teeth's places around the member.
    """

    order: Float[Array, " wave"]
    amplitude: Float[Array, " wave"]
    phase: Float[Array, " wave"]

    def missing(self, spot: Spot) -> Lanes:
        """Sum of the waves at the angle of each contact."""
        turn = self.order * spot.angle[..., None] + self.phase
        return jnp.sum(self.amplitude * jnp.cos(turn), axis=-1) * spot.leaning


def missing(surfaces: tuple[Surface, ...], spot: Spot) -> Lanes:
    """Height that is missing from the flank of one member [m].

    Args:
        surfaces: of the member.
        spot: where on it.
    """
    return sum((surface.missing(spot) for surface in surfaces), jnp.zeros_like(spot.flank))


def other_side(surfaces: tuple[Surface, ...]) -> tuple[Surface, ...]:
    """Those that the flanks on the other side of the teeth have too.

    Args:
        surfaces: of a member.
    """
    return tuple(surface for surface in surfaces if surface.both)


def with_surfaces(contacts: Contacts, surfaces: Surfaces, spots: tuple[Spot, Spot]) -> Contacts:
    """Contacts of flanks that differ from their design.

    Missing height adds to the gap, its second derivatives along the flank and across it, as contacts feel
    them, to the curvatures.

    Args:
        contacts: of the flanks as designed.
        surfaces: of both members.
        spots: where the contacts lie on them.

    Source: Johnson, Contact Mechanics (1985), section 4.1: curvatures are the second derivatives of the
    separation.
    """
    gap, curvature, felt = contacts.gap, contacts.curvature, contacts.felt
    for member, (of_member, spot) in enumerate(zip(surfaces, spots, strict=True)):
        if of_member:
            gap = gap + missing(of_member, spot)
            bend = sum((surface.bent(spot) for surface in of_member[1:]), of_member[0].bent(spot))
            curvature = curvature.at[member].add(bend)
            felt = felt if felt is None else felt + bend[0]
    return replace(contacts, gap=gap, curvature=curvature, felt=felt)


def _second(surface: Surface, spot: Spot, name: str) -> Lanes:
    """Second derivative of the missing height with respect to a place."""

    def height(place: Lanes) -> Lanes:
        return surface.missing(replace(spot, **{name: place}))

    def slope(place: Lanes) -> Lanes:
        tangent: Lanes = jax.jvp(height, (place,), (jnp.ones_like(place),))[1]
        return tangent

    place = getattr(spot, name)
    bend: Lanes = jax.jvp(slope, (place,), (jnp.ones_like(place),))[1]
    return bend
