"""The loss map of the output: balances in all quadrants, and what holds a load."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from mapped_pair import MOVING, PAIR, TOLERANCE, variant, whole

from pitchpoint.analyses import four_quadrants
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.four_quadrants import loss_beside, loss_of_output, quadrant_axes, table_of
from pitchpoint.analyses.loss_map import maps
from pitchpoint.analyses.main_figures import HOLDING_BANDS, held_at_operation, standstill_figures
from pitchpoint.analyses.operation import BACK_DRIVING, OPERATION
from pitchpoint.analyses.running import BANDS, RUNNING, from_rest
from pitchpoint.cases.built_drive import Ready
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views import show
from pitchpoint.views.section_registry import FOUR_QUADRANTS as FOUR_QUADRANTS_SECTION
from pitchpoint.views.sections.beside import BESIDE

EXAMPLES = Path(__file__).parents[2] / "examples"


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
    off = show.number_text(
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
