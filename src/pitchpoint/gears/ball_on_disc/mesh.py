"""A ball or barrel that rolls and slides on the flat face of a disc, both driven."""

from typing import ClassVar

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.contact.surface import Surfaces
from pitchpoint.core.factored import Numbers
from pitchpoint.gears.coordinates import AXIAL, Coordinate
from pitchpoint.gears.mesh_bodies import independent
from pitchpoint.gears.rigs.rig import Rig

__all__ = ["BallOnDisc"]


class BallOnDisc(Rig):
    """A ball or barrel that rolls and slides on the flat face of a disc, spin neglected.

    Coordinates and members are disc and ball. The disc lies in the plane z = 0 and turns about z, its
    track runs along y through the contact at x = `track_radius`; the ball above it turns about the
    line towards +x, so that both surfaces run the same way, and approaches along -z.

    Attributes:
        radius: of the ball along the track and across it, alike but for a barrel [m].
        track_radius: of the track on the disc [m].
        slide_roll_ratio: speed of the disc's surface less that of the ball's, over their mean; 2 for a
            ball at rest, above -2 since the disc drives.
        surfaces: how disc and ball differ from their design.
    """

    shape: ClassVar[Shape] = "ellipse"

    radius: Float[Array, "2"]
    track_radius: Float[Array, ""]
    slide_roll_ratio: Float[Array, ""]
    surfaces: Surfaces = ((), ())

    @property
    def other_rate(self) -> Float[Numbers, ""]:
        """The ball is driven to the slide-roll ratio on its own."""
        slip = self.slide_roll_ratio
        return self.track_radius / self.radius[0] * (2.0 - slip) / (2.0 + slip)

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The disc about z at the origin, the ball above the contact on the x axis."""
        above = self._frame[0].at[2].set(self.radius[0])
        disc = Coordinate("disc", jnp.zeros(3), jnp.asarray(AXIAL), 0)
        return disc, Coordinate("ball", above, jnp.array([1.0, 0.0, 0.0]), 1), self._approach

    @property
    def _frame(self) -> Float[Array, "3 3"]:
        directions = jnp.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]])
        return directions.at[0, 0].set(self.track_radius)

    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """The one elliptic contact, the same at every phase."""
        curvature = jnp.stack([jnp.zeros(2), 1.0 / self.radius])
        arms = (self.track_radius, self.radius[0])
        return self._contacts(phase, curvature, arms, jnp.asarray(1.0))


independent.register(BallOnDisc, lambda _: ("radius", "track_radius", "slide_roll_ratio"))
