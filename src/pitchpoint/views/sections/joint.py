"""Torsional vibration of a joint: natural frequencies, critical speeds, amplitudes against speed."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.campbell import campbell
from pitchpoint.views.inputs import input_words
from pitchpoint.views.lines import titled
from pitchpoint.views.screen import head, screen_value

__all__ = [
    "critical_rows",
    "joint_answer",
    "joint_blocks",
    "joint_facts",
    "joint_panel",
    "joint_printed",
]

_OWN = (
    "natural_frequency",
    "joint_damping_ratio",
    "reduced_inertia",
    "tangent_torsional_stiffness",
)
_CURVE = {
    "course_speed": "driver speed",
    "course_torque": "amplitude of the torque",
    "linear_torque": "by the tangent",
    "course_smallest_torque": "smallest torque",
}
_PLAY = 1e-6
"""Play that is worth a word [rad]."""

_APART = 0.1
"""Part of the axis by which marks of critical speeds stand apart."""


def joint_answer(outcome: Outcome) -> str:
    """Natural frequencies and the critical speed of the strongest wave in words."""
    data = outcome.parts["joint"]
    (held, speed), (free, free_speed) = _resonances(data)
    return (
        f"{held} on a motor that holds its speed, {free} on one that runs free; the strongest wave of the "
        f"error, {data.attrs['strongest']}, meets them at {speed} and {free_speed}"
    )


def _resonances(data: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Natural frequency and critical speed of the strongest wave, on a motor held and on one free."""
    strongest = int(np.argmax(data["wave_amplitude"].values))
    pairs = zip(data["natural_frequency"].values, data["critical_speed"].values, strict=True)
    for frequency, critical in pairs:
        shown_frequency = show.quantity("natural_frequency", float(frequency), of=data)
        yield shown_frequency, show.quantity("critical_speed", float(critical[strongest]), of=data)


def critical_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Each wave of the error with its critical speeds, and the largest amplitudes at the speeds shown."""
    data = outcome.parts["joint"]
    largest = data["torque_amplitude"].max("speed").values
    return [
        {"wave of the error": str(name)}
        | {
            head("wave_amplitude", data): screen_value(
                "wave_amplitude", float(data["wave_amplitude"][k])
            )
        }
        | {
            f"{head(variable, data)}, {motor}": screen_value(variable, float(values[m, k]), data)
            for variable, values in (
                ("critical_speed", data["critical_speed"].values),
                ("torque_amplitude", largest),
            )
            for m, motor in enumerate(("held", "free"))
        }
        for k, name in enumerate(data["excitation"].values)
    ]


def joint_panel(name: str, title: str, outcome: Outcome) -> plot.Panel:
    """Amplitudes against speed and the diagram of Campbell."""
    data = outcome.parts["joint"]
    figures = [
        _amplitudes(f"{name}_torque", data, "torque_amplitude", (0, 1)),
        _amplitudes(f"{name}_output", data, "output_amplitude", (0,)),
        _campbell(f"{name}_campbell", data),
    ]
    return plot.Panel(title, figures)


def _keys(data: xr.Dataset) -> list[plot.Key]:
    return [
        plot.Key(str(name), plot.PALETTE[k % len(plot.PALETTE)])
        for k, name in enumerate(data["excitation"].values)
    ]


def _amplitudes(name: str, data: xr.Dataset, variable: str, motors: tuple[int, ...]) -> plot.Figure:
    """Amplitude by each wave against speed, by the tangent of the wind-up."""
    speed, unit = plot.display("speed", data["speed"], data), show.unit_of(variable, data)
    values = plot.display(variable, data[variable].values, data)
    traces = [
        plot.legend_line(
            plot.Key(
                f"{key.label}, {data['motor'].values[m]}", key.colour, "dash" if m else "solid"
            ),
            speed,
            values[m, k],
            unit,
        )
        for m in motors
        for k, key in enumerate(_keys(data))
    ]
    keys = _keys(data)
    if len(motors) > 1:
        keys += [
            plot.Key("motor holds its speed", plot.GREY),
            plot.Key("motor runs free", plot.GREY, "dash"),
        ]
    held = "" if len(motors) > 1 else " Motor holds its speed."
    return plot.Figure(
        name,
        f"{titled(variable, data)} against driver speed",
        traces,
        plot.layout(
            show.axis_title("speed", data),
            plot.short_axis(variable, data),
            yaxis={"rangemode": "tozero"},
        )
        | plot.verticals(_marks(data, speed, motors)),
        f"Each wave by itself. Dotted: critical speeds.{held}",
        tuple(keys),
    )


def _marks(data: xr.Dataset, speed: np.ndarray, motors: tuple[int, ...]) -> list[tuple[str, float]]:
    """Critical speeds inside the figure that stand apart, the strongest waves first, by their order."""
    marks: list[tuple[str, float]] = []
    critical = plot.display("critical_speed", data["critical_speed"].values, data)
    for m in motors:
        for k, order in enumerate(data["wave_order"].values):
            there = float(critical[m, k])
            near = any(abs(there - mark) < _APART * np.ptp(speed) for _, mark in marks)
            if speed.min() <= there <= speed.max() and not near:
                marks.append((show.number_text(order), there))
    return marks


def _campbell(name: str, data: xr.Dataset) -> plot.Figure:
    """Frequencies of the waves over speed, with the natural frequencies."""
    levels = (
        plot.Key("natural frequency, motor holds its speed", plot.GREY),
        plot.Key("natural frequency, motor runs free", plot.GREY, "dash"),
    )
    natural = data["natural_frequency"].values
    orders = zip(_keys(data), data["wave_order"].values, strict=True)
    return campbell(
        name,
        data,
        [(key, float(order) / (2.0 * np.pi)) for key, order in orders],
        [(key, float(value)) for key, value in zip(levels, natural, strict=True)],
        2.0 * float(natural.max()),
    )


def _title(name: str, data: xr.Dataset) -> str:
    variable = show.described(name, data)
    return show.bracketed(f"{variable.long_name} {variable.symbol}", variable)


def _own_table(outcome: Outcome) -> section.SectionTable:
    data = outcome.parts["joint"]
    rows = [
        (
            _title(name, data),
            *(screen_value(name, float(value), data) for value in data[name].values),
        )
        for name in _OWN
    ]
    return section.SectionTable(
        ["", *(str(motor) for motor in data["motor"].values)], rows, compact=True
    )


def _curve_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Steady vibration by the strongest wave with the whole curve of the wind-up, and by its tangent."""
    data = outcome.parts["joint"]
    return [
        {"at the": str(name)}
        | {
            f"{label} [{show.unit_of(figure, data)}]": screen_value(
                figure, float(data[figure].values[k]), data
            )
            for figure, label in _CURVE.items()
        }
        for k, name in enumerate(data["course"].values)
    ]


def joint_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    for position, title, outcome in page.each("joint"):
        data = outcome.parts["joint"]
        if title:
            yield section.Heading(title)
        yield section.Paragraph(
            "Motor and load on both sides of the drive, with its error between them: small vibrations by the "
            "tangent of the wind-up at the operating torque. The damping ratio, "
            f"{input_words(outcome, 'dynamics', 'damping_ratio')}, is that of the free joint, "
            "assumed where the "
            "case gives none."
        )
        yield _own_table(outcome)
        rows = critical_rows(outcome)
        corner, *heads = rows[0]
        yield section.transposed_table(heads, [[*row.values()] for row in rows], corner)
        yield from section.naming(title, [joint_panel(f"joint{position}", "", outcome)])
        rows = _curve_rows(outcome)
        yield section.Paragraph(_whole(data))
        yield section.SectionTable([*rows[0]], [[*row.values()] for row in rows])
        yield section.Paragraph(f"{_friction(data)} {data.attrs['note']}", "note")


def _whole(data: xr.Dataset) -> str:
    """What the integration in time adds."""
    play = float(data["kinematic_play"])
    words = (
        f"its play of {show.quantity('kinematic_play', play, of=data)}"
        if play > _PLAY
        else "no play"
    )
    return (
        f"With the whole curve of the wind-up, {words} and both flanks, integrated in time until steady: the "
        f"strongest wave, {data.attrs['strongest']}, on a motor that holds its speed."
    )


def _friction(data: xr.Dataset) -> str:
    """What friction of the flanks adds to the damping."""
    most = float(data["flank_damping_ratio"].max())
    return (
        f"Friction of the flanks adds up to {show.number_text(most)} to the damping ratio: the "
        "drive has them "
        "sliding, and friction opposes a vibration only where that turns the sliding back. The loop of "
        "torque over wind-up is that of a drive at rest."
    )


def joint_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    if "joint" in outcome.parts:
        yield section.Printed(
            "Torsional vibration of the joint", critical_rows(outcome), f"{joint_answer(outcome)}."
        )


def joint_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Natural frequencies of the joint, for which the case gave its inertia."""
    (held, speed), (free, _) = _resonances(outcome.parts["joint"])
    detail = f"motor held, {free} motor free; critical {speed} motor held"
    yield section.KeyFigure(36.5, "Joint resonance", held, detail)
