"""Teeth and path of contact to scale: where the gears stand at a phase, and the drawing.

Gear 1 has its centre at the origin, gear 2 above it; a ring has its centre below. Gear 1 turns
counter-clockwise with growing phase, the contacts run from A to E along the common tangent of the
base circles that rises to the left; with the opposite flanks everything is mirrored. Lengths are in
metres, angles of rotation counter-clockwise from the position in which the tooth axis points up.
Helical gears are cut in the transverse section at the middle of the face: there a pair touches when
half of its contact line is behind, half of the overlap ratio after it entered.
"""

import json
from dataclasses import dataclass
from math import acos, atan2, ceil, cos, degrees, hypot, pi, sin, tan
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.facts import Facts, facts
from pitchpoint.views.inputs import words

__all__ = ["Drawing", "dimensions", "drawing", "specific_sliding"]

Place = tuple[float, float]


@dataclass(frozen=True)
class Drawing:
    """A gear pair that can be shown at any phase.

    Attributes:
        teeth: dataset of the part `teeth`.
        fact: driver, flank, points.
    """

    teeth: xr.Dataset
    fact: Facts

    @property
    def side(self) -> float:
        """-1 for the opposite flanks, which mirror the drawing."""
        return -1.0 if self.fact.right_flank else 1.0

    @property
    def sides(self) -> tuple[float, float]:
        """For each gear 1, or -1 for a ring, whose teeth point to its centre."""
        return 1.0, -1.0 if self.fact.internal else 1.0

    @property
    def distance(self) -> float:
        """Height of the centre of gear 2 over that of gear 1 [m]; negative for a ring."""
        return self.sides[1] * float(self.teeth["centre_distance"])

    @property
    def behind(self) -> float:
        """Base pitches from the entry of a pair until its contact line is in the section drawn."""
        return self.fact.overlap_ratio / 2.0

    @property
    def angle(self) -> float:
        """Working pressure angle [rad]."""
        return float(self.teeth["working_pressure_angle"])

    @property
    def tangent_length(self) -> float:
        """Position of N2 from N1 [m]; negative for a ring."""
        return self.distance * sin(self.angle)

    def radius(self, circle: str, gear: int) -> float:
        """Radius of a circle of gear 0 or 1 [m]; circle as base, tip, root, reference, working."""
        return float(self.teeth[f"{circle}_radius"].values[gear])

    def on_line(self, position: float) -> Place:
        """Point of the line of action at a position from N1 [m]."""
        base = self.radius("base", 0)
        x = base * sin(self.angle) - position * cos(self.angle)
        return self.side * x, base * cos(self.angle) + position * sin(self.angle)

    def contacts(self, phase: float) -> list[Place]:
        """Points of contact at a phase [base pitches]."""
        return [self.on_line(position) for position in self._positions(phase)]

    def rotations(self, phase: float) -> tuple[float, float]:
        """Rotation of one tooth of each gear that touches at a phase [rad]."""
        start = float(self.teeth["points"].values[0])
        first, second = (self._rotation(gear, start) for gear in (0, 1))
        z1, z2 = self.fact.teeth
        turn = 2.0 * pi * (phase - self.behind) * self.side
        return first + turn / z1, second - turn / z2

    def half_angle(self, gear: int, radius: float) -> float:
        """Half the tooth's angle at a radius on the involute, transverse section [rad]."""
        tip = self.radius("tip", gear)
        change = self._involute(gear, tip) - self._involute(gear, radius)
        return self._tip_thickness(gear) / (2.0 * tip) + self.sides[gear] * change

    def _tip_thickness(self, gear: int) -> float:
        """Tip thickness in the transverse section [m]; the dataset holds that of the normal section."""
        slope = tan(float(self.teeth["base_helix_angle"]))
        slope *= self.radius("tip", gear) / self.radius("base", gear)
        return float(self.teeth["tip_thickness"].values[gear]) * hypot(1.0, slope)

    def outline(self, gear: int, phase: float, tooth: int = 0) -> np.ndarray:
        """Outline of a tooth at a phase [m], counted from the one that touches, [corner, xy]."""
        turn = self.rotations(phase)[gear] + tooth * 2.0 * pi / abs(self.fact.teeth[gear])
        x, y = self.teeth["outline"].values[gear].T
        return np.stack(
            [
                x * np.cos(turn) - y * np.sin(turn),
                x * np.sin(turn) + y * np.cos(turn) + gear * self.distance,
            ],
            axis=-1,
        )

    def _positions(self, phase: float) -> list[float]:
        start, pitch = float(self.teeth["points"].values[0]), float(self.teeth["base_pitch"])
        lanes = ceil(self.fact.contact_ratio)
        each = [phase % 1.0 + lane - self.behind for lane in range(lanes + 1)]
        ratio = self.fact.transverse_ratio * (1.0 + 1e-12)
        return [start + place * pitch for place in each if 0.0 <= place <= ratio]

    def _rotation(self, gear: int, position: float) -> float:
        """Rotation of a tooth whose flank passes through the point of the line of action."""
        x, y = self.on_line(position)
        y -= gear * self.distance
        half = self.sides[gear] * self.half_angle(gear, hypot(x, y))
        return atan2(-x, y) - self.side * half

    def _involute(self, gear: int, radius: float) -> float:
        pressure = acos(min(self.radius("base", gear) / radius, 1.0))
        return tan(pressure) - pressure

    def picture(self, name: str) -> dict[str, Any]:
        """Everything that the page draws, in mm and degrees, y downwards."""
        window = _window(self)
        return {
            "name": name,
            "gears": [self._gear(gear) for gear in (0, 1)],
            "marks": _labelled(self, window[2] / 38e3),
            "path": [_mm(self.on_line(float(p))) for p in self.teeth["points"].values[[0, -1]]],
            "line": [_mm(self.on_line(p)) for p in self._line_ends()],
            "lanes": ceil(self.fact.contact_ratio - 1e-9),
            "window": window,
            "overview": self._overview(),
            "text": round(window[2] / 38.0, 5),
            "motion": self._motion(),
            "motion_json": json.dumps(self._motion()),
            "driver_turns": self._driver_turns(),
        }

    def _gear(self, gear: int) -> dict[str, Any]:
        turn = degrees(self.rotations(0.0)[gear])
        teeth = self.fact.teeth[gear]
        spin = self.side * (1.0, -1.0)[gear] * 360.0 / teeth
        circles = ("tip", "working", "base", "root")
        return {
            "ring": self.sides[gear] < 0.0,
            "tooth": _points(self.teeth["outline"].values[gear]),
            "root_arc": _points(self._root_arc(gear)),
            "turns": [round(k * 360.0 / abs(teeth), 5) for k in range(abs(teeth))],
            "centre": round(-1e3 * gear * self.distance, 4),
            "turn": round(-turn, 5),
            "spin": -spin,
            "radii": {name: round(1e3 * self.radius(name, gear), 4) for name in circles}
            | {"rim": round(1e3 * self._rim(gear), 4)},
        }

    def _root_arc(self, gear: int) -> np.ndarray:
        """Root circle from the end of the outline back to its start: a ring's teeth end on it."""
        outline = self.teeth["outline"].values[gear]
        half = pi / abs(self.fact.teeth[gear])
        radius = float(np.hypot(*outline[0]))
        last = float(np.arctan2(outline[-1, 0], outline[-1, 1]))
        angle = np.linspace(last, -np.sign(last) * half, 9)
        return np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)

    def _rim(self, gear: int) -> float:
        """Radius at which the drawing ends a ring [m]; its true outside is not known here."""
        return self.radius("root", gear) + 0.8 * abs(
            self.radius("root", gear) - self.radius("tip", gear)
        )

    def _marked(self) -> list[tuple[str, Place]]:
        points = zip(self.teeth["point"].values, self.teeth["points"].values, strict=True)
        named = [
            (str(name), self.on_line(float(p))) for name, p in points if name in self.fact.points
        ]
        return [*named, ("N1", self.on_line(0.0)), ("N2", self.on_line(self.tangent_length))]

    def _line_ends(self) -> tuple[float, float]:
        """Ends of the line of action as drawn: N1, N2 and the path between or beyond them."""
        ends = [0.0, self.tangent_length, *self.teeth["points"].values[[0, -1]].tolist()]
        return min(ends), max(ends)

    def _overview(self) -> list[float]:
        outside = [1e3 * self._outside(gear) for gear in (0, 1)]
        low = max(outside[0], -1e3 * self.distance + outside[1])
        high = max(outside[0], 1e3 * self.distance + outside[1])
        wide = 1.04 * max(outside)
        edge = 0.02 * wide
        return [-wide, -high - edge, 2.0 * wide, high + low + 2.0 * edge]

    def _outside(self, gear: int) -> float:
        return self._rim(gear) if self.sides[gear] < 0.0 else self.radius("tip", gear)

    def _driver_turns(self) -> str:
        """Sense of the driver: gear 1 drives the upper flanks to the left, gear 2 drives back."""
        back = self.fact.backwards and self.fact.internal
        return "counter-clockwise" if (self.side > 0.0) != back else "clockwise"

    def _motion(self) -> dict[str, Any]:
        """What the script needs to move the drawing."""
        start, pitch = self.teeth["points"].values[0], float(self.teeth["base_pitch"])
        first = np.array(_mm(self.on_line(float(start))))
        step = np.array(_mm(self.on_line(float(start) + pitch))) - first
        return {
            "start": (first - self.behind * step).round(5).tolist(),
            "step": step.round(5).tolist(),
            "behind": self.behind,
            "ratio": self.fact.transverse_ratio,
            "total": self.fact.contact_ratio,
            "points": [[name, round(place, 6)] for name, place in self.fact.points.items()],
            "direction": -1 if self.fact.backwards else 1,
        }


def drawing(outcome: Outcome) -> Drawing:
    """Drawing of a result whose teeth are there."""
    return Drawing(outcome.parts["teeth"], facts(outcome))


def dimensions(outcome: Outcome) -> list[tuple[str, ...]]:
    """Names of the main dimensions, each with its values for both gears or the one they share."""
    teeth, fact = outcome.parts["teeth"], facts(outcome)

    def values(name: str, factor: float, digits: int = 6) -> list[str]:
        return [show.number(factor * float(v), digits) for v in np.ravel(teeth[name].values)]

    def diameters(name: str) -> list[str]:
        return values(f"{name}_radius", 2e3)

    def backlash(kind: str) -> list[str]:
        name = f"{kind}_backlash"
        return [show.quantity(name, float(teeth[name]), with_unit=False)]

    def input_row(title: str, key: str) -> list[tuple[str, ...]]:
        found = words(outcome, "gears", key).replace(" deg", "°").split(" / ")
        each = [show.pretty(one).replace("-", "−") for one in found if one]
        return [(title, *each)] if each else []

    angle, helix = (
        degrees(float(teeth[n])) for n in ("working_pressure_angle", "base_helix_angle")
    )
    rows = [("number of teeth z", *values("teeth", 1.0))]
    rows += input_row("normal module m_n" if fact.helical else "module m", "module")
    rows += input_row("helix angle β", "helix_angle") if fact.helical else []
    rows += [("base helix angle β_b [°]", show.number(helix, 6))] if fact.helical else []
    rows += input_row("profile shift x", "profile_shift")
    rows += _undercut_limits(teeth, fact)
    if np.abs(teeth["tip_alteration"].values).max() > 5e-7:
        rows.append(("tip alteration k [modules]", *values("tip_alteration", 1.0, 4)))
    rows += [
        ("reference diameter d [mm]", *diameters("reference")),
        ("base diameter d_b [mm]", *diameters("base")),
        ("tip diameter d_a [mm]", *diameters("tip")),
        ("root diameter d_f [mm]", *diameters("root")),
        ("form diameter d_Ff [mm]", *diameters("form")),
        ("active root diameter d_Nf [mm]", *diameters("active_root")),
        ("pitch diameter in operation d_w [mm]", *diameters("working")),
        (_TIP_THICKNESS[fact.helical], *values("tip_thickness", 1e3, 4)),
        ("specific sliding at A", *values("specific_sliding_A", 1.0, 4)),
        ("specific sliding at E", *values("specific_sliding_E", 1.0, 4)),
        ("centre distance a [mm]", *values("centre_distance", 1e3)),
        ("backlash on the pitch circles j_wt [µm]", *backlash("circumferential")),
        ("backlash along the normal j_bn [µm]", *backlash("normal")),
        ("face width b [mm]", *values("face_width", 1e3)),
        (f"{_transverse(fact)}base pitch p_b{_t(fact)} [mm]", *values("base_pitch", 1e3)),
        (
            f"{_transverse(fact)}pressure angle in operation α_w{_t(fact)} [°]",
            show.number(angle, 6),
        ),
        ("transverse contact ratio ε_α", *values("transverse_contact_ratio", 1.0, 4)),
    ]
    if fact.helical:
        rows.append(("overlap ratio ε_β", *values("overlap_ratio", 1.0, 4)))
        rows.append(("total contact ratio ε_γ", *values("contact_ratio", 1.0, 4)))
    return rows


_TIP_THICKNESS = {
    False: "tooth thickness on the tip circle s_a [mm]",
    True: "tooth thickness on the tip circle, normal section s_an [mm]",
}


def _transverse(fact: Facts) -> str:
    return "transverse " if fact.helical else ""


def _t(fact: Facts) -> str:
    return "t" if fact.helical else ""


def _undercut_limits(teeth: xr.Dataset, fact: Facts) -> list[tuple[str, ...]]:
    """Smallest profile shifts without undercut; a ring is not cut by a rack."""
    limits = [show.number(float(value), 4) for value in teeth["undercut_limit"].values]
    if fact.internal:
        limits[1] = "not cut by a rack"
    return [("smallest x without undercut x_min", *limits)]


def specific_sliding(teeth: xr.Dataset, position: np.ndarray) -> np.ndarray:
    """Sliding speed over own rolling speed of each gear (ISO 21771), [position, gear].

    Args:
        teeth: part `teeth` of a result.
        position: on the line of action, from N1 [m].
    """
    z1, z2 = teeth["teeth"].values
    rolling = np.stack([position / z1, (float(teeth["tangent_length"]) - position) / z2], axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(1.0 - rolling[..., ::-1] / rolling)


def _window(shown: Drawing) -> list[float]:
    """View box around the mesh [mm]: path, base tangent points that are near, depth of the teeth."""
    pitch = float(shown.teeth["base_pitch"])
    centre = (0.0, shown.radius("working", 0))
    places = [
        place for _, place in shown._marked() if hypot(place[0], place[1] - centre[1]) < 2.6 * pitch
    ]
    far_root = shown.distance - shown.sides[1] * shown.radius("root", 1)
    heights = [shown.radius("root", 0), far_root]
    if shown.radius("tip", 0) < _SMALL * pitch:
        heights.append(-shown.radius("tip", 0))
    low = min([y for _, y in places] + heights) - 0.25 * pitch
    high = max([y for _, y in places] + heights) + 0.25 * pitch
    left = min([x for x, _ in places] + [-1.2 * pitch]) - 0.45 * pitch
    right = max([x for x, _ in places] + [1.2 * pitch]) + 0.45 * pitch
    high, low = _widened(low, high, (right - left) / 1.7)
    right, left = _widened(left, right, 1.3 * (high - low))
    return [round(1e3 * v, 4) for v in (left, -high, right - left, high - low)]


_SMALL = 1.6
"""Tip radius over base pitch of a gear 1 that is drawn whole: four or five teeth."""


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    more = max(least - (high - low), 0.0) / 2.0
    return high + more, low - more


def _labelled(shown: Drawing, letter: float) -> list[dict[str, Any]]:
    """Marks with their letters set off across the line of action; one label for those too close.

    C has its letter on the other side, B is often near.

    Args:
        shown: the drawing.
        letter: size of the letters [m].
    """
    groups: list[tuple[list[str], Place]] = []
    for name, place in shown._marked():
        near = [names for names, at in groups if hypot(place[0] - at[0], place[1] - at[1]) < letter]
        if near and name != "C" and near[0] != ["C"]:
            near[0].append(name)
        else:
            groups.append(([name], place))
    named = [_label(shown, " ".join(names), place) for names, place in groups]
    dots = [
        {"name": "", "x": x, "y": y, "dx": 0.0, "dy": 0.0}
        for x, y in (_mm(place) for _, place in shown._marked())
    ]
    return dots + named


def _label(shown: Drawing, name: str, place: Place) -> dict[str, Any]:
    x, y = _mm(place)
    off = (-1.0 if name == "C" else 1.0) * (1.0 + 0.25 * name.count(" "))
    dx, dy = off * shown.side * sin(shown.angle), -off * cos(shown.angle)
    return {"name": name, "x": x, "y": y, "dx": round(dx, 3), "dy": round(dy + 0.35, 3)}


def _mm(place: Place) -> Place:
    return round(1e3 * place[0], 4), round(-1e3 * place[1], 4)


def _points(outline: np.ndarray) -> str:
    """Points attribute of a polyline, repeated corners left out."""
    corners = [f"{1e3 * x:.4f},{-1e3 * y:.4f}" for x, y in outline]
    return " ".join(dict.fromkeys(corners))
