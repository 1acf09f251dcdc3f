"""Results of several designs beside each other, and given to other programs."""

import json
import re
import sys
import tomllib
import webbrowser
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import sound
import xarray as xr
from scipy.io import loadmat

from pitchpoint import cli
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.exports.files import FORMATS, export
from pitchpoint.exports.result_tables import sheets
from pitchpoint.results.variable import dimensionless
from pitchpoint.runs.compared_designs import (
    MainFigure,
    as_json,
    designs,
    main_results,
    resolved_reference,
)
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Outcome, Progress, open_outcomes, run_case, run_variant
from pitchpoint.views import show
from pitchpoint.views.designs import (
    differing,
    input_tables,
    law_words,
    of_several,
    result_table,
)
from pitchpoint.views.designs_screen import COMPARED_LINES, designs_screen
from pitchpoint.views.report import report_page

PAIR = (
    f'title = "First of two"\n{sound.PAIR}'
    + """
[models]
friction = ["xu_2007", "frictionless"]
[loss_map]
count = 3
[variants.new]
title = "First of two, new"
[variants.worn.roughness]
ra = "0.8 um"
"""
)
BALL = """
[gears]
family = "ball_on_disc"
ball_radius = "9.525 mm"
track_radius = "40 mm"
slide_roll_ratio = 0.1
[lubricant]
name = "pao-vg-100"
[roughness]
ra = "0.01 um"
[operation]
force = "50 N"
speed = "240 rpm"
temperature = "40 degC"
[models]
friction = { name = "constant", coefficient = 0.04 }
"""
HARD = (
    PAIR.partition("[variants.new]")[0]
    + """
[materials]
gear_1 = "case-hardened-mq"
gear_2 = "case-hardened-mq"
"""
)
STAGES = HARD.replace("[gears]", "[[stages]]\n[stages.gears]").replace(
    "[lubricant]",
    """[[stages]]
[stages.gears]
teeth = [19, 70]
module = "3 mm"
face_width = "30 mm"
[lubricant]""",
)

Outcomes = dict[str, Outcome]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Results of a pair in two variants and of a test rig, computed once."""
    folder = tmp_path_factory.mktemp("designs")
    for name, text in (("pair", PAIR), ("ball", BALL)):
        (folder / f"{name}.toml").write_text(text)
        run_case(str(folder / f"{name}.toml"), folder=folder / "out" / name)
    return folder


@pytest.fixture(scope="module")
def compared(folder: Path) -> Outcomes:
    return designs([str(folder / "out" / "pair")])


@pytest.mark.whole
def test_what_a_reference_means(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    Path("a@b.toml").write_text(BALL)
    assert resolved_reference("a@b.toml").variant is None
    assert resolved_reference("out/pair@worn") == resolved_reference("out/pair").__class__(
        "out/pair", "worn"
    )
    assert resolved_reference("out/pair/worn") == resolved_reference("out/pair@worn")
    assert resolved_reference("out/pair").variant is None
    assert [*designs(["out/pair@worn", "out/ball"])] == ["pair@worn", "ball"]
    assert [*designs(["out/pair"])] == ["pair@new", "pair@worn"]
    for references, words in (
        (["out/pair", "out/pair@new"], '"out/pair@new" was named twice'),
        (["out/pair@wron"], "is not a variant of this case; did you mean worn?"),
        (["out/pair", "nothing"], "neither a shipped case nor a file"),
    ):
        with pytest.raises(InputError, match=words.replace("?", r"\?")):
            designs(references)


def test_cases_of_one_name_are_told_apart(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    copy = Path("other/ball")
    if not copy.exists():
        copy.parent.mkdir()
        copy.symlink_to(folder / "out" / "ball")
    assert [*designs(["out/ball", "other/ball"])] == ["out/ball", "other/ball"]


def test_inputs_that_differ(compared: Outcomes) -> None:
    given, following = input_tables(compared)
    assert given.head == ("table", "key", "pair@new", "pair@worn")
    assert given.rows == [("roughness", "ra", "0.4 µm", "0.8 µm")]
    assert not following.rows


def test_what_is_demanded_of_one_design_alone_stands_first(compared: Outcomes) -> None:
    """A factor that one design gives shifts its safeties; defaults of a bearing that it has say nothing."""
    first, second = compared.values()

    def also(outcome: Outcome, *rows: tuple[str, str, str]) -> Outcome:
        more = [
            {"table": table, "key": key, "value": 0.7, "status": status, "kind": "dimensionless"}
            | {"where": "", "note": ""}
            for table, key, status in rows
        ]
        manifest = {**outcome.manifest, "inputs": [*outcome.manifest["inputs"], *more]}
        return replace(outcome, manifest=manifest)

    rated = also(
        second,
        ("gears", "own", "given"),
        ("strength", "mean_stress_factor", "given"),
        ("losses", "b1.preload", "default"),
    )
    given, _ = input_tables({"first": first, "second": rated})
    names = [row[:2] for row in given.rows]
    assert names[0] == ("strength", "mean_stress_factor")
    assert ("losses", "b1.preload") not in names and ("gears", "own") in names
    shown, alone = of_several(given, 2)
    assert [row[:2] for row in shown.rows] == names[:2] and alone == 1


def test_differences_are_those_of_the_results(compared: Outcomes) -> None:
    assert law_words(compared).startswith("Friction in every design: Xu and Kahraman 2007")
    table = result_table(compared)
    rows = {row[0]: row[1:] for row in table.rows}
    data = [one.parts["operation"] for one in compared.values()]
    efficiency = [100.0 * float(one["mean_efficiency"][0, 0]) for one in data]
    told = rows["mean efficiency (xu_2007) [%]"]
    assert told[:2] == tuple(show.number_text(value) for value in efficiency)
    assert told[2] == f"−{abs(efficiency[1] - efficiency[0]):.2f} points"
    pressure = [float(one.parts["cycle"]["pressure"].max()) / 1e6 for one in compared.values()]
    figure = next(one for one in main_results(compared) if one.name == "pressure")
    assert [value / 1e6 for value in figure.values.values()] == pytest.approx(pressure)
    losses = [float(one["mean_loss"][0, 0]) for one in data]
    part = 100.0 * (losses[1] / losses[0] - 1.0)
    assert rows["mean power loss (xu_2007) [W]"][2].endswith(f"(+{part:.1f} %)")
    assert rows["efficiency is that of the"][:2] == ("teeth alone", "teeth alone")


def test_what_is_of_other_things_is_not_subtracted(compared: Outcomes) -> None:
    first, last = compared.values()
    operation = last.parts["operation"].copy()
    operation["mean_efficiency"] = operation["mean_efficiency"].assign_attrs(
        operation["mean_efficiency"].attrs, lacks="bearing of its drum"
    )
    parts = {**last.parts, "operation": operation}
    other = replace(last, parts=parts, manifest=last.manifest | {"members": ["drum", "gear 2"]})
    rows = {row[0]: row[1:] for row in result_table({"one": first, "other": other}).rows}
    bases = rows["efficiency is that of the"]
    assert bases[:2] == ("teeth alone", "teeth alone, without the bearing of its drum")
    for name in ("mean efficiency (xu_2007) [%]", "mean power loss (xu_2007) [W]"):
        assert rows[name][2] == "of other things"
    assert {told[2] for name, told in rows.items() if "contact ratio" in name} == {
        "of other things"
    }
    assert "of other things" not in rows["largest Hertz pressure (xu_2007) [MPa]"][2]


def lines(outcomes: Outcomes, width: int = 80) -> list[str]:
    """First screen of a comparison, whose bounds it keeps."""
    told = [line.text for line in designs_screen(outcomes, "Report: out/report.html", width)]
    assert len(told) <= COMPARED_LINES == 24
    assert max(map(len, told)) <= width
    return told


def test_the_first_screen_tells_what_differs_in_the_answer(compared: Outcomes) -> None:
    told = lines(compared)
    assert told[0] == "pair@worn against pair@new"
    (loss,) = (line for line in told if line.startswith("loss [W] "))
    losses = [float(one.parts["operation"]["mean_loss"][0, 0]) for one in compared.values()]
    assert loss.split()[2:4] == [show.number_text(value) for value in losses]
    assert loss.endswith(f"(+{100.0 * (losses[1] / losses[0] - 1.0):.1f} %)")
    assert not any(line.startswith("stress of flanks") for line in told)
    assert re.search(r"The same in all: stress of flanks [\d.]+ MPa; ", " ".join(told))
    assert "Friction in every design: Xu and Kahraman 2007, EHL regression." in told
    assert "Inputs that differ: roughness.ra 0.4 µm → 0.8 µm." in told
    assert told[-2].startswith("By --full: ") and told[-1] == "Report: out/report.html"


def test_the_first_screen_says_in_words_what_is_unlike(compared: Outcomes) -> None:
    first, last = compared.values()
    operation = last.parts["operation"].copy()
    operation["mean_efficiency"] = operation["mean_efficiency"].assign_attrs(covers="")
    told = lines(
        {"one": first, "other": replace(last, parts={**last.parts, "operation": operation})}
    )
    (efficiency,) = (line for line in told if line.startswith("efficiency [%]"))
    assert efficiency.endswith("of other things")
    assert "Efficiency is that of the: teeth alone (one); whole drive (other)." in told


def test_the_first_screen_of_many_designs_has_a_line_for_each(compared: Outcomes) -> None:
    first, second = compared.values()
    told = lines({f"design_{number}": (first, second)[number % 2] for number in range(9)})
    each = [line for line in told if re.match(r"design_\d ", line)]
    assert len(each) == 9
    assert len({line.partition(" ")[2] for line in each}) == 2
    crowd = lines({f"design_{number}": (first, second)[number % 2] for number in range(40)}, 60)
    assert any(re.fullmatch(r"\d+ more designs by --full\.", line) for line in crowd)


def test_films_count_only_where_pairs_touch(compared: Outcomes) -> None:
    figures = [one for one in main_results(compared) if one.name == "film_thickness"]
    for figure in figures:
        for design, value in figure.values.items():
            cycle = compared[design].parts["cycle"]
            law = [str(one) for one in cycle["law"].values].index(figure.law)
            films = cycle["film_thickness"].values[law][cycle["active"].values]
            assert value == np.min(films) > 0.0


def test_mass_and_inertia_of_a_drive_stand_beside_those_of_a_strain_wave_gear() -> None:
    """Which has them by its bodies: their sum, and the same inertias at both ends."""
    ends = {"end": ["input", "output"]}
    felt = {"reflected_inertia": ("end", [4e-5, 0.4])}
    mass = ("member", [0.15, 0.04, 0.18])
    named = {"member": ["wave generator", "flexspline", "circular spline"]}
    wave = xr.Dataset({**felt, "body_mass": mass}, {**ends, **named})
    train = xr.Dataset({**felt, "drive_mass": 0.5}, ends)
    each = {"wave": {"bodies": wave}, "train": {"reflected": train}}
    found = {
        (one.name, one.place): one.values
        for one in main_results(
            {name: Outcome({"laws": [], "inputs": []}, parts) for name, parts in each.items()}
        )
    }
    assert found["drive_mass", ""] == pytest.approx({"wave": 0.37, "train": 0.5})
    assert found["reflected_inertia", "output"] == {"wave": 0.4, "train": 0.4}
    assert found["body_mass", "flexspline"] == {"wave": 0.04}


def test_designs_of_other_families(folder: Path) -> None:
    outcomes = designs([str(folder / "out" / "pair@new"), str(folder / "out" / "ball")])
    rows = {row[0]: row[1:] for row in result_table(outcomes).rows}
    assert "share no friction law" in law_words(outcomes)
    assert rows["mean efficiency [%]"][1:] == ("–", "–")
    assert "–" not in rows["largest Hertz pressure [MPa]"]
    page = report_page(outcomes, designs=True)
    assert "<h1>pair@new · ball</h1>" in page
    assert page.index("Designs beside each other") < page.index("The answer")
    assert "Designs beside each other" not in report_page(outcomes)


def test_the_command(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "200")

    def told(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "compare", *arguments])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        return int(caught.value.code or 0), *capsys.readouterr()

    status, out, _ = told("out/pair@new", "out/pair@worn", "-o", "beside")
    assert status == 0
    assert "−" in out
    assert "Report: beside/report.html" in out
    assert "Designs beside each other" in Path("beside/report.html").read_text("utf-8")
    assert "ripple of the input torque" not in out
    _, whole, _ = told("out/pair@new", "out/pair@worn", "-o", "beside", "--full")
    assert "ripple of the input torque" in whole
    _, _, err = told("out/pair@new", "--full")
    assert "goes with several designs" in err
    _, out, _ = told("out/pair", "out/ball", "-o", "beside", "--json")
    found = json.loads(out)
    assert [*found["designs"]] == ["pair@new", "pair@worn", "ball"]
    assert found["designs"]["ball"]["operation"]
    row = next(one for one in found["inputs"] if one["key"] == "ra")
    assert row["unit"] == "m"
    assert [one[0] for one in row["values"].values()] == pytest.approx([4e-7, 8e-7, 1e-8])
    status, _, err = told("out/pair", "out/ball", "--variant", "new")
    assert status == 2
    assert "write case@variant" in err


# ---- strength and backlash of designs


def kept(folder: Path, text: str, *parts: str, **settings: object) -> str:
    """Folder of a result that has some parts only."""
    variant = Variant(tomllib.loads(text), f"{folder.name}.toml", "default", settings)
    work = [job for job in jobs(variant, {}) if job.name in parts]
    run_variant(variant, work, folder=folder / "default", studies={}, progress=Progress())
    record = {"case": f"{folder.name}.toml", "variants": ["default"]}
    (folder / "run.json").write_text(json.dumps(record))
    return str(folder)


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """A drive of two stages whose second one does not bear the load, and one with wider teeth there."""
    folder = tmp_path_factory.mktemp("drives")
    load = {"operation.torque": "1500 N m"}
    wide = {"stages.2.gears.face_width": "200 mm"}
    return [
        kept(folder / "narrow", STAGES, "strength", **load),
        kept(folder / "wide", STAGES, "strength", **load, **wide),
    ]


@pytest.mark.whole
def test_stages_have_stresses_and_the_safety_of_their_weaker_gear(drives: list[str]) -> None:
    outcomes = designs(drives)
    figures = {(one.name, one.place): one for one in main_results(outcomes)}
    for name, word in (
        ("contact_stress", "largest"),
        ("root_stress", "largest"),
        ("flank_safety", "least"),
        ("root_safety", "least"),
    ):
        for stage in (1, 2):
            told = figures[name, f"{word} of stage {stage}"].values
            for design, outcome in outcomes.items():
                both = outcome.parts["strength"][name].sel(stage=stage).values
                assert told[design] == (max(both) if word == "largest" else min(both))
    assert ("tangential_force", "stage 2") in figures
    weaker = figures["root_safety", "least of stage 2"]
    assert weaker.title.endswith(", least of stage 2")
    assert weaker.values["narrow"] < weaker.values["wide"]


@pytest.mark.whole
def test_a_stage_with_a_gear_of_unknown_strength_has_no_least_safety(drives: list[str]) -> None:
    outcome = designs(drives[:1])["narrow"]
    data = outcome.parts["strength"].copy(deep=True)
    data["flank_safety"][1, 0] = np.nan
    told = main_results({"one": Outcome(outcome.manifest, {"strength": data})})
    safeties = [one.place for one in told if one.name == "flank_safety"]
    assert safeties == ["least of stage 1"]


@pytest.mark.whole
def test_what_cannot_be_stands_before_every_number(
    drives: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "300")
    output = str(Path(drives[0]).parent / "beside")
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "compare", *drives, "--full", "-o", output])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert not caught.value.code
    outcomes = designs(drives)
    failing = {name: one.manifest["implausible"] for name, one in outcomes.items()}
    assert any("stage 2: the flanks of gear 1 have" in text for text in failing["narrow"])
    assert not any("stage 2" in text for text in failing["wide"])
    expected = [f"{name}: {text}" for name, texts in failing.items() for text in texts]
    assert capsys.readouterr().out.splitlines()[: len(expected)] == expected
    found = as_json(outcomes)
    assert found["implausible"] == failing
    assert next(iter(found)) == "implausible"


def test_backlash_by_tolerances_beside_the_nominal_one(tmp_path: Path) -> None:
    allowed = {"gears.inspection.thickness_field": "26cd"}
    outcomes = designs(
        [
            kept(tmp_path / "nominal", HARD, "inspection"),
            kept(tmp_path / "thinned", HARD, "inspection", **allowed),
        ]
    )
    rows = {row[0]: row[1:] for row in result_table(outcomes).rows}
    turns = {words: row for words, row in rows.items() if "in its backlash" in words}
    assert len(turns) == 6  # the nominal one is left by rounding
    angles = outcomes["thinned"].parts["inspection"]["backlash_angle"].sel(gear="gear 2")
    for case in ("least", "mean", "largest"):
        (told,) = [row for words, row in turns.items() if f"gear 2, {case}" in words]
        minutes = float(np.degrees(angles.sel(case=case))) * 60.0
        assert told == ("–", f"{minutes:.4g}", "–")
        assert minutes > 1.0


def test_what_follows_is_told_where_there_is_something(compared: Outcomes, folder: Path) -> None:
    assert [*differing(compared)] == ["Inputs that differ"]
    others = designs([str(folder / "out" / "pair@new"), str(folder / "out" / "ball")])
    given, following = input_tables(others)
    assert [*differing(others).values()] == [given, following]


@pytest.mark.parametrize(
    ("change", "told"), [(9.394e-8, "0"), (0.0, "0"), (2e-3, "+0.002 (+0.2 %)")]
)
def test_what_solvers_leave_is_no_difference(
    compared: Outcomes, monkeypatch: pytest.MonkeyPatch, change: float, told: str
) -> None:
    first, second = compared
    values = {first: 1.0, second: 1.0 + change}
    figure = MainFigure("operation", "contact_ratio", "", "", dimensionless("ratio", ""), values)
    monkeypatch.setattr("pitchpoint.views.designs.main_results", lambda _: [figure])
    assert result_table(compared).rows[-1][-1] == told


def test_open(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    report = folder / "a report" / "report.html"
    report.parent.mkdir(exist_ok=True)
    report.touch()
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", lambda url: bool(opened.append(url)) or len(opened) > 1)
    for arguments, told in (([], True), ([], False), (["--print"], True)):
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "open", str(report.parent), *arguments])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        assert caught.value.code == 0
        assert (str(report) in capsys.readouterr().out) is told  # no browser, one, not asked for
    assert opened == [report.as_uri()] * 2
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "open", str(folder)])
    with pytest.raises(SystemExit):
        cli.main()
    assert "holds no report.html" in capsys.readouterr().err


# ---- the same results for other programs


@pytest.fixture(scope="module")
def written(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("export")
    export(open_outcomes(folder / "out" / "pair"), out, [*FORMATS])
    return out / "new"


def test_columns_have_units_and_contacts_alone_have_values(
    written: Path, compared: Outcomes
) -> None:
    cycle = compared["pair@new"].parts["cycle"]
    frame = pd.read_csv(written / "cycle_law_node_pair_slice.csv")
    assert [*frame.columns[:4]] == ["law", "node", "pair", "slice"]
    touching = np.broadcast_to(cycle["active"].values, cycle["pressure"].shape).ravel()
    pressure = frame["pressure [MPa]"].to_numpy()
    assert np.array_equal(np.isfinite(pressure), touching)
    expected = cycle["pressure"].values.ravel()[touching]
    assert pressure[touching] * 1e6 == pytest.approx(expected, rel=1e-12)
    assert not touching.all()
    assert "efficiency [%]" in pd.read_csv(written / "cycle_law_node.csv")


def test_every_format_has_the_same_numbers(written: Path, compared: Outcomes) -> None:
    loss = compared["pair@new"].parts["operation"]["mean_loss"].values
    found = json.loads((written / "result.json").read_text("utf-8"))
    told = found["parts"]["operation"]["mean_loss"]
    assert (told["unit"], told["dims"]) == ("W", ["law", "point"])
    assert np.array_equal(told["values"], loss)
    matlab = loadmat(written / "result.mat", simplify_cells=True)["operation"]
    assert np.array_equal(matlab["mean_loss"], loss[:, 0])
    assert [*matlab["law"]] == ["xu_2007", "frictionless"]
    assert matlab["units"]["mean_loss"] == "W"
    sheet = pd.read_excel(written / "result.xlsx", sheet_name="operation")
    assert sheet["mean_loss [W]"].to_numpy() == pytest.approx(loss[:, 0], rel=1e-14)
    inputs = pd.read_excel(written / "result.xlsx", sheet_name="inputs")
    assert "2 mm" in [*inputs[inputs["key"] == "module"]["value"]]


def test_the_readme_says_what_every_column_is(written: Path) -> None:
    text = (written / "README.txt").read_text("utf-8")
    for path in written.glob("*.csv"):
        assert f"\n{path.stem}: " in text
        for head in pd.read_csv(path).columns:
            assert f"\n  {head}: " in text, path.name
    assert "  pressure [MPa]: largest Hertz pressure" in text


def test_si_and_what_cannot_be_written(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcome = open_outcomes(folder / "out" / "ball")["default"]
    operation = next(one for one in sheets(outcome, si=True) if one.name == "operation")
    assert "pressure [Pa]" in operation.frame
    with pytest.raises(InputError, match="give one or several of --csv, --mat, --json, --xlsx"):
        export({"default": outcome}, tmp_path, [])
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(InputError, match=r"install pitchpoint\[xlsx\]"):
        export({"default": outcome}, tmp_path, ["xlsx"])
