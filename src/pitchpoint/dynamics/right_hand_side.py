"""Equations of motion of a mesh with friction: M q'' + C q' + K q + sum F (normal + mu tangent) = Q."""

from dataclasses import replace

import equinox as eqx
from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS, ContactLaw
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.moving_bodies import (
    Body,
    bearing_damping,
    bearing_forces,
    masses,
    moved_masses,
    on_all_coordinates,
)
from pitchpoint.dynamics.passage import Passage, on_springs
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import Mesh, has
from pitchpoint.lubrication.conditions import Conditions, evaluate

__all__ = [
    "WORKS",
    "ContactForces",
    "MovingMesh",
    "acceleration",
    "column",
    "conditions_at",
    "contact_forces",
    "forces_beside",
    "kinetic",
    "powers",
    "relaxation_time",
    "torques",
    "torques_beside_contacts",
]

Lanes = Float[Array, "pair slice *b"]
Each = Float[Array, "*b"]
Coordinates = Float[Array, "coordinate *b"]

STANDSTILL = 1e-12
"""Speed of the driver that counts as rest [rad/s]."""


WORKS = ("put_in", "error", "friction", "rolling", "damping", "drag", "pressed")
"""What `powers` tells, in its order; the names are those of `energy.Account`."""


class MovingMesh(eqx.Module):
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
        passage: contacts and their stiffness read from polynomials, which is quicker and takes the place
            of `stiffness`; those of the design if None.
        law: of the contact, with or without separation; static.
        backlash: free motion along the normal before back flanks meet [m]; infinite if never. These
            push through the same arms, without friction.
        error: moves the flanks apart, along the line of action of a family that has one and else along
            the normal; None without.
        mesh_damping: a damper along the line of action (else along the normal), whether flanks touch or
            not, which does not feel the error [N s/m].
        slowest: speed of the driver below which laws of friction, rolling and film are told the nominal
            motion at this one, positive [rad/s or m/s]: regressions of films have no value at rest.

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
    passage: Passage | None = None
    law: ContactLaw = eqx.field(static=True, default=CONTACT_LAWS["separating"])
    backlash: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.asarray(jnp.inf))
    error: ErrorOrders | None = None
    mesh_damping: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.asarray(0.0))
    slowest: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.asarray(STANDSTILL))

    @property
    def mass(self) -> Float[Array, " coordinate"]:
        """M, diagonal [kg m2 or kg]; infinite of what a prescribed speed holds."""
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
        force: normal force [N]; negative where a linear contact pulls or back flanks push.
        friction: coefficient.
        drawn: friction force on member 1 along the tangent [N].
        rolled: rolling resistance on each surface [N].
        closing: velocity at which the flanks approach, the error counted [m/s].
        moved: what the error adds to that [m/s].
        slip, roll: difference and sum of the surface velocities [m/s], the latter by the coordinates of the
            mesh alone.
        roll_arm: sum of the surface velocities for a unit rate of each of these: rolling resistance is a
            couple on each body, whose forces the pressure of the film balances.
        line: closing along the line of action, or along the normal, for a unit rate of each coordinate.
        damped: force of the damper along it [N].
        phase: of the mesh, counted on beyond a period [periods].
    """

    contacts: Contacts
    stiffness: Lanes
    stretch: Lanes
    elastic: Lanes
    force: Lanes
    friction: Lanes
    drawn: Lanes
    rolled: Lanes
    closing: Lanes
    moved: Lanes
    slip: Lanes
    roll: Lanes
    roll_arm: Float[Array, "coordinate pair slice *b"]
    line: Coordinates
    damped: Each
    phase: Each

    @property
    def lost(self) -> Lanes:
        """Power lost to sliding and rolling at each contact [W]."""
        return self.drawn * self.slip + self.rolled * self.roll

    @property
    def energy(self) -> Each:
        """Elastic energy of the contacts [J].

        From the work that stretches a spring; of back flanks behind the backlash.
        """
        springs = jnp.where(self.stiffness > 0.0, self.stiffness, 1.0)
        return total(self.elastic**2 / springs) / 2.0

    @property
    def on_coordinates(self) -> Coordinates:
        """Sum of F normal + mu F tangent: what holds the contacts on every coordinate [N m or N].

        Rolling resistance and the damper along the line of action count as well. From virtual work.
        """
        contacts = self.contacts
        pairs = (
            (self.force, contacts.normal),
            (self.drawn, contacts.slip_arm),
            (self.rolled, self.roll_arm),
        )
        of_contacts = sum((force * arm for force, arm in pairs), jnp.zeros(()))
        return jnp.sum(of_contacts, axis=(1, 2)) + self.damped * self.line


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


def contact_forces(moving: MovingMesh, place: Coordinates, rate: Coordinates) -> ContactForces:
    """Forces at the contacts in given places and at given rates; see `forces_beside`.

    Args:
        moving: mesh and bodies.
        place, rate: of all coordinates.
    """
    design = moving.design
    turned = _driving(moving, place)
    phase = moving.phase + design.onward / design.period * turned
    beside = place - column(moving.padded(design.motion), place) * turned
    return forces_beside(moving, _engaged(moving, phase), phase, beside, rate)


def forces_beside(
    moving: MovingMesh,
    engaged: tuple[Contacts, Lanes],
    phase: Each,
    beside: Coordinates,
    rate: Coordinates,
) -> ContactForces:
    """Forces at contacts that are known.

    The stretch is that of the way by which the bodies lie beside their nominal motion, which closes
    nothing; exact for involutes, whose arms along the normal are constant. A contact pushes with
    stiffness times (stretch + relaxation time times closing), and one that may part never pulls. Where
    it pushes on the front flanks it draws by the friction law at its own force and speeds, and brakes
    both surfaces by the rolling resistance. Laws for a whole mesh are told the force with friction.

    Args:
        moving: mesh and bodies.
        engaged: contacts on the coordinates of the mesh, and their stiffness.
        phase: of the mesh [periods].
        beside: place of all coordinates less that of the nominal motion.
        rate: of all coordinates.

    From a spring and a damper side by side, cut where together they would pull.
    """
    (of_mesh, springs), design = engaged, moving.design
    contacts = on_all_coordinates(of_mesh, design.mesh.coordinates, moving.bodies)
    leaning = _leaning(design.mesh, of_mesh)
    pace = design.onward / design.period * _driving(moving, rate)
    apart, parting = (leaning * value for value in _error(moving, phase, pace))
    stretch = _lanes(contacts.normal, beside) - contacts.gap - apart
    roll_arm = _on_mesh(of_mesh.roll_arm, contacts)
    closing, slip, roll = (
        _lanes(arm, rate) for arm in (contacts.normal, contacts.slip_arm, roll_arm)
    )
    pressed, force = _normal(moving, springs, stretch, closing - parting)
    conditions = conditions_at(moving, contacts, force, rate)
    friction = jnp.where(force > 0.0, moving.models.coefficient(conditions), 0.0)
    rolling = evaluate(moving.models.rolling, conditions) * contacts.weight
    line = contacts.normal[:, 0, 0] / leaning[0, 0]
    return ContactForces(
        contacts=contacts,
        stiffness=springs,
        stretch=stretch,
        elastic=springs * pressed,
        force=force,
        friction=friction,
        drawn=friction * force * jnp.tanh(slip / moving.creep),
        rolled=jnp.where(force > 0.0, rolling, 0.0) * jnp.tanh(roll / moving.creep),
        closing=closing - parting,
        moved=-parting,
        slip=slip,
        roll=roll,
        roll_arm=roll_arm,
        line=line,
        damped=moving.mesh_damping * jnp.sum(line * rate, axis=0),
        phase=phase,
    )


def torques(
    moving: MovingMesh, time: Each, place: Coordinates, rate: Coordinates, found: ContactForces
) -> Coordinates:
    """External torques and forces Q [N m or N], those that hold prescribed speeds among them.

    Arguments are those of `acceleration`.
    """
    external = _external(moving, time)
    missing = -_push(moving, external, place, rate, found)
    return external + jnp.where(jnp.isinf(column(moving.mass, missing)), missing, 0.0)


def torques_beside_contacts(moving: MovingMesh, rate: Coordinates) -> Coordinates:
    """External torques as given at the first knot, less the drag of the bodies [N m or N].

    Args:
        moving: mesh and bodies.
        rate: of all coordinates.
    """
    return _external(moving, moving.knots[0]) - _drag(moving, rate)


def acceleration(
    moving: MovingMesh, time: Each, place: Coordinates, rate: Coordinates, found: ContactForces
) -> Coordinates:
    """Accelerations q'' of all coordinates.

    Args:
        moving: mesh and bodies.
        time: [s].
        place, rate: of all coordinates.
        found: forces at the contacts there.

    From Newton's law on every coordinate, see the equation at the head of this module.
    """
    push = _push(moving, _external(moving, time), place, rate, found)
    return push / column(moving.mass, push)


def powers(
    moving: MovingMesh, time: Each, place: Coordinates, rate: Coordinates, found: ContactForces
) -> Float[Array, "7 *b"]:
    """Powers [W] of `WORKS`: put in by torques and by the error; lost; stored in contacts.

    Arguments are those of `acceleration`. Lost is what friction, rolling resistance, damping and drag
    take. The last one is what the bodies and the error do on the springs of the contacts.

    From force times velocity wherever a force acts.
    """
    held = jnp.tensordot(bearing_damping(moving.bodies), rate, 1)
    along_line = found.damped * jnp.sum(found.line * rate, axis=0)
    damped = total((found.force - found.elastic) * found.closing) + along_line
    return jnp.stack(
        [
            jnp.sum(torques(moving, time, place, rate, found) * rate, axis=0),
            total(found.force * found.moved),
            total(found.drawn * found.slip),
            total(found.rolled * found.roll),
            damped + jnp.sum(held * rate, axis=0),
            jnp.sum(_drag(moving, rate) * rate, axis=0),
            total(found.elastic * found.closing),
        ]
    )


def kinetic(moving: MovingMesh, rate: Coordinates) -> Each:
    """Kinetic energy of all bodies whose speed is not prescribed [J].

    From m v^2/2.
    """
    energy: Each = jnp.tensordot(moved_masses(moving.bodies), rate**2, axes=1) / 2.0
    return energy


def _driving(moving: MovingMesh, values: Coordinates) -> Each:
    """That of the driver, in its nominal sense."""
    design = moving.design
    of_driver: Each = jnp.tensordot(moving.padded(design.driver), values, axes=1)
    return of_driver * (design.driver @ design.motion)


def _engaged(moving: MovingMesh, phase: Each) -> tuple[Contacts, Lanes]:
    """Contacts of the mesh, and stiffness of each slice along its normal, zero out of contact [N/m]."""
    if moving.passage is not None:
        return moving.passage.at(phase)
    contacts = moving.design.mesh.contacts(phase)
    if moving.stiffness is not None:
        return contacts, jnp.where(contacts.active, moving.stiffness, 0.0)
    return on_springs(moving.design, contacts, moving.models.compliance, moving.operation.load)


def _leaning(mesh: Mesh, contacts: Contacts) -> Lanes:
    """Closing along the normal for a unit of closing along the line of action."""
    if not has(mesh, line_of_action):
        return jnp.ones_like(contacts.gap)
    action = line_of_action(mesh)
    return contact_velocity(contacts.normal, action) / jnp.sum(action**2)


def _on_mesh(arms: Float[Array, "dof pair slice *b"], contacts: Contacts) -> Array:
    """Arms on all coordinates, zero on the translations of bodies."""
    translations = contacts.normal.shape[0] - arms.shape[0]
    return jnp.pad(arms, ((0, translations), *((0, 0) for _ in arms.shape[1:])))


def _error(moving: MovingMesh, phase: Each, pace: Each) -> tuple[Each, Each]:
    """Separation by the error, and its rate."""
    if moving.error is None:
        return jnp.zeros_like(phase), jnp.zeros_like(phase)
    return moving.error.at(phase), moving.error.slope(phase) * pace


def _normal(
    moving: MovingMesh, springs: Lanes, stretch: Lanes, closing: Lanes
) -> tuple[Lanes, Lanes]:
    """Compression of the springs, and normal force."""
    pressed, touching = moving.law.function(stretch, moving.backlash)
    force = springs * (pressed + touching * moving.relaxation * closing)
    if moving.law.linear:
        return pressed, force
    pushes = jnp.where(pressed > 0.0, jnp.maximum(force, 0.0), jnp.minimum(force, 0.0))
    return pressed, pushes


def _external(moving: MovingMesh, time: Each) -> Coordinates:
    """External torques and forces at a time, as given."""
    knots = moving.knots
    every = [jnp.broadcast_to(body.torque, knots.shape) for body in moving.bodies]
    applied = [jnp.interp(time, knots, torque) for torque in every]
    still = [jnp.zeros_like(applied[0])] * (moving.mass.shape[0] - len(applied))
    return jnp.stack([*applied, *still])


def _push(
    moving: MovingMesh,
    external: Coordinates,
    place: Coordinates,
    rate: Coordinates,
    forces: ContactForces,
) -> Coordinates:
    """What is left of the external torques to accelerate the bodies."""
    bodies = moving.bodies
    held = bearing_forces(bodies, place, rate)
    return external - held - _drag(moving, rate) - forces.on_coordinates


def _drag(moving: MovingMesh, rate: Coordinates) -> Coordinates:
    """Torques against the motion of the bodies for themselves."""
    every = [
        body.resistance * jnp.tanh(speed / body.creep) + body.viscous * speed
        for body, speed in zip(moving.bodies, rate, strict=False)
    ]
    still = [jnp.zeros_like(every[0])] * (rate.shape[0] - len(every))
    return jnp.stack([*every, *still])


def conditions_at(
    moving: MovingMesh, contacts: Contacts, force: Lanes, rate: Coordinates
) -> Conditions:
    """What laws of friction, rolling and film are told, at the forces and rates of the moment.

    Args:
        moving: mesh and bodies.
        contacts: with arms on all coordinates.
        force: normal force of each slice [N]; laws are told 1 N where nothing carries.
        rate: of all coordinates.
    """
    driving = _driving(moving, rate)
    slow = jnp.abs(driving) < moving.slowest
    lifted = rate + column(moving.padded(moving.design.motion), rate) * jnp.where(
        slow, moving.slowest - driving, 0.0
    )
    point = replace(moving.operation, speed=jnp.maximum(jnp.abs(driving), moving.slowest))
    return moving.design.conditions(
        contacts, point, load=_or_one(force), nominal_load=_or_one(total(force)), rates=lifted
    )


def _or_one(force: Float[Array, "..."]) -> Float[Array, "..."]:
    """Force, or 1 N where nothing carries: laws divide by it and take powers."""
    return jnp.where(force > 0.0, force, 1.0)


def _lanes(arms: Float[Array, "coordinate pair slice *b"], values: Coordinates) -> Lanes:
    """Sum of arms times values of the coordinates at each contact."""
    return jnp.sum(arms * values[:, None, None], axis=0)


def column(values: Float[Array, " coordinate"], like: Float[Array, "..."]) -> Float[Array, "..."]:
    """Values along the first axis of others, to go with all of these.

    Args:
        values: of the coordinates.
        like: with the same number of axes behind its first one.
    """
    return values.reshape(-1, *[1] * (like.ndim - 1))
