"""Every way in which a case file or a command line can be wrong gets one clear sentence.

The broken case files are made by walking the schema: a field that is added to it is tested here
by itself, or fails `test_the_walk_reaches_every_table`.
"""

import copy
import datetime
import json
import math
import os
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

import numpy as np
import pytest
from pydantic import BaseModel, BeforeValidator
from sound import PAIR, quick_first

from pitchpoint import cli, units
from pitchpoint.cases import schema
from pitchpoint.cases.document import resolve
from pitchpoint.cases.laws import FRICTION
from pitchpoint.cases.variant import Variant
from pitchpoint.cases.worn import gears_digest
from pitchpoint.duty_cycle import table as duty_table
from pitchpoint.errors import InputError
from pitchpoint.gears import planetary
from pitchpoint.gears import table as every
from pitchpoint.gears.ball_on_disc import table as ball_on_disc
from pitchpoint.gears.cylindrical import table as cylindrical
from pitchpoint.gears.rack_and_pinion import table as rack_and_pinion
from pitchpoint.gears.strain_wave import table as strain_wave
from pitchpoint.gears.table import MODULE
from pitchpoint.gears.torus import table as torus
from pitchpoint.input.quantities import Pair, Quantity
from pitchpoint.input.tables import Table, tag
from pitchpoint.lubrication.conditions import arguments
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.zhao2022 import table as wear_table
from pitchpoint.published.zhao2022.table import ConjugateWear, FlankWear
from pitchpoint.results.store import dataset, save
from pitchpoint.runs.jobs import jobs

BASE = tomllib.loads("""
title = "a title"
summary = "a summary"
source = "liu_xiong_2017"

[gears]
family = "cylindrical"
teeth = [23, 61]
module = "2 mm"
face_width = "20 mm"

[gears.modifications]
tip_relief = "2 um"
root_relief = "1 um"
end_relief = "3 um"

[gears.deviations]
gear_1 = [{ order = 1, amplitude = "5 um", phase = "30 deg" }]
gear_2 = [{ order = 2, amplitude = "3 um" }]
iso_class = 6

[gears.inspection]
upper_thickness_allowance = ["-40 um", "-50 um"]
lower_thickness_allowance = ["-70 um", "-90 um"]
span_teeth = [3, 7]
ball_diameter = "3.5 mm"

[materials]
gear_1 = { young = "206 GPa", poisson = 0.3, density = "7830 kg/m3" }
gear_2 = { young = "206 GPa", poisson = 0.3, density = "7830 kg/m3" }

[lubricant]
base = "mineral"
viscosity_40 = "220 mm2/s"
viscosity_100 = "19 mm2/s"

[roughness]
ra = "0.4 um"

[operation]
torque = "50 N m"
speed = "1500 rpm"
temperature = "60 degC"
driver = "gear 1"

[models]
friction = [{ name = "constant", coefficient = 0.05 }, "xu_2007"]

[housing]
thermal_resistance = "0.06 K m2/W"
area = "0.05 m2"

[losses.seal]
between = ["gear 1", "housing"]
seal_torque = "0.1 N m"

[dynamics]
damping_ratio = 0.1
backlash = "50 um"
inertia = ["1 kg cm2", "20 kg cm2"]
torques = ["40 N m", "50 N m"]
speeds = { start = "500 rpm", stop = "3000 rpm", count = 3 }

[[dynamics.profile_error]]
order = 1
amplitude = "2 um"
phase = "0 deg"

[dynamics.motion]
bearing_stiffness = "300 N/um"
bearing_damping = "1000 N s/m"
mass = ["0.5 kg", "1.6 kg"]
mesh_damping = "800 N s/m"
pair_path = [0.0, 2.0]
pair_stiffness = ["300 N/um", "290 N/um"]
prescribed_speed = false
stall_torque = "100 N m"
no_load_speed = "2000 rpm"
cycles = 1
start_up = { duration = "10 ms", rise = "1 ms", speed = "10 rpm", count = 50 }

[film]
solver = "line"
phases = 9
in_series = false
nodes = 65
viscosity_law = "roelands_1966"
density_law = "dowson_higginson_1966"
shear_law = "ree_eyring_1955"
eyring_stress = "5 MPa"
asperities = "greenwood_tripp_1970"
eta_beta_sigma = 0.05
sigma_over_beta = 0.01
pattern = 1.0
boundary_friction = 0.1
inlet = "5 mm"

[wear]
law = "archard_1953"
cycles = 1e6
coefficient = 1e-6
hardness = ["200 HV", "1.9 GPa"]
profile = "kept"
load_ratio = "formula"
depth_limit = "20 um"
pressure_limit = 2.0
tip_land_limit = "0.1 mm"
backlash_limit = "30 um"
severe_by = "pressure"
cells = 20
phases = 8
tolerance = 1e-3

[strength]
application_factor = 1.25
dynamic_factor = 1.1
face_load_factor = 1.3
transverse_load_factor = 1.1
root_face_load_factor = 1.2
root_transverse_load_factor = 1.1
accuracy_class = 6
profile_correction = 1.0
life = "20000 h"
sigma_hlim = "1500 MPa"
sigma_flim = ["500 MPa", "460 MPa"]
treatment = "case_hardened"
work_hardening = 1.0
mean_stress_factor = 0.7
flank_roughness = "3 um"
root_roughness = ["10 um", "16 um"]

[studies.scan]
title = "a sweep"
sweep = { key = "gears.module", start = "1.9 mm", stop = "2.1 mm", count = 2 }

[studies.list]
sweep = { key = "gears.module", values = ["2 mm"] }

[studies.list.change.operation]
torque = "40 N m"

[study]
over = { "operation.torque" = ["20 N m", "60 N m"] }
how = "sobol"
n = 16
seed = 1
tolerances = "normal"
folder = "many"
piece = 8
workers = 2

[optimise]
vary = { "operation.torque" = "20 N m:60 N m" }
minimise = "mean_loss"
maximise = ""
subject_to = ["contact_ratio >= 1.2"]
law = "constant"
starts = 4
folder = "best"

[loss_map]
temperatures = ["60 degC"]

[output]
units = { angle = "arcmin" }

[formulas]
form = "motion"
bearing_stiffness = "2190 N/um"
bearing_damping = 0.001
mesh_damping = 0.005
error = "10 um"
mesh_cycles = 3.2
radius_factor = 1.6
roughness = "1.2 um"
torus_roll = ["1 deg", "4 deg", "8 deg", "12 deg", "16 deg"]
torus_stiffness = ["110 N/um", "140 N/um", "160 N/um", "160 N/um", "140 N/um"]
standard_roll = ["1 deg", "4 deg", "8 deg", "12 deg", "16 deg"]
standard_stiffness = ["110 N/um", "140 N/um", "160 N/um", "160 N/um", "140 N/um"]
standard_scale = 0.9

[[targets]]
quantity = "contact ratio"
where = "Table 1"
kind = "predicted"
printed = 1.6
study = "scan"
variable = "contact_ratio"
law = [0]

[[issues]]
where = "Table 1"
issue = "a misprint"
verdict = "corrected"
""")

STRAIN_WAVE = {key: BASE[key] for key in ("lubricant", "roughness")} | tomllib.loads("""
source = "xu_2021"

[gears]
family = "strain_wave"
teeth = [200, 202]
module = "0.3 mm"
face_width = "10 mm"
fixed = "circular spline"
slopes = ["10 N m", "35 N m"]

[gears.tooth]
form = "double arc"
set = "liu"

[gears.wave_generator]
weights = [1.0, -0.02]

[gears.wave_generator.bearing]
balls = 23

[gears.flexspline]
rim_thickness = "0.6 mm"

[gears.yielding]
bolts = 8

[gears.circular_spline]
form = "conjugate"

[gears.limits]
bending_concentration = 1.5
endurance_limit = "450 MPa"
tensile_strength = "1100 MPa"
ratcheting_torque = "500 N m"
catalogue_diameter = "62 mm"
rated_torque = "67 N m"
rated_speed = "2000 rpm"
rated_life = "7000 h"

[gears.deviations]
flexspline = [{ order = 1, amplitude = "5 um", phase = "30 deg" }]
circular_spline = [{ order = 2, amplitude = "3 um" }]

[operation]
torque = "50 N m"
speed = "1500 rpm"
temperature = "60 degC"
driver = "wave generator"

[losses.bearing]
between = ["wave generator", "flexspline"]
bearing = "palmgren_1959"
mean_diameter = "45 mm"
f0 = 1.5
f1 = 0.001
preload = "300 N"

[formulas]
form = "films"
map_angle = ["0 deg", "22.5 deg"]
map_distance = [-0.9, 0.9]
angles = ["0 deg", "7 deg"]
entrainment_factor = [1.0, 0.03]
speeds = ["300 rpm", "3000 rpm"]
temperatures = ["20 degC", "60 degC"]
eta_beta_sigma = 0.05
sigma_over_beta = 0.01
nodes = 33
course_nodes = 33
""")

INVOLUTE = copy.deepcopy(STRAIN_WAVE)
INVOLUTE["source"] = "zhao_2022"
INVOLUTE["formulas"] = {
    "form": "wear",
    "coefficient": 8e-9,
    "hardness": "1.96 GPa",
    "cycles": 6.5e9,
    "points": 20,
    "flank_length": 1.4,
    "severe_depth": 0.6,
    "coefficient_load": "case",
    "equivalent_radius": "0.5 mm",
    "reference": {
        "line_load": "880 N/m",
        "speed": "1200 rpm",
        "temperature": "40 degC",
        "roughness": "0.55 um",
        "modulus": "220 GPa",
        "viscosity": "84 mPa s",
        "pressure_viscosity": "14 1/GPa",
        "hardness": "1.96 GPa",
    },
    "adsorption_heat": "37 kJ/mol",
    "molecule": "0.3 nm",
    "vibration_period": "3e-12 s",
    "friction": 0.1,
    "conductivity": "46 W/m/K",
    "specific_heat": "460 J/kg/K",
}
INVOLUTE["gears"]["clearance"] = 0.35
INVOLUTE["gears"]["tooth"] = {"form": "involute", "profile_shift": 3.32}
INVOLUTE["gears"]["circular_spline"] = {"form": "involute", "profile_shift": 3.6}

CONJUGATE = copy.deepcopy(INVOLUTE)
CONJUGATE["formulas"] = {"form": "conjugate wear", "rate": "5e-18 1/Pa", "cycles": 6.5e9}

ON_PATH, IN_MOTION = copy.deepcopy(BASE), copy.deepcopy(BASE)
ON_PATH |= {"source": "tian_2024", "formulas": {"form": "pair on path", "places": 9}}
IN_MOTION |= {
    "source": "atanasiu_2011",
    "formulas": {"form": "pair in motion", "input_torques": ["10 N m", "20 N m"]},
}

RIG = {key: BASE[key] for key in ("lubricant", "roughness")} | tomllib.loads(
    """
[gears]
family = "ball_on_disc"
ball_radius = "10 mm"
transverse_radius = "20 mm"
track_radius = "40 mm"

[operation]
force = "50 N"
speed = "200 rpm"
temperature = "60 degC"

[film]
solver = "elliptic"

[film.heights.gear_1]
file = "HEIGHTS"
step_along = "50 um"
step_across = "50 um"
""".replace("HEIGHTS", str(Path(__file__).with_name("heights.csv")))
)

GANTRY = {key: BASE[key] for key in ("lubricant", "roughness")} | tomllib.loads("""
[gears]
family = "rack_and_pinion"
teeth = 20
module = "3 mm"
face_width = "25 mm"
mass = "40 kg"

[operation]
force = "2000 N"
speed = "200 rpm"
temperature = "60 degC"
""")

TORUS = {key: BASE[key] for key in ("lubricant", "roughness")} | tomllib.loads("""
[gears]
family = "torus"
teeth = [40, 49]
module = "2.5 mm"
face_width = ["15 mm", "20 mm"]
torus_radius = ["35 mm", "55 mm"]
centre_distance = "111.4 mm"
inclination = "2 mrad"
axial_offset = "0.1 mm"

[gears.deviations]
gear_1 = [{ order = 1, amplitude = "5 um", phase = "30 deg" }]
gear_2 = [{ order = 2, amplitude = "3 um" }]

[operation]
torque = "49 N m"
speed = "100 rad/s"
temperature = "60 degC"

[models]
elliptic_contact = "hamrock_brewe_1983"
rolling_resistance = "wu_cheng_1991_strips"
""")

DRIVE = tomllib.loads("""
[stages.1]
driver = "gear 1"
place = "0 mm"
turn = "0 deg"

[stages.1.gears]
flank = "left"
teeth = [23, 61]
module = "2 mm"
face_width = "20 mm"

[stages.1.materials]
gear_1 = "steel"

[stages.1.lubricant]
name = "pao-vg-100"

[stages.1.roughness]
ra = "0.3 um"

[stages.1.models]
friction = "constant"

[stages.1.losses.between_its_gears]
between = ["gear 1", "gear 2"]
seal_torque = "0.1 N m"

[stages.2.gears]
teeth = [19, 70]
module = "3 mm"
face_width = "30 mm"

[losses.seal]
between = ["shaft 3", "housing"]
seal_torque = "0.1 N m"

[loss_map]
count = 3
""")
DRIVE |= {key: BASE[key] for key in ("title", "summary", "source", "lubricant", "roughness")}
DRIVE |= {key: BASE[key] for key in ("materials", "housing", "issues")}
DRIVE |= {"operation": {k: v for k, v in BASE["operation"].items() if k != "driver"}}
DRIVE |= {"models": {"friction": "constant"}, "studies": {"cold": {"title": "cold"}}}
DRIVE |= {"targets": [{**BASE["targets"][0], "study": "cold", "variable": "mean_loss"}]}

WORN = {key: BASE[key] for key in ("lubricant", "roughness", "operation")}
WORN |= {"gears": {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"}}
WORN |= {"models": {"friction": "constant", "load_sharing": "from_stiffness"}}


def worn_file(gears: dict[str, Any]) -> str:
    """A result with wear of some gears."""
    document = resolve({**WORN, "gears": gears}, name="worn.toml", variant="default")
    depth = np.zeros((2, 2, 8, 1))
    depth[1, 0] = 1e-6
    data = dataset(
        {
            "worn_depth": (("step", "member", "cell", "strip"), depth),
            "deepest_wear": (("step", "member"), depth.max(axis=(2, 3))),
            "wear_error": (("step", "member"), 0.01 * depth.max(axis=(2, 3))),
            "cycles": (("step",), np.array([0.0, 1e6])),
            "conforming": (("step",), np.array([False, False])),
            "flank_ends": (("member", "side"), np.array([[0.5e-3, 3e-3], [2e-3, 6e-3]])),
            "across_ends": (("side",), np.array([-0.01, 0.01])),
            "contact_span": (("axis",), np.array([1e-4, 0.02])),
        },
        {},
        title="wear",
        gears=gears_digest(schema.validated(schema.CaseFile, document).gears),
        driver="gear 1",
    )
    path = Path(_FOLDER.name) / "wear.nc"
    save(data, path)
    return str(path)


_FOLDER = tempfile.TemporaryDirectory()
DUTY = {key: BASE[key] for key in ("lubricant", "roughness", "operation")}
DUTY |= {"gears": WORN["gears"], "loss_map": {"quadrants": 4}}


def cycle_file(name: str, text: str) -> str:
    """A file of loads over time."""
    path = Path(_FOLDER.name) / name
    path.write_text(text, "utf-8")
    return str(path)


DUTY |= {
    "duty": {
        "file": cycle_file("cycle.csv", "time [s], torque [N m], speed [rpm]\n0, 9, 9\n1, 9, 9\n"),
        "motor": {"torque_constant": "0.1 N m/A", "resistance": "0.5 ohm"},
        "lives": {"output": {"torque": "40 N m", "revolutions": 1e7}},
        "heat": {
            "gears": "case",
            "bodies": {"case": {"heat_capacity": "400 J/K", "largest_temperature": "90 degC"}},
            "resistances": {"air": {"between": ["case", "ambient"], "resistance": "0.5 K/W"}},
        },
    }
}
WORN |= {"worn": {"file": worn_file(WORN["gears"]), "cycles": 1e5}}

PLANETARY = {
    "gears": {
        "family": "planetary",
        "teeth": [24, 30, 84],
        "module": "1 mm",
        "face_width": "12 mm",
    },
    **{key: BASE[key] for key in ("lubricant", "roughness")},
    "operation": {"torque": "60 N m", "speed": "3000 rpm", "temperature": "60 degC"},
}
DRAWN = {
    **PLANETARY,
    "gears": {
        **PLANETARY["gears"],
        "inspection": {
            "upper_thickness_allowance": "-20 um",
            "lower_thickness_allowance": ["-50 um", "-60 um", "-80 um"],
            "centre_distance_field": "js7",
            "iso_class": 6,
        },
    },
}
OF_SET = {
    **PLANETARY,
    "materials": {name: {"young": "206 GPa", "poisson": 0.3} for name in ("sun", "planet", "ring")},
}
SECOND = {"teeth": [34, 88], "face_width": "10 mm", "module": "1 mm", "tip_alteration": [0, 0]}
THREE_K = {
    **PLANETARY,
    "gears": {**PLANETARY["gears"], "teeth": [18, 36, 90], "second": SECOND},
}
TRAIN = {
    "stages": {
        "1": {
            "bodies": ["sun", "planet"],
            "gears": {
                "teeth": [24, 30],
                "module": "1 mm",
                "face_width": "12 mm",
                "fillet_radius": 0.2,
            },
        },
        "2": {
            "bodies": ["planet", "ring"],
            "gears": {
                "teeth": [30, -84],
                "module": "1 mm",
                "face_width": "12 mm",
                "fillet_radius": 0.2,
            },
        },
    },
    "train": {"input": "sun", "output": "carrier", "held": "ring"},
    **{key: PLANETARY[key] for key in ("lubricant", "roughness", "operation")},
}
BASES = {
    "cylindrical": BASE,
    "drive": DRIVE,
    "strain wave": STRAIN_WAVE,
    "involute": INVOLUTE,
    "conjugate": CONJUGATE,
    "on path": ON_PATH,
    "in motion": IN_MOTION,
    "rack": GANTRY,
    "torus": TORUS,
    "rig": RIG,
    "worn": WORN,
    "duty": DUTY,
    "planetary": PLANETARY,
    "materials of a set": OF_SET,
    "drawings of a set": DRAWN,
    "3K": THREE_K,
    "train": TRAIN,
}
WALKS = [
    ("cylindrical", schema.CaseFile, ()),
    ("strain wave", strain_wave.StrainWaveGears, ("gears",)),
    ("strain wave", ZoneFilms, ("formulas",)),
    ("involute", FlankWear, ("formulas",)),
    ("conjugate", ConjugateWear, ("formulas",)),
    ("on path", PairOnPath, ("formulas",)),
    ("in motion", PairInMotion, ("formulas",)),
    ("involute", strain_wave.InvoluteTooth, ("gears", "tooth")),
    ("involute", strain_wave.InvoluteGroove, ("gears", "circular_spline")),
    ("rack", rack_and_pinion.RackAndPinionGears, ("gears",)),
    ("torus", torus.TorusGears, ("gears",)),
    ("rig", ball_on_disc.BallOnDiscRig, ("gears",)),
    ("rig", schema.HeightTables, ("film", "heights")),
    ("worn", schema.WornTable, ("worn",)),
    ("duty", duty_table.DutyTable, ("duty",)),
    ("planetary", planetary.PlanetaryGears, ("gears",)),
    ("materials of a set", schema.DriveMaterials, ("materials",)),
    ("drawings of a set", planetary.InspectionOfSet, ("gears", "inspection")),
    ("3K", planetary.SecondGears, ("gears", "second")),
    ("train", schema.TrainTable, ("train",)),
]
"""Sound case, table and its place: together every table of the schema."""

Path_ = tuple[str | int, ...]


@dataclass(frozen=True)
class Site:
    """A place in the schema: in which sound case, its path, and what belongs there."""

    base: str
    path: Path_
    annotation: Any
    marks: tuple[Any, ...]

    @property
    def key(self) -> str:
        return ".".join(map(str, self.path))

    def mark(self, kind: type) -> Any:
        return next((mark for mark in self.marks if isinstance(mark, kind)), None)


@dataclass(frozen=True)
class Bad:
    """A broken case: what is put where, what the message must contain, and in which sound case."""

    name: str
    path: Path_
    value: Any
    words: tuple[str, ...]
    key: str
    base: str = "cylindrical"


# ---- walking the schema


def marks_in(annotation: Any) -> Iterator[Any]:
    yield from getattr(annotation, "__metadata__", ())
    for inner in get_args(annotation):
        if not isinstance(inner, str):
            yield from marks_in(inner)


def tables_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from tables_in(inner)


def containers(annotation: Any) -> set[Any]:
    """Which of dict and tuple stand between a field and its values; a pair is no list."""
    found = {get_origin(annotation)} & {dict, tuple}
    if get_origin(annotation) in (Union, UnionType) or hasattr(annotation, "__metadata__"):
        found |= set().union(*(containers(inner) for inner in get_args(annotation)))
    return found


def inner(site: Site) -> Iterator[tuple[type[BaseModel], Path_]]:
    """Table that stands at a place of the sound case, and its path; of a list or many the first."""
    found = list(tables_in(site.annotation))
    if not found:
        return
    path, node = site.path, at(BASES[site.base], site.path, {})
    if not node:  # a table that another sound case has
        return
    if containers(site.annotation) & {tuple}:
        path = (*path, 0)
    elif dict in containers(site.annotation):
        path = (*path, next(iter(node)))
    forms = [table for table in found if len(found) > 1 and tag(table) in node.values()]
    yield from ((table, path) for table in forms or found)


def tables(base: str, model: type[BaseModel], path: Path_) -> Iterator[tuple[Any, str, Path_]]:
    yield model, base, path
    for site in places(base, model, path):
        for table, where in inner(site):
            yield from tables(base, table, where)


def places(base: str, model: type[BaseModel], path: Path_) -> Iterator[Site]:
    for name, info in model.model_fields.items():
        marks = (*info.metadata, *marks_in(info.annotation))
        yield Site(base, (*path, name), info.annotation, marks)


def at(tree: Any, path: Path_, missing: Any = None) -> Any:
    for part in path:
        if missing is not None and isinstance(tree, dict) and part not in tree:
            return missing
        tree = tree[part]
    return tree


def put(bad: Bad) -> dict[str, Any]:
    tree = copy.deepcopy(BASES[bad.base])
    path, value = bad.path, bad.value
    at(tree, path[:-1])[path[-1]] = value
    return tree


TABLES = [table for walk in WALKS for table in tables(*walk)]
TABLES += [
    (schema.DriveCase, "drive", ()),
    (schema.StageTable, "drive", ("stages", "1")),
]
SITES = [site for model, base, path in TABLES for site in places(base, model, path)]


# ---- what can be wrong at each kind of place

LIST, TABLE, DATE = [1, 2, 3], {"a": 1}, datetime.date(2024, 1, 31)
SHAPES = {
    "list": (LIST, "[1, 2, 3]"),
    "table": (TABLE, "{ a = 1 }"),
    "bool": (True, "true"),
    "date": (DATE, "2024-01-31"),
}
NUMBERS = {**SHAPES, "text": ("plenty", '"plenty"'), "empty": ("", '""')}
NAMES = {**SHAPES, "number": (7, "7"), "nan": (math.nan, "nan")}


def of_quantity(quantity: Quantity) -> Iterator[tuple[str, Any, str]]:
    """Name, value and shown value of everything that is no such quantity."""
    unit = units.si_unit(quantity.kind)

    def written(number: float) -> Any:
        return f"{number!r} {unit}" if unit else number

    for name, (value, shown) in NUMBERS.items():
        yield name, value, shown
    yield "nan", math.nan, "nan"
    yield "infinite", math.inf, "inf"
    yield "nan text", f"nan {unit}", "nan"
    yield "huge", 10**400, "more than 40 digits"
    other = "3 m" if quantity.kind == "mass" else "3 kg"
    yield "wrong dimension", other, f'"{other}"'
    yield "decimal comma", f"0,5 {unit}", "0,5"
    if unit:
        yield "missing unit", 3, '"3" has no unit'
        yield "missing unit in text", "3", '"3" has no unit'
        yield "unknown unit", "3 furlong", '"3 furlong"'
    if quantity.low > -math.inf:
        low = written(quantity.low - 0.5 * abs(quantity.low) - 1.0)
        yield "below", low, str(low)
    if quantity.open_low:
        yield "at the open end", written(quantity.low), str(written(quantity.low))
    if quantity.high < math.inf:
        high = written(1.5 * quantity.high + 1.0)
        yield "above", high, str(high)
    if quantity.whole:
        yield "not whole", written(quantity.low + 0.5), str(written(quantity.low + 0.5))


def of_name(known: list[str]) -> Iterator[tuple[str, Any, str, str]]:
    yield "misspelt", f"{known[0]}x", f'"{known[0]}x"', known[0]
    yield "unknown", "qqqq", '"qqqq"', f"known are {', '.join(known)}"
    for name, (value, shown) in NAMES.items():
        yield name, value, shown, known[0]


def named_list(site: Site) -> list[str] | None:
    """Names that a registry field takes: what its own message lists."""
    reader = site.mark(BeforeValidator)
    if reader is None or "named.<locals>" not in getattr(reader.func, "__qualname__", ""):
        return None
    with pytest.raises(Exception, match="known are") as caught:
        reader.func("qqqq")
    return str(caught.value).partition("known are ")[2].split(", ")


def literals(annotation: Any) -> tuple[Any, ...]:
    """Words that a field takes, be it one that may be left open; none where it takes others."""
    each = (annotation, *get_args(annotation))
    return next((get_args(one) for one in each if get_origin(one) is Literal), ())


def takes_flag(site: Site) -> bool:
    options = get_args(site.annotation)
    return site.annotation is bool or any(bool in get_args(option) for option in options)


def bads_at(site: Site) -> Iterator[Bad]:
    quantity, pair, known = site.mark(Quantity), site.mark(Pair), named_list(site)
    if pair is not None:
        yield from bad_pairs(site, pair.each, 3 if isinstance(pair, planetary.OfThree) else 2)
    elif quantity is not None:
        several = containers(site.annotation) & {tuple}
        for name, value, shown in of_quantity(quantity):
            given = [value] if several else value
            yield Bad(name, site.path, given, (shown, quantity.allowed), site.key)
        if several:
            for name, value in (("number", 3), ("text", "x"), ("table", TABLE)):
                yield Bad(f"no list but {name}", site.path, value, ("list",), site.key)
    elif known is not None:
        by_value = bool(list(tables_in(site.annotation)))
        for name, value, *words in of_name(known):
            if not (by_value and name == "table"):
                yield Bad(name, site.path, value, tuple(words), site.key.partition(".0.name")[0])
    elif options := literals(site.annotation):
        for name, (value, shown) in {**NAMES, "text": ("x", '"x"')}.items():
            yield Bad(name, site.path, value, (shown, *map(str, options)), site.key)
    elif takes_flag(site):
        for name, (value, shown) in {**NAMES, "text": ("x", '"x"')}.items():
            if not isinstance(value, bool):
                yield Bad(name, site.path, value, (shown, "true and false"), site.key)
    elif site.annotation is str:
        for name, (value, shown) in NAMES.items():
            yield Bad(name, site.path, value, (shown, "text"), site.key)
    elif list(tables_in(site.annotation)) or containers(site.annotation):
        yield from bad_structures(site)
    else:
        assert site.annotation is Any, f"{site.key} is of a kind that this test does not know"


def bad_pairs(site: Site, each: Quantity, count: int) -> Iterator[Bad]:
    for name, value, shown in of_quantity(each):
        if name == "list" and count == len(LIST):
            value, shown = [*LIST, 4], "[1, 2, 3, 4]"
        yield Bad(name, site.path, value, (shown, each.allowed), site.key)
        if name != "list":
            several = [value] * count
            yield Bad(f"{name} in list", site.path, several, (shown, each.allowed), site.key)
    yield Bad("list of none", site.path, [], ("0 values", each.allowed), site.key)


def bad_structures(site: Site) -> Iterator[Bad]:
    given = {"number": (3, "3"), "text": ("qqqq", '"qqqq"'), "bool": (True, "true")}
    given |= {"nan": (math.nan, "nan")}
    if site.path != ("models", "friction"):  # a single law may be given as it is
        shape = (
            (LIST, "[1, 2, 3]") if not containers(site.annotation) & {tuple} else (TABLE, "a = 1")
        )
        given["other shape"] = shape
    for name, (value, shown) in given.items():
        yield Bad(name, site.path, value, (shown,), site.key)


def bad_keys() -> Iterator[Bad]:
    for model, base, path in TABLES:
        if model is schema.FrictionChoice:
            continue  # its keys are parameters, see below
        first = next(iter(model.model_fields))
        wrong = f"{first}x"
        key = ".".join(map(str, (*path, wrong)))
        for name, value in (("key", 1), ("table", TABLE)):
            yield Bad(f"unknown {name}", (*path, wrong), value, (name, first), key, base)


def bad_sweeps() -> Iterator[Bad]:
    sweep = ("studies", "scan", "sweep")
    for name, value, shown in of_quantity(MODULE):
        for end in ("start", "stop"):
            words = (shown, MODULE.allowed, "gears.module")
            yield Bad(f"{end} {name}", (*sweep, end), value, words, ".".join(sweep))
        listed = ("studies", "list", "sweep", "values")
        yield Bad(f"values {name}", listed, [value], words, "studies.list.sweep")
    for wrong, words in {
        "gears.modul": ("module",),
        "gaers.module": ("gears",),
        "gears.module.deep": ("gears.module.deep",),
        "title": ("cannot be swept", "operation"),
        "models.load_sharing": ("cannot be swept", "operation"),
        "loss_map.torque": ("cannot be swept", "operation"),
        "operation.driver": ("no number", "values"),
        "": ("gears",),
    }.items():
        yield Bad(f"key {wrong}", (*sweep, "key"), wrong, words, ".".join(sweep))
    for key in ("start", "stop"):
        whole = {"key": "gears.module", key: "2 mm"}
        yield Bad(f"only {key}", sweep, whole, ("start and stop, or values",), ".".join(sweep))
    both = {**at(BASE, sweep), "values": ["2 mm"]}
    yield Bad("both", sweep, both, ("start and stop, or values",), ".".join(sweep))
    empty = {"key": "gears.module", "values": []}
    yield Bad("no values", sweep, empty, ("0 values", "1 to 100000"), ".".join(sweep))
    two_ends = {"key": "gears.module", "start": "2 mm", "stop": "3 mm", "count": 1}
    yield Bad(
        "one value",
        sweep,
        two_ends,
        ('both "2 mm" and "3 mm"; write 2',),
        ".".join((*sweep, "count")),
    )


def bad_parameters() -> Iterator[Bad]:
    path = ("models", "friction")
    for law in FRICTION.values():
        own = arguments(law.function)[1]
        table = {"name": law.name, "qqqq": 1}
        words = ("no parameter", law.name, *own)
        yield Bad(f"{law.name} unknown", path, table, words, "models.friction.qqqq")
        for key in own:
            for name, value, shown in of_quantity(schema.COEFFICIENT):
                words = (shown, schema.COEFFICIENT.allowed)
                where = f"models.friction.{key}"
                yield Bad(
                    f"{law.name} {key} {name}", path, {"name": law.name, key: value}, words, where
                )
    yield Bad("none", path, [], ("0 friction laws", "1 to 12"), "models.friction")
    yield Bad("many", path, ["constant"] * 13, ("13 friction laws", "1 to 12"), "models.friction")
    yield Bad("twice", path, ["xu_2007", "xu_2007"], ('"xu_2007"', "once"), "models.friction")


def bad_oils() -> Iterator[Bad]:
    by_value = at(BASE, ("lubricant",))
    for name, change, words, key in [
        ("nothing", {"base": None, "viscosity_40": None, "viscosity_100": None}, ("name",), ""),
        ("no base", {"base": None}, ("mineral", "pao"), ""),
        ("one viscosity", {"viscosity_100": None}, ("viscosity_40 and viscosity_100",), ""),
        ("rising", {"viscosity_100": "300 mm2/s"}, ("above",), ".viscosity_40"),
        ("ends", {"temperature_min": "90 degC", "temperature_max": "80 degC"}, ("below",), ""),
        (
            "thin in the cold",
            {"viscosity_minus_40": "20 mm2/s"},
            ("must be above viscosity_40",),
            ".viscosity_minus_40",
        ),
        (
            "hardly thicker in the cold",
            {"viscosity_minus_40": "300 mm2/s"},
            ("300 mm2/s at -40 degC does not go with", "factor of 5"),
            ".viscosity_minus_40",
        ),
    ]:
        oil = {k: v for k, v in {**by_value, **change}.items() if v is not None}
        yield Bad(f"oil {name}", ("lubricant",), oil, words, f"lubricant{key}")


def bad_cold() -> Iterator[Bad]:
    cold = ("operation", "temperature")
    for base, allowed in [("cylindrical", "to 120 degC"), ("strain wave", "0 degC to 120 degC")]:
        words = ("-41 degC is outside the range of", allowed)
        yield Bad(f"cold {base}", cold, "-41 degC", words, "operation.temperature", base)


def bad_surfaces() -> Iterator[Bad]:
    two = {"ra": "0.4 um", "composite_rq": "0.5 um"}
    yield Bad("two", ("roughness",), two, ("ra and composite_rq", "alone"), "roughness")
    yield Bad("none", ("roughness",), {}, ("no roughness", "ra, rq or both"), "roughness")
    low = {"ra": "0.4 um", "rq": "0.3 um"}
    yield Bad("low", ("roughness",), low, ("0.3 um", "below its Ra, 0.4 um"), "roughness.rq")


def bad_marks() -> Iterator[Bad]:
    for value in ("guessed", 3, LIST, TABLE):
        mark = {"value": "2 mm", "status": value}
        yield Bad(
            f"status {value}", ("gears", "module"), mark, ("printed", "assumed"), "gears.module"
        )
    table = {"value": "2 mm", "unit": "mm"}
    words = (MODULE.allowed,)
    yield Bad("no mark", ("gears", "module"), table, words, "gears.module")


def bad_targets() -> Iterator[Bad]:
    yield Bad("unit", ("targets", 0, "unit"), "parsec", ('"parsec"', "unit"), "targets.0.unit")
    yield Bad("study", ("targets", 0, "study"), "scam", ('"scam"', "scan"), "targets.0.study")


def bad_names() -> Iterator[Bad]:
    words = ("letters, digits",)
    for name in ("../up", "a/b", "a b", "", "x" * 61, "a\nb", ".."):
        yield Bad(f"study {name!r}", ("studies",), {name: {}}, words, "studies")
        yield Bad(f"variant {name!r}", ("variants",), {name: {}}, words, "variants")
    yield Bad("variants", ("variants",), 3, ("3", "table"), "variants")
    yield Bad("variant", ("variants",), {"a": 3}, ("3", "table"), "variants.a")
    flat = {"a": {"friction": "xu_2007"}}
    told = ("[variants.a.models]", "friction")
    yield Bad("a key of a variant in no table", ("variants",), flat, told, "variants.a.friction")


def bad_stages() -> Iterator[Bad]:
    """What is wrong with stages that are sound each by itself."""
    second, ball = ("stages", "2", "gears"), RIG["gears"]
    rack = {key: value for key, value in GANTRY["gears"].items() if key != "mass"}
    seal = {"seal_torque": "0.1 N m"}
    for name, path, value, words, key in [
        ("none", ("stages",), [], ("no stage was given", "[[stages]]"), "stages: "),
        ("six", ("stages",), [{}] * 6, ("6 were given; allowed are at most 5",), "stages: "),
        ("a gap", ("stages",), {"1": {}, "3": {}}, ("there is no stage 2",), "stages: "),
        ("nought", ("stages", "0"), {}, ('no stage "0"; use stages.1 to stages.2',), "stages: "),
        ("no number", ("stages", "x"), {}, ('no stage "x"; use stages.1 to stages.2',), "stages: "),
        (
            "path of one pair",
            ("stages", "2", "models"),
            {"averaging": "path"},
            ("the path of one pair does not stand for several meshes",),
            "stages.2.models.averaging",
        ),
        (
            "gears too",
            ("gears",),
            BASE["gears"],
            ("was given with [[stages]]", "write stages.1.gears."),
            "gears: ",
        ),
        ("dynamics", ("dynamics",), {}, ("that of a mesh; give a stage the table",), "dynamics: "),
        (
            "film",
            ("film",),
            {"solver": "line"},
            ("films are those of a mesh; give a stage",),
            "film: ",
        ),
        (
            "left",
            (*second, "flank"),
            "left",
            ("turns against", "leave flank"),
            "stages.2.gears.flank",
        ),
        (
            "teeth",
            (*second, "teeth"),
            [1, 70],
            ("gear 1 was given 1 teeth",),
            "stages.2.gears.teeth",
        ),
        (
            "pointed",
            (*second, "profile_shift"),
            [1.6, 0],
            ("tip circle",),
            "stages.2.gears.addendum",
        ),
        ("width", (*second, "face_widht"), 1, ("face_width",), "stages.2.gears.face_widht"),
        ("rig", second, ball, ("a test rig transmits nothing",), "stages.2.gears.family"),
        ("rack", ("stages", "1", "gears"), rack, ("turns no shaft",), "stages.1.gears.family"),
        ("force", ("operation", "force"), "3 N", ("carry a torque",), "operation.force"),
        ("path", ("models", "averaging"), "path", ("several meshes",), "models.averaging"),
        ("driver", ("operation", "driver"), "gear 1", ("[[stages]]",), "operation.driver"),
        ("member", ("stages", "2", "driver"), "gear 3", ("gear 1 or gear 2",), "stages.2.driver"),
        (
            "sharing",
            ("models", "load_sharing"),
            "sanchez",
            ("sanchez_2017",),
            "models.load_sharing",
        ),
        (
            "planet",
            ("losses",),
            {"oil": {"between": ["planet", "carrier"], **seal}},
            ('"planet" is no body of this drive',),
            "losses.oil.between",
        ),
        (
            "shaft",
            ("losses",),
            {"oil": {"between": ["shaft 4", "housing"], **seal}},
            ('"shaft 4" is no body of this drive', "shaft 2"),
            "losses.oil.between",
        ),
        (
            "far shafts",
            ("losses",),
            {"oil": {"between": ["shaft 1", "shaft 3"], **seal}},
            ("between shafts that no stage of the drive has in common",),
            "losses.oil.between",
        ),
        (
            "in the housing",
            ("stages", "1", "losses"),
            {"oil": {"between": ["gear 2", "housing"], **seal}},
            ("may carry two meshes", "[losses]"),
            "stages.1.losses.oil.between",
        ),
    ]:
        yield Bad(f"stages {name}", path, value, words, key, "drive")
    three = ["constant", "xu_2007", "iso_tr_14179_2"]
    told = ("2 friction laws were given where another stage has 3",)
    stages = copy.deepcopy(DRIVE["stages"])
    stages["1"]["models"]["friction"] = three[:2]
    stages["2"]["models"] = {"friction": three}
    yield Bad("stages laws", ("stages",), stages, told, "stages.1.models.friction", "drive")


def bad_drives() -> Iterator[Bad]:
    for name, path, value, words in [
        ("fixed", ("operation", "driver"), "circular spline", ("fixed", "wave generator or flex")),
        ("driver", ("operation", "driver"), "gear 1", ("is not in this drive", "flexspline")),
        ("clearance", ("gears", "clearance"), 1.5, ("less than the depth of the teeth",)),
        ("family", ("gears", "family"), "strainwave", ("did you mean strain_wave?",)),
        ("form", ("gears", "tooth", "form"), "involut", ("'double arc' or 'involute'",)),
        ("set", ("gears", "tooth"), {"convex_radius": 1.4}, ("convex_offset", "liu, flat")),
        ("shape", ("gears", "wave_generator", "shape"), "cosine", ("weights were both given",)),
        ("mixed", ("gears", "tooth", "profile_shift"), 3.3, ("profile_shift", "not a known key")),
        ("body", ("losses", "bearing", "between", 0), "wave", ("wave generator", "housing")),
        ("bodies", ("losses", "bearing", "between", 0), "flexspline", ("given twice", "housing")),
        ("factor", ("losses", "bearing", "bearing"), "none", ("no model asks for it",)),
        ("slopes", ("gears", "slopes"), ["9 N m", "9 N m"], ("larger last",)),
        ("walls", ("gears", "flexspline", "walls"), "bending strain", ("rim_thickness was given",)),
        (
            "support",
            ("gears", "flexspline", "support_stiffness"),
            "2e9 Pa",
            ("a bearing", "give one"),
        ),
        ("helix", ("gears", "helix_angle"), "10 deg", ("known are family, teeth", "backlash")),
        ("no length", ("gears", "relief_length"), 0.0, ("0.005 modules needs a length",)),
        ("long relief", ("gears", "relief_length"), 1.0, ("longer than the flank at the tip",)),
        ("deep relief", ("gears", "tip_relief"), 0.2, ("nothing of the rounding is left",)),
        ("late", ("gears", "disengagement"), "85 deg", ("allowed is 20 deg to 80 deg",)),
        ("edges", ("gears", "edges"), "maybe", ("clear", "carry")),
    ]:
        key = ".".join(part for part in path if isinstance(part, str)).removesuffix(".shape")
        key = key.replace("bearing.bearing", "bearing")
        yield Bad(f"drive {name}", path, value, words, key, "strain wave")
    for given, key, told in [
        ({"flange": "bolts", "flange_stiffness": "1 kN m/rad"}, "flange_stiffness", "both given"),
        ({"flange": "rigid", "bolts": 8}, "bolts", "flange leaves out"),
        ({"flange_stiffness": "1 kN m/rad", "bolts": 8}, "bolts", "flange_stiffness leaves out"),
        ({"flange_diameter": "59 mm"}, "flange_diameter", "leaves no bottom"),
        ({"bolt_circle": "500 mm"}, "bolt_circle", "the cup has one of"),
        ({"shaft_diameter": "500 mm"}, "shaft_diameter", "the cup has one of"),
        ({"outside_diameter": "60.5 mm"}, "outside_diameter", "roots lie on"),
    ]:
        where = f"gears.yielding.{key}"
        yield Bad(f"yielding {told}", ("gears", "yielding"), given, (told,), where, "strain wave")
    words = ("come free at the short axis", "a clearance of 0.35")
    yield Bad("free", ("gears", "clearance"), 0.1, words, "gears.clearance: ", "involute")
    for driver in ("wave generator", "gear 3", "Gear 1"):
        words = (f'"{driver}" is not in this drive; use gear 1 or gear 2\n',)
        yield Bad(driver, ("operation", "driver"), driver, words, "operation.driver: ")
    churned = {"between": ["gear 1", "housing"], "churning_torque": "1 N m"}
    yield Bad(
        "churning", ("losses",), {"oil": churned}, ("is missing",), "losses.oil.churning_speed"
    )
    for key, value, words in [
        ("slices", 24, ("not divided into slices", "leave it at 12")),
        ("averaging", "path", ("path of one pair", '"base_pitch"')),
    ]:
        yield Bad(key, ("models",), {key: value}, words, f"models.{key}", "strain wave")
    between = {"between": ["gear 1", "housing"]}
    for given, of in [
        ({"seal_torque": "1 N m", "preload": "10 N"}, "a bearing"),
        ({"seal_torque": "1 N m", "dynamic_load_rating": "9 kN"}, "a bearing"),
        ({"seal_torque": "1 N m", "life_exponent": 3}, "dynamic_load_rating"),
        ({"seal_torque": "1 N m", "static_load_rating": "9 kN"}, "a bearing"),
        ({"seal_torque": "1 N m", "churning_speed": "100 rpm"}, "churning_torque"),
        ({"seal_torque": "1 N m", "churning_exponent": 2}, "churning_torque"),
    ]:
        words, key = (f"without {of}", "belongs"), f"losses.oil.{[*given][1]}"
        yield Bad(f"{[*given][1]} alone", ("losses",), {"oil": between | given}, words, key)
    zero = {"bearing": "palmgren_1959", "mean_diameter": "45 mm", "f0": 0, "f1": 0}
    for name, given in [("nothing", {}), ("zero", zero | {"preload": "10 N"})]:
        yield Bad(f"loss {name}", ("losses",), {"oil": between | given}, ("zero",), "losses.oil")
    bearing = {"between": ["gear 1", "housing"], "bearing": "palmgren_1959", "f1": 0.001}
    words = ("is missing", "mean_diameter, f0, f1")
    yield Bad("bearing", ("losses",), {"oil": bearing}, words, "losses.oil.mean_diameter")
    held = {"between": ["gear 1", "housing"], "breakaway": "dry_and_viscous"}
    words = ("is missing", "mean_diameter, breakaway_dry, breakaway_viscous")
    yield Bad("breakaway", ("losses",), {"oil": held}, words, "losses.oil.mean_diameter")
    seal = between | {"seal_torque": "1 N m", "breakaway_preload": 2}
    words, key = ('breakaway is "none"; name one',), "losses.oil.breakaway_preload"
    yield Bad("breakaway_preload alone", ("losses",), {"oil": seal}, words, key)


def bad_loss_sets() -> Iterator[Bad]:
    for name, given, words in [
        ("misspelt", "strain_wave_componet", ("did you mean strain_wave_component",)),
        ("a number", 3, ("3 is not the name of a set of losses", "strain_wave_component")),
        ("a list", LIST, ("is not the name of a set of losses",)),
    ]:
        given = {"set": given}
        yield Bad(f"set {name}", ("losses",), given, words, "losses.set", "strain wave")
    named = {"set": "strain_wave_component"}
    words = ("scales with pitch diameter", "which these gears do not have")
    yield Bad("set of other gears", ("losses",), named, words, "losses.set: ")
    yield Bad("set of a rack", ("losses",), named, words, "losses.set: ", "rack")
    words = ("a set belongs to one mesh", "under the stage")
    yield Bad("set of a drive", ("losses",), named, words, "losses.set: ", "drive")
    key = "losses.wave_generator_bearing"
    for name, given, end, words in [
        ("negative", {"f0": -1}, ".f0", ("-1", "allowed is 0 to 100")),
        ("negative size", {"mean_diameter": "-3 mm"}, ".mean_diameter", ("-3 mm", "allowed")),
        ("negative part", {"breakaway_dry": "-1 N/m"}, ".breakaway_dry", ("allowed is 0",)),
        ("unknown key", {"f2": 1}, ".f2", ("f0", "f1")),
        ("no bearing", {"bearing": "none"}, ".f0", ('bearing is "none"; name one',)),
        ("no table", 3, "", ("3 was given where a table belongs",)),
    ]:
        table = named | {"wave_generator_bearing": given}
        yield Bad(f"set {name}", ("losses",), table, words, key + end, "strain wave")


WALKED = [replace(bad, base=site.base) for site in SITES for bad in bads_at(site)]
LISTED = [
    *bad_keys(),
    *bad_sweeps(),
    *bad_parameters(),
    *bad_oils(),
    *bad_cold(),
    *bad_loss_sets(),
    *bad_surfaces(),
    *bad_marks(),
    *bad_targets(),
    *bad_names(),
    *bad_drives(),
    *bad_stages(),
]
REQUIRED = [
    (base, (*path, name))
    for model, base, path in TABLES
    for name, info in model.model_fields.items()
    if info.is_required() and name != "stages"  # without it a case has one mesh
] + [("cylindrical", ("operation", "torque")), ("rig", ("operation", "force"))]


# ---- writing and running


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(k)} = {toml(v)}' for k, v in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(toml, value))}]"
    if isinstance(value, str | bool):
        return json.dumps(value)
    return str(value)


def written(tree: dict[str, Any], folder: Path) -> Path:
    path = folder / "bad.toml"
    path.write_text("".join(f"{json.dumps(k)} = {toml(v)}\n" for k, v in tree.items()), "utf-8")
    return path


@pytest.fixture
def refuse(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> Callable[..., str]:
    """Run a command that must be refused; gives its one sentence."""
    monkeypatch.chdir(tmp_path)

    def run(
        *arguments: object, status: int = 2, about: object = None, several: bool = False
    ) -> str:
        monkeypatch.setattr(sys, "argv", ["pitchpoint", *map(str, arguments)])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        told = capsys.readouterr()
        assert caught.value.code == status, about
        assert told.out == "", about
        lines = told.err.splitlines(keepends=True)
        assert several or len(lines) == 1, about
        for line in lines:
            assert line.startswith("error: "), about
            assert len(line) < 700, about
        assert "Traceback" not in told.err, about
        return lines[0]

    return run


@pytest.mark.parametrize("base", quick_first(BASES))
def test_the_whole_case_is_sound(
    base: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    path = str(written(BASES[base], tmp_path))
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "show", path, "--json"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert json.loads(capsys.readouterr().out)[0]["title"] == BASES[base].get("title", "bad.toml")


def test_the_walk_reaches_every_table() -> None:
    defined = {
        each
        for module in (
            schema,
            ball_on_disc,
            cylindrical,
            every,
            planetary,
            rack_and_pinion,
            strain_wave,
            torus,
            wear_table,
            duty_table,
        )
        for each in vars(module).values()
        if isinstance(each, type) and issubclass(each, BaseModel)
    }
    assert {model for model, *_ in TABLES} == defined - {BaseModel, Table, every.GearsTable}
    tested = {(bad.base, bad.path[:n]) for bad in WALKED + LISTED for n in range(len(bad.path) + 1)}
    assert tested >= {(site.base, site.path) for site in SITES if site.annotation is not Any}


def by_place(bads: Iterable[Bad]) -> dict[str, list[Bad]]:
    """Thousands of tests would take longer than what they test: one for each place of a case."""
    places: dict[str, list[Bad]] = {}
    for bad in bads:
        places.setdefault(f"{bad.base}: {bad.key}", []).append(bad)
    return places


OF_EACH_KIND = {(bad.base, bad.name): bad for bad in reversed(WALKED)}
ON_COMMAND_LINE = by_place([*OF_EACH_KIND.values(), *LISTED])
MORE_ON_COMMAND_LINE = by_place(bad for bad in WALKED if bad != OF_EACH_KIND[bad.base, bad.name])
IN_SCHEMA = by_place(WALKED)


def demand_words(told: str, bad: Bad) -> None:
    assert f"bad.toml: {bad.key}" in told, bad
    for word in bad.words:
        assert word in told, bad


@pytest.mark.parametrize("place", IN_SCHEMA)
def test_the_schema_refuses_wrong_values(place: str) -> None:
    for bad in IN_SCHEMA[place]:
        with pytest.raises(InputError) as caught:
            schema.validate(resolve(put(bad), name="bad.toml", variant="default"))
        (error,) = caught.value.every
        demand_words(str(error), bad)


@pytest.mark.parametrize("place", ON_COMMAND_LINE)
def test_the_command_line_tells_wrong_values(
    place: str, refuse: Callable[..., str], tmp_path: Path
) -> None:
    for bad in ON_COMMAND_LINE[place]:
        demand_words(refuse("show", written(put(bad), tmp_path), about=bad), bad)


@pytest.mark.whole
@pytest.mark.parametrize("place", MORE_ON_COMMAND_LINE)
def test_the_command_line_tells_every_wrong_value(
    place: str, refuse: Callable[..., str], tmp_path: Path
) -> None:
    for bad in MORE_ON_COMMAND_LINE[place]:
        demand_words(refuse("show", written(put(bad), tmp_path), about=bad), bad)


@pytest.mark.parametrize(("base", "path"), REQUIRED, ids=str)
def test_a_missing_key(base: str, path: Path_, refuse: Callable[..., str], tmp_path: Path) -> None:
    tree = copy.deepcopy(BASES[base])
    del at(tree, path[:-1])[path[-1]]
    told = refuse("show", written(tree, tmp_path))
    assert f"bad.toml: {'.'.join(map(str, path))}: is missing; " in told


# ---- files that are wrong as a whole

GEAR_WORDS = {
    "pointed tooth": (
        ("gears", {"profile_shift": [1.5, 0.0], "teeth": [12, 61]}),
        "gears.addendum: the tip circle of gear 1",
        "where the flanks cross; it may be",
    ),
    "contact ratio below one": (
        ("gears", {"addendum": 0.4}),
        "gears.addendum: the contact ratio of gear 1 and gear 2 is 0.7",
        "must be at least 1",
    ),
    "interference": (
        ("gears", {"teeth": [40, 120], "addendum": [1.5, 1.0], "dedendum": 1.2}),
        "gears.dedendum: the tip of gear 1 runs into the root of gear 2",
        "must be positive",
    ),
    "interference with the fillet": (
        ("gears", {"teeth": [40, 120], "addendum": [1.0, 1.5], "dedendum": 1.2}),
        "gears.addendum: the tip of gear 2 runs into the fillet of gear 1",
        "parts them; it runs with addendum = [1, ",
    ),
    "overlapping flanks": (
        ("gears", {"centre_distance": "83 mm"}),
        "gears.centre_distance: the flanks of gear 1 and gear 2 overlap",
        "at least 84 mm",
    ),
    "too cold": (
        ("operation", {"temperature": "-40 degC"}),
        "operation.temperature: -40 degC is outside the range of 75W90-A",
        "degC to 120 degC",
    ),
    "loss map too hot": (
        ("loss_map", {"temperatures": ["60 degC", "130 degC"]}),
        "loss_map.temperatures: 130 degC is outside the range of 75W90-A",
        "degC to 120 degC",
    ),
    "sharing of helical teeth": (
        ("gears", {"helix_angle": "15 deg"}),
        "models.load_sharing: 'sanchez_2017' holds for spur gears, and these are helical",
        "choose one of equal, from_stiffness",
    ),
    "a bore larger than the root": (
        ("gears", {"bore_diameter": ["10 mm", "300 mm"]}),
        "gears.bore_diameter: the bore diameter of gear 2 is 300 mm; it must be smaller than its root",
    ),
    "a ring smaller than its pinion": (
        ("gears", {"teeth": [23, -20]}),
        "gears.teeth: the ring, gear 2, has 20 teeth and must have more than gear 1, which has 23",
    ),
    "a ring of few teeth": (("gears", {"teeth": [23, -4]}), "gears.teeth: gear 2 was given -4"),
    "sharing beyond two": (
        ("gears", {"addendum": 1.4, "profile_shift": [0.4, -0.2]}),
        "models.load_sharing: 'sanchez_2017' holds for contact ratios between 1 and 2, this pair has 2",
        "equal, from_stiffness, single",
    ),
}


@pytest.mark.parametrize("name", GEAR_WORDS)
def test_gears_that_cannot_run(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    (table, change), *words = GEAR_WORDS[name]
    tree = {**tomllib.loads(PAIR), "models": {"load_sharing": "sanchez_2017"}}
    tree[table] = {**tree.get(table, {}), **change}
    told = refuse("show", written(tree, tmp_path))
    assert told.startswith(f"error: bad.toml: {words[0]}")
    for word in words:
        assert word in told


def deep(levels: int) -> bytes:
    return f"a{'.a' * levels} = 1".encode()


FILES = {
    "not TOML": (b"[gears\nteeth = 3", "is not a TOML file: line 1", "write [gears]"),
    "two of a kind": (b"a = 1\na = 2", "is not a TOML file: ", "line 2", "a = 2; write it once"),
    "binary": (b"\x00\x01\x02", "is not a TOML file", "line 1"),
    "not UTF-8": ("title = 'é'".encode("latin-1"), "is not UTF-8 text", "Latin-1"),
    "empty": (b"", "gears: is missing", "gears, lubricant, roughness, operation"),
    "only a remark": (b"# nothing", "gears: is missing", "gears, lubricant, roughness, operation"),
    "deep tables": (deep(50_000), "is nested more than 16 levels", "most allowed"),
    "deep tables in a line": (b"a = {" + deep(50_000) + b"}", "is nested more than 16", "allowed"),
    "many keys": (b"".join(b"k%d = 1\n" % i for i in range(90_000)), "k0: is not a known key", "g"),
    "a misspelt table": (b"[gaers]\nteeth = 20", "gaers: is not a known table", "mean gears?"),
    "deep lists": (b"a = " + b"[" * 50_000, "is nested more than 16 levels", "most allowed"),
    "closed lists": (b"a = " + b"[" * 40 + b"]" * 40, "is nested more than", "16 levels"),
    "too many digits": (b"a = " + b"9" * 5000, "is not a TOML file", "digit"),
    "many hexadecimal digits": (b"title = 0x" + b"f" * 9000, "title: a whole number", "text"),
    "control characters": (b'"a\\nb\\u001b[1m" = 1', "a\\nb\\x1b[1m", "known key"),
    "many losses": (
        PAIR.encode()
        + b"".join(b"[losses.a%d]\nbetween = ['gear 1', 'housing']\n" % i for i in range(400)),
        "losses: 400 were given; allowed are at most 20",
    ),
    "many studies": (
        PAIR.encode() + b"".join(b"[studies.a%d]\n" % i for i in range(20_000)),
        "studies: 20000 were given; allowed are at most 200",
    ),
    "many variants": (
        b"".join(b"[variants.a%d]\n" % i for i in range(5000)),
        "variants: 5000 were given; allowed are at most 50",
    ),
    "a long key of a change": (
        PAIR.encode() + b"[studies.a.change.gears.module]\n" + b"k" * 100_000 + b" = 1",
        "studies.a: gears.module.kkk",
        '...: "module" is a value, not a table',
    ),
    "a long title": (
        b"title = '" + b"k" * 100_000 + b"'",
        "title: has 100000 characters; allowed are at most 2000",
    ),
    "a remark that is none": (
        b"[gears]\nmodule = { value = 1, note = [2] }",
        "gears.module: ",
        "[2]",
    ),
    "a long remark": (
        b"[gears]\nmodule = { value = 1, where = '" + b"k" * 9000 + b"' }",
        "gears.module: has 9000 characters",
    ),
    "a long key": (b"k" * 100_000 + b" = 1", "kkk...: is not a known key", "gears"),
    "a long text": (b"gears = '" + b"k" * 100_000 + b"'", "gears: ", "where a table belongs"),
}


@pytest.mark.parametrize("name", FILES)
def test_files_that_are_no_case(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    content, *words = FILES[name]
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    told = refuse("show", path, several=True)
    assert told.startswith("error: bad.toml: ")
    for word in words:
        assert word in told


def test_a_byte_order_mark_does_no_harm(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(b"\xef\xbb\xbf[gears]\nteeth = -1")
    assert "gears.teeth: gear 1 was given -1 teeth; allowed are 2 or more" in (
        refuse("show", path, several=True)
    )


def test_a_file_of_a_gigabyte(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    with path.open("wb") as file:
        file.truncate(10**9)
    assert "bad.toml: has 1000 MB; a case file has at most 1 MB" in refuse("run", path)


@pytest.mark.parametrize("command", ["show", "run", "compare"])
def test_no_such_file(command: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    assert "gone.toml: there is no such case file" in refuse(command, tmp_path / "gone.toml")
    assert "is a folder" in refuse(command, tmp_path)
    assert "'tian2042' is neither a shipped case nor a file" in (
        told := refuse(command, "tian2042")
    )
    assert "did you mean tian2024?" in told
    assert "variants" in refuse(command, "tian2024", "--variant", "as_publisht")
    assert refuse(command, "x" * 5000)
    assert refuse(command, f"{'x' * 5000}.toml")
    for endless in ("/dev/null", "/dev/zero"):
        assert "is a pipe or a device; give a case file" in refuse(command, endless)


def test_a_case_without_targets(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    assert "bad.toml: has no targets to compare with" in refuse("compare", path)


@pytest.mark.parametrize("name", ["missing", "empty", "other", "broken"])
def test_nothing_to_cite(name: str, refuse: Callable[..., str], tmp_path: Path) -> None:
    folder = tmp_path / name
    if name != "missing":
        (folder / "default").mkdir(parents=True)
    if name in ("other", "broken"):
        text = '{"parts": 3}' if name == "other" else '{"parts": ['
        (folder / "default" / "manifest.json").write_text(text)
    told = refuse("cite", folder)
    assert name in told
    assert "pitchpoint" in told


# ---- command lines


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--set", "gears.modul=2 mm"], ["bad.toml: gears.modul: ", "did you mean module?"]),
        (["--set", "geers.module=2 mm"], ["bad.toml: geers: ", "did you mean gears?"]),
        (["--set", "gears.module=2"], ["gears.module: ", '"2" has no unit', "100 mm"]),
        (["--set", "gears.module=-2 mm"], ["gears.module: ", '"-2 mm"', "100 mm"]),
        (["--set", "gears.module.a=2 mm"], ["gears.module.a: ", '"module" is a value']),
        (["--set", "gears.teeth.3=20"], ["gears.teeth.3: ", "no gear 3; use 1 or 2"]),
        (
            ["--set", "materials.gear_2=POM-H", "--set", "operation.temperature=110 degC"],
            [
                "materials.gear_2: the modulus of POM-H is known from -40 degC to 100 degC",
                "110 degC",
            ],
        ),
        (
            ["--set", "gears.teeth.1=1"],
            ["gears.teeth: ", "gear 1 was given 1 teeth", "2 or more"],
        ),
        (["--set", "gears=3"], ["gears: ", "3 was given where a table belongs"]),
        (["--set", "operation.torque=[1, 2]"], ["operation.torque: ", "the list [1, 2]"]),
        (["--set", f"operation.torque={'9' * 5000}"], ["operation.torque: ", "1e+08 N m"]),
        (["--set", f"operation.torque={'[' * 5000}"], ["operation.torque: ", "1e+08 N m"]),
        (["--set", f"a{'.a' * 1500}=1"], ["bad.toml: a.a.a", "nested more than 16 levels"]),
        (
            ["--set", f"operation.torque={'[' * 400}{']' * 400}"],
            ["operation.torque: is nested more than 16 levels deep"],
        ),
        (["--set", "gears.family=[1]"], ["gears.family: the list [1]", "'cylindrical' or 'strain"]),
        (["--set", "gears.family={a=1}"], ["gears.family: the table { a = 1 }", "'cylindrical'"]),
        (["--set", f"{'k' * 100_000}=1"], ["kkk...: is not a known key"]),
        (["--set", f"gears.{'k' * 100_000}=1"], ["gears.kkk", "kkk...: is not a known key"]),
        (["--set", f"gears.module={'k' * 100_000}"], ["gears.module: ", "too long", "100 mm"]),
        (["--set", f"lubricant.name={'k' * 100_000}"], ["kkk...", "known are"]),
        (["--set", "k" * 100_000], ["--set: ", "kkk...", "KEY=VALUE"]),
        (["--sweep", "k" * 100_000], ["--sweep: ", "kkk...", "KEY=START:STOP:COUNT"]),
        (
            ["--sweep", f"{'k' * 100_000}=1:2:3"],
            ["--sweep: ", "kkk...", "is not KEY=START:STOP:COUNT"],
        ),
        (["--variant", "k" * 100_000], ["variants: ", "kkk..."]),
        ([f"--{'k' * 100_000}"], ["No such option: --kkk"]),
        (["--set", "gears.teeth=plenty"], ["gears.teeth: ", 'write a whole number like "20"']),
        (["--set", "lubricant.name=PAO VG 15"], ["lubricant.name: ", "did you mean pao-vg-150 "]),
        (["--set", "materials.gear_2=pom"], ["materials.gear_2: ", "did you mean POM-H?"]),
        (["--set", "materials.gear_2=Stel"], ["materials.gear_2: ", "did you mean steel "]),
        (["--set", "models.friction=Xu 2006"], ["models.friction: ", "did you mean xu_2007?"]),
        (["--set", "operation.torque=600 kp cm"], ["operation.torque: ", "kgf cm"]),
        (["--set", "operation.torque"], ["--set: ", "operation.torque", "KEY=VALUE"]),
        (["--set", "=3"], ["--set: ", "=3", "KEY=VALUE"]),
        (["--set", ""], ["--set: ", "KEY=VALUE"]),
        (["--set", ".=3"], ["bad.toml: ", "known are", "gears"]),
        (["--set", "variants.a.b=3"], ["variants: ", "known", "gears"]),
        (["--sweep", "gears.modul=1 mm:2 mm:3"], ["--sweep: gears.modul: ", "module"]),
        (["--sweep", "gears.module=1:2 mm:3"], ["--sweep: gears.module: ", '"1" has no unit']),
        (["--sweep", "gears.module=1 mm:2 kg:3"], ["--sweep: gears.module: ", '"2 kg"', "100 mm"]),
        (["--sweep", "gears.module=1 mm:2 mm:0"], ["--sweep: ", "1 mm:2 mm:0", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm:100001"], ["--sweep: ", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm:²"], ["--sweep: ", "1 to 100000"]),
        (["--sweep", "gears.module=1 mm:2 mm"], ["--sweep: ", "KEY=START:STOP:COUNT"]),
        (["--sweep", "gears.module"], ["--sweep: ", "KEY=START:STOP:COUNT"]),
        (["--sweep", "=1 mm:2 mm:3"], ["--sweep: ", "known are", "gears"]),
        (["--sweep", "operation.driver=1:2:3"], ["--sweep: operation.driver: ", "no number"]),
        (
            ["--sweep", "title=1:2:3"],
            ["--sweep: title: cannot be swept", "gears, stages, materials"],
        ),
        (["--sweep", "models.friction=1:2:3"], ["--sweep: models.friction: cannot be swept"]),
        (["--sweep", "gears.addendum=1:2.1:3"], ["--sweep: at gears.addendum = 2.1: ", "2.158"]),
        (
            ["--set", "gears.family=worm"],
            ["no family of gears of Pitchpoint; pitchpoint docs not_included"],
        ),
        (["--set", "gears.family=harmonic drive"], ["gears.family: ", "did you mean strain_wave?"]),
        (["--set", "torque=50 N m"], ["torque: ", "[operation] and [loss_map] have that key"]),
        (["--set", "friction=xu_2007"], ["friction: ", "[models] has that key"]),
        (["--set", "gears.film=true"], ["gears.film: ", "[film] is a table of its own"]),
        (
            ["--set", "models.friction=0.05"],
            ["models.friction: ", 'write { name = "constant", coefficient = 0.05 }'],
        ),
        (["--set", "models.friction=coulomb"], ["models.friction: ", "did you mean constant?"]),
        (["--set", "materials.gear_1=16MnCr5"], ["materials.gear_1: ", "case-hardened-mq?"]),
        (
            ["--set", "strength.accuracy_class=A6"],
            ["strength.accuracy_class: ", 'a whole number like "3"; allowed is 3 to 8'],
        ),
        (["--set", "strength.safety=1.3"], ["strength.safety: ", "safeties are results"]),
        (
            ["--set", "loss_map={ quadrants = 4, lowest_speed = '5000 rpm' }"],
            ["loss_map.lowest_speed: 5000 rpm was given; allowed is less than the largest speed"],
        ),
        (["--bogus"], ["No such option: --bogus; see pitchpoint run --help"]),
        (["--variant"], ["--variant", "requires an argument; see pitchpoint --help"]),
        (["--variant", "x"], ["this case has no variants", "[variants.x.operation]"]),
        (["--set", "lubricant.name=Omala 7"], ["any other oil is given by base, viscosity_40"]),
        (["--set", "roughness.ra=N6"], ["roughness.ra: ", "grade N6 is Ra 0.8 um"]),
        (["--set", "roughness.ra=Rz 4"], ["roughness.ra: ", "Ra is about Rz/6"]),
        (["--set", "strength.life=infinite"], ["leave life out for teeth that are to endure"]),
        (["--set", "operation.torque=-60 N m"], ["which member drives says driver"]),
        (["--set", "operation.torque=['1 N m', '2 N m']"], ["--sweep operation.torque="]),
        (["extra"], ["extra", "see pitchpoint run --help"]),
    ],
    ids=lambda given: " ".join(given)[:50],
)
def test_command_lines(
    arguments: list[str], words: list[str], refuse: Callable[..., str], tmp_path: Path
) -> None:
    told = refuse("run", written(tomllib.loads(PAIR), tmp_path), *arguments)
    for word in words:
        assert word in told
    assert not (tmp_path / "results").exists()


def test_a_page_that_cannot_be_written_is_refused_before_its_designs_are_computed(
    refuse: Callable[..., str], tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    told = refuse("explore", written(tomllib.loads(PAIR), tmp_path), "-o", tmp_path / "file/x.html")
    assert "cannot be written to: a file stands where a folder belongs" in told
    assert "designs" not in told


def test_no_such_command(refuse: Callable[..., str]) -> None:
    assert "No such command 'frobnicate'" in refuse("frobnicate")
    assert "Missing argument 'CASE'" in refuse("run")


OTHER_CALLS = {
    "report out": "pitchpoint open FOLDER opens it",
    "validate pair.toml": "pitchpoint check CASE",
    "help": "pitchpoint docs",
    "-o out run pair.toml": "options stand behind the command: pitchpoint run CASE -o FOLDER",
    "run pair.toml --set": '; write --set operation.torque="50 N m"',
    "run pair.toml other.toml": "it takes one case, pitchpoint compare several",
    "show": "a name out of pitchpoint cases",
    "optimise tian2024": "table [optimise] of the case or by option: --vary gears.face_width=",
    "study tian2024": 'table [study] of the case or by option: --over operation.torque="20 N m:90 N m:8"',
    "models steel oil": "it takes one kind or name, such as friction",
    "cases tian": "pitchpoint show CASE has the inputs of one",
    "new wolfrom": "did you mean 3K?",
    "new spur --ratio 3": "is for strain_wave, planetary and 3K; leave it out for spur",
    "new planetary --ratio 2": "2 is no ratio of one planetary set with 3 planets, which reaches",
    "new planetary --torque 5": "goes with --ratio",
    "new planetary --ratio 5/1": '--ratio: "5/1" is no ratio; write the input over the output',
    "new harmonic --ratio 100": "is no family of gears; did you mean strain_wave?",
    "compare pair.toml vs other.toml": "vs is no design; name them one after the other",
    "compare pair.toml,other.toml": "is no design; name them one after the other",
    "new pair.toml": "'pair.toml' is a file and no family of gears; write new spur -o FILE",
}


@pytest.mark.parametrize("called", OTHER_CALLS)
def test_commands_as_others_have_them_are_told_what_to_call(
    called: str, refuse: Callable[..., str]
) -> None:
    assert OTHER_CALLS[called] in refuse(*called.split())


def test_a_study_that_goes_wrong_half_way() -> None:
    tree = tomllib.loads(PAIR)
    sweep = {"key": "gears.profile_shift.1", "values": [0.0, 1.4, 0.1]}
    tree["studies"] = {"shift": {"sweep": sweep}}
    tree["gears"]["teeth"] = [12, 61]
    made = jobs(Variant(tree, "bad.toml", "default"), {})
    study = next(job for job in made if job.name == "study_shift")
    with pytest.raises(InputError) as caught:
        study.compute(study.pieces[0])
    told = str(caught.value)
    assert "bad.toml: studies.shift.sweep: at gears.profile_shift.1 = 1.4: " in told
    assert "gears.addendum: the tip circle of gear 1" in told
    assert "it may be" in told


def test_a_change_that_goes_wrong(refuse: Callable[..., str], tmp_path: Path) -> None:
    tree = tomllib.loads(PAIR)
    tree["studies"] = {"hot": {"change": {"operation": {"temperature": "200 degC"}}}}
    told = refuse("show", written(tree, tmp_path))
    assert "bad.toml: studies.hot: operation.temperature: 200 degC is outside" in told
    tree["studies"] = {"hot": {"change": {"operation": {"temperatur": "90 degC"}}}}
    told = refuse("show", written(tree, tmp_path))
    assert "studies.hot: operation.temperatur: is not a known key; did you mean temperature" in told


def test_a_folder_that_cannot_be_written(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    (tmp_path / "file").write_text("in the way")
    told = refuse("run", path, "-o", tmp_path / "file")
    assert f"{tmp_path / 'file'}: cannot be written to: " in told
    assert "file/in/it: cannot be written to: " in refuse(
        "run", path, "-o", tmp_path / "file/in/it"
    )
    assert (tmp_path / "file").read_text() == "in the way"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(refuse: Callable[..., str], tmp_path: Path) -> None:
    path = written(tomllib.loads(PAIR), tmp_path)
    (tmp_path / "closed").mkdir(mode=0o500)
    assert "cannot be written to: Permission denied" in refuse(
        "run", path, "-o", tmp_path / "closed"
    )


# ---- the same from outside


@pytest.mark.parametrize(
    ("content", "arguments", "words"),
    [
        (PAIR.replace('"2 mm"', '"[bold]2 mm[/bold]"'), [], ['"[bold]2 mm[/bold]"', "100 mm"]),
        (PAIR, ["--bogus"], ["No such option: --bogus"]),
    ],
    ids=["markup", "option"],
)
def test_a_process(content: str, arguments: list[str], words: list[str], tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text(content)
    command = [
        sys.executable,
        "-c",
        "from pitchpoint.cli import main; main()",
        "run",
        "bad.toml",
        *arguments,
    ]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    for word in words:
        assert word in done.stderr
