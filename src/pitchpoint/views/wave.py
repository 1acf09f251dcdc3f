"""Teeth on their way along a wave: path into the gap, clearance, and the state of the contacts."""

from collections.abc import Iterator, Mapping
from math import degrees
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.cycle import regimes
from pitchpoint.views.drive import arc_of, loaded_arcs, simplified
from pitchpoint.views.facts import Wave, operating_point, wave
from pitchpoint.views.figures import (
    GREY,
    INK,
    PALETTE,
    Curve,
    Curves,
    Figure,
    Key,
    Panel,
    Trace,
    continued,
    display,
    laws,
    layout,
    line,
    merged,
    plain,
    rounded,
    short_axis,
)

__all__ = ["ANGLE", "arc_panel", "gap_panel", "told_arcs", "wave_losses", "wave_sentence"]

ANGLE = "angle from the long axis p [°]"
_ARC = {
    "load": "It leaps where the contact passes from the root of a tooth to its tip.",
    "pressure": "By Hertz, for the load on the tooth and the radius of its contact; elastic steel, high on "
    "the roundings of root and tip, which wear.",
    "radius": "Where an edge touches it is small, where flanks fit into each other it is large.",
    "entrainment": "Mean speed of both flanks against their contact; it draws the oil in.",
    "sliding_velocity": "Flexspline over circular spline; teeth slide most far from the long axis.",
    "film_thickness": "",
    "lambda_ratio": "Below 1 boundary, 1 to 3 mixed, above 3 full film.",
    "friction": "",
    "loss": "Loss of the one tooth that is at this place.",
}
_POSITIVE = ("pressure", "radius", "entrainment", "film_thickness", "lambda_ratio")
_WIDE = 30.0
"""Ratio of the largest to the smallest value above which an axis is logarithmic."""

_LEAST = 1e-8
"""Smallest clearance drawn [m]: flanks that slide on each other have none."""

_TEETH = Key("teeth that carry", "#c0392b", "dot")


def gap_panel(outcome: Outcome, name: str) -> Panel:
    """Path of a tooth into its space, and clearance along the wave.

    Args:
        outcome: a result whose teeth are carried by a wave.
        name: with which the figures begin in the page.
    """
    return Panel("", [_passing(f"{name}_passing", outcome), _clearance(f"{name}_gap", outcome)])


def arc_panel(outcomes: Mapping[str, Outcome], known: Curves) -> Panel:
    """Quantities of one tooth on its way along the wave, over its angle from the long axis."""
    seen = list(_seen(outcomes, known))
    figures = [_arc_figure(name, seen) for name in _ARC] if seen else []
    return Panel("Along the wave", figures, [curve for curve, *_ in seen])


def wave_losses(outcome: Outcome, law: int) -> dict[str, float]:
    """Power lost where teeth go in, where they come out, and beside the teeth [W].

    Args:
        outcome: with a mesh cycle.
        law: position of the law.
    """
    data, fact = outcome.parts["cycle"], wave(outcome)
    each = (data["sliding_loss"] + data["rolling_loss"]).values[law]
    energy = each * data["weight"].values[:, None, None] / data["weight"].values.sum()
    inwards = arc_of(data) > 0.0 if fact.backwards else arc_of(data) < 0.0
    beside = outcome.parts.get("operation")
    return {
        "in": float(energy[inwards].sum()),
        "out": float(energy[~inwards].sum()),
        "beside": 0.0 if beside is None else float(beside["mean_drag_loss"].values[law, 0]),
    }


def wave_sentence(lost: Mapping[str, float]) -> str:
    """Where the loss is made, in words."""
    whole = sum(lost.values())
    if not whole > 0.0:
        return "There is no loss."
    share = {name: f"{100 * value / whole:.0f} %" for name, value in lost.items()}
    both = f"{100 * (lost['in'] + lost['out']) / whole:.0f} % in the teeth"
    told = (
        f"{both}: {share['in']} before they reach the long axis, on their way in, and "
        f"{share['out']} after it, on their way out"
    )
    return f"{told}; {share['beside']} beside the teeth." if lost["beside"] else f"{told}."


def _seen(
    outcomes: Mapping[str, Outcome], known: Curves
) -> Iterator[tuple[Curve, xr.Dataset, int, Wave]]:
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data = outcome.parts["cycle"]
            for position, law in enumerate(laws(data)):
                yield known[variant, law], data, position, wave(outcome)


def _values(data: xr.Dataset, name: str, law: int) -> np.ndarray:
    if name == "loss":
        return np.asarray((data["sliding_loss"] + data["rolling_loss"]).values[law])
    return np.asarray(data[name].values[law])


def _along(data: xr.Dataset, name: str, law: int) -> tuple[np.ndarray, np.ndarray]:
    """Angle [deg] and SI value of a tooth in one zone; NaN where it does not carry.

    Every node of every pair is one place of the same way; the zones at both ends are alike.
    """
    half = data.sizes["pair"] // 2
    angle = np.degrees(arc_of(data)[:, :half]).ravel()
    order = np.argsort(angle, kind="stable")
    load = data["load"].values[law][:, :half].ravel()[order]
    values = _values(data, name, law)[:, :half].ravel()[order]
    near = _beside(load > 0.0)
    if not near.any():
        return angle[:0], load[:0]
    values = np.where(load > 0.0, values, 0.0 if name in ("load", "loss") else np.nan)
    return continued(angle[order][near], values[near], most=400)


def _beside(carries: np.ndarray) -> np.ndarray:
    """True for nodes that carry and for their neighbours."""
    wide = carries.copy()
    wide[1:] |= carries[:-1]
    wide[:-1] |= carries[1:]
    return wide


def _arc_figure(name: str, seen: list[tuple[Curve, xr.Dataset, int, Wave]]) -> Figure:
    unit = show.unit(VARIABLES[name].display)
    traces = []
    for curve, data, law, _ in seen:
        x, y = _along(data, name, law)
        traces.append(line(curve, x, display(name, y), unit))
    shown, same = merged(traces)
    words = VARIABLES[name].long_name
    title = "Loss of a pair" if name == "loss" else words[0].upper() + words[1:]
    look = layout(
        ANGLE, short_axis(name), xaxis={"range": _range(seen)}, shapes=[_axis()], annotations=[]
    )
    cut = ""
    if name not in _POSITIVE and name != "sliding_velocity":
        look["yaxis"]["rangemode"] = "tozero"
    elif name in _POSITIVE and _scale(look, shown):
        cut = "The outermost values are outside the figure."
    if name == "lambda_ratio":
        regimes(look, shown)
    note = " ".join(filter(None, (_ARC[name], cut, same)))
    return Figure(f"arc_{name}", title, shown, look, note, missing="No tooth carries.")


def _range(seen: list[tuple[Curve, xr.Dataset, int, Wave]]) -> list[float]:
    """Angles of all teeth that carry, and a little beside them [deg]."""
    ends = [
        float(angle)
        for _, data, law, _ in seen
        for angle in np.degrees(arc_of(data)[data["load"].values[law] > 0.0])
    ]
    if not ends:
        return [-30.0, 30.0]
    low, high = min([*ends, 0.0]), max([*ends, 0.0])
    edge = 0.06 * (high - low)
    return [round(low - edge, 3), round(high + edge, 3)]


def _axis() -> dict[str, Any]:
    """Line at the long axis."""
    return {
        "type": "line",
        "x0": 0,
        "x1": 0,
        "yref": "paper",
        "y0": 0,
        "y1": 1,
        "layer": "below",
        "line": {"color": "#b4bec5", "width": 1, "dash": "dot"},
    }


def _scale(look: dict[str, Any], traces: list[Trace]) -> bool:
    """Logarithmic axis for positive values that differ by much; True if it leaves out the outermost.

    Where flanks fit into each other for a moment, radius and film are out of all proportion.
    """
    values = np.array([y for trace in traces for y in trace["y"] if y])
    if not values.size or values.max() <= _WIDE * values.min():
        look["yaxis"]["rangemode"] = "tozero"
        return False
    low, high = np.quantile(values, [0.01, 0.97]) * np.array([0.5, 3.0])
    low, high = max(low, 0.7 * values.min()), min(high, 1.4 * values.max())
    decades = float(np.log10(high / low))
    ends = [round(float(np.log10(low)), 3), round(float(np.log10(high)), 3)]
    look["yaxis"] |= {"type": "log", "dtick": 2 if decades > 6.0 else 1, "range": ends}
    return bool(values.min() < low or values.max() > high)


def _clearance(name: str, outcome: Outcome) -> Figure:
    """Clearance of unloaded flanks, with the teeth that carry at one moment."""
    teeth = outcome.parts["teeth"]
    angle = np.degrees(teeth["clearance_angle"].values)
    given = np.maximum(teeth["clearance"].values, _LEAST)
    unit = show.unit(VARIABLES["clearance"].display)
    key = Key("clearance of the unloaded flanks", PALETTE[0])
    traces = [plain(key, angle, display("clearance", given), unit)]
    keys = [key]
    told = "Clearances below 0.01 µm are drawn there: flanks without one slide on each other."
    places = _carrying(outcome)
    if places.size:
        there = np.interp(places, angle, display("clearance", given))
        traces.append(
            plain(_TEETH, places, there, unit)
            | {"mode": "markers", "marker": {"size": 7, "color": _TEETH.colour}}
        )
        keys.append(_TEETH)
        told = (
            f"Dots: the teeth of one end of the long axis that carry at "
            f"{_torque(outcome)} at one moment; load has closed their clearance. {told}"
        )
    ends = angle[np.isfinite(given)][[0, -1]].tolist()
    return Figure(
        name,
        "Clearance along the wave",
        traces,
        layout(
            ANGLE,
            short_axis("clearance"),
            xaxis={"range": ends},
            yaxis={"type": "log", "dtick": 1, "exponentformat": "none"},
            shapes=[_axis()],
        ),
        told,
        tuple(keys),
    )


def _torque(outcome: Outcome) -> str:
    return show.quantity("torque", operating_point(outcome).torque)


def _carrying(outcome: Outcome) -> np.ndarray:
    """Angles of the teeth of one zone that carry at the start of the mesh cycle [deg]."""
    data = outcome.parts.get("cycle")
    if data is None:
        return np.zeros(0)
    half = data.sizes["pair"] // 2
    carries = data["load"].values[0, 0, :half].max(axis=-1) > 0.0
    return np.asarray(np.degrees(arc_of(data)[0, :half, 0])[carries])


def _passing(name: str, outcome: Outcome) -> Figure:
    """One tooth in its space at several angles, seen from the circular spline."""
    teeth = outcome.parts["teeth"]
    low = float(teeth["space"].values[:, 1].min())
    angle = np.degrees(teeth["passing_angle"].values)
    shown = np.flatnonzero(teeth["passing"].values[..., 1].max(axis=1) > low - _reach(teeth))
    traces = [_space(teeth, low)]
    for k in shown:
        traces.append(_outline(teeth["passing"].values[k], low, float(angle[k]), _reach(teeth)))
    traces.append(_track(teeth["passing"].values[shown], low))
    wide = 1e3 * np.abs(teeth["space"].values[:, 0]).max()
    deep = 1e3 * float(np.ptp(teeth["space"].values[:, 1]))
    height = 1e3 * float(np.ptp(teeth["tooth"].values[:, 1]))
    axis = {"constrain": "domain", "scaleanchor": "x", "scaleratio": 1}
    return Figure(
        name,
        "Path of a tooth into its space",
        traces,
        layout(
            "across [mm]",
            "outwards [mm]",
            xaxis={"range": [3.2 * wide, -3.2 * wide], "constrain": "domain"},
            yaxis={"range": [-1.15 * height, 1.2 * deep], **axis},
        ),
        f"Every {degrees(_step(teeth)):.3g}° of p. Seen from the circular spline, "
        "which is shaded, outwards from its tip circle; positive rotation is to the left. Equal scale "
        "in both directions.",
        (
            Key("tooth on the long axis, p = 0", INK),
            Key("p > 0", PALETTE[0]),
            Key("p < 0", PALETTE[1]),
            Key("middle of its tip", GREY, "dash"),
        ),
    )


def _step(teeth: xr.Dataset) -> float:
    return float(np.diff(teeth["passing_angle"].values[:2])[0])


def _reach(teeth: xr.Dataset) -> float:
    """Distance inside the tip circle to which a tooth is shown [m]."""
    return 0.6 * float(np.ptp(teeth["tooth"].values[:, 1]))


def _space(teeth: xr.Dataset, low: float) -> Trace:
    """The circular spline around the space and half of its neighbours."""
    x, y = simplified(teeth["space"].values, 2e-7).T
    turns = np.exp(2j * np.pi * np.array([-1, 0, 1]) / float(teeth["teeth"].values[1]))
    places = 1e3 * ((turns[:, None] * (y + 1j * x)).ravel() - low)
    across, outwards = places.imag, places.real
    deep = 1.3 * float(outwards.max())
    ends = across[[-1, 0]].tolist()
    return {
        "type": "scatter",
        "mode": "lines",
        "x": rounded([*across.tolist(), *ends]),
        "y": rounded([*outwards.tolist(), deep, deep]),
        "fill": "toself",
        "fillcolor": "#ece5d6",
        "line": {"color": "#8a7b55", "width": 1.5},
        "hoverinfo": "skip",
    }


def _outline(corners: np.ndarray, low: float, angle: float, reach: float) -> Trace:
    colour = INK if abs(angle) < 1e-9 else PALETTE[0] if angle > 0.0 else PALETTE[1]
    x, y = 1e3 * (simplified(corners, 1e-6) - np.array([0.0, low])).T
    return {
        "type": "scatter",
        "mode": "lines",
        "x": rounded(x, 4),
        "y": rounded(y, 4),
        "line": {"color": colour, "width": 2.4 if colour == INK else 0.9},
        "hovertemplate": f"p = {show.number(angle)}°<extra></extra>",
    }


def _track(passing: np.ndarray, low: float) -> Trace:
    middle = passing.shape[1] // 2
    x, y = 1e3 * (passing[:, middle - 1 : middle + 1].mean(axis=1) - np.array([0.0, low])).T
    return {
        "type": "scatter",
        "mode": "lines",
        "x": rounded(x, 4),
        "y": rounded(y, 4),
        "line": {"color": GREY, "width": 1.2, "dash": "dash"},
        "hoverinfo": "skip",
    }


def told_arcs(outcome: Outcome) -> str:
    """Angles between which teeth carry, in words; empty if unknown."""
    arcs = loaded_arcs(outcome)
    each = [f"{degrees(a):.1f}° to {degrees(b):.1f}°".replace("-", "−") for a, b in arcs]
    return " and ".join(each)
