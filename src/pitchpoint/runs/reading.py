"""The variants of a case, as a run takes them: from a file, a shipped case, a record or a result."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from pitchpoint.cases.document import read_tables, variants
from pitchpoint.cases.library import as_text, case_path, find_case
from pitchpoint.cases.record import CASE, MANIFEST, RUN, Manifest, Record, is_record, is_result
from pitchpoint.cases.variant import Variant
from pitchpoint.core.plain_files import digest_of
from pitchpoint.errors import InputError, shorten, visible
from pitchpoint.lubrication.lubrication_registry import ChosenLaws
from pitchpoint.registry import nearest

__all__ = ["variants_of"]


def variants_of(
    case: str,
    only: Sequence[str] = (),
    settings: Mapping[str, Any] | None = None,
    own: ChosenLaws = (),
) -> list[Variant]:
    """Variants of a case, all or those that are named; of a record the one that it holds."""
    if is_result(case):
        return _of_result(Path(case), only, settings or {}, own)
    if is_record(case):
        held = _recorded(Path(case), own, settings or {})
    else:
        name, tree = find_case(case)
        held = Variant(tree, name, "", folder=case_path(case).parent)
    chosen = only or variants(dict(held.tree))
    return [
        replace(held, variant=variant, settings=dict(settings or {}), own=own) for variant in chosen
    ]


def _of_result(
    folder: Path, only: Sequence[str], settings: Mapping[str, Any], own: ChosenLaws
) -> list[Variant]:
    """Variants of the folder of a result, each from the case file that was written beside it."""
    variants = Record.read(folder / RUN).variants
    for name in only:
        if name not in variants:
            message = f"'{shorten(name)}' is not a variant of this result{nearest(name, variants)}"
            raise InputError(message, file=visible(as_text(str(folder))))
    return [
        replace(
            _handed_over(folder / name, own, settings),
            variant=name,
            settings=dict(settings),
            own=own,
        )
        for name in only or variants
    ]


def _handed_over(folder: Path, own: ChosenLaws, settings: Mapping[str, Any]) -> Variant:
    """The variant that a folder holds; where an earlier version left no case file there, its record."""
    path = folder / CASE
    if not path.is_file():
        return _recorded(folder / MANIFEST, own, settings)
    record = Manifest.read(folder / MANIFEST)
    name = visible(as_text(f"{folder.name}/{CASE}"))
    tree = {"variants": {folder.name: read_tables(path)}}
    warnings = tuple(record.warning)
    return Variant(tree, name, folder.name, recorded=record.case, warnings=warnings, folder=folder)


def _recorded(path: Path, own: ChosenLaws, settings: Mapping[str, Any]) -> Variant:
    """The variant that a record holds."""
    record, name = Manifest.read(path), visible(as_text(path.name))
    if record.own and not own:
        raise InputError(
            f"was computed with '{shorten(record.own)}', a friction law of the user's own, which no record "
            "can hold; give it again, from Python as friction",
            file=name,
        )
    try:
        tree = record.tree
    except InputError as error:
        raise error.at(file=name) from None
    warnings = (
        *record.warning,
        *_other_heights(record, settings),
        *dict.fromkeys(_other_inputs(record, settings)),
    )
    return Variant(
        tree, name, record.variant, recorded=record.case, warnings=warnings, folder=path.parent
    )


def _other_heights(record: Manifest, settings: Mapping[str, Any]) -> Iterator[str]:
    """That files hold other heights than when the record was made, those that settings replace left out."""
    for key in _by_key(record):
        film, _, which = key.partition(".heights.")
        replaced = any(
            setting == film or setting.startswith(f"{film}.heights") for setting in settings
        )
        if which.endswith(".digest") and not replaced:
            yield from _other_file(record, key.removesuffix("digest"), "heights")


def _other_inputs(record: Manifest, settings: Mapping[str, Any]) -> Iterator[str]:
    """That files hold other wear or loads than when the record was made, unless settings name others."""
    for key in _by_key(record):
        place, _, leaf = key.rpartition(".")
        *_, table = place.split(".")
        what = {"worn": "worn flanks", "duty": "loads over time"}.get(table)
        # Of a set the table of the file is that of each mesh.
        replaced = any(
            setting == table or setting.startswith((f"{table}.", place)) for setting in settings
        )
        if leaf == "digest" and what and not replaced:
            yield from _other_file(record, f"{place}.", what)


def _by_key(record: Manifest) -> dict[str, Any]:
    """Inputs by dotted key."""
    return {f"{row.table}.{row.key}": row.value for row in record.inputs}


def _other_file(record: Manifest, place: str, what: str) -> Iterator[str]:
    """That a file that stands at a place holds something else than when the record was made."""
    file, then = (_by_key(record).get(f"{place}{key}") for key in ("file", "digest"))
    now = digest_of(file) if isinstance(file, str) and then else ""
    if now and now != then:
        name = visible(shorten(os.path.basename(str(file))))
        yield f'The record was made with other {what} than "{name}" holds now: numbers differ.'
