"""Balance of oil in the cells of a patch, and how it changes with pressure and gap."""

from __future__ import annotations

from typing import NamedTuple

from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.patch.layout import PatchProblem
from pitchpoint.lubrication.ehl.reynolds import at_faces, third_order, upwind
from pitchpoint.lubrication.ehl.work import specific_volume

__all__ = [
    "ACROSS",
    "ALONG",
    "Stencil",
    "Through",
    "Work",
    "face_flows",
    "flow_balance",
    "heat_beside",
    "stencil",
    "work",
]

Field = Float[Arrays, "y x"]
Inner = Float[Array, "y inner"]

STEEP = 2.0
"""Conductance between two rows over the geometric mean of theirs, about, at most where gaps are steep."""

OPENED = 2.0
"""Film at a node over that at the node before it, up to which a bounded flow between them counts it.

Where a film ends the gap opens to many films within a cell of a coarse grid, and oil does not fill it.
Counted whole, it drew so much through the last face that the last node of the film was left with next to
nothing: smooth surfaces touched there in most slow contacts. With twice the film, what the surfaces draw
leaves the last node 7/9 of the film before it, about what is left where a film is narrowest. Grids that show
how a film ends never come to the bound. Conductances grow with the film to the power of three.
"""

CLOSED = 3.0
"""Film at a node over that at the one behind it, up to which a bounded flow on from there counts it.

Where the gap closes within a cell, as ahead of rows at a sharp end, the parabola through three nodes passes
below zero: oil flowed against the surfaces, and rows without oil were solutions. Up to five times it stays
positive; with three, a third of the films on both sides together flows through the face.
"""

ALONG, ACROSS = 4, 4
"""Nodes of a row, and rows, that a cell knows: from two before it to one behind."""


def flow_balance(problem: PatchProblem, oil: Field, gap: Field, rate: Array) -> tuple[Inner, Inner]:
    """What flows into each cell more than out of it, and what a pressure of one there takes out.

    Conductances along the faces between cells of a row: geometric mean ahead of the middle, arithmetic one
    behind, as in a line. Across, where the pressure falls to the sides, the arithmetic one: with the other
    one pressures beside an ellipse never settle. Where it would empty tips with thin films it is limited by
    the other, see `PatchProblem.steep`, and where films end within a cell by the film before, see
    `PatchProblem.bounded`. Oil leaves freely beyond the first and the last row.

    Args:
        problem: the contact.
        oil: pressure of the oil, shape (y, x).
        gap: of the mean planes, shape (y, x).
        rate: one over the time, in units of length and speed, in which the oil under a cell can change: it
            leaves the balance as it is and ties its changes; zero for a steady film.

    Returns:
        Both of the inner cells of each row, shape (y, x - 2).

    Source: Reynolds (1886), over cells of finite volume.
    """
    flows = face_flows(problem, oil, gap)
    width, spacing = _widths(problem)
    along = flows.conducts * jnp.diff(oil, axis=1) - flows.drawn
    beside = flows.sides * jnp.diff(_walled(oil), axis=0) - flows.carried
    rises = problem.flow.approach * problem.flow.density(oil) - _stored(problem, flows.mass, rate)
    gain = jnp.diff(along, axis=1) + (jnp.diff(beside, axis=0) + rises * width * spacing)[:, 1:-1]
    diagonal = flows.conducts[:, 1:] + flows.conducts[:, :-1]
    return gain, diagonal + (flows.sides[1:] + flows.sides[:-1])[:, 1:-1]


def _stored(problem: PatchProblem, mass: Field, rate: Array) -> Array:
    """What cells store in a time: since the film before, and since the mass that they have, to tie it."""
    since = (problem.pace, problem.before), (rate, jax.lax.stop_gradient(mass))
    return sum((pace * (mass - before) for pace, before in since), jnp.zeros(()))


class Through(NamedTuple):
    """What flows through the faces between cells.

    Attributes:
        mass: under each cell, shape (y, x).
        conducts: flow along by a fall of pressure of one, shape (y, x - 1).
        drawn: flow along by the surfaces.
        sides: as `conducts`, across, with the free ends, shape (y + 1, x).
        carried: as `drawn`, across.

    Source: Reynolds (1886), flow by pressure and flow by the surfaces.
    """

    mass: Array
    conducts: Array
    drawn: Array
    sides: Array
    carried: Array


def face_flows(problem: PatchProblem, oil: Field, gap: Field) -> Through:
    """What flows through the faces between cells; arguments as in `flow_balance`."""
    mass, ease = problem.flow.mass_and_ease(oil, gap)
    x, (width, spacing) = problem.bodies.x, _widths(problem)
    ahead = (0.5 * (x[1:] + x[:-1]) < 0.0)[:, None]
    eases = at_faces(ease.T, ahead).T
    if problem.bounded:
        eases = jnp.where(ahead.T, eases, jnp.minimum(eases, _most_eases(mass, ease)))
    return Through(
        mass,
        eases * width / spacing,
        problem.along[:, None] * _carried(problem, mass.T).T * width,
        _sides(ease, width[:, 0], spacing, problem.steep),
        problem.across * jnp.pad(_carried(problem, mass), ((1, 1), (0, 0)), mode="edge") * spacing,
    )


def _carried(problem: PatchProblem, mass: Array) -> Array:
    """Masses at the faces between rows, as in a line; bounded where they change by more than grids show."""
    if not problem.bounded:
        return upwind(mass)
    before, here = jnp.concatenate((mass[:1], mass[:-2])), mass[:-1]
    bounds = CLOSED * here, OPENED * here
    return third_order(jnp.minimum(before, bounds[0]), here, jnp.minimum(mass[1:], bounds[1]))


def _most_eases(mass: Field, ease: Field) -> Array:
    """Largest conductances at the faces along, by the film before each of them, shape (y, x - 1)."""
    # Falling viscosity, as behind a spike, is no opening gap: the bound is far off until the film doubles.
    opens = jnp.clip(OPENED * mass[:, :-1] / jnp.maximum(mass[:, 1:], 1e-30), 1.0, OPENED)
    return 0.5 * (1.0 + (OPENED * opens**3) ** 3) * ease[:, :-1]


class Work(NamedTuple):
    """What the oil does and turns into heat, in units of pressure, gap and length.

    Attributes:
        rows: rolling resistance of each row, shape (y,).
        across: that across.
        heat: of the flow under pressure, by a speed of one.
        expansion: work of the flow as a whole, by a speed of one; none where the film is as warm as its inlet
            and nothing approaches.
    """

    rows: Array
    across: Array
    heat: Array
    expansion: Array


def work(problem: PatchProblem, oil: Field, gap: Field) -> Work:
    """Work of the oil over the patch.

    Rolling resistance: half of the flow that a speed of one draws along times the rise of pressure; over a
    film that begins and ends without pressure, twice the speeds times these are the heat of the flow under
    pressure, as in a line, less what the flow as a whole does as it expands.
    """
    flows = face_flows(problem, oil, gap)
    width, _ = _widths(problem)
    rise, rise_beside = jnp.diff(oil, axis=1), jnp.diff(_walled(oil), axis=0)
    warmth = problem.flow.temperature_rise
    volume = rise * specific_volume(problem.flow, oil.T, warmth.T).T
    volume_beside = rise_beside * _volume_beside(problem, oil)
    row = 0.5 * jnp.sum(_carried(problem, flows.mass.T).T * width * volume, axis=1)
    unit = jnp.where(problem.across == 0.0, 1.0, problem.across)
    column = 0.5 * jnp.sum(flows.carried * volume_beside) / unit
    pressed = flows.conducts * rise, flows.sides * rise_beside
    heat = jnp.sum(pressed[0] * volume) + jnp.sum(pressed[1] * volume_beside)
    drawn = jnp.sum(flows.drawn * volume) + jnp.sum(flows.carried * volume_beside)
    return Work(row, column, heat, heat - drawn)


def heat_beside(problem: PatchProblem, oil: Field, gap: Field) -> Array:
    """Heat per area by flow under pressure from row to row, shape (y, x), by a speed of one.

    Half of what a face makes belongs to each of the rows beside it, all that an end makes to its row.
    """
    rise = jnp.diff(_walled(oil), axis=0)
    heat = face_flows(problem, oil, gap).sides * rise**2 * _volume_beside(problem, oil)
    inner = heat.at[0].multiply(2.0).at[-1].multiply(2.0)
    return 0.5 * (inner[1:] + inner[:-1]) / jnp.asarray(problem.bodies.areas)[:, None]


def _volume_beside(problem: PatchProblem, oil: Array) -> Array:
    """Mean of one over the density between rows, and between them and the ends, shape (y + 1, x)."""
    rise = problem.flow.temperature_rise
    if rise.ndim:
        rise = jnp.pad(rise, ((1, 1), (0, 0)), mode="edge")
    return specific_volume(problem.flow, _walled(oil), rise)


def _walled(oil: Array) -> Array:
    """Pressures with those beyond the first and the last row."""
    return jnp.pad(oil, ((1, 1), (0, 0)))


def _widths(problem: PatchProblem) -> tuple[Array, Array]:
    """Widths of the rows, shape (y, 1), and spacing of the nodes along them."""
    x, edges = problem.bodies.x, problem.bodies.edges
    return jnp.diff(jnp.asarray(edges))[:, None], (x[-1] - x[0]) / (x.shape[0] - 1)


def _sides(ease: Array, width: Array, spacing: Array, steep: Array) -> Array:
    """Conductances between rows, and to the free ends half a cell away, shape (y + 1, x).

    Where the gap opens steeply, as at the tips of an ellipse, a thin film there holds the oil back, however
    wide the gap of the next row is: an arithmetic mean alone would empty the tips.
    """
    mean = 0.5 * (ease[1:] + ease[:-1])
    part = jnp.sqrt(jnp.maximum(ease[1:] * ease[:-1], 1e-300)) / jnp.maximum(mean, 1e-150)
    # One of rows that are alike, smooth, and at most so many times the geometric mean.
    limited = mean * part * jnp.sqrt((1.0 + STEEP**2) / (1.0 + STEEP**2 * part**2))
    mean = jnp.where(steep > 0.0, limited, mean)
    between = 2.0 * mean / (width[1:] + width[:-1])[:, None]
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
    problem: PatchProblem, oil: Field, gap: Field, rate: Array
) -> tuple[Inner, Inner, Stencil, Stencil]:
    """Balance with its derivatives to the pressure of the oil and to gaps.

    Cells that no balance knows together are moved together: sixteen directions find all.

    Source: Reynolds (1886), see `flow_balance`; derivatives by automatic differentiation.
    """
    gain, by, diagonal = jax.linearize(
        lambda pressure, height: flow_balance(problem, pressure, height, rate),
        oil,
        gap,
        has_aux=True,
    )
    still = jnp.zeros_like(oil)
    moved = _colours(*oil.shape)
    by_oil = _sorted(jax.lax.map(lambda direction: by(direction, still), moved))
    return (
        gain,
        diagonal,
        by_oil,
        _sorted(jax.lax.map(lambda direction: by(still, direction), moved)),
    )


def _colours(rows: int, nodes: int) -> Array:
    """Directions in which cells move together, shape (16, y, x)."""
    across, along = (
        (jnp.arange(number) % reach == jnp.arange(reach)[:, None]) * 1.0
        for number, reach in ((rows, ACROSS), (nodes, ALONG))
    )
    return (across[:, None, :, None] * along[None, :, None, :]).reshape(-1, rows, nodes)


def _sorted(derivatives: Array) -> Stencil:
    """Derivatives by place, from those by direction."""
    _, rows, inner = derivatives.shape
    by = derivatives.reshape(ACROSS, ALONG, rows, inner)
    row, node = jnp.arange(rows)[:, None], jnp.arange(1, inner + 1)[None]

    def at(up: int, on: int) -> Array:
        value = by[(row + up) % ACROSS, (node + on) % ALONG, row, node - 1]
        beyond = (row + up < 0) | (row + up >= rows)
        return jnp.where(beyond, 0.0, value)

    return Stencil(
        jnp.stack([at(0, on) for on in range(-2, 2)]), jnp.stack([at(up, 0) for up in (-2, -1, 1)])
    )
