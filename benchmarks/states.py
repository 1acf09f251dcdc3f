"""States per second: the package beside the NumPy rivals, in one run on one thread.

    OPENBLAS_NUM_THREADS=1 taskset -c 0 .venv/bin/python benchmarks/states.py

A state is one position of the mesh under one operating point (torque, speed, viscosity,
roughness): contact force, input torque and efficiency with the friction of Xu et al. (2007),
the balance converged to 1e-10. Compile time is told apart. Times are those of the processor. A law
of a user's own stands beside the one by name; it has no rival. `--large` adds 1e8 states and the
memory they take.
"""

import argparse
import os
import resource
import statistics
import sys
import time
from pathlib import Path

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
sys.path.insert(0, str(Path(__file__).parent / "rivals"))

import equinox as eqx
import jax
import numpy as np
import spur_numpy as rival

from pitchpoint._jax import jnp
from pitchpoint.efficiency.grid import state_grid
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE, FrictionLaw
from pitchpoint.materials.solids import Solid
from pitchpoint.materials.surfaces import Roughness

jax.config.update("jax_enable_x64", True)

AGREEMENT = 1e-10
"""Most that forces may differ from those of the rival, and torques from their balance."""

XU = next(law for law in LAWS if law.name == "xu_2007")


class GivenViscosity(eqx.Module):
    """An oil whose viscosity is an input of its own, as the rival takes it."""

    given: jax.Array
    lubricant_factor: jax.Array

    def viscosity(self, temperature: jax.Array) -> jax.Array:
        return self.given

    kinematic_viscosity = pressure_viscosity = viscosity_slope = conductivity = viscosity


def own_law(*, slide_roll_ratio: jax.Array, pressure: jax.Array) -> jax.Array:
    return 0.04 * jnp.tanh(10.0 * slide_roll_ratio) * (pressure / 1e9) ** 0.1


OWN = FrictionLaw("own", "the user's own", own_law, (), ({}, 0.0))


def ours(points: rival.Points, law: FrictionLaw = XU) -> tuple[Design, Operation, Models]:
    steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    rq = jnp.asarray(points.roughness * 1e-6 / np.sqrt(2.0))[:, None]
    design = Design(
        build_cylindrical_pair(
            teeth=(18, 36), module=3e-3, pressure_angle=np.radians(20.0), face_width=26.7e-3
        ),
        (steel, steel),
        GivenViscosity(jnp.asarray(points.viscosity * 1e-3)[:, None], jnp.asarray(1.0)),
        Roughness(ra_1=rq, ra_2=rq, rq_1=rq, rq_2=rq),
    )
    speed = jnp.asarray(points.speed * 2.0 * np.pi / 60.0)
    operation = Operation(jnp.asarray(points.torque), speed, jnp.full_like(speed, 330.0))
    sharing, rolling = LOAD_SHARING["sanchez_2017"], ROLLING_RESISTANCE["none"]
    return design, operation, Models((law,), jnp.asarray(0), {}, sharing, rolling)


def run(inputs: tuple[Design, Operation, Models], phase: jax.Array) -> list:
    design, operation, models = inputs
    return list(state_grid(design, operation, phase, models))


def timed(work: object, *arguments: object) -> float:
    start = time.process_time()
    work(*arguments)
    return time.process_time() - start


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--positions", type=int, default=1000)
    parser.add_argument("--points", type=int, default=1024)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--large", action="store_true", help="also 1e8 states, for memory")
    parser.add_argument("--small", action="store_true", help="few states, for the agreement")
    asked = parser.parse_args()
    if asked.small:
        asked.positions, asked.points, asked.repeats = 500, 512, 3
    positions = np.sort(np.random.default_rng(0).random(asked.positions))
    points = rival.random_points(asked.points)
    states = asked.positions * asked.points
    inputs, phase = ours(points), jnp.asarray(positions)
    print(f"first call with compilation: {timed(run, inputs, phase):.2f} s")
    own = ours(points, OWN)
    run(own, phase)
    blocks = run(inputs, phase)
    theirs = rival.cache_blocked(positions, points)
    force = np.concatenate([block.force for block in blocks]).T
    residual = max(block.residual for block in blocks)
    agreement = np.abs(force / theirs.force - 1.0).max()
    print(f"agreement: force {agreement:.1e}, residual {residual:.1e}")
    contenders = {
        "pitchpoint": lambda: run(inputs, phase),
        "a law of one's own": lambda: run(own, phase),
        "whole array": lambda: rival.whole_array(positions, points),
        "cache blocked": lambda: rival.cache_blocked(positions, points),
    }
    times: dict[str, list[float]] = {name: [] for name in contenders}
    for _ in range(asked.repeats):  # in turn, so that a drift of the machine meets all alike
        for name, work in contenders.items():
            times[name].append(timed(work) / states * 1e9)
    for name, values in times.items():
        print(f"{name:18s} {statistics.median(values):7.1f} ns a state")
    ratios = [
        min(whole, blocked) / by_name
        for by_name, _, whole, blocked in zip(*times.values(), strict=True)
    ]
    print(f"ratio to the better rival: {statistics.median(ratios):.2f} (goal 0.5)")
    if asked.large:
        _large(phase)
    own = statistics.median(times["pitchpoint"])
    print(
        f"benchmark states ratio={statistics.median(ratios):.3g} nanoseconds={own:.3g} "
        f"agreement={agreement:.2e} residual={residual:.2e}"
    )
    if not max(agreement, residual) <= AGREEMENT:
        sys.exit(f"forces or torques of states differ by more than {AGREEMENT:.0e}")


def _large(phase: jax.Array) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    design, operation, models = ours(rival.random_points(100_000))
    start, count = time.perf_counter(), 0
    for block in state_grid(design, operation, phase, models):
        count += block.efficiency.size
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    print(f"{count:.3g} states in {time.perf_counter() - start:.0f} s, {grown:.0f} MB more memory")


if __name__ == "__main__":
    main()
