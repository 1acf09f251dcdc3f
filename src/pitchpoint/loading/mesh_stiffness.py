"""Stiffness of a mesh: every pair of teeth as a spring along the normal of its contacts."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.period import edges, nodes
from pitchpoint.loading.equilibrium import Equilibrium
from pitchpoint.loading.springs import springs
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid

__all__ = ["MeshStiffness", "mesh_stiffness"]

Lanes = Float[Array, "pair slice *#b"]


class MeshStiffness(eqx.Module):
    """Springs of all pairs over one period, for small motions about their places under the load.

    One arm and one separation stand for the whole contact line of a pair. Where flanks have gaps, the
    line is as long as it carries in the equilibrium under the load.

    Attributes:
        edges: phases between which the stiffness is smooth [periods].
        phase: of the nodes [periods].
        weight: of each node in a mean over the period.
        single: normal stiffness of each pair, force over closing for small changes of both, the sum over
            its contact line; zero out of contact [N/m].
        arm: closing of each contact along its normal for a unit of transmission error.
        error: closing at which these springs carry nothing, the mean over a contact line, see `Springs` [m].
        approach: of the loaded coordinate under the load [rad or m].
        state: the equilibrium; None where the flanks touch along the whole of every contact line.

    Source: Atanasiu et al. (2011), eqs. 20 to 22, see its methods.
    """

    edges: Float[Array, " edge"]
    phase: Float[Array, "segment node"]
    weight: Float[Array, "segment node"]
    single: Float[Array, "pair segment node"]
    arm: Float[Array, "pair segment node"]
    error: Float[Array, "pair segment node"]
    approach: Float[Array, "segment node"]
    state: Equilibrium | None = None

    @property
    def along_action(self) -> Float[Arrays, "pair segment node"]:
        """Stiffness of each pair against transmission error, along the line of action [N/m].

        From virtual work: a spring counts with the square of its arm.
        """
        return self.single * self.arm**2

    @property
    def total(self) -> Float[Arrays, "segment node"]:
        """Stiffness of the mesh against transmission error [N/m].

        Source: Atanasiu et al. (2011), eq. 21.
        """
        return jnp.sum(self.along_action, axis=0)

    @property
    def mean(self) -> Float[Arrays, ""]:
        """Mean over the period [N/m].

        Source: Atanasiu et al. (2011), eq. 22.
        """
        return jnp.sum(self.total * self.weight)


def mesh_stiffness(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, ""],
    count: int = 12,
) -> MeshStiffness:
    """Stiffness over one period at one load.

    Args:
        mesh: a family whose members have teeth and a line of action.
        loaded: one for the coordinate that carries the load, zero elsewhere.
        solids: material of each member.
        terms: of the model of tooth compliance.
        load: that the loaded coordinate carries [N m or N].
        count: nodes in each segment between events.

    Source: Atanasiu et al. (2011), eqs. 20 to 22.
    """
    events = mesh.events()
    phase, weight = nodes(events, count)
    contacts = mesh.contacts(phase)
    found = springs(mesh, loaded, contacts, solids, terms, load)
    each = jnp.where(found.loaded, found.stiffness, 0.0)
    if found.state is not None:
        each = jnp.where(jnp.isfinite(found.approach), each, jnp.nan)
    return MeshStiffness(
        edges=edges(events),
        phase=phase,
        weight=weight,
        single=jnp.sum(each, axis=1),
        arm=_action_arm(mesh, contacts)[:, 0],
        error=_mean_gap(found.gap, each),
        approach=found.approach,
        state=found.state,
    )


def _mean_gap(gap: Lanes, springs: Lanes) -> Float[Array, "pair *b"]:
    """Separation at which the springs of a whole contact line, all stretched alike, carry nothing."""
    whole = jnp.sum(springs, axis=1)
    touches = whole > 0.0
    moved = jnp.sum(springs * gap, axis=1)
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.where(touches, moved / jnp.where(touches, whole, 1.0), 0.0)


def _action_arm(mesh: Mesh, contacts: Contacts) -> Lanes:
    """Closing along the normal of each contact while the gears close by one along the line of action."""
    action = line_of_action(mesh)
    return contact_velocity(contacts.normal, action) / jnp.sum(action**2)
