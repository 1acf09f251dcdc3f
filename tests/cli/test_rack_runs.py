"""A rack and pinion from its case file: units of a travel, closed forms of its result, and refusals."""

import re
from dataclasses import replace
from pathlib import Path

import bank
import numpy as np
import pytest

from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import module
from pitchpoint.gears.families import sample_of
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, run_case, uncomputed_manifests
from pitchpoint.views.report import report_page

SAMPLE = str(sample_of(RackAndPinionGears))
EXAMPLE = Path(__file__).parents[2] / "examples" / "rack_and_pinion.toml"
FORCE, SPEED, RADIUS = 2000.0, 300.0 * 2.0 * np.pi / 60.0, 0.03
FRICTIONLESS = {"models.friction": "frictionless"}
SMALL = {"loss_map": {"count": 2, "force": "4000 N", "quadrants": 4}}


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    return bank.outcomes(SAMPLE, settings=SMALL)["default"]


def test_the_shipped_example_is_short() -> None:
    assert len(EXAMPLE.read_text("utf-8").splitlines()) <= 15
    (manifest,) = uncomputed_manifests(str(EXAMPLE))
    assert (manifest["driver"], manifest["loaded"]) == ("pinion", "rack")


@pytest.mark.whole
def test_power_goes_from_the_pinion_to_the_rack(outcome: Outcome) -> None:
    data = outcome.parts["operation"]
    lost, seal = float(data["mean_loss"].values[0, 0]), 0.1 * SPEED
    power = FORCE * SPEED * RADIUS
    efficiency = power / (power + lost)
    assert float(data["mean_efficiency"].values[0, 0]) == pytest.approx(efficiency, rel=1e-12)
    torque = (power + lost) / SPEED
    assert float(data["mean_input_torque"].values[0, 0]) == pytest.approx(torque, rel=1e-12)
    assert float(data["mean_drag_loss"].values[0, 0]) == pytest.approx(seal, rel=1e-12)


@pytest.mark.whole
def test_the_map_of_the_rack_is_in_its_units(outcome: Outcome) -> None:
    data = outcome.parts["four_quadrants"]
    units = [data[name].attrs["units"] for name in ("output_torque", "output_speed")]
    assert units == ["N", "m/s"]
    assert data["mean_input_torque"].attrs["units"] == "N m"
    text = module(outcome, table_of(data))
    assert "Units: torque N, speed m/s, torque of the driver N m" in text
    fast = data.isel(law=0, temperature=0, output_speed=-1, output_torque=[0, -1])
    given = fast["output_torque"] * fast["output_speed"]
    taken = fast["mean_input_torque"] * fast["output_speed"] / RADIUS
    np.testing.assert_allclose(taken - given, fast["mean_loss"], rtol=1e-10)
    assert (fast["mean_efficiency"] > 0.9).all()
    assert ">Four quadrants<" in report_page({"default": outcome})


@pytest.mark.whole
def test_guides_of_the_rack_bear_the_separating_force_alone() -> None:
    data = run_case(SAMPLE, settings={**SMALL, **FRICTIONLESS})["default"].parts["operation"]
    radial, axial = (
        np.array([float(data[f"{way}_reaction_{k}"].values[0, 0]) for k in (1, 2)])
        for way in ("radial", "axial")
    )
    expected = FORCE / np.cos(np.radians(20.0)), FORCE * np.tan(np.radians(20.0))
    np.testing.assert_allclose(radial, expected, rtol=1e-12)
    np.testing.assert_array_equal(axial, 0.0)


@pytest.mark.whole
def test_a_thrust_of_helical_teeth_is_that_on_the_shaft_of_the_pinion_alone(
    outcome: Outcome,
) -> None:
    thrust = outcome.parts["operation"].copy(deep=True)
    thrust["axial_reaction_1"][:] = 5.0
    helical = replace(outcome, parts={**outcome.parts, "operation": thrust})
    page = report_page({"default": helical})
    assert page.count("axial load on the shaft of the pinion") == 1
    assert "axial load on the guides" not in page


@pytest.mark.whole
def test_what_travels_has_units_of_its_own(outcome: Outcome) -> None:
    torsion, back = outcome.parts["torsion"], outcome.parts["back_driving"]
    units = {
        "torque": "N",
        "wind_up": "m",
        "torsional_stiffness": "N/m",
        "tangent_torsional_stiffness": "N/m",
        "phase_mean_torsional_stiffness": "N/m",
        "kinematic_play": "m",
        "mesh_torsional_stiffness": "N/m",
    }
    assert {name: torsion[name].attrs["units"] for name in units} == units
    assert outcome.parts["loss_map"]["torque"].attrs["units"] == "N"
    assert outcome.parts["operation"]["mean_input_torque"].attrs["units"] == "N m"
    assert back["mean_input_torque"].attrs["units"] == "N"
    assert outcome.parts["running"]["back_driving_torque"].attrs["units"] == "N"
    assert outcome.parts["vibration"]["torque"].attrs["long_name"] == "output force"


@pytest.mark.whole
def test_stiffness_against_the_force_is_that_along_the_line_of_action(outcome: Outcome) -> None:
    """A travel s closes the flanks by s cos(alpha), and the force along them is F/cos(alpha)."""
    torsion, stiffness = outcome.parts["torsion"], outcome.parts["stiffness"]
    at = int(np.argmin(np.abs(torsion["torque"].values - FORCE)))
    assert torsion["torque"].values[at] == pytest.approx(FORCE)
    mean = float(stiffness["mean_stiffness"]) * np.cos(np.radians(20.0)) ** 2
    found = torsion["phase_mean_torsional_stiffness"].values[at]
    assert float(found) == pytest.approx(mean, rel=1e-3)


@pytest.mark.whole
def test_the_map_reaches_the_force_that_was_asked_for(outcome: Outcome) -> None:
    assert outcome.parts["loss_map"]["torque"].values.tolist() == [0.0, 4000.0]


@pytest.mark.whole
def test_json_says_the_units_of_a_travel(outcome: Outcome) -> None:
    shown = figures_by_law(outcome)
    assert shown["units"]["wind_up"] == "m"
    assert shown["units"]["mean_input_torque"] == "N m"


@pytest.mark.whole
def test_every_section_that_applies_is_in_the_report_in_words_of_a_travel(outcome: Outcome) -> None:
    page = report_page({"default": outcome}).replace("\u00a0", " ")
    sections = re.findall(r'<section id="(\w+)"', page)
    assert sections[:7] == ["answer", "inputs", "teeth", "bodies", "path", "cycle", "film"]
    assert sections[7] == "torsion"
    assert sections[8:14] == ["beside", "stiffness", "vibration", "motion", "studies", "map"]
    assert sections[14:] == ["quadrants", "models", "sources"]
    assert "Kinematic error (deviations of the teeth of these gears are not among" in page
    assert "load on the guides of the rack, across its travel" in page
    for words in (
        "pinion drives at 300 rpm, rack carries 2000 N",
        "pinion (below), ",
        "rack (above). Pinion drives, turning counter-clockwise",
        "A at the tip of the rack; C is the pitch point",
        "Flank of pinion over flank of rack",
        "Force over deflection, growing and shrinking",
        "driver speed and output force",
        "back-driving force",
    ):
        assert words in re.sub(r"<[^>]*>", "", page), words


REFUSED = {
    "operation.torque": ({"operation.torque": "5 N m"}, "a rack carries a force"),
    "operation.driver": ({"operation.driver": "rack"}, "cannot drive"),
    "loss_map.torque": ({"loss_map.torque": "5 N m"}, "give force in place of torque"),
    "models.tooth_temperature": (
        {"models.tooth_temperature": "vdi_2736_2", "materials.gear_1": "POM-H"},
        "two gears that turn",
    ),
    "loss_map.torque_count": ({"loss_map.torque_count": 3}, "give force_count in place of"),
    "dynamics.torques": ({"dynamics.torques": ["5 N m"]}, "give forces in place of torques"),
    "dynamics.inertia": ({"dynamics.inertia": "1 kg cm2"}, "gears.mass"),
    "losses.seal.between": ({"losses.seal.between": ["rack", "housing"]}, "travels"),
    "gears.mounting_distance": ({"gears.mounting_distance": "29 mm"}, "flanks overlap"),
}


@pytest.mark.parametrize("key", REFUSED)
def test_what_a_rack_does_not_take_is_one_sentence(key: str) -> None:
    given, words = REFUSED[key]
    with pytest.raises(InputError, match=words) as caught:
        uncomputed_manifests(SAMPLE, settings=given)
    assert caught.value.key == key


def test_a_vibration_asks_for_the_mass(tmp_path: Path) -> None:
    text = Path(SAMPLE).read_text("utf-8").replace('mass = "40 kg"\n', "")
    (tmp_path / "light.toml").write_text(text, "utf-8")
    with pytest.raises(InputError, match="the mass of the rack") as caught:
        uncomputed_manifests(str(tmp_path / "light.toml"))
    assert caught.value.key == "gears.mass"
