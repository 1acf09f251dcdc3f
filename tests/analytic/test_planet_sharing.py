"""How planets share a load: closed forms until one lifts off, conditions of contact beyond."""

import numpy as np
import pytest

from pitchpoint.drive.assembly import equal_angles
from pitchpoint.loading.planets import PinEquivalents, path_stiffness, planet_forces

ANGLE = np.radians(24.6)
STIFFNESS = path_stiffness(
    levers=(1.0 / (2.0 * np.cos(ANGLE)),) * 2, stiffnesses=(5e8, 5e8), pin_stiffness=1e8
)


def at_sun(count, floating, error=20e-6):
    """Normal forces at the sun for 4 kN in all, with one pin out of place."""
    errors = np.zeros(count)
    errors[0] = error
    pins = planet_forces(
        4000.0 * 2.0 * np.cos(ANGLE), STIFFNESS, errors, equal_angles(count), floating=floating
    )
    return pins / (2.0 * np.cos(ANGLE))


@pytest.mark.parametrize(
    ("count", "floating", "expected"),
    [
        (3, True, [1333.33] * 3),
        (3, False, [679.24, 1660.38, 1660.38]),
        (4, True, [754.71, 1245.29, 754.71, 1245.29]),
        (4, False, [264.14, 1245.29, 1245.29, 1245.29]),
        (5, True, [407.54, 1117.50, 678.72, 678.72, 1117.50]),
        (6, False, [0.0, 800.0, 800.0, 800.0, 800.0, 800.0]),
    ],
)
def test_one_pin_out_of_place_gives_the_numbers_of_the_closed_form(count, floating, expected):
    np.testing.assert_allclose(at_sun(count, floating), expected, atol=0.006)


def closed(total, stiffness, errors, angles, *, floating):
    """F/N - k e', the error less its mean and less its first harmonic."""
    left = errors - errors.mean()
    if floating and errors.size > 2:
        for wave in (np.cos(angles), np.sin(angles)):
            left = left - wave * (left @ wave) / (wave @ wave)
    return total / errors.size - stiffness * left


def test_random_errors_follow_the_closed_form_until_a_planet_lifts_off():
    random, seen = np.random.default_rng(3), 0
    for _ in range(400):
        count, floating = int(random.integers(3, 9)), bool(random.integers(2))
        angles, errors = equal_angles(count), random.normal(0.0, 10e-6, count)
        total = random.uniform(2e3, 2e4)
        expected = closed(total, STIFFNESS, errors, angles, floating=floating)
        forces = planet_forces(total, STIFFNESS, errors, angles, floating=floating)
        assert forces.sum() == pytest.approx(total, rel=1e-9)
        assert forces.min() >= 0.0
        if floating:
            assert abs(forces @ np.exp(1j * angles)) < 1e-9 * total
        if expected.min() > 0.0:
            np.testing.assert_allclose(forces, expected, rtol=1e-9, atol=1e-9 * total)
            seen += 1
        elif not floating:
            # A planet that carries nothing is ahead of the place to which the others are wound up.
            level = (forces + STIFFNESS * errors)[forces > 0.0]
            np.testing.assert_allclose(level, level[0], rtol=1e-9)
            assert (STIFFNESS * errors[forces == 0.0] >= level[0] * (1.0 - 1e-9)).all()
    assert 100 < seen < 390


def test_up_to_24_planets_balance_however_far_their_pins_are_off():
    """Whatever pushes is in balance and as far as its gap is closed: the one equilibrium of such springs."""
    random = np.random.default_rng(7)
    for _ in range(300):
        count, floating = int(random.integers(2, 25)), bool(random.integers(2))
        angles = equal_angles(count)
        errors = random.normal(0.0, 10.0 ** random.uniform(-7.0, -2.0), count)
        forces = planet_forces(1e3, 1e8, errors, angles, floating=floating)
        assert forces.sum() == pytest.approx(1e3, rel=1e-8)
        arms = np.ones((count, 1))
        if floating:
            assert abs(forces @ np.exp(1j * angles)) < 1e-5
            arms = np.column_stack([arms, np.cos(angles), np.sin(angles)])
        pushes = forces > 0.0
        closed_by = forces / 1e8 + errors
        place = np.linalg.lstsq(arms[pushes], closed_by[pushes])[0]
        np.testing.assert_allclose(arms[pushes] @ place, closed_by[pushes], atol=1e-9)
        if np.linalg.matrix_rank(arms[pushes]) == arms.shape[1]:
            assert (arms @ place - errors)[~pushes].max(initial=0.0) < 1e-9


def test_three_planets_around_a_floating_body_share_alike_whatever_the_errors():
    errors = np.random.default_rng(5).normal(0.0, 1e-4, (200, 3))
    forces = planet_forces(900.0, STIFFNESS, errors, equal_angles(3), floating=True)
    np.testing.assert_allclose(forces, 300.0, rtol=1e-8)


def closings(angles, sun, ring, *, thicker, off_planet, off_sun, off_ring):
    """Closing of both meshes of each planet by deviations, along the normals, by the equations of motion."""
    p, q = angles - sun, angles + ring
    radial, tangential = (off_planet[0] * of(off_planet[1]) for of in (np.cos, np.sin))
    at_sun = -radial * np.sin(sun) - tangential * np.cos(sun) + thicker * np.cos(np.radians(20)) / 2
    at_ring = (
        radial * np.sin(ring) - tangential * np.cos(ring) + thicker * np.cos(np.radians(20)) / 2
    )
    for (offset, phase), closing, at in ((off_sun, at_sun, p), (off_ring, at_ring, q)):
        x, y = offset * np.cos(phase), offset * np.sin(phase)
        closing += y * np.cos(at) - x * np.sin(at)
    return at_sun, at_ring


def test_deviations_of_teeth_load_planets_as_the_meshes_of_both_sides_have_it():
    """Springs of all meshes with the turns of sun and planets as unknowns, beside pins out of place."""
    random = np.random.default_rng(11)
    sun, ring, stiff_sun, stiff_ring = np.radians(24.2), np.radians(15.6), 4e8, 6e8
    lever = 1.0 / (np.cos(sun) + np.cos(ring))
    path = path_stiffness(levers=(lever, lever), stiffnesses=(stiff_sun, stiff_ring))
    alike = PinEquivalents(sun, ring, np.radians(20.0))
    for count in (3, 4, 5):
        angles, total = equal_angles(count), 9e4
        far = {
            "thicker": random.normal(0.0, 5e-6, count),
            "off_planet": (5e-6, random.uniform(0.0, 6.0, count)),
            "off_sun": (8e-6, 0.7),
            "off_ring": (6e-6, 2.9),
        }
        at_sun, at_ring = closings(angles, sun, ring, **far)
        # Unknown: turn of the sun and of each planet, whose two forces are equal; their sum is given.
        system, right = np.zeros((count + 1, count + 1)), np.zeros(count + 1)
        for n in range(count):
            system[n, 0], system[n, n + 1] = stiff_sun, stiff_sun + stiff_ring
            right[n] = stiff_ring * at_ring[n] - stiff_sun * at_sun[n]
        system[count] = stiff_sun
        system[count, 0] *= count
        right[count] = total - stiff_sun * at_sun.sum()
        turns = np.linalg.solve(system, right)
        at_teeth = stiff_sun * (turns[0] + turns[1:] + at_sun)
        assert at_teeth.min() > 0.0
        errors = (
            alike.of_thickness(far["thicker"])
            + alike.of_planet(*far["off_planet"])
            + alike.of_sun(*far["off_sun"], angles)
            + alike.of_ring(*far["off_ring"], angles)
        )
        pins = planet_forces(total / lever, path, errors, angles)
        np.testing.assert_allclose(pins * lever, at_teeth, rtol=1e-9)
        free = planet_forces(
            total / lever, path, alike.of_sun(8e-6, 0.7, angles), angles, floating=True
        )
        np.testing.assert_allclose(free, total / lever / count, rtol=1e-8)


def test_planets_of_two_gears_bear_by_the_deviations_of_each():
    """Gears of other base radii, thicknesses and offsets in both meshes, and pins that lie outwards."""
    random = np.random.default_rng(5)
    sun, ring, stiff_sun, stiff_ring = np.radians(22.0), np.radians(18.5), 4e8, 6e8
    step, count, total = 24 / 36, 4, 9e4
    lever = np.array([step, 1.0]) / (step * np.cos(sun) + np.cos(ring))
    path = path_stiffness(levers=lever.tolist(), stiffnesses=(stiff_sun, stiff_ring))
    alike = PinEquivalents(sun, ring, np.radians(20.0), step=step)
    angles = equal_angles(count)
    thick = random.normal(0.0, 5e-6, (2, count))
    phases = random.uniform(0.0, 6.0, (2, count))
    central = {"off_sun": (8e-6, 0.7), "off_ring": (6e-6, 2.9)}
    at_sun, at_ring = (
        closings(angles, sun, ring, thicker=thick[k], off_planet=(5e-6, phases[k]), **central)[k]
        for k in range(2)
    )
    # Unknown: turn of the sun and of each planet [m at the base circle of its gear at the sun].
    system, right = np.zeros((count + 1, count + 1)), np.zeros(count + 1)
    for n in range(count):
        system[n, 0], system[n, n + 1] = stiff_sun, stiff_sun + step**2 * stiff_ring
        right[n] = step * stiff_ring * at_ring[n] - stiff_sun * at_sun[n]
    system[count] = stiff_sun
    system[count, 0] *= count
    right[count] = total - stiff_sun * at_sun.sum()
    turns = np.linalg.solve(system, right)
    at_teeth = stiff_sun * (turns[0] + turns[1:] + at_sun)
    assert at_teeth.min() > 0.0
    errors = (
        alike.of_thickness(*thick)
        + alike.of_planet(5e-6, *phases)
        + alike.of_sun(*central["off_sun"], angles)
        + alike.of_ring(*central["off_ring"], angles)
    )
    pins = planet_forces(total / lever[0], path, errors, angles)
    np.testing.assert_allclose(pins * lever[0], at_teeth, rtol=1e-9)
