"""Spaces of a circular spline: the flank that lets every flexspline tooth through, or a given one."""

from dataclasses import replace

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float, Int

from pitchpoint._jax import jax, jnp
from pitchpoint.core.roots import hypot
from pitchpoint.gears.strain_wave.flexspline_tooth import InvoluteFlank
from pitchpoint.gears.strain_wave.tooth_motion import ToothMotion

__all__ = [
    "NEWTON_STEPS",
    "NODES",
    "Groove",
    "SplineTips",
    "involute_groove",
    "swept",
    "tip_with_land",
]

NODES = 640
"""Heights at which the flank is known; cubic between them."""

NEWTON_STEPS = 8
"""Steps from a place on a grid to the envelope."""

_PHASES = np.deg2rad(
    np.concatenate(
        [np.arange(-40.0, -6.0, 0.5), np.arange(-6.0, 8.0, 0.1), np.arange(8.0, 90.5, 0.5)]
    )
)
_STATIONS = (120, 40)
_CURVATURES = (-1e6, 1e6)  # 1/m: sharper than any edge that is made
_FLATTEST = 1e-2  # 1/m
# Peaks nearer to each other are two phases of the grid around one peak.
_APART = np.deg2rad(1.0)
_JUMP = 0.1  # relative change of the curvature between neighbours
_KINK = 3e-3  # rad between neighbours that no smooth flank turns
_STRIDE = 0.02  # rad: the longest step of an iteration
_END = 1e-3  # of the length of the flank: nearer to its end a place counts as the end

_FROM_TOP = np.stack([np.ones(NODES), np.linspace(1.0, 0.0, NODES) ** 2])

Each = Float[Array, "*b"]


class SplineTips(eqx.Module):
    """How the tips of both splines are made, and the bottom of the spaces.

    Attributes:
        rounding: radius of all edges [m].
        relief: by which a tip lies below the flank that sweeps, or is swept, where its rounding begins [m].
        relief_length: along the flank up to there [m].
        bottom: clearance between the flexspline's tips and the bottom of the spaces on the long axis [m].
        ridge: radius of the ridges on a swept flank between parts that different phases sweep [m].
    """

    rounding: Float[Array, ""]
    relief: Float[Array, ""]
    relief_length: Float[Array, ""]
    bottom: Float[Array, ""]
    ridge: Float[Array, ""]


class Groove(eqx.Module):
    """One flank of a space of the circular spline, the one that faces against positive rotation.

    Heights are radii projected on the middle of the space. Nodes lie closer together at the deep
    end, where the rounded tips of the flexspline shape the groove.

    Attributes:
        low, high: heights of the tip of the circular spline's teeth and of the deepest contact [m].
        half_width: distance of the flank from the middle of the space at the nodes [m].
        slope: derivative of the half width with respect to height.
        curvature: of the flank, positive where it is convex [1/m].
        unsolved: number of nodes at which the point that sweeps the flank was not found: they have
            the nearest one of a grid, and its curvature.
        joint: height from which on the bottom lies deeper than the tips that sweep it [m].
        bottom: by how much it does at the deepest node [m].
    """

    low: Float[Array, ""]
    high: Float[Array, ""]
    half_width: Float[Array, " node"]
    slope: Float[Array, " node"]
    curvature: Float[Array, " node"]
    unsolved: Float[Array, ""]
    joint: Float[Array, ""]
    bottom: Float[Array, ""]

    @property
    def heights(self) -> Float[Array, " node"]:
        """Heights of the nodes as they are swept, without clearance at the bottom [m]."""
        return _heights(self.low, self.high)

    @property
    def made(self) -> Float[Array, " node"]:
        """Heights of the nodes as they are made, with the clearance at the bottom [m]."""
        into = jnp.maximum(self.heights - self.joint, 0.0) / (self.high - self.joint)
        return self.heights + self.bottom * into**2

    def _swept(self, height: Each) -> tuple[Each, Each]:
        """Height at which the bottom was swept that is made at a height, and its derivative.

        The clearance grows with the square of the way into the bottom, which has a closed inverse.
        """
        deep, beyond = self.high - self.joint, jnp.maximum(height - self.joint, 0.0)
        into = 2.0 * beyond / (deep + jnp.sqrt(deep**2 + 4.0 * self.bottom * beyond))
        return height - self.bottom * into**2, deep / (deep + 2.0 * self.bottom * into)

    def land(self, tooth_angle: Float[Array, ""]) -> Float[Array, " node"]:
        """Thickness of the teeth between such spaces at the nodes [m], for the angle of one pitch [rad]."""
        return tooth_angle * self.heights - 2.0 * self.half_width

    def _cell(self, height: Each) -> tuple[Array, Each, Each]:
        """Node below a height, the step to the next one [m], and the place between them, from 0 to 1."""
        low, high = jax.lax.stop_gradient((self.low, self.high))
        from_top = (high - jax.lax.stop_gradient(height)) / (high - low)
        place = (1.0 - jnp.sqrt(jnp.clip(from_top, 0.0, 1.0))) * (NODES - 1)
        cell = jnp.clip(jnp.floor(place), 0, NODES - 2).astype(int)
        heights = self.heights
        step = heights[cell + 1] - heights[cell]
        return cell, step, (height - heights[cell]) / step

    def width_and_slope(self, height: Each) -> tuple[Each, Each]:
        """Half width [m] and slope at heights; beyond the ends along the tangent there."""
        height, rate = self._swept(height)
        cell, step, t = self._cell(height)
        inside = jnp.clip(t, 0.0, 1.0)
        y0, y1 = self.half_width[cell], self.half_width[cell + 1]
        d0, d1 = self.slope[cell] * step, self.slope[cell + 1] * step
        rise = y1 - y0
        bend, twist = 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise
        width = y0 + inside * (d0 + inside * (bend + inside * twist))
        slope = (d0 + inside * (2.0 * bend + 3.0 * inside * twist)) / step
        return width + slope * step * (t - inside), slope * rate

    def curvature_at(self, height: Each) -> Each:
        """Curvature at heights [1/m].

        Where it jumps between two nodes, because the flank that left the groove behind has a joint
        there, the larger one: the other might belong to the other side of the joint.
        """
        cell, _, t = self._cell(self._swept(height)[0])
        inside = jnp.clip(t, 0.0, 1.0)
        low, high = self.curvature[cell], self.curvature[cell + 1]
        smooth = low * (1.0 - inside) + high * inside
        jumps = jnp.abs(high - low) > _JUMP * (jnp.abs(high) + jnp.abs(low))
        return jnp.where(jumps, jnp.maximum(low, high), smooth)

    def depth(self, height: Each) -> Each:
        """Arc length of the flank from its deepest point to heights [m]."""
        above = jnp.concatenate([jnp.cumsum(self.arcs[::-1])[::-1], jnp.zeros(1)])
        cell, _, t = self._cell(self._swept(height)[0])
        return above[cell] + t * (above[cell + 1] - above[cell])

    @property
    def arcs(self) -> Float[Array, " cell"]:
        """Arc lengths between the nodes [m]."""
        heights = self.made
        grown = hypot(1.0, self.slope * self._swept(heights)[1])
        return (grown[1:] + grown[:-1]) / 2.0 * jnp.diff(heights)


def _heights(low: Float[Array, ""], high: Float[Array, ""]) -> Float[Array, " node"]:
    # As a product the compiler works them out once, and not wherever one is looked up.
    return jnp.stack([high, low - high]) @ _FROM_TOP


def involute_groove(flank: InvoluteFlank, low: Float[Array, ""], high: Float[Array, ""]) -> Groove:
    """Groove of an involute circular spline: the space has the shape of an external tooth.

    Args:
        flank: of that tooth, with its neutral line on the axis.
        low: height of the tip of the circular spline's teeth [m].
        high: height of the deepest contact [m].
    """
    heights = _heights(low, high)
    radius = heights
    for _ in range(4):  # the tooth is thin, so that height and radius differ by its angle squared
        radius = heights / jnp.cos(flank.half_angle_at(radius))
    angle = flank.half_angle_at(radius)
    pressure = jnp.arccos(jnp.minimum(flank.base_radius / radius, 1.0))
    return Groove(
        low=low,
        high=high,
        half_width=heights * jnp.tan(angle),
        slope=-jnp.tan(pressure - angle),
        curvature=-1.0 / (flank.base_radius * jnp.tan(pressure)),
        unsolved=jnp.zeros(()),
        joint=low,
        bottom=jnp.zeros(()),
    )


def swept(motion: ToothMotion, low: Float[Array, ""], tips: SplineTips) -> Groove:
    """Flank that a tooth just clears at every phase: the outermost place that it reaches at each height.

    Conjugate profiles are part of it where they lie outermost; roots of the conjugate condition that
    lie inside do not touch.

    Args:
        motion: of flexspline teeth without relief.
        low: height of the tip of the circular spline's teeth [m].
        tips: how that tip is made, and the ridges between parts of the flank that different phases sweep.
    """
    edge = tips.rounding
    deepest = motion.place(motion.flank.length, jnp.zeros(()))
    heights = _heights(low, jnp.real(deepest))
    generated = _generated(motion, heights, *_outermost(motion, heights))
    width, slope, curvature, lost = _farther(*generated)
    joint = jnp.real(motion.carried(motion.flank.rounding_start, jnp.zeros(())))
    bottom = joint, tips.bottom
    groove = Groove(low, heights[-1], width, slope, curvature, jnp.sum(lost * 1.0), *bottom)
    reach = jnp.where(tips.relief_length > 0.0, tips.relief_length, 1.0)
    relief = jnp.where(tips.relief_length > 0.0, tips.relief, 0.0)
    groove = _relieved(_blended(groove, tips.ridge), low + edge, reach, 2.0 * relief / reach**2)
    return _relieved(groove, low, edge, 1.0 / edge)


def _blended(groove: Groove, radius: Float[Array, ""]) -> Groove:
    """The same with the ridges at which its parts meet blended by parabolas of a radius [m]."""
    heights, grown = groove.heights, hypot(1.0, groove.slope)
    across = (grown[1:] + grown[:-1]) / 2.0
    to_ridge, turned = _ridges(groove)
    reach = jnp.where(turned > 0.0, radius * turned / 2.0 / across, 1.0)
    bend = turned * across**2 / (2.0 * reach)  # of the slope over the height
    beside = heights[:, None] - heights[:-1] - to_ridge
    within = jnp.maximum(reach - jnp.abs(beside), 0.0)
    bends = jnp.where(within > 0.0, bend, 0.0)
    width = jnp.sum(bends * within**2, axis=1) / 2.0
    return _bent(
        groove, width, -jnp.sum(bends * within * jnp.sign(beside), axis=1), jnp.sum(bends, axis=1)
    )


def _ridges(groove: Groove) -> tuple[Float[Array, " cell"], Float[Array, " cell"]]:
    """Way from the node before it to a ridge [m], and by how much the flank turns there; zero without one.

    On both sides the flank goes on as a parabola.
    """
    slope, step = groove.slope, jnp.diff(groove.heights)
    bend, rise = groove.curvature * hypot(1.0, slope) ** 3, jnp.diff(groove.half_width)

    def sides(to_ridge: Each) -> tuple[Each, Each, Each]:
        """Slopes of both parts, and how far the second lies beyond the first [m]."""
        back = step - to_ridge
        bend_before, bend_behind = bend[:-1] * to_ridge, bend[1:] * back
        apart = (
            rise
            - (slope[:-1] + bend_before / 2.0) * to_ridge
            - (slope[1:] - bend_behind / 2.0) * back
        )
        return slope[:-1] + bend_before, slope[1:] - bend_behind, apart

    to_ridge = step / 2.0
    before, after, apart = sides(to_ridge)
    ridge = jnp.arctan(after) - jnp.arctan(before) > _KINK
    for _ in range(2):
        to_ridge = jnp.clip(to_ridge + apart / jnp.where(ridge, before - after, jnp.inf), 0.0, step)
        before, after, apart = sides(to_ridge)
    return to_ridge, jnp.where(ridge, jnp.arctan(after) - jnp.arctan(before), 0.0)


def _relieved(
    groove: Groove, end: Float[Array, ""], length: Float[Array, ""], bent: Float[Array, ""]
) -> Groove:
    """The same with teeth that bend away before a height, over a length [m], by a parabola of a curvature."""
    over = jnp.maximum(end + length - groove.heights, 0.0)
    return _bent(groove, bent * over**2 / 2.0, -bent * over, jnp.where(over > 0.0, bent, 0.0))


def _bent(groove: Groove, width: Array, slope: Array, bend: Array) -> Groove:
    """The same with so much more half width [m], slope, and second derivative of the width [1/m]."""
    steeper = groove.slope + slope
    bends = groove.curvature * hypot(1.0, groove.slope) ** 3 + bend
    return replace(
        groove,
        half_width=groove.half_width + width,
        slope=steeper,
        curvature=bends / hypot(1.0, steeper) ** 3,
    )


def tip_with_land(
    groove: Groove,
    tooth_angle: Float[Array, ""],
    least: Float[Array, ""] | float,
    edge: Float[Array, ""],
) -> Float[Array, ""]:
    """Height at which the teeth between such spaces end if their tips are to keep a land [m].

    Args:
        groove: up to the tips as they are meant to be.
        tooth_angle: of one pitch of the circular spline [rad].
        least: land [m].
        edge: radius with which the tips of the groove are rounded [m].

    Returns:
        The tips as they are where they are thick enough; infinity where nothing is left.
    """
    heights = groove.heights
    land = groove.land(tooth_angle)
    relief = jnp.where(heights < groove.low + edge, 2.0 * edge, 0.0)  # that of the edge is no cut
    narrow = jnp.where(land + relief < least, jnp.arange(NODES), -1)
    last_narrow = jnp.max(narrow)
    raised = jnp.where(
        last_narrow + 2 < NODES, heights[jnp.minimum(last_narrow + 1, NODES - 1)], jnp.inf
    )
    return jnp.where(last_narrow < 0, groove.low, raised)


def _outermost(motion: ToothMotion, heights: Array) -> tuple[Array, Array]:
    """Places on the flank and phases of the two highest peaks of reach at each height, on a grid of both.

    Beside an edge of the groove two parts of the wave reach nearly as far, and the grid cannot tell.
    """
    frozen, targets = jax.lax.stop_gradient((motion, heights))
    stations = frozen.flank.stations(*_STATIONS)
    phases = jnp.asarray(_PHASES)
    station_heights, across = (part.T for part in frozen.passed(stations, phases))
    after = _stations_below(station_heights, targets)
    far = _interpolated(targets, station_heights, across, after)
    far = jnp.where(
        (targets < station_heights[:, :1]) | (targets > station_heights[:, -1:]), -jnp.inf, far
    )
    beside = jnp.pad(far, ((1, 1), (0, 0)), constant_values=-jnp.inf)
    peaks = jnp.where((far >= beside[2:]) & (far >= beside[:-2]), far, -jnp.inf)
    farthest = _largest(peaks)
    others = jnp.where(jnp.abs(phases[:, None] - phases[farthest]) < _APART, -jnp.inf, peaks)
    best = jnp.stack([farthest, _largest(others)])
    at = jnp.take_along_axis(after, best, 0)
    low, high = station_heights[best, at - 1], station_heights[best, at]
    part = jnp.clip((targets - low) / (high - low), 0.0, 1.0)
    return stations[at - 1] + part * (stations[at] - stations[at - 1]), phases[best]


def _largest(values: Float[Array, "phase node"]) -> Int[Array, " node"]:
    """First phase with the largest value; `jnp.argmax` takes twice as long."""
    count = values.shape[0]
    place = jnp.arange(count, dtype=jnp.int32)[:, None]
    largest_phase = jnp.min(jnp.where(values == jnp.max(values, axis=0), place, count), axis=0)
    return jnp.minimum(largest_phase, count - 1)


def _stations_below(
    known: Float[Array, "phase station"], targets: Float[Array, " node"]
) -> Int[Array, "phase node"]:
    """Number of stations that do not lie above each target, from one to all but one.

    Both ascend. The targets are nodes of a groove, so the first one at or above a station follows from
    its height up to rounding; a search for each target would take as long as all else.
    """
    count, low, high = targets.shape[0], targets[0], targets[-1]
    from_top = jnp.clip((high - known) / (high - low), 0.0, 1.0)
    target_above = jnp.ceil((1.0 - jnp.sqrt(from_top)) * (count - 1)).astype(jnp.int32)
    target_above = jnp.where(targets[target_above] < known, target_above + 1, target_above)
    lower = targets[jnp.maximum(target_above - 1, 0)]
    target_above = jnp.where((target_above > 0) & (lower >= known), target_above - 1, target_above)
    rows = jnp.arange(known.shape[0], dtype=jnp.int32)[:, None]
    passed = (
        jnp.zeros((known.shape[0], count), jnp.int32).at[rows, target_above].add(1, mode="drop")
    )
    return jnp.clip(jnp.cumsum(passed, axis=1), 1, known.shape[1] - 1)


def _interpolated(
    targets: Float[Array, " node"],
    known: Float[Array, "phase station"],
    values: Float[Array, "phase station"],
    after: Int[Array, "phase node"],
) -> Float[Array, "phase node"]:
    """Values at targets between the stations before and after each."""

    def take(of: Array, at: Array) -> Array:
        return jnp.take_along_axis(of, at, 1)

    low, value_below = take(known, after - 1), take(values, after - 1)
    step = take(known, after) - low
    rise = take(values, after) - value_below
    return value_below + (targets - low) / jnp.where(step == 0.0, 1.0, step) * rise


def _farther(smooth: Array, width: Array, *others: Array) -> tuple[Array, ...]:
    """The farther one of two peaks; the second only where it is one of the envelope."""
    second = smooth[1] & (width[1] > width[0])
    return tuple(jnp.where(second, of_peaks[1], of_peaks[0]) for of_peaks in (width, *others))


def _generated(
    motion: ToothMotion, heights: Array, along: Array, angle: Array
) -> tuple[Array, Array, Array, Array, Array]:
    """Whether a flank generates the groove there, half width, slope, curvature, and whether that failed.

    A few nodes at the very ends are generated by the end of a flank instead; they take its tangent.
    """
    beside = _END * motion.flank.length
    smooth, along, angle = _enveloping(motion, heights, along, angle)
    at = motion.at(along, angle)
    level = jnp.real(at.place) - heights  # zero to rounding on the envelope
    slope = jnp.tan(at.direction)
    curvature = jnp.where(smooth, at.relative_curvature, _FLATTEST) - at.curvature
    width = jnp.imag(at.place) - jnp.where(smooth, 0.0, slope * level)
    lost = ~smooth & (along > beside) & (along < motion.flank.length - beside)
    return smooth, width, slope, jnp.clip(curvature, *_CURVATURES), lost


def _enveloping(
    motion: ToothMotion, heights: Array, along: Array, angle: Array
) -> tuple[Array, Array, Array]:
    """Where the farthest point is one of the envelope; place and phase there, as given elsewhere.

    Newton's method in both; its last step is differentiable.
    """
    frozen, targets = jax.lax.stop_gradient((motion, heights))
    length = frozen.flank.length

    def newton(which: ToothMotion, s: Array, p: Array, y: Array) -> tuple[Array, Array]:
        at = which.at(s, p)
        frozen_place = jax.lax.stop_gradient(at)
        a, b = jnp.real(at.place) - y, at.closing
        a_s, a_p = jnp.cos(frozen_place.direction), jnp.real(frozen_place.velocity)
        b_s, b_p = frozen_place.approach, frozen_place.change
        scale = a_s * b_p - a_p * b_s
        scale = jnp.where(scale == 0.0, 1.0, scale)
        return (a * b_p - a_p * b) / scale, (a_s * b - a * b_s) / scale

    def bounded(_: Int[Array, ""], at: tuple[Array, Array]) -> tuple[Array, Array]:
        by_s, by_p = newton(frozen, *at, targets)
        s = at[0] - jnp.clip(by_s, -length / 50.0, length / 50.0)
        return jnp.clip(s, 0.0, length), at[1] - jnp.clip(by_p, -_STRIDE, _STRIDE)

    s, p = jax.lax.fori_loop(0, NEWTON_STEPS, bounded, (along, angle))
    reached = frozen.at(s, p)
    close = (jnp.abs(p - angle) < 0.05) & (jnp.abs(s - along) < length / 20.0)
    solved = (jnp.abs(jnp.real(reached.place) - targets) < 1e-9 * length) & (
        jnp.abs(reached.closing) < 1e-9 * frozen.line.deflection
    )
    by_s, by_p = newton(motion, s, p, heights)
    smooth = close & solved
    return smooth, jnp.where(smooth, s - by_s, along), jnp.where(smooth, p - by_p, angle)
