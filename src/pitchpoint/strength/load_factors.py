"""Load factors of ISO 6336-1 that follow from a pair by a formula; all others are given by value."""

from collections.abc import Mapping, Sequence
from math import isnan, nan

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = [
    "CLASSES",
    "MOST_RESONANCE",
    "dynamic_factor",
    "dynamic_factor_by_resonance",
    "face_load_factor",
    "pinion_misalignment",
    "reduced_mass_per_width",
    "resonance_number",
    "root_face_load_factor",
    "running_in",
    "running_in_relief",
]

Each = Float[Numbers, "*#b"]
Both = Float[Numbers, "2 *#b"]
Found = Float[Array, "..."]

CLASSES: Mapping[int, tuple[float, float]] = {
    3: (2.1, 1.9),
    4: (3.9, 3.5),
    5: (7.5, 6.7),
    6: (14.9, 13.3),
    7: (26.8, 23.9),
    8: (39.1, 34.8),
}
"""K_1 of spur and helical gears by class of ISO 1328-1, for line loads in N/mm (IACS UR M56, table 1.1)."""

_SPUR, _HELICAL = 0.0193, 0.0087
_LEAST_LOAD = 100.0  # N/mm
_LEAST_COUNTED = 1e3  # N/m; without load the factor would have no end
_THIRD, _FALL = 2.071, 0.357

MOST_RESONANCE = _THIRD / (2.0 * _FALL)
"""Resonance number up to which K_v rises, 2.9 m/s: above it method C has no meaning, and K_v stays [m/s]."""


def resonance_number(*, speed: Each, teeth: Each, ratio: Each) -> Found:
    """Speed of a pair against its resonance, (v z_1/100) sqrt(u^2/(1 + u^2)) [m/s].

    Args:
        speed: v at the reference circles, shape (...) [m/s].
        teeth: z_1 of the pinion, shape (...) [1].
        ratio: u = z_2/z_1 of wheel over pinion, shape (...) [1].

    Source: IACS UR M56 Rev.4 (2021), 1.6.3, after ISO 6336-1 method C.

    Example:
        >>> round(float(resonance_number(speed=5.0, teeth=20.0, ratio=3.0)), 4)
        0.9487
    """
    squared = jnp.asarray(ratio) ** 2
    return speed * teeth / 100.0 * jnp.sqrt(squared / (1.0 + squared))


def dynamic_factor(
    *, resonance: Each, line_load: Each, overlap_ratio: Each, spur: Each, helical: Each
) -> Found:
    """Dynamic factor K_v of ISO 6336-1, method C [1].

    Args:
        resonance: see `resonance_number`; above `MOST_RESONANCE` as that, shape (...) [m/s].
        line_load: K_A F_t/b, counted as at least 100 N/mm, shape (...) [N/m].
        overlap_ratio: eps_beta, between spur and helical gears up to 1, shape (...) [1].
        spur, helical: K_1 of both by class, see `CLASSES`, shape (...) [N/mm].

    Validity:
        Steel gears well below resonance: a resonance number below 3 m/s, from where on the formula would
        fall and give less than 1 above 5.8 m/s; helix angles up to 30 deg.

    Source: IACS UR M56 Rev.4 (2021), 1.6.3: K_v = 1 + (K_1/(K_A F_t/b) + K_2) N K_3 with
    K_3 = 2.071 - 0.357 N, at most 2.

    Example:
        >>> factor = dynamic_factor(resonance=0.95, line_load=2e5, overlap_ratio=0.0, spur=14.9, helical=13.3)
        >>> round(float(factor), 3)
        1.154
    """
    load = jnp.maximum(jnp.asarray(line_load) / 1e3, _LEAST_LOAD)
    number = jnp.minimum(resonance, MOST_RESONANCE)
    third = jnp.minimum(_THIRD - _FALL * number, 2.0)
    straight, inclined = (
        1.0 + (first / load + second) * number * third
        for first, second in ((spur, _SPUR), (helical, _HELICAL))
    )
    return straight - jnp.clip(overlap_ratio, 0.0, 1.0) * (straight - inclined)


def reduced_mass_per_width(
    *, mean_radii: Both, inner_radii: Both, base_radii: Both, density: Both
) -> Found:
    """Mass of a pair of gears reduced to the line of action, per width [kg/m].

    Args:
        mean_radii: halfway between root and tip, shape (2, ...) [m].
        inner_radii: of the bores; of a ring the outer radius, shape (2, ...) [m].
        base_radii: shape (2, ...) [m].
        density: shape (2, ...) [kg/m3].

    Returns:
        J_1* J_2*/(J_1* r_b2^2 + J_2* r_b1^2) of discs that end halfway up the teeth.

    Validity:
        Both gears turn and carry nothing else.

    Source: ISO 6336-1:2006, method B of the dynamic factor; KISSsoft 03/2017 prints this value.
    """
    inertia = jnp.pi / 2.0 * density * jnp.abs(mean_radii**4 - inner_radii**4)
    first, second = inertia / base_radii**2
    return jnp.asarray(first * second / (first + second))


def running_in(*, deviation: Each, limit: Each, soft: Each, speed: Each) -> Found:
    """Running-in allowance y_alpha of a deviation of pitch or profile; y_beta is twice as large [m].

    Args:
        deviation: f_pb or f_falpha, for y_beta F_betax, shape (...) [m].
        limit: sigma_Hlim; one that is not a number counts as that of a hardened gear, shape (...) [Pa].
        soft: 1 for through-hardened and normalised gears, 0 for hardened ones, shape (...) [1].
        speed: v at the reference circles, shape (...) [m/s].

    Source: ISO 6336-1:2006, 8.3.5 and 7.5.2.3, 160/sigma_Hlim and 0.075 of the deviation and their limits;
    two public programs and the values that KISSsoft 03/2017 prints agree. Of two gears the mean counts.

    Example:
        >>> found = running_in(deviation=20.7e-6, limit=700e6, soft=1.0, speed=4.9)
        >>> round(1e6 * float(found), 2)
        4.73
    """
    unknown = jnp.isnan(limit)
    deviation, strength = jnp.asarray(deviation), jnp.where(unknown, 1.0, limit / 1e6)
    most = jnp.where(speed <= 5.0, 1e3, jnp.where(speed <= 10.0, 12.8e-3, 6.4e-3)) / strength
    yields = jnp.minimum(jnp.minimum(160.0 / strength, 1.0) * deviation, most)
    hard = jnp.minimum(0.075 * deviation, 3e-6)
    return jnp.where((jnp.asarray(soft) > 0.0) & ~unknown, yields, hard)


def running_in_relief(limits: Sequence[float]) -> float:
    """Tip relief C_ay that running in makes, the mean of both gears; NaN where no limit is known [m].

    Args:
        limits: sigma_Hlim of both gears [Pa].

    Source: ISO 6336-1:2006, 6.5; KISSsoft 03/2017 prints 2.0 and 8.5 um for 1500 and 700 MPa.

    Example:
        >>> [round(1e6 * running_in_relief([limit, limit]), 1) for limit in (1500e6, 700e6)]
        [2.0, 8.5]
    """
    known = [one / 97e6 for one in limits if not isnan(one)]
    reliefs = [1e-6 * ((one - 18.45) ** 2 / 18.0 + 1.5) for one in known]
    return sum(reliefs) / len(reliefs) if reliefs else nan


def dynamic_factor_by_resonance(
    *,
    resonance_ratio: Each,
    line_load: Each,
    contact_ratio: Each,
    stiffness: Each,
    pitch: Each,
    profile: Each,
    relief: Each,
) -> Found:
    """Dynamic factor K_v of ISO 6336-1, method B [1].

    Args:
        resonance_ratio: N, tooth frequency over that of the mesh, shape (...) [1].
        line_load: K_A F_t/b, counted as at least 1 N/mm, shape (...) [N/m].
        contact_ratio: eps_gamma of transverse and overlap, shape (...) [1].
        stiffness: c' of one pair per width, shape (...) [N/m2].
        pitch, profile: f_pb and f_falpha after running in, shape (...) [m].
        relief: C_a; not a number for classes from 6 on, where B_k is 1, shape (...) [m].

    Validity:
        Steel gears, a transverse contact ratio from 1.2 on; above N = 1.5 resonances of the pinion's shaft
        are left out.

    Source: ISO 6336-1:2006, 6.5, subcritical, main resonance, intermediate and supercritical range, with
    C_v1 to C_v7 of its table; two public programs agree, and KISSsoft 03/2017 prints values of the first.

    Example:
        >>> found = dynamic_factor_by_resonance(resonance_ratio=0.410, line_load=833.56e3,
        ...     contact_ratio=2.884, stiffness=13.832e9, pitch=14.71e-6, profile=20.35e-6,
        ...     relief=float("nan"))
        >>> round(float(found), 3)
        1.092
    """
    load = jnp.maximum(jnp.asarray(line_load), _LEAST_COUNTED)
    total = jnp.asarray(contact_ratio)
    several = jnp.maximum(total, 2.0)  # where the other branch stands
    few = total <= 2.0
    by_profile = jnp.where(few, 0.34, 0.57 / (several - 0.3))
    below = jnp.where(few, 0.23, 0.096 / (several - 1.56))
    within = jnp.where(few, 0.90, (0.57 - 0.05 * several) / (several - 1.44))
    above = jnp.where(few, 0.47, 0.12 / (several - 1.74))
    rest = 0.125 * jnp.sin(jnp.pi * (jnp.clip(total, 1.5, 2.5) - 2.0)) + 0.875
    by_pitch, by_form = (
        stiffness * jnp.asarray(pitch) / load,
        stiffness * jnp.asarray(profile) / load,
    )
    none = jnp.isnan(relief)
    by_relief = jnp.where(none, 1.0, jnp.abs(1.0 - stiffness * jnp.where(none, 0.0, relief) / load))
    deviating = 0.32 * by_pitch + by_profile * by_form
    subcritical = 1.0 + resonance_ratio * (deviating + below * by_relief)
    resonant = 1.0 + deviating + within * by_relief
    supercritical = 0.47 * by_pitch + above * by_form + rest
    between = jnp.clip((1.5 - jnp.asarray(resonance_ratio)) / 0.35, 0.0, 1.0)
    lower = 0.5 + 0.35 * jnp.sqrt(jnp.minimum(load / (1e3 * _LEAST_LOAD), 1.0))
    beyond = supercritical + between * (resonant - supercritical)
    return jnp.where(resonance_ratio <= lower, subcritical, beyond)


def pinion_misalignment(
    *,
    line_load: Each,
    face_width: Each,
    diameter: Each,
    span: Each,
    offset: Each,
    shaft_diameter: Each,
) -> Found:
    """Misalignment f_sh over the face by bending and torsion of a pinion between two bearings [m].

    Args:
        line_load: F_m/b = K_A K_v F_t/b, shape (...) [N/m].
        face_width: b, shape (...) [m].
        diameter: d_1 of the reference circle of the pinion, shape (...) [m].
        span: l between the bearings, shape (...) [m].
        offset: s of the pinion from the middle of the span, positive towards the end at which the torque
            enters, shape (...) [m].
        shaft_diameter: d_sh that bends; from d_1/d_sh = 1.15 on the pinion stiffens it, shape (...) [m].

    Validity:
        A solid or hollow shaft of steel with a bore below half its diameter, the whole power through this
        mesh, spur and single helical gears, s/l below 0.3.

    Source: ISO 6336-1:2006, method C of the face load factor, arrangements a and b; three public programs
    agree. Its share of bending is that of a beam on two supports within 12 %.

    Example:
        >>> found = pinion_misalignment(line_load=300e3, face_width=60e-3, diameter=80e-3, span=200e-3,
        ...     offset=20e-3, shaft_diameter=60e-3)
        >>> round(1e6 * float(found), 2)
        7.56
    """
    stiffening = jnp.asarray(diameter) / shaft_diameter
    constant = jnp.where(stiffening >= 1.15, 0.48, 0.8)
    bending = constant * span * offset / jnp.asarray(diameter) ** 2 * stiffening**4
    gamma = (jnp.abs(0.7 + bending) + 0.3) * (jnp.asarray(face_width) / diameter) ** 2
    return 2.3e-11 * line_load * gamma


def face_load_factor(*, misalignment: Each, stiffness: Each, line_load: Each) -> Found:
    """Face load factor K_Hbeta of ISO 6336-1, method C [1].

    Args:
        misalignment: F_betay after running in, shape (...) [m].
        stiffness: c_gamma_beta per width, shape (...) [N/m2].
        line_load: F_m/b, shape (...) [N/m].

    Source: ISO 6336-1:2006, 7.5.2, load across the whole face or on a part of it.

    Example:
        >>> found = [face_load_factor(misalignment=f, stiffness=15e9, line_load=3e5) for f in (10e-6, 90e-6)]
        >>> [round(float(one), 6) for one in found]
        [1.25, 3.0]
    """
    half = jnp.asarray(misalignment) * stiffness / (2.0 * jnp.asarray(line_load))
    return jnp.where(half >= 1.0, 2.0 * jnp.sqrt(half), 1.0 + half)


def root_face_load_factor(*, flank: Each, face_width: Each, height: Each) -> Found:
    """Face load factor of the root K_Fbeta = K_Hbeta^N, N = s^2/(1 + s + s^2) with s = b/h, at least 3 [1].

    Args:
        flank: K_Hbeta, shape (...) [1].
        face_width: b, shape (...) [m].
        height: h of the teeth, the higher ones of both gears, shape (...) [m].

    Validity:
        Contact is hardest at an end of the face; with end relief or crowning take K_Hbeta itself.

    Source: ISO 6336-1:2006; IACS UR M56 Rev.4 (2021), 1.6.4.

    Example:
        >>> factor = root_face_load_factor(flank=1.32, face_width=14e-3, height=10.779e-3)
        >>> round(float(factor), 2)  # b/h = 1.3 counts as 3
        1.21
    """
    slender = jnp.maximum(jnp.asarray(face_width) / height, 3.0)
    return jnp.asarray(flank) ** (slender**2 / (1.0 + slender + slender**2))
