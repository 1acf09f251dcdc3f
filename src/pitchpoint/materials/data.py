"""Files of the catalogue, with a status for each value."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any, Literal, get_args

from pitchpoint.errors import InputError

__all__ = [
    "Datum",
    "Status",
    "base_names",
    "check_positive",
    "oil_names",
    "read_data",
    "read_datum",
    "solid_names",
]

Status = Literal["printed", "derived", "digitised", "assumed", "fitted", "corrected", "given"]


@dataclass(frozen=True, kw_only=True)
class Datum:
    """One value [SI], how it was come by, and the key of its reference."""

    value: float
    status: Status = "given"
    source: str = ""
    note: str = ""


@cache
def read_data(name: str) -> dict[str, Any]:
    """One file of the catalogue folder, read once; what it gives is not to be changed."""
    text = resources.files(__package__).joinpath("catalogue", name).read_text(encoding="utf-8")
    return tomllib.loads(text)


def read_datum(entry: Mapping[str, Any], *, scale: float = 1.0) -> Datum:
    """Build a value from its table in a data file, times `scale` into SI."""
    if entry["status"] not in get_args(Status):
        raise InputError(f'"{entry["status"]}" is not a status', allowed=get_args(Status))
    return Datum(
        value=float(entry["value"]) * scale,
        status=entry["status"],
        source=entry.get("source", ""),
        note=entry.get("note", ""),
    )


def check_positive(name: str, values: Iterable[tuple[str, Datum]]) -> None:
    """Refuse a value that is not a finite positive number."""
    for key, datum in values:
        if not (math.isfinite(datum.value) and datum.value > 0.0):
            raise InputError(f"{datum.value} is not a positive number", key=f"{name}.{key}")


def oil_names() -> list[str]:
    """Names of the oils of the catalogue."""
    return [*read_data("lubricants.toml")["oil"]]


def base_names() -> list[str]:
    """Names of the classes of base oils."""
    return [*read_data("lubricants.toml")["base"]]


def solid_names() -> list[str]:
    """Names of the materials of the catalogue."""
    return [*read_data("solids.toml")]
