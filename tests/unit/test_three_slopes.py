"""Slopes, lost motion and hysteresis loss, read off curves whose answers are known."""

import numpy as np
import pytest

from pitchpoint.analyses.three_slopes import as_in_catalogues, torques_of_catalogues

RATED, LIMITS = 100.0, (20.0, 70.0)
TORQUE = np.union1d(np.linspace(0.0, 200.0, 25), torques_of_catalogues(RATED, LIMITS))
SOFT, STIFF, STIFFEST = 1e4, 2e4, 4e4


def curve(torque):
    """Wind-up of a drive with three slopes."""
    parts = ((20.0, SOFT), (50.0, STIFF), (np.inf, STIFFEST))
    turned, left = np.zeros_like(torque), np.array(torque)
    for width, stiffness in parts:
        step = np.minimum(left, width)
        turned, left = turned + step / stiffness, left - step
    return turned


def told(held, play=0.0, torque=TORQUE, limits=LIMITS):
    friction = np.broadcast_to(held, torque.shape)[None]
    found = as_in_catalogues(torque, curve(torque), friction, play, RATED, limits)
    return {name: np.squeeze(values) for name, (_, values) in found.items()}


def test_the_slopes_of_a_curve_with_three():
    found = told(0.0)
    np.testing.assert_allclose(found["slope_stiffness"], [SOFT, STIFF, STIFFEST], rtol=1e-12)
    np.testing.assert_array_equal(found["slope_torque"], [20.0, 70.0, 100.0])


def test_without_limits_they_are_parts_of_the_torque():
    np.testing.assert_allclose(torques_of_catalogues(50.0, None)[-3:], [10.0, 35.0, 50.0])


def test_beyond_the_torque_the_last_slope_ends_half_above_the_second_limit():
    assert torques_of_catalogues(RATED, (20.0, 120.0))[-1] == 180.0


def test_without_friction_the_loop_closes_and_lost_motion_is_that_of_the_springs():
    found = told(0.0)
    assert found["hysteresis_loss"] == 0.0
    assert found["catalogue_lost_motion"] == pytest.approx(8.0 / SOFT, rel=1e-12)


def test_friction_of_the_teeth_alone_closes_it_too():
    """It is in proportion to the torque, and opens the loop everywhere else."""
    assert told(0.05 * TORQUE)["hysteresis_loss"] == pytest.approx(0.0, abs=1e-15)


def test_what_holds_at_rest_opens_it():
    """On the way back the springs hold as much as friction does: by their slope on either side."""
    found = told(2.0)
    assert found["hysteresis_loss"] == pytest.approx(2.0 * 2.0 / SOFT, rel=1e-12)
    assert found["catalogue_lost_motion"] == pytest.approx(8.0 / SOFT, rel=1e-12)


def test_both_add_up_to_a_longer_way():
    """Zero torque is where T = B + 0.1 T."""
    found = told(2.0 + 0.1 * TORQUE)
    assert found["hysteresis_loss"] == pytest.approx(2.0 * 2.0 / 0.9 / SOFT, rel=1e-12)


def test_play_between_the_flanks_counts_in_both():
    free, held = told(0.0, play=3e-4), told(2.0, play=3e-4)
    assert free["catalogue_lost_motion"] == pytest.approx(8.0 / SOFT + 3e-4, rel=1e-12)
    assert held["hysteresis_loss"] == pytest.approx(4.0 / SOFT + 3e-4, rel=1e-12)


def test_a_drive_that_friction_locks_has_no_loop():
    found = told(np.nan)
    assert np.isnan(found["hysteresis_loss"])
    assert np.isnan(found["catalogue_lost_motion"])
    np.testing.assert_allclose(found["slope_stiffness"], [SOFT, STIFF, STIFFEST], rtol=1e-12)


def test_play_counts_whether_or_not_something_holds_at_rest():
    torque, limits = np.linspace(0.0, 100.0, 101), (10.0, 35.0)
    loss = [
        as_in_catalogues(torque, torque / 1e5, held * np.ones((1, 101)), 1e-4, 50.0, limits)[
            "hysteresis_loss"
        ][1][0]
        for held in (0.0, 1e-9)
    ]
    np.testing.assert_allclose(loss, 1e-4, rtol=1e-6)


def test_beyond_what_was_found_there_is_no_slope():
    torque = np.linspace(0.0, 100.0, 101)
    for last, known in ((30.0, 1), (-1.0, 0)):
        lost = np.where(torque <= last, torque / 1e5, np.nan)
        found = as_in_catalogues(torque, lost, np.zeros((1, 101)), 0.0, 50.0, (10.0, 35.0))
        slopes = found["slope_stiffness"][1]
        np.testing.assert_allclose(slopes[:known], 1e5, rtol=1e-12)
        assert np.all(np.isnan(slopes[known:]))
