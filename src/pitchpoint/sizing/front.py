"""Designs that no other one beats, and a few of many that stand for them."""

import numpy as np
from jaxtyping import Bool, Float, Int

__all__ = ["non_dominated", "representatives"]

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
    if costs.shape[1] == 2:
        least = np.minimum.accumulate(ranked[:, 1])
        kept[order[1:]] = ranked[1:, 1] < least[:-1]
        return kept
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


def representatives(costs: Float[np.ndarray, "design aim"], count: int) -> Int[np.ndarray, " _"]:
    """Numbers of at most so many designs: the best by each aim, others evenly in the order of the first one.

    Args:
        costs: of each design, less is better.
        count: of designs, at most; more than there are aims.

    Example:
        >>> import numpy as np
        >>> costs = np.array([[5.0, 1.0], [1.0, 9.0], [2.0, 2.0], [4.0, 0.0], [3.0, 2.0]])
        >>> representatives(costs, 4).tolist()
        [1, 4, 3, 0]
    """
    order = np.argsort(costs[:, 0], kind="stable")
    if len(order) <= count:
        return order
    even = np.linspace(0, len(order) - 1, count - costs.shape[1] + 1)
    best = costs[order].argmin(axis=0)
    some: Int[np.ndarray, " _"] = order[np.union1d(np.round(even).astype(int), best)]
    return some
