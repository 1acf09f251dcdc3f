"""Strength of cylindrical pairs: other routes to the same numbers, rings, limits and derivatives."""

from dataclasses import replace
from math import nan, pi, radians

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from rated_pairs import (
    FINISH,
    Found,
    base_pair,
    duty,
    factors,
    fzg_ratings,
    kisssoft,
    kst_e,
    numbers,
    rating,
    strengths,
    with_circles,
)

from pitchpoint.contact.hertz import line_pressure
from pitchpoint.core.programs import program
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.gears.rated_pair import bare_pair
from pitchpoint.materials import solids
from pitchpoint.results.strength_variables import STRENGTH
from pitchpoint.results.variables import VARIABLES
from pitchpoint.strength.rating import rated
from pitchpoint.strength.treatments import TREATMENTS

# ---- other routes to the same numbers


@pytest.fixture(scope="module")
def base() -> CylindricalPair:
    return base_pair()


@pytest.fixture(scope="module")
def fzg() -> Found:
    return fzg_ratings()


def test_the_zone_factor_is_hertz_at_the_pitch_point(fzg: Found) -> None:
    """sigma_H0 without Z_eps is the pressure of one pair of flanks over the face, by their curvatures."""
    base_radii, angle = np.array([67.658, 101.487]) * 0.5e-3, radians(22.43879)
    rolling = base_radii * np.tan(angle)
    young = 210e9 / (1.0 - 0.3**2)
    expected = line_pressure(
        line_load=fzg["normal_force"] / 14e-3,
        radius=np.prod(rolling) / np.sum(rolling),
        modulus=young,
    )
    nominal = fzg["nominal_contact_stress"] / fzg["contact_ratio_factor"]
    assert float(nominal) == pytest.approx(float(expected), rel=1e-5)


def test_the_single_pair_factor_is_hertz_where_one_pair_begins(fzg: Found) -> None:
    """One base pitch before the end of the path, with the curvatures there."""
    base_radii, tip = np.array([67.658, 101.487]) * 0.5e-3, 82.45e-3 / 2.0
    whole = 91.5e-3 * np.sin(radians(22.43879))
    at = np.sqrt(tip**2 - base_radii[0] ** 2) - 2.0 * pi * base_radii[0] / 16.0
    pitch = base_radii[0] * np.tan(radians(22.43879))
    ratio = np.sqrt(pitch * (whole - pitch) / (at * (whole - at)))
    assert fzg["single_contact_factor"][0] == pytest.approx(ratio, rel=1e-4)


@program
def _where_one_carries(pair: CylindricalPair) -> tuple[jax.Array, jax.Array]:
    """Ends of the path; angle of the force on gear 2 a base pitch from the tip of gear 1."""
    pinion, wheel = pair.gears
    roll = pair.tangent_length - pinion.tip_roll_length + pair.base_pitch
    half = wheel.half_thickness_angle(jnp.hypot(wheel.base_radius, roll))
    return pair.limits, jnp.arctan(roll / wheel.base_radius) - half


@pytest.mark.parametrize(("wheel", "factor"), [(41, 1.2363), (120, 1.2831)])
def test_an_undercut_moves_the_point_where_one_pair_begins(wheel: int, factor: float) -> None:
    """Factors by hand, from the curvatures a base pitch from the tip of the pinion; x = 0, full tips."""
    pair = build_cylindrical_pair(
        teeth=(12, wheel),
        module=2.5e-3,
        pressure_angle=radians(20.0),
        face_width=0.02,
        tip_alteration=(0.0, 0.0),
    )
    ends, angle = _where_one_carries(pair)
    found = rating(bare_pair(pair), duty(50.0, 1500.0), factors(), strengths(), ends=ends)
    np.testing.assert_allclose(found["single_contact_factor"], [factor, 1.0], atol=5e-5)
    assert found["load_angle"][1] == pytest.approx(float(angle), rel=1e-9)


@program
def _flanks(pair: CylindricalPair) -> jax.Array:
    return jnp.stack([gear.outline(800)[800:1600] for gear in pair.gears])


def tangent(fillet: np.ndarray, angle: float) -> tuple[float, float]:
    """Where a fillet makes an angle with the middle of its tooth: half chord and distance from the axis."""
    across, along = np.abs(fillet[:, 0]), fillet[:, 1]
    slopes = np.arctan2(np.abs(np.diff(across)), np.abs(np.diff(along)))
    middles = np.abs(fillet[1:] + fillet[:-1]) / 2.0
    order = np.argsort(slopes)
    return tuple(float(np.interp(angle, slopes[order], one[order])) for one in middles.T)  # type: ignore[return-value]


def test_the_section_of_a_cut_tooth_touches_its_generated_fillet(
    base: CylindricalPair, fzg: Found
) -> None:
    pair = with_circles(
        base,
        teeth=(25, 40),
        module=4.5e-3,
        tips=(122e-3, 190e-3),
        profile_shift=(0.1, 0.2),
        centre_distance=148e-3,
        face_width=14e-3,
    )
    found = rating(pair, duty(195.0, 1500.0), factors(), strengths())
    for gear, fillet in enumerate(np.asarray(_flanks(pair))):
        half, _ = tangent(fillet, radians(30.0))
        assert 2.0 * half == pytest.approx(found["root_chord"][gear], rel=1e-4)


@pytest.fixture(scope="module")
def ring() -> CylindricalPair:
    return build_cylindrical_pair(
        teeth=(20, -70),
        module=1e-3,
        pressure_angle=radians(20.0),
        face_width=0.01,
        addendum=(1.0, 0.8),
        fillet_radius=(0.3, 0.3),
    )


def test_a_ring_is_rated_on_the_fillet_that_it_has(ring: CylindricalPair) -> None:
    found = rating(bare_pair(ring), duty(7.0, 1000.0), factors(), strengths())
    half, distance = tangent(np.asarray(_flanks(bare_pair(ring)))[1], radians(60.0))
    assert found["root_chord"][1] == pytest.approx(2.0 * half, rel=1e-3)
    assert found["root_fillet_radius"][1] == pytest.approx(0.3e-3)
    # The force is tangent to the base circle: it crosses the middle of the tooth at r_b/cos(alpha_Fn).
    crossing = 35e-3 * np.cos(radians(20.0)) / np.cos(found["load_angle"][1])
    assert found["bending_arm"][1] == pytest.approx(distance - crossing, rel=5e-3)
    assert found["single_contact_factor"][1] == 1.0
    assert found["form_factor"][1] < found["form_factor"][0]
    # Forces are in balance with both torques.
    working = np.array([20.0, 70.0]) * 25e-3 / 50.0
    torques = float(found["tangential_force"]) * working
    assert torques == pytest.approx([2.0, 7.0], rel=1e-9)


def test_a_thinner_ring_has_thinner_roots(ring: CylindricalPair) -> None:
    given = duty(7.0, 1000.0), factors(), strengths()
    nominal = rating(bare_pair(ring), *given)
    thin = replace(FINISH, thickness=numbers(0.0, -60e-6))
    found = rating(bare_pair(ring), *given, thin)
    assert nominal["root_chord"][1] - found["root_chord"][1] == pytest.approx(60e-6)
    assert found["root_chord"][0] == nominal["root_chord"][0]
    # Bending goes with the square of the chord, and the force crosses the thinner tooth nearer to its root.
    thicker = (nominal["root_chord"][1] / found["root_chord"][1]) ** 2
    stress = found["root_stress"][1] / nominal["root_stress"][1]
    assert 1.0 < stress < 1.1 * thicker


def test_planet_and_ring_as_kisssoft_prints_them(ring: CylindricalPair) -> None:
    """Its ring has the root that a pinion cutter leaves, rounder than the arc that is rated here."""
    pair = replace(
        bare_pair(ring),
        teeth=numbers(17, -56),
        module=numbers(45e-3),
        profile_shift=numbers(0.8021, -0.5013),
        addendum=numbers(1.0, 1.0),
        tip_alteration=numbers(-10.861 / 45.0, 0.0),
        dedendum=numbers(1.25, 1.25),
        fillet_radius=numbers(0.38, 0.30),
        centre_distance=numbers(0.863),
        face_width=numbers(0.491),
    )
    found = rating(pair, duty(779454.877 * 1.26, 60.0 * 1.60 / pi / 0.765), factors(), kisssoft())
    for name, printed, within in (
        ("reference_force", 779454.877, 1.0),
        ("tangential_force", 792551.164, 20.0),
        ("radial_force", 244739.454, 20.0),
        ("zone_factor", 2.71, 5e-3),
        ("contact_ratio_factor", 0.952, 6e-4),  # eps_alpha with four digits
        ("nominal_contact_stress", 588.62e6, 1e5),
        ("single_contact_factor", 1.0, 1e-9),
        ("load_angle", np.radians([29.87, 19.59]), 3e-4),
    ):
        values = np.broadcast_to(found[name], 2)
        np.testing.assert_allclose(values, np.broadcast_to(printed, 2), atol=within, err_msg=name)
    assert found["bending_arm"][0] == pytest.approx(49.53e-3, abs=3e-5)
    assert found["form_factor"][0] == pytest.approx(1.14, abs=5e-3)
    assert found["stress_correction_factor"][0] == pytest.approx(2.38, abs=5e-3)
    assert found["nominal_root_stress"][0] / 1e6 == pytest.approx(95.70, abs=0.1)
    assert found["nominal_root_stress"][1] / 1e6 > 95.32


def test_a_ring_of_a_pinion_cutter_as_kisssoft_prints_it(ring: CylindricalPair) -> None:
    """Second stage by the edition of 2006: cutter of 30 teeth, x_0 = 0, corners of 0.3 modules."""
    pair = replace(
        bare_pair(ring),
        teeth=numbers(36, -93),
        module=numbers(21e-3),
        profile_shift=numbers(0.5039, 0.1171),
        addendum=numbers(1.0, 1.0),
        tip_alteration=numbers(-1.750 / 21.0, 0.0),
        dedendum=numbers(1.25, 1.25),
        fillet_radius=numbers(0.38, 0.30),
        centre_distance=numbers(0.584),
        face_width=numbers(0.55),
        cutter_teeth=numbers(30.0),
        cutter_shift=numbers(0.0),
    )
    asked = duty(285900.438 * 1.953 / 2.0, 60.0 * 4.88 / pi / 0.756)
    found = rating(pair, asked, factors(before_2019=1.0), kisssoft())
    for name, printed, within in (
        ("reference_force", 285900.438, 1.0),
        ("root_chord", [47.70e-3, 56.76e-3], 6e-6),
        ("bending_arm", [18.48e-3, 30.32e-3], 6e-6),
        ("load_angle", np.radians([22.21, 18.63]), 1e-4),
        ("root_fillet_radius", [8.69e-3, 8.78e-3], 6e-6),
        ("form_factor", [1.01, 1.20], 5e-3),
        ("stress_correction_factor", [2.48, 2.34], 5e-3),
        ("nominal_root_stress", [61.98e6, 69.12e6], 1e4),
    ):
        np.testing.assert_allclose(found[name], printed, atol=within, err_msg=name)
    # The fillet that the cutter leaves, by the edition of 2019, and an arc of its corners' radius.
    newer = rating(pair, asked, factors(), kisssoft())["nominal_root_stress"][1]
    arc = rating(replace(pair, cutter_teeth=None, cutter_shift=None), asked, factors(), kisssoft())[
        "nominal_root_stress"
    ][1]
    assert newer / 1e6 == pytest.approx(71.59, abs=0.05)
    assert arc / newer == pytest.approx(1.12, abs=0.02)


def test_the_root_of_a_rack_is_a_straight_tooth(base: CylindricalPair) -> None:
    """With very many teeth the section is that of a rack: its corner, 30 degrees from the middle."""
    pair = with_circles(
        base,
        teeth=(100_000, 100_000),
        module=1e-3,
        tips=(100.002, 100.002),
        profile_shift=(0.0, 0.0),
        centre_distance=100.0,
    )
    found = rating(pair, duty(1.0, 1.0), factors(), strengths())
    angle, depth, rounding = radians(20.0), 1.25, 0.38
    corner = pi / 4.0 - (depth - rounding) * np.tan(angle) - rounding / np.cos(angle)
    half = pi / 2.0 - corner - rounding * np.cos(radians(30.0))
    assert found["root_chord"][0] == pytest.approx(2.0 * half * 1e-3, rel=1e-3)
    assert found["root_fillet_radius"][0] == pytest.approx(rounding * 1e-3, rel=1e-3)


# ---- limits and derivatives


def test_every_number_has_its_name(fzg: Found) -> None:
    assert fzg.keys() == STRENGTH.keys()
    assert all(VARIABLES[name] == one for name, one in STRENGTH.items())  # no other takes its name
    assert all(value.shape in ((), (2,)) for value in fzg.values())


@pytest.mark.parametrize(
    ("flank", "root", "expected"),
    [
        (1.0, 1.0, (1.6, 2.5)),
        (5e7, 3e6, (1.0, 1.0)),
        (1e10, 1e10, (0.85, 0.85)),
        (1e12, 1e12, (0.85, 0.85)),
    ],
)
def test_life_factors_at_their_corners(
    base: CylindricalPair, flank: float, root: float, expected: tuple[float, float]
) -> None:
    found = rating(kst_e(base), duty(1.0, 1.0, flank, root), factors(), strengths())
    corners = found["flank_life_factor"][0], found["root_life_factor"][0]
    assert corners == pytest.approx(expected)


def test_permissible_stresses_at_a_limited_life(base: CylindricalPair) -> None:
    """Lines from static strength to endurance, DIN 3990-11:1989, eqs. 4.08, 5.04 and 5.06, by hand."""
    cycles_flank, cycles_root = 1e6, 1e5
    few, asked, many = (
        rating(kst_e(base), duty(1.0, 1.0, flank, root), factors(), strengths())
        for flank, root in ((1e5, 1e3), (cycles_flank, cycles_root), (5e7, 3e6))
    )
    np.testing.assert_allclose(few["contact_limit"], 1.6 * 1510e6)  # no oil film, no roughness
    notch = 0.44 * few["stress_correction_factor"] + 0.12
    np.testing.assert_allclose(few["root_limit"], 2.5 * 2.0 * 475e6 * notch)
    for name, ends, number, slope in (
        ("contact_limit", 5e7, cycles_flank, 0.3705),
        ("root_limit", 3e6, cycles_root, 0.2876),
    ):
        power = slope * np.log10(few[name] / many[name])
        line = many[name] * (ends / number) ** power
        np.testing.assert_allclose(asked[name], line, rtol=2e-5)  # the slopes have four digits


def test_stresses_grow_with_the_load_as_they_should(base: CylindricalPair) -> None:
    one, four = (
        rating(kst_e(base), duty(load, 1.0), factors(), strengths()) for load in (2.0, 8.0)
    )
    np.testing.assert_allclose(four["contact_stress"], 2.0 * one["contact_stress"])
    np.testing.assert_allclose(four["root_stress"], 4.0 * one["root_stress"])


def test_many_designs_are_one_batch_and_have_derivatives(base: CylindricalPair) -> None:
    pair, asked = kst_e(base), duty(8.0, 1000.0)

    def root_safety(width: jax.Array) -> jax.Array:
        found = rated(
            replace(pair, face_width=width),
            numbers(nan, nan),
            asked,
            factors(),
            strengths(),
            FINISH,
        )
        return found["root_safety"][0]

    widths = jnp.asarray(np.linspace(0.01, 0.02, 1000))
    values, slopes = jax.jit(jax.vmap(jax.value_and_grad(root_safety)))(widths)
    assert float(values[0]) < float(values[-1])
    steps = np.diff(values) / np.diff(widths)
    np.testing.assert_allclose((slopes[1:] + slopes[:-1]) / 2.0, steps, rtol=1e-5)


def test_materials_of_the_catalogue_name_treatments_that_are_known() -> None:
    limited = [one for one in solids.catalogue().values() if one.sigma_hlim is not None]
    assert limited
    for one in limited:
        assert one.treatment in TREATMENTS
        assert one.sigma_flim is not None
        assert one.sigma_hlim.source == "iso_6336_5_2016"
