"""The joint that stands behind all exports to simulators, from the record of a result."""

import numpy as np
import pytest
import xarray as xr
from documentation import ROOT
from made_joints import RATIO, error, locking, made_joint, plain, rippling, strengths, torsion

from pitchpoint.cases.built_drive import MEETINGS
from pitchpoint.errors import InputError
from pitchpoint.results.by_stage import by_stage, of_stage
from pitchpoint.runs.joint_model import joint_model, part_of_map
from pitchpoint.runs.run import run_case


def test_torques_are_those_of_the_map_in_all_quadrants() -> None:
    joint = joint_model(made_joint())
    assert joint.ratio == pytest.approx(RATIO)
    assert joint.speed == pytest.approx(100.0 / 50.0)
    for torque, speed in ((30.0, 1.0), (30.0, -1.0), (-30.0, 4.0), (-10.0, -0.1)):
        way = np.sign(speed)
        lost = float(plain(np.array(way * torque), np.array(abs(speed)), np.array(40.0)))
        assert joint.loss_torque(torque, speed) == pytest.approx(lost, rel=1e-12)
        assert joint.driver_torque(torque, speed) == pytest.approx((torque + way * lost) / 50.0)
    with pytest.raises(
        InputError, match=r"60 K, .* is no temperature of an oil; plain numbers are in K"
    ):
        joint.holding_band(30.0, 60.0)
    rest = joint.holding_band(30.0, 333.15)
    assert (rest.lowest, rest.highest) == pytest.approx(
        ((30.0 - 5.6 * 0.96) / 50.0, (30.0 + 5.0 * 0.96) / 50.0)
    )
    assert joint.fit().driven_share == pytest.approx(0.12, rel=1e-2)  # of a map between its nodes


def test_what_the_result_has_is_there_with_units_and_the_rest_has_a_reason() -> None:
    joint = joint_model(made_joint(more={"torsion": torsion(), "kinematic_error": error()}))
    assert joint.wind_up is not None and joint.kinematic_error is not None
    assert (joint.wind_up.at_load, joint.wind_up.covers) == (1000.0, "teeth")
    assert (joint.hysteresis, joint.transmission_error) == (3e-5, pytest.approx(2e-4))
    assert joint.backlash == {"nominal": 2e-4}
    order, amplitude, phase, angle, turns = joint.kinematic_error
    assert order.tolist() == [2, 7]
    assert amplitude == pytest.approx([2e-4, 5e-5])
    assert phase == pytest.approx([0.5, -np.pi / 2.0])
    assert (angle, turns) == ("wave generator against circular spline", 1.0)
    of_gear = error().assign_attrs(turn_angle="angle of flexspline")
    waves = joint_model(made_joint(more={"kinematic_error": of_gear})).kinematic_error
    assert waves is not None and waves.turns == pytest.approx(1.0 / 50.0)
    assert joint.inertia is None and joint.armature == 0.0
    assert joint.lacks["inertia"] == "that of a body of the drive is not known"
    bare = joint_model(made_joint())
    assert (bare.wind_up, bare.lacks["wind_up"]) == (None, "the teeth are rigid")
    assert bare.lacks.keys() >= {"rotor_inertia", "backlash", "kinematic_error", "torque_ripple"}


def test_friction_ripples_as_the_torque_of_the_driver_over_a_mesh_cycle() -> None:
    joint = joint_model(made_joint(more=rippling()))
    assert joint.friction_waves is not None
    order, amplitude, phase, angle, turns = joint.friction_waves
    assert (order.tolist(), angle, turns) == ([40.0, 80.0], "angle of wave generator", 1.0)
    assert amplitude == pytest.approx([0.3, 0.1], rel=1e-6)
    assert phase == pytest.approx([-0.7, 0.2], rel=1e-6)
    smooth = rippling()
    smooth["cycle"]["input_torque"][:] = 0.5
    assert "less than 1 %" in joint_model(made_joint(more=smooth)).lacks["friction_waves"]


def test_friction_of_stages_ripples_at_the_orders_of_each() -> None:
    """The second stage turns a fifth as fast: 8 of its 40 cycles come in a turn of the driver."""
    two = rippling()
    two["cycle"] = by_stage({1: two["cycle"], 2: two["cycle"]})
    made = made_joint(more=two)
    each = {"bodies": "", "period": 2.0 * np.pi / 40.0}
    made.manifest["stages"] = [
        {**each, "number": number, "speed": speed} for number, speed in ((1, 100.0), (2, -20.0))
    ]
    waves = joint_model(made).friction_waves
    assert waves is not None
    assert waves.order == pytest.approx([8.0, 16.0, 40.0, 80.0])
    assert waves.amplitude == pytest.approx([0.3, 0.1, 0.3, 0.1], rel=1e-6)


def test_friction_of_a_set_behind_a_pair_ripples_over_the_period_of_the_set() -> None:
    """Its meshes, which have cycles by their bodies, turn together; the pair keeps its own cycle."""
    pair, turn = rippling()["cycle"], 2.0 * np.pi
    angle = pair["phase"].values * turn / 10.0
    of_set = xr.Dataset(
        {"driver_angle": ("node", angle), "weight": pair["weight"].variable}
        | {"input_torque": pair["input_torque"].variable},
        {"law": pair["law"].values},
        attrs=pair.attrs | {"driver_period": turn / 10.0},
    )
    parts = {
        "cycle": by_stage({1: pair, "2 (sun and planet)": pair, "2 (planet and ring)": pair}),
        "train_period": by_stage({2: of_set}),
    }
    made = made_joint(more=rippling() | parts)
    made.manifest["averaging"] = MEETINGS
    made.manifest["stages"] = [
        {"number": number, "bodies": bodies, "speed": speed, "period": turn / 40.0}
        for number, bodies, speed in (
            (1, "", 100.0),
            (2, "planetary set", -20.0),
            ("2 (sun and planet)", "sun and planet", -15.0),
        )
    ]
    waves = joint_model(made).friction_waves
    assert waves is not None
    assert waves.order == pytest.approx([2.0, 4.0, 40.0, 80.0])
    assert waves.amplitude == pytest.approx([0.3, 0.1, 0.3, 0.1], rel=1e-6)
    del made.parts["train_period"]
    assert joint_model(made).friction_waves is None


@pytest.mark.whole
def test_friction_of_sets_in_a_row_ripples_over_the_period_of_each() -> None:
    """From the record of a run: orders are those of the periods of a set in a turn of the first sun."""
    settings = {"loss_map.quadrants": 4}
    parts = ("operation", "train_period", "four_quadrants")
    drive = run_case(
        ROOT / "examples" / "two_planetary_sets.toml", analyses=parts, settings=settings
    )
    (outcome,) = drive.values()
    waves = joint_model(outcome).friction_waves
    assert waves is not None
    data, stages = outcome.parts["train_period"], outcome.manifest["stages"]
    speeds = {stage["number"]: abs(float(stage["speed"])) for stage in stages}
    lowest = [
        2.0 * np.pi / of_stage(data, number).attrs["driver_period"] * speeds[number] / speeds[1]
        for number in (1, 2)
    ]
    over = waves.order[:, None] / np.array(lowest)
    assert np.all(np.any(np.abs(over - np.round(over)) < 1e-9, axis=1))
    assert {*np.argmin(np.abs(over - np.round(over)), axis=1).tolist()} == {0, 1}
    del outcome.parts["train_period"]
    assert joint_model(outcome).friction_waves is None


def test_inertia_is_that_at_the_output_with_the_rotor_by_value() -> None:
    bodies = xr.Dataset({"reflected_inertia": ("end", [4e-5, 0.1])}, {"end": ["input", "output"]})
    made = made_joint(more={"bodies": bodies})
    joint = joint_model(made, rotor_inertia="0.2 kg cm2")
    assert joint.armature == pytest.approx(0.1 + 2e-5 * 2500.0)
    assert joint_model(made, rotor_inertia=2e-5).armature == pytest.approx(joint.armature)
    pair = made_joint(more={"inspection": xr.Dataset({"disc_inertia": ("gear", [1e-4, 0.3])})})
    pair.manifest["members"] = ["wave generator", "flexspline"]
    pair.manifest["motion"] = [1.0, 1.0 / RATIO]
    assert joint_model(pair).inertia == pytest.approx(0.3 + 1e-4 * 2500.0)
    with pytest.raises(InputError, match="rotor_inertia") as refused:
        joint_model(made, rotor_inertia="0.2 mm")
    assert refused.value.key == "rotor_inertia"


def test_a_joint_that_locks_has_no_number_where_the_load_drives() -> None:
    joint = joint_model(made_joint(locking))
    assert np.isnan(joint.loss_torque(-30.0, 1.0))
    assert joint.holding_band(30.0).locked
    drives, driven = joint.errors(lambda torque, speed, degree: 0.0 * torque)
    assert driven.points == 0 < driven.locked
    assert drives.locked == 0


def test_ranges_that_somebody_names() -> None:
    joint = joint_model(made_joint())
    within = part_of_map(joint, "5 N m:30 N m", "10 rpm:30 rpm")
    assert within is not None
    assert within.torque == (5.0, 30.0)
    assert within.speed == pytest.approx((np.pi / 3.0, np.pi))
    assert within.temperature == (313.15, 313.15)
    assert part_of_map(joint) is None
    for told, texts in (
        ("beyond the map, which ends at 60 N m", ("5 N m:90 N m", None)),
        ("is no range", ("5 N m", None)),
        ('"30 N m: 5 N m" goes from high to low; write "5 N m:30 N m"', ("30 N m: 5 N m", None)),
        ("begins where it ends", ("5 N m:5 N m", None)),
        ("begins at 0.01 rad/s", (None, "0.001 rad/s:0.002 rad/s")),
        ("beyond the map, which ends at 4 rad/s", (None, "1 rpm:900 rpm")),
    ):
        with pytest.raises(InputError, match=told):
            part_of_map(joint, *texts)


def test_a_result_without_the_map_says_how_to_get_it() -> None:
    made = made_joint()
    del made.parts["four_quadrants"]
    with pytest.raises(InputError, match=r"pitchpoint run made\.toml --set loss_map\.quadrants=4"):
        joint_model(made)
    with pytest.raises(
        InputError, match=r"\"mad\" is not a friction law of this result; did you mean made\?"
    ):
        joint_model(made_joint(), law="mad")


def test_bearings_limit_the_torque_by_their_ratings() -> None:
    """The least of all places, and a wave generator by the torque on its flexspline."""
    margins = {
        "static_torque_margin": [2.5, np.nan, np.inf],
        "life_torque_margin": [0.9, 1.2, np.inf],
    }
    dims = ("law", "point", "place")
    point = xr.Dataset({name: (dims, [[row]]) for name, row in margins.items()})
    parts = strengths()
    parts["load_limits"]["rated_life_torque"] = 17.0
    joint = joint_model(made_joint(more={"operation": point, **parts}))
    bearing = {name: torque for name, torque in joint.part_limits.items() if "bearing" in name}
    assert bearing == pytest.approx(
        {
            "static_bearing_torque": 50.0,
            "lasting_bearing_torque": 18.0,
            "rated_bearing_torque": 17.0,
        }
    )
    assert joint.torque_limit == pytest.approx(17.0)


def test_parts_limit_the_torque_where_the_record_has_them() -> None:
    """Flanks by the square of their safety, roots and margins by themselves, at the load of operation."""
    joint = joint_model(made_joint(more=strengths()))
    assert joint.part_limits == pytest.approx(
        {
            "flank_torque": 28.8,
            "root_torque": 30.0,
            "flexspline_torque": 64.0,
            "ratcheting_torque": 40.0,
        }
    )
    assert joint.torque_limit == pytest.approx(28.8)
    assert "limit by ratcheting: 40 N m of the output" in joint.lines()
    bare = joint_model(made_joint())
    assert bare.part_limits == {} and bare.torque_limit == 60.0
    weak = strengths()
    weak["load_limits"]["goodman_torque"][:] = -1.0  # bending alone breaks it
    assert "flexspline_torque" not in joint_model(made_joint(more=weak)).part_limits
