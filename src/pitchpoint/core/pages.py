"""Pages of the documentation in Markdown, as the package ships them or as they lie in a clone."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from pitchpoint.errors import InputError, shorten
from pitchpoint.registry import known_as, similar_names

__all__ = ["is_page", "page_names", "page_text", "search_pages", "title"]

_PACKAGE = Path(__file__).parents[1]
_FOLDER = next(
    (folder for folder in (_PACKAGE / "docs", _PACKAGE.parents[1] / "docs") if folder.is_dir()),
    None,
)
_FOR_THE_SITE = ("_", "index", "reference/api")
"""Beginnings of what says nothing outside of the site: `help` tells what a Python name is."""

MOST = 10
"""Places that a search lists."""

_HEAD = re.compile(r"\A---\n.*?\n---\n+", re.DOTALL)


def page_names() -> list[str]:
    """Names of the pages, by folder."""
    if _FOLDER is None:
        return []
    paths = sorted(path.relative_to(_FOLDER).with_suffix("") for path in _FOLDER.rglob("*.md"))
    every = [path.as_posix() for path in paths]
    return [name for name in every if not name.startswith(_FOR_THE_SITE)]


def page_text(name: str) -> str:
    """Text of a page.

    Args:
        name: "guide/sizing", "guide/sizing.md", or "sizing" where only one page ends so.

    Raises:
        InputError: there is no such page.
    """
    chosen = _chosen(name)
    if chosen is None or _FOLDER is None:
        words = "" if "/" in name else ", nor is it on one"
        near = similar_names(name.removesuffix(".md"), page_names())
        advice = f"; did you mean {' or '.join(near)}?" if near else ", which pitchpoint docs lists"
        raise InputError(f"'{shorten(name)}' is no page of the documentation{words}{advice}")
    return _HEAD.sub("", (_FOLDER / f"{chosen}.md").read_text("utf-8"))


def is_page(name: str) -> bool:
    """True for the name of a page, see `page_text`."""
    return _chosen(name) is not None


def _chosen(name: str) -> str | None:
    """Whole name of a page; None for that of none, or of several."""
    wanted, every = name.removesuffix(".md"), page_names()
    ending = [page_name for page_name in every if page_name.rpartition("/")[2] == wanted]
    return known_as(wanted, every) or (ending[0] if len(ending) == 1 else None)


def search_pages(words: str) -> list[dict[str, str]]:
    """Lines that have all of some words, the nearest first: titles, headings, rows of a table, others.

    Where no line has them all, pages that have them are listed with their titles; where no page has them,
    those that have most of them.

    Args:
        words: of any case, with spaces between them; those without a letter or a figure do not count.

    Returns:
        At most `MOST` places, two of one page at most: the page, its line without marks, and the words that
        it lacks, if any.
    """
    wanted = [word for word in words.lower().split() if any(map(str.isalnum, word))]
    if not wanted:
        return []
    hits = sorted(
        (_rank(line, wanted[0]), name, _plain(line))
        for name in page_names()
        for line in page_text(name).splitlines()
        if _has(line, wanted)
    ) or [(0, name, title(name)) for name in page_names() if _has(page_text(name), wanted)]
    lines_of_page: Counter[str] = Counter()
    shown_lines: list[dict[str, str]] = []
    for _, name, line in hits:
        lines_of_page[name] += 1
        if lines_of_page[name] <= _OF_A_PAGE and len(shown_lines) < MOST:
            shown_lines.append({"page": name, "line": line})
    return shown_lines or _with_most(dict.fromkeys(wanted))


def _with_most(wanted: Iterable[str]) -> list[dict[str, str]]:
    """Pages with most of some words, those that name these most often first; none without any."""
    texts = {name: page_text(name).lower() for name in page_names()}
    counts = {name: {word: text.count(word) for word in wanted} for name, text in texts.items()}
    most = max(
        (sum(map(bool, count_of_word.values())) for count_of_word in counts.values()), default=0
    )
    nearest = [
        name
        for name, count_of_word in counts.items()
        if most and sum(map(bool, count_of_word.values())) == most
    ]
    lacks = {name: [word for word, count in counts[name].items() if not count] for name in nearest}
    nearest.sort(key=lambda name: (lacks[name], -min(filter(None, counts[name].values()))))
    return [
        {"page": name, "line": title(name), "without": ", ".join(lacks[name])}
        for name in nearest[:MOST]
    ]


def _has(text: str, words: Sequence[str]) -> bool:
    return all(word in text.lower() for word in words)


_OF_A_PAGE = 2
_MARKS = re.compile(r"\]\([^)]*\)|[\[\]`*|\\#>]+")


def _rank(line: str, word: str) -> int:
    """Place of a line in a search."""
    if line.startswith("#"):
        return 0 if line.startswith("# ") else 1
    return 2 if _plain(line).lower().startswith(word) else 3


def _plain(line: str) -> str:
    """A line without marks."""
    return " ".join(_MARKS.sub(" ", line).split())


def title(name: str) -> str:
    """Title of a page."""
    return next(line[2:] for line in page_text(name).splitlines() if line.startswith("# "))
