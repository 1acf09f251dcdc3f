"""Balances of mesh cycles in rows of one size, by the one program of a run that knows its friction laws.

Contacts and shares come from programs without a law, and figures are read by such, so that another law
compiles its balance alone.
"""

from dataclasses import replace
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    engagement_alone,
    forces_at_nodes,
)
from pitchpoint.loading.balance import Balance

__all__ = [
    "CHUNK",
    "NODES",
    "Row",
    "balance_in_rows",
    "balances_of",
    "one_engagement",
    "remembered_engagements",
    "row_balances",
    "stacked",
]

CHUNK = 8
"""Rows that are computed together: one compiled program serves any number of them."""

NODES = 24
"""Nodes of a row in each segment between events."""

Row = tuple[Design, Operation, Engagement]


@program
def engagements(designs: Design, load: Float[Array, " row"], models: Models) -> Engagement:
    """Contacts and shares of every row, for meshes with few contacts; see `engagement_alone`."""
    engagement: Engagement = eqx.filter_vmap(
        lambda design, torque: engagement_alone(design, torque, models, NODES)
    )(designs, load)
    return engagement


def remembered_engagements(
    designs: Design, load: Float[Arrays, " row"], models: Models
) -> Engagement:
    """The same as `engagements`, found once for rows that are asked for again, as under other laws."""
    inputs = designs, models, load if models.sharing.by_stiffness else None
    leaves, structure = jax.tree.flatten(inputs)
    key = structure, *((np.shape(leaf), np.asarray(leaf).tobytes()) for leaf in leaves)
    if key not in _KNOWN:
        while len(_KNOWN) >= MOST_KNOWN:
            _KNOWN.pop(next(iter(_KNOWN)), None)
        _KNOWN[key] = engagements(designs, load, models)
    return _KNOWN[key]


MOST_KNOWN = 4
"""Rows whose contacts are kept, about a megabyte each: those of a sweep of some 30 points."""

_KNOWN: dict[Any, Engagement] = {}


one_engagement = program(engagement_alone)
"""Contacts and shares of one point, see `engagement_alone`."""


@program
def row_balances(rows: Row, models: Models) -> Balance:
    """Balance of every row."""
    forces: Balance = eqx.filter_vmap(
        lambda design, operation, known: forces_at_nodes(design, operation, known, models)
    )(*rows)
    return forces


def balances_of(rows: Row, models: Models) -> Balance:
    """Balance of every row; no balance asks for the law of the film, and one program serves them all."""
    return row_balances(rows, models.without_film)


def stacked(rows: list[Any]) -> Any:
    """Trees of arrays as one with an axis in front; what is one object in all of them is looked at once.

    Args:
        rows: of equal structure.
    """
    leaves = {key: jax.tree.leaves(row) for key, row in {id(row): row for row in rows}.items()}
    stacks = map(_stack, *(leaves[id(row)] for row in rows))
    return jax.tree.unflatten(jax.tree.structure(rows[0]), stacks)


def _stack(first: Any, *others: Any) -> np.ndarray:
    if all(leaf is first for leaf in others):
        return np.asarray(first)[None].repeat(1 + len(others), axis=0)
    return np.stack((first, *others))


def balance_in_rows(
    design: Design, operation: Operation, known: Engagement, models: Models
) -> Balance:
    """Balance of one cycle, by the program of `row_balances`; a cycle of more nodes takes several rows."""
    count = known.nodes // NODES if known.nodes % NODES == 0 else 1
    parts = [_part(known, number, count) for number in range(count)]
    rows = [(design, operation, part) for part in parts]
    in_rows = jax.device_get(balances_of(stacked(rows + rows[-1:] * (CHUNK - count)), models))

    def joined(leaf: np.ndarray) -> np.ndarray:
        return np.concatenate(leaf[:count], axis=-1) if leaf.ndim > 1 else np.asarray(leaf.max())

    balance: Balance = jax.tree.map(joined, in_rows)
    return balance


def _part(engagement: Engagement, number: int, count: int) -> Engagement:
    """One of so many equal parts of the nodes."""
    alone = replace(engagement, body=None, nodes=engagement.nodes // count)
    part: Engagement = jax.tree.map(
        lambda leaf: np.split(np.asarray(leaf), count, axis=-1)[number], alone
    )
    return part
