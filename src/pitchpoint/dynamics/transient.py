"""Transients of a mesh with friction, such as a start from rest, by diffrax."""

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import diffrax
import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Bool, Float, Int

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import fast_program, program
from pitchpoint.core.status import Code, Status
from pitchpoint.dynamics.energy import Account
from pitchpoint.dynamics.moving_bodies import Body, Support, bearing_stiffness, moved_masses
from pitchpoint.dynamics.right_hand_side import (
    WORKS,
    ContactForces,
    MovingMesh,
    acceleration,
    contact_forces,
    kinetic,
    powers,
    torques,
)
from pitchpoint.errors import InputError
from pitchpoint.gears.mesh import has
from pitchpoint.gears.tooth_section import tooth_sections

__all__ = [
    "Transient",
    "demand_bodies",
    "demand_effects",
    "transient",
    "transient_motion",
    "where_known",
]

Vector = Float[Array, " coordinate"]
States = Float[Array, "coordinate time"]
Found = TypeVar("Found")

TOLERANCE = 1e-10
"""Largest estimated error of a step over the amplitude at which the external torques swing."""

ROUNDING = 1e-12
"""The same over the state itself, which bounds it from below where bodies have turned far."""

MOST_STEPS = 1_000_000
"""Steps after which a transient is given up."""

SHORTEST = 1e-22
"""Step over the whole duration below which it is given up too; a step that ends a rounding before a time at
which the motion is kept leaves one that is that short."""

CLOSED = 1e-6
"""Largest closure of the energy of a motion that counts as found."""

UNIT = 1e-9
"""How far ways of a support may be from unit vectors at right angles."""

TOGETHER = 1e-12
"""Share of the whole duration within which two events are one, as rounding may part them."""

MOST_HAND_OVERS = 4096
"""Events beyond which a transient finds the hand-overs by its steps."""

BUCKET = 64
"""Smallest number of events that a program is made for; it doubles, so that few programs serve all."""


class Transient(eqx.Module):
    """Motion at given times; what was not reached is NaN, and all of it if the energy does not close.

    Attributes:
        time: [s].
        place, rate: of all coordinates [rad or m, rad/s or m/s]: those of the mesh, then the
            translations of bodies.
        found: forces at the contacts.
        torque: external ones on all coordinates [N m or N], those that hold prescribed speeds among
            them.
        energy: where it is and where it went.
        status: the residual is the closure of the energy, at most `CLOSED` if solved; iterations are
            steps.
    """

    time: Float[Array, " time"]
    place: States
    rate: States
    found: ContactForces
    torque: States
    energy: Account
    status: Status


def transient(
    moving: MovingMesh,
    times: ArrayLike | Sequence[float],
    *,
    place: ArrayLike | Sequence[float] = 0.0,
    rate: ArrayLike | Sequence[float] = 0.0,
) -> Transient:
    """Motion from a given state, from rest by default, under torques, friction and drag.

    Integrated by an explicit method of order eight with steps that its error sets: where pairs enter or
    leave, teeth part and sliding changes its sense, it finds the place by itself; where the speed of the
    driver is prescribed, pairs enter and leave at steps' ends. The works of all
    forces are integrated beside the motion, so that the balance of energy says how well both are known.
    Friction needs speed: at rest nothing sticks, and bodies under it creep at a speed of the order of
    `MovingMesh.creep`. Nothing is kept between the times, so that a run may be long and its end be kept.

    Args:
        moving: mesh and bodies.
        times: at which the motion is kept, growing, evenly or not; the first is the start [s].
        place, rate: of all coordinates at the start.

    Raises:
        InputError: what moves is not complete, or has effects that a transient leaves out.

    Source: Prince and Dormand (1981), their method of order eight, as diffrax has it.
    """
    instants = np.asarray(times, float)
    _check(moving, instants)
    places, rates = (_start(moving, *named) for named in (("place", place), ("rate", rate)))
    events = _hand_overs(moving, instants, places, rates)
    motion: Transient = _travel(moving, array(instants), places, rates, events)
    return motion


def _hand_overs(
    moving: MovingMesh, times: np.ndarray, place: Vector, rate: Vector
) -> Float[Array, " event"] | None:
    """Times at which pairs enter or leave, where they are known; put behind the end to fill a bucket."""
    phase, pace, held, edges = (np.asarray(values) for values in _course(moving, place, rate))
    periods = abs(pace) * (times[-1] - times[0])
    if not held or pace == 0.0 or periods * edges.size > MOST_HAND_OVERS:
        return None
    turns = np.arange(math.floor(-periods) - 1, math.ceil(periods) + 2)
    every = times[0] + (np.add.outer(turns, edges - phase % 1.0) / pace).ravel()
    stops = np.concatenate([times, np.asarray(moving.knots)])
    inside = _apart(every, stops, TOGETHER * (times[-1] - times[0]))
    inside = inside[(inside > times[0]) & (inside < times[-1])]
    size = BUCKET
    while size < inside.size:
        size *= 2
    return jnp.asarray(np.pad(inside, (0, size - inside.size), constant_values=times[-1] + 1.0))


def _apart(events: np.ndarray, stops: np.ndarray, nearest: float) -> np.ndarray:
    """Events, each once; those next to a known time are put at it: no step fits between the two."""
    stops, events = np.sort(stops), np.sort(events)
    after = np.clip(np.searchsorted(stops, events), 1, stops.size - 1)
    low, high = stops[after - 1], stops[after]
    close = np.where(events - low < high - events, low, high)
    events = np.unique(np.where(np.abs(events - close) < nearest, close, events))
    return events[np.diff(events, prepend=-np.inf) > nearest]


@program
def _course(moving: MovingMesh, place: Vector, rate: Vector) -> tuple[Array, Array, Array, Array]:
    """Phase at the start, periods in a second, whether these are prescribed, and phases of the events."""
    design = moving.design
    forces = contact_forces(moving, place, rate)
    driver = moving.padded(design.driver)
    pace = design.onward / design.period * (driver @ rate) * (design.driver @ design.motion)
    held = jnp.isinf(driver @ jnp.where(driver > 0.0, moving.mass, 0.0))
    return forces.phase, pace, held, _edges(moving)


def _edges(moving: MovingMesh) -> Float[Array, " edge"]:
    if moving.passage is not None:
        return moving.passage.edges[:-1]
    return moving.design.mesh.events()


def _start(moving: MovingMesh, name: str, given: ArrayLike | Sequence[float]) -> Vector:
    """Values of all coordinates, or InputError."""
    values, size = np.asarray(given, float), moving.mass.shape[0]
    if values.shape not in ((), (1,), (size,)):
        raise InputError(
            f"{name} at the start of a transient is one number or one for each of the {size} "
            f"coordinates, those of the mesh and the translations of bodies; {values.size} are given"
        )
    return jnp.asarray(np.broadcast_to(values, (size,)))


def _check(moving: MovingMesh, times: np.ndarray) -> None:
    """InputError in one sentence."""
    demand_bodies(moving, "a transient")
    if times.size < 2 or not np.all(np.diff(times) > 0.0):
        raise InputError("times of a transient grow from its start on, at least two of them")
    if not np.all(np.diff(moving.knots) > 0.0):
        listed = ", ".join(f"{time:g}" for time in np.asarray(moving.knots))
        raise InputError(f"knots of the external torques grow with time, got {listed} s")
    demand_effects(moving, "a transient")


def demand_bodies(moving: MovingMesh, what: str) -> None:
    """InputError if the bodies do not suit the mesh or themselves.

    Args:
        moving: mesh and bodies.
        what: asks for them.
    """
    names = [coordinate.body for coordinate in moving.design.mesh.coordinates]
    if len(moving.bodies) != len(names):
        wanted = f"{', '.join(names)}; {len(moving.bodies)} bodies are given"
        raise InputError(f"{what} asks for one body for each of {wanted}")
    for name, body in zip(names, moving.bodies, strict=True):
        _check_body(name, body, moving.knots.size)


def _check_body(name: str, body: Body, knots: int) -> None:
    if not float(body.inertia) > 0.0:
        raise InputError(f"{name} needs a positive inertia, got {float(body.inertia):g}")
    if not float(body.creep) > 0.0:
        raise InputError(f"creep of {name} is a speed above 0, got {float(body.creep):g}")
    if body.torque.size not in (1, knots):
        raise InputError(
            f"{name} needs one torque, or one for each of the {knots} knots of time; "
            f"{body.torque.size} are given"
        )
    if body.support is not None:
        _check_support(name, body.support)


def _check_support(name: str, support: Support) -> None:
    if not float(support.mass) > 0.0:
        raise InputError(f"{name} needs a positive mass, got {float(support.mass):g}")
    ways = np.asarray(support.ways)
    if not np.allclose(ways @ ways.T, np.eye(len(ways)), rtol=0.0, atol=UNIT):
        lengths = ", ".join(f"{length:g}" for length in np.linalg.norm(ways, axis=1))
        raise InputError(
            f"{name} shifts along unit vectors at right angles to each other; "
            f"the ways of its bearings are {lengths} long, or not at right angles"
        )


def demand_effects(moving: MovingMesh, what: str) -> None:
    """InputError for effects that a motion with friction leaves out.

    Args:
        moving: mesh and bodies.
        what: leaves them out.
    """
    mesh = moving.design.mesh
    if not float(moving.creep) > 0.0:
        raise InputError(
            f"creep of the contacts is a sliding speed above 0 m/s, got {float(moving.creep):g}"
        )
    for quantity, value in (
        ("relaxation time of the contacts", moving.relaxation),
        ("damping of the mesh", moving.mesh_damping),
    ):
        if float(value) < 0.0:
            raise InputError(f"{quantity} is not negative, got {float(value):g}")
    if mesh.body.couples:
        raise InputError(f"{what} takes each pair of teeth as a spring, and a ring couples these")
    if moving.stiffness is None and moving.passage is None and not has(mesh, tooth_sections):
        raise InputError(f"bodies without teeth need the stiffness of their contact in {what}")
    if moving.design.drag:
        raise InputError(
            f"{what} leaves out the losses of a design beside its teeth; "
            "give them as resistance and viscous torque of the bodies"
        )


@fast_program
def _travel(
    moving: MovingMesh, times: Array, place: Vector, rate: Vector, events: Array | None
) -> Transient:
    return transient_motion(moving, times, place, rate, events)


def transient_motion(
    moving: MovingMesh,
    times: Float[Array, " time"],
    place: Vector,
    rate: Vector,
    events: Float[Array, " event"] | None = None,
) -> Transient:
    """The same without checks, for programs and batches of one's own.

    Args:
        moving, times, place, rate: as in `transient`, a number for each coordinate.
        events: times at which pairs enter or leave, where they are known; found by the steps if not.
    """
    scale = _StateScale(moving, times, place, rate)
    start = scale.scaled(place, rate)
    states, reached, steps = _integrated(moving, times, scale, start, events)
    solved = scale.parts(jnp.where(jnp.isfinite(states), states, jnp.nan).T)
    return _described(moving, times, solved, reached, steps)


class _StateScale:
    """Units in which all parts of the state are of order one.

    Energy is counted in what the torques store as they deflect the bodies, or what is there at the
    start, and places and rates as their shares of it at the highest natural frequency.
    """

    def __init__(self, moving: MovingMesh, times: Array, place: Vector, rate: Vector) -> None:
        mass, held = moving.mass, bearing_stiffness(moving.bodies)
        forces = contact_forces(moving, place, rate)
        pushed = forces.stiffness * forces.contacts.normal**2
        stiff = jnp.max((jnp.diag(held) + jnp.sum(pushed, axis=(1, 2))) / mass)
        frequency = jnp.where(stiff > 0.0, jnp.sqrt(stiff), 1.0 / (times[-1] - times[0]))
        kicked = jnp.sum(_pushes(moving) ** 2 / mass) / frequency**2
        there = moved_masses(moving.bodies) @ rate**2 + place @ held @ place
        energy = (kicked + there) / 2.0 + forces.energy
        self.energy = jnp.where(energy > 0.0, energy, 1.0)
        rates = jnp.sqrt(2.0 * self.energy / mass)
        self.rate = jnp.where(jnp.isinf(mass), jnp.max(rates), rates)
        self.place = self.rate / frequency

    def scaled(self, place: Vector, rate: Vector) -> Float[Array, " state"]:
        """State without dimensions, no work done."""
        return jnp.concatenate([place / self.place, rate / self.rate, jnp.zeros(len(WORKS))])

    def parts(self, state: Float[Array, "state *b"]) -> tuple[Array, Array, Array]:
        """Places, rates and works of states without dimensions."""
        size = self.place.shape[0]
        units = jnp.concatenate([self.place, self.rate, jnp.full(len(WORKS), self.energy)])
        physical = units.reshape(-1, *[1] * (state.ndim - 1)) * state
        return physical[:size], physical[size : 2 * size], physical[2 * size :]

    def changes(self, rate: Vector, faster: Vector, powers: Array) -> Float[Array, " state"]:
        """Derivative of the state without dimensions."""
        return jnp.concatenate([rate / self.place, faster / self.rate, powers / self.energy])


def _pushes(moving: MovingMesh) -> Vector:
    """Largest external torque and resistance on each coordinate."""
    largest = [jnp.max(jnp.abs(body.torque)) + body.resistance for body in moving.bodies]
    return moving.padded(jnp.stack(largest))


def _integrated(
    moving: MovingMesh, times: Array, scale: _StateScale, start: Array, events: Array | None
) -> tuple[Float[Array, "time state"], Bool[Array, ""], Int[Array, ""]]:
    """States without dimensions at all times, whether all were reached, and the steps taken."""
    shortest = SHORTEST * (times[-1] - times[0])
    control = diffrax.PIDController(
        rtol=ROUNDING, atol=TOLERANCE, dtmin=shortest, force_dtmin=False
    )
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(_rate(moving, scale)),
        diffrax.Dopri8(),
        t0=times[0],
        t1=times[-1],
        dt0=None,
        y0=start,
        saveat=diffrax.SaveAt(ts=times),
        stepsize_controller=diffrax.ClipStepSizeController(
            control, step_ts=times[1:], jump_ts=_bends(moving.knots, times, events)
        ),
        adjoint=diffrax.ForwardMode(),
        max_steps=MOST_STEPS,
        throw=False,
    )
    assert solution.ys is not None
    reached = solution.result == diffrax.RESULTS.successful
    return solution.ys, reached, solution.stats["num_steps"]


def _bends(knots: Array, times: Array, events: Array | None) -> Array | None:
    """Hand-overs that are known, and times between which the torques are straight.

    Those up to the start are put behind the end.
    """
    bends = [] if knots.size == 1 else [jnp.where(knots > times[0], knots, times[-1] + 1.0)]
    every = [*bends, *([] if events is None else [events])]
    return jnp.sort(jnp.concatenate(every)) if every else None


def _rate(moving: MovingMesh, scale: _StateScale) -> Callable[..., Array]:
    def rate(time: Array, state: Array, _: None) -> Array:
        place, moved, _works = scale.parts(state)
        forces = contact_forces(moving, place, moved)
        faster = acceleration(moving, time, place, moved, forces)
        return scale.changes(moved, faster, powers(moving, time, place, moved, forces))

    return rate


def _described(
    moving: MovingMesh,
    times: Array,
    states: tuple[Array, Array, Array],
    reached: Bool[Array, ""],
    steps: Int[Array, ""],
) -> Transient:
    """Forces and energies of states that were found."""
    place, rate, works = states
    forces = contact_forces(moving, place, rate)
    account = Account(
        kinetic=kinetic(moving, rate),
        contacts=forces.energy,
        bearings=jnp.sum(place * (bearing_stiffness(moving.bodies) @ place), axis=0) / 2.0,
        **dict(zip(WORKS, works, strict=True)),
    )
    status = Status(_code(reached, account.closure), account.closure, steps)
    fields = place, rate, forces, torques(moving, times, place, rate, forces), account
    return Transient(times, *where_known(_known(states, account.closure), fields), status)


def _code(reached: Bool[Array, ""], closure: Float[Array, ""]) -> Int[Array, ""]:
    """Solved where the end was reached and the energy closes."""
    solved = reached & (closure <= CLOSED)
    return jnp.where(solved, int(Code.SOLVED), int(Code.NOT_CONVERGED))


def _known(states: tuple[Array, ...], closure: Float[Array, ""]) -> Bool[Array, " time"]:
    """True at times that were reached, and at none if the energy does not close."""
    return jnp.all(jnp.isfinite(jnp.concatenate(states)), axis=0) & ~(closure > CLOSED)


def where_known(known: Bool[Array, "*b"], values: Found) -> Found:
    """Values where they are known; NaN, and no contact, elsewhere.

    Args:
        known: for each place along the last axes of the values.
        values: arrays of numbers and of truth, in any structure.
    """

    def kept(value: Array) -> Array:
        return jnp.where(known, value, False if value.dtype == bool else jnp.nan)

    masked: Found = jax.tree.map(kept, values)
    return masked
