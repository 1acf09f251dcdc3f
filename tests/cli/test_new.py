"""Case files to begin with: they are sound as they are, and so is every key that stands in a remark."""

import math
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

from pitchpoint import cli
from pitchpoint.analyses.envelope import set_diameter
from pitchpoint.analyses.four_quadrants import output_speed_ratio
from pitchpoint.analyses.strength import ratings_of
from pitchpoint.cases.document import read_tables, resolve
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.keys import keys, quantity_at
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.template import FAMILIES, sample_tree, template
from pitchpoint.cases.validation import validate
from pitchpoint.drive.assembly import ROOM_BETWEEN_PLANETS
from pitchpoint.duty_cycle.duty_table import DutyTable, HeatTable
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.gears.planetary import PLANETARY
from pitchpoint.runs.check import check_case
from pitchpoint.runs.run import load_case
from pitchpoint.sizing.for_ratio import (
    MODULES,
    SAFETIES,
    _planetary,
    _three_k,
    case_for_ratio,
    planetary_teeth,
    stepped_teeth,
)

HEAD = re.compile(r"(?:# )?\[([a-z_.0-9]+)\](?:  #.*)?")
KEY = re.compile(r"# ([a-z_0-9]+ = .*)")


def remarks(text: str) -> dict[str, object]:
    """Values of optional keys by dotted key."""
    found, table = {}, ""
    for line in text.partition("# [variants.")[0].splitlines():
        if head := HEAD.fullmatch(line):
            table = head[1]
        elif key := KEY.fullmatch(line):
            ((name, value),) = tomllib.loads(key[1]).items()
            found[f"{table}.{name}"] = value
    return found


@pytest.mark.parametrize("family", FAMILIES)
def test_it_is_sound_as_it_is(family: str, tmp_path: Path) -> None:
    path = tmp_path / f"{family}.toml"
    path.write_text(template(family))
    if family == "helical":  # the samples of the families are computed elsewhere, this one is not
        assert check_case(str(path)) == []
    case = validate(resolve(read_tables(path), name=path.name, variant="default"))
    assert case.title == f"My {family.replace('_', ' ')}"


@pytest.mark.parametrize("family", FAMILIES)
def test_every_remark_is_a_key_with_a_value_that_it_may_have(family: str) -> None:
    text = template(family)
    tree = tomllib.loads(text)
    for key, value in remarks(text).items():
        quantity = quantity_at(key, tree if "stages" not in tree else None)
        for one in value if isinstance(value, list) else [value]:
            if quantity is not None and one != FROM_CENTRE_DISTANCE:
                quantity.read(one)


def test_tables_by_names_of_ones_own_have_one_in_their_remark() -> None:
    told = remarks(template("spur"))
    lives = DutyTable.model_validate({"file": "cycle.csv", "lives": told["duty.lives"]}).lives
    assert [life.exponent for life in lives.values()] == [3.0]
    heat = {"gears": "name"} | {key: told[f"duty.heat.{key}"] for key in ("bodies", "resistances")}
    assert [*HeatTable.model_validate(heat).bodies] == ["name"]


@pytest.mark.parametrize("family", ["spur", "two_stages", "planetary"])
def test_every_key_stands_in_it(family: str) -> None:
    text = template(family)
    model = CaseFile if family == "spur" else DriveCase
    apart = ("targets", "issues", "formulas", "studies", "title", "summary", "source", "stages")
    apart += ("train",) + ("gears",) * (family == "two_stages")
    told = remarks(text)
    for key in keys(model):
        table, _, name = key.partition(".")
        if table in apart or (table == "gears" and name not in ("module", "helix_angle")):
            continue
        if re.search(
            r"(gear_[12]|sun|planet|ring|second_ring|both|friction|speeds|start_up|profile_error)\.",
            key,
        ):
            continue  # tables by name or in lists, which stand in braces
        assert key in told or f"[{key}]" in text or f"{name.rpartition('.')[2]} = " in text, key


@pytest.mark.parametrize("family", FAMILIES)
def test_what_a_key_is_stands_behind_it(family: str) -> None:
    text = template(family)
    assert re.search(
        r'^temperature = ".*"  # Temperature of the oil and around the gears; allowed', text, re.M
    )
    # Sent to a file where the screen has an old encoding, these would make it no UTF-8.
    assert not re.search("[\x80-\xff]", text)


def test_examples_of_a_set_are_what_an_engineer_takes() -> None:
    told = remarks(template("planetary"))
    assert told["gears.pin_errors"] == ["20 um", "0 um", "0 um"]
    assert (told["strength.life"], told["gears.second.teeth"]) == ("10000 h", [34, 88])
    of_gears = [value for key, value in told.items() if key.startswith("gears.")]
    assert not any(value in of_gears for value in ("3 um", 0.3, "text"))


def test_helical_gears_are_helical() -> None:
    assert tomllib.loads(template("helical"))["gears"]["helix_angle"] == "15 deg"
    assert "helix_angle" not in tomllib.loads(template("spur"))["gears"]


def test_names_as_people_write_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert template("Strain wave") == template("strain_wave")
    with pytest.raises(InputError, match="did you mean torus"):
        template("torsu")
    path = tmp_path / "mine.toml"
    for status in (0, 2):
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "new", "spur", "-o", str(path)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        assert caught.value.code == status
    assert path.read_text("utf-8") == template("spur")
    assert "is there already" in capsys.readouterr().err


def test_a_strain_wave_gear_comes_with_all_that_loses_and_yields() -> None:
    text = template("strain_wave")
    tree = tomllib.loads(text)
    assert tree["losses"] == {"set": "strain_wave_component"}
    assert tree["gears"]["wave_generator"]["bearing"] == tree["gears"]["yielding"] == {}
    case = validate(resolve(tree, name="new", variant="default"))
    assert {"wave_generator_bearing"} <= case.losses.keys()
    assert "losses" not in tomllib.loads(template("spur"))


def test_a_dash_stands_for_the_screen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "new", "spur", "-o", "-"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert capsys.readouterr().out == template("spur")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("planets", [1, 3, 4, 5])
def test_teeth_for_a_ratio_assemble_and_planets_stay_apart(planets: int) -> None:
    """Planets whose number divides sun and ring; tips apart, from the distance of neighbours."""
    for basic in (2.0, 2.8, 3.5):
        teeth = [*planetary_teeth(basic, planets)]
        assert teeth
        for sun, planet, ring in teeth:
            assert (sun + ring) % planets == 0
            assert 0 <= ring - sun - 2 * planet <= 1
            if planets > 1:
                apart = (sun + planet) * np.sin(np.pi / planets) - (planet + 2.0)
                assert apart >= ROOM_BETWEEN_PLANETS
        assert teeth[0][2] / teeth[0][0] == pytest.approx(basic, rel=0.006)


@pytest.mark.whole
@pytest.mark.parametrize(
    ("ratio", "sense"),
    [(5.0, "sun carrier ring"), (-3.0, "sun ring carrier"), (1.2, "ring carrier sun")],
)
def test_a_planetary_set_for_a_ratio_turns_so(ratio: float, sense: str) -> None:
    built = load_case(tomllib.loads(case_for_ratio("planetary", ratio)))
    train = built.case.train
    assert " ".join([train.input, train.output, *train.held]) == sense
    assert float(built.design.ratio) == pytest.approx(ratio, rel=1e-9)


@pytest.mark.parametrize("ratio", [20.0, pytest.param(15.0, marks=pytest.mark.whole)])
def test_a_ratio_beyond_one_set_has_stepped_planets(ratio: float) -> None:
    text = case_for_ratio("planetary", ratio)
    built = load_case(tomllib.loads(text))
    assert built.case.gears.stepped and built.planets == 3
    assert float(built.design.ratio) == pytest.approx(ratio, rel=0.005)
    assert f"Ratio {float(built.design.ratio):.6g}. Teeth " in text


@pytest.mark.parametrize("ratio", [4.0, 20.0])
def test_a_ring_meets_its_planets_away_from_their_base_circles(ratio: float) -> None:
    """Where a planet has no curvature its pressure has no bound; Hertz then fails what ISO 6336 passes."""
    built = load_case(tomllib.loads(case_for_ratio("planetary", ratio)))
    ring = built.meshes[1].design.mesh
    base, tip = np.abs(np.asarray(ring.base_radii)), np.abs(np.asarray(ring.tip_radii))
    distance = float(ring.centre_distance)
    line = np.sqrt(distance**2 - (base[1] - base[0]) ** 2)
    assert np.sqrt(tip[1] ** 2 - base[1] ** 2) - line > 0.5 * float(ring.module)


@pytest.mark.parametrize("planets", [1, 3, 4])
def test_stepped_teeth_for_a_ratio_assemble(planets: int) -> None:
    """By the ratio of two meshes in a row about a carrier, and the rule for two gears on each planet."""
    teeth = [*stepped_teeth(12.0, planets)]
    assert teeth
    for sun, first, second, ring in teeth:
        assert 1.0 + first / sun * ring / second == pytest.approx(12.0, rel=0.031)
        assert (sun * second + ring * first) % (planets * math.gcd(first, second)) == 0
        assert sun + first == ring - second
        if planets > 1:
            assert (sun + first) * np.sin(np.pi / planets) > first + 2.0


@pytest.mark.whole
def test_a_set_that_turns_the_other_way_says_so() -> None:
    assert "Ratio -1.95263: its output turns against the input." in case_for_ratio("3k", 2.0)
    assert "against the input" not in case_for_ratio("planetary", 5.0)


@pytest.mark.parametrize(("family", "ratio"), [("planetary", 5.0), ("3K", 100.0)])
def test_the_module_is_the_smallest_that_bears_the_torque(family: str, ratio: float) -> None:
    text = case_for_ratio(family.lower(), ratio, torque="200 N m")
    tree = tomllib.loads(text)
    gears = [tree["gears"], tree["gears"].get("second", {})]
    module = float(gears[0]["module"].removesuffix(" mm"))

    def safeties(module: float) -> list[float]:
        old = float(gears[0]["module"].removesuffix(" mm"))
        for one in gears:
            for key in {"module", "face_width"} & one.keys():
                one[key] = f"{float(one[key].removesuffix(' mm')) * module / old} mm"
        rated = ratings_of([load_case(tree)], 1)
        return [float(rated[f"least_{part}_safety"][1].item()) for part in SAFETIES]

    assert (np.array(safeties(module)) >= [*SAFETIES.values()]).all()
    smaller = MODULES[MODULES.index(module) - 1]
    assert (np.array(safeties(smaller)) < [*SAFETIES.values()]).any()
    built = load_case(tomllib.loads(text))
    assert float(built.design.ratio) == pytest.approx(ratio, rel=0.03)
    assert built.case.operation.load == 200.0


def test_speed_life_and_diameter_are_those_of_the_case() -> None:
    """The speed counts at the output, as `size` has it; of sets that bear the torque one that fits in."""
    task = {"torque": "200 N m", "speed": "30 rpm", "life": "5000 h"}
    text = case_for_ratio("planetary", 5.0, **task)
    case = load_case(tomllib.loads(text)).case
    assert case.strength is not None and case.strength.life == 5000.0 * 3600.0
    assert case.operation.speed == pytest.approx(np.pi * 30.0 / 30.0 * 5.0)
    assert 'life = "5000 h"' in text
    across = set_diameter(load_case(tomllib.loads(text)))
    with pytest.raises(InputError, match="too small") as caught:
        case_for_ratio("planetary", 5.0, **task, diameter="30 mm")
    smallest = float(str(caught.value).split("smallest is ")[1].split(" mm")[0])
    assert smallest <= 1e3 * across + 0.05
    fitting = case_for_ratio("planetary", 5.0, **task, diameter=f"{smallest + 0.1} mm")
    assert 1e3 * set_diameter(load_case(tomllib.loads(fitting))) <= smallest + 0.1


@pytest.mark.parametrize(
    ("family", "ratio"), [("planetary", 5.0), ("planetary", 30.0), ("3k", 100.0)]
)
def test_several_sets_are_variants_each_of_which_opens(family: str, ratio: float) -> None:
    """Each has the gears that it was sized with, and nothing of those of the first set."""
    text = case_for_ratio(family, ratio, count=3)
    variants = tomllib.loads(text)["variants"]
    assert [*variants] == ["set_1", "set_2", "set_3"] and variants["set_1"] == {}
    found = (_planetary if family == "planetary" else _three_k)(ratio, 3, 3)
    seen = set()
    for name, (make, _) in zip(variants, found, strict=False):
        built = load_case(tomllib.loads(text), variant=name)
        alone = load_case(sample_tree(PLANETARY if family == "planetary" else "3K", make(1.0)))
        assert built.case.gears == alone.case.gears
        pin = make(1.0).get("losses", {}).get("pin", {}).get("mean_diameter")
        assert pin is None or f'losses.pin]\n# mean_diameter = "{pin}"' in _of_set(text, name)
        teeth = [one.design.mesh.teeth.tolist() for one in built.meshes]
        assert abs(float(built.design.ratio)) == pytest.approx(ratio, rel=0.03)
        assert f"{name}: Ratio {float(built.design.ratio):.6g}" in text
        seen.add(str(teeth))
    assert len(seen) == 3
    assert "set_1" not in case_for_ratio(family, ratio)


def _of_set(text: str, name: str) -> str:
    """Lines of a variant; of the first one the pin of the file."""
    if name == "set_1":
        pin = re.search(r"(losses.pin\]\n)(?:# .*\n)*?(# mean_diameter.*)", text)
        return "".join(pin.groups()) if pin else ""
    return text.partition(f"[variants.{name}.gears]")[2].partition(".gears]\nteeth")[0]


LONG_RATIOS = [pytest.param(ratio, marks=pytest.mark.whole) for ratio in (30.0, -80.0, 320.0)]


@pytest.mark.parametrize("ratio", [80.4, *LONG_RATIOS])
def test_a_strain_wave_gear_for_a_ratio_has_it_within_half_a_turn(
    ratio: float, tmp_path: Path
) -> None:
    text = case_for_ratio("strain wave", ratio)
    flexspline, circular_spline = tomllib.loads(text)["gears"]["teeth"]
    built = load_case(tomllib.loads(text))
    met = -1.0 / output_speed_ratio(built)
    assert circular_spline - flexspline == 2
    assert met == pytest.approx(-flexspline / 2) and abs(abs(met) - abs(ratio)) <= 0.25
    assert float(built.case.gears.module) * flexspline == pytest.approx(0.06, rel=1e-3)
    against = ": its output turns against the input" if ratio > 0.0 else ""
    assert f"Ratio {met:.6g}{against}. " in text
    (tmp_path / "new.toml").write_text(text)
    assert check_case(str(tmp_path / "new.toml")) == []


@pytest.mark.parametrize(
    ("family", "ratio", "more", "told"),
    [
        ("planetary", 2.0, {}, "which reaches, from sun to carrier 2.6 to 13"),
        ("planetary", 0.0, {}, "0 is no ratio of one planetary set with 3 planets"),
        (
            "planetary",
            1000.0,
            {},
            "no teeth for a ratio of 1000 with 3 planets can be made; two sets",
        ),
        ("planetary", 0.2, {}, "ask for 5, and exchange input and output"),
        ("planetary", 5.0, {"torque": "5 N"}, 'torque: "5 N" is a force'),
        ("3K", 3000.0, {}, "pitchpoint.three_k_sets takes other limits"),
        ("planetary", 5.0, {"torque": "0 N m"}, "more than zero"),
        ("planetary", 5.0, {"planets": 30}, "planets: 30 is out of range; allowed is 1 to 24"),
        ("3K", -100.0, {}, "it is the size"),
        ("spur", 5.0, {}, "is for strain_wave, planetary and 3K; leave it out for spur"),
        ("strain_wave", 5.0, {}, "a strain wave gear of two lobes has 30 to 320"),
        ("strain_wave", 80.0, {"torque": "5 N m"}, "no rating of its teeth, give operation.torque"),
        ("strain_wave", 80.0, {"planets": 3}, "planets: is for planetary and 3K"),
        ("planetary", float("nan"), {}, "nan is no ratio"),
        ("planetary", 5.0, {"speed": "30 rpm"}, "speed: goes with --torque"),
        ("planetary", 5.0, {"torque": "200 N m", "life": "5"}, 'life: "5" has no unit'),
        (
            "planetary",
            5.0,
            {"torque": "200 N m", "diameter": "30 mm"},
            "diameter: 30 mm is too small: of the sets for this torque the smallest is",
        ),
        ("strain_wave", 80.0, {"speed": "30 rpm"}, "give operation.speed in the file"),
        ("strain_wave", 80.0, {"life": "5000 h"}, "life: is for planetary and 3K"),
        ("planetary", 5.0, {"count": 0}, "count: 0 is out of range; allowed is 1 to 20"),
        ("strain_wave", 80.0, {"count": 2}, "count: is for planetary and 3K"),
    ],
)
def test_what_no_set_has_is_told_in_a_sentence(
    family: str, ratio: float, more: dict[str, object], told: str
) -> None:
    with pytest.raises(InputError) as caught:
        case_for_ratio(family, ratio, **more)
    assert told in str(caught.value)
