"""A strain wave gear by positions alone: outlines, the deformed neutral line, and the groove they sweep.

Nothing here differentiates a formula or calls the library: normals, velocities and curvatures are
differences of positions. Places are complex numbers, the real part outwards along the middle of a
space of the circular spline, the imaginary part across it.

Formulas: Zhao et al. (2022), eqs. 1 to 7, with the signs that close the profile.
"""

import numpy as np
from scipy.optimize import brentq

STEEPEST = 1.4
SPACING = np.deg2rad(0.1)
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


class DoubleArc:
    """Right flank of a double-arc tooth by arc length from its root, from the neutral line."""

    def __init__(self, form, module, rim, rounding=0.1):
        """All of the form in modules, rim thickness [m]."""
        la, ea, lf, ef = (
            module * getattr(form, name)
            for name in ("convex_offset", "convex_shift", "concave_offset", "concave_shift")
        )
        self.radii = module * np.array([form.concave_radius, form.convex_radius])
        ha, hf, self.edge = module * form.addendum, module * form.dedendum, module * rounding
        pitch_line = rim / 2.0 + hf
        self.convex = pitch_line - ea - 1j * la
        self.concave = pitch_line + ef + 1j * (np.pi * module / 2.0 + lf)
        self.tip, self.root = pitch_line + ha, rim / 2.0
        apart = self.concave - self.convex
        straight = np.sqrt(abs(apart) ** 2 - self.radii.sum() ** 2)
        self.tangent = np.arctan2(apart.real, apart.imag) + np.arctan(straight / self.radii.sum())
        self.ends = np.arcsin([(hf + ef) / self.radii[0], (ha + ea) / self.radii[1]])
        inner = self.radii[1] - self.edge
        self.last = np.arcsin((ha + ea - self.edge) / inner)
        self.corner = self.convex + inner * turned(self.last)
        self.lengths = np.array(
            [
                self.radii[0] * (self.ends[0] - self.tangent),
                straight,
                self.radii[1] * (self.last - self.tangent),
                self.edge * (STEEPEST - self.last),
            ]
        )
        self.length = self.lengths.sum()

    def place(self, along):
        """Place at an arc length from the root."""
        concave, straight, convex, _ = np.cumsum(self.lengths)
        on_concave = self.concave - self.radii[0] * turned(self.ends[0] - along / self.radii[0])
        start = self.concave - self.radii[0] * turned(self.tangent)
        line = start + (along - concave) * np.exp(-1j * self.tangent)
        on_convex = self.tangent + (along - straight) / self.radii[1]
        on_edge = self.last + (along - convex) / self.edge
        return np.select(
            [along < concave, along < straight, along < convex],
            [on_concave, line, self.convex + self.radii[1] * turned(on_convex)],
            self.corner + self.edge * turned(on_edge),
        )


class Involute:
    """Right flank of an involute tooth by arc length from its root, from the neutral line."""

    def __init__(self, form, teeth, module, rim, rounding=0.1):
        """All of the form in modules, rim thickness [m]."""
        radius, tan = module * teeth / 2.0, np.tan(form.pressure_angle)
        self.base = radius * np.cos(form.pressure_angle)
        self.root_radius = radius + module * (form.profile_shift - form.dedendum)
        self.tip_radius = radius + module * (form.profile_shift + form.addendum)
        self.neutral, self.edge = self.root_radius - rim / 2.0, module * rounding
        self.thickness = module * (np.pi / 2.0 + 2.0 * form.profile_shift * tan)
        self.half = self.thickness / (2.0 * radius) + tan - form.pressure_angle
        first = np.sqrt((self.root_radius / self.base) ** 2 - 1.0)
        beyond = np.sqrt((self.tip_radius / self.base) ** 2 - 1.0)
        self.rolls = first, brentq(self._too_far, first, beyond, xtol=1e-15)
        self.corner = self._centre(self.rolls[1])
        self.last = self.rolls[1] - self.half
        rolled = self.base * (self.rolls[1] ** 2 - first**2) / 2.0
        self.lengths = np.array([rolled, self.edge * (STEEPEST - self.last)])
        self.length = self.lengths.sum()

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
        on_edge = self.corner + self.edge * turned(self.last + (along - rolled) / self.edge)
        return np.where(along > rolled, on_edge, self._polar(roll)) - self.neutral


def drive(form, teeth=(200, 202), module=0.3e-3, rim=0.7e-3, weights=(1.0,)):
    """Positions of a drive with a double-arc or an involute flexspline, w0 half the module a tooth more."""
    if hasattr(form, "pressure_angle"):
        outline = Involute(form, teeth[0], module, rim)
        neutral = outline.neutral
    else:
        outline = DoubleArc(form, module, rim)
        neutral = module * (teeth[0] / 2.0 - form.dedendum) - rim / 2.0
    return Drive(outline, teeth, neutral, module * (teeth[1] - teeth[0]) / 2.0, weights)


class Drive:
    """Positions of the flexspline's teeth in the spaces of the circular spline."""

    def __init__(self, outline, teeth, neutral, wave, weights=(1.0,)):
        """Outline of a flank, radius of the neutral line, deflection w0 and weights of cos 2p, cos 4p, ..."""
        self.outline, self.teeth = outline, np.asarray(teeth, float)
        self.neutral, self.wave, self.weights = neutral, wave, np.asarray(weights)

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

    def groove(self, low, edge, count=2000):
        """Heights and half widths of the space that lets every tooth through; its tip's edge rounded."""
        high = self.place(self.outline.length, 0.0).real
        # Close together at the deep end, where the groove runs across.
        heights = high - (high - low) * np.linspace(1.0, 0.0, count) ** 2
        over = np.maximum(low + edge - heights, 0.0) / edge
        return heights, self.outermost(heights)[0] + edge * over**2 / 2.0

    def clearance(self, p, heights, widths):
        """Least play along the circumference times the cosine of the flank there; infinite out of mesh."""
        step = 1e-3 * self.outline.length

        def play(along, angle):
            at = self.place(along, angle)
            return np.where(
                at.real < heights[0], np.inf, np.interp(at.real, heights, widths) - at.imag
            )

        along = np.linspace(0.0, 1.0, 6001)[:, None] * self.outline.length
        first = along[np.argmin(play(along, p), axis=0), 0]
        around = np.stack([play(first + k * step, p) for k in (-1, 0, 1)])
        inside = (first > step) & (first < self.outline.length - step)
        inside &= np.isfinite(around).all(axis=0)
        low, middle, high = np.where(inside, around, [[0.0], [-1.0], [0.0]])
        move = (low - high) / (2.0 * (low - 2.0 * middle + high))
        found = np.where(inside, first + step * np.clip(move, -1.0, 1.0), first)
        # A vertex that lies higher belongs to a place where pieces of the flank meet.
        found = np.where(play(found, p) <= play(first, p) + 1e-11, found, first)
        ends = self.place(found + step / 10.0, p) - self.place(found - step / 10.0, p)
        return play(first, p) * np.cos(np.angle(ends))

    def smooth(self, along, margin=1e-6):
        """True where the flank's curvature does not jump within a margin, nor the flank end."""
        ends = np.append(0.0, np.cumsum(self.outline.lengths))
        return np.all(np.abs(np.subtract.outer(ends, along)) > margin, axis=0)

    def curvatures(self, along, p, step=2e-7, near=1.2e-6):
        """Curvatures of the flank and its mate, and whether neighbouring phases shape the mate nearby."""
        height = self.place(along, p).real[:, None]
        heights = height + step * STEPS
        across, _ = self.reach(heights, p[:, None])
        around = np.hstack([heights, height - near, height + near])
        far, phases = (found.reshape(around.shape) for found in self.outermost(around.ravel()))
        with np.errstate(invalid="ignore"):  # beyond the end of a flank
            own, mate = (
                values @ SECOND / step**2 / (1.0 + (values @ FIRST / step) ** 2) ** 1.5
                for values in (across, far[:, : STEPS.size])
            )
        return -own, mate, np.ptp(phases, axis=1) < np.deg2rad(5.0)
