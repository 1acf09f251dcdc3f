"""Motion with the friction of the teeth in it: one period, against speed, and from a start."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import CAMPBELL, OF_COURSE, point_by_valid_laws
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.campbell import campbell
from pitchpoint.views.lines import titled
from pitchpoint.views.point import period_of
from pitchpoint.views.screen import head, screen_value

__all__ = [
    "motion_answer",
    "motion_blocks",
    "motion_facts",
    "motion_panel",
    "motion_printed",
    "speeds_panel",
    "start_panel",
]

TURNED = "mesh cycles that the driver has turned"
NONE = "No steady motion was found."

_FIGURES = (
    "mean_efficiency",
    "quasi_static_efficiency",
    "efficiency_difference",
    "mean_input_torque",
    *OF_COURSE,
    "mesh_frequency",
    "mesh_damping",
)
_ON_SCREEN = (
    "mean_efficiency",
    "quasi_static_efficiency",
    "efficiency_difference",
    "transmission_error_rms",
    "transmission_error_range",
    "largest_mesh_force",
    "smallest_mesh_force",
)
_WORKS = (
    "work_put_in",
    "work_friction",
    "work_rolling",
    "work_damping",
    "work_mesh",
    "work_error",
)
_OF_PAIRS = ("load", "friction", "friction_force", "lambda_ratio", "pair_loss")
_AGAINST_SPEED = ("transmission_error_rms", "transmission_error_range", "largest_mesh_force")


def motion_answer(outcome: Outcome) -> str:
    """Efficiency in motion and without it, and the transmission error, in words."""
    data = outcome.parts["motion"]
    if not _found(data):
        return str(data.attrs["sentence"])
    names = ("mean_efficiency", "quasi_static_efficiency", "transmission_error_rms")
    moving, still, error = (show.quantity(name, float(data[name]), of=data) for name in names)
    return (
        f"{moving} of the teeth with vibration and friction together, {still} without vibration, "
        f"{_taken(data)}; transmission error {error} rms, {_parts(data)}"
    )


def _taken(data: xr.Dataset) -> str:
    """What vibration takes of the efficiency, to digits that say something."""
    taken = float(data["efficiency_difference"])
    return f"which is {show.points(abs(taken))} {'more' if taken >= 0.0 else 'less'}"


def _parts(data: xr.Dataset) -> str:
    """Whether teeth part, in words."""
    least = float(data["smallest_mesh_force"])
    return "the teeth stay in contact" if least > 0.0 else "the teeth part within the period"


def _found(data: xr.Dataset) -> bool:
    return int(data["vibration_status"]) == 0


# ---- one period


def motion_panel(name: str, outcome: Outcome) -> plot.Panel:
    """Courses over the period and the orders of the transmission error."""
    data = outcome.parts["motion"]
    figures = [
        _course(f"{name}_error", data, "transmission_error"),
        _speeds(f"{name}_speed", data),
        *(_pairs(f"{name}_{variable}", data, variable) for variable in _OF_PAIRS),
        _course(f"{name}_efficiency", data, "efficiency", _NOW),
        _spectrum(f"{name}_spectrum", data),
    ]
    if data.sizes.get("bearing"):
        figures += [*_bearings(name, data), _bearing_spectrum(f"{name}_bearing_spectrum", data)]
    return plot.Panel("", figures)


def _bearings(name: str, data: xr.Dataset) -> Iterator[plot.Figure]:
    """Forces on the bearings of every gear, where they yield."""
    if data.sizes.get("bearing"):
        yield _labelled(f"{name}_bearing", data, "bearing_force", "bearing")


_NOW = "Less what the contacts lose at the moment, of the mean power that is put in."


def _course(name: str, data: xr.Dataset, variable: str, note: str = "") -> plot.Figure:
    """One course over the period, or from a start."""
    values = plot.display(variable, data[variable].values, data)
    return replace(
        _lines(name, data, variable, [plot.Key("", plot.PALETTE[0])], [values]), keys=(), note=note
    )


def _pairs(name: str, data: xr.Dataset, variable: str) -> plot.Figure:
    """A quantity of every pair of teeth; gaps where a pair carries nothing."""
    carries = np.abs(data["load"].values) > 0.0
    values = plot.display(variable, np.where(carries, data[variable].values, np.nan), data)
    keys = [plot.pair_key(pair) for pair in range(data.sizes["pair"])]
    return _lines(name, data, variable, keys, values)


def _speeds(name: str, data: xr.Dataset) -> plot.Figure:
    """Speed of every body, over the nominal one within a period."""
    return _labelled(name, data, _speed_of(data), "body")


def _labelled(name: str, data: xr.Dataset, variable: str, axis: str) -> plot.Figure:
    """A quantity of everything that an axis names."""
    names = enumerate(data[axis].values)
    keys = [plot.Key(str(label), plot.PALETTE[k % len(plot.PALETTE)]) for k, label in names]
    return _lines(name, data, variable, keys, plot.display(variable, data[variable].values, data))


def _lines(
    name: str,
    data: xr.Dataset,
    variable: str,
    keys: Sequence[plot.Key],
    values: Iterable[np.ndarray],
) -> plot.Figure:
    """Lines over the time of a start, else over what the driver has turned."""
    unit = show.unit_of(variable, data)
    if "turned" in data:
        x, along = data["turned"].values, TURNED
    else:
        x, along = plot.display("time", data["time"].values, data), show.axis_title("time", data)
    traces = [
        plot.legend_line(key, *plot.continued(x, y), unit)
        for key, y in zip(keys, values, strict=True)
    ]
    axes = plot.layout(along, plot.short_axis(variable, data))
    return plot.Figure(name, titled(variable, data), traces, axes, "", tuple(keys), NONE)


def _speed_of(data: xr.Dataset) -> str:
    """Variable of the speeds of the bodies."""
    return "body_speed" if "body_speed" in data else "relative_speed"


def _spectrum(name: str, data: xr.Dataset) -> plot.Figure:
    """Amplitudes of the orders of the transmission error."""
    bars = [_orders(data, "spectrum", data["spectrum"].values, plot.Key("", plot.PALETTE[0], ""))]
    return _of_orders(name, "Orders of the transmission error", "spectrum", bars)


def _bearing_spectrum(name: str, data: xr.Dataset) -> plot.Figure:
    """Those of the forces on the bearings of every gear."""
    names = data["bearing"].values
    keys = [
        plot.Key(str(one), plot.PALETTE[k % len(plot.PALETTE)], "") for k, one in enumerate(names)
    ]
    values = data["bearing_spectrum"].values
    bars = [
        _orders(data, "bearing_spectrum", one, key) for one, key in zip(values, keys, strict=True)
    ]
    title = "Orders of the force on the bearings"
    return replace(_of_orders(name, title, "bearing_spectrum", bars), keys=tuple(keys))


def _orders(data: xr.Dataset, variable: str, values: np.ndarray, key: plot.Key) -> plot.Trace:
    """Amplitudes of the orders of the mesh frequency; that of order zero is the mean."""
    orders = data["order"].values
    shown = (orders > 0.0) & (orders <= 20.0)
    amplitudes = plot.display(variable, values[shown])
    return plot.order_bars(key, orders[shown], amplitudes, show.unit_of(variable))


def _of_orders(name: str, title: str, variable: str, bars: list[plot.Trace]) -> plot.Figure:
    axes = plot.layout(
        "order of the mesh frequency", plot.short_axis(variable), yaxis={"rangemode": "tozero"}
    )
    return plot.Figure(name, title, bars, axes, missing=NONE)


def _table(data: xr.Dataset) -> section.SectionTable:
    names = [name for name in _FIGURES if name != "largest_bearing_force" or "bearing" in data]
    rows = [
        (f"{titled(name, data)} {show.described(name, data).symbol}", _cell(data, name))
        for name in names
    ]
    return section.SectionTable(["", ""], rows, compact=True)


def _modes(data: xr.Dataset) -> section.SectionTable:
    """Natural frequencies with the mean stiffness, what yields in them, and how they are damped."""
    rows = [
        (
            str(name),
            *(show.quantity(variable, float(data[variable][k]), of=data) for variable in _OF_MODES),
        )
        for k, name in enumerate(data["mode"].values)
    ]
    return section.SectionTable(
        ["Mode: elastic energy in", *(titled(variable, data) for variable in _OF_MODES)],
        rows,
        compact=True,
    )


_OF_MODES = ("natural_frequency", "modal_damping_ratio")


def _cell(data: xr.Dataset, name: str) -> str:
    value = float(data[name])
    if name == "efficiency_difference" and np.isfinite(value):
        return show.points(value)
    return show.quantity(name, value, of=data) if np.isfinite(value) else "none"


def _works(data: xr.Dataset) -> section.SectionTable:
    """Energies of one period that are not nothing, and how well they balance."""
    rows = [(titled(name, data), _cell(data, name)) for name in _WORKS if float(data[name])]
    closure = float(data["energy_closure"])
    left = f"{closure:.0e}" if np.isfinite(closure) else "not known"
    rows.append(("What is left of their balance, of the largest", left))
    return section.SectionTable(["Energy of one period", ""], rows, compact=True)


# ---- against speed


def speeds_panel(name: str, outcome: Outcome) -> plot.Panel:
    """Figures against speed, the orders over speed, and the diagram of Campbell."""
    data = outcome.parts["motion_against_speed"]
    figures = [_against(f"{name}_{variable}", data, variable) for variable in _AGAINST_SPEED]
    figures.insert(2, _efficiencies(f"{name}_efficiency", data))
    if data["largest_bearing_force"].notnull().any():
        figures.append(_against(f"{name}_bearing", data, "largest_bearing_force"))
    return plot.Panel(
        "", [*figures, _waterfall(f"{name}_waterfall", data), _campbell(name, outcome)]
    )


def _branches(
    data: xr.Dataset, variable: str, colour: str
) -> tuple[list[plot.Trace], list[plot.Key], str]:
    """Curves for rising and falling speed with their legend; where both are the same, one and a sentence."""
    speed, unit = plot.display("speed", data["speed"].values, data), show.unit_of(variable, data)
    traces, keys = [], []
    courses = plot.display(variable, _steady(data, variable))
    alike = len(courses) > 1 and np.allclose(courses[0], courses[1], rtol=1e-6, equal_nan=True)
    looks = zip(data["direction"].values, ("solid", "dash"), strict=False)
    for (direction, dash), values in zip(looks, courses[:1] if alike else courses, strict=False):
        key = plot.Key(f"speed {direction}", colour, dash)
        dots = {"mode": "lines+markers", "marker": {"size": 4, "color": colour}}
        traces.append(plot.legend_line(key, speed, values, unit, **dots))
        keys.append(key)
    return traces, keys, "Speed rising and falling give the same." if alike else ""


def _steady(data: xr.Dataset, variable: str) -> np.ndarray:
    """Values where a motion was found that is steady."""
    return np.where(data["vibration_status"].values == 0, data[variable].values, np.nan)


def _against(name: str, data: xr.Dataset, variable: str) -> plot.Figure:
    traces, keys, note = _branches(data, variable, plot.PALETTE[0])
    axes = plot.layout(
        show.axis_title("speed", data),
        plot.short_axis(variable, data),
        yaxis={"rangemode": "tozero"},
    )
    several = tuple(keys) if len(keys) > 1 else ()
    return plot.Figure(
        name, f"{titled(variable, data)} against speed", traces, axes, note, several, NONE
    )


def _efficiencies(name: str, data: xr.Dataset) -> plot.Figure:
    """Mean efficiency in motion beside that without vibration."""
    traces, keys, remark = _branches(data, "mean_efficiency", plot.PALETTE[0])
    still = plot.Key("without vibration", plot.GREY, "dot")
    speed = plot.display("speed", data["speed"].values, data)
    values = plot.display("quasi_static_efficiency", data["quasi_static_efficiency"].values)
    traces.append(plot.legend_line(still, speed, values, "%"))
    if len(keys) == 1:
        keys = [plot.Key("in motion", plot.PALETTE[0])]
    axes = plot.layout(show.axis_title("speed", data), plot.short_axis("mean_efficiency"))
    note = f"Of the teeth, pairs sharing the load as they yield. {remark}".rstrip()
    title = "Mean efficiency against speed"
    return plot.Figure(name, title, traces, axes, note, (*keys, still), NONE)


def _waterfall(name: str, data: xr.Dataset) -> plot.Figure:
    """Amplitude of every order over speed, rising."""
    orders, unit = data["order"].values, show.unit_of("spectrum")
    shown = (orders > 0.0) & (orders <= 12.0)
    codes = data["vibration_status"].values[0]
    amplitude = np.where(codes[:, None] == 0, data["spectrum"].values[0], np.nan)[:, shown]
    heat: plot.Trace = {
        "type": "heatmap",
        "x": plot.rounded(plot.display("speed", data["speed"].values, data)),
        "y": orders[shown].tolist(),
        "z": [plot.rounded(row) for row in plot.display("spectrum", amplitude).T],
        "colorscale": plot.RISING,
        "hoverongaps": False,
        "colorbar": {"title": {"text": unit}, "thickness": 12, "outlinewidth": 0},
        "hovertemplate": f"%{{z:.4~r}} {unit}<br>%{{x:.4~r}}, order %{{y}}<extra></extra>",
    }
    axes = plot.layout(show.axis_title("speed", data), "order of the mesh frequency")
    title = "Orders of the transmission error over speed"
    return plot.Figure(name, title, [heat], axes, "Speed rising.", missing=NONE)


def _campbell(name: str, outcome: Outcome) -> plot.Figure:
    """Frequencies of the orders over speed, with the natural frequencies."""
    data, cycle = outcome.parts["motion_against_speed"], period_of(outcome).angle
    orders = [(plot.Key(str(one), plot.PALETTE[0]), one / cycle) for one in range(1, CAMPBELL + 1)]
    natural = data["natural_frequency"].values
    diagram = campbell(
        f"{name}_campbell",
        data,
        orders,
        [(plot.Key("natural frequencies", plot.GREY, "dash"), float(one)) for one in natural],
        1.15 * float(natural.max()),
        marked=True,
    )
    keys = (
        plot.Key("orders of the mesh frequency", plot.PALETTE[0]),
        plot.Key("natural frequencies", plot.GREY, "dash"),
    )
    note = "Where an order crosses a natural frequency, with the mean stiffness, lies a critical speed."
    return replace(diagram, title="Campbell's diagram", note=note, keys=keys, missing=NONE)


def _critical(data: xr.Dataset) -> Iterator[section.Block]:
    """Crossings in the diagram of Campbell between the slowest speed and the fastest."""
    natural = "natural_frequency"
    heads = [_headed(name, data) for name in (natural, "critical_speed", "half_power_width")]
    rows = [_crossing(data, k) for k in range(data.sizes["crossing"])]
    if rows:
        yield section.Paragraph(
            "Critical speeds, where an order of the mesh frequency meets a mode:"
        )
        yield section.SectionTable(["Mode: elastic energy in", "Order", *heads], rows)
    else:
        yield section.Paragraph(
            f"No order up to {CAMPBELL} meets a natural frequency at these speeds."
        )


def _headed(name: str, data: xr.Dataset) -> str:
    return f"{_HEADS.get(name) or titled(name, data)} [{show.unit_of(name, data)}]"


_HEADS = {"critical_speed": "Driver speed", "half_power_width": "Width at half power"}


def _crossing(data: xr.Dataset, number: int) -> tuple[str, ...]:
    mode = int(data["critical_mode"][number])
    values = {
        "natural_frequency": data["natural_frequency"][mode],
        **{name: data[name][number] for name in ("critical_speed", "half_power_width")},
    }
    cells = (
        show.quantity(name, float(value), with_unit=False, of=data)
        for name, value in values.items()
    )
    return str(data["mode"].values[mode]), f"{float(data['critical_order'][number]):g}", *cells


# ---- from a start


def _start_table(data: xr.Dataset) -> section.SectionTable:
    """The largest of the forces, and where a start ends."""
    names = ["largest_mesh_force", *(["largest_bearing_force"] if "bearing" in data else [])]
    rows = [(titled(name, data), _cell(data, name)) for name in names]
    rows.append(("Time at the end", show.quantity("time", float(data["time"][-1]), of=data)))
    rows += [(f"Speed of {body} at the end", speed) for body, speed in _last_speeds(data)]
    lost = ("work_put_in", "work_friction", "work_rolling", "work_damping", "kinetic_energy")
    rows += [
        (f"{titled(name, data)}, at the end", show.quantity(name, float(data[name][-1]), of=data))
        for name in lost
        if float(data[name][-1])
    ]
    return section.SectionTable(["", ""], rows, compact=True)


def start_panel(name: str, outcome: Outcome) -> plot.Panel:
    """Courses in time from a start."""
    data = outcome.parts["start_up"]
    figures = [
        _speeds(f"{name}_speed", data),
        _course(f"{name}_error", data, "transmission_error"),
        *(_pairs(f"{name}_{variable}", data, variable) for variable in ("load", "friction_force")),
    ]
    return plot.Panel("", [*figures, *_bearings(name, data)])


def _balance(data: xr.Dataset) -> str:
    """What is left of the balance of energy, as a sentence; empty where there is no motion."""
    closure = float(data["energy_closure"])
    if not np.isfinite(closure):
        return ""
    return f"Of the balance of energy {closure:.0e} of its largest part is left. "


# ---- the section


def motion_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    yield from section.blocks_by_variant(page, "motion", _of_period)
    for position, title, outcome in page.each("motion_against_speed"):
        yield section.Heading(f"Against speed: {title}" if title else "Against speed")
        data = outcome.parts["motion_against_speed"]
        yield from _gaps(data)
        yield from _critical(data)
        yield from section.naming(title, [speeds_panel(f"speeds{position}", outcome)])
    for position, title, outcome in page.each("start_up"):
        yield section.Heading(f"Start: {title}" if title else "Start")
        data = outcome.parts["start_up"]
        yield section.Paragraph(
            f"Under the torques of the case: {data.attrs['sentence']}. {_balance(data)}At rest "
            "nothing sticks; below a hundredth of the operating speed friction is that of the law at it."
        )
        if np.isfinite(data["largest_mesh_force"]):
            yield _start_table(data)
        yield from section.naming(title, [start_panel(f"start{position}", outcome)])


def _of_period(position: int, outcome: Outcome) -> Iterator[section.Block]:
    data = outcome.parts["motion"]
    held = " on bearings that yield" if data.sizes.get("bearing") else ""
    yield section.Paragraph(
        f"Both gears as bodies{held}, at the mean speed of the operating point, steady. Every contact draws "
        f"at its own force, speeds and film by the law of friction: {data.attrs['law']}. Contact: "
        f"{data.attrs['contact']}."
    )
    if not _found(data):
        yield section.Paragraph(f"No values are shown: {data.attrs['sentence']}.", "warning")
        return
    yield _table(data)
    yield section.Paragraph(
        "The efficiency counts sliding, rolling and damping while the gears vibrate; that without vibration "
        "is quasi-static, pairs sharing the load as they yield. Springs that change with the phase and "
        "errors bring in work without a torque for it, listed below: it counts as put in by the driver. The "
        "transmission error is that of the rotations: where bearings yield their deflection is in it.",
        "note",
    )
    yield _works(data)
    yield _modes(data)
    yield motion_panel(f"motion{position}", outcome)


def _gaps(data: xr.Dataset) -> Iterator[section.Block]:
    """Speeds without a steady motion, and why."""
    sentences: Sequence[str] = json.loads(data.attrs["sentences"])
    for direction, codes in zip(
        data["direction"].values, data["vibration_status"].values, strict=True
    ):
        for code in np.unique(codes[codes != 0]):
            count = np.count_nonzero(codes == code)
            yield section.Paragraph(
                f"Speed {direction}: {count} of {codes.size} speeds are left out, {sentences[int(code)]}.",
                "warning",
            )


def motion_printed(outcome: Outcome) -> Iterator[section.Printed]:
    """What the screen shows."""
    data = outcome.parts.get("motion")
    if data is None:
        return
    if not _found(data):
        yield section.Printed(
            "Motion with friction", line=f"No values are shown: {motion_answer(outcome)}."
        )
        return
    row = {head(name, data): screen_value(name, float(data[name]), data) for name in _ON_SCREEN}
    sentence = f"{motion_answer(outcome)}; natural frequencies {_frequencies(data)}."
    yield section.Printed("Motion with friction", [row], sentence)
    if "start_up" in outcome.parts:
        yield section.Printed(line=f"{_end_of_start(outcome.parts['start_up'])}.")


def _end_of_start(data: xr.Dataset) -> str:
    """Speeds at the end of a start, in words."""
    if not np.isfinite(data["largest_mesh_force"]):
        return f"Start: no values are shown: {data.attrs['sentence']}"
    speeds = ", ".join(f"{body} {speed}" for body, speed in _last_speeds(data))
    force = show.quantity("largest_mesh_force", float(data["largest_mesh_force"]), of=data)
    after = show.quantity("time", float(data["time"][-1]), of=data)
    return f"Start, after {after}: {speeds}; largest normal force {force}"


def _last_speeds(data: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Every body, and its speed at the end of a start."""
    name = _speed_of(data)
    for body, value in zip(data["body"].values, data[name].values[:, -1], strict=True):
        yield str(body), show.quantity(name, float(value), of=data)


def _frequencies(data: xr.Dataset) -> str:
    values = ", ".join(
        show.number_text(float(frequency))
        for frequency in plot.display("natural_frequency", data["natural_frequency"].values, data)
    )
    return f"{values} {show.unit_of('natural_frequency', data)}"


def motion_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Efficiency and transmission error in motion, with its law where the efficiency is by another one."""
    figure = section.key_figure(34.0, "In motion", motion_answer(outcome), " of the teeth with")
    law, parts = str(outcome.parts["motion"].attrs["law"]), outcome.parts
    stands_by = (
        plot.law_title(outcome, plot.laws(point_by_valid_laws(parts))[0])
        if "operation" in parts
        else law
    )
    yield figure if stands_by == law else replace(figure, detail=f"by {law}; {figure.detail}")
