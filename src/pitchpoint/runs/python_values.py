"""What Python may hand over: values as a case file could hold them, arguments of their kind."""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from pitchpoint.cases.document import MAX_DEPTH
from pitchpoint.cases.study_tables import Study
from pitchpoint.errors import InputError, shorten
from pitchpoint.input.quantities import TOO_LONG, shown

__all__ = ["demand_arguments", "plain_value"]

MOST_VALUES = 200_000
"""Values in one table or list; one list that stands in others again and again has them quickly."""


def plain_value(value: Any, key: str = "") -> Any:
    """A value made of numbers, texts, lists and tables with keys of text alone, whatever it was made of.

    Args:
        value: numbers, texts, arrays, sequences, mappings, None.
        key: at which it stands, for the sentence.

    Raises:
        InputError: anything else, tables that hold themselves or too much, numbers that are none.

    Example:
        >>> import numpy as np
        >>> plain_value({"teeth": np.array([23, 61])})
        {'teeth': [23, 61]}
    """
    try:
        return _Gate().plain(value, 0)
    except InputError as error:
        raise error.at(key=shorten(key) or None) from None


class _Gate:
    """Counts what it lets through."""

    def __init__(self) -> None:
        self.left = MOST_VALUES

    def plain(self, value: Any, depth: int) -> Any:
        """The value with all that it holds, so many levels below the whole."""
        self.left -= 1
        if self.left < 0:
            raise InputError(f"holds more than {MOST_VALUES} values, the most allowed")
        if depth > MAX_DEPTH:
            raise InputError(f"is nested more than {MAX_DEPTH} levels deep, the most allowed")
        if hasattr(value, "tolist"):
            value = _from_array(value)
        elif hasattr(value, "__array__"):  # of xarray
            value = _from_array(np.asarray(value))
        if isinstance(value, Mapping):
            return {_key(name): self.plain(item, depth + 1) for name, item in value.items()}
        if isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray):
            return [self.plain(item, depth + 1) for item in value]
        return _single(value)


def _from_array(value: Any) -> Any:
    """Numbers or texts of an array."""
    if isinstance(value, np.ndarray) and value.size > MOST_VALUES:
        raise InputError(f"holds {value.size} values; allowed are at most {MOST_VALUES}")
    try:
        held = value.tolist()
    except Exception:  # anybody's array
        raise InputError(f"{_typed(value)} was given, which is no array of numbers") from None
    return _typed_out(held) if held is value or isinstance(held, np.generic) else held


def _typed_out(value: Any) -> Any:
    """A number of NumPy for which Python has no type of its own."""
    if isinstance(value, np.floating):
        return float(value)
    raise InputError(f"{_typed(value)} was given; a value is a number, a text, a list or a table")


def _key(name: Any) -> str:
    if isinstance(name, bool) or not isinstance(name, str | int):
        raise InputError(f"{_typed(name)} was given as a key; keys are texts")
    return str(_single(name))


def _single(value: Any) -> Any:
    """A number, a text, a truth value or None."""
    if value is None or isinstance(value, bool | float):
        return value
    if isinstance(value, int):
        if abs(value) >= TOO_LONG:
            raise InputError(f"{shown(value)} was given, which is too large for any key")
        return value
    if isinstance(value, str):
        if not value.isascii() and any("\ud800" <= sign <= "\udfff" for sign in value):
            raise InputError(f"{shown(value)} holds signs that are no letters of any text")
        return value
    raise InputError(f"{_typed(value)} was given; a value is a number, a text, a list or a table")


def _typed(value: Any) -> str:
    return f"a value of the type {type(value).__name__}"


def _whole(least: int) -> Callable[[Any], bool]:
    def fits(value: Any) -> bool:
        is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
        return is_whole and least <= value < TOO_LONG

    return fits


def _is_name(value: Any) -> bool:
    return isinstance(value, str)


def _is_flag(value: Any) -> bool:
    return isinstance(value, bool | np.bool_)


def _are_names(value: Any) -> bool:
    listed = isinstance(value, Sequence) and not isinstance(value, str)
    return listed and all(map(_is_name, value))


def _are_labels(value: Any) -> bool:
    return _are_names(value) and all(name.strip() for name in value)


def _name_or_names(value: Any) -> bool:
    return _is_name(value) or _are_names(value)


def _are_laws(value: Any) -> bool:
    listed = isinstance(value, Sequence) and not isinstance(value, str) and len(value) > 0
    return callable(value) or (listed and all(callable(law) or _is_name(law) for law in value))


def _is_path(value: Any) -> bool:
    return isinstance(value, str | os.PathLike) and "\0" not in os.fsdecode(value)


def _by_key(value: Any) -> bool:
    return isinstance(value, Mapping) and all(map(_is_name, value))


def _is_tolerance(value: Any) -> bool:
    return isinstance(value, str) and value in ("uniform", "normal")


def _are_studies(value: Any) -> bool:
    return _by_key(value) and all(isinstance(study, Study) for study in value.values())


_ARGUMENTS: Mapping[str, tuple[Callable[[Any], bool], str]] = {
    "analyses": (_are_names, 'a list of names of parts, ["operation", "cycle"],'),
    "by": (_name_or_names, 'a key or a list of keys, ["operation.torque"],'),
    "changes": (_by_key, "a dictionary of values by key"),
    "folder": (_is_path, "the name of a folder"),
    "friction": (
        _are_laws,
        "a function of conditions at a contact, or a list of such and of names,",
    ),
    "how": (_is_name, 'the name of a way to lay out a study, "grid",'),
    "key": (_is_name, 'a key, "operation.torque",'),
    "law": (_is_name, "the name of a friction law"),
    "maximise": (_is_name, 'the name of a result, "mean_efficiency",'),
    "minimise": (_is_name, 'the name of a result, "mean_loss",'),
    "n": (_whole(1), "a whole number from 1 on"),
    "names": (_are_labels, 'a list of names, none of them empty, ["sets", "wave"],'),
    "of": (_is_name, 'the name of a figure, "mean_loss",'),
    "only": (_are_names, 'a list of names of variants, ["default"],'),
    "over": (_by_key, "a dictionary of values by key"),
    "overwrite": (_is_flag, "True or False"),
    "path": (_is_path, "the name of a file"),
    "piece": (_whole(1), "a whole number from 1 on"),
    "scheduler": (_is_name, 'the address of a scheduler, "tcp://host:8786",'),
    "seed": (_whole(0), "a whole number from 0 on"),
    "settings": (_by_key, "a dictionary of values by key"),
    "starts": (_whole(0), "a whole number from 1 on"),
    "studies": (_are_studies, "a dictionary of studies by name"),
    "subject_to": (_name_or_names, 'a limit, "root_safety >= 1.5", or a list of such,'),
    "tolerances": (_is_tolerance, '"uniform" or "normal"'),
    "variant": (_is_name, "the name of a variant"),
    "vary": (_by_key, "a dictionary of ranges or lists of values by key"),
    "workers": (_whole(1), "a whole number from 1 on"),
}
"""Which values an argument takes, and what they are."""

_NEEDED = ("key", "of", "path")


def demand_arguments(**given: Any) -> None:
    """InputError for the first argument that is not of its kind; None stands for one that may be left out.

    Args:
        given: by the name of the argument.

    Example:
        >>> demand_arguments(seed=3, variant=None)
        >>> demand_arguments(seed=-1)
        Traceback (most recent call last):
        ...
        pitchpoint.errors.InputError: seed: -1 was given where a whole number from 0 on belongs
    """
    for name, value in given.items():
        fits, words = _ARGUMENTS[name]
        left_out = value is None and name not in _NEEDED
        if not left_out and not fits(value):
            raise InputError(f"{shown(value)} was given where {words} belongs", key=name)
