"""Wind-up of a drive under torque: load on every tooth, torque loop, stiffness, load on the bearing."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from pitchpoint.analyses.figures import WIND_UP
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import (
    GREY,
    INK,
    PALETTE,
    Curves,
    Figure,
    Key,
    Panel,
    Trace,
    display,
    laws,
    layout,
    level,
    plain,
    short_axis,
)
from pitchpoint.views.lines import titled
from pitchpoint.views.point import operating_point
from pitchpoint.views.screen import head, shown
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Printed, Section
from pitchpoint.views.way import beside, place_of

__all__ = ["TORSION", "torsion_answer", "torsion_panels", "wind_up_rows"]

_SHADES = ("#a6cee3", "#56a0cc", "#0072B2", "#08416b", "#02182b")
"""Colours from small to large torque, which differ in lightness alone."""

_ELASTIC = Key("without friction", INK, "dash")
_STIFFNESS = Key("slope of the torque over the wind-up", PALETTE[0])
_RANGE = Key("largest less smallest rotation over the mesh cycle", PALETTE[3])
_PAIRS = Key("pairs that carry, mean over the mesh cycle", PALETTE[2])
_ENDS = (Key("one end of the long axis", PALETTE[0]), Key("the other end", PALETTE[1], "dash"))


def torsion_panels(outcomes: Mapping[str, Outcome], known: Curves) -> list[Panel]:
    """Figures for each variant whose wind-up is there."""
    return [
        _panel(f"torsion{position}", name, len(outcomes) > 1, one, known)
        for position, (name, one) in enumerate(outcomes.items())
        if "torsion" in one.parts
    ]


def torsion_answer(outcome: Outcome) -> str:
    """Wind-up and stiffness at the operating point in words; empty if they are not there."""
    data = outcome.parts.get("torsion")
    if data is None:
        return ""
    at = operating_point(outcome).torque
    if not at > 0.0:
        return "nothing is carried at the operating point"
    values = {
        name: float(np.interp(at, data["torque"], data[name]))
        for name in ("torsional_stiffness", "wind_up", "loaded_pairs")
    }
    if not np.isfinite([*values.values()]).all():
        return "no equilibrium was found at the operating point"
    told = {name: level(name, value, data) for name, value in values.items()}
    return (
        f"{told['torsional_stiffness']} at the operating point, where the drive has wound up by "
        f"{told['wind_up']} and {told['loaded_pairs'].strip()} pairs carry in the mean"
        + _free(data)
        + (f"; {note}" if (note := str(data.attrs.get("note", ""))) else "")
    )


def _free(data: xr.Dataset) -> str:
    """Play between the flanks in words; empty without any."""
    if not data["lost_motion"] > 0.0:
        return ""
    free = level("lost_motion", float(data["lost_motion"]), data)
    moves = "travel" if _load(data)[0] == "force" else "turn"
    return f"; without load it is free to {moves} by {free} between its flanks"


def _panel(name: str, variant: str, several: bool, outcome: Outcome, known: Curves) -> Panel:
    data = outcome.parts["torsion"]
    figures = [
        _distribution(f"{name}_load", data),
        _loop(f"{name}_loop", variant, data, known),
        _against(
            f"{name}_stiffness",
            "torsional_stiffness",
            titled("torsional_stiffness", data),
            data,
            _STIFFNESS,
        ),
        _against(f"{name}_pairs", "loaded_pairs", "Pairs that carry", data, _PAIRS),
        _over_cycle(f"{name}_error", data),
        _against(
            f"{name}_range",
            "angular_transmission_error_range",
            "Static transmission error, peak to peak,",
            data,
            _RANGE,
        ),
        *([_bearing(f"{name}_bearing", data)] if "zone_load" in data else []),
    ]
    return Panel(variant if several else "", figures, note=str(data.attrs.get("note", "")))


def _load(data: xr.Dataset) -> tuple[str, str]:
    """What the loaded member takes, as a word and as the title of an axis."""
    travels = show.described("torque", data).unit == "N"
    word, symbol = ("force", "F") if travels else ("torque", "T")
    return word, f"{word} {symbol} [{show.unit_of('torque', data)}]"


def _yielded(data: xr.Dataset) -> tuple[str, str]:
    """How far it moves under it, likewise."""
    variable = show.described("wind_up", data)
    word = variable.long_name.removesuffix(" of the loaded member")
    return word, f"{word} {variable.symbol} [{show.unit_of('wind_up', data)}]"


def _distribution(name: str, data: xr.Dataset) -> Figure:
    """Force on every tooth at one end of the long axis at several torques, all phases together."""
    force = display("tooth_force", data["tooth_force"])
    zones, origin = (data["path"].attrs[name] for name in ("zones", "origin"))
    half = data.sizes["pair"] // int(zones)
    angle = place_of(data)[:, :half].ravel()
    order = np.argsort(angle, kind="stable")
    drawn = _shades(data)
    traces = [_course(key, angle[order], force[k, :, :half].ravel()[order]) for k, key in drawn]
    touched = [x for trace in traces for x, y in zip(trace["x"], trace["y"], strict=True) if y]
    ends = [min(touched, default=-20.0), max(touched, default=20.0)]
    edge = 0.06 * (ends[1] - ends[0])
    return Figure(
        name,
        f"Load on the teeth at one end of {origin}" if zones > 1 else "Load on the teeth",
        traces,
        layout(
            data["path"].attrs["axis"],
            short_axis("tooth_force"),
            xaxis={"range": [ends[0] - edge, ends[1] + edge]},
            yaxis={"rangemode": "tozero"},
        ),
        "Without friction. Every line is the way of a tooth through the zone; the teeth stand one pitch "
        f"apart on it.{f' The other end of {origin} carries alike.' if zones > 1 else ''}",
        tuple(key for _, key in drawn),
        missing="No tooth carries.",
    )


def _shades(data: xr.Dataset) -> list[tuple[int, Key]]:
    """Some torques, by place, and how they are drawn."""
    torques = data["torque"].values
    chosen = np.unique(np.linspace(0, torques.size - 1, len(_SHADES) + 1).round().astype(int))
    chosen = chosen[torques[chosen] > 0.0]
    return [
        (int(k), Key(level("torque", float(torques[k]), data), shade))
        for k, shade in zip(chosen, _SHADES, strict=False)
    ]


def _over_cycle(name: str, data: xr.Dataset) -> Figure:
    """Rotation of the loaded member under load over one mesh cycle, at several torques."""
    variable = "angular_transmission_error"
    values, unit = display(variable, data[variable], data), show.unit_of(variable, data)
    drawn = _shades(data)
    return Figure(
        name,
        "Static transmission error over the mesh cycle",
        [plain(key, data["phase"].values, values[k], unit) for k, key in drawn],
        layout(
            "phase of the mesh cycle", short_axis(variable, data), yaxis={"rangemode": "tozero"}
        ),
        "Rotation of the loaded member against its place without load and without gaps between the "
        "flanks as designed.",
        tuple(key for _, key in drawn),
    )


def _course(key: Key, angle: np.ndarray, force: np.ndarray) -> Trace:
    unit = show.unit(VARIABLES["tooth_force"].display)
    near = beside(force > 0.0)
    return plain(key, angle[near], force[near], unit)


def _loop(name: str, variant: str, data: xr.Dataset, known: Curves) -> Figure:
    """Torque over wind-up: growing, shrinking, and without friction."""
    wind_up, unit = display("wind_up", data["wind_up"], data), show.unit_of("torque", data)
    (load, load_axis), (way, way_axis) = _load(data), _yielded(data)
    keys, traces = [], []
    for position, law in enumerate(laws(data)):
        curve = known.get((variant, law))
        key = Key(law if curve is None else curve.label, PALETTE[position % len(PALETTE)])
        up, down = (
            display("torque", data[branch].values[position], data)
            for branch in ("loading_torque", "unloading_torque")
        )
        x = np.concatenate([wind_up, wind_up[::-1]])
        colour = key.colour if curve is None else curve.colour
        key = Key(f"with friction: {key.label}", colour)
        trace = plain(key, x, np.concatenate([up, down[::-1]]), unit)
        traces.append({**trace, "fill": "toself", "fillcolor": f"{colour}22"})
        keys.append(key)
    traces.append(plain(_ELASTIC, wind_up, display("torque", data["torque"], data), unit))
    return Figure(
        name,
        f"{load.capitalize()} over {way}, growing and shrinking",
        traces,
        layout(
            way_axis,
            load_axis,
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        f"Upper branch: the {load} grows; lower branch: it shrinks. The loop is that of tooth friction "
        f"alone, for one sense of {load} from first touch of the flanks.",
        (*keys, _ELASTIC),
    )


def _against(name: str, variable: str, title: str, data: xr.Dataset, key: Key) -> Figure:
    unit = show.unit_of(variable, data)
    values = data[variable].where(data["torque"] > 0.0)
    return Figure(
        name,
        f"{title} against {_load(data)[0]}",
        [
            plain(
                key, display("torque", data["torque"], data), display(variable, values, data), unit
            )
        ],
        layout(
            _load(data)[1],
            short_axis(variable, data),
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        keys=(key,),
    )


def _bearing(name: str, data: xr.Dataset) -> Figure:
    """Inward load of the teeth at both ends of the long axis."""
    unit = show.unit(VARIABLES["zone_load"].display)
    torque, loads = display("torque", data["torque"], data), display("zone_load", data["zone_load"])
    traces = [plain(key, torque, values, unit) for key, values in zip(_ENDS, loads.T, strict=False)]
    alike = np.allclose(loads[:, 0], loads[:, -1], rtol=1e-4, equal_nan=True)
    keys = (Key("either end of the long axis", GREY),) if alike else _ENDS
    if alike:
        traces = [plain(keys[0], torque, loads[:, 0], unit)]
    return Figure(
        name,
        "Radial load of the teeth on the wave generator",
        traces,
        layout(
            _load(data)[1],
            short_axis("zone_load"),
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        "Inwards, sum over the teeth of one end.",
        keys,
    )


def wind_up_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Wind-up, transmission error and stiffness at some torques."""
    data = outcome.parts["torsion"]
    torques = data["torque"].values
    return [
        {head("torque", data): f"{torques[k]:.5g}"}
        | {head(name, data): shown(name, float(data[name].values[k]), data) for name in WIND_UP}
        | {"K is that of": str(data["torsional_stiffness"].attrs.get("covers", ""))}
        for k in range(torques.size // 4, torques.size, torques.size // 4)
    ]


def _blocks(page: Page) -> Iterator[Block]:
    for it in torsion_panels(page.outcomes, page.curves):
        if it.title:
            yield Heading(it.title)
        note = f"In it: {it.note}." if it.note else ""
        yield Paragraph(
            f"Wind-up of the loaded member with the other members held, mean over the mesh cycle. {note}"
        )
        yield it


def _answer(outcome: Outcome) -> list[tuple[str, str]]:
    told = torsion_answer(outcome)
    return [("Torsional stiffness", told)] if told else []


TORSION = Section(
    name="torsion",
    title="Torsion",
    short="Torsion",
    order=300.0,
    parts=("torsion",),
    blocks=_blocks,
    answer=_answer,
    screen=lambda one: [Printed(rows=wind_up_rows(one))] if "torsion" in one.parts else [],
)
