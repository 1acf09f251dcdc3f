"""The errors Pitchpoint raises on purpose; each one says what was wrong and where."""

from __future__ import annotations

import copy
import difflib
from collections.abc import Iterable
from typing import ClassVar, Self

__all__ = ["ConvergenceError", "InputError", "PitchpointError", "unknown_name"]


class PitchpointError(Exception):
    """Base of every error raised on purpose; `exit_code` is what the command line returns."""

    exit_code: ClassVar[int] = 1


class InputError(PitchpointError, ValueError):
    """Bad input, told in one sentence: `pair.toml: gears.module: "3 mmm" is not a length; ...`.

    Args:
        message: the sentence without its location.
        file: name of the file the input came from, if any.
        key: dotted name of the entry inside the file, if any.
        value: the offending value, for programs that want to show it themselves.
        allowed: the values that would have been accepted, where they can be listed.

    Example:
        >>> str(InputError("must be positive", key="gears.module"))
        'gears.module: must be positive'
    """

    exit_code: ClassVar[int] = 2

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        key: str | None = None,
        value: object = None,
        allowed: Iterable[str] = (),
    ) -> None:
        super().__init__(message)
        self.message = message
        self.file = file
        self.key = key
        self.value = value
        self.allowed = tuple(allowed)

    def __str__(self) -> str:
        return ": ".join(part for part in (self.file, self.key, self.message) if part)

    def at(self, *, file: str | None = None, key: str | None = None) -> Self:
        """Return a copy with the location filled in; what is not given stays as it was."""
        located = copy.copy(self)
        located.file = file if file is not None else self.file
        located.key = key if key is not None else self.key
        return located


class ConvergenceError(PitchpointError, RuntimeError):
    """A solver stopped before its residual was small enough; no numbers are returned."""

    exit_code: ClassVar[int] = 3


def unknown_name(name: str, allowed: Iterable[str], *, what: str) -> InputError:
    """Return the error for a name that is not in a list, with the nearest names it has.

    Args:
        name: the name that was asked for.
        allowed: the names that exist.
        what: what the name stands for, with its article: "a lubricant".

    Example:
        >>> str(unknown_name("stel", ["steel", "pom"], what="a material"))
        '"stel" is not a material in the catalogue; did you mean steel?'
    """
    names = sorted(allowed)
    near = difflib.get_close_matches(name, names, n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(near)}?" if near else f"it has {', '.join(names)}"
    message = f'"{name}" is not {what} in the catalogue; {hint}'
    return InputError(message, value=name, allowed=names)
