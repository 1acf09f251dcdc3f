"""Laws and models that were used."""

from collections.abc import Iterator, Mapping

from pitchpoint.runs.run import Outcome
from pitchpoint.views.section import Block, Drawn, Page, Section

__all__ = ["MODELS"]


def _blocks(page: Page) -> Iterator[Block]:
    values = {"models": _models(page.outcomes), "several": page.several}
    yield Drawn("models.html.jinja", values)


def _models(outcomes: Mapping[str, Outcome]) -> list[dict[str, str]]:
    """Laws and models of all variants, each with the variants that use it."""
    by_model: dict[str, dict[str, str]] = {}
    for variant, outcome in outcomes.items():
        manifest = outcome.manifest
        named = [("friction", law) for law in manifest["laws"]]
        named += [(model["effect"], model) for model in manifest["models"]]
        for effect, model in named:
            entry = by_model.setdefault(
                f"{effect} {model['name']}",
                {"effect": effect, "name": model["name"], "title": model["title"]}
                | {"note": model["note"], "variants": ""},
            )
            entry["variants"] += ", " * bool(entry["variants"]) + variant
    return list(by_model.values())


MODELS = Section(
    name="models",
    title="Models",
    short="Models",
    order=990.0,
    lacks=lambda page: None,
    blocks=_blocks,
)
