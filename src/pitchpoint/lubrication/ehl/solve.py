"""Line contacts solved, many at once: in portions, with what became of each, and what to be wary of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final, TypeVar

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int
from numpy.typing import NDArray

from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.doubt import Doubt
from pitchpoint.lubrication.ehl.fields import LineFilm, line_film
from pitchpoint.lubrication.ehl.grid import ENDS, Ends, Grid, fewer, grid
from pitchpoint.lubrication.ehl.heat import (
    WARM_ENOUGH,
    defect,
    turned,
    warmed,
)
from pitchpoint.lubrication.ehl.line import LEAST, LineContact, Problem, problem_of
from pitchpoint.lubrication.ehl.newton import (
    ENOUGH,
    State,
    from_coarse,
    iterated,
    polished,
    residual,
)
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.lubrication.flash_temperature import LEAST_PECLET
from pitchpoint.lubrication.groups import line_groups
from pitchpoint.programs import fast_program, program
from pitchpoint.status import Code

__all__ = ["NODES", "Films", "line_films", "solve_lines"]

Tree = TypeVar("Tree")

NODES: Final = 129
"""Usual number of nodes: films come within 1 % of those on ever finer grids, minimum ones within 3 %."""

PORTION: Final = 64
"""Contacts of a program at once; between portions progress is told, and an interrupt is heard."""

COARSE: Final = 0.03
"""Error by the grid from which on it is told."""

FEW: Final = 128
"""Contacts up to which a program that compiles quickly is done sooner than one that runs twice as fast."""

WIDE: Final = 0.1
"""Half-width over radius, or over the size of a tooth, from which on bodies are no half spaces any more."""


class Ended(eqx.Module):
    """How a solve ended, of contacts `*b`.

    Attributes:
        code: of `Code`.
        reynolds: largest defect of the balance of a cell, in units of Hertz's pressure.
        load: defect of the load over it.
        gap: defect of the gap over the smallest one: elastic deformation against the gap of the result.
        iterations: of Newton's method, on all grids.
        grid: estimate of the error of the film in the middle that the grid makes, over that film, from the
            film on the grid before; NaN where there was none.
        temperature: defect of the temperature of the film over its largest rise; None of isothermal films.
        turns: between pressure and temperature, on all grids; None of isothermal films.
    """

    code: Int[Any, "*b"]
    reynolds: Float[Any, "*b"]
    load: Float[Any, "*b"]
    gap: Float[Any, "*b"]
    iterations: Int[Any, "*b"]
    grid: Float[Any, "*b"]
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
    warnings: tuple[str, ...]

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
        theorem), first ones; every cell stays full of oil, or not, as it is.

    Raises:
        InputError: a contact with conduction: with temperatures there are no derivatives.
    """
    if contact.conduction is not None:
        raise InputError("derivatives of films are known for isothermal ones alone", key="thermal")
    grids = _ladder(nodes, ends)
    shape = jnp.broadcast_shapes(*map(jnp.shape, jax.tree.leaves(contact)))
    contact = jax.tree.map(lambda leaf: jnp.broadcast_to(leaf, shape), contact)

    def one(single: LineContact) -> LineFilm:
        problem = problem_of(single)
        state = from_coarse(jax.lax.stop_gradient(problem), grids)
        film = line_film(single, problem, *polished(problem, state, grids[-1]), grids[-1])
        found = state.residual < ENOUGH
        if single.texture is None:
            found = found & ~_torn(film.gap / problem.flow.height, problem)
        return _withheld(film, found)

    return one(contact) if contact.line_load.ndim == 0 else jax.lax.map(one, contact)


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
        start: films of as many contacts on as many nodes, with profiles, from whose pressures solves begin.
        size: of the teeth, such as the module [m]; contacts that are wide against it are told.
        progress: called with the number of contacts that are done and that of all.

    Raises:
        InputError: a radius, modulus, viscosity, roughness, conductivity or heat capacity that is not
            positive, or nodes that no grid has.
    """
    shape, flat = _flat(contact)
    _check(flat)
    begin = None if start is None else _begin(start, flat.line_load.shape[0], nodes)
    closes = np.asarray(flat.approach) != 0.0
    # Each on the grid that it would have alone, and back in the order in which they came.
    groups = [np.flatnonzero(one) for one in (~closes, closes)]
    portions: list[tuple[LineFilm, Ended, NDArray[np.float64]]] = []
    done = 0
    for ends, which in zip(ENDS, groups, strict=True):
        some, given = _taken(flat, which), _taken(begin, which)
        for portion in _portions(some, given, nodes, ends, profiles):
            portions.append(portion)
            done += portion[1].code.size
            if progress is not None:
                progress(done, closes.size)
    back = np.argsort(np.concatenate(groups))
    film, ended, domain = jax.tree.map(lambda *parts: np.concatenate(parts)[back], *portions)
    warnings = tuple(_warnings(flat, film, ended, size))
    film, ended = (
        jax.tree.map(lambda leaf: leaf.reshape((*shape, *leaf.shape[1:])), one)
        for one in (film, ended)
    )
    domain = np.moveaxis(domain.reshape((*shape, 2)), -1, 0)
    return Films(film, ended, nodes, domain, warnings)


def _taken(tree: Tree, which: NDArray[np.int_]) -> Tree:
    """Some of the contacts that arrays have along their first axis."""
    found: Tree = jax.tree.map(lambda leaf: leaf[which], tree)
    return found


def _ladder(nodes: int, ends: Ends) -> tuple[Grid, ...]:
    """Grids from the coarsest to that of so many nodes."""
    numbers = [nodes]
    while (less := fewer(numbers[0])) is not None:
        numbers.insert(0, less)
    return tuple(grid(number, ends) for number in numbers)


def _flat(contact: LineContact) -> tuple[tuple[int, ...], LineContact]:
    """Shape of the contacts, and all of their arrays with one axis."""
    leaves = jax.tree.leaves(contact)
    shapes = {np.shape(leaf) for leaf in leaves}
    try:
        shape = np.broadcast_shapes(*shapes)
    except ValueError:
        told = " and ".join(map(str, sorted(shapes, key=len)))
        raise InputError(
            f"the arrays of the contacts do not fit each other: shapes {told}"
        ) from None
    if not np.prod(shape):
        raise InputError("there are no contacts to solve: an array is empty")
    flat = jax.tree.map(lambda leaf: np.broadcast_to(np.asarray(leaf), shape).reshape(-1), contact)
    return shape, flat


def _portions(
    flat: LineContact,
    begin: tuple[Any, Any] | None,
    nodes: int,
    ends: Ends,
    profiles: bool,
) -> Iterator[tuple[LineFilm, Ended, NDArray[np.float64]]]:
    every = flat.line_load.shape[0]
    solve = _soon if every <= FEW else _fast
    for first in range(0, every, PORTION):
        count = min(PORTION, every - first)
        # A last portion that is short is filled up with contacts that nobody solves.
        which = np.minimum(np.arange(first, first + PORTION), every - 1)
        part, given = _taken((flat, begin), which)
        wanted = np.arange(PORTION) < count
        film, ended, domain = solve(part, wanted, given, _ladder(nodes, ends))
        film = film if profiles else _without_profiles(film)
        yield jax.tree.map(lambda leaf: np.asarray(leaf)[:count], (film, ended, domain))  # noqa: B023


def _portion(
    contact: LineContact,
    wanted: Bool[Any, " b"],
    start: tuple[Float[Any, "b node"], Float[Any, " b"]] | None,
    grids: tuple[Grid, ...],
) -> tuple[LineFilm, Ended, Float[Array, "b 2"]]:
    def one(given: Any) -> tuple[LineFilm, Ended, Array]:
        single, asked, begin = given
        code = _before(single)
        ways = lambda: _solved(single, begin, grids), lambda: _not_solved(single, code, grids)
        ended: tuple[LineFilm, Ended, Array] = jax.lax.cond(asked & (code == Code.SOLVED), *ways)
        return ended

    found: tuple[LineFilm, Ended, Array] = jax.lax.map(one, (contact, wanted, start))
    return found


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
    return jnp.where(jnp.all(numbers), code, Code.NOT_FINITE)


def _solved(
    contact: LineContact, begin: tuple[Array, Array] | None, grids: tuple[Grid, ...]
) -> tuple[LineFilm, Ended, Array]:
    at = grids[-1]
    problem, state, turns = _iterated(contact, begin, grids)
    pressure, level = polished(problem, state, at)
    film = line_film(contact, problem, pressure, level, at)
    rest = residual(problem, pressure, level, at)
    gap = problem.gap(pressure, level, at)
    converged = (state.residual < ENOUGH) & (jnp.max(jnp.abs(rest)) < ENOUGH)
    code = jnp.where(converged, Code.SOLVED, Code.NOT_CONVERGED)
    if contact.texture is None:
        code = jnp.where(converged & _torn(gap, problem), Code.UNRESOLVED, code)
    off_heat = None if turns is None else defect(contact, problem, pressure, level, at)
    if off_heat is not None:
        code = jnp.where(off_heat < WARM_ENOUGH, code, Code.NOT_CONVERGED)
    found = code == Code.SOLVED
    at_middle = problem.film_in_the_middle(pressure, level, at)
    off = jnp.max(jnp.abs(film.gap / problem.flow.height - _as_turned(gap, contact)))
    ended = Ended(
        code,
        jnp.max(jnp.abs(rest[:-1])),
        jnp.abs(rest[-1]) / problem.load,
        off / jnp.min(problem.flow.room(gap)),
        state.total,
        jnp.abs(at_middle - state.coarse) / _gain(grids) / at_middle,
        off_heat,
        turns,
    )
    return _withheld(film, found), ended, at.x[jnp.array([0, -1])] / problem.yielding


def _iterated(
    contact: LineContact, begin: tuple[Array, Array] | None, grids: tuple[Grid, ...]
) -> tuple[Problem, State, Array | None]:
    """The contact as warm as it becomes, its solution, and the turns to its temperature."""
    problem, at = problem_of(contact), grids[-1]
    if begin is None:
        state = from_coarse(problem, grids)
    else:
        shape, gap = begin
        state = iterated(problem, *problem.carrying(shape, gap / problem.flow.height, at), at)
    if contact.conduction is None:
        return problem, state, None
    warm = turned(contact, problem, state, at)
    cold, hot = (
        problem.film_in_the_middle(one.pressure, one.level, at) for one in (state, warm.state)
    )
    # The grid makes as large a part of the warm film its error as of the isothermal one.
    found = warm.state._replace(total=warm.total, coarse=state.coarse * hot / cold)
    return warmed(problem, warm.rise), found, warm.turns


def _gain(grids: tuple[Grid, ...]) -> float:
    """By how much the last grid is better than the one before, but for one: errors are of second order."""
    fine, coarse = grids[-1].x.shape[0], grids[max(len(grids) - 2, 0)].x.shape[0]
    return ((fine - 1) / (coarse - 1)) ** 2 - 1.0


def _torn(gap: Array, problem: Problem) -> Array:
    """Whether smooth surfaces come nearer than any solution has them; trials may, and coarse grids."""
    return jnp.min(gap) < LEAST * problem.film


def _as_turned(gap: Array, contact: LineContact) -> Array:
    return jnp.where(contact.entrainment < 0.0, gap[::-1], gap)


def _not_solved(
    contact: LineContact, code: Array, grids: tuple[Grid, ...]
) -> tuple[LineFilm, Ended, Array]:
    shape = jax.eval_shape(lambda: _solved(contact, None, grids))
    film, ended, domain = jax.tree.map(
        lambda leaf: jnp.full(leaf.shape, jnp.nan if leaf.dtype.kind == "f" else 0, leaf.dtype),
        shape,
    )
    return film, eqx.tree_at(lambda one: one.code, ended, code.astype(ended.code.dtype)), domain


def _withheld(film: LineFilm, found: Array) -> LineFilm:
    """The numbers of what was solved; nothing of what was not."""
    kept: LineFilm = jax.tree.map(lambda leaf: jnp.where(found, leaf, jnp.nan), film)
    return kept


def _without_profiles(film: LineFilm) -> LineFilm:
    along = film.x.ndim
    found: LineFilm = jax.tree.map(lambda leaf: leaf[..., :0] if leaf.ndim == along else leaf, film)
    return found


def _begin(start: Films, count: int, nodes: int) -> tuple[Any, Any]:
    """Pressures and films in the middle from which solves begin."""
    pressure = np.asarray(start.film.pressure).reshape(-1, start.film.pressure.shape[-1])
    if pressure.shape != (count, nodes):
        raise InputError(
            f"films of {pressure.shape[0]} contacts on {pressure.shape[1]} nodes are no start for "
            f"{count} contacts on {nodes} nodes"
        )
    gap = np.asarray(start.film.gap).reshape(count, nodes)
    middle = np.argmin(np.abs(np.asarray(start.film.x).reshape(count, nodes)), axis=-1)
    return pressure, gap[np.arange(count), middle]


# ---- what is wrong with an input, and what is doubtful about a result


def _check(contact: LineContact) -> None:
    """InputError for values that no contact has."""
    fluid, texture = contact.fluid, contact.texture
    positive = {
        "radius": (contact.radius, "a relative radius of curvature", 1.0, "m"),
        "modulus": (contact.modulus, "a modulus E'", 1e-9, "GPa"),
        "viscosity": (fluid.viscosity, "a viscosity", 1e3, "mPa s"),
        "pressure_viscosity": (
            fluid.pressure_viscosity,
            "a pressure-viscosity coefficient",
            1e9,
            "1/GPa",
        ),
        "inlet": (contact.inlet, "a distance at which oil begins", 1e3, "mm"),
    }
    for name, value in fluid.shear_parameters.items():
        positive[name] = (value, f"a shear parameter {name}", 1.0, "in SI units")
    if texture is not None:
        positive["rq"] = (texture.rq, "a composite roughness Rq", 1e6, "um")
    if isinstance(texture, Rough):
        positive["eta_beta_sigma"] = (texture.eta_beta_sigma, "an eta_beta_sigma", 1.0, "")
        positive["sigma_over_beta"] = (texture.sigma_over_beta, "a sigma_over_beta", 1.0, "")
        if np.min(np.asarray(texture.friction)) < 0.0:
            raise InputError(
                f"a boundary friction of {np.min(np.asarray(texture.friction)):.4g}: it must not be negative",
                key="boundary_friction",
            )
    if contact.conduction is not None:
        positive |= _of_conduction(contact.conduction)
    for key, (value, what, scale, unit) in positive.items():
        low = np.min(np.asarray(value))
        if not low > 0.0 and not np.isnan(low):
            told = f"{low * scale:.4g} {unit}".strip()
            raise InputError(f"{what} of {told}: it must be positive", key=key)


def _of_conduction(given: Conduction) -> dict[str, tuple[Any, str, float, str]]:
    """What of conduction has to be positive: value, what it is, scale and unit, by its key."""
    of_oil = given.oil_conductivity, "a conductivity of the oil", 1.0, "W/m/K"
    found: dict[str, tuple[Any, str, float, str]] = {"oil_conductivity": of_oil}
    for member, body in enumerate((given.a, given.b)):
        conducts = body.conductivity, f"a conductivity of member {member}", 1.0, "W/m/K"
        stores = body.heat_capacity, f"a heat capacity of member {member}", 1e-6, "J/cm3/K"
        found |= {f"conductivity_{member}": conducts, f"heat_capacity_{member}": stores}
    return found


def _warnings(
    contact: LineContact, film: LineFilm, ended: Ended, size: float | None
) -> Iterator[str]:
    solved = np.asarray(ended.code) == Code.SOLVED
    if not solved.any():
        return
    some: LineContact = jax.tree.map(lambda leaf: np.asarray(leaf)[solved], contact)
    half_width = np.asarray(film.half_width)[solved]
    yield from _of_pressure(some, np.asarray(film.hertz_pressure)[solved])
    yield from _of_half_space(some, half_width, size)
    yield from _of_inlet(some, half_width)
    yield from _of_grid(np.asarray(ended.grid)[solved])
    if some.texture is not None:
        yield from _of_roughness(np.asarray(some.texture.rq), half_width)
    if film.heat is not None:
        peclet = np.stack([film.heat.peclet_a, film.heat.peclet_b])[:, solved]
        yield from _of_strips(peclet, np.stack([some.speed_a, some.speed_b]), half_width)


def _of_pressure(contact: LineContact, pressure: NDArray[np.float64]) -> Iterator[str]:
    told = contact.fluid.outside(pressure)
    if told is not None:
        sentence = f"{told}: films and traction there are extrapolated"
        yield Doubt(sentence, "pressure", pressure.max())


def _of_half_space(
    contact: LineContact, half_width: NDArray[np.float64], size: float | None
) -> Iterator[str]:
    radius = np.asarray(contact.radius)
    sizes = {"the relative radius": radius}
    if size is not None:
        sizes["the size of a tooth"] = np.full_like(radius, size)
    for name, length in sizes.items():
        worst = np.argmax(half_width / length)
        if half_width[worst] > WIDE * length[worst]:
            yield Doubt(
                f"the contact is {2e3 * half_width[worst]:.3g} mm wide, and {name} is "
                f"{1e3 * length[worst]:.3g} mm: the bodies are no half spaces, as the deformation takes them",
                f"wide against {name}",
                half_width[worst] / length[worst],
            )


def _of_roughness(rough: NDArray[np.float64], half_width: NDArray[np.float64]) -> Iterator[str]:
    worst = np.argmax(rough / half_width)
    if rough[worst] > WIDE * half_width[worst]:
        yield Doubt(
            f"a roughness Rq of {1e6 * rough[worst]:.3g} um is large against a contact that is "
            f"{2e6 * half_width[worst]:.3g} um wide: few asperities carry it, and their mean says little",
            "roughness",
            rough[worst] / half_width[worst],
        )


def _of_strips(
    peclet: NDArray[np.float64], speed: NDArray[np.float64], half_width: NDArray[np.float64]
) -> Iterator[str]:
    member, worst = np.unravel_index(np.argmin(peclet), peclet.shape)
    if peclet[member, worst] < LEAST_PECLET:
        yield Doubt(
            f"member {member} passes a contact {2e3 * half_width[worst]:.3g} mm wide at "
            f"{abs(speed[member, worst]):.3g} m/s, a Peclet number of {peclet[member, worst]:.3g}: below "
            f"{LEAST_PECLET:g} heat spreads along the surface too, which comes out too warm, and one that "
            "stands still is taken to take none",
            "strips",
            -peclet[member, worst],
        )


def _of_grid(error: NDArray[np.float64]) -> Iterator[str]:
    rough = error > COARSE
    if rough.any():
        yield Doubt(
            f"the grid is coarse for the thin films of {rough.sum()} of {rough.size} contacts: they may be "
            f"off by {100.0 * error.max():.2g} %; take more nodes",
            "grid",
            error.max(),
        )


def _of_inlet(contact: LineContact, half_width: NDArray[np.float64]) -> Iterator[str]:
    given, needed = np.asarray(contact.inlet) / half_width, flooded_inlet(contact)
    worst = np.argmin(given / needed)
    if given[worst] < needed[worst] * (1.0 - 1e-9):
        yield Doubt(
            f"oil begins {given[worst]:.3g} half-widths before the middle of a contact, and a fully flooded "
            f"one draws it from {needed[worst]:.0f} on: the contact is starved",
            "inlet",
            needed[worst] / given[worst],
        )


def flooded_inlet(contact: LineContact) -> NDArray[np.float64]:
    """Length of inlet beyond which oil no longer changes the film by more than a hundredth [half-widths].

    3 above a load parameter M = w/(E' R) (2 eta0 u/(E' R))^(-1/2) of 30, 4 above 10, 8 above 5, else 12:
    contacts with thick films draw oil from further away. Rolling resistance falls off with it much more
    slowly: it is 10 to 20 % below that of an endless inlet. From films of inlets of 2 to 12 half-widths.
    """
    oil = contact.fluid
    speed = abs(contact.entrainment)
    given = oil.viscosity, oil.pressure_viscosity, contact.radius, contact.modulus
    W, U, _ = map(np.asarray, line_groups(contact.line_load, speed, *given))
    load = W / np.sqrt(np.maximum(2.0 * U, 1e-30))
    return np.select([load > 30.0, load > 10.0, load > 5.0], [3.0, 4.0, 8.0], 12.0)
