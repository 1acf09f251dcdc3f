"""The first screen of a duty cycle."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.views import show
from pitchpoint.views.first_screen import Line, aligned
from pitchpoint.views.section import KeyFigure

__all__ = ["FIRST", "cycle_figures", "cycle_words", "duty_screen", "first_to_fail", "lost_words"]

FIRST = "Fails first"
"""Name of the line on the part with the shortest life."""


def duty_screen(data: xr.Dataset, width: int) -> list[Line]:
    """What the cycle takes, loses and asks of the driver, in a dozen lines.

    Args:
        data: see `duty_dataset`.
        width: of the screen [characters].
    """
    title = f"{data.attrs['case']} ({data.attrs['variant']}), friction {data.attrs['law']}"
    return [
        Line(f"{title}{_among(data)}", "title"),
        Line(show.first_clauses(cycle_words(data), width)),
        *aligned([*cycle_figures(data)], width),
    ]


def cycle_words(data: xr.Dataset) -> str:
    """Length, samples and temperatures of a duty cycle in words.

    Args:
        data: see `duty_dataset`.
    """
    low, high = (float(end(data["temperature"])) for end in (xr.DataArray.min, xr.DataArray.max))
    degrees = show.span("temperature", "temperature", (low, high), data)
    return f"duty cycle of {_value(data, 'duration')}, {data.sizes['time']} samples, oil {degrees}"


def cycle_figures(data: xr.Dataset) -> Iterator[KeyFigure]:
    """What the cycle takes, loses and asks of the driver, with what fails first at the end.

    Args:
        data: see `duty_dataset`.
    """

    def of(name: str) -> str:
        return _value(data, name)

    quadrants = dict(
        zip(data["quadrant"].values.tolist(), data["quadrant_time"].values, strict=True)
    )
    total = float(data["duration"])
    rows = (
        (
            "Energy in",
            "input_energy",
            f"{of('recovered_energy')} comes back to the driver; efficiency {of('drive_efficiency')}",
        ),
        ("Energy out", "output_energy", f"{of('returned_energy')} comes back from the load"),
        ("Energy lost", "lost_energy", f"{_spread(data)}{of('mean_loss')} in the mean"),
        *_electrical(data),
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
        f"{words} {show.number_text(100.0 * seconds / total, 3)} %"
        for words, seconds in (
            ("driven", quadrants["I"] + quadrants["III"]),
            ("back-driven", quadrants["II"] + quadrants["IV"]),
            ("at rest", quadrants["rest"]),
        )
    ]
    yield KeyFigure(len(rows), "Time", _value(data, "duration"), ", ".join(shares))
    yield first_to_fail(data, len(rows) + 1)


def _among(data: xr.Dataset) -> str:
    """How many laws there are beside the one that nobody chose."""
    return f", first of {data.sizes['law']} laws" if "law" in data.dims else ""


def lost_words(data: xr.Dataset) -> str:
    """Energy that is lost, from the least to the most of all laws where none was chosen.

    Args:
        data: see `duty_dataset`.
    """
    if "law" not in data.dims:
        return _value(data, "lost_energy")
    values = data["law_lost_energy"].values
    return show.span("lost_energy", "lost_energy", (np.nanmin(values), np.nanmax(values)), data)


def _spread(data: xr.Dataset) -> str:
    """Energies that are lost under all laws; empty where one was chosen."""
    if "law" not in data.dims:
        return ""
    stuck = int(np.isnan(data["law_lost_energy"].values).sum())
    return f"{lost_words(data)} by law{f', {stuck} without an answer' * bool(stuck)}; "


def _electrical(data: xr.Dataset) -> Iterator[tuple[str, str, str]]:
    """What the motor takes, where there is one."""
    if data.attrs["motor"]:
        back, share, most = (
            _value(data, name)
            for name in (
                "electrical_recovered_energy",
                "actuator_efficiency",
                "peak_electrical_power",
            )
        )
        detail = f"{back} given back, efficiency {share}, {most} at most"
        yield "Electrical energy", "electrical_energy", detail


def first_to_fail(data: xr.Dataset, order: float) -> KeyFigure:
    """Which part of a drive fails first over its duty cycle, and after how long.

    Args:
        data: see `duty_dataset`.
        order: of the line.
    """
    count, life = int(data.attrs["parts_compared"]), float(data["shortest_life"])
    without = f"not compared: {data.attrs['left_out']}"
    if not count:
        return KeyFigure(order, FIRST, "not known", without)
    if np.isinf(life):
        return KeyFigure(order, FIRST, "none", f"all of {count} endure; {without}")
    after = show.quantity("shortest_life", life) if life > 0.0 else "at once"
    part = str(data.attrs["first_to_fail"])
    return KeyFigure(order, FIRST, part, f"{after}, of {count}; {without}")


def _value(data: xr.Dataset, name: str) -> str:
    return show.quantity(name, float(data[name]), of=data)
