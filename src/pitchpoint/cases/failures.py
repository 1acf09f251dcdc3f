"""Sentences on what cannot be: they stand above every number, apart from all other warnings."""

from collections.abc import Iterable

__all__ = ["apart", "fails", "in_stage"]

_FAILS = "Fails: "


def fails(sentence: str) -> str:
    """Sentence marked as one on what cannot be; whoever warns of a result may tell such ones.

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


def apart(sentences: Iterable[str]) -> dict[str, list[str]]:
    """Sentences on what cannot be, and all other warnings, each once.

    Example:
        >>> from pitchpoint.cases.failures import fails
        >>> apart(["tips are pointed.", fails("teeth melt."), "tips are pointed."])
        {'implausible': ['Fails: teeth melt.'], 'warnings': ['tips are pointed.']}
    """
    each = list(dict.fromkeys(sentences))
    return {
        "implausible": [text for text in each if text.startswith(_FAILS)],
        "warnings": [text for text in each if not text.startswith(_FAILS)],
    }
