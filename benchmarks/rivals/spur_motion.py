"""Motion of a spur pair with friction in the loop: `scipy.integrate.solve_ivp`, and a compiled loop.

Rotations of two gears and, where their bearings yield, two translations of each: along the normal and along
the tangent, which for bearings that are alike in all directions is as good as any frame. A pair of teeth is a
spring, a polynomial of its path in base pitches, with a damper, and pushes only; it draws by the law of Xu et
al. (2007) at its own force and speeds, made smooth about no sliding by tanh. External torques are constant.

`solved` is the rival: DOP853 and a right-hand side in NumPy, both pairs of teeth in one array, and what
does not change computed before. `loop` is the other one: the same equations in plain numbers, and
Prince and Dormand's method of order eight with its own steps, compiled by numba where that is installed.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

try:
    from numba import njit
except ModuleNotFoundError:
    njit = None

Array = NDArray[np.float64]

XU = np.array(
    [-8.916465, 1.03303, 1.036077, -0.354068, 2.812084, -0.100601, 0.752755, -0.390958, 0.620305]
)


class Pair(NamedTuple):
    """What moves; SI. Where the bearings do not yield their mass is infinite."""

    teeth: tuple[int, int]
    module: float
    pressure_angle: float
    width: float
    modulus: float
    viscosity: float
    roughness: float
    inertia: tuple[float, float]
    mass: tuple[float, float]
    bearing: float
    bearing_damping: float
    viscous: float
    stiffness: tuple[float, ...]
    relaxation: float
    creep: float
    phase: float


class Constants(NamedTuple):
    """All that the right-hand side asks for, as numbers and arrays."""

    base: Array
    start: float
    pitch: float
    way: float
    ratio: float
    cycle: float
    phase: float
    width: float
    pressed: float
    before: float
    roughened: float
    thick: float
    mass: Array
    held: float
    damped: float
    viscous: float
    stiffness: Array
    relaxation: float
    creep: float


def constants(pair: Pair) -> Constants:
    """Geometry of standard involute gears, gear 1 driving, and all products that do not change."""
    radius = pair.module * np.array(pair.teeth) / 2.0
    base = radius * math.cos(pair.pressure_angle)
    tip = np.sqrt((radius + pair.module) ** 2 - base**2)
    way = float(np.sum(radius)) * math.sin(pair.pressure_angle)
    pitch = math.pi * pair.module * math.cos(pair.pressure_angle)
    cP = 1e3 * pair.viscosity
    return Constants(
        base=base,
        start=way - float(tip[1]),
        pitch=pitch,
        way=way,
        ratio=float(np.sum(tip) - way) / pitch,
        cycle=pair.teeth[0] / (2.0 * math.pi),
        phase=pair.phase,
        width=pair.width,
        pressed=pair.modulus / (2.0 * math.pi * pair.width),
        before=cP ** float(XU[6]),
        roughened=float(XU[0] + XU[8] * math.exp(1e6 * pair.roughness)),
        thick=math.log10(cP),
        mass=np.array([*pair.inertia, *np.repeat(pair.mass, 2)]),
        held=pair.bearing,
        damped=pair.bearing_damping,
        viscous=pair.viscous,
        stiffness=np.array(pair.stiffness),
        relaxation=pair.relaxation,
        creep=pair.creep,
    )


def rate(own: Constants, torque: Array) -> Callable[[float, Array], Array]:
    """Derivative of places and rates, both pairs of teeth at once."""
    own_pairs, powers = np.array([0.0, 1.0]), own.stiffness[::-1]
    (r1, r2), size = own.base, own.mass.size

    def slope(_: float, state: Array) -> Array:
        place, speed = state[:size], state[size:]
        path = (own.phase + own.cycle * place[0]) % 1.0 + own_pairs
        first = own.start + own.pitch * path
        second = own.way - first
        stiffness = np.where(path < own.ratio, np.polyval(powers, path), 0.0)
        stretch = r1 * place[0] + r2 * place[1] + place[2] - place[4]
        closing = r1 * speed[0] + r2 * speed[1] + speed[2] - speed[4]
        push = max(stretch + own.relaxation * closing, 0.0) if stretch > 0.0 else 0.0
        force = stiffness * push
        fast, slow = first * speed[0] + speed[3], -second * speed[1] + speed[5]
        slip, mean = fast - slow, np.abs(fast + slow) / 2.0
        radius = first * second / own.way
        carried = np.where(force > 0.0, force, 1.0)
        GPa = 1e-9 * np.sqrt(own.pressed * carried / radius)
        SR = np.maximum(np.abs(slip) / mean, 1e-12)
        heavy = GPa * SR * own.thick
        f = own.roughened + XU[3] * heavy + XU[4] * np.exp(-heavy)
        friction = own.before * np.exp(np.minimum(f, 50.0)) * GPa ** XU[1]
        friction = friction * SR ** XU[2] * mean ** XU[5] * radius ** XU[7]
        drawn = friction * force * np.tanh(slip / own.creep)
        whole, pulled = np.sum(force), np.sum(drawn)
        pushed = np.array([-r1 * whole, -r2 * whole, -whole, -pulled, whole, pulled])
        pushed[0] += torque[0] - drawn @ first
        pushed[1] += torque[1] - drawn @ second - own.viscous * speed[1]
        pushed[2:] -= own.held * place[2:] + own.damped * speed[2:]
        return np.concatenate([speed, pushed / own.mass])

    return slope


def solved(
    pair: Pair, torque: Array, times: Array, start: Array, unit: Array, tolerance: float
) -> Any:
    """Solution at times; the absolute tolerance is that of each state's own unit."""
    return solve_ivp(
        rate(constants(pair), torque),
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=1e-2 * tolerance,
        atol=tolerance * unit,
    )


def _slope(own: Any, torque: Any, state: Any, found: Any) -> None:
    """The same derivative in plain numbers, one pair of teeth after the other."""
    size = own.mass.size
    r1, r2 = own.base[0], own.base[1]
    turned = own.phase + own.cycle * state[0]
    turned -= math.floor(turned)
    stretch = r1 * state[0] + r2 * state[1] + state[2] - state[4]
    closing = r1 * state[size] + r2 * state[size + 1] + state[size + 2] - state[size + 4]
    push = max(stretch + own.relaxation * closing, 0.0) if stretch > 0.0 else 0.0
    whole, pulled, on_first, on_second = 0.0, 0.0, 0.0, 0.0
    for number in range(2):
        path = turned + number
        if path >= own.ratio or push == 0.0:
            continue
        first = own.start + own.pitch * path
        second = own.way - first
        stiffness = 0.0
        for power in range(own.stiffness.size - 1, -1, -1):
            stiffness = stiffness * path + own.stiffness[power]
        force = stiffness * push
        fast, slow = (
            first * state[size] + state[size + 3],
            -second * state[size + 1] + state[size + 5],
        )
        slip, mean = fast - slow, abs(fast + slow) / 2.0
        radius = first * second / own.way
        GPa = 1e-9 * math.sqrt(own.pressed * force / radius)
        SR = max(abs(slip) / mean, 1e-12)
        heavy = GPa * SR * own.thick
        f = min(own.roughened + XU[3] * heavy + XU[4] * math.exp(-heavy), 50.0)
        logs = XU[1] * math.log(GPa) + XU[2] * math.log(SR)
        logs += XU[5] * math.log(mean) + XU[7] * math.log(radius)
        drawn = own.before * math.exp(f + logs) * force * math.tanh(slip / own.creep)
        whole += force
        pulled += drawn
        on_first += drawn * first
        on_second += drawn * second
    for number in range(size):
        found[number] = state[size + number]
    found[size] = (torque[0] - r1 * whole - on_first) / own.mass[0]
    found[size + 1] = (torque[1] - r2 * whole - on_second - own.viscous * state[size + 1]) / (
        own.mass[1]
    )
    for number in range(2, size):
        sign = -1.0 if number < 4 else 1.0
        pushed = sign * (whole if number % 2 == 0 else pulled)
        held = own.held * state[number] + own.damped * state[size + number]
        found[size + number] = (pushed - held) / own.mass[number]


def _loop(
    own: Any,
    torques: Any,
    starts: Any,
    span: float,
    unit: Any,
    tolerance: float,
    tableau: Any,
    ends: Any,
) -> int:
    """One operating point after the other to the end of a span; calls of the right-hand side."""
    places, weights, errors = tableau
    stages, size = weights.size, starts.shape[1]
    slopes, state, trial = np.zeros((stages, size)), np.zeros(size), np.zeros(size)
    calls = 0
    for point in range(starts.shape[0]):
        state[:] = starts[point]
        time, step = 0.0, 1e-4 * span
        while time < span:
            step = min(step, span - time)
            for stage in range(stages):
                for number in range(size):
                    more = 0.0
                    for before in range(stage):
                        more += places[stage, before] * slopes[before, number]
                    trial[number] = state[number] + step * more
                slope(own, torques[point], trial, slopes[stage])
            calls += stages
            square = 0.0
            for number in range(size):
                more, missed = 0.0, 0.0
                for stage in range(stages):
                    more += weights[stage] * slopes[stage, number]
                    missed += errors[stage] * slopes[stage, number]
                trial[number] = state[number] + step * more
                large = max(abs(state[number]), abs(trial[number]))
                allowed = tolerance * unit[number] + 1e-2 * tolerance * large
                square += (step * missed / allowed) ** 2
            wrong = math.sqrt(square / size)
            if wrong <= 1.0:
                time += step
                state[:] = trial
            step *= min(max(0.9 * max(wrong, 1e-10) ** -0.125, 0.2), 10.0)
        ends[point] = state
    return calls


slope = _slope if njit is None else njit(_slope)
loop = None if njit is None else njit(_loop)
