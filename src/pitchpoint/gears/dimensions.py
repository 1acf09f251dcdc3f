"""Dimensions of a mesh: chosen ones, what follows, for tables and a drawing; gears register theirs here."""

from functools import singledispatch
from typing import Any

from jaxtyping import Array, Float

__all__ = ["completed", "drawing", "independent", "main_dimensions"]


@singledispatch
def main_dimensions(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """Main dimensions by name [SI], one value or one for each member; for results and tables."""
    return {}


@singledispatch
def drawing(mesh: Any) -> dict[str, Float[Array, "..."]]:
    """What a drawing of the teeth to scale needs [SI], see `Family.drawing`; empty where there is none."""
    return {}


@singledispatch
def independent(mesh: Any) -> tuple[str, ...]:
    """Fields of a mesh whose numbers are chosen one by one; what follows from them is `completed`."""
    return ()


@singledispatch
def completed(mesh: Any) -> Any:
    """The same mesh with dimensions that follow from others computed from them again.

    Derivatives with respect to one dimension then see what follows from it.
    """
    return mesh
