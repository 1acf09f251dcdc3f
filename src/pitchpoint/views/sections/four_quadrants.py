"""Loss, efficiency and torque of the driver over torque and speed of the output with their signs."""

from collections.abc import Iterator

import numpy as np

from pitchpoint.analyses.figures import covered
from pitchpoint.views import show
from pitchpoint.views.section import Block, Page, Paragraph, Section
from pitchpoint.views.sections.loss_map import Chart, map_panel

__all__ = ["FOUR_QUADRANTS"]

OF_OUTPUT = Chart(
    "four_quadrants",
    "Loss map of the output",
    ("output_speed", "output_torque"),
    ("mean_input_torque", "mean_efficiency", "mean_loss"),
    "quadrants",
)


def _blocks(page: Page) -> Iterator[Block]:
    there = page.having(OF_OUTPUT.part)
    data = next(iter(there.values())).parts[OF_OUTPUT.part]
    load, driving = (
        show.described(name, data).long_name for name in ("output_torque", "mean_input_torque")
    )
    yield Paragraph(
        f"Where {load} and speed have one sign the driver drives, where they differ the load does. The "
        f"{driving} is positive where it acts along a positive speed of the output. Cells are blank at rest, "
        "where no power comes out, and where friction locks the drive against its output."
    )
    yield Paragraph(str(data.attrs["note"]), "note")
    if any(bool(np.any(one.parts[OF_OUTPUT.part]["locked"].values)) for one in there.values()):
        told = (
            "Friction locks the drive against its output at some of these points, see the warnings."
        )
        yield Paragraph(told, "note")
    if alone := covered(one.parts for one in there.values()):
        yield Paragraph(alone, "note")
    yield map_panel(there, page.curves, OF_OUTPUT)


FOUR_QUADRANTS = Section(
    name="quadrants",
    title="Loss map of the output",
    short="Four quadrants",
    order=710.0,
    parts=("four_quadrants",),
    blocks=_blocks,
)
