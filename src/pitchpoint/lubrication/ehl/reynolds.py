"""Reynolds' equation across a line contact: the balance of every cell and its derivatives."""

from typing import NamedTuple

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.line_grid import Along, LineGrid
from pitchpoint.lubrication.ehl.texture import Texture
from pitchpoint.materials.fluid import Fluid

__all__ = ["REACH", "Flow", "NodeBalance", "at_faces", "banded", "third_order", "upwind"]

REACH = 4
"""Nodes on which the balance of a cell depends: two before it, its own, one behind it."""

Nodes = Float[Arrays, " node"]
Places = Float[Arrays, "*place"]


class Flow(eqx.Module):
    """What flows through a contact, in units of its length L, pressure and L^2/R, for gaps.

    Attributes:
        fluid: the oil.
        texture: of the surfaces.
        pressure: unit of pressure [Pa].
        height: unit of gaps [m].
        resistance: 12 eta0 u R^2/(L^3 p), u the unit of speed.
        entrainment: mean speed of the surfaces over the unit of speed, 0 or 1 for the usual one.
        approach: of the surfaces to each other over unit of speed times L/R.
        temperature_rise: of the film above the inlet, of one number or shape (node,) [K].

    Source: Reynolds (1886), with the mass that pressure and surfaces move through a gap.
    """

    fluid: Fluid
    texture: Texture
    pressure: Float[Arrays, ""]
    height: Float[Arrays, ""]
    resistance: Float[Arrays, ""]
    entrainment: Float[Arrays, ""]
    approach: Float[Arrays, ""]
    temperature_rise: Float[Arrays, "..."]

    def room(self, gap: Places) -> Places:
        """Mean gap that is open to the oil."""
        return self.texture.room(gap * self.height) / self.height

    def asperity_pressure(self, gap: Places) -> Places:
        """Pressure that asperities carry."""
        return self.texture.pressure(gap * self.height) / self.pressure

    def balance(self, film_pressure: Nodes, gap: Nodes, at: LineGrid) -> tuple[Array, Array]:
        """What flows into each inner cell more than out of it, and what a pressure of one there takes out.

        Flow by pressure: its conductance at a face is the geometric mean of those beside it ahead of the
        middle, where the viscosity rises steeply, and the arithmetic one behind, where the film ends. Flow
        that the surfaces draw along: upwind of third order.

        Args:
            film_pressure: of the oil, shape (node,).
            gap: of the mean planes, shape (node,).
            at: the grid.

        Returns:
            Both of shape (node - 2,).
        """
        mass, conductance = self.mass_and_conductance(film_pressure, gap, at)
        net = conductance * jnp.diff(film_pressure) - self.entrainment * upwind(mass)
        density = self.density(film_pressure)[1:-1]
        # Positive where oil comes in: convergent gaps and surfaces that approach raise the pressure.
        gain = jnp.diff(net) + self.approach * density * at.widths[1:-1]
        return gain, conductance[1:] + conductance[:-1]

    def density(self, film_pressure: Places, temperature_rise: Array | None = None) -> Places:
        """Density over that of the inlet, at the temperature of the film unless another is given."""
        pressure = jnp.maximum(film_pressure, 0.0) * self.pressure
        warmth = self.temperature_rise if temperature_rise is None else temperature_rise
        return self.fluid.density_ratio(pressure, warmth)

    def mass_and_conductance(
        self, film_pressure: Nodes, gap: Nodes, at: Along
    ) -> tuple[Array, Array]:
        """Mass under each node, and flow through each face for a fall of pressure of one."""
        mass, yields = self.mass_and_ease(film_pressure, gap)
        return mass, at_faces(yields, at.ahead) / at.spacing

    def mass_and_ease(self, film_pressure: Places, gap: Places) -> tuple[Places, Places]:
        """Mass under each place, and flow along a slope of the pressure of one."""
        pressure = jnp.maximum(film_pressure, 0.0) * self.pressure
        room = self.room(gap)
        thicker = self.fluid.viscosity_at(pressure, self.temperature_rise) / self.fluid.viscosity
        mass = self.density(film_pressure) * room
        open_ = self.texture.flow_factor(gap * self.height)
        return mass, open_ * mass * room**2 / (thicker * self.resistance)


def at_faces(values: Float[Arrays, "node *row"], ahead: Bool[Arrays, "face *#row"]) -> Array:
    """Mean of neighbours: geometric ahead of the middle, arithmetic behind; of positive values."""
    before, behind = values[:-1], values[1:]
    product = jnp.maximum(before * behind, 1e-300)
    return jnp.where(ahead, jnp.sqrt(product), 0.5 * (before + behind))


def upwind(values: Float[Arrays, "node *row"]) -> Array:
    """Values at the faces from the nodes around them, two of them on the side where the flow comes from."""
    padded = jnp.concatenate((values[:1], values))
    return third_order(padded[:-2], padded[1:-1], padded[2:])


def third_order(before: Places, here: Places, behind: Places) -> Places:
    """Value at the face behind a node, of the parabola through its mean and those beside it.

    From the parabola that has the means of three cells.
    """
    return (2.0 * behind + 5.0 * here - before) / 6.0


class NodeBalance(NamedTuple):
    """Balance of the inner cells with its derivatives, for REACH nodes from two before to one behind.

    Source: Reynolds (1886), see `Flow`.
    """

    gain: Float[Array, " inner"]
    own: Float[Array, " inner"]
    by_pressure: Float[Array, "reach inner"]
    by_gap: Float[Array, "reach inner"]


def banded(flow: Flow, film_pressure: Nodes, gap: Nodes, at: LineGrid) -> NodeBalance:
    """Balance of every cell, and its derivatives to pressure and gap at the nodes that it knows.

    Nodes that no cell knows together are moved together: four directions find a whole band matrix.

    Source: Reynolds (1886), see `Flow`; derivatives by automatic differentiation.
    """
    gain, by, diagonal = jax.linearize(
        lambda pressure, height: flow.balance(pressure, height, at),
        film_pressure,
        gap,
        has_aux=True,
    )
    nodes = film_pressure.shape[0]
    colour = jnp.arange(nodes) % REACH == jnp.arange(REACH)[:, None]
    moved, still = colour.astype(gain.dtype), jnp.zeros(nodes)
    pressure = jax.vmap(lambda direction: by(direction, still))(moved)
    height = jax.vmap(lambda direction: by(still, direction))(moved)
    inner = jnp.arange(1, nodes - 1)
    which = (inner - 2 + jnp.arange(REACH)[:, None]) % REACH, inner - 1
    return NodeBalance(gain, diagonal, pressure[which], height[which])
