"""Gears as polygons, cut by their racks point by point, and how deep two of them overlap; NumPy alone.

Nothing here is that of the package: flanks and fillets come from the normals of the rack, which pass through
the pitch point while it cuts; flanks of rings from the half angle of their space (ISO 21771:2007), their
fillets are arcs.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class Gear:
    """Numbers of a gear as a drawing has them; lengths in normal modules, `teeth` of a ring below zero.

    `shift` has the sign of ISO 21771, `tip` is the radius of the tip circle.
    """

    teeth: int
    shift: float
    dedendum: float
    fillet: float
    tip: float
    angle: float = np.pi / 9.0
    helix: float = 0.0

    @property
    def reference(self) -> float:
        return abs(self.teeth) / (2.0 * np.cos(self.helix))

    @property
    def transverse(self) -> float:
        return float(np.arctan(np.tan(self.angle) / np.cos(self.helix)))

    @property
    def base(self) -> float:
        return self.reference * float(np.cos(self.transverse))

    @cached_property
    def half(self) -> tuple[Array, Array]:
        """Radii from the root to the tip, and half the angle of a tooth there."""
        return self._ring(80) if self.teeth < 0 else self._cut(80)

    def _cut(self, count: int) -> tuple[Array, Array]:
        slope, cosine = np.tan(self.angle), np.cos(self.helix)
        depth = self.dedendum - self.fillet
        width = np.pi / 4.0 - depth * slope - self.fillet / np.cos(self.angle)
        turned = np.linspace(np.pi / 2.0, self.angle, 2 * count)
        arc = self._cut_by(
            (width + self.fillet * np.cos(turned)) / cosine,
            self.shift - depth - self.fillet * np.sin(turned),
            np.cos(turned) * cosine / np.sin(turned),
        )
        deep = np.linspace(depth + self.fillet * np.sin(self.angle), -3.0, 20 * count)
        flank = self._cut_by(
            (np.pi / 4.0 - deep * slope) / cosine, self.shift - deep, cosine / slope
        )
        first = int(np.argmin(flank[0]))  # at the base circle the flank turns back
        flank = flank[0][first:], flank[1][first:]
        root = self.reference + self.shift - self.dedendum
        fine = np.sin(np.linspace(0.0, np.pi / 2.0, count)) ** 2
        radii = np.unique(np.concatenate([root + (self.tip - root) * fine, arc[0]]))
        radii = radii[(radii >= root) & (radii <= self.tip)]
        rising = np.concatenate([[True], np.diff(arc[0]) > 0.0])
        spaces = [
            np.interp(radii, *(part[rising] for part in arc), right=-np.inf),
            np.interp(radii, *flank, left=-np.inf),
        ]
        return radii, np.pi / self.teeth - np.maximum(*spaces)

    def _cut_by(self, along: Array, above: Array, lean: Array | float) -> tuple[Array, Array]:
        """Polar places that points of the rack cut, from the middle of a space.

        They lie `along` the pitch line and `above` it; `lean` is how far their normals go along a unit down.
        """
        rolled = along + above * lean
        angle = np.arctan2(along - rolled, self.reference + above) + rolled / self.reference
        return np.hypot(along - rolled, self.reference + above), angle

    def _ring(self, count: int) -> tuple[Array, Array]:
        root = self.reference + self.dedendum - self.shift
        centre = root - self.fillet
        ends = np.hypot(self.base, np.sqrt(centre**2 - self.base**2) + self.fillet)
        fine = np.sin(np.linspace(0.0, np.pi / 2.0, 2 * count))
        radii = np.concatenate(
            [np.linspace(self.tip, ends, count), ends + (root - ends) * fine[1:]]
        )
        cosine = (radii**2 + centre**2 - self.fillet**2) / (2.0 * radii * centre)
        arc = self._involute(centre) - self.fillet / self.base + np.arccos(np.minimum(cosine, 1.0))
        space = np.where(radii > ends, arc, self._involute(np.maximum(radii, self.base)))
        return radii[::-1], np.pi / abs(self.teeth) - space[::-1]

    def _involute(self, radius: Array | float) -> Array:
        """Half the angle between the involutes of a tooth, of a ring of a space."""
        at = np.arccos(self.base / np.asarray(radius))
        side = np.sign(self.teeth)
        middle = (np.pi / 2.0 + 2.0 * side * self.shift * np.tan(self.angle)) / abs(self.teeth)
        return middle + np.tan(self.transverse) - self.transverse - np.tan(at) + at

    def thickness_angle(self, radius: float) -> float:
        """Half the angle of a tooth at a radius, also beyond its tip."""
        half = float(self._involute(radius))
        return half if self.teeth > 0 else np.pi / abs(self.teeth) - half

    def reached(self, points: Array, centre: float) -> Array:
        """Those of some points that lie within the tip circle, of a ring beyond it."""
        return points[np.sign(self.teeth) * (self.tip - np.abs(points - centre)) > -0.05]

    def polygon(self, axis: float, most: int) -> Array:
        """Corners of the teeth about a direction, as complex numbers, closed behind their roots."""
        radii, half = self.half
        side = np.sign(self.teeth)
        tooth = np.concatenate([radii * np.exp(-1j * half), (radii * np.exp(1j * half))[::-1]])
        pitch = 2.0 * np.pi / abs(self.teeth)
        most = min(most, abs(self.teeth) // 2 - 1)
        teeth = [tooth * np.exp(1j * (axis + pitch * k)) for k in range(-most, most + 1)]
        ends = axis + pitch * np.linspace(most + 0.5, -most - 0.5, 8 * most + 9)
        return np.concatenate([*teeth, (radii[0] - side) * np.exp(1j * ends)])


def deepest(first: Gear, second: Gear, distance: float, phases: int = 24) -> float:
    """How deep the polygons of two gears go into each other over a pitch, along the normal [normal modules].

    Flanks of one side touch; `distance` of the axes, positive, in normal modules.
    """
    ring = second.teeth < 0
    side = -1.0 if ring else 1.0
    ratio = first.teeth / abs(second.teeth)
    pitch_circle = distance * first.teeth / (abs(second.teeth) + side * first.teeth)
    begin = first.thickness_angle(pitch_circle), second.thickness_angle(pitch_circle / ratio)
    centre = distance if not ring else -distance
    most = 3 if not ring or first.teeth / abs(second.teeth) < 0.6 else 8
    found = 0.0
    for turned in 2.0 * np.pi / first.teeth * np.linspace(-0.5, 0.5, phases, endpoint=False):
        one = first.polygon(turned - begin[0], most)
        axis = ratio * turned + begin[1] if ring else np.pi - ratio * turned - begin[1]
        two = second.polygon(axis, most) + centre
        found = max(found, _depth(second.reached(one, centre), two))
        found = max(found, _depth(first.reached(two, 0.0), one))
    return found


def _depth(points: Array, polygon: Array) -> float:
    """Largest distance of points within a polygon from its edge."""
    begins, ends = polygon, np.roll(polygon, -1)
    across = (begins.imag > points.imag[:, None]) != (ends.imag > points.imag[:, None])
    rise = np.where(ends.imag == begins.imag, 1.0, ends.imag - begins.imag)
    meet = begins.real + (points.imag[:, None] - begins.imag) / rise * (ends.real - begins.real)
    inside = points[(across & (points.real[:, None] < meet)).sum(axis=1) % 2 == 1]
    if not inside.size:
        return 0.0
    edge = np.where(ends == begins, 1.0, ends - begins)
    part = ((inside[:, None] - begins) / edge).real.clip(0.0, 1.0)
    return float(np.abs(inside[:, None] - begins - part * edge).min(axis=1).max())
