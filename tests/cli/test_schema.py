"""The JSON Schema of case files: valid itself, and of one mind with the reader where a schema can be."""

import json
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from pydantic import BaseModel
from sound import PAIR

from pitchpoint import cli
from pitchpoint.cases.document import resolve
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.handed_over import as_toml
from pitchpoint.cases.json_schema import case_schema
from pitchpoint.cases.library import case_names, case_path, find_case
from pitchpoint.cases.schema import CaseFile
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import alternatives, field_quantity, key_sentences
from pitchpoint.units import allows_plain_number

EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = [*sorted(EXAMPLES.glob("*.toml")), *map(case_path, case_names()), *map(sample_of, TABLES)]


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    return case_schema()


@pytest.fixture(scope="module")
def validator(schema: dict[str, Any]) -> Draft202012Validator:
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def complaints(validator: Draft202012Validator, text: str) -> list[str]:
    return [error.message for error in validator.iter_errors(tomllib.loads(text))]


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_sound_cases_are_valid(path: Path, validator: Draft202012Validator) -> None:
    assert complaints(validator, path.read_text("utf-8")) == []


def test_a_case_that_was_handed_over_is_valid(validator: Draft202012Validator) -> None:
    name, tree = find_case("csd25")
    for case in (name, str(EXAMPLES / "two_stage.toml")):
        name, tree = find_case(case)
        settings = {"operation.temperature": "40 degC"}
        document = resolve(tree, name=name, variant="default", settings=settings)
        assert complaints(validator, as_toml(document)) == []


@pytest.mark.parametrize(
    ("sound", "broken"),
    [
        ("module =", "modul ="),
        ('"2 mm"', "2"),
        ('"2 mm"', '"two mm"'),
        ('module = "2 mm"\n', ""),
        ("[roughness]", "[rougness]"),
        ("[gears]", '[gears]\nfamily = "strain"'),
        ("[gears]", "[gears]\nprofile_shift = 3.5"),
        ("[gears]", "[gears]\nprofile_shift = [0.1, 0.2, 0.3]"),
        ("[operation]", '[models]\nfriction = "nobody_1999"\n[operation]'),
        ("[operation]", '[models]\nload_sharing = "nobody"\n[operation]'),
        ('"75W90-A"', '{ value = "75W90-A", status = "guessed" }'),
    ],
)
def test_what_is_wrong_is_not(sound: str, broken: str, validator: Draft202012Validator) -> None:
    assert not complaints(validator, PAIR)
    assert sound in PAIR
    assert complaints(validator, PAIR.replace(sound, broken))


def test_variants_say_what_differs(validator: Draft202012Validator) -> None:
    assert not complaints(validator, PAIR + '[variants.a.gears]\nmodule = "3 mm"\n')
    assert complaints(validator, PAIR + '[variants.a.gears]\nmodul = "3 mm"\n')


def tables(model: type[BaseModel]) -> dict[str, type[BaseModel]]:
    """A table of the schema and all below it, by name."""
    found = {model.__name__: model}
    for info in model.model_fields.values():
        for inner in alternatives(info.annotation).values():
            found |= tables(inner)
    return found


def test_every_key_says_what_it_is_and_editors_show_it(schema: dict[str, Any]) -> None:
    """In one sentence under it in its table."""
    known = tables(CaseFile) | tables(DriveCase)
    assert len(known) > 50
    for name, model in known.items():
        sentence = key_sentences(model)
        for key in model.model_fields:
            told = sentence.get(key, "")
            assert told.endswith(".") and told[0].isupper() and len(told) <= 110, (name, key, told)
            shown = schema["$defs"][name]["properties"][key]["description"]
            assert shown.startswith(told), (name, key)
    whole, losses = schema["properties"], schema["$defs"]["CaseFile"]["properties"]["losses"]
    assert whole["gears"]["description"].startswith("Gears of the mesh; ")
    assert losses["anyOf"][0]["properties"]["set"]["description"].startswith("Named set of losses")


def test_editors_show_units_ranges_and_usual_values(schema: dict[str, Any]) -> None:
    angle = schema["$defs"]["CylindricalGears"]["properties"]["pressure_angle"]
    assert "rack. An angle; allowed is 5 deg to 45 deg; units: rad, deg" in angle["description"]
    assert angle["description"].endswith("default 20 deg")
    slopes = schema["$defs"]["StrainWaveGears"]["properties"]["slopes"]
    assert "unless given. Each a torque; allowed is above 0 N m" in slopes["description"]
    flank = schema["$defs"]["CylindricalGears"]["properties"]["flank"]
    assert flank["default"] == "left"
    oils = schema["$defs"]["Oil"]["properties"]["name"]["anyOf"][0]
    assert "pao-vg-150" in oils["enum"]
    assert "null" not in json.dumps(schema)


def measured(table: type[BaseModel]) -> Iterator[tuple[str, Quantity]]:
    """Keys of a table, and of all in it, that hold a quantity."""
    for name, info in table.model_fields.items():
        if (quantity := field_quantity(info)) is not None:
            yield f"{table.__name__}.{name}", quantity
        for inner in alternatives(info.annotation).values():
            yield from measured(inner)


def test_what_a_key_is_told_to_be_written_as_is_in_its_range() -> None:
    every = dict(measured(CaseFile))
    assert len(every) > 150
    for quantity in every.values():
        quantity.read(quantity.example.strip('"'))
        assert quantity.example.startswith('"') != allows_plain_number(quantity.kind)
    assert every["WearTable.cycles"].example == "1e6"
    assert every["CylindricalGears.teeth"].example == "20"


def test_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "pitchpoint.json"
    for status in (0, 2):  # the second time it is there already
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "schema", "-o", str(path)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        assert caught.value.code == status
    assert json.loads(path.read_text("utf-8"))["title"] == "Case file of Pitchpoint"
    assert "is there already" in capsys.readouterr().err
