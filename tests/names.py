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


EXCUSED = {
    "catalogue": "the materials of a module, `lubricants` and `solids`; scripts of users import them",
    "find": "one of these materials by its name; scripts of users import them",
    "none": "the law of that name in a case file, each under a registry of its own",
    "readings": "what the registry of published cases asks each of its formulas for",
    "pieces": "what an analysis is computed in, see `analyses.analysis.Analysis`",
    "further": "the piece after the last one of a march, see `analyses.analysis.Analysis`",
    "joined": "the dataset of all pieces, see `analyses.analysis.Analysis`",
    "film_part": "a piece of films, the `compute` of an analysis",
    "contact_ratio_factor": "the factor of ISO 6336 or VDI 2736 that has this name in each of its parts",
    "helix_factor": "likewise of the helix angle",
    "size_factor": "likewise of the size",
}
"""Names of functions that stand more than once, and why."""

EXCUSED_FILES = {
    "gears/*/family.py": "what every family says of itself, in a folder of its name",
    "gears/*/mesh.py": "what every mesh is asked, in the folder of its family",
    "gears/*/table.py": "the table `[gears]` of a case file, in the folder of its family",
    "published/*/publication.py": "what every publication lists, in a folder of its name",
    "published/*/printed.py": "the numbers that its publication prints",
    "published/*/table.py": "the table `[formulas]` of a case file, in the folder of its publication",
}
"""Files that are named by what a folder of their kind must have, and why."""


SAYS_NOTHING = GENERIC | frozenset(
    [
        "after",
        "alike",
        "answer",
        "answered",
        "apart",
        "before",
        "behind",
        "beneath",
        "beside",
        "between",
        "beyond",
        "both",
        "counted",
        "elsewhere",
        "felt",
        "few",
        "gone",
        "held",
        "sentences",
        "the",
        "through",
        "together",
        "usual",
        "wanted",
        "within",
        "words",
        "written",
    ]
)
"""What no public function may be called."""


def _defined(kind: type[ast.ClassDef] | type[ast.FunctionDef]) -> Counter[str]:
    """In how many modules each name is defined: overloads of a function are one."""
    return Counter(
        name
        for path, tree in trees()
        if path.name != COMMANDS
        for name in {node.name for node in tree.body if isinstance(node, kind)}
    )


def public_functions() -> Counter[str]:
    """In how many modules the public functions of each name stand."""
    defined = _defined(ast.FunctionDef)
    return Counter({name: count for name, count in defined.items() if not name.startswith("_")})


def repeated_classes() -> set[str]:
    """Names of classes that stand in several modules."""
    return {name for name, count in _defined(ast.ClassDef).items() if count > 1}


def repeated_functions() -> set[str]:
    """Public names of functions that stand in several modules."""
    return {name for name, count in public_functions().items() if count > 1}


def files_of_stem() -> dict[str, list[str]]:
    """Files of the package by their stem, without those that are excused."""
    excused = {path for pattern in EXCUSED_FILES for path in SOURCE.glob(pattern)}
    files: dict[str, list[str]] = {}
    for path in sorted({*SOURCE.rglob("*.py")} - excused - {*SOURCE.rglob("__init__.py")}):
        files.setdefault(path.stem, []).append(path.relative_to(SOURCE).as_posix())
    return files


def repeated_stems() -> dict[str, list[str]]:
    """Files of which more than two have one stem: an analysis and its section may."""
    return {stem: files for stem, files in files_of_stem().items() if len(files) > 2}


if __name__ == "__main__":
    names = assigned()
    print(f"{generic_share(names):.1%} of {names.total()} assigned names are generic")
    print(
        *(f"  {count:5d} {name}" for name, count in names.most_common() if name in GENERIC),
        sep="\n",
    )
    unexcused = repeated_functions() - EXCUSED.keys()
    for what, repeated in (("classes", repeated_classes()), ("functions", unexcused)):
        print(
            f"{len(repeated)} names of {what} stand more than once: {', '.join(sorted(repeated))}"
        )
    print(f"{len(EXCUSED)} names of functions are excused:")
    print(*(f"  {name}: {why}" for name, why in EXCUSED.items()), sep="\n")
    print(f"{len(repeated_stems())} stems of files stand more than twice")
    print(*(f"  {stem}: {', '.join(files)}" for stem, files in repeated_stems().items()), sep="\n")
