"""Periodic motion of a mesh with friction at a mean speed of its driver, on all coordinates of its bodies."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import diffrax
import equinox as eqx
import numpy as np
from jax.typing import ArrayLike
from jaxtyping import Array, Bool, Complex, Float, Int

from pitchpoint._jax import array, jax, jnp
from pitchpoint.contact.contacts import total
from pitchpoint.core.factored import Arrays
from pitchpoint.core.programs import fast_program
from pitchpoint.core.status import Code, Status
from pitchpoint.dynamics.energy import Account
from pitchpoint.dynamics.floquet import STABLE, multipliers
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.modes import mean_stiffness
from pitchpoint.dynamics.moving_bodies import (
    bearing_damping,
    bearing_forces,
    bearing_stiffness,
    moved_masses,
)
from pitchpoint.dynamics.passage import Passage, passage
from pitchpoint.dynamics.right_hand_side import (
    WORKS,
    ContactForces,
    MovingMesh,
    acceleration,
    column,
    conditions_at,
    forces_beside,
    kinetic,
    powers,
    torques,
    torques_beside_contacts,
)
from pitchpoint.dynamics.shooting import Shot, search
from pitchpoint.dynamics.transient import CLOSED, demand_bodies, demand_effects, where_known
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.mesh import has
from pitchpoint.gears.period import nodes
from pitchpoint.lubrication.conditions import evaluate
from pitchpoint.lubrication.lubrication_registry import FilmThickness

__all__ = ["Motion", "film", "periodic_motion", "steady_motion", "steady_motions"]

TOLERANCE = 1e-10
"""Largest estimated error of a step, of states of order one."""

MOST_STEPS = 20_000
"""Steps between two events after which a period is given up."""

SHORTEST = 1e-12
"""Step over the way between two events below which it is given up too."""

SLOWEST = 1e-3
"""Speed of the driver over its mean below which it counts as stopped."""

UNRESOLVED = 1e-4
"""Highest Legendre coefficients of an element, relative to the largest deflection."""

SPEED_GAIN, TORQUE_GAIN = 0.3, 0.02
"""Parts of an error of the mean speed that a period of a march corrects at once, and by its torque: two
real roots of a controller with integral action, which fade within some twenty periods."""

WHOLE = 1e-9
"""How far the orders of an error times the cycles of a period may be from whole numbers."""

Values = Float[Arrays, "*b element node"]
States = Float[Array, "coordinate element node"]
State = Float[Array, " state"]


class Motion(eqx.Module):
    """One period of a steady motion; not a number where none was found.

    Attributes:
        bounds: mesh cycles of the driver between the elements.
        turned: by the driver, of the nodes [mesh cycles].
        time: at the nodes [s].
        pace: time for a mesh cycle at the speed of the moment [s].
        beside: places of all coordinates less those of a nominal motion with the driver [rad or m].
        rate: of all coordinates [rad/s or m/s].
        found: forces at the contacts.
        torque: external ones on all coordinates, with that which holds the mean speed of the driver.
        bearing: forces on bearings that yield, zero on other coordinates [N].
        load_power: what the loaded coordinate takes [W].
        transmission_error: how far the bodies have closed along the line of action (else along the normal)
            by their places on the coordinates of the mesh [m].
        energy: over the nodes in turn, from the start of the period on.
        multipliers: Floquet multipliers of one period, without that of the mean speed itself.
        state: at the start without dimensions, from which a search for a neighbour may begin.
        status: what became of the search; the residual is the closure of the energy.
        elements, nodes: static, of the grid.
    """

    bounds: Float[Array, " bound"]
    turned: Float[Array, "element node"]
    time: Float[Array, "element node"]
    pace: Float[Array, "element node"]
    beside: States
    rate: States
    found: ContactForces
    torque: States
    bearing: States
    load_power: Float[Array, "element node"]
    transmission_error: Float[Array, "element node"]
    energy: Account
    multipliers: Complex[Array, " multiplier"]
    state: State
    status: Status
    elements: int = eqx.field(static=True)
    nodes: int = eqx.field(static=True)

    @property
    def grid(self) -> PeriodGrid:
        """The grid of one mesh cycle."""
        return PeriodGrid(self.elements, self.nodes)

    def mean(self, values: Values) -> Float[Array, "*b"]:
        """Mean over time."""
        integral = jnp.sum(self.grid.integral(values * self.pace) * jnp.diff(self.bounds), axis=-1)
        return integral / jnp.sum(self.grid.integral(self.pace) * jnp.diff(self.bounds), axis=-1)

    def rms(self, values: Values) -> Float[Array, "*b"]:
        """Root mean square of the deviation from the mean; its derivative is NaN where it is zero."""
        mean = self.mean(values)[..., None, None]
        return jnp.sqrt(self.mean((values - mean) ** 2))

    def peak_to_peak(self, values: Values) -> Float[Array, "*b"]:
        """Largest less smallest value, between the nodes too."""
        low, high = self.grid.extremes(values)
        return high - low

    def spectrum(
        self, values: Values, orders: Sequence[int] | np.ndarray
    ) -> Float[Array, "order *b"]:
        """Amplitude of each order of the period over the turning of the driver; order zero is the mean.

        Args:
            values: any course over the period.
            orders: not negative, known when compiled; of a period of one mesh cycle they are orders of the
                mesh frequency.

        From the complex Fourier series: orders n and -n of a real course add up.
        """
        wanted = np.asarray(orders)
        begin, end = self.bounds[0], self.bounds[-1]
        bounds = (self.bounds - begin) / (end - begin)
        parts = jnp.abs(self.grid.fourier(values, bounds, wanted))
        sides = jnp.where(wanted == 0, 1.0, 2.0)
        return parts * sides.reshape(-1, *(1 for _ in values.shape[:-2]))

    @property
    def loss(self) -> Float[Array, "element node"]:
        """Power lost to sliding and rolling in the contacts [W]."""
        return total(self.found.lost)

    @property
    def power_in(self) -> Float[Array, ""]:
        """Mean power that the mesh asks for: what is taken out, and lost in contacts and dampers [W].

        Springs that change with the phase bring energy in without a torque for it, as does the error; in
        gears it is the driver that does this work. Drag of the bodies is beside the mesh.
        """
        energy, period = self.energy, self.time[-1, -1] - self.time[0, 0]
        lost = energy.friction + energy.rolling + energy.damping
        return self.mean(self.load_power) + lost[-1] / period

    @property
    def efficiency(self) -> Float[Array, ""]:
        """Power out over `power_in`; NaN where none is transmitted.

        From the balance of energy over one period.
        """
        return _ratio(self.mean(self.load_power), self.power_in)

    @property
    def instantaneous_efficiency(self) -> Float[Array, "element node"]:
        """One less what the contacts lose at each moment over the mean of `power_in`.

        Source: Liu and Xiong (2017), eq. 23.
        """
        return 1.0 - self.loss / self.power_in


def film(
    moving: MovingMesh, motion: Motion, law: FilmThickness
) -> Float[Array, "pair slice element node"]:
    """Film thickness at the contacts of a motion [m], NaN where nothing carries.

    Over the roughness `moving.design.roughness.composite_rq` it is the film ratio lambda.

    Args:
        moving: mesh and bodies.
        motion: of these.
        law: of the film.
    """
    force = motion.found.force
    conditions = conditions_at(moving, motion.found.contacts, force, motion.rate)
    return jnp.where(force > 0.0, evaluate(law, conditions), jnp.nan)


def steady_motion(
    moving: MovingMesh,
    speed: float,
    grid: PeriodGrid | None = None,
    *,
    cycles: int = 1,
    start: State | None = None,
    tolerance: float = TOLERANCE,
) -> Motion:
    """Steady motion at a mean speed of the driver, under the torques of the other bodies.

    Where the driver has an inertia, a constant torque beside its own holds its mean speed; where that is
    infinite the speed itself is constant. The way of the driver takes the place of time, so that pairs
    enter and leave at known places: it has to turn on at all times. Newton's method on the state after
    one period, with derivatives integrated beside it; where that leads nowhere the motion marches with
    its mean speed held. Derivatives go forwards (`jax.jvp`, `jax.jacfwd`).

    Args:
        moving: mesh and bodies, with constant torques. Its phase is not asked for: a period starts at an
            event of the mesh. Without a passage one is sampled.
        speed: mean speed of the driver, above zero [rad/s or m/s].
        grid: static; elements and nodes at which the motion is kept.
        cycles: static; mesh cycles in a period.
        start: `Motion.state` of a neighbour; the nominal motion where it is none, or not a number.
        tolerance: largest estimated error of a step, of states of order one. 1e-9 or less, below the 1e-8 to
            which a period closes: rougher steps leave none that does, or by chance one that is off by a
            thousand times as much; derivatives where friction reverses ask for 1e-13.

    Returns:
        The motion; its status says where none was found, and where a linear contact pulls.

    Raises:
        InputError: what moves is not complete, nothing is damped, the speed is not above zero, or the error
            does not repeat with the period.

    Source: Nayfeh and Balachandran (1995), chapter 6, shooting; Poincaré's section at a phase of the mesh.
    """
    ready = _checked(moving, [speed], cycles)
    motion: Motion = _steady(
        ready, array(speed), grid or PeriodGrid(), cycles, start, array(tolerance)
    )
    return motion


def steady_motions(
    moving: MovingMesh,
    speeds: ArrayLike | Sequence[float],
    grid: PeriodGrid | None = None,
    *,
    cycles: int = 1,
    follow: bool = False,
) -> Motion:
    """Steady motions at many speeds.

    Args:
        moving, grid, cycles: as in `steady_motion`.
        speeds: rising or falling [rad/s or m/s].
        follow: True if each begins from the one before, so that a branch is followed for as long as it is
            stable, in the order of the speeds; else all are found at once.

    Returns:
        Motions, the speed as first axis of every array.

    Source: Nayfeh and Balachandran (1995), chapter 6, sequential continuation.
    """
    every = np.atleast_1d(np.asarray(speeds, float))
    ready = _checked(moving, every, cycles)
    motions: Motion = _many(ready, array(every), grid or PeriodGrid(), cycles, follow)
    return motions


def periodic_motion(
    moving: MovingMesh,
    speed: Float[Array, ""],
    grid: PeriodGrid,
    cycles: int = 1,
    start: State | None = None,
    tolerance: Float[Array, ""] | float = TOLERANCE,
) -> Motion:
    """The same without checks, for programs and batches of one's own; `moving` has a passage.

    Arguments as in `steady_motion`.
    """
    # The search sees constants: the step of `_polished` has the derivatives, without those of every period.
    fixed, at = jax.lax.stop_gradient((_arrays(moving), speed))
    search_in = _Turning(eqx.combine(fixed, moving), at, cycles, tolerance)
    guess = search_in.first
    if start is not None:
        proposal = jax.lax.stop_gradient(start)
        guess = jnp.where(jnp.all(jnp.isfinite(proposal)), proposal, guess)
    shot = search(search_in.period, guess, 1, search_in.marched)
    turning = _Turning(moving, speed, cycles, tolerance)
    state = _polished(turning, shot)
    floquet = search_in.multipliers(jax.lax.stop_gradient(state))
    return _described(turning, state, shot, floquet, grid)


@fast_program
def _steady(
    moving: MovingMesh,
    speed: Float[Array, ""],
    grid: PeriodGrid,
    cycles: int,
    start: State | None,
    tolerance: Float[Array, ""],
) -> Motion:
    return periodic_motion(moving, speed, grid, cycles, start, tolerance)


@fast_program
def _many(
    moving: MovingMesh, speeds: Float[Array, " speed"], grid: PeriodGrid, cycles: int, follow: bool
) -> Motion:
    if not follow:
        every: Motion = jax.vmap(lambda speed: periodic_motion(moving, speed, grid, cycles))(speeds)
        return every

    def at(state: State, speed: Float[Array, ""]) -> tuple[State, Motion]:
        motion = periodic_motion(moving, speed, grid, cycles, state)
        return motion.state, motion

    _, motions = jax.lax.scan(at, jnp.full(2 * moving.mass.shape[0], jnp.nan), speeds)
    return motions


def _checked(moving: MovingMesh, speeds: Sequence[float] | np.ndarray, cycles: int) -> MovingMesh:
    """What moves with a passage, or InputError in one sentence."""
    demand_bodies(moving, "a steady motion")
    demand_effects(moving, "a steady motion")
    if not all(0.0 < float(speed) < np.inf for speed in speeds):
        listed = ", ".join(f"{float(speed):g}" for speed in speeds)
        raise InputError(
            f"a steady motion asks for a mean speed of the driver above 0, got {listed}"
        )
    if any(body.torque.size != 1 for body in moving.bodies):
        raise InputError("a steady motion asks for torques that are constant in time")
    _check_damping(moving)
    _check_orders(moving, cycles)
    if moving.passage is not None:
        return moving
    constant = None if moving.stiffness is None else float(moving.stiffness)
    sampled = passage(moving.design, moving.operation, moving.models.compliance, constant)
    return replace(moving, passage=sampled)


def _check_damping(moving: MovingMesh) -> None:
    dampers = [
        moving.relaxation,
        moving.mesh_damping,
        jnp.max(bearing_damping(moving.bodies), initial=0.0),
    ]
    if not any(float(damper) > 0.0 for damper in dampers):
        raise InputError(
            "nothing damps the vibration, so that it never becomes steady; give a relaxation time of the "
            "contacts, a damping of the mesh or of the bearings"
        )


def _check_orders(moving: MovingMesh, cycles: int) -> None:
    orders = np.zeros(0) if moving.error is None else np.asarray(moving.error.order)
    odd = orders[np.abs(orders * cycles - np.round(orders * cycles)) > WHOLE]
    if odd.size:
        raise InputError(
            f"an error of order {odd[0]:g} of the mesh does not repeat after {cycles} mesh cycles; "
            "a steady motion asks for as many cycles as it takes"
        )


class _SegmentPlace(NamedTuple):
    """Segment of the passage, and mesh cycles since the first one."""

    segment: Int[Array, "*b"]
    cycle: Float[Array, "*b"]


class _Turning:
    """A mesh and its bodies over one period, in units that make the state of order one.

    A state is the places beside the nominal motion, the time lag in the place of that of the driver, and
    the rates less the nominal ones. Where a search looks for a period, the torque that holds the mean
    speed stands in the place of the lag, which starts at zero.
    """

    def __init__(
        self,
        moving: MovingMesh,
        speed: Float[Array, ""],
        cycles: int,
        tolerance: Float[Array, ""] | float,
    ) -> None:
        assert moving.passage is not None
        self.tolerance = tolerance
        self.moving, self.speed, self.cycles = moving, speed, cycles
        self.passage: Passage = moving.passage
        design = moving.design
        self.driver, self.motion = _driver(moving), moving.padded(design.motion)
        self.way, self.onward = design.period, design.onward
        self.held = jnp.isinf(jnp.sum(jnp.where(self.driver > 0.0, moving.mass, 0.0)))
        self.size = 2 * moving.mass.shape[0]
        self.nominal = self.motion * speed
        # Units carry no derivative: the root of a rate unit that is zero would have none.
        units = jax.lax.stop_gradient(_units(moving))
        self.place, self.rate, self.energy, self.push = units

    @property
    def first(self) -> State:
        """Nominal motion, wound up by its torques; what drives balances these and the friction there."""
        pushes = torques_beside_contacts(self.moving, self.nominal)
        places = self._wound_up(pushes)
        needed = self._lost(places) / self.speed - pushes @ self.motion
        torque = jnp.where(self.held, 0.0, self.sense * needed / self.push)
        return jnp.pad(self.driver * torque + places / self.place, (0, self.size // 2))

    def _lost(self, places: Float[Array, " coordinate"]) -> Float[Array, ""]:
        """Mean power that the nominal motion loses in its contacts [W]."""
        phase, weight = nodes(self.passage.edges[:-1], PeriodGrid().nodes)

        def at(phase: Float[Array, ""]) -> Float[Array, ""]:
            engaged = self.passage.at(phase)
            forces = forces_beside(self.moving, engaged, phase, places, self.nominal)
            return total(forces.lost)

        return jax.vmap(at)(phase.ravel()) @ weight.ravel()

    def _wound_up(self, pushes: Float[Array, " coordinate"]) -> Float[Array, " coordinate"]:
        """Places under the torques on mean springs, the driver held; from there little swings at first."""
        free = 1.0 - self.driver
        springs = mean_stiffness(self.moving) * free[:, None] * free + jnp.diag(self.driver)
        places = jnp.linalg.solve(springs, pushes * free)
        return jnp.where(jnp.all(jnp.isfinite(places)), places, 0.0)

    @property
    def length(self) -> Float[Array, ""]:
        """Duration of a period [s]."""
        return self.cycles * self.way / self.speed

    def edges(self, bounds: Float[Array, " bound"]) -> Float[Array, " edge"]:
        """Mesh cycles of the driver from the start of a period to such phases of one cycle."""
        within = jnp.where(self.onward > 0.0, bounds - bounds[0], (bounds[-1] - bounds)[::-1])
        every = jnp.arange(self.cycles)[:, None] + within[:-1]
        return jnp.append(every.ravel(), float(self.cycles))

    def phase(self, turned: Float[Array, "*b"]) -> Float[Array, "*b"]:
        """Of the mesh, counted on [periods]."""
        begin = jnp.where(self.onward > 0.0, self.passage.edges[0], self.passage.edges[-1])
        return begin + self.onward * turned

    def segments(self, edges: Float[Array, " edge"]) -> "_SegmentPlace":
        """Where the passage holds the elements between such edges."""
        phase = self.phase((edges[1:] + edges[:-1]) / 2.0)
        return _SegmentPlace(self.passage.segment(phase), jnp.floor(phase - self.passage.edges[0]))

    def forces(
        self, moving: MovingMesh, turned: Array, place: "_SegmentPlace", beside: Array, rate: Array
    ) -> ContactForces:
        """Forces at the contacts, in an element whose place in the passage is known."""
        phase = self.phase(turned)
        engaged = self.passage.within(place.segment, phase - place.cycle)
        return forces_beside(moving, engaged, phase, beside, rate)

    def change(
        self, moving: MovingMesh, turned: Array, place: "_SegmentPlace", state: Array, works: bool
    ) -> Array:
        """Derivative of the scaled state by the mesh cycles of the driver."""
        beside, rate, _ = self.parts(state)
        driving = self.sense * (self.driver @ rate)
        pace = self.way / jnp.maximum(driving, SLOWEST * self.speed)
        forces = self.forces(moving, turned, place, beside, rate)
        still = jnp.zeros(())
        faster = acceleration(moving, still, beside, rate, forces)
        drift = (rate - self.motion * driving) * pace
        lag = pace - self.way / self.speed
        places = jnp.where(self.driver > 0.0, lag * self.speed, drift) / self.place
        parts = [places, faster * pace / self.rate]
        if works:
            parts.append(powers(moving, still, beside, rate, forces) * pace / self.energy)
        return jnp.concatenate(parts)

    def parts(self, state: Float[Array, "state *b"]) -> tuple[Array, Array, Array]:
        """Places beside the nominal motion, rates, and time lag of a scaled state."""
        half = self.size // 2
        places = column(self.place, state) * state[:half]
        rate = column(self.rate, state) * state[half : self.size] + column(self.nominal, state)
        driver = column(self.driver, state)
        lag = jnp.sum(driver * places, axis=0) / self.speed
        return places * (1.0 - driver), rate, lag

    def started(self, state: State) -> tuple[MovingMesh, State]:
        """What moves under the torque that a state of the search holds, and the state of its motion."""
        half = self.size // 2
        torque = jnp.sum(self.driver * state[:half]) * self.push
        bodies = [
            replace(body, torque=body.torque + share * torque)
            for body, share in zip(self.moving.bodies, self.driver, strict=False)
        ]
        moving = replace(self.moving, bodies=tuple(bodies))
        return moving, jnp.concatenate([state[:half] * (1.0 - self.driver), state[half:]])

    def end(self, state: State) -> tuple[State, Bool[Array, ""]]:
        """Scaled state of the motion after one period, and whether it was reached."""
        moving, start = self.started(state)
        edges = self.edges(self.passage.edges)
        states, fine, _ = self.integrated(moving, start, edges, np.array([0.0, 1.0]), works=False)
        return states[-1, -1], fine

    def integrated(
        self, moving: MovingMesh, start: State, edges: Array, place: np.ndarray, *, works: bool
    ) -> tuple[Float[Array, "element node part"], Bool[Array, ""], Int[Array, ""]]:
        """States at places of all elements in turn, whether all were reached, and the steps."""

        def element(
            carry: tuple[State, Array, Array], segment: tuple[Array, Array, _SegmentPlace]
        ) -> tuple[tuple[State, Array, Array], Array]:
            state, fine, steps = carry
            low, length, where = segment

            def rate(at: Array, now: Array, _: None) -> Array:
                return length * self.change(moving, low + length * at, where, now, works)

            states, reached, count = _solved(rate, state, place, self.tolerance)
            return (states[-1], fine & reached, steps + count), states

        from_start = jnp.append(start, jnp.zeros(len(WORKS))) if works else start
        begin = (from_start, jnp.asarray(True), jnp.asarray(0))
        segments = (edges[:-1], jnp.diff(edges), self.segments(edges))
        (_, fine, steps), states = jax.lax.scan(element, begin, segments)
        return states, fine, steps

    def after(self, end: State, state: State) -> State:
        """State of the search after a period, the mean speed corrected.

        What drives shifts all rates by a part of what the mean speed was off, and changes its torque by a
        part of as much as would have held it: all of it would take vibration for a change of speed.
        """
        half = self.size // 2
        lag = jnp.sum(self.driver * self.place * end[:half]) / self.speed
        off = -self.speed * lag / (self.length + lag)
        inertia = moved_masses(self.moving.bodies) @ self.motion**2
        missing = self.sense * inertia * off / (self.length * self.push)
        torque = jnp.sum(self.driver * state[:half]) - TORQUE_GAIN * missing
        places = jnp.where(self.driver > 0.0, jnp.where(self.held, 0.0, torque), end[:half])
        rates = end[half:] - SPEED_GAIN * self.motion * off / self.rate
        fixed = self.held & (self.driver > 0.0)
        return jnp.concatenate([places, jnp.where(fixed, 0.0, rates)])

    @property
    def sense(self) -> Float[Array, ""]:
        """Sign of the nominal motion of the driver."""
        sign: Float[Array, ""] = self.driver @ self.motion
        return sign

    def period(self, state: State) -> tuple[Array, Array, Bool[Array, ""]]:
        """State of the search after a period, its derivative, and whether it was reached."""
        end, slope, fine = self._with_slope(state)
        by_end, by_state = jax.jacfwd(self.after, (0, 1))(end, state)
        return self.after(end, state)[None], by_end @ slope + by_state, fine

    def marched(self, state: State) -> tuple[Array, Bool[Array, ""]]:
        """The same without the derivative."""
        end, fine = self.end(state)
        return self.after(end, state)[None], fine

    def multipliers(self, state: State) -> Complex[Array, " multiplier"]:
        """Floquet multipliers of the motion from a state, without that of the mean speed."""
        half = self.size // 2
        others = jnp.argsort(self.driver)[: half - 1]
        chosen = jnp.concatenate([others, half + jnp.arange(half)])
        _, slope, _ = self._with_slope(state)
        values = multipliers(slope[chosen][:, chosen])
        return values[jnp.argsort(jnp.abs(values - 1.0))[1:]]

    def _with_slope(self, state: State) -> tuple[Array, Array, Bool[Array, ""]]:
        """Scaled state after one period, its derivative, and whether it was reached."""

        def twice(state: State) -> tuple[Array, tuple[Array, Array]]:
            end, fine = self.end(state)
            return end, (end, fine)

        slope, (end, fine) = jax.jacfwd(twice, has_aux=True)(state)
        return end, slope, fine


def _units(moving: MovingMesh) -> tuple[Array, Array, Array, Array]:
    """Units of places, rates, energy and of the torque on the driver.

    Energy is what the torques and the error store in the stiffest springs.
    """
    assert moving.passage is not None
    mass, held = moving.mass, jnp.diag(bearing_stiffness(moving.bodies))
    springs = jnp.max(jnp.sum(moving.passage.stiffness[0], axis=(0, 1)))
    arms = jnp.max(jnp.abs(moving.passage.contacts.normal[0]), axis=(1, 2, 3))
    squares = moving.padded(springs * arms**2)
    stiff = jnp.maximum(jnp.max((held + squares) / mass), 1e-12)
    loads = jnp.stack([jnp.max(jnp.abs(body.torque)) + body.resistance for body in moving.bodies])
    pushes = jnp.sum(moving.padded(loads) ** 2 / mass) / stiff
    waves = 0.0 if moving.error is None else jnp.sum(moving.error.amplitude**2)
    energy = (pushes + springs * waves) / 2.0
    energy = jnp.where(energy > 0.0, energy, 1.0)
    rates = jnp.sqrt(2.0 * energy / mass)
    rate = jnp.where(jnp.isinf(mass), jnp.max(rates), rates)
    push = jnp.sqrt(2.0 * energy * springs) * jnp.max(arms)
    return rate / jnp.sqrt(stiff), rate, energy, push


def _solved(
    rate: object, start: Array, place: np.ndarray, tolerance: Float[Array, ""] | float
) -> tuple[Float[Array, "node state"], Bool[Array, ""], Int[Array, ""]]:
    """States at places of one element, whether they were reached, and the steps that it took."""
    control = diffrax.PIDController(
        rtol=tolerance, atol=tolerance, dtmin=SHORTEST, force_dtmin=False
    )
    solution = diffrax.diffeqsolve(
        diffrax.ODETerm(rate),  # type: ignore[arg-type]
        diffrax.Dopri8(),
        t0=0.0,
        t1=1.0,
        dt0=place[1] / 4.0,
        y0=start,
        saveat=diffrax.SaveAt(ts=jnp.asarray(place)),
        stepsize_controller=diffrax.ClipStepSizeController(control, step_ts=jnp.asarray(place[1:])),
        adjoint=diffrax.ForwardMode(),
        max_steps=MOST_STEPS,
        throw=False,
    )
    assert solution.ys is not None
    reached = solution.result == diffrax.RESULTS.successful
    return solution.ys, reached, solution.stats["num_steps"]


def _polished(turning: _Turning, shot: Shot) -> State:
    """The state that a search found, a step of Newton's method further, which carries the derivative."""
    state, slope = jax.lax.stop_gradient((shot.start, shot.monodromy))
    end, _ = turning.end(state)
    left = turning.after(end, state) - state
    further: State = jnp.linalg.solve(jnp.eye(turning.size) - slope, left)
    return state + further


def _described(
    turning: _Turning,
    state: State,
    shot: Shot,
    floquet: Complex[Array, " multiplier"],
    grid: PeriodGrid,
) -> Motion:
    """Everything at the nodes of a period."""
    moving, start = turning.started(state)
    bounds = turning.edges(grid.bounds(turning.passage.edges))
    length = jnp.diff(bounds)
    turned = bounds[:-1, None] + length[:, None] * grid.place
    states, fine, _ = turning.integrated(moving, start, bounds, grid.place, works=True)
    columns = jnp.moveaxis(states, -1, 0)
    beside, rate, lag = turning.parts(columns)
    places = jax.tree.map(
        lambda leaf: jnp.broadcast_to(leaf[:, None], turned.shape), turning.segments(bounds)
    )
    forces = turning.forces(moving, turned, places, beside, rate)
    account = _account(turning, beside, rate, forces, columns[turning.size :])
    torque = torques(moving, jnp.zeros_like(turned), beside, rate, forces)
    mesh = moving.design.mesh
    loaded, dof = moving.padded(moving.design.loaded), len(mesh.coordinates)
    action = line_of_action(mesh) if has(mesh, line_of_action) else forces.line[:dof, 0, 0]
    values: dict[str, Any] = {
        "turned": turned,
        "time": turned * turning.way / turning.speed + lag,
        "pace": turning.way / jnp.abs(jnp.tensordot(turning.driver, rate, 1)),
        "beside": beside,
        "rate": rate,
        "found": forces,
        "torque": torque,
        "bearing": bearing_forces(moving.bodies, beside, rate),
        "load_power": -jnp.tensordot(loaded, torque * rate, 1),
        "transmission_error": jnp.tensordot(action, beside[:dof], 1),
        "energy": account,
        "multipliers": floquet,
        "state": state,
    }
    status = _status(turning, shot, fine, account.closure, values, grid)
    lost = (Code.NOT_FINITE, Code.NOT_PERIODIC, Code.NOT_CONVERGED)
    reliable = jnp.all(status.code != jnp.array([int(code) for code in lost]))
    masked = {name: where_known(reliable, value) for name, value in values.items()}
    return Motion(bounds=bounds, status=status, elements=grid.elements, nodes=grid.nodes, **masked)


def _account(
    turning: _Turning, beside: States, rate: States, forces: ContactForces, works: Array
) -> Account:
    moving = turning.moving

    def flat(values: Values) -> Array:
        return values.reshape(*values.shape[:-2], -1)

    held = jnp.tensordot(bearing_stiffness(moving.bodies), beside, 1)
    return Account(
        kinetic=flat(kinetic(moving, rate)),
        contacts=flat(forces.energy),
        bearings=flat(jnp.sum(beside * held, axis=0) / 2.0),
        **dict(zip(WORKS, flat(works) * turning.energy, strict=True)),
    )


def _status(
    turning: _Turning,
    shot: Shot,
    fine: Bool[Array, ""],
    closure: Float[Array, ""],
    values: dict[str, Any],
    grid: PeriodGrid,
) -> Status:
    """How the search ended."""
    slowest = SLOWEST * turning.speed
    force, error = values["found"].force, values["transmission_error"]
    stops = jnp.any(turning.sense * jnp.tensordot(turning.driver, values["rate"], 1) <= slowest)
    size = jnp.max(jnp.abs(values["beside"]), axis=(-2, -1))
    coarse = jnp.any(grid.tail(values["beside"]) > UNRESOLVED * size)
    checks = (
        (~_finite(turning.moving), Code.NOT_FINITE),
        (~(shot.found & jnp.all(jnp.isfinite(error))) | stops, Code.NOT_PERIODIC),
        (~fine | ~(closure <= CLOSED), Code.NOT_CONVERGED),
        (jnp.max(jnp.abs(values["multipliers"])) > STABLE, Code.UNSTABLE),
        (coarse, Code.UNRESOLVED),
        (jnp.any(force < 0.0) & turning.moving.law.linear, Code.SEPARATES),
    )
    code = jnp.select(
        [check for check, _ in checks],
        [jnp.asarray(int(code)) for _, code in checks],
        int(Code.SOLVED),
    )
    return Status(code, closure, shot.marched + shot.tries)


def _finite(moving: MovingMesh) -> Bool[Array, ""]:
    """True if nothing but inertias and backlash is infinite, and nothing is no number."""
    parts = (moving.passage, [body.torque for body in moving.bodies], moving.relaxation)
    others = (moving.mesh_damping, moving.error, moving.creep)
    leaves = jax.tree.leaves((parts, others))
    return jnp.all(jnp.stack([jnp.all(jnp.isfinite(leaf)) for leaf in leaves]))


def _arrays(moving: MovingMesh) -> MovingMesh:
    arrays: MovingMesh = eqx.filter(moving, eqx.is_inexact_array)
    return arrays


def _driver(moving: MovingMesh) -> Float[Array, " coordinate"]:
    return moving.padded(moving.design.driver)


def _ratio(out: Array, put_in: Array) -> Array:
    some = (out > 0.0) & (put_in > 0.0)
    return jnp.where(some, out / jnp.where(some, put_in, 1.0), jnp.nan)
