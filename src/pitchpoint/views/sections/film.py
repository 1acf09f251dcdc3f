"""Films of the contacts solved over the mesh cycle, beside film laws and friction laws."""

import json
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.film_courses import (
    NONE,
    figure_notes,
    figures_table,
    film_course_panel,
    film_key_figure,
    film_law_errors,
    film_tables,
    films_sentence,
    missing_films,
    solved_how,
)
from pitchpoint.views.lines import titled

__all__ = ["film_answer", "film_blocks", "film_facts", "film_printed", "profiles_panel"]

_SEEN = 0.01
"""Part of the largest pressure of the cycle from which on a profile is seen without zooming out."""

# ---- across the contacts


def profiles_panel(name: str, data: xr.Dataset) -> plot.Panel:
    """Film and pressure across the contacts that carry most, with the phase to slide."""
    figures = [_film_profile(f"{name}_film", data), _pressure_profile(f"{name}_pressure", data)]
    if "profile_rise" in data:
        figures.append(_warm_profile(f"{name}_rise", data))
    choices = [_choice(data, figures, int(phase)) for phase in _in_order(data)]
    return plot.Panel("", figures, choices=choices, menu="Phase", slides=True)


def _in_order(data: xr.Dataset) -> np.ndarray:
    """Positions of the phases from 0 to 1, wherever the period begins."""
    return np.argsort(data["phase"].values % 1.0, kind="stable")


def _choice(data: xr.Dataset, figures: Sequence[plot.Figure], phase: int) -> plot.Choice:
    lines = _film_lines, _pressure_lines, _warm_lines
    pairs = zip(figures, lines, strict=False)
    changes = {figure.name: lines_of(data, phase) for figure, lines_of in pairs}
    label = f"{float(data['phase'][phase]) % 1.0:.3f}"
    return plot.Choice(label, {key: [_points(lines), {}] for key, lines in changes.items()})


def _points(lines: Sequence[plot.Trace]) -> dict[str, list[list[float]]]:
    return {axis: [line[axis] for line in lines] for axis in ("x", "y")}


def _film_profile(name: str, data: xr.Dataset) -> plot.Figure:
    middle = np.argmin(np.abs(data["profile_place"].values), axis=-1)[..., None]
    film = np.take_along_axis(data["profile_film"].values, middle, axis=-1)
    ends = 1.1 * np.nanmin(film, initial=0.0), 2.5 * np.nanmax(film, initial=0.0)
    axes = _across(data, "profile_film", *ends)
    title, phase = titled("profile_film", data), int(_in_order(data)[0])
    lines = _film_lines(data, phase)
    return plot.Figure(name, title, lines, axes, "", (*_keys(data), DRY), NONE)


DRY = plot.Key("±b of the dry contact", plot.GREY)


def _pressure_profile(name: str, data: xr.Dataset) -> plot.Figure:
    top = 1.08 * np.nanmax(data["profile_pressure"].values, initial=0.0)
    axes = _across(data, "profile_pressure", 0.0, top)
    keys = [*_keys(data), plot.Key("of it on asperities", plot.GREY, "dot"), DRY]
    title, phase = titled("profile_pressure", data), int(_in_order(data)[0])
    return plot.Figure(name, title, _pressure_lines(data, phase), axes, SPIKE, tuple(keys), NONE)


SPIKE = "A spike is resolved by few nodes: its height changes with the grid."


def _warm_profile(name: str, data: xr.Dataset) -> plot.Figure:
    """Temperatures of film and surfaces across the contacts."""
    top = 1.08 * np.nanmax(data["profile_rise"].values, initial=0.0)
    axes = _across(data, "profile_rise", 0.0, top)
    keys = [
        *_keys(data),
        plot.Key("surface of body 1", plot.GREY, "dot"),
        plot.Key("surface of body 2", plot.GREY, "dash"),
    ]
    title, phase = "Temperatures above the inlet", int(_in_order(data)[0])
    return plot.Figure(name, title, _warm_lines(data, phase), axes, "", tuple(keys), NONE)


def _warm_lines(data: xr.Dataset, phase: int) -> list[plot.Trace]:
    """Mean temperature of every film, and those of its surfaces."""
    dashes = {
        "profile_rise": "solid",
        "profile_surface_rise_1": "dot",
        "profile_surface_rise_2": "dash",
    }
    return [
        _profile(data, name, phase, k, plot.Key(key.label, key.colour, dash))
        for name, dash in dashes.items()
        for k, key in enumerate(_keys(data))
    ]


def _across(data: xr.Dataset, name: str, low: float, top: float) -> dict[str, object]:
    """Layout with axes that stay as they are while the phase slides."""
    wide = plot.display("profile_place", data["profile_place"].values)[_pressed(data)]
    ends = np.array([np.min(wide, initial=-1e-6), np.max(wide, initial=1e-6)])
    ends += 0.05 * np.ptp(ends) * np.array([-1.0, 1.0])
    high = float(plot.display(name, top)) if top > 0.0 else 1.0
    return plot.layout(
        f"x [{show.unit_of('profile_place')}]",
        plot.short_axis(name),
        xaxis={"range": [float(end) for end in ends]},
        yaxis={"range": [float(plot.display(name, low)), high]},
    )


def _pressed(data: xr.Dataset) -> np.ndarray:
    """Nodes under pressure [phase, shown, node]."""
    pressure = data["profile_pressure"].values
    pressed: np.ndarray = pressure > _SEEN * np.nanmax(pressure, initial=0.0)
    return pressed


def _keys(data: xr.Dataset) -> list[plot.Key]:
    """Pairs whose profiles are kept."""
    numbers = enumerate(data["shown_pair"].values)
    return [
        plot.Key(plot.pair_key(int(pair)).label, plot.PALETTE[k % len(plot.PALETTE)])
        for k, pair in numbers
    ]


def _film_lines(data: xr.Dataset, phase: int) -> list[plot.Trace]:
    lines = [_profile(data, "profile_film", phase, k, key) for k, key in enumerate(_keys(data))]
    film = data["profile_film"].values
    middle = np.argmin(np.abs(data["profile_place"].values), axis=-1)[..., None]
    top = 0.3 * np.nanmax(np.take_along_axis(film, middle, axis=-1), initial=0.0)
    return [*lines, *_marks(data, "profile_film", phase, float(top))]


def _pressure_lines(data: xr.Dataset, phase: int) -> list[plot.Trace]:
    """Pressure of every pair, and what asperities carry of it."""
    keys = list(enumerate(_keys(data)))
    profiles = [_profile(data, "profile_pressure", phase, k, key) for k, key in keys]
    dotted = [(k, plot.Key(key.label, key.colour, "dot")) for k, key in keys]
    some = [_profile(data, "profile_asperity_pressure", phase, k, key) for k, key in dotted]
    top = 0.15 * float(np.nanmax(data["profile_pressure"].values, initial=0.0))
    return [*profiles, *some, *_marks(data, "profile_pressure", phase, top)]


def _marks(data: xr.Dataset, name: str, phase: int, top: float) -> list[plot.Trace]:
    """Ends of the dry contact of every pair."""
    y = plot.display(name, np.array([0.0, top, np.nan, 0.0, top]))
    lines = []
    for width, key in zip(data["profile_half_width"].values[phase], _keys(data), strict=True):
        x = plot.display("profile_place", np.array([-width, -width, np.nan, width, width]))
        mark = plot.Key(f"±b of {key.label}", key.colour)
        lines.append(plot.legend_line(mark, x, y, show.unit_of(name)))
    return lines


def _profile(data: xr.Dataset, name: str, phase: int, which: int, key: plot.Key) -> plot.Trace:
    wide = _pressed(data)
    place = data["profile_place"].values
    near = np.abs(place[phase, which]) <= 2.0 * np.max(np.abs(place[wide]), initial=0.0)
    x = plot.display("profile_place", place[phase, which, near])
    y = plot.display(name, data[name].values[phase, which, near])
    return plot.legend_line(key, x, y, show.unit_of(name))


# ---- words


def film_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "film", _of_variant)


def _of_variant(position: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["film"]
    nodes = json.loads(data.attrs["choices"])["nodes"]
    yield section.Paragraph(solved_how(data, "line contacts", f"{nodes} nodes across a contact"))
    yield from missing_films(data)
    yield figures_table(outcome, data)
    yield from figure_notes(data)
    yield section.Heading("Across the contacts")
    yield section.Paragraph(_of_profiles(data), "note")
    yield profiles_panel(f"profile{position}", data)
    yield section.Heading("Over the mesh cycle")
    yield film_course_panel(f"films{position}", outcome, data)
    yield from film_law_errors(data)


def film_answer(outcome: Outcome) -> str:
    """Thinnest film, load on asperities, friction and efficiency by the films, in words."""
    return films_sentence(outcome.parts["film"])


def _of_profiles(data: xr.Dataset) -> str:
    few = data.sizes["pair"] > data.sizes["shown"]
    pairs = (
        f"The {data.sizes['shown']} pairs of teeth that carry most"
        if few
        else "Every pair of teeth"
    )
    slices = ", each at its slice with the highest load" if data.sizes["slice"] > 1 else ""
    return f"{pairs}{slices}. Oil enters from the left where the surfaces run to the right."


def film_facts(outcome: Outcome) -> Iterable[section.KeyFigure]:
    """What the films come to."""
    return [film_key_figure("Films solved", film_answer(outcome))]


def film_printed(outcome: Outcome) -> Iterable[section.Printed]:
    """What the screen shows."""
    return film_tables("Films", outcome.parts["film"])
