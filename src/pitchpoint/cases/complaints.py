"""What pydantic has against the tables of a case file, in gear words."""

import json
from collections.abc import Mapping, Sequence
from typing import Any, get_origin

from pydantic import BaseModel, ValidationError

from pitchpoint.cases.document import Document, too_many
from pitchpoint.cases.keys import ANY_NAME, meant
from pitchpoint.cases.wishes import keys_for_wish, no_family, value_advice, wish_answer
from pitchpoint.errors import CollectedInputError, InputError, shorten
from pitchpoint.gears.planetary import PLANETARY
from pitchpoint.input.quantities import shown
from pitchpoint.input.tables import DECIDING, alternatives, field_quantity, fields_at
from pitchpoint.registry import listed, similar_names

__all__ = ["complaint_of"]


_MOST_TOLD = 20
"""Sentences on one file."""


def complaint_of(error: ValidationError, document: Document, model: type[BaseModel]) -> InputError:
    """The complaints of pydantic in gear words, the clearest one first, each thing once."""
    details = error.errors(include_url=False)[:1000]  # of a hostile file, the first ones
    causes = [_clearest(details), *_causes(details, document)]
    faults = {str(fault): fault for cause in causes for fault in _sentences(cause, document, model)}
    every = list({fault.key: fault for fault in reversed(faults.values())}.values())[::-1]
    if len(every) > _MOST_TOLD:
        ending = InputError("more is wrong; these first", file=document.name)
        every = [*every[:_MOST_TOLD], ending]
    return every[0] if len(every) == 1 else CollectedInputError(every)


def _causes(details: Sequence[Any], document: Document) -> list[Any]:
    """What is wrong, each thing once: without what follows from a misspelt key or form.

    Of several complaints about one value the clearest one stands, and none about a value stands beside
    one about something in it, as a name that was given as a table has it.
    """
    places: dict[tuple[str, ...], list[Any]] = {}
    for detail in details:
        places.setdefault(_place_of(detail, document), []).append(detail)
    inside = {place[:end] for place in places for end in range(len(place))}
    forms_of = {place[:-1] for place, at_place in places.items() if _misspelt_form(at_place)}
    unknown = [
        place for place, at_place in places.items() if at_place[0]["type"] == "extra_forbidden"
    ]
    return [
        _clearest(at_place)
        for place, at_place in places.items()
        if place not in inside
        and (
            _misspelt_form(at_place)
            or not any(place[:end] in forms_of for end in range(len(place)))
        )
        and not _left_missing(place, at_place, unknown, document.tree)
        and not _told_with_another(place, at_place, places)
    ]


def _told_with_another(
    place: tuple[str, ...], same: Sequence[Any], places: Mapping[tuple[str, ...], Any]
) -> bool:
    """True for a missing table whose sentence stands with the first one, and the rest of a wrong list."""
    if same[0]["type"] != "missing":
        return False
    beside = [
        sibling for sibling in places if sibling[:-1] == place[:-1] and len(sibling) == len(place)
    ]
    if len(place) == 1:
        lacking = (sibling for sibling in beside if places[sibling][0]["type"] == "missing")
        return place != next(lacking)
    return place[-1].isdigit() and len(beside) > 1


def _place_of(detail: Any, document: Document) -> tuple[str, ...]:
    words = _words(document, detail)
    return tuple(str(part) for part in detail["loc"] if str(part) in words)


def _misspelt_form(same: Sequence[Any]) -> bool:
    """True for complaints about a key that decides what the others may be."""
    return any(
        detail["type"] == "literal_error" and detail["loc"][-1] in DECIDING for detail in same
    )


def _left_missing(
    place: tuple[str, ...],
    same: Sequence[Any],
    unknown: Sequence[tuple[str, ...]],
    tree: Mapping[str, Any],
) -> bool:
    """True for a missing key that stands there in another spelling."""
    beside = (sibling for sibling in unknown if sibling[:-1] == place[:-1])
    return same[0]["type"] == "missing" and any(
        place[-1] in keys_for_wish(sibling, tree) or similar_names(sibling[-1], place[-1:])
        for sibling in beside
    )


def _sentences(detail: Any, document: Document, model: type[BaseModel]) -> Sequence[InputError]:
    """A complaint of pydantic in gear words, or several that one check of our own has."""
    words = _words(document, detail)
    key = ".".join(shorten(str(part)) for part in detail["loc"] if str(part) in words)
    cause = detail.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        errors = cause.errors if isinstance(cause, CollectedInputError) else (cause,)
        places = [".".join(filter(None, (key, complaint.key))) for complaint in errors]
        return [
            complaint.at(file=document.name, key=place).followed_by(
                value_advice(place, detail["input"])
            )
            for complaint, place in zip(errors, places, strict=True)
        ]
    return [InputError(_message(detail, document, model), file=document.name, key=key)]


def _clearest(details: list[Any]) -> Any:
    """A misspelt key before the one it left missing.

    For a value that may be a name or a table, the complaint about the form that was given.
    """
    for item in details:  # a misspelt form makes its own keys unknown
        if item["type"] == "literal_error" and item["loc"][-1] in DECIDING:
            return item
    unknown = [item for item in details if item["type"] == "extra_forbidden"]
    foremost = (unknown or details)[0]
    at_place = [item for item in details if item["loc"][:2] == foremost["loc"][:2]]
    fitting = [
        item for item in at_place if item["type"] not in ("model_type", "model_attributes_type")
    ]
    return unknown[0] if unknown else (fitting or at_place)[0]


def _words(document: Document, detail: Any) -> set[str]:
    """Parts of a location that stand in the file, without pydantic's names of alternatives."""
    words: set[str] = set()
    node: Any = document.tree
    for part in detail["loc"]:
        if (isinstance(node, dict) and part in node) or (
            isinstance(node, list | tuple) and isinstance(part, int) and part < len(node)
        ):
            node = node[part]
        elif part != detail["loc"][-1] or detail["type"] not in ("missing", "extra_forbidden"):
            continue
        words.add(str(part))
    return words


def _message(detail: Any, document: Document, model: type[BaseModel]) -> str:
    kind, stated, context = detail["type"], detail.get("input"), detail.get("ctx", {})
    if kind == "missing":
        return f"is missing{_needed(detail['loc'], model)}"
    if kind == "extra_forbidden":
        what, fields = (
            "table" if isinstance(stated, dict) else "key",
            fields_at(detail["loc"], model),
        )
        place = _place_of(detail, document)
        advice = wish_answer(place, stated, document.tree, fields) or meant(
            place, fields, model, document.tree
        )
        return f"is not a known {what}{advice}"
    if kind == "literal_error":
        allowed = _options(detail["loc"], model) or context["expected"]
        if detail["loc"][-1] == "family" and isinstance(stated, str):
            return f"{shown(stated)} is no family of gears{no_family(stated, _quoted(allowed))}"
        return f"{shown(stated)} is not allowed; use {allowed}"
    if isinstance(stated, list) and stated and all(isinstance(entry, dict) for entry in stated):
        table = ".".join(_place_of(detail, document))
        both = "; a list in it has a value for each gear" if table == "gears" else ""
        return f"tables [[{table}]] were given where one table [{table}] belongs{both}"
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return f"{shown(stated)} was given where a table belongs{_inner(detail['loc'], model)}"
    if kind in ("tuple_type", "list_type"):
        return f"{shown(stated)} was given where a list belongs{_as_list(detail['loc'], model)}"
    if kind == "too_long":
        return too_many(len(stated), context["max_length"])
    return f"{shown(stated)} is not allowed: {detail['msg'].lower()}"


def _as_list(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a list of quantities: what to write."""
    info = fields_at(location, model).get(str(location[-1]))
    quantity = None if info is None else field_quantity(info)
    return "" if quantity is None else f"; write [{quantity.example}]; {quantity.allowed}"


def _inner(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """End of a sentence on a value in the place of a table of the user's own: where it belongs."""
    *above, key = map(str, location)
    if key in fields_at((*location, ""), model):
        table = ".".join(above)
        return f"; {key} is a key of each table in [{table}], such as {table}.{ANY_NAME}.{key}"
    return ""


def _quoted(options: str) -> list[str]:
    """Names between the quotation marks of a list in words."""
    return options.split("'")[1::2]


def _options(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    """Forms that a deciding key may name, those of all tables that stand there; else nothing."""
    if len(location) < 2:
        return ""
    *above, _, key = location
    if key not in DECIDING:
        return ""
    info = fields_at(tuple(above), model).get(above[-1]) if above else None
    sets = [PLANETARY] * (above == ["gears"])
    names = [*alternatives(info.annotation), *sets] if info else []
    return " or ".join(f"'{name}'" for name in names)


def _needed(location: tuple[Any, ...], model: type[BaseModel]) -> str:
    fields = fields_at(location, model)
    info = fields.get(str(location[-1]))
    if info is None:
        return ""
    if info.examples and get_origin(info.annotation) is tuple:
        return f"; write a list such as {json.dumps(info.examples[0])}"
    quantity = field_quantity(info)
    if quantity is not None:
        return f"; write {quantity.example}; {quantity.allowed}"
    if len(location) == 1:
        needed = [name for name, field in fields.items() if field.is_required()]
        begin = "; pitchpoint new spur writes a file to begin with"
        return f"; a case file needs the tables {', '.join(needed)}{begin}"
    if get_origin(info.annotation) is tuple:
        return "; write a list"
    if alternatives(info.annotation):
        return "; write a table"
    options = getattr(info.annotation, "__args__", ())
    names = [
        how.func.known() for how in info.metadata if hasattr(getattr(how, "func", None), "known")
    ]
    if options or names:
        return f"; use one of {listed(options or names[0])}"
    return "; write text"
