"""What the formulas of a publication give, side by side as it compares them."""

import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from pitchpoint.analyses.studies import PREFIX, is_study
from pitchpoint.cases.keys import quantity_at
from pitchpoint.core.status import Code
from pitchpoint.published.publication import Beside, Curves, Maps
from pitchpoint.published.publication_registry import publication_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.inputs import quantity_text
from pitchpoint.views.outlines import visible_points

__all__ = ["formulas_answer", "formulas_blocks", "formulas_lack"]

_WIDE = 6
"""Columns of numbers that a table has room for."""

_LONG = 12
"""Rows beyond which a table stands in two columns where its heads are short."""

_FEW = 4
"""Places that a sentence has room for."""

_FEW_SYMBOLS = 2
"""Symbols that the title of an axis has room for."""

_MANY = 1e6
"""Cycles from which on an axis counts them in powers of ten."""


def _besides(page: section.Page) -> Iterator[tuple[Beside, "list[_Study]"]]:
    """What the publication sets beside each other, with the studies that hold it, where there are any."""
    publication = publication_of(page.first.get("source", ""))
    for beside in publication.beside if publication else ():
        if studies := _studies(page, beside):
            yield beside, studies


class _Study(NamedTuple):
    """A study of a variant; its title names the variant where another has one of the same title."""

    name: str
    title: str
    data: xr.Dataset


def _studies(page: section.Page, beside: Beside) -> list[_Study]:
    """Studies that hold readings, without those whose points all stand in one with as much to tell."""
    candidates = [
        (variant, _Study(part.removeprefix(PREFIX), str(data.attrs["title"]), data))
        for variant, outcome in page.outcomes.items()
        for part, data in outcome.parts.items()
        if is_study(part) and _rows(data, beside)
    ]
    chosen: list[int] = []
    seen: list[_Told] = []
    for place in sorted(
        range(len(candidates)), key=lambda one: -len(_rows(candidates[one][1].data, beside))
    ):
        points = _points(candidates[place][1].data, beside)
        if not all(any(point <= shown for shown in seen) for point in points):
            chosen.append(place)
            seen += points
    left = [candidates[place] for place in sorted(chosen)]
    titles = Counter(study.title for _, study in left)
    return [
        study._replace(title=f"{study.title} ({variant})") if titles[study.title] > 1 else study
        for variant, study in left
    ]


_Told = frozenset[tuple[str, float]]


def _rows(data: xr.Dataset, beside: Beside) -> dict[str, tuple[str, ...]]:
    """Rows of which a study has all readings."""
    return {
        label: names for label, names in beside.rows.items() if all(name in data for name in names)
    }


def _points(data: xr.Dataset, beside: Beside) -> list[_Told]:
    """What is told of each point, by name of the reading."""
    every = [name for names in _rows(data, beside).values() for name in names]
    columns = {name: data[name].values[0].tolist() for name in every}
    return [
        frozenset((name, values[point]) for name, values in columns.items())
        for point in range(data.sizes["point"])
    ]


def formulas_blocks(page: section.Page) -> Iterator[section.Block]:
    """Figures and numbers that the publication sets beside each other."""
    for number, (beside, studies) in enumerate(_besides(page)):
        yield section.Paragraph(beside.note, "note")
        if beside.calibrated:
            yield section.Paragraph(beside.calibrated, "warning")
        name = f"formulas{number}"
        drawn = [
            _maps(f"{name}_map", studies, beside),
            _panel(name, studies, beside),
            _side_by_side(f"{name}_each", studies, beside),
            _families(name, studies, beside),
        ]
        yield from (panel for panel in drawn if panel.figures)
        yield from _solves(studies, beside)
        leading, *others = studies
        yield from _numbers(leading, beside)
        if others:
            inside = [block for study in others for block in _numbers(study, beside)]
            title = f"{len(others)} further studies" if len(others) > 1 else "one further study"
            yield section.Folded(f"The numbers of {title}", inside)


def _numbers(study: _Study, beside: Beside) -> Iterator[section.Block]:
    yield section.Heading(study.title)
    yield _table(study.data, beside)


def _solves(studies: list[_Study], beside: Beside) -> Iterator[section.Block]:
    """What became of solves that are not plainly solved, and where."""
    for label, names in beside.solves.items():
        by_code: dict[Code, list[str]] = {}
        for study in studies:
            for column, name in zip(beside.columns, names, strict=True):
                codes = study.data[name].values[0] if name in study.data else np.zeros(0)
                for point, code in enumerate(codes):
                    where = f"{column} at" * (len(beside.columns) > 1)
                    by_code.setdefault(Code(int(code)), []).append(
                        f"{where} {_point(study, point)}"
                    )
        for code, places in by_code.items():
            if not code.ok:
                where = "everywhere" if len(by_code) == 1 else _listed(places)
                words = f"{label[0].upper()}{label[1:]}, {where}: {code.sentence}."
                yield section.Paragraph(words, "warning")


def _listed(places: list[str]) -> str:
    """Places in words; of many the first ones and how many more there are."""
    shown = "; ".join(place.strip() for place in places[:_FEW])
    return shown + f"; and {len(places) - _FEW} more" * (len(places) > _FEW)


_Where = tuple[_Study, int]
"""A point of a study."""


def _panel(name: str, studies: list[_Study], beside: Beside) -> plot.Panel:
    """Courses at a point, with a menu of the points of all studies; it begins where most are known."""
    points = [(study, k) for study in studies for k in range(study.data.sizes["point"])]
    found_at = {k: [_known(one, *point) for point in points] for k, one in enumerate(beside.curves)}
    there = {f"{name}_{k}": beside.curves[k] for k, them in found_at.items() if any(them)}
    if not there:
        return plot.Panel("", [])
    at = int(np.argmax(np.sum([*found_at.values()], axis=0)))
    figures = [_figure(each, one, points[at], beside) for each, one in there.items()]
    choices = [
        plot.Choice(_point(*point), {each: [_at(one, *point), {}] for each, one in there.items()})
        for point in points
    ]
    several = choices if len(choices) > 1 else []
    return plot.Panel("", figures, choices=several, menu="Shown at", at=at if several else 0)


def _known(one: Curves, study: _Study, point: int) -> bool:
    """True if a study holds a number of the courses at a point."""
    if not _holds(study.data, one):
        return False
    return any(np.isfinite(study.data[name].values[point]).any() for name in one.names)


def _holds(data: xr.Dataset, one: Curves) -> bool:
    return all(variable in data for variable in one.names)


def _point(study: _Study, point: int) -> str:
    """A point of a study in words."""
    return ": ".join(filter(None, (study.title, _places(study.data)[point])))


def _at(one: Curves, study: _Study, point: int) -> dict[str, list[Any]]:
    """Places and values of courses at a point; empty where the study does not hold them."""
    data = study.data
    if not _holds(data, one):
        return dict.fromkeys("xy", [[]] * len(one.names))
    courses = [_course(variable, data, point, one) for variable in one.names]
    return {"x": [x for x, _ in courses], "y": [y for _, y in courses]}


def _families(name: str, studies: list[_Study], beside: Beside) -> plot.Panel:
    """Courses of all points of each sweep over each other; a sweep beyond all colours is left out."""
    figures = []
    for number, study in enumerate(studies):
        places = _places(study.data)
        places_of = [(study, point) for point in range(len(places))]
        drawn = [
            family
            for family in beside.families
            if not family.studies or study.name in family.studies
        ]
        for k, family in enumerate(drawn):
            if 1 < len(places) <= len(plot.PALETTE) and _holds(study.data, family):
                titled = replace(
                    family, title=f"{family.title}; {study.title[0].lower()}{study.title[1:]}"
                )
                figures.append(_family(f"{name}_{number}_{k}", titled, places_of, places))
    return plot.Panel("", figures)


def _side_by_side(name: str, studies: list[_Study], beside: Beside) -> plot.Panel:
    """Courses of all studies of one point over each other."""
    figures = []
    for k, family in enumerate(beside.over_studies):
        alone = [
            study
            for study in studies
            if study.data.sizes["point"] == 1 and _holds(study.data, family)
        ]
        titles = [study.title for study in alone]
        if 1 < len(alone) <= len(plot.PALETTE):
            figures.append(_family(f"{name}{k}", family, [(study, 0) for study in alone], titles))
    return plot.Panel("", figures)


def _family(name: str, one: Curves, points: list[_Where], titles: list[str]) -> plot.Figure:
    """One course at each of several points."""
    (variable,) = one.names
    keys = [plot.Key(show.pretty(title), plot.PALETTE[k]) for k, title in enumerate(titles)]
    unit = show.unit_of(variable)
    traces = [
        plot.legend_line(key, *_course(variable, study.data, point, one), unit)
        for key, (study, point) in zip(keys, points, strict=True)
    ]
    figure = _drawn(name, one, traces, keys)
    alike = all(trace[axis] == traces[0][axis] for trace in traces for axis in "xy")
    return replace(figure, note="All curves are the same.") if alike else figure


def _drawn(name: str, one: Curves, traces: list[plot.Trace], keys: list[plot.Key]) -> plot.Figure:
    scales: dict[str, Any] = {"yaxis": {"type": "log"}} if one.decades else {}
    if max(filter(None, traces[0]["x"]), default=0.0) > _MANY:
        scales["xaxis"] = {"exponentformat": "power", "separatethousands": False}
    axes = plot.layout(show.axis_title(one.along), _values_axis(one.names), **scales)
    return plot.Figure(
        name, _title(one), traces, axes, keys=tuple(keys), missing="No numbers were found."
    )


def _values_axis(names: tuple[str, ...]) -> str:
    """Symbols of the courses and their unit; that of the first alone where they are many."""
    symbols = dict.fromkeys(show.described(name).symbol for name in names)
    if len(symbols) > _FEW_SYMBOLS:
        return plot.short_axis(names[0])
    return show.bracketed(", ".join(symbols), show.described(names[0]))


def _title(one: Curves | Maps) -> str:
    shows = (
        f" ({one.shows} of the publication{f', {one.at}' if one.at else ''})" if one.shows else ""
    )
    return f"{one.title[0].upper()}{one.title[1:]}{shows}"


def _shown(name: str, data: xr.Dataset, point: int) -> list[Any]:
    return plot.rounded(plot.display(name, data[name].values[point]))


_LEVELS = 1000
"""Places and heights of a course at least, of which a publication may have hundreds."""


def _course(name: str, data: xr.Dataset, point: int, one: Curves) -> tuple[list[Any], list[Any]]:
    """Places and values of a course that can be seen; on decades small values keep their digits."""
    x, y = (plot.display(of, data[of].values[point]) for of in (one.along, name))
    with np.errstate(divide="ignore", invalid="ignore"):
        visible = visible_points(x, np.log10(y) if one.decades else y)
    heights = plot.rounded(y[visible]) if one.decades else plot.line_heights(y[visible], _LEVELS)
    return plot.line_heights(x[visible], _LEVELS), heights


def _figure(name: str, one: Curves, point: _Where, beside: Beside) -> plot.Figure:
    """Courses over each other at a point; empty where only other studies hold them."""
    columns = one.columns or beside.columns
    keys = [plot.Key(column, plot.PALETTE[k]) for k, column in enumerate(columns)]
    shown, unit = _at(one, *point), show.unit_of(one.names[0])
    traces = [
        plot.legend_line(key, x, y, unit)
        for key, x, y in zip(keys, shown["x"], shown["y"], strict=True)
    ]
    if any(_turns(y) > _MANY_TURNS for y in shown["y"]):
        for trace in traces:
            trace["line"]["width"], trace["opacity"] = 1, 0.75
    return _drawn(name, one, traces, keys)


_MANY_TURNS = 20
"""Turns of a course from which on lines are thin, as those of vibrations that lie close."""


def _turns(course: Sequence[float]) -> int:
    """How often a course rises after it fell, or falls after it rose."""
    steps = np.diff(np.asarray(course, dtype=float))
    return int(np.count_nonzero(steps[1:] * steps[:-1] < 0.0))


def _maps(name: str, studies: list[_Study], beside: Beside) -> plot.Panel:
    """Fields in colours at the first point of the first study that holds them."""
    figures = []
    for k, map_view in enumerate(beside.maps):
        there = [study.data for study in studies if map_view.name in study.data]
        figures += [_map(f"{name}{k}", map_view, data) for data in there[:1]]
    return plot.Panel("", figures)


def _map(name: str, one: Maps, data: xr.Dataset) -> plot.Figure:
    x, y = (_shown(axis, data, 0) for axis in one.axes)
    values = plot.display(one.name, data[one.name].values[0]).reshape(len(y), len(x))
    unit = show.unit_of(one.name)
    heat: plot.Trace = {
        "type": "heatmap",
        "x": x,
        "y": y,
        "z": plot.rounded(values, 4),
        "colorscale": plot.RISING,
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~r}} {unit}<extra></extra>",
    }
    along, across = (show.axis_title(axis) for axis in one.axes)
    axes = plot.layout(
        along, across.replace(", ", ",<br>")
    )  # in one line it is longer than the axis
    return plot.Figure(name, _title(one), [heat], axes, missing="No numbers were found.")


def _table(data: xr.Dataset, beside: Beside) -> section.SectionTable:
    """Points of a sweep side by side, or below each other where they are many."""
    places, rows = _places(data), _rows(data, beside).items()
    if len(places) * len(beside.columns) > _WIDE:
        long = [
            (f"{_titled(label, names[0])}, {place}", *_cells(data, names, point))
            for label, names in rows
            for point, place in enumerate(places)
        ]
        return section.SectionTable(["Quantity", *beside.columns], long)
    heads = [
        ", ".join(filter(None, (place, label))) for place in places for label in beside.columns
    ]
    wide = [
        (
            _titled(label, names[0]),
            *(cell for point in range(len(places)) for cell in _cells(data, names, point)),
        )
        for label, names in rows
    ]
    return section.SectionTable(
        ["Quantity", *heads], wide, compact=len(heads) < 4 or len(wide) > _LONG
    )


def _titled(told: str, name: str) -> str:
    unit = show.unit_of(name)
    return f"{told} [{unit}]" if unit else told


def _cells(data: xr.Dataset, names: tuple[str, ...], point: int) -> Iterator[str]:
    for name in names:
        value = float(data[name].values[0, point])
        is_finite = np.isfinite(value)
        yield show.quantity(name, value, with_unit=False) if is_finite else "not found"


def _places(data: xr.Dataset) -> list[str]:
    """Places on the axis of a study in words; one without words where there is none."""
    if "axis" not in data:
        return [""]
    quantity = quantity_at(data.attrs["sweep_key"])
    return [
        quantity_text(float(value), quantity) if quantity is not None else f"{value:.6g}"
        for value in data["axis"].values
    ]


def formulas_answer(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """What the publication is about, at the first point of the first study."""
    publication = publication_of(str(outcome.manifest.get("source", "")))
    for name in publication.answers if publication else ():
        held = (data for part, data in outcome.parts.items() if is_study(part) and name in data)
        for data in itertools.islice(held, 1):
            value = float(data[name].values[0, 0])
            words = show.quantity(name, value) if np.isfinite(value) else "not found"
            at = _Study("", str(data.attrs["title"]), data)
            yield section.KeyFigure(
                5.0, show.described(name).long_name, words, f"({_point(at, 0)})"
            )


def formulas_lack(page: section.Page) -> str | None:
    """None where studies hold what the publication compares; nobody asks for it elsewhere."""
    return None if any(_besides(page)) else ""
