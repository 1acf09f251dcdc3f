"""Diagram of Campbell: frequencies of orders over the driver's speed, with natural frequencies."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.views import show
from pitchpoint.views.figures import Figure, Key, Trace, display, layout, legend_line

__all__ = ["campbell"]

_ROOM = (1.04, 1.06)
"""Of the axes for marks at the ends of the lines."""

_APART = 0.06, 0.09
"""Of the axes between marks that do not touch: a figure on paper is lower than on the screen."""

_LABEL: dict[str, Any] = {
    "showarrow": False,
    "xanchor": "left",
    "yanchor": "bottom",
    "font": {"size": 11},
}


def campbell(
    name: str,
    data: xr.Dataset,
    orders: Sequence[tuple[Key, float]],
    natural: Sequence[tuple[Key, float]],
    most: float,
    *,
    marked: bool = False,
) -> Figure:
    """Frequencies over speed.

    Args:
        name: of the figure.
        data: with the speeds of the driver.
        orders: entry of the legend, and frequency for a unit of speed [Hz s/rad].
        natural: entry of the legend, and natural frequency [Hz].
        most: highest frequency [Hz].
        marked: True if lines of orders have their words at their ends, as far as there is room for them.
    """
    fastest = float(data["speed"].values[-1])
    ends = display("speed", np.array([0.0, fastest]), data)
    traces: list[Trace] = []
    marks, unit = [], show.unit_of("natural_frequency")
    for key, order in orders:
        line = np.array([0.0, min(fastest, most / order)])
        x, y = display("speed", line, data), display("natural_frequency", order * line)
        traces.append(legend_line(key, x, y, unit))
        marks.append({"text": key.label, "x": float(x[1]), "y": float(y[1])} | _LABEL)
    for key, value in natural:
        traces.append(legend_line(key, ends, display("natural_frequency", np.full(2, value)), unit))
    room = _ROOM if marked else (1.0, 1.0)
    highest = float(display("natural_frequency", most))
    words = {"annotations": _legible(marks, float(ends[1]), highest)} if marked else {}
    axes = layout(
        show.axis_title("speed", data),
        f"frequency [{unit}]",
        xaxis={"range": [0.0, room[0] * float(ends[1])]},
        yaxis={"range": [0.0, room[1] * highest]},
        **words,
    )
    keys = tuple(key for key, _ in (*orders, *natural))
    return Figure(
        name,
        "Frequencies of the waves against driver speed",
        traces,
        axes,
        "Where a wave crosses a natural frequency lies a critical speed (Campbell's diagram).",
        keys,
    )


def _legible(marks: Sequence[Trace], fastest: float, highest: float) -> list[Trace]:
    """Those of some marks that do not stand on the one before."""
    legible: list[Trace] = []
    for mark in marks:
        across, up = _APART[0] * fastest, _APART[1] * highest
        touching = [
            k for k in legible if abs(mark["x"] - k["x"]) < across and abs(mark["y"] - k["y"]) < up
        ]
        if not touching:
            legible.append(mark)
    return legible
