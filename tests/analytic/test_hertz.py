"""Hertz pressure against closed forms and the exact solution with elliptic integrals."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.hertz import elliptic_pressure, line_half_width, line_pressure

MODULUS = 226e9
LINE = {
    "line_load": jnp.asarray(1.2e5),
    "radius": jnp.asarray(7e-3),
    "modulus": jnp.asarray(MODULUS),
}


def ellipse(load=500.0, radius=7e-3, transverse=7e-3):
    values = {"load": load, "radius": radius, "transverse_radius": transverse, "modulus": MODULUS}
    return elliptic_pressure(**{key: jnp.asarray(value) for key, value in values.items()})


def test_line_contact_carries_its_load():
    b, peak = float(line_half_width(**LINE)), float(line_pressure(**LINE))
    assert peak == pytest.approx(2.0 * 1.2e5 / (np.pi * b), rel=1e-14)
    x = np.cos((np.arange(200) + 0.5) * np.pi / 200)  # Gauss-Chebyshev of the second kind
    semi_ellipse = b * peak * np.sum(np.pi / 200 * (1 - x**2))
    assert semi_ellipse == pytest.approx(1.2e5, rel=1e-12)


def test_line_pressure_and_half_width_relations():
    b, peak = float(line_half_width(**LINE)), float(line_pressure(**LINE))
    assert peak / MODULUS == pytest.approx(b / (4.0 * 7e-3), rel=1e-14)
    W = 1.2e5 / (MODULUS * 7e-3)
    assert b == pytest.approx(7e-3 * np.sqrt(8.0 * W / np.pi), rel=1e-14)
    assert peak == pytest.approx(MODULUS * np.sqrt(W / (2.0 * np.pi)), rel=1e-14)


def test_line_pressure_of_a_published_contact():
    """1 GPa for W = 1.2302e-4, R = 10 mm, E' = 226 GPa."""
    peak = line_pressure(
        line_load=jnp.asarray(1.2302e-4 * 2.26e11 * 0.01),
        radius=jnp.asarray(0.01),
        modulus=jnp.asarray(2.26e11),
    )
    assert float(peak) == pytest.approx(1e9, rel=5e-5)


def test_circle_is_the_closed_form():
    contact_modulus = MODULUS / 2.0
    exact = np.cbrt(6.0 * 500.0 * contact_modulus**2 / (np.pi**3 * 7e-3**2))
    assert float(ellipse()) == pytest.approx(exact, rel=1e-14)


def exact_pressure(load, radius, transverse):
    """Johnson, Contact Mechanics, eqs. 4.26 to 4.28, solved for the shape of the ellipse."""
    flat, curved = sorted([0.5 / radius, 0.5 / transverse])

    def sums(ratio):
        squared = 1.0 - ratio**-2
        return ratio**2 * ellipe(squared) - ellipk(squared), ellipk(squared) - ellipe(squared)

    ratio = brentq(lambda r: sums(r)[0] / sums(r)[1] - curved / flat, 1.0 + 1e-7, 1e3, xtol=1e-13)
    upper, lower = sums(ratio)
    eccentric = 1.0 - ratio**-2
    # sqrt(AB) = p0/E* b/(a^2 e^2) sqrt(...), a = ratio b, and 3F = 2 pi a b p0.
    bend = np.sqrt(upper * lower) / (ratio**2 * eccentric)
    slope = np.sqrt(flat * curved) * MODULUS / 2.0 / bend  # p0/b
    b = np.cbrt(1.5 * load / (np.pi * ratio * slope))
    return slope * b


@pytest.mark.parametrize("ratio", [0.01, 0.05, 0.3, 0.8, 1.25, 3.0, 10.0, 30.0, 100.0])
def test_ellipse_is_near_the_exact_solution(ratio):
    exact = exact_pressure(500.0, 7e-3, 7e-3 * ratio)
    assert float(ellipse(transverse=7e-3 * ratio)) == pytest.approx(exact, rel=0.03)


def test_exact_solution_tends_to_the_circle():
    assert exact_pressure(500.0, 7e-3, 7.0007e-3) == pytest.approx(float(ellipse()), rel=1e-4)


def test_ellipse_does_not_care_which_direction_is_called_first():
    one, other = ellipse(radius=5e-3, transverse=20e-3), ellipse(radius=20e-3, transverse=5e-3)
    assert float(one) == pytest.approx(float(other), rel=1e-14)


def test_pressure_grows_with_the_load():
    assert float(ellipse(load=4000.0) / ellipse()) == pytest.approx(2.0, rel=1e-14)
    heavy = line_pressure(**{**LINE, "line_load": 4.0 * LINE["line_load"]})
    assert float(heavy / line_pressure(**LINE)) == pytest.approx(2.0, rel=1e-14)


@pytest.mark.parametrize(
    "pressure",
    [
        lambda load: line_pressure(**{**LINE, "line_load": load}),
        lambda load: line_half_width(**{**LINE, "line_load": load}),
        lambda load: ellipse(load=load),
    ],
    ids=["line pressure", "half-width", "ellipse"],
)
def test_no_load_is_finite_with_its_gradient(pressure):
    value, slope = jax.value_and_grad(pressure)(jnp.asarray(0.0))
    assert float(value) == 0.0
    assert np.isfinite(slope)
