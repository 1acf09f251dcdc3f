"""Datasets on disk: NetCDF, written whole or not at all, recognised again by their fingerprint."""

import hashlib
import json
import math
import os
import tempfile
from collections.abc import Callable, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.errors import InputError
from pitchpoint.results.variables import VARIABLES

__all__ = [
    "dataset",
    "fingerprint",
    "load",
    "make_folder",
    "save",
    "without_nan",
    "write_text",
]


def dataset(
    variables: Mapping[str, tuple[tuple[str, ...], Any]],
    coordinates: Mapping[str, Any],
    **attributes: Any,
) -> xr.Dataset:
    """Dataset whose variables carry unit, long name and symbol.

    Args:
        variables: dimensions and values by name; names of `VARIABLES` get their attributes.
        coordinates: values by dimension.
        attributes: strings and numbers; anything else is stored as JSON.
    """
    data = xr.Dataset(
        {name: (dims, np.asarray(values)) for name, (dims, values) in variables.items()},
        coords=dict(coordinates),
    )
    for name in data.variables:
        described = VARIABLES.get(str(name))
        if described is not None:
            data[name].attrs.update(
                units=described.unit, long_name=described.long_name, symbol=described.symbol
            )
    data.attrs.update(
        {key: _attribute(value) for key, value in attributes.items()},
        version=version("pitchpoint"),
    )
    return data


def fingerprint(*parts: Any) -> str:
    """Short digest of inputs: equal inputs of one version of the package, equal digest."""
    text = json.dumps([version("pitchpoint"), *parts], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def without_nan(value: Any) -> Any:
    """The same tree with None in place of numbers that JSON cannot say."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def save(data: xr.Dataset, path: Path) -> None:
    """Write a dataset; a reader never sees half a file, whatever happens meanwhile."""
    _whole(path, lambda part: data.to_netcdf(part, engine="h5netcdf"))


def make_folder(folder: Path) -> None:
    """Make a folder for results; InputError if it cannot be written to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise InputError(f"cannot be written to: {error.strerror}", file=str(folder)) from None


def write_text(path: Path, text: str) -> None:
    """Write text the same way."""
    _whole(path, lambda part: part.write_text(text, encoding="utf-8"))


def _whole(path: Path, write: Callable[[Path], Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.stem}-", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    part = Path(name)
    try:
        write(part)
        part.chmod(0o644)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def load(path: Path) -> xr.Dataset:
    """Read a dataset that `save` wrote, whole, so that the file is closed again."""
    try:
        with xr.open_dataset(path, engine="h5netcdf") as data:
            return data.load()
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"is not a result of pitchpoint: {error}", file=str(path)) from None


def _attribute(value: Any) -> str | int | float:
    return value if isinstance(value, str | int | float) else json.dumps(value, default=str)
