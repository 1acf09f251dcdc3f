"""A case as a value of Python: read from anywhere, changed by key, written again."""

import copy
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from pitchpoint import units
from pitchpoint.cases.document import (
    STAGES,
    Document,
    Provenance,
    Tree,
    demand_shallow,
    leaves,
    unknown_variant,
    variants,
)
from pitchpoint.cases.drive_schema import DriveCase, StageTable
from pitchpoint.cases.keys import keys, quantity_at
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.validation import in_form, validate
from pitchpoint.cases.variant import Variant
from pitchpoint.cases.wishes import WISHES, wish_answer
from pitchpoint.errors import InputError, shorten
from pitchpoint.gears.cylindrical.table import FROM_CENTRE_DISTANCE
from pitchpoint.gears.gears_table import SHIFT
from pitchpoint.input.quantities import Quantity, shown
from pitchpoint.lubrication.lubrication_registry import ChosenLaws
from pitchpoint.registry import nearest
from pitchpoint.runs.python_values import demand_arguments, plain_value
from pitchpoint.runs.reading import variants_of

__all__ = ["Case", "CaseLike", "as_case", "case_value", "in_si", "selected_variants"]

_SHOWN = 4
_LISTED = 6

Source = str | Path | Mapping[str, Any]


@dataclass(frozen=True, init=False, repr=False)
class Case:
    """A case that can be computed, changed and written; what changes it gives a new one.

    Args:
        source: a file, the name of a shipped case, the manifest of a result, tables as a case file has
            them, or another case; left out where keywords say it all.
        variant: the only one to keep; all by default.
        tables: values by table, which replace those of the source.

    Numbers of a quantity are SI unless they are texts with a unit: 5.0 at a torque is 5 N m.

    Raises:
        InputError: no such case, no such key, or a value that the key does not take. What is missing, or
            does not fit together, is told where the case is computed.

    Example:
        >>> case = Case("tian2024", variant="physical").set(torque="5 N m")
        >>> case["operation.torque"]
        5.0
    """

    origin: str
    held: tuple[Variant, ...]

    def __init__(
        self,
        source: "Source | Case | None" = None,
        /,
        *,
        variant: str | None = None,
        **tables: Any,
    ) -> None:
        demand_arguments(variant=variant)
        origin, variants = _read(tables if source is None else source)
        chosen = tuple(variants if variant is None else _only(variants, variant))
        object.__setattr__(self, "origin", origin)
        object.__setattr__(self, "held", chosen)
        if tables and source is not None:
            object.__setattr__(self, "held", self.set(_flat(plain_value(tables))).held)

    def set(self, changes: Mapping[str, Any] | None = None, /, **named: Any) -> "Case":
        """The case with other values.

        Args:
            changes: values by dotted key; `gears.profile_shift.1` is that of gear 1, a whole table a
                dictionary. A key without a dot is that of the operating point, or the only one that the case
                has, or could have, which ends so.
            named: the same by keys without a dot.

        Raises:
            InputError: no such key, several that end so, or a value that the key does not take.
        """
        demand_arguments(changes=changes)
        changed = self
        for name, value in {**(changes or {}), **named}.items():
            changed = changed._with(changed.key(name), value)
        return changed

    def key(self, name: str) -> str:
        """Whole key of a case file for one that may lack its tables.

        Raises:
            InputError: there is none, or there are several.
        """
        demand_arguments(key=name)
        tree = self._first.document().tree
        if "." in name or name in _model(tree).model_fields:
            return name
        ending = [key for key in _every_key(tree) if key.rpartition(".")[2] == name]
        at_point = [key for key in ending if key == f"operation.{name}"]
        stated = at_point or [key for key in ending if _has(tree, key)]
        within = [key for key in ending if _has(tree, key.rpartition(".")[0])]
        matches = stated or within or ending
        if len(matches) == 1:
            return matches[0]
        if not matches:
            ends = dict.fromkeys(key.rpartition(".")[2] for key in _every_key(tree))
            wishes = (wish_answer((table, name), None, {}, ends) for table in WISHES)
            advice = next(filter(None, wishes), nearest(name, ends))
            raise InputError(f"there is no such key{advice}", key=shorten(name))
        listed = [*matches[:_LISTED], *["..."] * (len(matches) > _LISTED)]
        raise InputError(f"several keys end so; give one of {', '.join(listed)}", key=name)

    def __getitem__(self, name: str) -> Any:
        """Value of the first variant at a key: numbers in SI, tables as dictionaries.

        Raises:
            InputError: no such key, or a case that cannot be computed.
        """
        key = self.key(name)
        document = self._first.document()
        quantity_at(key, document.tree)
        return _plain(_at(validate(document), key))

    __iter__ = None

    def __repr__(self) -> str:
        title = str(self._first.document().tree.get("title", ""))
        about = [f'"{shorten(title)}"'] * bool(title)
        several = ", ".join(self.variants)
        about += [f"variants {several}"] * (self.variants != ["default"])
        changed = [f"{key} = {shown(value)}" for key, value in self._first.settings.items()]
        about += changed[:_SHOWN] + [f"{len(changed) - _SHOWN} more"] * (len(changed) > _SHOWN)
        return f"Case({self.name}: {'; '.join(about)})"

    @property
    def name(self) -> str:
        """Of its file, or of the shipped case."""
        return self._first.name

    @property
    def variants(self) -> list[str]:
        """Names of its variants."""
        return [variant.variant for variant in self.held]

    @property
    def tables(self) -> Tree:
        """Tables of a case file that says the same; marks on values are kept."""
        by_variant = {variant.variant: _tables(variant.document()) for variant in self.held}
        return by_variant["default"] if [*by_variant] == ["default"] else {"variants": by_variant}

    def to_toml(self, path: str | Path | None = None) -> str:
        """The case as the text of a case file, which is written where a path is given."""
        import tomlkit

        text = tomlkit.dumps(self.tables)
        if path is not None:
            Path(path).write_text(text, "utf-8")
        return text

    @property
    def _first(self) -> Variant:
        return self.held[0]

    def _with(self, key: str, value: Any) -> "Case":
        quantity = quantity_at(key, self._first.document().tree)
        text = case_value(key, value)
        if quantity is not None:
            _demand(quantity, text, key)
        changed_case = copy.copy(self)
        changed = (
            replace(variant, settings={**variant.settings, key: text}) for variant in self.held
        )
        object.__setattr__(changed_case, "held", tuple(changed))
        changed_case._first.document()  # a value of one gear where there is none for the other
        return changed_case


_A_CASE = "a case is a file, the name of a shipped case, or a dictionary of tables"

CaseLike = Case | str | Path | Mapping[str, Any]


def as_case(case: CaseLike) -> Case:
    """A case out of whatever may stand for one.

    Raises:
        InputError: it is None: that is no case, while `Case()` is one to begin with.
    """
    if case is None:
        raise InputError(f"None was given; {_A_CASE}")
    return case if isinstance(case, Case) else Case(case)


def selected_variants(
    case: CaseLike,
    only: Sequence[str] = (),
    settings: Mapping[str, Any] | None = None,
    own: ChosenLaws = (),
) -> list[Variant]:
    """Variants of a case, all or those that are named, with further settings and a law of the user's own."""
    demand_arguments(only=only, settings=settings)
    settings = {key: plain_value(value, key) for key, value in (settings or {}).items()}
    if isinstance(case, str):
        return variants_of(case, only, settings, own)
    chosen: Sequence[Variant] = as_case(case).held
    chosen = [entry for name in only for entry in _only(chosen, name)] if only else chosen
    return [
        replace(entry, settings={**entry.settings, **settings}, own=own or entry.own)
        for entry in chosen
    ]


def case_value(key: str, value: Any) -> Any:
    """A value of Python as a case file has it: numbers of a quantity with their SI unit.

    Args:
        key: dotted.
        value: numbers, texts, arrays, tables.

    Raises:
        InputError: it is none of these, or nested too deeply.
    """
    return _with_units(key, plain_value(value, key))


def _with_units(key: str, value: Any) -> Any:
    """A plain value with the units that stand for its numbers."""
    if isinstance(value, dict):
        return {
            name: _with_units(f"{key}.{name}" if key else name, item)
            for name, item in value.items()
            if item is not None
        }
    if isinstance(value, list):
        return [_with_units(key, item) for item in value]
    unit = _unit(key) if isinstance(value, float | int) and not isinstance(value, bool) else ""
    return f"{float(value)!r} {unit}" if unit else value


def _unit(key: str) -> str:
    """SI unit of the numbers at a key; empty for plain ones, and where there is no such key."""
    try:
        quantity = quantity_at(key)
    except InputError:
        return ""  # told by the schema, with its file
    return "" if quantity is None or quantity.whole else units.si_unit(quantity.kind)


def in_si(value: Any, key: str = "") -> Any:
    """Plain values with the SI number in the place of each quantity: "5 N m" and "5.0 N m" are one.

    Args:
        value: of a case file at the key.
        key: dotted; empty for the whole file.
    """
    if isinstance(value, dict):
        # Ends of a range are values of its key; a name that is none leaves what it has as it is.
        return {
            name: in_si(item, key if name in ("start", "stop") else f"{key}.{name}".lstrip("."))
            for name, item in value.items()
        }
    if isinstance(value, list | tuple):
        return [in_si(item, key) for item in value]
    try:
        quantity = quantity_at(key)
        return value if quantity is None else quantity.si(value)
    except InputError:
        return value


def _demand(quantity: Quantity, value: Any, key: str) -> None:
    """InputError if a value, or one of a list of them, is not what a key takes."""
    if isinstance(value, list):
        for element in value:
            _demand(quantity, element, key)
    elif quantity == SHIFT and value == FROM_CENTRE_DISTANCE:
        pass  # which shifts may follow so is the table's to say
    elif not isinstance(value, dict) and value is not None:
        try:
            quantity.read(value)
        except InputError as error:
            raise error.at(key=key) from None


def _read(source: "Source | Case") -> tuple[str, Sequence[Variant]]:
    """Where a case comes from, and its variants."""
    if isinstance(source, Case):
        return source.origin, source.held
    if isinstance(source, Mapping):
        return "", _of_tables(source)
    if not isinstance(source, str | Path):
        several = "; run several one by one" if isinstance(source, Sequence) else ""
        raise InputError(f"{shown(source)} was given; {_A_CASE}{several}")
    return str(source), variants_of(str(source))


def _of_tables(source: Mapping[str, Any]) -> Sequence[Variant]:
    plain = plain_value(source)
    tree: Tree = _with_units("", plain)
    if isinstance(named := plain.get("variants"), dict) and named:
        # Keys inside are those of a case file again.
        tree["variants"] = {variant: _with_units("", table) for variant, table in named.items()}
    demand_shallow(tree, "case")
    return [Variant(tree, "case", variant) for variant in variants(tree)]


def _only(made: Sequence[Variant], name: str) -> list[Variant]:
    variant_names = [variant.variant for variant in made]
    if name not in variant_names:
        raise unknown_variant(name, variant_names).at(file=made[0].name)
    return [variant for variant in made if variant.variant == name]


def _flat(tables: Mapping[str, Any]) -> dict[str, Any]:
    """Values by dotted key; those of a list of tables together."""
    return dict(leaves({key: value for key, value in tables.items() if value is not None}))


def _model(tree: Mapping[str, Any]) -> type[BaseModel]:
    return DriveCase if STAGES in tree else CaseFile


def _every_key(tree: Mapping[str, Any]) -> Iterator[str]:
    """Keys that a case may have, those of its stages with their numbers."""
    yield from _keys_of(_model(tree))
    for number in tree.get(STAGES) or ():
        yield from (f"{STAGES}.{number}.{key}" for key in _keys_of(StageTable))


@lru_cache
def _keys_of(table: type[BaseModel]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(keys(table)))


def _has(tree: Any, key: str) -> bool:
    """True if a case says something at a key."""
    for part in key.split("."):
        if not isinstance(tree, Mapping) or part not in tree:
            return False
        tree = tree[part]
    return True


def _at(node: Any, key: str) -> Any:
    """What stands at a key of a validated case; a last number is that of a gear."""
    for part in key.split("."):
        if isinstance(node, Mapping):
            node = node.get(part)
        elif isinstance(node, tuple | list) and part.isdecimal():
            node = node[int(part) - 1] if 0 < int(part) <= len(node) else None
        else:
            node = getattr(node, part, None)
    return node


def _plain(value: Any) -> Any:
    return value.model_dump() if isinstance(value, BaseModel) else value


def _tables(document: Document) -> Tree:
    marked: Tree = _marked(in_form(document), document.provenance, "")
    return marked


def _marked(value: Any, marks: Mapping[str, Provenance], key: str) -> Any:
    """Values with the marks that they had; what was set is given now, what is None is left out."""
    if isinstance(value, Mapping):
        inner = {
            name: _marked(item, marks, f"{key}.{name}" if key else name)
            for name, item in value.items()
            if item is not None
        }
        return inner
    plain = [*map(_listed, value)] if isinstance(value, list | tuple) else value
    mark = marks.get(key, Provenance())
    remarks = {"where": mark.where, "note": mark.note}
    remarks = {name: text for name, text in remarks.items() if text}
    if mark.status in ("given", "set") and not remarks:
        return plain
    return {"value": plain, "status": mark.status, **remarks}


def _listed(value: Any) -> Any:
    """An entry of a list as a case file writes it."""
    if isinstance(value, Mapping):
        return {name: _listed(item) for name, item in value.items() if item is not None}
    return [*map(_listed, value)] if isinstance(value, list | tuple) else value
