"""What became of a printed number, as a result keeps it."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

__all__ = ["Row", "counts"]


@dataclass(frozen=True)
class Row:
    """One printed number, in the unit of the print, and what was computed for it.

    `bound` says whether the number, or so many times it, is to be exceeded (">") or not reached ("<")
    instead of met: "< 2 x ".
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

    @property
    def deviation(self) -> float | None:
        """Computed minus printed."""
        return None if self.computed is None else self.computed - self.printed

    def as_json(self) -> dict[str, Any]:
        """The row for machines."""
        return asdict(self)


def counts(rows: Iterable[Row]) -> dict[str, Counter[str]]:
    """Verdicts counted for each kind of target, never summed over kinds."""
    kinds: dict[str, Counter[str]] = {}
    for row in rows:
        kinds.setdefault(row.kind, Counter())[row.verdict] += 1
    return kinds
