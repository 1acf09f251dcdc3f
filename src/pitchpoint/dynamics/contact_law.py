"""Force between two teeth from their stretch: the named models of contact and separation."""

from jaxtyping import Array, Float

from pitchpoint._jax import jnp

__all__ = ["linear_contact", "separating_contact"]

Each = Float[Array, "*b"]


def linear_contact(stretch: Each, backlash: Float[Array, ""]) -> tuple[Each, Each]:
    """Teeth never part: the force follows the stretch, pulling where it is negative.

    Args:
        stretch: arm times coordinates less profile error, positive where flanks press [m].
        backlash: not used, common to all laws.

    Source: Atanasiu et al. (2011), eq. 11.
    """
    return stretch, jnp.ones_like(stretch)


def separating_contact(stretch: Each, backlash: Float[Array, ""]) -> tuple[Each, Each]:
    """Teeth part where the stretch is negative, and meet their back flanks beyond the backlash.

    Args:
        stretch: arm times coordinates less profile error, positive where flanks press [m].
        backlash: free motion along the normal before the back flanks touch [m]; infinite if never.

    Source: Kahraman and Singh (1990), a spring with a clearance, counted from the front flank.
    """
    behind = -stretch - backlash
    back = jnp.where(behind > 0.0, jnp.where(jnp.isfinite(behind), behind, 0.0), 0.0)
    touching = (stretch > 0.0) | (behind > 0.0)
    return jnp.maximum(stretch, 0.0) - back, jnp.where(touching, 1.0, 0.0)
