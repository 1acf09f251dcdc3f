"""Drives of several meshes on common shafts, from the input to the output: the quasi-static state."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Self

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import jnp
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.quasi_static import (
    Design,
    Models,
    Operation,
    State,
    cycle_nodes,
    state,
)
from pitchpoint.errors import InputError
from pitchpoint.loading.reactions import Bearing
from pitchpoint.loading.wind_up import wind_up
from pitchpoint.programs import program
from pitchpoint.status import Status

__all__ = ["Drive", "DriveCycle", "Stage", "chained", "drive_cycle", "output_wind_up"]

Each = Float[Array, "*#b"]


class Stage(eqx.Module):
    """One mesh at its place in a drive.

    Attributes:
        design: mesh, materials, oil, surfaces; what brakes the shafts is the drive's.
        shafts: of the drive, one for each coordinate of the mesh; static.
        turn: angle about the shafts of the frame of the mesh against that of the drive [rad].
        place: of the middle of the face along the shafts [m].
    """

    design: Design
    shafts: tuple[int, ...] = eqx.field(static=True)
    turn: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))
    place: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))


class Drive(eqx.Module):
    """Meshes one after the other, each driven by the shaft that the one before it loads.

    Attributes:
        stages: from the input to the output.
        drag: places where a shaft is braked against the housing; `between` and `seat.coordinate` count
            shafts, places of bearings along them are those of the drive.
        links: for each stage the shaft that drives it and the one that it loads; static.
        braked: shaft of each place; static.
    """

    stages: tuple[Stage, ...]
    drag: tuple[Drag, ...]
    links: tuple[tuple[int, int], ...] = eqx.field(static=True)
    braked: tuple[int, ...] = eqx.field(static=True)

    @property
    def ratios(self) -> Float[Array, " stage"]:
        """Speed of each stage's driver over that of the drive's input, not negative.

        From kinematics: the ratios of stages one behind the other multiply.
        """
        steps = [
            jnp.abs(stage.design.mesh.loaded @ stage.design.mesh.motion) for stage in self.stages
        ]
        return jnp.cumprod(jnp.stack([jnp.ones(()), *steps]))

    def driven_backwards(self) -> Self:
        """The same drive with its output driving; the same flanks touch."""
        every = zip(self.stages, self.links, strict=True)
        stages = tuple(_driven_by(stage, output) for stage, (_, output) in every)
        links = tuple((output, first) for first, output in reversed(self.links))
        return replace(self, stages=stages[::-1], links=links)


def _driven_by(stage: Stage, shaft: int) -> Stage:
    mesh = stage.design.mesh.driven_by(stage.shafts.index(shaft))
    return replace(stage, design=replace(stage.design, mesh=mesh))


def chained(stages: Sequence[Stage], drag: Sequence[Drag] = ()) -> Drive:
    """A drive of stages that follow each other.

    Args:
        stages: from the input to the output.
        drag: see `Drive`.

    Raises:
        InputError: a stage is not driven by the shaft that the one before it loads, or turns it the
            other way; a loss between two shafts.
    """
    if not stages:
        raise InputError("a drive needs at least one stage")
    for number, stage in enumerate(stages, 1):
        count = len(stage.design.mesh.coordinates)
        if len(set(stage.shafts)) != count:
            raise InputError(
                f"stage {number} has {count} bodies that move, and shafts = {stage.shafts} names "
                f"{len(set(stage.shafts))} of the drive"
            )
    links = [_ends(stage) for stage in stages]
    for number, (before, behind) in enumerate(pairwise(range(len(stages))), 2):
        if links[behind][0] != links[before][1]:
            raise InputError(
                f"stage {number} is driven by shaft {links[behind][0] + 1}, and the stage before it loads "
                f"shaft {links[before][1] + 1}"
            )
        first, second = (stages[k].design.mesh for k in (before, behind))
        if float((first.motion @ first.loaded) * (second.motion @ second.driver)) < 0.0:
            raise InputError(
                f"stage {number} turns its first shaft against the stage before it; the other flanks of its "
                'gears do not, gears.flank = "right"'
            )
    braked = tuple(map(_braked_shaft, drag))
    return Drive(tuple(stages), tuple(drag), tuple(links), braked)


def _ends(stage: Stage) -> tuple[int, int]:
    """Shaft that drives a stage, and the one that it loads."""
    mesh = stage.design.mesh
    first, last = (stage.shafts[int(np.argmax(on))] for on in (mesh.driver, mesh.loaded))
    return first, last


def _braked_shaft(drag: Drag) -> int:
    """The shaft that is braked against the housing."""
    shafts = np.flatnonzero(np.asarray(drag.between))
    if shafts.size != 1:
        raise InputError("a loss between two shafts does not belong to one stage of a drive")
    return int(shafts[0])


class DriveCycle(eqx.Module):
    """States of all meshes over their periods, each at every phase of those behind it.

    Between two meshes whose tooth numbers on their common shaft have no common divisor every pair of
    phases comes up, so means over both periods are those over a turn; the ripple is that of the worst
    meeting of phases.

    Attributes:
        states: of the stages from the input to the output, batch axes `*b`, then the nodes of the last
            stage, of the one before it, and so on down to the own.
        weights: of the nodes of each stage; they sum to one.
        speed: of the input [rad/s].
    """

    states: tuple[State, ...]
    weights: tuple[Float[Array, " node"], ...]
    speed: Each

    def mean(self, values: Float[Array, "*#b"], stage: int = 0) -> Each:
        """Mean over the periods of a stage and of those behind it.

        Args:
            values: of that stage, see `states`.
            stage: counted from zero.
        """
        for weight in self.weights[stage:]:
            values = values @ weight
        return values

    @property
    def input_torque(self) -> Float[Array, "*#b"]:
        """Torque at the input at every meeting of phases [N m]."""
        return self.states[0].input_torque

    @property
    def mean_input_torque(self) -> Each:
        """Mean torque at the input [N m]."""
        return self.mean(self.input_torque)

    @property
    def ripple(self) -> Each:
        """Largest less smallest torque at the input [N m], at the nodes.

        Source: Tian et al. (2024), eq. 10, for several meshes.
        """
        axes = tuple(range(-len(self.weights), 0))
        return jnp.max(self.input_torque, axis=axes) - jnp.min(self.input_torque, axis=axes)

    @property
    def mean_losses(self) -> Float[Array, "stage *#b"]:
        """Mean power lost in each stage and beside its teeth [W]."""
        return jnp.stack([self.mean(one.loss, k) for k, one in enumerate(self.states)])

    @property
    def mean_output_power(self) -> Each:
        """Mean power taken at the output [W]."""
        last = len(self.states) - 1
        return self.mean(self.states[last].output_power, last)

    @property
    def mean_efficiency(self) -> Each:
        """Energy out over energy in; NaN where no power is transmitted.

        From the balance of energy over the periods of all meshes.
        """
        power_in = self.mean_input_torque * self.speed
        transmits = self.mean_output_power > 0.0
        return jnp.where(
            transmits, self.mean_output_power / jnp.where(transmits, power_in, 1.0), jnp.nan
        )

    @property
    def status(self) -> Status:
        """What became of the balances: the worst code, the largest residual and the most iterations."""
        every = [one.balance.status for one in self.states]
        worst = [jnp.max(one.code) for one in every]
        return Status(
            code=jnp.max(jnp.stack(worst)),
            residual=jnp.max(jnp.stack([jnp.max(one.residual) for one in every])),
            iterations=jnp.max(jnp.stack([jnp.max(one.iterations) for one in every])),
        )

    @property
    def locked(self) -> Bool[Array, "*#b"]:
        """True where friction locks a mesh at some meeting of phases."""
        each = [
            jnp.any(one.balance.locked, axis=tuple(range(k - len(self.states), 0)))
            for k, one in enumerate(self.states)
        ]
        return jnp.any(jnp.stack(each), axis=0)


@program
def drive_cycle(
    drive: Drive, operation: Operation, models: Sequence[Models], nodes: int = 12
) -> DriveCycle:
    """States of all meshes of a drive, from its output to its input.

    The torque that a stage and the losses of its shaft ask for is the load of the stage before it.

    Args:
        drive: see `chained`.
        operation: load at the output, speed of the input, temperature of the oil [*b].
        models: laws of each stage.
        nodes: Gauss-Lobatto nodes in each segment of each period.

    From the balance of torques on every shaft, see `balance`.
    """
    if len(models) != len(drive.stages):
        raise InputError(f"{len(models)} models were given for {len(drive.stages)} stages")
    states: list[State] = []
    weights: list[Float[Array, " node"]] = []
    load, ratios = operation.load, drive.ratios
    for number in reversed(range(len(drive.stages))):
        stage, laws = drive.stages[number], models[number]
        phase, weight = cycle_nodes(stage.design.mesh, laws.sharing, nodes)
        behind = (1,) * (len(states) + 1)
        point = Operation(
            load=load[..., None],
            speed=(operation.speed * ratios[number]).reshape(*operation.speed.shape, *behind),
            temperature=operation.temperature.reshape(*operation.temperature.shape, *behind),
        )
        braked = _braked(drive, number, states[0] if states else None)
        found = state(replace(stage.design, drag=braked), point, phase, laws)
        states.insert(0, found)
        weights.insert(0, weight)
        load = found.input_torque
    return DriveCycle(tuple(states), tuple(weights), operation.speed)


def _braked(drive: Drive, number: int, behind: State | None) -> tuple[Drag, ...]:
    """Losses of the shaft that a stage loads, and of the input with the first stage, in its coordinates.

    Args:
        drive: of which.
        number: of the stage.
        behind: state of the stage behind it, which loads the bearings of the same shaft.
    """
    stage, (first, last) = drive.stages[number], drive.links[number]
    found = []
    for shaft, drag in zip(drive.braked, drive.drag, strict=True):
        if shaft != last and (number > 0 or shaft != first):
            continue
        seat = drag.seat
        if isinstance(seat, Bearing):
            beside = None
            if behind is not None and shaft == last:
                beside = _beside(seat, stage, drive.stages[number + 1], behind)
            seat = replace(_seated(seat, stage), beside=beside)
        between = jnp.stack([drag.between[one] for one in stage.shafts])
        found.append(replace(drag, between=between, seat=seat))
    return tuple(found)


def _seated(seat: Bearing, stage: Stage) -> Bearing:
    """A bearing of the drive as the mesh of a stage sees it."""
    other = None if seat.other is None else seat.other - stage.place
    coordinate = stage.shafts.index(seat.coordinate)
    return replace(seat, coordinate=coordinate, place=seat.place - stage.place, other=other)


def _beside(seat: Bearing, stage: Stage, behind: Stage, found: State) -> Float[Array, "3 *#b"]:
    """Load on a bearing by the stage behind, in the frame of a stage [N]."""
    mesh = behind.design.mesh
    x, y, z = _seated(seat, behind).borne(mesh, found.contacts, found.balance.load)
    angle = behind.turn - stage.turn
    cosine, sine = jnp.cos(angle), jnp.sin(angle)
    return jnp.stack([cosine * x - sine * y, sine * x + cosine * y, z])[..., None]


@program
def output_wind_up(
    drive: Drive, load: Each, models: Sequence[Models], nodes: int = 12
) -> tuple[Each, Each]:
    """Rotation of the output under load with the input held, and its stiffness, without friction.

    Stages are springs one behind the other: each adds its wind-up over the ratio between it and the
    output, and its load is less by the same ratio.

    Args:
        drive: see `chained`; all meshes with teeth that yield.
        load: torques at the output [*b] [N m].
        models: of each stage, for how teeth yield.
        nodes: in each segment of each period.

    Returns:
        Mean rotation [rad], and one over the mean compliance for a small change of the load [N m/rad].

    From virtual work: rotation and torque go with the ratio, so compliance with its square.
    """
    ratios, turned, slope = drive.ratios, jnp.zeros_like(load), jnp.zeros_like(load)
    for number, (stage, laws) in enumerate(zip(drive.stages, models, strict=True)):
        mesh, solids = stage.design.mesh, stage.design.solids
        # Rotation at the output for one of the shaft that the stage loads.
        step = ratios[-1] / ratios[number + 1]
        phase, weight = cycle_nodes(mesh, laws.sharing, nodes)
        found = wind_up(mesh, solids, laws.compliance, (load * step)[..., None], phase[None])
        turned = turned + step * (found.wind_up @ weight)
        slope = slope + step**2 * ((1.0 / found.stiffness) @ weight)
    return turned, 1.0 / slope
