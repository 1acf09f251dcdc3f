"""Cases that ship with the package, and cases in files."""

import os
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

from pitchpoint import published
from pitchpoint.cases.document import Tree, read
from pitchpoint.errors import InputError, shorten, visible
from pitchpoint.registry import nearest

__all__ = ["as_text", "find", "names", "path_of", "table"]

if TYPE_CHECKING:
    import pandas as pd


def names() -> list[str]:
    """Names of the shipped cases."""
    folder = resources.files(published)
    return sorted(item.name for item in folder.iterdir() if (item / "case.toml").is_file())


def path_of(case: str) -> Path:
    """File of a shipped case, or the file itself.

    Raises:
        InputError: neither a shipped case nor a file.
    """
    if case in names():
        return Path(str(resources.files(published) / case / "case.toml"))
    if Path(case).suffix == "" and not _exists(Path(case)):
        from pitchpoint.cases.other_formats import neighbours

        told = f"'{shorten(case)}' is neither a shipped case nor a file"
        raise InputError(f"{told}{neighbours(Path(case)) or nearest(case, names())}")
    return Path(case)


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except OSError:  # a name that no file system takes
        return False


def find(case: str) -> tuple[str, Tree]:
    """Short name and tables of a case by its name or its file."""
    path = path_of(case)
    tree = read(path)
    return (case if case in names() else visible(as_text(path.name))), tree


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

    rows = [{"case": name, "title": str(find(name)[1].get("title", ""))} for name in names()]
    return pd.DataFrame(rows).set_index("case")
