"""Films over patches of finite contacts: maps of pressure and film, cuts, ends, courses of the cycle."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.film_courses import (
    MOST,
    NONE,
    contact_place,
    course_figure,
    cycle_trace,
    figure_notes,
    figures_table,
    film_course_panel,
    film_key_figure,
    film_law_errors,
    film_tables,
    films_sentence,
    missing_films,
    of_most,
    solved_how,
)
from pitchpoint.views.lines import titled
from pitchpoint.views.point import period_of

__all__ = ["finite_film_blocks", "finite_film_facts", "finite_film_printed"]

_THIN = 2.0
"""Film over that in the middle up to which a map has colours."""

_STEEP = 1.5
"""Pressure over the largest one in the middle up to which a map has colours."""

_WIDE = 1.8
"""Half-widths up to which a map shows a contact."""

_EDGE = 0.05
"""Part of the largest dry pressure at which its edge is drawn."""

_MOST_CELLS = 130
"""Cells either way that a map in a page shows at most."""

_CONTACTS = {"finite_line": "line contacts with their ends", "elliptic": "elliptic contacts"}


# ---- maps


def maps_panel(name: str, data: xr.Dataset, kept: int) -> plot.Panel:
    """Pressure, film and its temperature over the patch of a contact, and cuts through them."""
    figures = [
        _map(f"{name}_pressure", data, kept, "field_pressure"),
        _map(f"{name}_film", data, kept, "field_film", _OF_FILM),
        _cut_across(f"{name}_cut_pressure", data, kept, "field_pressure"),
        _cut_across(f"{name}_cut_film", data, kept, "field_film"),
        _ridge(f"{name}_ridge", data, kept),
        _valley(f"{name}_valley", data, kept),
    ]
    if "field_rise" in data:
        figures[2:2] = [_map(f"{name}_rise", data, kept, "field_rise")]
        figures.append(_warmth_along(f"{name}_warmth", data, kept))
    if is_rough(data):
        figures += [
            _roughness(f"{name}_heights", data, kept),
            _cut_heights(f"{name}_cut_heights", data, kept),
        ]
    return plot.Panel("", figures)


FLAT = 1e-13
"""Height below which cells see no map but rounding [m]."""


def is_rough(data: xr.Dataset) -> bool:
    """True if height maps lie on the contacts that are kept."""
    has_heights = "field_heights" in data
    return has_heights and bool(np.nanmax(np.abs(data["field_heights"].values), initial=0.0) > FLAT)


def _roughness(name: str, data: xr.Dataset, kept: int) -> plot.Figure:
    """Heights of both surfaces as the cells of the grid see them."""
    heat = {**_heat(data, kept, "field_heights"), "colorscale": plot.evenly("#1c1c1c", "#ffffff")}
    look = _patch_axes(data, kept)
    note = "Every cell sees the mean of the map over its area; what stands out is above zero."
    keys = (plot.Key("edge of the dry contact", plot.INK, "dot"),)
    return plot.Figure(
        name, "Roughness seen", [heat, _outline(data, kept, heat)], look, note, keys, NONE
    )


def _cut_heights(name: str, data: xr.Dataset, kept: int) -> plot.Figure:
    """Film and heights along the contact, in its middle row."""
    x, _ = _places(data, kept)
    row = data["field_film"].shape[1] // 2
    keys = {
        "field_film": plot.Key("film", plot.INK),
        "field_heights": plot.Key("heights", plot.GREY, "dash"),
    }
    lines = [
        _line(key, "kept_x", x, field, data[field].values[kept, row]) for field, key in keys.items()
    ]
    ends = (
        1.2 * float(np.min(data["field_heights"].values[kept])),
        2.0 * _THIN * _middle_film(data, kept),
    )
    axes = {
        "xaxis": {"range": _reach(data, kept)},
        "yaxis": {"range": [float(plot.display("field_film", end)) for end in ends]},
    }
    look = plot.layout(f"x [{show.unit_of('kept_x')}]", plot.short_axis("field_film"), **axes)
    title = "Film and heights along the contact, in its middle"
    return plot.Figure(name, title, lines, look, "", tuple(keys.values()), NONE)


def _places(data: xr.Dataset, kept: int) -> tuple[np.ndarray, np.ndarray]:
    return data["kept_x"].values[kept], data["kept_y"].values[kept]


def _middle_film(data: xr.Dataset, kept: int) -> float:
    """Film where the pressure of the middle rows is largest [m]."""
    pressure, film = (data[f"field_{name}"].values[kept] for name in ("pressure", "film"))
    row = film.shape[0] // 2
    return float(film[row, np.argmax(pressure[row])])


def _map(
    name: str, data: xr.Dataset, kept: int, variable: str, colours: list[list[Any]] = plot.RISING
) -> plot.Figure:
    """A variable over the patch, with the edge of the dry contact."""
    values = data[variable].values[kept]
    low, high = min(float(np.nanmin(values)), 0.0), _END_OF_COLOURS[variable](data, kept)
    shown = (
        float(plot.display(variable, low)),
        float(plot.display(variable, max(high, low + 1e-12))),
    )
    heat = {
        **_heat(data, kept, variable),
        "zmin": shown[0],
        "zmax": shown[1],
        "colorscale": colours,
    }
    look = _patch_axes(data, kept)
    note = _CUT_COLOURS.get(variable, "") if high < float(np.nanmax(values)) else ""
    keys = (plot.Key("edge of the dry contact", plot.INK, "dot"),)
    traces = [heat, _outline(data, kept, heat)]
    return plot.Figure(name, titled(variable), traces, look, note, keys, NONE)


def _patch_axes(data: xr.Dataset, kept: int) -> dict[str, Any]:
    """Axes of a map over the patch, at equal scales where it is about as wide as it is long."""
    unit, reach = show.unit_of("kept_x"), _reach(data, kept)
    across = plot.display("kept_y", _places(data, kept)[1])
    alike = 0.5 < np.ptp(across) / np.ptp(reach) < 2.0
    equal = {"scaleanchor": "x", "scaleratio": 1, "constrain": "domain"} if alike else {}
    xaxis = {"range": reach, "constrain": "domain", "nticks": 3 if alike else 5}
    return plot.layout(f"x [{unit}]", f"y [{unit}]", xaxis=xaxis, yaxis=equal)


def _heat(data: xr.Dataset, kept: int, variable: str) -> plot.Trace:
    """Cells of a map, thinned where there are more than a page can show."""
    (x, y), (rows, columns) = _places(data, kept), _cells(data, kept)
    unit, along = show.unit_of(variable), show.unit_of("kept_x")
    return {
        "type": "heatmap",
        "x": plot.rounded(plot.display("kept_x", x[columns])),
        "y": plot.rounded(plot.display("kept_y", y[rows])),
        "z": plot.rounded(
            plot.display(variable, data[variable].values[kept][np.ix_(rows, columns)]), 4
        ),
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~r}} {unit}<br>x %{{x:.4~r}} {along}, y %{{y:.4~r}} {along}"
        "<extra></extra>",
    }


def _outline(data: xr.Dataset, kept: int, heat: plot.Trace) -> plot.Trace:
    """Edge of the dry contact."""
    dry = _dry(data, kept)[np.ix_(*_cells(data, kept))]
    return {
        "type": "contour",
        "x": heat["x"],
        "y": heat["y"],
        "z": plot.rounded(dry / np.max(dry), 3),
        "contours": {"start": _EDGE, "end": _EDGE, "size": 1.0, "coloring": "none"},
        "line": {"color": plot.INK, "width": 1.2, "dash": "dot"},
        "showscale": False,
        "hoverinfo": "skip",
    }


def _dry(data: xr.Dataset, kept: int) -> np.ndarray:
    pressure: np.ndarray = data["field_dry_pressure"].values[kept]
    return pressure


def _reach(data: xr.Dataset, kept: int) -> list[float]:
    """Ends of an axis along the contact that shows it with what is beside it."""
    x, _ = _places(data, kept)
    wide = _WIDE * float(np.max(np.abs(x[np.any(_dry(data, kept) > 0.0, axis=0)])))
    return [float(plot.display("kept_x", end)) for end in (-wide, wide)]


def _cells(data: xr.Dataset, kept: int) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = (_thinned(size) for size in _dry(data, kept).shape)
    return rows, columns


def _highest(data: xr.Dataset, kept: int) -> float:
    """Pressure at which colours end: ends of lines would take all of them."""
    pressure = data["field_pressure"].values[kept]
    middle = float(np.max(pressure[pressure.shape[0] // 2]))
    return min(float(np.max(pressure)), _STEEP * middle)


_OF_FILM = plot.evenly("#081d58", "#225ea8", "#41b6c4", "#c7e9b4", "#fffff2")
"""Colours of a film: what is thin stands out from what is too thick to matter."""

_END_OF_COLOURS: Mapping[str, Callable[[xr.Dataset, int], float]] = {
    "field_pressure": _highest,
    "field_film": lambda data, kept: _THIN * _middle_film(data, kept),
    "field_rise": lambda data, kept: float(np.nanmax(data["field_rise"].values[kept])),
}
"""Value of a map at which its colours end."""

_CUT_COLOURS = {
    "field_pressure": f"Colours end at {_STEEP:g} times the largest pressure in the middle.",
    "field_film": f"Colours end at {_THIN:g} times the film in the middle.",
}
"""Words under a map with values beyond that."""


def _thinned(size: int) -> np.ndarray:
    return np.unique(np.linspace(0, size - 1, min(size, _MOST_CELLS)).round().astype(int))


# ---- cuts


def _rows(data: xr.Dataset, kept: int) -> Iterator[tuple[plot.Key, int]]:
    """Rows of cuts along x: in the middle, near both ends, half a half-width away from them."""
    x, y = _places(data, kept)
    carries = _dry(data, kept) > 0.0
    held = np.flatnonzero(np.any(carries, axis=1))
    wide = 0.5 * np.ptp(x[np.any(carries, axis=0)])
    ends = y[held[0]] + 0.5 * wide, y[held[-1]] - 0.5 * wide
    middle = 0.5 * (y[held[0]] + y[held[-1]])
    places = (middle, ends[1]) if _symmetric(data, kept) else (middle, *ends)
    for colour, place in zip((plot.INK, *plot.PALETTE), places, strict=False):
        row = int(np.argmin(np.abs(y - place)))
        yield plot.Key(_at_row(data, kept, row), colour), row


def _symmetric(data: xr.Dataset, kept: int) -> bool:
    """True if both ends are alike."""
    pressure = data["field_pressure"].values[kept]
    return bool(np.allclose(pressure, pressure[::-1], rtol=0.0, atol=1e-4 * np.max(pressure)))


def _at_row(data: xr.Dataset, kept: int, row: int) -> str:
    place = show.number_text(float(plot.display("kept_y", data["kept_y"].values[kept, row])))
    unit = show.unit_of("kept_y")
    return f"y = {place} {unit}"


def _cut_across(name: str, data: xr.Dataset, kept: int, variable: str) -> plot.Figure:
    """Values along x, in the middle and near both ends."""
    x, _ = _places(data, kept)
    values, rows = data[variable].values[kept], [*_rows(data, kept)]
    lines = [_line(key, "kept_x", x, variable, values[row]) for key, row in rows]
    axes = {"xaxis": {"range": _reach(data, kept)}}
    if variable == "field_film":
        low = min(float(np.nanmin(values)), 0.0)
        ends = 1.1 * low, 2.0 * _THIN * _middle_film(data, kept)
        axes["yaxis"] = {"range": [float(plot.display(variable, end)) for end in ends]}
    look = plot.layout(f"x [{show.unit_of('kept_x')}]", plot.short_axis(variable), **axes)
    what = "Pressure" if variable == "field_pressure" else "Film"
    title = f"{what} along the contact, in the middle and near its ends"
    return plot.Figure(name, title, lines, look, "", tuple(key for key, _ in rows), NONE)


def _line(
    key: plot.Key, along: str, places: np.ndarray, variable: str, values: np.ndarray
) -> plot.Trace:
    return plot.legend_line(
        key,
        plot.display(along, places),
        plot.display(variable, values),
        show.unit_of(variable),
        name=key.label,
    )


def _ridge(name: str, data: xr.Dataset, kept: int) -> plot.Figure:
    """Largest pressure of every row, and what asperities carry there."""
    _, y = _places(data, kept)
    keys = (
        plot.Key("with oil", plot.INK),
        plot.Key("dry", plot.GREY, "dash"),
        plot.Key("of it on asperities", plot.INK, "dot"),
    )
    names = ("field_pressure", "field_dry_pressure", "field_asperity_pressure")
    lines = [
        _line(key, "kept_y", y, "field_pressure", np.max(data[variable].values[kept], axis=1))
        for key, variable in zip(keys, names, strict=True)
    ]
    look = plot.layout(f"y [{show.unit_of('kept_y')}]", plot.short_axis("field_pressure"))
    return plot.Figure(name, "Largest pressure across the contact", lines, look, "", keys, NONE)


def _valley(name: str, data: xr.Dataset, kept: int) -> plot.Figure:
    """Smallest film of every row, and film in its middle."""
    x, y = _places(data, kept)
    film = data["field_film"].values[kept]
    held = np.any(_dry(data, kept) > 0.0, axis=1)
    middle = film[:, int(np.argmin(np.abs(x)))]
    keys = (
        plot.Key("in the middle, x = 0", plot.INK, "dash"),
        plot.Key("smallest of the row", plot.INK),
    )
    values = np.where(held, middle, np.nan), np.where(held, np.min(film, axis=1), np.nan)
    lines = [
        _line(key, "kept_y", y, "field_film", heights)
        for key, heights in zip(keys, values, strict=True)
    ]
    look = plot.layout(f"y [{show.unit_of('kept_y')}]", plot.short_axis("field_film"))
    return plot.Figure(
        name, "Film across the contact, where its dry rows carry", lines, look, "", keys, NONE
    )


def _warmth_along(name: str, data: xr.Dataset, kept: int) -> plot.Figure:
    """Temperatures of film and surfaces above the inlet along x, in the row where the film is warmest."""
    x, _ = _places(data, kept)
    film = data["field_rise"].values[kept]
    row = int(np.argmax(np.max(film, axis=1)))
    keys = (
        plot.Key("film", plot.INK),
        plot.Key("surface of body 1", plot.PALETTE[0]),
        plot.Key("surface of body 2", plot.PALETTE[1]),
    )
    names = ("field_rise", "field_surface_rise_1", "field_surface_rise_2")
    lines = [
        _line(key, "kept_x", x, "field_rise", data[variable].values[kept][row])
        for key, variable in zip(keys, names, strict=True)
    ]
    axes = {"xaxis": {"range": _reach(data, kept)}}
    look = plot.layout(f"x [{show.unit_of('kept_x')}]", plot.short_axis("field_rise"), **axes)
    title = f"Temperature above the inlet, in the warmest row, {_at_row(data, kept, row)}"
    return plot.Figure(name, title, lines, look, "", keys, NONE)


# ---- over the mesh cycle


def _pressures(name: str, outcome: Outcome, data: xr.Dataset) -> plot.Figure:
    """Largest pressures over the mesh cycle: in all, near the ends, and of the dry line."""
    near = np.nanmax(data["near_ends"].values, axis=-2, initial=-np.inf)
    near = np.where(np.isfinite(near), near, np.nan)
    courses_of = {
        plot.Key("largest, with oil", plot.INK): data["film_pressure"].values,
        plot.Key("Hertz", plot.GREY, "dash"): data["pressure"].values,
    }
    for k, far in enumerate(data["distance"].values):
        if np.isfinite(near[..., k]).any():
            courses_of[plot.Key(f"{far:g} b from an end", plot.PALETTE[k])] = near[..., k]
    lines = [
        (key, cycle_trace(data, "film_pressure", key, of_most(data, values)))
        for key, values in courses_of.items()
    ]
    axis = period_of(outcome).axis
    return course_figure(name, "Pressure over the mesh cycle", "film_pressure", lines, axis, MOST)


# ---- tables and words


def _ends_table(data: xr.Dataset) -> section.SectionTable:
    """Pressures at distances from the ends of the contact that carries most, here and on a coarser grid."""
    at = tuple(data["kept_at"].values[0])
    here, coarse = data["near_ends"].values[at], data["coarse_near_ends"].values[0]

    def cells(values: np.ndarray) -> list[str]:
        return [_or_nothing("near_ends", float(value)) for value in values]

    rows = [
        (
            f"{far:g} b from the end",
            *cells(here[:, k]),
            _or_nothing("near_ends", float(np.max(coarse[:, k]))),
        )
        for k, far in enumerate(data["distance"].values)
    ]
    largest = float(data["film_pressure"].values[at])
    coarse_largest = _or_nothing("film_pressure", float(data["coarse_largest_pressure"].values[0]))
    caption = "largest of all cells: in the last row a number of the grid"
    rows.append((caption, _or_nothing("film_pressure", largest), "", coarse_largest))
    rows.append(
        ("Hertz, without ends", _or_nothing("pressure", float(data["pressure"].values[at])), "", "")
    )
    return section.SectionTable(
        ["", "first end", "last end", "higher one on a coarser grid"], rows, compact=True
    )


def _or_nothing(name: str, value: float) -> str:
    return show.quantity(name, value) if np.isfinite(value) else ""


def _grid_table(data: xr.Dataset) -> section.SectionTable:
    """Values of the contact that carries most, on its grid, on one of half as many cells, and as a line."""
    at = tuple(data["kept_at"].values[0])
    lines = ["line without ends"] * ("line_central_film" in data)

    def value(name: str) -> str:
        return _or_nothing(name, float(data[name].values[at])) if name in data else ""

    rows = []
    for name, endless in _ON_GRIDS.items():
        coarse = float(data[f"coarse_{_COARSE.get(name, name)}"].values[0])
        beside = [value(endless) for _ in lines]
        rows.append((titled(name), value(name), _or_nothing(name, coarse), *beside))
    return section.SectionTable(
        ["", "this grid", "half as many cells either way", *lines], rows, compact=True
    )


_ON_GRIDS = {
    "central_film": "line_central_film",
    "minimum_film": "",
    "film_friction": "line_friction",
}
_COARSE = {"film_friction": "friction"}


_WHICH = ("carries most", "has the thinnest film")


def finite_film_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "finite_film", _of_variant)


def _of_variant(position: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["finite_film"]
    yield from missing_films(data)
    still = np.unique(data["central_film"].values).size == 1  # one contact, the same at all phases
    times = {"times": "times, at all of which the contact is the same,"} if still else {}
    yield section.Paragraph(solved_how(data, _CONTACTS[data.attrs["solver"]], _grid(data), **times))
    yield figures_table(outcome, data)
    yield from figure_notes(data)
    if int(data["solved_contacts"]):
        yield from _of_kept(position, data)
    if not still:
        yield section.Heading("Over the mesh cycle")
        name = f"finite{position}"
        figures = [_pressures(f"{name}_pressures", outcome, data)]
        yield film_course_panel(name, outcome, data, figures)
    yield from film_law_errors(data)


def _grid(data: xr.Dataset) -> str:
    nodes, cells = json.loads(data.attrs["grid"])
    ends = {
        "mirrored": ", bodies that end with the line",
        "half_space": ", bodies that go on beyond it",
    }
    profile = data.attrs["end_profile"].replace("_", " ")
    ends_words = f", ends {profile}" if profile else ""
    return f"{nodes} nodes along and {cells} cells across{ends.get(data.attrs['ends'], '')}{ends_words}"


def _of_kept(position: int, data: xr.Dataset) -> Iterator[section.Block]:
    """Maps and cuts of the contacts that are kept, and what their grid is worth."""
    places = [tuple(map(int, at)) for at in data["kept_at"].values]
    for k, (phase, pair, part) in enumerate(places):
        if k and places[k] == places[0]:
            yield section.Paragraph("It has the thinnest film as well.", "note")
            continue
        yield section.Heading(f"The contact that {_WHICH[k]}")
        yield section.Paragraph(
            f"At {contact_place(data, phase, pair, part)}: {_loaded(data, places[k])}. Oil enters from "
            "the left where the surfaces run to the right.",
            "note",
        )
        yield maps_panel(f"patch{position}_{k}", data, k)
    tables = []
    if np.isfinite(data["near_ends"].values).any():
        tables.append(_ends_table(data))
    if np.isfinite(data["coarse_central_film"].values).any():
        tables.append(_grid_table(data))
    if tables:
        yield section.Folded("What the grid is worth", tables)


def _loaded(data: xr.Dataset, at: tuple[int, ...]) -> str:
    force = show.quantity("load", float(data["load"].values[at]))
    long = float(data["line_length"].values[at]) if data.attrs["solver"] == "finite_line" else 0.0
    return f"{force} on {show.quantity('line_length', long)}" if long else force


def finite_film_facts(outcome: Outcome) -> Iterable[section.KeyFigure]:
    """What the films come to."""
    return [
        film_key_figure("Films of finite contacts", films_sentence(outcome.parts["finite_film"]))
    ]


def finite_film_printed(outcome: Outcome) -> Iterable[section.Printed]:
    """What the screen shows."""
    return film_tables("Films of finite contacts", outcome.parts["finite_film"])
