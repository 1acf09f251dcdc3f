"""Efficiency map of a strain wave gear in NumPy, as one writes it for one drive.

What it computes itself: where every tooth of both zones is at every phase, its clearance by a search
over 1500 places of the flank and 401 more around the best of them, normals and velocities by
differences of positions, the load on all pairs by exchanging pairs until none pulls and none
overlaps, and the balance with friction and bearing loss by fixed point at every operating point.

What it is given as arrays: the outline of the tooth and the flank of the groove, the tooth and ring
compliance (between all pairs, at every phase, for every torque), and the phases with their weights.

Geometry is computed once, the load once for each torque: whoever writes such a loop sees that neither
speed nor temperature enters them. `by_point` treats all phases of an operating point at once,
`by_state` one state after another. The model is the package's: constant friction, drag by Palmgren's
law between wave generator and flexspline, circular spline at rest.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

STATIONS = 1500
FINE = 401
STEP = 1e-4
CLOSE = 1e-13
NONE = 1e-12
MOST = 100


class Drive(NamedTuple):
    """What the rival is given."""

    teeth: tuple[int, int]
    neutral: float
    """Radius of the neutral line [m]."""
    wave: float
    """Deflection w0 of the cosine shape [m]."""
    window: tuple[float, float]
    """Angles between which teeth are looked at [rad]."""
    along: Array
    """Arc lengths of the outline's points [m]."""
    outline: NDArray[np.complex128]
    """Points of the flank, outwards from the neutral line and across from the axis [m]."""
    lean: Array
    """Angle of the flank against the tooth's axis there [rad]."""
    heights: Array
    """Heights at which the groove is known, ascending [m]."""
    half_width: Array
    """Of the groove there [m]."""
    slope: Array
    """Derivative of the half width [1]."""
    friction: float
    mean_diameter: float
    """Of the wave generator's bearing [m]."""
    f0: float
    f1: float


class Geometry(NamedTuple):
    """Pairs at all phases, (lane, phase)."""

    active: NDArray[np.bool_]
    gap: Array
    normal: Array
    """Closing for a unit rate of wave generator, flexspline, circular spline (3, lane, phase) [m]."""
    slip: Array
    radial: Array
    """Inward component of a unit force."""


class Map(NamedTuple):
    """Figures over (torque, speed, temperature)."""

    efficiency: Array
    loss: Array


def _groove(drive: Drive, height: Array) -> Array:
    """Half width by the cubic through values and slopes."""
    cell = np.clip(np.searchsorted(drive.heights, height) - 1, 0, drive.heights.size - 2)
    step = drive.heights[cell + 1] - drive.heights[cell]
    t = np.clip((height - drive.heights[cell]) / step, 0.0, 1.0)
    y0, y1 = drive.half_width[cell], drive.half_width[cell + 1]
    d0, d1 = drive.slope[cell] * step, drive.slope[cell + 1] * step
    bend, twist = 3.0 * (y1 - y0) - 2.0 * d0 - d1, d0 + d1 - 2.0 * (y1 - y0)
    return np.asarray(y0 + t * (d0 + t * (bend + t * twist)))


def _frame(drive: Drive, angle: Array) -> tuple[Array, Array]:
    """Foot of a tooth in the space that it meets, and direction of its axis."""
    lag = 1.0 - drive.teeth[0] / drive.teeth[1]
    turn = lag * angle - drive.wave * np.sin(2.0 * angle) / 2.0 / drive.neutral
    foot = (drive.neutral + drive.wave * np.cos(2.0 * angle)) * np.exp(1j * turn)
    return foot, turn + 2.0 * drive.wave * np.sin(2.0 * angle) / drive.neutral


def _at(drive: Drive, along: Array) -> tuple[Array, Array]:
    """Point and lean of the outline between its given points."""
    real = np.interp(along, drive.along, drive.outline.real)
    across = np.interp(along, drive.along, drive.outline.imag)
    return real + 1j * across, np.interp(along, drive.along, drive.lean)


def geometry(drive: Drive, phases: Array) -> Geometry:
    """Pairs of both zones at these phases [pitches]."""
    pitch = 2.0 * np.pi / drive.teeth[0]
    first = np.ceil(drive.window[0] / pitch)
    lanes = int(np.floor(drive.window[1] / pitch) - first)
    moved = np.mod(np.stack([phases, phases + drive.teeth[0] / 2.0]), 1.0)
    numbers = first + np.arange(lanes)
    angle = (numbers[None, :, None] + moved[:, None, :]).reshape(-1, phases.size) * pitch
    parts = [_at_phase(drive, column) for column in angle.T]
    return Geometry(*(np.stack(each, axis=-1) for each in zip(*parts, strict=True)))


def _at_phase(drive: Drive, angle: Array) -> tuple[Array, ...]:
    station = np.linspace(0.0, drive.along[-1], STATIONS)
    local, _ = _at(drive, station)
    foot, axis = _frame(drive, angle)
    turned = np.exp(1j * axis)
    low = drive.heights[0]
    place = foot[:, None] + turned[:, None] * local
    play = _groove(drive, place.real) - place.imag
    best = station[np.argmin(np.where(place.real < low, np.inf, play), axis=1)]
    along = _refined(drive, foot, turned, best, 2.0 * station[1])
    local, lean = _at(drive, along)
    place = foot + turned * local
    direction = axis - lean

    def moved(by: float) -> Array:
        there, tilt = _frame(drive, angle + by)
        return np.asarray(there + np.exp(1j * tilt) * local)

    lag = 1.0 - drive.teeth[0] / drive.teeth[1]
    velocity = (8.0 * (moved(STEP) - moved(-STEP)) - moved(2 * STEP) + moved(-2 * STEP)) / 12 / STEP
    shift, whole = velocity - 1j * lag * place, 1j * place
    local_velocity = np.exp(-1j * direction) * np.stack([-shift, shift + whole, -whole])
    gap = np.maximum((_groove(drive, place.real) - place.imag) * np.cos(direction), 0.0)
    active = (foot + turned * drive.outline[-1]).real > low
    # What the yielding of other teeth makes possible does no work in a steady state.
    inner = _motion(drive) - _motion(drive).mean()
    normal = local_velocity.imag
    elastic = np.tensordot(_motion(drive), normal, 1) / (inner @ inner)
    normal = normal - inner[:, None] * elastic
    return active, gap, normal, local_velocity.real, np.sin(lean)


def _refined(drive: Drive, foot: Array, turned: Array, best: Array, reach: float) -> Array:
    """Place of the least play on a finer grid, with a parabola through the best three."""
    station = best[:, None] + np.linspace(-reach, reach, FINE)
    station = np.clip(station, 0.0, drive.along[-1])
    place = foot[:, None] + turned[:, None] * _at(drive, station)[0]
    below = place.real < drive.heights[0]
    play = np.where(below, 1.0, _groove(drive, place.real) - place.imag)
    middle = np.clip(np.argmin(play, axis=1), 1, FINE - 2)
    lane = np.arange(best.size)
    left, centre, right = (play[lane, middle + k] for k in (-1, 0, 1))
    curve = left - 2.0 * centre + right
    safe = (curve > 0.0) & (right < 1.0) & (left < 1.0)
    beyond = np.where(safe, 0.5 * (left - right) / np.where(safe, curve, 1.0), 0.0)
    step = 2.0 * reach / (FINE - 1)
    return np.clip(station[lane, middle] + np.clip(beyond, -1.0, 1.0) * step, 0.0, drive.along[-1])


def _motion(drive: Drive) -> Array:
    """Rates of wave generator, flexspline and circular spline for a radian of the first."""
    return np.array([1.0, -(drive.teeth[1] - drive.teeth[0]) / drive.teeth[0], 0.0])


def forces(found: Geometry, compliance: Array, torque: float) -> Array:
    """Normal forces without friction (lane, phase) by exchange of pairs [N]."""
    parts = [
        _equilibrium(
            compliance[..., k],
            found.gap[:, k],
            np.abs(found.normal[1, :, k]),
            found.active[:, k],
            torque,
        )
        for k in range(found.gap.shape[1])
    ]
    return np.stack(parts, axis=-1)


def _equilibrium(
    compliance: Array, gap: Array, arm: Array, active: NDArray[np.bool_], torque: float
) -> Array:
    touch = np.where(active, gap / np.where(active, arm, 1.0), np.inf)
    loaded = touch <= np.sort(touch)[9]
    for _ in range(MOST):
        where = np.flatnonzero(loaded)
        solved = np.linalg.solve(
            compliance[np.ix_(where, where)], np.stack([arm[where], gap[where]], axis=1)
        )
        stiffness = arm[where] @ solved[:, 0]
        approach = (torque + arm[where] @ solved[:, 1]) / stiffness
        force = np.zeros(gap.size)
        force[where] = solved[:, 0] * approach - solved[:, 1]
        slack = compliance @ force + gap - arm * approach
        pulls = loaded & (force < 0.0)
        overlaps = active & ~loaded & (slack < -NONE * gap[active].max())
        if not (pulls | overlaps).any():
            return force
        loaded = loaded & ~pulls if pulls.any() else loaded | overlaps
    raise RuntimeError("the loaded pairs were not found")


def _drag(drive: Drive, speed: float, viscosity: float, load: Array) -> Array:
    """Torque of the bearing between wave generator and flexspline [N m]."""
    relative = abs(_motion(drive) @ np.array([1.0, -1.0, 0.0])) * speed
    product = viscosity * 1e6 * relative * 30.0 / np.pi
    lubricant = product ** (2.0 / 3.0) if product >= 2000.0 else 160.0
    viscous = 1e-10 * drive.f0 * lubricant * (drive.mean_diameter * 1e3) ** 3
    return np.asarray(viscous + drive.f1 * load * drive.mean_diameter)


def _balance(
    drive: Drive, arms: tuple[Array, ...], torque: float, speed: float, viscosity: float
) -> Array:
    """Input torque; arms are sums over the pairs for a unit of total force, any number of phases."""
    out_normal, out_slip, in_normal, in_slip, pressed = arms
    grip = out_normal - drive.friction * out_slip
    force = torque / grip
    for _ in range(MOST):
        drag = _drag(drive, speed, viscosity, pressed * force)
        better = (torque + drag) / grip
        done = np.max(np.abs(better - force)) <= CLOSE * np.max(force)
        force = better
        if done:
            break
    drag = _drag(drive, speed, viscosity, pressed * force)
    return np.asarray(force * (in_normal + drive.friction * in_slip) + drag)


def _arms(found: Geometry, force: Array, motion: Array) -> tuple[Array, ...]:
    """Sums over the pairs for shares of one newton (phase,).

    Positive torque on the flexspline is what it delivers; friction takes from it and adds to the input.
    """
    share = force / force.sum(axis=0)
    sense = np.sign(np.tensordot(motion, found.slip, 1))
    side = np.sign((share * found.normal[1]).sum(axis=0))
    each = [
        (share * found.normal[1]).sum(axis=0) * side,
        -(share * sense * found.slip[1]).sum(axis=0) * side,
        (share * found.normal[0]).sum(axis=0),
        (share * sense * found.slip[0]).sum(axis=0),
        (share * found.radial).sum(axis=0),
    ]
    return tuple(each)


def by_point(
    drive: Drive,
    found: Geometry,
    compliance: Array,
    weight: Array,
    torque: float,
    speeds: Array,
    viscosities: Array,
) -> tuple[Array, Array]:
    """Efficiency and loss (speed, temperature) of one torque, all phases of a point together."""
    motion = _motion(drive)
    arms = _arms(found, forces(found, compliance, torque), motion)
    efficiency, loss = np.empty((2, speeds.size, viscosities.size))
    for i, speed in enumerate(speeds):
        for j, viscosity in enumerate(viscosities):
            given = weight @ _balance(drive, arms, torque, speed, viscosity)
            efficiency[i, j] = -torque * motion[1] / given
            loss[i, j] = (given + torque * motion[1]) * speed
    return efficiency, loss


def by_state(
    drive: Drive,
    found: Geometry,
    compliance: Array,
    weight: Array,
    torque: float,
    speeds: Array,
    viscosities: Array,
) -> tuple[Array, Array]:
    """The same with one state after another: sums over the pairs anew at each."""
    motion = _motion(drive)
    force = forces(found, compliance, torque)
    efficiency, loss = np.empty((2, speeds.size, viscosities.size))
    for i, speed in enumerate(speeds):
        for j, viscosity in enumerate(viscosities):
            given = 0.0
            for k, part in enumerate(weight):
                at = Geometry(*(field[..., k : k + 1] for field in found))
                arms = _arms(at, force[:, k : k + 1], motion)
                given += part * float(_balance(drive, arms, torque, speed, viscosity)[0])
            efficiency[i, j] = -torque * motion[1] / given
            loss[i, j] = (given + torque * motion[1]) * speed
    return efficiency, loss
