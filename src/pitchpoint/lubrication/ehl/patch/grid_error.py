"""How far off the grid makes the film of a contact of finite length, from a grid with half as many cells."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import array
from pitchpoint.doubts import Doubt
from pitchpoint.lubrication.ehl.doubts import of_grid
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import FEWEST, Layout, Problem, problem_on
from pitchpoint.lubrication.ehl.patch.newton import CAREFUL, ENOUGH, iterated
from pitchpoint.lubrication.ehl.patch.solve import (
    WARM_TIME,
    Earlier,
    as_warm,
    dry_under,
    gap_on,
    warm_start,
)
from pitchpoint.lubrication.ehl.registry import MOST_PATCH_NODES

__all__ = ["OF_ELLIPSE", "grid_errors", "of_patches"]

UNKNOWN: Final = (np.nan, np.nan)
"""Errors of films that have no coarser grid beside them."""

OF_ELLIPSE: Final = np.array([0.4, 0.45])
"""Estimated error of the film in the middle and of the smallest one of an ellipse, over the factor less one
that lies between the films of both grids: nine in ten are to be off by less, half by more than a third."""

OF_LINE: Final = np.array([0.4, 1.5])
"""The same of a line. Films at its ends come nearer by little with twice as many nodes."""

LINE_FALLS: Final = float(OF_LINE[1] / (1.0 + OF_LINE[1]))
"""Part of an error that twice as many nodes leave in nine of ten lines, if each doubling leaves the same."""


def grid_errors(
    contact: PatchContact,
    layout: Layout,
    problem: Problem,
    pressure: NDArray[np.float64],
    level: Any,
    held: NDArray[np.float64],
) -> tuple[float, float]:
    """Estimated errors of the film in the middle and of the smallest one, over these; NaN where unknown.

    The film is solved once more on a grid with half as many cells, from the one that is known, and as warm.

    Args:
        contact: one, as the grid lies.
        layout: of its grid.
        problem: the same in units of its own.
        pressure: solution, shape (y, x).
        level: of the surfaces.
        held: dry pressure, shape (y, x).
    """
    cells, nodes = pressure.shape
    if min(nodes, cells + 1) <= FEWEST:
        return UNKNOWN
    gap = np.asarray(gap_on(problem, array(pressure), level))
    weight = np.asarray(problem.bodies.areas)[:, None] * held
    mean = float(np.sum(gap * weight) / np.sum(weight)) / float(problem.film)
    rise = np.asarray(problem.flow.temperature_rise)
    near = Earlier(layout, pressure - held, mean, rise if rise.ndim else None)
    half = as_warm(near, layout, problem_on(contact, layout, nodes // 2 + 1, cells // 2, cells))
    begin, level = warm_start(near, layout, half, np.asarray(dry_under(half).pressure))
    state = iterated(half, array(begin), array(level), WARM_TIME, None, CAREFUL)
    if not state.residual < ENOUGH:
        return UNKNOWN
    coarse = _films(half, np.asarray(gap_on(half, state.pressure, state.level)))
    fine = _films(problem, gap)
    if not np.nanmin([coarse, fine]) > 0.0:  # parts of a film that is none
        return UNKNOWN
    apart = np.maximum(coarse, fine) / np.minimum(coarse, fine) - 1.0
    central, least = apart * (OF_ELLIPSE if contact.length is None else OF_LINE)
    return float(central), float(least)


def of_patches(
    errors: NDArray[np.float64], grid: tuple[int, int], *, line: bool
) -> Iterator[Doubt]:
    """That a grid is coarse for lines, or else ellipses, and which one is not.

    Args:
        errors: estimated, of films in the middle and of smallest ones, over them, shape (2, b).
        grid: number of nodes, and that of cells across.
        line: whether these are lines.
    """
    falls = LINE_FALLS if line else 0.5
    return of_grid(*errors, grid=grid, most=MOST_PATCH_NODES, falls=falls)


def _films(problem: Problem, gap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Film in the middle, NaN where nothing touches near it, and the smallest one, shape (2,)."""
    x, y = np.asarray(problem.bodies.x), np.asarray(problem.bodies.y)
    ridge = [np.interp(0.0, x, row) for row in gap]
    return np.array([np.interp(0.0, y, ridge, left=np.nan, right=np.nan), np.min(gap)])
