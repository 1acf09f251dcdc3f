"""All that is wrong with a case file is told at once, each thing in one sentence."""

import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from sound import PAIR

from pitchpoint import cli
from pitchpoint.errors import CollectedInputError, InputError
from pitchpoint.runs import run
from pitchpoint.runs.check import check_case
from pitchpoint.runs.run import STRENGTH as RATED
from pitchpoint.runs.run import load_case

Run = Callable[..., tuple[int, str, list[str]]]


@pytest.fixture
def told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Run:
    """Run a command on a case file; gives status, standard output and lines on standard error."""
    monkeypatch.chdir(tmp_path)

    def run(text: str, *arguments: str, command: str = "check") -> tuple[int, str, list[str]]:
        Path("bad.toml").write_text(text)
        monkeypatch.setattr(sys, "argv", ["pitchpoint", command, "bad.toml", *arguments])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        out, err = capsys.readouterr()
        return int(caught.value.code or 0), out, err.splitlines()

    return run


LUBRICANT = 'base = "mineral"\nviscosity_40 = "20 mm2/s"\nviscosity_100 = "220 mm2/s"'
STRENGTH = '[materials]\ngear_1 = "PA66"\n[strength]\nsigma_hlim = "1500 MPa"\n'
WRONG = (
    PAIR.replace('"2 mm"', '"2 mmm"')
    .replace('torque = "50 N m"\n', "")
    .replace('"75W90-A"', '"75W90-X"')
    .replace("[roughness]", "[rougness]")
    + '[models]\nfriction = ["xu_2007", "nobody"]\n[film]\nsolver = "lines"\n'
    + '[materials]\ngear_1 = { young = "206 GPa", poisson = 3 }\ngear_2 = "stel"\n'
)
KEYS = [
    "rougness",  # the clearest one first; that roughness is missing follows from it
    "gears.module",
    "materials.gear_1.poisson",
    "materials.gear_2",
    "lubricant.name",
    "models.friction.1",
    "film.solver",
]


@pytest.mark.parametrize("command", ["check", "show", "run"])
def test_every_error_has_its_sentence(told: Run, command: str) -> None:
    status, out, err = told(WRONG, command=command)
    assert (status, out) == (2, "")
    assert [line.partition("bad.toml: ")[2].partition(":")[0] for line in err] == KEYS
    assert err[0] == "error: bad.toml: rougness: is not a known table; did you mean roughness?"
    assert all(line.startswith("error: ") for line in err)


def test_a_misspelt_family_says_nothing_of_its_keys(told: Run) -> None:
    text = PAIR.replace("[gears]", '[gears]\nfamily = "strain_wav"\ntooth = { set = "liu" }')
    _, _, err = told(text.replace('"1500 rpm"', '"1500"'))
    assert [line.split(": ")[2] for line in err] == ["gears.family", "operation.speed"]


def test_every_variant_is_checked_and_each_error_told_once(told: Run) -> None:
    text = PAIR.replace('"60 degC"', '"60 degK"')
    text += '[variants.a.operation]\nspeed = 3\n[variants.b.gears]\nmodule = "0 mm"\n'
    status, _, err = told(text)
    assert status == 2
    assert [line.split(": ")[2] for line in err] == [
        "operation.speed",
        "operation.temperature",
        "gears.module",
    ]
    _, _, err = told(text, "--variant", "b", "--set", "gears.module=2 mm")
    assert [line.split(": ")[2] for line in err] == ["operation.temperature"]


BY_THEMSELVES = (
    PAIR.replace(
        "[lubricant]", "addendum = [1.0, 3.0]\ndedendum = [0.2, 1.25]\n[lubricant]"
    ).replace('name = "75W90-A"', LUBRICANT)
    + STRENGTH
)


def test_what_is_wrong_by_itself_is_told_together(told: Run) -> None:
    """Both gears, the oil, and the strength, which no schema knows; nothing that follows from them."""
    status, _, err = told(BY_THEMSELVES)
    assert status == 2
    assert [line.split(": ")[2] for line in err] == [
        "gears.dedendum",
        "gears.addendum",
        "lubricant.viscosity_40",
        "strength.treatment",
    ]
    assert "dedendum of gear 1" in err[0]
    assert "tip circle of gear 2" in err[1]


def test_gears_and_oil_are_looked_at_where_other_tables_are_wrong(told: Run) -> None:
    _, _, err = told(BY_THEMSELVES.replace('"1500 rpm"', '"1500"').replace("0.4 um", "0.4 K"))
    assert [line.split(": ")[2] for line in err] == [
        "roughness.ra",
        "operation.speed",
        "gears.dedendum",
        "gears.addendum",
        "lubricant.viscosity_40",
    ]


def test_one_cause_at_both_gears_is_told_once(told: Run) -> None:
    for text in (
        PAIR.replace("[lubricant]", "dedendum = 0.2\n[lubricant]"),
        PAIR.replace('"60 degC"', '"250 degC"').replace(
            'name = "75W90-A"', f'{LUBRICANT}\ntemperature_max = "300 degC"'.replace("220", "9")
        )
        + '[materials]\ngear_1 = "POM-H"\ngear_2 = "POM-H"\n',
    ):
        _, _, err = told(text)
        assert len(err) == 1


def test_whole_case_checks_are_told_together(told: Run) -> None:
    text = PAIR + 'driver = "gear 3"\n'
    for name, body in (("a", "gear 4"), ("b", "wall")):
        text += f'[losses.{name}]\nbetween = ["gear 1", "{body}"]\nseal_torque = "1 N m"\n'
    _, _, err = told(text)
    assert [line.split(": ")[2] for line in err] == [
        "losses.a.between",
        "losses.b.between",
        "operation.driver",
    ]


def test_every_study_and_stage_is_looked_at(told: Run) -> None:
    text = PAIR + "".join(
        f'[studies.{name}]\nsweep = {{ key = "{key}", start = "1 N m", stop = "2 N m", count = 2 }}\n'
        for name, key in (
            ("a", "operation.torqe"),
            ("b", "operation.speed"),
            ("c", "operation.torque"),
        )
    )
    _, _, err = told(text)
    assert [line.split(": ")[2].split(".")[1] for line in err] == ["a", "b"]
    gears, rest = PAIR.strip().removeprefix("[gears]\n").split("[lubricant]")
    stage = f"[[stages]]\n[stages.gears]\n{gears}dedendum = 0.2\n"
    _, _, err = told(f"{stage}{stage}[lubricant]{rest}")
    assert [line.split(": ")[2] for line in err] == [
        "stages.1.gears.dedendum",
        "stages.2.gears.dedendum",
    ]


def test_a_sound_case_is_ok_with_what_warns(told: Run) -> None:
    assert told(PAIR) == (0, "ok\n", [])
    status, out, _ = told(PAIR.replace("[23, 61]", "[12, 120]"))
    assert status == 0
    assert out.startswith("ok\nwarning: The undercut of gear 1 loses")


ABSURD = PAIR.replace('torque = "50 N m"', 'torque = "60 kN m"')
WHEEL = '[materials]\ngear_2 = "POM-H"\n'


def test_teeth_that_cannot_be_are_not_ok(told: Run) -> None:
    """60 kN m on teeth of module 2 mm, and a wheel of plastic that its stress breaks within a life."""
    status, out, err = told(ABSURD)
    assert (status, err) == (0, [])
    told_of = " ".join(out.split())
    assert re.match(
        r"Fails: the root stress of gear \d reaches [\d.]+ GPa; the strongest teeth of steel",
        told_of,
    )
    plastic = PAIR + WHEEL
    assert told(plastic.replace('torque = "50 N m"', 'torque = "5 N m"'))[1].startswith("ok\n")
    _, out, _ = told(plastic)
    roots = re.search(r"Fails: the roots of gear 2 have .*", " ".join(out.split()))
    assert roots and "they break within 1e+08 load cycles" in roots[0]


def test_from_python_they_are_one_error(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(WRONG)
    with pytest.raises(InputError, match="rougness") as caught:
        load_case(str(path))
    assert isinstance(caught.value, CollectedInputError)
    assert [error.key for error in caught.value.errors] == KEYS
    assert str(caught.value).count("\n") == len(KEYS) - 1
    assert caught.value.at(file="other").errors[1].file == "other"


def test_names_are_found_however_they_are_spelled(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    text = PAIR.replace('"75W90-A"', '"PAO VG 150"')
    path.write_text(f'{text}[materials]\ngear_1 = "PA 66"\n[models]\nfriction = "Xu-2007"\n')
    case = load_case(str(path)).case
    assert case.lubricant.name == "pao-vg-150"
    assert case.materials.gear_1 == "PA66"
    assert [choice.name for choice in case.models.friction] == ["xu_2007"]
    path.write_text(f'{PAIR}[models]\nfriction = ["xu_2007", "XU 2007"]\n')
    with pytest.raises(InputError, match="given twice"):
        load_case(str(path))


VARIANTS = PAIR + '[variants.good]\n[variants.bad]\ngears = { module = "2 mmm" }\n'
VARIANTS += '[variants.strong]\noperation = { torque = "60 kN m" }\n'


def test_a_variant_that_is_wrong_has_its_name(told: Run) -> None:
    status, _, err = told(VARIANTS)
    assert (status, len(err)) == (2, 1)
    assert err[0].startswith('error: bad.toml@bad: gears.module: "2 mmm" is not a length')


def test_what_fails_of_a_variant_has_its_name(told: Run) -> None:
    status, out, _ = told(VARIANTS.replace("2 mmm", "2.5 mm"))
    assert status == 0 and "Fails: strong: the root stress of gear" in " ".join(out.split())
    assert "bad:" not in out and "good:" not in out


def test_a_variant_is_built_once(told: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    rated = []

    def compute(*given: Any) -> Any:
        rated.append(given)
        return RATED.compute(*given)

    monkeypatch.setattr(run, "STRENGTH", replace(RATED, compute=compute))
    assert told(VARIANTS.replace("2 mmm", "2.5 mm"))[0] == 0
    assert len(rated) == 3


@pytest.mark.parametrize(
    ("case", "sentence"),
    [
        ("", "no case was given; name a file or one of atanasiu2011"),
        ("out/report.html", "out/report.html: is a page of a result, no case; give "),
        ("out/default", "out/default: is a folder of a result, no case; give "),
        ("out/default/cycle.nc", "cycle.nc: is a dataset of a result, no case; give "),
        ("other", "other: is a folder, no case file; there are pair.toml in it"),
        ("none.nc", "none.nc: there is no such case file"),
    ],
)
def test_what_belongs_to_a_result_is_no_case(told: Run, case: str, sentence: str) -> None:
    for name in ("out/run.json", "out/report.html", "out/default/cycle.nc", "other/pair.toml"):
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).touch()
    with pytest.raises(InputError) as caught:
        check_case(case)
    assert sentence in str(caught.value)


def test_a_study_none_of_whose_designs_can_be_built_is_not_ok(told: Run) -> None:
    drawn = '[study]\nhow = "sobol"\nn = 64\nover = { "gears.misalignment" = ["5 um", "9 um"] }\n'
    status, _, lines = told(f'{PAIR}[models]\nload_sharing = "equal"\n{drawn}')
    assert status == 2 and len(lines) == 1
    assert lines[0].startswith(
        "error: bad.toml: study: none of 16 designs that were tried can be computed; the first one: "
        "models.load_sharing: 'equal' holds where"
    )
    assert told(f"{PAIR}{drawn}")[0] == 0


def test_the_help_of_a_study_names_its_table(told: Run) -> None:
    assert "in the table [study] of the case" in told("", "--help", command="study")[1]
