"""The loss map of the output, and its evaluator in Python and C without dependencies."""

import ast
import json
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sound
import xarray as xr

import pitchpoint as pp
from pitchpoint import cli
from pitchpoint.analyses import four_quadrants
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.figures import (
    HOLDING_BANDS,
    duty_figures,
    held_at_operation,
    standstill_figures,
)
from pitchpoint.analyses.four_quadrants import (
    loss_beside,
    loss_of_output,
    quadrant_axes,
    table_of,
)
from pitchpoint.analyses.loss_map import maps
from pitchpoint.analyses.operation import BACK_DRIVING, OPERATION
from pitchpoint.analyses.registry import DUTY as DUTY_CYCLE
from pitchpoint.analyses.registry import FOUR_QUADRANTS
from pitchpoint.analyses.running import BANDS, RUNNING, from_rest
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import read
from pitchpoint.cases.variant import Variant
from pitchpoint.doubts import apart, doubts_of
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import header, module
from pitchpoint.runs.jobs import chosen_jobs, jobs
from pitchpoint.runs.run import Outcome, describe, keep, load_case, open_result
from pitchpoint.views import show
from pitchpoint.views.registry import DUTY as DUTY_SECTION
from pitchpoint.views.registry import FOUR_QUADRANTS as FOUR_QUADRANTS_SECTION
from pitchpoint.views.sections.beside import BESIDE
from pitchpoint.views.sections.duty import actuator_points, operating_points

EXAMPLES = Path(__file__).parents[2] / "examples"
SIZING = Path(__file__).parents[2] / "docs" / "guide" / "sizing.md"
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
motor = { between = ["gear 1", "housing"], seal_torque = "0.1 N m" }
[losses.seal]
between = ["gear 2", "housing"]
seal_torque = "2 N m"
breakaway_torque = "1 N m"
breakaway_spread = 2.0
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


def beside_torques_at_rest(outcome: Outcome, running: xr.Dataset) -> Iterator[str]:
    """What stands beside torques without load and from rest on a first screen."""
    yield from (one.detail for one in BESIDE.answer(replace(outcome, parts={"running": running})))


def test_a_torque_that_holds_hardly_anything_is_told_as_none_is(
    moving: tuple[Ready, Outcome],
) -> None:
    assert "lower bound" not in moving[1].parts["running"].attrs["warnings"]
    for held in ('breakaway_torque = "1e-6 N m"\n', ""):
        losses = MOVING.replace('breakaway_torque = "1 N m"\nbreakaway_spread = 2.0\n', held)
        built = variant(PAIR + losses).built({})
        running = RUNNING.compute(built, {}, silent)
        (told,) = json.loads(running.attrs["warnings"])
        # 0.1 N m and 2 N m over the ratio of 10, at rest as in slow motion
        assert "A torque to start of 0.3 N m beside 0.3 N m in slow motion is a lower bound" in told
        assert [*beside_torques_at_rest(moving[1], running)] == [
            "at 1500\u00a0rpm",
            *["at least; without breakaway, none is in [losses]"] * 2,
        ]
        every = moving[1].parts["four_quadrants"]
        bare = every.drop_vars([end for ends in HOLDING_BANDS.values() for end in ends])
        doubted = replace(moving[1], parts={"running": running, "four_quadrants": bare})
        (figure,) = FOUR_QUADRANTS_SECTION.answer(doubted)
        assert figure.detail.startswith("too narrow: no breakaway given; for ")


def test_the_input_of_a_drive_that_runs_backwards_is_the_member_that_is_loaded() -> None:
    built = variant(PAIR + '[models]\nfriction = "frictionless"\n').built({})
    forth, back = (
        one.compute(built, {}, silent)["mean_input_torque"] for one in (OPERATION, BACK_DRIVING)
    )
    ratio = 120 / 12  # without losses the load of 50 N m turns it backwards
    assert (forth.item() * ratio, back.item()) == pytest.approx((50.0, 50.0), rel=1e-6)
    assert "note" not in forth.attrs and back.attrs["note"].endswith("loads, which drives here")


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
    loads, speeds, degrees = quadrant_axes(built)
    data = result.parts["four_quadrants"].sel(output_torque=slice(0.0, None))
    positive = whole(data.sel(output_speed=slice(0.0, None)))["mean_loss"]
    for number, load in enumerate(loads):
        each = [one[0] for one in maps(built, float(load), speeds, degrees)]
        np.testing.assert_allclose(positive[:, number], np.stack(each), rtol=TOLERANCE)


def test_the_output_drives_as_computed_from_its_side(moving: tuple[Ready, Outcome]) -> None:
    """What the driver has to hold is the load under which the output needs its torque."""
    built, result = moving
    data = result.parts["four_quadrants"]
    back = four_quadrants._driven_back(built)
    torque, speeds = float(data["output_torque"][0]), quadrant_axes(back)[1]
    held = whole(data)["mean_input_torque"][:, 0]
    for law, speed in ((0, 1), (0, 3), (1, 2)):
        load = -held[law, speeds.size - 1 + speed, 0]
        assert load > 0.0
        loss = [one[0] for one in maps(back, load, speeds, quadrant_axes(back)[2])][law][speed, 0]
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


def off(table: LossTable, built: Ready, load: float, speeds: list[float]) -> np.ndarray:
    """How far the table is off direct computation under the first law at 50 degC, over it."""
    driver = np.array(speeds) / table.speed_ratio
    direct = next(maps(built, load, driver, np.array([323.15] * 2)))[0][:, 0]
    there = [table.at(load, speed, 50.0).loss for speed in speeds]
    return np.asarray(np.abs(np.array(there) / direct - 1.0))


def test_between_nodes_it_is_as_near_as_is_told(moving: tuple[Ready, Outcome]) -> None:
    """At random places, half of them slower than the hundredth part of the largest speed."""
    built, result = moving
    data = result.parts["four_quadrants"]
    names = (
        "interpolation_error",
        "mean_interpolation_error",
        "light_load_error",
        "creeping_error",
    )
    most, mean, light, creeping = (float(data[n][0]) for n in names)
    assert 0.0 < mean < most < 0.05
    table, random = table_of(data), np.random.default_rng(3)
    lowest, largest = table.speeds[1], table.speeds[-1]
    heavy = off(table, built, 41.0, np.geomspace(lowest, largest, 4).tolist())
    assert heavy.max() <= most
    every = np.exp(random.uniform(np.log(lowest), np.log(largest), 4)).tolist()
    assert off(table, built, 0.4 * table.torques[-1], every).max() <= most
    assert off(table, built, 0.05 * table.torques[-1], every).max() <= light
    assert (
        off(table, built, 41.0, np.geomspace(lowest / 10.0, lowest, 4).tolist()).max() <= creeping
    )
    assert creeping < 0.5  # by the law; a loss that vanished with the speed would miss all of it


@pytest.mark.whole
@pytest.mark.parametrize("name", ["pair_23_61", "strain_wave"])
def test_told_errors_of_random_points(name: str) -> None:
    """Both ways, at any torque, speed and temperature: nine of ten are nearer than is told.

    Away from the nodes and from the points half way between them at which the errors were measured.
    """
    changes = {"loss_map.quadrants": 4, "operation.temperature": "50 degC"}
    built = load_case(str(EXAMPLES / f"{name}.toml"), settings=changes)
    pieces = FOUR_QUADRANTS.pieces(built)
    data = FOUR_QUADRANTS.joined(
        built, [FOUR_QUADRANTS.compute(built, piece, silent) for piece in pieces]
    )
    table, random = table_of(data), np.random.default_rng(7)
    loads, driver, degrees = quadrant_axes(built)
    near = []
    for load in np.append(random.uniform(0.0, loads[1], 3), random.uniform(0.0, loads[-1], 7)):
        for way in ("forwards", "backwards"):
            drive = built if way == "forwards" else four_quadrants._driven_back(built)
            step = table.speed_ratio if way == "forwards" else 1.0
            slow, fast = np.log(driver[[1, -1]] * table.speed_ratio / step)
            speeds = np.exp(random.uniform(slow, fast, driver.size))
            there = random.uniform(degrees[0], degrees[-1], degrees.size)
            for law, (loss, _, _) in enumerate(maps(drive, float(load), speeds, there)):
                lost = loss / (speeds * step)[:, None]
                torque = (
                    load + 0.0 * lost if way == "forwards" else -load / table.speed_ratio - lost
                )
                for at in np.ndindex(lost.shape):
                    if table.torques[0] <= torque[at] <= table.torques[-1]:
                        kind = "light_load" if abs(torque[at]) < loads[1] else "interpolation"
                        place = float(torque[at]), speeds[at[0]] * step, there[at[1]] - 273.15
                        found = table.lost(*place, [*table.loss_torques][law])
                        near.append(
                            abs(found / lost[at] - 1.0) <= float(data[f"{kind}_error"][law])
                        )
    assert len(near) > 250
    assert np.mean(near) > 0.9
    assert float(data["interpolation_error"].max()) < 0.06
    assert float(data["light_load_error"].max()) < 0.08


def test_near_standstill_friction_under_load_is_there(moving: tuple[Ready, Outcome]) -> None:
    table = table_of(moving[1].parts["four_quadrants"])
    slow, slower = (table.at(60.0, speed, 50.0) for speed in (1e-3, 1e-9))
    assert slower.input_torque == slow.input_torque > 60.0 * table.speed_ratio + 0.1
    assert table.at(60.0, -1e-9, 50.0).input_torque < 60.0 * table.speed_ratio - 0.1
    rest = table.at_rest(60.0, 50.0)
    assert rest.lowest < 60.0 * table.speed_ratio < slow.input_torque < rest.highest


def test_what_holds_a_load_is_what_starts_it_either_way(moving: tuple[Ready, Outcome]) -> None:
    """From direct balances at rest under the load, and under what the driver holds of it."""
    built, result = moving
    table, step = (
        table_of(result.parts["four_quadrants"]),
        result.parts["four_quadrants"].speed_ratio,
    )
    point = quadrant_axes(built)[1][1]
    load, degrees = float(table.torques[-1]) / 2.0, np.array([313.15, 333.15])
    highest = from_rest(built, load, point, degrees)[0]
    back = four_quadrants._driven_back(built)
    for law, name in enumerate(table.loss_torques):
        rest = table.at_rest(load, 40.0, name)
        assert rest.highest == pytest.approx(highest[law, 0], rel=3e-3)
        turning = from_rest(back, rest.lowest, point * step, degrees)[0]
        assert turning[law, 0] == pytest.approx(load, rel=3e-3)
    # Without friction on the teeth: seals, and what holds one of them at rest.
    free = table.at_rest(load, 50.0, "frictionless")
    seals = 0.1 + step * (2.0 + 1.0)
    assert free.highest == pytest.approx(step * load + seals, rel=1e-9)
    assert free.lowest == pytest.approx(step * load - seals, rel=1e-9)
    assert table.at_rest(0.0, 50.0, "frictionless").lowest == pytest.approx(-seals, rel=1e-9)


def test_what_holds_at_rest_has_the_band_that_was_given(moving: tuple[Ready, Outcome]) -> None:
    """Half and twice the breakaway torque of the seal at the output, without friction on the teeth."""
    data = moving[1].parts["running"].sel(law="frictionless")
    step = moving[1].parts["four_quadrants"].speed_ratio
    names = BANDS[0][0], "starting_torque", BANDS[0][1]
    backwards = BANDS[1][0], "back_driving_torque", BANDS[1][1]
    for name, back, held in zip(names, backwards, (0.5, 1.0, 2.0), strict=True):
        output = 2.0 + held
        np.testing.assert_allclose(data[name], 0.1 + step * output, rtol=1e-9)
        np.testing.assert_allclose(data[back], 0.1 / step + output, rtol=1e-9)


def test_both_ends_of_what_holds_a_load_have_the_band_that_was_given(
    moving: tuple[Ready, Outcome],
) -> None:
    """Of each end, by half and twice the breakaway torque; the drive holds at least between inner ends."""
    data = moving[1].parts["four_quadrants"].sel(law="frictionless")
    step, load = data.speed_ratio, data["output_torque"]
    for held, least, largest in ((0.5, "high", "low"), (2.0, "low", "high")):
        seals = 0.1 + step * (2.0 + held)
        ends = data[f"least_holding_torque_{least}"], data[f"largest_holding_torque_{largest}"]
        for end, sign in zip(ends, (-1.0, 1.0), strict=True):
            np.testing.assert_allclose(*xr.broadcast(end, step * load + sign * seals), rtol=1e-9)
    table, every = table_of(moving[1].parts["four_quadrants"]), moving[1].parts["four_quadrants"]
    at_load = table.at_rest(30.0, 50.0, "frictionless")
    expected = {
        f"{end}_{side}": step * 30.0 + sign * (0.1 + step * (2.0 + held))
        for end, sign, sides in (
            ("lowest", -1.0, ("high", "low")),
            ("highest", 1.0, ("low", "high")),
        )
        for side, held in zip(sides, (0.5, 2.0), strict=True)
    }
    assert {name: getattr(at_load, name) for name in expected} == pytest.approx(expected, rel=1e-9)
    for name, ends in HOLDING_BANDS.items():
        assert (every[ends[0]] < every[name]).all()
        assert (every[name] < every[ends[1]]).all()
    (told,) = (one for one in FOUR_QUADRANTS_SECTION.answer(moving[1]))
    held = next(iter(held_at_operation(every).values()))
    off = show.number(
        100.0 * (held["largest_holding_torque_high"] / held["largest_holding_torque"] - 1.0), 2
    )
    assert told.detail.startswith(f"ends ±{off} % of the larger; at least ")
    assert told.detail.endswith(" by breakaway_spread")


def test_figures_of_a_load_that_is_held(
    moving: tuple[Ready, Outcome], locking: tuple[Ready, Outcome]
) -> None:
    found = standstill_figures(moving[1].parts)["four_quadrants"]["frictionless"]
    step = moving[1].parts["four_quadrants"].speed_ratio
    load, seals = float(moving[0].operation.load), 0.1 + step * 3.0
    assert found["largest_holding_torque"] == pytest.approx(step * load + seals, rel=1e-9)
    assert found["least_holding_torque"] == pytest.approx(step * load - seals, rel=1e-9)
    assert found["self_locking"] is False
    stuck = standstill_figures(locking[1].parts)["four_quadrants"]["constant"]
    assert stuck["self_locking"] is True
    assert stuck["least_holding_torque"] is None
    (told,) = (one for one in FOUR_QUADRANTS_SECTION.answer(locking[1]))
    assert "self-locking" in told.detail


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
    rest = table.at_rest(1.0, 50.0)
    assert rest.locked
    assert np.isnan([rest.lowest, rest.lowest_low, rest.lowest_high]).all()
    assert rest.highest_low == rest.highest == rest.highest_high  # no spread was given
    assert rest.highest > table.speed_ratio


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


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_bound_at_rest_encloses_what_it_bounds_at_any_load(way: float) -> None:
    """Drawn losses beside the teeth, of the teeth, and what phases add; on curves of their own some cross."""
    rng, load, crossed = np.random.default_rng(0), np.array([0.0, 0.5, 2, 4, 6, 8, 11, 15]), 0
    torque, free = np.linspace(0.1, 15.0, 50), np.zeros(8, bool)
    for _ in range(300):
        idle = 10.0 ** rng.uniform(-2.0, 1.5)
        usual = idle + rng.uniform(0.05, 0.8) * load ** rng.uniform(0.5, 1.0)
        bound = usual * (1.0 + way * rng.uniform(0.0, 0.02, 8))
        start = idle * rng.uniform(0.2, 2.0)
        mean = (start, load + usual, usual, free)
        beyond = (start * (1.0 + 0.01 * way), load + bound, bound, free)
        alone, kept = loss_of_output(torque, *mean)[0], loss_beside(torque, mean, beyond)[0]
        crossed += bool(np.any(way * (loss_of_output(torque, *beyond)[0] - alone) < -1e-12))
        at_nodes = loss_beside(load + bound, mean, beyond)[0]
        assert np.all(way * (kept - alone)[np.isfinite(kept + alone)] >= -1e-12)
        ahead = way * (bound - loss_of_output(load + bound, *mean)[0]) > 0.0
        np.testing.assert_allclose(at_nodes[ahead], bound[ahead], rtol=1e-9)
    assert crossed > 5


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
    keep({"default": bare}, {"default": variant(PAIR + MOVING)}, tmp_path / "other")
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
        open_result(folder)["default"].parts["four_quadrants"].attrs["title"]
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


def test_a_duty_cycle_is_told_by_the_map(
    folder: Path,
    moving: tuple[Ready, Outcome],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    path = tmp_path / "cycle.csv"
    head = "duration [s], torque [N m], speed [rpm], temperature [degC]\n"
    path.write_text(head + "2, 20, 60, 40\n1, 20, -60, 50\n3, 10, 0, 50\n")
    assert command("duty", folder, path) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 12 and max(map(len, lines)) <= 80
    assert lines[-1].split(maxsplit=2)[:2] == ["Fails", "first"]
    assert command("duty", folder, path, "--json", "--law", "frictionless") == 0
    told = json.loads(capsys.readouterr().out)
    table = table_of(moving[1].parts[FOUR_QUADRANTS.name])
    speed = 2.0 * np.pi
    lost = [
        table.at(20.0, sign * speed, degree, "frictionless").loss
        for sign, degree in ((1, 40), (-1, 50))
    ]
    assert told["lost_energy"] == pytest.approx(2.0 * lost[0] + lost[1], rel=1e-9)
    assert told["output_energy"] == pytest.approx(2.0 * 20.0 * speed, rel=1e-12)
    assert told["returned_energy"] == pytest.approx(20.0 * speed, rel=1e-12)
    assert command("duty", "--help") == 0
    help_ = capsys.readouterr().out
    assert all(head in help_ for head in ("time [s]", "torque [N m]", "speed [rpm]"))
    assert command("duty", folder, path, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    by_law = dict(zip(told["law"], told["law_lost_energy"], strict=True))
    assert by_law["frictionless"] == pytest.approx(2.0 * lost[0] + lost[1], rel=1e-9)
    assert told["quadrant"] == ["I", "II", "III", "IV", "rest"] and "time" not in told
    assert command("duty", folder, path, "--law", "xu") == 2
    assert "is not a friction law of this result" in capsys.readouterr().err
    path.write_text(head + "2, 20, 60, 400\n")
    assert command("duty", folder, path) == 2
    assert (
        "cycle.csv: temperature: 673.15 K, which are 400 degC, is no temperature"
        in capsys.readouterr().err
    )


CYCLE = "duration [s], torque [N m], speed [rpm], temperature [degC]\n"
STEPS = "2, 20, 60, 40\n1, 20, -60, 50\n3, 10, 0, 50\n"
DUTY = """
[duty]
file = "cycle.csv"
[duty.motor]
torque_constant = "0.1 N m/A"
resistance = "0.5 ohm"
[duty.lives.output]
torque = "40 N m"
revolutions = 1e6
"""


def on_duty(folder: Path, steps: str = STEPS, more: str = "", changed: str = PAIR) -> Variant:
    """The pair with a duty cycle beside its case file."""
    (folder / "cycle.csv").write_text(CYCLE + steps)
    (folder / "pair.toml").write_text(f'title = "a joint"\n{changed}{MOVING}{DUTY}{more}')
    return Variant(read(folder / "pair.toml"), "pair.toml", "default")


def test_a_run_answers_with_its_duty_cycle(
    moving: tuple[Ready, Outcome], folder: Path, tmp_path: Path
) -> None:
    built = on_duty(tmp_path).built({})
    assert DUTY_CYCLE.why_not(built) is None
    part = DUTY_CYCLE.joined(built, [moving[1].parts[FOUR_QUADRANTS.name]])
    beside = pp.duty(
        pp.open_result(folder),
        tmp_path / "cycle.csv",
        motor=pp.Motor(torque_constant=0.1, resistance=0.5),
        lives={"output": pp.RatedLife(40.0, 1e6)},
        teeth=True,
    )
    xr.testing.assert_equal(part, beside)
    assert part.attrs["first_to_fail"] == beside.attrs["first_to_fail"] == "bearing output"
    told = duty_figures({DUTY_CYCLE.name: part})[DUTY_CYCLE.name]
    assert told["lost_energy"] == float(part["lost_energy"]) and told["left_out"]
    made = replace(moving[1], parts={**moving[1].parts, DUTY_CYCLE.name: part})
    facts = {fact.name: fact for fact in DUTY_SECTION.answer(made)}
    assert facts["Fails first"].value == "bearing output"
    figure = operating_points("duty", made)
    dots = figure.data[1]
    np.testing.assert_allclose(dots["x"], [60.0, -60.0, 0.0], rtol=1e-4, atol=1e-12)
    assert dots["y"] == [20.0, 20.0, 10.0] and "oil at 40" in figure.note
    for name in ("map_actuator_efficiency", "map_electrical_power"):
        drawn = actuator_points(name, 0, made)
        assert drawn.drawn and drawn.data[1]["y"] == dots["y"] and "actuator" in drawn.title
    assert any(row[""] == "Electrical energy" for row in next(iter(DUTY_SECTION.screen(made))).rows)
    (printed,) = DUTY_SECTION.screen(made)
    assert [row[""] for row in printed.rows][-1] == "Fails first"
    # The actuator is at the mean over time, of the samples it is 50 degC.
    hot = CYCLE + "5, 20, 60, 40\n1, 20, -60, 60\n"
    (tmp_path / "hot.csv").write_text(hot)
    motor = pp.Motor(torque_constant=0.1, resistance=0.5)
    cycle = pp.duty(pp.open_result(folder), tmp_path / "hot.csv", motor=motor)
    made = replace(made, parts={**made.parts, DUTY_CYCLE.name: cycle})
    assert "oil at 43.33" in actuator_points("map_electrical_power", 0, made).note


def test_a_duty_cycle_brings_the_map_that_it_reads(tmp_path: Path) -> None:
    made = on_duty(tmp_path)
    assert [job.name for job in chosen_jobs(made, {}, ["duty"])] == ["four_quadrants", "duty"]
    assert chosen_jobs(made, {}, ["duty"])[1].pieces == ()


@pytest.mark.parametrize(
    ("steps", "more", "changed", "told"),
    [
        ("2, 20, 60, nan\n", "", PAIR, '"cycle.csv": temperature: sample 1 is nan'),
        ("2, 20, 60, 400\n", "", PAIR, '"cycle.csv": temperature: 673.15 K'),
        ("2, 900, 60, 40\n", "", PAIR, "1 of 1 samples lie beyond the loss map"),
        (
            STEPS,
            "",
            PAIR.replace("quadrants = 4", ""),
            r"duty: asks for the loss map .* quadrants = 4",
        ),
        (
            STEPS,
            '[duty.heat]\ngears = "a"\nbodies.b.heat_capacity = "1 J/K"\n'
            'resistances.c = { between = ["b", "ambient"], resistance = "1 K/W" }\n',
            PAIR,
            "duty.heat.gears: the network has no body 'a', but b",
        ),
        (
            STEPS,
            '[duty.heat]\ngears = "b"\nbodies.b.heat_capacity = "1 J/K"\n'
            'resistances.c = { between = ["a", "ambient"], resistance = "1 K/W" }\n',
            PAIR,
            "duty.heat.resistances: a resistance is between two of b, ambient",
        ),
    ],
)
def test_a_duty_cycle_that_cannot_be_is_told_before_its_map(
    tmp_path: Path, steps: str, more: str, changed: str, told: str
) -> None:
    with pytest.raises(InputError, match=told):
        jobs(on_duty(tmp_path, steps, more, changed), {})


HEAT = """
[duty.heat]
gears = "gears"
bodies.gears = { heat_capacity = "100 J/K", largest_temperature = "45 degC" }
resistances.arm = { between = ["gears", "ambient"], resistance = "%s" }
"""


def heated(
    moving: tuple[Ready, Outcome],
    folder: Path,
    resistance: str,
    ambient: str,
    steps: str = STEPS,
) -> xr.Dataset:
    """The duty cycle of the pair with a resistance to its surroundings."""
    more = (HEAT % resistance).replace("bodies", f'ambient = "{ambient}"\nbodies')
    built = on_duty(folder, steps, more).built({})
    return DUTY_CYCLE.joined(built, [moving[1].parts[FOUR_QUADRANTS.name]])


def test_heat_that_runs_away_or_is_too_much_is_told_first(
    moving: tuple[Ready, Outcome], tmp_path: Path
) -> None:
    away = heated(moving, tmp_path, "1e6 K/W", "45 degC")
    (sentence,) = apart(doubts_of(away.attrs))["implausible"]
    assert "there is no steady temperature" in sentence and "first at gears" in sentence
    assert away.attrs["first_to_fail"] == "heat of gears" and float(away["shortest_life"]) == 0.0
    assert "body_temperature" not in away and float(away["lost_energy"]) > 0.0
    hot = heated(moving, tmp_path, "0.01 K/W", "46 degC")
    (sentence,) = apart(doubts_of(hot.attrs))["implausible"]
    hottest = float(hot["body_temperature"].max()) - 273.15
    assert f"gears gets {hottest:.4g} degC" in sentence and "bears 45 degC" in sentence
    cool = heated(moving, tmp_path, "0.01 K/W", "42 degC")
    assert not apart(doubts_of(cool.attrs))["implausible"]


@pytest.mark.parametrize(
    ("resistance", "ambient", "steps", "first", "edge"),
    [
        (
            "1e6 K/W",
            "45 degC",
            "2, 20, 60, 30\n",
            "no steady temperature",
            "at 30 degC is taken at 40",
        ),
        ("0.01 K/W", "74 degC", STEPS, "gears gets 76", "at 76.* degC is taken at 60"),
        ("0.01 K/W", "20 degC", STEPS, "", "at 21.* degC is taken at 40"),
    ],
)
def test_oil_beyond_the_map_does_not_end_the_run(
    moving: tuple[Ready, Outcome],
    tmp_path: Path,
    resistance: str,
    ambient: str,
    steps: str,
    first: str,
    edge: str,
) -> None:
    part = heated(moving, tmp_path, resistance, ambient, steps)
    *hot, at_edge = doubts_of(part.attrs)
    assert len(hot) == bool(first) and all(first in sentence for sentence in hot)
    assert re.search(edge, at_edge) and float(part["lost_energy"]) > 0.0


def test_a_law_of_a_duty_cycle_is_one_of_the_case(tmp_path: Path) -> None:
    made = on_duty(tmp_path)
    settings = {"duty.law": "xu_2006"}
    changed = Variant(read(tmp_path / "pair.toml"), "pair.toml", "default", settings)
    with pytest.raises(InputError, match=r'duty.law: "xu_2006" is no .*did you mean xu_2007'):
        jobs(changed, {})
    assert len(jobs(made, {})) > 0


def test_files_of_the_map_say_what_is_doubtful_of_it(moving: tuple[Ready, Outcome]) -> None:
    _, made = moving
    doubtful = replace(made, manifest={**made.manifest, "warnings": ["The film */ is thin."]})
    table = table_of(made.parts[FOUR_QUADRANTS.name])
    for text in (header(doubtful, table), module(doubtful, table)):
        assert "Doubtful: The film _/ is thin." in text
        assert "Doubtful" not in text.replace("Doubtful: The film _/ is thin.", "")
