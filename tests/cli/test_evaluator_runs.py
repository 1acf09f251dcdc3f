"""The loss map of the output, and its evaluator in Python and C without dependencies."""

import ast
import json
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sound
import xarray as xr

from pitchpoint import cli
from pitchpoint.analyses import four_quadrants
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.four_quadrants import loss_of_output, table_of
from pitchpoint.analyses.loss_map import map_axes, maps
from pitchpoint.analyses.registry import FOUR_QUADRANTS
from pitchpoint.analyses.running import RUNNING
from pitchpoint.cases.stages import Ready
from pitchpoint.cases.variant import Variant
from pitchpoint.exports.evaluator import header, module
from pitchpoint.runs.run import Outcome, describe, keep, open_result

TITLE = '"""*/ #\' \\ ??/ {title}\u2028 % \U0001f600'
GEARS = sound.PAIR.replace("[23, 61]", "[12, 120]\nprofile_shift = [0.5, 0.0]")
PAIR = f"""
{GEARS}
[loss_map]
count = 4
temperatures = ["40 degC", "60 degC"]
quadrants = 4
"""
MOVING = """
[models]
friction = ["xu_2007", "frictionless"]
[losses]
seal = { between = ["gear 2", "housing"], seal_torque = "2 N m", breakaway_torque = "1 N m" }
motor = { between = ["gear 1", "housing"], seal_torque = "0.1 N m" }
"""
LOCKING = """
[models]
friction = { name = "constant", coefficient = 1.8 }
"""
TOLERANCE = 1e-13


def variant(text: str) -> Variant:
    return Variant({**tomllib.loads(text), "title": TITLE}, "pair.toml", "default")


def outcome(text: str, *others: Any) -> tuple[Ready, Outcome]:
    made = variant(text)
    built = made.built({})
    parts = {}
    for analysis in (FOUR_QUADRANTS, *others):
        pieces = [analysis.compute(built, piece, silent) for piece in analysis.pieces(built)]
        parts[analysis.name] = analysis.joined(built, pieces)
        parts[analysis.name].attrs["fingerprint"] = "0123456789abcdef"
    (manifest,) = describe(made.tree)
    return built, Outcome(manifest | {"lacks": {}, "parts": [*parts], "finished": True}, parts)


@pytest.fixture(scope="module")
def moving() -> tuple[Ready, Outcome]:
    return outcome(PAIR + MOVING, RUNNING)


@pytest.fixture(scope="module")
def locking() -> tuple[Ready, Outcome]:
    return outcome(PAIR + LOCKING)


@pytest.fixture(scope="module")
def folder(moving: tuple[Ready, Outcome], tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("result")
    keep({"default": moving[1]}, {"default": variant(PAIR + MOVING)}, made)
    return made


def command(*arguments: object) -> int:
    with pytest.MonkeyPatch.context() as changed, pytest.raises(SystemExit) as caught:
        changed.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        cli.main()
    return int(caught.value.code or 0)


def whole(data: xr.Dataset) -> dict[str, np.ndarray]:
    """Values over law, torque, speed and temperature."""
    dims = ("law", "output_torque", "output_speed", "temperature")
    names = ("mean_loss", "mean_efficiency", "mean_input_torque", "locked")
    return {name: data[name].transpose(*dims).values for name in names}


def powers(data: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Power at the output and at the driver."""
    torque, speed = (
        data["output_torque"].values[:, None, None],
        data["output_speed"].values[:, None],
    )
    found = whole(data)["mean_input_torque"] * (speed / data.attrs["speed_ratio"])
    return np.broadcast_to(torque * speed, found.shape), found


def test_power_balances_in_all_quadrants(moving: tuple[Ready, Outcome]) -> None:
    data = moving[1].parts["four_quadrants"]
    found, (given, taken) = whole(data), powers(data)
    turns = np.broadcast_to((data["output_speed"].values != 0.0)[:, None], given.shape)
    assert np.isfinite(found["mean_loss"]).all()
    assert (found["mean_loss"][turns] > 0.0).all()  # seals brake at no torque too
    assert not found["mean_loss"][~turns].any()
    assert np.isnan(found["mean_input_torque"][~turns]).all()
    np.testing.assert_allclose((taken - given)[turns], found["mean_loss"][turns], rtol=1e-11)
    drives, driven = (given > 0.0) & turns, (given < 0.0) & (taken < 0.0) & turns
    eta = found["mean_efficiency"]
    np.testing.assert_allclose(eta[drives], given[drives] / taken[drives], rtol=TOLERANCE)
    np.testing.assert_allclose(eta[driven], taken[driven] / given[driven], rtol=TOLERANCE)
    assert np.isnan(eta[~drives & ~driven]).all()
    assert driven.any()


def test_both_senses_are_alike(moving: tuple[Ready, Outcome]) -> None:
    found = whole(moving[1].parts["four_quadrants"])
    for name, sign in (("mean_loss", 1.0), ("mean_efficiency", 1.0), ("mean_input_torque", -1.0)):
        np.testing.assert_array_equal(found[name], sign * found[name][:, ::-1, ::-1])


def test_the_driver_drives_as_in_the_loss_map(moving: tuple[Ready, Outcome]) -> None:
    built, result = moving
    loads, speeds, degrees = map_axes(built)
    data = result.parts["four_quadrants"].sel(output_torque=slice(0.0, None))
    positive = whole(data.sel(output_speed=slice(0.0, None)))["mean_loss"]
    for number, load in enumerate(loads):
        each = [one[0] for one in maps(built, float(load), speeds, degrees)]
        np.testing.assert_array_equal(positive[:, number], np.stack(each))


def test_the_output_drives_as_computed_from_its_side(moving: tuple[Ready, Outcome]) -> None:
    """What the driver has to hold is the load under which the output needs its torque."""
    built, result = moving
    data = result.parts["four_quadrants"]
    back = four_quadrants._driven_back(built)
    torque, speeds = float(data["output_torque"][0]), map_axes(back)[1]
    held = whole(data)["mean_input_torque"][:, 0]
    for law, speed in ((0, 1), (0, 3), (1, 2)):
        load = -held[law, speeds.size - 1 + speed, 0]
        assert load > 0.0
        loss = [one[0] for one in maps(back, load, speeds, map_axes(back)[2])][law][speed, 0]
        turning = load / data.attrs["speed_ratio"] + loss / speeds[speed]
        # Of four loads; the error is that of the loss, not of the torque.
        assert abs(turning + torque) * speeds[speed] < 2e-3 * loss


def test_light_loads_and_the_driver_put_power_in(moving: tuple[Ready, Outcome]) -> None:
    """Without friction on teeth the loss of seals is the same whichever end overcomes them."""
    data = moving[1].parts["four_quadrants"].sel(law="frictionless", output_speed=slice(1e-9, None))
    speed = data["output_speed"].values
    seals = (2.0 + 0.1 / data.attrs["speed_ratio"]) * speed
    loss = data["mean_loss"].transpose("output_torque", "temperature", "output_speed").values
    np.testing.assert_allclose(loss, np.broadcast_to(seals, loss.shape), rtol=1e-12)
    assert (
        float(moving[1].parts["four_quadrants"]["interpolation_error"].sel(law="frictionless"))
        < 1e-12
    )


def test_between_nodes_it_is_as_near_as_is_told(moving: tuple[Ready, Outcome]) -> None:
    built, result = moving
    data = result.parts["four_quadrants"]
    most, mean = (float(data[n][0]) for n in ("interpolation_error", "mean_interpolation_error"))
    assert 0.0 < mean < most < 0.2
    table = table_of(data)
    (loads, speeds, degrees), ratio = map_axes(built), data.attrs["speed_ratio"]
    load, speed, degree = ((one[1] + one[0]) / 2.0 for one in (loads[1:], speeds[1:], degrees))
    direct = next(maps(built, float(load), np.array([speed] * 4), np.array([degree] * 2)))[0][0, 0]
    assert abs(table.at(load, speed * ratio, 50.0).loss / direct - 1.0) <= most
    finer = PAIR.replace("count = 4", "count = 7") + MOVING
    assert float(outcome(finer)[1].parts["four_quadrants"]["interpolation_error"][0]) < most


def test_a_drive_that_friction_locks(locking: tuple[Ready, Outcome]) -> None:
    data = locking[1].parts["four_quadrants"]
    found, (given, _) = whole(data), powers(data)
    np.testing.assert_array_equal(found["locked"], given < 0.0)
    assert np.isnan(found["mean_loss"][given < 0.0]).all()
    assert np.isfinite(found["mean_efficiency"][given > 0.0]).all()
    (told,) = json.loads(data.attrs["warnings"])
    assert "friction locks the drive against its output at" in told
    assert "the driver has to turn the load along" in told
    table = table_of(data)
    assert table.at(-1.0, 3.0, 50.0).locked  # beside nodes that are
    assert not table.at(1.0, 3.0, 50.0).locked
    assert not table.at(-1.0, 0.0, 50.0).locked


@pytest.mark.parametrize(
    ("locked", "expected", "held"),
    [
        ([False, False, False], [1.5, 2.0, 6.0, 12.0], [False] * 4),
        ([False, False, True], [1.5, 2.0, 6.0, np.nan], [False, False, False, True]),
        ([False, True, False], [1.5, 2.0, np.nan, np.nan], [False, False, True, True]),
        ([True, True, True], [np.nan] * 4, [True] * 4),
    ],
)
def test_loss_from_loads_at_the_driver(
    locked: list[bool], expected: list[float], held: list[bool]
) -> None:
    torque, driving = np.array([0.5, 1.0, 5.0, 11.0]), np.array([1.0, 5.0, 11.0])
    loss, found = loss_of_output(torque, 1.0, driving, driving + 1.0, np.array(locked))
    np.testing.assert_allclose(loss, expected)
    assert found.tolist() == held


ASK = """
import json, math, sys
sys.path.insert(0, "")
import loss_table
points = json.load(sys.stdin)
print(json.dumps([loss_table.at(*point) for point in points] + [loss_table.at_rest(50.0)]))
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
    *found, rest = asked(exported, nodes(data))
    values = np.array(found, float)
    for column, name in enumerate(("mean_loss", "mean_efficiency", "mean_input_torque", "locked")):
        np.testing.assert_array_equal(values[:, column], whole(data)[name].ravel().astype(float))
    assert not values[:, 4].any()
    running = moving[1].parts["running"].sel(law="xu_2007")
    degrees = running["temperature"].values
    for number, name in enumerate(("starting_torque", "back_driving_torque")):
        there = np.interp(323.15, degrees, running[name].values)
        assert rest[number] == pytest.approx(there, rel=1e-12)


def test_the_module_between_and_beyond_its_nodes(
    moving: tuple[Ready, Outcome], exported: Path
) -> None:
    data = moving[1].parts["four_quadrants"]
    table = table_of(data, moving[1].parts["running"])
    torques, speeds = table.torques, table.speeds
    half = [(one[-1] + one[-2]) / 2.0 for one in (torques, speeds)]
    points = [
        (half[0], speeds[-1], 40.0),
        (torques[-1], half[1], 40.0),
        (torques[-1], speeds[-1], 50.0),
    ]
    points += [
        (2.0 * torques[-1], speeds[-1], 40.0),
        (1.0, -2.0 * speeds[-1], 90.0),
        (5.0, 0.0, 50.0),
    ]
    points += [(30.0, speeds[1] / 3.0, 40.0)]
    *found, _ = asked(exported, points)
    losses = np.array(table.losses["xu_2007"])[-2:, -2:, :]
    means = losses[:, 1, 0].mean(), losses[1, :, 0].mean(), losses[1, 1, :].mean()
    assert [one[0] for one in found[:3]] == pytest.approx(means, rel=1e-14)
    assert [one[4] for one in found] == [False] * 3 + [True] * 2 + [False] * 2
    assert found[3][0] == losses[1, 1, 0]
    beyond = points[3][0] * points[3][1]
    assert found[3][1] == pytest.approx(beyond / (beyond + losses[1, 1, 0]), rel=1e-14)
    assert found[5][0] == 0.0
    assert np.isnan(found[5][1:3]).all()
    first, second = (table.at(30.0, speed, 40.0).loss for speed in speeds[1:3])
    power = max(np.log(second / first) / np.log(2.0), 1.0)
    assert found[6][0] == pytest.approx(first * 3.0**-power, rel=1e-12)


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
        printf("%.17g %.17g %.17g %d %d\\n", p.loss, p.efficiency, p.input_torque, p.locked, p.outside);
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
        table = table_of(result.parts["four_quadrants"], result.parts.get("running"))
        (tmp_path / "loss_table.h").write_text(header(result, table), "utf-8")
        (tmp_path / "ask.c").write_text(ASK_IN_C, "utf-8")
        build = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", "-pedantic")
        subprocess.run([*build, "ask.c", "-o", "ask", "-lm"], cwd=tmp_path, check=True, timeout=60)
        names = [*table.losses]
        text = "\n".join(f"{t!r} {s!r} {d!r} {names.index(law)}" for t, s, d, law in points)
        done = subprocess.run(
            [tmp_path / "ask"], input=text, capture_output=True, text=True, timeout=60
        )
        assert done.stderr == TITLE
        found = np.array([line.split() for line in done.stdout.splitlines()], float)
        expected = np.array([table.at(*point) for point in points], float)
        np.testing.assert_allclose(found, expected, rtol=1e-13, equal_nan=True)


def test_a_result_without_the_map(
    folder: Path, moving: tuple[Ready, Outcome], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    manifest, parts = moving[1].manifest, {"running": moving[1].parts["running"]}
    bare = Outcome({**manifest, "parts": ["running"]}, parts)
    keep({"default": bare}, {"default": variant(PAIR + MOVING)}, tmp_path / "other")
    assert command("export", tmp_path / "other", "--evaluator") == 2
    told = capsys.readouterr().err
    assert "the result has no loss map of the output" in told
    assert "--set loss_map.quadrants=4" in told
    assert (
        open_result(folder)["default"].parts["four_quadrants"].attrs["title"]
        == FOUR_QUADRANTS.title
    )


def test_the_head_tells_signs_errors_and_origin(moving: tuple[Ready, Outcome]) -> None:
    result = moving[1]
    text = module(result, table_of(result.parts["four_quadrants"]))
    head = " ".join((ast.get_docstring(ast.parse(text)) or "").split())
    most = 100.0 * float(result.parts["four_quadrants"]["interpolation_error"][0])
    assert f"xu_2007: {most:.2g} % at most" in head
    for words in (
        "quadrants I and III",
        "Units: torque N m, speed rad/s",
        "Beyond the table",
        "flanks",
    ):
        assert words in head
