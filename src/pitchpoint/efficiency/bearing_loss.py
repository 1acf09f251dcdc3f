"""Friction torque of rolling bearings, by named models."""

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["none", "palmgren_1959"]


def none(
    *, speed: ArrayLike, load: ArrayLike, kinematic_viscosity: ArrayLike, mean_diameter: ArrayLike
) -> Float[Array, ""]:
    """No friction in the bearing [N m]."""
    return jnp.asarray(0.0)


def palmgren_1959(
    *,
    speed: ArrayLike,
    load: ArrayLike,
    kinematic_viscosity: ArrayLike,
    mean_diameter: ArrayLike,
    f0: ArrayLike,
    f1: ArrayLike,
) -> Float[Array, "..."]:
    """Friction torque of a rolling bearing, M0 of the lubricant and M1 = f1 F d_m of the load.

    M0 = 1e-7 f0 (nu n)^(2/3) d_m^3 N mm from nu n = 2000 upwards and 160e-7 f0 d_m^3 N mm below, with
    nu in mm2/s, n in revolutions per minute and d_m in mm. The two differ by 0.8 % where they meet.

    Args:
        speed: of one ring against the other, its sign does not matter, shape (...) [rad/s].
        load: on the bearing F, shape (...) [N].
        kinematic_viscosity: of the oil, or of the base oil of a grease, nu, shape (...) [m2/s].
        mean_diameter: of bore and outside d_m, shape (...) [m].
        f0: factor of the lubricant; depends on type of bearing and way of lubrication, shape (...).
        f1: factor of the load; depends on type of bearing and relative load, shape (...).

    Returns:
        Friction torque M0 + M1, shape (...) [N m].

    Validity:
        Moderate loads and speeds, bearings without contact seals. At rest the lower value of M0
        stays. The book was not at hand: form and coefficients are as later publications and
        programs agree to give them; they state no range of fit.

    Source:
        Palmgren 1959.

    Example:
        >>> torque = palmgren_1959(
        ...     speed=104.72, load=500.0, kinematic_viscosity=32e-6, mean_diameter=0.05, f0=2.0, f1=1e-3
        ... )
        >>> round(float(torque), 4)
        0.0502
    """
    product = jnp.asarray(kinematic_viscosity) * 1e6 * jnp.abs(speed) * (60.0 / (2.0 * jnp.pi))
    viscous = product >= 2000.0
    power = jnp.exp(2.0 / 3.0 * jnp.log(jnp.where(viscous, product, 2000.0)))
    diameter = jnp.asarray(mean_diameter)
    lubricant = 1e-10 * jnp.asarray(f0) * jnp.where(viscous, power, 160.0) * (diameter * 1e3) ** 3
    return lubricant + jnp.asarray(f1) * load * diameter
