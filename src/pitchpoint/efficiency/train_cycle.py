"""The quasi-static state of a gear train over its period, from the contacts of all its meshes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import demand_double, jax, jnp
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.brief import brief
from pitchpoint.core.factored import product_array, square_root
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.efficiency.drag import ROUNDING as NO_TURNING
from pitchpoint.efficiency.quasi_static import Models, Operation, events_of, extremes, power_ratio
from pitchpoint.efficiency.train import Train, TrainMesh
from pitchpoint.gears.period import nodes as period_nodes
from pitchpoint.gears.period import phases_past_ties
from pitchpoint.loading.balance import UNSOLVED
from pitchpoint.lubrication.conditions import Conditions, evaluate

__all__ = ["NODES_OF_TRAINS", "MeshState", "TrainCycle", "train_cycle"]

Nodes = Float[Array, " node"]
Copies = Float[Array, "copy node"]
Lanes = Float[Array, "pair slice copy node"]
Forces = Float[Array, "force node"]
Arms = Float[Array, "row force node"]
Rows = Float[Array, "row #node"]
Vectors = Float[Array, "3 copy node"]
OfPlanets = Float[Array, "_ node"]

NODES_OF_TRAINS = 6
"""Nodes in each segment between events of a train, of which planets out of phase make many."""

MOST_STEPS = 60
"""Steps of the search for forces. Friction hangs weakly on them, so that a step leaves a few per cent of the
error before it; next to locking it leaves more, and the search ends without a solution."""

IDLE = 1e-9
"""Force over the largest of a train below which a mesh carries nothing: what rounding leaves."""

NEAR = 1e-14
"""Relative change of the forces at which the search ends."""

MOST_TURNS = 3
"""Changes of the flank that a mesh without load presses, from step to step, after which it lies on neither.

On its way to forces that stand a flank changes once or twice.
"""


class MeshState(eqx.Module):
    """State of a mesh of a train at the nodes of its period.

    Attributes:
        conditions: at the contacts of all copies.
        friction: coefficient at each slice.
        sliding_loss, rolling_loss: power lost at each slice [W].
        force, nominal: normal force of each copy, negative on other flanks that losses press, and its size
            without friction; zero at places without a copy, and of a mesh that then idles [N].
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

    @property
    def latent_power(self) -> Nodes:
        """Power that its driving member puts in against the carrier, of all copies [W].

        It rolls through the teeth whether the carrier moves or not; friction takes its part of it.
        """
        power = self.input_torque * self.speed
        return jnp.where(power > 0.0, power, self.loss - power)

    @property
    def normal_force(self) -> Nodes:
        """Sum of the normal forces of all contacts of all copies [N]."""
        return jnp.sum(total(self.conditions.load), axis=0)

    @property
    def friction_force(self) -> Nodes:
        """Sum of their friction forces in size [N]."""
        return jnp.sum(total(self.conditions.load * self.friction), axis=0)

    @property
    def contact_force_ratio(self) -> Nodes:
        """Largest normal force of a copy over that without friction; one where none carries."""
        carries = self.nominal > 0.0
        ratios = jnp.abs(self.force) / jnp.where(carries, self.nominal, 1.0)
        largest = jnp.max(jnp.where(carries, ratios, 0.0), axis=0)
        return jnp.where(jnp.any(carries, axis=0), largest, 1.0)


class TrainCycle(eqx.Module):
    """One period of a train with the weights that integrate over it.

    Attributes:
        phase: nodes, as parts of the period of the train; where planets come to each other's places, they lie
            in the first part of it that repeats but for that, see `Train.turns`.
        weight: of each node; they sum to one.
        meshes: states of the meshes at the nodes.
        torques: from outside on every body that is not free, by name; of a train without names on every
            body, rounding on those that are free [N m or N].
        drag_loss: power lost beside the teeth [W].
        pressed: load on the bearing of each place, of several planets the mean [N].
        on_planet: mean force of the teeth on a planet, outwards, along its circle and along its axis [N].
        input_power, output_power: at the nodes [W].
        levers: of a unit of normal force in each mesh on each body in equilibrium, with each planet as if it
            were alone: of its normal part, and of its friction for a coefficient of one.
        status: of the search for forces at each node.
        nodes: static, nodes in each segment between events.

    Source: Tian et al. (2024), eq. 10, for the ripple of trains.
    """

    phase: Nodes
    weight: Nodes
    meshes: tuple[MeshState, ...]
    torques: Mapping[str, Nodes]
    drag_loss: Nodes
    pressed: tuple[Nodes, ...]
    on_planet: Float[Array, "3 node"]
    input_torque: Nodes
    input_power: Nodes
    output_power: Nodes
    levers: Float[Array, "2 node copy body mesh"]
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
        """Power lost in all meshes and beside their teeth [W]."""
        return sum((mesh.loss for mesh in self.meshes), self.drag_loss)

    @property
    def contact_force_ratio(self) -> Nodes:
        """Largest one of all meshes, see `MeshState`."""
        return jnp.max(jnp.stack([mesh.contact_force_ratio for mesh in self.meshes]), axis=0)

    @property
    def largest_friction(self) -> Nodes:
        """Largest friction coefficient of all contacts."""
        largest = [jnp.max(mesh.friction, axis=(0, 1, 2)) for mesh in self.meshes]
        return jnp.max(jnp.stack(largest), axis=0)

    @property
    def mean_efficiency(self) -> Float[Array, ""]:
        """Energy out over energy in; NaN where the train is locked, or nothing is transmitted.

        From the balance of energy over the period.
        """
        return power_ratio(self.mean(self.output_power), self.mean(self.input_power))

    @property
    def ripple(self) -> Float[Array, ""]:
        """Largest less smallest torque of the driving body [N m].

        Source: Tian et al. (2024), eq. 10, for trains.
        """
        low, high = self.extremes(self.input_torque)
        return high - low

    @property
    def locked(self) -> Bool[Array, ""]:
        """True where friction holds the train at some phase.

        With losses beside the teeth the search finds no forces there, see `train_summary.train_figures`.
        """
        return jnp.any(self.status.code == int(Code.LOCKED))


@program
def train_cycle(
    train: Train, operation: Operation, models: Sequence[Models], nodes: int = NODES_OF_TRAINS
) -> TrainCycle:
    """States of a train over its period, integrated segment by segment between the events of all meshes.

    Where planets share a load, equilibrium leaves open how: of all forces in equilibrium those are taken
    that, over equal ones without friction, have the least sum of squares; planets in phase share equally. A
    planet that either flank of a mesh without load would push onto the other one lies on neither.

    Args:
        train: see `gear_train`.
        operation: load of the loaded body, speed of the driving one, temperature of the oil; one point.
        models: laws of each mesh.
        nodes: Gauss-Lobatto nodes in each segment.

    From the equilibrium of every body under the forces of all its contacts with their friction; the sides of
    friction are those of the sliding that the motion asks for. Losses beside the teeth may press the other
    flanks of a mesh that carries little: these are taken to lie as the loaded ones do, which is so in the
    mean over a period.
    """
    demand_double()
    phase, weight = period_nodes(jnp.concatenate([*_events(train, models)]), nodes)
    phase, weight = phases_past_ties(phase, weight).ravel() / train.turns, weight.ravel()
    every = [
        _Meshing(train, mesh, operation, laws, phase)
        for mesh, laws in zip(train.meshes, models, strict=True)
    ]
    if train.drag:
        _press(train, every, operation)
    _leave_open(every)
    solved = _solve(train, every, operation)
    lost = solved.code != int(Code.SOLVED)
    forces = _by_mesh(every, jnp.where(lost, jnp.nan, solved.forces))
    states = tuple(meshing.state(force) for meshing, force in zip(every, forces, strict=True))
    places = _places(train, every, forces, operation)
    torques = _torques(train, every, forces, places)
    rates, roles = jnp.stack([train.rates[body] for body in train.bodies]), train.roles
    on_bodies = jnp.stack([torques.get(body, 0.0 * weight) for body in train.bodies])
    driving = on_bodies[roles.turned] * jnp.sign(rates[roles.turned])
    power_out = operation.load * jnp.abs(rates[roles.loaded]) * operation.speed
    balanced = train.free if train.turned else ()
    return TrainCycle(
        phase,
        weight,
        states,
        {body: torque for body, torque in torques.items() if body not in balanced},
        sum((place.lost for place in places), jnp.zeros_like(weight)),
        tuple(place.pressed for place in places),
        _mean_on_planet(train, every, forces),
        driving,
        driving * operation.speed,
        jnp.where(lost, jnp.nan, power_out),
        _levers(train, every),
        Status(solved.code, solved.residual, solved.steps),
        nodes,
    )


def _events(train: Train, models: Sequence[Models]) -> Iterator[Float[Array, " event"]]:
    """Parts of what repeats of a train at which anything begins or ends in a mesh.

    What happens to one planet then happens to every other one at the same time in another part.
    """
    for mesh, laws in zip(train.meshes, models, strict=True):
        events = events_of(mesh.design.mesh, laws.sharing)
        turns = jnp.arange(mesh.most_periods)[:, None, None]
        turns = jnp.where(turns < mesh.periods, turns, 0)  # again those of the first one
        phases = mesh.phases[:1] if train.alike else mesh.phases
        ahead = (events[:, None] - phases) * train.onward(mesh)
        yield jnp.mod(train.turns * (ahead + turns) / mesh.periods, 1.0).ravel()


class _Meshing:
    """The contacts of a mesh of a train, and what they do for a unit of force on each copy.

    Args:
        train: of which.
        mesh: of it.
        operation: of the train.
        models: laws of the mesh.
        phase: nodes of the period of the train.
    """

    def __init__(
        self, train: Train, mesh: TrainMesh, operation: Operation, models: Models, phase: Nodes
    ) -> None:
        self.mesh, self.models = mesh, models
        self.planets, self.there = train.planets, mesh.there[:, None]
        design, turned = mesh.design, train.onward(mesh) * mesh.periods * phase
        self.contacts: Contacts = design.mesh.contacts(mesh.phases[:, None] + turned)
        motion = train.motion(mesh)
        speed = jnp.abs(design.driver @ motion) * operation.speed
        self.driving = design.driver * jnp.sign(design.driver @ motion)
        self.operation = Operation(
            mesh.carried / mesh.count * operation.load, speed, operation.temperature
        )
        self.share = models.share(design, self.contacts, self.operation.load)
        arm = jnp.abs(total(self.share * contact_velocity(self.contacts.normal, design.loaded)))
        self.rates = motion * operation.speed
        self.carry(self.operation.load / arm)
        self.either: Bool[Array, "..."] = jnp.asarray(bool(train.drag))
        self.idle: Bool[Array, "..."] = jnp.asarray(False)
        slip, roll = (
            contact_velocity(self.contacts.slip_arm, motion),
            contact_velocity(self.contacts.roll_arm, motion),
        )
        # Beside the pitch point by rounding, a contact does not slide.
        self.sense = jnp.where(jnp.abs(slip) > 1e-13 * jnp.abs(roll), jnp.sign(slip), 0.0)
        self.turn = jnp.sign(roll)
        self.carrying = self.contacts.active & (self.share > 0.0) & self.there
        self.normal = jnp.stack([total(self.share * n) for n in self.contacts.normal])
        self.sliding = self.share * self.sense
        self.direction = jnp.stack([total(self.share * d) for d in self.contacts.direction])
        self.rolls = models.rolling.name != "none"

    def carry(self, nominal: Copies) -> None:
        """Take these as the normal forces without friction."""
        self.nominal = jnp.where(self.there, nominal, 0.0)
        self.unloaded = self.mesh.design.conditions(
            self.contacts,
            self.operation,
            load=jnp.zeros_like(self.share),
            nominal_load=jnp.where(self.there, nominal, 1.0),
            rates=self.rates,
        )

    def laws(self, force: Copies) -> tuple[Lanes, Lanes]:
        """Friction coefficient and rolling resistance [N] of each slice under normal forces of the copies."""
        # Of a train that friction locks a force comes out negative: the law is asked for the usual one there.
        force = force * self.pressing(force)
        pushed = jnp.where(force > 0.0, force, jnp.where(self.nominal > 0.0, self.nominal, 1.0))
        at = replace(self.unloaded, load=jnp.where(self.carrying, self.share, 1.0) * pushed)
        loaded = self.carrying & (self.nominal > 0.0)
        coefficient = jnp.where(loaded, self.models.coefficient(at), 0.0)
        if not self.rolls:
            return coefficient, jnp.zeros_like(coefficient)
        resistance = evaluate(self.models.rolling, at) * self.contacts.weight
        return coefficient, jnp.where(loaded, resistance, 0.0)

    def pressing(self, force: Copies) -> Copies:
        """One, or minus one where losses press the other flanks, where they may: see `_leave_open`."""
        return jnp.where((force < 0.0) & self.either, -1.0, 1.0)

    def torques(self, coefficient: Lanes, force: Copies) -> Float[Array, "dof copy node"]:
        """Torques from outside on the coordinates that a unit of normal force on each copy asks for."""
        rubbing = coefficient * self.sliding
        friction = jnp.stack([total(rubbing * arm) for arm in self.contacts.slip_arm])
        return (self.normal + friction * self.pressing(force)) * self.there

    def rolling_torques(self, resistance: Lanes) -> Float[Array, "dof copy node"]:
        """Torques from outside on the coordinates that rolling resistance asks for."""
        if not self.rolls:
            return jnp.zeros_like(self.normal)
        return jnp.stack([total(resistance * self.turn * arm) for arm in self.contacts.roll_arm])

    def pressed(self, body: str, force: Copies) -> Vectors:
        """Force on a body of the mesh by its normal forces [N], x from the central axis to the planet.

        From action and reaction along the normals; on other flanks it pushes the other way round the body
        and apart as on the loaded ones.
        """
        number = self.mesh.bodies.index(body)
        places = jnp.stack(
            [coordinate.place[0] for coordinate in self.mesh.design.mesh.coordinates]
        )
        planet = next((k for k, name in enumerate(self.mesh.bodies) if name in self.planets), 1)
        outward = jnp.sign(places[planet] - places[1 - planet])
        toward = outward * self.pressing(force)
        unit = (2.0 * number - 1.0) * self.direction
        return (
            unit * force * jnp.stack([toward, outward * jnp.ones_like(force), jnp.ones_like(force)])
        )

    def of_force(self, coefficient: Lanes, force: Copies) -> dict[str, Copies]:
        """Torques of a unit of force, by body."""
        return self.mesh.arms(self.torques(coefficient, force))

    def of_rolling(self, resistance: Lanes) -> dict[str, Copies]:
        """Torques of rolling resistance, by body."""
        return self.mesh.arms(self.rolling_torques(resistance))

    def state(self, force: Copies) -> MeshState:
        """What follows from the forces of the copies."""
        coefficient, resistance = self.laws(force)
        at = replace(self.unloaded, load=self.share * force * self.pressing(force))
        driver = self.driving @ jnp.stack(
            [
                jnp.sum(arm * force + rolling, axis=0)
                for arm, rolling in zip(
                    self.torques(coefficient, force), self.rolling_torques(resistance), strict=True
                )
            ]
        )
        return MeshState(
            at,
            coefficient,
            at.load * coefficient * product_array(at.sliding),
            2.0 * resistance * product_array(at.entrainment),
            force,
            jnp.where(self.idle, 0.0, self.nominal),
            driver,
            self.operation.speed,
        )


class _Balanced(eqx.Module):
    forces: Forces
    residual: Nodes
    steps: Int[Array, ""]
    code: Int[Array, " node"]


class _ForceSearch(NamedTuple):
    """A step of the search for forces, with the changes of flanks up to it."""

    forces: Forces
    turns: Int[Array, "force node"]
    residual: Nodes
    steps: Int[Array, ""]


def _solve(train: Train, every: Sequence[_Meshing], operation: Operation) -> _Balanced:
    """Forces of all copies in equilibrium; friction is that under the forces of the step before."""
    external = _asked(train, operation)
    either = jnp.concatenate(
        [jnp.broadcast_to(meshing.either, meshing.nominal.shape) for meshing in every]
    )
    # A planet alone is held by the mesh, whichever flank it is.
    one_of_several = either & jnp.concatenate(
        [jnp.broadcast_to(meshing.mesh.count > 1.0, meshing.nominal.shape) for meshing in every]
    )

    def step(held: _ForceSearch) -> _ForceSearch:
        forces, turns, _, steps = held
        by_mesh = _by_mesh(every, forces)
        laws = [meshing.laws(force) for meshing, force in zip(every, by_mesh, strict=True)]
        taken = [
            meshing.of_rolling(rolling)
            for meshing, (_, rolling) in zip(every, laws, strict=True)
            if meshing.rolls
        ]
        arms = _arms(
            train,
            [
                meshing.of_force(mu, force)
                for meshing, (mu, _), force in zip(every, laws, by_mesh, strict=True)
            ],
        )
        wanted = external - jnp.sum(_arms(train, taken), axis=1) if taken else external
        if train.drag:
            wanted = wanted - _on_rows(train, _places(train, every, by_mesh, operation))
        each_torque = arms * forces
        left = jnp.sum(each_torque, axis=1) - wanted
        size = jnp.max(jnp.abs(each_torque), axis=1)
        # A body that idles is in balance within rounding of the forces in the rest of the train.
        size = jnp.maximum(size, IDLE * jnp.max(size, axis=0))
        residual = jnp.max(jnp.abs(left) / jnp.where(size > 0.0, size, 1.0), axis=0)
        scale = jnp.where(turns < MOST_TURNS, usual, 0.0)
        renewed = scale * _least(arms * scale, wanted, _apart(train))
        turned = one_of_several & (renewed * forces < 0.0)
        return _ForceSearch(renewed, turns + turned, residual, steps + 1)

    def goes_on(held: _ForceSearch) -> Array:
        return (held.steps < MOST_STEPS) & jnp.any(held.residual > NEAR)

    nominal = jnp.concatenate([meshing.nominal for meshing in every])
    largest = jnp.max(nominal, axis=0)
    idle = nominal <= IDLE * largest
    nominal = jnp.maximum(nominal, jnp.where(largest > 0.0, IDLE * largest, 1.0))
    # Forces of a mesh that idles without losses are free to become what these ask for.
    usual = jnp.where(idle & (largest > 0.0), largest, nominal)
    turns, unknown = jnp.zeros(nominal.shape, int), jnp.full(nominal.shape[1], jnp.inf)
    begin = _ForceSearch(nominal, turns, unknown, jnp.asarray(0))
    forces, _, residual, steps = jax.lax.while_loop(goes_on, step, begin)
    pulled = forces < -IDLE * jnp.max(jnp.abs(forces), axis=0)
    # Where other flanks may be pressed, no forces hold a train that is locked.
    pulled = jnp.any(pulled & ~either, axis=0)
    code = jnp.where(pulled, int(Code.LOCKED), int(Code.SOLVED))
    code = jnp.where(residual <= UNSOLVED, code, int(Code.NOT_CONVERGED))
    return _Balanced(forces, residual, steps, code)


def _asked(train: Train, operation: Operation) -> Float[Array, "row 1"]:
    """Torques from outside on the bodies in equilibrium."""
    rates, roles = jnp.stack([train.rates[body] for body in train.bodies]), train.roles
    load = -jnp.sign(rates[roles.loaded]) * operation.load
    return jnp.zeros((*roles.rows.shape, 1)).at[0].set(load)


def _levers(train: Train, every: Sequence[_Meshing]) -> Float[Array, "2 node copy body mesh"]:
    """See `TrainCycle.levers`; places without a planet have those of the first one."""
    places = max(meshing.mesh.places for meshing in every)

    def on_bodies(meshing: _Meshing, coefficient: float) -> Float[Array, "body copy node"]:
        arms = meshing.of_force(jnp.where(meshing.carrying, coefficient, 0.0), meshing.nominal)
        nothing = jnp.zeros(meshing.nominal.shape)
        by_body = (arms.get(body, nothing) for body in train.bodies)
        on_each = jnp.stack([jnp.where(meshing.there, arm, arm[:1]) for arm in by_body])
        on_each = jnp.broadcast_to(on_each, (len(train.bodies), places, on_each.shape[-1]))
        return on_each[train.roles.balanced]

    normal, with_friction = (
        jnp.stack([on_bodies(meshing, coefficient) for meshing in every], axis=-1)
        for coefficient in (0.0, 1.0)
    )
    return jnp.moveaxis(jnp.stack([normal, with_friction - normal]), (3, 2), (1, 2))


def _arms(train: Train, every: Sequence[Mapping[str, Copies]]) -> Arms:
    """Torques on the bodies in equilibrium by mesh and copy, those of planets on the planet of the copy."""
    rows = {place: row for row, place in enumerate(train.rows())}
    columns = []
    for by_body in every:
        copies, nodes = next(iter(by_body.values())).shape
        for copy in range(copies):
            column = [jnp.zeros(nodes)] * len(rows)
            for body, values in by_body.items():
                row = rows.get((body, copy if body in train.planets else 0))
                if row is not None:
                    column[row] = column[row] + values[copy]
            columns.append(jnp.stack(column)[train.roles.rows])
    return jnp.stack(columns, axis=1)


def _apart(train: Train) -> int:
    """How many of the last rows share no force: those of the copies of one planet."""
    last = max(train.planets, key=train.bodies.index, default="")
    return sum(body == last for body, _ in train.rows())


def _least(arms: Arms, wanted: Rows, apart: int) -> Forces:
    """Parts of the nominal forces of the least sum of squares that give the torques wanted.

    Args:
        arms: of the forces in each row.
        wanted: torque of each row.
        apart: how many of the last rows have no force in common.

    By Lagrange's multipliers, one for each row. Rows that have no force in common are taken off the others
    first, which leaves a system of these few: a third of the time of one of all rows. A second pass takes off
    what rounding leaves of the first.
    """
    size = jnp.max(jnp.abs(arms), axis=1, keepdims=True)
    absent = size == 0.0  # of a planet that is not there
    size = jnp.where(absent, 1.0, size)
    arms, wanted = arms / size, wanted / size[:, 0]
    count = arms.shape[0] - apart
    planets, square = arms[count:], jnp.sum(arms[count:] ** 2, axis=1)
    planets = planets / jnp.where(absent[count:, 0], 1.0, square)[:, None]
    taken = jnp.sum(arms[:count, None] * planets, axis=2)
    central = arms[:count] - jnp.sum(taken[:, :, None] * arms[count:], axis=1)
    system = jnp.sum(central[:, None] * central, axis=2)
    inverse = _inverse(system + jnp.eye(count)[..., None] * absent[:count])

    def solved(right: Rows) -> Forces:
        left = right[:count] - jnp.sum(taken * right[count:], axis=1)
        multipliers = jnp.sum(inverse * left, axis=1)
        of_central = jnp.sum(central * multipliers[:, None], axis=0)
        return of_central + jnp.sum(planets * right[count:, None], axis=0)

    forces = solved(wanted)
    return forces + solved(wanted - jnp.sum(arms * forces, axis=1))


def _inverse(system: Float[Array, "row row node"]) -> Float[Array, "row row node"]:
    """Inverses of positive definite matrices, by as many steps of elimination as they have rows.

    LAPACK takes some microseconds for each matrix of a few rows, this one of them for ten.
    """
    for row in range(system.shape[0]):
        pivot = 1.0 / system[row, row]
        taken = system[row] * pivot
        reduced = system - system[:, row, None] * taken[None]
        reduced = reduced.at[:, row].set(-system[:, row] * pivot)
        system = reduced.at[row].set(taken.at[row].set(pivot))
    return system


def _by_mesh(every: Sequence[_Meshing], forces: Forces) -> list[Copies]:
    """Forces of the copies of each mesh."""
    ends = np.cumsum([meshing.mesh.places for meshing in every])[:-1]
    split: list[Copies] = jnp.split(forces, ends)
    return split


def _torques(
    train: Train,
    every: Sequence[_Meshing],
    forces: Sequence[Copies],
    places: "Sequence[_NodePlace]",
) -> dict[str, Nodes]:
    """Torques from outside on each body; those on free ones are rounding."""
    torques: dict[str, Nodes] = {}
    for place in places:
        for body, torque in place.torques.items():
            torques[body] = torques.get(body, 0.0) + jnp.sum(torque, axis=0)
    for meshing, force in zip(every, forces, strict=True):
        coefficient, resistance = meshing.laws(force)
        rolling = meshing.of_rolling(resistance)
        for body, arm in meshing.of_force(coefficient, force).items():
            taken = jnp.sum(arm * force + rolling[body], axis=0)
            torques[body] = torques.get(body, jnp.zeros_like(taken)) + taken
    return torques


class _NodePlace(NamedTuple):
    """A place beside the teeth at the nodes.

    Attributes:
        torques: from outside that overcome what it takes, by body, for each planet that is braked, or one.
        pressed: see `TrainCycle.pressed`.
        lost: power, of all planets [W].
    """

    torques: dict[str, OfPlanets]
    pressed: Nodes
    lost: Nodes


def _places(
    train: Train, every: Sequence[_Meshing], forces: Sequence[Copies], operation: Operation
) -> list[_NodePlace]:
    """What brakes bodies beside the teeth under normal forces of the copies of each mesh."""
    viscosity = every[0].mesh.design.lubricant.kinematic_viscosity(operation.temperature)
    places = []
    for drag, bodies in zip(train.drag, train.braked, strict=True):
        rates = jnp.stack([train.rates[body] for body in bodies])
        rate = drag.between @ rates
        turns = jnp.abs(rate) > NO_TURNING * jnp.sum(jnp.abs(rates))
        sense = jnp.where(turns, jnp.sign(rate), 0.0)
        borne = _borne(train, every, forces, bodies, operation.speed)
        load = drag.preload + borne * (drag.bearing.name != "none")
        speed = jnp.abs(rate) * operation.speed
        torque = drag.torque(speed=speed, load=load, kinematic_viscosity=viscosity)
        there = _there(train, every, bodies)
        torque = torque * there
        torques = {
            body: side * sense * torque for body, side in zip(bodies, drag.between, strict=True)
        }
        lost = jnp.sum(torque, axis=0) * speed * turns
        mean = jnp.sum(load * there, axis=0) / jnp.sum(there, axis=0)
        places.append(_NodePlace(torques, mean, lost))
    return places


def _there(train: Train, every: Sequence[_Meshing], bodies: tuple[str, str]) -> Float[Array, "_ 1"]:
    """One for each planet that a place beside the teeth is at, zero where none stands; or one."""
    braked = {*bodies} & {*train.planets}
    of_planet = [meshing.there for meshing in every if braked & {*meshing.mesh.bodies}]
    return jnp.where(of_planet[0], 1.0, 0.0) if of_planet else jnp.ones((1, 1))


def _borne(
    train: Train,
    every: Sequence[_Meshing],
    forces: Sequence[Copies],
    bodies: tuple[str, str],
    speed: Float[Array, ""],
) -> OfPlanets:
    """Size of what is on the bearing between two bodies, of each planet that it is in [N].

    From the forces of a planet in all its meshes and the centrifugal one, added as vectors; of central bodies
    and of the carrier from those of all planets around them, which cancel as far as planets share alike.
    """
    nothing = jnp.zeros((1, forces[0].shape[-1]))
    pairs = list(zip(every, forces, strict=True))
    if any(body in train.planets for body in bodies):
        carrier = next(meshing.mesh.carrier for meshing in every if meshing.mesh.carrier != HOUSING)
        outward = train.pull * (train.rates[carrier] * speed) ** 2
        return _size(_on_planets(train, every, forces).at[0].add(outward))
    if HOUSING not in bodies:
        return nothing
    (body,) = (name for name in bodies if name != HOUSING)
    around = [
        meshing.pressed(body, force) for meshing, force in pairs if body in meshing.mesh.bodies
    ]
    if any(meshing.mesh.carrier == body for meshing in every):
        around.append(_on_planets(train, every, forces))
    return sum((_size(_around(force, train.angles)) for force in around), nothing)


def _on_planets(train: Train, every: Sequence[_Meshing], forces: Sequence[Copies]) -> Vectors:
    """Force of the teeth on each planet by all its meshes, see `_Meshing.pressed` [N]."""
    first, *others = [
        meshing.pressed(body, force)
        for meshing, force in zip(every, forces, strict=True)
        for body in meshing.mesh.bodies
        if body in train.planets
    ]
    return sum(others, first)


def _mean_on_planet(
    train: Train, every: Sequence[_Meshing], forces: Sequence[Copies]
) -> Float[Array, "3 node"]:
    """See `TrainCycle.on_planet`; nothing where there are no planets."""
    counts = [meshing.mesh.count for meshing in every if {*meshing.mesh.bodies} & {*train.planets}]
    if not counts:
        return jnp.zeros((3, forces[0].shape[-1]))
    return jnp.sum(_on_planets(train, every, forces), axis=1) / counts[0]


def _around(vectors: Vectors, angles: Float[Array, " copy"]) -> Float[Array, "3 1 node"]:
    """Sum of forces about an axis, each in the frame of its planet."""
    x, y, z = vectors
    if x.shape[0] == 1:  # a mesh in the housing
        return vectors
    cosine, sine = jnp.cos(angles)[:, None], jnp.sin(angles)[:, None]
    turned = jnp.stack([cosine * x - sine * y, sine * x + cosine * y, z])
    return jnp.sum(turned, axis=1, keepdims=True)


def _size(vector: Float[Array, "3 _ node"]) -> OfPlanets:
    size: OfPlanets = square_root(jnp.sum(vector**2, axis=0))
    return size


def _on_rows(train: Train, places: Sequence[_NodePlace]) -> Rows:
    """Torques that overcome losses beside the teeth, on the bodies in equilibrium."""
    nodes = places[0].pressed.shape
    rows = {row: jnp.zeros(nodes) for row in train.rows()}
    for place in places:
        for body, torque in place.torques.items():
            for number in range(torque.shape[0] if body in train.planets else 1):
                if (body, number) in rows:
                    taken = torque[number] if body in train.planets else jnp.sum(torque, axis=0)
                    rows[body, number] += taken
    return jnp.stack([*rows.values()])[train.roles.rows]


def _leave_open(every: Sequence[_Meshing]) -> None:
    """Let losses choose the flanks of meshes that carry nothing without them.

    As that of the sun of a 3K set between two rings: what rounding leaves has no side.
    """
    nominal = jnp.concatenate([meshing.nominal for meshing in every])
    rounding = IDLE * jnp.max(nominal, axis=0)
    for meshing in every:
        meshing.idle = meshing.nominal <= rounding
        meshing.either = meshing.either | meshing.idle


def _press(train: Train, every: Sequence[_Meshing], operation: Operation) -> None:
    """Give meshes the normal forces that losses beside the teeth leave them without friction."""
    still = [jnp.zeros_like(meshing.nominal) for meshing in every]
    arms = _arms(
        train,
        [
            meshing.of_force(jnp.zeros_like(meshing.share), force)
            for meshing, force in zip(every, still, strict=True)
        ],
    )
    taken = _on_rows(train, _places(train, every, still, operation))
    forces = _least(arms, _asked(train, operation) - taken, _apart(train))
    for meshing, force in zip(every, _by_mesh(every, forces), strict=True):
        meshing.carry(jnp.abs(force))
