"""Values of a case file with kind and allowed range, as pydantic types."""

import math
import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from datetime import date, time
from itertools import islice
from numbers import Number
from pathlib import PurePath
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from pitchpoint import units
from pitchpoint.errors import InputError, shorten
from pitchpoint.registry import known_as, listed, nearest

__all__ = ["Pair", "Quantity", "SIValue", "count_of", "for_both", "named", "shown", "text"]


TOO_LONG = 10**40

_SHOWN_DEPTH = 3

LONGEST_TEXT = 2000
"""Longest title or remark [characters]; real ones have some hundred."""


class SIValue(float):
    """A number in SI that was checked before, as sweeps make it."""


@dataclass(frozen=True)
class Quantity:
    """Annotation of a field: what kind of quantity it is and what range is allowed.

    Attributes:
        kind: of `units.kinds()`.
        low, high: allowed range in SI.
        unit: in which the value is shown.
        open_low: True if the lower bound itself is not allowed.
        whole: True for counts.
    """

    kind: str
    low: float
    high: float
    unit: str = "1"
    open_low: bool = False
    whole: bool = False

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """One validator from text or number to SI."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """What editors know of the values."""
        return self.json_schema

    @property
    def json_schema(self) -> JsonSchemaValue:
        """Numbers in their range, or text that begins with one; ranges of those with units in words."""
        text = {"type": "string", "pattern": r"^\s*[+-]?\.?\d"}
        if not units.allows_plain_number(self.kind):
            example = units.example(self.kind).strip('"')
            return {**text, "description": self.told, "examples": [example]}
        number: JsonSchemaValue = {"type": "number"}
        if math.isfinite(self.low):
            number["exclusiveMinimum" if self.open_low else "minimum"] = self.low
        if math.isfinite(self.high):
            number["maximum"] = self.high
        if self.whole:
            number["multipleOf"] = 1
        return {"anyOf": [number, text], "description": self.told}

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        if units.allows_plain_number(self.kind):
            noun = "a whole number" if self.whole else units.noun(self.kind)
            return f"{noun}; {self.allowed}"
        return f"{units.noun(self.kind)}; {self.allowed}; units: {', '.join(units.units_of(self.kind))}"

    def read(self, value: Any) -> float:
        """SI value of text or number; InputError if it is not what is needed."""
        number = self.si(value)
        if isinstance(value, SIValue):
            return number
        if not math.isfinite(number) or self._outside(number):
            meant = self._meant(value)
            raise InputError(f"{shown(value)} is out of range; {self.allowed}{meant}", value=value)
        if self.whole and number != round(number):
            raise InputError(f"{shown(value)} is not a whole number; {self.allowed}", value=value)
        return number

    def _meant(self, value: Any) -> str:
        """What a number in SI, as those of Python are, may mean that is in the range; empty if nothing."""
        si_unit = units.si_unit(self.kind)
        number, _, unit = str(value).partition(" ")
        meant = f"{number.removesuffix('.0')} {self.unit}"
        if self.unit in ("1", si_unit) or unit != si_unit or not self._reads(meant):
            return ""
        return f'; "{meant}" is in it (from Python a plain number is in {si_unit})'

    def _outside(self, number: float) -> bool:
        """Beyond the range, by more than the last bit that converting a bound such as 60 deg leaves."""
        below = number <= self.low if self.open_low else number < self.low
        converted = any(
            number != bound and math.isclose(number, bound, rel_tol=1e-15)
            for bound in (self.low, self.high)
        )
        return (below or number > self.high) and not converted

    @property
    def allowed(self) -> str:
        """The allowed range in words."""
        low, high = (self.show(bound) for bound in (self.low, self.high))
        if not math.isfinite(self.low):
            return "allowed is any finite number"
        if not math.isfinite(self.high):
            return f"allowed is {'above' if self.open_low else 'at least'} {low}"
        return f"allowed is {'above ' if self.open_low else ''}{low} to {high}"

    @property
    def example(self) -> str:
        """A value of the range as it is written, in the unit in which it is shown."""
        plain = units.allows_plain_number(self.kind)
        if self.whole:
            return self.show(_TEETH if self.low < 0.0 else max(self.low, 2.0))
        number = units.example(self.kind).strip('"').partition(" ")[0]
        reaches_millions = plain and _MANY <= self.high < math.inf
        written = (
            "1e6" if reaches_millions else number if self.unit == "1" else f"{number} {self.unit}"
        )
        inside = (
            text for text in (written, *map(self.show, (self.low, self.high))) if self._reads(text)
        )
        text = next(inside, written)
        return text if plain else f'"{text}"'

    def _reads(self, text: str) -> bool:
        """True for a text that the range takes."""
        try:
            self.read(text)
        except InputError:
            return False
        return True

    def show(self, number: float) -> str:
        """Number in the unit in which it is shown."""
        if self.unit == "1":
            return f"{number:.6g}"
        return f"{units.convert(number, self.unit, self.kind):.6g} {self.unit}"

    def si(self, value: Any) -> float:
        """SI value of text or number of this kind, in its range or not."""
        if isinstance(value, SIValue):
            return float(value)
        if isinstance(value, bool) or not isinstance(value, str | int | float):
            raise InputError(f"{shown(value)} was given where one value belongs; {self.allowed}")
        if isinstance(value, int) and abs(value) >= TOO_LONG:
            raise InputError(f"{shown(value)} is too large; {self.allowed}")
        try:
            return units.parse(value, "count" if self.whole else self.kind)
        except InputError as error:
            refusal = self._in_own_unit(error.message)
            raise InputError(f"{refusal}; {self.allowed}", value=value) from None

    def _in_own_unit(self, message: str) -> str:
        """A refusal whose example is in the range, and whose missing unit is the one that is shown.

        A roughness of 0.4 is not one of 0.4 mm.
        """
        usual = units.example("count" if self.whole else self.kind).strip('"')
        message = message.replace(f'like "{usual}"', f'like "{self.example.strip(chr(34))}"')
        if self.unit == "1" or units.allows_plain_number(self.kind):
            return message
        unit = re.escape(usual.partition(" ")[2])
        missing = re.search(rf'write "([^" ]+) {unit}"', message)
        meant = f"{missing[1]} {self.unit}" if missing else ""
        if missing is None:
            return message
        if not self._reads(meant):
            # A number out of the range in the usual unit is not offered in it: 400 is no roughness in mm.
            others = (f"{missing[1]} {other_unit}" for other_unit in units.units_of(self.kind))
            fitting = next(filter(self._reads, others), "")
            if not fitting or self._reads(missing[0].removeprefix("write ").strip('"')):
                return message
            return message.replace(missing[0], f'write "{fitting}"')
        return message.replace(f' or "{meant}"', "").replace(missing[0], f'write "{meant}"')


_TEETH = 20.0
"""Example of a whole number that may be negative, which numbers of teeth alone may."""

_MANY = 1e9
"""Bound from which on a plain number counts turns, not parts of one."""


def count_of(values: Sequence[Any]) -> str:
    """How many values a list has, in words.

    Example:
        >>> count_of([3, 4])
        '2 values'
    """
    return f"{len(values)} value{'s' * (len(values) != 1)}"


@dataclass(frozen=True)
class Pair:
    """Annotation of a field that holds one value for both gears, or a list of two."""

    each: Quantity

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """One validator to a tuple of two SI values."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """What editors know of the values."""
        single = self.each.json_schema
        both = {"type": "array", "items": single, "minItems": 2, "maxItems": 2}
        return {"anyOf": [single, both], "description": self.told}

    @property
    def told(self) -> str:
        """Kind, range and units in words."""
        return f"{self.each.told}; one value for both gears, or a list of two"

    def read(self, value: Any) -> tuple[float, float]:
        """SI values of gear 1 and gear 2."""
        if isinstance(value, list | tuple):
            if len(value) != 2:
                raise InputError(
                    f"{shown(value)} has {count_of(value)}; give one for both gears, or a list "
                    f"of two{_with_points(value)}; {self.each.allowed}"
                )
            return self.each.read(value[0]), self.each.read(value[1])
        try:
            both = self.each.read(value)
        except InputError:
            parts = value.split(",") if isinstance(value, str) else []
            if len(parts) != 2 or not all(map(self.each._reads, parts)):
                raise
            plain = ", ".join(
                part.strip() if units.allows_plain_number(self.each.kind) else f'"{part.strip()}"'
                for part in parts
            )
            raise InputError(
                f"{shown(value)} is one text; for gear 1 and gear 2 write the list [{plain}]; "
                f"{self.each.allowed}"
            ) from None
        return both, both


def _with_points(value: Sequence[Any]) -> str:
    """The list of two that four whole numbers mean whose commas stand before decimals."""
    if len(value) != 4 or not all(type(number) is int for number in value) or min(value[1::2]) < 0:
        return ""
    for_gear, for_mate = (
        f"{shown(number)}.{shown(decimals)}" for number, decimals in (value[:2], value[2:])
    )
    return f" (decimals stand after a point: [{for_gear}, {for_mate}])"


def named(
    registry: Callable[[], Collection[str]], kind: str, at_hand: Collection[str] = ()
) -> Callable[[Any], str]:
    """Validator of a name out of a registry that is looked up when it is needed.

    Args:
        registry: names that there are, as they are looked up.
        kind: what a name stands for.
        at_hand: those of them that are known without a look.
    """

    def read(value: Any) -> str:
        if isinstance(value, str) and value in at_hand:
            return value
        names = registry()
        if not isinstance(value, str):
            number = isinstance(value, int | float) and not isinstance(value, bool)
            if number and kind == "friction law":
                advice = f'write {{ name = "constant", coefficient = {shown(value)} }}'
                raise InputError(f"{shown(value)} is not the name of a {kind}; {advice}")
            raise InputError(
                f"{shown(value)} is not the name of a {kind}; known are {listed(names)}"
            )
        name = known_as(value, names)
        if name is None:
            hint = nearest(value, names)
            raise InputError(f"{shown(value)} is not a known {kind}{hint}")
        return name

    read.known = registry  # type: ignore[attr-defined]  # what the schema for editors lists
    return read


def for_both(read: Callable[[Any], str]) -> Callable[[Any], tuple[str, str]]:
    """Validator of a name for gear 1 and gear 2, from one name or a list of two."""

    def read_both(value: Any) -> tuple[str, str]:
        names = value if isinstance(value, list | tuple) else [value, value]
        if len(names) != 2:
            raise InputError(
                f"{shown(value)} has {count_of(names)}; give one for both gears, or a list of two"
            )
        return read(names[0]), read(names[1])

    return read_both


def text(value: Any) -> str:
    """Text of a case file; InputError if it is none, or would fill the screen."""
    if not isinstance(value, str):
        raise InputError(f"{shown(value)} was given where text belongs")
    if len(value) > LONGEST_TEXT:
        raise InputError(f"has {len(value)} characters; allowed are at most {LONGEST_TEXT}")
    return value


def shown(value: Any, depth: int = 0) -> str:
    """Value as a case file writes it: text quoted, on one line, shortened; what it is where it is none.

    Args:
        value: of a case file, or of a stranger.
        depth: levels of tables and lists around it.
    """
    if depth > _SHOWN_DEPTH:
        return "..."
    if isinstance(value, str):
        return f'"{shorten(value)}"'
    if isinstance(value, dict):
        inner = ", ".join(
            f"{key if isinstance(key, str) else shown(key)} = {shown(item, depth + 1)}"
            for key, item in islice(value.items(), 9)
        )
        return f"the table {shorten(f'{{ {inner} }}')}"
    if isinstance(value, list | tuple):
        inner = ", ".join(shown(item, depth + 1) for item in value[:9])
        return f"the list {shorten(f'[{inner}]')}"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int) and abs(value) >= TOO_LONG:
        return "a whole number of more than 40 digits"
    if value is None or isinstance(value, Number | date | time | PurePath):
        return shorten(str(value))
    return shorten(f"a value of the type {type(value).__name__}")
