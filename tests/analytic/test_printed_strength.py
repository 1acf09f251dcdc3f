"""Strength of cylindrical pairs: what other programs print, other routes to the same numbers, limits.

STplus (FZG, Munich) and the FVA Workbench compute by ISO 6336 and DIN 3990; their listings are printed in a
public repository, https://github.com/tkuhn39/semesterthesis. Each program here is traced once.
"""

from dataclasses import replace
from math import degrees, nan, pi, radians
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
from rated_pairs import (
    STEEL,
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

from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.materials import solids
from pitchpoint.materials.solids import Solid
from pitchpoint.strength.load_factors import root_face_load_factor
from pitchpoint.strength.rating import Finish

PRINTED_FZG = {
    "reference_force": (3611.1, 0.05),
    "tangential_force": (3551.9, 0.05),
    "normal_force": (3842.9, 0.05),
    "zone_factor": (2.342, 5e-4),
    "elasticity_factor": (191.6, 0.05),
    "contact_ratio_factor": (0.924, 6e-4),
    "nominal_contact_stress": (1013.8e6, 1e5),
    "single_contact_factor": ([1.075, 1.000], 5e-4),
    "lubricant_factor": (0.960, 5e-4),
    "velocity_factor": (0.985, 5e-4),
    "roughness_factor": (1.037, 5e-4),
    "contact_limit": (1480.9e6, 7e5),  # STplus takes v of the pitch circles in operation
    "root_face_load_factor": (1.21, 5e-3),
    "form_factor": ([2.087, 1.866], 1e-3),
    "stress_correction_factor": ([1.758, 1.856], 1e-3),
    "notch_parameter": ([1.93, 2.18], 5e-3),
    "root_chord": ([1.933 * 4.5e-3, 2.089 * 4.5e-3], 3e-6),
    "bending_arm": ([1.329 * 4.5e-3, 1.385 * 4.5e-3], 3e-6),
    "root_fillet_radius": ([0.501 * 4.5e-3, 0.479 * 4.5e-3], 3e-6),
    "nominal_root_stress": ([210.3e6, 198.5e6], 1.5e5),
    "notch_sensitivity_factor": ([0.994, 0.997], 5e-4),
    "surface_factor": (0.957, 5e-4),
    "root_limit": ([903.7e6, 906.1e6], 3e5),
}


@pytest.fixture(scope="module")
def base() -> CylindricalPair:
    return base_pair()


@pytest.fixture(scope="module")
def fzg() -> Found:
    return fzg_ratings()


@pytest.mark.parametrize("name", PRINTED_FZG)
def test_test_gears_as_stplus_prints_them(fzg: Found, name: str) -> None:
    printed, half_digit = PRINTED_FZG[name]
    values = np.broadcast_to(fzg[name], np.broadcast_shapes(fzg[name].shape, np.shape(printed)))
    np.testing.assert_allclose(
        values, np.broadcast_to(printed, values.shape), atol=half_digit, rtol=0.0
    )


def test_safeties_of_the_test_gears(fzg: Found) -> None:
    """K_v and K_Hbeta are printed with three digits, which the stresses have half of, or all."""
    np.testing.assert_allclose(fzg["flank_safety"], [1.166, 1.253], rtol=3e-3)
    np.testing.assert_allclose(fzg["root_safety"], [3.446, 3.661], rtol=6e-3)
    angles = np.degrees(fzg["load_angle"])
    np.testing.assert_allclose(angles, [23.206, 22.975], atol=0.03)


def test_a_pair_by_din_3990(base: CylindricalPair) -> None:
    """STplus 11.0F by DIN 3990:1987, whose method B is that of ISO 6336 for spur gears; both as steel."""
    plastic = Solid(young=2.3e9, poisson=0.5, density=1140.0)
    both = strengths(solids=(STEEL, plastic), flank=numbers(nan, nan), root=numbers(430e6, nan))
    loads = factors(dynamic=1.56, face=1.19, root_face=1.16)
    found = rating(kst_e(base), duty(10.0, 1000.0), loads, both)
    assert float(found["reference_force"]) == pytest.approx(384.6, abs=0.05)
    assert float(found["nominal_contact_stress"]) / 1e6 == pytest.approx(72.4, abs=0.05)
    np.testing.assert_allclose(found["single_contact_factor"], [1.009, 1.008], atol=1e-3)
    np.testing.assert_allclose(found["contact_stress"] / 1e6, [99.6, 99.5], atol=0.15)
    np.testing.assert_allclose(found["form_factor"], [2.417, 1.970], atol=1.5e-3)
    np.testing.assert_allclose(found["stress_correction_factor"], [1.819, 1.984], atol=1e-3)
    wide = np.array([15.0 / 17.0, 1.0])  # gear 1 is 17 mm wide at its root
    np.testing.assert_allclose(wide * found["nominal_root_stress"] / 1e6, [99.5, 100.2], atol=0.1)
    np.testing.assert_allclose(wide * found["root_stress"] / 1e6, [180.1, 181.4], rtol=2e-3)
    assert found["root_safety"][0] / wide[0] == pytest.approx(4.571, rel=3e-3)
    assert np.isnan(found["root_safety"][1]) and np.isnan(found["flank_safety"]).all()


def test_a_plastic_wheel_by_vdi_2736(base: CylindricalPair) -> None:
    """The same pair by the FVA Workbench: force at the tip, pressure of the pitch point."""
    plastic = Solid(young=4.156e9, poisson=0.34, density=1400.0)
    both = strengths(
        solids=(STEEL, plastic),
        plastic=(False, True),
        flank=numbers(1510e6, 80e6),
        root=numbers(430e6, 35e6),
    )
    found = rating(kst_e(base), duty(8.0, 2250.0), factors(), both)
    assert found["contact_stress"][1] / 1e6 == pytest.approx(79.893, abs=0.1)
    assert found["root_stress"][1] / 1e6 == pytest.approx(77.896, rel=3e-3)
    assert found["form_factor"][1] == pytest.approx(2.211, abs=1.5e-3)  # Y_Fa of STplus
    assert found["stress_correction_factor"][1] == pytest.approx(1.904, abs=1e-3)
    assert found["root_safety"][1] == pytest.approx(
        2.0 * 35e6 / found["root_stress"][1]
    )  # Y_St = 2
    assert found["flank_safety"][1] == pytest.approx(80e6 / found["contact_stress"][1])


@pytest.mark.parametrize(
    ("name", "temperature", "cycles", "expected"),
    [  # by hand, in MPa
        ("POM-H", 50.0, 1e6, 26.0 - 0.0025 * 2500.0 + 400.0 / 15.8489),
        ("POM-H", 90.0, 1e7, 5.75 + 400.0 / 25.1189),
        ("POM-H", 20.0, 1e3, 70.0),  # no more than a bar without notch
        ("PA66", 60.0, 1e6, 16.8 + (4600.0 - 900.0 * 3.41543) / 100.0),
        ("PA66", 100.0, 1e8, 8.0 + (4600.0 - 900.0 * 3.98107) / 464.159),
    ],
)
def test_plastic_roots_over_temperature_and_cycles(
    base: CylindricalPair, name: str, temperature: float, cycles: float, expected: float
) -> None:
    record = solids.find(name)
    assert record.root_strength is not None and record.tensile_strength is not None
    curve = (*record.root_strength.at(temperature + 273.15), record.tensile_strength.value)
    both = strengths(
        plastic=(False, True),
        root=numbers(430e6, nan),
        over_cycles=jnp.asarray(np.stack([np.full(4, nan), curve], axis=1)),
    )
    found = rating(kst_e(base), duty(8.0, 2250.0, root=cycles), factors(), both)
    assert found["root_endurance"] / 1e6 == pytest.approx([430.0, expected], rel=1e-5)
    assert found["root_safety"][1] == pytest.approx(
        2e6 * expected / found["root_stress"][1], rel=1e-5
    )
    assert found["root_cycles"][1] == cycles


# Example 1 of ISO/TR 6336-30: dimensions and duty stand in two public repositories, tkuhn39/semesterthesis
# (2022 edition, annex A) and gfsReboucas/Drivetrain (MATISO_6336.m, 2017 edition). The factors and stresses
# of the flank are printed in the latter only, beside that program's own.
@pytest.fixture(scope="module")
def example_1(base: CylindricalPair) -> Found:
    """Of the 2006 edition, where gears with an overlap ratio above 1 have Z_B = Z_D = 1: f_ZCa = 1."""
    pair = with_circles(
        base,
        teeth=(17, 103),
        module=8e-3,
        tips=(159.66e-3, 872.35e-3),
        profile_shift=(0.14522, 0.0),
        helix_angle=radians(15.8),
        centre_distance=0.5,
        face_width=0.1,
        dedendum=(1.4, 1.4),
        fillet_radius=(0.39, 0.39),
    )
    steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    both = strengths(solids=(steel, steel), flank=numbers(1500e6, 1500e6))
    asked = duty(9000.0 * 103.0 / 17.0, 360.0)
    asked = replace(asked, cycles_flank=numbers(1.080e9, 1.783e8))
    loads = factors(dynamic=1.003, face=1.16, correction=1.0)
    finish = Finish(numbers(0.0, 0.0), numbers(6e-6), numbers(6e-6, 6e-6), numbers(320e-6))
    return rating(pair, asked, loads, both, finish)


PRINTED_EXAMPLE_1 = {
    "reference_force": (127352.0, 0.5),
    "zone_factor": (2.39533, 1.5e-5),
    "elasticity_factor": (189.81170, 5e-5),
    "contact_ratio_factor": (0.803, 5e-4),
    "helix_factor": (1.01944, 5e-6),
    "nominal_contact_stress": (1206.58207e6, 2e5),  # Z_eps with three digits
    "single_contact_factor": (1.0, 1e-12),
    "contact_stress": (1301.35343e6, 3e5),  # K_v and Z_eps with three digits
    "lubricant_factor": (1.04739, 5e-6),
    "velocity_factor": (0.96911, 1e-5),  # v with four digits
    "roughness_factor": (0.96599, 1e-5),
    "work_hardening_factor": (1.0, 0.0),
    "flank_size_factor": (1.0, 0.0),
    "flank_life_factor": ([0.910, 0.962], 5e-4),
    "contact_limit": ([1338.48050e6, 1414.52551e6], 6e5),  # Z_NT with three digits
    "flank_safety": ([1.02853, 1.08696], 6e-4),
}


@pytest.mark.parametrize("name", PRINTED_EXAMPLE_1)
def test_example_1_of_iso_tr_6336_30(example_1: Found, name: str) -> None:
    printed, within = PRINTED_EXAMPLE_1[name]
    values = np.broadcast_to(example_1[name], np.broadcast_shapes(2, np.shape(printed)))
    np.testing.assert_allclose(
        values, np.broadcast_to(printed, values.shape), atol=within, rtol=0.0
    )


def test_face_load_factor_of_the_root_of_example_1() -> None:
    """From its tip and root diameters, those of teeth cut with x_E."""
    factor = root_face_load_factor(
        flank=1.16, face_width=0.1, height=(159.66e-3 - 120.825e-3) / 2.0
    )
    assert float(factor) == pytest.approx(1.12803, abs=2e-5)


def third_stage(base: CylindricalPair, **more: Any) -> CylindricalPair:
    """Helical stage of a wind turbine's gearbox, as KISSsoft prints it."""
    return with_circles(
        base,
        teeth=(24, 95),
        module=14e-3,
        tips=(380.747e-3, 1395.376e-3),
        profile_shift=(0.48, 0.6691),
        helix_angle=radians(10.0),
        centre_distance=0.861,
        face_width=0.36,
        **more,
    )


def test_a_helical_stage_as_kisssoft_prints_it(base: CylindricalPair) -> None:
    """Third stage. The edition of 2019 has f_eps in Y_F and a cube of the cosine in Y_beta beside it.

    The angle of the force is 0.015 and 0.009 deg more there, and with it the arm 0.2 % longer; spur gears
    have all digits, as the helical pinion of the FVA Workbench below.
    """
    helix, ratio = radians(10.0), 61.276 / 41.891
    pair = third_stage(base)
    asked = duty(162105.5, 1165.9)
    cycles = numbers(12255.788e6, 3096.199e6)
    asked = replace(asked, cycles_flank=cycles, cycles_root=cycles)
    loads = factors(application=1.25, dynamic=1.092, face=1.15, transverse=1.069, correction=1.0)
    finish = Finish(numbers(0.0, 0.0), numbers(4.8e-6), numbers(20e-6, 20e-6), numbers(220e-6))
    found = rating(pair, asked, loads, kisssoft(), finish)
    for name, printed, within in (
        ("reference_force", 240064.4, 10.0),
        ("tangential_force", 235840.3, 10.0),
        ("radial_force", 99409.4, 10.0),
        ("axial_force", 42329.8, 2.0),
        ("normal_force", 259412.2, 10.0),
        ("zone_factor", 2.307, 5e-4),
        ("elasticity_factor", 189.812, 5e-4),
        ("contact_ratio_factor", 0.827, 5e-4),
        ("helix_factor", 1.008, 5e-4),
        ("nominal_contact_stress", 570.79e6, 1e5),
        ("contact_stress", 739.61e6, 3.5e5),  # K_v and K_Halpha with four digits
        ("lubricant_factor", 1.020, 5e-4),
        ("velocity_factor", 1.022, 5e-4),
        ("roughness_factor", 1.007, 5e-4),
        ("flank_life_factor", [0.850, 0.881], 5e-4),
        ("root_face_load_factor", 1.136, 6e-4),  # teeth with allowances are a little higher
        ("load_angle", np.radians([23.89, 22.20]), radians(0.02)),
        ("bending_arm", [14.06e-3, 16.11e-3], 3e-5),
        ("root_chord", [31.18e-3, 32.75e-3], 6e-6),
        ("root_fillet_radius", [5.95e-3, 5.39e-3], 6e-6),
        ("notch_parameter", [2.620, 3.036], 1e-3),
        ("stress_correction_factor", [2.28, 2.35], 7e-3),
        ("notch_sensitivity_factor", [1.001, 1.005], 5e-4),
        ("surface_factor", 0.957, 5e-4),
        ("root_size_factor", 0.910, 1e-9),
        ("root_life_factor", [0.850, 0.870], 5e-4),
        ("root_limit", [637.15e6, 654.72e6], 4e5),
    ):
        values = np.broadcast_to(found[name], 2)
        np.testing.assert_allclose(values, np.broadcast_to(printed, 2), atol=within, err_msg=name)
    newer = np.cos(found_base_helix(helix)) / np.sqrt(ratio)  # f_eps
    np.testing.assert_allclose(found["form_factor"] / newer, [1.18, 1.24], atol=5e-3)
    newer /= np.cos(helix) ** 3
    nominal = found["nominal_root_stress"] / newer
    np.testing.assert_allclose(nominal / 1e6, [117.92, 127.69], rtol=2.5e-3)
    np.testing.assert_allclose(found["root_safety"] * newer, [3.26, 3.09], atol=0.015)
    # KISSsoft prints Z_X = 1.
    safeties = found["flank_safety"] / found["flank_size_factor"]
    np.testing.assert_allclose(safeties, [1.81, 1.88], atol=5e-3)


def test_the_dynamic_factor_by_method_b_as_kisssoft_prints_it(base: CylindricalPair) -> None:
    """Third stage in class 6: m_red 0.36503 kg/mm, N 0.410, K_v 1.092, and the edition of 2006 throughout."""
    roots, bores = np.array([319.623, 1334.252]), np.array([179.10, 1193.32])
    pair = third_stage(base, rim_ratio=roots / bores)
    loads = factors(
        application=1.25,
        dynamic=nan,
        face=1.15,
        transverse=1.069,
        correction=1.0,
        before_2019=1.0,
        method_b=1.0,
    )
    loads = replace(loads, deviations=numbers(15.9e-6, 22e-6))  # f_pb and f_falpha of the wheel
    steel = Solid(young=206e9, poisson=0.3, density=7830.0)
    of = replace(kisssoft(), solids=(steel, steel))
    found = rating(pair, duty(162105.5, 1165.9), loads, of)
    # C_R is 0.898 there, 1 here: N goes with the root of the stiffness, B_p and B_f with it.
    assert found["resonance_ratio"] / np.sqrt(0.898) == pytest.approx(0.410, abs=1e-3)
    deviating = found["dynamic_factor_b"] - 1.0 - found["resonance_ratio"] * 0.096 / (2.884 - 1.56)
    given = 0.410 / found["resonance_ratio"] * 0.898
    relief = 0.410 * 0.096 / (2.884 - 1.56)
    assert 1.0 + deviating * given + relief == pytest.approx(1.092, abs=1e-3)
    assert (
        found["rated_dynamic_factor"] == found["dynamic_factor_b"] > found["dynamic_factor_c"] - 0.3
    )
    np.testing.assert_allclose(found["form_factor"], [1.18, 1.24], atol=5e-3)
    np.testing.assert_allclose(found["root_helix_factor"], 0.917, atol=5e-4)
    np.testing.assert_allclose(found["nominal_root_stress"] / 1e6, [117.92, 127.69], rtol=2.5e-3)


def found_base_helix(helix: float) -> float:
    """sin(beta_b) = sin(beta) cos(alpha_n)."""
    return float(np.arcsin(np.sin(helix) * np.cos(radians(20.0))))


def test_sun_and_planet_as_kisssoft_prints_them(base: CylindricalPair) -> None:
    """First stage, spur: both editions agree, with the load above the middle of short, thick teeth."""
    pair = with_circles(
        base,
        teeth=(19, 17),
        module=45e-3,
        tips=(978.808e-3, 905.470e-3),
        profile_shift=(0.6170, 0.8021),
        centre_distance=0.863,
        face_width=0.491,
    )
    asked = duty(779454.877 * 0.765 / 2.0, 60.0 * 1.60 / pi / 0.855)
    cycles = numbers(1124.7e6, 419.0e6)
    asked = replace(asked, cycles_flank=cycles, cycles_root=cycles)
    finish = Finish(numbers(0.0, 0.0), numbers(4.8e-6), numbers(20e-6, 20e-6), numbers(220e-6))
    found = rating(pair, asked, factors(), kisssoft(mean_stress=numbers(1.0, 0.7)), finish)
    for name, printed, within in (
        ("tangential_force", 731585.690, 10.0),
        ("radial_force", 390918.311, 20.0),
        ("zone_factor", 2.06, 5e-3),
        ("contact_ratio_factor", 0.981, 5e-4),
        ("nominal_contact_stress", 759.92e6, 1e5),
        ("single_contact_factor", [996.13 / 958.15, 1002.73 / 958.15], 2e-4),
        ("lubricant_factor", 1.020, 5e-4),
        ("velocity_factor", 0.961, 5e-4),
        ("roughness_factor", 1.024, 5e-4),
        ("flank_life_factor", [0.909, 0.937], 5e-4),
        ("form_factor", [1.56, 1.44], 5e-3),
        ("stress_correction_factor", [2.06, 2.14], 5e-3),
        ("bending_arm", [64.83e-3, 65.24e-3], 3e-5),
        ("load_angle", np.radians([30.75, 33.33]), 3e-4),
        ("root_chord", [101.18e-3, 104.13e-3], 1e-5),
        ("root_fillet_radius", [18.12e-3, 17.19e-3], 6e-6),
        ("nominal_root_stress", [113.46e6, 108.94e6], 1e5),
        ("root_size_factor", 0.8, 1e-9),
        ("notch_sensitivity_factor", [1.003, 1.005], 5e-4),
        ("root_life_factor", [0.888, 0.906], 5e-4),
        ("root_limit", [586.11e6, 419.35e6], 4e5),
    ):
        values = np.broadcast_to(found[name], 2)
        np.testing.assert_allclose(values, np.broadcast_to(printed, 2), atol=within, err_msg=name)


def test_a_helical_pinion_has_the_load_distribution_of_2019(base: CylindricalPair) -> None:
    """Normal section and Y_F of a pinion by the FVA Workbench after ISO 6336:2019, eps_beta above 1."""
    helix = radians(20.0)
    pair = with_circles(
        base,
        teeth=(25, 40),
        module=2e-3,
        tips=(57.209e-3, 89.134e-3),
        profile_shift=(-0.058384, -0.058384),
        helix_angle=helix,
        centre_distance=65.0 * 1e-3 / np.cos(helix),
        face_width=25e-3,
        fillet_radius=(0.25, 0.25),
    )
    found = rating(pair, duty(100.0, 3000.0), factors(), strengths())
    assert found["root_chord"][0] / 2e-3 == pytest.approx(2.031, abs=1e-3)
    assert found["root_fillet_radius"][0] / 2e-3 == pytest.approx(0.49, abs=5e-3)
    assert found["bending_arm"][0] / 2e-3 == pytest.approx(1.050, abs=1e-3)
    assert degrees(found["load_angle"][0]) == pytest.approx(18.539, abs=5e-3)
    assert found["form_factor"][0] == pytest.approx(1.181, abs=1e-3)
    assert float(found["helix_factor"]) == pytest.approx(1.032, abs=5e-4)
    np.testing.assert_allclose(found["single_contact_factor"], np.sqrt(1.2))
