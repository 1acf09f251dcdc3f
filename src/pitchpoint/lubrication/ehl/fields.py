"""Pressure and film of line contacts, and what follows from them: films, forces, powers, shares of load."""

from __future__ import annotations

from typing import Final

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Arrays
from pitchpoint.lubrication.ehl.grid import Grid
from pitchpoint.lubrication.ehl.line import LineContact, Problem
from pitchpoint.lubrication.ehl.reynolds import Flow, upwind

__all__ = ["LineFilm", "line_film"]

Nodes = Float[Arrays, "*b node"]
Each = Float[Arrays, "*b"]

BROKEN: Final = 1e-9
"""Pressure below which a film is broken, in units of Hertz's pressure."""

_GAUSS = np.polynomial.legendre.leggauss(8)


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
        central_film: in the middle of the contact [m].
        minimum_film: smallest one [m].
        minimum_place: its place [m].
        mean_film: mean over the width of the dry contact [m].
        largest_pressure: [Pa].
        asperity_share: part of the load that asperities carry.
        rolling: resistance to rolling, which the oil in the inlet does to each surface [N/m].
        shear_force: shear of the oil on member 0, along positive speeds; minus that on member 1 [N/m].
        boundary_force: friction of asperities on member 0, in the same way [N/m].
        pumping_power: that the flow under pressure turns into heat [W/m].
        half_width: of the dry contact [m].
        hertz_pressure: largest one of the dry contact [Pa].
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
    asperity_share: Each
    rolling: Each
    shear_force: Each
    boundary_force: Each
    pumping_power: Each
    half_width: Each
    hertz_pressure: Each

    @property
    def traction_a(self) -> Each:
        """Force on member 0 along positive speeds: shear, asperities and rolling resistance [N/m]."""
        return self.shear_force + self.boundary_force - self.rolling

    @property
    def traction_b(self) -> Each:
        """Force on member 1 along positive speeds [N/m]."""
        return -self.shear_force - self.boundary_force - self.rolling


def line_film(
    contact: LineContact, problem: Problem, pressure: Array, level: Array, at: Grid
) -> LineFilm:
    """Fields of one contact from a solution in its own units.

    Args:
        contact: one.
        problem: the same in units of its own.
        pressure: of the nodes, shape (node,).
        level: of the surfaces.
        at: the grid.
    """
    flow, length = problem.flow, contact.half_width / problem.yielding
    gap = problem.gap(pressure, level, at)
    asperities = flow.asperity_pressure(gap)
    oil = pressure - asperities
    room = flow.room(gap)
    sliding = contact.speed_b - contact.speed_a
    filled = _filled(flow, oil, room)
    stress = filled * _shear_stress(flow, oil, room, sliding)
    carried = jnp.sum(at.widths * asperities) / problem.load
    place, least = _minimum(at.x, room, jnp.abs(at.x) < 1.5 / problem.yielding)
    rolling, pumping = _work_of_pressure(flow, oil, gap, at)
    film = LineFilm(
        x=at.x * length,
        pressure=pressure * flow.pressure,
        asperity_pressure=asperities * flow.pressure,
        gap=gap * flow.height,
        film=room * flow.height,
        filled=filled,
        shear_stress=stress,
        central_film=room[jnp.argmin(jnp.abs(at.x))] * flow.height,
        minimum_film=least * flow.height,
        minimum_place=place * length,
        mean_film=_mean(at, room, problem.yielding) * flow.height,
        largest_pressure=jnp.max(pressure) * flow.pressure,
        asperity_share=carried,
        rolling=rolling * flow.pressure * flow.height,
        shear_force=jnp.sum(stress * at.widths) * length,
        boundary_force=flow.texture.boundary_friction
        * carried
        * contact.line_load
        * jnp.sign(sliding),
        pumping_power=pumping * flow.pressure * flow.height * problem.speed,
        half_width=contact.half_width,
        hertz_pressure=flow.pressure,
    )
    return _turned(film, contact.entrainment < 0.0)


def _shear_stress(flow: Flow, oil: Array, room: Array, sliding: Array) -> Array:
    """On member 0, which member 1 draws along where it is the faster one [Pa]."""
    pressure = jnp.maximum(oil, 0.0) * flow.pressure
    return flow.fluid.shear_stress(sliding / (room * flow.height), pressure, flow.temperature_rise)


def _work_of_pressure(flow: Flow, oil: Array, gap: Array, at: Grid) -> tuple[Array, Array]:
    """Half of the flow that surfaces draw along times the rise of pressure; the same of that under pressure.

    Both per volume: mass over the density between two nodes. Over a film that begins and ends without
    pressure the flow as a whole does no work, so that twice the speed times the first is the second.
    """
    mass, conductance = flow.mass_and_conductance(oil, gap, at)
    rise = jnp.diff(oil)
    volume = rise * _specific_volume(flow, oil)
    drawn = flow.entrainment * upwind(mass)
    return 0.5 * jnp.sum(drawn * volume), jnp.sum(conductance * rise * volume)


def _specific_volume(flow: Flow, oil: Array) -> Array:
    """Mean of one over the density from the pressure at a node to that at the next."""
    one, other = oil[:-1], oil[1:]
    between = [0.5 * (one + other) + 0.5 * at * (other - one) for at in _GAUSS[0]]
    weighed = [0.5 * w / flow.density(p) for w, p in zip(_GAUSS[1], between, strict=True)]
    return jnp.sum(jnp.stack(weighed), axis=0)


def _filled(flow: Flow, oil: Array, room: Array) -> Array:
    """Oil that passes the end of the film over what would fill the gap behind it, one in the film."""
    mass = flow.density(oil) * room
    place = jnp.arange(oil.shape[0])
    last = jnp.max(jnp.where(oil > BROKEN, place, 0))
    return jnp.where(place > last, jnp.minimum(mass[last] / mass, 1.0), 1.0)


def _minimum(x: Arrays, film: Array, where: Bool[Array, " node"]) -> tuple[Array, Array]:
    """Place and value of the lowest point of the parabola through the lowest node and its neighbours."""
    low = jnp.clip(jnp.argmin(jnp.where(where, film, jnp.inf)), 1, x.shape[0] - 2)
    near = low + jnp.arange(-1, 2)
    (x0, x1, x2), (h0, h1, h2) = jnp.asarray(x)[near], film[near]
    first, second = (h1 - h0) / (x1 - x0), (h2 - h1) / (x2 - x1)
    bend = (second - first) / (x2 - x0)
    level = jnp.where(bend > 0.0, bend, 1.0)
    at = jnp.clip(0.5 * (x0 + x1 - first / level), x0, x2)
    value = h0 + (at - x0) * (first + bend * (at - x1))
    return jnp.where(bend > 0.0, at, x1), jnp.where(bend > 0.0, value, h1)


def _mean(at: Grid, film: Array, half_width: Array) -> Array:
    """Mean over the dry contact: of the lines between the nodes."""
    low, high = (jnp.clip(x, -half_width, half_width) for x in (at.x[:-1], at.x[1:]))
    middle = 0.5 * (low + high)
    share = (middle - at.x[:-1]) / at.spacing
    lines = film[:-1] + share * jnp.diff(film)
    return jnp.sum(lines * (high - low)) / (2.0 * half_width)


def _turned(film: LineFilm, turned: Array) -> LineFilm:
    """The other way round where the surfaces run against their positive sense."""
    along = ("pressure", "asperity_pressure", "gap", "film", "filled", "shear_stress")
    sign = jnp.where(turned, -1.0, 1.0)
    changed = {
        name: jnp.where(turned, getattr(film, name)[::-1], getattr(film, name)) for name in along
    }
    changed |= {
        "x": jnp.where(turned, -film.x[::-1], film.x),
        "minimum_place": sign * film.minimum_place,
        "rolling": sign * film.rolling,
    }
    found: LineFilm = eqx.tree_at(
        lambda one: [getattr(one, name) for name in changed], film, list(changed.values())
    )
    return found
