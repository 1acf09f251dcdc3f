"""Sentences on what cannot run: they stand before all other warnings."""

from collections.abc import Iterable

__all__ = ["fails", "in_stage", "worst_first"]

_FAILS = "Fails: "


def fails(sentence: str) -> str:
    """Sentence marked as one on what cannot run.

    Example:
        >>> fails("the teeth of gear 2 melt.")
        'Fails: the teeth of gear 2 melt.'
    """
    return f"{_FAILS}{sentence}"


def in_stage(number: int, sentence: str) -> str:
    """Sentence on one stage of a drive.

    Example:
        >>> from pitchpoint.cases.failures import fails
        >>> in_stage(2, fails("the teeth of gear 2 melt."))
        'Fails: stage 2: the teeth of gear 2 melt.'
        >>> in_stage(1, "Tips are pointed.")
        'Stage 1: tips are pointed.'
    """
    if sentence.startswith(_FAILS):
        return fails(f"stage {number}: {sentence.removeprefix(_FAILS)}")
    return f"Stage {number}: {sentence[:1].lower()}{sentence[1:]}"


def worst_first(sentences: Iterable[str]) -> list[str]:
    """Sentences, each once, those on what cannot run first.

    Example:
        >>> from pitchpoint.cases.failures import fails
        >>> worst_first(["tips are pointed.", fails("teeth melt."), "tips are pointed."])
        ['Fails: teeth melt.', 'tips are pointed.']
    """
    return sorted(dict.fromkeys(sentences), key=lambda text: not text.startswith(_FAILS))
