"""Film thickness and rolling resistance: unit values, exponents, converged solutions, limits."""

import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.lubrication.film_thickness import (
    dowson_1968,
    dowson_higginson_1959,
    dowson_toyoda_1979,
    hamrock_dowson_1977,
    moes_1992,
    pan_hamrock_1989,
    pan_hamrock_1989_central,
)
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, ROLLING_RESISTANCE
from pitchpoint.lubrication.rolling_resistance import wu_cheng_1991

MODULUS = 206e9 / 0.91
OIL = {"entrainment": 2.0, "viscosity": 0.015, "pressure_viscosity": 2.2e-8}
LINE = {**OIL, "line_load": 1000.0 / 0.015, "radius": 0.01, "modulus": MODULUS}
ELLIPSE = {
    **OIL,
    "load": 1000.0,
    "radius": 0.01,
    "transverse_radius": 0.01 * 9.0 ** (np.pi / 2.0),
    "modulus": MODULUS,
}


def value(law, given, **changed):
    arguments = {**given, **changed}
    return float(law(**{key: jnp.asarray(v) for key, v in arguments.items()}))


def test_line_film_of_a_1000_newton_contact():
    assert value(dowson_higginson_1959, LINE) * 1e6 == pytest.approx(0.24951, abs=5e-6)


def test_elliptic_film_of_a_1000_newton_contact():
    assert value(hamrock_dowson_1977, ELLIPSE) * 1e6 == pytest.approx(0.19573, abs=5e-6)


def test_line_film_is_its_power_product():
    W, U, G = 6.666e4 / (MODULUS * 0.01), 0.015 * 2.0 / (MODULUS * 0.01), 2.2e-8 * MODULUS
    expected = 0.01 * 1.6 * W**-0.13 * U**0.7 * G**0.6
    assert value(dowson_higginson_1959, LINE, line_load=6.666e4) == pytest.approx(
        expected, rel=1e-12
    )


@pytest.mark.parametrize(
    ("law", "factor", "exponents"),
    [
        (dowson_1968, 2.65, (-0.13, 0.7, 0.54)),
        (dowson_toyoda_1979, 3.06, (-0.10, 0.69, 0.56)),
        (pan_hamrock_1989, 1.714, (-0.128, 0.694, 0.568)),
        (pan_hamrock_1989_central, 2.922, (-0.166, 0.692, 0.470)),
    ],
)
def test_line_films_are_the_power_products_that_are_printed(law, factor, exponents):
    W, U, G = LINE["line_load"] / (MODULUS * 0.01), 0.015 * 2.0 / (MODULUS * 0.01), 2.2e-8 * MODULUS
    powers = np.prod(np.array([W, U, G]) ** np.array(exponents))
    assert value(law, LINE) == pytest.approx(0.01 * factor * powers, rel=1e-12)


def moes(M, L):
    """Film h/R U2^-1/2 of a line contact whose groups are M and L."""
    modulus, radius, U2 = 2.26e11, 0.01, 1e-11
    given = {
        "line_load": M * modulus * radius * np.sqrt(U2),
        "entrainment": 0.5,
        "viscosity": U2 * modulus * radius,
        "pressure_viscosity": L / (modulus * U2**0.25),
        "radius": radius,
        "modulus": modulus,
    }
    return value(moes_1992, given) / (radius * np.sqrt(U2))


@pytest.mark.parametrize(
    ("M", "L", "film", "solved"),
    [
        (5.0, 5.0, 4.105, 4.126),
        (10.0, 10.0, 5.464, 5.633),
        (20.0, 10.0, 5.100, 5.262),
        (50.0, 10.0, 4.636, 4.749),
        (100.0, 10.0, 4.297, 4.367),
        (200.0, 10.0, 3.971, 4.003),
    ],
)
def test_film_after_moes_by_hand_and_beside_converged_solutions(M, L, film, solved):
    assert moes(M, L) == pytest.approx(film, abs=6e-4)
    assert 1.0 < solved / moes(M, L) < 1.04


@pytest.mark.parametrize(
    ("M", "L", "limit"),
    [
        (1e-3, 0.0, lambda M, L: 3.0 / M),
        (1e8, 0.0, lambda M, L: 2.621 * M**-0.2),
        (1e-2, 1e9, lambda M, L: 1.287 * L ** (2.0 / 3.0)),
        (1e8, 1e3, lambda M, L: 1.311 * M**-0.125 * L**0.75),
    ],
    ids=["rigid isoviscous", "elastic isoviscous", "rigid piezoviscous", "elastic piezoviscous"],
)
def test_limits_of_the_film_after_moes(M, L, limit):
    assert moes(M, L) == pytest.approx(limit(M, L), rel=2e-3)


@pytest.mark.parametrize("law", [one for one in FILM_THICKNESS.values() if one.shape == "line"])
def test_line_films_grow_with_speed_to_the_power_of_about_seven_tenths(law):
    given = {key: jnp.asarray(v) for key, v in LINE.items()}
    slope = jax.grad(lambda u: jnp.log(law.function(**{**given, "entrainment": jnp.exp(u)})))
    assert 0.64 <= float(slope(jnp.log(2.0))) <= 0.72


@pytest.mark.parametrize(
    ("name", "exponent"), [("entrainment", 0.68), ("viscosity", 0.68), ("load", -0.073)]
)
def test_exponents_of_the_elliptic_film(name, exponent):
    law, given = hamrock_dowson_1977, ELLIPSE
    ratio = value(law, given, **{name: 3.0 * given[name]}) / value(law, given)
    assert ratio == pytest.approx(3.0**exponent, rel=1e-12)


# Converged full solutions of line contacts with a compressible, Roelands oil: Hertz pressure [Pa],
# speed [m/s], radius [m], minimum film [m], rolling resistance [N/m], central film [m].
CONVERGED = [
    (0.5e9, 1.0, 0.01, 288.2e-9, 37.27, 338.2e-9),
    (1.0e9, 0.1, 0.01, 48.64e-9, 8.545, 55.25e-9),
    (1.0e9, 1.0, 0.01, 250.9e-9, 44.83, 285.2e-9),
]
# Ratio of solution to formula over eight such cases.
RATIOS = [
    (dowson_higginson_1959, 3, 0.95, 1.02),
    (dowson_1968, 3, 0.95, 1.02),
    (pan_hamrock_1989, 3, 1.01, 1.10),
    (pan_hamrock_1989_central, 5, 1.02, 1.15),
    (dowson_toyoda_1979, 5, 0.80, 0.88),
    (moes_1992, 5, 0.81, 0.88),
    (wu_cheng_1991, 4, 0.95, 1.22),
]


@pytest.mark.parametrize(("law", "column", "low", "high"), RATIOS)
@pytest.mark.parametrize("row", CONVERGED)
def test_regressions_are_near_converged_solutions(row, law, column, low, high):
    pressure, speed, radius = row[:3]
    modulus = 2.26e11
    line_load = 2.0 * np.pi * radius * pressure**2 / modulus
    found = value(
        law,
        {"viscosity": 0.04, "pressure_viscosity": 2.2e-8, "modulus": modulus},
        line_load=line_load,
        entrainment=speed,
        radius=radius,
    )
    assert low - 0.005 <= row[column] / found <= high + 0.005


def test_rolling_resistance_of_a_1000_newton_contact():
    # The value is for W = F/(E' R^2): a contact line as long as the radius, 10 mm.
    found = value(wu_cheng_1991, LINE, line_load=1000.0 / 0.01)
    assert found == pytest.approx(32.6024, abs=5e-5)


def test_rolling_resistance_from_its_groups():
    G, U, W, alpha = 4972.0, 1.77e-11, 1.23e-4, 2.2e-8
    modulus = G / alpha
    found = value(
        wu_cheng_1991,
        {"radius": 0.01, "pressure_viscosity": alpha, "modulus": modulus},
        line_load=W * modulus * 0.01,
        viscosity=0.04,
        entrainment=U * modulus * 0.01 / 0.04,
    )
    assert found == pytest.approx(39.910, abs=5e-4)


@pytest.mark.parametrize(
    ("name", "exponent"), [("entrainment", 0.658), ("viscosity", 0.658), ("line_load", 0.0126)]
)
def test_exponents_of_the_rolling_resistance(name, exponent):
    ratio = value(wu_cheng_1991, LINE, **{name: 3.0 * LINE[name]}) / value(wu_cheng_1991, LINE)
    assert ratio == pytest.approx(3.0**exponent, rel=1e-12)


LAWS = [(entry.function, entry.shape) for entry in FILM_THICKNESS.values()]
LAWS.append((ROLLING_RESISTANCE["wu_cheng_1991"].function, "line"))


@pytest.mark.parametrize(("law", "shape"), LAWS)
@pytest.mark.parametrize("missing", ["load", "entrainment"])
def test_no_load_or_no_speed_gives_none_with_a_finite_gradient(law, shape, missing):
    given = {key: jnp.asarray(v) for key, v in (LINE if shape == "line" else ELLIPSE).items()}
    name = "line_load" if (missing, shape) == ("load", "line") else missing
    nothing, slope = jax.value_and_grad(lambda v: law(**{**given, name: v}))(jnp.asarray(0.0))
    assert float(nothing) == 0.0
    assert np.isfinite(slope)


@pytest.mark.parametrize(("law", "shape"), LAWS)
def test_laws_do_not_depend_on_the_unit_of_length_and_time(law, shape):
    """Lengths, masses and times scaled together: the result scales by its own dimension."""
    L, M, T = 3.0, 5.0, 0.7
    force, stress, speed = M * L / T**2, M / (L * T**2), L / T
    scale = {
        "line_load": force / L,
        "load": force,
        "entrainment": speed,
        "viscosity": stress * T,
        "pressure_viscosity": 1.0 / stress,
        "radius": L,
        "transverse_radius": L,
        "modulus": stress,
    }
    given = LINE if shape == "line" else ELLIPSE
    scaled = {key: v * scale[key] for key, v in given.items()}
    expected = value(law, given) * (force / L if law is wu_cheng_1991 else L)
    assert value(law, scaled) == pytest.approx(expected, rel=1e-12)
