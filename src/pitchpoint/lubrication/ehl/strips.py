"""Heat of a strip along the motion of its surfaces: how its temperatures follow from that, and settle."""

from __future__ import annotations

from typing import Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line import SLOWEST
from pitchpoint.lubrication.ehl.line_grid import Along
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.work import fractional_film_content, pressure_flow, shear_stress
from pitchpoint.lubrication.flash_temperature import Conductor, moving_strip

__all__ = [
    "LEAST_RISE",
    "MOST_TURNS",
    "NEAR",
    "REMEMBERED",
    "STEADY",
    "WARM_ENOUGH",
    "PassingSurfaces",
    "Past",
    "Spread",
    "Strip",
    "Surfaces",
    "anderson_rise",
    "by_heat",
    "change_of",
    "cold_past",
    "line_temperature_rise",
    "of_surfaces",
    "spread_of",
    "surface_passages",
    "warmer_flow",
]

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


class Spread(NamedTuple):
    """How temperatures follow from heat per area at every node of a strip.

    Across the film k T'' = -q/h with the temperatures of the surfaces at its ends, so that half of q and
    k (Tb - Ta)/h go into a, and the mean is that of the surfaces and q h/(12 k).

    Attributes:
        strip_a: rise of surface a by heat per area into it, shape (node, node) [K m2/W].
        strip_b: of surface b.
        across: heat from surface b to a by their difference k/h, shape (node,) [W/m2/K].

    From Fourier's law across the film, with even heat over its thickness.
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
        flux: Array = 0.5 * heat + (self.across * apart.T).T
        return flux

    def of_surfaces(self, heat: Array) -> Array:
        """Mean rise of both surfaces by some heat that is made, shape (node, ...) [K]."""
        into_a = self.into_a(heat)
        rise: Array = 0.5 * (self.strip_a @ into_a + self.strip_b @ (heat - into_a))
        return rise


class PassingSurfaces(NamedTuple):
    """Surfaces that pass the cells of a strip in either sense, see `moving_strip`.

    Attributes:
        along: towards larger x, shape (node, node), root of the unit of length.
        against: towards smaller x.

    Source: Jaeger (1942), see `moving_strip`.
    """

    along: Float[Array, "node node"]
    against: Float[Array, "node node"]


def surface_passages(x: Float[Arrays, " node"], edges: Float[Arrays, " edge"]) -> PassingSurfaces:
    """Surfaces that pass cells with such edges, in units of length."""
    against = moving_strip(-x[::-1], -edges[::-1])
    return PassingSurfaces(moving_strip(x, edges), against[::-1, ::-1])


def spread_of(
    given: Conduction,
    speeds: tuple[Array, Array],
    length: Array,
    film: Array,
    passes: PassingSurfaces,
) -> Spread:
    """How temperatures follow from heat in one strip.

    Args:
        given: what conducts the heat.
        speeds: of both surfaces along x [m/s].
        length: unit of length [m].
        film: that is open to the oil, shape (node,) [m].
        passes: surfaces that pass its cells.
    """
    strips = [
        _warms(body, speed, length, passes)
        for body, speed in zip((given.a, given.b), speeds, strict=True)
    ]
    return Spread(strips[0], strips[1], given.oil_conductivity / film)


def _warms(body: Conductor, speed: Array, length: Array, passes: PassingSurfaces) -> Array:
    """Rise of a surface by heat per area into it, shape (node, node) [K m2/W]."""
    passed = jnp.where(speed >= 0.0, passes.along, passes.against)
    fast = jnp.maximum(jnp.abs(speed), SLOWEST)
    return passed * jnp.sqrt(length / (jnp.pi * fast)) / body.effusivity


class Strip(NamedTuple):
    """What pressure and level give in a strip, which heat is made of.

    Attributes:
        oil: pressure of the oil, shape (node,).
        gap: of the mean planes.
        room: mean gap that is open to the oil.
        asperities: pressure that they carry.
        beside: heat per area by flow to the strips beside it, shape (node,) or () [W/m2].
        sliding: of the surfaces against each other [m/s].
        length: unit of length [m].
        power: unit of power per width of the strip [W/m].
        spread: how temperatures follow from heat.
    """

    oil: Array
    gap: Array
    room: Array
    asperities: Array
    beside: Array
    sliding: Array
    length: Array
    power: Array
    spread: Spread


def warmer_flow(flow: Flow, rise: Array) -> Flow:
    """The flow of a film that is so much warmer than its inlet [K]."""
    warm: Flow = eqx.tree_at(lambda tree: tree.temperature_rise, flow, rise)
    return warm


def _made(flow: Flow, strip: Strip, moved: Array, at: Along) -> tuple[Array, Array]:
    """Heat per area that the film makes at each node, and the asperities, where mass is moved as given."""
    sliding = strip.sliding
    stress = shear_stress(flow, strip.oil, strip.room, sliding)
    shear = fractional_film_content(flow, strip.oil, strip.room) * stress * sliding
    # Half of what a face makes belongs to each of the nodes beside it.
    pumping = 0.5 * moved**2 * pressure_flow(flow, strip.oil, strip.gap, at)[1]
    pumping = jnp.append(pumping, 0.0) + jnp.append(0.0, pumping)
    pumped = pumping * strip.power / (at.widths * strip.length)
    rubbed = flow.texture.boundary_friction * strip.asperities * flow.pressure
    return shear + pumped + strip.beside, rubbed * jnp.abs(sliding)


def line_temperature_rise(flow: Flow, strip: Strip, at: Along) -> Array:
    """Rise of the film at a pressure, by Newton's method from that of the flow, shape (node,) [K].

    The mass that pressure moves is held instead of the slope of the pressure: the heat of a flow that is held
    falls as the oil becomes warmer, that of a slope that is held rises without bound.
    """
    moved, _ = pressure_flow(flow, strip.oil, strip.gap, at)
    mean, none = strip.spread.mean, jnp.eye(strip.oil.shape[0])
    total = mean + jnp.diag(strip.spread.within)

    def made(rise: Array) -> tuple[Array, tuple[Array, Array]]:
        film, rubbed = _made(warmer_flow(flow, rise), strip, moved, at)
        return film, (film, rubbed)

    def onward(iterate: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        rise, _, steps = iterate
        by_rise, (film, rubbed) = jax.jacfwd(made, has_aux=True)(rise)
        off = rise - total @ film - mean @ rubbed
        better = jnp.maximum(rise - jnp.linalg.solve(none - total @ by_rise, off), 0.0)
        return better, change_of(rise, better), steps + 1

    def unfinished(iterate: tuple[Array, Array, Array]) -> Array:
        _, change, steps = iterate
        return (change > 0.1 * STEADY) & (steps < MOST_STEPS)

    begin = flow.temperature_rise, jnp.asarray(jnp.inf), jnp.asarray(0)
    rise: Array = jax.lax.while_loop(unfinished, onward, begin)[0]
    return rise


def by_heat(flow: Flow, strip: Strip, at: Along) -> tuple[Array, Array]:
    """Rise of the film that its heat makes, each of shape (node,) [K], and that heat per area [W/m2]."""
    moved, _ = pressure_flow(flow, strip.oil, strip.gap, at)
    film, rubbed = _made(flow, strip, moved, at)
    rise = strip.spread.of_surfaces(film + rubbed) + strip.spread.within * film
    return rise, film + rubbed


class Surfaces(NamedTuple):
    """Heat into both surfaces of a strip [W/m2], and their rises [K], each of shape (node,)."""

    flux_a: Array
    flux_b: Array
    surface_a: Array
    surface_b: Array


def of_surfaces(spread: Spread, heat: Array) -> Surfaces:
    """Surfaces of a strip in which so much heat is made, shape (node,) [W/m2]."""
    into_a = spread.into_a(heat)
    into_b = heat - into_a
    return Surfaces(into_a, into_b, spread.strip_a @ into_a, spread.strip_b @ into_b)


# ---- turns between pressure and temperature


class Past(NamedTuple):
    """Last turn of the temperature, and how the turns before it differed from each other.

    Attributes:
        found: rise that the turn found, shape (node,) [K].
        moved: by how much that differed from what it began with, shape (node,) [K].
        all_found: differences between turns, shape (REMEMBERED, node) [K].
        all_moved: of the same turns.

    Source: Anderson (1965), see `anderson_rise`.
    """

    found: Float[Array, " node"]
    moved: Float[Array, " node"]
    all_found: Float[Array, "turn node"]
    all_moved: Float[Array, "turn node"]


def cold_past(nodes: int) -> Past:
    """No turn yet, for rises of so many nodes."""
    cold, none = array(np.zeros(nodes)), array(np.zeros((REMEMBERED, nodes)))
    return Past(cold, cold, none, none)


def change_of(begun: Array, found: Array) -> Array:
    """Largest change between two rises of the film over the largest rise."""
    return jnp.max(jnp.abs(found - begun)) / (jnp.max(found) + LEAST_RISE)


def anderson_rise(past: Past, begun: Array, found: Array, known: Array) -> tuple[Array, Past]:
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
