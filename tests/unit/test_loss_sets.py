"""Losses by the name of a set: constants as data, scaled to the gears, told with their marks."""

from dataclasses import replace

import numpy as np
import pytest

from pitchpoint.analyses.running import _of_set, running_axes
from pitchpoint.cases.document import resolve
from pitchpoint.cases.loss_sets import loss_sets, marks_of
from pitchpoint.cases.validation import validate
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.gears.strain_wave.ball_bearing import Balls, ball_circle
from pitchpoint.gears.strain_wave.design import build_strain_wave

NAME, PLACE = "strain_wave_component", "wave_generator_bearing"
TREE = {
    "gears": {
        "family": "strain_wave",
        "teeth": [200, 202],
        "module": "0.3 mm",
        "face_width": "10 mm",
    },
    "lubricant": {"name": "pao-vg-100"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "67 N m", "speed": "2000 rpm", "temperature": "40 degC"},
    "losses": {"set": NAME},
}
TERMS = loss_sets()[NAME].places[PLACE]


def losses(tree=TREE, **settings):
    document = resolve(tree, name="drive.toml", variant="default", settings=settings)
    return validate(document).losses


def constants(key):
    return [term.value for term in TERMS[key]]


def test_one_line_names_all_losses():
    (place,) = losses()
    found = losses()[place]
    assert place == PLACE
    assert found.mean_diameter == pytest.approx(constants("mean_diameter")[0] * 60e-3, rel=1e-14)
    for key in ("f0", "f1"):
        of_round, grown = constants(key)
        assert getattr(found, key) == pytest.approx(of_round + grown / 200.0, rel=1e-14)
    assert found.breakaway_dry == constants("breakaway_dry")[0]
    assert found.breakaway_preload == pytest.approx(1.0)


def test_constants_scale_with_size_and_deflection():
    plain = losses()[PLACE]
    large = losses(**{"gears.module": "0.6 mm"})[PLACE]
    assert large.mean_diameter == pytest.approx(2.0 * plain.mean_diameter, rel=1e-14)
    same = ("f0", "f1", "breakaway_dry", "breakaway_viscous", "breakaway_preload")
    assert all(getattr(large, key) == getattr(plain, key) for key in same)
    fewer = losses(**{"gears.teeth": [100, 102], "gears.module": "0.6 mm"})[PLACE]
    assert fewer.mean_diameter == pytest.approx(plain.mean_diameter, rel=1e-14)
    assert fewer.breakaway_preload == pytest.approx(2.0)
    wider = losses(**{"gears.wave_generator": {"deflection": 2.0}})[PLACE]
    for key in ("f0", "f1", "breakaway_preload"):
        assert getattr(wider, key) == pytest.approx(getattr(fewer, key), rel=1e-14)


def test_values_of_the_case_stand_before_those_of_the_set():
    seal = {"between": ["wave generator", "housing"], "seal_torque": "10 mN m"}
    own = {"set": NAME, PLACE: {"f0": 3.0}, "seal": seal}
    found = losses({**TREE, "losses": own})
    assert [*found] == [PLACE, "seal"]
    assert found[PLACE].f0 == 3.0
    assert found[PLACE].f1 == losses()[PLACE].f1


def test_a_place_may_be_named_set():
    seal = {"between": ["wave generator", "housing"], "seal_torque": "10 mN m"}
    assert [*losses({**TREE, "losses": {"set": seal}})] == ["set"]


def test_a_stage_names_a_set():
    tree = {key: TREE[key] for key in ("lubricant", "roughness", "operation")}
    gears = {"teeth": [23, 61], "module": "1 mm", "face_width": "9 mm"}
    second = {"gears": TREE["gears"], "losses": {"set": NAME}}
    document = resolve({**tree, "stages": [{"gears": gears}, second]}, name="", variant="default")
    assert [*validate(document).stages["2"].losses] == [PLACE]


def test_a_sealed_drive_has_a_seal_on_either_shaft_which_its_file_replaces():
    """Of 60 mm: torques by hand; the bearing stays that of the component set."""
    sealed = losses({**TREE, "losses": {"set": "strain_wave_sealed"}})
    assert [*sealed] == [PLACE, "input_seal", "output_seal"]
    assert sealed[PLACE] == losses()[PLACE]
    assert sealed["input_seal"].seal_torque == pytest.approx(2.5 * 0.06**2)
    assert sealed["output_seal"].breakaway_torque == pytest.approx(20.0 * 0.06**2)
    assert all(place.breakaway_spread == 2.0 for place in sealed.values())
    own = {"breakaway_torque": "30 mN m", "breakaway_spread": 1.2}
    other = losses({**TREE, "losses": {"set": "strain_wave_sealed", "input_seal": own}})
    assert other["input_seal"].breakaway_torque == pytest.approx(0.03)
    assert other["input_seal"].seal_torque == sealed["input_seal"].seal_torque
    open_input = {"set": "strain_wave_sealed", "input_seal": "none"}
    assert [*losses({**TREE, "losses": open_input})] == [PLACE, "output_seal"]
    nothing = {"breakaway_torque": "0 N m", "seal_torque": "0 N m"}
    with pytest.raises(InputError, match='write "none" in place of one that a set has'):
        losses({**TREE, "losses": {**open_input, "input_seal": nothing}})
    with pytest.raises(InputError, match="where a table belongs"):
        losses({**TREE, "losses": {"set": NAME, "input_seal": "none"}})
    marks = marks_of({"set": "strain_wave_sealed"})
    keys = ("seal_torque", "breakaway_torque", "breakaway_spread")
    assert {marks[f"{one}.{k}"].status for one in [*sealed][1:] for k in keys} == {"assumed"}
    assert loss_sets()["strain_wave_sealed"].fitted == loss_sets()[NAME].fitted


def test_the_result_says_how_both_torques_from_rest_stand_to_each_other():
    """4.4 N m at the output against 0.04 N m at the wave generator and a ratio of 100."""
    axes, degrees = ("law", "temperature"), np.array([313.15, 333.15])
    data = {
        "starting_torque": (axes, np.array([[0.04, 0.03]])),
        "back_driving_torque": (axes, np.array([[4.4, 4.0]])),
    }
    built = Variant(TREE, "drive.toml", "default").built({})
    assert _of_set(built, data, degrees).startswith(
        "Driving it backwards takes 1.1 times ratio and"
    )
    assert _of_set(replace(built, fitted=None), data, degrees) == ""


def test_marks_say_how_each_constant_was_come_by():
    marks = marks_of(TREE["losses"])
    fitted = {key for key, mark in marks.items() if mark.status == "fitted"}
    assert fitted == {f"{PLACE}.{key}" for key in ("f0", "f1", "breakaway_dry")}
    assert loss_sets()[NAME].note.startswith("Three constants are fitted")
    assert all(marks[f"{PLACE}.{key}"].status == "assumed" for key in ("mean_diameter",))
    note = marks[f"{PLACE}.f1"].note
    assert "0.0003, assumed" in note
    assert "times the deflection over pitch diameter, fitted" in note
    assert loss_sets()[NAME].sources == ("metzger_2015",)
    assert marks_of({}) == marks_of(None) == {}


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"operation.temperature": "-10 degC", "lubricant.name": "pao-4"}, None),
        ({"operation.temperature": "-20 degC", "lubricant.name": "pao-4"}, "at -20 degC they are"),
        ({"loss_map": {"temperatures": ["40 degC", "60 degC"]}}, "at 60 degC they are"),
    ],
)
def test_losses_beyond_the_temperatures_of_their_fit_are_told(settings, told):
    warnings = Variant(TREE, "drive.toml", "default").built(settings).warnings
    found = [text for text in warnings if "fitted from -10 degC to 40 degC" in text]
    assert len(found) == (told is not None)
    assert all(told in text for text in found)


def test_values_beside_a_named_oil_are_told():
    built = Variant(TREE, "drive.toml", "default").built({"lubricant.viscosity_40": "110 mm2/s"})
    assert built.lubricant.title == "PAO gear oil ISO VG 100 with viscosity_40 of the case file"
    assert built.lubricant.nu_1.note.endswith("those of pao-vg-100 in the catalogue")
    assert any(
        "viscosity_40 of the case file and the viscosity_100 of" in w for w in built.warnings
    )


def test_a_cold_day_is_among_the_temperatures_without_load():
    built = Variant(TREE, "drive.toml", "default").built({"lubricant.name": "pao-4"})
    degrees = running_axes(built)[1]
    assert degrees[0] == pytest.approx(233.15)
    assert np.isclose(degrees, 243.15, rtol=1e-12).sum() == 1
    warmer = Variant(TREE, "drive.toml", "default").built({})
    assert running_axes(warmer)[1].min() == pytest.approx(273.15)


def test_gears_without_a_wave_generator_have_no_such_losses():
    gears = {"teeth": [23, 61], "module": "1 mm", "face_width": "9 mm"}
    with pytest.raises(InputError, match="scales with pitch diameter and deflection over pitch"):
        losses({**TREE, "gears": gears})


@pytest.mark.parametrize("ratio", [30, 50, 100, 160])
def test_the_bearing_of_the_losses_is_that_of_the_stiffness(ratio):
    """Its diameter is the circle of the balls in usual proportions: as noted within 0.6 %, exact at 100."""
    teeth, diameter = 2 * ratio, 60e-3
    drive = build_strain_wave(
        teeth=(teeth, teeth + 2), module=diameter / teeth, face_width=1e-2, bearing=Balls()
    )
    bore = 2.0 * float(drive.rim.radius) - float(drive.rim.thickness)
    circle = ball_circle(Balls(), diameter, bore)
    (value,) = constants("mean_diameter")
    assert circle / diameter == pytest.approx(value, rel=0.0065 if ratio != 100 else 0.002)
