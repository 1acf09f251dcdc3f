"""A gear train over its period: torque and efficiency over the angle, what each planet carries."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.lines import gapped, titled

__all__ = ["train_period_blocks", "train_period_printed"]

_PART = "train_period"


def train_period_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    variants, page = page.having(_PART), page.by_mesh(_PART)
    alone = len(variants) == 1 and [*variants] == [*page.outcomes]
    first = next(iter(page.outcomes))
    for position, (variant, outcome) in enumerate(page.outcomes.items()):
        data = outcome.parts[_PART]
        title = "" if alone else variant
        yield from [section.Heading(title)] if title else []
        turn = show.quantity("driver_angle", float(data.attrs["driver_period"]))
        by_law = f" by {plot.laws(data)[0]}" if data.sizes["law"] > 1 else ""
        yield section.Paragraph(
            f"All meshes come together again after {turn} of the driving body. Equilibrium leaves open how "
            "planets share a load: of all forces that hold the train those of the least sum of squares are "
            f"shown{by_law}."
        )
        if rows := _torques(data):
            yield section.SectionTable(_OUTSIDE, rows, compact=True)
            yield section.Paragraph(_OF_TORQUES, "note")
        if "body_thrust" in data and data["body_thrust"].any():
            yield section.SectionTable(_HEADS, _thrusts(data), compact=True)
            yield section.Paragraph(_tilted(data), "note")
        # Stages of one variant have figures of their own: all with whole lines, whose jumps can be seen.
        drawn = (
            first if len(variants) == 1 and (first, plot.laws(data)[0]) in page.curves else variant
        )
        known = {(variant, law): page.curves[drawn, law] for law in plot.laws(data)}
        figures = [
            *(
                _over_angle(f"train{position}_{name}", name, variant, data, known)
                for name in ("input_torque", "efficiency")
            ),
            *_forces(f"train{position}_force", data),
        ]
        yield from section.naming(title, [plot.Panel(title, figures, [*known.values()])])


_HEADS = ["body", f"axial force [{show.unit_of('body_thrust')}]"]


_OUTSIDE = ["friction law", "body", f"mean torque from outside [{show.unit_of('outside_torque')}]"]
_OF_TORQUES = (
    "Torques of the input, of the load, and of what holds the other bodies, with all losses; positive as the "
    "input turns."
)


def _torques(data: xr.Dataset) -> list[tuple[str, ...]]:
    """Rows of torques from outside on the bodies; none of results without them."""
    if "outside_torque" not in data:
        return []
    return [
        (law, str(body), show.quantity("outside_torque", float(value), with_unit=False))
        for law, values in zip(plot.laws(data), data["outside_torque"].values, strict=True)
        for body, value in zip(data["outer_body"].values, values, strict=True)
    ]


def _thrusts(data: xr.Dataset) -> list[tuple[str, ...]]:
    values = zip(data["body"].values, data["body_thrust"].values, strict=True)
    return [
        (str(body), show.quantity("body_thrust", float(value), with_unit=False))
        for body, value in values
    ]


def _tilted(data: xr.Dataset) -> str:
    moment = show.quantity("planet_tilting_moment", float(data["planet_tilting_moment"]))
    return (
        "Axial forces of the teeth without losses, of one planet; one sense, one sign. They tilt "
        f"each planet by {moment} about the tangent of the circle of the pins, which its bearings bear as a "
        "couple beside the force on the pin. Gears of a planet have one hand and count as lying in one plane."
    )


def train_period_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows: torques on the bodies, and axial forces of helical gears."""
    data = outcome.parts[_PART]
    if rows := [dict(zip(_OUTSIDE, row, strict=True)) for row in _torques(data)]:
        yield section.Printed("Torques on the bodies", rows, _OF_TORQUES)
    if "body_thrust" in data and data["body_thrust"].any():
        rows = [dict(zip(_HEADS, row, strict=True)) for row in _thrusts(data)]
        yield section.Printed("Axial forces on the shafts", rows, _tilted(data))


def _over_angle(
    name: str, variable: str, variant: str, data: xr.Dataset, known: plot.Curves
) -> plot.Figure:
    unit = show.unit_of(variable, data)
    angle = plot.display("driver_angle", data["driver_angle"].values)
    traces = [
        plot.line(known[variant, law], *gapped(angle, plot.display(variable, values, data)), unit)
        for law, values in zip(plot.laws(data), data[variable].values, strict=True)
    ]
    return plot.Figure(
        name,
        f"{titled(variable, data)} over the angle of the driving body",
        traces,
        plot.layout(
            plot.short_axis("driver_angle"), plot.short_axis(variable, data), xaxis=_legible(data)
        ),
        _SHOWN if _legible(data) else "",
    )


_PIECES = 150
"""Events of a course that can be told from each other in one figure; many come at once."""

_SHOWN = "The beginning; a double click shows the whole period."


def _legible(data: xr.Dataset) -> dict[str, Any]:
    """Range of the axis of the angle where a period has more pieces than a figure shows; else nothing."""
    angle = plot.display("driver_angle", data["driver_angle"].values)
    jumps = np.flatnonzero(np.diff(angle) < 1e-9 * angle[-1])
    return {"range": [0.0, float(angle[jumps[_PIECES]])]} if len(jumps) > _PIECES else {}


def _forces(name: str, data: xr.Dataset) -> Iterator[plot.Figure]:
    """Normal force of each planet in each mesh under the first law."""
    angle = plot.display("driver_angle", data["driver_angle"].values)
    unit = show.unit_of("contact_force", data)
    for at, mesh in enumerate(data["mesh"].values):
        forces = plot.display("contact_force", data["contact_force"].values[0, at], data)
        copies = int(np.isfinite(forces).any(axis=-1).sum())
        keys = tuple(
            plot.Key(
                f"planet {number}" if copies > 1 else "mesh",
                plot.PALETTE[k % len(plot.PALETTE)],
                plot.DASHES[k % len(plot.DASHES)],
            )
            for k, number in enumerate(data["planet"].values)
            if np.isfinite(forces[k]).any()
        )
        yield plot.Figure(
            f"{name}{at}",
            f"Normal force of the teeth, {mesh}",
            [plot.legend_line(key, *gapped(angle, forces[k]), unit) for k, key in enumerate(keys)],
            plot.layout(
                plot.short_axis("driver_angle"),
                plot.short_axis("contact_force", data),
                xaxis=_legible(data),
            ),
            _SHOWN if _legible(data) else "",
            keys,
        )
