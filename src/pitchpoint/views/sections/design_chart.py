"""Design chart: contact ratio, vibration and stiffness against profile shift, with its limits."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.studies import is_study
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.inputs import input_value
from pitchpoint.views.lines import titled

__all__ = ["design_charts", "is_design_chart"]

_SHOWN = ("contact_ratio", "transmission_error_range", "mean_stiffness", "tip_thickness_1")
_UNDERCUT, _CUT_BACK = "#fbe9e2", "#fdf5dc"
_AXIS = "profile shift x1"

Seen = Sequence[tuple[plot.Key, xr.Dataset]]


def is_design_chart(data: xr.Dataset) -> bool:
    """True for a study that sweeps the profile shift and knows what follows from it."""
    return (
        data.attrs.get("sweep_key") in ("gears.profile_shift", "gears.profile_shift.1")
        and "axis" in data
        and bool(np.isfinite(data["axis"].values).all())
        and {"contact_ratio", "undercut_limit_1"} <= set(data.data_vars)
    )


def design_charts(outcomes: Mapping[str, Outcome]) -> list[plot.Panel]:
    """A panel for each study of the profile shift with more than two points."""
    return [
        _chart(name, outcomes, seen)
        for name, seen in _studies(outcomes)
        if any(data.sizes["point"] > 2 for _, data in seen)
    ]


def _studies(outcomes: Mapping[str, Outcome]) -> Iterator[tuple[str, Seen]]:
    by_name: dict[str, list[tuple[str, xr.Dataset]]] = {}
    for variant, outcome in outcomes.items():
        for name, data in outcome.parts.items():
            if is_study(name) and is_design_chart(data):
                by_name.setdefault(name, []).append((variant, data))
    for name, charts in by_name.items():
        yield (
            name,
            [
                (plot.Key(variant, plot.PALETTE[k % len(plot.PALETTE)]), data)
                for k, (variant, data) in enumerate(charts)
            ],
        )


def _chart(name: str, outcomes: Mapping[str, Outcome], seen: Seen) -> plot.Panel:
    data = seen[0][1]
    least = _least_tip(next(iter(outcomes.values())), data)
    limits = _Limits(data, least)
    figures = [
        _figure(f"chart_{name}_{variable}", variable, seen, limits)
        for variable in _SHOWN
        if variable in data
    ]
    return plot.Panel(f"{data.attrs['title']}: design chart", figures, note=limits.words)


class _Limits:
    """Undercut and shortened tips in the range of a sweep.

    Attributes:
        shapes: of a layout, regions behind the curves.
        annotations: of a layout.
        words: what they mean.
        least: least tip thickness asked for [m]; zero if none was.
    """

    def __init__(self, data: xr.Dataset, least: float) -> None:
        self.shapes: list[dict[str, Any]] = []
        self.annotations: list[dict[str, Any]] = []
        self.least = least
        sentences: list[str] = []
        x = np.sort(data["axis"].values)
        order = np.argsort(data["axis"].values)
        self._undercut(x, data["undercut_limit_1"].values[0][order], sentences)
        if least > 0.0 and "tip_thickness_1" in data:
            self._tips(x, data["tip_thickness_1"].values[0][order], sentences)
        self.words = " ".join(sentences)

    def _undercut(self, x: np.ndarray, limit: np.ndarray, told: list[str]) -> None:
        below = x < limit
        if not below.any():
            told.append("No undercut in this range: x1 is above x_min1 throughout.")
            return
        highest = int(np.flatnonzero(below)[-1])
        edge = float(limit[highest]) if highest + 1 < x.size else float(x[-1])
        self._region(float(x[0]), edge, _UNDERCUT, "undercut", "left")
        told.append(
            "Shaded on the left: the rack undercuts gear 1, x1 below x_min1 = "
            f"{show.number_text(limit[highest])}."
        )

    def _tips(self, x: np.ndarray, thickness: np.ndarray, told: list[str]) -> None:
        cut = thickness <= self.least * (1.0 + 1e-6)
        shown = f"{show.quantity('tip_thickness_1', self.least)}"
        if not cut.any():
            told.append(f"No tip is cut back: all are thicker than the {shown} asked for.")
        elif cut.all():
            told.append(f"The tip of gear 1 is cut back to {shown} throughout.")
        else:
            lowest = float(x[np.flatnonzero(cut)[0]])
            self._region(lowest, float(x[-1]), _CUT_BACK, "tip cut back", "right")
            told.append(f"Shaded on the right: the tip of gear 1 is cut back to {shown}.")

    def _region(self, low: float, high: float, colour: str, words: str, side: str) -> None:
        self.shapes += [
            {"type": "rect", "x0": low, "x1": high, "yref": "paper", "y0": 0, "y1": 1}
            | {"fillcolor": colour, "line": {"width": 0}, "layer": "below"},
            {"type": "line", "x0": high if side == "left" else low, "yref": "paper", "y0": 0}
            | {"x1": high if side == "left" else low, "y1": 1, "layer": "below"}
            | {"line": {"color": "#b07c5a", "width": 1.5, "dash": "dash"}},
        ]
        self.annotations.append(
            {"text": words, "x": low if side == "left" else high, "xanchor": side}
            | {"yref": "paper", "y": 1, "yanchor": "bottom", "showarrow": False}
            | {"font": {"size": 11, "color": "#7a6a4f"}}
        )


def _figure(name: str, variable: str, seen: Seen, limits: _Limits) -> plot.Figure:
    unit = show.display_unit(VARIABLES[variable].display)
    traces = []
    for key, data in seen:
        order = np.argsort(data["axis"].values)
        values = plot.display(variable, _valid(variable, data)[order])
        marks = {"mode": "lines+markers", "marker": {"size": 5, "color": key.colour}}
        traces.append(plot.legend_line(key, data["axis"].values[order], values, unit, **marks))
    shapes = list(limits.shapes)
    if variable == "tip_thickness_1" and limits.least > 0.0:
        level = float(plot.display(variable, limits.least))
        shapes.append(
            {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": level, "y1": level}
            | {"line": {"color": "#5b6873", "width": 1, "dash": "dot"}}
        )
    axis = {"rangemode": "tozero"} if variable == "tip_thickness_1" else {}
    return plot.Figure(
        name,
        titled(variable),
        traces,
        plot.layout(
            _AXIS,
            plot.short_axis(variable),
            yaxis=axis,
            shapes=shapes,
            annotations=limits.annotations,
        ),
        "Dotted: least thickness asked for." if len(shapes) > len(limits.shapes) else "",
        tuple(key for key, _ in seen) if len(seen) > 1 else (),
    )


def _valid(variable: str, data: xr.Dataset) -> np.ndarray:
    """Values [point], those of a vibration only where there is a steady state."""
    values = np.asarray(data[variable].values[0], dtype=float)
    if variable == "transmission_error_range" and "vibration_status" in data:
        values = np.where(data["vibration_status"].values[0] == 0, values, np.nan)
    return values


def _least_tip(outcome: Outcome, data: xr.Dataset) -> float:
    """Least tip thickness asked for [m]; zero if none was."""
    thickness = input_value(outcome, "gears", "least_tip_thickness")
    if thickness is None or "module" not in data:
        return 0.0
    return float(thickness) * float(data["module"].values.ravel()[0])
