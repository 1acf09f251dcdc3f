"""The drive backwards, and the friction that locks it, in words."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from pitchpoint.analyses.caveats import jamming_words
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import laws
from pitchpoint.views.section import KeyFigure

__all__ = [
    "ROUGHEST",
    "back_driving",
    "back_driving_figure",
    "jamming",
    "locks_from",
    "margin_figure",
]

ROUGHEST = 1.0
"""Friction coefficient that no lubricated flank reaches: where a mesh locks beyond it is no figure."""


def back_driving(outcome: Outcome, law: str) -> str:
    """Efficiency with the other gear driving, or that friction locks the mesh, and from when on it does."""
    data = outcome.parts.get("back_driving")
    if data is None or law not in laws(data):
        return "not computed"
    position = laws(data).index(law)
    if bool(data["locked"].values[position, 0]):
        return f"self-locking: friction locks the mesh; {jamming_words(*_nearest(data, position))}"
    value = float(data["mean_efficiency"].values[position, 0])
    if not np.isfinite(value):
        return "undefined, no power"
    efficiency = f"{show.quantity('mean_efficiency', value)}, friction does not lock the mesh"
    if not np.isfinite(_limit(data, position)):
        return efficiency
    return f"{efficiency} ({_would(data, position)})"


def back_driving_figure(outcome: Outcome, law: str) -> KeyFigure:
    """The drive backwards as a figure of the first screen, among the first where it locks or nearly does.

    Args:
        outcome: that has its part.
        law: of the case.
    """
    data = outcome.parts["back_driving"]
    position = laws(data).index(law)
    value = float(data["mean_efficiency"].values[position, 0])
    acting, limit = _nearest(data, position)
    locked = bool(data["locked"].values[position, 0])
    if locked or acting > 0.5 * limit:
        words = "self-locking" if locked else show.quantity("mean_efficiency", value)
        at = f"locks from μ = {show.number_text(limit)} on; at most {show.number_text(acting)} acts"
        return KeyFigure(_NEARLY_LOCKED, _NAME, words, at)
    if not np.isfinite(value):
        return KeyFigure(_MOVES, _NAME, "undefined", "no power")
    torque = show.quantity(
        "mean_input_torque", float(data["mean_input_torque"].values[position, 0]), of=data
    )
    words = f"efficiency with the output driving by {torque}; friction does not lock it"
    would = f"; {_would(data, position)}" if np.isfinite(_limit(data, position)) else ""
    return KeyFigure(_MOVES, _NAME, show.quantity("mean_efficiency", value), f"{words}{would}")


def margin_figure(outcome: Outcome, law: str) -> Iterator[KeyFigure]:
    """How far friction is from locking the drive backwards, where a friction that flanks have locks it.

    Args:
        outcome: that has its part.
        law: of the case.
    """
    data = outcome.parts["back_driving"]
    position = laws(data).index(law)
    acting, limit = _nearest(data, position)
    if "self_locking_margin" not in data or not 0.0 < limit <= ROUGHEST or acting == 0.0:
        return
    margin = float(data["self_locking_margin"].values[position, 0])
    order = _NEARLY_LOCKED if acting > 0.5 * limit else _MOVES
    at = f"times the friction locks it, from μ = {show.number_text(limit)} on"
    yield KeyFigure(order + 0.05, "Self-locking margin", show.number_text(margin), at)


_NAME = "Back-driving"
_NEARLY_LOCKED, _MOVES = 29.0, 77.0
"""Places among the figures; half of the friction that locks takes about half of the power."""


def _nearest(data: Any, position: int) -> tuple[float, float]:
    """Friction coefficient where the mesh is nearest to locking, and the one at which it locks there."""
    names = ("nearest_friction", "nearest_jamming_coefficient")
    acting, limit = (float(data[name].values[position, 0]) for name in names)
    return acting, limit


def _would(data: Any, position: int) -> str:
    limit = _limit(data, position)
    if limit > ROUGHEST:
        return f"nor would it below μ = {ROUGHEST:g}"
    acting = show.number_text(_nearest(data, position)[0])
    return f"it would from μ = {show.number_text(limit)} on, at most {acting} acts"


def jamming(data: Any, position: int) -> str:
    """Friction coefficient at which the mesh locks; empty where none does."""
    limit = _limit(data, position)
    return locks_from(limit, show.number_text(limit)) if np.isfinite(limit) else ""


def locks_from(limit: float, shown: str) -> str:
    """Friction coefficient from which on a mesh locks, in words.

    Args:
        limit: the coefficient.
        shown: it as a number is shown there.

    Example:
        >>> locks_from(0.45, "0.4500"), locks_from(4.9, "4.9000")
        ('0.4500', 'above 1')
    """
    return shown if limit <= ROUGHEST else f"above {ROUGHEST:g}"


def _limit(data: Any, position: int) -> float:
    if "jamming_coefficient" not in data:
        return np.inf
    return float(data["jamming_coefficient"].values[position, 0])
