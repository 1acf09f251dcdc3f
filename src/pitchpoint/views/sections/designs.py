"""Designs beside each other: inputs that differ, main results, and what follows from the inputs."""

from collections.abc import Iterator

from pitchpoint.views import section
from pitchpoint.views.designs import (
    Compared,
    differing,
    law_words,
    named_inputs,
    of_several,
    result_table,
)

__all__ = ["designs_blocks"]


def designs_blocks(page: section.Page) -> Iterator[section.Block]:
    """Inputs that differ, results, and what follows from the inputs, side by side."""
    differing_inputs, *following = (_inputs(*table) for table in differing(page.outcomes).items())
    yield from differing_inputs
    yield section.Heading("Results")
    yield section.Paragraph(law_words(page.outcomes))
    results = result_table(page.outcomes)
    shared, _ = of_several(results, len(page.outcomes))
    yield section.SectionTable(shared.head, shared.rows)
    alone = [row for row in results.rows if row not in shared.rows]
    if alone:
        columns = slice(results.names + len(page.outcomes))
        yield section.Heading("Results that one design alone has")
        yield section.SectionTable(results.head[columns], [row[columns] for row in alone])
    for blocks in following:
        yield from blocks


def _inputs(title: str, table: Compared) -> Iterator[section.Block]:
    yield section.Heading(title)
    if not table.rows:
        yield section.Paragraph("None.")
        return
    head, rows = ["input", *table.head[2:]], named_inputs(table)
    yield section.SectionTable(head, rows[:_OPEN])
    if hidden := rows[_OPEN:]:
        yield section.Folded(
            f"{len(hidden)} more inputs that differ", [section.SectionTable(head, hidden)]
        )


_OPEN = 10
"""Inputs that differ which stand open: results follow below them on the first screen."""
