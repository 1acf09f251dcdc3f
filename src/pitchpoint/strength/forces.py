"""Forces between the teeth of a cylindrical pair, without friction."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Numbers

__all__ = ["ToothForces", "tooth_forces"]

Each = Float[Numbers, "*#b"]
Found = Float[Array, "..."]


class ToothForces(eqx.Module):
    """Forces on the teeth, in magnitude [N]; those on both gears are opposite.

    Attributes:
        reference: F_t, tangential to the reference circles.
        tangential: F_tw, tangential to the pitch circles in operation.
        radial: F_r, along the line of centres.
        axial: F_a, along the axes.
        normal: F_n, along the normal of the flanks.

    From the balance of forces on a gear, see `tooth_forces`.
    """

    reference: Found
    tangential: Found
    radial: Found
    axial: Found
    normal: Found


def tooth_forces(
    *,
    reference: Each,
    radius_ratio: Each,
    transverse_pressure_angle: Each,
    working_pressure_angle: Each,
    helix_angle: Each,
    base_helix_angle: Each,
) -> ToothForces:
    """Forces of a pair without friction from the one at the reference circles.

    Args:
        reference: F_t, torque over the reference radius of the same gear, shape (...) [N].
        radius_ratio: reference radius over that of the pitch circle in operation, r/r_w, shape (...) [1].
        transverse_pressure_angle: alpha_t, shape (...) [rad].
        working_pressure_angle: alpha_wt, shape (...) [rad].
        helix_angle: beta on the reference cylinders, shape (...) [rad].
        base_helix_angle: beta_b, shape (...) [rad].

    Returns:
        Forces, broadcast shape of the arguments.

    From the balance of forces on a gear: F_tw = F_t r/r_w, F_r = F_tw tan(alpha_wt), F_a = F_t tan(beta),
    F_n = F_t/(cos(alpha_t) cos(beta_b)).

    Example:
        >>> from math import radians
        >>> angle = radians(20.0)
        >>> forces = tooth_forces(reference=1000.0, radius_ratio=1.0, transverse_pressure_angle=angle,
        ...     working_pressure_angle=angle, helix_angle=0.0, base_helix_angle=0.0)
        >>> round(float(forces.radial), 1), round(float(forces.axial), 1), round(float(forces.normal), 1)
        (364.0, 0.0, 1064.2)
    """
    tangential = jnp.asarray(reference) * radius_ratio
    return ToothForces(
        reference=jnp.asarray(reference),
        tangential=tangential,
        radial=tangential * jnp.tan(working_pressure_angle),
        axial=reference * jnp.tan(helix_angle),
        normal=reference / (jnp.cos(transverse_pressure_angle) * jnp.cos(base_helix_angle)),
    )
