"""Which rows of a published case feel its inputs: `python tests/long/perturbed_inputs.py CASE [VARIANT]`.

Each number that the case gives is made 2 % larger, alone, and everything that its rows read is computed
anew. Rows whose verdict no input changes are listed, as they may be unable to fail, and inputs that change
no row's number. Whole numbers, as teeth and grids, are left as they are, and so is what a study changes.
"""

import re
import sys
from collections.abc import Iterator, Mapping
from copy import deepcopy
from typing import Any

from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import PitchpointError
from pitchpoint.runs.run import rows_of

LARGER = 1.02
FELT = 1e-9
"""Relative change of a number from which on a row feels an input."""

OWN = ("gears", "materials", "lubricant", "roughness", "operation", "models", "film", "formulas")
"""Tables of inputs."""

NUMBER = re.compile(r"^\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)(.*)$")

Path = tuple[str | int, ...]


def numbers(tree: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Places of numbers, with units or without, and their values."""
    if isinstance(tree, Mapping):
        inside = [("value", tree["value"])] if "value" in tree else tree.items()
        for key, value in inside:
            yield from numbers(value, (*path, key))
    elif isinstance(tree, list):
        for place, value in enumerate(tree):
            yield from numbers(value, (*path, place))
    elif isinstance(tree, float) or (isinstance(tree, str) and NUMBER.match(tree)):
        yield path, tree


def larger(value: Any) -> Any:
    """The number 2 % larger; a temperature as much over absolute zero."""
    if isinstance(value, float):
        return value * LARGER
    found = NUMBER.match(value)
    assert found
    number, unit = float(found[1]), found[2]
    zero = 273.15 if "degC" in unit else 0.0
    return f"{(number + zero) * LARGER - zero!r}{unit}"


def changed(tree: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """The tree with a larger number at a place."""
    found = deepcopy(dict(tree))
    inside: Any = found
    for key in path[:-1]:
        inside = inside[key]
    inside[path[-1]] = larger(inside[path[-1]])
    return found


def inputs(tree: Mapping[str, Any], variant: str) -> Iterator[Path]:
    """Places of inputs of the case and of a variant."""
    for above in ((), ("variants", variant)):
        inside: Any = tree
        for key in above:
            inside = inside.get(key, {})
        for table in OWN:
            yield from ((*above, table, *path) for path, _ in numbers(inside.get(table, {})))


def main(case: str, variant: str = "as_published") -> None:
    """Print what feels nothing."""
    name, tree = find_case(case)
    base = rows_of(Variant(tree, name, variant))
    steady, deaf = {place for place, row in enumerate(base) if row.computed is not None}, []
    for path in inputs(tree, variant):
        key = ".".join(str(part) for part in path if part != "value")
        try:
            rows = rows_of(Variant(changed(tree, path), name, variant))
        except PitchpointError as error:
            print(f"{key}: {error}")
            continue
        steady -= {place for place, row in enumerate(rows) if row.verdict != base[place].verdict}
        pairs = [
            (one, other) for one, other in zip(base, rows, strict=True) if one.computed is not None
        ]
        moved = [
            abs(other.computed - one.computed) / max(abs(one.computed), one.tolerance, 1e-30)
            for one, other in pairs
        ]
        if not any(not change <= FELT for change in moved):
            deaf.append(key)
        print(f"{key}: {sum(not change <= FELT for change in moved)} rows move", flush=True)
    kept = [f"{base[place].quantity} ({base[place].kind})" for place in sorted(steady)]
    for title, found in (("Rows that keep their verdict", kept), ("Inputs unfelt", deaf)):
        print(f"\n{title}:", *(found or ["none"]), sep="\n  ")


if __name__ == "__main__":
    main(*sys.argv[1:])
