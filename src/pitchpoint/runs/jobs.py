"""Parts of a result to compute: the analyses of a case, with their pieces."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress, Several, Subject, silent
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.study_tables import Study
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import Complaints, InputError, shorten
from pitchpoint.input.quantities import shown
from pitchpoint.registry import nearest

__all__ = ["Job", "chosen_jobs", "job_of", "jobs", "with_parts_read"]


@dataclass(frozen=True)
class Job:
    """One dataset to compute, in one piece or several: an analysis of a case."""

    analysis: Analysis
    built: Ready

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
        """Descriptions of the pieces, in order; a long sweep has several, what reads another part none."""
        if self.analysis.reads:
            return ()
        return tuple({"analysis": self.name, **piece} for piece in self.analysis.pieces(self.built))

    @property
    def several(self) -> bool:
        """True if there may be more pieces than one."""
        return len(self.pieces) > 1 or self.analysis.onward is not None

    def compute(self, piece: Piece, progress: PieceProgress = silent) -> xr.Dataset:
        """Dataset of a piece."""
        return self.analysis.compute(self.built, piece, progress)

    def onward(self, last: xr.Dataset, progress: PieceProgress = silent) -> xr.Dataset | None:
        """Next piece of a march after the last one, None at its end or where nothing marches."""
        march = self.analysis.onward
        return None if march is None else march(self.built, last, progress)

    def piece(
        self, number: int, last: xr.Dataset | None, progress: PieceProgress
    ) -> xr.Dataset | None:
        """Dataset of the piece of a number, which a march makes from the last one; None after the end."""
        if number < len(self.pieces):
            return self.compute(self.pieces[number], progress)
        return None if last is None else self.onward(last, progress)

    def joined(self, pieces: Sequence[xr.Dataset]) -> xr.Dataset:
        """The whole dataset."""
        return self.analysis.joined(self.built, pieces)


def jobs(
    variant: Variant, studies: Mapping[str, Study], names: Sequence[str] | None = None
) -> list[Job]:
    """All parts of a case in the order in which they are worth having, or those of some names.

    Args:
        variant: the case.
        studies: that the user added.
        names: of parts; whether the case has others is not looked at.

    Raises:
        InputError: before the first part, for the case and for the ends of every sweep.
    """
    built = variant.built({})
    subject = Subject(variant, built, studies)
    wrong = Complaints(variant.name)
    chosen = (
        analysis_or_group
        for analysis_or_group in ANALYSES.values()
        if names is None
        or analysis_or_group.name in names
        or isinstance(analysis_or_group, Several)
    )
    collected = [wrong.tried(_parts, analysis, subject) for analysis in chosen]
    wrong.demand_none()
    return [
        Job(part, built)
        for parts in collected
        for part in parts or ()
        if names is None or part.name in names
    ]


def chosen_jobs(variant: Variant, studies: Mapping[str, Study], names: Sequence[str]) -> list[Job]:
    """Parts of those names, in their order among all, see `jobs`.

    Raises:
        InputError: no name, or one that is no part of the case, with what it lacks where that is known.
    """
    if isinstance(names, str) or not names:
        advice = 'analyses are a list of names of parts, ["operation", "cycle"]'
        raise InputError(f"{shown(names)} was given; {advice}", file=variant.name)
    chosen = jobs(variant, studies, [*with_parts_read(names)])
    if missing := {*names} - {job.name for job in chosen}:
        every = [job.name for job in jobs(variant, studies)]
        for name in sorted(missing, key=[*names].index):
            _demand_part(name, every, variant)
    return chosen


def with_parts_read(names: Iterable[str]) -> set[str]:
    """Names of parts, with those of the parts that they are computed of.

    Args:
        names: of parts and studies.

    Example:
        >>> sorted(with_parts_read(["duty"]))
        ['duty', 'four_quadrants']
    """
    analyses = dict(ANALYSES)
    wanted = {*names}
    read = (analyses[name] for name in wanted & analyses.keys())
    return wanted | {
        analysis.reads for analysis in read if isinstance(analysis, Analysis) and analysis.reads
    }


def _parts(entry: Analysis | Several, subject: Subject) -> list[Analysis]:
    return [*entry.parts(subject)]


def job_of(variant: Variant, name: str) -> Job:
    """The part of that name; InputError if the case has none, with what it lacks where that is known."""
    by_name = {job.name: job for job in jobs(variant, {})}
    _demand_part(name, [*by_name], variant)
    return by_name[name]


def _demand_part(name: str, known: Sequence[str], variant: Variant) -> None:
    """InputError for what is no part of the case."""
    if name in known:
        return
    analyses = dict(ANALYSES)
    why = analyses[name].why_not(variant.built({})) if name in analyses else None
    advice = f": {why}" if why else nearest(name, known)
    raise InputError(f"this case computes no part '{shorten(name)}'{advice}", file=variant.name)
