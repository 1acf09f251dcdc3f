"""Specific sliding of both gears along the path of contact."""

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import PALETTE, Figure, Key, layout, legend_line
from pitchpoint.views.path import contact_path, path_marks
from pitchpoint.views.point import named_members

__all__ = ["sliding_figure", "specific_sliding"]

_LOWEST = -8.0
"""Below, the figure would show nothing else: at the base circle it is infinite."""


def sliding_figure(name: str, outcome: Outcome) -> Figure:
    """Sliding speed over own rolling speed of each gear on the way from A to E.

    Args:
        name: of the figure in the page.
        outcome: a result whose teeth are there.
    """
    teeth, path = outcome.parts["teeth"], contact_path(outcome)
    place = np.linspace(0.0, path.transverse_ratio, 121)
    start, pitch = float(teeth["points"].values[0]), float(teeth["base_pitch"])
    values = specific_sliding(teeth, start + place * pitch)
    gear_1, gear_2 = named_members(outcome)
    keys = (Key(gear_1, PALETTE[0]), Key(gear_2, PALETTE[1], "dash"))
    end = path.transverse_ratio
    lowest = float(np.nanmin(values))
    cut = {"range": [_LOWEST, 1.5]} if lowest < _LOWEST else {}
    note = "Sliding speed over the flank's own rolling speed; zero at C, negative below the pitch circle."
    return Figure(
        name,
        "Specific sliding along the path of contact",
        [legend_line(key, place, course, "") for key, course in zip(keys, values.T, strict=True)],
        layout(
            path.axis,
            "ζ",
            xaxis={"range": [-0.02 * end, 1.02 * end]},
            yaxis=cut,
            **path_marks(path),
        ),
        note + (f" The lowest value is {show.number_text(lowest)}." if cut else ""),
        keys,
    )


def specific_sliding(teeth: xr.Dataset, position: np.ndarray) -> np.ndarray:
    """Sliding speed over own rolling speed of each gear (ISO 21771), [position, gear].

    Args:
        teeth: part `teeth` of a result.
        position: on the line of action, from N1 [m].
    """
    constant, slope = teeth["rolling"].values.T
    rolling = constant + slope * np.asarray(position)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(1.0 - rolling[..., ::-1] / rolling)
