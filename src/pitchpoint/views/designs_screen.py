"""The first screen of a comparison: what cannot be, main figures beside each other, inputs behind them."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, zip_longest

from pitchpoint.core.doubts import as_doubt
from pitchpoint.runs.compared_designs import MainFigure, main_results, shared_laws
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.columns import fitted, lines_of
from pitchpoint.views.designs import (
    NOTHING,
    RATIO,
    bases,
    figure_row,
    input_tables,
    law_words,
    left_by_rounding,
    of_several,
    result_table,
)
from pitchpoint.views.first_screen import Line, Style, lines_within, wrapped
from pitchpoint.views.point import by_members

__all__ = ["COMPARED_LINES", "designs_screen"]

COMPARED_LINES = 24
"""Lines of the first screen of a comparison."""

_FAILS, _DOUBTS = 3, 2
"""Most sentences on what fails, and on what is doubtful."""

_FEW = 3
"""Most designs whose notes take two lines."""

_FIGURES = 8
"""Lines that are left to figures, if there are so many, before notes become shorter."""

SHORT = {
    ("operation", "mean_efficiency"): "efficiency",
    ("operation", "mean_input_torque"): "input torque",
    ("operation", "mean_loss"): "loss",
    ("strength", "least_flank_safety"): "safety of flanks",
    ("strength", "least_root_safety"): "safety of roots",
    ("load_limits", "goodman_safety"): "safety of the flexspline",
    ("strength", "largest_contact_stress"): "stress of flanks",
    ("strength", "largest_root_stress"): "stress of roots",
    ("cycle", "pressure"): "Hertz pressure",
    ("cycle", "lambda_ratio"): "film ratio",
    ("load_limits", "bearing_life"): "life of the bearing",
    ("reflected", "output_backlash"): "backlash",
    ("operation", "circumferential_backlash"): "backlash",
    ("torsion", "torsional_stiffness"): "stiffness",
    ("torsion", "angular_transmission_error_range"): "transmission error",
    ("kinematic_error", "kinematic_error_range"): "kinematic error",
    ("torsion", "catalogue_lost_motion"): "lost motion",
    ("reflected", "drive_mass"): "mass",
    ("reflected", "reflected_inertia"): "inertia",
    ("running", "no_load_torque"): "input without load",
    ("running", "starting_torque"): "input to start",
    ("running", "back_driving_torque"): "output to move back",
    ("back_driving", "mean_efficiency"): "efficiency backwards",
    ("operation", "torque_ripple"): "torque ripple",
    ("operation", "contact_ratio"): "contact ratio",
}
"""Figures that answer for most designs, under short names, in the order in which they stand."""

_OF_MOST = {*(part for part, _ in SHORT), "inspection", "bodies", "joint", "stiffness"}
"""Analyses that most cases have; what others tell was asked for, and stands with all its main figures."""


def designs_screen(outcomes: Mapping[str, Outcome], report: str, width: int) -> list[Line]:
    """Lines that tell what differs in the answers of some designs, and what is behind `--full`.

    Args:
        outcomes: by design.
        report: where the page lies that holds everything else.
        width: of the screen [characters].
    """
    rows, alike = _answers(outcomes)
    head = [
        *_told(outcomes, "implausible", "fails", _FAILS, width),
        *(Line(text, "title") for text in lines_within(_title([*outcomes]), width, 2)),
        *_told(outcomes, "warnings", "doubt", _DOUBTS, width),
    ]
    notes = [law_words(outcomes, 1), *_basis(outcomes), *_same(alike)]
    for most in (2, 1)[len(outcomes) > _FEW :]:  # figures come first
        foot = [
            *chain(*(lines_within(text, width, most) for text in notes)),
            *_inputs(outcomes, width, most),
        ]
        room = COMPARED_LINES - len(head) - len(foot) - 2
        if room >= _FIGURES:
            break
    table, shown = _fitting(rows, [*outcomes], room, width)
    behind = show.first_clauses(_behind(outcomes, shown + len(alike)), width)
    return [
        *head,
        *(Line(text, "figure") for text in table),
        *map(Line, foot),
        Line(behind),
        Line(report),
    ]


def _title(names: Sequence[str]) -> str:
    return f"{names[1]} against {names[0]}" if len(names) == 2 else ", ".join(names)


def _told(
    outcomes: Mapping[str, Outcome], kind: str, style: Style, most: int, width: int
) -> Iterator[Line]:
    """Briefs of what fails or is doubtful, the worst of each design first; how many more there are."""
    start = "Doubtful: " if style == "doubt" else ""
    every = [
        [
            f"{start}{name}: {by_members(outcome, show.pretty(as_doubt(text).brief))}"
            for text in outcome.manifest[kind]
        ]
        for name, outcome in outcomes.items()
    ]
    ranked = [text for texts in zip_longest(*every) for text in texts if text is not None]
    shown = ranked if len(ranked) <= most else ranked[: most - 1]
    lines = 2 if style == "doubt" else 1
    yield from (Line(line, style) for text in shown for line in lines_within(text, width, lines))
    if hidden := len(ranked) - len(shown):
        yield Line(f"{hidden} more of this kind by --full.", style)


def _answers(outcomes: Mapping[str, Outcome]) -> tuple[list[tuple[str, ...]], list[str]]:
    """Rows of the figures that differ, the ratio first; names of those that are the same in all designs."""
    others = [*outcomes][1:] if len(outcomes) == 2 else []
    ratios = [
        ("ratio", *row[1:], *([""] * len(others))) for row in bases(outcomes) if row[0] == RATIO
    ]
    rows, alike = [], []
    for figure in _main_figures(outcomes):
        name = _short(figure)
        row = figure_row(figure, name, outcomes, others)
        if len({*row[1 : len(outcomes) + 1]}) > 1:
            rows.append(row)
        else:
            alike.append(f"{name} {row[1]} {show.display_unit(figure.variable.display)}".strip())
    return [*ratios, *rows], alike


def _main_figures(outcomes: Mapping[str, Outcome]) -> list[MainFigure]:
    """Figures of more than one design that stand on the first screen, in their order."""
    shared = shared_laws(outcomes)[:1]
    order = [*SHORT]
    every = [
        one
        for one in main_results(outcomes)
        if len(one.values) > 1
        and one.law in ("", *shared)
        and not left_by_rounding(one)
        and ((one.part, one.name) in SHORT or one.part not in _OF_MOST)
    ]
    last = order.index(("operation", "mean_loss")) + 0.5
    return sorted(
        every, key=lambda one: order.index(at) if (at := (one.part, one.name)) in SHORT else last
    )


def _short(figure: MainFigure) -> str:
    name = SHORT.get((figure.part, figure.name))
    return figure.title if name is None else ", ".join(filter(None, (name, figure.place)))


def _fitting(
    rows: Sequence[Sequence[str]], designs: Sequence[str], room: int, width: int
) -> tuple[list[str], int]:
    """Lines of as many figures as there is room for, and how many these are.

    Figures are rows where all designs stand beside each other, else columns.
    """
    head = ["", *designs, *(["difference"] if len(designs) == 2 else [])]
    cells = [dict(zip(head, row, strict=True)) for row in rows]
    for count in range(len(cells), 0, -1):
        if len(fitted(cells[:count], head, width)) == 1:
            lines = [*lines_of(cells[:count], head, width)]
            if len(lines) <= room:
                return lines, count
    return _turned(rows, designs, room, width)


def _turned(
    rows: Sequence[Sequence[str]], designs: Sequence[str], room: int, width: int
) -> tuple[list[str], int]:
    """The same with a line for each design and a column for each figure."""
    for count in range(len(rows), 0, -1):
        head = ["", *(row[0] for row in rows[:count])]
        cells = [
            {"": name} | {row[0]: row[place] for row in rows[:count]}
            for place, name in enumerate(designs, 1)
        ]
        if count == 1 or len(fitted(cells, head, width)) == 1:
            return _cut([*lines_of(cells, head, width)], room), count
    return [], 0


def _cut(lines: list[str], room: int) -> list[str]:
    if len(lines) <= room:
        return lines
    return [*lines[: room - 1], f"{len(lines) - room + 1} more designs by --full."]


def _basis(outcomes: Mapping[str, Outcome]) -> Iterator[str]:
    """What efficiency and stiffness are of, where that is not the same; else what the efficiency is of."""
    for words, *cells in bases(outcomes):
        designs: dict[str, list[str]] = {}
        for name, what in zip(outcomes, cells, strict=True):
            if what != NOTHING:
                designs.setdefault(what, []).append(name)
        sentences = "; ".join(f"{what} ({', '.join(names)})" for what, names in designs.items())
        if words != RATIO and len(designs) > 1:
            yield f"{show.sentence(words, whole=False)}: {sentences}."
        elif words.startswith("efficiency"):
            yield f"{show.sentence(words, whole=False)} {next(iter(designs))}."


def _same(alike: Sequence[str]) -> Iterator[str]:
    if alike:
        yield f"The same in all: {'; '.join(alike)}."


def _inputs(outcomes: Mapping[str, Outcome], width: int, most: int) -> list[str]:
    """Inputs that differ, with their values of two designs, as many as a few lines hold."""
    table, _ = of_several(input_tables(outcomes)[0], len(outcomes))
    differing = [
        f"{row[0]}.{row[1]}" + (f" {row[2]} → {row[3]}" if len(outcomes) == 2 else "")
        for row in table.rows
    ]
    for count in range(len(differing), 0, -1):
        hidden = f"; {len(differing) - count} more by --full" if count < len(differing) else ""
        lines = wrapped(f"Inputs that differ: {'; '.join(differing[:count])}{hidden}.", width)
        if len(lines) <= most + 1:
            return lines
    return ["Inputs that differ: by --full."] if differing else ["No input differs."]


def _behind(outcomes: Mapping[str, Outcome], shown: int) -> str:
    """What --full has beyond that."""
    results = len(result_table(outcomes).rows) - shown
    inputs = sum(len(table.rows) for table in input_tables(outcomes))
    warnings = sum(len(outcome.manifest["warnings"]) for outcome in outcomes.values())
    counts = {
        "more results": results,
        f"input{'s' * (inputs > 1)} that differ{'s' * (inputs == 1)}": inputs,
        f"warning{'s' * (warnings > 1)} in full": warnings,
    }
    return f"By --full: {', '.join(f'{count} {words}' for words, count in counts.items() if count > 0)}"
