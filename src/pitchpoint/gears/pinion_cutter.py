"""Root of a ring as a pinion cutter generates it: the envelope of the rounded tips of the cutter's teeth."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.core.roots import hypot

__all__ = ["PinionCutting"]

_STEPS = 12


class PinionCutting(eqx.Module):
    """A pinion cutter in its last position in a ring, where it has cut flanks and root, in one section.

    Both roll without sliding. Angles about the cutter are counted from the middle of its tooth, those about
    the ring from the middle of the space that this tooth cuts.

    Attributes:
        base_radius: r_b0 of the cutter [m].
        tip_radius: r_a0 of the cutter, which reaches to the root circle of the ring [m].
        rounding: rho_a0, radius of the corners of its tip, in the section [m].
        base_half_angle: half the angle of its tooth on the base circle [rad].
        working_pressure_angle: alpha_w0 [rad].
        distance: a_0 between the axes, positive [m].
        ratio: z_0/|z|.
        half_pitch: half the pitch angle of the ring [rad].

    Source: ISO 21771:2007, generation by a pinion-type cutter; the envelope from the law of gearing: where a
    point of the corner cuts, its normal passes through the pitch point.
    """

    base_radius: Float[Arrays, ""]
    tip_radius: Float[Arrays, ""]
    rounding: Float[Arrays, ""]
    base_half_angle: Float[Arrays, ""]
    working_pressure_angle: Float[Arrays, ""]
    distance: Float[Arrays, ""]
    ratio: Float[Arrays, ""]
    half_pitch: Float[Arrays, ""]

    @property
    def form_roll_length(self) -> Float[Array, ""]:
        """Involute length of the ring where its fillet begins, cut by the end of the cutter's flank [m]."""
        beyond = self.distance * jnp.sin(self.working_pressure_angle)
        return self._centre_length + self.rounding + beyond

    @property
    def root_land_angle(self) -> Float[Array, ""]:
        """Half the angle of the root circle between two fillets [rad]; negative where corners do not fit."""
        return self._centre_angle * self.ratio

    def fillet(self, unit: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Radius [m] and angle from the tooth's middle [rad], from the root at 0 to the involute at 1."""
        across, along = self._place(unit * self._end)
        return jnp.stack([hypot(across, along), jnp.arctan2(across, along)])

    def tangent(self, angle: float | Float[Array, ""]) -> Float[Array, "3"]:
        """Where the tangent to the fillet makes an angle with the middle of the ring's tooth.

        Args:
            angle: between that of the flank and a right angle [rad].

        Returns:
            Distance from the middle of the tooth, along it from the axis of the ring, and radius [m].
        """
        wanted_direction = self.half_pitch + jnp.pi / 2.0 - angle
        turn = self._end / 2.0
        for _ in range(_STEPS):
            direction, slope = jax.jvp(self._direction, (turn,), (jnp.ones_like(turn),))
            turn = jnp.clip(turn - (direction - wanted_direction) / slope, 0.0, self._end)
        slope = jax.jvp(self._direction, (turn,), (jnp.ones_like(turn),))[1]
        place, speed = jax.jvp(self._place, (turn,), (jnp.ones_like(turn),))
        return jnp.stack([*place, hypot(*speed) / slope])

    @property
    def _centre_radius(self) -> Float[Array, ""]:
        return self.tip_radius - self.rounding

    @property
    def _centre_length(self) -> Float[Array, ""]:
        """Involute length of the corner's centre, which lies on a parallel involute."""
        return jnp.sqrt(jnp.maximum(self._centre_radius**2 - self.base_radius**2, 1e-30))

    @property
    def _centre_angle(self) -> Float[Array, ""]:
        along = self._centre_length
        unwound = (along + self.rounding) / self.base_radius
        return self.base_half_angle - unwound + jnp.arctan(along / self.base_radius)

    @property
    def _end(self) -> Float[Array, ""]:
        """Angle at the corner's centre between the radius to its outermost point and that to the flank."""
        return jnp.pi / 2.0 - jnp.arctan(self._centre_length / self.base_radius)

    def _normal(self, turn: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Angle between the normal of the cutting point and the line of centres, by the pitch point on it."""
        pitch = self.base_radius / jnp.cos(self.working_pressure_angle)
        return jnp.arcsin(self._centre_radius * jnp.sin(turn) / pitch)

    def _direction(self, turn: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Angle between that normal and the middle of the ring's space."""
        normal = self._normal(turn)
        return normal - (normal - turn - self._centre_angle) * self.ratio

    def _place(self, turn: Float[Array, "*b"]) -> Float[Array, "2 *b"]:
        """Point that a point of the corner cuts: from the middle of the ring's tooth, and along it [m]."""
        normal = self._normal(turn)
        centre = normal - turn
        turned = (centre - self._centre_angle) * self.ratio
        across = self._centre_radius * jnp.sin(centre) + self.rounding * jnp.sin(normal)
        along = self.distance + (
            self._centre_radius * jnp.cos(centre) + self.rounding * jnp.cos(normal)
        )
        angle = self.half_pitch - (jnp.arctan2(across, along) - turned)
        radius = hypot(across, along)
        return jnp.stack([radius * jnp.sin(angle), radius * jnp.cos(angle)])
