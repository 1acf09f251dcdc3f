"""Dynamic transmission error, microseconds a case: the package beside solve_ivp, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/transmission_error.py

A case is a design at a load: helical gears with few teeth like the first pair of Atanasiu et al.
(2011), steel on polyamide, of random profile shifts, width, damping and load. Its figures are mean
and peak to peak of the transmission error and the largest dynamic factor over a steady period, with
about 90 natural periods in a mesh period. `rivals/dte_solve_ivp.py` gets the very stiffness of the
mesh that the package computes, through its own file format, and reads the same three figures; for
them alone the package then reads the force of the whole mesh. Told apart is what the package does
beyond its rival: stiffness from the design, force of every pair. Compile time is told apart.
"""

import dataclasses
import statistics
import tempfile
import time
from collections.abc import Callable

import bench
import dte_solve_ivp as rival
import equinox as eqx
import jax
import numpy as np

from pitchpoint._jax import jnp
from pitchpoint.dynamics.excitation import Excitation
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.pair_vibration import Vibrating, excitation, frequency_ratio, system
from pitchpoint.dynamics.response import Response
from pitchpoint.dynamics.steady_state import steady_state
from pitchpoint.dynamics.system import System
from pitchpoint.efficiency.quasi_static import Design as Gears
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.loading.mesh_stiffness import MeshStiffness, mesh_stiffness
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.materials import lubricants
from pitchpoint.materials.solids import Solid
from pitchpoint.materials.surfaces import Roughness

jax.config.update("jax_enable_x64", True)

SOLIDS = (
    Solid(young=206e9, poisson=0.3, density=7830.0),
    Solid(young=3.54e9, poisson=0.4, density=1140.0),
)
TERMS = terms_of("beam_foundation_weber")
OIL, SMOOTH = lubricants.find("pao-vg-220").build(), Roughness.from_composite_rq(0.4e-6)
SPEED = 1800.0 * np.pi / 30.0
AGREE = 1e-4
"""Largest deviation of a figure from the rival's at a tight tolerance."""


class Design(eqx.Module):
    """What differs between cases; first axis (cases,)."""

    shift: jax.Array
    width: jax.Array
    damping_ratio: jax.Array
    torque: jax.Array


Excited = tuple[MeshStiffness, System, Excitation]
Figures = dict[str, jax.Array]


def random_designs(count: int) -> Design:
    rng = np.random.default_rng(0)
    first = rng.uniform(0.68, 0.80, count)
    return Design(
        shift=jnp.asarray(
            np.stack([first, 0.79 - first + rng.uniform(-0.02, 0.02, count)], axis=1)
        ),
        width=jnp.asarray(rng.uniform(15e-3, 17e-3, count)),
        damping_ratio=jnp.asarray(rng.uniform(0.13, 0.19, count)),
        torque=jnp.asarray(rng.choice([3.825, 5.355], count)),
    )


def base_pair() -> CylindricalPair:
    """The pair all designs come from: its tip is shortened, it has no undercut, as they have."""
    angle = float(np.radians(20.0))
    return build_cylindrical_pair(
        teeth=(4, 51),
        module=1.5e-3,
        pressure_angle=angle,
        helix_angle=angle,
        face_width=16e-3,
        profile_shift=(0.74, 0.05),
        least_tip=0.25,
    )


def excited(pair: CylindricalPair, design: Design) -> Excited:
    """Stiffness of one design's mesh, and the system that it excites."""
    own = dataclasses.replace(pair, profile_shift=design.shift, face_width=design.width).completed()
    none = jnp.zeros(0)
    inertia = plain_inertia(own, jnp.stack([solid.density for solid in SOLIDS]))
    vibrating = Vibrating(inertia, design.damping_ratio, none, none, orders=())
    between = Gears(own, SOLIDS, OIL, SMOOTH)
    found = mesh_stiffness(own, between.loaded, SOLIDS, TERMS, design.torque)
    moved = system(
        between, vibrating, found.mean, Operation(design.torque, SPEED, jnp.asarray(300.0))
    )
    return found, moved, excitation(found, vibrating)


@eqx.filter_jit
def all_excited(pair: CylindricalPair, designs: Design) -> Excited:
    return jax.lax.map(lambda design: excited(pair, design), designs, batch_size=4)


def whole(stiffness: MeshStiffness, driven: Excitation) -> Excitation:
    """The mesh as one spring along the line of action, as the rival sees it."""
    total = stiffness.total[None]
    return Excitation(driven.edges, total, jnp.ones_like(total)[None], jnp.zeros_like(total))


def figures(stiffness: MeshStiffness, moved: System, found: Response) -> Figures:
    del stiffness
    factor = found.dynamic_factor(moved.load[0])
    error = found.transmission_error
    return {
        "mean": found.mean(error),
        "peak_to_peak": found.peak_to_peak(error),
        "dynamic_factor": jnp.max(found.extremes(factor)[1]),
        "status": found.status.code,
    }


@eqx.filter_jit
def solved(parts: Excited, grid: PeriodGrid, of_mesh: bool) -> Figures:
    def one(part: Excited) -> Figures:
        stiffness, moved, driven = part
        driven = whole(stiffness, driven) if of_mesh else driven
        return figures(stiffness, moved, steady_state(moved, driven, grid))

    return jax.lax.map(one, parts)


def rival_cases(parts: Excited, count: int) -> rival.Cases:
    """Cases in the rival's format, by way of a file."""
    stiffness, moved, _ = jax.tree.map(lambda leaf: np.asarray(leaf)[:count], parts)
    cases = rival.Cases(
        edges=stiffness.edges - stiffness.edges[:, :1],
        stiffness=np.sum(stiffness.along_action, axis=1),
        mass=moved.mass[:, 0, 0],
        damping=moved.damping[:, 0, 0],
        force=moved.load[:, 0],
        period=moved.period,
    )
    with tempfile.TemporaryDirectory() as folder:
        name = f"{folder}/cases.npz"
        np.savez(name, **cases._asdict())
        return rival.read_cases(name)


def timed(work: Callable[[], object]) -> float:
    """Processor seconds: on one thread those of the clock, unless others use the core too."""
    start = time.process_time()
    jax.block_until_ready(work())
    return time.process_time() - start


def compare(own: Figures, theirs: rival.Steady) -> float:
    """Largest deviation of a figure, after each has been printed."""
    count, largest = theirs.mean.size, 0.0
    for name in ("mean", "peak_to_peak", "dynamic_factor"):
        away = np.max(np.abs(np.asarray(own[name])[:count] / getattr(theirs, name) - 1.0))
        print(f"  {name}: {away:.1e}")
        largest = max(largest, float(away))
    return largest


def main() -> None:
    asked = bench.sizes(__doc__, cases=(1000, 4), looped=(20, 1), repeats=(5, 1))
    designs, pair = random_designs(asked.cases), base_pair()
    print(
        f"stiffness: first call with compilation {timed(lambda: all_excited(pair, designs)):.2f} s"
    )
    parts = all_excited(pair, designs)
    ratios = jax.vmap(frequency_ratio)(*parts[:2])
    grid = PeriodGrid.resolving(float(jnp.max(ratios)))
    print(f"natural over mesh frequency {jnp.min(ratios):.1f} to {jnp.max(ratios):.1f}, {grid}")
    own = {
        "stiffness from design": lambda: all_excited(pair, designs),
        "vibration of every pair": lambda: solved(parts, grid, False),
        "vibration": lambda: solved(parts, grid, True),
    }
    for name, work in list(own.items())[1:]:
        print(f"{name}: first call with compilation {timed(work):.2f} s")
    found = solved(parts, grid, True)
    print(f"statuses other than converged: {np.count_nonzero(found['status'])}")
    cases, some = rival_cases(parts, asked.cases), rival_cases(parts, asked.looped)
    loop = min(timed(lambda: rival.steady(some)) for _ in range(2)) / asked.looped
    together = timed(lambda: rival.steady_together(cases)) / asked.cases
    print(f"solve_ivp: loop {loop * 1e6:.0f} us a case, together {together * 1e6:.0f} us a case")
    ratio = 0.0
    for name, work in own.items():
        each = statistics.median(timed(work) for _ in range(asked.repeats)) / asked.cases
        ratio = loop / each
        text = f"loop over it {ratio:.0f}, together over it {together / each:.1f}"
        print(f"{name}: {each * 1e6:.0f} us a case{'' if 'design' in name else ', ' + text}")
    print("largest deviation from solve_ivp at its tolerance and at a tight one (asked 1e-4)")
    compare(found, rival.steady(some))
    away = compare(found, rival.steady(some, rival.TIGHT))
    assert away < AGREE, "solve_ivp finds another motion"
    bench.last_line(ratio=ratio)


if __name__ == "__main__":
    main()
