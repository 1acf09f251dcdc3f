"""Pages of the documentation in Markdown, as the package ships them or as they lie in a clone."""

import re
from pathlib import Path

from pitchpoint.errors import InputError, shorten
from pitchpoint.registry import known_as, nearest

__all__ = ["names", "page", "title"]

_PACKAGE = Path(__file__).parent
_FOLDER = next(
    (one for one in (_PACKAGE / "docs", _PACKAGE.parents[1] / "docs") if one.is_dir()), None
)
_FOR_THE_SITE = ("_", "index", "reference/api")
"""Beginnings of what says nothing outside of the site: `help` tells what a Python name is."""

_HEAD = re.compile(r"\A---\n.*?\n---\n+", re.DOTALL)


def names() -> list[str]:
    """Names of the pages, by folder."""
    if _FOLDER is None:
        return []
    found = sorted(path.relative_to(_FOLDER).with_suffix("") for path in _FOLDER.rglob("*.md"))
    every = [path.as_posix() for path in found]
    return [name for name in every if not name.startswith(_FOR_THE_SITE)]


def page(name: str) -> str:
    """Text of a page.

    Args:
        name: "guide/sizing", "guide/sizing.md", or "sizing" where only one page ends so.

    Raises:
        InputError: there is no such page.
    """
    wanted, known = name.removesuffix(".md"), names()
    found = [one for one in known if one.rpartition("/")[2] == wanted]
    chosen = known_as(wanted, known) or (found[0] if len(found) == 1 else None)
    if chosen is None or _FOLDER is None:
        near = f"; there are {' and '.join(found)}" if found else nearest(wanted, known)
        raise InputError(f"'{shorten(name)}' is no page of the documentation{near}")
    return _HEAD.sub("", (_FOLDER / f"{chosen}.md").read_text("utf-8"))


def title(name: str) -> str:
    """Title of a page."""
    return next(line[2:] for line in page(name).splitlines() if line.startswith("# "))
