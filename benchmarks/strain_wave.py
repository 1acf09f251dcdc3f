"""Strain wave gear: conjugate groove and efficiency map, beside a NumPy loop, on one thread.

    OPENBLAS_NUM_THREADS=1 taskset -c 0 .venv/bin/python benchmarks/strain_wave.py

The groove that 200 teeth of the shipped drive sweep, after the first run: asked are less than 1 s.
The map is the loss map of the same case: torques by speeds by temperatures, load shared by stiffness
of teeth and ring, friction constant, bearing loss by Palmgren's law. The rival is
`rivals/strain_wave_numpy.py`, timed for a few of the torques; it says there what it is given.
Efficiencies are compared twice: from the rival's own contacts, and from the package's. Near the long
axis a tooth may touch at its root and at its tip; the rival lets it touch at the nearer place alone, and
the first comparison shows what that is worth.
Compile time is told apart. Times are those of the processor, which others on it do not change; the
parts of the package's time are those of one torque.
"""

import argparse
import os
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
sys.path.insert(0, str(Path(__file__).parent / "rivals"))

import equinox as eqx
import jax
import numpy as np
import strain_wave_numpy as rival
import xarray as xr

from pitchpoint._jax import jnp
from pitchpoint.analyses.loss_map import at_torque, map_axes, pieces
from pitchpoint.cases.built import Built
from pitchpoint.efficiency.quasi_static import (
    Engagement,
    Operation,
    contacts_at,
    coupling,
    cycle,
    engagement,
    shares_at,
)
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.gears.strain_wave import drive as strain_wave
from pitchpoint.gears.strain_wave.groove import swept
from pitchpoint.loading.compliance import compliance
from pitchpoint.runs.run import load_case

jax.config.update("jax_enable_x64", True)

OUTLINE = 400_001

AGREEMENT = 1e-9
"""Most that efficiencies from the same contacts may differ."""


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    start = time.process_time()
    found = jax.block_until_ready(work())
    return time.process_time() - start, found


def median(work: Callable[[], Any], repeats: int) -> float:
    return statistics.median(timed(work)[0] for _ in range(repeats))


def the_case(torques: int, speeds: int, temperatures: int) -> Built:
    degrees = np.linspace(-10.0, 40.0, temperatures)
    settings = {
        "loss_map.torque_count": torques + 1,
        "loss_map.speed_count": speeds + 1,
        "loss_map.temperatures": [f"{each:.6g} degC" for each in degrees],
    }
    return load_case("csd25", settings=settings)


def groove(built: Built, repeats: int) -> None:
    mesh = built.design.mesh
    sweep = eqx.filter_jit(lambda: swept(mesh.cutter_motion, mesh.tip_height, mesh.tips))
    first, _ = timed(sweep)
    print(f"groove of 200 teeth: first run with compilation {first:.2f} s, then", end=" ")
    print(f"{median(sweep, repeats):.3f} s (asked 1 s)")


def given(built: Built) -> rival.Drive:
    """Arrays for the rival."""
    mesh, drag = built.design.mesh, built.design.drag[0]
    along = np.linspace(0.0, float(mesh.flank.plain), OUTLINE)
    return rival.Drive(
        teeth=tuple(int(z) for z in mesh.teeth),
        neutral=float(mesh.line.radius),
        wave=float(mesh.line.deflection),
        window=strain_wave.WINDOW,
        along=along,
        outline=np.asarray(mesh.flank.place(along)),
        lean=np.asarray(mesh.flank.angle(along)),
        heights=np.asarray(mesh.groove.heights),
        half_width=np.asarray(mesh.groove.half_width),
        slope=np.asarray(mesh.groove.slope),
        friction=built.case.models.friction[0].parameters["coefficient"],
        mean_diameter=float(drag.mean_diameter),
        f0=float(drag.factors["f0"]),
        f1=float(drag.factors["f1"]),
    )


@eqx.filter_jit
def _compliance(built_in: Any, contacts: Any, terms: Any, torque: Any) -> Any:
    mesh, loaded, solids = built_in
    yields = compliance(mesh, loaded, contacts, solids, terms, torque)
    teeth = yields.of_teeth(contacts)
    lanes = teeth.reshape(-1, *teeth.shape[2:])
    count = lanes.shape[0]
    return yields.body + jnp.eye(count).reshape(count, count, *(1 for _ in lanes.shape[1:])) * lanes


def package_geometry(built: Built, known: Engagement) -> rival.Geometry:
    """The package's contacts in the rival's form, to compare what follows from them."""
    contacts = known.contacts
    return rival.Geometry(
        active=np.asarray(contacts.active[:, 0]),
        gap=np.asarray(contacts.gap[:, 0]),
        normal=np.asarray(contacts.normal[:, :, 0]),
        slip=np.asarray(contacts.slip_arm[:, :, 0]),
        radial=np.asarray(built.design.mesh.body.inner_load(contacts)).sum(axis=0)[:, 0],
    )


@eqx.filter_jit
def _balance(design: Any, points: Operation, models: Any, known: Engagement) -> Any:
    found = cycle(design, points, models, engaged=known)
    return found.mean_loss, found.mean_efficiency, found.locked


def whole_map(built: Built) -> list[xr.Dataset]:
    return [torque_of(built, number) for number in range(len(pieces(built)))]


def torque_of(built: Built, number: int) -> xr.Dataset:
    return at_torque(built, pieces(built)[number], lambda done: None)


def parts_of_one(built: Built, repeats: int) -> None:
    """Where the time of one torque goes."""
    models = built.models[0]
    design, load = built.design, built.operation.load
    known = engagement(design, load, models)
    _, speeds, degrees = map_axes(built)
    speed, degree = (jnp.asarray(x) for x in np.meshgrid(speeds[1:], degrees, indexing="ij"))
    points = Operation(jnp.full(speed.shape, load), speed, degree)
    work = {
        "contacts": lambda: contacts_at(design.mesh, known.phase),
        "ring": lambda: coupling(design.mesh.body, design.solids, known.contacts),
        "load on the pairs": lambda: shares_at(design, known.contacts, load, models, known.body),
        "balance": lambda: _balance(design, points, models, known),
        "one torque in all": lambda: torque_of(built, -1)["mean_loss"].values,
    }
    for name, part in work.items():
        part()  # compiled now if it was not
        print(f"  {name:20s} {1e3 * median(part, repeats):8.1f} ms")


def theirs(
    built: Built, known: Engagement, torques: np.ndarray, loop: Callable[..., Any]
) -> tuple[float, float, list[np.ndarray], list[np.ndarray]]:
    """Seconds for the geometry and for each torque; efficiencies there, also from the package's contacts."""
    drive = given(built)
    _, speeds, degrees = map_axes(built)
    nu = np.asarray(built.design.lubricant.kinematic_viscosity(degrees))
    tree = built.design.mesh, built.design.loaded, built.design.solids
    weight = np.asarray(known.weight)
    once, found = timed(lambda: rival.geometry(drive, np.asarray(known.phase)))
    same = package_geometry(built, known)
    places = np.arange(known.contacts.active.shape[0])
    (first,) = in_pairs(built.design.mesh, places[:, None], 0)[:, :1].T
    seconds, own, shared = [], [], []
    for torque in torques:
        every = np.asarray(_compliance(tree, known.contacts, built.terms, jnp.asarray(torque)))
        conditions = weight, float(torque), speeds[1:], nu
        inputs = drive, found, every[np.ix_(first, first)], *conditions
        took, figure = timed(lambda inputs=inputs: loop(*inputs))
        seconds.append(took)
        own.append(figure[0])
        shared.append(rival.by_point(drive, same, every, *conditions)[0])
    return once, statistics.mean(seconds), own, shared


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--torques", type=int, default=50)
    parser.add_argument("--speeds", type=int, default=20)
    parser.add_argument("--temperatures", type=int, default=10)
    parser.add_argument(
        "--subset", type=int, default=3, help="torques for which the rival is timed"
    )
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--small", action="store_true", help="few points, once, for the agreement")
    asked = parser.parse_args()
    if asked.small:
        asked.torques, asked.speeds, asked.temperatures = 2, 3, 2
        asked.subset = asked.repeats = 1
    built = the_case(asked.torques, asked.speeds, asked.temperatures)
    if not asked.small:
        groove(built, asked.repeats)
    first, _ = timed(lambda: torque_of(built, 0)["mean_loss"].values)
    print(f"map: first torque with compilation {first:.2f} s")
    start = time.process_time()
    ours = whole_map(built)[1:]  # without the torque of zero
    own = (time.process_time() - start) * asked.torques / (asked.torques + 1)
    points = asked.torques * asked.speeds * asked.temperatures
    print(f"map of {points} points: {own:.2f} s, {own / points * 1e6:.0f} us a point")
    if not asked.small:
        parts_of_one(built, asked.repeats)
    known = engagement(built.design, built.operation.load, built.models[0])
    chosen = np.unique(np.linspace(0, asked.torques - 1, asked.subset).round().astype(int))
    torques = map_axes(built)[0][1:][chosen]
    agreement, ratios = 0.0, []
    for name, loop in (("by point", rival.by_point), ("by state", rival.by_state)):
        once, each, *figures = theirs(built, known, torques, loop)
        whole = once + each * asked.torques
        ratios.append(whole / own)
        print(
            f"NumPy {name}: geometry {once:.2f} s, a torque {1e3 * each:.1f} ms, map {whole:.1f} s; "
            f"ratio {whole / own:.2f} (goal 20)"
        )
        for words, found in zip(("its", "the package's"), figures, strict=True):
            away = [
                np.abs(ours[k]["mean_efficiency"].values[0, 0, 1:] / each - 1.0).max()
                for k, each in zip(chosen, found, strict=True)
            ]
            told = ", ".join(f"{one:.1e}" for one in away)
            print(f"  efficiencies from {words} contacts differ by {told} at the torques timed")
        agreement = max(agreement, *away)
    print(
        f"benchmark strain_wave ratio={min(ratios):.3g} loop={max(ratios):.3g} "
        f"microseconds={own / points * 1e6:.3g} agreement={agreement:.2e}"
    )
    if not agreement <= AGREEMENT:
        sys.exit(f"efficiencies from the same contacts differ by more than {AGREEMENT:.0e}")


if __name__ == "__main__":
    main()
