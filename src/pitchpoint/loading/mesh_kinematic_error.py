"""Kinematic error of a mesh: what deviations of the teeth around both members do to its motion."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.contact.surface import Spot, Surfaces, missing
from pitchpoint.loading.compliance import Compliance
from pitchpoint.loading.equilibrium import Equilibrium, equilibrium, touching_approach

__all__ = ["KinematicError", "added_gap", "kinematic_error"]

Each = Float[Array, "*#b"]
Lanes = Float[Array, "pair slice *#b"]


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


def added_gap(deviations: Surfaces, spots: tuple[Spot, Spot]) -> Lanes:
    """What the deviations of both members add to the separation of their flanks [m].

    Args:
        deviations: of both members.
        spots: where the contacts lie on them, see `Mesh.spots`.
    """
    first, second = (missing(own, spot) for own, spot in zip(deviations, spots, strict=True))
    return first + second


def kinematic_error(contacts: Contacts, yields: Compliance, added: Lanes) -> KinematicError:
    """Rotation of the loaded member by deviations: of rigid teeth, their elastic mean, and under load.

    It is positive in the sense of the load, so where material is missing the loaded member lies back.
    The elastic mean is the sum of (dF/dT) e over the slices, with added gaps e and the forces F that
    a small change of the load T adds: without clearances they share it like the load itself. It is
    the limit for deviations that are small against what the teeth yield. Under load the equilibrium
    with the added gaps is compared with that without them: pairs may leave it or join it.

    Args:
        contacts: of the mesh; those of one period serve all teeth, with an axis of length one for them.
        yields: how the pairs yield, and the load of the loaded member.
        added: separation of the flanks by deviations [m].

    Returns:
        NaN where no equilibrium was found.

    From virtual work: forces that balance a unit of the load do as much work on the added gaps as it
    does on the rotation.

    From virtual work of the forces that a unit of the load adds.
    """
    teeth = yields.of_teeth(contacts)
    given = {
        "arm": jnp.abs(contact_velocity(contacts.normal, yields.loaded)),
        "active": contacts.active,
    }

    gaps = yields.gap(contacts)

    def under(gap: Lanes, load: Each) -> Equilibrium:
        return equilibrium(teeth, yields.body, gap=gap, load=load, **given)

    def plainly(load: Each) -> tuple[Lanes, Equilibrium]:
        found = under(gaps, load)
        return found.force, found

    load = yields.load
    _, more, plain = jax.jvp(plainly, (load,), (jnp.ones_like(load),), has_aux=True)
    deviating = under(gaps + added, load)
    return KinematicError(
        geometric=touching_approach(gaps + added, **given) - touching_approach(gaps, **given),
        elastic_mean=total(more * added),
        under_load=deviating.approach - plain.approach,
        wind_up=plain.approach,
    )
