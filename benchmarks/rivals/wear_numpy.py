"""Plain NumPy rival for the wear benchmark: the march of one spur pair after the other.

Dry wear by Archard's law of a spur pair whose load is shared by stiffness. A rate is one turn of
the driver on flanks that have lost so much already: gaps from cubic B-splines over the cells of
both flanks, forces of pairs that only push, Hertz's half-width with the curvature averaged over it,
force times sliding laid on the cells that each contact passes. The march is that of Bogacki and
Shampine as SciPy has it, with steps as long as their error allows. What makes it fast:

- everything that flanks as new decide is computed once for a pair: places, speeds, springs, and the
  splines as matrices from cells to contacts;
- half-widths of the last rate are those with which the search of the next begins;
- a rate is arrays over all contacts of a turn;
- all states of one step are remembered, so that none is rated twice.

It loops over steps and over pairs.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import RK23

Array = NDArray[np.float64]

FIRST = 1e-9
"""Depth that the first step takes off [m]."""

BRIDGED = 2.0
"""Cells to either side over which curvatures are averaged at least."""

REACH = np.sqrt(1.25)
"""Half-width of the parabola over that of the contact of the same variance."""

SETTLED = 1e-10
"""Part of the load that half-widths may lack."""

SHORT = 1e-3
"""Ways below this part of a cell count as that long."""


class Pair(NamedTuple):
    """A spur pair as new, and how it wears. Contacts are those of two pairs of teeth at every phase.

    Attributes:
        weight: part of a base pitch that each phase stands for, shape (phase,).
        active: shape (2, phase).
        flank: arc length on both members' flanks, shape (member, 2, phase) [m].
        speed: of both surfaces at one radian per second of the driver, shape (member, 2, phase) [m].
        curvature: relative, shape (2, phase) [1/m].
        springs: compliance of each pair of teeth, shape (2, phase) [m/N].
        width: of the face [m].
        force: along the line of action [N].
        modulus: E' [Pa].
        teeth: of both members.
        rate: specific wear rate of both members [1/Pa].
        ends: of both members' cells along the flank, shape (member, 2) [m].
        cells: along each flank.
    """

    weight: Array
    active: NDArray[np.bool_]
    flank: Array
    speed: Array
    curvature: Array
    springs: Array
    width: float
    force: float
    modulus: float
    teeth: tuple[int, int]
    rate: tuple[float, float]
    ends: Array
    cells: int


class Course(NamedTuple):
    """Worn flanks at the end, and how many rates and steps they took."""

    turns: float
    depth: Array
    rates: int
    steps: int


def spline(place: Array, ends: Array, cells: int, *, straight: bool) -> Array:
    """Matrix from depths of cells to depths at places; beyond the last cells as there, or straight on."""
    anywhere = (place.ravel() - ends[0]) * cells / (ends[1] - ends[0]) - 0.5
    at = np.clip(anywhere, 0.0, cells - 1.0)
    first = np.clip(np.floor(at), 0, cells - 2).astype(int)
    t, rows = at - first, np.arange(place.size)
    weights = ((1 - t) ** 3, 4 - 6 * t**2 + 3 * t**3, 1 + 3 * t + 3 * t**2 - 3 * t**3, t**3)
    found = np.zeros((place.size, cells + 2))
    for offset, one in enumerate(weights):
        found[rows, first + offset] = one / 6
    # Cells beyond an end go straight on from the last two.
    for beyond, last, before in ((0, 1, 2), (-1, -2, -3)):
        found[:, last] += 2.0 * found[:, beyond]
        found[:, before] -= found[:, beyond]
    found = found[:, 1:-1]
    if straight:
        far = anywhere - at
        found[rows, first] -= far
        found[rows, first + 1] += far
    return found


def pieces(depth: Array) -> Array:
    """The spline through the cells: area since the first middle, depth, its three derivatives, in cells.

    One row for each stretch between middles, and for what is straight on before and behind them.
    """
    bend = np.pad(np.diff(depth, n=2), 1)
    third = np.pad(np.diff(bend), 1)
    rows = np.empty((5, depth.size + 1))
    for row, values in zip(rows[1:4], (depth + bend / 6.0, np.gradient(depth), bend), strict=True):
        row[0], row[1:] = values[0], values
    rows[4] = third
    _, height, slope, bend, third = rows
    inner = (height + slope / 2.0 + bend / 6.0 + third / 24.0)[1:-1]
    rows[0] = np.concatenate([[0.0, 0.0], np.cumsum(inner)])
    return rows


def mean_bend(rows: Array, middle: Array, reach: Array) -> tuple[Array, Array]:
    """Second derivative averaged by the parabola that far to either side, and its slope over that reach."""
    ends = np.stack([middle - reach, middle + reach])
    piece = np.clip(np.floor(ends) + 1.0, 0, rows.shape[1] - 1).astype(int)
    t = ends - np.maximum(piece - 1, 0)
    area, depth, slope, bend, third = rows[:, piece]
    height = depth + t * (slope + t * (bend / 2.0 + t * third / 6.0))
    tilt = slope + t * (bend + t * third / 2.0)
    below = area + t * (depth + t * (slope / 2.0 + t * (bend / 6.0 + t * third / 24.0)))
    both, mean = height[0] + height[1], (below[1] - below[0]) / reach
    apart = both - mean
    rise = tilt[1] - tilt[0] - (both - mean) / reach
    return 1.5 * apart / reach**2, 1.5 * (rise - 2.0 * apart / reach) / reach**2


class Rater:
    """What a turn does to the flanks of one pair."""

    def __init__(self, pair: Pair) -> None:
        self.pair, self.count = pair, 0
        flanks = zip(pair.flank, pair.ends, strict=True)
        both = [spline(place, ends, pair.cells, straight=False) for place, ends in flanks]
        self.height = np.concatenate(both, axis=1)
        self.slide = np.abs(pair.speed[0] - pair.speed[1])
        period = 2.0 * np.pi / pair.teeth[0]
        self.lasts = pair.weight * period
        self.ways = np.abs(pair.speed) * self.lasts
        self.length = (pair.ends[:, 1] - pair.ends[:, 0]) / pair.cells
        begin, cell = pair.ends[:, 0, None, None], self.length[:, None, None]
        self.middle = (pair.flank - begin) / cell - 0.5
        self.half: Array | None = None
        self.edges = [
            one[0] + (one[1] - one[0]) * np.arange(1, pair.cells) / pair.cells for one in pair.ends
        ]

    def forces(self, gap: Array) -> Array:
        """Forces of two springs that only push and share a force."""
        pair = self.pair
        gap = np.where(pair.active, gap, np.inf)
        early = np.minimum(gap[0], gap[1])
        behind = gap - early
        first = behind <= 0.0
        alone = np.where(first, pair.force, 0.0)
        yielded = np.sum(np.where(first, pair.springs, 0.0), axis=0) * pair.force
        far = np.max(behind, axis=0)
        shared = (np.isfinite(far) & (yielded > far)) | np.all(first, axis=0)
        stiff = 1.0 / pair.springs
        gaps = np.where(shared, behind, 0.0)
        approach = (pair.force + np.sum(stiff * gaps, axis=0)) / np.sum(stiff, axis=0)
        return np.where(shared, stiff * (approach - gaps), alone)

    def half_widths(self, force: Array, depth: Array) -> Array:
        """Half-widths that have their loads with the curvature averaged over themselves, by Newton."""
        pair = self.pair
        rows = [pieces(one) for one in depth.reshape(2, -1)]
        loaded = force > 0.0
        target = np.where(loaded, 8.0 * force / pair.width / (np.pi * pair.modulus), 1e-12)
        half = np.sqrt(target / pair.curvature) if self.half is None else self.half
        for _ in range(30):
            curvature, rise = pair.curvature, np.zeros_like(half)
            for k in range(2):
                cells = half / self.length[k]
                reach = REACH * np.maximum(cells, BRIDGED)
                bend, slope = mean_bend(rows[k], self.middle[k], reach)
                curvature = curvature + bend / self.length[k] ** 2
                rise = rise + np.where(cells > BRIDGED, slope * reach, 0.0) / self.length[k] ** 2
            lack = half**2 * curvature - target
            if np.all(np.abs(lack) < SETTLED * target):
                break
            half = np.sqrt(np.maximum(half**2 - lack / (curvature + rise / 2.0), 0.25 * half**2))
        else:
            raise RuntimeError("no half-widths were found")
        self.half = half
        return np.where(loaded, half, 0.0)

    def __call__(self, depth: Array) -> Array:
        """Depth that a turn wears off every cell of both members [m]."""
        self.count += 1
        pair, cells = self.pair, self.pair.cells
        shape = pair.curvature.shape
        force = self.forces((self.height @ depth).reshape(shape))
        half = self.half_widths(force, depth)
        slid = force * self.slide * self.lasts
        found = np.empty((2, cells))
        for k in range(2):
            way, covers = self.ways[k], 2.0 * half
            moves = way / pair.weight
            spread = way + covers * covers**2 / (covers**2 + moves**2)
            spread = np.maximum(spread, SHORT * self.length[k]).ravel()
            passed = (self.edges[k] - pair.flank[k].ravel()[:, None]) / spread[:, None] + 0.5
            np.clip(passed, 0.0, 1.0, out=passed)
            before = slid.ravel() @ passed
            laid = np.diff(before, prepend=0.0, append=slid.sum())
            turns = pair.teeth[0] / pair.teeth[k]
            found[k] = pair.rate[k] * turns * laid / (self.length[k] * pair.width)
        return found.ravel()


def march(pair: Pair, *, turns: float, tolerance: float) -> Course:
    """Flanks of one pair after so many turns of the driver."""
    rate = Rater(pair)
    depth, at, steps = np.zeros(2 * pair.cells), 0.0, 0
    new = rate(depth)
    seen = {depth.tobytes(): new}

    def known(_: float, depth: Array) -> Array:
        key = depth.tobytes()
        if key not in seen:
            seen[key] = rate(depth)
        return seen[key]

    step = FIRST / float(new.max())
    while at < turns:
        deepest = max(float(depth.max()), FIRST)
        solver = RK23(
            known,
            at,
            depth,
            turns,
            first_step=min(step, turns - at),
            rtol=tolerance,
            atol=tolerance * deepest,
        )
        solver.step()
        if solver.status == "failed":
            raise RuntimeError("no step was found")
        seen = {solver.y.tobytes(): known(solver.t, solver.y)}
        depth, at, step, steps = solver.y, solver.t, solver.h_abs, steps + 1
    return Course(at, depth.reshape(2, pair.cells), rate.count, steps)


def march_all(pairs: Iterable[Pair], *, turns: float, tolerance: float) -> list[Course]:
    """One after the other."""
    return [march(pair, turns=turns, tolerance=tolerance) for pair in pairs]
