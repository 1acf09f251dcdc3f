"""Figures of whole mesh cycles for many designs and operating points at once, in chunks of one size."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import contact_velocity, total
from pitchpoint.core.programs import program
from pitchpoint.efficiency.drag import bearing_loads
from pitchpoint.efficiency.in_turns import in_turns
from pitchpoint.efficiency.quasi_static import (
    Cycle,
    Design,
    Engagement,
    Models,
    Operation,
    State,
    cycle,
    cycle_nodes,
    cycle_of,
    engagement,
)
from pitchpoint.efficiency.rows import (
    CHUNK,
    NODES,
    Row,
    balances_of,
    one_engagement,
    remembered_engagements,
    stacked,
)
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.mesh_bodies import main_dimensions
from pitchpoint.gears.nominal_motion import ratio_dimension
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.balance import Balance
from pitchpoint.loading.reactions import radial_and_axial
from pitchpoint.loading.sharing import equal
from pitchpoint.lubrication.conditions import evaluate
from pitchpoint.lubrication.lubrication_registry import LAWS, FilmThickness

if TYPE_CHECKING:
    from pitchpoint.efficiency.train_state import TrainState

__all__ = [
    "at_points",
    "cycle_summary",
    "engaged",
    "groups_alike",
    "joined_parts",
    "loss_factor",
    "mean_friction",
    "of_stacks",
    "stacks",
    "summarise",
    "tooth_heat_figures",
]


Point = tuple[Design, Operation]
Prepared = tuple[Design, Operation, Engagement | None]


def loss_factor(design: Design, models: Models, engaged: Engagement | None = None) -> Array:
    """Loss factor H_V: P_loss = P_in mu H_V to first order in mu.

    Mean over one pitch of the sliding arms over the driver's arm; for an involute pair with equal
    load sharing it is Ohlendorf's closed form. Pairs with gaps cannot share equally: they take their
    shares of one load. NaN where the driver presses no contact, as in a test rig.

    Args:
        design: mesh.
        models: for the nodes of the cycle.
        engaged: contacts and shares of a mesh with gaps; equal shares by default.

    Source: ISO/TR 14179-2:2001, H_V; Höhn (2010).
    """
    mesh = design.mesh
    if engaged is None:
        phase, weight = cycle_nodes(mesh, models.sharing, 6)
        contacts = mesh.contacts(phase)
        share = equal(contacts, mesh)
    else:
        weight, contacts, share = engaged.weight, engaged.contacts, engaged.share
    sliding = jnp.abs(contact_velocity(contacts.slip_arm, design.motion))
    arm = jnp.abs(contact_velocity(contacts.normal, design.driver))
    presses = jnp.any(arm > 0.0)
    return jnp.where(
        presses, total(share * sliding / jnp.where(presses, arm, 1.0)) @ weight, jnp.nan
    )


def cycle_summary(design: Design, result: Cycle, factor: Array) -> dict[str, Array]:
    """Figures of one cycle; powers in W, torques in N m, the rest dimensionless.

    Args:
        design: mesh, materials, oil, surfaces.
        result: its cycle at one operating point.
        factor: loss factor.
    """
    state = result.state
    low, high = result.extremes(state.efficiency)
    # Between the nodes the interpolation may overshoot; no state is better than free of loss.
    high = jnp.minimum(high, jnp.maximum(1.0, jnp.max(state.efficiency, axis=-1)))
    torque_low, torque_high = result.extremes(state.input_torque)
    acting, limit = result.nearest_to_jamming
    return {
        **_by_gear(main_dimensions(design.mesh)),
        **ratio_dimension(design.mesh, design.driver, design.loaded),
        "contact_ratio": design.mesh.contact_ratio,
        "loss_factor": factor,
        "mean_loss": result.mean_loss,
        "mean_loss_path": result.path_mean(state.loss),
        "mean_drag_loss": result.mean(state.drag_loss),
        "mean_efficiency": result.mean_efficiency,
        "mean_efficiency_path": result.path_mean(state.efficiency),
        "min_efficiency": low,
        "max_efficiency": high,
        "mean_input_torque": result.mean_input_torque,
        "mean_input_torque_path": result.path_mean(state.input_torque),
        "min_input_torque": torque_low,
        "max_input_torque": torque_high,
        "mean_friction": result.mean(mean_friction(result.state)),
        "residual": result.residual,
        "iterations": state.balance.iterations,
        "locked": result.locked,
        "jamming_coefficient": result.jamming,
        "nearest_friction": acting,
        "nearest_jamming_coefficient": limit,
        "largest_contact_force_ratio": jnp.max(state.contact_force_ratio, axis=-1),
        "carrying_slices": _carrying_slices(result),
        "slices": jnp.asarray(state.balance.load.shape[1]),
        **_by_gear(_reactions(design.mesh, result)),
        **_bearing_loads(design, result),
        **_at_pitch_point(result),
    }


def _at_pitch_point(result: Cycle) -> dict[str, Array]:
    """What laws for a whole mesh ask for; nothing where there is no pitch point."""
    at = result.state.conditions
    if at.reference is None:
        return {}
    return {
        "pitch_line_load": result.mean(at.reference_line_load),
        "pitch_sum_speed": result.mean(at.reference_sum_speed),
        "pitch_radius": at.reference_radius,
    }


LIMITING = tuple(sorted({name for law in LAWS for name in law.ranges}))
"""Conditions by which friction laws are limited."""


def _extremes(result: Cycle, film: FilmThickness | None) -> dict[str, Array]:
    """Smallest and largest values over all contacts that carry: what decides whether a law holds."""
    state = result.state
    at, carries = state.conditions, state.balance.load > 0.0
    values = {"friction": state.balance.friction} | {name: getattr(at, name) for name in LIMITING}
    if film is not None:
        rough = at.roughness_rq > 0.0
        ratio = evaluate(film, at) / jnp.where(rough, at.roughness_rq, 1.0)
        values["lambda_ratio"] = jnp.where(rough, ratio, jnp.inf)
    return {
        f"{end}_{name}": extreme(jnp.where(carries, value, -worst))
        for name, value in values.items()
        for end, extreme, worst in (("lowest", jnp.min, -jnp.inf), ("highest", jnp.max, jnp.inf))
    }


def _carrying_slices(result: Cycle) -> Array:
    """Mean number of slices that carry of the contact lines that carry; NaN where none does."""
    carries = jnp.where(result.state.balance.load > 0.0, 1.0, 0.0)
    lines = jnp.sum(jnp.max(carries, axis=1), axis=0)
    return result.mean(total(carries)) / result.mean(lines)


def _reactions(mesh: Mesh, result: Cycle) -> dict[str, Array]:
    """Mean load of the teeth on the bearings of each member, across its axis and along it [N]."""
    held = radial_and_axial(mesh, result.state.contacts, result.state.balance.load)
    return dict(zip(("radial_reaction", "axial_reaction"), result.mean(held), strict=True))


def _bearing_loads(design: Design, result: Cycle) -> dict[str, Array]:
    """Mean load on the bearing of each place beside the teeth [place] [N]; nothing without places."""
    if not design.drag:
        return {}
    state, nodes = result.state, result.phase.shape
    loads = bearing_loads(design.drag, design.mesh, state.contacts, state.balance.load)
    means = [result.mean(jnp.broadcast_to(load, nodes)) for load in loads]
    return {"bearing_load": jnp.stack(means)}


def _by_gear(values: Mapping[str, Array]) -> dict[str, Array]:
    """Values for the mesh as they are, values for each member under a name with its number."""
    by_member = {
        f"{name}_{number}": value
        for name, pair in values.items()
        if jnp.ndim(pair) == 1
        for number, value in enumerate(pair, 1)
    }
    return {name: value for name, value in values.items() if jnp.ndim(value) == 0} | by_member


@program
def tooth_heat_figures(design: Design, operation: Operation, models: Models) -> dict[str, Array]:
    """Mean friction coefficient and loss factor at one operating point: what heats the teeth."""
    mesh_cycle = cycle(design, operation, models, nodes=6)
    return {
        "mean_friction": mesh_cycle.mean(mean_friction(mesh_cycle.state)),
        "loss_factor": loss_factor(design, models),
    }


def summarise(
    points: Sequence[Point],
    models: Models,
    progress: Callable[[int], None] | None = None,
) -> dict[str, np.ndarray]:
    """Summaries of many points, each quantity [point].

    Args:
        points: designs and operating points of equal static structure (lanes, undercut).
        models: laws.
        progress: told the number of finished points after each chunk.

    Returns:
        Figures; where the law solves films, `turns_code`, `turns` and `turns_change` tell what became of each
        point, `outside_films` in words what is to be wary of about its films, and figures of films that were
        not solved are NaN.
    """
    prepared = list(_prepared(points, models))
    if models.law.films is not None:
        return _by_films(prepared, models, progress)
    return of_stacks(
        (_figures(chunk, models), used) for chunk, used in stacks(prepared, CHUNK, progress)
    )


def at_points(design: Design, operation: Operation, models: Models) -> dict[str, np.ndarray]:
    """Summaries of one design at several operating points of one load, each quantity [point].

    Their contacts and shares are the same and are found once.

    Args:
        design: whose rigid flanks all touch.
        operation: operating points [point].
        models: laws.
    """
    alone, designs = models.without_friction, stacked([design] * CHUNK)
    meshing = remembered_engagements(designs, array(np.resize(operation.load, CHUNK)), alone)
    count = operation.load.shape[0]

    def some(start: int) -> dict[str, np.ndarray]:
        taken = np.minimum(np.arange(start, start + CHUNK), count - 1)
        rows = designs, jax.tree.map(lambda values: np.asarray(values)[taken], operation), meshing
        figures: dict[str, np.ndarray] = jax.device_get(
            _summaries(rows, balances_of(rows, models), alone, models.film)
        )
        return figures

    return of_stacks((some(start), count - start) for start in range(0, count, CHUNK))


def _figures(chunk: Prepared, models: Models) -> dict[str, Array]:
    """Summaries of stacked points: programs without a law before and after that of their balances."""
    design, operation, meshing = chunk
    alone = models.without_friction
    if meshing is None:
        meshing = remembered_engagements(design, operation.load, alone)
    rows = design, operation, meshing
    return _summaries(rows, balances_of(rows, models), alone, models.film)


def _by_films(
    prepared: Sequence[Prepared], models: Models, progress: Callable[[int], None] | None
) -> dict[str, np.ndarray]:
    """Summaries of points whose films are solved, one after the other."""
    alone, rows, ends, doubts = models.without_friction, [], [], []
    for done, (design, operation, engaged) in enumerate(prepared, 1):
        meshing = engaged or one_engagement(design, operation.load, alone, NODES)
        solution = in_turns(design, operation, models, meshing)
        rows.append(((design, operation, replace(meshing, body=None)), solution.balance))
        ends.append(solution.status)
        doubts.append(
            "; ".join(getattr(warning, "brief", "") or warning for warning in solution.warnings)
        )
        if progress is not None:
            progress(done)
    figures = of_stacks(
        (_summaries(chunk[0], chunk[1], alone, models.film), used) for chunk, used in stacks(rows)
    )
    of_turns = {
        "turns_code": [status.code for status in ends],
        "turns_change": [status.residual for status in ends],
        "turns": [status.iterations for status in ends],
        "outside_films": doubts,
    }
    return {**figures, **{name: np.array(values) for name, values in of_turns.items()}}


def _prepared(points: Sequence[Point], models: Models) -> Iterator[Prepared]:
    """Points with their contacts and shares; neighbours of one drive have its contacts in common."""
    before: Design | None = None
    meshing: Engagement | None = None
    for design, operation in points:
        like = (
            meshing
            if meshing is not None and before is not None and _alike(before, design)
            else None
        )
        meshing = engaged(design, operation, models, like=like)
        before = design
        # The compliance of the bodies has done its work, and of many points it would be large.
        yield design, operation, meshing and replace(meshing, body=None)


def _alike(design: Design, neighbour: Design) -> bool:
    """True if both have the same drive in hand and equal solids."""
    return design.mesh is neighbour.mesh and _equal(design.solids, neighbour.solids)


def _equal(one: Any, other: Any) -> bool:
    """True if trees of the same kind hold equal numbers."""
    leaves, other_leaves = jax.tree.leaves(one), jax.tree.leaves(other)
    return len(leaves) == len(other_leaves) and all(map(np.array_equal, leaves, other_leaves))


def engaged(
    design: Design,
    operation: Operation,
    models: Models,
    nodes: int = 24,
    like: Engagement | None = None,
) -> Engagement | None:
    """Contacts and shares of a mesh with gaps at one load; None for others, which are quick.

    Args:
        design, operation, models: of one point.
        nodes: in each segment between events.
        like: of the same mesh, solids and nodes under another load.
    """
    if touching(design.mesh):
        return None
    for earlier in _LAST:
        if like is None and earlier.serves(design, models, nodes):
            if float(earlier.load) == float(operation.load):
                return earlier.engagement
            like = earlier.engagement
    meshing = engagement(design, operation.load, models, nodes, like)
    _LAST.append(_Known(design, operation.load, models, meshing))
    return meshing


class _Known(NamedTuple):
    """An engagement with what it was computed for."""

    design: Design
    load: Array
    models: Models
    engagement: Engagement

    def serves(self, design: Design, models: Models, nodes: int) -> bool:
        """True if another load of a drive has its contacts and the compliance of its bodies."""
        same_shares = self.engagement.nodes == nodes and self.models.sharing is models.sharing
        alike = same_shares and _alike(self.design, design)
        return alike and _equal(self.models.compliance, models.compliance)


_LAST: deque[_Known] = deque(maxlen=2)
"""The parts of a case ask for those of its drive, and of the same driven from its output."""


def stacks(
    points: Sequence[Any], size: int = CHUNK, progress: Callable[[int], None] | None = None
) -> Iterator[tuple[Any, int]]:
    """Stacks of so many points, the last one filled up by repetition, and how many of each count.

    One program serves any number of points.

    Args:
        points: trees of arrays of equal static structure.
        size: points that are stacked together.
        progress: told the number of finished points when the next stack is asked for.
    """
    for start in range(0, len(points), size):
        part = list(points[start : start + size])
        yield stacked(part + [part[-1]] * (size - len(part))), len(part)
        if progress is not None:
            progress(start + len(part))


def of_stacks(results: Iterable[tuple[Mapping[str, Any], int]]) -> dict[str, np.ndarray]:
    """Results of stacks, each quantity [point ...] and how many points count, as those of all points."""
    return joined_parts(
        [
            {name: np.asarray(values)[:used] for name, values in figures.items()}
            for figures, used in results
        ]
    )


def groups_alike(trees: Iterable[Any]) -> list[list[int]]:
    """Positions of inputs in groups of equal static structure and shapes: one program serves a group."""
    groups: dict[Any, list[int]] = {}
    for position, tree in enumerate(trees):
        leaves, structure = jax.tree.flatten(tree)
        groups.setdefault((structure, *map(np.shape, leaves)), []).append(position)
    return [*groups.values()]


def joined_parts(
    parts: Sequence[Mapping[str, np.ndarray]], groups: Sequence[Sequence[int]] = ()
) -> dict[str, np.ndarray]:
    """Results of several parts as those of the whole, each quantity [point ...].

    Args:
        parts: each quantity [point ...] of some points.
        groups: positions of the points of each part; they follow each other unless given.

    Example:
        >>> import numpy as np
        >>> from pitchpoint.efficiency.summary import groups_alike
        >>> groups = groups_alike([np.zeros(2), np.zeros(3), np.ones(2)])
        >>> parts = [{"loss": np.array([1.0, 3.0])}, {"loss": np.array([2.0])}]
        >>> groups, joined_parts(parts, groups)["loss"].tolist()
        ([[0, 2], [1]], [1.0, 2.0, 3.0])
    """
    if len(parts) == 1:
        return dict(parts[0])
    order = np.argsort(np.concatenate(groups)) if groups else slice(None)
    return {name: np.concatenate([part[name] for part in parts])[order] for name in parts[0]}


@program
def _summaries(
    rows: Row, balances: Balance, models: Models, film: FilmThickness | None
) -> dict[str, Array]:
    def one(
        design: Design, operation: Operation, meshing: Engagement, balance: Balance
    ) -> dict[str, Array]:
        factor = loss_factor(design, models, None if touching(design.mesh) else meshing)
        result = cycle_of(design, operation, meshing, balance)
        return cycle_summary(design, result, factor) | _extremes(result, film)

    result: dict[str, Array] = eqx.filter_vmap(one)(*rows, balances)
    return result


def mean_friction(state: "State | TrainState") -> Array:
    """Friction coefficient weighted with the load of the contacts, at phases `*b`.

    From the mean of the coefficient, weighted with the load.
    """
    normal = state.normal_force
    loaded = normal > 0.0
    return jnp.where(loaded, state.friction_force / jnp.where(loaded, normal, 1.0), 0.0)
