"""Quantities by other names than their keys: each answered in a sentence, and what it says to write runs."""

import copy
import re
import tomllib
from math import cos, pi, radians, tan
from types import NoneType
from typing import get_args

import pytest

from pitchpoint import Case
from pitchpoint.cases.document import resolve
from pitchpoint.cases.schema import CaseFile as Schema
from pitchpoint.cases.validation import validate
from pitchpoint.cases.wishes import WISHES
from pitchpoint.efficiency.drag_tables import Loss
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import Inspection
from pitchpoint.gears.families import TABLES
from pitchpoint.gears.planetary import PlanetaryGears
from pitchpoint.registry import letters

BASE = tomllib.loads("""
[gears]
teeth = [20, 40]
module = "2 mm"
face_width = "10 mm"
[lubricant]
name = "mineral-vg-100"
[roughness]
ra = "0.4 um"
[operation]
torque = "6 N m"
speed = "1000 rpm"
temperature = "60 degC"
""")


def asked(key, value, **gears):
    """The case with a wish, in the place of the keys that would say the same."""
    tree = copy.deepcopy(BASE)
    tree["gears"] |= gears
    table, name = key.split(".")
    wish = next(one for one in WISHES[table] if name in one.names)
    for one in wish.keys:
        tree[table].pop(one, None)
    tree[table][name] = value
    return tree


def read(tree):
    return validate(resolve(tree, name="case", variant="default"))


def refused(tree):
    with pytest.raises(InputError) as error:
        read(tree)
    return str(error.value)


WRITTEN = {
    "operation.input_torque": ("3 N m", {}, 'torque = "6 N m"'),
    "operation.motor_torque": ("3 N m", {"teeth": [20, 60]}, 'torque = "9 N m"'),
    "operation.driver_torque": (
        "0.5 N m",
        {"family": "strain_wave", "teeth": [200, 202], "module": "0.3 mm"},
        'torque = "50 N m"',
    ),
    "operation.torque_in": (
        "3 N m",
        {"family": "rack_and_pinion", "teeth": 20, "module": "2 mm"},
        'force = "150 N"',
    ),
    "operation.power": ("1 kW", {}, 'torque = "19.0986 N m"'),
    "operation.output_speed": ("500 rpm", {}, 'speed = "1000 rpm"'),
    "operation.oil_temperature": ("50 degC", {}, 'temperature = "50 degC"'),
    "operation.planets": (3, {}, 'torque = "2 N m"'),
    "gears.transverse_module": ("2 mm", {"helix_angle": "15 deg"}, 'module = "1.93185 mm"'),
    "gears.pitch_diameter": (["40 mm", "80 mm"], {}, 'module = "2 mm"'),
    "gears.tip_diameter": (["43.8 mm", "84 mm"], {}, "tip_alteration = [-0.05, 0]"),
    "gears.root_diameter": (["35 mm", "75 mm"], {}, "dedendum = [1.25, 1.25]"),
    "gears.hob_addendum": ("2.4 mm", {}, "dedendum = 1.2"),
    "gears.tip_radius": ("0.5 mm", {}, "fillet_radius = 0.25"),
    "gears.z": ([20, 40], {}, "teeth = [20, 40]"),
    "gears.m_n": ("2 mm", {}, 'module = "2 mm"'),
    "gears.b": (["10 mm", "9 mm"], {}, 'face_width = ["10 mm", "9 mm"]'),
    "gears.beta": ("15 deg", {}, 'helix_angle = "15 deg"'),
    "gears.circumferential_backlash": ("0.1 mm", {}, 'backlash = "0.1 mm"'),
    "gears.x": ([0.1, 0.2], {}, "profile_shift = [0.1, 0.2]"),
    "gears.lead_angle": ("75 deg", {}, 'helix_angle = "15 deg"'),
    "gears.accuracy": (6, {}, "inspection = { iso_class = 6 }"),
    "roughness.rz": ("3 um", {}, 'ra = "0.5 um"'),
    "lubricant.iso_vg": (220, {}, 'name = "mineral-vg-220"'),
}


@pytest.mark.parametrize("key", WRITTEN)
def test_what_a_wish_is_told_to_write_runs(key):
    value, gears, line = WRITTEN[key]
    tree, (table, name) = asked(key, value, **gears), key.split(".")
    told = refused(tree)
    assert told.startswith(f"case: {key}: is not a known key: ")
    assert f"; write {line}" in told and "\n" not in told
    del tree[table][name]
    tree[table] |= tomllib.loads(line)
    read(tree)


def test_what_stands_under_two_names_makes_one_list():
    tree = copy.deepcopy(BASE)
    tree["gears"] |= {"z1": 20, "z2": 40}
    del tree["gears"]["teeth"]
    assert refused(tree).count("write teeth = [20, 40]") == 2
    tree["gears"] = {**BASE["gears"], "x_1": 0.1}
    assert "the key is profile_shift" in refused(tree)  # that of gear 2 is not known


def test_wear_by_other_names_is_asked_for_as_cycles() -> None:
    tree = copy.deepcopy(BASE) | {"wear": {"law": "archard_1953", "turns": 1e6, "k": 1e-7}}
    told = refused(tree)
    assert (
        "wear.turns: is not a known key: cycles are turns of the driver; write cycles = 1e+06"
        in told
    )
    assert "write coefficient = 1e-07" in told
    read(
        copy.deepcopy(BASE)
        | {"wear": tomllib.loads("law = 'archard_1953'\ncycles = 1e+06\ncoefficient = 1e-07")}
    )


def test_tables_of_other_programs_are_answered():
    told = refused(copy.deepcopy(BASE) | {"oil": {}, "strength": {"KA": 1.25, "SHmin": 1.2}})
    assert "oil: is not a known table: the oil has a table [lubricant]" in told
    assert (
        "strength.KA: is not a known key: K_A is the application factor; write application_factor = 1.25"
        in told
    )
    assert "strength.SHmin: is not a known key: safeties are results" in told


def test_what_follows_from_other_keys_names_them():
    for name, words in (
        ("form_diameter", "follows from the rack and its fillet; the key is fillet_radius"),
        ("base_pitch", "follow from module and pressure angle; the key is"),
        ("internal", "a ring is gear 2 with a negative number of teeth; the key is teeth"),
    ):
        tree = copy.deepcopy(BASE)
        tree["gears"][name] = 3
        told = refused(tree)
        assert words in told and "did you mean" not in told
    told = refused(copy.deepcopy(BASE) | {"strength": {"K_gamma": 1.2}})
    assert "K_γ is the mesh load factor; write mesh_load_factor = 1.2" in told


def test_a_grade_is_a_part_of_several_names_of_oils():
    for name in ("VG 220", "ISO VG 220", "vg220"):
        told = refused(copy.deepcopy(BASE) | {"lubricant": {"name": name}})
        assert "mineral-vg-220" in told and "pao-vg-220" in told


def test_torque_of_the_driver_is_never_taken_for_that_of_the_driven_gear():
    told = refused(asked("operation.input_torque", "2.5 N m"))
    assert "torque counts at the driven gear" in told and "did you mean" not in told
    assert 'torque = "1.25 N m"' in refused(
        asked("operation.input_torque", "2.5 N m")
        | {"operation": {**BASE["operation"], "driver": "gear 2", "input_torque": "2.5 N m"}}
    )
    stages = {key: value for key, value in BASE.items() if key != "gears"}
    stages["stages"] = [{"gears": BASE["gears"]}, {"gears": BASE["gears"]}]
    stages["operation"] = {**BASE["operation"], "input_torque": "1 N m"}
    assert 'torque = "4 N m"' in refused(stages)


@pytest.mark.parametrize("helix", [0.0, 25.0])
def test_a_backlash_along_the_normal_is_answered_with_that_on_the_pitch_circles(helix):
    told = refused(asked("gears.j_bn", "0.1 mm", helix_angle=f"{helix} deg"))
    on_circles = float(re.search(r'backlash = "([\d.]+) um"', told)[1])
    # without profile shifts the pitch circles are the reference circles: j_bn = j_t cos(beta) cos(alpha_n)
    assert on_circles * cos(radians(helix)) * cos(radians(20.0)) == pytest.approx(100.0, rel=1e-5)


@pytest.mark.parametrize("distance", ["20 mm", "200 mm"])
def test_a_backlash_that_no_teeth_have_gets_no_number(distance):
    """Base circles that reach beyond the distance, and teeth that do not reach one another."""
    told = refused(asked("gears.j_bn", "0.1 mm", centre_distance=distance))
    assert told.endswith("not along the normal; the key is backlash")
    told = refused(
        BASE | {"gears": BASE["gears"] | {"backlash": "0.1 mm", "centre_distance": "200 mm"}}
    )
    assert told.endswith("have more; give a centre distance nearer to 60 mm")


ELSEWHERE = {
    "module": "[gears] has that key",
    "force": "[operation] and [loss_map] have that key",
    "seal_torque": "[losses.NAME] has that key",
    "gears.span_teeth": "[gears.inspection] has that key",
    "operation.temperatures": "did you mean temperature?",
}


@pytest.mark.parametrize("key", ELSEWHERE)
def test_a_key_of_another_table_is_no_misspelt_neighbour(key):
    tree = copy.deepcopy(BASE)
    *above, name = key.split(".")
    (tree[above[0]] if above else tree)[name] = 2
    assert refused(tree) == f"case: {key}: is not a known key; {ELSEWHERE[key]}"


ARRANGED = {
    "in a list": (
        {"gears": [{"teeth": 20}, {"teeth": 50}]},
        "one table [gears] belongs; a list in it has",
    ),
    "each its own": (
        {"gear_1": {"teeth": 20}},
        "gear_1: is not a known table: both gears have one table",
    ),
    "with steel": (
        {"gears": BASE["gears"] | {"material": "steel"}},
        "materials have a table [materials]",
    ),
    "a set": (
        {"gears": BASE["gears"] | {"family": "planetary", "teeth": [17, 22, -61]}},
        "below zero; teeth of a set are positive, those of the ring too",
    ),
}


@pytest.mark.parametrize("name", ARRANGED)
def test_tables_as_other_programs_arrange_them(name):
    changes, words = ARRANGED[name]
    assert words in refused(BASE | changes)


def test_a_table_of_stages_without_numbers():
    drive = {key: value for key, value in BASE.items() if key != "gears"}
    told = refused(drive | {"stages": {"gears": BASE["gears"]}})
    assert 'there is no stage "gears"; use stages.1, or a table [[stages]] for each mesh' in told


def test_keys_of_the_gears_of_a_stage_are_sent_there():
    tree = {**BASE, "stages": [{"gears": BASE["gears"], "module": 2}, {"gears": BASE["gears"]}]}
    del tree["gears"]
    assert refused(tree) == (
        "case: stages.1.module: is not a known key; [stages.1.gears] has that key"
    )
    del tree["stages"][0]["module"]
    tree["teeth"] = 20
    assert refused(tree) == "case: teeth: is not a known key; [stages.1.gears] has that key"


def test_a_key_in_the_place_of_a_named_table_is_sent_into_one():
    told = refused(BASE | {"losses": {"breakaway_spread": 2}})
    assert told.endswith("a key of each table in [losses], such as losses.NAME.breakaway_spread")
    assert refused(BASE | {"losses": {"seal": 2}}).endswith("was given where a table belongs")


def test_tip_alterations_for_tip_diameters_make_them():
    tree = asked("gears.tip_diameter", ["44.3 mm", "116.2 mm"], teeth=[20, -60])
    alteration = tomllib.loads(refused(tree).partition("; write ")[2])["tip_alteration"]
    addendum, module = 1.0, 2.0
    made = [
        z * module + 2.0 * module * (addendum + k)
        for z, k in zip((20, -60), alteration, strict=True)
    ]
    assert made == pytest.approx([44.3, -116.2], abs=1e-4)


def test_angles_of_other_sections():
    told = refused(asked("gears.alpha_wt", "22 deg"))
    assert f'"{60.0 * cos(radians(20)) / cos(radians(22)):.6g} mm"' in told
    told = refused(asked("gears.transverse_pressure_angle", "20 deg", helix_angle="15 deg"))
    normal = float(re.search(r'pressure_angle = "([\d.]+) deg"', told)[1]) * pi / 180
    assert tan(normal) / cos(radians(15)) == pytest.approx(tan(radians(20)), rel=1e-5)


def test_a_diametral_pitch_is_a_module():
    tree = copy.deepcopy(BASE)
    tree["gears"]["module"] = "20 DP"
    assert read(tree).gears.module == 1.27e-3
    tree["gears"]["module"] = "20 1/in"
    assert read(tree).gears.module == 1.27e-3
    document = resolve(asked("gears.diametral_pitch", 20), name="case", variant="default")
    assert validate(document).gears.module == 1.27e-3
    assert document.provenance["gears.module"].note == "by the diametral pitch 20"
    told = refused(asked("gears.diametral_pitch", 20, helix_angle="15 deg"))
    assert 'module = "20 DP"' in told and 'module = "1.22673 mm"' in told and "missing" not in told
    tree["gears"]["diametral_pitch"] = 20
    assert 'write module = "20 DP"' in refused(tree)


def test_of_two_face_widths_the_smaller_one_is_common():
    tree = copy.deepcopy(BASE)
    tree["gears"]["face_width"] = ["20 mm", "18 mm"]
    assert read(tree).gears.face_width == 0.018
    assert Case(BASE).set(face_width=["12 mm", 0.011])["gears.face_width"] == 0.011
    tree["gears"]["face_width"] = ["20 mm", "18 mm", "3 mm"]
    assert "has 3 values" in refused(tree)


def test_what_gears_do_not_have_is_told_without_a_neighbour_in_spelling():
    wave = {"family": "strain_wave", "teeth": [200, 202]}
    for key, value in (("tip_diameter", "80 mm"), ("hob_addendum", 1.2)):
        told = refused(asked(f"gears.{key}", value, **wave))
        assert "did you mean" not in told and "; known are family, teeth" in told
    told = refused(asked("gears.tip_diameter", "much"))  # no number, and no sentence about that
    assert told.endswith("tip alteration; the key is tip_alteration")


def test_python_and_settings_answer_too():
    with pytest.raises(InputError, match="torque counts at the driven gear; the key is torque"):
        Case(BASE).set(input_torque="2.5 N m")
    with pytest.raises(InputError, match="counts on the pitch circles; the key is backlash"):
        Case(BASE).set({"gears.j_wt": "0.1 mm"})


OTHER_TABLES = {
    "": [Schema],
    "gears": TABLES,
    "gears of a set": [PlanetaryGears],
    "gears.inspection": [Inspection],
    "losses.NAME": [Loss],
}


@pytest.mark.parametrize("table", WISHES)
def test_no_wish_is_a_key_and_none_stands_twice(table):
    names = [letters(name) for wish in WISHES[table] for name in wish.names]
    assert len(names) == len(set(names))
    tables = OTHER_TABLES.get(table) or [Schema.model_fields[table].annotation]
    tables = [form for one in tables for form in (get_args(one) or [one])]
    for one in filter(lambda one: one is not NoneType, tables):
        fields = {letters(key): key for key in one.model_fields}
        taken = {fields[name] for name in names if name in fields}
        assert taken <= {
            "backlash"
        }  # a key of cylindrical pairs and strain wave gears, and of no others


UNITS_LEFT_OUT = {
    ("roughness", "ra", 0.4): 'write "0.4 um" or use one of m',  # 0.4 mm is out of the range
    ("roughness", "ra", 400): 'write "400 nm" or use one of m',  # out of the range in um and in mm
    ("operation", "speed", 1200): 'write "1200 rpm" or',
    ("strength", "life", 20000): 'write "20000 h" or use one of s',
    ("materials", "hardness", 200): 'write "200 HV" or',  # 200 GPa is out of the range
    ("gears", "pressure_angle", 20): 'write "20 deg" or "20 rad" or',
}


@pytest.mark.parametrize("place", UNITS_LEFT_OUT)
def test_a_missing_unit_is_the_one_of_the_key(place):
    table, key, value = place
    solid = {"young": "206 GPa", "poisson": 0.3, key: value}
    inside = {"gear_1": solid} if table == "materials" else BASE.get(table, {}) | {key: value}
    assert UNITS_LEFT_OUT[place] in refused(BASE | {table: inside})


def test_what_a_wish_is_told_to_write_has_its_unit():
    assert refused(asked("gears.beta", 15)).endswith("cylinders; the key is helix_angle")


def test_an_oil_of_a_maker_is_answered_with_its_grade():
    told = refused(BASE | {"lubricant": {"name": "Mobil SHC 220"}})
    assert "did you mean mineral-vg-220 or pao-vg-220 or pag-vg-220? Any other oil is given" in told


SET = BASE | {
    "gears": {
        "family": "planetary",
        "teeth": [24, 30, 84],
        "module": "1 mm",
        "face_width": "12 mm",
    },
    "operation": BASE["operation"] | {"torque": "60 N m"},
}
OF_SET = {
    "n_planets": (4, "planets = 4"),
    "planet_count": (4, "planets = 4"),
    "floating_sun": (True, 'floating = "sun"'),
    "pin_error": (["10 um", "0 um", "0 um"], 'pin_errors = ["10 um", "0 um", "0 um"]'),
    "fixed": ("ring", 'held = "ring"'),
    "z": ([24, 30, 84], "teeth = [24, 30, 84]"),
    "quality": (6, "inspection = { iso_class = 6 }"),
}


@pytest.mark.parametrize("name", OF_SET)
def test_keys_of_a_set_by_other_names(name):
    value, line = OF_SET[name]
    told = refused(SET | {"gears": SET["gears"] | {name: value}})
    assert told.startswith(f"case: gears.{name}: is not a known key: ") and told.endswith(line)
    pins = {"pin_tolerance": "20 um"} if name == "floating_sun" else {}
    read(SET | {"gears": SET["gears"] | pins | tomllib.loads(line)})


def test_teeth_of_a_set_each_by_itself_make_one_list():
    rest = {key: value for key, value in SET["gears"].items() if key != "teeth"}
    for names in (("sun_teeth", "planet_teeth", "ring_teeth"), ("z1", "z2", "z3")):
        told = refused(SET | {"gears": rest | dict(zip(names, (24, 30, -84), strict=True))})
        assert told.count("write teeth = [24, 30, 84]") == 3 and "missing" not in told
    assert refused(SET | {"gears": rest}).endswith("is missing; write a list such as [24, 30, 84]")


@pytest.mark.parametrize("name", ["backlash", "deviations"])
def test_what_a_set_does_not_have_its_meshes_as_stages_have(name):
    value = "60 um" if name == "backlash" else {"iso_class": 6}
    assert "write its meshes as [[stages]] with a [train]" in refused(
        SET | {"gears": SET["gears"] | {name: value}}
    )
    common = {"module": "1 mm", "face_width": "12 mm", "fillet_radius": 0.2, name: value}
    drive = {key: table for key, table in SET.items() if key != "gears"}
    meshes = {("sun", "planet"): [24, 30], ("planet", "ring"): [30, -84]}
    read(
        drive
        | {
            "stages": [
                {"bodies": [*bodies], "gears": common | {"teeth": teeth}}
                for bodies, teeth in meshes.items()
            ],
            "train": {"input": "sun", "output": "carrier", "held": "ring", "planets": 3},
        }
    )


def test_load_of_a_set_by_its_input_counts_what_is_held():
    point = {"speed": "1000 rpm", "temperature": "60 degC", "input_torque": "10 N m"}
    assert 'write torque = "45 N m"' in refused(SET | {"operation": point})  # 1 + 84 / 24
    held = SET["gears"] | {"held": "carrier", "output": "ring"}
    assert 'write torque = "35 N m"' in refused(SET | {"gears": held, "operation": point})


def test_places_of_losses_and_of_inspection_have_wishes_of_their_own():
    told = refused(BASE | {"losses": {"seal": {"torque": "0.1 N m"}}})
    assert 'sliding seal; write seal_torque = "0.1 N m"' in told
    assert 'losses.seal.between: is missing; write a list such as ["gear 1", "housing"]' in told
    read(BASE | {"losses": {"seal": {"seal_torque": "0.1 N m", "between": ["gear 1", "housing"]}}})
    for place in ({"losses": {"lubricant": {"temperature": "60 degC"}}},):
        assert "the temperature of the oil" not in refused(BASE | place)
    told = refused(BASE | {"gears": BASE["gears"] | {"inspection": {"quality": 6}}})
    assert told.endswith("write iso_class = 6")
    told = refused(BASE | {"gears": BASE["gears"] | {"inspection": {"x": 6}}})
    assert "profile shifts" not in told


def test_a_wish_in_another_table_is_sent_to_its_own():
    told = refused(BASE | {"operation": BASE["operation"] | {"K_A": 1.25}})
    assert told.endswith("K_A is the application factor: application_factor in [strength]")
    told = refused(BASE | {"operation": BASE["operation"] | {"b": 1}})  # one letter means too much
    assert "face" not in told


SLIPS = {
    "rpm": (1200, 'write speed = "1200 rpm"'),
    "load_spectrum": ([[60, 1200, 1]], "each further one is a table [variants.NAME]"),
    "version": (1, "it decides nothing; write it into title or summary"),
    "variant": ({"cold": {}}, "tables [variants.NAME], each with what differs"),
    "pinion": ("steel", "in the order of their numbers of teeth"),
    "accuracy": ("AGMA 10", "is a key of [gears.deviations] and of [gears.inspection]; the key is"),
}


@pytest.mark.parametrize("name", SLIPS)
def test_names_that_mean_something_else_than_their_neighbours(name):
    value, words = SLIPS[name]
    places = {"rpm": "operation", "load_spectrum": "operation", "accuracy": "gears"}
    tree = copy.deepcopy(BASE) | {"materials": {}}
    table = (
        tree["materials" if name == "pinion" else places[name]]
        if name in places or name == "pinion"
        else tree
    )
    table[name] = value
    assert words in (told := refused(tree)) and "did you mean" not in told


def test_two_values_in_one_text_are_a_list_of_both_gears():
    for key, value, line in (
        ("teeth", "20,40", "[20, 40]"),
        ("profile_shift", "0.4, -0.2", "[0.4, -0.2]"),
    ):
        told = refused(BASE | {"gears": BASE["gears"] | {key: value}})
        assert f"for gear 1 and gear 2 write the list {line}; allowed is" in told
        read(BASE | {"gears": BASE["gears"] | tomllib.loads(f"{key} = {line}")})
