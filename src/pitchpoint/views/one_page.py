"""The page that sums a report up on paper: gears, operating point, results, figures, doubts, assumptions."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from pitchpoint.analyses.main_figures import of_contact
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.designs import input_tables, named_inputs
from pitchpoint.views.figures import Figure, Key, Panel
from pitchpoint.views.first_screen import beside_each_other
from pitchpoint.views.inputs import printed_input_rows
from pitchpoint.views.point import (
    named_members,
    of_stage_by_bodies,
    ratio_words,
    way_in_a_turn,
)
from pitchpoint.views.section import (
    Page,
    Paragraph,
    SectionTable,
    figures_by_members,
    key_figures,
    made_of,
    stages_together,
    variant_warnings,
)
from pitchpoint.views.sections.answer import operation_words, sharing_words

__all__ = ["one_page"]

_RESULTS, _GEARS, _INPUTS, _COLUMNS, _DOUBTS, _ASSUMED = 15, 17, 10, 4, 4, 10
"""How much one page has room for: key figures, rows of the gears, inputs that differ, variants, doubts,
assumed inputs."""

_PICTURE = 20
"""Rows of a table that are as high as the picture and what stands under it."""

_LINE, _BESIDE = 280, 90
"""Characters of a doubt, and of what stands beside a key figure."""

_OF_MODELS = ("Friction", "Load sharing")
"""Facts that a comparison of designs tells beside its results."""

_CHOSEN = ("assumed", "fitted", "corrected")
_USUAL = ("default", "derived")


def one_page(page: Page, shown: Sequence[Panel]) -> dict[str, Any]:
    """What the template shows of the first variant, and of all where they stand side by side.

    Args:
        page: with the sections that are shown.
        shown: panels of the whole report, of which main figures are taken.
    """
    outcome = next(iter(page.outcomes.values()))
    manifest = outcome.manifest
    blocks = (
        []
        if page.designs
        else [
            block
            for section in page.sections
            for block in made_of([outcome], partial(section.sums_up, outcome))
        ]
    )
    tables = [block for block in blocks if isinstance(block, SectionTable)]
    if not any(table.caption == "Gears" for table in tables):
        summed_up = any(table.caption.startswith("Gears") for table in tables)
        tables = [_given_gears(outcome, _SUMMED_UP if summed_up else ()), *tables]
    if page.several:
        name = next(iter(page.outcomes))
        tables = [replace(t, head=[f"{t.head[0]}, {name}", *t.head[1:]]) for t in tables]
    remarks = [str(block.words) for block in blocks if isinstance(block, Paragraph)]
    doubts = _doubts(page)
    return {
        "of": next(iter(page.outcomes)) if page.several else "",
        "columns": _columns([] if page.designs else [_cut(table, _GEARS) for table in tables]),
        "facts": [] if page.designs else _facts(outcome),
        "differing": [table for table in (_standing(page), _differing(page)) if table],
        "results": _results(page, outcome),
        "more_variants": max(len(page.outcomes) - _COLUMNS, 0),
        "figures": list(_main_figures(page, shown)),
        "doubts": [show.first_clauses(text, _LINE) for text in doubts[:_DOUBTS]],
        "more_doubts": max(len(doubts) - _DOUBTS, 0),
        "assumed": "" if page.designs else _assumed(manifest),
        "remarks": remarks,
        "code": manifest["surroundings"].get("code", ""),
        "fingerprints": _fingerprints(page),
    }


def _columns(tables: Sequence[SectionTable]) -> tuple[list[SectionTable], list[SectionTable]]:
    """Tables of the gears on the left and, as far as these are longer, under the picture on the right."""
    left: list[SectionTable] = []
    right: list[SectionTable] = []
    heights = [0, _PICTURE]
    for table in tables:
        side = int(heights[0] > heights[1])
        (left, right)[side].append(table)
        heights[side] += len([*table.rows]) + 1
    return left, right


def _cut(table: SectionTable, room: int) -> SectionTable:
    """A table of as many rows as there is room for."""
    rows = list(table.rows)
    hidden = len(rows) - room
    if hidden <= 0:
        return replace(table, rows=rows)
    return replace(table, rows=rows[:room], caption=f"{table.caption}, {hidden} more below")


_SUMMED_UP = ("teeth", "module", "face_width", "profile_shift")
"""Keys whose values stand in the tables of gears."""


def _given_gears(outcome: Outcome, apart: Sequence[str]) -> SectionTable:
    """Inputs of gears that no section sums up, those left as they are by default apart."""
    rows = [
        (_plain_key(row["key"]), show.pretty(row["value"]))
        for row in printed_input_rows(outcome.manifest)
        if row["table"] in ("gears", "stages", "train")
        and row["status"] not in _USUAL
        and row["key"].rpartition(".")[2] not in apart
    ]
    return SectionTable(
        ["Drive, as given" if apart else "Gears, as given", ""], rows, caption="Gears"
    )


def _plain_key(key: str) -> str:
    """A dotted key of the case file in words; symbols, X_L say, stay."""
    *tables, name = key.split(".")
    stage = f"stage {tables[0]}, " if tables and tables[0].isdigit() else ""
    return stage + re.sub(r"(?<=\w\w)_", " ", name)


def _place_of(row: Mapping[str, str]) -> str:
    """What an input is of where its key alone does not say it."""
    table = row["table"].partition(" ")[0]
    return "" if table in ("gears", "stages") else f"{table}: "


def _of_member(key: str, outcome: Outcome) -> str:
    """Key of a material as the member of a mesh that it is of."""
    gear, *inner_keys = key.split(".")
    members = dict(zip(("gear_1", "gear_2"), named_members(outcome), strict=False))
    return " ".join([members.get(gear, gear), *inner_keys]).replace("_", " ")


def _facts(outcome: Outcome) -> list[tuple[str, str]]:
    """Operating point, materials, oil and models that the numbers stand on."""
    manifest = outcome.manifest
    rows = printed_input_rows(manifest)
    materials = [
        f"{_of_member(row['key'], outcome)} {show.pretty(row['value'])}"
        for row in rows
        if row["table"] == "materials"
    ]
    laws = "; ".join(str(law["title"]) for law in manifest["laws"])
    rated = [
        f"{_plain_key(row['key'])} {show.pretty(row['value'])}"
        for row in rows
        if row["table"] == "strength" and row["status"] not in _USUAL
    ]
    facts = [
        ("Operating point", operation_words(outcome)),
        ("Ratio", ratio_words(outcome)),
        (
            "Travel",
            "" if of_contact(outcome.parts.get("operation", ())) else way_in_a_turn(outcome),
        ),
        ("Materials", ", ".join(materials)),
        ("Rating", ", ".join(rated)),
        ("Oil", str(manifest["oil"])),
        ("Friction", laws),
        ("Load sharing", sharing_words(outcome)),
    ]
    return [(term, words) for term, words in facts if words]


def _standing(page: Page) -> SectionTable | None:
    """What the numbers of designs stand on, side by side."""
    few = dict([*page.outcomes.items()][:_COLUMNS])
    if not page.designs:
        return None
    facts = {name: dict(_facts(one)) for name, one in few.items()}
    terms = dict.fromkeys(
        term for standing in facts.values() for term in standing if term not in _OF_MODELS
    )
    rows = [(term, *(standing.get(term, "–") for standing in facts.values())) for term in terms]
    return SectionTable(["", *few], rows, caption="Designs")


def _doubts(page: Page) -> list[str]:
    """Warnings of all, each once, with the names of those that have it where not all do."""
    of = variant_warnings(page.outcomes, "warnings", of_stage_by_bodies)
    everyone = len(page.outcomes)
    return [t if len(of[t]) == everyone else f"{', '.join(of[t])}: {t}" for t in of]


def _differing(page: Page) -> SectionTable | None:
    """Inputs that differ between designs or variants; None of one alone, or where none differ."""
    few = dict([*page.outcomes.items()][:_COLUMNS])
    table, _ = input_tables(few)
    if len(few) < 2 or not table.rows:
        return None
    title, rows = "Inputs that differ", named_inputs(table)
    room = _INPUTS if page.designs else _INPUTS // 2  # the gears of a case stand above
    return _cut(SectionTable(["", *few], rows, caption=title), room)


def _results(page: Page, outcome: Outcome) -> SectionTable:
    """Key figures: of one variant with what goes with them, of several side by side."""
    if page.several:
        few = dict([*page.outcomes.items()][:_COLUMNS])
        rows = [[*row.values()] for row in beside_each_other(few)][:_RESULTS]
        return SectionTable(["", *few], rows, caption="Results")
    every = stages_together(key_figures(page.sections, outcome))
    figures = figures_by_members(outcome, every)[:_RESULTS]
    return SectionTable(
        ["", "", ""], [(f.name, f.value, _detail(f.detail)) for f in figures], caption="Results"
    )


def _detail(words: str) -> str:
    return show.whole_clauses(words.lstrip(",; "), _BESIDE)


def _main_figures(page: Page, shown: Iterable[Panel]) -> Iterator[Figure]:
    """The main figures of two sections, else the first ones, each with the legend of its panel."""
    drawn = {f.name: (f, panel) for panel in shown for f in panel.figures if f.drawn}
    wanted = [section.main_figure for section in page.sections]
    for name in ([name for name in wanted if name in drawn] or [*drawn])[:2]:
        figure, panel = drawn[name]
        curves = panel.curves if len(panel.curves) > 1 else []
        keys = tuple(Key(curve.label, curve.colour, curve.dash) for curve in curves)
        label = panel.choices[panel.at].label if panel.choices else ""
        chosen = f" · {label}" if any(variant in label for variant in page.outcomes) else ""
        yield replace(figure, title=figure.title + chosen, keys=figure.keys or keys)


def _assumed(manifest: Mapping[str, Any]) -> str:
    """Inputs that somebody chose, in words, and how many are as usual."""
    rows = printed_input_rows(manifest)
    chosen = [
        f"{_place_of(row)}{_plain_key(row['key'])} {show.pretty(row['value'])}"
        for row in rows
        if row["status"] in _CHOSEN
    ]
    usual = sum(row["status"] == "default" for row in rows)
    hidden = len(chosen) - _ASSUMED
    remainder = f"; {hidden} more under Inputs as resolved" if hidden > 0 else ""
    words = f"Inputs assumed, fitted or corrected: {'; '.join(chosen[:_ASSUMED])}{remainder}. "
    return f"{words if chosen else ''}{usual} inputs are not given and taken as usual."


def _fingerprints(page: Page) -> str:
    """Fingerprint of the operating point of every variant, of its first part where there is none."""
    parts = (
        outcome.parts.get("operation", next(iter(outcome.parts.values()), None))
        for outcome in page.outcomes.values()
    )
    marks = (str(part.attrs.get("fingerprint", "")) for part in parts if part is not None)
    return ", ".join(dict.fromkeys(filter(None, marks)))
