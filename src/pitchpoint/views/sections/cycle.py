"""Over the mesh cycle: efficiency and input torque, friction of the pairs."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.main_figures import of_contact
from pitchpoint.runs.run import Outcome
from pitchpoint.views import figures as plot
from pitchpoint.views import section, show
from pitchpoint.views.inputs import input_words
from pitchpoint.views.lines import Points, folded, gapped, titled
from pitchpoint.views.path import contact_path
from pitchpoint.views.point import Period, period_of

__all__ = ["CYCLE", "cycle_panel"]

_FEW = 8
"""Pairs above which the friction of each cannot be told apart."""

_PARTS = ("teeth", "cycle")
_COURSES = ("efficiency", "input_torque")
Timed = list[tuple[plot.Curve, xr.Dataset, int, Period]]

_PAIR_DASHES = ("solid", "dash", "dot", "dashdot", "longdash", "longdashdot")


def _blocks(page: section.Page) -> Iterator[section.Block]:
    there = page.having(*_PARTS)
    period = period_of(next(iter(there.values())))
    opening = f"{_start(page)} one" if _start(page) else "One"
    yield section.Paragraph(f"{opening} period is one {period.pitch}: {_cycle_words(there)}.")
    yield cycle_panel(there, page.curves)


def _start(page: section.Page) -> str:
    """At which moment a period begins; empty where no point of the way stands out."""
    paths = [contact_path(outcome) for outcome in page.having("teeth.points", "cycle").values()]
    if not paths:
        return ""
    helical = any(path.helical for path in paths)
    entry = "enters at one end of the face" if helical else "is at A"
    return f"Phase 0 is the moment at which a pair {entry};"


def cycle_panel(outcomes: Mapping[str, Outcome], known: plot.Curves) -> plot.Panel:
    """Efficiency and input torque over phase and time and against each other, friction of the pairs."""
    seen = list(_timed(outcomes, known))
    if not seen:
        return plot.Panel("Over the mesh cycle", [])
    figures = [
        *(_over(name, "phase", seen) for name in _COURSES),
        _against(seen),
        (_pairs if seen[0][1].sizes["pair"] <= _FEW else _count)(seen),
    ]
    choices = [_choice(axis, figures, seen) for axis in ("phase", "time")]
    return plot.Panel(
        "Over the mesh cycle",
        figures,
        [curve for curve, *_ in seen],
        choices,
        menu="Efficiency and torque over",
    )


def _choice(axis: str, figures: list[plot.Figure], seen: Timed) -> plot.Choice:
    """One period over the phase, or two over time."""
    others = [_over(name, axis, seen) for name in _COURSES]
    changes = {
        drawn.name: _change(traces)
        for drawn, traces in zip(figures, others, strict=False)
        if drawn.drawn
    }
    return plot.Choice(_axis(axis, seen[0][3]), changes)


def _change(other: plot.Figure) -> list[Any]:
    x, y = ([trace[of] for trace in other.data] for of in "xy")
    return [{"x": x, "y": y}, {"xaxis.title.text": other.layout["xaxis"]["title"]["text"]}]


def _axis(axis: str, period: Period) -> str:
    """Title of the axis; time may run against the phase."""
    against = f", against the phase: {period.against}" if period.backwards else ""
    return period.axis if axis == "phase" else f"time [{show.unit_of('time')}]{against}"


def _timed(
    outcomes: Mapping[str, Outcome], known: plot.Curves
) -> Iterator[tuple[plot.Curve, xr.Dataset, int, Period]]:
    """Curve, cycle, position of the law and period for every law of every variant."""
    for variant, outcome in outcomes.items():
        if "cycle" in outcome.parts:
            data, period = outcome.parts["cycle"], period_of(outcome)
            for position, law in enumerate(plot.laws(data)):
                yield known[variant, law], data, position, period


def _over(name: str, axis: str, seen: Timed) -> plot.Figure:
    phase_axis = seen[0][3]
    abscissa = _phase if axis == "phase" else _time
    like = seen[0][1]
    unit = show.unit_of(name, like)
    traces = []
    for curve, data, law, period in seen:
        x, y = abscissa(data, data[name].values[law], period)
        traces.append(plot.line(curve, x, plot.display(name, y, data), unit))
    return plot.Figure(
        f"cycle_{name}",
        f"{titled(name, like)} over the mesh cycle",
        traces,
        plot.layout(_axis(axis, phase_axis), plot.short_axis(name, like)),
    )


def _phase(data: xr.Dataset, values: np.ndarray, _: Period) -> Points:
    return gapped(*folded(data["phase"].values, values))


def _time(data: xr.Dataset, values: np.ndarray, period: Period) -> Points:
    phase = data["phase"].values
    if period.backwards:
        phase, values = 1.0 - phase[::-1], values[::-1]
    x, y = gapped(np.concatenate([phase, phase + 1.0]) - phase[0], np.tile(values, 2))
    return plot.display("time", x * period.time), y


def _against(seen: Timed) -> plot.Figure:
    """Efficiency against input torque; curves lie on each other, so the first ones are wider."""
    traces = []
    for position, (curve, data, law, _) in enumerate(seen):
        order = np.argsort(data["input_torque"].values[law], kind="stable")
        trace = plot.line(
            curve,
            plot.display("input_torque", data["input_torque"].values[law][order], data),
            plot.display("efficiency", data["efficiency"].values[law][order]),
            "%",
        )
        trace["line"] = {"color": curve.colour, "width": 2 + 3 * (len(seen) - 1 - position)}
        trace |= {"mode": "lines+markers", "marker": {"size": 3, "color": curve.colour}}
        traces.append(trace)
    return plot.Figure(
        "cycle_against",
        "Instantaneous efficiency against input torque",
        traces,
        plot.layout(plot.short_axis("input_torque", seen[0][1]), plot.short_axis("efficiency")),
        "With the load held, all laws lie on one curve and cover different parts of it; "
        "the first laws are drawn wider."
        if len(seen) > 1
        else "",
    )


def _pairs(seen: Timed) -> plot.Figure:
    """Friction of all pairs that are in contact at a phase."""
    traces = []
    for curve, data, law, _ in seen:
        for pair in range(data.sizes["pair"]):
            active = data["active"].values[:, pair, 0]
            friction = np.where(active, _mean_friction(data, law)[:, pair], np.nan)
            x, y = gapped(data["phase"].values, friction)
            trace = plot.line(curve, x, y, f"(pair {pair + 1})")
            trace["line"] = {
                "color": curve.colour,
                "width": 2,
                "dash": _PAIR_DASHES[pair % len(_PAIR_DASHES)],
            }
            traces.append(trace)
    names = ", ".join(
        f"{dash} for the pair that entered {_ago(pair)}"
        for pair, dash in enumerate(_PAIR_DASHES[: seen[0][1].sizes["pair"]])
    )
    return plot.Figure(
        "cycle_friction",
        "Friction coefficient of the pairs in contact",
        traces,
        plot.layout(seen[0][3].axis, "μ", yaxis={"rangemode": "tozero"}),
        f"Line styles here: {names}.",
    )


def _count(seen: Timed) -> plot.Figure:
    """Number of pairs that carry; steps, since it is a whole number."""
    traces = []
    for curve, data, law, period in seen:
        carrying = (data["load"].values[law].max(axis=-1) > 0.0).sum(axis=-1)
        phase, count = _phase(data, carrying, period)
        traces.append(plot.line(curve, phase, np.rint(count), "pairs"))
    shown, remark = plot.merged(traces)
    for trace in shown:
        trace["line"]["shape"] = "hvh"
    return plot.Figure(
        "cycle_pairs",
        "Number of pairs that carry",
        shown,
        plot.layout(seen[0][3].axis, "pairs", yaxis={"rangemode": "tozero"}),
        remark,
    )


def _mean_friction(data: xr.Dataset, law: int) -> np.ndarray:
    """Friction coefficient of each contact line [node, pair], slices weighted by their load.

    NaN where a line carries nothing while others do.
    """
    friction, load = (data[name].values[law] for name in ("friction", "load"))
    total = load.sum(axis=-1)
    carries = total > 0.0
    mean = (friction * load).sum(axis=-1) / np.where(carries, total, 1.0)
    return np.where(carries, mean, np.nan if carries.any() else friction.mean(axis=-1))


def _ago(pair: int) -> str:
    return ("in this period", "one period before")[pair] if pair < 2 else f"{pair} periods before"


def _cycle_words(outcomes: Mapping[str, Outcome]) -> str:
    """Driver angle and time of one period."""
    seen: dict[str, list[str]] = {}
    for variant, outcome in outcomes.items():
        period = period_of(outcome)
        time = show.number_text(float(plot.display("time", period.time)))
        seen.setdefault(f"{period.words}, {time} {show.unit_of('time')}", []).append(variant)
    if len(seen) < 2:
        return next(iter(seen), "")
    return "; ".join(f"{words} ({', '.join(names)})" for words, names in seen.items())


def _turns(outcome: Outcome, law: str) -> list[tuple[str, str]]:
    """How films and forces were found together, name and words; nothing of a formula."""
    data = outcome.parts.get("operation")
    if data is None or "turns" not in data or law not in plot.laws(data):
        return []
    turns, change = (
        float(data[name].values[plot.laws(data).index(law), 0])
        for name in ("turns", "turns_change")
    )
    if not turns:
        return []
    agree = f"agree after {turns:.0f} turns, the coefficients to {change:.1g} of the largest one"
    return [("films and forces", agree)]


def _screen(outcome: Outcome) -> Iterator[section.Printed]:
    for law in outcome.manifest["laws"]:
        for name, words in _turns(outcome, law["name"]):
            yield section.Printed(line=f"{law['title']}: {name} {words}.")


_NO_FILM = 1e-3
"""Film over composite Rq below which it is thinner than a molecule, where the entrainment turns."""


_FULL, _BOUNDARY = 3.0, 1.0
"""Film over composite Rq from which on the film is whole, and below which roughness carries most."""


def _regime(ratio: float) -> str:
    """How a film separates flanks, in the usual words (Hamrock, Schmid, Jacobson 2004, ch. 1)."""
    if ratio >= _FULL:
        return "full film"
    return "mixed: rough peaks touch" if ratio >= _BOUNDARY else "boundary: rough peaks carry"


def _key_figures(outcome: Outcome) -> Iterator[section.KeyFigure]:
    """The thinnest film over roughness and what asperities carry at most, under the first law."""
    data = outcome.parts.get("cycle")
    of_rig = of_contact(outcome.parts.get("operation", ()))  # which has it among its main figures
    if data is None or of_rig or "lambda_ratio" not in data:
        return
    ratio = data["lambda_ratio"].values[0][data["load"].values[0] > 0.0]
    if ratio.size and np.isfinite(ratio).any():
        least = float(np.nanmin(ratio))
        value = show.number_text(least) if least >= _NO_FILM else f"below {_NO_FILM:g}"
        law = show.pretty(input_words(outcome, "models", "film_thickness"))
        detail = f"{_regime(least)}; thinnest film by {law} over composite Rq"
        asked_by = "models.film_thickness", "models.asperity_load"
        yield section.KeyFigure(76.5, "Film ratio", value, detail, rank=least, asked_by=asked_by)
    if "asperity_load_ratio" in data:
        share = data["asperity_load_ratio"].values[0]
        value = show.quantity("asperity_load_ratio", float(np.max(share)))
        law = show.pretty(input_words(outcome, "models", "asperity_load"))
        words = f"largest part over the cycle, by {law}"
        yield section.KeyFigure(
            38.0, "Load on asperities", value, words, rank=-float(np.max(share))
        )


CYCLE = section.Section(
    name="cycle",
    title="Over the mesh cycle",
    short="Over the cycle",
    order=200.0,
    parts=_PARTS,
    blocks=_blocks,
    answer=_key_figures,
    card=_turns,
    screen=_screen,
    main_figure="cycle_efficiency",
    of_a_mesh=True,
)
