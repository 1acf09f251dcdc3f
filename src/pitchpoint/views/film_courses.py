"""Figures, tables and words of films that were solved over the mesh cycle, whatever solved them."""

import json
from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.solved_films import film_notes
from pitchpoint.core.doubts import in_percent
from pitchpoint.lubrication.ehl.ehl_registry import ISOTHERMAL
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.lines import REGRESSED, folded, gapped, regimes, titled
from pitchpoint.views.point import period_of
from pitchpoint.views.screen import head, screen_value

__all__ = [
    "MOST",
    "NONE",
    "contact_place",
    "course_figure",
    "cycle_trace",
    "figure_notes",
    "figures_table",
    "film_counts",
    "film_course_panel",
    "film_key_figure",
    "film_law_errors",
    "film_quantity",
    "film_tables",
    "films_sentence",
    "missing_films",
    "of_most",
    "solved_how",
]

NONE = "There is no film to show."
LOST = "No film was found."
UNLOADED = "Nothing is loaded: no contact carries, and none has a film."

_FIGURES = (
    "smallest_film",
    "smallest_lambda",
    "largest_film_pressure",
    "largest_asperity_share",
    "largest_central_film_error",
    "largest_minimum_film_error",
)
_PARTS = {
    "mean_film_friction": ("mean_boundary_part",),
    "mean_film_loss": ("mean_film_sliding_loss",),
}
"""Figures with the parts that stand under them."""

_BESIDE = {
    "mean_film_friction": "mean_law_friction",
    "mean_film_loss": "mean_law_loss",
    "mean_film_rolling_loss": "mean_law_rolling_loss",
    "film_efficiency": "law_efficiency",
}
"""Figures by the films, and the same by a friction law."""

_WARMTH = ("largest_film_rise", "largest_flash_rise")
"""Figures of films that are no isothermal ones."""

_FINITE = ("smallest_central_film", "largest_end_pressure")
"""Figures of films that are solved over the whole patch of a contact."""

_SERIES = ("stiffness_without_films", "film_torsional_stiffness", "stiffness_with_films")
"""Stiffness that films take part in, where the case asks for it."""

IN_SERIES = (
    "Films in series: at the speed of the operating point, with forces in proportion to the torque; at rest "
    "there are none. Their own stiffness wavers with the grid, by some 10 %."
)

_NOTES = ("leaning", "sharp", "interferometry", "below_hertz", "other_rolling")
"""Attributes with sentences under the figures of the films."""

_CENTRAL = ("longdash", "dashdot", "dot")
"""Dashes of film laws for the middle, in turns: laws that agree lie upon each other."""


def films_sentence(data: xr.Dataset) -> str:
    """Thinnest film, load on asperities, friction and efficiency by the films, in words."""
    if int(data["solved_contacts"]) == 0:
        return _none(data)
    words = (
        f"{_least(data)}, {film_quantity(data, 'smallest_lambda')} of Rq{_near_ends(data)}; "
        f"asperities carry up to {film_quantity(data, 'largest_asperity_share')} of a contact's "
        f"load{_warmed(data)}"
    )
    words += _spread(data)
    if rests := str(data.attrs["assumed"]):
        words = f"{words}; {rests}"
    words += _in_series(data)
    if not np.isfinite(float(data["mean_film_loss"])):
        return f"{words}; loss and efficiency are withheld, some films were not found"
    friction, loss = (
        film_quantity(data, name) for name in ("mean_film_friction", "mean_film_loss")
    )
    return f"{words}; friction coefficient {friction} in the mean, loss {loss}{_efficient(data)}"


def _spread(data: xr.Dataset) -> str:
    """What asperities carry at most with every set of summits, in words."""
    if "summits_share" not in data:
        return ""
    summits = zip(data["summits"].values, data["summits_share"].values, strict=True)
    shares = (
        f"{show.quantity('summits_share', float(share))} by {name}" for name, share in summits
    )
    return f" ({', '.join(shares)})"


def film_key_figure(name: str, words: str) -> section.KeyFigure:
    """Thinnest film, and the words that go with it."""
    return section.key_figure(32.0, name, words, " at least")


def _none(data: xr.Dataset) -> str:
    """Why there is no film at all, in words."""
    return LOST if int(data["loaded_contacts"]) else UNLOADED


def _in_series(data: xr.Dataset) -> str:
    """What films take from the torsional stiffness, in words."""
    if "stiffness_with_films" not in data:
        return ""
    without, films = (
        film_quantity(data, f"stiffness_{which}_films") for which in ("without", "with")
    )
    part = 1.0 - float(data["stiffness_with_films"] / data["stiffness_without_films"])
    if not np.isfinite(part):
        return "; what films take from the torsional stiffness is withheld"
    return (
        f"; in series at this speed films take the torsional stiffness from {without} to {films} "
        f"({in_percent(part)} less)"
    )


def _least(data: xr.Dataset) -> str:
    """Thinnest films with what the grid may make them off, in words."""
    least = f"{film_quantity(data, 'smallest_film')}{_by_grid(data, 'minimum')}"
    below_zero = ": mean planes overlap" if float(data["smallest_film"]) < 0.0 else ""
    if not np.isfinite(float(data.get("smallest_central_film", np.nan))):
        return f"{least} at least{below_zero}"
    middle = f"{film_quantity(data, 'smallest_central_film')}{_by_grid(data, 'central')}"
    return f"{middle} at least in the middle of a contact, {least} anywhere{below_zero}"


def _by_grid(data: xr.Dataset, which: str) -> str:
    """How far off the grid makes films of a kind at most, beside their value; empty where it is not known."""
    error = float(data.get(f"largest_{which}_film_error", np.nan))
    return f" ±{in_percent(error)}" if np.isfinite(error) else ""


def _near_ends(data: xr.Dataset) -> str:
    """Largest pressure near the ends of lines, in words."""
    if "largest_end_pressure" not in data:
        return ""
    return f"; pressure up to {film_quantity(data, 'largest_end_pressure')} half a half-width from an end"


def _thermal(data: xr.Dataset) -> str:
    """Name of the thermal effect of the films."""
    return str(json.loads(data.attrs["choices"])["thermal"])


def _main(data: xr.Dataset) -> tuple[str, ...]:
    """Names of the figures of the films themselves."""
    finite = (name for name in _FINITE if name in data and np.isfinite(float(data[name])))
    names = (*finite, *(name for name in _FIGURES if name in data))
    return names if _thermal(data) == ISOTHERMAL else (*names, *_WARMTH)


def _first(data: xr.Dataset) -> tuple[str, ...]:
    """Those on the screen: a largest pressure at a sharp end is none to begin with."""
    sharp = bool(data.attrs.get("sharp"))
    return tuple(name for name in _main(data) if not (sharp and name == "largest_film_pressure"))


def _warmed(data: xr.Dataset) -> str:
    if _thermal(data) == ISOTHERMAL:
        return ""
    film, flash = (film_quantity(data, name) for name in _WARMTH)
    return f"; films are up to {film} warmer than their inlet, surfaces {flash}"


def _efficient(data: xr.Dataset) -> str:
    if not np.isfinite(float(data["film_efficiency"])):
        return ""
    return f", efficiency {film_quantity(data, 'film_efficiency')}"


def film_quantity(data: xr.Dataset, name: str) -> str:
    """A figure of the films with its unit."""
    return show.quantity(name, float(data[name]), of=data)


def film_course_panel(
    name: str, outcome: Outcome, data: xr.Dataset, more: Sequence[plot.Figure] = ()
) -> plot.Panel:
    """Films, film over roughness, asperities, friction and loss over the mesh cycle, and more figures."""
    axis = period_of(outcome).axis
    return plot.Panel(
        "",
        [
            *more,
            _films(f"{name}_thickness", data, axis),
            *_ratios(f"{name}_ratio", data, axis),
            _asperities(f"{name}_asperities", data, axis),
            _frictions(f"{name}_friction", outcome, data, axis),
            _losses(f"{name}_loss", outcome, data, axis),
        ],
    )


MOST = "Of the contact that carries most at a phase."
MEANS = "Mean of all contacts by their load."


def of_most(data: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Values [..., phase, pair, slice] at the contact of each phase that carries most [..., phase]."""
    load = data["load"].values
    flat = np.argmax(load.reshape(load.shape[0], -1), axis=-1)
    places = values.reshape(*values.shape[:-2], -1)
    of_loaded: np.ndarray = places[..., np.arange(load.shape[0]), flat]
    return of_loaded


def _mean(data: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Mean over the contacts by their load [..., phase]; not a number where a film is missing."""
    carries = np.where(np.isnan(data["pressure"].values), 0.0, data["load"].values)
    weighed = np.where(carries > 0.0, carries * values, 0.0).sum(axis=(-2, -1))
    total = carries.sum(axis=(-2, -1))
    mean: np.ndarray = weighed / np.where(total > 0.0, total, np.nan)
    return mean


def cycle_trace(data: xr.Dataset, name: str, key: plot.Key, values: np.ndarray) -> plot.Trace:
    """Values [phase] of a variable over the mesh cycle."""
    x, y = gapped(*folded(data["phase"].values, values))
    return plot.legend_line(key, x, plot.display(name, y, data), show.unit_of(name, data))


def course_figure(
    name: str,
    title: str,
    variable: str,
    lines: list[tuple[plot.Key, plot.Trace]],
    axis: str,
    note: str,
) -> plot.Figure:
    """Lines of one variable over the mesh cycle."""
    look = plot.layout(axis, plot.short_axis(variable), yaxis={"rangemode": "tozero"})
    keys = tuple(key for key, _ in lines)
    return plot.Figure(name, title, [trace for _, trace in lines], look, note, keys, NONE)


_OF_LINES_ALONE = {
    "row_film": plot.Key("solved, smallest of the middle row", plot.INK, "dot"),
    "line_minimum_film": plot.Key("line without ends, smallest", plot.GREY),
    "line_central_film": plot.Key("line without ends, in the middle", plot.GREY, "dash"),
}
_SOLVED = (
    plot.Key("solved, smallest", plot.INK),
    plot.Key("solved, in the middle", plot.INK, "dash"),
)


def _films(name: str, data: xr.Dataset, axis: str) -> plot.Figure:
    """Films solved, with what the grid may change of them, beside those of every regression."""
    lines = [
        (
            key,
            cycle_trace(data, film, key, of_most(data, data[film].values))
            | _error_bars(data, film),
        )
        for key, film in zip(_SOLVED, ("minimum_film", "central_film"), strict=True)
    ]
    lines += [
        (key, cycle_trace(data, variable, key, of_most(data, data[variable].values)))
        for variable, key in _OF_LINES_ALONE.items()
        if variable in data
    ]
    by_law = of_most(data, data["film_by_law"].values)
    lines += [
        (key, cycle_trace(data, "film_by_law", key, values))
        for key, values in zip(_film_keys(data), by_law, strict=True)
    ]
    barred = any("error_y" in line for _, line in lines)
    bars = "Bars: estimated error by the grid. " if barred else ""
    note = (
        f"{MOST} {bars}Regressions of the film in the middle are broken lines; all are those of smooth "
        "surfaces."
    )
    return course_figure(name, "Film over the mesh cycle", "minimum_film", lines, axis, note)


def _error_bars(data: xr.Dataset, film: str) -> dict[str, Any]:
    """Bars over the course of a film that reach as far as its estimated error by the grid."""
    if f"{film}_error" not in data or data[f"{film}_error"].isnull().all():
        return {}
    error = of_most(data, np.abs(data[film].values) * data[f"{film}_error"].values)
    _, reach = gapped(*folded(data["phase"].values, error))
    bars = {"array": plot.rounded(plot.display(film, reach, data)), "thickness": 1, "width": 2}
    return {"error_y": {"type": "data", **bars}}


def _film_keys(data: xr.Dataset) -> list[plot.Key]:
    """Film laws, in broken lines where they give the film in the middle."""
    titles, places = (json.loads(data.attrs[f"film_{what}"]) for what in ("titles", "places"))
    broken = cycle(_CENTRAL)
    dashes = [next(broken) if place == "central" else "solid" for place in places]
    numbered = enumerate(zip(titles, dashes, strict=True))
    return [
        plot.Key(title, plot.PALETTE[k % len(plot.PALETTE)], dash) for k, (title, dash) in numbered
    ]


def _ratios(name: str, data: xr.Dataset, axis: str) -> Iterator[plot.Figure]:
    """Film over roughness with the lubrication regimes; none over smooth flanks."""
    ratio, film = data["minimum_lambda"].values, data["minimum_film"].values
    if not np.any(np.isfinite(ratio)):
        return
    rough = np.nanmedian(film / ratio)
    thinnest = np.min(np.where(np.isnan(ratio), np.inf, ratio), axis=(-2, -1))
    ratios = {
        plot.Key("solved, smallest", plot.INK): of_most(data, ratio),
        plot.Key("solved, in the middle", plot.INK, "dash"): of_most(
            data, data["central_film"].values
        )
        / rough,
        plot.Key("solved, thinnest of all contacts", plot.GREY, "dot"): np.where(
            np.isinf(thinnest), np.nan, thinnest
        ),
    }
    by_law = of_most(data, data["film_by_law"].values) / rough
    ratios |= dict(zip(_film_keys(data), by_law, strict=True))
    lines = [
        (key, cycle_trace(data, "minimum_lambda", key, values)) for key, values in ratios.items()
    ]
    title = "Film over composite Rq, and lubrication regimes"
    note = f"{MOST} {REGRESSED} What asperities carry stands in the next figure."
    figure = course_figure(name, title, "minimum_lambda", lines, axis, note)
    figure.layout.setdefault("shapes", [])
    figure.layout.setdefault("annotations", [])
    regimes(figure.layout, figure.data)
    yield figure


_NO_SHARE = 1e-9
"""Part of a load that is none: what a film many times the roughness leaves of the law of asperities."""


def _asperities(name: str, data: xr.Dataset, axis: str) -> plot.Figure:
    """Part of the load that asperities carry."""
    shares = data["asperity_share"].values
    shares = np.where(shares < _NO_SHARE, 0.0, shares)
    key, most = (
        plot.Key("all contacts", plot.PALETTE[0]),
        plot.Key("contact that carries most", plot.PALETTE[1], "dash"),
    )
    lines = [
        (key, cycle_trace(data, "asperity_share", key, _mean(data, shares))),
        (most, cycle_trace(data, "asperity_share", most, of_most(data, shares))),
    ]
    title = "Part of the load on asperities"
    return course_figure(name, title, "asperity_share", lines, axis, MEANS)


def _frictions(name: str, outcome: Outcome, data: xr.Dataset, axis: str) -> plot.Figure:
    """Friction coefficient by the films, its part by asperities, and that of the laws of the case."""
    both = {
        plot.Key("by films", plot.INK): "film_friction",
        plot.Key("of it by asperities", plot.INK, "dot"): "boundary_part",
    }
    lines = [
        (key, cycle_trace(data, figure, key, _mean(data, data[figure].values)))
        for key, figure in both.items()
    ]
    for key, values in zip(_law_keys(outcome, data), data["friction"].values, strict=True):
        lines.append((key, cycle_trace(data, "friction", key, _mean(data, values))))
    return course_figure(name, "Friction coefficient", "friction", lines, axis, MEANS)


def _law_keys(outcome: Outcome, data: xr.Dataset) -> list[plot.Key]:
    names = enumerate(plot.laws(data))
    return [
        plot.Key(plot.law_title(outcome, law), plot.PALETTE[k % len(plot.PALETTE)])
        for k, law in names
    ]


def _losses(name: str, outcome: Outcome, data: xr.Dataset, axis: str) -> plot.Figure:
    """Loss of the teeth by the films, and by the laws of the case."""
    key = plot.Key("by films", plot.INK)
    lines = [(key, cycle_trace(data, "film_loss", key, data["film_loss"].values))]
    for law, values in zip(_law_keys(outcome, data), data["law_loss"].values, strict=True):
        lines.append((law, cycle_trace(data, "law_loss", law, values)))
    note = "Sliding and rolling of all contacts."
    return course_figure(name, "Loss of the teeth", "film_loss", lines, axis, note)


def missing_films(data: xr.Dataset) -> Iterator[section.Paragraph]:
    """That contacts have no film, where some have none."""
    missing = int(data["loaded_contacts"]) - int(data["solved_contacts"])
    if missing:
        yield section.Paragraph(
            f"{missing} loaded contacts have no film, and nothing is shown of them; loss, efficiency and "
            "mean friction by films are withheld.",
            "warning",
        )


def solved_how(
    data: xr.Dataset, contacts: str, grid: str, times: str = "phases of the mesh cycle"
) -> str:
    """How the films were solved, in words.

    Args:
        data: films of the cycle.
        contacts: what they are, in words.
        grid: on which they were solved, in words.
        times: what the phases are of.
    """
    solve, chosen = json.loads(data.attrs["solve"]), json.loads(data.attrs["choices"])
    named = ", ".join(f"{name.replace('_', ' ')} {chosen[name]}" for name in _CHOSEN)
    return (
        f"Pressure, film and load of each of {int(data['loaded_contacts'])} {contacts} together, at "
        f"{data.sizes['phase']} {times} under the forces of the balance with the first "
        f"friction law: {solve['sentence']}; at most {solve['iterations']} iterations, largest defect "
        f"{solve['residual']:.0e} of Hertz's pressure. {grid}; {named}, "
        f"boundary friction {chosen['boundary_friction']:g}. {_warmth(data)}"
    )


def _warmth(data: xr.Dataset) -> str:
    thermal = _thermal(data)
    if thermal == ISOTHERMAL:
        return "Isothermal."
    film, flash = (film_quantity(data, name) for name in _WARMTH)
    named = thermal.replace("_", " ")
    return f"With heat ({named}): films up to {film} above their inlet, surfaces up to {flash}."


def figures_table(outcome: Outcome, data: xr.Dataset) -> section.SectionTable:
    """Figures of the cycle, with those of lines without ends and of the friction laws beside them."""
    law_names, lines = plot.laws(data), [LINES] * ("mean_line_loss" in data)

    def row(name: str, cells: Sequence[str]) -> tuple[str, ...]:
        beside = [film_quantity(data, _OF_LINES[name]) if name in _OF_LINES else "" for _ in lines]
        title = titled(name, data).removesuffix(" by the films")
        return (title, film_quantity(data, name), *beside, *cells)

    empty = [""] * len(law_names)
    rows = [row(name, empty) for name in _main(data)]
    rows += [row(name, empty) for name in _SERIES if name in data]
    for figure, by_law in _BESIDE.items():
        values = data[by_law].values
        if figure == "film_efficiency" and not np.isfinite(values).any():
            continue  # nothing is transmitted
        rows.append(row(figure, [show.quantity(by_law, float(value), of=data) for value in values]))
        rows += [row(part, empty) for part in _PARTS.get(figure, ())]
    named = [plot.law_title(outcome, law) for law in law_names]
    return section.SectionTable(["", "by films", *lines, *named], rows, compact=True)


LINES = "lines without ends"

_OF_LINES = {"mean_film_friction": "mean_line_friction", "mean_film_loss": "mean_line_loss"}


def film_law_errors(data: xr.Dataset) -> Iterator[section.Block]:
    """How far film laws are off, as a table and words."""
    yield _film_laws_table(data)
    yield section.Paragraph(
        "Film by regression less that solved at the same place, over that solved: mean of all contacts that "
        "carry, and where it is largest. Regressions know no roughness. A film here is the distance of the "
        "mean planes: asperities carry load and hinder the flow of oil. Nothing is compared where these "
        "overlap.",
        "note",
    )


def _film_laws_table(data: xr.Dataset) -> section.SectionTable:
    titles, places = (json.loads(data.attrs[f"film_{what}"]) for what in ("titles", "places"))
    names = ("film_deviation", "largest_film_deviation")
    rows = [
        (title, place, *(_compared(name, float(data[name].values[k])) for name in names))
        for k, (title, place) in enumerate(zip(titles, places, strict=True))
    ]
    return section.SectionTable(["Film law", "place", "mean", "largest"], rows, compact=True)


def _compared(name: str, value: float) -> str:
    return show.quantity(name, value) if np.isfinite(value) else "not compared"


def figure_notes(data: xr.Dataset) -> Iterator[section.Paragraph]:
    """Notes under the figures: what rests on assumptions, where the film is thinnest."""
    if rests := _assumed(data):
        yield section.Paragraph(rests, "note")
    yield from (
        section.Paragraph(data.attrs[name], "note") for name in _NOTES if data.attrs.get(name)
    )
    yield section.Paragraph(_thinnest(data), "note")
    yield from (section.Paragraph(text, "note") for text in film_notes(data))


def contact_place(data: xr.Dataset, phase: int, pair: int, part: int) -> str:
    """Where a contact of the cycle is, in words; bodies with one alone have neither phases nor pairs."""
    _, pairs, part_count = data["minimum_film"].shape
    word = data["minimum_film"].dims[-1]
    parts = [
        f"phase {float(data['phase'][phase]) % 1.0:.3f}, {plot.pair_key(pair).label}"
        if pairs > 1
        else "",
        f"{word} {part + 1} of {part_count}, counted along the face" if part_count > 1 else "",
    ]
    return ", ".join(filter(None, parts)) or "the only contact"


def _thinnest(data: xr.Dataset) -> str:
    """Where the film is thinnest, in words."""
    film = data["minimum_film"].values
    if np.isnan(film).all():
        return _none(data)
    phase, pair, part = map(int, np.unravel_index(np.nanargmin(film), film.shape))
    at = contact_place(data, phase, pair, part)
    there = {name: data[name].values[phase, pair, part] for name in _THERE}
    least, rough, pressed = (show.quantity(name, float(v), of=data) for name, v in there.items())
    return f"The thinnest film is at {at}: {least}, {rough} of Rq, under {pressed} at most."


_THERE = ("minimum_film", "minimum_lambda", "film_pressure")

_CHOSEN = ("viscosity_law", "density_law", "shear_law", "asperities")


_OVERLAP = "A smallest film below zero: the mean planes of the rough flanks overlap; asperities carry there."


def film_tables(title: str, data: xr.Dataset) -> Iterator[section.Printed]:
    """What the screen shows of films: their figures, then friction and losses beside those of laws."""
    row = {head(name, data): screen_value(name, float(data[name]), data) for name in _first(data)}
    below = _OVERLAP if float(data["smallest_film"]) < 0.0 else ""
    yield section.Printed(title, [row], " ".join(filter(None, (below, film_counts(data)))))
    rows = [{"friction by": "films", **_row(data, [*_BESIDE], ())}]
    if "mean_line_loss" in data:
        rows.append({"friction by": LINES, **_row(data, [*_OF_LINES.values()], (), [*_OF_LINES])})
    rows += [
        {"friction by": law, **_row(data, [*_BESIDE.values()], (k,), [*_BESIDE])}
        for k, law in enumerate(plot.laws(data))
    ]
    yield section.Printed("", rows, str(data.attrs["other_rolling"]))
    if "stiffness_with_films" in data:
        yield section.Printed(
            "",
            [{head(name, data): screen_value(name, float(data[name]), data) for name in _SERIES}],
            IN_SERIES,
        )


def _row(
    data: xr.Dataset, names: Sequence[str], at: tuple[int, ...], heads: Sequence[str] = ()
) -> dict[str, str]:
    pairs, unit = zip(heads or names, names, strict=True), show.unit_of("mean_film_loss")
    symbols = {
        "mean_film_friction": "μ mean",
        "mean_film_loss": f"P [{unit}]",
        "mean_film_rolling_loss": f"of it rolling [{unit}]",
        "film_efficiency": "η [%]",
    }
    empty = dict.fromkeys(symbols.values(), "")
    return empty | {
        symbols[head]: screen_value(name, float(data[name].values[at]), data)
        for head, name in pairs
    }


def film_counts(data: xr.Dataset) -> str:
    """How many contacts have a film, and what of it rests on assumptions."""
    solved, every = int(data["solved_contacts"]), int(data["loaded_contacts"])
    words = f"{solved} of {every} loaded contacts of the mesh cycle have a film that was found."
    words = words if every else UNLOADED
    return " ".join(
        filter(
            None,
            (
                words,
                _assumed(data),
                str(data.attrs.get("leaning", "")),
                str(data.attrs.get("sharp", "")),
                str(data.attrs["below_hertz"]),
                *film_notes(data),
            ),
        )
    )


def _assumed(data: xr.Dataset) -> str:
    """What rests on assumed asperities, as a sentence; empty if nothing does."""
    words = str(data.attrs["assumed"])
    return f"{words[0].upper()}{words[1:]}." if words else ""
