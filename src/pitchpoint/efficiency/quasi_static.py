"""The quasi-static state of a mesh at any phase, and its cycle between events."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import equinox as eqx
import numpy as np
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import array, demand_double, jax, jnp
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT, USUAL_ELLIPSE, EllipticContact
from pitchpoint.contact.contacts import Contacts, contact_velocity, total
from pitchpoint.core.brief import brief
from pitchpoint.core.factored import Arrays, Numbers, product_array
from pitchpoint.core.programs import program
from pitchpoint.core.status import Status
from pitchpoint.efficiency.drag import Drag, resistance
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.coordinates import number_of
from pitchpoint.gears.gear_body import GearBody
from pitchpoint.gears.mesh import Mesh, coordinates_of, has
from pitchpoint.gears.nominal_motion import (
    MOTORS,
    mesh_ends,
    nominal_motion,
    nominal_period,
    phase_sense,
    turned_rates,
)
from pitchpoint.gears.on_balls import Body
from pitchpoint.gears.pairs import touching
from pitchpoint.gears.period import nodes as period_nodes
from pitchpoint.gears.period import polynomial_matrices
from pitchpoint.loading.balance import Balance, first_guess, force_balance, tooth_load
from pitchpoint.loading.balance import Drag as TorqueOnBodies
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.loading_registry import LoadSharing
from pitchpoint.loading.sharing import from_stiffness
from pitchpoint.loading.tooth_compliance import TeethAt, Terms, terms_of
from pitchpoint.loading.wind_up import wound_up
from pitchpoint.lubrication.conditions import Conditions, evaluate
from pitchpoint.lubrication.lubrication_registry import (
    FilmThickness,
    FrictionLaw,
    RollingResistance,
)
from pitchpoint.materials.lubricants import Lubricant
from pitchpoint.materials.solids import Solid, reduced_modulus
from pitchpoint.materials.surfaces import Roughness

__all__ = [
    "Cycle",
    "Design",
    "Engagement",
    "Models",
    "Operation",
    "State",
    "contacts_at",
    "coupling",
    "cycle",
    "cycle_nodes",
    "cycle_of",
    "engagement",
    "engagement_alone",
    "events_of",
    "extremes",
    "forces_at_nodes",
    "power_ratio",
    "shares_at",
    "state",
]

Lanes = Float[Numbers, "pair slice *#b"]
Each = Float[Arrays, "*#b"]
Coupling = Body

FEWEST = 32
"""Pairs that are kept of many; more are twice as many, and so on."""

ROUNDING = 1e-13
"""Output over input power up to which no power is transmitted: an idle drive has rounding alone."""


class Design(eqx.Module):
    """What is built once: the mesh, its materials, oil and surfaces, and what brakes it beside the teeth.

    Attributes:
        mesh: any gear family.
        solids: material of each member.
        lubricant: the oil.
        roughness: of both flanks.
        drag: places beside the teeth where power is lost; none by default.
        elliptic: how an elliptic contact follows from its load; static.
        driver: one for the coordinate that drives, zero elsewhere; by default see `mesh_ends`, which takes
            one mesh: of a batch give both, with its axis in front.
        loaded: one for the coordinate whose load is prescribed, zero elsewhere; what is left stands still.
    """

    mesh: Mesh
    solids: tuple[Solid, Solid]
    lubricant: Lubricant
    roughness: Roughness
    drag: tuple[Drag, ...] = ()
    elliptic: EllipticContact = eqx.field(static=True, default=ELLIPTIC_CONTACT[USUAL_ELLIPSE])
    driver: Float[Arrays, " dof"] = eqx.field(default=None)
    loaded: Float[Arrays, " dof"] = eqx.field(default=None)

    def __post_init__(self) -> None:
        if (self.driver is None) != (self.loaded is None):
            raise InputError("driver and loaded coordinate are given together, see `driven_by`")
        if self.driver is not None and self.driver is self.loaded:
            raise InputError("one coordinate cannot drive and be loaded at once")
        if self.driver is None:
            self.driver, self.loaded = mesh_ends(self.mesh)

    def __repr__(self) -> str:
        return brief(self)

    @property
    def modulus(self) -> Float[Array, ""]:
        """Reduced modulus E' [Pa], 2/E' = sum of (1 - nu^2)/E over both members."""
        return reduced_modulus(*self.solids)

    @property
    def motion(self) -> Float[Array, " dof"]:
        """Rates of the coordinates of the mesh for a unit rate of the driver, see `nominal_motion`."""
        return nominal_motion(self.mesh, self.driver, self.loaded)

    @property
    def period(self) -> Float[Array, ""]:
        """Motion of the driver in one period [rad or m]."""
        return nominal_period(self.mesh, self.motion)

    @property
    def onward(self) -> Float[Array, ""]:
        """Sense in which the phase runs while the drive turns on: one, or minus one."""
        return phase_sense(self.mesh, self.motion)

    @property
    def backwards(self) -> "Design":
        """The same, driven by the member that is loaded, in the sense that presses the same flanks.

        Raises:
            InputError: bodies have motors of their own.
        """
        if has(self.mesh, turned_rates):
            raise InputError(MOTORS)
        return replace(self, driver=self.loaded, loaded=self.driver)

    def driven_by(self, driver: str | int, loaded: str | int | None = None) -> "Design":
        """The same with another member driving, in the sense that presses the same flanks.

        Args:
            driver: name of a body, or number of its coordinate.
            loaded: likewise; by default a member that is fixed stays so, and the one that drove is loaded.

        Raises:
            InputError: there is no such body, it is fixed, or bodies have motors of their own.
        """
        if loaded is not None:
            input_end, output_end = mesh_ends(self.mesh, driver, loaded)
            return replace(self, driver=input_end, loaded=output_end)
        names = tuple(place.body for place in coordinates_of(self.mesh))
        drives = number_of(driver, names)
        if np.asarray(self.driver)[drives]:
            return self
        if not np.asarray(self.loaded)[drives] and not has(self.mesh, turned_rates):
            raise InputError(f"the {names[drives]} is fixed and cannot drive")
        return self.backwards

    def conditions(
        self,
        contacts: Contacts,
        operation: "Operation",
        *,
        load: Lanes,
        nominal_load: Each,
        rates: Float[Array, "dof *#b"] | None = None,
    ) -> Conditions:
        """Conditions at the contacts, for laws of friction and film.

        A vibration asks the same laws with its own forces and rates.

        Args:
            contacts: of the mesh.
            operation: speed of the driver and temperature of the oil.
            load: normal force of each slice [N].
            nominal_load: normal force of the whole mesh without friction [N].
            rates: of the coordinates [rad/s or m/s]; those of the nominal motion by default.
        """
        oil, temperature, mesh = self.lubricant, operation.temperature, self.mesh
        # Per radian of the driver: laws keep the speed as a factor on axes of its own.
        motion = self.motion if rates is None else rates / operation.speed
        return Conditions(
            contacts=contacts,
            load=load,
            nominal_load=nominal_load,
            slip=contact_velocity(contacts.slip_arm, motion),
            roll=contact_velocity(contacts.roll_arm, motion),
            speed=operation.speed,
            modulus=self.modulus,
            temperature=temperature,
            viscosity=oil.viscosity(temperature),
            kinematic_viscosity=oil.kinematic_viscosity(temperature),
            pressure_viscosity=oil.pressure_viscosity(temperature),
            viscosity_slope=oil.viscosity_slope(temperature),
            conductivity=oil.conductivity,
            lubricant_factor=oil.lubricant_factor,
            roughness_ra=self.roughness.mean_ra,
            roughness_rq=self.roughness.composite_rq,
            hardness=jnp.minimum(*(solid.hardness for solid in self.solids)),
            reference=pitch_point(mesh, self.driver) if has(mesh, pitch_point) else None,
            elliptic=self.elliptic,
        )


class Operation(eqx.Module):
    """Operating points.

    Attributes:
        load: torque (or force) that the loaded coordinate carries, not negative [N m or N].
        speed: of the driver, positive [rad/s].
        temperature: of the oil [K].
    """

    load: Each
    speed: Each
    temperature: Each


class Models(eqx.Module):
    """Which law stands for which effect.

    Rival friction laws share one compiled program: `choice` picks one of them at run time.

    Attributes:
        friction: laws of the friction coefficient, one of which acts.
        choice: index of the one that acts.
        parameters: values of the laws' own parameters by name of the law.
        sharing: of the load between pairs.
        rolling: rolling resistance.
        compliance: terms of the model by which teeth yield, where the sharing asks for it.
        held: friction coefficient of each slice that was found elsewhere and takes the place of the law;
            other values need no other program.
        held_rolling: rolling resistance on each surface of each slice, found likewise, in the place of
            `rolling` and in its unit.
        film: law of the film thickness, for figures of a cycle; they have no film ratio without one.
    """

    friction: tuple[FrictionLaw, ...] = eqx.field(static=True)
    choice: Int[Arrays, ""]
    parameters: Mapping[str, Mapping[str, Float[Array, ""]]]
    sharing: LoadSharing = eqx.field(static=True)
    rolling: RollingResistance = eqx.field(static=True)
    compliance: Terms = eqx.field(default_factory=lambda: terms_of("beam_foundation_weber"))
    held: Lanes | None = None
    held_rolling: Lanes | None = None
    film: FilmThickness | None = eqx.field(static=True, default=None)

    def __repr__(self) -> str:
        return brief(self)

    @cached_property
    def law(self) -> FrictionLaw:
        """The friction law that acts."""
        return self.friction[int(self.choice)]

    @property
    def of_meshes(self) -> "tuple[Models, ...]":
        """Models of each mesh: of the only one."""
        return (self,)

    @property
    def each(self) -> "tuple[Models, ...]":
        """The same models under each of the friction laws."""
        return tuple(replace(self, choice=array(number)) for number in range(len(self.friction)))

    @cached_property
    def without_film(self) -> "Models":
        """The same without the law of the film, for what does not ask for it."""
        return replace(self, film=None)

    @cached_property
    def without_friction(self) -> "Models":
        """The same without friction laws, for what does not ask for them: its programs serve every law."""
        return replace(
            self,
            friction=(),
            choice=product_array(np.array(0)),  # one of JAX might belong to whatever is traced now
            parameters={},
            held=None,
            held_rolling=None,
            film=None,
        )

    def holding(self, friction: Lanes, rolling: Lanes | None = None) -> "Models":
        """The same with friction that was found elsewhere in the place of laws.

        Args:
            friction: coefficient of each slice.
            rolling: resistance on each surface of each slice [N/m of a line, N of an ellipse]; by default
                that of the law.
        """
        return replace(self.without_friction, held=friction, held_rolling=rolling)

    def coefficient(self, conditions: Conditions) -> Lanes:
        """Friction coefficient at every contact by the law that acts."""

        def branch(law: FrictionLaw) -> Callable[[Conditions], Lanes]:
            return lambda at: evaluate(law, at, self.parameters.get(law.name))

        if self.held is not None:
            return jnp.broadcast_to(self.held, conditions.load.shape)
        if len(self.friction) == 1:
            return branch(self.friction[0])(conditions)
        chosen: Lanes = jax.lax.switch(
            self.choice, [branch(law) for law in self.friction], conditions
        )
        return chosen

    def share(
        self,
        design: Design,
        contacts: Contacts,
        load: Each,
        body: Coupling | None = None,
        teeth: TeethAt | None = None,
    ) -> Lanes:
        """Share of the load on each slice.

        Args:
            design: mesh and materials.
            contacts: of the mesh.
            load: that the loaded coordinate carries [N m or N].
            body: compliance of what is under the teeth, where it is known already.
            teeth: where the contacts lie on them, likewise.
        """
        mesh, yields = design.mesh, None
        if self.sharing.by_stiffness:
            elastic = mesh, design.loaded, contacts, design.solids, self.compliance
            yields = compliance(*elastic, load, body, teeth)
        return self.sharing.function(contacts, mesh, yields)


class Engagement(eqx.Module):
    """Contacts of a mesh over one period and their shares of one load, computed beforehand.

    Attributes:
        phase, weight: nodes of the cycle and their weights [node].
        contacts: at the nodes, batch axis `node`.
        share: of the load on each slice.
        body: compliance of what is under the teeth, whatever the load [m/N]; None where it does not
            couple them or the sharing does not ask for it.
        nodes: static, nodes in each segment between events.
    """

    phase: Float[Array, " node"]
    weight: Float[Array, " node"]
    contacts: Contacts
    share: Float[Arrays, "pair slice node"]
    body: Body | None
    nodes: int = eqx.field(static=True)

    def loaded(self) -> "Engagement":
        """Only the pairs that carry at some node.

        Losses and torques come from these alone. Their number doubles where it must grow, so that few
        programs serve all loads; the compliance of the bodies is left out.
        """
        carries = np.any(np.asarray(self.share) > 0.0, axis=(1, 2))
        count = FEWEST
        while count < carries.sum():
            count *= 2
        pairs = np.sort(np.argsort(~carries, kind="stable")[:count])

        def of_them(leaf: Array) -> np.ndarray:
            return np.asarray(leaf)[..., pairs, :, :]

        contacts, share = jax.tree.map(of_them, (self.contacts, self.share))
        return replace(self, contacts=contacts, share=share, body=None)

    def of_rank(self, rank: int) -> tuple[Contacts, Lanes]:
        """Contacts and shares with so many batch axes, the last one that of the nodes."""

        def widened(leaf: Array) -> Array:
            return leaf.reshape(*leaf.shape[:-1], *(1 for _ in range(rank - 1)), leaf.shape[-1])

        engaged: tuple[Contacts, Lanes] = jax.tree.map(widened, (self.contacts, self.share))
        return engaged


def engagement(
    design: Design,
    load: Float[Array, ""],
    models: Models,
    nodes: int = 24,
    like: Engagement | None = None,
) -> Engagement:
    """Contacts and shares for one load, in programs that serve all later ones.

    Worth it for meshes whose pairs have gaps: contacts and shares take most of the work there. A cycle
    without it computes them itself.

    Args:
        design: mesh and materials.
        load: that the loaded coordinate carries [N m or N].
        models: sharing and compliance.
        nodes: in each segment between events.
        like: of the same mesh, solids and nodes under another load: what does not depend on it is
            taken from there.
    """
    if like is None:
        phase, weight = _nodes(design.mesh, models.sharing, nodes)
        contacts = contacts_at(design.mesh, phase)
        body = (
            coupling(design.mesh.body, design.solids, contacts)
            if models.sharing.by_stiffness
            else None
        )
    else:
        phase, weight, contacts, body = like.phase, like.weight, like.contacts, like.body
    share = shares_at(design, contacts, load, models, body)
    return Engagement(phase, weight, contacts, share, body, nodes)


def shares_at(
    design: Design, contacts: Contacts, load: Each, models: Models, body: Coupling | None
) -> Lanes:
    """Share of the load on each slice; that from stiffness by the program of the wind-up.

    Args:
        design: mesh and materials.
        contacts: of the mesh.
        load: that the loaded coordinate carries [N m or N].
        models: sharing and compliance.
        body: compliance of what is under the teeth, where it couples them.
    """
    if models.sharing.function is from_stiffness:
        elastic = (
            design.mesh,
            design.loaded,
            design.solids,
            models.compliance,
            jnp.asarray(load, float),
        )
        return wound_up(*elastic, contacts, body).share
    return _shares(design, contacts, load, models.without_friction, body)


def engagement_alone(
    design: Design, load: Float[Array, ""], models: Models, nodes: int = 24
) -> Engagement:
    """Contacts and shares for one load, all traced together: for meshes with few contacts.

    Arguments as in `engagement`.
    """
    phase, weight = cycle_nodes(design.mesh, models.sharing, nodes)
    contacts = design.mesh.contacts(phase)
    share = models.share(design, contacts, load[None])
    return Engagement(phase, weight, contacts, share, None, nodes)


@program
def _nodes(mesh: Mesh, sharing: LoadSharing, nodes: int) -> tuple[Array, Array]:
    return cycle_nodes(mesh, sharing, nodes)


@program
def contacts_at(mesh: Mesh, phase: Each) -> Contacts:
    """Contacts of a mesh at any phases [periods]; one program for all of a structure."""
    return mesh.contacts(phase)


@program
def coupling(body: GearBody, solids: tuple[Solid, Solid], contacts: Contacts) -> Coupling | None:
    """How far a unit force on one lane moves another; one program for all bodies of a structure."""
    return body.compliance(contacts, solids) if body.couples else None


@program
def _shares(
    design: Design, contacts: Contacts, load: Each, models: Models, body: Coupling | None
) -> Lanes:
    return models.share(design, contacts, load, body)


class State(eqx.Module):
    """Quasi-static state at phases and operating points `*b`.

    Attributes:
        contacts: where the teeth touch.
        conditions: at each of them.
        balance: forces and torques.
        sliding_loss, rolling_loss: power lost at each slice [W].
        drag_loss: power lost beside the teeth [W].
        input_torque: torque of the driver in its direction of motion [N m].
        input_power: power put in at all coordinates but the loaded one [W].
        output_power: power taken at the loaded coordinate [W]; zero where it stands still.

    Source: Tian et al. (2024), eqs. 1, 2 and 5, for any number of contacts; rolling resistance brakes
    both surfaces.
    """

    contacts: Contacts
    conditions: Conditions
    balance: Balance
    sliding_loss: Lanes
    rolling_loss: Lanes
    drag_loss: Each
    input_torque: Each
    input_power: Each
    output_power: Each

    @property
    def loss(self) -> Each:
        """Power lost in all contacts and beside the teeth [W]."""
        return total(self.sliding_loss + self.rolling_loss) + self.drag_loss

    @property
    def efficiency(self) -> Each:
        """Output over input power; NaN where no power is transmitted.

        Source: Tian et al. (2024), eq. 3.
        """
        return power_ratio(self.output_power, self.input_power)

    @property
    def normal_force(self) -> Each:
        """Sum of the normal forces of all contacts [N]."""
        return total(self.balance.load)

    @property
    def friction_force(self) -> Each:
        """Sum of the friction forces of all contacts in size [N]."""
        return total(self.balance.load * self.balance.friction)

    @property
    def status(self) -> Status:
        """What became of the search for the contact force."""
        return self.balance.status

    @property
    def locked(self) -> Bool[Array, "*b"]:
        """True where friction holds the load."""
        return self.balance.locked

    @property
    def jamming(self) -> Each:
        """Coefficient of friction from which on the mesh is locked, see `Balance`."""
        return self.balance.jamming

    @property
    def largest_friction(self) -> Each:
        """Largest friction coefficient of the contacts."""
        return self.balance.largest_friction

    @property
    def contact_force_ratio(self) -> Each:
        """Contact force over that without friction on teeth; one without load (Tian et al. 2024, eq. 18)."""
        loaded = self.balance.frictionless > 0.0
        return jnp.where(
            loaded, self.balance.force / jnp.where(loaded, self.balance.frictionless, 1.0), 1.0
        )


def state(
    design: Design,
    operation: Operation,
    phase: Each,
    models: Models,
    *,
    quick: bool = False,
    engaged: Engagement | None = None,
) -> State:
    """State of the mesh in static equilibrium with friction.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: operating points [*b], broadcast against the phases.
        phase: [*b] periods.
        models: laws.
        quick: two steps for the balance, the first one in single precision, instead of as many as it
            takes; check the residual then.
        engaged: contacts and shares at these phases, where they are known already.

    Source: Tian et al. (2024), eqs. 1, 2, 5 and 16; see `force_balance`.
    """
    demand_double()
    rank = max(jnp.ndim(x) for x in (phase, *jax.tree.leaves(operation)))
    phase, operation = jax.tree.map(lambda x: _of_rank(x, rank), (phase, operation))
    contacts, share = (None, None) if engaged is None else engaged.of_rank(rank)
    if contacts is None:
        contacts = design.mesh.contacts(phase)
    # Losses beside the teeth hardly move the shares; leaving them out, one sharing of each load
    # serves all speeds and temperatures.
    if share is None:
        share = models.share(design, contacts, operation.load)
    unloaded = _unloaded(design, operation, contacts, share)
    forces = _balance(design, operation, share, unloaded, models, quick=quick)
    return _state(design, operation, unloaded, forces)


def _unloaded(design: Design, operation: Operation, contacts: Contacts, share: Lanes) -> Conditions:
    """Conditions at the contacts before it is known what each of them carries."""
    oil, temperature = design.lubricant, operation.temperature
    drag = _drag(design, operation, contacts, oil.kinematic_viscosity(temperature))
    carried = tooth_load(contacts, loaded=design.loaded, load=operation.load, drag=drag)
    arm = jnp.abs(total(share * contact_velocity(contacts.normal, design.loaded)))
    return design.conditions(
        contacts, operation, load=jnp.zeros_like(share), nominal_load=carried / arm
    )


def _balance(
    design: Design,
    operation: Operation,
    share: Lanes,
    unloaded: Conditions,
    models: Models,
    *,
    quick: bool = False,
) -> Balance:
    """Forces under the friction law: all that a state asks of it."""
    problem = design, operation, unloaded.contacts, share, unloaded, design.motion, design.loaded
    guess = None
    if quick:
        single = jax.tree.map(_single, problem)
        guess = jnp.asarray(first_guess(**_in_balance(single, models)), jnp.float64)
    return force_balance(**_in_balance(problem, models), guess=guess)


def _state(design: Design, operation: Operation, unloaded: Conditions, forces: Balance) -> State:
    """What follows from the forces."""
    at_contact, motion, loaded = replace(unloaded, load=forces.load), design.motion, design.loaded
    driver = design.driver * jnp.sign(design.driver @ motion)
    putting, taking = (1.0 - loaded) * motion, loaded * motion
    return State(
        contacts=unloaded.contacts,
        conditions=at_contact,
        balance=forces,
        sliding_loss=forces.load * forces.friction * product_array(at_contact.sliding),
        rolling_loss=2.0 * forces.rolling * product_array(at_contact.entrainment),
        drag_loss=contact_velocity(forces.drag, motion) * operation.speed,
        input_torque=contact_velocity(forces.torque, driver),
        input_power=contact_velocity(forces.torque, putting) * operation.speed,
        output_power=-contact_velocity(forces.torque, taking) * operation.speed,
    )


_Given = tuple[Design, Operation, Contacts, Lanes, Conditions, Array, Array]


def _in_balance(problem: _Given, models: Models) -> dict[str, Any]:
    """What the balance of forces asks for, with the laws under any load."""
    design, operation, contacts, share, unloaded, motion, loaded = problem

    def friction(load: Lanes) -> Lanes:
        return models.coefficient(replace(unloaded, load=load))

    return {
        "contacts": contacts,
        "share": share,
        "motion": motion,
        "loaded": loaded,
        "load": operation.load,
        "friction": friction,
        "rolling": _rolling(models, unloaded),
        "drag": _drag(design, operation, contacts, unloaded.kinematic_viscosity),
    }


def _rolling(models: Models, unloaded: Conditions) -> Callable[[Lanes], Lanes] | None:
    """Rolling resistance of each slice [N] under any load; None without any."""
    weight, held = unloaded.contacts.weight, models.held_rolling
    if held is not None:
        return lambda load: jnp.broadcast_to(held * weight, load.shape)
    if models.rolling.name == "none":
        return None
    return lambda load: evaluate(models.rolling, replace(unloaded, load=load)) * weight


def _drag(
    design: Design, operation: Operation, contacts: Contacts, kinematic_viscosity: Each
) -> TorqueOnBodies | None:
    """Losses beside the teeth as torques from the loads on them; None without any."""
    if not design.drag:
        return None
    return resistance(
        design.drag,
        design.mesh,
        contacts,
        motion=design.motion,
        speed=operation.speed,
        kinematic_viscosity=kinematic_viscosity,
    )


def _single(value: Any) -> Any:
    """Arrays of numbers in single precision."""
    return jnp.asarray(value, jnp.float32) if eqx.is_inexact_array(value) else value


def _of_rank(values: Each, rank: int) -> Each:
    """Values with axes of length one in front: contacts and operating points count the same batch axes."""
    return jnp.reshape(values, (*(1 for _ in range(rank - jnp.ndim(values))), *jnp.shape(values)))


class Cycle(eqx.Module):
    """One period of states with the weights that integrate over it.

    Attributes:
        phase: nodes [node], ordered, moving with the events.
        weight: of each node; they sum to one.
        state: at the nodes, batch axes `*b node`.
        nodes: static, nodes in each segment between events.
        smooth: static, True if states are smooth between events: no pair comes to carry or ceases to.

    Source: Tian et al. (2024), eqs. 7 and 10, see its methods.
    """

    phase: Float[Array, " node"]
    weight: Float[Array, " node"]
    state: State
    nodes: int = eqx.field(static=True)
    smooth: bool = eqx.field(static=True, default=True)

    def __repr__(self) -> str:
        return brief(self)

    def mean(self, values: Float[Array, "*b node"]) -> Each:
        """Mean over one period."""
        return jnp.sum(values * self.weight, axis=-1)

    def path_mean(self, values: Float[Array, "*b node"]) -> Each:
        """Mean over the path of contact of one pair: double contact counts twice.

        Source: Tian et al. (2024), eq. 7, whose mean is over the path of contact.
        """
        pairs = jnp.sum(jnp.any(self.state.contacts.active, axis=1), axis=0)
        return self.mean(values * pairs) / self.mean(pairs * 1.0)

    def extremes(self, values: Float[Array, "*b node"]) -> tuple[Each, Each]:
        """Smallest and largest value of the cycle, between the nodes too; piecewise differentiable.

        A polynomial through the nodes of each segment is read at points between them, and at its
        vertex beside a point where it is level: jumps lie at the ends of segments, where there are
        nodes. Where pairs with gaps come and go between the events, values have kinks that no
        polynomial follows, and the nodes alone are read. Values that are undefined at a node have none.

        From Taylor's series to the third order about the point beside the vertex.
        """
        every = jnp.broadcast_to(values, (*values.shape[:-1], self.phase.shape[0]))
        return extremes(every, self.nodes, smooth=self.smooth)

    @property
    def mean_loss(self) -> Each:
        """Mean power lost [W]."""
        return self.mean(self.state.loss)

    @property
    def mean_input_torque(self) -> Each:
        """Mean torque of the driver [N m]."""
        return self.mean(self.state.input_torque)

    @property
    def mean_efficiency(self) -> Each:
        """Energy out over energy in within one period; NaN where no power is transmitted.

        From the balance of energy over one period.
        """
        return power_ratio(self.mean(self.state.output_power), self.mean(self.state.input_power))

    @property
    def ripple(self) -> Each:
        """Largest minus smallest input torque [N m]; piecewise differentiable.

        Source: Tian et al. (2024), eq. 10.
        """
        low, high = self.extremes(self.state.input_torque)
        return high - low

    @property
    def residual(self) -> Each:
        """Largest relative error of the balance."""
        return jnp.max(self.state.balance.residual, axis=-1)

    @property
    def locked(self) -> Bool[Array, "*b"]:
        """True where friction locks the mesh at some phase."""
        return jnp.any(self.state.balance.locked, axis=-1)

    @property
    def jamming(self) -> Each:
        """Smallest coefficient of friction, the same at all contacts, from which on the mesh is locked."""
        return jnp.min(self.state.balance.jamming, axis=-1)

    @property
    def nearest_to_jamming(self) -> tuple[Each, Each]:
        """Friction coefficient where the mesh is nearest to locking, and the one at which it locks there."""
        forces = self.state.balance
        coefficients = jnp.broadcast_arrays(forces.largest_friction, forces.jamming)
        nearest = jnp.argmax(coefficients[0] / coefficients[1], axis=-1)[..., None]
        acting, limit = (jnp.take_along_axis(v, nearest, axis=-1)[..., 0] for v in coefficients)
        return acting, limit


def power_ratio(power_out: Each, power_in: Each) -> Each:
    """Power out over power in; NaN where no power is transmitted, see `ROUNDING`.

    Args:
        power_out: at the output [W].
        power_in: put in [W].
    """
    transmits = power_out > ROUNDING * power_in
    return jnp.where(transmits, power_out / jnp.where(transmits, power_in, 1.0), jnp.nan)


def extremes(values: Float[Array, "*b node"], nodes: int, *, smooth: bool) -> tuple[Each, Each]:
    """Smallest and largest value over one period, see `Cycle.extremes`.

    Args:
        values: at the nodes of the period.
        nodes: in each segment between events.
        smooth: False where values have kinks between events.

    From Taylor's series to the third order about the point beside the vertex.
    """
    finite = ~jnp.any(jnp.isnan(values), axis=-1)
    low, high = _ends(values, nodes, smooth)
    return jnp.where(finite, low, jnp.nan), jnp.where(finite, high, jnp.nan)


def _ends(values: Float[Array, "*b node"], nodes: int, smooth: bool) -> tuple[Each, Each]:
    if not smooth:
        return jnp.min(values, axis=-1), jnp.max(values, axis=-1)
    segments = values.reshape(*values.shape[:-1], -1, nodes)
    at, *derivatives, spacing = polynomial_matrices(nodes)
    dense, slope, curve, third = (segments @ matrix for matrix in (at, *derivatives))
    # A vertex farther off than the next point is told there, by derivatives that are nearer to it.
    level = jnp.abs(slope) < jnp.abs(curve) * spacing
    step = -slope / jnp.where(level, curve, 1.0)
    vertex = dense + slope * step / 2.0 + third * step**3 / 6.0
    candidates = jnp.stack([dense, jnp.where(level, vertex, dense)])
    return jnp.min(candidates, axis=(0, -2, -1)), jnp.max(candidates, axis=(0, -2, -1))


def cycle(
    design: Design,
    operation: Operation,
    models: Models,
    nodes: int = 24,
    engaged: Engagement | None = None,
) -> Cycle:
    """States over one period, integrated segment by segment between the events.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: operating points [*b].
        models: laws.
        nodes: Gauss-Lobatto nodes in each segment; its ends lie beside the events.
        engaged: contacts and shares with their nodes, where they are known already.

    Source: Abramowitz and Stegun (1964), eq. 25.4.32, for the nodes; see `state` for the balance.
    """
    demand_double()
    if engaged is None:
        phase, weight = cycle_nodes(design.mesh, models.sharing, nodes)
    else:
        phase, weight, nodes = engaged.phase, engaged.weight, engaged.nodes
    mesh_states = state(design, _at_nodes(operation), phase, models, engaged=engaged)
    return Cycle(phase, weight, mesh_states, nodes, smooth=touching(design.mesh))


def forces_at_nodes(
    design: Design, operation: Operation, known: Engagement, models: Models
) -> Balance:
    """Forces at the nodes of a cycle whose contacts and shares are known; only they ask for the law.

    Args:
        design: mesh, materials, oil, surfaces.
        operation: one operating point.
        known: contacts and shares.
        models: laws.
    """
    points = _at_nodes(operation)
    unloaded = _unloaded(design, points, known.contacts, known.share)
    return _balance(design, points, known.share, unloaded, models)


def cycle_of(design: Design, operation: Operation, known: Engagement, found: Balance) -> Cycle:
    """The cycle that belongs to such forces; arguments as in `forces_at_nodes`."""
    points = _at_nodes(operation)
    unloaded = _unloaded(design, points, known.contacts, known.share)
    states = _state(design, points, unloaded, found)
    return Cycle(known.phase, known.weight, states, known.nodes, smooth=touching(design.mesh))


def _at_nodes(operation: Operation) -> Operation:
    """Operating points with an axis for the nodes of a cycle."""
    at_nodes: Operation = jax.tree.map(lambda values: values[..., None], operation)
    return at_nodes


def cycle_nodes(
    mesh: Mesh, sharing: LoadSharing, nodes: int
) -> tuple[Float[Array, " node"], Float[Array, " node"]]:
    """Phases and weights over one period, between the events and the hand-overs of the sharing.

    Args:
        mesh: any family.
        sharing: may add hand-overs to the events of the mesh.
        nodes: in each segment, at least 3.

    Source: Abramowitz and Stegun (1964), eq. 25.4.32, Lobatto's formula.
    """
    phase, weight = period_nodes(events_of(mesh, sharing), nodes)
    return phase.ravel(), weight.ravel()


def events_of(mesh: Mesh, sharing: LoadSharing) -> Float[Array, " event"]:
    """Phases at which a mesh, or how its pairs share the load, changes its course [periods].

    Args:
        mesh: any family.
        sharing: may add hand-overs to the events of the mesh.
    """
    events = mesh.events()
    if sharing.hand_over is None:
        return events
    return jnp.concatenate([events, sharing.hand_over(mesh.contact_ratio)])
