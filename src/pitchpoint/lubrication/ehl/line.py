"""Line contacts with oil between them, and one of them in units of its own."""

from __future__ import annotations

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.hertz import line_half_width, line_pressure
from pitchpoint.factored import Arrays
from pitchpoint.lubrication.ehl.grid import Grid
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.texture import Smooth, Texture
from pitchpoint.materials._leaves import as_array
from pitchpoint.materials.fluid import Fluid

__all__ = ["LineContact", "Problem", "problem_of"]

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
    """

    line_load: Float[Array, "..."]
    radius: Float[Array, "..."]
    modulus: Float[Array, "..."]
    speed_a: Float[Array, "..."]
    speed_b: Float[Array, "..."]
    approach: Float[Array, "..."]
    fluid: Fluid
    texture: Texture | None

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
    ) -> None:
        self.line_load, self.radius = as_array(line_load), as_array(radius)
        self.modulus = as_array(modulus)
        self.speed_a, self.speed_b = as_array(speed_a), as_array(speed_b)
        self.approach = as_array(approach)
        self.fluid, self.texture = fluid, texture

    @property
    def entrainment(self) -> Float[Array, "..."]:
        """Mean of the surface speeds, with its sign [m/s]."""
        return 0.5 * (self.speed_a + self.speed_b)

    @property
    def half_width(self) -> Float[Array, "..."]:
        """Half-width b of the dry contact [m]."""
        return line_half_width(line_load=self.line_load, radius=self.radius, modulus=self.modulus)

    @property
    def hertz_pressure(self) -> Float[Array, "..."]:
        """Largest pressure of the dry contact [Pa]."""
        return line_pressure(line_load=self.line_load, radius=self.radius, modulus=self.modulus)


class Problem(eqx.Module):
    """One line contact in units of its own.

    Attributes:
        flow: of the oil.
        yielding: b/L, the deflection by a pressure of one over a length of one, times pi.
        load: over pressure and length.
        film: guess of it, for a start.
    """

    flow: Flow
    yielding: Float[Arrays, ""]
    load: Float[Arrays, ""]
    film: Float[Arrays, ""]

    def gap(self, pressure: Array, level: Array, at: Grid) -> Array:
        """Gap of the mean planes at every node, shape (node,)."""
        return level + 0.5 * at.x**2 + self.yielding * (at.kernel @ pressure)

    def at_speed(self, factor: Array) -> Problem:
        """The same contact at another speed."""
        return eqx.tree_at(lambda one: one.flow.resistance, self, self.flow.resistance * factor)


def problem_of(contact: LineContact, nodes: int) -> Problem:
    """One contact in units of its own length, pressure and speed."""
    half_width, pressure = contact.half_width, contact.hertz_pressure
    approach = jnp.maximum(contact.approach, 0.0)
    speed = jnp.abs(contact.entrainment)
    unit = jnp.maximum(speed + approach * contact.radius / half_width, 1e-9)
    film = guess(contact, unit)
    ratio = jax.lax.stop_gradient(jnp.sqrt(1.0 + contact.radius * film / half_width**2))
    # In steps, so that the grid keeps its places in the contact while inputs change a little.
    ratio = 2.0 ** (jnp.ceil(4.0 * jnp.log2(ratio) - 1e-9) / 4.0)
    length = half_width * ratio
    height = length**2 / contact.radius
    fluid = contact.fluid
    flow = Flow(
        fluid,
        contact.texture or Smooth(0.1 * film),
        pressure,
        height,
        12.0 * fluid.viscosity * unit * contact.radius**2 / (length**3 * pressure),
        speed / unit,
        contact.approach * contact.radius / (length * unit),
        jnp.zeros(nodes),
    )
    return Problem(flow, 1.0 / ratio, 0.5 * jnp.pi / ratio, film / height)


def guess(contact: LineContact, unit: Array) -> Array:
    speed = 2.0 * contact.fluid.viscosity * unit / (contact.modulus * contact.radius)
    M = contact.line_load / (contact.modulus * contact.radius) / jnp.sqrt(speed)
    L = contact.fluid.pressure_viscosity * contact.modulus * speed**0.25
    ri, rp, ei, ep = 3 / M, 1.287 * L ** (2 / 3), 2.621 * M**-0.2, 1.311 * M**-0.125 * L**0.75
    s = (7 + 8 * jnp.exp(-2 * ei / ri)) / 5
    h = (
        (ri ** (7 / 3) + ei ** (7 / 3)) ** (3 * s / 7) + (rp**-3.5 + ep**-3.5) ** (-2 * s / 7)
    ) ** (1 / s)
    return h * contact.radius * jnp.sqrt(speed)


