"""One line for a value of many: its class and what it holds, nested values by their names."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np

__all__ = ["brief"]

FEW = 4
"""Numbers of an array that are shown; of more its shape."""

LONGEST = 900
"""Longest line [characters]."""


def brief(thing: Any) -> str:
    """Class and fields of a dataclass, for its `__repr__`.

    Example:
        >>> from dataclasses import make_dataclass
        >>> brief(make_dataclass("Gear", ["teeth"])(23))
        'Gear(teeth=23)'
    """
    each = (
        f"{one.name}={_word(getattr(thing, one.name))}"
        for one in fields(thing)
        if getattr(thing, one.name) is not None
    )
    text = f"{type(thing).__name__}({', '.join(each)})"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 4]}...)"


def _word(value: Any) -> str:
    """A plain value, few numbers, a shape, or the name of what is nested."""
    if isinstance(value, bool | int | str):
        return repr(value)
    if isinstance(value, tuple | list):
        return f"({', '.join(map(_word, value))})"
    if isinstance(value, Mapping):
        return f"{{{', '.join(map(str, value))}}}"
    if isinstance(value, float) or hasattr(value, "dtype"):
        return _numbers(value)
    name = getattr(value, "name", None) or getattr(value, "__name__", None)
    return name if isinstance(name, str) else type(value).__name__


def _numbers(value: Any) -> str:
    """Few numbers with four digits, else type and shape, as those of what JAX traces are not there."""
    try:
        held = np.asarray(value)
    except Exception:  # traced
        return f"{value.dtype}{list(value.shape)}"
    if held.size > FEW or held.dtype.kind not in "biuf":
        return f"{held.dtype}{list(held.shape)}"
    return np.array2string(held, precision=4, separator=", ", floatmode="maxprec").replace("\n", "")
