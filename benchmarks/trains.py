"""Planetary and 3K trains: a state beside those of their meshes alone, later runs beside that of two pairs.

    taskset -c 0 .venv/bin/python benchmarks/trains.py

A state of a train is one phase under one operating point with all copies of all meshes in equilibrium; its
meshes alone are as many states of each pair as there are copies, at the same phases, under the load that it
has in the train, compiled alike. Programs of a train have places for planets in common, of which 3 leave one
empty: 4 planets show what equilibrium takes, and without losses beside the teeth, which meshes alone do not
have. Seconds are of the processor, compile time is left out. Runs of examples have programs of their own from
the run before, each in turn with that of two pairs in a row.
"""

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import bench
import equinox as eqx
import jax
import numpy as np
import pace

from pitchpoint._jax import jnp
from pitchpoint.efficiency.quasi_static import Operation, state
from pitchpoint.efficiency.train_cycle import train_cycle
from pitchpoint.runs.run import load_case

jax.config.update("jax_enable_x64", True)

EXAMPLES = pace.ROOT / "examples"
RIVAL, RUNS = "two_stage", ("planetary", "planetary_printed", "three_k")
SIZES = bench.sizes(__doc__, points=(64, 8), repeats=(7, 1), runs=(3, 0))


def seconds(*works: Callable[[], object]) -> list[float]:
    """Least processor time of some runs in turn, after one each that compiles."""
    found: list[list[float]] = [[] for _ in works]
    for work in works:
        jax.block_until_ready(work())
    for _ in range(SIZES.repeats):
        for own, work in zip(found, works, strict=True):
            start = time.process_time()
            jax.block_until_ready(work())
            own.append(time.process_time() - start)
    return [*map(min, found)]


def over_meshes(name: str, planets: int, braked: bool) -> float:
    """Time of a state of an example with so many planets over that of its meshes alone."""
    built: Any = load_case(EXAMPLES / f"{name}.toml", settings={"gears.planets": planets})
    train, laws = built.design, built.models[0].stages
    train = train if braked else replace(train, drag=(), braked=())
    load, speed, temperature = (float(x) for x in jax.tree.leaves(built.operation))
    loads = load * np.linspace(0.5, 1.5, SIZES.points)
    points = Operation(*(jnp.asarray(x + 0.0 * loads) for x in (loads, speed, temperature)))

    @eqx.filter_jit
    def together(points: Operation) -> Any:
        def one(point: Operation) -> Any:
            found = train_cycle.function(train, point, laws)
            return found.input_torque, found.loss

        return jax.vmap(one)(points)

    phases = train_cycle(train, built.operation, laws).phase

    @eqx.filter_jit
    def alone(points: Operation) -> Any:
        def one(point: Operation) -> Any:
            each = []
            for place, mesh, own in zip(train.meshes, built.stages, laws, strict=True):
                at = place.phases[:planets, None] + place.periods * phases
                part, rate = point.load / load, point.speed / speed
                here = Operation(
                    mesh.operation.load * part, mesh.operation.speed * rate, point.temperature
                )
                found = state(mesh.design, here, at, own)
                each.append((found.input_torque, found.loss))
            return each

        return jax.vmap(one)(points)

    both, meshes = seconds(lambda: together(points), lambda: alone(points))
    states = SIZES.points * phases.size
    print(
        f"{name:18} {planets} planets{' on bearings' * braked:12} {1e6 * both / states:8.2f} us a state, "
        f"meshes alone {1e6 * meshes / states:8.2f}, {both / meshes:5.2f} times",
        flush=True,
    )
    return both / meshes


def later_runs() -> dict[str, float]:
    """Least processor time of later runs over that of two pairs in a row; nothing in a small run."""
    if not SIZES.runs:
        return {}
    pace.RUNS |= {name: str(EXAMPLES / f"{name}.toml") for name in (RIVAL, *RUNS)}
    with tempfile.TemporaryDirectory() as folder:
        runs = {name: pace.Run(Path(folder) / name, name) for name in (RIVAL, *RUNS)}
        took: dict[str, list[float]] = {name: [] for name in runs}
        for _ in range(SIZES.runs):
            for name, run in runs.items():
                took[name].append(run.once().seconds)
    least = {name: min(own) for name, own in took.items()}
    for name, own in least.items():
        print(f"{name:18} {own:6.2f} s of a later run, {own / least[RIVAL]:5.2f} times", flush=True)
    return {f"{name}_run": least[name] / least[RIVAL] for name in RUNS}


if __name__ == "__main__":
    found = {
        "braked": over_meshes("planetary", 3, braked=True),
        "three": over_meshes("planetary", 3, braked=False),
        "four": over_meshes("planetary", 4, braked=False),
        **later_runs(),
    }
    bench.last_line(**found)
