"""How a wave generator deforms the neutral line of a flexspline: named shapes as cosine series."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import equinox as eqx
import numpy as np
from jaxtyping import Array, Complex, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.factored import Arrays
from pitchpoint.registry import Registry

__all__ = ["TERMS", "WAVE_SHAPES", "NeutralLine", "WaveShape"]

TERMS = 16
"""Even harmonics of every shape; the last of an infinite series is below 1e-5 of the first."""


class NeutralLine(eqx.Module):
    """Neutral line of a ring whose length does not change to first order in its deflection.

    Attributes:
        radius: of the undeformed ring [m].
        deflection: radial displacement on the long axis of the wave generator w0 [m].
        weights: amplitudes of cos 2p, cos 4p, ... of the radial displacement over w0, p being the
            angle from the long axis; they sum to one.
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
    known = jax.lax.complex(jnp.cos(2.0 * angle), jnp.sin(2.0 * angle))[None]
    while known.shape[0] < count:
        known = jnp.concatenate([known, known * known[-1]])
    return known[:count]


@dataclass(frozen=True, eq=False)
class WaveShape:
    """One way in which a wave generator holds its flexspline.

    Attributes:
        name, title: by which it is picked, and what it says.
        harmonics: amplitudes of cos 2p, cos 4p, ... that sum to one, from the angle of the forces
            [rad] and the ratio w0/r; of no account to some.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    harmonics: Callable[[float, float], np.ndarray]
    sources: tuple[str, ...] = ()
    note: str = ""


def _cosine(force_angle: float, relative: float) -> np.ndarray:
    return np.asarray(np.eye(TERMS)[0])


def _elliptical(force_angle: float, relative: float) -> np.ndarray:
    """Ellipse with half axes r (1 + e) and r (1 - e); its constant part is left to the second order."""
    angle = np.linspace(0.0, 2.0 * np.pi, 512, endpoint=False)
    long, short = 1.0 + relative, 1.0 - relative
    radius = long * short / np.hypot(long * np.sin(angle), short * np.cos(angle))
    found = np.fft.rfft(radius).real[2 : 2 * TERMS + 1 : 2]
    return np.asarray(found / found.sum())


def _four_forces(force_angle: float, relative: float) -> np.ndarray:
    """Ring under two pairs of equal outward forces at plus and minus an angle from the long axis."""
    orders = 2.0 * np.arange(1, TERMS + 1)
    found = np.cos(orders * force_angle) / (orders**2 - 1.0) ** 2
    # Outward forces far from the long axis pull it in; the sign tells.
    return np.asarray(found / abs(found.sum()))


def _two_rollers(force_angle: float, relative: float) -> np.ndarray:
    return _four_forces(0.0, relative)


WAVE_SHAPES = Registry(
    "shape of the wave generator",
    WaveShape("cosine", "radial displacement w0 cos 2p", _cosine, ("zhao_2022",)),
    WaveShape("elliptical", "ellipse with half axes r + w0 and r - w0", _elliptical),
    WaveShape(
        "two_rollers",
        "ring under two opposite forces",
        _two_rollers,
        ("timoshenko_1955",),
    ),
    WaveShape(
        "four_forces",
        "ring under two pairs of forces beside the long axis",
        _four_forces,
        ("timoshenko_1955",),
        note="force_angle says where; 30 degrees where it is not given.",
    ),
)
