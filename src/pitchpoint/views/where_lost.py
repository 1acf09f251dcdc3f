"""Where in the mesh the loss is made, in words."""

from collections.abc import Callable, Iterator, Mapping

from pitchpoint.runs.run import Outcome
from pitchpoint.views.figures import laws
from pitchpoint.views.section import Block, Drawn, Heading, Page

__all__ = ["where_lost"]


def where_lost(
    page: Page, outcomes: Mapping[str, Outcome], words: Callable[[Outcome, int], str]
) -> Iterator[Block]:
    """A sentence for each curve that says where in the mesh the loss is made.

    Args:
        page: with the curves.
        outcomes: by variant; those without a mesh cycle have no sentence.
        words: of an outcome under the law at a position.
    """
    losses = [
        (page.curves[variant, law], words(outcome, position))
        for variant, outcome in outcomes.items()
        if "cycle" in outcome.parts
        for position, law in enumerate(laws(outcome.parts["cycle"]))
    ]
    if losses:
        yield Heading("Where the loss is made")
        yield Drawn("losses.html.jinja", {"losses": losses})
