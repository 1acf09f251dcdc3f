"""A ball pressed on a plane, without a lubricant: the package beside tamaas 2.9.0, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/dry_contact.py --rival PYTHON

PYTHON is the interpreter of an environment with tamaas, as `rivals/tamaas_hertz.py` makes it; without it the
package is timed alone. 129 x 129 cells over 3 radii of the contact. Accuracy is told twice: against Hertz,
which is that of the grid, and against the solution of the same cells that tamaas iterates to the end with
its operator of two half spaces. Its periodic one solves another problem, rows of contacts. Times are those
of the processor, without compilation; the kernel of a grid is told apart. Then straight rollers.
"""

import json
import os
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bench
import numpy as np

from pitchpoint._jax import jax
from pitchpoint.contact.dry_contact import dry_contact
from pitchpoint.contact.gaps import elliptic_gap, line_gap
from pitchpoint.contact.half_space import HalfSpace, graded_edges, half_space

jax.config.update("jax_enable_x64", True)

SIZES = bench.sizes(__doc__, rival="tamaas", cells=(129, 33), rollers=(128, 32), turns=(5, 1))
CELLS, WIDTH = SIZES.cells, 3.0
RIVAL = bench.RIVALS / "tamaas_hertz.py"
RIVALS_CELLS = 129
MODULUS, LOAD, LARGEST = 2.0, 4.0 / 3.0, 2.0 / np.pi


def timed(action: Callable[[], Any]) -> tuple[float, Any]:
    """Least processor time after a first run, and the result."""
    jax.block_until_ready(action())
    times = []
    for _ in range(SIZES.turns):
        begin = time.process_time()
        found = jax.block_until_ready(action())
        times.append(time.process_time() - begin)
    return min(times), found


def ball() -> tuple[HalfSpace, np.ndarray]:
    """A grid of the rival's places, with lengths in the radius of the contact."""
    x = (np.arange(CELLS) - CELLS // 2) * WIDTH / CELLS
    bodies = half_space(x, np.linspace(-WIDTH / 2.0, WIDTH / 2.0, CELLS + 1))
    return bodies, np.asarray(elliptic_gap(bodies, 1.0, 1.0))


def rivals(python: str, save: str) -> Iterator[dict[str, Any]]:
    done = subprocess.run(
        [python, str(RIVAL), "--save", save],
        env=os.environ | {"OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    yield from map(json.loads, done.stdout.splitlines())


def beside_hertz(python: str | None) -> float:
    """Seconds of a ball, with what Hertz and tamaas find."""
    kernel, (bodies, gap) = timed(ball)
    seconds, found = timed(lambda: dry_contact(bodies, gap, MODULUS, load=LOAD))
    pressure = np.asarray(found.pressure) / LARGEST
    print(
        f"ball, {CELLS} x {CELLS}: {seconds:.3f} s, {int(found.status.iterations)} iterations, residual "
        f"{float(found.status.residual):.0e}, largest pressure {pressure.max():.5f} of Hertz; kernel of the "
        f"grid {kernel:.3f} s"
    )
    assert abs(pressure.max() - 1.0) < 0.02, "Hertz finds another pressure"
    if python is None or CELLS != RIVALS_CELLS:
        print("tamaas is left out: `--rival PYTHON` names the python of an environment with it")
        return seconds
    with tempfile.TemporaryDirectory() as folder:
        save = str(Path(folder) / "pressure.npy")
        told = list(rivals(python, save))
        off = np.abs(pressure - np.load(save)).max()
    print(f"  off the solution of the same cells by {off:.0e} of the largest pressure")
    for one in told:
        print(
            f"  tamaas, {one['operator']}, tolerance {one['tolerance']:.0e}: {one['seconds']:.3f} s, "
            f"{one['seconds'] / seconds:.1f} times as long, {one['seconds'] / (seconds + kernel):.1f} times "
            f"with our kernel counted; off its solution by {one['off']:.0e}, largest pressure "
            f"{one['largest']:.5f} of Hertz"
        )
    assert off < 1e-6, "tamaas finds other pressures"
    return seconds


def rollers() -> None:
    """Straight rollers of 56.5 half-widths under the load of Hertz."""
    for cells in (SIZES.rollers, 2 * SIZES.rollers):
        nodes = cells + 1
        edges = graded_edges(56.5, cells, 0.02)
        kernel, bodies = timed(lambda: half_space(np.linspace(-2.0, 2.0, nodes), edges))  # noqa: B023
        gap = np.asarray(line_gap(bodies, 1.0, 0.0))
        load = np.pi * MODULUS / 8.0 * 56.5
        seconds, found = timed(
            lambda: dry_contact(bodies, gap, MODULUS, load=load, to_ends=True)  # noqa: B023
        )
        print(
            f"straight roller, {nodes} x {cells}: {seconds:.3f} s, {int(found.status.iterations)} "
            f"iterations; kernel of the grid {kernel:.3f} s"
        )


if __name__ == "__main__":
    seconds_of_ball = beside_hertz(SIZES.rival)
    rollers()
    bench.last_line(seconds=seconds_of_ball)
