"""Helical and internal pairs against printed designs, closed forms, a swept rack and drawn teeth."""

import dataclasses
import itertools

import equinox as eqx
import numpy as np
import pytest
from drawn_teeth import ANGLE, MODULE, Tooth, figures, overlap, pair, placed, plain

from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.checks import _measure, check_cylindrical

SLICES, LANES = 4, 9


@eqx.filter_jit
def _contacts(mesh, phase):
    return mesh.contacts(phase), mesh.events()


def contacts(mesh, phase):
    found, events = _contacts(plain(mesh, LANES, SLICES), jnp.asarray(phase))
    return jax.tree.map(np.asarray, found), np.asarray(events)


V1 = pair((24, 95), 10.0, 14e-3, 0.36, profile_shift=(0.48, 0.6691), centre_distance=0.861)
V3 = pair((20, 30), 15.0, 3.5e-3, profile_shift=(0.1809, 0.0891), centre_distance=91.5e-3)
FEW = {
    name: pair(teeth, 20.0, module, 16e-3, profile_shift=shift, least_tip=0.25)
    for name, teeth, module, shift in [
        ("GP1", (4, 51), 1.5e-3, (0.74, 0.05)),
        ("GP2", (4, 51), 1.5e-3, (0.85, -0.06)),
        ("GP3", (6, 77), 1.0e-3, (0.60, 0.29)),
        ("GP4", (6, 77), 1.0e-3, (0.85, 0.04)),
    ]
}
RACK = {"addendum": (1.0, 0.8), "dedendum": (1.25, 1.25), "fillet_radius": (0.38, 0.25)}
RING = pair((20, -60), profile_shift=(0.3, -0.3), **RACK)
HELICAL_RING = pair((20, -60), 25.0, profile_shift=(0.2, -0.3), **RACK)


def test_drivetrain_stage_of_a_commercial_gear_program():
    """24/95, module 14 mm: report of a wind turbine's third stage, to its printed digits."""
    found = figures(V1)
    degrees = {"transverse": 20.284, "working": 22.856}
    for name, value in degrees.items():
        assert np.rad2deg(found[f"{name}_pressure_angle"]) == pytest.approx(value, abs=6e-4)
    assert np.rad2deg(found["base_helix_angle"]) == pytest.approx(9.391, abs=6e-4)
    assert 1e3 * found["reference_radius"].sum() == pytest.approx(845.850, abs=6e-4)
    np.testing.assert_allclose(14.0 * found["tip_alteration"], -0.938, atol=6e-4)
    np.testing.assert_allclose(2e3 * found["tip_radii"], [380.747, 1395.376], atol=2e-3)
    np.testing.assert_allclose(1e3 * found["tip_thickness"], [8.800, 11.034], atol=2e-3)
    assert 1e3 * found["base_pitch"] == pytest.approx(41.891, abs=6e-4)
    start, end = 1e3 * found["limits"]
    assert start == pytest.approx(41.865, abs=2e-3)
    assert end - start == pytest.approx(61.276, rel=1e-4)
    base, form = 1e3 * found["base_radii"][0], 1e3 * found["form_roll_length"][0]
    assert 2.0 * np.hypot(base, form) == pytest.approx(328.991, abs=2e-3)
    assert 2.0 * np.hypot(base, start) == pytest.approx(330.798, abs=2e-3)
    ratios = [found[f"{name}contact_ratio"] for name in ("transverse_", "")]
    np.testing.assert_allclose(ratios, [1.463, 2.884], atol=6e-4)
    assert found["overlap_ratio"] == pytest.approx(1.421, abs=6e-4)
    virtual = [float(g.virtual_spur_gear.teeth) for g in V1.gears]
    np.testing.assert_allclose(virtual, [25.037, 99.104], atol=1e-3)
    assert 1e3 * line_lengths(V1)[0].min() == pytest.approx(483.685, rel=5e-4)


def test_helical_test_gears_h501_to_all_printed_digits():
    found = figures(V3)
    np.testing.assert_allclose(1e3 * found["tip_radii"], [40.336, 58.132], atol=6e-4)
    np.testing.assert_allclose(1e3 * found["root_radius"], [32.493, 50.289], atol=6e-4)
    assert 1e3 * found["base_pitch"] == pytest.approx(10.652, abs=6e-4)
    assert found["transverse_contact_ratio"] == pytest.approx(1.46, abs=6e-3)
    assert 1e3 * found["tangent_length"] == pytest.approx(34.45, abs=6e-3)
    A, B, C, D, E = 1e3 * found["points"]
    np.testing.assert_allclose([B - A, C - A, D - A, E - A], [4.90, 7.48, 10.65, 15.55], atol=6e-3)


@pytest.mark.parametrize(
    ("name", "transverse", "overlap", "distance", "shortened", "tips"),
    [
        ("GP1", 0.8880, 1.1613, 44.9971, 0.3221, (10.6387, 84.3891)),
        ("GP2", 0.8253, 1.1613, 44.9971, 0.3834, (10.7850, 84.0591)),
        ("GP3", 1.0786, 1.7419, 45.0031, 0.1501, (9.2849, 84.4212)),
        ("GP4", 0.9366, 1.7419, 45.0031, 0.2812, (9.5227, 83.9212)),
    ],
)
def test_pairs_with_four_and_six_pinion_teeth(name, transverse, overlap, distance, shortened, tips):
    """Values of an independent reference calculation for the pairs of Atanasiu et al. 2011."""
    found = figures(FEW[name])
    module = found["module"]
    assert found["transverse_contact_ratio"] == pytest.approx(transverse, abs=1e-4)
    assert found["overlap_ratio"] == pytest.approx(overlap, abs=1e-4)
    assert 1e3 * found["centre_distance"] == pytest.approx(distance, abs=1e-4)
    assert -found["tip_alteration"][0] == pytest.approx(shortened, abs=1e-4)
    assert found["tip_thickness"][0] == pytest.approx(0.25 * module, rel=1e-9)
    assert found["tip_thickness"][1] > 0.25 * module
    np.testing.assert_allclose(2e3 * found["tip_radii"], tips, atol=1e-4)
    limit = {4: 0.7223, 6: 0.5835}[int(found["teeth"][0])]
    assert found["undercut_limit"][0] == pytest.approx(limit, abs=1e-4)


def line_lengths(mesh):
    """Total length of the contact lines where its slope changes, and its mean over one period."""
    _, events = contacts(mesh, np.full(10, 0.3))
    phase = np.pad(events, (1, 9 - len(events)), constant_values=(0.0, 1.0 - 1e-12))
    found, _ = contacts(mesh, phase)
    lengths = np.where(found.active, found.weight, 0.0).sum(axis=(0, 1))
    return lengths, np.trapezoid(lengths, phase)


LINES = {
    **FEW,
    "V1": V1,
    "V3": V3,
    "ring": HELICAL_RING,
    "narrow": pair((23, 61), 12.0, width=6e-3),
    "wide": pair((23, 61), 30.0, width=50e-3),
}


@pytest.mark.parametrize("name", LINES)
def test_lengths_of_the_contact_lines(name):
    """The plane of action is a rectangle of eps_alpha by eps_beta pitches that the lines cross."""
    mesh = LINES[name]
    found = figures(mesh)
    transverse, overlap = found["transverse_contact_ratio"], found["overlap_ratio"]
    mean = transverse * float(mesh.face_width) / np.cos(found["base_helix_angle"])
    a, b = transverse % 1.0, overlap % 1.0
    lost = (1.0 - a) * (1.0 - b) if a + b > 1.0 else a * b
    gained = min(a * (1.0 - b), b * (1.0 - a))
    lengths, average = line_lengths(mesh)
    assert lengths.min() == pytest.approx(mean * (1.0 - lost / transverse / overlap), rel=1e-8)
    assert lengths.max() == pytest.approx(mean * (1.0 + gained / transverse / overlap), rel=1e-8)
    assert average == pytest.approx(mean, rel=1e-8)


@pytest.mark.parametrize(
    ("name", "mean", "least", "most", "longest"),
    [
        ("GP1", 15.003, 0.9089, 1.0175, 12.920),
        ("GP2", 13.945, 0.8611, 1.0294, 12.008),
        ("GP3", 18.224, 0.9690, 1.0108, 10.462),
        ("GP4", 15.826, 0.9900, 1.0288, 9.086),
    ],
)
def test_contact_lines_of_the_pairs_with_few_teeth(name, mean, least, most, longest):
    lengths, average = line_lengths(FEW[name])
    assert 1e3 * average == pytest.approx(mean, abs=2e-3)
    assert lengths.min() / average == pytest.approx(least, abs=1e-4)
    assert lengths.max() / average == pytest.approx(most, abs=1e-4)
    assert 1e3 * single_line(FEW[name])[1].max() == pytest.approx(longest, abs=2e-3)


def single_line(mesh):
    """Length of one contact line over its way through the plane of action [base pitches]."""
    phase = (np.arange(10) + 0.5) / 10
    found, _ = contacts(mesh, phase)
    travelled = phase + np.arange(LANES)[:, None]
    return travelled.ravel(), np.where(found.active, found.weight, 0.0).sum(axis=1).ravel()


@pytest.mark.parametrize("name", LINES)
def test_one_contact_line_grows_stays_and_shrinks(name):
    mesh = LINES[name]
    found = figures(mesh)
    a, b = found["transverse_contact_ratio"], found["overlap_ratio"]
    width = float(mesh.face_width) / np.cos(found["base_helix_angle"])

    def share(travelled):
        return (
            np.maximum(
                np.minimum.reduce([travelled, 0 * travelled + min(a, b), a + b - travelled]), 0
            )
            / a
        )

    travelled, length = single_line(mesh)
    np.testing.assert_allclose(length, a / b * width * share(travelled), atol=1e-8 * width)
    kinks = np.array([0.0, min(a, b), max(a, b), a + b])
    assert np.trapezoid(share(kinks), kinks) == pytest.approx(b, rel=1e-12)


CURVED = {"GP1": FEW["GP1"], "helical ring": HELICAL_RING, "ring": RING, "V3": V3}


@pytest.mark.parametrize("name", CURVED)
def test_flanks_touch_and_part_with_the_relative_curvature(name):
    """Two involute helicoids near a contact point, across the contact line, in the normal section."""
    mesh = CURVED[name]
    found = figures(mesh)
    each, _ = contacts(mesh, np.full(10, 0.3))
    assert each.active[0, 0, 0]
    for path, curvature in zip(
        each.path[0, :, 0], each.relative_curvature[0, 0, :, 0], strict=True
    ):
        position = found["limits"][0] + path * found["base_pitch"]
        assert curvature == pytest.approx(gap_curvature(found, position), rel=1e-5)


def gap_curvature(found, position):
    """Second derivative of the distance between both flanks along their common normal [1/m]."""
    angle, slope = found["working_pressure_angle"], found["base_helix_angle"]
    first, second = found["base_radii"]
    side = np.sign(found["teeth"][1])
    centre = side * found["centre_distance"]
    rolled = np.array([position, found["tangent_length"] - position])
    direction = np.exp(-1j * angle)

    def flank(member, roll, height):
        base, sign = ((first, 1.0), (second, -1.0))[member]
        turn = (-(roll - rolled[member]) + sign * height * np.tan(slope)) / base
        point = sign * direction * np.exp(1j * turn) * (base + 1j * roll)
        return np.array([point.real + (0.0, centre)[member], point.imag, height])

    contact = flank(0, rolled[0], 0.0)
    np.testing.assert_allclose(flank(1, rolled[1], 0.0), contact, atol=1e-15)
    across = 1j * direction
    normal = np.array([*(np.cos(slope) * np.array([across.real, across.imag])), -np.sin(slope)])
    # Contact lines run in the plane of action, which holds the normal and the axes.
    tangent = np.array([direction.real, direction.imag, 0.0])
    step = 1e-4 * float(first)

    def depth(member, along):
        def miss(unknown):
            roll, height, away = unknown * step
            point = flank(member, rolled[member] + roll, height)
            return (point - contact - along * tangent - away * normal) / step

        unknown = np.zeros(3)
        for _ in range(8):
            shifted = [miss(unknown + 1e-6 * one) for one in np.eye(3)]
            slopes = 1e6 * (np.array(shifted) - miss(unknown)).T
            unknown = unknown - np.linalg.solve(slopes, miss(unknown))
        assert np.abs(miss(unknown)).max() < 1e-10
        return unknown[2] * step

    gaps = [depth(1, along) - depth(0, along) for along in (-step, 0.0, step)]
    assert abs(gaps[1]) < 1e-10 * step
    return (gaps[0] + gaps[2]) / step**2


CLEAR = {**CURVED, "V1": V1, "GP4": FEW["GP4"], "undercut": pair((10, -60), **RACK)}


@pytest.mark.parametrize("name", CLEAR)
def test_drawn_gears_touch_and_do_not_overlap(name):
    mesh = CLEAR[name]
    check_cylindrical(mesh)
    backlash = 1e-4 if mesh is V3 or mesh is V1 else 0.0  # their centre distances are rounded
    assert abs(overlap(mesh)) < 5e-6 + backlash


def test_ring_flank_is_the_envelope_of_the_pinion():
    """Seen from the ring, the pinion's teeth reach every point of the active flank and none beyond."""
    found = figures(RING)
    pinion, ring = (Tooth(g) for g in RING.gears)
    first, second, centre = placed(RING, found, found["points"][2])
    pitch = 2.0 * np.pi / ring.teeth
    deepest = np.hypot(found["base_radii"][1], found["limits"][1] - found["tangent_length"])
    radius = np.linspace(ring.tip, deepest, 30)[1:-1]
    nearest = np.full(len(radius), np.inf)
    for turn in 2.0 * np.pi / pinion.teeth * np.arange(0.0, 1.0, 0.01):
        points = pinion.corners(first + turn) - centre
        points = points[np.abs(points) > ring.tip]
        axis = second + turn * pinion.teeth / ring.teeth
        away = np.mod(np.angle(points) - axis, pitch)  # from a tooth up to the next one
        order = np.argsort(np.abs(points))
        for k, r in enumerate(radius):
            at = order[slice(*np.searchsorted(np.abs(points)[order], [0.9995 * r, 1.0005 * r]))]
            free = (away[at] - ring.half_angle(np.abs(points[at]))) * r
            nearest[k] = min(nearest[k], free.min(initial=np.inf))
    assert nearest.min() > -1e-5 * MODULE
    assert nearest.max() < 2e-3 * MODULE


@pytest.mark.parametrize(
    "gear", [*RING.gears, *HELICAL_RING.gears, V1.gears[0], FEW["GP1"].gears[0]]
)
def test_fillet_meets_root_circle_and_involute_without_a_kink(gear):
    tooth = Tooth(gear, 800)

    def slopes(radius, angle):
        chord = np.diff(radius * np.exp(1j * angle))
        return np.angle(chord[[0, -1]] / np.exp(1j * angle[[0, -1]]))

    at_root, at_end = slopes(*tooth.fillet)
    at_start = slopes(*tooth.flank)[0]
    assert tooth.fillet[0][-1] == pytest.approx(tooth.flank[0][0], rel=1e-12)
    assert tooth.fillet[1][-1] == pytest.approx(tooth.flank[1][0], rel=1e-9)
    assert at_end == pytest.approx(at_start, abs=0.02)
    assert abs(at_root) == pytest.approx(np.pi / 2.0, abs=0.02)  # along the root circle


SWEPT = {
    "GP1": FEW["GP1"].gears[0],
    "undercut": pair((4, 51), 20.0, 1.5e-3, 16e-3, profile_shift=(0.5, 0.29)).gears[0],
    "V1": V1.gears[0],
}


@pytest.mark.parametrize("name", SWEPT)
def test_a_swept_rack_leaves_the_fillet_of_a_helical_tooth(name):
    """Transverse section of the rack, its rounded corner stretched by 1/cos(beta), at all positions."""
    gear = SWEPT[name]
    assert gear.undercut == (name == "undercut")
    tooth = Tooth(gear, 400)
    module, angle = float(gear.module), ANGLE
    stretch = 1.0 / np.cos(float(gear.helix_angle))
    reference = float(gear.teeth) * module * stretch / 2.0
    rounding, depth = float(gear.fillet_radius), float(gear.dedendum)
    across = np.pi / 4.0 - (depth - rounding) * np.tan(angle) - rounding / np.cos(angle)
    corner = rounding * np.exp(-1j * np.linspace(angle, np.pi / 2.0, 240))
    corner = (
        across + corner.real + 1j * (corner.imag - depth + rounding + float(gear.profile_shift))
    )
    turned = np.linspace(-1.2, 1.2, 4001)[:, None] * 2.0 * module / reference
    # The rack's space axis is imaginary at turn zero; the tooth's axis is half a pitch away.
    points = module * (stretch * corner.real + 1j * corner.imag)
    points = (reference * (turned + 1j) + points) * np.exp(1j * turned)
    radius, away = (
        np.abs(points),
        float(gear.pitch_half_angle) - np.angle(1j / points * np.abs(points)),
    )
    here = (radius > tooth.root) & (radius < tooth.tip)
    free = (away - tooth.half_angle(radius)) * radius / module
    assert free[here].min() > -1e-5
    radii = np.linspace(tooth.root, tooth.fillet[0][-1], 20)
    for low, high in itertools.pairwise(radii):
        assert free[(radius > low) & (radius < high)].min() < 1e-5


APART = {
    "spur": pair((18, 36), module=3e-3, centre_distance=81.2e-3),
    "shifted": pair((23, 61), profile_shift=(0.4, -0.2), centre_distance=84.55e-3),
    "helical": pair((19, 33), 15.0, profile_shift=(0.2, 0.1), centre_distance=54.6e-3),
    "ring": pair((20, -60), addendum=(1.0, 0.8), centre_distance=39.9e-3),
}


def inv(angle):
    return np.tan(angle) - angle


@pytest.mark.parametrize("name", APART)
def test_backlash_of_a_centre_distance(name):
    """On the base circles j_wt cos(alpha_wt) = sum(z) m_t cos(alpha_t) (inv alpha_wt - inv alpha_w0)."""
    mesh = APART[name]
    found = figures(mesh)
    beta, total = float(mesh.helix_angle), float(found["teeth"].sum())
    transverse, working = found["transverse_pressure_angle"], found["working_pressure_angle"]
    base = total * float(mesh.module) / np.cos(beta) * np.cos(transverse)
    close = np.arccos(abs(base) / 2.0 / found["zero_backlash_centre_distance"])
    expected = base * (inv(working) - inv(close)) / np.cos(working)
    assert expected > 1e-5
    assert found["backlash"] == pytest.approx(expected, rel=1e-9)
    # ISO 21771: along the normal, by the normal pressure angle and the helix angle in operation.
    helix = np.arctan(np.tan(found["base_helix_angle"]) / np.cos(working))
    normal = np.arcsin(np.sin(working) * np.cos(found["base_helix_angle"]))
    by_normal = expected * np.cos(normal) * np.cos(helix)
    assert found["normal_backlash"] == pytest.approx(by_normal, rel=1e-9)


def test_without_a_centre_distance_there_is_no_backlash():
    assert abs(figures(pair((23, 61), profile_shift=(0.4, -0.2)))["backlash"]) < 1e-15


def test_virtual_spur_gear_has_the_teeth_of_the_normal_section():
    for g in (V1.gears[0], FEW["GP1"].gears[0], HELICAL_RING.gears[1]):
        virtual, slope = g.virtual_spur_gear, np.cos(float(g.base_helix_angle))
        rolled = float(g.reference_radius) * np.sin(float(g.transverse_pressure_angle)) / slope
        assert float(virtual.reference_radius) * np.sin(ANGLE) == pytest.approx(rolled, rel=1e-13)
        assert float(virtual.undercut_limit) == pytest.approx(float(g.undercut_limit), rel=1e-12)
        flat = float(virtual.half_thickness_angle(virtual.reference_radius)) * 2.0
        helical = float(g.half_thickness_angle(g.reference_radius)) * 2.0
        thickness = abs(float(g.reference_radius)) * helical * np.cos(float(g.helix_angle))
        assert abs(float(virtual.reference_radius)) * flat == pytest.approx(thickness, rel=1e-12)


def test_signs_of_a_ring():
    found = figures(RING)
    for name in ("base_radii", "tip_radii", "root_radius", "reference_radius", "working_radii"):
        assert found[name][0] > 0.0 > found[name][1]
    assert found["centre_distance"] == pytest.approx(-found["working_radii"].sum(), rel=1e-13)
    assert abs(found["base_radii"][1]) < abs(found["tip_radii"][1]) < abs(found["root_radius"][1])
    assert found["tangent_length"] < 0.0
    turns = found["motion"]
    assert turns[1] / turns[0] == pytest.approx(20 / 60, rel=1e-14)  # the same way round
    each, _ = contacts(RING, np.full(10, 0.3))
    np.testing.assert_allclose(np.tensordot(turns, each.normal, 1), 0.0, atol=1e-16)
    assert each.curvature[1, 0].max() < 0.0 < each.relative_curvature[0].min()


def test_a_positive_shift_thickens_the_teeth_of_a_ring_and_moves_them_inwards():
    thick, thin = (pair((20, -60), profile_shift=(0.3, x), **RACK) for x in (-0.3, -0.4))
    for mesh, other, sign in ((thick, thin, 1.0), (thin, thick, -1.0)):
        g, reference = mesh.gears[1], mesh.gears[1].reference_radius
        change = g.half_thickness_angle(reference) - other.gears[1].half_thickness_angle(reference)
        assert sign * float(change) > 0.0
        assert sign * (abs(float(g.tip_radius)) - abs(float(other.gears[1].tip_radius))) < 0.0
    assert float(thick.centre_distance) < float(thin.centre_distance)


@eqx.filter_jit
def _ratio_and_slope(mesh, values):
    def ratio(values):
        angle, width, shift = values
        changed = dataclasses.replace(
            mesh, helix_angle=angle, face_width=width, profile_shift=shift
        )
        changed = changed.completed()
        return changed.contact_ratio + 0.1 * changed.gears[0].tip_thickness / changed.module

    return jax.value_and_grad(ratio)(values)


@pytest.mark.parametrize("mesh", [FEW["GP1"], HELICAL_RING], ids=["few teeth", "ring"])
def test_derivatives_of_the_contact_ratio(mesh):
    """Centre distance and tips follow; a pinion tip shortened to a thickness keeps it."""
    mesh = dataclasses.replace(mesh, lanes=2, slices=1)
    values = (mesh.helix_angle, mesh.face_width, mesh.profile_shift)
    _, slopes = _ratio_and_slope(mesh, values)
    steps = [(1e-6, 0.0, [0.0, 0.0]), (0.0, 1e-8, [0.0, 0.0])]
    steps += [(0.0, 0.0, [1e-6, 0.0]), (0.0, 0.0, [0.0, 1e-6])]
    for step in steps:
        step = tuple(jnp.asarray(x) for x in step)
        up, down = (
            _ratio_and_slope(mesh, jax.tree.map(lambda x, d, s=sign: x + s * d, values, step))[0]
            for sign in (1.0, -1.0)
        )
        expected = sum(float(jnp.sum(a * b)) for a, b in zip(slopes, step, strict=True))
        assert abs(expected) > 1e-9
        assert float(up - down) / 2.0 == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("teeth", "shifts", "refused"),
    [
        ((84, -90), (0.05, -0.10), False),
        ((84, -90), (0.05, -0.05), True),
        ((54, -60), (0.25, -0.262), False),
        ((54, -60), (0.25, -0.24), True),
        ((24, -30), (0.23, -0.25), False),
        ((24, -30), (0.23, -0.22), True),
    ],
)
def test_tips_of_an_internal_pair_are_refused_where_the_drawn_teeth_overlap(teeth, shifts, refused):
    mesh = pair(teeth, profile_shift=shifts, **(RACK | {"addendum": (0.8, 0.8)}))
    assert (overlap(mesh, 24) > 2e-4) == refused
    if refused:
        with pytest.raises(InputError, match="run into each other where their tip circles cross"):
            check_cylindrical(mesh)
    else:
        check_cylindrical(mesh)


@pytest.mark.parametrize(("teeth", "shifts"), [((16, -30), (0.0, -0.29)), ((14, -60), (0.0, 0.0))])
def test_undercut_fillet_is_refused_by_as_much_as_the_drawn_tip_of_the_ring_enters_it(
    teeth, shifts
):
    mesh = pair(teeth, profile_shift=shifts, **(RACK | {"addendum": (1.0, 1.0)}))
    with pytest.raises(InputError, match="undercut fillet of gear 1") as caught:
        check_cylindrical(mesh)
    assert caught.value.value == pytest.approx(overlap(mesh, 24), rel=0.01)


@pytest.mark.parametrize(
    ("teeth", "shifts", "apart"),
    [
        ((46, -60), (0.14, -0.14), True),
        ((40, -60), (0.13, -0.35), True),
        ((50, -60), (0.40, -0.44), False),
        ((52, -60), (0.30, -0.37), False),
    ],
)
def test_pinion_goes_into_its_ring_radially_where_the_drawn_teeth_let_it(teeth, shifts, apart):
    mesh = pair(teeth, profile_shift=shifts, **(RACK | {"addendum": (0.8, 0.8)}))
    found = figures(mesh)
    pinion, ring = (Tooth(g, 60) for g in mesh.gears)
    first, second, centre = placed(mesh, found, found["points"][2])
    deepest = -np.inf
    for turn in 2.0 * np.pi * np.arange(0.0, 1.0, 0.125):
        points = pinion.corners(first + turn / pinion.teeth, 3) - centre
        axis = second + turn / ring.teeth
        for moved in np.linspace(0.0, 2.4, 25) * MODULE:
            deepest = max(deepest, ring.depth(points - moved, axis).max(initial=-1.0))
    assert (deepest < 1e-3 * MODULE) == apart
    assert any("along its axis" in text for text in check_cylindrical(mesh)) != apart


def random_pairs(count):
    """Designs of all kinds, most of them without undercut."""
    rng = np.random.default_rng(7)
    for k in range(count):
        internal, degrees = k % 3 > 0, (0.0 if k % 3 == 1 else rng.uniform(5.0, 35.0))
        first = int(rng.integers(8, 40))
        second = -first - int(rng.integers(5, 40)) if internal else int(rng.integers(20, 60))
        least = 1.0 - first / 2.0 * np.sin(ANGLE) ** 2
        shift = max(least, 0.0) + rng.uniform(0.05, 0.4)
        yield (
            (first, second),
            degrees,
            {
                "profile_shift": (shift, -shift * rng.uniform(0.5, 1.5)),
                "addendum": tuple(rng.uniform((0.8, 0.6), 1.1)),
                "dedendum": (1.25, 1.25),
                "fillet_radius": (0.3, 0.2),
            },
        )


def test_random_pairs_that_pass_the_checks_neither_overlap_nor_lose_contact():
    passed, refused = {True: 0, False: 0}, 0
    for teeth, degrees, options in random_pairs(45):
        try:
            mesh = pair(teeth, degrees, **options)
            check_cylindrical(mesh)
        except InputError:
            refused += 1
            continue
        passed[mesh.internal] += 1
        deepest = max(gear.fillet_overlap for gear in _measure(mesh)[1])
        assert deepest < 0.005
        assert overlap(mesh, 4) < 1.01 * deepest + 1e-5, (teeth, degrees, options)
        each, _ = contacts(mesh, np.arange(10) / 10)
        assert all(np.isfinite(x).all() for x in jax.tree.leaves(each))
        assert each.active.any(axis=(0, 1)).all()
        assert each.relative_curvature[0][each.active].min() > 0.0
    assert min(passed.values()) > 10
    assert refused > 5
