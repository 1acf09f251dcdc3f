"""Flank pressure and what limits it, after ISO 6336-2:2019, method B.

The standard itself was not at hand. Formulas are those on which IACS UR M56 Rev.4, which cites it, and public
programs agree, and which give the factors that STplus and the FVA Workbench print; see the tests.
"""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = [
    "NO_MODIFICATION",
    "contact_ratio_factor",
    "elasticity_factor",
    "helix_factor",
    "lubricant_factor",
    "nominal_contact_stress",
    "roughness_factor",
    "single_contact_factor",
    "size_factor",
    "velocity_factor",
    "zone_factor",
]

Each = Float[Numbers, "*#b"]
Found = Float[Array, "..."]

NO_MODIFICATION = 1.2
"""Correction f_ZCa of helical gears whose profile modification is not known to suit the load."""


def zone_factor(
    *, base_helix_angle: Each, transverse_pressure_angle: Each, working_pressure_angle: Each
) -> Found:
    """Zone factor Z_H: curvature of the flanks at the pitch point [1].

    Args:
        base_helix_angle: beta_b, shape (...) [rad].
        transverse_pressure_angle: alpha_t, shape (...) [rad].
        working_pressure_angle: alpha_wt, shape (...) [rad].

    Source: ISO 6336-2:2019; IACS UR M56 Rev.4 (2021), 2.4.

    Example:
        >>> from math import radians
        >>> factor = zone_factor(base_helix_angle=0.0, transverse_pressure_angle=radians(20.0),
        ...     working_pressure_angle=radians(22.43879))
        >>> round(float(factor), 3)
        2.342
    """
    curved = jnp.cos(transverse_pressure_angle) ** 2 * jnp.tan(working_pressure_angle)
    return jnp.sqrt(2.0 * jnp.cos(base_helix_angle) / curved)


def elasticity_factor(*, young_1: Each, poisson_1: Each, young_2: Each, poisson_2: Each) -> Found:
    """Elasticity factor Z_E = 1/sqrt(pi ((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2)) [sqrt(Pa)].

    Args:
        young_1, young_2: Young's moduli, shape (...) [Pa].
        poisson_1, poisson_2: Poisson's ratios, shape (...) [1].

    Source: ISO 6336-2:2019.

    Example:
        >>> factor = elasticity_factor(young_1=206e9, poisson_1=0.3, young_2=206e9, poisson_2=0.3)
        >>> round(float(factor) / 1e3, 1)  # sqrt(N/mm2)
        189.8
    """
    soft = (1.0 - jnp.asarray(poisson_1) ** 2) / young_1 + (
        1.0 - jnp.asarray(poisson_2) ** 2
    ) / young_2
    return 1.0 / jnp.sqrt(jnp.pi * soft)


def contact_ratio_factor(*, transverse_contact_ratio: Each, overlap_ratio: Each) -> Found:
    """Contact ratio factor Z_eps: length of the contact lines [1].

    Args:
        transverse_contact_ratio: eps_alpha, shape (...) [1].
        overlap_ratio: eps_beta; above 1 as 1, shape (...) [1].

    Source: ISO 6336-2:2019; IACS UR M56 Rev.4 (2021), 2.6.

    Example:
        >>> factor = contact_ratio_factor(transverse_contact_ratio=1.436, overlap_ratio=0.0)
        >>> round(float(factor), 3)
        0.924
    """
    ratio, overlap = jnp.asarray(transverse_contact_ratio), jnp.clip(overlap_ratio, 0.0, 1.0)
    return jnp.sqrt((4.0 - ratio) / 3.0 * (1.0 - overlap) + overlap / ratio)


def helix_factor(*, helix_angle: Each) -> Found:
    """Helix angle factor Z_beta = 1/sqrt(cos(beta)) [1].

    Args:
        helix_angle: beta on the reference cylinders, shape (...) [rad].

    Source: ISO 6336-2:2019; IACS UR M56 Rev.4 (2021), 2.7. Before its corrigendum of 2008 the edition of 2006
    had the inverse.

    Example:
        >>> from math import radians
        >>> round(float(helix_factor(helix_angle=radians(20.0))), 3)
        1.032
    """
    return 1.0 / jnp.sqrt(jnp.cos(helix_angle))


def nominal_contact_stress(
    *,
    zone: Each,
    elasticity: Each,
    contact_ratio: Each,
    helix: Each,
    force: Each,
    diameter: Each,
    face_width: Each,
    ratio: Each,
) -> Found:
    """Nominal contact stress at the pitch point sigma_H0 [Pa].

    Args:
        zone, contact_ratio, helix: Z_H, Z_eps, Z_beta, shape (...) [1].
        elasticity: Z_E, shape (...) [sqrt(Pa)].
        force: F_t at the reference circles, shape (...) [N].
        diameter: d_1 of the reference circle of gear 1, shape (...) [m].
        face_width: b, common to both, shape (...) [m].
        ratio: u = z_2/z_1, negative for a ring, shape (...) [1].

    Source: ISO 6336-2:2019; IACS UR M56 Rev.4 (2021), 2.2.1.

    Example:
        >>> stress = nominal_contact_stress(zone=2.342, elasticity=191.6e3, contact_ratio=0.9243, helix=1.0,
        ...     force=3611.1, diameter=72e-3, face_width=14e-3, ratio=1.5)
        >>> round(float(stress) / 1e6)
        1013
    """
    load = jnp.asarray(force) / (jnp.asarray(diameter) * face_width)
    return zone * elasticity * contact_ratio * helix * jnp.sqrt(load * (1.0 + 1.0 / ratio))


def single_contact_factor(
    *,
    own_end: Each,
    own_teeth: Each,
    other_end: Each,
    other_teeth: Each,
    working_pressure_angle: Each,
    transverse_contact_ratio: Each,
    overlap_ratio: Each,
    correction: Each | float = NO_MODIFICATION,
) -> Found:
    """Single pair contact factor, Z_B of gear 1 or Z_D of gear 2: where one pair begins to carry [1].

    Args:
        own_end, other_end: sqrt((d/d_b)^2 - 1) of the gear and its mate where the path of contact ends, at
            the tip d_a unless an undercut of the other one ends it before, shape (...) [1].
        own_teeth, other_teeth: z, negative for a ring, shape (...) [1].
        working_pressure_angle: alpha_wt, shape (...) [rad].
        transverse_contact_ratio: eps_alpha; above 2 that of spur gears is 1, shape (...) [1].
        overlap_ratio: eps_beta; above 1 as 1, shape (...) [1].
        correction: f_ZCa of helical gears, shape (...) [1].

    Source: ISO 6336-2:2019, M_1 and M_2 of clause 6 and the square root of f_ZCa for helical gears; IACS UR
    M56 Rev.4 (2021), 2.3, has 1 there, as the edition of 2006.

    Example:
        >>> from math import radians, sqrt
        >>> factor = single_contact_factor(own_end=sqrt((82.45 / 67.658) ** 2 - 1.0), own_teeth=16.0,
        ...     other_end=sqrt((118.35 / 101.487) ** 2 - 1.0), other_teeth=24.0,
        ...     working_pressure_angle=radians(22.43879), transverse_contact_ratio=1.436, overlap_ratio=0.0)
        >>> round(float(factor), 3)
        1.075
    """
    ratio, overlap = jnp.asarray(transverse_contact_ratio), jnp.clip(overlap_ratio, 0.0, 1.0)
    own = own_end - 2.0 * jnp.pi / own_teeth
    other = other_end - (ratio - 1.0) * 2.0 * jnp.pi / other_teeth
    curved = jnp.maximum(own * other, 1e-12)
    spur = jnp.maximum(jnp.tan(working_pressure_angle) / jnp.sqrt(curved), 1.0)
    spur = jnp.where(ratio > 2.0, 1.0, spur)
    return spur + overlap * (jnp.sqrt(correction) - spur)


def _softness(limit: Each, low: float, high: float) -> Found:
    """A constant that falls or rises with sigma_Hlim from 850 to 1200 MPa."""
    place = jnp.clip((jnp.asarray(limit) / 1e6 - 850.0) / 350.0, 0.0, 1.0)
    return low + place * (high - low)


def lubricant_factor(*, viscosity: Each, limit: Each) -> Found:
    """Lubricant factor Z_L [1].

    Args:
        viscosity: nominal kinematic viscosity at 40 degC nu_40, shape (...) [m2/s].
        limit: sigma_Hlim of the softer gear, shape (...) [Pa].

    Source: ISO 6336-2:2019, eq. 42; IACS UR M56 Rev.4 (2021), 2.10 a.

    Example:
        >>> round(float(lubricant_factor(viscosity=90.02e-6, limit=1510e6)), 3)
        0.96
    """
    constant = _softness(limit, 0.83, 0.91)
    return constant + 4.0 * (1.0 - constant) / (1.2 + 134.0 / (1e6 * jnp.asarray(viscosity))) ** 2


def velocity_factor(*, speed: Each, limit: Each) -> Found:
    """Velocity factor Z_v [1].

    Args:
        speed: v at the reference circles, shape (...) [m/s].
        limit: sigma_Hlim of the softer gear, shape (...) [Pa].

    Source: ISO 6336-2:2019, eq. 47; IACS UR M56 Rev.4 (2021), 2.10 b.

    Example:
        >>> round(float(velocity_factor(speed=5.749, limit=1510e6)), 3)
        0.985
    """
    constant = _softness(limit, 0.85, 0.93)
    return constant + 2.0 * (1.0 - constant) / jnp.sqrt(0.8 + 32.0 / jnp.asarray(speed))


def roughness_factor(*, roughness: Each, radius: Each, limit: Each) -> Found:
    """Roughness factor Z_R [1].

    Args:
        roughness: mean Rz of both flanks, shape (...) [m].
        radius: relative radius of curvature at the pitch point in the transverse section, shape (...) [m].
        limit: sigma_Hlim of the softer gear, shape (...) [Pa].

    Source: ISO 6336-2:2019, eq. 53; IACS UR M56 Rev.4 (2021), 2.10 c.

    Example:
        >>> round(float(roughness_factor(roughness=18e-6, radius=5.91e-3, limit=1500e6)), 3)
        0.854
    """
    relative = 1e6 * jnp.asarray(roughness) * (10.0 / (1e3 * jnp.asarray(radius))) ** (1.0 / 3.0)
    return (3.0 / relative) ** _softness(limit, 0.15, 0.08)


def size_factor(*, module: Each, a: Each, b: Each, least: Each) -> Found:
    """Size factor of the flank Z_X = a - b m_n with m_n in mm, from `least` to 1 [1].

    Args:
        module: normal module m_n, shape (...) [m].
        a, b, least: constants of the material, shape (...) [1].

    Source: DIN 3990-11:1989, table 4.2: case-hardened gears above m_n = 10 mm, nitrided ones above 7.5 mm.
    Public programs give the former as ISO 6336-2:2006 too; KISSsoft 03/2017 prints 1 by ISO 6336:2006 for
    case-hardened gears of m_n = 14 and 45 mm.

    Example:
        >>> round(float(size_factor(module=16e-3, a=1.05, b=0.005, least=0.9)), 3)
        0.97
    """
    return jnp.clip(a - b * 1e3 * jnp.asarray(module), least, 1.0)
