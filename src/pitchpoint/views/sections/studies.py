"""Figures and tables of the studies of a case."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint import units
from pitchpoint.analyses.figures import CONTACT, MAIN, covered, of_contact
from pitchpoint.analyses.studies import is_study
from pitchpoint.cases.schema import quantity_at
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import (
    Choice,
    Curve,
    Curves,
    Figure,
    Panel,
    Trace,
    display,
    laws,
    layout,
    line,
    short_axis,
    text,
)
from pitchpoint.views.lines import titled
from pitchpoint.views.screen import efficiency_of, head, shown
from pitchpoint.views.section import Block, Drawn, Heading, Page, Paragraph, Printed, Section, Table
from pitchpoint.views.sections.design_chart import design_charts, is_design_chart

__all__ = ["STUDIES", "study_panels", "swept_rows"]

_SHOWN = ("mean_efficiency", "efficiency_fluctuation", "mean_input_torque", "torque_ripple")
_MOVING = ("mean_stiffness", "transmission_error_range", "largest_dynamic_factor")
"""Shown where a case has vibration, the same under every friction law."""
_TABLE = ("contact_ratio", *MAIN)

_WORDS = {
    "operation.torque": "output torque",
    "operation.force": "normal force",
    "operation.speed": "driver speed",
    "operation.temperature": "oil temperature",
    "roughness.ra": "roughness Ra",
    "gears.addendum": "addendum of both basic racks [modules]",
    "gears.profile_shift": "profile shift x1",
}

Seen = list[tuple[Curve, xr.Dataset, int]]


def study_panels(outcomes: Mapping[str, Outcome], known: Curves) -> list[Panel]:
    """A panel for each sweep."""
    return [_panel(name, seen) for name, seen in _studies(outcomes, known) if "axis" in seen[0][1]]


def _tables(page: Page) -> Iterator[Block]:
    """Heading and table for each study of a single point."""
    for _, seen in _studies(page.outcomes, page.curves):
        if "axis" not in seen[0][1]:
            columns = _columns(seen)
            yield Heading(str(seen[0][1].attrs["title"]))
            yield Table(
                ["Friction law", *(show.axis_title(name, seen[0][1]) for name in columns)],
                [(curve.label, *_cells(data, law, columns)) for curve, data, law in seen],
            )


def _studies(outcomes: Mapping[str, Outcome], known: Curves) -> Iterator[tuple[str, Seen]]:
    names = dict.fromkeys(
        name for outcome in outcomes.values() for name in outcome.parts if is_study(name)
    )
    for name in names:
        yield (
            name,
            [
                (known[variant, law], outcome.parts[name], position)
                for variant, outcome in outcomes.items()
                if name in outcome.parts
                for position, law in enumerate(laws(outcome.parts[name]))
            ],
        )


def _columns(seen: Seen) -> list[str]:
    """Quantities of the table of a study of a single point."""
    more = ["mean_stiffness", "stiffness_variation", *_MOVING[1:]]
    if of_contact(seen[0][1]):
        return [*CONTACT]
    return [name for name in (*_TABLE, *more) if any(name in data for _, data, _ in seen)]


def _cells(data: xr.Dataset, law: int, columns: list[str]) -> list[str]:
    return [
        show.quantity(name, float(_valid(data, name)[law, 0]), with_unit=False, of=data)
        for name in columns
    ]


def _valid(data: xr.Dataset, name: str) -> np.ndarray:
    """Values [law, point], those of a vibration only where there is a steady state."""
    if name not in data:
        return np.full(data["mean_loss"].shape, np.nan)
    values = data[name].values
    if name in _MOVING[1:] and "vibration_status" in data:
        return np.where(data["vibration_status"].values == 0, values, np.nan)
    return np.asarray(values)


def _panel(name: str, seen: Seen) -> Panel:
    data = seen[0][1]
    chart = is_design_chart(data)
    axes = [_swept, _ratio] if _ratio_varies(data) and not chart else [_swept]
    more = _MOVING[2:] if chart else _MOVING
    first = CONTACT if of_contact(data) else _SHOWN
    every = [*first, *(name for name in more if any(name in data for _, data, _ in seen))]
    figures = [_figure(f"{name}_{variable}", variable, seen, axes[-1]) for variable in every]
    choices = []
    if len(axes) > 1:
        choices = [_choice(axis, figures, seen) for axis in reversed(axes)]
    note = f"Swept: {data.attrs['sweep_key']}."
    return Panel(
        str(data.attrs["title"]),
        figures,
        [curve for curve, *_ in seen],
        choices,
        note,
        "Shown against",
    )


def _figure(name: str, variable: str, seen: Seen, axis: Any) -> Figure:
    like = seen[0][1]
    unit = show.unit_of(variable, like)
    return Figure(
        name,
        titled(variable, like),
        [_trace(curve, data, law, variable, axis, unit) for curve, data, law in seen],
        layout(text(axis(like)[1]), short_axis(variable, like)),
    )


def _trace(curve: Curve, data: xr.Dataset, law: int, variable: str, axis: Any, unit: str) -> Trace:
    values = display(variable, _valid(data, variable)[law], data)
    marks = {"mode": "lines+markers", "marker": {"size": 5, "color": curve.colour}}
    return line(curve, axis(data)[0], values, unit, **marks)


def _choice(axis: Any, figures: list[Figure], seen: Seen) -> Choice:
    x = [_trace(curve, data, law, "mean_loss", axis, "")["x"] for curve, data, law in seen]
    title = axis(seen[0][1])[1]
    change: list[Any] = [{"x": x}, {"xaxis.title.text": text(title)}]
    return Choice(title, {figure.name: change for figure in figures})


def _swept(data: xr.Dataset) -> tuple[np.ndarray, str]:
    """Values of the swept key in its unit, and the title of their axis."""
    values = data["axis"].values
    key = str(data.attrs["sweep_key"])
    words = _WORDS.get(key, key.replace("_", " ").replace(".", ", ", 1))
    if not np.isfinite(values).all():
        return np.arange(1.0, values.size + 1.0), f"{words} (number in the list)"
    unit, kind = str(data.attrs["axis_unit"]), str(data.attrs["axis_kind"])
    if kind:
        values = np.asarray(units.convert(values, unit, kind))
    return values, f"{words} [{show.unit(unit)}]" if show.unit(unit) else words


def _ratio(data: xr.Dataset) -> tuple[np.ndarray, str]:
    return data["contact_ratio"].values[0], "contact ratio"


def _ratio_varies(data: xr.Dataset) -> bool:
    return "contact_ratio" in data and bool(np.ptp(data["contact_ratio"].values) > 1e-6)


def _blocks(page: Page) -> Iterator[Block]:
    from markupsafe import Markup

    yield Paragraph(
        Markup(
            "Apart from what is named, every study stands at the operating point. How far the friction laws "
            'disagree is shown at the operating point, <a href="#answer">above</a>.'
        ),
        "note",
    )
    if alone := covered(one.parts for one in page.outcomes.values()):
        yield Paragraph(alone, "note")
    told = _warnings(page)
    if told:
        yield Drawn("study_warnings.html.jinja", {"study_warnings": told})
    for it in (*design_charts(page.outcomes), *study_panels(page.outcomes, page.curves)):
        yield Heading(it.title)
        yield Paragraph(it.note, "note")
        yield it
    yield from _tables(page)


def _warnings(page: Page) -> list[str]:
    """Sentences of the studies, each with its variant and title."""
    return [
        f"{f'{variant}, ' if page.several else ''}{text}"
        for variant, outcome in page.outcomes.items()
        for text in _warns(outcome)
    ]


def _warns(outcome: Outcome) -> list[str]:
    return [
        f"{data.attrs['title']}: {text}"
        for name, data in outcome.parts.items()
        if is_study(name)
        for text in json.loads(data.attrs.get("warnings", "[]"))
        if text not in outcome.manifest["warnings"]
    ]


SWEPT = ("mean_efficiency", "torque_ripple", "mean_stiffness", "transmission_error_range")


def _screen(outcome: Outcome) -> Iterator[Printed]:
    """Every sweep of the command line: point by point, each friction law by name."""
    for name, data in outcome.parts.items():
        if name.startswith("study_sweep_") and "axis" in data:
            yield Printed(str(data.attrs["title"]), swept_rows(data))


def swept_rows(data: xr.Dataset) -> list[dict[str, str]]:
    """A sweep point by point, under each friction law."""
    return [
        _swept_row(data, law, point)
        for point in range(data.sizes["point"])
        for law in range(data.sizes["law"])
    ]


def _swept_row(data: xr.Dataset, law: int, point: int) -> dict[str, str]:
    key = data.attrs["sweep_key"]
    place = {key: _place(data["axis"].values[point], key)}
    names = CONTACT if of_contact(data) else SWEPT
    cells = {
        head(n, data): shown(n, float(data[n].values[law, point]), data) for n in names if n in data
    }
    return {**place, "friction law": str(data["law"].values[law]), **cells, **efficiency_of(data)}


def _place(value: float, key: str) -> str:
    """Place on the axis of a sweep as case files write it."""
    quantity = quantity_at(key)
    return f"{value:.6g}" if quantity is None else quantity.show(float(value))


def _lacks(page: Page) -> str | None:
    there = any(is_study(name) for one in page.outcomes.values() for name in one.parts)
    return None if there else ""


STUDIES = Section(
    name="studies",
    title="Studies",
    short="Studies",
    order=600.0,
    lacks=_lacks,
    blocks=_blocks,
    warns=_warns,
    screen=_screen,
)
