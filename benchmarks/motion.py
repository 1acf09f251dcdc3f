"""Transients of a spur pair with friction in the loop: the package beside solve_ivp and a compiled loop.

    taskset -c 0 .venv/bin/python benchmarks/motion.py

One case is twenty mesh cycles from the nominal speed, with the friction of Xu et al. (2007) at the force and
speeds of the moment, teeth that may part, and bearings that yield (six coordinates) or do not (two).
`rivals/spur_motion.py` has the same equations for `scipy.integrate.solve_ivp` (DOP853, right-hand side in
NumPy) at the same tolerance. Many operating points are two mesh cycles each of torques and speeds drawn at
random: side by side (`vmap`) and in turn (`lax.map`) in one program, beside a loop compiled by numba with
the same method, where numba is installed. What the package does beyond its rivals stays in: works of all
forces, and the force of every pair at the end. Times are those of the processor, compilation is told apart.
"""

import dataclasses
import statistics
import time
from collections.abc import Callable
from functools import partial

import bench
import diffrax
import equinox as eqx
import numpy as np
import spur_motion as rival

from pitchpoint._jax import array, jax, jnp
from pitchpoint.dynamics.moving_bodies import Body, radial_bearings
from pitchpoint.dynamics.passage import passage, polynomial
from pitchpoint.dynamics.right_hand_side import MovingMesh
from pitchpoint.dynamics.transient import Transient, transient, transient_motion
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

jax.config.update("jax_enable_x64", True)

TEETH, MODULE, ANGLE, WIDTH = (18, 36), 3e-3, float(np.radians(20.0)), 26.7e-3
INERTIA, MASS = (1e-3, 6e-3), (2.0, 4.0)
BEARING, BEARING_DAMPING, VISCOUS = 2e8, 4e3, 0.1
STIFFNESS, RELAXATION, CREEP, PHASE = (3e8, 0.0, -0.3e8), 2e-6, 1e-3, 0.4
SPEED, LOAD, DRIVE = 100.0, 100.0, 0.55
TEMPERATURE, TOLERANCE = 328.15, 1e-10
SIZES = bench.sizes(__doc__, cycles=(20, 4), points=(64, 2), more=(1024, 0), repeats=(5, 1))
AGREE = 2e-6
"""Largest difference to the rival, of rates to their swing and of places to that of the closing."""


def design() -> Design:
    steel = solids.find("steel").build()
    mesh = build_cylindrical_pair(
        teeth=TEETH, module=MODULE, pressure_angle=ANGLE, face_width=WIDTH
    )
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (steel, steel), oil, Roughness.from_composite_rq(0.8e-6))


def moving(own: Design, bearings: bool) -> MovingMesh:
    point = Operation(*map(array, (LOAD, SPEED, TEMPERATURE)))
    laws = tuple(law for law in LAWS if law.name == "xu_2007")
    sharing, rolling = LOAD_SHARING["from_stiffness"], ROLLING_RESISTANCE["none"]
    models = Models(laws, array(0), {}, sharing, rolling)
    held = [radial_bearings(mass, BEARING, BEARING_DAMPING) if bearings else None for mass in MASS]
    bodies = (
        Body(INERTIA[0], DRIVE * LOAD, support=held[0]),
        Body(INERTIA[1], LOAD, viscous=VISCOUS, support=held[1]),
    )
    return MovingMesh(
        own,
        point,
        models,
        bodies,
        knots=array([0.0]),
        phase=array(PHASE),
        creep=array(CREEP),
        relaxation=array(RELAXATION),
        passage=passage(own, point, models.compliance, polynomial(STIFFNESS)),
    )


def pair(own: Design, bearings: bool) -> rival.Pair:
    return rival.Pair(
        teeth=TEETH,
        module=MODULE,
        pressure_angle=ANGLE,
        width=WIDTH,
        modulus=float(own.modulus),
        viscosity=float(own.lubricant.viscosity(jnp.asarray(TEMPERATURE))),
        roughness=float(own.roughness.composite_rq),
        inertia=INERTIA,
        mass=MASS if bearings else (np.inf, np.inf),
        bearing=BEARING,
        bearing_damping=BEARING_DAMPING,
        viscous=VISCOUS,
        stiffness=STIFFNESS,
        relaxation=RELAXATION,
        creep=CREEP,
        phase=PHASE,
    )


def units() -> np.ndarray:
    """Amplitudes of the rival's states: shares of the kinetic energy at the start."""
    energy = INERTIA[0] * SPEED**2 + INERTIA[1] * (SPEED / 2.0) ** 2
    rate = np.sqrt(energy / np.array([*INERTIA, *np.repeat(MASS, 2)]))
    base = MODULE * np.array(TEETH) / 2.0 * np.cos(ANGLE)
    frequency = np.sqrt(2.0 * STIFFNESS[0] * np.max(base**2 / np.array(INERTIA)))
    return np.concatenate([rate / frequency, rate])


def timed(work: Callable[[], object]) -> float:
    start = time.process_time()
    jax.block_until_ready(work())
    return time.process_time() - start


def one_case(own: Design, bearings: bool) -> float:
    """How many times as long the rival takes."""
    moves, rates = moving(own, bearings), SPEED * np.asarray(own.motion)
    size = moves.mass.shape[0]
    cycle = float(own.period) / SPEED
    times = np.linspace(0.0, SIZES.cycles * cycle, 2 * SIZES.cycles + 1)
    ours = partial(transient, moves, times, rate=np.pad(rates, (0, size - 2)))
    first = timed(ours)
    each = statistics.median(timed(ours) for _ in range(SIZES.repeats))
    found: Transient = ours()
    start = np.zeros(12)
    start[6:8] = rates
    theirs = partial(
        rival.solved,
        pair(own, bearings),
        np.array([DRIVE * LOAD, LOAD]),
        times,
        start,
        units(),
        TOLERANCE,
    )
    began = time.process_time()
    other = theirs()
    rivals = time.process_time() - began
    base = MODULE * np.array(TEETH) / 2.0 * np.cos(ANGLE)
    away = np.abs(np.asarray(found.rate)[:2] - other.y[6:8]).max() / np.ptp(other.y[6])
    closing = base @ other.y[:2]
    apart = np.abs(base @ np.asarray(found.place)[:2] - closing).max() / np.ptp(closing)
    steps = int(found.status.iterations)
    print(f"{size} coordinates: first call with compilation {first:.1f} s")
    print(
        f"  {each * 1e3:.0f} ms, {steps} steps, {each / steps / 14 * 1e9:.0f} ns a right-hand side; "
        f"energy closes to {float(found.energy.closure):.0e}"
    )
    print(
        f"  solve_ivp {rivals * 1e3:.0f} ms, {other.nfev} right-hand sides, "
        f"{rivals / other.nfev * 1e6:.0f} us each; rates differ by {away:.0e}, closing by {apart:.0e}"
    )
    assert max(away, apart) < AGREE, "the rival computes something else"
    print(f"  ratio {rivals / each:.0f} (goal 50)")
    return rivals / each


def drawn(own: Design, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torques of both bodies [N m], speeds of the driver [rad/s] and states at the start of many points."""
    rng = np.random.default_rng(0)
    loads, speeds = LOAD * rng.uniform(0.5, 1.5, count), SPEED * rng.uniform(0.8, 1.2, count)
    starts = np.zeros((count, 12))
    starts[:, 6:8] = speeds[:, None] * np.asarray(own.motion)
    return np.stack([DRIVE * loads, loads], axis=1), speeds, starts


def two_cycles(own: Design, bearings: bool) -> Callable[..., tuple[jax.Array, jax.Array]]:
    """Rates of both bodies after two mesh cycles, and steps, from torques and the speed of the driver."""
    moves, motion = moving(own, bearings), np.asarray(own.motion)
    times = array(np.linspace(0.0, 2.0 * float(own.period) / SPEED, 3))

    def single(given: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        torque, speed = given
        bodies = [
            dataclasses.replace(body, torque=own_torque[None])
            for body, own_torque in zip(moves.bodies, torque, strict=True)
        ]
        rate = moves.padded(speed * jnp.asarray(motion))
        driven = dataclasses.replace(moves, bodies=tuple(bodies))
        found = transient_motion(driven, times, jnp.zeros(moves.mass.shape[0]), rate)
        return found.rate[:2, -1], found.status.iterations

    return single


def many(own: Design, bearings: bool, count: int) -> None:
    repeats = min(SIZES.repeats, 3)
    torques, speeds, starts = drawn(own, count)
    single = two_cycles(own, bearings)
    span = 2.0 * float(own.period) / SPEED
    ways = {
        "side by side": eqx.filter_jit(jax.vmap(single)),
        "in turn": eqx.filter_jit(partial(jax.lax.map, single)),
    }
    given = (jnp.asarray(torques), jnp.asarray(speeds))
    each = {}
    for name, way in ways.items():
        first = timed(lambda way=way: way(given))
        each[name] = statistics.median(timed(lambda way=way: way(given)) for _ in range(repeats))
        calls = 14 * int(np.sum(way(given)[1]))
        print(
            f"{count} points {name}: {each[name] / count * 1e3:.2f} ms a point, "
            f"{each[name] / calls * 1e9:.0f} ns a right-hand side; first call {first:.0f} s"
        )
    if rival.loop is None:
        print("  numba is not installed: no compiled loop beside it")
        return
    tableau = diffrax.Dopri8.tableau
    places = np.zeros((tableau.num_stages,) * 2)
    for stage, row in enumerate(tableau.a_lower, start=1):
        places[stage, :stage] = row
    method = (places, np.asarray(tableau.b_sol, float), np.asarray(tableau.b_error, float))
    ends = np.zeros_like(starts)
    loop = partial(
        rival.loop,
        rival.constants(pair(own, bearings)),
        torques,
        starts,
        span,
        units(),
        TOLERANCE,
        method,
        ends,
    )
    first = timed(loop)
    rivals = statistics.median(timed(loop) for _ in range(repeats))
    found = np.asarray(ways["in turn"](given)[0])
    away = np.abs(found - ends[:, 6:8]).max() / np.ptp(ends[:, 6])
    print(
        f"  compiled loop {rivals / count * 1e3:.2f} ms a point, {rivals / loop() * 1e9:.0f} ns a "
        f"right-hand side; compilation {first:.1f} s; rates differ by {away:.0e}"
    )
    assert away < AGREE, "the loop computes something else"
    told = ", ".join(f"{name} {value / rivals:.1f}" for name, value in each.items())
    print(f"  times that of the loop: {told} (goal 1)")


def main() -> None:
    own = design()
    ratios = {name: one_case(own, name == "six") for name in ("six", "two")}
    for count in filter(None, (SIZES.points, SIZES.more)):
        many(own, True, count)
    bench.last_line(**ratios)


if __name__ == "__main__":
    main()
