"""What stands on a bench is what `run_case` says of each case."""

import json
import sys

import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint import cli
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.runs.run import run_case

TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "60 N m", "speed": "3000 rpm", "temperature": "60 degC"},
}
LAWS = {"friction": {"name": "constant", "coefficient": 0.05}}
NEEDLES = {
    "between": ["planet", "carrier"],
    "bearing": "palmgren_1959",
    "mean_diameter": "12 mm",
    "f0": 5.0,
    "f1": 0.0005,
}
SET = {"family": "planetary", "teeth": [24, 30, 84], "module": "1 mm", "face_width": "12 mm"}
SETS = {
    "planetary": {
        "gears": SET | {"pin_stiffness": "100 N/um"},
        "losses": {"needles": NEEDLES},
        "models": LAWS | {"load_sharing": "from_stiffness"},
        **TABLES,
    },
    "3K": {
        "gears": {
            **SET,
            "teeth": [18, 36, 90],
            "second": {"teeth": [34, 88], "module": "1 mm", "face_width": "12 mm"},
        },
        "models": LAWS,
        **TABLES,
    },
    "two sets": {
        "stages": [{"gears": SET}, {"gears": SET | {"teeth": [25, 29, 83], "planets": 4}}],
        "models": LAWS,
        **TABLES,
    },
    "pair": {
        "gears": {
            "teeth": [23, 61],
            "module": "2 mm",
            "face_width": "20 mm",
            "inspection": {"thickness_field": "e24", "centre_distance_field": "js7"},
        },
        "models": LAWS,
        **TABLES,
    },
    "strain wave": {
        "gears": {
            "family": "strain_wave",
            "teeth": [120, 122],
            "module": "0.5 mm",
            "face_width": "12 mm",
            "tooth": {"set": "liu"},
            "wave_generator": {"bearing": {}},
            "yielding": {},
        },
        "losses": {"set": "strain_wave_component"},
        "models": {"friction": {"name": "constant", "coefficient": 0.08}},
        **TABLES,
    },
}
READ = ["operation", "back_driving", "torsion", "running", "reflected", "inspection", "bodies"]


def parts_of(case):
    built = pp.load_case(case)
    there = [name for name in READ if ANALYSES[name].why_not(built) is None]
    return run_case(case, analyses=there)["default"].parts


@pytest.mark.parametrize(
    "name",
    [
        "planetary",
        *(pytest.param(name, marks=pytest.mark.whole) for name in SETS if name != "planetary"),
    ],
)
def test_figures_of_a_bench_are_those_of_the_runs(name):
    case = SETS[name]
    (drive,) = pp.bench([case]).drives
    parts, figures = parts_of(case), drive.figures
    expected = {
        "efficiency": parts["operation"]["mean_efficiency"].item(),
        "torque_ripple": parts["operation"]["torque_ripple"].item(),
        "back_efficiency": parts["back_driving"]["mean_efficiency"].item(),
    }
    torsion = parts.get("torsion")
    if torsion is None:
        stiff = {"models.load_sharing": "from_stiffness"}
        torsion = run_case(case, analyses=["torsion"], settings=stiff)["default"].parts["torsion"]
        assert any("from_stiffness" in remark for remark in drive.remarks)
    expected["torsional_stiffness"] = torsion["torsional_stiffness"].sel(torque=60.0).item()
    if "running" in parts:
        running = parts["running"].isel(law=0)
        there = running.sel(temperature=333.15, method="nearest")
        expected["no_load_torque"] = float(
            there["no_load_torque"].sel(speed=100.0 * np.pi, method="nearest")
        )
        expected["starting_torque"] = float(there["starting_torque"])
        expected["back_driving_torque"] = float(there["back_driving_torque"])
    else:
        assert drive.lacks["starting_torque"] == "the case has no [losses] beside its teeth"
    if "reflected" in parts:
        expected["drive_mass"] = parts["reflected"]["drive_mass"].item()
        expected["backlash"] = parts["reflected"]["output_backlash"].sel(case="mean").item()
        expected["input_inertia"] = parts["reflected"]["reflected_inertia"].sel(end="input").item()
    elif "bodies" in parts:
        expected["drive_mass"] = float(parts["bodies"]["body_mass"].sum())
        expected["input_inertia"] = parts["bodies"]["reflected_inertia"].sel(end="input").item()
        expected["lost_motion"] = torsion["catalogue_lost_motion"].item()
    else:
        data = parts["inspection"]
        expected["drive_mass"] = float(data["disc_mass"].sum())
        expected["backlash"] = data["backlash_angle"].sel(case="mean").values[1]
        inertia = data["disc_inertia"].values
        expected["input_inertia"] = inertia[0] + inertia[1] * (23 / 61) ** 2
    for figure, value in expected.items():
        assert figures[figure] == pytest.approx(value, rel=1e-9, abs=1e-15), figure
    tenth = {"operation.torque": "6 N m"}
    at_tenth = run_case(case, analyses=["operation", "back_driving"], settings=tenth)[
        "default"
    ].parts
    for figure, part in (
        ("efficiency_tenth", "operation"),
        ("back_efficiency_tenth", "back_driving"),
    ):
        there = at_tenth[part]["mean_efficiency"].item()
        assert figures[figure] == pytest.approx(there, rel=1e-9), figure
    fitted = "Losses of the set end at -10 degC and 40 degC"
    assert (fitted in drive.remarks) == (name == "strain wave")


def test_room_for_gears_is_that_of_their_circles():
    """Ring of 84 teeth with its usual rim; a pair is as wide as both tips and the centre distance."""
    (drive,) = pp.bench([SETS["planetary"]]).drives
    root = 0.5 * (84 + 2 * 1.25) * 1e-3
    assert drive.figures["outer_diameter"] == pytest.approx(2.0 * 1.2 * root, rel=1e-9)
    assert drive.figures["gear_length"] == pytest.approx(12e-3)
    assert drive.family == "planetary"


def test_the_command_writes_a_page_a_table_and_records(tmp_path, capsys, monkeypatch):
    case = tmp_path / "set.toml"
    pp.Case(SETS["planetary"]).to_toml(case)
    line = ["pitchpoint", "bench", str(case), "-o", str(tmp_path / "out"), "--json"]
    monkeypatch.setattr(sys, "argv", line)
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert not ended.value.code
    (record,) = json.loads(capsys.readouterr().out)
    assert record["drive"] == "set"
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {"bench.html", "bench.csv", "bench.json"}


@pytest.mark.whole
def test_a_point_out_of_range_leaves_the_others_there():
    """At 125 % of the speed the case is refused: that point alone is none, and the refusal is a remark."""
    fast = pp.Case(SETS["pair"]).set({"operation.speed": "800000 rpm"})
    (drive,) = pp.bench([fast]).drives
    for name in ("efficiency", "back_efficiency"):
        assert np.isfinite(getattr(drive, name)).all()
        assert np.isfinite(getattr(drive, f"{name}_over_speed")).tolist() == [True] * 4 + [False]
        assert {f"{name}_quarter", f"{name}_tenth"} <= {*drive.figures}
    assert drive.efficiency_over_speed[3] == pytest.approx(drive.figures["efficiency"], rel=1e-9)
    (gap,) = (one for one in drive.remarks if "without an efficiency" in one)
    assert gap.startswith("without an efficiency at 125 % of the speed: ")
    assert 'operation.speed: "1000000 rpm" is out of range' in gap
