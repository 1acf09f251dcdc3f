"""Analyses as entries: what each lacks, pieces that other processes compute, one of a user's own."""

import json
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from sound import PAIR

from pitchpoint.analyses import studies
from pitchpoint.analyses.analysis import Analysis, Unasked
from pitchpoint.analyses.analysis_registry import ANALYSES, register
from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.cli import main
from pitchpoint.errors import InputError
from pitchpoint.results.store import dataset, load
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.jobs import job_of
from pitchpoint.runs.matrix import matrix, matrix_page
from pitchpoint.runs.run import (
    Outcome,
    open_outcomes,
    pieces_of,
    run_case,
    run_piece,
    uncomputed_manifests,
)
from pitchpoint.views.figures import PALETTE, Figure, Key, Panel, display, layout, legend_line
from pitchpoint.views.report import report_page
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.section import (
    Block,
    KeyFigure,
    Page,
    Paragraph,
    Printed,
    Section,
    SectionTable,
)
from pitchpoint.views.section_registry import SECTIONS, register_section

DOCS = Path(__file__).parents[2] / "docs"
SWEPT = f"""{PAIR}
[models]
friction = "constant"
[studies.hot]
sweep = {{ key = "operation.temperature", start = "40 degC", stop = "60 degC", count = 3 }}
"""
TARGET = """
[[targets]]
quantity = "teeth that pass"
where = "at the driver"
part = "passing"
variable = "teeth_passed"
kind = "predicted"
printed = 2300.0
tolerance = 1e-9
at = ["100 rad/s"]
"""

# ---- pieces in other processes

ELSEWHERE = """
import json, sys
from pathlib import Path
from pitchpoint.results.store import save
from pitchpoint.runs.run import run_piece
save(run_piece(sys.argv[1], json.load(sys.stdin)), Path(sys.argv[2]))
"""


@pytest.fixture
def swept(tmp_path: Path) -> Path:
    path = tmp_path / "pair.toml"
    path.write_text(SWEPT, "utf-8")
    return path


@pytest.fixture
def record(swept: Path) -> Path:
    """The record of the case, without a result yet."""
    path = swept.with_name("manifest.json")
    path.write_text(json.dumps(uncomputed_manifests(str(swept))[0]), "utf-8")
    return path


def test_a_piece_of_a_sweep_is_computed_elsewhere_from_its_description_alone(
    record: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(studies, "PIECE", 2)
    job = job_of(
        Variant(*reversed(find_case(str(record.with_name("pair.toml")))), "default"), "study_hot"
    )
    first, second = job.pieces
    assert second == {"analysis": "study_hot", "first": 2, "stop": 3}
    kept = record.with_name("piece.nc")
    done = subprocess.run(
        [sys.executable, "-c", ELSEWHERE, str(record), str(kept)],
        input=json.dumps(second),
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    there, here = load(kept), job.compute(second)
    xr.testing.assert_identical(there, here)
    whole = job.joined([job.compute(first), there])
    np.testing.assert_array_equal(whole["mean_loss"][:, 2:], there["mean_loss"])
    assert whole["axis"].values.tolist() == pytest.approx([313.15, 323.15, 333.15])


def test_descriptions_are_small_and_plain(swept: Path) -> None:
    every = pieces_of(str(swept))
    assert {one["analysis"] for one in every} >= {"cycle", "operation", "study_hot", "loss_map"}
    for one in every:
        text = json.dumps(one)
        assert len(text) < 1000
        assert json.loads(text) == one


def test_a_part_that_a_case_does_not_have_is_told(swept: Path) -> None:
    with pytest.raises(InputError, match=r"no part 'vibration': the case has no \[dynamics\]"):
        run_piece(str(swept), {"analysis": "vibration"})
    with pytest.raises(InputError, match="no part 'operatoin'; did you mean operation"):
        run_piece(str(swept), {"analysis": "operatoin"})


# ---- families and analyses


def test_the_matrix_says_yes_or_why_not_and_stands_in_the_docs() -> None:
    rows = {row["analysis"]: row for row in matrix()}
    assert list(rows) == list(ANALYSES)
    assert {rows["cycle"][family] for family in ("cylindrical", "strain_wave", "ball_on_disc")} == {
        "yes"
    }
    assert [name for name, row in rows.items() if row["cylindrical"] != "yes"] == [
        "load_limits",
        "bodies",
        "reflected",
        "train_period",
        "planet_sharing",
        "joint",
    ]
    assert "along their line of action" in rows["joint"]["cylindrical"]
    assert rows["joint"]["strain_wave"] == "yes"
    assert "no line of action" in rows["vibration"]["strain_wave"]
    assert rows["loss_map"]["ball_on_disc"] == "nothing is transmitted by a test rig"
    assert matrix_page() == (DOCS / "analyses.md").read_text("utf-8")


# ---- an analysis of a user's own


COMPUTED: list[float] = []


def passed(built, piece, progress) -> xr.Dataset:
    """Teeth that pass each second at one speed of the driver."""
    COMPUTED.append(piece["speed"])
    teeth = piece["speed"] * 23.0
    return dataset(
        {"teeth_passed": (("speed",), [teeth])}, {"speed": [piece["speed"]]}, warnings=[]
    )


def worn(built, last, progress) -> xr.Dataset | None:
    """Half the speed of the last piece, down to an eighth."""
    speed = float(last["speed"][0]) / 2.0
    return None if speed < 20.0 else passed(built, {"speed": speed}, progress)


def toy(**changes) -> Analysis:
    return Analysis(
        name="passing",
        title="teeth that pass",
        compute=passed,
        joined=lambda built, parts: xr.concat(parts, "speed", combine_attrs="override"),
        main=("teeth_passed",),
        variables={"teeth_passed": Variable(long_name="teeth that pass", symbol="n z", unit="1/s")},
        **changes,
    )


@pytest.fixture
def alone(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No analyses but those that a test registers."""
    monkeypatch.setattr(ANALYSES, "_entries", {})
    COMPUTED.clear()
    yield
    VARIABLES.pop("teeth_passed", None)


def test_an_analysis_of_ones_own_is_run_shown_compared_and_resumed(
    alone: None, tmp_path: Path
) -> None:
    register(toy(pieces=lambda built: [{"speed": speed} for speed in (100.0, 200.0)]))
    case = tmp_path / "pair.toml"
    case.write_text(PAIR + TARGET, "utf-8")

    class Stopped(running.Progress):
        def points(self, done: int) -> None:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_case(str(case), folder=tmp_path / "out", progress=Stopped())
    assert (tmp_path / "out" / "default" / "passing.0000.nc").is_file()
    outcome = run_case(str(case), folder=tmp_path / "out")["default"]
    assert COMPUTED == [100.0, 200.0]  # the first piece once, before the interruption
    assert outcome.parts["passing"]["teeth_passed"].values.tolist() == [2300.0, 4600.0]
    assert outcome.parts["passing"]["teeth_passed"].attrs["symbol"] == "n z"
    told = figures_by_law(outcome)
    assert told["passing"] == {"teeth_passed": [2300.0, 4600.0]}
    assert told["units"] == {"teeth_passed": "1/s"}
    assert [row["verdict"] for row in told["rows"]] == ["pass"]
    assert open_outcomes(tmp_path / "out")["default"].manifest["parts"] == ["passing"]


def test_a_march_goes_on_from_its_last_piece(alone: None, tmp_path: Path) -> None:
    register(toy(pieces=lambda built: [{"speed": 100.0}], onward=worn))
    case = tmp_path / "pair.toml"
    case.write_text(PAIR, "utf-8")

    class Stopped(running.Progress):
        def points(self, done: int) -> None:
            if done == 2:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_case(str(case), folder=tmp_path / "out", progress=Stopped())
    outcome = run_case(str(case), folder=tmp_path / "out")["default"]
    assert COMPUTED == [100.0, 50.0, 25.0]
    assert outcome.parts["passing"]["speed"].values.tolist() == [100.0, 50.0, 25.0]
    begun = run_piece(str(case), {"analysis": "passing", "speed": 100.0})
    follows = run_piece(str(case), {"analysis": "passing"}, last=begun)
    assert follows["teeth_passed"].values.tolist() == [1150.0]


def test_one_that_lacks_something_has_no_part(alone: None, tmp_path: Path) -> None:
    register(toy(lacks=lambda built: "the teeth stand still"))
    case = tmp_path / "pair.toml"
    case.write_text(PAIR, "utf-8")
    outcome = run_case(str(case))["default"]
    assert outcome.parts == {}
    assert figures_by_law(outcome)["passing"] == {}
    with pytest.raises(InputError, match="no part 'passing': the teeth stand still"):
        run_piece(str(case), {"analysis": "passing", "speed": 1.0})


def test_programs_are_given_back_between_parts_too(
    alone: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    register(toy(pieces=lambda built: [{"speed": 100.0}]))
    case, asked = tmp_path / "pair.toml", Counter[str]()
    case.write_text(PAIR, "utf-8")
    monkeypatch.setattr(running, "bound_programs", lambda: asked.update(["parts"]))
    for computed in (1, 1):  # what is read from disk takes no memory
        run_case(str(case), folder=tmp_path / "out")
        assert asked["parts"] == computed


# ---- a section of a user's own


def shown_passing() -> Section:
    """What a user writes beside an analysis: figure and table of the report, a fact, a table on screen."""

    def rows(outcome: Outcome) -> list[dict[str, str]]:
        data = outcome.parts["passing"]
        return [
            {
                head("speed"): screen_value("speed", float(speed)),
                head("teeth_passed"): f"{float(teeth):g}",
            }
            for speed, teeth in zip(data["speed"], data["teeth_passed"], strict=True)
        ]

    def blocks(page: Page) -> Iterator[Block]:
        for _, _, outcome in page.each("passing"):
            data, key = outcome.parts["passing"], Key("driver", PALETTE[0])
            yield Paragraph("Teeth that go by at the driver.")
            line = legend_line(key, display("speed", data["speed"]), data["teeth_passed"], "1/s")
            figure = Figure("passing_speed", "Teeth that pass", [line], layout("n", "n z"))
            yield Panel("", [figure])
            cells = rows(outcome)
            yield SectionTable([*cells[0]], [[*row.values()] for row in cells])

    return Section(
        name="passing",
        title="Teeth that pass",
        short="Passing",
        order=350.0,
        parts=("passing",),
        blocks=blocks,
        answer=lambda outcome: [KeyFigure(95.0, "Teeth", f"{len(rows(outcome))} speeds")],
        screen=lambda outcome: [Printed("Teeth that pass", rows(outcome))],
    )


def command(*words: str, monkeypatch: pytest.MonkeyPatch) -> object:
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *words])
    with pytest.raises(SystemExit) as stop:
        main()
    return stop.value.code


def test_an_analysis_and_a_section_of_ones_own_are_all_that_is_needed(
    alone: None,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(SECTIONS, "_entries", dict(SECTIONS.items()))
    register(toy(pieces=lambda built: [{"speed": speed} for speed in (100.0, 200.0)]))
    register_section(shown_passing())
    case, out = tmp_path / "pair.toml", tmp_path / "out"
    case.write_text(PAIR + TARGET, "utf-8")
    assert command("run", str(case), "-o", str(out), "--full", monkeypatch=monkeypatch) == 0
    screen = capsys.readouterr().out
    assert re.search(r"Teeth that pass\n.*teeth that pass \[1/s\]\n954\.9 +2300", screen)
    assert re.search(r"\nTeeth +2 speeds\n", screen)
    assert "predicted: 1 pass" in screen
    page = (out / "report.html").read_text("utf-8")
    assert '<a href="#passing">Passing</a>' in page
    assert '<section id="passing">\n<h2>Teeth that pass</h2>' in page
    assert '<div class="plot" id="passing_speed">' in page
    assert "<dt>Teeth</dt><dd><strong>2 speeds</strong></dd>" in page
    assert '<th scope="row">954.9</th><td class="n">2300</td>' in page
    assert page.index('id="inputs"') < page.index('id="passing"') < page.index('id="compared"')
    assert command("run", str(case), "-o", str(out), "--json", monkeypatch=monkeypatch) == 0
    told = json.loads(capsys.readouterr().out)["default"]
    assert told["passing"] == {"teeth_passed": [2300.0, 4600.0]}
    assert command("compare", str(case), monkeypatch=monkeypatch) == 0
    assert "teeth that pass" in capsys.readouterr().out


def test_a_section_that_lacks_something_says_so_once_at_the_end(
    alone: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(SECTIONS, "_entries", dict(SECTIONS.items()))
    case = tmp_path / "pair.toml"
    case.write_text(PAIR, "utf-8")
    register(toy(lacks=lambda built: "the teeth stand still"))
    register_section(shown_passing())
    page = report_page(run_case(str(case)))
    assert page.count("the teeth stand still") == 1
    assert "Not shown: Passing (the teeth stand still)." in page
    assert '<section id="passing">' not in page
    register(toy(lacks=lambda built: Unasked("nobody counts the teeth")))
    assert "Not shown" not in report_page(run_case(str(case)))
