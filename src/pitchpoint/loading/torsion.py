"""Wind-up of a strain-wave gear under torque, its stiffness, and hysteresis by friction of the teeth."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.errors import InputError
from pitchpoint.factored import Arrays
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.clearances import Shared, shared_load
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.loading.yielding import yielding
from pitchpoint.materials.solids import Solid
from pitchpoint.programs import program

__all__ = ["Hysteresis", "Torsion", "hysteresis", "torsion", "wound_up"]

Each = Float[Arrays, "*#b"]


class Torsion(eqx.Module):
    """Equilibrium at rest at torques and phases `*b`, without friction.

    Attributes:
        load: torque of the loaded member [N m].
        wind_up: rotation of that member from first touch, the others held [rad].
        touch: rotation up to first touch: its play on this flank at this phase [rad].
        stiffness: slope of the load over the wind-up [N m/rad]; steps up where a pair comes to carry.
        loaded_pairs: number of pairs that carry.
        force: normal force of each slice [N].
        share: part of the sum of all forces; without load the limit for a vanishing one.
        radial_load: inward force of the teeth on the ring at each end of the long axis [N].
        slip_torque: sum of forces times their sliding arms: what a friction coefficient of one would
            hold at the loaded member [N m].
        residual: of the equilibrium, see `Shared`.
        iterations: common to all states.
    """

    load: Each
    wind_up: Each
    touch: Each
    stiffness: Each
    loaded_pairs: Int[Array, "*b"]
    force: Float[Array, "pair slice *b"]
    share: Float[Array, "pair slice *b"]
    radial_load: Float[Array, "2 *b"]
    slip_torque: Each
    residual: Each
    iterations: Int[Array, ""]


class Hysteresis(eqx.Module):
    """Branches of a loop of torque over wind-up.

    Attributes:
        wind_up: of the loaded member, from first touch [rad].
        loading, unloading: its torque while the wind-up grows, and while it shrinks [N m].
    """

    wind_up: Each
    loading: Each
    unloading: Each


def torsion(
    mesh: Mesh,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Each,
    phase: Each,
    contacts: Contacts | None = None,
    body: Float[Array, "lane lane *#b"] | None = None,
) -> Torsion:
    """Wind-up of the loaded member at torques and phases, with the pairs that come to carry.

    Args:
        mesh: a family whose member 0 is a thin ring; the first half of its pairs lies at one end of
            the long axis, the second at the other.
        solids: material of each member.
        terms: of the model of tooth compliance.
        load: torques of the loaded member, not negative, broadcast against the phases [N m].
        phase: of the mesh [periods], as many axes as `load`.
        contacts: at these phases, where they are known already.
        body: see `body_compliance`, where it is known already.

    Returns:
        NaN where no equilibrium was found. Teeth, ring and cup yield, and the bearing inside the ring
        by its support stiffness; its clearance, shafts, joints and the flange are not in it.

    Raises:
        InputError: the mesh has no ring.
    """
    contacts = mesh.contacts(phase) if contacts is None else contacts
    loads = mesh.ring_loads(contacts)
    if mesh.ring is None or loads is None:
        raise InputError("wind-up over pairs with clearances asks for a strain-wave gear")
    arm = jnp.abs(along(contacts.normal, mesh.loaded))
    load = jnp.broadcast_to(load, jnp.broadcast_shapes(jnp.shape(load), jnp.shape(phase)))

    def approach(torque: Each) -> tuple[Each, Shared]:
        compliance = yielding(mesh, contacts, solids, terms, torque, body).compliance(contacts)
        given = {"gap": contacts.gap, "arm": arm, "active": contacts.active}
        found = shared_load(compliance, **given, load=torque)
        return found.approach, found

    # The springs themselves depend on the load where the contact of the teeth does.
    moved, slope, found = jax.jvp(approach, (load,), (jnp.ones_like(load),), has_aux=True)
    touches = contacts.active & (arm > 0.0)
    each = jnp.where(touches, contacts.gap / jnp.where(touches, arm, 1.0), jnp.inf)
    touch = jnp.broadcast_to(jnp.min(each, axis=(0, 1)), moved.shape)
    half = contacts.path.shape[0] // 2
    inward = -found.force * loads.radial
    slip = jnp.abs(along(contacts.slip_arm, mesh.loaded))
    return Torsion(
        load=load,
        wind_up=moved - touch,
        touch=touch,
        stiffness=1.0 / slope,
        loaded_pairs=jnp.sum(jnp.any(found.loaded, axis=1), axis=0),
        force=found.force,
        share=found.share,
        radial_load=jnp.stack([total(inward[:half]), total(inward[half:])]),
        slip_torque=total(found.force * slip),
        residual=found.residual,
        iterations=found.iterations,
    )


@program
def wound_up(
    mesh: Mesh,
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, ""],
    contacts: Contacts,
    body: Float[Array, "lane lane *#b"] | None,
) -> Torsion:
    """Wind-up at one torque at all phases of known contacts: one program for every torque and part of a run.

    Arguments and result as in `torsion`.
    """
    loads = jnp.broadcast_to(load, contacts.path.shape[2:])
    return torsion(mesh, solids, terms, loads, loads, contacts, body)


def hysteresis(found: Torsion, friction: float | Float[Array | np.ndarray, "*#b"]) -> Hysteresis:
    """Loop of torque over wind-up by Coulomb friction on the teeth while the drive stands still.

    On loading, friction adds mu times the sum of forces times sliding arms to the torque that the
    same wind-up takes without it, and takes away as much on unloading. All flanks are taken to slide
    as soon as the sense turns, and forces to be those without friction, so the loop is right to
    first order in mu and closes at no load: what remains of a measured loop there has other causes.

    Args:
        found: wind-up over torques.
        friction: coefficient mu of the teeth, broadcast over the states.
    """
    held = friction * found.slip_torque
    return Hysteresis(found.wind_up, found.load + held, found.load - held)
