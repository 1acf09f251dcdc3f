"""Line contacts against closed forms."""

import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.hertz import line_half_width, line_pressure, line_shear

MODULUS = 226e9
LINE = {
    "line_load": jnp.asarray(1.2e5),
    "radius": jnp.asarray(7e-3),
    "modulus": jnp.asarray(MODULUS),
}


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


def test_pressure_grows_with_the_load():
    heavy = line_pressure(**{**LINE, "line_load": 4.0 * LINE["line_load"]})
    assert float(heavy / line_pressure(**LINE)) == pytest.approx(2.0, rel=1e-14)


@pytest.mark.parametrize(
    "pressure",
    [
        lambda load: line_pressure(**{**LINE, "line_load": load}),
        lambda load: line_half_width(**{**LINE, "line_load": load}),
    ],
    ids=["line pressure", "half-width"],
)
def test_no_load_is_finite_with_its_gradient(pressure):
    value, slope = jax.value_and_grad(pressure)(jnp.asarray(0.0))
    assert float(value) == 0.0
    assert np.isfinite(slope)


def test_shear_below_a_line_is_largest_where_it_is_said_to_be():
    stress, depth = line_shear(pressure=1.0, half_width=1.0)
    below = np.linspace(0.7, 0.9, 20_001)
    shear = below - below**2 / np.sqrt(1.0 + below**2)
    assert stress == pytest.approx(shear.max(), rel=1e-9)
    assert depth == pytest.approx(below[shear.argmax()], abs=1e-5)
