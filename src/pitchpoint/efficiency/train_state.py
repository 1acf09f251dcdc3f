"""A gear train as a link of a drive: its states under all loads that the links behind it make."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.status import Code, Status
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.efficiency.drive import (
    MET,
    DriveLink,
    LinkPlace,
    Locking,
    UnderLoad,
    overcome_losses,
)
from pitchpoint.efficiency.quasi_static import Engagement, Models, Operation
from pitchpoint.efficiency.train import Train
from pitchpoint.efficiency.train_cycle import NODES_OF_TRAINS, TrainCycle, train_cycle
from pitchpoint.efficiency.train_summary import torques_at_rest_of_train, train_memory

__all__ = ["TrainLink", "TrainState", "train_state"]

Each = Float[Array, "*b"]


class TrainState(eqx.Module):
    """State of a train at operating points and the nodes of its period `*b`, read as `quasi_static.State` is.

    Attributes:
        input_torque: torque of the driving body in its direction of motion [N m].
        input_power, output_power: put in, and taken at the loaded body [W].
        loss: power lost in all contacts and beside the teeth [W].
        drag_loss: the part beside the teeth [W].
        latent_power: that rolls through all meshes, see `MeshState` [W].
        normal_force, friction_force: sums over all contacts, in size [N].
        contact_force_ratio: largest normal force of a mesh over that without friction.
        largest_friction: coefficient of all contacts.
        pressed: load on the bearing of each place, see `TrainCycle` [N].
        levers: see `TrainCycle`, of which follows what locks the train.
        status: of the search for forces.
    """

    input_torque: Each
    input_power: Each
    output_power: Each
    loss: Each
    drag_loss: Each
    latent_power: Each
    normal_force: Each
    friction_force: Each
    contact_force_ratio: Each
    largest_friction: Each
    pressed: tuple[Each, ...]
    levers: Float[Array, "*b 2 copy body mesh"]
    status: Status

    @property
    def locked(self) -> Bool[Array, "*b"]:
        """True where friction holds the train by the signs of its forces, see `TrainCycle.locked`."""
        return self.status.code == int(Code.LOCKED)

    @property
    def jamming(self) -> Each:
        """Infinite: of a train it follows from its levers, see `train_summary.nearest_to_jamming`."""
        return jnp.full_like(self.input_torque, jnp.inf)


def train_state(
    train: Train, operation: Operation, models: Sequence[Models], nodes: int
) -> tuple[TrainState, Float[Array, " node"]]:
    """States of a train at operating points over its period, and the weights of its nodes.

    Args:
        train: see `gear_train`.
        operation: operating points [*#b].
        models: laws of each mesh.
        nodes: Gauss-Lobatto nodes in each segment.

    Returns:
        States [*b node] and weights, which sum to one.

    From `train_cycle` of every point.
    """
    points = jnp.broadcast_arrays(operation.load, operation.speed, operation.temperature)
    shape = points[0].shape

    def at_point(*values: Float[Array, ""]) -> tuple[TrainState, Float[Array, " node"]]:
        cycle = train_cycle.function(train, Operation(*values), models, nodes)
        return _state(cycle), cycle.weight

    states, weight = jax.vmap(at_point)(*(values.ravel() for values in points))
    return jax.tree.map(lambda leaf: leaf.reshape(*shape, *leaf.shape[1:]), states), weight[0]


def _state(cycle: TrainCycle) -> TrainState:
    normal, friction = (
        sum(getattr(mesh, name) for mesh in cycle.meshes)
        for name in ("normal_force", "friction_force")
    )
    return TrainState(
        cycle.input_torque,
        cycle.input_power,
        cycle.output_power,
        cycle.loss,
        cycle.drag_loss,
        sum((mesh.latent_power for mesh in cycle.meshes), jnp.zeros_like(cycle.drag_loss)),
        normal,
        friction,
        cycle.contact_force_ratio,
        cycle.largest_friction,
        cycle.pressed,
        jnp.moveaxis(cycle.levers, 0, 1),
        cycle.status,
    )


class TrainLink(DriveLink):
    """A train at its place in a drive, which the bodies at its ends join to two shafts.

    Attributes:
        design: the train.
        shafts: the one that drives it and the one that it loads; static.
    """

    design: Train
    shafts: tuple[int, ...] = eqx.field(static=True)

    presses_bearings: ClassVar[bool] = False

    @property
    def bodies(self) -> int:
        """See `DriveLink`."""
        return 2

    @property
    def ends(self) -> tuple[int, int]:
        """See `DriveLink`."""
        turned, loaded = self.shafts
        return turned, loaded

    @property
    def step(self) -> Float[Array, ""]:
        """See `DriveLink`."""
        return jnp.abs(1.0 / self.design.ratio)

    @property
    def touching(self) -> bool:
        """See `DriveLink`."""
        return True

    def senses(self, before: float) -> tuple[float, float]:
        """See `DriveLink`."""
        return before, before * float(jnp.sign(self.design.ratio))

    def driven_backwards(self) -> "TrainLink":
        """See `DriveLink`."""
        return TrainLink(self.design.driven_backwards(), self.shafts[::-1])

    def under_load(
        self,
        place: LinkPlace,
        point: Operation,
        models: tuple[Models, ...],
        nodes: int,
        known: Engagement | None,
    ) -> UnderLoad:
        """See `DriveLink`; a train has nodes of its own."""
        at_loads = jax.tree.map(lambda leaf: leaf[..., 0], point)
        states, weight = train_state(self._braked(place), at_loads, models, NODES_OF_TRAINS)
        return UnderLoad(states, states.pressed, weight, NODES_OF_TRAINS)

    def at_rest(
        self, place: LinkPlace, point: Operation, models: tuple[Models, ...]
    ) -> tuple[Array, Array]:
        """See `DriveLink`."""
        mean, largest = torques_at_rest_of_train(self._braked(place), point, models)
        return array(mean), array(largest)

    def memory(self, models: tuple[Models, ...], nodes: int) -> tuple[float, int]:
        """See `DriveLink`."""
        return train_memory(self.design, models), 0

    def locking(self, state: TrainState) -> Locking:
        """See `DriveLink`."""
        lost = state.status.code == int(Code.NOT_CONVERGED)
        count = len(state.input_torque.shape) - len(MET)
        levers, friction, lost = (
            values.reshape(*values.shape[:count], -1, *values.shape[count + len(MET) :])
            for values in (state.levers, state.largest_friction, lost)
        )
        return levers, friction, lost

    def _braked(self, place: LinkPlace) -> Train:
        """The train with the losses of the drive that it overcomes before its own."""
        train, drive = self.design, place.drive
        names = dict(zip(self.shafts, (train.turned, train.loaded), strict=True))
        drags, pairs = [], []
        for number in overcome_losses(drive, place.number):
            drag, shafts = drive.drag[number], drive.braked[number]
            body, against = *(names[shaft] for shaft in shafts), *[HOUSING] * (2 - len(shafts))
            sides = drag.between[shafts[0]] * jnp.array([1.0, -1.0])
            drags.append(replace(drag, between=sides, seat=None))
            pairs.append((body, against))
        return replace(train, drag=(*drags, *train.drag), braked=(*pairs, *train.braked))
