"""The page of a sizing: its front, all designs that were worked out, to be brushed, and their gears."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import isfinite
from pathlib import Path
from shlex import quote
from typing import Any

import numpy as np

from pitchpoint import units
from pitchpoint.registry import enumerated
from pitchpoint.sizing.sizing import SizedDrive, Sizing, families_by_reason
from pitchpoint.views import show
from pitchpoint.views.designs_page import Better, DesignColumn, DesignsPage, render_designs
from pitchpoint.views.section import Block, Paragraph, SectionTable
from pitchpoint.views.sizing_screen import (
    BEST_WORDS,
    counted_words,
    doubts_of_sizing,
    gear_words,
    task_words,
)

__all__ = ["render_sizing"]

_FIGURES: Mapping[str, tuple[str, str, str, str, Better]] = {
    "ratio": ("ratio", "", "", "dimensionless", ""),
    "mass": ("mass of the gears", "kg", "kg", "mass", "less"),
    "loss": ("loss of the teeth", "%", "%", "dimensionless", "less"),
    "diameter": ("diameter", "mm", "mm", "length", "less"),
    "length": ("length", "mm", "mm", "length", "less"),
    "backlash": ("backlash at the output", "'", "arcmin", "angle", "less"),
    "stiffness": (
        "torsional stiffness at the output",
        "N m/'",
        "N m/arcmin",
        "torsional stiffness",
        "more",
    ),
    "inertia": ("inertia at the input", "kg cm²", "kg cm2", "moment of inertia", "less"),
    "flank_safety": ("least flank safety", "", "", "dimensionless", "more"),
    "root_safety": ("least root safety", "", "", "dimensionless", "more"),
}
"""Words, unit as printed and as written, kind, and what is good, by figure of a `SizedDrive`."""

_AXES = (
    "family",
    "mass",
    "loss",
    "diameter",
    "length",
    "backlash",
    "flank_safety",
    "root_safety",
)

_ON_FRONT = "on_front"

_GEARS = {
    "teeth": ("teeth", ""),
    "module": ("module", "mm"),
    "face_width": ("face width", "mm"),
    "planets": ("planets", ""),
}
"""Words and unit by what `gear_words` says."""


def render_sizing(sizing: Sizing, *, folder: Path | None = None) -> str:
    """The page of a sizing as text.

    Args:
        sizing: its designs.
        folder: with the case files of its front, beside which the page lies; None where there are none.
    """
    designs = [*sizing.designs.values()]
    columns = [*_columns(sizing, designs)]
    first, second = _two_aims(sizing)
    balanced = sizing.best["balanced"]
    return render_designs(
        DesignsPage(
            title=task_words(sizing.task),
            summary=counted_words(sizing),
            answer=[*_answer(sizing)],
            columns=columns,
            labels=[*sizing.designs],
            drawn=f"All {len(designs)} designs that were worked out are drawn: of each family the best, and "
            "others evenly by mass.",
            axes=_AXES,
            colour=first,
            aims=(first, second),
            front=[_front_table(sizing, first, second)],
            front_words=f"The front drawn here is that of two figures. {len(sizing.front)} designs are "
            f"beaten by none in {enumerated(sizing.task.aims)} together; their axis says so.",
            opening=_opening(sizing, folder, [*sizing.designs].index(balanced)),
            opening_words=[Paragraph(_opening_words(folder))],
        )
    )


def _shown(name: str, value: float) -> float:
    """A figure of a design in the unit of the page."""
    if name == "loss":
        return 100.0 * value
    _, _, unit, kind, _ = _FIGURES[name]
    return float(units.convert(value, unit, kind)) if unit else value


def _columns(sizing: Sizing, designs: Sequence[SizedDrive]) -> Iterator[DesignColumn]:
    families = [design.family for design in designs]
    yield _named(
        "family",
        "family",
        families,
        [one for one in sizing.task.families if one in families],
        is_axis=True,
    )
    gears = [gear_words(design) for design in designs]
    for name, (words, unit) in _GEARS.items():
        texts = [entry[name] for entry in gears]
        if any(texts):
            column = _named(name, words, texts, sorted({*texts}))
            yield replace(column, unit=unit)
    on = ["yes" if design.name in sizing.front else "no" for design in designs]
    yield _named(_ON_FRONT, "on the front of all that counts", on, ["no", "yes"], is_axis=True)
    for name, (words, unit, _, _, better) in _FIGURES.items():
        values = [_shown(name, float(getattr(design, name))) for design in designs]
        yield DesignColumn(
            name=name, words=words, unit=unit, values=np.array([values]), better=better
        )


def _named(
    name: str, words: str, texts: Sequence[str], levels: Sequence[str], *, is_axis: bool = False
) -> DesignColumn:
    values = np.array([[float(levels.index(text)) for text in texts]])
    return DesignColumn(
        name=name,
        words=words,
        values=values,
        levels=levels,
        is_input=name != _ON_FRONT,
        is_axis=is_axis,
    )


def _two_aims(sizing: Sizing) -> tuple[str, str]:
    aims = [*sizing.task.aims, "mass", "loss"]
    return aims[0], next(aim for aim in aims if aim != aims[0])


def _answer(sizing: Sizing) -> Iterator[Block]:
    best = [(BEST_WORDS[aim], sizing.designs[name]) for aim, name in sizing.best.items()]
    gears = [[by, design.name, *_gear_cells(design)] for by, design in best]
    figures = [[by, design.name, *_figure_cells(design)] for by, design in best]
    heads, caption = ["", "design", *_gear_heads()], "The best designs of the front"
    yield SectionTable(heads, gears, caption=caption, wide=True, names=6)
    heads = ["", "design", *_figure_heads()]
    yield SectionTable(heads, figures, caption="Their figures", wide=True, names=2)
    for words in doubts_of_sizing(sizing):
        yield Paragraph(words, "note")
    without = families_by_reason(sizing.without)
    if without:
        reasons = [[families, words] for words, families in without.items()]
        yield SectionTable(
            ["families", "why not"], reasons, caption="Families without a design", names=2
        )


def _gear_heads() -> list[str]:
    return [f"{words} [{unit}]" if unit else words for words, unit in _GEARS.values()]


def _figure_heads() -> list[str]:
    return [f"{words} [{unit}]" if unit else words for words, unit, *_ in _FIGURES.values()]


def _gear_cells(design: SizedDrive) -> list[str]:
    gears = gear_words(design)
    return [gears[name] for name in _GEARS]


def _figure_cells(design: SizedDrive) -> list[str]:
    figures = [_shown(name, float(getattr(design, name))) for name in _FIGURES]
    return [show.number_text(value) if isfinite(value) else "–" for value in figures]


def _front_table(sizing: Sizing, first: str, second: str) -> SectionTable:
    designs = sorted((sizing.designs[name] for name in sizing.front), key=lambda it: it.mass)
    rows = [[it.name, *_gear_cells(it), *_figure_cells(it)] for it in designs]
    caption = f"Designs that none beats in {enumerated(sizing.task.aims)}"
    head = ["design", *_gear_heads(), *_figure_heads()]
    return SectionTable(head, rows, caption=caption, wide=True, names=5)


def _opening(sizing: Sizing, folder: Path | None, at: int) -> dict[str, Any]:
    if folder is None:
        return {"files": {}, "without": "", "at": at}
    files = {
        name: {
            "link": f"{name}.toml",
            "command": f"pitchpoint run {quote(str(folder / f'{name}.toml'))}",
        }
        for name in sizing.front
    }
    without = ": not on the front of all that counts, thus without a case file"
    return {"files": files, "without": without, "at": at}


def _opening_words(folder: Path | None) -> str:
    if folder is None:
        return "`-o FOLDER` writes the designs of the front as case files."
    return "Each design of the front is a case file beside this page, which runs and says the same."
