"""Flow through the gap of rough surfaces: its mean height, and how much roughness hinders or carries it."""

from collections.abc import Callable
from functools import partial
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Numbers

__all__ = ["mean_gap", "patir_cheng_1978", "patir_cheng_1979_shear"]

Each = Float[Numbers, "*#b"]

_PATTERNS: Final = np.log([1.0 / 9.0, 1.0 / 6.0, 1.0 / 3.0, 1.0, 3.0, 6.0, 9.0])
_LEAST: Final = 0.5  # gap over Rq below which flow factors are continued, not fitted


class _Pressure(NamedTuple):
    """Constants of the pressure flow factor of one pattern: 1 - C exp(-r H), longitudinal 1 + C H^-r."""

    C: float
    r: float
    least: float
    longitudinal: bool = False


_PRESSURE: Final = (
    _Pressure(1.48, 0.42, 1.0),
    _Pressure(1.38, 0.42, 1.0),
    _Pressure(1.18, 0.42, 0.75),
    _Pressure(0.90, 0.56, 0.5),
    _Pressure(0.225, 1.5, 0.5, longitudinal=True),
    _Pressure(0.520, 1.5, 0.5, longitudinal=True),
    _Pressure(0.870, 1.5, 0.5, longitudinal=True),
)


class _Shear(NamedTuple):
    """Constants of the shear flow factor, A1 H^a1 exp(-a2 H + a3 H^2) up to H = 5, A2 exp(-H/4) beyond."""

    A1: float
    a1: float
    a2: float
    a3: float
    A2: float


_SHEAR: Final = (
    _Shear(2.046, 1.12, 0.78, 0.03, 1.856),
    _Shear(1.962, 1.08, 0.77, 0.03, 1.754),
    _Shear(1.858, 1.01, 0.76, 0.03, 1.561),
    _Shear(1.899, 0.98, 0.92, 0.05, 1.126),
    _Shear(1.560, 0.85, 1.13, 0.08, 0.556),
    _Shear(1.290, 0.62, 1.09, 0.08, 0.388),
    _Shear(1.011, 0.54, 1.07, 0.08, 0.295),
)


def mean_gap(*, gap: Each, roughness_rq: Each) -> Each:
    """Mean height of the gap between rough surfaces, zero where they touch [m].

    Args:
        gap: h, between the mean planes; negative where they overlap [m].
        roughness_rq: sigma, composite Rq, zero or more [m].

    h_T = h Phi(h/sigma) + sigma phi(h/sigma) of Gaussian heights that are cut where they touch; it is never
    negative, and rises with h. Source: Patir and Cheng (1978), average gap.

    Example:
        >>> round(float(mean_gap(gap=0.0, roughness_rq=1e-6)) * 1e6, 4)
        0.3989
    """
    rough = jnp.asarray(roughness_rq) > 0.0
    sigma = jnp.where(rough, roughness_rq, 1.0)
    depth = -gap / sigma
    density = jnp.exp(-0.5 * depth**2) / np.sqrt(2.0 * np.pi)
    left = density - depth * jnp.exp(jax.scipy.special.log_ndtr(-depth))
    return jnp.where(rough, sigma * left, jnp.maximum(gap, 0.0))


def patir_cheng_1978(*, ratio: Each, pattern: float = 1.0) -> Each:
    """Pressure flow factor of rough surfaces, flow under pressure over that of smooth ones [1].

    Args:
        ratio: H, gap between the mean planes over composite Rq [1].
        pattern: Peklenik's gamma, length of asperities along the flow over that across it, 1/9 to 9; 1 where
            they are alike both ways. Known when compiled.

    1 - C exp(-r H), for gamma above one 1 + C H^-r, with the constants of the paper; between them it is
    interpolated in ln gamma. Fitted from H = 0.5 (transverse 0.75 to 1) on; below that, where mean planes
    come to overlap, it goes on with its slope and stays positive, which is a choice.
    Source: Patir and Cheng (1978), table 1.

    Example:
        >>> round(float(patir_cheng_1978(ratio=2.0)), 4)
        0.7063
    """
    return _between(pattern, [partial(_pressure, constants, ratio) for constants in _PRESSURE])


def _pressure(constants: _Pressure, ratio: Each) -> Array:
    fitted = jnp.where(ratio > constants.least, ratio, constants.least)
    below = jnp.where(ratio > constants.least, 0.0, ratio - constants.least)
    C, r, least, longitudinal = constants
    if longitudinal:
        # Towards the value at which the slope would arrive a quarter of Rq further on.
        steep: float = C * r * least ** (-r - 1.0)
        return 1.0 + C * jnp.exp(-r * jnp.log(fitted)) - 0.25 * steep * jnp.expm1(4.0 * below)
    end = 1.0 - C * np.exp(-r * least)
    return (1.0 - C * jnp.exp(-r * fitted)) * jnp.exp(r * (1.0 - end) / end * below)


def patir_cheng_1979_shear(
    *, ratio: Each, share: Each | float, patterns: tuple[float, float] = (1.0, 1.0)
) -> Each:
    """Shear flow factor of two rough surfaces: flow that sliding carries in their valleys, over u_s Rq/2 [1].

    Args:
        ratio: H, gap between the mean planes over composite Rq [1].
        share: part of the squared roughness that surface 1 has, Rq_1^2/Rq^2 [1].
        patterns: Peklenik's gamma of both surfaces, 1/9 to 9. Known when compiled.

    share Phi(H, gamma_1) - (1 - share) Phi(H, gamma_2): none where both are alike. Phi is fitted from H = 0.5
    on; below that it goes to zero with its slope, which is a choice, and is zero where mean planes overlap.
    Source: Patir and Cheng (1979), table 1.

    Example:
        >>> round(float(patir_cheng_1979_shear(ratio=2.0, share=1.0)), 4)
        0.7266
    """
    factor_a, factor_b = (
        _between(pattern, [partial(_shear, constants, ratio) for constants in _SHEAR])
        for pattern in patterns
    )
    carried: Each = share * factor_a - (1.0 - share) * factor_b
    return carried


def _shear(constants: _Shear, ratio: Each) -> Array:
    A1, a1, a2, a3, A2 = constants
    film_ratio = jnp.asarray(ratio)
    fitted = jnp.clip(film_ratio, _LEAST, 5.0)
    near = A1 * jnp.exp(a1 * jnp.log(fitted) - a2 * fitted + a3 * fitted**2)
    far = A2 * jnp.exp(-0.25 * jnp.where(film_ratio > 5.0, film_ratio, 5.0))
    return jnp.where(
        film_ratio > 5.0, far, jnp.where(film_ratio > _LEAST, near, _start(constants, film_ratio))
    )


def _start(constants: _Shear, ratio: Array) -> Array:
    """Cubic that leaves zero with no slope and meets the fit with its value and slope."""
    A1, a1, a2, a3, _ = constants
    end = A1 * _LEAST**a1 * np.exp(-a2 * _LEAST + a3 * _LEAST**2)
    slope = end * (a1 / _LEAST - a2 + 2.0 * a3 * _LEAST) * _LEAST
    part = jnp.clip(ratio / _LEAST, 0.0, 1.0)
    begun: Array = part**2 * (3.0 * end - slope + (slope - 2.0 * end) * part)
    return begun


def _between(pattern: float, factors: list[Callable[[], Array]]) -> Array:
    """Interpolated in ln gamma from values at the patterns of the tables, of which two are asked for."""
    place = float(np.interp(np.log(pattern), _PATTERNS, np.arange(len(factors))))
    low, part = int(place), place - int(place)
    if part < 1e-12:
        return factors[low]()
    return (1.0 - part) * factors[low]() + part * factors[low + 1]()
