"""Duty cycles by hand: energies of a loss map, means, lives, resistances."""

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from duty_map import RATIO, WARM, table
from scipy.integrate import solve_ivp

from pitchpoint.analyses.tooth_life import cycles_on_curve, cycles_to_failure, load_classes
from pitchpoint.cases.built_duty import _heating
from pitchpoint.core.doubts import BRIEF, doubts_of
from pitchpoint.duty_cycle.duty_dataset import Heating, duty_dataset
from pitchpoint.duty_cycle.duty_table import HeatTable
from pitchpoint.duty_cycle.energy import driver_course, duty_energies, mean_load
from pitchpoint.duty_cycle.first_failure import WITHOUT_LIFE, first_failure
from pitchpoint.duty_cycle.history import LoadHistory, load_history, load_steps
from pitchpoint.duty_cycle.life import BALL, ROLLER, SCATTER, RatedLife, system_life
from pitchpoint.duty_cycle.motor import COPPER, Motor
from pitchpoint.duty_cycle.recorded_lives import recorded_lives
from pitchpoint.duty_cycle.thermal_network import ThermalNetwork
from pitchpoint.efficiency.loss_table import LOCKED
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.results.by_stage import by_stage
from pitchpoint.results.store import dataset
from pitchpoint.views.duty_cycle import duty_screen, first_to_fail

COLD_LOSS, WARM_LOSS = 3.0, 2.0


def history() -> LoadHistory:
    return load_steps([2.0, 1.0, 3.0, 4.0], [30.0, 40.0, -20.0, 10.0], [2.0, -4.0, 5.0, 0.0], WARM)


def test_energies_are_those_of_the_map_by_hand() -> None:
    lift, lower, brake = (2.0 * 30.0 * 2.0, 1.0 * 40.0 * 4.0, 3.0 * 20.0 * 5.0)
    lost = [2.0 * 5.0 * 2.0, 1.0 * 6.0 * 4.0, 3.0 * 4.0 * 5.0]
    of = duty_energies(history(), driver_course(table(), history()))
    assert of["output_energy"] == pytest.approx(lift, rel=1e-12)
    assert of["returned_energy"] == pytest.approx(lower + brake, rel=1e-12)
    assert of["lost_energy"] == pytest.approx(sum(lost), rel=1e-12)
    assert of["input_energy"] == pytest.approx(lift + lost[0], rel=1e-12)
    assert of["recovered_energy"] == pytest.approx(lower + brake - sum(lost[1:]), rel=1e-12)
    assert of["mean_loss"] == pytest.approx(sum(lost) / 10.0, rel=1e-12)


def test_at_rest_the_driver_holds_with_the_least_torque_of_the_band() -> None:
    course = driver_course(table(), load_steps([1.0] * 3, [10.0, -10.0, 1.0], 0.0, WARM))
    # 10 N m, less what friction of 2 + 1 N m holds, at the driver; 1 N m is held by friction alone.
    np.testing.assert_allclose(course.torque, [7.0 * RATIO, -7.0 * RATIO, 0.0], rtol=1e-12)
    assert (course.loss == 0.0).all()


def test_power_balances_with_a_rotor_that_is_sped_up() -> None:
    time = np.linspace(0.0, 2.0, 4001)
    speed = 3.0 * np.sin(np.pi * time) ** 2
    motor = Motor(torque_constant=0.1, resistance=0.5, inertia=1e-4)
    moved = load_history(time, 20.0, speed, WARM)
    course = driver_course(table(), moved, motor=motor)
    kinetic = 0.5 * 1e-4 * (course.speed[1000] ** 2 - course.speed[0] ** 2)
    half = load_history(time[:1001], 20.0, speed[:1001], WARM)
    of = duty_energies(half, driver_course(table(), half, motor=motor))
    assert of["rotor_energy"] == pytest.approx(kinetic, rel=1e-5)
    assert duty_energies(moved, course)["rotor_energy"] == pytest.approx(0.0, abs=1e-9 * kinetic)
    # The rotor takes and gives energy before the drive: through that goes what it has without a motor.
    heavy = replace(motor, inertia=1e-2)
    whole = duty_energies(moved, driver_course(table(), moved, motor=heavy))
    assert whole["recovered_energy"] > 0.0
    bare = duty_energies(moved, driver_course(table(), moved))
    assert whole["drive_efficiency"] == pytest.approx(20.0 / 24.0, rel=1e-12)
    assert bare["actuator_efficiency"] == pytest.approx(whole["drive_efficiency"], rel=1e-12)


def test_motor_losses_are_those_of_its_current_and_speed() -> None:
    motor = Motor(torque_constant=0.1, resistance=0.5, iron_loss=0.01, iron_exponent=1.5)
    steps = load_steps([1.0], [30.0], [2.0], WARM)
    course = driver_course(table(), steps, motor=motor, winding_temperature=353.15)
    current, speed = 35.0 * RATIO / 0.1, 2.0 / RATIO
    by_hand = 0.5 * (1.0 + 60.0 * COPPER) * current**2 + 0.01 * speed**1.5
    assert course.motor_loss[0] == pytest.approx(by_hand, rel=1e-12)


def test_mean_torques_and_lives_agree_by_two_roads() -> None:
    speeds, torques, times = (
        [50.0, 200.0, 80.0, 0.0],
        [60.0, 20.0, -45.0, 30.0],
        [0.3, 2.0, 0.3, 1.5],
    )
    cycle = load_steps(times, torques, speeds, WARM)
    assert mean_load(cycle, BALL) == pytest.approx(26.98558, abs=5e-6)
    cycles = RatedLife(torque=40.0, revolutions=1e8).life(cycle) / sum(times)
    assert cycles == pytest.approx(4661224.7556, abs=1e-4)
    for exponent in (BALL, ROLLER):  # Miner: the part of its life that each step uses up
        turns = [time * speed / (2.0 * np.pi) for time, speed in zip(times, speeds, strict=True)]
        lives = [1e8 * (40.0 / abs(torque)) ** exponent for torque in torques]
        damage = sum(part / life for part, life in zip(turns, lives, strict=True))
        rated = RatedLife(torque=40.0, revolutions=1e8, exponent=exponent)
        assert rated.life(cycle) == pytest.approx(sum(times) / damage, rel=1e-12)
    # Heat goes with the mean square over time, which is another number.
    slow = cycle._replace(speed=cycle.speed / 50.0, torque=cycle.torque / 2.0)
    of = duty_energies(slow, driver_course(table(), slow))
    assert of["rms_output_torque"] == pytest.approx(30.594 / 2.0, abs=5e-4)


def test_parts_that_fail_alone_fail_sooner_together() -> None:
    assert system_life([20.0, 35.0, 12.0], SCATTER[BALL]) == pytest.approx(6.83, abs=5e-3)
    assert system_life([12.0, math.inf]) == pytest.approx(12.0)


NETWORK = ThermalNetwork(
    {"gears": 120.0, "housing": 800.0},
    {("gears", "housing"): 0.6, ("housing", "ambient"): 1.5},
)


def test_temperatures_of_two_bodies_follow_their_equations() -> None:
    heat = np.array([15.0, 6.0])
    np.testing.assert_allclose(NETWORK.steady([15.0, 6.0]) - 293.15, [40.5, 31.5], rtol=1e-12)
    np.testing.assert_allclose(NETWORK.time_constants, [1389.83, 62.17], atol=5e-3)

    def rates(_: float, at: np.ndarray) -> list[float]:
        between, out = (at[0] - at[1]) / 0.6, (at[1] - 293.15) / 1.5
        return [(heat[0] - between) / 120.0, (heat[1] + between - out) / 800.0]

    start = np.array([293.15, 303.15])
    stepped = solve_ivp(rates, (0.0, 7200.0), start, method="DOP853", rtol=1e-11, atol=1e-9)
    course = NETWORK.course(start, np.full(72, 100.0), np.tile(heat, (72, 1)))
    np.testing.assert_allclose(course[-1], stepped.y[:, -1], rtol=1e-9)
    from_cold = NETWORK.course(np.full(2, 293.15), np.array([7200.0]), heat[None])
    np.testing.assert_allclose(from_cold[-1] - 293.15, [40.307, 31.317], atol=5e-4)
    # Steps of any length: what decays below the last bit, and what hardly decays.
    uneven = np.array([1e-3, 6e6, 7200.0 - 1e-3])
    again = NETWORK.course(start, uneven, np.array([heat, [0.0, 0.0], heat]))
    cold = NETWORK.course(np.full(2, 293.15), uneven[2:], heat[None])
    np.testing.assert_allclose(again[-1], cold[-1], rtol=1e-12)


def test_a_cycle_comes_back_to_its_periodic_temperatures() -> None:
    durations, heat = np.array([30.0, 200.0, 70.0]), np.array([[90.0, 0.0], [2.0, 1.0], [0.0, 9.0]])
    begin = NETWORK.periodic(durations, heat)
    np.testing.assert_allclose(NETWORK.course(begin, durations, heat)[-1], begin, rtol=1e-12)
    many = NETWORK.course(np.full(2, 293.15), np.tile(durations, 200), np.tile(heat, (200, 1)))
    np.testing.assert_allclose(many[-1], begin, rtol=1e-6)


@pytest.mark.parametrize(("loss", "degrees"), [(20.0, 73.850), (60.0, 300.1), (120.0, None)])
def test_copper_that_warms_up_settles_or_runs_away(loss: float, degrees: float | None) -> None:
    winding = ThermalNetwork({"winding": 100.0}, {("winding", "ambient"): 1.0 / 0.45})

    def heat(temperature: np.ndarray) -> np.ndarray:
        return loss * (1.0 + COPPER * (temperature - 293.15))

    if degrees is None:
        with pytest.raises(ConvergenceError, match="no steady temperature"):
            winding.steady_with(heat)
        return
    closed = loss / (0.45 - COPPER * loss)
    assert winding.steady_with(heat)[0] - 293.15 == pytest.approx(closed, rel=1e-9)
    assert winding.steady_with(heat)[0] - 273.15 == pytest.approx(degrees, abs=6e-2)


def test_oil_has_the_temperature_that_its_own_loss_gives() -> None:
    drive = ThermalNetwork({"drive": 1e9}, {("drive", "ambient"): 0.8}, ambient=293.15)
    data = duty_dataset(table(), history(), heating=Heating(drive, "drive"))
    rise = float(data["temperature"][0]) - 293.15
    # 3 N m at 20 degC, 1 less at 20 K more, beside a tenth of the load, over the way of 2 s, 1 s and 3 s.
    way, loaded = np.array([4.0, 4.0, 15.0]), np.array([30.0, 40.0, 20.0])
    mean = float((way * (3.0 - 0.05 * rise + 0.1 * loaded)).sum()) / 10.0
    assert rise == pytest.approx(0.8 * mean, rel=1e-7)
    assert float(data["mean_loss"]) == pytest.approx(mean, rel=1e-7)


def test_quadrants_add_up_to_the_whole() -> None:
    data = duty_dataset(
        table(), history(), lives={"a": RatedLife(40.0, 1e8), "b": RatedLife(40.0, 1e8)}
    )
    assert data["quadrant_time"].values.tolist() == [2.0, 1.0, 0.0, 3.0, 4.0]
    assert float(data["quadrant_lost_energy"].sum()) == pytest.approx(float(data["lost_energy"]))
    together = float(data["bearing_life"][0]) / 2.0 ** (1.0 / SCATTER[BALL])
    assert float(data["system_life"]) == pytest.approx(together, rel=1e-12)


def teeth(flank: float, root: float) -> Callable[[LoadHistory], xr.Dataset]:
    """Gives lives [s] of the working flank and of the root of gear 1; all others endure."""
    lives = {name: np.full((1, 2), math.inf) for name in ("flank", "back_flank", "root")}
    lives["flank"][0, 0], lives["root"][0, 0] = flank, root
    data = {f"{name}_life": (("mesh", "gear"), each) for name, each in lives.items()}
    coordinates = {"mesh": ["1"], "gear": ["gear 1", "gear 2"]}
    attributes = {"members": '["sun", "planet on sun"]'}
    return lambda _: xr.Dataset(data, coordinates, attributes)


def test_the_part_that_fails_first_is_the_one_of_the_shortest_life() -> None:
    bearing = {"output": RatedLife(40.0, 1e8)}
    data = duty_dataset(table(), history(), lives=bearing, teeth=teeth(9e9, 8e3))
    assert data.attrs["first_to_fail"] == "root of sun" and float(data["shortest_life"]) == 8e3
    assert data.attrs["parts_compared"] == 7 and data.attrs["left_out"] == "heat, wear"
    assert first_to_fail(data, 0.0).value == "root of sun"
    data = duty_dataset(table(), history(), lives=bearing, teeth=teeth(math.inf, math.nan))
    assert data.attrs["first_to_fail"] == "bearing output"
    assert float(data["shortest_life"]) == float(data["bearing_life"][0])
    assert data.attrs["parts_compared"] == 6
    assert data.attrs["left_out"] == "other teeth, heat, wear"
    endures = duty_dataset(table(), history(), teeth=teeth(math.inf, math.inf))
    assert endures.attrs["first_to_fail"] == "" and first_to_fail(endures, 0.0).value == "none"
    bare = duty_dataset(table(), history())
    assert math.isnan(float(bare["shortest_life"]))
    assert first_to_fail(bare, 0.0).detail == "not compared: teeth, bearings, heat, wear"


def test_lives_of_like_names_are_all_compared_and_unloaded_flanks_endure_nothing() -> None:
    lives = xr.Dataset(
        {"bearing_life": ("bearing", [1e7, 9e7])}, {"bearing": ["output", "bearing output"]}
    )
    assert first_failure(lives)[:3] == ("bearing output", 1e7, 2)
    both = {"flank_life": math.nan, "back_flank_life": math.inf, "root_life": math.nan}
    plastic = xr.Dataset(
        {name: (("mesh", "gear"), [[life]]) for name, life in both.items()},
        {"mesh": [""], "gear": ["gear 1"]},
        {"members": '["gear 1"]'},
    )
    assert first_failure(plastic).compared == 0
    assert "other teeth" in first_failure(plastic).left_out
    steel = plastic.map(lambda life: xr.full_like(life, 1e9)).assign_attrs(unrated=1)
    assert "other teeth" in first_failure(steel).left_out


def test_resistances_side_by_side_carry_together() -> None:
    table = HeatTable.model_validate(
        {
            "gears": "g",
            "bodies": {"g": {"heat_capacity": "9 J/K"}},
            "resistances": {
                "fan": {"between": ["g", "ambient"], "resistance": "1 K/W"},
                "plate": {"between": ["ambient", "g"], "resistance": "2 K/W"},
            },
        }
    )
    network = _heating(table).network
    assert network.steady({"g": 10.0})[0] - network.ambient == pytest.approx(10.0 / 1.5, rel=1e-12)


@pytest.mark.parametrize(("most", "fails"), [(1.0, "heat of drive"), (-1.0, "")])
def test_a_body_that_gets_too_hot_fails_at_once(most: float, fails: str) -> None:
    network = ThermalNetwork({"drive": 1e9}, {("drive", "ambient"): 0.8}, ambient=293.15)
    free = duty_dataset(table(), history(), heating=Heating(network, "drive"))
    hottest = float(free["body_temperature"].max())
    heating = Heating(network, "drive", limits={"drive": hottest - most})
    data = duty_dataset(table(), history(), heating=heating, teeth=teeth(math.inf, math.inf))
    assert data.attrs["first_to_fail"] == fails
    assert float(data["shortest_life"]) == (0.0 if fails else math.inf)


@pytest.mark.parametrize("ambient", [363.15, 263.15])
def test_oil_that_its_loss_heats_beyond_the_map_loses_as_at_its_edge(ambient: float) -> None:
    network = ThermalNetwork({"drive": 1e9}, {("drive", "ambient"): 0.01}, ambient=ambient)
    data = duty_dataset(table(), history(), heating=Heating(network, "drive"))
    edge = duty_dataset(
        table(), history().at_temperature(np.full(4, WARM if ambient > WARM else 293.15))
    )
    assert float(data["lost_energy"]) == pytest.approx(float(edge["lost_energy"]), rel=1e-12)
    assert abs(float(data["temperature"][0]) - ambient) < 0.2
    (told,) = doubts_of(data.attrs)
    assert re.search(r"oil at (90|-9).* is taken at (40|20) degC, the edge .* = \[\"", told)
    assert len(told.brief) <= BRIEF and "warnings" not in edge.attrs
    far = history()._replace(torque=np.full(4, 60.0))
    with pytest.raises(InputError, match="torque: 4 of 4 samples lie beyond the loss map"):
        duty_dataset(table(), far, heating=Heating(network, "drive"))


def test_limits_of_bodies_are_kelvins_of_bodies_that_are_there() -> None:
    network = ThermalNetwork({"drive": 1e9}, {("drive", "ambient"): 0.8})
    with pytest.raises(InputError, match="limits: the network has no body 'gear', but drive"):
        Heating(network, "drive", limits={"gear": 353.0})
    with pytest.raises(InputError, match=r"80 K, .* is no temperature of drive; plain numbers"):
        Heating(network, "drive", limits={"drive": 80.0})


def test_lines_of_endurance_give_the_cycles_that_teeth_bear() -> None:
    cycles, limits = np.array([1e5, 5e7, 1e10]), np.array([1600.0, 1000.0, 850.0])
    number = [
        cycles_to_failure(np.array(stress), cycles, limits)
        for stress in (1700.0, 1600.0, 1000.0, 900.0, 850.0, 840.0)
    ]
    slope = math.log(1e10 / 5e7) / math.log(1000.0 / 850.0)
    by_hand = [0.0, 1e5, 5e7, 5e7 * (1000.0 / 900.0) ** slope, 1e10, math.inf]
    np.testing.assert_allclose(number, by_hand, rtol=1e-12)


def test_curves_of_plastic_roots_give_the_cycles_that_they_bear() -> None:
    curve = np.array([20.0, 400.0, 0.2, 120.0])[:, None]
    number = cycles_on_curve(np.array([19.0, 20.0, 30.0, 60.0, 121.0, math.nan]), curve)
    by_hand = [math.inf, math.inf, 40.0**5, 10.0**5, 0.0, math.nan]
    np.testing.assert_allclose(number, by_hand, rtol=1e-12)
    assert np.isnan(cycles_on_curve(np.array([30.0]), np.full((4, 1), math.nan))).all()


def test_a_collective_keeps_way_and_mean_loads_of_a_history() -> None:
    few = load_classes(
        load_steps([1.0, 2.0, 3.0, 1.0], [5.0, -5.0, 5.0, 0.0], [2.0, -1.0, 2.0, 2.0], WARM)
    )
    assert sorted(zip(*few, strict=True)) == [(-5.0, 1.0, 2.0, WARM), (5.0, 2.0, 8.0, WARM)]
    two = load_steps([1.0, 1.0], 5.0, 2.0, [WARM, WARM + 8.0])
    assert load_classes(two).temperature.tolist() == [WARM + 4.0]
    assert load_classes(two, warm=True).temperature.tolist() == [WARM, WARM + 8.0]
    time = np.linspace(0.0, 10.0, 4001)
    waves = load_history(time, 30.0 * np.sin(time), 2.0 + np.cos(3.0 * time), WARM)
    many = load_classes(waves)
    assert many.way.size <= 2 * 48 * 6
    way = waves.duration * waves.speed
    for side in (-1.0, 1.0):
        counts, here = side * waves.torque > 0.03, side * many.torque > 0.0
        for power in (4.0, 6.6, 8.0, 8.7):
            asked = way[counts] @ np.abs(waves.torque[counts]) ** power
            assert many.way[here] @ np.abs(many.torque[here]) ** power == pytest.approx(
                asked, rel=3e-3
            )


def part(**attributes: object) -> xr.Dataset:
    """A march of wear under 40 N m at 1 rad/s that took 3e6 s to 20 um."""
    values = {"life_hours": ((), 3e6), "final_depth": ((), 2e-5)}
    return xr.Dataset(values, attrs={"law": "archard_1953", "end": "depth"} | attributes)


def test_lives_that_a_result_has_are_those_of_its_operating_point() -> None:
    generator = xr.Dataset({"bearing_life": ((), 1e7)}, attrs={"bearing": "wave generator"})
    planets = xr.Dataset({"bearing_life": ("pin", [2e7, 3e7])}, {"pin": ["pin 1", "pin 2"]})
    of = recorded_lives([generator, planets, xr.Dataset()], 40.0, 1.5)
    assert [*of.bearings] == ["wave generator", "bearing pin 1", "bearing pin 2"]
    there = load_steps([1.0], [-40.0], [1.5], WARM)
    assert of.bearings["bearing pin 2"].life(there) == pytest.approx(3e7, rel=1e-12)
    half = load_steps(
        [1.0, 1.0], [20.0, 30.0], [3.0, 0.0], WARM
    )  # half the load, twice as fast, rest
    assert of.bearings["wave generator"].life(half) == pytest.approx(8.0 * 1e7, rel=1e-12)
    averaged = generator.assign(operating_bearing_life=((), 4e6))
    assert recorded_lives([averaged], 40.0, 1.5).bearings["wave generator"].life(
        there
    ) == pytest.approx(4e6, rel=1e-12)
    each = dataset({"bearing_life": ((), 1e7)}, {}, title="limits", bearing="wave generator")
    stages = by_stage({1: each, 2: each})
    assert [*recorded_lives([stages], 40.0, 1.5).bearings] == [
        "wave generator, stage 1",
        "wave generator, stage 2",
    ]


def test_lives_over_another_duty_cycle_are_none_of_the_operating_point() -> None:
    """A case with [duty] has that cycle among its parts."""
    before = duty_dataset(table(), history(), lives={"output": RatedLife(40.0, 1e8)})
    assert not recorded_lives([before], 40.0, 1.5).bearings


def test_flanks_wear_with_the_load_times_the_way_of_the_side_that_bears() -> None:
    (worn,) = recorded_lives([part()], 40.0, 1.0).worn.values()
    assert worn.until_as_deep(load_steps([1.0], [40.0], [-1.0], WARM)) == pytest.approx(3e6)
    # 20 N m forwards over 2 rad and 30 N m backwards over 3 rad in 4 s: the second side is the worse.
    both = load_steps([1.0, 1.0, 2.0], [20.0, -30.0, 9.0], [2.0, 3.0, 0.0], WARM)
    life = 3e6 * 40.0 * 4.0 / (30.0 * 3.0)
    assert worn.until_as_deep(both) == pytest.approx(life, rel=1e-12)
    data = duty_dataset(table(), both, recorded=recorded_lives([part()], 40.0, 1.0))
    assert data.attrs["first_to_fail"] == "wear of flanks"
    assert float(data["wear_life"][0]) == pytest.approx(life, rel=1e-12)
    assert float(data["cycle_wear"][0]) == pytest.approx(2e-5 * 4.0 / life, rel=1e-12)
    assert data.attrs["left_out"] == "teeth, bearings, heat"


@pytest.mark.parametrize(
    ("attributes", "why"),
    [
        ({"law": "masjedi_khonsari_2015"}, "wear at other loads"),
        ({"end": "turns"}, "wear to a limit"),
        ({"end": "pressure"}, "wear to a pressure"),
        ({"end": "hardness"}, "wear to a pressure"),
        ({"end": "lost"}, "wear that is not solved"),
        ({"end": "outgrown"}, "wear that is not solved"),
    ],
)
def test_wear_without_a_life_is_told(attributes: dict[str, str], why: str) -> None:
    of = recorded_lives([part(**attributes)], 40.0, 1.0)
    data = duty_dataset(table(), history(), recorded=of)
    assert data.attrs["left_out"].endswith(why) and why in WITHOUT_LIFE
    assert math.isnan(float(data["shortest_life"]))
    if of.worn:  # how deep a cycle wears is known
        assert float(data["cycle_wear"][0]) > 0.0


@pytest.mark.parametrize(
    ("end", "why"),
    [
        ("lost", "wear that is not solved"),
        ("pressure", "wear to a pressure"),
        ("tip land", ""),
    ],
)
def test_a_march_that_ends_as_new_has_no_turns(end: str, why: str) -> None:
    at_once = part(end=end).assign(life_hours=((), 0.0), final_depth=((), 0.0))
    of = recorded_lives([at_once], 40.0, 1.0)
    data = duty_dataset(table(), history(), recorded=of)
    assert of.left_out == ((why,) if why else ())
    if why:
        assert not of.worn and data.attrs["left_out"].endswith(why)
        return
    assert data.attrs["first_to_fail"] == "wear of flanks" and float(data["shortest_life"]) == 0.0
    assert math.isnan(float(data["cycle_wear"][0]))


def test_energies_under_all_laws_stand_beside_the_first_where_none_is_chosen() -> None:
    two = table()._replace(
        loss_torques={
            "own": table().loss_torques["own"],
            "twice": (2.0 * np.array(table().loss_torques["own"])).tolist(),
            "locked": np.full((3, 3, 2), LOCKED).tolist(),
        }
    )
    data = duty_dataset(two, history(), case="x", variant="v")
    lost = float(data["lost_energy"])
    np.testing.assert_allclose(data["law_lost_energy"], [lost, 2.0 * lost, np.nan], rtol=1e-12)
    screen = [line.text for line in duty_screen(data, 80)]
    assert screen[0].endswith("friction own, first of 3 laws")
    (row,) = [line for line in screen if line.startswith("Energy lost")]
    assert "104 to 208 J by law, 1 without an answer" in row
    chosen = duty_dataset(two, history(), law="twice", case="x", variant="v")
    assert float(chosen["lost_energy"]) == pytest.approx(2.0 * lost)
    assert "law" not in chosen.dims
    assert duty_screen(chosen, 80)[0].text.endswith("friction twice")


def test_an_actuator_takes_what_its_motor_and_drive_lose_over_map_and_cycle() -> None:
    motor = Motor(torque_constant=0.1, resistance=0.5, iron_loss=0.01, largest_torque=0.9)
    steps = load_steps([1.0, 2.0], [30.0, 30.0], [1.0, -1.0], WARM)
    data = duty_dataset(table(), steps, motor=motor)

    def taken(load: float, speed: float) -> float:
        lost = (2.0 + 0.1 * abs(load)) * np.sign(speed)
        torque, turning = (load + lost) * RATIO, speed / RATIO
        copper = 0.5 * (1.0 + 20.0 * COPPER) * (torque / 0.1) ** 2
        return float(torque * turning + copper + 0.01 * abs(turning) ** 1.5)

    on, back = taken(30.0, 1.0), 2.0 * taken(30.0, -1.0)
    assert float(data["electrical_energy"]) == pytest.approx(max(on, 0.0) + max(back, 0.0))
    out, into = 30.0 + max(-back, 0.0), on + max(back, 0.0) + 60.0
    assert float(data["actuator_efficiency"]) == pytest.approx(out / into)
    assert float(data["drive_efficiency"]) == pytest.approx((30.0 + 2 * 25.0) / (35.0 + 60.0))
    there = data.sel(map_torque=50.0)
    assert np.isnan(
        there["map_electrical_power"].sel(map_speed=[0.0, 1.0])
    ).all()  # 1.14 N m of 0.9
    there = data.sel(map_torque=0.0, map_speed=10.0)
    assert float(there["map_electrical_power"]) == pytest.approx(taken(0.0, 10.0))
    assert np.isnan(there["map_actuator_efficiency"])
    there = data.sel(
        map_torque=-50.0, map_speed=1.0
    )  # the load and the motor both heat the winding
    assert float(there["map_electrical_power"]) == pytest.approx(taken(-50.0, 1.0))
    assert "Electrical energy" in "\n".join(
        line.text for line in duty_screen(data.assign_attrs(case="", variant=""), 80)
    )
