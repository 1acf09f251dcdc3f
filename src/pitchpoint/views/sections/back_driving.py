"""The drive backwards, and the friction that locks it, in words."""

from typing import Any

import numpy as np

from pitchpoint.analyses.caveats import jamming_words
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import laws

__all__ = ["back_driving", "jamming"]


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
    locks = jamming(data, position)
    return f"{told} (it would from μ = {locks} on)" if locks else told


def jamming(data: Any, position: int) -> str:
    """Friction coefficient at which the mesh locks; empty where none does."""
    if "jamming_coefficient" not in data:
        return ""
    limit = float(data["jamming_coefficient"].values[position, 0])
    return show.number(limit, 3) if np.isfinite(limit) else ""
