"""Along a way without letters: quantities of one pair over the coordinate that its family has for it."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.lines import REGIMES, regimes, titled, values_of
from pitchpoint.views.point import period_of
from pitchpoint.views.section import Block, Page, Paragraph, Section, naming
from pitchpoint.views.way import at_origin, carrying_or_next, places_on_axis
from pitchpoint.views.where_lost import where_lost

__all__ = ["ARC", "arc_panel", "wave_losses", "wave_sentence"]

_ARC = {
    "load": "Where it touches at two places, at its root and at its tip, their sum.",
    "pressure": "By Hertz, for the load and the radius of each contact; elastic steel, high on edges, which "
    "wear. Dashed: the contact nearer to the tip of a tooth that touches at two places.",
    "radius": "Where an edge touches it is small, where flanks fit into each other it is large.",
    "entrainment": "Mean speed of both flanks against their contact; it draws the oil in.",
    "sliding_velocity": "",
    "film_thickness": "",
    "lambda_ratio": REGIMES,
    "friction": "",
    "loss": "Loss of the one tooth that is at this place.",
}
_POSITIVE = ("pressure", "radius", "entrainment", "film_thickness", "lambda_ratio")
_SUMS = ("load", "loss")
_WIDE = 30.0
"""Ratio of the largest to the smallest value above which an axis is logarithmic."""


def _ways(page: Page) -> dict[str, Outcome]:
    """Outcomes whose pairs go a way that is told, and that has no letters."""
    return {
        name: outcome
        for name, outcome in page.by_mesh("teeth", "cycle").outcomes.items()
        if "points" not in outcome.parts["teeth"] and outcome.parts["cycle"]["path"].attrs["title"]
    }


def _told(page: Page, name: str) -> str:
    """Words of the way, see `Way`."""
    return str(next(iter(_ways(page).values())).parts["cycle"]["path"].attrs[name])


def _lacks(page: Page) -> str | None:
    return None if _ways(page) else ""


def _blocks(page: Page) -> Iterator[Block]:
    ways = _ways(page)
    alone = next(iter(ways)) if len(ways) == 1 else ""
    panel = arc_panel(ways, page.by_mesh("teeth", "cycle").curves)
    yield Paragraph(_told(page, "told"))
    yield from naming("" if alone in page.outcomes else alone, [panel])


def _closing(page: Page) -> Iterator[Block]:
    def words(outcome: Outcome, law: int) -> str:
        return wave_sentence(wave_losses(outcome, law), _told(page, "origin"))

    return where_lost(page.by_mesh("teeth", "cycle"), _ways(page), words)


def arc_panel(outcomes: Mapping[str, Outcome], known: plot.Curves) -> plot.Panel:
    """Quantities of one pair over its place on the way."""
    seen = list(_seen(outcomes, known))
    figures = [_arc_figure(name, seen) for name in _ARC] if seen else []
    return plot.Panel("", figures, [curve for curve, *_ in seen])


def wave_losses(outcome: Outcome, law: int) -> dict[str, float]:
    """Power lost where teeth go in, where they come out, and beside the teeth [W].

    Args:
        outcome: with a mesh cycle.
        law: position of the law.
    """
    data, backwards = outcome.parts["cycle"], period_of(outcome).backwards
    losses = (data["sliding_loss"] + data["rolling_loss"]).values[law]
    energy = losses * data["weight"].values[:, None, None] / data["weight"].values.sum()
    place = places_on_axis(data)
    inwards = place > 0.0 if backwards else place < 0.0
    beside = outcome.parts.get("operation")
    return {
        "in": float(energy[inwards].sum()),
        "out": float(energy[~inwards].sum()),
        "beside": 0.0 if beside is None else float(beside["mean_drag_loss"].values[law, 0]),
    }


def wave_sentence(lost: Mapping[str, float], origin: str) -> str:
    """Where the loss is made, in words.

    Args:
        lost: as `wave_losses` gives it.
        origin: what lies in the middle of the way.
    """
    total = sum(lost.values())
    if not total > 0.0:
        return "There is no loss."
    share = {name: f"{100 * value / total:.0f} %" for name, value in lost.items()}
    both = f"{100 * (lost['in'] + lost['out']) / total:.0f} % in the teeth"
    sentence = (
        f"{both}: {share['in']} before they reach {origin}, on their way in, and "
        f"{share['out']} after it, on their way out"
    )
    return f"{sentence}; {share['beside']} beside the teeth." if lost["beside"] else f"{sentence}."


def _seen(
    outcomes: Mapping[str, Outcome], known: plot.Curves
) -> Iterator[tuple[plot.Curve, xr.Dataset, int]]:
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data = outcome.parts["cycle"]
            for position, law in enumerate(plot.laws(data)):
                yield known[variant, law], data, position


def _along(
    data: xr.Dataset, name: str, law: int, place: int | None
) -> tuple[np.ndarray, np.ndarray]:
    """Place and SI value of a pair in one zone; NaN where it does not carry.

    Every node of every pair is one place of the same way; all zones are alike.

    Args:
        data: mesh cycle.
        name: of the variable.
        law: its position.
        place: of the pair's contact among several; None for the sum of all.
    """
    half = data.sizes["pair"] // int(data["path"].attrs["zones"])

    def of_pair(values: np.ndarray) -> np.ndarray:
        zone = values[:, :half]
        return (zone.sum(axis=2) if place is None else zone[..., place]).ravel()

    angle = places_on_axis(data)[:, :half, 0].ravel()
    order = np.argsort(angle, kind="stable")
    load = of_pair(data["load"].values[law])[order]
    values = of_pair(values_of(data, name)[law])[order]
    near = carrying_or_next(load > 0.0)
    if not near.any():
        return angle[:0], load[:0]
    values = np.where(load > 0.0, values, np.nan)
    return plot.continued(angle[order][near], values[near], most=400)


def _traces(seen: list[tuple[plot.Curve, xr.Dataset, int]], name: str) -> Iterator[plot.Trace]:
    """A line for each contact of a pair, the later ones dashed; one for what they have in sum."""
    unit = show.display_unit(VARIABLES[name].display)
    for curve, data, law in seen:
        for place in [None] if name in _SUMS else range(data.sizes["slice"]):
            x, y = _along(data, name, law, place)
            trace = plot.line(curve, x, plot.display(name, y), unit)
            if len(seen) == 1:  # dashes are those of the other contact of a pair
                trace["line"] = trace["line"] | {"dash": "solid"}
            if place:
                trace["line"] = trace["line"] | {"dash": "dash", "width": 1.5}
            if x.size or not place:
                yield trace


def _arc_figure(name: str, seen: list[tuple[plot.Curve, xr.Dataset, int]]) -> plot.Figure:
    shown, remark = plot.merged(list(_traces(seen, name)))
    title = "Loss of a pair" if name == "loss" else titled(name)
    look = plot.layout(
        seen[0][1]["path"].attrs["axis"],
        plot.short_axis(name),
        xaxis={"range": _range(seen)},
        shapes=[at_origin()] if seen[0][1]["path"].attrs["origin"] else [],
        annotations=[],
    )
    cut = ""
    if name not in _POSITIVE and name != "sliding_velocity":
        look["yaxis"]["rangemode"] = "tozero"
    elif name in _POSITIVE and _scale(look, shown):
        cut = "The outermost values are outside the figure."
    if name == "lambda_ratio":
        regimes(look, shown)
    meaning = seen[0][1]["path"].attrs["sliding"] if name == "sliding_velocity" else _ARC[name]
    note = " ".join(filter(None, (meaning, cut, remark)))
    return plot.Figure(f"arc_{name}", title, shown, look, note, missing="No tooth carries.")


def _range(seen: list[tuple[plot.Curve, xr.Dataset, int]]) -> list[float]:
    """Places of all pairs that carry, and a little beside them."""
    ends = [
        float(angle)
        for _, data, law in seen
        for angle in places_on_axis(data)[data["load"].values[law] > 0.0]
    ]
    if not ends:
        return [-30.0, 30.0]
    low, high = min([*ends, 0.0]), max([*ends, 0.0])
    edge = 0.06 * (high - low)
    return [round(low - edge, 3), round(high + edge, 3)]


def _scale(look: dict[str, Any], traces: list[plot.Trace]) -> bool:
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
    powers = range(int(np.ceil(ends[0])), int(np.floor(ends[1])) + 1)
    if len(powers) < 2:  # one number alone tells no scale
        marks = np.outer(10.0 ** np.arange(powers.start - 1, powers.stop), [1.0, 2.0, 5.0]).ravel()
        look["yaxis"]["tickvals"] = [float(mark) for mark in marks if low <= mark <= high]
    return bool(values.min() < low or values.max() > high)


ARC = Section(
    name="arc",
    title=lambda page: _told(page, "title"),
    short=lambda page: _told(page, "title"),
    order=130.0,
    lacks=_lacks,
    blocks=_blocks,
    closing=_closing,
)
