"""The evaluator of a loss map at many points: Python and C beside SciPy's regular grids, on one thread.

    taskset -c 0 .venv/bin/python benchmarks/evaluator.py

A map of 57 torques, 23 speeds and 7 temperatures, as a drive with its usual settings has it, at random points
in all quadrants. The rival looks the torque that is lost up by `RegularGridInterpolator` over torque,
logarithm of the speed and temperature, and makes loss and torque of the driver of it, as its user would. C is
the batch call of the exported header, built by `cc -O2`. Times are those of the processor, the least of some.
"""

import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bench
import numpy as np
from scipy.interpolate import RegularGridInterpolator

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from made_joints import made_joint

from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports.evaluator import header

SIZES = bench.sizes(__doc__, points=(1_000_000, 10_000), turns=(7, 1))
AGREE = 1e-12
TIMED = """#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "loss_table.h"
int main(int count, char **arguments)
{
    const int n = atoi(arguments[1]), turns = atoi(arguments[2]);
    double *in = malloc(3 * n * sizeof(double)), best = 1e9;
    struct loss_table_point *out = malloc(n * sizeof *out);
    if (count != 3 || fread(in, sizeof(double), 3 * n, stdin) != (size_t)(3 * n))
        return 1;
    for (int k = 0; k < turns; ++k) {
        const clock_t start = clock();
        loss_table_at_many(n, in, in + n, in + 2 * n, 0, out);
        const double took = (double)(clock() - start) / CLOCKS_PER_SEC;
        best = took < best ? took : best;
    }
    fprintf(stderr, "%.9g", best);
    for (int k = 0; k < n; ++k)
        fwrite(&out[k].input_torque, sizeof(double), 1, stdout);
    return 0;
}
"""


def table() -> LossTable:
    """Losses by powers of load and speed."""
    torques, speeds = np.geomspace(2.0, 450.0, 28), np.geomspace(0.01, 24.0, 22)
    both, degrees = np.concatenate([-torques[::-1], [0.0], torques]), np.linspace(40.0, 80.0, 7)
    load, speed, warm = np.meshgrid(both, [0.0, *speeds], degrees, indexing="ij")
    lost = 2.0 + 0.02 * np.abs(load) ** 1.2 * np.maximum(speed, 0.01) ** -0.2 * (warm / 40.0) ** 0.1
    axes = tuple(both.tolist()), (0.0, *speeds.tolist()), tuple(degrees.tolist())
    return LossTable(*axes, {"made": lost.tolist()}, 0.1)


def least(action: Callable[[], Any]) -> tuple[float, Any]:
    """Nanoseconds a point, and the result."""
    times = []
    for _ in range(SIZES.turns):
        begin = time.process_time()
        found = action()
        times.append(time.process_time() - begin)
    return min(times) / SIZES.points * 1e9, found


def in_c(made: LossTable, points: np.ndarray) -> tuple[float, np.ndarray]:
    """The same of the exported header."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        (place / "loss_table.h").write_text(header(made_joint(), made), "utf-8")
        (place / "timed.c").write_text(TIMED, "utf-8")
        build = ["cc", "-std=c99", "-O2", "timed.c", "-o", "timed", "-lm"]
        subprocess.run(build, cwd=place, check=True)
        asked = [str(place / "timed"), str(SIZES.points), str(SIZES.turns)]
        done = subprocess.run(asked, input=points.tobytes(), capture_output=True, check=True)
    return float(done.stderr) / SIZES.points * 1e9, np.frombuffer(done.stdout)


def main() -> None:
    made, random = table(), np.random.default_rng(1)
    ends = np.array([made.torques[-1], made.speeds[-1], 20.0])[:, None]
    points = random.uniform(-1.0, 1.0, (3, SIZES.points)) * ends + [[0.0], [0.0], [60.0]]
    moving = np.array(made.loss_torques["made"])[:, 1:]
    axes = made.torques, np.log(made.speeds[1:]), made.temperatures
    grid = RegularGridInterpolator(axes, moving)

    def rival() -> np.ndarray:
        torque, speed, warm = points
        sign, pace = np.sign(speed), np.maximum(np.abs(speed), made.speeds[1])
        lost = grid(np.stack([sign * torque, np.log(pace), warm], axis=-1))
        return sign * (sign * torque + lost) * made.speed_ratio

    python, found = least(lambda: made.at_many(*points).input_torque)
    scipy, theirs = least(rival)
    figures = {"python": python, "scipy": scipy}
    others = [theirs]
    if shutil.which("cc"):
        figures["c"], of_c = in_c(made, points)
        others.append(of_c)
    for other in others:
        assert np.abs(found - other).max() < AGREE * np.abs(found).max(), "it finds other torques"
    print(", ".join(f"{name} {value:.1f} ns a point" for name, value in figures.items()))
    bench.last_line(**figures, ratio=scipy / python)


if __name__ == "__main__":
    main()
