"""A duty cycle of a million samples: energies of a loss map, by a motor, with two laws, with heat.

    .venv/bin/python benchmarks/duty_cycle.py

The rival is the plain loop of a reader over the evaluator that the export hands over, a sample at a time, on
a part of the samples; both have to lose the same energy to 1e-9. Seconds are of the processor, the least of
some turns.
"""

import time
from collections.abc import Callable

import bench
import numpy as np

from pitchpoint.duty_cycle.duty_dataset import Heating, duty_dataset
from pitchpoint.duty_cycle.history import load_history
from pitchpoint.duty_cycle.motor import Motor
from pitchpoint.duty_cycle.thermal_network import ThermalNetwork
from pitchpoint.efficiency.loss_table import LossTable

SIZES = bench.sizes(__doc__, samples=(1_000_000, 20_000), turns=(3, 1), slow=(20_000, 2_000))
WARM = 313.15
MOTOR = Motor(torque_constant=0.1, resistance=0.05, inertia=1e-5)


def table() -> LossTable:
    """Of the size of a map of four quadrants: 33 torques, 11 speeds, 3 temperatures."""
    torques, degrees = np.linspace(-40.0, 40.0, 33), np.array([20.0, 40.0, 60.0])
    speeds = np.array([0.0, *np.geomspace(0.01, 10.0, 10)])
    base = 0.02 * np.abs(torques)[:, None, None] + 1.0 / (1.0 + speeds[:, None]) + 20.0 / degrees
    laws = {"own": base.tolist(), "other": (1.5 * base).tolist()}
    return LossTable(torques.tolist(), speeds.tolist(), degrees.tolist(), laws, 0.02)


def least(work: Callable[[], object]) -> float:
    """Processor time of the quickest turn [s]."""
    spent = []
    for _ in range(SIZES.turns):
        begun = time.process_time()
        work()
        spent.append(time.process_time() - begun)
    return min(spent)


def main() -> None:
    """Times each kind of cycle, and holds energy against the loop."""
    of, time_axis = table(), np.linspace(0.0, 100.0, SIZES.samples)
    torque, speed = 20.0 + 8.0 * np.cos(time_axis), 5.0 * np.sin(time_axis) ** 3
    cycle = load_history(time_axis, torque, speed, WARM)
    network = ThermalNetwork(
        {"gears": 400.0, "winding": 60.0},
        {("winding", "gears"): 0.6, ("gears", "ambient"): 0.5},
    )
    heating = Heating(network, gears="gears", motor="winding")
    seconds = {
        "one_law": least(lambda: duty_dataset(of, cycle, law="own")),
        "two_laws": least(lambda: duty_dataset(of, cycle)),
        "motor": least(lambda: duty_dataset(of, cycle, law="own", motor=MOTOR)),
        "heat": least(lambda: duty_dataset(of, cycle, law="own", motor=MOTOR, heating=heating)),
    }
    part = slice(0, SIZES.slow)
    begun = time.process_time()
    lost = sum(
        seconds_ * of.at(load, pace, WARM - 273.15, "own").loss
        for seconds_, load, pace in zip(
            cycle.duration[part].tolist(), torque[part].tolist(), speed[part].tolist(), strict=True
        )
    )
    loop = (time.process_time() - begun) / SIZES.slow * SIZES.samples
    whole = duty_dataset(of, cycle, law="own")
    ours = float(cycle.duration[part] @ whole["loss"].values[part])
    off = abs(ours / lost - 1.0)
    for name, spent in seconds.items():
        print(f"{SIZES.samples} samples, {name.replace('_', ' ')}: {spent:.2f} s")
    times = loop / seconds["one_law"]
    print(f"a loop over the evaluator: {loop:.1f} s, {times:.0f} times as long; off {off:.0e}")
    assert off < 1e-9, "the loop loses another energy"
    bench.last_line(**seconds, times_of_loop=times)


if __name__ == "__main__":
    main()
