"""Along the path of contact: quantities of one pair on its way, and where on it the loss is made."""

from collections.abc import Iterator, Mapping
from itertools import pairwise

import numpy as np
import xarray as xr

from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.lines import REGIMES, SHORT, Points, gapped, regimes, titled, values_of
from pitchpoint.views.path import StraightPath, contact_path, path_marks
from pitchpoint.views.point import named_members
from pitchpoint.views.section import Block, Page, Paragraph, Section
from pitchpoint.views.where_lost import where_lost

__all__ = ["PATH", "loss_places", "loss_sentence", "path_panel", "points_along_path"]

_ALONG = {
    "load_share": "",
    "contact_force_ratio": "Normal force of the mesh over that without friction.",
    "sliding_velocity": "",
    "pressure": "",
    "film_thickness": "",
    "lambda_ratio": REGIMES,
    "friction": "",
    "loss": "Loss of the one pair that is at this place.",
}
_MISSING = {
    "film_thickness": "There is no film to compute: nothing is carried.",
    "lambda_ratio": "Without limit: the flanks are smooth, or nothing is carried.",
}
_PARTS = ("teeth.points", "cycle")
_WHOLE = ("load_share", "contact_force_ratio", "loss")
_LINES = {
    "load_share": "Of the whole contact line.",
    "loss": "Of the whole contact line.",
}


def _blocks(page: Page) -> Iterator[Block]:
    there = page.having(*_PARTS)
    yield Paragraph(
        f"One pair on its way between A and E. {' '.join(_point_notes(there))} Lines are interrupted where a "
        "pair enters or leaves."
    )
    yield path_panel(there, page.curves)


def _closing(page: Page) -> Iterator[Block]:
    meshes = page.by_mesh(*_PARTS)
    return where_lost(meshes, meshes.outcomes, _loss_words)


def _loss_words(outcome: Outcome, law: int) -> str:
    path = contact_path(outcome)
    return loss_sentence(loss_places(outcome.parts["cycle"], law, path), path)


def path_panel(outcomes: Mapping[str, Outcome], known: plot.Curves) -> plot.Panel:
    """Quantities of one pair on its way from A to E."""
    seen = list(_seen(outcomes, known))
    path = contact_path(next(iter(outcomes.values())))
    figures = [_along_figure(name, seen, path) for name in _ALONG] if seen else []
    return plot.Panel("Along the path of contact", figures, [curve for curve, *_ in seen])


def loss_places(data: xr.Dataset, law: int, path: StraightPath) -> dict[tuple[str, str], float]:
    """Share of the loss that is made between neighbouring points of the path; empty without loss.

    Args:
        data: the mesh cycle.
        law: position of the law.
        path: with the points.
    """
    place = data["path"].values
    loss = np.where(data["active"].values, values_of(data, "loss")[law], 0.0)
    energy = loss * data["weight"].values[:, None, None]
    if not energy.sum() > 0.0:
        return {}
    ends = list(path.points.items())
    return {
        (start, end): float(energy[(place >= low) & (place < high)].sum() / energy.sum())
        for (start, low), (end, high) in pairwise(ends)
        if high - low > SHORT
    }


def points_along_path(data: xr.Dataset, name: str, law: int, path: StraightPath) -> Points:
    """Place [base pitches] and SI value, the pairs one after the other.

    Quantities of a point of the flanks stand over the place on the path from A; those of a helical
    pair are taken at the middle of the face, those of a spur pair cut into slices where the load on them
    is highest. Quantities of a whole contact line (`_WHOLE`) stand over
    the base pitches since the pair entered, which is the same place for straight teeth.
    """
    values = values_of(data, name)[law]
    if name in _UNDER_LOAD:
        values = np.where(data["load"].values[law] > 0.0, values, np.nan)
    entered = data["phase"].values[:, None] + np.arange(float(data.sizes["pair"]))
    if values.ndim == 1:
        by_pair = np.broadcast_to(values[:, None], entered.shape)
    elif name in _WHOLE or data.sizes["slice"] == 1:
        by_pair = values.sum(axis=-1)
    elif not path.helical:
        highest = np.argmax(data["load"].values[law], axis=-1, keepdims=True)
        by_pair = np.take_along_axis(values, highest, axis=-1)[..., 0]
    else:
        by_pair = _at_middle(data, values, entered - path.overlap_ratio / 2.0)
        entered = entered - path.overlap_ratio / 2.0
    end = path.contact_ratio if name in _WHOLE else path.transverse_ratio
    touches = data["active"].values[..., 0] & (entered >= -SHORT) & (entered <= end + SHORT)
    touches = touches.T.ravel()
    return gapped(entered.T.ravel()[touches], by_pair.T.ravel()[touches])


_UNDER_LOAD = ("film_thickness", "lambda_ratio", "friction")
"""What there is none of where flanks carry nothing."""


def _at_middle(data: xr.Dataset, values: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values [node, pair] between those of the slices, at a place on the path [node, pair]."""
    flat = (-1, data.sizes["slice"])
    paths, of_rows = data["path"].values.reshape(flat), values.reshape(flat)
    at_middle = [
        _between(x, path[::-1], value[::-1])
        for x, path, value in zip(place.ravel(), paths, of_rows, strict=True)
    ]
    return np.array(at_middle).reshape(place.shape)


def _between(x: float, path: np.ndarray, values: np.ndarray) -> float:
    """Value at x along one line; beyond the middles of the outer slices it goes on straight."""
    apart = np.append(True, np.diff(path) > SHORT)
    path, values = path[apart], values[apart]
    if path.size < 2 or path[0] <= x <= path[-1]:
        return float(np.interp(x, path, values))
    nearest = slice(0, 2) if x < path[0] else slice(-2, None)
    (low, high), (start, end) = path[nearest], values[nearest]
    return float(start + (end - start) * (x - low) / (high - low))


def _seen(
    outcomes: Mapping[str, Outcome], known: plot.Curves
) -> Iterator[tuple[plot.Curve, xr.Dataset, int, StraightPath]]:
    """Curve, cycle, position of the law and path for every law of every variant."""
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data, path = outcome.parts["cycle"], contact_path(outcome)
            for position, law in enumerate(plot.laws(data)):
                yield known[variant, law], data, position, path


def _along_figure(
    name: str, seen: list[tuple[plot.Curve, xr.Dataset, int, StraightPath]], first: StraightPath
) -> plot.Figure:
    unit = show.display_unit(VARIABLES[name].display)
    traces = []
    for curve, data, law, path in seen:
        x, y = points_along_path(data, name, law, path)
        traces.append(plot.line(curve, x, plot.display(name, y), unit))
    shown, remark = plot.merged(traces)
    of_line = first.helical and name in _WHOLE
    end = first.contact_ratio if of_line else first.transverse_ratio
    look = plot.layout(
        f"{first.pitch}es since the pair entered" if of_line else first.axis,
        plot.short_axis(name),
        xaxis={"range": [-0.02 * end, 1.02 * end]},
        yaxis={} if name == "sliding_velocity" else {"rangemode": "nonnegative"},
        **({} if of_line else path_marks(first)),
    )
    title = "Loss of the pair" if name == "loss" else titled(name)
    if name == "lambda_ratio":
        regimes(look, shown)
    note = _LINES.get(name, _ALONG[name]) if first.helical else _ALONG[name]
    if name == "sliding_velocity":
        note = str(seen[0][1]["path"].attrs["sliding"])
    note, missing = " ".join(filter(None, (note, remark))), _MISSING.get(name, plot.NO_POWER)
    return plot.Figure(f"along_{name}", title, shown, look, note, missing=missing)


def loss_sentence(shares: Mapping[tuple[str, str], float], path: StraightPath) -> str:
    """Where the loss is made, in words.

    Args:
        shares: by the two points between which it is made.
        path: with the order of the points.
    """
    if not shares:
        return "There is no loss."
    shares_words = ", ".join(
        f"{100 * share:.0f} % between {a} and {b}" for (a, b), share in shares.items()
    )
    if "C" not in path.points:
        return f"{shares_words}. The pitch point lies outside the path."
    middle = path.points["C"]
    before = sum(share for (_, end), share in shares.items() if path.points[end] <= middle + 1e-9)
    approach, recess = (1.0 - before, before) if path.backwards else (before, 1.0 - before)
    return (
        f"{shares_words}: {100 * approach:.0f} % before the pitch point C (approach) and "
        f"{100 * recess:.0f} % after it (recess)."
    )


def _point_notes(outcomes: Mapping[str, Outcome]) -> list[str]:
    """What the letters mean for this contact ratio and driver."""
    sample = next(iter(outcomes.values()))
    path, members = contact_path(sample), named_members(sample)
    notes = [_letters(path, members[1])]
    if path.helical:
        notes.append(
            f"Contact lines cross the face at an angle, so a pair is in contact for "
            f"{show.number_text(path.contact_ratio)} base pitches, "
            f"{show.number_text(path.overlap_ratio)} longer "
            "than the path. Over the path from A stand values at the middle of the face, over the base "
            "pitches since the pair entered those of the whole contact line."
        )
    elif path.transverse_ratio > 2.0:
        notes.append(
            "With a contact ratio above 2 there is no single contact, and D comes before B."
        )
    else:
        notes.append("Between B and D one pair carries the load, outside two share it.")
    cycles = [outcome.parts["cycle"] for outcome in outcomes.values() if "cycle" in outcome.parts]
    if not path.helical and any(cycle.sizes["slice"] > 1 for cycle in cycles):
        notes.append("What differs over the face is shown where the load on it is highest.")
    if path.backwards:
        driver = show.with_article(str(sample.manifest["driver"]))
        notes.append(
            f"{driver[0].upper()}{driver[1:]} drives, so every pair runs from E to A, and the phase runs "
            "backwards."
        )
    return notes


def _letters(path: StraightPath, second: str) -> str:
    ends = (
        "A and E are the ends of the path of contact, A at the tip of "
        f"{show.with_article(second)}; C is the pitch point"
    )
    return f"{ends}; B and D lie one base pitch from E and A." if "B" in path.points else f"{ends}."


PATH = Section(
    name="path",
    title="Along the path of contact",
    short="Along the path",
    order=110.0,
    parts=_PARTS,
    blocks=_blocks,
    closing=_closing,
    of_a_mesh=True,
)
