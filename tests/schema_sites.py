"""The schema of case files walked: places that hold a value, and what can be wrong at each kind of place."""

import copy
import datetime
import math
from collections.abc import Iterator
from dataclasses import dataclass
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

import pytest
from pydantic import BaseModel, BeforeValidator
from whole_cases import BASES, WALKS

from pitchpoint import units
from pitchpoint.cases.drive_schema import DriveCase, StageTable
from pitchpoint.gears import planetary
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import tag

Path_ = tuple[str | int, ...]


@dataclass(frozen=True)
class Site:
    """A place in the schema: in which sound case, its path, and what belongs there."""

    base: str
    path: Path_
    annotation: Any
    marks: tuple[Any, ...]

    @property
    def key(self) -> str:
        return ".".join(map(str, self.path))

    def mark(self, kind: type) -> Any:
        return next((mark for mark in self.marks if isinstance(mark, kind)), None)


@dataclass(frozen=True)
class Bad:
    """A broken case: what is put where, what the message must contain, and in which sound case."""

    name: str
    path: Path_
    value: Any
    words: tuple[str, ...]
    key: str
    base: str = "cylindrical"


def marks_in(annotation: Any) -> Iterator[Any]:
    yield from getattr(annotation, "__metadata__", ())
    for inner in get_args(annotation):
        if not isinstance(inner, str):
            yield from marks_in(inner)


def tables_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from tables_in(inner)


def containers(annotation: Any) -> set[Any]:
    """Which of dict and tuple stand between a field and its values; a pair is no list."""
    found = {get_origin(annotation)} & {dict, tuple}
    if get_origin(annotation) in (Union, UnionType) or hasattr(annotation, "__metadata__"):
        found |= set().union(*(containers(inner) for inner in get_args(annotation)))
    return found


def inner(site: Site) -> Iterator[tuple[type[BaseModel], Path_]]:
    """Table that stands at a place of the sound case, and its path; of a list or many the first."""
    found = list(tables_in(site.annotation))
    if not found:
        return
    path, node = site.path, at(BASES[site.base], site.path, {})
    if not node:  # a table that another sound case has
        return
    if containers(site.annotation) & {tuple}:
        path = (*path, 0)
    elif dict in containers(site.annotation):
        path = (*path, next(iter(node)))
    forms = [table for table in found if len(found) > 1 and tag(table) in node.values()]
    yield from ((table, path) for table in forms or found)


def tables(base: str, model: type[BaseModel], path: Path_) -> Iterator[tuple[Any, str, Path_]]:
    yield model, base, path
    for site in places(base, model, path):
        for table, where in inner(site):
            yield from tables(base, table, where)


def places(base: str, model: type[BaseModel], path: Path_) -> Iterator[Site]:
    for name, info in model.model_fields.items():
        marks = (*info.metadata, *marks_in(info.annotation))
        yield Site(base, (*path, name), info.annotation, marks)


def at(tree: Any, path: Path_, missing: Any = None) -> Any:
    for part in path:
        if missing is not None and isinstance(tree, dict) and part not in tree:
            return missing
        tree = tree[part]
    return tree


def put(bad: Bad) -> dict[str, Any]:
    tree = copy.deepcopy(BASES[bad.base])
    path, value = bad.path, bad.value
    at(tree, path[:-1])[path[-1]] = value
    return tree


TABLES = [table for walk in WALKS for table in tables(*walk)]
TABLES += [
    (DriveCase, "drive", ()),
    (StageTable, "drive", ("stages", "1")),
]
SITES = [site for model, base, path in TABLES for site in places(base, model, path)]


# ---- what can be wrong at each kind of place

LIST, TABLE, DATE = [1, 2, 3], {"a": 1}, datetime.date(2024, 1, 31)
SHAPES = {
    "list": (LIST, "[1, 2, 3]"),
    "table": (TABLE, "{ a = 1 }"),
    "bool": (True, "true"),
    "date": (DATE, "2024-01-31"),
}
NUMBERS = {**SHAPES, "text": ("plenty", '"plenty"'), "empty": ("", '""')}
NAMES = {**SHAPES, "number": (7, "7"), "nan": (math.nan, "nan")}


def of_quantity(quantity: Quantity) -> Iterator[tuple[str, Any, str]]:
    """Name, value and shown value of everything that is no such quantity."""
    unit = units.si_unit(quantity.kind)

    def written(number: float) -> Any:
        return f"{number!r} {unit}" if unit else number

    for name, (value, shown) in NUMBERS.items():
        yield name, value, shown
    yield "nan", math.nan, "nan"
    yield "infinite", math.inf, "inf"
    yield "nan text", f"nan {unit}", "nan"
    yield "huge", 10**400, "more than 40 digits"
    other = "3 m" if quantity.kind == "mass" else "3 kg"
    yield "wrong dimension", other, f'"{other}"'
    yield "decimal comma", f"0,5 {unit}", "0,5"
    if unit:
        yield "missing unit", 3, '"3" has no unit'
        yield "missing unit in text", "3", '"3" has no unit'
        yield "unknown unit", "3 furlong", '"3 furlong"'
    if quantity.low > -math.inf:
        low = written(quantity.low - 0.5 * abs(quantity.low) - 1.0)
        yield "below", low, str(low)
    if quantity.open_low:
        yield "at the open end", written(quantity.low), str(written(quantity.low))
    if quantity.high < math.inf:
        high = written(1.5 * quantity.high + 1.0)
        yield "above", high, str(high)
    if quantity.whole:
        yield "not whole", written(quantity.low + 0.5), str(written(quantity.low + 0.5))


def of_name(known: list[str]) -> Iterator[tuple[str, Any, str, str]]:
    yield "misspelt", f"{known[0]}x", f'"{known[0]}x"', known[0]
    yield "unknown", "qqqq", '"qqqq"', f"known are {', '.join(known)}"
    for name, (value, shown) in NAMES.items():
        yield name, value, shown, known[0]


def named_list(site: Site) -> list[str] | None:
    """Names that a registry field takes: what its own message lists."""
    reader = site.mark(BeforeValidator)
    if reader is None or "named.<locals>" not in getattr(reader.func, "__qualname__", ""):
        return None
    with pytest.raises(Exception, match="known are") as caught:
        reader.func("qqqq")
    return str(caught.value).partition("known are ")[2].split(", ")


def literals(annotation: Any) -> tuple[Any, ...]:
    """Words that a field takes, be it one that may be left open; none where it takes others."""
    each = (annotation, *get_args(annotation))
    return next((get_args(one) for one in each if get_origin(one) is Literal), ())


def takes_flag(site: Site) -> bool:
    options = get_args(site.annotation)
    return site.annotation is bool or any(bool in get_args(option) for option in options)


def bads_at(site: Site) -> Iterator[Bad]:
    quantity, pair, known = site.mark(Quantity), site.mark(Pair), named_list(site)
    if pair is not None:
        yield from bad_pairs(site, pair.each, 3 if isinstance(pair, planetary.OfThree) else 2)
    elif quantity is not None:
        several = containers(site.annotation) & {tuple}
        for name, value, shown in of_quantity(quantity):
            given = [value] if several else value
            yield Bad(name, site.path, given, (shown, quantity.allowed), site.key)
        if several:
            for name, value in (("number", 3), ("text", "x"), ("table", TABLE)):
                yield Bad(f"no list but {name}", site.path, value, ("list",), site.key)
    elif known is not None:
        by_value = bool(list(tables_in(site.annotation)))
        for name, value, *words in of_name(known):
            if not (by_value and name == "table"):
                yield Bad(name, site.path, value, tuple(words), site.key.partition(".0.name")[0])
    elif options := literals(site.annotation):
        for name, (value, shown) in {**NAMES, "text": ("x", '"x"')}.items():
            yield Bad(name, site.path, value, (shown, *map(str, options)), site.key)
    elif takes_flag(site):
        for name, (value, shown) in {**NAMES, "text": ("x", '"x"')}.items():
            if not isinstance(value, bool):
                yield Bad(name, site.path, value, (shown, "true and false"), site.key)
    elif site.annotation is str:
        for name, (value, shown) in NAMES.items():
            yield Bad(name, site.path, value, (shown, "text"), site.key)
    elif list(tables_in(site.annotation)) or containers(site.annotation):
        yield from bad_structures(site)
    else:
        assert site.annotation is Any, f"{site.key} is of a kind that this test does not know"


def bad_pairs(site: Site, each: Quantity, count: int) -> Iterator[Bad]:
    for name, value, shown in of_quantity(each):
        if name == "list" and count == len(LIST):
            value, shown = [*LIST, 4], "[1, 2, 3, 4]"
        yield Bad(name, site.path, value, (shown, each.allowed), site.key)
        if name != "list":
            several = [value] * count
            yield Bad(f"{name} in list", site.path, several, (shown, each.allowed), site.key)
    yield Bad("list of none", site.path, [], ("0 values", each.allowed), site.key)


def bad_structures(site: Site) -> Iterator[Bad]:
    given = {"number": (3, "3"), "text": ("qqqq", '"qqqq"'), "bool": (True, "true")}
    given |= {"nan": (math.nan, "nan")}
    if site.path != ("models", "friction"):  # a single law may be given as it is
        shape = (
            (LIST, "[1, 2, 3]") if not containers(site.annotation) & {tuple} else (TABLE, "a = 1")
        )
        given["other shape"] = shape
    for name, (value, shown) in given.items():
        yield Bad(name, site.path, value, (shown,), site.key)
