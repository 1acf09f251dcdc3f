"""Straight flanks of a rack, in its normal section, and its tooth as a beam."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.gears.involute import FILLET_STATIONS, gauss
from pitchpoint.gears.tooth_section import ToothSection, chebyshev_nodes

__all__ = ["Rack"]


class Rack(eqx.Module):
    """Teeth of a rack; the space is as wide as the tooth on the reference line. Source: ISO 53:1998.

    Heights are counted from the reference line towards the tips.

    Attributes:
        module: normal module m_n [m].
        pressure_angle: normal pressure angle alpha_n [rad].
        addendum, dedendum, fillet_radius: in normal modules (h_aP*, h_fP*, rho_fP*).
    """

    module: Float[Array, ""]
    pressure_angle: Float[Array, ""]
    addendum: Float[Array, ""]
    dedendum: Float[Array, ""]
    fillet_radius: Float[Array, ""]

    @property
    def tip(self) -> Float[Array, ""]:
        """Height of the tips [m]."""
        return self.addendum * self.module

    @property
    def root(self) -> Float[Array, ""]:
        """Height of the line of the roots, below zero [m]."""
        return -self.dedendum * self.module

    @property
    def form(self) -> Float[Array, ""]:
        """Height at which the straight flank begins [m]."""
        rounding = self.fillet_radius * self.module
        return self.root + rounding * (1.0 - jnp.sin(self.pressure_angle))

    def half_thickness(self, height: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Half the tooth's thickness at a height on the straight flank [m]."""
        return jnp.pi * self.module / 4.0 - height * jnp.tan(self.pressure_angle)

    def arc(self, height: Float[Array, "*b"], angle: Float[Array, ""]) -> Float[Array, "*b"]:
        """Length along the flank in the transverse section, up to a height [m].

        Counted from a module below the form line, so that its root is smooth everywhere on the flank.

        Args:
            height: [m].
            angle: transverse pressure angle [rad].
        """
        return self.module + (height - self.form) / jnp.cos(angle)

    @property
    def root_half_thickness(self) -> Float[Array, ""]:
        """Half the tooth's thickness where its fillets run into the line of the roots [m]."""
        return self._fillet(jnp.zeros(()))[0]

    def section(self, angle: Float[Array, ""]) -> ToothSection:
        """Tooth in the normal section, as a beam.

        Args:
            angle: transverse pressure angle [rad].
        """
        unit, weight = gauss(FILLET_STATIONS)
        points, slopes = jax.jvp(self._fillet, (unit,), (jnp.ones_like(unit),))
        reach = jnp.sqrt(self.arc(jnp.stack([self.form, self.tip]), angle))
        half = (reach[1] - reach[0]) / 2.0
        place = reach[0] + half * (jnp.asarray(chebyshev_nodes()) + 1.0)
        height = self.form + (place**2 - self.module) * jnp.cos(angle)
        return ToothSection(
            fillet=points,
            step=slopes[1] * weight,
            flank=jnp.stack([self.half_thickness(height), height]),
            slope=2.0 * place * half * jnp.cos(angle),
            load_angle=jnp.broadcast_to(self.pressure_angle, height.shape),
            reach=reach,
            root_radius=jnp.asarray(jnp.inf),
            root_half_angle=jnp.zeros(()),
            rim_ratio=jnp.ones(()),
            stiff="a rack's body",
        )

    def outline(self, slope: Float[Array, ""], count: int = 24) -> Float[Array, "point 2"]:
        """One tooth in the transverse section with half a space on each side, axis along y [m].

        The origin is on the reference line.

        Args:
            slope: cosine of the helix angle.
            count: points on each line, as many as on those of a gear.
        """
        unit = jnp.linspace(0.0, 1.0, count)
        fillet = self._fillet(unit)
        height = self.form + (self.tip - self.form) * unit
        tip = self.half_thickness(self.tip) * (1.0 - unit)
        half = jnp.pi * self.module / 2.0
        root = jnp.stack([half + (fillet[0, 0] - half) * unit, jnp.full(count, self.root)])
        flank = jnp.stack([self.half_thickness(height), height])
        top = jnp.stack([tip, jnp.full(count, self.tip)])
        side = (
            jnp.concatenate([root, fillet, flank, top], axis=1)
            / jnp.stack([slope, jnp.ones(())])[:, None]
        )
        mirrored = side * jnp.array([[-1.0], [1.0]])
        return jnp.concatenate([mirrored, jnp.flip(side, axis=1)], axis=1).T

    def _fillet(self, unit: Float[Array, "*p"]) -> Float[Array, "2 *p"]:
        """Half thickness and height of the fillet's arc, from the root at 0 to the flank at 1 [m]."""
        rounding, angle = self.fillet_radius * self.module, self.pressure_angle
        turn = 1.5 * jnp.pi - (jnp.pi / 2.0 - angle) * unit
        across = self.half_thickness(self.form) + rounding * (jnp.cos(angle) + jnp.cos(turn))
        return jnp.stack([across, self.root + rounding * (1.0 + jnp.sin(turn))])
