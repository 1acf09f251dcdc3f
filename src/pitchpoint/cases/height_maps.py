"""Height maps of rough surfaces in files that a case names."""

import io
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
from pitchpoint.plain_files import content, digest, opened

__all__ = ["MEMBERS", "digest_of", "height_maps"]

MEMBERS: Final[Mapping[str, int | None]] = {"gear_1": 0, "gear_2": 1, "both": None}
"""Surfaces that a map is of, by key, and the body that takes it along."""

MOST_BYTES: Final = 64_000_000
"""Size of the largest file."""

MOST_HEIGHTS: Final = 16_000_000
"""Heights of the largest map; each takes eight bytes once it is used, be it one byte in its file."""

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
        return digest(Path(file), MOST_BYTES)
    except InputError:
        return ""


def _map(table: HeightTable, member: int | None, key: str) -> HeightMap:
    try:
        held = _read(table.file, _stamp(table.file))
    except InputError as error:
        name = visible(shorten(os.path.basename(table.file)))
        raise InputError(f'"{name}" {error.message}', key=key) from None
    heights = np.multiply(held, table.unit, dtype=float)
    rows, columns = heights.shape
    x = table.middle_along + table.step_along * (np.arange(columns) - 0.5 * (columns - 1))
    y = table.middle_across + table.step_across * (np.arange(rows) - 0.5 * (rows - 1))
    return HeightMap(x=x, y=y, heights=heights, member=member, periodic=table.periodic)


def _stamp(file: str) -> tuple[int, int]:
    """Size and time of change of a file, by which it is read anew."""
    try:
        with opened(Path(file), MOST_BYTES, "file of heights") as held:
            found = os.fstat(held.fileno())
    except InputError as error:
        folder = os.path.dirname(file)
        where = f" in {visible(shorten(folder, LONGEST_PLACE))}" if folder else ""
        raise InputError(f"{error.message}{where}") from None
    return found.st_size, found.st_mtime_ns


@lru_cache(maxsize=4)
def _read(file: str, stamp: tuple[int, int]) -> np.ndarray:
    """Heights in the unit and of the type of the file, shape (y, x)."""
    ending = Path(file).suffix.lower()
    if ending not in (".npy", *_TEXTS):
        raise InputError("is no file of heights; those end in .csv, .txt or .npy")
    held = io.BytesIO(content(Path(file), MOST_BYTES, "file of heights"))
    heights = _array(held) if ending == ".npy" else _text(held, _TEXTS[ending])
    if not heights.size:
        raise InputError("holds no heights")
    if heights.size > MOST_HEIGHTS:
        raise InputError(
            f"holds {heights.size / 1e6:.6g} million heights; a height map has at most "
            f"{MOST_HEIGHTS / 1e6:g} million: cut it, or take means of neighbours"
        )
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


def _array(file: io.BytesIO) -> np.ndarray:
    try:
        held: Any = np.load(file, allow_pickle=False)
    except Exception:  # its head is anybody's, and NumPy raises what it likes
        raise InputError("cannot be read as an array of NumPy") from None
    if not isinstance(held, np.ndarray) or held.dtype.kind not in "fiu":
        raise InputError("holds no array of real numbers")
    return held


def _text(file: io.BytesIO, between: str | None) -> np.ndarray:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of a file without heights
            return np.loadtxt(file, delimiter=between, ndmin=2, encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("is not UTF-8 text") from None
    except ValueError:
        rows = "commas" if between == _COMMA else "blanks"
        ends = ", none at the end of a row" if between == _COMMA else ""
        raise InputError(
            f"is no table of numbers: rows of equally many heights with {rows} between them{ends}"
        ) from None
