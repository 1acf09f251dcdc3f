"""What the formulas of a publication give, side by side as it compares them."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.studies import is_study
from pitchpoint.cases.schema import quantity_at
from pitchpoint.published.publication import Beside, Curves
from pitchpoint.published.registry import PUBLICATIONS
from pitchpoint.status import Code
from pitchpoint.views import show
from pitchpoint.views.figures import (
    PALETTE,
    Choice,
    Figure,
    Key,
    Panel,
    Trace,
    display,
    layout,
    plain,
    rounded,
    short_axis,
)
from pitchpoint.views.inputs import in_words
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Section, Table

__all__ = ["FORMULAS"]

_WIDE = 6
"""Columns of numbers that a table has room for."""

_MANY = 1e6
"""Cycles from which on an axis counts them in powers of ten."""


def _besides(page: Page) -> tuple[Beside, ...]:
    """What the publication sets beside each other, as far as a study holds it."""
    source = page.first.get("source", "")
    every = PUBLICATIONS[source].beside if source in PUBLICATIONS else ()
    return tuple(one for one in every if _studies(page, one))


def _studies(page: Page, beside: Beside) -> list[xr.Dataset]:
    """Studies that hold readings, without those whose points all stand in one with as much to tell."""
    found = [
        data
        for one in page.outcomes.values()
        for part, data in one.parts.items()
        if is_study(part) and _rows(data, beside)
    ]
    kept: list[int] = []
    seen: list[_Told] = []
    for place in sorted(range(len(found)), key=lambda one: -len(_rows(found[one], beside))):
        points = _points(found[place], beside)
        if not all(any(point <= other for other in seen) for point in points):
            kept.append(place)
            seen += points
    return [found[place] for place in sorted(kept)]


_Told = frozenset[tuple[str, float]]


def _rows(data: xr.Dataset, beside: Beside) -> dict[str, tuple[str, ...]]:
    """Rows of which a study has all readings."""
    return {
        told: names for told, names in beside.rows.items() if all(name in data for name in names)
    }


def _points(data: xr.Dataset, beside: Beside) -> list[_Told]:
    """What is told of each point, by name of the reading."""
    every = [name for names in _rows(data, beside).values() for name in names]
    columns = {name: data[name].values[0].tolist() for name in every}
    return [
        frozenset((name, values[point]) for name, values in columns.items())
        for point in range(data.sizes["point"])
    ]


def _blocks(page: Page) -> Iterator[Block]:
    for number, beside in enumerate(_besides(page)):
        yield Paragraph(beside.note, "note")
        if beside.calibrated:
            yield Paragraph(beside.calibrated, "warning")
        for position, data in enumerate(_studies(page, beside)):
            yield Heading(str(data.attrs["title"]))
            yield _table(data, beside)
            yield from _solves(data, beside)
            name = f"formulas{number}_{position}"
            panels = _panel(name, data, beside), _families(f"{name}_all", data, beside)
            yield from (panel for panel in panels if panel.figures)


def _solves(data: xr.Dataset, beside: Beside) -> Iterator[Block]:
    """What became of solves that are not plainly solved, and where."""
    for told, names in beside.solves.items():
        found: dict[Code, list[str]] = {}
        for column, name in zip(beside.columns, names, strict=True):
            codes = data[name].values[0] if name in data else np.zeros(0)
            for place, code in zip(_places(data), codes, strict=False):
                where = " at ".join(filter(None, (column, place)))
                found.setdefault(Code(int(code)), []).append(where)
        for code, places in found.items():
            if not code.ok:
                words = f"{told.capitalize()}, {', '.join(places)}: {code.sentence}."
                yield Paragraph(words, "warning")


def _panel(name: str, data: xr.Dataset, beside: Beside) -> Panel:
    """Courses of a study, with a menu of its points; empty where it has none."""
    there = [one for one in beside.curves if all(each in data for each in one.names)]
    curves = {f"{name}_{k}": one for k, one in enumerate(there)}
    figures = [_figure(each, one, data, beside) for each, one in curves.items()]
    choices = [
        Choice(place, {each: [_changed(one, data, point), {}] for each, one in curves.items()})
        for point, place in enumerate(_places(data))
    ]
    several = len(choices) > 1 and bool(figures)
    return Panel("", figures, choices=choices if several else [], menu="Shown at")


def _changed(one: Curves, data: xr.Dataset, point: int) -> dict[str, list[Any]]:
    """What a choice of a point changes: values, and places where they are others."""
    places = data[one.along].values
    moved = not np.array_equal(places[point], places[0])
    x = {"x": [_shown(one.along, data, point)] * len(one.names)} if moved else {}
    return {**x, "y": [_shown(name, data, point) for name in one.names]}


def _families(name: str, data: xr.Dataset, beside: Beside) -> Panel:
    """Courses of all points of a sweep over each other; empty without a sweep, or beyond all colours."""
    places = _places(data)
    if not 1 < len(places) <= len(PALETTE):
        return Panel("", [])
    there = [one for one in beside.families if all(each in data for each in one.names)]
    return Panel("", [_family(f"{name}{k}", one, data, places) for k, one in enumerate(there)])


def _family(name: str, one: Curves, data: xr.Dataset, places: list[str]) -> Figure:
    """A course at each point of a sweep."""
    (variable,) = one.names
    keys = [Key(place, PALETTE[k]) for k, place in enumerate(places)]
    traces = [
        plain(
            key,
            _shown(one.along, data, point),
            _shown(variable, data, point),
            show.unit_of(variable),
        )
        for point, key in enumerate(keys)
    ]
    return _drawn(name, one, traces, keys)


def _drawn(name: str, one: Curves, traces: list[Trace], keys: list[Key]) -> Figure:
    scales: dict[str, Any] = {"yaxis": {"type": "log"}} if one.decades else {}
    if max(filter(None, traces[0]["x"]), default=0.0) > _MANY:
        scales["xaxis"] = {"exponentformat": "power", "separatethousands": False}
    axes = layout(show.axis_title(one.along), short_axis(one.names[0]), **scales)
    title = one.title[0].upper() + one.title[1:]
    return Figure(name, title, traces, axes, keys=tuple(keys), missing="No numbers were found.")


def _shown(name: str, data: xr.Dataset, point: int) -> list[Any]:
    return rounded(display(name, data[name].values[point]))


def _figure(name: str, one: Curves, data: xr.Dataset, beside: Beside) -> Figure:
    """Courses over each other at the first point."""
    columns = one.columns or beside.columns
    keys = [Key(column, PALETTE[k]) for k, column in enumerate(columns)]
    unit, places = show.unit_of(one.names[0]), display(one.along, data[one.along].values[0])
    traces = [
        plain(key, places, display(each, data[each].values[0]), unit, opacity=0.75)
        for key, each in zip(keys, one.names, strict=True)
    ]
    for trace in traces:
        trace["line"]["width"] = 1  # of vibrations that lie close
    return _drawn(name, one, traces, keys)


def _table(data: xr.Dataset, beside: Beside) -> Table:
    """Points of a sweep side by side, or below each other where they are many."""
    places, rows = _places(data), _rows(data, beside).items()
    if len(places) * len(beside.columns) > _WIDE:
        long = [
            (f"{_titled(told, names[0])}, {place}", *_cells(data, names, point))
            for told, names in rows
            for point, place in enumerate(places)
        ]
        return Table(["Quantity", *beside.columns], long)
    heads = [", ".join(filter(None, (place, told))) for place in places for told in beside.columns]
    wide = [
        (
            _titled(told, names[0]),
            *(cell for point in range(len(places)) for cell in _cells(data, names, point)),
        )
        for told, names in rows
    ]
    return Table(["Quantity", *heads], wide)


def _titled(told: str, name: str) -> str:
    unit = show.unit_of(name)
    return f"{told} [{unit}]" if unit else told


def _cells(data: xr.Dataset, names: tuple[str, ...], point: int) -> Iterator[str]:
    for name in names:
        value = float(data[name].values[0, point])
        known = np.isfinite(value)
        yield show.quantity(name, value, with_unit=False) if known else "not found"


def _places(data: xr.Dataset) -> list[str]:
    """Places on the axis of a study in words; one without words where there is none."""
    if "axis" not in data:
        return [""]
    quantity = quantity_at(data.attrs["sweep_key"])
    return [
        in_words(float(value), quantity) if quantity is not None else f"{value:.6g}"
        for value in data["axis"].values
    ]


def _lacks(page: Page) -> str | None:
    return None if _besides(page) else ""


FORMULAS = Section(
    name="formulas",
    title="Formulas of the publication",
    short="Formulas",
    order=610.0,
    lacks=_lacks,
    blocks=_blocks,
)
