"""The least value of an aim under constraints over designs of which some are refused: a search in shares."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

__all__ = ["AT_LIMIT", "ConstrainedSearch", "Multipliers", "even_shares", "multipliers_of"]

EXACT = 1e-6
"""Largest part of its bound by which an equality may be missed, and by which inequalities are kept inside."""

AT_LIMIT = 1e-4
"""Part of its bound, or of the range of a key, within which a constraint or an end of the range is active."""

STEP = 3e-4
"""Step of differences, as a share of the range of a key."""

APART = 0.15
"""Share of a range by which starting points that are improved differ in one key at least."""

ITERATIONS, ACCURACY = 40, 1e-9
"""Most iterations of SLSQP, and the change of the aim over its spread at which they end."""

RADIUS, LEAST_RADIUS, ROUNDS = 0.02, 1e-4, 60
"""First and last distance at which designs around the best one are tried, and how often at most."""

QUICKLY, SLOWLY = 8.0, 1.5
"""By what the distance is divided where none is better: slowly beside designs that are refused."""

Shares = Float[np.ndarray, "design key"]
Columns = Float[np.ndarray, "design column"]


def even_shares(count: int, keys: int) -> Shares:
    """Points that fill the unit cube evenly, always the same: Halton's sequence.

    Args:
        count, keys: numbers of points and of dimensions.

    Example:
        >>> even_shares(3, 1).ravel().tolist()
        [0.5, 0.25, 0.75]
    """
    from scipy.stats import qmc

    return np.asarray(qmc.Halton(keys, scramble=False).random(count + 1)[1:])


@dataclass(frozen=True)
class Multipliers:
    """What limits cost at a point.

    Attributes:
        constraints: change of the aim when a constraint is tightened by its whole bound.
        ends: change of the aim when an end of the range of a key moves inwards by the whole range.
        unbalanced: size of the part of the gradient of the aim that no limit holds, near zero at a smooth
            optimum.
    """

    constraints: Float[np.ndarray, " constraint"]
    ends: Float[np.ndarray, " key"]
    unbalanced: float


@dataclass(eq=False)
class ConstrainedSearch:
    """A search among designs whose keys are shares of their ranges.

    Attributes:
        evaluate: of designs the aim, less is better, and by what part of its bound each constraint is kept,
            negative where it is not; not numbers of a design that is refused.
        derive: derivatives of both by the shares at a design; where it has none, differences stand.
        equal: which constraints are equalities.
        shares, columns: of all designs that were evaluated.
    """

    evaluate: Callable[[Shares], Columns]
    derive: Callable[[Float[np.ndarray, " key"]], Float[np.ndarray, "column key"]]
    equal: Bool[np.ndarray, " constraint"]
    shares: list[np.ndarray] = field(default_factory=list)
    columns: list[np.ndarray] = field(default_factory=list)

    def at(self, shares: Shares) -> Columns:
        """Aim and constraints of designs, which are kept."""
        columns = self.evaluate(shares)
        self.shares += [*shares]
        self.columns += [*columns]
        return columns

    def missed(self, columns: Columns) -> Float[np.ndarray, "design constraint"]:
        """By what part of its bound each design misses each constraint; zero where it is kept."""
        kept = columns[:, 1:]
        off = np.where(self.equal, np.abs(kept), np.maximum(-kept, 0.0))
        return np.where(self.equal & (off <= EXACT), 0.0, off)

    def order(self, columns: Columns) -> np.ndarray:
        """Designs from the best one on: those that keep all constraints first, refused ones last."""
        worst = self.missed(columns).max(axis=1, initial=0.0)
        return np.lexsort((columns[:, 0], worst))  # not a number comes last

    @property
    def best(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Shares and columns of the best design so far; None where all were refused."""
        if not self.columns:
            return None
        number = self.order(np.array(self.columns))[0]
        found = self.columns[number]
        return None if np.isnan(found).any() else (self.shares[number], found)

    @property
    def spread(self) -> float:
        """Largest less least aim of all designs so far, at least one of which has figures."""
        aims = np.array(self.columns)[:, 0]
        return float(np.nanmax(aims) - np.nanmin(aims)) or abs(float(np.nanmax(aims))) or 1.0

    def starts(self, shares: Shares, count: int) -> list[np.ndarray]:
        """The best of some points that differ from each other."""
        columns = self.at(shares)
        chosen: list[np.ndarray] = []
        for number in self.order(columns):
            point = shares[number]
            apart = all(np.abs(point - other).max() > APART for other in chosen)
            if len(chosen) < count and apart and not np.isnan(columns[number]).any():
                chosen.append(point)
        return chosen

    def slopes(self, point: Float[np.ndarray, " key"]) -> Float[np.ndarray, "column key"]:
        """Derivatives by the shares; differences within the ranges where `derive` has none."""
        derived = self.derive(point)
        lacking = np.isnan(derived).any(axis=1)
        if not lacking.any():
            return derived
        steps = np.array([_steps(share) for share in point])
        around = np.repeat(point[None], 2 * len(point), axis=0)
        for key, pair in enumerate(steps):
            around[2 * key : 2 * key + 2, key] += pair
        columns = self.at(np.vstack([point[None], around]))
        here, beside = columns[0], columns[1:].reshape(len(point), 2, -1)
        slopes = np.stack([_slope(here, *of) for of in zip(steps, beside, strict=True)], axis=1)
        derived[lacking] = slopes[lacking]
        return derived

    def improve(self, start: Float[np.ndarray, " key"]) -> None:
        """Go from a point to where no direction lessens the aim, by SLSQP; designs on the way are kept."""
        from scipy.optimize import minimize

        known: dict[bytes, np.ndarray] = {}
        spread = self.spread
        worst = np.nanmax(np.array(self.columns)[:, 0])
        refused = np.concatenate([[worst + spread], np.full(len(self.equal), -1.0)])
        inside = np.where(self.equal, 0.0, EXACT)

        def columns_at(point: np.ndarray) -> np.ndarray:
            found = known.get(point.tobytes())
            if found is None:
                inner = np.clip(point, 0.0, 1.0)
                (row,) = self.at(inner[None])
                found = known[point.tobytes()] = refused if np.isnan(row).any() else row
            return found

        derived: dict[bytes, np.ndarray] = {}

        def slopes_at(point: np.ndarray) -> np.ndarray:
            if point.tobytes() not in derived:
                derived[point.tobytes()] = np.nan_to_num(self.slopes(np.clip(point, 0.0, 1.0)))
            return derived[point.tobytes()]

        def constraint(rows: np.ndarray, kind: str) -> dict[str, Any]:
            return {
                "type": kind,
                "fun": lambda point: columns_at(point)[1:][rows] - inside[rows],
                "jac": lambda point: slopes_at(point)[1:][rows],
            }

        both = ((self.equal, "eq"), (~self.equal, "ineq"))
        minimize(
            lambda point: columns_at(point)[0] / spread,
            start,
            jac=lambda point: slopes_at(point)[0] / spread,
            bounds=[(0.0, 1.0)] * len(start),
            constraints=[constraint(rows, kind) for rows, kind in both if rows.any()],
            method="SLSQP",
            options={"maxiter": ITERATIONS, "ftol": ACCURACY},
        )

    def look_around(self) -> None:
        """Move to better designs around the best one until none is left, at smaller and smaller distances.

        It goes along designs that are refused, where no constraint says how far they are, and over kinks,
        and ends where it took three times the designs that there were before.
        """
        if self.best is None or self.equal.any():
            return
        point, found = self.best
        most = 4 * len(self.columns)
        radius, onward = RADIUS, np.zeros((0, len(point)))
        for directions in _directions(len(point)):
            around = np.clip(point + np.vstack([radius * directions, onward]), 0.0, 1.0)
            columns = np.vstack([found[None], self.at(around)])
            number = int(self.order(columns)[0])
            onward = onward[:0]
            if number:
                step = around[number - 1] - point
                point, found = around[number - 1], columns[number]
                onward = np.outer([1.0, 2.0, 4.0, 8.0], step)
                radius = max(radius, float(np.abs(step).max()) / 2.0)
            else:
                radius /= SLOWLY if np.isnan(columns).any() else QUICKLY
            if radius < LEAST_RADIUS or len(self.columns) > most:
                return


def _directions(keys: int) -> Iterator[Shares]:
    """Both ways along each key, and as many ways again between them, others in every round."""
    both = np.vstack([np.eye(keys), -np.eye(keys)])
    spread = 2.0 * even_shares(4 * keys * ROUNDS, keys) - 1.0
    between = spread / np.linalg.norm(spread, axis=1, keepdims=True).clip(1e-3)
    for further in between.reshape(ROUNDS, 4 * keys, keys):
        yield np.vstack([both, further] if keys > 1 else [both])


def _steps(share: float) -> tuple[float, float]:
    """Two steps of a key that stay in its range."""
    if share < STEP:
        return STEP, 2.0 * STEP
    return (-STEP, -2.0 * STEP) if share > 1.0 - STEP else (-STEP, STEP)


def _slope(here: np.ndarray, steps: Sequence[float], beside: np.ndarray) -> np.ndarray:
    """Derivative of the parabola through three points; a line where one of them is refused, else none."""
    first, second = steps
    by_first, by_second = ((row - here) / step for row, step in zip(beside, steps, strict=True))
    parabola: np.ndarray = (second * by_first - first * by_second) / (second - first)
    line = np.where(np.isnan(by_first), by_second, by_first)
    return np.asarray(np.where(np.isnan(parabola), line, parabola))


def multipliers_of(
    slopes: Float[np.ndarray, "column key"],
    columns: Float[np.ndarray, " column"],
    shares: Float[np.ndarray, " key"],
    equal: Bool[np.ndarray, " constraint"],
) -> Multipliers:
    """Multipliers of the limits that are active at a point, by least squares of what is not negative.

    Args:
        slopes: derivatives of aim and constraints.
        columns: aim and constraints.
        shares: of the point.
        equal: which constraints are equalities, whose multipliers have either sign.

    Example:
        >>> import numpy as np
        >>> aim, kept = np.array([2.0, 1.0]), np.array([1.0, 0.0])  # x1 is held, x2 at its least
        >>> found = multipliers_of(
        ...     np.array([aim, kept]), np.array([5.0, 0.0]), np.array([0.5, 0.0]), np.array([False])
        ... )
        >>> found.constraints.tolist(), found.ends.tolist(), found.unbalanced
        ([2.0], [0.0, 1.0], 0.0)
    """
    from scipy.optimize import nnls

    active = equal | (np.abs(columns[1:]) < AT_LIMIT)
    low, high = shares < AT_LIMIT, shares > 1.0 - AT_LIMIT
    ends = np.where(low, 1.0, np.where(high, -1.0, 0.0))
    normals = np.vstack([slopes[1:][active], -slopes[1:][equal], np.diag(ends)[ends != 0.0]])
    if not len(normals):
        return Multipliers(
            np.zeros(len(equal)), np.zeros(len(shares)), float(np.linalg.norm(slopes[0]))
        )
    weights, left = nnls(normals.T, slopes[0])
    count, both = int(active.sum()), int(equal.sum())
    constraints, of_ends = np.zeros(len(equal)), np.zeros(len(shares))
    constraints[active] = weights[:count]
    constraints[equal] -= weights[count : count + both]
    of_ends[ends != 0.0] = weights[count + both :]
    return Multipliers(constraints, of_ends, float(left))
