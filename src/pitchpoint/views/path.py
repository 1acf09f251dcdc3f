"""The path of contact of a result: its points by letter, its length, and what lies along it."""

from dataclasses import dataclass
from typing import Any

import xarray as xr

from pitchpoint.runs.run import Outcome

__all__ = ["StraightPath", "contact_path", "path_marks"]


@dataclass(frozen=True)
class StraightPath:
    """The way of a pair whose contacts run along a straight path.

    Attributes:
        points: by letter, positions from A in base pitches, in order.
        transverse_ratio, overlap_ratio: transverse contact ratio and overlap ratio.
        axis: title of an axis along it.
        pitch: what a base pitch is called.
        against: why pairs run from E to A; empty where they run from A to E.
    """

    points: dict[str, float]
    transverse_ratio: float
    overlap_ratio: float
    axis: str
    pitch: str
    against: str

    @property
    def contact_ratio(self) -> float:
        """Total contact ratio: base pitches from the entry of a pair to its exit."""
        return self.transverse_ratio + self.overlap_ratio

    @property
    def helical(self) -> bool:
        """True if contact lines cross the face at an angle."""
        return self.overlap_ratio > 0.0

    @property
    def backwards(self) -> bool:
        """True if a pair runs from E to A."""
        return bool(self.against)


def contact_path(outcome: Outcome) -> StraightPath:
    """Path of contact of a result whose teeth have one."""
    teeth = outcome.parts["teeth"]
    ratio = float(teeth["transverse_contact_ratio"])
    return StraightPath(
        points=_inside(teeth, ratio),
        transverse_ratio=ratio,
        overlap_ratio=float(teeth["overlap_ratio"]),
        axis=str(teeth["points"].attrs["axis"]),
        pitch=str(outcome.manifest["pitch"]),
        against=str(outcome.manifest["against"]),
    )


def _inside(teeth: xr.Dataset, ratio: float) -> dict[str, float]:
    """Points that lie on the path, by letter and in order [base pitches from A]."""
    places = (teeth["points"].values - teeth["points"].values[0]) / float(teeth["base_pitch"])
    named = sorted(zip(places.tolist(), teeth["point"].values.tolist(), strict=True))
    return {str(name): place for place, name in named if -1e-9 <= place <= ratio + 1e-9}


def path_marks(path: StraightPath) -> dict[str, Any]:
    """Vertical lines and letters at the points of the path."""
    places: list[tuple[float, str]] = []
    for letter, place in path.points.items():
        if places and place - places[-1][0] < 0.03 * path.transverse_ratio:
            places[-1] = (places[-1][0], f"{places[-1][1]} {letter}")
        else:
            places.append((place, letter))
    return {
        "shapes": [
            {
                "type": "line",
                "x0": place,
                "x1": place,
                "yref": "paper",
                "y0": 0,
                "y1": 1,
                "layer": "below",
                "line": {"color": "#b4bec5", "width": 1, "dash": "dot"},
            }
            for place in path.points.values()
        ],
        "annotations": [
            {"text": letter, "x": place, "yref": "paper", "y": 1, "yanchor": "bottom"}
            | {"showarrow": False, "font": {"size": 12}}
            for place, letter in places
        ],
    }
