"""Rheology of oils under pressure: rival laws of viscosity, density and shear stress by name.

Laws of one kind take the same keywords, so that one can stand in the place of another. All arguments
broadcast. They are defined, and have finite gradients, at every pressure that the iterate of a solver may
have: what lies below `LEAST_PRESSURE` counts as it.
"""

from typing import Final

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Numbers
from pitchpoint.materials.registry import LEAST_PRESSURE

__all__ = [
    "bair_winer_1979",
    "barus_1893",
    "dowson_higginson_1966",
    "incompressible",
    "lorentz_lorenz_1880",
    "newtonian",
    "ree_eyring_1955",
    "roelands_1966",
    "roelands_index",
]

Each = Float[Numbers, "*#b"]

_ROELANDS_PRESSURE: Final = 1.96e8  # Pa
_ROELANDS_TEMPERATURE: Final = 138.0  # K
_ROELANDS_LOGARITHM: Final = 9.67  # of 6.31e-5 Pa s, with its sign changed

EYRING_STRESS: Final = 5e6
"""Usual shear stress from which on an oil thins [Pa]: assumed, of the 2 to 10 MPa of mineral oils."""

LIMITING_COEFFICIENT: Final = 0.08
"""Usual limiting shear stress over pressure: assumed, of the 0.05 to 0.1 of mineral oils."""

LIMITING_STRESS: Final = 2e6
"""Limiting shear stress without pressure [Pa]: assumed; it keeps the inlet of a contact Newtonian."""


def _bounded(pressure: Each) -> Array:
    return jnp.where(jnp.asarray(pressure) > LEAST_PRESSURE, pressure, LEAST_PRESSURE)


def roelands_index(*, viscosity: Each, pressure_viscosity: Each) -> Each:
    """Pressure-viscosity index Z = alpha p0/(ln eta0 + 9.67) of Roelands' law [1].

    Args:
        viscosity: eta0 at ambient pressure [Pa s], above 6.31e-5.
        pressure_viscosity: alpha [1/Pa].

    With p0 = 196 MPa; it makes alpha the slope of ln eta at ambient pressure. Source: Roelands (1966), in
    the form of Houpert (1985).

    Example:
        >>> round(float(roelands_index(viscosity=0.04, pressure_viscosity=2.2e-8)), 4)
        0.6684
    """
    logarithm = jnp.log(viscosity) + _ROELANDS_LOGARITHM
    return pressure_viscosity * _ROELANDS_PRESSURE / logarithm


def roelands_1966(
    *,
    pressure: Each,
    temperature_rise: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    temperature: Each,
    viscosity_slope: Each,
) -> Each:
    """Viscosity under pressure by Roelands, eta0 exp{(ln eta0 + 9.67)[(1 + p/p0)^Z t^-S0 - 1]} [Pa s].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: above `temperature` [K].
        viscosity: eta0 at ambient pressure and `temperature` [Pa s], above 6.31e-5.
        pressure_viscosity: alpha there [1/Pa].
        temperature: T0 to which the values belong [K].
        viscosity_slope: -d ln eta0/dT there [1/K].

    p0 = 196 MPa, t = (T - 138)/(T0 - 138); Z = alpha p0/(ln eta0 + 9.67) and S0 = slope (T0 - 138)/
    (ln eta0 + 9.67), so that the slopes of ln eta at p = 0 and T = T0 are alpha and -slope. The minus one
    belongs inside the bracket; where it is printed outside of it, the viscosity at p = 0 is wrong.
    Source: Roelands (1966), in the form of Houpert (1985).

    Example:
        >>> eta = roelands_1966(
        ...     pressure=1e9, temperature_rise=0.0, viscosity=0.04, pressure_viscosity=2.2e-8,
        ...     temperature=313.15, viscosity_slope=0.04,
        ... )
        >>> round(float(eta))
        153281
    """
    logarithm = jnp.log(viscosity) + _ROELANDS_LOGARITHM
    from_pole = temperature - _ROELANDS_TEMPERATURE
    index = roelands_index(viscosity=viscosity, pressure_viscosity=pressure_viscosity)
    by_heat = viscosity_slope * from_pole / logarithm
    warmth = jnp.log(jnp.maximum(from_pole + temperature_rise, 1.0) / from_pole)
    squeezed = jnp.log1p(_bounded(pressure) / _ROELANDS_PRESSURE)
    return viscosity * jnp.exp(logarithm * jnp.expm1(index * squeezed - by_heat * warmth))


def barus_1893(
    *,
    pressure: Each,
    temperature_rise: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    temperature: Each,
    viscosity_slope: Each,
) -> Each:
    """Viscosity under pressure by Barus, eta0 exp(alpha p - slope (T - T0)) [Pa s].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].
        viscosity: eta0 at ambient pressure and T0 [Pa s].
        pressure_viscosity: alpha [1/Pa].
        temperature: T0 [K]; not asked for.
        viscosity_slope: -d ln eta0/dT at T0 [1/K].

    Source: Barus (1893) for the pressure; the exponential of the temperature is the usual one beside it.

    Example:
        >>> eta = barus_1893(
        ...     pressure=0.1e9, temperature_rise=5.0, viscosity=0.04, pressure_viscosity=2e-8,
        ...     temperature=313.15, viscosity_slope=0.04,
        ... )
        >>> round(float(eta), 6)
        0.241986
    """
    del temperature
    return viscosity * jnp.exp(
        pressure_viscosity * _bounded(pressure) - viscosity_slope * temperature_rise
    )


def dowson_higginson_1966(*, pressure: Each, temperature_rise: Each) -> Each:
    """Density over that at ambient pressure, 1 + 0.6 p/(1 + 1.7 p) - 0.0007 (T - T0), p in GPa [1].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].

    Source: Dowson and Higginson (1966) for the pressure, of a mineral oil; the expansion by heat is that of
    Xu et al. (2021), equation 13, where the 0.0007 must multiply the density.

    Example:
        >>> round(float(dowson_higginson_1966(pressure=1e9, temperature_rise=10.0)), 6)
        1.215222
    """
    GPa = _bounded(pressure) * 1e-9
    return 1.0 + 0.6 * GPa / (1.0 + 1.7 * GPa) - 0.7e-3 * temperature_rise


def incompressible(*, pressure: Each, temperature_rise: Each) -> Each:
    """Density that neither pressure nor heat changes, 1 [1].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].
    """
    return jnp.ones(jnp.broadcast_shapes(jnp.shape(pressure), jnp.shape(temperature_rise)))


def lorentz_lorenz_1880(*, refractive_index: Each, density_ratio: Each) -> Each:
    """Refractive index n of a compressed oil [1], (n^2 - 1)/(n^2 + 2) = rho/rho0 (n0^2 - 1)/(n0^2 + 2).

    Args:
        refractive_index: n0, at ambient pressure [1].
        density_ratio: rho/rho0, density over that at ambient pressure [1].

    What a molecule refracts is taken not to change with pressure. Source: Lorentz (1880), Lorenz (1880).

    Example:
        >>> round(float(lorentz_lorenz_1880(refractive_index=1.47, density_ratio=1.15)), 4)
        1.5548
    """
    squared = refractive_index**2
    refraction = density_ratio * (squared - 1.0) / (squared + 2.0)
    found: Each = jnp.sqrt((1.0 + 2.0 * refraction) / (1.0 - refraction))
    return found


def newtonian(*, viscosity: Each, shear_rate: Each, pressure: Each) -> Each:
    """Shear stress eta gamma of a Newtonian oil [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign [1/s].
        pressure: p [Pa]; not asked for.

    Source: Newton's definition of viscosity.
    """
    del pressure
    return viscosity * shear_rate


def ree_eyring_1955(
    *,
    viscosity: Each,
    shear_rate: Each,
    pressure: Each,
    eyring_stress: Each | float = EYRING_STRESS,
) -> Each:
    """Shear stress tau_E asinh(eta gamma/tau_E) of an oil that thins under shear [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign [1/s].
        pressure: p [Pa]; not asked for.
        eyring_stress: tau_E from which on it thins [Pa].

    Source: Ree and Eyring (1955), with one kind of unit; Johnson and Tevaarwerk (1977), equation 4.

    Example:
        >>> round(float(ree_eyring_1955(viscosity=100.0, shear_rate=1e6, pressure=1e9)))
        18447519
    """
    del pressure
    return eyring_stress * jnp.arcsinh(viscosity * shear_rate / eyring_stress)


def bair_winer_1979(
    *,
    viscosity: Each,
    shear_rate: Each,
    pressure: Each,
    limiting_coefficient: Each | float = LIMITING_COEFFICIENT,
    limiting_stress: Each | float = LIMITING_STRESS,
) -> Each:
    """Shear stress tau_L [1 - exp(-eta gamma/tau_L)] of an oil that bears tau_L at most [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign, which the stress has too [1/s].
        pressure: p [Pa].
        limiting_coefficient: rise of tau_L with pressure [1].
        limiting_stress: tau_L without pressure [Pa].

    tau_L = limiting_stress + limiting_coefficient p, where a pressure below zero counts as zero; without
    the first term the stress would vanish in the inlet, where the oil is Newtonian.
    Source: Bair and Winer (1979), steady shear.

    Example:
        >>> round(float(bair_winer_1979(viscosity=100.0, shear_rate=1e6, pressure=1e9)))
        57779314
    """
    pressed = jnp.where(jnp.asarray(pressure) > 0.0, pressure, 0.0)
    limit = limiting_stress + limiting_coefficient * pressed
    drawn = viscosity * shear_rate / limit
    return limit * (jnp.expm1(jnp.minimum(drawn, 0.0)) - jnp.expm1(-jnp.maximum(drawn, 0.0)))
