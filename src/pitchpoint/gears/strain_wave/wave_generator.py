"""How a wave generator deforms the neutral line of a flexspline: named shapes as cosine series."""

from functools import partial

import equinox as eqx
import numpy as np
from jaxtyping import Array, Complex, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays

__all__ = ["TERMS", "NeutralLine", "cosine", "elliptical", "four_forces", "two_rollers"]

TERMS = 16
"""Even harmonics of every shape; the last of an infinite series is below 1e-5 of the first."""


class NeutralLine(eqx.Module):
    """Neutral line of a ring whose length does not change to first order in its deflection.

    Attributes:
        radius: of the undeformed ring [m].
        deflection: radial displacement on the long axis of the wave generator w0 [m].
        weights: amplitudes of cos 2p, cos 4p, ... of the radial displacement over w0, p being the
            angle from the long axis; they sum to one.

    From the strain of the line, (v' + w)/r, which is zero to first order.
    """

    radius: Float[Array, ""]
    deflection: Float[Array, ""]
    weights: Float[Array, " term"]

    def radial(self, angle: Float[Arrays, "*b"], order: int = 0) -> Float[Array, "*b"]:
        """Radial displacement w or a derivative of it with respect to the angle [m]."""
        return self._series(angle, order)

    def tangential(self, angle: Float[Arrays, "*b"], order: int = 0) -> Float[Array, "*b"]:
        """Tangential displacement v [m]: its derivative is minus w, so the line keeps its length."""
        return -self._series(angle, order - 1)

    def rotation(self, angle: Float[Arrays, "*b"], order: int = 0) -> Float[Array, "*b"]:
        """Turn of the normal against the radius through the displaced point, -w'/r [rad]."""
        return -self._series(angle, order + 1) / self.radius

    def _series(self, angle: Float[Arrays, "*b"], order: int) -> Float[Array, "*b"]:
        """Derivative of the radial displacement; its integral for order -1."""
        harmonics = 2.0 * jnp.arange(1.0, self.weights.shape[0] + 1.0)
        turned = _powers(jnp.asarray(angle), self.weights.shape[0])
        wave = (jnp.real, lambda z: -jnp.imag(z), lambda z: -jnp.real(z), jnp.imag)[order % 4]
        return self.deflection * jnp.tensordot(self.weights * harmonics**order, wave(turned), 1)


@partial(jax.jit, static_argnums=1, inline=True)
def _powers(angle: Float[Array, "*b"], count: int) -> Complex[Array, "term *b"]:
    """Powers of exp(2ip): sines of all harmonics for the price of one."""
    powers = jax.lax.complex(jnp.cos(2.0 * angle), jnp.sin(2.0 * angle))[None]
    while powers.shape[0] < count:
        powers = jnp.concatenate([powers, powers * powers[-1]])
    return powers[:count]


def cosine(force_angle: float, relative: float) -> np.ndarray:
    """Radial displacement w0 cos 2p alone."""
    return np.asarray(np.eye(TERMS)[0])


def elliptical(force_angle: float, relative: float) -> np.ndarray:
    """Ellipse with half axes r (1 + e) and r (1 - e); its constant part is left to the second order.

    From the polar equation of the ellipse, in a Fourier series.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, 512, endpoint=False)
    long, short = 1.0 + relative, 1.0 - relative
    radius = long * short / np.hypot(long * np.sin(angle), short * np.cos(angle))
    amplitudes = np.fft.rfft(radius).real[2 : 2 * TERMS + 1 : 2]
    return np.asarray(amplitudes / amplitudes.sum())


def four_forces(force_angle: float, relative: float) -> np.ndarray:
    """Ring under two pairs of equal outward forces at plus and minus an angle from the long axis.

    From the energy of bending of a ring that keeps its length: a force makes n waves of cos(n p)/(n^2 -
    1)^2.
    """
    orders = 2.0 * np.arange(1, TERMS + 1)
    amplitudes = np.cos(orders * force_angle) / (orders**2 - 1.0) ** 2
    # Outward forces far from the long axis pull it in; the sign tells.
    return np.asarray(amplitudes / abs(amplitudes.sum()))


def two_rollers(force_angle: float, relative: float) -> np.ndarray:
    """Ring under two opposite outward forces.

    From `four_forces` whose pairs lie on the long axis.
    """
    return four_forces(0.0, relative)
