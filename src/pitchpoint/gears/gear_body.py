"""What lies under and behind the teeth of a pair of members, as it yields."""

from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.on_balls import Body
from pitchpoint.materials.solids import Solid

__all__ = ["GearBody"]


class GearBody(eqx.Module):
    """Bodies under the teeth; these are stiff but for what the tooth model says of the foundations of teeth.

    Attributes:
        couples: of the class; True if teeth yield under loads on others, see `compliance`.
        inner_bearing: of the class; the two bodies between which a bearing sits inside the drive, by name;
            empty without one.
    """

    couples: ClassVar[bool] = False
    inner_bearing: ClassVar[frozenset[str]] = frozenset()

    @property
    def yielding(self) -> tuple[str, str]:
        """What yields under load, and what is left out, in words."""
        return "teeth and the bodies under them", "shafts, bearings and housing"

    def compliance(self, contacts: Contacts, solids: tuple[Solid, Solid]) -> Body:
        """How far a unit force on one lane moves another through the body under the teeth [m/N].

        Lanes are pairs and slices, flattened; both ends along their normals. It does not depend on the
        load. Of bodies that say so, see `couples`.

        Args:
            contacts: of the mesh.
            solids: material of each member.
        """
        raise TypeError(f"{type(self).__name__} does not couple teeth")

    def parts(
        self,
        contacts: Contacts,
        solids: tuple[Solid, Solid],
        force: Float[Array, "pair slice *b"],
        balls: Float[Array, "ball *b"] | None,
    ) -> dict[str, Float[Array, "*b"]]:
        """Work of the contacts' forces on what bodies under the teeth yield, by name of the part [N m].

        Args:
            contacts: of the mesh.
            solids: material of each member.
            force: normal force of each slice [N].
            balls: approach of balls that hold the body [m]; None without.
        """
        return {}

    def in_series(
        self, solids: tuple[Solid, Solid], loaded: Float[Arrays, " dof"]
    ) -> dict[str, Float[Array, ""]]:
        """What yields behind the teeth and carries the whole load, by name.

        Args:
            solids: material of each member.
            loaded: one for the coordinate that carries the load, zero elsewhere.

        Returns:
            Movement of the loaded coordinate for a unit load on it [rad/(N m) or m/N].
        """
        return {}

    def inner_load(self, contacts: Contacts) -> Float[Array, "zone pair slice *b"]:
        """Load on the bearing inside the drive for a unit normal force at each contact, not negative.

        Forces that press on it from all around are no reaction, in which they cancel: it bears their sum.
        One row for each zone in which they press; none without such a bearing, see `inner_bearing`.

        Args:
            contacts: of the mesh.
        """
        return jnp.zeros((0, *contacts.weight.shape))

    @property
    def elsewhere(self) -> "GearBody | None":
        """The same while the balls in it stand elsewhere; None without balls."""
        return None
