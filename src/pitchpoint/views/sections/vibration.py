"""Vibration of the mesh: transmission error, dynamic factors, orders, and speeds through resonance."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import VIBRATION as FIGURES
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.inputs import input_words
from pitchpoint.views.lines import titled
from pitchpoint.views.point import period_of
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.section import (
    Block,
    Heading,
    KeyFigure,
    Page,
    Paragraph,
    Printed,
    Section,
    SectionTable,
    reason,
    tabbed,
)

__all__ = ["VIBRATION", "resonance_panels", "vibration_answer", "vibration_panels"]

ORDERS = range(1, 21)
"""Orders of the mesh frequency that are drawn."""

NONE = "No steady state was found that the model describes."
TIME = "time over mesh period t/t_z"
_ROWS = (
    "natural_frequency",
    "mesh_frequency",
    "equivalent_mass",
    "mean_transmission_error",
    "transmission_error_range",
    "static_transmission_error_range",
    "largest_dynamic_factor",
)
_DYNAMIC = ("mean_transmission_error", "transmission_error_range", "largest_dynamic_factor")
_AGAINST_SPEED = ("transmission_error_range", "largest_dynamic_factor")
_FEW = 6


def vibration_panels(outcomes: Mapping[str, Outcome]) -> list[plot.Panel]:
    """Figures for each variant whose vibration is there."""
    return [
        _panel(f"vibration{position}", name if len(outcomes) > 1 else "", outcome)
        for position, (name, outcome) in enumerate(outcomes.items())
        if "vibration" in outcome.parts
    ]


def vibration_answer(outcome: Outcome) -> list[tuple[str, str]]:
    """Transmission error for each torque, peak to peak, and what goes with it; empty without vibration."""
    data = outcome.parts.get("vibration")
    if data is None:
        return []
    return [
        _error(data, k, torque) if ok else (reason, f"at {torque}")
        for k, (torque, ok, reason) in enumerate(
            zip(_torques(data), _found(data), steady_state_sentences(data), strict=True)
        )
    ]


def _error(data: xr.Dataset, index: int, torque: str) -> tuple[str, str]:
    mean, spread = (_cell(data, name, index) for name in _DYNAMIC[:2])
    return spread, f"dynamic, peak to peak at {torque}, {mean} in the mean"


def steady_state_sentences(data: xr.Dataset) -> list[str]:
    """What became of the steady state, for each torque."""
    return [str(sentence) for sentence in json.loads(data.attrs.get("status", "[]"))]


def _found(data: xr.Dataset) -> list[bool]:
    """For each torque whether a steady state was found that the model describes."""
    return [int(code) == 0 for code in data["vibration_status"].values]


def _torques(data: xr.Dataset) -> list[str]:
    unit = show.unit_of("torque", data)
    values = plot.display("torque", data["torque"], data)
    return [f"{show.number_text(float(value))} {unit}" for value in values]


def _cell(data: xr.Dataset, name: str, torque: int) -> str:
    if name in _DYNAMIC and not _found(data)[torque]:
        return "none"
    return show.quantity(name, float(data[name].values[torque]))


def _table(outcome: Outcome) -> SectionTable:
    """Figures of every torque."""
    data = outcome.parts["vibration"]
    count, load = range(data.sizes["torque"]), show.described("torque", data).long_name
    rows = [(_title(name), *(_cell(data, name, k) for k in count)) for name in _ROWS]
    damping = input_words(outcome, "dynamics", "damping_ratio")
    if damping:
        rows.insert(3, ("damping ratio ξ", *[damping] * len(count)))
    return SectionTable([f"At the {load}", *_torques(data)], rows, compact=True)


def _status(data: xr.Dataset) -> str:
    """What became of the steady state, once for torques that share it."""
    shared: dict[str, list[str]] = {}
    for torque, sentence in zip(_torques(data), steady_state_sentences(data), strict=True):
        shared.setdefault(sentence, []).append(torque)
    return "; ".join(f"at {', '.join(torques)} {status}" for status, torques in shared.items())


def _title(name: str) -> str:
    variable = VARIABLES[name]
    return f"{variable.long_name} {variable.symbol}"


def _panel(name: str, variant: str, outcome: Outcome) -> plot.Panel:
    data, backwards = outcome.parts["vibration"], period_of(outcome).backwards
    figures = [
        _errors(name, data, backwards),
        _factors(name, data, backwards),
        _spectrum(name, data),
    ]
    return plot.Panel(variant, figures, note=_missing(data))


def _missing(data: xr.Dataset) -> str:
    """Torques without a steady state that could be drawn, in words."""
    lines = [
        f"At {torque} no dynamic values are shown: {sentence}."
        for torque, ok, sentence in zip(
            _torques(data), _found(data), steady_state_sentences(data), strict=True
        )
        if not ok
    ]
    return " ".join(lines)


def _keys(data: xr.Dataset) -> list[plot.Key]:
    return [
        plot.Key(words, plot.PALETTE[k % len(plot.PALETTE)])
        for k, words in enumerate(_torques(data))
    ]


def _errors(name: str, data: xr.Dataset, backwards: bool) -> plot.Figure:
    """Transmission error over one period, dynamic and static, for every torque."""
    traces, keys, unit = [], [], show.unit_of("transmission_error")
    for k, (key, ok) in enumerate(zip(_keys(data), _found(data), strict=True)):
        looks = {
            "static_transmission_error": replace(key, label=f"{key.label}, static", dash="dot")
        }
        if ok:
            looks["transmission_error"] = replace(key, label=f"{key.label}, dynamic")
        for variable, look in reversed(looks.items()):
            x, y = _over_time(data, data[variable].values[k], backwards)
            traces.append(plot.legend_line(look, x, plot.display(variable, y), unit))
            keys.append(look)
    return plot.Figure(
        f"{name}_error",
        "Transmission error over one mesh period",
        traces,
        plot.layout(TIME, f"δ [{unit}]", xaxis={"range": [0, 1]}),
        "Dynamic: with inertia and damping. Static: load over stiffness at each instant.",
        tuple(keys),
        NONE,
    )


def _factors(name: str, data: xr.Dataset, backwards: bool) -> plot.Figure:
    """Force of each pair over that of a single pair that carries everything."""
    traces: list[plot.Trace] = []
    torques: list[tuple[str, str]] = []
    for k, torque in enumerate(_torques(data)):
        if not _found(data)[k]:
            continue
        dash = plot.DASHES[len(torques) % len(plot.DASHES)]
        torques.append((torque, dash))
        for pair, values in enumerate(data["dynamic_factor"].values[k]):
            key = replace(
                plot.pair_key(pair), label=f"{plot.pair_key(pair).label}, {torque}", dash=dash
            )
            course = np.where(np.abs(values) > 1e-12, values, np.nan)
            traces.append(plot.legend_line(key, *_over_time(data, course, backwards), ""))
    keys = [plot.pair_key(pair) for pair in range(data.sizes["pair"])]
    if len(torques) > 1:
        keys += [plot.Key(f"at {torque}", "#5b6873", dash) for torque, dash in torques]
    return plot.Figure(
        f"{name}_factor",
        "Dynamic factors of the pairs",
        traces,
        plot.layout(TIME, plot.short_axis("dynamic_factor"), xaxis={"range": [0, 1]}),
        "Force of a pair over that of a single pair that carries everything without vibration.",
        tuple(keys),
        NONE,
    )


def _over_time(
    data: xr.Dataset, values: np.ndarray, backwards: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Time over period, and values; time may run against the phase."""
    phase = data["phase"].values
    return (
        plot.continued(1.0 - phase[::-1], values[::-1])
        if backwards
        else plot.continued(phase, values)
    )


def _spectrum(name: str, data: xr.Dataset) -> plot.Figure:
    """Amplitudes of the orders of the mesh frequency."""
    wanted = np.isin(data["order"].values, ORDERS)
    keys = [key for key, ok in zip(_keys(data), _found(data), strict=True) if ok]
    spectra = [
        values for values, ok in zip(data["spectrum"].values, _found(data), strict=True) if ok
    ]
    traces = [
        plot.order_bars(
            key,
            data["order"].values[wanted],
            plot.display("spectrum", values[wanted]),
            show.unit_of("spectrum"),
        )
        for key, values in zip(keys, spectra, strict=True)
    ]
    return plot.Figure(
        f"{name}_spectrum",
        "Orders of the transmission error",
        traces,
        plot.layout(
            "order of the mesh frequency",
            plot.short_axis("spectrum"),
            xaxis={"tickvals": [1, *range(5, ORDERS[-1] + 1, 5)], "range": [0.4, ORDERS[-1] + 0.6]},
            yaxis={"rangemode": "tozero"},
            barmode="group",
        ),
        keys=tuple(replace(key, dash="") for key in keys),
        missing=NONE,
    )


def resonance_panels(outcomes: Mapping[str, Outcome]) -> list[plot.Panel]:
    """Vibration against speed for each variant that has it."""
    return [
        plot.Panel(
            name if len(outcomes) > 1 else "",
            [
                _against_speed(f"resonance{position}", variable, outcome)
                for variable in _AGAINST_SPEED
            ],
            note=" ".join(_gaps(outcome.parts["resonance"])),
        )
        for position, (name, outcome) in enumerate(outcomes.items())
        if "resonance" in outcome.parts
    ]


def _against_speed(name: str, variable: str, outcome: Outcome) -> plot.Figure:
    data = outcome.parts["resonance"]
    values = np.where(data["vibration_status"].values == 0, data[variable].values, np.nan)
    rising, falling = plot.display(variable, values)
    speed, unit = plot.display("speed", data["speed"].values, data), show.unit_of(variable)
    alike = np.allclose(rising, falling, rtol=1e-6, equal_nan=True)
    traces = []
    for key, up, down in zip(_keys(data), rising, falling, strict=True):
        branches = (
            {"rising": ("solid", up)}
            if alike
            else {"rising": ("solid", up), "falling": ("dash", down)}
        )
        for branch, (dash, course) in branches.items():
            look = replace(key, label=f"{key.label}, {branch}", dash=dash)
            traces.append(plot.legend_line(look, speed, course, unit, **_dots(key.colour, branch)))
    keys = _keys(data)
    note = "Speed rising and falling give the same."
    if not alike:
        keys += [plot.Key("speed rising", "#5b6873"), plot.Key("speed falling", "#5b6873", "dash")]
        note = "Where only the solid line is seen, both branches lie on each other."
    marks = _resonances(outcome, speed)
    if marks:
        note += (
            f" Dotted: speeds at which {', '.join(label for label, _ in marks)} is the mesh "
            "frequency, with the mean stiffness."
        )
    return plot.Figure(
        f"{name}_{variable}",
        f"{titled(variable)} against speed",
        traces,
        plot.layout(
            show.axis_title("speed", data), plot.short_axis(variable), yaxis={"rangemode": "tozero"}
        )
        | plot.verticals(marks),
        note,
        tuple(keys),
        NONE,
    )


def _dots(colour: str, branch: str) -> dict[str, Any]:
    """Small marks: a single speed between two gaps would be no line."""
    symbol = "circle" if branch == "rising" else "circle-open"
    return {"mode": "lines+markers", "marker": {"size": 4, "color": colour, "symbol": symbol}}


def _resonances(outcome: Outcome, speed: np.ndarray) -> list[tuple[str, float]]:
    """Driver speeds, as shown, at which a part of the natural frequency is the mesh frequency."""
    if "vibration" not in outcome.parts:
        return []
    natural = float(outcome.parts["vibration"]["natural_frequency"].values[-1])
    angle = period_of(outcome).angle
    marks: list[tuple[str, float]] = []
    for part in range(1, _FEW + 1):
        there = float(plot.display("speed", natural / part * angle, outcome.parts["resonance"]))
        near = marks and abs(marks[-1][1] - there) < 0.13 * np.ptp(speed)
        if speed.min() <= there <= speed.max() and not near:
            marks.append(("f_n" if part == 1 else f"f_n/{part}", there))
    return marks


def _gaps(data: xr.Dataset) -> Iterator[str]:
    """For each torque how many speeds have no steady state, and why; one sentence where directions agree."""
    ways: dict[tuple[str, str], list[str]] = {}
    sentences = json.loads(data.attrs.get("sentences", "[]"))
    codes = data["vibration_status"].values
    speed, unit = plot.display("speed", data["speed"].values, data), show.unit_of("speed", data)
    for direction, by_torque in zip(data["direction"].values, codes, strict=True):
        for torque, statuses in zip(_torques(data), by_torque, strict=True):
            for code in np.unique(statuses[statuses != 0]):
                where = speed[statuses == code]
                ends = f"{show.number_text(where[0])} to {show.number_text(where[-1])} {unit}"
                words = ends if where.size > 1 else f"{show.number_text(where[0])} {unit}"
                why = sentences[int(code)] if int(code) < len(sentences) else "not solved"
                left_out = f"{where.size} of {speed.size} speeds ({words}) are left out, {why}."
                ways.setdefault((torque, left_out), []).append(str(direction))
    for (torque, left_out), those in ways.items():
        yield f"At {torque}, speed {' and '.join(those)}: {left_out}"


def _blocks(page: Page) -> Iterator[Block]:
    panels = zip(vibration_panels(page.outcomes), page.having("vibration").values(), strict=True)
    yield from tabbed((it.title, _steady(it, outcome)) for it, outcome in panels)
    if swept := resonance_panels(page.outcomes):
        yield Heading("Against speed")
        yield from tabbed((it.title, _through_resonance(it)) for it in swept)


def _through_resonance(it: plot.Panel) -> Iterator[Block]:
    if it.note:
        yield Paragraph(it.note, "warning")
    yield it


def _steady(it: plot.Panel, outcome: Outcome) -> Iterator[Block]:
    data = outcome.parts["vibration"]
    yield Paragraph(
        "Steady state at the operating speed; the motion of one member against the other, measured along "
        f"the line of action. Contact: {data.attrs.get('contact', '')}."
    )
    if it.note:
        yield Paragraph(it.note, "warning")
    yield _table(outcome)
    yield Paragraph(f"Steady state: {_status(data)}.", "note")
    yield it


def _lacks(page: Page) -> str | None:
    there = page.having("vibration") or page.having("resonance")
    return None if there else reason(page, "vibration")


def _answer(outcome: Outcome) -> Iterator[KeyFigure]:
    """Transmission error at each torque, as the gears vibrate."""
    if answers := vibration_answer(outcome):
        (value, detail), *others = answers
        details = [detail, *(" ".join(answer) for answer in others)]
        yield KeyFigure(35.0, "Transmission error", value, "; ".join(details))
        yield _natural(outcome)


def _natural(outcome: Outcome) -> KeyFigure:
    """Natural frequency at the operating torque, and the driver speed at which it is the mesh frequency."""
    data = outcome.parts["vibration"]
    natural = float(data["natural_frequency"].values[-1])
    met = show.quantity("speed", natural * period_of(outcome).angle, of=data)
    driver = show.with_article(outcome.manifest["driver"])
    value = show.quantity("natural_frequency", natural)
    return KeyFigure(36.0, "Natural frequency", value, f"that of the mesh at {met} of {driver}")


def _screen(outcome: Outcome) -> Iterator[Printed]:
    """Stiffness and transmission error for every torque."""
    data = outcome.parts.get("vibration")
    if data is not None:
        rows = [
            {head("torque", data): screen_value("torque", float(torque), data)}
            | {head(name): screen_value(name, float(data[name].values[k])) for name in FIGURES}
            for k, torque in enumerate(data["torque"].values)
        ]
        yield Printed(rows=rows)


VIBRATION = Section(
    name="vibration",
    title="Vibration",
    short="Vibration",
    order=410.0,
    parts=("vibration",),
    lacks=_lacks,
    blocks=_blocks,
    answer=_answer,
    screen=_screen,
    of_a_mesh=True,
    main_figure="vibration0_factor",
)
