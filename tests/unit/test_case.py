"""Cases as values of Python: read from anywhere, changed by key, written as TOML; nothing is computed."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from pitchpoint.cases.document import Document
from pitchpoint.cases.library import case_names
from pitchpoint.cases.validation import validate
from pitchpoint.errors import InputError
from pitchpoint.runs.case import Case, selected_variants

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
TABLES: dict[str, Any] = {
    "title": "A pair",
    "gears": {"teeth": [23, 61], "module": 2e-3, "face_width": "18 mm"},
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": 4e-7},
    "operation": {"torque": 60, "speed": 100.0, "temperature": 323.15},
}


@pytest.fixture
def case() -> Case:
    return Case(TABLES)


def test_numbers_of_python_are_si(case: Case) -> None:
    assert case["operation.torque"] == 60.0
    assert case["gears.module"] == 2e-3
    assert case["gears.face_width"] == pytest.approx(18e-3, rel=1e-15)
    assert case["roughness.ra"] == (4e-7, 4e-7)
    assert case["operation.temperature"] == 323.15
    assert case.set(torque=xr.DataArray(5.0))["torque"] == 5.0


def test_a_change_gives_another_case(case: Case) -> None:
    other = case.set(torque="5 N m").set({"operation.speed": np.float64(50.0)})
    assert (other["torque"], other["speed"]) == (5.0, 50.0)
    assert (case["torque"], case["speed"]) == (60.0, 100.0)
    assert case == Case(TABLES)
    assert case != other


def test_keywords_make_a_case_and_change_one(case: Case) -> None:
    assert Case(**TABLES)["operation.torque"] == 60.0
    assert Case(case, operation={"torque": 7.0})["operation.torque"] == 7.0


def test_one_gear_keeps_what_is_usual_of_the_other(case: Case) -> None:
    assert case.set({"gears.profile_shift.1": 0.3})["gears.profile_shift"] == (0.3, 0.0)
    assert case.set({"gears.addendum.2": 0.9})["gears.addendum"] == (1.0, 0.9)
    with pytest.raises(
        InputError, match=r"gears.dedendum.1: is the value of one gear, and there is"
    ):
        case.set({"gears.dedendum.1": 1.3})


def test_a_whole_table(case: Case) -> None:
    table = {"damping_ratio": 0.05, "profile_error": [{"order": 1, "amplitude": 2e-6}]}
    assert case.set(dynamics=table)["dynamics.profile_error"][0].amplitude == 2e-6
    assert case["dynamics"] is None
    again = case.set(dynamics=table).set({"dynamics.damping_ratio": 0.1})
    assert (again["damping_ratio"], again["profile_error"]) == (
        0.1,
        case.set(dynamics=table)["profile_error"],
    )
    assert again.held[0].document().provenance["dynamics.profile_error"].status == "set"


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"torqe": 5.0}, r"^torqe: there is no such key; did you mean torque"),
        ({"gears.profil_shift": 0.1}, r"^gears.profil_shift: there is no such key; did you mean"),
        ({"torque": "5 N"}, r'^operation.torque: "5 N" is a force, but a torque is needed'),
        ({"torque": -5.0}, r'^operation.torque: "-5.0 N m" is out of range; allowed is 0 N m to'),
        ({"roughness.ra": [1e-6, 1.0]}, r'^roughness.ra: "1.0 m" is out of range'),
        ({"module": 2}, r'100 mm; "2 mm" is in it \(from Python a plain number is in m\)$'),
        ({"temperature": 60}, r'; "60 degC" is in it \(from Python a plain number is in K\)$'),
        ({"module": 2000}, r'"2000.0 m" is out of range; allowed is 0.01 mm to 100 mm$'),
        ({"specific_heat": 460.0}, r"^specific_heat: several keys end so; give one of materials."),
    ],
    ids=["bare", "dotted", "unit", "range", "list", "no SI", "no K", "too large", "several"],
)
def test_a_change_that_cannot_be(case: Case, change: dict[str, Any], told: str) -> None:
    with pytest.raises(InputError, match=told):
        case.set(change)


def test_what_is_no_case() -> None:
    with pytest.raises(InputError, match="'tian2025' is neither a shipped case nor a file"):
        Case("tian2025")
    with pytest.raises(InputError, match="3 was given; a case is a file, the name of a shipped"):
        Case(3)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="None was given; a case is a file"):
        selected_variants(None)  # type: ignore[arg-type]
    with pytest.raises(InputError, match='"printed" is not a variant of this case'):
        Case("tian2024", variant="printed")
    with pytest.raises(InputError, match=r"case: gears\.teeth: is missing"):
        _ = Case(gears={"module": 2e-3})["gears.module"]
    with pytest.raises(TypeError, match="not iterable"):
        iter(Case("tian2024"))  # type: ignore[call-overload]


def test_the_operating_point_goes_before_other_tables_and_stages_have_numbers() -> None:
    assert Case("tian2024", variant="physical").key("torque") == "operation.torque"
    stages = {"1": {"gears": TABLES["gears"]}, "2": {"gears": TABLES["gears"]}}
    drive = Case(
        {key: value for key, value in TABLES.items() if key != "gears"} | {"stages": stages}
    )
    assert drive.key("speed") == "operation.speed"
    with pytest.raises(
        InputError, match=r"one of stages\.1\.gears\.module, stages\.2\.gears\.module"
    ):
        drive.key("module")
    of_file = Case(str(EXAMPLES[0].with_stem("two_stage")))
    with pytest.raises(InputError, match=r"there is no stage .*7.*; use stages.1 to stages.2"):
        of_file.set({"stages.7": {}})


def test_a_case_says_in_a_line_what_it_is(case: Case) -> None:
    changed = case.set(torque=5.0, speed="1 rpm")
    assert repr(changed) == (
        'Case(case: "A pair"; operation.torque = "5.0 N m"; operation.speed = "1 rpm")'
    )
    assert repr(Case("tian2024")).endswith("variants as_published, physical)")


def test_settings_of_a_run_go_on_top(case: Case) -> None:
    (variant,) = selected_variants(case.set(torque=5.0), settings={"operation.torque": "6 N m"})
    assert validate(variant.document()).operation.torque == 6.0


def test_a_change_of_form_leaves_out_what_the_new_form_does_not_have() -> None:
    case = Case("hfuc32").set({"gears.tooth.form": "involute", "gears.tooth.profile_shift": 3.32})
    again = Case(tomllib.loads(case.to_toml()))
    assert again["gears.tooth.form"] == "involute"


@pytest.mark.parametrize("source", [*case_names(), *EXAMPLES], ids=lambda one: Path(one).stem)
def test_written_as_toml_it_is_the_same_case(source: str | Path) -> None:
    """Values to the last bit, with their status, place and remark."""
    case = Case(source)
    again = Case(tomllib.loads(case.to_toml()))
    assert again.variants == case.variants
    for one, other in zip(case.held, again.held, strict=True):
        first, second = one.document(), other.document()
        assert validate(first) == validate(second)
        assert first.provenance == second.provenance


def test_changes_are_in_the_file(case: Case, tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    case.set(torque=1.0 / 3.0).to_toml(path)
    assert Case(path)["torque"] == 1.0 / 3.0
    assert 'torque = "0.3333333333333333 N m"' in path.read_text("utf-8")


def test_materials_of_a_set_that_are_no_table_are_refused_in_a_sentence() -> None:
    tree = tomllib.loads((EXAMPLES[0].parent / "planetary.toml").read_text("utf-8"))
    with pytest.raises(InputError, match=r"^set: materials: 0 was given where a table belongs"):
        validate(Document("set", {**tree, "materials": 0}))
