"""Files that others name: regular ones of at most so many bytes, whatever stands at the name.

A pipe would never end, a device neither, and a file may be larger than the memory.
"""

import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Final

from pitchpoint.errors import InputError

__all__ = ["MOST_BYTES", "content", "digest", "digest_of", "plain_file"]

_PIECE = 1 << 20
_WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)


@contextmanager
def plain_file(path: Path, most: int, what: str = "file") -> Iterator[BinaryIO]:
    """A regular file, open for reading.

    Args:
        path: of the file.
        most: bytes that it may have.
        what: a word for it.

    Raises:
        InputError: there is none, or a folder, a pipe, a device; a larger one; one that cannot be read.
    """
    try:
        _demand_regular(os.stat(path).st_mode, path, what)
        with os.fdopen(os.open(path, os.O_RDONLY | _WITHOUT_WAITING), "rb") as file:
            held = os.fstat(file.fileno())  # another one may have taken its place
            _demand_regular(held.st_mode, path, what)
            _demand_small(held.st_size, most, path, what)
            yield file
    except (FileNotFoundError, NotADirectoryError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"there is no such {what}", file=str(path)) from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", file=str(path)) from None


def content(path: Path, most: int, what: str = "file") -> bytes:
    """What a regular file holds; InputError as of `plain_file`.

    Args:
        path: of the file.
        most: bytes that it may have.
        what: a word for it.
    """
    with plain_file(path, most, what) as file:
        held = file.read(most + 1)
    _demand_small(len(held), most, path, what)  # some tell no size, or grow
    return held


def digest(path: Path, most: int) -> str:
    """SHA-256 of what a regular file holds, read in pieces; InputError as of `plain_file`.

    Args:
        path: of the file.
        most: bytes that it may have.
    """
    made, length = hashlib.sha256(), 0
    with plain_file(path, most) as file:
        while piece := file.read(_PIECE):
            made.update(piece)
            length += len(piece)
            _demand_small(length, most, path, "file")
    return made.hexdigest()


def _demand_regular(mode: int, path: Path, what: str) -> None:
    if stat.S_ISDIR(mode):
        raise InputError(f"is a folder; give a {what}", file=str(path))
    if not stat.S_ISREG(mode):
        raise InputError(f"is a pipe or a device; give a {what}", file=str(path))


def _demand_small(size: int, most: int, path: Path, what: str) -> None:
    if size > most:
        told = f"has {size / 1e6:.4g} MB; a {what} has at most {most / 1e6:g} MB"
        raise InputError(told, file=str(path))


MOST_BYTES: Final = 64_000_000
"""Size of the largest file."""


def digest_of(file: str, largest: int = MOST_BYTES) -> str:
    """Digest of what a file holds; empty where it cannot be read, or holds more bytes than the largest."""
    try:
        return digest(Path(file), largest)
    except InputError:
        return ""
