"""Pressure-viscosity coefficient of oils."""

from __future__ import annotations

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["gold_2001"]


def gold_2001(*, nu: ArrayLike, s: ArrayLike, t: ArrayLike) -> Float[Array, "..."]:
    """Pressure-viscosity coefficient from the kinematic viscosity, alpha = s nu^t 1e-9 (Gold).

    Args:
        nu: kinematic viscosity at ambient pressure, shape (...) [m2/s].
        s: constant of the base oil, shape (...) [1/GPa at 1 mm2/s].
        t: exponent of the base oil, shape (...) [1]; 0 gives the constant alpha = s 1e-9.

    Returns:
        Pressure-viscosity coefficient alpha, shape (...) [1/Pa].

    Validity:
        The constants belong to one class of base oil; the catalogue has those of mineral oil, PAO,
        ester and PAG. The formula is fitted with nu in mm2/s.

    Source:
        Gold et al. 2001.

    Example:
        >>> round(float(gold_2001(nu=100e-6, s=9.904, t=0.139)) * 1e9, 2)
        18.78
    """
    nu_mm2_s = jnp.asarray(nu) * 1e6
    return jnp.asarray(s) * jnp.exp(jnp.asarray(t) * jnp.log(nu_mm2_s)) * 1e-9
