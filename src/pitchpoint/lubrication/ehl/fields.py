"""Pressure and film of line contacts, and what follows from them: films, forces, powers, shares of load."""

from __future__ import annotations

from typing import Final

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.heat import Temperatures, line_temperatures
from pitchpoint.lubrication.ehl.line import NEAR, LineContact, LineProblem
from pitchpoint.lubrication.ehl.line_grid import LineGrid, parabola_minimum
from pitchpoint.lubrication.ehl.work import fractional_film_content, shear_stress, work_of_pressure

__all__ = ["LineFilm", "line_film"]

STANDS_OUT: Final = 1e-3
"""Part of the largest pressure by which a spike is higher than the valley before it."""

Nodes = Float[Arrays, "*b node"]
Each = Float[Arrays, "*b"]


class LineFilm(eqx.Module):
    """Fields across line contacts `*b`, and what follows from them.

    Forces are those on a metre of contact line. Where a contact was not solved all of it is NaN.

    Attributes:
        x: place of the nodes, against the sense of positive surface speeds at first [m].
        pressure: that oil and asperities carry together [Pa].
        asperity_pressure: that asperities carry [Pa].
        gap: between the mean planes; negative where they overlap [m].
        film: mean gap that is open to the oil [m].
        filled: part of it that oil fills, below one where the film is broken.
        shear_stress: of the oil on member 0, half way between the surfaces [Pa].
        central_film: gap of the mean planes in the middle of the contact [m].
        minimum_film: smallest gap [m].
        minimum_place: its place [m].
        mean_film: mean gap over the width of the dry contact [m].
        largest_pressure: [Pa].
        spike_pressure: second, local maximum of the pressure, ahead of the end of the film where the oil
            thickens; that of a parabola through three nodes. Few nodes resolve it, so that it changes with
            their number, by a quarter from 65 to 513 of them. Not a number where the pressure has one maximum
            alone, or where the second one stands out by less than a thousandth of the largest pressure [Pa].
        spike_place: its place [m].
        asperity_share: part of the load that asperities carry.
        rolling: resistance to rolling, which the oil in the inlet does to each surface [N/m].
        shear_force: shear of the oil on member 0, along positive speeds; minus that on member 1 [N/m].
        boundary_force: friction of asperities on member 0, in the same way [N/m].
        friction: of oil and asperities together over the load, without rolling resistance.
        film_ratio: smallest gap over the composite Rq; infinite between smooth surfaces.
        stiffness: -dw/dh of the load on a metre of contact line by the mean film, whose width grows with the
            load; speeds, approach and oil are held, and its temperature where it is solved for. It is that
            of the film on its grid, and wavers about that on fine ones as a spike passes the nodes, by some
            8 % on 129 nodes, 4 % on 257. Light loads hardly change a film: there it is large, of either
            sign [N/m2].
        damping: dw/dV of that load by the speed V at which the surfaces approach, with the mean film held and
            all else as for the stiffness. Not a number where surfaces stand still on their asperities
            [N s/m2].
        pumping_power: that the flow under pressure turns into heat [W/m].
        half_width: of the dry contact [m].
        hertz_pressure: largest one of the dry contact [Pa].
        heat: temperatures, where they were solved for; None of isothermal films.
    """

    x: Nodes
    pressure: Nodes
    asperity_pressure: Nodes
    gap: Nodes
    film: Nodes
    filled: Nodes
    shear_stress: Nodes
    central_film: Each
    minimum_film: Each
    minimum_place: Each
    mean_film: Each
    largest_pressure: Each
    spike_pressure: Each
    spike_place: Each
    asperity_share: Each
    rolling: Each
    shear_force: Each
    boundary_force: Each
    friction: Each
    film_ratio: Each
    stiffness: Each
    damping: Each
    pumping_power: Each
    half_width: Each
    hertz_pressure: Each
    heat: Temperatures | None

    @property
    def traction_a(self) -> Each:
        """Force on member 0 along positive speeds: shear, asperities and rolling resistance [N/m]."""
        return self.shear_force + self.boundary_force - self.rolling

    @property
    def traction_b(self) -> Each:
        """Force on member 1 along positive speeds [N/m]."""
        return -self.shear_force - self.boundary_force - self.rolling


def line_film(
    contact: LineContact,
    problem: LineProblem,
    pressure: Array,
    level: Array,
    response: tuple[Array, Array],
    at: LineGrid,
) -> LineFilm:
    """Fields of one contact from a solution in its own units.

    Args:
        contact: one.
        problem: the same in units of its own.
        pressure: of the nodes, shape (node,).
        level: of the surfaces.
        response: stiffness and damping of the film [N/m2] and [N s/m2].
        at: the grid.
    """
    flow, length = problem.flow, contact.half_width / problem.yielding
    gap = problem.gap(pressure, level, at)
    asperities = flow.asperity_pressure(gap)
    oil = pressure - asperities
    room = flow.room(gap)
    sliding = contact.speed_b - contact.speed_a
    full = fractional_film_content(flow, oil, room)
    stress = full * shear_stress(flow, oil, room, sliding)
    carried = jnp.sum(at.widths * asperities) / problem.load
    place, least = _minimum(at.x, gap, jnp.abs(at.x) < NEAR / problem.yielding)
    spike_place, spike = _spike(at.x, pressure)
    sheared = jnp.sum(stress * at.widths) * length
    rubbed = flow.texture.boundary_friction * carried * contact.line_load * jnp.sign(sliding)
    rolling, pumping = work_of_pressure(flow, oil, gap, at)
    film = LineFilm(
        x=at.x * length,
        pressure=pressure * flow.pressure,
        asperity_pressure=asperities * flow.pressure,
        gap=gap * flow.height,
        film=room * flow.height,
        filled=full,
        shear_stress=stress,
        central_film=gap[at.middle] * flow.height,
        minimum_film=least * flow.height,
        minimum_place=place * length,
        mean_film=problem.mean_film(pressure, level, at) * flow.height,
        largest_pressure=jnp.max(pressure) * flow.pressure,
        spike_pressure=spike * flow.pressure,
        spike_place=spike_place * length,
        asperity_share=carried,
        rolling=rolling * flow.pressure * flow.height,
        shear_force=sheared,
        boundary_force=rubbed,
        friction=jnp.abs(sheared + rubbed) / contact.line_load,
        film_ratio=least * flow.height / (0.0 if contact.texture is None else contact.texture.rq),
        stiffness=response[0],
        damping=response[1],
        pumping_power=pumping * flow.pressure * flow.height * problem.speed,
        half_width=contact.half_width,
        hertz_pressure=flow.pressure,
        heat=line_temperatures(contact, problem, pressure, level, at),
    )
    return _turned(film, contact.entrainment < 0.0)


def _minimum(x: Arrays, film: Array, where: Bool[Array, " node"]) -> tuple[Array, Array]:
    """Place and value of the lowest point about the lowest node."""
    return parabola_minimum(x, film, jnp.argmin(jnp.where(where, film, jnp.inf)))


def _spike(x: Arrays, pressure: Array) -> tuple[Array, Array]:
    """Place and value of the last maximum of the pressure behind the middle with a valley ahead of it."""
    before, here, after = pressure[:-2], pressure[1:-1], pressure[2:]
    inner = jnp.arange(1, x.shape[0] - 1)
    peak = jnp.max(jnp.where((here > before) & (here >= after) & (x[1:-1] > 0.0), inner, 0))
    valley = jnp.max(jnp.where((here < before) & (here < after) & (inner < peak), inner, 0))
    stands_out = pressure[peak] - pressure[valley] > STANDS_OUT * jnp.max(pressure)
    place, deepest = parabola_minimum(x, -pressure, peak)
    exists = (valley > 0) & stands_out
    return jnp.where(exists, place, jnp.nan), jnp.where(exists, -deepest, jnp.nan)


def _turned(film: LineFilm, turned: Array) -> LineFilm:
    """The other way round where the surfaces run against their positive sense."""
    mirrored = jax.tree.map(
        lambda leaf: jnp.where(turned, leaf[::-1], leaf) if leaf.ndim else leaf, film
    )
    sign = jnp.where(turned, -1.0, 1.0)
    turned_film: LineFilm = eqx.tree_at(
        lambda tree: (tree.x, tree.minimum_place, tree.spike_place, tree.rolling),
        mirrored,
        replace_fn=lambda v: sign * v,
    )
    return turned_film
