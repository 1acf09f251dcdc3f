"""States over a grid of positions and operating points, fast and in bounded memory."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, demand_double, jax, jnp
from pitchpoint.core.programs import fast_program
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation, state

__all__ = ["Block", "state_grid"]

# A quick attempt takes two steps for the balance; where it leaves more than this, all is done again with as
# many steps as it takes.
TOLERANCE = 1e-10
ROWS, MANY_ROWS = 256, 4096
"""Most operating points of one block, on a processor and on an accelerator."""

COLUMNS = 4096
"""Most positions of one block."""

_ROWS, _COLUMNS = 32, 128
"""Operating points and positions that a processor solves together: their work arrays stay in the cache of a
core. An accelerator takes a block at once, since it hides the way to its memory behind other states."""


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
        Blocks of at most `ROWS` operating points (`MANY_ROWS` on an accelerator) and `COLUMNS` positions;
        what is kept of them bounds the memory. Two steps solve the balance, the first one in single
        precision; a block that has then a residual above 1e-10 is solved again, iterating to convergence.
    """
    demand_double()
    count, places = int(operation.load.shape[0]), int(phase.shape[0])
    rows = min(_most_rows(), 1 << (count - 1).bit_length())
    columns = min(COLUMNS, places)
    for row in range(0, count, rows):
        taken = np.minimum(np.arange(row, row + rows), count - 1)
        part = _taken((design, operation), taken, count)
        for start in range(0, places, columns):
            at = np.minimum(np.arange(start, start + columns), places - 1)
            solved = _solved(part, array(np.asarray(phase)[at]), models)
            tall, wide = min(rows, count - row), min(columns, places - start)
            force, torque, efficiency = (_cut(values, tall, wide) for values in solved.states)
            locked = int(jnp.sum(~jnp.isfinite(force))) if bool(solved.locks) else 0
            largest = float(solved.residual)
            yield Block((row, start), force, torque, efficiency, largest, locked)


Inputs = tuple[Design, Operation]
States = tuple[Array, ...]


class _Solved(NamedTuple):
    """Force, torque and efficiency, and what became of their balances.

    Attributes:
        states: of the whole block.
        residual: largest of the states that have a balance.
        near: True if the residuals of all states are small.
        locks: True if some state has no balance.
    """

    states: States
    residual: Array
    near: Array
    locks: Array


def _solved(inputs: Inputs, phase: Array, models: Models) -> _Solved:
    attempt = _block(inputs, phase, models, quick=True)
    return attempt if bool(attempt.near) else _block(inputs, phase, models, quick=False)


def _cut(values: Array, rows: int, columns: int) -> Array:
    """The first rows and columns; all of them are not copied, which takes time."""
    return values if values.shape == (rows, columns) else values[:rows, :columns]


def _taken(inputs: Inputs, rows: np.ndarray, count: int) -> Inputs:
    """Rows of everything that has one value for each operating point, batch axes last but one."""

    def take(leaf: Array) -> Array:
        # By NumPy: JAX would start a program for each of them.
        return np.asarray(leaf)[rows] if jnp.ndim(leaf) and leaf.shape[0] == count else leaf

    design, operation = inputs
    oil, surfaces = jax.tree.map(take, (design.lubricant, design.roughness))
    return (
        replace(design, lubricant=oil, roughness=surfaces),
        jax.tree.map(lambda leaf: take(leaf)[:, None], operation),
    )


@fast_program
def _block(inputs: Inputs, phase: Array, models: Models, quick: bool) -> _Solved:
    """States in tiles of rows and columns: what varies along one of them is computed once for the other.

    Tiles are written where they belong: put together afterwards they would be copied twice.
    """
    count, places = inputs[1].load.shape[0], phase.shape[0]
    rows, columns = _tile(count, places)
    strips = jnp.pad(phase, (0, -places % columns), mode="edge").reshape(-1, columns)

    def per_row(leaf: Any) -> bool:
        return eqx.is_array(leaf) and jnp.ndim(leaf) == 2 and leaf.shape[0] == count

    rowwise, common = eqx.partition(inputs, per_row)
    stacked = jax.tree.map(lambda leaf: leaf.reshape(-1, rows, *leaf.shape[1:]), rowwise)

    def strip(number: Array, before: _Solved) -> _Solved:
        at = strips[number]
        engagement = _engaged(inputs[0], at, models)

        def tile(place: Array, before: _Solved) -> _Solved:
            part = jax.tree.map(lambda leaf: leaf[place], stacked)
            design, operation = eqx.combine(part, common)
            mesh_state = state(design, operation, at, models, quick=quick, engaged=engagement)
            balance = mesh_state.balance
            states = balance.force, mesh_state.input_torque, mesh_state.efficiency
            return _joined(before, states, balance.residual, (place * rows, number * columns))

        done: _Solved = jax.lax.fori_loop(0, count // rows, tile, before)
        return done

    blank = jnp.zeros((count, strips.size))
    none = _Solved((blank, blank, blank), jnp.zeros(()), jnp.asarray(True), jnp.asarray(False))
    solved: _Solved = jax.lax.fori_loop(0, strips.shape[0], strip, none)
    return solved._replace(states=tuple(values[:, :places] for values in solved.states))


def _most_rows() -> int:
    return ROWS if jax.default_backend() == "cpu" else MANY_ROWS


def _tile(count: int, places: int) -> tuple[int, int]:
    if jax.default_backend() == "cpu":
        return min(count, _ROWS), min(places, _COLUMNS)
    return count, places


def _joined(before: _Solved, tile: States, residual: Array, corner: tuple[Array, Array]) -> _Solved:
    """States with those of one more tile, whose first row and column are told."""
    solved = jnp.isfinite(tile[0])
    largest = jnp.max(jnp.where(solved, residual, 0.0))
    return _Solved(
        tuple(
            map(partial(jax.lax.dynamic_update_slice, start_indices=corner), before.states, tile)
        ),
        jnp.maximum(before.residual, largest),
        before.near & jnp.all(residual <= TOLERANCE),
        before.locks | ~jnp.all(solved),
    )


def _engaged(design: Design, phase: Float[Array, " column"], models: Models) -> Engagement | None:
    """Contacts and shares at some phases, where the shares do not depend on the load."""
    if models.sharing.by_stiffness:
        return None
    contacts = design.mesh.contacts(phase)
    share = models.share(design, contacts, jnp.zeros(()))
    return Engagement(phase, jnp.ones_like(phase), contacts, share, None, 1)
