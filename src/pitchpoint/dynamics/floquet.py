"""Stability of a periodic motion: the Floquet multipliers of one period."""

from jaxtyping import Array, Complex, Float

from pitchpoint._jax import jnp

__all__ = ["STABLE", "multipliers"]

STABLE = 1.0 + 1e-6
"""Largest magnitude of a multiplier of a motion that is reached."""


def multipliers(monodromy: Float[Array, "state state"]) -> Complex[Array, " state"]:
    """Eigenvalues of the map of small disturbances over one period.

    Args:
        monodromy: derivative of the state after a period with respect to that before. Zero stands in
            for what is not a finite number, so that a failed lane disturbs no other.

    Source: Nayfeh and Mook (1979), chapter 5, Floquet theory.
    """
    finite = jnp.where(jnp.isfinite(monodromy), monodromy, 0.0)
    if monodromy.shape[0] > 2:
        values: Complex[Array, " state"] = jnp.linalg.eigvals(finite)
        return values
    half = jnp.trace(finite) / 2.0
    product = finite[0, 0] * finite[1, 1] - finite[0, 1] * finite[1, 0]
    # Complex before the root, of a negative number for a vibration: its multipliers are conjugate.
    root = jnp.sqrt((half**2 - product).astype(complex))
    return jnp.stack([half + root, half - root])
