"""Line contacts with an oil film: the package beside a loop in NumPy.

    taskset -c 0 .venv/bin/python benchmarks/films.py

64 contacts of .4 to 1.5 GPa and .3 to 10 m/s. `rivals/ehl_line.py` solves one after the other with the same
equations, the same scheme and as many nodes on a uniform grid of its own; its films are compared. Then a mesh
cycle of 100 phases with two pairs of teeth, and ten thousand contacts without profiles with the memory that
they take. Times are those of the processor, the first run, which compiles, is told apart.
"""

import resource
import time
from collections.abc import Callable
from typing import Any

import bench
import ehl_line as rival
import jax
import numpy as np

from pitchpoint.lubrication.ehl.line import LineContact
from pitchpoint.lubrication.ehl.solve import solve_lines
from pitchpoint.lubrication.ehl.texture import Rough
from pitchpoint.materials.fluid import Fluid

jax.config.update("jax_enable_x64", True)

MODULUS, RADIUS, VISCOSITY, ALPHA = 2.26e11, 0.01, 0.04, 2.2e-8
SIZES = bench.sizes(
    __doc__, contacts=(64, 4), nodes=(129, 129), phases=(100, 3), many=(10_000, 20), turns=(5, 1)
)


def drawn(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Loads [N/m] and mean speeds [m/s]."""
    random = np.random.default_rng(0)
    pressure = random.uniform(0.4e9, 1.5e9, count)
    speed = np.exp(random.uniform(np.log(0.3), np.log(10.0), count))
    return 2.0 * np.pi * (pressure / MODULUS) ** 2 * MODULUS * RADIUS, speed


def contacts(load: Any, speed: Any, **more: Any) -> LineContact:
    fluid = Fluid(viscosity=VISCOSITY, pressure_viscosity=ALPHA)
    given = {"line_load": load, "radius": RADIUS, "modulus": MODULUS, "fluid": fluid}
    return LineContact(**given, speed_a=1.05 * speed, speed_b=0.95 * speed, **more)


def timed(action: Callable[[], Any]) -> tuple[float, float, Any]:
    """Processor time of the first run and the least of those after it, and the result."""
    times = []
    for _ in range(SIZES.turns + 1):
        begin = time.process_time()
        found = action()
        times.append(time.process_time() - begin)
    return times[0], min(times[1:]), found


def beside_the_rival(nodes: int) -> float:
    """How many times as long the loop takes."""
    count = SIZES.contacts
    load, speed = drawn(count)
    cases = [
        rival.Case(w, u, RADIUS, MODULUS, VISCOSITY, ALPHA)
        for w, u in zip(load, speed, strict=True)
    ]
    _, loop, theirs = timed(lambda: [rival.solve(one, nodes) for one in cases])
    first, ours, films = timed(lambda: solve_lines(contacts(load, speed), nodes=nodes))
    width = np.asarray(films.film.half_width)
    middle = [one.film[np.argmin(np.abs(one.x))] for one in theirs]
    off = films.film.central_film / (np.array(middle) * width**2 / RADIUS) - 1.0
    apart = np.nanmedian(np.abs(off))
    print(
        f"{count} contacts on {nodes} nodes: loop {1e3 * loop / count:.2f} ms each, "
        f"{sum(one.residual < 1e-9 for one in theirs)} solved; package {1e3 * ours / count:.2f} ms each, "
        f"{int(films.solved.sum())} solved, {loop / ours:.1f} times as fast, first run {first:.1f} s; "
        f"films differ by {100 * apart:.2g} % in the median"
    )
    assert apart < 0.1, "the rival finds other films"
    return loop / ours


def a_mesh_cycle() -> None:
    phase = np.linspace(0.0, 1.0, SIZES.phases)[:, None]
    share = np.clip(np.stack([phase, 1.0 - phase], axis=-1)[:, 0], 0.05, None)
    load, radius = 2.5e5 * share, 0.004 + 0.006 * np.hstack([phase, 1.0 - phase])
    rough = Rough(rq=0.4e-6, modulus=MODULUS)
    case = LineContact(
        line_load=load,
        radius=radius,
        modulus=MODULUS,
        speed_a=3.0 + phase,
        speed_b=4.0 - phase,
        fluid=Fluid(viscosity=VISCOSITY, pressure_viscosity=ALPHA),
        texture=rough,
    )
    first, again, films = timed(lambda: solve_lines(case))
    print(
        f"mesh cycle of {SIZES.phases} phases with 2 pairs, rough, 129 nodes: {again:.2f} s, "
        f"first run {first:.1f} s, {int(films.solved.sum())} of {2 * SIZES.phases} solved"
    )


def many() -> None:
    load, speed = drawn(SIZES.many)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    begin = time.process_time()
    films = solve_lines(contacts(load, speed), nodes=65, profiles=False)
    took = time.process_time() - begin
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
    print(
        f"{SIZES.many} contacts on 65 nodes without profiles: {took:.1f} s, "
        f"{int(films.solved.sum())} solved, {grown:.0f} MB more memory at the most"
    )


if __name__ == "__main__":
    ratio, finer = map(beside_the_rival, (SIZES.nodes, 2 * SIZES.nodes - 1))
    a_mesh_cycle()
    many()
    bench.last_line(ratio=ratio, finer=finer)
