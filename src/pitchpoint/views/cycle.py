"""Figures along the path of contact and over the mesh cycle, and where the loss is made."""

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.facts import Facts, Wave, facts, has_wave, timed
from pitchpoint.views.figures import (
    NO_POWER,
    Curve,
    Curves,
    Figure,
    Panel,
    Trace,
    display,
    laws,
    layout,
    line,
    merged,
    short_axis,
)

__all__ = [
    "PLACE",
    "along",
    "cycle_panel",
    "cycle_pitch",
    "gapped",
    "loss_places",
    "marks",
    "path_panel",
    "regimes",
]

# Nodes beside an event are closer than this; a segment shorter than the second is no segment.
_EVENT, _SHORT = 1e-7, 1e-6
_ALONG = {
    "load_share": "",
    "contact_force_ratio": "Normal force of the mesh over that without friction.",
    "sliding_velocity": "Flank of gear 1 over flank of gear 2; zero at the pitch point C.",
    "pressure": "",
    "film_thickness": "",
    "lambda_ratio": "Below 1 boundary, 1 to 3 mixed, above 3 full film.",
    "friction": "",
    "loss": "Loss of the one pair that is at this place.",
}
_MISSING = {
    "film_thickness": "There is no film to compute: nothing is carried.",
    "lambda_ratio": "Without limit: the flanks are smooth, or nothing is carried.",
}
_WHOLE = ("load_share", "contact_force_ratio", "loss")
_LINES = {
    "load_share": "Of the whole contact line.",
    "loss": "Of the whole contact line.",
}
PLACE = "place on the path from A [base pitches]"
_REGIMES = (
    (0.0, 1.0, "#fbe9e2", "boundary"),
    (1.0, 3.0, "#fdf5dc", "mixed"),
    (3.0, np.inf, "#e7f2ea", "full film"),
)
_FEW = 8
"""Pairs above which the friction of each cannot be told apart."""

_PAIR_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")

Points = tuple[np.ndarray, np.ndarray]


def path_panel(outcomes: Mapping[str, Outcome], known: Curves) -> Panel:
    """Quantities of one pair on its way from A to E."""
    seen = list(_seen(outcomes, known))
    first = facts(next(iter(outcomes.values())))
    figures = [_along_figure(name, seen, first) for name in _ALONG] if seen else []
    return Panel("Along the path of contact", figures, [curve for curve, *_ in seen])


def cycle_panel(outcomes: Mapping[str, Outcome], known: Curves) -> Panel:
    """Efficiency and input torque over phase and time and against each other, friction of the pairs."""
    seen = list(_timed(outcomes, known))
    if not seen:
        return Panel("Over the mesh cycle", [])
    pitch = cycle_pitch(outcomes)
    figures = [
        _over("efficiency", "phase", seen, pitch),
        _over("input_torque", "phase", seen, pitch),
        _over("efficiency", "time", seen, pitch),
        _over("input_torque", "time", seen, pitch),
        _against(seen),
        (_pairs if seen[0][1].sizes["pair"] <= _FEW else _count)(seen, pitch),
    ]
    return Panel("Over the mesh cycle", figures, [curve for curve, *_ in seen])


def cycle_pitch(outcomes: Mapping[str, Outcome]) -> str:
    """What the phase of the mesh cycle counts: the mesh repeats with every pitch of this kind."""
    return "tooth pitch" if all(map(has_wave, outcomes.values())) else "base pitch"


def loss_places(data: xr.Dataset, law: int, fact: Facts) -> dict[tuple[str, str], float]:
    """Share of the loss that is made between neighbouring points of the path; empty without loss.

    Args:
        data: the mesh cycle.
        law: position of the law.
        fact: with the points.
    """
    place = data["path"].values
    loss = np.where(data["active"].values, _values(data, "loss")[law], 0.0)
    energy = loss * data["weight"].values[:, None, None]
    if not energy.sum() > 0.0:
        return {}
    ends = list(fact.points.items())
    return {
        (start, end): float(energy[(place >= low) & (place < high)].sum() / energy.sum())
        for (start, low), (end, high) in pairwise(ends)
        if high - low > _SHORT
    }


def gapped(x: np.ndarray, y: np.ndarray) -> Points:
    """Points with a gap (NaN) at every event, so that no line crosses a jump."""
    cuts = np.flatnonzero(np.abs(np.diff(x)) < _EVENT) + 1
    parts = [
        part for part in np.split(np.arange(x.size), cuts) if part.size and np.ptp(x[part]) > _SHORT
    ]
    if not parts:
        return x[:0], y[:0]
    gap = np.array([np.nan])
    return (
        np.concatenate([piece for part in parts for piece in (x[part], x[part[-1:]])]),
        np.concatenate([piece for part in parts for piece in (y[part], gap)]),
    )


def along(data: xr.Dataset, name: str, law: int, fact: Facts) -> Points:
    """Place [base pitches] and SI value, the pairs one after the other.

    Quantities of a point of the flanks stand over the place on the path from A; those of a helical
    pair are taken at the middle of the face, those of a spur pair cut into slices where the load on them
    is highest. Quantities of a whole contact line (`_WHOLE`) stand over
    the base pitches since the pair entered, which is the same place for straight teeth.
    """
    values = _values(data, name)[law]
    entered = data["phase"].values[:, None] + np.arange(float(data.sizes["pair"]))
    if values.ndim == 1:
        by_pair = np.broadcast_to(values[:, None], entered.shape)
    elif name in _WHOLE or data.sizes["slice"] == 1:
        by_pair = values.sum(axis=-1)
    elif not fact.helical:
        highest = np.argmax(data["load"].values[law], axis=-1, keepdims=True)
        by_pair = np.take_along_axis(values, highest, axis=-1)[..., 0]
    else:
        by_pair = _at_middle(data, values, entered - fact.overlap_ratio / 2.0)
        entered = entered - fact.overlap_ratio / 2.0
    end = fact.contact_ratio if name in _WHOLE else fact.transverse_ratio
    touches = data["active"].values[..., 0] & (entered >= -_SHORT) & (entered <= end + _SHORT)
    touches = touches.T.ravel()
    return gapped(entered.T.ravel()[touches], by_pair.T.ravel()[touches])


def _at_middle(data: xr.Dataset, values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values [node, pair] between those of the slices, at a place on the path [node, pair]."""
    flat = (-1, data.sizes["slice"])
    paths, each = data["path"].values.reshape(flat), values.reshape(flat)
    found = [
        _between(x, path[::-1], value[::-1])
        for x, path, value in zip(place.ravel(), paths, each, strict=True)
    ]
    return np.array(found).reshape(place.shape)


def _between(x: float, path: np.ndarray, values: np.ndarray) -> float:
    """Value at x along one line; beyond the middles of the outer slices it goes on straight."""
    apart = np.append(True, np.diff(path) > _SHORT)
    path, values = path[apart], values[apart]
    if path.size < 2 or path[0] <= x <= path[-1]:
        return float(np.interp(x, path, values))
    first = slice(0, 2) if x < path[0] else slice(-2, None)
    (low, high), (start, end) = path[first], values[first]
    return float(start + (end - start) * (x - low) / (high - low))


def _values(data: xr.Dataset, name: str) -> np.ndarray:
    if name == "loss":
        return np.asarray((data["sliding_loss"] + data["rolling_loss"]).values)
    return np.asarray(data[name].values)


def _seen(
    outcomes: Mapping[str, Outcome], known: Curves
) -> Iterator[tuple[Curve, xr.Dataset, int, Facts]]:
    """Curve, cycle, position of the law and facts for every law of every variant."""
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data, fact = outcome.parts["cycle"], facts(outcome)
            for position, law in enumerate(laws(data)):
                yield known[variant, law], data, position, fact


def _timed(
    outcomes: Mapping[str, Outcome], known: Curves
) -> Iterator[tuple[Curve, xr.Dataset, int, Facts | Wave]]:
    """The same as `_seen`, with the period of a mesh of any kind."""
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data, fact = outcome.parts["cycle"], timed(outcome)
            for position, law in enumerate(laws(data)):
                yield known[variant, law], data, position, fact


def _along_figure(
    name: str, seen: list[tuple[Curve, xr.Dataset, int, Facts]], first: Facts
) -> Figure:
    unit = show.unit(VARIABLES[name].display)
    traces = []
    for curve, data, law, fact in seen:
        x, y = along(data, name, law, fact)
        traces.append(line(curve, x, display(name, y), unit))
    shown, same = merged(traces)
    of_line = first.helical and name in _WHOLE
    end = first.contact_ratio if of_line else first.transverse_ratio
    look = layout(
        "base pitches since the pair entered" if of_line else PLACE,
        short_axis(name),
        xaxis={"range": [-0.02 * end, 1.02 * end]},
        yaxis={} if name == "sliding_velocity" else {"rangemode": "nonnegative"},
        **({} if of_line else marks(first)),
    )
    title = "Loss of the pair" if name == "loss" else _title(name)
    if name == "lambda_ratio":
        regimes(look, shown)
    note = _LINES.get(name, _ALONG[name]) if first.helical else _ALONG[name]
    note, missing = " ".join(filter(None, (note, same))), _MISSING.get(name, NO_POWER)
    return Figure(f"along_{name}", title, shown, look, note, missing=missing)


def _title(name: str) -> str:
    words = VARIABLES[name].long_name
    return words[0].upper() + words[1:]


def marks(fact: Facts) -> dict[str, Any]:
    """Vertical lines and letters at the points of the path."""
    places: list[tuple[float, str]] = []
    for letter, place in fact.points.items():
        if places and place - places[-1][0] < 0.03 * fact.transverse_ratio:
            places[-1] = (places[-1][0], f"{places[-1][1]} {letter}")
        else:
            places.append((place, letter))
    return {
        "shapes": [
            {
                "type": "line",
                "x0": place,
                "x1": place,
                "yref": "paper",
                "y0": 0,
                "y1": 1,
                "layer": "below",
                "line": {"color": "#b4bec5", "width": 1, "dash": "dot"},
            }
            for place in fact.points.values()
        ],
        "annotations": [
            {"text": letter, "x": place, "yref": "paper", "y": 1, "yanchor": "bottom"}
            | {"showarrow": False, "font": {"size": 12}}
            for place, letter in places
        ],
    }


def regimes(look: dict[str, Any], traces: list[Trace]) -> None:
    """Bands of the lubrication regimes behind the curves; sets the range of the axis of values.

    Args:
        look: layout with lists of shapes and annotations.
        traces: curves of the film thickness over the roughness.
    """
    values = [y for t in traces for y in t["y"] if y is not None]
    top = max(1.25, 1.1 * max(values, default=1.0))
    bottom = 0.0
    if look["yaxis"].get("type") == "log":
        bottom = 0.7 * min(values)
        top *= 1.3
    if "range" in look["yaxis"]:
        bottom, top = (10.0**end for end in look["yaxis"]["range"])
        top = max(top, 1.25)
    look["yaxis"]["range"] = [_place(bottom, bottom), _place(top, bottom)]
    bands = [band for band in _REGIMES if bottom < band[1] and band[0] < top]
    for low, high, colour, words in bands:
        ends = {"y0": max(low, bottom), "y1": min(high, top)}
        look["shapes"].insert(
            0,
            {"type": "rect", "xref": "paper", "x0": 0, "x1": 1, **ends}
            | {"fillcolor": colour, "line": {"width": 0}, "layer": "below"},
        )
        look["annotations"].append(
            {"text": words, "xref": "paper", "x": 0.99, "xanchor": "right", "showarrow": False}
            | {"y": _place(ends["y1"], bottom), "yanchor": "top", "yshift": 3}
            | {"font": {"size": 11, "color": "#7a6a4f"}}
        )


def _place(value: float, bottom: float) -> float:
    """Place on the axis: logarithmic axes, which begin above zero, count in powers of ten."""
    return float(np.log10(value)) if bottom > 0.0 else value


def _over(
    name: str, axis: str, seen: list[tuple[Curve, xr.Dataset, int, Facts | Wave]], pitch: str
) -> Figure:
    abscissa = _phase if axis == "phase" else _time
    unit = show.unit(VARIABLES[name].display)
    traces = []
    for curve, data, law, fact in seen:
        x, y = abscissa(data, data[name].values[law], fact)
        traces.append(line(curve, x, display(name, y), unit))
    words = {"phase": _phase_axis(pitch), "time": "time [ms]"}[axis]
    title = {"phase": f"over one {pitch}", "time": f"over time, two {pitch}es"}[axis]
    note = _BACKWARDS[pitch] if seen[0][3].backwards else ""
    return Figure(
        f"cycle_{name}_{axis}",
        f"{_title(name)} {title}",
        traces,
        layout(words, short_axis(name)),
        note if axis == "time" else "",
    )


_BACKWARDS = {
    "base pitch": "Time runs against the phase: the wheel drives.",
    "tooth pitch": "Time runs against the phase: teeth come from positive angles.",
}


def _phase_axis(pitch: str) -> str:
    return f"phase of the mesh cycle [{pitch}es]"


def _phase(data: xr.Dataset, values: np.ndarray, _: Facts | Wave) -> Points:
    phase = np.where(data["phase"].values > 1.0, data["phase"].values - 1.0, data["phase"].values)
    order = np.argsort(phase, kind="stable")
    return gapped(phase[order], values[order])


def _time(data: xr.Dataset, values: np.ndarray, fact: Facts | Wave) -> Points:
    phase = data["phase"].values
    if fact.backwards:
        phase, values = 1.0 - phase[::-1], values[::-1]
    x, y = gapped(np.concatenate([phase, phase + 1.0]) - phase[0], np.tile(values, 2))
    return x * fact.period * 1e3, y


def _against(seen: list[tuple[Curve, xr.Dataset, int, Facts | Wave]]) -> Figure:
    """Efficiency against input torque; curves lie on each other, so the first ones are wider."""
    traces = []
    for position, (curve, data, law, _) in enumerate(seen):
        order = np.argsort(data["input_torque"].values[law], kind="stable")
        trace = line(
            curve,
            display("input_torque", data["input_torque"].values[law][order]),
            display("efficiency", data["efficiency"].values[law][order]),
            "%",
        )
        trace["line"] = {"color": curve.colour, "width": 2 + 3 * (len(seen) - 1 - position)}
        trace |= {"mode": "lines+markers", "marker": {"size": 3, "color": curve.colour}}
        traces.append(trace)
    return Figure(
        "cycle_against",
        "Instantaneous efficiency against input torque",
        traces,
        layout(short_axis("input_torque"), short_axis("efficiency")),
        "With the output torque held, all laws lie on one curve and cover different parts of it; "
        "the first laws are drawn wider.",
    )


def _pairs(seen: list[tuple[Curve, xr.Dataset, int, Facts | Wave]], pitch: str) -> Figure:
    """Friction of all pairs that are in contact at a phase."""
    traces = []
    for curve, data, law, _ in seen:
        for pair in range(data.sizes["pair"]):
            active = data["active"].values[:, pair, 0]
            friction = np.where(active, _mean_friction(data, law)[:, pair], np.nan)
            x, y = gapped(data["phase"].values, friction)
            trace = line(curve, x, y, f"(pair {pair + 1})")
            trace["line"] = {
                "color": curve.colour,
                "width": 2,
                "dash": _PAIR_DASHES[pair % len(_PAIR_DASHES)],
            }
            traces.append(trace)
    names = ", ".join(
        f"{dash} for the pair that entered {_ago(pair)}"
        for pair, dash in enumerate(_PAIR_DASHES[: seen[0][1].sizes["pair"]])
    )
    return Figure(
        "cycle_friction",
        "Friction coefficient of the pairs in contact",
        traces,
        layout(_phase_axis(pitch), "μ", yaxis={"rangemode": "tozero"}),
        f"Line styles here: {names}.",
    )


def _count(seen: list[tuple[Curve, xr.Dataset, int, Facts | Wave]], pitch: str) -> Figure:
    """Number of pairs that carry; steps, since it is a whole number."""
    traces = []
    for curve, data, law, fact in seen:
        carrying = (data["load"].values[law].max(axis=-1) > 0.0).sum(axis=-1)
        traces.append(line(curve, *_phase(data, carrying, fact), "pairs"))
    shown, same = merged(traces)
    for trace in shown:
        trace["line"]["shape"] = "hvh"
    return Figure(
        "cycle_pairs",
        "Number of pairs that carry",
        shown,
        layout(_phase_axis(pitch), "pairs", yaxis={"rangemode": "tozero"}),
        same,
    )


def _mean_friction(data: xr.Dataset, law: int) -> np.ndarray:
    """Friction coefficient of each contact line [node, pair], slices weighted by their load."""
    friction, load = (data[name].values[law] for name in ("friction", "load"))
    total = load.sum(axis=-1)
    even = friction.mean(axis=-1)
    return np.asarray(
        np.where(total > 0.0, (friction * load).sum(axis=-1) / np.where(total, total, 1.0), even)
    )


def _ago(pair: int) -> str:
    return ("in this period", "one period before")[pair] if pair < 2 else f"{pair} periods before"
