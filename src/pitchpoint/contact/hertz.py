"""Line contacts of two solids: half-width, pressure, and the shear below the surface."""

from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers, square_root

__all__ = ["line_half_width", "line_pressure", "line_shear"]

Each = Float[Numbers, "*#b"]

_DEPTH = 0.7861513777574233
"""Root of (1 + s^2)^3 = s^2 (2 + s^2)^2, the square root of the golden section."""

_SHEAR = 0.3002831060007762
"""Shear there over the largest pressure: s - s^2/sqrt(1 + s^2)."""


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
    half_width: Each = square_root(8.0 * line_load * radius / (jnp.pi * modulus))
    return half_width


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
    pressure: Each = square_root(line_load * modulus / (2.0 * jnp.pi * radius))
    return pressure


def line_shear(*, pressure: Each, half_width: Each) -> tuple[Each, Each]:
    """Largest shear stress below a line contact [Pa] and its depth [m], whatever Poisson's ratio.

    Args:
        pressure: largest one, p_H [Pa].
        half_width: b [m].

    Half the difference of the principal stresses at x = 0, p_H (s - s^2/sqrt(1 + s^2)) with s = z/b, at its
    largest where (1 + s^2)^(3/2) = s (2 + s^2). Source: Johnson, Contact Mechanics (1985), eqs. 4.46, 4.47.

    Example:
        >>> stress, depth = line_shear(pressure=1e9, half_width=1e-4)
        >>> round(stress / 1e9, 5), round(depth / 1e-4, 5)
        (0.30028, 0.78615)
    """
    return _SHEAR * pressure, _DEPTH * half_width
