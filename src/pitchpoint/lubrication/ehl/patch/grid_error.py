"""How far off the grid makes the film of a contact of finite length, from a grid with half as many cells."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from pitchpoint._jax import array
from pitchpoint.core.doubts import Doubt
from pitchpoint.lubrication.ehl.doubts import of_grid
from pitchpoint.lubrication.ehl.ehl_registry import MOST_PATCH_NODES
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import FEWEST, Layout, PatchProblem, problem_on
from pitchpoint.lubrication.ehl.patch.newton import CAREFUL, ENOUGH, newton_on_patch
from pitchpoint.lubrication.ehl.patch.solve import (
    WARM_TIME,
    Earlier,
    as_warm,
    dry_under,
    gap_on,
    warm_start,
)

__all__ = ["OPENS", "REMAINS", "grid_errors", "of_patches"]

UNKNOWN: Final = (np.nan, np.nan)
"""Errors of films that have no coarser grid beside them."""

REMAINS: Final = np.array([0.35, 0.25])
"""Error of the logarithm of the film in the middle, and of the smallest one at least, over what the last
doubling of the nodes changed: logarithms, as half as many cells may leave a smallest film an eighth of what
it is.

With `OPENS` chosen in view of 29 ellipses and 25 finite lines of M 5 to 100 on 65 x 64;
`tests/long/errors_of_grids.py` names their seeds and judges by others.
"""

OPENS: Final = 0.43
"""Error of the smallest film over half of what the gap opens from its cell to both neighbours: films are
smallest in constrictions, at the outlet and to the sides, which may lie between cells on both grids alike."""

LINE_FALLS: Final = 0.6
"""Part of an error that twice as many nodes leave of lines, whose films at the ends come nearer slowly."""


def grid_errors(
    contact: PatchContact,
    layout: Layout,
    problem: PatchProblem,
    pressure: NDArray[np.float64],
    level: Any,
    held: NDArray[np.float64],
) -> tuple[float, float]:
    """Estimated errors of the film in the middle and of the smallest one, over these; NaN where unknown.

    The film is solved once more on a grid with half as many cells, from the one that is known, and as warm.
    Where the film in the middle happens to be alike on both grids, the mean film tells, or the films at
    x = 0 in the middle half of the rows; of the smallest film also how the gap opens beside it.

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
    state = newton_on_patch(half, array(begin), array(level), WARM_TIME, None, CAREFUL)
    if not state.residual < ENOUGH:
        return UNKNOWN
    coarse_gap = np.asarray(gap_on(half, state.pressure, state.level))
    coarse = _films(half, coarse_gap, dry)
    if not np.nanmin([coarse, fine]) > 0.0:  # parts of a film that is none
        return UNKNOWN
    changes = np.abs(np.log(coarse / fine))
    of_rows = np.log(np.interp(half.bodies.y, problem.bodies.y, _ridge(problem, gap)))
    of_rows -= np.log(_ridge(half, coarse_gap))
    middle = of_rows[len(of_rows) // 4 : -(len(of_rows) // 4)]
    central = np.max([*changes[:2], np.sqrt(np.mean(middle**2))])
    errors = np.expm1(REMAINS * [central, changes[2]])
    return float(errors[0]), float(max(errors[1], OPENS * _opening(gap)))


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
    problem: PatchProblem, gap: NDArray[np.float64], dry: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Film in the middle, NaN where nothing touches near it, mean and smallest one, shape (3,)."""
    y, weight = np.asarray(problem.bodies.y), np.asarray(problem.bodies.areas)[:, None] * dry
    middle = np.interp(0.0, y, _ridge(problem, gap), left=np.nan, right=np.nan)
    return np.array([middle, np.sum(gap * weight) / np.sum(weight), np.min(gap)])


def _ridge(problem: PatchProblem, gap: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gap at x = 0 in every row, shape (y,)."""
    return np.array([np.interp(0.0, problem.bodies.x, row) for row in gap])


def _opening(gap: NDArray[np.float64]) -> float:
    """Half of what a gap opens from its narrowest cell to both neighbours over it, along or across."""
    row, node = np.unravel_index(np.argmin(gap), gap.shape)
    around = np.pad(gap, 1, mode="reflect")[row : row + 3, node : node + 3]
    return float(max(np.mean(around[1, ::2]), np.mean(around[::2, 1])) / around[1, 1] - 1.0)
