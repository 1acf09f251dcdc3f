"""Estimates for flexsplines: rings bent to their wave, tubes, Goodman's line, torques and lives of makers."""

import numpy as np
import pytest
from sound import wave_rates

from pitchpoint.gears.strain_wave.proportions import PROPORTIONS, rim_by_strain
from pitchpoint.gears.strain_wave.strain_wave_registry import WAVE_SHAPES
from pitchpoint.gears.strain_wave.strength_estimates import (
    bearing_life,
    curvature_change,
    face_stress,
    flexspline_torque,
    goodman_safety,
    of_other_size,
    torque_by_goodman,
    tube_shear,
    von_mises,
)

RADIUS = 0.03
ANGLES = np.linspace(0.0, np.pi, 73)


@pytest.mark.parametrize("shape", ["cosine", "elliptical", "four_forces"])
def test_the_curvature_is_that_of_the_drawn_ring(shape) -> None:
    """Neutral line as points, without stretch to first order, its curvature by finite differences."""
    deflection = 1e-6 * RADIUS
    weights = WAVE_SHAPES[shape].harmonics(np.pi / 6, 1e-6)
    waves = 2.0 * np.arange(1, len(weights) + 1)
    angle = np.linspace(-0.1, np.pi + 0.1, 40001)
    radial = deflection * np.cos(np.outer(angle, waves)) @ weights
    tangential = -deflection * np.sin(np.outer(angle, waves)) @ (weights / waves)
    turned = angle + tangential / RADIUS
    x, y = (RADIUS + radial) * np.cos(turned), (RADIUS + radial) * np.sin(turned)
    slopes = [np.gradient(one, angle) for one in (x, y)]
    bends = [np.gradient(one, angle) for one in slopes]
    drawn = (slopes[0] * bends[1] - slopes[1] * bends[0]) / np.hypot(*slopes) ** 3 - 1.0 / RADIUS
    found = curvature_change(angle, radius=RADIUS, deflection=deflection, weights=weights)
    np.testing.assert_allclose(found[5:-5], drawn[5:-5], atol=2e-3 * np.abs(drawn).max())


def test_two_rollers_bend_a_ring_as_timoshenko_has_it() -> None:
    """Moment P r/pi under each force, where the ring gives way by (pi/8 - 1/pi) P r^3/(E I)."""
    terms = 2.0 * np.arange(1, 20001)
    exact = (1.0 / np.pi) / (np.pi / 8.0 - 1.0 / np.pi)
    given = {"radius": 1.0, "deflection": 1.0}
    long = (1.0 / (terms**2 - 1.0) ** 2) / np.sum(1.0 / (terms**2 - 1.0) ** 2)
    assert curvature_change(np.zeros(1), weights=long, **given)[0] == pytest.approx(exact, rel=1e-4)
    short = WAVE_SHAPES["two_rollers"].harmonics(0.0, 0.01)
    found = curvature_change(np.zeros(1), weights=short, **given)[0]
    assert exact * 0.96 < found < exact  # what the 16 terms of a shape leave out under a force


def test_the_strain_is_that_of_the_rule_for_rims() -> None:
    diameter, deflection = 0.06, 0.06 / 60.0
    rim = rim_by_strain(diameter, deflection)
    bent = curvature_change(
        np.zeros(1), radius=diameter / 2.0, deflection=deflection, weights=np.ones(1)
    )
    assert face_stress(young=1.0, thickness=rim, curvature=bent[0]) == pytest.approx(
        PROPORTIONS.strain
    )


def test_a_thin_tube_is_the_limit_of_a_thick_one() -> None:
    outer, inner = RADIUS + 0.05e-3, RADIUS - 0.05e-3
    exact = 100.0 * RADIUS / (np.pi / 2.0 * (outer**4 - inner**4))
    assert tube_shear(torque=100.0, radius=RADIUS, thickness=0.1e-3) == pytest.approx(
        exact, rel=1e-5
    )


def test_goodman_as_in_shigley() -> None:
    # alternating bending of 25 and steady shear of 15 kpsi on S_e = 40, S_ut = 80 kpsi: 1.05
    mean = von_mises(normal=0.0, shear=15.0)
    assert mean == pytest.approx(25.98, abs=5e-3)
    strengths = {"endurance_limit": 40.0, "tensile_strength": 80.0}
    assert goodman_safety(alternating=25.0, mean=mean, **strengths) == pytest.approx(1.05, abs=5e-3)


@pytest.mark.parametrize("reversing", [False, True])
def test_the_torque_of_a_safety_of_one(reversing) -> None:
    strengths = {"endurance_limit": 450e6, "tensile_strength": 1100e6}
    bends = {"alternating": np.array([120e6, 500e6]), "mean_bending": np.array([-30e6, 0.0])}
    shear = np.array([0.4e6, 0.8e6])
    torque = torque_by_goodman(shear_per_torque=shear, **bends, **strengths, reversing=reversing)
    swing, rest = (shear * torque, 0.0) if reversing else (0.0, shear * torque)
    alternating = von_mises(normal=bends["alternating"], shear=swing)
    mean = von_mises(normal=bends["mean_bending"], shear=rest)
    safety = goodman_safety(alternating=alternating, mean=mean, **strengths)
    assert safety[0] == pytest.approx(1.0)
    assert torque[1] == 0.0
    assert safety[1] < 1.0


@pytest.mark.parametrize("fixed", [0, 1, 2])
def test_the_torque_on_the_flexspline_balances_power_and_moments(fixed) -> None:
    members = ("wave generator", "flexspline", "circular spline")
    drives = next(k for k in range(3) if k != fixed)
    loaded = 3 - fixed - drives
    motion = wave_rates((200.0, 202.0), fixed, drives)
    torques = np.zeros(3)
    torques[loaded] = 50.0
    torques[drives] = -50.0 * motion[loaded] / motion[drives]
    torques[fixed] = -torques.sum()
    found = flexspline_torque(50.0, members[loaded], (200.0, 202.0))
    assert found == pytest.approx(abs(torques[1]))


def test_torques_of_a_catalogue_go_nearly_with_the_cube_of_the_size() -> None:
    # ratcheting of CSF-25-100 and CSF-32-100: 500 and 1000 N m; buckling of both sizes: 1000 and 2200 N m
    assert of_other_size(500.0, size=32.0, known=25.0) == pytest.approx(1000.0, rel=0.06)
    assert of_other_size(1000.0, size=32.0, known=25.0) == pytest.approx(2200.0, rel=0.06)


def test_the_life_of_the_bearing_goes_with_the_cube_of_the_torque() -> None:
    given = {"rated_life": 7000.0, "rated_torque": 67.0, "rated_speed": 2000.0}
    assert bearing_life(torque=67.0, speed=2000.0, **given) == 7000.0
    assert bearing_life(torque=33.5, speed=4000.0, **given) == pytest.approx(7000.0 * 8.0 / 2.0)
    assert bearing_life(torque=0.0, speed=4000.0, **given) == np.inf
