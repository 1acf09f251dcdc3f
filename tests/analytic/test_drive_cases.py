"""Drives of several meshes from a case file, beside their stages from files of their own."""

import tomllib
from functools import cache

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import jnp
from pitchpoint.analyses.analysis import Subject
from pitchpoint.analyses.analysis_registry import (
    ANALYSES,
    FOUR_QUADRANTS,
    INSPECTION,
    REFLECTED,
    TORSION,
)
from pitchpoint.analyses.loss_map import LOSS_MAP
from pitchpoint.analyses.operation import BACK_DRIVING, LAWS_THERE, OPERATION
from pitchpoint.cases.built_drive import BuiltDrive
from pitchpoint.cases.variant import Variant
from pitchpoint.efficiency.drive import drive_cycle
from pitchpoint.efficiency.drive_summary import points_per_batch
from pitchpoint.errors import InputError
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.results.netcdf import decode, encode

COMMON = """
[lubricant]
name = "pao-vg-150"
[roughness]
ra = "0.4 um"
[operation]
torque = "300 N m"
speed = "1500 rpm"
temperature = "60 degC"
[models.friction]
name = "constant"
coefficient = 0.06
[loss_map]
torque = "300 N m"
speed = "1500 rpm"
temperatures = ["60 degC"]
count = 2
"""
FIRST = "teeth = [23, 61]\nmodule = '2 mm'\nface_width = '18 mm'\n"
SECOND = "teeth = [19, 70]\nmodule = '3 mm'\nface_width = '30 mm'\n"
TWO = f"[[stages]]\n[stages.gears]\n{FIRST}[[stages]]\n[stages.gears]\n{SECOND}{COMMON}"
RATIOS = 61 / 23, 70 / 19
RATIO = RATIOS[0] * RATIOS[1]
SPEED, LOAD = 1500.0 * np.pi / 30.0, 300.0


def built(text, **settings):
    return Variant(tomllib.loads(text), "drive.toml", "default", settings).built({})


@cache
def two():
    return built(TWO)


def part(analysis, case, piece=None):
    return analysis.compute(case, piece or {}, lambda _: None)


def of_every_stage(analysis, case):
    """Part of an analysis of a mesh of every stage that has it."""
    (made,) = analysis.parts(Subject(None, case))
    on_disk = [decode(encode(part(made, case, piece))) for piece in made.pieces(case)]
    return made.joined(case, on_disk)


@cache
def operation():
    return part(OPERATION, two())


def alone(gears, **settings):
    """A stage in a file of its own."""
    return built(f"[gears]\n{gears}{COMMON}", **settings)


def figure(data, name):
    return float(data[name].values[0, 0])


def stages(*gears):
    return "".join(f"[[stages]]\n[stages.gears]\n{one}" for one in gears)


def test_the_second_stage_turns_the_other_way_and_so_presses_its_right_flanks():
    case = two()
    assert [one.case.gears.flank for one in case.stages] == ["left", "right"]
    np.testing.assert_allclose(case.motion, [1.0, -1.0 / RATIOS[0], 1.0 / RATIO], rtol=1e-14)
    assert [one.case.operation.load for one in case.stages] == pytest.approx(
        [LOAD / RATIOS[1], LOAD]
    )
    assert case.stages[1].case.operation.speed == pytest.approx(SPEED / RATIOS[0])


def test_a_ring_needs_no_other_flank():
    ring = "teeth = [20, -61]\nmodule = '2 mm'\nface_width = '18 mm'\naddendum = [1.0, 0.8]\n"
    case = built(TWO.replace(FIRST, ring))
    assert [one.case.gears.flank for one in case.stages] == ["left", "left"]


@eqx.filter_jit
def meetings(drive, operation, models):
    found = drive_cycle(drive, operation, models, nodes=4, few=None)
    first, last = (jnp.squeeze(one.loss) for one in found.states)
    out = jnp.squeeze(found.states[-1].output_power)[..., None]
    return jnp.squeeze(found.input_torque), first + last[..., None], out


def test_torque_route_equals_loss_route_at_every_meeting_of_phases():
    case = two()
    at_meetings = meetings(case.design, case.operation, case.models[0].stages)
    torque, lost, out = map(np.asarray, at_meetings)
    assert torque.shape == (12, 12)
    rounding = 1e-14 * np.max(torque * SPEED)
    np.testing.assert_allclose(torque * SPEED - out, lost, rtol=1e-10, atol=rounding)


@pytest.mark.whole
def test_with_a_constant_coefficient_the_efficiency_is_the_product_of_those_of_the_stages():
    slow = f"{1500.0 / RATIOS[0]!r} rpm"
    second = {"operation.speed": slow, "gears.flank": "right"}
    cases = alone(FIRST, **{"operation.torque": "81 N m"}), alone(SECOND, **second)
    first, last = (figure(part(OPERATION, one), "mean_efficiency") for one in cases)
    data = operation()
    assert figure(data, "mean_efficiency") == pytest.approx(first * last, rel=1e-12)
    np.testing.assert_allclose(data["stage_efficiency"].values[0, 0], [first, last], rtol=1e-12)


def test_losses_of_the_stages_are_what_goes_in_and_does_not_come_out():
    data = operation()
    put_in = figure(data, "mean_input_torque") * SPEED
    lost = figure(data, "mean_loss")
    assert put_in - LOAD * SPEED / RATIO == pytest.approx(lost, rel=1e-10)
    assert float(data["stage_loss"].sum()) == pytest.approx(lost, rel=1e-12)
    ripple = figure(data, "max_input_torque") - figure(data, "min_input_torque")
    assert figure(data, "torque_ripple") == pytest.approx(ripple, rel=1e-12)
    assert figure(data, "mean_friction") == pytest.approx(0.06, rel=1e-12)


def test_one_stage_is_the_plain_case():
    case = built(f"[[stages]]\n[stages.gears]\n{FIRST}{COMMON}")
    plain = alone(FIRST)
    assert isinstance(case, BuiltDrive)
    assert (case.driver, case.loaded) == ("shaft 1", "shaft 2")
    back = case.backwards
    assert (back.driver, back.loaded) == ("shaft 2", "shaft 1")
    found, beside = part(OPERATION, case), part(OPERATION, plain)
    shared = [name for name in found if name in beside]
    assert {"mean_efficiency", "torque_ripple", "min_efficiency", "mean_friction"} <= {*shared}
    for name in shared:
        np.testing.assert_allclose(found[name], beside[name], rtol=1e-12, atol=1e-15, err_msg=name)


def test_the_loss_map_is_the_operating_point_at_its_node():
    case, data = two(), operation()
    pieces = LOSS_MAP.pieces(case)
    whole = LOSS_MAP.joined(case, [part(LOSS_MAP, case, piece) for piece in pieces])
    for name in ("mean_loss", "mean_efficiency"):
        corner = float(whole[name].values[0, -1, -1, 0])
        assert corner == pytest.approx(figure(data, name), rel=1e-12)
    assert np.isnan(whole["mean_efficiency"].values[0, 0, 0, 0])
    assert not whole["mean_loss"].values[0, :, 0].any()


def test_the_map_of_the_output_is_the_drive_forwards_and_backwards():
    case = built(TWO, **{"loss_map.quadrants": 4})
    pieces = FOUR_QUADRANTS.pieces(case)
    data = FOUR_QUADRANTS.joined(case, [part(FOUR_QUADRANTS, case, piece) for piece in pieces])
    corner = data.isel(law=0, temperature=0, output_torque=-1)
    assert float(corner["output_torque"]) == LOAD
    for end, sign in ((-1, 1.0), (0, -1.0)):
        speed = float(corner["output_speed"][end])
        assert speed == pytest.approx(sign * SPEED / RATIO, rel=1e-12)
        loss = float(corner["mean_loss"][end])
        torque = float(corner["mean_input_torque"][end])
        assert torque * sign * SPEED == pytest.approx(LOAD * speed + loss, rel=1e-12)
    assert float(corner["mean_loss"][-1]) == pytest.approx(
        figure(operation(), "mean_loss"), rel=1e-12
    )
    # With a constant coefficient neither efficiency asks for the torque.
    back = figure(part(BACK_DRIVING, case), "mean_efficiency")
    assert float(corner["mean_efficiency"][0]) == pytest.approx(back, rel=1e-9)


def test_the_drive_backwards_locks_before_it_does_forwards():
    shifted = {"stages.1.gears.profile_shift": [0.3, 0.1], "stages.2.gears.profile_shift": [0.4, 0]}
    case = built(TWO, **shifted)
    data = part(BACK_DRIVING, case)
    assert not data["locked"].values.any()
    assert data["stage"].values.tolist() == [2, 1]
    limit = figure(data, "jamming_coefficient")
    assert limit < figure(part(OPERATION, case), "jamming_coefficient")
    level = "models.friction.coefficient"
    locked = {
        factor: part(BACK_DRIVING, built(TWO, **shifted, **{level: factor * limit}))
        for factor in (0.999, 1.001)
    }
    assert not locked[0.999]["locked"].values.any()
    assert locked[1.001]["locked"].values.all()
    assert np.isnan(figure(locked[1.001], "mean_efficiency"))


RACK = "family = 'rack_and_pinion'\nteeth = 20\nmodule = '3 mm'\nface_width = '29 mm'\n"


@pytest.mark.whole
def test_figures_of_a_drive_that_a_rack_drives_have_one_unit_each():
    case = built(stages(FIRST, RACK) + COMMON.replace('torque = "300 N m"', 'force = "3000 N"'))
    assert (case.driver, case.loaded) == ("shaft 1", "shaft 3")
    data = part(BACK_DRIVING, case)
    assert data["mean_input_torque"].attrs["units"] == "N"
    of_drivers = {"stage_input_torque", "stage_speed"}
    assert of_drivers <= {*operation()}
    assert not of_drivers & {*data}
    assert float(data["stage_loss"].sum()) == pytest.approx(figure(data, "mean_loss"), rel=1e-12)


def test_a_loss_map_stays_in_the_range_of_all_oils():
    hot = {"loss_map.temperatures": ["60 degC", "300 degC"]}
    with pytest.raises(InputError, match=r"loss_map.temperatures: 300 degC is outside the range"):
        built(TWO, **hot)


def test_no_other_friction_law_is_tried_where_all_stages_have_their_own():
    own = {"name": "constant", "coefficient": 0.05}
    first = {"stages.1.models.friction": own}
    assert LAWS_THERE.why_not(built(TWO, **first)) is None
    told = LAWS_THERE.why_not(built(TWO, **first, **{"stages.2.models.friction": own}))
    assert told.startswith("every stage has a friction law of its own")
    assert LAWS_THERE.shown({})["friction_laws"] == {}


HELICAL = f"{FIRST}helix_angle = '15 deg'\n"


COMMON_BEARING = """[losses.{0}]
between = ["shaft {0}", "housing"]
bearing = "palmgren_1959"
mean_diameter = "37 mm"
f0 = 2.0
f1 = 0.0003
"""


def size(case):
    return points_per_batch(case.design, case.models[0].stages)


@pytest.mark.whole
def test_points_together_follow_from_the_memory_of_their_meetings():
    assert size(two()) == 8
    five = stages(*[HELICAL] * 5) + COMMON
    slices = {"models.slices": 48.0}
    assert size(built(five)) == size(built(five, **slices)) == 8
    bearings = "".join(map(COMMON_BEARING.format, range(2, 6)))
    assert 1 <= size(built(five + bearings, **slices)) < 8
    with pytest.raises(InputError, match=r"stages: .* take fewer slices"):
        size(built(five + bearings, **{"models.slices": 400.0}))


@pytest.mark.parametrize("member", [0, 1])
def test_axial_forces_on_a_shaft_counteract_but_for_those_of_two_gears_of_one_number(member):
    driver = {"stages.2.driver": f"gear {member + 1}"}
    case = built(stages(HELICAL, HELICAL) + COMMON, **driver)
    told = [text for text in case.told if "axial forces" in text]
    thrusts = [thrust(case.stages[0], 1), thrust(case.stages[1], member)]
    assert bool(told) == (thrusts[0] * thrusts[1] > 0.0) == (member == 1)
    assert not [text for text in told if not text.startswith("On shaft 2 the helical gear 2s of")]


def thrust(one, member):
    """Axial component of the normals that press on a member of a stage."""
    contacts = eqx.filter_jit(type(one.design.mesh).contacts)(one.design.mesh, jnp.zeros(1))
    return (-1.0, 1.0)[member] * float(np.sum(contacts.direction[2] * contacts.active))


@pytest.mark.whole
def test_stiffness_at_the_output_is_that_of_springs_in_series():
    by_stiffness = {"models.load_sharing": "from_stiffness"}
    whole = part(TORSION, built(TWO, **by_stiffness))
    load = f"{LOAD / RATIOS[1]!r} N m"
    first = part(TORSION, alone(FIRST, **by_stiffness, **{"operation.torque": load}))
    second = part(TORSION, alone(SECOND, **by_stiffness, **{"gears.flank": "right"}))
    springs = [one["torsional_stiffness"].values for one in (first, second)]
    series = 1.0 / (1.0 / (springs[0] * RATIOS[1] ** 2) + 1.0 / springs[1])
    np.testing.assert_allclose(whole["torsional_stiffness"], series, rtol=1e-10)
    turned = first["wind_up"].values / RATIOS[1] + second["wind_up"].values
    np.testing.assert_allclose(whole["wind_up"], turned, rtol=1e-10)
    np.testing.assert_allclose(whole["stage_wind_up"].sum("stage"), turned, rtol=1e-10)


def test_torsion_says_which_stage_does_not_yield():
    assert TORSION.why_not(two()).startswith("stage 1: nothing in the case asks how teeth yield")
    one = {"stages.1.models.load_sharing": "from_stiffness"}
    assert TORSION.why_not(built(TWO, **one)).startswith("stage 2: ")


WAVE = """[stages.gears]
family = "strain_wave"
teeth = [100, 102]
module = "0.4 mm"
face_width = "10 mm"
[stages.losses.inside]
between = ["wave generator", "flexspline"]
seal_torque = "0.02 N m"
"""


@pytest.mark.whole
def test_a_spur_pair_before_a_strain_wave_gear_keeps_its_power():
    text = f"[[stages]]\n[stages.gears]\n{FIRST}[[stages]]\n{WAVE}{COMMON}"
    text = text.replace("300 N m", "25 N m")
    case = built(text)
    # The wave generator turns positively, so the pinion before it turns the other way.
    assert case.stages[0].case.gears.flank == "right"
    np.testing.assert_allclose(case.motion, [-1.0, 23 / 61, -23 / 61 / 50], rtol=1e-12)
    data = part(OPERATION, case)
    put_in, out = figure(data, "mean_input_torque") * SPEED, 25.0 * SPEED * 23 / 61 / 50
    assert put_in - out == pytest.approx(figure(data, "mean_loss"), rel=1e-10)
    inside = 0.02 * SPEED * 23 / 61 * (1.0 + 1.0 / 50)
    np.testing.assert_allclose(data["stage_drag_loss"].values[0, 0], [0.0, inside], rtol=1e-10)
    assert case.places == ["stage 2 inside"]


def test_all_stages_before_one_of_a_single_sense_turn_over():
    ring = "teeth = [20, -61]\nmodule = '2 mm'\nface_width = '18 mm'\naddendum = [1.0, 0.8]\n"
    first, second = (f"[[stages]]\n[stages.gears]\n{gears}" for gears in (FIRST, ring))
    case = built(f"{first}{second}[[stages]]\n{WAVE}{COMMON}")
    # A ring turns as its pinion does; both turn positively where the first pinion does not.
    assert [one.case.gears.flank for one in case.stages[:2]] == ["right", "left"]
    assert np.sign(case.motion).tolist() == [-1.0, 1.0, 1.0, -1.0]
    held = f"{first}flank = 'left'\n[[stages]]\n{WAVE}{COMMON}"
    with pytest.raises(InputError, match=r"stages.2.gears: .* for one sense of rotation alone"):
        built(held)


def test_few_meetings_of_phases_are_told():
    assert not [text for text in two().warnings if "meet" in text]
    text = TWO.replace("[23, 61]", "[23, 60]").replace("[19, 70]", "[20, 70]")
    (told,) = [text for text in built(text).warnings if "meet" in text]
    assert told.startswith("On shaft 2 60 and 20 teeth mesh in a turn, with the common divisor 20")


TOLERANCES = "[stages.gears.inspection]\nthickness_field = 'cd25'\n"
TIGHT = (
    f"[[stages]]\n[stages.gears]\n{FIRST}{TOLERANCES}[[stages]]\n[stages.gears]\n{SECOND}{COMMON}"
)


def test_a_stage_is_inspected_as_in_a_file_of_its_own():
    whole = decode(encode(of_every_stage(INSPECTION, built(TIGHT))))
    assert whole["over_balls"].dims == ("stage", "gear", "limit")
    assert stages_of(whole) == (1, 2)
    assert np.isnan(whole["over_balls"].sel(stage=2, limit=["upper", "lower"])).all()
    inspection = {"gears.inspection.thickness_field": "cd25"}
    for number, alike in ((1, alone(FIRST, **inspection)), (2, alone(SECOND))):
        expected = part(INSPECTION, alike)
        there = of_stage(whole, number)
        for name, values in expected.variables.items():
            if values.dtype.kind == "f":
                np.testing.assert_allclose(there[name], values, rtol=1e-12, err_msg=name)
            else:
                assert there[name].values.tolist() == values.values.tolist(), name
            assert there[name].attrs == values.attrs, name
        assert there.attrs == expected.attrs


def test_backlash_and_inertia_of_the_stages_count_by_the_squares_of_their_ratios():
    case = built(TIGHT)
    data, each = part(REFLECTED, case), of_every_stage(INSPECTION, case)
    first, second = (of_stage(each, number) for number in (1, 2))
    (nominal,) = second["backlash_angle"].sel(gear="gear 2").values
    at_output = first["backlash_angle"].sel(gear="gear 2").values / RATIOS[1] + nominal
    np.testing.assert_allclose(data["output_backlash"], at_output, rtol=1e-12)
    assert at_output[3] > at_output[1] > at_output[0]
    (pinion, wheel), (driving, driven) = first["disc_inertia"].values, second["disc_inertia"].values
    felt = pinion + (wheel + driving) / RATIOS[0] ** 2 + driven / RATIO**2
    at_ends = [felt, felt * RATIO**2]
    np.testing.assert_allclose(data["reflected_inertia"], at_ends, rtol=1e-12)
    np.testing.assert_allclose(data["reflected_part"].sum("body"), at_ends, rtol=1e-12)
    masses = [*first["disc_mass"].values, *second["disc_mass"].values]
    assert float(data["drive_mass"]) == pytest.approx(sum(masses), rel=1e-12)


def test_what_is_of_each_mesh_is_there_where_one_of_them_has_it():
    lacks = {name: analysis.why_not(two()) for name, analysis in ANALYSES.items()}
    assert lacks["inspection"] is None
    assert lacks["load_limits"] == "a flexspline is that of a strain wave gear"
    assert lacks["vibration"] == "the case has no [dynamics]"
    assert ANALYSES["reflected"].why_not(alone(FIRST)) is not None


SPEEDS = {"start": "2000 rpm", "stop": "3000 rpm", "count": 2}
DYNAMICS = "[stages.dynamics]\nspeeds = { start = '2000 rpm', stop = '3000 rpm', count = 2 }\n"


def test_the_cycle_of_each_mesh_is_that_under_the_torque_that_it_carries():
    """What drives a stage, in the mean over its cycle, is what the stage before it carries."""
    case = two()
    whole = of_every_stage(ANALYSES["cycle"], case)
    for k, number in enumerate((1, 2)):
        data, mesh = of_stage(whole, number), case.at_work[k]
        assert data["pressure"].values == pytest.approx(
            part(ANALYSES["cycle"], mesh)["pressure"].values, rel=1e-12
        )
        mean = np.average(data["input_torque"].values[0], weights=data["weight"].values)
        assert mean == pytest.approx(operation()["stage_input_torque"].values[0, 0, k], rel=1e-9)


def test_each_stage_vibrates_as_in_a_file_of_its_own():
    text = (
        f"[[stages]]\n[stages.gears]\n{FIRST}{DYNAMICS}[[stages]]\n[stages.gears]\n{SECOND}{COMMON}"
    )
    case = built(text)
    (told,) = [text for text in case.warnings if "vibrates by itself" in text]
    assert told.startswith("Each stage")
    whole = of_every_stage(ANALYSES["resonance"], case)
    assert stages_of(whole) == (1,)
    carried = case.at_work[0].case.operation.load
    inside = {"operation.torque": f"{carried!r} N m", "dynamics.speeds": SPEEDS}
    apart = part(ANALYSES["resonance"], alone(FIRST, **inside))
    for name in ("transmission_error_range", "largest_dynamic_factor"):
        assert of_stage(whole, 1)[name].values == pytest.approx(apart[name].values, rel=1e-12)


def test_a_mesh_at_work_carries_what_drives_the_stage_behind_it():
    case = two()
    first, last = case.at_work
    driving = operation()["stage_input_torque"].values[0, 0]
    assert first.case.operation.load == pytest.approx(driving[1], rel=1e-12)
    assert first.case.operation.load > 1.002 * case.stages[0].case.operation.load
    assert last is case.stages[1]
