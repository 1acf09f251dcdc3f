"""Films of finite contacts over time: load, speeds, form and oil change, rough surfaces pass."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array
from numpy.typing import ArrayLike, NDArray

from pitchpoint._jax import array, jax
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.fields import ElasticResponse, PatchFilm
from pitchpoint.lubrication.ehl.patch.layout import Layout, PatchProblem
from pitchpoint.lubrication.ehl.patch.newton import ENOUGH, PatchIterate, Progress, newton_on_patch
from pitchpoint.lubrication.ehl.patch.patch_films import (
    CELLS,
    NODES,
    PatchEnded,
    Turned,
    code_before_solve,
    film_as_given,
    film_with_doubts,
)
from pitchpoint.lubrication.ehl.patch.plan import Plan, all_lie, check_times
from pitchpoint.lubrication.ehl.patch.solve import dry_under, solve

__all__ = ["STEPS", "MarchState", "PatchMoment", "march_patches", "steady_beside"]

STEPS: Final = ("given", "by_error")
"""Ways to choose steps of time: from each given time to the next, or by an estimate of the error."""

TOLERANCE: Final = 1e-3
"""Usual error of a step, of the mass under the contact over the mean."""

REMEMBERED: Final = 3
"""Films before a step from which its error is estimated."""

FIRST: Final = 0.01
"""First step by error, over the first time between two given ones."""

GROWING: Final = 2.0
"""Largest factor between steps; the scheme is stable up to 2.4."""

SHRINKING: Final = 0.3
"""Smallest one."""

HALF: Final = 0.5
"""Part of a step that found no film which is tried next."""

SAFETY: Final = 0.9
"""Part of the step by which the error would be just met."""

MOST_CUTS: Final = 8
"""Times that a step is cut before a march is given up."""

FEW: Final = 16
"""Steps of Newton's method in a first attempt."""

TIED: Final = 2.0
"""Time over which the first step of a second attempt lets oil flow, in units of the contact."""

FEWEST_NODES: Final = 8
"""Nodes over the half-width of a contact that a grid has to show."""

Field = NDArray[np.float64]


class MarchState(NamedTuple):
    """Where a march stands, in units of its layout.

    Attributes:
        layout: where the grid lies, and its units.
        lies: how it lies.
        pressure: of the last film, shape (y, x).
        level: of the surfaces.
        times: of the last films, the latest first [s].
        masses: under the cells of these films, each of shape (y, x).
        step: of time that comes next by error [s]; none after the first film.
    """

    layout: Layout
    lies: Turned
    pressure: Field
    level: float
    times: tuple[float, ...]
    masses: tuple[Field, ...]
    step: float | None


@dataclass(frozen=True)
class PatchMoment:
    """Film of a contact at one time of a march.

    Attributes:
        time: [s].
        film: fields and what follows from them, NumPy arrays; NaN where the film was not found, and stiffness
            and damping, which are those of steady films. Pumping power and rolling resistance do not balance
            while the film is squeezed.
        ended: how the steps since the moment before ended: the defects of the last one, and steps of Newton's
            method in all of them.
        time_steps: of time since the moment before.
        course: from where the march goes on.
        warnings: what to be wary of, in sentences.
    """

    time: float
    film: PatchFilm
    ended: PatchEnded
    time_steps: int
    course: MarchState
    warnings: tuple[Doubt, ...]

    @property
    def solved(self) -> bool:
        """Whether the film was found."""
        return self.ended.code == Code.SOLVED


def march_patches(
    contacts: Sequence[PatchContact],
    times: ArrayLike,
    *,
    steps: str = "given",
    tolerance: float = TOLERANCE,
    nodes: int = NODES,
    cells: int = CELLS,
    after: PatchMoment | MarchState | None = None,
    progress: Progress | None = None,
) -> Iterator[PatchMoment]:
    """Films of a contact whose load, speeds, form and oil change over time, one after the other.

    The balance of every cell holds d(rho h)/dt; load and pressure balance at every time, without the inertia
    of the bodies. Second order in time: backward differences over two steps of any lengths, the first step of
    first order. The film at the first time is the steady one of the first contact, with its speed of approach
    and with height maps where they lie; those of a member move with its surface from then on. Between times
    every value of the contacts is linear. One grid holds all contacts. Cells without pressure are full of oil
    again as soon as pressure rises: what was lost at the outlet is not missing there.

    Args:
        contacts: one at each time, all of one kind, with arrays of the same shapes.
        times: rising, shape (time,) [s].
        steps: "given", one step from each time to the next, halved where it finds no film, or "by_error", as
            many as the tolerance asks for.
        tolerance: of a step by error: mean of the mass under a cell, weighed by pressure, over its mean.
        nodes: along x, one more than a power of two.
        cells: across, a power of two.
        after: moment of the same contacts and times after which to go on, on its grid, or its course alone.
        progress: told the number of Newton's steps and the residual, after each of them.

    Yields:
        The film at each time. The march ends with a film that was not found.

    Raises:
        InputError: what `solve_patch` refuses, contacts of several kinds, times that do not rise, an approach
            of later contacts, which the march finds, entrainment that turns round, a tolerance that is not
            positive, a moment after which nothing comes.

    From the parabola through three times, whose slope at the last one is d(rho h)/dt.
    """
    if steps not in STEPS:
        raise InputError(f'there are no steps "{steps}"', key="steps", allowed=STEPS)
    if not 0.0 < tolerance < np.inf:  # written so that NaN fails
        raise InputError(f"a tolerance of {tolerance:.4g}: it must be positive", key="tolerance")
    if isinstance(after, PatchMoment) and not after.solved:
        raise InputError(
            "the film of this moment was not found, and nothing goes on after it; take one before",
            key="after",
        )
    at = np.asarray(times, float)
    check_times(contacts, at)
    course = after.course if isinstance(after, PatchMoment) else after
    if course is None:
        plan = Plan(contacts, at, all_lie(contacts), nodes, cells)
    else:
        plan = _plan_on(course, contacts, at)
    plan.check()
    stepper = _Stepper(plan, progress, tolerance if steps == "by_error" else None)
    return _march(plan, stepper, course)


def steady_beside(
    contact: PatchContact, course: MarchState, *, progress: Progress | None = None
) -> PatchMoment:
    """The steady film of a contact on the grid of a march, to set beside the one that is squeezed.

    Films on one grid differ by squeeze alone, and not by what cells make of them.

    Args:
        contact: one of those of the march, with height maps that lie where they are.
        course: where the march stands, best at the time of this contact: the search begins there.
        progress: told the number of Newton's steps and the residual, after each of them.

    Returns:
        The film, at the time zero of a march of its own.
    """
    plan = _plan_on(course, [contact], np.zeros(1))
    laid, problem = plan.contact(0.0), plan.problem(0.0)
    guess = array(course.pressure), array(course.level)
    state = newton_on_patch(problem, *guess, TIED, progress, most=FEW)
    if not state.residual < ENOUGH:
        _, problem, state, _ = solve(laid, *plan.grid, progress, plan.layout_of(0))
    return _moment(plan, 0, problem, course, state, (0, state.steps))


def _plan_on(
    course: MarchState, contacts: Sequence[PatchContact], times: NDArray[np.float64]
) -> Plan:
    """Contacts at times on the grid of a course."""
    rows, places = course.pressure.shape
    return Plan(contacts, times, course.lies, places, rows, course.layout)


# ---- one step after the other


class _Step(NamedTuple):
    """A film that a step of time found."""

    problem: PatchProblem
    state: PatchIterate
    mass: Field


class _Stepper:
    """Steps of time from film to film.

    Attributes:
        plan: contacts over time.
        told: called with the number of steps and the residual after each of them.
        tolerance: of a step by error; None for given steps.
    """

    def __init__(self, plan: Plan, told: Progress | None, tolerance: float | None) -> None:
        self.plan, self.told, self.tolerance = plan, told, tolerance

    def begun(self) -> tuple[MarchState, PatchProblem, PatchIterate]:
        """The steady film of the first contact."""
        plan = self.plan
        contact = plan.contact(plan.times[0])
        contact = replace(contact, approach=plan.contacts[0].approach)
        _, problem, state, _ = solve(contact, *plan.grid, self.told, plan.layout_of(0))
        state = state._replace(pressure=np.asarray(state.pressure), level=float(state.level))
        mass = np.asarray(_mass(problem, array(state.pressure), array(state.level)))
        stands = state.pressure, state.level, (float(plan.times[0]),), (mass,), None
        return MarchState(plan.layout, plan.lies, *stands), problem, state

    def to(self, course: MarchState, time: float) -> tuple[MarchState, _Step, int, int]:
        """Course at a time, the last step to it, and how many steps of time and of Newton's method."""
        steps, newton = 0, 0
        while True:
            step = self._length(course, time)
            course, last_step = self._accepted(course, time, step)
            steps, newton = steps + 1, newton + last_step.state.steps
            if course.times[0] == time or not last_step.state.residual < ENOUGH:
                return course, last_step, steps, newton

    def _length(self, course: MarchState, time: float) -> float:
        """Length of the next step: parts of the way to the time that are all alike [s]."""
        left = time - course.times[0]
        if self.tolerance is None:
            return left
        step = FIRST * left if course.step is None else course.step
        return left / float(np.ceil(left / step * (1.0 - 1e-9)))

    def _accepted(self, course: MarchState, time: float, step: float) -> tuple[MarchState, _Step]:
        """A step that finds a film, within the tolerance if there is one, cut as often as that takes."""
        for _ in range(MOST_CUTS):
            near = abs(course.times[0] + step - time) < 1e-6 * step
            at = time if near else course.times[0] + step
            trial = self._found(course, at)
            factor = self._factor(course, trial, at)
            if factor >= SAFETY:
                return _onward(course, trial, at)._replace(step=factor * step), trial
            step *= factor
        lost = trial._replace(state=trial.state._replace(residual=np.inf))
        return _onward(course, trial, at), lost

    def _factor(self, course: MarchState, taken: _Step, time: float) -> float:
        """By how much longer the next step may be, or has to be shorter where it is below `SAFETY`."""
        if not taken.state.residual < ENOUGH:
            return HALF
        if self.tolerance is None:
            return 1.0
        off = max(_error(course, taken, time), 1e-12)
        return float(np.clip(SAFETY * (self.tolerance / off) ** (1.0 / 3.0), SHRINKING, GROWING))

    def _found(self, course: MarchState, time: float) -> _Step:
        """The film at a time, from the one before."""
        problem = _since(self.plan.problem(time), course, time)
        guess = array(course.pressure), array(course.level)
        state = newton_on_patch(problem, *guess, np.inf, self.told, most=FEW)
        if not state.residual < ENOUGH:
            state = newton_on_patch(problem, *guess, TIED, self.told)
        mass = np.asarray(_mass(problem, state.pressure, state.level))
        return _Step(problem, state, mass)


def _mass_of(problem: PatchProblem, pressure: Array, level: Array) -> Array:
    """Mass under every cell, shape (y, x)."""
    gap = problem.gap(pressure, level)
    return problem.flow.mass_and_ease(pressure - problem.flow.asperity_pressure(gap), gap)[0]


_mass = program(_mass_of)


def _since(problem: PatchProblem, course: MarchState, time: float) -> PatchProblem:
    """The problem of a film that follows those of a course.

    Backward differences over two steps: d m/dt = (m - before)/(the time of that), exact for masses that are
    quadratic in time. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, III.5.
    """
    step, ratio = _ratio(course, time)
    weight = (1.0 + 2.0 * ratio) / (1.0 + ratio)
    mass = (1.0 + ratio) * course.masses[0]
    if ratio:
        mass = mass - ratio**2 / (1.0 + ratio) * course.masses[1]
    pace = weight * course.layout.length / (course.layout.speed * step)
    following: PatchProblem = eqx.tree_at(
        lambda tree: (tree.pace, tree.before), problem, (array(pace), array(mass / weight))
    )
    return following


def _ratio(course: MarchState, time: float) -> tuple[float, float]:
    """A step of time [s], and its length over that of the one before; none after the first film."""
    step = time - course.times[0]
    if len(course.times) < 2:
        return step, 0.0
    return step, step / (course.times[0] - course.times[1])


def _onward(course: MarchState, taken: _Step, time: float) -> MarchState:
    state = taken.state
    return course._replace(
        pressure=np.asarray(state.pressure),
        level=float(state.level),
        times=(time, *course.times)[:REMEMBERED],
        masses=(taken.mass, *course.masses)[:REMEMBERED],
    )


def _error(course: MarchState, taken: _Step, time: float) -> float:
    """Error of a step: mean over the contact, weighed by pressure, over the mean mass.

    The parabola through the three films before differs from the film by its own error and that of the step,
    whose ratio is known. Before the first film nothing changed.
    """
    step, ratio = _ratio(course, time)
    times, masses = list(course.times), list(course.masses)
    while len(times) < REMEMBERED:
        times.append(times[-1] - step)
        masses.append(masses[-1])
    ahead = _parabola(times, masses, time)
    of_scheme = step * (1.0 + ratio) / (1.0 + 2.0 * ratio)
    part = of_scheme / (of_scheme + time - times[2])
    pressure = np.asarray(taken.state.pressure)
    weight = np.maximum(pressure, 0.0) * np.asarray(taken.problem.bodies.areas)[:, None]
    off = part * np.abs(taken.mass - ahead)
    return float(np.sum(weight * off) / np.sum(weight * taken.mass))


def _parabola(times: Sequence[float], masses: Sequence[Field], time: float) -> Field:
    """Masses at a time by the parabola through three films."""
    parabola = np.zeros_like(masses[0])
    for k, mass in enumerate(masses):
        others = [instant for number, instant in enumerate(times) if number != k]
        parabola = parabola + mass * np.prod(
            [(time - instant) / (times[k] - instant) for instant in others]
        )
    return parabola


def _march(plan: Plan, stepper: _Stepper, after: MarchState | None) -> Iterator[PatchMoment]:
    course, solved = after, True
    if course is None:
        course, problem, state = stepper.begun()
        moment = _moment(plan, 0, problem, course, state, (0, state.steps))
        solved = moment.solved
        yield moment
    for number, time in enumerate(plan.times):
        if time <= course.times[0] or not solved:
            continue
        course, step, steps, newton = stepper.to(course, float(time))
        moment = _moment(plan, number, step.problem, course, step.state, (steps, newton))
        solved = moment.solved
        yield moment


def _moment(
    plan: Plan,
    number: int,
    problem: PatchProblem,
    course: MarchState,
    state: PatchIterate,
    steps: tuple[int, int],
) -> PatchMoment:
    """Film at one of the times."""
    contact, layout = plan.contact(plan.times[number]), plan.layout_of(number)
    code = code_before_solve(plan.contacts[0]) if number == 0 else Code.SOLVED
    ended = PatchEnded(code, float(state.residual), abs(float(state.load)), steps[1])
    dry, unknown = dry_under(problem), array(np.nan)
    solution = np.asarray(state.pressure), float(state.level), np.asarray(dry.pressure)
    response = ElasticResponse(array(dry.approach), unknown, unknown, unknown)
    judged = film_with_doubts(contact, layout, problem, *solution, response, ended)
    film: Any = jax.tree.map(np.asarray, film_as_given(judged.film, plan.lies))
    warnings = (*judged.warnings, *_few(layout, plan.grid[0]))
    time = float(plan.times[number])
    return PatchMoment(time, film, judged.ended, steps[0], course, warnings)


def _few(layout: Layout, nodes: int) -> Iterator[Doubt]:
    """A sentence on contacts that are small on the grid of the largest one."""
    shown = layout.half_width / (layout.outlet - layout.inlet) * (nodes - 1)
    if shown < FEWEST_NODES:
        yield Doubt(
            f"the grid of the largest contact of the march has {shown:.1f} nodes over the half-width of this "
            "one: take more nodes",
            "few nodes",
            1.0 / shown,
            brief=f"{shown:.1f} nodes over a half-width: take more nodes",
        )
