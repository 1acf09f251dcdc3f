"""States over a grid of positions and operating points, fast and in bounded memory."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.programs import program

__all__ = ["Block", "state_grid"]

TOLERANCE = 1e-10
ROWS = 256
"""Most operating points of one block."""

COLUMNS = 4096
"""Most positions of one block."""

_CACHED = 2048
"""States solved together: their work arrays stay in the cache of a core."""

_STEPS = 2


@dataclass(frozen=True)
class Block:
    """States of some operating points [point] at some positions [position].

    Attributes:
        first: index of the first operating point and of the first position.
        force: normal force of the mesh [N], shape [point, position]; NaN where friction locks it.
        input_torque: torque of the driver [N m].
        efficiency: output over input power; NaN where no power is transmitted.
        residual: largest relative residual of the torque balance among the states that have one.
        locked: number of states without a balance.
    """

    first: tuple[int, int]
    force: Float[Array, "point position"]
    input_torque: Float[Array, "point position"]
    efficiency: Float[Array, "point position"]
    residual: float
    locked: int


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
        Blocks of at most `ROWS` operating points and `COLUMNS` positions; what is kept of them
        bounds the memory. Two written-out steps solve the balance; a block that has then a residual
        above 1e-10 is solved again, iterating to convergence.
    """
    count, places = int(operation.load.shape[0]), int(phase.shape[0])
    rows = min(ROWS, 1 << (count - 1).bit_length())
    columns = min(COLUMNS, places)
    for first in range(0, count, rows):
        taken = np.minimum(np.arange(first, first + rows), count - 1)
        part = _taken((design, operation), taken, count)
        for start in range(0, places, columns):
            at = phase[np.minimum(np.arange(start, start + columns), places - 1)]
            found = _solved(part, at, models)
            wide, tall = min(columns, places - start), min(rows, count - first)
            force, torque, efficiency, residual = (values[:tall, :wide] for values in found)
            solved = jnp.isfinite(force)
            largest = float(jnp.max(jnp.where(solved, residual, 0.0)))
            locked = int(jnp.sum(~solved))
            yield Block((first, start), force, torque, efficiency, largest, locked)


Columns = tuple[Array, Array, Array, Array]
Inputs = tuple[Design, Operation]


def _solved(inputs: Inputs, phase: Array, models: Models) -> Columns:
    quick = _block(inputs, phase, models, _STEPS)
    if bool(jnp.all(quick[-1] <= TOLERANCE)):
        return quick
    return _block(inputs, phase, models, 0)


def _taken(inputs: Inputs, rows: np.ndarray, count: int) -> Inputs:
    """Rows of everything that has one value for each operating point, batch axes last but one."""

    def take(leaf: Array) -> Array:
        return leaf[rows] if jnp.ndim(leaf) and leaf.shape[0] == count else leaf

    design, operation = inputs
    oil, surfaces = jax.tree.map(take, (design.lubricant, design.roughness))
    return (
        replace(design, lubricant=oil, roughness=surfaces),
        jax.tree.map(lambda leaf: take(leaf)[:, None], operation),
    )


@program
def _block(inputs: Inputs, phase: Array, models: Models, steps: int) -> Columns:
    rows = inputs[1].load.shape[0]
    together = min(rows, 1 << max(0, (_CACHED // phase.shape[0]).bit_length() - 1))

    def solve(part: Inputs) -> Columns:
        found = state(*part, phase, models, unrolled=steps)
        balance = found.balance
        return balance.force, found.input_torque, found.efficiency, balance.residual

    def per_row(leaf: Any) -> bool:
        return eqx.is_array(leaf) and jnp.ndim(leaf) == 2 and leaf.shape[0] == rows

    rowwise, whole = eqx.partition(inputs, per_row)
    stacked = jax.tree.map(lambda leaf: leaf.reshape(-1, together, *leaf.shape[1:]), rowwise)
    out: Columns = jax.lax.map(lambda part: solve(eqx.combine(part, whole)), stacked)
    force, torque, efficiency, residual = (x.reshape(rows, phase.shape[0]) for x in out)
    return force, torque, efficiency, residual
