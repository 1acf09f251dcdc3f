"""A study as a description of some hundred bytes, from which any piece of it is computed in any process."""

import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import double_precision
from pitchpoint.analyses.analysis import PieceProgress as AnalysisProgress
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.analyses.made_gears import unfollowed
from pitchpoint.cases.record import OUTPUT
from pitchpoint.cases.variant import Variant
from pitchpoint.core.programs import bound_programs, surroundings
from pitchpoint.results.netcdf import encode
from pitchpoint.results.pieces import ALONG
from pitchpoint.results.store import fingerprint
from pitchpoint.runs.case import in_si
from pitchpoint.runs.layouts import DRAWN, StudyLayout, layout_of
from pitchpoint.runs.run import mark_of

__all__ = ["StudyDescription", "piece_elsewhere"]

_PART = "designs"
_OF_VARIANT = ("tree", "name", "variant", "settings", "recorded")


@dataclass(frozen=True)
class StudyDescription:
    """All that decides about the designs of a study.

    Attributes:
        variant: the case.
        over: values by whole key, see `StudyAxis.described`.
        how, n, seed: see `study`.
        size: designs of a piece.
    """

    variant: Variant
    over: Mapping[str, Any]
    how: str
    n: int | None
    seed: int
    size: int

    @classmethod
    @lru_cache(maxsize=4)
    def read(cls, packed: bytes) -> "StudyDescription":
        """The description that `packed` made."""
        plain = json.loads(zlib.decompress(packed))
        folder = plain["case"].pop("folder")
        variant = Variant(**plain["case"], folder=None if folder is None else Path(folder))
        return cls(variant, **plain["study"])

    @cached_property
    def packed(self) -> bytes:
        """The description as another process takes it; a law of the user's own is not in it."""
        case = {name: getattr(self.variant, name) for name in _OF_VARIANT}
        folder = None if self.variant.folder is None else str(self.variant.folder)
        plain = {"case": {**case, "folder": folder}, "study": self._layout}
        return zlib.compress(json.dumps(plain, separators=(",", ":")).encode(), 9)

    @property
    def _layout(self) -> dict[str, Any]:
        return {
            "over": self.over,
            "how": self.how,
            "n": self.n,
            "seed": self.seed,
            "size": self.size,
        }

    @cached_property
    def layout(self) -> StudyLayout:
        """Values of the designs; InputError for what cannot be."""
        return layout_of(self.variant, self.over, self.how, self.n, self.seed)

    @cached_property
    def mark(self) -> str:
        """Digest of the description, of the code and of what it runs on: equal ones give equal bits."""
        tree = self.variant.document().tree
        case = in_si({key: table for key, table in tree.items() if key != OUTPUT})
        layout = {**self._layout, "over": {key: in_si(one, key) for key, one in self.over.items()}}
        return fingerprint(mark_of(self.variant, _PART), case, layout, self.decisive)

    @property
    def decisive(self) -> dict[str, str]:
        """What decides about the numbers beside the description: drawn designs are those of SciPy."""
        drawn = {"scipy": version("scipy")} if self.how in DRAWN else {}
        return {**surroundings(), **drawn}

    @cached_property
    def _remarks(self) -> list[str]:
        """Sentences on figures that do not follow what changes."""
        return unfollowed(self.variant.built({}), self.layout.axes)

    def computed(self, first: int, stop: int, progress: AnalysisProgress = silent) -> xr.Dataset:
        """Figures [law, design] of a range of designs, with their values as coordinates.

        Args:
            first, stop: of the range.
            progress: told how many of them are done.
        """
        bound_programs()  # those of the pieces before
        columns = self.layout.columns(first, stop)
        data = CaseDesigns(self.variant, self.layout.changes(first, stop)).compute(progress)
        labels = {"case": self.variant.label, "variant": self.variant.variant}
        labels["remarks"] = json.dumps(self._remarks)
        keys: dict[str, Any] = {
            key: (ALONG, *self.layout.axes[key].stored(values)) for key, values in columns.items()
        }
        return (
            data.rename(point=ALONG)
            .assign_coords({ALONG: np.arange(first, stop), **keys})
            .assign_attrs({**labels, "fingerprint": self.mark})
        )


@double_precision()
def piece_elsewhere(packed: bytes, mark: str, first: int, stop: int) -> bytes | dict[str, str]:
    """The file of a piece, computed in a process that shares nothing with the one that asks.

    Args:
        packed: description of the study.
        mark: of the study where it was asked for.
        first, stop: range of designs.

    Returns:
        The file; what decides about numbers here, where that is not what decides there.
    """
    study = StudyDescription.read(packed)
    if study.mark != mark:
        return study.decisive
    return encode(study.computed(first, stop))
