"""Loss and efficiency over torque, speed and temperature."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.figures import covered
from pitchpoint.results.rounding import ROUNDING
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import (
    DASHES,
    INK,
    Choice,
    Curve,
    Curves,
    Figure,
    Key,
    Menu,
    Panel,
    Trace,
    display,
    laws,
    layout,
    level,
    line,
    rounded,
    short_axis,
)
from pitchpoint.views.lines import titled
from pitchpoint.views.point import operating_point
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Section

__all__ = ["LOSS_MAP", "Chart", "efficiency_panel", "map_panel"]

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
        return {n: one.parts[self.part] for n, one in outcomes.items() if self.part in one.parts}


OF_DRIVER = Chart(
    "loss_map", "Loss map", ("speed", "torque"), ("mean_loss", "mean_efficiency"), "map"
)


def map_panel(outcomes: Mapping[str, Outcome], known: Curves, chart: Chart = OF_DRIVER) -> Panel:
    """Heat maps of loss and efficiency with a menu for law, variant and temperature."""
    choices = list(_choices(outcomes, chart))
    if not choices:
        return Panel(chart.title, [])
    first = min(range(len(choices)), key=lambda at: choices[at][0])
    _, variant, position, law = choices[first]
    scales = {name: _scale(name, outcomes, chart) for name in chart.shown}
    figures = [
        _figure(name, outcomes[variant], chart, law, position, scales[name]) for name in chart.shown
    ]
    menu = [_choice(outcomes, known, chart, *choice[1:]) for choice in choices]
    menus = _menus(outcomes, known, chart) if len(choices) > 1 else []
    return Panel(chart.title, figures, choices=menu, menu="Shown for", menus=menus, at=first)


def _menus(outcomes: Mapping[str, Outcome], known: Curves, chart: Chart) -> list[Menu]:
    """Menus for law and for temperature; none where variants have their maps at others."""
    maps = chart.of(outcomes)
    degrees = {tuple(data["temperature"].values.tolist()) for data in maps.values()}
    labels = [known[name, law].label for name, data in maps.items() for law in laws(data)]
    if len(degrees) > 1:
        return []
    told = [level("temperature", degree) for degree in degrees.pop()]
    each = [Menu("Friction", labels), Menu("Oil at", told)]
    return [menu for menu in each if len(menu.labels) > 1]


def _scale(name: str, outcomes: Mapping[str, Outcome], chart: Chart) -> dict[str, float]:
    """Ends of the colour scale that all maps of a quantity share; none where nothing is known."""
    maps = [data[name] for data in chart.of(outcomes).values()]
    values = np.concatenate([display(name, each.values).ravel() for each in maps])
    values = values[np.isfinite(values)]
    if not values.size or not np.ptp(values) > ROUNDING * np.abs(values).max():
        return {}
    return {"zmin": float(values.min()), "zmax": float(values.max())}


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
    known: Curves,
    chart: Chart,
    variant: str,
    position: int,
    law: int,
) -> Choice:
    data = outcomes[variant].parts[chart.part]
    curve = known[variant, laws(data)[law]]
    degree = level("temperature", float(data["temperature"].values[position]))
    changes: dict[str, list[Any]] = {}
    for name in chart.shown:
        heat = _heat(name, data, chart, law, position)
        changes[f"{chart.name}_{name}"] = [{key: [values] for key, values in heat.items()}, {}, [0]]
    return Choice(f"{curve.label}, oil at {degree}", changes)


def _heat(name: str, data: xr.Dataset, chart: Chart, law: int, temperature: int) -> dict[str, Any]:
    """Axes and values, thinned where there are more than a page can show."""
    across, up = chart.axes
    values = data[name].transpose("law", "temperature", up, across).values[law, temperature]
    rows, columns = (_thinned(size) for size in values.shape)
    return {
        "x": rounded(display(across, data[across].values[columns], data)),
        "y": rounded(display(up, data[up].values[rows], data)),
        "z": rounded(display(name, values[np.ix_(rows, columns)], data)),
    }


def _thinned(size: int) -> np.ndarray:
    return np.unique(np.linspace(0, size - 1, min(size, _MOST)).round().astype(int))


def _figure(
    name: str,
    outcome: Outcome,
    chart: Chart,
    law: int,
    temperature: int,
    scale: Mapping[str, float],
) -> Figure:
    data, fact, (across, up) = outcome.parts[chart.part], operating_point(outcome), chart.axes
    unit, units = show.unit_of(name, data), [show.unit_of(one, data) for one in chart.axes]
    speed = fact.speed * float(data.attrs.get("speed_ratio", 1.0))
    heat = {
        "type": "contour",
        **_heat(name, data, chart, law, temperature),
        **_COLOURS.get(name, {"colorscale": "YlOrRd", "reversescale": True}),
        "hoverongaps": False,
        **scale,
        "zauto": not scale,
        "contours": {"coloring": "heatmap", "showlabels": True, "labelfont": {"size": 11}},
        "line": {"color": INK, "width": 0.7},
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~g}} {unit}<br>%{{x:.4~g}} {units[0]}, %{{y:.4~g}} {units[1]}"
        "<extra></extra>",
    }
    point = {
        "type": "scatter",
        "mode": "markers",
        "x": rounded(display(across, [speed], data)),
        "y": rounded(display(up, [fact.torque], data)),
        "marker": {
            "symbol": "x",
            "size": 10,
            "color": "#fff",
            "line": {"color": "#222", "width": 1.5},
        },
        "hovertemplate": "operating point<extra></extra>",
    }
    return Figure(
        f"{chart.name}_{name}",
        titled(name, data),
        [heat, point],
        layout(show.axis_title(across, data), show.axis_title(up, data)),
        "The cross marks the operating point.",
    )


_COLOURS: dict[str, dict[str, Any]] = {
    "mean_efficiency": {"colorscale": "Cividis", "reversescale": False},
    "mean_input_torque": {"colorscale": "RdBu", "reversescale": True, "zmid": 0.0},
}
"""Colours of quantities of which little is not what is wanted."""

_AXES = {"torque": "temperature", "speed": "temperature", "temperature": "torque"}
"""For the axis of a figure, what its lines differ in."""


def efficiency_panel(outcomes: Mapping[str, Outcome], known: Curves) -> Panel:
    """Efficiency against torque, speed and temperature, lines through the operating point and beside it."""
    seen = [
        (known[variant, law], outcome, position)
        for variant, outcome in outcomes.items()
        if "loss_map" in outcome.parts
        for position, law in enumerate(laws(outcome.parts["loss_map"]))
    ]
    figures = [_lines(axis, other, seen) for axis, other in _AXES.items() if _worth(axis, seen)]
    return Panel("Efficiency", figures, [curve for curve, *_ in seen])


def _worth(axis: str, seen: list[tuple[Curve, Outcome, int]]) -> bool:
    """True if there are enough values for a line."""
    return any(outcome.parts["loss_map"].sizes[axis] > 2 for _, outcome, _ in seen)


def _lines(axis: str, other: str, seen: list[tuple[Curve, Outcome, int]]) -> Figure:
    traces: list[Trace] = []
    unit = show.unit(VARIABLES["mean_efficiency"].display)
    values = _spread([o.parts["loss_map"][other].values for _, o, _ in seen], other)
    held: dict[str, None] = {}
    for curve, outcome, law in seen:
        data = outcome.parts["loss_map"].isel(law=law)
        (third,) = {"torque", "speed", "temperature"} - {axis, other}
        near = data.sel({third: getattr(operating_point(outcome), third)}, method="nearest")
        held[level(third, float(near[third]), data)] = None
        for dash, value in zip(DASHES, values, strict=False):
            if value not in near[other].values:
                continue
            found = near["mean_efficiency"].sel({other: value})
            trace = line(
                curve, display(axis, near[axis], data), display("mean_efficiency", found), unit
            )
            trace["line"] = {"color": curve.colour, "dash": dash, "width": 2}
            traces.append(trace)
    like = seen[0][1].parts["loss_map"]
    words = show.described(axis, like).long_name
    return Figure(
        f"efficiency_{axis}",
        f"Mean efficiency against {words}",
        traces,
        layout(show.axis_title(axis, like), short_axis("mean_efficiency")),
        f"At {' and '.join(held)}, which of the loss map is nearest to the operating point.",
        tuple(
            Key(level(other, value, like), INK, dash)
            for dash, value in zip(DASHES, values, strict=False)
        ),
        missing="Undefined here: no power is transmitted, or the mesh is locked.",
    )


def _spread(axes: list[np.ndarray], name: str) -> list[float]:
    """At most so many values of an axis as there are dashes, from its least to its largest."""
    every = np.unique(np.concatenate(axes))
    if name == "torque":
        every = every[every > 0.0]
    count = min(every.size, len(DASHES))
    return [float(v) for v in every[np.linspace(0, every.size - 1, count).round().astype(int)]]


_LOSSY = 0.95
"""Efficiency at the operating point below which lines of it say more than the map does."""


def _lossy(outcome: Outcome) -> bool:
    point = outcome.parts.get("operation")
    lost = point is not None and bool((point["mean_efficiency"] < _LOSSY).any())
    return "running" in outcome.parts or lost


def _blocks(page: Page) -> Iterator[Block]:
    there = page.having("loss_map")
    data = next(iter(there.values())).parts["loss_map"]
    load = show.described("torque", data).long_name
    yield Paragraph(
        f"Mean loss and mean efficiency over driver speed and {load}. At zero {load.split()[-1]} or zero "
        "speed no power is transmitted and the efficiency is undefined; those cells are blank. All choices "
        "share one colour scale."
    )
    if alone := covered(one.parts for one in there.values()):
        yield Paragraph(alone, "note")
    yield map_panel(there, page.curves)
    lines = efficiency_panel({n: one for n, one in there.items() if _lossy(one)}, page.curves)
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
)
