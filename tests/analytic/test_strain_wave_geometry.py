"""Strain wave geometry: closed forms, and positions alone against what the library derives.

The positions are those of `strain_wave_positions`, which differentiates no formula.
"""

from dataclasses import replace
from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from scipy.integrate import quad
from sound import OnDemand, quick_first
from strain_wave_forms import BY, FORMS, INVOLUTE, MODULE, build
from strain_wave_positions import bend, slope

from pitchpoint._jax import jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion, nominal_period
from pitchpoint.gears.strain_wave.design import InvoluteForm, double_arc_flank
from pitchpoint.gears.strain_wave.strain_wave_registry import (
    DOUBLE_ARCS,
    WAVE_SHAPES,
    DoubleArcForm,
)
from pitchpoint.gears.strain_wave.wave_generator import TERMS, NeutralLine


@pytest.fixture(scope="module")
def drives():
    return OnDemand(lambda name: build(form=FORMS[name]))


@eqx.filter_jit
def passing(motion, along_flank, angle):
    at = motion.at(along_flank, angle)
    derived = ("closing", "sliding", "rolling", "relative_curvature", "change", "approach")
    given = ("place", "direction", "curvature", "velocity", "turning", "acceleration")
    return {name: getattr(at, name) for name in (*derived, *given, "shift", "whole")}


def seen(drive, along_flank, angle):
    found = passing(drive.tooth_motion, jnp.asarray(along_flank), jnp.asarray(angle))
    return SimpleNamespace(**{name: np.asarray(value) for name, value in found.items()})


# Tooth forms.
@pytest.mark.parametrize(
    ("name", "theta_b", "theta_a", "land"),
    [("liu", 16.5, 38.9, 0.805), ("flat", 10.5, 26.1, 1.004)],
)
def test_double_arc_closes_with_its_common_tangent(name, theta_b, theta_a, land):
    form = DOUBLE_ARCS[name]
    flank = double_arc_flank(form, module=1.0, rim_thickness=2.0)
    assert np.degrees(flank.tangent_angle) == pytest.approx(
        theta_b, abs=0.06
    )  # 16.446 for the first
    assert np.degrees(flank.tip_angle) == pytest.approx(theta_a, abs=0.05)
    assert float(flank.tip_land) == pytest.approx(land, abs=5e-4)
    # Zhao et al. (2022), eq. 4, by coordinates across and along the tooth's axis.
    angle, length = float(flank.tangent_angle), float(flank.tangent_length)
    normal, tangent = (
        np.array([np.cos(angle), np.sin(angle)]),
        np.array([-np.sin(angle), np.cos(angle)]),
    )
    convex = np.array([-form.convex_offset, 1.75 - form.convex_shift]) + form.convex_radius * normal
    space = np.array([np.pi / 2.0 + form.concave_offset, 1.75 + form.concave_shift])
    concave = space - form.concave_radius * normal
    np.testing.assert_allclose(concave + length * tangent, convex, rtol=0.0, atol=1e-12)


@eqx.filter_jit
def places(flank, station):
    return flank.place(station), flank.angle(station), flank.curvature(station)


@pytest.mark.whole
@pytest.mark.parametrize("name", FORMS)
def test_flank_is_its_own_arc_length_angle_and_curvature(drives, name):
    flank, outline = drives[name].flank, BY[name].outline
    station = (np.arange(40) + 0.5) / 40.0 * outline.length
    place, angle, curvature = places(flank, jnp.asarray(station))
    np.testing.assert_allclose(flank.lengths, outline.lengths, rtol=1e-12, atol=1e-17)
    np.testing.assert_allclose(place, outline.place(station), atol=1e-15)
    smooth = BY[name].smooth(station, 1e-6)
    rate = slope(outline.place, station, 2e-7)[smooth]
    np.testing.assert_allclose(np.abs(rate), 1.0, rtol=1e-9)
    np.testing.assert_allclose(-np.angle(rate), np.asarray(angle)[smooth], atol=1e-9)
    turning = (bend(outline.place, station, 2e-7)[smooth] / rate).imag
    np.testing.assert_allclose(-turning, np.asarray(curvature)[smooth], rtol=1e-6, atol=0.05)
    joints = np.cumsum(outline.lengths)[:-1]
    for side in (-1e-12, 1e-12):
        there = places(flank, jnp.asarray(joints + side))[0]
        np.testing.assert_allclose(there, outline.place(joints), atol=1e-11)


@pytest.mark.whole
def test_involute_of_the_wear_paper_has_its_figures():
    """200 teeth, m = 0.3 mm, x = 3.32: r_a 31.296, r_f 30.591 mm, tip land 0.123 mm."""
    flank = build(form=INVOLUTE).flank
    assert float(flank.tip_radius) == pytest.approx(31.296e-3, abs=1e-9)
    assert float(flank.root_radius) == pytest.approx(30.591e-3, abs=1e-9)
    thickness = MODULE * (np.pi / 2.0 + 2.0 * 3.32 * np.tan(np.deg2rad(20.0)))
    assert float(flank.pitch_thickness) == pytest.approx(thickness, rel=1e-14)
    assert float(flank.tip_land) == pytest.approx(0.123e-3, abs=0.5e-6)
    # Tooth and space at the tip circle, from the definition of the involute function.
    inv = np.tan(np.deg2rad(20.0)) - np.deg2rad(20.0)
    at_tip = np.arccos(30e-3 * np.cos(np.deg2rad(20.0)) / 31.296e-3)
    land = 2.0 * 31.296e-3 * (thickness / 60e-3 + inv - np.tan(at_tip) + at_tip)
    assert float(flank.tip_land) == pytest.approx(land, rel=1e-10)


def test_neutral_radii_of_the_wear_paper(drives):
    assert float(drives["flat"].line.radius) == pytest.approx(29.425e-3, rel=1e-12)
    assert float(drives["involute"].line.radius) == pytest.approx(30.241e-3, rel=1e-12)


# Neutral line.
ANGLES = np.linspace(0.0, 2.0 * np.pi, 512, endpoint=False)


def line_of(name, wave=0.3e-3, force_angle=np.pi / 6.0, radius=29.425e-3):
    weights = WAVE_SHAPES[name].harmonics(force_angle, wave / radius)
    return NeutralLine(*map(jnp.asarray, (radius, wave, weights)))


@pytest.mark.parametrize("name", WAVE_SHAPES)
def test_velocities_of_the_neutral_line_are_differences_of_its_places(name):
    line = line_of(name)
    # The last of 16 even harmonics turns 32 times as fast.
    for values in (line.radial, line.tangential, line.rotation):
        for order in (0, 1):
            expected = slope(lambda p, at=values, k=order: np.asarray(at(p, k)), ANGLES, 2e-3)
            found = np.asarray(values(ANGLES, order + 1))
            np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(found).max())
    np.testing.assert_allclose(line.tangential(ANGLES, 1), -line.radial(ANGLES), atol=1e-18)
    tilt = -slope(lambda p: np.asarray(line.radial(p)), ANGLES, 2e-3) / float(line.radius)
    np.testing.assert_allclose(line.rotation(ANGLES), tilt, atol=1e-9 * np.abs(tilt).max())
    assert float(line.radial(jnp.zeros(()))) == pytest.approx(0.3e-3, rel=1e-12)


def stretched(line):
    """Strain of the whole neutral line by its length, and how far its normal is from the given one."""
    radius = float(line.radius)

    def place(p):
        reach = radius + np.asarray(line.radial(p))
        return reach * np.exp(1j * (p + np.asarray(line.tangential(p)) / radius))

    rate = slope(place, ANGLES, 2e-3)
    normal = (
        ANGLES + np.asarray(line.tangential(ANGLES)) / radius + np.asarray(line.rotation(ANGLES))
    )
    off = np.angle(-1j * rate * np.exp(-1j * normal))
    return np.mean(np.abs(rate)) / radius - 1.0, np.abs(off).max()


@pytest.mark.parametrize("name", WAVE_SHAPES)
def test_neutral_line_keeps_its_length_and_normal_to_first_order(name):
    """What is left is of the second order: a quarter for half the deflection."""
    # The normal is right to the second order too.
    (strain, off), (quarter, off_quarter) = (stretched(line_of(name, w)) for w in (0.3e-3, 0.15e-3))
    assert 1e-5 < strain < 5e-4
    assert strain / quarter == pytest.approx(4.0, rel=0.02)
    assert off < 1.5e-3
    assert off / off_quarter == pytest.approx(8.0, rel=0.05)


def two_forces(p):
    """Ring under two opposite forces on the axis p = 0, over P r^3/(4 E I): Timoshenko (1955)."""
    p = np.abs((p + np.pi / 2.0) % np.pi - np.pi / 2.0)
    return np.sin(p) + (np.pi / 2.0 - p) * np.cos(p) - 4.0 / np.pi


@pytest.mark.parametrize(("name", "at"), [("two_rollers", 0.0), ("four_forces", 0.4)])
def test_rollers_give_the_ring_of_the_strength_of_materials(name, at):
    def shape(p):
        return two_forces(p - at) + two_forces(p + at)

    def amplitude(k):
        return quad(
            lambda p: shape(p) * np.cos(2 * k * p), 0, np.pi, points=(at, np.pi - at), epsabs=1e-13
        )[0]

    line = line_of(name, force_angle=at)
    weights = np.asarray(line.weights)
    expected = np.array([amplitude(k) for k in range(1, TERMS + 1)])
    np.testing.assert_allclose(weights / weights[0], expected / expected[0], atol=1e-10)
    found = np.asarray(line.radial(ANGLES)) / 0.3e-3
    np.testing.assert_allclose(found, shape(ANGLES) / shape(0.0), atol=3e-4)


def test_elliptical_wave_is_an_ellipse():
    line = line_of("elliptical")
    long, short = 29.425e-3 + 0.3e-3, 29.425e-3 - 0.3e-3
    radius = 1.0 / np.hypot(np.cos(ANGLES) / long, np.sin(ANGLES) / short)
    beyond = radius - radius.mean()
    np.testing.assert_allclose(line.radial(ANGLES), 0.3e-3 * beyond / beyond[0], atol=1e-16)


# Motion of teeth.
@pytest.mark.parametrize("name", FORMS)
def test_motion_of_a_point_is_differences_of_its_places(drives, name):
    by, rng = BY[name], np.random.default_rng(5)
    station = rng.uniform(0.0, by.outline.length, 60)
    angle = rng.uniform(-np.pi / 2.0, np.pi / 2.0, 60)
    at = seen(drives[name], station, angle)
    np.testing.assert_allclose(at.place, by.place(station, angle), atol=1e-16)
    step = 2e-3
    velocity = slope(lambda p: by.place(station, p), angle, step)
    np.testing.assert_allclose(at.velocity, velocity, atol=1e-9 * np.abs(velocity).max())
    bent = bend(lambda p: by.place(station, p), angle, step)
    np.testing.assert_allclose(at.acceleration, bent, atol=1e-8 * np.abs(bent).max())
    for found, rates in ((at.shift, (-1, 0, 0)), (at.whole, (0, 0, -1))):
        expected = by.velocity(station, angle, rates)
        np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    smooth = by.smooth(station)
    direction = by.direction(station, angle, 2e-7)
    assert np.abs(at.direction - direction)[smooth].max() < 1e-8


def envelope(by, station, low, high, step):
    """Phases in a bracket at which points of the flank move along it, by positions alone."""

    def closing(p):
        velocity = slope(lambda at: by.place(station, at), p, 2e-3)
        return np.imag(velocity * np.exp(-1j * by.direction(station, p, step)))

    low, high = np.full(station.shape, low), np.full(station.shape, high)
    rises = np.sign(closing(high))
    assert np.all(np.sign(closing(low)) == -rises), "no root in the bracket"
    for _ in range(52):
        middle = (low + high) / 2.0
        above = np.sign(closing(middle)) == rises
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2.0


# Parts of the flank from root to tip as shares of its pieces, and a bracket of phases [deg].
BRANCHES = {
    "flat, root, deep": ("flat", 0, (0.2, 0.5, 0.8), (-2.0, 6.0)),
    "flat, tip, deep": ("flat", 2, (0.3, 0.6, 0.85), (0.5, 8.0)),
    "flat, tip, outer": ("flat", 2, (0.6, 0.7, 0.85), (25.0, 46.0)),
    "involute, deep": ("involute", 0, (0.3, 0.6, 0.9), (0.5, 8.0)),
    "involute, outer": ("involute", 0, (0.3, 0.6, 0.9), (30.0, 50.0)),
}


@pytest.mark.whole
@pytest.mark.parametrize("case", quick_first(BRANCHES, 2))
def test_flank_rolls_and_slides_on_its_envelope(drives, case):
    name, piece, parts, bracket = BRANCHES[case]
    by = BY[name]
    start = np.sum(by.outline.lengths[:piece])
    station = start + np.array(parts) * by.outline.lengths[piece]
    low, high = np.deg2rad(bracket)
    step = by.outline.lengths[piece] / 60.0

    def phase(s):
        return envelope(by, s, low, high, step / 4.0)

    def along_envelope(s):
        return by.place(s, phase(s))

    angle = phase(station)
    at = seen(drives[name], station, angle)
    assert np.max(np.abs(at.closing) / np.abs(at.velocity)) < 1e-9, "residual of the envelope"
    rate = slope(phase, station, step)
    np.testing.assert_allclose(at.rolling * rate, 1.0, rtol=1e-6)
    moved = slope(along_envelope, station, step)
    size = np.real(moved * np.exp(-1j * at.direction))
    assert np.max(np.abs(np.imag(moved * np.exp(-1j * at.direction))) / np.abs(size)) < 1e-7
    np.testing.assert_allclose((at.rolling + at.sliding) * rate, size, rtol=1e-8, atol=1e-8)
    # The envelope has the flank's direction, so that its curvature is the turn of the flank on the way.
    turned = slope(lambda s: by.direction(s, phase(s), step / 4.0), station, step)
    np.testing.assert_allclose(at.relative_curvature, at.curvature + turned / size, rtol=1e-5)


def branches(drive, by):
    """Phases [deg] and relative curvatures of all points at which parts of the flank have an envelope."""
    station = (np.arange(300) + 0.5) / 300.0 * np.sum(by.outline.lengths[:-1])
    angle = np.deg2rad(np.arange(-5.0, 60.0, 0.05))
    at = seen(drive, station[:, None], angle[None])
    row, column = np.nonzero(np.sign(at.closing[:, 1:]) != np.sign(at.closing[:, :-1]))
    return np.degrees(angle[column]), at.relative_curvature[row, column], row


def test_conjugate_branches_are_where_the_wear_notes_found_them(drives):
    """Of the teeth that sweep, which have no relief."""
    for name in FORMS:
        cutter = replace(drives[name], flank=drives[name].flank.unrelieved)
        phase, curvature, row = branches(cutter, BY[name].cutter)
        deep = phase < 6.0
        assert np.unique(row[deep]).size == 300
        assert phase[deep].min() > -0.5
        assert phase[deep].max() < 4.6
        assert np.all(curvature[deep] > 0.0)
        outer = phase > 6.0
        if name == "involute":
            assert phase[outer].min() == pytest.approx(37.0, abs=0.5)
            assert phase[outer].max() == pytest.approx(41.0, abs=0.5)
            assert np.all(curvature[outer] < 0.0)
        if name == "flat":
            assert phase[outer].min() == pytest.approx(15.0, abs=0.5)
            assert phase[outer].max() == pytest.approx(47.0, abs=0.6)
            assert np.unique(row[outer & (curvature > 0.0)]).size / 300 == pytest.approx(
                0.34, abs=0.04
            )


# Kinematics of the drive.
@pytest.mark.parametrize("teeth", quick_first([((200, 202),), ((200, 204),), ((201, 203),)]))
def test_ten_turns_of_the_wave_generator(teeth):
    z1, z2 = teeth
    mesh = build(teeth=teeth)
    motion = nominal_motion(mesh, *mesh_ends(mesh))
    wave, flexspline, circular = 10.0 * 2.0 * np.pi * np.asarray(motion)
    assert wave / flexspline == pytest.approx(-z1 / (z2 - z1), rel=1e-15)
    assert circular == 0.0
    assert flexspline == pytest.approx(-2.0 * np.pi * 10.0 * (z2 - z1) / z1, rel=1e-15)
    # The wave passes every space of the circular spline once a turn, and teeth as fast as it turns past them.
    passed = (wave - flexspline) / float(mesh.tooth_angle)
    assert passed == pytest.approx(10.0 * z2, rel=1e-14)
    assert 10.0 * 2.0 * np.pi / float(nominal_period(mesh, motion)) == pytest.approx(
        10.0 * z2, rel=1e-14
    )
    # A tooth stands in the middle of a space whenever an end of the long axis passes it.
    ends = np.arange(21) * np.pi
    foot, axis = mesh.tooth_motion.foot(jnp.asarray(ends))
    spaces = np.unwrap(np.angle(np.asarray(foot))) * z2 / (2.0 * np.pi)
    np.testing.assert_allclose(np.diff(spaces), (z2 - z1) / 2.0, rtol=1e-10)
    np.testing.assert_allclose(np.asarray(axis) * z2 / (2.0 * np.pi), spaces, rtol=0.0, atol=1e-10)


# What cannot be built.
BAD = {
    "no common tangent": (
        {"form": DoubleArcForm(2.5, 0.6, 0.3, 2.5, 0.6, 0.3)},
        "form",
        "no common tangent: their centres are 2.835 modules apart, less than the sum of their radii, 5",
    ),
    "interference": (
        {"form": INVOLUTE, "groove": InvoluteForm(3.0)},
        "groove",
        "interfere: 127 um of overlap 79 degrees from the long axis",
    ),
    "zero engaged teeth": (
        {"form": INVOLUTE, "groove": InvoluteForm(5.0)},
        "groove",
        "no tooth of the flexspline engages: the least clearance is",
    ),
    "deflection larger than the tooth": (
        {"deflection": 1.4},
        "deflection",
        "deflects the flexspline by 1.4 modules for each pair of teeth of difference, more than its teeth",
    ),
    "deflection too small": (
        {"deflection": 0.4},
        "form",
        "the teeth meet at edges alone",
    ),
    "clearance too small": (
        {"form": INVOLUTE, "groove": InvoluteForm(3.6), "clearance": 0.1},
        "clearance",
        "reach 2.25 modules into each other, and twice the deflection is 2 modules; a clearance of 0.35",
    ),
    **{
        f"{key} of a given circular spline": (
            {"form": INVOLUTE, "groove": InvoluteForm(3.6), "clearance": 0.35, key: size},
            key,
            f"{size} modules were given, which would not shape a given circular spline",
        )
        for key, size in {
            "tip_relief": 0.006,
            "relief_length": 0.08,
            "bottom_clearance": 0.2,
        }.items()
    },
    "pointed teeth": (
        {"form": InvoluteForm(5.0)},
        "form",
        "teeth are pointed: their tip land is 0.012 modules",
    ),
    "odd difference": ({"teeth": (200, 203)}, "teeth", "200 and 203 teeth were given"),
    "no wave": ({"shape": (1.0, -1.0)}, "shape", "must have their sum as its largest value"),
}


@pytest.mark.parametrize(
    "name",
    # Found by a tooth that passes the whole turn.
    [pytest.param(name, marks=[pytest.mark.whole] * (name == "interference")) for name in BAD],
)
def test_what_cannot_be_built_says_why(name):
    options, key, words = BAD[name]
    with pytest.raises(InputError) as told:
        build(**options)
    assert told.value.key == key
    message = str(told.value)
    assert words in message
    assert "\n" not in message


def test_double_arc_needs_centres_farther_apart_than_its_radii():
    """At the limit the tangent has no length; a hair less and there is none."""
    form = DOUBLE_ARCS["flat"]
    across = np.pi / 2.0 + form.convex_offset + form.concave_offset
    apart = np.hypot(across, form.convex_shift + form.concave_shift)
    for beyond, possible in ((1e-3, False), (-1e-3, True)):
        radius = apart - form.convex_radius + beyond
        changed = DoubleArcForm(
            form.convex_radius,
            form.convex_offset,
            form.convex_shift,
            radius,
            form.concave_offset,
            form.concave_shift,
        )
        if possible:
            flank = double_arc_flank(changed, module=1.0, rim_thickness=2.0)
            assert 0.0 < float(flank.tangent_length) < 0.2
        else:
            with pytest.raises(InputError, match="no common tangent"):
                double_arc_flank(changed, module=1.0, rim_thickness=2.0)
