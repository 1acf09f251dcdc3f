"""Kinds of values that tables of several rooms take: quantities with their ranges, texts, flags."""

from typing import Annotated, Any

from pydantic import BeforeValidator

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity, shown, text

__all__ = [
    "COEFFICIENT",
    "FORCE",
    "HARDNESS",
    "LIFE",
    "LIFE_EXPONENT",
    "LOADED",
    "LOAD_FACTOR",
    "MAP_SPEED",
    "MOST_STAGES",
    "PLACE",
    "PRESSED",
    "RATIO",
    "SPEED",
    "TEMPERATURE",
    "TORQUE",
    "Flag",
    "Text",
]


RATIO = Quantity("dimensionless", 0.0, 1.0, open_low=True)
HARDNESS = Quantity("hardness", 1e6, 1e11, "GPa")
TORQUE = Quantity("torque", 0.0, 1e8, "N m")
LOADED = Quantity("torque", 0.0, 1e8, "N m", open_low=True)
SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm", open_low=True)
MAP_SPEED = Quantity("rotational speed", 0.0, 1e5, "rpm")
TEMPERATURE = Quantity("temperature", 150.0, 600.0, "degC")
COEFFICIENT = Quantity("dimensionless", 0.0, 2.0)
FORCE = Quantity("force", 0.0, 1e7, "N")
PRESSED = Quantity("force", 0.0, 1e7, "N", open_low=True)
PLACE = Quantity("length", -10.0, 10.0, "mm")
MOST_STAGES = 5
"""Stages of a drive: the meetings of their phases multiply."""

LOAD_FACTOR = Quantity("dimensionless", 1.0, 10.0)
LIFE = Quantity("time", 0.0, 4e9, "h", open_low=True)
Text = Annotated[str, BeforeValidator(text)]


def _flag(value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError(f"{shown(value)} was given; allowed are true and false")
    return value


Flag = Annotated[bool, BeforeValidator(_flag)]


LIFE_EXPONENT = Quantity("dimensionless", 1.0, 20.0)
