"""Every way in which a command line can be wrong gets one clear sentence."""

import os
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from called import written
from sound import PAIR

from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.runs.jobs import jobs

# ---- command lines


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--set", "gears.modul=2 mm"], ["bad.toml: gears.modul: ", "did you mean module?"]),
        (["--set", "geers.module=2 mm"], ["bad.toml: geers: ", "did you mean gears?"]),
        (["--set", "gears.module=2"], ["gears.module: ", '"2" has no unit', "100 mm"]),
        (["--set", "gears.module=-2 mm"], ["gears.module: ", '"-2 mm"', "100 mm"]),
        (["--set", "gears.module.a=2 mm"], ["gears.module.a: ", '"module" is a value']),
        (["--set", "gears.teeth.3=20"], ["gears.teeth.3: ", "no gear 3; use 1 or 2"]),
        (
            ["--set", "materials.gear_2=POM-H", "--set", "operation.temperature=110 degC"],
            [
                "materials.gear_2: the modulus of POM-H is known from -40 degC to 100 degC",
                "110 degC",
            ],
        ),
        (
            ["--set", "gears.teeth.1=1"],
            ["gears.teeth: ", "gear 1 was given 1 teeth", "2 or more"],
        ),
        (["--set", "gears=3"], ["gears: ", "3 was given where a table belongs"]),
        (["--set", "operation.torque=[1, 2]"], ["operation.torque: ", "the list [1, 2]"]),
        (["--set", f"operation.torque={'9' * 5000}"], ["operation.torque: ", "1e+08 N m"]),
        (["--set", f"operation.torque={'[' * 5000}"], ["operation.torque: ", "1e+08 N m"]),
        (["--set", f"a{'.a' * 1500}=1"], ["bad.toml: a.a.a", "nested more than 16 levels"]),
        (
            ["--set", f"operation.torque={'[' * 400}{']' * 400}"],
            ["operation.torque: is nested more than 16 levels deep"],
        ),
        (["--set", "gears.family=[1]"], ["gears.family: the list [1]", "'cylindrical' or 'strain"]),
        (["--set", "gears.family={a=1}"], ["gears.family: the table { a = 1 }", "'cylindrical'"]),
        (["--set", f"{'k' * 100_000}=1"], ["kkk...: is not a known key"]),
        (["--set", f"gears.{'k' * 100_000}=1"], ["gears.kkk", "kkk...: is not a known key"]),
        (["--set", f"gears.module={'k' * 100_000}"], ["gears.module: ", "too long", "100 mm"]),
        (["--set", f"lubricant.name={'k' * 100_000}"], ["kkk...", "known are"]),
        (["--set", "k" * 100_000], ["--set: ", "kkk...", "KEY=VALUE"]),
        (["--sweep", "k" * 100_000], ["--sweep: ", "kkk...", "KEY=START:STOP:COUNT"]),
        (
            ["--sweep", f"{'k' * 100_000}=1:2:3"],
            ["--sweep: ", "kkk...", "is not KEY=START:STOP:COUNT"],
        ),
        (["--variant", "k" * 100_000], ["variants: ", "kkk..."]),
        ([f"--{'k' * 100_000}"], ["No such option: --kkk"]),
        (["--set", "gears.teeth=plenty"], ["gears.teeth: ", 'write a whole number like "20"']),
        (["--set", "lubricant.name=PAO VG 15"], ["lubricant.name: ", "did you mean pao-vg-150 "]),
        (["--set", "materials.gear_2=pom"], ["materials.gear_2: ", "did you mean POM-H?"]),
        (["--set", "materials.gear_2=Stel"], ["materials.gear_2: ", "did you mean steel "]),
        (["--set", "models.friction=Xu 2006"], ["models.friction: ", "did you mean xu_2007?"]),
        (["--set", "operation.torque=600 kp cm"], ["operation.torque: ", "kgf cm"]),
        (["--set", "operation.torque"], ["--set: ", "operation.torque", "KEY=VALUE"]),
        (["--set", "=3"], ["--set: ", "=3", "KEY=VALUE"]),
        (["--set", ""], ["--set: ", "KEY=VALUE"]),
        (["--set", ".=3"], ["bad.toml: ", "known are", "gears"]),
        (["--set", "variants.a.b=3"], ["variants: ", "known", "gears"]),
        (["--sweep", "gears.modul=1 mm:2 mm:3"], ["--sweep: gears.modul: ", "module"]),
        (["--sweep", "gears.module=1:2 mm:3"], ["--sweep: gears.module: ", '"1" has no unit']),
        (["--sweep", "gears.module=1 mm:2 kg:3"], ["--sweep: gears.module: ", '"2 kg"', "100 mm"]),
        (["--sweep", "gears.module=1 mm:2 mm:0"], ["--sweep: ", "1 mm:2 mm:0", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm:100001"], ["--sweep: ", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm:²"], ["--sweep: ", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm"], ["--sweep: ", "KEY=START:STOP:COUNT"]),
        (["--sweep", "gears.module"], ["--sweep: ", "KEY=START:STOP:COUNT"]),
        (["--sweep", "=1 mm:2 mm:3"], ["--sweep: ", "known are", "gears"]),
        (["--sweep", "operation.driver=1:2:3"], ["--sweep: operation.driver: ", "no number"]),
        (
            ["--sweep", "title=1:2:3"],
            ["--sweep: title: cannot be swept", "gears, stages, materials"],
        ),
        (["--sweep", "models.friction=1:2:3"], ["--sweep: models.friction: cannot be swept"]),
        (["--sweep", "gears.addendum=1:2.1:3"], ["--sweep: at gears.addendum = 2.1: ", "2.158"]),
        (
            ["--set", "gears.family=worm"],
            ["no family of gears of Pitchpoint; pitchpoint docs not_included"],
        ),
        (["--set", "gears.family=harmonic drive"], ["gears.family: ", "did you mean strain_wave?"]),
        (["--set", "torque=50 N m"], ["torque: ", "[operation] and [loss_map] have that key"]),
        (["--set", "friction=xu_2007"], ["friction: ", "[models] has that key"]),
        (["--set", "gears.film=true"], ["gears.film: ", "[film] is a table of its own"]),
        (
            ["--set", "models.friction=0.05"],
            ["models.friction: ", 'write { name = "constant", coefficient = 0.05 }'],
        ),
        (["--set", "models.friction=coulomb"], ["models.friction: ", "did you mean constant?"]),
        (["--set", "materials.gear_1=16MnCr5"], ["materials.gear_1: ", "case-hardened-mq?"]),
        (
            ["--set", "strength.accuracy_class=A6"],
            ["strength.accuracy_class: ", 'a whole number like "3"; allowed is 3 to 8'],
        ),
        (["--set", "strength.safety=1.3"], ["strength.safety: ", "safeties are results"]),
        (
            ["--set", "loss_map={ quadrants = 4, lowest_speed = '5000 rpm' }"],
            ["loss_map.lowest_speed: 5000 rpm was given; allowed is less than the largest speed"],
        ),
        (["--bogus"], ["No such option: --bogus; see pitchpoint run --help"]),
        (["--variant"], ["--variant", "requires an argument; see pitchpoint --help"]),
        (["--variant", "x"], ["this case has no variants", "[variants.x.operation]"]),
        (["--set", "lubricant.name=Omala 7"], ["any other oil is given by base, viscosity_40"]),
        (["--set", "roughness.ra=N6"], ["roughness.ra: ", "grade N6 is Ra 0.8 um"]),
        (["--set", "roughness.ra=Rz 4"], ["roughness.ra: ", "Ra is about Rz/6"]),
        (["--set", "strength.life=infinite"], ["leave life out for teeth that are to endure"]),
        (["--set", "operation.torque=-60 N m"], ["which member drives says driver"]),
        (["--set", "operation.torque=['1 N m', '2 N m']"], ["--sweep operation.torque="]),
        (["extra"], ["extra", "see pitchpoint run --help"]),
    ],
    ids=lambda given: " ".join(given)[:50],
)
def test_command_lines(
    arguments: list[str], words: list[str], refuse: Callable[..., str], tmp_path: Path
) -> None:
    told = refuse("run", written(tomllib.loads(PAIR), tmp_path), *arguments)
    for word in words:
        assert word in told
    assert not (tmp_path / "results").exists()


def test_a_page_that_cannot_be_written_is_refused_before_its_designs_are_computed(
    refuse: Callable[..., str], tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    told = refuse("explore", written(tomllib.loads(PAIR), tmp_path), "-o", tmp_path / "file/x.html")
    assert "cannot be written to: a file stands where a folder belongs" in told
    assert "designs" not in told


def test_no_such_command(refuse: Callable[..., str]) -> None:
    assert "No such command 'frobnicate'" in refuse("frobnicate")
    assert "Missing argument 'CASE'" in refuse("run")


OTHER_CALLS = {
    "report out": "pitchpoint open FOLDER opens it",
    "validate pair.toml": "pitchpoint check CASE",
    "help": "pitchpoint docs",
    "-o out run pair.toml": "options stand behind the command: pitchpoint run CASE -o FOLDER",
    "run pair.toml --set": '; write --set operation.torque="50 N m"',
    "run pair.toml other.toml": "it takes one case, pitchpoint compare several",
    "show": "a name out of pitchpoint cases",
    "optimise tian2024": "table [optimise] of the case or by option: --vary gears.face_width=",
    "study tian2024": 'table [study] of the case or by option: --over operation.torque="20 N m:90 N m:8"',
    "models steel oil": "it takes one kind or name, such as friction",
    "cases tian": "pitchpoint show CASE has the inputs of one",
    "new wolfrom": "did you mean 3K?",
    "new spur --ratio 3": "is for strain_wave, planetary and 3K; leave it out for spur",
    "new planetary --ratio 2": "2 is no ratio of one planetary set with 3 planets, which reaches",
    "new planetary --torque 5": "goes with --ratio",
    "new planetary --ratio 5/1": '--ratio: "5/1" is no ratio; write the input over the output',
    "new harmonic --ratio 100": "is no family of gears; did you mean strain_wave?",
    "compare pair.toml vs other.toml": "vs is no design; name them one after the other",
    "compare pair.toml,other.toml": "is no design; name them one after the other",
    "new pair.toml": "'pair.toml' is a file and no family of gears; write new spur -o FILE",
}


@pytest.mark.parametrize("called", OTHER_CALLS)
def test_commands_as_others_have_them_are_told_what_to_call(
    called: str, refuse: Callable[..., str]
) -> None:
    assert OTHER_CALLS[called] in refuse(*called.split())


def test_a_study_that_goes_wrong_half_way() -> None:
    tree = tomllib.loads(PAIR)
    sweep = {"key": "gears.profile_shift.1", "values": [0.0, 1.4, 0.1]}
    tree["studies"] = {"shift": {"sweep": sweep}}
    tree["gears"]["teeth"] = [12, 61]
    made = jobs(Variant(tree, "bad.toml", "default"), {})
    study = next(job for job in made if job.name == "study_shift")
    with pytest.raises(InputError) as caught:
        study.compute(study.pieces[0])
    told = str(caught.value)
    assert "bad.toml: studies.shift.sweep: at gears.profile_shift.1 = 1.4: " in told
    assert "gears.addendum: the tip circle of gear 1" in told
    assert "it may be" in told


def test_a_change_that_goes_wrong(refuse: Callable[..., str], tmp_path: Path) -> None:
    tree = tomllib.loads(PAIR)
    tree["studies"] = {"hot": {"change": {"operation": {"temperature": "200 degC"}}}}
    told = refuse("show", written(tree, tmp_path))
    assert "bad.toml: studies.hot: operation.temperature: 200 degC is outside" in told
    tree["studies"] = {"hot": {"change": {"operation": {"temperatur": "90 degC"}}}}
    told = refuse("show", written(tree, tmp_path))
    assert "studies.hot: operation.temperatur: is not a known key; did you mean temperature" in told


def test_a_folder_that_cannot_be_written(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    (tmp_path / "file").write_text("in the way")
    told = refuse("run", path, "-o", tmp_path / "file")
    assert f"{tmp_path / 'file'}: cannot be written to: " in told
    assert "file/in/it: cannot be written to: " in refuse(
        "run", path, "-o", tmp_path / "file/in/it"
    )
    assert (tmp_path / "file").read_text() == "in the way"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    (tmp_path / "closed").mkdir(mode=0o500)
    assert "cannot be written to: Permission denied" in refuse(
        "run", path, "-o", tmp_path / "closed"
    )


# ---- the same from outside


@pytest.mark.parametrize(
    ("content", "arguments", "words"),
    [
        (PAIR.replace('"2 mm"', '"[bold]2 mm[/bold]"'), [], ['"[bold]2 mm[/bold]"', "100 mm"]),
        (PAIR, ["--bogus"], ["No such option: --bogus"]),
    ],
    ids=["markup", "option"],
)
def test_a_process(content: str, arguments: list[str], words: list[str], tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text(content)
    command = [
        sys.executable,
        "-c",
        "from pitchpoint.cli import main; main()",
        "run",
        "bad.toml",
        *arguments,
    ]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    for word in words:
        assert word in done.stderr
