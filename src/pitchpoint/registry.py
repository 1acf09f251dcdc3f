"""Registries of rival formulas: a name picks one, an unknown name gets the nearest known ones."""

import difflib
from collections.abc import Iterable, Iterator, Mapping
from typing import Protocol, TypeVar

from pitchpoint.errors import InputError

__all__ = ["Registry", "listed", "nearest"]

_MOST = 24  # names in one sentence


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """Name by which it is picked."""
        ...


Entry = TypeVar("Entry", bound=Named)


class Registry(Mapping[str, Entry]):
    """Entries by name, in the order in which they were given."""

    def __init__(self, kind: str, *entries: Entry) -> None:
        """`kind` names the entries in messages, e.g. "friction law"."""
        self.kind = kind
        self._entries = {entry.name: entry for entry in entries}

    def __getitem__(self, name: str) -> Entry:
        """Entry of that name; InputError with the nearest names if there is none."""
        try:
            return self._entries[name]
        except KeyError:
            raise InputError(
                f"'{name}' is not a known {self.kind}{nearest(name, self._entries)}"
            ) from None

    def __iter__(self) -> Iterator[str]:
        """Names in order."""
        return iter(self._entries)

    def __len__(self) -> int:
        """Number of entries."""
        return len(self._entries)

    def extended(self, *entries: Entry) -> "Registry[Entry]":
        """A registry with further entries, this one unchanged."""
        return Registry(self.kind, *self._entries.values(), *entries)


def nearest(name: str, known: Mapping[str, object]) -> str:
    """End of a sentence that offers the known names nearest to a wrong one, or all of them."""
    close = difflib.get_close_matches(name, known, n=3, cutoff=0.6)
    if close:
        return f"; did you mean {' or '.join(close)}?"
    return f"; known are {listed(known)}"


def listed(names: Iterable[str]) -> str:
    """Names in a sentence, of very many the first ones."""
    every = [*names]
    more = f" and {len(every) - _MOST} more" if len(every) > _MOST else ""
    return ", ".join(every[:_MOST]) + more
