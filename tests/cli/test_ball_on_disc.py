"""A ball on a disc from its case file: film, pressure and friction in closed form, and every refusal."""

import json
from math import cbrt, exp, pi
from pathlib import Path

import bank
import numpy as np
import pytest
import xarray as xr
from pages import payload

from pitchpoint.cases.study_tables import Study, Sweep
from pitchpoint.errors import InputError
from pitchpoint.runs.catalogue import entries, figures_by_law
from pitchpoint.runs.run import Outcome, run_case, uncomputed_manifests
from pitchpoint.views.report import report_page
from pitchpoint.views.section_registry import SECTIONS
from pitchpoint.views.sections.answer import operation_summary

EXAMPLE = Path(__file__).parents[2] / "examples" / "ball_on_disc.toml"
OIL = {
    "lubricant.viscosity_40": "100 mm2/s",
    "lubricant.density": "850 kg/m3",
    "lubricant.density_slope": "0 kg/m3/K",
    "lubricant.pressure_viscosity": "22 1/GPa",
}
SWEEPS = {
    "force": ("operation.force", ["5 N", "50 N", "400 N"]),
    "speed": ("operation.speed", ["24 rpm", "240 rpm", "2400 rpm"]),
    "temperature": ("operation.temperature", ["40 degC", "60 degC"]),
    "slip": ("gears.slide_roll_ratio", [-0.5, 0.0, 0.1, 2.0]),
    "barrel": ("gears.transverse_radius", ["9.525 mm", "30 mm"]),
}

RADIUS, TRACK, FORCE, MU = 9.525e-3, 40e-3, 50.0, 0.04
CONTACT_MODULUS = 206e9 / (2.0 * (1.0 - 0.3**2))  # E* of two equal solids
DISC = 240.0 * 2.0 * pi / 60.0 * TRACK


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    studies = {
        name: Study(title=name, sweep=Sweep(key=key, values=tuple(values)))
        for name, (key, values) in SWEEPS.items()
    }
    return bank.outcomes(EXAMPLE, settings=OIL, studies=studies)["default"]


def film(*, force: float, entrainment: float, across: float = RADIUS) -> float:
    """Hamrock and Dowson's minimum film [m], from their groups."""
    modulus = 2.0 * CONTACT_MODULUS
    U = 0.085 * entrainment / (modulus * RADIUS)
    G, W = 22e-9 * modulus, force / (modulus * RADIUS**2)
    slender = (across / RADIUS) ** (2.0 / pi)
    return RADIUS * 3.63 * U**0.68 * G**0.49 * W**-0.073 * (1.0 - exp(-0.68 * slender))


def at(data: xr.Dataset, name: str) -> float:
    return float(data[name].values[0, 0])


def study(outcome: Outcome, name: str, variable: str) -> np.ndarray:
    return np.asarray(outcome.parts[f"study_{name}"][variable].values[0])


def test_film_by_hamrock_and_dowson(outcome: Outcome) -> None:
    found = at(outcome.parts["operation"], "film_thickness")
    assert found == pytest.approx(film(force=50.0, entrainment=DISC / 1.05), rel=1e-12)
    assert found == pytest.approx(0.23209e-6, rel=1e-3)
    np.testing.assert_allclose(outcome.parts["cycle"]["film_thickness"], found, rtol=1e-14)


def test_pressure_of_a_circular_contact(outcome: Outcome) -> None:
    """Johnson, Contact Mechanics, eq. 4.24: p0 = (6 F E*^2/(pi^3 R^2))^(1/3)."""
    exact = cbrt(6.0 * FORCE * CONTACT_MODULUS**2 / (pi**3 * RADIUS**2))
    found = at(outcome.parts["operation"], "pressure")
    assert found == pytest.approx(exact, rel=1e-13)
    assert found == pytest.approx(1.1096e9, rel=1e-4)


def test_friction_torque_and_loss(outcome: Outcome) -> None:
    operation = outcome.parts["operation"]
    assert at(operation, "mean_input_torque") == pytest.approx(MU * FORCE * TRACK, rel=1e-13)
    assert at(operation, "entrainment") == pytest.approx(DISC / 1.05, rel=1e-13)
    sliding = 0.1 * DISC / 1.05
    assert at(operation, "sliding_velocity") == pytest.approx(sliding, rel=1e-12)
    assert at(operation, "mean_loss") == pytest.approx(MU * FORCE * sliding, rel=1e-12)


def test_bearings_hold_disc_along_and_ball_across_its_axis(outcome: Outcome) -> None:
    operation = outcome.parts["operation"]
    held = [at(operation, f"{way}_reaction_{k}") for k in (1, 2) for way in ("axial", "radial")]
    np.testing.assert_allclose(held, [-FORCE, 0.0, 0.0, FORCE], rtol=1e-14, atol=1e-12)


def test_the_sense_of_sliding_turns_the_torque(outcome: Outcome) -> None:
    ratio = np.array(SWEEPS["slip"][1])
    mean = DISC / (1.0 + ratio / 2.0)
    torque, loss = (study(outcome, "slip", name) for name in ("mean_input_torque", "mean_loss"))
    np.testing.assert_allclose(torque, MU * FORCE * TRACK * np.sign(ratio), rtol=1e-12)
    np.testing.assert_allclose(loss, MU * FORCE * np.abs(ratio) * mean, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(study(outcome, "slip", "entrainment"), mean, rtol=1e-13)
    sliding = study(outcome, "slip", "sliding_velocity")
    np.testing.assert_allclose(sliding, ratio * mean, rtol=1e-12, atol=1e-15)
    assert loss[-1] == pytest.approx(MU * FORCE * DISC)  # the ball at rest


def test_nothing_is_transmitted(outcome: Outcome) -> None:
    assert set(outcome.parts) == {"cycle", "operation", "laws", *(f"study_{n}" for n in SWEEPS)}
    efficiency = outcome.parts["operation"]["mean_efficiency"]
    assert np.isnan(efficiency).all()
    assert efficiency.attrs["note"] == "undefined (NaN): no power goes through a test rig"
    assert np.isnan(outcome.parts["cycle"]["efficiency"]).all()
    assert np.isnan(outcome.parts["operation"]["loss_factor"]).all()


def test_film_and_pressure_against_force_and_speed(outcome: Outcome) -> None:
    forces, speeds = np.array([5.0, 50.0, 400.0]), np.array([0.1, 1.0, 10.0])
    expected = [film(force=one, entrainment=DISC / 1.05) for one in forces]
    np.testing.assert_allclose(study(outcome, "force", "film_thickness"), expected, rtol=1e-12)
    pressure = study(outcome, "force", "pressure")
    np.testing.assert_allclose(pressure, pressure[1] * (forces / 50.0) ** (1 / 3), rtol=1e-13)
    expected = [film(force=FORCE, entrainment=DISC / 1.05 * one) for one in speeds]
    np.testing.assert_allclose(study(outcome, "speed", "film_thickness"), expected, rtol=1e-12)
    hot = study(outcome, "temperature", "film_thickness")
    assert 0.3 * hot[0] < hot[1] < 0.7 * hot[0]


def test_a_barrel_touches_in_a_wider_ellipse(outcome: Outcome) -> None:
    expected = [film(force=FORCE, entrainment=DISC / 1.05, across=one) for one in (RADIUS, 30e-3)]
    np.testing.assert_allclose(study(outcome, "barrel", "film_thickness"), expected, rtol=1e-12)
    round_, wide = study(outcome, "barrel", "pressure")
    assert 0.6 * round_ < wide < 0.8 * round_


def test_tables_and_json_tell_the_contact(outcome: Outcome) -> None:
    (row,) = operation_summary(outcome).rows
    assert [*row][:4] == [
        "friction law",
        "film thickness [µm]",
        "film thickness over composite Rq",
        "largest Hertz pressure [MPa]",
    ]
    assert row["largest Hertz pressure [MPa]"] == "1110"
    assert (
        operation_summary(outcome).line == "No power is transmitted: the efficiency is undefined."
    )
    told = figures_by_law(outcome)
    assert told["back_driving"] == {}
    assert told["operation"]["constant"]["film_thickness"] == pytest.approx(0.23209e-6, rel=1e-3)
    assert told["studies"]["force"]["constant"]["pressure"][1] == pytest.approx(1.1096e9, rel=1e-4)
    swept = Outcome({}, {"study_sweep_force": outcome.parts["study_force"]})
    (printed,) = SECTIONS["studies"].screen(swept)
    assert [row["operation.force"] for row in printed.rows] == ["5 N", "50 N", "400 N"]
    assert all(float(row["film thickness [µm]"]) > 0.0 for row in printed.rows)


def test_the_report_shows_the_contact_and_leaves_out_what_gears_have(outcome: Outcome) -> None:
    page = report_page({"default": outcome})
    body = page[page.index("<main>") : page.index("</main>")].replace("\u00a0", " ")
    assert "disc drives at 240 rpm, ball carries 50 N, oil at 40 °C" in body
    assert "<dt>largest Hertz pressure</dt><dd><strong>1110 MPa</strong>" in body
    assert "Under the friction law" not in body  # whose figures are those above
    assert "normal force" in json.dumps(payload(page))
    body, absent = body.split('id="absent"')
    assert "Loss map, Four quadrants, Duty cycle (nothing is transmitted by a test rig)" in absent
    for heading in ("base pitch", "back-driving", "Loss map", "Load sharing</dt>", "None"):
        assert heading not in body, heading
    assert report_page({"one": outcome, "two": outcome})


LINE = "holds for line contacts, and these touch in an ellipse; choose one of"
BAD: dict[str, tuple[object, str]] = {
    "models.film_thickness": (
        "dowson_higginson_1959",
        f"'dowson_higginson_1959' {LINE} hamrock_dowson_1977, hamrock_dowson_1977_central",
    ),
    "models.friction": (
        "iso_tr_14179_2",
        f"'iso_tr_14179_2' {LINE} constant, frictionless, xu_2007",
    ),
    "models.rolling_resistance": (
        "wu_cheng_1991",
        f"'wu_cheng_1991' {LINE} none, wu_cheng_1991_strips",
    ),
    "operation.torque": (
        "5 N m",
        "a test rig is loaded by a normal force; give force in place of torque",
    ),
    "operation.driver": ("ball", '"ball" cannot drive; use disc'),
    "gears.slide_roll_ratio": (-2.0, "-2.0 is out of range; allowed is -1.9 to 2"),
    "gears.ball_radius": ("0 mm", '"0 mm" is out of range; allowed is 0.1 mm to 1000 mm'),
    "models.slices": (4, "the contact of a ball is not divided into slices; leave it at 12"),
    "loss_map": (
        {"count": 4},
        "a loss map runs over the torque of an output, which a test rig does not have; leave this table "
        "out",
    ),
    "dynamics": (
        {"damping_ratio": 0.1},
        "vibration is computed along a line of action, which these gears do not have; leave this table "
        "out",
    ),
}


@pytest.mark.parametrize("key", BAD)
def test_bad_input_is_one_sentence(key: str) -> None:
    value, told = BAD[key]
    with pytest.raises(InputError) as error:
        uncomputed_manifests(str(EXAMPLE), settings={key: value})
    assert str(error.value) == f"{EXAMPLE.name}: {key}: {told}"


def test_gears_take_no_force_and_no_film_of_an_ellipse() -> None:
    pair = str(EXAMPLE.with_name("pair_23_61.toml"))
    with pytest.raises(InputError, match=r"operation.force: gears carry a torque; give torque in"):
        uncomputed_manifests(pair, settings={"operation.force": "50 N"})
    with pytest.raises(
        InputError, match=r"models.film_thickness: 'hamrock_dowson_1977' holds for ell"
    ):
        uncomputed_manifests(pair, settings={"models.film_thickness": "hamrock_dowson_1977"})


def test_a_law_of_ones_own_for_lines_is_refused() -> None:
    def my_law(*, line_load: float) -> float:
        return 0.0 * line_load

    with pytest.raises(
        InputError, match="'my_law' holds for line contacts, and these touch in an ell"
    ):
        run_case(str(EXAMPLE), friction=my_law)


def test_a_contact_narrower_than_long_is_told() -> None:
    (manifest,) = uncomputed_manifests(str(EXAMPLE), settings={"gears.transverse_radius": "5 mm"})
    assert any("narrower across the track" in text for text in manifest["warnings"])
    (usual,) = uncomputed_manifests(str(EXAMPLE))
    assert usual["warnings"] == []


def test_models_tell_the_shape_of_contact() -> None:
    ranges = {row["name"]: row["range"] for row in entries()}
    assert ranges["hamrock_dowson_1977"] == "elliptic contacts, minimum film; ellipticity 1 to 8"
    assert ranges["wu_cheng_1991"] == "line contacts"
    assert ranges["constant"] == "each contact; any shape of contact"
    assert "line contacts" in ranges["iso_tr_14179_2"]
