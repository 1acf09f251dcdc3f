"""A page of many designs that one brushes: of a study, or of a sizing."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from pitchpoint.views.figures import rounded
from pitchpoint.views.report import environment, packed
from pitchpoint.views.section import Block

__all__ = ["Better", "DesignColumn", "DesignsPage", "InfluenceBar", "Influences", "render_designs"]

Better = Literal["", "less", "more"]
"""What is good of a figure; empty where nobody can say."""


@dataclass(frozen=True, kw_only=True)
class DesignColumn:
    """A quantity of the designs of a page.

    Attributes:
        name: key of a case, or name of a figure.
        words: for it.
        unit: as printed; empty for plain numbers.
        values: by friction law and design, or in one row that holds under every law; where there are
            `levels`, numbers of these.
        levels: names, in the order in which an axis has them.
        is_input: True for what was varied.
        better: what is good of it.
        unit_written: as a case file has it.
        is_axis: False for what only tables show.
    """

    name: str
    words: str
    values: Float[np.ndarray, "law design"]
    unit: str = ""
    levels: Sequence[str] = ()
    is_input: bool = False
    better: Better = ""
    unit_written: str = ""
    is_axis: bool = True

    @property
    def for_script(self) -> dict[str, Any]:
        """What the script of the page reads; inputs with all digits that a case file needs."""
        as_list = _exactly if self.is_input or self.levels else _shortly
        return {
            "name": self.name,
            "words": self.words,
            "unit": self.unit,
            "written": self.unit_written,
            "levels": [*self.levels],
            "input": self.is_input,
            "better": self.better,
            "axis": self.is_axis,
            "values": [as_list(row) for row in self.values],
        }


def _exactly(row: Float[np.ndarray, " design"]) -> list[float | None]:
    return [float(f"{value:.15g}") if np.isfinite(value) else None for value in row]


def _shortly(row: Float[np.ndarray, " design"]) -> list[float | None]:
    return rounded(row, 6)


@dataclass(frozen=True)
class InfluenceBar:
    """How much one input matters to one figure.

    Attributes:
        label: the input, or what is measured of it.
        value: as drawn.
        words: as printed.
        low, high: bounds, if there are any.
    """

    label: str
    value: float
    words: str
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class Influences:
    """Bars of one figure.

    Attributes:
        title: the figure.
        bars: of its inputs.
        least: where bars begin that are as long to the left as can be, 0 or -1; they end at 1.
    """

    title: str
    bars: Sequence[InfluenceBar]
    least: float


@dataclass(frozen=True, kw_only=True)
class DesignsPage:
    """What a page of many designs shows.

    Attributes:
        title: of the page.
        summary: the answer in a sentence or two.
        answer: blocks below it.
        columns: quantities of the designs.
        labels: of the designs, as numbers or names.
        drawn: which designs are drawn, as a sentence.
        laws: titles of friction laws, where there are several.
        axes: names of the columns that are shown first.
        colour: name of the column that colours the lines.
        aims: names of two columns whose front is shown first.
        front: blocks of that front, for who has no script.
        front_words: what the front is of.
        influences: bars by title of their figure.
        influence_words: what they are, as sentences.
        effects: main effects for the script, by law, figure and key: rows of `MainEffect`.
        opening: how a design is opened, for the script: `command` before its settings, or `call` in Python;
            `files` by label.
        opening_words: the same as blocks.
    """

    title: str
    summary: str
    answer: Iterable[Block]
    columns: Sequence[DesignColumn]
    labels: Sequence[int | str]
    drawn: str
    axes: Sequence[str]
    colour: str
    aims: tuple[str, str]
    front: Sequence[Block]
    front_words: str
    opening: Mapping[str, Any]
    opening_words: Sequence[Block]
    laws: Sequence[str] = ()
    influences: Sequence[Influences] = ()
    influence_words: Sequence[Block] = ()
    effects: Sequence[Mapping[str, Any]] = field(default_factory=tuple)


def render_designs(page: DesignsPage) -> str:
    """The page as text."""
    content = {
        "columns": [column.for_script for column in page.columns],
        "labels": [*page.labels],
        "axes": [*page.axes],
        "colour": page.colour,
        "aims": [*page.aims],
        "effects": [*page.effects],
        "opening": dict(page.opening),
    }
    axes = [column for column in page.columns if column.is_axis]
    return (
        environment()
        .get_template("designs.html.jinja")
        .render(
            page=page,
            axes=axes,
            numbers=[column for column in axes if not column.levels],
            effects=[*page.effects[0]] if page.effects else [],
            words={column.name: column.words for column in page.columns},
            version=version("pitchpoint"),
            designs=packed(content),
        )
    )
