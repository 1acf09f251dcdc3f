"""A strain wave gear from its file: every part is computed, kept and shown as for other gears."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from pitchpoint.cases import run as running
from pitchpoint.cases.catalogue import figures, summary_table, wind_up_table
from pitchpoint.cases.run import Outcome, Progress, open_result
from pitchpoint.cases.studies import Variant, jobs

DRIVE = """
[gears]
family = "strain_wave"
teeth = [200, 202]
module = "0.3 mm"
face_width = "10 mm"
[lubricant]
name = "pao-vg-100"
[roughness]
ra = "0.4 um"
[operation]
torque = "67 N m"
speed = "2000 rpm"
temperature = "40 degC"
[models]
friction = { name = "constant", coefficient = 0.08 }
[losses.bearing]
between = ["wave generator", "flexspline"]
bearing = "palmgren_1959"
mean_diameter = "46 mm"
f0 = 2.0
f1 = 0.001
preload = "300 N"
[losses.seal]
between = ["wave generator", "housing"]
seal_torque = "10 mN m"
breakaway_torque = "5 mN m"
[loss_map]
torque_count = 3
speed_count = 2
temperatures = ["20 degC", "40 degC"]
"""
PARTS = ["teeth", "cycle", "operation", "laws", "torsion", "running", "loss_map", "back_driving"]

PAIR = """
[gears]
teeth = [23, 61]
module = "2 mm"
face_width = "20 mm"
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
torque = "50 N m"
speed = "1500 rpm"
temperature = "60 degC"
[loss_map]
torque_count = 4
speed_count = 3
temperatures = ["60 degC", "80 degC"]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    where = tmp_path_factory.mktemp("drive")
    (where / "drive.toml").write_text(DRIVE)
    running.run(str(where / "drive.toml"), folder=where / "out")
    yield where / "out"


@pytest.fixture(scope="module")
def drive(folder: Path) -> Outcome:
    return open_result(folder)["default"]


def test_all_parts_are_there(drive: Outcome) -> None:
    assert list(drive.parts) == PARTS
    assert drive.manifest["finished"]
    told = {name: drive.manifest[name] for name in ("family", "driver", "loaded")}
    assert told == {"family": "strain_wave", "driver": "wave generator", "loaded": "flexspline"}
    assert "palmgren_1959" in [source["key"] for source in drive.manifest["sources"]]


def test_the_tables_on_screen(drive: Outcome) -> None:
    rows, columns, note = summary_table(drive)
    assert len(rows) == 1
    assert "η mean [%]" in columns
    assert "xu_2007" in note
    rows, _ = wind_up_table(drive)
    assert [row["T_out [N m]"] for row in rows] == ["33.5", "67", "100.5", "134"]
    json.dumps(figures(drive), allow_nan=False)


def test_the_loads_carry_the_torque(drive: Outcome) -> None:
    data = drive.parts["operation"]
    ratio = float(data["speed_ratio"].values[0, 0])
    torque = float(data["mean_input_torque"].values[0, 0])
    assert ratio == 100.0
    assert float(data["mean_efficiency"].values[0, 0]) == pytest.approx(67.0 / ratio / torque)
    assert "loss_factor" not in data
    assert float(data["mean_drag_loss"].values[0, 0]) > 0.0
    cycle = drive.parts["cycle"]
    share = cycle["load_share"].sum(["pair", "slice"]).values
    np.testing.assert_allclose(share, 1.0, rtol=1e-12)


def test_wind_up_grows_with_the_torque(drive: Outcome) -> None:
    data = drive.parts["torsion"]
    assert data["wind_up"].values[0] == pytest.approx(0.0, abs=1e-12)
    assert (np.diff(data["wind_up"].values) > 0.0).all()
    assert (np.diff(data["loaded_pairs"].values) >= 0.0).all()
    assert (data["loading_torque"].values >= data["unloading_torque"].values).all()
    assert data["tooth_force"].shape == (25, 8, data.sizes["pair"])


def test_running_without_load(drive: Outcome) -> None:
    data = drive.parts["running"]
    assert (data["no_load_torque"].values > 0.010).all()  # more than the seal
    assert (np.diff(data["no_load_torque"].values, axis=1) > 0.0).all()  # with speed
    assert (data["starting_torque"].values > 0.015).all()
    assert (data["back_driving_torque"].values > 100.0 * 0.015).all()


def test_the_map_agrees_with_the_operating_point(drive: Outcome) -> None:
    data = drive.parts["loss_map"]
    assert data["mean_loss"].shape == (1, 3, 2, 2)
    efficiency = data["mean_efficiency"].values[0, 1:, 1]
    assert (np.diff(efficiency, axis=0) > 0.0).all()  # rises with torque
    assert (np.diff(efficiency, axis=1) > 0.0).all()  # and with temperature
    assert np.isnan(data["mean_efficiency"].values[0, 0]).all()
    assert not data["locked"].any()


class Interrupted(Progress):
    """Stops a computation when it has told of its points so often; never at 0."""

    def __init__(self, after: int) -> None:
        self.after, self.told = after, []

    def points(self, done: int) -> None:
        self.told.append(done)
        if len(self.told) == self.after:
            raise KeyboardInterrupt


def test_an_interrupted_map_goes_on_where_it_was(tmp_path: Path) -> None:
    made = Variant(tomllib.loads(PAIR), "pair.toml", "default")
    job = next(job for job in jobs(made, {}) if job.name == "loss_map")

    def compute(after: int, folder: Path | None = tmp_path) -> xr.Dataset:
        return running._part(job, made, folder, {}, Interrupted(after))

    whole = compute(0, None)
    with pytest.raises(KeyboardInterrupt):
        compute(4)
    pieces = sorted(tmp_path.glob("loss_map.*.nc"))
    kept = {piece: piece.stat().st_mtime_ns for piece in pieces}
    assert 1 <= len(pieces) < 4
    with pytest.raises(KeyboardInterrupt):
        compute(5)
    assert {piece: piece.stat().st_mtime_ns for piece in pieces} == kept
    data = compute(0)
    np.testing.assert_array_equal(data["mean_loss"], whole["mean_loss"])
    assert [path.name for path in tmp_path.iterdir()] == ["loss_map.nc"]
    assert data.sizes == {"law": 1, "torque": 4, "speed": 3, "temperature": 2}
