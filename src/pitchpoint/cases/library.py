"""Cases that ship with the package, and cases in files."""

import os
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from pitchpoint import published
from pitchpoint.cases.document import Tree, read_tables
from pitchpoint.errors import InputError, shorten, visible
from pitchpoint.registry import nearest

__all__ = ["as_text", "case_names", "case_path", "find_case", "table"]

if TYPE_CHECKING:
    import pandas as pd


def case_names() -> list[str]:
    """Names of the shipped cases."""
    return [*_shipped()]


@cache
def _shipped() -> tuple[str, ...]:
    """Names of the shipped cases, looked for once: a run asks four times."""
    folder = resources.files(published)
    return tuple(
        sorted(entry.name for entry in folder.iterdir() if (entry / "case.toml").is_file())
    )


def case_path(case: str) -> Path:
    """File of a shipped case, or the file itself.

    Raises:
        InputError: neither a shipped case nor a file.
    """
    if case in case_names():
        return Path(str(resources.files(published) / case / "case.toml"))
    if Path(case).suffix == "" and not _exists(Path(case)):
        from pitchpoint.cases.other_formats import neighbours

        message = f"'{shorten(case)}' is neither a shipped case nor a file"
        raise InputError(f"{message}{neighbours(Path(case)) or nearest(case, case_names())}")
    return Path(case)


def _of_a_result(path: Path) -> str:
    """What to give in the place of a folder, or of a file of a result; empty for what may be a case."""
    is_folder = os.path.isdir(path)  # other than pathlib's it takes names of any length
    if not is_folder and not (path.suffix in _WRITTEN and os.path.isfile(path)):
        return ""
    folder = path if is_folder else path.parent
    kind = "a folder" if is_folder else _WRITTEN[path.suffix]
    for place in (folder, folder.absolute().parent):
        if (place / "run.json").is_file():
            result = shorten(as_text(str(place)))
            return f"is {kind} of a result, no case; give {result}, which computes the same"
    inside = ", ".join(shorten(place.name) for place in sorted(folder.glob("*.toml"))[:3])
    return f"is {kind}, no case file{f'; there are {inside} in it' if is_folder and inside else ''}"


_WRITTEN = {".nc": "a dataset", ".html": "a page"}
"""Files of a result, by their ending."""


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a name that no file system takes
        return False


def find_case(case: str) -> tuple[str, Tree]:
    """Short name and tables of a case by its name or its file.

    Raises:
        InputError: none is given; what is given belongs to a result, or is no case file.
    """
    if not case.strip():
        raise InputError(f"no case was given; name a file or one of {', '.join(case_names())}")
    path = case_path(case)
    if reason := _of_a_result(path):
        raise InputError(reason, file=visible(as_text(case)))
    tree = read_tables(path)
    return (case if case in case_names() else visible(as_text(path.name))), tree


def as_text(path: str) -> str:
    """Path that can be written into any file; bytes in it that are no UTF-8 are spelled out."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


def table() -> "pd.DataFrame":
    """Names and titles of the shipped cases.

    Example:
        >>> "tian2024" in table().index
        True
    """
    import pandas as pd

    rows = [
        {"case": name, "title": str(find_case(name)[1].get("title", ""))} for name in case_names()
    ]
    return pd.DataFrame(rows).set_index("case")
