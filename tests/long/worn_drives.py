"""Torus pair and strain wave gear of the examples: worn, and what their analyses say of them afterwards.

    .venv/bin/python tests/long/worn_drives.py [torus | strain_wave]

Prints backlash, transmission error, stiffness and kinematic error with flanks as new, worn by one turn, by
some and by all, and ends with an error if one turn changes anything or all of them do not.
"""

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.runs.run import run_case

EXAMPLES = Path(__file__).parents[2] / "examples"
SHARED = {"models.load_sharing": "from_stiffness"}
DRY = {
    "wear.law": "archard_1953",
    "wear.coefficient": 1e-7,
    "wear.hardness": "700 HV",
}
ASKED: dict[str, dict[str, Any]] = {
    "torus": {"wear.cycles": 1e7, "wear.cells": 16, "wear.phases": 8},
    "strain_wave": {"wear.cycles": 1e6, "wear.cells": 12, "wear.phases": 4},
}
AFTERWARDS = ("torsion", "kinematic_error", "stiffness")


def figures(case: str, settings: dict[str, Any]) -> dict[str, float]:
    """What is looked at of a drive, by name."""
    (outcome,) = run_case(case, settings=SHARED | settings).values()
    torsion = outcome.parts["torsion"]
    rated = torsion.isel(torque=torsion.sizes["torque"] // 2)
    found = {
        "backlash [rad]": torsion["kinematic_play"],
        "transmission error, peak to peak [rad]": rated["angular_transmission_error_range"],
        "torsional stiffness [N m/rad]": rated["torsional_stiffness"],
    }
    if "kinematic_error" in outcome.parts:
        ranges = outcome.parts["kinematic_error"]["kinematic_error_range"]
        found["kinematic error under load [rad]"] = ranges.sel(curve="under load", cause="both")
    return {name: float(value) for name, value in found.items()}


def main(name: str) -> bool:
    """Wear a drive and compare; True if something is wrong."""
    case, asked = str(EXAMPLES / f"{name}.toml"), ASKED[name]
    every = dict(ANALYSES._entries)
    with tempfile.TemporaryDirectory() as folder:
        ANALYSES._entries = {"wear": every["wear"]}
        began = time.monotonic()
        (outcome,) = run_case(case, folder=folder, settings=SHARED | DRY | asked).values()
        data = outcome.parts["wear"]
        print(
            f"{name}: {data.sizes['step'] - 1} steps in {time.monotonic() - began:.0f} s, "
            f"{1e6 * float(data['final_depth']):.3g} um deep"
        )
        ANALYSES._entries = {one: every[one] for one in AFTERWARDS}
        file = {"worn.file": str(Path(folder) / "default" / "wear.nc")}
        turns = [1.0, 0.1 * asked["wear.cycles"], asked["wear.cycles"]]
        each = [figures(case, file | {"worn.cycles": one}) for one in turns]
        each.insert(0, figures(case, {}))
        ANALYSES._entries = every
    wrong = not np.isfinite([[*one.values()] for one in each]).all()
    for what in each[0]:
        values = [one[what] for one in each]
        same = bool(np.isclose(values[1], values[0], rtol=1e-6, atol=1e-9))
        moved = bool(abs(values[3] / values[0] - 1.0) > 1e-4)
        wrong |= not (same and moved)
        print(f"    {what:40s}" + "".join(f"{value:14.7g}" for value in values))
    members = np.abs(data["worn_volume"].values[-1])
    print(f"    volumes of gear 1 over gear 2: {members[0] / members[1]:.6f}")
    return wrong | (not each[3]["backlash [rad]"] > each[0]["backlash [rad]"])


if __name__ == "__main__":
    sys.exit(int(any([main(name) for name in sys.argv[1:] or ASKED])))
