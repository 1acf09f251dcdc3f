"""Wear: the worn flanks over the cycles, how fast they wear, and what of it is taken from elsewhere."""

import json
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import doubts_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.lines import titled
from pitchpoint.views.point import named_members
from pitchpoint.views.screen import head
from pitchpoint.wear.wear_stages import SEVERE, SEVERE_BY

__all__ = ["wear_blocks", "wear_facts", "wear_printed"]

_NONE = "No depth is known here."

_DRAWN = 0.15
"""Largest depth as it is drawn, over the height of a flank."""

_DEPENDS = 5e-4
"""Relative change over that of an input from which on it is told."""

_ENDS = {
    "turns": "after as many turns as were asked for",
    "depth": "where a flank reaches the limit of its depth",
    "module": "at 0.2 modules, beyond which contacts move off their places",
    "outgrown": "where its contacts have outgrown Hertz's theory",
    "pressure": "where the largest pressure reaches its limit",
    "hardness": "where the largest pressure reaches the hardness of the softer flank",
    "tip land": "where a tooth is as thin at its tip as its limit",
    "backlash": "where the backlash that wear adds reaches its limit",
    "lost": "where the loads of the worn flanks, or films that are asked for, were not found",
    "no wear": "where it begins: nothing wears",
}
"""Why a march ended, in words."""

_FIGURES = ("final_cycles", "final_cycles_error", "life_hours", "final_depth", "pressure_change")


def wear_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "wear", _of_variant)


def _of_variant(position: int, outcome: Outcome) -> Iterator[section.Block]:
    data, name = _of_members(outcome), f"wear{position}"
    if data.attrs["end"] == "lost":
        yield section.Paragraph(_said(data, "were not found"), "warning")
    yield section.Paragraph(_how(data))
    yield _whole(data)
    yield _table(data)
    if data.attrs["end"] == "no wear":
        return
    yield section.Heading("Worn flanks")
    yield _flanks(name, data)
    if data.sizes["strip"] > 1:
        yield section.Heading("Over the face")
        yield plot.Panel("", [_map(f"{name}_map{k}", data, k) for k in range(2)])
    yield section.Heading("Over the cycles")
    yield _life(name, data)
    rows = _sensitive(data)
    if rows:
        yield section.Heading("What the life depends on")
        yield section.Paragraph(
            "Changes with 1 % more of an input alone, by derivatives along the steps of the march: of the "
            "turns to the depth at its end (life), of the depth after as many turns, and of the largest "
            "depth that a turn wears off flanks as new. Dimensions that follow from others follow; "
            f"temperatures count from absolute zero; less than {_DEPENDS:g} % is left out. Derivatives hold "
            "near the case: where another pair comes to carry they jump.",
            "note",
        )
        yield section.SectionTable(
            ["1 % more of", "life", "depth", "depth per turn, new"], rows, compact=True
        )


def _said(data: xr.Dataset, words: str) -> str:
    """The warning of a result that has some words in it."""
    doubts = [doubt for doubt in doubts_of(data.attrs) if words in doubt]
    return doubts[0] if doubts else ""


def _how(data: xr.Dataset) -> str:
    updated = data.attrs["profile"] == "updated"
    feedback = (
        "What is worn off opens the gaps and changes the curvatures of the flanks; loads, pressures and "
        "films follow"
        if updated
        else "Loads, pressures and films stay those of flanks as new (wear.profile)"
    )
    return (
        f"Every place of a flank wears by its line load times the sliding over the rolling speed of its "
        f"contact, once for each engagement, times the specific wear rate of {data.attrs['law']}"
        f"{_by_films(data)}. {feedback}. All teeth of a gear wear alike, forces are those without friction, "
        f"and contacts stay on the normals of the flanks as new. {int(data['wear_steps'])} steps of the "
        f"march, each with an error of {100.0 * float(data.attrs['tolerance']):g} % of the largest depth "
        "at most, which are added up; so is what a coarser grid on the flanks changes there. Curvatures are "
        "those of the depths smoothed over two cells to either side, so that pressures depend on the number "
        "of cells: repeat with another one (wear.cells) where they matter."
    )


def _by_films(data: xr.Dataset) -> str:
    films = data.attrs["load_ratio"] == "film"
    return ", with the load on asperities from solved films" if films else ""


def _whole(data: xr.Dataset) -> section.SectionTable:
    """Where the march ended, and its stages."""
    rows = [(titled(name, data), _told(data, name)) for name in _FIGURES]
    for name in ("backlash_growth", "backlash_growth_error"):
        if name in data:
            rows.append((titled(name, data), show.quantity(name, float(data[name].values[-1]))))
    rows.append(("ended", _ENDS[str(data.attrs["end"])]))
    for name in ("run_in_cycles", "severe_cycles"):
        rows.append((titled(name, data), _told(data, name)))
    return section.SectionTable(["", ""], rows, compact=True)


def _told(data: xr.Dataset, name: str) -> str:
    value = float(data[name])
    if name == "severe_cycles" and not np.isfinite(value):
        return f"not reached: {_severe(data)}"
    if name == "severe_cycles":
        return f"{show.quantity(name, value, of=data)}, {_severe(data)}"
    if name == "run_in_cycles" and value == 0.0:
        return "none: the rate is near its least from the start"
    return show.quantity(name, value, of=data)


def _severe(data: xr.Dataset) -> str:
    """What tells that wear is severe, with its factor."""
    return f"{SEVERE:g} {SEVERE_BY[str(data.attrs['severe_by'])]}"


_OF_MEMBER = (
    "deepest_wear",
    "deepest_radius",
    "deepest_place",
    "wear_error",
    "fastest_wear",
    "worn_volume",
    "worn_tip_land",
)


def _of_members(outcome: Outcome) -> xr.Dataset:
    """Wear of the flanks of a mesh, of a train by the bodies that its members are."""
    data = outcome.parts["wear"]
    names = dict(zip(outcome.manifest["members"], named_members(outcome), strict=True))
    member_names = {
        "members": json.dumps([names.get(member, member) for member in _members(data)]),
        "driver": names.get(data.attrs["driver"], data.attrs["driver"]),
    }
    return data.assign_attrs(member_names)


def _members(data: xr.Dataset) -> list[str]:
    return [str(name) for name in json.loads(data.attrs["members"])]


def _table(data: xr.Dataset) -> section.SectionTable:
    """What each member has lost at the end, and where most."""
    names = _members(data)
    rows = [
        (titled(name, data), *(show.quantity(name, float(v)) for v in data[name].values[-1]))
        for name in _OF_MEMBER
        if name in data
    ]
    return section.SectionTable(["at the end", *names], rows, compact=True)


def _places(data: xr.Dataset, member: int) -> tuple[str, np.ndarray]:
    """Radii of the cells of a flank, or their arc lengths on a member that travels."""
    radius = data["flank_radius"].values[member]
    if np.all(np.isfinite(radius)):
        return "flank_radius", radius
    return "flank_place", data["flank_place"].values[member]


# ---- flanks


def _flanks(name: str, data: xr.Dataset) -> plot.Panel:
    """Depth along both flanks and the teeth before and after, with the cycles to slide."""
    figures = [_flank(f"{name}_flank{k}", data, k) for k in range(2)]
    if "flank_height" in data:
        figures += [_tooth(f"{name}_tooth{k}", data, k) for k in range(2)]
    choices = [_choice(figures, data, step) for step in range(data.sizes["step"])]
    final_step = len(choices) - 1
    return plot.Panel("", figures, choices=choices, menu="Turns", slides=True, at=final_step)


def _choice(figures: list[plot.Figure], data: xr.Dataset, step: int) -> plot.Choice:
    turns = float(data["cycles"][step])
    drawn = [(lines, member) for lines in (_lines, _outlines) for member in range(2)]
    changes = {
        figure.name: [_moved(lines(data, member, step)), {}]
        for figure, (lines, member) in zip(figures, drawn, strict=False)
    }
    return plot.Choice(show.number_text(turns), changes)


def _moved(lines: list[plot.Trace]) -> dict[str, list[Any]]:
    """Places of lines, for a choice."""
    return {axis: [line[axis] for line in lines] for axis in ("x", "y")}


def _flank(name: str, data: xr.Dataset, member: int) -> plot.Figure:
    place, _ = _places(data, member)
    top = float(plot.display("worn_depth", data["deepest_wear"].values[:, member].max()))
    look = plot.layout(
        show.axis_title(place, data),
        plot.short_axis("worn_depth", data),
        yaxis={"range": [1.05 * top or 1.0, 0.0]},
    )
    title = f"Depth of wear, {_members(data)[member]}"
    lines = _lines(data, member, data.sizes["step"] - 1)
    return plot.Figure(name, title, lines, look, "", _keys(data), _NONE)


def _keys(data: xr.Dataset) -> tuple[plot.Key, ...]:
    if data.sizes["strip"] == 1:
        return (plot.Key("depth", plot.INK),)
    return plot.Key("mean over the face", plot.INK), plot.Key("largest", plot.PALETTE[1], "dash")


def _lines(data: xr.Dataset, member: int, step: int) -> list[plot.Trace]:
    place, x = _places(data, member)
    depth, unit = data["worn_depth"].values[step, member], show.unit_of("worn_depth", data)
    largest = x, depth.max(axis=1)
    if "profile_depth" in data:
        largest = data["profile_radius"].values[member], data["profile_depth"].values[step, member]
    courses = [(x, depth.mean(axis=1)), largest][-len(_keys(data)) :]
    return [
        plot.legend_line(
            key,
            plot.display(place, at[order := np.argsort(at, kind="stable")]),
            plot.display("worn_depth", values[order]),
            unit,
        )
        for key, (at, values) in zip(_keys(data), courses, strict=True)
    ]


def _tooth(name: str, data: xr.Dataset, member: int) -> plot.Figure:
    """Half a tooth before and after, its wear magnified."""
    lines = _outlines(data, member, data.sizes["step"] - 1)
    look = plot.layout(
        f"from the axis of the tooth [{show.unit_of('flank_half_thickness')}]",
        plot.short_axis("flank_height", data),
        yaxis={"scaleanchor": "x", "scaleratio": 1, "constrain": "domain"},
        xaxis={"constrain": "domain", "nticks": 3, "range": _as_wide_as_high(lines)},
    )
    title = f"Flank as new and worn, {_members(data)[member]}"
    keys = _before_and_after(data)
    return plot.Figure(name, title, lines, look, "In the normal section.", keys, _NONE)


def _as_wide_as_high(lines: list[plot.Trace]) -> list[float]:
    """Ends of an axis across outlines that leave room for its numbers, however slender these are."""
    across, upwards = (
        [x for outline in lines for x in outline[name] if x is not None] for name in "xy"
    )
    middle = 0.5 * (max(across) + min(across))
    half = 0.5 * max(1.1 * (max(across) - min(across)), max(upwards) - min(upwards))
    return [round(middle - half, 3), round(middle + half, 3)]


def _before_and_after(data: xr.Dataset) -> tuple[plot.Key, plot.Key]:
    return plot.Key("as new", plot.GREY), plot.Key(
        f"worn, depth times {_magnified(data):g}", plot.INK
    )


def _outlines(data: xr.Dataset, member: int, step: int) -> list[plot.Trace]:
    """The flank as new, and what a step leaves of it where most is gone across the face."""
    half, height, angle = (
        data[name].values[member]
        for name in ("flank_half_thickness", "flank_height", "flank_angle")
    )
    gone = _magnified(data) * data["worn_depth"].values[step, member].max(axis=1)
    order, unit = np.argsort(height), show.unit_of("flank_height")
    return [
        plot.legend_line(
            key,
            plot.display("flank_half_thickness", (half - off * np.cos(angle))[order]),
            plot.display("flank_height", (height - off * np.sin(angle))[order]),
            unit,
        )
        for key, off in zip(_before_and_after(data), (0.0 * gone, gone), strict=True)
    ]


def _magnified(data: xr.Dataset) -> float:
    """How much larger depths are drawn than they are, at all cycles alike: 1, 2 or 5 times a power of ten."""
    deepest = float(data["worn_depth"].values.max())
    if deepest == 0.0:
        return 1.0
    height = float(np.ptp(data["flank_height"].values, axis=1).min())
    wanted = max(_DRAWN * height / deepest, 1.0)
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(power * max(factor for factor in (1.0, 2.0, 5.0) if factor * power <= wanted))


def _map(name: str, data: xr.Dataset, member: int) -> plot.Figure:
    """Depth over a flank at the end."""
    place, x = _places(data, member)
    order, unit = np.argsort(x), show.unit_of("worn_depth", data)
    along, across = show.unit_of(place), show.unit_of("across_place")
    heat = {
        "type": "heatmap",
        "x": plot.rounded(plot.display("across_place", data["across_place"].values)),
        "y": plot.rounded(plot.display(place, x[order])),
        "z": plot.rounded(
            plot.display("worn_depth", data["worn_depth"].values[-1, member][order]), 4
        ),
        "colorscale": plot.RISING,
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~r}} {unit}<br>y %{{x:.4~r}} {across}, r %{{y:.4~r}} {along}"
        "<extra></extra>",
    }
    look = plot.layout(f"y [{across}]", f"{titled(place, data)} [{along}]")
    return plot.Figure(
        name, f"Depth at the end, {_members(data)[member]}", [heat], look, "", (), _NONE
    )


# ---- over the cycles


def _life(name: str, data: xr.Dataset) -> plot.Panel:
    """Depth, rate and pressure over the cycles."""
    members = tuple(plot.Key(body, plot.PALETTE[k]) for k, body in enumerate(_members(data)))
    pressure = (plot.Key("largest Hertz pressure", plot.INK),)
    return plot.Panel(
        "",
        [
            _course(f"{name}_depth", data, "deepest_wear", members),
            _course(f"{name}_rate", data, "fastest_wear", members),
            _course(f"{name}_pressure", data, "wear_pressure", pressure),
        ],
    )


def _marks(data: xr.Dataset) -> dict[str, object]:
    """Ends of the stages, as far as there are any."""
    ends = {"run-in ends": "run_in_cycles", "severe": "severe_cycles"}
    marks = [(words, float(data[name])) for words, name in ends.items()]
    return plot.verticals([(words, at) for words, at in marks if np.isfinite(at) and at > 0.0])


def _course(name: str, data: xr.Dataset, variable: str, keys: tuple[plot.Key, ...]) -> plot.Figure:
    """A variable over the cycles, a line for each key."""
    x, unit = data["cycles"].values, show.unit_of(variable, data)
    courses = plot.display(variable, data[variable].values).reshape(x.size, -1).T
    lines = [
        plot.legend_line(key, x, course, unit) for key, course in zip(keys, courses, strict=True)
    ]
    look = plot.layout(
        f"turns of {data.attrs['driver']}, N",
        plot.short_axis(variable, data),
        yaxis={"rangemode": "tozero"},
        **_marks(data),
    )
    return plot.Figure(name, titled(variable, data).capitalize(), lines, look, "", keys, _NONE)


def _sensitive(data: xr.Dataset) -> list[tuple[str, ...]]:
    """Changes with 1 % of each input, the largest first; what changes nothing is left out."""
    sensitivities = json.loads(data.attrs["sensitivities"])
    order = sorted(sensitivities.items(), key=lambda one: -abs(one[1]["life"]))
    return [
        (name, *(f"{show.signed(one[of], 3)} %" for of in ("life", "depth", "rate")))
        for name, one in order
        if max(map(abs, one.values())) >= _DEPENDS
    ]


# ---- words


def _answer(data: xr.Dataset) -> str:
    """Depth at the end of the march, in words."""
    end = str(data.attrs["end"])
    if end == "no wear":
        return "nothing wears"
    depth = data["deepest_wear"].values[-1]
    most = int(np.argmax(depth))
    turns, hours = (
        show.quantity(name, float(data[name])) for name in ("final_cycles", "life_hours")
    )
    words = (
        f"{show.quantity('deepest_wear', float(depth[most]))} at most, on {_members(data)[most]}, after "
        f"{turns} turns of {data.attrs['driver']} ({hours})"
    )
    severe = float(data["severe_cycles"])
    if np.isfinite(severe):
        words += (
            f"; severe wear ({_severe(data)}) begins at {show.quantity('severe_cycles', severe)}"
        )
    return words if end == "turns" else f"{words}: the march ended {_ENDS[end]}"


def _screen(data: xr.Dataset) -> Iterator[section.Printed]:
    row = {
        head(name, data): show.quantity(name, float(data[name]), with_unit=False)
        for name in _FIGURES
    }
    for k, body in enumerate(_members(data)):
        row[f"h max {body} [{show.unit_of('deepest_wear')}]"] = show.quantity(
            "deepest_wear", float(data["deepest_wear"].values[-1, k]), with_unit=False
        )
    yield section.Printed("Wear", [row], f"The march ended {_ENDS[str(data.attrs['end'])]}.")


def wear_facts(outcome: Outcome) -> Iterable[section.KeyFigure]:
    """Depth at the end of the march."""
    return [section.key_figure(30.0, "Wear depth", _answer(_of_members(outcome)), " at most")]


def wear_printed(outcome: Outcome) -> Iterable[section.Printed]:
    """What the screen shows."""
    return _screen(_of_members(outcome))
