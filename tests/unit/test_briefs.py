"""Doubts as a screen shows them: a brief for each, which fits one line of eighty columns."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import pitchpoint
from pitchpoint.analyses.caveats import law_sentences, range_left
from pitchpoint.core.doubts import (
    BRIEF,
    Doubt,
    as_doubt,
    doubts_of,
    fails,
    in_stage,
    ranked_doubts,
    stored,
)
from pitchpoint.lubrication.applicability import Limited
from pitchpoint.lubrication.lubrication_registry import ASPERITY_LOAD, FILM_THICKNESS, LAWS

PACKAGE = Path(pitchpoint.__file__).parent
LINE = BRIEF + len("Doubtful: ")
NUMBER, NAME = 7, 12
"""Characters that a number with its format and a name take in the place that an f-string leaves for them."""


def doubts_in(path: Path) -> Iterator[tuple[str, ast.Call]]:
    """Calls that make doubts in a file, each with its place."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in {"Doubt", "fails"}:
            yield f"{path.relative_to(PACKAGE)}:{node.lineno}", node


def size(text: ast.expr) -> int:
    """Characters of a string or an f-string with usual values; of what is computed elsewhere none."""
    if isinstance(text, ast.Constant):
        return len(str(text.value))
    if isinstance(text, ast.JoinedStr):
        return sum(map(size, text.values))
    return (NUMBER if text.format_spec else NAME) if isinstance(text, ast.FormattedValue) else 0


def shown(call: ast.Call) -> ast.expr:
    """What a screen shows of a doubt: its brief, or the sentence where it has none."""
    named = {keyword.arg: keyword.value for keyword in call.keywords}
    marked = call.args[1:2] if getattr(call.func, "id", "") == "fails" else []
    return named.get("brief") or [*marked, call.args[0]][0]


CALLS = {
    place: call
    for path in PACKAGE.rglob("*.py")
    if path != PACKAGE / "core" / "doubts.py"
    for place, call in doubts_in(path)
}


def test_there_are_many() -> None:
    assert len(CALLS) > 100


@pytest.mark.parametrize("call", CALLS.values(), ids=[*CALLS])
def test_every_doubt_fits_a_line(call: ast.Call) -> None:
    begins = "Fails: " if getattr(call.func, "id", "") == "fails" else "Doubtful: "
    assert len(begins) + size(shown(call)) <= LINE, ast.unparse(shown(call))


@pytest.mark.parametrize("law", [*LAWS, *FILM_THICKNESS.values(), *ASPERITY_LOAD.values()])
def test_a_range_that_is_left_fits_beside_the_name_of_its_law(law: Limited) -> None:
    partly = {"weight": np.array([0.123, 0.877])}
    run = {f"outside {law.name} {name}": np.array([True, False]) for name in law.ranges}
    for doubt in law_sentences(law, range_left(law, {**partly, **run}, "film")):
        assert "12 % of a cycle" in as_doubt(doubt).brief
        assert len(as_doubt(doubt).brief) <= BRIEF, as_doubt(doubt).brief


def test_the_brief_goes_where_the_sentence_goes() -> None:
    tips = Doubt("Tips of gear 1 are thin, which is told at length.", brief="Tips of gear 1: thin.")
    (kept,) = doubts_of(stored([tips]))
    assert (kept, kept.brief) == (tips, tips.brief)
    other = Doubt(tips.replace("gear 1", "gear 2"), brief="Tips of gear 2: thin.")
    (both,) = ranked_doubts([in_stage(2, tips), in_stage(2, other)])["warnings"]
    assert both.brief == "Stage 2: tips of gear 1 (gear 2 alike): thin."
    failing = fails("teeth melt at 300 degC, of which much is said.", "teeth melt at 300 degC.")
    assert in_stage(1, failing).brief == "Fails: stage 1: teeth melt at 300 degC."


def test_results_of_earlier_versions_have_no_briefs() -> None:
    held = {"warnings": '["tips are thin."]', "doubts": '[["tips", 0.1, 0.2, []]]'}
    assert doubts_of(held)[0].brief == "tips are thin."
