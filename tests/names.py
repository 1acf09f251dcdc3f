"""What the names of the package say: `python tests/names.py` counts them.

A generic name (`found`, `one`) says nothing of what it holds; the name of a class or
of a public function that stands twice means two things.
"""

import ast
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).parent.parent / "src" / "pitchpoint"

GENERIC = frozenset(
    [
        "one",
        "found",
        "told",
        "given",
        "own",
        "each",
        "first",
        "said",
        "known",
        "asked",
        "last",
        "whole",
        "same",
        "other",
        "more",
        "much",
        "many",
        "rest",
        "kept",
        "made",
        "put",
        "way",
        "thing",
        "things",
    ]
)


def trees() -> Iterator[tuple[Path, ast.Module]]:
    """Syntax tree of every module of the package."""
    for path in sorted(SOURCE.rglob("*.py")):
        yield path.relative_to(SOURCE), ast.parse(path.read_text(encoding="utf-8"))


def assigned() -> Counter[str]:
    """How often each name is assigned."""
    return Counter(
        node.id
        for _, tree in trees()
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
    )


def generic_share(names: Counter[str]) -> float:
    """Assignments to generic names over all assignments."""
    return sum(names[name] for name in GENERIC) / names.total()


COMMANDS = "cli.py"
"""Its functions are the commands, each named as the function that it calls."""


def _defined(kind: type[ast.ClassDef] | type[ast.FunctionDef]) -> Counter[str]:
    return Counter(
        node.name
        for path, tree in trees()
        if path.name != COMMANDS
        for node in tree.body
        if isinstance(node, kind)
    )


def repeated_classes() -> set[str]:
    """Names of classes that stand in several modules."""
    return {name for name, count in _defined(ast.ClassDef).items() if count > 1}


def repeated_functions() -> set[str]:
    """Public names of functions that stand in several modules."""
    defined = _defined(ast.FunctionDef)
    return {name for name, count in defined.items() if count > 1 and not name.startswith("_")}


if __name__ == "__main__":
    names = assigned()
    print(f"{generic_share(names):.1%} of {names.total()} assigned names are generic")
    print(
        *(f"  {count:5d} {name}" for name, count in names.most_common() if name in GENERIC),
        sep="\n",
    )
    for what, repeated in (("classes", repeated_classes()), ("functions", repeated_functions())):
        print(
            f"{len(repeated)} names of {what} stand more than once: {', '.join(sorted(repeated))}"
        )
