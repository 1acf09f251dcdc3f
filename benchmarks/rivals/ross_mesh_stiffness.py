"""Mesh stiffness over one mesh period with ross-rotordynamics 2.3.0, timed as its user gets it.

ross stays out of the package's dependencies: it runs in an environment of its own, which this
makes (any folder outside the repository will do):

    uv venv <folder>
    uv pip install --python <folder>/bin/python 'ross-rotordynamics==2.3.0' 'plotly<7'
    OPENBLAS_NUM_THREADS=1 <folder>/bin/python benchmarks/rivals/ross_mesh_stiffness.py

The pair is the one of the library's own example and tests: 62/62 spur teeth, module 2 mm, 20 deg,
width 20 mm, bore 35 mm, steel. `Mesh(driving, driven)` tabulates the stiffness of a mesh period of
1000 points while it is built, and `Mesh.get_stiffness_for_mesh_period(n_points=...)` is the public
way to any other number of points; both loop over the points in Python with six quadratures for each
tooth. Nothing public is faster: `Mesh.interpolate_stiffness` only reads the table. The method is
what is timed, so building the gears and the library's table is not charged to it.

What ross computes: bending, shear and axial compliance (potential energy, fillet included), fillet
foundation (Sainsot, Velex and Duverger 2004) and a constant Hertzian stiffness, each pair of teeth
on its own. Contact starts at phase 0 of the period; both ends of the period are in the points.

Prints one line of JSON; what the libraries say on import goes to the standard error stream.
"""

import argparse
import contextlib
import json
import os
import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

YOUNG, POISSON, DENSITY = 206e9, 0.3, 7810.0
PAIR = {
    "module": 2e-3,
    "n_teeth": 62,
    "width": 20e-3,
    "bore_diameter": 35e-3,
    "pr_angle": float(np.radians(20.0)),
}


@contextlib.contextmanager
def _quiet_output() -> Iterator[None]:
    """Send file descriptor 1 to the error stream: compiled libraries write to it directly."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(2, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


def build_mesh() -> Any:
    """Mesh of two equal steel gears; its construction fills the library's table once."""
    from ross import Material
    from ross.gear_element import GearElementTVMS, Mesh

    steel = Material("steel_206", rho=DENSITY, E=YOUNG, Poisson=POISSON)
    driving, driven = (GearElementTVMS(n=node, material=steel, **PAIR) for node in (0, 1))
    return Mesh(driving, driven)


def timed(mesh: Any, points: int, repeats: int) -> dict[str, float]:
    """Best seconds per point of several runs, and the stiffness that came out [N/m]."""
    seconds = []
    for _ in range(repeats):
        start = time.perf_counter()
        phase, stiffness = mesh.get_stiffness_for_mesh_period(n_points=points)
        seconds.append(time.perf_counter() - start)
    values = np.asarray(stiffness)
    return {
        "points": points,
        "seconds_per_point": min(seconds) / points,
        "stiffness_mean": float(np.trapezoid(values, phase) / (phase[-1] - phase[0])),
        "stiffness_min": float(values.min()),
        "stiffness_max": float(values.max()),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, nargs="+", default=[1000, 61])
    parser.add_argument("--repeats", type=int, default=5)
    asked = parser.parse_args()
    with _quiet_output():
        mesh = build_mesh()
        runs = [timed(mesh, points, asked.repeats) for points in asked.points]
    pair = PAIR | {"young": YOUNG, "poisson": POISSON, "contact_ratio": float(mesh.contact_ratio)}
    print(json.dumps({"library": "ross-rotordynamics 2.3.0", "pair": pair, "runs": runs}))


if __name__ == "__main__":
    main()
