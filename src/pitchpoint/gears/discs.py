"""Two test rigs with closed forms everywhere: twin disc and ball on disc."""

from typing import Self

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh, Reference

__all__ = ["BallOnDisc", "TwinDisc"]


class _Rig(Mesh):
    """One contact that stays where it is. Coordinates: rotation of each body, approach along the normal.

    The load acts on the approach; the speed ratio u1/u0 of the surfaces is free.
    """

    speed_ratio: eqx.AbstractVar[Float[Array, ""]]

    @property
    def contact_ratio(self) -> Float[Array, ""]:
        """One contact, always."""
        return jnp.asarray(1.0)

    @property
    def driver(self) -> Float[Array, "3"]:
        """Body 0 sets the speed."""
        return jnp.array([1.0, 0.0, 0.0])

    @property
    def loaded(self) -> Float[Array, "3"]:
        """The load presses along the normal."""
        return jnp.array([0.0, 0.0, 1.0])

    def driven_by(self, member: str | int) -> Self:
        """The rig as it is, driven by body 0; its load presses and does not drive."""
        if member != 0:
            raise InputError("body 0 of a test rig sets the speed, and nothing else drives it")
        return self

    @property
    def period(self) -> Float[Array, ""]:
        """One turn of body 0."""
        return jnp.asarray(2.0 * jnp.pi)

    @property
    def reference(self) -> Reference | None:
        """A rig has no pitch point."""
        return None

    def events(self) -> Float[Array, "1"]:
        """Nothing enters or leaves."""
        return jnp.zeros(1)

    def _contacts(
        self,
        phase: Float[Array, "*b"],
        curvature: Float[Array, "2 2"],
        arms: tuple[Float[Array, ""], Float[Array, ""]],
        length: Float[Array, ""],
        shape: Shape,
    ) -> Contacts:
        lanes = (1, 1, *jnp.shape(phase))
        zero = jnp.zeros(lanes)
        turn = jnp.mod(phase, 1.0)[None, None]
        surface = jnp.zeros((2, 3)).at[0, 0].set(arms[0]).at[1, 1].set(arms[1])
        speeds = surface @ self.motion
        return Contacts(
            active=jnp.ones(lanes, bool),
            path=turn,
            width=zero,
            weight=jnp.broadcast_to(length, lanes),
            curvature=_everywhere(curvature, lanes),
            surface=_everywhere(surface, lanes),
            normal=_everywhere(self.loaded, lanes),
            gap=zero,
            flank=_everywhere(speeds * self.period, lanes) * turn,
            shape=shape,
        )


def _everywhere(values: Float[Array, "..."], lanes: tuple[int, ...]) -> Float[Array, "..."]:
    """The same values [structure] at every contact [structure pair slice *b]."""
    return jnp.broadcast_to(
        values.reshape(*values.shape, *(1 for _ in lanes)), (*values.shape, *lanes)
    )


class TwinDisc(_Rig):
    """Two cylinders that roll and slide on each other.

    Attributes:
        radii: of both discs [m].
        length: of the contact line [m].
        speed_ratio: surface speed of disc 1 over that of disc 0; 1 rolls without sliding.
    """

    radii: Float[Array, "2"]
    length: Float[Array, ""]
    speed_ratio: Float[Array, ""]

    @property
    def motion(self) -> Float[Array, "3"]:
        """Disc 1 turns the other way at the speed that the ratio asks for."""
        return jnp.stack(
            [jnp.asarray(1.0), -self.speed_ratio * self.radii[0] / self.radii[1], jnp.asarray(0.0)]
        )

    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """The one contact line, the same at every phase."""
        curvature = jnp.stack([1.0 / self.radii, jnp.zeros(2)], axis=-1)
        arms = (self.radii[0], -self.radii[1])
        return self._contacts(phase, curvature, arms, self.length, "line")


class BallOnDisc(_Rig):
    """A ball that rolls and slides on the flat face of a disc, spin neglected.

    Attributes:
        ball_radius: [m].
        track_radius: of the track on the disc [m].
        speed_ratio: surface speed of the disc over that of the ball.
    """

    ball_radius: Float[Array, ""]
    track_radius: Float[Array, ""]
    speed_ratio: Float[Array, ""]

    @property
    def motion(self) -> Float[Array, "3"]:
        """The disc turns so that its track runs along with the ball's surface."""
        ratio = self.speed_ratio * self.ball_radius / self.track_radius
        return jnp.stack([jnp.asarray(1.0), ratio, jnp.asarray(0.0)])

    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """The one circular contact, the same at every phase."""
        curvature = jnp.stack([jnp.full(2, 1.0 / self.ball_radius), jnp.zeros(2)])
        arms = (self.ball_radius, self.track_radius)
        return self._contacts(phase, curvature, arms, jnp.asarray(1.0), "ellipse")
