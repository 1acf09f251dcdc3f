"""3K and stepped sets as stages of a drive, and materials of their gears."""

import numpy as np
import pytest
from planetary_sets import (
    PAIR,
    RATIO_OF_PAIR,
    RATIOS,
    SETS,
    SPEED,
    TABLES,
    alone,
    by_themselves,
    drive,
    figures,
    of,
    operation,
)

from pitchpoint.errors import InputError
from pitchpoint.runs.run import load_case


def three_k(**more):
    """Gears of a 3K set in the short form: second gears on the planets, and their ring."""
    second = {"teeth": [34, 88], "face_width": "10 mm", **more}
    one = {"teeth": [18, 36, 90], "module": "1 mm", "face_width": "10 mm"}
    return {"family": "planetary", **one, "second": second}


@pytest.mark.whole
def test_second_gears_of_the_planets_make_a_3k_set():
    """The short form is the same as three meshes with a train."""
    short = alone(three_k(), 60.0, SPEED)
    teeth = {
        ("sun", "planet"): [18, 36],
        ("planet", "ring"): [36, -90],
        ("planet", "out"): [34, -88],
    }
    width = {"module": "1 mm", "face_width": "10 mm"}
    meshes = [
        {
            "bodies": [*bodies],
            "gears": {"teeth": z, "fillet_radius": [0.38, 0.2] if z[1] > 0 else 0.2, **width},
        }
        for bodies, z in teeth.items()
    ]
    train = {"input": "sun", "output": "out", "held": "ring", "planets": 3}
    point = {"operation": operation(60.0, SPEED)}
    long = load_case({"stages": meshes, "train": train, **point, **TABLES})
    assert short.case.gears.output == "second ring"
    assert 1.0 / short.motion[short.case.bodies.index("second ring")] == pytest.approx(176.0)
    got, want = figures(short), figures(long)
    for name in ("mean_efficiency", "mean_input_torque", "stage_loss"):
        assert got[name] == pytest.approx(want[name], rel=1e-9), name
    # Events of its meshes coincide: which contacts carry at them does not hang on rounding.
    for name in ("max_input_torque", "min_input_torque", "max_efficiency", "min_efficiency"):
        assert got[name] == pytest.approx(want[name], rel=1e-9), name


@pytest.mark.whole
def test_a_3k_set_is_a_stage():
    """A pair before it: the product of both, each from a file of its own."""
    made = drive(PAIR, three_k())
    found = figures(made)
    apart = by_themselves(made, [PAIR, three_k()], found)
    product = np.prod([one["mean_efficiency"] for one in apart])
    assert found["mean_efficiency"] == pytest.approx(product, rel=1e-9)
    assert made.motion[-1] == pytest.approx(-1.0 / RATIO_OF_PAIR / 176.0)
    labels = of(made, "strength")["stage"].values.tolist()
    assert labels == [
        "1",
        "2 (sun and planet)",
        "2 (planet and ring)",
        "2 (planet and second ring)",
    ]


@pytest.mark.parametrize(
    ("more", "ends", "key", "told"),
    [
        ({"teeth": [34, 30]}, {}, "second.teeth", "not around a gear of 34 teeth"),
        ({"teeth": [34, -88]}, {}, "second.teeth", "numbers below zero"),
        ({"teeth": [34, 88, 3]}, {}, "second.teeth", "the second gear of the planets and of its ring"),
        ({"teeth": [34, 120]}, {}, "second.teeth", "it has some 88"),
        ({"module": "1.2 mm"}, {}, "second.teeth", "it has some 79"),
        ({"tip_alteration": [0, 3]}, {}, "second.tip_alteration", "out of range"),
        ({}, {"output": "carrier"}, "output", "the carrier bears planets alone"),
        ({}, {"held": "second ring"}, "held", "none of them is the ring"),
    ],
)  # fmt: skip
def test_wrong_second_gears_are_told_with_their_key(more, ends, key, told):
    """One sentence with the key that the table has."""
    with pytest.raises(InputError) as caught:
        alone({**three_k(**more), **ends}, 60.0, SPEED)
    assert told in str(caught.value)
    assert f"gears.{key}" in str(caught.value)


def stepped(**more):
    """Gears of a stepped set in the short form: the ring meshes with second gears of the planets."""
    second = {"teeth": [24, 78], "face_width": "10 mm"}
    table = {"teeth": [18, 36], "module": "1 mm", "face_width": "12 mm", "second": second}
    return {"family": "planetary", **table, **more}


@pytest.mark.whole
def test_a_stepped_set_is_the_train_of_its_meshes():
    """The short form is two meshes with a train, with the ratio of its teeth."""
    width = {"module": "1 mm"}
    meshes = [
        {
            "bodies": ["sun", "planet"],
            "gears": {
                "teeth": [18, 36],
                "fillet_radius": [0.38, 0.2],
                "face_width": "12 mm",
                **width,
            },
        },
        {
            "bodies": ["planet", "ring"],
            "gears": {"teeth": [24, -78], "fillet_radius": 0.2, "face_width": "10 mm", **width},
        },
    ]
    train = {"input": "sun", "output": "carrier", "held": "ring", "planets": 3}
    point = {"operation": operation(60.0, SPEED)}
    built = alone(stepped(), 60.0, SPEED)
    got = figures(built)
    want = figures(load_case({"stages": meshes, "train": train, **point, **TABLES}))
    assert built.design.ratio == pytest.approx(1 + 36 * 78 / (18 * 24), rel=1e-12)
    assert [one.design.mesh.face_width for one in built.stages] == [12e-3, 10e-3]
    for name in ("mean_efficiency", "max_input_torque", "stage_loss", "stage_speed"):
        assert got[name] == pytest.approx(want[name], rel=1e-9), name


@pytest.mark.whole
def test_a_stepped_set_is_a_stage():
    """A pair before it and a simple set behind it: the product of all, each from a file of its own."""
    gears = [PAIR, stepped(), SETS[0]]
    made = drive(*gears)
    found = figures(made)
    apart = by_themselves(made, gears, found)
    product = np.prod([one["mean_efficiency"] for one in apart])
    assert found["mean_efficiency"] == pytest.approx(product, rel=1e-9)
    assert abs(made.motion[-1]) == pytest.approx(1.0 / RATIO_OF_PAIR / 7.5 / RATIOS[0])
    assert of(made, "strength")["stage"].values.tolist()[1:3] == [
        "2 (sun and planet)",
        "2 (planet and ring)",
    ]


@pytest.mark.parametrize(
    ("more", "key", "told"),
    [
        ({"planets": 4}, "planets", "of 1 to 8 planets fit 1, 2, 3"),
        ({"teeth": [15, 90], "second": {"teeth": [42, 147], "face_width": "10 mm"}}, "planets",
         "the planets run into each other"),
        ({"face_width": ["12 mm"] * 3}, "face_width", "give those of these two here and that of the ring"),
        ({"tip_alteration": [0, 0, 0]}, "tip_alteration", "that of the ring in the table second"),
        ({"second": {"teeth": [24, 90], "face_width": "10 mm"}}, "second.teeth", "it has some 78"),
        ({"second": {"teeth": [24, 20], "face_width": "10 mm"}}, "second.teeth", "not around a gear of 24"),
        ({"output": "second ring"}, "output", "three different ones of sun, carrier, ring"),
        ({"fillet_radius": [0.38, 0.2, 0.6]}, "fillet_radius", "runs with fillet_radius = [0.38, 0.2, 0.44]"),
        ({"cutter_teeth": 70}, "cutter_teeth", "runs with addendum = [1, 1, 0.807]"),
    ],
)  # fmt: skip
def test_a_wrong_stepped_set_is_told_with_its_key(more, key, told):
    """One sentence with the key that the table has."""
    with pytest.raises(InputError) as caught:
        alone(stepped(**more), 60.0, SPEED)
    assert told in str(caught.value)
    assert f"gears.{key}:" in str(caught.value)


@pytest.mark.whole
def test_second_gears_with_as_many_teeth_as_the_first_are_gears_of_their_own():
    """Other shifts than the first have, teeth that one mate loads, a name of their own."""
    second = {
        "teeth": [36, 90],
        "face_width": "10 mm",
        "profile_shift": [0.1, "from centre distance"],
    }
    built = alone(stepped(second=second), 60.0, SPEED)
    factors = [one.case.strength.mean_stress_factor for one in built.meshes]
    assert factors == [(1.0, 1.0), (1.0, 1.0)]
    names = [member.body for mesh in built.member_motions for member in mesh]
    assert names == ["sun", "planet, gear 1 of 36 teeth", "planet, gear 2 of 36 teeth", "ring"]
    same = load_case({"gears": SETS[0], **TABLES, "operation": operation(60.0, SPEED)})
    assert [one.case.strength.mean_stress_factor for one in same.meshes] == [(1.0, 0.7), (0.7, 1.0)]
    written = spelt_out_with_equal_gears()
    spelt_out = load_case(written)
    assert [member.body for mesh in spelt_out.member_motions for member in mesh] == names
    assert [one.case.strength.mean_stress_factor for one in spelt_out.meshes] == factors
    assert figures(spelt_out)["mean_efficiency"] == pytest.approx(
        figures(built)["mean_efficiency"], rel=1e-12
    )


def spelt_out_with_equal_gears(**second):
    """A stepped set whose planets have two gears of 36 teeth, written as meshes with a train."""
    width = {"module": "1 mm", "fillet_radius": 0.2}
    sun = {"teeth": [18, 36], "face_width": "12 mm", **width, "fillet_radius": [0.38, 0.2]}
    shifts = [0.1, "from centre distance"]
    ring = {"teeth": [36, -90], "face_width": "10 mm", "profile_shift": shifts, **width}
    ring["centre_distance"] = "27 mm"
    return {
        "stages": [
            {"bodies": ["sun", "planet"], "gears": sun},
            {"bodies": ["planet", "ring"], "gears": ring, **{"planet_gear": 2, **second}},
        ],
        "train": {"input": "sun", "output": "carrier", "held": "ring"},
        "operation": operation(60.0, SPEED),
        **TABLES,
    }


def test_a_second_gear_of_written_planets_is_told_from_the_first_by_its_number():
    """Without it the planets would have two shifts; it counts for planets of a train alone."""
    with pytest.raises(InputError, match=r"it is one gear; a second one .* has planet_gear = 2"):
        load_case(spelt_out_with_equal_gears(planet_gear=1))
    with pytest.raises(InputError, match=r"stages.1.planet_gear: was given for a mesh without"):
        drive({"gears": PAIR, "planet_gear": 2}, PAIR)
    with pytest.raises(InputError, match=r"stages.2.planet_gear: .* whole"):
        load_case(spelt_out_with_equal_gears(planet_gear=1.5))


def test_an_output_that_stands_still_is_told_with_the_table_of_the_set():
    """Two rings alike on planets alike turn alike."""
    with pytest.raises(InputError) as caught:
        alone(three_k(teeth=[36, 90]), 60.0, SPEED)
    assert caught.value.key == "gears"


IRON = {"young": "170 GPa", "poisson": 0.28, "density": "7200 kg/m^3", "hardness": "250 HB"}
BRONZE = {"young": "110 GPa", "poisson": 0.34}
OF_GEARS = {"sun": "steel", "planet": BRONZE, "ring": IRON}
LIMITS = {"sigma_hlim": "600 MPa", "sigma_flim": "200 MPa", "treatment": "through_hardened"}


def contact_stresses(**tree):
    point = {"operation": operation(60.0, SPEED), "strength": LIMITS}
    return of(load_case({**tree, **TABLES, **point}), "strength")["contact_stress"].values


@pytest.mark.whole
@pytest.mark.parametrize(("gears", "last"), [(SETS[0], "ring"), (three_k(), "second_ring")])
def test_gears_of_a_set_have_materials_of_their_own(gears, last):
    """The same as of the meshes, each with its two; a set in a row takes those of the drive."""
    materials = {**OF_GEARS, last: IRON}
    built = alone(gears, 60.0, SPEED, materials=materials)
    pairs = [["sun", "planet"], ["planet", "ring"], ["planet", "second_ring"]]
    meshes = [
        {**mesh, "materials": {"gear_1": materials[first], "gear_2": materials[second]}}
        for (first, second), mesh in zip(pairs, built.case.gears.meshes(), strict=False)
    ]
    spelt_out = contact_stresses(stages=meshes, train=built.case.gears.train())
    steel = contact_stresses(gears=gears)
    found = contact_stresses(gears=gears, materials=materials)
    np.testing.assert_allclose(found, spelt_out, rtol=1e-12)
    assert (found < 0.95 * steel).all()
    row = drive(PAIR, gears, materials={"gear_2": IRON, **materials})
    for mine, other in zip(row.meshes[1:], built.meshes, strict=True):
        assert [one.record.young.value for one in mine.solids] == [
            one.record.young.value for one in other.solids
        ]
    assert row.meshes[0].solids[1].record.young.value == pytest.approx(170e9)


@pytest.mark.parametrize(
    ("materials", "key", "told"),
    [
        (
            {"sun": "steel", "second_ring": "steel"},
            "second_ring",
            "gears of this set are sun, planet, ring",
        ),
        ({"sun": "steel", "gear_2": "steel"}, "gear_2", "gears of this set are sun, planet, ring"),
        ({"planets": "steel"}, "planets", "those of its sun, planet and ring"),
        ({"sun": "stele"}, "sun", "did you mean steel"),
    ],
)
def test_materials_of_other_gears_are_told_with_their_key(materials, key, told):
    with pytest.raises(InputError) as caught:
        alone(SETS[0], 60.0, SPEED, materials=materials)
    assert told in str(caught.value)
    assert f"materials.{key}:" in str(caught.value)


def test_gears_of_sets_have_no_materials_where_there_is_none():
    with pytest.raises(InputError, match=r"materials.sun: .* use gear_1 and gear_2"):
        drive(PAIR, PAIR, materials={"sun": "steel"})


@pytest.mark.parametrize("text", ['["20 um", 0, 0]', '["20 um", "0", 0.0]'])
def test_pins_in_their_place_need_no_unit(tmp_path, text):
    tables = [
        f"[gears]\nfamily = 'planetary'\nteeth = [24, 30, 84]\nmodule = '1 mm'\npin_errors = {text}",
        "face_width = '12 mm'\n[lubricant]\nname = 'pao-vg-150'\n[roughness]\nra = '0.4 um'",
        "[operation]\ntorque = '60 N m'\nspeed = '3000 rpm'\ntemperature = '60 degC'",
    ]
    (tmp_path / "case.toml").write_text("\n".join(tables))
    assert load_case(tmp_path / "case.toml").case.train.pin_errors == (20e-6, 0.0, 0.0)
    (tmp_path / "case.toml").write_text("\n".join(tables).replace('"20 um"', "20"))
    with pytest.raises(
        InputError, match=r'"20" has no unit where a length is needed; write "20 um"'
    ):
        load_case(tmp_path / "case.toml")


@pytest.mark.whole
def test_a_mesh_that_carries_nothing_without_losses_does_not_lock_a_set():
    """Between two rings alike the held sun bears what their meshes lose, on the flank that they press."""
    second = {"teeth": [25, 96], "face_width": "8.78 mm", "module": "0.486 mm"}
    second["profile_shift"] = [0.022, "from centre distance"]
    ends = {"input": "ring", "output": "second ring", "held": "sun"}
    table = {"family": "planetary", "teeth": [44, 25, 96], "planets": 5, "module": "0.5 mm"}
    table |= {
        "face_width": "6.42 mm",
        "profile_shift": [0.278, 0.05],
        "fillet_radius": [0.3, 0.2, 0.1],
    }
    built = alone({**table, **ends, "second": second}, 2.0, SPEED)
    found = figures(built)
    assert not found["locked"]
    taken = found["mean_input_torque"] * SPEED
    assert taken == pytest.approx(2.0 * SPEED * built.output_rate + found["mean_loss"], rel=1e-9)
    # Of each ring mesh about the loss of a pair with this coefficient.
    assert 0.98 < found["mean_efficiency"] < 0.999
