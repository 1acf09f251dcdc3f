"""Hertz pressure of line and elliptic contacts."""

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Numbers, root

__all__ = ["elliptic_pressure", "line_half_width", "line_pressure"]

Each = Float[Numbers, "*#b"]


def line_half_width(*, line_load: Each, radius: Each, modulus: Each) -> Each:
    """Half-width of a line contact [m]: b = sqrt(8 w R / (pi E')).

    Args:
        line_load: normal load per length w [N/m], not negative.
        radius: relative radius of curvature R [m].
        modulus: E' [Pa] with 2/E' = sum of (1 - nu^2)/E over both members.

    Source: Johnson, Contact Mechanics (1985), eq. 4.43 (there E* = E'/2).

    Example:
        >>> half_width = line_half_width(line_load=1e5, radius=0.01, modulus=226.4e9)
        >>> round(float(half_width) * 1e6)
        106
    """
    found: Each = root(8.0 * line_load * radius / (jnp.pi * modulus))
    return found


def line_pressure(*, line_load: Each, radius: Each, modulus: Each) -> Each:
    """Largest pressure of a line contact [Pa]: p_H = sqrt(w E' / (2 pi R)).

    Args:
        line_load: normal load per length w [N/m], not negative.
        radius: relative radius of curvature R [m].
        modulus: E' [Pa] with 2/E' = sum of (1 - nu^2)/E over both members.

    Source: Johnson, Contact Mechanics (1985), eq. 4.45 (there E* = E'/2).

    Example:
        >>> pressure = line_pressure(line_load=1e5, radius=0.01, modulus=226.4e9)
        >>> round(float(pressure) / 1e6)
        600
    """
    found: Each = root(line_load * modulus / (2.0 * jnp.pi * radius))
    return found


def elliptic_pressure(
    *,
    load: Each,
    radius: Each,
    transverse_radius: Each,
    modulus: Each,
) -> Each:
    """Largest pressure of an elliptic contact [Pa], exact for a circle, within 3 % of Hertz otherwise.

    Args:
        load: normal load [N], not negative.
        radius: relative radius in the rolling direction R_x [m].
        transverse_radius: relative radius across it R_y [m].
        modulus: E' [Pa] with 2/E' = sum of (1 - nu^2)/E over both members.

    Valid for 0.01 <= R_y/R_x <= 100. Source: Hamrock and Brewe (1983), eqs. 1-8.

    Example: a steel ball of 19 mm on a disc.

        >>> pressure = elliptic_pressure(
        ...     load=30.0, radius=9.5e-3, transverse_radius=9.5e-3, modulus=226.4e9
        ... )
        >>> round(float(pressure) / 1e6)
        938
    """
    slender = jnp.maximum(transverse_radius / radius, radius / transverse_radius)
    small = jnp.minimum(radius, transverse_radius)
    ratio = slender ** (2.0 / jnp.pi)
    integral = 1.0 + (jnp.pi / 2.0 - 1.0) / slender
    combined = small * slender / (1.0 + slender)
    pressed = jnp.where(load > 0.0, load, 1.0)
    major = jnp.cbrt(6.0 * ratio**2 * integral * pressed * combined / (jnp.pi * modulus))
    return jnp.where(load > 0.0, 1.5 * pressed * ratio / (jnp.pi * major**2), 0.0)
