"""March of wear: one life curve and many drives together, beside a NumPy loop, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/wear.py

Spur pairs of 23 and 61 teeth that differ in module, width and torque wear dry by Archard's law for
three million turns; their load is shared by stiffness, and worn flanks change gaps, loads, and
curvatures averaged over each contact. The rival marches by the same method over the same contacts
and cells to the same tolerance, with splines and springs that it is given or computes once for each
pair. Seconds are of the processor; compile time is told apart. Both find the same depths.
"""

import dataclasses
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import bench
import equinox as eqx
import jax
import numpy as np
import wear_numpy as rival
from worn_together import worn_together

from pitchpoint._jax import array, jnp
from pitchpoint.contact.contacts import Contacts
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pairs
from pitchpoint.gears.design_groups import select_designs
from pitchpoint.loading.compliance import compliance
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.loading.tooth_compliance import terms_of
from pitchpoint.lubrication.lubrication_registry import ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness
from pitchpoint.wear.history import Cells, WearModel, unworn_start, wear_of_turn
from pitchpoint.wear.laws import archard_1953
from pitchpoint.wear.march import Limit, Rate, unworn_flanks, wear_step

jax.config.update("jax_enable_x64", True)

TEETH, TURNS, TOLERANCE = (23, 61), 3e6, 3e-4
CELLS, PARTS = 40, 24
AGREE = 1e-6
"""Largest difference of depths to the rival, over the largest depth."""
COEFFICIENT, HARDNESS = 2e-7, 2e9
MODELS = Models(
    friction=(),
    choice=array(0),
    parameters={},
    sharing=LOAD_SHARING["from_stiffness"],
    rolling=ROLLING_RESISTANCE["none"],
    compliance=terms_of("beam_foundation_hertz"),
)
Given = tuple[Design, Operation, WearModel]


def drives(count: int) -> Given:
    """Designs, operating points and how material goes, with an axis of drives in front."""
    rng = np.random.default_rng(0)
    module, width = rng.uniform(2e-3, 3e-3, count), rng.uniform(15e-3, 25e-3, count)
    common = {"teeth": TEETH, "pressure_angle": np.radians(20.0)}
    made = build_cylindrical_pairs(**common, module=module, face_width=width)
    (group,) = made.groups
    assert made.good.all()
    one = {"coefficient": array(COEFFICIENT), "hardness": array(HARDNESS)}
    steel, oil = solids.find("steel").build(), lubricants.find("pao-vg-220").build()
    rest = (steel, steel), oil, Roughness.from_composite_rq(0.4e-6), (one, one)

    def many(values: Any) -> Any:
        return jnp.broadcast_to(values, (count, *jnp.shape(values)))

    both, oil, rough, own = jax.tree.map(many, rest)
    driver, loaded = (many(array(end)) for end in np.eye(2))
    point = rng.uniform(30.0, 90.0, count), np.full(count, 157.0), np.full(count, 330.0)
    return (
        Design(
            jax.tree.map(jnp.asarray, group.mesh), both, oil, rough, driver=driver, loaded=loaded
        ),
        Operation(*map(jnp.asarray, point)),
        WearModel(archard_1953, own),
    )


def of(given: Given, number: int) -> Given:
    """One of the drives."""
    found: Given = jax.tree.map(array, select_designs(given, number))
    return found


@eqx.filter_jit
def springs_of(design: Design, operation: Operation, contacts: Contacts) -> jax.Array:
    """Compliance of each pair of teeth."""
    given = design.mesh, design.loaded, contacts, design.solids, MODELS.compliance
    return compliance(*given, operation.load).of_teeth(contacts)


def as_rival(given: Given) -> rival.Pair:
    """A drive as plain numbers."""
    design, operation, _ = given
    start, cells = unworn_start(design, operation, MODELS, parts=PARTS, count=CELLS)
    mesh, contacts = design.mesh, start.contacts
    springs = springs_of(design, operation, contacts)
    speed = np.einsum("kdpsn,d->kpn", contacts.surface, design.motion)
    arm = float(np.abs(np.einsum("dpsn,d->psn", contacts.normal, design.loaded)).max())
    return rival.Pair(
        weight=np.asarray(start.weight),
        active=np.asarray(contacts.active[:, 0]),
        flank=np.broadcast_to(contacts.flank, (2, *contacts.path.shape))[:, :, 0],
        speed=speed,
        curvature=np.asarray(contacts.relative_curvature[0][:, 0]),
        springs=np.asarray(springs[:, 0]),
        width=float(mesh.face_width),
        force=float(operation.load) / arm,
        modulus=float(design.modulus),
        teeth=TEETH,
        rate=(COEFFICIENT / HARDNESS,) * 2,
        ends=np.asarray(cells.flank),
        cells=CELLS,
    )


def alone(cells: Cells) -> Cells:
    """Cells without places under the contacts, whose depths the rival does not hold."""
    return dataclasses.replace(cells, places=0, nearest=None)


def curve(given: Given) -> np.ndarray:
    """Depths of one drive over its life, step by step as a case does but for places under its contacts."""
    design, operation, wear = given
    start, cells = unworn_start(design, operation, MODELS, parts=PARTS, count=CELLS)
    cells = alone(cells)

    def rate(depth: np.ndarray) -> Rate:
        return Rate.of(wear_of_turn(design, operation, MODELS, wear, cells, start, array(depth)))

    state = unworn_flanks(rate, cells.shape)
    first = state.rate.pressure
    while not state.end:
        state = wear_step(state, rate, Limit(TURNS), start=first, tolerance=TOLERANCE)
    return state.depth[..., 0]


def seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    jax.block_until_ready(work())
    return time.process_time() - start


def main() -> None:
    asked = bench.sizes(__doc__, drives=(1000, 2), repeats=(3, 1))
    count = asked.drives
    given = drives(count)
    pairs = [as_rival(of(given, number)) for number in range(count)]
    _, cells = unworn_start(*of(given, 0)[:2], MODELS, parts=PARTS, count=CELLS)
    cells = alone(cells)
    limits = jnp.full(count, TURNS), jnp.full(count, jnp.inf), array(TOLERANCE)

    def together() -> Any:
        return worn_together(given, MODELS, cells, PARTS, *limits)

    def loop(number: int) -> list[rival.Course]:
        return rival.march_all(pairs[:number], turns=TURNS, tolerance=TOLERANCE)

    work = {
        "one life curve": (lambda: curve(of(given, 0)), lambda: loop(1), 1),
        f"{count} drives": (together, lambda: loop(count), count),
    }
    for name, (own, *_) in work.items():
        print(f"{name}: first call with compilation {seconds(own):.1f} s")
    found, theirs = together(), loop(count)
    depth = np.stack([one.depth for one in theirs])
    apart = np.abs(np.asarray(found.depth[..., 0]) - depth).max(axis=(1, 2)) / depth.max(
        axis=(1, 2)
    )
    steps = np.array([one.steps for one in theirs])
    print(
        f"agreement: depths {apart.max():.1e} of the largest, steps {steps.min()} to {steps.max()}"
    )
    assert apart.max() < AGREE, "the rival finds other depths"
    print(
        f"steps together {found.steps.min()} to {found.steps.max()}, all found {bool(found.found.all())}"
    )
    ratios = []
    for name, (own, other, number) in work.items():
        both = [(seconds(own), seconds(other)) for _ in range(asked.repeats)]
        ours, loops = (1e3 * statistics.median(one) / number for one in zip(*both, strict=True))
        print(
            f"{name}: {ours:.2f} ms each, NumPy {loops:.2f} ms, ratio {loops / ours:.1f} (goal 15)"
        )
        ratios.append(loops / ours)
    bench.last_line(alone=ratios[0], together=ratios[1])


if __name__ == "__main__":
    main()
