"""One involute gear cut by a basic rack: circles, thickness, form circle, outline (ISO 21771)."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.roots import root

__all__ = ["InvoluteGear", "inverse_involute", "involute"]


def involute(angle: Float[Array, "*b"]) -> Float[Array, "*b"]:
    """Involute function inv(alpha) = tan(alpha) - alpha [rad]."""
    return jnp.tan(angle) - angle


def inverse_involute(value: Float[Array, ""]) -> Float[Array, ""]:
    """Angle [rad] whose involute function is `value`, for value > 0."""
    guess = jnp.arctan(value + jnp.minimum(jnp.cbrt(3.0 * value), 1.5))
    return root(lambda angle: involute(angle) / value - 1.0, guess, jnp.pi / 2.0)[0]


class InvoluteGear(eqx.Module):
    """One spur gear cut by a basic rack.

    Attributes:
        teeth: number of teeth z.
        module: [m].
        pressure_angle: of the basic rack [rad].
        profile_shift: coefficient x.
        tip_alteration: coefficient k; negative shortens the tip (ISO 21771).
        addendum, dedendum, fillet_radius: of the basic rack, in modules (h_aP*, h_fP*, rho_fP*).
        undercut: True if the rack undercuts the flank; static, so that sound gears compile to little.
        crossing: normal angle of the fillet point where an undercut crosses the involute [rad], as
            `crossing_angle` finds it; any value without undercut.
    """

    teeth: Float[Array, ""]
    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    profile_shift: Float[Array, ""]
    tip_alteration: Float[Array, ""]
    addendum: Float[Array, ""]
    dedendum: Float[Array, ""]
    fillet_radius: Float[Array, ""]
    undercut: bool = eqx.field(static=True)
    crossing: Float[Array, ""]

    @property
    def reference_radius(self) -> Float[Array, ""]:
        """Radius of the reference circle r = z m / 2 [m]."""
        return self.teeth * self.module / 2.0

    @property
    def base_radius(self) -> Float[Array, ""]:
        """Radius of the base circle [m]."""
        return self.reference_radius * jnp.cos(self.pressure_angle)

    @property
    def tip_radius(self) -> Float[Array, ""]:
        """Radius of the tip circle [m]: r + m (h_aP* + x + k)."""
        return self.reference_radius + self.module * (
            self.addendum + self.profile_shift + self.tip_alteration
        )

    @property
    def root_radius(self) -> Float[Array, ""]:
        """Radius of the root circle [m]: r - m (h_fP* - x)."""
        return self.reference_radius - self.module * (self.dedendum - self.profile_shift)

    @property
    def undercut_limit(self) -> Float[Array, ""]:
        """Smallest profile shift without undercut: the straight rack flank ends on the base tangent."""
        straight = self.dedendum - self.fillet_radius * (1.0 - jnp.sin(self.pressure_angle))
        return straight - self.teeth * jnp.sin(self.pressure_angle) ** 2 / 2.0

    @property
    def form_roll_length(self) -> Float[Array, ""]:
        """Involute length at the form circle, where fillet and involute meet [m].

        Without undercut the rack's straight flank ends there; with undercut fillet and involute cross.
        """
        if not self.undercut:
            margin = self.profile_shift - self.undercut_limit
            return margin * self.module / jnp.sin(self.pressure_angle)
        radius = self._point(self._fillet_end)[0]
        return jnp.sqrt(jnp.maximum(radius**2 - self.base_radius**2, 1e-30))

    def half_thickness_angle(self, radius: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Half the tooth's angle [rad] at a radius [m] on the involute; negative beyond the pointed tip."""
        cosine = jnp.clip(self.base_radius / radius, -1.0, 1.0)
        at_reference = jnp.pi / 2.0 + 2.0 * self.profile_shift * jnp.tan(self.pressure_angle)
        return (
            at_reference / self.teeth + involute(self.pressure_angle) - involute(jnp.arccos(cosine))
        )

    @property
    def tip_thickness(self) -> Float[Array, ""]:
        """Tooth thickness on the tip circle s_a [m]; negative if the flanks cross below it."""
        return 2.0 * self.tip_radius * self.half_thickness_angle(self.tip_radius)

    def outline(self, count: int = 24) -> Float[Array, "point 2"]:
        """One tooth with half a space on each side, tooth axis along y, origin at the gear's centre [m].

        Args:
            count: points on each fillet, involute and arc.
        """
        unit = jnp.linspace(0.0, 1.0, count)
        start = self._fillet_end
        fillet = self._fillet(jnp.pi / 2.0 + (start - jnp.pi / 2.0) * unit)
        lengths = self.form_roll_length + (self._tip_roll_length - self.form_roll_length) * unit
        flank_radius = jnp.hypot(self.base_radius, lengths)
        flank = jnp.stack([flank_radius, self.half_thickness_angle(flank_radius)])
        tip = jnp.stack([jnp.full(count, self.tip_radius), flank[1, -1] * (1.0 - unit)])
        root = jnp.stack(
            [
                jnp.full(count, self.root_radius),
                jnp.pi / self.teeth + (fillet[1, 0] - jnp.pi / self.teeth) * unit,
            ]
        )
        half = jnp.concatenate([root, fillet, flank, tip], axis=1)
        whole = jnp.concatenate([half * jnp.array([[1.0], [-1.0]]), jnp.flip(half, axis=1)], axis=1)
        return jnp.stack([whole[0] * jnp.sin(whole[1]), whole[0] * jnp.cos(whole[1])], axis=-1)

    @property
    def _tip_roll_length(self) -> Float[Array, ""]:
        return jnp.sqrt(self.tip_radius**2 - self.base_radius**2)

    def _fillet(self, angle: Float[Array, " point"]) -> Float[Array, "2 point"]:
        """Radius and angle from the tooth axis of the fillet that the rack's rounded corner cuts."""
        radius, from_space = self._point(angle)
        return jnp.stack([radius, jnp.pi / self.teeth - from_space])

    def _point(self, angle: Float[Array, "*b"]) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
        """Fillet point whose normal makes `angle` with the pitch line: radius, angle from the space axis."""
        rounding = self.fillet_radius * self.module
        depth = (self.dedendum - self.profile_shift - self.fillet_radius) * self.module
        corner = (
            jnp.pi * self.module / 4.0
            - (self.dedendum - self.fillet_radius) * self.module * jnp.tan(self.pressure_angle)
            - rounding / jnp.cos(self.pressure_angle)
        )
        along = depth * jnp.cos(angle) / jnp.sin(angle)
        x = along + rounding * jnp.cos(angle)
        y = self.reference_radius - depth - rounding * jnp.sin(angle)
        return jnp.hypot(x, y), jnp.arctan2(x, y) - (along - corner) / self.reference_radius

    def crossing_angle(self) -> Float[Array, ""]:
        """Normal angle of the fillet point where an undercut crosses the involute [rad]."""
        # Clustered at the rack angle: a slight undercut crosses close to it.
        span = jnp.pi / 2.0 - self.pressure_angle
        scan = self.pressure_angle + span * jnp.linspace(0, 1, 200) ** 3
        first = jnp.argmax(self._removed(scan[1:]) > 0.0)
        guess = (scan[first] + scan[first + 1]) / 2.0 - self.pressure_angle
        beyond, _ = root(lambda x: self._removed(self.pressure_angle + x), guess, span)
        return self.pressure_angle + beyond

    @property
    def _fillet_end(self) -> Float[Array, ""]:
        """Normal angle of the fillet point where the involute begins.

        One Newton step from the stored crossing, so that it follows the dimensions to first order
        and gradients see them.
        """
        if not self.undercut:
            return self.pressure_angle
        stored = jax.lax.stop_gradient(self.crossing)
        value, slope = jax.jvp(self._removed, (stored,), (jnp.ones_like(stored),))
        return jnp.asarray(stored - value / jax.lax.stop_gradient(slope))

    def _removed(self, angle: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Angle by which the fillet point lies inside the tooth that the involute bounds [rad]."""
        radius, from_space = self._point(angle)
        radius = jnp.maximum(radius, self.base_radius * (1.0 + 1e-15))
        return from_space - (jnp.pi / self.teeth - self.half_thickness_angle(radius))
