"""Site of the documentation, read without a network: `sphinx-build -W -n docs docs/_build/html`."""

import os
import re
import sys
from importlib.metadata import version as installed
from importlib.resources import files
from pathlib import Path
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator

sys.path.insert(0, str(Path(__file__).parent))

# Cells run for seconds: their programs are compiled quickly, as those of the tests, from whose cache they
# come where these ran before.
QUICKLY = (
    "--xla_backend_optimization_level=0 --xla_llvm_disable_expensive_passes=true "
    "--xla_cpu_use_fusion_emitters=false"
)
os.environ.setdefault("XLA_FLAGS", QUICKLY)
os.environ.setdefault("JAX_TRACEBACK_IN_LOCATIONS_LIMIT", "0")
os.environ["PLOTLY_RENDERER"] = "notebook_connected"  # as HTML without its library

project = "Pitchpoint"
author = "The Pitchpoint authors"
copyright = author
version = release = installed("pitchpoint")

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "gallery_pages"]
exclude_patterns = ["_build"]
html_theme = "furo"
html_title = "Pitchpoint"
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_static_path = ["_static", str(files("plotly") / "package_data" / "plotly.min.js")]

myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_heading_anchors = 3

# Gallery pages are run while the site is built; a cell that fails ends the build.
nb_execution_mode = "cache"
nb_execution_timeout = 600
nb_execution_raise_on_error = True
nb_merge_streams = True

napoleon_custom_sections = ["Validity", "Source"]
autodoc_typehints = "none"  # docstrings give shapes and units
autodoc_member_order = "bysource"
nitpick_ignore_regex = [("py:.*", ".*")]  # types are words there; links of pages are checked


def _equation(page: HTML5Translator, node: nodes.math) -> None:
    page.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _displayed_equation(page: HTML5Translator, node: nodes.math_block) -> None:
    page.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def _plain_words(_: Sphinx, what: str, *event: Any) -> None:
    """Axes such as `*b` begin no emphasis; the words before a colon are no type of a property."""
    lines = event[-1]
    lines[:] = [line if ">>>" in line else line.replace("*", r"\*") for line in lines]
    if what == "property":
        lines[:0] = ["..", ""]  # an empty remark


def _plain_types(*event: Any) -> None:
    """Types of attributes as the source has them."""
    lines = event[-1]
    for number, line in enumerate(lines):
        if line.lstrip().startswith(":type:"):
            start, given, words = line.partition(":type: ")
            short = re.sub(r"(?:\w+\.)+(?=\w)", "", words)
            lines[number] = f"{start}{given}``{short}``"


def setup(app: Sphinx) -> None:
    """Have equations in the browser's own form, and pages from the schema and the registries."""
    from generate import write

    app.add_html_math_renderer("mathml", (_equation, None), (_displayed_equation, None))
    app.connect("autodoc-process-docstring", _plain_words, priority=400)  # before napoleon
    app.connect("autodoc-process-docstring", _plain_types, priority=600)
    app.connect("builder-inited", lambda _: write(Path(__file__).parent / "reference"))
