"""The commands from the outside: what they print, what they leave on disk, how they end."""

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from called import TINY, Told

from pitchpoint.analyses import studies
from pitchpoint.cases.study_tables import Study, Sweep
from pitchpoint.runs import run as running
from pitchpoint.runs.run import open_outcomes
from pitchpoint.views import show
from pitchpoint.views.report import report_page

PARTS = {
    "teeth",
    "inspection",
    "cycle",
    "operation",
    "laws",
    "strength",
    "loss_map",
    "back_driving",
}


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    path = tmp_path / "tiny.toml"
    path.write_text(TINY)
    return path


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of the tiny case, computed once; tests that change them take a copy."""
    folder = tmp_path_factory.mktemp("finished")
    (folder / "tiny.toml").write_text(TINY)
    running.run_case(str(folder / "tiny.toml"), folder=folder / "out")
    return folder / "out"


@pytest.fixture(scope="module")
def repeated(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Results of the tiny case with a setting and a sweep, and those of their record, without the case."""
    folder = tmp_path_factory.mktemp("repeated")
    (case := folder / "tiny.toml").write_text(TINY)
    sweep = Sweep(key="operation.temperature", start="50 degF", stop="60 degC", count=2)
    running.run_case(
        str(case),
        folder=folder / "out",
        settings={"operation.speed": "1234.5678 rpm"},
        studies={"warm": Study(sweep=sweep)},
    )
    case.unlink()
    (record := folder / "moved" / "joint.json").parent.mkdir()
    (folder / "out" / "default" / "manifest.json").rename(record)
    running.run_case(str(record), folder=folder / "again")
    shutil.copy(record, folder / "out" / "default" / "manifest.json")
    return folder / "out", folder / "again"


def times(folder: Path) -> dict[str, int]:
    return {path.stem: path.stat().st_mtime_ns for path in folder.glob("default/*.nc")}


# ---- listing and showing


def test_cases(pitchpoint: Callable[..., Told]) -> None:
    told = pitchpoint("cases", "--json").json
    assert [row["case"] for row in told] == [
        "atanasiu2011",
        "csd25",
        "hfuc32",
        "liu_xiong_torus",
        "tian2024",
        "xu2021",
        "zhao2022",
    ]
    assert "tian2024" in pitchpoint("cases").out


def test_show(pitchpoint: Callable[..., Told], tiny: Path) -> None:
    shown = pitchpoint("show", "tian2024", "--variant", "physical", "--json").json
    assert [one["variant"] for one in shown] == ["physical"]
    rows = {(row["table"], row["key"]): row for row in shown[0]["inputs"]}
    assert rows["gears", "module"]["value"] == 0.003
    assert rows["gears", "module"]["kind"] == "length"
    assert rows["gears", "module"]["status"] == "printed"
    assert rows["gears", "module"]["where"] == "Table 1"
    assert rows["gears", "flank"]["status"] == "default"
    assert shown[0]["issues"]
    told = pitchpoint("show", "tian2024")
    assert told.status == 0
    assert all(issue["where"] in told.out for issue in shown[0]["issues"])


def test_show_takes_settings(pitchpoint: Callable[..., Told], tiny: Path) -> None:
    told = pitchpoint("show", tiny, "--set", "operation.torque=77 N m", "--json")
    (manifest,) = json.loads(told.out)
    row = next(row for row in manifest["inputs"] if row["key"] == "torque")
    assert (row["value"], row["status"]) == (77.0, "set")
    wrong = pitchpoint("show", tiny, "--set", "operation.torqe=7 N m")
    assert (wrong.status, wrong.out) == (2, "")
    assert "operation.torqe: is not a known key" in wrong.err


def test_text_of_the_user_is_shown_as_typed(pitchpoint: Callable[..., Told], tiny: Path) -> None:
    assert "A [bold]pair[/bold] of <b>gears</b>" in pitchpoint("show", tiny).out


def test_models(pitchpoint: Callable[..., Told]) -> None:
    rows = pitchpoint("models", "--json").json
    kinds = {row["kind"] for row in rows}
    assert kinds >= {"friction", "load_sharing", "rolling_resistance", "lubricant", "material"}
    assert {row["name"] for row in rows if row["kind"] == "bearing"} == {"none", "palmgren_1959"}
    sharing = next(row for row in rows if row["name"] == "sanchez_2017")
    assert sharing["range"] == "1 < contact ratio < 2"
    assert all(row["name"] in pitchpoint("models").out for row in rows[:3])
    of_kind = pitchpoint("models", "friction").out
    assert "xu_2007" in of_kind and "sanchez_2017" not in of_kind
    sheet = pitchpoint("models", "sanchez_2017").out
    assert "1 < contact ratio < 2" in sheet and "from_stiffness" not in sheet
    assert pitchpoint("models", "xu_2007", "--json").json == [
        row for row in rows if row["name"] == "xu_2007"
    ]
    wrong = pitchpoint("models", "xu2007")
    assert wrong.status == 2 and "did you mean xu_2007?" in wrong.err


# ---- running


def test_run_leaves_results_that_are_not_computed_twice(
    pitchpoint: Callable[..., Told], tiny: Path, tmp_path: Path
) -> None:
    first = pitchpoint("run", tiny, "--json")
    assert first.status == 0
    figures = first.json["default"]
    assert set(figures["operation"]) == {"xu_2007", "frictionless"}
    assert 0.9 < figures["operation"]["xu_2007"]["mean_efficiency"] < 1.0
    assert figures["operation"]["frictionless"]["mean_efficiency"] == pytest.approx(1.0, abs=1e-12)
    assert len(figures["studies"]["speed"]["axis"]["values"]) == 3
    assert figures["studies"]["smooth"]["xu_2007"]["mean_loss"] > 0.0
    made = times(tmp_path / "results" / "tiny")
    assert set(made) == PARTS | {"study_speed", "study_smooth"}
    outcome = open_outcomes(tmp_path / "results" / "tiny")["default"]
    assert outcome.manifest["finished"]
    assert outcome.parts["operation"]["mean_efficiency"].attrs["units"] == "1"

    again = pitchpoint("run", tiny)
    assert again.status == 0
    assert "A [bold]pair[/bold] of <b>gears</b>" in again.out
    assert "% by xu_2007" in again.out
    assert times(tmp_path / "results" / "tiny") == made

    smooth = ("--set", "roughness.ra=0.2 um", "--sweep", "operation.torque=10 N m:50 N m:2")
    other = pitchpoint("run", tiny, *smooth, "--json").json["default"]
    loss = other["operation"]["xu_2007"]["mean_loss"]
    assert loss == pytest.approx(figures["studies"]["smooth"]["xu_2007"]["mean_loss"], rel=1e-12)
    assert other["studies"]["sweep_operation_torque"]["axis"]["values"] == [10.0, 50.0]
    assert times(tmp_path / "results" / "tiny") == made
    (changed,) = (tmp_path / "results").glob("tiny+*")
    assert changed.name == "tiny+roughness.ra=0.2_um"


def test_every_part_says_what_became_of_its_solves(repeated: tuple[Path, Path]) -> None:
    (outcome,) = running.open_outcomes(repeated[0]).values()
    solves = {name: json.loads(data.attrs["solve"]) for name, data in outcome.parts.items()}
    for name, told in solves.items():
        assert told.keys() == {"code", "sentence", "residual", "iterations"}
        assert told["code"] == 0, f"{name}: {told['sentence']}"
    assert solves["teeth"]["residual"] is None
    swept = next(name for name in solves if name.startswith("study_"))
    for name in ("operation", "back_driving", swept):
        assert solves[name]["sentence"] == "a solution was found"
        assert 0.0 <= solves[name]["residual"] < 1e-10
        assert solves[name]["iterations"] > 1


def test_a_record_repeats_its_result_bit_for_bit(repeated: tuple[Path, Path]) -> None:
    first, again = (folder / "default" for folder in repeated)
    files = {path.name for path in first.iterdir()}
    assert files == {path.name for path in again.iterdir()}
    assert files > {"cycle.nc", "loss_map.nc", "study_smooth.nc", "study_warm.nc", "manifest.json"}
    for name in files - {"case.toml"}:  # in the units of the case there, in SI here
        assert (first / name).read_bytes() == (again / name).read_bytes(), name
    rows = json.loads((again / "manifest.json").read_text())["inputs"]
    (row,) = (row for row in rows if (row["table"], row["key"]) == ("operation", "speed"))
    assert row["value"] == pytest.approx(1234.5678 * np.pi / 30.0, rel=1e-15)


def test_the_folder_of_a_result_repeats_it_bit_for_bit(
    pitchpoint: Callable[..., Told], repeated: tuple[Path, Path], tmp_path: Path
) -> None:
    out = shutil.copytree(repeated[0], tmp_path / "out")
    made = times(out)
    assert pitchpoint("run", out).status == 0
    assert times(out) == made  # all on disk
    (out / "default" / "cycle.nc").unlink()
    again = pitchpoint("run", out, "-o", "again", "--json").json
    assert again["default"]["studies"]["warm"]["axis"]["key"] == "operation.temperature"
    first, other = (folder / "default" for folder in (repeated[0], tmp_path / "again"))
    for name in made:
        assert (first / f"{name}.nc").read_bytes() == (other / f"{name}.nc").read_bytes(), name
    assert (first / "case.toml").read_bytes() == (other / "case.toml").read_bytes()
    assert json.loads((other / "manifest.json").read_text())["case"] == "tiny.toml"


def test_the_report_of_a_repeated_result_is_the_same(repeated: tuple[Path, Path]) -> None:
    one, other = (report_page(open_outcomes(folder)) for folder in repeated)
    assert one == other
    assert "<code>operation.speed</code> = 1234.57 rpm" in one.replace("\u00a0", " ")


def test_a_record_is_a_case_to_other_commands(
    pitchpoint: Callable[..., Told], repeated: tuple[Path, Path]
) -> None:
    record = repeated[0] / "default" / "manifest.json"
    shown = pitchpoint("show", record, "--set", "operation.torque=7 N m").out
    assert re.search(r"operation +speed +1234.57 rpm +set", shown)
    assert re.search(r"operation +torque +7 N m +set", shown)
    assert "xu_2007" in pitchpoint("cite", record).out
    assert pitchpoint("compare", record).complaint == (
        "error: manifest.json: has no targets to compare with; give several designs, or a published case"
    )


def test_units_by_choice_are_kept_and_compute_nothing_anew(
    pitchpoint: Callable[..., Told], finished: Path, tmp_path: Path
) -> None:
    shutil.copytree(finished.parent, tmp_path / "moved")
    case, folder = tmp_path / "moved" / "tiny.toml", tmp_path / "moved" / "out"
    made = times(folder)
    chosen = ("--units", "torque=N cm, speed of nothing=rpm")
    told = pitchpoint("run", case, "-o", folder, *chosen)
    assert told.err.startswith('error: --units: "speed of nothing" is no kind of quantity')
    told = pitchpoint("run", case, "-o", folder, "--units", "torque=N cm", "--units", "power=mW")
    assert told.status == 0
    assert re.search(r"Input +\S+ N cm", told.out)
    assert re.search(r"Loss +\S+ mW", told.out)
    assert times(folder) == made
    kept = open_outcomes(folder)["default"]
    assert kept.parts["operation"]["mean_input_torque"].attrs["units"] == "N m"
    assert [row["value"] for row in kept.manifest["inputs"] if row["table"] == "output"] == [
        {"torque": "N cm", "power": "mW"}
    ]
    assert " N cm" in pitchpoint("run", folder).out  # of the case that it holds
    assert times(folder) == made

    def heads(*options: str) -> str:
        assert pitchpoint("export", folder, "--csv", *options).status == 0
        return (folder / "export" / "cycle_law_node.csv").read_text().partition("\n")[0]

    assert "input_torque [N cm]" in heads()
    assert "input_torque [mN m]" in heads("--units", "torque=mN m")
    assert "input_torque [N m]" in heads("--si")
    told = pitchpoint("export", folder, "--csv", "--si", "--units", "torque=mN m")
    assert told.complaint.endswith("give one of --si and --units")
    assert re.search(r"Input +\S+ N m", pitchpoint("run", case, "-o", folder).out)
    assert times(folder) == made


def test_print_has_its_own_units(pitchpoint: Callable[..., Told]) -> None:
    told = pitchpoint("compare", "tian2024", "--units", "torque=N cm")
    assert (told.status, told.out) == (2, "")
    assert told.complaint.startswith("error: --units: goes with several designs")


def test_another_case_is_not_written_over(
    pitchpoint: Callable[..., Told], tiny: Path, tmp_path: Path
) -> None:
    other = tmp_path / "other" / "tiny.toml"
    other.parent.mkdir()
    other.write_text(TINY.replace("50 N m", "60 N m"))
    assert pitchpoint("run", tiny).status == 0
    made = times(tmp_path / "results" / "tiny")
    told = pitchpoint("run", other, "-o", "results/tiny")
    assert (told.status, told.out) == (2, "")
    assert told.err.startswith(
        "error: results/tiny: holds results of another case, ../../tiny.toml;"
    )
    assert times(tmp_path / "results" / "tiny") == made
    assert "results/other-tiny/report.html" in pitchpoint("run", other).out
    assert times(tmp_path / "results" / "tiny") == made
    assert pitchpoint("run", other, "-o", "results/tiny", "--overwrite").status == 0
    assert times(tmp_path / "results" / "tiny")["operation"] != made["operation"]


@pytest.mark.whole
def test_a_run_that_is_set_otherwise_says_what_it_replaces(
    pitchpoint: Callable[..., Told], tiny: Path, finished: Path, tmp_path: Path
) -> None:
    folder = shutil.copytree(finished, tmp_path / "out")
    assert "has replaced it" not in pitchpoint("run", tiny, "-o", folder).err
    hotter = ("run", tiny, "-o", folder, "--set", "operation.temperature=70 degC")
    assert f"{folder} held a run without --set; this one" in pitchpoint(*hotter).err
    assert "has replaced it" not in pitchpoint(*hotter).err
    replaced = "held a run with --set operation.temperature=70 degC; this one has replaced it"
    assert replaced in pitchpoint("run", tiny, "-o", folder).err


def test_damaged_parts_are_computed_again(
    pitchpoint: Callable[..., Told], tiny: Path, finished: Path, tmp_path: Path
) -> None:
    folder = shutil.copytree(finished, tmp_path / "out")
    before = pitchpoint("run", tiny, "-o", folder, "--json")
    made = times(folder)
    parts = folder / "default"
    (parts / "operation.nc").write_bytes(b"no dataset at all")
    whole = (parts / "cycle.nc").read_bytes()
    (parts / "cycle.nc").write_bytes(whole[: len(whole) // 2])
    (parts / "laws.nc").write_bytes(b"")
    (parts / "teeth.nc").unlink()
    pieces = [parts / "study_gone.0003.nc", parts / ".laws-abcd1234.nc"]  # of runs that were killed
    for piece in pieces:
        piece.touch()
    refused = pitchpoint("cite", folder)
    assert refused.status == 2
    assert refused.out == ""
    assert refused.err.count("\n") == 1
    assert ".nc: " in refused.err
    after = pitchpoint("run", tiny, "-o", folder, "--json")
    assert after.json == before.json
    assert not any(piece.exists() for piece in pieces)
    kept = {name for name, stamp in times(folder).items() if stamp == made.get(name)}
    assert kept == {*PARTS, "study_speed", "study_smooth"} - {"teeth", "cycle", "operation", "laws"}


def test_cite(pitchpoint: Callable[..., Told], finished: Path, tiny: Path) -> None:
    sources = pitchpoint("cite", finished, "--json").json
    assert "xu_2007" in [source["key"] for source in sources]
    told = pitchpoint("cite", finished).out
    assert re.search(r"^xu_2007: Xu.* \[friction xu_2007\]$", told, re.M)
    assert all(" [" in line for line in told.splitlines()[:-1])
    assert "{xu_2007," in pitchpoint("cite", finished, "--bibtex").out
    assert "@misc{pitchpoint," in pitchpoint("cite", finished, "--bibtex").out
    assert pitchpoint("cite", tiny, "--json").json == sources


def test_a_mesh_that_friction_locks(pitchpoint: Callable[..., Told], tiny: Path) -> None:
    changes = [
        'models.friction={name="constant", coefficient=2.0}',
        "operation.driver=gear 2",
        "gears.profile_shift=[0.8, -0.6]",
    ]
    told = pitchpoint("run", tiny, *(part for change in changes for part in ("--set", change)))
    assert told.status == 3
    assert told.out == ""
    assert told.complaint.count("\n") <= 1
    assert "friction locks the mesh with constant" in told.complaint
    found = re.search(r"friction 2 reaches the ([0-9.]+) at which this mesh locks", told.complaint)
    assert found
    assert 1.0 < float(found.group(1)) < 2.0
    assert "50 N m" in told.complaint


def test_points_of_a_study_out_of_the_range_of_their_law_are_marked(finished: Path) -> None:
    outcomes = open_outcomes(str(finished))
    study = outcomes["default"].parts["study_speed"]
    assert study["extrapolated"].sel(law="xu_2007").values.all()  # films below the roughness
    assert not study["extrapolated"].sel(law="frictionless").values.any()
    smooth = study_of_one_point = outcomes["default"].parts["study_smooth"]
    assert study_of_one_point["extrapolated"].shape == smooth["mean_loss"].shape
    page = report_page(outcomes)
    efficiency = show.quantity(
        "mean_efficiency", float(smooth["mean_efficiency"][0, 0]), with_unit=False
    )
    assert (f"{efficiency}†" in page) is bool(smooth["extrapolated"][0, 0])
    assert ("out of its range there" in page) is bool(smooth["extrapolated"][0, 0])


# ---- interruptions

PIECE, POINTS = 16, 160
SWEEP = f"operation.torque=10 N m:50 N m:{POINTS}"
CODE = f"""
import pitchpoint.cli as cli
from pitchpoint.analyses import studies
studies.PIECE = {PIECE}
cli._write_report = lambda outcomes, folder, **_: None
cli.main()
"""
PIECES = "study_sweep_operation_torque.0*.nc"


def killed_after_another_piece(folder: Path, *arguments: str) -> None:
    """A process of its own that dies when it has put one more piece on disk."""
    pieces = partial(folder.glob, f"out/default/{PIECES}")
    gone, limit = len(list(pieces())), time.monotonic() + 300.0
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, *arguments],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while len(list(pieces())) <= gone:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < limit
        time.sleep(0.02)
    process.kill()
    process.communicate(timeout=60)
    assert process.returncode == -signal.SIGKILL


@pytest.mark.whole
def test_interrupted_runs_go_on_where_they_were(
    pitchpoint: Callable[..., Told],
    finished: Path,
    tiny: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shutil.copytree(finished, tmp_path / "out")
    for name in ("study_smooth", "loss_map", "back_driving"):
        (tmp_path / "out" / "default" / f"{name}.nc").unlink()
    command = ("run", tiny.name, "-o", "out", "--sweep", SWEEP)

    def save(data: xr.Dataset, path: Path) -> None:
        running_save(data, path)
        if path.match(PIECES):
            signal.raise_signal(signal.SIGINT)

    running_save = running.save
    # Workers that run tests side by side ignore the signal.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    with monkeypatch.context() as changed:
        changed.setattr(studies, "PIECE", PIECE)
        changed.setattr(running, "save", save)
        told = pitchpoint(*command)
    signal.signal(signal.SIGINT, handler)
    assert told.status == 130
    assert told.out == ""
    assert len(told.complaint.splitlines()) == 1
    assert told.complaint.startswith("interrupted: ")
    assert "finished parts are in out" in told.complaint
    assert "the same command goes on from there" in told.complaint
    outcome = open_outcomes(tmp_path / "out")["default"]
    assert not outcome.manifest["finished"]
    assert {"teeth", "cycle", "operation", "laws", "study_speed"} <= set(outcome.parts)
    assert not list(tmp_path.glob("out/default/.*"))
    kept = times(tmp_path / "out")
    assert [name for name in kept if ".0" in name]

    killed_after_another_piece(tmp_path, *command)
    open_outcomes(tmp_path / "out")
    killed = times(tmp_path / "out")
    assert {name: killed[name] for name in kept} == kept

    monkeypatch.setattr(studies, "PIECE", PIECE)
    done = pitchpoint(*command, "--json")
    assert done.status == 0, done.err
    whole = times(tmp_path / "out")
    assert {name: whole[name] for name in whole if name in kept} == {
        name: stamp for name, stamp in kept.items() if ".0" not in name
    }
    axis = done.json["default"]["studies"]["sweep_operation_torque"]["axis"]["values"]
    assert len(axis) == POINTS
    assert axis == sorted(axis)
    assert "study_sweep_operation_torque" in whole


def test_a_reader_that_stops_early() -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", CODE, "models"], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    with process.stderr:
        err = process.stderr.read()
    process.wait(60)
    assert b"Traceback" not in err
    assert process.returncode in (0, 1)
