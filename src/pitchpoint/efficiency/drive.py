"""Drives of stages on common shafts, from the input to the output: the quasi-static state."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import demand_double, jax, jnp
from pitchpoint.brief import brief
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.efficiency.drag import Drag, bearing_loads
from pitchpoint.efficiency.meetings import FEW, Meetings, meetings, unmet
from pitchpoint.efficiency.quasi_static import (
    Design,
    Engagement,
    Models,
    Operation,
    State,
    cycle_nodes,
    extremes,
    power_ratio,
    state,
)
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.pairs import touching
from pitchpoint.loading.reactions import Bearing
from pitchpoint.programs import program
from pitchpoint.status import Status

if TYPE_CHECKING:
    from pitchpoint.efficiency.train import Train
    from pitchpoint.efficiency.train_state import TrainState

__all__ = [
    "MET",
    "NODES_OF_TRAINS",
    "Drive",
    "DriveCycle",
    "NextStage",
    "Stage",
    "StageModels",
    "braked",
    "braked_train",
    "chained",
    "drive_cycle",
    "felt",
    "owner",
]

Each = Float[Array, "*#b"]
Met = Float[Array, "*#b load behind node"]
Values = Float[Array, "..."]

StageModels = Models | tuple[Models, ...]
"""Laws of a stage, of a train those of each mesh."""

MET = (-3, -2, -1)
"""Axes of the states of a stage along which loads and phases meet."""

NODES_OF_TRAINS = 6
"""Nodes in each segment between events of a train, of which planets out of phase make many."""


class Stage(eqx.Module):
    """One mesh at its place in a drive, or meshes that turn together, as a planetary set.

    Attributes:
        design: mesh, materials, oil, surfaces, and what brakes its bodies against each other, or a train;
            what brakes the shafts is the drive's.
        shafts: of the drive, one for each coordinate of the mesh, of a train those that drive it and that it
            loads; static.
        turn: angle about the shafts of the frame of the mesh against that of the drive [rad].
        place: of the middle of the face along the shafts [m].
    """

    design: "Design | Train"
    shafts: tuple[int, ...] = eqx.field(static=True)
    turn: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))
    place: Float[Array, ""] = eqx.field(default_factory=lambda: jnp.zeros(()))

    @property
    def train(self) -> "Train | None":
        """The meshes that turn together; None of one mesh."""
        return None if isinstance(self.design, Design) else self.design

    @property
    def alone(self) -> Design:
        """The design of the only mesh; there is none where several turn together."""
        assert isinstance(self.design, Design)
        return self.design

    @property
    def mesh(self) -> Mesh:
        """The only mesh."""
        return self.alone.mesh

    @property
    def ends(self) -> tuple[int, int]:
        """Shaft that drives the stage, and the one that it loads."""
        if self.train is not None:
            return self.shafts[0], self.shafts[1]
        first, last = (
            self.shafts[int(np.argmax(on))] for on in (self.mesh.driver, self.mesh.loaded)
        )
        return first, last

    @property
    def step(self) -> Float[Array, ""]:
        """Speed of the shaft that the stage loads for a unit speed of its driver, not negative."""
        if self.train is not None:
            return jnp.abs(1.0 / self.train.ratio)
        return jnp.abs(self.mesh.loaded @ self.mesh.motion)

    @property
    def touching(self) -> bool:
        """True if what the stage does is smooth between events, since its rigid flanks all touch."""
        return self.train is not None or touching(self.mesh)

    def driven_backwards(self) -> "Stage":
        """The same stage with its output driving; the same flanks touch."""
        if self.train is not None:
            return replace(self, design=self.train.driven_backwards(), shafts=self.shafts[::-1])
        mesh = self.mesh.driven_by(self.shafts.index(self.ends[1]))
        return replace(self, design=replace(self.alone, mesh=mesh))


class Drive(eqx.Module):
    """Stages one after the other, each driven by the shaft that the one before it loads.

    Attributes:
        stages: from the input to the output.
        drag: places where a shaft is braked against the housing, or against another of its stage;
            `between` and `seat.coordinate` count shafts, places of bearings along them are those of the
            drive.
        links: for each stage the shaft that drives it and the one that it loads; static.
        owners: for each place the stage that overcomes it: the one that loads the shaft, the first one for
            the input; of a shaft between a train and one mesh that mesh, whose teeth press its bearings;
            static.
        braked: for each place the shafts that it brakes; static.
    """

    stages: tuple[Stage, ...]
    drag: tuple[Drag, ...]
    links: tuple[tuple[int, int], ...] = eqx.field(static=True)
    owners: tuple[int, ...] = eqx.field(static=True)
    braked: tuple[tuple[int, ...], ...] = eqx.field(static=True)

    def __repr__(self) -> str:
        return brief(self)

    @property
    def ratios(self) -> Float[Array, " stage"]:
        """Speed of each stage's driver over that of the drive's input, not negative.

        From kinematics: the ratios of stages one behind the other multiply.
        """
        return jnp.cumprod(jnp.stack([jnp.ones(()), *(stage.step for stage in self.stages)]))

    def driven_backwards(self) -> "Drive":
        """The same drive with its output driving; the same flanks touch."""
        return chained([stage.driven_backwards() for stage in self.stages[::-1]], self.drag)


def chained(stages: Sequence[Stage], drag: Sequence[Drag] = ()) -> Drive:
    """A drive of stages that follow each other.

    Args:
        stages: from the input to the output.
        drag: see `Drive`.

    Raises:
        InputError: a stage is not driven by the shaft that the one before it loads, or turns it the
            other way; a loss between shafts that no stage has in common.
    """
    if not stages:
        raise InputError("a drive needs at least one stage")
    for number, stage in enumerate(stages, 1):
        count = 2 if stage.train is not None else len(stage.mesh.coordinates)
        if len(set(stage.shafts)) != count:
            raise InputError(
                f"stage {number} has {count} bodies that move, and shafts = {stage.shafts} names "
                f"{len(set(stage.shafts))} of the drive"
            )
    links = [stage.ends for stage in stages]
    for number, (before, behind) in enumerate(pairwise(links), 2):
        if behind[0] != before[1]:
            raise InputError(
                f"stage {number} is driven by shaft {behind[0] + 1}, and the stage before it loads shaft "
                f"{before[1] + 1}"
            )
    _check_senses(stages)
    owners = tuple(owner(one, stages) for one in drag)
    braked = tuple(_braked_shafts(one) for one in drag)
    return Drive(tuple(stages), tuple(drag), tuple(links), owners, braked)


def _check_senses(stages: Sequence[Stage]) -> None:
    """InputError if a mesh turns its first shaft the other way; a train may turn either way."""
    sense = 0.0
    for number, stage in enumerate(stages, 1):
        if stage.train is not None:
            sense *= float(jnp.sign(stage.train.ratio))
            continue
        mesh = stage.mesh
        if sense * float(mesh.motion @ mesh.driver) < 0.0:
            raise InputError(
                f"stage {number} turns its first shaft against the stage before it; the other flanks of its "
                'gears do not, gears.flank = "right"'
            )
        sense = float(jnp.sign(mesh.motion @ mesh.loaded))


def _braked_shafts(drag: Drag) -> tuple[int, ...]:
    return tuple(int(shaft) for shaft in np.flatnonzero(np.asarray(drag.between)))


def owner(drag: Drag, stages: Sequence[Stage]) -> int:
    """Number of the stage that overcomes a loss, see `Drive.owners`.

    Args:
        drag: where it arises, in the shafts of the drive.
        stages: from the input to the output.

    Raises:
        InputError: it is between shafts that no stage has in common.

    From the order of the balances, which goes from the output to the input.
    """
    shafts = {*_braked_shafts(drag)}
    having = [number for number, stage in enumerate(stages) if shafts <= {*stage.shafts}]
    if not having:
        raise InputError("is between shafts that no stage of the drive has in common")
    having = [number for number in having if stages[number].train is None] or having
    loading = [number for number in having if stages[number].ends[1] in shafts]
    return (loading or having)[0]


class DriveCycle(eqx.Module):
    """States of all meshes over their periods, each under the loads that phases of those behind it make.

    Between two meshes whose tooth numbers on their common shaft have no common divisor every pair of
    phases comes up, so means over both periods are those over a turn; the ripple is that of the worst
    meeting of phases.

    Attributes:
        states: of the stages from the input to the output, batch axes `*b load behind node`: loads, phases of
            the stage behind as far as they are kept, see `Meetings`, and nodes of the own period.
        pressed: for each stage the loads on the bearings of the places that it overcomes: those of the
            drive in order, then its own [N].
        weights: of the nodes of each stage; they sum to one.
        meetings: loads of each stage, and how often they are.
        speed: of the input [rad/s].
        nodes: static, for each stage nodes in each segment between events.
        smooth: static, for each stage True if its states are smooth between events.
    """

    states: "tuple[State | TrainState, ...]"
    pressed: tuple[tuple[Values, ...], ...]
    weights: tuple[Float[Array, " _"], ...]
    meetings: tuple[Meetings, ...]
    speed: Each
    nodes: tuple[int, ...] = eqx.field(static=True)
    smooth: tuple[bool, ...] = eqx.field(static=True)

    def mean(self, values: Values, stage: int = 0) -> Each:
        """Mean over the periods of a stage and of those behind it.

        Args:
            values: of that stage, see `states`.
            stage: counted from zero.
        """
        return jnp.sum(self._under_loads(values, stage) * self.meetings[stage].weight, (-2, -1))

    def _under_loads(self, values: Values, stage: int) -> Float[Array, "*b load behind"]:
        """Mean over the own period of a stage."""
        every = self.states[stage].input_torque
        values = jnp.broadcast_to(values, jnp.broadcast_shapes(values.shape, every.shape))
        return values @ self.weights[stage]

    @property
    def input_torque(self) -> Float[Array, "*#b load behind node"]:
        """Torque at the input under every load of the first stage at every phase of it [N m]."""
        return self.states[0].input_torque

    @property
    def mean_input_torque(self) -> Each:
        """Mean torque at the input [N m]."""
        return self.mean(self.input_torque)

    def extremes(self, values: Met) -> tuple[Each, Each]:
        """Smallest and largest value over all meetings of phases, between the nodes too.

        Args:
            values: of the first stage, see `states`.

        From the extremes over the phase of one stage after the other, see `quasi_static.extremes`: a stage
        takes most where the one behind it does, since more load is not carried by less torque.
        """
        phases = slice(2 if self.meetings[0].kept else 1)
        return _extremes(values, self.nodes[phases], self.smooth[phases])

    @property
    def ripple(self) -> Each:
        """Largest less smallest torque at the input [N m].

        Source: Tian et al. (2024), eq. 10, for several meshes.
        """
        low, high = self.extremes(self.input_torque)
        return high - low

    @property
    def efficiency(self) -> Float[Array, "*#b load behind node"]:
        """Power out over power in at every state of the first stage; NaN where no power is transmitted.

        From the balance of power there.
        """
        power_out = self.mean_output_power[..., None, None, None]
        return power_ratio(power_out, self.states[0].input_power)

    @property
    def mean_losses(self) -> Float[Array, "stage *#b"]:
        """Mean power lost in each stage and beside its teeth [W]."""
        return jnp.stack([self.mean(one.loss, k) for k, one in enumerate(self.states)])

    @property
    def meeting_error(self) -> Each:
        """How far few loads are off that stand for all meetings of phases, over the mean loss at most.

        From the mean losses with every second of the few loads alone, where less than all of them are taken.
        """
        off: list[Each] = []
        for k, (one, met) in enumerate(zip(self.states, self.meetings, strict=True)):
            apart = self._under_loads(one.loss, k) * (met.weight - met.coarse)
            off.append(jnp.abs(jnp.sum(apart, (-2, -1))))
        lost = jnp.sum(self.mean_losses, axis=0)
        return jnp.where(lost > 0.0, sum(off) / jnp.where(lost > 0.0, lost, 1.0), 0.0)

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
        return power_ratio(self.mean_output_power, self.mean(self.states[0].input_power))

    @property
    def stage_efficiencies(self) -> Float[Array, "stage *#b"]:
        """Energy out over energy in of each stage with its shaft; their product is that of the drive.

        From the balance of energy of each stage.
        """
        return jnp.stack(
            [
                power_ratio(self.mean(one.output_power, k), self.mean(one.input_power, k))
                for k, one in enumerate(self.states)
            ]
        )

    @property
    def status(self) -> Status:
        """What became of the balances: the worst code, the largest residual and the most iterations."""
        every = [one.status for one in self.states]
        worst = [jnp.max(one.code) for one in every]
        return Status(
            code=jnp.max(jnp.stack(worst)),
            residual=jnp.max(jnp.stack([jnp.max(one.residual) for one in every])),
            iterations=jnp.max(jnp.stack([jnp.max(one.iterations) for one in every])),
        )

    @property
    def locked(self) -> Bool[Array, "*#b"]:
        """True where friction locks a mesh at some meeting of phases."""
        each = [jnp.any(one.locked, axis=MET) for one in self.states]
        return jnp.any(jnp.stack(each), axis=0)


def _extremes(
    values: Values, nodes: Sequence[int], smooth: Sequence[bool], axes: int = 3
) -> tuple[Values, Values]:
    """Smallest and largest value over so many last axes, of which the last ones are phases."""
    low = high = values
    for count, one in zip(nodes, smooth, strict=True):
        low = extremes(low, count, smooth=one)[0]
        high = extremes(high, count, smooth=one)[1]
    others = tuple(range(len(smooth) - axes, 0))
    return jnp.min(low, axis=others), jnp.max(high, axis=others)


@program
def drive_cycle(
    drive: Drive,
    operation: Operation,
    models: Sequence[StageModels],
    nodes: int = 12,
    engaged: Engagement | None = None,
    few: int | None = FEW,
) -> DriveCycle:
    """States of all meshes of a drive, from its output to its input.

    The torque that a stage and the losses of its shaft ask for is the load of the stage before it.

    Args:
        drive: see `chained`.
        operation: load at the output, speed of the input, temperature of the oil [*b].
        models: laws of each stage, of a train those of each mesh.
        nodes: Gauss-Lobatto nodes in each segment of each period; a train has `NODES_OF_TRAINS`.
        engaged: contacts and shares of the last stage at so many nodes, where all loads at the output are
            one and they are known already.
        few: odd number of loads of a stage that stand for all meetings of phases behind it; None for each
            meeting by itself, of which there are as many as the product of the nodes of all stages.

    From the balance of torques on every shaft, see `balance`.
    """
    demand_double()
    if len(models) != len(drive.stages):
        raise InputError(f"{len(models)} models were given for {len(drive.stages)} stages")
    states: "list[State | TrainState]" = []
    pressed: list[tuple[Values, ...]] = []
    weights: list[Float[Array, " node"]] = []
    every = [unmet(operation.load)]
    ratios, smooth = drive.ratios, tuple(stage.touching for stage in drive.stages)
    counts = tuple(nodes if stage.train is None else NODES_OF_TRAINS for stage in drive.stages)
    for number in reversed(range(len(drive.stages))):
        known, engaged = engaged, None
        laws: Any = models[number]
        point = Operation(
            load=every[0].load[..., None],
            speed=(operation.speed * ratios[number])[..., None, None, None],
            temperature=operation.temperature[..., None, None, None],
        )
        behind = NextStage(states[0], every[0]) if every[0].kept else None
        if drive.stages[number].train is None:
            found = _mesh_under_load(drive, number, point, laws, nodes, behind, known)
        else:
            found = _train_under_load(drive, number, point, laws)
        states.insert(0, found.state)
        pressed.insert(0, found.pressed)
        weights.insert(0, found.weight)
        load = found.state.input_torque
        if number > 0:
            often = every[0].weight[..., None] * found.weight
            kept, phases = felt(drive, number - 1), slice(number, number + 1 + every[0].kept)
            of_phases = counts[phases], smooth[phases]
            if kept:
                of_phases = of_phases[0][1:], of_phases[1][1:]
                ends = _extremes(jnp.moveaxis(load, -1, -3), *of_phases, axes=2)
            else:
                ends = _extremes(load[..., None, :, :, :], *of_phases)
            every.insert(0, meetings(load, often, ends, kept=kept, few=few))
    return DriveCycle(
        tuple(states), tuple(pressed), tuple(weights), tuple(every), operation.speed, counts, smooth
    )


class _UnderLoad(NamedTuple):
    """A stage under its loads: see `DriveCycle`."""

    state: "State | TrainState"
    pressed: tuple[Values, ...]
    weight: Float[Array, " node"]


def _mesh_under_load(
    drive: Drive,
    number: int,
    point: Operation,
    laws: Models,
    nodes: int,
    behind: "NextStage | None",
    known: Engagement | None,
) -> _UnderLoad:
    """A stage of one mesh under its loads [*b load behind 1]."""
    design = drive.stages[number].alone
    if known is None:
        phase, weight = cycle_nodes(design.mesh, laws.sharing, nodes)
    else:
        phase, weight = known.phase, known.weight
    drag = braked(drive, number, behind)
    found = state(replace(design, drag=drag), point, phase, laws, engaged=known)
    loads = bearing_loads(drag, design.mesh, found.contacts, found.balance.load)
    return _UnderLoad(found, tuple(loads), weight)


def _train_under_load(
    drive: Drive, number: int, point: Operation, laws: tuple[Models, ...]
) -> _UnderLoad:
    """A stage of meshes that turn together under its loads [*b load behind 1]."""
    # Only now: a pair or a chain of pairs does not load what trains take.
    from pitchpoint.efficiency.train_state import train_state

    at_loads = jax.tree.map(lambda leaf: leaf[..., 0], point)
    found, weight = train_state(braked_train(drive, number), at_loads, laws, NODES_OF_TRAINS)
    return _UnderLoad(found, found.pressed, weight)


class NextStage(NamedTuple):
    """The stage behind another one, whose teeth load the bearings of the same shaft.

    Attributes:
        state: of it, which is one mesh: a `State`.
        meetings: loads of the stage before it, which go with its phase.
    """

    state: Any
    meetings: Meetings


def braked(drive: Drive, number: int, behind: NextStage | None = None) -> tuple[Drag, ...]:
    """Losses of the drive that a stage overcomes, in its coordinates, then its own.

    Args:
        drive: of which.
        number: of the stage.
        behind: the stage behind it, which loads the bearings of the same shaft; it does not without.

    From `Drive.owners`.
    """
    stage = drive.stages[number]
    found = []
    for drag in _overcome(drive, number):
        seat = drag.seat
        if isinstance(seat, Bearing):
            beside = None
            if behind is not None and _common(drive, number, seat):
                beside = _beside(seat, stage, drive.stages[number + 1], behind)
            seat = replace(_seated(seat, stage), beside=beside)
        between = jnp.stack([drag.between[one] for one in stage.shafts])
        found.append(replace(drag, between=between, seat=seat))
    return (*found, *stage.alone.drag)


def braked_train(drive: Drive, number: int) -> "Train":
    """The train of a stage with the losses of the drive that it overcomes before its own.

    Args:
        drive: of which.
        number: of the stage.

    From `Drive.owners`; the shafts are the bodies at its ends.
    """
    stage = drive.stages[number]
    assert stage.train is not None
    names = dict(zip(stage.shafts, (stage.train.turned, stage.train.loaded), strict=True))
    drags, pairs = [], []
    for place, drag in enumerate(drive.drag):
        if drive.owners[place] != number:
            continue
        shafts = drive.braked[place]
        first, second = *(names[shaft] for shaft in shafts), *[HOUSING] * (2 - len(shafts))
        sides = drag.between[shafts[0]] * jnp.array([1.0, -1.0])
        drags.append(replace(drag, between=sides, seat=None))
        pairs.append((first, second))
    return replace(
        stage.train,
        drag=(*drags, *stage.train.drag),
        braked=(*pairs, *stage.train.braked),
    )


def _overcome(drive: Drive, number: int) -> list[Drag]:
    """Losses of the drive that a stage overcomes."""
    every = zip(drive.owners, drive.drag, strict=True)
    return [drag for owner, drag in every if owner == number]


def _common(drive: Drive, number: int, seat: Bearing) -> bool:
    """True if a bearing sits on the shaft that a stage has in common with the one behind it."""
    return (
        number + 1 < len(drive.stages)
        and drive.stages[number + 1].train is None
        and seat.coordinate == drive.links[number][1]
    )


def felt(drive: Drive, number: int) -> bool:
    """True if bearings that a stage overcomes feel the teeth of the stage behind it; none do of trains."""
    if drive.stages[number].train is not None:
        return False
    seats = [drag.seat for drag in _overcome(drive, number)]
    return any(isinstance(seat, Bearing) and _common(drive, number, seat) for seat in seats)


def _seated(seat: Bearing, stage: Stage) -> Bearing:
    """A bearing of the drive as the mesh of a stage sees it."""
    other = None if seat.other is None else seat.other - stage.place
    coordinate = stage.shafts.index(seat.coordinate)
    return replace(seat, coordinate=coordinate, place=seat.place - stage.place, other=other)


def _beside(seat: Bearing, stage: Stage, after: Stage, behind: NextStage) -> Float[Array, "3 *#b"]:
    """Load on a bearing by the stage behind, in the frame of a stage [N]."""
    state = behind.state
    borne = _seated(seat, after).borne(after.mesh, state.contacts, state.balance.load)
    x, y, z = behind.meetings.following(borne)
    angle = after.turn - stage.turn
    cosine, sine = jnp.cos(angle), jnp.sin(angle)
    return jnp.stack([cosine * x - sine * y, sine * x + cosine * y, z])[..., None]
