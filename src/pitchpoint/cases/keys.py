"""Keys of a case file by their dotted names: what they hold, and what a wrong one may have meant."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from pitchpoint.cases.document import STAGES
from pitchpoint.cases.drive_schema import DriveCase, StageTable, check_stage, form_of, is_planetary
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.wishes import other_table_hint, wish_answer
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import Quantity
from pitchpoint.input.tables import (
    UnknownKeyError,
    alternatives,
    forms,
    holds_named_tables,
    quantity_in,
    quantity_of_any,
)
from pitchpoint.registry import nearest, similar_names

__all__ = ["ANY_NAME", "keys", "meant", "quantity_at", "usual_at"]


def quantity_at(key: str, tree: Any = None) -> Quantity | None:
    """Kind and range of the value at a dotted key, None where it is no quantity.

    Args:
        key: in a case file; a last part 1 or 2 is one of two values.
        tree: plain values of the case; without them every family has its keys.

    Raises:
        InputError: there is no such key.
    """
    try:
        if not isinstance(tree, Mapping):
            return quantity_of_any(key, (CaseFile, DriveCase))
        check_stage(key, tree.get(STAGES))
        return quantity_in(key, tree, [form_of(tree)])
    except UnknownKeyError as error:
        root = form_of(tree) if isinstance(tree, Mapping) else CaseFile
        advice = wish_answer(error.place, None, {}, error.known_keys) or meant(
            error.place, error.known_keys, root, tree
        )
        raise InputError(f"{error.message}{advice}", key=key) from None


def usual_at(key: str, tree: Mapping[str, Any]) -> Any:
    """Default of the value at a dotted key; None where there is none, or no such key.

    Args:
        key: in a case file.
        tree: values of the case, which decide what form a table has.
    """
    models: list[type[BaseModel]] = [form_of(tree)]
    info: FieldInfo | None = None
    node: Any = tree
    for part in key.split("."):
        node = node.get(part) if isinstance(node, Mapping) else None
        if part.isdigit():
            continue
        info = next(
            (table.model_fields[part] for table in models if part in table.model_fields), None
        )
        models = forms(info.annotation, node) if info is not None else []
    return None if info is None or info.is_required() else info.default


def keys(table: type[BaseModel] = CaseFile) -> Iterator[str]:
    """Dotted keys that take one value or a list, those of every family and form of a table."""
    for name, info in table.model_fields.items():
        inner, kind = alternatives(info.annotation), get_origin(info.annotation)
        options = get_args(info.annotation) or (info.annotation,)
        if kind is not dict and len(options) > len(inner):
            yield name
        if kind not in (dict, tuple):
            below = (f"{name}.{key}" for inside in inner.values() for key in keys(inside))
            yield from dict.fromkeys(below)


def _of_stage(place: Sequence[str]) -> tuple[str, Sequence[str]]:
    """Beginning of the keys of the stage of a place, and the place in it; nothing of other places."""
    if place[0] != STAGES:
        return "", ()
    numbered = len(place) > 1 and place[1].isdigit()
    return ".".join(place[: 1 + numbered]) + ".", place[1 + numbered :]


_SLIP = 0.8
"""Likeness of two spellings of one key: "temperatures" and "temperature" agree by 0.96."""


def meant(place: Sequence[str], known: Collection[str], model: type[BaseModel], tree: Any) -> str:
    """End of a sentence on a key that its table does not have: its neighbours, or the tables that have it.

    Only a slip of the pen comes before a table that has the very key: "force" is not "source".
    """
    key = place[-1]
    stage, inside = _of_stage(place)
    if inside:
        tree = value_inside(value_inside(tree, STAGES), place[1])
        place, model = inside, StageTable
    # Gears of a set are in the place of stages, and not offered beside these.
    beside = {"gears"} if not stage and STAGES in _keys_of(tree) else set()
    every = [name for name in _holding(key, model, tree) if name not in beside]
    if STAGES in model.model_fields:
        of_stage = _holding(key, StageTable, value_inside(value_inside(tree, STAGES), "1"))
        every += [f"{STAGES}.1.{name}" for name in of_stage if name not in every]
    above = ".".join(place[:-1])
    every = [name for name in every if name != above]  # of another family
    near = [name for name in every if above and name.startswith(f"{above}.")]
    flat = [name for name in every if "." not in name.removeprefix(f"{STAGES}.1.")]
    tables = [f"[{stage}{name}]" for name in (near or flat or every)[:_FEW_TABLES]]
    if key in model.model_fields and forms(model.model_fields[key].annotation):
        return f"; [{key}] is a table of its own"
    if similar_names(key, known, _SLIP) or not tables:
        return ("" if similar_names(key, known) else other_table_hint(key)) or nearest(key, known)
    return f"; {' and '.join(tables)} {'has' if len(tables) == 1 else 'have'} that key"


def _keys_of(tree: Any) -> Collection[str]:
    """Keys of a table; none where nothing is known of one, or it is that of a planetary set."""
    return tree.keys() if isinstance(tree, Mapping) and not is_planetary(tree) else ()


_FEW_TABLES = 3
"""Tables that a sentence names of those that have a key."""


def value_inside(tree: Any, key: str) -> Any:
    """What stands at a key of a table; None where nothing does, or the table is none."""
    return tree.get(key) if isinstance(tree, Mapping) else None


def _holding(key: str, model: type[BaseModel], tree: Any, above: str = "") -> Iterator[str]:
    """Dotted names of the tables in a table that have a key, those nearest to it first.

    Of a table with several forms only the form that the tree has counts, or all where it has none.
    """
    inner = [
        (
            f"{above}{name}" + f".{ANY_NAME}" * holds_named_tables(info),
            form,
            value_inside(tree, name),
        )
        for name, info in model.model_fields.items()
        if name not in ("formulas", STAGES)
        for form in forms(info.annotation, value_inside(tree, name))
    ]
    names = [name for name, form, _ in inner if key in form.model_fields]
    deeper = (name for at, form, node in inner for name in _holding(key, form, node, f"{at}."))
    yield from dict.fromkeys((*names, *deeper))


ANY_NAME = "NAME"
"""Stands for a name of the user's own in the key of a table."""
