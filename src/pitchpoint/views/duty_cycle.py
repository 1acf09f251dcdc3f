"""The first screen of a duty cycle."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.views import show
from pitchpoint.views.first_screen import Line, aligned
from pitchpoint.views.section import KeyFigure

__all__ = ["duty_screen"]


def duty_screen(data: xr.Dataset, width: int) -> list[Line]:
    """What the cycle takes, loses and asks of the driver, in a dozen lines.

    Args:
        data: see `duty_dataset`.
        width: of the screen [characters].
    """
    count = data.sizes["time"]
    title = f"{data.attrs['case']} ({data.attrs['variant']}), friction {data.attrs['law']}"
    low, high = (float(end(data["temperature"])) for end in (xr.DataArray.min, xr.DataArray.max))
    degrees = show.span("temperature", "temperature", (low, high), data)
    cycle = f"duty cycle of {_value(data, 'duration')}, {count} samples, oil {degrees}"
    return [
        Line(title, "title"),
        Line(show.first_clauses(cycle, width)),
        *aligned([*_figures(data)], width),
    ]


def _figures(data: xr.Dataset) -> Iterator[KeyFigure]:
    def of(name: str) -> str:
        return _value(data, name)

    quadrants = dict(
        zip(data["quadrant"].values.tolist(), data["quadrant_time"].values, strict=True)
    )
    total = float(data["duration"])
    rows = (
        ("Energy in", "input_energy", f"{of('recovered_energy')} comes back to the driver"),
        ("Energy out", "output_energy", f"{of('returned_energy')} comes back from the load"),
        ("Energy lost", "lost_energy", f"{of('mean_loss')} in the mean"),
        (
            "Output torque",
            "rms_output_torque",
            f"rms over time, largest {of('peak_output_torque')}",
        ),
        ("Output speed", "mean_output_speed", f"in the mean, largest {of('peak_output_speed')}"),
        ("Input torque", "rms_input_torque", f"rms over time, largest {of('peak_input_torque')}"),
        ("Input power", "peak_input_power", "largest, either way"),
        (
            "Bearing torque",
            "mean_torque_of_balls",
            f"mean over turns, of rollers {of('mean_torque_of_rollers')}",
        ),
    )
    for order, (name, variable, detail) in enumerate(rows):
        yield KeyFigure(order, name, of(variable), detail)
    shares = [
        f"{words} {show.number(100.0 * seconds / total, 3)} %"
        for words, seconds in (
            ("driven", quadrants["I"] + quadrants["III"]),
            ("back-driven", quadrants["II"] + quadrants["IV"]),
            ("at rest", quadrants["rest"]),
        )
    ]
    if "root_life" in data:
        yield _of_teeth(data)
    yield KeyFigure(len(rows), "Time", _value(data, "duration"), ", ".join(shares))


def _of_teeth(data: xr.Dataset) -> KeyFigure:
    """Least life of teeth and whose it is; a word where all endure."""
    parts = {"flank": "flank_life", "back flank": "back_flank_life", "root": "root_life"}
    lives = {
        (words, *place): float(data[name].values[at])
        for words, name in parts.items()
        for at, place in _places(data)
        if not np.isnan(data[name].values[at])
    }
    if not lives:
        return KeyFigure(
            90, "Life of teeth", "not known", "ISO 6336 has no lines of these materials"
        )
    (part, mesh, gear), least = min(lives.items(), key=lambda item: item[1])
    if np.isinf(least):
        return KeyFigure(
            90, "Life of teeth", "no end", "all teeth endure the cycle (ISO 6336, Miner)"
        )
    of = f", mesh {mesh}" if data.sizes["mesh"] > 1 else ""
    value = show.quantity("root_life", least)
    return KeyFigure(90, "Life of teeth", value, f"{part} of {gear}{of} first (ISO 6336, Miner)")


def _places(data: xr.Dataset) -> Iterator[tuple[tuple[int, int], tuple[str, str]]]:
    """Indices of meshes and gears with their labels."""
    meshes, gears = (data[name].values.tolist() for name in ("mesh", "gear"))
    for row, mesh in enumerate(meshes):
        for column, gear in enumerate(gears):
            yield (row, column), (mesh, gear)


def _value(data: xr.Dataset, name: str) -> str:
    return show.quantity(name, float(data[name]), of=data)
