"""A ball pressed on a plane with tamaas 2.9.0 (AGPL), in an environment of its own.

tamaas is no dependency of the package, and nothing of it is imported there. Any folder outside the
repository will do:

    python3 -m venv <folder>
    <folder>/bin/pip install tamaas==2.9.0

It has two operators: the usual one repeats the contact periodically, "dcfft" is that of two half spaces.
Both are solved by the method of Polonsky and Keer. The grid has 129 x 129 cells and is 3 radii of the
contact wide, as `benchmarks/dry_contact.py` has it; lengths are in that radius, moduli in E*.

Prints one line of JSON for each operator; `--save FILE` keeps the pressure over Hertz's for comparison.
"""

import argparse
import json
import time

import numpy as np
import tamaas

CELLS, WIDTH, TURNS = 129, 3.0, 3
LOAD, LARGEST = 4.0 / 3.0, 2.0 / np.pi
"""Of a ball with a radius of one, for a contact with a radius of one."""


def solved(operator: str, tolerance: float) -> tuple[float, np.ndarray]:
    """Processor time of a solve, and the pressure over Hertz's largest one."""
    kind = tamaas.model_type.basic_2d
    model = tamaas.ModelFactory.createModel(kind, [WIDTH, WIDTH], [CELLS, CELLS])
    model.E, model.nu = 1.0, 0.0
    x = (np.arange(CELLS) - CELLS // 2) * WIDTH / CELLS
    solver = tamaas.PolonskyKeerRey(model, -0.5 * (x[:, None] ** 2 + x**2), tolerance)
    if operator == "dcfft":
        tamaas.ModelFactory.registerNonPeriodic(model, operator)
        solver.setIntegralOperator(operator)
    begin = time.process_time()
    solver.solve(LOAD / WIDTH**2)
    return time.process_time() - begin, np.array(model.traction) / LARGEST


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--save")
    given = parser.parse_args()
    tamaas.set_log_level(tamaas.LogLevel.error)
    tamaas.initialize(1)
    for operator in ("dcfft", "periodic"):
        exact = solved(operator, 1e-14)[1]
        for tolerance in (1e-8, 1e-10):
            runs = [solved(operator, tolerance) for _ in range(TURNS)]
            seconds, pressure = min(runs, key=lambda run: run[0])
            off = float(np.abs(pressure - exact).max())
            told = {"operator": operator, "tolerance": tolerance, "seconds": seconds, "off": off}
            print(json.dumps(told | {"largest": float(pressure.max())}))
        if given.save and operator == "dcfft":
            np.save(given.save, exact)


if __name__ == "__main__":
    main()
