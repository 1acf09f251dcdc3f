"""Loss and torque of the driver over torque and speed of the output, and loads held at rest."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import (
    HOLDING,
    HOLDING_BANDS,
    coverage_sentences,
    error_words,
    held_at_operation,
)
from pitchpoint.core.doubts import in_percent
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.figures import laws
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.sections.beside import starts_doubtfully
from pitchpoint.views.sections.loss_map import Chart, map_blocks, map_panel

__all__ = ["OF_OUTPUT", "quadrants_blocks", "quadrants_facts", "quadrants_printed"]

OF_OUTPUT = Chart(
    "four_quadrants",
    "Loss map of the output",
    ("output_speed", "output_torque"),
    ("mean_input_torque", "mean_efficiency", "mean_loss"),
    "quadrants",
)


HELD = f"{OF_OUTPUT.part}.{HOLDING[0]}"
"""The map as it is now; results of before lack the torques that hold a load."""


def quadrants_blocks(page: section.Page) -> Iterator[section.Block]:
    """Paragraphs, tables and panels of the map."""
    there = page.having(HELD)
    data = next(iter(there.values())).parts[OF_OUTPUT.part]
    load, driving = (
        show.described(name, data).long_name for name in ("output_torque", "mean_input_torque")
    )
    yield section.Paragraph(
        f"Where {load} and speed have one sign the driver drives, where they differ the load does. The "
        f"{driving} is positive where it acts along a positive speed of the output. The "
        "efficiency is blank from rest and from no load, where no power comes out, to the nodes beside "
        "them; everything is where friction locks the drive against its output."
    )
    yield section.Paragraph(str(data.attrs["note"]), "note")
    for sentence in dict.fromkeys(_errors(design) for design in there.values()):
        yield section.Paragraph(sentence, "note")
    if any(
        bool(np.any(design.parts[OF_OUTPUT.part]["locked"].values)) for design in there.values()
    ):
        sentence = (
            "Friction locks the drive against its output at some of these points, see the warnings."
        )
        yield section.Paragraph(sentence, "note")
    if alone := coverage_sentences([design.parts for design in there.values()]):
        yield section.Paragraph(alone, "note")
    yield from map_blocks(map_panel(there, page.curves, OF_OUTPUT))
    yield section.Heading("Held at rest")
    banded = any(
        HOLDING_BANDS[HOLDING[0]][0] in design.parts[OF_OUTPUT.part] for design in there.values()
    )
    yield section.Paragraph(f"{AT_REST} {IN_BRACKETS}" if banded else AT_REST)
    yield from section.blocks_by_variant(page, HELD, lambda _, outcome: _held(outcome))


AT_REST = (
    "At rest the torque of the driver may have any value of a band: below it the load moves back, above it "
    "the load moves on. The band holds in the mean over the phases of the teeth; beyond the torques of the "
    "last columns the load moves at every phase. Friction of the teeth is that of a creeping drive, "
    "with what holds bearings and seals at rest. Where zero lies in the band the load is held without "
    "the driver."
)
IN_BRACKETS = "In brackets: how far both ends may be off by breakaway_spread of [losses]."


def _errors(outcome: Outcome) -> str:
    data = outcome.parts[OF_OUTPUT.part]

    def in_units(name: str, value: float) -> str:
        return show.quantity(name, value, of=data)

    by_law = "; ".join(error_words(data, law, in_units) for law in range(data.sizes["law"]))
    return f"Error of the loss in the map against direct computation: {by_law}."


def _rows(outcome: Outcome) -> list[dict[str, str]]:
    """Torques that hold each load from zero on, by law, at the temperature next to that of operation."""
    data = outcome.parts[OF_OUTPUT.part]
    there = _nearest_of(data)
    there = there.isel(output_torque=there["output_torque"].values >= 0.0)
    return [
        {
            "friction law": law,
            head("output_torque", data): screen_value("output_torque", float(load), data),
        }
        | {head(n, data): _word(there, n, (k, place)) for n in HOLDING}
        for k, law in enumerate(laws(data))
        for place, load in enumerate(there["output_torque"].values)
    ]


def _nearest_of(data: xr.Dataset) -> xr.Dataset:
    """The map at its temperature next to that of operation."""
    return data.sel(temperature=data.attrs["degree"], method="nearest")


def _degree(outcome: Outcome) -> str:
    there = _nearest_of(outcome.parts[OF_OUTPUT.part])
    return show.quantity("temperature", float(there["temperature"]), of=there)


def _word(data: xr.Dataset, name: str, at: tuple[int, int]) -> str:
    """A torque, with the ends of its band where it has one."""
    names = [name, *(end for end in HOLDING_BANDS.get(name, ()) if end in data)]
    values_of = [float(data[n].transpose("law", "output_torque", ...).values[at]) for n in names]
    value, *ends = (
        screen_value(name, end, data) if np.isfinite(end) else "locked" for end in values_of
    )
    return f"{value} ({' to '.join(ends)})" if ends else value


def _held(outcome: Outcome) -> Iterator[section.Block]:
    rows = _rows(outcome)
    caption = f"Torques that hold a load at {_degree(outcome)}"
    yield section.SectionTable([*rows[0]], [[*row.values()] for row in rows], caption=caption)


def quadrants_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What holds the drive at rest, for the screen."""
    if HOLDING[0] in outcome.parts.get(OF_OUTPUT.part, ()):
        yield section.Printed(
            f"Held at rest at {_degree(outcome)}", _rows(outcome), _errors(outcome)
        )


def quadrants_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Torque that holds the load of operation at rest, under the first law."""
    if HOLDING[0] not in outcome.parts.get(OF_OUTPUT.part, ()):
        return
    data = outcome.parts[OF_OUTPUT.part]
    held = next(iter(held_at_operation(data).values()))
    ends = [held[name] for name in HOLDING[:2]]
    load = show.quantity("output_torque", data.attrs["load"], of=data)
    if held["self_locking"]:
        words, detail = "none", f"self-locking: friction holds {load} without the driver"
    elif None in ends:
        words, detail = "not known", f"{load} lies beyond the map, or friction jams the teeth"
    else:
        low = screen_value(HOLDING[0], ends[0], data)
        words = f"{low} to {show.quantity(HOLDING[1], ends[1], of=data)}"
        alone = f"for {load} at rest; {_without(ends[0])}"
        band = _of_band(held, data, load)
        detail = band or (f"{_TOO_NARROW}; {alone}" if _doubted(outcome) else alone)
    yield section.KeyFigure(36.0, "Holding torque", words, detail)


_TOO_NARROW = "too narrow: no breakaway given"
"""Beside torques that hold a load of which nothing says what holds the drive at rest."""


def _doubted(outcome: Outcome) -> bool:
    """True where torques from rest are doubtful: nothing but friction of teeth and bearings holds there."""
    running = outcome.parts.get("running")
    return running is not None and starts_doubtfully(running)


def _without(least: float) -> str:
    return "held without the driver" if least <= 0.0 else "less lets it go, more lifts it"


def _of_band(held: dict[str, Any], data: xr.Dataset, load: str) -> str:
    """The narrowest and the widest band by the spread of what holds at rest; empty without any."""
    (widest, least), (largest, most) = HOLDING_BANDS.values()
    if any(held.get(end) is None for end in (widest, least, largest, most)):
        return ""
    narrow, wide = (
        " to ".join(screen_value(HOLDING[0], held[end], data) for end in ends)
        for ends in ((least, largest), (widest, most))
    )
    return (
        f"ends ±{in_percent(_apart(held))} of the larger; at least {narrow} for {load}; "
        f"{_without(held[least])}; at most {wide} by breakaway_spread"
    )


def _apart(held: dict[str, Any]) -> float:
    """How far the spread moves the torques that hold, over the larger of them."""
    moved = (abs(held[end] - held[name]) for name, ends in HOLDING_BANDS.items() for end in ends)
    return float(max(moved) / max(abs(held[name]) for name in HOLDING_BANDS))
