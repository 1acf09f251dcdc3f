"""Case files of planetary sets and a 3K train."""

from pitchpoint.runs.run import load_case

TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "60 N m", "speed": "3000 rpm", "temperature": "60 degC"},
    "models": {"friction": {"name": "constant", "coefficient": 0.05}},
}
SET = {
    "family": "planetary",
    "teeth": [24, 30, 84],
    "planets": 3,
    "module": "1 mm",
    "face_width": "12 mm",
}
PLANETARY = {"gears": SET, **TABLES}


def gears(teeth, **more):
    return {"teeth": teeth, "module": "1 mm", "face_width": "10 mm", "fillet_radius": 0.2, **more}


THREE_K = {
    "stages": [
        {"bodies": ["sun", "planet"], "gears": gears([18, 36])},
        {"bodies": ["planet", "ring"], "gears": gears([36, -90])},
        {"bodies": ["planet", "output ring"], "gears": gears([34, -88])},
    ],
    "train": {"input": "sun", "output": "output ring", "held": "ring", "planets": 3},
    **TABLES,
}
STEPPED = SET | {"teeth": [18, 36], "second": {"teeth": [24, 78], "face_width": "10 mm"}}
PIN = {
    "between": ["planet", "carrier"],
    "bearing": "palmgren_1959",
    "mean_diameter": "12 mm",
    "f0": 4.0,
    "f1": 0.003,
}


def figures(tree, **settings):
    built = load_case(tree, settings={key.replace("__", "."): v for key, v in settings.items()})
    found = built.figures_of([(built.design, built.operation)], built.models[0])
    return built, {name: values[0] for name, values in found.items()}
