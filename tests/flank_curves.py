"""Flanks of every family as curves, from its data alone: what its contacts are checked against.

Nothing here calls the geometry of the library. In a section across a line of contact places are complex
numbers; in a section along it a line is straight and a ball is round.
"""

from abc import ABC, abstractmethod

import numpy as np

FLAT = 1e30
"""Radius of a plane [m]."""


def circle(radius, across):
    """Depth of a circle below its tangent."""
    return across**2 / (radius + np.sqrt(radius**2 - across**2))


class Section(ABC):
    """Both flanks about the point where they should touch.

    Attributes:
        size: length over which they do not change much [m].
        scale: size of the numbers behind them, for their rounding [m].
    """

    @abstractmethod
    def height(self, member, across):
        """Height of a flank's point along the normal out of member 0, `across` away from the normal [m]."""


class Curves(ABC):
    """What is asked of each family.

    Attributes:
        slope: cosine of the angle between the line of contact and the section's normal.
        ratio: end of the path.
    """

    slope = 1.0
    ratio = np.inf

    @abstractmethod
    def section(self, path, direction):
        """Section in rolling direction (0) or across it (1) at a place of the path."""

    @abstractmethod
    def velocity(self, coordinate, path):
        """Closing and sliding velocity at the touching point for a unit rate of a coordinate."""

    @abstractmethod
    def path(self, phase, pair, width):
        """Place on the path of a pair, counted from the last one that entered, at a place across the face."""


class Straight(Section):
    """Two straight lines."""

    size, scale = 1e-3, 0.0

    def height(self, member, across):
        return np.zeros_like(across)


class Round(Section):
    """Two circles on either side of their tangent."""

    scale = 0.0

    def __init__(self, first, second):
        self.radii = (first, second)
        self.size = min(self.radii)

    def height(self, member, across):
        depth = circle(self.radii[member], across)
        return -depth if member == 0 else depth


class Discs(Curves):
    """Two cylinders side by side, their axes at right angles to the section."""

    def __init__(self, mesh):
        self.radii = [float(r) for r in mesh.radii]
        self.centres = [0.0, sum(self.radii)]

    def section(self, path, direction):
        return Straight() if direction else Round(*self.radii)

    def velocity(self, coordinate, path):
        moved = 1j * (self.radii[0] - self.centres[coordinate]) * (1.0 if coordinate == 0 else -1.0)
        return moved.real, moved.imag

    def path(self, phase, pair, width):
        return phase + 0.0 * (pair + width)


class Ball(Curves):
    """A ball or barrel on the face of a disc, which lies at right angles to z."""

    def __init__(self, mesh):
        self.radii = [float(r) for r in mesh.radius]
        contact = np.array([float(mesh.track_radius), 0.0, 0.0])
        above = contact + np.array([0.0, 0.0, self.radii[0]])
        self.velocities = (
            np.cross([0.0, 0.0, 1.0], contact),
            -np.cross([1.0, 0.0, 0.0], contact - above),
        )

    def section(self, path, direction):
        return Round(FLAT, self.radii[direction])

    def velocity(self, coordinate, path):
        return self.velocities[coordinate][2], self.velocities[coordinate][1]

    def path(self, phase, pair, width):
        return phase + 0.0 * (pair + width)


def transverse(pressure_angle, helix_angle):
    """Transverse pressure angle and cosine of the base helix angle [rad]."""
    angle, helix = float(pressure_angle), float(helix_angle)
    across = np.arctan(np.tan(angle) / np.cos(helix))
    return across, np.cos(np.arctan(np.tan(helix) * np.cos(across)))


def involute(base, turned, angle, touch, across):
    """Point of the involute of a gear about the origin that lies `across` from the line of action.

    Args:
        base: radius of its circle [m].
        turned: angle at which it leaves the circle [rad].
        angle: of the line of action, from the real axis to its normal [rad].
        touch: point of the line of action.
        across: [m].
    """
    roll = np.full_like(across, turned - angle)
    frame = np.exp(1j * angle)
    for _ in range(30):
        local = (base * np.exp(1j * (turned - roll)) * (1 + 1j * roll) - touch) / frame
        roll = roll - (local.real - across) / (base * roll * np.cos(turned - roll - angle))
    return local


class Involutes(Curves):
    """Involutes of both gears of a cylindrical pair in a transverse section.

    A ring has its centre on the other side, negative radii and a negative roll. Both gears turn from phase 0
    by their tooth numbers, not by where they should touch.
    """

    def __init__(self, mesh):
        self.teeth = np.asarray(mesh.teeth)
        across, self.slope = transverse(mesh.pressure_angle, mesh.helix_angle)
        self.module = float(mesh.module) / np.cos(float(mesh.helix_angle))
        self.base = self.teeth * self.module * np.cos(across) / 2.0
        side = -1.0 if self.teeth[1] < 0 else 1.0
        self.centres = np.array([0.0, side * float(mesh.centre_distance)])
        self.angle = -np.arccos(self.base.sum() / self.centres[1])
        self.tangent = -self.centres[1] * np.sin(self.angle)
        self.start = self.tangent - self._tip_reach(mesh, 1)
        self.pitch = np.pi * self.module * np.cos(across)
        self.hand = -1.0 if bool(mesh.right_flank) else 1.0
        self.ratio = (self._tip_reach(mesh, 0) - self.start) / self.pitch
        self.lag = np.tan(np.arccos(self.slope)) / self.pitch
        self.face, self.helical = float(mesh.face_width), float(mesh.helix_angle) != 0.0

    def _tip_reach(self, mesh, index):
        """Length of the base tangent up to the tip circle; negative on a ring."""
        z, m, x = self.teeth[index], float(mesh.module), float(mesh.profile_shift[index])
        tip = self.module * z / 2 + m * (
            float(mesh.addendum[index]) + x + float(mesh.tip_alteration[index])
        )
        return np.sign(z) * np.sqrt(tip**2 - self.base[index] ** 2)

    def length(self, path):
        """Place on the line of action [m]."""
        return self.start + path * self.pitch

    def touch(self, path):
        """Point that should touch."""
        return np.exp(1j * self.angle) * (self.base[0] + 1j * self.length(path))

    def section(self, path, direction):
        return Straight() if direction else InvoluteSection(self, path)

    def velocity(self, coordinate, path):
        turned = 1j * (self.touch(path) - self.centres[coordinate])
        local = turned / np.exp(1j * self.angle) * self.hand * (1.0 if coordinate == 0 else -1.0)
        return local.imag, -local.real

    def path(self, phase, pair, width):
        return phase + pair - self.helical * self.lag * (width + self.face / 2.0)


class TorusFlanks(Involutes):
    """Involutes of a pair of which tooth thicknesses vary across the face, by arcs of the pitch surfaces."""

    def __init__(self, mesh):
        super().__init__(mesh)
        self.arcs = [float(face.radius) for face in mesh.faces]
        self.lean = np.tan(float(mesh.pressure_angle)) * 2.0 / (self.teeth * self.module)

    def section(self, path, direction):
        return Across(self, path) if direction else InvoluteSection(self, path)

    def thicker(self, member, across):
        """Angle by which the flank of a tooth lies farther out than in the middle of the face [rad]."""
        arc = self.arcs[member]
        return self.lean[member] * np.sign(arc) * (np.sqrt(arc**2 - across**2) - abs(arc))


class InvoluteSection(Section):
    """Involutes of both gears at a place of the path."""

    def __init__(self, curves, path):
        self.curves, self.touch = curves, curves.touch(path)
        start, base, turns = curves.start, curves.base, 2.0 * np.pi * path / curves.teeth
        first = curves.angle + start / base[0] + turns[0]
        second = curves.angle + (curves.tangent - start) / base[1] - turns[1]
        self.turned = (first, second)
        # Steps stay far from the cusps, where the involutes start on their base circles.
        rolls = np.abs([curves.length(path), curves.tangent - curves.length(path)])
        self.size = np.min(rolls * np.minimum(1.0, rolls / np.abs(base)))
        self.scale = abs(curves.centres[1])

    def height(self, member, across):
        curves, side = self.curves, 1.0 if member == 0 else -1.0
        # Gear 2 is seen from its own centre, against the sense of the line of action.
        touch = self.touch if member == 0 else curves.centres[1] - self.touch
        given = curves.base[member], self.turned[member], curves.angle, touch
        return side * involute(*given, side * across).imag


class Across(InvoluteSection):
    """Flanks along the face at a place of the path."""

    def __init__(self, curves, path):
        super().__init__(curves, path)
        self.size = 0.2 * np.min(np.abs(curves.arcs))

    def height(self, member, across):
        curves, side = self.curves, 1.0 if member == 0 else -1.0
        touch = self.touch if member == 0 else curves.centres[1] - self.touch
        turned = self.turned[member] + curves.thicker(member, across)
        local = involute(curves.base[member], turned, curves.angle, touch, np.zeros_like(across))
        return side * local.imag


class RackFlanks(Curves):
    """Involute of a pinion on the straight flank of a rack that travels by its pitch."""

    def __init__(self, mesh):
        pinion, rack = mesh.pinion, mesh.rack
        across, self.slope = transverse(pinion.pressure_angle, pinion.helix_angle)
        self.teeth, module = float(pinion.teeth), float(pinion.module)
        self.pitch = np.pi * module / np.cos(float(pinion.helix_angle))
        reference = self.teeth * self.pitch / (2.0 * np.pi)
        self.base, self.angle = reference * np.cos(across), -across
        tips = float(mesh.distance) - module * float(rack.addendum)
        self.start = (tips - self.base * np.cos(across)) / np.sin(across)
        tip = reference + module * (float(pinion.addendum) + float(pinion.profile_shift))
        self.ratio = (np.sqrt(tip**2 - self.base**2) - self.start) / (self.pitch * np.cos(across))
        self.hand = -1.0 if bool(mesh.right_flank) else 1.0
        self.lag = np.tan(float(pinion.helix_angle)) / self.pitch
        self.face = float(mesh.face_width)

    def touch(self, path):
        """Point of the line of action where the rack's flank crosses it after its travel."""
        travel = path * self.pitch * np.cos(self.angle)
        return np.exp(1j * self.angle) * (self.base + 1j * (self.start + travel))

    def section(self, path, direction):
        return Straight() if direction else RackSection(self, path)

    def velocity(self, coordinate, path):
        moved = 1j * self.touch(path) if coordinate == 0 else 1j
        local = moved / np.exp(1j * self.angle) * self.hand * (1.0 if coordinate == 0 else -1.0)
        return local.imag, -local.real

    def path(self, phase, pair, width):
        return phase + pair - self.lag * (width + self.face / 2.0)


class RackSection(Section):
    """Involute and straight line at a place of the path."""

    def __init__(self, curves, path):
        self.curves, self.touch = curves, curves.touch(path)
        self.turned = curves.angle + curves.start / curves.base + 2.0 * np.pi * path / curves.teeth
        length = (self.touch / np.exp(1j * curves.angle)).imag
        self.size, self.scale = length * min(1.0, length / curves.base), abs(self.touch)

    def height(self, member, across):
        if member == 1:
            return np.zeros_like(across)
        given = self.curves.base, self.turned, self.curves.angle, self.touch
        return involute(*given, across).imag
