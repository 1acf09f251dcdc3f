"""The loss map for Simscape: what a linear lookup of the MAT file gives is the map."""

from pathlib import Path

import numpy as np
import pytest
from made_joints import TITLE, locking, made_joint
from scipy.interpolate import RegularGridInterpolator
from scipy.io import loadmat

from pitchpoint.errors import visible
from pitchpoint.exports.simulators import hand_over
from pitchpoint.runs.joint_model import joint_model


def test_a_linear_lookup_is_the_map(tmp_path: Path) -> None:
    made = made_joint()
    (path, script), lost = hand_over({"default": made}, tmp_path, ["simscape"])["simscape"]
    held = loadmat(path, squeeze_me=True)
    table = RegularGridInterpolator(
        (held["torque"], held["log_speed"], held["temperature"]), held["loss_torque"]
    )
    random = np.random.default_rng(2)
    points = random.uniform([-60.0, np.log(0.01), 20.0], [60.0, np.log(4.0), 60.0], (500, 3))
    joint = joint_model(made)
    expected = joint.loss_torque(points[:, 0], np.exp(points[:, 1]), points[:, 2] + 273.15)
    np.testing.assert_allclose(table(points), expected, rtol=1e-9)
    driver = (points[:, 0] + table(points)) * held["speed_ratio"]
    there = joint.driver_torque(points[:, 0], np.exp(points[:, 1]), points[:, 2] + 273.15)
    np.testing.assert_allclose(driver, there, atol=1e-9)
    assert str(held["title"]) == visible(TITLE)
    assert (float(held["ratio"]), str(held["units"]["torque"])) == (-50.0, "N m")
    assert "nothing of the torque of the driver, by construction" in " ".join(lost)
    lines = script.read_text("utf-8").splitlines()
    code = [line for line in lines if not line.startswith("%")]
    assert len(code) == 4 and code[0].startswith("joint = load(")


def test_a_drive_that_locks_has_numbers_and_a_flag(tmp_path: Path) -> None:
    (path, _), _ = hand_over({"default": made_joint(locking)}, tmp_path, ["simscape"])["simscape"]
    held = loadmat(path)
    names = ("loss_torque", "loss_power", "efficiency")
    assert all(np.isfinite(held[name]).all() for name in names)
    drives = held["torque"].ravel() >= 0.0
    assert held["locked"][~drives].all() and not held["locked"][drives].any()
    assert held["loss_torque"][0, 0, 0] == pytest.approx(2.0)  # of the nearest torque, none
