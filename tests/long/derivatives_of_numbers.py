"""Derivatives by every number of six cases: `python tests/long/derivatives_of_numbers.py [CASE ...]`.

Each one that `gradients` gives is held against one of runs of the case, by central differences with a
step of its own. Those that lie further apart than `FAR` are listed, and for every key without a
derivative the reason.
"""

import sys
from typing import Any

import numpy as np

import pitchpoint as pp
from pitchpoint.errors import PitchpointError
from pitchpoint.runs.run import run_case

FAR = 5e-3
"""Relative distance of two derivatives that is listed, beside what solvers leave."""

STEP = 3e-4

OIL = {
    "base": "pao",
    "viscosity_40": "150 mm2/s",
    "viscosity_100": "19 mm2/s",
    "density": "850 kg/m3",
}
STEEL = {"materials": {"gear_1": "case-hardened-mq", "gear_2": "case-hardened-mq"}}
POINT = {"torque": "60 N m", "speed": "1200 rpm", "temperature": "60 degC"}
REST = {"lubricant": {"name": "pao-vg-150"}, "roughness": {"ra": "0.4 um"}, "operation": POINT}
GEARS = {"teeth": [20, 41], "module": "2 mm", "face_width": "20 mm"}
SHAFT = {"bearing_span": "100 mm", "pinion_offset": "10 mm", "pinion_shaft_diameter": "30 mm"}
FACTORS = {"life": "5000 h", "application_factor": 1.25, "transverse_load_factor": 1.1}

CASES: dict[str, Any] = {
    "spur": {
        **{**REST, "lubricant": OIL},
        "gears": {**GEARS, "profile_shift": [0.3, 0.1], "centre_distance": "61.9 mm"},
    },
    "helical": {
        **{**REST, **STEEL},
        "gears": {
            **{**GEARS, "helix_angle": "15 deg", "profile_shift": [0.3, 0.1]},
            "misalignment": "12 um",
            "modifications": {"tip_relief": ["10 um", "12 um"], "crowning": "3 um"},
        },
        "strength": {**SHAFT, **FACTORS},
    },
    "plastic": {
        **{**REST, "operation": {**POINT, "torque": "6 N m"}},
        **{"gears": GEARS, "materials": {"gear_1": "steel", "gear_2": "POM-H"}},
    },
    "strain wave": "examples/strain_wave.toml",
    "planetary": "examples/planetary.toml",
    "stages": {
        **{**REST, **STEEL},
        "stages": {
            "1": {"gears": GEARS},
            "2": {"gears": {**GEARS, "module": "3 mm", "face_width": "35 mm"}},
        },
        "strength": FACTORS,
    },
}

FIGURES = (
    *("mean_loss", "mean_efficiency", "mean_input_torque", "torque_ripple"),
    *("least_flank_safety", "least_root_safety", "largest_contact_stress", "largest_root_stress"),
    *("circumferential_backlash", "output_backlash"),
)

OF_STRENGTH = {
    "least_flank_safety": ("flank_safety", np.nanmin),
    "least_root_safety": ("root_safety", np.nanmin),
    "largest_contact_stress": ("contact_stress", np.nanmax),
    "largest_root_stress": ("root_stress", np.nanmax),
}


def figures_of_run(case: pp.Case) -> dict[str, float]:
    """Figures of a run of the case."""
    (outcome,) = run_case(case, analyses=["operation", "strength"]).values()
    point = outcome.parts["operation"]
    found = {
        name: float(point[name].values.ravel()[0])
        for name in FIGURES
        if name in point and point[name].size
    }
    if "strength" in outcome.parts:
        rating = outcome.parts["strength"]
        found |= {
            name: float(extreme(rating[of].values))
            for name, (of, extreme) in OF_STRENGTH.items()
            if np.isfinite(rating[of].values).any()
        }
    return found


def compared(name: str) -> int:
    """How many derivatives of a case are far from those of its runs."""
    case = pp.Case(CASES[name])
    tables = {}
    for of in FIGURES:
        try:
            tables[of] = pp.gradients(case, of)
        except PitchpointError as error:
            print(f"{name}: {of}: {error}")
    far, keys = 0, dict.fromkeys(key for table in tables.values() for key in table.index)
    value_of = {key: float(t.value[key]) for t in tables.values() for key in t.index}
    for key in keys:
        step = STEP * (abs(value_of[key]) or 1.0)
        ends = []
        for way in (-1.0, 1.0):
            try:
                ends.append(figures_of_run(case.set({key: value_of[key] + way * step})))
            except PitchpointError:
                ends.append({})
        for of, table in tables.items():
            if key not in table.index or any(of not in end for end in ends):
                continue
            beside = (ends[1][of] - ends[0][of]) / (2.0 * step)
            derivative = float(table.derivative[key])
            noise = 1e-8 * abs(table.attrs["value"]) / step
            if not abs(derivative - beside) <= FAR * max(abs(beside), abs(derivative)) + noise:
                far += 1
                print(f"{name}: d {of}/d {key}: {derivative:.6g}, of runs {beside:.6g}")
    without = {key: why for t in tables.values() for key, why in t.attrs["without"].items()}
    for key, why in without.items():
        print(f"{name}: {key}: {why}" + " for some" * (key in keys))
    print(
        f"{name}: {sum(len(t) for t in tables.values())} derivatives of {len(tables)} figures, {far} far"
    )
    return far


if __name__ == "__main__":
    sys.exit(sum(compared(name) for name in sys.argv[1:] or CASES))
