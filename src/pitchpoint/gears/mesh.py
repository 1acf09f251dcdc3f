"""What every gear family answers."""

import abc
import dataclasses
from functools import singledispatch
from typing import Any, Self, final

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.brief import brief
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.contact.surface import Spot, Surfaces, with_surfaces
from pitchpoint.contact.worn import new_and_worn, with_worn
from pitchpoint.errors import InputError
from pitchpoint.factored import Arrays
from pitchpoint.gears.coordinates import Coordinate, number_of
from pitchpoint.gears.gear_body import GearBody

__all__ = ["Mesh", "has", "turned_rates"]


class Mesh(eqx.Module):
    """A gear family: contacts that travel, and the coordinates of the bodies that carry them.

    One period of `phase` is one engagement: the state of the mesh repeats with it. Coordinates are
    rotations counter-clockwise [rad], or translations [m] where a family has them. What only some gears
    have is no member: they register it, see `has`.

    Attributes:
        shape: of the class; that of all its contacts.
        driver: one for the coordinate that drives, zero elsewhere.
        loaded: one for the coordinate whose load is prescribed, zero elsewhere; what is left stands still.
    """

    shape: eqx.AbstractClassVar[Shape]
    driver: eqx.AbstractVar[Float[Arrays, " dof"]]
    loaded: eqx.AbstractVar[Float[Arrays, " dof"]]

    def __repr__(self) -> str:
        return brief(self)

    @property
    @abc.abstractmethod
    def surfaces(self) -> Surfaces:
        """How all flanks of each member differ from those of `rigid_contacts`; a field of every family."""

    @property
    @abc.abstractmethod
    def body(self) -> GearBody:
        """What lies under and behind the teeth."""

    @property
    @abc.abstractmethod
    def other_flanks(self) -> Self:
        """The same mesh where its other flanks carry; gaps are counted from the same position."""

    @abc.abstractmethod
    def spots(self, contacts: Contacts, phase: Float[Arrays, "..."]) -> tuple[Spot, Spot]:
        """Where contacts lie on both members.

        Args:
            contacts: of the mesh.
            phase: at which they were taken, counted on beyond one period [periods].
        """

    @property
    @abc.abstractmethod
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The bodies and their axes, in the order of `motion`."""

    @final
    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts at any phase [periods], with the surfaces that the flanks have."""
        rigid = self.rigid_contacts(phase)
        if not any(self.surfaces):
            return rigid
        spots = self.spots(rigid, phase)
        made, worn = new_and_worn(self.surfaces)
        new = with_surfaces(rigid, made, spots)
        return with_worn(new, worn, spots)[0] if any(worn) else new

    @abc.abstractmethod
    def rigid_contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts of rigid flanks as designed, at any phase [periods]."""

    @abc.abstractmethod
    def events(self) -> Float[Array, " event"]:
        """Sorted phases in [0, 1) at which a pair enters, leaves or passes pure rolling (static count)."""

    @property
    @abc.abstractmethod
    def contact_ratio(self) -> Float[Array, ""]:
        """Mean number of pairs in contact."""

    @property
    @abc.abstractmethod
    def relation(self) -> Float[Array, " dof"]:
        """Factors of the rates of the coordinates: their sum is zero in every motion that flanks allow.

        A sum above zero closes the flanks that touch.
        """

    @property
    @abc.abstractmethod
    def pitch(self) -> Float[Array, ""]:
        """Pitch of a period, positive: `passing` over one period [rad or m]."""

    @property
    @abc.abstractmethod
    def passing(self) -> Float[Array, " dof"]:
        """Factors of the rates of the coordinates, whose sum is the rate at which engagements pass."""

    @final
    @property
    def motion(self) -> Float[Array, " dof"]:
        """Nominal rates of the coordinates for a unit rate of the driver, which presses the flanks."""
        turned, relation = turned_rates(self), self.relation
        return turned - (relation @ turned) / (relation @ self.loaded) * self.loaded

    @final
    @property
    def period(self) -> Float[Array, ""]:
        """Motion of the driver in one period [rad or m]."""
        return self.pitch / jnp.abs(self.passing @ self.motion)

    @final
    @property
    def onward(self) -> Float[Array, ""]:
        """Sense in which the phase runs while the drive turns on: one, or minus one."""
        return jnp.sign(self.passing @ self.motion)

    @final
    def driven_by(self, member: str | int) -> Self:
        """The same drive with another member driving, in the sense that presses the same flanks.

        A fixed member stays fixed; the one that drove carries the load.

        Args:
            member: name of a body, or number of its coordinate.

        Raises:
            InputError: it cannot drive.
        """
        places = eqx.filter_eval_shape(lambda mesh: mesh.coordinates, self)
        names = tuple(place.body for place in places)
        drives = number_of(member, names)
        if np.asarray(self.driver)[drives]:
            return self
        if has(self, turned_rates):
            raise InputError(
                f"bodies here have motors of their own; the {names[drives]} drives none"
            )
        if not np.asarray(self.loaded)[drives]:
            raise InputError(f"the {names[drives]} is fixed and cannot drive")
        return dataclasses.replace(self, driver=self.loaded, loaded=self.driver)


@singledispatch
def turned_rates(mesh: Any) -> Float[Array, " dof"]:
    """Rates of the coordinates that are turned from outside, zero of the others.

    Args:
        mesh: any family; that of most turns its driver alone.
    """
    rates: Array = mesh.driver * jnp.sign(mesh.relation @ mesh.driver)
    return rates


def has(mesh: Mesh, question: Any) -> bool:
    """True if the gears of a mesh register an answer to a question that not all gears have one to.

    Args:
        mesh: any family.
        question: of `functools.singledispatch`, such as `flanks_in_turn`.

    Example:
        >>> import jax.numpy as jnp
        >>> from pitchpoint.gears.contact_lines import line_of_action
        >>> from pitchpoint.gears.pairs import flanks_in_turn
        >>> from pitchpoint.gears.rigs.twin_disc import TwinDisc
        >>> discs = TwinDisc(jnp.array([0.02, 0.035]), jnp.asarray(0.008), jnp.asarray(0.8))
        >>> has(discs, flanks_in_turn), has(discs, line_of_action)
        (True, False)
    """
    return question.dispatch(type(mesh)) is not question.dispatch(object)
