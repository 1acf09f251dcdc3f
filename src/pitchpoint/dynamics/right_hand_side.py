"""Equations of motion of a mesh with friction: M q'' + C q' + K q + sum F (normal + mu tangent) = Q."""

from dataclasses import replace

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, total
from pitchpoint.dynamics.bodies import Body, damping, masses, on_all_coordinates, stiffness
from pitchpoint.dynamics.contact_law import separating
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.loading.compliance import compliance

__all__ = [
    "ContactForces",
    "Moving",
    "acceleration",
    "contact_forces",
    "external",
    "powers",
    "relaxation_time",
]

Lanes = Float[Array, "pair slice *b"]
Each = Float[Array, "*b"]
Coordinates = Float[Array, "coordinate *b"]

STANDSTILL = 1e-12
"""Speed of the driver below which laws of friction are told this one [rad/s]."""


class Moving(eqx.Module):
    """A mesh and its bodies as they move.

    Coordinates q are those of the mesh, then the translations that bearings allow, body by body.

    Attributes:
        design: mesh, materials, oil, surfaces.
        operation: the load at which the stiffness of the contacts is taken, and the temperature of the
            oil; its speed is not asked for.
        models: the friction law and how teeth yield; pairs share the load as they yield, whatever the
            model of sharing.
        bodies: one for each coordinate of the mesh.
        knots: times of the external torques [s].
        phase: of the mesh at q = 0 [periods].
        creep: sliding speed at which 76 % of the friction is reached, mu F tanh(sliding/creep) [m/s].
        relaxation: damping over stiffness of each contact [s], see `relaxation_time`.
        stiffness: of each contact [N/m]; that of the teeth if None.

    From Coulomb's friction, made smooth about rest by tanh.
    """

    design: Design
    operation: Operation
    models: Models
    bodies: tuple[Body, ...] = eqx.field(converter=tuple)
    knots: Float[Array, " knot"]
    phase: Float[Array, ""]
    creep: Float[Array, ""]
    relaxation: Float[Array, ""]
    stiffness: Float[Array, ""] | None = None

    @property
    def mass(self) -> Float[Array, " coordinate"]:
        """M, diagonal [kg m2 or kg]."""
        return masses(self.bodies)

    def padded(self, values: Float[Array, " dof"]) -> Float[Array, " coordinate"]:
        """Values on the coordinates of the mesh, zero on the translations."""
        return jnp.pad(values, (0, self.mass.shape[0] - values.shape[0]))


class ContactForces(eqx.Module):
    """What acts at the contacts.

    Attributes:
        contacts: with arms on all coordinates.
        stiffness: of each slice along its normal [N/m]; zero out of contact.
        stretch: how far the flanks are pressed together; negative where they part [m].
        elastic: part of the normal force that is stiffness times stretch [N].
        force: normal force [N].
        friction: coefficient.
        drawn: friction force on member 1 along the tangent [N].
        closing, slip: velocities of the members against each other [m/s].
        phase: of the mesh, counted on beyond a period [periods].
    """

    contacts: Contacts
    stiffness: Lanes
    stretch: Lanes
    elastic: Lanes
    force: Lanes
    friction: Lanes
    drawn: Lanes
    closing: Lanes
    slip: Lanes
    phase: Each

    @property
    def energy(self) -> Each:
        """Elastic energy of the contacts [J].

        From the work that stretches a spring.
        """
        return total(self.elastic * self.stretch) / 2.0

    @property
    def on_coordinates(self) -> Coordinates:
        """Sum of F normal + mu F tangent: what holds the contacts on every coordinate [N m or N].

        From virtual work.
        """
        arms = self.contacts.normal, self.contacts.slip_arm
        return jnp.sum(self.force * arms[0] + self.drawn * arms[1], axis=(1, 2))


def relaxation_time(ratio: ArrayLike, mass: ArrayLike, stiffness: ArrayLike) -> Float[Array, "..."]:
    """Damping over stiffness of a contact that damps what vibrates on it by a ratio [s].

    c/k = 2 xi sqrt(m/k), as c = 2 xi sqrt(m k).

    Args:
        ratio: damping ratio xi.
        mass: that vibrates, see `system.reduced_mass` [kg].
        stiffness: of the mesh [N/m].

    Source: Atanasiu et al. (2011), eq. 12.

    Example:
        >>> round(1e6 * float(relaxation_time(0.05, 1.0, 4e8)), 6)
        5.0
    """
    return 2.0 * jnp.asarray(ratio) * jnp.sqrt(jnp.asarray(mass) / stiffness)


def contact_forces(moving: Moving, place: Coordinates, rate: Coordinates) -> ContactForces:
    """Forces at the contacts in given places and at given rates.

    The stretch is that of the way by which the bodies lie beside their nominal motion, which closes
    nothing; exact for involutes, whose arms along the normal are constant. A contact pushes with
    stiffness times (stretch + relaxation time times closing), never pulls, and draws by the friction law
    at its own force and speeds. Laws for a whole mesh are told the force with friction.

    Args:
        moving: mesh and bodies.
        place, rate: of all coordinates.

    From a spring and a damper side by side, cut where together they would pull.
    """
    mesh = moving.design.mesh
    turned = jnp.tensordot(moving.padded(mesh.driver), place, axes=1) * (mesh.driver @ mesh.motion)
    phase = moving.phase + mesh.onward / mesh.period * turned
    own = mesh.contacts(phase)
    contacts = on_all_coordinates(own, mesh.coordinates, moving.bodies)
    springs = _springs(moving, own)
    beside = place - _column(moving.padded(mesh.motion), place) * turned
    stretch = _lanes(contacts.normal, beside) - contacts.gap
    closing, slip = _lanes(contacts.normal, rate), _lanes(contacts.slip_arm, rate)
    pressed, touching = separating(stretch, jnp.asarray(jnp.inf))
    force = jnp.maximum(springs * (pressed + touching * moving.relaxation * closing), 0.0)
    friction = _friction(moving, contacts, force, rate)
    return ContactForces(
        contacts=contacts,
        stiffness=springs,
        stretch=stretch,
        elastic=springs * pressed,
        force=force,
        friction=friction,
        drawn=friction * force * jnp.tanh(slip / moving.creep),
        closing=closing,
        slip=slip,
        phase=phase,
    )


def external(moving: Moving, time: Each) -> Coordinates:
    """External torques and forces Q at a time [N m or N]."""
    knots = moving.knots
    torques = [jnp.broadcast_to(body.torque, knots.shape) for body in moving.bodies]
    given = [jnp.interp(time, knots, torque) for torque in torques]
    still = [jnp.zeros_like(given[0])] * (moving.mass.shape[0] - len(given))
    return jnp.stack([*given, *still])


def acceleration(
    moving: Moving, time: Each, place: Coordinates, rate: Coordinates, found: ContactForces
) -> Coordinates:
    """Accelerations q'' of all coordinates.

    Args:
        moving: mesh and bodies.
        time: [s].
        place, rate: of all coordinates.
        found: forces at the contacts there.

    From Newton's law on every coordinate, see the equation at the head of this module.
    """
    bodies = moving.bodies
    held = stiffness(bodies) @ place + damping(bodies) @ rate + _drag(moving, rate)
    push = external(moving, time) - held - found.on_coordinates
    return push / _column(moving.mass, push)


def powers(
    moving: Moving, time: Each, rate: Coordinates, found: ContactForces
) -> Float[Array, "5 *b"]:
    """Powers [W] put in by the torques; lost to friction, to damping and to drag; stored in contacts.

    Arguments are those of `acceleration`. The last one is what the bodies do on the springs of the
    contacts.

    From force times velocity wherever a force acts.
    """
    held = damping(moving.bodies) @ rate
    damped = total((found.force - found.elastic) * found.closing)
    return jnp.stack(
        [
            jnp.sum(external(moving, time) * rate, axis=0),
            total(found.drawn * found.slip),
            damped + jnp.sum(held * rate, axis=0),
            jnp.sum(_drag(moving, rate) * rate, axis=0),
            total(found.elastic * found.closing),
        ]
    )


def _drag(moving: Moving, rate: Coordinates) -> Coordinates:
    """Torques against the motion of the bodies for themselves."""
    every = [
        body.resistance * jnp.tanh(own / body.creep) + body.viscous * own
        for body, own in zip(moving.bodies, rate, strict=False)
    ]
    still = [jnp.zeros_like(every[0])] * (rate.shape[0] - len(every))
    return jnp.stack([*every, *still])


def _springs(moving: Moving, contacts: Contacts) -> Lanes:
    """Stiffness of each slice along its normal, zero out of contact [N/m]."""
    if moving.stiffness is not None:
        return jnp.where(contacts.active, moving.stiffness, 0.0)
    design, load = moving.design, moving.operation.load
    yields = compliance(design.mesh, contacts, design.solids, moving.models.compliance, load)
    return jnp.where(contacts.active, 1.0 / yields.of_teeth(contacts), 0.0)


def _friction(moving: Moving, contacts: Contacts, force: Lanes, rate: Coordinates) -> Lanes:
    """Friction coefficient of each slice by the law, at the forces and rates of the moment."""
    driving = jnp.abs(jnp.tensordot(moving.padded(moving.design.mesh.driver), rate, axes=1))
    point = replace(moving.operation, speed=jnp.maximum(driving, STANDSTILL))
    carries = force > 0.0
    conditions = moving.design.conditions(
        contacts, point, load=_or_one(force), nominal_load=_or_one(total(force)), rates=rate
    )
    return jnp.where(carries, moving.models.coefficient(conditions), 0.0)


def _or_one(force: Float[Array, "..."]) -> Float[Array, "..."]:
    """Force, or 1 N where nothing carries: laws divide by it and take powers."""
    return jnp.where(force > 0.0, force, 1.0)


def _lanes(arms: Float[Array, "coordinate pair slice *b"], values: Coordinates) -> Lanes:
    """Sum of arms times values of the coordinates at each contact."""
    return jnp.sum(arms * values[:, None, None], axis=0)


def _column(
    values: Float[Array, " coordinate"], like: Coordinates
) -> Float[Array, "coordinate ..."]:
    """Values along the first axis of others, to go with all of these."""
    return values.reshape(-1, *[1] * (like.ndim - 1))
