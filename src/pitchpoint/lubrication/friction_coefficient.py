"""Friction coefficients of lubricated gear teeth: published laws, and the table of them.

A law takes SI values by keyword and returns a dimensionless coefficient that is never negative. Its
arguments carry the names of the contact conditions, so that a caller can pass the conditions on as
they are; a further keyword is a parameter of the law and has a default. All arguments broadcast.

A law is listed in `LAWS` when its form, its coefficients and its units agree in two sources that do
not depend on each other.
"""

import math
from functools import reduce
from operator import or_
from typing import Final

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers, log, product_array, scaled

__all__ = [
    "constant",
    "frictionless",
    "iso_tr_14179_2",
    "xu_2007",
]

Each = Float[Numbers, "*#b"]

# Far below any physical value in fitted units, large enough for finite powers and gradients.
_FLOOR: Final = 1e-12


_XU: Final = (
    -8.916465,
    1.03303,
    1.036077,
    -0.354068,
    2.812084,
    -0.100601,
    0.752755,
    -0.390958,
    0.620305,
)


def _power_product(*factors: tuple[Each, float], exponent: Each | float = 0.0) -> Array:
    """Product of value ** power, times exp(exponent); 0 where a factor of positive power vanishes.

    A factor of negative power has no finite limit at zero: it is held at the floor.
    """
    logs = [(log(value, _FLOOR), power) for value, power in factors]
    total = sum((power * logarithm for logarithm, power in sorted(logs, key=_size)), 0.0) + exponent
    vanishes = [logarithm <= math.log(_FLOOR) for logarithm, power in logs if power > 0.0]
    return jnp.where(reduce(or_, vanishes), 0.0, jnp.exp(total))


def _size(term: tuple[Array, float]) -> int:
    return int(jnp.size(term[0]))


def constant(*, coefficient: ArrayLike = 0.05) -> Float[Array, "..."]:
    """Coulomb friction with one coefficient for every contact.

    Args:
        coefficient: friction coefficient [-].

    Returns:
        The coefficient as an array [-].

    Source: Tian et al. (2024), eq. 4.

    Example:
        >>> float(constant(coefficient=0.06))
        0.06
    """
    return jnp.asarray(coefficient, dtype=float)


def frictionless() -> Float[Array, ""]:
    """No friction at all: the reference that losses are measured against.

    Returns:
        Zero [-].
    """
    return jnp.asarray(0.0)


def iso_tr_14179_2(
    *,
    reference_line_load: Each,
    reference_sum_speed: Each,
    reference_radius: Each,
    viscosity: Each,
    roughness_ra: Each,
    lubricant_factor: Each,
) -> Float[Array, "..."]:
    """Mean coefficient of a whole mesh after ISO/TR 14179-2, known as Schlenk's formula.

    It belongs with the total load of the mesh and its loss factor. The load enters as it is, no
    lower limit is applied. The formula has no finite limit at standstill: a sum speed below
    1e-12 m/s counts as 1e-12 m/s.

    Args:
        reference_line_load: transverse force at the base circle per face width [N/m].
        reference_sum_speed: sum of the surface speeds at the pitch point [m/s].
        reference_radius: relative radius of curvature at the pitch point [m].
        viscosity: dynamic viscosity at oil temperature [Pa s].
        roughness_ra: mean of the arithmetic roughness of the two flanks [m].
        lubricant_factor: X_L, the factor of the oil type [-].

    Returns:
        Mean friction coefficient of the mesh [-].

    References:
        ISO/TR 14179-2:2001 (`iso_tr_14179_2_2001`); Tian et al. 2024, equation 12 (`tian_2024`).

    Example:
        >>> mu = iso_tr_14179_2(reference_line_load=117.3e3, reference_sum_speed=2.9,
        ...     reference_radius=6.156e-3, viscosity=0.05, roughness_ra=0.8e-6,
        ...     lubricant_factor=1.0)
        >>> round(float(mu), 4)
        0.0544
    """
    newton_per_mm, mm = scaled(reference_line_load, 1e-3), scaled(reference_radius, 1e3)
    mPas, um = scaled(viscosity, 1e3), scaled(roughness_ra, 1e6)
    powers = _power_product(
        (newton_per_mm, 0.2), (reference_sum_speed, -0.2), (mm, -0.2), (mPas, -0.05), (um, 0.25)
    )
    return 0.048 * powers * jnp.asarray(lubricant_factor)


def xu_2007(
    *,
    pressure: Each,
    slide_roll_ratio: Each,
    entrainment: Each,
    viscosity: Each,
    radius: Each,
    roughness_rq: Each,
) -> Float[Array, "..."]:
    """Local coefficient after Xu and Kahraman: a regression of computed EHL contacts.

    It tends to zero at pure rolling. It is doubly exponential in the roughness, and returns values
    of mixed friction and above for rough flanks. It has no finite limit at zero entrainment, which
    is held at 1e-12 m/s. Inlet viscosities below 1 mPa s are outside its form.

    Args:
        pressure: maximum Hertz pressure [Pa].
        slide_roll_ratio: sliding speed over entrainment speed, absolute [-].
        entrainment: mean of the two surface speeds [m/s].
        viscosity: dynamic viscosity at inlet temperature and ambient pressure [Pa s].
        radius: relative radius of curvature [m].
        roughness_rq: composite RMS roughness of the two surfaces [m].

    Returns:
        Friction coefficient at the contact [-].

    References:
        Xu et al., J. Mech. Des. 129 (2007) 58-68 (`xu_2007`); Xu 2005 (`xu_2005`).

    Example:
        >>> mu = xu_2007(pressure=1e9, slide_roll_ratio=0.3, entrainment=10.0, viscosity=0.01,
        ...     radius=0.01, roughness_rq=0.5e-6)
        >>> round(float(mu), 6)
        0.021024
    """
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = _XU
    GPa, cP = scaled(pressure, 1e-9), scaled(viscosity, 1e3)
    um, SR = scaled(roughness_rq, 1e6), abs(scaled(slide_roll_ratio, 1.0))
    heaviness = product_array(GPa * (SR * log(cP, _FLOOR) / math.log(10.0)))
    f = (b1 + b9 * jnp.exp(um)) + b4 * heaviness + b5 * jnp.exp(-heaviness)
    return _power_product(
        (GPa, b2),
        (SR, b3),
        (entrainment, b6),
        (cP, b7),
        (radius, b8),
        # Far beyond any sense already; without the limit a rough flank overflows.
        exponent=jnp.minimum(f, 50.0),
    )
