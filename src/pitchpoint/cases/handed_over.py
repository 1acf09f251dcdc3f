"""A case as it was run, written as a case file that repeats it: what its folder needs is in the folder."""

import hashlib
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import tomlkit
from tomlkit.items import AoT, InlineTable, Item, Table

from pitchpoint.cases.document import STAGES, Document, Provenance, files_of
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.library import as_text
from pitchpoint.cases.record import CASE
from pitchpoint.cases.study_tables import Study
from pitchpoint.core.plain_files import content, digest
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import SIValue
from pitchpoint.results.store import MOST_BYTES, write_bytes, write_text
from pitchpoint.units import si_unit

__all__ = ["FILES", "as_toml", "write_case_copy"]

FILES = "files"
"""Folder beside it with the files that it names."""

_FIRST = ("title", "summary", "source")
_HEAD = "The case as it was run, settings applied; pitchpoint run computes it again."


def write_case_copy(
    document: Document,
    folder: Path,
    *,
    title: str = "",
    studies: Mapping[str, Study] | None = None,
    head: str = _HEAD,
) -> None:
    """Write the case file of a result, and copies of the files that it names.

    Args:
        document: the case, settings applied.
        folder: of the result.
        title: where the case has none.
        studies: beside those of the case.
        head: comment on its first line.

    Raises:
        OSError: the disk is full, say.
    """
    copies = dict(_copies(document))
    for source, name in copies.items():
        _copy(Path(source), folder / FILES / name)
    text = as_toml(document, title=title, studies=studies, files=copies, head=head)
    write_text(folder / CASE, text)


def as_toml(
    document: Document,
    *,
    title: str = "",
    studies: Mapping[str, Study] | None = None,
    files: Mapping[str, str] | None = None,
    head: str = _HEAD,
) -> str:
    """A case as text of a case file: each value as it was given, with its mark.

    Args:
        document: the case, settings applied.
        title: where the case has none.
        studies: beside those of the case.
        files: names in the folder `files` by those that the case has for its files.
        head: comment on its first line.
    """
    of_studies = {
        name: study.model_dump(exclude_unset=True) for name, study in (studies or {}).items()
    }
    tree = {"title": title, **document.tree} if title else dict(document.tree)
    if of_studies:
        tree["studies"] = {**tree.get("studies", {}), **of_studies}
    every = dict.fromkeys((*_FIRST, *tree))
    toml = tomlkit.document()
    toml.add(tomlkit.comment(head))
    pen = _Pen(document.provenance, {} if files is None else files)
    for key, item in pen.entries({key: tree[key] for key in every if key in tree}, ""):
        toml.add(key, item)
    return tomlkit.dumps(toml)


class _Pen:
    """Writes values with their marks.

    Attributes:
        marks: by dotted key.
        files: names in the folder of files by those in the case.
    """

    def __init__(self, marks: Mapping[str, Provenance], files: Mapping[str, str]) -> None:
        self.marks = marks
        self.files = files

    def entries(self, tree: Mapping[str, Any], path: str) -> list[tuple[str, Item]]:
        """Keys and what stands at them, tables last as TOML wants it."""
        written = [(key, self.entry(value, _at(path, key))) for key, value in tree.items()]
        return sorted(written, key=lambda entry: isinstance(entry[1], Table | AoT))

    def entry(self, value: Any, path: str) -> Item:
        """What stands at a key."""
        mark = self.marks.get(path, Provenance())
        if mark != Provenance():
            remarks = {"where": mark.where, "note": mark.note}
            marks = {"status": mark.status, **{key: text for key, text in remarks.items() if text}}
            return _inline({"value": self.plain(value, path), **marks})
        if path == STAGES and isinstance(value, Mapping):
            return self.tables([(table, f"{STAGES}.{number}") for number, table in value.items()])
        if isinstance(value, Mapping):
            return self.table(value, path)
        if "." not in path and _of_tables(value):
            return self.tables([(table, f"{path}.{place}") for place, table in enumerate(value)])
        return self.plain(value, path)

    def table(self, tree: Mapping[str, Any], path: str) -> Table:
        """A table under a heading of its own."""
        entries = self.entries(tree, path)
        table = tomlkit.table(
            bool(entries) and all(isinstance(entry, Table) for _, entry in entries)
        )
        for key, item in entries:
            table.add(key, item)
        return table

    def tables(self, every: list[tuple[Mapping[str, Any], str]]) -> AoT:
        """A list of tables, each under its heading."""
        return _aot([self.table(*placed) for placed in every])

    def plain(self, value: Any, path: str) -> Item:
        """A value without marks, tables in it in braces."""
        if isinstance(value, str) and value in self.files:
            return tomlkit.item(f"{FILES}/{self.files[value]}")
        if isinstance(value, SIValue):
            return tomlkit.item(_with_unit(value, path))
        if isinstance(value, Mapping):
            inner = {key: self.plain(element, _at(path, key)) for key, element in value.items()}
            return _inline(inner)
        if isinstance(value, list | tuple):
            array = tomlkit.array()
            for element in value:
                array.append(self.plain(element, path))
            return array
        written: Item = tomlkit.item(value)
        return written


def _at(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _aot(tables: list[Table]) -> AoT:
    array = tomlkit.aot()
    for table in tables:
        array.append(table)
    return array


def _inline(values: Mapping[str, Any]) -> InlineTable:
    table = tomlkit.inline_table()
    for key, value in values.items():
        table.append(key, value)
    return table


def _of_tables(value: Any) -> bool:
    return isinstance(value, list | tuple) and bool(value) and isinstance(value[0], Mapping)


def _with_unit(value: SIValue, path: str) -> str | float:
    """An SI number as a case file has it."""
    change = path.split(".change.")[-1]
    try:
        quantity = quantity_at(change)
    except InputError:
        return float(value)
    unit = "" if quantity is None else si_unit(quantity.kind)
    return f"{float(value)!r} {unit}" if unit else float(value)


def _copies(document: Document) -> Iterator[tuple[str, str]]:
    """Files that a case names, with what they are called beside its result."""
    taken: dict[str, str] = {}
    for key, file in files_of(document.tree):
        name = as_text(os.path.basename(file))
        if taken.setdefault(name, file) != file:
            name = f"{key}-{name}"
        yield file, name


def _copy(source: Path, target: Path) -> None:
    """Copy a file unless it is there already."""
    held = content(source, MOST_BYTES)
    if not target.is_file() or digest(target, MOST_BYTES) != hashlib.sha256(held).hexdigest():
        write_bytes(target, held)
