"""Every value of a case file that can be wrong gets one clear sentence.

The broken case files are made by walking the schema: a field that is added to it is tested here
by itself, or fails `test_the_walk_reaches_every_table`.
"""

import copy
import json
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from called import written
from pydantic import BaseModel
from schema_sites import LIST, SITES, TABLE, TABLES, Bad, Path_, at, bads_at, of_quantity, put
from sound import quick_first
from whole_cases import BASE, BASES, DRIVE, GANTRY, RIG

from pitchpoint import cli
from pitchpoint.cases.document import resolve
from pitchpoint.cases.laws import FRICTION, FrictionChoice
from pitchpoint.cases.validation import validate
from pitchpoint.errors import InputError
from pitchpoint.gears import gears_table as every
from pitchpoint.gears.gears_table import MODULE
from pitchpoint.input.kinds import COEFFICIENT
from pitchpoint.input.tables import Table
from pitchpoint.lubrication.conditions import law_arguments


def bad_keys() -> Iterator[Bad]:
    for model, base, path in TABLES:
        if model is FrictionChoice:
            continue  # its keys are parameters, see below
        first = next(iter(model.model_fields))
        wrong = f"{first}x"
        key = ".".join(map(str, (*path, wrong)))
        for name, value in (("key", 1), ("table", TABLE)):
            yield Bad(f"unknown {name}", (*path, wrong), value, (name, first), key, base)


def bad_sweeps() -> Iterator[Bad]:
    sweep = ("studies", "scan", "sweep")
    for name, value, shown in of_quantity(MODULE):
        for end in ("start", "stop"):
            words = (shown, MODULE.allowed, "gears.module")
            yield Bad(f"{end} {name}", (*sweep, end), value, words, ".".join(sweep))
        listed = ("studies", "list", "sweep", "values")
        yield Bad(f"values {name}", listed, [value], words, "studies.list.sweep")
    for wrong, words in {
        "gears.modul": ("module",),
        "gaers.module": ("gears",),
        "gears.module.deep": ("gears.module.deep",),
        "title": ("cannot be swept", "operation"),
        "models.load_sharing": ("cannot be swept", "operation"),
        "loss_map.torque": ("cannot be swept", "operation"),
        "operation.driver": ("no number", "values"),
        "": ("gears",),
    }.items():
        yield Bad(f"key {wrong}", (*sweep, "key"), wrong, words, ".".join(sweep))
    for key in ("start", "stop"):
        whole = {"key": "gears.module", key: "2 mm"}
        yield Bad(f"only {key}", sweep, whole, ("start and stop, or values",), ".".join(sweep))
    both = {**at(BASE, sweep), "values": ["2 mm"]}
    yield Bad("both", sweep, both, ("start and stop, or values",), ".".join(sweep))
    empty = {"key": "gears.module", "values": []}
    yield Bad("no values", sweep, empty, ("0 values", "1 to 100000"), ".".join(sweep))
    two_ends = {"key": "gears.module", "start": "2 mm", "stop": "3 mm", "count": 1}
    yield Bad(
        "one value",
        sweep,
        two_ends,
        ('both "2 mm" and "3 mm"; write 2',),
        ".".join((*sweep, "count")),
    )


def bad_parameters() -> Iterator[Bad]:
    path = ("models", "friction")
    for law in FRICTION.values():
        own = law_arguments(law.function)[1]
        table = {"name": law.name, "qqqq": 1}
        words = ("no parameter", law.name, *own)
        yield Bad(f"{law.name} unknown", path, table, words, "models.friction.qqqq")
        for key in own:
            for name, value, shown in of_quantity(COEFFICIENT):
                words = (shown, COEFFICIENT.allowed)
                where = f"models.friction.{key}"
                yield Bad(
                    f"{law.name} {key} {name}", path, {"name": law.name, key: value}, words, where
                )
    yield Bad("none", path, [], ("0 friction laws", "1 to 12"), "models.friction")
    yield Bad("many", path, ["constant"] * 13, ("13 friction laws", "1 to 12"), "models.friction")
    yield Bad("twice", path, ["xu_2007", "xu_2007"], ('"xu_2007"', "once"), "models.friction")


def bad_oils() -> Iterator[Bad]:
    by_value = at(BASE, ("lubricant",))
    for name, change, words, key in [
        ("nothing", {"base": None, "viscosity_40": None, "viscosity_100": None}, ("name",), ""),
        ("no base", {"base": None}, ("mineral", "pao"), ""),
        ("one viscosity", {"viscosity_100": None}, ("viscosity_40 and viscosity_100",), ""),
        ("rising", {"viscosity_100": "300 mm2/s"}, ("above",), ".viscosity_40"),
        ("ends", {"temperature_min": "90 degC", "temperature_max": "80 degC"}, ("below",), ""),
        (
            "thin in the cold",
            {"viscosity_minus_40": "20 mm2/s"},
            ("must be above viscosity_40",),
            ".viscosity_minus_40",
        ),
        (
            "hardly thicker in the cold",
            {"viscosity_minus_40": "300 mm2/s"},
            ("300 mm2/s at -40 degC does not go with", "factor of 5"),
            ".viscosity_minus_40",
        ),
    ]:
        oil = {k: v for k, v in {**by_value, **change}.items() if v is not None}
        yield Bad(f"oil {name}", ("lubricant",), oil, words, f"lubricant{key}")


def bad_cold() -> Iterator[Bad]:
    cold = ("operation", "temperature")
    for base, allowed in [("cylindrical", "to 120 degC"), ("strain wave", "0 degC to 120 degC")]:
        words = ("-41 degC is outside the range of", allowed)
        yield Bad(f"cold {base}", cold, "-41 degC", words, "operation.temperature", base)


def bad_surfaces() -> Iterator[Bad]:
    two = {"ra": "0.4 um", "composite_rq": "0.5 um"}
    yield Bad("two", ("roughness",), two, ("ra and composite_rq", "alone"), "roughness")
    yield Bad("none", ("roughness",), {}, ("no roughness", "ra, rq or both"), "roughness")
    low = {"ra": "0.4 um", "rq": "0.3 um"}
    yield Bad("low", ("roughness",), low, ("0.3 um", "below its Ra, 0.4 um"), "roughness.rq")


def bad_marks() -> Iterator[Bad]:
    for value in ("guessed", 3, LIST, TABLE):
        mark = {"value": "2 mm", "status": value}
        yield Bad(
            f"status {value}", ("gears", "module"), mark, ("printed", "assumed"), "gears.module"
        )
    table = {"value": "2 mm", "unit": "mm"}
    words = (MODULE.allowed,)
    yield Bad("no mark", ("gears", "module"), table, words, "gears.module")


def bad_targets() -> Iterator[Bad]:
    yield Bad("unit", ("targets", 0, "unit"), "parsec", ('"parsec"', "unit"), "targets.0.unit")
    yield Bad("study", ("targets", 0, "study"), "scam", ('"scam"', "scan"), "targets.0.study")


def bad_names() -> Iterator[Bad]:
    words = ("letters, digits",)
    for name in ("../up", "a/b", "a b", "", "x" * 61, "a\nb", ".."):
        yield Bad(f"study {name!r}", ("studies",), {name: {}}, words, "studies")
        yield Bad(f"variant {name!r}", ("variants",), {name: {}}, words, "variants")
    yield Bad("variants", ("variants",), 3, ("3", "table"), "variants")
    yield Bad("variant", ("variants",), {"a": 3}, ("3", "table"), "variants.a")
    flat = {"a": {"friction": "xu_2007"}}
    told = ("[variants.a.models]", "friction")
    yield Bad("a key of a variant in no table", ("variants",), flat, told, "variants.a.friction")


def bad_stages() -> Iterator[Bad]:
    """What is wrong with stages that are sound each by itself."""
    second, ball = ("stages", "2", "gears"), RIG["gears"]
    rack = {key: value for key, value in GANTRY["gears"].items() if key != "mass"}
    seal = {"seal_torque": "0.1 N m"}
    for name, path, value, words, key in [
        ("none", ("stages",), [], ("no stage was given", "[[stages]]"), "stages: "),
        ("six", ("stages",), [{}] * 6, ("6 were given; allowed are at most 5",), "stages: "),
        ("a gap", ("stages",), {"1": {}, "3": {}}, ("there is no stage 2",), "stages: "),
        ("nought", ("stages", "0"), {}, ('no stage "0"; use stages.1 to stages.2',), "stages: "),
        ("no number", ("stages", "x"), {}, ('no stage "x"; use stages.1 to stages.2',), "stages: "),
        (
            "path of one pair",
            ("stages", "2", "models"),
            {"averaging": "path"},
            ("the path of one pair does not stand for several meshes",),
            "stages.2.models.averaging",
        ),
        (
            "gears too",
            ("gears",),
            BASE["gears"],
            ("was given with [[stages]]", "write stages.1.gears."),
            "gears: ",
        ),
        ("dynamics", ("dynamics",), {}, ("that of a mesh; give a stage the table",), "dynamics: "),
        (
            "film",
            ("film",),
            {"solver": "line"},
            ("films are those of a mesh; give a stage",),
            "film: ",
        ),
        (
            "left",
            (*second, "flank"),
            "left",
            ("turns against", "leave flank"),
            "stages.2.gears.flank",
        ),
        (
            "teeth",
            (*second, "teeth"),
            [1, 70],
            ("gear 1 was given 1 teeth",),
            "stages.2.gears.teeth",
        ),
        (
            "pointed",
            (*second, "profile_shift"),
            [1.6, 0],
            ("tip circle",),
            "stages.2.gears.addendum",
        ),
        ("width", (*second, "face_widht"), 1, ("face_width",), "stages.2.gears.face_widht"),
        ("rig", second, ball, ("a test rig transmits nothing",), "stages.2.gears.family"),
        ("rack", ("stages", "1", "gears"), rack, ("turns no shaft",), "stages.1.gears.family"),
        ("force", ("operation", "force"), "3 N", ("carry a torque",), "operation.force"),
        ("path", ("models", "averaging"), "path", ("several meshes",), "models.averaging"),
        ("driver", ("operation", "driver"), "gear 1", ("[[stages]]",), "operation.driver"),
        ("member", ("stages", "2", "driver"), "gear 3", ("gear 1 or gear 2",), "stages.2.driver"),
        (
            "sharing",
            ("models", "load_sharing"),
            "sanchez",
            ("sanchez_2017",),
            "models.load_sharing",
        ),
        (
            "planet",
            ("losses",),
            {"oil": {"between": ["planet", "carrier"], **seal}},
            ('"planet" is no body of this drive',),
            "losses.oil.between",
        ),
        (
            "shaft",
            ("losses",),
            {"oil": {"between": ["shaft 4", "housing"], **seal}},
            ('"shaft 4" is no body of this drive', "shaft 2"),
            "losses.oil.between",
        ),
        (
            "far shafts",
            ("losses",),
            {"oil": {"between": ["shaft 1", "shaft 3"], **seal}},
            ("between shafts that no stage of the drive has in common",),
            "losses.oil.between",
        ),
        (
            "in the housing",
            ("stages", "1", "losses"),
            {"oil": {"between": ["gear 2", "housing"], **seal}},
            ("may carry two meshes", "[losses]"),
            "stages.1.losses.oil.between",
        ),
    ]:
        yield Bad(f"stages {name}", path, value, words, key, "drive")
    three = ["constant", "xu_2007", "iso_tr_14179_2"]
    told = ("2 friction laws were given where another stage has 3",)
    stages = copy.deepcopy(DRIVE["stages"])
    stages["1"]["models"]["friction"] = three[:2]
    stages["2"]["models"] = {"friction": three}
    yield Bad("stages laws", ("stages",), stages, told, "stages.1.models.friction", "drive")


def bad_drives() -> Iterator[Bad]:
    for name, path, value, words in [
        ("fixed", ("operation", "driver"), "circular spline", ("fixed", "wave generator or flex")),
        ("driver", ("operation", "driver"), "gear 1", ("is not in this drive", "flexspline")),
        ("clearance", ("gears", "clearance"), 1.5, ("less than the depth of the teeth",)),
        ("family", ("gears", "family"), "strainwave", ("did you mean strain_wave?",)),
        ("form", ("gears", "tooth", "form"), "involut", ("'double arc' or 'involute'",)),
        ("set", ("gears", "tooth"), {"convex_radius": 1.4}, ("convex_offset", "liu, flat")),
        ("shape", ("gears", "wave_generator", "shape"), "cosine", ("weights were both given",)),
        ("mixed", ("gears", "tooth", "profile_shift"), 3.3, ("profile_shift", "not a known key")),
        ("body", ("losses", "bearing", "between", 0), "wave", ("wave generator", "housing")),
        ("bodies", ("losses", "bearing", "between", 0), "flexspline", ("given twice", "housing")),
        ("factor", ("losses", "bearing", "bearing"), "none", ("no model asks for it",)),
        ("slopes", ("gears", "slopes"), ["9 N m", "9 N m"], ("larger last",)),
        ("walls", ("gears", "flexspline", "walls"), "bending strain", ("rim_thickness was given",)),
        (
            "support",
            ("gears", "flexspline", "support_stiffness"),
            "2e9 Pa",
            ("a bearing", "give one"),
        ),
        ("helix", ("gears", "helix_angle"), "10 deg", ("known are family, teeth", "backlash")),
        ("no length", ("gears", "relief_length"), 0.0, ("0.005 modules needs a length",)),
        ("long relief", ("gears", "relief_length"), 1.0, ("longer than the flank at the tip",)),
        ("deep relief", ("gears", "tip_relief"), 0.2, ("nothing of the rounding is left",)),
        ("late", ("gears", "disengagement"), "85 deg", ("allowed is 20 deg to 80 deg",)),
        ("edges", ("gears", "edges"), "maybe", ("clear", "carry")),
    ]:
        key = ".".join(part for part in path if isinstance(part, str)).removesuffix(".shape")
        key = key.replace("bearing.bearing", "bearing")
        yield Bad(f"drive {name}", path, value, words, key, "strain wave")
    for given, key, told in [
        ({"flange": "bolts", "flange_stiffness": "1 kN m/rad"}, "flange_stiffness", "both given"),
        ({"flange": "rigid", "bolts": 8}, "bolts", "flange leaves out"),
        ({"flange_stiffness": "1 kN m/rad", "bolts": 8}, "bolts", "flange_stiffness leaves out"),
        ({"flange_diameter": "59 mm"}, "flange_diameter", "leaves no bottom"),
        ({"bolt_circle": "500 mm"}, "bolt_circle", "the cup has one of"),
        ({"shaft_diameter": "500 mm"}, "shaft_diameter", "the cup has one of"),
        ({"outside_diameter": "60.5 mm"}, "outside_diameter", "roots lie on"),
    ]:
        where = f"gears.yielding.{key}"
        yield Bad(f"yielding {told}", ("gears", "yielding"), given, (told,), where, "strain wave")
    words = ("come free at the short axis", "a clearance of 0.35")
    yield Bad("free", ("gears", "clearance"), 0.1, words, "gears.clearance: ", "involute")
    for driver in ("wave generator", "gear 3", "Gear 1"):
        words = (f'"{driver}" is not in this drive; use gear 1 or gear 2\n',)
        yield Bad(driver, ("operation", "driver"), driver, words, "operation.driver: ")
    churned = {"between": ["gear 1", "housing"], "churning_torque": "1 N m"}
    yield Bad(
        "churning", ("losses",), {"oil": churned}, ("is missing",), "losses.oil.churning_speed"
    )
    for key, value, words in [
        ("slices", 24, ("not divided into slices", "leave it at 12")),
        ("averaging", "path", ("path of one pair", '"base_pitch"')),
    ]:
        yield Bad(key, ("models",), {key: value}, words, f"models.{key}", "strain wave")
    between = {"between": ["gear 1", "housing"]}
    for given, of in [
        ({"seal_torque": "1 N m", "preload": "10 N"}, "a bearing"),
        ({"seal_torque": "1 N m", "dynamic_load_rating": "9 kN"}, "a bearing"),
        ({"seal_torque": "1 N m", "life_exponent": 3}, "dynamic_load_rating"),
        ({"seal_torque": "1 N m", "static_load_rating": "9 kN"}, "a bearing"),
        ({"seal_torque": "1 N m", "churning_speed": "100 rpm"}, "churning_torque"),
        ({"seal_torque": "1 N m", "churning_exponent": 2}, "churning_torque"),
    ]:
        words, key = (f"without {of}", "belongs"), f"losses.oil.{[*given][1]}"
        yield Bad(f"{[*given][1]} alone", ("losses",), {"oil": between | given}, words, key)
    zero = {"bearing": "palmgren_1959", "mean_diameter": "45 mm", "f0": 0, "f1": 0}
    for name, given in [("nothing", {}), ("zero", zero | {"preload": "10 N"})]:
        yield Bad(f"loss {name}", ("losses",), {"oil": between | given}, ("zero",), "losses.oil")
    bearing = {"between": ["gear 1", "housing"], "bearing": "palmgren_1959", "f1": 0.001}
    words = ("is missing", "mean_diameter, f0, f1")
    yield Bad("bearing", ("losses",), {"oil": bearing}, words, "losses.oil.mean_diameter")
    held = {"between": ["gear 1", "housing"], "breakaway": "dry_and_viscous"}
    words = ("is missing", "mean_diameter, breakaway_dry, breakaway_viscous")
    yield Bad("breakaway", ("losses",), {"oil": held}, words, "losses.oil.mean_diameter")
    seal = between | {"seal_torque": "1 N m", "breakaway_preload": 2}
    words, key = ('breakaway is "none"; name one',), "losses.oil.breakaway_preload"
    yield Bad("breakaway_preload alone", ("losses",), {"oil": seal}, words, key)


def bad_loss_sets() -> Iterator[Bad]:
    for name, given, words in [
        ("misspelt", "strain_wave_componet", ("did you mean strain_wave_component",)),
        ("a number", 3, ("3 is not the name of a set of losses", "strain_wave_component")),
        ("a list", LIST, ("is not the name of a set of losses",)),
    ]:
        given = {"set": given}
        yield Bad(f"set {name}", ("losses",), given, words, "losses.set", "strain wave")
    named = {"set": "strain_wave_component"}
    words = ("scales with pitch diameter", "which these gears do not have")
    yield Bad("set of other gears", ("losses",), named, words, "losses.set: ")
    yield Bad("set of a rack", ("losses",), named, words, "losses.set: ", "rack")
    words = ("a set belongs to one mesh", "under the stage")
    yield Bad("set of a drive", ("losses",), named, words, "losses.set: ", "drive")
    key = "losses.wave_generator_bearing"
    for name, given, end, words in [
        ("negative", {"f0": -1}, ".f0", ("-1", "allowed is 0 to 100")),
        ("negative size", {"mean_diameter": "-3 mm"}, ".mean_diameter", ("-3 mm", "allowed")),
        ("negative part", {"breakaway_dry": "-1 N/m"}, ".breakaway_dry", ("allowed is 0",)),
        ("unknown key", {"f2": 1}, ".f2", ("f0", "f1")),
        ("no bearing", {"bearing": "none"}, ".f0", ('bearing is "none"; name one',)),
        ("no table", 3, "", ("3 was given where a table belongs",)),
    ]:
        table = named | {"wave_generator_bearing": given}
        yield Bad(f"set {name}", ("losses",), table, words, key + end, "strain wave")


WALKED = [replace(bad, base=site.base) for site in SITES for bad in bads_at(site)]
LISTED = [
    *bad_keys(),
    *bad_sweeps(),
    *bad_parameters(),
    *bad_oils(),
    *bad_cold(),
    *bad_loss_sets(),
    *bad_surfaces(),
    *bad_marks(),
    *bad_targets(),
    *bad_names(),
    *bad_drives(),
    *bad_stages(),
]
REQUIRED = [
    (base, (*path, name))
    for model, base, path in TABLES
    for name, info in model.model_fields.items()
    if info.is_required() and name != "stages"  # without it a case has one mesh
] + [("cylindrical", ("operation", "torque")), ("rig", ("operation", "force"))]


@pytest.mark.parametrize("base", quick_first(BASES))
def test_the_whole_case_is_sound(
    base: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = str(written(BASES[base], tmp_path))
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "show", path, "--json"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert json.loads(capsys.readouterr().out)[0]["title"] == BASES[base].get("title", "bad.toml")


TASKS = "pitchpoint.sizing."
"""Tables of other files."""


def _subclasses(model: type[BaseModel]) -> Iterator[type[BaseModel]]:
    for below in model.__subclasses__():
        yield below
        yield from _subclasses(below)


def test_the_walk_reaches_every_table() -> None:
    defined = {FrictionChoice} | {
        table for table in _subclasses(Table) if not table.__module__.startswith(TASKS)
    }
    assert {model for model, *_ in TABLES} == defined - {every.GearsTable}
    tested = {(bad.base, bad.path[:n]) for bad in WALKED + LISTED for n in range(len(bad.path) + 1)}
    assert tested >= {(site.base, site.path) for site in SITES if site.annotation is not Any}


def by_place(bads: Iterable[Bad]) -> dict[str, list[Bad]]:
    """Thousands of tests would take longer than what they test: one for each place of a case."""
    places: dict[str, list[Bad]] = {}
    for bad in bads:
        places.setdefault(f"{bad.base}: {bad.key}", []).append(bad)
    return places


OF_EACH_KIND = {(bad.base, bad.name): bad for bad in reversed(WALKED)}
ON_COMMAND_LINE = by_place([*OF_EACH_KIND.values(), *LISTED])
MORE_ON_COMMAND_LINE = by_place(bad for bad in WALKED if bad != OF_EACH_KIND[bad.base, bad.name])
IN_SCHEMA = by_place(WALKED)


def demand_words(told: str, bad: Bad) -> None:
    assert f"bad.toml: {bad.key}" in told, bad
    for word in bad.words:
        assert word in told, bad


@pytest.mark.parametrize("place", IN_SCHEMA)
def test_the_schema_refuses_wrong_values(place: str) -> None:
    for bad in IN_SCHEMA[place]:
        with pytest.raises(InputError) as caught:
            validate(resolve(put(bad), name="bad.toml", variant="default"))
        (error,) = caught.value.every
        demand_words(str(error), bad)


@pytest.mark.parametrize("place", ON_COMMAND_LINE)
def test_the_command_line_tells_wrong_values(
    place: str, refuse: Callable[..., str], tmp_path: Path
) -> None:
    for bad in ON_COMMAND_LINE[place]:
        demand_words(refuse("show", written(put(bad), tmp_path), about=bad), bad)


@pytest.mark.whole
@pytest.mark.parametrize("place", MORE_ON_COMMAND_LINE)
def test_the_command_line_tells_every_wrong_value(
    place: str, refuse: Callable[..., str], tmp_path: Path
) -> None:
    for bad in MORE_ON_COMMAND_LINE[place]:
        demand_words(refuse("show", written(put(bad), tmp_path), about=bad), bad)


@pytest.mark.parametrize(("base", "path"), REQUIRED, ids=str)
def test_a_missing_key(base: str, path: Path_, refuse: Callable[..., str], tmp_path: Path) -> None:
    tree = copy.deepcopy(BASES[base])
    del at(tree, path[:-1])[path[-1]]
    told = refuse("show", written(tree, tmp_path))
    assert f"bad.toml: {'.'.join(map(str, path))}: is missing; " in told
