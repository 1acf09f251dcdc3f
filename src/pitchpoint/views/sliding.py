"""Specific sliding of both gears along the path of contact."""

import numpy as np

from pitchpoint.runs.run import Outcome
from pitchpoint.views.cycle import PLACE, marks
from pitchpoint.views.facts import facts
from pitchpoint.views.figures import PALETTE, Figure, Key, layout, plain
from pitchpoint.views.geometry import specific_sliding

__all__ = ["sliding_figure"]

_LOWEST = -8.0
"""Below, the figure would show nothing else: at the base circle it is infinite."""


def sliding_figure(name: str, outcome: Outcome) -> Figure:
    """Sliding speed over own rolling speed of each gear on the way from A to E.

    Args:
        name: of the figure in the page.
        outcome: a result whose teeth are there.
    """
    teeth, fact = outcome.parts["teeth"], facts(outcome)
    place = np.linspace(0.0, fact.transverse_ratio, 121)
    start, pitch = float(teeth["points"].values[0]), float(teeth["base_pitch"])
    values = specific_sliding(teeth, start + place * pitch)
    keys = (Key("gear 1", PALETTE[0]), Key("gear 2", PALETTE[1], "dash"))
    end = fact.transverse_ratio
    lowest = float(np.nanmin(values))
    cut = {"range": [_LOWEST, 1.5]} if lowest < _LOWEST else {}
    note = "Sliding speed over the flank's own rolling speed; zero at C, negative below the pitch circle."
    return Figure(
        name,
        "Specific sliding along the path of contact",
        [plain(key, place, course, "") for key, course in zip(keys, values.T, strict=True)],
        layout(PLACE, "ζ", xaxis={"range": [-0.02 * end, 1.02 * end]}, yaxis=cut, **marks(fact)),
        note + (f" The lowest value is {lowest:.3g}." if cut else ""),
        keys,
    )
