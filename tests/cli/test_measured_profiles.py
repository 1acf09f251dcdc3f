"""Profiles and x3p files as heights of a surface: what they say, and archives that mean harm."""

import io
import random
import struct
import zipfile
from pathlib import Path
from typing import Any

import jax
import numpy as np
import pytest

from pitchpoint import double_precision
from pitchpoint.cases.height_maps import MOST_HEIGHTS, height_maps
from pitchpoint.cases.x3p import read_x3p
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.ehl.patch.heights import HeightMap

WAVE = 0.3 * np.cos(0.4 * np.arange(60)) + 0.01 * np.arange(60)
"""Heights of a profile [um]."""


def map_of(path: Path, **table: Any) -> HeightMap:
    film = {"solver": "finite_line", "heights": {"gear_1": {"file": str(path), **table}}}
    (found,) = height_maps(FilmTable.model_validate(film))
    return found


def refused(path: Path, **table: Any) -> InputError:
    with pytest.raises(InputError) as caught:
        map_of(path, **table)
    return caught.value


@pytest.fixture(params=["csv", "txt", "npy", "flat.npy", "places.csv", "places.npy", "rounded.txt"])
def profile(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """The same profile in every form."""
    name = str(request.param)
    path = tmp_path / f"profile.{name}"
    places = 1.5 + 0.002 * np.arange(60)
    columns = np.column_stack([places, WAVE]) if "places" in name else WAVE[:, None]
    if "rounded" in name:
        lines = [
            f"{place:.4f} {height!r}" for place, height in zip(places, WAVE.tolist(), strict=True)
        ]
        path.write_text("\n".join(lines), "utf-8")
    elif name.endswith("npy"):
        np.save(path, WAVE if "flat" in name else columns)
    else:
        np.savetxt(path, columns, fmt="%.17g", delimiter="," if name.endswith("csv") else " ")
    return path


def test_a_profile_is_the_same_everywhere_the_other_way(profile: Path) -> None:
    along = map_of(profile, step_along="2 um", middle_along="0.1 mm")
    x = 1e-4 + 2e-6 * (np.arange(60) - 29.5)
    assert np.asarray(along.x) == pytest.approx(x) and along.heights.shape == (2, 60)
    assert (np.asarray(along.heights) == 1e-6 * WAVE).all()
    assert min(-float(along.y[0]), float(along.y[-1])) >= 1.0
    across = map_of(profile, step_across="2 um", middle_across="0.1 mm", direction="across")
    assert np.asarray(across.y) == pytest.approx(x) and across.heights.shape == (60, 2)
    assert (np.asarray(across.heights) == 1e-6 * WAVE[:, None]).all()


def test_cells_take_means_of_a_profile(tmp_path: Path) -> None:
    np.save(tmp_path / "profile.npy", WAVE)
    found = map_of(tmp_path / "profile.npy", step_along="2 um")
    places, edges = np.asarray(found.x), np.linspace(-4e-5, 4e-5, 5)
    with double_precision():
        cells = np.asarray(jax.jit(HeightMap.over)(found, edges, np.array([-3e-3, 1e-3, 2e-3])))
    fine = np.linspace(edges[:-1], edges[1:], 4001)
    heights = np.interp(fine, places, 1e-6 * WAVE)
    means = np.trapezoid(heights, dx=1.0 / 4000, axis=0)
    assert cells == pytest.approx(np.broadcast_to(means, (2, 4)), rel=1e-5)


TWO_COLUMNS = {
    "falling": np.column_stack([-np.arange(9.0), np.ones(9)]),
    "uneven": np.column_stack([np.arange(9.0) ** 1.2, np.ones(9)]),
    "still": np.ones((9, 2)),
    "heights": np.random.default_rng(1).normal(size=(9, 2)),
}


@pytest.mark.parametrize("name", TWO_COLUMNS)
def test_two_columns_are_never_a_map(name: str, tmp_path: Path) -> None:
    np.savetxt(tmp_path / "two.csv", TWO_COLUMNS[name], delimiter=",")
    told = refused(tmp_path / "two.csv", step_along="1 um", step_across="1 um")
    assert "its places do not rise evenly" in told.message
    assert told.key == "film.heights.gear_1.file"


def test_steps_that_are_lacking_or_contradict_places(tmp_path: Path) -> None:
    np.savetxt(tmp_path / "one.csv", WAVE)
    np.savetxt(tmp_path / "map.csv", np.ones((4, 5)), delimiter=",")
    np.savetxt(tmp_path / "two.txt", np.column_stack([0.5 * np.arange(60), WAVE]))
    missing = {
        "one.csv": {"step_across": "1 um"},
        "map.csv": {"step_across": "1 um"},
        "two.txt": {},
    }
    for name, table in missing.items():
        told = refused(tmp_path / name, **table)
        assert told.key == "film.heights.gear_1.step_along" and "is missing" in told.message
    told = refused(tmp_path / "one.csv", direction="across", step_along="1 um")
    assert told.key == "film.heights.gear_1.step_across"
    told = refused(tmp_path / "two.txt", step_along="5 um")
    assert told.message.startswith("5 um was given, and the places in the file are 0.5 apart")
    assert map_of(tmp_path / "two.txt", step_along="0.5 um").heights.shape == (2, 60)
    assert map_of(tmp_path / "two.txt", step_along="500 nm").heights.shape == (2, 60)


# ---- x3p, written here from the description in the standard

MAIN = """<?xml version="1.0" encoding="utf-8"?>{doctype}
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>{axis}</AxisType><DataType>D</DataType><Increment>2e-6</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>5e-6</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{kind}</DataType>{increment}<Offset>0</Offset></CZ></Axes></Record1>
<Record3><MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>{layers}</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink>{valid}</DataLink></Record3>
</p:ISO5436_2>"""
HEIGHTS = np.arange(-6, 6).reshape(3, 4)
USUAL = {
    "doctype": "",
    "axis": "I",
    "kind": "I",
    "increment": "<Increment>1e-8</Increment>",
    "columns": 4,
    "rows": 3,
    "layers": 1,
    "valid": "",
}


def archive(data: bytes, *, more: dict[str, bytes] | None = None, **words: Any) -> bytes:
    image = io.BytesIO()
    with zipfile.ZipFile(image, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("main.xml", MAIN.format(**{**USUAL, **words}))
        file.writestr("bindata/data.bin", data)
        for name, held in (more or {}).items():
            file.writestr(name, held)
    return image.getvalue()


def packed(kind: str, heights: np.ndarray = HEIGHTS) -> bytes:
    sign = {"I": "h", "L": "i", "F": "f", "D": "d"}[kind]
    scale = 1 if kind in "IL" else 1e-8
    return struct.pack(f"<{heights.size}{sign}", *(scale * heights.ravel()).tolist())


@pytest.mark.parametrize("kind", "ILFD")
def test_an_x3p_says_its_heights_steps_and_units(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "flank.x3p"
    increment = USUAL["increment"] if kind in "IL" else ""
    path.write_bytes(archive(packed(kind), kind=kind, increment=increment))
    found = map_of(path)
    assert np.asarray(found.heights) == pytest.approx(1e-8 * HEIGHTS, rel=1e-7)
    assert np.asarray(found.x) == pytest.approx(2e-6 * (np.arange(4) - 1.5))
    assert np.asarray(found.y) == pytest.approx(5e-6 * (np.arange(3) - 1.0))
    for key in ("unit", "step_along", "step_across"):
        told = refused(path, **{key: "1 um"})
        assert told.key == f"film.heights.gear_1.{key}" and "leave it out" in told.message


def test_an_x3p_may_hold_a_profile(tmp_path: Path) -> None:
    path = tmp_path / "flank.x3p"
    path.write_bytes(archive(packed("I"), columns=12, rows=1))
    along, across = map_of(path), map_of(path, direction="across")
    assert along.heights.shape == (2, 12) and across.heights.shape == (12, 2)
    assert np.asarray(along.heights[0]) == pytest.approx(1e-8 * HEIGHTS.ravel())
    assert float(across.y[1] - across.y[0]) == pytest.approx(2e-6)


def test_points_that_were_not_measured_are_no_heights(tmp_path: Path) -> None:
    path, link = tmp_path / "flank.x3p", "<ValidPointsLink>valid.bin</ValidPointsLink>"
    path.write_bytes(
        archive(packed("I"), valid=link, more={"valid.bin": bytes([0b11111011, 0x0F])})
    )
    assert "has one height that is no finite number" in refused(path).message
    path.write_bytes(archive(packed("I"), valid=link, more={"valid.bin": b"\xff\xff"}))
    assert np.asarray(map_of(path).heights) == pytest.approx(1e-8 * HEIGHTS)


LAUGHS = '<!DOCTYPE p [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]>'
HARMFUL: dict[str, tuple[bytes, str]] = {
    "a declaration": (archive(packed("I"), doctype=LAUGHS), "declares a document type"),
    "another file": (
        archive(packed("I"), doctype='<!DOCTYPE p SYSTEM "file:///etc/passwd">'),
        "declares a document type",
    ),
    "a bomb": (archive(bytes(50_000_000)), "of more than 24 bytes"),
    "a long description": (
        archive(packed("I"), doctype=" " * 2_000_000),
        "of more than 1000000 bytes",
    ),
    "many heights": (archive(b"", columns=10**6, rows=10**6), "at most 16 million"),
    "too few numbers": (archive(packed("I")[:-2]), "cannot be read as x3p"),
    "negative sizes": (archive(packed("I"), columns=-4, rows=-3), "it has to be positive"),
    "layers": (archive(packed("I"), layers=2), "one layer"),
    "places of their own": (archive(packed("I"), axis="A"), "even grid"),
    "another type": (archive(packed("I"), kind="X"), "cannot be read as x3p"),
    "no increment": (archive(packed("I"), increment=""), "lacks Record1/Axes/CZ/Increment"),
    "no archive": (b"PK\x03\x04", "cannot be read as x3p"),
}


@pytest.mark.parametrize("what", HARMFUL)
def test_archives_that_mean_harm_are_told(what: str, tmp_path: Path) -> None:
    content, words = HARMFUL[what]
    (tmp_path / "flank.x3p").write_bytes(content)
    assert words in refused(tmp_path / "flank.x3p").message


def test_broken_archives_are_told() -> None:
    draw, sound = random.Random(1), archive(packed("I"))
    ended = set()
    for _ in range(400):
        broken = bytearray(sound)
        for _ in range(draw.randrange(1, 4)):
            broken[draw.randrange(len(broken))] = draw.randrange(256)
        try:
            ended.add(read_x3p(io.BytesIO(bytes(broken)), MOST_HEIGHTS).heights.shape)
        except InputError as error:
            ended.add(error.message[:10])
    assert {(3, 4), "cannot be "} <= ended
