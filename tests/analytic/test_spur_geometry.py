"""Involute gears and pairs against printed designs, closed forms and a swept rack."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest
from scipy.optimize import brentq

from pitchpoint._jax import jax, jnp
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.involute import inverse_involute, involute

ANGLE = np.deg2rad(20.0)


def pair(teeth, module, **options):
    return build_cylindrical_pair(
        teeth=teeth, module=module, pressure_angle=ANGLE, face_width=0.02, **options
    )


@eqx.filter_jit
def lengths(mesh):
    return mesh.points, mesh.tip_radii, mesh.base_pitch, mesh.contact_ratio, mesh.centre_distance


def gear(teeth, shift, dedendum=1.25, fillet=0.38):
    """Gear 1 of a pair that is of no account here."""
    mesh = pair(
        (teeth, 60),
        2e-3,
        profile_shift=(shift, 0.5),
        dedendum=(dedendum, 1.25),
        fillet_radius=(fillet, 0.38),
        tip_alteration=(0.0, 0.0),
    )
    return mesh.gears[0]


@eqx.filter_jit
def figures(g):
    return {
        "form": g.form_roll_length,
        "outline": g.outline(count=200),
        "tip": g.tip_radius,
        "root": g.root_radius,
        "base": g.base_radius,
        "half thickness": g.half_thickness_angle(g.reference_radius),
    }


@jax.jit
def inverse_with_slope(value):
    return jax.value_and_grad(inverse_involute)(value)


def test_fzg_c_gears_to_all_printed_digits():
    mesh = pair((16, 24), 4.5e-3, profile_shift=(0.1817, 0.1715), centre_distance=91.5e-3)
    points, tips, base_pitch, ratio, _ = lengths(mesh)
    A, _, C, _, E = np.asarray(points) * 1e3
    np.testing.assert_allclose(np.asarray(tips) * 1e3, [41.228, 59.182], atol=5e-4)
    assert float(base_pitch) * 1e3 == pytest.approx(13.285, abs=5e-4)
    assert float(ratio) == pytest.approx(1.44, abs=5e-3)
    assert pytest.approx(9.50, abs=5e-3) == C - A
    assert pytest.approx(19.10, abs=5e-3) == E - A


def test_fzg_c_distance_follows_from_its_profile_shifts():
    mesh = pair((16, 24), 4.5e-3, profile_shift=(0.1817, 0.1715))
    assert float(mesh.centre_distance) * 1e3 == pytest.approx(91.5, abs=5e-3)


def test_derivatives_of_tips_at_the_reference_distance_are_those_towards_backlash():
    mesh = pair((18, 36), 3e-3, centre_distance=0.081)

    def tips(shift):
        moved = dataclasses.replace(mesh, profile_shift=shift)
        return moved.clearance_keeping_tip_alteration

    with_backlash = [float(tips(jnp.array([s, 0.0]))) for s in (0.0, -1e-3)]
    np.testing.assert_allclose(with_backlash, 0.0, atol=1e-15)
    np.testing.assert_array_equal(jax.grad(tips)(jnp.zeros(2)), 0.0)
    np.testing.assert_allclose(jax.grad(tips)(jnp.array([0.1, 0.0])), -1.0)


def test_points_of_contact_of_tian_2024():
    points, _, base_pitch, ratio, _ = lengths(pair((18, 36), 3e-3))
    A, B, C, D, E = np.asarray(points) * 1e3
    np.testing.assert_allclose([A, C, E], [1.7401, 9.2345, 16.0086], atol=5e-5)
    assert float(base_pitch) * 1e3 == pytest.approx(8.8564, abs=5e-5)
    assert float(ratio) == pytest.approx(1.6111, abs=5e-5)
    np.testing.assert_allclose([E - B, D - A], 8.8564, atol=5e-5)


def ratio_by_hand(teeth, shift, addendum):
    """Contact ratio in modules from textbook lengths, with the rack's tip clearance kept."""
    total = sum(teeth)
    value = np.tan(ANGLE) - ANGLE + 2.0 * np.tan(ANGLE) * sum(shift) / total
    working = brentq(lambda a: np.tan(a) - a - value, 0.05, 0.9, xtol=1e-15)
    distance = total / 2.0 * np.cos(ANGLE) / np.cos(working)
    shortened = min(distance - total / 2.0 - sum(shift), 0.0)
    reach = [
        np.sqrt((z / 2 + addendum + x + shortened) ** 2 - (z / 2 * np.cos(ANGLE)) ** 2)
        for z, x in zip(teeth, shift, strict=True)
    ]
    return (sum(reach) - distance * np.sin(working)) / (np.pi * np.cos(ANGLE)), distance


@pytest.mark.parametrize("addendum", [1.0, 1.4])
def test_contact_ratio_of_shifted_gears(addendum):
    mesh = pair((23, 61), 2e-3, profile_shift=(0.4, -0.2), addendum=(addendum, addendum))
    _, _, _, ratio, distance = lengths(mesh)
    expected, in_modules = ratio_by_hand((23, 61), (0.4, -0.2), addendum)
    assert float(ratio) == pytest.approx(expected, rel=1e-12)
    assert float(distance) == pytest.approx(in_modules * 2e-3, rel=1e-12)
    assert (float(ratio) > 2.0) == (addendum > 1.0)
    assert mesh.lanes == (3 if addendum > 1.0 else 2)


def test_specific_sliding_at_the_ends_and_at_the_pitch_point():
    mesh = pair((18, 36), 3e-3)
    A, C, E = (float(mesh.points[i]) for i in (0, 2, 4))
    at = np.asarray(mesh.specific_sliding(jnp.asarray([A, C, E])))
    T = float(mesh.tangent_length)
    np.testing.assert_allclose(at[1], 0.0, atol=1e-14)
    np.testing.assert_allclose(at[0], [1 - (T - A) / A / 2, 1 - 2 * A / (T - A)], rtol=1e-13)
    assert at[0, 0] < 0.0 < at[0, 1]
    assert at[2, 1] < 0.0 < at[2, 0]


def test_fewest_teeth_without_undercut():
    """A rack whose straight flank reaches one module deep: z_min = 2/sin^2(20 deg) = 17.097."""
    fillet = 0.25 / (1.0 - np.sin(ANGLE))
    limit = [float(gear(z, 0.0, fillet=fillet).undercut_limit) for z in (17, 18)]
    assert limit[0] > 0.0 > limit[1]
    fewest = jnp.asarray(2.0 / np.sin(ANGLE) ** 2)
    just = dataclasses.replace(gear(17, 0.0, fillet=fillet), teeth=fewest)
    assert float(just.undercut_limit) == pytest.approx(0.0, abs=1e-14)
    assert float(gear(12, 0.0, fillet=fillet).undercut_limit) == pytest.approx(
        1.0 - 12.0 / (2.0 / np.sin(ANGLE) ** 2), rel=1e-13
    )


def flank(g, roll):
    """Involute point at a roll length, angle counted from the axis of the tooth space."""
    z, m, x = float(g.teeth), float(g.module), float(g.profile_shift)
    base = z * m * np.cos(ANGLE) / 2.0
    half_tooth = (np.pi / 2 + 2 * x * np.tan(ANGLE)) / z + np.tan(ANGLE) - ANGLE
    angle = np.pi / z - (half_tooth - (roll / base - np.arctan(roll / base)))
    return np.hypot(base, roll) * np.exp(1j * (np.pi / 2 - angle))


def swept_clearance(g, roll):
    """Distance from an involute point to the rack's rounded corner, over all positions of the rack."""
    m, depth = float(g.module), float(g.dedendum)
    rounding, radius = float(g.fillet_radius), float(g.teeth) * m / 2
    below = depth - rounding
    across = (np.pi / 4 - below * np.tan(ANGLE) - rounding / np.cos(ANGLE)) * m
    height = radius + (float(g.profile_shift) - below) * m
    low, high = -1.5, 1.5
    for _ in range(9):
        turned = np.linspace(low, high, 4001)
        corner = (across + radius * turned + 1j * height) * np.exp(1j * turned)
        away = np.abs(flank(g, roll) - corner)
        nearest, step = turned[np.argmin(away)], turned[1] - turned[0]
        low, high = nearest - 2 * step, nearest + 2 * step
    return away.min() - rounding * m


@pytest.mark.parametrize(("teeth", "shift"), [(8, 0.0), (12, 0.0), (14, -0.1), (16, 0.02)])
def test_undercut_ends_the_involute_where_a_swept_rack_cuts_it(teeth, shift):
    g = gear(teeth, shift)
    assert g.undercut
    found = figures(g)
    tip = np.sqrt(float(found["tip"]) ** 2 - float(found["base"]) ** 2)
    rolls = np.linspace(1e-3, 0.9, 60) * tip
    removed = np.array([swept_clearance(g, roll) < 0.0 for roll in rolls])
    assert removed.any(), "the corner never cuts the involute"
    last = np.flatnonzero(removed)[-1]
    form = brentq(lambda roll: swept_clearance(g, roll), rolls[last], rolls[last + 1], xtol=1e-13)
    assert float(found["form"]) == pytest.approx(form, rel=1e-6)


@pytest.mark.parametrize(("teeth", "shift"), [(24, 0.0), (12, 0.5), (60, -0.3)])
def test_without_undercut_the_rack_touches_the_involute_at_its_end_only(teeth, shift):
    g = gear(teeth, shift)
    assert not g.undercut
    form = float(figures(g)["form"])
    # The corner's arc is tangent there; lower points are cut, higher ones are not touched by it.
    scale = float(g.module)
    assert abs(swept_clearance(g, form)) < 1e-9 * scale
    for roll in (1.05 * form, 1.3 * form, 2.0 * form):
        assert swept_clearance(g, roll) > 1e-7 * scale


@pytest.mark.parametrize("angle", [0.02, 0.1, 0.35, 0.7, 1.1, 1.4, 1.55])
def test_inverse_involute_round_trip(angle):
    value = involute(jnp.asarray(angle))
    found, slope = inverse_with_slope(value)
    assert float(found) == pytest.approx(angle, rel=1e-12)
    assert float(slope) == pytest.approx(1.0 / np.tan(angle) ** 2, rel=1e-9)


OUTLINES = [(24, 0.0), (12, 0.5), (60, -0.3), (10, 0.0), (17, 0.0)]


@pytest.mark.parametrize(("teeth", "shift"), OUTLINES)
def test_outline_of_one_tooth(teeth, shift):
    g = gear(teeth, shift)
    found = figures(g)
    points = np.asarray(found["outline"])
    radius, angle = np.hypot(*points.T), np.arctan2(*points.T)
    module = float(g.module)

    assert radius.max() == pytest.approx(float(found["tip"]), rel=1e-13)
    assert radius.min() == pytest.approx(float(found["root"]), rel=1e-13)
    # Tooth and both half spaces fill one pitch, mirrored about the tooth axis.
    np.testing.assert_allclose(angle[[0, -1]], [-np.pi / teeth, np.pi / teeth], rtol=1e-12)
    np.testing.assert_allclose(angle, -angle[::-1], atol=1e-12)
    np.testing.assert_allclose(radius, radius[::-1], rtol=1e-13)

    gaps = np.abs(np.diff(points[:, 0] + 1j * points[:, 1]))
    assert gaps.max() < 0.04 * module, "the outline jumps"
    at_joints = gaps[[199, 399, 599, 799, 999, 1199, 1399]]
    assert at_joints.max() < 1e-8 * module, "arcs, fillets and involutes do not meet"

    half = slice(len(radius) // 2, None)
    order = np.argsort(radius[half])
    reference = teeth * module / 2
    thickness = 2 * reference * np.interp(reference, radius[half][order], angle[half][order])
    expected = module * (np.pi / 2 + 2 * shift * np.tan(ANGLE))
    assert thickness == pytest.approx(expected, rel=1e-5)
    half_thickness = float(found["half thickness"])
    space = 2 * reference * (np.pi / teeth - half_thickness)
    assert space + expected == pytest.approx(np.pi * module, rel=1e-13)
    assert half_thickness * 2 * reference == pytest.approx(expected, rel=1e-13)
