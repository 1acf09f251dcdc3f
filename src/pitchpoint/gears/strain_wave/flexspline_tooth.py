"""Flanks of flexspline teeth: double arc and involute, as curves by arc length from root to tip."""

import abc
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Complex, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.involute import involute

__all__ = ["ArcChain", "DoubleArcFlank", "FlexsplineFlank", "InvoluteFlank", "unit_circle_place"]

Along = Float[Arrays, "*#b"]
Place = Complex[Array, "*#b"]

STEEPEST = 1.4
"""Flank angle at which the rounding of the tip ends [rad]: what lies beyond meets no flank."""


def unit_circle_place(angle: Along) -> Place:
    """Place on the unit circle at an angle [rad]: exp(i angle) without the exponential of nothing."""
    place: Place = _on_circle(jnp.asarray(angle))
    return place


@partial(jax.jit, inline=True)
def _on_circle(angle: Array) -> Array:
    return jax.lax.complex(jnp.cos(angle), jnp.sin(angle))


class FlexsplineFlank(eqx.Module):
    """One flank of a tooth, the one that faces in the sense of positive rotation.

    Places are complex numbers `y + i x`: y outwards along the axis of the tooth from the neutral
    line of the rim that carries it, x across the tooth from its axis [m]. The tooth is symmetric.
    """

    tip_rounding: eqx.AbstractVar[Float[Array, ""]]
    tip_relief: eqx.AbstractVar[Float[Array, ""]]
    relief_length: eqx.AbstractVar[Float[Array, ""]]

    @property
    @abc.abstractmethod
    def lengths(self) -> tuple[Float[Array, ""], ...]:
        """Arc lengths of the smooth pieces from root to tip [m]; the rounding of the tip is the last."""

    @property
    @abc.abstractmethod
    def rounding_start(self) -> Place:
        """Place where the rounding of the tip begins [m].

        The place at the arc length `plain` is the same to the last digits alone: there a piece is chosen by
        an order of two equal numbers, and a compiler that works them out anew beside each use may take the
        arc of one piece with the angle of another.
        """

    @abc.abstractmethod
    def place(self, along: Along) -> Place:
        """Place at an arc length from the root [m]."""

    @abc.abstractmethod
    def angle(self, along: Along) -> Along:
        """Flank angle: between the tooth's axis and the tangent, growing towards the tip [rad]."""

    @abc.abstractmethod
    def curvature(self, along: Along) -> Along:
        """Curvature, positive where the flank is convex [1/m]."""

    def prepared(self) -> "FlexsplineFlank":
        """The same curve in the form that is evaluated with the least work."""
        return self

    @property
    def unrelieved(self) -> Self:
        """The same flank without relief, which generates the groove of its mate."""
        none = array(np.zeros(jnp.shape(self.tip_relief)))
        return replace(self, tip_relief=none, relief_length=none)

    @property
    def length(self) -> Float[Array, ""]:
        """Arc length from root to tip [m]."""
        return jnp.sum(jnp.stack(self.lengths))

    @property
    def plain(self) -> Float[Array, ""]:
        """Arc length from the root to where the rounding of the tip begins [m]."""
        return jnp.sum(jnp.stack(self.lengths[:-1]))

    @property
    def _bent(self) -> Float[Array, ""]:
        """Curvature that the relief adds, so that it takes off its amount at its end [1/m]."""
        reach = jnp.where(self.relief_length > 0.0, self.relief_length, 1.0)
        return 2.0 * self.tip_relief / reach**2

    def stations(self, flank: int, rounding: int) -> Float[Array, " station"]:
        """Arc lengths of so many places on the flank and so many more on the rounding of its tip [m]."""
        rounded, plain = self.lengths[-1], self.plain
        before = jnp.arange(flank) / (flank - 1) * plain
        beyond = jnp.arange(1, rounding + 1) / max(rounding, 1) * rounded
        return jnp.concatenate([before, plain + beyond])

    @property
    def root_height(self) -> Float[Array, ""]:
        """Height of the root above the neutral line [m]."""
        return jnp.real(self.place(jnp.zeros(())))


class ArcChain(FlexsplineFlank):
    """Circular arcs and straight lines that go over into each other without a bend.

    Attributes:
        starts: arc lengths at which the pieces begin [m].
        places: where they begin.
        angles: flank angles there [rad].
        curvatures: of the pieces, zero for a line [1/m].
        pieces: their arc lengths [m].
        tip_rounding: radius of the last one [m].
        tip_relief, relief_length: of the one before it [m].
    """

    starts: Float[Array, " piece"]
    places: Complex[Array, " piece"]
    angles: Float[Array, " piece"]
    curvatures: Float[Array, " piece"]
    pieces: Float[Array, " piece"]
    tip_rounding: Float[Array, ""]
    tip_relief: Float[Array, ""]
    relief_length: Float[Array, ""]

    @classmethod
    def beyond(
        cls,
        place: Place,
        angle: Along,
        pieces: Sequence[Float[Array, ""]],
        curvatures: Sequence[Float[Array, ""]],
        like: FlexsplineFlank,
    ) -> "ArcChain":
        """Arcs that follow each other from a place and a flank angle on."""
        lengths, bends = jnp.stack(pieces), jnp.stack(curvatures)
        starts = jnp.concatenate([jnp.zeros(1), jnp.cumsum(lengths)[:-1]])
        angles, places = [angle], [place]
        for piece, bend in zip(pieces[:-1], curvatures[:-1], strict=True):
            places.append(places[-1] + _chord(angles[-1], bend, piece))
            angles.append(angles[-1] + bend * piece)
        return cls(
            starts=starts,
            places=jnp.stack(places),
            angles=jnp.stack(angles),
            curvatures=bends,
            pieces=lengths,
            tip_rounding=like.tip_rounding,
            tip_relief=like.tip_relief,
            relief_length=like.relief_length,
        )

    @property
    def lengths(self) -> tuple[Float[Array, ""], ...]:
        """Arc lengths of the pieces [m]."""
        return tuple(self.pieces)

    @property
    def rounding_start(self) -> Place:
        """Place where the last piece begins [m]."""
        return self.places[-1]

    def _piece(self, along: Along) -> tuple[Array, Along]:
        """Piece at an arc length, and the way from its beginning [m]."""
        along = jnp.asarray(along)
        piece = sum((along > start).astype(int) for start in self.starts[1:])
        return piece, along - self.starts[piece]

    def place(self, along: Along) -> Place:
        """Place at an arc length from the root [m]."""
        piece, arc_length = self._piece(along)
        return self.places[piece] + _chord(self.angles[piece], self.curvatures[piece], arc_length)

    def angle(self, along: Along) -> Along:
        """Flank angle [rad]."""
        piece, arc_length = self._piece(along)
        return self.angles[piece] + self.curvatures[piece] * arc_length

    def curvature(self, along: Along) -> Along:
        """Curvature, positive where the flank is convex [1/m]."""
        return self.curvatures[self._piece(along)[0]]


def _chord(angle: Along, curvature: Along, way: Along) -> Place:
    """From the beginning of an arc with a flank angle there to a point on it."""
    half = curvature * way / 2.0
    return way * jnp.sinc(half / jnp.pi) * unit_circle_place(-(angle + half))


class DoubleArcFlank(FlexsplineFlank):
    """Convex arc at the tip, concave arc at the root, and the common tangent between them.

    The centre of the convex arc lies `convex_offset` beyond the tooth's axis and `convex_shift`
    below the pitch line; that of the concave arc `concave_offset` beyond the middle of the space
    and `concave_shift` above the pitch line, all [m].

    Attributes:
        pitch: circular pitch of the teeth on the pitch line, pi times the module [m].
        pitch_height: of the pitch line above the neutral line, half a rim and the dedendum [m].
        addendum, dedendum: from the pitch line [m].
        convex_radius, convex_offset, convex_shift: rho_a, l_a, e_a [m].
        concave_radius, concave_offset, concave_shift: rho_f, l_f, e_f [m].
        tip_rounding: radius of the rounded edge of the tip [m].
        tip_relief: by which an arc of smaller radius lies below the convex one where the rounding
            begins [m].
        relief_length: of that arc [m].

    Source: Zhao et al. (2022), eqs. 1 to 4, with the centre of the convex arc on the far side of the
    axis and the angles of both ends of the tangent equal, which its eq. 4 needs to close.
    """

    pitch: Float[Array, ""]
    pitch_height: Float[Array, ""]
    addendum: Float[Array, ""]
    dedendum: Float[Array, ""]
    convex_radius: Float[Array, ""]
    convex_offset: Float[Array, ""]
    convex_shift: Float[Array, ""]
    concave_radius: Float[Array, ""]
    concave_offset: Float[Array, ""]
    concave_shift: Float[Array, ""]
    tip_rounding: Float[Array, ""]
    tip_relief: Float[Array, ""]
    relief_length: Float[Array, ""]

    @property
    def convex_centre(self) -> Place:
        """Centre of the convex arc."""
        return self.pitch_height - self.convex_shift - 1j * self.convex_offset

    @property
    def concave_centre(self) -> Place:
        """Centre of the concave arc."""
        return self.pitch_height + self.concave_shift + 1j * (self.pitch / 2 + self.concave_offset)

    @property
    def tangent_length(self) -> Float[Array, ""]:
        """Length of the common tangent [m]; NaN where the arcs overlap and have none."""
        distance = jnp.abs(self.concave_centre - self.convex_centre)
        return jnp.sqrt(distance**2 - (self.convex_radius + self.concave_radius) ** 2)

    @property
    def tangent_angle(self) -> Float[Array, ""]:
        """Flank angle of the common tangent theta_B [rad]."""
        across = self.concave_centre - self.convex_centre
        radii = self.convex_radius + self.concave_radius
        return jnp.arctan2(jnp.real(across), jnp.imag(across)) + jnp.arctan(
            self.tangent_length / radii
        )

    @property
    def tip_angle(self) -> Float[Array, ""]:
        """Flank angle of the convex arc at the tip, were it not rounded, theta_A [rad]."""
        return jnp.arcsin((self.addendum + self.convex_shift) / self.convex_radius)

    @property
    def root_angle(self) -> Float[Array, ""]:
        """Flank angle of the concave arc at the root theta_D [rad]."""
        return jnp.arcsin((self.dedendum + self.concave_shift) / self.concave_radius)

    @property
    def tip_land(self) -> Float[Array, ""]:
        """Thickness of the tooth at its tip, were it not rounded [m]."""
        return 2.0 * (self.convex_radius * jnp.cos(self.tip_angle) - self.convex_offset)

    @property
    def rounding_angle(self) -> Float[Array, ""]:
        """Flank angle at which the convex arc would go over into the rounding without relief [rad]."""
        inner = self.convex_radius - self.tip_rounding
        return jnp.arcsin((self.addendum + self.convex_shift - self.tip_rounding) / inner)

    @property
    def lengths(self) -> tuple[Float[Array, ""], ...]:
        """Arc lengths of concave arc, tangent, convex arc, relief and rounding [m]."""
        convex = self.convex_radius * (self.rounding_angle - self.tangent_angle)
        steeper = self.rounding_angle + self._bent * self.relief_length
        return (
            self.concave_radius * (self.root_angle - self.tangent_angle),
            self.tangent_length,
            convex - self.relief_length,
            self.relief_length,
            self.tip_rounding * (STEEPEST - steeper),
        )

    def prepared(self) -> ArcChain:
        """The arcs and the tangent as a chain."""
        root = self.concave_centre - self.concave_radius * 1j * unit_circle_place(-self.root_angle)
        convex = 1.0 / self.convex_radius
        bends = [-1.0 / self.concave_radius, jnp.zeros_like(convex), convex, convex + self._bent]
        bends.append(1.0 / self.tip_rounding)
        return ArcChain.beyond(root, self.root_angle, self.lengths, bends, self)

    @property
    def rounding_start(self) -> Place:
        """Place where the rounding of the tip begins [m]."""
        return self.prepared().rounding_start

    def place(self, along: Along) -> Place:
        """Place at an arc length from the root [m]."""
        return self.prepared().place(along)

    def angle(self, along: Along) -> Along:
        """Flank angle [rad]."""
        return self.prepared().angle(along)

    def curvature(self, along: Along) -> Along:
        """Curvature, positive where the flank is convex [1/m]."""
        return self.prepared().curvature(along)


class InvoluteFlank(FlexsplineFlank):
    """Involute with a large profile shift, from the root circle to a rounded tip.

    Attributes:
        teeth: number of teeth.
        module: [m].
        pressure_angle: of the basic rack [rad].
        profile_shift: coefficient x.
        addendum, dedendum: of the basic rack, in modules.
        neutral_radius: of the rim that carries the teeth [m].
        tip_rounding: radius of the rounded edge of the tip [m].
        tip_relief: by which an arc lies below the involute where the rounding begins [m].
        relief_length: of that arc [m].

    Source: ISO 21771:2007, involute of a basic rack with profile shift.
    """

    teeth: Float[Array, ""]
    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    profile_shift: Float[Array, ""]
    addendum: Float[Array, ""]
    dedendum: Float[Array, ""]
    neutral_radius: Float[Array, ""]
    tip_rounding: Float[Array, ""]
    tip_relief: Float[Array, ""]
    relief_length: Float[Array, ""]

    @property
    def base_radius(self) -> Float[Array, ""]:
        """Base radius r_b [m]."""
        return self.teeth * self.module / 2.0 * jnp.cos(self.pressure_angle)

    @property
    def root_radius(self) -> Float[Array, ""]:
        """Root radius r_f [m]."""
        return self.module * (self.teeth / 2.0 + self.profile_shift - self.dedendum)

    @property
    def tip_radius(self) -> Float[Array, ""]:
        """Tip radius r_a [m]."""
        return self.module * (self.teeth / 2.0 + self.profile_shift + self.addendum)

    @property
    def pitch_thickness(self) -> Float[Array, ""]:
        """Thickness of the tooth on the reference circle [m]."""
        return self.module * (
            jnp.pi / 2.0 + 2.0 * self.profile_shift * jnp.tan(self.pressure_angle)
        )

    @property
    def tip_land(self) -> Float[Array, ""]:
        """Thickness of the tooth at its tip, were it not rounded [m]."""
        return 2.0 * self.tip_radius * self.half_angle_at(self.tip_radius)

    def half_angle_at(self, radius: Along) -> Along:
        """Half the angle that the tooth takes on circles outside the base circle [rad]."""
        pressure = jnp.arccos(jnp.minimum(self.base_radius / radius, 1.0))
        return self._half_angle - involute(pressure)

    @property
    def _half_angle(self) -> Float[Array, ""]:
        """Half the angle that the tooth would take on the base circle [rad]."""
        return self.pitch_thickness / (self.teeth * self.module) + involute(self.pressure_angle)

    @property
    def _rolls(self) -> tuple[Float[Array, ""], Float[Array, ""]]:
        """Roll angles at the root and where the rounding of the tip begins [rad]."""
        root = jnp.sqrt((self.root_radius / self.base_radius) ** 2 - 1.0)
        inner = self.tip_radius - self.tip_rounding
        tip_roll = (self.tip_rounding + jnp.sqrt(inner**2 - self.base_radius**2)) / self.base_radius
        return root, tip_roll

    @property
    def _rolled(self) -> Float[Array, ""]:
        """Arc length of the involute [m]."""
        root, tip_roll = self._rolls
        return self.base_radius * (tip_roll**2 - root**2) / 2.0 - self.relief_length

    def _roll(self, along: Along) -> Along:
        """Roll angle at an arc length on the involute [rad]."""
        root, _ = self._rolls
        return jnp.sqrt(root**2 + 2.0 * jnp.minimum(along, self._rolled) / self.base_radius)

    def _on_involute(self, along: Along) -> tuple[Place, Along]:
        """Place and flank angle at an arc length on the involute; beyond it those of its end."""
        roll = self._roll(along)
        turned = unit_circle_place(self._half_angle - roll)
        place = self.base_radius * turned * (1.0 + 1j * roll) - self.neutral_radius
        return place, roll - self._half_angle

    @property
    def _beyond(self) -> ArcChain:
        """Relief and rounding, which share the normal of the involute where it ends."""
        place, angle = self._on_involute(self._rolled)
        bend = 1.0 / (self.base_radius * self._roll(self._rolled)) + self._bent
        rounded = self.tip_rounding * (STEEPEST - angle - bend * self.relief_length)
        lengths = self.relief_length, rounded
        return ArcChain.beyond(place, angle, lengths, [bend, 1.0 / self.tip_rounding], self)

    @property
    def lengths(self) -> tuple[Float[Array, ""], ...]:
        """Arc lengths of involute, relief and rounding [m]."""
        return self._rolled, *self._beyond.lengths

    @property
    def rounding_start(self) -> Place:
        """Place where the rounding of the tip begins [m]."""
        return self._beyond.rounding_start

    def place(self, along: Along) -> Place:
        """Place at an arc length from the root [m]."""
        beyond = self._beyond.place(along - self._rolled)
        return jnp.where(along > self._rolled, beyond, self._on_involute(along)[0])

    def angle(self, along: Along) -> Along:
        """Flank angle [rad]."""
        beyond = self._beyond.angle(along - self._rolled)
        return jnp.where(along > self._rolled, beyond, self._on_involute(along)[1])

    def curvature(self, along: Along) -> Along:
        """Curvature, positive where the flank is convex [1/m]."""
        beyond = self._beyond.curvature(along - self._rolled)
        return jnp.where(along > self._rolled, beyond, 1.0 / (self.base_radius * self._roll(along)))
