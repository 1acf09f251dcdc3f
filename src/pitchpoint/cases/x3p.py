"""Heights in files of the kind x3p (ISO 25178-72): a ZIP archive of a description and binary numbers.

Whoever wrote it, an archive unpacks to no more than its heights can be, and its description declares nothing.
"""

import io
import zipfile
from collections.abc import Callable
from typing import Final, NamedTuple, TypeVar
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np

from pitchpoint.errors import InputError, shorten

__all__ = ["Heights", "read_x3p"]

MAIN: Final = "main.xml"
MOST_WORDS: Final = 1_000_000
"""Bytes of a description; real ones have some thousand."""

_TYPES: Final = {"I": "<i2", "L": "<i4", "F": "<f4", "D": "<f8"}
_AXES: Final = "{*}Record1/{*}Axes/{*}"
_SIZES: Final = "{*}Record3/{*}MatrixDimension/{*}Size"
_LINKS: Final = "{*}Record3/{*}DataLink/{*}"


Number = TypeVar("Number", int, float)


class Heights(NamedTuple):
    """Heights as a file has them.

    Attributes:
        heights: shape (y, x); of a profile (x, 1), NaN where none was measured.
        unit: what a height of one is [m]; None where the file does not say.
        steps: distances along and across [m]; None where the file does not say, or there are none.
        apart: distance of the places of a profile in the unit of the file; None where there are none.
    """

    heights: np.ndarray
    unit: float | None = None
    steps: tuple[float | None, float | None] = (None, None)
    apart: float | None = None


def read_x3p(file: io.BytesIO, most: int) -> Heights:
    """Heights of an archive on a regular grid.

    Args:
        file: the archive.
        most: heights that it may hold.

    Raises:
        InputError: no such archive, or one of other points than those of a grid.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            return _Description(_unpacked(archive, MAIN, MOST_WORDS)).heights(archive, most)
    except InputError:
        raise
    except Exception:  # of anybody's archive: zipfile, zlib and expat raise what they like
        raise InputError("cannot be read as x3p, an archive with main.xml and its data") from None


def _unpacked(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    """A part of the archive, of which no more is unpacked than it may have."""
    with archive.open(name) as part:
        held = part.read(most + 1)
    if len(held) > most:
        raise InputError(
            f'holds "{shorten(name)}" of more than {most} bytes, the most that it needs'
        )
    return held


def _refuse(*_: object) -> None:
    raise InputError("declares a document type in main.xml, which no description of heights needs")


class _Description:
    """What `main.xml` says."""

    def __init__(self, content: bytes) -> None:
        parser = expat.ParserCreate()
        parser.StartDoctypeDeclHandler = (
            _refuse  # what expands, or reads other files, is declared there
        )
        parser.Parse(content, True)
        self.root = ElementTree.fromstring(content)

    def heights(self, archive: zipfile.ZipFile, most: int) -> Heights:
        """Heights of the archive that is described."""
        columns, rows, layers = (self.value(_SIZES + axis, int) for axis in "XYZ")
        if min(columns, rows) < 1 or layers != 1:
            complaint = f"has {columns} x {rows} x {layers} points"
            raise InputError(f"{complaint}; a height map has one layer of them on a grid")
        if columns * rows > most:
            complaint = f"holds {columns * rows / 1e6:.6g} million heights"
            raise InputError(f"{complaint}; a height map has at most {most / 1e6:g} million")
        kind = np.dtype(_TYPES[self.text(_AXES + "CZ/{*}DataType")])
        data = _unpacked(
            archive, self.text(_LINKS + "PointDataLink"), columns * rows * kind.itemsize
        )
        heights = np.frombuffer(data, kind).reshape(rows, columns)
        scale = self.value(_AXES + "CZ/{*}Increment", float) if kind.kind == "i" else 1.0
        heights = self.measured(archive, heights)
        steps = self.step("CX"), self.step("CY") if rows > 1 else None
        return Heights(heights if rows > 1 else heights.T, scale, steps)

    def measured(self, archive: zipfile.ZipFile, found: np.ndarray) -> np.ndarray:
        """Heights with NaN where the archive says that none was measured."""
        link = self.root.findtext(_LINKS + "ValidPointsLink")
        if not link:
            return found
        packed = _unpacked(archive, link, found.size // 8 + 1)
        valid = np.unpackbits(np.frombuffer(packed, np.uint8), bitorder="little")[: found.size]
        return np.where(valid.reshape(found.shape) == 1, found, np.nan)

    def step(self, axis: str) -> float:
        """Distance of the points along an axis [m]; InputError unless they are evenly apart."""
        if self.text(f"{_AXES}{axis}/{{*}}AxisType") != "I":
            raise InputError(
                "has points with places of their own; a height map has them on an even grid"
            )
        return self.value(f"{_AXES}{axis}/{{*}}Increment", float)

    def text(self, place: str) -> str:
        """What stands at a place; InputError where nothing does."""
        entry = self.root.findtext(place)
        if entry is None:
            name = place.replace("{*}", "")
            raise InputError(f"lacks {name} in main.xml, so its heights are not known")
        return entry.strip()

    def value(self, place: str, kind: Callable[[str], Number]) -> Number:
        """A positive number at a place; InputError where there is none."""
        number = kind(self.text(place))
        if not 0 < number < 1e9:
            name = place.replace("{*}", "")
            raise InputError(f"says {number:g} at {name} in main.xml; it has to be positive")
        return number
