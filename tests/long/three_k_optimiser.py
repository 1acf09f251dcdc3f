"""From uncorrected teeth to 3K sets of ratio 90 to 110 that run well both ways, in a minute; by contacts too.

    .venv/bin/python tests/long/three_k_optimiser.py [sets]

Constant friction of 0.1, contact ratios of at least 1.1, three planets at equal angles, every pair built as
any other is. Prints processor time, how many points a second are compared, the best set without profile
shift, and of the best sets the closed forms beside all contacts, both ways. Ends with an error where it takes
more than a minute, a set is below 85 % either way, or contacts lose other than closed forms by more than 2 %.
"""

import sys
import time
from typing import Any

import numpy as np

import pitchpoint as pp
from pitchpoint.sizing import three_k

RATIOS, FRICTION, CONTACT_RATIO = (90.0, 110.0), 0.1, 1.1
LONGEST, LEAST, AGREES = 60.0, 0.85, 0.02
WAYS = {"operation": "efficiency", "back_driving": "back_driving_efficiency"}


def uncorrected() -> tuple[list[int], float]:
    """Teeth of the best set without profile shift, and its worse efficiency, if it could be made."""
    task = three_k._Task(RATIOS, 3, FRICTION, CONTACT_RATIO, (12, 60), (15, 60), 150)
    teeth = np.concatenate([*three_k._teeth(task)])
    teeth = teeth[(teeth[:, 2] == teeth[:, 0] + 2 * teeth[:, 1])]
    teeth = teeth[teeth[:, 4] - teeth[:, 3] == teeth[:, 0] + teeth[:, 1]].astype(float)
    none, z = np.zeros(len(teeth)), [*teeth.T]
    meshes = three_k._three_meshes(z, (z[0] + z[1]) / 2.0, none, none)
    each = np.stack([one.efficiency(FRICTION) for one in meshes], axis=-1)
    worse = np.minimum(*three_k.three_k_efficiencies(teeth, each))
    best = int(np.argmax(worse))
    return teeth[best].astype(int).tolist(), float(worse[best])


def by_contacts(chosen: Any) -> list[float]:
    """Efficiencies of a set from all of its contacts, both ways."""
    case = pp.Case(
        lubricant={"name": "pao-vg-150"},
        roughness={"ra": "0.4 um"},
        operation={"torque": "20 N m", "speed": "3000 rpm", "temperature": "60 degC"},
        models={"friction": {"name": "constant", "coefficient": FRICTION}},
        **pp.three_k_tables(chosen, "0.5 mm", "8 mm"),
    )
    result = pp.run(case, analyses=[*WAYS])
    return [float(result.dataset(part)["mean_efficiency"].item()) for part in WAYS]


def main(count: int) -> int:
    """Number of faults."""
    teeth, worse = uncorrected()
    print(f"without profile shift: {teeth}, worse way {100.0 * worse:.2f} %")
    start = time.process_time()
    sets = pp.three_k_sets(RATIOS, friction=FRICTION, contact_ratio=CONTACT_RATIO, count=count)
    taken = time.process_time() - start
    points = sets.attrs["compared"] * three_k._ANGLES.size * three_k._SHIFTS.size**2
    print(f"{taken:.2f} s of the processor, {points / taken / 1e6:.1f} million points a second")
    faults = int(taken > LONGEST)
    for number in range(sets.sizes["set"]):
        chosen = sets.isel(set=number)
        closed, contacts = [chosen[name].item() for name in WAYS.values()], by_contacts(chosen)
        apart = [(1.0 - a) / (1.0 - b) - 1.0 for a, b in zip(contacts, closed, strict=True)]
        both = zip(closed, contacts, strict=True)
        print(
            chosen["teeth"].values.tolist(),
            f"ratio {chosen['ratio'].item():.6g}",
            *(f"{100.0 * a:.2f} %, contacts {100.0 * b:.2f} %" for a, b in both),
            f"losses apart by {100.0 * max(map(abs, apart)):.2f} %",
        )
        faults += min(*closed, *contacts) < LEAST or max(map(abs, apart)) > AGREES
    return faults


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 3))
