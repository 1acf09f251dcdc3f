"""Kinematic error by deviations of the teeth: over a turn, and by order."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import error_ranges
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.screen import head, screen_value

__all__ = [
    "error_blocks",
    "error_facts",
    "error_printed",
    "error_rows",
    "kinematic_error_answer",
    "kinematic_error_panels",
]

_KEYS = {
    "geometry": plot.Key("rigid teeth without load", plot.GREY),
    "elastic mean": plot.Key("elastic mean over the pairs that carry", plot.PALETTE[0], "dash"),
    "under load": plot.Key("under the operating torque", plot.PALETTE[1]),
}
_LEAST = 0.05
"""Part of the largest amplitude below which the orders end in the figure."""

_FEWEST = 6
"""Orders that are always in it."""


def kinematic_error_panels(page: section.Page) -> list[plot.Panel]:
    """Figures for each variant whose teeth have deviations, and for each such stage."""
    return [
        _panel(f"kinematic{position}", title, outcome)
        for position, title, outcome in page.each("kinematic_error")
    ]


def kinematic_error_answer(outcome: Outcome) -> str:
    """Peak to peak in words; empty if there are no deviations."""
    data = outcome.parts.get("kinematic_error")
    if data is None:
        return ""
    if not np.isfinite(data["kinematic_error_range"].values).all():
        return "no equilibrium was found at some places of the turn"
    loaded, rigid = (
        show.quantity(
            "kinematic_error_range", float(data["kinematic_error_range"].values[k, -1]), of=data
        )
        for k in (-1, 0)
    )
    return (
        f"{loaded} peak to peak under the operating torque over {data.attrs['turn']}, by deviations of the "
        f"teeth; {rigid} if they were rigid and without load"
    )


def _panel(name: str, title: str, outcome: Outcome) -> plot.Panel:
    data = outcome.parts["kinematic_error"]
    members = [str(member) for member in data["member"].values]
    deviate = np.any(data["kinematic_error_range"].values[:, : len(members)] != 0.0, axis=0)
    bars = [
        _spectrum(f"{name}_{position}", data, position, member)
        for position, member in enumerate(members)
        if deviate[position]
    ]
    return plot.Panel(title, [_turn(f"{name}_turn", data), *bars], note=data.attrs["note"])


def _turn(name: str, data: xr.Dataset) -> plot.Figure:
    """Error by the deviations of both members."""
    angle = plot.display("turn_angle", data["turn_angle"])
    unit = show.unit_of("kinematic_error", data)
    quarter = float(plot.display("turn_angle", 0.5 * np.pi))
    traces = [
        plot.legend_line(
            key,
            *plot.continued(
                angle, plot.display("kinematic_error", data["kinematic_error"][k], data)
            ),
            unit,
        )
        for k, key in enumerate(_KEYS.values())
    ]
    return plot.Figure(
        name,
        f"Kinematic error over {data.attrs['turn']}",
        traces,
        plot.layout(
            f"{data.attrs['turn_angle']} θ [{show.unit_of('turn_angle')}]",
            plot.short_axis("kinematic_error", data),
            xaxis={"range": [0, 4.0 * quarter], "dtick": quarter},
        ),
        "Rotation of the loaded member in the sense of its torque, less that of teeth without "
        "deviations.",
        tuple(_KEYS.values()),
        missing="No equilibrium was found.",
    )


def _spectrum(name: str, data: xr.Dataset, position: int, member: str) -> plot.Figure:
    """Amplitudes of the orders that the deviations of one member make."""
    lines = plot.display(
        "kinematic_error_spectrum", data["kinematic_error_spectrum"][:, position], data
    )
    alone = float(data["kinematic_error_range"].values[-1, position])
    orders, unit = _orders(lines), show.unit_of("kinematic_error_spectrum", data)
    return plot.Figure(
        name,
        f"Orders by {show.with_article(member)}",
        [
            plot.order_bars(key, orders, lines[k][orders], unit)
            for k, key in enumerate(_KEYS.values())
        ],
        plot.layout(
            f"order, per {data.attrs['own_turn'].format(member)}",
            plot.short_axis("kinematic_error_spectrum", data),
            xaxis={"range": [0.4, orders[-1] + 0.6], "dtick": 1 if orders.size < 25 else None},
            yaxis={"rangemode": "tozero"},
            barmode="group",
        ),
        f"With deviations of {show.with_article(member)} alone, over {data.attrs['turn_alone']}: "
        f"{show.quantity('kinematic_error_range', alone, of=data)} peak to peak under the operating torque. "
        "Orders of the mesh, about the number of teeth, are not drawn.",
        tuple(replace(key, dash="") for key in _KEYS.values()),
        missing="No equilibrium was found.",
    )


def _orders(lines: np.ndarray) -> np.ndarray:
    """Orders from 1 to the last that can be seen, below half the number of teeth."""
    half = lines[:, : lines.shape[1] // 2 + 2]
    seen = np.flatnonzero(np.nanmax(half[:, 1:], axis=0) > _LEAST * np.nanmax(half[:, 1:])) + 1
    return np.arange(1, max(int(seen[-1]) if seen.size else 0, _FEWEST) + 1)


def error_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Kinematic error, peak to peak, by the deviations of each member and of both."""
    name, data = "kinematic_error_range", outcome.parts.get("kinematic_error")
    return [
        {head(name, data): curve}
        | {
            cause: screen_value(name, float(v), data)
            for cause, v in zip(causes, values, strict=True)
        }
        for curve, causes, values in error_ranges(data)
    ]


def error_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield section.Paragraph(
        "By the deviations that the case gives for the teeth, which differ from tooth to tooth: the mesh "
        "cycle, its losses and stiffness are those of teeth without them."
    )
    for it in kinematic_error_panels(page):
        if it.title:
            yield section.Heading(it.title)
        yield section.Paragraph(it.note)
        yield from section.naming(it.title, [it])


def error_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Peak to peak of the kinematic error."""
    words = kinematic_error_answer(outcome)
    figure = section.key_figure(73.0, "Kinematic error", words, " peak to peak")
    detail = figure.detail.replace("peak to peak ", "peak to peak, ", 1)
    yield replace(figure, detail=detail, asked_by=("gears.deviations",))


def error_printed(outcome: Outcome) -> Iterable[section.Printed]:
    """What the screen shows."""
    return [section.Printed(rows=error_rows(outcome))]
