"""Datasets on disk: NetCDF, written whole or not at all, recognised again by their fingerprint."""

import hashlib
import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import stored
from pitchpoint.core.plain_files import plain_file
from pitchpoint.core.status import DIRECT
from pitchpoint.errors import InputError
from pitchpoint.results.netcdf import decode, encode
from pitchpoint.results.variable import End, Variable
from pitchpoint.results.variables import VARIABLES

__all__ = [
    "dataset",
    "demand_writable_folder",
    "describe_variables",
    "fingerprint",
    "load",
    "make_folder",
    "save",
    "save_image",
    "sole_writer",
    "sweep",
    "without_nan",
    "write_bytes",
    "write_text",
]

MOST_BYTES = 4_000_000_000
"""Size of the largest dataset that is read."""

SEAL = 8 + hashlib.sha256().digest_size
"""Bytes behind the end of a dataset's file: its length and its digest.

No reader of NetCDF looks there. In the same file as what they vouch for, one rename puts both in place.
"""

_TEMPORARY = re.compile(r"\.[\w.-]+-[a-z0-9_]{8}\.(nc|json|html|toml|csv|txt|npy)", re.ASCII)


def dataset(
    variables: Mapping[str, tuple[tuple[str, ...], Any]],
    coordinates: Mapping[str, Any],
    *,
    solve: Mapping[str, Any] = DIRECT,
    travels: Collection[End] = (),
    warnings: Iterable[str] | None = None,
    **attributes: Any,
) -> xr.Dataset:
    """Dataset whose variables carry unit, long name and symbol.

    Args:
        variables: dimensions and values by name; names of `VARIABLES` get their attributes.
        coordinates: values by dimension.
        solve: what became of the solves behind it, see `core.status.solve_summary`; kept as JSON.
        travels: members that travel in place of turning, whose quantities have other units.
        warnings: sentences on what is doubtful, see `doubts.stored`; None where a part has no place for any.
        attributes: strings and numbers; anything else is stored as JSON.
    """
    data = xr.Dataset(
        {name: (dims, np.asarray(values)) for name, (dims, values) in variables.items()},
        coords=dict(coordinates),
    )
    described = VARIABLES.keys() & data.variables.keys()
    describe_variables(data, {name: VARIABLES[name].where(travels) for name in described})
    data.attrs.update(
        {key: _attribute(value) for key, value in {"solve": solve, **attributes}.items()},
        **({} if warnings is None else stored(warnings)),
        version=_version(),
    )
    return data


def describe_variables(data: xr.Dataset, variables: Mapping[str, Variable]) -> None:
    """Write unit, long name and symbol to those variables of a dataset that are described."""
    for name, values in data.variables.items():
        quantity = variables.get(str(name))
        if quantity is not None:
            values.attrs.update(
                units=quantity.unit, long_name=quantity.long_name, symbol=quantity.symbol
            )


@cache
def _version() -> str:
    return version("pitchpoint")


def fingerprint(*parts: Any) -> str:
    """Short digest of inputs: equal inputs of one version of the package, equal digest."""
    text = json.dumps([_version(), *parts], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def without_nan(value: Any) -> Any:
    """The same tree with None in place of numbers that JSON cannot say."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def save(data: xr.Dataset, path: Path) -> None:
    """Write a dataset; a reader never sees half a file, whatever happens meanwhile.

    Raises:
        OSError: the disk is full, say; its `filename` is the path.
    """
    save_image(encode(data), path)


def save_image(image: bytes, path: Path) -> None:
    """Write a dataset that is encoded already, see `save`."""
    _whole(path, image + _seal(image), lasting=True)


def load(path: Path, only: Collection[str] | None = None) -> xr.Dataset:
    """Read a dataset that `save` wrote.

    Args:
        path: of the file.
        only: names of variables; all by default.

    Raises:
        InputError: there is no such file, or it is not what was written.
    """
    image = _unsealed(path)
    try:
        return decode(image, only)
    except Exception as error:  # sealed by someone else: h5py raises what it likes
        raise InputError(f"is not a result of pitchpoint: {error}", file=str(path)) from None


def make_folder(folder: Path) -> None:
    """Make a folder for results; InputError if it cannot be written to."""
    with _unwritable(folder):
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()


def demand_writable_folder(folder: Path) -> None:
    """InputError if a folder cannot be made or written to: told before what takes long."""
    with _unwritable(folder):
        there = next(
            ancestor for ancestor in (folder, *folder.absolute().parents) if ancestor.exists()
        )
        tempfile.TemporaryFile(dir=there).close()


@contextmanager
def _unwritable(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        blocked = isinstance(error, FileExistsError | NotADirectoryError)
        why = "a file stands where a folder belongs" if blocked else error.strerror
        raise InputError(f"cannot be written to: {why}", file=str(folder)) from None


def write_text(path: Path, text: str) -> None:
    """Write text the same way; if the power fails, the next run writes it again."""
    _whole(path, text.encode("utf-8"), lasting=False)


def write_bytes(path: Path, content: bytes) -> None:
    """Write the copy of a file the same way."""
    _whole(path, content, lasting=False)


@contextmanager
def sole_writer(folder: Path) -> Iterator[bool]:
    """Keep other runs out of a folder; the system lets go however this process ends.

    Yields:
        False where folders cannot be locked, as on Windows and some network drives.

    Raises:
        InputError: another run is writing there.
    """
    handle = _locked(folder)
    try:
        yield handle is not None
    finally:
        if handle is not None:
            os.close(handle)


def sweep(folder: Path) -> None:
    """Remove what killed runs left half written; for the sole writer of a folder."""
    for path in folder.glob(".*"):
        if _TEMPORARY.fullmatch(path.name):
            path.unlink(missing_ok=True)


def _locked(folder: Path) -> int | None:
    if sys.platform == "win32":
        return None
    import fcntl

    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(handle)
        if isinstance(error, BlockingIOError):
            refusal = "another run is writing there; wait for it or give another folder"
            raise InputError(refusal, file=str(folder)) from None
        return None
    return handle


def _whole(path: Path, content: bytes, *, lasting: bool) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _renamed(path, content, lasting=lasting)
    except OSError as error:
        assurance = "; what was finished before is kept and found again" if lasting else ""
        raise OSError(error.errno, f"{error.strerror}{assurance}", str(path)) from None


def _renamed(path: Path, content: bytes, *, lasting: bool) -> None:
    """What lasts is on disk before its name is, and the name before anything builds on it."""
    handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
    part = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            if lasting:
                os.fsync(handle)
        part.chmod(0o644)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    if lasting:
        _sync(path.parent)


def _sync(folder: Path) -> None:
    with suppress(OSError):  # some systems cannot
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _seal(image: bytes) -> bytes:
    return len(image).to_bytes(8, "big") + hashlib.sha256(image).digest()


def _unsealed(path: Path) -> bytes:
    """File without its seal; a damaged one never reaches HDF5, which may hang on it or believe it."""
    with plain_file(path, MOST_BYTES) as file:
        length = max(file.seek(0, os.SEEK_END) - SEAL, 0)
        file.seek(length)
        seal = file.read()
        file.seek(0)
        image = file.read(length) if seal[:8] == length.to_bytes(8, "big") else b""
    if seal != _seal(image):
        refusal = "is damaged or not of pitchpoint; the same run computes it again"
        raise InputError(refusal, file=str(path))
    return image


def _attribute(value: Any) -> str | int | float:
    return value if isinstance(value, str | int | float) else json.dumps(value, default=str)
