"""Sources behind a result, and the files that hold it."""

from collections.abc import Iterator, Mapping
from typing import Any

from pitchpoint.cases.record import sources_of
from pitchpoint.runs.run import Outcome
from pitchpoint.views.inputs import set_for_run
from pitchpoint.views.section import Block, Drawn, Page, Section

__all__ = ["SOURCES"]


def _blocks(page: Page) -> Iterator[Block]:
    sources = sources_of([outcome.manifest for outcome in page.outcomes.values()])
    if sources:
        yield Drawn("sources.html.jinja", {"sources": sources})
    yield Drawn(
        "files.html.jinja",
        {
            "version": page.version,
            "case": page.cases,
            "settings": {n: set_for_run(outcome.manifest) for n, outcome in page.outcomes.items()},
            "several": page.several,
            "parts": _parts(page.outcomes),
        },
    )


def _parts(outcomes: Mapping[str, Outcome]) -> list[dict[str, Any]]:
    """Files of the result with the fingerprint of what they were computed from."""
    return [
        {
            "file": f"{variant}/{name}.nc",
            "title": str(data.attrs.get("title", name)),
            "fingerprint": str(data.attrs.get("fingerprint", "")),
        }
        for variant, outcome in outcomes.items()
        for name, data in outcome.parts.items()
    ]


SOURCES = Section(
    name="sources",
    title="Sources",
    short="Sources",
    order=1000.0,
    lacks=lambda page: None,
    blocks=_blocks,
)
