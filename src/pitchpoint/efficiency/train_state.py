"""A gear train as one stage of a drive: its states under all loads that the stages behind it make."""

from collections.abc import Sequence

import equinox as eqx
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.efficiency.quasi_static import Models, Operation
from pitchpoint.efficiency.train import Train
from pitchpoint.efficiency.train_cycle import TrainCycle, train_cycle
from pitchpoint.status import Code, Status

__all__ = ["TrainState", "train_state"]

Each = Float[Array, "*b"]


class TrainState(eqx.Module):
    """State of a train at operating points and the nodes of its period `*b`, read as `quasi_static.State` is.

    Attributes:
        input_torque: torque of the driving body in its direction of motion [N m].
        input_power, output_power: put in, and taken at the loaded body [W].
        loss: power lost in all contacts and beside the teeth [W].
        drag_loss: the part beside the teeth [W].
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
    normal_force: Each
    friction_force: Each
    contact_force_ratio: Each
    largest_friction: Each
    pressed: tuple[Each, ...]
    levers: Float[Array, "*b 2 body mesh"]
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
        found = train_cycle.function(train, Operation(*values), models, nodes)
        return _state(found), found.weight

    found, weight = jax.vmap(at_point)(*(values.ravel() for values in points))
    return jax.tree.map(lambda leaf: leaf.reshape(*shape, *leaf.shape[1:]), found), weight[0]


def _state(found: TrainCycle) -> TrainState:
    normal, friction = (
        sum(getattr(one, name) for one in found.meshes)
        for name in ("normal_force", "friction_force")
    )
    return TrainState(
        found.input_torque,
        found.input_power,
        found.output_power,
        found.loss,
        found.drag_loss,
        normal,
        friction,
        found.contact_force_ratio,
        found.largest_friction,
        found.pressed,
        jnp.moveaxis(found.levers, 0, 1),
        found.status,
    )
