"""Contacts of a mesh over its cycle, for solvers of films: what they carry, and which are alike."""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import jax, jnp
from pitchpoint.cases.built import Built
from pitchpoint.cases.film_choices import PATCH_NODES, patch_grid
from pitchpoint.contact.contacts import Contacts, Shape
from pitchpoint.core.programs import program
from pitchpoint.efficiency.in_turns import balance_under
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    cycle_nodes,
    cycle_of,
)
from pitchpoint.efficiency.rows import one_engagement
from pitchpoint.efficiency.summary import engaged
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.loading.balance import Balance
from pitchpoint.lubrication.conditions import Conditions, evaluate, shape_of
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.lubrication.ehl.model import FilmModel
from pitchpoint.lubrication.ehl.solve import usual_nodes
from pitchpoint.lubrication.groups import load_parameter
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, FilmThickness

__all__ = [
    "LEAST",
    "Done",
    "by_pairs",
    "contact_states",
    "cycle_engagement",
    "distinct_contacts",
    "film_laws_for_shape",
    "film_model_of",
    "film_table",
    "patch_grid_of",
]

Done = Callable[[int, int], None]
"""Told the number of contacts that are done, and that of all."""

LEAST = 1e-6
"""Load per length over the largest one of the cycle below which a contact counts as unloaded."""

ALIKE = 11
"""Digits to which contacts are alike and solved once: those of both ends of a wave, say."""


def film_table(built: Built) -> FilmTable:
    """The table of the case that asks for films."""
    assert built.case.film is not None
    return built.case.film


@lru_cache(maxsize=2)
def film_model_of(built: Built) -> FilmModel:
    """How the films of a case are solved; nodes that it leaves open are those usual for its heaviest line."""
    model, table = built.film_model, film_table(built)
    assert model is not None
    if built.design.mesh.shape != "line" or not (table.nodes is None or table.over_patch):
        return model
    return replace(model, nodes=usual_nodes(_heaviest(built, model)))


@lru_cache(maxsize=2)
def patch_grid_of(built: Built) -> tuple[int, int]:
    """Nodes along the patches of a case and cells across; open ones are usual for its heaviest contact."""
    model, table = built.film_model, film_table(built)
    assert model is not None
    if table.nodes is not None:
        return patch_grid(table)
    return patch_grid(table, usual_nodes(_heaviest(built, model), PATCH_NODES))


def _heaviest(built: Built, model: FilmModel) -> float:
    """Largest load parameter M over the cycle, of ellipses that of lines as narrow; none without load."""
    loaded, modulus = contact_states(built)["loaded"], float(built.design.modulus)
    names = ("line_load", "pressure", "radius", "speed_a", "speed_b")
    load, pressure, radius, *speeds = (contact_states(built)[name][loaded] for name in names)
    if built.design.mesh.shape == "ellipse":
        load = 2.0 * np.pi * (pressure / modulus) ** 2 * modulus * radius
    oil = model.fluid(built.design.lubricant, float(built.operation.temperature))
    constants = float(oil.viscosity), radius, modulus
    return float(np.max(load_parameter(load, 0.5 * sum(speeds), *constants), initial=0.0))


def film_laws_for_shape(shape: Shape) -> list[FilmThickness]:
    """Film laws that hold for contacts of a shape."""
    return [law for law in FILM_THICKNESS.values() if shape_of(law) == shape]


def distinct_contacts(values: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Contacts that differ, and which of them each one is alike.

    Args:
        values: that tell contacts from each other [contact, value].
        scale: of each value.
    """
    rounded = np.round(values / np.where(scale > 0.0, scale, 1.0), ALIKE)
    _, where, inverse = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    return where, inverse.reshape(-1)


@lru_cache(maxsize=2)
def contact_states(built: Built) -> dict[str, np.ndarray]:
    """What the contacts of a cycle carry and how they move, [phase, pair, slice].

    Forces are those of the first friction law; what a law says, with an axis for all laws in front, stands
    under its own forces.
    """
    by_law = [_under(built, cycle_engagement(built), models) for models in built.models]
    pairs, cycle = by_law[0]
    pairs |= {name: np.stack([contacts[name] for contacts, _ in by_law]) for name in _OF_LAW}
    loaded = pairs["active"] & (pairs["line_load"] > LEAST * pairs["line_load"].max())
    return {**pairs, **cycle, "loaded": loaded}


_OF_LAW = ("friction", "sliding_loss", "rolling_loss", "load_by_law")


@lru_cache(maxsize=2)
def cycle_engagement(built: Built) -> Engagement:
    """Contacts and shares over the cycle."""
    loaded_design, nodes = (built.design, built.operation), _nodes(built)
    engagement = engaged(*loaded_design, built.models[0], nodes)
    alone = built.models[0].without_friction
    return engagement or one_engagement(built.design, built.operation.load, alone, nodes)


def _under(
    built: Built, engagement: Engagement, models: Models
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Contacts and cycle in balance under one friction law."""
    loaded_design = built.design, built.operation
    balance, _ = balance_under(*loaded_design, engagement, models)
    lanes, cycle = jax.device_get(
        _computed(*loaded_design, replace(engagement, body=None), balance)
    )
    return {name: by_pairs(built, values) for name, values in lanes.items()}, cycle


def _nodes(built: Built) -> int:
    """Nodes in each segment between events, so that there are as many phases as asked for."""
    sharing = built.models[0].sharing
    shape = jax.eval_shape(lambda mesh: cycle_nodes(mesh, sharing, 3)[0], built.design.mesh)
    segments = int(shape.size) // 3
    return max(3, -(-int(film_table(built).phases) // segments))


@program
def _computed(
    design: Design, operation: Operation, engagement: Engagement, found: Balance
) -> tuple[dict[str, Array], dict[str, Array]]:
    """Values at the contacts [..., pair, slice, node], and those of the whole mesh [node]."""
    cycle = cycle_of(design, operation, engagement, found)
    state, at, contacts = cycle.state, cycle.state.conditions, cycle.state.contacts
    lanes = {
        "active": contacts.active,
        "path": contacts.path,
        "weight_of_line": contacts.weight,
        "radius": contacts.radius,
        **_of_load(at, contacts),
        "load_by_law": state.balance.load,
        "friction": state.balance.friction,
        "sliding_loss": state.sliding_loss,
        "rolling_loss": state.rolling_loss,
        "film_by_law": jnp.stack(
            [evaluate(law, at) for law in film_laws_for_shape(contacts.shape)]
        ),
    }
    shape = contacts.active.shape
    of_mesh = {"drag_loss": state.drag_loss, "output_power": state.output_power}
    courses = {name: jnp.broadcast_to(v, cycle.phase.shape) for name, v in of_mesh.items()}
    courses |= {"phase": cycle.phase, "weight": cycle.weight}
    return {name: _spread(values, shape) for name, values in lanes.items()}, courses


def _of_load(at: Conditions, contacts: Contacts) -> dict[str, Array]:
    """What a contact carries and how its surfaces move; nothing where a pair is not in contact."""
    values = {
        "load": at.load,
        # An ellipse has no length.
        "line_load": at.line_load if contacts.shape == "line" else at.load,
        "pressure": at.pressure,
        "speed_a": at.speed_a,
        "speed_b": at.speed_b,
    }
    return {name: jnp.where(contacts.active, lane, 0.0) for name, lane in values.items()}


def _spread(values: Array, shape: tuple[int, ...]) -> Array:
    return jnp.broadcast_to(values, (*values.shape[: values.ndim - 3], *shape))


def by_pairs(built: Built, values: np.ndarray) -> np.ndarray:
    """Values [..., pair, slice, node] as [..., node, pair, slice] of the pairs that the mesh holds."""
    ordered = np.moveaxis(np.asarray(values), -1, -3)
    return in_pairs(built.design.mesh, ordered, ordered.ndim - 2)
