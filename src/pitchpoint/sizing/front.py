"""Designs that no other one beats, and a few of many that stand for them."""

import numpy as np
from jaxtyping import Bool, Float, Int

__all__ = ["evenly_spread", "non_dominated"]

CHUNK = 512
"""Designs that are held against all others at once, which bounds memory."""


def non_dominated(costs: Float[np.ndarray, "design aim"]) -> Bool[np.ndarray, " design"]:
    """True for designs that no other one beats: none is at least as good in all aims and better in one.

    Of designs that are alike in all aims the first one stays.

    Args:
        costs: of each design, less is better.

    Example:
        >>> import numpy as np
        >>> non_dominated(np.array([[1.0, 3.0], [2.0, 2.0], [2.0, 3.0], [1.0, 3.0]])).tolist()
        [True, True, False, False]
    """
    kept = np.ones(len(costs), bool)
    order = np.lexsort(costs.T[::-1])  # none is beaten by one behind it
    ranked = costs[order]
    front = np.zeros((0, costs.shape[1]))
    for start in range(0, len(ranked), CHUNK):
        some = ranked[start : start + CHUNK]
        beaten = _beaten(some, front) if len(front) else np.zeros(len(some), bool)
        for place in np.flatnonzero(~beaten):
            before = some[:place][~beaten[:place]]
            beaten[place] = bool(_beaten(some[place : place + 1], before)[0])
        kept[order[start : start + CHUNK]] = ~beaten
        front = np.concatenate([front, some[~beaten]])
    return kept


def _beaten(some: np.ndarray, front: np.ndarray) -> np.ndarray:
    """True for designs that are not better than one of a front in any aim."""
    return np.asarray(np.any(np.all(front[None] <= some[:, None], axis=2), axis=1))


def evenly_spread(values: Float[np.ndarray, " design"], count: int) -> Int[np.ndarray, " _"]:
    """Numbers of at most so many designs, evenly among all in the order of a value, both ends with them.

    Args:
        values: one of each design.
        count: of designs, at most.

    Example:
        >>> import numpy as np
        >>> evenly_spread(np.array([5.0, 1.0, 2.0, 4.0, 3.0]), 3).tolist()
        [1, 4, 0]
    """
    order = np.argsort(values, kind="stable")
    if len(order) <= count:
        return order
    some: Int[np.ndarray, " _"] = order[
        np.unique(np.round(np.linspace(0, len(order) - 1, count)).astype(int))
    ]
    return some
