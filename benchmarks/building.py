"""Building designs, milliseconds each: many in one call beside one after the other, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/building.py

A thousand cylindrical pairs differ in profile shift, fifty strain wave gears in deflection; what takes
part in both ways is the whole design with its checks. Seconds are of the processor, compile time is
left out. On a shared core of a small virtual machine: spur 2.5 ms one by one and 0.008 ms of a batch,
helical 2.4 and 0.009 ms; strain wave 62 ms and 22 ms, where one by one took 215 ms before grooves were
swept in less work. One strain wave gear by itself is built by programs that compile in a third of the time.
"""

import time
from collections.abc import Callable
from typing import Any

import bench
import jax
import numpy as np

from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair, build_cylindrical_pairs
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.design_groups import Designs
from pitchpoint.gears.strain_wave.design import build_strain_wave, build_strain_waves

jax.config.update("jax_enable_x64", True)

PAIR: dict[str, Any] = {
    "teeth": (23, 61),
    "module": 2e-3,
    "pressure_angle": np.radians(20.0),
    "face_width": 18e-3,
}
WAVE: dict[str, Any] = {"teeth": (200, 202), "module": 0.3e-3, "face_width": 0.01}
SIZES = bench.sizes(__doc__, pairs=(1000, 20), waves=(50, 2), alone=(10, 2), repeats=(3, 1))


def seconds(work: Callable[[], object]) -> float:
    """Least processor time of some runs, after one that compiles."""
    work()
    found = []
    for _ in range(SIZES.repeats):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return min(found)


def compared(name: str, together: float, count: int, alone: float) -> float:
    """Milliseconds of one design alone over those of one among many, with a line of the table."""
    among, single = 1e3 * together / count, 1e3 * alone / SIZES.alone
    print(
        f"{name:12} {single:9.2f} ms alone {among:9.4f} ms of {count} {single / among:7.1f} times"
    )
    return single / among


def cylindrical(name: str, helix_angle: float) -> float:
    """Pairs that differ in profile shift."""
    count = SIZES.pairs
    shifts = np.stack([np.linspace(0.0, 0.6, count), np.full(count, -0.2)], axis=1)
    common = PAIR | {"helix_angle": helix_angle}

    def single(shift: np.ndarray) -> CylindricalPair:
        return build_cylindrical_pair(**common, profile_shift=(float(shift[0]), float(shift[1])))

    def alone() -> None:
        for shift in shifts[:: count // SIZES.alone]:
            check_cylindrical(single(shift))

    def together() -> Designs:
        return build_cylindrical_pairs(**common, profile_shift=shifts)

    agree(together(), single(shifts[0]))
    return compared(name, seconds(together), count, seconds(alone))


def strain_wave() -> float:
    """Drives that differ in deflection."""
    count = SIZES.waves
    deflections = np.linspace(0.95, 1.0, count)

    def alone() -> None:
        for deflection in deflections[:: count // SIZES.alone]:
            build_strain_wave(**WAVE, deflection=float(deflection))

    def together() -> Designs:
        return build_strain_waves(**WAVE, deflection=deflections)

    agree(together(), build_strain_wave(**WAVE, deflection=float(deflections[0])))
    return compared("strain wave", seconds(together), count, seconds(alone))


def agree(designs: Designs, alone: Any) -> None:
    """Stop where the first of many is not the design that is built alone."""
    assert designs.good.all()
    for own, other in zip(*map(jax.tree.leaves, (designs[0], alone)), strict=True):
        np.testing.assert_allclose(own, other, rtol=1e-9, atol=1e-12)


if __name__ == "__main__":
    bench.last_line(
        spur=cylindrical("spur", 0.0),
        helical=cylindrical("helical", float(np.radians(15.0))),
        strain_wave=strain_wave(),
    )
