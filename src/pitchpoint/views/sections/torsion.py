"""Wind-up of a drive under torque: load on every tooth, torque loop, stiffness, load on the bearing."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import WIND_UP
from pitchpoint.results.variables import VARIABLES, variable_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.lines import folded, overlaid
from pitchpoint.views.point import Period, operating_point, period_of
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.way import carrying_or_next, places_on_axis

__all__ = [
    "part_rows",
    "slope_rows",
    "torsion_answer",
    "torsion_blocks",
    "torsion_facts",
    "torsion_panels",
    "torsion_printed",
    "wind_up_rows",
]

_SHADES = ("#a6cee3", "#56a0cc", "#0072B2", "#08416b", "#02182b")
"""Colours from small to large torque, which differ in lightness alone."""

_ELASTIC = plot.Key("without friction", plot.INK, "dash")
_PAIRS = plot.Key("pairs that carry, mean over the mesh cycle", plot.PALETTE[2])


_SLOPES = ("torsional_stiffness", "tangent_torsional_stiffness")
_BENT = 0.01
"""Part by which torque over wind-up differs from its slope, from which on both are told."""

_PLAY = 1e-3
"""Play over the largest wind-up below which nobody feels it, and dimensions are not known to it."""


def torsion_panels(outcomes: Mapping[str, Outcome], known: plot.Curves) -> list[plot.Panel]:
    """Figures for each variant whose wind-up is there."""
    return [
        _panel(f"torsion{position}", name, len(outcomes) > 1, outcome, known)
        for position, (name, outcome) in enumerate(outcomes.items())
        if "torsion" in outcome.parts
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
        for name in (*_SLOPES, "wind_up", "loaded_pairs")
        if name in data
    }
    if not np.isfinite([*values.values()]).all():
        return "no equilibrium was found at the operating point"
    words = {name: plot.level(name, value, data) for name, value in values.items()}
    return (
        f"{words['torsional_stiffness']} at the operating point{_slope(values, words)}, where the drive has "
        f"{_words(data).yielded} by {words['wind_up']}"
        + _carrying(words.get("loaded_pairs", ""))
        + _free(data)
        + (f"; {note}" if (note := str(data.attrs.get("brief", ""))) else "")
    )


def _slope(values: Mapping[str, float], told: Mapping[str, str]) -> str:
    """Slope of the torque over the wind-up in words; empty where torque over wind-up is the same."""
    secant, slope = (values.get(name) for name in _SLOPES)
    if not secant or slope is None or abs(slope / secant - 1.0) < _BENT:
        return ""
    return f" ({told[_SLOPES[1]]} as the slope there)"


def _carrying(pairs: str) -> str:
    """How many pairs carry, in words; empty for a drive of several meshes."""
    return f" and {pairs.strip()} pairs carry in the mean" if pairs else ""


def _free(data: xr.Dataset) -> str:
    """Play between the flanks in words; empty without any."""
    if not data["kinematic_play"] > _PLAY * data["wind_up"].max():
        return ""
    free = plot.level("kinematic_play", float(data["kinematic_play"]), data)
    return f"; without load its flanks let it {_words(data).moves} freely by a kinematic play of {free}"


def _panel(
    name: str, variant: str, several: bool, outcome: Outcome, known: plot.Curves
) -> plot.Panel:
    data = outcome.parts["torsion"]
    one_mesh = "tooth_force" in data
    words = _words(data)
    slope = plot.Key(f"slope of the {words.load} over the {words.way}", plot.PALETTE[0])
    over = "over the mesh cycle" if one_mesh else "of each stage, at the output, summed"
    spread = plot.Key(f"largest less smallest {words.motion} {over}", plot.PALETTE[3])
    figures = [
        *([_distribution(f"{name}_load", data)] if one_mesh else []),
        *([_loop(f"{name}_loop", variant, data, known)] if one_mesh else []),
        _against(
            f"{name}_stiffness",
            "tangent_torsional_stiffness",
            words.stiffness,
            data,
            slope,
        ),
        *(
            [_against(f"{name}_pairs", "loaded_pairs", "Pairs that carry", data, _PAIRS)]
            if one_mesh
            else []
        ),
        *([_over_cycle(f"{name}_error", data, period_of(outcome))] if one_mesh else []),
        _against(
            f"{name}_range",
            "angular_transmission_error_range",
            "Static transmission error, peak to peak,",
            data,
            spread,
        ),
        *([_bearing(f"{name}_bearing", data)] if "zone_load" in data else []),
    ]
    return plot.Panel(variant if several else "", figures, note=str(data.attrs.get("note", "")))


@dataclass(frozen=True)
class _Words:
    """Words of the load on the loaded member and of its way under it."""

    load: str
    load_axis: str
    way: str
    way_axis: str
    stiffness: str
    yielded: str
    moves: str
    motion: str


def _words(data: xr.Dataset) -> _Words:
    """Words for a member that turns, or for one that travels."""
    load, twist = (show.unit_of(name, data) for name in ("torque", "wind_up"))
    if show.described("torque", data).unit == "N":
        axes = (f"force F [{load}]", "deflection", f"deflection Δs [{twist}]")
        return _Words("force", *axes, "Stiffness", "yielded", "travel", "travel")
    axes = (f"torque T [{load}]", "wind-up", f"wind-up Δθ [{twist}]")
    return _Words("torque", *axes, "Torsional stiffness", "wound up", "turn", "rotation")


def _distribution(name: str, data: xr.Dataset) -> plot.Figure:
    """Force on every tooth at one end of the long axis at several torques, all phases together."""
    force = plot.display("tooth_force", data["tooth_force"])
    zones, origin = (data["path"].attrs[name] for name in ("zones", "origin"))
    half = data.sizes["pair"] // int(zones)
    angle = places_on_axis(data)[:, :half].ravel()
    order = np.argsort(angle, kind="stable")
    drawn = _shades(data)
    traces = [_course(key, angle[order], force[k, :, :half].ravel()[order]) for k, key in drawn]
    touched = [x for trace in traces for x, y in zip(trace["x"], trace["y"], strict=True) if y]
    ends = [min(touched, default=-20.0), max(touched, default=20.0)]
    edge = 0.06 * (ends[1] - ends[0])
    return plot.Figure(
        name,
        f"Load on the teeth at one end of {origin}" if zones > 1 else "Load on the teeth",
        traces,
        plot.layout(
            data["path"].attrs["axis"],
            plot.short_axis("tooth_force"),
            xaxis={"range": [ends[0] - edge, ends[1] + edge]},
            yaxis={"rangemode": "tozero"},
        ),
        "Without friction. Every line is the way of a tooth through the zone; the teeth stand one pitch "
        f"apart on it.{f' The other end of {origin} carries alike.' if zones > 1 else ''}",
        tuple(key for _, key in drawn),
        missing="No tooth carries.",
    )


def _shades(data: xr.Dataset) -> list[tuple[int, plot.Key]]:
    """Some torques, by place, and how they are drawn."""
    torques = data["torque"].values
    chosen = np.unique(np.linspace(0, torques.size - 1, len(_SHADES) + 1).round().astype(int))
    chosen = chosen[torques[chosen] > 0.0]
    return [
        (int(k), plot.Key(plot.level("torque", float(torques[k]), data), shade))
        for k, shade in zip(chosen, _SHADES, strict=False)
    ]


def _over_cycle(name: str, data: xr.Dataset, period: Period) -> plot.Figure:
    """Motion of the loaded member under load over one mesh cycle less its mean, at several torques."""
    ripple, shown = "angular_transmission_error_range", _shades(data)
    symbol = show.described("angular_transmission_error", data).symbol
    unit = show.unit_of(ripple, data)
    traces = []
    for k, key in shown:
        values = data["angular_transmission_error"].values[k]
        phase, error = folded(data["phase"].values, values - _mean(data["phase"].values, values))
        traces.append(plot.legend_line(key, phase, plot.display(ripple, error, data), unit))
    return plot.Figure(
        name,
        "Static transmission error over the mesh cycle, less its mean",
        traces,
        plot.layout(period.axis, f"{symbol} less its mean [{unit}]", xaxis={"range": [0, 1]}),
        f"{_words(data).motion.capitalize()} of the loaded member against its place without load and "
        "without gaps between the flanks as designed, each line less its mean.",
        tuple(key for _, key in shown),
        missing="No equilibrium was found.",
    )


def _mean(phase: np.ndarray, values: np.ndarray) -> float:
    """Mean over one period, the last value followed by the first one of the next."""
    around = np.append(phase, phase[0] + 1.0)
    return float(np.trapezoid(np.append(values, values[0]), around))


def _course(key: plot.Key, angle: np.ndarray, force: np.ndarray) -> plot.Trace:
    """Line of the force where a tooth carries, with gaps where it does not touch."""
    unit = show.display_unit(VARIABLES["tooth_force"].display)
    near = carrying_or_next(force > 0.0)
    return plot.legend_line(key, angle[near], np.where(force > 0.0, force, np.nan)[near], unit)


def _loop(name: str, variant: str, data: xr.Dataset, known: plot.Curves) -> plot.Figure:
    """Torque over wind-up: growing, shrinking, and without friction."""
    wind_up, unit = plot.display("wind_up", data["wind_up"], data), show.unit_of("torque", data)
    words = _words(data)
    keys, traces = [], []
    for position, law in enumerate(plot.laws(data)):
        curve = known.get((variant, law))
        key = plot.Key(
            law if curve is None else curve.label, plot.PALETTE[position % len(plot.PALETTE)]
        )
        up, down = (
            plot.display("torque", data[branch].values[position], data)
            for branch in ("loading_torque", "unloading_torque")
        )
        x = np.concatenate([wind_up, wind_up[::-1]])
        colour = key.colour if curve is None else curve.colour
        key = plot.Key(f"with friction: {key.label}", colour)
        trace = plot.legend_line(key, x, np.concatenate([up, down[::-1]]), unit)
        traces.append({**trace, "fill": "toself", "fillcolor": f"{colour}22"})
        keys.append(key)
    traces.append(
        plot.legend_line(_ELASTIC, wind_up, plot.display("torque", data["torque"], data), unit)
    )
    return plot.Figure(
        name,
        f"{words.load.capitalize()} over {words.way}, growing and shrinking",
        traces,
        plot.layout(
            words.way_axis,
            words.load_axis,
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        f"Upper branch: the {words.load} grows; lower branch: it shrinks, for one sense of {words.load} "
        "from first touch of the flanks. The loop is that of friction on the teeth, and in bearings and "
        "seals that the case gives.",
        (*keys, _ELASTIC),
    )


def _against(name: str, variable: str, title: str, data: xr.Dataset, key: plot.Key) -> plot.Figure:
    unit = show.unit_of(variable, data)
    values = data[variable].where(data["torque"] > 0.0)
    return plot.Figure(
        name,
        f"{title} against {_words(data).load}",
        [
            plot.legend_line(
                key,
                plot.display("torque", data["torque"], data),
                plot.display(variable, values, data),
                unit,
            )
        ],
        plot.layout(
            _words(data).load_axis,
            plot.short_axis(variable, data),
            xaxis={"rangemode": "tozero"},
            yaxis={"rangemode": "tozero"},
        ),
        keys=(key,),
    )


def _bearing(name: str, data: xr.Dataset) -> plot.Figure:
    """Inward load of the teeth at both ends of the long axis."""
    unit, origin = show.unit_of("zone_load", data), data["path"].attrs["origin"]
    ends = (
        plot.Key(f"one end of {origin}", plot.PALETTE[0]),
        plot.Key("the other end", plot.PALETTE[1], "dash"),
    )
    torque, loads = (
        plot.display("torque", data["torque"], data),
        plot.display("zone_load", data["zone_load"]),
    )
    traces = [
        plot.legend_line(key, torque, values, unit)
        for key, values in zip(ends, loads.T, strict=False)
    ]
    alike = np.allclose(loads[:, 0], loads[:, -1], rtol=1e-4, equal_nan=True)
    keys = (plot.Key(f"either end of {origin}", plot.GREY),) if alike else ends
    if alike:
        traces = [plot.legend_line(keys[0], torque, loads[:, 0], unit)]
    return plot.Figure(
        name,
        "Radial load of the teeth on the wave generator",
        traces,
        plot.layout(
            _words(data).load_axis,
            plot.short_axis("zone_load"),
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
        {head("torque", data): screen_value("torque", float(torques[k]), data)}
        | {
            head(name, data): screen_value(name, float(data[name].values[k]), data)
            for name in WIND_UP
            if name in data
        }
        for k in range(torques.size // 4, torques.size, torques.size // 4)
    ]


_NO_LOOP = (
    "The hysteresis loss is that by friction of the teeth alone, a lower bound: of a drive of size 25 some "
    "fiftieth of the arc minute that catalogues give. Not in the loop: friction in the joints and of the "
    "ring on its race, damping of the material, teeth that are pressed on both flanks."
)


def part_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Parts of the wind-up at the operating point, the largest first; none where nothing is known of them."""
    data = outcome.parts["torsion"]
    if "wind_up_part" not in data:
        return []
    at = operating_point(outcome).torque
    wind_ups = [
        float(np.interp(at, data["torque"], values)) for values in data["wind_up_part"].values
    ]
    order = sorted(range(len(wind_ups)), key=lambda k: -wind_ups[k])
    words = f"at {plot.level('torque', at, data)} [{show.unit_of('wind_up_part')}]"
    return [
        {
            "part of the wind-up": str(data["part"].values[k]),
            words: screen_value("wind_up_part", wind_ups[k]),
            "share [%]": show.number_text(100.0 * wind_ups[k] / sum(wind_ups)),
        }
        for k in order
    ]


def slope_rows(outcome: Outcome) -> list[dict[str, str]]:
    """Stiffness in three slopes, with lost motion and hysteresis loss under each law."""
    data = outcome.parts["torsion"]
    if "slope_stiffness" not in data:
        return []
    slopes = {
        f"{name} up to {plot.level('slope_torque', float(end))}": plot.level(
            "slope_stiffness", float(value)
        )
        for name, end, value in zip(
            data["slope"].values,
            data["slope_torque"].values,
            data["slope_stiffness"].values,
            strict=True,
        )
    }
    return [
        {"friction law": str(law)}
        | slopes
        | {
            f"{words} [{show.unit_of(name)}]": screen_value(name, float(data[name].values[k]))
            for words, name in (
                ("lost motion at ±4 % of the torque", "catalogue_lost_motion"),
                ("hysteresis loss", "hysteresis_loss"),
            )
        }
        for k, law in enumerate(data["law"].values)
    ]


def _table(rows: list[dict[str, str]]) -> Iterator[section.Block]:
    """Rows as a table of the report; nothing without any."""
    if rows:
        yield section.SectionTable(
            [*rows[0]], [[*row.values()] for row in rows], compact=len(rows[0]) < 5
        )


def _down(rows: list[dict[str, str]]) -> list[dict[str, str]]:
    """Columns as rows, so that a narrow page holds them: a column for each name in the first one."""
    names = [*rows[0]] if rows else []
    return [{names[0]: name} | {row[names[0]]: row[name] for row in rows} for name in names[1:]]


def torsion_blocks(page: section.Page) -> Iterator[section.Block]:
    """Blocks of the section."""
    panels, having = torsion_panels(page.outcomes, page.curves), page.having("torsion")
    if page.designs and len(having) > 1:
        yield _of_designs({name: design.parts["torsion"] for name, design in having.items()})
    there = zip(panels, having.values(), strict=True)
    yield from section.tabbed((it.title, _of_variant(it, outcome)) for it, outcome in there)


def _of_designs(designs: Mapping[str, xr.Dataset]) -> plot.Panel:
    """Wind-up and stiffness of several designs on the same axes."""
    drawn = (
        ("wind_up", "torque", "Load over wind-up, without friction"),
        ("torque", "torsional_stiffness", "Stiffness against load"),
        ("torque", "angular_transmission_error_range", "Transmission error, peak to peak"),
    )
    like = {name: data.where(data["torque"] > 0.0) for name, data in designs.items()}
    figures = [
        overlaid(f"torsion_of_designs_{up}", title, across, up, like) for across, up, title in drawn
    ]
    return plot.Panel("Designs on the same axes", figures)


def _of_variant(it: plot.Panel, outcome: Outcome) -> Iterator[section.Block]:
    note = f"{it.note[0].upper()}{it.note[1:]}." if it.note else ""
    data = outcome.parts["torsion"]
    held = (
        "with the other members held, mean over the mesh cycle"
        if "tooth_force" in data
        else "with the input held, while the shafts between them turn: the sum of those of the stages, "
        "each the mean over its mesh cycle"
    )
    yield section.Paragraph(f"{_words(data).way.capitalize()} of the loaded member {held}. {note}")
    if left_out := str(data.attrs.get("left_out", "")):
        yield section.Paragraph(left_out, "note")
    yield from _table(_down(slope_rows(outcome)))
    yield from _table(part_rows(outcome))
    if "hysteresis_loss" in data:
        yield section.Paragraph(_NO_LOOP, "note")
    yield it


def torsion_facts(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """Stiffness at the operating point; three slopes and lost motion where a maker would state them."""
    words, data = torsion_answer(outcome), outcome.parts["torsion"]
    figure = section.key_figure(70.0, _words(data).stiffness, words, " at the operating point")
    slopes = _slopes(data)
    rigid = _rigid(data)
    detail = figure.detail.replace(f"; {rigid} are not in it", "")
    without = _pins(data) or (f"without {rigid}" if rigid else "")
    clauses = (slopes, _assumed(data), without, detail)
    yield replace(figure, detail="; ".join(filter(None, clauses)), asked_by=("gears.yielding",))
    if "catalogue_lost_motion" in data:
        values = data["catalogue_lost_motion"].values
        shown = dict.fromkeys(show.quantity("catalogue_lost_motion", float(v)) for v in values)
        detail = "at ±4 % of torque, tooth friction alone"
        asked_by = "gears.yielding", "gears.backlash", "gears.wave_generator.bearing.play"
        yield section.KeyFigure(71.0, "Lost motion", " and ".join(shown), detail, asked_by=asked_by)


def _pins(data: xr.Dataset) -> str:
    """What of a set is in a stiffness, in few words; empty where no planets bear on pins."""
    counted = "pins" in data["torsional_stiffness"].attrs.get("covers", "")
    left_out = "pins" in _rigid(data)
    if counted:
        return f"of teeth and {'some ' * left_out}pins"
    return "of teeth alone" if left_out else ""


def _rigid(data: xr.Dataset) -> str:
    """What a stiffness is without, as "shafts and bearings"; empty where its analysis named nothing."""
    rigid, without, _ = str(data.attrs.get("brief", "")).partition(" are not in it")
    return rigid if without else ""


def _assumed(data: xr.Dataset) -> str:
    """On how many sizes that nobody gave a stiffness rests, in few words; empty if on none."""
    sizes = str(data.attrs.get("brief", "")).partition(" are not in it; ")[2]
    count = sizes.partition(" ")[0]
    return f"{count} size{'s' * (count != '1')} assumed" if sizes else ""


_OF_SLOPES = 3
"""Digits of a slope: makers print two, and a screen has the doubt beside."""


def _slopes(data: xr.Dataset) -> str:
    """Stiffness in three slopes, in the unit of the stiffness itself; empty where catalogues have none."""
    if "slope_stiffness" not in data:
        return ""
    names, stiffnesses = data["slope"].values, data["slope_stiffness"]
    values = np.asarray(
        show.displayed(variable_of(data, "slope_stiffness"), stiffnesses.values), float
    )
    shown_slopes = ", ".join(show.number_text(float(value), _OF_SLOPES) for value in values)
    units = {show.unit_of(name, data) for name in ("slope_stiffness", "torsional_stiffness")}
    unit = f" {show.unit_of('slope_stiffness', data)}" if len(units) > 1 else ""
    return f"{names[0]}–{names[-1]} {shown_slopes}{unit}"


def torsion_printed(outcome: Outcome) -> list[section.Printed]:
    """What the screen shows."""
    slopes, attrs = slope_rows(outcome), outcome.parts["torsion"].attrs
    note, left_out = (str(attrs.get(name, "")) for name in ("brief", "left_out"))
    return [
        section.Printed(rows=wind_up_rows(outcome), line=f"Stiffness: {note}." if note else ""),
        section.Printed(rows=slopes, line=_NO_LOOP if slopes else left_out),
        section.Printed(rows=part_rows(outcome)),
    ]
