"""Datasets as NetCDF-4 files in memory, by the conventions of xarray and of the netCDF library.

xarray and h5netcdf take a tenfold of the time of h5py itself, for the many small variables of a case as
long as its numerics.
"""

from collections.abc import Collection, Hashable, Mapping
from functools import cache
from importlib.metadata import version
from typing import Any

import h5py
import numpy as np
import xarray as xr

__all__ = ["decode", "encode"]

_TEXT = h5py.string_dtype()
_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."
_NUMBER = "_Netcdf4Dimid"  # of a dimension, on its scale
_NUMBERS = "_Netcdf4Coordinates"  # of the dimensions of a variable
_COORDINATES = "coordinates"  # names of those of a variable that are no dimensions
_SCALE = {"CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST"}
_HIDDEN = _SCALE | {_NUMBER, _NUMBERS, "_NCProperties", "_FillValue", "dtype", _COORDINATES}


def encode(data: xr.Dataset) -> bytes:
    """File of a dataset; equal datasets give equal bytes.

    Args:
        data: numbers, truth values and texts; coordinates along dimensions; attributes that are texts
            or numbers.
    """
    with h5py.File.in_memory(track_order=True) as file:
        properties = f"version=2,pitchpoint={_version()},hdf5={h5py.version.hdf5_version}"
        file.attrs["_NCProperties"] = np.bytes_(properties)
        sizes, variables, coords = dict(data.sizes), dict(data.variables), set(data.coords)
        others = {str(name): set(variables[name].dims) for name in coords - sizes.keys()}
        numbers = {name: number for number, name in enumerate(sizes)}
        scales = [
            _scale(file, str(name), size, variables.get(name), numbers[name])
            for name, size in sizes.items()
        ]
        for name, variable in variables.items():
            if name not in sizes:
                stored_variable = _variable(file, str(name), variable)
                _attach(stored_variable, [numbers[dim] for dim in variable.dims], scales)
                if name not in coords:
                    _describe(stored_variable, _beside(others, variable))
        _describe(file, data.attrs)
        file.flush()
        return bytes(file.id.get_file_image())


@cache
def _version() -> str:
    return version("pitchpoint")


def _beside(others: Mapping[str, set[Hashable]], variable: xr.Variable) -> dict[str, str]:
    """Coordinates along dimensions of a variable that are no dimensions themselves, by name."""
    names = sorted(name for name, dims in others.items() if dims <= set(variable.dims))
    return {_COORDINATES: " ".join(names)} if names else {}


def decode(image: bytes, only: Collection[str] | None = None) -> xr.Dataset:
    """Dataset of a file that `encode` made; whatever else it is given raises some exception.

    Args:
        image: the file.
        only: names of variables; all by default.
    """
    with h5py.File.in_memory(image) as file:
        items = dict(file.items())
        scales = [name for name, item in items.items() if _NUMBER in item.attrs]
        order = [*(name for name in items if name not in scales), *scales]  # as xarray has them
        chosen = order if only is None else [name for name in order if name in only]
        stored = {name: items[name] for name in chosen if not _bare(items[name])}
        variables = {name: _read(name, item, scales) for name, item in stored.items()}
        beside = {
            coordinate
            for item in stored.values()
            for coordinate in item.attrs.get(_COORDINATES, "").split()
        }
        return xr.Dataset(variables, attrs=_described(file)).set_coords(beside & variables.keys())


def _scale(
    file: h5py.File, name: str, size: int, coordinate: xr.Variable | None, number: int
) -> h5py.Dataset:
    """Dimension: with its coordinate, or an array of nothing that has its length."""
    if coordinate is not None:
        scale = _variable(file, name, coordinate)
        scale.make_scale(name)
    else:
        scale = _array(file, name, shape=(size,), dtype=">f4")
        scale.make_scale(f"{_NO_VARIABLE}{size:10}")
    _put(scale, _NUMBER, np.int32(number))
    return scale


def _variable(file: h5py.File, name: str, variable: xr.Variable) -> h5py.Dataset:
    values, attributes = variable.values, dict(variable.attrs)
    if values.dtype.kind == "b":
        values, attributes["dtype"] = values.astype("i1"), "bool"
    if values.dtype.kind in "OU":
        stored_variable = _array(file, name, data=values.astype(object), dtype=_TEXT)
    elif values.dtype.kind == "f":
        attributes["_FillValue"] = values.dtype.type(np.nan)
        stored_variable = _array(file, name, data=values, fillvalue=np.nan)
    else:
        stored_variable = _array(file, name, data=values)
    _describe(stored_variable, attributes)
    return stored_variable


def _array(file: h5py.File, name: str, **what: Any) -> h5py.Dataset:
    """Array with its attributes in their order; a dimension without length is one that may grow."""
    shape = what["data"].shape if "data" in what else what["shape"]
    grows = tuple(size or None for size in shape) if 0 in shape else None
    return file.create_dataset(name, maxshape=grows, track_order=True, **what)


def _attach(made: h5py.Dataset, numbers: list[int], scales: list[h5py.Dataset]) -> None:
    if numbers:
        _put(made, _NUMBERS, np.array(numbers, np.int32))
    for axis, number in enumerate(numbers):
        h5py.h5ds.attach_scale(made.id, scales[number].id, axis)


def _describe(item: h5py.File | h5py.Dataset, attributes: Mapping[Any, Any]) -> None:
    """Attributes: texts, in which HDF5 takes no zero, and numbers as arrays of one, as netCDF has them."""
    for name, value in attributes.items():
        text = isinstance(value, str)
        _put(item, name, value.replace("\0", "\\0") if text else np.atleast_1d(value))


def _put(item: h5py.File | h5py.Dataset, name: str, value: Any) -> None:
    """A new attribute, as `item.attrs` writes it; that takes three times as long to find out its type."""
    values = np.asarray(value, _TEXT if isinstance(value, str) else None)
    kind, held = _kinds(values.dtype)
    attribute = h5py.h5a.create(item.id, name.encode(), kind, _space(values.shape))
    attribute.write(values, mtype=held)


@cache
def _space(shape: tuple[int, ...]) -> h5py.h5s.SpaceID:
    return h5py.h5s.create_simple(shape)


@cache
def _kinds(dtype: "np.dtype[Any]") -> tuple[h5py.h5t.TypeID, h5py.h5t.TypeID]:
    """Type of an attribute in the file and in memory."""
    element_type = _TEXT if dtype == _TEXT else dtype
    return h5py.h5t.py_create(element_type, logical=True), h5py.h5t.py_create(element_type)


def _read(name: str, item: h5py.Dataset, scales: list[str]) -> xr.Variable:
    dims = [name] if name in scales else [scales[number] for number in item.attrs.get(_NUMBERS, ())]
    return xr.Variable(dims, _values(item), _described(item))


def _values(item: h5py.Dataset) -> np.ndarray[Any, Any]:
    if h5py.check_string_dtype(item.dtype):
        return np.asarray(item.asstr()[()], dtype=str)
    values = np.asarray(item[()])
    return values.astype(bool) if item.attrs.get("dtype") == "bool" else values


def _described(item: h5py.File | h5py.Dataset) -> dict[str, Any]:
    attributes = {name: item.attrs[name] for name in item.attrs if name not in _HIDDEN}
    return {
        name: value if isinstance(value, str) else value[0] for name, value in attributes.items()
    }


def _bare(item: h5py.Dataset) -> bool:
    """True for a dimension without a coordinate."""
    return bytes(item.attrs.get("NAME", b"")).startswith(_NO_VARIABLE.encode())
