"""What test rigs have in common: one contact that stays where it is."""

import abc
from typing import ClassVar, Self

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.contact.surface import Spot
from pitchpoint.core.factored import Arrays, Numbers
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import turned_rates, usual_ends
from pitchpoint.gears.pairs import flanks_in_turn

__all__ = ["Rig"]


class Rig(Mesh):
    """One contact that stays where it is. Coordinates: rotation of each body, approach along the normal.

    The load acts on the approach, which stands still: nothing is transmitted. Phase counts turns of
    body 0.
    """

    body: ClassVar[GearBody] = GearBody()

    @property
    def other_flanks(self) -> Self:
        """Bodies without flanks have no other ones."""
        return self

    @property
    def contact_ratio(self) -> Float[Array, ""]:
        """One contact, always."""
        return jnp.asarray(1.0)

    @property
    def relation(self) -> Float[Array, "3"]:
        """Discs slide on each other at any speeds; only the load keeps them together."""
        return jnp.array([0.0, 0.0, 1.0])

    @property
    def pitch(self) -> Float[Array, ""]:
        """One turn of body 0."""
        return jnp.asarray(2.0 * jnp.pi)

    @property
    def passing(self) -> Float[Array, "3"]:
        """Phase counts turns of body 0."""
        return jnp.array([1.0, 0.0, 0.0])

    @property
    @abc.abstractmethod
    def other_rate(self) -> Float[Numbers, ""]:
        """Rate of body 1, which is turned on its own, for a unit rate of body 0."""

    @property
    def rates(self) -> Float[Array, "3"]:
        """Of both bodies, each by its own motor, for a unit rate of body 0; the approach stands still."""
        return jnp.stack([jnp.asarray(1.0), self.other_rate, jnp.asarray(0.0)])

    @property
    def _approach(self) -> Coordinate:
        """The way along which the load presses body 1 on body 0."""
        return Coordinate("load", self._frame[0], -self._frame[1], 1, turns=False)

    @property
    @abc.abstractmethod
    def _frame(self) -> Float[Array, "3 3"]:
        """Place of the contact, normal out of body 0, and tangent."""

    def events(self) -> Float[Array, "1"]:
        """Nothing enters or leaves."""
        return jnp.zeros(1)

    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """Both bodies turn on under the contact."""
        lanes = contacts.path.shape
        body_spot, mate_spot = (
            Spot(
                flank=flank,
                across=contacts.width,
                angle=jnp.broadcast_to(-rate * self.pitch * phase, lanes),
                tooth=jnp.zeros(lanes, int),
                leaning=jnp.ones(lanes),
            )
            for flank, rate in zip(contacts.flank, self.rates[:2], strict=True)
        )
        return body_spot, mate_spot

    def _contacts(
        self,
        phase: Float[Array, "*b"],
        curvature: Float[Array, "2 2"],
        arms: tuple[Float[Array, ""], Float[Array, ""]],
        length: Float[Array, ""],
    ) -> Contacts:
        """The one contact at any phase.

        Args:
            phase: [periods].
            curvature: of each body along and across the rolling direction [1/m].
            arms: surface velocity of each body for a unit rate of its rotation [m/rad].
            length: of the contact line [m]; one for an ellipse, which carries as a whole.
        """
        lanes = (1, 1, *jnp.shape(phase))
        zero = jnp.zeros(lanes)
        point, direction, tangent = _everywhere(self._frame, lanes)
        turn = jnp.mod(phase, 1.0)[None, None]
        surface = jnp.zeros((2, 3)).at[0, 0].set(arms[0]).at[1, 1].set(arms[1])
        speeds = surface @ self.rates
        return Contacts(
            active=jnp.ones(lanes, bool),
            path=turn,
            width=zero,
            weight=jnp.broadcast_to(length, lanes),
            curvature=_everywhere(curvature, lanes),
            surface=_everywhere(surface, lanes),
            normal=_everywhere(self.relation, lanes),
            gap=zero,
            flank=_everywhere(speeds * self.pitch, lanes) * turn,
            point=point,
            direction=direction,
            tangent=tangent,
            shape=self.shape,
        )


def _everywhere(values: Float[Array, "..."], lanes: tuple[int, ...]) -> Float[Array, "..."]:
    """The same values [structure] at every contact [structure pair slice *b]."""
    return jnp.broadcast_to(
        values.reshape(*values.shape, *(1 for _ in lanes)), (*values.shape, *lanes)
    )


@usual_ends.register
def _usual_ends(rig: Rig) -> tuple[int, int]:
    """The load presses, and moves nothing."""
    return 0, 2


@turned_rates.register
def _turned_rates(rig: Rig, driver: Float[Arrays, "3"]) -> Float[Array, "3"]:
    """Both bodies."""
    return rig.rates


@flanks_in_turn.register
def _flanks_in_turn(rig: Rig) -> Float[Array, "2"]:
    """Ways that a body rolls in one period of body 0, over its circumference."""
    rates = rig.rates[:2]
    return jnp.abs(rates[0] / jnp.where(rates == 0.0, jnp.nan, rates))
