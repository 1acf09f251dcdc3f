"""Elliptic contacts against the integrals of another library, the half space itself and published tables."""

from functools import partial

import numpy as np
import pytest
import scipy.special
from scipy.optimize import brentq

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contact_registry import ELLIPTIC_CONTACT
from pitchpoint.contact.ellipse import (
    Ellipse,
    _principal_stresses,
    hamrock_brewe_1983,
    hertz_1881,
    largest_shear,
)
from pitchpoint.contact.elliptic_integrals import carlson_rd, carlson_rf, complete_integrals
from pitchpoint.contact.hertz import line_half_width, line_pressure, line_shear

MODULUS = 226e9
RATIOS = (1e-3, 0.01, 0.3, 1.0, 1.25, 3.0, 30.0, 1e3)


@partial(jax.jit, static_argnames="law")
def contact(load=500.0, radius=7e-3, transverse=7e-3, law=hertz_1881):
    values = {"load": load, "radius": radius, "transverse_radius": transverse, "modulus": MODULUS}
    return law(**{key: jnp.asarray(value, float) for key, value in values.items()})


shear_below = jax.jit(largest_shear)


def pressed(along, across, pressure=1.0):
    return Ellipse(*map(jnp.asarray, (along, across, pressure, 1.0, 1.0)))


@pytest.mark.parametrize(
    ("own", "other"),
    [(carlson_rf, scipy.special.elliprf), (carlson_rd, scipy.special.elliprd)],
    ids=["R_F", "R_D"],
)
def test_symmetric_integrals_are_those_of_another_library(own, other):
    x, y, z = 10.0 ** np.random.default_rng(3).uniform(-6.0, 6.0, (3, 500))
    for first in (x, 0.0 * x):
        np.testing.assert_allclose(jax.jit(own)(first, y, z), other(first, y, z), rtol=3e-15)


def test_complete_integrals_are_those_of_another_library():
    complement = np.geomspace(1e-10, 1e3, 200)
    whole, cosine, sine = jax.jit(complete_integrals)(complement)
    np.testing.assert_allclose(whole, scipy.special.ellipkm1(complement), rtol=2e-15)
    np.testing.assert_allclose(cosine + sine, whole, rtol=2e-15)
    second = whole - (1.0 - complement) * sine
    np.testing.assert_allclose(second, scipy.special.ellipe(1.0 - complement), rtol=2e-14)


def test_derivative_of_a_complete_integral_is_the_closed_form():
    """dK/dm = (E/(1 - m) - K)/(2 m)."""
    slope = jax.jit(jax.grad(lambda complement: complete_integrals(complement)[0]))(0.3)
    first, second = scipy.special.ellipk(0.7), scipy.special.ellipe(0.7)
    assert float(slope) == pytest.approx(-(second / 0.3 - first) / 1.4, rel=1e-13)


def dipped(found: Ellipse, x: float, y: float) -> float:
    """Depth of the half space's surface under the contact's pressure, summed over rays through a point."""
    across, along = float(found.across), float(found.along)
    turn = np.pi * np.arange(4000) / 4000
    cosine, sine = np.cos(turn), np.sin(turn)
    bend = (cosine / along) ** 2 + (sine / across) ** 2
    lean = x * cosine / along**2 + y * sine / across**2
    inside = 1.0 - (x / along) ** 2 - (y / across) ** 2
    # Along a ray the pressure is half an ellipse: its area is that of its height and half-length.
    rays = np.pi / 2.0 * (inside + lean**2 / bend) / np.sqrt(bend)
    return float(found.pressure) / (np.pi * MODULUS / 2.0) * np.pi * np.mean(rays)


@pytest.mark.parametrize("ratio", [0.05, 0.4, 1.0, 3.0, 30.0])
def test_pressure_dips_the_half_space_as_the_bodies_ask(ratio):
    found = contact(transverse=7e-3 * ratio)
    along, across = float(found.along), float(found.across)
    carried = 2.0 / 3.0 * np.pi * along * across * float(found.pressure)
    assert carried == pytest.approx(500.0, rel=1e-14)
    for part_x, part_y in ((0.0, 0.0), (0.7, 0.0), (0.0, 0.7), (0.5, -0.4)):
        x, y = part_x * along, part_y * across
        asked = float(found.approach) - x**2 / 14e-3 - y**2 / (14e-3 * ratio)
        assert dipped(found, x, y) == pytest.approx(asked, rel=1e-11)


def test_circle_is_the_closed_form():
    star = MODULUS / 2.0
    for law in (hertz_1881, hamrock_brewe_1983):
        found = contact(law=law)
        width = np.cbrt(0.75 * 500.0 * 7e-3 / star)
        assert float(found.along) == pytest.approx(width, rel=1e-13)
        assert float(found.across) == pytest.approx(width, rel=1e-13)
        assert float(found.approach) == pytest.approx(width**2 / 7e-3, rel=1e-13)
        assert float(found.pressure) == pytest.approx(750.0 / np.pi / width**2, rel=1e-13)


@pytest.mark.parametrize("law", [hertz_1881, hamrock_brewe_1983])
def test_either_axis_may_lie_along_the_rolling_direction(law):
    one = contact(radius=5e-3, transverse=20e-3, law=law)
    other = contact(radius=20e-3, transverse=5e-3, law=law)
    for name, turned in (("along", "across"), ("pressure", "pressure"), ("approach", "approach")):
        assert float(getattr(one, name)) == pytest.approx(float(getattr(other, turned)), rel=1e-13)


@pytest.mark.parametrize("ratio", [0.01, 0.05, 0.3, 0.8, 1.25, 3.0, 10.0, 30.0, 100.0])
def test_powers_are_near_the_integrals(ratio):
    exact, near = (
        contact(transverse=7e-3 * ratio, law=law) for law in (hertz_1881, hamrock_brewe_1983)
    )
    for name, within in (("pressure", 0.03), ("approach", 0.05), ("across", 0.03), ("along", 0.03)):
        assert float(getattr(near, name)) == pytest.approx(float(getattr(exact, name)), rel=within)


def test_published_contact_of_a_torus_involute_pair():
    """4257 N at the pitch point: R_x 9.415 mm, R_y 281.42 mm, two of steel."""
    given = {"load": 4257.0, "radius": 9.415e-3, "transverse": 0.28142}
    exact, near = contact(**given), contact(**given, law=hamrock_brewe_1983)
    scale = np.cbrt(MODULUS / (206e9 / 0.91))
    for found, across, along, pressure in (
        (exact, 2.97e-3, 0.335e-3, 2.042e9),
        (near, 2.93e-3, 0.337e-3, 2.06e9),
    ):
        assert float(found.across) * scale == pytest.approx(across, rel=5e-3)
        assert float(found.along) * scale == pytest.approx(along, rel=5e-3)
        assert float(found.pressure) / scale**2 == pytest.approx(pressure, rel=5e-3)


@pytest.mark.parametrize("name", ELLIPTIC_CONTACT)
def test_stiffness_is_the_slope_of_the_load(name):
    law = ELLIPTIC_CONTACT[name].function
    slope = jax.grad(lambda load: contact(load, transverse=0.03, law=law).approach)(700.0)
    stiffness = contact(700.0, transverse=0.03, law=law).stiffness
    assert float(slope * stiffness) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.whole
def test_derivatives_are_those_of_differences():
    @jax.jit
    def figures(radius):
        found = contact(radius=radius, transverse=0.05)
        return jnp.stack([*jax.tree.leaves(found), *largest_shear(found, 0.3)])

    step = 1e-8
    slopes = (figures(7e-3 + step) - figures(7e-3 - step)) / (2.0 * step)
    np.testing.assert_allclose(jax.jit(jax.jacfwd(figures))(7e-3), slopes, rtol=1e-6)
    np.testing.assert_allclose(jax.jit(jax.jacrev(figures))(7e-3), slopes, rtol=1e-6)


def test_no_load_is_finite_with_its_gradient():
    for name in ("pressure", "approach", "along", "across"):
        value, slope = jax.value_and_grad(lambda load, name=name: getattr(contact(load), name))(0.0)
        assert float(value) == 0.0
        assert np.isfinite(slope)
    stress, depth = shear_below(contact(0.0), 0.3)
    assert (float(stress), float(depth)) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("ratio", "depth", "stress"),
    [
        (0.0, 0.785, 0.300),
        (0.2, 0.745, 0.322),
        (0.4, 0.665, 0.325),
        (0.6, 0.590, 0.323),
        (0.8, 0.530, 0.317),
        (1.0, 0.480, 0.310),
    ],
)
def test_largest_shear_is_that_of_a_published_table(ratio, depth, stress):
    """Johnson, Contact Mechanics (1985), table 4.1, nu = 0.3: depth over the shorter semi-axis."""
    short = max(ratio, 1e-4)
    for along, across in ((short, 1.0), (1.0, short)):
        found, below = shear_below(pressed(along, across), 0.3)
        assert float(found) == pytest.approx(stress, abs=1.5e-3)
        assert float(below) / short == pytest.approx(depth, abs=8e-3)


def test_shear_of_a_long_ellipse_is_that_of_a_line():
    load = 1e5
    given = {"line_load": load, "radius": 7e-3, "modulus": MODULUS}
    width, pressure = line_half_width(**given), line_pressure(**given)
    stress, depth = line_shear(pressure=pressure, half_width=width)
    found, below = shear_below(pressed(width, 1e8 * width, pressure), 0.28)
    assert float(found) == pytest.approx(float(stress), rel=1e-7)
    assert float(below) == pytest.approx(float(depth), rel=1e-6)


def axis_stress(squeeze, depth, poisson, direction):
    """Stress on the normal under the pressure, by rings of point forces; p_0 = a = 1, b = squeeze."""
    turn = 2.0 * np.pi * (np.arange(400) + 0.5) / 400
    node, weight = np.polynomial.legendre.leggauss(400)
    # Density of load over an ellipse: r = sin(t) takes the root at its edge out.
    t = np.pi / 4.0 * (node + 1.0)
    part, density = np.sin(t), np.cos(t) ** 2 * np.pi / 4.0 * weight
    x = part[:, None] * np.cos(turn)
    y = squeeze * part[:, None] * np.sin(turn)
    force = squeeze * (part * density)[:, None] * 2.0 * np.pi / 400
    far = np.sqrt(x**2 + y**2 + depth**2)
    if direction == "normal":
        return -np.sum(force * 3.0 * depth**3 / (2.0 * np.pi * far**5))
    along, other = (x, y) if direction == "long" else (y, x)
    square = x**2 + y**2
    part_a = (
        (1.0 - 2.0 * poisson)
        / square
        * ((1.0 - depth / far) * (along**2 - other**2) / square + depth * other**2 / far**3)
    )
    return np.sum(force * (part_a - 3.0 * depth * along**2 / far**5)) / (2.0 * np.pi)


@pytest.mark.parametrize("squeeze", [0.3, 0.8])
def test_stresses_below_are_those_of_point_forces(squeeze):
    for depth in (0.2, 0.7):
        found = jax.jit(_principal_stresses)(depth, squeeze, 0.3)
        for value, direction in zip(found, ("normal", "long", "short"), strict=True):
            asked = axis_stress(squeeze, depth, 0.3, direction)
            assert float(value) == pytest.approx(asked, rel=1e-8)


@pytest.mark.parametrize("ratio", RATIOS)
def test_ratio_of_axes_is_that_of_a_root_finder(ratio):
    found = contact(transverse=7e-3 * ratio)

    def missing(log):
        _, cosine, sine = jax.jit(complete_integrals)(np.exp(-2.0 * log))
        return 2.0 * log + np.log(cosine / sine) - np.log(ratio)

    asked = np.exp(brentq(missing, -8.0, 8.0, xtol=1e-14))
    assert float(found.across / found.along) == pytest.approx(asked, rel=1e-12)
