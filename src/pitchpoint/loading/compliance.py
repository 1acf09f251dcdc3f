"""How the contacts of a mesh yield: each tooth by itself, and bodies that couple them."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.on_balls import Body, separation_on_balls
from pitchpoint.gears.tooth_section import tooth_sections
from pitchpoint.loading.tooth_compliance import TeethAt, Terms, teeth_at, unit_stiffness
from pitchpoint.materials.solids import Solid

__all__ = ["Compliance", "compliance", "mean_line_load", "slice_stiffness"]


class Compliance(eqx.Module):
    """How contacts yield under a load.

    Attributes:
        stiffness: of each slice per length of contact line [N/m2].
        body: how far a unit force on one lane (pair and slice, flattened) moves another, both along
            their normals [m/N]; None where bodies under the teeth do not couple them.
        load: that the loaded coordinate carries [N m or N].
        loaded: one for that coordinate, zero elsewhere.
    """

    stiffness: Float[Array, "pair slice *#b"]
    body: Body | None
    load: Float[Array, "*#b"]
    loaded: Float[Arrays, " dof"]

    def of_teeth(self, contacts: Contacts) -> Float[Array, "pair slice *b"]:
        """Compliance of each lane by itself [m/N].

        Args:
            contacts: of the mesh. Lanes without a contact line take no part and stay finite.
        """
        length = jnp.where(contacts.active & (contacts.weight > 0.0), contacts.weight, 1.0)
        return 1.0 / (self.stiffness * length)

    def gap(self, contacts: Contacts) -> Float[Array, "pair slice *b"]:
        """Separation of the unloaded flanks as their bodies stand [m].

        Args:
            contacts: of the mesh.
        """
        return separation_on_balls(contacts.gap, self.body)


def compliance(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    contacts: Contacts,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, "*#b"],
    body: Body | None = None,
    teeth: TeethAt | None = None,
) -> Compliance:
    """How the contacts of a mesh yield under a load.

    Args:
        mesh: a family whose members have teeth.
        loaded: one for the coordinate that carries the load, zero elsewhere.
        contacts: of the mesh.
        solids: material of each member.
        terms: of the model of tooth compliance.
        load: that the loaded coordinate carries [N m or N].
        body: see `GearBody.compliance`, where it is known already.
        teeth: where the contacts lie on them, where that is known already.
    """
    if body is None and mesh.body.couples:
        body = mesh.body.compliance(contacts, solids)
    stiffness = slice_stiffness(mesh, loaded, contacts, solids, terms, load, teeth)
    return Compliance(stiffness=stiffness, body=body, load=load, loaded=loaded)


def mean_line_load(
    loaded: Float[Arrays, " dof"], contacts: Contacts, load: Float[Array, "*#b"]
) -> Float[Array, "*#b"]:
    """Load per length if all contact lines carried the same [N/m].

    Args:
        loaded: one for the coordinate that carries the load, zero elsewhere.
        contacts: of the mesh.
        load: that the loaded coordinate carries [N m or N].

    From the balance of the loaded coordinate under one load per length on all contact lines.
    """
    arms = jnp.abs(contact_velocity(contacts.normal, loaded))
    return load / total(jnp.where(contacts.active, contacts.weight * arms, 0.0))


def slice_stiffness(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    contacts: Contacts,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, "*#b"],
    teeth: TeethAt | None = None,
) -> Float[Array, "pair slice *#b"]:
    """Stiffness of every slice per length of contact line [N/m2]; the contact's at the mean line load.

    Args:
        mesh, loaded, contacts, solids, terms, load: as in `compliance`.
        teeth: where the contacts lie on them, where that is known already.
    """
    if teeth is None:
        teeth = teeth_at(contacts, tooth_sections(mesh), solids, terms)
    line_load = mean_line_load(loaded, contacts, load)
    return unit_stiffness(contacts, teeth, solids, terms, line_load)
