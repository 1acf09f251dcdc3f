"""What became of a printed number, as a result keeps it."""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["TargetRow", "counts", "verdict_sentence"]


@dataclass(frozen=True)
class TargetRow:
    """One printed number, in the unit of the print, and what was computed for it.

    `bound` says whether the number, or so many times it, is to be exceeded (">") or not reached ("<")
    instead of met: "< 2 x ". Of an expected miss the cause is known, and stands in `reason`.
    """

    quantity: str
    where: str
    printed: float
    computed: float | None
    unit: str
    tolerance: float
    kind: str
    verdict: str
    reason: str
    bound: str = ""
    expected_miss: bool = False

    @property
    def deviation(self) -> float | None:
        """Computed minus printed."""
        return None if self.computed is None else self.computed - self.printed

    @property
    def surprises(self) -> bool:
        """True for a number that is missed without a known cause, or met in spite of one."""
        return self.verdict == ("pass" if self.expected_miss else "miss")

    def as_json(self) -> dict[str, Any]:
        """The row for machines."""
        return asdict(self)


_MET = "met"
_VERDICTS = {"pass": _MET, "miss": "missed", "excluded": "left out"}

FITTED = ("calibrated", "fitted")
"""Kinds of numbers with which a constant, a reading or an input was found: that they are met tests little."""


def verdict_sentence(rows: Iterable[TargetRow]) -> str:
    """How many numbers of the publication were met, and apart from them of an independent calculation."""
    of_both: dict[str, list[TargetRow]] = {}
    for row in rows:
        independent = row.kind == "reference"
        source = "of an independent calculation" if independent else "printed numbers"
        of_both.setdefault(source, []).append(row)
    every = sorted(of_both.items(), reverse=True)
    return "; ".join(
        f"{len(those)} {source if len(those) > 1 else source.removesuffix('s')}: {_tally(those)}"
        for source, those in every
    )


def _tally(rows: Sequence[TargetRow]) -> str:
    ordered = sorted(rows, key=lambda row: ([*_VERDICTS].index(row.verdict), row.surprises))
    fitted = sum(row.verdict == "pass" and row.kind in FITTED for row in rows)
    counted = ", ".join(
        f"{count} {verdict}{f' ({fitted} fitted)' if verdict == _MET and fitted else ''}"
        for verdict, count in Counter(map(_verdict, ordered)).items()
    )
    predicted = [row.verdict == "pass" for row in rows if row.kind == "predicted"]
    return (
        f"{counted}; {sum(predicted)} of {len(predicted)} predicted met" if predicted else counted
    )


def _verdict(row: TargetRow) -> str:
    if row.verdict == "miss":
        return "missed with a reason" if row.expected_miss else "missed without a reason"
    in_spite = row.verdict == "pass" and row.expected_miss
    return _VERDICTS[row.verdict] + " in spite of its reason" * in_spite


def counts(rows: Iterable[TargetRow]) -> dict[str, Counter[str]]:
    """Verdicts counted for each kind of target, never summed over kinds."""
    kinds: dict[str, Counter[str]] = {}
    for row in rows:
        kinds.setdefault(row.kind, Counter())[row.verdict] += 1
    return kinds
