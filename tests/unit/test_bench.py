"""A bench of drives that are made up: its screen, its files, what is said of figures that are not there."""

import csv
import json

import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint.errors import InputError
from pitchpoint.runs.bench import BENCHED, LOADS, SPEEDS, Bench, BenchedDrive, bench
from pitchpoint.views.bench import bench_page, bench_screen, write_bench

FIGURES = {
    "ratio": 59.1197,
    "drive_mass": 0.49754,
    "outer_diameter": 0.1185,
    "gear_length": 8e-3,
    "output_torque": 60.0,
    "input_speed": 185.73,
    "efficiency": 0.98995,
    "efficiency_quarter": 0.99238,
    "efficiency_tenth": 0.99365,
    "torsional_stiffness": 600801.0,
    "backlash": 2e-16,
    "input_inertia": 9.55e-7,
}
LOCKED = "friction holds the drive"
NO_LOSSES = "the case has no [losses] beside its teeth"


def made(name, **figures):
    every = FIGURES | figures
    lacks = {
        figure: LOCKED if figure.startswith("back_eff") else NO_LOSSES
        for figure in BENCHED
        if figure not in every
    }
    loads, speeds = np.full(len(LOADS), 0.99), np.full(len(SPEEDS), 0.98)
    return BenchedDrive(
        name,
        "A drive",
        "planetary + planetary",
        "constant",
        "teeth alone",
        every,
        lacks,
        ("its backlash is nominal: no allowance is given",),
        loads,
        loads * np.nan,
        speeds,
        speeds,
    )


TWO = Bench((made("sets"), made("wave", drive_mass=0.7516, lost_motion=9.5e-5)))


def test_the_first_screen_has_a_row_for_each_drive_and_a_reason_for_each_dash():
    lines = [line.text for line in bench_screen(TWO, 80, "page.html")]
    assert max(map(len, lines)) <= 80
    whole = " ".join(" ".join(lines).split())
    rows = [line.split() for line in lines if line.startswith("sets ")]
    assert rows[0] == [
        "sets",
        "59.12",
        "0.4975",
        "118.5",
        "99",
        "99.36",
        "600.8",
        "0",
        "0.00955",
        "-",
    ]
    assert "sets without starting" not in whole
    assert f"Each drive without η back: {LOCKED}." in whole
    assert "sets without no-load torque, starting torque, back-driving torque, lost motion" in whole
    assert "Each drive: its backlash is nominal" in whole


@pytest.mark.parametrize("full", [True, False])
def test_many_drives_have_a_row_each_and_further_columns_by_full(full):
    many = Bench(tuple(made(f"set_{number:02d}") for number in range(30)))
    lines = [line.text for line in bench_screen(many, 80, "page.html", full=full)]
    assert sum(line.startswith("set_29 ") for line in lines) == 1
    heads = "".join(lines[1:5])
    assert ("length" in heads) == full


def test_files_have_all_figures_or_why_they_are_not_there(tmp_path):
    assert write_bench(TWO, tmp_path) == tmp_path / "bench.html"
    with (tmp_path / "bench.csv").open(encoding="utf-8") as file:
        first, second = csv.DictReader(file)
    assert float(first["drive_mass [kg]"]) == FIGURES["drive_mass"]
    assert first["lost_motion [rad]"] == f"- ({NO_LOSSES})"
    assert float(second["lost_motion [rad]"]) == 9.5e-5
    records = json.loads((tmp_path / "bench.json").read_text("utf-8"))
    assert records[0]["lacks"]["back_efficiency"] == LOCKED
    assert records[0]["back_efficiency"] == [None] * len(LOADS)
    assert TWO.table["drive_mass"].sel(drive="wave").item() == 0.7516
    assert np.isnan(TWO.table["lost_motion"].sel(drive="sets").item())
    assert TWO.table["efficiency_over_load"].dims == ("drive", "load")


def test_the_page_has_the_table_and_no_name_twice():
    page = bench_page(TWO)
    for name in ("figures", "plotly", "table", "axes", "lacking"):
        assert page.count(f'id="{name}"') == 1
    for name in ("efficiency", "efficiency_over_speed", "loss", "torsional_stiffness"):
        assert f'id="bench_{name}"' in page
    assert 'id="bench_back_efficiency"' not in page
    assert "No drive has an efficiency here." in page


PAIR = {
    "gears": {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"},
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "0 N m", "speed": "1500 rpm", "temperature": "60 degC"},
}


@pytest.mark.parametrize(
    ("cases", "words"),
    [
        ([], "no drive was named"),
        (["planetary.toml.txt"], "planetary.toml.txt"),
        ([PAIR], "carries nothing at its operating point"),
        (PAIR, "carries nothing at its operating point"),
        (pp.Case(PAIR), "carries nothing at its operating point"),
        (5, "5 was given; a bench takes a case or a list of cases"),
        (None, "None was given; a bench takes a case or a list of cases"),
        ([3], "3 was given; a case is a file"),
        (["tian2024", "tian2024"], '"tian2024" was named twice'),
        ([PAIR, PAIR], '"case" was named twice'),
    ],
)
def test_what_is_no_drive_is_refused_in_a_sentence(cases, words):
    with pytest.raises(InputError) as caught:
        bench(cases)
    assert words in str(caught.value)


def test_names_are_one_for_each_case():
    with pytest.raises(InputError, match="names: 1 were given for 2 cases"):
        bench([PAIR, PAIR], names=["first"])
    for names in (5, "a", [3], [""]):
        with pytest.raises(InputError, match=r"names: .* was given where a list of names"):
            bench([PAIR], names=names)
    with pytest.raises(InputError, match='names: "pair" was named twice'):
        bench([PAIR, PAIR], names=["pair", "pair"])
