"""Torque of a drive over its wind-up as a smooth curve, with play, on both flanks."""

from typing import Self

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays

__all__ = ["WindUpCurve"]

Each = Float[Arrays, "*b"]
Knots = Float[Arrays, " knot"]


class WindUpCurve(eqx.Module):
    """Torque over wind-up by cubics through points with their slopes, straight beyond the last one.

    The wind-up counts from the middle of the play. The other flanks are taken to yield alike.

    Attributes:
        wind_up: from first touch, rising from zero [rad].
        torque: there, rising from zero [N m].
        stiffness: slope there, positive [N m/rad].
        play: between both flanks without load; where they press on each other it counts as none [rad].

    From Hermite's cubics.
    """

    wind_up: Knots
    torque: Knots
    stiffness: Knots
    play: Float[Arrays, ""]

    @classmethod
    def straight(cls, stiffness: float, play: float = 0.0) -> Self:
        """A spring of one stiffness [N m/rad], with play [rad]."""
        both = jnp.array([0.0, 1.0])
        return cls(both, stiffness * both, jnp.full(2, stiffness), jnp.asarray(play))

    def torque_at(self, wind_up: Each) -> Float[Array, "*b"]:
        """Torque at a wind-up from the middle of the play, with its sign [N m].

        Example:
            >>> from pitchpoint._jax import jnp
            >>> from pitchpoint.loading.wind_up_curve import WindUpCurve
            >>> spring = WindUpCurve.straight(2e4, play=1e-3)
            >>> spring.torque_at(jnp.array([-1.5e-3, 0.2e-3, 1.5e-3])).round(9).tolist()
            [-20.0, 0.0, 20.0]
        """
        height, slope, curve, bend, at, past = self._piece(wind_up)
        inside = height + at * (slope + at * (curve + at * bend))
        return jnp.sign(wind_up) * (inside + self.stiffness[-1] * past)

    def energy_at(self, wind_up: Each) -> Float[Array, "*b"]:
        """Elastic energy there [J]: the integral of the torque."""
        height, slope, curve, bend, at, past = self._piece(wind_up)
        own = at * (height + at * (slope / 2.0 + at * (curve / 3.0 + at * bend / 4.0)))
        beyond = past * (self.torque[-1] + self.stiffness[-1] * past / 2.0)
        return self._stored[self._number(wind_up)] + own + beyond

    def slope_at(self, wind_up: Each) -> Float[Array, "*b"]:
        """Stiffness there [N m/rad]; none inside the play."""
        _, slope, curve, bend, at, past = self._piece(wind_up)
        inside = slope + at * (2.0 * curve + 3.0 * at * bend)
        touching = self._from_touch(wind_up) > 0.0
        return jnp.where(touching, jnp.where(past > 0.0, self.stiffness[-1], inside), 0.0)

    def _from_touch(self, wind_up: Each) -> Float[Array, "*b"]:
        return jnp.maximum(jnp.abs(wind_up) - jnp.maximum(self.play, 0.0) / 2.0, 0.0)

    def _number(self, wind_up: Each) -> Array:
        found = jnp.searchsorted(self.wind_up, self._from_touch(wind_up), side="right") - 1
        return jnp.clip(found, 0, self.wind_up.shape[0] - 2)

    def _piece(self, wind_up: Each) -> tuple[Array, ...]:
        """Coefficients of the cubic at a wind-up, the place in its piece, and how far beyond the last."""
        number, way = self._number(wind_up), self._from_touch(wind_up)
        past = jnp.maximum(way - self.wind_up[-1], 0.0)
        coefficients = (part[number] for part in self._cubics)
        return *coefficients, way - past - jnp.asarray(self.wind_up)[number], past

    @property
    def _cubics(self) -> tuple[Array, Array, Array, Array]:
        """Hermite's cubics, by rising powers of the way from the start of each piece."""
        step, rise = jnp.diff(self.wind_up), jnp.diff(self.torque)
        first, last = (jnp.asarray(self.stiffness)[part] for part in (slice(-1), slice(1, None)))
        mean = rise / step
        curve = (3.0 * mean - 2.0 * first - last) / step
        bend = (first + last - 2.0 * mean) / step**2
        return jnp.asarray(self.torque)[:-1], first, curve, bend

    @property
    def _stored(self) -> Float[Array, " piece"]:
        """Energy at the start of each piece."""
        height, slope, curve, bend = self._cubics
        step = jnp.diff(self.wind_up)
        each = step * (height + step * (slope / 2.0 + step * (curve / 3.0 + step * bend / 4.0)))
        return jnp.cumsum(each) - each
