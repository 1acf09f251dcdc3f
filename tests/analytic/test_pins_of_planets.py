"""Pins of planets as springs in the torsional stiffness: closed forms, and the equilibrium of springs."""

from functools import cache

import numpy as np
import pytest

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.torsion import mesh_slopes
from pitchpoint.drive.kinematics import HOUSING
from pitchpoint.errors import InputError
from pitchpoint.runs.run import load_case

TABLES = {
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "60 N m", "speed": "3000 rpm", "temperature": "60 degC"},
    "models": {
        "friction": {"name": "constant", "coefficient": 0.05},
        "load_sharing": "from_stiffness",
    },
}
SET = {
    "family": "planetary",
    "teeth": [24, 30, 84],
    "planets": 3,
    "module": "1 mm",
    "face_width": "12 mm",
}
RADIUS, PIN = 27e-3, 20e6
STEPPED = {**SET, "teeth": [18, 36], "second": {"teeth": [24, 78], "face_width": "12 mm"}}
THREE_K = {
    **SET,
    "teeth": [18, 36, 90],
    "second": {"teeth": [34, 88], "face_width": "12 mm", "module": "1 mm"},
}
SETS = {
    "carrier": SET,
    "ring": SET | {"output": "ring", "held": "carrier"},
    "ring, sun held": SET | {"input": "carrier", "output": "ring", "held": "sun"},
    "sun": SET | {"input": "carrier", "output": "sun"},
    "stepped": STEPPED,
    "3K": THREE_K,
}


@cache
def set_of(name, pins):
    more = {"pin_stiffness": "20 N/um"} if pins else {}
    return load_case({"gears": SETS[name] | more, **TABLES})


@cache
def torsion(name, pins):
    return ANALYSES["torsion"].compute(set_of(name, pins), {}, lambda *_: None)


def compliance(name, pins):
    """Turn of the output for a unit on it at the load, by the slope."""
    return 1.0 / torsion(name, pins)["tangent_torsional_stiffness"].sel(torque=60.0).item()


def by_springs(name, pin=PIN):
    """The same from the equilibrium of springs: bodies turn, each planet also shifts along its circle."""
    built = set_of(name, pins=False)
    train, slopes = built.design, mesh_slopes(built)
    bodies = [body for body in train.rates if body != HOUSING]
    moving = [body for body in bodies if body not in (*train.held, train.turned)]
    place = {body: number for number, body in enumerate(moving)}
    carrier, count = built.case.train.carrier, built.planets
    stiffness = np.zeros((len(moving) + 1,) * 2)
    stiffness[-1, -1] = count * pin
    for mesh, slope in zip(train.meshes, slopes, strict=True):
        base = np.asarray(mesh.design.mesh.base_radii)
        closing = np.zeros(len(moving) + 1)
        for body, radius in zip(mesh.bodies, base, strict=True):
            if body in place:
                closing[place[body]] += radius
        # A planet that shifts ahead by v does what its carrier would, turned by v over the radius.
        if carrier in place:
            closing[place[carrier]] -= base.sum()
        closing[-1] -= base.sum() / float(built.meshes[0].dimensions["centre_distance"])
        driven = np.abs(np.asarray(mesh.design.loaded)) > 0.0
        normal = slope / float(np.abs(base[driven][0])) ** 2
        stiffness += count * normal * np.outer(closing, closing)
    load = np.zeros(len(moving) + 1)
    load[place[train.loaded]] = 1.0
    return np.linalg.solve(stiffness, load)[place[train.loaded]]


WHOLE = ("stepped", "3K")
"""Sets with programs of their own."""


def each(*rows):
    """Rows of a test, those of sets with programs of their own in the longer part of the suite."""
    marked = [(row, [pytest.mark.whole] if row[0] in WHOLE else []) for row in rows]
    return [pytest.param(*row, marks=marks) for row, marks in marked]


@pytest.mark.parametrize("name", each(*((name,) for name in SETS)))
def test_pins_yield_as_by_the_equilibrium_of_all_springs(name):
    assert compliance(name, pins=True) == pytest.approx(by_springs(name), rel=1e-7)
    assert compliance(name, pins=False) == pytest.approx(by_springs(name, pin=1e22), rel=1e-7)


@pytest.mark.parametrize(
    ("name", "step"),
    each(
        ("carrier", 1.0 / RADIUS),
        ("ring", (1.0 + 24 / 84) / RADIUS),
        ("ring, sun held", (1.0 + 24 / 84) / RADIUS),
        ("sun", (1.0 + 84 / 24) / RADIUS),
        ("stepped", 1.0 / RADIUS),
        ("3K", 0.0),
    ),
)
def test_pins_are_springs_side_by_side_behind_the_teeth(name, step):
    """Force on all pins is the torque of the carrier over their radius; that of a free carrier is none."""
    added = compliance(name, pins=True) - compliance(name, pins=False)
    assert added == pytest.approx(step**2 / (3 * PIN), rel=1e-7, abs=1e-15)
    soft, rigid = torsion(name, pins=True), torsion(name, pins=False)
    turned = (soft["wind_up"] - rigid["wind_up"]) / soft["torque"]
    assert turned.values[1:] == pytest.approx(added, rel=1e-7, abs=1e-15)


def test_what_yields_says_whether_pins_do():
    yields = torsion("carrier", pins=True)["torsional_stiffness"].attrs["covers"]
    assert "pins of the planets" in yields
    assert torsion("carrier", pins=False).attrs["brief"].startswith("pins of the planets, shafts")
    assert "pins" not in torsion("carrier", pins=True).attrs["brief"]
    assert set_of("3K", pins=True).pin_compliance == 0.0
    parts = torsion("carrier", pins=True)
    assert parts["wind_up_part"].sum("part").values == pytest.approx(parts["wind_up"].values)


@pytest.mark.whole
def test_pins_that_bear_nothing_are_said_to_count_for_nothing():
    assert "pin_stiffness does not count" in torsion("3K", pins=True).attrs["left_out"]


@pytest.mark.whole
def test_pins_of_a_stage_yield_at_the_output_of_the_drive():
    """Behind a set a pair of ratio i: its pins bear 1/i of the load and turn the output by 1/i of that."""
    pair = {"teeth": [23, 61], "module": "2 mm", "face_width": "20 mm"}

    def drive(more):
        stages = [{"gears": SET | more}, {"gears": pair}]
        built = load_case({"stages": stages, **TABLES})
        return ANALYSES["torsion"].compute(built, {}, lambda *_: None)

    rigid, soft = drive({}), drive({"pin_stiffness": "20 N/um"})
    added = (soft["stage_wind_up"] - rigid["stage_wind_up"]).sel(torque=60.0)
    onward = 23 / 61
    expected = 60.0 * onward**2 / (3 * PIN * RADIUS**2)
    # Stage 1 is the set: per unit at the output its carrier bears `onward`, and its turn counts by the same.
    assert added.values == pytest.approx([expected, 0.0], rel=1e-7, abs=1e-18)


def test_a_floating_body_without_errors_of_pins_is_still_refused():
    with pytest.raises(InputError, match="counts where pins are out of place"):
        load_case({"gears": SET | {"floating": "sun", "pin_stiffness": "20 N/um"}, **TABLES})
