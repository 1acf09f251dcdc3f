"""Stresses below contacts, beside Hertz's and Boussinesq's."""

import equinox as eqx
import jax
import numpy as np
import pytest
from sound import quick_first

from pitchpoint._jax import jnp
from pitchpoint.contact.ellipse import hertz_1881, largest_shear
from pitchpoint.contact.half_space import graded_edges, half_space
from pitchpoint.contact.hertz import line_shear
from pitchpoint.contact.subsurface import Stresses, below_row
from pitchpoint.errors import InputError

sheared = eqx.filter_jit(Stresses.largest_shear)
compared = eqx.filter_jit(Stresses.von_mises)

DEPTH = np.linspace(0.3, 1.2, 91)
X = np.linspace(-1.5, 1.5, 65)


def below_an_ellipse(across, poisson=0.3):
    """Stresses below the middle of an elliptic contact with a semi-axis of one along x."""
    bodies = half_space(X, np.linspace(-1.1, 1.1, 65) * across)
    far = bodies.x**2 + (bodies.y[:, None] / across) ** 2
    pressure = np.sqrt(np.maximum(1.0 - far, 0.0))
    return jax.tree.map(np.asarray, below_row(bodies, pressure, DEPTH, poisson, 32))


@pytest.mark.whole
@pytest.mark.parametrize("across", quick_first([3.0, 1.0]))
@pytest.mark.parametrize("poisson", quick_first([0.3, 0.4]))
def test_below_an_ellipse_it_is_that_of_hertz(across, poisson):
    """Ratios of radii are those that make the ellipse; the closed form is asked for its shear."""
    radii = {"radius": 1.0, "transverse_radius": 1.0, "load": 1.0, "modulus": 1e6}
    if across > 1.0:
        ratios = np.geomspace(1.0, 40.0, 4000)
        every = hertz_1881(**radii | {"transverse_radius": ratios})
        radii["transverse_radius"] = np.interp(across, every.across / every.along, ratios)
    hertz = hertz_1881(**{name: jnp.asarray(one) for name, one in radii.items()})
    stress, depth = largest_shear(hertz, poisson)
    shear = np.asarray(sheared(below_an_ellipse(across, poisson)))[:, 32]
    assert shear.max() == pytest.approx(float(stress / hertz.pressure), rel=3e-3)
    assert DEPTH[shear.argmax()] == pytest.approx(float(depth / hertz.along), abs=0.02)


@pytest.mark.whole
def test_below_a_ball_von_mises_is_the_difference_on_the_axis():
    found = below_an_ellipse(1.0)
    middle = np.asarray(compared(found))[:, 32]
    shear = np.asarray(sheared(found))[:, 32]
    # Two principal stresses are equal there.
    np.testing.assert_allclose(middle, 2.0 * shear, rtol=1e-3)


def below_a_line(poisson):
    bodies = half_space(X, graded_edges(4000.0, 64, 20.0))
    pressure = np.broadcast_to(np.sqrt(np.maximum(1.0 - X**2, 0.0)), (64, 65))
    found = below_row(bodies, np.ascontiguousarray(pressure), DEPTH, poisson, 31)
    return jax.tree.map(np.asarray, found)


@pytest.mark.whole
def test_below_a_long_line_it_is_that_of_plane_strain():
    found = below_a_line(0.3)
    stress, depth = line_shear(pressure=1.0, half_width=1.0)
    shear = np.asarray(sheared(found))[:, 32]
    assert shear.max() == pytest.approx(stress, rel=3e-3)
    assert DEPTH[shear.argmax()] == pytest.approx(depth, abs=0.02)
    np.testing.assert_allclose(found.yy, 0.3 * (found.xx + found.zz), atol=1e-3)
    # Johnson eqs. 4.46a and b, on the axis.
    root = np.sqrt(1.0 + DEPTH**2)
    np.testing.assert_allclose(found.zz[:, 32], -1.0 / root, rtol=3e-3)
    sideways = -((1.0 + 2.0 * DEPTH**2) / root - 2.0 * DEPTH)
    np.testing.assert_allclose(found.xx[:, 32], sideways, atol=3e-3)


def boussinesq(x, y, z, poisson):
    """Stresses below a point load of one, Johnson eqs. 3.20, turned to x and y."""
    flat, r = np.hypot(x, y), np.sqrt(x**2 + y**2 + z**2)
    slack, lean = 1.0 - 2.0 * poisson, (1.0 - z / r) / flat**2
    outwards = (slack * lean - 3.0 * z * flat**2 / r**5) / (2.0 * np.pi)
    around = -slack * (lean - z / r**3) / (2.0 * np.pi)
    down, cut = -3.0 * z**3 / r**5 / (2.0 * np.pi), -3.0 * flat * z**2 / r**5 / (2.0 * np.pi)
    cosine, sine = x / flat, y / flat
    return {
        "xx": outwards * cosine**2 + around * sine**2,
        "yy": outwards * sine**2 + around * cosine**2,
        "zz": down,
        "xy": (outwards - around) * sine * cosine,
        "yz": cut * sine,
        "zx": cut * cosine,
    }


@pytest.mark.whole
@pytest.mark.parametrize("name", ["xx", "yy", "zz", "xy", "yz", "zx"])
def test_a_cell_far_away_is_a_point_load(name):
    bodies = half_space(X, np.linspace(-1.1, 1.1, 65))
    pressure = np.zeros((64, 65))
    pressure[10, 20] = 1.0 / bodies.areas[10]
    found = below_row(bodies, pressure, DEPTH, 0.3, 50)
    x, y = bodies.x[45] - bodies.x[20], bodies.y[50] - bodies.y[10]
    expected = boussinesq(x, y, DEPTH, 0.3)[name]
    at = np.asarray(getattr(found, name))[:, 45]
    np.testing.assert_allclose(at, expected, atol=2e-3 * np.abs(expected).max())


@pytest.mark.whole
def test_close_to_the_surface_it_is_the_pressure():
    bodies = half_space(X, np.linspace(-1.1, 1.1, 65))
    pressure = np.random.default_rng(0).uniform(size=(64, 65))
    found = below_row(bodies, pressure, np.full(91, 1e-6), 0.3, 7)
    np.testing.assert_allclose(np.asarray(found.zz)[0], -pressure[7], rtol=1e-3)


PRESSURE = np.ones((64, 65))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pressure": PRESSURE[:, 1:]}, "a finite pressure on each of (64, 65) cells"),
        ({"pressure": PRESSURE * np.nan}, "a finite pressure"),
        ({"depth": np.array([0.0, 1.0])}, "depth: depths below the surface have to be positive"),
        ({"poisson": 0.6}, "poisson: a Poisson's ratio of 0.6"),
        ({"row": 64}, "there is no row 64: the grid has 64"),
    ],
)
def test_bad_input_is_told(change, words):
    bodies = half_space(X, np.linspace(-1.1, 1.1, 65))
    given = {"pressure": PRESSURE, "depth": DEPTH, "poisson": 0.3} | change
    with pytest.raises(InputError) as told:
        below_row(bodies, **given)
    assert words in str(told.value)
