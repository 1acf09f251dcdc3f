"""A sound case of every family and kind of drive: together they have every table of the schema."""

import copy
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from pitchpoint.cases.document import resolve
from pitchpoint.cases.drive_schema import TrainTable
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.validation import validated
from pitchpoint.cases.worn import gears_digest
from pitchpoint.duty_cycle import duty_table
from pitchpoint.gears import planetary
from pitchpoint.gears.ball_on_disc import table as ball_on_disc
from pitchpoint.gears.rack_and_pinion import table as rack_and_pinion
from pitchpoint.gears.strain_wave import table as strain_wave
from pitchpoint.gears.torus import table as torus
from pitchpoint.lubrication.ehl.film_tables import HeightTables
from pitchpoint.materials.material_tables import DriveMaterials
from pitchpoint.published.atanasiu2011.table import PairInMotion
from pitchpoint.published.tian2024.table import PairOnPath
from pitchpoint.published.xu2021.table import ZoneFilms
from pitchpoint.published.zhao2022.table import ConjugateWear, FlankWear
from pitchpoint.results.store import dataset, save
from pitchpoint.wear.wear_tables import WornTable

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
""".replace("HEIGHTS", str(Path(__file__).parent / "cli" / "heights.csv"))
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
        gears=gears_digest(validated(CaseFile, document).gears),
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
THREE_K = {**PLANETARY, "gears": {**PLANETARY["gears"], "teeth": [18, 36, 90], "second": SECOND}}
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
    ("cylindrical", CaseFile, ()),
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
    ("rig", HeightTables, ("film", "heights")),
    ("worn", WornTable, ("worn",)),
    ("duty", duty_table.DutyTable, ("duty",)),
    ("planetary", planetary.PlanetaryGears, ("gears",)),
    ("materials of a set", DriveMaterials, ("materials",)),
    ("drawings of a set", planetary.InspectionOfSet, ("gears", "inspection")),
    ("3K", planetary.SecondGears, ("gears", "second")),
    ("train", TrainTable, ("train",)),
]
"""Sound case, table and its place: together every table of the schema."""
