"""Stress at the root of plastic teeth after VDI 2736 Part 2.

Equation 10 was taken from one public program (tkuhn39 2026), whose tests hold it against the report of a
commercial program; the guideline itself was not at hand. It is the stress of DIN 3990 method C, with the
force at the tip. The limit is Y_St sigma_FlimN with Y_St = 2, equation 13, in that program and in GEARpie.
"""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = ["contact_ratio_factor", "helix_factor"]

Each = Float[Numbers, "*#b"]
Found = Float[Array, "..."]


def contact_ratio_factor(*, virtual_contact_ratio: Each) -> Found:
    """Contact ratio factor Y_eps = 0.25 + 0.75/eps_alpha_n of a force at the tip [1].

    Args:
        virtual_contact_ratio: eps_alpha_n, eps_alpha of spur gears, shape (...) [1].

    Source: DIN 3990-3:1987; VDI 2736 Part 2 (2014) for spur gears.

    Example:
        >>> round(float(contact_ratio_factor(virtual_contact_ratio=1.154)), 2)
        0.9
    """
    return 0.25 + 0.75 / jnp.asarray(virtual_contact_ratio)


def helix_factor(*, helix_angle: Each, overlap_ratio: Each) -> Found:
    """Helix angle factor Y_beta = 1 - eps_beta beta/120 deg [1].

    Args:
        helix_angle: beta on the reference cylinders; above 30 deg as 30 deg, shape (...) [rad].
        overlap_ratio: eps_beta; above 1 as 1, shape (...) [1].

    Source: DIN 3990-3:1987; IACS UR M56 Rev.4 (2021), 3.5.

    Example:
        >>> from math import radians
        >>> round(float(helix_factor(helix_angle=radians(30.0), overlap_ratio=1.0)), 3)
        0.75
    """
    beta = jnp.rad2deg(jnp.minimum(helix_angle, jnp.pi / 6.0))
    return 1.0 - jnp.minimum(overlap_ratio, 1.0) * beta / 120.0
