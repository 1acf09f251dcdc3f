"""Designs beside each other: main results, inputs that differ, and what follows from them."""

from collections.abc import Iterator

from pitchpoint.views.designs import Compared, differing, law_words, of_several, result_table
from pitchpoint.views.section import Block, Heading, Page, Paragraph, Section, Table

__all__ = ["DESIGNS"]


def _blocks(page: Page) -> Iterator[Block]:
    yield Paragraph(law_words(page.outcomes))
    results = result_table(page.outcomes)
    shared, _ = of_several(results, len(page.outcomes))
    yield Table(shared.head, shared.rows)
    alone = [row for row in results.rows if row not in shared.rows]
    if alone:
        columns = slice(results.names + len(page.outcomes))
        yield Heading("Results that one design alone has")
        yield Table(results.head[columns], [row[columns] for row in alone])
    for title, table in differing(page.outcomes).items():
        yield from _inputs(title, table)


def _inputs(title: str, table: Compared) -> Iterator[Block]:
    yield Heading(title)
    if not table.rows:
        yield Paragraph("None.")
        return
    rows = [(f"{where}, {key}", *told) for where, key, *told in table.rows]
    yield Table(["input", *table.head[2:]], rows)


DESIGNS = Section(
    name="designs",
    title="Designs beside each other",
    short="Designs",
    order=-1.0,
    lacks=lambda page: None if page.designs else "",
    blocks=_blocks,
)
