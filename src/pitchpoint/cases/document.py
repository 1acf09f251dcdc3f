"""Case files as plain data: reading, variants, settings, and where each value comes from."""

import copy
import io
import math
import os
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pitchpoint.core.plain_files import content
from pitchpoint.errors import InputError, shorten
from pitchpoint.input.quantities import shown, text
from pitchpoint.registry import nearest

__all__ = [
    "DIAMETRAL_PITCH",
    "MARKS",
    "STAGES",
    "STATUSES",
    "Document",
    "Provenance",
    "at_most",
    "check_name",
    "demand_shallow",
    "files_of",
    "leaves",
    "parsed",
    "read_tables",
    "set_key",
    "setting",
    "strip",
    "too_many",
    "unknown_variant",
]

_NAMING_FILES = (
    ("film", "heights", "*"),
    ("worn",),
    ("duty",),
    ("stages", "*", "worn"),
    ("stages", "*", "film", "heights", "*"),
)
"""Places of the tables that name files; a star stands for every table there."""

MAX_BYTES = 1_000_000
"""Largest case file that is read; real ones have a few kilobytes."""

MAX_DEPTH = 16
"""Deepest nesting of tables and lists that is read; real ones have about five levels."""

STAGES = "stages"
"""Table of the meshes of a drive, a list of them from the input to the output."""

DIAMETRAL_PITCH = "diametral_pitch"
"""Key of [gears] that may stand in the place of the module of gears without a helix."""

MAX_VARIANTS = 50
"""Most variants of a case; each is computed by itself."""

STATUSES = (
    "printed",
    "derived",
    "digitised",
    "assumed",
    "fitted",
    "corrected",
    "given",
    "set",
    "default",
)

Tree = dict[str, Any]

MARKS = {
    "status": "How the value was come by; given unless said.",
    "where": "Place of the value in its source.",
    "note": "Remark on the value.",
}
"""What may stand beside a value, `{ value = ..., status = ... }`, and what it says."""

_BETWEEN_KEYS = re.compile(r"[=,{}\[\]\n]")
_MANY_DOTS = 500  # more than any remark has
_NAME = re.compile(r"[A-Za-z0-9_-]{1,60}", re.ASCII)


@dataclass(frozen=True)
class Provenance:
    """How a value was come by: status, place in the publication, remark."""

    status: str = "given"
    where: str = ""
    note: str = ""


@dataclass(frozen=True)
class Document:
    """A case file with its variants resolved.

    Attributes:
        name: of the file or of the shipped case, for messages.
        tree: plain values by table and key.
        provenance: by dotted key, for values that carry a mark.
    """

    name: str
    tree: Tree
    provenance: Mapping[str, Provenance] = field(default_factory=dict)


def read_tables(path: Path) -> Tree:
    """Tables of a TOML file, marks included.

    Raises:
        InputError: missing, too large, not text, not TOML.
    """
    try:
        text = _text(path)
        if max(part.count(".") for part in _BETWEEN_KEYS.split(text)) > _MANY_DOTS:
            raise _too_deep(path.name)  # the reader would take hours to say so
        tree = parsed(text)
    except UnicodeDecodeError as error:
        from pitchpoint.cases.other_formats import not_utf_8

        raise InputError(not_utf_8(error), file=path.name) from None
    except RecursionError:
        raise _too_deep(path.name) from None
    except InputError:
        raise
    except ValueError as error:
        from pitchpoint.cases.other_formats import not_toml

        raise InputError(not_toml(text, error), file=path.name) from None
    demand_shallow(tree, path.name)
    try:
        overlays = _overlays(tree)
    except InputError as error:
        raise error.at(file=path.name) from None
    for table in (tree, *overlays.values()):
        _find_files(table, path.parent)
    return tree


def parsed(text: str) -> Tree:
    """Tables of a text in TOML; a number that is no number of a computer stays as it was written.

    Args:
        text: of a case file, or a part of one.

    Raises:
        ValueError: it is not TOML.

    Example:
        >>> parsed("module = 1e400")
        {'module': '1e400'}
    """
    return tomllib.loads(text, parse_float=_as_written)


def _as_written(text: str) -> float | str:
    number, digits = float(text), text.lower().partition("e")[0]
    lost = math.isinf(number) or (number == 0.0 and re.search("[1-9]", digits))
    return text if lost and re.search("[0-9]", text) else number


def _find_files(tree: Tree, folder: Path) -> None:
    """Names of files become those from where the case file lies."""
    for place in _NAMING_FILES:
        for table in _tables_at(tree, place):
            file = table.get("file")
            if isinstance(file, dict) and isinstance(file.get("value"), str):
                file["value"] = _from(folder, file["value"])
            elif isinstance(file, str):
                table["file"] = _from(folder, file)


def files_of(tree: Tree) -> Iterator[tuple[str, str]]:
    """Name of the table and file of everything that a case reads from a file of its own.

    Args:
        tree: plain values, without marks.
    """
    for place in _NAMING_FILES:
        *above, name = place
        tables = [(name, table) for table in _tables_at(tree, place)] if name != "*" else []
        if name == "*":
            inner = [item for table in _tables_at(tree, tuple(above)) for item in table.items()]
            tables = [(key, table) for key, table in inner if isinstance(table, dict)]
        yield from (
            (key, table["file"]) for key, table in tables if isinstance(table.get("file"), str)
        )


def _tables_at(tree: Any, place: tuple[str, ...]) -> Iterator[Tree]:
    """Tables at a place of a tree, as far as there are any."""
    table = _bare(tree)
    if isinstance(table, list):  # of stages, which are not numbered yet
        table = dict(enumerate(table))
    if not isinstance(table, dict):
        return
    if not place:
        yield table
        return
    head, *others = place
    for key in table if head == "*" else (head,):
        yield from _tables_at(table.get(key), tuple(others))


def _bare(value: Any) -> Any:
    """A table without the marks that stand around it."""
    return value["value"] if isinstance(value, dict) and _marked(value) else value


def _from(folder: Path, name: str) -> str:
    return name if not name or "\0" in name else os.path.realpath(folder / name)


def _text(path: Path) -> str:
    if not os.path.exists(path):
        from pitchpoint.cases.other_formats import neighbours

        raise InputError(f"there is no such case file{neighbours(path)}", file=str(path))
    held = io.BytesIO(content(path, MAX_BYTES, "case file"))
    return io.TextIOWrapper(held, encoding="utf-8-sig").read()  # ends lines as Macintoshes did


def _too_deep(name: str) -> InputError:
    return InputError(f"is nested more than {MAX_DEPTH} levels deep, the most allowed", file=name)


def demand_shallow(tree: Tree, name: str) -> None:
    """InputError if tables and lists are nested more deeply than any case needs."""
    if _depth(tree) > MAX_DEPTH:
        raise _too_deep(name)


def _depth(tree: Any) -> int:
    """Levels of tables and lists; without recursion, so that no file exhausts the stack."""
    level, depth = [tree], 0
    while level and depth <= MAX_DEPTH:
        inner = [item.values() if isinstance(item, dict) else item for item in level]
        level = [part for items in inner for part in items if isinstance(part, dict | list)]
        depth += 1
    return depth


def variants(tree: Tree) -> list[str]:
    """Names of the variants that a case file defines; one nameless default if it has none."""
    return list(_overlays(tree)) or ["default"]


def unknown_variant(variant: str, known: Sequence[str]) -> InputError:
    """Error for a variant that a case does not have."""
    if [*known] == ["default"]:
        name = variant if _NAME.fullmatch(variant) else "NAME"
        return InputError(
            f"{shown(variant)} was asked for, and this case has no variants; leave it out, or write its "
            f"changes as tables, such as [variants.{name}.operation]",
            key="variants",
        )
    return InputError(
        f"{shown(variant)} is not a variant of this case{nearest(variant, known)}", key="variants"
    )


def _overlays(tree: Tree) -> Tree:
    stated = tree.get("variants", {})
    if not isinstance(stated, dict):
        raise InputError(f"{shown(stated)} was given where a table belongs", key="variants")
    if len(stated) > MAX_VARIANTS:
        message = f"{len(stated)} were given; allowed are at most {MAX_VARIANTS}"
        raise InputError(message, key="variants")
    overlays = {name: _bare(overlay) for name, overlay in stated.items()}
    for name, overlay in overlays.items():
        check_name(name, "variants")
        if not isinstance(overlay, dict):
            raise InputError(
                f"{shown(overlay)} was given where a table belongs; a variant has the tables that it "
                f"changes, such as [variants.{name}.operation]",
                key=f"variants.{name}",
            )
        for key, value in overlay.items():
            _demand_table(key, value, name, tree)
    return overlays


def _demand_table(key: str, value: Any, variant: str, tree: Tree) -> None:
    """InputError for a key of a table of the case that stands in a variant by itself."""
    *above, leaf = key.split(".")
    tables = [name for name, table in tree.items() if isinstance(table, dict) and leaf in table]
    holding = ".".join(above) or next(iter(tables), "")
    if not isinstance(value, dict) and holding and key not in tree:
        raise InputError(
            f"stands in no table; write [variants.{variant}.{holding}] and {leaf} below it",
            key=f"variants.{variant}.{key}",
        )


def check_name(name: str, key: str) -> None:
    """InputError if a name of the user's own would not do as the name of a file."""
    if not _NAME.fullmatch(name):
        raise InputError(
            f"{shown(name)} is not a name; use 1 to 60 letters, digits, '_' and '-'", key=key
        )


def resolve(
    tree: Tree,
    *,
    name: str,
    variant: str,
    settings: Mapping[str, Any] | None = None,
    folder: Path | None = None,
    usual: Callable[[str, Tree], Any] = lambda key, tree: None,
) -> Document:
    """One variant of a case with settings applied, its marks separated from the values.

    Args:
        tree: as read.
        name: of the file, for messages.
        variant: one of `variants(tree)`.
        settings: values by dotted key that replace those of the file.
        folder: where files that settings name are looked for; None to take their names as they are.
        usual: values of both gears at a key that the tables leave out; None where there are none.

    Raises:
        InputError: unknown variant, or a mark that is not one.
    """
    allowed = variants(tree)
    if variant not in allowed:
        raise unknown_variant(variant, allowed).at(file=name)
    base = {key: value for key, value in tree.items() if key != "variants"}
    merged = _tables_merged(_numbered(base), _numbered(_overlays(tree).get(variant, {})))
    for key, value in (settings or {}).items():
        mark = {"value": copy.deepcopy(value), "status": "set"}
        merged = setting(merged, key, mark, name=name, usual=usual)
    if settings and folder is not None:
        for place, *_ in _NAMING_FILES:
            if place in merged:  # else a table of the file itself would be changed
                merged[place] = copy.deepcopy(merged[place])
        _find_files(merged, folder)
    provenance: dict[str, Provenance] = {}
    plain = {key: strip(entry, provenance, name=name, key=key) for key, entry in merged.items()}
    _respell(plain, "gears", provenance)
    stages = plain.get(STAGES)
    for number, stage in stages.items() if isinstance(stages, dict) else ():
        _respell(stage, f"{STAGES}.{number}.gears", provenance)
    return Document(name, plain, provenance)


def _respell(tables: Any, place: str, provenance: dict[str, Provenance]) -> None:
    """The diametral pitch of gears becomes their module; that of helical ones has two meanings and stays."""
    gears = tables.get("gears") if isinstance(tables, dict) else None
    pitch = gears.get(DIAMETRAL_PITCH) if isinstance(gears, dict) else None
    number = isinstance(pitch, int | float) and not isinstance(pitch, bool)
    if number and isinstance(gears, dict) and not {"module", "helix_angle"} & gears.keys():
        gears["module"] = f"{gears.pop(DIAMETRAL_PITCH)} DP"
        mark = provenance.pop(f"{place}.{DIAMETRAL_PITCH}", Provenance())
        note = "; ".join(filter(None, [mark.note, f"by the diametral pitch {pitch}"]))
        provenance[f"{place}.module"] = replace(mark, note=note)


def _numbered(tree: Tree) -> Tree:
    """Tables with a list of stages as tables by number, so that each value has a dotted key."""
    stages = tree.get(STAGES)
    if not isinstance(stages, list) or not all(isinstance(stage, dict) for stage in stages):
        return tree
    return {**tree, STAGES: {str(number): stage for number, stage in enumerate(stages, 1)}}


def setting(
    tree: Tree,
    key: str,
    value: Any,
    *,
    name: str = "--set",
    usual: Callable[[str, Tree], Any] = lambda key, tree: None,
) -> Tree:
    """The tables with the value at a dotted key replaced; `a.b.1` is the value of gear 1.

    Tables along the key are copies, all others those of `tree`.
    """
    if key.count(".") + _depth(value) > MAX_DEPTH:
        raise _too_deep(name).at(key=key)
    *parents, leaf = key.split(".")
    result = _copied(tree, parents)
    try:
        if leaf.isdecimal() and parents:
            node = _table(result, parents[:-1])
            above = parents[-1]
            both = node[above] if above in node else usual(".".join(parents), tree)
            node[parents[-1]] = _of_gear(both, leaf, value)
        else:
            set_key(result, key, value)
    except InputError as error:
        raise error.at(file=name, key=key) from None
    return result


def _copied(tree: Tree, parents: list[str]) -> Tree:
    """Tables of which those along a key may be changed."""
    result = node = dict(tree)
    for part in parents:
        inner = node.get(part)
        if not isinstance(inner, dict):
            break
        node[part] = node = dict(inner)
    return result


def set_key(tree: Tree, key: str, value: Any) -> None:
    """Put a value at a dotted key into tables; InputError if a value stands where a table is needed."""
    *parents, leaf = key.split(".")
    _table(tree, parents)[leaf] = value


def _table(tree: Tree, parents: list[str]) -> Tree:
    node = tree
    for part in parents:
        inner = node.setdefault(part, {})
        if isinstance(inner, dict) and _marked(inner) and isinstance(inner["value"], dict):
            node[part] = inner = _spread(inner)
        node = inner
        if not isinstance(node, dict) or _marked(node):
            raise InputError(f"{shown(part)} is a value, not a table")
    return node


def _spread(marked: Tree) -> Tree:
    """A table with a mark as a table of values that have it each."""
    return {key: {**marked, "value": value} for key, value in marked["value"].items()}


def strip(value: Any, provenance: dict[str, Provenance], *, name: str = "", key: str = "") -> Any:
    """Values without their marks, which go into `provenance` by dotted key."""
    if isinstance(value, dict):
        if _marked(value):
            mark = _provenance(value, name, key)
            bare = strip(value["value"], provenance, name=name, key=key)
            for path in (key, *(leaf for leaf, _ in leaves({key: bare}))):
                provenance.setdefault(path, mark)  # of a table, that of its values
            return bare
        return {
            part: strip(item, provenance, name=name, key=f"{key}.{part}" if key else part)
            for part, item in value.items()
        }
    return value


def _marked(table: Tree) -> bool:
    """True for a value with its marks, false for a table of values."""
    return "value" in table and set(table) <= {*MARKS, "value"}


def leaves(tree: Tree, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted key and value of everything that is not a table, and of tables that are empty."""
    for key, value in tree.items():
        path = f"{prefix}{key}"
        if isinstance(value, dict) and value:
            yield from leaves(value, f"{path}.")
        else:
            yield path, value


def _provenance(mark: Tree, name: str, key: str) -> Provenance:
    status = mark.get("status", "given")
    if status not in STATUSES:
        raise InputError(
            f"{shown(status)} is not a status; use one of {', '.join(STATUSES)}", file=name, key=key
        )
    try:
        return Provenance(status, *(text(mark.get(part, "")) for part in ("where", "note")))
    except InputError as error:
        raise error.at(file=name, key=key) from None


def _merged(base: Any, overlay: Any) -> Any:
    if not (isinstance(base, dict) and isinstance(overlay, dict)) or "value" in overlay:
        return overlay
    if "value" in base:
        return overlay
    return _tables_merged(base, overlay)


def _tables_merged(base: Tree, overlay: Tree) -> Tree:
    keys = [*base, *(key for key in overlay if key not in base)]
    return {
        key: _merged(base[key], overlay[key])
        if key in base and key in overlay
        else overlay.get(key, base.get(key))
        for key in keys
    }


def _of_gear(values: Any, gear: str, value: Any) -> Any:
    """Values of two gears, or of all of a set, with that of one of them replaced; or stages with one."""
    if isinstance(values, dict) and "1" in values:
        if gear not in values:
            raise InputError(f"there is no stage {shorten(gear)}; use {' or '.join(values)}")
        return {**values, gear: value}
    if isinstance(values, dict):
        values = values.get("value")
    of_gears = (
        list(values) if isinstance(values, list | tuple) and len(values) > 1 else [values] * 2
    )
    gears = [str(number) for number in range(1, len(of_gears) + 1)]
    if gear not in gears:
        raise InputError(f"there is no gear {shorten(gear)}; use {' or '.join(gears)}")
    if values is None:
        raise InputError(
            "is the value of one gear, and there is none for the other; give both as a list"
        )
    mark = value if isinstance(value, dict) else {"value": value}
    of_gears[int(gear) - 1] = mark["value"]
    return {**mark, "value": of_gears}


def at_most(most: int) -> Callable[[Any], Any]:
    """Validator of tables under names of the user's own, which are counted before they are read."""

    def check(value: Any) -> Any:
        entries = value if isinstance(value, dict) else {}
        if len(entries) > most:
            raise InputError(too_many(len(entries), most))
        for name in entries:
            check_name(name, "")
        return value

    return check


def too_many(count: int, most: int) -> str:
    """What is wrong with a list or a table of so many entries."""
    return f"{count} were given; allowed are at most {most}"
