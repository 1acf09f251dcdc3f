"""Types and array shapes are checked while the tests run, as far as they say so in their annotations.

A program is checked as it is traced. One that an earlier run of the same sources left on disk is not traced
again, so what is in it was checked then; where it matters, start with an empty cache, as CI does.
"""

from importlib.util import find_spec
from pathlib import Path
from typing import Any, Self

from beartype import BeartypeConf, FrozenDict, beartype
from jaxtyping import install_import_hook

WORDS = {
    "__init__",
    "__main__",
    "citations",
    "core.kept",
    "core.programs",
    "errors",
    "registry",
    "units",
}
WORDS |= {"cases", "analyses", "runs", "results", "views", "notebook", "cli"}
"""Rooms without formulas; their tests put stand-ins in the place of much that they do not look at."""

CHECKED = BeartypeConf(
    is_pep484_tower=True,  # an int where a float is asked for, as type checkers take it
    hint_overrides=FrozenDict({Self: Any}),  # methods are seen without their class
)

check = beartype(conf=CHECKED)


def rooms() -> list[str]:
    """All folders that compute."""
    (package,) = find_spec("pitchpoint").submodule_search_locations
    every = [path for path in Path(package).iterdir() if path.name != "__pycache__"]
    names = {path.stem for path in every if path.suffix in ("", ".py")} - {"core"}
    names |= {f"core.{path.stem}" for path in Path(package, "core").glob("[!_]*.py")}
    return [f"pitchpoint.{name}" for name in sorted(names - WORDS)]


def install() -> None:
    """Have functions and modules checked that are imported from now on."""
    install_import_hook(rooms(), "shapes.check")
