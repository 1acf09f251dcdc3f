"""The evaluator of a loss map in Python and C without dependencies, and joints handed over."""

import ast
import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from mapped_pair import (
    MOVING,
    PAIR,
    TITLE,
    TOLERANCE,
    command,
    variant,
    whole,
)

from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import header, module
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.run import Outcome, open_outcomes, write_results

SIZING = Path(__file__).parents[2] / "docs" / "guide" / "sizing.md"


@pytest.fixture(scope="module")
def folder(moving: tuple[Ready, Outcome], tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("result")
    write_results({"default": moving[1]}, {"default": variant(PAIR + MOVING)}, made)
    return made


ASK = """
import json, math, sys
sys.path.insert(0, "")
import loss_table
points = json.load(sys.stdin)
rest = [loss_table.at_rest(7.0, degree) for degree in (50.0, 90.0)]
print(json.dumps([loss_table.at(*point) for point in points] + rest))
"""


def asked(folder: Path, points: list[Any]) -> list[Any]:
    """What the file says, in a process that has nothing but the standard library, in its folder alone."""
    done = subprocess.run(
        [sys.executable, "-I", "-S", "-c", ASK],
        cwd=folder,
        input=json.dumps(points),
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    found: list[Any] = json.loads(done.stdout)
    return found


@pytest.fixture(scope="module")
def exported(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("exported")
    assert command("export", folder, "--evaluator", "-o", out) == 0
    assert {path.name for path in out.iterdir()} == {"loss_table.py", "loss_table.h"}
    return out


def nodes(data: xr.Dataset) -> list[tuple[float, float, float, str]]:
    return [
        (torque, speed, round(degree - 273.15, 9), law)
        for law in data["law"].values.tolist()
        for torque in data["output_torque"].values.tolist()
        for speed in data["output_speed"].values.tolist()
        for degree in data["temperature"].values.tolist()
    ]


def test_the_module_has_the_nodes_to_the_last_digit(
    moving: tuple[Ready, Outcome], exported: Path
) -> None:
    data = moving[1].parts["four_quadrants"]
    *found, rest, beyond = asked(exported, nodes(data))
    values = np.array(found, float)
    for column, name in enumerate(("mean_loss", "mean_efficiency", "mean_input_torque", "locked")):
        np.testing.assert_allclose(
            values[:, column],
            whole(data)[name].ravel().astype(float),
            rtol=TOLERANCE,
            equal_nan=True,
        )
    assert not values[:, 4].any()
    assert rest == [*table_of(data).at_rest(7.0, 50.0)]
    assert rest[2:4] == [False, False]
    assert beyond[3] is True


def test_the_module_between_and_beyond_its_nodes(
    moving: tuple[Ready, Outcome], exported: Path
) -> None:
    table = table_of(moving[1].parts["four_quadrants"])
    torques, speeds = table.torques, table.speeds
    half = (torques[-1] + torques[-2]) / 2.0, np.sqrt(speeds[-1] * speeds[-2])
    points = [
        (half[0], speeds[-1], 60.0),
        (torques[-1], half[1], 60.0),
        (torques[-1], speeds[-1], sum(table.temperatures[-2:]) / 2.0),
    ]
    points += [
        (2.0 * torques[-1], speeds[-1], 40.0),
        (1.0, -2.0 * speeds[-1], 90.0),
        (5.0, 0.0, 50.0),
    ]
    points += [(30.0, speeds[1] / 3.0, 40.0)]
    *found, _, _ = asked(exported, points)
    lost = np.array(table.loss_torques["xu_2007"])[-2:, -2:, -2:]
    means = lost[:, 1, 1].mean(), lost[1, :, 1].mean(), lost[1, 1, :].mean()
    expected = np.array(means) * [one[1] for one in points[:3]]
    assert [one[0] for one in found[:3]] == pytest.approx(expected.tolist(), rel=1e-13)
    assert [one[4] for one in found] == [False] * 3 + [True] * 2 + [False] * 2
    cold = table.lost(torques[-1], speeds[-1], 40.0)
    assert found[3][0] == pytest.approx(cold * speeds[-1], rel=1e-14)
    given = points[3][0]
    assert found[3][1] == pytest.approx(given / (given + cold), rel=1e-14)
    assert found[5][0] == 0.0
    assert np.isnan(found[5][1:3]).all()
    assert found[6][0] == pytest.approx(table.at(30.0, speeds[1], 40.0).loss / 3.0, rel=1e-13)


def test_the_module_is_a_command(exported: Path, moving: tuple[Ready, Outcome]) -> None:
    given = ("--torque", "-20", "--speed", "3", "--temperature", "45", "--law", "frictionless")
    done = subprocess.run(
        [sys.executable, "-I", "-S", "loss_table.py", *given],
        cwd=exported,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    told = dict(line.split(": ") for line in done.stdout.splitlines())
    expected = table_of(moving[1].parts["four_quadrants"]).at(-20.0, 3.0, 45.0, "frictionless")
    assert told["input_torque"] == f"{expected.input_torque!r} N m"
    assert told["locked"] == "False"


def test_a_joint_in_time_starts_stops_and_keeps_its_energy(exported: Path) -> None:
    """The loop of the guide: held inside the band, moved beyond it, held again where it comes to rest."""
    loop = next(
        block
        for block in re.findall(r"```python\n(.*?)```", SIZING.read_text("utf-8"), re.DOTALL)
        if "def next_speed" in block
    )
    program = f"""{loop}
import json
rest = at_rest(LOAD, OIL)
inside = (rest.lowest + rest.highest) / 2.0
speeds, gained, speed = [], 0.0, 0.0
for step in range(6000):
    motor = inside if step < 500 or step >= 2000 else 1.05 * rest.highest
    later = next_speed(speed, motor)
    middle = (speed + later) / 2.0
    if middle:
        lost = at(LOAD, speed or later, OIL).loss / abs(speed or later) * abs(middle)
        gained += (motor * middle / TABLE.speed_ratio - LOAD * middle - lost) * STEP
    speed = later
    speeds.append((speed, gained, INERTIA * speed**2 / 2.0))
print(json.dumps(speeds))
"""
    told = subprocess.run(
        [sys.executable, "-c", program], cwd=exported, capture_output=True, check=True, timeout=60
    )
    speed, gained, kinetic = np.array(json.loads(told.stdout)).T
    assert not speed[:500].any()
    assert speed[1999] > 0.01 and np.all(np.diff(speed[500:2000]) > 0.0)
    assert np.all(np.diff(speed[2000:]) <= 0.0) and not speed[-1]
    np.testing.assert_allclose(gained[:2000], kinetic[:2000], atol=0.02 * kinetic.max())
    assert gained[-1] == pytest.approx(0.0, abs=0.02 * kinetic.max())


def test_nothing_that_was_typed_breaks_out(exported: Path) -> None:
    tree = ast.parse((exported / "loss_table.py").read_text("utf-8"))
    (about,) = (
        ast.literal_eval(one.value)
        for one in tree.body
        if isinstance(one, ast.Assign) and ast.unparse(one.targets[0]) == "ABOUT"
    )
    assert about["title"] == TITLE
    assert about["digest"] == "0123456789abcdef"
    text = (exported / "loss_table.h").read_text("utf-8")
    assert text.isascii()
    assert text.count("*/") == text.count("/*")
    assert "??" not in text


ASK_IN_C = """
#include <stdio.h>
#include "loss_table.h"
int main(void) {
    double torque, speed, temperature;
    int law;
    fprintf(stderr, "%s", loss_table_title);
    while (scanf("%lf %lf %lf %d", &torque, &speed, &temperature, &law) == 4) {
        struct loss_table_point p = loss_table_at(torque, speed, temperature, law);
        struct loss_table_rest r = loss_table_at_rest(torque, temperature, law);
        loss_table_at_many(1, &torque, &speed, &temperature, law, &p);
        printf("%.17g %.17g %.17g %d %d ", p.loss, p.efficiency, p.input_torque, p.locked, p.outside);
        printf("%.17g %.17g %d %d ", r.lowest, r.highest, r.locked, r.outside);
        printf("%.17g %.17g %.17g %.17g\\n", r.lowest_low, r.lowest_high, r.highest_low, r.highest_high);
    }
    return loss_table_law("frictionless") == 1 && loss_table_law("no") == -1 ? 0 : 1;
}
"""


@pytest.mark.skipif(shutil.which("gcc") is None, reason="there is no gcc")
def test_the_header_says_what_the_module_says(
    moving: tuple[Ready, Outcome], locking: tuple[Ready, Outcome], tmp_path: Path
) -> None:
    data = moving[1].parts["four_quadrants"]
    torque, speed = (float(data[name].max()) for name in ("output_torque", "output_speed"))
    random = np.random.default_rng(1)
    low, high = [-1.1 * torque, -1.1 * speed, 35.0], [1.1 * torque, 1.1 * speed, 65.0]
    others = [(*map(float, one), "xu_2007") for one in random.uniform(low, high, (200, 3))]
    own = [(*point[:3], "constant") for point in nodes(locking[1].parts["four_quadrants"])]
    for points, result in (
        ([*nodes(data), *others], moving[1]),
        (own, locking[1]),
    ):
        table = table_of(result.parts["four_quadrants"])
        (tmp_path / "loss_table.h").write_text(header(result, table), "utf-8")
        (tmp_path / "ask.c").write_text(ASK_IN_C, "utf-8")
        build = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-pedantic")
        subprocess.run([*build, "ask.c", "-o", "ask", "-lm"], cwd=tmp_path, check=True, timeout=60)
        names = [*table.loss_torques]
        text = "\n".join(f"{t!r} {s!r} {d!r} {names.index(law)}" for t, s, d, law in points)
        done = subprocess.run(
            [tmp_path / "ask"], input=text, capture_output=True, text=True, timeout=60
        )
        assert done.stderr == TITLE
        found = np.array([line.split() for line in done.stdout.splitlines()], float)
        there = [(*table.at(*point), *table.at_rest(point[0], *point[2:])) for point in points]
        expected = np.array(there, float)
        np.testing.assert_allclose(found, expected, rtol=1e-12, equal_nan=True)
        for law in names:
            rows = [k for k, point in enumerate(points) if point[3] == law]
            many = table.at_many(*np.array([points[k][:3] for k in rows]).T, law)
            np.testing.assert_allclose(
                np.array(many, float).T, expected[rows, :5], rtol=1e-12, equal_nan=True
            )


def test_a_result_without_the_map(
    folder: Path, moving: tuple[Ready, Outcome], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest, parts = moving[1].manifest, {"running": moving[1].parts["running"]}
    bare = Outcome({**manifest, "parts": ["running"]}, parts)
    write_results({"default": bare}, {"default": variant(PAIR + MOVING)}, tmp_path / "other")
    assert command("export", tmp_path / "other", "--evaluator") == 2
    told = capsys.readouterr().err
    assert "the result has no loss map of the output" in told
    assert "--set loss_map.quadrants=4" in told
    assert command("export", tmp_path / "other", "--mujoco") == 2
    told = capsys.readouterr().err
    assert "--mujoco: the result has no loss map of the output" in told
    advice = re.search(r"pitchpoint run \S+ --set ([\w.]+)=(\d+)", " ".join(told.split()))
    assert advice is not None
    key, value = advice.groups()
    plain = tomllib.loads(PAIR.replace("quadrants = 4", ""))
    work = jobs(Variant(plain, "pair.toml", "default", {key: int(value)}), {})
    assert FOUR_QUADRANTS.name in [job.name for job in work]
    assert (
        open_outcomes(folder)["default"].parts["four_quadrants"].attrs["title"]
        == FOUR_QUADRANTS.title
    )


def test_a_joint_is_handed_over_with_what_is_lost_on_the_screen(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wishes = (
        "--law",
        "frictionless",
        "--rotor-inertia",
        "0.3 kg cm2",
        "--torque-range",
        "5 N m:20 N m",
    )
    assert command("export", folder, "--mujoco", "-o", tmp_path, *wishes) == 0
    told = capsys.readouterr().out
    files = {path.name for path in (tmp_path / "mujoco").iterdir()}
    assert files == {"joint.xml", "joint_friction.py", "arm.xml"}
    assert "What is lost: torque of the driver, this file against the loss map [N m]" in told
    # Without friction on the teeth the seals alone are lost, at any load and speed.
    rows = re.findall(r"^(?:the map|range) .*\) +(\S+) +(\S+) +\S+ % +\d+$", told, re.MULTILINE)
    assert np.array(rows, float) == pytest.approx(np.zeros((4, 2)), abs=1e-9)


@pytest.mark.parametrize(
    ("wishes", "told"),
    [
        (
            ("--law", "xu_2006"),
            '"xu_2006" is not a friction law of this result; did you mean xu_2007?',
        ),
        (("--load", "900 N m"), '"900 N m" is beyond the map, which goes from 0 to 75 N m'),
        (("--temperature", "5 degC"), '"5 degC" is beyond the map, which goes from 40 to 60 degC'),
        (("--rotor-inertia", "3 mm"), '"3 mm" is a length, but a moment of inertia is needed'),
        (("--speed-range", "9 rpm"), '"9 rpm" is no range'),
    ],
)
def test_wishes_that_a_joint_cannot_fulfil(
    folder: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    wishes: tuple[str, str],
    told: str,
) -> None:
    assert command("export", folder, "--mujoco", "-o", tmp_path, *wishes) == 2
    found = " ".join(capsys.readouterr().err.split())
    assert f"error: {wishes[0]}: {told}" in found


def test_an_export_of_nothing_names_simulators_too(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("export", folder) == 2
    assert "--evaluator, --mujoco, --urdf, --ros2-control" in capsys.readouterr().err.replace(
        "\n", " "
    )


def test_the_head_tells_signs_errors_and_origin(moving: tuple[Ready, Outcome]) -> None:
    result = moving[1]
    text = module(result, table_of(result.parts["four_quadrants"]))
    compile(text, "loss_table.py", "exec")
    head = " ".join((ast.get_docstring(ast.parse(text)) or "").split())
    most = 100.0 * float(result.parts["four_quadrants"]["interpolation_error"][0])
    assert f"xu_2007 {most:.2g} % at most" in head
    assert "at a tenth of" in head
    for words in (
        "quadrants I and III",
        "Units: torque N m, speed rad/s",
        "Beyond the table",
        "flanks",
    ):
        assert words in head


@pytest.mark.parametrize(
    ("added", "told"),
    [
        ('lowest_speed = "3000 rpm"', "less than the largest speed of the map, 2250 rpm"),
        ('speed = "0 rpm"', "asks for a speed above standstill"),
    ],
)
def test_speeds_that_make_no_map(added: str, told: str) -> None:
    with pytest.raises(InputError, match=told):
        variant(PAIR + added).built({})
    variant(PAIR + added.replace("3000", "5").replace('"0 ', '"9 ')).built({})
