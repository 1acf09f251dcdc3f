"""Tables of a case file: their base, and the one of several forms that a key in them picks."""

import ast
import inspect
import sys
from collections.abc import Hashable, Iterator, Mapping, Sequence
from functools import cache
from itertools import pairwise
from typing import Any, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Discriminator
from pydantic.fields import FieldInfo

from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Pair, Quantity, shown

__all__ = [
    "DECIDING",
    "Numbered",
    "Table",
    "UnknownKeyError",
    "alternatives",
    "field_marks",
    "field_quantity",
    "fields_at",
    "forms",
    "holds_named_tables",
    "is_stated",
    "key_sentences",
    "measure_of",
    "quantity_in",
    "quantity_of_any",
    "table_by_key",
    "tag",
    "usual_words",
]

DECIDING = ("family", "form")
"""Keys whose value says which of several tables is meant."""


class Table(BaseModel):
    """A table of a case file: no unknown keys, values fixed once read.

    The sentence under a key is what the reference, editors and new case files say of it, see `key_sentences`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def key_sentences(table: type[BaseModel]) -> dict[str, str]:
    """The sentence under each key of a table, out of its source: nobody waits for it who does not ask."""
    bases = (base for base in reversed(table.__mro__) if issubclass(base, Table | table))
    return {
        key: words
        for base in bases
        for key, words in _under_keys(base.__module__).get(base.__name__, [])
    }


@cache
def _under_keys(module: str) -> dict[str, list[tuple[str, str]]]:
    """Keys and the sentences under them by class of a module."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    classes = (node for node in tree.body if isinstance(node, ast.ClassDef))
    return {node.name: [*_told(node)] for node in classes}


def _told(table: ast.ClassDef) -> Iterator[tuple[str, str]]:
    for line, below in pairwise(table.body):
        if isinstance(line, ast.AnnAssign) and isinstance(below, ast.Expr):
            yield ast.unparse(line.target), inspect.cleandoc(ast.literal_eval(below.value))


def table_by_key(key: str, *tables: type[Table]) -> Discriminator:
    """Picks one of several tables by the value of a key; the first where it is missing or unknown.

    The first table then says what is wrong with the value.
    """
    table_by_tag = {tag(table): table for table in tables}

    def pick(value: Any) -> str:
        chosen = value.get(key) if isinstance(value, dict) else getattr(value, key, None)
        return (
            chosen
            if isinstance(chosen, str) and chosen in table_by_tag
            else next(iter(table_by_tag))
        )

    return Discriminator(pick)


def tag(table: type[BaseModel]) -> str:
    """Name of a table among its alternatives: the only value of its deciding key, or its own name."""
    for key in DECIDING:
        if key in table.model_fields:
            return str(get_args(table.model_fields[key].annotation)[0])
    return table.__name__


def alternatives(annotation: Any) -> Mapping[str, type[BaseModel]]:
    """Tables that a field may hold, by name."""
    return _by_tag(annotation)


@cache
def _by_tag(annotation: Hashable) -> Mapping[str, type[BaseModel]]:
    return {tag(table): table for table in _tables(annotation)}


def forms(annotation: Any, node: Any = None) -> list[type[BaseModel]]:
    """Tables that a field may hold; the one that is meant, if the table is given or known to be empty.

    Args:
        annotation: of the field.
        node: what a case file has there; None where it is not known.
    """
    table_by_tag = alternatives(annotation)
    if len(table_by_tag) < 2 or not isinstance(node, Mapping):
        return [*table_by_tag.values()]
    chosen = next((node[key] for key in DECIDING if key in node), None)
    if isinstance(chosen, str) and chosen in table_by_tag:
        return [table_by_tag[chosen]]
    return [next(iter(table_by_tag.values()))]


def _tables(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for option in getattr(annotation, "__args__", ()):
        yield from _tables(option)


class Numbered:
    """Annotation of tables by number, 1, 2, ..., in a table or a list."""


def is_stated(table: Table, key: str) -> bool:
    """True if a table says something of a key, be it what is usual."""
    return key in table.model_fields_set


def holds_named_tables(info: FieldInfo) -> bool:
    """True if a field holds tables under names of the user's own."""
    numbered = any(isinstance(mark, Numbered) for mark in info.metadata)
    return get_origin(info.annotation) is dict and not numbered


def field_quantity(info: FieldInfo) -> Quantity | None:
    """Kind and range of the values of a field, None where they are no quantities."""
    measure = measure_of(info)
    return measure.each if isinstance(measure, Pair) else measure


def measure_of(info: FieldInfo) -> Quantity | Pair | None:
    """The same, of both gears together where a field holds a value for each."""
    every = (*info.metadata, *field_marks(info.annotation))
    return next((mark for mark in every if isinstance(mark, Quantity | Pair)), None)


def usual_words(info: FieldInfo) -> str:
    """The value that a quantity has where none is given, in words; empty where there is none."""
    quantity, usual = field_quantity(info), info.default
    if quantity is None or usual is None or info.is_required():
        return ""
    values = usual if isinstance(usual, tuple) else (usual,)
    shown_values = dict.fromkeys(
        quantity.show(value) for value in values if isinstance(value, float)
    )
    return f"default {' / '.join(shown_values)}" if shown_values else ""


def field_marks(annotation: Any) -> Iterator[Any]:
    """What is said of the values that a field may hold, alone or in a list."""
    for option in getattr(annotation, "__args__", ()):
        yield from getattr(option, "__metadata__", ())
        yield from field_marks(option)


def fields_at(location: tuple[Any, ...], model: type[BaseModel]) -> Mapping[str, FieldInfo]:
    """Fields of the table in which the last part of a location stands."""
    fields: Mapping[str, FieldInfo] = model.model_fields
    tables: Mapping[str, type[BaseModel]] = {}
    named = False
    for part in location[:-1]:
        if named:
            named = False
        elif part in tables:
            fields, tables = tables[part].model_fields, {}
        elif isinstance(part, str) and part in fields:
            named = holds_named_tables(fields[part])
            tables = alternatives(fields[part].annotation)
            fields = next(iter(tables.values())).model_fields if tables else {}
    return fields


class UnknownKeyError(InputError):
    """A dotted key that no table has.

    Attributes:
        place: its parts up to the unknown one.
        known_keys: of the tables that stand there.
    """

    def __init__(self, key: str, place: Sequence[str] = (), known_keys: Sequence[str] = ()) -> None:
        super().__init__("there is no such key", key=key)
        self.place, self.known_keys = place, known_keys


@cache
def quantity_of_any(key: str, models: tuple[type[BaseModel], ...]) -> Quantity | None:
    """Kind and range of the value at a dotted key of one of some tables, in any of their forms.

    See `quantity_in`.
    """
    return quantity_in(key, None, models)


def quantity_in(key: str, tree: Any, models: Sequence[type[BaseModel]]) -> Quantity | None:
    """Kind and range of the value at a dotted key of some tables, None where it is no quantity.

    Args:
        key: inside the tables; parts that are numbers count for nothing.
        tree: plain values of the table, which decide what form an inner one has; None for every form.
        models: tables that may be meant.

    Raises:
        UnknownKeyError: no table has it.
        InputError: a part of it is a value.
    """
    parts = [part for part in key.split(".") if not part.isdigit()]
    is_name = False
    for position, part in enumerate(parts):
        if is_name:  # of the user's own
            is_name = False
            continue
        fields = [model.model_fields for model in models]
        holding = [allowed[part] for allowed in fields if part in allowed]
        further: list[Quantity] = [
            model.further_keys for model in models if hasattr(model, "further_keys")
        ]
        if not holding and further:
            return further[0]
        if not holding:
            every = dict.fromkeys(name for allowed in fields for name in allowed)
            raise UnknownKeyError(key, parts[: position + 1], [*every])
        if position == len(parts) - 1:
            return field_quantity(holding[0])
        tree = tree.get(part, {}) if isinstance(tree, Mapping) else None
        if any(isinstance(mark, Numbered) for mark in holding[0].metadata):
            tree = None
        models = [model for info in holding for model in forms(info.annotation, tree)]
        is_name = holds_named_tables(holding[0])
        if not models:
            raise InputError(f"{shown(part)} is a value, not a table", key=key)
    return None
