"""Case files of planetary sets and other trains: what they compute, what they say of a wrong number."""

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from set_cases import PLANETARY, SET, STEPPED, TABLES, THREE_K, figures, gears

import pitchpoint as pp
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.inspection import inspection_part
from pitchpoint.drive.kinematics import Ends, Link
from pitchpoint.drive.thrusts import axial_loads
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency import train_summary
from pitchpoint.runs.run import load_case
from pitchpoint.views.section_registry import TRAIN
from pitchpoint.views.train_picture import train_pictures

EXAMPLES = Path(__file__).parents[2] / "examples"


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
    for teeth, distance in ((SET, 27e-3), (of_two, 27e-3)):
        built = load_case({"gears": teeth, **TABLES})
        first, last = (inspection_part(mesh)["disc_mass"].values for mesh in built.meshes)
        mass = max(first[1], last[0]) if teeth is SET else first[1] + last[0]
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
