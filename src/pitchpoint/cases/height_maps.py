"""Height maps and profiles of rough surfaces in files that a case names."""

import io
import os
import warnings
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

import numpy as np

from pitchpoint.cases.x3p import Heights, read_x3p
from pitchpoint.core.plain_files import MOST_BYTES, content, plain_file
from pitchpoint.errors import LONGEST_PLACE, InputError, shorten, visible
from pitchpoint.lubrication.ehl.film_tables import MEMBERS, FilmTable, HeightTable
from pitchpoint.lubrication.ehl.patch.heights import HeightMap

__all__ = ["height_maps"]

MOST_HEIGHTS: Final = 16_000_000
"""Heights of the largest map; each takes eight bytes once it is used, be it one byte in its file."""

WIDE: Final = 2.0
"""Width over which a profile is the same, more than any contact has [m]."""

_UNEVEN: Final = 0.05
"""Part of a step by which the place of a profile may lie beside an even grid."""

_LENGTHS: Final = (1e-9, 1e-6, 1e-3, 1e-2, 1.0, 0.0254)
"""Units in which places are written [m]."""

_ARCHIVE: Final = ".x3p"
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
    heights = ((name, getattr(table.heights, name)) for name in MEMBERS)
    return tuple(
        _map(height_table, MEMBERS[name] if moving else None, f"film.heights.{name}.file")
        for name, height_table in heights
        if height_table is not None
    )


def _map(table: HeightTable, member: int | None, key: str) -> HeightMap:
    try:
        held = _read(table.file, _stamp(table.file))
    except InputError as error:
        name = visible(shorten(os.path.basename(table.file)))
        raise InputError(f'"{name}" {error.message}', key=key) from None
    profile = held.heights.shape[1] == 1
    along, across = _steps(table, held, key.removesuffix(".file"), profile=profile)
    unit = table.unit if held.unit is None else held.unit
    heights = np.multiply(_oriented(held.heights, table.direction), unit, dtype=float)
    rows, columns = heights.shape
    x = table.middle_along + along * (np.arange(columns) - 0.5 * (columns - 1))
    y = table.middle_across + across * (np.arange(rows) - 0.5 * (rows - 1))
    return HeightMap(x=x, y=y, heights=heights, member=member, periodic=table.periodic)


def _oriented(heights: np.ndarray, direction: str) -> np.ndarray:
    """Heights over y and x: a profile along x or y, the same at both ends of the other way."""
    if heights.shape[1] > 1:
        return heights
    both = np.repeat(heights, 2, axis=1)
    return both.T if direction == "along" else both


def _steps(table: HeightTable, held: Heights, key: str, *, profile: bool) -> tuple[float, float]:
    """Distances of heights along and across; InputError where nobody says them, or two do."""
    for name in ("unit", "step_along", "step_across"):
        if held.unit is not None and name in table.model_fields_set:
            raise InputError("is said by an x3p file itself; leave it out", key=f"{key}.{name}")
    steps = {"along": table.step_along, "across": table.step_across}
    if held.unit is not None:
        file_steps = held.steps if not profile or table.direction == "along" else held.steps[::-1]
        steps = dict(zip(steps, file_steps, strict=True))
    if profile:
        steps["across" if table.direction == "along" else "along"] = WIDE
    for direction, step in steps.items():
        if step is None:
            what = f"profile {direction} the surface speeds" if profile else "height map"
            message = f"is missing; a {what} needs the distance of its heights, such as"
            raise InputError(f'{message} step_{direction} = "5 um"', key=f"{key}.step_{direction}")
        if direction == table.direction and held.apart is not None:
            _demand_apart(held.apart, step, f"{key}.step_{direction}")
    return tuple(steps.values())  # type: ignore[return-value]  # none is None by now


def _demand_apart(apart: float, step: float, key: str) -> None:
    """InputError unless places of a file are a step apart in some unit of length."""
    if min(abs(apart * unit / step - 1.0) for unit in _LENGTHS) > _UNEVEN:
        raise InputError(
            f"{1e6 * step:.6g} um was given, and the places in the file are {apart:.6g} apart, which is that "
            "neither in nm, um, mm, cm, m nor in inches",
            key=key,
        )


def _stamp(file: str) -> tuple[int, int]:
    """Size and time of change of a file, by which it is read anew."""
    try:
        with plain_file(Path(file), MOST_BYTES, "file of heights") as held:
            status = os.fstat(held.fileno())
    except InputError as error:
        folder = os.path.dirname(file)
        where = f" in {visible(shorten(folder, LONGEST_PLACE))}" if folder else ""
        raise InputError(f"{error.message}{where}") from None
    return status.st_size, status.st_mtime_ns


@lru_cache(maxsize=4)
def _read(file: str, stamp: tuple[int, int]) -> Heights:
    """Heights of the type of the file, shape (y, x), of a profile (x, 1)."""
    ending = Path(file).suffix.lower()
    if ending not in (".npy", _ARCHIVE, *_TEXTS):
        raise InputError("is no file of heights; those end in .csv, .txt, .npy or .x3p")
    packed = io.BytesIO(content(Path(file), MOST_BYTES, "file of heights"))
    if ending == _ARCHIVE:
        held = read_x3p(packed, MOST_HEIGHTS)
    else:
        heights = _array(packed) if ending == ".npy" else _text(packed, _TEXTS[ending])
        held = _told_apart(_grid(heights))
    wrong = int(np.sum(~np.isfinite(held.heights)))
    if wrong:
        which = "one height" if wrong == 1 else f"{wrong} heights"
        raise InputError(f"has {which} that {'is' if wrong == 1 else 'are'} no finite number")
    return held


def _grid(heights: np.ndarray) -> np.ndarray:
    """Heights over y and x, of a profile over x alone."""
    if not heights.size:
        raise InputError("holds no heights")
    if heights.size > MOST_HEIGHTS:
        raise InputError(
            f"holds {heights.size / 1e6:.6g} million heights; a height map has at most "
            f"{MOST_HEIGHTS / 1e6:g} million: cut it, or take means of neighbours"
        )
    grid = heights[:, None] if heights.ndim == 1 else heights
    if grid.ndim != 2 or len(grid) < 2:
        raise InputError(
            f"has the shape {heights.shape}; a height map has at least two rows, across the contact, and "
            "three columns, along it; a profile has a row for each height"
        )
    return grid


def _told_apart(grid: np.ndarray) -> Heights:
    """A map, or a profile without its places; InputError for places that are not evenly apart."""
    if grid.shape[1] != 2:
        return Heights(grid)
    places = grid[:, 0].astype(float)
    step = (places[-1] - places[0]) / (len(places) - 1)
    even = places[0] + step * np.arange(len(places))
    # Places that were rounded for print pass.
    if not (step > 0.0 and np.max(np.abs(places - even)) < _UNEVEN * step):
        raise InputError(
            "has two columns, which are the places and the heights of a profile, and its places do not rise "
            "evenly; a height map has three columns at least"
        )
    return Heights(grid[:, 1:], apart=float(step))


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
