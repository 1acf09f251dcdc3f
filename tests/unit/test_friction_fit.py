"""Friction of simulators fitted to loss torques, and how far it is off."""

import numpy as np
import pytest

from pitchpoint.efficiency.friction_fit import MapRange, fit_friction, law_errors, loss_nodes
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.errors import InputError

TORQUE, SPEED = (
    one.ravel()
    for one in np.meshgrid(np.linspace(-60.0, 60.0, 17), np.geomspace(1e-3, 4.0, 8), indexing="ij")
)


def law(constant: float, driving: float, driven: float, viscous: float) -> np.ndarray:
    share = np.where(TORQUE < 0.0, driven, driving)
    return np.asarray(constant + share * abs(TORQUE) + viscous * SPEED)


@pytest.mark.parametrize(
    "given", [(0.7, 0.01, 0.03, 0.2), (0.0, 0.4, 1.3, 0.0), (2.0, 0.0, 0.0, 3.0)]
)
def test_constants_of_a_law_come_back(given: tuple[float, float, float, float]) -> None:
    fit = fit_friction(TORQUE, SPEED, law(*given))
    found = fit.constant, fit.driving_share, fit.driven_share, fit.viscous
    assert found == pytest.approx(given, abs=1e-9)
    assert fit.largest_error < 1e-9
    np.testing.assert_allclose(fit.lost(TORQUE, -SPEED), law(*given), atol=1e-9)


def test_the_part_that_falls_with_speed_comes_back() -> None:
    lost = law(0.7, 0.01, 0.03, 0.2) + 1.5 * np.exp(-SPEED / 0.3)
    fit = fit_friction(TORQUE, SPEED, lost, stribeck=True)
    assert (fit.stribeck, fit.stribeck_speed) == pytest.approx((1.5, 0.3), rel=1e-6)
    assert fit.constant == pytest.approx(0.7, rel=1e-6)
    assert fit.largest_error < 1e-6 < 0.3 < fit_friction(TORQUE, SPEED, lost).largest_error


def test_no_constant_is_negative_and_what_that_costs_is_told() -> None:
    """A loss that falls with speed, as of films: 0.7 at rest, 0.1 less at 4 rad/s."""
    fit = fit_friction(TORQUE, SPEED, law(0.7, 0.01, 0.01, -0.025))
    assert fit.viscous == 0.0
    assert 0.05 < fit.largest_error < 0.1
    assert fit.mean_error < fit.largest_error


def test_points_that_lock_do_not_count() -> None:
    lost = np.where(TORQUE < 0.0, np.nan, law(0.7, 0.01, 0.03, 0.2))
    fit = fit_friction(TORQUE, SPEED, lost)
    assert (fit.constant, fit.driving_share, fit.driven_share) == pytest.approx((0.7, 0.01, 0.0))
    with pytest.raises(InputError, match="3 points with a known loss are too few"):
        fit_friction(TORQUE[:3], SPEED[:3], lost[-3:])


def test_errors_are_those_of_the_driver_by_quadrant_and_range() -> None:
    """Against 0.02 of the load less where it drives; the map is linear, so that nothing else is off."""
    columns = [(2.0 + (0.12 if t < 0.0 else 0.10) * abs(t),) for t in (-60.0, 0.0, 60.0)]
    table = LossTable(
        (-60.0, 0.0, 60.0), (0.0, 0.1, 4.0), (40.0,), {"made": [[c] * 3 for c in columns]}, 0.02
    )

    def alike(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
        return np.asarray(2.0 + 0.10 * abs(torque))

    within = MapRange((6.0, 30.0), (0.1, 1.0), (313.15, 313.15))
    drives, driven = law_errors(table, loss_nodes(table, within=within), alike)
    assert (drives.quadrants, driven.quadrants) == ("I, III", "II, IV")
    assert drives.largest < 1e-15
    assert driven.largest == pytest.approx(0.02 * 30.0 / 50.0)
    assert driven.mean == pytest.approx(0.02 * 18.0 / 50.0)
    assert driven.share == pytest.approx(0.02 * 30.0 / (30.0 - 2.0 - 3.6))
    whole = law_errors(table, loss_nodes(table, temperature=313.15), alike)
    assert whole[1].largest == pytest.approx(0.02 * 60.0 / 50.0)
    assert (whole[0].points, whole[1].points, whole[1].locked) == (4, 2, 0)
