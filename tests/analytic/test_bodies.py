"""Masses and moments of inertia of bodies: closed forms, those that a vibration takes, and of catalogues."""

import copy
import re
import tomllib
from math import isnan, pi

import numpy as np
import pytest
from sound import WAVE

from pitchpoint._jax import array
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.bodies import bodies_of
from pitchpoint.cases.variant import Variant
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.gears.mesh_bodies import plain_inertia
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.gears.torus.table import TorusGears

STEEL = 7830.0


def built(tree):
    return Variant(tree, "case", "default").built({})


def bodies(tree):
    data = bodies_of(built(tree), {}, lambda *_: None)
    return data["body_mass"].values, data["body_inertia"].values


@pytest.mark.parametrize("table", [RackAndPinionGears, TorusGears])
def test_gears_are_the_discs_that_a_vibration_takes(table):
    tree = tomllib.loads(sample_of(table).read_text())
    made = built(tree)
    densities = array([float(solid.density) for solid in made.design.solids])
    taken = np.asarray(plain_inertia(made.design.mesh, densities))
    mass, inertia = bodies(tree)
    if table is RackAndPinionGears:
        assert mass[1] == taken[1] and isnan(inertia[1])  # it travels
        assert inertia[0] == pytest.approx(taken[0], rel=1e-12)
    else:
        assert inertia == pytest.approx(taken, rel=1e-12)


def test_what_is_felt_at_the_ends_is_all_that_turns_by_its_ratio():
    """Of a pair J_1 + J_2/i^2 at the input and that times i^2 at the output."""
    tree = tomllib.loads(sample_of(TorusGears).read_text())
    found = bodies_of(built(tree), {}, lambda *_: None)
    first, second = found["body_inertia"].values
    ratio = np.divide(*tree["gears"]["teeth"][::-1])
    at_input = first + second / ratio**2
    assert found["reflected_inertia"].values == pytest.approx([at_input, at_input * ratio**2])
    travels = bodies_of(built(tomllib.loads(sample_of(RackAndPinionGears).read_text())), {}, print)
    assert "reflected_inertia" not in travels


def test_a_rack_without_a_mass_has_none():
    tree = tomllib.loads(sample_of(RackAndPinionGears).read_text())
    del tree["gears"]["mass"]
    tree.pop("dynamics", None)
    assert isnan(bodies(tree)[0][1])


def drive(**gears):
    tree = copy.deepcopy(tomllib.loads(WAVE))
    tree["gears"] = {"family": "strain_wave", "teeth": [200, 202], "module": "0.3 mm"} | gears
    return tree


@pytest.mark.whole
def test_parts_of_a_strain_wave_gear():
    """A drive of 60 mm by its volumes, worked out beside the code."""
    mass, inertia = bodies(
        drive(
            face_width="10 mm",
            flexspline={
                "rim_thickness": "0.6 mm",
                "wall_thickness": "0.3 mm",
                "cup_length": "30 mm",
            },
            yielding={"outside_diameter": "80 mm", "bottom_thickness": "0.5 mm"},
        )
    )
    spline = STEEL * pi * 0.01 * (0.04**2 - 0.0303**2)
    assert mass[2] == pytest.approx(spline, rel=1e-12)
    assert inertia[2] == pytest.approx(spline * (0.04**2 + 0.0303**2) / 2.0, rel=1e-12)
    middle = float(built(drive(face_width="10 mm")).design.mesh.rim.radius)
    # Tube and bottom of thin walls, a toothed ring: to the order of their thickness over the radius.
    thin = (
        2.0 * pi * middle * 0.01 * (0.03 - middle + 0.0003)
        + 2.0 * pi * middle * 0.03 * 0.0003
        + pi * middle**2 * 0.0005
    )
    assert mass[1] == pytest.approx(STEEL * thin, rel=0.05)
    # Balls of 4.68 mm on a circle of 52.2 mm round a plug that carries them, on a shaft of 10.2 mm.
    within = middle - 0.0003
    circle = 2.0 * within - 2.0 * 0.00075 - 0.00468
    plug = STEEL * pi * 0.01 * (((circle - 0.00468) / 2.0) ** 2 - 0.0051**2)
    balls = 23 * STEEL * pi / 6.0 * 0.00468**3
    race = STEEL * pi * 0.01 * (within**2 - (within - 0.00075) ** 2)
    assert mass[0] == pytest.approx(plug + balls + race, rel=1e-12)
    cage = (1.0 - 0.00468 / circle) / 2.0
    of_plug = plug * (((circle - 0.00468) / 2.0) ** 2 + 0.0051**2) / 2.0
    assert inertia[0] == pytest.approx(of_plug + balls * (cage * circle / 2.0) ** 2, rel=1e-12)


@pytest.mark.whole
@pytest.mark.parametrize(
    ("diameter", "width", "expected"), [(35.6e-3, 7e-3, 0.033e-4), (63.5e-3, 10e-3, 0.413e-4)]
)
def test_wave_generators_are_near_those_of_catalogues(diameter, width, expected):
    """Component sets of sizes 14 and 25, moments of inertia [kg m2]; widths assumed, that of 25 recalled."""
    gears = {"module": f"{1e3 * diameter / 200} mm", "face_width": f"{1e3 * width} mm"}
    assert bodies(drive(**gears))[1][0] == pytest.approx(expected, rel=0.35)


@pytest.mark.whole
def test_which_gears_have_bodies():
    told = {
        table.__name__: ANALYSES["bodies"].why_not(
            built(tomllib.loads(sample_of(table).read_text()))
        )
        for table in TABLES
    }
    assert [name for name, why in told.items() if why is None] == [
        "StrainWaveGears",
        "RackAndPinionGears",
        "TorusGears",
    ]
    assert "drawing" in told["CylindricalGears"] and "test rig" in told["BallOnDiscRig"]


def test_a_rim_is_judged_by_what_its_material_bears():
    """Of steel by usual cups; of plastic by the strain of its wave, silent with the rim that is told."""

    def told(young, thickness, **cup):
        tree = drive(teeth=[68, 70], module="0.9 mm", face_width="12 mm")
        tree["gears"]["flexspline"] = cup or {"rim_thickness": thickness}
        tree["materials"] = {"gear_1": {"young": young, "poisson": 0.36}}
        return [text for text in built(tree).warnings if "rim" in text]

    assert told("3.3 GPa", "1.2 mm") == []
    (steel,) = told("206 GPa", "1.2 mm")
    assert "usual for cups of steel of its size and its wave are 0.26 mm" in steel
    (soft,) = told("3.3 GPa", "3.6 mm")
    within = re.search(r"strains the rim of the flexspline by (\S+) %,.* 0\.5 % .*: (\S+) mm", soft)
    assert float(within[1]) == pytest.approx(0.57, abs=0.06)
    assert told("3.3 GPa", f"{0.95 * float(within[2])} mm") == []
    (thin,) = told("3.3 GPa", "0.26 mm")
    assert "usual for cups of plastic of its size and its wave are 1.22 mm" in thin
    # Left open it is that of steel cups, which is told of one of plastic; by 6 w0 t/d^2, with w0 of a module.
    (left_open,) = told("3.3 GPa", None, walls="bending strain")
    assert f"is {3.75e-4 * 68.0**2 * 0.9 / 6.0:.3g} mm thick" in left_open
    assert f'are {0.02 * 68.0 * 0.9:.3g} mm, which walls = "bending strain of plastic"' in left_open
    assert told("3.3 GPa", None, walls="bending strain of plastic") == []
    assert told("206 GPa", None, walls="bending strain") == []
    (foreign,) = told("206 GPa", None, walls="bending strain of plastic")
    assert 'which walls = "bending strain" takes' in foreign
    *_, light = told("71 GPa", "1.6 mm")
    assert "metals are taken to bear 0.2 % in alternating bending, as steel does" in light
