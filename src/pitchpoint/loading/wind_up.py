"""Wind-up of a mesh under load, its stiffness, and hysteresis by friction of the teeth."""

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import looping_program, program
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.on_balls import Body
from pitchpoint.gears.pairs import of_pairs, on_edge
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.equilibrium import Equilibrium, equilibrium, touching_approach
from pitchpoint.loading.tooth_compliance import Terms
from pitchpoint.materials.solids import Solid

__all__ = ["Hysteresis", "WindUp", "body_parts", "hysteresis", "wind_up", "wound_up"]

Each = Float[Arrays, "*#b"]


class WindUp(eqx.Module):
    """Equilibrium at rest at loads and phases `*b`, without friction.

    Attributes:
        load: that the loaded coordinate carries [N m or N].
        wind_up: movement of that coordinate from first touch, the others held [rad or m].
        touch: movement up to first touch: its play on this flank at this phase [rad or m].
        stiffness: slope of the load over the wind-up [N m/rad or N/m]; steps up where a pair comes to
            carry.
        loaded_pairs: number of pairs that carry.
        force: normal force of each slice [N].
        share: part of the sum of all forces; without load the limit for a vanishing one.
        edge_load: sum of the forces at ends of flanks and on roundings, see `on_edge` [N].
        inner_load: on the bearing inside the drive in each zone, see `GearBody.inner_load` [N].
        slip_torque: sum of forces times their sliding arms: what a friction coefficient of one would
            hold at the driven coordinate [N m or N].
        residual: of the equilibrium, see `Equilibrium`.
        iterations: common to all states.
        of_teeth, of_gaps: parts of the wind-up by which the teeth yield, and by which gaps between them
            close beyond the first touch [rad or m].
        balls: approach of balls under the body of the teeth, see `OnBalls`; None where none hold it [m].
    """

    load: Each
    wind_up: Each
    touch: Each
    stiffness: Each
    loaded_pairs: Int[Array, "*b"]
    force: Float[Array, "pair slice *b"]
    share: Float[Array, "pair slice *b"]
    edge_load: Each
    inner_load: Float[Array, "zone *b"]
    slip_torque: Each
    residual: Each
    iterations: Int[Array, ""]
    of_teeth: Each
    of_gaps: Each
    balls: Float[Array, "ball *b"] | None


class Hysteresis(eqx.Module):
    """Branches of a loop of torque over wind-up.

    Attributes:
        wind_up: of the loaded member, from first touch [rad].
        loading, unloading: its torque while the wind-up grows, and while it shrinks [N m].

    From Coulomb's friction, see `hysteresis`.
    """

    wind_up: Each
    loading: Each
    unloading: Each


def wind_up(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Each,
    phase: Each,
    contacts: Contacts | None = None,
    body: Body | None = None,
) -> WindUp:
    """Movement of the driven coordinate at loads and phases, with the pairs that come to carry.

    Args:
        mesh: a family with teeth.
        loaded: one for the coordinate that carries the load, zero elsewhere.
        solids: material of each member.
        terms: of the model of tooth compliance.
        load: of the driven coordinate, not negative, broadcast against the phases [N m or N].
        phase: of the mesh [periods], as many axes as `load`.
        contacts: at these phases, where they are known already.
        body: see `GearBody.compliance`, where it is known already.

    Returns:
        NaN where no equilibrium was found. What yields is what `GearBody.yielding` says.

    From the equilibrium of its contacts, see `equilibrium`, and its derivative with respect to the load.
    """
    contacts = mesh.contacts(phase) if contacts is None else contacts
    arm = jnp.abs(contact_velocity(contacts.normal, loaded))
    load = jnp.broadcast_to(load, jnp.broadcast_shapes(jnp.shape(load), jnp.shape(phase)))
    given = {"arm": arm, "active": contacts.active}
    behind = sum(mesh.body.in_series(solids, loaded).values(), jnp.zeros(()))

    def approach(torque: Each) -> tuple[Each, tuple[Equilibrium, Arrays, Arrays]]:
        yields = compliance(mesh, loaded, contacts, solids, terms, torque, body)
        own, gap = yields.of_teeth(contacts), yields.gap(contacts)
        found = equilibrium(own, yields.body, gap=gap, **given, load=torque)
        return found.approach + behind * torque, (found, own, gap)

    # The springs themselves depend on the load where the contact of the teeth does.
    moved, slope, aux = jax.jvp(approach, (load,), (jnp.ones_like(load),), has_aux=True)
    found, own, gap = aux
    free = jnp.broadcast_to(touching_approach(gap, **given), moved.shape)
    closed = jnp.where(contacts.active, gap - arm * free, 0.0)
    slip = jnp.abs(contact_velocity(contacts.slip_arm, loaded))
    return WindUp(
        load=load,
        wind_up=moved - free,
        touch=free,
        stiffness=1.0 / slope,
        loaded_pairs=jnp.sum(of_pairs(mesh, jnp.any(found.loaded, axis=1) * 1.0) > 0.0, axis=0),
        edge_load=total(jnp.where(on_edge(mesh, contacts), found.force, 0.0)),
        force=found.force,
        share=found.share,
        inner_load=jnp.sum(mesh.body.inner_load(contacts) * found.force, axis=(1, 2)),
        slip_torque=total(found.force * slip),
        residual=found.residual,
        iterations=found.iterations,
        of_teeth=_over(total(found.force**2 * own), load),
        of_gaps=_over(total(found.force * closed), load),
        balls=found.balls,
    )


def _over(work: Each, load: Each) -> Each:
    """Movement that does this work under a load; none without it."""
    carries = load > 0.0
    # Safe in the branch that is not taken too: its derivative would be NaN, which no `where` takes away.
    return jnp.where(carries, work / jnp.where(carries, load, 1.0), 0.0)


@program
def body_parts(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    contacts: Contacts,
    found: WindUp,
) -> dict[str, Float[Array, "load *b"]]:
    """Parts of the wind-up by what lies under and behind the teeth, by name [rad or m].

    Args:
        mesh: a family with teeth.
        loaded: one for the coordinate that carries the load, zero elsewhere.
        solids: material of each member.
        contacts: of the mesh.
        found: wind-up at several loads, an axis in front, at all phases of these contacts.

    With those of the teeth and of their gaps they sum up to the wind-up: forces f move along C f, and the
    load along all of it.
    """

    def works(one: WindUp) -> dict[str, Each]:
        return mesh.body.parts(contacts, solids, one.force, one.balls)

    under = {part: _over(work, found.load) for part, work in jax.vmap(works)(found).items()}
    behind = {part: each * found.load for part, each in mesh.body.in_series(solids, loaded).items()}
    names = (*under, *(part for part in behind if part not in under))
    none = jnp.zeros(found.load.shape)
    return {part: under.get(part, none) + behind.get(part, none) for part in names}


@looping_program
def wound_up(
    mesh: Mesh,
    loaded: Float[Arrays, " dof"],
    solids: tuple[Solid, Solid],
    terms: Terms,
    load: Float[Array, ""],
    contacts: Contacts,
    body: Body | None,
) -> WindUp:
    """Wind-up at one torque at all phases of known contacts: one program for every torque and part of a run.

    Arguments and result as in `wind_up`.
    """
    loads = jnp.broadcast_to(load, contacts.path.shape[2:])
    return wind_up(mesh, loaded, solids, terms, loads, loads, contacts, body)


def hysteresis(
    found: WindUp,
    friction: float | Float[Array | np.ndarray, "*#b"],
    at_rest: float | Float[Array | np.ndarray, "*#b"] = 0.0,
) -> Hysteresis:
    """Loop of torque over wind-up by Coulomb friction on the teeth while the drive stands still.

    On loading, friction adds mu times the sum of forces times sliding arms to the torque that the
    same wind-up takes without it, and takes away as much on unloading. All flanks are taken to slide
    as soon as the sense turns, and forces to be those without friction, so the loop is right to
    first order in mu. The teeth hold nothing without load; bearings and seals may.

    Args:
        found: wind-up over torques.
        friction: coefficient mu of the teeth, broadcast over the states.
        at_rest: torque at the loaded member by which bearings and seals hold it [N m].

    From virtual work: friction slides by its arm while the loaded member turns by one.
    """
    held = friction * found.slip_torque + at_rest
    return Hysteresis(found.wind_up, found.load + held, found.load - held)
