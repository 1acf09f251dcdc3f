"""Planetary sets as stages of a drive, beside each set and pair from a file of its own."""

import json
from functools import cache

import numpy as np
import pytest
from planetary_sets import (
    LOAD,
    PAIR,
    RATIO_OF_PAIR,
    RATIOS,
    SETS,
    SPEED,
    TABLES,
    WIDTH,
    alone,
    by_themselves,
    drive,
    figures,
    of,
    operation,
)

from pitchpoint.analyses.analysis import Subject
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.plausibility import unlikely
from pitchpoint.analyses.running import from_rest
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.errors import CollectedInputError, InputError
from pitchpoint.results.by_stage import of_stage, stages_of
from pitchpoint.runs.run import load_case, uncomputed_manifests

NEEDLES = {
    "between": ["planet", "carrier"],
    "bearing": "palmgren_1959",
    "mean_diameter": "8 mm",
    "f0": 5.0,
    "f1": 0.0005,
}
SHAFT_2 = {
    "between": ["shaft 2", "housing"],
    "bearing": "palmgren_1959",
    "mean_diameter": "30 mm",
    "f0": 2.0,
    "f1": 0.0003,
}


@cache
def two_sets():
    return drive(*SETS)


@cache
def pair_before_set():
    return drive(PAIR, SETS[0], losses={"left": SHAFT_2})


@cache
def set_before_pair():
    return drive({"gears": SETS[0], "losses": {"needles": NEEDLES}}, PAIR, losses={"left": SHAFT_2})


def test_two_sets_in_a_row_are_as_good_as_their_product():
    """Efficiency, torques and speeds are those of each set alone where it stands, and by tooth numbers."""
    built = two_sets()
    found = figures(built)
    apart = by_themselves(built, SETS, found)
    product = np.prod([one["mean_efficiency"] for one in apart])
    assert found["mean_efficiency"] == pytest.approx(product, rel=1e-12)
    assert found["stage_efficiency"] == pytest.approx(
        [one["mean_efficiency"] for one in apart], rel=1e-12
    )
    assert found["mean_loss"] == pytest.approx(sum(one["mean_loss"] for one in apart), rel=1e-11)
    rolling = [one["latent_power"] for one in apart]
    assert found["stage_latent_power"] == pytest.approx(rolling, rel=1e-11)
    assert found["latent_power"] == pytest.approx(sum(rolling), rel=1e-11)
    torque = LOAD / np.prod(RATIOS) / product
    assert found["mean_input_torque"] == pytest.approx(torque, rel=1e-12)
    assert found["stage_speed"] == pytest.approx([SPEED, SPEED / RATIOS[0]], rel=1e-12)
    assert built.motion == pytest.approx([1.0, 1 / RATIOS[0], 1 / np.prod(RATIOS)], rel=1e-12)


@pytest.mark.whole
def test_ripple_is_that_of_both_sets_at_their_worst():
    """Without losses that hang on the load the worst meeting is that of the worst of each."""
    found = figures(two_sets())
    apart = by_themselves(two_sets(), SETS, found)
    for end in ("min", "max"):
        both = np.prod([one[f"{end}_input_torque"] / one["mean_input_torque"] for one in apart])
        least = found["mean_input_torque"] * both
        assert found[f"{end}_input_torque"] == pytest.approx(least, rel=1e-9)


@pytest.mark.whole
def test_two_sets_driven_backwards():
    """The carrier of the second set drives: each set alone at its new torque, driven backwards likewise."""
    built = two_sets().backwards
    found = figures(built)
    assert [one.driver for one in built.stages] == ["carrier", "carrier"]
    turned = [{**SETS[k], "input": "carrier", "output": "sun"} for k in (1, 0)]
    apart = by_themselves(built, turned, found)
    product = np.prod([one["mean_efficiency"] for one in apart])
    assert found["mean_efficiency"] == pytest.approx(product, rel=1e-12)
    assert found["stage_speed"] == pytest.approx(
        [SPEED / np.prod(RATIOS), SPEED / RATIOS[0]], rel=1e-12
    )


@pytest.mark.whole
@pytest.mark.parametrize(
    ("built", "gears", "of_pair", "ratios"),
    [
        (pair_before_set, [PAIR, SETS[0]], 0, (RATIO_OF_PAIR, RATIOS[0])),
        (set_before_pair, [SETS[0], PAIR], 1, (RATIOS[0], RATIO_OF_PAIR)),
    ],
)
def test_a_pair_before_and_behind_a_set(built, gears, of_pair, ratios):
    """The bearing of the shaft between them is pressed by the pair, whose loss it adds to."""
    made = built()
    found = figures(made)
    loads, speeds = made.carried_by_meshes(found), found["stage_speed"]
    assert speeds[1] == pytest.approx(SPEED / ratios[0], rel=1e-12)
    gear = ("gear 2", "gear 1")[of_pair]
    bearing = {"left": {**SHAFT_2, "between": [gear, "housing"]}}
    losses = [{"needles": NEEDLES}, {"needles": NEEDLES}]
    losses[of_pair] = bearing
    if built is pair_before_set:
        losses[1] = {}
    apart = [
        figures(alone(table, load, speed, losses=own))
        for table, load, speed, own in zip(
            gears, loads.tolist(), speeds.tolist(), losses, strict=True
        )
    ]
    product = np.prod([one["mean_efficiency"] for one in apart])
    # The bearing's torque goes with a power of its load other than one: means over phases differ a little.
    assert found["mean_efficiency"] == pytest.approx(product, rel=1e-9)
    assert found["bearing_load"][0] == pytest.approx(apart[of_pair]["bearing_load"][0], rel=1e-6)
    assert found["mean_loss"] == pytest.approx(sum(one["mean_loss"] for one in apart), rel=1e-6)
    assert np.isnan(found["stage_latent_power"]).tolist() == [k == of_pair for k in range(2)]
    assert made.motion[-1] == pytest.approx(np.sign(made.motion[0]) * -1 / np.prod(ratios))


@pytest.mark.whole
def test_from_rest_what_starts_a_set_is_the_load_of_the_stage_before():
    """Seals at the ends and in the sets, from the output to the input."""
    seal = {"seal_torque": "0.1 N m"}
    made = drive(
        {"gears": PAIR, "losses": {}},
        {"gears": SETS[0], "losses": {"pins": {"between": ["planet", "carrier"], **seal}}},
        losses={"seal": {"between": ["shaft 3", "housing"], **seal}},
    )
    degrees = np.array([330.0])
    mean, largest = from_rest(made, 0.0, 1e-3, degrees)
    sealed = {
        "seal": {"between": ["carrier", "housing"], **seal},
        "pins": {"between": ["planet", "carrier"], **seal},
    }
    of_set = alone(SETS[0], 1.0, SPEED, losses=sealed)
    inner = from_rest(of_set, 0.0, 1e-3 / RATIO_OF_PAIR, degrees)
    pair = alone(PAIR, 1.0, SPEED)
    for got, own in ((mean, inner[0][0]), (largest, inner[1][0])):
        point = pair.operation.__class__(own, np.array([1e-3]), degrees)
        both = torques_at_rest(pair.design, point, pair.models[0])
        assert got[0] == pytest.approx(np.asarray(both[0 if got is mean else 1]), rel=1e-12)


@pytest.mark.whole
def test_wind_up_and_inertia_are_those_of_each_set_through_the_ratios():
    """Springs one behind the other at the output, kinetic energy at the input."""
    models = {"models": {**TABLES["models"], "load_sharing": "from_stiffness"}}
    made = drive(*SETS, **models)
    sets = [alone(SETS[0], LOAD / RATIOS[1], SPEED, **models)]
    sets += [alone(SETS[1], LOAD, SPEED / RATIOS[0], **models)]
    twist = of(made, "torsion")
    first, second = (of(one, "torsion") for one in sets)
    at_output = [first["wind_up"] / RATIOS[1], second["wind_up"]]
    assert pytest.approx(np.array(at_output), rel=1e-12) == twist["stage_wind_up"].values.T
    assert twist["wind_up"].values == pytest.approx(np.sum(at_output, axis=0), rel=1e-12)
    compliance = 1 / first["tangent_torsional_stiffness"].values / RATIOS[1] ** 2
    compliance += 1 / second["tangent_torsional_stiffness"].values
    assert twist["tangent_torsional_stiffness"].values == pytest.approx(1 / compliance, rel=1e-9)
    whole, (front, back) = of(made, "reflected"), (of(one, "reflected") for one in sets)
    assert whole["reflected_inertia"].values[0] == pytest.approx(
        front["reflected_inertia"].values[0] + back["reflected_inertia"].values[0] / RATIOS[0] ** 2,
        rel=1e-12,
    )
    assert whole["drive_mass"] == pytest.approx(
        float(front["drive_mass"] + back["drive_mass"]), rel=1e-12
    )


def test_meshes_of_sets_in_a_row_are_those_of_each_set_by_itself():
    """Strength and inspection at the load and speed without losses; the loads at work with them."""
    built = two_sets()
    labels = [
        f"{number} ({pair})" for number in (1, 2) for pair in ("sun and planet", "planet and ring")
    ]
    sets = [
        alone(SETS[0], LOAD / RATIOS[1], SPEED),
        alone(SETS[1], LOAD, SPEED / RATIOS[0]),
    ]
    whole, apart = of(built, "strength"), [of(one, "strength") for one in sets]
    assert whole["stage"].values.tolist() == labels
    for name in ("tangential_force", "contact_stress", "root_stress", "mesh_load_factor"):
        each = np.concatenate([one[name].values for one in apart])
        assert whole[name].values == pytest.approx(each, rel=1e-12), name
    spans, ring = of(built, "inspection"), of(sets[1], "inspection")
    assert stages_of(spans) == (*labels,)
    for variable in ("span_measurement", "over_balls"):
        got, want = of_stage(spans, labels[3])[variable], of_stage(ring, 2)[variable]
        assert got.values == pytest.approx(want.values, rel=1e-12, nan_ok=True)
    carried = built.carried_by_meshes(figures(built))
    speeds = SPEED, SPEED / RATIOS[0]
    points = zip(SETS, carried.tolist(), speeds, strict=True)
    again = [alone(gears, load, speed) for gears, load, speed in points]
    loads = [mesh.case.operation.load for one in again for mesh in one.at_work]
    assert [mesh.case.operation.load for mesh in built.at_work] == pytest.approx(loads, rel=1e-12)
    assert not built.locked


UPPER, LOWER = ("-20 um", "-30 um", "-40 um"), ("-50 um", "-70 um", "-90 um")


def thinned(first):
    """Allowances of two neighbours among sun, planet and ring."""
    both = slice(first, first + 2)
    limits = {"upper": UPPER, "lower": LOWER}
    return {f"{name}_thickness_allowance": [*of[both]] for name, of in limits.items()}


@pytest.mark.whole
def test_allowances_of_a_set_are_those_of_its_meshes():
    """Backlash at the output by tolerances, of the short form and of two meshes with a train."""
    whole = {
        "upper_thickness_allowance": [*UPPER],
        "lower_thickness_allowance": [*LOWER],
        "centre_distance_field": "js7",
    }
    short = alone(SETS[0] | {"inspection": whole}, LOAD, SPEED)
    racks = {"fillet_radius": [0.38, 0.2]}, {"fillet_radius": 0.2}
    pairs = (("sun", "planet"), [24, 30]), (("planet", "ring"), [30, -84])
    meshes = [
        {
            "bodies": [*bodies],
            "gears": {
                "teeth": teeth,
                "inspection": thinned(first) | {"centre_distance_field": "js7"},
                **racks[first],
                **WIDTH,
            },
        }
        for first, (bodies, teeth) in enumerate(pairs)
    ]
    train = {"input": "sun", "output": "carrier", "held": "ring", "planets": 3}
    point = {"operation": operation(LOAD, SPEED)}
    long = load_case({"stages": meshes, "train": train, **point, **TABLES})
    got, want = (of(one, "reflected")["output_backlash"].values for one in (short, long))
    assert got == pytest.approx(want, rel=1e-12, abs=1e-15)
    row = drive(PAIR | {"inspection": thinned(0)}, SETS[0] | {"inspection": whole})
    with_pair = of(row, "reflected")["output_backlash"].values
    assert np.all(with_pair[1:] > got[1:]) and np.all(got[1:] > 1e-3)
    angle = (
        got[2] * RATIOS[0]
    )  # by hand: both gears of a mesh thinner by the mean of their allowances
    thin = np.array([35e-6 + 50e-6, 50e-6 + 65e-6])
    radius = 24 * 0.5e-3 * np.cos(np.pi / 9)
    assert angle == pytest.approx(thin.sum() * np.cos(np.pi / 9) / radius, rel=1e-6)


@pytest.mark.parametrize(
    ("gears", "words"),
    [
        ({"thickness_field": ["cd25", "cd24"]}, r"thickness_field: .* has 2 values; give those of sun,"),
        ({"iso_class": [6, 6]}, r"iso_class: the list has 2 values; give those of sun, planet and ring"),
        ({"upper_thickness_allowance": "0 um"}, r"was given without lower_thickness_allowance"),
    ],
)  # fmt: skip
def test_wrong_allowances_of_a_set_are_told_with_their_key(gears, words):
    with pytest.raises(InputError, match=rf"gears.inspection.{words}|gears.inspection.*{words}"):
        alone(SETS[0] | {"inspection": gears}, LOAD, SPEED)


def test_allowances_of_second_gears_stand_in_their_table():
    """A stepped set has those of sun and planets alone beside it; the centre distance is that of all."""
    limits = thinned(0)
    second = {"teeth": [24, 78], "face_width": "10 mm", "inspection": {"iso_class": 6} | limits}
    gears = {**SETS[0], "teeth": [18, 36], "second": second}
    built = alone(gears | {"inspection": limits | {"centre_distance_field": "js7"}}, LOAD, SPEED)
    tables = [mesh.case.gears.inspection for mesh in built.meshes]
    assert [one.centre_distance_field for one in tables] == ["js7"] * 2
    assert [one.iso_class for one in tables] == [None, (6.0, 6.0)]
    assert tables[1].lower_thickness_allowance == tables[0].lower_thickness_allowance
    three = {"thickness_field": ["cd25"] * 3}
    with pytest.raises(
        InputError, match=r"inspection.thickness_field: .* has 3 values, and the list"
    ):
        alone(gears | {"inspection": three}, LOAD, SPEED)


FILM = {"solver": "line", "nodes": 65, "phases": 3}
WORN = {"law": "vdi_2736", "cycles": 1e6, "rate": "1e-9 mm3/(N m)", "profile": "kept"}


def test_films_and_wear_of_a_set_are_asked_of_each_mesh():
    """Over turns of the input, by Willis those of a driver against the carrier; planets wear sun and ring."""
    row = drive(PAIR, {"gears": SETS[0], "film": FILM, "wear": WORN})
    by_itself = alone(SETS[0], LOAD, SPEED, film=FILM, wear=WORN)
    for meshes in (row.meshes[1:], by_itself.meshes):
        assert [mesh.case.film.solver for mesh in meshes] == ["line"] * 2
        tables = [mesh.case.wear for mesh in meshes]
        turns = [1e6 * (1 - 1 / RATIOS[0]), 1e6 * (84 / 30) / RATIOS[0]]
        assert [table.cycles for table in tables] == pytest.approx(turns, rel=1e-12)
        assert [table.engagements for table in tables] == [(3.0, 1.0), (1.0, 3.0)]
    assert row.meshes[0].case.wear is None


def test_inputs_of_films_and_wear_of_sets_are_told_once_as_given():
    """A set in a file of its own has its tables there, one in a row in its stage."""
    of_drive = {"operation": operation(), **TABLES}
    row = {"stages": [{"gears": PAIR}, {"gears": SETS[0], "film": FILM, "wear": WORN}], **of_drive}
    by_itself = {"gears": SETS[0], "film": FILM, "wear": WORN, **of_drive}
    for tree, table, inside in ((row, "stages", "2.wear."), (by_itself, "wear", "")):
        (manifest,) = uncomputed_manifests(tree)
        rows = [one for one in manifest["inputs"] if one["table"] == table and one["given"]]
        told = {one["key"]: one["value"] for one in rows if one["key"].startswith(inside)}
        cycles = (f"{inside}cycles", 1e6)
        assert [(key, value) for key, value in told.items() if "cycles" in key] == [cycles]
        assert told[f"{inside}law"] == "vdi_2736"


@pytest.mark.whole
def test_films_and_wear_of_a_set_in_a_row_are_those_of_the_set_alone():
    """At the load and speed that it has, driven by a pair."""
    row = drive(PAIR, {"gears": SETS[0], "film": FILM, "wear": WORN})
    by_itself = alone(SETS[0], LOAD, SPEED / RATIO_OF_PAIR, film=FILM, wear=WORN)
    for name in ("film", "wear"):
        together, apart = (whole_of(built, name) for built in (row, by_itself))
        bodies = by_itself.stage_bodies
        assert stages_of(together) == tuple(f"2 ({pair})" for pair in bodies)
        for number, pair in enumerate(bodies, 1):
            got, want = of_stage(together, f"2 ({pair})"), of_stage(apart, number)
            assert {*got.data_vars} == {*want.data_vars}
            for variable, values in want.data_vars.items():
                if np.issubdtype(values.dtype, np.floating):
                    largest = np.max(np.nan_to_num(np.abs(values.values)), initial=0.0)
                    np.testing.assert_allclose(
                        got[variable], values, rtol=1e-12, atol=1e-12 * largest
                    )


def whole_of(built, name):
    """A part of a drive, piece by piece."""
    (analysis,) = ANALYSES[name].parts(Subject(None, built))
    pieces = [analysis.compute(built, piece, lambda *_: None) for piece in analysis.pieces(built)]
    while analysis.onward is not None:
        further = analysis.onward(built, pieces[-1], lambda *_: None)
        if further is None:
            break
        pieces.append(further)
    return analysis.joined(built, pieces)


PINS = [{"pin_errors": ["2 um", 0, 0]}, {"pin_tolerance": "20 um", "floating": "sun"}]


@pytest.mark.whole
def test_planets_of_sets_in_a_row_share_as_those_of_each_set_by_itself():
    """Forces, factors and rating at the load without losses; the section tells each stage."""
    gears = [{**one, **pins} for one, pins in zip(SETS, PINS, strict=True)]
    built = drive(PAIR, *gears)
    speeds = SPEED / RATIO_OF_PAIR, SPEED / RATIO_OF_PAIR / RATIOS[0]
    loads = LOAD / RATIOS[1], LOAD
    points = zip(gears, loads, speeds, strict=True)
    apart = [alone(*point) for point in points]
    sharing = of(built, "planet_sharing")
    assert stages_of(sharing) == (2, 3)
    for label, one in zip((2, 3), apart, strict=True):
        got, want = of_stage(sharing, label), of(one, "planet_sharing")
        assert {*got.data_vars} == {*want.data_vars}
        for name in want.data_vars:
            np.testing.assert_allclose(got[name].values, want[name].values, rtol=1e-9)
    whole = of(built, "strength")
    factors = np.hstack([1.0, *(of(one, "strength")["mesh_load_factor"].values for one in apart)])
    assert factors[1] > 1.1 and factors[3] > 1.1
    assert whole["mesh_load_factor"].values == pytest.approx(factors, rel=1e-9)
    remarks = json.loads(whole.attrs["remarks"])
    assert [text[:8] for text in remarks if "by the deviations" in text] == ["Stage 2:", "Stage 3:"]


@pytest.mark.whole
def test_one_of_two_sets_may_have_pins_out_of_place():
    """The other one has no sharing, and both without pins out of place have no such part."""
    built = drive(SETS[0], {**SETS[1], **PINS[1]})
    assert stages_of(of(built, "planet_sharing")) == (2,)
    assert "ask for it" in ANALYSES["planet_sharing"].why_not(two_sets())


def test_periods_of_sets_in_a_row_are_those_of_each_set_by_itself():
    """Torques and forces over the period, under the load that each carries with all losses."""
    built = two_sets()
    loads = built.carried_by_meshes(figures(built))
    speeds = SPEED, SPEED / RATIOS[0]
    whole = of(built, "train_period")
    assert stages_of(whole) == (1, 2)
    for number, gears, load, speed in zip((1, 2), SETS, loads.tolist(), speeds, strict=True):
        got, want = of_stage(whole, number), of(alone(gears, load, speed), "train_period")
        assert {*got.data_vars} == {*want.data_vars}
        for name in want.data_vars:
            np.testing.assert_allclose(got[name], want[name], rtol=1e-9, atol=1e-12)
        assert got.attrs["driver_period"] == pytest.approx(want.attrs["driver_period"], rel=1e-12)
    assert loads[0] > 1.005 * LOAD / RATIOS[1]
    second = of_stage(whole, 2)
    mean = second["input_torque"].values[0] @ second["weight"].values
    assert mean == pytest.approx(loads[0], rel=1e-9)


def test_a_pair_beside_a_set_has_a_cycle_and_the_set_a_period():
    """What turns together once more is told of a pair; its rating is that of each mesh."""
    built = pair_before_set()
    assert ANALYSES["train_period"].why_not(built) is None
    assert "do not turn together" in ANALYSES["train_period"].why_not(built.stages[0])
    data = of(built, "strength")
    assert data["stage"].values.tolist() == ["1", "2 (sun and planet)", "2 (planet and ring)"]
    assert unlikely(built, {"strength": data}) == []


@pytest.mark.parametrize(
    ("stage", "more", "key", "told"),
    [
        ({"driver": "sun"}, {}, "stages.1.driver", "what drives a planetary set is input"),
        ({"turn": "90 deg"}, {}, "stages.1.turn", "leave it out"),
        ({"wear": {"law": "archard_1953", "cycles": 1e6, "coefficient": 1e-6}}, {},
         "stages.1.wear.profile", "share the load by their gaps"),
        ({"wear": {"law": "archard_1953", "cycles": 1e6, "hardness": ["1 GPa", "2 GPa"]}}, {},
         "stages.1.wear.hardness", "one value for sun, planets and rings"),
        ({"bodies": ["sun", "planet"]}, {}, "stages.1.bodies", "without a table [train]"),
        ({"gears": {**SETS[0], "teeth": [24, 30, 80]}}, {}, "stages.1.gears", ""),
        ({"gears": {**SETS[0], "planets": 5}}, {}, "stages.1.gears.planets", "fit"),
        ({"gears": {**SETS[0], "held": "sun"}}, {}, "stages.1.gears.held", "three different ones"),
        ({"losses": {"pin": {**NEEDLES, "between": ["carrier", "gear 1"]}}}, {},
         "stages.1.losses.pin.between", "no body"),
        ({}, {"losses": {"left": {**SHAFT_2, "position": "5 mm"},
                         "right": {**SHAFT_2, "position": "25 mm"}}}, "losses.left.position",
         "without a place"),
        ({}, {"train": {"input": "sun", "output": "carrier"}}, "stages.1.gears.family",
         "pairs of cylindrical gears"),
        ({}, {"losses": {"left": {**SHAFT_2, "between": ["carrier", "housing"]}}},
         "losses.left.between", "no body"),
    ],
)  # fmt: skip
def test_a_wrong_set_in_a_row_is_told_with_its_key(stage, more, key, told):
    """One sentence with the key that the file has."""
    with pytest.raises(InputError) as caught:
        drive({"gears": SETS[0], **stage}, SETS[1], **more)
    first = caught.value.every[0] if isinstance(caught.value, CollectedInputError) else caught.value
    assert first.key.startswith(key)
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("stages", "tables"),
    [
        ([PAIR, SETS[0]], ["stages.2.losses"]),
        (SETS, ["stages.1.losses or stages.2.losses"]),
        ([PAIR, PAIR], []),
    ],
)
def test_losses_of_planets_belong_into_the_stage_that_is_a_set(stages, tables):
    with pytest.raises(InputError, match='"planet" is no body of this drive') as caught:
        drive(*stages, losses={"needles": NEEDLES})
    told = str(caught.value).partition("losses within a set stand in its stage, ")[2]
    assert told.splitlines()[:1] == tables
