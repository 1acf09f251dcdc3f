"""Friction of solved films over load, speed and temperature, from few operating points.

At each place of the mesh cycle the coefficient is a polynomial in the logarithms of load and speed and in the
temperature, through its values at Chebyshev's points.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from itertools import product

import numpy as np
from jaxtyping import Float
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from pitchpoint._jax import array
from pitchpoint.efficiency.in_turns import first_turn
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation

__all__ = ["LEVELS", "FilmMap", "film_map"]

Values = NDArray[np.float64]

LEVELS = (4, 4, 3)
"""Loads, speeds and temperatures at which films are solved, at most."""


@dataclass(frozen=True)
class FilmMap:
    """Friction coefficients of solved films at a grid of operating points.

    Attributes:
        axes: logarithms of load and speed, and temperature [K], at which films were solved.
        friction: coefficients there [load, speed, temperature, pair, slice, node].
        rolling: rolling resistance on each surface there [N/m]; None where the case has a model of its own.

    From polynomials through Chebyshev's points.
    """

    axes: tuple[Values, Values, Values]
    friction: Float[np.ndarray, "load speed temperature pair slice node"]
    rolling: Float[np.ndarray, "load speed temperature pair slice node"] | None = None

    def at(self, load: float, speeds: Values, degrees: Values) -> tuple[Values, ...]:
        """Friction [pair, slice, speed, temperature, node] between the points, or at the nearest end.

        Args:
            load: that the loaded coordinate carries [N m or N].
            speeds: of the driver [rad/s].
            degrees: temperatures of the oil [K].

        Returns:
            Coefficients, and rolling resistances [N/m] where they are known.
        """
        every = self.friction, self.rolling
        return tuple(
            self._between(field, load, speeds, degrees) for field in every if field is not None
        )

    def _between(self, values: Values, load: float, speeds: Values, degrees: Values) -> Values:
        places = _log(np.array([load])), _log(speeds), degrees
        weights = map(_weights, self.axes, places)
        blended = reduce(lambda some, weight: np.tensordot(some, weight, (0, 0)), weights, values)
        # Each product has moved an axis to the end: pair, slice, node, load, speed, temperature.
        held: Values = np.maximum(np.moveaxis(blended[:, :, :, 0], 2, -1), 0.0)
        return held

    @property
    def between(self) -> list[tuple[float, float, float]]:
        """Load, speed and temperature of points half way between those at the ends and their neighbours."""
        load, speed, degrees = (0.5 * (levels[1:] + levels[:-1]) for levels in self._two_or_more)
        ends = product(load[[0, -1]], speed[[0, -1]], degrees[[len(degrees) // 2]])
        return list(
            dict.fromkeys((float(np.exp(w)), float(np.exp(v)), float(t)) for w, v, t in ends)
        )

    @property
    def _two_or_more(self) -> tuple[Values, ...]:
        return tuple(levels if levels.size > 1 else np.repeat(levels, 2) for levels in self.axes)


def film_map(
    design: Design,
    models: Models,
    loads: Values,
    speeds: Values,
    degrees: Values,
    known: Callable[[float], Engagement],
) -> FilmMap:
    """Friction of solved films at few points of a map.

    The films are those under the forces of a small friction, which the coefficients hardly depend on.

    Args:
        design: mesh, materials, oil, surfaces.
        models: laws; the one that acts has `films`.
        loads: of the map [N m or N]; none counts as the least of the others.
        speeds: of the map [rad/s]; standstill counts as the slowest of the others.
        degrees: temperatures of the map [K].
        known: contacts and shares by load, whose nodes are those of the map.

    Raises:
        ConvergenceError: a film was not solved.

    From polynomials through Chebyshev's points.
    """
    ends = _log(loads[loads > 0.0]), _log(speeds[speeds > 0.0]), degrees
    axes = tuple(_levels(values, most) for values, most in zip(ends, LEVELS, strict=True))
    frictions = []
    for load, speed, degree in product(*axes):
        point = Operation(array(np.exp(load)), array(np.exp(speed)), array(degree))
        frictions.append(first_turn(design, point, models, known(float(np.exp(load)))))
    shape = tuple(levels.size for levels in axes)
    load_axis, speed_axis, degree_axis = axes
    by_point = np.stack(frictions, axis=1)
    on_axes = by_point.reshape(by_point.shape[0], *shape, *by_point.shape[2:])
    return FilmMap((load_axis, speed_axis, degree_axis), *on_axes)


def _log(values: Values) -> Values:
    """Logarithms; of nothing that of the smallest number there is, which counts as the nearest end."""
    return np.log(np.maximum(values, np.finfo(float).tiny))


def _levels(values: Values, most: int) -> Values:
    """The values themselves where they are few, else Chebyshev's points from end to end."""
    every = np.unique(values)
    if every.size <= most:
        return every
    low, high = every[[0, -1]]
    turned = np.cos(np.pi * np.arange(most) / (most - 1))
    levels: Values = 0.5 * (low + high) - 0.5 * (high - low) * turned
    return levels


def _weights(levels: Values, places: Values) -> Values:
    """Part of the value at each level in that at each place [level, place]."""
    middle, half = 0.5 * (levels[-1] + levels[0]), 0.5 * (levels[-1] - levels[0]) or 1.0
    degree = levels.size - 1
    there = chebvander(np.clip((places - middle) / half, -1.0, 1.0), degree)
    weights: Values = np.linalg.solve(chebvander((levels - middle) / half, degree).T, there.T)
    return weights
