"""Deviations of the teeth around both members of a strain-wave gear, and the kinematic error by them."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.clearances import Shared, shared_load
from pitchpoint.loading.yielding import Yielding

__all__ = ["Deviations", "KinematicError", "added_gap", "kinematic_error", "leaning"]

Each = Float[Array, "*#b"]
Lanes = Float[Array, "pair slice *#b"]


class Deviations(eqx.Module):
    """How far the flanks of one member lie behind their places, as waves around it.

    Attributes:
        order: waves around the member; 1 is an eccentricity.
        amplitude: along the normal of the flank [m].
        phase: angle of each wave where the member's angle is zero [rad].
    """

    order: Float[Array, " wave"]
    amplitude: Float[Array, " wave"]
    phase: Float[Array, " wave"]

    def at(self, angle: Float[Array, "..."]) -> Float[Array, "..."]:
        """Deviation at angles around the member [m]; positive where material is missing.

        Args:
            angle: of a tooth around the member [rad].
        """
        turn = self.order * angle[..., None] + self.phase
        return jnp.sum(self.amplitude * jnp.cos(turn), axis=-1)


class KinematicError(eqx.Module):
    """Rotation of the loaded member at phases `*b` by deviations of the teeth.

    Attributes:
        geometric: of rigid teeth without load: rotation to first touch with deviations, less that
            without them [rad].
        elastic_mean: mean of the deviations over the pairs that carry [rad].
        under_load: what deviations add to the rotation under load, with the pairs that then carry
            [rad].
        wind_up: rotation under load without deviations; its changes with the phase are the part of
            the transmission error that the mesh itself has [rad].
    """

    geometric: Each
    elastic_mean: Each
    under_load: Each
    wind_up: Each


def added_gap(
    deviations: tuple[Deviations, Deviations], place: Float[Array, "member pair slice *b"]
) -> Lanes:
    """What the deviations of both members add to the separation of their flanks [m].

    Args:
        deviations: of flexspline and circular spline.
        place: angles around them, see `Mesh.places` [rad].
    """
    return deviations[0].at(place[0]) + deviations[1].at(place[1])


def leaning(mesh: Mesh, contacts: Contacts) -> Lanes:
    """Part of a tooth's displacement that counts along the normal of its contact.

    It is one where the flank stands upright most, and less on roundings of root and tip: a tooth
    that lies behind its place moves along the circumference, and their normals lean to the radius.

    Args:
        mesh: a family whose member 0 is a thin ring.
        contacts: of the mesh.

    Raises:
        InputError: the mesh has no ring.
    """
    loads = mesh.ring_loads(contacts)
    if loads is None:
        raise InputError("deviations around both members ask for a strain-wave gear")
    across = jnp.where(contacts.active, jnp.abs(loads.tangential), 0.0)
    return across / jnp.max(across)


def kinematic_error(
    contacts: Contacts, yields: Yielding, loaded: Float[Array, " dof"], added: Lanes
) -> KinematicError:
    """Rotation of the loaded member by deviations: of rigid teeth, their elastic mean, and under load.

    It is positive in the sense of the load, so where material is missing the loaded member lies back.
    The elastic mean is the sum of (dF/dT) e over the slices, with added gaps e and the forces F that
    a small change of the load T adds: without clearances they share it like the load itself. It is
    the limit for deviations that are small against what the teeth yield. Under load the equilibrium
    with the added gaps is compared with that without them: pairs may leave it or join it.

    Args:
        contacts: of the mesh; those of one period serve all teeth, with an axis of length one for them.
        yields: how the pairs yield, and the load of the loaded member.
        loaded: one for that member.
        added: separation of the flanks by deviations [m].

    Returns:
        NaN where no equilibrium was found.
    """
    compliance = yields.compliance(contacts)
    arm = jnp.abs(along(contacts.normal, loaded))

    def under(gap: Lanes, load: Each) -> Shared:
        given = {"gap": gap, "arm": arm, "active": contacts.active}
        return shared_load(compliance, **given, load=load)

    def plainly(load: Each) -> tuple[Lanes, Shared]:
        found = under(contacts.gap, load)
        return found.force, found

    def touch(gap: Lanes) -> Each:
        touches = contacts.active & (arm > 0.0)
        return jnp.min(jnp.where(touches, gap / jnp.where(touches, arm, 1.0), jnp.inf), axis=(0, 1))

    load = yields.load
    _, more, plain = jax.jvp(plainly, (load,), (jnp.ones_like(load),), has_aux=True)
    deviating = under(contacts.gap + added, load)
    return KinematicError(
        geometric=touch(contacts.gap + added) - touch(contacts.gap),
        elastic_mean=total(more * added),
        under_load=deviating.approach - plain.approach,
        wind_up=plain.approach,
    )
