"""The first screen of a run: what fails or is doubtful, then figures that answer, in a dozen short lines."""

import shlex
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from math import isfinite
from pathlib import Path
from typing import Literal

import xarray as xr

from pitchpoint.analyses.main_figures import of_contact, point_by_valid_laws
from pitchpoint.core.doubts import as_doubt
from pitchpoint.results.target_rows import verdict_sentence
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import laws
from pitchpoint.views.inputs import input_number, input_words
from pitchpoint.views.point import by_members, driver_speed_ratio, ratio_words
from pitchpoint.views.section import (
    OF_MESHES,
    KeyFigure,
    Page,
    figures_by_members,
    key_figures,
    page_words,
    stages_together,
    variant_warnings,
)
from pitchpoint.views.section_registry import in_order
from pitchpoint.views.sections.studies import is_swept, marked, swept_place

__all__ = [
    "FEW_LINES",
    "Line",
    "Style",
    "aligned",
    "beside_each_other",
    "first_screen",
    "lines_within",
    "most_lines",
    "swept_beside",
    "wrapped",
]

FEW_LINES = 12
"""Lines of a first screen."""

_OF_SETS = 2
"""Further ones for planetary sets: their diameter, and their backlash at the output."""

_DOUBTS, _OF_DOUBTS = 2, 4
"""Sentences on what is doubtful, one more where something fails, and lines that they may take in all.

More would push what is asked first off the screen: safeties, backlash, stiffness.
"""

Style = Literal["title", "fails", "doubt", "figure", "note"]


@dataclass(frozen=True)
class Line:
    """A line of the screen: its text, and what it is."""

    text: str
    style: Style = "note"


MOST_SWEPT = 24
"""Rows of a sweep that still stand on a first screen."""

SWEPT_HEADS = {
    "mean_efficiency": "efficiency",
    "mean_input_torque": "input",
    "mean_loss": "loss",
    "mean_friction": "friction",
    "min_lambda_ratio": "film ratio",
    "least_flank_safety": "S flank",
    "least_root_safety": "S root",
}
"""What a sweep on a first screen has of its points, under short heads."""


def first_screen(
    outcomes: Mapping[str, Outcome], report: Path, width: int, *, tables: bool = True
) -> list[Line]:
    """Lines that answer for one variant; for several only what fails or is doubtful, see `beside_each_other`.

    Args:
        outcomes: by variant.
        report: the page that holds everything else.
        width: of the screen, in characters; no line is longer, and no number cut.
        tables: False below the tables of all sections: then every figure stands here.
    """
    outcome = next(iter(outcomes.values()))
    few = most_lines(outcomes)
    title = _title(outcome, len(outcomes))
    at = _operation(outcome) if len(outcomes) == 1 else ""
    doubts = _doubts(outcomes, width)
    below = _more(outcomes, report, width) if tables else [Line(f"Report: {report}")]
    rows = [*_rows_met(outcomes), *_missed(outcomes, report.parent, width)]
    folded = [line for text in rows for line in wrapped(text, width)]
    if 1 + len(doubts) + len(folded) + len(below) > few:
        folded = [show.first_clauses(text, width) for text in rows]
    foot = [*map(Line, folded), *below]
    room = few - len(doubts) - len(foot) - bool(at)
    titles = wrapped(title, width)
    titles = titles if len(titles) <= min(room, 2) else [show.first_clauses(title, width)]
    head = [Line(text, "title") for text in titles]
    head += [Line(show.first_clauses(at, width))] if at else []
    key_figures = _key_figures(outcome) if len(outcomes) == 1 else []
    room = max(room - len(titles), 0)
    figures = _fitting(key_figures, room, width) if tables else _in_full(key_figures, width)
    fails, doubtful = (
        [line for line in doubts if line.style == style] for style in ("fails", "doubt")
    )
    return [*fails, *head, *doubtful, *figures, *foot]


def most_lines(outcomes: Mapping[str, Outcome]) -> int:
    """Lines of a first screen at most: a dozen, of planetary sets with their diameter and backlash.

    Args:
        outcomes: by variant.
    """
    of_sets = [outcome for outcome in outcomes.values() if outcome.manifest.get("trains")]
    return FEW_LINES + _OF_SETS * bool(of_sets and len(outcomes) == 1)


def beside_each_other(outcomes: Mapping[str, Outcome]) -> list[dict[str, str]]:
    """Values of the key figures of several variants: a row for each figure, a column for each variant."""
    figures = {
        variant: figures_by_members(outcome, key_figures(in_order(), outcome))
        for variant, outcome in outcomes.items()
    }
    values = {
        variant: {figure.name: figure.beside or figure.value for figure in every}
        for variant, every in figures.items()
    }
    ranked = sorted(chain(*figures.values()), key=lambda figure: figure.order)
    names = dict.fromkeys(figure.name for figure in ranked)
    rows = [
        {"": name} | {variant: of_variant.get(name, "–") for variant, of_variant in values.items()}
        for name in names
    ]
    has_efficiency = {
        v: "%" in of_variant.get("Efficiency", "") for v, of_variant in values.items()
    }
    others = {
        v: _by_other_laws(outcome) if has_efficiency[v] else "" for v, outcome in outcomes.items()
    }
    if any(others.values()):
        at = 1 + [*names].index("Efficiency")
        rows.insert(at, {"": "by other laws"} | {v: words or "–" for v, words in others.items()})
    return [*_differing_bases(outcomes), *rows]


def _by_other_laws(outcome: Outcome) -> str:
    """Efficiency by the other friction laws that the case names, whether in their range or not."""
    if "operation" not in outcome.parts or of_contact(outcome.parts["operation"]):
        return ""
    data, shown_law = outcome.parts["operation"], _law(outcome)
    values = zip(laws(data), data["mean_efficiency"].values[:, 0], strict=True)
    efficiencies = ((law, value) for law, value in values if law != shown_law and isfinite(value))
    return "; ".join(
        f"{show.quantity('mean_efficiency', value)} {law}" for law, value in efficiencies
    )


def _differing_bases(outcomes: Mapping[str, Outcome]) -> Iterator[dict[str, str]]:
    """Ratios of drives of several meshes; friction law and mean of variants where these are not the same."""
    if any(design.manifest.get("stages") for design in outcomes.values()):
        yield {"": "Ratio"} | {v: ratio_words(outcome) or "–" for v, outcome in outcomes.items()}
    by_basis = {
        "Friction": {variant: _law(outcome) for variant, outcome in outcomes.items()},
        "Mean over": {
            variant: show.pretty(str(outcome.manifest.get("averaging", "–")))
            for variant, outcome in outcomes.items()
        },
    }
    yield from (
        {"": name} | cells for name, cells in by_basis.items() if len({*cells.values()}) > 1
    )


def _law(outcome: Outcome) -> str:
    """Friction law by which figures of an outcome are."""
    return (
        str(point_by_valid_laws(outcome.parts)["law"].values[0])
        if "operation" in outcome.parts
        else "–"
    )


def swept_beside(outcomes: Mapping[str, Outcome]) -> list[list[dict[str, str]]]:
    """Sweeps of the command line: for each the rows of its points, by variant and friction law.

    None of a sweep of more rows than a first screen has room for.
    """
    sweeps: dict[str, list[dict[str, str]]] = {}
    for variant, outcome in outcomes.items():
        for name, data in outcome.parts.items():
            if is_swept(name, data):
                named = {"variant": variant} if len(outcomes) > 1 else {}
                rows = _swept(data, solved="film" in outcome.parts)
                sweeps.setdefault(name, []).extend(named | row for row in rows)
    return [rows for rows in sweeps.values() if len(rows) <= MOST_SWEPT]


def _swept(data: xr.Dataset, *, solved: bool) -> Iterator[dict[str, str]]:
    """A row for each point under each law; beside solved films that of a formula is called so."""
    points, laws = (range(data.sizes[dim]) for dim in ("point", "law"))
    units = {name: show.unit_of(name, data) for name in SWEPT_HEADS}
    heads = {n: f"{head} [{units[n]}]" if units[n] else head for n, head in SWEPT_HEADS.items()}
    if solved:
        heads["min_lambda_ratio"] = "film ratio by formula"
    shown_heads = {n: head for n, head in heads.items() if n in data and not data[n].isnull().all()}
    for point in points:
        for law in laws:
            named = {"law": str(data["law"].values[law])} if len(laws) > 1 else {}
            values = {name: float(data[name].values[law, point]) for name in shown_heads}
            cells = {
                shown_heads[name]: marked(name, _cell(name, value, data), data, law, point)
                for name, value in values.items()
            }
            yield swept_place(data, point) | named | cells


def _cell(name: str, value: float, data: xr.Dataset) -> str:
    return show.quantity(name, value, with_unit=False, of=data) if isfinite(value) else "–"


def _title(outcome: Outcome, variants: int) -> str:
    manifest = outcome.manifest
    return (
        f"{manifest['title']} ({manifest['variant'] if variants == 1 else f'{variants} variants'})"
    )


def _operation(outcome: Outcome) -> str:
    """Speed, load and temperature in few words; of a drive of several meshes its ratio, else the law."""
    speed, torque, force, temperature = (
        show.pretty(input_words(outcome, "operation", key))
        for key in ("speed", "torque", "force", "temperature")
    )
    manifest, ratio, law = outcome.manifest, driver_speed_ratio(outcome), ""
    loaded, load = manifest["loaded"], torque or force
    if manifest.get("stages") and isfinite(ratio):
        speed_out = show.quantity(
            "output_speed", input_number(outcome, "operation", "speed") / ratio
        )
        loaded, load = f"{loaded} at {speed_out}", f"{load}, ratio {ratio_words(outcome)}"
    elif "operation" in outcome.parts:
        law = f", friction {point_by_valid_laws(outcome.parts)['law'].values[0]}"
    return f"{manifest['driver']} at {speed}, {loaded} with {load}, oil {temperature}{law}"


def _doubts(outcomes: Mapping[str, Outcome], width: int) -> list[Line]:
    """What fails, then what is doubtful, a line each; how many more there are."""
    fails = _of_variants(outcomes, "implausible")
    doubts = _of_variants(outcomes, "warnings")
    every: list[list[Line]] = [
        *([Line(line, "fails") for line in wrapped(text, width)] for text in fails),
        *([Line(line, "doubt") for line in wrapped(f"Doubtful: {text}", width)] for text in doubts),
    ]
    most = _DOUBTS + bool(fails)
    if fails:  # room for what is asked first
        every[len(fails) :] = [
            [Line(show.first_clauses(f"Doubtful: {text}", width), "doubt")] for text in doubts
        ]
    shown = every if len(every) <= most else every[: most - 1]
    while sum(map(len, shown)) > _OF_DOUBTS:
        shown = shown[:-1]
    hidden = len(every) - len(shown)
    remainder = "1 more of this kind is" if hidden == 1 else f"{hidden} more of this kind are"
    return [*chain(*shown), *[Line(f"{remainder} in the report.", "doubt")] * (hidden > 0)]


def _key_figures(outcome: Outcome) -> list[KeyFigure]:
    """Figures of one variant in their order, those of a planetary set by its members."""
    return figures_by_members(outcome, stages_together(key_figures(in_order(), outcome)))


def _of_variants(outcomes: Mapping[str, Outcome], kind: str) -> list[str]:
    """Briefs of all variants, each once and the worst of each first, those of some with their variants."""
    by_text = variant_warnings(
        outcomes, kind, lambda one, text: by_members(one, show.pretty(as_doubt(text).brief))
    )
    return [
        text if len(names) == len(outcomes) else f"{_few(names, len(outcomes))}: {text}"
        for text, names in by_text.items()
    ]


def _few(names: Sequence[str], variants: int) -> str:
    """Some of the variants by name where that is short, else how many they are."""
    return names[0] if len(names) == 1 else f"{len(names)} of {variants} variants"


def _in_full(figures: Sequence[KeyFigure], width: int) -> list[Line]:
    """All figures; those of meshes, whose names are long, in columns of their own."""
    of_drive = [figure for figure in figures if figure.order < OF_MESHES]
    return [*aligned(of_drive, width), *aligned(figures[len(of_drive) :], width)]


def _fitting(figures: Sequence[KeyFigure], room: int, width: int) -> list[Line]:
    """Figures on so many lines; where there are more, the last line names them."""
    if len(figures) <= room or room == 0:
        return aligned(figures[:room], width)
    return [*aligned(figures[: room - 1], width), Line(_left_out(figures[room - 1 :], width))]


def _left_out(figures: Sequence[KeyFigure], width: int) -> str:
    """Figures that have no line of their own, as many by name as a line holds, and what shows them."""
    names = [show.one_line(f"{figure.name[:1].lower()}{figure.name[1:]}") for figure in figures]
    for count in range(len(names), 0, -1):
        hidden = [f"{len(names) - count} more"] if count < len(names) else []
        text = f"By --full: {', '.join([*names[:count], *hidden])}"
        if len(text) <= width:
            return text
    return f"{len(names)} more by --full"


def aligned(figures: Sequence[KeyFigure], width: int) -> list[Line]:
    """Lines of figures: names, values, and what goes with them as far as a line holds it.

    Args:
        figures: in order.
        width: of the screen [characters].
    """
    if not figures:
        return []
    names = [show.one_line(figure.name) for figure in figures]
    values = [show.one_line(figure.value) for figure in figures]
    name_width = max(map(len, names))
    value_width = max((len(value) for value in values if len(value) <= width // 5), default=0)
    lines = []
    for figure, name, value in zip(figures, names, values, strict=True):
        begin = f"{name:<{name_width}}  {value:<{value_width}}  "
        room = width - len(begin)
        if room < 0:  # words in place of a number
            lines.append(show.first_clauses(f"{name:<{name_width}}  {value}", width))
            continue
        lines.append(f"{begin}{show.whole_clauses(figure.detail.lstrip(',; '), room)}".rstrip())
    return [Line(text, "figure") for text in lines]


def _rows_met(outcomes: Mapping[str, Outcome]) -> Iterator[str]:
    """How many printed numbers each variant meets, of a published case."""
    for variant, outcome in outcomes.items():
        if outcome.rows:
            several = sum(bool(compared.rows) for compared in outcomes.values()) > 1
            start = f"{variant}: " if several else ""
            yield f"{start}{verdict_sentence(outcome.rows)}"


_PATH = 30
"""Longest folder that is named in a command on the first screen [characters]."""


def _missed(outcomes: Mapping[str, Outcome], folder: Path, width: int) -> Iterator[str]:
    """Which printed numbers are missed, as many as two lines hold, and what shows them all."""
    case, where = next(iter(outcomes.values())).manifest["case"], str(folder)
    command = f"pitchpoint compare {shlex.quote(where if len(where) <= _PATH else case)}"
    names = dict.fromkeys(
        row.quantity
        for outcome in outcomes.values()
        for row in outcome.rows
        if row.verdict == "miss" and row.kind != "reference"
    )
    for count in range(len(names), 0, -1):
        hidden = f"and {len(names) - count} more: {command}".replace(" ", "\u00a0")
        text = f"Missed: {'; '.join([*names][:count])}{f'; {hidden}' if count < len(names) else ''}"
        if len(wrapped(text, width)) <= 2:
            yield text
            return


def wrapped(text: str, width: int) -> list[str]:
    """A text on as many lines as it takes."""
    return textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False)


def lines_within(text: str, width: int, most: int) -> list[str]:
    """A text on so many lines at most; the last one ends early where there is more."""
    lines = wrapped(text, width)
    return [*lines[: most - 1], show.first_clauses(" ".join(lines[most - 1 :]), width)][
        : len(lines)
    ]


def _more(outcomes: Mapping[str, Outcome], report: Path, width: int) -> list[Line]:
    """Where everything else is: the page, and of which sections there are tables."""
    page = Page(outcomes, {})
    titles = [
        page_words(section.short, page)
        for section in in_order()
        if any(
            printed.rows or printed.line
            for outcome in outcomes.values()
            for printed in section.prints(outcome)
        )
    ]
    page_at, tables = f"Report: {report}", f"tables by --full: {', '.join(titles).lower()}"
    on_one_line = (f"{page_at}; {tables}", f"{page_at}; tables by --full")
    fits = next((text for text in on_one_line if len(text) <= width), None)
    return [Line(page_at), Line("Tables by --full")] if fits is None else [Line(fits)]
