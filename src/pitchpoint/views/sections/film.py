"""Films of the contacts solved over the mesh cycle, beside film laws and friction laws."""

import json
from collections.abc import Iterator, Sequence
from itertools import cycle

import numpy as np
import xarray as xr

from pitchpoint.lubrication.ehl.conduction import ISOTHERMAL
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import (
    GREY,
    INK,
    PALETTE,
    Choice,
    Figure,
    Key,
    Panel,
    Trace,
    display,
    law_title,
    laws,
    layout,
    pair_key,
    plain,
    short_axis,
)
from pitchpoint.views.lines import folded, gapped, regimes, titled
from pitchpoint.views.point import period_of
from pitchpoint.views.screen import head, shown
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Printed, Section, Table

__all__ = ["FILM", "courses_panel", "film_answer", "profiles_panel"]

NONE = "No film was found."

_FIGURES = (
    "smallest_film",
    "smallest_lambda",
    "largest_film_pressure",
    "largest_asperity_share",
)
_PARTS = {
    "mean_film_friction": ("mean_boundary_part",),
    "mean_film_loss": ("mean_film_sliding_loss", "mean_film_rolling_loss"),
}
"""Figures with the parts that stand under them."""

_BESIDE = {
    "mean_film_friction": "mean_law_friction",
    "mean_film_loss": "mean_law_loss",
    "film_efficiency": "law_efficiency",
}
"""Figures by the films, and the same by a friction law."""

_WARMTH = ("largest_film_rise", "largest_flash_rise")
"""Figures of films that are no isothermal ones."""

_SEEN = 0.01
"""Part of the largest pressure of the cycle from which on a profile is seen without zooming out."""

_CENTRAL = ("longdash", "dashdot", "dot")
"""Dashes of film laws for the middle, in turns: laws that agree lie upon each other."""


def film_answer(outcome: Outcome) -> str:
    """Thinnest film, load on asperities, friction and efficiency by the films, in words."""
    data = outcome.parts["film"]
    if int(data["solved_contacts"]) == 0:
        return NONE
    told = (
        f"{_told(data, 'smallest_film')} at least, {_told(data, 'smallest_lambda')} of Rq; asperities "
        f"carry up to {_told(data, 'largest_asperity_share')} of a contact's load{_warmed(data)}"
    )
    if not np.isfinite(float(data["mean_film_loss"])):
        return f"{told}; loss and efficiency are withheld, some films were not found"
    friction, loss = (_told(data, name) for name in ("mean_film_friction", "mean_film_loss"))
    return f"{told}; friction coefficient {friction} in the mean, loss {loss}{_efficient(data)}"


def _thermal(data: xr.Dataset) -> str:
    """Name of the thermal effect of the films."""
    return str(json.loads(data.attrs["choices"])["thermal"])


def _main(data: xr.Dataset) -> tuple[str, ...]:
    """Names of the figures of the films themselves."""
    return _FIGURES if _thermal(data) == ISOTHERMAL else (*_FIGURES, *_WARMTH)


def _warmed(data: xr.Dataset) -> str:
    if _thermal(data) == ISOTHERMAL:
        return ""
    film, flash = (_told(data, name) for name in _WARMTH)
    return f"; films are up to {film} warmer than their inlet, surfaces {flash}"


def _efficient(data: xr.Dataset) -> str:
    if not np.isfinite(float(data["film_efficiency"])):
        return ""
    return f", efficiency {_told(data, 'film_efficiency')}"


def _told(data: xr.Dataset, name: str) -> str:
    return show.quantity(name, float(data[name]), of=data)


# ---- across the contacts


def profiles_panel(name: str, data: xr.Dataset) -> Panel:
    """Film and pressure across the contacts that carry most, with the phase to slide."""
    figures = [_film_profile(f"{name}_film", data), _pressure_profile(f"{name}_pressure", data)]
    if "profile_rise" in data:
        figures.append(_warm_profile(f"{name}_rise", data))
    choices = [_choice(data, figures, int(phase)) for phase in _in_order(data)]
    return Panel("", figures, choices=choices, menu="Phase", slides=True)


def _in_order(data: xr.Dataset) -> np.ndarray:
    """Positions of the phases from 0 to 1, wherever the period begins."""
    return np.argsort(data["phase"].values % 1.0, kind="stable")


def _choice(data: xr.Dataset, figures: Sequence[Figure], phase: int) -> Choice:
    lines = _film_lines, _pressure_lines, _warm_lines
    each = zip(figures, lines, strict=False)
    changes = {figure.name: own(data, phase) for figure, own in each}
    label = f"{float(data['phase'][phase]) % 1.0:.3f}"
    return Choice(label, {key: [_points(lines), {}] for key, lines in changes.items()})


def _points(lines: Sequence[Trace]) -> dict[str, list[list[float]]]:
    return {axis: [line[axis] for line in lines] for axis in ("x", "y")}


def _film_profile(name: str, data: xr.Dataset) -> Figure:
    middle = np.argmin(np.abs(data["profile_place"].values), axis=-1)[..., None]
    film = np.take_along_axis(data["profile_film"].values, middle, axis=-1)
    ends = 1.1 * np.nanmin(film, initial=0.0), 2.5 * np.nanmax(film, initial=0.0)
    axes = _across(data, "profile_film", *ends)
    title, first = titled("profile_film", data), int(_in_order(data)[0])
    lines = _film_lines(data, first)
    return Figure(name, title, lines, axes, "", (*_keys(data), DRY), NONE)


DRY = Key("±b of the dry contact", GREY)


def _pressure_profile(name: str, data: xr.Dataset) -> Figure:
    top = 1.08 * np.nanmax(data["profile_pressure"].values, initial=0.0)
    axes = _across(data, "profile_pressure", 0.0, top)
    keys = [*_keys(data), Key("of it on asperities", GREY, "dot"), DRY]
    title, first = titled("profile_pressure", data), int(_in_order(data)[0])
    return Figure(name, title, _pressure_lines(data, first), axes, SPIKE, tuple(keys), NONE)


SPIKE = "The largest pressure is that of one node, at the spike where there is one: finer grids have more."


def _warm_profile(name: str, data: xr.Dataset) -> Figure:
    """Temperatures of film and surfaces across the contacts."""
    top = 1.08 * np.nanmax(data["profile_rise"].values, initial=0.0)
    axes = _across(data, "profile_rise", 0.0, top)
    keys = [
        *_keys(data),
        Key("surface of body 1", GREY, "dot"),
        Key("surface of body 2", GREY, "dash"),
    ]
    title, first = "Temperatures above the inlet", int(_in_order(data)[0])
    return Figure(name, title, _warm_lines(data, first), axes, "", tuple(keys), NONE)


def _warm_lines(data: xr.Dataset, phase: int) -> list[Trace]:
    """Mean temperature of every film, and those of its surfaces."""
    each = {
        "profile_rise": "solid",
        "profile_surface_rise_1": "dot",
        "profile_surface_rise_2": "dash",
    }
    return [
        _profile(data, name, phase, k, Key(key.label, key.colour, dash))
        for name, dash in each.items()
        for k, key in enumerate(_keys(data))
    ]


def _across(data: xr.Dataset, name: str, low: float, top: float) -> dict[str, object]:
    """Layout with axes that stay as they are while the phase slides."""
    wide = display("profile_place", data["profile_place"].values)[_pressed(data)]
    ends = np.array([np.min(wide, initial=-1e-6), np.max(wide, initial=1e-6)])
    ends += 0.05 * np.ptp(ends) * np.array([-1.0, 1.0])
    high = float(display(name, top)) if top > 0.0 else 1.0
    return layout(
        f"x [{show.unit_of('profile_place')}]",
        short_axis(name),
        xaxis={"range": [float(end) for end in ends]},
        yaxis={"range": [float(display(name, low)), high]},
    )


def _pressed(data: xr.Dataset) -> np.ndarray:
    """Nodes under pressure [phase, shown, node]."""
    pressure = data["profile_pressure"].values
    found: np.ndarray = pressure > _SEEN * np.nanmax(pressure, initial=0.0)
    return found


def _keys(data: xr.Dataset) -> list[Key]:
    """Pairs whose profiles are kept."""
    numbers = enumerate(data["shown_pair"].values)
    return [Key(pair_key(int(one)).label, PALETTE[k % len(PALETTE)]) for k, one in numbers]


def _film_lines(data: xr.Dataset, phase: int) -> list[Trace]:
    lines = [_profile(data, "profile_film", phase, k, key) for k, key in enumerate(_keys(data))]
    film = data["profile_film"].values
    middle = np.argmin(np.abs(data["profile_place"].values), axis=-1)[..., None]
    top = 0.3 * np.nanmax(np.take_along_axis(film, middle, axis=-1), initial=0.0)
    return [*lines, *_marks(data, "profile_film", phase, float(top))]


def _pressure_lines(data: xr.Dataset, phase: int) -> list[Trace]:
    """Pressure of every pair, and what asperities carry of it."""
    keys = list(enumerate(_keys(data)))
    whole = [_profile(data, "profile_pressure", phase, k, key) for k, key in keys]
    dotted = [(k, Key(key.label, key.colour, "dot")) for k, key in keys]
    some = [_profile(data, "profile_asperity_pressure", phase, k, key) for k, key in dotted]
    top = 0.15 * float(np.nanmax(data["profile_pressure"].values, initial=0.0))
    return [*whole, *some, *_marks(data, "profile_pressure", phase, top)]


def _marks(data: xr.Dataset, name: str, phase: int, top: float) -> list[Trace]:
    """Ends of the dry contact of every pair."""
    y = display(name, np.array([0.0, top, np.nan, 0.0, top]))
    found = []
    for width, key in zip(data["profile_half_width"].values[phase], _keys(data), strict=True):
        x = display("profile_place", np.array([-width, -width, np.nan, width, width]))
        mark = Key(f"±b of {key.label}", key.colour)
        found.append(plain(mark, x, y, show.unit_of(name)))
    return found


def _profile(data: xr.Dataset, name: str, phase: int, which: int, key: Key) -> Trace:
    wide = _pressed(data)
    place = data["profile_place"].values
    near = np.abs(place[phase, which]) <= 2.0 * np.max(np.abs(place[wide]), initial=0.0)
    x = display("profile_place", place[phase, which, near])
    y = display(name, data[name].values[phase, which, near])
    return plain(key, x, y, show.unit_of(name))


# ---- over the mesh cycle


def courses_panel(name: str, outcome: Outcome) -> Panel:
    """Films, film over roughness, asperities, friction and loss over the mesh cycle."""
    data, axis = outcome.parts["film"], period_of(outcome).axis
    return Panel(
        "",
        [
            _films(f"{name}_thickness", data, axis),
            *_ratios(f"{name}_ratio", data, axis),
            _asperities(f"{name}_asperities", data, axis),
            _frictions(f"{name}_friction", outcome, axis),
            _losses(f"{name}_loss", outcome, axis),
        ],
    )


MOST = "Of the contact that carries most at a phase."
MEANS = "Mean of all contacts by their load."


def _of_most(data: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Values [..., phase, pair, slice] at the contact of each phase that carries most [..., phase]."""
    load = data["load"].values
    flat = np.argmax(load.reshape(load.shape[0], -1), axis=-1)
    each = values.reshape(*values.shape[:-2], -1)
    found: np.ndarray = each[..., np.arange(load.shape[0]), flat]
    return found


def _mean(data: xr.Dataset, values: np.ndarray) -> np.ndarray:
    """Mean over the contacts by their load [..., phase]; not a number where a film is missing."""
    carries = np.where(np.isnan(data["pressure"].values), 0.0, data["load"].values)
    weighed = np.where(carries > 0.0, carries * values, 0.0).sum(axis=(-2, -1))
    total = carries.sum(axis=(-2, -1))
    found: np.ndarray = weighed / np.where(total > 0.0, total, np.nan)
    return found


def _line(data: xr.Dataset, name: str, key: Key, values: np.ndarray) -> Trace:
    x, y = gapped(*folded(data["phase"].values, values))
    return plain(key, x, display(name, y, data), show.unit_of(name, data))


def _figure(
    name: str, title: str, variable: str, lines: list[tuple[Key, Trace]], axis: str, note: str
) -> Figure:
    look = layout(axis, short_axis(variable), yaxis={"rangemode": "tozero"})
    keys = tuple(key for key, _ in lines)
    return Figure(name, title, [trace for _, trace in lines], look, note, keys, NONE)


_SOLVED = (Key("solved, smallest", INK), Key("solved, in the middle", INK, "dash"))


def _films(name: str, data: xr.Dataset, axis: str) -> Figure:
    """Films solved beside those of every regression."""
    solved = [_of_most(data, data[one].values) for one in ("minimum_film", "central_film")]
    lines = [
        (key, _line(data, "minimum_film", key, values))
        for key, values in zip(_SOLVED, solved, strict=True)
    ]
    by_law = _of_most(data, data["film_by_law"].values)
    lines += [
        (key, _line(data, "film_by_law", key, values))
        for key, values in zip(_film_keys(data), by_law, strict=True)
    ]
    note = f"{MOST} Regressions of the film in the middle are broken lines; all are those of smooth surfaces."
    return _figure(name, "Film over the mesh cycle", "minimum_film", lines, axis, note)


def _film_keys(data: xr.Dataset) -> list[Key]:
    """Film laws, in broken lines where they give the film in the middle."""
    titles, places = (json.loads(data.attrs[f"film_{what}"]) for what in ("titles", "places"))
    broken = cycle(_CENTRAL)
    dashes = [next(broken) if place == "central" else "solid" for place in places]
    each = enumerate(zip(titles, dashes, strict=True))
    return [Key(title, PALETTE[k % len(PALETTE)], dash) for k, (title, dash) in each]


def _ratios(name: str, data: xr.Dataset, axis: str) -> Iterator[Figure]:
    """Film over roughness with the lubrication regimes; none over smooth flanks."""
    ratio, film = data["minimum_lambda"].values, data["minimum_film"].values
    if not np.any(np.isfinite(ratio)):
        return
    rough = np.nanmedian(film / ratio)
    thinnest = np.min(np.where(np.isnan(ratio), np.inf, ratio), axis=(-2, -1))
    given = {
        Key("solved, smallest", INK): _of_most(data, ratio),
        Key("solved, in the middle", INK, "dash"): _of_most(data, data["central_film"].values)
        / rough,
        Key("solved, thinnest of all contacts", GREY, "dot"): np.where(
            np.isinf(thinnest), np.nan, thinnest
        ),
    }
    by_law = _of_most(data, data["film_by_law"].values) / rough
    given |= dict(zip(_film_keys(data), by_law, strict=True))
    lines = [(key, _line(data, "minimum_lambda", key, values)) for key, values in given.items()]
    title = "Film over composite Rq, and lubrication regimes"
    figure = _figure(name, title, "minimum_lambda", lines, axis, MOST)
    figure.layout.setdefault("shapes", [])
    figure.layout.setdefault("annotations", [])
    regimes(figure.layout, figure.data)
    yield figure


def _asperities(name: str, data: xr.Dataset, axis: str) -> Figure:
    """Part of the load that asperities carry."""
    shares = data["asperity_share"].values
    key, most = (
        Key("all contacts", PALETTE[0]),
        Key("contact that carries most", PALETTE[1], "dash"),
    )
    lines = [
        (key, _line(data, "asperity_share", key, _mean(data, shares))),
        (most, _line(data, "asperity_share", most, _of_most(data, shares))),
    ]
    title = "Part of the load on asperities"
    return _figure(name, title, "asperity_share", lines, axis, MEANS)


def _frictions(name: str, outcome: Outcome, axis: str) -> Figure:
    """Friction coefficient by the films, its part by asperities, and that of the laws of the case."""
    data = outcome.parts["film"]
    both = {
        Key("by films", INK): "film_friction",
        Key("of it by asperities", INK, "dot"): "boundary_part",
    }
    lines = [
        (key, _line(data, one, key, _mean(data, data[one].values))) for key, one in both.items()
    ]
    for key, values in zip(_law_keys(outcome), data["friction"].values, strict=True):
        lines.append((key, _line(data, "friction", key, _mean(data, values))))
    return _figure(name, "Friction coefficient", "friction", lines, axis, MEANS)


def _law_keys(outcome: Outcome) -> list[Key]:
    names = enumerate(laws(outcome.parts["film"]))
    return [Key(law_title(outcome, law), PALETTE[k % len(PALETTE)]) for k, law in names]


def _losses(name: str, outcome: Outcome, axis: str) -> Figure:
    """Loss of the teeth by the films, and by the laws of the case."""
    data, key = outcome.parts["film"], Key("by films", INK)
    lines = [(key, _line(data, "film_loss", key, data["film_loss"].values))]
    for law, values in zip(_law_keys(outcome), data["law_loss"].values, strict=True):
        lines.append((law, _line(data, "law_loss", law, values)))
    note = "Sliding and rolling of all contacts."
    return _figure(name, "Loss of the teeth", "film_loss", lines, axis, note)


# ---- tables and words


def _blocks(page: Page) -> Iterator[Block]:
    for position, title, outcome in page.each("film"):
        if title:
            yield Heading(title)
        yield from _of_variant(position, outcome)


def _of_variant(position: int, outcome: Outcome) -> Iterator[Block]:
    data = outcome.parts["film"]
    yield Paragraph(_status(data))
    missing = int(data["loaded_contacts"]) - int(data["solved_contacts"])
    if missing:
        yield Paragraph(
            f"{missing} loaded contacts have no film, and nothing is shown of them; loss, efficiency and "
            "mean friction by films are withheld.",
            "warning",
        )
    yield _table(outcome)
    if other := str(data.attrs["other_rolling"]):
        yield Paragraph(other, "note")
    yield Paragraph(_thinnest(data), "note")
    if _overlap(data):
        yield Paragraph(OVERLAP, "note")
    yield Heading("Across the contacts")
    yield Paragraph(_of_profiles(data), "note")
    yield profiles_panel(f"profile{position}", data)
    yield Heading("Over the mesh cycle")
    yield courses_panel(f"films{position}", outcome)
    yield _film_laws(data)
    yield Paragraph(
        "Film by regression less that solved at the same place, over that solved: mean of all contacts that "
        "carry, and where it is largest. Regressions know no roughness. A film here is the distance of the "
        "mean planes: asperities carry load and hinder the flow of oil. Nothing is compared where these "
        "overlap.",
        "note",
    )


def _status(data: xr.Dataset) -> str:
    """How the films were solved, in words."""
    solve, chosen = json.loads(data.attrs["solve"]), json.loads(data.attrs["choices"])
    laws = ", ".join(f"{name.replace('_', ' ')} {chosen[name]}" for name in _CHOSEN)
    return (
        f"Pressure, film and load of each of {int(data['loaded_contacts'])} line contacts together, at "
        f"{data.sizes['phase']} phases of the mesh cycle under the forces of the balance with the first "
        f"friction law: {solve['sentence']}; at most {solve['iterations']} iterations, largest defect "
        f"{solve['residual']:.0e} of Hertz's pressure. {chosen['nodes']} nodes across a contact; {laws}, "
        f"boundary friction {chosen['boundary_friction']:g}. {_warmth(data)}"
    )


def _warmth(data: xr.Dataset) -> str:
    thermal = _thermal(data)
    if thermal == ISOTHERMAL:
        return "Isothermal."
    film, flash = (_told(data, name) for name in _WARMTH)
    named = thermal.replace("_", " ")
    return f"With heat ({named}): films up to {film} above their inlet, surfaces up to {flash}."


def _thinnest(data: xr.Dataset) -> str:
    """Where the film is thinnest, in words."""
    film = data["minimum_film"].values
    if np.isnan(film).all():
        return NONE
    phase, pair, part = np.unravel_index(np.nanargmin(film), film.shape)
    at = f"phase {float(data['phase'][phase]) % 1.0:.3f}, {pair_key(int(pair)).label}"
    many = film.shape[-1]
    part_of = f", slice {part + 1} of {many}, counted along the face" if many > 1 else ""
    there = {name: data[name].values[phase, pair, part] for name in _THERE}
    least, rough, pressed = (show.quantity(name, float(v), of=data) for name, v in there.items())
    return (
        f"The thinnest film is at {at}{part_of}: {least}, {rough} of Rq, under {pressed} at most."
    )


_THERE = ("minimum_film", "minimum_lambda", "film_pressure")

_CHOSEN = ("viscosity_law", "density_law", "shear_law", "asperities")


def _of_profiles(data: xr.Dataset) -> str:
    few = data.sizes["pair"] > data.sizes["shown"]
    pairs = (
        f"The {data.sizes['shown']} pairs of teeth that carry most"
        if few
        else "Every pair of teeth"
    )
    slices = ", each at its slice with the highest load" if data.sizes["slice"] > 1 else ""
    return f"{pairs}{slices}. Oil enters from the left where the surfaces run to the right."


def _table(outcome: Outcome) -> Table:
    """Figures of the cycle, with those by the friction laws beside them."""
    data, known = outcome.parts["film"], laws(outcome.parts["film"])

    def alone(name: str) -> tuple[str, ...]:
        return (titled(name, data), _told(data, name), *("" for _ in known))

    rows = [alone(name) for name in _main(data)]
    for own, by_law in _BESIDE.items():
        values = data[by_law].values
        cells = [show.quantity(by_law, float(value), of=data) for value in values]
        rows.append((titled(own, data).removesuffix(" by the films"), _told(data, own), *cells))
        rows += [alone(part) for part in _PARTS.get(own, ())]
    return Table(["", "by films", *(law_title(outcome, law) for law in known)], rows, compact=True)


def _film_laws(data: xr.Dataset) -> Table:
    titles, places = (json.loads(data.attrs[f"film_{what}"]) for what in ("titles", "places"))
    names = ("film_deviation", "largest_film_deviation")
    rows = [
        (title, place, *(show.quantity(name, float(data[name].values[k])) for name in names))
        for k, (title, place) in enumerate(zip(titles, places, strict=True))
    ]
    return Table(["Film law", "place", "mean", "largest"], rows, compact=True)


def _screen(outcome: Outcome) -> Iterator[Printed]:
    data = outcome.parts.get("film")
    if data is None:
        return
    row = {head(name, data): shown(name, float(data[name]), data) for name in _main(data)}
    yield Printed("Films", [row], _counted(data))
    rows = [{"friction by": "films", **_row(data, [*_BESIDE], ())}]
    rows += [
        {"friction by": law, **_row(data, [*_BESIDE.values()], (k,), [*_BESIDE])}
        for k, law in enumerate(laws(data))
    ]
    yield Printed("", rows, str(data.attrs["other_rolling"]))


def _row(
    data: xr.Dataset, names: Sequence[str], at: tuple[int, ...], heads: Sequence[str] = ()
) -> dict[str, str]:
    pairs = zip(heads or names, names, strict=True)
    symbols = {
        "mean_film_friction": "μ mean",
        "mean_film_loss": "P [W]",
        "film_efficiency": "η [%]",
    }
    return {symbols[head]: shown(name, float(data[name].values[at]), data) for head, name in pairs}


def _counted(data: xr.Dataset) -> str:
    found, every = int(data["solved_contacts"]), int(data["loaded_contacts"])
    told = f"{found} of {every} loaded contacts of the mesh cycle have a film that was found."
    return f"{told} {OVERLAP}" if _overlap(data) else told


def _overlap(data: xr.Dataset) -> bool:
    return float(data["smallest_film"]) < 0.0


OVERLAP = "Films below zero: the mean planes of the rough flanks overlap."


FILM = Section(
    name="film",
    title="Films solved",
    short="Films",
    order=230.0,
    parts=("film",),
    blocks=_blocks,
    answer=lambda one: [("Films solved", film_answer(one))] if "film" in one.parts else [],
    screen=_screen,
)
