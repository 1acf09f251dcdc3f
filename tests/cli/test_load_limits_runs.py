"""Load limits of a strain wave gear as a case asks for them: dataset, section, screen, refusals."""

import json

import numpy as np
import pytest
from sound import WAVE

from pitchpoint.analyses.load_limits import load_limits_part
from pitchpoint.errors import InputError
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.section import Page, Paragraph, SectionTable
from pitchpoint.views.section_registry import LOAD_LIMITS

TABLE = """[gears.limits]
bending_concentration = 1.5
endurance_limit = "450 MPa"
tensile_strength = "1100 MPa"
ratcheting_torque = "30 N m"
catalogue_diameter = "60 mm"
rated_torque = "67 N m"
rated_speed = "1000 rpm"
rated_life = "7000 h"
"""


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    def of(table: str):
        path = tmp_path_factory.mktemp("limits") / "wave.toml"
        path.write_text(WAVE + table, "utf-8")
        return load_case(str(path))

    return of


@pytest.fixture(scope="module")
def plain(built):
    return load_limits_part(built(""))


@pytest.fixture(scope="module")
def asked(built):
    return load_limits_part(built(TABLE))


def words(data) -> str:
    page = Page({"default": Outcome({}, {"load_limits": data})}, {})
    blocks = [*LOAD_LIMITS.blocks(page)]
    return " ".join(str(one.words) for one in blocks if isinstance(one, Paragraph))


def test_stresses_are_those_of_ring_and_tube(plain, asked) -> None:
    # rim of two modules, wall of half of that, w0 one module, flexspline of 200 teeth of 0.3 mm
    strain = plain["bending_strain"].values
    radius = np.sqrt(3.0 * 0.3e-3 * 0.3e-3 / strain[0])
    assert 28e-3 < radius < 30e-3  # the neutral line is below the pitch circle
    assert strain[0] == pytest.approx(2.0 * strain[1])
    np.testing.assert_allclose(asked["bending_amplitude"], 1.5 * plain["bending_amplitude"])
    np.testing.assert_allclose(plain["alternating_stress"], plain["bending_amplitude"])
    np.testing.assert_allclose(
        plain["torsional_stress"], 67.0 / (2 * np.pi * radius**2 * np.array([0.6e-3, 0.3e-3]))
    )
    np.testing.assert_allclose(plain["mean_bending_stress"], 0.0, atol=1.0)
    assert "goodman_safety" not in plain


def test_a_torque_that_reverses_makes_shear_alternate(built, plain) -> None:
    data = load_limits_part(built('[gears.limits]\ntorque = "reversing"\n'))
    bending, shear = (plain[name].values for name in ("bending_amplitude", "torsional_stress"))
    np.testing.assert_allclose(data["alternating_stress"], np.hypot(bending, np.sqrt(3) * shear))
    np.testing.assert_allclose(data["mean_stress"], 0.0, atol=1.0)
    assert "reversed at its full height" in data.attrs["note"]
    assert "which is steady" in plain.attrs["note"]


def test_margins_and_life_are_those_of_the_case(asked) -> None:
    margin = asked["limit_margin"].sel(against="ratcheting")
    assert float(margin) == pytest.approx(30.0 / 67.0)
    assert np.isnan(asked["limit_margin"].sel(against="buckling"))
    assert float(asked["bearing_life"]) == pytest.approx(3500.0 * 3600.0)
    assert float(asked["rated_life_torque"]) == pytest.approx(67.0 / 2.0 ** (1.0 / 3.0))
    (told,) = json.loads(asked.attrs["warnings"])
    assert told == "Fails: the torque on the flexspline is 2.23 times that of ratcheting."


def test_caveats_stand_beside_the_numbers(plain, asked) -> None:
    assert "An estimate" in words(plain)
    assert "hold no concentration" in words(plain)
    assert "Ratcheting and buckling are not computed." in words(plain)
    assert "No safety" in words(plain)
    assert "1.5 times (bending)" in words(asked)
    assert "by the cube of the pitch diameters" in words(asked)
    assert "7000" not in words(asked)
    assert "3500 h" in words(asked)


def test_the_screen_has_a_row_for_each_place(asked) -> None:
    outcome = Outcome({}, {"load_limits": asked})
    answers = {figure.name: figure for figure in LOAD_LIMITS.answer(outcome)}
    assert answers["Life of the bearing"].value == "3500 h"
    assert "estimate" in answers["Flexspline safety"].detail
    (printed,) = LOAD_LIMITS.screen(outcome)
    assert len(printed.rows) == 2
    heads = " ".join(printed.rows[0])
    assert all(name in heads for name in ("alternating", "shear stress", "Goodman"))
    assert "Against ratcheting 0.4478, by 30 N\u00a0m" in printed.line
    page = Page({"default": outcome}, {})
    heads = [one.head[0] for one in LOAD_LIMITS.blocks(page) if isinstance(one, SectionTable)]
    assert heads == ["flexspline", "against"]


def test_a_flexspline_that_fails_is_told(built) -> None:
    table = '[gears.limits]\nendurance_limit = "50 MPa"\ntensile_strength = "600 MPa"\n'
    data = load_limits_part(built(table))
    (told,) = json.loads(data.attrs["warnings"])
    assert "rim under the teeth" in told
    assert float(data["goodman_torque"].min()) == 0.0


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ('endurance_limit = "450 MPa"', "was given without tensile_strength"),
        ('rated_life = "7000 h"', "was given without rated_torque and rated_speed"),
        ('catalogue_diameter = "60 mm"', "without a torque of a catalogue"),
        ('average_torque = "60 N m"', "without a rated life"),
        ("bending_concentration = 0.5", "out of range"),
    ],
)
def test_bad_tables_are_refused(built, table, told) -> None:
    with pytest.raises(InputError, match=told) as caught:
        built(f"[gears.limits]\n{table}\n")
    assert "gears.limits" in str(caught.value)
