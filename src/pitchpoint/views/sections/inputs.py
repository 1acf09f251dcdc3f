"""Inputs as resolved, each with the mark that says how it was come by."""

from collections.abc import Iterator, Mapping
from itertools import groupby
from typing import Any

from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.inputs import printed_input_rows
from pitchpoint.views.section import Block, Drawn, Page, Section

__all__ = ["INPUTS"]

STATUSES = {
    "printed": "stands in the source",
    "derived": "follows from printed values",
    "digitised": "read from a figure",
    "assumed": "not stated anywhere, chosen",
    "fitted": "tuned until a printed result was met",
    "corrected": "differs from the source, with a reason",
    "given": "stands in the case file or the catalogue",
    "set": "set for this run",
    "default": "not given, taken as usual",
}


def _blocks(page: Page) -> Iterator[Block]:
    values = {
        "runs": _runs(_inputs(page.outcomes)),
        "several": page.several,
        "statuses": STATUSES,
        "source_keys": {
            s["key"] for outcome in page.outcomes.values() for s in outcome.manifest["sources"]
        },
    }
    yield Drawn("inputs.html.jinja", values)


def _inputs(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Inputs by table and key; one entry where the variants agree, one for each where they do not."""
    rows: dict[tuple[str, str], dict[str, dict[str, str]]] = {}
    for variant, outcome in outcomes.items():
        for row in printed_input_rows(outcome.manifest):
            rows.setdefault((row["table"], row["key"]), {})[variant] = row
    tables: dict[str, list[dict[str, Any]]] = {}
    for (table, key), by_variant in rows.items():
        tables.setdefault(table, []).append(_input(show.pretty(key), by_variant, len(outcomes)))
    return [{"table": table, "rows": inside} for table, inside in tables.items()]


def _runs(tables: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Tables in turn, those without places and notes together: they stand in two columns."""
    return [{"bare": bare, "tables": list(run)} for bare, run in groupby(tables, key=_is_bare)]


def _is_bare(table: dict[str, Any]) -> bool:
    cells = [cell for row in table["rows"] for cell in row["cells"]]
    return not any(cell["where"] or cell["note"] for cell in cells)


def _input(key: str, by_variant: Mapping[str, dict[str, str]], variants: int) -> dict[str, Any]:
    cells: dict[tuple[str, ...], list[str]] = {}
    for variant, row in by_variant.items():
        mark = (show.pretty(row["value"]), row["status"], row["where"], row["note"])
        cells.setdefault(mark, []).append(variant)
    differs = len(cells) > 1 or len(by_variant) < variants
    return {
        "key": key,
        "differs": differs,
        "cells": [
            {"variants": ", ".join(names) if differs else "", "value": mark[0], "status": mark[1]}
            | {"where": mark[2], "note": mark[3]}
            for mark, names in cells.items()
        ],
    }


INPUTS = Section(
    name="inputs",
    title="Inputs as resolved",
    short="Inputs",
    order=10.0,
    lacks=lambda page: None,
    blocks=_blocks,
    folded=True,
)
