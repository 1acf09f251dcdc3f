"""Two cylinders that roll and slide on each other."""

from typing import ClassVar

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.contact.surface import Surfaces
from pitchpoint.core.factored import Numbers
from pitchpoint.gears.coordinates import AXIAL, Coordinate
from pitchpoint.gears.mesh_bodies import independent
from pitchpoint.gears.rigs.rig import Rig

__all__ = ["TwinDisc"]


class TwinDisc(Rig):
    """Two cylinders that roll and slide on each other.

    Attributes:
        radii: of both discs [m].
        length: of the contact line [m].
        speed_ratio: surface speed of disc 1 over that of disc 0; 1 rolls without sliding.
        surfaces: how the discs differ from cylinders.
    """

    shape: ClassVar[Shape] = "line"

    radii: Float[Array, "2"]
    length: Float[Array, ""]
    speed_ratio: Float[Array, ""]
    surfaces: Surfaces = ((), ())

    @property
    def other_rate(self) -> Float[Numbers, ""]:
        """Disc 1 turns the other way at the speed that the ratio asks for."""
        return -self.speed_ratio * self.radii[0] / self.radii[1]

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """Disc 0 at the origin, disc 1 beside it on the x axis."""
        centres = jnp.zeros((2, 3)).at[1, 0].set(jnp.sum(self.radii))
        axis = jnp.asarray(AXIAL)
        discs = [Coordinate(f"disc {k}", centres[k], axis, k) for k in (0, 1)]
        return (*discs, self._approach)

    @property
    def _frame(self) -> Float[Array, "3 3"]:
        directions = jnp.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        return directions.at[0, 0].set(self.radii[0])

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """The one contact line, the same at every phase."""
        curvature = jnp.stack([1.0 / self.radii, jnp.zeros(2)], axis=-1)
        return self._contacts(phase, curvature, (self.radii[0], -self.radii[1]), self.length)


independent.register(TwinDisc, lambda _: ("radii", "length", "speed_ratio"))
