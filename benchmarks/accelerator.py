"""An accelerator beside the processor of the same machine: seconds of the clock, compilation left out.

    python benchmarks/accelerator.py

Each workload runs in a process of its own on JAX's usual device, then in one that uses one core of the
processor; results must be equal. Where JAX has no accelerator it says so and ends.
States of a mesh, designs and motions side by side are what one gains from; films are solved step by step in
programs made for a processor, and are measured to say so.
"""

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
sys.path.insert(0, str(FOLDER / "rivals"))


def states(count: int) -> Callable[[], Any]:
    """A mesh cycle of 4,096 positions under as many operating points as are asked for."""
    import numpy as np
    import spur_numpy
    import states as own

    inputs = own.ours(spur_numpy.random_points(count), own.XU)
    phase = own.jnp.asarray(np.sort(np.random.default_rng(0).random(4096)))
    return lambda: own.jnp.concatenate([block.efficiency for block in own.run(inputs, phase)])[
        ::97, ::89
    ]


def designs(count: int) -> Callable[[], Any]:
    import building
    import numpy as np

    shift = np.linspace(0.0, 0.3, count)
    both = np.stack([shift, -shift], axis=1)

    def built() -> list[Any]:
        (group,) = building.build_cylindrical_pairs(**building.PAIR, profile_shift=both).groups
        return [leaf[::97] for leaf in building.jax.tree.leaves(group.mesh)]

    return built


def motions(count: int) -> Callable[[], Any]:
    """Two mesh cycles of six coordinates each; one core is quicker where it takes them in turn."""
    import functools

    import motion

    own, jax = motion.design(), motion.jax
    torques, speeds, _ = motion.drawn(own, count)
    single = motion.two_cycles(own, True)
    in_turn = jax.default_backend() == "cpu"
    compute = motion.eqx.filter_jit(
        functools.partial(jax.lax.map, single) if in_turn else jax.vmap(single)
    )
    return lambda: compute((motion.jnp.asarray(torques), motion.jnp.asarray(speeds)))[0]


def lines(count: int) -> Callable[[], Any]:
    import films

    contacts = films.contacts(*films.drawn(count))
    return lambda: films.solve_lines(contacts, nodes=129).film.central_film


def patch(nodes: int) -> Callable[[], Any]:
    import patch_films

    contact = patch_films.line(1e9, 1.0, crown=5e-6)
    return lambda: patch_films.middle(patch_films.solve(contact, nodes, nodes - 1))


WORK: dict[Callable[[int], Callable[[], Any]], tuple[int, float]] = {
    states: (8192, 1e-10),
    designs: (20_000, 1e-10),
    motions: (2048, 1e-6),
    lines: (64, 1e-6),
    patch: (129, 1e-6),
}
"""Sizes, and the most by which results of both may differ, to their largest."""


def measured(name: str, count: int) -> dict[str, Any]:
    """Seconds of the clock of a workload that was run before, and its numbers."""
    import jax
    import numpy as np

    jax.config.update("jax_enable_x64", True)
    work = globals()[name](count)
    begun = time.perf_counter()
    jax.block_until_ready(work())
    first = time.perf_counter() - begun
    begun = time.perf_counter()
    result = jax.block_until_ready(work())
    seconds = time.perf_counter() - begun
    numbers = np.concatenate([np.ravel(leaf) for leaf in jax.tree.leaves(result)])
    kind = jax.devices()[0].device_kind
    return {"seconds": seconds, "first": first, "device": kind, "numbers": numbers.tolist()}


def apart(name: str, count: int, limit: float, **environment: str) -> dict[str, Any] | str:
    """What a process of its own measured, or why it did not."""
    command = [sys.executable, __file__, "--within", name, "--count", str(count)]
    try:
        done = subprocess.run(
            command, env=os.environ | environment, capture_output=True, text=True, timeout=limit
        )
    except subprocess.TimeoutExpired:
        return f"more than {limit:.0f} s"
    if done.returncode:
        return f"fails: {(done.stderr.splitlines() or ['without a word'])[-1]}"
    return dict(json.loads(done.stdout.splitlines()[-1]))


def beside(name: str, count: int, agree: float, limit: float) -> None:
    """Prints a workload on the accelerator and on a core of the processor."""
    import numpy as np

    fast = apart(name, count, limit)
    cores = apart(name, count, limit, JAX_PLATFORMS="cpu", CUDA_VISIBLE_DEVICES="")
    told = [
        one if isinstance(one, str) else f"{one['seconds']:.4f} s (first {one['first']:.1f} s)"
        for one in (fast, cores)
    ]
    line = f"{name} {count}: accelerator {told[0]}, one core {told[1]}"
    if isinstance(fast, dict) and isinstance(cores, dict):
        ours, theirs = np.array(fast["numbers"]), np.array(cores["numbers"])
        away = np.nanmax(np.abs(ours - theirs)) / np.nanmax(np.abs(theirs))
        line += f", {cores['seconds'] / fast['seconds']:.2f} times; differ by {away:.0e}"
        assert away < agree, line
    print(line, flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--within", help="measure here")
    parser.add_argument("--count", type=int)
    parser.add_argument("--limit", type=float, default=150.0, help="seconds of a process")
    parser.add_argument("names", nargs="*")
    asked = parser.parse_args()
    if asked.within:
        sys.argv[1:] = []
        print(json.dumps(measured(asked.within, asked.count)))
        return
    import jax

    print(f"{jax.devices()[0].device_kind}, JAX {jax.__version__}, {os.cpu_count()} cores")
    if jax.default_backend() == "cpu":
        print("no accelerator")
        return
    for workload, (count, agree) in WORK.items():
        if not asked.names or workload.__name__ in asked.names:
            beside(workload.__name__, count, agree, asked.limit)


if __name__ == "__main__":
    main()
