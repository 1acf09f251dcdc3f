"""How results of many designs go with their inputs, where nobody laid designs out for Sobol' indices."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

__all__ = ["MainEffect", "main_effect", "rank_correlations"]

FEWEST_RANKED = 10
"""Designs below which ranks say nothing."""


def rank_correlations(
    inputs: Float[np.ndarray, "key design"], results: Float[np.ndarray, "figure design"]
) -> Float[np.ndarray, "figure key"]:
    """Spearman's rank correlation of every result with every input.

    Args:
        inputs: values of the keys, in any unit.
        results: values of the figures; designs that are not a number are left out of their figure.

    Returns:
        From -1 (falls with the input throughout) to 1 (rises with it); not a number where either does not
        vary, or of fewer than 10 designs.

    Validity: inputs that were varied independently of each other; what rises and falls again has none.

    Example:
        >>> import numpy as np
        >>> torque = np.linspace(1.0, 2.0, 11)
        >>> rank_correlations(torque[None], np.stack([torque**3, -torque])).tolist()
        [[1.0], [-1.0]]
    """
    from scipy.stats import rankdata

    ranked = np.full((len(results), len(inputs)), np.nan)
    for row, result in enumerate(results):
        there = np.isfinite(result)
        if there.sum() < FEWEST_RANKED:
            continue
        ranks = rankdata(np.vstack([result[None, there], inputs[:, there]]), axis=1)
        ranks -= ranks.mean(axis=1, keepdims=True)
        sizes = np.sqrt((ranks**2).sum(axis=1))
        products = (ranks[1:] * ranks[0]).sum(axis=1)
        np.divide(products, sizes[1:] * sizes[0], out=ranked[row], where=sizes[1:] * sizes[0] > 0.0)
    return np.asarray(np.clip(ranked, -1.0, 1.0))


@dataclass(frozen=True)
class MainEffect:
    """A result over one input, whatever the others are.

    Attributes:
        place: mean of the input in each group of designs.
        median: of the result there.
        low, high: between which 80 of 100 results lie there.
    """

    place: Float[np.ndarray, " group"]
    median: Float[np.ndarray, " group"]
    low: Float[np.ndarray, " group"]
    high: Float[np.ndarray, " group"]


GROUPS = 12
"""Groups of designs along an input, each with as many designs."""


def main_effect(
    values: Float[np.ndarray, " design"], result: Float[np.ndarray, " design"]
) -> MainEffect:
    """Medians of a result in groups of designs whose values of an input are near each other.

    Args:
        values: of the input, in any unit; where there are few different ones each is a group.
        result: of each design; what is not a number is left out.

    Example:
        >>> import numpy as np
        >>> main_effect(np.array([1.0, 1.0, 2.0, 2.0]), np.array([3.0, 5.0, 7.0, 9.0])).median.tolist()
        [4.0, 8.0]
    """
    there = np.isfinite(result)
    order = np.argsort(values[there], kind="stable")
    ordered, results = values[there][order], result[there][order]
    different = np.unique(ordered)
    if len(different) <= GROUPS:
        ends = np.searchsorted(ordered, different)[1:]
    else:
        ends = np.linspace(0, len(ordered), GROUPS + 1).round().astype(int)[1:-1]
    groups = [*zip(np.split(ordered, ends), np.split(results, ends), strict=True)]
    low, median, high = (
        np.array([np.quantile(part, share) for _, part in groups]) for share in (0.1, 0.5, 0.9)
    )
    return MainEffect(np.array([place.mean() for place, _ in groups]), median, low, high)
