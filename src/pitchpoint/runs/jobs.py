"""Parts of a result to compute: the analyses of a case, with their pieces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, Progress, Subject
from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.cases.build import Built
from pitchpoint.cases.schema import Study
from pitchpoint.cases.variant import Variant

__all__ = ["Job", "jobs"]


@dataclass(frozen=True)
class Job:
    """One dataset to compute, in one piece or several: an analysis of a case."""

    analysis: Analysis
    built: Built

    @property
    def name(self) -> str:
        """Of the part, and of its file."""
        return self.analysis.name

    @property
    def title(self) -> str:
        """For progress."""
        return self.analysis.title

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Descriptions of the pieces, in order; a long sweep has several."""
        return tuple({"analysis": self.name, **each} for each in self.analysis.pieces(self.built))

    def compute(self, piece: Piece, progress: Progress = lambda _: None) -> xr.Dataset:
        """Dataset of a piece."""
        return self.analysis.compute(self.built, piece, progress)

    def joined(self, pieces: Sequence[xr.Dataset]) -> xr.Dataset:
        """The whole dataset."""
        return self.analysis.joined(self.built, pieces)


def jobs(variant: Variant, studies: Mapping[str, Study]) -> list[Job]:
    """All parts of a case in the order in which they are worth having.

    Args:
        variant: the case.
        studies: that the user added.

    Raises:
        InputError: before the first part, for the case and for the ends of every sweep.
    """
    built = variant.built({})
    subject = Subject(variant, built, studies)
    parts = (part for analysis in ANALYSES.values() for part in analysis.parts(subject))
    return [Job(part, built) for part in parts]
