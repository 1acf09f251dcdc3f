"""Stress and work of the oil in a line contact, which fields and heat are made of."""

from __future__ import annotations

from typing import Final

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import jnp
from pitchpoint.lubrication.ehl.line_grid import Along, LineGrid
from pitchpoint.lubrication.ehl.reynolds import Flow, upwind

__all__ = [
    "fractional_film_content",
    "pressure_flow",
    "shear_stress",
    "specific_volume",
    "work_of_expansion",
    "work_of_pressure",
]

BROKEN: Final = 1e-9
"""Pressure below which a film is broken, in units of Hertz's pressure."""

# Means of 1/rho between nodes come to 1e-7 even from 0 to 2 GPa, with four points to 1e-4.
_GAUSS = np.polynomial.legendre.leggauss(8)


def shear_stress(flow: Flow, oil: Array, room: Array, sliding: Array) -> Array:
    """On member 0, which member 1 draws along where it is the faster one [Pa]."""
    pressure = jnp.maximum(oil, 0.0) * flow.pressure
    return flow.fluid.shear_stress(sliding / (room * flow.height), pressure, flow.temperature_rise)


def work_of_pressure(flow: Flow, oil: Array, gap: Array, at: LineGrid) -> tuple[Array, Array]:
    """Half of the flow that surfaces draw along times the rise of pressure; the same of that under pressure.

    Both per volume: mass over the density between two nodes. Over a film that begins and ends without
    pressure the flow as a whole does no work, unless it becomes warm, so that twice the speed times the first
    is the second.
    """
    mass, conductance = flow.mass_and_conductance(oil, gap, at)
    rise = jnp.diff(oil)
    volume = rise * specific_volume(flow, oil)
    drawn = flow.entrainment * upwind(mass)
    return 0.5 * jnp.sum(drawn * volume), jnp.sum(conductance * rise * volume)


def work_of_expansion(flow: Flow, oil: Array, gap: Array, at: LineGrid) -> Array:
    """What the flow as a whole does as it expands warm after it was compressed cold."""
    mass, conductance = flow.mass_and_conductance(oil, gap, at)
    rise, inside = jnp.diff(oil), jnp.argmax(oil)
    passing = flow.entrainment * upwind(mass)[inside] - conductance[inside] * rise[inside]
    return -passing * jnp.sum(rise * specific_volume(flow, oil))


def pressure_flow(flow: Flow, oil: Array, gap: Array, at: Along) -> tuple[Array, Array]:
    """Mass that pressure moves through each face, and the power that this turns into heat over its square.

    Source: Reynolds (1886), the flow by pressure; its power is that flow times the fall of the pressure.
    """
    _, conductance = flow.mass_and_conductance(oil, gap, at)
    # Oil that is all but solid lets nothing through, and makes no heat.
    return conductance * jnp.diff(oil), specific_volume(flow, oil) / jnp.maximum(
        conductance, 1e-200
    )


def specific_volume(flow: Flow, oil: Array, rise: Array | None = None) -> Array:
    """Mean of one over the density from the pressure at a node to that at the next.

    Args:
        flow: of the oil.
        oil: its pressure, neighbours along the first axis.
        rise: of the temperature at the same nodes; that of the flow unless given [K].

    Source: Abramowitz and Stegun (1964), eq. 25.4.30, Gauss' formula.
    """
    warmth = flow.temperature_rise if rise is None else rise
    weighed = [
        0.5 * w / flow.density(_between(oil, at), _between(warmth, at))
        for at, w in zip(*_GAUSS, strict=True)
    ]
    return jnp.sum(jnp.stack(weighed), axis=0)


def _between(values: Array, at: float) -> Array:
    """From values at a node, at -1, to those at the next, at 1; one that holds everywhere as it is."""
    if values.ndim == 0:
        return values
    before, behind = values[:-1], values[1:]
    return 0.5 * (before + behind) + 0.5 * at * (behind - before)


def fractional_film_content(flow: Flow, oil: Array, room: Array) -> Array:
    """Oil that passes the end of the film over what would fill the gap behind it, one in the film.

    From the mass that the surfaces carry on behind the end of the film.
    """
    mass = flow.density(oil) * room
    place = jnp.arange(oil.shape[0])
    last_full = jnp.max(jnp.where(oil > BROKEN, place, 0))
    return jnp.where(place > last_full, jnp.minimum(mass[last_full] / mass, 1.0), 1.0)
