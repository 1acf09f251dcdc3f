"""How the teeth of a flexspline travel through the spaces of a circular spline."""

import equinox as eqx
from jaxtyping import Array, Complex, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.strain_wave.flexspline_tooth import FlexsplineFlank, unit_circle_place
from pitchpoint.gears.strain_wave.wave_generator import NeutralLine

__all__ = ["PassingPoint", "ToothMotion"]

Each = Float[Arrays, "*#b"]
Place = Complex[Array, "*#b"]


class PassingPoint(eqx.Module):
    """A point of a flank at one phase, and how it moves for a unit rate of the phase.

    Attributes:
        place: in the space of the circular spline [m].
        direction: of the flank's tangent from root to tip [rad].
        curvature: of the flank [1/m].
        velocity: of the material [m/rad].
        turning: rate of the tooth.
        acceleration: of the material [m/rad^2].
        shift, whole: velocity with the undeformed flexspline at rest, and as the whole flexspline turns
            with the wave generator [m/rad].
    """

    place: Place
    direction: Each
    curvature: Each
    velocity: Place
    turning: Each
    acceleration: Place
    shift: Place
    whole: Place

    @property
    def _velocity(self) -> Place:
        """Velocity along the tangent (real part) and the normal (imaginary part)."""
        return unit_circle_place(-self.direction) * self.velocity

    @property
    def closing(self) -> Each:
        """Velocity along the normal [m/rad]; the flank touches its envelope where it is zero."""
        return jnp.imag(self._velocity)

    @property
    def sliding(self) -> Each:
        """Velocity along the tangent from root to tip [m/rad]."""
        return jnp.real(self._velocity)

    @property
    def change(self) -> Each:
        """Derivative of `closing` with respect to the phase."""
        return (
            jnp.imag(unit_circle_place(-self.direction) * self.acceleration)
            - self.turning * self.sliding
        )

    @property
    def approach(self) -> Each:
        """Derivative of `closing` along the flank [1/rad]."""
        return self.curvature * self.sliding + self.turning

    @property
    def rolling(self) -> Each:
        """Speed at which the point that touches the envelope moves along the flank [m/rad]."""
        return -self.change / self.approach

    @property
    def relative_curvature(self) -> Each:
        """Sum of the curvatures of flank and envelope [1/m]; contact needs it positive.

        Source: rolling of two curves on each other, 1/R = (kappa_1 v_s + turning)/v_2.
        """
        return self.approach / (self.rolling + self.sliding)


class ToothMotion(eqx.Module):
    """A flexspline tooth seen from the space of the circular spline that it meets.

    Places are complex numbers, the real axis along the middle of the space and outwards, the
    imaginary axis in the sense of positive rotation; the origin is the common axis. `angle` is the
    angle p of the tooth from the long axis of the wave generator, counted on the undeformed
    flexspline: teeth of a flexspline that turns ahead of the wave generator have a growing p.

    Attributes:
        flank: of the flexspline tooth.
        line: neutral line of the flexspline.
        lag: turn of the tooth against its space for a unit of p, 1 - z1/z2.
    """

    flank: FlexsplineFlank
    line: NeutralLine
    lag: Float[Array, ""]

    def foot(self, angle: Each) -> tuple[Place, Each]:
        """Foot of the tooth on the neutral line [m] and direction of its axis [rad].

        Source: ring theory to first order in the deflection.
        """
        line = self.line
        polar = self.lag * angle + line.tangential(angle) / line.radius
        reach = line.radius + line.radial(angle)
        return reach * unit_circle_place(polar), polar + line.rotation(angle)

    def place(self, along: Each, angle: Each) -> Place:
        """Where a point of the flank is [m]."""
        return self.carried(self.flank.place(along), angle)

    def carried(self, of_tooth: Place, angle: Each) -> Place:
        """Where a point is that is given from the foot of the tooth [m]."""
        foot, axis = self.foot(angle)
        return foot + unit_circle_place(axis) * of_tooth

    def passed(
        self, stations: Float[Array, " station"], angle: Float[Array, "*b"]
    ) -> tuple[Float[Array, "station *b"], Float[Array, "station *b"]]:
        """Heights of all stations of a flank and their distances from the middle of the space [m].

        As products of matrices: what is looked up by these heights works them out once, not for each look.

        Args:
            stations: arc lengths on the flank from its root [m].
            angle: p [rad].
        """
        foot, axis = self.foot(angle)
        local = self.flank.place(stations)
        parts = jnp.stack([jnp.ones_like(stations), jnp.real(local), jnp.imag(local)], axis=1)
        cosine, sine = jnp.cos(axis), jnp.sin(axis)
        height = jnp.tensordot(parts, jnp.stack([jnp.real(foot), cosine, -sine]), 1)
        return height, jnp.tensordot(parts, jnp.stack([jnp.imag(foot), sine, cosine]), 1)

    def at(self, along: Each, angle: Each) -> PassingPoint:
        """Place and motion of a point of the flank.

        Args:
            along: arc length on the flank from its root [m].
            angle: p [rad].
        """
        line, flank = self.line, self.flank
        reach = line.radius + line.radial(angle)
        turn, turn_2 = (line.tangential(angle, k) / line.radius for k in (1, 2))
        tilt, tilt_2 = (line.rotation(angle, k) for k in (1, 2))
        rise, rise_2 = line.radial(angle, 1), line.radial(angle, 2)
        foot, axis = self.foot(angle)
        outwards = foot / reach
        arm = unit_circle_place(axis) * flank.place(along)
        polar, turning = self.lag + turn, self.lag + turn + tilt
        place = foot + arm
        bend = rise_2 + 2j * rise * polar + 1j * reach * turn_2 - reach * polar**2
        shift = (rise + 1j * reach * turn) * outwards + 1j * (turn + tilt) * arm
        return PassingPoint(
            place=place,
            direction=axis - flank.angle(along),
            curvature=flank.curvature(along),
            velocity=shift + 1j * self.lag * place,
            turning=turning,
            acceleration=bend * outwards + (1j * (turn_2 + tilt_2) - turning**2) * arm,
            shift=shift,
            whole=1j * place,
        )
