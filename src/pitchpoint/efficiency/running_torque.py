"""Torque that a drive takes to run without load, and to start from rest."""

from collections.abc import Sequence
from dataclasses import replace

from jaxtyping import Array, Float

from pitchpoint._jax import jnp
from pitchpoint.core.programs import program
from pitchpoint.efficiency.drag import at_rest
from pitchpoint.efficiency.drive import Drive, LinkModels, LinkPlace
from pitchpoint.efficiency.quasi_static import Design, Engagement, Models, Operation, cycle

__all__ = [
    "no_load_torque",
    "torques_at_rest",
    "torques_at_rest_of_drive",
]

Each = Float[Array, "*b"]


@program
def no_load_torque(
    design: Design, operation: Operation, models: Models, engaged: Engagement | None = None
) -> Each:
    """Mean torque of the driver without load on the driven coordinate [N m].

    The teeth carry the drag of the driven coordinate and lose power too.

    Args:
        design: mesh, materials, lubricant, surfaces, and the drag; without drag the torque is zero.
        operation: operating points [*b]; their load is left out.
        models: laws.
        engaged: contacts and shares without load, where they are known already.

    Returns:
        Torque, shape [*b]; NaN where friction locks the mesh.

    From the balance of a mesh whose teeth carry the drag alone, see `tooth_load`.
    """
    idle = replace(operation, load=jnp.zeros_like(operation.load))
    return cycle(design, idle, models, engaged=engaged).mean_input_torque


@program
def torques_at_rest(
    design: Design, operation: Operation, models: Models, engaged: Engagement | None = None
) -> tuple[Each, Each]:
    """Torque at which the driver begins to turn from rest: its mean over the phases, and the largest [N m].

    Beside the teeth act the breakaway and seal torques and the bearings at speed zero, where
    Palmgren's torque of the lubricant keeps its lower value; nothing churns. Laws of tooth friction do
    not hold at rest: the law is taken at the speed of the operating point, a creeping one.

    Args:
        design: mesh, materials, lubricant, surfaces, drag. For back-driving the same drive with
            its mesh driven from the output: the loaded coordinate is then the input, whose breakaway
            torque the teeth carry.
        operation: operating points [*b]; with load zero for the starting torque of a catalogue.
        models: laws.
        engaged: contacts and shares at that load, where they are known already.

    Returns:
        Both torques, shape [*b]; NaN where friction holds the drive whatever the torque.

    From the same balance with the bodies about to move; Palmgren (1959) for the bearings.
    """
    resting = replace(design, drag=at_rest(design.drag))
    mesh_cycle = cycle(resting, operation, models, engaged=engaged)
    return mesh_cycle.mean_input_torque, mesh_cycle.extremes(mesh_cycle.state.input_torque)[1]


def torques_at_rest_of_drive(
    drive: Drive, operation: Operation, models: Sequence[LinkModels]
) -> tuple[Each, Each]:
    """The same of a drive of several links, at its input [N m].

    What starts a link is the load of the one before it, by the means of all links or with each at its worst
    phase. Bearings of a shaft feel the teeth of the link that overcomes them, not those of the link behind,
    which carry little then.

    Args:
        drive: see `chained`; for back-driving `drive.driven_backwards()`.
        operation: operating points [*b], see `torques_at_rest`; their load is that of the output.
        models: laws of each link.

    Returns:
        Both torques, shape [*b]; NaN where friction holds a link whatever the torque.

    From the torques of the links, from the output to the input.
    """
    mean, largest, ratios = operation.load, operation.load, drive.ratios
    for number, link in reversed([*enumerate(drive.links)]):
        point = replace(operation, speed=operation.speed * ratios[number])
        place, laws = LinkPlace(drive, number), models[number]
        mean = link.at_rest(place, replace(point, load=mean), laws)[0]
        largest = link.at_rest(place, replace(point, load=largest), laws)[1]
    return mean, largest
