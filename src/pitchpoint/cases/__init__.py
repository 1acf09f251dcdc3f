"""Cases: TOML files that describe a gear pair and what to compute; published ones ship with the package."""

import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd


class _Listed(ModuleType):
    """This package, which lists the cases that ship when it is called: `pitchpoint.cases()`."""

    def __call__(self) -> "pd.DataFrame":
        """Names and titles of the cases that ship with the package."""
        from pitchpoint.cases.library import table

        return table()


sys.modules[__name__].__class__ = _Listed
