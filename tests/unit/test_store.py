"""Datasets on disk: as NetCDF readers expect them, and never believed when damaged."""

import os
import resource
import stat
from collections.abc import Callable, Iterator
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from pitchpoint.errors import InputError
from pitchpoint.results import store
from pitchpoint.results.netcdf import decode, encode


def every_kind() -> xr.Dataset:
    """Everything that a part may hold, and its borders."""
    return store.dataset(
        {
            "mean_loss": (("law", "point"), np.array([[1.5, np.nan, -0.0], [np.inf, 2.0, 3.0]])),
            "locked": (("law", "point"), np.array([[True, False, True]] * 2)),
            "iterations": (("law",), np.array([3, -4])),
            "centre_distance": ((), 0.1),
            "flag": ((), True),
            "text": ((), "ε_γ"),
            "texts": (("point",), np.array(["a", "", "längeres Wort"])),
            "single": (("point",), np.array([1.0, np.nan, 2.0], np.float32)),
            "small": (("point",), np.array([1, 2, 3], np.uint8)),
            "nothing": (("none",), np.zeros(0)),
            "nowhere": (("point", "none"), np.zeros((3, 0), bool)),
            "no_texts": (("none",), np.array([], str)),
            "square": (("pair", "slice"), np.eye(2)),
        },
        {
            "law": ["xu_2007", "η"],
            "torque": [10.0, 50.0],
            "place": (("pair", "slice"), np.array([[0.0, 1.0], [2.0, np.nan]])),
        },
        title="",
        warnings=["ä" * 70_000],
        turns=3,
        events=[0.0, 0.5],
        share=0.25,
    )


@pytest.fixture
def kept(tmp_path: Path) -> Path:
    path = tmp_path / "part.nc"
    store.save(every_kind(), path)
    return path


def assert_equal(one: xr.Dataset, other: xr.Dataset) -> None:
    assert one.identical(other)
    assert list(one.data_vars) == list(other.data_vars)
    for name, variable in one.variables.items():
        assert variable.dtype == other[name].dtype, name
        assert list(variable.attrs) == list(other[name].attrs), name


def test_xarray_reads_what_it_would_have_written(kept: Path, tmp_path: Path) -> None:
    data = every_kind()
    data.to_netcdf(tmp_path / "xarray.nc", engine="h5netcdf")
    with (
        xr.open_dataset(kept, engine="h5netcdf") as ours,
        xr.open_dataset(tmp_path / "xarray.nc", engine="h5netcdf") as theirs,
    ):
        assert_equal(ours, data)
        assert_equal(ours, theirs)
        assert ours.sizes == theirs.sizes
        for name, variable in ours.variables.items():
            for encoded in (one := dict(variable.encoding), other := dict(theirs[name].encoding)):
                encoded.pop("source", None)
            np.testing.assert_equal(one, other, name)


def test_what_is_read_is_what_was_written(kept: Path) -> None:
    assert_equal(store.load(kept), every_kind())
    assert encode(store.load(kept)) == encode(every_kind())


def test_a_text_may_hold_a_zero() -> None:
    title = decode(encode(store.dataset({}, {}, title="a\0b"))).attrs["title"]
    assert title == "a\\0b"


def test_dimensions_are_scales_with_numbers(kept: Path) -> None:
    """The conventions by which the netCDF library itself finds dimensions."""
    with h5py.File(kept) as file:
        for number, name in enumerate(("law", "point", "none", "pair", "slice", "torque")):
            assert file[name].attrs["_Netcdf4Dimid"] == number
            assert h5py.h5ds.is_scale(file[name].id)
        assert [axis[0].name for axis in file["mean_loss"].dims] == ["/law", "/point"]
        assert file["point"].attrs["NAME"] == (
            b"This is a netCDF dimension but not a netCDF variable.         3"
        )
        assert file["none"].maxshape == (None,)


# ---- damage


def test_no_changed_byte_is_believed(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    store.save(xr.Dataset({"a": 1.0}), path)
    whole = path.read_bytes()
    for place in range(0, len(whole), 7):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 16]) + whole[place + 1 :])
        with pytest.raises(InputError, match="damaged"):
            store.load(path)


@pytest.mark.parametrize(
    "damage",
    [
        lambda whole: b"",
        lambda whole: whole[:20],
        lambda whole: whole[: len(whole) // 2],
        lambda whole: whole[:-1],
        lambda whole: whole[: -store.SEAL],
        lambda whole: whole + b"\0",
        lambda whole: whole[:512] + bytes(512) + whole[1024:],
        lambda whole: bytes(len(whole)),
        lambda whole: b"no dataset at all" * 1000,
    ],
    ids=["empty", "short", "half", "end", "unsealed", "longer", "sector", "zeros", "other"],
)
def test_damage_is_told_in_one_sentence(kept: Path, damage: Callable[[bytes], bytes]) -> None:
    kept.write_bytes(damage(kept.read_bytes()))
    with pytest.raises(InputError) as caught:
        store.load(kept)
    assert str(caught.value) == (
        f"{kept}: is damaged or not of pitchpoint; the same run computes it again"
    )


def test_hdf5_never_sees_what_is_damaged(kept: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "decode", lambda image: pytest.fail("HDF5 saw it"))
    kept.write_bytes(kept.read_bytes()[:-100])
    with pytest.raises(InputError):
        store.load(kept)


def test_a_seal_around_anything_else(kept: Path) -> None:
    for image in (b"x" * 5000, encode(every_kind())[:-3000]):
        kept.write_bytes(image + store._seal(image))
        with pytest.raises(InputError, match="is not a result of pitchpoint"):
            store.load(kept)


def test_what_is_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        store.load(tmp_path / "part.nc")
    with pytest.raises(InputError, match="is a folder"):
        store.load(tmp_path)
    os.mkfifo(tmp_path / "pipe.nc")  # reading it would wait for ever
    with pytest.raises(InputError, match="is a pipe"):
        store.load(tmp_path / "pipe.nc")


# ---- writing


@pytest.fixture
def small_disk() -> Iterator[None]:
    """No file may grow beyond 4 kB, as on a disk that is full."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_is_told_with_the_file(kept: Path, small_disk: None) -> None:
    before = kept.read_bytes()
    with pytest.raises(OSError) as caught:
        store.save(every_kind(), kept)
    assert caught.value.filename == str(kept)
    assert "what was finished before is kept" in str(caught.value)
    assert kept.read_bytes() == before
    assert [path.name for path in kept.parent.iterdir()] == ["part.nc"]


def test_content_is_on_disk_before_its_name_and_the_name_after(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    replace = Path.replace

    def synced(handle: int) -> None:
        told.append("folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "content")

    def renamed(part: Path, path: Path) -> Path:
        told.append("name")
        return replace(part, path)

    monkeypatch.setattr(os, "fsync", synced)
    monkeypatch.setattr(Path, "replace", renamed)
    store.save(every_kind(), tmp_path / "part.nc")
    assert told == ["content", "name", "folder"]


def test_a_folder_has_one_writer(tmp_path: Path) -> None:
    with store.sole_writer(tmp_path) as alone:
        assert alone
        with (
            pytest.raises(InputError, match="another run is writing there"),
            store.sole_writer(tmp_path),
        ):
            pass
    with store.sole_writer(tmp_path):
        pass
    assert not list(tmp_path.iterdir())


def test_what_killed_runs_left_is_swept(tmp_path: Path) -> None:
    left = [".teeth-ab12_xyz.nc", ".sweep.0003-abcdefgh.nc", ".run-01234567.json"]
    others = ["teeth.nc", ".notes", ".git", "report-abcdefgh.html", ".my-notes.json"]
    for name in left + others:
        (tmp_path / name).touch()
    store.sweep(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == set(others)
