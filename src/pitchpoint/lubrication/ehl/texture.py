"""What the surfaces of a contact do to its film: room for oil, resistance to its flow, load on asperities."""

import abc

import equinox as eqx
from jaxtyping import Float

from pitchpoint._jax import jnp
from pitchpoint.factored import Arrays, Numbers

__all__ = ["Smooth", "Texture"]

Each = Float[Numbers, "*#b"]


class Texture(eqx.Module):
    """Surfaces as seen across a gap between their mean planes, which may overlap."""

    @abc.abstractmethod
    def pressure(self, gap: Each) -> Each:
        """Pressure that asperities carry [Pa]."""

    @abc.abstractmethod
    def room(self, gap: Each) -> Each:
        """Mean gap that is open to the oil, positive [m]."""

    @abc.abstractmethod
    def flow_factor(self, gap: Each) -> Each:
        """Flow along the pressure gradient over that between smooth surfaces."""


class Smooth(Texture):
    """Smooth surfaces.

    Attributes:
        least: gap below which a trial counts as a smaller and smaller positive one [m]; no solution has it.
    """

    least: Float[Arrays, ""]

    def pressure(self, gap: Each) -> Each:
        return jnp.zeros_like(gap)

    def room(self, gap: Each) -> Each:
        tight = jnp.minimum(gap / self.least, 1.0)
        return jnp.where(tight < 1.0, self.least * jnp.exp(tight - 1.0), gap)

    def flow_factor(self, gap: Each) -> Each:
        return jnp.ones_like(gap)
