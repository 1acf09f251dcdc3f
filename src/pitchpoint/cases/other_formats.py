"""Why a file is no case file, and what to write: other formats, signs and names that are nearly right."""

import re
from pathlib import Path

from pitchpoint.errors import shorten
from pitchpoint.registry import similar_names
from pitchpoint.units import comma_readings

__all__ = ["neighbours", "not_toml", "not_utf_8"]

_CASE = 'a case file is TOML, with tables such as [gears] and lines such as module = "2 mm"'

_SHAPES = (
    ("JSON", re.compile(r"\s*\{\s*(\"|\}|$)")),
    ("YAML", re.compile(r"(?:[ \t]*(?:#.*)?\n|---[ \t]*\n)*[ \t]*(?:- )?[A-Za-z_][\w .-]*:(\s|$)")),
    ("XML or HTML", re.compile(r"\s*<[?!A-Za-z]")),
    (
        "a table of values, CSV say",
        re.compile(r"(?:[ \t]*(?:#.*)?\n)*(?![ \t]*#)[^=\n\[\]]*[,;\t][^=\n\[\]]*(\n|$)"),
    ),
)
"""Formats, and how a file of each begins."""

_QUOTES = re.compile("[\u201c\u201d\u201e\u201f\u2018\u2019\u201a\u00ab\u00bb\u2033\u00b4]")
_COMMA = re.compile(r"(?<![\w.\"'])[+-]?\d+,\d+(?![\w.,])")
_BARE = re.compile(
    r"[\w.]+\s*=\s*([+-]?[\d.]+(?:e[+-]?\d+)? ?[A-Za-z\u00b5\u03bc\u00b0%/][^\"'#]*?)\s*(?:#.*)?"
)
_SPACED = re.compile(r"\[\s*[+-]?[\d.]+(?:\s+[+-]?[\d.]+)+\s*\]")
_COLON = re.compile(r"([\w.]+)\s*:\s+(\S.*)")
_PATH = re.compile(r"([\w.]+)\s*=\s*\"([^\"]*\\[^\"]*)\"")
_KEY = re.compile(r"([A-Za-z]\w*(?:[ \t]+\w+)+)\s*=(?!=)")
_NOTHING = re.compile(r"([\w.]+)\s*=\s*(null|None|nil|NULL|NaN|undefined|-)?")
_TRUTH = re.compile(r"([\w.]+)\s*=\s*(True|False|TRUE|FALSE|yes|no|on|off)")
_WORD = re.compile(r"([\w.]+)\s*=\s*([A-Za-z][\w-]*)")
_AFTER = re.compile(
    r"([\w.]+\s*=\s*(?:\"[^\"]*\"|'[^']*'|[\w.+-]+|\[.*\]))\s*(;|,|//|%|--|\\)\s*(.*)"
)
_AGAIN = re.compile(r"Cannot (declare .* twice|overwrite a value)")
_LINE = re.compile(r"\(at line (\d+), column")


def not_utf_8(error: UnicodeDecodeError) -> str:
    """Why a file is no UTF-8 text: in what it was saved, and the first sign that shows it."""
    content = bytes(error.object)
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "is UTF-16 text; save it as UTF-8"
    if b"\0" in content:
        return "is not text, so it is no case file"
    line = content.count(b"\n", 0, error.start) + 1
    sign = content[error.start : error.start + 1].decode("cp1252", "replace")
    character = f'"{sign}" in Latin-1' if sign.isprintable() and sign != "\ufffd" else "no sign"
    return f"is not UTF-8 text: line {line} has a byte that is {character}; save it as UTF-8"


def not_toml(text: str, error: ValueError) -> str:
    """Why a text is not TOML, with what to write where that can be told.

    Args:
        text: of the file.
        error: of the reader.
    """
    for name, shape in _SHAPES:
        if shape.match(text[:2000]):
            return f"looks like {name}; {_CASE}"
    again = bool(_AGAIN.search(str(error)))
    at_end = again or "end of document" in str(error)  # where the reader tells no line
    line_count = len(text.splitlines()) if at_end else 0
    number = int((_LINE.search(str(error)) or [0, line_count])[1])
    line = [*text.splitlines(), ""][number - 1] if 0 < number <= text.count("\n") + 1 else ""
    return f"is not a TOML file: {_mended(line, number, again) or error}"


def _mended(line: str, number: int, again: bool) -> str:
    """What is wrong with a line and what it should have; empty where that is not known.

    Args:
        line: of the file.
        number: of that line.
        again: True where the line gives something a second time.
    """
    code, at = line.partition("#")[0].strip()[:200], f"line {number}"
    if quote := _QUOTES.search(code):
        straight = shorten(_QUOTES.sub('"', code))
        return f"{at} has the quotation mark {quote[0]}; write straight ones, {straight}"
    if bare := _BARE.fullmatch(code):
        return (
            f'{at} has a value with its unit outside of quotation marks; write "{shorten(bare[1])}"'
        )
    if path := _PATH.fullmatch(code):
        plain = shorten(f"{path[1]} = '{path[2]}'")
        return f"{at} has a backslash between quotation marks; write {plain}, or / in its place"
    if nothing := _NOTHING.fullmatch(code):
        return f"{at} has no value for {shorten(nothing[1])}; leave the line out, or give one"
    if truth := _TRUTH.fullmatch(code):
        plain = "true" if truth[2].lower() in ("true", "yes", "on") else "false"
        return f"{at} has {truth[2]}; write {shorten(f'{truth[1]} = {plain}')}"
    if word := _WORD.fullmatch(code):
        cure = shorten(f'{word[1]} = "{word[2]}"')
        return f"{at} has a word outside of quotation marks; write {cure}"
    if comma := _COMMA.search(code):
        meant = comma_readings(comma[0])
        which = "before decimals" if len(meant) == 1 else "in a number"
        return f"{at} has a comma {which}, {comma[0]}; write {' or '.join(meant)}"
    if (opened := code.count("[")) > code.count("]") and code.startswith("["):
        closed = f"{code.rstrip('] ')}{']' * opened}"
        return f"{at} opens a table that it does not close; write {shorten(closed)}"
    if again:
        what = "table" if code.startswith("[") else "key"
        return f"{at} has a {what} that was there before, {shorten(code)}; write it once"
    if spaced := _SPACED.search(code):
        cure = f"[{', '.join(spaced[0].strip('[]').split())}]"
        return f"{at} has a list without commas; write {shorten(cure)}"
    if after := _AFTER.fullmatch(code):
        remark = f"  # {after[3]}" if after[3] else ""
        return f"{at} has {after[2]} behind a value; write {shorten(after[1] + remark)}"
    if key := _KEY.match(code):
        joined = "_".join(key[1].split())
        return f"{at} has a space inside a key; write {shorten(joined)}"
    if colon := _COLON.fullmatch(code):
        return f"{at} has a colon; write {shorten(f'{colon[1]} = {colon[2]}')}"
    return ""


def neighbours(path: Path) -> str:
    """End of a sentence on a file that is not there: case files beside it whose names are nearly the same."""
    try:
        files = sorted(path.parent.glob("*.toml"))[:1000]
    except (OSError, ValueError):
        return ""
    close = similar_names(path.name.partition(".")[0], [file.stem for file in files])
    names = [file.name for file in files if file.stem in close and file.name != path.name]
    return f"; did you mean {' or '.join(map(shorten, names))}?" if names else ""
