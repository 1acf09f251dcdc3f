"""Case files of planetary sets and other trains: what they compute, what they say of a wrong number."""

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint.analyses.duty import rated_lives
from pitchpoint.analyses.inspection import inspection_part
from pitchpoint.analyses.registry import ANALYSES
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.analyses.tooth_life import mesh_member_names
from pitchpoint.analyses.train_period import over_period
from pitchpoint.cases.variant import Variant
from pitchpoint.doubts import doubts_of
from pitchpoint.drive.kinematics import Ends, Link
from pitchpoint.drive.thrusts import axial_loads
from pitchpoint.drive.torques import train_torques
from pitchpoint.duty_cycle.history import load_steps
from pitchpoint.efficiency import train_summary
from pitchpoint.errors import InputError
from pitchpoint.runs.run import load_case
from pitchpoint.views.registry import TRAIN, in_order
from pitchpoint.views.section import key_figures
from pitchpoint.views.train_picture import train_pictures

EXAMPLES = Path(__file__).parents[2] / "examples"
TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "60 N m", "speed": "3000 rpm", "temperature": "60 degC"},
    "models": {"friction": {"name": "constant", "coefficient": 0.05}},
}
SET = {
    "family": "planetary",
    "teeth": [24, 30, 84],
    "planets": 3,
    "module": "1 mm",
    "face_width": "12 mm",
}
PLANETARY = {"gears": SET, **TABLES}


def gears(teeth, **more):
    return {"teeth": teeth, "module": "1 mm", "face_width": "10 mm", "fillet_radius": 0.2, **more}


THREE_K = {
    "stages": [
        {"bodies": ["sun", "planet"], "gears": gears([18, 36])},
        {"bodies": ["planet", "ring"], "gears": gears([36, -90])},
        {"bodies": ["planet", "output ring"], "gears": gears([34, -88])},
    ],
    "train": {"input": "sun", "output": "output ring", "held": "ring", "planets": 3},
    **TABLES,
}


SHIFTED = {"teeth": [24, 29, 84], "profile_shift": [0.3, 0.3, "from centre distance"]}
STEPPED = {
    "teeth": [18, 36],
    "helix_angle": "15 deg",
    "second": {"teeth": [24, 78], "face_width": "10 mm"},
}
FRICTIONLESS = {"models.friction.coefficient": 0.0}

PIN = {
    "between": ["planet", "carrier"],
    "bearing": "palmgren_1959",
    "mean_diameter": "12 mm",
    "f0": 4.0,
    "f1": 0.003,
}


def figures(tree, **settings):
    built = load_case(tree, settings={key.replace("__", "."): v for key, v in settings.items()})
    found = built.figures_of([(built.design, built.operation)], built.models[0])
    return built, {name: values[0] for name, values in found.items()}


def test_a_set_from_its_tooth_numbers():
    """The efficiency is that of an independent computation tooth by tooth, torque and speeds are Willis'."""
    built, found = figures(PLANETARY)
    assert found["mean_efficiency"] == pytest.approx(0.99114646, rel=3e-6)
    assert dict(zip(built.case.bodies, built.motion, strict=True)) == pytest.approx(
        {"sun": 1.0, "planet": -0.4, "ring": 0.0, "carrier": 24 / 108}
    )
    sun, ring = built.stages
    against = 84 / 108  # of the speed of the sun, that against the carrier
    assert sun.case.operation.speed == pytest.approx(np.pi * 100 * against)
    assert ring.case.operation.speed == pytest.approx(np.pi * 100 * against * 24 / 30)
    assert ring.case.operation.torque == pytest.approx(60 * 84 / 108 / 3)
    assert found["stage_loss"].sum() == pytest.approx(found["mean_loss"], rel=1e-12)


@pytest.mark.whole
def test_meshes_carry_more_by_the_losses_behind_them():
    built, found = figures(PLANETARY)
    without, work = (
        [one.case.operation.torque for one in every] for every in (built.stages, built.at_work)
    )
    assert without[0] < work[0] < without[0] / found["mean_efficiency"]
    # What the ring holds and what the sun puts in is what the carrier gives.
    held = 3 * work[1]
    assert held + found["mean_input_torque"] == pytest.approx(60.0, rel=1e-9)


def test_power_that_rolls_through_the_meshes():
    """Against the carrier, by Willis with the efficiencies of the meshes; of a 3K many times the input."""
    built, found = figures(PLANETARY)
    power = found["mean_input_torque"] * built.case.operation.speed
    against = 84 / 108  # of the speed of the sun
    first = found["stage_efficiency"][0]
    expected = power * against * np.array([1.0, first])
    assert found["stage_latent_power"] == pytest.approx(expected, rel=1e-9)
    built, found = figures(THREE_K)
    power = found["mean_input_torque"] * built.case.operation.speed
    sun, _, output = found["stage_efficiency"]
    one, two = 90 / 18, 90 * 34 / (36 * 88)
    given = power * found["mean_efficiency"] * two / (1.0 - two)  # by the output ring
    held = power * sun * one / (1.0 + one) + given * output  # by the planets to the held ring
    expected = [power * one / (1.0 + one), held, given]
    assert found["stage_latent_power"] == pytest.approx(expected, rel=1e-9)
    assert found["latent_power"] == pytest.approx(sum(expected), rel=1e-9)
    assert found["latent_power"] > 50.0 * power


@pytest.mark.whole
def test_planets_that_either_flank_of_an_idle_sun_pushes_onto_the_other_one_lie_on_neither():
    """Two equal rings turn each other at ratio 1; their friction alone presses three planets on the sun."""
    equal = {"teeth": [44, 130], "module": "0.5 mm", "face_width": "7.54 mm"}
    rings = SET | {
        "teeth": [41, 44, 130],
        "module": "0.5 mm",
        "profile_shift": [0.175, 0.203],
        "fillet_radius": [0.3, 0.2, 0.1],
        "second": equal | {"profile_shift": [0.215, "from centre distance"]},
        "input": "second ring",
        "output": "ring",
        "held": "sun",
    }
    built, found = figures(PLANETARY | {"gears": rings}, models__friction__coefficient=0.1121)
    speed = built.case.operation.speed
    assert built.output_rate == pytest.approx(1.0, rel=1e-12)
    taken = found["mean_input_torque"] * speed
    assert taken == pytest.approx(60.0 * speed + found["mean_loss"], rel=1e-12)
    assert 0.99 < found["mean_efficiency"] < 1.0 and not found["locked"]
    # A mesh that carries nothing without friction has no force to compare with.
    assert 1.0 <= found["largest_contact_force_ratio"] < 1.2


def test_other_flows_planets_and_teeth_take_the_programs_that_are_there():
    """All six flows of a set are one program, and so are 3K sets whose planets come round in like times."""

    def program_count(tree):
        figures(tree)
        return len(train_summary._figures.ready)

    there = program_count(PLANETARY)
    for turned, loaded, held in permutations(("sun", "carrier", "ring")):
        roles = {"input": turned, "output": loaded, "held": held}
        assert program_count({**PLANETARY, "gears": SET | roles}) == there
    assert (
        program_count({**PLANETARY, "gears": SET | {"teeth": [25, 29, 83], "planets": 4}}) == there
    )
    there = program_count(THREE_K)
    held = {"train": {**THREE_K["train"], "output": "ring", "held": "output ring"}}
    assert program_count(THREE_K | held) == there
    other = [[18, 38], [38, -94], [36, -92]]
    stages = [
        one | {"gears": gears(teeth)} for one, teeth in zip(THREE_K["stages"], other, strict=True)
    ]
    train = THREE_K["train"] | {"planets": 2}
    assert program_count(THREE_K | {"stages": stages, "train": train}) == there


def test_planets_are_pulled_outwards_by_the_mass_of_their_gears():
    """Discs of the inspection, both of a stepped planet."""
    second = {"teeth": [24, 78], "face_width": "10 mm"}
    of_two = {**SET, "teeth": [18, 36], "second": second}
    for gears, distance in ((SET, 27e-3), (of_two, 27e-3)):
        built = load_case({"gears": gears, **TABLES})
        first, last = (inspection_part(mesh)["disc_mass"].values for mesh in built.meshes)
        mass = max(first[1], last[0]) if gears is SET else first[1] + last[0]
        assert float(built.design.pull) == pytest.approx(distance * mass, rel=1e-9)


@pytest.mark.whole
def test_what_starts_a_3k_either_way_is_the_braking_of_its_planets_times_their_speeds():
    """Without friction: power of three seals at w_p - w_c; at the output the ratio times that at the sun."""
    held = {"between": ["planet", "carrier"], "breakaway_torque": "0.01 N m"}
    built, _ = figures(THREE_K | {"losses": {"pin": held}}, models__friction__coefficient=0.0)
    data = ANALYSES["running"].compute(built, {}, lambda *_: None)
    there = data.sel(temperature=built.case.operation.temperature).isel(law=0)
    against = (
        18 / 36 * 90 / 108
    )  # planets by the sun, both against the carrier that the ring leaves 18/108
    start = 3 * 0.01 * against
    assert there["starting_torque"].item() == pytest.approx(start, rel=1e-9)
    assert there["back_driving_torque"].item() == pytest.approx(176.0 * start, rel=1e-9)


@pytest.mark.whole
def test_the_margin_of_self_locking_is_the_friction_beyond_which_a_3k_holds():
    """Backwards its ring meshes lock it where e_1 e_2 = I_2 in the mean, and before at the worst phase."""
    built, found = figures(THREE_K)
    data = ANALYSES["back_driving"].compute(built, {}, lambda *_: None).isel(law=0, point=0)
    margin, acting = float(data["self_locking_margin"]), 0.05
    of_rings = (1.0 - found["stage_efficiency"][1:]) / acting
    mean = np.roots([of_rings.prod(), -of_rings.sum(), 1.0 - 90 * 34 / (36 * 88)]).min()
    assert margin > 1.0 and margin * acting < mean
    for times, holds in ((0.98, False), (1.02, True)):
        case = load_case(THREE_K, settings={"models.friction.coefficient": times * margin * acting})
        back = ANALYSES["back_driving"].compute(case, {}, lambda *_: None).isel(law=0, point=0)
        assert bool(back["locked"]) == holds
        assert float(back["self_locking_margin"]) == pytest.approx(1.0 / times, rel=1e-6)


@pytest.mark.whole
def test_bearings_of_planets_and_seals_take_their_part():
    """The pin bears two tangential forces; torques from rest go either way, with the band of what holds."""
    seal = {"between": ["sun", "housing"], "seal_torque": "0.02 N m"}
    seal |= {"breakaway_torque": "0.01 N m", "breakaway_spread": 1.5}
    built, found = figures(PLANETARY | {"losses": {"pin": PIN, "seal": seal}})
    pin = 60.0 / 3 / 27e-3
    assert built.places == ["pin", "seal"]
    # Friction in the teeth and of the pin itself adds some thousandths.
    assert found["bearing_load"] == pytest.approx([pin, 0.0], rel=5e-3)
    rate = np.pi * 100.0
    relative = rate * (24 / 108 + 0.4)
    viscosity = float(built.stages[0].design.lubricant.kinematic_viscosity(333.15))
    product = 1e6 * viscosity * relative * 30.0 / np.pi
    by_oil = 1e-10 * 4.0 * max(product, 2000.0) ** (2 / 3) * 12.0**3
    by_load = 0.003 * found["bearing_load"][0] * 0.012
    lost = 0.02 * rate + 3 * (by_oil + by_load) * relative
    assert product > 2000.0
    assert found["mean_drag_loss"] == pytest.approx(lost, rel=1e-6)
    assert not any("bearings of the planets" in one for one in built.told)
    quiet = load_case(PLANETARY | {"losses": {"seal": seal | {"between": ["planet", "housing"]}}})
    assert any("without the bearings of the planets" in one for one in quiet.told)
    data = ANALYSES["running"].compute(built, {}, lambda *_: None)
    start, low, high = (
        data[name].sel(temperature=built.case.operation.temperature).item()
        for name in ("starting_torque", "least_starting_torque", "largest_starting_torque")
    )
    assert low < start < high
    assert high - start == pytest.approx(0.005, rel=0.02)
    assert start > 0.03
    back = data["back_driving_torque"].sel(temperature=built.case.operation.temperature).item()
    assert back > start * 108 / 24


@pytest.mark.whole
@pytest.mark.parametrize("changes", [SHIFTED, STEPPED])
def test_teeth_push_planets_along_their_circle_outwards_and_along_the_axis(changes):
    """Without friction F_t along, F_t tan of the working angle apart, 2 T sin β/(z m) along the axis."""
    built = load_case({"gears": SET | changes, **TABLES}, settings=FRICTIONLESS)
    train, point = built.design, built.operation
    on_planet = over_period(built, point, built.models[0])["on_planet"]
    (radius,) = {round(float(mesh.dimensions["centre_distance"]), 12) for mesh in built.meshes}
    ends = Ends({"sun": 314.0}, train.held, train.loaded)
    shares = train_torques([one.link for one in train.meshes], ends, 60.0, [1.0, 1.0]).shares
    pushed = np.zeros(3)
    for place, share, apart in zip(train.meshes, shares, (1.0, -1.0), strict=True):
        mesh, member = place.design.mesh, place.bodies.index("planet")
        torque, teeth = share["planet"] / 3.0, np.asarray(mesh.teeth)
        working = np.arccos(abs(np.sum(np.asarray(mesh.base_radii))) / abs(mesh.centre_distance))
        force = torque / (apart * radius * abs(teeth[member] / teeth.sum()))
        axial = 2.0 * torque * np.sin(mesh.helix_angle) / (abs(teeth[member]) * mesh.module)
        pushed += [apart * abs(force) * np.tan(working), force, axial]
    assert np.abs(on_planet) == pytest.approx(np.abs(pushed), rel=1e-9, abs=1e-6)
    assert on_planet[0] == pytest.approx(pushed[0], rel=1e-9, abs=1e-6)
    assert abs(on_planet[1]) == pytest.approx(60.0 / 3 / radius, rel=1e-9)
    assert abs(on_planet[0 if changes is SHIFTED else 2]) > 10.0


def test_life_of_planet_bearings():
    """ISO 281 at the speed against the carrier, under K_γ times the teeth and the pull of the planet."""
    pin = {**PIN, "f0": 1e-9, "f1": 0, "dynamic_load_rating": "8 kN", "life_exponent": 10 / 3}
    pin |= {"static_load_rating": "6 kN"}
    case = PLANETARY | {"losses": {"pin": pin}, "strength": {"life": "2000 h"}}
    case |= {"models": {"friction": {"name": "constant", "coefficient": 0}}}
    built, found = figures(case)
    speed = np.pi * 100.0
    pull = float(built.design.pull) * (speed * 24 / 108) ** 2
    assert found["bearing_load"] == pytest.approx([np.hypot(60 / 3 / 27e-3, pull)], rel=1e-9)
    load = np.hypot(1.1 * 60.0 / 3 / 27e-3, pull)
    life = 1e6 * (8000.0 / load) ** (10 / 3) * 2.0 * np.pi / (speed * (24 / 108 + 0.4))
    data = ANALYSES["operation"].compute(built, {}, lambda *_: None)
    assert data["bearing_life"].item() == pytest.approx(life, rel=1e-9)
    # Twice the load at half the speed for half of the time: Miner's rule.
    history = load_steps([1.0, 1.0], [60.0, -120.0], [speed * 24 / 108, -speed * 12 / 108], 333.15)
    twice = np.hypot(2.2 * 60.0 / 3 / 27e-3, pull / 4)
    part = 0.5 + 0.25 * (twice / load) ** (10 / 3)
    lives = rated_lives(built, history)
    assert lives["pin"].life(history) == pytest.approx(life / part, rel=1e-9)
    assert lives["pin"].count == 3
    assert data["equivalent_bearing_load"].item() == pytest.approx(load, rel=1e-9)
    # What it bears at a static safety of 1, and for 2000 h: loads of the teeth beside the same pull.
    assert data["static_bearing_safety"].item() == pytest.approx(6000.0 / load, rel=1e-9)
    lasting = load * (life / (2000.0 * 3600.0)) ** 0.3
    for name, borne in (("static", 6000.0), ("life", lasting)):
        margin = np.sqrt(borne**2 - pull**2) / (1.1 * 60.0 / 3 / 27e-3)
        assert data[f"{name}_torque_margin"].item() == pytest.approx(margin, rel=1e-9)


def test_life_of_planet_bearings_over_a_duty_hangs_on_no_operating_load():
    """With a seal on the carrier, whose share of the load on teeth does not grow with that of the output."""
    seal = {"between": ["carrier", "housing"], "seal_torque": "1 N m"}
    losses = {"pin": {**PIN, "dynamic_load_rating": "8 kN"}, "seal": seal}
    history = load_steps(1.0, 60.0, np.pi * 10.0, 333.15)
    lives = []
    for torque in ("60 N m", "5 N m", "0 N m"):
        case = PLANETARY | {
            "losses": losses,
            "operation": PLANETARY["operation"] | {"torque": torque},
        }
        built, _ = figures(case)
        lives.append(rated_lives(built, history)["pin"].life(history))
    assert lives[1:] == pytest.approx(lives[:1] * 2, rel=1e-9)
    bears_nothing = load_steps(1.0, 0.0, np.pi * 10.0, 333.15)
    assert rated_lives(built, bears_nothing) == {}


def test_a_bearing_around_which_planets_cancel_has_no_life():
    rated = {"between": ["carrier", "housing"], "dynamic_load_rating": "8 kN"} | {
        key: value for key, value in PIN.items() if key != "between"
    }
    built, _ = figures(PLANETARY | {"losses": {"main": rated, "pin": PIN}})
    data = ANALYSES["operation"].compute(built, {}, lambda *_: None)
    assert np.isinf(data["bearing_life"].values[0, 0, 0])


def test_torque_and_forces_over_the_period_have_the_means_of_the_operating_point():
    """25/29/83: planets out of phase carry unlike forces, which hold the carrier together."""
    built, found = figures(PLANETARY | {"gears": SET | {"teeth": [25, 29, 83]}})
    data = ANALYSES["train_period"].compute(built, {}, lambda *_: None)
    torque = data["input_torque"].values[0] @ data["weight"].values
    assert torque == pytest.approx(found["mean_input_torque"], rel=1e-12)
    assert data["loss"].values[0] @ data["weight"].values == pytest.approx(found["mean_loss"])
    assert data["input_torque"].values.max() <= found["max_input_torque"] * (1 + 1e-12)
    # A tooth of the sun comes to a planet once in so much of a turn against the carrier.
    assert data.attrs["driver_period"] == pytest.approx(2 * np.pi / 25 / (83 / 108))
    outside = dict(zip(data["outer_body"].values, data["outside_torque"].values[0], strict=True))
    sun = found["mean_input_torque"]
    assert outside == pytest.approx({"sun": sun, "carrier": -60.0, "ring": 60.0 - sun}, rel=1e-9)
    ends = data["driver_angle"].values[[0, -1]]
    assert ends == pytest.approx([0.0, data.attrs["driver_period"]], abs=1e-9)
    first, second = data["contact_force"].values[0]
    assert np.ptp(first, axis=0).max() > 1e-3 * first.mean()
    base = 1e-3 * np.array([25, 83]) * np.cos(np.radians(20.0)) / 2.0
    held = first.sum(0) * base[0] + second.sum(0) * base[1]
    np.testing.assert_allclose(held, 60.0, rtol=5e-3)  # friction puts some thousandths beside it
    for name in ("pair_23_61", "two_stage"):
        case = load_case(EXAMPLES / f"{name}.toml")
        assert "do not turn together" in ANALYSES["train_period"].why_not(case)


def test_helical_planets_balance_their_thrusts_and_are_tilted_by_them():
    """F_a = F_t tan β at the reference circles; a planet takes none and both of them as a couple."""
    built = load_case({"gears": SET | {"helix_angle": "20 deg"}, **TABLES})
    train = built.design
    links = [one.link for one in train.meshes]
    ends = Ends({"sun": 314.0}, train.held, train.loaded)
    found = axial_loads(
        links, train.planets, train_torques(links, ends, 60.0, [1.0, 1.0]).shares, built.copies
    )
    of_reference = 24e-3 / np.cos(np.radians(20.0)) / 2.0
    axial = 60.0 * 24 / 108 / of_reference * np.tan(np.radians(20.0))
    thrusts = {body: abs(force) for body, force in found.thrusts.items()}
    assert thrusts == pytest.approx({"sun": axial, "planet": 0.0, "ring": axial}, abs=1e-9)
    assert found.thrusts["sun"] == pytest.approx(-found.thrusts["ring"], rel=1e-12)
    distance = float(built.meshes[0].dimensions["centre_distance"])
    arms = distance * (30 / 54 + 30 / 54)
    assert found.tilting == pytest.approx(axial / 3 * arms, rel=1e-12)
    sizes = ANALYSES["strength"].compute(built, {}, lambda *_: None)["axial_force"].values
    assert sizes == pytest.approx([axial / 3] * 2, rel=1e-9)


PINS = {"pin_errors": ["20 um", 0, 0, 0], "pin_tolerance": "20 um", "planets": 4}


@pytest.mark.whole
def test_planets_share_by_the_springs_of_their_teeth_and_pins():
    """With rigid pins the springs of all planets are the stiffness of the drive; errors by closed form."""
    by_stiffness = {"models": TABLES["models"] | {"load_sharing": "from_stiffness"}}
    set_of = SET | PINS | {"face_width": "12 mm"}
    compute = ANALYSES["planet_sharing"].compute
    built = load_case({"gears": set_of, **TABLES | by_stiffness})
    data = compute(built, {}, lambda *_: None)
    torsion = ANALYSES["torsion"].compute(built, {}, lambda *_: None)
    of_drive = torsion["tangent_torsional_stiffness"].sel(torque=60.0).item()
    stiffness = float(data["planet_stiffness"])
    assert 4 * stiffness * 27e-3**2 == pytest.approx(of_drive, rel=1e-9)
    yielding = {"pin_stiffness": "20 N/um", "floating": "ring"}
    soft = compute(load_case({"gears": set_of | yielding, **TABLES}), {}, lambda *_: None)
    series = 1.0 / (1.0 / stiffness + 1.0 / 20e6)
    assert float(soft["planet_stiffness"]) == pytest.approx(series, rel=1e-9)
    alike, more = 60.0 / 4 / 27e-3, series * 20e-6 / 4
    expected = [alike - more, alike + more, alike - more, alike + more]
    assert soft["pin_force"].values == pytest.approx(expected, rel=1e-9)
    assert float(soft["planet_load_factor"]) == pytest.approx(1.0 + more / alike)
    drawn = soft["drawn_planet_load_factor"].values
    assert 1.0 < drawn[0] < drawn[1] < drawn[2] < 1.0 + 4 * more / alike
    more = {"thickness_tolerance": "10 um", "planet_runout": "16 um", "central_runout": "20 um"}
    for key, width in more.items():
        alone = SET | {"face_width": "12 mm", "planets": 4, key: width}
        factors = compute(load_case({"gears": alone, **TABLES}), {}, lambda *_: None)
        factors = factors["drawn_planet_load_factor"].values
        assert 1.0 < factors[0] < factors[2], key
    # Runout of the sun is that of a body out of the axis, which a floating one is not: no planet feels it.
    floats = load_case({"gears": alone | {"floating": "sun"}, **TABLES})
    factors = compute(floats, {}, lambda *_: None)["drawn_planet_load_factor"].values
    assert factors == pytest.approx([1.0] * 3, rel=1e-8)
    idle = load_case({"gears": set_of, **TABLES}, settings={"operation.torque": "0 N m"})
    assert ANALYSES["planet_sharing"].why_not(idle) == "planets share no load where there is none"
    (lifted,) = doubts_of(data.attrs)
    assert "planet 1 carries nothing" in lifted


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"planets": 3}, "pin_errors: 4 were given for 3 planets; give the error of each"),
        ({"pin_errors": "20 um"}, "pin_errors"),
        ({"floating": "planet"}, "\"planet\" is not allowed; use 'sun', 'carrier'"),
        (
            {"pin_errors": [], "pin_tolerance": 0.0, "floating": "sun"},
            "floating: counts where pins",
        ),
        ({"pin_stiffness": "20 N"}, "pin_stiffness"),
    ],
)
def test_pins_of_other_planets_are_refused_in_a_sentence(changes, words):
    with pytest.raises(InputError, match="gears") as caught:
        load_case({"gears": SET | PINS | changes, **TABLES})
    assert words in str(caught.value)


def drawn_load_factors(tree):
    data = ANALYSES["planet_sharing"].compute(load_case(tree), {}, lambda *_: None)
    assert data.sizes["planet"] == 3
    return data["drawn_planet_load_factor"].values


def test_three_planets_share_by_drawn_tolerances():
    """Fewer planets than places for them."""
    drawn = drawn_load_factors({"gears": SET | {"pin_tolerance": "2 um"}, **TABLES})
    assert 1.0 < drawn[0] < drawn[-1] < 3.0


@pytest.mark.whole
def test_planets_share_alike_in_whatever_order_the_bodies_of_a_mesh_are_named():
    train = {
        "input": "sun",
        "output": "carrier",
        "held": "ring",
        "planets": 3,
        "planet_runout": "9 um",
    }
    ring = {"bodies": ["planet", "ring"], "gears": gears([30, -84])}
    orders = (["sun", "planet"], [24, 30]), (["planet", "sun"], [30, 24])
    first, second = (
        drawn_load_factors(
            {"stages": [{"bodies": bodies, "gears": gears(teeth)}, ring], "train": train, **TABLES}
        )
        for bodies, teeth in orders
    )
    np.testing.assert_allclose(first, second, rtol=1e-9)


@pytest.mark.whole
def test_planets_of_a_stepped_set_behind_a_pair_share_its_load():
    stages = [
        {"bodies": ["motor", "sun"], "gears": gears([20, 40])},
        {"bodies": ["sun", "planet"], "gears": gears([18, 36])},
        {"bodies": ["planet", "ring"], "gears": gears([24, -78])},
    ]
    train = {"input": "motor", "output": "carrier", "held": "ring", "pin_errors": ["9 um", 0, 0]}
    tree = {"stages": stages, "train": train, **TABLES}
    data = ANALYSES["planet_sharing"].compute(load_case(tree), {}, lambda *_: None)
    assert data["pin_force"].sum() == pytest.approx(60.0 / 27e-3)
    assert not any("along the radius" in told for told in doubts_of(data.attrs))
    tolerances = {
        "planet_runout": "20 um",
        "central_runout": "20 um",
        "thickness_tolerance": "9 um",
    }
    drawn = ANALYSES["planet_sharing"].compute(
        load_case(tree | {"train": train | {"pin_errors": []} | tolerances}), {}, lambda *_: None
    )
    assert np.all(np.diff(drawn["drawn_planet_load_factor"]) > 0.0)
    with pytest.raises(InputError, match="does not float; sun, ring, carrier may"):
        load_case(tree | {"train": train | {"floating": "motor"}})


def inspected(teeth):
    return gears(teeth, inspection={"thickness_field": "cd25"})


@pytest.mark.parametrize("kind", ["set", pytest.param("3K", marks=pytest.mark.whole)])
def test_play_and_inertia_at_the_ends_follow_from_gaps_and_speeds(kind):
    """Play by the gaps of all meshes, closed on bodies that are held; inertia by the energy of all bodies."""
    meshes = {
        "set": [("sun", [24, 30]), ("ring", [30, -84])],
        "3K": [("sun", [18, 36]), ("ring", [36, -90]), ("output ring", [34, -88])],
    }[kind]
    output = {"set": "carrier", "3K": "output ring"}[kind]
    stages = [
        {
            "bodies": ["sun", "planet"] if body == "sun" else ["planet", body],
            "gears": inspected(teeth),
        }
        for body, teeth in meshes
    ]
    train = {"input": "sun", "output": output, "held": "ring", "planets": 3}
    built = load_case({"stages": stages, "train": train, **TABLES})
    data = ANALYSES["reflected"].compute(built, {}, lambda *_: None)
    each = [inspection_part(mesh) for mesh in built.meshes]

    # Along the line of action: what a turn of the other bodies opens, with sun and ring held.
    free = [*dict.fromkeys(("planet", "carrier", output))]
    opening = np.zeros((len(meshes), len(free)))
    closed = np.zeros(len(meshes))
    for row, (body, teeth) in enumerate(meshes):
        outer, planet = teeth if body == "sun" else teeth[::-1]
        base = abs(np.array([outer, planet])) * np.cos(np.radians(20.0)) * 1e-3 / 2.0
        of_outer, of_planet = np.sign(outer) * base[0], base[1]
        arms = {"planet": of_planet, "carrier": -of_outer - of_planet, body: of_outer}
        opening[row] = [arms.get(name, 0.0) for name in free]
        closed[row] = -of_outer * (body == "sun")  # again, for a radian of the sun
    gaps = np.array([one["backlash_along_normal"].values for one in each])
    turns = np.abs(np.linalg.inv(opening)[free.index(output)]) @ gaps
    np.testing.assert_allclose(data["output_backlash"], turns, rtol=1e-9)
    assert turns[3] > turns[1] > 0.0

    moving = np.linalg.solve(opening, closed)
    speed = {"sun": 1.0, "ring": 0.0} | dict(zip(free, moving, strict=True))
    weighed = {}
    for (body, teeth), one, mesh in zip(meshes, each, built.meshes, strict=True):
        planet = 1 if body == "sun" else 0
        mass, inertia = one["disc_mass"].values, one["disc_inertia"].values
        orbit = speed["carrier"] * float(mesh.dimensions["centre_distance"])
        turning = inertia[planet] * speed["planet"] ** 2 + mass[planet] * orbit**2
        weighed[f"planet {teeth[planet]}"] = 3 * turning
        weighed[body] = inertia[1 - planet] * speed[body] ** 2
    at_input = sum(weighed.values())
    np.testing.assert_allclose(
        data["reflected_inertia"], [at_input, at_input / speed[output] ** 2], rtol=1e-9
    )
    assert data.sizes["body"] == len(weighed)
    assert data.attrs["carriers"] == '["carrier"]'


@pytest.mark.parametrize("planets", [1, 3])
def test_planets_share_a_load_bear_both_ways_and_meet_sun_and_ring_in_turn(planets):
    """Beside a lone pair under the load of a planet: K_gamma under the root, Y_M, more load cycles."""
    settings = {"gears.planets": planets, "operation.torque": f"{20 * planets} N m"}
    settings |= {"materials.gear_1": "case-hardened-mq", "materials.gear_2": "case-hardened-mq"}
    settings["strength.life"] = "1000 h"
    built = load_case(PLANETARY, settings=settings)
    data = ANALYSES["strength"].compute(built, {}, lambda *_: None)
    names = ["sun", "planet on sun", "planet on ring", "ring"]
    assert mesh_member_names(built, built.mesh_labels) == names
    sun, ring = (data.sel(stage=stage) for stage in (1, 2))
    turns = 1000 * 3600 * 50 * 84 / 108 * np.array([1, 24 / 30, 24 / 84])
    assert sun["flank_cycles"].values == pytest.approx(turns[:2] * [planets, 1])
    assert ring["root_cycles"].values == pytest.approx(turns[1:] * [1, planets])
    assert sun["mean_stress_factor"].values.tolist() == [1.0, 0.7]
    assert ring["mean_stress_factor"].values.tolist() == [0.7, 1.0]
    pair = {"gears": gears([24, 30], face_width="12 mm", fillet_radius=[0.38, 0.2]), **TABLES}
    speed = f"{3000 * 84 / 108} rpm"
    alone = settings | {"operation.torque": f"{20 * 30 / 108} N m", "operation.speed": speed}
    alone.pop("gears.planets")
    lone = ANALYSES["strength"].compute(load_case(pair, settings=alone), {}, lambda *_: None)
    shared = 1.1 if planets == 3 else 1.0
    stress = lone["contact_stress"] / np.sqrt(lone["rated_dynamic_factor"])
    found = sun["contact_stress"] / np.sqrt(sun["rated_dynamic_factor"])
    assert found.values == pytest.approx(stress.values * np.sqrt(shared), rel=1e-9)
    root = lone["root_stress"] / lone["rated_dynamic_factor"]
    found = sun["root_stress"] / sun["rated_dynamic_factor"]
    assert found.values == pytest.approx(root.values * shared, rel=1e-9)
    # The line load of K_v has it in as it has K_A.
    more = load_case(pair, settings=alone | {"strength.application_factor": shared})
    dynamic = ANALYSES["strength"].compute(more, {}, lambda *_: None)["rated_dynamic_factor"]
    assert float(sun["rated_dynamic_factor"]) == pytest.approx(float(dynamic), rel=1e-12)
    given = load_case(PLANETARY, settings=settings | {"strength.mesh_load_factor": 1.3})
    other = ANALYSES["strength"].compute(given, {}, lambda *_: None)
    assert other["mesh_load_factor"].values.tolist() == [1.3, 1.3]
    told = f"K_γ is at least {shared:g}" if planets == 3 else "K_γ = 1,"
    assert told in data.attrs["remarks"].replace("\\u03b3", "γ")


@pytest.mark.whole
def test_the_rating_takes_the_load_of_planets_whose_pins_are_out_of_place():
    """As if K_γ had been given; where the standard has more, or the case gives one, pins change nothing."""

    def rated(**changes):
        built = load_case({"gears": SET | changes, **TABLES}, settings=given)
        return ANALYSES["strength"].compute(built, {}, lambda *_: None), built

    given = {}
    pins = {"pin_errors": ["0.2 um", 0, 0], "pin_tolerance": "1 um"}
    found, built = rated(**pins)
    sharing = ANALYSES["planet_sharing"].compute(built, {}, lambda *_: None)
    factor = float(sharing["drawn_planet_load_factor"][-1])
    assert 1.1 < factor < 2.0
    assert found["mesh_load_factor"].values == pytest.approx([factor] * 2, rel=1e-12)
    assert found.attrs["planets"] == 3
    assert f"up to {factor:.3g} of an equal share in 99 % of sets" in found.attrs["remarks"]
    swept = ratings_of([built], 1)["largest_root_stress"][1].item()
    assert swept == pytest.approx(found["root_stress"].max().item(), rel=1e-12)
    given = {"strength.mesh_load_factor": factor}
    same, _ = rated()
    for name in ("root_stress", "contact_stress", "rated_dynamic_factor"):
        np.testing.assert_allclose(found[name], same[name], rtol=1e-9)
    given = {"strength.mesh_load_factor": 1.05}
    assert rated(**pins)[0]["mesh_load_factor"].values.tolist() == [1.05, 1.05]
    given = {}
    slight = rated(pin_errors=["0.05 um", 0, 0])[0]
    assert slight["mesh_load_factor"].values.tolist() == [1.1, 1.1]
    assert "stays that of the standard" in slight.attrs["remarks"]


@pytest.mark.parametrize(
    ("changes", "settings", "words"),
    [
        ({"pin_tolerance": "2 um"}, {}, "at most that in 99 % of sampled sets"),
        ({"pin_errors": ["1 um", 0, 0]}, {}, "by pin_errors"),
        ({"pin_tolerance": "0.01 um"}, {}, "assumed by IEC 61400-4; deviations alone: 1"),
        ({}, {}, "assumed by IEC 61400-4"),
        ({"pin_tolerance": "2 um"}, {"strength.mesh_load_factor": 1.05}, "by [strength]"),
    ],
)
def test_the_first_screen_says_by_what_the_load_on_a_planet_is(changes, settings, words):
    """One factor, the one of the rating; and by hand the diameter around the ring."""
    parts = ["teeth", "strength", *["planet_sharing"] * bool(changes)]
    tree = {"gears": SET | changes, **TABLES}
    (outcome,) = pp.run(tree, analyses=parts, settings=settings).values()
    figures = {figure.name: figure for figure in key_figures(in_order(), outcome)}
    (name,) = [name for name in figures if name.startswith("Load")]
    assert name == "Load on a planet" and figures[name].detail.startswith(words)
    rated = float(outcome.parts["strength"]["mesh_load_factor"].max())
    assert figures[name].value == f"K_γ {rated:.3g}"
    # 1.2 of a root circle 2.5 modules beyond 84 teeth; 27 teeth from axis to axis
    across, apart = 1.2 * 1.0 * (84 + 2.5), 27.0
    assert figures["Outer diameter"].value == f"{across:.4g} mm"
    assert figures["Outer diameter"].detail.endswith(f"axes {apart:g} mm apart")


@pytest.mark.whole
def test_the_rating_of_a_wind_turbine_stage_is_that_of_a_commercial_program():
    """Second stage of the gearbox of Nejad and others (2016), by ISO 6336:2006, load factors as printed.

    Source: a printout of KISSsoft 03/2017, file stage_02.rtf in github.com/gfsReboucas/Drivetrain.
    """
    shortened = -1.75 / 21.0
    common = {
        "module": "21 mm",
        "face_width": "550 mm",
        "centre_distance": "584 mm",
        "dedendum": 1.25,
    }
    sun = {"teeth": [18, 36], "profile_shift": [0.389, 0.504], "fillet_radius": 0.38}
    ring = {"teeth": [36, -93], "profile_shift": [0.504, 0.1171], "fillet_radius": [0.38, 0.3]}
    stages = [
        {
            "bodies": ["sun", "planet"],
            "gears": common | sun | {"tip_alteration": shortened},
            "strength": {"face_load_factor": 2.06, "root_face_load_factor": 1.94},
        },
        {
            "bodies": ["planet", "ring"],
            "gears": common | ring | {"tip_alteration": [shortened, 0.0], "cutter_teeth": 30},
            "strength": {"face_load_factor": 1.15, "root_face_load_factor": 1.14},
        },
    ]
    load = {"torque": "162105.5 N m", "speed": "47.756 rpm", "temperature": "75 degC"}
    factors = {"edition": "2006", "application_factor": 1.25, "dynamic_factor": 1.06}
    tree = {
        "stages": stages,
        "train": {"input": "carrier", "output": "sun", "held": "ring"},
        **TABLES,
        "operation": load,
        "strength": factors | {"life": "175200 h"},
    }
    settings = {f"materials.gear_{gear}": "case-hardened-mq" for gear in (1, 2)}
    built = load_case(tree, settings=settings)
    data = ANALYSES["strength"].compute(built, {}, lambda *_: None)
    contact = [float(one.dimensions["transverse_contact_ratio"]) for one in built.meshes]
    assert contact == pytest.approx([1.370, 1.618], abs=6e-4)
    printed = {
        "tangential_force": [277578.0, 292999.0],
        "radial_force": [124570.7, 81969.4],
        "nominal_contact_stress": [573.40e6, 312.44e6],
        "contact_stress": [[1071.17e6, 994.13e6], [404.76e6, 404.76e6]],
        "form_factor": [[1.47, 1.38], [1.01, 1.20]],
        "stress_correction_factor": [[2.04, 2.18], [2.48, 2.34]],
        "nominal_root_stress": [[73.95e6, 74.21e6], [61.98e6, 69.12e6]],
        "root_stress": [[209.38e6, 210.14e6], [102.77e6, 114.61e6]],
        "flank_cycles": [[7782.3e6, 1297.1e6], [1297.1e6, 1506.3e6]],
        "root_life_factor": [[0.854, 0.886], [0.886, 0.883]],
        "root_size_factor": [[0.84, 0.84], [0.84, 0.84]],
        "mean_stress_factor": [[1.0, 0.7], [0.7, 1.0]],
        "mesh_load_factor": [1.1, 1.1],
    }
    for name, values in printed.items():
        rounded = 4e-3 if name in ("form_factor", "stress_correction_factor") else 2.5e-3
        np.testing.assert_allclose(data[name].values, values, rtol=rounded, err_msg=name)


@pytest.mark.whole
def test_a_set_is_the_train_of_its_meshes():
    built, found = figures(PLANETARY)
    table = {"teeth": [24, 30], "module": "1 mm", "face_width": "12 mm"}
    table |= {"fillet_radius": [0.38, 0.2]}
    ring = table | {"teeth": [30, -84], "fillet_radius": 0.2}
    spelt = {
        "stages": [
            {"bodies": ["sun", "planet"], "gears": table},
            {"bodies": ["planet", "ring"], "gears": ring},
        ],
        "train": {"input": "sun", "output": "carrier", "held": "ring", "planets": 3},
        **TABLES,
    }
    assert figures(spelt)[1]["mean_efficiency"] == pytest.approx(
        found["mean_efficiency"], rel=1e-13
    )
    back = built.backwards
    assert (back.driver, back.loaded) == ("carrier", "sun")
    assert back.case.operation.torque == pytest.approx(60.0 * 24 / 108)
    assert back.case.operation.speed == pytest.approx(np.pi * 100 * 24 / 108)
    returned = back.figures_of([(back.design, back.operation)], built.models[0])
    eta, basic = float(np.prod(returned["stage_efficiency"][0])), -84 / 24
    willis = (1 - basic) / (1 - basic / eta)
    assert returned["mean_efficiency"][0] == pytest.approx(willis, rel=1e-5)


@pytest.mark.whole
def test_a_3k_by_its_meshes():
    """Free bodies with the efficiencies of the meshes have the efficiency of the train."""
    built, found = figures(THREE_K, models__friction={"name": "constant", "coefficient": 0.02})
    assert built.design.ratio == pytest.approx(176.0)
    links = [Link(one.design.mesh, one.bodies, one.carrier) for one in built.design.meshes]
    ends = Ends({"sun": 1.0}, ("ring",), "output ring")
    asked = train_torques(links, ends, 1.0, found["stage_efficiency"].tolist())
    assert found["mean_efficiency"] == pytest.approx(asked.efficiency, rel=1e-9)
    assert 0.9 < asked.efficiency < 0.95
    assert [one.periods for one in built.design.meshes] == [18, 18, 17]


@pytest.mark.whole
def test_stiffness_at_the_output_is_that_of_the_springs_of_all_planets():
    """By energy: the wind-up of the carrier is the sum of those of the meshes by the torques they carry."""
    one = load_case(PLANETARY, settings={"models.load_sharing": "from_stiffness"})
    data = ANALYSES["torsion"].compute(one, {}, lambda *_: None)
    each = [ANALYSES["torsion"].compute(mesh, {}, lambda *_: None) for mesh in one.stages]
    # Three planets share what the planets and the ring take of a torque at the carrier.
    torque = float(data["torque"].values[12])
    parts = np.array([24 / 108 * 30 / 24, 84 / 108])
    wound = [
        part * np.interp(part * torque / 3, mesh["torque"].values, mesh["wind_up"].values)
        for part, mesh in zip(parts, each, strict=True)
    ]
    assert data["wind_up"].values[12] == pytest.approx(sum(wound), rel=1e-6)
    # A planet more, under as much load, is a spring more beside those that are there.
    settings = {"gears.planets": 4, "operation.torque": "80 N m"}
    more = load_case(PLANETARY, settings={"models.load_sharing": "from_stiffness", **settings})
    other = ANALYSES["torsion"].compute(more, {}, lambda *_: None)["tangent_torsional_stiffness"]
    rise = other.values[-1] / data["tangent_torsional_stiffness"].values[-1]
    assert rise == pytest.approx(4 / 3, rel=1e-6)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"gears.planets": 5}, r"gears.planets: .* misses the teeth of the ring by 0.4 of a pitch"),
        ({"gears.planets": 5}, r"of 1 to 8 planets fit 1, 2, 3, 4; it runs with gears.teeth = \["),
        (
            {"gears.planet_angles": ["0 deg", "9 deg"]},
            r"planet_angles: 2 were given for 3 planets; ",
        ),
        ({"gears.planet_angles": ["0 deg", "9 deg", "9 N"]}, r"planet_angles.*\"9 N\" is a force"),
        (
            {"gears.planets": 6},
            r"run into each other: 27 mm apart, and their tip circles measure 32",
        ),
        (
            {"gears.teeth": [24, 30, 85]},
            r"runs with gears.teeth = \[24, 30, 84\] \(ratio 4.5, here 4.54",
        ),
        ({"gears.planets": 0}, r"gears.planets: 0 is out of range; allowed is 1 to 24"),
        ({"gears.planets": 1.5}, r"gears.planets: 1.5 is not a whole number; allowed is 1 to 24"),
        ({"gears.planets": 100}, r"gears.planets: 100 is out of range; allowed is 1 to 24"),
        ({"gears.planets": "nan"}, r"gears.planets: .* does not start with a plain finite number"),
        ({"gears.module": "1 N"}, r"gears.module: \"1 N\" is a force, but a length is needed"),
        ({"gears.floating": "all"}, r'"all" is more than one body, and one body alone floats; the'),
        ({"gears.teeth": [60, 10, 40]}, r"40 teeth is not around a sun of 60; .* has some 80$"),
        ({"gears.held": "sun"}, r"gears.held: .* none of them is the ring"),
        ({"gears.input": "carrier"}, r"gears.input: .* none of them is the sun"),
        ({"gears.teeth": [24, 30, 20]}, r"20 teeth is not around a planet of 30; .* some 84"),
        ({"gears.teeth": [24, 30]}, r"has 2 values; give those of sun, planet and ring"),
        ({"gears.profile_shift": [0.1]}, r"has 1 value; give those of sun, planet and ring"),
        (
            {"gears.held": "planet"},
            r"gears.held: 'planet' is not allowed; use|\"planet\" is not allowed",
        ),
        ({"gears.modul": 3}, r"gears.modul: is not a known key; did you mean module"),
        ({"gears.fillet_radius": 0.38}, r"addendum = \[1, 1, 0.9\d*\], or with fillet_radius = \["),
        ({"operation.driver": "ring"}, r"that is the input of the train"),
        ({"materials.gear_2": "POM-H"}, r"material of the planet with 30 teeth is steel here and"),
        ({"roughness.ra": ["0.4 um", "0.8 um"]}, r"roughness Rq of the planet with 30 teeth is"),
        ({"gears.profile_shift": [-0.9, -0.9, 0]}, r"always have backlash; give larger ones"),
        ({"gears.teeth": [24, 30, 60]}, r"asks for a profile shift of .*; .* it has some 84"),
        ({"film.solver": "lines"}, r"film.solver: \"lines\" is not allowed; use 'line', "),
        (
            {"worn.file": "x.nc"},
            r'worn.file: .*sun .*: "x.nc" cannot be read as a result; name the',
        ),
        ({"dynamics.damping_ratio": 0.1}, r"a load of inertia J on it have a natural frequency"),
    ],
)
def test_a_wrong_number_gets_a_sentence_in_the_words_of_the_set(settings, words):
    with pytest.raises(InputError, match=words):
        load_case(PLANETARY, settings=settings)


STEPPED = SET | {"teeth": [18, 36], "second": {"teeth": [24, 78], "face_width": "10 mm"}}
THREE_K_SET = SET | {"teeth": [18, 36, 90], "second": {"teeth": [34, 88], "face_width": "10 mm"}}
LARGE_SUN = {
    "teeth": [40, 30, 100],
    "second": THREE_K_SET["second"] | {"teeth": [28, 98]},
}
APART = ["0 deg", "110 deg", "235 deg"]


TEETH, BOTH = ("gears.teeth",), ("gears.teeth", "gears.second.teeth")
OF_MESHES = tuple(f"stages.{number}.gears.teeth" for number in (1, 2, 3))
ANGLES = ("gears.planet_angles",)


@pytest.mark.parametrize(
    ("tree", "keys", "ratio"),
    [
        ({"gears": SET | {"planets": 5}}, [TEETH], 4.5),
        ({"gears": SET | {"teeth": [25, 30, 84]}}, [TEETH, ANGLES], 4.36),
        ({"gears": SET | {"planet_angles": APART}}, [ANGLES], 4.5),
        ({"gears": SET | {"planet_angles": ["11 deg", *APART[1:]]}}, [ANGLES], 4.5),
        ({"gears": STEPPED | {"planets": 4}}, [BOTH], 7.5),
        ({"gears": THREE_K_SET | {"planets": 4}}, [BOTH], 176.0),
        ({"gears": THREE_K_SET | LARGE_SUN}, [BOTH, ANGLES], 73.5),
        (THREE_K | {"train": THREE_K["train"] | {"planets": 4}}, [OF_MESHES], 176.0),
    ],
)
def test_advice_for_planets_that_do_not_fit_in_runs(tree, keys, ratio):
    """The nearest numbers of teeth and unequal angles, each with about the ratio that was asked for."""
    with pytest.raises(InputError, match=r"planet(s|_angles): .*; it runs with ") as caught:
        load_case(TABLES | tree)
    cures = caught.value.cures
    assert [tuple(cure) for cure in cures] == keys
    for cure in cures:
        built = load_case(TABLES | tree, settings=cure)
        assert float(built.design.ratio) == pytest.approx(ratio, rel=0.05)
        assert all(key in str(caught.value) for key in cure)
        sideways = any("press sun, rings and carrier sideways" in told for told in built.told)
        assert sideways == ([*cure] == [*ANGLES])


@pytest.mark.parametrize("first", [0.0, 10.0, -50.4])
def test_angles_of_planets_may_be_rounded_wherever_the_first_one_stands(first):
    """To 1 % of the step of 360/109 deg, by which others stand from the first one."""
    step = 360.0 / 109.0
    for off, fits in ((0.0, True), (0.009, True), (0.02, False)):
        angles = [f"{first + steps * step:.9g} deg" for steps in (0.0, 36.0 + off, 73.0 - off)]
        tree = {"gears": SET | {"teeth": [25, 30, 84], "planet_angles": angles}, **TABLES}
        if fits:
            (train,) = load_case(tree).trains.values()
            stand = np.degrees(train.design.angles[:3])  # behind them what stands in the housing
            assert stand == pytest.approx(first + step * np.array([0, 36, 73]), abs=1e-6)
        else:
            with pytest.raises(InputError, match="number 2 misses") as caught:
                load_case(tree)
            (cure,) = caught.value.cures
            assert cure["gears.planet_angles"][0] == f"{first:g} deg"


ONE_PLANET = STEPPED | {"planets": 1, "teeth": [12, 18], "profile_shift": [0.3, -0.3]}
PIN_IN_TEETH = {"gears": SET, "losses": {"pin": PIN | {"mean_diameter": "27.6 mm"}}}


@pytest.mark.parametrize(
    ("tree", "words", "keys"),
    [
        (
            {"gears": SET | {"profile_shift": [0.3, 0.1, 0.0]}},
            r"centre_distance: .* sum to -0.4 instead of 0.1; it runs with profile_shift = \[",
            [("gears.profile_shift",)],  # another centre distance would not suit sun and planet
        ),
        (
            {"gears": SET | {"profile_shift": [0, 0, 0.3]}},
            r"sum to 0 instead of 0.3; it runs with",
            [("gears.profile_shift",)],
        ),
        (
            {"gears": SET | {"centre_distance": "26.89 mm"}},
            r"sum to -0.1083 instead of 0; it runs with centre_distance = \"27 mm\"$",
            [("gears.centre_distance",)],
        ),
        ({"gears": SET | {"teeth": [24, 30, 90]}}, r"teeth: .* any profile shift; .* some 84$", []),
        ({"gears": SET | {"centre_distance": "30 mm"}}, r"profile shift of -3.95; .* some 90$", []),
        (
            {"gears": SET | {"teeth": [12, 18, 48]}},
            r"ring \(gear 2\): the tip of gear 2 runs into the undercut fillet of gear 1",
            [("gears.addendum",), ("gears.fillet_radius",)],
        ),
        (
            {"gears": ONE_PLANET | {"second": STEPPED["second"] | {"teeth": [30, 40], "module": "3 mm"}}},
            r"the second gear of the planets \(gear 1\) and its ring \(gear 2\): the tip of gear 2 runs",
            [("gears.addendum",)],
        ),
        (
            PIN_IN_TEETH,
            r"pin.mean_diameter: rolling bodies on a circle of 27.6 mm do not fit into planets whose roots "
            r"lie on 27.5 mm; it runs with mean_diameter = \"12 mm\"$",
            [("losses.pin.mean_diameter",)],
        ),
    ],
)  # fmt: skip
def test_gears_of_a_set_that_do_not_fit_are_refused_with_what_mends_all_of_it(tree, words, keys):
    """Advice of one mesh that the others do not bear is left out; what is left runs."""
    with pytest.raises(InputError, match=words) as caught:
        load_case(TABLES | tree)
    assert [tuple(cure) for cure in caught.value.cures] == keys
    for cure in caught.value.cures:
        load_case(TABLES | tree, settings=cure)


def test_advice_for_one_mesh_mends_what_it_leaves_wrong_in_the_other():
    """Both meshes complain of the dedendum; what suits one alone led from each to the other."""
    tree = {"gears": SET | {"dedendum": 0.3}, **TABLES}
    with pytest.raises(InputError) as caught:
        load_case(tree)
    cures = [cure for complaint in caught.value.every for cure in complaint.cures]
    assert len(cures) == 2
    for cure in cures:
        load_case(tree, settings=cure)


@pytest.mark.parametrize("key", ["gears.profile_shift", "gears.second.profile_shift"])
def test_shifts_that_follow_are_set_from_python(key):
    shifts = [0.1, 0.0, "from centre distance"][-3 if key.startswith("gears.p") else -2 :]
    case = pp.Case({"gears": THREE_K_SET, **TABLES}).set({key: shifts})
    assert "from centre distance" in case.to_toml()
    with pytest.raises(InputError, match="plain finite number"):
        case.set({"gears.teeth": [18, 36, "from centre distance"]})


@pytest.mark.parametrize(
    ("changes", "words", "keys"),
    [
        ({"teeth": [25, 30, 84]}, r"planets: the planets do not fit", ["teeth", "planet_angles"]),
        (
            {"profile_shift": [0.3, 0.1, 0.0]},
            r"centre_distance: .* sum to -0.4 instead of 0.1; it runs with profile_shift = \[",
            ["profile_shift"],  # another centre distance would not suit sun and planet
        ),
        (
            {"teeth": [12, 18, 48]},
            r"gear 1 parts them; it runs with addendum = \[.*, or with fillet_radius = \[",
            ["addendum", "fillet_radius"],
        ),
    ],
)
def test_advice_for_a_set_that_is_a_stage_has_the_keys_of_the_stage(changes, words, keys):
    stages = [{"gears": gears([23, 61])}, {"gears": SET | changes}]
    with pytest.raises(InputError, match=rf"stages.2.gears.*{words}") as caught:
        load_case({"stages": stages, **TABLES})
    cures = caught.value.cures
    assert [[*cure] for cure in cures] == [[f"stages.2.gears.{key}"] for key in keys]
    for cure in cures:
        load_case({"stages": stages, **TABLES}, settings=cure)


def test_a_set_that_is_not_advised_has_no_change_that_was_not_tried():
    variant = Variant({"gears": SET, **TABLES}, "set.toml", "default")
    (left,) = variant.built_each([{"gears.profile_shift": [0.3, 0.1, 0.0]}])
    assert str(left).endswith("sum to -0.4 instead of 0.1") and left.cures == ()


@pytest.mark.whole
@pytest.mark.parametrize(
    ("settings"),
    [
        {"gears.fillet_radius": [0.38, 0.22, 0.38]},
        {"gears.profile_shift": [0.3, 0.1, "from centre distance"]},
        {"gears.profile_shift": [0.3, 0.1]},
        {"gears.profile_shift.2": 0.1},
        {"gears.planets": 4},
        {"gears.input": "ring", "gears.held": "sun"},
        {"gears.output": "ring", "gears.held": "carrier"},
        {"gears.helix_angle": "20 deg"},
    ],
)
def test_advice_that_is_followed_and_other_sets_run(settings):
    built = load_case(PLANETARY, settings=settings)
    distances = {round(float(one.design.mesh.centre_distance), 12) for one in built.stages}
    assert len(distances) == 1


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"train": None}, r"stages.1.bodies: was given without a table \[train\]"),
        ({"train": THREE_K["train"] | {"input": "arm"}}, r'train.input: "arm" is no body of this'),
        ({"train": THREE_K["train"] | {"held": []}}, r"train: the motion is not settled by sun"),
        ({"train": THREE_K["train"] | {"held": ["ring", "carrier"]}}, r"this train cannot move"),
        (
            {"train": THREE_K["train"] | {"output": "ring"}},
            r"train: ring is held and takes no power",
        ),
        ({"gears": SET}, r"stages: was given with gears of the family"),
        (
            {"losses": {"seal": {"between": ["sun", "hull"], "seal_torque": "0.1 N m"}}},
            r'losses.seal.between: "hull" is no body of this drive',
        ),
        (
            {"losses": {"pin": PIN | {"between": ["sun", "housing"], "position": "3 mm"}}},
            r"losses.pin.position: was given; a bearing of a train stands for all bearings of its",
        ),
        (
            {"losses": {"pin": PIN | {"between": ["planet", "housing"]}}},
            r'losses.pin.between: bearings of planets sit in their carrier: \["planet", "carrier"\]',
        ),
        (
            {"losses": {"a": PIN, "b": PIN | {"between": ["carrier", "planet"]}}},
            r"losses.b.between: a is a bearing between the same two; one of a train stands for all",
        ),
        (
            {
                "losses": {"pin": PIN},
                "stages": [
                    THREE_K["stages"][0] | {"lubricant": {"name": "pao-vg-220"}},
                    *THREE_K["stages"][1:],
                ],
            },
            r"stages.1.lubricant: was given beside \[losses\]; a train that has them has one oil",
        ),
        (
            {"strength": {"engagements": 2}},
            r"strength.engagements: was given without life, whose load cycles it counts",
        ),
        (
            {"stages": [THREE_K["stages"][0] | {"losses": {"pin": PIN}}, *THREE_K["stages"][1:]]},
            r"stages.1.losses.pin: losses of a train stand between its bodies; give this one under",
        ),
        ({"train": THREE_K["train"] | {"output": "planet"}}, r"planets are neither turned nor"),
        ({"train": THREE_K["train"] | {"output": "sun"}}, r"sun is turned, and would take its own"),
        ({"train": THREE_K["train"] | {"carrier": "housing"}}, r"train.carrier: the housing is no"),
        ({"train": THREE_K["train"] | {"planet": "planets"}}, r"train.planet: no stage has a body"),
        (
            {
                "stages": [
                    *THREE_K["stages"][:2],
                    {**THREE_K["stages"][2], "gears": gears([34, -86])},
                ]
            },
            r"stages.3.gears.centre_distance: the centre distance is 26 mm, and 27 mm in stage 1",
        ),
        (
            {"stages": [*THREE_K["stages"], THREE_K["stages"][0]]},
            r"4 meshes settle the motion of 3 bodies that are free",
        ),
        (
            {"stages": [THREE_K["stages"][0] | {"driver": "gear 2"}, *THREE_K["stages"][1:]]},
            r"stages.1.driver: follows from the train; leave it out",
        ),
        (
            {
                "stages": [
                    {
                        "bodies": ["sun", "planet"],
                        "gears": gears(
                            [18, 36], profile_shift=[-0.1, 0.1], centre_distance="27 mm"
                        ),
                    },
                    *THREE_K["stages"][1:],
                ]
            },
            r"profile shift of the planet with 36 teeth is 0 here and 0.1 in stage 1; it is one gear",
        ),
    ],
)
def test_a_train_that_cannot_run_is_refused_in_a_sentence(changes, words):
    tree = {key: table for key, table in (THREE_K | changes).items() if table is not None}
    with pytest.raises(InputError, match=words):
        load_case(tree)


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("held", "one body alone is held; with two of them held nothing moves"),
        ("floating", "one body alone floats"),
    ],
)
def test_several_bodies_held_or_floating_are_refused_in_a_sentence(key, words):
    with pytest.raises(InputError, match=words):
        load_case({"gears": SET | {key: ["sun", "ring"]}, **TABLES})


def test_what_else_stands_beside_a_set_is_told():
    stages = [{"gears": gears([23, 61])}, {"gears": SET | {"family": "epicyclic"}}]
    with pytest.raises(InputError, match=r"epicyclic. is no family .* did you mean planetary"):
        load_case({"stages": stages, **TABLES})
    torus = {"family": "torus", "teeth": [20, 40], "module": "1 mm", "face_width": "10 mm"}
    torus |= {"torus_radius": ["60 mm", "70 mm"]}
    stages = [*THREE_K["stages"], {"bodies": ["output ring", "out"], "gears": torus}]
    with pytest.raises(InputError, match=r"stages.4.gears.family: meshes of a train are pairs"):
        load_case(THREE_K | {"stages": stages})


def test_stages_of_a_train_name_their_bodies():
    stages = [{key: one[key] for key in ("gears",)} for one in THREE_K["stages"]]
    with pytest.raises(InputError, match=r"stages.1.bodies: is missing; name the 2 bodies"):
        load_case(THREE_K | {"stages": stages})


def faced(angle, seen, count):
    """Part of a pitch by which the nearest tooth of a gear misses a direction, both clockwise [deg]."""
    return (angle - 90.0 - seen) * count / 360.0


@pytest.mark.parametrize("tree", [SET | {"teeth": [25, 29, 83], "planets": 4}, STEPPED])
def test_a_picture_of_a_set_has_teeth_in_spaces_wherever_it_turns(tree):
    """Without backlash a tooth of one gear faces the middle of a space of its mate on the line of centres."""
    (outcome,) = pp.run({"gears": tree, **TABLES}, analyses=["teeth"]).values()
    (train,) = outcome.manifest["trains"]
    planes = train_pictures(outcome, train)
    assert len(planes) == (2 if "second" in tree else 1)
    for turns in (0.0, 0.3, 7.77):
        for plane in planes:
            carrier = 360.0 * turns * plane["carrier"]
            turned = [
                (
                    gear,
                    gear["turn"]
                    + 360.0 * turns * gear["rate"]
                    + carrier * (gear["at"] is not None),
                )
                for gear in plane["gears"]
            ]
            planets = [(gear, angle) for gear, angle in turned if gear["at"] is not None]
            for mate, standing in (one for one in turned if one[0]["at"] is None):
                for planet, angle in planets:
                    out = planet["at"] + carrier
                    inwards = out if mate["ring"] else out + 180.0
                    of_planet = faced(angle, inwards, len(planet["repeats"]))
                    of_mate = faced(standing, out, len(mate["repeats"]))
                    off = of_mate - of_planet if mate["ring"] else of_mate + of_planet
                    assert off % 1.0 == pytest.approx(0.5, abs=2e-3)


def test_the_motion_of_a_set_is_told_with_its_mesh_frequencies_and_hunting_teeth():
    (outcome,) = pp.run({"gears": SET, **TABLES}, analyses=["teeth"]).values()
    (words, bodies, meshes, _) = TRAIN.screen(outcome)
    assert words.line == "sun drives, carrier turns the same way, ring held: ratio 4.5."
    speeds = {row["body"]: row["speed [rpm]"] for row in bodies.rows}
    assert speeds == {"sun": "3000", "planet": "−1200", "ring": "0", "carrier": "666.67"}
    for row, turns in zip(
        meshes.rows, ("5 turns of the sun", "14 turns of the planet"), strict=True
    ):
        assert float(row["frequency [Hz]"]) == pytest.approx(50 * 84 / 108 * 24, rel=1e-4)
        assert (row["common divisor"], row["same two teeth again after"]) == ("6", turns)
