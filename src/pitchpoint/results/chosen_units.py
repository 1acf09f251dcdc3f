"""Units that a reader chose by kind of quantity, in place of those in which results are usually shown.

A choice says units by kind, `{"angle": "arcmin", "torsional stiffness": "N m/arcmin"}`. Angles, lengths
and times have two sizes: whole ones (a turn in degrees, a centre distance in mm) and small ones (a
kinematic error in arcsec, a film in um). A unit is taken by quantities of its size, "angle=arcmin" by
small angles, "angle=rad" by whole ones; the kinds "small angle", "small length" and "small time" give
those another unit of any size. Results themselves are SI, whatever is chosen.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from types import MappingProxyType
from typing import Annotated, Any, Final

from pydantic import BeforeValidator, Field

from pitchpoint import units
from pitchpoint.errors import InputError
from pitchpoint.input.quantities import shown
from pitchpoint.input.tables import Table
from pitchpoint.registry import known_as, nearest

__all__ = ["Choice", "Output", "UnitsByKind", "choosable", "shown_in", "unit_choice", "unit_in_use"]

Choice = Mapping[str, str]
"""Units by kind of quantity."""

UnitsByKind = Choice | str
"""A choice as a caller may write it, see `unit_choice`."""

_SMALL: Final[Mapping[str, tuple[str, ...]]] = {
    "angle": ("mrad", "urad", "arcmin", "arcsec"),
    "length": ("um", "nm"),
    "time": ("ms", "us"),
}
"""Units of small quantities, of kinds that have two sizes."""

_NONE: Final[Choice] = MappingProxyType({})
_CHOSEN: ContextVar[Choice] = ContextVar("units chosen by size of a kind", default=_NONE)


def choosable() -> list[str]:
    """Kinds of quantities whose unit can be chosen.

    Example:
        >>> "torque" in choosable(), "small angle" in choosable(), "count" in choosable()
        (True, True, False)
    """
    return [
        *(kind for kind in units.kinds() if not units.allows_plain_number(kind)),
        *map(_small, _SMALL),
    ]


def unit_choice(given: Any) -> dict[str, str]:
    """A choice as it was given, each kind and unit in the spelling of the lists.

    Args:
        given: units by kind, or text, "angle=arcmin, torque=N cm".

    Raises:
        InputError: there is no such kind, it has no such unit, or it was given twice.

    Example:
        >>> unit_choice("Angle=arcmin, torsional_stiffness=N*m/arcmin")
        {'angle': 'arcmin', 'torsional stiffness': 'N m/arcmin'}
    """
    pairs = [*given.items()] if isinstance(given, Mapping) else _pairs(given)
    units_by_kind: dict[str, str] = {}
    for name, unit in pairs:
        kind = known_as(str(name), choosable())
        if kind is None:
            ending = [
                kind_listed for kind_listed in choosable() if kind_listed.endswith(f" {name}")
            ]
            near = nearest(str(name), ending or choosable())
            raise InputError(f"{shown(name)} is no kind of quantity with units{near}", value=name)
        if kind in units_by_kind:
            raise InputError(f"the unit of {kind} was given twice", value=unit)
        if not isinstance(unit, str):
            raise InputError(f"{shown(unit)} was given where a unit of {kind} belongs", value=unit)
        units_by_kind[kind] = units.spelled(unit, _whole(kind))
    return units_by_kind


@contextmanager
def shown_in(choice: Choice) -> Iterator[None]:
    """Within it tables, figures and exports of this thread show quantities in the units of a choice."""
    before = _CHOSEN.set(_by_size(choice))
    try:
        yield
    finally:
        _CHOSEN.reset(before)


def unit_in_use(kind: str, usual: str) -> str:
    """Unit in which quantities of a kind are shown: the chosen one, else that which is usual for them.

    Example:
        >>> from pitchpoint.results.chosen_units import shown_in
        >>> with shown_in({"angle": "arcmin"}):
        ...     unit_in_use("angle", "arcsec"), unit_in_use("angle", "deg")
        ('arcmin', 'deg')
    """
    return _CHOSEN.get().get(_sized(kind, usual), usual)


def _pairs(text: Any) -> list[tuple[str, str]]:
    """Kinds and units of a text."""
    if not isinstance(text, str):
        raise InputError(f"{shown(text)} was given where units by kind of quantity belong")
    pairs = [part.partition("=") for part in text.split(",")]
    for kind, equals, unit in pairs:
        if not (equals and kind.strip() and unit.strip()):
            refusal = "is not KIND=UNIT, for example angle=arcmin"
            raise InputError(f"{shown(text)} {refusal}", value=text)
    return [(kind.strip(), unit.strip()) for kind, _, unit in pairs]


def _by_size(choice: Choice) -> Choice:
    """Units by kind and size; a small kind named as such goes before one whose unit is small."""
    by_unit = {_sized(kind, unit): unit for kind, unit in choice.items() if kind in units.kinds()}
    return MappingProxyType({**by_unit, **{k: u for k, u in choice.items() if k != _whole(k)}})


def _sized(kind: str, unit: str) -> str:
    """The kind of a quantity with its size, which its unit tells."""
    return _small(kind) if unit in _SMALL.get(kind, ()) else kind


def _small(kind: str) -> str:
    return f"small {kind}"


def _whole(kind: str) -> str:
    """The kind without its size."""
    return kind.removeprefix(_small(""))


class Output(Table):
    """How results are shown; numbers that are computed and kept are SI whatever it says.

    `units` are those of tables, figures and exports by kind of quantity: angle, torque, torsional_stiffness,
    rotational_speed and so on. A unit of small angles, lengths or times (arcmin, um, ms) is for these; the
    kinds `small_angle`, `small_length` and `small_time` give them a unit of any size.
    """

    units: Annotated[dict[str, str], BeforeValidator(unit_choice)] = Field(
        default_factory=dict, examples=[{"angle": "arcmin", "torsional stiffness": "N m/arcmin"}]
    )
    """Unit by kind of quantity; usual ones unless given."""
