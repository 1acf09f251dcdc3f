"""Wear laws by name: the volume that a flank loses per normal force and sliding distance.

A law takes SI values by keyword and returns the specific wear rate k of one member at a contact, in
1/Pa = m3/(N m): times the pressure it is the depth per sliding distance. It is a pure function, and all
its arguments broadcast.
"""

from collections.abc import Mapping
from types import MappingProxyType

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers, log, square_root
from pitchpoint.lubrication import conditions

__all__ = [
    "UNITS",
    "archard_1953",
    "janakiraman_2013",
    "masjedi_khonsari_2015",
    "vdi_2736",
]

Each = Float[Numbers, "*#b"]

_LEAST = 1e-30  # below any group of a contact, with logarithms that are finite

UNITS: Mapping[str, str] = MappingProxyType(
    {
        **conditions.UNITS,
        "coefficient": "1",
        "asperity_share": "1",
        "film_defect": "1",
        "ra_1": "m",
        "ra_2": "m",
        "rate": "1/Pa",
    }
)
"""Unit of everything that a wear law may ask for: conditions at a contact, and what belongs to wear alone."""


def archard_1953(*, coefficient: Each, hardness: Each) -> Float[Array, "..."]:
    """Specific wear rate of dry sliding, K/H [1/Pa].

    Args:
        coefficient: K of Archard, shape (...) [1].
        hardness: H of the member that wears, shape (...) [Pa].

    Returns:
        The rate, broadcast shape of the arguments [1/Pa].

    Source: Archard (1953); Zhao et al. (2022), equations 5 and 8.

    Example:
        >>> f"{float(archard_1953(coefficient=8.5e-6, hardness=1.96e9)):.3g}"
        '4.34e-15'
    """
    return jnp.asarray(coefficient) / hardness


def masjedi_khonsari_2015(
    *, coefficient: Each, hardness: Each, asperity_share: Each, film_defect: Each
) -> Float[Array, "..."]:
    """Specific wear rate of mixed lubrication, K/H psi L_a [1/Pa].

    Only the part of the load that asperities carry wears, and only where the adsorbed film is torn.

    Args:
        coefficient: K of dry sliding, shape (...) [1].
        hardness: H of the member that wears, shape (...) [Pa].
        asperity_share: L_a, part of the load on asperities, 0 to 1, shape (...) [1].
        film_defect: psi, part of the sites that are bare, 0 to 1, shape (...) [1].

    Returns:
        The rate, broadcast shape of the arguments [1/Pa].

    Source: Masjedi and Khonsari (2015), as Zhao et al. (2022) print it in equation 11.

    Example:
        >>> rate = masjedi_khonsari_2015(
        ...     coefficient=8.5e-6, hardness=1.96e9, asperity_share=0.5, film_defect=2e-3
        ... )
        >>> f"{float(rate):.3g}"
        '4.34e-18'
    """
    return archard_1953(coefficient=coefficient, hardness=hardness) * asperity_share * film_defect


def janakiraman_2013(
    *,
    line_load: Each,
    radius: Each,
    modulus: Each,
    pressure_viscosity: Each,
    ra_1: Each,
    ra_2: Each,
) -> Float[Array, "..."]:
    """Specific wear rate of lubricated steel rollers by a regression [1/Pa].

    3.981e29/E' L^1.219 G^-7.377 S^1.589 with L = w/(E' R), G = alpha E' and S = sqrt(Ra1^2 + Ra2^2)/R. It is
    K over hardness already, as its unit says, and was found with a lubricant between the rollers: neither a
    hardness nor a load ratio or film defect belongs on it.

    Args:
        line_load: w, shape (...) [N/m].
        radius: R, shape (...) [m].
        modulus: E', 2/E' = sum of (1 - nu^2)/E, shape (...) [Pa]; it serves for E* in front too.
        pressure_viscosity: alpha at the temperature of the oil, shape (...) [1/Pa].
        ra_1, ra_2: mean deviation of both flanks, shape (...) [m].

    Returns:
        The rate, broadcast shape of the arguments [1/Pa]; 0 of smooth or unloaded flanks.

    Validity:
        The range of the tests is not printed in what was at hand. It is very steep in G: from alpha of
        25 to 15 1/GPa the rate grows by a factor of 43.

    Source:
        Janakiraman (2013), as Zhao et al. (2022) print it in equations 29 to 31, with the squares that the
        dimension of the composite roughness asks for.

    Example:
        >>> rate = janakiraman_2013(
        ...     line_load=1e5, radius=0.01, modulus=226e9, pressure_viscosity=2e-8, ra_1=4e-7, ra_2=3e-7
        ... )
        >>> f"{float(rate):.3g}"
        '1.38e-21'
    """
    loaded = jnp.asarray(line_load) / (modulus * radius)
    rough = square_root(jnp.asarray(ra_1) ** 2 + jnp.asarray(ra_2) ** 2) / radius
    viscous = jnp.asarray(pressure_viscosity) * modulus
    total = (
        jnp.log(3.981e29)
        + 1.219 * log(loaded, _LEAST)
        - 7.377 * log(viscous, _LEAST)
        + 1.589 * log(rough, _LEAST)
    )
    return jnp.where((loaded > _LEAST) & (rough > _LEAST), jnp.exp(total), 0.0) / modulus


def vdi_2736(*, rate: Each) -> Float[Array, "..."]:
    """Specific wear rate by value, k_w of plastic gears [1/Pa].

    Args:
        rate: k_w of the pair of materials, their mate's roughness and lubrication, shape (...) [1/Pa];
            tables have it in 1e-6 mm3/(N m), which is 1e-15 1/Pa.

    Returns:
        The rate as an array [1/Pa].

    Source: VDI 2736 Part 2 (2014), k_w.

    Example:
        >>> float(vdi_2736(rate=1.03e-15))
        1.03e-15
    """
    return jnp.asarray(rate, dtype=float)
