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

__all__ = ["REMAINS", "grid_errors", "of_patches"]

UNKNOWN: Final = (np.nan, np.nan)
"""Errors of films that have no coarser grid beside them."""

REMAINS: Final = np.array([0.4, 0.5])
"""Error of the logarithm of the film in the middle, and of the smallest one, over what the last doubling of
the nodes changed: logarithms, as half as many cells may leave a smallest film an eighth of what it is.

Chosen in view of 32 ellipses and 15 finite lines of M 5 to 91, seeds 901, 911 to 914 and 921 to 923;
`tests/long/errors_of_grids.py` judges by others.
"""

OF_ROW: Final = 0.9
"""The same of the smallest film of a row over what that row changed which changed most."""

LINE_FALLS: Final = 0.6
"""Part of an error that twice as many nodes leave of lines, whose films at the ends come nearer slowly."""


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
    Where the film in the middle happens to be alike on both grids and the mean film is not, the mean tells;
    of lines, and with bounded flow, where the grid decides in which row the film is smallest, the row that
    changes most.

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
    fine = _films(problem, gap, held)
    mean = float(fine[1]) / float(problem.film)
    rise = np.asarray(problem.flow.temperature_rise)
    near = Earlier(layout, pressure - held, mean, rise if rise.ndim else None)
    half = as_warm(near, layout, problem_on(contact, layout, nodes // 2 + 1, cells // 2, cells))
    dry = np.asarray(dry_under(half).pressure)
    begin, level = warm_start(near, layout, half, dry)
    state = iterated(half, array(begin), array(level), WARM_TIME, None, CAREFUL)
    if not state.residual < ENOUGH:
        return UNKNOWN
    coarse_gap = np.asarray(gap_on(half, state.pressure, state.level))
    coarse = _films(half, coarse_gap, dry)
    if not np.nanmin([coarse, fine]) > 0.0:  # parts of a film that is none
        return UNKNOWN
    apart = np.abs(np.log(coarse / fine))
    central, least = np.expm1(REMAINS * [np.max(apart[:2]), apart[2]])
    if layout.bounded or contact.length is not None:
        carries = np.any(dry > 0.0, axis=1)
        low = np.interp(half.bodies.y, problem.bodies.y, np.log(np.min(gap, axis=1)))
        of_rows = np.abs(np.log(np.min(coarse_gap, axis=1)) - low)
        least = max(least, np.expm1(OF_ROW * np.max(of_rows[carries])))
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


def _films(
    problem: Problem, gap: NDArray[np.float64], dry: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Film in the middle, NaN where nothing touches near it, mean and smallest one, shape (3,)."""
    x, y = np.asarray(problem.bodies.x), np.asarray(problem.bodies.y)
    ridge = [np.interp(0.0, x, row) for row in gap]
    weight = np.asarray(problem.bodies.areas)[:, None] * dry
    mean = np.sum(gap * weight) / np.sum(weight)
    return np.array([np.interp(0.0, y, ridge, left=np.nan, right=np.nan), mean, np.min(gap)])
