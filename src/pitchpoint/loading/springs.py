"""Contacts of loaded teeth as springs for small motions about the place where the load has moved them."""

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.factored import Arrays
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.compliance import Compliance, compliance
from pitchpoint.loading.equilibrium import Equilibrium, equilibrium
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid

__all__ = ["Springs", "springs"]

Lanes = Float[Array, "pair slice *b"]


class Springs(eqx.Module):
    """Every slice as a straight line through its force and its closing under the load.

    For motions that are small beside that closing; where teeth part, the line ends before the contact does,
    by what `gap` is wider than the flanks.

    Attributes:
        stiffness: change of the normal force over closing, zero out of contact [N/m].
        gap: closing at which that line has no force, in place of the separation of the unloaded flanks; a
            contact that stiffens with its load has a wider one [m].
        approach: of the loaded coordinate under the load, from where `Contacts.gap` counts [rad or m].
        loaded: True where the load presses a slice.
        state: the equilibrium; None where the flanks touch along the whole of every contact line.

    From the tangent of force over closing under the load.
    """

    stiffness: Lanes
    gap: Lanes
    approach: Float[Array, "*b"]
    loaded: Bool[Array, "pair slice *b"]
    state: Equilibrium | None = None


def springs(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    contacts: Contacts,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, "*#b"],
) -> Springs:
    """Slope of the force of every slice over its closing at one load, without friction.

    With the closing C(W) f of a slice, f its force, W the mean load on a length of contact line: the slope
    of all contacts together is 1 + e times as soft as C, e the mean of W C'(W)/C by the share of the load.
    All slices get that factor, so that they share a change of the load as they share the load, and the gap
    -e C f that leaves closing and force under the load as they are.

    Args:
        mesh, loaded, contacts, solids, terms, load: as in `compliance.compliance`.

    From the derivative of the equilibrium with respect to the load, see `equilibrium`.
    """
    load = jnp.asarray(load, float)
    arm = jnp.abs(contact_velocity(contacts.normal, loaded))
    yields, change = _with_change(mesh, loaded, contacts, solids, terms, load)
    own, gap = yields.of_teeth(contacts), yields.gap(contacts)
    if touching(mesh) and yields.body is None:
        state = None
        unit = jnp.where(contacts.active, arm / own, 0.0)
        approach = load / total(unit * arm)
        force, carries = unit * approach, contacts.active
    else:
        given = {"gap": gap, "arm": arm, "active": contacts.active}
        state = equilibrium(own, yields.body, **given, load=load)
        approach, force, carries = state.approach, state.force, state.loaded
    changed = total(jnp.where(carries, arm * force * change, 0.0))
    softer = 1.0 + changed / jnp.where(load > 0.0, load, 1.0)
    return Springs(
        stiffness=jnp.where(contacts.active, 1.0 / (softer * own), 0.0),
        gap=gap + jnp.where(carries, (1.0 - softer) * own * force, 0.0),
        approach=approach,
        loaded=carries,
        state=state,
    )


def _with_change(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    contacts: Contacts,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, "*#b"],
) -> tuple[Compliance, Lanes]:
    """How contacts yield, and the relative change of their compliance for one of the load."""

    def stiffness(load: Float[Array, "*#b"]) -> tuple[Lanes, Compliance]:
        yields = compliance(mesh, loaded, contacts, solids, terms, load)
        return yields.stiffness, yields

    of_load, change, yields = jax.jvp(stiffness, (load,), (load,), has_aux=True)
    return yields, -change / of_load
