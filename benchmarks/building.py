"""Building designs, milliseconds each: many in one call beside one after the other, on one thread.

    OPENBLAS_NUM_THREADS=1 taskset -c 0 .venv/bin/python benchmarks/building.py

A thousand cylindrical pairs differ in profile shift, fifty strain wave gears in deflection; what takes
part in both ways is the whole design with its checks. Seconds are of the processor, compile time is
left out. On a shared core of a small virtual machine: spur 2.5 ms one by one and 0.008 ms of a batch,
helical 2.4 and 0.009 ms; strain wave 62 ms and 22 ms, where one by one took 215 ms before grooves were
swept in less work. One strain wave gear by itself is built by programs that compile in a third of the time.
"""

import os
import time
from collections.abc import Callable
from typing import Any

os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"
import numpy as np

from pitchpoint.gears.cylindrical.checks import check_cylindrical
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair, build_cylindrical_pairs
from pitchpoint.gears.strain_wave.design import build_strain_wave, build_strain_waves

PAIR: dict[str, Any] = {
    "teeth": (23, 61),
    "module": 2e-3,
    "pressure_angle": np.radians(20.0),
    "face_width": 18e-3,
}
WAVE: dict[str, Any] = {"teeth": (200, 202), "module": 0.3e-3, "face_width": 0.01}
PAIRS, WAVES, ALONE = 1000, 50, 10
REPEATS = 3


def seconds(work: Callable[[], object]) -> float:
    """Least processor time of some runs, after one that compiles."""
    work()
    found = []
    for _ in range(REPEATS):
        start = time.process_time()
        work()
        found.append(time.process_time() - start)
    return min(found)


def told(name: str, together: float, count: int, alone: float) -> None:
    """One line of the table."""
    each, one = 1e3 * together / count, 1e3 * alone / ALONE
    print(f"{name:12} {one:9.2f} ms alone {each:9.4f} ms of {count} {one / each:7.1f} times")


def cylindrical(name: str, helix_angle: float) -> None:
    """Pairs that differ in profile shift."""
    shifts = np.stack([np.linspace(0.0, 0.6, PAIRS), np.full(PAIRS, -0.2)], axis=1)
    common = PAIR | {"helix_angle": helix_angle}

    def alone() -> None:
        for first, second in shifts[:: PAIRS // ALONE]:
            check_cylindrical(
                build_cylindrical_pair(**common, profile_shift=(float(first), float(second)))
            )

    together = seconds(lambda: build_cylindrical_pairs(**common, profile_shift=shifts))
    told(name, together, PAIRS, seconds(alone))


def strain_wave() -> None:
    """Drives that differ in deflection."""
    deflections = np.linspace(0.95, 1.0, WAVES)

    def alone() -> None:
        for deflection in deflections[:: WAVES // ALONE]:
            build_strain_wave(**WAVE, deflection=float(deflection))

    together = seconds(lambda: build_strain_waves(**WAVE, deflection=deflections))
    told("strain wave", together, WAVES, seconds(alone))


if __name__ == "__main__":
    cylindrical("spur", 0.0)
    cylindrical("helical", float(np.radians(15.0)))
    strain_wave()
