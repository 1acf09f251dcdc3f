"""Quadrature over one mesh period: nodes between the events, and polynomials through them."""

from functools import cache

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp

__all__ = ["INSIDE", "edges", "lobatto", "nodes", "phases_past_ties", "polynomial_matrices"]

INSIDE = 1e-9
"""Nodes keep this relative distance from the events, so that each lies on one side of them."""


TOGETHER = 1e-9
"""Part of a period within which events are at the same phase: that of rounding, and of printed numbers."""


def edges(events: Float[Array, " event"]) -> Float[Array, " edge"]:
    """Phases between which everything is smooth; the last is the first plus one.

    Args:
        events: of a mesh, in any order.
    """
    ordered = jnp.sort(events)
    return jnp.concatenate([ordered, ordered[:1] + 1.0])


def nodes(
    events: Float[Array, " event"], count: int
) -> tuple[Float[Array, "segment node"], Float[Array, "segment node"]]:
    """Phases and weights that integrate exactly between events, and move with them.

    Args:
        events: of a mesh; two at the same phase give a segment without length.
        count: Gauss-Lobatto nodes in each segment, at least 3.

    Source: Abramowitz and Stegun (1964), eq. 25.4.32, Lobatto's formula.
    """
    ends = edges(events)
    start, length = ends[:-1, None], jnp.diff(ends)[:, None]
    unit, weight = lobatto(count)
    return start + length * unit, length * weight


def phases_past_ties(
    phase: Float[Array, "segment node"], weight: Float[Array, "segment node"]
) -> Float[Array, "segment node"]:
    """Phases whose segments between events that are together are at the first node behind these.

    Which contacts carry between two events that rounding alone parts, hangs on rounding.

    Args:
        phase, weight: see `nodes`.
    """
    short = jnp.sum(weight, axis=-1) < TOGETHER
    segment_start = jnp.where(short, jnp.inf, phase[:, 0])
    behind = jax.lax.cummin(segment_start, reverse=True)
    behind = jnp.where(jnp.isinf(behind), jnp.min(segment_start) + 1.0, behind)
    return jnp.where(short[:, None], behind[:, None], phase)


@cache
def lobatto(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Lobatto nodes, nearly on [0, 1], and weights: both ends and the roots of P'.

    Source: Abramowitz and Stegun (1964), eq. 25.4.32, Lobatto's formula.
    """
    legendre = np.polynomial.Legendre.basis(count - 1)
    inner = np.sort(legendre.deriv().roots().real)
    x = np.concatenate([[-1.0], inner, [1.0]])
    weight = 1.0 / (count * (count - 1) * legendre(x) ** 2)
    return np.clip((x + 1.0) / 2.0, INSIDE, 1.0 - INSIDE), weight


@cache
def polynomial_matrices(count: int) -> list[np.ndarray]:
    """Matrices from values at the nodes to a polynomial and its derivatives at points between.

    The points are the nodes and seven more between neighbours, on [-1, 1]; last comes their
    spacing, zero at the ends, where a level tangent means nothing.

    From Legendre polynomials through the nodes.
    """
    nodes = 2.0 * lobatto(count)[0] - 1.0
    place = np.arange(8 * (count - 1) + 1) / 8.0
    x = -np.cos(np.interp(place, np.arange(count), np.arccos(-nodes)))
    spacing = np.concatenate([[0.0], np.maximum(x[2:] - x[1:-1], x[1:-1] - x[:-2]), [0.0]])
    modes = np.polynomial.legendre.legvander(nodes, count - 1)
    polynomials = [np.polynomial.Legendre.basis(degree) for degree in range(count)]
    rows = [[p.deriv(order)(x) if order else p(x) for p in polynomials] for order in range(4)]
    return [*(np.linalg.solve(modes.T, np.array(row)) for row in rows), spacing]
