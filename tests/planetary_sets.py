"""Sets and pairs as stages of a drive, and each from a file of its own."""

import numpy as np

from pitchpoint.analyses.analysis import Subject
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.runs.run import load_case

SPEED, LOAD = 3000.0 * np.pi / 30.0, 40.0
TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "models": {"friction": {"name": "constant", "coefficient": 0.05}},
}
WIDTH = {"module": "1 mm", "face_width": "12 mm"}
SETS = [
    {"family": "planetary", "teeth": [24, 30, 84], "planets": 3, **WIDTH},
    {"family": "planetary", "teeth": [25, 29, 83], "planets": 4, **WIDTH},
]
PAIR = {"teeth": [23, 61], "module": "1 mm", "face_width": "12 mm"}
RATIOS = 1 + 84 / 24, 1 + 83 / 25  # by Willis, sun to carrier
RATIO_OF_PAIR = 61 / 23


def operation(torque=LOAD, speed=SPEED):
    return {"torque": f"{torque!r} N m", "speed": f"{speed!r} rad/s", "temperature": "60 degC"}


def drive(*stages, **more):
    """A drive of tables [gears], or of whole stages."""
    tables = [one if "gears" in one else {"gears": one} for one in stages]
    return load_case({"stages": tables, "operation": operation(), **TABLES, **more})


def figures(built, law=0):
    """Figures of a drive, or of a set or pair alone, at its operating point."""
    found = built.figures_of([(built.design, built.operation)], built.models[law])
    return {name: values[0] for name, values in found.items()}


def alone(gears, torque, speed, **more):
    """A stage from a file of its own."""
    return load_case({"gears": gears, "operation": operation(torque, speed), **TABLES, **more})


def by_themselves(built, gears, found):
    """Figures of each stage from a file of its own, at the mean load and the speed that it has in a drive."""
    loads = built.carried_by_meshes(found)
    each = zip(gears, loads.tolist(), found["stage_speed"].tolist(), strict=True)
    return [figures(alone(table, load, speed)) for table, load, speed in each]


def of(built, analysis):
    """A part of a drive; of stages or sets with all of them."""
    (part,) = ANALYSES[analysis].parts(Subject(None, built))
    pieces = [part.compute(built, piece, lambda *_: None) for piece in part.pieces(built)]
    return part.joined(built, pieces)
