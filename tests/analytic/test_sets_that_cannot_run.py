"""What is said of sets and trains that cannot run, and that advice for them ends in a case that does."""

import numpy as np
import pytest
from set_cases import PIN, PLANETARY, SET, STEPPED, TABLES, THREE_K, gears

import pitchpoint as pp
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.runs.run import load_case


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
