"""Designs in pieces: a file for each range of them, read as one dataset whose values stay on disk."""

import json
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.backends import BackendArray
from xarray.core import indexing

from pitchpoint.core.doubts import doubts_of
from pitchpoint.errors import InputError
from pitchpoint.results.netcdf import decode, encode
from pitchpoint.results.store import load, save_image

__all__ = ["ALONG", "StudyPieces", "Summary", "joined_pieces", "summary_of"]

ALONG = "design"
"""Dimension along which pieces follow each other."""


@dataclass(frozen=True)
class StudyPieces:
    """Where pieces of a study are: in files of a folder, or in memory without one.

    Attributes:
        folder: of the files.
        name: with which their names begin.
        mark: digest of all that decides about their numbers; a file with another one is none of them.
        count: of designs.
        size: designs of a piece; the last one may have fewer.
    """

    folder: Path | None
    name: str
    mark: str
    count: int
    size: int
    held: dict[int, xr.Dataset] = field(default_factory=dict)

    def __len__(self) -> int:
        return -(-self.count // self.size)

    def range(self, number: int) -> tuple[int, int]:
        """First design of a piece, and the one after its last."""
        return number * self.size, min((number + 1) * self.size, self.count)

    def path(self, number: int) -> Path | None:
        """File of a piece; None in memory."""
        return None if self.folder is None else self.folder / f"{self.name}.{number:06d}.nc"

    def missing(self) -> list[int]:
        """Numbers of the pieces that are not there whole."""
        return [number for number in range(len(self)) if not self._there(number)]

    def keep(self, number: int, piece: xr.Dataset | bytes) -> None:
        """Take a piece, as dataset or as the file that it is.

        Raises:
            OSError: the disk is full, say.
        """
        path = self.path(number)
        if path is not None:
            save_image(piece if isinstance(piece, bytes) else encode(piece), path)
        else:
            self.held[number] = decode(piece) if isinstance(piece, bytes) else piece

    def read(self, number: int, only: Collection[str] | None = None) -> xr.Dataset:
        """A piece, or some of its variables."""
        path = self.path(number)
        if path is not None:
            return load(path, only)
        piece = self.held[number]
        return piece if only is None else piece[[name for name in only if name in piece.variables]]

    def _there(self, number: int) -> bool:
        path = self.path(number)
        if path is None:
            return number in self.held
        try:
            return bool(load(path, ()).attrs.get("fingerprint") == self.mark)
        except InputError:
            return False  # none, or damaged: computed again


@dataclass(frozen=True)
class Summary:
    """What all pieces have together, without their values.

    Attributes:
        variables: first of the name, without designs.
        dtypes: that hold the values of all pieces.
        attributes: of the first piece that has figures.
        warnings: each once, in their order.
        codes: how many balances ended how.
        residual, iterations: largest.
        reasons: how many designs have no figures under the first law by the first sentence of its kind, the
            most frequent first; sentences that differ in numbers alone are of one kind.
    """

    variables: Mapping[str, xr.Variable]
    dtypes: Mapping[str, np.dtype[Any]]
    attributes: Mapping[str, Any]
    warnings: Sequence[Any]
    codes: Mapping[int, int]
    residual: float
    iterations: int
    reasons: Mapping[str, int]


def summary_of(pieces: StudyPieces, codes_of: Callable[[xr.Dataset], np.ndarray]) -> Summary:
    """What all pieces have together; one of them is in memory at a time.

    Args:
        pieces: all there.
        codes_of: how balances of a piece ended, see `status.Code`.
    """
    variables: dict[str, xr.Variable] = {}
    kinds: dict[str, list[np.dtype[Any]]] = {}
    attributes: dict[str, Any] = {}
    warnings: dict[Any, None] = {}
    codes: Counter[int] = Counter()
    reasons, first_of = Counter[str](), dict[str, str]()
    solves: list[dict[str, Any]] = []
    for piece in map(pieces.read, range(len(pieces))):
        for name, variable in piece.variables.items():
            kinds.setdefault(str(name), []).append(variable.dtype)
            variables.setdefault(str(name), _head(variable))
        for text in filter(None, map(str, piece["reason"].values[0])):
            kind = _NUMBER.sub("0", text)
            reasons[first_of.setdefault(kind, text)] += 1
        if "solve" in piece.attrs:
            attributes = attributes or dict(piece.attrs)
            warnings |= dict.fromkeys(doubts_of(piece.attrs))
            codes.update(codes_of(piece).tolist())
            solves.append(json.loads(piece.attrs["solve"]))
    dtypes = {name: _holding(kind, len(pieces)) for name, kind in kinds.items()}
    return Summary(
        variables,
        dtypes,
        attributes,
        [*warnings],
        codes,
        max((solve["residual"] for solve in solves), default=0.0),
        max((solve["iterations"] for solve in solves), default=0),
        dict(reasons.most_common()),
    )


_NUMBER = re.compile(r"-?\d+(\.\d+)?(e-?\d+)?")


def _head(variable: xr.Variable) -> xr.Variable:
    """A variable whose designs are left out."""
    return variable.isel({ALONG: slice(0, 0)}).copy() if ALONG in variable.dims else variable


def _holding(kinds: Sequence[np.dtype[Any]], pieces: int) -> np.dtype[Any]:
    """Type that holds the values of all pieces, those without any too."""
    kind = np.result_type(*kinds)
    whole = kind.kind in "iu" and len(kinds) < pieces
    return np.dtype(float) if whole else kind


def joined_pieces(
    pieces: StudyPieces,
    summary: Summary,
    dims: Mapping[str, int],
    shown: Callable[[xr.Dataset], xr.Dataset],
) -> xr.Dataset:
    """All pieces as one dataset, of which values are read when they are asked for.

    Args:
        pieces: all there.
        summary: of them.
        dims: in place of the designs, the last one the fastest.
        shown: a part of a piece in the units of the whole.
    """
    variables = {
        name: _whole(name, pieces, summary, dims, shown)
        for name in summary.variables
        if name != ALONG and name not in dims
    }
    beside = [name for name in variables if "." in name]  # keys, where they are no dimensions
    return xr.Dataset(variables).set_coords(beside)


def _whole(
    name: str,
    pieces: StudyPieces,
    summary: Summary,
    dims: Mapping[str, int],
    shown: Callable[[xr.Dataset], xr.Dataset],
) -> xr.Variable:
    head = shown(xr.Dataset({name: summary.variables[name]}))[name].variable
    if ALONG not in head.dims:
        return head
    at = head.dims.index(ALONG)
    before, after = head.shape[:at], head.shape[at + 1 :]

    def read(number: int) -> np.ndarray | None:
        part = shown(pieces.read(number, [name]).drop_vars(ALONG, errors="ignore"))
        return part[name].values if name in part.variables else None

    values = _Values(read, pieces, (before, tuple(dims.values()), after), summary.dtypes[name])
    names = [*head.dims[:at], *dims, *head.dims[at + 1 :]]
    return xr.Variable(names, indexing.LazilyIndexedArray(values), head.attrs)


_NOTHING: Mapping[str, Any] = {"U": "", "b": False, "i": 0, "u": 0}
"""What stands for designs without figures, by kind of type; not a number otherwise. None lack whole ones."""


class _Values(BackendArray):
    """Values of a variable, read from the pieces that an index asks for."""

    def __init__(
        self,
        read: Callable[[int], np.ndarray | None],
        pieces: StudyPieces,
        shapes: tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]],
        dtype: np.dtype[Any],
    ) -> None:
        self.read, self.pieces = read, pieces
        self.before, self.designs, self.after = shapes
        self.shape, self.dtype = sum(shapes, ()), dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:
        outer = indexing.IndexingSupport.OUTER
        return indexing.explicit_indexing_adapter(key, self.shape, outer, self._taken)

    def _taken(self, key: tuple[Any, ...]) -> np.ndarray:
        every = [np.arange(size)[index] for size, index in zip(self.shape, key, strict=True)]
        places = [np.atleast_1d(index) for index in every]
        first, last = len(self.before), len(self.before) + len(self.designs)
        at = np.ix_(*places[first:last])
        flat = np.ravel_multi_index(at, self.designs).ravel() if last > first else np.zeros(1, int)
        made = self._of_designs(flat, places[:first], places[last:])
        return made.reshape([size for index in every for size in np.shape(index)])

    def _of_designs(
        self, flat: np.ndarray, before: Sequence[np.ndarray], after: Sequence[np.ndarray]
    ) -> np.ndarray:
        shape = [*map(len, before), len(flat), *map(len, after)]
        made = np.full(shape, _NOTHING.get(self.dtype.kind, np.nan), self.dtype)
        axis = len(before)
        numbers = flat // self.pieces.size
        for number in np.unique(numbers).tolist():
            values = self.read(number)
            if values is not None:
                here = np.flatnonzero(numbers == number)
                inside = [*before, flat[here] - number * self.pieces.size, *after]
                made[(slice(None),) * axis + (here,)] = values[np.ix_(*inside)]
        return made
