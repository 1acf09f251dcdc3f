"""The drive backwards, and the friction that locks it, in words."""

from typing import Any

import numpy as np

from pitchpoint.analyses.caveats import jamming_words
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import laws

__all__ = ["back_driving", "jamming", "locks_from"]

ROUGHEST = 1.0
"""Friction coefficient that no lubricated flank reaches: where a mesh locks beyond it is no figure."""


def back_driving(outcome: Outcome, law: str) -> str:
    """Efficiency with the other gear driving, or that friction locks the mesh, and from when on it does."""
    data = outcome.parts.get("back_driving")
    if data is None or law not in laws(data):
        return "not computed"
    position = laws(data).index(law)
    if bool(data["locked"].values[position, 0]):
        ends = ("nearest_friction", "nearest_jamming_coefficient")
        acting, limit = (float(data[name].values[position, 0]) for name in ends)
        return f"self-locking: friction locks the mesh; {jamming_words(acting, limit)}"
    value = float(data["mean_efficiency"].values[position, 0])
    if not np.isfinite(value):
        return "undefined, no power"
    told = f"{show.quantity('mean_efficiency', value)}, friction does not lock the mesh"
    limit = _limit(data, position)
    if not np.isfinite(limit):
        return told
    return f"{told} ({_would(limit)})"


def _would(limit: float) -> str:
    if limit > ROUGHEST:
        return f"nor would it below μ = {ROUGHEST:g}"
    return f"it would from μ = {show.number(limit)} on"


def jamming(data: Any, position: int) -> str:
    """Friction coefficient at which the mesh locks; empty where none does."""
    limit = _limit(data, position)
    return locks_from(limit, show.number(limit)) if np.isfinite(limit) else ""


def locks_from(limit: float, shown: str) -> str:
    """Friction coefficient from which on a mesh locks, in words.

    Args:
        limit: the coefficient.
        shown: it as a number is shown there.

    Example:
        >>> locks_from(0.45, "0.4500"), locks_from(4.9, "4.9000")
        ('0.4500', 'not below 1')
    """
    return shown if limit <= ROUGHEST else f"not below {ROUGHEST:g}"


def _limit(data: Any, position: int) -> float:
    if "jamming_coefficient" not in data:
        return np.inf
    return float(data["jamming_coefficient"].values[position, 0])
