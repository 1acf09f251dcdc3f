"""Site of the documentation: `sphinx-build -W -n docs docs/_build`."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent))

project = "Pitchpoint"
author = "The Pitchpoint authors"
copyright = author
version = release = installed("pitchpoint")

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_build", "jupyter_execute"]
html_theme = "furo"
html_title = "Pitchpoint"
html_static_path: list[str] = []

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
suppress_warnings = [
    "docutils"
]  # shapes such as (*b, 3) look like emphasis to it; links still count
nitpick_ignore_regex = [("py:.*", ".*")]  # types are words there; links of pages are checked


def setup(app: Sphinx) -> None:
    """Write the pages that come from the schema and the registries."""
    from generate import write

    app.connect("builder-inited", lambda _: write(Path(__file__).parent / "reference"))
