"""Plain NumPy rival for the spur pair benchmark, written for speed.

Torque-balanced contact force, input torque and efficiency of the spur pair 18/36 (module 3 mm,
20 deg, width 26.7 mm, centre distance 81 mm) after Tian, Wang and Jiang (2024), equations 1-3, 11
and 13-18, with the friction coefficient of Xu et al. (2007) and the sign of sliding per contact.

A state is one pair (meshing position, operating point). It is solved on its own: no state uses
another one. What makes it fast:

- everything that depends on the position alone or on the point alone is computed once, so a state
  is left with ``z = decay * scale * sqrt(x)`` and ``exp(b4 z + b5 exp(-z))`` per contact, where
  ``x`` is the contact force over the frictionless one;
- states of the single zone carry one contact, those of the double zone two;
- one step in float32, where NumPy has a vector ``exp``, then one Newton step in float64; its
  last correction also updates the loss to first order. A block whose correction was too long for
  the tolerance takes another float64 step;
- all ufuncs write to buffers that are allocated once and reused.

Run as a script it checks itself and prints nanoseconds per state. Set ``OPENBLAS_NUM_THREADS=1``
(and pin the process to one core) for a one-thread figure.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Single = NDArray[np.float32]
Real = TypeVar("Real", np.float32, np.float64)

Z1, Z2, MODULE, WIDTH, ALPHA = 18, 36, 3e-3, 26.7e-3, np.radians(20.0)
YOUNG, POISSON = 206e9, 0.3
B1, B2, B3, B4, B5, B6, B7, B8, B9 = (
    -8.916465,
    1.03303,
    1.036077,
    -0.354068,
    2.812084,
    -0.100601,
    0.752755,
    -0.390958,
    0.620305,
)

RB1, RB2 = (0.5 * MODULE * z * np.cos(ALPHA) for z in (Z1, Z2))
LINE = (RB1 + RB2) * np.tan(ALPHA)
PITCH = np.pi * MODULE * np.cos(ALPHA)
TIP1, TIP2 = (0.5 * MODULE * (z + 2) for z in (Z1, Z2))
START = LINE - np.sqrt(TIP2**2 - RB2**2)
CONTACT_RATIO = (np.sqrt(TIP1**2 - RB1**2) - START) / PITCH

TOLERANCE = 1e-10
# A Newton step of length s leaves a relative force error below 0.05 s^2 while friction changes the
# force by less than 10 %: half the curvature is (1 + a) a Q / 2 with |a| < 0.52.
LONGEST_STEP = np.sqrt(TOLERANCE / 0.05)
MAX_EVALUATIONS = 12
BLOCK_STATES = 32000
COLUMNS = 4000


class Points(NamedTuple):
    """Operating points, each field of shape (points,)."""

    torque: Array
    """Output torque [N m]."""
    speed: Array
    """Pinion speed [1/min]."""
    viscosity: Array
    """Dynamic viscosity [mPa s], above 1."""
    roughness: Array
    """Composite roughness of the friction formula [um]."""


class Result(NamedTuple):
    """Results per state, each field of shape (positions, points)."""

    force: Array
    """Contact force, sum over the contacts [N]."""
    input_torque: Array
    """Torque on the pinion [N m]."""
    efficiency: Array
    """Output power over input power [1]."""
    iterations: NDArray[np.int8]
    """Evaluations of the friction formula, the one in float32 included."""


class Zone(NamedTuple):
    """What depends on the position alone, per contact: shape (contacts, positions, 1)."""

    rows: NDArray[np.intp]
    decay: Array
    balance: Array
    loss: Array
    ratio: Array
    decay32: Single
    balance32: Single


class Load(NamedTuple):
    """What depends on the operating point alone: shape (points,)."""

    force: Array
    torque: Array
    scale: Array
    level: Array
    scale32: Single
    level32: Single


class Buffers(NamedTuple):
    """Work arrays: `pair*` of two contacts per state, `one*` of one value per state."""

    pair: tuple[Array, ...]
    one: tuple[Array, ...]
    pair32: tuple[Single, ...]
    one32: tuple[Single, ...]


def buffers(states: int) -> Buffers:
    """Allocate work arrays for blocks of at most `states` states."""
    return Buffers(
        tuple(np.zeros(2 * states) for _ in range(3)),
        tuple(np.zeros(states) for _ in range(5)),
        tuple(np.zeros(2 * states, np.float32) for _ in range(3)),
        tuple(np.zeros(states, np.float32) for _ in range(2)),
    )


def empty_result(positions: int, points: int) -> Result:
    """Allocate the results, touched once so that timings do not hold page faults."""
    force, torque, efficiency = (np.zeros((positions, points)) for _ in range(3))
    return Result(force, torque, efficiency, np.zeros((positions, points), np.int8))


def _zone(rows: NDArray[np.intp], path: Array, share: Array) -> Zone:
    """Constants of the contacts at `path` [base pitches from the start of contact]."""
    rho1 = START + path * PITCH
    rho2 = LINE - rho1
    u1, u2 = rho1, rho2 * (Z1 / Z2)
    entrain, slip = 0.5 * (u1 + u2), u1 - u2
    slide = np.abs(slip) / entrain
    radius = rho1 * rho2 / LINE
    modulus = YOUNG / (2.0 * (1.0 - POISSON**2))
    hertz = 1e-9 * np.sqrt(share * modulus / (np.pi * radius * WIDTH))
    friction = hertz**B2 * slide**B3 * entrain**B6 * radius**B8
    signed = np.sign(slip) * share * friction
    tan1, tan2 = rho1 / RB1, rho2 / RB2
    decay, balance, loss = -slide * hertz, signed * tan2, signed * (tan1 - tan2)
    ratio = tan1 / tan2 - 1.0
    single = decay.astype(np.float32), balance.astype(np.float32)
    return Zone(rows, *(a[..., None] for a in (decay, balance, loss, ratio, *single)))


def zones(positions: Array) -> tuple[Zone, Zone]:
    """Split positions [base pitches, 0..1] into the double and the single zone, eq. 11."""
    double = positions < CONTACT_RATIO - 1.0
    rows2, rows1 = np.flatnonzero(double), np.flatnonzero(~double)
    main = positions[rows2]
    share = 0.36 + 0.28 / (CONTACT_RATIO - 1.0) * main
    return (
        _zone(rows2, np.stack([main, main + 1.0]), np.stack([share, 1.0 - share])),
        _zone(rows1, positions[rows1][None], np.ones((1, rows1.size))),
    )


def load(points: Points) -> Load:
    """Constants of the operating points."""
    force = points.torque / RB2
    omega = points.speed * (2.0 * np.pi / 60.0)
    scale = np.log10(points.viscosity) * np.sqrt(force)
    level = np.exp(
        B1
        + B9 * np.exp(points.roughness)
        + B6 * np.log(omega)
        + B7 * np.log(points.viscosity)
        + 0.5 * B2 * np.log(force)
    )
    single = scale.astype(np.float32), level.astype(np.float32)
    return Load(force, points.torque * (RB1 / RB2), scale, level, *single)


def _sum(terms: NDArray[Real], out: NDArray[Real]) -> NDArray[Real]:
    """Sum over the contacts; one contact needs no work."""
    total: NDArray[Real] = terms[0]
    if len(terms) > 1:
        np.add(total, terms[1], out=out)
        total = out
    return total


def _guess(zone: Zone, at: Load, work: Buffers, shape: tuple[int, int]) -> Single:
    """Root of the force ratio, from one float32 step of third order started without friction."""
    pair = (len(zone.decay), *shape)
    z, t, u = (a[: pair[0] * shape[0] * shape[1]].reshape(pair) for a in work.pair32)
    s, q = (a[: shape[0] * shape[1]].reshape(shape) for a in work.one32)
    np.multiply(zone.decay32, at.scale32, out=z)
    np.exp(z, out=t)
    t *= np.float32(B5)
    np.subtract(t, np.float32(B4), out=u)
    u *= z
    z *= np.float32(B4)
    t -= z
    np.exp(t, out=t)
    t *= zone.balance32
    u *= t
    first, slope = _sum(t, s), _sum(u, q)
    np.multiply(first, at.level32, out=s)
    np.multiply(slope, at.level32, out=q)
    # f = x (1 + Q) - 1 at x = 1; q is the logarithmic slope x dQ/dx.
    rise, curve = z[0], t[0]
    np.multiply(s, np.float32(B2), out=rise)
    q += rise
    q *= np.float32(0.5)
    np.add(s, q, out=rise)
    rise += np.float32(1.0)
    s /= rise
    # Q is close to a power 0.35 of x, hence f'' = 1.35 q and half of it below.
    np.multiply(q, s, out=curve)
    curve /= rise
    curve *= np.float32(0.67)
    curve += np.float32(1.0)
    s *= curve
    np.subtract(np.float32(1.0), s, out=s)
    return np.sqrt(s, out=s)


def _newton(
    zone: Zone, at: Load, work: Buffers, shape: tuple[int, int], start: Single
) -> tuple[Array, Array, float]:
    """One float64 Newton step: force ratio, input torque ratio, longest step.

    `start` is the root of the force ratio to start from.
    """
    pair = (len(zone.decay), *shape)
    z, t, u = (a[: pair[0] * shape[0] * shape[1]].reshape(pair) for a in work.pair)
    x, r, s, q, d = (a[: shape[0] * shape[1]].reshape(shape) for a in work.one)
    log32 = work.one32[1][: shape[0] * shape[1]].reshape(shape)
    np.copyto(r, start)
    np.multiply(r, r, out=x)
    # r^b2 = r r^(b2-1), where r^2 = x; the second exponent is 0.033, so a float32 log is enough.
    np.log(start, out=log32)
    np.multiply(log32, B2 - 1.0, out=q)
    np.multiply(at.scale, r, out=s)
    r *= at.level
    np.multiply(zone.decay, s, out=z)
    np.exp(z, out=t)
    t *= B5
    np.subtract(t, B4, out=u)
    u *= z
    z *= B4
    t -= z
    t += q
    np.exp(t, out=t)
    np.multiply(t, zone.balance, out=z)
    first = _sum(z, s)
    np.multiply(first, r, out=s)
    z *= u
    np.multiply(_sum(z, q), r, out=q)
    np.multiply(s, B2, out=d)
    q += d
    q *= 0.5
    s += 1.0
    q += s
    s *= x
    np.subtract(1.0, s, out=s)
    s /= q
    step = max(float(s.max()), -float(s.min()))
    if len(zone.decay) == 1:
        # The balance holds after the step, so the loss follows from the force itself.
        x += s
        np.subtract(1.0, x, out=q)
        q *= zone.ratio[0]
        q += 1.0
        return x, q, step
    t *= zone.loss
    u *= t
    _sum(t, q)
    _sum(u, d)
    q *= r
    d *= r
    # y = 1 + x D; to first order its change is (D + x dD/dx) times the step.
    d *= 0.5
    np.multiply(q, 1.0 + 0.5 * B2, out=r)
    d += r
    d *= s
    q *= x
    q += d
    q += 1.0
    x += s
    return x, q, step


def _converge(
    zone: Zone, at: Load, work: Buffers, shape: tuple[int, int]
) -> tuple[Array, Array, int]:
    """Force ratio, input torque ratio and evaluations of the friction formula of one block."""
    start = _guess(zone, at, work, shape)
    for evaluations in range(2, MAX_EVALUATIONS + 1):
        x, y, step = _newton(zone, at, work, shape, start)
        if step < LONGEST_STEP:
            return x, y, evaluations
        np.sqrt(x, out=start, casting="same_kind")
    raise RuntimeError("the torque balance did not converge")


def _solve(zone: Zone, at: Load, work: Buffers, out: Result) -> None:
    """Solve one block and write it to `out`, whose fields are views of the block."""
    rows, columns = out.force.shape
    x, y, evaluations = _converge(zone, at, work, (rows, columns))
    np.multiply(x, at.force, out=out.force)
    np.multiply(y, at.torque, out=out.input_torque)
    np.divide(1.0, y, out=out.efficiency)
    out.iterations[...] = evaluations


def _cut(fields: Sequence[NDArray[Any]], where: Any) -> list[Any]:
    return [field[where] for field in fields]


def _blocks(
    zone: Zone, at: Load, out: Result, rows: int, columns: int
) -> Iterator[tuple[Zone, Load, Result]]:
    """Constants and results of blocks of neighbouring rows of one zone."""
    for first in range(0, zone.rows.size, rows):
        part = slice(first, first + rows)
        lines = zone.rows[part]
        held = Zone(lines, *_cut(zone[1:], (slice(None), part)))
        for left in range(0, at.force.size, columns):
            cut = slice(left, left + columns)
            area = slice(lines[0], lines[-1] + 1), cut
            yield held, Load(*_cut(at, cut)), Result(*_cut(out, area))


def _ordered(
    positions: Array,
    points: Points,
    rows: int,
    columns: int,
    out: Result | None,
    work: Buffers | None,
) -> Result:
    """Solve sorted positions; a zone is then a run of neighbouring rows."""
    if np.any(np.diff(positions) < 0.0):
        raise ValueError("positions must ascend")
    count, width = positions.size, points.torque.size
    out = empty_result(count, width) if out is None else out
    work = buffers(min(rows, count) * min(columns, width)) if work is None else work
    at = load(points)
    for zone in zones(positions):
        for held, part, area in _blocks(zone, at, out, rows, columns):
            _solve(held, part, work, area)
    return out


def whole_array(
    positions: Array, points: Points, *, out: Result | None = None, work: Buffers | None = None
) -> Result:
    """Solve all states with whole-array NumPy, one array per zone.

    Arguments:
        positions: main pair from the start of contact, ascending, (positions,) [base pitches, 0..1]
        points: operating points, fields (points,)
        out: results to write to, from `empty_result`
        work: work arrays for all states, from `buffers`

    Returns the results, fields (positions, points). Raises ValueError for positions that do not
    ascend, RuntimeError without convergence.
    """
    return _ordered(positions, points, positions.size, points.torque.size, out, work)


def cache_blocked(
    positions: Array,
    points: Points,
    *,
    block: int = BLOCK_STATES,
    out: Result | None = None,
    work: Buffers | None = None,
) -> Result:
    """Solve all states in blocks whose work arrays stay in the cache.

    Arguments, returns and errors as `whole_array`; `block` is the number of states per block and
    `work` must hold as many. A state needs 120 bytes of work arrays and a block about 80 calls of
    ufuncs, so the block that fits a small L2 is not the fastest: tune it (`--tune`).
    """
    columns = min(COLUMNS, block, points.torque.size)
    return _ordered(positions, points, max(1, block // columns), columns, out, work)


def random_points(count: int, seed: int = 0) -> Points:
    """Random operating points: 50..500 N m, 1000..10000 1/min, 15..100 mPa s, 0.1..1.0 um."""
    rng = np.random.default_rng(seed)
    ranges = ((50.0, 500.0), (1e3, 1e4), (15.0, 100.0), (0.1, 1.0))
    return Points(*(rng.uniform(*limits, count) for limits in ranges))


def scalar_state(
    position: float, torque: float, speed: float, viscosity: float, roughness: float
) -> tuple[float, float, float]:
    """Slow reference for one state, formulas as printed, root by Brent's method.

    Arguments in the units of `Points`. Returns force [N], input torque [N m] and efficiency [1],
    the last from the friction losses (eqs. 5 and 8) and not from the torques.
    """
    from math import exp, log10, pi

    from scipy.optimize import brentq

    if position < CONTACT_RATIO - 1.0:
        share = 0.36 + 0.28 * position / (CONTACT_RATIO - 1.0)
        other = 0.36 - 0.28 * (position + 1.0 - CONTACT_RATIO) / (CONTACT_RATIO - 1.0)
        contacts = [(position, share), (position + 1.0, other)]
    else:
        contacts = [(position, 1.0)]
    omega1 = 2.0 * pi * speed / 60.0
    omega2 = omega1 * Z1 / Z2

    def arms(path: float) -> tuple[float, float]:
        return START + path * PITCH, LINE - START - path * PITCH

    def friction(path: float, share: float, force: float) -> float:
        rho1, rho2 = arms(path)
        u1, u2 = omega1 * rho1, omega2 * rho2
        entrain = (u1 + u2) / 2.0
        slide = abs(u1 - u2) / entrain
        radius = 1.0 / (1.0 / rho1 + 1.0 / rho2)
        reduced = 1.0 / (2.0 * (1.0 - POISSON**2) / YOUNG)
        hertz = (share * force / WIDTH * reduced / (pi * radius)) ** 0.5 / 1e9
        z = slide * hertz * log10(viscosity)
        f = B1 + B4 * z + B5 * exp(-z) + B9 * exp(roughness)
        powers = hertz**B2 * slide**B3 * entrain**B6 * viscosity**B7 * radius**B8
        return float(exp(f) * powers)

    def moment(force: float, wheel: int) -> float:
        total = force * float((RB1, RB2)[wheel])
        for path, share in contacts:
            rho = arms(path)
            sign = 1.0 if omega1 * rho[0] > omega2 * rho[1] else -1.0
            total += sign * share * force * friction(path, share, force) * rho[wheel]
        return total

    force = brentq(
        lambda f: moment(f, 1) - torque,
        0.2 * torque / RB2,
        5.0 * torque / RB2,
        xtol=1e-9,
        rtol=1e-14,
    )
    power_loss = sum(
        share
        * force
        * friction(path, share, force)
        * abs(omega1 * arms(path)[0] - omega2 * arms(path)[1])
        for path, share in contacts
    )
    return force, moment(force, 0), torque * omega2 / (torque * omega2 + power_loss)


def check_reference(states: int = 200, seed: int = 1) -> float:
    """Largest relative deviation of both versions from `scalar_state` on random states."""
    rng = np.random.default_rng(seed)
    positions, points = np.sort(rng.uniform(size=states)), random_points(states, seed)
    columns = rng.permutation(states)
    expected = np.array(
        [scalar_state(positions[i], *(a[j] for a in points)) for i, j in enumerate(columns)]
    )
    worst = 0.0
    for solve in (whole_array, cache_blocked):
        found = solve(positions, points)
        picked = np.stack([a[np.arange(states), columns] for a in found[:3]], axis=1)
        worst = max(worst, float(np.max(np.abs(picked / expected - 1.0))))
    return worst


def case_one() -> tuple[float, float, float]:
    """Case 1 of the paper: least efficiency, largest input torque, mean efficiency on the path."""
    path = np.linspace(0.0, CONTACT_RATIO, 20001)[:-1]
    order = np.argsort(path % 1.0)
    case = Points(*(np.array([v]) for v in (159.0, 1500.0, 54.8, 0.8)))
    found = whole_array((path % 1.0)[order], case)
    return (
        float(found.efficiency.min()),
        float(found.input_torque.max()),
        float(found.efficiency.mean()),
    )


def _median_ns(run: Callable[[], object], states: int, repeats: int) -> float:
    run()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return float(np.median(times) / states * 1e9)


def main() -> None:
    """Check, then time both versions."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--positions", type=int, default=1000)
    parser.add_argument("--points", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--block", type=int, default=BLOCK_STATES)
    parser.add_argument("--tune", action="store_true", help="time several block sizes")
    args = parser.parse_args()

    print(f"largest relative deviation from brentq, 200 states: {check_reference():.1e}")
    least, torque, mean = case_one()
    print(f"case 1: least efficiency {least:.5%}, mean on path {mean:.5%}, torque {torque:.4f} N m")

    positions = (np.arange(args.positions) + 0.5) / args.positions
    points = random_points(args.points)
    states = args.positions * args.points
    out = empty_result(args.positions, args.points)
    full = buffers(states)
    run = partial(whole_array, positions, points, out=out, work=full)
    ns = _median_ns(run, states, args.repeats)
    used = np.unique(out.iterations).tolist()
    print(f"whole_array                 {ns:7.2f} ns/state, evaluations {used}")
    sizes = (1000, 2000, 4000, 8000, 16000, 32000, 64000) if args.tune else (args.block,)
    for block in sizes:
        run = partial(cache_blocked, positions, points, block=block, out=out, work=buffers(block))
        print(
            f"cache_blocked, block {block:6d} {_median_ns(run, states, args.repeats):7.2f} ns/state"
        )


if __name__ == "__main__":
    main()
