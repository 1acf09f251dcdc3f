"""Teeth and path of contact to scale: where the gears stand at a phase, and the drawing.

Gear 1 has its centre at the origin, gear 2 above it. Gear 1 turns counter-clockwise with growing
phase, the contacts run from A to E along the common tangent of the base circles that rises to the
left; with the opposite flanks everything is mirrored. Lengths are in metres, angles of rotation
counter-clockwise from the position in which the tooth axis points up.
"""

import json
from dataclasses import dataclass
from math import acos, atan2, ceil, cos, degrees, hypot, pi, sin, tan
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.cases.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.facts import Facts, facts

__all__ = ["Drawing", "dimensions", "drawing"]

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
    def distance(self) -> float:
        """Centre distance [m]."""
        return float(self.teeth["centre_distance"])

    @property
    def angle(self) -> float:
        """Working pressure angle [rad]."""
        return float(self.teeth["working_pressure_angle"])

    @property
    def tangent_length(self) -> float:
        """Length N1 N2 [m]."""
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
        turn = 2.0 * pi * phase * self.side
        return first + turn / z1, second - turn / z2

    def half_angle(self, gear: int, radius: float) -> float:
        """Half the tooth's angle at a radius on the involute [rad]."""
        tip = self.radius("tip", gear)
        thickness = float(self.teeth["tip_thickness"].values[gear])
        return thickness / (2.0 * tip) + self._involute(gear, tip) - self._involute(gear, radius)

    def outline(self, gear: int, phase: float, tooth: int = 0) -> np.ndarray:
        """Outline of a tooth at a phase [m], counted from the one that touches, [corner, xy]."""
        turn = self.rotations(phase)[gear] + tooth * 2.0 * pi / self.fact.teeth[gear]
        x, y = self.teeth["outline"].values[gear].T
        return np.stack(
            [
                x * np.cos(turn) - y * np.sin(turn),
                x * np.sin(turn) + y * np.cos(turn) + gear * self.distance,
            ],
            axis=-1,
        )

    def _positions(self, phase: float) -> list[float]:
        points, pitch = self.teeth["points"].values, float(self.teeth["base_pitch"])
        lanes = ceil(self.fact.contact_ratio)
        each = [float(points[0]) + (phase % 1.0 + lane) * pitch for lane in range(lanes + 1)]
        return [position for position in each if position <= float(points[-1]) * (1.0 + 1e-12)]

    def _rotation(self, gear: int, position: float) -> float:
        """Rotation of a tooth whose flank passes through the point of the line of action."""
        x, y = self.on_line(position)
        y -= gear * self.distance
        return atan2(-x, y) - self.side * self.half_angle(gear, hypot(x, y))

    def _involute(self, gear: int, radius: float) -> float:
        pressure = acos(min(self.radius("base", gear) / radius, 1.0))
        return tan(pressure) - pressure

    def picture(self, name: str) -> dict[str, Any]:
        """Everything that the page draws, in mm and degrees, y downwards."""
        window = _window(self)
        return {
            "name": name,
            "gears": [self._gear(gear) for gear in (0, 1)],
            "marks": [_labelled(self, key, place) for key, place in self._marked()],
            "path": [_mm(self.on_line(float(p))) for p in self.teeth["points"].values[[0, -1]]],
            "line": [_mm(self.on_line(p)) for p in (0.0, self.tangent_length)],
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
        spin = self.side * (1.0, -1.0)[gear] * 360.0 / self.fact.teeth[gear]
        circles = ("tip", "working", "base", "root")
        return {
            "tooth": _points(self.teeth["outline"].values[gear]),
            "turns": [k * 360.0 / self.fact.teeth[gear] for k in range(self.fact.teeth[gear])],
            "centre": round(-1e3 * gear * self.distance, 4),
            "turn": round(-turn, 5),
            "spin": -spin,
            "radii": {name: round(1e3 * self.radius(name, gear), 4) for name in circles},
        }

    def _marked(self) -> list[tuple[str, Place]]:
        points = zip(self.teeth["point"].values, self.teeth["points"].values, strict=True)
        named = [
            (str(name), self.on_line(float(p))) for name, p in points if name in self.fact.points
        ]
        return [*named, ("N1", self.on_line(0.0)), ("N2", self.on_line(self.tangent_length))]

    def _overview(self) -> list[float]:
        tips = [1e3 * self.radius("tip", gear) for gear in (0, 1)]
        wide = 1.04 * max(tips)
        top = 1e3 * self.distance + tips[1]
        return [-wide, -top - 0.02 * wide, 2.0 * wide, top + tips[0] + 0.04 * wide]

    def _driver_turns(self) -> str:
        """Sense of the driver: gear 1 drives the upper flanks to the left, gear 2 drives back."""
        return "counter-clockwise" if self.side > 0.0 else "clockwise"

    def _motion(self) -> dict[str, Any]:
        """What the script needs to move the drawing."""
        start, pitch = self.teeth["points"].values[0], float(self.teeth["base_pitch"])
        first = np.array(_mm(self.on_line(float(start))))
        step = np.array(_mm(self.on_line(float(start) + pitch))) - first
        return {
            "start": first.round(5).tolist(),
            "step": step.round(5).tolist(),
            "ratio": self.fact.contact_ratio,
            "points": [[name, round(place, 6)] for name, place in self.fact.points.items()],
            "direction": -1 if self.fact.backwards else 1,
        }


def drawing(outcome: Outcome) -> Drawing:
    """Drawing of a result whose teeth are there."""
    return Drawing(outcome.parts["teeth"], facts(outcome))


def dimensions(outcome: Outcome) -> list[tuple[str, ...]]:
    """Names of the main dimensions, each with its values for both gears or the one they share."""
    teeth = outcome.parts["teeth"]

    def values(name: str, factor: float, digits: int = 6) -> list[str]:
        return [show.number(factor * float(v), digits) for v in np.ravel(teeth[name].values)]

    angle = degrees(float(teeth["working_pressure_angle"]))
    return [
        ("number of teeth z", *values("teeth", 1.0)),
        ("reference radius r [mm]", *values("reference_radius", 1e3)),
        ("base radius r_b [mm]", *values("base_radius", 1e3)),
        ("tip radius r_a [mm]", *values("tip_radius", 1e3)),
        ("root radius r_f [mm]", *values("root_radius", 1e3)),
        ("pitch radius in operation r_w [mm]", *values("working_radius", 1e3)),
        ("tooth thickness on the tip circle s_a [mm]", *values("tip_thickness", 1e3, 4)),
        ("specific sliding at A", *values("specific_sliding_A", 1.0, 4)),
        ("specific sliding at E", *values("specific_sliding_E", 1.0, 4)),
        ("centre distance a [mm]", *values("centre_distance", 1e3)),
        ("base pitch p_b [mm]", *values("base_pitch", 1e3)),
        ("working pressure angle α_w [°]", show.number(angle, 6)),
        ("transverse contact ratio ε_α", *values("contact_ratio", 1.0, 4)),
    ]


def _window(shown: Drawing) -> list[float]:
    """View box around the mesh [mm]: path, base tangent points that are near, depth of the teeth."""
    pitch = float(shown.teeth["base_pitch"])
    centre = (0.0, shown.radius("working", 0))
    places = [
        place for _, place in shown._marked() if hypot(place[0], place[1] - centre[1]) < 2.6 * pitch
    ]
    heights = [shown.radius("root", 0), shown.distance - shown.radius("root", 1)]
    low = min([y for _, y in places] + heights) - 0.25 * pitch
    high = max([y for _, y in places] + heights) + 0.25 * pitch
    left = min([x for x, _ in places] + [-1.2 * pitch]) - 0.45 * pitch
    right = max([x for x, _ in places] + [1.2 * pitch]) + 0.45 * pitch
    high, low = _widened(low, high, (right - left) / 1.7)
    return [round(1e3 * v, 4) for v in (left, -high, right - left, high - low)]


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    more = max(least - (high - low), 0.0) / 2.0
    return high + more, low - more


def _labelled(shown: Drawing, name: str, place: Place) -> dict[str, Any]:
    """Mark with its letter set off across the line of action; C on the other side, B is often near."""
    x, y = _mm(place)
    off = -1.0 if name == "C" else 1.0
    dx, dy = off * shown.side * sin(shown.angle), -off * cos(shown.angle)
    return {"name": name, "x": x, "y": y, "dx": round(dx, 3), "dy": round(dy + 0.35, 3)}


def _mm(place: Place) -> Place:
    return round(1e3 * place[0], 4), round(-1e3 * place[1], 4)


def _points(outline: np.ndarray) -> str:
    """Points attribute of a polyline, repeated corners left out."""
    corners = [f"{1e3 * x:.4f},{-1e3 * y:.4f}" for x, y in outline]
    return " ".join(dict.fromkeys(corners))
