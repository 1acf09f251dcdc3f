"""Mesh stiffness, microseconds a point: the package beside ross-rotordynamics, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/stiffness.py --rival PYTHON

PYTHON is the interpreter of an environment with ross, as `rivals/ross_mesh_stiffness.py` makes it;
without it only the package is timed. A point is one position of the mesh: the stiffness of all
pairs in contact, with bending, shear and compression of both teeth, the bodies under them and linear
contact. The pair is the rival's, of 62/62 spur teeth. The outline of both teeth and their compliance
along the flank are computed anew in every run; the many designs differ in profile shifts and width,
and what follows from these is computed anew as well. Compile time is told apart.

The formulas are ross's too, and the beams agree to five digits. Three readings differ, and the last
lines take over ross's one by one. It counts the lever of the body's compliance to the point of
contact; the source, and the package, to where the line of the load crosses the tooth's axis. Its
width of the tooth at the root circle leaves out the tip clearance of the rack. And it moves the
contact evenly in pressure angle, from where the rack's flank ends, not evenly along the line of
action between the tips.
"""

import dataclasses
import json
import statistics
import subprocess
import time
from collections.abc import Callable
from typing import NamedTuple

import bench
import equinox as eqx
import jax
import numpy as np

from pitchpoint._jax import jnp
from pitchpoint.contact.flattening import yang_sun_1985
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.tooth_section import ToothSection, tooth_sections
from pitchpoint.loading.compliance import slice_stiffness
from pitchpoint.loading.foundation import sainsot_2004
from pitchpoint.loading.tooth_compliance import beam_compliance, interpolate, terms_of
from pitchpoint.materials.solids import Solid

jax.config.update("jax_enable_x64", True)

RIVAL = bench.RIVALS / "ross_mesh_stiffness.py"
STEEL = Solid(young=206e9, poisson=0.3, density=7810.0)
TERMS = terms_of("beam_foundation_hertz")
LOAD = jnp.asarray(100.0)
LOADED = jnp.array([0.0, 1.0])
ROOT_RADIUS, BORE_RADIUS = 59.5e-3, 17.5e-3
TOGETHER = 20
"""Designs in one step of the loop over many: what they need stays in the cache."""


def rival_pair() -> CylindricalPair:
    """The pair of the rival's own example."""
    return build_cylindrical_pair(
        teeth=(62, 62),
        module=2e-3,
        pressure_angle=float(np.radians(20.0)),
        face_width=20e-3,
        rim_ratio=(ROOT_RADIUS / BORE_RADIUS,) * 2,
    )


def total_stiffness(pair: CylindricalPair, phase: jax.Array) -> jax.Array:
    """Stiffness of the mesh along the line of action at phases of the period [N/m]."""
    contacts = pair.contacts(phase)
    each = slice_stiffness(pair, LOADED, contacts, (STEEL, STEEL), TERMS, LOAD) * contacts.weight
    return jnp.sum(jnp.where(contacts.active, each, 0.0), axis=(0, 1))


Design = tuple[jax.Array, jax.Array]
"""Profile shifts and face width."""


def designed(pair: CylindricalPair, design: Design) -> CylindricalPair:
    """The pair with other profile shifts and another width, and what follows from them."""
    shift, width = design
    return dataclasses.replace(pair, profile_shift=shift, face_width=width).completed()


@eqx.filter_jit
def stiffness_of_one(pair: CylindricalPair, phase: jax.Array) -> jax.Array:
    return total_stiffness(pair, phase)


@eqx.filter_jit
def stiffness_of_many(pair: CylindricalPair, designs: Design, phase: jax.Array) -> jax.Array:
    return jax.lax.map(
        lambda design: total_stiffness(designed(pair, design), phase), designs, batch_size=TOGETHER
    )


def random_designs(count: int) -> Design:
    rng = np.random.default_rng(0)
    shift, width = rng.uniform(0.0, 0.4, (count, 2)), rng.uniform(15e-3, 25e-3, count)
    return jnp.asarray(shift), jnp.asarray(width)


def compliance(section: ToothSection, clearance: jax.Array, reading: "Reading") -> jax.Array:
    """Compliance of tooth and body times E at the section's nodes."""
    half_thickness, height = section.flank
    angle = section.root_half_angle
    arm = height - (height[0] - jnp.sum(section.step))
    if not reading.lever:
        arm -= half_thickness * jnp.tan(section.load_angle)
    if reading.root:
        arm -= section.root_radius * (1.0 - jnp.cos(angle))
        angle -= clearance
    body = sainsot_2004(
        load_angle=section.load_angle,
        arm_ratio=arm / (2.0 * angle * section.root_radius),
        rim_ratio=section.rim_ratio,
        root_half_angle=angle,
    )
    return beam_compliance(section, STEEL.poisson) + body


def even_in_pressure_angle(pair: CylindricalPair, phase: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Flank arc lengths (member, pair, position) as ross moves the contact, and which pairs touch."""
    base, tip, angle = pair.base_radii[0], pair.tip_radii[0], pair.transverse_pressure_angle
    first = jnp.arctan(jnp.tan(angle) - pair.module / jnp.sin(angle) / base)
    last = jnp.arccos(base / tip)
    entered = phase + jnp.arange(2.0)[:, None]
    moved = (last - first) / pair.contact_ratio * entered
    flank = base * jnp.tan(jnp.stack([first + moved, last - moved])) ** 2 / 2.0
    return flank, entered <= pair.contact_ratio


def along_line_of_action(pair: CylindricalPair, phase: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Flank arc lengths (member, pair, position) and which pairs touch."""
    contacts = pair.contacts(phase)
    return contacts.flank[:, :, 0], contacts.active[:, 0]


class Reading(NamedTuple):
    """Which of ross's readings stand in for the package's."""

    lever: bool = False
    root: bool = False
    positions: bool = False


@eqx.filter_jit
def read_as(pair: CylindricalPair, phase: jax.Array, reading: Reading) -> jax.Array:
    """Stiffness of the mesh by a reading [N/m]."""
    positions = even_in_pressure_angle if reading.positions else along_line_of_action
    flank, active = positions(pair, phase)
    clearance = 2.0 * jnp.tan(pair.pressure_angle) * (pair.dedendum - pair.addendum) / pair.teeth
    teeth = sum(
        interpolate(compliance(section, missing, reading) / STEEL.young, section, arc)
        for section, missing, arc in zip(tooth_sections(pair), clearance, flank, strict=True)
    )
    young, poisson = jnp.full(2, STEEL.young), jnp.full(2, STEEL.poisson)
    each = pair.face_width / (teeth + yang_sun_1985(young=young, poisson=poisson))
    return jnp.sum(jnp.where(active, each, 0.0), axis=0)


def timed(work: Callable[[], jax.Array]) -> float:
    start = time.perf_counter()
    jax.block_until_ready(work())
    return time.perf_counter() - start


def run_rival(python: str, points: int) -> dict[str, float]:
    """What the rival prints about one run of its own, on one thread."""
    command = [python, str(RIVAL), "--points", str(points), "--repeats", "3"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    found: dict[str, float] = json.loads(done.stdout)["runs"][0]
    return found


def described(values: jax.Array, phase: np.ndarray) -> np.ndarray:
    """Mean, least and largest [N/um]."""
    return np.array([np.trapezoid(values, phase), np.min(values), np.max(values)]) / 1e6


def main() -> None:
    usual = {"positions": (61, 11), "designs": (1000, 20), "repeats": (9, 1)}
    asked = bench.sizes(__doc__, rival="ross-rotordynamics", **usual)
    pair, phase = rival_pair(), np.linspace(0.0, 1.0, asked.positions)
    many, at = random_designs(asked.designs), jnp.asarray(phase)
    own: dict[str, tuple[Callable[[], jax.Array], int]] = {
        "one pair": (lambda: stiffness_of_one(pair, at), 1),
        f"{asked.designs} designs": (lambda: stiffness_of_many(pair, many, at), asked.designs),
    }
    for name, (work, _) in own.items():
        print(f"{name}: first call with compilation {timed(work):.2f} s")
    rival = run_rival(asked.rival, asked.positions) if asked.rival else None
    points = []
    for name, (work, count) in own.items():
        seconds = statistics.median(timed(work) for _ in range(asked.repeats))
        point = seconds / count / asked.positions
        points.append(1e6 * point)
        ratio = f", ross over it {rival['seconds_per_point'] / point:.0f}" if rival else ""
        print(f"{name}: {point * 1e6:.3f} us a point{ratio} (goal 1000)")
    if rival:
        print(f"ross: {rival['seconds_per_point'] * 1e6:.0f} us a point")
    compare(pair, phase, rival)
    bench.last_line(microseconds_alone=points[0], microseconds_together=points[1])


def compare(pair: CylindricalPair, phase: np.ndarray, rival: dict[str, float] | None) -> None:
    """Print mean, least and largest stiffness by the package's readings and by ross's."""
    at = jnp.asarray(phase)
    readings = {
        "lever to the contact": Reading(lever=True),
        "width at the root": Reading(root=True),
        "positions": Reading(positions=True),
        "all three": Reading(lever=True, root=True, positions=True),
    }
    own = stiffness_of_one(pair, at)
    assert np.allclose(read_as(pair, at, Reading()), own, rtol=1e-12)
    found = {"pitchpoint": own} | {name: read_as(pair, at, r) for name, r in readings.items()}
    table = {name: described(values, phase) for name, values in found.items()}
    if rival:
        names = ("stiffness_mean", "stiffness_min", "stiffness_max")
        table["ross"] = np.array([rival[name] for name in names]) / 1e6
    print(f"\n{'stiffness [N/um]':22s}{'mean':>9s}{'least':>9s}{'largest':>9s}")
    for name, row in table.items():
        cells = "".join(f"{value:9.2f}" for value in row)
        away = "".join(f"{value:+8.2%}" for value in row / table["ross"] - 1.0) if rival else ""
        print(f"{name:22s}{cells}  {away}")
    if rival:
        close = np.allclose(table["all three"], table["ross"], rtol=0.01)
        assert close, "ross finds another stiffness"


if __name__ == "__main__":
    main()
