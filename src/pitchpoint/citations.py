"""The references behind formulas and data, by key, as one line or as BibTeX."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources

from pitchpoint.errors import InputError
from pitchpoint.registry import unknown_name

__all__ = ["Reference", "available", "bibtex", "citation_text", "of_program", "reference"]


@dataclass(frozen=True, kw_only=True)
class Reference:
    """One entry of references.toml; what could not be confirmed is empty.

    Args:
        key: name of the entry, author and year.
        kind: "article", "proceedings", "thesis", "book", "standard", "catalogue" or "software".
        authors: names as "Family, Given"; a last "others" stands for names left out.
        title: title.
        year: year of publication.
        journal: journal of an article, or the volume of proceedings.
        volume: volume.
        number: issue.
        pages: pages, or the article number.
        publisher: publisher, issuing body, or the address of a program.
        doi: digital object identifier.
        note: anything a reader should know.
    """

    key: str
    kind: str
    authors: tuple[str, ...]
    title: str
    year: int
    journal: str = ""
    volume: str = ""
    number: str = ""
    pages: str = ""
    publisher: str = ""
    doi: str = ""
    note: str = ""


_BIBTEX_KINDS = {
    "article": "article",
    "proceedings": "inproceedings",
    "thesis": "phdthesis",
    "book": "book",
    "standard": "misc",
    "catalogue": "misc",
    "software": "misc",
}
_ISSUED = ("standard", "catalogue")
_PUBLISHERS = {"misc": "howpublished", "phdthesis": "school"}
_ESCAPES = {"&": r"\&", "%": r"\%", "_": r"\_", "#": r"\#"}


@lru_cache(maxsize=1)
def _references() -> dict[str, Reference]:
    text = resources.files("pitchpoint").joinpath("references.toml").read_text(encoding="utf-8")
    return {key: _read(key, entry) for key, entry in tomllib.loads(text).items()}


def _read(key: str, entry: dict[str, object]) -> Reference:
    authors = entry.pop("authors")
    if entry["kind"] not in _BIBTEX_KINDS or not isinstance(authors, list):
        raise InputError("an entry needs a known kind and a list of authors", key=key)
    return Reference(key=key, authors=tuple(authors), **entry)  # type: ignore[arg-type]


def available() -> tuple[str, ...]:
    """Return the keys of all references, in alphabetical order."""
    return tuple(sorted(_references()))


def reference(key: str) -> Reference:
    """Return one reference.

    Raises:
        InputError: there is no such key; the message has the nearest ones.
    """
    if key not in _references():
        raise unknown_name(key, _references(), what="a reference")
    return _references()[key]


def citation_text(key: str) -> str:
    """Return a reference as one line of plain text.

    Raises:
        InputError: there is no such key.

    Example:
        >>> citation_text("johnson_1985")
        'Johnson, K. L. (1985). Contact Mechanics. Cambridge University Press.'
    """
    entry = reference(key)
    doi = f"doi:{entry.doi}" if entry.doi else ""
    parts = (f"{_names(entry)} ({entry.year}). {entry.title}", _where(entry), doi)
    return ". ".join(part.rstrip(".") for part in parts if part) + "."


def bibtex(key: str) -> str:
    """Return a reference as a BibTeX entry.

    Raises:
        InputError: there is no such key.
    """
    entry = reference(key)
    pages = entry.pages.replace("-", "--")
    kind = _BIBTEX_KINDS[entry.kind]
    fields = {
        "author": " and ".join(_bib_name(entry, name) for name in entry.authors),
        "title": "{" + _escaped(entry.title) + "}",
        "year": str(entry.year),
        "booktitle" if kind == "inproceedings" else "journal": _escaped(entry.journal),
        "volume": entry.volume,
        "number": entry.number,
        "pages": pages,
        _PUBLISHERS.get(kind, "publisher"): _escaped(entry.publisher),
        "doi": entry.doi,
        "note": _escaped(entry.note),
    }
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items() if value]
    return "\n".join([f"@{kind}{{{key},", *lines, "}"])


def of_program(version: str, *, bibtex: bool = False) -> str:
    """Pitchpoint itself, in words or as a BibTeX entry.

    Args:
        version: of the package.
        bibtex: True for an entry.

    Example:
        >>> of_program("0.1.0")
        'pitchpoint: The Pitchpoint authors. Pitchpoint, version 0.1.0. Software.'
    """
    if not bibtex:
        return f"pitchpoint: The Pitchpoint authors. Pitchpoint, version {version}. Software."
    fields = {
        "author": "{The Pitchpoint authors}",
        "title": "Pitchpoint",
        "note": f"version {version}",
    }
    lines = [f"  {name} = {{{value}}}," for name, value in fields.items()]
    return "\n".join(["@misc{pitchpoint,", *lines, "}"])


def _escaped(text: str) -> str:
    return "".join(_ESCAPES.get(letter, letter) for letter in text)


def _bib_name(entry: Reference, name: str) -> str:
    """Brace the name of an organisation, which BibTeX would split into first and last names."""
    return f"{{{_escaped(name)}}}" if entry.kind in _ISSUED else _escaped(name)


def _names(entry: Reference) -> str:
    *first, last = entry.authors
    if not first:
        return last
    return ", ".join(first) + (" et al." if last == "others" else f" and {last}")


def _where(entry: Reference) -> str:
    issue = f"{entry.volume}({entry.number})" if entry.number else entry.volume
    return ", ".join(p for p in (entry.journal, issue, entry.pages, entry.publisher) if p)
