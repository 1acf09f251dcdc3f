"""Viscosity against temperature."""

from __future__ import annotations

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["astm_d341", "dynamic_viscosity"]

_MM2_S = 1e-6  # one mm2/s in m2/s
_SHIFT = 0.7  # mm2/s, the constant of the standard


def _loglog(nu: ArrayLike) -> Float[Array, "..."]:
    return jnp.log10(jnp.log10(jnp.asarray(nu) / _MM2_S + _SHIFT))


def astm_d341(
    *, T: ArrayLike, nu_1: ArrayLike, T_1: ArrayLike, nu_2: ArrayLike, T_2: ArrayLike
) -> Float[Array, "..."]:
    """Kinematic viscosity on the line through two measured points (Walther; ASTM D341).

    log10(log10(nu + 0.7)) = A - B log10(T), with nu in mm2/s and T in K. All arguments broadcast.

    Args:
        T: temperature, shape (...) [K].
        nu_1: kinematic viscosity at T_1, shape (...) [m2/s].
        T_1: first temperature, shape (...) [K].
        nu_2: kinematic viscosity at T_2, shape (...) [m2/s].
        T_2: second temperature, not equal to T_1, shape (...) [K].

    Returns:
        Kinematic viscosity at T, shape (...) [m2/s].

    Validity:
        Oils that are homogeneous liquids, from about 2 mm2/s upwards; below that the standard has
        further terms, which are left out. Best between the two points. NaN where nu_1 or nu_2 is
        0.3 mm2/s or less.

    Source:
        ASTM D341-20, the equation in its short form.

    Example:
        >>> nu = astm_d341(T=328.15, nu_1=98.8e-6, T_1=313.15, nu_2=15.2e-6, T_2=373.15)
        >>> round(float(nu) * 1e6, 2)
        54.79
    """
    x, x_1, x_2 = jnp.log(jnp.asarray(T)), jnp.log(jnp.asarray(T_1)), jnp.log(jnp.asarray(T_2))
    y_1, y_2 = _loglog(nu_1), _loglog(nu_2)
    y = y_1 + (y_2 - y_1) * (x - x_1) / (x_2 - x_1)
    return (10.0 ** (10.0**y) - _SHIFT) * _MM2_S


def dynamic_viscosity(*, nu: ArrayLike, rho: ArrayLike) -> Float[Array, "..."]:
    """Dynamic viscosity, the product of kinematic viscosity and density.

    Args:
        nu: kinematic viscosity, shape (...) [m2/s].
        rho: density at the same temperature, shape (...) [kg/m3].

    Returns:
        Dynamic viscosity, shape (...) [Pa s].

    From the definition of the kinematic viscosity.
    """
    return jnp.asarray(nu) * jnp.asarray(rho)
