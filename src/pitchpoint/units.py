"""Numbers with units, at the door only: text such as "3 mm" in, SI floats inside, and back.

The number and the unit are split here, and the unit must be on the list of its quantity kind.
Only our own expression for a listed unit reaches pint, never the text a user wrote. Factors are
asked of pint once for all units and kept in the user's cache.

Spelling: `*`, `.` and `·` between units mean a product and may be written as a space ("N m",
"N*m"), a power is written "mm2", "mm^2" or "mm²", and "µm", "°C" and "°" are understood.
Revolutions and radians are never guessed: "Hz" and "1/s" are frequencies, a rotational speed is
given in rpm, rev/s, rad/s or deg/s.
"""

from __future__ import annotations

import difflib
import hashlib
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any, NoReturn, overload

from pitchpoint.core.kept import base_folder, prepared_folder, read_kept, write_kept
from pitchpoint.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    import pint
    from numpy.typing import NDArray

__all__ = [
    "UnitError",
    "allows_plain_number",
    "comma_readings",
    "convert",
    "degrees_celsius",
    "example",
    "hardness_scale",
    "is_quotient",
    "kind_of",
    "kinds",
    "noun",
    "parse",
    "si_unit",
    "spelled",
    "units_of",
]

MAX_LENGTH = 64
"""Longest text that is read as a quantity [characters]."""


class UnitError(InputError):
    """The text is not a quantity of the kind that is needed."""


@dataclass(frozen=True)
class _Kind:
    """One quantity kind: its noun, an example to show, pint's name for each unit, a remark on others."""

    noun: str
    example: str
    units: Mapping[str, str]
    remark: str = ""

    @property
    def si(self) -> str:
        return next(iter(self.units))


# The first unit of each kind is its SI unit.
_KINDS: dict[str, _Kind] = {
    "length": _Kind(
        "a length",
        "3 mm",
        {
            "m": "meter",
            "mm": "millimeter",
            "um": "micrometer",
            "nm": "nanometer",
            "cm": "centimeter",
            "in": "inch",
        },
    ),
    "angle": _Kind(
        "an angle",
        "20 deg",
        {
            "rad": "radian",
            "deg": "degree",
            "mrad": "milliradian",
            "urad": "microradian",
            "arcmin": "arcminute",
            "arcsec": "arcsecond",
            "rev": "turn",
        },
    ),
    "rotational speed": _Kind(
        "a rotational speed",
        "1500 rpm",
        {
            "rad/s": "radian/second",
            "rpm": "turn/minute",
            "rev/min": "turn/minute",
            "1/min": "turn/minute",
            "rev/s": "turn/second",
            "rps": "turn/second",
            "deg/s": "degree/second",
        },
    ),
    "torque": _Kind(
        "a torque",
        "159 N m",
        {
            "N m": "newton*meter",
            "Nm": "newton*meter",
            "kN m": "kilonewton*meter",
            "kNm": "kilonewton*meter",
            "mN m": "millinewton*meter",
            "mNm": "millinewton*meter",
            "N mm": "newton*millimeter",
            "Nmm": "newton*millimeter",
            "N cm": "newton*centimeter",
            "Ncm": "newton*centimeter",
            "kgf m": "force_kilogram*meter",
            "kgf cm": "force_kilogram*centimeter",
            "lbf in": "force_pound*inch",
            "in lbf": "force_pound*inch",
            "lbf ft": "force_pound*foot",
            "ft lbf": "force_pound*foot",
            "ozf in": "force_ounce*inch",
        },
    ),
    "temperature": _Kind(
        "a temperature", "55 degC", {"K": "kelvin", "degC": "degC", "degF": "degF"}
    ),
    "temperature difference": _Kind(
        "a temperature difference",
        "10 K",
        {"K": "kelvin", "degC": "delta_degC", "degF": "delta_degF"},
    ),
    "pressure": _Kind(
        "a pressure",
        "206 GPa",
        {
            "Pa": "pascal",
            "kPa": "kilopascal",
            "MPa": "megapascal",
            "GPa": "gigapascal",
            "N/mm2": "newton/millimeter**2",
            "bar": "bar",
            "psi": "force_pound/inch**2",
            "ksi": "kip/inch**2",
        },
    ),
    "hardness": _Kind(
        "a hardness",
        "200 HV",
        {
            "Pa": "pascal",
            "MPa": "megapascal",
            "GPa": "gigapascal",
            "N/mm2": "newton/millimeter**2",
            "HV": "force_kilogram/millimeter**2",
            "HB": "kilogram_force/millimeter**2",  # same as HV by another name: both scales are shown
            "HBW": "kilogram_force/millimeter**2",
            "HBS": "kilogram_force/millimeter**2",
        },
        "; numbers of Rockwell and other scales are not converted",
    ),
    "dynamic viscosity": _Kind(
        "a dynamic viscosity",
        "10 mPa s",
        {"Pa s": "pascal*second", "mPa s": "millipascal*second", "cP": "centipoise"},
    ),
    "kinematic viscosity": _Kind(
        "a kinematic viscosity",
        "98.8 mm2/s",
        {
            "m2/s": "meter**2/second",
            "mm2/s": "millimeter**2/second",
            "cSt": "centistokes",
        },
    ),
    "density": _Kind(
        "a density",
        "859 kg/m3",
        {
            "kg/m3": "kilogram/meter**3",
            "kg/dm3": "kilogram/decimeter**3",
            "g/cm3": "gram/centimeter**3",
            "g/ml": "gram/milliliter",
        },
    ),
    "temperature coefficient": _Kind(
        "a relative change with temperature", "0.001 1/K", {"1/K": "1/kelvin"}
    ),
    "density slope": _Kind(
        "a fall of density with temperature",
        "0.5 kg/m3/K",
        {
            "kg/m3/K": "kilogram/meter**3/kelvin",
            "kg/(m3 K)": "kilogram/meter**3/kelvin",
            "g/cm3/K": "gram/centimeter**3/kelvin",
        },
    ),
    "thermal conductivity": _Kind(
        "a thermal conductivity",
        "0.14 W/m/K",
        {
            "W/m/K": "watt/meter/kelvin",
            "W/(m K)": "watt/meter/kelvin",
            "mW/m/K": "milliwatt/meter/kelvin",
        },
    ),
    "specific heat": _Kind(
        "a specific heat",
        "460 J/kg/K",
        {
            "J/kg/K": "joule/kilogram/kelvin",
            "J/(kg K)": "joule/kilogram/kelvin",
            "kJ/kg/K": "kilojoule/kilogram/kelvin",
        },
    ),
    "pressure-viscosity coefficient": _Kind(
        "a pressure-viscosity coefficient",
        "22 1/GPa",
        {
            "1/Pa": "1/pascal",
            "1/MPa": "1/megapascal",
            "1/GPa": "1/gigapascal",
            "Pa-1": "1/pascal",
            "GPa-1": "1/gigapascal",
            "m2/N": "meter**2/newton",
            "mm2/N": "millimeter**2/newton",
        },
    ),
    "mass": _Kind("a mass", "1.2 kg", {"kg": "kilogram", "g": "gram", "lb": "pound"}),
    "force": _Kind(
        "a force",
        "500 N",
        {
            "N": "newton",
            "kN": "kilonewton",
            "mN": "millinewton",
            "kgf": "force_kilogram",
            "lbf": "force_pound",
        },
    ),
    "stiffness": _Kind(
        "a stiffness",
        "10 N/um",
        {
            "N/m": "newton/meter",
            "N/um": "newton/micrometer",
            "N/mm": "newton/millimeter",
            "kN/mm": "kilonewton/millimeter",
        },
    ),
    "viscous damping": _Kind(
        "a viscous damping",
        "1000 N s/m",
        {
            "N s/m": "newton*second/meter",
            "kN s/m": "kilonewton*second/meter",
            "N s/mm": "newton*second/millimeter",
        },
    ),
    "torsional stiffness": _Kind(
        "a torsional stiffness",
        "10 kN m/rad",
        {
            "N m/rad": "newton*meter/radian",
            "kN m/rad": "kilonewton*meter/radian",
            "N m/arcmin": "newton*meter/arcminute",
            "N m/mrad": "newton*meter/milliradian",
            "N m/deg": "newton*meter/degree",
        },
    ),
    "moment of inertia": _Kind(
        "a moment of inertia",
        "2 kg cm2",
        {
            "kg m2": "kilogram*meter**2",
            "kg cm2": "kilogram*centimeter**2",
            "kg mm2": "kilogram*millimeter**2",
            "g cm2": "gram*centimeter**2",
        },
    ),
    "area": _Kind(
        "an area",
        "0.05 m2",
        {"m2": "meter**2", "cm2": "centimeter**2", "mm2": "millimeter**2"},
    ),
    "thermal resistance": _Kind(
        "a thermal resistance", "0.06 K m2/W", {"K m2/W": "kelvin*meter**2/watt"}
    ),
    "resistance to heat": _Kind("a resistance to heat", "1.5 K/W", {"K/W": "kelvin/watt"}),
    "heat capacity": _Kind(
        "a heat capacity", "400 J/K", {"J/K": "joule/kelvin", "kJ/K": "kilojoule/kelvin"}
    ),
    "torque constant": _Kind(
        "a torque constant",
        "0.1 N m/A",
        {"N m/A": "newton*meter/ampere", "mN m/A": "millinewton*meter/ampere"},
    ),
    "electrical resistance": _Kind(
        "an electrical resistance", "0.5 ohm", {"ohm": "ohm", "mohm": "milliohm"}
    ),
    "line load": _Kind(
        "a load per length",
        "150 N/mm",
        {
            "N/m": "newton/meter",
            "N/mm": "newton/millimeter",
            "kN/m": "kilonewton/meter",
            "lbf/in": "force_pound/inch",
        },
    ),
    "velocity": _Kind(
        "a velocity",
        "3 m/s",
        {
            "m/s": "meter/second",
            "mm/s": "millimeter/second",
            "km/h": "kilometer/hour",
            "ft/min": "foot/minute",
        },
    ),
    "power": _Kind(
        "a power", "25 kW", {"W": "watt", "kW": "kilowatt", "mW": "milliwatt", "hp": "horsepower"}
    ),
    "energy": _Kind(
        "an energy",
        "25 J",
        {"J": "joule", "mJ": "millijoule", "kJ": "kilojoule", "Wh": "watt*hour"},
    ),
    "molar energy": _Kind(
        "an energy per mole",
        "49 kJ/mol",
        {"J/mol": "joule/mole", "kJ/mol": "kilojoule/mole"},
    ),
    "time": _Kind(
        "a time",
        "3 s",
        {
            "s": "second",
            "ms": "millisecond",
            "us": "microsecond",
            "min": "minute",
            "h": "hour",
        },
    ),
    "volume": _Kind(
        "a volume",
        "1 mm3",
        {"m3": "meter**3", "mm3": "millimeter**3", "cm3": "centimeter**3"},
    ),
    "frequency": _Kind(
        "a frequency", "50 Hz", {"Hz": "1/second", "kHz": "kilohertz", "1/s": "1/second"}
    ),
    "specific wear rate": _Kind(
        "a specific wear rate",
        "1e-6 mm3/(N m)",
        {
            "1/Pa": "1/pascal",
            "m3/(N m)": "meter**3/(newton*meter)",
            "mm3/(N m)": "millimeter**3/(newton*meter)",
            "mm3/(Nm)": "millimeter**3/(newton*meter)",
            "mm3/N/m": "millimeter**3/(newton*meter)",
            "mm3/Nm": "millimeter**3/(newton*meter)",
            "m2/N": "meter**2/newton",
            "mm2/N": "millimeter**2/newton",
        },
    ),
    "dimensionless": _Kind(
        "a plain number", "0.3", {"": "dimensionless", "1": "dimensionless", "%": "percent"}
    ),
    "count": _Kind("a whole number", "20", {"": "dimensionless"}),
}

_SCALES = {"HV": "Vickers", "HB": "Brinell", "HBW": "Brinell", "HBS": "Brinell"}

_NUMBER = re.compile(
    r"([+-]?(?:\d{1,40}(?:\.\d{0,40})?|\.\d{1,40})(?:[eE][+-]?\d{1,3})?)(.*)", re.ASCII
)
_SIGNS = str.maketrans(
    {"µ": "u", "μ": "u", "²": "2", "³": "3", "·": " ", "⋅": " ", "°": "deg"} | {"⁻": "-", "¹": "1"}
)
_PRODUCT = re.compile(r"(?<!\*)\*(?!\*)|(?<=[A-Za-z0-9])\.(?=[A-Za-z])")
_POWER = re.compile(r"(?<=[A-Za-z])\^(?=-?\d)")

# Units that exist, listed or not: a neighbour in the list may be a thousand times as large.
_FORCE, _LENGTH = "N|gf|lbf|ozf", "m|in|ft"
_WORD = (
    rf"(?:da|[TGMkhdcmunp])?(?:(?:{_FORCE})[kdcmunp]?(?:{_LENGTH})|{_FORCE}|{_LENGTH}|kp|tf|g|lb|oz|t|l|L"
    r"|Pa|bar|psi|ksi|kip|atm|s|min|h|d|Hz|rpm|rps|rev|turn|rad|grad|gon|deg[CFR]?|arcmin|arcsec|K|W|Wh|J|hp|P|St|mol|A|V|ohm)"
)
_OTHERWISE = {
    "degC": ("c", "celsius", "deg c", "° c"),
    "degF": ("f", "fahrenheit", "deg f"),
    "h": ("hour", "hours", "hr", "hrs", "std"),
    "min": ("minute", "minutes"),
    "s": ("second", "seconds", "sec"),
    "rpm": ("min-1", "r/min", "u/min", "tr/min"),
    "um": ("micron", "microns", "u", "mu"),
    "in": ('"', "″", "inch", "inches", "in."),
    "N": ("newton", "newtons"),
    "N m": ("n-m", "newton meter", "newton metre"),
    "lbf in": ("lb in", "lb-in"),
    "in lbf": ("in lb", "in-lb", "in-lbf", "inlb"),
    "lbf ft": ("lb ft", "ft lb", "ft-lb", "lb-ft", "ft-lbf", "ftlb"),
}
"""Spellings of others, in lower case, by the unit of the lists that they mean."""
_MARKS = "“”„‟‘’‚«»″\"'"
_SOUND = re.compile(rf"(?:1/)?\(?{_WORD}-?[1-9]?(?:[ /(]+{_WORD}-?[1-9]?)*\)?", re.ASCII)


def kinds() -> tuple[str, ...]:
    """Return the names of the quantity kinds."""
    return tuple(_KINDS)


def units_of(kind: str) -> tuple[str, ...]:
    """Return the unit spellings that a kind accepts, its SI unit first."""
    return tuple(unit for unit in _kind(kind).units if unit)


def si_unit(kind: str) -> str:
    """Return the SI unit of a kind; empty for plain numbers.

    Example:
        >>> si_unit("torque")
        'N m'
    """
    return _kind(kind).si


def noun(kind: str) -> str:
    """Return what a quantity of a kind is called, with its article.

    Example:
        >>> noun("torque")
        'a torque'
    """
    return _kind(kind).noun


def allows_plain_number(kind: str) -> bool:
    """Return True for a kind whose numbers may stand without a unit.

    Example:
        >>> allows_plain_number("dimensionless"), allows_plain_number("length")
        (True, False)
    """
    return "" in _kind(kind).units


def example(kind: str) -> str:
    """Return a quantity of a kind as a user writes it.

    Example:
        >>> example("length")
        '"3 mm"'
    """
    plain = "" in _kind(kind).units
    return _kind(kind).example if plain else f'"{_kind(kind).example}"'


def kind_of(unit: str) -> str:
    """Return the kind a unit belongs to, the first in the list of kinds where two share it.

    Args:
        unit: a unit as a user may write it, for example "N*m".

    Raises:
        UnitError: no kind has this unit.

    Example:
        >>> kind_of("N*m")
        'torque'
    """
    kind = _first_kind(_spelling(unit))
    if kind is None:
        raise UnitError(f"{_quoted(unit)} is not a known unit", value=unit)
    return kind


def hardness_scale(text: object) -> str:
    """Name of the scale on which a hardness is given; empty for a pressure or for no text.

    A Vickers and a Brinell number both count the force over the area of their own indentation in
    kgf/mm2, 9.80665 MPa. They are used as such: neither is converted to the other.

    Example:
        >>> hardness_scale("200 HBW")
        'Brinell'
        >>> hardness_scale("1.96 GPa")
        ''
    """
    if not isinstance(text, str):
        return ""
    return _SCALES.get(_split(text, _KINDS["hardness"])[1], "")


def is_quotient(kind: str, above: str, below: str) -> bool:
    """True if a quantity of one kind over one of another has the dimension of a third.

    Args:
        kind, above, below: of `kinds()`.

    Example:
        >>> is_quotient("stiffness", "force", "length")
        True
    """
    quotient, over, under = (
        _registry().Quantity(1, _kind(kind_name).units[si_unit(kind_name)])
        for kind_name in (kind, above, below)
    )
    return bool(quotient.check((over / under).dimensionality))


def parse(text: str | float, kind: str) -> float:
    """Read a quantity and return it in SI units.

    Args:
        text: number and unit, for example "3 mm"; a bare number only where kind is
            "dimensionless".
        kind: what is needed, one of `kinds()`.

    Returns:
        The value in `si_unit(kind)`.

    Raises:
        UnitError: the text is not a finite quantity of this kind; the sentence says why.

    Example:
        >>> parse("55 degC", "temperature")
        328.15
    """
    return _parsed(text, kind) if isinstance(text, str) else _read(text, kind)


def _read(text: str | float, kind: str) -> float:
    wanted = _kind(kind)
    number, unit = _split(text, wanted)
    if unit not in wanted.units:
        _refuse_unit(text, number, unit, wanted)
    scale, offset = _factors(kind, unit)
    value = float(Decimal(number) * scale + offset)
    if not math.isfinite(value):
        raise UnitError(f"{_quoted(text)} is too large", value=text)
    if kind == "temperature" and value < 0.0:
        raise UnitError(f"{_quoted(text)} is below absolute zero", value=text)
    return value


_parsed = lru_cache(maxsize=4096)(_read)  # points of a sweep have most of their values in common


@overload
def convert(value_si: float, unit: str, kind: str) -> float: ...
@overload
def convert(value_si: NDArray[np.floating[Any]], unit: str, kind: str) -> NDArray[Any]: ...
def convert(
    value_si: float | NDArray[np.floating[Any]], unit: str, kind: str
) -> float | NDArray[Any]:
    """Express an SI value in another unit, for display.

    Args:
        value_si: value in `si_unit(kind)`, a float or an array of any shape.
        unit: the unit wanted.
        kind: the quantity kind, one of `kinds()`.

    Returns:
        The value in `unit`, same shape.

    Raises:
        UnitError: the kind does not have this unit.

    Example:
        >>> convert(0.003, "mm", "length")
        3.0
    """
    scale, offset = _factors(kind, spelled(unit, kind))
    return (value_si - float(offset)) / float(scale)


def degrees_celsius(kelvins: "NDArray[np.floating[Any]]") -> "NDArray[Any]":
    """Temperatures in degC, without the rounding of the difference.

    Args:
        kelvins: of any shape [K].

    Example:
        >>> import numpy as np
        >>> degrees_celsius(np.array([313.15, 333.15])).tolist()
        [40.0, 60.0]
    """
    return convert(kelvins, "degC", "temperature").round(9)


def spelled(unit: str, kind: str) -> str:
    """A unit of a kind in the spelling of its list.

    Args:
        unit: as a user may write it.
        kind: of quantity, one of `kinds()`.

    Raises:
        UnitError: the kind does not have this unit; the nearest one it has is told.

    Example:
        >>> spelled("N*m/arcmin", "torsional stiffness")
        'N m/arcmin'
    """
    spelling, wanted = _spelling(unit), _kind(kind)
    if spelling in wanted.units:
        return spelling
    other_kind, near = _first_kind(spelling), _near(spelling, wanted)
    meant = f' (did you mean "{near}"?)' if near and other_kind is None else ""
    of = f"a unit of {_KINDS[other_kind].noun}, not" if other_kind is not None else "not a unit"
    raise UnitError(
        f"{_quoted(unit)} is {of} of {wanted.noun}; use one of {_listed(wanted)}{meant}",
        value=unit,
        allowed=units_of(kind),
    )


def _kind(kind: str) -> _Kind:
    if kind not in _KINDS:
        raise ValueError(f"no quantity kind {kind!r}; there are {', '.join(_KINDS)}")
    return _KINDS[kind]


def _spelling(unit: str) -> str:
    """Bring a unit to the spelling of the lists; what is not understood stays as it is."""
    plain = _POWER.sub("", _PRODUCT.sub(" ", unit.translate(_SIGNS)))
    return re.sub(r" ?([/()]) ?", r"\1", re.sub(r"\s+", " ", plain)).strip()


def _first_kind(spelled: str) -> str | None:
    return next((name for name, kind in _KINDS.items() if spelled in kind.units), None)


def _split(text: str | float, wanted: _Kind) -> tuple[str, str]:
    """Return number and unit spelling; a missing unit is refused unless none is needed."""
    match = _match(text, wanted)
    number, unit = match.group(1), _spelling(match.group(2))
    if not math.isfinite(float(number)):
        raise UnitError(f"{_quoted(text)} is too large", value=text)
    if not unit and "" not in wanted.units:
        others = [f' or "{number} {unit}"' for unit in ("rad", "h") if unit in wanted.units]
        alternatives = "".join(others)  # what is usual for the one is not for the other
        raise UnitError(
            f'{_quoted(text)} has no unit where {wanted.noun} is needed; write "{number} '
            f'{wanted.example.split(" ", 1)[1]}"{alternatives} or use one of {_listed(wanted)}',
            value=text,
            allowed=_shown(wanted),
        )
    return number, unit


def _match(text: object, wanted: _Kind) -> re.Match[str]:
    if isinstance(text, bool) or not isinstance(text, str | int | float):
        raise UnitError(f'{_quoted(text)} is not {wanted.noun}; write "{wanted.example}"')
    plain = _plain(text)
    if len(plain) > MAX_LENGTH:
        raise UnitError(f"a quantity of {len(plain)} characters is too long", value=text)
    match = _NUMBER.fullmatch(plain.strip()) if plain.isprintable() else None
    if match is None or match.group(2)[:1] in {"_", ",", "."}:
        _refuse_number(text, plain, wanted)
    return match


def _plain(text: str | float) -> str:
    """Turn a number into text that reads back to the same value."""
    if isinstance(text, str):
        return text
    if isinstance(text, int) and abs(text) >= 10**40:
        return "an integer that is too large"
    return repr(text if isinstance(text, int) else float(text))


def _refuse_number(text: object, plain: str, wanted: _Kind) -> NoReturn:
    raise UnitError(
        f"{_quoted(text)} does not start with a plain finite number; write {_meant(plain, wanted)}",
        value=text,
    )


def _meant(plain: str, wanted: _Kind) -> str:
    """The quantity without quotation marks of its own, with a point before decimals; else an example.

    A comma before three digits may stand between thousands: both are told.
    """
    bare = plain.strip().strip(_MARKS).strip()
    read = comma_readings(bare) or [bare]
    quantities = [_with_unit(text, wanted) for text in read if text != plain]
    meant = [text if text[-1].isdigit() else f'"{text}"' for text in quantities if text]
    return " or ".join(meant) or f'{wanted.noun} like "{wanted.example}"'


_THOUSANDS = re.compile(r"(?<![\d,.])[1-9]\d{0,2}(?:,\d{3})+(?![\d,])")
_BEFORE_DECIMALS = re.compile(r"(?<=\d),(?=\d+(?!\d*,))")


def comma_readings(text: str) -> list[str]:
    """What a number with commas may mean: without those between thousands, or with a point for a decimal one.

    Example:
        >>> comma_readings("0,125 mm"), comma_readings("20,000 h"), comma_readings("1,234.5 mm")[0]
        (['0.125 mm'], ['20000 h', '20.000 h'], '1234.5 mm')
    """
    thousands = _THOUSANDS.sub(lambda number: number[0].replace(",", ""), text)
    read = dict.fromkeys([thousands, _BEFORE_DECIMALS.sub(".", text)])
    return [meant for meant in read if meant != text]


def _with_unit(text: str, wanted: _Kind) -> str:
    """A number with a unit of a kind, that of the example where it has none; else empty."""
    match = _NUMBER.fullmatch(text)
    unit = _spelling(match.group(2)) if match else "?"
    if unit in wanted.units:
        return text
    return "" if unit else f"{text} {wanted.example.split(' ', 1)[1]}"


def _refuse_unit(text: str | float, number: str, unit: str, wanted: _Kind) -> NoReturn:
    other_kind = _first_kind(unit)
    if re.match(r"\d{3}\b", unit):
        reason = "has a space in its number"
    elif other_kind is not None:
        reason = f"is {_KINDS[other_kind].noun}, but {wanted.noun} is needed"
    else:
        reason = f"is not {wanted.noun}{wanted.remark}"
    raise UnitError(
        f"{_quoted(text)} {reason}; {_advice(number, unit, other_kind, wanted)}",
        value=text,
        allowed=_shown(wanted),
    )


def _advice(number: str, unit: str, other: str | None, wanted: _Kind) -> str:
    if "" in wanted.units:
        return f"give a number without a unit{', or in %' if '%' in wanted.units else ''}"
    near = None if other or unit[:1].isdigit() else _near(unit, wanted)
    meant = f' (did you mean "{number} {near}"?)' if near else ""
    return f"give a number with one of {_listed(wanted)}{meant}"


def _near(unit: str, wanted: _Kind) -> str | None:
    """Unit of a kind that is spelled like a wrong one; none for a unit that means something else."""
    for meant, spellings in _OTHERWISE.items():
        if meant in wanted.units and unit.strip(_MARKS[:-2]).lower() in spellings:
            return meant
    if _SOUND.fullmatch(unit):
        return None
    lower = {listed_unit.lower(): listed_unit for listed_unit in wanted.units}
    close = difflib.get_close_matches(unit.lower(), lower, n=1, cutoff=0.6)
    return lower[close[0]] if close else None


def _shown(wanted: _Kind) -> tuple[str, ...]:
    """Return one spelling for each unit; "Nm" goes without saying beside "N m"."""
    unit_of_expression = {
        expression: unit for unit, expression in reversed(list(wanted.units.items())) if unit
    }
    return tuple(unit for unit in wanted.units if unit in unit_of_expression.values())


def _listed(wanted: _Kind) -> str:
    return ", ".join(_shown(wanted))


def _quoted(text: object) -> str:
    """Quote input for a message: short, and without characters that move the cursor."""
    shown = text if isinstance(text, str) else _described(text)
    if len(shown) > MAX_LENGTH:
        shown = shown[:MAX_LENGTH] + "..."
    return f'"{shown}"' if shown.isprintable() else f'"{ascii(shown)[1:-1]}"'


def _described(value: object) -> str:
    if value is None or isinstance(value, float):
        return str(value)
    if isinstance(value, int) and abs(value) < 10**40:
        return str(value)
    return f"a value of type {type(value).__name__}"


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[Decimal]:
    import pint  # takes 0.6 s, and many commands never need a unit

    return pint.UnitRegistry(non_int_type=Decimal)


def _factors(kind: str, unit: str) -> tuple[Decimal, Decimal]:
    """Return scale and offset of `si = scale * value + offset`; decimals keep "0.8 um" exact."""
    if unit == si_unit(kind):
        return Decimal(1), Decimal(0)
    scale, offset = _every_factor()[kind][unit]
    return Decimal(scale), Decimal(offset)


@cache
def _every_factor() -> Mapping[str, Mapping[str, Sequence[str]]]:
    """Factors of all units by kind, as pint gives them; kept, because pint takes its time."""
    from importlib.metadata import version

    listed = {kind: dict(quantity_kind.units) for kind, quantity_kind in _KINDS.items()}
    state = hashlib.sha256(json.dumps([version("pint"), listed]).encode()).hexdigest()[:16]
    try:
        folder = prepared_folder(base_folder() / "units")
    except RuntimeError:
        folder = None
    path = None if folder is None else folder / state
    stored = None if path is None else read_kept(path)
    if stored is not None:
        return dict(json.loads(stored))
    factors = {
        kind: {unit: _by_pint(kind, unit) for unit in units} for kind, units in listed.items()
    }
    if path is not None:
        write_kept(path, json.dumps(factors).encode())
    return factors


def _by_pint(kind: str, unit: str) -> tuple[str, str]:
    if kind == "temperature":
        return _by_pint("temperature difference", unit)[0], str(_in_si(kind, unit, Decimal(0)))
    return str(_in_si(kind, unit, Decimal(1))), "0"


def _in_si(kind: str, unit: str, value: Decimal) -> Decimal:
    units = _KINDS[kind].units
    quantity = _registry().Quantity(value, units[unit])
    return Decimal(quantity.to(units[si_unit(kind)]).magnitude)
