"""Derivatives of the march of wear with respect to every continuous input."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import completed, independent
from pitchpoint.wear.history import Cells, Start, WearModel, reached_ends, travelled, turn_alone

__all__ = ["Inputs", "Sensitivity", "march_sensitivities", "scalable_inputs", "scaled_inputs"]

Inputs = tuple[Design, Operation, WearModel]
Values = Float[np.ndarray, "..."]


class Sensitivity(NamedTuple):
    """Relative change of a figure over the relative change of an input, d ln y/d ln x.

    Attributes:
        rate: of the largest depth that a turn wears off flanks as new.
        depth: of the largest depth at the end of the march, after as many turns.
        life: of the turns to that depth.

    From the derivative of one logarithm with respect to the other.
    """

    rate: float
    depth: float
    life: float


def scalable_inputs(inputs: Inputs) -> list[str]:
    """Names of the inputs that can be changed by a part of themselves: finite ones that are not zero."""
    named = _named(inputs)
    values = jax.device_get(named)
    return [name for name in named if np.isfinite(values[name]) and values[name] != 0.0]


def scaled_inputs(
    inputs: Inputs, names: Sequence[str], part: Float[Array, " input"] | Values
) -> Inputs:
    """Inputs of which some are larger by a part of themselves; what follows from them follows.

    Args:
        inputs: design, operating point and how material goes.
        names: as `scalable_inputs` has them.
        part: of each; temperatures count from absolute zero.
    """
    inputs_by_name = _named(inputs)
    values = {name: inputs_by_name[name] * (1.0 + part[k]) for k, name in enumerate(names)}
    design, operation, wear = inputs
    solids = [
        replace(solid, young=values.get(f"Young's modulus {k}", solid.young))
        for k, solid in enumerate(design.solids, 1)
    ]
    rq_1, rq_2 = (values.get(f"Rq {k}", getattr(design.roughness, f"rq_{k}")) for k in (1, 2))
    constants = [
        {
            name: values.get(f"{_words(name)} {k}", constant)
            for name, constant in law_constants.items()
        }
        for k, law_constants in enumerate(wear.own, 1)
    ]
    defect = wear.defect and {
        name: values.get(_words(name), constant) for name, constant in wear.defect.items()
    }
    return (
        replace(
            design,
            mesh=completed(replace(design.mesh, **_fields(design.mesh, values))),
            solids=(solids[0], solids[1]),
            roughness=replace(design.roughness, rq_1=rq_1, rq_2=rq_2),
        ),
        Operation(*(values.get(name, getattr(operation, key)) for key, name in _POINT.items())),
        replace(wear, own=(constants[0], constants[1]), defect=defect),
    )


_POINT = {"load": "load", "speed": "speed", "temperature": "temperature of the oil"}


def _named(inputs: Inputs) -> dict[str, Array]:
    """Inputs that a designer can choose, by name."""
    design, operation, wear = inputs
    rough = design.roughness
    return {
        **{name: getattr(operation, key) for key, name in _POINT.items()},
        **{name: number for name, _, _, number in _of_mesh(design.mesh)},
        **{f"Young's modulus {k}": solid.young for k, solid in enumerate(design.solids, 1)},
        **{f"Rq {k}": rq for k, rq in enumerate((rough.rq_1, rough.rq_2), 1)},
        **{
            f"{_words(name)} {k}": constant
            for k, law_constants in enumerate(wear.own, 1)
            for name, constant in law_constants.items()
        },
        **{_words(name): constant for name, constant in (wear.defect or {}).items()},
    }


def _words(name: str) -> str:
    return name.replace("_", " ")


def _of_mesh(mesh: Mesh) -> Iterator[tuple[str, str, int | None, Array]]:
    """Name, field, member and value of the numbers of a mesh that are chosen."""
    for field in independent(mesh):
        value = getattr(mesh, field)
        if not np.ndim(value):
            yield _words(field), field, None, value
        else:
            for member in range(2):
                yield f"{_words(field)} {member + 1}", field, member, value[member]


def _fields(mesh: Mesh, values: Mapping[str, Array]) -> dict[str, Array]:
    """Fields of a mesh with some of its numbers changed."""
    fields: dict[str, Array] = {}
    for name, field, member, _ in _of_mesh(mesh):
        if name in values and member is None:
            fields[field] = values[name]
        elif name in values:
            fields[field] = fields.get(field, getattr(mesh, field)).at[member].set(values[name])
    return fields


# ---- along the steps of a march


def march_sensitivities(
    inputs: Inputs,
    models: Models,
    cells: Cells,
    parts: int,
    turns: Float[np.ndarray, " step"],
    depth: Float[np.ndarray, "step 2 cell strip"],
    *,
    updated: bool = True,
) -> dict[str, Sensitivity]:
    """How the end of a march depends on each input.

    Args:
        inputs: design, operating point and how material goes.
        models: sharing of the load, and friction where it warms the contacts.
        cells: on both flanks.
        parts: phases in each stretch between events.
        turns: of the driver after each step, from zero on.
        depth: that the march came to there [m].
        updated: False where flanks count as new throughout the march.

    Returns:
        Sensitivities by the name of the input; none where nothing wears.

    By automatic differentiation of what a turn wears off, and its variational equation along the steps that
    the march took, by the same method: s' = df/dh s + df/dx for d h/d ln x = s. The turns N to a depth h
    follow from h(N, x): d ln N/d ln x = - s/(N dh/dN). Both belong to the place that is deepest at the end.
    """
    names = tuple(scalable_inputs(inputs))
    moved = np.zeros((len(names), *depth.shape[1:]))
    felt = float(updated)

    def rate(depth: Values, moved: Values) -> tuple[Values, Values]:
        rates: tuple[Values, Values] = jax.device_get(
            _rate(inputs, models, cells, parts, names, array(felt * depth), array(felt * moved))
        )
        return rates

    here, slope = rates_as_new = rate(depth[0], moved)
    for step, at, after in zip(np.diff(turns), depth, depth[1:], strict=False):
        start_slope, middle = slope, rate(at + 0.5 * step * here, moved + 0.5 * step * slope)
        late = rate(at + 0.75 * step * middle[0], moved + 0.75 * step * middle[1])
        moved = moved + step * (2.0 * start_slope + 3.0 * middle[1] + 4.0 * late[1]) / 9.0
        here, slope = rate(after, moved)
    rows = cells.deepest
    new, new_slope = rates_as_new[0][:, rows], rates_as_new[1][:, :, rows]
    worn_depth, here, moved = depth[-1][:, rows], here[:, rows], moved[:, :, rows]
    if not float(new.max()) > 0.0:
        return {}
    start = np.unravel_index(int(np.argmax(new)), new.shape)
    place = np.unravel_index(int(np.argmax(worn_depth)), worn_depth.shape)
    deepest, fast = float(worn_depth[place]), float(here[place])
    return {
        name: Sensitivity(
            rate=float(new_slope[k][start] / new[start]),
            depth=float(moved[k][place]) / deepest if deepest > 0.0 else np.nan,
            life=-float(moved[k][place]) / (turns[-1] * fast) if fast > 0.0 else np.nan,
        )
        for k, name in enumerate(names)
    }


@program
def _rate(
    inputs: Inputs,
    models: Models,
    cells: Cells,
    parts: int,
    names: tuple[str, ...],
    depth: Float[Array, "2 cell strip"],
    moved: Float[Array, "input 2 cell strip"],
) -> tuple[Array, Array]:
    """What a turn wears off, and its derivatives by the logarithm of each input with a depth that moves."""

    def turn(part: Array, depth: Array) -> Array:
        design, operation, wear = scaled_inputs(inputs, names, part)
        start = Start.of(design, models, parts)
        share = models.share(design, start.contacts, operation.load, start.body, start.teeth)
        # Cells follow the flanks.
        flank, across, span = reached_ends(
            *travelled(design, operation, models, start.engaged(share))
        )
        moved_cells = replace(cells, flank=flank, across=across, span=span)
        return turn_alone(design, operation, models, wear, moved_cells, start, depth).depth

    value, slope = jax.linearize(turn, jnp.zeros(len(names)), depth)
    return value, jax.vmap(slope)(jnp.eye(len(names)), moved)
