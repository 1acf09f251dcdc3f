"""Sentences on what cannot run: they stand before all other warnings."""

from collections.abc import Iterable

__all__ = ["fails", "worst_first"]

_FAILS = "Fails: "


def fails(sentence: str) -> str:
    """Sentence marked as one on what cannot run.

    Example:
        >>> fails("the teeth of gear 2 melt.")
        'Fails: the teeth of gear 2 melt.'
    """
    return f"{_FAILS}{sentence}"


def worst_first(sentences: Iterable[str]) -> list[str]:
    """Sentences, each once, those on what cannot run first.

    Example:
        >>> from pitchpoint.cases.failures import fails
        >>> worst_first(["tips are pointed.", fails("teeth melt."), "tips are pointed."])
        ['Fails: teeth melt.', 'tips are pointed.']
    """
    return sorted(dict.fromkeys(sentences), key=lambda text: not text.startswith(_FAILS))
