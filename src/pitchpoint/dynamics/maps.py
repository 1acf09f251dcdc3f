"""Affine maps of states, the batch last; a map's last column is where it takes the state of rest."""

from typing import TypeAlias

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp

__all__ = [
    "Chain",
    "Map",
    "chain",
    "compose",
    "horner",
    "identity",
    "inverse_matrix",
    "matrix_product",
    "on_last",
]

Map: TypeAlias = Float[Array, "state state+1 *b"]


class Chain(eqx.Module):
    """States at all nodes of a period as affine functions of the state at its start.

    Attributes:
        within: from the start of each element to its nodes.
        before: from the start of the period to the start of each element and to the end.
    """

    within: Float[Array, "state state+1 element node"]
    before: Float[Array, "state state+1 element+1"]

    @property
    def period(self) -> tuple[Float[Array, "state state"], Float[Array, " state"]]:
        """Monodromy matrix, and the state reached from rest after one period."""
        return self.before[:, :-1, -1], self.before[:, -1, -1]

    def states(self, start: Float[Array, " state"]) -> Float[Array, "state element node"]:
        """States at the nodes."""
        at = jnp.einsum("ijk,j->ik", self.before[:, :-1, :-1], start) + self.before[:, -1, :-1]
        moved = matrix_product(self.within[:, :-1], at[:, None, :, None])[:, 0]
        return moved + self.within[:, -1]


def chain(maps: Float[Array, "state state+1 element interval"]) -> Chain:
    """Compose the maps from node to node, all elements side by side, then the elements."""
    size = maps.shape[0] // 2
    unmoved = identity(size, maps.shape[2:3])

    def further(before: Map, step: Map) -> tuple[Map, Map]:
        after = compose(step, before)
        return after, after

    elements, inner = jax.lax.scan(further, unmoved, jnp.moveaxis(maps, -1, 0))
    within = jnp.concatenate([unmoved[None], inner])
    begin = identity(size, ())
    _, ends = jax.lax.scan(further, begin, jnp.moveaxis(elements, -1, 0))
    before = jnp.moveaxis(jnp.concatenate([begin[None], ends]), 0, -1)
    return Chain(jnp.moveaxis(within, 0, -1), before)


def matrix_product(
    left: Float[Array, "i j *#b"], right: Float[Array, "j k *#b"]
) -> Float[Array, "i k *b"]:
    """Matrix product with the batch last, where it runs along rows."""
    value: Array = left[:, 0, None] * right[None, 0]
    for j in range(1, right.shape[0]):
        value = value + left[:, j, None] * right[None, j]
    return value


def compose(after: Map, before: Map) -> Map:
    """The map that does one after the other."""
    return matrix_product(after[:, :-1], before) + on_last(after[:, -1], after.shape[1])


def inverse_matrix(matrix: Float[Array, "state state *b"]) -> Float[Array, "state state *b"]:
    """Inverse with the batch last, in closed form for a single coordinate."""
    if matrix.shape[0] > 2:
        inverse: Array = jnp.linalg.inv(jnp.moveaxis(matrix, (0, 1), (-2, -1)))
        return jnp.moveaxis(inverse, (-2, -1), (0, 1))
    (a, b), (c, d) = matrix
    adjugate = jnp.stack([jnp.stack([d, -b]), jnp.stack([-c, a])])
    return jnp.divide(adjugate, a * d - b * c)


def on_last(column: Float[Array, "row *b"], columns: int) -> Float[Array, "row column *b"]:
    """Zeros but for the last column: to add it so remains elementwise, a scatter is slow."""
    is_last = jnp.asarray(np.arange(columns) == columns - 1)
    return column[:, None] * is_last.reshape(1, -1, *(1 for _ in column.shape[1:]))


def identity(size: int, batch: tuple[int, ...]) -> Map:
    """The map that changes nothing, for so many coordinates."""
    eye = jnp.eye(2 * size, 2 * size + 1)
    return jnp.broadcast_to(eye.reshape(*eye.shape, *(1 for _ in batch)), (*eye.shape, *batch))


def horner(coefficients: Float[Array, "power *b"], at: Float[Array, "..."]) -> Float[Array, "*b"]:
    """Polynomial with the lowest power first.

    Source: Horner (1819).
    """
    value = coefficients[-1]
    for power in range(coefficients.shape[0] - 2, -1, -1):
        value = value * at + coefficients[power]
    return value
