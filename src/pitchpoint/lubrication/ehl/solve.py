"""Line contacts solved, many at once: in portions, with what became of each, and what to be wary of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final, TypeVar

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int
from numpy.typing import NDArray

from pitchpoint._jax import jax, jnp
from pitchpoint.core.doubts import Doubt
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.doubts import SolvedLines, check_line_contact, line_film_warnings
from pitchpoint.lubrication.ehl.ehl_registry import coarser_count
from pitchpoint.lubrication.ehl.fields import LineFilm, line_film
from pitchpoint.lubrication.ehl.heat import (
    alternating_solution,
    line_heat_defect,
    polished_warm_line,
    warmed_line,
)
from pitchpoint.lubrication.ehl.line import (
    LEAST,
    LineContact,
    LineProblem,
    problem_of,
)
from pitchpoint.lubrication.ehl.line_grid import ENDS, Ends, LineGrid, grid, prolongation
from pitchpoint.lubrication.ehl.line_response import (
    load_and_approach_change,
    pushed_rest,
    solution_response,
    stiffness_and_damping,
)
from pitchpoint.lubrication.ehl.newton import (
    ENOUGH,
    LineIterate,
    from_coarse,
    newton_on_line,
    polished_line,
    residual,
    solved_films,
)
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.profiles import check_profiles
from pitchpoint.lubrication.ehl.strips import WARM_ENOUGH

__all__ = [
    "LEAST_FALL",
    "NODES",
    "OF_HALF",
    "OPENS",
    "THINNEST",
    "Films",
    "line_films",
    "solve_lines",
    "usual_nodes",
]

Tree = TypeVar("Tree")

NODES: Final = 129
"""Nodes on which films of Moes' load parameter M up to 100 come within 1 % of those on twice as many, and
smallest ones within 3 %."""

HEAVY: Final = 100.0
"""Load parameter M beyond which twice as many are usual."""

OF_HALF: Final = np.array([0.45, 0.6])
"""Estimate of the error of the film in the middle and of the smallest one, over what the last doubling of the
nodes changed. `tests/long/errors_of_grids.py` judges it by contacts that it was not chosen in view of."""

OPENS: Final = 0.27
"""Estimate of the error of a smallest film, at least, over half of what the gap opens from its node to both
neighbours: the constriction at which films are smallest may lie between nodes on all grids alike. Chosen in
view of seeds 501 to 504, 7301, 31 and 32 on 65 and 129 nodes."""

LEAST_FALL: Final = 1.0 / 8.0
"""Part of what a doubling of the nodes changed that the next one is taken to change at least: a film may
happen to be alike on two grids, and no error falls faster than with the third power of a cell's width."""

THINNEST: Final = 0.1
"""Part of Rq that errors are taken over where mean planes come nearer: there a film may be none at all."""

PORTION: Final = 64
"""Contacts of a program at once; between portions progress is told, and an interrupt is heard."""

FEW: Final = 128
"""Contacts up to which a program that compiles quickly is done sooner than one that runs twice as fast."""


class Ended(eqx.Module):
    """How a solve ended, of contacts `*b`.

    Attributes:
        code: of `Code`.
        reynolds: largest defect of the balance of a cell, in units of Hertz's pressure.
        load: defect of the load over it.
        gap: defect of the gap over the smallest one: elastic deformation against the gap of the result.
        iterations: of Newton's method, on all grids.
        grid: estimate of the error of the film in the middle that the grid makes, over that film, or over a
            tenth of Rq where mean planes come nearer, from films on grids with a half and a quarter as many
            nodes; NaN where there was none on half as many.
        grid_minimum: the same of the smallest film, from how the gap opens beside it too.
        temperature: defect of the temperature of the film over its largest rise; None of isothermal films.
        turns: between pressure and temperature, on all grids; None of isothermal films.
    """

    code: Int[Any, "*b"]
    reynolds: Float[Any, "*b"]
    load: Float[Any, "*b"]
    gap: Float[Any, "*b"]
    iterations: Int[Any, "*b"]
    grid: Float[Any, "*b"]
    grid_minimum: Float[Any, "*b"]
    temperature: Float[Any, "*b"] | None
    turns: Int[Any, "*b"] | None


@dataclass(frozen=True)
class Films:
    """Films of contacts `*b` with what became of each.

    Attributes:
        film: fields and what follows from them, NumPy arrays; NaN where a contact was not solved.
        ended: how each solve ended.
        nodes: across a contact.
        domain: first and last place in half-widths, shape (2, *b).
        warnings: what to be wary of, in sentences, each a `Doubt`.
    """

    film: LineFilm
    ended: Ended
    nodes: int
    domain: NDArray[np.float64]
    warnings: tuple[Doubt, ...]

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Whether each contact was solved."""
        return np.asarray(np.asarray(self.ended.code) == Code.SOLVED)


def line_films(contact: LineContact, nodes: int = NODES, ends: Ends = "entrained") -> LineFilm:
    """Films of contacts as a function that can be differentiated, and be a part of programs.

    Args:
        contact: its arrays broadcast against each other to `*b`, of no axis or one.
        nodes: across a contact.
        ends: of the grid; "squeezed" for contacts that approach.

    Returns:
        Films, NaN where a contact was not solved. Derivatives are those of the solution (implicit function
        theorem, with heat of pressure and temperature together), first ones, of stiffness and damping too;
        every cell stays full of oil, or not, as it is.
    """
    grids = _ladder(nodes, ends)
    heights, even = contact.heights, replace(contact, heights=())
    shape = jnp.broadcast_shapes(*map(jnp.shape, jax.tree.leaves(even)))
    even = jax.tree.map(lambda leaf: jnp.broadcast_to(leaf, shape), even)

    def one(alone: LineContact) -> LineFilm:
        single = replace(alone, heights=heights)
        problem, pressure, level, solved = _followed(single, grids)
        push = load_and_approach_change(single, problem, grids[-1])
        solution = problem, push, pressure, level
        response = stiffness_and_damping(
            single, *solution, solution_response(*solution, grids[-1]), grids[-1]
        )
        film = line_film(single, problem, pressure, level, response, grids[-1])
        if single.texture is None:
            solved = solved & ~_torn(film.gap / problem.flow.height, problem)
        return _withheld(film, solved)

    return one(even) if even.line_load.ndim == 0 else jax.lax.map(one, even)


def _followed(
    contact: LineContact, grids: tuple[LineGrid, ...]
) -> tuple[LineProblem, Array, Array, Array]:
    """A contact as warm as it is, its pressure and level with derivatives, and whether they were found."""
    at = grids[-1]
    problem = problem_of(contact, at)
    # The iteration sees constants: a last step from its end has the derivatives, without those of every step.
    frozen, still = jax.lax.stop_gradient((problem, contact))
    state = from_coarse(frozen, grids)
    if contact.conduction is None:
        pressure, level, _ = polished_line(problem, state, at)
        return problem, pressure, level, state.residual < ENOUGH
    warm = alternating_solution(still, frozen, state, at)
    so_warm, pressure, level = polished_warm_line(contact, problem, warm, at)
    off = line_heat_defect(contact, so_warm, pressure, level, at)
    converged = (warm.state.residual < ENOUGH) & (off < WARM_ENOUGH)
    return so_warm, pressure, level, converged


def solve_lines(
    contact: LineContact,
    *,
    nodes: int = NODES,
    profiles: bool = True,
    start: Films | None = None,
    size: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Films:
    """Films of many contacts.

    Args:
        contact: its arrays broadcast against each other to `*b`.
        nodes: across a contact: 33, 65, 129, 257, ...
        profiles: whether fields are kept; without them the memory stays small for any number of contacts.
        start: films of as many contacts, with profiles on any grid, from whose pressures solves begin, such
            as those of a saved dataset.
        size: of the teeth, such as the module [m]; contacts that are wide against it are told.
        progress: called with the number of contacts that are done and that of all.

    Raises:
        InputError: a radius, modulus, viscosity, roughness, conductivity or heat capacity that is not
            positive, nodes that no grid has, or heights that are no profile of a line, or too fine for the
            nodes.
    """
    shape, flat = _flat(replace(contact, heights=()))
    check_line_contact(flat)
    check_profiles(contact, nodes)
    begin = None if start is None else _begin(start, flat.line_load.shape[0], nodes)
    closes = np.asarray(flat.approach) != 0.0
    # Each on the grid that it would have alone, and back in the order in which they came.
    groups = [np.flatnonzero(mask) for mask in (~closes, closes)]
    portions: list[tuple[LineFilm, Ended, NDArray[np.float64]]] = []
    done = 0
    for ends, which in zip(ENDS, groups, strict=True):
        some, begins = _taken(flat, which), _taken(begin, which)
        for portion in _portions(some, contact.heights, begins, nodes, ends, profiles):
            portions.append(portion)
            done += portion[1].code.size
            if progress is not None:
                progress(done, closes.size)
    back = np.argsort(np.concatenate(groups))
    film, ended, domain = jax.tree.map(lambda *parts: np.concatenate(parts)[back], *portions)
    grid_error = np.stack([ended.grid, ended.grid_minimum])
    doubts = tuple(line_film_warnings(SolvedLines(flat, film, ended.code, grid_error, nodes, size)))
    film, ended = (
        jax.tree.map(lambda leaf: leaf.reshape((*shape, *leaf.shape[1:])), tree)
        for tree in (film, ended)
    )
    domain = np.moveaxis(domain.reshape((*shape, 2)), -1, 0)
    return Films(film, ended, nodes, domain, doubts)


def _taken(tree: Tree, which: NDArray[np.int_]) -> Tree:
    """Some of the contacts that arrays have along their first axis."""
    part: Tree = jax.tree.map(lambda leaf: leaf[which], tree)
    return part


def usual_nodes(load: float, light: int = NODES) -> int:
    """Nodes on which contacts are solved unless asked otherwise.

    Args:
        load: largest load parameter M of Moes among them.
        light: nodes for loads up to M = 100.

    Source: Moes (1992) for M, see `load_parameter`; the choice is from errors of solved films.
    """
    return 2 * light - 1 if load > HEAVY else light


def _ladder(nodes: int, ends: Ends) -> tuple[LineGrid, ...]:
    """Grids from the coarsest to that of so many nodes."""
    numbers = [nodes]
    while (less := coarser_count(numbers[0])) is not None:
        numbers.insert(0, less)
    return tuple(grid(number, ends) for number in numbers)


def _flat(contact: LineContact) -> tuple[tuple[int, ...], LineContact]:
    """Shape of the contacts, and all of their arrays with one axis."""
    leaves = jax.tree.leaves(contact)
    shapes = {np.shape(leaf) for leaf in leaves}
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        listed = " and ".join(map(str, sorted(shapes, key=len)))
        raise InputError(
            f"the arrays of the contacts do not fit each other: shapes {listed}"
        ) from None
    if not np.prod(shape):
        raise InputError("there are no contacts to solve: an array is empty")
    flat = jax.tree.map(lambda leaf: np.broadcast_to(np.asarray(leaf), shape).reshape(-1), contact)
    return shape, flat


def _portions(
    flat: LineContact,
    heights: tuple[HeightMap, ...],
    begin: tuple[Any, Any] | None,
    nodes: int,
    ends: Ends,
    profiles: bool,
) -> Iterator[tuple[LineFilm, Ended, NDArray[np.float64]]]:
    every = flat.line_load.shape[0]
    solve = _soon if every <= FEW else _fast
    for start in range(0, every, PORTION):
        count = min(PORTION, every - start)
        # A last portion that is short is filled up with contacts that nobody solves.
        which = np.minimum(np.arange(start, start + PORTION), every - 1)
        part, begins = _taken((flat, begin), which)
        wanted = np.arange(PORTION) < count
        rough = replace(part, heights=heights)
        film, ended, domain = solve(rough, wanted, begins, _ladder(nodes, ends))
        film = film if profiles else _without_profiles(film)
        yield jax.tree.map(lambda leaf: np.asarray(leaf)[:count], (film, ended, domain))  # noqa: B023


def _portion(
    contact: LineContact,
    wanted: Bool[Any, " b"],
    start: tuple[Float[Any, "b node"], Float[Any, " b"]] | None,
    grids: tuple[LineGrid, ...],
) -> tuple[LineFilm, Ended, Float[Array, "b 2"]]:
    heights, even = contact.heights, replace(contact, heights=())

    def one(lane: Any) -> tuple[LineFilm, Ended, Array]:
        alone, is_wanted, begin = lane
        single = replace(alone, heights=heights)
        code = _before(single)
        # Traced once, for its shape and for its numbers.
        solve = jax.jit(partial(_solved, grids=grids))
        shape = jax.eval_shape(solve, single, begin)
        ways = lambda: solve(single, begin), lambda: _not_solved(shape, code)
        ended: tuple[LineFilm, Ended, Array] = jax.lax.cond(
            is_wanted & (code == Code.SOLVED), *ways
        )
        return ended

    films: tuple[LineFilm, Ended, Array] = jax.lax.map(one, (even, wanted, start))
    return films


_soon, _fast = program(_portion), fast_program(_portion)


def _before(contact: LineContact) -> Array:
    """What can be said of a contact before it is solved."""
    numbers = jnp.stack([jnp.all(jnp.isfinite(leaf)) for leaf in jax.tree.leaves(contact)])
    # Rough surfaces may stand still upon each other, smooth ones would have no film.
    dry = contact.texture is None
    still = (contact.entrainment == 0.0) & (contact.approach <= 0.0)
    code = jnp.where(still & dry, Code.NO_FILM, Code.SOLVED)
    if contact.conduction is not None:
        rests = (contact.speed_a == 0.0) & (contact.speed_b == 0.0)
        code = jnp.where(rests & (code == Code.SOLVED), Code.NO_STEADY_HEAT, code)
    code = jnp.where(contact.line_load <= 0.0, Code.UNLOADED, code)
    return jnp.where(jnp.all(numbers), code, Code.NO_NUMBER)


def _solved(
    contact: LineContact, begin: tuple[Array, Array] | None, grids: tuple[LineGrid, ...]
) -> tuple[LineFilm, Ended, Array]:
    at = grids[-1]
    problem, state, turns = _iterated(contact, begin, grids)
    push = load_and_approach_change(contact, problem, at)
    others = pushed_rest(problem, push, state.pressure, state.level, at)
    pressure, level, answers = polished_line(problem, state, at, others)
    response = stiffness_and_damping(contact, problem, push, pressure, level, answers, at)
    film = line_film(contact, problem, pressure, level, response, at)
    residuals = residual(problem, pressure, level, at)
    gap = problem.gap(pressure, level, at)
    converged = (state.residual < ENOUGH) & (jnp.max(jnp.abs(residuals)) < ENOUGH)
    code = jnp.where(converged, Code.SOLVED, Code.NOT_CONVERGED)
    if contact.texture is None:
        code = jnp.where(converged & _torn(gap, problem), Code.UNRESOLVED, code)
    off_heat = None if turns is None else line_heat_defect(contact, problem, pressure, level, at)
    if off_heat is not None:
        code = jnp.where(off_heat < WARM_ENOUGH, code, Code.NOT_CONVERGED)
    solved = code == Code.SOLVED
    rq = problem.flow.texture.rq / problem.flow.height
    films = problem.films(pressure, level, at)
    grid_error = _grid_errors(films, problem.opening(gap, at), state.coarse, rq)
    off = jnp.max(jnp.abs(film.gap / problem.flow.height - _as_turned(gap, contact)))
    ended = Ended(
        code,
        jnp.max(jnp.abs(residuals[:-1])),
        jnp.abs(residuals[-1]) / problem.load,
        off / jnp.min(problem.flow.room(gap)),
        state.total,
        grid_error[0],
        grid_error[1],
        off_heat,
        turns,
    )
    return _withheld(film, solved), ended, at.x[jnp.array([0, -1])] / problem.yielding


def _iterated(
    contact: LineContact, begin: tuple[Array, Array] | None, grids: tuple[LineGrid, ...]
) -> tuple[LineProblem, LineIterate, Array | None]:
    """The contact as warm as it becomes, its solution, and the turns to its temperature."""
    at = grids[-1]
    problem = problem_of(contact, at)
    if begin is None:
        state = from_coarse(problem, grids)
    else:
        state = _onward(problem, begin[0], begin[1] / problem.flow.height, grids)
    if contact.conduction is None:
        return problem, state, None
    warm = alternating_solution(contact, problem, state, at)
    cold, hot = (
        problem.films(solution.pressure, solution.level, at) for solution in (state, warm.state)
    )
    # The grid changes the warm film by as much as the isothermal one.
    warm_state = warm.state._replace(total=warm.total, coarse=state.coarse + (hot - cold))
    return warmed_line(problem, warm.rise), warm_state, warm.turns


def _onward(
    problem: LineProblem, shape: Array, gap: Array, grids: tuple[LineGrid, ...]
) -> LineIterate:
    """Solution from a pressure that is near it; those on the two grids before tell the error by the grid."""
    at = grids[-1]
    state = newton_on_line(problem, *problem.carrying(shape, gap, at), at)
    films, total, coarse = state.coarse, state.total, state
    for k, before in enumerate(grids[-2:-4:-1]):
        coarse = newton_on_line(problem, coarse.pressure[::2], coarse.level, before)
        films = films.at[k].set(solved_films(problem, coarse, before))
        total = total + coarse.total
    return state._replace(coarse=films, total=total)


def _grid_errors(films: Array, opening: Array, coarse: Array, rq: Array) -> Array:
    """Estimated errors of the film in the middle and of the smallest one, over them, shape (2,).

    Where a film happens to be alike on the last two grids, the mean film tells, or the grid before those; of
    the smallest one also how the gap opens beside it.

    Args:
        films: of `LineProblem.films`, shape (3,).
        opening: of `LineProblem.opening`.
        coarse: the same on the two grids before, shape (2, 3).
        rq: composite roughness.
    """
    latest, earlier = jnp.abs(coarse - jnp.stack((films, coarse[0])))
    change = jnp.fmax(jnp.maximum(latest[:2], latest[2]), LEAST_FALL * earlier[:2])
    errors = (jnp.asarray(OF_HALF) * change).at[1].max(OPENS * opening)
    return errors / jnp.maximum(jnp.abs(films[:2]), THINNEST * rq)


def _torn(gap: Array, problem: LineProblem) -> Array:
    """Whether smooth surfaces come nearer than any solution has them; trials may, and coarse grids."""
    return jnp.min(gap) < LEAST * problem.film


def _as_turned(gap: Array, contact: LineContact) -> Array:
    return jnp.where(contact.entrainment < 0.0, gap[::-1], gap)


def _not_solved(shape: tuple[LineFilm, Ended, Any], code: Array) -> tuple[LineFilm, Ended, Array]:
    film, ended, domain = jax.tree.map(
        lambda leaf: jnp.full(leaf.shape, jnp.nan if leaf.dtype.kind == "f" else 0, leaf.dtype),
        shape,
    )
    return film, eqx.tree_at(lambda tree: tree.code, ended, code.astype(ended.code.dtype)), domain


def _withheld(film: LineFilm, solved: Array) -> LineFilm:
    """The numbers of what was solved; nothing of what was not."""
    shown: LineFilm = jax.tree.map(lambda leaf: jnp.where(solved, leaf, jnp.nan), film)
    return shown


def _without_profiles(film: LineFilm) -> LineFilm:
    along = film.x.ndim
    bare: LineFilm = jax.tree.map(lambda leaf: leaf[..., :0] if leaf.ndim == along else leaf, film)
    return bare


def _begin(start: object, count: int, nodes: int) -> tuple[Any, Any]:
    """Pressures along the grid and films in the middle from which solves begin."""
    if not isinstance(start, Films):
        raise InputError(
            f"a start of type {type(start).__name__} is no films; `films_of_dataset` makes some of a dataset "
            "of `film_dataset`"
        )
    across, number = np.shape(start.film.pressure)[-1], start.ended.code.size
    if not across or number != count:
        raise InputError(
            f"films of {number} contacts on {across} nodes are no start for {count} contacts on {nodes} nodes"
        )
    x, pressure, gap = (
        np.asarray(field).reshape(count, across)
        for field in (start.film.x, start.film.pressure, start.film.gap)
    )
    middle = np.argmin(np.abs(x), axis=-1)
    # A grid follows the entrainment, and has its long side ahead.
    turned = np.abs(x[:, -1]) > 1.5 * np.abs(x[:, 0])
    along = np.where(turned[:, None], pressure[:, ::-1], pressure)
    return _on_nodes(along, nodes), gap[np.arange(count), middle]


def _on_nodes(values: NDArray[np.float64], nodes: int) -> NDArray[np.float64]:
    """Values at the nodes of a grid from those of a finer or coarser one, along the last axis."""
    size = values.shape[-1]
    if size >= nodes:
        return values[:, :: (size - 1) // (nodes - 1)]
    return np.maximum(values @ prolongation(size, nodes).T, 0.0)
