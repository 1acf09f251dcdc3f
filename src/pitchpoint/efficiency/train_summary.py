"""Figures of gear trains over their period, by one program for many operating points."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.efficiency.drag import at_rest
from pitchpoint.efficiency.quasi_static import Models, Operation, events_of, power_ratio
from pitchpoint.efficiency.rows import CHUNK
from pitchpoint.efficiency.summary import of_stacks, stacks
from pitchpoint.efficiency.train import Train
from pitchpoint.efficiency.train_cycle import NODES_OF_TRAINS, MeshState, TrainCycle, train_cycle
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.loading.loading_registry import LoadSharing

__all__ = [
    "NearestToJamming",
    "nearest_to_jamming",
    "torques_at_rest_of_train",
    "train_figures",
    "train_memory",
]

MOST_BYTES = 1e9
"""Memory that the states of one chunk of points may take [B]."""

ROUNDING = 1e-9
"""Part of the largest lever by which those of planets in phase differ."""

OF_A_LANE = 300.0
"""Memory for each contact at a phase [B], as the compiler tells."""


def train_figures(
    points: Sequence[tuple[Train, Operation]],
    models: Sequence[Models],
    progress: Callable[[int], None] | None = None,
) -> dict[str, np.ndarray]:
    """Figures of many points, each quantity [point] or [point, stage]; the stages are the meshes.

    Args:
        points: trains and operating points of equal static structure.
        models: laws of each mesh.
        progress: told the number of finished points after each chunk.

    From the states of `train_cycle` over the period of the train.
    """
    laws = tuple(models)
    points = [(train.without_names(), operation) for train, operation in points]
    size = min(CHUNK, int(MOST_BYTES // train_memory(points[0][0], laws)))
    if size == 0:
        raise InputError(
            "the phases at which the meshes of this train come together would take more than "
            f"{MOST_BYTES / 1e9:g} GB of memory; take fewer slices of their contact lines with models.slices",
            key="models.slices",
        )
    figures = of_stacks(
        (_figures(chunk[0], chunk[1], laws), used) for chunk, used in stacks(points, size, progress)
    )
    near = nearest_to_jamming(
        *(figures.pop(name) for name in ("levers", "largest_friction", "lost"))
    )
    return {
        **figures,
        "locked": figures["locked"] | near.held,
        "jamming_coefficient": near.limit,
        "nearest_jamming_coefficient": near.limit,
        "nearest_friction": near.friction,
    }


class NearestToJamming(NamedTuple):
    """Where trains are nearest to being locked [point].

    Attributes:
        friction: largest coefficient there.
        limit: from which on friction locks the train.
        held: True where no forces were found at a phase for friction beyond that limit: they run away there.
    """

    friction: Float[np.ndarray, " point"]
    limit: Float[np.ndarray, " point"]
    held: Bool[np.ndarray, " point"]


def nearest_to_jamming(
    levers: Float[np.ndarray, "point 2 node copy body mesh"],
    friction: Float[np.ndarray, "point node"],
    lost: Bool[np.ndarray, "point node"],
) -> NearestToJamming:
    """Where trains are nearest to being locked.

    Args:
        levers: of the forces, see `TrainCycle.levers`.
        friction: largest coefficient.
        lost: True where no forces were found.
    """
    limit = jamming_coefficients(levers)
    at = np.argmin(limit, axis=-1)[:, None]
    acting, nearest = (np.take_along_axis(values, at, -1)[:, 0] for values in (friction, limit))
    return NearestToJamming(acting, nearest, np.any(lost & (friction >= limit), axis=-1))


def torques_at_rest_of_train(
    train: Train, operation: Operation, models: Sequence[Models]
) -> tuple[Float[np.ndarray, " point"], Float[np.ndarray, " point"]]:
    """Torque at which the driving body begins to turn from rest: mean over the phases, and largest [N m].

    Args:
        train: for back-driving `train.driven_backwards()`.
        operation: operating points [point], see `running_torque.torques_at_rest`.
        models: laws of each mesh.

    Returns:
        Both torques; NaN where friction holds the train whatever the torque.

    From the balance in motion, with what brakes bodies beside the teeth as where they are about to move.
    """
    resting = replace(train, drag=at_rest(train.drag))
    every = zip(*jax.tree.map(np.asarray, jax.tree.leaves(operation)), strict=True)
    points = [(resting, Operation(*map(array, values))) for values in every]
    figures = train_figures(points, models)
    return figures["mean_input_torque"], figures["max_input_torque"]


def train_memory(train: Train, models: Sequence[Models]) -> float:
    """Memory for the states of a train at one operating point [B], from that of compiled programs."""
    nodes, lanes = 0, 0
    for mesh, laws in zip(train.meshes, models, strict=True):
        contacts, phases = eqx.filter_eval_shape(_sizes, mesh.design.mesh, laws.sharing)
        copies = 1 if train.alike else mesh.places
        nodes += mesh.most_periods * copies * NODES_OF_TRAINS * phases.size
        lanes += mesh.places * contacts.size
    return nodes * lanes * OF_A_LANE


def _sizes(mesh: Mesh, sharing: LoadSharing) -> tuple[Array, Array]:
    """Contacts at one phase, and phases at which something begins or ends, of which the shapes count."""
    return mesh.contacts(jnp.zeros(())).weight, events_of(mesh, sharing)


def jamming_coefficients(
    levers: Float[np.ndarray, "point 2 node copy body mesh"],
) -> Float[np.ndarray, "point node"]:
    """Smallest coefficient of friction, the same at all contacts, from which on a train is locked.

    Args:
        levers: of the forces, see `TrainCycle.levers`.

    Returns:
        At each node; infinite where friction pushes on.

    From the smallest positive root of det(A + mu B), an eigenvalue of A^-1 B, of any planet: the first one
    that friction holds would have the others pull at it.
    """
    # Planets in phase, and places without one, are as the first one, and take no time.
    size = ROUNDING * np.abs(levers).max()
    apart = np.abs(levers - levers[:, :, :, :1]).max(axis=(0, 1, 2, 4, 5)) > size
    apart[0] = True
    levers = levers[:, :, :, apart]
    roots = np.linalg.eigvals(-np.linalg.solve(levers[:, 0], levers[:, 1]))
    real = np.where(np.abs(roots.imag) <= 1e-9 * np.abs(roots.real), roots.real, 0.0)
    largest = np.max(real, axis=(-1, -2))
    infinite = np.full(largest.shape, np.inf)
    return np.asarray(np.divide(1.0, largest, out=infinite, where=largest > 0.0))


@program
def _figures(trains: Train, operations: Operation, models: tuple[Models, ...]) -> dict[str, Array]:
    def figures(train: Train, operation: Operation) -> dict[str, Array]:
        cycle = train_cycle.function(train, operation, models, NODES_OF_TRAINS)
        return {**_of_train(cycle), **_of_meshes(cycle), **_of_places(cycle)}

    result: dict[str, Array] = eqx.filter_vmap(figures)(trains, operations)
    return result


def _of_train(cycle: TrainCycle) -> dict[str, Array]:
    efficiency = power_ratio(cycle.output_power, cycle.input_power)
    low, high = cycle.extremes(efficiency)
    torque_low, torque_high = cycle.extremes(cycle.input_torque)
    return {
        "mean_loss": cycle.mean(cycle.loss),
        "mean_drag_loss": cycle.mean(cycle.drag_loss),
        "latent_power": cycle.mean(_latent_power(cycle.meshes)),
        "mean_efficiency": cycle.mean_efficiency,
        "min_efficiency": low,
        # Between the nodes the interpolation may overshoot; no state is better than free of loss.
        "max_efficiency": jnp.minimum(high, jnp.maximum(1.0, jnp.max(efficiency))),
        "mean_input_torque": cycle.mean(cycle.input_torque),
        "min_input_torque": torque_low,
        "max_input_torque": torque_high,
        "mean_friction": cycle.mean(_mean_friction(cycle.meshes)),
        "residual": jnp.max(cycle.status.residual),
        "iterations": cycle.status.iterations,
        "locked": cycle.locked,
        "largest_contact_force_ratio": jnp.max(cycle.contact_force_ratio),
        "largest_friction": cycle.largest_friction,
        "lost": cycle.status.code == int(Code.NOT_CONVERGED),
        "levers": cycle.levers,
    }


def _latent_power(meshes: Sequence[MeshState]) -> Float[Array, " node"]:
    """Power that rolls through all meshes [W]."""
    powers = [mesh.latent_power for mesh in meshes]
    return sum(powers[1:], powers[0])


def _mean_friction(meshes: Sequence[MeshState]) -> Float[Array, " node"]:
    """Coefficient weighted with the load of all contacts."""
    loads = [mesh.normal_force for mesh in meshes]
    rubbing = [mesh.friction_force for mesh in meshes]
    load = sum(loads[1:], loads[0])
    return sum(rubbing[1:], rubbing[0]) / jnp.where(load > 0.0, load, 1.0)


def _of_meshes(cycle: TrainCycle) -> dict[str, Array]:
    """Figures of each mesh, of all its copies, with speeds against its carrier [stage]."""
    losses = [cycle.mean(mesh.loss) for mesh in cycle.meshes]
    driving = [cycle.mean(mesh.input_torque) for mesh in cycle.meshes]
    speeds = [mesh.speed for mesh in cycle.meshes]
    powers = [torque * speed for torque, speed in zip(driving, speeds, strict=True)]
    return {
        "stage_loss": jnp.stack(losses),
        "stage_drag_loss": jnp.zeros(len(losses)),
        "stage_efficiency": _of_powers(jnp.stack(powers), jnp.stack(losses)),
        "stage_friction": jnp.stack([cycle.mean(_mean_friction([mesh])) for mesh in cycle.meshes]),
        "stage_input_torque": jnp.stack(driving),
        "stage_speed": jnp.stack(speeds),
        "stage_latent_power": jnp.stack([cycle.mean(mesh.latent_power) for mesh in cycle.meshes]),
    }


def _of_places(cycle: TrainCycle) -> dict[str, Array]:
    """Mean load on the bearing of each place [place]."""
    if not cycle.pressed:
        return {}
    return {"bearing_load": jnp.stack([cycle.mean(load) for load in cycle.pressed])}


def _of_powers(
    driving: Float[Array, " mesh"], lost: Float[Array, " mesh"]
) -> Float[Array, " mesh"]:
    """Efficiency of meshes by the power of their driving members, negative where these are driven."""
    power_in = jnp.where(driving > 0.0, driving, lost - driving)
    return 1.0 - lost / jnp.where(power_in > 0.0, power_in, jnp.nan)
