"""Stiffness of the mesh: of each pair and of all together, beside the standard's estimate."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
import xarray as xr

from pitchpoint.core.doubts import doubts_of
from pitchpoint.published.publication_registry import publication_of
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.lines import overlaid
from pitchpoint.views.point import Period, period_of

__all__ = [
    "stiffness_answer",
    "stiffness_blocks",
    "stiffness_facts",
    "stiffness_panels",
]

_ROWS = ("mean_stiffness", "stiffness_variation", "standard_stiffness", "standard_single_stiffness")
_STANDARD = plot.Key("mesh, estimate of ISO 6336-1", "#8a4b08", "longdash")
_OUTSIDE = plot.Key("mesh, estimate of ISO 6336-1, outside its range", "#8a4b08", "longdash")
_TOTAL = plot.Key("mesh", plot.INK)
_MEAN = plot.Key("mesh, mean", plot.GREY, "dot")


def stiffness_panels(outcomes: Mapping[str, Outcome]) -> list[plot.Panel]:
    """Figures for each variant whose stiffness is there."""
    return [
        _panel(f"stiffness{position}", name if len(outcomes) > 1 else "", outcome)
        for position, (name, outcome) in enumerate(outcomes.items())
        if "stiffness" in outcome.parts
    ]


def _table(page: section.Page) -> section.SectionTable:
    """Means and variations, a column for each variant."""
    parts = {name: outcome.parts["stiffness"] for name, outcome in page.outcomes.items()}
    rows = [
        (_title(name), *(_cell(data, name) for data in parts.values()))
        for name in _ROWS
        if any(name in data for data in parts.values())
    ]
    models = [str(data.attrs.get("model", "")) for data in parts.values()]
    head = [*parts] if page.several or "number" in page.first else ["value"]
    return section.SectionTable(
        ["Stiffness", *head], [*rows, ("teeth yield as", *models)], compact=True
    )


def stiffness_answer(outcome: Outcome) -> str:
    """Mean and variation in words; empty without stiffness."""
    data = outcome.parts.get("stiffness")
    if data is None:
        return ""
    return (
        f"{_cell(data, 'mean_stiffness')} in the mean, varies by "
        f"{_cell(data, 'stiffness_variation')} of it over the mesh cycle"
    )


def _title(name: str) -> str:
    variable = VARIABLES[name]
    symbol = f" {variable.symbol}" if variable.symbol not in variable.long_name else ""
    return variable.long_name + symbol


def _cell(data: xr.Dataset, name: str) -> str:
    return show.quantity(name, float(data[name])) if name in data else "no estimate"


def _panel(name: str, variant: str, outcome: Outcome) -> plot.Panel:
    data, period = outcome.parts["stiffness"], period_of(outcome)
    reasons = "; ".join(_outside_standard(data))
    note = f"The estimate of ISO 6336-1 is outside its range: {reasons}." if reasons else ""
    return plot.Panel(
        variant, [_over_phase(name, data, period), _of_a_pair(name, data, period)], note=note
    )


def _outside_standard(data: xr.Dataset) -> list[str]:
    """Where the pair lies outside what the standard's estimate covers."""
    return [doubt for doubt in doubts_of(data.attrs) if "ISO 6336-1" in doubt]


def _over_phase(name: str, data: xr.Dataset, period: Period) -> plot.Figure:
    phase, unit = data["phase"].values, show.display_unit(VARIABLES["mesh_stiffness"].display)
    keys = [plot.pair_key(pair) for pair in range(data.sizes["pair"])]
    traces = [
        plot.legend_line(key, *_shown(phase, values), unit)
        for key, values in zip(keys, _touching(data, "pair_stiffness"), strict=True)
    ]
    total = plot.legend_line(_TOTAL, *_shown(phase, data["mesh_stiffness"].values), unit)
    total["line"] = {**total["line"], "width": 3}
    standard = _OUTSIDE if _outside_standard(data) else _STANDARD
    levels = {_MEAN: "mean_stiffness", standard: "standard_stiffness"}
    shown_levels = {key: variable for key, variable in levels.items() if variable in data}
    traces += [total, *(_level(key, float(data[v]), unit) for key, v in shown_levels.items())]
    return plot.Figure(
        f"{name}_phase",
        "Stiffness of the pairs and of the mesh",
        traces,
        plot.layout(
            period.axis, f"k [{unit}]", xaxis={"range": [0, 1]}, yaxis={"rangemode": "tozero"}
        ),
        keys=(*keys, _TOTAL, *shown_levels),
    )


def _of_a_pair(name: str, data: xr.Dataset, period: Period) -> plot.Figure:
    """A pair from its entry to its exit."""
    entered = data["entered"].values.ravel()
    order = np.argsort(entered, kind="stable")
    values = _touching(data, "pair_stiffness").ravel()[order]
    unit = show.display_unit(VARIABLES["pair_stiffness"].display)
    key = plot.Key("pair", plot.PALETTE[0])
    x, y = _shown(entered[order], values)
    seen = np.isfinite(values)
    end = float(entered[order][seen][-1]) if seen.any() else 1.0
    return plot.Figure(
        f"{name}_pair",
        "Stiffness of one pair from its entry to its exit",
        [plot.legend_line(key, x, y, unit)],
        plot.layout(
            f"{period.pitch}es since the pair entered ε_0",
            plot.short_axis("pair_stiffness"),
            xaxis={"range": [-0.02 * end, 1.02 * end]},
            yaxis={"rangemode": "tozero"},
        ),
    )


def _touching(data: xr.Dataset, name: str) -> np.ndarray:
    """Values [pair, node]; not a number where the pair does not touch."""
    length = data["line_length"].values
    return np.where(length > 1e-7 * length.max(initial=0.0), data[name].values, np.nan)


def _shown(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return plot.continued(x, plot.display("mesh_stiffness", y))


def _level(key: plot.Key, value: float, unit: str) -> plot.Trace:
    return plot.legend_line(
        key, [0.0, 1.0], [float(plot.display("mesh_stiffness", value))] * 2, unit
    )


def stiffness_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield section.Paragraph(
        "Along the transverse line of action: force there over the approach of the teeth. Pair I entered in "
        "this period, II one period before, and so on; the mesh is their sum."
    )
    if note := _of_publication(page.first.get("source", "")):
        yield section.Paragraph(note, "note")
    of_drives, page = page.outcomes, page.by_mesh("stiffness")
    yield _table(page)
    having = page.outcomes
    if page.designs and len(having) > 1:
        parts = {name: outcome.parts["stiffness"] for name, outcome in having.items()}
        title = "Mesh stiffness over the mesh cycle"
        figure = overlaid("stiffness_of_designs", title, "phase", "mesh_stiffness", parts)
        yield plot.Panel("Designs on the same axes", [figure])
    alone = "" if {*having} <= {*of_drives} else next(iter(having))
    yield from section.tabbed(
        (it.title or alone, _of_variant(it)) for it in stiffness_panels(having)
    )


def _of_publication(source: str) -> str:
    """On which stiffness the formulas of a publication run, where that is another one."""
    publication = publication_of(source)
    return publication.stiffness if publication else ""


def _of_variant(it: plot.Panel) -> Iterator[section.Block]:
    yield it
    if it.note:
        yield section.Paragraph(it.note, "warning")


def stiffness_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Stiffness of the mesh, and how much it varies."""
    published = _of_publication(outcome.manifest.get("source", ""))
    title = "Mesh stiffness of the library, not of the motion" if published else "Mesh stiffness"
    figure = section.key_figure(72.0, title, stiffness_answer(outcome), " in the mean")
    yield replace(figure, asked_by=("models.tooth_compliance", "models.line_stiffness"))
