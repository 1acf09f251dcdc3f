"""What figures are made of: curves with one colour throughout, traces, and layouts.

Figures are plain mappings for plotly.js: building them as plotly's Python objects takes longer than
computing a case.
"""

import html
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import ceil, floor, isfinite, log10
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from pitchpoint.cases.laws import FRICTION
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show

__all__ = [
    "DASHES",
    "GREY",
    "INK",
    "NO_POWER",
    "PALETTE",
    "RISING",
    "Choice",
    "Curve",
    "Curves",
    "Figure",
    "Key",
    "Menu",
    "Panel",
    "Trace",
    "continued",
    "curves",
    "display",
    "evenly",
    "hovered",
    "law_title",
    "laws",
    "layout",
    "legend_line",
    "level",
    "line",
    "line_heights",
    "merged",
    "order_bars",
    "pair_key",
    "plotly_text",
    "rounded",
    "short_axis",
    "verticals",
]

Trace = dict[str, Any]
Curves = Mapping[tuple[str, str], "Curve"]

# Okabe and Ito's palette, which people with colour vision deficiency can tell apart.
PALETTE = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#B07C00", "#56B4E9", "#5A5A5A")
DASHES = ("solid", "dash", "dot", "dashdot")
INK, GREY = "#24303a", "#7b8791"


def evenly(*colours: str) -> list[list[Any]]:
    """A scale of colours for a map, written with #: pages turn only these over for dark paper."""
    end = len(colours) - 1
    return [[place / end, colour] for place, colour in enumerate(colours)]


RISING = evenly("#fffef2", "#fed976", "#fd8d3c", "#e31a1c", "#800026")
"""For a map of what is nothing on most of it; the ground is nearly that of the paper."""

GRID = "#e6eaed"
NO_POWER = "Undefined here: no power is transmitted."


@dataclass(frozen=True)
class Curve:
    """One friction law in one variant, with one look in all figures."""

    key: str
    variant: str
    law: str
    label: str
    colour: str
    dash: str


@dataclass(frozen=True)
class Key:
    """An entry of the legend of one figure; a bar where `dash` is empty."""

    label: str
    colour: str
    dash: str = "solid"


@dataclass(frozen=True)
class Figure:
    """A figure for plotly.js with its name in the page, title, remark and legend of its own."""

    name: str
    title: str
    data: list[Trace]
    layout: dict[str, Any]
    note: str = ""
    keys: tuple[Key, ...] = ()
    missing: str = NO_POWER

    def __post_init__(self) -> None:
        """Gives an axis of constant values a range that says so, where plotly's would be of length two.

        Numbers of many digits along an axis get a power of ten.
        """
        for name in "xy":
            look = self.layout.get(f"{name}axis", {})
            values = [value for trace in self.data for value in trace.get(name, [])]
            if look.get("exponentformat") == "none" and look.get("type") != "log" and _long(values):
                look |= {"exponentformat": "power", "minexponent": 2, "separatethousands": False}
        axis, level = self.layout.get("yaxis", {}), _constant(self.data)
        if level is not None and axis.get("type") != "log":
            axis.setdefault("range", _around(level, "rangemode" in axis))

    @property
    def remarks(self) -> str:
        """The remark, and a word where one value is drawn as a line."""
        flat = "" if _constant(self.data) is None else "The same throughout, but for rounding."
        return " ".join(filter(None, (self.note, flat)))

    @property
    def drawn(self) -> bool:
        """True if there is a finite value to draw."""
        return any(_finite(trace.get("z") or trace.get("y") or []) for trace in self.data)


@dataclass(frozen=True)
class Choice:
    """An entry of a menu: by name of the figure what to restyle, and what to lay out anew."""

    label: str
    changes: dict[str, list[Any]]


@dataclass(frozen=True)
class Menu:
    """One of several menus of a panel: its words and the labels of its entries."""

    words: str
    labels: Sequence[str]


@dataclass(frozen=True)
class Panel:
    """Figures that belong together, with the curves in them and a menu if there is one.

    Attributes:
        menus: where one menu is not enough; the choices are all combinations, those of the last menu next
            to each other.
        slides: True if the choices are places in order, for a slider in place of a menu.
        at: number of the choice that the figures show at first.
    """

    title: str
    figures: list[Figure]
    curves: list[Curve] = field(default_factory=list)
    choices: list[Choice] = field(default_factory=list)
    note: str = ""
    menu: str = ""
    slides: bool = False
    at: int = 0
    menus: Sequence[Menu] = ()
    block: ClassVar[str] = "panel"

    @property
    def selects(self) -> Iterator[tuple[Menu, int, int]]:
        """Every menu with the number of choices from one entry to the next, and the entry shown first."""
        menus = self.menus or [Menu(self.menu, [choice.label for choice in self.choices])]
        step = len(self.choices)
        for menu in menus:
            step //= len(menu.labels)
            yield menu, step, self.at // step % len(menu.labels)


def curves(outcomes: Mapping[str, Outcome]) -> dict[tuple[str, str], Curve]:
    """Curve by variant and law, for every law of the results apart from the spread of the laws."""
    names = list(dict.fromkeys(_variant_laws(outcomes)))
    variants = list(outcomes)
    return {
        (variant, law): Curve(
            key=f"c{position}",
            variant=variant,
            law=law,
            label=law_title(outcomes[variant], law)
            + (f" · {variant}" if len(variants) > 1 else ""),
            colour=PALETTE[position % len(PALETTE)],
            dash=DASHES[(variants.index(variant) + position // len(PALETTE)) % len(DASHES)],
        )
        for position, (variant, law) in enumerate(names)
    }


PAIRS = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")
"""Names of the pairs: I entered in this period, II one period before, and so on."""


def pair_key(position: int) -> Key:
    """Entry of a pair in a legend, the same colour wherever it is shown."""
    name = PAIRS[position] if position < len(PAIRS) else str(position + 1)
    return Key(f"pair {name}", PALETTE[position % len(PALETTE)])


def law_title(outcome: Outcome, law: str) -> str:
    """Title of a friction law, or its name where nobody knows it any more."""
    titles = {entry["name"]: str(entry["title"]) for entry in outcome.manifest["laws"]}
    if law in titles:
        return titles[law]
    return FRICTION[law].title if law in FRICTION else law


def laws(data: xr.Dataset) -> list[str]:
    """Names of the laws of a dataset."""
    return [str(name) for name in data["law"].values]


def rounded(values: Any, digits: int = 5) -> list[Any]:
    """List of numbers with so many significant digits, and with so many of their range where that is finer.

    A ripple far smaller than its mean keeps its shape so. What is rounding against the largest number
    is zero, and numbers that differ by rounding alone are one; None for what is not finite.
    """
    array = np.asarray(values, dtype=float)
    finite = array[np.isfinite(array)]
    size, span = np.max(np.abs(finite), initial=0.0), np.ptp(finite) if finite.size else 0.0
    if span <= ROUNDING * size:
        array = np.where(np.isfinite(array), finite[:1].sum(), array)
    array = np.where(np.abs(array) <= ROUNDING * size, 0.0, array)
    of_range = _decimals(span, digits) if span > ROUNDING * size else 0

    def plain(value: Any) -> Any:
        if isinstance(value, list):
            return [plain(entry) for entry in value]
        if not isfinite(value):
            return None
        return round(value, max(_decimals(value, digits), of_range))

    entries: list[Any] = plain(array.tolist())
    return entries


def line_heights(values: Any, levels: int = 4000) -> list[Any]:
    """List of numbers for a line on an axis without decades, in so many heights at least.

    A figure is 300 px high, and may be enlarged.
    """
    numbers = rounded(values)
    finite = [value for value in numbers if value is not None]
    span = max(finite, default=0.0) - min(finite, default=0.0)
    if not span:
        return numbers
    decimals = ceil(log10(levels / span))
    most = max(
        10.0**decimals * span / levels, 1.0
    )  # units of the last decimal from a level to the next
    step = next(factor for factor in (5, 2, 1) if factor <= most) * 10.0**-decimals
    return [v if v is None else round(round(v / step) * step, decimals) + 0.0 for v in numbers]


def _decimals(value: float, digits: int) -> int:
    """Decimals with which a number has so many significant digits."""
    return digits - 1 - floor(log10(abs(value))) if value else 0


def display(name: str, values: Any, of: Any = None) -> np.ndarray:
    """SI values of a variable in its display unit, see `show.described`."""
    return np.asarray(show.described(name, of).displayed(np.asarray(values, dtype=float)))


def line(curve: Curve, x: Any, y: Any, unit: str, **more: Any) -> Trace:
    """Line of a curve; its values may contain gaps."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": plotly_text(curve.label),
        "meta": curve.key,
        "x": rounded(x, 6),
        "y": rounded(y),
        "line": {"color": curve.colour, "dash": curve.dash, "width": 2},
        "hovertemplate": f"%{{y:{hovered(y)}}} {unit}<br>at %{{x:.4~r}}",
        **more,
    }


def hovered(values: Any) -> str:
    """Format of plotly.js for values under the mouse: four significant digits, and three of their range.

    Example:
        >>> hovered([0.0, 4.0]), hovered([71.75, 71.95])
        ('.4~r', '.6~r')
    """
    array = np.asarray(values, float)
    finite = array[np.isfinite(array)]
    size, span = np.max(np.abs(finite), initial=0.0), np.ptp(finite) if finite.size else 0.0
    extra_digits = ceil(log10(size / span)) if span > ROUNDING * size else 0
    return f".{max(4, 3 + extra_digits)}~r"


def legend_line(key: Key, x: Any, y: Any, unit: str, **more: Any) -> Trace:
    """Line of an entry of a legend, as `line` is that of a curve."""
    return line(Curve("", "", "", key.label, key.colour, key.dash), x, y, unit, **more)


def order_bars(key: Key, orders: np.ndarray, amplitudes: Any, unit: str) -> Trace:
    """Bars of the amplitudes of orders, shapes (order,)."""
    return {
        "type": "bar",
        "name": plotly_text(key.label),
        "meta": "",
        "x": orders.tolist(),
        "y": rounded(amplitudes),
        "marker": {"color": key.colour},
        "hovertemplate": f"%{{y:.4~r}} {unit}<br>order %{{x}}",
    }


def continued(x: np.ndarray, y: np.ndarray, most: int = 600) -> tuple[np.ndarray, np.ndarray]:
    """Points of a line with a gap (NaN) where it jumps, and no more of them than a page needs.

    Args:
        x, y: points in order; at a jump two of them share their place, NaN where there is nothing.
        most: count above which points are left out.
    """
    span = np.nanmax(y, initial=-np.inf) - np.nanmin(y, initial=np.inf)
    jumps = np.flatnonzero((np.diff(x) < 1e-6) & (np.abs(np.diff(y)) > 1e-3 * span))
    shown = np.zeros(x.size, bool)
    shown[:: max(x.size // most, 1)] = True
    shown[[0, -1, *jumps, *(jumps + 1)]] = True
    shown |= np.isnan(y) | np.isnan(np.roll(y, 1)) | np.isnan(np.roll(y, -1))  # gaps stay as wide
    cuts = np.searchsorted(np.flatnonzero(shown), jumps + 1)
    return np.insert(x[shown], cuts, x[jumps]), np.insert(y[shown], cuts, np.nan)


def layout(x: str, y: str, **more: Any) -> dict[str, Any]:
    """Layout with titles of the axes; `more` goes on top, axes are merged."""
    axis = {
        "gridcolor": GRID,
        "zeroline": False,
        "linecolor": "#9aa5ad",
        "ticks": "outside",
        "tickcolor": "#9aa5ad",
        "automargin": True,
        "exponentformat": "none",
        "separatethousands": True,
    }
    return {
        "xaxis": {
            **axis,
            "title": {"text": show.subscripts(x), "standoff": 8},
            **more.pop("xaxis", {}),
        },
        "yaxis": {
            **axis,
            "title": {"text": show.subscripts(y), "standoff": 8},
            **more.pop("yaxis", {}),
        },
        "showlegend": False,
        "margin": {"l": 62, "r": 14, "t": 24, "b": 48},
        "font": {"family": "system-ui, sans-serif", "size": 12, "color": INK},
        "hoverlabel": {"font": {"size": 12}},
        "paper_bgcolor": "#fff",
        "plot_bgcolor": "#fff",
        "separators": ".\u2009",
        **more,
    }


def verticals(marks: Sequence[tuple[str, float]]) -> dict[str, Any]:
    """Dotted lines of a layout at places of the x axis, each with its words above."""
    return {
        "shapes": [
            {"type": "line", "x0": x, "x1": x, "yref": "paper", "y0": 0, "y1": 1, "layer": "below"}
            | {"line": {"color": "#9aa5ad", "width": 1, "dash": "dot"}}
            for _, x in marks
        ],
        "annotations": [
            {"text": show.subscripts(label), "x": x, "yref": "paper", "y": 1, "yanchor": "bottom"}
            | {"showarrow": False, "font": {"size": 12}}
            for label, x in marks
        ],
    }


def level(name: str, value: float, of: Any = None) -> str:
    """A value at which a line holds, with its unit, for a legend [SI in], see `show.described`."""
    return f"{show.number_text(float(display(name, value, of)))}\u00a0{show.unit_of(name, of)}"


def short_axis(name: str, of: Any = None) -> str:
    """Title of an axis: symbol and unit; the figure has the long name above it."""
    variable = show.described(name, of)
    return show.bracketed(variable.symbol, variable)


def plotly_text(words: str) -> str:
    """Words for plotly.js, which reads tags in them otherwise."""
    return html.escape(words, quote=False)


def merged(traces: Sequence[Trace]) -> tuple[list[Trace], str]:
    """One trace and a remark in place of several that lie on each other."""
    trace = traces[0] if traces else {}
    alike = all((t["x"], t["y"]) == (trace["x"], trace["y"]) for t in traces)
    if len(traces) < 2 or not alike:
        return list(traces), ""
    common = {**trace, "name": "", "meta": "", "line": {"color": INK, "width": 2}}
    return [common], "The same for every curve."


def _constant(traces: Sequence[Trace]) -> float | None:
    """The value of lines that all lie at one height; None for anything else."""
    if any("z" in trace or "orientation" in trace for trace in traces):
        return None
    values = {y for trace in traces for y in trace.get("y", []) if y is not None}
    return float(values.pop()) if len(values) == 1 else None


def _long(values: Sequence[Any]) -> bool:
    """True if numbers along an axis with these values would have seven digits, or five decimals."""
    numbers = [value for value in values if isinstance(value, int | float)]
    if not numbers:
        return False
    largest, span = max(map(abs, numbers)), max(numbers) - min(numbers)
    step = (span or largest) / 4.0
    return largest >= 1e6 or (largest < 0.01 and 0.0 < step < 1e-4)


def _around(value: float, from_zero: bool) -> list[float]:
    """Range of an axis that shows one value."""
    if value == 0.0:
        return [0.0, 1.0] if from_zero else [-1.0, 1.0]
    if from_zero:
        return sorted([0.0, 1.25 * value])
    return [value - 0.05 * abs(value), value + 0.05 * abs(value)]


def _variant_laws(outcomes: Mapping[str, Outcome]) -> Iterator[tuple[str, str]]:
    for variant, outcome in outcomes.items():
        for name, data in outcome.parts.items():
            if name != "laws" and "law" in data.coords:
                yield from ((variant, law) for law in laws(data))


def _finite(values: Sequence[Any]) -> bool:
    return any(_finite(value) if isinstance(value, list) else value is not None for value in values)
