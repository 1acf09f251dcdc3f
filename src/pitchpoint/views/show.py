"""Numbers and units as people read them."""

import re
from collections.abc import Sequence
from math import isclose, isfinite
from typing import Any

import numpy as np

from pitchpoint import units
from pitchpoint.results.variable import Variable
from pitchpoint.results.variables import VARIABLES, variable_of

__all__ = [
    "NOISE",
    "axis_title",
    "bracketed",
    "described",
    "display_unit",
    "displayed",
    "first_clauses",
    "handy",
    "number_text",
    "one_line",
    "points",
    "pretty",
    "quantities",
    "quantity",
    "sentence",
    "signed",
    "span",
    "subscripts",
    "unit_of",
    "whole_clauses",
    "with_article",
]

_UNITS = {
    "um": "µm",
    "N/um": "N/µm",
    "degC": "°C",
    "deg": "°",
    "mm2/s": "mm²/s",
    "mm3": "mm³",
    "kg/m3": "kg/m³",
    "kg/m3/K": "kg/(m³ K)",
    "N m": "N\u00a0m",
    "kN m": "kN\u00a0m",
    "mN m": "mN\u00a0m",
    "urad": "µrad",
    "us": "µs",
    "degF": "°F",
    "N/mm2": "N/mm²",
    "kg m2": "kg m²",
    "kg cm2": "kg cm²",
    "kg mm2": "kg mm²",
    "g cm2": "g cm²",
    "m2/s": "m²/s",
    "m2": "m²",
    "cm2": "cm²",
    "mm2": "mm²",
    "m3": "m³",
    "cm3": "cm³",
    "1": "",
}
NOISE = 1e-9
"""Value in usual units below which one is left by rounding."""

_CLAUSE = re.compile(r"(?<=[^\d\s]),? \(|[;,.] | – ")
"""Where a sentence can end early; not within a number, nor before its unit."""

_MOST_OF = 0.6
"""Part of a line that clauses must fill; else a sentence ends within one."""

_NUMBER = re.compile(r"[−+-]?\d[\d.,]*(e[−+-]?\d+)?")

_INDEXED = re.compile(
    r"(?<![\w`.])(?<![^\W_Δ]\w/)(?<!\./)([ΔΣd]?[^\W\d_])_([^\W²³]{1,5})(?![^\W²³]|\()"
)
_LAST_UNIT = re.compile(r"(?<=\d) (um|urad|degC|degF|mm2/s|kg/m3/K|kg/m3)\b(?![/0-9])")


def display_unit(name: str) -> str:
    """Unit as printed; empty for plain numbers.

    Example:
        >>> display_unit("um")
        'µm'
    """
    return _UNITS.get(name, name)


def pretty(text: str) -> str:
    """Text in which units that follow a number are printed as in a book."""
    return _LAST_UNIT.sub(lambda found: f" {_UNITS[found.group(1)]}", text)


def sentence(text: str, whole: bool = True) -> str:
    """A clause as a sentence: with a capital, but for names with digits, and where it is whole a full stop.

    Example:
        >>> [sentence(text) for text in ("gear 2: a rim is thin", "xu_2007: out of its range.")]
        ['Gear 2: a rim is thin.', 'xu_2007: out of its range.']
    """
    begun = text[:1].upper() + text[1:] if _PLAIN_WORD.match(text) else text
    return begun if not whole or begun.endswith((".", "!", "?", ":")) else f"{begun}."


_PLAIN_WORD = re.compile(r"[a-z]+[ ,:]")


def subscripts(text: str) -> str:
    """Text in which the index of a symbol of one letter is set low, as HTML and plotly.js read it.

    Example:
        >>> subscripts("pitch diameter d_w of gear_1")
        'pitch diameter d<sub>w</sub> of gear_1'
        >>> subscripts("Δk/k_m in out/k_m")
        'Δk/k<sub>m</sub> in out/k_m'
        >>> subscripts("Δh_c/h_c and ΣF_f")
        'Δh<sub>c</sub>/h<sub>c</sub> and ΣF<sub>f</sub>'
    """
    return _INDEXED.sub(r"\1<sub>\2</sub>", text)


def number_text(value: float, digits: int = 4) -> str:
    """Number as people read it: so many significant digits, no zeros behind them; a whole one whole.

    Args:
        value: any; "undefined" if it is not finite. From a million on, and below a thousandth, it has its
            power of ten.
        digits: significant ones; fewer for what is itself an estimate, more for what is given.

    Example:
        >>> [number_text(value) for value in (0.74199, 1.0, 12345.0, 12345.6, 9275724.0, 0.0005542)]
        ['0.742', '1', '12345', '12350', '9.276e6', '5.542e−4']
    """
    if not isfinite(value):
        return "undefined"
    mantissa, _, exponent = f"{value:.{digits - 1}e}".partition("e")
    power = int(exponent)
    if not _SMALLEST <= power < _LARGEST:
        return f"{_bare(mantissa)}e{_bare(str(power))}"
    if isclose(value, round(value), rel_tol=NOISE):
        return _bare(f"{round(value)}")
    return _bare(f"{float(f'{mantissa}e{power}'):.{max(digits - 1 - power, 0)}f}")


_SMALLEST, _LARGEST = -3, 6
"""Powers of ten of the first digit: from the one on, and below the other, a number is written out."""


def _bare(text: str) -> str:
    """A number without zeros behind its last decimal, with a proper minus."""
    return (text.rstrip("0").rstrip(".") if "." in text else text).replace("-", "−")


def signed(value: float, decimals: int) -> str:
    """Number with its sign and so many decimals.

    Example:
        >>> signed(0.0042, 3)
        '+0.004'
    """
    text = f"{value:+.{decimals}f}"
    return text.replace("-", "−") if float(text) else "0"


def described(name: str, of: Any = None) -> Variable:
    """A variable by name, as it is in a dataset: that of a member that travels has other units.

    Args:
        name: of `VARIABLES`.
        of: the dataset; one without that variable, or none, leaves it as it usually is.
    """
    return VARIABLES[name] if of is None or name not in of else variable_of(of, name)


def unit_of(name: str, of: Any = None) -> str:
    """Display unit of a variable as printed, see `described`."""
    return display_unit(described(name, of).display)


def bracketed(words: str, variable: Variable) -> str:
    """Words for a variable with its display unit behind them.

    Example:
        >>> from pitchpoint.results.variables import VARIABLES
        >>> bracketed("backlash j_bn", VARIABLES["normal_backlash"])
        'backlash j_bn [µm]'
    """
    shown = display_unit(variable.display)
    return f"{words} [{shown}]" if shown else words


def displayed(variable: Variable, values: Any) -> np.ndarray:
    """SI values of a variable in its display unit, zero where only rounding left something.

    What rounding leaves is told in the usual unit: a film of 0.1 um is none of that, also in metres. No
    temperature is that small.
    """
    array = np.asarray(values, float)
    shown = variable.displayed(array)
    of_zero = shown
    if variable.kind != "temperature":
        of_zero = units.convert(array, variable.usual, variable.kind)
    return np.where(np.abs(of_zero) < NOISE, 0.0, shown)


def quantity(name: str, value: float, *, with_unit: bool = True, of: Any = None) -> str:
    """Value of a variable of a result in its display unit [SI in], see `described`.

    Example:
        >>> quantity("mean_efficiency", 0.99354), quantity("normal_backlash", 6e-15)
        ('99.35 %', '0 µm')
        >>> print(*(quantity("mean_input_torque", torque) for torque in (1.007e6, 9.128e-4)), sep="; ")
        1007 kN m; 0.9128 mN m
    """
    variable = described(name, of)
    if not isfinite(value):
        if name.endswith("film_error"):
            return "not known"
        return "undefined, no power" if variable.display == "%" else "undefined"
    rounding = name in _DIFFERENCES and abs(value) < _OF_DIFFERENCES
    shown = float(displayed(variable, 0.0 if rounding else value))
    return _with_unit(shown, variable.display) if with_unit else number_text(shown)


def quantities(name: str, values: Sequence[float], of: Any = None) -> tuple[str, list[str]]:
    """Unit, as printed, and numbers of values of a variable that share it [SI in], see `described`.

    Example:
        >>> quantities("disc_inertia", (2.038e-8, 8.014e-5))
        ('g cm²', ['0.2038', '801.4'])
    """
    variable = described(name, of)
    shown, display = handy(
        [float(displayed(variable, value)) for value in values], variable.display
    )
    return display_unit(display), [number_text(value) for value in shown]


def handy(values: Sequence[float], display: str) -> tuple[list[float], str]:
    """Values and their unit; in a larger or smaller one where one of them would need a power of ten.

    Args:
        values: in the unit.
        display: the unit; one that has no other in its place stays.

    Example:
        >>> handy([1.088e-9, 1.059e-5], "kg m2")[1], handy([2.5], "N m")
        ('g cm2', ([2.5], 'N m'))
    """
    sizes = [abs(value) for value in values if value and isfinite(value)]
    if not sizes:
        return list(values), display
    small, large = min(sizes) < 10.0**_SMALLEST, max(sizes) >= 10.0**_LARGEST
    other_unit, times = (_LARGER if large else _SMALLER).get(display, (display, 1.0))
    if small == large or other_unit == display or (small and max(sizes) / times >= 10.0**_LARGEST):
        return list(values), display
    changed = [value / times for value in values]
    return handy(changed, other_unit) if small else (changed, other_unit)


def _with_unit(value: float, display: str) -> str:
    """Number with its unit; with a larger or smaller one where it would need a power of ten."""
    (shown,), display = handy([value], display)
    return f"{number_text(shown)} {display_unit(display)}".strip()


_LARGER = {
    "N m": ("kN m", 1e3),
    "N": ("kN", 1e3),
    "W": ("kW", 1e3),
    "J": ("MJ", 1e6),
    "kg cm2": ("kg m2", 1e4),
}
_SMALLER = {
    "N m": ("mN m", 1e-3),
    "N": ("mN", 1e-3),
    "W": ("mW", 1e-3),
    "J": ("µJ", 1e-6),
    "kg": ("g", 1e-3),
    "kg m2": ("kg cm2", 1e-4),
    "kg cm2": ("g cm2", 1e-3),
}
"""Units in place of one, and what they are of it."""

_DIFFERENCES = (
    "circumferential_backlash",
    "normal_backlash",
    "backlash_on_circle",
    "backlash_along_normal",
    "backlash_angle",
)
_OF_DIFFERENCES = 1e-12
"""What rounding leaves of differences of dimensions of a large gear [m, rad]."""


def points(part: float) -> str:
    """A difference of efficiencies in percentage points; one that says nothing is told to be small.

    Example:
        >>> points(0.0123), points(-8.195e-6)
        ('1.23 percentage points', 'less than 0.001 percentage points')
    """
    small = 0.0 < abs(100.0 * part) < 10.0**_SMALLEST
    return f"{'less than 0.001' if small else number_text(100.0 * part)} percentage points"


def span(low: str, high: str, values: Sequence[float], of: Any = None) -> str:
    """Range of two variables that share their unit [SI in].

    Example:
        >>> span("min_efficiency", "max_efficiency", (0.9918, 1.0))
        '99.18 to 100 %'
    """
    lower, upper = quantity(low, values[0], of=of), quantity(high, values[1], of=of)
    if lower == upper:
        return lower
    (value, _, unit_of_low), (_, _, unit_of_high) = lower.partition(" "), upper.partition(" ")
    return f"{value if unit_of_low == unit_of_high else lower} to {upper}"


def with_article(member: str) -> str:
    """Name of a body in a sentence.

    Example:
        >>> with_article("rack"), with_article("gear 2"), with_article("stage 1: carrier")
        ('the rack', 'gear 2', 'stage 1: carrier')
    """
    return member if re.search(r"\d", member) else f"the {member}"


def axis_title(name: str, of: Any = None) -> str:
    """Long name and display unit of a variable, see `described`."""
    variable = described(name, of)
    return bracketed(variable.long_name, variable)


def one_line(text: str) -> str:
    """Text without line breaks and repeated spaces; those that hold a number and its unit together stay."""
    return re.sub(r"[ \t\r\n]+", " ", text).strip()


def first_clauses(sentence: str, width: int, filled: float = _MOST_OF) -> str:
    """As many clauses of a sentence as there is room for, else words; a number and its unit stay whole.

    Args:
        sentence: in one line.
        width: of the line.
        filled: part of the line that clauses must fill; else a sentence ends within one.

    Example:
        >>> first_clauses("Tips are thin, 0.2 modules; case-hardened teeth may break there.", 40)
        'Tips are thin, 0.2 modules …'
        >>> first_clauses("friction 0.31 reaches the 0.29 at which this mesh locks", 32)
        'friction 0.31 reaches the …'
    """
    sentence = one_line(sentence)
    if len(sentence) <= width:
        return sentence
    clauses = whole_clauses(sentence, width - 2)
    if clauses and len(clauses) >= filled * width:
        return f"{clauses} …"
    words = sentence[: width - 1].rsplit(" ", 1)[0].split(" ")
    while len(words) > 1 and _NUMBER.fullmatch(words[-1]):
        words.pop()  # its unit is what was cut off
    return f"{' '.join(words).rstrip()} …"


def whole_clauses(sentence: str, width: int) -> str:
    """As many whole clauses of a detail as there is room for, none where the first one is too long.

    Args:
        sentence: in one line, the most telling clause first; the page shows all of it.
        width: of the line.

    Example:
        >>> whole_clauses("by iso_tr_14179_2 (fitted to rigs, of steel); 97.87 % by xu_2007", 50)
        'by iso_tr_14179_2 (fitted to rigs, of steel)'
        >>> whole_clauses("friction 0.31 reaches the 0.29 at which this mesh locks", 32)
        ''
    """
    sentence = one_line(sentence)
    ends = [*(clause.start() for clause in _CLAUSE.finditer(sentence)), len(sentence)]
    begins = [sentence[:end].rstrip() for end in ends if end <= width]
    return next(
        (clauses for clauses in reversed(begins) if clauses.count("(") == clauses.count(")")), ""
    )
