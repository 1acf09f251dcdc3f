"""Stiffness by its three names, against what the mean wind-up does."""

import numpy as np
import pytest

from pitchpoint.analyses.torsion import _stiffness

TORQUE = np.array([0.0, 10.0, 20.0, 20.002])
WEIGHT = np.array([0.5, 0.3, 0.2])
SPRING = np.array([1e4, 1.5e4, 3e4])


def found(bent: float) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Mean wind-up and stiffness of springs that stiffen, T/k - bent T^2, by phase."""
    turned = (TORQUE[:, None] / SPRING - bent * TORQUE[:, None] ** 2) @ WEIGHT
    slopes = 1.0 / (1.0 / SPRING - 2.0 * bent * TORQUE[:, None])
    return turned, _stiffness(TORQUE, turned, slopes, WEIGHT)


@pytest.mark.parametrize("bent", [0.0, 2e-7])
def test_the_wind_up_follows_slope_and_secant(bent: float) -> None:
    turned, values = found(bent)
    slope = np.diff(TORQUE[2:]) / np.diff(turned[2:])
    np.testing.assert_allclose(values["tangent_torsional_stiffness"][2], slope[0], rtol=2e-5)
    np.testing.assert_allclose(values["torsional_stiffness"] * turned, TORQUE, rtol=1e-14)
    assert values["torsional_stiffness"][0] == values["tangent_torsional_stiffness"][0]


def test_the_mean_of_slopes_is_larger() -> None:
    _, values = found(0.0)
    mean = SPRING @ WEIGHT
    np.testing.assert_allclose(values["phase_mean_torsional_stiffness"], mean)
    np.testing.assert_allclose(values["torsional_stiffness"], 1.0 / (1.0 / SPRING @ WEIGHT))
    assert (values["torsional_stiffness"] < 0.9 * mean).all()
