"""What a registry says of a model of the torque by which bodies beside the teeth brake each other."""

from collections.abc import Callable
from dataclasses import dataclass

from jaxtyping import Array

__all__ = ["DragModel"]


@dataclass(frozen=True, eq=False)
class DragModel:
    """A named model of a torque between two bodies, in motion or at rest.

    Attributes:
        name, title: by which it is picked, and what it says.
        function: torque [N m], not negative, from the keywords that all models of its registry take and
            from the factors of the model.
        factors: names of the further keywords, which the case gives for each place.
        sources: keys of the bibliography.
        note: caution for the user.
    """

    name: str
    title: str
    function: Callable[..., Array]
    factors: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    note: str = ""
