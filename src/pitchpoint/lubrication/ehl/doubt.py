"""What to be wary of about films, with how bad it is: of many results the worst one is told."""

from __future__ import annotations

__all__ = ["Doubt", "extent_of", "kind_of"]


class Doubt(str):
    """A sentence without its stop, of a kind, and how bad it is.

    Args:
        sentence: with its numbers.
        kind: what sentences have in common of which the worst one says enough.
        extent: larger is worse; comparable within a kind.

    Example:
        >>> from pitchpoint.lubrication.ehl.doubt import Doubt
        >>> told = Doubt("the grid is coarse: off by 5 %", "grid", 0.05)
        >>> print(told, told.kind, told.extent)
        the grid is coarse: off by 5 % grid 0.05
    """

    kind: str
    extent: float

    def __new__(cls, sentence: str, kind: str, extent: float) -> Doubt:
        """See the class."""
        found = super().__new__(cls, sentence)
        found.kind, found.extent = kind, float(extent)
        return found


def kind_of(sentence: str) -> str:
    """Kind of a sentence; a plain one is its own."""
    return sentence.kind if isinstance(sentence, Doubt) else sentence


def extent_of(sentence: str) -> float:
    """How bad it is; nothing is known of a plain one."""
    return sentence.extent if isinstance(sentence, Doubt) else 0.0
