"""Losses beside the teeth: how the loss is split, and the torque that a drive takes without load."""

from collections.abc import Iterator, Mapping
from functools import reduce
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.running import TORQUES
from pitchpoint.core.doubts import doubts_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views import section, show
from pitchpoint.views.figures import (
    DASHES,
    INK,
    PALETTE,
    Curve,
    Curves,
    Figure,
    Key,
    Panel,
    Trace,
    display,
    laws,
    layout,
    level,
    line,
    plotly_text,
    rounded,
    short_axis,
)
from pitchpoint.views.lines import titled
from pitchpoint.views.point import operating_point
from pitchpoint.views.screen import head, screen_value

__all__ = [
    "BESIDE",
    "drag_panel",
    "in_smaller_unit",
    "loss_split",
    "running_rows",
    "starting_answer",
    "starts_doubtfully",
]

_TEETH = Key("in the teeth", PALETTE[5], "")
_BESIDE = Key("beside the teeth", "#9aa5ad", "")


def drag_panel(outcomes: Mapping[str, Outcome], known: Curves) -> Panel:
    """Split of the loss, torque without load, torques that start the drive; empty without such losses."""
    split = [losses for losses in _split(outcomes, known) if losses[2] > 0.0]
    seen = list(_running(outcomes, known))
    figures = [_shares(list(_split(outcomes, known)))] if split else []
    if seen:
        if any(data.sizes["speed"] > 1 for _, data, *_ in seen):
            figures.append(_no_load("speed", "temperature", seen))
        if any(data.sizes["temperature"] > 1 for _, data, *_ in seen):
            figures += [_no_load("temperature", "speed", seen), _starting("starting_torque", seen)]
            figures.append(_starting("back_driving_torque", seen))
    curves = [curve for curve, *_ in seen]
    return Panel("Losses beside the teeth", figures, curves)


def starting_answer(outcome: Outcome, law: str) -> list[tuple[str, str]]:
    """Torque without load and torques that start the drive at the operating point, names and words."""
    data = outcome.parts.get("running")
    if data is None or law not in laws(data):
        return []
    at = operating_point(outcome)
    of_law = data.isel(law=laws(data).index(law))
    # The operating point is on both axes; where it is read from words it is so up to rounding.
    there = of_law.sel(speed=at.speed, temperature=at.temperature, method="nearest")
    return [
        (words.format(_load(data, name)), _with_band(data, name, there))
        for words, name in (
            (f"{{}} without load at {level('speed', at.speed, data)}", "no_load_torque"),
            ("starting {}", "starting_torque"),
            ("back-driving {}", "back_driving_torque"),
        )
    ]


def _with_band(data: xr.Dataset, name: str, there: xr.Dataset) -> str:
    """A torque, with the ends of its band where it has one."""
    value, ends = _held(data, name, float(there[name])), _ends(data, name)
    if not ends:
        return value
    low, high = (float(there[variable]) for variable in ends)
    least = screen_value(ends[0], low, data) if np.isfinite(low) else "friction holds the drive"
    return f"{value}, {least} to {_held(data, ends[1], high)} by breakaway_spread"


def _ends(data: xr.Dataset, name: str) -> list[str]:
    """Names of the ends of the band of a torque from rest; none without a spread."""
    ends = [f"{end}_{name}" for end in ("least", "largest")]
    return ends if all(variable in data for variable in ends) else []


def _load(data: xr.Dataset, name: str) -> str:
    """What moves a member, as a word."""
    return "force" if show.described(name, data).unit == "N" else "torque"


def _held(data: xr.Dataset, name: str, value: float) -> str:
    return show.quantity(name, value, of=data) if np.isfinite(value) else "friction holds the drive"


def running_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Torque without load at the operating speed and torques from rest, by temperature and law."""
    data = outcome.parts.get("running")
    if data is None:
        return []
    speed = operating_point(outcome).speed
    there = data.sel(speed=speed, method="nearest")
    heads = {name: head(name, data) for name in TORQUES}
    name = show.described("no_load_torque", data).long_name
    at = f"{name} at {screen_value('speed', speed, data)} {show.unit_of('speed', data)}"
    heads["no_load_torque"] = heads["no_load_torque"].replace(name, at, 1)
    return [
        {"friction law": law, head("temperature"): screen_value("temperature", float(degree))}
        | {heads[n]: _screened(data, n, there.isel(law=k, temperature=place)) for n in TORQUES}
        for k, law in enumerate(laws(data))
        for place, degree in enumerate(data["temperature"].values)
    ]


def _screened(data: xr.Dataset, name: str, there: xr.Dataset) -> str:
    """A torque, with the ends of its band where it has one."""
    each = [float(there[one]) for one in (name, *_ends(data, name))]
    value, *ends = (screen_value(name, one, data) if np.isfinite(one) else "held" for one in each)
    return f"{value} ({' to '.join(ends)})" if ends else value


def loss_split(data: xr.Dataset, law: int) -> tuple[float, float] | None:
    """Loss in the teeth and beside them [W]."""
    if "mean_drag_loss" not in data:
        return None
    beside = float(data["mean_drag_loss"].values[law, 0])
    total = float(data["mean_loss"].values[law, 0])
    return (total - beside, beside) if np.isfinite(total) else None


def _split(outcomes: Mapping[str, Outcome], known: Curves) -> Iterator[tuple[Curve, float, float]]:
    for variant, outcome in outcomes.items():
        if "operation" not in outcome.parts:
            continue
        data = outcome.parts["operation"]
        for position, law in enumerate(laws(data)):
            losses = loss_split(data, position)
            if losses is not None:
                yield known[variant, law], *losses


def _running(
    outcomes: Mapping[str, Outcome], known: Curves
) -> Iterator[tuple[Curve, xr.Dataset, int, Outcome]]:
    for variant, outcome in outcomes.items():
        if "running" not in outcome.parts:
            continue
        data = outcome.parts["running"]
        for position, law in enumerate(laws(data)):
            yield known[variant, law], data, position, outcome


def _shares(split: list[tuple[Curve, float, float]]) -> Figure:
    places, unit = list(range(len(split))), show.unit_of("mean_loss")
    traces = [
        {
            "type": "bar",
            "orientation": "h",
            "y": places,
            "x": rounded(display("mean_loss", [losses[part] for losses in split])),
            "marker": {"color": key.colour},
            "width": 0.4,
            "hovertemplate": f"%{{x:.4~r}} {unit} {key.label}<extra></extra>",
        }
        for part, key in ((1, _TEETH), (2, _BESIDE))
    ]
    names = [
        {"text": plotly_text(curve.label).replace(" + ", "<br>+ "), "x": 0, "xanchor": "left"}
        | {"y": place - 0.22, "yanchor": "bottom", "showarrow": False, "align": "left"}
        for place, (curve, *_) in zip(places, split, strict=True)
    ]
    return Figure(
        "loss_split",
        "Power loss in the teeth and beside them",
        traces,
        layout(
            f"mean power loss P_loss [{unit}]",
            "",
            barmode="stack",
            xaxis={"rangemode": "tozero", "nticks": 6},
            yaxis={"range": [len(split) - 0.6, -0.7], "showticklabels": False, "ticks": ""}
            | {"showgrid": False},
            annotations=names,
        ),
        "At the operating point; beside the teeth: bearings, seals and churning, as the case gives them.",
        (_TEETH, _BESIDE),
    )


def _no_load(axis: str, other: str, seen: list[tuple[Curve, xr.Dataset, int, Outcome]]) -> Figure:
    values = _chosen([data[other].values for _, data, *_ in seen])
    like = seen[0][1]
    traces = [
        _dashed(curve, data.isel(law=law).sel({other: value}), axis, "no_load_torque", dash)
        for curve, data, law, _ in seen
        for dash, value in zip(DASHES, values, strict=False)
        if value in data[other].values
    ]
    return Figure(
        f"no_load_{axis}",
        f"{titled('no_load_torque', like)} against {axis}",
        traces,
        _look(like, axis, "no_load_torque"),
        keys=tuple(
            Key(level(other, value, like), INK, dash)
            for dash, value in zip(DASHES, values, strict=False)
        ),
        missing="Friction holds the drive whatever the torque.",
    )


def _starting(name: str, seen: list[tuple[Curve, xr.Dataset, int, Outcome]]) -> Figure:
    like = seen[0][1]
    traces = [
        _dashed(curve, data.isel(law=law), "temperature", name, curve.dash)
        for curve, data, law, _ in seen
    ]
    look = _look(like, "temperature", name)
    in_smaller_unit(traces, look, show.described(name, like).display)
    return Figure(
        f"running_{name}",
        titled(name, like),
        traces,
        look,
        "From rest, without load, at the worst phase of the mesh.",
        missing="Friction holds the drive whatever the torque.",
    )


def in_smaller_unit(traces: list[Trace], look: dict[str, Any], display: str) -> None:
    """Turns curves and their axis to a smaller unit where all values would need a power of ten."""
    top = max((abs(v) for trace in traces for v in trace["y"] if v is not None), default=0.0)
    (shown,), smaller_unit = show.handy([top], display)
    if smaller_unit == display:
        return
    usual, smaller = show.display_unit(display), show.display_unit(smaller_unit)
    for trace in traces:
        trace["y"] = [None if v is None else v * shown / top for v in trace["y"]]
        trace["hovertemplate"] = trace["hovertemplate"].replace(usual, smaller)
    title = look["yaxis"]["title"]
    title["text"] = title["text"].replace(usual, smaller)


def _look(data: xr.Dataset, axis: str, name: str) -> dict[str, Any]:
    axes = {"yaxis": {"rangemode": "tozero"}}
    return layout(show.axis_title(axis, data), short_axis(name, data), **axes)


def _dashed(curve: Curve, data: xr.Dataset, axis: str, name: str, dash: str) -> Trace:
    x, y = (display(variable, data[variable], data) for variable in (axis, name))
    trace = line(curve, x, y, show.unit_of(name, data))
    return {**trace, "line": {"color": curve.colour, "dash": dash, "width": 2}}


def _chosen(axes: list[np.ndarray]) -> list[float]:
    """Some values, of those that all have where there are any."""
    common = reduce(np.intersect1d, axes)
    every = common if common.size else np.unique(np.concatenate(axes))
    count = min(every.size, len(DASHES))
    return [float(v) for v in every[np.linspace(0, every.size - 1, count).round().astype(int)]]


def _screen(outcome: Outcome) -> Iterator[section.Printed]:
    if rows := running_rows(outcome):
        remark = str(outcome.parts["running"].attrs.get("fitted", ""))
        yield section.Printed("Without load: running, and from rest either way", rows, remark)


def _lacks(page: section.Page) -> str | None:
    there = drag_panel(page.outcomes, page.curves).figures
    return None if there else section.reason(page, "running")


def _blocks(page: section.Page) -> Iterator[section.Block]:
    yield drag_panel(page.outcomes, page.curves)
    attributes = (one.parts["running"].attrs for one in page.having("running").values())
    for told in dict.fromkeys(str(one.get("fitted", "")) for one in attributes):
        yield from [section.Paragraph(show.pretty(told), "note")] if told else []


_AT_LEAST = "at least; without breakaway, none is in [losses]"
"""Beside a torque from rest of which nothing says what holds it there."""

_FROM_REST, _DOUBTED = 70.1, 79.6
"""Place of what starts a drive either way, for which a joint is chosen: before its lost motion.

Where nothing was said of what holds bearings at rest, behind all that is known.
"""


def starts_doubtfully(data: xr.Dataset) -> bool:
    """True where torques from rest are hardly more than those of slow motion, see `running_part`."""
    return any("starting_torque" in doubt.about for doubt in doubts_of(data.attrs))


def _key_figures(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Torque without load and torques from rest, under the first law."""
    data = outcome.parts.get("running")
    if data is not None:
        doubted = starts_doubtfully(data)
        from_rest = _DOUBTED if doubted else _FROM_REST
        for place, (name, value) in enumerate(starting_answer(outcome, laws(data)[0])):
            brief, _, speed = name.partition(" at ")
            torque, _, band = value.partition(", ")
            detail = f"at {speed}" if speed else band or _AT_LEAST * doubted
            order = 76.0 if speed else from_rest + 0.1 * place
            asked_by = () if speed else ("breakaway",)
            yield section.KeyFigure(order, brief.capitalize(), torque, detail, asked_by=asked_by)


BESIDE = section.Section(
    name="beside",
    title="Losses beside the teeth",
    short="Beside the teeth",
    order=320.0,
    lacks=_lacks,
    blocks=_blocks,
    answer=_key_figures,
    card=starting_answer,
    screen=_screen,
)
