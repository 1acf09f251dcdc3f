"""Array leaves, which the material modules share."""

from __future__ import annotations

from collections.abc import Sequence

from jax.typing import ArrayLike
from jaxtyping import Array, Float

from pitchpoint._jax import array, jnp

__all__ = ["float64_array"]


def float64_array(value: ArrayLike | Sequence[float]) -> Float[Array, "..."]:
    """Return a float64 array: a leaf that is a Python float would retrace for each value."""
    return array(value, jnp.float64)
