"""Contacts of finite length solved: from the dry contact, from coarse to fine."""

from __future__ import annotations

from typing import Any, Final

import equinox as eqx
import numpy as np
from jaxtyping import Array
from numpy.typing import NDArray

from pitchpoint._jax import array
from pitchpoint.contact.dry_contact import pressed
from pitchpoint.contact.half_space import HalfSpace
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import Layout, Problem, ladder, laid_out, problem_on
from pitchpoint.lubrication.ehl.patch.newton import Progress, State, iterated
from pitchpoint.programs import fast_program

THICK: Final = 1.0
"""First guess of the film over the one that a regression gives."""

BED: Final = 0.3
"""Part of film and Rq by which the layer of a start yields to the unit of pressures."""

FINER_TIME: Final = 2.0
"""Time over which the first step lets oil flow on a grid that starts from a coarser one."""

_dry = fast_program(pressed)


def dry_start(problem: Problem) -> tuple[NDArray[np.float64], Any]:
    """Dry pressure of bodies with a soft layer on them, and the level at which the mean film is as guessed.

    The layer yields as film and asperities do, and spreads the pressure: that of a thick film reaches far
    beyond the contact without one, and that of rough edges is low.
    """
    dry = _dry(_bedded(problem), problem.apart, 1.0 / problem.yielding, problem.load)
    pressure = np.array(dry.pressure)
    pressure[:, [0, -1]] = 0.0
    gap = np.asarray(_gap(problem, array(pressure), array(0.0)))
    weight = np.asarray(problem.bodies.areas)[:, None] * pressure
    return pressure, THICK * float(problem.film) - float(np.sum(gap * weight) / np.sum(weight))


def dry_pressure(problem: Problem) -> NDArray[np.float64]:
    """Pressure without oil, shape (y, x)."""
    dry = _dry(problem.bodies, problem.apart, 1.0 / problem.yielding, problem.load)
    return np.asarray(dry.pressure)


def _bedded(problem: Problem) -> HalfSpace:
    """The bodies with a layer on them that yields in every cell to the pressure there alone."""
    bodies, flow = problem.bodies, problem.flow
    film = float(problem.film) + float(flow.texture.rq) / float(flow.height)
    soft = BED * film / float(problem.yielding)
    spectrum, rows = np.asarray(bodies.spectrum), np.array(bodies.rows)
    # The sum over the parts of a symmetric grid is what a cell does to itself.
    spectrum = spectrum + soft / len(spectrum) * np.eye(spectrum.shape[-1])
    rows[:, 0] += soft
    changed = tuple(map(array, (spectrum, np.asarray(bodies.own) + soft, rows)))
    return eqx.tree_at(lambda one: (one.spectrum, one.own, one.rows), bodies, changed)


def gap_of(problem: Problem, pressure: Array, level: Array) -> Array:
    """Gap of the mean planes, as a program of its own."""
    return problem.gap(pressure, level)


_gap = fast_program(gap_of)


def finer(
    coarse: Problem,
    state: State,
    dry: NDArray[np.float64],
    fine: Problem,
    fine_dry: NDArray[np.float64],
) -> tuple[Any, Any]:
    """Pressure and level on a finer grid: what the film adds to the dry pressure changes slowly."""
    added = np.asarray(state.pressure) - dry
    along = _between(np.asarray(coarse.bodies.x), np.asarray(fine.bodies.x))
    across = _between(np.asarray(coarse.bodies.y), np.asarray(fine.bodies.y))
    pressure = np.maximum(fine_dry + across @ added @ along.T, 0.0)
    pressure[:, [0, -1]] = 0.0
    areas = np.asarray(fine.bodies.areas)[:, None]
    pressure *= float(fine.load) / np.sum(pressure * areas)
    held = dry > 0.0
    before = np.asarray(_gap(coarse, state.pressure, array(state.level)))
    weight = np.asarray(coarse.bodies.areas)[:, None] * held
    mean = np.sum(before * weight) / np.sum(weight)
    found = np.asarray(_gap(fine, array(pressure), array(0.0)))
    weight = areas * (fine_dry > 0.0)
    return pressure, mean - np.sum(found * weight) / np.sum(weight)


def _between(coarse: NDArray[np.float64], fine: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix that takes values at coarse places to fine ones, linearly."""
    one = np.eye(len(coarse))
    return np.stack([np.interp(fine, coarse, row) for row in one], axis=1)


def solve(
    contact: PatchContact, nodes: int, cells: int, told: Progress | None = None
) -> tuple[Layout, Problem, State, float, int]:
    """Layout, problem and solution of a contact, the film in its middle on the grid before, and all steps."""
    layout = laid_out(contact, cells)
    before: Any = None
    coarse, steps = 0.0, 0
    for grid in ladder(nodes, cells):
        problem = problem_on(contact, layout, *grid, cells)
        dry, level = dry_start(problem)
        if before is None:
            state = iterated(problem, array(dry), array(level), told=told)
        else:
            coarse = float(_middle(*before[:2]))
            begun = (array(one) for one in finer(*before, problem, dry))
            state = iterated(problem, *begun, FINER_TIME, told=told)
        steps += state.steps
        before = problem, state, dry
    return layout, problem, state, coarse, steps


def _middle(problem: Problem, state: State) -> float:
    """Film in the middle [m]."""
    gap = np.asarray(_gap(problem, state.pressure, array(state.level)))
    x, y = np.asarray(problem.bodies.x), np.asarray(problem.bodies.y)
    rows = [np.interp(0.0, x, row) for row in gap]
    return float(np.interp(0.0, y, rows)) * float(problem.flow.height)
