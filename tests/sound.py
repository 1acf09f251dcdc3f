"""Cases and pairs that several files take as a sound beginning."""

import numpy as np
import pytest

from pitchpoint.gears.cylindrical.design import build_cylindrical_pair

PAIR = """
[gears]
teeth = [23, 61]
module = "2 mm"
face_width = "20 mm"
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
torque = "50 N m"
speed = "1500 rpm"
temperature = "60 degC"
"""
"""The shortest case file of a pair."""

SMOOTH = """
[gears]
teeth = [23, 61]
module = "2 mm"
face_width = "15 mm"
profile_shift = [0.4, -0.2]
[lubricant]
base = "mineral"
viscosity_40 = "220 mm2/s"
viscosity_100 = "19 mm2/s"
[roughness]
rq = "0.1 um"
[operation]
torque = "60 N m"
speed = "900 rpm"
temperature = "60 degC"
"""
"""One whose smooth flanks and thick oil have every friction law in its range."""

WAVE = """
[gears]
family = "strain_wave"
teeth = [200, 202]
module = "0.3 mm"
face_width = "10 mm"
[lubricant]
name = "pao-vg-100"
[roughness]
ra = "0.4 um"
[operation]
torque = "67 N m"
speed = "2000 rpm"
temperature = "40 degC"
"""
"""That of a strain wave gear."""


class OnDemand(dict):
    """Values by key, each made when it is first asked for."""

    def __init__(self, make):
        super().__init__()
        self.make = make

    def __missing__(self, key):
        self[key] = self.make(key)
        return self[key]


def quick_first(values, count=1):
    """Values of parameters of which all but the first are marked `whole`."""
    several = [value if isinstance(value, tuple) else (value,) for value in values]
    marks = [[pytest.mark.whole] * (number >= count) for number in range(len(several))]
    return [pytest.param(*value, marks=mark) for value, mark in zip(several, marks, strict=True)]


def pair(teeth, degrees=0.0, module=3e-3, width=20e-3, **options):
    """A cylindrical pair of 20 deg by teeth, helix [deg], module and face width [m]."""
    return build_cylindrical_pair(
        teeth=teeth,
        module=module,
        pressure_angle=np.deg2rad(20.0),
        helix_angle=np.deg2rad(degrees),
        face_width=width,
        **options,
    )


def wave_rates(teeth: tuple[float, float], fixed: int, drives: int) -> np.ndarray:
    """Rates of wave generator, flexspline and circular spline by z2 q_C = z1 q_F + (z2 - z1) q_W, by hand."""
    law, loaded = np.array([teeth[1] - teeth[0], teeth[0], -teeth[1]]), 3 - fixed - drives
    motion = np.zeros(3)
    motion[drives] = np.sign(law[drives])
    motion[loaded] = -law[drives] * motion[drives] / law[loaded]
    return motion
