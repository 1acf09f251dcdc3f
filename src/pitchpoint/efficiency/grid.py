"""States over a grid of positions and operating points, fast and in bounded memory."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state

__all__ = ["Block", "state_grid"]

TOLERANCE = 1e-10
ROWS = 256
"""Operating points of one block."""

_CACHED = 2048
"""States solved together: their work arrays stay in the cache of a core."""

_STEPS = 2


@dataclass(frozen=True)
class Block:
    """States of some operating points [point] at all positions [position].

    Attributes:
        first: index of the first operating point.
        force: normal force of the mesh [N], shape [point, position].
        input_torque: torque of the driver [N m].
        efficiency: output over input power; NaN where no power is transmitted.
        residual: largest relative residual of the torque balance in the block.
    """

    first: int
    force: Float[Array, "point position"]
    input_torque: Float[Array, "point position"]
    efficiency: Float[Array, "point position"]
    residual: Float[Array, ""]


def state_grid(
    design: Design, operation: Operation, phase: Float[Array, " position"], models: Models
) -> Iterator[Block]:
    """States of every operating point at every phase, block by block.

    Args:
        design: mesh, materials, oil, surfaces; values of oil and surfaces may have shape [point, 1].
        operation: operating points [point].
        phase: [position] periods.
        models: laws.

    Yields:
        Blocks of at most `ROWS` operating points; what is kept of them bounds the memory. Two
        written-out steps solve the balance; a block whose residual is then above 1e-10 is solved
        again, iterating to convergence.
    """
    count = int(operation.load.shape[0])
    for first in range(0, count, ROWS):
        used = min(ROWS, count - first)
        rows = np.minimum(np.arange(first, first + ROWS), count - 1)
        part, points = _taken((design, operation), rows, count)
        block = _block(part, points, phase, models, _STEPS)
        if not bool(block[-1] <= TOLERANCE):
            block = _block(part, points, phase, models, 0)
        force, torque, efficiency, residual = block
        yield Block(first, force[:used], torque[:used], efficiency[:used], residual)


def _taken(
    inputs: tuple[Design, Operation], rows: np.ndarray, count: int
) -> tuple[Design, Operation]:
    """Rows of everything that has one value for each operating point."""

    def take(leaf: Array) -> Array:
        return leaf[rows] if jnp.ndim(leaf) and leaf.shape[0] == count else leaf

    design, operation = inputs
    oil, surfaces = jax.tree.map(take, (design.lubricant, design.roughness))
    return (
        Design(design.mesh, design.modulus, oil, surfaces),
        jax.tree.map(lambda leaf: take(leaf)[:, None], operation),
    )


@eqx.filter_jit
def _block(
    design: Design, points: Operation, phase: Array, models: Models, steps: int
) -> tuple[Array, Array, Array, Array]:
    together = max(1, min(ROWS, _CACHED // phase.shape[0]))

    def solve(rows: tuple[Design, Operation]) -> tuple[Array, Array, Array, Array]:
        found = state(rows[0], rows[1], phase, models, unrolled=steps)
        return (
            found.balance.force,
            found.input_torque,
            found.efficiency,
            jnp.max(found.balance.residual),
        )

    rowwise, whole = eqx.partition((design, points), _per_row)
    stacked = jax.tree.map(lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]), rowwise)
    out = jax.lax.map(lambda rows: solve(eqx.combine(rows, whole)), stacked)
    force, torque, efficiency, residual = out
    shape = (ROWS, phase.shape[0])
    return force.reshape(shape), torque.reshape(shape), efficiency.reshape(shape), jnp.max(residual)


def _per_row(leaf: Any) -> bool:
    return eqx.is_array(leaf) and jnp.ndim(leaf) == 2 and leaf.shape[0] == ROWS
