"""Figures that only a published case needs: formulas as its source prints them."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from pitchpoint.cases.atanasiu2011 import printed as atanasiu2011
from pitchpoint.cases.build import Built
from pitchpoint.cases.xu2021 import printed as xu2021
from pitchpoint.cases.zhao2022 import printed as zhao2022

__all__ = ["READINGS", "readings_of"]

READINGS: dict[str, Callable[[Built], dict[str, float]]] = {
    "atanasiu_2011": atanasiu2011.readings,
    "xu_2021": xu2021.readings,
    "zhao_2022": zhao2022.readings,
}
"""By source of the case."""


def readings_of(points: Sequence[Built], laws: int) -> dict[str, Any]:
    """Variables [law, point] that belong to the source of a case; none for most."""
    reading = READINGS.get(points[0].case.source)
    if reading is None:
        return {}
    found = [reading(point) for point in points]
    return {
        name: (("law", "point"), np.array([[one[name] for one in found]] * laws))
        for name in found[0]
    }
