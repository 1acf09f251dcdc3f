"""Numbers that are nothing but rounding against their own scale."""

import numpy as np

__all__ = ["ROUNDING", "difference"]

ROUNDING = 1e-12
"""Difference of two values, over the larger of them, that is left by rounding."""


def difference(high: np.ndarray, low: np.ndarray) -> np.ndarray:
    """Difference of two values; zero where rounding alone has left it.

    Example:
        >>> import numpy as np
        >>> difference(np.array([0.1 + 0.2, 2.0]), np.array([0.3, 1.0])).tolist()
        [0.0, 1.0]
    """
    scale = ROUNDING * np.maximum(np.abs(high), np.abs(low))
    gap: np.ndarray = np.where(np.abs(high - low) <= scale, 0.0, high - low)
    return gap
