"""Heat of line contacts: temperatures of film and surfaces in balance with the pressure."""

from __future__ import annotations

from typing import NamedTuple

import equinox as eqx
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import LineContact, LineProblem
from pitchpoint.lubrication.ehl.line_grid import LineGrid
from pitchpoint.lubrication.ehl.newton import ENOUGH, LineIterate, newton_on_line, residual
from pitchpoint.lubrication.ehl.strips import (
    MOST_TURNS,
    NEAR,
    STEADY,
    Past,
    Strip,
    anderson_rise,
    by_heat,
    change_of,
    cold_past,
    line_temperature_rise,
    of_surfaces,
    spread_of,
    surface_passages,
    warmer_flow,
)
from pitchpoint.lubrication.ehl.work import work_of_expansion
from pitchpoint.lubrication.flash_temperature import peclet_number

__all__ = [
    "Temperatures",
    "Warm",
    "alternating_solution",
    "line_heat_defect",
    "line_temperatures",
    "polished_warm_line",
    "warmed_line",
]

Nodes = Float[Arrays, "*b node"]
Each = Float[Arrays, "*b"]


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


def _forward(contact: LineContact) -> tuple[Array, Array]:
    """Speeds of both surfaces along the grid, which follows the entrainment [m/s]."""
    sign = jnp.where(contact.entrainment < 0.0, -1.0, 1.0)
    return sign * contact.speed_a, sign * contact.speed_b


def _conduction(contact: LineContact) -> Conduction:
    assert contact.conduction is not None
    return contact.conduction


def _strip(
    contact: LineContact, problem: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> Strip:
    """What heat is made of at a pressure."""
    flow = problem.flow
    gap = problem.gap(pressure, level, at)
    asperities, room = flow.asperity_pressure(gap), flow.room(gap)
    length = contact.half_width / problem.yielding
    speeds, passes = _forward(contact), surface_passages(at.x, at.edges)
    spread = spread_of(_conduction(contact), speeds, length, room * flow.height, passes)
    none, sliding = jnp.zeros(()), contact.speed_b - contact.speed_a
    fields = pressure - asperities, gap, room, asperities, none, sliding
    return Strip(*fields, length, _power(problem), spread)


def _power(problem: LineProblem) -> Array:
    """Unit of power per length of contact line [W/m]."""
    return problem.flow.pressure * problem.flow.height * problem.speed


def warmed_line(problem: LineProblem, rise: Array) -> LineProblem:
    """The contact with a film that is so much warmer than its inlet, shape (node,) [K]."""
    warm: LineProblem = eqx.tree_at(
        lambda tree: tree.flow, problem, warmer_flow(problem.flow, rise)
    )
    return warm


class Warm(NamedTuple):
    """Where pressure and temperature of a contact stand.

    Attributes:
        state: of the pressure.
        rise: of the film above its inlet, shape (node,) [K].
        change: of the rise in the last turn over the largest rise.
        turns: between pressure and temperature.
        total: steps of Newton's method for the pressure.
    """

    state: LineIterate
    rise: Float[Array, " node"]
    change: Float[Array, ""]
    turns: Int[Array, ""]
    total: Int[Array, ""]
    past: Past


def alternating_solution(
    contact: LineContact, problem: LineProblem, state: LineIterate, at: LineGrid
) -> Warm:
    """Pressure and temperature in turns, from the isothermal solution or any other pressure."""

    def onward(warm: Warm) -> Warm:
        so_warm = warmed_line(problem, warm.rise)
        state = newton_on_line(so_warm, warm.state.pressure, warm.state.level, at)
        strip = _strip(contact, so_warm, state.pressure, state.level, at)
        rise = line_temperature_rise(so_warm.flow, strip, at)
        change = change_of(warm.rise, rise)
        near = (change < NEAR) & (warm.change < NEAR)
        quicker, past = anderson_rise(warm.past, warm.rise, rise, near)
        rise = jnp.where(near & (change > STEADY), quicker, rise)
        return Warm(state, rise, change, warm.turns + 1, warm.total + state.total, past)

    def unfinished(warm: Warm) -> Array:
        lost = (warm.turns > 0) & ~(warm.state.residual < ENOUGH)
        return ~(warm.change < STEADY) & (warm.turns < MOST_TURNS) & ~lost

    cold = jnp.zeros_like(at.x)
    begin = Warm(
        state, cold, jnp.asarray(jnp.inf), jnp.asarray(0), state.total, cold_past(at.x.shape[0])
    )
    end: Warm = jax.lax.while_loop(unfinished, onward, begin)
    return end


def polished_warm_line(
    contact: LineContact, problem: LineProblem, warm: Warm, at: LineGrid
) -> tuple[LineProblem, Array, Array]:
    """Contact as warm as it is, pressure and level, with their derivatives to all that it is made of.

    A last step of pressure, level and temperature together carries them (implicit function theorem), with the
    cells that are full and those that are not as they are.

    Args:
        contact: one, with conduction.
        problem: the same in units of its own, as warm as its inlet.
        warm: at which the turns ended.
        at: the grid.

    From the implicit function theorem at the solution.
    """
    nodes = at.x.shape[0]

    def parts(solution: Array) -> tuple[LineProblem, Array, Array]:
        inner, level, rise = solution[: nodes - 2], solution[nodes - 2], solution[nodes - 1 :]
        return warmed_line(problem, rise), jnp.pad(inner, 1), level

    def left(contact: LineContact, problem: LineProblem, solution: Array) -> Array:
        _, pressure, level = parts(solution)
        so_warm = warmed_line(problem, solution[nodes - 1 :])
        rise, heated, *_ = _balance(contact, so_warm, pressure, level, at)
        return jnp.append(residual(so_warm, pressure, level, at), rise - heated)

    state = warm.state
    solution = jnp.concatenate((state.pressure[1:-1], state.level[None], warm.rise))
    *frozen, solution = jax.lax.stop_gradient((contact, problem, solution))
    matrix = jax.jacfwd(left, 2)(*frozen, solution)
    return parts(solution - jnp.linalg.solve(matrix, left(contact, problem, solution)))


def line_heat_defect(
    contact: LineContact, problem: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> Array:
    """Rise of the film against that by its heat, over the largest rise."""
    rise, heated, *_ = _balance(contact, problem, pressure, level, at)
    return change_of(rise, heated)


def _balance(
    contact: LineContact, problem: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> tuple[Array, Array, Array, Strip]:
    """Rise of the film, that by its heat, the heat per area, and what it is made of."""
    strip = _strip(contact, problem, pressure, level, at)
    return problem.flow.temperature_rise, *by_heat(problem.flow, strip, at), strip


def line_temperatures(
    contact: LineContact, problem: LineProblem, pressure: Array, level: Array, at: LineGrid
) -> Temperatures | None:
    """Heat and temperatures of one contact along its grid; None of an isothermal one."""
    if contact.conduction is None:
        return None
    rise, _, heat, strip = _balance(contact, problem, pressure, level, at)
    surfaces = of_surfaces(strip.spread, heat)
    cells, half_width = at.widths * strip.length, contact.half_width
    a, b = contact.conduction.a, contact.conduction.b
    expansion = work_of_expansion(problem.flow, strip.oil, strip.gap, at)
    return Temperatures(
        film=rise,
        surface_a=surfaces.surface_a,
        surface_b=surfaces.surface_b,
        flux_a=surfaces.flux_a,
        flux_b=surfaces.flux_b,
        heat=heat,
        largest_film=jnp.max(rise),
        largest_a=jnp.max(surfaces.surface_a),
        largest_b=jnp.max(surfaces.surface_b),
        power_a=cells @ surfaces.flux_a,
        power_b=cells @ surfaces.flux_b,
        expansion_power=expansion * strip.power,
        peclet_a=peclet_number(speed=contact.speed_a, half_width=half_width, body=a),
        peclet_b=peclet_number(speed=contact.speed_b, half_width=half_width, body=b),
    )
