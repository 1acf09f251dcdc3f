"""Many designs of a case computed together; one that cannot be computed says why, and stops no other."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, Progress, silent
from pitchpoint.analyses.studies import more_of
from pitchpoint.analyses.summaries import joined, summaries
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError, PitchpointError

__all__ = ["Designs"]

PIECE = 256
"""Designs that are computed, and kept on disk, together."""

LOCKED = "friction locks the mesh"
UNKNOWN = "no solution was found"
REASON = "why there are no figures"
OUTSIDE = "why the friction law does not hold"


@dataclass(frozen=True)
class Designs:
    """Designs of a case.

    Attributes:
        name: of the part.
        variant: the case.
        changes: of each design, by dotted key.
    """

    name: str
    variant: Variant
    changes: Sequence[Mapping[str, Any]]

    @property
    def analysis(self) -> Analysis:
        """The designs as a part of a result."""
        return Analysis(
            name=self.name,
            title="designs",
            of="drive",
            compute=self.compute,
            pieces=lambda _: self.pieces,
            joined=self.joined,
        )

    @property
    def pieces(self) -> list[Piece]:
        """Ranges of designs."""
        count = len(self.changes)
        return [{"first": n, "stop": min(n + PIECE, count)} for n in range(0, count, PIECE)]

    def compute(self, _: Ready, piece: Piece, progress: Progress = silent) -> xr.Dataset:
        """Figures of those of a range that can be computed; why not of the others, as attribute."""
        points: dict[int, Ready] = {}
        reasons: dict[int, str] = {}
        built = self.variant.built_each(self.changes[piece["first"] : piece["stop"]])
        for number, one in enumerate(built, piece["first"]):
            if isinstance(one, InputError):
                reasons[number] = _told(one)
            else:
                points[number] = one
        found = _figures(points, reasons) if points else []
        data = joined(found) if found else xr.Dataset()
        return data.assign_attrs(reasons=json.dumps(reasons))

    def joined(self, _: Ready, pieces: Sequence[xr.Dataset]) -> xr.Dataset:
        """All designs [law, point], NaN where there are no figures, with the reason.

        Raises:
            InputError: no design can be computed.
        """
        reasons = {
            int(number): told
            for piece in pieces
            for number, told in json.loads(piece.attrs["reasons"]).items()
        }
        found = [piece for piece in pieces if piece.data_vars]
        if not found:
            first = next(iter(reasons.values()), "")
            told = f"none of {len(self.changes)} designs can be computed; the first one: {first}"
            raise InputError(told, file=self.variant.name)
        every = joined(found).reindex(
            point=np.arange(len(self.changes)), fill_value={"locked": False, "out_of_range": ""}
        )
        every["reason"] = (("law", "point"), _reasons(every, reasons), {"long_name": REASON})
        if "out_of_range" in every:
            every["out_of_range"].attrs["long_name"] = OUTSIDE
        return every.drop_vars("point")


def _figures(points: Mapping[int, Ready], reasons: dict[int, str]) -> list[xr.Dataset]:
    """Figures of designs, together; each alone where one of them spoils that, which then has a reason."""
    try:
        return [_together(points)]
    except PitchpointError as error:
        if len(points) == 1:
            reasons[next(iter(points))] = _told(error)
            return []
    return [part for number, one in points.items() for part in _figures({number: one}, reasons)]


def _together(points: Mapping[int, Ready]) -> xr.Dataset:
    every = [*points.values()]
    under = every[0].models
    extra = more_of(every, len(under))
    data = summaries(every, under, extra, title="designs", may_lock=True, several=True)
    return data.assign_coords(point=[*points])


def _reasons(data: xr.Dataset, failed: Mapping[int, str]) -> np.ndarray:
    """Why there are no figures [law, point]; empty where there are."""
    missing = np.isnan(data["mean_loss"].values)
    why = np.where(data["locked"].values.astype(bool), LOCKED, np.where(missing, UNKNOWN, ""))
    why = why.astype(object)
    for number, told in failed.items():
        why[:, number] = told
    return why.astype(str)


def _told(error: PitchpointError) -> str:
    """Sentence of an error without the name of the file."""
    key, message = getattr(error, "key", None), getattr(error, "message", str(error))
    return f"{key}: {message}" if key else message
