"""Tables of a case file: their base, and the one of several forms that a key in them picks."""

from collections.abc import Iterator, Mapping
from typing import Any, get_args

from pydantic import BaseModel, ConfigDict, Discriminator

__all__ = ["DECIDING", "Table", "alternatives", "by", "forms", "tag"]

DECIDING = ("family", "form")
"""Keys whose value says which of several tables is meant."""


class Table(BaseModel):
    """A table of a case file: no unknown keys, values fixed once read.

    The sentence under a key is what the reference, editors and new case files say of it.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


def by(key: str, *tables: type[Table]) -> Discriminator:
    """Picks one of several tables by the value of a key; the first where it is missing or unknown.

    The first table then says what is wrong with the value.
    """
    known = {tag(table): table for table in tables}

    def pick(value: Any) -> str:
        given = value.get(key) if isinstance(value, dict) else getattr(value, key, None)
        return given if isinstance(given, str) and given in known else next(iter(known))

    return Discriminator(pick)


def tag(table: type[BaseModel]) -> str:
    """Name of a table among its alternatives: the only value of its deciding key, or its own name."""
    for key in DECIDING:
        if key in table.model_fields:
            return str(get_args(table.model_fields[key].annotation)[0])
    return table.__name__


def alternatives(annotation: Any) -> dict[str, type[BaseModel]]:
    """Tables that a field may hold, by name."""
    return {tag(table): table for table in _tables(annotation)}


def forms(annotation: Any, node: Any = None) -> list[type[BaseModel]]:
    """Tables that a field may hold; the one that is meant, if the table is given or known to be empty.

    Args:
        annotation: of the field.
        node: what a case file has there; None where it is not known.
    """
    known = alternatives(annotation)
    if len(known) < 2 or not isinstance(node, Mapping):
        return [*known.values()]
    given = next((node[key] for key in DECIDING if key in node), None)
    if isinstance(given, str) and given in known:
        return [known[given]]
    return [next(iter(known.values()))]


def _tables(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for option in getattr(annotation, "__args__", ()):
        yield from _tables(option)
