"""Rheology of oils under pressure: rival laws of viscosity, density and shear stress by name.

Laws of one kind take the same keywords, so that one can stand in the place of another. All arguments
broadcast. They are defined, and have finite gradients, at every pressure that the iterate of a solver may
have: what lies below `LEAST_PRESSURE` counts as it.
"""

from typing import Final

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.materials.materials_registry import LEAST_PRESSURE

__all__ = [
    "bair_2015",
    "bair_winer_1979",
    "barus_1893",
    "carreau_1972",
    "doolittle_1951",
    "dowson_higginson_1966",
    "incompressible",
    "limiting_shear_stress",
    "lorentz_lorenz_1880",
    "newtonian",
    "ree_eyring_1955",
    "roelands_1966",
    "roelands_index",
    "tait_1888",
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

CRITICAL_STRESS: Final = 7e6
"""Usual shear stress from which on an oil thins by a power of it [Pa]: recalled of thin hydrocarbons."""

SHEAR_EXPONENT: Final = 0.45
"""Usual exponent of that power: assumed, of the 0.35 to 0.6 recalled of oils without polymers."""

OCCUPIED_VOLUME: Final = 0.68
"""Usual part of the volume that molecules occupy [1]: assumed; 0.65 and 0.70 of two oils at 50 degC."""

BULK_MODULUS: Final = 1.3e9
"""Usual bulk modulus at ambient pressure [Pa]: assumed; 1.1e9 to 1.5e9 of four oils at 50 degC."""

MODULUS_RISE: Final = 10.8
"""Usual rise of the bulk modulus with pressure [1]: assumed; 10.3 to 11.7 of four oils."""

MODULUS_SLOPE: Final = 5.7e-3
"""Usual relative fall of the bulk modulus per kelvin [1/K]: assumed; 4.9e-3 to 6.3e-3 of four oils."""

EXPANSION: Final = 7.8e-4
"""Usual thermal expansion [1/K]: assumed; 7.2e-4 to 8.4e-4 of four oils."""

MCEWEN_EXPONENT: Final = 3.0
"""Exponent of McEwen's power [1]: assumed, that of one gear oil at 60 degC."""

PALUCH_SHARE: Final = 0.36
"""Part of the pressure-viscosity coefficient by Paluch's term [1]: assumed, likewise."""

DIVERGENCE_PRESSURE: Final = 4.7e9
"""Pressure at which Paluch's term goes to infinity [Pa]: assumed, likewise."""

_NEAREST_DIVERGENCE: Final = 0.9
"""Part of that pressure from which on the viscosity stays: none that can be measured comes so far."""

_STRETCHED: Final = -0.5
"""Least argument of Tait's logarithm: a hot oil under tension, of which nothing is known."""

_LEAST_BASE: Final = 0.02
"""Least base of McEwen's power: an oil under tension, of which nothing is known."""

_LEAST_FREE: Final = 0.02
"""Least free volume over that at ambient pressure: viscosities beyond all that can be measured."""


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


def tait_1888(
    *,
    pressure: Each,
    temperature_rise: Each,
    bulk_modulus: Each | float = BULK_MODULUS,
    modulus_rise: Each | float = MODULUS_RISE,
    modulus_slope: Each | float = MODULUS_SLOPE,
    expansion: Each | float = EXPANSION,
) -> Each:
    """Density over that at ambient pressure and T0, 1/V with V = (1 - ln(1 + m p/K)/m) (1 + a (T - T0)) [1].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].
        bulk_modulus: K0 at ambient pressure and T0 [Pa]; K = K0 exp(-slope (T - T0)).
        modulus_rise: dK/dp at ambient pressure, m - 1 [1].
        modulus_slope: -d ln K/dT [1/K].
        expansion: a, thermal expansion at ambient pressure [1/K].

    Source: Tait (1888), in the form of Bair (2019), where the modulus falls exponentially with temperature.

    Example:
        >>> round(float(tait_1888(pressure=1e9, temperature_rise=0.0)), 6)
        1.243447
    """
    volume = _tait_volume(
        pressure, temperature_rise, bulk_modulus, modulus_rise, modulus_slope, expansion
    )
    return 1.0 / volume


def _tait_volume(
    pressure: Each,
    rise: Each,
    bulk_modulus: Each | float,
    modulus_rise: Each | float,
    modulus_slope: Each | float,
    expansion: Each | float,
) -> Each:
    """Volume over that at ambient pressure and T0."""
    steep = 1.0 + modulus_rise
    squeezed = steep * _bounded(pressure) / (bulk_modulus * jnp.exp(-modulus_slope * rise))
    logarithm = jnp.log1p(jnp.maximum(squeezed, _STRETCHED))
    return (1.0 - logarithm / steep) * (1.0 + expansion * rise)


def doolittle_1951(
    *,
    pressure: Each,
    temperature_rise: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    temperature: Each,
    viscosity_slope: Each,
    occupied_volume: Each | float = OCCUPIED_VOLUME,
    bulk_modulus: Each | float = BULK_MODULUS,
    modulus_rise: Each | float = MODULUS_RISE,
    modulus_slope: Each | float = MODULUS_SLOPE,
    expansion: Each | float = EXPANSION,
) -> Each:
    """Viscosity under pressure by free volume, eta0 exp{B [x/(V - x) - R0/(1 - R0)]} [Pa s].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].
        viscosity: eta0 at ambient pressure and T0 [Pa s].
        pressure_viscosity: alpha there [1/Pa].
        temperature: T0 [K]; not asked for.
        viscosity_slope: -d ln eta0/dT there [1/K].
        occupied_volume: R0, part of the volume at ambient pressure and T0 that molecules occupy [1].
        bulk_modulus: K0 there [Pa].
        modulus_rise: see `tait_1888`, whose volume is V.
        modulus_slope: likewise.
        expansion: a, likewise.

    B = alpha K0 (1 - R0)^2/R0 and the occupied volume x = R0 (1 + e (T - T0)), e = a - slope/(alpha K0): so
    the slopes of ln eta at p = 0 and T = T0 are alpha and -slope. The viscosity rises more slowly than
    exponentially at first and faster in the end, as measured ones do and Roelands' does not.

    Validity: two correlations of one gear oil up to 1 GPa, this one and another, agree within 18 % from 65 to
    100 degC. It was held against no measured traction curve, for none was found in numbers.

    Source: Doolittle (1951) with Tait's volume, in the form of Bair (2019).

    Example:
        >>> eta = doolittle_1951(
        ...     pressure=1e9, temperature_rise=0.0, viscosity=0.04, pressure_viscosity=2.2e-8,
        ...     temperature=313.15, viscosity_slope=0.04,
        ... )
        >>> round(float(eta))
        73575
    """
    del temperature
    fall = pressure_viscosity * bulk_modulus
    factor = fall * (1.0 - occupied_volume) ** 2 / occupied_volume
    occupied = occupied_volume * (1.0 + (expansion - viscosity_slope / fall) * temperature_rise)
    volume = _tait_volume(
        pressure, temperature_rise, bulk_modulus, modulus_rise, modulus_slope, expansion
    )
    free = jnp.maximum(volume - occupied, _LEAST_FREE)
    # The difference of both fractions with its zero taken out: exact at ambient pressure.
    filled = (occupied - occupied_volume * volume) / (free * (1.0 - occupied_volume))
    return viscosity * jnp.exp(factor * filled)


def bair_2015(
    *,
    pressure: Each,
    temperature_rise: Each,
    viscosity: Each,
    pressure_viscosity: Each,
    temperature: Each,
    viscosity_slope: Each,
    mcewen_exponent: Each | float = MCEWEN_EXPONENT,
    paluch_share: Each | float = PALUCH_SHARE,
    divergence_pressure: Each | float = DIVERGENCE_PRESSURE,
) -> Each:
    """Viscosity under pressure by Bair's hybrid, eta0 (1 + a p/q)^q exp[C p/(p1 - p)] [Pa s].

    Args:
        pressure: p above ambient [Pa].
        temperature_rise: T - T0 [K].
        viscosity: eta0 at ambient pressure and T0 [Pa s].
        pressure_viscosity: alpha there [1/Pa].
        temperature: T0 [K]; not asked for.
        viscosity_slope: -d ln eta0/dT there [1/K].
        mcewen_exponent: q [1].
        paluch_share: s, part of alpha by the second factor [1]; 0 leaves McEwen's law alone.
        divergence_pressure: p1 [Pa]; from 0.9 of it on the viscosity stays.

    a = (1 - s) alpha and C = s alpha p1, so that alpha is the slope of ln eta at p = 0; constants printed as
    a, q, C, p1 have alpha = a + C/p1 and s = C/(alpha p1). The first factor, McEwen's, rises more slowly than
    exponentially, the second, Paluch's, faster. Heat counts by exp(-slope (T - T0)) at every pressure, so
    that warm oil under pressure is too stiff.

    Validity: the constants belong to one oil at one temperature. The usual ones are fitted to the correlation
    of a gear oil at 60 degC by Bair (2019), within 2 % up to 1 GPa; at 0.5 GPa they are 0.66 of it at 50 degC
    and 1.9 times it at 80 degC, and four times the free volume of squalane at 40 degC. In print one set was
    found, of Paluch's factor alone: mineral oil 23D at 311 K, 27.8 fPa s exp(C p1/(p1 - p)) with C = 27.5 and
    p1 = 2.73 GPa, which is s = 1, alpha = C/p1 = 10.1 1/GPa and eta0 = 24.4 mPa s.

    Source: McEwen (1952) and Bair (2015), whose abstract names the hybrid; its form is recalled. Constants of
    mineral oil 23D: Encyclopedia of Tribology (2013).

    Example:
        >>> eta = bair_2015(
        ...     pressure=1e9, temperature_rise=0.0, viscosity=0.04, pressure_viscosity=2.2e-8,
        ...     temperature=313.15, viscosity_slope=0.04,
        ... )
        >>> round(float(eta))
        172742
    """
    del temperature
    most = _NEAREST_DIVERGENCE * divergence_pressure
    pressed = jnp.minimum(_bounded(pressure), most)
    base = 1.0 + (1.0 - paluch_share) * pressure_viscosity * pressed / mcewen_exponent
    power = mcewen_exponent * jnp.log(jnp.maximum(base, _LEAST_BASE))
    steep = paluch_share * pressure_viscosity * divergence_pressure * pressed
    steep = steep / (divergence_pressure - pressed)
    return viscosity * jnp.exp(power + steep - viscosity_slope * temperature_rise)


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
    compressed_index: Each = jnp.sqrt((1.0 + 2.0 * refraction) / (1.0 - refraction))
    return compressed_index


def newtonian(*, viscosity: Each, shear_rate: Each, pressure: Each, temperature_rise: Each) -> Each:
    """Shear stress eta gamma of a Newtonian oil [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign [1/s].
        pressure: p [Pa]; not asked for.
        temperature_rise: above the inlet [K]; not asked for.

    Source: Newton's definition of viscosity.
    """
    del pressure, temperature_rise
    return viscosity * shear_rate


def ree_eyring_1955(
    *,
    viscosity: Each,
    shear_rate: Each,
    pressure: Each,
    temperature_rise: Each,
    eyring_stress: Each | float = EYRING_STRESS,
) -> Each:
    """Shear stress tau_E asinh(eta gamma/tau_E) of an oil that thins under shear [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign [1/s].
        pressure: p [Pa]; not asked for.
        temperature_rise: above the inlet [K]; not asked for.
        eyring_stress: tau_E from which on it thins [Pa].

    Source: Ree and Eyring (1955), with one kind of unit; Johnson and Tevaarwerk (1977), equation 4.

    Example:
        >>> sheared = {"viscosity": 100.0, "shear_rate": 1e6, "pressure": 1e9, "temperature_rise": 0.0}
        >>> round(float(ree_eyring_1955(**sheared)))
        18447519
    """
    del pressure, temperature_rise
    return eyring_stress * jnp.arcsinh(viscosity * shear_rate / eyring_stress)


def bair_winer_1979(
    *,
    viscosity: Each,
    shear_rate: Each,
    pressure: Each,
    temperature_rise: Each,
    limiting_coefficient: Each | float = LIMITING_COEFFICIENT,
    limiting_stress: Each | float = LIMITING_STRESS,
    limiting_fall: Each | float = 0.0,
) -> Each:
    """Shear stress tau_L [1 - exp(-eta gamma/tau_L)] of an oil that bears tau_L at most [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign, which the stress has too [1/s].
        pressure: p [Pa].
        temperature_rise: above the inlet [K].
        limiting_coefficient: rise of tau_L with pressure [1].
        limiting_stress: tau_L without pressure [Pa].
        limiting_fall: relative fall of tau_L per kelvin [1/K].

    tau_L as in `limiting_shear_stress`. Source: Bair and Winer (1979), steady shear.

    Example:
        >>> sheared = {"viscosity": 100.0, "shear_rate": 1e6, "pressure": 1e9, "temperature_rise": 0.0}
        >>> round(float(bair_winer_1979(**sheared)))
        57779314
    """
    limit = limiting_shear_stress(
        pressure, temperature_rise, limiting_coefficient, limiting_stress, limiting_fall
    )
    drawn = viscosity * shear_rate / limit
    return limit * (jnp.expm1(jnp.minimum(drawn, 0.0)) - jnp.expm1(-jnp.maximum(drawn, 0.0)))


def limiting_shear_stress(
    pressure: Each,
    temperature_rise: Each,
    coefficient: Each | float = LIMITING_COEFFICIENT,
    stress: Each | float = LIMITING_STRESS,
    fall: Each | float = 0.0,
) -> Each:
    """Largest shear stress that an oil bears, (tau_0 + Lambda p) exp(-fall (T - T0)) [Pa].

    Args:
        pressure: p [Pa]; below zero it counts as zero.
        temperature_rise: T - T0, above the inlet [K].
        coefficient: Lambda [1].
        stress: tau_0, without which there would be no stress in the inlet, where oil is Newtonian [Pa].
        fall: relative fall per kelvin [1/K]; none unless given, for no figure of it was found.

    Source: Bair and Winer (1979) for the pressure; Habchi (2018), page 427, has 0.083 p for Shell T9 at every
    temperature. Wikstroem and Hoeglund (1994) measured a fall with temperature; the exponential is a choice.
    """
    pressed = jnp.where(jnp.asarray(pressure) > 0.0, pressure, 0.0)
    return (stress + coefficient * pressed) * jnp.exp(-fall * temperature_rise)


def carreau_1972(
    *,
    viscosity: Each,
    shear_rate: Each,
    pressure: Each,
    temperature_rise: Each,
    critical_stress: Each | float = CRITICAL_STRESS,
    shear_exponent: Each | float = SHEAR_EXPONENT,
    limiting_coefficient: Each | float = LIMITING_COEFFICIENT,
    limiting_stress: Each | float = LIMITING_STRESS,
    limiting_fall: Each | float = 0.0,
) -> Each:
    """Shear stress eta gamma [1 + (eta gamma/G)^2]^((n - 1)/2) of an oil that thins, tau_L at most [Pa].

    Args:
        viscosity: eta, that under pressure [Pa s].
        shear_rate: gamma, with its sign, which the stress has too [1/s].
        pressure: p [Pa].
        temperature_rise: above the inlet [K].
        critical_stress: G from which on it thins [Pa].
        shear_exponent: n [1].
        limiting_coefficient: rise of tau_L with pressure [1].
        limiting_stress: tau_L without pressure [Pa].
        limiting_fall: relative fall of tau_L per kelvin [1/K].

    tau_L as in `limiting_shear_stress`; the stress is cut there, as Habchi (2018), page 426, has it. It was
    held against no measured traction curve, for none was found in numbers.

    Source: Carreau (1972) with stress in the place of a relaxation time, in the form of Bair (2019).

    Example:
        >>> sheared = {"viscosity": 100.0, "shear_rate": 1e6, "pressure": 1e9, "temperature_rise": 0.0}
        >>> round(float(carreau_1972(**sheared)))
        23132370
    """
    limit = limiting_shear_stress(
        pressure, temperature_rise, limiting_coefficient, limiting_stress, limiting_fall
    )
    drawn = viscosity * shear_rate
    thins = 0.5 * (shear_exponent - 1.0) * jnp.log1p((drawn / critical_stress) ** 2)
    return jnp.clip(drawn * jnp.exp(thins), -limit, limit)
