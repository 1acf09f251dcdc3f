"""Teeth and path of contact to scale: what the page draws of the layers that a family gives.

The picture has y upwards, the page downwards; lengths are in metres here and in mm in the page, angles
counter-clockwise here and clockwise there. Bodies move by the nominal motion of the coordinate of their
name: they turn about their origin, or travel.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import ceil, copysign, cos, degrees, hypot, pi
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.runs.run import Outcome
from pitchpoint.views.outlines import simplified
from pitchpoint.views.path import StraightPath, contact_path
from pitchpoint.views.point import named_members, period_of

__all__ = ["Picture", "PictureBody", "picture_of"]

_FINE = 2e-4
"""Largest distance that a corner of an outline may be moved by, in tooth heights."""

Place = tuple[float, float]

_CIRCLES = ("tip", "working", "base")
_SMALL = 1.6
"""Tip radius over base pitch of a first body that is drawn whole: four or five teeth."""


_LEGENDS = {
    True: {
        "line": " N1 N2, which touches both base circles",
        "circles": "Circles of each gear: tip (thin), pitch circle in operation (dash-dotted), base (dashed)",
    },
    False: {
        "line": "",
        "circles": "Circles and lines of both: tip (thin), pitch in operation (dash-dotted), base (dashed)",
    },
}
"""Words for bodies that all turn, and for a pair of which one travels."""


@dataclass(frozen=True)
class PictureBody:
    """One body of a picture.

    Attributes:
        name: of the body.
        tooth: outline in its own frame [corner, xy], the axis of the tooth along y [m].
        place: of its origin at phase zero [m].
        turned: rotation there [rad].
        levels: distances of circles, or of lines of a body that travels, by name [m].
        count, pitch: number of teeth, and angle [rad] or distance [m] from one to the next.
        spin: rotation in one period [rad]; zero for a body that travels.
        travel: way in one period [m]; zero for a body that turns.
        turns: False for a body that travels.
    """

    name: str
    tooth: np.ndarray
    place: Place
    turned: float
    levels: Mapping[str, float]
    count: int
    pitch: float
    spin: float
    travel: Place
    turns: bool

    @property
    def ring(self) -> bool:
        """True if its teeth point to its centre."""
        return self.turns and self.levels["rim"] > self.levels["root"]

    @property
    def outside(self) -> float:
        """Radius, or half the length of a body that travels [m]."""
        if not self.turns:
            return self.count * self.pitch / 2.0
        return self.levels["rim"] if self.ring else self.levels["tip"]

    @property
    def upwards(self) -> float:
        """1 if the tooth in mesh points upwards, -1 if downwards."""
        return copysign(1.0, cos(self.turned))

    @property
    def root(self) -> float:
        """Height of the root next to the mesh [m]."""
        return self._height(self.levels["root"])

    def _height(self, level: float) -> float:
        """Height next to the mesh of a distance from the origin [m]."""
        return self.place[1] + self.upwards * level

    @property
    def heights(self) -> tuple[float, float]:
        """Lowest and highest point [m]."""
        if self.turns:
            return self.place[1] - self.outside, self.place[1] + self.outside
        ends = [self._height(self.levels[name]) for name in ("tip", "rim")]
        return min(ends), max(ends)

    def outline(self, phase: float, tooth: int = 0) -> np.ndarray:
        """Outline of a tooth at a phase, counted from the first [corner, xy] in m."""
        along = tooth * self.pitch
        turn = self.turned + phase * self.spin + (along if self.turns else 0.0)
        x, y = (self.tooth + np.array([0.0 if self.turns else along, 0.0])).T
        moved = [np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y]
        return np.stack(moved, axis=-1) + self.place + phase * np.array(self.travel)

    def svg(self) -> dict[str, Any]:
        """What the page draws, in mm and degrees, y downwards."""
        x, y = _mm(self.place)
        dx, dy = _mm(self.travel)
        return {
            "ring": self.ring,
            "turns": self.turns,
            "tooth": _points(simplified(self.tooth, _FINE * float(np.ptp(self.tooth[:, 1])))),
            "root_arc": _points(self._root_arc()),
            "repeats": [self._repeat(tooth) for tooth in range(self.count)],
            "place": (x, y),
            "turn": round(-degrees(self.turned), 5),
            "spin": round(-degrees(self.spin), 10),
            "travel": (dx, dy),
            "levels": {name: round(1e3 * at, 4) for name, at in self.levels.items()},
            "name": self.name,
            "heights": {n: round(-1e3 * self._height(at), 4) for n, at in self.levels.items()},
            "circles": [name for name in _CIRCLES if np.isfinite(self.levels[name])],
            "length": round(2e3 * self.outside, 4),
        }

    def _repeat(self, tooth: int) -> str:
        """Transformation that makes a tooth of the first."""
        if self.turns:
            return f"rotate({round(tooth * degrees(self.pitch), 5)})"
        return f"translate({round(1e3 * (tooth - self.count // 2) * self.pitch, 5)} 0)"

    def _root_arc(self) -> np.ndarray:
        """Root circle from the end of the outline back to its start: a ring's teeth end on it.

        Under a tooth of a body that travels its rim, over which it lies without a seam.
        """
        if not self.turns:
            return np.stack([self.tooth[[-1, 0], 0], np.full(2, self.levels["rim"])], axis=-1)
        radius = float(np.hypot(*self.tooth[0]))
        root_angle = float(np.arctan2(self.tooth[-1, 0], self.tooth[-1, 1]))
        angle = np.linspace(root_angle, -np.sign(root_angle) * pi / self.count, 9)
        return np.stack([radius * np.sin(angle), radius * np.cos(angle)], axis=-1)


@dataclass(frozen=True)
class Picture:
    """Bodies in mesh that can be shown at any phase.

    Attributes:
        teeth: dataset of the part `teeth`, with layers.
        path: of contact.
        bodies: of which the first is in front.
        driver: name of the member that drives, and its rate for one radian of it.
    """

    teeth: xr.Dataset
    path: StraightPath
    bodies: tuple[PictureBody, ...]
    driver: tuple[str, float]

    @property
    def behind(self) -> float:
        """Base pitches from the entry of a pair until its contact line is in the section drawn."""
        return self.path.overlap_ratio / 2.0

    @property
    def lanes(self) -> int:
        """Largest number of pairs in contact."""
        return ceil(self.path.contact_ratio - 1e-9)

    @cached_property
    def marks(self) -> list[tuple[str, Place]]:
        """Points with a letter."""
        marks = zip(self.teeth["mark"].values, self.teeth["layer_mark"].values, strict=True)
        return [(str(name), (float(x), float(y))) for name, (x, y) in marks if np.isfinite(x)]

    def contacts(self, phase: float) -> list[Place]:
        """Points of contact at a phase [m]."""
        start, step = self.teeth["contact_start"].values, self.teeth["contact_step"].values
        entered = phase % 1.0 + np.arange(self.lanes + 1)
        path_end = self.path.transverse_ratio * (1.0 + 1e-12)
        inside = (entered >= self.behind) & (entered - self.behind <= path_end)
        return [(float(x), float(y)) for x, y in start + entered[inside, None] * step]

    def svg(self, name: str) -> dict[str, Any]:
        """Everything that the page draws, in mm and degrees, y downwards."""
        window = self._window()
        line, path = ([_mm(end) for end in ends] for ends in self.teeth["layer_line"].values)
        return {
            "name": name,
            "bodies": [body.svg() for body in self.bodies],
            "marks": list(self._labelled(window[2] / 38e3)),
            "path": path,
            "line": line,
            "lanes": self.lanes,
            "window": window,
            "overview": self._overview(),
            "text": round(window[2] / 38.0, 5),
            "motion": self._motion(),
            "motion_json": json.dumps(self._motion()),
            "where": [_where(body, self.bodies) for body in self.bodies],
            "moves": self._moves(),
            "alike": self._alike(),
            "helical": self.path.helical,
            "legend": _LEGENDS[all(body.turns for body in self.bodies)],
        }

    def _moves(self) -> str:
        """Who drives, and which way."""
        name, rate = self.driver
        body = next(body for body in self.bodies if body.name == name)
        left = (body.travel[0] < 0.0) != self.path.backwards
        motion = (
            f"turning {'counter-clockwise' if rate > 0.0 else 'clockwise'}"
            if body.turns
            else f"travelling to the {'left' if left else 'right'}"
        )
        return f"{name.capitalize()} drives, {motion}"

    def _alike(self) -> bool:
        """True if all bodies turn, and the same way."""
        return len({copysign(1.0, body.spin) for body in self.bodies if body.turns}) == 1 and all(
            body.turns for body in self.bodies
        )

    def _overview(self) -> list[float]:
        low, high = (1e3 * end for end in self._reach())
        wide = 1.04e3 * max(body.outside for body in self.bodies if body.turns)
        edge = 0.02 * wide
        return [-wide, -high - edge, 2.0 * wide, high - low + 2.0 * edge]

    def _reach(self) -> tuple[float, float]:
        heights = [body.heights for body in self.bodies]
        return min(low for low, _ in heights), max(high for _, high in heights)

    def _motion(self) -> dict[str, Any]:
        """What the script needs to move the contacts."""
        start, step = (1e3 * self.teeth[f"contact_{of}"].values for of in ("start", "step"))
        return {
            "start": (start * [1.0, -1.0]).round(5).tolist(),
            "step": (step * [1.0, -1.0]).round(5).tolist(),
            "behind": self.behind,
            "ratio": self.path.transverse_ratio,
            "total": self.path.contact_ratio,
            "points": [[name, round(place, 6)] for name, place in self.path.points.items()],
            "direction": -1 if self.path.backwards else 1,
        }

    def _window(self) -> list[float]:
        """View box around the mesh [mm]: path, marks that are near, depth of the teeth."""
        pitch, driver = float(self.teeth["base_pitch"]), self.bodies[0]
        middle = driver.place[1] + driver.upwards * driver.levels["working"]
        places = [(x, y) for _, (x, y) in self.marks if hypot(x, y - middle) < 2.6 * pitch]
        heights = [body.root for body in self.bodies]
        if driver.turns and driver.levels["tip"] < _SMALL * pitch:
            heights.append(-driver.levels["tip"])
        low = min([y for _, y in places] + heights) - 0.25 * pitch
        high = max([y for _, y in places] + heights) + 0.25 * pitch
        left = min([x for x, _ in places] + [-1.2 * pitch]) - 0.45 * pitch
        right = max([x for x, _ in places] + [1.2 * pitch]) + 0.45 * pitch
        high, low = _widened(low, high, (right - left) / 1.7)
        right, left = _widened(left, right, 1.3 * (high - low))
        return [round(1e3 * v, 4) for v in (left, -high, right - left, high - low)]

    def _labelled(self, letter: float) -> Iterator[dict[str, Any]]:
        """Marks, and their letters set off across the line of action; one label for those too close.

        C has its letter on the other side, B is often near.

        Args:
            letter: size of the letters [m].
        """
        groups: list[tuple[list[str], Place]] = []
        for name, (x, y) in self.marks:
            near = [names for names, at in groups if hypot(x - at[0], y - at[1]) < letter]
            if near and name != "C" and near[0] != ["C"]:
                near[0].append(name)
            else:
                groups.append(([name], (x, y)))
        for x, y in (_mm(place) for _, place in self.marks):
            yield {"name": "", "x": x, "y": y, "dx": 0.0, "dy": 0.0}
        for names, place in groups:
            yield self._label(" ".join(names), place)

    def _label(self, name: str, place: Place) -> dict[str, Any]:
        x, y = _mm(place)
        across, up = (float(v) for v in self.teeth["contact_step"].values)
        off = (-1.0 if name == "C" else 1.0) * (1.0 + 0.25 * name.count(" ")) / hypot(across, up)
        dx, dy = -copysign(off, off * across) * up, -off * abs(across)
        return {"name": name, "x": x, "y": y, "dx": round(dx, 3), "dy": round(dy + 0.35, 3)}


def picture_of(outcome: Outcome) -> Picture:
    """Picture of a result whose teeth have layers."""
    teeth, manifest = outcome.parts["teeth"], outcome.manifest
    motion = dict(zip(manifest["members"], manifest["motion"], strict=True))
    period = period_of(outcome)
    step = -period.angle if period.backwards else period.angle
    names = dict(zip(motion, named_members(outcome), strict=True))
    bodies = tuple(
        _body(teeth.isel(body=k), names[name], motion[name] * step)
        for k, name in enumerate(map(str, teeth["body"].values))
    )
    driver = str(manifest["driver"])
    return Picture(teeth, contact_path(outcome), bodies, (names[driver], motion[driver]))


def _body(layer: xr.Dataset, name: str, moved: float) -> PictureBody:
    """A body that moves on by a rotation or a way in each period."""
    x, y = (float(v) for v in layer["layer_place"].values)
    across, up = (float(v) for v in layer["layer_travel"].values)
    turns = across == up == 0.0
    levels = zip(layer["level"].values, layer["layer_level"].values, strict=True)
    return PictureBody(
        name=name,
        tooth=layer["layer_tooth"].values,
        place=(x, y),
        turned=float(layer["layer_turned"]),
        levels={str(level): float(at) for level, at in levels},
        count=round(float(layer["layer_count"])),
        pitch=float(layer["layer_pitch"]),
        spin=moved if turns else 0.0,
        travel=(moved * across, moved * up),
        turns=turns,
    )


def _where(body: PictureBody, bodies: tuple[PictureBody, ...]) -> str:
    """Where a body is seen in the picture."""
    if body.ring:
        return "a ring; its rim is cut off"
    if any(body_beside.ring for body_beside in bodies):
        return "inside"
    return "above" if body.place[1] > 0.0 else "below"


def _widened(low: float, high: float, least: float) -> tuple[float, float]:
    margin = max(least - (high - low), 0.0) / 2.0
    return high + margin, low - margin


def _mm(place: Any) -> Place:
    return round(1e3 * float(place[0]), 4) + 0.0, round(-1e3 * float(place[1]), 4) + 0.0


def _points(outline: np.ndarray) -> str:
    """Points attribute of a polyline, repeated corners left out."""
    corners = [f"{1e3 * x:.4f},{-1e3 * y:.4f}" for x, y in outline]
    return " ".join(dict.fromkeys(corners))
