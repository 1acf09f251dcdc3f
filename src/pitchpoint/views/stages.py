"""Stages of a drive: what each loses, and how far it lets the output turn."""

import numpy as np
import xarray as xr

from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import (
    DASHES,
    PALETTE,
    Figure,
    Key,
    display,
    layout,
    plain,
    short_axis,
)

__all__ = ["has_stages", "stage_answer", "stage_wind_up"]


def has_stages(outcome: Outcome) -> bool:
    """True for a drive of several meshes."""
    return "stage_loss" in outcome.parts.get("operation", ())


def stage_answer(outcome: Outcome, law: int) -> list[tuple[str, str]]:
    """What each stage loses at the operating point, names and words; nothing of one mesh."""
    if not has_stages(outcome):
        return []
    data = outcome.parts["operation"]
    names = ("stage_loss", "stage_efficiency", "stage_input_torque", "stage_speed")
    found = []
    for at, stage in enumerate(data["stage"].values):
        loss, efficiency, torque, speed = (
            show.quantity(name, float(data[name].values[law, 0, at])) for name in names
        )
        found.append(
            (f"stage {stage}", f"{loss} lost, {efficiency}, driven by {torque} at {speed}")
        )
    return found


def stage_wind_up(name: str, data: xr.Dataset) -> list[Figure]:
    """Wind-up at the output by each stage against torque; nothing of one mesh."""
    if "stage_wind_up" not in data:
        return []
    variable = "stage_wind_up"
    unit = show.unit(VARIABLES[variable].display)
    keys = tuple(
        Key(f"stage {stage}", PALETTE[at % len(PALETTE)], DASHES[at % len(DASHES)])
        for at, stage in enumerate(data["stage"].values)
    )
    torque, turned = (
        display("torque", data["torque"]),
        np.asarray(display(variable, data[variable])),
    )
    return [
        Figure(
            name,
            "Wind-up at the output by stage",
            [plain(key, torque, turned[:, at], unit) for at, key in enumerate(keys)],
            layout(
                "torque T [N\u00a0m]",
                short_axis(variable),
                xaxis={"rangemode": "tozero"},
                yaxis={"rangemode": "tozero"},
            ),
            "Stages are springs one behind the other: the wind-up of the drive is their sum.",
            keys,
        )
    ]
