"""Overlaps of teeth as the checks measure them, against polygons of gears that racks have cut."""

import numpy as np
import pytest
from polygons import Gear, deepest

from pitchpoint.gears.cylindrical.checks import _measure
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair

CLEAR = {
    "external": {"teeth": (23, 61)},
    "helical": {"teeth": (23, 61), "helix_angle": 0.44, "profile_shift": (0.3, -0.1)},
    "undercut": {"teeth": (10, 40)},
    "long and short": {"teeth": (20, 40), "addendum": (1.2, 0.8)},
    "ring": {"teeth": (20, -50), "addendum": (1.0, 0.8)},
}
OVERLAPPING = {
    "planet 22/61": {"teeth": (22, -61)},
    "planet 18/48": {"teeth": (18, -48)},
    "few teeth more": {"teeth": (45, -50), "profile_shift": (0.0, -0.2)},
}
SOME = [
    pytest.param(one, marks=[pytest.mark.whole] * (one == "few teeth more")) for one in OVERLAPPING
]


def numbers(gear):
    """What a drawing has of a gear."""
    return Gear(
        teeth=round(float(gear.teeth)),
        shift=float(gear.profile_shift),
        dedendum=float(gear.dedendum),
        fillet=float(gear.fillet_radius),
        tip=abs(float(gear.tip_radius / gear.module)),
        angle=float(gear.pressure_angle),
        helix=float(gear.helix_angle),
    )


def both(**gears):
    """Deepest overlap of polygons and as measured, in modules."""
    gears |= {"module": 2e-3, "pressure_angle": np.pi / 9.0, "face_width": 0.02}
    if gears["teeth"][1] < 0:
        gears["fillet_radius"] = (0.38, 0.2)
    mesh = build_cylindrical_pair(**gears)
    distance = abs(float(mesh.centre_distance / mesh.module))
    phases = 12 if gears["teeth"] != (45, -50) else 4  # many of their teeth are in each other
    found = deepest(*map(numbers, mesh.gears), distance, phases)
    return found, max(float(gear.fillet_overlap) for gear in _measure(mesh)[1])


@pytest.mark.parametrize("name", CLEAR)
def test_polygons_of_pairs_that_pass_only_touch(name):
    found, measured = both(**CLEAR[name])
    assert found < 2e-5 and measured < 1e-9


@pytest.mark.parametrize("name", SOME)
def test_polygons_overlap_by_what_is_measured(name):
    """Measured along circles, that of polygons along the normal, which leans by the angle of pressure."""
    found, measured = both(**OVERLAPPING[name])
    assert measured > 0.002
    assert found == pytest.approx(measured * np.cos(np.pi / 9.0), rel=0.03)


def test_a_tip_that_just_enters_is_seen():
    """A judge that sees nothing would pass the pairs that only touch."""
    closer = {**CLEAR["external"], "centre_distance": 0.084 - 2e-6}
    found, _ = both(**closer)
    assert found == pytest.approx(2.0 * 1e-3 * np.sin(np.pi / 9.0), rel=0.05)
