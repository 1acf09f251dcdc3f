"""The errors Pitchpoint raises on purpose; each one says what was wrong and where."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, ParamSpec, Self, TypeVar

__all__ = [
    "RUNS_WITH",
    "CollectedInputError",
    "Complaints",
    "ConvergenceError",
    "Cure",
    "InputError",
    "PitchpointError",
    "shorten",
    "visible",
]

LONGEST_PLACE = 240
"""Longest file name or key in a sentence [characters]."""

RUNS_WITH = "; it runs with "
"""What stands between a refusal and changes that mend it, see `InputError.cures`."""

Cure = dict[str, Any]
"""A change that mends an input: values of a case file by dotted key."""

P = ParamSpec("P")
T = TypeVar("T")


class PitchpointError(Exception):
    """Base of every error raised on purpose; `exit_code` is what the command line returns."""

    exit_code: ClassVar[int] = 1

    @property
    def every(self) -> tuple[PitchpointError, ...]:
        """What went wrong, one by one."""
        return (self,)


class InputError(PitchpointError, ValueError):
    """Bad input, told in one sentence: `pair.toml: gears.module: "3 mmm" is not a length; ...`.

    Args:
        message: the sentence without its location.
        file: name of the file the input came from, if any.
        key: dotted name of the entry inside the file, if any.
        value: the offending value, for programs that want to show it themselves.
        allowed: the values that would have been accepted, where they can be listed.

    Attributes:
        cures: changes by dotted key, as a case file has the values; the input is sound after any of them.

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
        self.cures: tuple[Cure, ...] = ()

    def __str__(self) -> str:
        where = (shorten(part, LONGEST_PLACE) for part in (self.file, self.key) if part)
        return ": ".join((*where, self.message))

    def __copy__(self) -> Self:
        # Packages that pickle tracebacks (tblib, for dask) tell `copy` to share what an exception holds.
        made = self.__class__.__new__(self.__class__, *self.args)
        made.__dict__.update(self.__dict__)
        return made

    def at(self, *, file: str | None = None, key: str | None = None) -> Self:
        """Return a copy with the location filled in; what is not given stays as it was.

        Cures move with the key into the table that it is told to be in.
        """
        located = copy.copy(self)
        if key and self.key and key.endswith(self.key):
            table = key.removesuffix(self.key)
            located.cures = tuple(
                {f"{table}{name}": cure[name] for name in cure} for cure in self.cures
            )
        located.file = file if file is not None else self.file
        located.key = key if key is not None else self.key
        return located

    def followed_by(self, clause: str) -> Self:
        """Return a copy whose sentence ends with a further clause; the same where that is empty."""
        longer = copy.copy(self)
        if clause and self.message.endswith("?"):
            longer.message = f"{self.message} {clause[0].upper()}{clause[1:]}"
        elif clause:
            longer.message = f"{self.message}; {clause}"
        return longer


class CollectedInputError(InputError):
    """Several things wrong with one input, each told in one sentence on a line of its own.

    Args:
        errors: at least one, the first one first; file, key, value and what is allowed are those of it.

    Example:
        >>> from pitchpoint.errors import InputError
        >>> wrong = CollectedInputError([InputError("is missing", key=key) for key in ("a", "b")])
        >>> print(wrong)
        a: is missing
        b: is missing
    """

    def __init__(self, errors: Sequence[InputError]) -> None:
        first_error = errors[0]
        super().__init__(
            first_error.message,
            file=first_error.file,
            key=first_error.key,
            value=first_error.value,
            allowed=first_error.allowed,
        )
        self.errors = tuple(errors)

    @property
    def every(self) -> tuple[PitchpointError, ...]:
        """What is wrong, one by one."""
        return self.errors

    def __str__(self) -> str:
        return "\n".join(map(str, self.errors))

    def at(self, *, file: str | None = None, key: str | None = None) -> Self:
        """Return a copy with the location filled in for each of them."""
        return type(self)([error.at(file=file, key=key) for error in self.errors])

    def __reduce__(self) -> tuple[type[Self], tuple[tuple[InputError, ...]]]:
        return type(self), (self.errors,)


class Complaints:
    """What is wrong with one input, gathered: things that are wrong by themselves are told together.

    What rests on something that is wrong is not tried; so nothing is told that only follows from it. One
    thing about a key is told, or several about different values at it.

    Args:
        file: that errors name which name none.

    Example:
        >>> from pitchpoint.errors import Complaints, InputError
        >>> def refuse(key):
        ...     raise InputError("is missing", key=key)
        >>> wrong = Complaints("pair.toml")
        >>> wrong.tried(refuse, "a"), wrong.under("gears").tried(refuse, "b"), wrong.tried(len, "sound")
        (None, None, 5)
        >>> print(wrong.error)
        pair.toml: a: is missing
        pair.toml: gears.b: is missing
    """

    def __init__(self, file: str | None = None) -> None:
        self._file = file
        self._table = ""
        self._told: dict[tuple[str, str], InputError] = {}

    def __bool__(self) -> bool:
        """True if anything is wrong."""
        return bool(self._told)

    def under(self, table: str) -> Complaints:
        """The same complaints, those made through it with keys inside a table."""
        inside = Complaints(self._file)
        inside._table, inside._told = table, self._told
        return inside

    def of(self, table: str) -> bool:
        """True if anything is wrong with a table or in it."""
        keys = [error.key or "" for error in self._told.values()]
        return any(key == table or key.startswith(f"{table}.") for key in keys)

    def tried(self, make: Callable[P, T], *given: P.args, **named: P.kwargs) -> T | None:
        """What a function makes; None where it raises an InputError, which is kept."""
        try:
            return make(*given, **named)
        except InputError as error:
            self.add(error)
            return None

    def add(self, error: InputError) -> None:
        """Keep an error, each one of several."""
        for refusal in error.errors if isinstance(error, CollectedInputError) else (error,):
            key = ".".join(filter(None, (self._table, refusal.key))) or None
            located = refusal.at(file=refusal.file or self._file, key=key)
            self._told.setdefault((key or refusal.message, str(refusal.value)), located)

    @property
    def error(self) -> InputError:
        """What is wrong, at least one thing, as one error."""
        every = [*self._told.values()]
        return every[0] if len(every) == 1 else CollectedInputError(every)

    def demand_none(self) -> None:
        """InputError if anything is wrong."""
        if self:
            raise self.error


class ConvergenceError(PitchpointError, RuntimeError):
    """A solver stopped before its residual was small enough; no numbers are returned."""

    exit_code: ClassVar[int] = 3


def visible(text: str) -> str:
    r"""Return text with every character written out that could steer a terminal.

    Args:
        text: from outside: a title, a remark, a key, the name of a file.

    Example:
        >>> visible("title" + chr(27) + "[2J")
        'title\\x1b[2J'
    """
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in text)


def shorten(text: str, most: int = 60) -> str:
    """Return visible text of at most so many characters."""
    readable = visible(text[: most + 1])
    return readable if len(readable) <= most else f"{readable[: most - 3]}..."
