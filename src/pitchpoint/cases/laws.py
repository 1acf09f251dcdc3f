"""Friction laws that a case file may name: those of the library, and those of published cases."""

from pitchpoint.cases.tian2024 import friction as tian2024
from pitchpoint.lubrication.friction_coefficient import LAWS, FrictionLaw
from pitchpoint.registry import Registry

__all__ = ["CASE_LAWS", "FRICTION"]

CASE_LAWS: tuple[FrictionLaw, ...] = tian2024.LAWS
"""Readings of a publication that are needed to reproduce its tables; no spread counts them."""

FRICTION: Registry[FrictionLaw] = Registry("friction law", *LAWS, *CASE_LAWS)
