"""Loads on the bearings of a drive: what the forces at its contacts ask of those that hold its bodies."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, total
from pitchpoint.core.factored import square_root
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.gears.mesh import Mesh

__all__ = ["Bearing", "InnerBearing", "radial_and_axial", "unit_forces"]

Lanes = Float[Array, "pair slice *#b"]
Vectors = Float[Array, "3 pair slice *#b"]
Each = Float[Array, "*#b"]

ROUNDING = 1e-12
"""Component of a resultant over the sum of its forces that counts as zero."""


class Bearing(eqx.Module):
    """A bearing between a body and the housing: one of two, or all bearings of the body as one.

    Forces and moments of the teeth on the body are in equilibrium with those of two bearings: radial
    loads follow from the moments about each other's place, one of the two takes the thrust. Several
    bearings as one take the resultant force, wherever it acts.

    Attributes:
        coordinate: of the body; static.
        place: along its axis from the middle of the face [m]; of no account to one that is alone.
        other: place of the second bearing [m]; None without one.
        thrust: True if it takes the axial force; static.
        beside: load on it by other meshes of the body, as a vector in the frame of this one [N]; None
            without any.

    From the balance of forces and moments on the body.
    """

    coordinate: int = eqx.field(static=True)
    place: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))
    other: Float[Array, ""] | None = None
    thrust: bool = eqx.field(static=True, default=True)
    beside: Float[Array, "3 *#b"] | None = None

    def unit_loads(self, mesh: Mesh, contacts: Contacts) -> Vectors:
        """Load on the bearing for a unit normal force at each contact, as a vector.

        Args:
            mesh: any family.
            contacts: of the mesh.

        From the balance of moments about the place of the other bearing.
        """
        body = mesh.coordinates[self.coordinate]
        force = unit_forces(body, contacts)
        if self.other is None:
            return force
        axis, place = (_widened(v, contacts) for v in (body.axis, body.place))
        lever = contacts.point - place
        along, axial = (jnp.sum(axis * v, axis=0) for v in (lever, force))
        radial, arm = force - axial * axis, lever - along * axis
        held = ((along - self.other) * radial - axial * arm) / (self.place - self.other)
        return held + axial * axis if self.thrust else held

    def load(self, mesh: Mesh, contacts: Contacts, force: Lanes) -> Each:
        """Size of the load on the bearing, radial and axial together [N].

        Args:
            mesh: any family.
            contacts: of the mesh.
            force: normal force of each slice [N].
        """
        own = self.borne(mesh, contacts, force)
        return _size(own if self.beside is None else own + self.beside)

    def borne(self, mesh: Mesh, contacts: Contacts, force: Lanes) -> Float[Array, "3 *#b"]:
        """Load on the bearing by this mesh alone, as a vector [N]; arguments as in `load`."""
        return _resultant(self.unit_loads(mesh, contacts) * force)


class InnerBearing(eqx.Module):
    """The bearing inside a drive that a wave of teeth presses on all around, see `GearBody.inner_load`."""

    def load(self, mesh: Mesh, contacts: Contacts, force: Lanes) -> Each:
        """Sum of the sizes of the loads around the bearing [N]; arguments as in `Bearing.load`."""
        return jnp.sum(mesh.body.inner_load(contacts) * force, axis=(0, 1, 2))


def unit_forces(body: Coordinate, contacts: Contacts) -> Vectors:
    """Force on a body for a unit normal force at each contact; none on one that carries no flanks.

    Friction acts at right angles to the normal force and would change the size of a reaction by less
    than half the square of its coefficient; it is left out.

    Args:
        body: of the mesh.
        contacts: of the mesh.

    From action and reaction along the unit normal.
    """
    if body.member is None:
        return jnp.zeros_like(contacts.direction)
    return contacts.direction if body.member == 1 else -contacts.direction


def radial_and_axial(mesh: Mesh, contacts: Contacts, force: Lanes) -> Float[Array, "2 member *#b"]:
    """Resultant of the normal forces on each member: across the axis of its body, and along it [N].

    The bearings of the body hold it, the guides of one that travels. The axial part is signed, positive along
    the body's axis. Forces that
    cancel, as those of two zones opposite each other, leave zero and not their rounding.

    Args:
        mesh: any family.
        contacts: of the mesh.
        force: normal force of each slice [N].

    From the balance of forces on each body.

    From the sum of the forces as vectors.
    """
    found = []
    for member in (0, 1):
        body = next(one for one in mesh.coordinates if one.member == member)
        whole = _resultant(unit_forces(body, contacts) * force)
        whole = jnp.where(jnp.abs(whole) > ROUNDING * total(force), whole, 0.0)
        axis = body.axis.reshape(3, *(1 for _ in whole.shape[1:]))
        axial = jnp.sum(axis * whole, axis=0)
        # A body that travels along its axis is held across it alone.
        held = axial if body.turns else jnp.zeros_like(axial)
        found.append(jnp.stack([_size(whole - axial * axis), held]))
    return jnp.stack(found, axis=1)


def _resultant(vectors: Vectors) -> Float[Array, "3 *#b"]:
    return jnp.sum(vectors, axis=(1, 2))


def _size(vector: Float[Array, "3 *#b"]) -> Each:
    found: Each = square_root(jnp.sum(vector**2, axis=0))
    return found


def _widened(vector: Float[Array, "3"], contacts: Contacts) -> Float[Array, "3 ..."]:
    return vector.reshape(3, *(1 for _ in contacts.active.shape))
