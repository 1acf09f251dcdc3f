"""Printed against computed numbers, misses first."""

from collections.abc import Iterator, Mapping
from itertools import groupby
from math import ceil, floor, isfinite, log10
from typing import Any

from pitchpoint.results.target_rows import TargetRow, counts, verdict_sentence
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.section import Block, Drawn, Heading, Page

__all__ = ["compared_blocks", "compared_closing"]

KINDS = {
    "predicted": "no constant, grid or reading was chosen with it",
    "calibrated": "a constant or a reading of the model was found with it",
    "fitted": "an input was tuned to it",
    "trend": "only a direction was printed",
    "definition": "it follows from the inputs by arithmetic, whatever the model",
    "reference": "a value of an independent calculation, not of the publication",
    "excluded": "not computed, for the reason given",
}
_ORDER = {"miss": 0, "excluded": 1, "pass": 2}


def compared_blocks(page: Page) -> Iterator[Block]:
    """Tables of printed and computed numbers."""
    yield Drawn("compared.html.jinja", {"rows": _rows(page.outcomes), "kinds": KINDS})


def compared_closing(page: Page) -> Iterator[Block]:
    """How many printed numbers are met, for the end of the answer."""
    yield Heading("Printed numbers")
    yield Drawn("met.html.jinja", {"rows": _rows(page.outcomes)})


def _rows(outcomes: Mapping[str, Outcome]) -> dict[str, Any]:
    """Printed against computed, misses first."""
    by_variant = {name: outcome.rows for name, outcome in outcomes.items() if outcome.rows}
    every = [(name, row) for name, rows in by_variant.items() for row in rows]
    ordered = sorted(every, key=lambda pair: _ORDER.get(pair[1].verdict, 0))
    table = [{**_row(row), "variant": name} for name, row in ordered]
    return {
        "open": _reasoned([row for row in table if row["verdict"] != "pass"]),
        "passed": _reasoned([row for row in table if row["verdict"] == "pass"]),
        "counts": [
            {"kind": kind, "verdicts": dict(verdicts), "variant": name}
            for name, rows in by_variant.items()
            for kind, verdicts in counts(rows).items()
        ],
        "in_words": [(name, verdict_sentence(rows)) for name, rows in by_variant.items()],
        "missed": [row for row in table if row["verdict"] == "miss"],
        "excluded": [row for row in table if row["verdict"] == "excluded"],
        "variants": [*by_variant],
        "others": [name for name in outcomes if name not in by_variant],
    }


def _reasoned(table: list[dict[str, str]]) -> list[dict[str, str]]:
    """Rows of which the last of several with one reason says it for all of them."""
    done = []
    for reason, rows in groupby(table, key=lambda row: row["reason"]):
        *before, final_row = rows
        several = f"These {len(before) + 1} rows: " if before and reason else ""
        done += [row | {"because": ""} for row in before]
        done.append(final_row | {"because": f"{several}{reason}"})
    return done


def _row(row: TargetRow) -> dict[str, str]:
    unit = show.display_unit(row.unit)
    computed, deviation, tolerance = "not computed", "", ""
    if row.computed is not None and row.deviation is not None and isfinite(row.computed):
        digits = _decimals(row.tolerance)
        rounding = digits > _most_decimals(row.computed)  # a tolerance for that alone, or none
        if rounding or digits > _WRITTEN_OUT or abs(row.computed) >= _LARGE:
            computed = show.number_text(row.computed, _digits(row.computed, row.tolerance))
            off = round(row.deviation, digits)
            deviation = f"{'+' * (off > 0.0)}{show.number_text(off)}"
        else:
            # What is rounded to nothing has no sign.
            computed = f"{round(row.computed, digits) + 0.0:.{digits}f}"
            deviation = show.signed(row.deviation, digits)
        computed = f"{computed.replace('-', '−')} {unit}".strip()
        tolerance = "" if row.bound else f"± {row.tolerance:.3g}"
    return {
        "quantity": show.pretty(row.quantity),
        "where": row.where,
        "printed": f"{row.bound}{row.printed:g} {unit}".strip().replace("-", "−"),
        "computed": computed,
        "deviation": deviation,
        "tolerance": tolerance,
        "kind": row.kind,
        "verdict": row.verdict,
        "reason": row.reason or "no reason is known" * (row.verdict == "miss"),
    }


def _digits(value: float, tolerance: float) -> int:
    """Significant digits that show a tenth of the tolerance, four to seven of them; four without one."""
    return min(max(ceil(log10(abs(value) / tolerance)) + 1, 4), 7) if value and tolerance else 4


_WRITTEN_OUT, _LARGE = 9, 1e6
"""Decimals beyond which, and numbers from which on, a power of ten is told."""


def _decimals(tolerance: float) -> int:
    """Decimals that show a deviation to a tenth of the tolerance or finer; all for none."""
    return max(ceil(-log10(tolerance)), 0) + 1 if tolerance else 99


def _most_decimals(value: float) -> int:
    """Decimals of seven significant digits, which no print has more of."""
    return max(6 - floor(log10(abs(value))), 0) if value else 6
