"""Factors between the strength of test gears and that of a pair, after ISO 6336-2 and ISO 6336-3."""

from typing import Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp
from pitchpoint.core.factored import Numbers
from pitchpoint.strength.treatments import Life, Treatment

__all__ = [
    "STRESS_CORRECTION",
    "Constants",
    "at_life",
    "endurance_share",
    "life_factor",
    "notch_sensitivity_factor",
    "size_factor",
    "static_notch_sensitivity_factor",
    "surface_factor",
]

Each = Float[Numbers, "*#b"]
Found = Float[Array, "..."]

# ISO 6336-2 and -3: life factors fall to 0.85 at 1e10 cycles; the notch of the test gears has q_s = 2.5.
_LONG, _LEAST = 1e10, 0.85
_REFERENCE_NOTCH = 2.5

STRESS_CORRECTION = 2.0
"""Y_ST, stress correction of the gears on which sigma_Flim was measured; also Y_St of VDI 2736, eq. 13."""


class Constants(eqx.Module):
    """Constants of the treatment of both gears as arrays, see `Treatment`.

    Attributes:
        flank, root: level, few and many cycles of the life factors.
        slip_layer: [mm].
        static_notch: slope of the static notch sensitivity over Y_S.
        surface: a, b, n, and the factor of smooth roots.
        root_size: a, b, least.
        flank_size: level, and slope [1/mm], least.

    Source: ISO 6336-2:2019 and ISO 6336-3:2019, see `Treatment`.
    """

    flank: Float[Array, "3 2"]
    root: Float[Array, "3 2"]
    slip_layer: Float[Array, "2"]
    static_notch: Float[Array, "2"]
    surface: Float[Array, "4 2"]
    root_size: Float[Array, "3 2"]
    flank_size: Float[Array, "3 2"]

    @classmethod
    def of(cls, first: Treatment, second: Treatment) -> Self:
        """Constants of two gears by the treatment of each."""
        both = (first, second)
        return cls(
            flank=array(np.array([_life(one.flank) for one in both]).T),
            root=array(np.array([_life(one.root) for one in both]).T),
            slip_layer=array([one.slip_layer for one in both]),
            static_notch=array([one.static_notch for one in both]),
            surface=array(np.array([(*one.surface, one.smooth) for one in both]).T),
            root_size=array(np.array([one.root_size for one in both]).T),
            flank_size=array(np.array([one.flank_size for one in both]).T),
        )


def _life(life: Life) -> tuple[float, float, float]:
    return life.level, life.few, life.many


def life_factor(*, cycles: Each, level: Each, few: Each, many: Each) -> Found:
    """Life factor Z_NT or Y_NT, on lines in the logarithms of factor and cycles [1].

    Args:
        cycles: load cycles N_L, shape (...) [1].
        level: of the factor up to `few` cycles, shape (...) [1].
        few, many: load cycles where the factor begins to fall and where it is 1, few < many, shape (...) [1].

    Returns:
        The factor; beyond `many` cycles it falls to 0.85 at 1e10 and stays there.

    Source: ISO 6336-2:2006, table 2, and ISO 6336-3:2006, table 1. The branch beyond `many` cycles may be 1
    with optimum material, manufacture and lubrication.

    Example:
        >>> factor = life_factor(cycles=9e7, level=1.6, few=1e5, many=5e7)
        >>> round(float(factor), 3)
        0.982
    """
    number = jnp.log(jnp.clip(cycles, few, _LONG))
    begins, ends, long = jnp.log(few), jnp.log(many), jnp.log(_LONG)
    short = jnp.log(level) * jnp.maximum(ends - number, 0.0) / (ends - begins)
    beyond = jnp.log(_LEAST) * jnp.maximum(number - ends, 0.0) / (long - ends)
    return jnp.exp(short + beyond)


def endurance_share(*, cycles: Each, few: Each, many: Each) -> Found:
    """Where a number of cycles lies between static strength and endurance, in their logarithms: 0 to 1 [1].

    Args:
        cycles: load cycles N_L, shape (...) [1].
        few, many: load cycles where static strength ends and endurance begins, few < many, shape (...) [1].

    From straight lines in logarithms, as the life factors of ISO 6336-2:2019 and ISO 6336-3:2019 are.

    Example:
        >>> round(float(endurance_share(cycles=1e6, few=1e5, many=1e7)), 3)
        0.5
    """
    begins, ends = jnp.log(few), jnp.log(many)
    return jnp.clip((jnp.log(cycles) - begins) / (ends - begins), 0.0, 1.0)


def at_life(*, endurance: Each, static: Each | float, share: Each) -> Found:
    """Factor of a permissible stress at a limited life [1].

    Args:
        endurance, static: the factor for endurance and for static strength, shape (...) [1].
        share: see `endurance_share`, shape (...) [1].

    The permissible stress of both standards is a line in the logarithms of stress and cycles from the static
    strength to endurance, so each of its factors is.

    Source: ISO 6336-2:2006, 5.4, and ISO 6336-3:2006, 5.5, as DIN 3990-11:1989, 4.1.2 and 5.1.3.

    Example:
        >>> round(float(at_life(endurance=0.81, static=1.0, share=0.5)), 3)
        0.9
    """
    return jnp.asarray(endurance) ** share * jnp.asarray(static) ** (1.0 - jnp.asarray(share))


def static_notch_sensitivity_factor(*, stress_correction: Each, slope: Each) -> Found:
    """Relative notch sensitivity factor for static strength, 1 + s (Y_S - 2) [1].

    Args:
        stress_correction: Y_S, shape (...) [1].
        slope: s of the material, shape (...) [1].

    Source: DIN 3990-11:1989, 5.6: 0.44 Y_S + 0.12 of case-hardened steel, 0.20 Y_S + 0.60 of nitrided steel;
    (1 + k (Y_S - 1))/(1 + k) of others, k = 0.82 (300/sigma_0.2)^(1/4) of through-hardened and
    0.93 (200/sigma_S)^(1/4) of normalised steel.

    Example:
        >>> round(float(static_notch_sensitivity_factor(stress_correction=1.7, slope=0.44)), 3)
        0.868
    """
    return 1.0 + slope * (jnp.asarray(stress_correction) - 2.0)


def notch_sensitivity_factor(*, notch: Each, slip_layer: Each) -> Found:
    """Relative notch sensitivity factor Y_delta_rel_T [1].

    Args:
        notch: notch parameter q_s, shape (...) [1].
        slip_layer: rho', shape (...) [mm].

    Source: ISO 6336-3:2019, eqs. 75 to 77; IACS UR M56 Rev.4 (2021), 3.11.

    Example:
        >>> round(float(notch_sensitivity_factor(notch=1.93, slip_layer=0.003)), 3)
        0.994
    """
    gradient, reference = ((1.0 + 2.0 * jnp.asarray(q)) / 5.0 for q in (notch, _REFERENCE_NOTCH))
    return (1.0 + jnp.sqrt(slip_layer * gradient)) / (1.0 + jnp.sqrt(slip_layer * reference))


def surface_factor(*, roughness: Each, a: Each, b: Each, n: Each, smooth: Each) -> Found:
    """Relative surface factor Y_R_rel_T = a - b (Rz + 1)^n with Rz in um [1].

    Args:
        roughness: Rz of the root fillets; above 40 um as 40 um, shape (...) [m].
        a, b, n: constants of the material, shape (...) [1].
        smooth: the factor below Rz = 1 um, shape (...) [1].

    Source: ISO 6336-3:2019, eqs. 87 to 89; IACS UR M56 Rev.4 (2021), 3.12.

    Example:
        >>> round(float(surface_factor(roughness=20e-6, a=1.674, b=0.529, n=0.1, smooth=1.12)), 3)
        0.957
    """
    rz = jnp.minimum(1e6 * jnp.asarray(roughness), 40.0)
    return jnp.where(rz < 1.0, smooth, a - b * (rz + 1.0) ** n)


def size_factor(*, module: Each, a: Each, b: Each, least: Each) -> Found:
    """Size factor of the root Y_X = a - b m_n with m_n in mm, from `least` to 1 [1].

    Args:
        module: normal module m_n, shape (...) [m].
        a, b, least: constants of the material, shape (...) [1].

    Source: ISO 6336-3:2006, table 5; IACS UR M56 Rev.4 (2021), 3.13 (with 0.006 where it prints 0.06).

    Example:
        >>> round(float(size_factor(module=10e-3, a=1.05, b=0.01, least=0.8)), 3)
        0.95
    """
    return jnp.clip(a - b * 1e3 * jnp.asarray(module), least, 1.0)
