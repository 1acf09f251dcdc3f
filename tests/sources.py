"""Where formulas come from, by docstrings of the rooms that compute: `python tests/sources.py` counts them.

A public name has a source in print where its docstring names an author with a year, a standard, a
numbered equation or a key of references.toml; it has a derivation where a sentence begins with `From` or
`Source:`, as in "From the balance of forces on each body".
"""

import ast
import re
import tomllib
from collections import Counter
from collections.abc import Iterator

from names import SOURCE, trees

ROOMS = (
    "materials",
    "contact",
    "gears",
    "loading",
    "lubrication",
    "strength",
    "wear",
    "efficiency",
    "dynamics",
    "drive",
    "duty_cycle",
)

KEYS = tomllib.loads((SOURCE / "references.toml").read_text(encoding="utf-8"))

_AUTHOR = r"[A-ZÄÖÜ][\w'’-]+(?:(?:,| and| et al\.|['’]s?)? [A-ZÄÖÜ(][\w.'’-]*)*(?: and| et al\.|,)?"
PRINTED = re.compile(
    rf"{_AUTHOR}\s+\(?(?:1[6-9]|20)\d\d\b"
    r"|\b(?:ISO|DIN|VDI|AGMA|ASTM|IEC|IACS)[ /](?:TR |UR |D|M)?\d"
    r"|\b[Ee]qs?\. ?\(?\d|\b[Ee]quations? \(?\d"
    rf"|\b(?:{'|'.join(KEYS)})\b"
)
DERIVED = re.compile(r"(?:^|\.\s+|\n\s*)(?:From|Source:|By (?:virtual|automatic|Lagrange|Newton)) ")


def public() -> Iterator[tuple[str, str, str]]:
    """Room, name and docstring of each public class and function of these rooms."""
    for path, tree in trees():
        for node in tree.body:
            named = isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name[0] != "_"
            if named and path.parts[0] in ROOMS:
                yield path.parts[0], node.name, ast.get_docstring(node) or ""


def shares() -> tuple[float, float]:
    """Parts of the public names with a source in print, and with that or a derivation."""
    texts = [text for _, _, text in public()]
    printed = [bool(PRINTED.search(text)) for text in texts]
    either = [a or bool(DERIVED.search(text)) for a, text in zip(printed, texts, strict=True)]
    return sum(printed) / len(texts), sum(either) / len(texts)


if __name__ == "__main__":
    count: Counter[str] = Counter(room for room, _, _ in public())
    for room, total in count.items():
        texts = [text for there, _, text in public() if there == room]
        printed = sum(bool(PRINTED.search(text)) for text in texts)
        print(f"{printed:4d} of {total:4d} in {room}")
    print("{:.1%} name a source in print, {:.1%} that or a derivation".format(*shares()))
