"""Stages of a drive: what each loses, and how far it lets the output turn."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import STAGES as FIGURES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.lines import titled
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.section import (
    Block,
    Heading,
    Page,
    Printed,
    Section,
    naming,
    transposed_table,
)

__all__ = ["STAGES", "stage_rows", "stage_words"]


def stage_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Figures of each stage by law, those that are nothing anywhere left out; none of one mesh."""
    data = outcome.parts.get("operation")
    if data is None or "stage" not in data.coords:
        return []
    names = [name for name in FIGURES if name in data and np.any(data[name])]
    return [
        {"friction law": law, "stage": stage_words(outcome, at, stage)}
        | {
            head(name, data): _of_stage(
                screen_value, name, float(data[name].values[k, 0, at]), data
            )
            for name in names
        }
        for k, law in enumerate(plot.laws(data))
        for at, stage in enumerate(data["stage"].values)
    ]


def _of_stage(words: Callable[[str, float, Any], str], name: str, value: float, data: Any) -> str:
    """A figure of a stage in words; a dash for what only sets have."""
    return "–" if name == "stage_latent_power" and np.isnan(value) else words(name, value, data)


def _quantity(name: str, value: float, data: Any) -> str:
    return show.quantity(name, value, of=data)


def stage_words(outcome: Outcome, at: int, stage: Any) -> str:
    """Number of a stage, with its bodies where it is a mesh of a train."""
    bodies = [stage_record["bodies"] for stage_record in outcome.manifest.get("stages", ())][
        at : at + 1
    ]
    return f"{stage}: {bodies[0]}" if bodies and bodies[0] else str(stage)


def _card(outcome: Outcome, law: str) -> Iterator[tuple[str, str]]:
    """What each stage loses at the operating point under one friction law."""
    data = outcome.parts["operation"]
    if "stage" not in data.coords:
        return
    position = plot.laws(data).index(law)
    for at, stage in enumerate(data["stage"].values):
        loss, efficiency = (
            show.quantity(name, float(data[name].values[position, 0, at]), of=data)
            for name in ("stage_loss", "stage_efficiency")
        )
        yield f"stage {stage_words(outcome, at, stage)}", f"{efficiency}, {loss} lost"


def _blocks(page: Page) -> Iterator[Block]:
    for _, title, outcome in page.each("operation.stage_loss"):
        if title:
            yield Heading(title)
        data = outcome.parts["operation"]
        names = [name for name in FIGURES if name in data]
        titles = [show.described(name, data).long_name for name in names]
        for k, law in enumerate(plot.laws(data)):
            columns = [
                (
                    f"stage {stage_words(outcome, at, stage)}",
                    *(
                        _of_stage(_quantity, n, float(data[n].values[k, 0, at]), data)
                        for n in names
                    ),
                )
                for at, stage in enumerate(data["stage"].values)
            ]
            yield transposed_table(titles, columns, f"by {law}")
    for position, title, outcome in page.each("torsion.stage_wind_up"):
        figure = _wind_up(f"stages{position}", outcome.parts["torsion"])
        yield from naming(title, [plot.Panel(title, [figure])])


def _wind_up(name: str, data: xr.Dataset) -> plot.Figure:
    """Wind-up at the output by each stage against torque."""
    variable = "stage_wind_up"
    unit = show.unit_of(variable, data)
    keys = tuple(
        plot.Key(
            f"stage {stage}",
            plot.PALETTE[at % len(plot.PALETTE)],
            plot.DASHES[at % len(plot.DASHES)],
        )
        for at, stage in enumerate(data["stage"].values)
    )
    load = plot.display("torque", data["torque"], data)
    turned = plot.display(variable, data[variable], data)
    return plot.Figure(
        name,
        titled(variable, data),
        [plot.legend_line(key, load, turned[:, at], unit) for at, key in enumerate(keys)],
        plot.layout(
            plot.short_axis("torque", data),
            plot.short_axis(variable, data),
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        "Stages are springs one behind the other: that of the drive is their sum.",
        keys,
    )


def _lacks(page: Page) -> str | None:
    return None if page.having("operation.stage_loss") else ""


STAGES = Section(
    name="stages",
    title="Stages",
    short="Stages",
    order=50.0,
    blocks=_blocks,
    lacks=_lacks,
    card=_card,
    main_figure="stages0",
    screen=lambda one: [Printed(rows=rows)] if (rows := stage_rows(one)) else [],
)
