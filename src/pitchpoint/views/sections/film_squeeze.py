"""Squeeze of films: the film of a pair over its engagement beside steady ones, with load and entrainment."""

import json
from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.film_courses import NONE, film_key_figure, film_quantity
from pitchpoint.views.lines import titled
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.sections.finite_film import maps_panel
from pitchpoint.views.way import places_on_axis

__all__ = ["squeeze_blocks", "squeeze_facts", "squeeze_printed"]

_SMALL = 1e-4
"""Part of the film by which squeeze changes it from which on it is worth a number."""

_HEADLINES = (
    "smallest_film",
    "steady_smallest_film",
    "smallest_central_film",
    "steady_smallest_central_film",
    "squeeze_change",
)
_BESIDE = {
    "smallest_film": "steady_smallest_film",
    "smallest_central_film": "steady_smallest_central_film",
}


def squeeze_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "film_squeeze", _of_variant)


def _of_variant(position: int, outcome: Outcome) -> Iterator[section.Block]:
    data, name = outcome.parts["film_squeeze"], f"squeeze{position}"
    yield from _gone(data)
    yield section.Paragraph(_how(data))
    if not int(data["solved_moments"]):
        return
    yield _table(data)
    yield section.Heading("Over the engagement")
    yield _courses(name, data)
    yield section.Heading("The moment with the thinnest film")
    yield section.Paragraph(_thinnest(data), "note")
    yield maps_panel(f"{name}_patch", data, 0)


def _gone(data: xr.Dataset) -> Iterator[section.Paragraph]:
    missing = int(data["loaded_moments"]) - int(data["solved_moments"])
    if missing:
        yield section.Paragraph(
            f"The film of {missing} moments of the engagement was not found, and nothing is shown of it; "
            "what follows a lost film is not known either.",
            "warning",
        )


def _how(data: xr.Dataset) -> str:
    """How the films were solved, in words."""
    solve, (nodes, cells) = json.loads(data.attrs["solve"]), json.loads(data.attrs["grid"])
    steps = int(np.nansum(data["time_steps"].values))
    duration = show.quantity("time", float(data["time"][-1]))
    return (
        f"One pair is followed through its engagement, at {int(data['loaded_moments'])} moments in "
        f"{duration}: oil stays where it was while load, speeds, radii and form change, by d(ρh)/dt in "
        "the balance of every cell. Films are isothermal, and the first one is steady; between moments "
        "everything changes evenly. "
        f"{steps} steps of time, each with an error of {100.0 * float(data.attrs['tolerance']):g} % of the "
        f"mass under the contact at most: {solve['sentence']}; largest defect {solve['residual']:.0e} of "
        f"Hertz's pressure. One grid for all moments, {nodes} nodes along and {cells} cells across; the "
        "steady films beside are solved on it too, so that squeeze alone makes the difference. Forces are "
        "those of the balance: the inertia of the bodies is left out."
    )


def _table(data: xr.Dataset) -> section.SectionTable:
    """Thinnest films with squeeze and without."""
    rows = [
        (titled(name), film_quantity(data, name), film_quantity(data, steady))
        for name, steady in _BESIDE.items()
    ]
    if np.isfinite(float(data["squeeze_change"])):
        rows.append((titled("squeeze_change"), film_quantity(data, "squeeze_change"), ""))
    return section.SectionTable(["", "with squeeze", "if all were steady"], rows, compact=True)


# ---- over the engagement


def _abscissa(data: xr.Dataset) -> tuple[np.ndarray, str]:
    """Places along the way of the pair with the title of the axis; times where slices have several places."""
    path = places_on_axis(data)
    ways = np.sign(np.diff(path))
    if np.all(ways == ways[0]) and data["path"].attrs["title"]:
        return path, str(data["path"].attrs["axis"])
    return plot.display("time", data["time"].values), f"time [{show.unit_of('time')}]"


_FILMS = {
    "central_film": plot.Key("in the middle, with squeeze", plot.INK),
    "steady_central_film": plot.Key("in the middle, steady", plot.INK, "dash"),
    "minimum_film": plot.Key("smallest, with squeeze", plot.PALETTE[0]),
    "steady_minimum_film": plot.Key("smallest, steady", plot.PALETTE[0], "dash"),
}
_PRESSURES = {
    "film_pressure": plot.Key("largest, with squeeze", plot.INK),
    "steady_film_pressure": plot.Key("largest, steady", plot.INK, "dash"),
    "pressure": plot.Key("Hertz", plot.GREY, "dot"),
}


def _courses(name: str, data: xr.Dataset) -> plot.Panel:
    """Films, pressures, load and entrainment over the engagement."""
    change = {"film_change": plot.Key("film in the middle", plot.INK)}
    return plot.Panel(
        "",
        [
            _figure(f"{name}_films", "Film over the engagement", data, _FILMS),
            _figure(f"{name}_change", "Film with squeeze less the steady one", data, change),
            _figure(f"{name}_pressures", "Pressure over the engagement", data, _PRESSURES),
            _figure(f"{name}_load", "Load of the pair", data, {"load": plot.Key("load", plot.INK)}),
            _figure(
                f"{name}_entrainment",
                "Entrainment",
                data,
                {"entrainment": plot.Key("mean surface speed", plot.INK)},
            ),
        ],
    )


def _figure(name: str, title: str, data: xr.Dataset, keys: dict[str, plot.Key]) -> plot.Figure:
    x, axis = _abscissa(data)
    leading = next(iter(keys))
    lines = [
        plot.legend_line(
            key,
            x,
            plot.display(variable, data[variable].values, data),
            show.unit_of(variable, data),
        )
        for variable, key in keys.items()
    ]
    zero = {} if leading == "film_change" else {"yaxis": {"rangemode": "tozero"}}
    look = plot.layout(axis, plot.short_axis(leading, data), **zero)
    return plot.Figure(name, title, lines, look, "", tuple(keys.values()), NONE)


# ---- words


def _thinnest(data: xr.Dataset) -> str:
    """Where in the engagement the film is thinnest, in words."""
    at = int(data["kept_moment"].values[0])
    named = ("time", "load", "minimum_film", "steady_minimum_film")
    time, load, film, steady = (
        show.quantity(figure, float(data[figure].values[at])) for figure in named
    )
    return (
        f"At {time} after the first moment, under {load}: {film} with squeeze, {steady} if it were steady. "
        "Oil enters from the left where the surfaces run to the right."
    )


def squeeze_sentence(data: xr.Dataset) -> str:
    """Thinnest film of the engagement, and what squeeze makes of it, in words."""
    if not int(data["solved_moments"]):
        return "No film of the engagement was found."
    words = (
        f"{film_quantity(data, 'smallest_film')} at least over the engagement of a pair, "
        f"{film_quantity(data, 'steady_smallest_film')} if every moment were steady; "
    )
    change = float(data["squeeze_change"])
    if not np.isfinite(change):
        return f"{words}the mean planes of the rough flanks overlap, and films are not compared"
    if abs(change) < _SMALL:
        return f"{words}squeeze changes nothing"
    sense = "thicker" if change > 0.0 else "thinner"
    part = show.number_text(100.0 * abs(change), 2)
    return f"{words}squeeze makes the film in the middle up to {part} % {sense}"


def screen(data: xr.Dataset) -> Iterator[section.Printed]:
    """What the screen shows."""
    row = {head(name, data): screen_value(name, float(data[name]), data) for name in _HEADLINES}
    solved, every = int(data["solved_moments"]), int(data["loaded_moments"])
    yield section.Printed(
        "Squeeze of films", [row], f"{solved} of {every} moments have a film that was found."
    )


def squeeze_facts(outcome: Outcome) -> Iterable[section.KeyFigure]:
    """What squeeze comes to."""
    return [film_key_figure("Squeeze of films", squeeze_sentence(outcome.parts["film_squeeze"]))]


def squeeze_printed(outcome: Outcome) -> Iterable[section.Printed]:
    """What the screen shows."""
    return screen(outcome.parts["film_squeeze"])
