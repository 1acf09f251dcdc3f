"""Tables on a narrow screen: columns that keep numbers and keys whole, in as many blocks as it takes."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from textwrap import wrap

__all__ = ["Columns", "fitted", "lines_of"]

_WHOLE = 16
"""Characters up to which a cell is never broken: numbers, units, keys."""

_GAP = 1
"""Characters between columns."""

Columns = dict[str, int]
"""Names of columns that stand beside each other, each with its width in characters."""


def fitted(rows: Sequence[Mapping[str, str]], names: Sequence[str], width: int) -> list[Columns]:
    """Blocks of columns that fit beside each other; the first column stands in every block.

    A column is as wide as its content where there is room for all. Else long texts are broken at spaces, and
    where that is not enough columns go into a further block.

    Args:
        rows: of the table, cells by name of the column.
        names: of the columns.
        width: of the screen, in characters.

    Example:
        >>> rows = [{"law": "iso", "loss [W]": "13.58", "note": "a long remark on the law"}]
        >>> fitted(rows, ["law", "loss [W]", "note"], 40)
        [{'law': 3, 'loss [W]': 8, 'note': 24}]
        >>> fitted(rows, ["law", "loss [W]", "note"], 28)
        [{'law': 3, 'loss [W]': 5, 'note': 18}]
        >>> fitted(rows, ["law", "loss [W]", "note"], 12)
        [{'law': 3, 'loss [W]': 8}, {'law': 3, 'note': 8}]
    """
    cells = {name: [str(row.get(name, "")) for row in rows] for name in names}
    least = {name: _least(name, cells[name]) for name in names}
    natural = {name: max([len(name), *map(len, cells[name])]) for name in names}
    return [
        _shared({name: least[name] for name in block}, natural, width)
        for block in _blocks(least, width)
    ]


def lines_of(rows: Sequence[Mapping[str, str]], names: Sequence[str], width: int) -> Iterator[str]:
    r"""A table as lines of text, block below block; the heads stand above each.

    Args:
        rows: of the table, cells by name of the column.
        names: of the columns.
        width: of the screen, in characters.

    Example:
        >>> print(*lines_of([{"": "loss [W]", "new": "13.58"}], ["", "new"], 40), sep="\n")
                 new
        loss [W] 13.58
    """
    for block in fitted(rows, names, width):
        for row in ({name: name for name in block}, *rows):
            cells = [wrap(row.get(name, ""), size) or [""] for name, size in block.items()]
            for line in zip_longest(*cells, fillvalue=""):
                padded = (
                    f"{text:<{size}}" for text, size in zip(line, block.values(), strict=True)
                )
                yield (" " * _GAP).join(padded).rstrip()


def _least(name: str, cells: Sequence[str]) -> int:
    """Width below which a word of the head, or a number with its unit, would be broken."""
    words = [word for text in (name, *cells) for word in text.split()]
    short = [text for text in cells if len(text) <= _WHOLE]
    return max(map(len, [*words, *short]), default=1)


def _blocks(least: Columns, width: int) -> list[list[str]]:
    """Names of the columns of each block."""
    row_head, *others = least
    blocks = [[row_head]]
    for name in others:
        taken = sum(least[column] + _GAP for column in blocks[-1])
        if taken + least[name] > width and len(blocks[-1]) > 1:
            blocks.append([row_head])
        blocks[-1].append(name)
    return blocks


def _shared(least: Columns, natural: Columns, width: int) -> Columns:
    """Widths of one block: what is left goes to the columns that lack most of it."""
    widths = {name: min(size, max(width, 1)) for name, size in least.items()}
    room = width - sum(widths.values()) - _GAP * (len(widths) - 1)
    while room > 0 and (lacking := [name for name in widths if widths[name] < natural[name]]):
        widest = max(lacking, key=lambda name: natural[name] - widths[name])
        widths[widest] += 1
        room -= 1
    return widths
