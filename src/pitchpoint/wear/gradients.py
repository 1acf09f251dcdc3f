"""Derivatives of wear with respect to every continuous input."""

import dataclasses

import equinox as eqx
import numpy as np
from jaxtyping import Array

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation
from pitchpoint.programs import program
from pitchpoint.wear.history import Cells, WearModel, midpoints, reached, travelled, wear_of

__all__ = ["Inputs", "depth_gradient", "sensitivities"]

Inputs = tuple[Design, Operation, WearModel]


def depth_gradient(
    inputs: Inputs, models: Models, cells: Cells, parts: int
) -> tuple[Array, Inputs]:
    """Largest depth that a turn wears off flanks as new [m], and its derivatives.

    Args:
        inputs: design, operating point and how material goes.
        models: sharing of the load, and friction where it warms the contacts.
        cells: on both flanks.
        parts: phases in each stretch between events.

    Returns:
        The depth, and the same inputs with the derivative in place of each continuous value, in m over its SI
        unit; None in place of the others. It belongs to the cell that is deepest.

    By automatic differentiation in reverse, no differences are taken.
    """
    value, slopes = _gradient(inputs, models, cells, parts)
    structure = jax.tree.structure(eqx.filter(inputs, eqx.is_inexact_array))
    return value, jax.tree.unflatten(structure, slopes)


@program
def _gradient(
    inputs: Inputs, models: Models, cells: Cells, parts: int
) -> tuple[Array, list[Array]]:
    """Value and derivatives without the laws between them, by which the program could not be kept."""

    def deepest(inputs: Inputs) -> Array:
        design, operation, wear = inputs
        design = dataclasses.replace(design, mesh=design.mesh.completed())
        phase, weight = midpoints(design.mesh.events(), parts)
        contacts = design.mesh.contacts(phase)
        share = models.share(design, contacts, operation.load)
        known = Engagement(phase, weight, contacts, share, None, 1)
        # Cells follow the flanks.
        flank, across, span = reached(*travelled(design, operation, models, known))
        own = dataclasses.replace(cells, flank=flank, across=across, span=span)
        return jnp.max(wear_of(design, operation, models, wear, own, known).depth)

    value, slopes = eqx.filter_value_and_grad(deepest)(inputs)
    return value, jax.tree.leaves(slopes)


def sensitivities(inputs: Inputs, value: float, derivatives: Inputs) -> dict[str, float]:
    """Relative change of a figure over the relative change of an input, by its name.

    Args:
        inputs: design, operating point and how material goes.
        value: of the figure.
        derivatives: of it, as from `depth_gradient`.

    From d ln y/d ln x; temperatures count from absolute zero.
    """
    found = {}
    for name, own, slope in zip(*_named(inputs), _named(derivatives)[1], strict=True):
        if own is not None and slope is not None and np.ndim(own) == 0:
            found[name] = float(own) * float(slope) / value
    return found


def _named(inputs: Inputs) -> tuple[list[str], list[Array | None]]:
    """Inputs that a designer can choose, by name."""
    design, operation, wear = inputs
    mesh, rough = design.mesh, design.roughness
    every: dict[str, Array | None] = {
        "load": operation.load,
        "speed": operation.speed,
        "temperature of the oil": operation.temperature,
        "module": getattr(mesh, "module", None),
        "face width": getattr(mesh, "face_width", None),
        **{f"Young's modulus {k + 1}": one.young for k, one in enumerate(design.solids)},
        **{f"Rq {k + 1}": one for k, one in enumerate((rough.rq_1, rough.rq_2))},
        **{f"{name} {k + 1}": v for k, own in enumerate(wear.own) for name, v in own.items()},
        **{name.replace("_", " "): v for name, v in (wear.defect or {}).items()},
    }
    return list(every), list(every.values())
