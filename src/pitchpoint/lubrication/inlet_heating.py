"""Heat by shear in the inlet of a contact: factors that thin a film and lower a rolling resistance.

Each is a function of the thermal loading L = beta eta0 u^2/k, with beta = -d ln eta0/dT, u the mean surface
speed and k the conductivity of the oil. Effects named `none` leave the isothermal law as it is.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, TypeVar

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers, product_array
from pitchpoint.lubrication.lubrication_registry import (
    FilmThickness,
    InletHeating,
    RollingResistance,
)

__all__ = [
    "Inlet",
    "aihara_1987",
    "murch_wilson_1975",
    "wilson_sheu_1983",
    "with_inlet_heating",
    "zhu_cheng_1988",
]

Each = Float[Numbers, "*#b"]
Inlet = TypeVar("Inlet", FilmThickness, RollingResistance)

_LEAST = 1e-12
"""Thermal loading below which powers are taken of it: its factor is one to 8 digits."""


def murch_wilson_1975(*, thermal_loading: Each) -> Each:
    """Factor of the film of a line contact in pure rolling, 1/(1 + 0.254 L^0.62) [1].

    Args:
        thermal_loading: L = beta eta0 u^2/k [1].

    Source: Murch and Wilson (1975), in the form of Wilson and Sheu (1983), equation 9.

    Example:
        >>> round(float(murch_wilson_1975(thermal_loading=1.0)), 4)
        0.7974
    """
    return 1.0 / (1.0 + 0.254 * _power(thermal_loading, 0.62))


def wilson_sheu_1983(*, thermal_loading: Each, slide_roll_ratio: Each) -> Each:
    """Factor of the film of a line contact that slides, 1/{1 + 0.241 (1 + 14.8 Z^0.83) L^0.64} [1].

    Args:
        thermal_loading: L = beta eta0 u^2/k [1].
        slide_roll_ratio: sliding over mean speed; Z = (u1 - u2)/(u1 + u2) is half of it [1].

    Source: Wilson and Sheu (1983), equation 7.

    Example:
        >>> round(float(wilson_sheu_1983(thermal_loading=1.0, slide_roll_ratio=0.5)), 4)
        0.422
    """
    sliding = 1.0 + 14.8 * _power(0.5 * product_array(slide_roll_ratio), 0.83)
    return 1.0 / (1.0 + 0.241 * sliding * _power(thermal_loading, 0.64))


def zhu_cheng_1988(
    *, thermal_loading: Each, slide_roll_ratio: Each, pressure: Each, modulus: Each
) -> Each:
    """Factor [1 - 13.2 (p_H/E') L^0.42]/[1 + 0.213 (1 + 2.23 S^0.83) L^0.64] of film and resistance [1].

    Args:
        thermal_loading: L = beta eta0 u^2/k [1].
        slide_roll_ratio: S, sliding over mean speed [1].
        pressure: p_H, largest Hertz pressure [Pa].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E.

    At high thermal loading the numerator falls below zero, which nothing supports: it is held at 0.1.
    Source: Zhu and Cheng (1988), as Zhou and Hoeprich (1991) give it in equation 21, on the resistance too.

    Example:
        >>> factor = zhu_cheng_1988(
        ...     thermal_loading=1.0, slide_roll_ratio=0.0, pressure=1e9, modulus=226.4e9,
        ... )
        >>> round(float(factor), 4)
        0.7763
    """
    squeezed = 1.0 - 13.2 * pressure / modulus * _power(thermal_loading, 0.42)
    sliding = 1.0 + 2.23 * _power(slide_roll_ratio, 0.83)
    heat = 1.0 + 0.213 * sliding * _power(thermal_loading, 0.64)
    return jnp.where(squeezed > 0.1, squeezed, 0.1) / heat


def aihara_1987(*, thermal_loading: Each) -> Each:
    """Factor of the rolling resistance of a line contact, 1/(1 + 0.29 L^0.78) [1].

    Args:
        thermal_loading: L = beta eta0 u^2/k, up to several tens [1].

    Approximates Goksem and Hargreaves (1978), and agrees with measurements on two discs.
    Source: Aihara (1987), equation 21.

    Example:
        >>> round(float(aihara_1987(thermal_loading=1.0)), 4)
        0.7752
    """
    return 1.0 / (1.0 + 0.29 * _power(thermal_loading, 0.78))


def _power(base: Each, exponent: float) -> Array:
    """A power below one, with a finite slope where its base is zero."""
    argument = jnp.asarray(base)
    some = argument > _LEAST
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.where(some, jnp.exp(exponent * jnp.log(jnp.where(some, argument, 1.0))), 0.0)


def with_inlet_heating(law: Inlet, heating: InletHeating) -> Inlet:
    """A law of film or of rolling resistance under the heat in the inlet; the law itself without any.

    Args:
        law: isothermal.
        heating: of `INLET_HEATING`.
    """
    factor = heating.film if isinstance(law, FilmThickness) else heating.rolling
    heated: Inlet = law if factor is None else _with(law, factor)
    return heated


@lru_cache(maxsize=64)
def _with(law: Any, factor: Callable[..., Array]) -> Any:
    """One record for each pair: another one of the same content would be another program."""
    return replace(law, heating=factor)
