"""The duty cycle of a case: energies, torques, what fails first, operating points over the efficiency."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import ceil

import numpy as np
import xarray as xr

from pitchpoint.duty_cycle.first_failure import WITHOUT_LIFE, part_lives
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.duty_cycle import cycle_figures, cycle_words, first_to_fail, lost_words
from pitchpoint.views.figures import Figure, Panel, Trace, display, laws, level, rounded
from pitchpoint.views.sections.four_quadrants import OF_OUTPUT
from pitchpoint.views.sections.loss_map import colour_scale, map_figure

__all__ = ["actuator_points", "duty_blocks", "duty_facts", "duty_printed", "operating_points"]

_MOST = 2000
"""Largest number of operating points that go into the page."""

_PART = "duty"


def operating_points(name: str, outcome: Outcome) -> Figure:
    """Operating points of a cycle over the efficiency of the drive, at the temperature next to its mean.

    Args:
        name: of the figure.
        outcome: with a duty cycle and its map.
    """
    data, cycle = outcome.parts[OF_OUTPUT.part], outcome.parts[_PART]
    mean = float(cycle.attrs["mean_temperature"])
    place = int(np.argmin(np.abs(data["temperature"].values - mean)))
    points, thinned = _points(cycle)
    law = laws(data).index(str(cycle.attrs["law"]))
    drawn = map_figure("mean_efficiency", outcome, OF_OUTPUT, law, place)
    degree = level("temperature", float(data["temperature"].values[place]))
    note = f"Dots are the operating points of the cycle{thinned}; oil at {degree}."
    return replace(drawn, name=name, data=[drawn.data[0], points], note=note)


def _points(cycle: xr.Dataset) -> tuple[Trace, str]:
    """Dots at the operating points of a cycle, and what is left out of them in words."""
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
    return points, f", one in {step} of them" if step > 1 else ""


ACTUATOR = ("map_actuator_efficiency", "map_electrical_power")
"""Quantities of the actuator that are drawn over its map."""


def actuator_points(name: str, place: int, outcome: Outcome) -> Figure:
    """Operating points of a cycle over a quantity of the actuator, drive and motor together.

    Args:
        name: of `ACTUATOR`.
        place: of the variant, for the name of the figure.
        outcome: with a duty cycle of a motor.
    """
    cycle = outcome.parts[_PART]
    values = cycle[name].values[None, :, :, None]
    dims = ("law", "output_torque", "output_speed", "temperature")
    axes = {"output_torque": cycle["map_torque"].values, "output_speed": cycle["map_speed"].values}
    mean = float(cycle.attrs["mean_temperature"])
    of_output = dataset(
        {name: (dims, values)},
        {"law": [str(cycle.attrs["law"])], **axes, "temperature": [mean]},
        travels=[end for end in ("loaded",) if cycle["output_torque"].attrs["units"] == "N"],
        speed_ratio=outcome.parts[OF_OUTPUT.part].attrs["speed_ratio"],
    )
    parts = {**outcome.parts, OF_OUTPUT.part: of_output}
    drawn = map_figure(
        name, replace(outcome, parts=parts), OF_OUTPUT, 0, 0, colour_scale(name, [values])
    )
    points, thinned = _points(cycle)
    oil = show.quantity("temperature", mean, of=cycle)
    note = (
        f"Dots are the operating points of the cycle{thinned}; drive and motor with oil at {oil}."
    )
    return replace(drawn, name=f"duty_{name}_{place}", data=[drawn.data[0], points], note=note)


def duty_blocks(page: section.Page) -> Iterator[section.Block]:
    """Figures and operating points of the duty cycle of each variant."""
    yield section.Paragraph(
        "Torque is that of the output on its load, positive along positive speeds. The cycle goes over and "
        "over."
    )
    yield from section.blocks_by_variant(page, _PART, _of_variant)


def _of_variant(place: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts[_PART]
    yield section.Paragraph(show.sentence(cycle_words(data)))
    rows = [[row.name, row.value, row.detail] for row in cycle_figures(data)]
    yield section.SectionTable(["", "value", ""], rows, caption="Over the duty cycle")
    if lives := [(name, life) for name, life in part_lives(data) if not np.isnan(life)]:
        yield _lives(lives)
    if "worn" in data.coords:
        yield _worn(data)
    if "law" in data.coords:
        yield _laws(data)
    out = filter(None, str(data.attrs["left_out"]).split(", "))
    yield section.Paragraph(" ".join(WITHOUT_LIFE[key] for key in out), "note")
    figure = operating_points(f"duty_{place}", outcome)
    yield Panel("Operating points over the efficiency", [figure])
    if data.attrs["motor"]:
        figures = [actuator_points(name, place, outcome) for name in ACTUATOR]
        yield Panel("Operating points over the map of the actuator", figures)


def _lives(lives: Sequence[tuple[str, float]]) -> section.SectionTable:
    """Lives of all parts, the shortest first; parts that endure behind them."""
    rows = [
        [name, show.quantity("shortest_life", life) if np.isfinite(life) else "endures"]
        for name, life in sorted(lives, key=lambda pair: pair[1])
    ]
    return section.SectionTable(["part", "life"], rows, caption="Lives of the parts")


def _worn(data: xr.Dataset) -> section.SectionTable:
    """Depth that a cycle wears off."""
    pairs = zip(data["worn"].values, data["cycle_wear"].values, strict=True)
    rows = [[str(name), show.quantity("cycle_wear", float(depth))] for name, depth in pairs]
    return section.SectionTable(["flanks", "depth in a cycle"], rows, caption="Wear of one cycle")


def _laws(data: xr.Dataset) -> section.SectionTable:
    """Energies under each friction law."""
    names = ("law_lost_energy", "law_input_energy")
    columns = [data[name].values for name in names]
    rows = [
        [str(law), *(show.quantity(n, float(v)) for n, v in zip(names, values, strict=True))]
        for law, *values in zip(data["law"].values, *columns, strict=True)
    ]
    caption = "Energies by friction law; all else is by the first one, or by duty.law"
    return section.SectionTable(["law", "lost", "driver gives"], rows, caption=caption)


def duty_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """What is lost over the duty cycle, and what fails first."""
    data = outcome.parts[_PART]
    taken = show.quantity("input_energy", float(data["input_energy"]), of=data)
    failing = first_to_fail(data, 38.0)
    fails = f"fails first: {failing.value}; of {taken} in"
    detail = fails if data.attrs["first_to_fail"] else f"of {taken} in; {cycle_words(data)}"
    yield section.KeyFigure(37.0, "Duty cycle", f"{lost_words(data)} lost", detail)
    yield failing


def duty_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """The same with all figures."""
    data = outcome.parts[_PART]
    rows = [{"": row.name, "value": row.value, "with": row.detail} for row in cycle_figures(data)]
    yield section.Printed("Over the duty cycle", rows, cycle_words(data))
