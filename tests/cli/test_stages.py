"""A drive of two meshes from its file through the command line: parts, sweeps, record, report."""

import json
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pitchpoint import cli
from pitchpoint.analyses.torsion import _on_edges_of_meshes
from pitchpoint.cases.study_tables import Study, Sweep
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.results.store import load
from pitchpoint.runs.run import Outcome, run_case, uncomputed_manifests
from pitchpoint.views.report import report_page
from pitchpoint.views.sections.spread import spread_sentence

TWO = """
title = "Two stages"
[[stages]]
gears = { teeth = [23, 61], module = "2 mm", face_width = "18 mm" }
[[stages]]
gears = { teeth = [19, 70], module = "3 mm", face_width = "30 mm" }
place = "40 mm"
[lubricant]
name = "pao-vg-150"
[roughness]
ra = "0.4 um"
[operation]
torque = "300 N m"
speed = "1500 rpm"
temperature = "60 degC"
[models]
friction = ["iso_tr_14179_2", "xu_2007"]
load_sharing = "from_stiffness"
[losses.seal]
between = ["shaft 3", "housing"]
seal_torque = "0.5 N m"
[loss_map]
count = 2
temperatures = ["60 degC"]
"""
PARTS = [
    "teeth",
    "inspection",
    "reflected",
    "cycle",
    "operation",
    "laws",
    "strength",
    "torsion",
    "stiffness",
    "study_sweep_operation_speed",
]
PARTS += ["study_sweep_stages_1_gears_profile_shift_1", "running", "loss_map", "back_driving"]
SWEEPS = ["--sweep", "operation.speed=500 rpm:1500 rpm:2"]
SWEEPS += ["--sweep", "stages.1.gears.profile_shift.1=0:0.3:2"]
SPEED = 1500.0 * np.pi / 30.0
RATIO = (61 / 23) * (70 / 19)


def call(*arguments: object) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
    assert caught.value.code == 0


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of the drive, and of its record fed back."""
    place = tmp_path_factory.mktemp("stages")
    (place / "two.toml").write_text(TWO)
    setting = ["--set", 'stages.2.roughness.ra="0.3 um"']
    call("run", place / "two.toml", "-o", place / "out", *SWEEPS, *setting)
    call("run", place / "out" / "default" / "manifest.json", "-o", place / "again")
    return place


@pytest.mark.whole
def test_all_parts_are_there_and_the_record_repeats_them_bit_for_bit(folder: Path) -> None:
    first, again = folder / "out" / "default", folder / "again" / "default"
    manifest = json.loads((first / "manifest.json").read_text())
    assert manifest["parts"] == PARTS
    for part in PARTS:
        assert load(first / f"{part}.nc").identical(load(again / f"{part}.nc")), part
    assert "vibration" not in manifest["lacks"]
    assert manifest["members"] == ["shaft 1", "shaft 2", "shaft 3"]
    np.testing.assert_allclose(manifest["motion"], [1.0, -23 / 61, 1.0 / RATIO], rtol=1e-14)


@pytest.mark.whole
def test_what_is_set_for_a_stage_is_its_own(folder: Path) -> None:
    rows = json.loads((folder / "out" / "default" / "manifest.json").read_text())["inputs"]
    every = {f"{row['table']}.{row['key']}": row for row in rows}
    assert every["stages.2.roughness.ra"]["value"] == [3e-7, 3e-7]
    assert every["stages.2.roughness.ra"]["status"] == "set"
    assert every["roughness.ra"]["value"] == [4e-7, 4e-7]
    assert "stages.1.roughness.ra" not in every
    flank = every["stages.2.gears.flank"]
    assert (flank["value"], flank["status"], flank["given"]) == ("right", "derived", False)


@pytest.mark.whole
def test_the_loss_of_a_seal_is_that_of_its_shaft(folder: Path) -> None:
    data = load(folder / "out" / "default" / "operation.nc")
    lost = 0.5 * SPEED / RATIO
    np.testing.assert_allclose(data["stage_drag_loss"].values[:, 0], [[0.0, lost]] * 2, rtol=1e-10)
    put_in = data["mean_input_torque"].values * SPEED
    np.testing.assert_allclose(put_in - 300.0 * SPEED / RATIO, data["mean_loss"].values, rtol=1e-10)
    product = data["stage_efficiency"].values.prod(axis=-1)
    np.testing.assert_allclose(product, data["mean_efficiency"].values, rtol=1e-12)


@pytest.mark.whole
def test_a_seal_at_the_output_is_what_starts_the_drive(folder: Path) -> None:
    data = load(folder / "out" / "default" / "running.nc")
    assert data["speed"].values == pytest.approx([SPEED])
    np.testing.assert_allclose(data["back_driving_torque"], 0.5, rtol=1e-10)  # no load on teeth
    for name in ("starting_torque", "no_load_torque"):
        over = data[name].values * RATIO / 0.5
        assert np.all((over > 1.0) & (over < 1.06)), name  # and the friction of teeth that turn it


@pytest.mark.whole
def test_a_sweep_holds_the_operating_point(folder: Path) -> None:
    where = folder / "out" / "default"
    point, speeds = load(where / "operation.nc"), load(where / "study_sweep_operation_speed.nc")
    shifts = load(where / "study_sweep_stages_1_gears_profile_shift_1.nc")
    for name in ("mean_efficiency", "torque_ripple", "stage_loss"):
        expected = point[name].values[:, 0]
        np.testing.assert_allclose(speeds[name].values[:, -1], expected, rtol=1e-10)
        np.testing.assert_allclose(shifts[name].values[:, 0], expected, rtol=1e-10)
    assert np.all(np.abs(np.diff(shifts["mean_efficiency"].values)) > 1e-5)


@pytest.mark.whole
def test_the_report_shows_the_stages(folder: Path) -> None:
    page = (folder / "out" / "report.html").read_text().replace("\u00a0", " ")
    for words in (
        'id="stages"',
        'id="inspection"',
        'id="reflected"',
        'id="torsion"',
        'id="map"',
        "Wind-up at the output by the stage",
    ):
        assert words in page, words
    assert "shaft 1 drives at 1500 rpm, shaft 3 carries 300" in page
    assert "Averages run over all meetings of the phases of the stages." in page
    assert "Wind-up of the loaded member with the input held" in page
    assert "with the other members held" not in page
    assert "largest less smallest rotation of each stage, at the output, summed" in page


@pytest.mark.whole
def test_json_of_a_case_on_disk_has_the_figures_by_stage(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call("run", folder / "out" / "default" / "manifest.json", "-o", folder / "again", "--json")
    told = capsys.readouterr()
    assert "(on disk)" in told.err
    found = json.loads(told.out)["default"]
    each = found["operation"]["xu_2007"]
    assert len(each["stage_loss"]) == 2
    assert sum(each["stage_loss"]) == pytest.approx(each["mean_loss"], rel=1e-12)
    assert found["torsion"]["torsional_stiffness"][-1] > 1e6


@pytest.mark.whole
def test_the_screen_has_a_row_for_each_stage(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call("run", folder / "out" / "default" / "manifest.json", "-o", folder / "again", "--full")
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("friction law") and "stage" in line for line in lines)
    assert any("Averages over: all meetings of phases." in line for line in lines)


def test_edges_that_carry_are_told_of_their_stage() -> None:
    built = Variant(tomllib.loads(TWO), "two.toml", "default").built({})
    torques, none = np.array([0.0, 150.0, 300.0]), {"wind_up": np.zeros(3)}
    much = none | {"edge_share": np.array([0.0, 0.01, 0.05])}
    (told,) = _on_edges_of_meshes(built, torques, [none, much])
    assert told.startswith("Stage 2: edges of the teeth")
    assert "carry up to 5 % of the load, that part at 300 N m" in told
    assert _on_edges_of_meshes(built, torques, [none, none]) == []


def test_variants_change_one_stage() -> None:
    tree: dict[str, Any] = tomllib.loads(TWO)
    tree["variants"] = {"wide": {"stages": {"2": {"gears": {"face_width": "40 mm"}}}}}
    case = Variant(tree, "two.toml", "wide").built({}).case
    widths = [stage.gears.face_width for stage in case.stages.values()]
    assert widths == pytest.approx([0.018, 0.04])


def test_show_tells_where_values_of_a_stage_come_from(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    marked = '{ value = "2 mm", status = "printed", where = "Table 1" }'
    path.write_text(TWO.replace('module = "2 mm"', f"module = {marked}"))
    (manifest,) = uncomputed_manifests(str(path))
    (row,) = (one for one in manifest["inputs"] if one["key"] == "1.gears.module")
    assert (row["status"], row["where"], row["value"]) == ("printed", "Table 1", 0.002)


ONE = """
[[stages]]
gears = { teeth = [23, 61], module = "2 mm", face_width = "18 mm" }
""" + TWO.partition('place = "40 mm"')[2].partition("[losses.seal]")[0]
BEARING = """
[losses.seat]
between = ["shaft 2", "housing"]
bearing = "palmgren_1959"
mean_diameter = "46 mm"
f0 = 2.0
f1 = 0.001
"""


def test_a_drive_of_one_stage_names_its_shafts_and_bearings(tmp_path: Path) -> None:
    path = tmp_path / "one.toml"
    path.write_text(ONE + BEARING)
    (manifest,) = uncomputed_manifests(str(path))
    assert (manifest["driver"], manifest["loaded"]) == ("shaft 1", "shaft 2")
    assert [one["effect"] for one in manifest["models"]].count("bearing seat") == 1
    assert "palmgren_1959" in {one["key"] for one in manifest["sources"]}


def test_a_sweep_of_stages_names_one_of_them(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    path.write_text(TWO)
    for key in ("stages.gears.module", "stages.0.gears.module"):
        wrong = {"swept": Study(sweep=Sweep(key=key, values=("2 mm",)))}
        with pytest.raises(InputError, match=r"there is no stage .*; use stages.1 to stages.2"):
            uncomputed_manifests(str(path), studies=wrong)


def test_the_load_sharing_of_stages_that_differ_is_told_of_each(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    path.write_text(TWO)
    (manifest,) = uncomputed_manifests(
        str(path), settings={"stages.1.models.load_sharing": "equal"}
    )
    titles = {one["effect"]: one["title"] for one in manifest["models"]}
    first, second = (titles[f"load sharing, stage {number}"] for number in (1, 2))
    page = report_page({"default": Outcome(manifest, {})})
    assert f"<dt>Load sharing</dt><dd>stage 1: {first}; stage 2: {second}</dd>" in page


def test_the_screen_says_why_no_other_friction_law_is_tried() -> None:
    why = "every stage has a friction law of its own"
    assert spread_sentence(Outcome({"lacks": {"laws": why}}, {})) == f"E{why[1:]}."


FIRST = 'gears = { teeth = [23, 61], module = "2 mm", face_width = "18 mm" }\n'
SECOND = 'gears = { teeth = [19, 70], module = "3 mm", face_width = "30 mm" }\n'
FILM = 'film = { solver = "line", phases = 3, nodes = 33 }\n'
WEAR = 'wear = { law = "vdi_2736", cycles = 1e6, rate = "1e-9 mm3/(N m)", profile = "kept" }\n'
POINT = """
[lubricant]
name = "pao-vg-150"
[roughness]
ra = "0.4 um"
[operation]
torque = "{} N m"
speed = "1500 rpm"
temperature = "60 degC"
[models]
friction = "iso_tr_14179_2"
"""


@pytest.mark.whole
def test_films_and_wear_of_a_stage_are_those_of_its_gears_under_what_it_carries(
    tmp_path: Path,
) -> None:
    stages = f"[[stages]]\n{FIRST}{FILM}{WEAR}[[stages]]\n{SECOND}{WEAR}"
    (tmp_path / "two.toml").write_text(stages + POINT.format(300))
    parts = ["operation", "film", "wear"]
    (whole,) = run_case(
        str(tmp_path / "two.toml"), folder=tmp_path / "out", analyses=parts
    ).values()
    carried = float(whole.parts["operation"]["stage_input_torque"][0, 0, 1])
    (tmp_path / "one.toml").write_text(f"{FIRST}{FILM}{WEAR}{POINT.format(carried)}")
    (one,) = run_case(str(tmp_path / "one.toml"), analyses=parts[1:]).values()
    for part in parts[1:]:
        there = of_stage(whole.parts[part], 1)
        for name, values in one.parts[part].items():
            if values.dtype.kind == "f":
                np.testing.assert_allclose(there[name], values, rtol=1e-9, err_msg=str(name))
    assert stages_of(whole.parts["film"]) == (1,)
    assert stages_of(whole.parts["wear"]) == (1, 2)
    page = report_page({"default": whole})
    for words in ("Films solved, stage 1", "Wear depth, stage 1", "Wear depth, stage 2"):
        assert words in page, words
    again = run_case(str(tmp_path / "out" / "default" / "manifest.json"), analyses=parts)["default"]
    assert again.parts["wear"].identical(whole.parts["wear"])


def test_a_table_of_films_belongs_to_a_stage(tmp_path: Path) -> None:
    stages = f"{FILM}[[stages]]\n{FIRST}[[stages]]\n{SECOND}"
    with pytest.raises(InputError, match=r"give a stage the table, film = \{ ... \}"):
        Variant(tomllib.loads(stages + POINT.format(300)), "two.toml", "default").built({})
    inside = f"[[stages]]\n{FIRST}{FILM.replace('line', 'elliptic')}[[stages]]\n{SECOND}"
    with pytest.raises(InputError, match="elliptic") as caught:
        Variant(tomllib.loads(inside + POINT.format(300)), "two.toml", "default").built({})
    assert caught.value.key == "stages.1.film.solver"


@pytest.mark.parametrize(("place", "over"), [("24 mm", ""), ("20 mm", "4 mm"), ("-10 mm", "14 mm")])
def test_faces_that_lie_over_each_other_on_a_shaft_are_told(place: str, over: str) -> None:
    tree = tomllib.loads(TWO.replace("40 mm", place))
    told = " ".join(Variant(tree, "two.toml", "default").built({}).warnings)
    assert (f"On shaft 2 the gears of stages 1 and 2 lie {over} over each other" in told) == bool(
        over
    )
    del tree["stages"][1]["place"]  # nothing is said of places, and nothing hangs on them
    assert "over each other" not in " ".join(
        Variant(tree, "two.toml", "default").built({}).warnings
    )
