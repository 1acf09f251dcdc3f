"""Pitchpoint: load, sliding, film, friction and efficiency where gear teeth touch.

Importing the package costs next to nothing: a public name is loaded when it is first asked for.
"""

from importlib import import_module
from typing import Any

__version__: str

_LAZY: dict[str, str] = {}  # public name -> module that defines it


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("importlib.metadata").version("pitchpoint")
    if name in _LAZY:
        return getattr(import_module(_LAZY[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_LAZY, "__version__"])
