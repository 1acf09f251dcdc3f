"""Figures of drives of several links over all meetings of their phases, by one program for many points."""

from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from jaxtyping import Array

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.efficiency.drive import (
    MET,
    Drive,
    DriveCycle,
    LinkModels,
    Locking,
    bearings_feel_link_behind,
    drive_cycle,
)
from pitchpoint.efficiency.meetings import FEW, Meetings, among_few, few_between
from pitchpoint.efficiency.quasi_static import (
    Engagement,
    Operation,
    State,
)
from pitchpoint.efficiency.rows import CHUNK, NODES
from pitchpoint.efficiency.summary import engaged, mean_friction
from pitchpoint.errors import InputError

if TYPE_CHECKING:
    from pitchpoint.efficiency.train_state import TrainState

__all__ = ["drive_figures", "drive_nodes", "mean_friction_of_drive", "points_per_batch"]

MOST_BYTES = 4e8
"""Memory that the states of one chunk of points may take [B]."""

Point = tuple[Drive, Operation]


def drive_nodes(links: int) -> int:
    """Nodes in each segment of each period; those of several links meet.

    Example:
        >>> drive_nodes(1), drive_nodes(2), drive_nodes(3)
        (24, 12, 12)
    """
    return NODES if links == 1 else NODES // 2


def points_per_batch(drive: Drive, models: Sequence[LinkModels]) -> int:
    """Points that are computed together, so that memory suffices.

    Args:
        drive: any.
        models: laws of each link.

    Raises:
        InputError: a single point takes too much memory.
    """
    needed = _memory(drive, models, drive_nodes(len(drive.links)))
    if needed > MOST_BYTES:
        raise InputError(
            f"the meetings of the phases of these stages would take {needed / 1e9:.2g} GB of memory, and "
            f"{MOST_BYTES / 1e9:g} GB is the most allowed; take fewer slices of their contact lines with "
            "models.slices",
            key="stages",
        )
    return min(CHUNK, int(MOST_BYTES // needed))


def _memory(drive: Drive, models: Sequence[LinkModels], nodes: int) -> float:
    """Memory for the states of a drive at one operating point [B], from that of compiled programs."""
    loads, needed = 1, 0.0
    for number in reversed(range(len(drive.links))):
        per_load, phases = drive.links[number].memory(models[number], nodes)
        needed += loads * per_load
        loads = phases * min(loads, FEW) if bearings_feel_link_behind(drive, number - 1) else FEW
    return needed


def drive_figures(
    points: Sequence[Point],
    models: Sequence[LinkModels],
    progress: Callable[[int], None] | None = None,
) -> dict[str, np.ndarray]:
    """Figures of many points, each quantity [point], [point, place] or [point, stage].

    Args:
        points: drives and operating points of equal static structure.
        models: laws of each link.
        progress: told the number of finished points after each chunk.

    From the states of `drive_cycle`, means and extremes over all meetings of their phases.
    """
    parts: list[dict[str, np.ndarray]] = []
    done = 0
    size = points_per_batch(points[0][0], models)
    for drive, operations in _of_one_drive(points, models):
        for start in range(0, len(operations), size):
            some = operations[start : start + size]
            parts.append(_chunk(drive, some, models, size))
            done += len(some)
            if progress is not None:
                progress(done)
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _of_one_drive(
    points: Sequence[Point], models: Sequence[LinkModels]
) -> Iterator[tuple[Drive, list[Operation]]]:
    """Neighbours that differ by their operating point alone: one program computes them together."""
    before: list[np.ndarray] = []
    group, number = [], 0
    for drive, operation in points:
        fixed = [*map(np.asarray, jax.tree.leaves(drive))]
        if not drive.links[-1].touching:
            fixed.append(np.asarray(operation.load))  # its shares are those of one load
        number += not (before and all(map(np.array_equal, before, fixed)))
        before = fixed
        group.append((number, drive, operation))
    for _, neighbours in groupby(group, key=lambda numbered: numbered[0]):
        alike = list(neighbours)
        yield alike[0][1], [operation for _, _, operation in alike]


def _chunk(
    drive: Drive, operations: Sequence[Operation], models: Sequence[LinkModels], size: int
) -> dict[str, np.ndarray]:
    """Figures of a few operating points of one drive, filled up by repetition."""
    filled = [*operations, *([operations[-1]] * (size - len(operations)))]
    stacked: Operation = jax.tree.map(lambda *v: array(np.stack(v)), *filled)
    output_link, nodes = drive.links[-1], drive_nodes(len(drive.links))
    laws: Any = models[-1]
    engagement = (
        None if output_link.touching else engaged(output_link.design, operations[0], laws, nodes)
    )
    figures, trains = jax.device_get(_figures(drive, stacked, tuple(models), nodes, engagement))
    for train in trains:
        figures |= _with_train(figures, *train)
    return {name: np.asarray(values)[: len(operations)] for name, values in figures.items()}


def _with_train(
    figures: dict[str, np.ndarray], levers: np.ndarray, friction: np.ndarray, lost: np.ndarray
) -> dict[str, np.ndarray]:
    """Figures with what locks one of the trains, see `nearest_to_jamming`; all along [point node]."""
    from pitchpoint.efficiency.train_summary import nearest_to_jamming

    near = nearest_to_jamming(np.moveaxis(levers, 2, 1), friction, lost)
    nearer = near.friction / near.limit > (
        figures["nearest_friction"] / figures["nearest_jamming_coefficient"]
    )
    return {
        "locked": figures["locked"] | near.held,
        "jamming_coefficient": np.minimum(figures["jamming_coefficient"], near.limit),
        "nearest_friction": np.where(nearer, near.friction, figures["nearest_friction"]),
        "nearest_jamming_coefficient": np.where(
            nearer, near.limit, figures["nearest_jamming_coefficient"]
        ),
    }


@program
def _figures(
    drive: Drive,
    operation: Operation,
    models: tuple[LinkModels, ...],
    nodes: int,
    engagement: Engagement | None,
) -> tuple[dict[str, Array], list[Locking]]:
    cycle = drive_cycle.function(drive, operation, models, nodes, engagement)
    points = operation.load.shape
    every = {
        **_of_drive(cycle),
        **_of_links(drive, cycle),
        **_of_sets(cycle),
        **_of_places(drive, cycle),
    }
    figures = {
        name: jnp.broadcast_to(values, (*points, *values.shape[len(points) :]))
        for name, values in every.items()
    }
    lockings = [link.locking(state) for link, state in zip(drive.links, cycle.states, strict=True)]
    return figures, [train for train in lockings if train is not None]


def _of_drive(cycle: DriveCycle) -> dict[str, Array]:
    """Figures of the whole drive [point]."""
    low, high = cycle.extremes(cycle.efficiency)
    # Between the nodes the interpolation may overshoot; no state is better than free of loss.
    most = jnp.max(cycle.efficiency, axis=MET)
    torque_low, torque_high = cycle.extremes(cycle.input_torque)
    acting, limit = _nearest_to_jamming(cycle)
    drag = [cycle.mean(state.drag_loss, k) for k, state in enumerate(cycle.states)]
    return {
        "mean_loss": jnp.sum(cycle.mean_losses, axis=0),
        "mean_drag_loss": sum(drag, jnp.zeros(())),
        "mean_efficiency": cycle.mean_efficiency,
        "min_efficiency": low,
        "max_efficiency": jnp.minimum(high, jnp.maximum(1.0, most)),
        "mean_input_torque": cycle.mean_input_torque,
        "min_input_torque": torque_low,
        "max_input_torque": torque_high,
        "mean_friction": mean_friction_of_drive(cycle),
        "residual": _worst(cycle, jnp.max, lambda state: state.status.residual),
        "iterations": jnp.max(jnp.stack([jnp.max(s.status.iterations) for s in cycle.states])),
        "locked": cycle.locked,
        "jamming_coefficient": _worst(cycle, jnp.min, lambda state: state.jamming),
        "nearest_friction": acting,
        "nearest_jamming_coefficient": limit,
        "largest_contact_force_ratio": _worst(
            cycle, jnp.max, lambda state: state.contact_force_ratio
        ),
        "meeting_error": cycle.meeting_error,
    }


def mean_friction_of_drive(found: DriveCycle) -> Array:
    """Friction coefficient weighted with the load of the contacts of all links [point].

    Args:
        found: states of a drive.
    """
    forces = _Forces.none(found.states[-1])
    every = [*zip(found.states, found.weights, strict=True)]
    for (state, weight), met in zip(every[:0:-1], found.meetings[-2::-1], strict=True):
        forces = forces.with_link(state, weight).met(met)
    drive_forces = forces.with_link(*every[0])
    loaded = drive_forces.normal > 0.0
    mean = jnp.where(
        loaded, drive_forces.rubbing / jnp.where(loaded, drive_forces.normal, 1.0), 0.0
    )
    return jnp.sum(mean, axis=(0, *MET))


class _Forces(NamedTuple):
    """Sums of the forces in the links behind that go with each load, see `few_between` [sum *b load behind].

    Attributes:
        normal: of the contacts [N].
        often: weight of each.
        rubbing: friction force times that weight [N].
    """

    normal: Array
    often: Array
    rubbing: Array

    @classmethod
    def none(cls, state: "State | TrainState") -> "_Forces":
        """Without any link."""
        zero = jnp.zeros((1, *state.input_torque.shape[:-1]))
        return cls(zero, zero + 1.0, zero)

    def with_link(self, state: "State | TrainState", weight: Array) -> "_Forces":
        """With those of a link at every node of it, along a last axis."""
        normal, often, rubbing = (values[..., None] for values in self)
        rubbing = (rubbing + often * state.friction_force) * weight
        return _Forces(normal + state.normal_force, often * weight, rubbing)

    def met(self, loads: Meetings) -> "_Forces":
        """The same by the loads of the next link, and few sums of normal forces."""
        low, high = (end(self.normal, axis=(0, -3, -2)) for end in (jnp.min, jnp.max))
        if not loads.kept:
            low, high = jnp.min(low, axis=-1, keepdims=True), jnp.max(high, axis=-1, keepdims=True)
        part = among_few(self.normal, low[..., None, None, :], high[..., None, None, :])
        often, rubbing = (
            loads.summed(jnp.sum(part * values, axis=1)) for values in (self.often, self.rubbing)
        )
        return _Forces(jnp.moveaxis(few_between(low, high), -1, 0)[..., None, :], often, rubbing)


def _worst(
    cycle: DriveCycle, reduce: Callable[..., Array], values: Callable[[Any], Array]
) -> Array:
    """Worst value of all links and meetings [point]."""
    worst = [reduce(_met(state, values(state)), axis=MET) for state in cycle.states]
    return reduce(jnp.stack(worst), axis=0)


def _met(state: "State | TrainState", values: Array) -> Array:
    """Values of a link at every meeting of phases."""
    return jnp.broadcast_to(values, state.input_torque.shape)


def _nearest_to_jamming(cycle: DriveCycle) -> tuple[Array, Array]:
    """Friction coefficient where a link is nearest to locking, and the one at which it locks there."""
    ends: list[tuple[Array, Array]] = []
    for state in cycle.states:
        acting, limit = (
            _met(state, values).reshape(*state.input_torque.shape[: -len(MET)], -1)
            for values in (state.largest_friction, state.jamming)
        )
        ends.append((acting, limit))
    acting, limit = (jnp.concatenate(parts, axis=-1) for parts in zip(*ends, strict=True))
    nearest = jnp.argmax(acting / limit, axis=-1)[..., None]
    friction, jamming = (jnp.take_along_axis(v, nearest, axis=-1)[..., 0] for v in (acting, limit))
    return friction, jamming


def _of_links(drive: Drive, cycle: DriveCycle) -> dict[str, Array]:
    """Figures of each link [point, stage]."""
    every = list(enumerate(cycle.states))
    torque = [cycle.mean(state.input_torque, k) for k, state in every]
    speed = [cycle.speed * ratio for ratio in drive.ratios[:-1]]
    friction = [cycle.mean(mean_friction(state), k) for k, state in every]
    drag = [cycle.mean(state.drag_loss, k) for k, state in every]
    return {
        name: jnp.stack(jnp.broadcast_arrays(*values), axis=-1)
        for name, values in {
            "stage_loss": [*cycle.mean_losses],
            "stage_drag_loss": drag,
            "stage_efficiency": [*cycle.link_efficiencies],
            "stage_friction": friction,
            "stage_input_torque": torque,
            "stage_speed": speed,
        }.items()
    }


def _of_sets(cycle: DriveCycle) -> dict[str, Array]:
    """Power that rolls through the meshes of each set [point, stage], NaN of other links, and in sum."""
    sets = {k: state for k, state in enumerate(cycle.states) if not isinstance(state, State)}
    if not sets:
        return {}
    powers = [
        cycle.mean(sets[k].latent_power, k) if k in sets else jnp.full((), jnp.nan)
        for k in range(len(cycle.states))
    ]
    stages = jnp.stack(jnp.broadcast_arrays(*powers), axis=-1)
    return {"stage_latent_power": stages, "latent_power": jnp.nansum(stages, axis=-1)}


def _of_places(drive: Drive, cycle: DriveCycle) -> dict[str, Array]:
    """Mean load on the bearing of each place [point, place]: those of the drive, then of its links."""
    of_drive: dict[int, Array] = {}
    of_links: list[Array] = []
    for k, loads in enumerate(cycle.pressed):
        means = [cycle.mean(jnp.asarray(load), k) for load in loads]
        mine = [place for place, owner in enumerate(drive.owners) if owner == k]
        of_drive |= dict(zip(mine, means, strict=False))
        of_links += means[len(mine) :]
    every = [*(of_drive[place] for place in sorted(of_drive)), *of_links]
    if not every:
        return {}
    return {"bearing_load": jnp.stack(jnp.broadcast_arrays(*every), axis=-1)}
