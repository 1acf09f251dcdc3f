"""Line contacts with oil between them, and one of them in units of its own."""

from __future__ import annotations

from typing import Final

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.hertz import line_half_width, line_pressure
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line_grid import LineGrid, parabola_minimum, restricted
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.texture import Smooth, Texture
from pitchpoint.lubrication.film_thickness import moes_1992
from pitchpoint.materials._leaves import float64_array
from pitchpoint.materials.fluid import Fluid

__all__ = ["SLOWEST", "LineContact", "LineProblem", "length_of", "problem_of"]

SLOWEST: Final = 1e-9
"""Least unit of speed [m/s], for contacts that stand still."""

SUMMITS: Final = 4.0
"""Gap over Rq up to which asperities are counted when the length of a contact is chosen."""

INLETS: Final = 4.0
"""Square of the length of a contact between rigid bodies, over radius and film."""

LEAST: Final = 0.1
"""Gap of smooth surfaces over its guess below which no solution has it; a trial may."""

NEAR: Final = 1.5
"""Half-widths from the middle of a dry contact within which a smallest film is looked for."""

FLOODED: Final = 1e9
"""Distance at which oil begins where there is enough of it [m]."""


class LineContact(eqx.Module):
    """Line contacts `*b` between two bodies with oil between them.

    Args:
        line_load: normal load per length of contact line w [N/m].
        radius: relative radius of curvature R [m].
        modulus: E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members.
        speed_a: surface speed of member 0 relative to the contact [m/s].
        speed_b: surface speed of member 1 relative to the contact [m/s].
        approach: speed at which the bodies approach each other [m/s].
        fluid: the oil.
        texture: of the surfaces; None for smooth ones.
        inlet: distance from the middle of the contact at which oil begins to fill the gap [m]; a short one
            starves the contact.
        conduction: of heat, for the temperature of film and surfaces; None for isothermal films.
        heights: profiles of the surfaces, maps that are the same all along the line and stay where they are,
            with x from the middle of each contact towards positive speeds; the same for all contacts.
    """

    line_load: Float[Arrays, "..."]
    radius: Float[Arrays, "..."]
    modulus: Float[Arrays, "..."]
    speed_a: Float[Arrays, "..."]
    speed_b: Float[Arrays, "..."]
    approach: Float[Arrays, "..."]
    inlet: Float[Arrays, "..."]
    fluid: Fluid
    texture: Texture | None
    conduction: Conduction | None
    heights: tuple[HeightMap, ...]

    def __init__(
        self,
        *,
        line_load: ArrayLike,
        radius: ArrayLike,
        modulus: ArrayLike,
        speed_a: ArrayLike,
        speed_b: ArrayLike,
        fluid: Fluid,
        approach: ArrayLike = 0.0,
        texture: Texture | None = None,
        inlet: ArrayLike = FLOODED,
        conduction: Conduction | None = None,
        heights: tuple[HeightMap, ...] = (),
    ) -> None:
        self.line_load, self.radius = float64_array(line_load), float64_array(radius)
        self.modulus = float64_array(modulus)
        self.speed_a, self.speed_b = float64_array(speed_a), float64_array(speed_b)
        self.approach, self.inlet = float64_array(approach), float64_array(inlet)
        self.fluid, self.texture, self.conduction = fluid, texture, conduction
        self.heights = heights

    @property
    def entrainment(self) -> Float[Arrays, "..."]:
        """Mean of the surface speeds, with its sign [m/s]."""
        return 0.5 * (self.speed_a + self.speed_b)

    @property
    def half_width(self) -> Float[Arrays, "..."]:
        """Half-width b of the dry contact [m]."""
        return line_half_width(line_load=self.line_load, radius=self.radius, modulus=self.modulus)

    @property
    def hertz_pressure(self) -> Float[Arrays, "..."]:
        """Largest pressure of the dry contact [Pa]."""
        return line_pressure(line_load=self.line_load, radius=self.radius, modulus=self.modulus)


class LineProblem(eqx.Module):
    """One line contact in units of its own.

    Attributes:
        flow: of the oil.
        yielding: b/L, the deflection by a pressure of one over a length of one, times pi.
        load: over pressure and length.
        film: guess of it, for a start.
        speed: unit of speed [m/s].
        inlet: distance from the middle from which on there is oil.
        lowered: by how much less heights make the gap in each cell of the finest grid, shape (node,); zero
            for even surfaces.
    """

    flow: Flow
    yielding: Float[Arrays, ""]
    load: Float[Arrays, ""]
    film: Float[Arrays, ""]
    speed: Float[Arrays, ""]
    inlet: Float[Arrays, ""]
    lowered: Float[Arrays, "..."]

    def gap(self, pressure: Array, level: Array, at: LineGrid) -> Array:
        """Gap of the mean planes at every node, shape (node,)."""
        lowered = self.lowered
        while lowered.shape > at.x.shape:
            lowered = restricted(lowered)
        return level + 0.5 * at.x**2 - lowered + self.yielding * (at.kernel @ pressure)

    def films(self, pressure: Array, level: Array, at: LineGrid) -> Array:
        """Gap of the mean planes at the middle node, the smallest and the mean one, shape (3,)."""
        gap = self.gap(pressure, level, at)
        _, least = parabola_minimum(at.x, gap, self._narrowest(gap, at))
        return jnp.stack([gap[at.middle], least, self.mean_film(pressure, level, at)])

    def opening(self, gap: Array, at: LineGrid) -> Array:
        """Half of what a gap opens from its narrowest node to both neighbours."""
        node = jnp.clip(self._narrowest(gap, at), 1, gap.shape[0] - 2)
        return 0.5 * (gap[node - 1] + gap[node + 1]) - gap[node]

    def _narrowest(self, gap: Array, at: LineGrid) -> Array:
        """Node of the smallest gap near the contact."""
        near = jnp.abs(at.x) < NEAR / self.yielding
        return jnp.argmin(jnp.where(near, gap, jnp.inf))

    def mean_film(self, pressure: Array, level: Array, at: LineGrid) -> Array:
        """Mean gap of the mean planes over the dry contact, of the lines between the nodes."""
        film, half_width = self.gap(pressure, level, at), self.yielding
        low, high = (jnp.clip(x, -half_width, half_width) for x in (at.x[:-1], at.x[1:]))
        middle = 0.5 * (low + high)
        share = (middle - at.x[:-1]) / at.spacing
        lines = film[:-1] + share * jnp.diff(film)
        return jnp.sum(lines * (high - low)) / (2.0 * half_width)

    def carrying(self, pressure: Array, gap: Array, at: LineGrid) -> tuple[Array, Array]:
        """Pressure of a shape that carries the load, and the level for a gap in the middle."""
        carries = pressure * self.load / (at.widths @ pressure)
        return carries, gap - self.gap(carries, jnp.zeros(()), at)[at.middle]

    def wet(self, at: LineGrid) -> Array:
        """Whether there is oil at each inner node, shape (node - 2,)."""
        half_way = 0.5 * (at.x[1:-1] + at.x[2:])
        wet: Array = half_way > -self.inlet
        return wet

    def at_speed(self, factor: Array) -> LineProblem:
        """The same contact at another speed."""
        changed: LineProblem = eqx.tree_at(
            lambda tree: tree.flow.resistance, self, self.flow.resistance * factor
        )
        return changed


def problem_of(contact: LineContact, at: LineGrid) -> LineProblem:
    """One contact in units of its own length, pressure and speed.

    Args:
        contact: one.
        at: the finest grid on which it is solved.
    """
    half_width, pressure = contact.half_width, contact.hertz_pressure
    speed = jnp.abs(contact.entrainment)
    unit = jnp.maximum(speed + jnp.abs(contact.approach) * contact.radius / half_width, SLOWEST)
    film = guess(contact)
    ratio = _longer(contact, film)
    length = half_width * ratio
    height = length**2 / contact.radius
    fluid = contact.fluid
    flow = Flow(
        fluid,
        contact.texture or Smooth(LEAST * film),
        pressure,
        height,
        12.0 * fluid.viscosity * unit * contact.radius**2 / (length**3 * pressure),
        speed / unit,
        contact.approach * contact.radius / (length * unit),
        jnp.zeros(()),
    )
    return LineProblem(
        flow,
        1.0 / ratio,
        0.5 * jnp.pi / ratio,
        film / height,
        unit,
        contact.inlet / length,
        _lowered(contact, at, length) / height,
    )


def _longer(contact: LineContact, film: Array) -> Array:
    """Length over which a contact carries, over that of the dry one: thick films and asperities add to it."""
    rough = 0.0 if contact.texture is None else contact.texture.rq
    beyond = contact.radius * (INLETS * film + SUMMITS * rough) / contact.half_width**2
    return jnp.sqrt(1.0 + beyond)


def length_of(contact: LineContact) -> Float[Array, "*b"]:
    """Unit of length of contacts [m]."""
    return contact.half_width * _longer(contact, guess(contact))


def _lowered(contact: LineContact, at: LineGrid, length: Array) -> Array:
    """By how much less heights make the gap in each cell, shape (node,); zero without any [m]."""
    if not contact.heights:
        return jnp.zeros(())
    # Grids follow the entrainment. Means between edges that fall are those between edges that rise.
    turned = jnp.where(contact.entrainment < 0.0, -length, length)
    beside = length * jnp.array([-1.0, 1.0])
    return sum(
        (height_map.over(turned * at.edges, beside)[0] for height_map in contact.heights),
        jnp.zeros(()),
    )


def guess(contact: LineContact) -> Array:
    """Film in the middle that a regression gives [m].

    An approach counts as the speed that would give rigid bodies with an oil that pressure does not thicken
    the same film, (3 pi sqrt(2) eta V R^(3/2)/w)^(2/3) for the one and 6 eta u R/w for the other.

    Source: Moes (1992), see `moes_1992`.
    """
    load, oil, radius = contact.line_load, contact.fluid.viscosity, contact.radius
    closes = contact.approach > 0.0
    closing = jnp.where(closes, contact.approach, 1.0)
    alone = (3.0 * jnp.pi * jnp.sqrt(2.0) * oil * closing * radius**1.5 / load) ** (2.0 / 3.0)
    squeezed = jnp.where(closes, alone, 0.0)
    speed = jnp.abs(contact.entrainment) + squeezed * load / (6.0 * oil * radius)
    return moes_1992(
        line_load=contact.line_load,
        entrainment=jnp.maximum(speed, SLOWEST),
        viscosity=contact.fluid.viscosity,
        pressure_viscosity=contact.fluid.pressure_viscosity,
        radius=contact.radius,
        modulus=contact.modulus,
    )
