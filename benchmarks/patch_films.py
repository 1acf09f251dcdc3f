"""Films of contacts of finite length: processor seconds on 129 x 128 and 257 x 256, and memory.

    .venv/bin/python benchmarks/patch_films.py --rival PYTHON

PYTHON is the interpreter of an environment with slippy, as `rivals/slippy_point.py` makes it; without it the
package is timed alone. Programs are compiled before the clock starts. The dry contact and all coarser grids
count. The rival's film is that of its own grid; ours on finer ones tell how far both are off.
"""

import json
import os
import resource
import subprocess
import time
from collections.abc import Callable, Iterator

import bench
import jax
import numpy as np

from pitchpoint._jax import array
from pitchpoint.contact.end_profiles import crowned, log_relieved
from pitchpoint.lubrication.ehl.patch.contact import PatchContact, elliptic_contact, finite_line
from pitchpoint.lubrication.ehl.patch.newton import ENOUGH
from pitchpoint.lubrication.ehl.patch.solve import Solved, solve
from pitchpoint.materials.fluid import Fluid

jax.config.update("jax_enable_x64", True)

MODULUS, OIL = 2.26e11, Fluid(viscosity=0.04, pressure_viscosity=2.2e-8)
LONG = 56.5
"""Length of the lines over their half-width."""

SIZES = bench.sizes(__doc__, rival="slippy", cells=(128, 32), cases=(9, 1), balls=(3, 0))
FINE, FINER = (SIZES.cells + 1, SIZES.cells), (2 * SIZES.cells + 1, 2 * SIZES.cells)
RIVAL, RIVALS_NODES = bench.RIVALS / "slippy_point.py", 65


def line(
    pressure: float, speed: float, radius: float = 0.01, crown: float = 0.0, drop: float = 0.0
) -> PatchContact:
    """A roller on a plane, of a Hertz pressure [Pa], mean speed [m/s], radius [m] and relief of its ends [m].

    The relief is a crown or, as a drop, a logarithm.
    """
    line_load = 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * radius
    length = LONG * np.sqrt(8.0 * line_load * radius / (np.pi * MODULUS))
    profile = crowned(width=length, radius=length**2 / (8.0 * crown)) if crown else ()
    if drop:
        profile = log_relieved(width=length, line_load=line_load, modulus=MODULUS, drop=drop)
    return finite_line(
        load=line_load * length,
        length=length,
        radius=radius,
        modulus=MODULUS,
        speed_a=speed,
        speed_b=speed,
        fluid=OIL,
        profile=profile,
    )


def ball() -> PatchContact:
    """A ball of 19.05 mm on a plane."""
    return elliptic_contact(
        load=800.0,
        radius=0.01905,
        transverse_radius=0.01905,
        modulus=2.28e11,
        speed_a=4.0,
        speed_b=4.0,
        fluid=Fluid(viscosity=0.096, pressure_viscosity=2.2e-8),
    )


CASES: dict[str, Callable[[], PatchContact]] = {
    "crown 5 um, 1.5 GPa, 1 m/s": lambda: line(1.5e9, 1.0, crown=5e-6),
    "crown 5 um, 1 GPa, 1 m/s": lambda: line(1e9, 1.0, crown=5e-6),
    "crown 5 um, 1 GPa, 0.1 m/s": lambda: line(1e9, 0.1, crown=5e-6),
    "straight, 1.5 GPa, 1 m/s": lambda: line(1.5e9, 1.0),
    "straight, 1 GPa, 1 m/s": lambda: line(1e9, 1.0),
    "logarithm of 8 um, 1 GPa, 1 m/s": lambda: line(1e9, 1.0, drop=8e-6),
    "crown 2 um, R 100 mm, 0.3 GPa, 0.3 m/s": lambda: line(3e8, 0.3, 0.1, 2e-6),
    "crown 2 um, R 100 mm, 0.3 GPa, 0.03 m/s": lambda: line(3e8, 0.03, 0.1, 2e-6),
    "ball, 1.73 GPa, 4 m/s": ball,
}


def timed(contact: PatchContact, grid: tuple[int, int]) -> tuple[float, Solved]:
    """Processor seconds of a solve, compiled before, and its solution."""
    solve(contact, *grid)
    begun = time.process_time()
    found = solve(contact, *grid)
    return time.process_time() - begun, found


def rows() -> Iterator[tuple[str, float]]:
    """Cases with their seconds, told as they come."""
    for name, made in list(CASES.items())[: SIZES.cases]:
        seconds, (_, _, state, _) = timed(made(), FINE)
        assert state.residual < ENOUGH, f"{name} is not solved"
        print(
            f"{name}: {seconds:.2f} s, {state.steps} steps, residual {state.residual:.0e}",
            flush=True,
        )
        yield name, seconds


def rivals_ball() -> PatchContact:
    """The ball with the rival's steel and oil."""
    slope = 0.68 * 5.1e-9 * (np.log(0.096) + 9.67)
    oil = Fluid(viscosity=0.096, pressure_viscosity=slope)
    steel = 2.0 * 200e9 / (2.0 * (1.0 - 0.3**2))
    return elliptic_contact(
        load=800.0,
        radius=0.01905,
        transverse_radius=0.01905,
        modulus=steel,
        speed_a=4.0,
        speed_b=4.0,
        fluid=oil,
    )


def beside_slippy(python: str | None) -> None:
    """Print the ball of the rival on three grids, and the rival."""
    contact, own = rivals_ball(), {}
    for nodes in (RIVALS_NODES, 129, 257)[: SIZES.balls]:
        own[nodes], found = timed(contact, (nodes, nodes - 1))
        film = 1e9 * middle(found)
        print(f"ball of slippy, {nodes}: {own[nodes]:.2f} s, film {film:.0f} nm", flush=True)
    if python is None:
        print("slippy is left out: `--rival PYTHON` names the python of an environment with it")
        return
    done = subprocess.run(
        [python, str(RIVAL), "--nodes", str(RIVALS_NODES)],
        env=os.environ | {"OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    told = json.loads(done.stdout.splitlines()[-1])
    ratio = told["seconds"] / own[RIVALS_NODES]
    print(
        f"slippy, {RIVALS_NODES}: {told['seconds']:.2f} s, {ratio:.1f} times as long, "
        f"film {1e9 * told['film']:.0f} nm"
    )
    assert abs(told["film"] / middle(found) - 1.0) < 0.2, "slippy finds another film"


def middle(found: Solved) -> float:
    """Gap at the node next to the middle [m]; not a number where no film was found."""
    _, problem, state, _ = found
    if not state.residual < ENOUGH:
        return np.nan
    gap = problem.gap(array(state.pressure), array(state.level)) * problem.flow.height
    node = int(np.argmin(np.abs(np.asarray(problem.bodies.x))))
    return float(gap[len(gap) // 2, node])


def main() -> None:
    """Print the figures."""
    beside_slippy(SIZES.rival)
    seconds = dict(rows())
    median = float(np.median(list(seconds.values())))
    print(f"median: {median:.2f} s")
    first = next(iter(CASES))
    finer, (_, _, state, _) = timed(CASES[first](), FINE if SIZES.small else FINER)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    print(
        f"{first} on {FINER[0]} x {FINER[1]}: {finer:.1f} s, {finer / seconds[first]:.1f} times, "
        f"{state.steps} steps, residual {state.residual:.0e}, {memory:.1f} GB"
    )
    bench.last_line(seconds=median)


if __name__ == "__main__":
    main()
