"""Heat of contacts of finite length: temperatures of film and surfaces over the patch."""

from __future__ import annotations

from typing import NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.factored import Arrays
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.conduction import Conduction
from pitchpoint.lubrication.ehl.line_grid import NodeRow
from pitchpoint.lubrication.ehl.patch.balance import heat_beside, work
from pitchpoint.lubrication.ehl.patch.contact import PatchContact
from pitchpoint.lubrication.ehl.patch.layout import PatchProblem
from pitchpoint.lubrication.ehl.reynolds import Flow
from pitchpoint.lubrication.ehl.strips import (
    NEAR,
    PassingSurfaces,
    Past,
    Strip,
    anderson_rise,
    by_heat,
    change_of,
    line_temperature_rise,
    of_surfaces,
    spread_of,
    surface_passages,
    warmer_flow,
)
from pitchpoint.lubrication.flash_temperature import Conductor, peclet_number

__all__ = [
    "TEMPERATURES",
    "ContactHeat",
    "HeatStep",
    "PatchTemperatures",
    "check_heat",
    "contact_heat",
    "next_turn",
    "patch_heat_defect",
    "patch_temperature_rise",
    "patch_temperatures",
    "rests_somewhere",
    "warmed_patch",
]

Field = Float[Arrays, "y x"]
One = Float[Arrays, ""]

TEMPERATURES = ("film", "surface_a", "surface_b", "flux_a", "flux_b", "heat")
"""Names of what has a value in every cell, shape (y, x)."""


class PatchTemperatures(eqx.Module):
    """Heat and rises of temperature above the inlet over the patch of one contact.

    Attributes:
        film: mean over the film, shape (y, x) [K].
        surface_a: of member 0, shape (y, x) [K].
        surface_b: of member 1 [K].
        flux_a: heat per area into member 0, shape (y, x) [W/m2].
        flux_b: into member 1 [W/m2].
        heat: per area that film and asperities make, shape (y, x) [W/m2].
        largest_film: largest mean over the film [K].
        largest_a: flash temperature of member 0, largest [K].
        largest_b: of member 1 [K].
        power_a: heat into member 0 [W].
        power_b: into member 1 [W].
        expansion_power: work that the oil does as it expands warm after it was compressed cold, and as
            surfaces that approach press it; with the work against friction it makes up the heat [W].
        peclet_a: least Peclet number |u| b rho c/(2 k) of member 0 along y.
        peclet_b: of member 1.
    """

    film: Field
    surface_a: Field
    surface_b: Field
    flux_a: Field
    flux_b: Field
    heat: Field
    largest_film: One
    largest_a: One
    largest_b: One
    power_a: One
    power_b: One
    expansion_power: One
    peclet_a: One
    peclet_b: One


class ContactHeat(NamedTuple):
    """What decides about the heat of a contact besides its pressure; see `PatchContact`.

    Attributes:
        places: along y at which speeds are given, shape (k,) [m].
        speed_a: surface speed of member 0 along x, shape (k,) [m/s].
        speed_b: of member 1.
        conduction: of the heat.
    """

    places: Float[Arrays, " k"]
    speed_a: Float[Arrays, " k"]
    speed_b: Float[Arrays, " k"]
    conduction: Conduction

    def speeds(self, y: Array) -> tuple[Array, Array]:
        """Of both surfaces in every row, each of shape (y,) [m/s]."""
        speed_a, speed_b = (jnp.interp(y, self.places, v) for v in (self.speed_a, self.speed_b))
        return speed_a, speed_b


def contact_heat(contact: PatchContact) -> ContactHeat | None:
    """What decides about the heat of a contact, entrained along x; None of an isothermal one."""
    if contact.conduction is None:
        return None
    return ContactHeat(contact.places, contact.speed_a, contact.speed_b, contact.conduction)


def check_heat(contact: PatchContact) -> None:
    """InputError for a contact with conduction, as its grid lies, whose surfaces move across rows too."""
    moves = float(contact.across_a) != 0.0 or float(contact.across_b) != 0.0
    if contact.conduction is not None and moves:
        raise InputError(
            "temperatures of a patch are those of surfaces that move along one of its axes, and with speeds "
            "along both heat passes it obliquely: turn the contact, or leave `conduction` out",
            key="across",
        )


def rests_somewhere(contact: PatchContact) -> bool:
    """Whether both surfaces stand still somewhere, which has no steady temperature; of conduction alone."""
    stands = (np.asarray(contact.speed_a) == 0.0) & (np.asarray(contact.speed_b) == 0.0)
    return contact.conduction is not None and bool(np.any(stands))


def warmed_patch(problem: PatchProblem, rise: Field) -> PatchProblem:
    """The contact with a film that is so much warmer than its inlet, shape (y, x) [K]."""
    warm: PatchProblem = eqx.tree_at(
        lambda tree: tree.flow, problem, warmer_flow(problem.flow, rise)
    )
    return warm


class _Rows(NamedTuple):
    """Rows of a contact as strips along the motion of their surfaces.

    Attributes:
        flow: of the oil.
        conduction: of the heat.
        passes: surfaces that pass the cells of a row.
        at: nodes of a row.
        length: unit of length [m].
        power: unit of power per width of a row [W/m].
    """

    flow: Flow
    conduction: Conduction
    passes: PassingSurfaces
    at: NodeRow
    length: Array
    power: Array

    def strip(self, row: _Row) -> tuple[Flow, Strip]:
        """Flow and heat in one row."""
        flow = warmer_flow(self.flow, row.rise)
        spread = spread_of(
            self.conduction, row.speeds, self.length, row.room * flow.height, self.passes
        )
        fields = row.oil, row.gap, row.room, row.asperities, row.beside
        sliding = row.speeds[1] - row.speeds[0]
        return flow, Strip(*fields, sliding, self.length, self.power, spread)


class _Row(NamedTuple):
    """What a row, or each of them, has of its own; see `Strip`."""

    rise: Array
    oil: Array
    gap: Array
    room: Array
    asperities: Array
    beside: Array
    speeds: tuple[Array, Array]


def _rows(
    heats: ContactHeat, problem: PatchProblem, pressure: Array, level: Array
) -> tuple[_Rows, _Row]:
    flow, bodies, length = problem.flow, problem.bodies, problem.length
    gap = problem.gap(pressure, level)
    asperities = flow.asperity_pressure(gap)
    oil, nodes = pressure - asperities, pressure.shape[1]
    x = jnp.asarray(bodies.x)
    spacing = (x[-1] - x[0]) / (nodes - 1)
    edges = x[0] + spacing * (jnp.arange(nodes + 1) - 0.5)
    ahead = 0.5 * (x[1:] + x[:-1]) < 0.0
    at = NodeRow(jnp.full(nodes, spacing), jnp.full(nodes - 1, spacing), ahead)
    power = flow.pressure * flow.height * problem.speed
    beside = heat_beside(problem, oil, gap) * power / length
    shared = flow, heats.conduction, surface_passages(x, edges), at, length, power
    speeds = heats.speeds(jnp.asarray(bodies.y) * length)
    per_row = flow.temperature_rise, oil, gap, flow.room(gap), asperities, beside, speeds
    return _Rows(*shared), _Row(*per_row)


class HeatStep(NamedTuple):
    """A turn from pressure to temperature.

    Attributes:
        rise: of the film at the pressure, shape (y, x) [K].
        begin: rise from which the next turn begins.
        change: between the rises of this turn and the one before, over the largest rise.
        past: turns so far, of all cells in one row.
    """

    rise: Float[Array, "y x"]
    begin: Float[Array, "y x"]
    change: Float[Array, ""]
    past: Past


def next_turn(
    heats: ContactHeat,
    problem: PatchProblem,
    pressure: Array,
    level: Array,
    past: Past,
    before: Array,
) -> HeatStep:
    """Temperature at a pressure: row by row, with the flow from row to row as warm as it was.

    Args:
        heats: what decides about the heat.
        problem: the contact, as warm as its pressure was found for.
        pressure: shape (y, x).
        level: of the surfaces.
        past: turns so far.
        before: change in the turn before.
    """
    shared, rows = _rows(heats, problem, pressure, level)

    def settled(row: _Row) -> Array:
        return line_temperature_rise(*shared.strip(row), shared.at)

    rise = jax.lax.map(settled, rows)
    begun = problem.flow.temperature_rise
    change = change_of(begun, rise)
    near = (change < NEAR) & (before < NEAR)
    quicker, past = anderson_rise(past, jnp.ravel(begun), jnp.ravel(rise), near)
    begin = jnp.where(near, quicker.reshape(rise.shape), rise)
    return HeatStep(rise, begin, change, past)


def patch_temperature_rise(
    heats: ContactHeat, problem: PatchProblem, pressure: Array, level: Array
) -> Array:
    """Rise of the film that its heat makes, shape (y, x) [K]."""
    shared, rows = _rows(heats, problem, pressure, level)
    rise: Array = jax.lax.map(lambda row: by_heat(*shared.strip(row), shared.at)[0], rows)
    return rise


def patch_heat_defect(
    heats: ContactHeat, problem: PatchProblem, pressure: Array, level: Array
) -> Array:
    """Rise of the film against that by its heat, over the largest rise."""
    rise = patch_temperature_rise(heats, problem, pressure, level)
    return change_of(problem.flow.temperature_rise, rise)


def patch_temperatures(
    heats: ContactHeat, problem: PatchProblem, pressure: Array, level: Array, half_width: Array
) -> PatchTemperatures:
    """Heat and temperatures over the patch of a contact.

    Args:
        heats: what decides about the heat.
        problem: the contact as warm as it is, in units of its own.
        pressure: solution, shape (y, x).
        level: of the surfaces.
        half_width: of the dry contact [m].
    """
    shared, rows = _rows(heats, problem, pressure, level)

    def told(row: _Row) -> tuple[Array, ...]:
        flow, strip = shared.strip(row)
        _, heat = by_heat(flow, strip, shared.at)
        return heat, *of_surfaces(strip.spread, heat)

    heat, flux_a, flux_b, surface_a, surface_b = jax.lax.map(told, rows)
    length, bodies, rise = problem.length, problem.bodies, problem.flow.temperature_rise
    expansion = work(problem, rows.oil, rows.gap).expansion
    peclet = [
        _least_peclet(speed, half_width, body)
        for speed, body in (
            (heats.speed_a, heats.conduction.a),
            (heats.speed_b, heats.conduction.b),
        )
    ]
    return PatchTemperatures(
        film=rise,
        surface_a=surface_a,
        surface_b=surface_b,
        flux_a=flux_a,
        flux_b=flux_b,
        heat=heat,
        largest_film=jnp.max(rise),
        largest_a=jnp.max(surface_a),
        largest_b=jnp.max(surface_b),
        power_a=bodies.load(flux_a) * length**2,
        power_b=bodies.load(flux_b) * length**2,
        expansion_power=expansion * shared.power * length,
        peclet_a=peclet[0],
        peclet_b=peclet[1],
    )


def _least_peclet(speed: Array, half_width: Array, body: Conductor) -> Array:
    return jnp.min(peclet_number(speed=speed, half_width=half_width, body=body))
