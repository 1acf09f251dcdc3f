"""Strain wave geometry: closed forms, and positions alone against what the library derives.

The positions are those of `strain_wave_positions`, which differentiates no formula.
"""

from dataclasses import replace
from types import SimpleNamespace

import equinox as eqx
import numpy as np
import pytest
from loaded_strain_wave import passing as passing_teeth
from loaded_strain_wave import wound, yielding
from scipy.integrate import quad
from sound import OnDemand, quick_first
from strain_wave_positions import bend, drive, slope

from pitchpoint._jax import jax, jnp
from pitchpoint.contact.contacts import along
from pitchpoint.errors import InputError
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion, nominal_period
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.gears.strain_wave.design import InvoluteForm, build_strain_wave, double_arc_flank
from pitchpoint.gears.strain_wave.registry import DOUBLE_ARCS, WAVE_SHAPES, DoubleArcForm
from pitchpoint.gears.strain_wave.wave_generator import TERMS, NeutralLine
from pitchpoint.gears.tooth_section import tooth_sections

MODULE, RIM = 0.3e-3, 0.7e-3
INVOLUTE = InvoluteForm(3.32)
FORMS = {"flat": DOUBLE_ARCS["flat"], "liu": DOUBLE_ARCS["liu"], "involute": INVOLUTE}
LOW_RIDGE = 2e-8
"""Ridges of the play so low part no valleys for the library, which looks at few places [m]."""


def build(**options):
    form = options.setdefault("form", DOUBLE_ARCS["flat"])
    options.setdefault("clearance", 0.35 if isinstance(form, InvoluteForm) else 0.25)
    options = {"teeth": (200, 202), "rim_thickness": RIM} | options
    return build_strain_wave(module=MODULE, face_width=0.01, **options)


@pytest.fixture(scope="module")
def drives():
    return OnDemand(lambda name: build(form=FORMS[name]))


BY = {name: drive(form) for name, form in FORMS.items()}


@eqx.filter_jit
def passing(motion, along_flank, angle):
    at = motion.at(along_flank, angle)
    derived = ("closing", "sliding", "rolling", "relative_curvature", "change", "approach")
    given = ("place", "direction", "curvature", "velocity", "turning", "acceleration")
    return {name: getattr(at, name) for name in (*derived, *given, "shift", "whole")}


@eqx.filter_jit
def of_groove(groove, height):
    return groove.width_and_slope(height), groove.made


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


# Flanks and grooves.


@pytest.fixture(scope="module", params=quick_first(FORMS))
def pair(request, drives):
    mesh, by = drives[request.param], BY[request.param]
    space = by.groove(float(mesh.groove.low))
    return SimpleNamespace(name=request.param, mesh=mesh, by=by, space=space)


@pytest.mark.whole
def test_groove_is_the_outermost_place_of_the_tooth(pair):
    """With ridges blended, tips relieved and rounded, and room at the bottom."""
    groove, space = pair.mesh.groove, pair.space
    (known, _), nodes = jax.tree.map(np.asarray, of_groove(groove, jnp.asarray(space.heights)))
    between = np.abs(np.asarray(known) - space.widths)
    inside = nodes[nodes < nodes[-1] - 1e-7][::7]
    found, slopes = map(np.asarray, of_groove(groove, jnp.asarray(inside))[0])
    error = np.abs(found - space.width(inside))
    ridge = space.on_ridge(inside)
    assert ridge.any() == (pair.name == "flat")
    assert np.max(error[~ridge]) < 1e-10
    assert np.max(error, initial=0.0, where=ridge) < 2e-10  # ridges are found by parabolas
    smooth = space.smooth(inside)
    assert smooth.mean() > 0.4
    rate = slope(space.width, inside[smooth], 2e-7)
    turned = np.abs(slopes[smooth] - rate) / (1.0 + rate**2)
    assert np.max(turned[~ridge[smooth]]) < 1e-6
    assert np.max(turned) < 1e-5
    # The table goes smoothly round edges, which a cell of it wide.
    assert between.max() < (1e-7 if pair.name == "involute" else 5e-9)
    assert np.median(between) < 1e-12


@pytest.mark.parametrize("shape", quick_first([None, "two_rollers", "elliptical"]))
def test_teeth_pass_the_whole_turn_without_interference(drives, pair, shape):
    """Every part of a tooth, at every phase, is in the space or inside the tips beside it."""
    mesh, by = pair.mesh, pair.by
    if shape:
        if pair.name == "involute":
            # No case that is shipped has involute teeth on these wave generators; without a shape they ran.
            pytest.skip("the double-arc pairs are those that are shipped")
        mesh = build(form=FORMS[pair.name], shape=shape)
        by = drive(FORMS[pair.name], weights=np.asarray(mesh.line.weights))
    heights, widths = np.asarray(mesh.groove.made), np.asarray(mesh.groove.half_width)
    station = np.append(np.linspace(0.0, 1.0, 400) * by.outline.length, by.outline.length)
    angle = np.deg2rad(np.arange(-90.0, 90.01, 0.1))[:, None]
    flank = by.place(station, angle)
    tooth = np.concatenate([flank, by.mirrored(station, angle)], axis=1)
    # The end of the rounding closes the outline with a straight tip land.
    last = tooth[:, [station.size - 1]]
    land = last + np.linspace(0.0, 1.0, 9) * (tooth[:, [-1]] - last)
    outline = np.concatenate([tooth, land], axis=1)
    pitch = 2.0 * np.pi / float(mesh.teeth[1])
    outline = outline * np.exp(-1j * pitch * np.round(np.angle(outline) / pitch))
    within = outline.real >= heights[0]
    room = np.interp(outline.real, heights, widths, right=-np.inf) - np.abs(outline.imag)
    deepest = outline.real > heights[-1]  # above it there is the ground of the space
    room = np.where(deepest, widths[-1] - np.abs(outline.imag), room)
    assert np.min(room[within]) > -3e-8
    assert heights[-1] - outline.real.max() > 0.15 * MODULE, "the bottom is clear"
    assert not within[np.abs(np.degrees(angle[:, 0])) > 88.0].any(), (
        "teeth are free at the short axis"
    )


def engaged(mesh, phases, torque):
    """Contacts at phases under a torque."""
    (part,) = passing_teeth(mesh, phases)
    contacts, carried = part[0], wound(mesh, part, torque)
    arm = np.abs(along(np.asarray(contacts.normal), np.asarray(mesh_ends(mesh)[1])))[:, 0]
    found = {
        "angle": 2.0 * np.pi * np.asarray(contacts.path[:, 0]),
        "active": contacts.active[:, 0],
        "gap": contacts.gap[:, 0],
        "force": carried.force[:, 0],
        "moved": yielding(mesh, *part, jnp.asarray(torque), carried.force),
        "reach": arm * np.asarray(carried.wind_up + carried.touch),
    }
    return SimpleNamespace(**{k: np.asarray(v)[:, : len(phases)] for k, v in found.items()})


@pytest.fixture(scope="module")
def loaded(pair):
    """At each place the clearance of its valley by positions: of two the first is nearer to the root."""
    mesh, by = pair.mesh, pair.by
    found = engaged(mesh, [0.0, 0.21, 0.43, 0.64, 0.86], 16.0)
    at, clear, rise = by.valleys(found.angle, pair.space)
    places = np.arange(found.angle.shape[0])
    found.first = np.isin(places, in_pairs(mesh, places[:, None], 0)[:, 0])[:, None]
    turned = np.isfinite(clear[1]) & (at[1] < at[0]) & (rise > LOW_RIDGE)
    own = found.first != turned
    found.clearance = np.where(own, clear[0], clear[1])
    found.along = np.where(own, at[0], at[1])
    found.rise = rise
    found.name = pair.name
    reach = by.place(by.outline.plain, found.angle).real
    found.inside = found.active & (reach > pair.space.low + by.made.rounding)
    return found


def test_gaps_are_those_of_the_positions(loaded):
    assert np.all(np.isinf(loaded.clearance[~loaded.active & loaded.first]))
    assert np.all(loaded.rise[~loaded.active & ~loaded.first] < LOW_RIDGE)
    assert loaded.inside.sum() > 0.7 * loaded.active.sum()
    second = loaded.inside & ~loaded.first
    assert second.any() == (loaded.name != "involute"), "pairs may touch at two places"
    found, expected = loaded.gap[loaded.inside], loaded.clearance[loaded.inside]
    np.testing.assert_allclose(found, np.maximum(expected, 0.0), rtol=1e-4, atol=1e-8)


def test_pairs_that_count_as_touching_touch_and_none_lies_inside(loaded):
    """Where relieved tips would touch there may be a few nanometres between all pairs."""
    nearest = np.where(loaded.active, loaded.gap, np.inf).min(axis=0)
    assert np.max(nearest) < (1e-12 if loaded.name == "flat" else 1e-8)
    touching = loaded.active & (loaded.gap < 1e-12)
    assert np.all((touching.sum(axis=0) >= 2) | (nearest > 1e-12))
    assert np.max(np.abs(loaded.clearance[touching])) < 1e-9
    assert np.min(loaded.clearance) > -1e-9


def test_all_teeth_that_touch_are_held(pair, loaded):
    mesh, angle = pair.mesh, np.deg2rad(np.arange(-90.0, 90.0, 0.25))
    near = pair.by.valleys(angle, pair.space)[1][0] < 1e-3 * float(mesh.module)
    assert loaded.angle.min() < angle[near].min()
    assert angle[near].max() < loaded.angle.max()
    assert np.degrees(angle[near].max()) < 50.0, "teeth have left"
    expected = 2.0 * np.pi * near.mean() / float(mesh.tooth_angle)
    assert float(mesh.pairs) == pytest.approx(expected, abs=0.5)
    assert mesh.groove.unsolved == 0


@pytest.mark.parametrize("name", quick_first(FORMS))
def test_tips_of_the_circular_spline_end_where_teeth_leave(name):
    """Or where the clearance ends them."""
    cutter, root = BY[name].cutter, BY[name].place(0.0, 0.0).real
    for clearance, angle in ((0.1, 50.0), (0.1, 40.0), (1.0, 50.0)):
        mesh = build(form=FORMS[name], clearance=clearance, disengagement=np.deg2rad(angle))
        leaves = cutter.place(cutter.outline.length, np.deg2rad(angle)).real
        clear = root + clearance * MODULE
        assert float(mesh.tip_height) == pytest.approx(max(leaves, clear), abs=1e-12)
        assert (leaves > clear) == (clearance < 0.5 or name == "involute")


@pytest.mark.parametrize("form", quick_first(FORMS))
def test_play_takes_no_pairs_away(drives, form):
    """It lies between all flanks alike and is taken up before the first of them touches."""
    without, found = drives[form], build(form=FORMS[form], backlash=20e-6)
    assert found.lanes == without.lanes
    # The play counts along the normal, so upright flanks have more of it than rounded tips.
    assert float(found.pairs) > 0.2 * float(without.pairs)


def test_load_closes_the_gap_of_every_pair_that_carries(loaded):
    """Tooth and ring yield by what the rigid motion moves a pair beyond its clearance."""
    carries = loaded.force > 0.0
    left = loaded.moved + loaded.clearance - loaded.reach
    assert np.all(loaded.force >= 0.0)
    assert np.all(carries.sum(axis=0) >= 6)
    assert np.any(loaded.clearance[carries] > 1e-8)
    assert np.max(np.abs(left[carries])) < 1e-8
    assert np.min(left[loaded.active & ~carries]) > -1e-8


@eqx.filter_jit
def sections_of(mesh):
    return [(jnp.stack(each.reach), *each.flank, each.slope) for each in tooth_sections(mesh)]


def test_tooth_sections_are_the_outlines(pair):
    """Half thickness, height and slope of the sections by which teeth yield."""
    mesh, by = pair.mesh, pair.by
    node = -np.cos(np.pi * np.arange(24) / 23.0)
    for index, section in enumerate(sections_of(mesh)):
        (low, high), half, height, rate_there = map(np.asarray, section)
        reach = (high + low + node * (high - low)) / 2.0
        place = by.outline.place if index == 0 else mate_outline(pair)
        expected = place(reach**2)
        tolerance = 1e-13 if index == 0 else 1e-7  # its arc length is that of chords
        np.testing.assert_allclose(half, expected.imag, atol=tolerance)
        np.testing.assert_allclose(height, expected.real, atol=tolerance)
        step = 1e-9 if index == 0 else 1e-7
        rate = (high - low) * reach * slope(lambda s, at=place: at(s).real, reach**2, step)
        error = np.abs(rate_there - rate)[1:-1]
        assert np.max(error) < (1e-5 if index == 0 else 5e-3) * np.max(np.abs(rate))
        assert np.all(half > 0.0)
        assert np.all(np.diff(height) > 0.0)


def mate_outline(pair):
    """Tooth of the circular spline by arc length from the deepest point of the groove."""
    heights, widths = pair.space.heights, pair.space.widths
    grown = np.hypot(np.diff(heights), np.diff(widths))
    depth = np.append(np.cumsum(grown[::-1])[::-1], 0.0)
    pitch = np.pi / float(pair.mesh.teeth[1])

    def place(at):
        height = np.interp(at, depth[::-1], heights[::-1])
        half = pitch * height - np.interp(height, heights, widths)
        return heights[-1] - height + 1j * half

    return place


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
