"""A strain wave gear from its file: every part is computed, kept and shown as for other gears."""

import json
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from documentation import block
from sound import PAIR, WAVE

import pitchpoint as pp
from pitchpoint.analyses.running import BANDS
from pitchpoint.cases.built import ALONE, BEARING_FREE, LACKING, TEETH_ALONE
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.core import programs
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Outcome, Progress, open_outcomes
from pitchpoint.views import show
from pitchpoint.views.screen import head
from pitchpoint.views.section_registry import TORSION
from pitchpoint.views.sections.answer import operation_summary
from pitchpoint.views.sections.beside import running_rows, starting_answer
from pitchpoint.views.sections.kinematic_error import error_rows, kinematic_error_answer
from pitchpoint.views.sections.torsion import wind_up_rows

DRIVE = (
    WAVE
    + """
[gears.deviations]
flexspline = [{ order = 1, amplitude = "0.2 um" }, { order = 2, amplitude = "0.1 um", phase = "50 deg" }]
circular_spline = [{ order = 3, amplitude = "0.2 um" }, { order = 4, amplitude = "0.1 um" }]
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
breakaway_spread = 1.5
[loss_map]
torque_count = 3
speed_count = 2
temperatures = ["20 degC", "60 degC"]
"""
)
PARTS = ["teeth", "load_limits", "bodies", "cycle", "operation", "laws", "torsion"]
PARTS += ["kinematic_error", "running", "loss_map", "back_driving"]

MAPPED = f"""{PAIR}
[loss_map]
torque_count = 4
speed_count = 3
temperatures = ["60 degC", "80 degC"]
"""


@pytest.fixture(scope="module", autouse=True)
def programs_stay() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(programs, "MOST_PROGRAMS", 10**9)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    where = tmp_path_factory.mktemp("drive")
    (where / "drive.toml").write_text(DRIVE)
    running.run_case(str(where / "drive.toml"), folder=where / "out")
    yield where / "out"


@pytest.fixture(scope="module")
def other(folder: Path) -> tuple[int, Outcome]:
    """Programs that a second drive of other teeth, torque, speed and oil asked for, and what it found."""
    before = programs._LOADED["programs"]
    settings = {
        "gears.teeth": [190, 192],
        "operation.torque": "40 N m",
        "operation.speed": "1500 rpm",
        "lubricant.name": "mineral-vg-220",
        "gears.deviations": {"flexspline": [{"order": 2, "amplitude": "0.1 um"}]},
    }
    found = running.run_case(str(folder.parent / "drive.toml"), settings=settings)["default"]
    return programs._LOADED["programs"] - before, found


@pytest.mark.whole
def test_another_drive_compiles_nothing_new(other: tuple[int, Outcome]) -> None:
    more, found = other
    assert list(found.parts) == PARTS
    assert more == 0


@pytest.mark.whole
def test_empty_places_for_pairs_are_not_told(drive: Outcome, other: tuple[int, Outcome]) -> None:
    """Teeth within 30 degrees before and 50 behind the long axis, at both of its ends."""
    for outcome, pairs in ((drive, 2 * 43), (other[1], 2 * 41)):
        assert outcome.parts["cycle"].sizes["pair"] == pairs
        assert outcome.parts["torsion"].sizes["pair"] == pairs


@pytest.fixture(scope="module")
def drive(folder: Path) -> Outcome:
    return open_outcomes(folder)["default"]


@pytest.mark.whole
def test_all_parts_are_there(drive: Outcome) -> None:
    assert list(drive.parts) == PARTS
    assert drive.manifest["finished"]
    told = {name: drive.manifest[name] for name in ("family", "driver", "loaded")}
    assert told == {"family": "strain_wave", "driver": "wave generator", "loaded": "flexspline"}
    assert "palmgren_1959" in [source["key"] for source in drive.manifest["sources"]]


@pytest.mark.whole
def test_an_efficiency_without_losses_is_that_of_the_teeth_alone(folder: Path) -> None:
    name, tree = find_case(str(folder.parent / "drive.toml"))
    with_losses = Variant(tree, name, "default").built({})
    alone = Variant({**tree, "losses": {}}, name, "default").built({})
    assert with_losses.covers == {}
    assert TEETH_ALONE not in with_losses.warnings
    assert alone.covers == {"covers": ALONE, "lacks": LACKING}
    assert ALONE.startswith("teeth alone: bearings, seals and grease")
    assert alone.warnings.count(TEETH_ALONE) == 1
    seal = {"seal": tree["losses"]["seal"]}
    some = Variant({**tree, "losses": seal}, name, "default").built({})
    told = "teeth, seal: the bearing inside the drive is not in it"
    assert some.covers == {"covers": told, "lacks": LACKING}
    assert some.warnings.count(BEARING_FREE) == 1
    assert TEETH_ALONE not in some.warnings


@pytest.mark.whole
def test_the_torsional_stiffness_carries_what_yields(drive: Outcome) -> None:
    covers = drive.parts["torsion"]["torsional_stiffness"].attrs["covers"]
    assert covers.startswith("teeth, ring and cup wall of the flexspline")
    note = drive.parts["torsion"].attrs["note"]
    assert "flange joint" in note
    assert note.startswith(covers)
    assert "assumed proportions: rim thickness, wall" in note
    line = TORSION.screen(drive)[0].line
    assert line.startswith(
        "Stiffness: bearing of the wave generator, bottom of the cup, flange joint, "
    )
    assert line.endswith("are not in it; 3 dimensions of its parts are assumed, see the inputs.")
    assert "assumed proportions: rim thickness" in figures_by_law(drive)["torsion"]["stiffness_of"]


@pytest.mark.whole
def test_the_tables_on_screen(drive: Outcome) -> None:
    (row,) = operation_summary(drive).rows
    assert head("mean_efficiency") in row
    assert "xu_2007" in operation_summary(drive).line
    rows = wind_up_rows(drive)
    assert [row[head("torque", drive.parts["torsion"])] for row in rows] == [
        "33.5",
        "67",
        "100.5",
        "134",
    ]
    rows = error_rows(drive)
    columns = [*rows[0]]
    assert columns[1:] == ["flexspline", "circular spline", "both"]
    assert [row[columns[0]] for row in rows] == ["geometry", "elastic mean", "under load"]
    told = figures_by_law(drive)
    size = float(rows[2]["both"])  # in seconds of arc
    given = told["kinematic_error_range"]["under load"]["both"]
    assert np.degrees(given) * 3600.0 == pytest.approx(size, rel=1e-4)
    json.dumps(told, allow_nan=False)


@pytest.mark.whole
def test_the_loads_carry_the_torque(drive: Outcome) -> None:
    data = drive.parts["operation"]
    ratio = float(data["speed_ratio"].values[0, 0])
    torque = float(data["mean_input_torque"].values[0, 0])
    assert ratio == 100.0
    assert float(data["mean_efficiency"].values[0, 0]) == pytest.approx(67.0 / ratio / torque)
    assert "loss_factor" not in data
    assert float(data["mean_drag_loss"].values[0, 0]) > 0.0
    cycle = drive.parts["cycle"]
    assert (cycle["drag_loss"] > 0.0).all()
    assert (cycle["drag_loss"] < cycle["loss"]).all()
    share = cycle["load_share"].sum(["pair", "slice"]).values
    np.testing.assert_allclose(share, 1.0, rtol=1e-12)


@pytest.mark.whole
def test_wind_up_grows_with_the_torque(drive: Outcome) -> None:
    data = drive.parts["torsion"]
    assert data["wind_up"].values[0] == pytest.approx(0.0, abs=1e-12)
    assert (np.diff(data["wind_up"].values) > 0.0).all()
    assert (np.diff(data["loaded_pairs"].values) >= 0.0).all()
    assert (data["loading_torque"].values >= data["unloading_torque"].values).all()
    assert data["tooth_force"].shape == (25, 8, data.sizes["pair"])


@pytest.mark.whole
def test_orders_of_the_kinematic_error(drive: Outcome) -> None:
    """Odd orders cancel over both ends of the long axis, even ones stand at their place."""
    data = drive.parts["kinematic_error"]
    spectrum = data["kinematic_error_spectrum"]
    mean, loaded = (spectrum.sel(curve=name).values for name in ("elastic mean", "under load"))
    rigid = 0.1e-6 / 0.030  # of upright teeth, all of which lie behind, at the pitch radius
    for spline, order in ((0, 2), (1, 4)):
        few = mean[spline, :100]
        assert np.argmax(few) == order
        assert 0.8 * rigid < few[order] < 1.1 * rigid  # the wave turns by little along a zone
        assert np.delete(few, order).max() < 1e-9 * few[order]
        # Small deviations under load are their elastic mean to first order, odd ones cancel too.
        assert loaded[spline, order] == pytest.approx(few[order], rel=3e-3)
        assert loaded[spline, 1:100:2].max() < 1e-6 * few[order]
    error = data["kinematic_error"]
    both = error.sel(curve="elastic mean").values
    np.testing.assert_allclose(error.sel(curve="under load"), both, atol=0.02 * np.ptp(both))
    assert data["turn_angle"].values[-1] == pytest.approx(2.0 * np.pi * (1.0 - 1.0 / both.size))
    assert kinematic_error_answer(drive).endswith("if they were rigid and without load")


@pytest.mark.whole
def test_waves_stay_on_their_teeth(drive: Outcome) -> None:
    """Once the wave has passed all teeth of the circular spline, those of the other have moved on by two."""
    data = drive.parts["kinematic_error"].sel(curve="elastic mean")
    angle, error = data["turn_angle"].values, data["kinematic_error"].values
    ratio = 202.0 / 200.0
    columns = [np.ones(angle.size)]
    columns += [f(k * angle) for k in (2.0 * ratio, 4.0) for f in (np.cos, np.sin)]
    fitted, *_ = np.linalg.lstsq(np.stack(columns, axis=-1), error, rcond=None)
    sizes = np.hypot(fitted[1::2], fitted[2::2])
    lines = data["kinematic_error_spectrum"].values
    np.testing.assert_allclose(sizes, [lines[0, 2], lines[1, 4]], rtol=1e-3)
    # A wave of the flexspline stands at its phase when the turn begins.
    assert np.arctan2(-fitted[2], fitted[1]) == pytest.approx(np.radians(50.0), abs=0.3)


@pytest.mark.whole
def test_running_without_load(drive: Outcome) -> None:
    data = drive.parts["running"]
    assert (data["no_load_torque"].values > 0.010).all()  # more than the seal
    assert (np.diff(data["no_load_torque"].values, axis=1) > 0.0).all()  # with speed
    assert (data["starting_torque"].values > 0.015).all()
    assert (data["back_driving_torque"].values > 100.0 * 0.015).all()
    words = dict(starting_answer(drive, "constant"))
    rows = running_rows(drive)
    assert [row[head("temperature")] for row in rows] == ["20", "40", "60"]
    told, place = (
        figures_by_law(drive)["running"],
        [row[head("temperature")] for row in rows].index("40"),
    )
    held = float(rows[place][head("starting_torque")].partition(" ")[0])  # before its band
    assert held == pytest.approx(told["constant"]["starting_torque"][place], rel=1e-4)
    torques = [
        [float(row[key].partition(" ")[0]) for row in rows]
        for key in (
            "mean input torque without load at 2000 rpm [N\u00a0m]",
            head("back_driving_torque"),
        )
    ]
    assert all(np.all(np.diff(torque) <= 0.0) for torque in torques)
    there = data.sel(law="constant", temperature=313.15)
    told = float(there["starting_torque"])
    low, high = (float(there[name]) for name in BANDS[0])
    assert low < told < high
    band = [show.quantity("starting_torque", value) for value in (told, low, high)]
    least = show.quantity("starting_torque", low, with_unit=False)
    assert words["starting torque"].startswith(f"{band[0]}, {least} to {band[2]} ")
    told = float(there["no_load_torque"].sel(speed=2000.0 * np.pi / 30.0, method="nearest"))
    assert words["torque without load at 2000\u00a0rpm"] == show.quantity("no_load_torque", told)


@pytest.mark.whole
def test_python_of_the_documentation(
    drive: Outcome, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As it stands there, with the drive at hand in place of the one that it runs."""
    text = block("guide/python.md", "python", "strain_wave.toml")
    monkeypatch.setattr(pp, "run", lambda case: {"default": drive})
    exec(compile(text, "guide/python.md", "exec"), {})
    told = capsys.readouterr().out
    assert str(PARTS) in told
    assert all(name in told for name in ("wall of the cup", "K1", "starting_torque"))


@pytest.mark.whole
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


@pytest.mark.whole
def test_an_interrupted_map_goes_on_where_it_was(tmp_path: Path) -> None:
    made = Variant(tomllib.loads(MAPPED), "pair.toml", "default")
    job = next(job for job in jobs(made, {}) if job.name == "loss_map")

    def compute(after: int, folder: Path | None = tmp_path) -> xr.Dataset:
        return running._part(job, made, "mark", folder, Interrupted(after), {})

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
