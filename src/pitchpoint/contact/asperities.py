"""Pressure of asperities where two rough surfaces come near each other, averaged over their heights."""

from functools import partial
from typing import Final

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contact_registry import SUMMITS, USUAL_SUMMITS
from pitchpoint.core.factored import Numbers

__all__ = [
    "ETA_BETA_SIGMA",
    "SIGMA_OVER_BETA",
    "gaussian_moment",
    "greenwood_tripp_1970",
    "greenwood_tripp_stiffness",
    "greenwood_williamson_1966",
    "greenwood_williamson_1966_exponential",
    "hu_1994",
]

Each = Float[Numbers, "*#b"]

ETA_BETA_SIGMA: Final = SUMMITS[USUAL_SUMMITS].eta_beta_sigma
"""Usual product of summits per area, their radius and Rq: assumed."""

SIGMA_OVER_BETA: Final = SUMMITS[USUAL_SUMMITS].sigma_over_beta
"""Usual Rq over the radius of summits: assumed."""

_FAR: Final = -12.0  # overlap, in Rq, from which on nearly every height is in contact
# The integrand is even, so that the trapezoidal rule converges at once: moments of the orders 1/2 to 5/2 come
# to 2e-15 at any gap with this step, and to 4e-7 with twice it.
_STEP: Final = 0.08
_ROOTS: Final = _STEP * np.arange(59)  # of heights above the gap; the last one is beyond 8 Rq
_HEIGHTS, _WEIGHTS = np.polynomial.hermite_e.hermegauss(16)
_ROOT_TWO_PI: Final = float(np.sqrt(2.0 * np.pi))


def gaussian_moment(ratio: Each, order: float) -> Array:
    """Moment F_n(u) of Gaussian heights s above a gap u, mean of (s - u)^n where s > u [1].

    Args:
        ratio: u, gap over standard deviation of the heights; negative where mean planes overlap [1].
        order: n, half of an odd number from -1/2 on.

    The integral over the square root of s - u is analytic, and the trapezoidal rule gives it to 1e-10 from
    u = -12 to 25; below that Gauss and Hermite's rule does. Its slope is -n F_(n-1). It is a parabolic
    cylinder function, Gamma(n + 1)/sqrt(2 pi) exp(-u^2/4) D_(-n-1)(u).
    Source: Greenwood and Tripp (1970), F_n; Abramowitz and Stegun (1964), 19.5.3.

    Example:
        >>> round(float(gaussian_moment(0.0, 2.5)), 6)
        0.616634
    """
    return _moment(order, jnp.asarray(ratio, float))


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _moment(order: float, ratio: Array) -> Array:
    near = jnp.where(ratio > _FAR, ratio, _FAR)
    power = _ROOTS ** round(2.0 * order + 1.0)
    heights = jnp.exp(-0.5 * (near[..., None] + _ROOTS**2) ** 2)
    # Half of the first node belongs to each side of the even integrand.
    counted = np.where(_ROOTS > 0.0, 2.0, 1.0) * power * _STEP / _ROOT_TWO_PI
    deep = _HEIGHTS - jnp.where(ratio > _FAR, _FAR, ratio)[..., None]
    overlapped = jnp.sum(_WEIGHTS / _ROOT_TWO_PI * deep**order, axis=-1)
    return jnp.where(ratio > _FAR, jnp.sum(counted * heights, axis=-1), overlapped)


@_moment.defjvp
def _slope(order: float, primals: tuple[Array], along: tuple[Array]) -> tuple[Array, Array]:
    (ratio,), (step,) = primals, along
    # F_(n-1) = (F_(n+1) + u F_n)/n would lose digits; below -1/2 nothing is integrable any more.
    below = _moment(order - 1.0, ratio) if order > 0.0 else _by_parts(order, ratio)
    return _moment(order, ratio), -order * below * step


def _by_parts(order: float, ratio: Array) -> Array:
    """F_(n-1) from those above it: F_(n+1) = n F_(n-1) - u F_n."""
    return (_moment(order + 1.0, ratio) + ratio * _moment(order, ratio)) / order


def hu_1994(*, ratio: Each) -> Each:
    """The usual fit of the moment F_5/2 of Gaussian heights, 4.4086e-5 (4 - u)^6.804 up to u = 4 [1].

    Args:
        ratio: u, gap over Rq [1].

    Within 11 % of the integral from u = 0 to 2, then too low: by 35 % at 2.5, 74 % at 3, all from 4 on.
    Source: Hu et al. (1994).

    Example:
        >>> round(float(hu_1994(ratio=1.0)), 5)
        0.07774
    """
    below = 4.0 - jnp.asarray(ratio)
    some = below > 0.0
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    power = jnp.exp(6.804 * jnp.log(jnp.where(some, below, 1.0)))
    return jnp.where(some, 4.4086e-5 * power, 0.0)


def greenwood_tripp_1970(
    *,
    gap: Each,
    roughness_rq: Each,
    modulus: Each,
    eta_beta_sigma: Each | float = ETA_BETA_SIGMA,
    sigma_over_beta: Each | float = SIGMA_OVER_BETA,
) -> Each:
    """Mean pressure of the asperities of two rough surfaces [Pa].

    p = 16 sqrt(2) pi/15 (eta beta sigma)^2 sqrt(sigma/beta) E*  F_5/2(h/sigma), with E* half of E'.

    Args:
        gap: h, between the mean planes; negative where they overlap [m].
        roughness_rq: sigma, composite Rq of both surfaces, positive [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.
        eta_beta_sigma: summits per area times their radius times sigma [1].
        sigma_over_beta: sigma over the radius of the summits [1].

    Elastic summits of one radius and Gaussian heights; the two constants decide how much asperities carry,
    and their usual values span two powers of ten. Source: Greenwood and Tripp (1970).

    Example:
        >>> pressure = greenwood_tripp_1970(gap=0.5e-6, roughness_rq=0.5e-6, modulus=226.4e9)
        >>> round(float(pressure) / 1e6, 3)
        10.805
    """
    stiff = greenwood_tripp_stiffness(modulus, eta_beta_sigma, sigma_over_beta)
    pressure: Each = stiff * gaussian_moment(gap / roughness_rq, 2.5)
    return pressure


def greenwood_tripp_stiffness(
    modulus: Each, eta_beta_sigma: Each | float, sigma_over_beta: Each | float
) -> Array:
    """Pressure of asperities over the moment F_5/2, 16 sqrt(2) pi/15 (eta beta sigma)^2 sqrt(sigma/beta) E*.

    Arguments as in `greenwood_tripp_1970`. Source: Greenwood and Tripp (1970).
    """
    per_modulus = 16.0 * np.sqrt(2.0) * np.pi / 15.0 * eta_beta_sigma**2 * jnp.sqrt(sigma_over_beta)
    stiffness: Array = per_modulus * 0.5 * modulus
    return stiffness


def greenwood_williamson_1966(
    *, gap: Each, deviation: Each, radius: Each, density: Each, modulus: Each
) -> Each:
    """Mean pressure of elastic asperities with Gaussian heights [Pa], 4/3 eta E* beta^1/2 s^3/2 F_3/2(d/s).

    Args:
        gap: d, from the mean of the summits to the smooth plane; may be negative [m].
        deviation: s, standard deviation of the summits, positive [m].
        radius: beta, of the summits [m].
        density: eta, summits per area [1/m2].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E; E* is half of it.

    Source: Greenwood and Williamson (1966).

    Example:
        >>> pressure = greenwood_williamson_1966(
        ...     gap=0.5e-6, deviation=0.5e-6, radius=10e-6, density=1e10, modulus=226.4e9,
        ... )
        >>> round(float(pressure) / 1e6, 3)
        127.689
    """
    return _summits(deviation, radius, density, modulus) * gaussian_moment(gap / deviation, 1.5)


def greenwood_williamson_1966_exponential(
    *, gap: Each, deviation: Each, radius: Each, density: Each, modulus: Each
) -> Each:
    """Mean pressure of elastic asperities with exponential heights [Pa], 4/3 eta E* beta^1/2 s^3/2 F(d/s).

    F(u) = Gamma(5/2) exp(-u): the highest quarter of Gaussian heights falls off like that.

    Arguments are those of `greenwood_williamson_1966`.

    Source: Greenwood and Williamson (1966).

    Example:
        >>> pressure = greenwood_williamson_1966_exponential(
        ...     gap=0.5e-6, deviation=0.5e-6, radius=10e-6, density=1e10, modulus=226.4e9,
        ... )
        >>> round(float(pressure) / 1e6, 3)
        825.243
    """
    above: Array = 0.75 * np.sqrt(np.pi) * jnp.exp(-gap / deviation)
    return _summits(deviation, radius, density, modulus) * above


def _summits(deviation: Each, radius: Each, density: Each, modulus: Each) -> Array:
    """4/3 eta E* beta^1/2 s^3/2."""
    stiff: Array = 4.0 / 3.0 * density * 0.5 * modulus * jnp.sqrt(radius * deviation)
    return stiff * deviation
