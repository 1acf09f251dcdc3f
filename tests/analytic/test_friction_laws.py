"""Friction laws: check values of the table, printed unit values, exponents and limits."""

from dataclasses import replace

import numpy as np
import pytest
from bare_contacts import conditions

from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.lubrication.conditions import UNITS, evaluate, law_arguments
from pitchpoint.lubrication.friction_coefficient import iso_tr_14179_2, xu_2007
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, LAWS, FrictionLaw

BY_NAME = {law.name: law for law in LAWS}


def value(law, given, **changed):
    return float(law(**{key: jnp.asarray(v) for key, v in {**given, **changed}.items()}))


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_check_value_of_every_law(law):
    given, expected = law.check
    assert value(law.function, given) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_every_law_asks_for_known_conditions(law):
    wanted, _ = law_arguments(law.function)
    assert set(wanted) <= set(UNITS)
    assert set(law.ranges) <= set(wanted)
    assert law.name == law.function.__name__


@pytest.mark.parametrize(
    ("conditions", "expected"),
    [  # SR, Ph [GPa], nu0 [cP], S [um], Ve [m/s], R [m]
        ((0.1, 1.0, 10.0, 0.1, 10.0, 0.01), 0.008185),
        ((0.3, 1.0, 10.0, 0.1, 10.0, 0.01), 0.015007),
        ((0.3, 1.0, 10.0, 0.5, 10.0, 0.01), 0.021024),
        ((0.3, 1.5, 10.0, 0.1, 10.0, 0.01), 0.016185),
        ((0.3, 1.0, 5.0, 0.1, 10.0, 0.01), 0.011197),
        ((0.3, 1.0, 15.0, 0.5, 2.0, 0.01), 0.029574),
        ((0.1, 0.4, 15.0, 0.5, 2.0, 0.01), 0.008308),
    ],
)
def test_unit_values_of_xu(conditions, expected):
    SR, GPa, cP, um, speed, radius = conditions
    found = value(
        xu_2007,
        {},
        slide_roll_ratio=SR,
        pressure=GPa * 1e9,
        viscosity=cP * 1e-3,
        roughness_rq=um * 1e-6,
        entrainment=speed,
        radius=radius,
    )
    assert found == pytest.approx(expected, abs=5.1e-7)


def test_first_case_of_tian_2024_in_iso():
    given, _ = BY_NAME["iso_tr_14179_2"].check
    assert value(iso_tr_14179_2, given) == pytest.approx(0.05440, abs=5e-6)


@pytest.mark.parametrize(
    ("name", "exponent"),
    [
        ("reference_line_load", 0.2),
        ("reference_sum_speed", -0.2),
        ("reference_radius", -0.2),
        ("viscosity", -0.05),
        ("roughness_ra", 0.25),
        ("lubricant_factor", 1.0),
    ],
)
def test_exponents_of_iso(name, exponent):
    given, at = BY_NAME["iso_tr_14179_2"].check
    ratio = value(iso_tr_14179_2, given, **{name: 3.0 * given[name]}) / at
    assert ratio == pytest.approx(3.0**exponent, rel=1e-12)


@pytest.mark.parametrize(("name", "exponent"), [("entrainment", -0.100601), ("radius", -0.390958)])
def test_exponents_of_xu(name, exponent):
    given, at = BY_NAME["xu_2007"].check
    ratio = value(xu_2007, given, **{name: 3.0 * given[name]}) / at
    assert ratio == pytest.approx(3.0**exponent, rel=1e-12)


def test_roughness_in_xu_is_doubly_exponential():
    given, at = BY_NAME["xu_2007"].check
    ratio = value(xu_2007, given, roughness_rq=1.0e-6) / at
    assert ratio == pytest.approx(np.exp(0.620305 * (np.exp(1.0) - np.exp(0.5))), rel=1e-12)


def test_xu_vanishes_towards_pure_rolling():
    given, at = BY_NAME["xu_2007"].check
    assert value(xu_2007, given, slide_roll_ratio=0.0) == 0.0
    small = [value(xu_2007, given, slide_roll_ratio=s) for s in (1e-6, 1e-7)]
    assert small[0] / small[1] == pytest.approx(10.0**1.036077, rel=1e-5)
    assert value(xu_2007, given, slide_roll_ratio=-0.3) == pytest.approx(at, rel=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("scale", [0.0, 1e-9, 1.0, 10.0, 1e3])
def test_laws_are_finite_and_never_negative(law, scale):
    given = {key: jnp.asarray(v * scale) for key, v in law.check[0].items()}
    found, slopes = jax.jit(jax.value_and_grad(lambda at: law.function(**at)))(given)
    assert np.isfinite(found)
    assert float(found) >= 0.0
    assert all(np.isfinite(slope) for slope in slopes.values())


def test_a_law_of_ones_own_asks_for_film_temperature_and_place():
    film = FILM_THICKNESS["dowson_higginson_1959"]
    given = {"viscosity": 0.05, "pressure_viscosity": 2e-8, "roughness_rq": 0.5e-6}
    at = conditions("line", temperature=330.0, **given)

    def law(*, lambda_ratio, film_thickness, temperature, path_position, face_position):
        return jnp.stack([lambda_ratio, film_thickness, lambda_ratio * 0.0 + temperature]).sum(0)

    known = FrictionLaw("law", "law", law, film=film)
    thickness = float(evaluate(film, at)[0, 0])
    assert thickness > 1e-9
    found = float(evaluate(known, at)[0, 0])
    assert found == pytest.approx(thickness / 0.5e-6 + thickness + 330.0, rel=1e-12)
    with pytest.raises(InputError, match="no film law stands beside this law"):
        evaluate(FrictionLaw("law", "law", law), at)


def test_a_contact_without_load_has_no_film_and_finite_slopes():
    film = FILM_THICKNESS["dowson_higginson_1959"]
    law = FrictionLaw("law", "law", lambda *, film_thickness: film_thickness, film=film)

    @jax.jit
    @jax.value_and_grad
    def value_and_slope(load):
        return evaluate(law, replace(conditions("line"), load=jnp.full((1, 1), load)))[0, 0]

    value, slope = value_and_slope(0.0)
    assert float(value) == 0.0
    assert np.isfinite(slope)
