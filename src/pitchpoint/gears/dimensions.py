"""Dimensions of a mesh, for tables and for a drawing; gears that have them register them here."""

from functools import singledispatch
from typing import Any

from jaxtyping import Array, Float

__all__ = ["drawing", "main_dimensions"]


@singledispatch
def main_dimensions(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """Main dimensions by name [SI], one value or one for each member; for results and tables."""
    return {}


@singledispatch
def drawing(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """What a drawing of the teeth to scale needs [SI], see `Family.drawing`; empty where there is none."""
    return {}
