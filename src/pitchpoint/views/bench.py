"""A bench of drives: its first screen, its page with figures on the same axes, its table as CSV."""

import csv
import io
import json
from collections.abc import Callable, Iterator, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from pitchpoint.registry import enumerated
from pitchpoint.results.store import make_folder, without_nan, write_text
from pitchpoint.runs.bench import BENCHED, LOADS, SPEEDS, Bench, BenchedDrive
from pitchpoint.views import figures as plot
from pitchpoint.views import show
from pitchpoint.views.columns import lines_of
from pitchpoint.views.first_screen import Line, wrapped
from pitchpoint.views.report import page_of
from pitchpoint.views.section import Block, Paragraph, SectionTable

__all__ = ["bench_page", "bench_screen", "write_bench"]

NONE = "-"
"""Stands for a figure that a drive does not have."""

HEADS = {
    "ratio": "ratio",
    "drive_mass": "mass",
    "outer_diameter": "⌀",
    "gear_length": "length",
    "efficiency": "η",
    "efficiency_quarter": "η at 25 %",
    "efficiency_tenth": "η at 10 %",
    "back_efficiency": "η back",
    "back_efficiency_quarter": "η back at 25 %",
    "back_efficiency_tenth": "η back at 10 %",
    "no_load_torque": "no-load torque",
    "starting_torque": "starting torque",
    "back_driving_torque": "back-driving torque",
    "torsional_stiffness": "stiffness",
    "backlash": "backlash",
    "lost_motion": "lost motion",
    "input_inertia": "inertia",
    "torque_ripple": "ripple",
    "transmission_error": "transmission error",
    "kinematic_error": "kinematic error",
}
"""Heads of the columns; what all drives lack has none."""

_FIRST = (
    "ratio",
    "drive_mass",
    "outer_diameter",
    "efficiency",
    "efficiency_tenth",
    "back_efficiency",
    "torsional_stiffness",
    "backlash",
    "input_inertia",
)
"""Columns of the first screen."""

_SECOND = (
    "no_load_torque",
    "starting_torque",
    "back_driving_torque",
    "lost_motion",
    "torque_ripple",
)
"""Columns beside these of few drives."""

_FEW = 8
"""Most drives that are few."""


def bench_screen(bench: Bench, width: int, page: str, *, full: bool = False) -> list[Line]:
    """Lines of the screen: the table, what efficiencies are of, why figures are not there.

    Args:
        bench: the drives.
        width: of the screen [characters].
        page: where the page lies.
        full: True for all columns, however many drives there are.
    """
    few = _SECOND if len(bench.drives) <= _FEW else ()
    chosen = (*HEADS,) if full else (*_FIRST, *few)
    names = [name for name in chosen if _there(bench, name)]
    heads, rows = _cells(bench, names)
    title = f"{len(bench.drives)} drives at their operating points"
    foot = [*_basis(bench), *_remarks(bench), *_reasons(bench, chosen)]
    behind = (
        [] if full else ["Length, efficiencies at part load backwards, errors of motion: --full."]
    )
    return [
        Line(title, "title"),
        *(Line(words, "figure") for words in lines_of(rows, heads, width)),
        *(Line(words, "note") for sentence in foot for words in wrapped(sentence, width)),
        *map(Line, behind),
        Line(f"Page: {page}"),
    ]


def _there(bench: Bench, name: str) -> bool:
    return any(name in drive.figures for drive in bench.drives)


def _cells(bench: Bench, names: Sequence[str]) -> tuple[list[str], list[dict[str, str]]]:
    """Heads with units, and a row for each drive."""
    units, columns = {}, {}
    for name in names:
        values = [drive.figures.get(name, np.nan) for drive in bench.drives]
        units[name], columns[name] = _in_one_unit(name, values)
    heads = {name: f"{HEADS[name]} {units[name]}".strip() for name in names}
    rows = [
        {"": drive.name} | {heads[name]: columns[name][at] for name in names}
        for at, drive in enumerate(bench.drives)
    ]
    return ["", *heads.values()], rows


def _in_one_unit(name: str, values: Sequence[float]) -> tuple[str, list[str]]:
    """Unit of a column, handy for the largest value, and its cells."""
    variable = BENCHED[name]
    shown = np.asarray(show.displayed(variable, np.asarray(values)), float)
    shown = np.where(np.abs(shown) < _NOTHING, 0.0 * shown, shown)
    cells = [NONE if np.isnan(value) else show.number_text(float(value)) for value in shown]
    return show.display_unit(variable.display), cells


_NOTHING = 1e-6
"""What is shown as nothing, in the unit in which it is shown: rounding of a backlash without allowances."""


def _basis(bench: Bench) -> Iterator[str]:
    """What efficiencies are of and by which law, each with its drives where they are not the same."""
    scopes = _grouped(bench, lambda drive: drive.scope)
    yield f"Efficiency is that of {_told(scopes)}, at the load of each case unless a part of it is named."
    yield f"Friction: {_told(_grouped(bench, lambda drive: drive.law))}."


def _grouped(bench: Bench, key: Callable[[BenchedDrive], str]) -> dict[str, list[str]]:
    groups: dict[str, list[str]] = {}
    for drive in bench.drives:
        groups.setdefault(key(drive), []).append(drive.name)
    return groups


def _told(groups: dict[str, list[str]]) -> str:
    """What groups have in common, with their names where there are several."""
    if len(groups) == 1:
        return next(iter(groups))
    return "; ".join(f"{words} ({_some(names)})" for words, names in groups.items())


_LISTED = 4
"""Most drives that are named one by one."""


def _some(names: Sequence[str]) -> str:
    if len(names) <= _LISTED:
        return ", ".join(names)
    return f"{', '.join(names[: _LISTED - 1])} and {len(names) - _LISTED + 1} more"


def _remarks(bench: Bench) -> Iterator[str]:
    """Remarks with the drives that they are of."""
    groups: dict[str, list[str]] = {}
    for drive in bench.drives:
        for remark in drive.remarks:
            groups.setdefault(remark, []).append(drive.name)
    for remark, names in groups.items():
        yield show.pretty(f"{_all_or_some(names, bench)}: {remark}.")


def _all_or_some(names: Sequence[str], bench: Bench) -> str:
    return "Each drive" if len(names) == len(bench.drives) > 1 else _some(names)


def _reasons(bench: Bench, chosen: Sequence[str]) -> Iterator[str]:
    """Why figures are not there: by reason, with the figures and drives."""
    groups: dict[tuple[str, tuple[str, ...]], list[str]] = {}
    for drive in bench.drives:
        by_reason: dict[str, list[str]] = {}
        for name, why in drive.lacks.items():
            if name in chosen:
                by_reason.setdefault(why, []).append(HEADS[name])
        for why, figures in by_reason.items():
            groups.setdefault((why, tuple(figures)), []).append(drive.name)
    for (why, lacking), drives in groups.items():
        sentence = show.pretty(why.rstrip("."))
        yield f"{_all_or_some(drives, bench)} without {enumerated(lacking)}: {sentence}."


def write_bench(bench: Bench, folder: Path | str) -> Path:
    """Write `bench.html`, `bench.csv` (SI) and `bench.json` into a folder; the path of the page.

    Args:
        bench: the drives.
        folder: made if it is not there; files of these names are replaced.

    Raises:
        OSError: the disk is full, say.
    """
    place = Path(folder)
    make_folder(place)
    write_text(place / "bench.csv", _csv(bench))
    records = json.dumps(
        without_nan(bench.as_json()), indent=1, allow_nan=False, ensure_ascii=False
    )
    write_text(place / "bench.json", f"{records}\n")
    page = place / "bench.html"
    write_text(page, bench_page(bench))
    return page


def _csv(bench: Bench) -> str:
    """A row for each drive, figures in SI; cells of what it does not have are "-" and the reason."""
    text_of = io.StringIO()
    writer = csv.writer(text_of, lineterminator="\n")
    heads = [f"{name} [{variable.unit}]" for name, variable in BENCHED.items()]
    writer.writerow(["drive", "family", "friction", "efficiency of", *heads])
    for drive in bench.drives:
        cells = [
            repr(drive.figures[name]) if name in drive.figures else f"- ({drive.lacks[name]})"
            for name in BENCHED
        ]
        writer.writerow([drive.name, drive.family, drive.law, drive.scope, *cells])
    return text_of.getvalue()


def bench_page(bench: Bench) -> str:
    """The page as text: the table, figures on the same axes, why figures are not there.

    Args:
        bench: the drives.
    """
    sections: list[dict[str, Any]] = [
        {"name": "table", "title": "Drives", "blocks": [*_tables(bench)]},
        {"name": "axes", "title": "On the same axes", "blocks": [_panel(bench)]},
        {"name": "lacking", "title": "What is not there", "blocks": [*_lacking(bench)]},
    ]
    title = f"{len(bench.drives)} drives on one bench"
    return page_of("bench.html.jinja", sections, title=title, version=version("pitchpoint"))


def _tables(bench: Bench) -> Iterator[Block]:
    names = [name for name in HEADS if _there(bench, name)]
    heads, rows = _cells(bench, names)
    families = {drive.name: drive.family for drive in bench.drives}
    cells = [[row[""], families[row[""]], *(row[head] for head in heads[1:])] for row in rows]
    yield SectionTable(
        ["drive", "family", *heads[1:]],
        cells,
        caption="At the operating points",
        wide=True,
        names=2,
    )
    for sentence in (*_basis(bench), *_remarks(bench)):
        yield Paragraph(sentence, "note")


def _lacking(bench: Bench) -> Iterator[Block]:
    rows = [
        (drive.name, HEADS.get(name, name), show.pretty(why))
        for drive in bench.drives
        for name, why in drive.lacks.items()
    ]
    if rows:
        yield SectionTable(
            ["drive", "figure", "why"], rows, caption="Figures that drives lack", names=3
        )
    else:
        yield Paragraph("Every drive has every figure.")


def _keys(bench: Bench) -> list[plot.Key]:
    """A line for each drive."""
    return [
        plot.Key(
            drive.name,
            plot.PALETTE[at % len(plot.PALETTE)],
            plot.DASHES[at // len(plot.PALETTE) % len(plot.DASHES)],
        )
        for at, drive in enumerate(bench.drives)
    ]


def _panel(bench: Bench) -> plot.Panel:
    keys = _keys(bench)
    over_load = ("part of the load [%]", LOADS)
    over_speed = ("part of the speed [%]", SPEEDS)
    return plot.Panel(
        "On the same axes",
        [
            _curves(bench, keys, "efficiency", "Efficiency over the load", *over_load),
            _curves(
                bench, keys, "back_efficiency", "Efficiency backwards over the load", *over_load
            ),
            _curves(bench, keys, "efficiency_over_speed", "Efficiency over the speed", *over_speed),
            _curves(
                bench,
                keys,
                "back_efficiency_over_speed",
                "Efficiency backwards over the speed",
                *over_speed,
            ),
            _scatter(bench, keys, "loss", "Loss over mass"),
            _scatter(bench, keys, "torsional_stiffness", "Stiffness over mass"),
        ],
    )


def _curves(
    bench: Bench, keys: Sequence[plot.Key], name: str, title: str, axis: str, parts: Sequence[float]
) -> plot.Figure:
    """A line of each drive over its load or speed."""
    percents = 100.0 * np.array(parts)
    traces = [
        plot.legend_line(key, percents, 100.0 * getattr(drive, name), "%", mode="lines+markers")
        for key, drive in zip(keys, bench.drives, strict=True)
    ]
    return plot.Figure(
        f"bench_{name}",
        title,
        traces,
        plot.layout(axis, "η [%]"),
        "" if all(np.isfinite(getattr(one, name)).all() for one in bench.drives) else _GAPS,
        tuple(keys),
        missing="No drive has an efficiency here.",
    )


_GAPS = (
    "A line has a gap where friction holds its drive, or where its efficiency could not be computed: the "
    "remarks say why."
)


def _scatter(bench: Bench, keys: Sequence[plot.Key], name: str, title: str) -> plot.Figure:
    """A dot for each drive over its mass, in handy units."""
    mass, unit = (
        BENCHED["drive_mass"],
        "%" if name == "loss" else show.display_unit(BENCHED[name].display),
    )
    traces: list[plot.Trace] = []
    for key, drive in zip(keys, bench.drives, strict=True):
        value, weight = _value(drive, name), drive.figures.get("drive_mass", np.nan)
        if np.isfinite(value) and np.isfinite(weight):
            marks: dict[str, Any] = {
                "mode": "markers+text" if len(keys) <= _FEW else "markers",
                "text": [plot.plotly_text(key.label)],
                "textposition": "top center",
                "marker": {"size": 9, "color": key.colour},
                "cliponaxis": False,
            }
            traces.append(
                plot.legend_line(key, [float(mass.displayed(weight))], [value], unit, **marks)
            )
    words = f"loss [{unit}]" if name == "loss" else f"{HEADS[name]} [{unit}]"
    scales = {"xaxis": {"type": "log"}, "yaxis": {"type": "log"}}
    return plot.Figure(
        f"bench_{name}",
        title,
        traces,
        plot.layout(f"mass [{show.display_unit(mass.display)}]", words, **scales),
        "Both axes in equal ratios.",
        tuple(keys) if len(keys) > _FEW else (),
        missing="No drive has both.",
    )


def _value(drive: BenchedDrive, name: str) -> float:
    """A figure in the unit in which it is shown; the loss in percent."""
    if name == "loss":
        return 100.0 * (1.0 - drive.figures.get("efficiency", np.nan))
    return float(BENCHED[name].displayed(drive.figures.get(name, np.nan)))
