"""Loss and efficiency over torque, speed and temperature."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import ceil, floor, log10
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import coverage_sentences, why_not
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.lines import titled
from pitchpoint.views.point import operating_point
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Section

__all__ = ["LOSS_MAP", "Chart", "efficiency_panel", "map_blocks", "map_figure", "map_panel"]

_SEEN = 1e-4
"""Difference, over the larger of two values, that four digits tell."""

_LINES = 7
"""Steps between contour lines that a map has about."""

_MOST = 60
"""Largest number of values on an axis that goes into the page."""


@dataclass(frozen=True)
class Chart:
    """A map that is drawn.

    Attributes:
        part: of the result.
        title: of the panel.
        axes: that go across and up.
        shown: quantities, each in a figure.
        name: begins the names of the figures.
    """

    part: str
    title: str
    axes: tuple[str, str]
    shown: tuple[str, ...]
    name: str

    def of(self, outcomes: Mapping[str, Outcome]) -> dict[str, xr.Dataset]:
        """The maps of those outcomes that have one."""
        return {
            n: outcome.parts[self.part]
            for n, outcome in outcomes.items()
            if self.part in outcome.parts
        }


OF_DRIVER = Chart(
    "loss_map", "Loss map", ("speed", "torque"), ("mean_loss", "mean_efficiency"), "map"
)


def map_panel(
    outcomes: Mapping[str, Outcome], known: plot.Curves, chart: Chart = OF_DRIVER
) -> plot.Panel:
    """Heat maps of loss and efficiency with a menu for law, variant and temperature."""
    choices = list(_choices(outcomes, chart))
    if not choices:
        return plot.Panel(chart.title, [])
    shown = min(range(len(choices)), key=lambda at: choices[at][0])
    _, variant, position, law = choices[shown]
    even = {name: words for name in chart.shown if (words := _even(name, outcomes, chart))}
    drawn = replace(chart, shown=tuple(name for name in chart.shown if name not in even))
    figures = [
        map_figure(name, outcomes[variant], chart, law, position, _scale(name, outcomes, chart))
        for name in drawn.shown
    ]
    menu = [_choice(outcomes, known, drawn, *choice[1:]) for choice in choices]
    menus = _menus(outcomes, known, chart) if len(choices) > 1 else []
    if not figures:
        menu, menus, shown = [], [], 0
    note = " ".join(even.values())
    return plot.Panel(chart.title, figures, [], menu, note, menu="Shown for", menus=menus, at=shown)


def map_blocks(panel: plot.Panel) -> Iterator[Block]:
    """The heat maps of a panel below what is the same everywhere.

    Args:
        panel: see `map_panel`.
    """
    if panel.note:
        yield Paragraph(panel.note)
    yield panel


def _even(name: str, outcomes: Mapping[str, Outcome], chart: Chart) -> str:
    """A sentence in place of a map that would have one colour whatever is chosen; empty for others."""
    every = [data[name].values.ravel() for data in chart.of(outcomes).values()]
    low, high = _ends(np.concatenate(every))
    if high > low:
        return ""
    data = next(iter(chart.of(outcomes).values()))
    title = show.sentence(show.described(name, data).long_name, whole=False)
    return f"{title}: {show.quantity(name, low, of=data)} throughout, to four digits."


def _menus(outcomes: Mapping[str, Outcome], known: plot.Curves, chart: Chart) -> list[plot.Menu]:
    """Menus for law and for temperature; none where variants have their maps at others."""
    maps = chart.of(outcomes)
    degrees = {tuple(data["temperature"].values.tolist()) for data in maps.values()}
    labels = [known[name, law].label for name, data in maps.items() for law in plot.laws(data)]
    if len(degrees) > 1:
        return []
    levels = [plot.level("temperature", degree) for degree in degrees.pop()]
    menus = [plot.Menu("Friction", labels), plot.Menu("Oil at", levels)]
    return [menu for menu in menus if len(menu.labels) > 1]


def _scale(name: str, outcomes: Mapping[str, Outcome], chart: Chart) -> dict[str, float]:
    """Ends of the colour scale that all maps of a quantity share; none where nothing is known.

    They are those of the laws in their range: an extrapolation would leave the others in one colour.
    """
    every = chart.of(outcomes)
    inside = [data[name].values[_holds(outcomes[n], data)] for n, data in every.items()]
    maps = inside if sum(map(len, inside)) else [data[name].values for data in every.values()]
    return colour_scale(name, maps)


def colour_scale(name: str, maps: Iterable[np.ndarray]) -> dict[str, float]:
    """Ends of the colour scale of some maps, with zero in the middle where both signs mean something.

    Args:
        name: of the quantity.
        maps: its values, as many as have one scale.
    """
    low, high = _ends(np.concatenate([plot.display(name, values).ravel() for values in maps]))
    low, high = (-max(-low, high), max(-low, high)) if name in _SIGNED else (low, high)
    if not high > low:  # as one colour, not its last digits over the whole scale
        low, high = low - _SEEN * abs(low), low + _SEEN * abs(low)
    return {"zmin": low, "zmax": high} if high > low else {}


def _holds(outcome: Outcome, data: xr.Dataset) -> np.ndarray:
    """True for laws of a map that are in their range at the operating point, or of which nobody knows."""
    return ~np.isin(plot.laws(data), [*why_not(outcome.parts)])


def _ends(values: np.ndarray) -> tuple[float, float]:
    """Smallest and largest value, equal where four digits do not tell them apart, or nothing is known."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    return (low, high) if high - low > _SEEN * max(abs(low), abs(high)) else (low, low)


def _contours(values: Any) -> dict[str, Any]:
    """Lines of a map at round values, some `_LINES` between the ends of what it shows itself."""
    low, high = _ends(np.array(values, float))
    if not high > low:
        above = 2.0 * abs(low) + 1.0
        return {"contours.start": above, "contours.end": above, "contours.size": 1.0}
    wanted = (high - low) / _LINES
    decade = 10.0 ** floor(log10(wanted))
    size = decade * min((1.0, 2.0, 2.5, 5.0, 10.0), key=lambda step: abs(step - wanted / decade))
    ends = (floor(low / size) + 1) * size, (ceil(high / size) - 1) * size
    return {"contours.start": ends[0], "contours.end": ends[1], "contours.size": size}


def _choices(
    outcomes: Mapping[str, Outcome], chart: Chart
) -> Iterator[tuple[float, str, int, int]]:
    """Distance from the operating temperature, variant, temperature and law of every map."""
    for variant, data in chart.of(outcomes).items():
        fact = operating_point(outcomes[variant])
        for law in range(data.sizes["law"]):
            for position, degree in enumerate(data["temperature"].values):
                yield abs(float(degree) - fact.temperature), variant, position, law


def _choice(
    outcomes: Mapping[str, Outcome],
    known: plot.Curves,
    chart: Chart,
    variant: str,
    position: int,
    law: int,
) -> plot.Choice:
    data = outcomes[variant].parts[chart.part]
    curve = known[variant, plot.laws(data)[law]]
    degree = plot.level("temperature", float(data["temperature"].values[position]))
    changes: dict[str, list[Any]] = {}
    for name in chart.shown:
        heat = _heat(name, data, chart, law, position)
        restyled = {**heat, **_contours(heat["z"])}
        changes[f"{chart.name}_{name}"] = [{k: [values] for k, values in restyled.items()}, {}, [0]]
    return plot.Choice(f"{curve.label}, oil at {degree}", changes)


def _heat(name: str, data: xr.Dataset, chart: Chart, law: int, temperature: int) -> dict[str, Any]:
    """Axes and values from where some map has any, thinned where there are more than a page can show."""
    across, up = chart.axes
    every = data[name].transpose("law", "temperature", up, across).values
    finite = np.isfinite(every).any(axis=(0, 1))
    rows, columns = (_thinned(finite.any(axis=axis)) for axis in (1, 0))
    values = every[law, temperature]
    return {
        "x": plot.rounded(plot.display(across, data[across].values[columns], data)),
        "y": plot.rounded(plot.display(up, data[up].values[rows], data)),
        "z": plot.rounded(plot.display(name, values[np.ix_(rows, columns)], data)),
    }


def _thinned(known: np.ndarray) -> np.ndarray:
    """Places from the first to the last that is known, all where none is; no more than a page can show."""
    places = np.flatnonzero(known) if known.any() else np.arange(known.size)
    count = min(int(np.ptp(places)) + 1, _MOST)
    return np.unique(np.linspace(places[0], places[-1], count).round().astype(int))


def map_figure(
    name: str,
    outcome: Outcome,
    chart: Chart,
    law: int,
    temperature: int,
    scale: Mapping[str, float] = MappingProxyType({}),
) -> plot.Figure:
    """Heat map of a quantity with the operating point.

    Args:
        name: of the quantity.
        outcome: that has the map.
        chart: which map it is.
        law: position of the friction law.
        temperature: position of the temperature of the oil.
        scale: ends of the colour scale, `zmin` and `zmax`; those of the values unless given.
    """
    data, fact, (across, up) = outcome.parts[chart.part], operating_point(outcome), chart.axes
    unit, units = (
        show.unit_of(name, data),
        [show.unit_of(variable, data) for variable in chart.axes],
    )
    speed = fact.speed * float(data.attrs.get("speed_ratio", 1.0))
    shown, uniform = _heat(name, data, chart, law, temperature), _same(name, data)
    lines = {key.partition(".")[2]: value for key, value in _contours(shown["z"]).items()}
    heat = {
        "type": "contour",
        **shown,
        **_COLOURS.get(name, {"colorscale": plot.evenly("#ffffcc", "#feb24c", "#f4714d")}),
        "hoverongaps": False,
        **scale,
        "zauto": not scale,
        "showscale": not uniform,
        "autocontour": False,
        "contours": {"coloring": "heatmap", "showlabels": True, "labelfont": {"size": 11}, **lines},
        "line": {"color": plot.INK, "width": 0.7},
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~r}} {unit}<br>%{{x:.4~r}} {units[0]}, %{{y:.4~r}} {units[1]}"
        "<extra></extra>",
    }
    point = {
        "type": "scatter",
        "mode": "markers",
        "x": plot.rounded(plot.display(across, [speed], data)),
        "y": plot.rounded(plot.display(up, [fact.torque], data)),
        # The number of a contour can be read inside.
        "marker": {"symbol": "circle-open", "size": 20, "color": "#222", "line": {"width": 2}},
        "hovertemplate": "operating point<extra></extra>",
    }
    return plot.Figure(
        f"{chart.name}_{name}",
        titled(name, data),
        [heat, point],
        plot.layout(show.axis_title(across, data), show.axis_title(up, data)),
        f"The ring marks the operating point.{_beginning(name, data, chart, shown)}{uniform}",
    )


def _same(name: str, data: xr.Dataset) -> str:
    """Value of a map that is of one colour beside others that are not; empty for others."""
    low, high = _ends(data[name].values)
    return "" if high > low else f" {show.quantity(name, low, of=data)} throughout, to four digits."


def _beginning(name: str, data: xr.Dataset, chart: Chart, shown: Mapping[str, Any]) -> str:
    """Where a map begins that leaves out rest; empty for others."""
    across, up = chart.axes
    if len(shown["x"]) == data.sizes[across] or min(shown["x"]) < 0.0:
        return ""
    ends = (
        f"{show.number_text(shown[axis][0])}\u00a0{show.unit_of(of, data)}"
        for axis, of in (("x", across), ("y", up))
    )
    return f" From {' and '.join(ends)} on, the smallest that were computed above rest."


_EFFICIENCIES = ("mean_efficiency", "map_actuator_efficiency")

_SIGNED = ("mean_input_torque", "map_electrical_power")
"""Quantities whose scale has zero in its middle."""

_COLOURS: dict[str, dict[str, Any]] = {
    **{
        name: {"colorscale": plot.evenly("#8fa3cf", "#c9cdd0", "#ffe45c")} for name in _EFFICIENCIES
    },
    **{name: {"colorscale": plot.evenly("#e08a6d", "#f4f2ef", "#79a9d8")} for name in _SIGNED},
}
"""Colours of quantities of which little is not what is wanted; light, so that contours can be read."""

_AXES = {"torque": "temperature", "speed": "temperature", "temperature": "torque"}
"""For the axis of a figure, what its lines differ in."""


def efficiency_panel(outcomes: Mapping[str, Outcome], known: plot.Curves) -> plot.Panel:
    """Efficiency against torque, speed and temperature, lines through the operating point and beside it.

    Several laws have a figure each, with one scale of the efficiency.
    """
    seen = [
        (known[variant, law], outcome, position)
        for variant, outcome in outcomes.items()
        if "loss_map" in outcome.parts
        for position, law in enumerate(plot.laws(outcome.parts["loss_map"]))
    ]
    figures = [
        figure
        for axis, level_axis in _AXES.items()
        if _worth(axis, seen)
        for figure in _on_one_scale(
            {drawn[0].label: _lines(axis, level_axis, *drawn) for drawn in seen}
        )
    ]
    return plot.Panel(
        "Efficiency", figures, [curve for curve, *_ in seen] if len(seen) == 1 else []
    )


def _worth(axis: str, seen: list[tuple[plot.Curve, Outcome, int]]) -> bool:
    """True if there are enough values for a line."""
    return any(outcome.parts["loss_map"].sizes[axis] > 2 for _, outcome, _ in seen)


def _lines(axis: str, other: str, curve: plot.Curve, outcome: Outcome, law: int) -> plot.Figure:
    """Efficiency under one law, a line for each of some values of another axis."""
    data = outcome.parts["loss_map"].isel(law=law)
    (third,) = {"torque", "speed", "temperature"} - {axis, other}
    near = data.sel({third: getattr(operating_point(outcome), third)}, method="nearest")
    values = dict(zip(_spread(near[other].values, other), plot.DASHES, strict=False))
    drawn = [
        plot.line(
            curve,
            plot.display(axis, near[axis], data),
            plot.display("mean_efficiency", near["mean_efficiency"].sel({other: value})),
            show.unit_of("mean_efficiency"),
            line={"color": curve.colour, "dash": dash, "width": 2},
        )
        for value, dash in values.items()
    ]
    held = plot.level(third, float(near[third]), data)
    return plot.Figure(
        f"efficiency_{axis}",
        f"Mean efficiency against {show.described(axis, data).long_name}",
        drawn,
        plot.layout(show.axis_title(axis, data), plot.short_axis("mean_efficiency")),
        f"At {held}, which of the loss map is nearest to the operating point.",
        tuple(
            plot.Key(plot.level(other, value, data), plot.INK, dash)
            for value, dash in values.items()
        ),
        missing="Undefined here: no power is transmitted, or the mesh is locked.",
    )


def _on_one_scale(figures: Mapping[str, plot.Figure]) -> list[plot.Figure]:
    """The same figures, several with one range of their values and named by their curve."""
    if len(figures) < 2:
        return [*figures.values()]
    values = [
        y for it in figures.values() for trace in it.data for y in trace["y"] if y is not None
    ]
    edge = 0.05 * (max(values, default=1.0) - min(values, default=0.0))
    ends = [min(values, default=0.0) - edge, max(values, default=1.0) + edge]
    return [
        replace(
            it,
            name=f"{it.name}_{number}",
            title=f"{it.title}, {label}",
            layout={**it.layout, "yaxis": {**it.layout["yaxis"], "range": ends}},
        )
        for number, (label, it) in enumerate(figures.items())
    ]


def _spread(values: np.ndarray, name: str) -> list[float]:
    """At most so many values of an axis as there are dashes, from its least to its largest."""
    every = values[values > 0.0] if name == "torque" else values
    count = min(every.size, len(plot.DASHES))
    return [float(v) for v in every[np.linspace(0, every.size - 1, count).round().astype(int)]]


_LOSSY = 0.95
"""Efficiency at the operating point below which lines of it say more than the map does."""


def _lossy(outcome: Outcome) -> bool:
    point = outcome.parts.get("operation")
    lost = point is not None and bool((point["mean_efficiency"] < _LOSSY).any())
    return "running" in outcome.parts or lost


def _colours(outcomes: Mapping[str, Outcome]) -> str:
    """What blank cells and the colours of several maps mean, as sentences."""
    maps = [(outcome, outcome.parts["loss_map"]) for outcome in outcomes.values()]
    locked = any(bool((data["locked"] & (data["torque"] > 0.0)).any()) for _, data in maps)
    blank = " Blank cells: friction locks the mesh there." if locked else ""
    outside = [
        plot.law_title(outcome, plot.laws(d)[k])
        for outcome, d in maps
        for k in np.flatnonzero(~_holds(outcome, d))
    ]
    shared = f"{blank} All choices share one colour scale"
    if not outside or not any(_holds(outcome, data).any() for outcome, data in maps):
        return f"{shared}."
    return (
        f"{shared}, that of the laws in their range: under {', '.join(dict.fromkeys(outside))} values "
        "beyond it have the colour of its end."
    )


def _blocks(page: Page) -> Iterator[Block]:
    there = page.having("loss_map")
    data = next(iter(there.values())).parts["loss_map"]
    load = show.described("torque", data).long_name
    yield Paragraph(
        f"Mean loss and mean efficiency over driver speed and {load}. At zero {load.split()[-1]} or zero "
        f"speed no power is transmitted and the efficiency is undefined.{_colours(there)}"
    )
    if alone := coverage_sentences([outcome.parts for outcome in there.values()]):
        yield Paragraph(alone, "note")
    yield from map_blocks(map_panel(there, page.curves))
    lines = efficiency_panel(
        {n: outcome for n, outcome in there.items() if _lossy(outcome)}, page.curves
    )
    if lines.figures:
        yield Heading("Efficiency against load, speed and temperature")
        yield lines


LOSS_MAP = Section(
    name="map",
    title="Loss map",
    short="Loss map",
    order=700.0,
    parts=("loss_map",),
    blocks=_blocks,
    main_figure="map_mean_loss",
)
