"""A strain wave gear by positions alone: outlines, the deformed neutral line, and the groove they sweep.

Nothing here differentiates a formula or calls the library: normals, velocities and curvatures are
differences of positions. Places are complex numbers, the real part outwards along the middle of a
space of the circular spline, the imaginary part across it.

Formulas: Zhao et al. (2022), eqs. 1 to 7, with the signs that close the profile.
"""

from dataclasses import astuple, dataclass, replace

import numpy as np
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

STEEPEST = 1.4
SPACING = np.deg2rad(0.1)
LOWEST = 1e-9
"""A ridge between two valleys of the play is at least so high [m]."""
STEPS = np.arange(-4, 5)
FIRST = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])


def slope(function, at, step):
    """First derivative by central differences of order eight."""
    return np.tensordot(FIRST, np.stack([function(at + k * step) for k in STEPS]), 1) / step


def bend(function, at, step):
    """Second derivative by central differences of order eight."""
    return np.tensordot(SECOND, np.stack([function(at + k * step) for k in STEPS]), 1) / step**2


def turned(angle):
    """Unit vector at an angle from across the tooth towards its axis."""
    return np.sin(angle) + 1j * np.cos(angle)


class Tip:
    """Relief and rounding of a flank beyond a place on it: an arc that bends more, then the edge."""

    def __init__(self, start, angle, curvature, made):
        """Place, angle and curvature of the flank where the relief begins."""
        self.length, self.edge = made.relief_length, made.rounding
        bent = 2.0 * made.relief / made.relief_length**2 if made.relief_length else 0.0
        self.radius, self.first = 1.0 / (curvature + bent), angle
        self.last = angle + self.length / self.radius
        self.centre = start - self.radius * turned(angle)
        self.corner = self.centre + (self.radius - self.edge) * turned(self.last)
        self.lengths = [self.length, self.edge * (STEEPEST - self.last)]

    def place(self, beyond):
        """Place at an arc length from there."""
        relieved = self.centre + self.radius * turned(self.first + beyond / self.radius)
        angle = self.last + (beyond - self.length) / self.edge
        return np.where(beyond < self.length, relieved, self.corner + self.edge * turned(angle))


class Outline:
    """Right flank of a tooth by arc length from its root; `lengths` of its pieces, the edge last."""

    @property
    def length(self):
        """From the root to the end of the rounding."""
        return self.lengths.sum()

    @property
    def plain(self):
        """From the root to where the rounding begins."""
        return self.lengths[:-1].sum()


class DoubleArc(Outline):
    """Right flank of a double-arc tooth by arc length from its root, from the neutral line."""

    def __init__(self, form, module, rim, made):
        """All of the form in modules; module, rim thickness and how tips are made in metres."""
        la, ea, lf, ef = (
            module * getattr(form, name)
            for name in ("convex_offset", "convex_shift", "concave_offset", "concave_shift")
        )
        self.radii = module * np.array([form.concave_radius, form.convex_radius])
        ha, hf = module * form.addendum, module * form.dedendum
        pitch_line = rim / 2.0 + hf
        self.convex = pitch_line - ea - 1j * la
        self.concave = pitch_line + ef + 1j * (np.pi * module / 2.0 + lf)
        self.tip, self.root = pitch_line + ha, rim / 2.0
        apart = self.concave - self.convex
        straight = np.sqrt(abs(apart) ** 2 - self.radii.sum() ** 2)
        self.tangent = np.arctan2(apart.real, apart.imag) + np.arctan(straight / self.radii.sum())
        self.ends = np.arcsin([(hf + ef) / self.radii[0], (ha + ea) / self.radii[1]])
        inner = self.radii[1] - made.rounding
        touched = np.arcsin((ha + ea - made.rounding) / inner)
        relieved = touched - made.relief_length / self.radii[1]
        start = self.convex + self.radii[1] * turned(relieved)
        self.beyond = Tip(start, relieved, 1.0 / self.radii[1], made)
        first = self.radii[0] * (self.ends[0] - self.tangent)
        second = self.radii[1] * (relieved - self.tangent)
        self.lengths = np.array([first, straight, second, *self.beyond.lengths])

    def place(self, along):
        """Place at an arc length from the root."""
        concave, straight, convex = np.cumsum(self.lengths)[:3]
        on_concave = self.concave - self.radii[0] * turned(self.ends[0] - along / self.radii[0])
        start = self.concave - self.radii[0] * turned(self.tangent)
        line = start + (along - concave) * np.exp(-1j * self.tangent)
        on_convex = self.tangent + (along - straight) / self.radii[1]
        return np.select(
            [along < concave, along < straight, along < convex],
            [on_concave, line, self.convex + self.radii[1] * turned(on_convex)],
            self.beyond.place(along - convex),
        )


class Involute(Outline):
    """Right flank of an involute tooth by arc length from its root, from the neutral line."""

    def __init__(self, form, teeth, module, rim, made):
        """All of the form in modules; module, rim thickness and how tips are made in metres."""
        radius, tan = module * teeth / 2.0, np.tan(form.pressure_angle)
        self.base = radius * np.cos(form.pressure_angle)
        self.root_radius = radius + module * (form.profile_shift - form.dedendum)
        self.tip_radius = radius + module * (form.profile_shift + form.addendum)
        self.neutral, self.edge = self.root_radius - rim / 2.0, made.rounding
        self.thickness = module * (np.pi / 2.0 + 2.0 * form.profile_shift * tan)
        self.half = self.thickness / (2.0 * radius) + tan - form.pressure_angle
        first = np.sqrt((self.root_radius / self.base) ** 2 - 1.0)
        beyond = np.sqrt((self.tip_radius / self.base) ** 2 - 1.0)
        touched = brentq(self._too_far, first, beyond, xtol=1e-15)
        self.rolls = first, np.sqrt(touched**2 - 2.0 * made.relief_length / self.base)
        start, angle = self._polar(self.rolls[1]), self.rolls[1] - self.half
        self.beyond = Tip(start, angle, 1.0 / (self.base * self.rolls[1]), made)
        rolled = self.base * (self.rolls[1] ** 2 - first**2) / 2.0
        self.lengths = np.array([rolled, *self.beyond.lengths])

    def _polar(self, roll):
        radius = self.base * np.sqrt(1.0 + roll**2)
        return radius * np.exp(1j * (self.half - (roll - np.arctan(roll))))

    def _centre(self, roll):
        """Centre of a circle inside the tooth that touches the involute there."""
        return self._polar(roll) - self.edge * turned(roll - self.half)

    def _too_far(self, roll):
        return abs(self._centre(roll)) + self.edge - self.tip_radius

    def place(self, along):
        """Place at an arc length from the root."""
        rolled = np.minimum(along, self.lengths[0])
        roll = np.sqrt(self.rolls[0] ** 2 + 2.0 * rolled / self.base)
        beyond = self.beyond.place(along - rolled)
        return np.where(along > rolled, beyond, self._polar(roll)) - self.neutral


@dataclass(frozen=True)
class Made:
    """How tips and bottoms are made, in modules as it is given, in metres once it is multiplied.

    Rounding of all edges; relief of both tips and its length along the flank; clearance at the bottom of the
    spaces on the long axis; radius of ridges between parts of a groove that different phases sweep.
    """

    rounding: float = 0.1
    relief: float = 0.005
    relief_length: float = 0.1
    bottom: float = 0.15
    ridge: float = 1.0

    def __mul__(self, module):
        return Made(*(module * size for size in astuple(self)))


def drive(form, teeth=(200, 202), module=0.3e-3, rim=0.7e-3, weights=(1.0,), made=None):
    """Positions of a drive with a double-arc or an involute flexspline, w0 half the module a tooth more."""
    made = (made or Made()) * module
    unrelieved = replace(made, relief=0.0, relief_length=0.0)
    if hasattr(form, "pressure_angle"):
        outline, cutter = (Involute(form, teeth[0], module, rim, m) for m in (made, unrelieved))
        neutral = outline.neutral
    else:
        outline, cutter = (DoubleArc(form, module, rim, m) for m in (made, unrelieved))
        neutral = module * (teeth[0] / 2.0 - form.dedendum) - rim / 2.0
    line = teeth, neutral, module * (teeth[1] - teeth[0]) / 2.0, weights
    return Drive(outline, *line, made, Drive(cutter, *line, unrelieved))


class Drive:
    """Positions of the flexspline's teeth in the spaces of the circular spline."""

    def __init__(self, outline, teeth, neutral, wave, weights, made, cutter=None):
        """Outline of a flank, radius of the neutral line, deflection w0 and weights of cos 2p, cos 4p, ...

        The cutter is the drive with the teeth that sweep the spaces.
        """
        self.outline, self.teeth = outline, np.asarray(teeth, float)
        self.neutral, self.wave, self.weights = neutral, wave, np.asarray(weights)
        self.made, self.cutter = made, cutter

    def radial(self, p):
        """Radial displacement of the neutral line."""
        return self.wave * sum(a * np.cos(2 * k * p) for k, a in enumerate(self.weights, 1))

    def tangential(self, p):
        """Its tangential displacement, minus the integral of the radial one."""
        return -self.wave * sum(
            a * np.sin(2 * k * p) / (2 * k) for k, a in enumerate(self.weights, 1)
        )

    def tilt(self, p):
        """Turn of the tooth against the radius through its foot."""
        waves = enumerate(self.weights, 1)
        return self.wave / self.neutral * sum(2 * k * a * np.sin(2 * k * p) for k, a in waves)

    def seen(self, along, root, p):
        """Place of a point of a tooth with its undeformed root at a polar angle."""
        polar = root + self.tangential(p) / self.neutral
        foot = (self.neutral + self.radial(p)) * np.exp(1j * polar)
        return foot + self.outline.place(along) * np.exp(1j * (polar + self.tilt(p)))

    def place(self, along, p):
        """Place in the space of the circular spline as the drive runs."""
        return self.seen(along, p * (1.0 - self.teeth[0] / self.teeth[1]), p)

    def mirrored(self, along, p):
        """Place of the other flank: the tooth is symmetric, and the motion in p."""
        return np.conj(self.place(along, -p))

    def velocity(self, along, p, rates, step=1e-3):
        """Velocity of the material for rates of wave generator, flexspline and circular spline."""
        wave, flex, circular = rates

        def place(time):
            at = self.seen(
                along,
                p * (1.0 - self.teeth[0] / self.teeth[1]) + flex * time,
                p + (flex - wave) * time,
            )
            return at * np.exp(-1j * circular * time)

        return slope(place, 0.0, step)

    def direction(self, along, p, step=1e-6):
        """Direction of the flank from root to tip; pieces of other curvature within the step spoil it."""
        tangent = slope(lambda s: self.place(s, p), along, step)
        return np.angle(tangent)

    def reach(self, height, p):
        """How far a flank reaches across at a height; minus infinity beyond its ends."""
        height, p = np.broadcast_arrays(height, p)
        low, high = np.zeros(p.shape), np.full(p.shape, self.outline.length)
        inside = (self.place(low, p).real <= height) & (self.place(high, p).real >= height)
        for _ in range(12):
            middle = (low + high) / 2.0
            below = self.place(middle, p).real < height
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        along = (low + high) / 2.0
        for _ in range(5):
            step = 1e-9
            ahead, behind = self.place(along + step, p).real, self.place(along - step, p).real
            miss = self.place(along, p).real - height
            along = np.clip(along - miss * 2 * step / (ahead - behind), low, high)
        return np.where(inside, self.place(along, p).imag, -np.inf), along

    def outermost(self, height):
        """Largest reach over all phases of half a turn at heights, and the phase there."""
        height = np.atleast_1d(height)
        stations = np.linspace(0.0, 1.0, 1500) * self.outline.length
        best, where = np.full(height.shape, -np.inf), np.zeros(height.shape)
        for p in np.arange(-np.pi / 2.0, np.pi / 2.0, SPACING):
            at = self.place(stations, p)
            if at.real[-1] < height.min():
                continue
            far = np.interp(height, at.real, at.imag, left=-np.inf, right=-np.inf)
            where = np.where(far > best, p, where)
            best = np.maximum(far, best)
        return self._refined(height, where)

    def _refined(self, height, where):
        """Golden section between neighbouring phases."""
        golden = (np.sqrt(5.0) - 1.0) / 2.0
        low, high = where - SPACING, where + SPACING
        for _ in range(40):
            one, two = high - golden * (high - low), low + golden * (high - low)
            rises = self.reach(height, one)[0] < self.reach(height, two)[0]
            low, high = np.where(rises, one, low), np.where(rises, high, two)
        # Where the end of a flank reaches farthest one side of its phase has no flank.
        tries = np.stack([low, (low + high) / 2.0, high, where])
        far = self.reach(height, tries)[0]
        best = np.argmax(far, axis=0)[None]
        return np.take_along_axis(far, best, 0)[0], np.take_along_axis(tries, best, 0)[0]

    def groove(self, low, count=2000):
        """Space with tips at a height, as it is made."""
        return Space(self, low, count)

    def valleys(self, p, space):
        """Where the play of a plain flank is least along the circumference, and least beyond a ridge.

        Arc lengths and clearances, the play times the cosine of the flank there, two of each; infinite
        out of mesh and where there is one valley alone. The third is how far the play rises to the ridge.
        """
        p = np.asarray(p)
        along = np.linspace(0.0, 1.0, 3001) * self.outline.plain
        play = space.play(self.place(along.reshape(-1, *np.ones(p.ndim, int)), p))
        first = np.argmin(play, axis=0)
        beyond, rise = self._beyond_a_ridge(play, first)
        found = np.stack([first, beyond])
        known = np.isfinite(np.take_along_axis(play, found, 0)) & np.stack([first >= 0, rise > 0])
        at = np.stack([self._least(along, one, p, space) for one in found])
        ends = self.place(at + along[1] / 10.0, p) - self.place(at - along[1] / 10.0, p)
        clear = space.play(self.place(at, p)) * np.cos(np.angle(ends))
        return at, np.where(known, clear, np.inf), rise

    def _beyond_a_ridge(self, play, first):
        """Number of the lowest place beyond a ridge, and how far it lies below; zero without a ridge."""
        number = np.arange(play.shape[0]).reshape(-1, *np.ones(first.ndim, int))
        finite = np.where(np.isfinite(play), play, -np.inf)
        after = np.maximum.accumulate(np.where(number >= first, finite, -np.inf))
        before = np.maximum.accumulate(np.where(number <= first, finite, -np.inf)[::-1])[::-1]
        below = np.where(number > first, after, before) - play
        where = np.argmin(np.where(below > LOWEST, play, np.inf), axis=0)
        rise = np.take_along_axis(below, where[None], 0)[0]
        return where, np.where(rise > LOWEST, rise, 0.0)

    def _least(self, along, number, p, space):
        """Arc length at the bottom of the parabola through a place and its neighbours."""
        step, first = along[1], along[number]
        sides = [space.play(self.place(first + k * step, p)) for k in (-1, 0, 1)]
        inside = (number > 0) & (number < along.size - 1) & np.isfinite(sides).all(axis=0)
        flat = zip(sides, (0.0, -1.0, 0.0), strict=True)
        low, middle, high = (np.where(inside, side, usual) for side, usual in flat)
        move = (low - high) / (2.0 * (low - 2.0 * middle + high))
        found = np.where(inside, first + step * np.clip(move, -1.0, 1.0), first)
        # A vertex that lies higher belongs to a place where pieces of the flank meet.
        better = space.play(self.place(found, p)) <= space.play(self.place(first, p)) + 1e-11
        return np.where(better, found, first)

    def smooth(self, along, margin=1e-6):
        """True where the flank's curvature does not jump within a margin, nor the flank end."""
        ends = np.append(0.0, np.cumsum(self.outline.lengths))
        return np.all(np.abs(np.subtract.outer(ends, along)) > margin, axis=0)

    def curvatures(self, along, p, space, step=2e-7, near=1.2e-6):
        """Curvatures of the flank and its mate, and whether neighbouring phases shape the mate nearby."""
        height = self.place(along, p).real[:, None]
        heights = height + step * STEPS
        across, _ = self.reach(heights, p[:, None])
        around = np.hstack([heights, height - near, height + near])
        far = space.width(around)
        phases = self.cutter.outermost(space.swept(around).ravel())[1].reshape(around.shape)
        with np.errstate(invalid="ignore"):  # beyond the end of a flank
            own, mate = (
                values @ SECOND / step**2 / (1.0 + (values @ FIRST / step) ** 2) ** 1.5
                for values in (across, far[:, : STEPS.size])
            )
        return -own, mate, np.ptp(phases, axis=1) < np.deg2rad(5.0)


class Space:
    """Space of the circular spline that lets every tooth through, with tips and bottom as they are made.

    Attributes:
        heights, widths: places of its flank, half widths.
        ridges: heights where parts meet that different phases sweep, the turn of the slope there, and the
            reach of the parabola that blends both.
    """

    def __init__(self, drive, low, count):
        """Swept by the cutter of the drive, with tips at a height."""
        self.cutter, self.made, self.low = drive.cutter, drive.made, low
        outline = self.cutter.outline
        self.high, self.joint = self.cutter.place(
            np.array([outline.length, outline.plain]), 0.0
        ).real
        # Close together at the deep end, where the groove runs across.
        heights = self.high - (self.high - low) * np.linspace(1.0, 0.0, count) ** 2
        widths, phases = self.cutter.outermost(heights)
        self.ridges = self._ridges(heights, widths, phases)
        self.widths = widths + self._taken_off(heights)
        self.heights = heights + self.made.bottom * self._into(heights) ** 2
        self.curve = CubicSpline(self.heights, self.widths)

    def _ridges(self, heights, widths, phases):
        """Where the phase jumps and the flank is convex: lines through the places on either side meet."""
        jumps = np.flatnonzero(np.abs(np.diff(phases)) > np.deg2rad(1.0))
        found = []
        for jump in jumps[(jumps > 4) & (jumps < heights.size - 6)]:
            sides = [slice(jump - 3, jump + 1), slice(jump + 1, jump + 5)]
            middle, step = heights[jump], heights[jump + 1] - heights[jump]
            first, second = (
                Polynomial(np.polyfit((heights[k] - middle) / step, widths[k], 3)[::-1])
                for k in sides
            )
            apart, at = first - second, 0.0
            for _ in range(5):
                at -= apart(at) / apart.deriv()(at)
            slopes = [side.deriv()(at) / step for side in (first, second)]
            turn, grown = slopes[1] - slopes[0], 1.0 + np.mean(slopes) ** 2
            reach = self.made.ridge * turn / (2.0 * grown**1.5)
            if turn > 0.0:
                found.append((middle + at * step, turn, reach))
        return found

    def _into(self, height):
        return np.maximum(height - self.joint, 0.0) / (self.high - self.joint)

    def swept(self, height):
        """Height at which the flank was swept that is made at a height."""
        low, high = height - self.made.bottom, np.array(height, float)
        for _ in range(60):
            middle = (low + high) / 2.0
            above = middle + self.made.bottom * self._into(middle) ** 2 > height
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        return (low + high) / 2.0

    def _taken_off(self, height):
        """What ridges, relief and rounding of the tips take off the flank that was swept."""
        made, edge = self.made, self.low + self.made.rounding
        total = np.maximum(edge - height, 0.0) ** 2 / (2.0 * made.rounding)
        if made.relief_length:
            into = np.maximum(edge + made.relief_length - height, 0.0) / made.relief_length
            total = total + made.relief * into**2
        for at, turn, reach in self.ridges:
            total = total + turn / (4.0 * reach) * np.maximum(reach - np.abs(height - at), 0.0) ** 2
        return total

    def width(self, height):
        """Half width at any heights."""
        swept = self.swept(height)
        return self.cutter.outermost(swept.ravel())[0].reshape(swept.shape) + self._taken_off(swept)

    def on_ridge(self, height):
        """True where a ridge is blended."""
        swept = self.swept(height)
        off = [np.abs(swept - at) < reach for at, _, reach in self.ridges]
        return np.any(off, axis=0) if off else np.zeros(swept.shape, bool)

    def smooth(self, height, margin=1e-6):
        """True where the curvature of the flank does not jump within a margin."""
        swept, edge = self.swept(height), self.low + self.made.rounding
        ends = [edge, edge + self.made.relief_length, self.joint]
        ends += [at + side * reach for at, _, reach in self.ridges for side in (-1, 0, 1)]
        phase = self.cutter.outermost(swept)[1]
        far = np.all(np.abs(np.subtract.outer(ends, swept)) > margin, axis=0)
        return far & self.cutter.smooth(self.cutter.reach(swept, phase)[1], margin)

    def play(self, place):
        """Play of places along the circumference; infinite beyond the tips beside the space."""
        play = self.curve(place.real) - place.imag
        return np.where(place.real < self.heights[0], np.inf, play)
