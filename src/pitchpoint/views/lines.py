"""Lines over the mesh cycle and along the way of a pair: gaps at events, bands of lubrication regimes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.views import figures as plot
from pitchpoint.views import show

__all__ = [
    "REGIMES",
    "REGRESSED",
    "SHORT",
    "Points",
    "folded",
    "gapped",
    "overlaid",
    "regimes",
    "titled",
    "values_of",
]

_EVENT, SHORT = 1e-7, 1e-6
"""Nodes beside an event are closer than the first; a segment shorter than the second is no segment."""

_REGIMES = (
    (-np.inf, 1.0, "#fbe9e2", "boundary"),
    (1.0, 3.0, "#fdf5dc", "mixed"),
    (3.0, np.inf, "#e7f2ea", "full film"),
)

_LEAST_BAND = 0.08
"""Part of the axis under which a band has no room for its name."""

REGRESSED = "The regimes are those of film laws for smooth surfaces."

REGIMES = f"Below 1 boundary, 1 to 3 mixed, above 3 full film. {REGRESSED}"
"""What the bands of the lubrication regimes mean."""

Points = tuple[np.ndarray, np.ndarray]


def gapped(x: np.ndarray, y: np.ndarray) -> Points:
    """Points with a gap (NaN) at every event, so that no line crosses a jump."""
    cuts = np.flatnonzero(np.abs(np.diff(x)) < _EVENT) + 1
    parts = [
        part for part in np.split(np.arange(x.size), cuts) if part.size and np.ptp(x[part]) > SHORT
    ]
    if not parts:
        return x[:0], y[:0]
    gap = np.array([np.nan])
    return (
        np.concatenate([piece for part in parts for piece in (x[part], x[part[-1:]])]),
        np.concatenate([piece for part in parts for piece in (y[part], gap)]),
    )


def folded(phase: np.ndarray, values: np.ndarray) -> Points:
    """Values of one period in the order of their phases from 0 to 1, wherever the period begins.

    At both ends stands what lies between the last value and the first one of the next period.

    Example:
        >>> import numpy as np
        >>> folded(np.array([0.5, 1.0, 1.25]), np.array([2.0, 4.0, 5.0]))
        (array([0.  , 0.25, 0.5 , 1.  , 1.  ]), array([4., 5., 2., 4., 4.]))
    """
    inside = np.where(phase > 1.0, phase - 1.0, phase)
    order = np.argsort(inside, kind="stable")
    x, y = inside[order], values[order]
    end = float(np.interp(1.0, [x[-1], x[0] + 1.0], [y[-1], y[0]]))
    return np.concatenate([[0.0], x, [1.0]]), np.concatenate([[end], y, [end]])


def values_of(data: xr.Dataset, name: str) -> np.ndarray:
    """SI values of a mesh cycle by name; "loss" is all of it."""
    if name == "loss":
        return np.asarray((data["sliding_loss"] + data["rolling_loss"]).values)
    return np.asarray(data[name].values)


def overlaid(
    name: str, title: str, across: str, up: str, designs: Mapping[str, xr.Dataset]
) -> plot.Figure:
    """One variable of several designs over another, a line for each that has it in the units of the first.

    Args:
        name: of the figure in the page.
        title: of the figure.
        across, up: variables on its axes.
        designs: datasets by design.
    """
    like = next(iter(designs.values()))
    alike = {
        design: data
        for design, data in designs.items()
        if [show.unit_of(variable, data) for variable in (across, up)]
        == [show.unit_of(variable, like) for variable in (across, up)]
    }
    keys = [
        plot.Key(
            design,
            plot.PALETTE[k % len(plot.PALETTE)],
            plot.DASHES[k // len(plot.PALETTE) % len(plot.DASHES)],
        )
        for k, design in enumerate(alike)
    ]
    traces = [
        plot.legend_line(
            key,
            *plot.continued(
                plot.display(across, data[across].values, data),
                plot.display(up, data[up].values, data),
            ),
            show.unit_of(up, data),
        )
        for key, data in zip(keys, alike.values(), strict=True)
    ]
    axes = plot.layout(
        show.axis_title(across, like), plot.short_axis(up, like), yaxis={"rangemode": "tozero"}
    )
    return plot.Figure(name, title, traces, axes, keys=tuple(keys))


def titled(name: str, of: Any = None) -> str:
    """Long name of a variable as a title, see `show.described`."""
    words = show.described(name, of).long_name
    return words[0].upper() + words[1:]


def regimes(look: dict[str, Any], traces: list[plot.Trace]) -> None:
    """Bands of the lubrication regimes behind the curves; sets the range of the axis of values.

    Args:
        look: layout with lists of shapes and annotations.
        traces: curves of the film thickness over the roughness.
    """
    values = [y for t in traces for y in t["y"] if y is not None]
    top = max(1.25, 1.1 * max(values, default=1.0))
    bottom = min(1.1 * min(values, default=0.0), 0.0)  # mean planes of rough flanks may overlap
    if look["yaxis"].get("type") == "log":
        bottom = 0.7 * min(values)
        top *= 1.3
    if "range" in look["yaxis"]:
        bottom, top = (10.0**end for end in look["yaxis"]["range"])
        top = max(top, 1.25)
    look["yaxis"]["range"] = [_place(bottom, bottom), _place(top, bottom)]
    span = look["yaxis"]["range"][1] - look["yaxis"]["range"][0]
    bands = [band for band in _REGIMES if bottom < band[1] and band[0] < top]
    for low, high, colour, words in bands:
        ends = {"y0": max(low, bottom), "y1": min(high, top)}
        look["shapes"].insert(
            0,
            {"type": "rect", "xref": "paper", "x0": 0, "x1": 1, **ends}
            | {"fillcolor": colour, "line": {"width": 0}, "layer": "below"},
        )
        part = (_place(ends["y1"], bottom) - _place(ends["y0"], bottom)) / span
        if part < _LEAST_BAND:
            continue
        name = _place(ends["y1"], bottom)
        side = _free_side(traces, (name - _BESIDE * span, name), bottom)
        look["annotations"].append(
            {"text": words, "xref": "paper", "x": _ENDS[side], "xanchor": side, "showarrow": False}
            | {"y": _place(ends["y1"], bottom), "yanchor": "top", "yshift": 3}
            | {"font": {"size": 11, "color": "#7a6a4f"}}
        )


_ENDS = {"left": 0.01, "right": 0.99}
_BESIDE, _LAST = 0.16, 0.25
"""Height of the name of a band and what it may come close to, and its length, as parts of the axes."""


def _free_side(traces: list[plot.Trace], heights: tuple[float, float], bottom: float) -> str:
    """Side on which fewer points of curves lie at the heights of a name; the right one at a tie."""
    x, y = (
        np.array([np.nan if v is None else v for t in traces for v in t[name]]) for name in "xy"
    )
    if not np.isfinite(x).any():  # curves of an idle drive
        return "right"
    with np.errstate(invalid="ignore"):
        at = np.array([_place(max(value, bottom), bottom) for value in y])
        met = (heights[0] <= at) & (at <= heights[1])
        low, high = np.nanmin(x), np.nanmax(x)
        place = (x - low) / max(high - low, SHORT)
        left, right = (np.count_nonzero(met & far) for far in (place < _LAST, place > 1.0 - _LAST))
    return "left" if left < right else "right"


def _place(value: float, bottom: float) -> float:
    """Place on the axis: logarithmic axes, which begin above zero, count in powers of ten."""
    return float(np.log10(value)) if bottom > 0.0 else value
