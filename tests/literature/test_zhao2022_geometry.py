"""Zhao et al. (2022): load, geometry and conjugate kinematics."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from zhao2022_in_print import STEP, built, readings

from pitchpoint.published.zhao2022.printed import (
    arc_distance,
    closure_residual,
    deflection_offset,
    half_zone_forces,
    largest_tangential_load,
    printed_tooth_forces,
    recovered_torque,
)

ZONE = {"half_zone": np.deg2rad(36.0), "diameter": 59.4e-3, "face_width": 12e-3}
LOAD = largest_tangential_load(torque=16.0, **ZONE)
RING = {"radius": 29.425e-3, "deflection": 0.3e-3}


def flank(study):
    return built(study).design.mesh.flank


# ------------------------------------------------------------------ load


def test_largest_load_closes_the_torque_integral():
    """Eq. 15 with the diameter of eq. 16."""
    half, d, b = ZONE["half_zone"], ZONE["diameter"], ZONE["face_width"]
    torque, _ = quad(lambda p: 4 * b * (d / 2) ** 2 * LOAD * np.cos(np.pi * p / 2 / half), 0, half)
    assert torque == pytest.approx(16.0, rel=1e-12)


def test_corrected_forces_close_the_torque():
    forces = half_zone_forces(load=LOAD, step=STEP, **ZONE)
    assert forces.shape == (20,)
    assert forces.max() == pytest.approx(10.57, abs=0.005)
    assert np.all(np.diff(forces) > 0.0)
    assert np.all(forces > 0.0)
    found = recovered_torque(forces=forces, diameter=ZONE["diameter"])
    assert found == pytest.approx(16.004, abs=0.0005)


def test_sum_converges_to_the_integral():
    """The middle rule errs by the square of the step."""
    error = [
        recovered_torque(
            forces=half_zone_forces(load=LOAD, step=STEP / n, **ZONE), diameter=ZONE["diameter"]
        )
        - 16.0
        for n in (1, 2, 4)
    ]
    np.testing.assert_allclose(error[:-1], np.array(error[1:]) * 4.0, rtol=2e-3)


def test_printed_forces_are_negative_at_the_entry_and_lose_torque():
    forces = printed_tooth_forces(load=LOAD, step=STEP, **ZONE)
    assert np.all(forces[:4] < 0.0)
    assert np.all(forces[4:] > 0.0)
    np.testing.assert_allclose(forces[[0, 3]], [-2.9, -0.5], atol=0.05)
    found = recovered_torque(forces=forces, diameter=ZONE["diameter"])
    assert found == pytest.approx(9.3, abs=0.05)


# ------------------------------------------------------------------ geometry


def test_offset_of_the_teeth():
    assert deflection_offset(angle=np.deg2rad(35.1), **RING) == pytest.approx(0.00963, abs=5e-6)
    most = minimize_scalar(lambda p: -deflection_offset(angle=p, **RING), bounds=(0.1, 1.4))
    assert -most.fun == pytest.approx(0.0102, abs=5e-5)
    assert -most.fun == pytest.approx(np.arcsin(0.3 / 29.425), rel=1e-9)


@pytest.mark.parametrize(
    ("study", "theta_b", "theta_a", "land"),
    [("double_arc", 10.5, 26.1, 1.004), ("double_arc_liu", 16.5, 38.9, 0.805)],
)
def test_double_arc_flank_has_the_angles_and_the_land_of_the_reference(
    study, theta_b, theta_a, land
):
    found = flank(study)
    assert np.rad2deg(found.tangent_angle) == pytest.approx(theta_b, abs=0.06)
    assert np.rad2deg(found.tip_angle) == pytest.approx(theta_a, abs=0.05)
    assert found.tip_land / 0.3e-3 == pytest.approx(land, abs=5e-4)


@pytest.mark.parametrize("study", ["double_arc", "double_arc_liu"])
def test_tangent_closes_with_equal_angles_only(study):
    found = flank(study)
    theta_b, offset = float(found.tangent_angle), float(found.convex_offset)
    closed = closure_residual(flank=found, theta_c=theta_b)
    as_printed = closure_residual(flank=found, theta_c=np.pi + theta_b)
    wrong_side = closure_residual(flank=found, theta_c=theta_b, convex_offset=-offset)
    assert abs(closed) < 1e-15
    assert 3e-3 < abs(as_printed) < 7.5e-3
    assert abs(wrong_side) > 1e-3
    # The line of eq. 2 is tangent to both circles.
    slope, apart = -1.0 / np.tan(theta_b), complex(found.concave_centre - found.convex_centre)
    distance = abs(apart.real - slope * apart.imag) / np.hypot(1.0, slope)
    radii = float(found.convex_radius + found.concave_radius)
    assert distance == pytest.approx(radii, rel=1e-12)


def test_printed_distances_are_negative():
    found = flank("double_arc")
    convex = {"radius": float(found.convex_radius), "boundary": float(found.tangent_angle)}
    angle = np.linspace(float(found.tangent_angle), float(found.tip_angle), 9)
    distance = arc_distance(angle=angle, **convex)
    assert distance[0] == 0.0
    assert np.all(np.diff(distance) < 0.0)
    assert distance[-1] * 1e3 == pytest.approx(-0.162, abs=0.0015)


def test_involute_teeth_have_the_figures_of_table_1():
    mesh = built("involute").design.mesh
    assert mesh.flank.tip_radius * 1e3 == pytest.approx(31.296, abs=5e-4)
    assert mesh.flank.root_radius * 1e3 == pytest.approx(30.591, abs=5e-4)
    assert mesh.line.radius * 1e3 == pytest.approx(30.241, abs=5e-4)
    assert mesh.flank.tip_land * 1e3 == pytest.approx(0.123, abs=5e-4)


# ------------------------------------------------------------------ conjugate kinematics


def placed(point, p, w0=0.3e-3, radius=29.425e-3):
    """A point of the flank in the space of the circular spline, and the turn of its tooth."""
    w, v = w0 * np.cos(2.0 * p), -w0 / 2.0 * np.sin(2.0 * p)
    polar = p * (1.0 - 200.0 / 202.0) + v / radius
    turn = polar + 2.0 * w0 * np.sin(2.0 * p) / radius
    return (radius + w) * np.exp(1j * polar) + np.exp(1j * turn) * point, turn


def convex(theta):
    """Point of the convex arc of the base case, from its foot on the neutral line."""
    half_rim, scale = 0.35e-3, 0.3e-3
    centre = half_rim + scale * (0.75 - 0.33) - 1j * scale * 1.294
    return centre + 2.0 * scale * 1j * np.exp(-1j * theta)


def envelope(theta, low, high):
    """Where the point touches the swept flank, found by positions alone."""
    point, h = convex(theta), 1e-5

    def closing(p):
        step = (placed(point, p + h)[0] - placed(point, p - h)[0]) / (2.0 * h)
        return np.imag(step * np.exp(-1j * (placed(point, p)[1] - theta)))

    p = brentq(closing, low, high, xtol=1e-14)
    return placed(point, p)[0], p


@pytest.mark.parametrize(
    ("branch", "low", "high", "radius"),
    [("deep", 0.0, 0.085, "deep_radius_tip"), ("outer", 0.25, 0.85, "outer_radius_largest")],
)
def test_relative_radius_is_that_of_the_places(branch, low, high, radius):
    """Curvature of the envelope by differences of its places, against the closed form."""
    expected = read_value(radius)
    tip, h = np.arcsin((0.55 + 0.33) / 2.0), 1e-3
    thetas = [tip] if branch == "deep" else np.linspace(np.deg2rad(11.0), tip, 31)
    found = []
    for theta in thetas:
        before, here, after = (envelope(theta + k * h, low, high)[0] for k in (-1, 0, 1))
        first, second = (after - before) / (2.0 * h), (after - 2.0 * here + before) / h**2
        _, turn = placed(convex(theta), envelope(theta, low, high)[1])
        outwards = 1j * np.exp(1j * (turn - theta))
        bend = second - first * np.real(second * np.conj(first)) / abs(first) ** 2
        across = np.real(bend * np.conj(outwards)) / abs(first) ** 2
        found.append(1.0 / (across + 1.0 / 0.6e-3))
    assert max(found) == pytest.approx(expected, rel=1e-3)


def read_value(name):
    return float(readings(["double_arc"])["study_double_arc"][name].values[0, 0])
