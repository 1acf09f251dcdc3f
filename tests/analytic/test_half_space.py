"""Deflection of half spaces on a grid, beside sums, point loads, lines and mirrored loads."""

import equinox as eqx
import jax
import numpy as np
import pytest

from pitchpoint.contact.half_space import HalfSpace, graded_edges, half_space
from pitchpoint.errors import InputError

MODULUS = 226.4e9
X = np.linspace(-3e-4, 3e-4, 13)
EDGES = graded_edges(4e-3, 10, 1e-4)


deflected = eqx.filter_jit(HalfSpace.deflection)


@pytest.fixture(scope="module")
def bodies():
    return half_space(X, EDGES)


@pytest.fixture(scope="module")
def pressure():
    return 1e9 * np.random.default_rng(0).uniform(size=(10, 13))


def corner(x, y):
    """Love's integral as it is printed, with its limits where a logarithm ends."""
    along = 0.0 if x == 0.0 else x * np.arcsinh(y / abs(x))
    return along + (0.0 if y == 0.0 else y * np.arcsinh(x / abs(y)))


def by_cell(x, y, left, right, low, high):
    parts = (corner(right - x, high - y), corner(left - x, low - y))
    less = (corner(left - x, high - y), corner(right - x, low - y))
    return 2.0 / np.pi * (sum(parts) - sum(less))


def summed(bodies, pressure, modulus):
    """Deflection as the sum over all cells, at all cells."""
    edges = bodies.edges
    step = X[1] - X[0]
    found = np.zeros(pressure.shape)
    for (i, j), _ in np.ndenumerate(found):
        for (k, m), one in np.ndenumerate(pressure):
            sides = X[m] - step / 2, X[m] + step / 2, edges[k], edges[k + 1]
            found[i, j] += one * by_cell(X[j], bodies.y[i], *sides)
    return found / modulus


@pytest.mark.parametrize(
    "edges",
    [EDGES, EDGES - 1e-3, np.linspace(-2.0, 1.0, 10) * 1e-3, np.geomspace(1.0, 2.0, 11) * 1e-3],
    ids=["symmetric", "symmetric about another middle", "with a row in the middle", "other"],
)
def test_the_convolution_is_the_direct_sum(edges, pressure):
    bodies, pressure = half_space(X, edges), pressure[: len(edges) - 1]
    found = np.asarray(deflected(bodies, pressure, MODULUS))
    direct = summed(bodies, pressure, MODULUS)
    np.testing.assert_allclose(found, direct, rtol=0, atol=1e-12 * direct.max())


def test_symmetric_edges_need_half_the_numbers():
    even, other = half_space(X, EDGES), half_space(X, np.geomspace(1.0, 2.0, 11) * 1e-3)
    assert even.spectrum.size == other.spectrum.size // 2


def test_a_symmetric_pressure_deflects_symmetrically(bodies, pressure):
    even = pressure + pressure[::-1]
    even = even + even[:, ::-1]
    found = np.asarray(deflected(bodies, even, MODULUS))
    np.testing.assert_allclose(found, found[::-1], rtol=1e-13)
    np.testing.assert_allclose(found, found[:, ::-1], rtol=1e-13)


def test_far_away_a_cell_is_a_point_load():
    x = np.linspace(-1.0, 1.0, 101)
    bodies = half_space(x, np.linspace(-0.05, 0.05, 6))
    pressure = np.zeros((5, 101))
    pressure[2, 0] = 1.0
    found = float(deflected(bodies, pressure, MODULUS)[2, -1])
    assert found == pytest.approx(2.0 * bodies.areas[2] / (np.pi * MODULUS * 2.0), rel=1e-4)


def test_a_long_line_has_the_logarithm_of_an_endless_one():
    length = 400.0
    x = np.linspace(-1.0, 1.0, 41)
    bodies = half_space(x, graded_edges(length, 200, 1.0))
    pressure = np.zeros((200, 41))
    pressure[:, 20] = 1.0
    found = np.asarray(deflected(bodies, pressure, 1.0))[100]
    load = x[1] - x[0]
    away = np.log(np.abs(x[30:] / x[40]))
    # From the middle of a long line: 2 w/pi (ln(L/|x|)), Johnson eq. 2.19 for w of one.
    np.testing.assert_allclose(found[30:] - found[40], -4.0 * load / np.pi * away, rtol=1e-3)
    assert found[40] == pytest.approx(4.0 * load / np.pi * np.log(length), rel=1e-3)


def test_lines_are_rows_of_the_whole(bodies, pressure):
    alone = np.zeros_like(pressure)
    alone[3] = pressure[3]
    found = deflected(bodies, alone, 1.0)[3]
    np.testing.assert_allclose(bodies.lines()[3] @ pressure[3], found, rtol=1e-12)


def test_mirrored_ends_are_a_pressure_on_the_bodies_gone_on_beyond_them(pressure):
    length = EDGES[-1] - EDGES[0]
    beyond = np.concatenate((EDGES[:-1] - length, EDGES[:-1], EDGES + length))
    whole = half_space(X, np.concatenate((beyond[:10], beyond[10:20], beyond[20:])))
    thrice = np.concatenate((pressure[::-1], pressure, pressure[::-1]))
    # The edges are symmetric, so the mirrored cells are those of the row beyond.
    found = np.asarray(deflected(half_space(X, EDGES, "mirrored"), pressure, MODULUS))
    np.testing.assert_allclose(found, deflected(whole, thrice, MODULUS)[10:20], rtol=1e-12)


def test_the_load_is_the_sum_over_the_cells(bodies):
    assert bodies.load(np.full((10, 13), 2e6)) == pytest.approx(2e6 * 4e-3 * 6.5e-4)


def test_deflections_have_derivatives_and_are_compiled(bodies, pressure):
    squares = eqx.filter_jit(lambda one, of: (one.deflection(of, MODULUS) ** 2).sum())
    found = np.asarray(jax.grad(squares, argnums=1)(bodies, pressure))
    step = np.zeros_like(pressure)
    step[4, 5] = 1e5
    ahead, behind = (float(squares(bodies, pressure + sign * step)) for sign in (1.0, -1.0))
    assert found[4, 5] == pytest.approx((ahead - behind) / 2e5, rel=1e-8)


@pytest.mark.parametrize(
    ("x", "edges", "ends", "words"),
    [
        (X**3, EDGES, "half_space", "uniform steps"),
        (X * np.nan, EDGES, "half_space", "uniform steps"),
        (X[::-1], EDGES, "half_space", "uniform steps"),
        (X, EDGES[::-1], "half_space", "have to rise"),
        (X[:2], EDGES, "half_space", "at least three cells"),
        (X, EDGES, "welded", 'no ends "welded"'),
    ],
)
def test_grids_that_are_none_are_told(x, edges, ends, words):
    with pytest.raises(InputError, match=words):
        half_space(x, edges, ends)


@pytest.mark.parametrize(("cells", "end"), [(9, 0.1), (2, 0.1), (10, 0.0), (10, 0.5)])
def test_edges_that_cannot_grow_are_told(cells, end):
    with pytest.raises(InputError, match="end cells"):
        graded_edges(4.0, cells, end)
