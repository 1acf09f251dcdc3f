"""Pressure and film over a patch, and what follows from them."""

from __future__ import annotations

from typing import Final, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.lubrication.ehl.patch.balance import work
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.heat import (
    PatchTemperatures,
    contact_heat,
    patch_temperatures,
)
from pitchpoint.lubrication.ehl.patch.layout import Layout, PatchProblem
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.strips import warmer_flow
from pitchpoint.lubrication.ehl.work import fractional_film_content, shear_stress

__all__ = [
    "END_DISTANCES",
    "FIELDS",
    "STRESSES",
    "VECTORS",
    "ElasticResponse",
    "PatchFilm",
    "patch_film",
]

Field = Float[Arrays, "y x"]
One = Float[Arrays, ""]

END_DISTANCES: Final = np.array([0.25, 0.5, 1.0, 2.0])
"""Distances from the ends of a line at which its largest pressures are told, in half-widths."""


FIELDS: Final = (
    "pressure",
    "asperity_pressure",
    "dry_pressure",
    "gap",
    "film",
    "deflection",
    "heights",
    "filled",
    "shear_x",
    "shear_y",
    "traction_x",
    "traction_y",
)
"""Names of what has a value in every cell, shape (y, x)."""

STRESSES: Final = (("shear_x", "shear_y"), ("traction_x", "traction_y"))
"""Names of those along x and y of what has a direction."""

VECTORS: Final = ("minimum_place", "largest_place", "shear_force", "boundary_force", "rolling")
"""Names of what has a value along x and one along y, shape (2,)."""


class ElasticResponse(NamedTuple):
    """How the bodies of a contact answer, in own units.

    Attributes:
        dry: approach of the bodies without oil.
        dry_by_load: its change with the load, as a part of it.
        by_load: change of the level with the load with oil, as a part of it.
        by_approach: with the speed of approach, in the unit of `Flow.approach`.
    """

    dry: Float[Arrays, ""]
    dry_by_load: Float[Arrays, ""]
    by_load: Float[Arrays, ""]
    by_approach: Float[Arrays, ""]


class PatchFilm(eqx.Module):
    """Fields over the patch of one contact, and what follows from them; NaN where it was not solved.

    Attributes:
        x: places along, shape (x,) [m].
        y: places across, middles of the cells, shape (y,) [m].
        pressure: that oil and asperities carry together, shape (y, x) [Pa].
        asperity_pressure: that asperities carry [Pa].
        dry_pressure: of the contact without oil, which films are weighed by [Pa].
        gap: between the mean planes; negative where they overlap [m].
        film: mean gap that is open to the oil [m].
        deflection: of both bodies together [m].
        heights: of both surfaces together, as the cells see them of height maps [m].
        filled: part of the film that oil fills.
        shear_x: stress of the oil on member 0 along x, half way between the surfaces [Pa].
        shear_y: along y [Pa].
        traction_x: that and the friction of asperities; over the patch it is `shear_force` and
            `boundary_force` [Pa].
        traction_y: along y [Pa].
        central_film: gap of the mean planes at x = y = 0 [m]; NaN where nothing touches near y = 0.
        minimum_film: smallest gap of a cell [m].
        minimum_place: its x and y, shape (2,) [m].
        mean_film: mean gap, weighed by the dry pressure [m].
        largest_pressure: of a cell; where a line ends sharply it is a number of the grid [Pa].
        largest_place: its x and y, shape (2,) [m].
        near_ends: largest pressure across at `END_DISTANCES` half-widths from the ends of the line, shape
            (2, 4) [Pa]; NaN of ellipses, and where the grid ends before, as nothing touches there.
        asperity_share: part of the load that asperities carry.
        shear_force: of the oil on member 0, along x and y, shape (2,) [N].
        boundary_force: friction of asperities on member 0, shape (2,) [N].
        friction: net coefficient of the contact, the sum of both as vectors over the load; where sliding
            changes its sense along a line, parts of it cancel.
        friction_magnitude: integral of the magnitude of the traction over the load: what heats and wears,
            and what lines without ends side by side add up to.
        boundary_magnitude: its part by asperities.
        rolling: resistance to rolling, which the oil in the inlet does to each surface, shape (2,) [N].
        sliding_power: that oil and asperities take by sliding [W].
        pumping_power: that the flow under pressure turns into heat [W].
        separation: by which the bodies are further apart than without oil [m].
        stiffness: -dF/dh of the load by that separation, all else as it is: the film as a spring in series
            with the dry contact. It wavers as the edge of a narrow contact passes nodes: by 20 % of smooth
            heavy ones at 129 nodes, by 1 % of wide rough ones; on coarser grids by more. The temperature of
            the film is held where it is solved for [N/m].
        damping: dF/dV of the load by the speed V at which the bodies approach, with the separation held, and
            the temperature [N s/m].
        half_width: of the dry contact along x, of the rows that carry most [m].
        hertz_pressure: largest one of the dry contact, but for the ends of lines [Pa].
        film_ratio: smallest film over composite Rq; infinite for smooth surfaces.
        heat: temperatures, where they were solved for; None of isothermal films.
    """

    x: Float[Arrays, " x"]
    y: Float[Arrays, " y"]
    pressure: Field
    asperity_pressure: Field
    dry_pressure: Field
    gap: Field
    film: Field
    deflection: Field
    heights: Field
    filled: Field
    shear_x: Field
    shear_y: Field
    traction_x: Field
    traction_y: Field
    central_film: One
    minimum_film: One
    minimum_place: Float[Arrays, "2"]
    mean_film: One
    largest_pressure: One
    largest_place: Float[Arrays, "2"]
    near_ends: Float[Arrays, "2 distance"]
    asperity_share: One
    shear_force: Float[Arrays, "2"]
    boundary_force: Float[Arrays, "2"]
    friction: One
    friction_magnitude: One
    boundary_magnitude: One
    rolling: Float[Arrays, "2"]
    sliding_power: One
    pumping_power: One
    separation: One
    stiffness: One
    damping: One
    half_width: One
    hertz_pressure: One
    film_ratio: One
    heat: PatchTemperatures | None

    @property
    def traction_a(self) -> Float[Arrays, "2"]:
        """Force on member 0 along x and y: shear, asperities and rolling resistance [N]."""
        return self.shear_force + self.boundary_force - self.rolling

    @property
    def traction_b(self) -> Float[Arrays, "2"]:
        """Force on member 1 [N]."""
        return -self.shear_force - self.boundary_force - self.rolling


def patch_film(
    contact: PatchContact,
    layout: Layout,
    problem: PatchProblem,
    pressure: Array,
    level: Array,
    held: Array,
    response: ElasticResponse,
) -> PatchFilm:
    """Fields of a contact from a solution in its own units, as the grid lies.

    Args:
        contact: one, entrained along x.
        layout: of its grid.
        problem: the same in units of its own.
        pressure: solution, shape (y, x).
        level: of the surfaces.
        held: dry pressure, which films are weighed by, shape (y, x).
        response: of the bodies.
    """
    flow, bodies, length = problem.flow, problem.bodies, problem.length
    gap = problem.gap(pressure, level)
    asperities = flow.asperity_pressure(gap)
    oil, room = pressure - asperities, flow.room(gap)
    x, y = jnp.asarray(bodies.x), jnp.asarray(bodies.y)
    full = _filled(flow, oil, room)
    sliding = _sliding(contact, y * length)
    fast = jnp.hypot(*sliding)
    still = jnp.where(fast == 0.0, 1.0, fast)
    stress = full * shear_stress(flow, oil, room, fast[:, None])
    rubbing = flow.texture.boundary_friction * asperities * flow.pressure
    senses = [(component / still)[:, None] for component in sliding]
    shear, rubs = ([magnitude * sense for sense in senses] for magnitude in (stress, rubbing))
    done = work(problem, oil, gap)
    rolls = flow.pressure * flow.height * length
    apart = _apart(contact, problem, level, response)
    low, high = jnp.argmin(gap), jnp.argmax(pressure)
    rough = 0.0 if contact.texture is None else contact.texture.rq
    # Surfaces that do not slide against each other have no traction, whatever asperities carry there.
    slides = (fast > 0.0)[:, None]
    dragged = [bodies.load(magnitude * slides) * length**2 for magnitude in (stress, rubbing)]
    sheared, rubbed = (
        jnp.stack([bodies.load(component) for component in field]) * length**2
        for field in (shear, rubs)
    )
    return PatchFilm(
        x=x * length,
        y=y * length,
        pressure=pressure * flow.pressure,
        asperity_pressure=asperities * flow.pressure,
        dry_pressure=jnp.asarray(held) * flow.pressure,
        gap=gap * flow.height,
        film=room * flow.height,
        deflection=(gap - level - problem.apart) * flow.height,
        heights=contact.gap(x * length, y * length) - problem.apart * flow.height,
        filled=full,
        shear_x=shear[0],
        shear_y=shear[1],
        traction_x=shear[0] + rubs[0],
        traction_y=shear[1] + rubs[1],
        central_film=_in_the_middle(x, y, gap) * flow.height,
        minimum_film=jnp.min(gap) * flow.height,
        minimum_place=_place(x, y, low) * length,
        mean_film=problem.mean(gap, held) * flow.height,
        largest_pressure=jnp.max(pressure) * flow.pressure,
        largest_place=_place(x, y, high) * length,
        near_ends=_near_ends(contact, layout, y * length, pressure) * flow.pressure,
        asperity_share=bodies.load(asperities) / problem.load,
        shear_force=sheared,
        boundary_force=rubbed,
        friction=jnp.hypot(*(sheared + rubbed)) / contact.load,
        friction_magnitude=(dragged[0] + dragged[1]) / contact.load,
        boundary_magnitude=dragged[1] / contact.load,
        rolling=jnp.stack([jnp.sum(done.rows), done.across]) * rolls,
        sliding_power=bodies.load((stress + rubbing) * fast[:, None]) * length**2,
        pumping_power=done.heat * rolls * problem.speed,
        separation=apart[0],
        stiffness=apart[1],
        damping=apart[2],
        half_width=jnp.asarray(layout.half_width),
        hertz_pressure=jnp.asarray(layout.hertz_pressure),
        film_ratio=jnp.min(gap) * flow.height / rough,
        heat=_heat(contact, problem, pressure, level, layout),
    )


def _filled(flow: Flow, oil: Array, room: Array) -> Array:
    """Part of the film that oil fills in every cell, row by row."""
    rise = flow.temperature_rise

    def of_row(row: tuple[Array, Array, Array]) -> Array:
        oil_row, room_row, warmth = row
        return fractional_film_content(warmer_flow(flow, warmth), oil_row, room_row)

    rows = oil, room, jnp.broadcast_to(rise, rise.shape or oil.shape[:1])
    filling: Array = jax.vmap(of_row)(rows)
    return filling


def _heat(
    contact: PatchContact, problem: PatchProblem, pressure: Array, level: Array, layout: Layout
) -> PatchTemperatures | None:
    heats = contact_heat(contact)
    if heats is None:
        return None
    return patch_temperatures(heats, problem, pressure, level, jnp.asarray(layout.half_width))


def _apart(
    contact: PatchContact, problem: PatchProblem, level: Array, response: ElasticResponse
) -> tuple[Array, Array, Array]:
    """Separation, stiffness and damping; constants for derivatives, as dry bodies have none here."""
    height = problem.flow.height
    stiffness = -contact.load / ((response.by_load + response.dry_by_load) * height)
    yields = response.by_approach * problem.length / problem.speed
    constants: tuple[Array, Array, Array] = jax.lax.stop_gradient(
        ((level + response.dry) * height, stiffness, stiffness * yields)
    )
    return constants


def _sliding(contact: PatchContact, y: Array) -> tuple[Array, Array]:
    """Speed of member 1 against member 0 along x and y at every row, each of shape (y,) [m/s]."""
    along = contact.along(contact.speed_b - contact.speed_a, y)
    return along, jnp.full_like(along, contact.across_b - contact.across_a)


def _place(x: Array, y: Array, cell: Array) -> Array:
    row, node = jnp.unravel_index(cell, (y.shape[0], x.shape[0]))
    return jnp.stack([x[node], y[row]])


def _in_the_middle(x: Array, y: Array, field: Array) -> Array:
    """Value at x = y = 0, between the cells around."""
    rows = jax.vmap(lambda row: jnp.interp(0.0, x, row))(field)
    return jnp.interp(0.0, y, rows, left=jnp.nan, right=jnp.nan)


def _near_ends(contact: PatchContact, layout: Layout, y: Array, pressure: Array) -> Array:
    """Largest pressure across at distances from both ends of the line."""
    if contact.length is None:
        return jnp.full((2, END_DISTANCES.size), jnp.nan)
    ridge, away = jnp.max(pressure, axis=1), END_DISTANCES * layout.half_width
    ends = away - 0.5 * contact.length, 0.5 * contact.length - away
    return jnp.stack([jnp.interp(place, y, ridge, left=jnp.nan, right=jnp.nan) for place in ends])
