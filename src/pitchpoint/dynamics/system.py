"""Equations of motion of a mesh: mass, damping and load on its coordinates."""

import equinox as eqx
from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.factored import Arrays

__all__ = ["System", "modal_damping", "reduced_mass"]

Matrix = Float[Array, "coordinate coordinate"]
Vector = Float[Array, " coordinate"]


class System(eqx.Module):
    """M q'' + C q' + sum over pairs of (arm, force) = f.

    Attributes:
        mass: symmetric, positive definite [kg or kg m2].
        damping: [N s/m or N m s].
        load: constant, of the nominal torques [N or N m].
        period: of the mesh [s].

    Source: Atanasiu et al. (2011), eqs. 8, 9 and 12, for any number of coordinates.
    """

    mass: Matrix
    damping: Matrix
    load: Vector
    period: Float[Array, ""]


def modal_damping(mass: Matrix, mean_stiffness: Matrix, ratio: Float[Array, ""] | float) -> Matrix:
    """Damping that gives each mode of the mean system the same damping ratio.

    For one coordinate this is c = 2 xi sqrt(m k).

    Args:
        mass: [coordinate coordinate] positive definite [kg or kg m2].
        mean_stiffness: mean over the period of arm, stiffness and arm, semi-definite [N/m or N m].
        ratio: damping ratio xi.

    Source: Atanasiu et al. (2011), eq. 12; for several coordinates mode by mode.
    """
    if mass.shape[0] == 1:
        return 2.0 * ratio * jnp.sqrt(mass * mean_stiffness)
    root = jnp.linalg.cholesky(mass)
    square, modes = jnp.linalg.eigh(_congruent(jnp.linalg.inv(root), mean_stiffness))
    positive = square > 0.0
    frequency = jnp.where(positive, jnp.sqrt(jnp.where(positive, square, 1.0)), 0.0)
    return 2.0 * ratio * _congruent(root, (modes * frequency) @ modes.T)


def reduced_mass(inertia: Float[Arrays, " body"], arm: Float[Arrays, " body"]) -> Float[Array, ""]:
    """Mass that vibrates along a contact between free bodies, m_e = 1/sum(n^2/J).

    Args:
        inertia: J of each body about its coordinate [kg m2 or kg].
        arm: n, closing velocity per unit rate of each coordinate [m/rad or 1].

    For two gears this is J1 J2/(J1 r_b2^2 + J2 r_b1^2), the right form of eq. 13 of Atanasiu et al.
    (2011), whose print swaps the indices.

    Example:
        >>> import jax.numpy as jnp
        >>> round(float(reduced_mass(jnp.asarray([2.0, 3.0]), jnp.asarray([1.0, 1.0]))), 3)
        1.2
    """
    return 1.0 / jnp.sum(arm**2 / inertia)


def _congruent(left: Matrix, matrix: Matrix) -> Matrix:
    return left @ matrix @ left.T
