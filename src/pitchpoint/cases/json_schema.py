"""The schema of case files for editors: JSON Schema, which completes keys and names in TOML."""

import copy
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from pitchpoint.cases.document import DIAMETRAL_PITCH, MARKS, STAGES, STATUSES
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.loss_sets import NOT_THERE, SET, SET_TOLD
from pitchpoint.cases.schema import CaseFile
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.input.tables import alternatives, key_sentences, measure_of, usual_words

__all__ = ["case_schema", "table_schema"]

DIALECT = "https://json-schema.org/draft/2020-12/schema"

_DEFS = "$defs"
_PART = "_of_a_variant"
"""Ends the names of tables of which a variant says only what differs."""


class _Names(GenerateJsonSchema):
    """Lists the names that a key may have."""

    def function_before_schema(
        self, schema: core_schema.BeforeValidatorFunctionSchema
    ) -> JsonSchemaValue:
        """Schema of what is read before it is checked; the names of a registry where it is one."""
        names: Callable[[], list[str]] | None = getattr(
            schema["function"]["function"], "known", None
        )
        if names is None:
            return super().function_before_schema(schema)
        return {"type": "string", "enum": [*names()]}


def case_schema() -> dict[str, Any]:
    """JSON Schema of case files, of one mesh or several, with variants.

    Every value may be a table of the value with its marks. Ranges of quantities with units are told in
    words, for no schema reads "3 mm"; `pitchpoint check` tells all that a schema cannot.
    """
    defs: dict[str, Any] = {}
    properties: dict[str, Any] = {}
    wholes = []
    models = dict(entry for model in (CaseFile, DriveCase) for entry in _tables(model))
    for model in (CaseFile, DriveCase):
        schema = model.model_json_schema(schema_generator=_Names, mode="validation")
        defs |= schema.pop(_DEFS)
        if "gears" not in schema["required"]:  # those of a planetary set stand for stages
            schema["required"].remove(STAGES)
            schema["anyOf"] = [{"required": [STAGES]}, {"required": ["gears"]}]
        defs[model.__name__] = schema
        wholes.append({"$ref": f"#/{_DEFS}/{model.__name__}"})
    for name, table in defs.items():
        _plain(table)
        _loosen(table, models[name])
    parts = {f"{name}{_PART}": _partial(table) for name, table in defs.items()}
    for model in (DriveCase, CaseFile):
        properties |= parts[f"{model.__name__}{_PART}"]["properties"]
    gears = [
        parts[f"{model.__name__}{_PART}"]["properties"]["gears"] for model in (CaseFile, DriveCase)
    ]
    properties["gears"] = {"description": gears[0]["description"], "anyOf": gears}
    variant = {"type": "object", "properties": properties, "additionalProperties": False}
    variants = {
        "type": "object",
        "description": "what differs in each variant, by its name",
        "additionalProperties": {"$ref": f"#/{_DEFS}/variant"},
    }
    return {
        "$schema": DIALECT,
        "title": "Case file of Pitchpoint",
        "type": "object",
        "properties": {**properties, "variants": variants},
        "additionalProperties": False,
        "anyOf": [{"required": ["variants"]}, *wholes],
        _DEFS: {**defs, **parts, "variant": variant, "mark": _mark()},
    }


def table_schema(title: str, key: str, model: type[BaseModel]) -> dict[str, Any]:
    """JSON Schema of files that have one table, and a title beside it; values as in `case_schema`.

    Args:
        title: of the schema.
        key: name of the table.
        model: of the table, without tables in it.
    """
    table = model.model_json_schema(schema_generator=_Names, mode="validation")
    _plain(table)
    _loosen(table, model)
    return {
        "$schema": DIALECT,
        "title": title,
        "type": "object",
        "properties": {"title": {"type": "string"}, key: table},
        "required": [key],
        "additionalProperties": False,
        _DEFS: {"mark": _mark()},
    }


def _mark() -> dict[str, Any]:
    """A value with its marks."""
    return {
        "type": "object",
        "description": "a value with how it was come by",
        "properties": {
            "value": {},
            "status": {"enum": list(STATUSES), "description": MARKS["status"]},
            **{key: {"type": "string", "description": MARKS[key]} for key in ("where", "note")},
        },
        "required": ["value"],
        "additionalProperties": False,
    }


_OF_ONE_OR_SEVERAL = ("friction", "at")
"""Keys that take one value in place of a list of one."""


def _loosen(table: dict[str, Any], model: type[BaseModel]) -> None:
    """Takes what the reader takes: marks, one in place of a list, stages in a list, sets of losses."""
    descriptions = key_sentences(model)
    for key, value in table.get("properties", {}).items():
        words = _words(value, model.model_fields[key], descriptions.get(key, ""))
        options = [value, *_other_ways(key, value), {"$ref": f"#/{_DEFS}/mark"}]
        table["properties"][key] = {**words, "anyOf": options}
    if issubclass(model, GearsTable) and "module" in model.model_fields:
        words = {
            "description": "Diametral pitch P, in place of the module 1 in/P of gears without a helix."
        }
        options = [{"type": "number", "exclusiveMinimum": 0}, {"$ref": f"#/{_DEFS}/mark"}]
        table["properties"][DIAMETRAL_PITCH] = {**words, "anyOf": options}
        table["required"].remove("module")
        table["anyOf"] = [{"required": [key]} for key in ("module", DIAMETRAL_PITCH)]


def _words(value: dict[str, Any], info: FieldInfo, sentence: str) -> dict[str, Any]:
    """What is told of a key in place of what is told of its values; a usual value with its unit."""
    value.pop("description", None)
    default, usual = value.pop("default", None), usual_words(info)
    constant = isinstance(default, str | bool) and not usual
    description = " ".join(filter(None, [sentence, _measured(value, info)]))
    return {"description": description, **({"default": default} if constant else {})}


def _measured(value: dict[str, Any], info: FieldInfo) -> str:
    """Kind, range and units of the values of a key, and the usual one."""
    measure = measure_of(info)
    if measure is None:
        return ""
    unit = f"each {measure.told}" if value.get("type") == "array" else measure.told
    return "; ".join(filter(None, [unit[0].upper() + unit[1:], usual_words(info)]))


def _other_ways(key: str, value: dict[str, Any]) -> list[dict[str, Any]]:
    """Schemas of other ways to write what stands at a key."""
    if key in _OF_ONE_OR_SEVERAL and "items" in value:
        inner = copy.deepcopy(value["items"])
        by_name = [{"$ref": f"{inner['$ref']}/properties/name"}] if "$ref" in inner else []
        value["items"] = {"anyOf": [copy.deepcopy(inner), *by_name]}
        return [inner, *by_name]
    if key == STAGES:
        return [{"type": "array", "items": copy.deepcopy(value["additionalProperties"])}]
    if key == "losses":
        named = [{"type": "string"}, {"$ref": f"#/{_DEFS}/mark"}]
        value["additionalProperties"] = {
            "anyOf": [value["additionalProperties"], {"const": NOT_THERE}]
        }
        value["properties"] = {SET: {"description": SET_TOLD, "anyOf": named}}
    return []


def _plain(node: Any) -> None:
    """One of several tables is the first that fits, for a key that decides may be left out; no nulls."""
    for schema in _nodes(node):
        if "oneOf" in schema:
            schema["anyOf"] = schema.pop("oneOf")
            schema.pop("discriminator", None)
        if {"type": "null"} in schema.get("anyOf", ()):
            schema["anyOf"].remove({"type": "null"})
            if len(schema["anyOf"]) == 1:
                schema.update(schema.pop("anyOf")[0])


def _tables(model: type[BaseModel]) -> Iterator[tuple[str, type[BaseModel]]]:
    """A table and those in it, by name."""
    yield model.__name__, model
    for info in model.model_fields.values():
        for inner in alternatives(info.annotation).values():
            yield from _tables(inner)


def _partial(table: Mapping[str, Any]) -> dict[str, Any]:
    """The same table where any key may be left out, in it and below."""
    part = copy.deepcopy(dict(table))
    for schema in _nodes(part):
        schema.pop("required", None)
        name, slash, inside = schema.get("$ref", "").removeprefix(f"#/{_DEFS}/").partition("/")
        if name and name != "mark" and not name.endswith(_PART):
            schema["$ref"] = f"#/{_DEFS}/{name}{_PART}{slash}{inside}"
    return part


def _nodes(node: Any) -> Iterator[dict[str, Any]]:
    if isinstance(node, dict):
        yield node
    inner = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    for child in list(inner):
        yield from _nodes(child)
