"""How the pairs of a mesh yield: each tooth by itself, and a thin ring that couples them."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.mesh_stiffness import slice_stiffness
from pitchpoint.loading.ring_compliance import ring_compliance
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid

__all__ = ["Yielding", "body_compliance", "yielding"]


class Yielding(eqx.Module):
    """How the pairs yield under a load.

    Attributes:
        stiffness: of each slice per length of contact line [N/m2].
        body: how far a unit force on one lane (pair and slice, flattened) moves another, both along
            their normals [m/N]; None where bodies under the teeth do not couple them.
        load: that the driven coordinate carries [N m or N].
    """

    stiffness: Float[Array, "pair slice *#b"]
    body: Float[Array, "lane lane *#b"] | None
    load: Float[Array, "*#b"]

    def compliance(self, contacts: Contacts) -> Float[Array, "lane lane *b"]:
        """Compliance of all lanes, teeth and body together [m/N]; symmetric positive definite.

        Args:
            contacts: of the mesh. Lanes without a contact line take no part and stay finite.
        """
        length = jnp.where(contacts.active & (contacts.weight > 0.0), contacts.weight, 1.0)
        each = 1.0 / (self.stiffness * length)
        each = each.reshape(-1, *each.shape[2:])
        count = each.shape[0]
        teeth = jnp.eye(count).reshape(count, count, *(1 for _ in each.shape[1:])) * each
        return teeth if self.body is None else teeth + self.body


def yielding(
    mesh: Mesh,
    contacts: Contacts,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, "*#b"],
    body: Float[Array, "lane lane *#b"] | None = None,
) -> Yielding:
    """How the pairs of a mesh yield under a load.

    Args:
        mesh: a family whose members have teeth.
        contacts: of the mesh.
        solids: material of each member.
        terms: of the model of tooth compliance.
        load: that the driven coordinate carries [N m or N].
        body: see `body_compliance`, where it is known already.
    """
    if body is None:
        body = body_compliance(mesh, contacts, solids)
    return Yielding(
        stiffness=slice_stiffness(mesh, contacts, solids, terms, load), body=body, load=load
    )


def body_compliance(
    mesh: Mesh, contacts: Contacts, solids: tuple[Solid, Solid]
) -> Float[Array, "lane lane *b"] | None:
    """How far a unit force on one lane moves another through the body under the teeth [m/N].

    It does not depend on the load. None for bodies that do not couple their teeth.

    Args:
        mesh: any family.
        contacts: of the mesh.
        solids: material of each member.
    """
    ring, loads = mesh.ring, mesh.ring_loads(contacts)
    if ring is None or loads is None:
        return None
    return ring_compliance(ring, solids[0], loads)
