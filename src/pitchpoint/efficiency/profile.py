"""Everything along one mesh cycle, for figures and tables: torques, and the state of every contact."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import total
from pitchpoint.core.programs import program
from pitchpoint.efficiency.in_turns import balance_under
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    cycle_of,
)
from pitchpoint.efficiency.rows import one_engagement
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.gears.pairs import largest_inclination
from pitchpoint.loading.balance import Balance
from pitchpoint.lubrication.applicability import Limited
from pitchpoint.lubrication.conditions import evaluate
from pitchpoint.lubrication.lubrication_registry import (
    FILM_THICKNESS,
    LAWS,
    AsperityLoad,
    FilmThickness,
)

__all__ = ["FINE", "profile"]

FINE = 48
"""Usual nodes of a profile in each segment between events."""


def profile(
    design: Design,
    operation: Operation,
    models: Models,
    film: FilmThickness,
    nodes: int = FINE,
    engaged: Engagement | None = None,
    asperities: AsperityLoad | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, np.ndarray]:
    """State over one period at one operating point.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        models: laws.
        film: law of the film thickness.
        nodes: in each segment between events.
        engaged: contacts and shares, where they are known already.
        asperities: law of the part of the load that asperities carry, where it is asked for.
        progress: told the number of films that are solved, where the law solves them.

    Returns:
        Quantities by name, [node] for the mesh and [node, pair, slice] for each contact; zero where
        a pair is not in contact. Losses beside the teeth are among them where the design has some.
        Without any load there is no film (NaN), which the laws let grow without limit; over smooth
        flanks its ratio to their roughness is infinite. Names that begin with "outside" tell where laws are
        out of their ranges, and what to be wary of about solved films.

    Raises:
        ConvergenceError: a film was not solved, or films and forces do not agree.
    """
    chosen: list[Limited] = [models.law, film, *([asperities] if asperities else [])]
    engagement = engaged or one_engagement(design, operation.load, models.without_friction, nodes)
    balance, warnings = balance_under(design, operation, engagement, models, progress)
    limited = _limiting(chosen, film)
    courses, ranged = jax.device_get(
        _profile(
            design, operation, replace(engagement, body=None), balance, film, asperities, limited
        )
    )
    outside = {
        f"outside {law.name} {name}": _outside(ranged[name], limits, courses["active"])
        for law in chosen
        for name, limits in law.ranges.items()
    }
    return {**courses, **outside, "outside films": np.array(warnings)}


@program
def _profile(
    design: Design,
    operation: Operation,
    engagement: Engagement,
    balance: Balance,
    film: FilmThickness,
    asperities: AsperityLoad | None,
    limited: tuple[str, ...],
) -> tuple[dict[str, Array], dict[str, Array]]:
    """The state by name, and conditions by which laws are limited [pair, slice, node]."""
    result = cycle_of(design, operation, engagement, balance)
    state = result.state
    at, contacts = state.conditions, state.contacts
    carries = state.balance.force > 0.0
    thickness = jnp.where(carries, evaluate(film, at), jnp.nan)
    mesh = {
        "phase": result.phase,
        "weight": result.weight,
        "input_torque": state.input_torque,
        "efficiency": state.efficiency,
        "loss": state.loss,
        "contact_force": state.balance.force,
        "contact_force_ratio": state.contact_force_ratio,
        "residual": state.balance.residual,
        "locked": state.balance.locked,
        "jamming_coefficient": state.balance.jamming,
        "largest_friction": state.balance.largest_friction,
        "contact_line_length": total(jnp.where(contacts.active, contacts.weight, 0.0)),
    }
    by_slice = {
        "load": state.balance.load,
        "load_share": state.balance.load / _positive(state.balance.force),
        "friction": state.balance.friction,
        "sliding_velocity": at.slip * at.speed,
        "entrainment": at.entrainment,
        "slide_roll_ratio": at.slide_roll_ratio,
        "pressure": at.pressure,
        "film_thickness": thickness,
        "lambda_ratio": jnp.where(
            at.roughness_rq > 0.0, thickness / _positive(at.roughness_rq), thickness * jnp.inf
        ),
        "sliding_loss": state.sliding_loss,
        "rolling_loss": state.rolling_loss,
        "radius": contacts.radius,
    }
    if asperities is not None:
        by_slice["asperity_load_ratio"] = jnp.where(carries, evaluate(asperities, at), 0.0)
    if contacts.shape == "ellipse":
        ellipse = at.ellipse
        by_slice |= {"semi_axis_along": ellipse.along, "semi_axis_across": ellipse.across}
        longest = jnp.max(jnp.where(contacts.active, ellipse.across, 0.0), axis=(0, 1))
        mesh["contact_room"] = main_dimensions(design.mesh).get("contact_room", array(np.inf))
        mesh["largest_inclination"] = largest_inclination(design.mesh, longest)
    if design.drag:
        mesh["drag_loss"] = state.drag_loss
    mesh = {name: jnp.broadcast_to(v, result.phase.shape) for name, v in mesh.items()}
    masked = {name: jnp.where(contacts.active, values, 0.0) for name, values in by_slice.items()}
    lanes = {**masked, "active": contacts.active, "path": contacts.path}
    ranged = {name: jnp.broadcast_to(getattr(at, name), contacts.path.shape) for name in limited}
    in_order: dict[str, Array] = {
        name: jnp.moveaxis(values, -1, 0) for name, values in lanes.items()
    }
    return {**mesh, **in_order}, ranged


def _limiting(chosen: Sequence[Limited], film: FilmThickness) -> tuple[str, ...]:
    """Conditions by which laws are limited, rivals among them: they share one program."""
    films = (rival for rival in FILM_THICKNESS.values() if rival.shape == film.shape)
    return tuple(sorted({name for law in (*chosen, *LAWS, *films) for name in law.ranges}))


def _outside(value: np.ndarray, limits: tuple[float, float], active: np.ndarray) -> np.ndarray:
    """True at nodes where a condition [pair, slice, node] of a pair in contact leaves a range."""
    beyond = (value < limits[0]) | (value > limits[1])
    outside: np.ndarray = np.any(beyond & np.moveaxis(active, 0, -1), axis=(0, 1))
    return outside


def _positive(value: Array) -> Array:
    """Value, or infinity in place of zero, so that a quotient is zero."""
    return jnp.where(value > 0.0, value, jnp.inf)
