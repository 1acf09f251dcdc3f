"""What every gear family answers."""

import abc
from functools import lru_cache
from typing import Any, Self, final

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.contact.surface import Spot, Surfaces, with_surfaces
from pitchpoint.contact.worn import new_and_worn, with_worn
from pitchpoint.core.brief import brief
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.gear_body import GearBody

__all__ = ["Mesh", "coordinates_of", "has"]


class Mesh(eqx.Module):
    """A gear family: contacts that travel, and the coordinates of the bodies that carry them.

    One period of `phase` is one engagement: the state of the mesh repeats with it. Coordinates are
    rotations counter-clockwise [rad], or translations [m] where a family has them. What only some gears
    have is no member: they register it, see `has`.

    Attributes:
        shape: of the class; that of all its contacts.
    """

    shape: eqx.AbstractClassVar[Shape]

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
        """The bodies and their axes, in the order of `relation`."""

    @final
    def contacts(self, phase: Float[Array, "*b"]) -> Contacts:
        """Contacts at any phase [periods], with the surfaces that the flanks have."""
        rigid = self.rigid_contacts(phase)
        if not any(self.surfaces):
            return rigid
        spots = self.spots(rigid, phase)
        as_made, worn = new_and_worn(self.surfaces)
        new = with_surfaces(rigid, as_made, spots)
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


def coordinates_of(mesh: Mesh) -> tuple[Coordinate, ...]:
    """Coordinates of a mesh without their places: of each form of a mesh they are traced once.

    Args:
        mesh: any family.
    """
    leaves, structure = jax.tree.flatten(mesh)
    shapes = (
        jax.ShapeDtypeStruct(leaf.shape, leaf.dtype) if hasattr(leaf, "dtype") else leaf
        for leaf in leaves
    )
    return _bodies(structure, tuple(shapes))


@lru_cache(maxsize=64)
def _bodies(structure: Any, leaves: tuple[Any, ...]) -> tuple[Coordinate, ...]:
    shape = jax.tree.unflatten(structure, leaves)
    coordinates: tuple[Coordinate, ...] = eqx.filter_eval_shape(
        lambda mesh: mesh.coordinates, shape
    )
    return coordinates


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
