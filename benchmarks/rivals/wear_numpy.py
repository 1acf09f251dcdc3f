"""Plain NumPy rival for the wear benchmark: the march of one spur pair after the other.

Dry wear by Archard's law of a spur pair whose load is shared by stiffness. A rate is one turn of the
driver on flanks that have lost so much already: gaps and curvatures from cubic B-splines over the
cells of both flanks, forces of pairs that only push, Hertz's half-width, force times sliding laid on
the cells that each contact passes. The march is that of Bogacki and Shampine as SciPy has it, with
steps as long as their error allows. What makes it fast:

- everything that flanks as new decide is computed once for a pair: places, speeds, springs, and the
  splines as matrices from cells to contacts;
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

FLATTEST = 0.1
"""Part of their relative curvature as new that contacts keep at least."""

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
        span: half-width of the contacts over which a worn flank's curvature counts [m].
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
    span: float
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


def splines(place: Array, ends: Array, cells: int, span: float) -> tuple[Array, Array]:
    """Matrices from depths of cells to depth at places, and to its second difference over a span."""
    beside = sum(spline(place + by, ends, cells, straight=True) for by in (-span, span))
    here = spline(place, ends, cells, straight=True)
    return spline(place, ends, cells, straight=False), (beside - 2.0 * here) / span**2


class Rater:
    """What a turn does to the flanks of one pair."""

    def __init__(self, pair: Pair) -> None:
        self.pair, self.count = pair, 0
        both = [splines(pair.flank[k], pair.ends[k], pair.cells, pair.span) for k in range(2)]
        self.height = np.concatenate([one for one, _ in both], axis=1)
        self.bend = np.concatenate([one for _, one in both], axis=1)
        self.least = FLATTEST * pair.curvature
        self.slide = np.abs(pair.speed[0] - pair.speed[1])
        period = 2.0 * np.pi / pair.teeth[0]
        self.lasts = pair.weight * period
        self.ways = np.abs(pair.speed) * self.lasts
        self.length = (pair.ends[:, 1] - pair.ends[:, 0]) / pair.cells
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

    def __call__(self, depth: Array) -> Array:
        """Depth that a turn wears off every cell of both members [m]."""
        self.count += 1
        pair, cells = self.pair, self.pair.cells
        shape = pair.curvature.shape
        force = self.forces((self.height @ depth).reshape(shape))
        curvature = np.maximum(pair.curvature + (self.bend @ depth).reshape(shape), self.least)
        half = np.sqrt(8.0 * force / pair.width / curvature / (np.pi * pair.modulus))
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
