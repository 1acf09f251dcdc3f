"""Outlines and courses for the page: no more corners than can be seen."""

from math import hypot

import numpy as np

__all__ = ["simplified", "visible_points"]

_WIDE, _HIGH, _FINE = 480.0, 240.0, 0.8
"""Pixels of a figure beside another, and how far a course may be moved by."""


def simplified(outline: np.ndarray, fine: float) -> np.ndarray:
    """Outline without the corners that lie closer than `fine` to a line between others [corner, xy].

    Source: Douglas and Peucker's method.
    """
    corners: np.ndarray = outline[_corners(outline, fine)]
    return corners


def visible_points(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Places of the points of a course without which it would look otherwise, gaps among them [point].

    Args:
        x, y: the course, as high and wide in its figure as it can be; NaN where it is interrupted.
    """
    gaps = ~np.isfinite(x + y)
    pixels = np.stack([_scaled(x, _WIDE), _scaled(y, _HIGH)], axis=1)
    visible = gaps & ~np.append(gaps[1:], False)  # of a gap its last place
    for run in np.split(np.arange(x.size), np.flatnonzero(np.diff(gaps)) + 1):
        if run.size and not gaps[run[0]]:
            visible[run] = _corners(pixels[run], _FINE)
    return np.flatnonzero(visible)


def _scaled(values: np.ndarray, pixels: float) -> np.ndarray:
    finite = values[np.isfinite(values)]
    return values * (pixels / (np.ptp(finite) or 1.0)) if finite.size else values


def _corners(outline: np.ndarray, fine: float) -> np.ndarray:
    """True for corners that stay [corner]."""
    corners = np.zeros(len(outline), bool)
    corners[[0, -1]] = True
    stack = [(0, len(outline) - 1)]
    while stack:
        start, end = stack.pop()
        inside = outline[start + 1 : end]
        if not len(inside):
            continue
        (dx, dy), (x, y) = outline[end] - outline[start], (inside - outline[start]).T
        span = hypot(dx, dy)
        away = np.abs(dx * y - dy * x) / span if span > 0.0 else np.hypot(x, y)
        farthest = int(np.argmax(away))
        if away[farthest] > fine:
            middle = start + 1 + farthest
            corners[middle] = True
            stack += [(start, middle), (middle, end)]
    return corners
