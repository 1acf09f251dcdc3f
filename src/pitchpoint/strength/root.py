"""Stress at the tooth root and its factors, after ISO 6336-3:2019, method B.

The standard itself was not at hand. Formulas are those on which public programs and IACS UR M56 Rev.4, which
cites it, agree, and which give the sections and factors that STplus and the FVA Workbench print, see the
tests.
"""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.gears.involute import involute

__all__ = [
    "THINNEST_RIM",
    "THINNEST_RING",
    "LoadPoint",
    "RootSection",
    "bending_arm",
    "deep_tooth_factor",
    "form_factor",
    "helix_factor",
    "load_distribution_factor",
    "load_point",
    "nominal_root_stress",
    "notch_parameter",
    "pinion_cut_section",
    "rack_section",
    "rim_factor",
    "ring_rim_factor",
    "ring_section",
    "stress_correction_factor",
]

Each = Float[Numbers, "*#b"]
Found = Float[Array, "..."]

# A fixed number, so that it has derivatives and runs in batches: racks of 10 to 1000 teeth with profile
# shifts of -0.6 to 1 take four steps at most to the last digit (216 tried).
_STEPS = 12

THINNEST_RIM, THINNEST_RING = 0.5, 1.75
"""Rim thickness over tooth height, of a ring over the module, down to which Y_B is known."""


class RootSection(eqx.Module):
    """Critical section of a tooth in the normal section.

    Attributes:
        chord: s_Fn between both fillets [m].
        distance: of the section from the axis of the virtual gear, along the middle of the tooth [m].
        fillet_radius: rho_F there [m].

    Source: ISO 6336-3:2019, section where tangents make 30 degrees with the middle of the tooth, 60 in a
    ring.
    """

    chord: Found
    distance: Found
    fillet_radius: Found


class LoadPoint(eqx.Module):
    """Where the normal force of a flank crosses the middle of its tooth, in the normal section.

    Attributes:
        angle: alpha_Fen between the force and the perpendicular to the middle [rad].
        distance: from the axis of the virtual gear, negative for a ring [m].

    Source: ISO 6336-3:2019, load direction angle.
    """

    angle: Found
    distance: Found


def rack_section(
    *,
    virtual_teeth: Each,
    module: Each,
    pressure_angle: Each,
    dedendum: Each,
    tip_radius: Each,
    generating_shift: Each,
) -> RootSection:
    """Section of a tooth cut by a rack, where tangents to the fillets make 30 degrees with its middle.

    Args:
        virtual_teeth: z_n, shape (...) [1].
        module: normal module m_n, shape (...) [m].
        pressure_angle: of the rack alpha_n, shape (...) [rad].
        dedendum: h_fP of the rack's gear, in modules, shape (...) [1].
        tip_radius: rho_fP of the rack's corner, in modules, shape (...) [1].
        generating_shift: x_E with which the teeth are cut, shape (...) [1].

    Returns:
        The section, broadcast shape of the arguments.

    Source: ISO 6336-3:2019, eqs. 26 to 31 (E, G, H, theta, s_Fn, rho_F), without protuberance.

    Example:
        >>> from math import radians
        >>> section = rack_section(virtual_teeth=51.0, module=1.0, pressure_angle=radians(20.0),
        ...     dedendum=1.1, tip_radius=0.2, generating_shift=-0.2030)
        >>> round(float(section.chord), 3), round(float(section.fillet_radius), 3)
        (2.068, 0.404)
    """
    sine, cosine = jnp.sin(pressure_angle), jnp.cos(pressure_angle)
    corner = jnp.pi / 4.0 - dedendum * sine / cosine - (1.0 - sine) * tip_radius / cosine  # E/m_n
    depth = tip_radius - jnp.asarray(dedendum) + generating_shift  # G
    offset = 2.0 / jnp.asarray(virtual_teeth) * (jnp.pi / 2.0 - corner) - jnp.pi / 3.0  # H
    theta = _turn(2.0 * depth / virtual_teeth, offset)
    rounded = depth / jnp.cos(theta) - tip_radius
    chord = virtual_teeth * jnp.sin(jnp.pi / 3.0 - theta) + jnp.sqrt(3.0) * rounded
    distance = (virtual_teeth * jnp.cos(jnp.pi / 3.0 - theta) + rounded) / 2.0
    bent = jnp.cos(theta) * (virtual_teeth * jnp.cos(theta) ** 2 - 2.0 * depth)
    radius = tip_radius + 2.0 * depth**2 / bent
    return RootSection(module * chord, module * distance, module * radius)


def _turn(slope: Each, offset: Each) -> Found:
    """Root of theta = slope tan(theta) - offset, by steps of Newton from 30 degrees."""
    theta = jnp.full(jnp.broadcast_shapes(jnp.shape(slope), jnp.shape(offset)), jnp.pi / 6.0)
    for _ in range(_STEPS):
        missing = theta - slope * jnp.tan(theta) + offset
        theta = theta - missing / (1.0 - slope / jnp.cos(theta) ** 2)
    return theta


def ring_section(*, half_chord: Each, distance: Each, fillet_radius: Each) -> RootSection:
    """Section of a ring's tooth, where tangents to the fillets make 60 degrees with its middle.

    Args:
        half_chord: from the middle of the tooth to the fillet there, shape (...) [m].
        distance: of that place from the axis along the middle of the tooth, shape (...) [m].
        fillet_radius: of the fillet there, shape (...) [m].

    Returns:
        The section as measured on the fillet that the ring has, whatever tool cut it.

    Source: ISO 6336-3:2019, 6.1, for the angle; its own formulas follow from a pinion cutter.
    """
    return RootSection(
        2.0 * jnp.asarray(half_chord), jnp.asarray(distance), jnp.asarray(fillet_radius)
    )


def pinion_cut_section(
    *,
    virtual_teeth: Each,
    module: Each,
    pressure_angle: Each,
    dedendum: Each,
    tip_radius: Each,
    generating_shift: Each,
    cutter_teeth: Each,
    cutter_shift: Each,
) -> RootSection:
    """Section of a ring's tooth by a pinion cutter, where tangents to the fillets make 60 degrees.

    The cutter counts as a rack whose corners are rounder. A cutter of 30 teeth with corners of 0.3 modules
    leaves a ring of 93 teeth a root 1.3 % thicker and 11 % sharper than this section; its stress is 3.6 %
    higher.

    Args:
        virtual_teeth: z_n of the ring without its sign, shape (...) [1].
        module: normal module m_n, shape (...) [m].
        pressure_angle: alpha_n, shape (...) [rad].
        dedendum: h_fP of the ring, in modules, shape (...) [1].
        tip_radius: of the corners of the cutter, in modules, shape (...) [1].
        generating_shift: x_E with which the teeth are cut, shape (...) [1].
        cutter_teeth: z_0, shape (...) [1].
        cutter_shift: x_0, shape (...) [1].

    Source: ISO 6336-3:2006 with its corrigendum of 2007, rho_fPv and the formulas for internal gears, as
    KISSsoft 03/2017 prints their values.

    Example:
        >>> from math import radians
        >>> section = pinion_cut_section(virtual_teeth=93.0, module=21.0, pressure_angle=radians(20.0),
        ...     dedendum=1.25, tip_radius=0.3, generating_shift=0.1171, cutter_teeth=30.0, cutter_shift=0.0)
        >>> round(float(section.chord), 2), round(float(section.fillet_radius), 2)
        (56.76, 8.78)
    """
    sine, cosine = jnp.sin(pressure_angle), jnp.cos(pressure_angle)
    added = jnp.maximum(cutter_shift + jnp.asarray(dedendum) - tip_radius, 0.0) ** 1.95
    rounding = tip_radius + added / (3.156 * 1.036 ** jnp.asarray(cutter_teeth))  # rho_fPv
    corner = jnp.pi / 4.0 - dedendum * sine / cosine - (1.0 - sine) * rounding / cosine
    depth = rounding - jnp.asarray(dedendum) + generating_shift
    teeth = -jnp.asarray(virtual_teeth)
    offset = 2.0 / teeth * (jnp.pi / 2.0 - corner) - jnp.pi / 6.0
    theta = _turn(2.0 * depth / teeth, offset)
    rounded = depth / jnp.cos(theta) - rounding
    chord = teeth * jnp.sin(jnp.pi / 6.0 - theta) + rounded
    distance = -(teeth * jnp.cos(jnp.pi / 6.0 - theta) + jnp.sqrt(3.0) * rounded) / 2.0
    bent = jnp.cos(theta) * (virtual_teeth * jnp.cos(theta) ** 2 - 2.0 * depth)
    return RootSection(
        module * chord, module * distance, module * (rounding + 2.0 * depth**2 / bent)
    )


def load_point(
    *,
    virtual_teeth: Each,
    module: Each,
    pressure_angle: Each,
    profile_shift: Each,
    end_height: Each,
    base_pitches: Each,
) -> LoadPoint:
    """Where the force at a point of the flank crosses the middle of the tooth.

    Args:
        virtual_teeth: z_n, negative for a ring, shape (...) [1].
        module: normal module m_n, shape (...) [m].
        pressure_angle: alpha_n, shape (...) [rad].
        profile_shift: x of the thickness of the teeth, shape (...) [1].
        end_height: r_a - r, signed as the radii; of the end of the path of contact where an undercut of the
            mate ends it below the tip, shape (...) [m].
        base_pitches: from there down to the point, in normal base pitches: eps_alpha_n - 1 down to where
            one pair begins to carry, 0 at that end, shape (...) [1].

    Returns:
        Angle and place, broadcast shape of the arguments.

    Source: ISO 6336-3:2019, method B, d_en, alpha_en, gamma_e and alpha_Fen.

    Example:
        >>> from math import degrees, radians
        >>> point = load_point(virtual_teeth=51.0, module=1.0, pressure_angle=radians(20.0),
        ...     profile_shift=-0.2030, end_height=0.947, base_pitches=0.154)
        >>> round(degrees(float(point.angle)), 2)
        23.22
    """
    side = jnp.sign(jnp.asarray(virtual_teeth))
    reference = virtual_teeth * jnp.asarray(module) / 2.0
    base = reference * jnp.cos(pressure_angle)
    end = jnp.sqrt((reference + end_height) ** 2 - base**2)
    pitch = jnp.pi * module * jnp.cos(pressure_angle)
    at = end - side * jnp.maximum(base_pitches, 0.0) * pitch
    pressure = jnp.arctan(at / jnp.abs(base))
    thickness = (jnp.pi / 2.0 + 2.0 * profile_shift * jnp.tan(pressure_angle)) / virtual_teeth
    gamma = thickness + involute(jnp.asarray(pressure_angle)) - involute(pressure)
    angle = pressure - gamma
    return LoadPoint(angle, base / jnp.cos(angle))  # the force is tangent to the base circle


def load_distribution_factor(*, virtual_contact_ratio: Each, overlap_ratio: Each) -> Found:
    """Load distribution factor f_eps of the tooth form factor [1].

    Args:
        virtual_contact_ratio: eps_alpha_n = eps_alpha/cos^2(beta_b), shape (...) [1].
        overlap_ratio: eps_beta, shape (...) [1].

    Source: ISO 6336-3:2019, eqs. 10 to 14; the edition of 2006 has no such factor.

    Example:
        >>> factor = load_distribution_factor(virtual_contact_ratio=1.703, overlap_ratio=1.1)
        >>> round(float(factor), 3)
        0.766
    """
    ratio, overlap = jnp.asarray(virtual_contact_ratio), jnp.asarray(overlap_ratio)
    several = ratio >= 2.0
    partly = jnp.sqrt(
        jnp.where(several, 0.5, 1.0) * (1.0 - jnp.clip(overlap, 0.0, 1.0))
        + jnp.clip(overlap, 0.0, 1.0) / ratio
    )
    return jnp.where(overlap > 0.0, partly, jnp.where(several, 0.7, 1.0))


def form_factor(
    *, section: RootSection, load: LoadPoint, module: Each, pressure_angle: Each
) -> Found:
    """Tooth form factor of a force on the flank, 6 (h/m_n) cos(alpha_Fen)/((s_Fn/m_n)^2 cos(alpha_n)) [1].

    Args:
        section: of the root.
        load: where the force acts; at the outer point of single contact it gives Y_F, at the tip Y_Fa.
        module: normal module m_n, shape (...) [m].
        pressure_angle: alpha_n, shape (...) [rad].

    Source: ISO 6336-3:2019, method B, where Y_F is this times f_eps, see `load_distribution_factor`.
    """
    arm = bending_arm(section, load) / module
    chord = section.chord / module
    return 6.0 * arm * jnp.cos(load.angle) / (chord**2 * jnp.cos(pressure_angle))


def bending_arm(section: RootSection, load: LoadPoint) -> Found:
    """Bending moment arm h_Fe, from the section to where the force crosses the middle of the tooth [m].

    Source: ISO 6336-3:2019, bending moment arm.
    """
    return jnp.abs(jnp.abs(load.distance) - section.distance)


def notch_parameter(section: RootSection) -> Found:
    """Notch parameter q_s = s_Fn/(2 rho_F) [1].

    Source: ISO 6336-3:2019, notch parameter.
    """
    return section.chord / (2.0 * section.fillet_radius)


def stress_correction_factor(*, section: RootSection, load: LoadPoint) -> Found:
    """Stress correction factor, (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L)) with L = s_Fn/h_Fe [1].

    Args:
        section: of the root.
        load: where the force acts; at the outer point of single contact it gives Y_S, at the tip Y_Sa.

    Validity:
        Notch parameters q_s from 1 to 8; derived from external spur gears of 20 deg.

    Source: ISO 6336-3:2019, 7.2; IACS UR M56 Rev.4 (2021), 3.4.
    """
    slender = section.chord / bending_arm(section, load)
    power = 1.0 / (1.21 + 2.3 / slender)
    return (1.2 + 0.13 * slender) * notch_parameter(section) ** power


def helix_factor(
    *, helix_angle: Each, overlap_ratio: Each, before_2019: Each | float = 0.0
) -> Found:
    """Helix angle factor of the root Y_beta = (1 - eps_beta beta/120 deg)/cos^3(beta) [1].

    Args:
        helix_angle: beta on the reference cylinders; above 30 deg as 30 deg, shape (...) [rad].
        overlap_ratio: eps_beta; above 1 as 1, shape (...) [1].
        before_2019: 1 for the edition of 2006, else 0, shape (...) [1].

    Source: ISO 6336-3:2019, eqs. 66, 67; without the cosine in the edition of 2006 and in IACS UR M56 Rev.4.

    Example:
        >>> from math import radians
        >>> round(float(helix_factor(helix_angle=radians(30.0), overlap_ratio=1.0)), 4)
        1.1547
    """
    beta = jnp.minimum(helix_angle, jnp.pi / 6.0)
    newer = jnp.where(jnp.asarray(before_2019) > 0.0, 1.0, 1.0 / jnp.cos(beta) ** 3)
    return (1.0 - jnp.minimum(overlap_ratio, 1.0) * jnp.rad2deg(beta) / 120.0) * newer


def rim_factor(*, backup: Each) -> Found:
    """Rim thickness factor Y_B of an external gear, 1.6 ln(2.242 h/s_R) below s_R/h = 1.2 [1].

    Args:
        backup: s_R/h, thickness of the rim under the teeth over their height, shape (...) [1].

    Validity:
        s_R/h above 0.5; at and below, the value at 0.5 stands and thinner rims are to be avoided.

    Source: ISO 6336-3:2019, clause 9; IACS UR M56 Rev.4 (2021), 3.6.

    Example:
        >>> round(float(rim_factor(backup=0.8)), 3)
        1.649
    """
    backup = jnp.maximum(backup, THINNEST_RIM)
    return jnp.where(backup < 1.2, 1.6 * jnp.log(2.242 / backup), 1.0)


def ring_rim_factor(*, backup: Each) -> Found:
    """Rim thickness factor Y_B of a ring, 1.15 ln(8.324 m_n/s_R) below s_R/m_n = 3.5 [1].

    Args:
        backup: s_R/m_n, thickness of the rim behind the teeth over the normal module, shape (...) [1].

    Validity:
        s_R/m_n above 1.75; at and below, the value at 1.75 stands and thinner rims are to be avoided.

    Source: ISO 6336-3:2019, clause 9; IACS UR M56 Rev.4 (2021), 3.6.

    Example:
        >>> round(float(ring_rim_factor(backup=2.5)), 3)
        1.383
    """
    backup = jnp.maximum(backup, THINNEST_RING)
    return jnp.where(backup < 3.5, 1.15 * jnp.log(8.324 / backup), 1.0)


def deep_tooth_factor(*, virtual_contact_ratio: Each, accurate: Each) -> Found:
    """Deep tooth factor Y_DT: 2.366 - 0.666 eps_alpha_n from 2.05 to 2.5, 0.7 above [1].

    Args:
        virtual_contact_ratio: eps_alpha_n, shape (...) [1].
        accurate: 1 for gears of class 4 of ISO 1328-1 or better, whose factor may not be 1, shape (...) [1].

    Source: ISO 6336-3:2019, clause 10; IACS UR M56 Rev.4 (2021), 3.7.

    Example:
        >>> round(float(deep_tooth_factor(virtual_contact_ratio=2.3, accurate=1.0)), 3)
        0.834
    """
    ratio = jnp.asarray(virtual_contact_ratio)
    deep = jnp.where(ratio > 2.5, 0.7, jnp.minimum(2.366 - 0.666 * ratio, 1.0))
    return jnp.where((jnp.asarray(accurate) > 0.0) & (ratio > 2.05), deep, 1.0)


def nominal_root_stress(*, force: Each, face_width: Each, module: Each, factors: Each) -> Found:
    """Nominal root stress sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B Y_DT [Pa].

    Args:
        force: F_t at the reference circles, shape (...) [N].
        face_width: b, shape (...) [m].
        module: normal module m_n, shape (...) [m].
        factors: product of the factors, shape (...) [1].

    Source: ISO 6336-3:2019; IACS UR M56 Rev.4 (2021), 3.2.1.

    Example:
        >>> stress = nominal_root_stress(force=384.6, face_width=17e-3, module=1e-3, factors=2.417 * 1.819)
        >>> round(float(stress) / 1e6, 1)
        99.5
    """
    return jnp.asarray(force) / (jnp.asarray(face_width) * module) * factors
