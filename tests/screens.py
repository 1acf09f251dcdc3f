"""First screens as they must be: a dozen lines of eighty characters, with every number whole."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from pitchpoint.runs.run import Outcome
from pitchpoint.views.first_screen import first_screen, most_lines

NUMBER = re.compile(r"\d(?:[\d.,e−+-]*[\de])?")
REPORT = Path("results/pair/report.html")


def screen(outcomes: Mapping[str, Outcome], width: int = 80, *, tables: bool = True) -> list[str]:
    """Its lines."""
    lines = first_screen(outcomes, REPORT, width, tables=tables)
    return [line.text.replace("\u00a0", " ") for line in lines]


def faults_of_the_screen(outcomes: Mapping[str, Outcome], width: int = 80) -> Iterator[str]:
    """What is wrong with the screen of a result."""
    lines = screen(outcomes, width)
    whole = {number for line in screen(outcomes, 1000) for number in NUMBER.findall(line)}
    if len(lines) > most_lines(outcomes):
        yield f"{len(lines)} lines"
    for line in lines:
        if len(line) > width:
            yield f"{len(line)} characters: {line}"
        # Wider lines leave room for more of a kind.
        counted = line.endswith("in the report.") or re.search(
            r"[;,] (and )?\d+ more\b|^and \d+ more\b", line
        )
        if not counted and (cut := {*NUMBER.findall(line)} - whole):
            yield f"{', '.join(cut)} is a part of a number: {line}"
