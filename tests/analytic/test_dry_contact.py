"""Dry contact on a grid beside Hertz, long rollers and their ends."""

import equinox as eqx
import jax
import numpy as np
import pytest

from pitchpoint.contact.contact_registry import END_PROFILES
from pitchpoint.contact.dry_contact import dry_contact, near_ends, pressed
from pitchpoint.contact.ellipse import hertz_1881
from pitchpoint.contact.end_profiles import chamfered, crowned, dub_off, log_relieved, straight
from pitchpoint.contact.gaps import elliptic_gap, line_gap, missing_along
from pitchpoint.contact.half_space import graded_edges, half_space
from pitchpoint.contact.hertz import line_half_width, line_pressure
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError

MODULUS, RADIUS, LOAD = 226.4e9, 0.01, 1e5
HALF_WIDTH = float(line_half_width(line_load=LOAD, radius=RADIUS, modulus=MODULUS))
PRESSURE = float(line_pressure(line_load=LOAD, radius=RADIUS, modulus=MODULUS))
LENGTH = 56.5 * HALF_WIDTH
X = np.linspace(-2.0, 2.0, 65) * HALF_WIDTH


def on_host(tree):
    """NumPy compiles nothing for the comparisons that follow."""
    return jax.tree.map(np.asarray, tree)


def point(radius, transverse, load=30.0):
    """A ball or a barrel on a plane with the ellipse of Hertz."""
    given = {"radius": radius, "transverse_radius": transverse, "modulus": MODULUS}
    hertz = on_host(hertz_1881(load=load, **given))
    along, across = float(hertz.along), float(hertz.across)
    bodies = half_space(np.linspace(-1.3, 1.3, 65) * along, np.linspace(-1.3, 1.3, 65) * across)
    gap = elliptic_gap(bodies, radius, transverse)
    return bodies, hertz, on_host(dry_contact(bodies, gap, MODULUS, load=load))


def roller(surfaces=(), end=0.02 * HALF_WIDTH, ends="half_space", tilt=0.0):
    bodies = half_space(X, graded_edges(LENGTH, 64, end), ends)
    relief = np.asarray(missing_along(surfaces, bodies.y)) + tilt * bodies.y
    gap = line_gap(bodies, RADIUS, relief)
    found = dry_contact(bodies, gap, MODULUS, load=LOAD * LENGTH, to_ends=True)
    return bodies, on_host(found)


@pytest.fixture(scope="module")
def straight_roller():
    return roller(straight(width=LENGTH))


@pytest.mark.parametrize("transverse", [0.01, 0.04, 0.004])
def test_points_are_those_of_hertz(transverse):
    bodies, hertz, found = point(RADIUS, transverse)
    assert found.pressure.max() == pytest.approx(float(hertz.pressure), rel=5e-4)
    assert float(found.approach) == pytest.approx(float(hertz.approach), rel=5e-4)
    held = found.pressure > 0.0
    along, across = (np.ptp(axis[held.any(axis=k)]) for k, axis in enumerate((bodies.x, bodies.y)))
    assert along == pytest.approx(2.0 * float(hertz.along), abs=2.0 * (bodies.x[1] - bodies.x[0]))
    assert across == pytest.approx(2.0 * float(hertz.across), abs=2.0 * (bodies.y[1] - bodies.y[0]))


def test_the_whole_pressure_of_a_ball_is_an_ellipsoid():
    bodies, hertz, found = point(RADIUS, RADIUS)
    far = (bodies.x**2 + bodies.y[:, None] ** 2) / float(hertz.along) ** 2
    expected = float(hertz.pressure) * np.sqrt(np.maximum(1.0 - far, 0.0))
    inside = far < 0.9
    np.testing.assert_allclose(
        found.pressure[inside], expected[inside], atol=5e-3 * float(hertz.pressure)
    )


def test_the_middle_of_a_long_roller_is_a_line_contact(straight_roller):
    _, found = straight_roller
    middle = found.pressure[31:33].mean(axis=0)
    share = middle.max() / PRESSURE
    assert share == pytest.approx(0.944, abs=1e-3)
    # By itself each slice is one of Hertz, under its own load.
    ratio = X / (share * HALF_WIDTH)
    hertz = middle.max() * np.sqrt(np.maximum(1.0 - ratio**2, 0.0))
    inside = np.abs(ratio) < 0.95
    np.testing.assert_allclose(middle[inside], hertz[inside], atol=0.01 * PRESSURE)


def test_straight_ends_at_distances(straight_roller):
    bodies, found = straight_roller
    distances = np.array([0.25, 0.5, 1.0, 2.0]) * HALF_WIDTH
    ends = near_ends(bodies, found.pressure, distances) / PRESSURE
    np.testing.assert_allclose(ends[0], [1.75, 1.40, 1.21, 1.10], rtol=0.01)
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-7)
    assert np.isnan(near_ends(bodies, found.pressure, np.array([0.005 * HALF_WIDTH]))).all()


def test_distances_from_the_end_are_converged_and_the_end_cell_is_not(straight_roller):
    bodies, coarse = straight_roller
    finer, fine = roller(end=0.005 * HALF_WIDTH)
    at = np.array([0.5, 1.0, 2.0]) * HALF_WIDTH
    on_both = [
        near_ends(one, found.pressure, at)[0] for one, found in ((bodies, coarse), (finer, fine))
    ]
    np.testing.assert_allclose(on_both[0], on_both[1], rtol=0.01)
    assert fine.pressure[0].max() > 1.5 * coarse.pressure[0].max()


def test_balance_status_and_symmetry(straight_roller):
    bodies, found = straight_roller
    pressure = found.pressure
    assert found.status.code == Code.SOLVED
    assert found.status.residual < 1e-8
    assert float(found.load) == pytest.approx(LOAD * LENGTH, rel=1e-12)
    assert float(bodies.load(pressure)) == pytest.approx(LOAD * LENGTH, rel=1e-12)
    np.testing.assert_allclose(pressure, pressure[::-1], atol=1e-6 * PRESSURE)
    np.testing.assert_allclose(pressure, pressure[:, ::-1], atol=1e-6 * PRESSURE)
    assert np.min(found.gap) > -1e-8 * float(found.approach)


def test_a_given_approach_gives_the_load_that_gives_it(straight_roller):
    bodies, found = straight_roller
    gap = line_gap(bodies, RADIUS, 0.0)
    back = dry_contact(bodies, gap, MODULUS, approach=float(found.approach), to_ends=True)
    assert float(back.load) == pytest.approx(LOAD * LENGTH, rel=1e-8)


def test_the_logarithm_takes_the_peak_away():
    surfaces = log_relieved(width=LENGTH, line_load=LOAD, modulus=MODULUS)
    bodies, found = roller(surfaces)
    ridge = found.pressure.max(axis=1) / PRESSURE
    inside = np.abs(bodies.y) < LENGTH / 2.0 - 5.0 * HALF_WIDTH
    np.testing.assert_allclose(ridge[inside], 1.0, atol=0.01)
    # The profile takes the load as that of a line: what its width adds at the ends stays.
    assert ridge.max() < 1.15
    assert ridge[0] == 0.0


@pytest.mark.parametrize(
    "surfaces",
    [
        crowned(width=LENGTH, radius=1.0),
        chamfered(width=LENGTH, length=0.1 * LENGTH, angle=2e-3),
        dub_off(width=LENGTH, length=0.1 * LENGTH, radius=0.1),
        log_relieved(width=LENGTH, line_load=LOAD, modulus=MODULUS, drop=8e-6),
    ],
    ids=["crowned", "chamfered", "dub_off", "log_relieved"],
)
def test_relieved_ends_carry_less(surfaces, straight_roller):
    _, sharp = straight_roller
    _, found = roller(surfaces)
    assert found.status.code == Code.SOLVED
    assert found.pressure[0].max() < 0.5 * sharp.pressure[0].max()
    assert float(found.load) == pytest.approx(LOAD * LENGTH, rel=1e-12)


def test_mirrored_ends_fall(straight_roller):
    bodies, sharp = straight_roller
    _, found = roller(ends="mirrored")
    at = np.array([0.25, 0.5, 1.0]) * HALF_WIDTH
    flush = near_ends(bodies, found.pressure, at)
    assert np.all(flush < 0.95 * near_ends(bodies, sharp.pressure, at))
    np.testing.assert_allclose(flush, PRESSURE, rtol=0.03)


def test_a_tilted_roller_carries_more_at_one_end():
    bodies, found = roller(tilt=2e-4)
    low, high = near_ends(bodies, found.pressure, np.array([5.0 * HALF_WIDTH]))
    assert low > 1.1 * high
    assert found.status.code == Code.SOLVED


def test_rough_surfaces_on_long_cells_settle():
    """Many cells that join the contact at once must not throw each other out again."""
    length, height = 100.0 * HALF_WIDTH, HALF_WIDTH**2 / RADIUS
    bodies = half_space(1.25 * X, np.linspace(-0.5, 0.5, 65) * length)
    bevel = 3.0 * height * np.maximum(np.abs(bodies.y) / length - 0.4, 0.0) / 0.1
    rough = 0.2 * height * np.random.default_rng(0).normal(size=(64, 65))
    gap = line_gap(bodies, RADIUS, bevel) + rough
    found = dry_contact(bodies, gap, MODULUS, load=LOAD * length, to_ends=True)
    assert int(found.status.code) == Code.SOLVED
    assert int(found.status.iterations) < 100


def test_ends_by_name_are_what_they_say():
    half, y = LENGTH / 2.0, np.array([0.0, 0.4, 0.45, 0.5]) * LENGTH
    length = 0.1 * LENGTH
    found = {
        "crowned": missing_along(crowned(width=LENGTH, radius=2.0), y),
        "chamfered": missing_along(chamfered(width=LENGTH, length=length, angle=0.01), y),
        "dub_off": missing_along(dub_off(width=LENGTH, length=length, radius=0.2), y),
        "log_relieved": missing_along(
            log_relieved(width=LENGTH, line_load=LOAD, modulus=MODULUS, drop=5e-6), y
        ),
    }
    beyond = np.maximum(y - 0.4 * LENGTH, 0.0)
    np.testing.assert_allclose(found["crowned"], y**2 / 4.0, rtol=1e-12)
    np.testing.assert_allclose(found["chamfered"], beyond * np.tan(0.01), atol=1e-18)
    np.testing.assert_allclose(found["dub_off"], beyond**2 / 0.4, atol=1e-18)
    assert float(found["log_relieved"][-1]) == pytest.approx(5e-6)
    # Near the middle it is Lundberg's, as if there were no bound.
    amount = 2.0 * LOAD / (np.pi * MODULUS)
    near = np.array([0.1 * half])
    surfaces = log_relieved(width=LENGTH, line_load=LOAD, modulus=MODULUS)
    assert float(missing_along(surfaces, near)[0]) == pytest.approx(-amount * np.log(0.99))
    assert set(found) | {"straight"} == set(END_PROFILES)


GAP = np.add.outer(np.zeros(64), X**2 / (2.0 * RADIUS))


@pytest.mark.parametrize(
    ("gap", "given", "words"),
    [
        (GAP[:-1], {"load": 1.0}, "of shape (63, 65) on a grid of (64, 65) cells"),
        (np.where(GAP > 1e-7, GAP, np.nan), {"load": 1.0}, "not a finite number"),
        (GAP, {}, "either the load or the approach"),
        (GAP, {"load": 1.0, "approach": 1e-6}, "either the load or the approach"),
        (GAP, {"load": 0.0}, "load: a load of 0: it must be positive"),
        (GAP, {"load": np.nan}, "a load of nan"),
        (GAP, {"load": 1.0, "modulus": -1.0}, "modulus: a modulus E' of -1"),
        (GAP + 1e-3, {"approach": 1e-4}, "do not touch"),
        (GAP, {"load": 30.0 * LOAD * LENGTH}, "the grid cuts the contact"),
        (GAP, {"load": LOAD * LENGTH}, "the grid cuts the contact"),
        (
            GAP,
            {"load": 1e-3 * LOAD * LENGTH, "to_ends": True},
            "cells along x and 64 across; the grid needs at least 8",
        ),
    ],
)
def test_bad_input_is_told_in_a_sentence(straight_roller, gap, given, words):
    bodies, _ = straight_roller
    with pytest.raises(InputError) as told:
        dry_contact(bodies, gap, given.pop("modulus", MODULUS), **given)
    assert words in str(told.value)


def test_numbers_are_withheld_where_nothing_is_found(straight_roller):
    bodies, _ = straight_roller
    given = np.asarray(MODULUS), np.asarray(LOAD * LENGTH)
    found = on_host(eqx.filter_jit(pressed)(bodies, GAP, *given, 3))
    assert found.status.code == Code.NOT_CONVERGED
    assert found.status.iterations == 3
    assert np.isnan(found.pressure).all() and np.isnan(found.gap).all() and np.isnan(found.load)


@pytest.mark.parametrize(
    ("profile", "given", "words"),
    [
        (dub_off, {"length": 0.6, "radius": 1.0}, "do not fit on a face of 1 m"),
        (chamfered, {"length": 0.1, "angle": 0.0}, "angle of 0: it must be positive"),
        (crowned, {"radius": np.nan}, "radius of nan: it must be positive"),
        (log_relieved, {"line_load": -1.0, "modulus": 1.0}, "line load of -1"),
    ],
)
def test_ends_that_do_not_exist_are_told(profile, given, words):
    with pytest.raises(InputError) as told:
        profile(width=1.0, **given)
    assert words in str(told.value)
