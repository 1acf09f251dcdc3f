"""Functions that remember what they gave last: points of a sweep have most of their tables in common."""

from collections import deque
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

__all__ = ["remembering"]

P = ParamSpec("P")
R = TypeVar("R")

MOST = 8
"""Results that are kept: rivals of a comparison, or values that are swept beside another key."""


def remembering(function: Callable[P, R]) -> Callable[P, R]:
    """The function, which gives the same result again where its arguments are equal to recent ones.

    Tables with dictionaries in them have no hash, so that `lru_cache` does not take them. Equal results are
    one object: rows of a batch that share it are stacked without a look at their numbers.

    Args:
        function: pure, of values that compare by `==`; its result is not to be changed.
    """
    memory: deque[tuple[object, R]] = deque(maxlen=MOST)

    @wraps(function)
    def take(*args: P.args, **named: P.kwargs) -> R:
        arguments = args, named
        for before, result in tuple(memory):  # another thread may add to it
            if before == arguments:
                return result
        result = function(*args, **named)
        memory.appendleft((arguments, result))
        return result

    return take
