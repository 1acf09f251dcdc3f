"""Heat of line contacts: temperatures of film and surfaces in balance with the pressure."""

from __future__ import annotations

from typing import Final, NamedTuple

import equinox as eqx
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.factored import Arrays
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.grid import Grid
from pitchpoint.lubrication.ehl.line import SLOWEST, LineContact, Problem
from pitchpoint.lubrication.ehl.newton import ENOUGH, State, iterated, residual
from pitchpoint.lubrication.ehl.work import filled, pressure_flow, shear_stress, work_of_expansion
from pitchpoint.lubrication.flash_temperature import Conductor, moving_strip, peclet_number

__all__ = [
    "WARM_ENOUGH",
    "Spread",
    "Temperatures",
    "Warm",
    "defect",
    "settled",
    "temperatures",
    "turned",
    "warmed",
]

Nodes = Float[Arrays, "*b node"]
Each = Float[Arrays, "*b"]

WARM_ENOUGH: Final = 1e-6
"""Defect of the temperature over the largest rise, with which a film counts as solved."""

STEADY: Final = 1e-7
"""Change of the temperature in a turn, over the largest rise, at which turns end."""

MOST_TURNS: Final = 60
"""Turns between pressure and temperature after which a contact is given up."""

MOST_STEPS: Final = 60
"""Steps of Newton's method for the temperature in a turn."""

REMEMBERED: Final = 4
"""Turns from whose differences the next one begins."""

NEAR: Final = 0.03
"""Change of the temperature in a turn, over the largest rise, below which turns of the past are used."""

LEAST_RISE: Final = 1e-6
"""Rise of temperature that counts as none [K]."""


class Temperatures(eqx.Module):
    """Heat and rises of temperature above the inlet, of line contacts `*b`.

    Attributes:
        film: mean over the film [K].
        surface_a: of member 0 [K].
        surface_b: of member 1 [K].
        flux_a: heat per area into member 0 [W/m2].
        flux_b: into member 1 [W/m2].
        heat: per area that film and asperities make [W/m2].
        largest_film: largest mean over the film [K].
        largest_a: flash temperature of member 0, largest [K].
        largest_b: of member 1 [K].
        power_a: heat into member 0 [W/m].
        power_b: into member 1 [W/m].
        expansion_power: work that the oil does as it expands warm after it was compressed cold; with the
            work against friction it makes up the heat [W/m].
        peclet_a: Peclet number |u| b rho c/(2 k) of member 0.
        peclet_b: of member 1.
    """

    film: Nodes
    surface_a: Nodes
    surface_b: Nodes
    flux_a: Nodes
    flux_b: Nodes
    heat: Nodes
    largest_film: Each
    largest_a: Each
    largest_b: Each
    power_a: Each
    power_b: Each
    expansion_power: Each
    peclet_a: Each
    peclet_b: Each


class Spread(NamedTuple):
    """How temperatures follow from heat per area at every node of a contact.

    Across the film k T'' = -q/h with the temperatures of the surfaces at its ends, so that half of q and
    k (Tb - Ta)/h go into a, and the mean is that of the surfaces and q h/(12 k).

    Attributes:
        strip_a: rise of surface a by heat per area into it, shape (node, node) [K m2/W].
        strip_b: of surface b.
        across: heat from surface b to a by their difference k/h, shape (node,) [W/m2/K].
    """

    strip_a: Float[Array, "node node"]
    strip_b: Float[Array, "node node"]
    across: Float[Array, " node"]

    @property
    def within(self) -> Array:
        """Rise of the mean film above that of the surfaces by heat in the film, shape (node,) [K m2/W]."""
        return 1.0 / (12.0 * self.across)

    @property
    def to_a(self) -> Array:
        """Heat into surface a by heat that is made, shape (node, node) [1]; the rest goes into b."""
        return self.into_a(jnp.eye(self.across.shape[0]))

    @property
    def mean(self) -> Array:
        """Mean rise of both surfaces by heat that is made, shape (node, node) [K m2/W]."""
        return self.of_surfaces(jnp.eye(self.across.shape[0]))

    def into_a(self, heat: Array) -> Array:
        """Heat into surface a by some that is made, shape (node, ...) [W/m2]."""
        # Tb - Ta = (Sb - Sa) q/2 - (Sa + Sb) across (Tb - Ta)
        mixed = jnp.eye(self.across.shape[0]) + (self.strip_a + self.strip_b) * self.across
        apart = jnp.linalg.solve(mixed, 0.5 * (self.strip_b - self.strip_a) @ heat)
        found: Array = 0.5 * heat + (self.across * apart.T).T
        return found

    def of_surfaces(self, heat: Array) -> Array:
        """Mean rise of both surfaces by some heat that is made, shape (node, ...) [K]."""
        into_a = self.into_a(heat)
        found: Array = 0.5 * (self.strip_a @ into_a + self.strip_b @ (heat - into_a))
        return found


def _strip(body: Conductor, speed: Array, length: Array, at: Grid) -> Array:
    """Rise of a surface by heat per area into it, shape (node, node) [K m2/W]."""
    edges = at.x[0] + jnp.append(0.0, jnp.cumsum(at.widths))
    along, against = moving_strip(at.x, edges), moving_strip(-at.x[::-1], -edges[::-1])
    passed = jnp.where(speed >= 0.0, along, against[::-1, ::-1])
    fast = jnp.maximum(jnp.abs(speed), SLOWEST)
    return passed * jnp.sqrt(length / (jnp.pi * fast)) / body.effusivity


def _forward(contact: LineContact) -> tuple[Array, Array]:
    """Speeds of both surfaces along the grid, which follows the entrainment [m/s]."""
    sign = jnp.where(contact.entrainment < 0.0, -1.0, 1.0)
    return sign * contact.speed_a, sign * contact.speed_b


def _conduction(contact: LineContact) -> Conduction:
    assert contact.conduction is not None
    return contact.conduction


class _Found(NamedTuple):
    """What pressure and level give, which heat is made of."""

    oil: Array
    gap: Array
    room: Array
    asperities: Array
    length: Array
    spread: Spread


def _found(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> _Found:
    flow, given = problem.flow, _conduction(contact)
    gap = problem.gap(pressure, level, at)
    asperities, room = flow.asperity_pressure(gap), flow.room(gap)
    length = contact.half_width / problem.yielding
    speed_a, speed_b = _forward(contact)
    strips = _strip(given.a, speed_a, length, at), _strip(given.b, speed_b, length, at)
    through = Spread(*strips, given.oil_conductivity / (room * flow.height))
    return _Found(pressure - asperities, gap, room, asperities, length, through)


def _power(problem: Problem) -> Array:
    """Unit of power per length of contact line [W/m]."""
    return problem.flow.pressure * problem.flow.height * problem.speed


def _made(
    contact: LineContact, problem: Problem, found: _Found, moved: Array, at: Grid
) -> tuple[Array, Array]:
    """Heat per area that the film makes at each node, and the asperities, where mass is moved as given."""
    flow, sliding = problem.flow, contact.speed_b - contact.speed_a
    stress = shear_stress(flow, found.oil, found.room, sliding)
    shear = filled(flow, found.oil, found.room) * stress * sliding
    # Half of what a face makes belongs to each of the nodes beside it.
    pumping = 0.5 * moved**2 * pressure_flow(flow, found.oil, found.gap, at)[1]
    pumping = jnp.append(pumping, 0.0) + jnp.append(0.0, pumping)
    rubbed = flow.texture.boundary_friction * found.asperities * flow.pressure
    return shear + pumping * _power(problem) / (at.widths * found.length), rubbed * jnp.abs(sliding)


def warmed(problem: Problem, rise: Array) -> Problem:
    """The contact with a film that is so much warmer than its inlet, shape (node,) [K]."""
    found: Problem = eqx.tree_at(lambda one: one.flow.temperature_rise, problem, rise)
    return found


def _in_balance(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> Array:
    """Rise of the film at a pressure, by Newton's method, shape (node,) [K].

    The mass that pressure moves is held instead of the slope of the pressure: the heat of a flow that is held
    falls as the oil becomes warmer, that of a slope that is held rises without bound.
    """
    found = _found(contact, problem, pressure, level, at)
    moved, _ = pressure_flow(problem.flow, found.oil, found.gap, at)
    mean, none = found.spread.mean, jnp.eye(pressure.shape[0])
    whole = mean + jnp.diag(found.spread.within)

    def made(rise: Array) -> tuple[Array, tuple[Array, Array]]:
        film, rubbed = _made(contact, warmed(problem, rise), found, moved, at)
        return film, (film, rubbed)

    def onward(given: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        rise, _, steps = given
        by_rise, (film, rubbed) = jax.jacfwd(made, has_aux=True)(rise)
        off = rise - whole @ film - mean @ rubbed
        better = jnp.maximum(rise - jnp.linalg.solve(none - whole @ by_rise, off), 0.0)
        change = jnp.max(jnp.abs(better - rise)) / (jnp.max(better) + LEAST_RISE)
        return better, change, steps + 1

    def unfinished(given: tuple[Array, Array, Array]) -> Array:
        _, change, steps = given
        return (change > 0.1 * STEADY) & (steps < MOST_STEPS)

    begin = problem.flow.temperature_rise, jnp.asarray(jnp.inf), jnp.asarray(0)
    rise: Array = jax.lax.while_loop(unfinished, onward, begin)[0]
    return rise


class Warm(NamedTuple):
    """Where pressure and temperature of a contact stand.

    Attributes:
        state: of the pressure.
        rise: of the film above its inlet, shape (node,) [K].
        change: of the rise in the last turn over the largest rise.
        turns: between pressure and temperature.
        total: steps of Newton's method for the pressure.
    """

    state: State
    rise: Float[Array, " node"]
    change: Float[Array, ""]
    turns: Int[Array, ""]
    total: Int[Array, ""]
    past: Past


class Past(NamedTuple):
    """Last turn of the temperature, and how the turns before it differed from each other.

    Attributes:
        found: rise that the turn found, shape (node,) [K].
        moved: by how much that differed from what it began with, shape (node,) [K].
        all_found: differences between turns, shape (REMEMBERED, node) [K].
        all_moved: of the same turns.
    """

    found: Float[Array, " node"]
    moved: Float[Array, " node"]
    all_found: Float[Array, "turn node"]
    all_moved: Float[Array, "turn node"]


def _accelerated(past: Past, begun: Array, found: Array, known: Array) -> tuple[Array, Past]:
    """Rise from which the next turn begins: where turns of the past together would have moved least.

    Source: Anderson (1965), with differences between turns as unknowns.
    """
    moved = found - begun
    by_found = jnp.roll(past.all_found, 1, axis=0).at[0].set(known * (found - past.found))
    by_moved = jnp.roll(past.all_moved, 1, axis=0).at[0].set(known * (moved - past.moved))
    square = by_moved @ by_moved.T
    # Rows of turns that were not yet made are zero: the bound gives them no part.
    bound = (1e-14 * jnp.trace(square) + 1e-300) * jnp.eye(REMEMBERED)
    parts = jnp.linalg.solve(square + bound, by_moved @ moved)
    return jnp.maximum(found - parts @ by_found, 0.0), Past(found, moved, by_found, by_moved)


def turned(contact: LineContact, problem: Problem, state: State, at: Grid) -> Warm:
    """Pressure and temperature in turns, from the isothermal solution or any other pressure."""

    def onward(warm: Warm) -> Warm:
        so_warm = warmed(problem, warm.rise)
        state = iterated(so_warm, warm.state.pressure, warm.state.level, at)
        rise = _in_balance(contact, so_warm, state.pressure, state.level, at)
        change = jnp.max(jnp.abs(rise - warm.rise)) / (jnp.max(rise) + LEAST_RISE)
        near = (change < NEAR) & (warm.change < NEAR)
        quicker, past = _accelerated(warm.past, warm.rise, rise, near)
        rise = jnp.where(near & (change > STEADY), quicker, rise)
        return Warm(state, rise, change, warm.turns + 1, warm.total + state.total, past)

    def unfinished(warm: Warm) -> Array:
        lost = (warm.turns > 0) & ~(warm.state.residual < ENOUGH)
        return ~(warm.change < STEADY) & (warm.turns < MOST_TURNS) & ~lost

    cold, none = jnp.zeros_like(at.x), jnp.zeros((REMEMBERED, *at.x.shape))
    past = Past(cold, cold, none, none)
    begin = Warm(state, cold, jnp.asarray(jnp.inf), jnp.asarray(0), state.total, past)
    found: Warm = jax.lax.while_loop(unfinished, onward, begin)
    return found


def settled(
    contact: LineContact, problem: Problem, warm: Warm, at: Grid
) -> tuple[Problem, Array, Array]:
    """Contact as warm as it is, pressure and level, with their derivatives to all that it is made of.

    A last step of pressure, level and temperature together carries them (implicit function theorem), with the
    cells that are full and those that are not as they are.

    Args:
        contact: one, with conduction.
        problem: the same in units of its own, as warm as its inlet.
        warm: at which the turns ended.
        at: the grid.
    """
    nodes = at.x.shape[0]

    def parts(found: Array) -> tuple[Problem, Array, Array]:
        inner, level, rise = found[: nodes - 2], found[nodes - 2], found[nodes - 1 :]
        return warmed(problem, rise), jnp.pad(inner, 1), level

    def left(contact: LineContact, problem: Problem, found: Array) -> Array:
        _, pressure, level = parts(found)
        so_warm = warmed(problem, found[nodes - 1 :])
        rise, by_heat, *_ = _balance(contact, so_warm, pressure, level, at)
        return jnp.append(residual(so_warm, pressure, level, at), rise - by_heat)

    state = warm.state
    found = jnp.concatenate((state.pressure[1:-1], state.level[None], warm.rise))
    *frozen, found = jax.lax.stop_gradient((contact, problem, found))
    matrix = jax.jacfwd(left, 2)(*frozen, found)
    return parts(found - jnp.linalg.solve(matrix, left(contact, problem, found)))


def defect(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> Array:
    """Rise of the film against that by its heat, over the largest rise."""
    rise, by_heat, *_ = _balance(contact, problem, pressure, level, at)
    return jnp.max(jnp.abs(rise - by_heat)) / (jnp.max(by_heat) + LEAST_RISE)


def _balance(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> tuple[Array, Array, Array, _Found]:
    """Rise of the film, that by its heat, the heat per area, and what it is made of."""
    found = _found(contact, problem, pressure, level, at)
    moved, _ = pressure_flow(problem.flow, found.oil, found.gap, at)
    film, rubbed = _made(contact, problem, found, moved, at)
    by_heat = found.spread.of_surfaces(film + rubbed) + found.spread.within * film
    return problem.flow.temperature_rise, by_heat, film + rubbed, found


def temperatures(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> Temperatures | None:
    """Heat and temperatures of one contact along its grid; None of an isothermal one."""
    if contact.conduction is None:
        return None
    rise, _, heat, found = _balance(contact, problem, pressure, level, at)
    into_a = found.spread.into_a(heat)
    into_b = heat - into_a
    surface_a, surface_b = found.spread.strip_a @ into_a, found.spread.strip_b @ into_b
    cells, half_width = at.widths * found.length, contact.half_width
    a, b = contact.conduction.a, contact.conduction.b
    expansion = work_of_expansion(problem.flow, found.oil, found.gap, at)
    return Temperatures(
        film=rise,
        surface_a=surface_a,
        surface_b=surface_b,
        flux_a=into_a,
        flux_b=into_b,
        heat=heat,
        largest_film=jnp.max(rise),
        largest_a=jnp.max(surface_a),
        largest_b=jnp.max(surface_b),
        power_a=cells @ into_a,
        power_b=cells @ into_b,
        expansion_power=expansion * _power(problem),
        peclet_a=peclet_number(speed=contact.speed_a, half_width=half_width, body=a),
        peclet_b=peclet_number(speed=contact.speed_b, half_width=half_width, body=b),
    )
