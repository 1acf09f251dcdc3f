"""States over a grid of positions and operating points, fast and in bounded memory."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation, state
from pitchpoint.programs import fast_program

__all__ = ["Block", "state_grid"]

TOLERANCE = 1e-10
ROWS = 256
"""Most operating points of one block."""

COLUMNS = 4096
"""Most positions of one block."""

_ROWS, _COLUMNS = 64, 128
"""Operating points and positions that are solved together: their work arrays stay in the cache of a core."""


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
        bounds the memory. Two steps solve the balance, the first one in single precision; a block that
        has then a residual above 1e-10 is solved again, iterating to convergence.
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
    found = _block(inputs, phase, models, quick=True)
    if bool(jnp.all(found[-1] <= TOLERANCE)):
        return found
    return _block(inputs, phase, models, quick=False)


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


@fast_program
def _block(inputs: Inputs, phase: Array, models: Models, quick: bool) -> Columns:
    """States in tiles of rows and columns: what varies along one of them is computed once for the other."""
    count, places = inputs[1].load.shape[0], phase.shape[0]
    rows, columns = min(count, _ROWS), min(places, _COLUMNS)

    def per_row(leaf: Any) -> bool:
        return eqx.is_array(leaf) and jnp.ndim(leaf) == 2 and leaf.shape[0] == count

    rowwise, whole = eqx.partition(inputs, per_row)
    stacked = jax.tree.map(lambda leaf: leaf.reshape(-1, rows, *leaf.shape[1:]), rowwise)

    def strip(at: Float[Array, " column"]) -> Columns:
        known = _engaged(inputs[0], at, models)

        def tile(part: Inputs) -> Columns:
            design, operation = eqx.combine(part, whole)
            found = state(design, operation, at, models, quick=quick, engaged=known)
            balance = found.balance
            return balance.force, found.input_torque, found.efficiency, balance.residual

        out: Columns = jax.lax.map(tile, stacked)
        return out

    strips = jnp.pad(phase, (0, -places % columns), mode="edge").reshape(-1, columns)
    out: Columns = jax.lax.map(strip, strips)
    force, torque, efficiency, residual = (
        jnp.moveaxis(x, 0, 2).reshape(count, -1)[:, :places] for x in out
    )
    return force, torque, efficiency, residual


def _engaged(design: Design, phase: Float[Array, " column"], models: Models) -> Engagement | None:
    """Contacts and shares at some phases, where the shares do not depend on the load."""
    if models.sharing.by_stiffness:
        return None
    contacts = design.mesh.contacts(phase)
    share = models.share(design, contacts, jnp.zeros(()))
    return Engagement(phase, jnp.ones_like(phase), contacts, share, None, 1)
