"""Friction laws that a case file may name: those of the library, and those of published cases."""

from pitchpoint.lubrication.registry import LAWS, FrictionLaw
from pitchpoint.published.registry import LAWS_OF_CASES
from pitchpoint.registry import Registry

__all__ = ["FRICTION"]

SOLVED = {"ehl_line": "pitchpoint.lubrication.ehl.traction:EHL_LINE"}
"""Places of laws that are no formula."""

FRICTION: Registry[FrictionLaw] = Registry(
    "friction law", *LAWS, places={**SOLVED, **LAWS_OF_CASES}
)
