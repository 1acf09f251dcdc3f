"""Outlines for the page: no more corners than can be seen."""

from math import hypot

import numpy as np

__all__ = ["simplified"]


def simplified(outline: np.ndarray, fine: float) -> np.ndarray:
    """Outline without the corners that lie closer than `fine` to a line between others [corner, xy].

    Source: Douglas and Peucker's method.
    """
    kept = np.zeros(len(outline), bool)
    kept[[0, -1]] = True
    stack = [(0, len(outline) - 1)]
    while stack:
        first, last = stack.pop()
        inside = outline[first + 1 : last]
        if not len(inside):
            continue
        (dx, dy), (x, y) = outline[last] - outline[first], (inside - outline[first]).T
        span = hypot(dx, dy)
        away = np.abs(dx * y - dy * x) / span if span > 0.0 else np.hypot(x, y)
        farthest = int(np.argmax(away))
        if away[farthest] > fine:
            middle = first + 1 + farthest
            kept[middle] = True
            stack += [(first, middle), (middle, last)]
    return outline[kept]
