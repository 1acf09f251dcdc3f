"""The explorer: one HTML file whose sliders change inputs of a case, from points computed beforehand."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice, pairwise
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint import units
from pitchpoint.analyses.main_figures import efficiency_coverage, main_figures
from pitchpoint.results.chosen_units import shown_in, unit_in_use
from pitchpoint.results.store import write_text
from pitchpoint.runs.explore import Axis, Explored
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import PALETTE, display, law_title, laws, layout, rounded, short_axis
from pitchpoint.views.inputs import recorded_units
from pitchpoint.views.lines import folded, gapped, titled
from pitchpoint.views.point import period_of
from pitchpoint.views.report import environment, packed, packed_plotly
from pitchpoint.views.section import Animation
from pitchpoint.views.section_registry import in_order

__all__ = ["ExplorerPoint", "Reader", "explorer_page", "write_explorer"]

_COURSES = {
    "cycle": ("efficiency", "input_torque"),
    "stiffness": ("mesh_stiffness", "static_transmission_error"),
}
"""Courses over the mesh cycle that are shown, by part."""

_NODES = 72
"""Points of a course that a page needs."""

_OF_SOLUTIONS = (
    "residual",
    "nearest_friction",
    "nearest_jamming_coefficient",
    "turns",
    "turns_change",
    "vibration_status",
)
"""Figures that tell how a solution was found."""


@dataclass(frozen=True)
class PhaseCourse:
    """One course over the mesh cycle.

    Attributes:
        title, axis, abscissa: words of the figure and of its axes.
        x: phases; None at gaps.
        y: values in their display unit, by law, or one row where all have the same.
    """

    title: str
    axis: str
    abscissa: str
    x: list[Any]
    y: list[list[Any]]


@dataclass(frozen=True)
class ExplorerPoint:
    """What the page shows of a case at one point.

    Attributes:
        courses: by name.
        implausible, warnings: sentences.
        drawing: numbers of its drawings, one of each stage; none where nothing is drawn.
        acting: of each drawing, see `Animation`.
        pace: of each drawing, what its slider counts while that of the first counts one.
    """

    courses: Mapping[str, PhaseCourse]
    implausible: Sequence[str]
    warnings: Sequence[str]
    drawing: Sequence[int]
    acting: Sequence[Any]
    pace: Sequence[float]


class Reader:
    """Reads points, and keeps every drawing once.

    Attributes:
        drawings: in order.
    """

    def __init__(self) -> None:
        self.drawings: list[Animation] = []
        self._known: dict[str, int] = {}

    def __call__(
        self, outcome: Outcome, stages: Mapping[int, Outcome] = MappingProxyType({})
    ) -> ExplorerPoint:
        """What the page shows of a case at one point, and of the teeth of its stages by number."""
        titled_ones = {f"Stage {number}": one for number, one in stages.items()} or {"": outcome}
        drawn = [one for title, of in titled_ones.items() for one in self._drawn(of, title)]
        manifest = outcome.manifest
        with shown_in(recorded_units({"": outcome})):
            courses = _courses(outcome)
        rates = [rate for *_, rate in drawn]
        return ExplorerPoint(
            courses,
            manifest["implausible"],
            manifest["warnings"],
            [number for number, *_ in drawn],
            [acting for _, acting, _ in drawn],
            [rate / rates[0] for rate in rates],
        )

    def _drawn(self, outcome: Outcome, title: str) -> Iterator[tuple[int, Any, float]]:
        """Number of a drawing, what acts in it, and what its slider counts in a second; none without one."""
        name = f"drawing{len(self.drawings)}"
        for moving in islice(_movings(outcome, name), 1):
            mark = json.dumps({**moving.picture, "name": title})
            number = self._known.setdefault(mark, len(self.drawings))
            if number == len(self.drawings):
                self.drawings.append(replace(moving, title=title))
            yield number, moving.acting, moving.period / period_of(outcome).time


def _movings(outcome: Outcome, name: str) -> Iterator[Animation]:
    """Drawings of the sections that have one and whose parts are there."""
    for section in in_order():
        if section.moving is not None and all(_has(outcome, part) for part in section.parts):
            yield section.moving(outcome, name)


def _has(outcome: Outcome, part: str) -> bool:
    name, _, variable = part.partition(".")
    return name in outcome.parts and (not variable or variable in outcome.parts[name])


def _courses(outcome: Outcome) -> dict[str, PhaseCourse]:
    return {
        name: _course(outcome, outcome.parts[part], name)
        for part, names in _COURSES.items()
        if part in outcome.parts
        for name in names
    }


def _course(outcome: Outcome, data: xr.Dataset, name: str) -> PhaseCourse:
    values = np.atleast_2d(display(name, data[name].values, data))
    courses = [_thinned(*gapped(*folded(data["phase"].values, row))) for row in values]
    return PhaseCourse(
        title=f"{titled(name, data)} over the mesh cycle",
        axis=short_axis(name, data),
        abscissa=period_of(outcome).axis,
        x=rounded(courses[0][0], 5),
        y=[rounded(y) for _, y in courses],
    )


def _thinned(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fewer points, with those on both sides of every gap, which repeats the place before it."""
    shown = np.arange(x.size) % max(x.size // _NODES, 1) == 0
    gaps = np.flatnonzero(np.diff(x) == 0.0) + 1
    for beside in (gaps - 1, gaps, gaps[gaps + 1 < x.size] + 1):
        shown[beside] = True
    return x[shown], y[shown]


def write_explorer(
    found: Explored[ExplorerPoint], drawings: Sequence[Animation], path: str | Path
) -> None:
    """Write the page; a reader never sees half of it.

    Args:
        found: read by a `Reader`.
        drawings: of that reader.
        path: of the HTML file.
    """
    write_text(Path(path), explorer_page(found, drawings))


def explorer_page(found: Explored[ExplorerPoint], drawings: Sequence[Animation]) -> str:
    """The page as text.

    Args:
        found: read by a `Reader`.
        drawings: of that reader.
    """
    with shown_in(recorded_units({"": found.own})):
        return _rendered(found, drawings)


def _rendered(found: Explored[ExplorerPoint], drawings: Sequence[Animation]) -> str:
    manifest, data = found.own.manifest, found.figures
    axes = [_axis(axis, found) for axis in found.axes]
    figures = list(_figures(found))
    main = main_figures(data)
    courses = _drawn_courses(found)
    content = {
        "laws": [
            {"name": law, "title": law_title(found.own, law), "colour": PALETTE[k % len(PALETTE)]}
            for k, law in enumerate(laws(data))
        ],
        "axes": axes,
        "figures": figures,
        **_sentences(found),
        "courses": courses,
        "drawing": [[] if one is None else one.drawing for one in found.seen],
        "acting": [[] if one is None else one.acting for one in found.seen],
        "pace": [[] if one is None else one.pace for one in found.seen],
        "over": layout("", "", xaxis=_LEVEL),
    }
    return (
        environment()
        .get_template("explorer.html.jinja")
        .render(
            title=manifest["title"],
            case=manifest["case"],
            variant=manifest["variant"],
            version=data.attrs["version"],
            covers=efficiency_coverage(data),
            axes=axes,
            laws=content["laws"],
            first=figures[0],
            main=[(k, one) for k, one in enumerate(figures) if one["name"] in main],
            others=[(k, one) for k, one in enumerate(figures) if one["name"] not in main],
            courses=courses,
            drawings=drawings,
            undrawn=manifest["lacks"].get("teeth", "there are no teeth to draw"),
            uncoursed=manifest["lacks"].get("cycle", ""),
            points=len(found.seen),
            impossible=int(sum(np.all(data["reason"].values != "", axis=0).ravel())),
            errors=_error_words(found),
            midpoints=found.midpoints,
            explored=packed(content),
            plotly=packed_plotly(),
        )
    )


def _axis(axis: Axis, found: Explored[ExplorerPoint]) -> dict[str, Any]:
    """What a slider needs, in the unit in which a case file shows the values."""
    quantity = axis.quantity
    values, own_value = (_shown(axis, one) for one in (axis.values, np.array([axis.own])))
    return {
        "key": axis.key,
        "words": _words(axis.key, found.own.manifest),
        "unit": show.display_unit(unit_in_use(quantity.kind, quantity.unit)),
        "values": values,
        "own": own_value[0],
        "step": _step(values),
        "whole": quantity.whole,
        "shapes": _shapes(axis, found),
    }


def _step(values: Sequence[float]) -> float:
    """Step of a slider: some twentieth of the least gap, a whole number of which reaches the last value.

    It is a trifle short, since a browser never goes beyond the last value.
    """
    span = values[-1] - values[0]
    count = np.ceil(20.0 * span / np.diff(values).min() - 1e-6)  # values have twelve digits
    return float(span / count * (1.0 - 1e-9))


def _shown(axis: Axis, values: np.ndarray) -> list[float]:
    quantity = axis.quantity
    if quantity.unit != "1":
        unit = unit_in_use(quantity.kind, quantity.unit)
        values = np.asarray(units.convert(values, unit, quantity.kind))
    return [_plain(value) for value in values]


def _plain(value: float) -> float:
    """A number without what a change of units leaves behind its twelfth digit."""
    return float(f"{value:.12g}")


_ENDS = {"torque": "loaded", "force": "loaded", "speed": "driver"}


def _words(key: str, manifest: Mapping[str, Any]) -> str:
    """What a slider changes, in words.

    Example:
        >>> _words("operation.speed", {"driver": "gear 1", "loaded": "gear 2"})
        'speed, gear 1'
        >>> _words("gears.profile_shift.1", {})
        'profile shift, gear 1'
        >>> _words("stages.2.gears.wave_generator.deflection", {})
        'stage 2, wave generator, deflection'
    """
    table, *inside = key.split(".")
    if table == "operation":
        end = _ENDS.get(inside[0])
        return ", ".join([inside[0].replace("_", " "), *([str(manifest[end])] if end else [])])
    stage = [f"stage {inside[0]}"] if table == "stages" else []
    inside = inside[2:] if stage else inside
    return ", ".join(
        [
            *stage,
            *(f"gear {part}" if part.isdecimal() else part.replace("_", " ") for part in inside),
        ]
    )


def _shapes(axis: Axis, found: Explored[ExplorerPoint]) -> bool:
    """True if the teeth, or the phases at which pairs come and go, change along an axis."""
    where = [slider.key for slider in found.axes].index(axis.key)
    numbers = np.moveaxis(
        np.arange(len(found.seen)).reshape([len(slider.values) for slider in found.axes]), where, 0
    ).reshape(len(axis.values), -1)
    return any(
        _differ(found.seen[a], found.seen[b])
        for before, after in pairwise(numbers)
        for a, b in zip(before, after, strict=True)
    )


def _differ(one: ExplorerPoint | None, other: ExplorerPoint | None) -> bool:
    if one is None or other is None:
        return False
    phases = ([course.x for course in point.courses.values()] for point in (one, other))
    return one.drawing != other.drawing or len({*map(str, phases)}) > 1


def _figures(found: Explored[ExplorerPoint]) -> Iterator[dict[str, Any]]:
    """Figures of the study with a finite value, the main ones first, at all points of the grid."""
    data, main = found.figures, main_figures(found.figures)
    others = sorted(map(str, data.data_vars), key=lambda name: (name not in main, name))
    for name in (*main, *(one for one in others if one not in main)):
        one = data[name]
        if one.dtype.kind != "f" or one.dims[:1] != ("law",) or name in _OF_SOLUTIONS:
            continue
        extra = one.dims[1 + len(found.axes) :]
        for number, label in enumerate(one[extra[0]].values if extra else [""]):
            values = one.values[..., number] if extra else one.values
            flat = display(name, values.reshape(values.shape[0], -1), data)
            if np.isfinite(flat).any():
                yield _figure(name, str(label), flat, found)


def _figure(
    name: str, label: str, values: np.ndarray, found: Explored[ExplorerPoint]
) -> dict[str, Any]:
    variable = show.described(name, found.figures)
    finite = values[np.isfinite(values)]
    words = [variable.long_name, *([label.replace("_", " ")] if label else [])]
    return {
        "name": name,
        "words": ", ".join(words),
        "axis": short_axis(name, found.figures),
        "unit": show.display_unit(variable.display),
        "range": rounded([finite.min(), finite.max()]),
        "error": _percent(found.errors[name]) if name in found.errors else "",
        "values": rounded(values, 6),
    }


def _percent(share: float) -> str:
    return f"{show.number_text(100.0 * share, 2)} %" if share >= 5e-6 else "below 0.001 %"


def _error_words(found: Explored[ExplorerPoint]) -> str:
    """How far interpolated figures are off, the worst one first."""
    errors = sorted(found.errors.items(), key=lambda one: -one[1])
    named = {show.described(name, found.figures).long_name: _percent(off) for name, off in errors}
    return ", ".join(f"{percent} {words}" for words, percent in named.items())


def _sentences(found: Explored[ExplorerPoint]) -> dict[str, Any]:
    """Sentences once, and by point and law which of them say why there are no figures, or warn."""
    sentences: dict[str, int] = {"": 0}

    def number(text: str) -> int:
        return sentences.setdefault(show.pretty(text), len(sentences))

    reasons = found.figures["reason"].values
    why = [[number(str(text)) for text in row.ravel()] for row in reasons]
    by_design: list[list[list[int]]] = [
        [[], []]
        if design is None
        else [[*map(number, design.implausible)], [*map(number, design.warnings)]]
        for design in found.seen
    ]
    absent = [number(found.refused.get(k, "")) for k in range(len(found.seen))]
    return {"why": why, "told": by_design, "absent": absent, "sentences": [*sentences]}


_LEVEL = {"automargin": False, "tickangle": 0}
"""Labels that turned upright would change the margin, and with it whether they turn: plotly.js gives up."""


def _drawn_courses(found: Explored[ExplorerPoint]) -> list[dict[str, Any]]:
    """Courses that have a finite value somewhere, phases once."""
    names = dict.fromkeys(name for one in found.seen if one is not None for name in one.courses)
    drawn = []
    for name in names:
        courses = [None if one is None else one.courses.get(name) for one in found.seen]
        sample = next(one for one in courses if one is not None)
        if not any(y is not None for one in courses if one for row in one.y for y in row):
            continue
        phase_numbers: dict[str, int] = {}
        phases: list[list[Any]] = []
        points: list[Any] = []
        for one in courses:
            if one is not None and (key := str(one.x)) not in phase_numbers:
                phase_numbers[key] = len(phases)
                phases.append(one.x)
            points.append(None if one is None else [phase_numbers[str(one.x)], one.y])
        look = layout(sample.abscissa, sample.axis, xaxis=_LEVEL)
        drawn.append(
            {
                "name": name,
                "title": sample.title,
                "phases": phases,
                "points": points,
                "layout": look,
            }
        )
    return drawn
