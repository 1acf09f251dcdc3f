"""Tooth temperature of VDI 2736 Part 2 against estimates by hand, and the modulus it leads to."""

import dataclasses
import math
from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import pitchpoint
from pitchpoint import citations
from pitchpoint.cases.solids import heating, solids_at_root_temperature, surrounded
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, Status
from pitchpoint.efficiency.efficiency_registry import TOOTH_TEMPERATURE
from pitchpoint.efficiency.summary import tooth_heat_figures
from pitchpoint.efficiency.tooth_temperature import isothermal, modulus_at, vdi_2736_2
from pitchpoint.efficiency.warm_teeth import warm_teeth
from pitchpoint.errors import InputError
from pitchpoint.materials import solids

# Four steel/PA66 pairs at 0.42 N m and 1800 rpm: wheel teeth, normal module [mm], loss factor as
# printed with two digits, rise of the flank temperature [K] at mu = 0.2.
PAIRS = {
    "GP1": (51, 1.5, 0.53, 70.0),
    "GP2": (51, 1.5, 0.59, 77.0),
    "GP3": (77, 1.0, 0.34, 41.0),
    "GP4": (77, 1.0, 0.41, 49.0),
}
SPEED = 2.0 * math.pi * 30.0


def case(**changes):
    values = dict(
        ambient=293.15,
        power=0.42 * SPEED,
        friction=0.2,
        loss_factor=0.53,
        face_width=16e-3,
        teeth=51,
        pitch_speed=6.385e-3 / 2.0 * SPEED,
        normal_module=1.5e-3,
    )
    return values | changes


def rise(**changes):
    return float(vdi_2736_2(**case(**changes)).flank) - 293.15


@pytest.mark.parametrize("name", PAIRS)
def test_heating_of_dry_steel_and_polyamide_pairs(name):
    teeth, module, loss_factor, expected = PAIRS[name]
    found = rise(teeth=teeth, normal_module=module * 1e-3, loss_factor=loss_factor)
    rounding = 0.5 + found * 0.005 / loss_factor  # last digits of the rise and of the loss factor
    assert found == pytest.approx(expected, abs=rounding)
    assert 9.5 < found / 4.0 < 19.5  # mu = 0.05: 10 to 19 K


def test_a_hand_calculation_in_the_units_of_the_fit():
    # 100 W * 0.1 * 0.5 = 5 W; v mn = 2 m/s * 8 mm = 16, to the 3/4 is 8; b z 8 = 10 * 20 * 8
    values = case(
        power=100.0,
        friction=0.1,
        loss_factor=0.5,
        face_width=10e-3,
        teeth=20,
        pitch_speed=2.0,
        normal_module=8e-3,
    )
    steel, plastic = vdi_2736_2(**values), vdi_2736_2(**values, mate="plastic")
    found = [float(t) - 293.15 for t in (*steel, *plastic)]
    expected = [5.0 * k / 1600.0 for k in (6300.0, 895.0, 9000.0, 2148.0)]
    np.testing.assert_allclose(found, expected, rtol=1e-11)


def test_closed_housing_meets_a_published_report():
    # The report counts the housing alone, 0.06 K m2/W on 0.01 m2: 107.767 degC from 80 degC.
    # Its loss factor is the guideline's own, of partial contact ratios 0.600 and 0.554.
    loss_factor = math.pi * (52 / 51 + 1) / 52 * (1 - 0.600 - 0.554 + 0.600**2 + 0.554**2)
    values = case(power=1848.706, friction=0.04, loss_factor=loss_factor, pitch_speed=6.067)
    in_the_open = vdi_2736_2(**values)
    closed = vdi_2736_2(**values, housing_resistance=0.06, housing_area=0.01)
    assert float(closed.flank - in_the_open.flank) == pytest.approx(27.767, abs=0.001)
    assert float(closed.root - in_the_open.root) == pytest.approx(27.767, abs=0.001)


def test_intermittent_running_heats_less():
    assert rise(duty=0.5) / rise() == pytest.approx(0.5**0.64, rel=1e-10)
    assert rise(duty=0.0) == 0.0


def test_at_rest_and_without_load_nothing_is_heated():
    assert rise(pitch_speed=0.0) == 0.0
    assert rise(power=0.0) == 0.0


def test_many_points_at_once_equal_one_by_one():
    friction = jnp.array([0.0, 0.05, 0.2])
    together = vdi_2736_2(**case(friction=friction)).flank - 293.15
    np.testing.assert_allclose(together, [rise(friction=float(mu)) for mu in friction], atol=1e-10)


def test_gradient_with_respect_to_speed_equals_finite_difference():
    def flank(speed):
        return vdi_2736_2(**case(pitch_speed=speed, duty=0.4)).flank

    central = (flank(0.6 + 1e-5) - flank(0.6 - 1e-5)) / 2e-5
    assert float(jax.grad(flank)(0.6)) == pytest.approx(float(central), rel=1e-6)
    assert float(jax.grad(flank)(0.0)) == 0.0


def test_half_a_housing_and_unknown_mates_are_refused():
    with pytest.raises(InputError, match="both its thermal resistance and its outer area"):
        vdi_2736_2(**case(), housing_resistance=0.06)
    with pytest.raises(InputError, match='"brass" is not the material of a mating gear'):
        vdi_2736_2(**case(), mate="brass")


def test_isothermal_teeth_are_as_warm_as_the_room():
    assert [float(t) for t in isothermal(ambient=300.0)] == [300.0, 300.0]


def test_registry_names_its_models_and_their_sources():
    assert list(TOOTH_TEMPERATURE) == ["isothermal", "vdi_2736_2"]
    cited = {key for model in TOOTH_TEMPERATURE.values() for key in model.sources}
    assert cited <= set(citations.available())
    with pytest.raises(InputError, match="is not a known thermal model; did you mean vdi_2736_2"):
        TOOTH_TEMPERATURE["vdi_2736"]


def test_warm_tooth_is_softer_where_a_table_says_so():
    warm = modulus_at(solids.find("POM-H"), 273.15 + 61.5)  # half way from 23 to 100 degC
    assert float(warm.young) == pytest.approx((3.25e9 + 0.7e9) / 2.0, rel=1e-12)
    assert warm.status == (
        "POM-H: its modulus is known from -40 degC to 100 degC, "
        "interpolated at 61.5 degC (values assumed)"
    )


def test_single_modulus_is_used_and_the_status_says_it():
    warm = modulus_at(solids.find("PA66"), 366.15)
    assert float(warm.young) == solids.find("PA66").young.value
    assert warm.status == (
        "PA66: its modulus is known at 23 degC only, the same value is used at 93 degC, where the "
        "true one is lower: stiffness comes out too high, transmission error too low"
    )
    assert modulus_at(solids.find("PA66"), 300.0).status.endswith("used at 26.9 degC")


def test_a_tooth_hotter_than_its_table_is_refused():
    with pytest.raises(InputError, match=r"POM-H .* a temperature of 140 degC is not allowed"):
        modulus_at(solids.find("POM-H"), 413.15)


EXAMPLE = Path(__file__).parents[2] / "examples" / "helical_few_teeth_plastic.toml"


def plastic(friction):
    """A pinion of steel and a wheel of plastic, as a case file builds them."""
    return pitchpoint.load_case(EXAMPLE, settings={"models.friction": friction})


@pytest.fixture(scope="module")
def warm():
    return plastic("xu_2007")


def test_heat_modulus_and_friction_are_in_balance(warm):
    """Pressure by the modulus at the root, friction by the pressure, heat by the friction, and back."""
    assert int(warm.warming.code) == Code.SOLVED
    assert 2 < int(warm.warming.iterations) < 20
    assert float(warm.warming.residual) < 1e-11
    found = tooth_heat_figures(warm.design, warm.operation, warm.models[0])
    figures = {name: float(value) for name, value in found.items()}
    cool = surrounded(warm.solids, warm.case.operation.temperature)
    again = solids_at_root_temperature(warm.case, warm.design, cool, figures)
    for ours, theirs in zip(warm.solids, again, strict=True):
        np.testing.assert_allclose(ours.temperature, theirs.temperature, rtol=1e-12)
        np.testing.assert_allclose(ours.solid.young, theirs.solid.young, rtol=1e-11)


def test_one_pass_is_the_balance_where_friction_does_not_ask_the_modulus():
    warm = plastic("constant")
    assert int(warm.warming.iterations) == 2


@program
def _root_and_rate(given, load):
    design, operation, models, heated = given

    def root(at):
        point = dataclasses.replace(operation, load=at)
        return warm_teeth(design, point, models, heated).root[1]

    return root(load), jax.grad(root)(load)


@pytest.mark.whole
def test_derivatives_of_the_balance_agree_with_differences(warm):
    cool = surrounded(warm.solids, warm.case.operation.temperature)
    given = warm.design, warm.operation, warm.models[0], heating(warm.case, cool)
    load = warm.operation.load
    step = 1e-4 * load
    _, rate = _root_and_rate(given, load)
    beyond, _ = _root_and_rate(given, load + step)
    before, _ = _root_and_rate(given, load - step)
    np.testing.assert_allclose(rate, (beyond - before) / (2.0 * step), rtol=1e-7)


def test_a_balance_that_is_not_found_says_so(warm):
    lost = Status(jnp.asarray(Code.NOT_CONVERGED), jnp.asarray(0.1), jnp.asarray(40))
    assert any("no balance" in text for text in dataclasses.replace(warm, warming=lost).warnings)
    assert not any("no balance" in text for text in warm.warnings)


@pytest.mark.whole
def test_backwards_has_a_balance_of_its_own(warm):
    other = warm.backwards
    assert int(other.warming.code) == Code.SOLVED
    assert other.solids[1].temperature != warm.solids[1].temperature
