"""README and documentation as tests read them: their blocks, by page."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
RUN_WHILE_BUILT = ("gallery", "reference")
"""Folders of pages whose cells run while the site is built, or that are made from the code."""


def _pages() -> dict[str, str]:
    found = {"README.md": (ROOT / "README.md").read_text("utf-8")}
    for path in sorted((ROOT / "docs").rglob("*.md")):
        name = path.relative_to(ROOT / "docs")
        if not {"_build", *RUN_WHILE_BUILT} & set(name.parts):
            found[name.as_posix()] = path.read_text("utf-8")
    return found


PAGES = _pages()


def blocks(page: str, kind: str) -> list[str]:
    """Blocks of a kind on a page, in order."""
    fenced = re.findall(r"^```(\w+)\n(.*?)^```$", PAGES[page], re.DOTALL | re.MULTILINE)
    return [text for own, text in fenced if own == kind]


def block(page: str, kind: str, holding: str) -> str:
    """The one block of a kind on a page that holds some words."""
    (found,) = (text for text in blocks(page, kind) if holding in text)
    return found
