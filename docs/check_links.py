"""Checks the built site: every link of it leads to a place that is there, nothing is loaded from elsewhere.

`python docs/check_links.py docs/_build/html`; addresses of other sites are links only, and are not opened.
"""

import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Places of a page that can be linked to, what it links to, and what it loads."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.places: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take what a tag names."""
        given = {name: value or "" for name, value in attrs}
        self.places |= {given[name] for name in ("id", "name") if name in given}
        self.loads += [given["src"]] if "src" in given else []
        if "href" in given:
            (self.links if tag == "a" else self.loads).append(given["href"])


def broken(folder: Path) -> Iterator[str]:
    """A sentence for each link that leads nowhere, and for what a page loads from elsewhere."""
    pages = {path.resolve(): Page(path.read_text("utf-8")) for path in folder.rglob("*.html")}
    for path, page in sorted(pages.items()):
        name = path.relative_to(folder.resolve())
        for link in dict.fromkeys(page.links + page.loads):
            to = urlsplit(link)
            if to.scheme == "data" or (to.scheme and link not in page.loads):
                continue
            if to.scheme or to.netloc:
                yield f"{name}: {link} is loaded from another site"
                continue
            target = (path.parent / unquote(to.path)).resolve() if to.path else path
            if not target.is_file():
                yield f"{name}: {link} leads to no file"
            elif (
                to.fragment and target in pages and unquote(to.fragment) not in pages[target].places
            ):
                yield f"{name}: {link} leads to no place of {target.name}"
    if not pages:
        yield f"{folder}: no page is there"


if __name__ == "__main__":
    found = list(broken(Path(sys.argv[1])))
    print("\n".join(found) or "every link leads somewhere")
    sys.exit(bool(found))
