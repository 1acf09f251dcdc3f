"""A tooth on its way into its space, and the clearance along the wave."""

from math import degrees

import numpy as np
import xarray as xr

from pitchpoint.results.variable import length
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.outlines import simplified
from pitchpoint.views.point import operating_point
from pitchpoint.views.way import at_origin, places_on_axis

__all__ = ["gap_panel"]

_LENGTH = length("", "")
_LEAST = 1e-8
"""Smallest clearance drawn [m]: flanks that slide on each other have none."""

_TEETH = plot.Key("teeth that carry", "#c0392b", "dot")


def gap_panel(outcome: Outcome, name: str) -> plot.Panel:
    """Path of a tooth into its space, and clearance along the wave.

    Args:
        outcome: a result whose teeth are carried by a wave.
        name: with which the figures begin in the page.
    """
    return plot.Panel(
        "", [_passing(f"{name}_passing", outcome), _clearance(f"{name}_gap", outcome)]
    )


def _clearance(name: str, outcome: Outcome) -> plot.Figure:
    """Clearance of unloaded flanks, with the teeth that carry at one moment."""
    teeth = outcome.parts["teeth"]
    angle = plot.display("clearance_angle", teeth["clearance_angle"].values)
    clearance = np.maximum(teeth["clearance"].values, _LEAST)
    unit = show.display_unit(VARIABLES["clearance"].display)
    key = plot.Key("clearance of the unloaded flanks", plot.PALETTE[0])
    traces = [plot.legend_line(key, angle, plot.display("clearance", clearance), unit)]
    keys = [key]
    least = f"{show.number_text(float(plot.display('clearance', _LEAST)))} {unit}"
    note = f"Clearances below {least} are drawn there: flanks without one slide on each other."
    places = _carrying(outcome)
    if places.size:
        there = np.interp(places, angle, plot.display("clearance", clearance))
        traces.append(
            plot.legend_line(_TEETH, places, there, unit)
            | {"mode": "markers", "marker": {"size": 7, "color": _TEETH.colour}}
        )
        keys.append(_TEETH)
        note = (
            f"Dots: the teeth of one end of the long axis that carry at "
            f"{_torque(outcome)} at one moment; load has closed their clearance. {note}"
        )
    ends = angle[np.isfinite(clearance)][[0, -1]].tolist()
    return plot.Figure(
        name,
        "Clearance along the wave",
        traces,
        plot.layout(
            _angle_axis(),
            plot.short_axis("clearance"),
            xaxis={"range": ends},
            yaxis={"type": "log", "dtick": 1, "exponentformat": "none"},
            shapes=[at_origin()],
        ),
        note,
        tuple(keys),
    )


def _angle_axis() -> str:
    variable = VARIABLES["clearance_angle"]
    return show.bracketed(f"{variable.long_name} {variable.symbol}", variable)


def _torque(outcome: Outcome) -> str:
    return show.quantity("torque", operating_point(outcome).torque)


def _carrying(outcome: Outcome) -> np.ndarray:
    """Angles of the teeth of one zone that carry at the start of the mesh cycle, as shown."""
    data = outcome.parts.get("cycle")
    if data is None:
        return np.zeros(0)
    half = data.sizes["pair"] // int(data["path"].attrs["zones"])
    carries = data["load"].values[0, 0, :half].max(axis=-1) > 0.0
    return plot.display("clearance_angle", np.radians(places_on_axis(data)[0, :half, 0][carries]))


def _passing(name: str, outcome: Outcome) -> plot.Figure:
    """One tooth in its space at several angles, seen from the circular spline."""
    teeth = outcome.parts["teeth"]
    low = float(teeth["space"].values[:, 1].min())
    angle = np.degrees(teeth["passing_angle"].values)
    shown = np.flatnonzero(teeth["passing"].values[..., 1].max(axis=1) > low - _reach(teeth))
    traces = [_space(teeth, low)]
    for k in shown:
        traces.append(_outline(teeth["passing"].values[k], low, float(angle[k]), _reach(teeth)))
    traces.append(_track(teeth["passing"].values[shown], low))
    wide, deep, height = (
        float(_LENGTH.displayed(size))
        for size in (
            np.abs(teeth["space"].values[:, 0]).max(),
            np.ptp(teeth["space"].values[:, 1]),
            np.ptp(teeth["tooth"].values[:, 1]),
        )
    )
    axis = {"constrain": "domain", "scaleanchor": "x", "scaleratio": 1}
    return plot.Figure(
        name,
        "Path of a tooth into its space",
        traces,
        plot.layout(
            show.bracketed("across", _LENGTH),
            show.bracketed("outwards", _LENGTH),
            xaxis={"range": [3.2 * wide, -3.2 * wide], "constrain": "domain"},
            yaxis={"range": [-1.15 * height, 1.2 * deep], **axis},
        ),
        f"Every {show.number_text(degrees(_step(teeth)))}° of p. Seen from the circular spline, "
        "which is shaded, outwards from its tip circle; positive rotation is to the left. Equal scale "
        "in both directions.",
        (
            plot.Key("tooth on the long axis, p = 0", plot.INK),
            plot.Key("p > 0", plot.PALETTE[0]),
            plot.Key("p < 0", plot.PALETTE[1]),
            plot.Key("middle of its tip", plot.GREY, "dash"),
        ),
    )


def _step(teeth: xr.Dataset) -> float:
    return float(np.diff(teeth["passing_angle"].values[:2])[0])


def _reach(teeth: xr.Dataset) -> float:
    """Distance inside the tip circle to which a tooth is shown [m]."""
    return 0.6 * float(np.ptp(teeth["tooth"].values[:, 1]))


def _space(teeth: xr.Dataset, low: float) -> plot.Trace:
    """The circular spline around the space and half of its neighbours."""
    x, y = simplified(teeth["space"].values, 2e-7).T
    turns = np.exp(2j * np.pi * np.array([-1, 0, 1]) / float(teeth["teeth"].values[1]))
    places = (turns[:, None] * (y + 1j * x)).ravel() - low
    across, outwards = (_LENGTH.displayed(part) for part in (places.imag, places.real))
    deep = 1.3 * float(outwards.max())
    ends = across[[-1, 0]].tolist()
    return {
        "type": "scatter",
        "mode": "lines",
        "x": plot.rounded([*across.tolist(), *ends]),
        "y": plot.rounded([*outwards.tolist(), deep, deep]),
        "fill": "toself",
        "fillcolor": "#ece5d6",
        "line": {"color": "#8a7b55", "width": 1.5},
        "hoverinfo": "skip",
    }


def _outline(corners: np.ndarray, low: float, angle: float, reach: float) -> plot.Trace:
    colour = plot.INK if abs(angle) < 1e-9 else plot.PALETTE[0] if angle > 0.0 else plot.PALETTE[1]
    x, y = _LENGTH.displayed(simplified(corners, 1e-6) - np.array([0.0, low])).T
    return {
        "type": "scatter",
        "mode": "lines",
        "x": plot.rounded(x, 4),
        "y": plot.rounded(y, 4),
        "line": {"color": colour, "width": 2.4 if colour == plot.INK else 0.9},
        "hovertemplate": f"p = {show.number_text(angle)}°<extra></extra>",
    }


def _track(passing: np.ndarray, low: float) -> plot.Trace:
    middle = passing.shape[1] // 2
    x, y = _LENGTH.displayed(
        passing[:, middle - 1 : middle + 1].mean(axis=1) - np.array([0.0, low])
    ).T
    return {
        "type": "scatter",
        "mode": "lines",
        "x": plot.rounded(x, 4),
        "y": plot.rounded(y, 4),
        "line": {"color": plot.GREY, "width": 1.2, "dash": "dash"},
        "hoverinfo": "skip",
    }
