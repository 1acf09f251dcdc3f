"""Drives of links on common shafts, from the input to the output: the quasi-static state."""

import abc
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float

from pitchpoint._jax import demand_double, jnp
from pitchpoint.core.brief import brief
from pitchpoint.core.programs import program
from pitchpoint.core.status import Status
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.meetings import FEW, Meetings, meetings, unmet
from pitchpoint.efficiency.quasi_static import (
    Engagement,
    Models,
    Operation,
    State,
    extremes,
    power_ratio,
)
from pitchpoint.errors import InputError
from pitchpoint.loading.reactions import Bearing

if TYPE_CHECKING:
    from pitchpoint.efficiency.train_state import TrainState

__all__ = [
    "MET",
    "Drive",
    "DriveCycle",
    "DriveLink",
    "LinkModels",
    "LinkPlace",
    "Locking",
    "UnderLoad",
    "bearings_feel_link_behind",
    "chained",
    "drive_cycle",
    "loss_owner",
    "overcome_losses",
]

Each = Float[Array, "*#b"]
Met = Float[Array, "*#b load behind node"]
Values = Float[Array, "..."]

LinkModels = Models | tuple[Models, ...]
"""Laws of a link, of a train those of each mesh."""

Locking = tuple[Array, Array, Array]
"""Levers of a train, its largest friction, and where no forces were found [point node]."""

MET = (-3, -2, -1)
"""Axes of the states of a link along which loads and phases meet."""


class UnderLoad(NamedTuple):
    """A link under its loads: see `DriveCycle`."""

    state: "State | TrainState"
    pressed: tuple[Values, ...]
    weight: Float[Array, " node"]
    nodes: int


class LinkPlace(NamedTuple):
    """Where a link is in a drive, counted from zero.

    Attributes:
        behind: states of the link behind it, a mesh whose teeth load the bearings of the same shaft too;
            None where no bearing feels them.
        meetings: loads of the link, which go with the phase of that one.
    """

    drive: "Drive"
    number: int
    behind: Any = None
    meetings: Meetings | None = None


class DriveLink(eqx.Module):
    """What joins two shafts of a drive: one mesh, or the meshes of a train, which turn together.

    Attributes:
        design: mesh, materials, oil, surfaces, and what brakes its bodies against each other, or a train;
            what brakes the shafts is the drive's.
        shafts: of the drive, one for each body on a shaft; static.
        presses_bearings: True if its teeth press the bearings of its shafts, each at its place.
    """

    design: eqx.AbstractVar[Any]
    shafts: eqx.AbstractVar[tuple[int, ...]]
    presses_bearings: eqx.AbstractClassVar[bool]

    @property
    @abc.abstractmethod
    def bodies(self) -> int:
        """How many of its bodies are on shafts of the drive."""

    @property
    @abc.abstractmethod
    def ends(self) -> tuple[int, int]:
        """Shaft that drives it, and the one that it loads."""

    @property
    @abc.abstractmethod
    def step(self) -> Float[Array, ""]:
        """Speed of the shaft that it loads for a unit speed of its driver, not negative."""

    @property
    @abc.abstractmethod
    def touching(self) -> bool:
        """True if what it does is smooth between events, since its rigid flanks all touch."""

    @abc.abstractmethod
    def senses(self, before: float) -> tuple[float, float]:
        """Senses in which both shafts turn, where the link before it turns the first one so; zero for any."""

    @abc.abstractmethod
    def driven_backwards(self) -> "DriveLink":
        """The same link with its output driving; the same flanks touch."""

    @abc.abstractmethod
    def under_load(
        self, place: LinkPlace, point: Operation, models: Any, nodes: int, known: Engagement | None
    ) -> UnderLoad:
        """Its states under its loads [*b load behind 1], see `drive_cycle`."""

    @abc.abstractmethod
    def at_rest(self, place: LinkPlace, point: Operation, models: Any) -> tuple[Array, Array]:
        """Mean and largest torque that starts it with the losses that it overcomes [N m]."""

    @abc.abstractmethod
    def memory(self, models: Any, nodes: int) -> tuple[float, int]:
        """Memory for its states under one load [B], and how many phases may be felt in front of it."""

    @abc.abstractmethod
    def locking(self, state: Any) -> Locking | None:
        """What locks it where its forces do so together; None where each contact tells by itself."""


class Drive(eqx.Module):
    """Links one after the other, each driven by the shaft that the one before it loads.

    Attributes:
        links: from the input to the output.
        drag: places where a shaft is braked against the housing, or against another of its link;
            `between` and `seat.coordinate` count shafts, places of bearings along them are those of the
            drive.
        ends: for each link the shaft that drives it and the one that it loads; static.
        owners: for each place the link that overcomes it: the one that loads the shaft, the first one for
            the input; of a shaft between a train and one mesh that mesh, whose teeth press its bearings;
            static.
        braked: for each place the shafts that it brakes; static.
    """

    links: tuple[DriveLink, ...]
    drag: tuple[Drag, ...]
    ends: tuple[tuple[int, int], ...] = eqx.field(static=True)
    owners: tuple[int, ...] = eqx.field(static=True)
    braked: tuple[tuple[int, ...], ...] = eqx.field(static=True)

    def __repr__(self) -> str:
        return brief(self)

    @property
    def ratios(self) -> Float[Array, " link"]:
        """Speed of each link's driver over that of the drive's input, not negative.

        From kinematics: the ratios of links one behind the other multiply.
        """
        return jnp.cumprod(jnp.stack([jnp.ones(()), *(link.step for link in self.links)]))

    def driven_backwards(self) -> "Drive":
        """The same drive with its output driving; the same flanks touch."""
        return chained([link.driven_backwards() for link in self.links[::-1]], self.drag)


def chained(links: Sequence[DriveLink], drag: Sequence[Drag] = ()) -> Drive:
    """A drive of links that follow each other.

    Args:
        links: from the input to the output.
        drag: see `Drive`.

    Raises:
        InputError: a link is not driven by the shaft that the one before it loads, or turns it the
            other way; a loss between shafts that no link has in common.
    """
    if not links:
        raise InputError("a drive needs at least one stage")
    for number, link in enumerate(links, 1):
        if len(set(link.shafts)) != link.bodies:
            raise InputError(
                f"stage {number} has {link.bodies} bodies that move, and shafts = {link.shafts} names "
                f"{len(set(link.shafts))} of the drive"
            )
    ends = [link.ends for link in links]
    for number, (before, behind) in enumerate(pairwise(ends), 2):
        if behind[0] != before[1]:
            raise InputError(
                f"stage {number} is driven by shaft {behind[0] + 1}, and the stage before it loads shaft "
                f"{before[1] + 1}"
            )
    _check_senses(links)
    owners = tuple(loss_owner(place, links) for place in drag)
    braked = tuple(_braked_shafts(place) for place in drag)
    return Drive(tuple(links), tuple(drag), tuple(ends), owners, braked)


def _check_senses(links: Sequence[DriveLink]) -> None:
    """InputError if a mesh turns its first shaft the other way; a train may turn either way."""
    sense = 0.0
    for number, link in enumerate(links, 1):
        sense_in, sense_out = link.senses(sense)
        if sense * sense_in < 0.0:
            raise InputError(
                f"stage {number} turns its first shaft against the stage before it; the other flanks of its "
                'gears do not, gears.flank = "right"'
            )
        sense = sense_out


def _braked_shafts(drag: Drag) -> tuple[int, ...]:
    return tuple(int(shaft) for shaft in np.flatnonzero(np.asarray(drag.between)))


def loss_owner(drag: Drag, links: Sequence[DriveLink]) -> int:
    """Number of the link that overcomes a loss, see `Drive.owners`.

    Args:
        drag: where it arises, in the shafts of the drive.
        links: from the input to the output.

    Raises:
        InputError: it is between shafts that no link has in common.

    From the order of the balances, which goes from the output to the input.
    """
    shafts = {*_braked_shafts(drag)}
    having = [number for number, link in enumerate(links) if shafts <= {*link.shafts}]
    if not having:
        raise InputError("is between shafts that no stage of the drive has in common")
    having = [number for number in having if links[number].presses_bearings] or having
    loading = [number for number in having if links[number].ends[1] in shafts]
    return (loading or having)[0]


def overcome_losses(drive: Drive, number: int) -> list[int]:
    """Places of a drive whose losses a link overcomes, by their numbers."""
    return [place for place, link in enumerate(drive.owners) if link == number]


def bearings_feel_link_behind(drive: Drive, number: int, place: int | None = None) -> bool:
    """True if bearings that a link overcomes feel the teeth of the link behind it too; none do of trains.

    Args:
        drive: of which.
        number: of the link.
        place: a bearing of the drive; by default any that the link overcomes.
    """
    if place is None:
        return any(
            bearings_feel_link_behind(drive, number, loss_place)
            for loss_place in overcome_losses(drive, number)
        )
    seat = drive.drag[place].seat
    return (
        isinstance(seat, Bearing)
        and number + 1 < len(drive.links)
        and all(link.presses_bearings for link in drive.links[number : number + 2])
        and seat.coordinate == drive.ends[number][1]
    )


class DriveCycle(eqx.Module):
    """States of all meshes over their periods, each under the loads that phases of those behind it make.

    Between two meshes whose tooth numbers on their common shaft have no common divisor every pair of
    phases comes up, so means over both periods are those over a turn; the ripple is that of the worst
    meeting of phases.

    Attributes:
        states: of the links from the input to the output, batch axes `*b load behind node`: loads, phases of
            the link behind as far as they are kept, see `Meetings`, and nodes of the own period.
        pressed: for each link the loads on the bearings of the places that it overcomes: those of the
            drive in order, then its own [N].
        weights: of the nodes of each link; they sum to one.
        meetings: loads of each link, and how often they are.
        speed: of the input [rad/s].
        nodes: static, for each link nodes in each segment between events.
        smooth: static, for each link True if its states are smooth between events.

    Source: Tian et al. (2024), eq. 10, for the ripple of several meshes.
    """

    states: "tuple[State | TrainState, ...]"
    pressed: tuple[tuple[Values, ...], ...]
    weights: tuple[Float[Array, " _"], ...]
    meetings: tuple[Meetings, ...]
    speed: Each
    nodes: tuple[int, ...] = eqx.field(static=True)
    smooth: tuple[bool, ...] = eqx.field(static=True)

    def mean(self, values: Values, link: int = 0) -> Each:
        """Mean over the periods of a link and of those behind it.

        Args:
            values: of that link, see `states`.
            link: counted from zero.
        """
        return jnp.sum(self._under_loads(values, link) * self.meetings[link].weight, (-2, -1))

    def _under_loads(self, values: Values, link: int) -> Float[Array, "*b load behind"]:
        """Mean over the own period of a link."""
        every = self.states[link].input_torque
        values = jnp.broadcast_to(values, jnp.broadcast_shapes(values.shape, every.shape))
        return values @ self.weights[link]

    @property
    def input_torque(self) -> Float[Array, "*#b load behind node"]:
        """Torque at the input under every load of the first link at every phase of it [N m]."""
        return self.states[0].input_torque

    @property
    def mean_input_torque(self) -> Each:
        """Mean torque at the input [N m]."""
        return self.mean(self.input_torque)

    def extremes(self, values: Met) -> tuple[Each, Each]:
        """Smallest and largest value over all meetings of phases, between the nodes too.

        Args:
            values: of the first link, see `states`.

        From the extremes over the phase of one link after the other, see `quasi_static.extremes`: a link
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
        """Power out over power in at every state of the first link; NaN where no power is transmitted.

        From the balance of power there.
        """
        power_out = self.mean_output_power[..., None, None, None]
        return power_ratio(power_out, self.states[0].input_power)

    @property
    def mean_losses(self) -> Float[Array, "link *#b"]:
        """Mean power lost in each link and beside its teeth [W]."""
        return jnp.stack([self.mean(state.loss, k) for k, state in enumerate(self.states)])

    @property
    def meeting_error(self) -> Each:
        """How far few loads are off that stand for all meetings of phases, over the mean loss at most.

        From the mean losses with every second of the few loads alone, where less than all of them are taken.
        """
        off: list[Each] = []
        for k, (state, met) in enumerate(zip(self.states, self.meetings, strict=True)):
            apart = self._under_loads(state.loss, k) * (met.weight - met.coarse)
            off.append(jnp.abs(jnp.sum(apart, (-2, -1))))
        lost = jnp.sum(self.mean_losses, axis=0)
        return jnp.where(lost > 0.0, sum(off) / jnp.where(lost > 0.0, lost, 1.0), 0.0)

    @property
    def mean_output_power(self) -> Each:
        """Mean power taken at the output [W]."""
        output = len(self.states) - 1
        return self.mean(self.states[output].output_power, output)

    @property
    def mean_efficiency(self) -> Each:
        """Energy out over energy in; NaN where no power is transmitted.

        From the balance of energy over the periods of all meshes.
        """
        return power_ratio(self.mean_output_power, self.mean(self.states[0].input_power))

    @property
    def link_efficiencies(self) -> Float[Array, "link *#b"]:
        """Energy out over energy in of each link with its shaft; their product is that of the drive.

        From the balance of energy of each link.
        """
        return jnp.stack(
            [
                power_ratio(self.mean(state.output_power, k), self.mean(state.input_power, k))
                for k, state in enumerate(self.states)
            ]
        )

    @property
    def status(self) -> Status:
        """What became of the balances: the worst code, the largest residual and the most iterations."""
        every = [state.status for state in self.states]
        worst = [jnp.max(status.code) for status in every]
        return Status(
            code=jnp.max(jnp.stack(worst)),
            residual=jnp.max(jnp.stack([jnp.max(status.residual) for status in every])),
            iterations=jnp.max(jnp.stack([jnp.max(status.iterations) for status in every])),
        )

    @property
    def locked(self) -> Bool[Array, "*#b"]:
        """True where friction locks a mesh at some meeting of phases."""
        locks = [jnp.any(state.locked, axis=MET) for state in self.states]
        return jnp.any(jnp.stack(locks), axis=0)


def _extremes(
    values: Values, nodes: Sequence[int], smooth: Sequence[bool], axes: int = 3
) -> tuple[Values, Values]:
    """Smallest and largest value over so many last axes, of which the last ones are phases."""
    low = high = values
    for count, is_smooth in zip(nodes, smooth, strict=True):
        low = extremes(low, count, smooth=is_smooth)[0]
        high = extremes(high, count, smooth=is_smooth)[1]
    others = tuple(range(len(smooth) - axes, 0))
    return jnp.min(low, axis=others), jnp.max(high, axis=others)


@program
def drive_cycle(
    drive: Drive,
    operation: Operation,
    models: Sequence[LinkModels],
    nodes: int = 12,
    engaged: Engagement | None = None,
    few: int | None = FEW,
) -> DriveCycle:
    """States of all meshes of a drive, from its output to its input.

    The torque that a link and the losses of its shaft ask for is the load of the link before it.

    Args:
        drive: see `chained`.
        operation: load at the output, speed of the input, temperature of the oil [*b].
        models: laws of each link, of a train those of each mesh.
        nodes: Gauss-Lobatto nodes in each segment of each period; a train has `NODES_OF_TRAINS`.
        engaged: contacts and shares of the last link at so many nodes, where all loads at the output are
            one and they are known already.
        few: odd number of loads of a link that stand for all meetings of phases behind it; None for each
            meeting by itself, of which there are as many as the product of the nodes of all links.

    From the balance of torques on every shaft, see `force_balance`.
    """
    demand_double()
    if len(models) != len(drive.links):
        raise InputError(f"{len(models)} models were given for {len(drive.links)} stages")
    states: "list[State | TrainState]" = []
    pressed: list[tuple[Values, ...]] = []
    weights: list[Float[Array, " node"]] = []
    counts: list[int] = []
    every = [unmet(operation.load)]
    ratios, smooth = drive.ratios, tuple(link.touching for link in drive.links)
    for number in reversed(range(len(drive.links))):
        engagement, engaged = engaged, None
        point = Operation(
            load=every[0].load[..., None],
            speed=(operation.speed * ratios[number])[..., None, None, None],
            temperature=operation.temperature[..., None, None, None],
        )
        behind = (states[0], every[0]) if every[0].kept else ()
        place = LinkPlace(drive, number, *behind)
        loaded = drive.links[number].under_load(place, point, models[number], nodes, engagement)
        states.insert(0, loaded.state)
        pressed.insert(0, loaded.pressed)
        weights.insert(0, loaded.weight)
        counts.insert(0, loaded.nodes)
        load = loaded.state.input_torque
        if number > 0:
            often = every[0].weight[..., None] * loaded.weight
            feels_behind, felt_too = bearings_feel_link_behind(drive, number - 1), 1 + every[0].kept
            of_phases = counts[:felt_too], smooth[number : number + felt_too]
            if feels_behind:
                of_phases = of_phases[0][1:], of_phases[1][1:]
                ends = _extremes(jnp.moveaxis(load, -1, -3), *of_phases, axes=2)
            else:
                ends = _extremes(load[..., None, :, :, :], *of_phases)
            every.insert(0, meetings(load, often, ends, kept=feels_behind, few=few))
    return DriveCycle(
        tuple(states),
        tuple(pressed),
        tuple(weights),
        tuple(every),
        operation.speed,
        tuple(counts),
        smooth,
    )
