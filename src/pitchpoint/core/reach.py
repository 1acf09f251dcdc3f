"""What modules of the package reach, and digests of that code.

Only what runs counts: neither docstrings nor comments. A module reaches what it imports, inside functions
too; what it names in full in a string, as entries of registries do; data files beside or below it that it
names; and the packages around it. A module whose name is put together from parts is not seen.
"""

import hashlib
import json
import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from importlib.util import MAGIC_NUMBER
from pathlib import Path, PurePosixPath
from types import CodeType
from typing import NamedTuple

from pitchpoint.core.kept import read_kept, write_kept

__all__ = ["Sources"]

_NAMED = re.compile(r"(?P<module>pitchpoint(?:\.\w+)+)(?::[\w.]+)?|(?P<data>[\w-]+\.toml)")
_TEXTS = frozenset({"references.toml", "sample.toml"})
"""Data files of which no number enters a program: sources of laws, and cases to begin with."""


class _Source(NamedTuple):
    """What counts of a file: digests of all of it and of what runs, and the files that it may mean."""

    whole: str
    code: str
    next: list[str]


class Sources:
    """Files of code and data of the package, as they are now.

    Args:
        root: folder of the package.
        kept: folder for what was found, for later processes; compiling all files takes a second.
    """

    def __init__(self, root: Path, kept: Path | None = None) -> None:
        self.root, self.kept = root, kept
        self._fresh = False
        self._reached: dict[str, str] = {}

    @cached_property
    def digest(self) -> str:
        """Digest of every file, texts and all."""
        return _digest(f"{file}:{content};" for file, content in self._wholes.items())

    def digest_of_reach(self, modules: Iterable[str]) -> str:
        """Digest of all that runs in modules of the package, and in what they reach."""
        return _digest(map(self._reach_of, sorted(set(filter(None, map(self._file, modules))))))

    def _reach_of(self, start: str) -> str:
        if start not in self._reached:
            files = sorted(self.reach(start))
            self._reached[start] = _digest(f"{file}:{self._source(file).code};" for file in files)
            self._keep()
        return self._reached[start]

    def reach(self, start: str) -> set[str]:
        """Files that one reaches, itself among them."""
        reached, ahead = set[str](), {start}
        while ahead:
            reached |= ahead
            ahead = {file for here in ahead for file in self._source(here).next} - reached
        return reached

    def _file(self, name: str) -> str | None:
        """File of a module, or of the one that holds what is named; None if it is not of the package."""
        package, *parts = name.split(".")
        while parts and package == "pitchpoint":
            stem = "/".join(parts)
            for file in (f"{stem}.py", f"{stem}/__init__.py"):
                if file in self._wholes:
                    return file
            parts.pop()
        return None

    @cached_property
    def _wholes(self) -> dict[str, str]:
        """Digest of every file by its path in the package."""
        files = sorted(path for path in self.root.rglob("*") if path.suffix in (".py", ".toml"))
        return {
            path.relative_to(self.root).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in files
        }

    @cached_property
    def _path(self) -> Path | None:
        """File for what was found here among just these files, which names are looked up in."""
        name = _digest([MAGIC_NUMBER.hex(), str(self.root), *self._wholes])
        return None if self.kept is None else self.kept / name[:40]

    @cached_property
    def _known(self) -> dict[str, _Source]:
        """What is known of files; an earlier process may have found it."""
        content = None if self._path is None else read_kept(self._path)
        return {file: _Source(*record) for file, record in json.loads(content or b"{}").items()}

    def _source(self, file: str) -> _Source:
        content = self._wholes[file]
        if file not in self._known or self._known[file].whole != content:
            self._known[file] = self._read(file, content)
            self._fresh = True
        return self._known[file]

    def _read(self, file: str, whole: str) -> _Source:
        if not file.endswith(".py"):
            return _Source(whole, whole, [])
        code = compile((self.root / file).read_bytes(), "", "exec", dont_inherit=True, optimize=2)
        return _Source(whole, _digest(_run(code)), sorted(set(self._next(code, file))))

    def _next(self, code: CodeType, file: str) -> Iterator[str]:
        """Files of the packages around one, and of what it may name."""
        folder = PurePosixPath(file).parent
        around = (str(above / "__init__.py") for above in (folder, *folder.parents))
        yield from filter(self._wholes.__contains__, around)
        # What the package itself names is loaded when a user asks for it.
        for name in () if file == "__init__.py" else _names(code):
            if name.endswith(".toml"):
                yield from (
                    data for data in self._wholes if _beside(PurePosixPath(data), name, folder)
                )
            elif module := self._file(name):
                yield module

    def _keep(self) -> None:
        if self._fresh and self._path is not None:
            write_kept(self._path, json.dumps(self._known).encode())
        self._fresh = False


def _digest(parts: Iterable[str]) -> str:
    digest = hashlib.sha256()
    for part in parts:
        digest.update(part.encode())
    return digest.hexdigest()


def _beside(data: PurePosixPath, name: str, folder: PurePosixPath) -> bool:
    """True for a data file of that name in a folder or below it."""
    return data.name == name not in _TEXTS and data.is_relative_to(folder)


def _run(code: CodeType) -> Iterator[str]:
    """What runs, without the lines that it stands on: the same in every process."""
    yield code.co_code.hex() + code.co_exceptiontable.hex()
    yield repr(
        (code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_qualname)
    )
    yield repr((code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags))
    for value in code.co_consts:
        yield from _run(value) if isinstance(value, CodeType) else (_shown(value),)


def _shown(value: object) -> str:
    """A constant; sets have an order of their own in each process."""
    if isinstance(value, frozenset):
        return repr(sorted(map(_shown, value)))
    if isinstance(value, tuple):
        return f"({','.join(map(_shown, value))})"
    return repr(value)


def _names(code: CodeType) -> Iterator[str]:
    """Names of modules and data files in some code; perhaps of more than it means."""
    for value in code.co_consts:
        yield from _names(value) if isinstance(value, CodeType) else _named(value)
    for module in code.co_names:
        if module.startswith("pitchpoint"):
            yield from (module, *(f"{module}.{name}" for name in code.co_names))


def _named(value: object) -> Iterator[str]:
    """Names in a constant."""
    if isinstance(value, tuple | frozenset):
        for item in value:
            yield from _named(item)
    elif isinstance(value, str) and (match := _NAMED.fullmatch(value)):
        yield match["module"] or match["data"]
