"""Friction laws that a case file may name: those of the library, and those of published cases."""

from math import inf

from pitchpoint import units
from pitchpoint.lubrication.conditions import UNITS
from pitchpoint.lubrication.ehl.traction import EHL_LINE
from pitchpoint.lubrication.friction_coefficient import LAWS, FrictionLaw
from pitchpoint.published.registry import LAWS_OF_CASES
from pitchpoint.registry import Registry

__all__ = ["FRICTION", "limits_words"]

FRICTION: Registry[FrictionLaw] = Registry("friction law", *LAWS, EHL_LINE, places=LAWS_OF_CASES)


def limits_words(name: str, limits: tuple[float, float]) -> str:
    """Range of a condition that a law asks for, in words.

    Args:
        name: of the condition.
        limits: smallest and largest value [SI]; infinite where there is none.

    Example:
        >>> limits_words("viscosity", (1e-3, float("inf")))
        'at least 1 mPa s'
    """
    low, high = (_shown(name, value) for value in limits)
    if limits[1] == inf:
        return f"at least {low}"
    return f"at most {high}" if limits[0] == -inf else f"{low} to {high}"


_SHOWN = {"viscosity": ("mPa s", "dynamic viscosity"), "roughness_ra": ("um", "length")}


def _shown(name: str, value: float) -> str:
    unit, kind = _SHOWN.get(name, (UNITS[name], ""))
    return f"{units.convert(value, unit, kind) if kind else value:g} {unit}".removesuffix(" 1")
