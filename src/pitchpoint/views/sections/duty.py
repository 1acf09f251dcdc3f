"""The duty cycle of a case: energies, torques, what fails first, operating points over the efficiency."""

from collections.abc import Iterator
from dataclasses import replace
from math import ceil

import numpy as np
import xarray as xr

from pitchpoint.duty_cycle.first_failure import WITHOUT_LIFE
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.duty_cycle import cycle_figures, cycle_words, first_to_fail
from pitchpoint.views.figures import Figure, Panel, display, laws, level, rounded
from pitchpoint.views.section import (
    Block,
    KeyFigure,
    Page,
    Paragraph,
    Printed,
    Table,
    by_variant,
)
from pitchpoint.views.sections.four_quadrants import OF_OUTPUT
from pitchpoint.views.sections.loss_map import map_figure

__all__ = ["duty_blocks", "duty_facts", "duty_printed", "operating_points"]

_MOST = 2000
"""Largest number of operating points that go into the page."""

_PART = "duty"


def operating_points(name: str, outcome: Outcome) -> Figure:
    """Operating points of a cycle over the efficiency of the drive, at the temperature next to their mean.

    Args:
        name: of the figure.
        outcome: with a duty cycle and its map.
    """
    data, cycle = outcome.parts[OF_OUTPUT.part], outcome.parts[_PART]
    mean = float(cycle["temperature"].mean())
    place = int(np.argmin(np.abs(data["temperature"].values - mean)))
    step = ceil(cycle.sizes["time"] / _MOST)
    across, up = (cycle[axis].values[::step] for axis in OF_OUTPUT.axes)
    points = {
        "type": "scatter",
        "mode": "markers",
        "x": rounded(display("output_speed", across, cycle)),
        "y": rounded(display("output_torque", up, cycle)),
        "marker": {"size": 5, "color": "#c2185b", "opacity": 0.6},
        "hovertemplate": "%{x:.4~r}, %{y:.4~r}<extra>duty cycle</extra>",
    }
    law = laws(data).index(str(cycle.attrs["law"]))
    drawn = map_figure("mean_efficiency", outcome, OF_OUTPUT, law, place)
    degree = level("temperature", float(data["temperature"].values[place]))
    thinned = f", one in {step} of them" if step > 1 else ""
    told = f"Dots are the operating points of the cycle{thinned}; oil at {degree}."
    return replace(drawn, name=name, data=[drawn.data[0], points], note=told)


def duty_blocks(page: Page) -> Iterator[Block]:
    """Figures and operating points of the duty cycle of each variant."""
    yield Paragraph(
        "Torque is that of the output on its load, positive along positive speeds. The cycle goes over and "
        "over."
    )
    yield from by_variant(page, _PART, _of_variant)


def _of_variant(place: int, outcome: Outcome) -> Iterator[Block]:
    data = outcome.parts[_PART]
    yield Paragraph(show.sentence(cycle_words(data)))
    rows = [[row.name, row.value, row.detail] for row in cycle_figures(data)]
    yield Table(["", "value", ""], rows, caption="Over the duty cycle")
    if "bearing" in data.coords:
        yield _lives(data)
    out = filter(None, str(data.attrs["left_out"]).split(", "))
    yield Paragraph(" ".join(WITHOUT_LIFE[key] for key in out), "note")
    figure = operating_points(f"duty_{place}", outcome)
    yield Panel("Operating points over the efficiency", [figure])


def _lives(data: xr.Dataset) -> Table:
    """Lives of bearings and wave generators."""
    pairs = zip(data["bearing"].values, data["bearing_life"].values, strict=True)
    rows = [[str(name), show.quantity("bearing_life", float(life))] for name, life in pairs]
    return Table(["bearing", "life"], rows, caption="Lives of bearings")


def duty_facts(outcome: Outcome) -> Iterator[KeyFigure]:
    """What is lost over the duty cycle, and what fails first."""
    data = outcome.parts[_PART]
    lost, taken = (
        show.quantity(name, float(data[name]), of=data) for name in ("lost_energy", "input_energy")
    )
    yield KeyFigure(37.0, "Duty cycle", f"{lost} lost", f"of {taken} in; {cycle_words(data)}")
    yield first_to_fail(data, 38.0)


def duty_printed(outcome: Outcome) -> Iterator[Printed]:
    """The same with all figures."""
    data = outcome.parts[_PART]
    rows = [{"": row.name, "value": row.value, "with": row.detail} for row in cycle_figures(data)]
    yield Printed("Over the duty cycle", rows, cycle_words(data))
