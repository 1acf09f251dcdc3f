"""Named sets of losses: places with constants as data, scaled to the gears by stated rules."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from pitchpoint.cases.document import Provenance
from pitchpoint.errors import InputError
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.input.quantities import SIValue, named
from pitchpoint.registry import Registry

__all__ = [
    "NOT_THERE",
    "SET",
    "SET_TOLD",
    "LossSet",
    "expanded",
    "loss_sets",
    "marks_of",
    "named_set",
    "set_sources",
]

SET = "set"
"""Key of [losses] that names a set, in place of a table of that name."""

SET_TOLD = (
    "Named set of losses, scaled to the gears; what is given beside it stands before its own."
)
"""What it is, as the tables say it of their keys."""


NOT_THERE = "none"
"""What a case says in place of the table of a place that its set has and its drive has not."""


@dataclass(frozen=True)
class Term:
    """A constant of a set, times a scale of the gears where it names one.

    Attributes:
        value: in SI.
        times: name of the scale, see `GearsTable.loss_scales`; empty for a number of its own.
        mark: how it was come by.
    """

    value: float
    times: str
    mark: Provenance

    @property
    def rule(self) -> str:
        """The constant, how it scales, how it was come by."""
        scale = f" times the {self.times}" if self.times else ""
        return f"{self.value:g}{scale}, {self.mark.status} ({self.mark.note})"


@dataclass(frozen=True)
class LossSet:
    """Losses of one sort of drive.

    Attributes:
        name, title: by which it is picked, and what it is.
        note: caution for the user.
        fitted: temperatures of the oil between which the data lie that it was fitted to [K].
        places: by name; of each the values that are names, and those that are sums of terms.
    """

    name: str
    title: str
    note: str
    fitted: tuple[float, float]
    places: Mapping[str, Mapping[str, Any]]

    @property
    def sources(self) -> tuple[str, ...]:
        """Keys of the bibliography."""
        every = (term.mark.where for place in self.places.values() for term in _terms(place))
        return tuple(dict.fromkeys(filter(None, every)))

    def of(self, gears: GearsTable) -> dict[str, dict[str, Any]]:
        """Tables of the losses for some gears.

        Raises:
            InputError: the gears do not have what the set is scaled by.
        """
        scales = gears.loss_scales
        factors = [term.times for place in self.places.values() for term in _terms(place)]
        if missing := [
            *dict.fromkeys(factor for factor in factors if factor and factor not in scales)
        ]:
            message = (
                f"'{self.name}' scales with {' and '.join(missing)}, which these gears do not have"
            )
            raise InputError(f"{message}; give the losses by value", key=SET)
        return {
            name: {key: _scaled(value, scales) for key, value in place.items()}
            for name, place in self.places.items()
        }

    @property
    def marks(self) -> dict[str, Provenance]:
        """How the values were come by, by place and key with a dot between."""
        return {
            f"{name}.{key}": _mark(self.name, value)
            for name, place in self.places.items()
            for key, value in place.items()
        }


@cache
def loss_sets() -> Registry[LossSet]:
    """Sets of losses that come with the package."""
    text = resources.files(__package__).joinpath("loss_sets.toml").read_text(encoding="utf-8")
    tables = tomllib.loads(text)
    for table in tables.values():
        like = tables.get(table.get("like", ""), {"places": {}})
        table |= {**like, **table, "places": {**like["places"], **table["places"]}}
    return Registry("set of losses", *(_set(name, table) for name, table in tables.items()))


def named_set(losses: Any) -> str:
    """Name of the set that a table of losses asks for; empty without one."""
    name = losses.get(SET) if isinstance(losses, dict) else None
    if name is None or isinstance(name, dict):
        return ""
    try:
        return named(lambda: [*loss_sets()], "set of losses")(name)
    except InputError as error:
        raise error.at(key=SET) from None


def expanded(losses: Any, gears: GearsTable | None) -> Any:
    """Tables of losses with those of the set that they name; values of one's own stay, "none" leaves one out.

    Args:
        losses: as a case file has them.
        gears: they belong to; None where the gears are wrong, which is told first.
    """
    name = named_set(losses)
    if not name:
        return losses
    stated = {key: table for key, table in losses.items() if key != SET}
    places = {} if gears is None else loss_sets()[name].of(gears)
    return {
        place: {**places.get(place, {}), **table} if isinstance(table, dict) else table
        for place, table in {**places, **stated}.items()
        if not (place in places and table == NOT_THERE)
    }


def marks_of(losses: Any) -> dict[str, Provenance]:
    """How the values of the set that a table of losses names were come by, see `LossSet.marks`."""
    name = named_set(losses)
    return loss_sets()[name].marks if name else {}


def set_sources(losses: Any) -> tuple[str, ...]:
    """Keys of the bibliography behind the set that a table of losses names."""
    name = named_set(losses)
    return loss_sets()[name].sources if name else ()


def _set(name: str, entry: Mapping[str, Any]) -> LossSet:
    places = {
        place: {key: _read(value) for key, value in table.items()}
        for place, table in entry["places"].items()
    }
    low, high = entry["fitted"]
    return LossSet(name, entry["title"], entry["note"], (low, high), places)


def _read(value: Any) -> Any:
    """A name or names as they are, a number or a sum of them as terms."""
    several = value if isinstance(value, list) else [value]
    if not isinstance(several[0], dict):
        return value
    return tuple(
        Term(
            term["value"],
            term.get("times", ""),
            Provenance(term["status"], term.get("source", ""), term["note"]),
        )
        for term in several
    )


def _terms(place: Mapping[str, Any]) -> list[Term]:
    return [term for value in place.values() if isinstance(value, tuple) for term in value]


def _scaled(value: Any, scales: Mapping[str, float]) -> Any:
    if not isinstance(value, tuple):
        return value
    return SIValue(sum(term.value * scales.get(term.times, 1.0) for term in value))


def _mark(name: str, value: Any) -> Provenance:
    """Mark of a value of a set: fitted where one of its terms is."""
    origin = f"of the set {name}"
    if not isinstance(value, tuple):
        return Provenance("default", note=origin)
    least_sure = min(value, key=lambda term: term.mark.status != "fitted")
    note = f"{origin}: {' + '.join(term.rule for term in value)}"
    return Provenance(least_sure.mark.status, least_sure.mark.where, note)
