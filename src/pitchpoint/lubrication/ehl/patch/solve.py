"""Contacts of finite length solved: from the dry contact, from coarse to fine."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import Any, Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array
from numpy.typing import NDArray

from pitchpoint._jax import array
from pitchpoint.contact.dry_contact import DryContact
from pitchpoint.contact.half_space import HalfSpace
from pitchpoint.core.programs import fast_program
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.heat import ContactHeat, contact_heat, next_turn, warmed_patch
from pitchpoint.lubrication.ehl.patch.layout import (
    Layout,
    PatchProblem,
    ladder,
    laid_out,
    leaks,
    problem_on,
    without_oil,
)
from pitchpoint.lubrication.ehl.patch.newton import (
    CAREFUL,
    ENOUGH,
    MOST,
    TOLERANCE,
    Manner,
    PatchIterate,
    Progress,
    newton_on_patch,
)
from pitchpoint.lubrication.ehl.patch.roughness import check_maps_on
from pitchpoint.lubrication.ehl.strips import MOST_TURNS, STEADY, cold_past

__all__ = [
    "Earlier",
    "Found",
    "Solved",
    "dry_bodies",
    "dry_start",
    "dry_under",
    "finer",
    "gap_on",
    "shown_film",
    "solve",
    "touches_dry",
]

FINER_TIME: Final = 2.0
"""Time over which the first step lets oil flow that starts from another film."""

WARM_TIME: Final = 10.0
"""The same from a film of another contact."""

# By trial, on the contacts of `newton.INEXACT`: with a tenth of it 3 % more steps.
BED: Final = 0.3
"""Part of film and Rq by which the layer of a start yields to the unit of pressures."""

SHOWN: Final = 0.8
"""Least film of a coarse grid over its step to the power 1.5, as the gap opens in a cell beside a contact."""

STRIDE: Final = 4.0
"""Film over the one that is looked for from it."""

LEAST_STRIDE: Final = 1.2
"""Stride that is not made shorter any more: a film that is not found with it is given up."""

MOST_STRIDES: Final = 12
"""Films that are looked for on the way to one."""

ROOMIER: Final = 1.05
"""Factor by which a grid has to become longer or wider to be worth another layout."""

MOST_LAYOUTS: Final = 8
"""Layouts for films that turn out thicker than they were taken for."""

MORE: Final = 1e-3
"""Part of the load by which dry bodies are loaded more and less to see how they yield."""


class Attempt(NamedTuple):
    """One way to begin.

    Attributes:
        bed: part of film and Rq by which the layer yields to the unit of pressures.
        time: of the first step.
        manner: in which steps are taken.
    """

    bed: float
    time: float
    manner: Manner


ATTEMPTS: Final = (
    Attempt(BED, 1.0, Manner(False, 1.0)),
    Attempt(BED, 1.0, CAREFUL),
    Attempt(BED, 1.0, Manner(False, 0.3)),
    Attempt(0.5, 2.0, Manner(False, 0.3)),
)

NEARLY_WARM: Final = 1e-2
"""Change of the temperature in a turn, over the largest rise, at which turns end on all but the last grid."""

LEAPS: Final = 0.1
"""The same above which pressures are looked for with care after a turn."""

EXACT: Final = 1e-6
"""Residual of the pressure over the change of the temperature, at which a turn ends: the heat of a flow under
the low pressures ahead of a contact is that of their slopes."""

FINEST: Final = 1e-12
"""Least such residual."""

BOLD: Final = Manner(False, 0.3)
"""Manner in which a film is looked for from another where careful steps do not find it."""

MOST_ON_GRID: Final = 240
"""Steps on one grid after which it is given up."""


class Found(NamedTuple):
    """A solution on one grid.

    Attributes:
        problem: the contact there, at the speed of the solution.
        dry: pressure of the start, shape (y, x).
        state: the solution.
    """

    problem: PatchProblem
    dry: NDArray[np.float64]
    state: PatchIterate

    def faster(self, problem: PatchProblem) -> bool:
        """Whether oil flows faster in it than in the problem, as where a grid shows no film that is thin."""
        return float(self.problem.film) != float(problem.film)


def dry_start(problem: PatchProblem, bed: float = BED) -> tuple[NDArray[np.float64], Any]:
    """Dry pressure of bodies with a soft layer on them, and the level at which the mean film is as guessed.

    The layer yields as film and asperities do, and spreads the pressure: that of a thick film reaches far
    beyond the contact without one, and that of rough edges is low.
    """
    dry = without_oil(_bedded(problem, bed), problem.apart, 1.0 / problem.yielding, problem.load)
    pressure = np.array(dry.pressure)
    pressure[:, [0, -1]] = 0.0
    return pressure, float(problem.film) - _mean_gap(problem, pressure, array(pressure), 0.0)


def touches_dry(problem: PatchProblem, state: PatchIterate) -> bool:
    """Whether smooth surfaces carry load without oil, as where a grid is too coarse for their film."""
    if float(problem.flow.texture.rq) > 0.0:
        return False
    gap = gap_on(problem, array(state.pressure), array(state.level))
    return bool(np.any(np.asarray(problem.flow.asperity_pressure(gap)) > 0.0))


def dry_under(problem: PatchProblem, part: float = 1.0) -> DryContact:
    """The contact without oil under a part of its load."""
    load = problem.load * part
    return without_oil(problem.bodies, problem.apart, 1.0 / problem.yielding, load)


def dry_bodies(problem: PatchProblem) -> tuple[NDArray[np.float64], float, float]:
    """Pressure without oil, shape (y, x), approach of the bodies, and its change with ln of the load."""
    dry, lighter, heavier = (dry_under(problem, part) for part in (1.0, 1.0 - MORE, 1.0 + MORE))
    slope = float(heavier.approach - lighter.approach) / (2.0 * MORE)
    return np.asarray(dry.pressure), float(dry.approach), slope


def _bedded(problem: PatchProblem, bed: float) -> HalfSpace:
    """The bodies with a layer on them that yields in every cell to the pressure there alone."""
    bodies, flow = problem.bodies, problem.flow
    film = float(problem.film) + float(flow.texture.rq) / float(flow.height)
    soft = bed * film / float(problem.yielding)
    spectrum, rows = np.asarray(bodies.spectrum), np.array(bodies.rows)
    # The sum over the parts of a symmetric grid is what a cell does to itself.
    spectrum = spectrum + soft / len(spectrum) * np.eye(spectrum.shape[-1])
    rows[:, 0] += soft
    changed = tuple(map(array, (spectrum, np.asarray(bodies.own) + soft, rows)))
    bedded: HalfSpace = eqx.tree_at(
        lambda tree: (tree.spectrum, tree.own, tree.rows), bodies, changed
    )
    return bedded


def _mean_gap(problem: PatchProblem, dry: NDArray[np.float64], pressure: Any, level: Any) -> float:
    """Mean gap where a dry contact carries, as much as it carries."""
    weight = np.asarray(problem.bodies.areas)[:, None] * dry
    gap = np.asarray(gap_on(problem, pressure, array(level)))
    return float(np.sum(gap * weight) / np.sum(weight))


def _gap_of(problem: PatchProblem, pressure: Array, level: Array) -> Array:
    return problem.gap(pressure, level)


gap_on = fast_program(_gap_of)
"""Gap of the mean planes in every cell of a solution, in units of its own, shape (y, x)."""


def finer(coarse: Found, fine: PatchProblem, fine_dry: NDArray[np.float64]) -> tuple[Any, Any]:
    """Pressure and level on a finer grid: what the film adds to the dry pressure changes slowly."""
    before = coarse.problem
    along = _between(np.asarray(before.bodies.x), np.asarray(fine.bodies.x))
    across = _between(np.asarray(before.bodies.y), np.asarray(fine.bodies.y))
    added = across @ (np.asarray(coarse.state.pressure) - coarse.dry) @ along.T
    mean = _mean_gap(before, coarse.dry, coarse.state.pressure, coarse.state.level)
    return _together(fine, fine_dry, added, mean * float(fine.film / before.film))


def _together(
    problem: PatchProblem, dry: NDArray[np.float64], added: NDArray[np.float64], film: float
) -> tuple[Any, Any]:
    """Pressure of the load from a dry one and what a film adds, and the level for a mean film."""
    pressure = np.maximum(dry + added, 0.0)
    pressure[:, [0, -1]] = 0.0
    pressure *= float(problem.load) / np.sum(pressure * np.asarray(problem.bodies.areas)[:, None])
    return pressure, film - _mean_gap(problem, dry, array(pressure), 0.0)


class Earlier(NamedTuple):
    """A solution of a contact that is like the one in question, on any grid.

    Attributes:
        layout: where its grid lies.
        added: what the film adds to the dry pressure, in the units of that, shape (y, x).
        film: mean one over the guess of that.
        rise: of the temperature of the film, shape (y, x) [K]; None of an isothermal one.
    """

    layout: Layout
    added: NDArray[np.float64]
    film: float
    rise: NDArray[np.float64] | None


def warm_start(
    earlier: Earlier, layout: Layout, problem: PatchProblem, dry: NDArray[np.float64]
) -> tuple[Any, Any]:
    """Pressure and level of a start from the dry pressure and a solution of a contact that is alike."""
    added = _as_laid(earlier, layout, problem, earlier.added)
    return _together(problem, dry, added, earlier.film * float(problem.film))


def as_warm(earlier: Earlier, layout: Layout, problem: PatchProblem) -> PatchProblem:
    """The contact as warm as one that is alike, where both have temperatures."""
    if earlier.rise is None or not problem.flow.temperature_rise.ndim:
        return problem
    return warmed_patch(problem, array(_as_laid(earlier, layout, problem, earlier.rise)))


def _as_laid(
    earlier: Earlier, layout: Layout, problem: PatchProblem, field: NDArray[np.float64]
) -> NDArray[np.float64]:
    """A field of an earlier solution on the grid of a contact."""
    rows, nodes = np.shape(problem.apart)
    (x, y), (fine_x, fine_y) = (
        grid_layout.places(*shape[::-1])
        for grid_layout, shape in ((earlier.layout, field.shape), (layout, (rows, nodes)))
    )
    return _between(y, fine_y) @ field @ _between(x, fine_x).T


def as_warm_as(coarse: PatchProblem, fine: PatchProblem) -> PatchProblem:
    """The contact on a finer grid, with temperatures of a coarse one."""
    rise = np.asarray(coarse.flow.temperature_rise)
    if not rise.ndim:
        return fine
    along = _between(np.asarray(coarse.bodies.x), np.asarray(fine.bodies.x))
    across = _between(np.asarray(coarse.bodies.y), np.asarray(fine.bodies.y))
    return warmed_patch(fine, array(across @ rise @ along.T))


def _between(coarse: NDArray[np.float64], fine: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix that takes values at coarse places to fine ones, linearly."""
    identity = np.eye(len(coarse))
    return np.stack([np.interp(fine, coarse, row) for row in identity], axis=1)


def shown_film(problem: PatchProblem) -> float:
    """Film, in own units, below which the grid shows none."""
    spacing = float(problem.bodies.x[1] - problem.bodies.x[0])
    return float(SHOWN * spacing**1.5)


_next_turn = fast_program(next_turn)


class Solved(NamedTuple):
    """Where a solve ended.

    Attributes:
        layout: where the grid lies.
        problem: the contact on the last grid of its ladder, as warm as it is.
        state: the solution.
        turns: between pressure and temperature, on all grids.
    """

    layout: Layout
    problem: PatchProblem
    state: PatchIterate
    turns: int


@dataclass
class _Solver:
    """Newton's iterations on the grids of a ladder.

    Attributes:
        told: called with the number of steps and the residual after each of them.
        steps: of all iterations so far.
        left: steps that are left on a grid.
        last: where the last one ended.
        turns: between pressure and temperature so far.
    """

    told: Progress | None
    steps: int = 0
    left: int = MOST_ON_GRID
    last: PatchIterate | None = None
    turns: int = 0

    def on_grid(self, problem: PatchProblem, before: Found | None, *, last: bool) -> Found | None:
        """Solution on one grid, None where none is found.

        From one on a coarser grid, else from dry contacts, else from the coarser one in strides.

        Grids show no film that is much thinner than the gap that opens within a cell: on all but the last one
        oil flows faster.
        """
        self.left = MOST_ON_GRID
        shown = max(1.0, shown_film(problem) / float(problem.film))
        times = 1.0 if last else shown
        solution = None if before is None else self.onward(problem.thicker(times), before)
        if solution is None:
            solution = self.from_dry(problem.thicker(shown))
            if solution is not None and times < shown:
                solution = self.thinner(problem, times, solution)
        if solution is None and before is not None:
            solution = self.thinner(problem, times, before)
        return solution

    def onward(self, problem: PatchProblem, solution: Found) -> Found | None:
        """Solution from that on a coarser grid."""
        dry, _ = dry_start(problem)
        state = self.iterated(problem, finer(solution, problem, dry), FINER_TIME, CAREFUL)
        return Found(problem, dry, state) if state.residual < ENOUGH else None

    def thinner(self, problem: PatchProblem, times: float, solution: Found) -> Found | None:
        """Solution with a film so many times as thick as it is, by films that become thinner and thinner."""
        now, stride = float(solution.problem.film / problem.film), STRIDE
        for _ in range(MOST_STRIDES):
            factor = max(times, now / stride)
            trial = problem.thicker(factor)
            dry, _ = dry_start(trial)
            shortest = now / factor < LEAST_STRIDE
            state = self.near(trial, finer(solution, trial, dry), boldly=shortest)
            if state.residual < ENOUGH:
                solution, now = Found(trial, dry, state), factor
            elif shortest:
                return None
            else:
                stride = float(np.sqrt(now / factor))
            if now == times:
                return solution
        return None

    def from_dry(self, problem: PatchProblem) -> Found | None:
        """Solution from a dry contact, by one attempt or another."""
        for attempt in ATTEMPTS:
            dry, level = dry_start(problem, attempt.bed)
            state = self.iterated(problem, (dry, level), attempt.time, attempt.manner)
            if state.residual < ENOUGH:
                return Found(problem, dry, state)
        return None

    def warm(self, heats: ContactHeat, solution: Found, steady: float = STEADY) -> Found | None:
        """A solution as warm as its heat makes it, by turns between pressure and temperature."""
        problem, state = solution.problem, solution.state
        past = cold_past(problem.flow.temperature_rise.size)
        change = array(np.inf)
        for _ in range(MOST_TURNS):
            turn = _next_turn(heats, problem, state.pressure, state.level, past, change)
            past, change, self.turns = turn.past, turn.change, self.turns + 1
            if float(change) < steady:
                return solution._replace(problem=warmed_patch(problem, turn.rise), state=state)
            problem = warmed_patch(problem, turn.begin)
            enough = max(FINEST, EXACT * min(float(change), 1.0))
            state = self.after_turn(problem, state, float(change), enough)
            if not state.residual < ENOUGH:
                return None
        return None

    def settled(
        self, heats: ContactHeat | None, solution: Found | None, steady: float = STEADY
    ) -> Found | None:
        """A solution as warm as it becomes, itself where it is isothermal; None where none is found."""
        if heats is None or solution is None:
            return solution
        return self.warm(heats, solution, steady)

    def onto(
        self, problem: PatchProblem, heats: ContactHeat | None, before: Found | None, *, last: bool
    ) -> Found | None:
        """Solution on a finer grid, about as warm as that before becomes."""
        warm = self.settled(heats, before, NEARLY_WARM)
        if warm is None or heats is None:
            return self.on_grid(problem, before, last=last)
        solution = self.on_grid(as_warm_as(warm.problem, problem), warm, last=last)
        return self.on_grid(problem, before, last=last) if solution is None else solution

    def with_tips(self, layout: Layout, solution: Found | None) -> tuple[Layout, Found | None]:
        """Layout and solution, with limited conductances across where tips would be emptied."""
        held = None if solution is None else self.held(solution)
        return (layout, solution) if held is None else (layout._replace(steep=1.0), held)

    def held(self, solution: Found) -> Found | None:
        """Solution whose tips hold their film, where smooth surfaces touch in that which was found."""
        problem, state = solution.problem, solution.state
        if not touches_dry(problem, state):
            return None
        limited: PatchProblem = eqx.tree_at(lambda tree: tree.steep, problem, array(1.0))
        self.left, start = MOST_ON_GRID, (state.pressure, state.level)
        after = self.near(limited, start, boldly=True)
        return solution._replace(problem=limited, state=after) if after.residual < ENOUGH else None

    def from_earlier(self, problem: PatchProblem, earlier: Earlier, layout: Layout) -> Found | None:
        """Solution from one of a contact that is alike."""
        dry = np.asarray(dry_under(problem).pressure)
        start = warm_start(earlier, layout, problem, dry)
        state = self.iterated(problem, start, WARM_TIME, CAREFUL)
        return Found(problem, dry, state) if state.residual < ENOUGH else None

    def ended(
        self, layout: Layout, solution: Found | None, last_problem: PatchProblem | None = None
    ) -> Solved:
        """Where the solve ended, without a solution as well."""
        assert self.last is not None
        if solution is not None:
            state = solution.state._replace(steps=self.steps)
            return Solved(layout, solution.problem, state, self.turns)
        assert last_problem is not None
        return Solved(layout, last_problem, self.last._replace(residual=np.inf), self.turns)

    def after_turn(
        self, problem: PatchProblem, state: PatchIterate, change: float, enough: float
    ) -> PatchIterate:
        """Pressure of a film that became warmer or colder, from the one before."""
        self.left, start = MOST_ON_GRID, (state.pressure, state.level)
        time = WARM_TIME if change > LEAPS else np.inf
        after = self.iterated(problem, start, time, CAREFUL, enough)
        if not after.residual < ENOUGH:
            after = self.iterated(problem, start, FINER_TIME, BOLD, enough)
        return after

    def near(self, problem: PatchProblem, start: tuple[Any, Any], *, boldly: bool) -> PatchIterate:
        """Where iterations from another film end, in one manner, and the other where that is asked for."""
        state = self.iterated(problem, start, FINER_TIME, CAREFUL)
        if boldly and not state.residual < ENOUGH:
            state = self.iterated(problem, start, FINER_TIME, BOLD)
        return state

    def iterated(
        self,
        problem: PatchProblem,
        start: tuple[Any, Any],
        time: float,
        manner: Manner,
        enough: float = TOLERANCE,
    ) -> PatchIterate:
        pressure, level = map(array, start)
        most = min(MOST, self.left)
        state = newton_on_patch(problem, pressure, level, time, self.told, manner, most, enough)
        self.steps += state.steps
        self.left -= state.steps
        self.last = state._replace(steps=self.steps)
        return state


def _film_of(problem: PatchProblem, dry: NDArray[np.float64], state: PatchIterate) -> float:
    """Mean film of a solution [m]."""
    gap = _mean_gap(problem, dry, state.pressure, state.level)
    return gap * float(problem.flow.height)


def _roomier(contact: PatchContact, layout: Layout, cells: int, film: float) -> Layout | None:
    """A grid for a film that is thicker than it was taken for; None where that is no larger."""
    if not (film > layout.film and leaks(contact, layout)):
        return None
    roomier = laid_out(contact, cells, film)
    sizes = (
        (grid_layout.length, grid_layout.last - grid_layout.first)
        for grid_layout in (roomier, layout)
    )
    larger = any(new > ROOMIER * old for new, old in zip(*sizes, strict=True))
    return roomier if larger else None


def solve(
    contact: PatchContact,
    nodes: int = 129,
    cells: int = 128,
    told: Progress | None = None,
    layout: Layout | None = None,
    earlier: Earlier | None = None,
    *,
    bounded: bool = False,
) -> Solved:
    """Layout, unless one is given, problem and solution of a contact on the last grid of its ladder.

    Where the film on the coarsest grid is so much thicker than it was taken for that it needs more room, it
    gets that. Bounded, faces where a film begins or ends within a cell are, unless a layout is given.
    """
    grids, fixed = ladder(nodes, cells), layout is not None
    layout = laid_out(contact, cells)._replace(bounded=bounded) if layout is None else layout
    check_maps_on(contact, layout, cells)
    solver, heats = _Solver(told), contact_heat(contact)
    if earlier is not None:
        problem = problem_on(contact, layout, nodes, cells, cells)
        solution = solver.from_earlier(as_warm(earlier, layout, problem), earlier, layout)
        if solution is not None and _roomier(contact, layout, cells, _film_of(*solution)) is None:
            tipped, solution = solver.with_tips(layout, solution)
            solution = solver.settled(heats, solution)
            if solution is not None:
                return solver.ended(tipped, solution)
    for layouts in count():
        problem = problem_on(contact, layout, *grids[0], cells)
        solution = solver.on_grid(problem, None, last=len(grids) == 1)
        if fixed or layouts == MOST_LAYOUTS or solution is None or solution.faster(problem):
            break
        roomier = _roomier(contact, layout, cells, _film_of(*solution))
        if roomier is None:
            break
        layout = roomier._replace(bounded=bounded)
    for grid in grids[1:]:
        problem = problem_on(contact, layout, *grid, cells)
        solution = solver.onto(problem, heats, solution, last=grid == grids[-1])
    if not fixed:
        layout, solution = solver.with_tips(layout, solution)
    warm = solver.settled(heats, solution)
    if heats is not None and warm is None and len(grids) > 1:
        # From a film that is as warm as its inlet, should temperatures of coarse grids have led astray.
        warm = solver.settled(heats, solver.on_grid(problem, None, last=True))
    return solver.ended(layout, warm, problem)
