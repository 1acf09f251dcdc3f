"""Absurd but well-formed cases: the first line says what is wrong. Sound ones have no such line."""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from sound import PAIR, quick_first

from pitchpoint import cli
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.runs import jobs
from pitchpoint.views.show import number_text

ISO = "iso_tr_14179_2"
MODELS = '[models]\nfriction = ["iso_tr_14179_2", "xu_2007"]\n'

ABSURD = [
    (
        ["operation.torque=50 kN m"],
        "the Hertz pressure reaches 18.3 GPa, the material bears 2.5 GPa",
    ),
    (["gears.face_width=0.1 mm"], "the Hertz pressure reaches"),
    (["operation.speed=0.01 rpm"], "nm, less than an atom: flanks touch"),
    (["operation.speed=900000 rpm"], "pitch circles at"),
    (["gears.module=100 mm", "operation.speed=3000 rpm"], "pitch circles at"),
    (["materials.gear_1=PA66", "operation.temperature=110 degC"], "PA66 does not bear more than"),
    (["materials.gear_1=POM-H", "operation.torque=900 N m"], "% of the modulus: strains are large"),
    (["materials.gear_2={young='1 MPa', poisson=0.4}"], "% of the modulus: strains are large"),
    (
        ["materials.gear_1=PEEK", "models.friction=[{name='constant', coefficient=0.5}]"],
        "mean friction 0.5; allowed about 0.4",
    ),
    (
        ["materials.gear_1={young='206 GPa', poisson=0.3, hardness='20 HV'}"],
        "reaches 582 MPa, by hardness borne 250 MPa",
    ),
    (
        ["models.friction=[{name='constant', coefficient=0.6}]"],
        "mean friction 0.6; allowed about 0.2",
    ),
    (["models.rolling_resistance=wu_cheng_1991"], "rolling is counted twice"),
    (["roughness.ra=100 um"], "xu_2007' is far out of its range"),
    (
        ["roughness.ra=100 um", "models.friction=constant"],
        "Ra is 100 µm, rough flanks have 12.5 µm",
    ),
    (
        [
            "gears.module=0.01 mm",
            "gears.face_width=0.1 mm",
            "operation.torque=1e-5 N m",
            "models.friction=constant",
        ],
        "is over 1 % of the radius: no roughness",
    ),
    (
        [
            "lubricant={base='mineral', viscosity_40='100000 mm2/s', viscosity_100='50000 mm2/s'}",
            "models.friction=constant",
        ],
        "2.3 % of the radius: not thin",
    ),
    (["operation.speed=0.4 rpm", "operation.torque=500 N m"], "no friction law holds"),
    (["operation.temperature=300 degC"], "error"),
    (["gears.teeth=[2, 61]"], "error"),
    (["gears.profile_shift=[2.5, 2.5]"], "error"),
]

SOUND = [
    [],
    ["operation.torque=1 N m"],
    ["operation.torque=300 N m"],
    ["operation.speed=100 rpm"],
    ["operation.speed=10000 rpm"],
    ["gears.module=1 mm", "operation.torque=5 N m"],
    ["gears.module=20 mm", "operation.torque=20 kN m", "gears.face_width=200 mm"],
    ["gears.profile_shift=[0.4, -0.2]"],
    ["roughness.ra=0.1 um"],
    ["roughness.ra=0.8 um"],
    ["lubricant.name=mineral-vg-220"],
    ["operation.temperature=20 degC"],
    ["models.friction=[{name='constant', coefficient=0.12}]"],
    ["gears.teeth=[25, 70]"],
    ["gears.teeth=[30, 90]"],
    ["materials.gear_2=POM-H", "operation.torque=5 N m", "operation.speed=200 rpm"],
    ["materials.gear_1={young='206 GPa', poisson=0.3, hardness='700 HV'}"],
    ["models.rolling_resistance=wu_cheng_1991", "models.friction=constant"],
    ["operation.driver=gear 2"],
    ["gears.face_width=60 mm", "operation.torque=150 N m"],
]


@pytest.fixture
def printed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., str]:
    """What a run prints, of the parts on which checks look; what it complains of where it prints nothing."""
    (case := tmp_path / "pair.toml").write_text(PAIR + MODELS, "utf-8")
    few = {name: ANALYSES[name] for name in ("cycle", "operation", "laws")}
    monkeypatch.setattr(jobs, "ANALYSES", few)
    monkeypatch.setenv("COLUMNS", "200")

    def run(settings: list[str], *more: str, report: bool = False) -> str:
        if not report:
            monkeypatch.setattr(cli, "_write_report", lambda outcomes, folder: None)
        given = [word for one in settings for word in ("--set", one)]
        words = ["pitchpoint", "run", str(case), "-o", str(tmp_path / "out"), *more, *given]
        monkeypatch.setattr(sys, "argv", words)
        with pytest.raises(SystemExit):
            cli.main()
        out, err = capsys.readouterr()
        return out or err.splitlines()[-1]

    return run


@pytest.mark.parametrize(("settings", "words"), quick_first(ABSURD, 5))
def test_an_absurd_case_says_so_first(
    printed: Callable[..., str], settings: list[str], words: str
) -> None:
    line = printed(settings).splitlines()[0]
    assert line.startswith(("Fails: ", "error: "))
    assert words in line


@pytest.mark.parametrize("settings", quick_first(SOUND, 3))
def test_a_sound_case_has_no_such_line(printed: Callable[..., str], settings: list[str]) -> None:
    assert printed(settings).splitlines()[0] == "pair.toml (default)"


def test_what_cannot_be_stands_above_every_number(
    printed: Callable[..., str], tmp_path: Path
) -> None:
    figures = json.loads(printed(["operation.torque=50 kN m"], "--json", report=True))["default"]
    assert next(iter(figures)) == "implausible"
    (told,) = figures["implausible"]
    assert told.startswith("Fails: the Hertz pressure reaches 18.3 GPa")
    assert told not in figures["warnings"]
    page = (tmp_path / "out" / "report.html").read_text("utf-8").replace("\u00a0", " ")
    on_paper, on_screen = page.split("<header>")
    assert 0 < on_screen.index(told) < on_screen.index('id="answer"')
    assert on_paper.count(told) == on_screen.count(told) == 1


def test_a_law_out_of_its_range_gives_no_headline(
    printed: Callable[..., str], tmp_path: Path
) -> None:
    lines = printed([], "--full", report=True).splitlines()
    apart = lines.index("Out of their range here: extrapolations")
    assert next(line for line in lines if line.startswith(("iso_tr", "xu_"))).startswith(ISO)
    assert lines[apart + 2].startswith("xu_2007")
    figures = json.loads(printed(["models.friction=xu_2007"], "--json", report=True))["default"]
    assert [*figures["headline"]] == [ISO]
    assert [one["law"] for one in figures["friction_laws_out_of_range"]] == ["xu_2007"]
    assert [*figures["operation"]] == ["xu_2007"]
    page = (tmp_path / "out" / "report.html").read_text("utf-8")
    big = page.index(
        f'<p class="big">{number_text(100 * figures["headline"][ISO]["mean_efficiency"])}'
    )
    assert big < page.index("Out of its range here: an extrapolation.")
