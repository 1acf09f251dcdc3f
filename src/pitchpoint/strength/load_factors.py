"""Load factors of ISO 6336-1 that follow from a pair by a formula; all others are given by value."""

from collections.abc import Mapping

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Numbers

__all__ = [
    "CLASSES",
    "MOST_RESONANCE",
    "dynamic_factor",
    "resonance_number",
    "root_face_load_factor",
]

Each = Float[Numbers, "*#b"]
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
