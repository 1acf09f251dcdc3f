"""Balance of oil in the cells of a patch, and how it changes with pressure and gap."""

from __future__ import annotations

from typing import NamedTuple

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.factored import Arrays
from pitchpoint.lubrication.ehl.patch.layout import Problem
from pitchpoint.lubrication.ehl.reynolds import at_faces, upwind

__all__ = ["ACROSS", "ALONG", "Stencil", "balance", "stencil"]

Field = Float[Arrays, "y x"]
Inner = Float[Array, "y inner"]

ALONG, ACROSS = 4, 4
"""Nodes of a row, and rows, that a cell knows: from two before it to one behind."""


def balance(problem: Problem, oil: Field, gap: Field, rate: Array) -> tuple[Inner, Inner]:
    """What flows into each cell more than out of it, and what a pressure of one there takes out.

    Conductances along the faces between cells of a row: geometric mean ahead of the middle, arithmetic one
    behind, as in a line. Across, where the pressure falls to the sides, the arithmetic one: with the other
    one pressures beside an ellipse never settle. Oil leaves freely beyond the first and the last row.

    Args:
        problem: the contact.
        oil: pressure of the oil, shape (y, x).
        gap: of the mean planes, shape (y, x).
        rate: one over the time, in units of length and speed, in which the oil under a cell can change: it
            leaves the balance as it is and ties its changes; zero for a steady film.

    Returns:
        Both of the inner cells of each row, shape (y, x - 2).
    """
    mass, ease = problem.flow.mass_and_ease(oil, gap)
    bodies = problem.bodies
    width, spacing = _widths(problem)
    middle = 0.5 * (bodies.x[1:] + bodies.x[:-1])
    conducts = at_faces(ease.T, (middle < 0.0)[:, None]).T * width / spacing
    net = conducts * jnp.diff(oil, axis=1) - problem.along[:, None] * upwind(mass.T).T * width
    sides = _sides(ease, width[:, 0], spacing)
    padded = jnp.pad(oil, ((1, 1), (0, 0)))
    drawn = problem.across * jnp.pad(upwind(mass), ((1, 1), (0, 0)), mode="edge") * spacing
    beside = sides * jnp.diff(padded, axis=0) - drawn
    area = width * spacing
    tied = rate * (mass - jax.lax.stop_gradient(mass))
    rises = problem.flow.approach * problem.flow.density(oil) - tied
    gain = jnp.diff(net, axis=1) + (jnp.diff(beside, axis=0) + rises * area)[:, 1:-1]
    own = conducts[:, 1:] + conducts[:, :-1] + (sides[1:] + sides[:-1])[:, 1:-1]
    return gain, own


def _widths(problem: Problem) -> tuple[Array, Array]:
    """Widths of the rows, shape (y, 1), and spacing of the nodes along them."""
    x, edges = problem.bodies.x, problem.bodies.edges
    return jnp.diff(jnp.asarray(edges))[:, None], (x[-1] - x[0]) / (x.shape[0] - 1)


def _sides(ease: Array, width: Array, spacing: Array) -> Array:
    """Conductances between rows, and to the free ends half a cell away, shape (y + 1, x)."""
    between = (ease[1:] + ease[:-1]) / (width[1:] + width[:-1])[:, None]
    ends = 2.0 * ease[:1] / width[0], 2.0 * ease[-1:] / width[-1]
    return jnp.concatenate((ends[0], between, ends[1])) * spacing


class Stencil(NamedTuple):
    """Derivatives of the balance of each cell to the cells that it knows.

    Attributes:
        along: to those of its own row, from two before it to one behind, shape (4, y, inner).
        across: to those of its own column in rows two before it to one behind, its own row left out,
            shape (3, y, inner).
    """

    along: Float[Array, "along y inner"]
    across: Float[Array, "across y inner"]


def stencil(
    problem: Problem, oil: Field, gap: Field, rate: Array
) -> tuple[Inner, Inner, Stencil, Stencil]:
    """Balance with its derivatives to the pressure of the oil and to gaps.

    Cells that no balance knows together are moved together: sixteen directions find all.
    """
    found, by, own = jax.linearize(
        lambda pressure, height: balance(problem, pressure, height, rate), oil, gap, has_aux=True
    )
    still = jnp.zeros_like(oil)
    moved = _colours(*oil.shape)
    by_oil = _sorted(jax.lax.map(lambda one: by(one, still), moved))
    return found, own, by_oil, _sorted(jax.lax.map(lambda one: by(still, one), moved))


def _colours(rows: int, nodes: int) -> Array:
    """Directions in which cells move together, shape (16, y, x)."""
    across, along = (
        (jnp.arange(number) % reach == jnp.arange(reach)[:, None]) * 1.0
        for number, reach in ((rows, ACROSS), (nodes, ALONG))
    )
    return (across[:, None, :, None] * along[None, :, None, :]).reshape(-1, rows, nodes)


def _sorted(found: Array) -> Stencil:
    """Derivatives by place, from those by direction."""
    _, rows, inner = found.shape
    by = found.reshape(ACROSS, ALONG, rows, inner)
    row, node = jnp.arange(rows)[:, None], jnp.arange(1, inner + 1)[None]

    def at(up: int, on: int) -> Array:
        value = by[(row + up) % ACROSS, (node + on) % ALONG, row, node - 1]
        beyond = (row + up < 0) | (row + up >= rows)
        return jnp.where(beyond, 0.0, value)

    return Stencil(
        jnp.stack([at(0, on) for on in range(-2, 2)]), jnp.stack([at(up, 0) for up in (-2, -1, 1)])
    )
