"""What a run leaves beside its datasets: whose folder it is, and a manifest of each variant.

Folders travel between people: what these files hold is checked before it is believed or followed.
"""

import os
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, StringConstraints, ValidationError

from pitchpoint.cases.comparison import Row
from pitchpoint.cases.library import as_text, names, path_of
from pitchpoint.errors import InputError, shorten
from pitchpoint.results.store import read_bytes, write_text

__all__ = ["MANIFEST", "RUN", "Manifest", "Record", "default_folder", "owner"]

MANIFEST = "manifest.json"

RUN = "run.json"
"""Case and variants of the last run into a folder."""

MAX_BYTES = 50_000_000
"""Largest manifest that is read; real ones have some ten kilobytes."""

# Of a variant or part, and of its folder or file: never a path that leads elsewhere.
Name = Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_-]{1,200}$")]


class _Kept(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid")

    @classmethod
    def read(cls, path: Path) -> Self:
        """Content of a file; InputError for whatever `write` did not write."""
        content = read_bytes(path, MAX_BYTES)
        try:
            return cls.model_validate_json(content)
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            told = f"was not written by this version of pitchpoint: {first['msg']}"
            key = shorten(".".join(map(str, first["loc"])))
            raise InputError(told, file=str(path), key=key or None) from None


class Record(_Kept):
    """Whose folder it is.

    Attributes:
        case: name of the shipped case or of the file.
        file: way from the folder to the case file, so that both may move; empty for a shipped case.
        variants: of the last run.
    """

    case: str
    file: str = ""
    variants: list[Name]

    @classmethod
    def of(cls, case: str, name: str, folder: Path, variants: list[str]) -> Self:
        """Record of a case, given by its name or file, that runs into a folder."""
        return cls(case=name, file=_way(case, folder), variants=variants)

    @property
    def mark(self) -> str:
        """What tells one case from another."""
        return self.file or self.case

    def write(self, folder: Path) -> None:
        """Mark the folder as that of this case."""
        write_text(folder / RUN, self.model_dump_json())

    def demand_own(self, folder: Path) -> None:
        """InputError if the folder holds results of another case."""
        theirs = owner(folder)
        if theirs is not None and theirs.mark != self.mark:
            raise InputError(
                f"holds results of another case, {shorten(theirs.mark)}; give another folder, or"
                " --overwrite (overwrite=True) to replace them",
                file=str(folder),
            )


class Input(_Kept):
    """A resolved input: table, key, value, status, place, remark."""

    table: str
    key: str
    value: str
    status: str
    where: str
    note: str


class Law(_Kept):
    """A friction law in use."""

    name: str
    title: str
    note: str


class Model(Law):
    """A model in use for one effect beside friction."""

    effect: str


class Source(_Kept):
    """A reference behind the result."""

    key: str
    text: str


class Doubt(_Kept):
    """A misprint or a questionable point of the publication."""

    where: str
    issue: str
    verdict: str


class Manifest(_Kept):
    """What a variant was computed from and with, and how far it got."""

    case: str
    variant: Name
    variants: list[Name]
    title: str
    summary: str
    settings: dict[str, str]
    inputs: list[Input]
    warnings: list[str]
    laws: list[Law]
    models: list[Model]
    family: str
    driver: str
    loaded: str
    averaging: str
    plastic: bool
    oil: str
    sources: list[Source]
    issues: list[Doubt]
    rows: list[Row]
    parts: list[Name]
    finished: bool


def owner(folder: Path) -> Record | None:
    """Whose folder it is; None if nobody's, or if its record cannot be read."""
    try:
        return Record.read(folder / RUN)
    except InputError:
        return None


def default_folder(case: str, root: Path) -> Path:
    """Folder of a case under another: named after the case, by more of its path where that is taken.

    A case finds its own folder again; `b/pair.toml` beside `a/pair.toml` goes to `b-pair`.

    Args:
        case: name of a shipped case, or a file.
        root: folder of all results.
    """
    path = Path(os.path.abspath(path_of(case)))
    shipped = case in names()
    parts = path.parent.parts[1:] if shipped else (*path.parent.parts[1:], path.stem)
    folders = [root / "-".join(parts[-count:]) for count in range(1, len(parts) + 1)]
    owners = {folder: owner(folder) for folder in folders}
    own = [one for one, of in owners.items() if of and of.mark == (_way(case, one) or case)]
    free = [one for one, of in owners.items() if of is None]
    return [*own, *free, *folders][0]


def _way(case: str, folder: Path) -> str:
    if case in names():
        return ""
    file = os.path.realpath(path_of(case))
    with suppress(ValueError):  # on another drive
        file = os.path.relpath(file, os.path.realpath(folder))
    return as_text(file)
