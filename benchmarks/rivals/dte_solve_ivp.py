"""Steady dynamic transmission error of a gear pair with `scipy.integrate.solve_ivp`.

One degree of freedom on the line of action, m d'' + c d' + k(t) d = F, with d = r_b1 theta_1 -
r_b2 theta_2, a constant force and a stiffness that repeats every mesh period, is smooth between
hand-over instants and may jump there. The profile error is zero.

`steady` is the rival: a loop over cases, each on its own. What makes it fast:

- each segment between hand-overs is an integration of its own, so no step meets a jump;
- length F/k_mean and time sqrt(m/k_mean), so that one tolerance suits every case;
- the stiffness of a segment is a table of 512 intervals, read by index and slope; state, table and
  constants are Python floats, faster here than NumPy scalars;
- LSODA: its multistep Adams formulas need about two evaluations a step while the teeth ring, its
  backward differentiation takes over where they only follow the load. RK45 took twice its time at
  this accuracy, DOP853, Radau and BDF more;
- the static solution is released only as long before the period that is kept as its error needs to
  decay; further periods run only if that one does not close on itself;
- extremes and mean come from the solver's own steps by cubic Hermite interpolation, without dense
  output.

`steady_together` goes beyond that loop: one system of all cases of a block, each segment of each
case mapped to 0..1 so that the hand-overs coincide, with a banded Jacobian. It stands beside the
loop as what whole-array NumPy can do with the same solver.

Excitation of N cases of S segments with Q nodes, as fields of `Cases` or arrays of an .npz file:

    edges      (N, S + 1)  ascending hand-over phases; the last is the first plus 1 [mesh periods]
    stiffness  (N, S, Q)   total mesh stiffness at the Gauss-Lobatto nodes of each segment, both
                           its ends among them, ascending; Q >= 2 counts from the array [N/m]
    mass       (N,)        equivalent mass [kg]
    damping    (N,)        c [N s/m], above zero
    force      (N,)        F, above zero [N]
    period     (N,)        mesh period [s]

Segments may have no length. Run as a script it checks itself against a tighter run and prints one
line of JSON with seconds per case; `--input` reads such a file, `--save` writes the cases that were
solved and their results. Set ``OPENBLAS_NUM_THREADS=1`` for a one-thread figure.
"""

import argparse
import json
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

TABLE = 512
TOLERANCE = 1e-6
TIGHT = 1e-10
CLOSED = 20.0
MOST_PERIODS = 200
BLOCK_CASES = 400


class Cases(NamedTuple):
    """Excitation as the module describes it, first axis (cases,)."""

    edges: Array
    stiffness: Array
    mass: Array
    damping: Array
    force: Array
    period: Array


class Steady(NamedTuple):
    """Steady state, fields (cases,)."""

    mean: Array
    """Mean of d over a mesh period [m]."""
    peak_to_peak: Array
    """Largest less smallest d [m]."""
    dynamic_factor: Array
    """Largest k(t) d / F [1], on both sides of every hand-over."""
    change: Array
    """Change of d over the period that was kept, over F/k_mean [1]."""


class Scaled(NamedTuple):
    """Cases in units of F/k_mean and sqrt(m/k_mean): x'' + 2 zeta x' + k x = 1."""

    table: Array
    """Stiffness, (cases, segments, TABLE + 1)."""
    duration: Array
    """Durations of the segments, (cases, segments)."""
    zeta: Array
    """Damping ratio, (cases,)."""
    length: Array
    """F/k_mean, (cases,) [m]."""


class Path(NamedTuple):
    """Solver steps through one segment, each (..., steps)."""

    times: Array
    deflection: Array
    velocity: Array
    stiffness: Array
    slope: Array


def lobatto_nodes(count: int) -> Array:
    """Gauss-Lobatto nodes on -1..1, ends included, ascending."""
    inner = legendre.Legendre.basis(count - 1).deriv().roots()
    return np.concatenate(([-1.0], np.sort(np.real(inner)), [1.0]))


def _scaled(cases: Cases) -> Scaled:
    nodes = lobatto_nodes(cases.stiffness.shape[-1])
    degree = nodes.size - 1
    series = cases.stiffness @ np.linalg.inv(legendre.legvander(nodes, degree)).T
    table = series @ legendre.legvander(np.linspace(-1.0, 1.0, TABLE + 1), degree).T
    width = np.diff(cases.edges, axis=1)
    mean = np.sum(series[..., 0] * width, axis=1)
    frequency = np.sqrt(mean / cases.mass)
    return Scaled(
        table / mean[:, None, None],
        width * (frequency * cases.period)[:, None],
        cases.damping / (2.0 * cases.mass * frequency),
        cases.force / mean,
    )


def _release(duration: Array, zeta: Array, tolerance: float) -> tuple[int, float]:
    """Segments to run before the kept period, and where in the first of them to start [0..1].

    Arguments: durations (cases, segments), damping ratios (cases,), what may be left of the
    initial error; the answer suits all cases.
    """
    decay = zeta - np.sqrt(np.maximum(zeta**2 - 1.0, 0.0))
    missing = np.log(1.0 / tolerance) / np.maximum(decay, np.finfo(float).eps)
    segments = duration.shape[1]
    for back in range(1, MOST_PERIODS * segments):
        last = duration[:, -back % segments]
        if np.all(missing <= last):
            return back, float(np.min(1.0 - missing / np.maximum(last, np.finfo(float).tiny)))
        missing = missing - last
    raise RuntimeError("the damping is too low to reach a steady state by integration")


def _least(steps: Array, values: Array, slopes: Array) -> Array:
    """Least value of the cubic Hermite interpolant along the last axis."""
    start, rise = values[..., :-1], np.diff(values, axis=-1)
    first, last = slopes[..., :-1] * steps, slopes[..., 1:] * steps
    square, cube = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
    root = np.sqrt(np.maximum(square**2 - 3.0 * cube * first, 0.0))
    # The trough is the root of the slope where it rises, in the form that does not cancel.
    above, below = np.where(square < 0.0, (root - square, 3.0 * cube), (-first, root + square))
    at = np.clip(above / np.where(below == 0.0, np.inf, below), 0.0, 1.0)
    inside = start + at * (first + at * (square + at * cube))
    return np.asarray(np.minimum(np.min(values, axis=-1), np.min(inside, axis=-1)))


def _largest(steps: Array, values: Array, slopes: Array) -> Array:
    return -_least(steps, -values, -slopes)


def _summary(paths: list[Path]) -> tuple[Array, Array, Array]:
    """Mean, peak to peak and largest k x of one period, in scaled units."""
    area, total, least, largest, force = np.zeros(()), np.zeros(()), [], [], []
    for path in paths:
        steps = np.diff(path.times, axis=-1)
        x, v, k = path.deflection, path.velocity, path.stiffness
        pairs = x[..., 1:] + x[..., :-1] - steps / 6.0 * np.diff(v, axis=-1)
        area = area + 0.5 * np.sum(steps * pairs, axis=-1)
        total = total + np.sum(steps, axis=-1)
        least.append(_least(steps, x, v))
        largest.append(_largest(steps, x, v))
        force.append(_largest(steps, k * x, path.slope * x + k * v))
    return area / total, np.max(largest, axis=0) - np.min(least, axis=0), np.max(force, axis=0)


Crossed = tuple[Array, Path]


def _integrated(
    slope: Any, span: tuple[float, float], state: Array, tolerance: float, **options: Any
) -> Any:
    """Solution with the solver's own steps; RuntimeError where it gives up."""
    accuracy = {"rtol": tolerance, "atol": tolerance}
    found = solve_ivp(slope, span, state, method="LSODA", **accuracy, **options)
    if not found.success:
        raise RuntimeError(found.message)
    return found


class _One:
    """Segments of one case."""

    def __init__(self, scaled: Scaled, case: int) -> None:
        self.arrays, self.duration = scaled.table[case], scaled.duration[case].tolist()
        self.rises = np.diff(self.arrays, axis=1, append=self.arrays[:, -1:])
        self.table, self.rise = self.arrays.tolist(), self.rises.tolist()
        self.drag = 2.0 * float(scaled.zeta[case])

    def static(self, segment: int, start: float) -> Array:
        level = np.interp(start * TABLE, np.arange(TABLE + 1), self.arrays[segment])
        return np.array([1.0 / level, 0.0])

    def __call__(self, segment: int, start: float, state: Array, tolerance: float) -> Crossed:
        table, rise, drag = self.table[segment], self.rise[segment], self.drag
        duration = self.duration[segment]
        rate = TABLE / duration

        def slope(at: float, y: Array) -> tuple[float, float]:
            x, v = y.tolist()
            place = at * rate
            index = int(place)
            return v, 1.0 - drag * v - (table[index] + (place - index) * rise[index]) * x

        def jacobian(at: float, y: Array) -> list[list[float]]:
            index = int(at * rate)
            return [[0.0, 1.0], [-table[index], -drag]]

        span = start * duration, duration
        found = _integrated(slope, span, state, tolerance, jac=jacobian)
        place = found.t * rate
        index = np.minimum(place.astype(np.intp), TABLE)
        rises = self.rises[segment][np.minimum(index, TABLE - 1)]
        stiffness = self.arrays[segment][index] + (place - index) * self.rises[segment][index]
        x, v = found.y
        return found.y[:, -1], Path(found.t, x, v, stiffness, rises * rate)


class _Together:
    """Segments of all cases of a block; states alternate x and v, so the Jacobian has a band."""

    def __init__(self, scaled: Scaled) -> None:
        self.table = np.ascontiguousarray(np.moveaxis(scaled.table, 0, -1))
        self.rise = np.diff(self.table, axis=1, append=self.table[:, -1:])
        self.duration, self.drag = scaled.duration.T, 2.0 * scaled.zeta

    def static(self, segment: int, start: float) -> Array:
        level = self.table[segment, int(start * TABLE)]
        return np.column_stack((1.0 / level, np.zeros_like(level))).ravel()

    def __call__(self, segment: int, start: float, state: Array, tolerance: float) -> Crossed:
        table, rise, drag = self.table[segment], self.rise[segment], self.drag
        duration = self.duration[segment]
        band = np.zeros((3, state.size))
        band[0, 1::2], band[1, 1::2] = duration, -duration * drag

        def slope(at: float, y: Array) -> Array:
            place = at * TABLE
            index = int(place)
            x, v, out = y[0::2], y[1::2], np.empty_like(y)
            np.multiply(duration, v, out=out[0::2])
            pull = (place - index) * rise[index]
            pull += table[index]
            pull *= x
            pull += drag * v
            np.subtract(1.0, pull, out=pull)
            np.multiply(duration, pull, out=out[1::2])
            return out

        def jacobian(at: float, y: Array) -> Array:
            packed = band.copy()
            packed[2, 0::2] = -duration * table[int(at * TABLE)]
            return packed

        span = start, 1.0
        found = _integrated(slope, span, state, tolerance, jac=jacobian, lband=1, uband=1)
        place = found.t * TABLE
        index = np.minimum(place.astype(np.intp), TABLE)
        stiffness = (table[index] + (place - index)[:, None] * rise[index]).T
        rises = rise[np.minimum(index, TABLE - 1)].T
        x, v = found.y[0::2], found.y[1::2]
        lasting = np.maximum(duration, np.finfo(float).tiny)[:, None]
        path = Path(found.t * duration[:, None], x, v, stiffness, rises * TABLE / lasting)
        return found.y[:, -1], path


Segments = _One | _Together


def _run(cross: Segments, duration: Array, zeta: Array, tolerance: float) -> tuple[Array, ...]:
    """Mean, peak to peak, largest force and change over the period, in scaled units."""
    lasting = np.flatnonzero(np.any(duration > 0.0, axis=0)).tolist()
    back, start = _release(duration[:, lasting], zeta, tolerance)
    ahead = [lasting[-(step % len(lasting)) - 1] for step in range(back)][::-1]
    state = cross.static(ahead[0], start)
    for segment in ahead:
        state, _ = cross(segment, start, state, tolerance)
        start = 0.0
    for _ in range(MOST_PERIODS):
        before, paths = state, []
        for segment in lasting:
            state, path = cross(segment, 0.0, state, tolerance)
            paths.append(path)
        change = np.max(np.abs(state - before).reshape(-1, 2), axis=1)
        if np.all(change < CLOSED * tolerance):
            return *_summary(paths), change
    raise RuntimeError("no steady state: the parametric excitation feeds the motion")


def steady(cases: Cases, tolerance: float = TOLERANCE) -> Steady:
    """Solve the cases one after the other.

    Arguments:
        cases: excitation, (cases,) each
        tolerance: relative and absolute tolerance of the solver, in units of F/k_mean [1]

    Returns the steady state, fields (cases,). Raises RuntimeError where none is reached.
    """
    scaled = _scaled(cases)
    rows = []
    for case in range(scaled.zeta.size):
        one = slice(case, case + 1)
        found = _run(_One(scaled, case), scaled.duration[one], scaled.zeta[one], tolerance)
        rows.append([float(np.squeeze(value)) for value in found])
    return _unscaled(np.array(rows).T, scaled.length)


def steady_together(cases: Cases, tolerance: float = TOLERANCE, block: int = BLOCK_CASES) -> Steady:
    """Solve blocks of cases as one system each; arguments, returns and errors as `steady`."""
    scaled = _scaled(cases)
    parts = []
    for first in range(0, scaled.zeta.size, block):
        part = Scaled(*(field[first : first + block] for field in scaled))
        parts.append(_run(_Together(part), part.duration, part.zeta, tolerance))
    return _unscaled(np.concatenate(parts, axis=1), scaled.length)


def _unscaled(rows: Array, length: Array) -> Steady:
    mean, peak, force, change = rows
    return Steady(mean * length, peak * length, force, change)


def random_cases(count: int, seed: int = 0, nodes: int = 9) -> Cases:
    """Pairs like a small helical one of steel and plastic: four segments with jumps between them.

    Mass about 2.2e-3 kg, mean stiffness about 1.14e7 N/m with about 20 % from least to largest,
    damping ratio 0.16, 100..141 N, mesh frequency 120 Hz.
    """
    rng = np.random.default_rng(seed)
    shifts = rng.uniform(-0.05, 0.05, (count, 3))
    inner = np.array([0.05, 0.4, 0.62]) + shifts * np.array([0.8, 1.0, 1.0])
    edges = np.column_stack((np.zeros(count), inner, np.ones(count)))
    width = np.diff(edges, axis=1)[..., None]
    phase = edges[:, :-1, None] + 0.5 * width * (1.0 + lobatto_nodes(nodes))
    level = np.array([1.0, -0.3, 0.6, -1.0]) + rng.uniform(-0.2, 0.2, (count, 4))
    wave = 0.4 * np.cos(2.0 * np.pi * (phase + rng.uniform(size=(count, 1, 1))))
    shape = level[..., None] + wave
    shape -= np.sum(np.mean(shape, axis=2, keepdims=True) * width, axis=1, keepdims=True)
    spread = np.ptp(shape, axis=(1, 2), keepdims=True) / rng.uniform(0.16, 0.24, (count, 1, 1))
    mean = 1.14e7 * rng.uniform(0.85, 1.15, count)
    stiffness = mean[:, None, None] * (1.0 + shape / spread)
    mass = 2.2e-3 * rng.uniform(0.8, 1.25, count)
    damping = 2.0 * 0.16 * np.sqrt(mass * mean)
    force = rng.uniform(100.0, 141.0, count)
    return Cases(edges, stiffness, mass, damping, force, np.full(count, 1.0 / 120.0))


def read_cases(name: str) -> Cases:
    """Cases of an .npz file in the format of the module; ValueError for edges that do not fit."""
    with np.load(name) as data:
        cases = Cases(*(np.asarray(data[field], float) for field in Cases._fields))
    steps = np.diff(cases.edges, axis=1)
    if np.any(steps < 0.0) or np.any(np.abs(np.sum(steps, axis=1) - 1.0) > 1e-9):
        raise ValueError("edges must ascend and span one period")
    return cases


def _deviations(found: Steady, expected: Steady) -> dict[str, float]:
    pairs = zip(Steady._fields[:3], found, expected, strict=False)
    return {name: float(np.max(np.abs(own / other - 1.0))) for name, own, other in pairs}


def _timed(solve: Callable[[], Steady], repeats: int) -> tuple[float, Steady]:
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        found = solve()
        times.append(time.perf_counter() - begin)
    return min(times), found


def _reports(cases: Cases, checked: int, repeats: int) -> Iterator[tuple[dict[str, Any], Steady]]:
    few = Cases(*(field[:checked] for field in cases))
    tight = steady(few, TIGHT)
    for name, solve in (("loop", steady), ("together", steady_together)):
        seconds, found = _timed(partial(solve, cases), repeats)
        deviation = _deviations(Steady(*(field[:checked] for field in found)), tight)
        yield (
            {
                "rival": name,
                "seconds_per_case": seconds / cases.mass.size,
                "largest_deviation_from_tight_run": deviation,
                "largest_change_over_period": float(np.max(found.change)),
            },
            found,
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--checked", type=int, default=10, help="cases of the tighter run")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--input", help=".npz with the excitation, instead of random cases")
    parser.add_argument("--save", help=".npz for the cases and the loop's results")
    asked = parser.parse_args()
    cases = read_cases(asked.input) if asked.input else random_cases(asked.cases)
    reports = list(_reports(cases, asked.checked, asked.repeats))
    print(json.dumps({"cases": cases.mass.size, "runs": [report for report, _ in reports]}))
    if asked.save:
        np.savez(asked.save, **cases._asdict(), **reports[0][1]._asdict())


if __name__ == "__main__":
    main()
