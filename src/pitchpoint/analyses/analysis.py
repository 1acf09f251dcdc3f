"""The contract of an analysis: what it lacks, its pieces, and the dataset that they make."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any, Literal, Protocol

import xarray as xr

from pitchpoint.cases.built import Built
from pitchpoint.cases.built_drive import TRAIN_PERIOD, BuiltDrive, Ready
from pitchpoint.cases.study_tables import Study
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import Doubt, doubts_of, stored
from pitchpoint.errors import InputError
from pitchpoint.registry import Deferred
from pitchpoint.results.by_stage import Label, as_label, by_stage, of_stage, stages_of
from pitchpoint.results.variable import Variable

__all__ = [
    "Analysis",
    "Piece",
    "PieceProgress",
    "Several",
    "Subject",
    "Unasked",
    "has_key",
    "of_gears_with",
    "of_stages",
    "silent",
]

Piece = Mapping[str, Any]
"""Where a piece lies, as plain data of less than 1 kB: a torque, a range of points; empty for the whole."""


class PieceProgress(Protocol):
    """Told how far a piece is."""

    def __call__(self, done: int, doing: str = "") -> None:
        """Told the number of points that are done, 0 where none are counted, and what takes long."""


def silent(done: int, doing: str = "") -> None:
    """Progress that nobody hears."""


class Unasked(str):
    """A reason why a part does not exist that lies in what the case file asks for, not in its gears."""


def _is_unasked(why: str | None) -> bool:
    return isinstance(why, Unasked)


def has_key(built: Built, key: str) -> bool:
    """True if the table `[gears]` of a mesh has a key, given or not."""
    return key in type(built.case.gears).model_fields


def of_gears_with(key: str, told: str) -> Callable[[Built], str | None]:
    """What an analysis lacks that is for gears whose table `[gears]` has a key, given or not.

    Args:
        key: of the table.
        told: why other gears have no such part.
    """

    def lacks(built: Built) -> str | None:
        return None if has_key(built, key) else Unasked(told)

    return lacks


def _of_no_piece(built: Ready, piece: Piece, progress: PieceProgress) -> xr.Dataset:
    """InputError for a piece of what reads another part."""
    raise InputError("this part is computed of another part of the result and has no pieces")


@dataclass(frozen=True)
class Subject:
    """What analyses look at.

    Attributes:
        variant: of the case, which can be built again with changed values.
        built: the case as it stands.
        studies: asked for beside those of the case.
    """

    variant: Variant
    built: Ready
    studies: Mapping[str, Study] = field(default_factory=dict)


def _whole(_: Ready) -> Iterable[Piece]:
    return ({},)


def _only(_: Ready, parts: Sequence[xr.Dataset]) -> xr.Dataset:
    (part,) = parts
    return part


@dataclass(frozen=True, kw_only=True)
class Entry:
    """What is known of parts of a result before they are computed.

    Attributes:
        name: of the part, and of its file.
        title: for progress and figures.
        lacks: None, or why the part does not exist for a case: what its gears do not have, or its file
            does not ask for (`Unasked`).
        of: what it is of: "mesh", or "train", meshes that turn together, and a drive of several has it of
            each along a dimension `stage`; or "drive", of one mesh or several.
        under_load: True where it hangs on the load: in a drive on that which a mesh or a set carries with all
            losses.
        of_no_train: why the meshes of a train do not have it each by itself; empty where they do.
        main: variables that are shown first.
        figures: entries of `--json` from all parts that exist; by default the main variables under the
            name of the part.
        variables: those that no other part knows, by name.
    """

    name: str
    title: str
    lacks: Callable[[Any], str | None] = lambda built: None
    of: Literal["mesh", "train", "drive"] = "mesh"
    under_load: bool = False
    of_no_train: str = ""
    main: tuple[str, ...] = ()
    figures: Deferred[Callable[[Mapping[str, xr.Dataset]], Mapping[str, Any]] | None] = Deferred(
        None
    )
    variables: Mapping[str, Variable] = field(default_factory=dict)

    def why_not(self, built: Ready) -> str | None:
        """Why the part does not exist for a case; None where it does."""
        if self.of_no_train and built.averaging == TRAIN_PERIOD:
            return self.of_no_train
        members = {"mesh": built.meshes, "train": [*built.trains.values()]}.get(self.of)
        reasons = [*map(self.lacks, members or [built])]
        return None if None in reasons else min(reasons, key=_is_unasked)

    def shown(self, parts: Mapping[str, xr.Dataset]) -> Mapping[str, Any]:
        """Entries of `--json`; of a part of the meshes or sets of a drive by stage."""
        data = parts.get(self.name)
        stages = {} if data is None else {n: of_stage(data, n) for n in stages_of(data)}
        per_stage = {
            n: self._shown({**parts, self.name: stage_data}) for n, stage_data in stages.items()
        }
        names = dict.fromkeys(name for entries in per_stage.values() for name in entries)
        figures = {
            name: {
                f"stage {n}": entries[name] for n, entries in per_stage.items() if name in entries
            }
            for name in names
        }
        return figures or self._shown(parts)

    def _shown(self, parts: Mapping[str, xr.Dataset]) -> Mapping[str, Any]:
        if self.figures is not None:
            return self.figures(parts)
        data = parts.get(self.name)
        if data is None or not self.main:
            return {self.name: {}} if self.main else {}
        return {self.name: {name: data[name].values.tolist() for name in self.main if name in data}}


@dataclass(frozen=True, kw_only=True)
class Analysis(Entry):
    """One part of a result: what it needs, how it is computed, and what is shown of it.

    Attributes:
        compute: dataset of a piece, told a callback for progress. It needs nothing but the case and the
            piece, so that another process can compute it. What reads another part has none.
        pieces: where the pieces lie, in order; one that is the whole by default.
        joined: the whole dataset from its pieces.
        reads: name of a part that it is computed of, which `joined` has in place of pieces.
        beside: variables; `joined` has the parts before it that have any of them too, behind what it reads.
        onward: of a march, the next piece after the last one as computed, None at its end; it begins after
            `pieces`.
    """

    reads: str = ""
    beside: tuple[str, ...] = ()
    compute: Deferred[Callable[[Any, Piece, PieceProgress], xr.Dataset]] = Deferred(_of_no_piece)
    pieces: Deferred[Callable[[Any], Iterable[Piece]]] = Deferred(_whole)
    joined: Deferred[Callable[[Any, Sequence[xr.Dataset]], xr.Dataset]] = Deferred(_only)
    onward: Deferred[Callable[[Any, xr.Dataset, PieceProgress], xr.Dataset | None] | None] = (
        Deferred(None)
    )

    def parts(self, subject: Subject) -> "Iterable[Analysis]":
        """The analysis itself, unless a case lacks something that it needs; of a drive see `of_stages`."""
        if self.why_not(subject.built):
            return ()
        whole = {"mesh": not subject.built.numbers, "train": 0 in subject.built.trains}
        return (self if whole.get(self.of, True) else of_stages(self),)


def of_stages(analysis: Analysis) -> Analysis:
    """An analysis of a mesh or a set as one of a drive: of each that has it, along a dimension `stage`.

    Stages are computed one after the other, a march of one to its end before that of the next begins.

    Args:
        analysis: of a mesh, or of a train.
    """

    def members(built: BuiltDrive) -> dict[Label, Ready]:
        every: dict[Label, Ready]
        if analysis.of == "train":
            trains = built.trains_at_work if analysis.under_load else built.trains
            every = {number: train for number, train in trains.items()}
        else:
            meshes = built.at_work if analysis.under_load else built.meshes
            every = dict(zip(built.mesh_labels, meshes, strict=True))
        return {label: member for label, member in every.items() if analysis.lacks(member) is None}

    def pieces(built: BuiltDrive) -> Iterator[Piece]:
        for label, member in members(built).items():
            yield from ({"stage": label, **piece} for piece in analysis.pieces(member))
            if analysis.onward is not None:
                return

    def compute(built: BuiltDrive, piece: Piece, progress: PieceProgress) -> xr.Dataset:
        label = piece["stage"]
        return _labelled(analysis.compute(members(built)[label], piece, progress), label)

    def onward(built: BuiltDrive, last: xr.Dataset, progress: PieceProgress) -> xr.Dataset | None:
        there, label = members(built), as_label(last.attrs[_OF_STAGE])
        march = analysis.onward
        further = None if march is None else march(there[label], last, progress)
        if further is not None:
            return _labelled(further, label)
        behind = [*there][[*there].index(label) + 1 :]
        begun = ((n, piece) for n in behind for piece in analysis.pieces(there[n]))
        return next((compute(built, {"stage": n, **piece}, progress) for n, piece in begun), None)

    def joined(built: BuiltDrive, parts: Sequence[xr.Dataset]) -> xr.Dataset:
        there = members(built)
        groups = groupby(parts, key=lambda part: as_label(part.attrs[_OF_STAGE]))
        of_members = {label: analysis.joined(there[label], [*group]) for label, group in groups}
        for data in of_members.values():
            data.attrs.pop(_OF_STAGE, None)
        drive_data = by_stage(of_members)
        if analysis.under_load and built.locked:
            drive_data.attrs.update(stored([*doubts_of(drive_data.attrs), _UNDER_NO_LOSSES]))
        return drive_data

    march = None if analysis.onward is None else onward
    return replace(
        analysis, of="drive", pieces=pieces, compute=compute, onward=march, joined=joined
    )


_UNDER_NO_LOSSES = Doubt(
    "Friction locks the drive: each stage is under the load that it has without losses.",
    brief="Friction locks the drive: loads of stages are without losses.",
)
_OF_STAGE = "of_stage"
"""Attribute of a piece that is of one stage: its label."""


def _labelled(piece: xr.Dataset, label: Label) -> xr.Dataset:
    return piece.assign_attrs({_OF_STAGE: str(label)})


@dataclass(frozen=True, kw_only=True)
class Several(Entry):
    """Parts of one kind, of which a case may ask for several.

    Attributes:
        each: analyses of those that it asks for.
    """

    each: Callable[[Subject], Iterable[Analysis]]

    def parts(self, subject: Subject) -> Iterable[Analysis]:
        """One for each that a case asks for."""
        return self.each(subject)
