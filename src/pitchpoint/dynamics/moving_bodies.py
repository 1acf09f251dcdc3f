"""Bodies of a drive as they move: what accelerates, holds and brakes them, on all their coordinates."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.errors import InputError
from pitchpoint.gears.coordinates import Coordinate
from pitchpoint.materials._leaves import float64_array

__all__ = [
    "Body",
    "Support",
    "bearing_damping",
    "bearing_forces",
    "bearing_stiffness",
    "masses",
    "motor",
    "moved_masses",
    "on_all_coordinates",
    "radial_bearings",
]

Matrix = Float[Array, "coordinate coordinate"]


class Support(eqx.Module):
    """Bearings of a body that yield, and so add translations to its coordinates.

    Attributes:
        mass: of the body [kg].
        ways: unit vectors along which it may shift, at right angles to each other, in the frame of the
            mesh.
        stiffness: of all its bearings together, symmetric [N/m].
        damping: likewise [N s/m].
    """

    mass: Float[Array, ""] = eqx.field(converter=float64_array)
    ways: Float[Array, "way 3"] = eqx.field(converter=float64_array)
    stiffness: Float[Array, "way way"] = eqx.field(converter=float64_array)
    damping: Float[Array, "way way"] = eqx.field(converter=float64_array)


class Body(eqx.Module):
    """What moves with one coordinate of a mesh.

    Attributes:
        inertia: about its axis [kg m2], or mass of a body that travels [kg]; infinite for one whose speed
            is prescribed: it keeps the rate that it starts with, and the torque for that is a result.
        torque: external one, or those at the knots of time, straight between them and constant beyond
            [N m or N].
        resistance: torque against its motion, the same at every speed but for slow ones [N m or N].
        creep: speed at which 76 % of the resistance is reached, R tanh(speed/creep) [rad/s or m/s].
        viscous: torque against its motion over the speed [N m s or N s/m].
        support: bearings that yield; held across its axis if None.

    From Coulomb's friction, made smooth about rest by tanh.
    """

    inertia: Float[Array, ""] = eqx.field(converter=float64_array)
    torque: Float[Array, " knot"] = eqx.field(converter=float64_array, default=(0.0,))
    resistance: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    creep: Float[Array, ""] = eqx.field(converter=float64_array, default=1e-3)
    viscous: Float[Array, ""] = eqx.field(converter=float64_array, default=0.0)
    support: Support | None = None


def motor(*, stall_torque: float, no_load_speed: float, inertia: float) -> Body:
    """A motor whose torque falls in proportion to its speed, from stall to none at the no-load speed.

    What its torque falls short of that at stall counts as drag in the energy.

    Args:
        stall_torque: at rest, with the sign of its motion [N m].
        no_load_speed: without sign, positive [rad/s].
        inertia: of all that turns with it [kg m2].

    Raises:
        InputError: the no-load speed is not positive.

    From a straight line of torque over speed.

    Example:
        >>> body = motor(stall_torque=-6.0, no_load_speed=300.0, inertia=1e-3)
        >>> float(body.torque[0]), float(body.viscous)
        (-6.0, 0.02)
    """
    if not no_load_speed > 0.0:
        raise InputError(f"no-load speed of a motor is above 0 rad/s, got {no_load_speed:g}")
    viscous = abs(stall_torque) / no_load_speed
    return Body(
        float64_array(inertia), float64_array([stall_torque]), viscous=float64_array(viscous)
    )


def radial_bearings(mass: float, stiffness: float, damping: float = 0.0) -> Support:
    """Bearings of a gear that yield alike in all directions across its axis.

    Args:
        mass: of the gear [kg].
        stiffness: of its bearings together [N/m].
        damping: likewise [N s/m].
    """
    plane = jnp.eye(2)
    return Support(float64_array(mass), jnp.eye(3)[:2], stiffness * plane, damping * plane)


def masses(bodies: Sequence[Body]) -> Float[Array, " coordinate"]:
    """Inertia or mass on every coordinate, M: those of the mesh, then translations body by body."""
    moved = [jnp.full(held.ways.shape[0], held.mass) for _, held in _supports(bodies)]
    return jnp.concatenate([jnp.stack([body.inertia for body in bodies]), *moved])


def moved_masses(bodies: Sequence[Body]) -> Float[Array, " coordinate"]:
    """The same, zero where the speed is prescribed: what has kinetic energy that may change."""
    every = masses(bodies)
    return jnp.where(jnp.isinf(every), 0.0, every)


def bearing_stiffness(bodies: Sequence[Body]) -> Matrix:
    """Stiffness of the bearings on all coordinates, K [N/m]."""
    return _assembled(bodies, [held.stiffness for _, held in _supports(bodies)])


def bearing_damping(bodies: Sequence[Body]) -> Matrix:
    """Damping of the bearings on all coordinates, C [N s/m]."""
    return _assembled(bodies, [held.damping for _, held in _supports(bodies)])


def bearing_forces(
    bodies: Sequence[Body],
    place: Float[Array, "coordinate *b"],
    rate: Float[Array, "coordinate *b"],
) -> Float[Array, "coordinate *b"]:
    """Forces on bearings that yield, zero on the coordinates of the mesh [N].

    Args:
        bodies: of all coordinates.
        place, rate: of all coordinates.

    From springs and dampers side by side.
    """
    return jnp.tensordot(bearing_stiffness(bodies), place, 1) + jnp.tensordot(
        bearing_damping(bodies), rate, 1
    )


def on_all_coordinates(
    contacts: Contacts, coordinates: Sequence[Coordinate], bodies: Sequence[Body]
) -> Contacts:
    """The contacts with arms on the translations of bodies behind those of the mesh.

    A body that shifts along e closes its contacts by e times the normal out of it, and its surface
    slides by e times the tangent. The contact itself is taken to stay: sliding is exact, and the
    entrainment leaves out that it moves along with the bodies. Arms are those of the undeformed place.

    Args:
        contacts: of a mesh.
        coordinates: of the mesh.
        bodies: one for each of them.

    From the kinematics of rigid bodies.
    """
    normal, surface = [contacts.normal], [contacts.surface]
    for number, held in _supports(bodies):
        closing, sliding = _arms(contacts, coordinates[number].member, held)
        normal.append(closing)
        surface.append(sliding)
    return replace(
        contacts, normal=jnp.concatenate(normal), surface=jnp.concatenate(surface, axis=1)
    )


def _arms(
    contacts: Contacts, member: int | None, held: Support
) -> tuple[Float[Array, "way pair slice *b"], Float[Array, "member way pair slice *b"]]:
    """Closing by a unit of each translation, and velocity of each member's surface."""
    closing, sliding = (
        jnp.tensordot(held.ways, vector, axes=1)
        for vector in (contacts.direction, contacts.tangent)
    )
    if member is None:
        return 0.0 * closing, jnp.stack([0.0 * sliding, 0.0 * sliding])
    on_member = jnp.arange(2) == member
    outwards = 1.0 if member == 0 else -1.0
    return outwards * closing, jnp.where(on_member.reshape(2, *[1] * sliding.ndim), sliding, 0.0)


def _supports(bodies: Sequence[Body]) -> Iterator[tuple[int, Support]]:
    """Bearings that yield, with the number of their body."""
    for number, body in enumerate(bodies):
        if body.support is not None:
            yield number, body.support


def _assembled(bodies: Sequence[Body], blocks: Sequence[Array]) -> Matrix:
    turning = jnp.zeros((len(bodies), len(bodies)))
    matrix: Matrix = jax.scipy.linalg.block_diag(turning, *blocks)
    return matrix
