"""The plane of action: contact lines on their way across the faces, and how long they are together.

Positions across the face are counted from the end at which a line enters, positions along the path
from A. A line that entered eps_0 base pitches ago crosses the face at path = eps_0 - eps_beta times
the part of the face behind it (ISO 21771: eps_beta p_bt = b tan(beta_b)).
"""

import json
from dataclasses import dataclass
from math import ceil, cos, floor
from typing import Any

import xarray as xr

from pitchpoint.results.variable import length
from pitchpoint.views import show

__all__ = ["PlaneOfAction", "plane_of_action"]

_LENGTH = length("", "")
_EDGE = 1e-9

_MARK = 0.03
"""Half the length of the mark of a contact in a point, as part of the face."""


@dataclass(frozen=True)
class PlaneOfAction:
    """Rectangle of path of contact times face width, and the contact lines in it.

    Attributes:
        transverse_ratio, overlap_ratio: transverse contact ratio and overlap ratio.
        base_pitch: transverse base pitch [m].
        face_width: [m].
        base_helix_angle: inclination of the lines to the axes [rad].
        pitch_line: position of the pitch point C from A [m].
        point: part of the face at which flanks touch in points; None where they touch along lines.
    """

    transverse_ratio: float
    overlap_ratio: float
    base_pitch: float
    face_width: float
    base_helix_angle: float
    pitch_line: float
    point: float | None = None

    @property
    def length(self) -> float:
        """Length of the path of contact [m]."""
        return self.transverse_ratio * self.base_pitch

    @property
    def lanes(self) -> int:
        """Largest count of contact lines at a time."""
        return ceil(self.transverse_ratio + self.overlap_ratio - _EDGE)

    def ends(self, entered: float) -> tuple[float, float] | None:
        """Parts of the face between which a line touches; None before its entry and after its exit.

        Args:
            entered: base pitches since the pair entered.
        """
        if not 0.0 <= entered <= self.transverse_ratio + self.overlap_ratio:
            return None
        if self.overlap_ratio == 0.0:
            return self._straight
        low = (entered - self.transverse_ratio) / self.overlap_ratio
        return max(low, 0.0), min(entered / self.overlap_ratio, 1.0)

    @property
    def _straight(self) -> tuple[float, float]:
        """Parts of the face between which straight teeth touch; a mark where they touch in a point."""
        return (0.0, 1.0) if self.point is None else (self.point - _MARK, self.point + _MARK)

    def total_length(self, phase: float) -> float:
        """Length of all contact lines together at a phase [m]."""
        contact_ends = (self.ends(phase % 1.0 + lane) for lane in range(self.lanes + 1))
        share = sum(ends[1] - ends[0] for ends in contact_ends if ends)
        return share * self.face_width / cos(self.base_helix_angle)

    @property
    def mean_length(self) -> float:
        """Mean length of all contact lines together [m]: eps_alpha b/cos(beta_b)."""
        return self.transverse_ratio * self.face_width / cos(self.base_helix_angle)

    @property
    def extreme_lengths(self) -> tuple[float, float]:
        """Smallest and largest length of all contact lines together [m].

        With the fractional parts n of both ratios, relative to the mean length,

            smallest  1 - (1 - n_a)(1 - n_b)/(eps_a eps_b)  if n_a + n_b > 1
                      1 - n_a n_b/(eps_a eps_b)             else
            largest   1 + min(n_a (1 - n_b), n_b (1 - n_a))/(eps_a eps_b)

        and for straight teeth whole numbers of lines across the face.
        """
        a, b = self.transverse_ratio, self.overlap_ratio
        if b == 0.0:
            return floor(a + _EDGE) * self.face_width, ceil(a - _EDGE) * self.face_width
        n_a, n_b = a % 1.0, b % 1.0
        less = (1.0 - n_a) * (1.0 - n_b) if n_a + n_b > 1.0 else n_a * n_b
        excess = min(n_a * (1.0 - n_b), n_b * (1.0 - n_a))
        return (
            self.mean_length * (1.0 - less / (a * b)),
            self.mean_length * (1.0 + excess / (a * b)),
        )

    def picture(self) -> dict[str, Any]:
        """Everything that the page draws, in mm, the path upwards."""
        width, height = 1e3 * self.face_width, 1e3 * self.length
        text = _text_size(width, height)
        low, high = self.extreme_lengths
        return {
            "width": round(width, 4),
            "height": round(height, 4),
            "window": [-2.2 * text, -height - 1.6 * text, width + 4.4 * text, height + 4.6 * text],
            "text": round(text, 5),
            "pitch_line": round(-1e3 * self.pitch_line, 4),
            "has_pitch_line": 0.0 <= self.pitch_line <= self.length,
            "lanes": self.lanes,
            "point": self.point,
            "mean": 1e3 * self.mean_length,
            "least": 1e3 * low,
            "most": 1e3 * high,
            "motion_json": json.dumps(self._motion()),
        }

    def _motion(self) -> dict[str, Any]:
        """What the script needs to move the lines."""
        return {
            "alpha": self.transverse_ratio,
            "beta": self.overlap_ratio,
            "ends": self._straight,
            "pitch": round(1e3 * self.base_pitch, 6),
            "width": round(1e3 * self.face_width, 6),
            "slope": cos(self.base_helix_angle),
            "unit": show.display_unit(_LENGTH.display),
            "of_mm": float(_LENGTH.displayed(1e-3)),
        }


def plane_of_action(teeth: xr.Dataset) -> PlaneOfAction:
    """Plane of action of a result's teeth."""
    places = dict(zip(teeth["point"].values.tolist(), teeth["points"].values.tolist(), strict=True))
    return PlaneOfAction(
        transverse_ratio=float(teeth["transverse_contact_ratio"]),
        overlap_ratio=float(teeth["overlap_ratio"]),
        base_pitch=float(teeth["base_pitch"]),
        face_width=float(teeth["face_width"]),
        base_helix_angle=float(teeth["base_helix_angle"]),
        pitch_line=places["C"] - places["A"],
        point=_point(teeth),
    )


def _point(teeth: xr.Dataset) -> float | None:
    """Part of the face at which flanks touch in a point."""
    if "contact_place" not in teeth:
        return None
    return 0.5 + float(teeth["contact_place"]) / float(teeth["face_width"])


def _text_size(width: float, height: float) -> float:
    """Letters that can be read whichever side of the rectangle fills the page."""
    return max(width / 33.0, height / 14.0)
