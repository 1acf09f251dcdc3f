"""Pages whose cells run: their figures, a thumbnail of each, cards that lead to them, and notebooks."""

import html
import re
import resource
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from docutils import nodes
from notebooks import figure_of, head, notebook, thumbnail
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

import pitchpoint
from pitchpoint.gears.mesh_bodies import drawing

__all__ = ["setup"]

BUDGET = 600.0
"""Most of the processor that the cells of all pages may take [s]: some 350 s with no program kept before."""


class MovingTeeth(SphinxDirective):
    """A pair of gears, by its table `[gears]`, where it meshes."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """The picture as HTML."""
        gears = tomllib.loads("\n".join(self.content))
        return [nodes.raw("", moving_teeth(gears), format="html")]


RUNNING = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "1 N m", "speed": "1 rpm", "temperature": "50 degC"},
}
"""What a case asks for beside its gears, which nothing is seen of."""


def moving_teeth(gears: dict[str, Any]) -> str:
    """A pair of gears which turns by one tooth again and again, as SVG.

    Args:
        gears: table `[gears]` of a case.
    """
    mesh = pitchpoint.load_case({"title": "Teeth", "gears": gears, **RUNNING}).design.mesh
    with pitchpoint.double_precision():
        drawn = {name: np.asarray(value) for name, value in drawing(mesh).items()}
    tip = 1e3 * drawn["tip_radius"][0]
    box = f"{-1.7 * tip:.1f} {-1.6 * tip:.1f} {3.4 * tip:.1f} {1.5 * tip:.1f}"
    bodies = "".join(_turning(drawn, body, side) for body, side in ((0, 1.0), (1, -1.0)))
    return f'<svg class="teeth" viewBox="{box}" role="img" aria-label="Gear teeth">{bodies}</svg>'


def _turning(drawn: dict[str, np.ndarray], body: int, side: float) -> str:
    """Outline of a gear about its centre, y downwards, in mm."""
    tooth, pitch = drawn["layer_tooth"][body][::3], drawn["layer_pitch"][body]
    ends = np.arctan2(tooth[[0, -1], 1], tooth[[0, -1], 0])
    turns = np.sign(ends[1] - ends[0]) * pitch * np.arange(drawn["layer_count"][body])
    turns = turns[:, None] + drawn["layer_turned"][body]
    x = 1e3 * (np.cos(turns) * tooth[:, 0] - np.sin(turns) * tooth[:, 1])
    y = 1e3 * (np.sin(turns) * tooth[:, 0] + np.cos(turns) * tooth[:, 1])
    points = " ".join(f"{a:.2f},{-b:.2f}" for a, b in zip(x.ravel(), y.ravel(), strict=True))
    across, up = 1e3 * drawn["layer_place"][body]
    spin = f"--turn: {side * np.degrees(pitch):.5f}deg"
    return (
        f'<g transform="translate({across:.3f} {-up:.3f})">'
        f'<polygon class="gear-{body + 1}" style="{spin}" points="{points}"/></g>'
    )


class Cards(SphinxDirective):
    """Pages by thumbnail, title and first sentence, one page a line."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Cards as HTML."""
        up = "../" * self.env.docname.count("/")
        cards = "".join(self._card(up, name) for name in filter(None, self.content))
        return [nodes.raw("", f'<div class="cards">{cards}</div>', format="html")]

    def _card(self, up: str, name: str) -> str:
        path = Path(self.env.srcdir) / f"{name}.md"
        self.env.note_dependency(str(path))
        title, words = head(path.read_text("utf-8"))
        picture = f'<img src="{up}_static/thumbnails/{_short(name)}.svg" alt="" loading="lazy">'
        told = f"<strong>{html.escape(title)}</strong><span>{html.escape(words)}</span>"
        return f'<a class="card" href="{up}{name}.html">{picture}{told}</a>'


def _short(name: str) -> str:
    return name.rpartition("/")[2]


def _offer(app: Sphinx, name: str, source: list[str]) -> None:
    """A line under the title that leads to the notebook."""
    if name.startswith("gallery/"):
        link = f'<a href="../_static/notebooks/{_short(name)}.ipynb" download>'
        line = f'<p class="notebook">{link}This page as a notebook</a></p>'
        source[0] = re.sub(r"^(# .+\n)", rf"\1\n{line}\n", source[0], count=1, flags=re.MULTILINE)


def _without_elsewhere(app: Sphinx, document: nodes.document) -> None:
    """Figures as plotly writes them, without what it would load from other sites; a picture of the first."""
    figures = [node for node in document.findall(nodes.raw) if "Plotly.newPlot(" in node.astext()]
    for node in figures:
        kept = re.sub(r'<script[^>]* src="https?://[^>]*></script>', "", node.astext())
        node[:] = [nodes.Text(kept)]
        node.rawsource = kept
    if figures:
        document["thumbnail"] = thumbnail(figure_of(figures[0].astext()))
        up = "../" * app.env.docname.count("/")
        library = f'<script src="{up}_static/plotly.min.js"></script>'
        figures[0].insert(0, nodes.Text(library))


def _write(app: Sphinx, failed: Exception | None) -> None:
    """Notebooks and thumbnails of all pages that ran, beside the other files of the site."""
    if failed is not None or app.builder.name != "html":
        return
    static = Path(app.outdir) / "_static"
    for folder in ("notebooks", "thumbnails"):
        (static / folder).mkdir(exist_ok=True)
    for path in sorted((Path(app.srcdir) / "gallery").glob("*.md")):
        picture = app.env.get_doctree(f"gallery/{path.stem}")["thumbnail"]
        (static / "thumbnails" / f"{path.stem}.svg").write_text(picture, "utf-8")
        book = notebook(path.read_text("utf-8"))
        (static / "notebooks" / f"{path.stem}.ipynb").write_text(book, "utf-8")


def _within_budget(*_: Any) -> None:
    """A warning, which ends a build by `-W`, where cells took more of the processor than they may."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = used.ru_utime + used.ru_stime
    words = "cells of all pages took %.0f s of the processor, of %.0f s"
    logger = logging.getLogger(__name__)
    (logger.warning if seconds > BUDGET else logger.info)(words, seconds, BUDGET)


def setup(app: Sphinx) -> None:
    """Add all of it to the site."""
    app.add_directive("cards", Cards)
    app.add_directive("teeth", MovingTeeth)
    app.connect("source-read", _offer)
    app.connect("doctree-read", _without_elsewhere)
    app.connect("build-finished", _write)
    app.connect("build-finished", _within_budget)
