"""Gear trains whose meshes turn together, planetary ones among them: the quasi-static state by contacts."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import lcm

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import array, demand_double, jax, jnp
from pitchpoint.brief import brief
from pitchpoint.contact.contacts import Contacts, along, total
from pitchpoint.drive.kinematics import HOUSING, Ends, Link
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.quasi_static import (
    Design,
    Models,
    Operation,
    events_of,
    extremes,
)
from pitchpoint.errors import InputError
from pitchpoint.factored import as_array
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.period import nodes as period_nodes
from pitchpoint.loading.balance import UNSOLVED
from pitchpoint.lubrication.conditions import Conditions, evaluate
from pitchpoint.programs import program
from pitchpoint.status import Code, Status

__all__ = [
    "MeshState",
    "Train",
    "TrainCycle",
    "TrainMesh",
    "gear_train",
    "presses_other_flanks",
    "train_cycle",
]

Nodes = Float[Array, " node"]
Copies = Float[Array, "copy node"]
Lanes = Float[Array, "pair slice copy node"]
Forces = Float[Array, "node force"]
Arms = Float[Array, "node row force"]

MOST_STEPS = 60
"""Steps of the search for forces. Friction hangs weakly on them, so that a step leaves a few per cent of the
error before it; next to locking it leaves more, and the search ends without a solution."""

IDLE = 1e-9
"""Force over the largest of a train below which a mesh carries nothing: what rounding leaves."""

NEAR = 1e-14
"""Relative change of the forces at which the search ends."""

MOST_PERIODS = 200
"""Periods of a mesh, in the period that a train repeats, up to which its repetition is looked for."""


class TrainMesh(eqx.Module):
    """One mesh at its place in a train; equal copies of it, as of planets, are one.

    Attributes:
        design: mesh, materials, oil, surfaces.
        phases: of the copies where the train starts [periods].
        carried: torque or force on the driven coordinate of the mesh for a unit load of the train, without
            friction, on all copies together.
        bodies, carrier: see `Link`; static.
        periods: of the mesh in one period of the train; static.
    """

    design: Design
    phases: Float[Array, " copy"]
    carried: Float[Array, ""]
    bodies: tuple[str, ...] = eqx.field(static=True)
    carrier: str = eqx.field(static=True)
    periods: int = eqx.field(static=True)

    @property
    def copies(self) -> int:
        """How many there are of the mesh."""
        return int(np.shape(self.phases)[0])

    def arms(self, values: Float[Array, "dof copy node"]) -> dict[str, Copies]:
        """Values for the coordinates of the mesh by body of the train; the carrier has minus their sum.

        Turning all bodies of a mesh with their carrier neither closes flanks nor slides them.
        """
        each = {body: values[number] for number, body in enumerate(self.bodies)}
        borne = -jnp.sum(values, axis=0)
        return {**each, self.carrier: borne + each[self.carrier] if self.carrier in each else borne}


class Train(eqx.Module):
    """Meshes that turn together, between bodies of which each may be in several.

    Attributes:
        meshes: in any order.
        rates: of the bodies for a unit speed of the one that is turned, from the housing.
        turned: body that drives; static.
        loaded: body that takes the power; static.
        held: bodies that do not move, beside the housing; static.
        planets: bodies of which there are as many as copies of their meshes; static.
    """

    meshes: tuple[TrainMesh, ...]
    rates: Mapping[str, Float[Array, ""]]
    turned: str = eqx.field(static=True)
    loaded: str = eqx.field(static=True)
    held: tuple[str, ...] = eqx.field(static=True)
    planets: tuple[str, ...] = eqx.field(static=True)

    def __repr__(self) -> str:
        return brief(self)

    @property
    def ratio(self) -> Float[Array, ""]:
        """Rate of the driving body over that of the loaded one."""
        return self.rates[self.turned] / self.rates[self.loaded]

    def motion(self, mesh: TrainMesh) -> Float[Array, " dof"]:
        """Rates of the coordinates of a mesh against their carrier for a unit speed of the train."""
        return jnp.stack([self.rates[body] - self.rates[mesh.carrier] for body in mesh.bodies])

    def onward(self, mesh: TrainMesh) -> Float[Array, ""]:
        """Sense in which the phase of a mesh runs: one, or minus one."""
        own = mesh.design.mesh
        return own.onward * jnp.sign((own.driver @ own.motion) * (own.driver @ self.motion(mesh)))

    @property
    def free(self) -> tuple[str, ...]:
        """Bodies that nothing turns, loads or holds."""
        others = {HOUSING, self.turned, self.loaded, *self.held}
        return tuple(body for body in self.rates if body not in others)

    def driven_backwards(self, designs: Sequence[Design] = ()) -> "Train":
        """The same train with its output driving; the same flanks touch.

        Args:
            designs: of the meshes, driven backwards; by default as they are.
        """
        designs = designs or [one.design for one in self.meshes]
        links = [
            Link(design.mesh, one.bodies, one.carrier)
            for design, one in zip(designs, self.meshes, strict=True)
        ]
        backwards = Ends({self.loaded: -float(self.rates[self.loaded])}, self.held, self.turned)
        phases = [np.asarray(one.phases) for one in self.meshes]
        return gear_train(links, designs, backwards, planets=self.planets, phases=phases)

    def rows(self) -> list[tuple[str, int]]:
        """Bodies in equilibrium, planets by their number."""
        counts = {body: one.copies for one in self.meshes for body in one.bodies}
        return [
            (body, number)
            for body in (self.loaded, *self.free)
            for number in range(counts[body] if body in self.planets else 1)
        ]


def gear_train(
    links: Sequence[Link],
    designs: Sequence[Design],
    ends: Ends,
    *,
    planets: Sequence[str] = (),
    phases: Sequence[Float[np.ndarray, " copy"]] = (),
) -> Train:
    """A train of meshes that turn together.

    Args:
        links: the meshes with the bodies that they join.
        designs: the same meshes with materials, oil and surfaces.
        ends: the one body that is turned, those that are held, and the one that is loaded.
        planets: bodies of which there are several, each with its meshes.
        phases: of the copies of each mesh, where the train starts [periods]; by default there is one of each,
            which starts at zero.

    Raises:
        InputError: see `train_torques`; a mesh that would press its other flanks, losses beside the teeth,
            periods of meshes that hardly ever come together again.
    """
    demand_double()
    if len(ends.turned) != 1:
        raise InputError(f"{len(ends.turned)} bodies are turned; the state of a train asks for one")
    ((turned, rate),) = ends.turned.items()
    unit = replace(ends, turned={turned: float(np.sign(rate))})
    ideal = train_torques(links, unit, 1.0, [1.0] * len(links))
    meshes = []
    for link, design, starts, share, periods in zip(
        links,
        designs,
        phases or [np.zeros(1)] * len(links),
        ideal.shares,
        _periods(links, ideal.rates),
        strict=True,
    ):
        torque = np.array([share[body] for body in link.bodies])
        _check_mesh(link, design, torque)
        meshes.append(
            TrainMesh(
                design,
                array(starts),
                array(abs(float(design.mesh.loaded @ torque))),
                link.bodies,
                link.carrier,
                periods,
            )
        )
    return Train(
        tuple(meshes),
        {body: array(one) for body, one in ideal.rates.items()},
        turned,
        ends.loaded,
        tuple(ends.held),
        tuple(planets),
    )


def presses_other_flanks(mesh: Mesh, torque: Float[np.ndarray, " dof"]) -> bool:
    """True if torques from outside close the flanks of a mesh that do not touch.

    Args:
        mesh: any family.
        torque: on its coordinates [N m or N].
    """
    return float(mesh.driver @ torque) * float(mesh.driver @ mesh.motion) < 0.0


def _check_mesh(link: Link, design: Design, torque: Float[np.ndarray, " dof"]) -> None:
    """Raise InputError unless a mesh can stand in a train, under these torques."""
    bodies = " and ".join(link.bodies)
    if presses_other_flanks(design.mesh, torque):
        raise InputError(
            f"the mesh of {bodies} presses its other flanks when the train is driven so; build it with "
            "them (right_flank)"
        )
    if design.drag:
        raise InputError(f"losses beside the teeth of {bodies} are not among those of a train")


def _periods(links: Sequence[Link], rates: Mapping[str, float]) -> list[int]:
    """Periods of each mesh in which all come together again."""
    each = []
    for link in links:
        mesh = link.mesh
        against = [rates[body] - rates[link.carrier] for body in link.bodies]
        each.append(abs(float(mesh.driver @ np.array(against)) / float(mesh.period)))
    fastest = max(each)
    parts = [Fraction(one / fastest).limit_denominator(MOST_PERIODS) for one in each]
    whole = lcm(*(part.denominator for part in parts))
    if whole > MOST_PERIODS or not np.allclose(
        [*map(float, parts)], np.array(each) / fastest, 1e-9
    ):
        raise InputError(
            f"the meshes of this train come together again after more than {MOST_PERIODS} periods; "
            "its state over all of them is not computed"
        )
    return [int(part * whole) for part in parts]


class MeshState(eqx.Module):
    """State of a mesh of a train at the nodes of its period.

    Attributes:
        conditions: at the contacts of all copies.
        friction: coefficient at each slice.
        sliding_loss, rolling_loss: power lost at each slice [W].
        force, nominal: normal force of each copy, and without friction, equal for all [N].
        input_torque: torque on the driving member of the mesh in its sense of motion, of all copies [N m].
        speed: of that member against the carrier [rad/s].
    """

    conditions: Conditions
    friction: Lanes
    sliding_loss: Lanes
    rolling_loss: Lanes
    force: Copies
    nominal: Copies
    input_torque: Nodes
    speed: Float[Array, ""]

    @property
    def loss(self) -> Nodes:
        """Power lost in all copies [W]."""
        return jnp.sum(total(self.sliding_loss + self.rolling_loss), axis=0)


class TrainCycle(eqx.Module):
    """One period of a train with the weights that integrate over it.

    Attributes:
        phase: nodes, as parts of the period of the train.
        weight: of each node; they sum to one.
        meshes: states of the meshes at the nodes.
        torques: from outside on every body that is not free, by name [N m or N].
        input_power, output_power: at the nodes [W].
        levers: of a unit of normal force in each mesh on each body in equilibrium, all planets as one: of its
            normal part, and of its friction for a coefficient of one.
        status: of the search for forces at each node.
        nodes: static, nodes in each segment between events.
    """

    phase: Nodes
    weight: Nodes
    meshes: tuple[MeshState, ...]
    torques: Mapping[str, Nodes]
    input_torque: Nodes
    input_power: Nodes
    output_power: Nodes
    levers: Float[Array, "2 node body mesh"]
    status: Status
    nodes: int = eqx.field(static=True)

    def __repr__(self) -> str:
        return brief(self)

    def mean(self, values: Nodes) -> Float[Array, ""]:
        """Mean over the period."""
        return jnp.sum(values * self.weight, axis=-1)

    def extremes(self, values: Nodes) -> tuple[Float[Array, ""], Float[Array, ""]]:
        """Smallest and largest value over the period, see `quasi_static.extremes`."""
        return extremes(values, self.nodes, smooth=True)

    @property
    def loss(self) -> Nodes:
        """Power lost in all meshes [W]."""
        return sum((one.loss for one in self.meshes[1:]), self.meshes[0].loss)

    @property
    def mean_efficiency(self) -> Float[Array, ""]:
        """Energy out over energy in; NaN where the train is locked.

        From the balance of energy over the period.
        """
        return self.mean(self.output_power) / self.mean(self.input_power)

    @property
    def ripple(self) -> Float[Array, ""]:
        """Largest less smallest torque of the driving body [N m].

        Source: Tian et al. (2024), eq. 10, for trains.
        """
        low, high = self.extremes(self.input_torque)
        return high - low

    @property
    def locked(self) -> Bool[Array, ""]:
        """True where friction holds the train at some phase."""
        return jnp.any(self.status.code == int(Code.LOCKED))


@program
def train_cycle(
    train: Train, operation: Operation, models: Sequence[Models], nodes: int = 6
) -> TrainCycle:
    """States of a train over its period, integrated segment by segment between the events of all meshes.

    Where planets share a load, equilibrium leaves open how: of all forces in equilibrium those are taken
    that, over equal ones without friction, have the least sum of squares; planets in phase share equally.

    Args:
        train: see `gear_train`.
        operation: load of the loaded body, speed of the driving one, temperature of the oil; one point.
        models: laws of each mesh.
        nodes: Gauss-Lobatto nodes in each segment.

    From the equilibrium of every body under the forces of all its contacts with their friction; the sides of
    friction are those of the sliding that the motion asks for.
    """
    demand_double()
    phase, weight = (
        one.ravel() for one in period_nodes(jnp.concatenate([*_events(train, models)]), nodes)
    )
    every = [
        _Meshing(train, one, operation, laws, phase)
        for one, laws in zip(train.meshes, models, strict=True)
    ]
    solved = _solve(train, every, operation)
    lost = solved.code != int(Code.SOLVED)
    forces = _by_mesh(every, jnp.where(lost[:, None], jnp.nan, solved.forces))
    states = tuple(one.state(force) for one, force in zip(every, forces, strict=True))
    torques = _torques(train, every, forces)
    driving = torques[train.turned] * jnp.sign(train.rates[train.turned])
    power_out = operation.load * jnp.abs(train.rates[train.loaded]) * operation.speed
    return TrainCycle(
        phase,
        weight,
        states,
        torques,
        driving,
        driving * operation.speed,
        jnp.where(lost, jnp.nan, power_out),
        _levers(train, every),
        Status(solved.code, solved.residual, solved.steps),
        nodes,
    )


def _events(train: Train, models: Sequence[Models]) -> Iterator[Float[Array, " event"]]:
    """Parts of the period of a train at which anything begins or ends in a mesh."""
    for one, laws in zip(train.meshes, models, strict=True):
        events = events_of(one.design.mesh, laws.sharing)
        turns = jnp.arange(one.periods)[:, None, None]
        ahead = (events[:, None] - one.phases) * train.onward(one)
        yield jnp.mod((ahead + turns) / one.periods, 1.0).ravel()


class _Meshing:
    """The contacts of a mesh of a train, and what they do for a unit of force on each copy.

    Args:
        train: of which.
        one: mesh of it.
        operation: of the train.
        models: laws of the mesh.
        phase: nodes of the period of the train.
    """

    def __init__(
        self, train: Train, one: TrainMesh, operation: Operation, models: Models, phase: Nodes
    ) -> None:
        self.one, self.models = one, models
        design, mesh = one.design, one.design.mesh
        turned = train.onward(one) * one.periods * phase
        self.contacts: Contacts = mesh.contacts(one.phases[:, None] + turned)
        motion = train.motion(one)
        speed = jnp.abs(mesh.driver @ motion) * operation.speed
        self.driving = mesh.driver * jnp.sign(mesh.driver @ motion)
        self.operation = Operation(
            one.carried / one.copies * operation.load, speed, operation.temperature
        )
        self.share = models.share(design, self.contacts, self.operation.load)
        arm = jnp.abs(total(self.share * along(self.contacts.normal, mesh.loaded)))
        self.nominal = self.operation.load / arm
        self.unloaded = design.conditions(
            self.contacts,
            self.operation,
            load=jnp.zeros_like(self.share),
            nominal_load=self.nominal,
            rates=motion * operation.speed,
        )
        slip, roll = along(self.contacts.slip_arm, motion), along(self.contacts.roll_arm, motion)
        # Beside the pitch point by rounding, a contact does not slide.
        self.sense = jnp.where(jnp.abs(slip) > 1e-13 * jnp.abs(roll), jnp.sign(slip), 0.0)
        self.turn = jnp.sign(roll)
        self.carrying = self.contacts.active & (self.share > 0.0)

    def laws(self, force: Copies) -> tuple[Lanes, Lanes]:
        """Friction coefficient and rolling resistance [N] of each slice under normal forces of the copies."""
        # Of a train that friction locks a force comes out negative: the law is asked for the usual one there.
        pushed = jnp.where(force > 0.0, force, jnp.where(self.nominal > 0.0, self.nominal, 1.0))
        at = replace(self.unloaded, load=jnp.where(self.carrying, self.share, 1.0) * pushed)
        loaded = self.carrying & (self.nominal > 0.0)
        coefficient = jnp.where(loaded, self.models.coefficient(at), 0.0)
        if self.models.rolling.name == "none":
            return coefficient, jnp.zeros_like(coefficient)
        resistance = evaluate(self.models.rolling, at) * self.contacts.weight
        return coefficient, jnp.where(loaded, resistance, 0.0)

    def torques(self, coefficient: Lanes) -> Float[Array, "dof copy node"]:
        """Torques from outside on the coordinates that a unit of normal force on each copy asks for."""
        slip, mu = self.contacts.slip_arm, coefficient * self.sense
        each = zip(self.contacts.normal, slip, strict=True)
        return jnp.stack([total(self.share * (n + mu * t)) for n, t in each])

    def turned(self, resistance: Lanes) -> Float[Array, "dof copy node"]:
        """Torques from outside on the coordinates that rolling resistance asks for."""
        return jnp.stack([total(resistance * self.turn * arm) for arm in self.contacts.roll_arm])

    def of_force(self, coefficient: Lanes) -> dict[str, Copies]:
        """Torques of a unit of force, by body."""
        return self.one.arms(self.torques(coefficient))

    def of_rolling(self, resistance: Lanes) -> dict[str, Copies]:
        """Torques of rolling resistance, by body."""
        return self.one.arms(self.turned(resistance))

    def state(self, force: Copies) -> MeshState:
        """What follows from the forces of the copies."""
        coefficient, resistance = self.laws(force)
        at = replace(self.unloaded, load=self.share * force)
        driver = self.driving @ jnp.stack(
            [
                jnp.sum(arm * force + rolling, axis=0)
                for arm, rolling in zip(
                    self.torques(coefficient), self.turned(resistance), strict=True
                )
            ]
        )
        return MeshState(
            at,
            coefficient,
            at.load * coefficient * as_array(at.sliding),
            2.0 * resistance * as_array(at.entrainment),
            force,
            self.nominal,
            driver,
            self.operation.speed,
        )


class _Balanced(eqx.Module):
    forces: Forces
    residual: Nodes
    steps: Int[Array, ""]
    code: Int[Array, " node"]


def _solve(train: Train, every: Sequence[_Meshing], operation: Operation) -> _Balanced:
    """Forces of all copies in equilibrium; friction is that under the forces of the step before."""
    load = -jnp.sign(train.rates[train.loaded]) * operation.load
    asked = jnp.stack([load * (body == train.loaded) for body, _ in train.rows()])

    def step(held: tuple[Forces, Nodes, Array]) -> tuple[Forces, Nodes, Array]:
        forces, _, steps = held
        laws = [one.laws(force) for one, force in zip(every, _by_mesh(every, forces), strict=True)]
        arms = _arms(train, [one.of_force(mu) for one, (mu, _) in zip(every, laws, strict=True)])
        taken = [one.of_rolling(rolling) for one, (_, rolling) in zip(every, laws, strict=True)]
        wanted = asked - jnp.sum(_arms(train, taken), axis=-1)
        left = jnp.einsum("nrf,nf->nr", arms, forces) - wanted
        size = jnp.max(jnp.abs(arms) * jnp.abs(forces)[:, None], axis=-1)
        # A body that idles is in balance within rounding of the forces in the rest of the train.
        size = jnp.maximum(size, IDLE * jnp.max(size, axis=-1, keepdims=True))
        residual = jnp.max(jnp.abs(left) / jnp.where(size > 0.0, size, 1.0), axis=-1)
        return nominal * _least(arms * nominal[:, None], wanted), residual, steps + 1

    def goes_on(held: tuple[Forces, Nodes, Array]) -> Array:
        _, residual, steps = held
        return (steps < MOST_STEPS) & jnp.any(residual > NEAR)

    nominal = jnp.concatenate([one.nominal for one in every]).T
    largest = jnp.max(nominal, axis=-1, keepdims=True)
    nominal = jnp.maximum(nominal, jnp.where(largest > 0.0, IDLE * largest, 1.0))
    first = nominal, jnp.full(nominal.shape[0], jnp.inf), jnp.asarray(0)
    forces, residual, steps = jax.lax.while_loop(goes_on, step, first)
    pulled = jnp.any(forces < -IDLE * jnp.max(jnp.abs(forces), axis=-1, keepdims=True), axis=-1)
    code = jnp.where(pulled, int(Code.LOCKED), int(Code.SOLVED))
    code = jnp.where(residual <= UNSOLVED, code, int(Code.NOT_CONVERGED))
    return _Balanced(forces, residual, steps, code)


def _levers(train: Train, every: Sequence[_Meshing]) -> Float[Array, "2 node body mesh"]:
    """See `TrainCycle.levers`."""

    def on_bodies(one: _Meshing, coefficient: float) -> Float[Array, "body node"]:
        arms = one.of_force(jnp.where(one.carrying, coefficient, 0.0))
        nothing = jnp.zeros(one.nominal.shape)
        each = (arms.get(body, nothing) for body in (train.loaded, *train.free))
        return jnp.stack([jnp.mean(arm, axis=0) for arm in each])

    normal, whole = (
        jnp.stack([on_bodies(one, coefficient) for one in every], axis=-1)
        for coefficient in (0.0, 1.0)
    )
    return jnp.moveaxis(jnp.stack([normal, whole - normal]), 2, 1)


def _arms(train: Train, every: Sequence[Mapping[str, Copies]]) -> Arms:
    """Torques on the bodies in equilibrium by mesh and copy, those of planets on the planet of the copy."""
    rows = {place: row for row, place in enumerate(train.rows())}
    columns = []
    for one in every:
        copies, nodes = next(iter(one.values())).shape
        for copy in range(copies):
            column = [jnp.zeros(nodes)] * len(rows)
            for body, values in one.items():
                row = rows.get((body, copy if body in train.planets else 0))
                if row is not None:
                    column[row] = column[row] + values[copy]
            columns.append(jnp.stack(column, axis=-1))
    return jnp.stack(columns, axis=-1)


def _least(arms: Arms, wanted: Float[Array, "node row"]) -> Forces:
    """Parts of the nominal forces of the least sum of squares that give the torques wanted.

    By Lagrange's multipliers, with a second pass that takes off what rounding leaves of the first.
    """
    size = jnp.max(jnp.abs(arms), axis=-1, keepdims=True)
    arms, wanted = arms / size, wanted / size[..., 0]
    count, rows = arms.shape[-1], arms.shape[-2]
    none = jnp.zeros((*arms.shape[:-2], rows, rows))
    unit = jnp.broadcast_to(jnp.eye(count), (*arms.shape[:-2], count, count))
    system = jnp.block([[unit, jnp.swapaxes(arms, -1, -2)], [arms, none]])

    def solved(right: Float[Array, "node row"]) -> Forces:
        whole = jnp.concatenate([jnp.zeros((*right.shape[:-1], count)), right], axis=-1)
        found: Forces = jnp.linalg.solve(system, whole[..., None])[..., :count, 0]
        return found

    forces = solved(wanted)
    return forces + solved(wanted - jnp.einsum("nrf,nf->nr", arms, forces))


def _by_mesh(every: Sequence[_Meshing], forces: Forces) -> list[Copies]:
    """Forces of the copies of each mesh."""
    ends = np.cumsum([one.one.copies for one in every])[:-1]
    split: list[Copies] = jnp.split(forces.T, ends)
    return split


def _torques(train: Train, every: Sequence[_Meshing], forces: Sequence[Copies]) -> dict[str, Nodes]:
    """Torques from outside on each body that is not free."""
    found: dict[str, Nodes] = {}
    for one, force in zip(every, forces, strict=True):
        coefficient, resistance = one.laws(force)
        rolling = one.of_rolling(resistance)
        for body, arm in one.of_force(coefficient).items():
            taken = jnp.sum(arm * force + rolling[body], axis=0)
            found[body] = found.get(body, jnp.zeros_like(taken)) + taken
    return {body: torque for body, torque in found.items() if body not in train.free}
