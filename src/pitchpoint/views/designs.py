"""Designs beside each other in words: inputs that differ, main results and by how much they differ."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pitchpoint.analyses.main_figures import efficiency_coverage
from pitchpoint.runs.compared_designs import MainFigure, main_results, shared_laws
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import law_title
from pitchpoint.views.inputs import FOLLOWING, printed_input_rows
from pitchpoint.views.point import ratio_words

__all__ = [
    "NOTHING",
    "RATIO",
    "UNLIKE",
    "Compared",
    "bases",
    "differing",
    "figure_row",
    "input_tables",
    "law_words",
    "left_by_rounding",
    "named_inputs",
    "of_several",
    "result_table",
]

NOTHING = "–"
"""Stands for what a design does not have."""

_FEW_DESIGNS = 3
"""Most designs of which differences have room beside their results."""

_ROUNDING = 1e-6
"""Part of a result below which a difference is what solvers leave."""


@dataclass(frozen=True)
class Compared:
    """A table of a comparison.

    Attributes:
        head: of its columns.
        rows: cells in words.
        names: columns before those of the designs.
    """

    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    names: int


def input_tables(outcomes: Mapping[str, Outcome]) -> tuple[Compared, Compared]:
    """Inputs that differ, and what follows from them: table, key, and words of each design.

    What others lack and nobody gave is left out: a bearing that one design has brings many such values.
    """
    rows: dict[tuple[str, str], dict[str, str]] = {}
    stated: set[tuple[str, str]] = set()
    for design, outcome in outcomes.items():
        for row in printed_input_rows(outcome.manifest):
            words = show.pretty(row["value"]) or NOTHING
            rows.setdefault((row["table"], row["key"]), {})[design] = words
            if row["status"] != "default":
                stated.add((row["table"], row["key"]))
    differing = [
        (table, key, *(by_design.get(name, NOTHING) for name in outcomes))
        for (table, key), by_design in rows.items()
        if len({by_design.get(name, NOTHING) for name in outcomes}) > 1
        and (len({*by_design.values()}) > 1 or (table, key) in stated)
    ]
    head = ("table", "key", *outcomes)
    following = [row for row in differing if row[0] in FOLLOWING]
    inputs = sorted((row for row in differing if row not in following), key=_standing)
    return Compared(head, inputs, 2), Compared(head, following, 2)


_DEMANDS = ("operation", "strength", "materials", "lubricant", "roughness", "models")
"""Tables on which the numbers of any gears stand: where these differ, gears are no longer compared alone."""

_DETAILS = ("addendum", "dedendum", "fillet_radius", "tip_alteration")
"""Keys of gears that are read last."""


def _standing(row: Sequence[str]) -> tuple[int, bool]:
    """Place of an input among those that differ."""
    table, key = row[:2]
    place = _DEMANDS.index(table) if table in _DEMANDS else len(_DEMANDS)
    return place, key.rpartition(".")[2] in _DETAILS


def differing(outcomes: Mapping[str, Outcome]) -> dict[str, Compared]:
    """Tables of the inputs by title; that of gears, materials and oils only where they differ."""
    inputs, following = input_tables(outcomes)
    also = {"Gears, materials and oils that differ by them": following} if following.rows else {}
    return {"Inputs that differ": inputs, **also}


def named_inputs(table: Compared) -> list[tuple[str, ...]]:
    """Rows of a table of inputs with table and key as one name."""
    return [(f"{where}, {key}", *cells) for where, key, *cells in table.rows]


def law_words(outcomes: Mapping[str, Outcome], most: int | None = None) -> str:
    """Under which friction laws the designs are compared, so many at most, as a sentence."""
    shared = shared_laws(outcomes)[:most]
    if shared:
        law_names = [law_title(next(iter(outcomes.values())), law) for law in shared]
        return f"Friction in every design: {'; '.join(law_names)}."
    labelled = [
        f"{name}: {law_title(outcome, outcome.manifest['laws'][0]['name'])}"
        for name, outcome in outcomes.items()
        if outcome.manifest["laws"]
    ]
    return f"The designs share no friction law; each stands under its first one, {'; '.join(labelled)}."


def result_table(outcomes: Mapping[str, Outcome]) -> Compared:
    """Main results of the designs but those that rounding leaves; of few designs differences from the first.

    Args:
        outcomes: by design.
    """
    reference, *others = outcomes if len(outcomes) <= _FEW_DESIGNS else [*outcomes][:1]
    figures = [entry for entry in main_results(outcomes) if not left_by_rounding(entry)]
    by_law = len({entry.law for entry in figures if entry.law}) > 1
    rows = [
        figure_row(
            entry,
            f"{entry.title} ({entry.law})" if by_law and entry.law else entry.title,
            outcomes,
            others,
        )
        for entry in figures
    ]
    head = ("result", *outcomes, *(f"{entry} against {reference}" for entry in others))
    blank = ("",) * len(others)
    return Compared(head, [*((*row, *blank) for row in bases(outcomes)), *rows], 1)


def figure_row(
    figure: MainFigure, title: str, outcomes: Mapping[str, Outcome], others: Sequence[str]
) -> tuple[str, ...]:
    """A figure in words: title with unit, value of each design, differences of some from the first one.

    Args:
        figure: that some of the designs have.
        title: words for it.
        outcomes: by design.
        others: designs whose differences from the first one are told.
    """
    reference = next(iter(outcomes))
    return (
        show.bracketed(title, figure.variable),
        *(_value(figure, design) for design in outcomes),
        *(
            UNLIKE
            if {reference, design} <= {*figure.values}
            and _unlike(figure, outcomes[reference], outcomes[design])
            else _difference(figure, reference, design)
            for design in others
        ),
    )


UNLIKE = "of other things"

_OF_POWER = ("efficiency", "loss", "input_torque", "torque_ripple")
"""Parts of the names of figures that are of what the efficiency is of."""

_OF_BODIES = ("reaction", "contact_ratio", "bearing_load")
"""Parts of the names of figures that are of the bodies of a drive."""


def _unlike(figure: MainFigure, first: Outcome, other: Outcome) -> bool:
    """True for figures of which one design has those of its teeth and another those of its drive or bodies.

    What is of other things has a difference, but it says nothing of the designs.
    """
    basis: Callable[[Outcome], str]
    if any(part in figure.name for part in _OF_POWER):
        basis = _efficiency
    elif "backlash" in figure.name:
        basis = _tolerances
    elif figure.part == "torsion" or "stiffness" in figure.name:
        basis = _yields
    elif any(part in figure.name for part in _OF_BODIES):
        basis = _bodies
    else:
        return False
    return basis(first) != basis(other)


def of_several(table: Compared, designs: int) -> tuple[Compared, int]:
    """Rows that two designs have or that demand something of one, and how many others one alone has."""
    ends = table.names, table.names + designs
    rows = [
        row
        for row in table.rows
        if row[0] in _DEMANDS or sum(cell != NOTHING for cell in row[slice(*ends)]) > 1
    ]
    return replace(table, rows=rows), len(table.rows) - len(rows)


def bases(outcomes: Mapping[str, Outcome]) -> Iterator[tuple[str, ...]]:
    """Ratios that differ, and what efficiencies and stiffnesses are of, where that is not the whole."""
    ratios = [ratio_words(outcome) or NOTHING for outcome in outcomes.values()]
    if len({*ratios}) > 1:
        yield (RATIO, *ratios)
    for words, basis in (
        ("efficiency is that of the", _efficiency),
        ("stiffness is that of", _yields),
    ):
        cells = [basis(outcome).partition(";")[0] for outcome in outcomes.values()]
        if any(cells):
            yield (words, *(outcome or NOTHING for outcome in cells))


RATIO = "ratio, speed of the driver over that of the output"


def _efficiency(outcome: Outcome) -> str:
    operation = outcome.parts.get("operation")
    if operation is None or "mean_efficiency" not in operation:
        return ""
    of = efficiency_coverage(operation).partition(":")[0] or "whole drive"
    lacks = operation["mean_efficiency"].attrs.get("lacks")
    return f"{of}, without the {lacks}" if lacks else of


def _bodies(outcome: Outcome) -> str:
    return ", ".join(outcome.manifest["members"])


def _tolerances(outcome: Outcome) -> str:
    """Whether a backlash is by tolerances or as drawn."""
    parts = (outcome.parts.get(name) for name in ("reflected", "inspection"))
    return str(
        max((part.sizes.get("case", 1) for part in parts if part is not None), default=1) > 1
    )


def _yields(outcome: Outcome) -> str:
    torsion = outcome.parts.get("torsion")
    if torsion is None:
        return ""
    attributes = torsion["torsional_stiffness"].attrs
    return f"{attributes.get('covers', '')}{attributes.get('assumed', '')}"


def _shown(figure: MainFigure, value: float) -> float:
    return float(show.displayed(figure.variable, value))


def left_by_rounding(figure: MainFigure) -> bool:
    """True if all values are shown as zero; that of a temperature is as good as any other one."""
    values = (_shown(figure, value) for value in figure.values.values())
    return figure.variable.kind != "temperature" and not any(values)


def _value(figure: MainFigure, design: str) -> str:
    if design not in figure.values:
        return NOTHING
    return show.number_text(_shown(figure, figure.values[design]))


def _difference(figure: MainFigure, first: str, design: str) -> str:
    """Difference from the first design; in points of a percentage, else in its unit and in percent."""
    if first not in figure.values or design not in figure.values:
        return NOTHING
    before, now = (_shown(figure, figure.values[name]) for name in (first, design))
    change = now - before
    if figure.variable.display == "%":
        return f"{show.signed(change, 2)} points"
    if abs(change) <= _ROUNDING * max(abs(before), abs(now)):
        return "0"
    signed = show.number_text(change) if change < 0.0 else f"+{show.number_text(change)}"
    part = 100.0 * np.divide(change, abs(before)) if before else np.inf
    return f"{signed} ({show.signed(part, 1)} %)" if abs(part) < 1000.0 else signed
