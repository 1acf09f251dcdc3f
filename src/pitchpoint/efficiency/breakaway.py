"""Torque that holds bearings and seals at rest beyond their friction in motion, by named models."""

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["dry_and_viscous", "none"]

REFERENCE_VISCOSITY = 100e-6
"""Kinematic viscosity at which the viscous part of the breakaway torque is stated [m2/s]."""


def none(*, mean_diameter: ArrayLike, kinematic_viscosity: ArrayLike) -> Float[Array, ""]:
    """Nothing holds the bodies beyond their friction in motion [N m]."""
    return jnp.asarray(0.0)


def dry_and_viscous(
    *,
    mean_diameter: ArrayLike,
    kinematic_viscosity: ArrayLike,
    dry: ArrayLike,
    viscous: ArrayLike,
    preload: ArrayLike,
) -> Float[Array, "..."]:
    """Breakaway torque T = d_m^2 (dry preload + viscous (nu / nu_ref)^(2/3)), nu_ref = 100 mm2/s.

    The dry part stands for preloaded races and the lips of seals, and knows no viscosity; the other one
    for the lubricant that is to be sheared.

    Args:
        mean_diameter: of bearing or lip d_m, shape (...) [m].
        kinematic_viscosity: of the oil, or of the base oil of a grease, nu, shape (...) [m2/s].
        dry: torque over the square of the diameter at a preload of 1, shape (...) [N/m].
        viscous: the same of the lubricant at nu_ref, shape (...) [N/m].
        preload: over that to which `dry` belongs, shape (...).

    Returns:
        Breakaway torque, shape (...) [N m].

    Validity:
        An assumption: the square is about how starting torques of catalogues grow with the size at
        equal proportions, the power of the viscosity that of the torque in motion by Palmgren 1959.
        The stiffening of a grease by its thickener in the cold is not in it.

    Example:
        >>> torque = dry_and_viscous(
        ...     mean_diameter=0.06, kinematic_viscosity=800e-6, dry=15.0, viscous=5.0, preload=2.0
        ... )
        >>> round(float(torque), 6)
        0.18
    """
    thicker = jnp.asarray(kinematic_viscosity) / REFERENCE_VISCOSITY
    held = jnp.asarray(dry) * preload + jnp.asarray(viscous) * jnp.exp(2.0 / 3.0 * jnp.log(thicker))
    return held * jnp.asarray(mean_diameter) ** 2
