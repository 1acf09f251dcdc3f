"""Many designs of a case computed together; one that cannot be computed says why, and stops no other."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import PieceProgress, silent
from pitchpoint.analyses.studies import more_of
from pitchpoint.analyses.summaries import joined_points, summaries
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError, PitchpointError

__all__ = ["TOGETHER", "CaseDesigns"]

TOGETHER = 256
"""Designs that are computed together."""

LOCKED = "friction locks the mesh"
UNKNOWN = "no solution was found"
REASON = "why there are no figures"
OUTSIDE = "why the friction law does not hold"


@dataclass(frozen=True)
class CaseDesigns:
    """Designs of a case.

    Attributes:
        variant: the case.
        changes: of each design, by dotted key.
    """

    variant: Variant
    changes: Sequence[Mapping[str, Any]]

    def compute(self, progress: PieceProgress = silent) -> xr.Dataset:
        """All designs [law, point], NaN where there are no figures, with the reason.

        Args:
            progress: told how many are done.
        """
        reasons: dict[int, str] = {}
        figures: list[xr.Dataset] = []
        for first in range(0, len(self.changes), TOGETHER):
            progress(first)
            figures += self._range(first, reasons)
        return self._joined(figures, reasons)

    def _range(self, first: int, reasons: dict[int, str]) -> list[xr.Dataset]:
        """Figures of those of a range that can be computed; of the others the reason is noted."""
        points: dict[int, Ready] = {}
        built = self.variant.built_each(self.changes[first : first + TOGETHER])
        for number, design in enumerate(built, first):
            if isinstance(design, InputError):
                reasons[number] = _told(design)
            else:
                points[number] = design
        return _figures(points, [*self.changes[0]], reasons) if points else []

    def _joined(self, found: Sequence[xr.Dataset], reasons: Mapping[int, str]) -> xr.Dataset:
        if not found:
            laws = [models.law.name for models in self.variant.built({}).models]
            why = np.array([[*reasons.values()]] * len(laws), dtype=str)
            return xr.Dataset(
                {"reason": (("law", "point"), why, {"long_name": REASON})}, {"law": laws}
            )
        every = joined_points(found).reindex(
            point=np.arange(len(self.changes)), fill_value={"locked": False, "out_of_range": ""}
        )
        every["reason"] = (("law", "point"), _reasons(every, reasons), {"long_name": REASON})
        if "out_of_range" in every:
            every["out_of_range"].attrs["long_name"] = OUTSIDE
        return every.drop_vars("point")


def _figures(
    points: Mapping[int, Ready], keys: Collection[str], reasons: dict[int, str]
) -> list[xr.Dataset]:
    """Figures of designs, together; each alone where one of them spoils that, which then has a reason."""
    try:
        return [_together(points, keys)]
    except PitchpointError as error:
        if len(points) == 1:
            reasons[next(iter(points))] = _told(error)
            return []
    return [
        part
        for number, design in points.items()
        for part in _figures({number: design}, keys, reasons)
    ]


def _together(points: Mapping[int, Ready], keys: Collection[str]) -> xr.Dataset:
    every = [*points.values()]
    under = every[0].models
    extra = more_of(every, len(under), keys)
    data = summaries(every, under, extra, title="designs", may_lock=True, several=True)
    return data.assign_coords(point=[*points])


def _reasons(data: xr.Dataset, failed: Mapping[int, str]) -> np.ndarray:
    """Why there are no figures [law, point]; empty where there are."""
    missing = np.isnan(data["mean_loss"].values)
    why = np.where(data["locked"].values.astype(bool), LOCKED, np.where(missing, UNKNOWN, ""))
    why = why.astype(object)
    for number, reason in failed.items():
        why[:, number] = reason
    return why.astype(str)


def _told(error: PitchpointError) -> str:
    """Sentence of an error without the name of the file."""
    key, message = getattr(error, "key", None), getattr(error, "message", str(error))
    return f"{key}: {message}" if key else message
