"""Height maps of rough surfaces in files that a case names."""

import hashlib
import os
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from pitchpoint.cases.schema import FilmTable, HeightTable
from pitchpoint.errors import LONGEST_PLACE, InputError, shorten, visible
from pitchpoint.lubrication.ehl.patch.heights import HeightMap

__all__ = ["MEMBERS", "digest_of", "height_maps"]

MEMBERS: Final[Mapping[str, int | None]] = {"gear_1": 0, "gear_2": 1, "both": None}
"""Surfaces that a map is of, by key, and the body that takes it along."""

MOST_BYTES: Final = 64_000_000
"""Size of the largest file."""

_COMMA: Final = ","
_TEXTS: Final[Mapping[str, str | None]] = {".csv": _COMMA, ".txt": None}
"""What stands between heights in files of text, by their ending; None for blanks."""


def height_maps(table: FilmTable, *, moving: bool = False) -> tuple[HeightMap, ...]:
    """Height maps of a case, with the middle of each where it lies in the contact.

    Args:
        table: as validated.
        moving: whether maps of one gear move along with it; those of both together always stay.

    Raises:
        InputError: a file that cannot be read, that holds no heights, or too few.
    """
    if table.heights is None:
        return ()
    given = ((name, getattr(table.heights, name)) for name in MEMBERS)
    return tuple(
        _map(one, MEMBERS[name] if moving else None, f"film.heights.{name}.file")
        for name, one in given
        if one is not None
    )


def digest_of(file: str) -> str:
    """Digest of what a file holds; empty where it cannot be read."""
    try:
        return hashlib.sha256(Path(file).read_bytes()).hexdigest()
    except OSError:
        return ""


def _map(table: HeightTable, member: int | None, key: str) -> HeightMap:
    try:
        heights = _read(table.file, _stamp(table.file)) * table.unit
    except InputError as error:
        name = visible(shorten(os.path.basename(table.file)))
        raise InputError(f'"{name}" {error.message}', key=key) from None
    rows, columns = heights.shape
    x = table.middle_along + table.step_along * (np.arange(columns) - 0.5 * (columns - 1))
    y = table.middle_across + table.step_across * (np.arange(rows) - 0.5 * (rows - 1))
    return HeightMap(x=x, y=y, heights=heights, member=member, periodic=table.periodic)


def _stamp(file: str) -> tuple[int, int]:
    """Size and time of change of a file, by which it is read anew."""
    try:
        found = os.stat(file)
    except (OSError, ValueError):
        folder = os.path.dirname(file)
        where = f" in {visible(shorten(folder, LONGEST_PLACE))}" if folder else ""
        raise InputError(f"is no file{where}: there are no heights to read") from None
    if os.path.isdir(file):
        raise InputError("is a folder; give a file with heights")
    if found.st_size > MOST_BYTES:
        told = f"a file of heights has at most {MOST_BYTES / 1e6:g} MB"
        raise InputError(f"has {found.st_size / 1e6:.4g} MB; {told}")
    return found.st_size, found.st_mtime_ns


@lru_cache(maxsize=4)
def _read(file: str, stamp: tuple[int, int]) -> np.ndarray:
    """Heights in the unit of the file, shape (y, x)."""
    ending = Path(file).suffix.lower()
    if ending == ".npy":
        heights = _array(file)
    elif ending in _TEXTS:
        heights = _text(file, _TEXTS[ending])
    else:
        raise InputError("is no file of heights; those end in .csv, .txt or .npy")
    if not heights.size:
        raise InputError("holds no heights")
    if heights.ndim != 2 or min(heights.shape) < 2:
        raise InputError(
            f"has the shape {heights.shape}; a height map has at least two rows, across the contact, and two "
            "columns, along it"
        )
    wrong = int(np.sum(~np.isfinite(heights)))
    if wrong:
        which = "one height" if wrong == 1 else f"{wrong} heights"
        raise InputError(f"has {which} that {'is' if wrong == 1 else 'are'} no finite number")
    return heights


def _array(file: str) -> np.ndarray:
    try:
        held: Any = np.load(file, mmap_mode="r", allow_pickle=False)
    except (OSError, ValueError, EOFError):
        raise InputError("cannot be read as an array of NumPy") from None
    if not isinstance(held, np.ndarray) or held.dtype.kind not in "fiu":
        raise InputError("holds no array of real numbers")
    return np.array(held, float)


def _text(file: str, between: str | None) -> np.ndarray:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of a file without heights
            return np.loadtxt(file, delimiter=between, ndmin=2, encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("is not UTF-8 text") from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}") from None
    except ValueError:
        rows = "commas" if between == _COMMA else "blanks"
        ends = ", none at the end of a row" if between == _COMMA else ""
        raise InputError(
            f"is no table of numbers: rows of equally many heights with {rows} between them{ends}"
        ) from None
