"""The grid of a steady period: elements that end at every hand-over, Lobatto nodes in each."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from jaxtyping import Array, Complex, Float, Int

from pitchpoint._jax import jnp
from pitchpoint.gears.period import lobatto, polynomial_matrices

__all__ = ["PeriodGrid"]

_DEGREE = 6
"""Degree of the polynomials between neighbouring nodes: exact to rounding for what nodes resolve."""

_PHASE_PER_ELEMENT = 20.0
"""Largest phase [rad] of a vibration within an element that 24 nodes represent to 1e-7."""

Values = Float[Array, "*b element node"]


@dataclass(frozen=True)
class PeriodGrid:
    """How finely a period is divided; static, so that each grid is compiled once.

    The grid points that divide the period evenly and the hand-overs together bound the elements:
    elements are as short as the vibration needs, and nothing jumps inside one.

    Attributes:
        elements: even divisions of the period, at least 1.
        nodes: Gauss-Lobatto nodes in each element, its ends among them, at least 12.

    Source: Abramowitz and Stegun (1964), eq. 25.4.32, Lobatto's formula.
    """

    elements: int = 8
    nodes: int = 24

    @classmethod
    def resolving(cls, frequency_ratio: float) -> "PeriodGrid":
        """Grid for a natural frequency of so many times the mesh frequency.

        Args:
            frequency_ratio: highest natural frequency over mesh frequency, not negative.

        Returns:
            Grid with 4, 6, 8, 12, 16... elements, so that few are ever compiled.

        Example:
            >>> from pitchpoint.dynamics.grid import PeriodGrid
            >>> PeriodGrid.resolving(90.0).elements
            32
        """
        needed = 2.0 * math.pi * max(frequency_ratio, 1.0) / _PHASE_PER_ELEMENT
        power = 2 ** max(2, math.ceil(math.log2(needed)))
        return cls(power * 3 // 4 if power > 4 and needed <= 0.75 * power else power)

    @property
    def stiffness_degree(self) -> int:
        """Degree that a stiffness needs between neighbouring nodes.

        Elements that are short for the sake of a fast vibration hold little of the mesh period. Not so
        for profile errors, which may vary as fast as the vibration.
        """
        return _DEGREE if self.elements < 16 else 4

    @property
    def place(self) -> np.ndarray:
        """Nodes of an element on [0, 1], ends included."""
        return _ends(lobatto(self.nodes)[0])

    @property
    def weight(self) -> np.ndarray:
        """Weights of the nodes of an element; they sum to one.

        Source: Abramowitz and Stegun (1964), eq. 25.4.32, Lobatto's formula.
        """
        return lobatto(self.nodes)[1]

    def bounds(self, edges: Float[Array, " edge"]) -> Float[Array, " bound"]:
        """Phases between the elements: hand-overs and even grid points, sorted."""
        even = edges[0] + jnp.arange(1, self.elements) / self.elements
        return jnp.sort(jnp.concatenate([edges, even]))

    def integral(self, values: Values) -> Float[Array, "*b element"]:
        """Integral over each element of unit length."""
        return values @ self.weight

    def derivative(self, values: Values) -> Values:
        """Derivative along each element of unit length, at its nodes.

        From the Legendre series through the nodes.
        """
        return values @ _derivative(self.nodes)

    def local(
        self, values: Values, degree: int = _DEGREE
    ) -> Float[Array, "power *b element interval"]:
        """Coefficients of polynomials between neighbouring nodes, on [-1, 1], lowest power first."""
        powers = values @ _local(self.nodes, degree)
        split = powers.reshape(*values.shape[:-1], degree + 1, self.nodes - 1)
        return jnp.moveaxis(split, -2, 0)

    def extremes(self, values: Values) -> tuple[Float[Array, "*b"], Float[Array, "*b"]]:
        """Smallest and largest value, between the nodes too; piecewise differentiable.

        From Taylor's series to the third order about the point beside the vertex.
        """
        dense = values @ polynomial_matrices(self.nodes)[0]
        flat = dense.reshape(*dense.shape[:-2], -1)
        low, high = (self._vertex(values, pick(flat, axis=-1)) for pick in (jnp.argmin, jnp.argmax))
        return jnp.minimum(low, jnp.min(flat, axis=-1)), jnp.maximum(high, jnp.max(flat, axis=-1))

    def _vertex(self, values: Values, where: Int[Array, "*b"]) -> Float[Array, "*b"]:
        """Value at the level point beside a point between the nodes, if there is one."""
        *matrices, spacing = (jnp.asarray(matrix) for matrix in polynomial_matrices(self.nodes))
        element, point = jnp.divmod(where, spacing.shape[0])
        row = jnp.take_along_axis(values, element[..., None, None], axis=-2)[..., 0, :]
        at, slope, curve, third = (
            jnp.sum(row * jnp.moveaxis(matrix[:, point], 0, -1), axis=-1) for matrix in matrices
        )
        level = jnp.abs(slope) < jnp.abs(curve) * spacing[point]
        step = -slope / jnp.where(level, curve, 1.0)
        return jnp.where(level, at + slope * step / 2.0 + third * step**3 / 6.0, at)

    def tail(self, values: Values) -> Float[Array, "*b"]:
        """Largest of the two highest Legendre coefficients: what the nodes hardly resolve."""
        return jnp.max(jnp.abs(values @ _modes(self.nodes)[:, -2:]), axis=(-2, -1))

    def fourier(
        self, values: Values, bounds: Float[Array, " bound"], orders: np.ndarray
    ) -> Complex[Array, "order *b"]:
        """Complex Fourier coefficients of the mean-value kind, for any order.

        Each element's polynomial is multiplied with the harmonic at points enough for both, so that
        the quadrature is exact to rounding however high the order.

        Args:
            values: at the nodes.
            bounds: phases between the elements [periods].
            orders: integers, known when compiled.

        Returns:
            integral over the period of value exp(-2 pi i order phase).

        From Gauss's quadrature of the Fourier integral.
        """
        highest = float(np.max(np.abs(orders), initial=0))
        turned = (self.nodes + math.pi * highest / self.elements) / 2.0
        count = math.ceil(turned + 4.0 * turned ** (1.0 / 3.0)) + 8
        matrix, place, weight = _fine(self.nodes, count)
        length = jnp.diff(bounds)
        phase = bounds[:-1, None] + length[:, None] * place
        harmonic = jnp.exp(-2j * jnp.pi * orders[:, None, None] * phase)
        return jnp.einsum("...eq,oeq->o...", (values @ matrix) * weight * length[:, None], harmonic)


def _ends(place: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], place[1:-1], [1.0]])


@cache
def _modes(count: int) -> np.ndarray:
    """Matrix from values at the nodes to Legendre coefficients."""
    modes = np.polynomial.legendre.legvander(2.0 * _ends(lobatto(count)[0]) - 1.0, count - 1)
    return np.linalg.inv(modes).T


def _reading(count: int, place: np.ndarray) -> np.ndarray:
    """Matrix from values at the nodes to the polynomial at other places of [0, 1]."""
    return _modes(count) @ np.polynomial.legendre.legvander(2.0 * place - 1.0, count - 1).T


@cache
def _derivative(count: int) -> np.ndarray:
    """Matrix from values at the nodes to derivatives at the nodes of [0, 1]."""
    x = 2.0 * _ends(lobatto(count)[0]) - 1.0
    slopes = [np.polynomial.Legendre.basis(degree).deriv()(x) for degree in range(count)]
    return 2.0 * _modes(count) @ np.array(slopes)


@cache
def _local(count: int, degree: int) -> np.ndarray:
    """Matrix from values at the nodes to powers of a local coordinate, interval by interval."""
    place = _ends(lobatto(count)[0])
    local = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    powers = np.linalg.inv(np.polynomial.polynomial.polyvander(local, degree))
    at = place[:-1, None] + np.diff(place)[:, None] * (local + 1.0) / 2.0
    values = _reading(count, at.ravel()).reshape(count, count - 1, degree + 1)
    return np.asarray(np.swapaxes(values @ powers.T, 1, 2).reshape(count, -1))


@cache
def _fine(count: int, points: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Matrix to Gauss points of [0, 1], these points, and their weights."""
    x, weight = np.polynomial.legendre.leggauss(points)
    return _reading(count, (x + 1.0) / 2.0), (x + 1.0) / 2.0, weight / 2.0
