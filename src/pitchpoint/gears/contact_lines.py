"""Contact lines of involute flanks in the plane of action: along the path of contact, and across the face."""

import abc
import dataclasses
from functools import cached_property, singledispatch
from typing import Any, ClassVar, Self

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Shape
from pitchpoint.contact.surface import Offset, other_side
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.errors import InputError
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.involute import InvoluteGear
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import ACTION, way_of_pairs

__all__ = [
    "LARGEST_CONTACT_RATIO",
    "SLICES",
    "InvoluteMesh",
    "PathOfContact",
    "PitchPoint",
    "lanes_for_contact_ratio",
    "line_of_action",
    "pitch_point",
]

# Few values, so that few programs are compiled for many pairs.
_LANES_FOR_RATIO_BELOW = (2.0, 3.0, 4.0, 6.0, 9.0, 14.0, 24.0)

LARGEST_CONTACT_RATIO = _LANES_FOR_RATIO_BELOW[-1]
"""Contact ratio above which no lanes are held."""

SLICES = 12
"""Slices of each contact line of helical gears, an even number: midpoints, so errors fall with its square."""

# Share of the face width that a contact line has at least while it is in mesh: a length of zero has
# no load per length.
_SHORTEST = 1e-9


class PathOfContact(abc.ABC):
    """Lengths along the line of action, and what they follow from, each computed when first asked for.

    One program asks for the same lengths in many places; this record answers one question of it
    and is then thrown away, so that no traced value outlives its trace. Source: ISO 21771:2007.

    Args:
        mesh: whose dimensions count.
    """

    def __init__(self, mesh: Any) -> None:
        self.mesh = mesh

    @property
    @abc.abstractmethod
    def pinion(self) -> InvoluteGear:
        """The gear from whose base circle positions are counted."""

    @property
    @abc.abstractmethod
    def base_radius(self) -> Float[Array, ""]:
        """Base radius of the pinion [m]."""

    @property
    @abc.abstractmethod
    def limits(self) -> Float[Array, "2"]:
        """Positions of A and E from N1 [m]."""

    @property
    @abc.abstractmethod
    def pitch_position(self) -> Float[Array, ""]:
        """Position of the pitch point C from N1 [m]."""

    @cached_property
    def base_pitch(self) -> Float[Array, ""]:
        """Transverse base pitch p_bt, the pitch on the line of action [m]."""
        return 2.0 * jnp.pi * self.base_radius / self.pinion.teeth

    @cached_property
    def overlap_ratio(self) -> Float[Array, ""]:
        """Overlap ratio eps_beta = b sin(beta)/(pi m_n)."""
        pinion, width = self.pinion, self.mesh.face_width
        return jnp.asarray(width * jnp.sin(pinion.helix_angle) / (jnp.pi * pinion.module))

    @cached_property
    def pitch_path(self) -> Float[Array, ""]:
        """Position of the pitch point from A [base pitches]."""
        return (self.pitch_position - self.limits[0]) / self.base_pitch

    @cached_property
    def points(self) -> Float[Array, "5"]:
        """Positions of A, B, C, D, E from N1 [m]; B and D one base pitch from the far end (1 < eps < 2)."""
        (start, end), pitch = self.limits, self.base_pitch
        return jnp.stack([start, end - pitch, self.pitch_position, start + pitch, end])

    @cached_property
    def transverse_contact_ratio(self) -> Float[Array, ""]:
        """Transverse contact ratio eps_alpha."""
        return jnp.asarray((self.limits[1] - self.limits[0]) / self.base_pitch)

    @cached_property
    def contact_ratio(self) -> Float[Array, ""]:
        """Total contact ratio eps_gamma = eps_alpha + eps_beta."""
        return self.transverse_contact_ratio + self.overlap_ratio

    def bounds(self, *, helical: bool) -> list[Float[Array, ""]]:
        """Base pitches from the entry of a pair at which it leaves, or passes the pitch point.

        Of helical teeth also those at which a contact line stops growing and begins to shrink, and
        at which the pitch line enters and leaves it.

        Args:
            helical: static.
        """
        bounds = [jnp.zeros_like(self.pitch_path), self.contact_ratio, self.pitch_path]
        if not helical:
            return bounds
        overlap = self.overlap_ratio
        return [*bounds, self.transverse_contact_ratio, overlap, self.pitch_path + overlap]

    def lines(
        self, entered: Float[Array, "pair 1 *b"], *, helical: bool, slices: int
    ) -> tuple[Float[Array, "pair slice *b"], Float[Array, "pair slice *b"]]:
        """Middles of the slices of each contact line, and the share of the face that each slice takes.

        Both are parts of the face width, counted from the end that enters first. Half of the slices
        lie on each side of the pitch line, so that sliding changes its sense in no slice.

        Args:
            entered: base pitches since the pair entered.
            helical: False for straight teeth, whose lines take the whole face; static.
            slices: of each line; even, or one; static.
        """
        if not helical:
            face_start = jnp.zeros_like(entered)
            return _sliced(face_start, face_start + 1.0, slices)
        overlap = self.overlap_ratio
        low = jnp.clip((entered - self.transverse_contact_ratio) / overlap, 0.0, 1.0)
        high = jnp.clip(entered / overlap, 0.0, 1.0)
        if slices == 1:
            return (low + high) / 2.0, jnp.maximum(high - low, _SHORTEST)
        pitch_line = jnp.clip((entered - self.pitch_path) / overlap, low, high)
        parts = [_sliced(*ends, slices // 2) for ends in ((low, pitch_line), (pitch_line, high))]
        middles, shares = zip(*parts, strict=True)
        return jnp.concatenate(middles, axis=1), jnp.concatenate(shares, axis=1)


def _sliced(
    low: Float[Array, "pair 1 *b"], high: Float[Array, "pair 1 *b"], count: int
) -> tuple[Float[Array, "pair slice *b"], Float[Array, "pair slice *b"]]:
    """Middles and lengths of equal slices between two ends."""
    share = jnp.maximum(high - low, _SHORTEST) / count
    middle = (jnp.arange(count) + 0.5).reshape(-1, *([1] * (low.ndim - 2)))
    return low + middle * share, jnp.broadcast_to(share, (low.shape[0], count, *low.shape[2:]))


def lanes_for_contact_ratio(contact_ratio: float, *, helical: bool = False) -> int:
    """Static count of pairs to hold for a contact ratio: few values, so that few programs are compiled."""
    for limit in _LANES_FOR_RATIO_BELOW:
        if contact_ratio < limit:
            return max(int(limit), 3) if helical else int(limit)
    message = f"contact ratio {contact_ratio:.3g} is out of reach"
    raise InputError(message, value=contact_ratio)


class PitchPoint(eqx.Module):
    """Values at the pitch point for laws that describe a whole mesh.

    Attributes:
        width: face width [m].
        line_length: length of a contact line across the whole face [m]: longer than the face on
            helical teeth.
        radius: relative radius of curvature at the pitch point [m].
        sum_speed: sum of the surface speeds there for a unit rate of the driver [m/rad or 1].
        pitch_line_speed: speed of the pitch circles for a unit rate of the driver [m/rad or 1].

    Source: ISO 21771:2007, pitch point C and pitch circles in operation.
    """

    width: Float[Array, ""]
    line_length: Float[Array, ""]
    radius: Float[Array, ""]
    sum_speed: Float[Array, ""]
    pitch_line_speed: Float[Array, ""]


class InvoluteMesh(Mesh):
    """Teeth of which pairs follow each other along a straight line of action, from A to E.

    Attributes:
        right_flank: False while member 0 pushes with its left flanks (seen with the tip up), turning
            counter-clockwise when it drives; True for the other ones.

    Source: ISO 21771:2007, path of contact with its points A to E.
    """

    shape: ClassVar[Shape] = "line"
    body: ClassVar[GearBody] = GearBody()

    right_flank: eqx.AbstractVar[Bool[Arrays, ""]]

    @property
    @abc.abstractmethod
    def line(self) -> PathOfContact:
        """Lengths on the line of action, for one question."""

    @property
    @abc.abstractmethod
    def normal_backlash(self) -> Float[Array, ""]:
        """Backlash along the normal of the flanks [m]."""

    @property
    def contact_ratio(self) -> Float[Array, ""]:
        """Total contact ratio eps_gamma = eps_alpha + eps_beta."""
        return self.line.contact_ratio

    @property
    def other_flanks(self) -> Self:
        """The same teeth on their other flanks, which lie back by the backlash."""
        of_gear, of_mate = (other_side(of_member) for of_member in self.surfaces)
        surfaces = ((*of_gear, Offset(self.normal_backlash)), of_mate)
        return dataclasses.replace(self, right_flank=~self.right_flank, surfaces=surfaces)  # type: ignore[call-arg]

    @property
    def _side(self) -> Float[Numbers, ""]:
        return 1.0 - 2.0 * self.right_flank


way_of_pairs.register(InvoluteMesh, lambda _: ACTION)


@singledispatch
def pitch_point(mesh: Any, driver: Float[Arrays, " dof"]) -> PitchPoint:
    """Values at the pitch point of a mesh.

    Args:
        mesh: any family.
        driver: one for the coordinate that drives, zero elsewhere.

    Raises:
        TypeError: its gears have none, see `has`.
    """
    raise TypeError(f"{type(mesh).__name__} has no pitch point")


@singledispatch
def line_of_action(mesh: Any) -> Float[Array, " dof"]:
    """Closing along the line of action for a unit rate of each coordinate [m/rad or 1].

    Transmission error is measured along it.

    Raises:
        TypeError: the gears of the mesh have none, see `has`.
    """
    raise TypeError(f"{type(mesh).__name__} has no line of action")
