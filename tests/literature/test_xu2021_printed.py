"""Xu et al. (2021): load, curvature, speed and materials by the formulas as printed and as corrected."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from xu2021_in_print import END, NAME, OIL, RADII, TREE, VARIANTS, case, curvature, mapped, speed

from pitchpoint.cases.document import leaves, resolve
from pitchpoint.citations import citation_text
from pitchpoint.materials.solids import Solid, reduced_modulus
from pitchpoint.published.xu2021.printed import (
    density,
    effective_modulus,
    largest_force,
    loaded_count,
    printed_count,
    printed_density,
    printed_viscosity,
    relative_radius,
    roelands_exponents,
    viscosity,
    zone_tooth_forces,
)

LOAD = {"torque": 400.0, "base_radius": RADII[1], "teeth": 202.0}


# ------------------------------------------------------------------ load


def test_printed_number_of_teeth_leaves_the_zone_of_positive_load():
    assert (printed_count(teeth=202), loaded_count(teeth=202)) == (20, 12)
    within = zone_tooth_forces(largest=1.0, teeth=202, count=12)
    beyond = zone_tooth_forces(largest=1.0, teeth=202, count=13)
    assert within.shape == (25,)
    assert within.min() > 0.0 > beyond.min()
    assert loaded_count(teeth=208) == 12, "a tooth on the end of the zone carries nothing"


def test_printed_force_pulls_on_the_outermost_teeth():
    largest = largest_force(count=20, **LOAD)
    forces = zone_tooth_forces(largest=largest, teeth=202, count=20)
    assert largest == pytest.approx(940.5, abs=0.05)
    assert forces.min() == pytest.approx(-747.0, abs=0.5)
    assert (forces < 0.0).sum() == 16


def test_two_zones_close_the_torque():
    one, two = (largest_force(count=12, zones=zones, **LOAD) for zones in (1, 2))
    assert one == pytest.approx(524.1, abs=0.05)
    assert two == pytest.approx(262.0, abs=0.05)
    forces = zone_tooth_forces(largest=two, teeth=202, count=12)
    assert 2.0 * RADII[1] * forces.sum() == pytest.approx(400.0, rel=1e-12)


def test_sum_over_the_teeth_is_near_the_integral_over_the_zone():
    """With many teeth: one tooth per pitch 2 pi/z."""
    area, _ = quad(lambda p: np.cos(4.0 * p), -END, END)
    for teeth, near in ((202, 3e-3), (2002, 3e-5)):
        force = largest_force(torque=400.0, base_radius=1.0, teeth=teeth, count=teeth // 16)
        assert force * area * teeth / (2.0 * np.pi) == pytest.approx(400.0, rel=near)


def test_base_radii():
    np.testing.assert_allclose(np.array(RADII) * 1e3, [46.985, 47.454], atol=5e-4)


def test_relative_radius_is_metres_and_changes_its_sign():
    radius = relative_radius(**dict(zip(("first", "second"), curvature([0.0, END]), strict=True)))
    assert radius[0] == pytest.approx(1.5, abs=0.05)
    assert radius[1] < 0.0
    first, second = curvature(np.deg2rad(10.0))
    assert relative_radius(first=first, second=second) == pytest.approx(3.5, abs=0.05)
    agree = brentq(lambda p: np.subtract(*curvature(p)), 0.0, END)
    assert 10.0 < np.rad2deg(agree) < 15.0


def test_relative_radius_is_that_of_a_concave_and_a_convex_circle():
    """Second derivative of the gap between arcs of 10 and 12 mm that touch from inside."""
    x = 1e-4
    gap = (10e-3 - np.sqrt(10e-3**2 - x**2)) - (12e-3 - np.sqrt(12e-3**2 - x**2))
    assert relative_radius(first=10e-3, second=12e-3) == pytest.approx(x**2 / (2 * gap), rel=1e-3)


@pytest.mark.parametrize(("sense", "ends"), [(-1, (0.0, 0.23)), (1, (0.10, 0.31))])
def test_speed_of_the_mesh_point(sense, ends):
    angle = np.linspace(0.0, END, 46)
    found = speed(angle, sense)
    np.testing.assert_allclose(found[[0, -1]], ends, atol=0.005)
    assert np.all(np.diff(found) > 0.0)


def test_added_speed_is_that_of_a_moving_point():
    """Positions of a point of the oval ring a moment apart, along the flank direction."""
    p, h, wave = 0.2, 1e-7, 100.0 * np.pi
    distance = mapped(p)

    def place(time):
        # The carried point moves back by the pitch it gains on the wave, which passes it.
        phase = p + wave * (1.0 + 0.01) * time
        w, v = 0.5e-3 * np.cos(2 * phase), -0.25e-3 * np.sin(2 * phase)
        return (distance + w) * np.exp(1j * (v / (distance + w) - 0.01 * wave * time))

    velocity = (place(h) - place(-h)) / (2 * h) / (place(0.0) / abs(place(0.0)))
    cosine = RADII[0] / distance
    along = -velocity.real * cosine - velocity.imag * np.sqrt(1 - cosine**2)
    assert along == pytest.approx(speed(p, 1), rel=3e-3)


# ------------------------------------------------------------------ materials


def test_equivalent_modulus_is_that_of_eq_11():
    solids = [Solid(young=e, poisson=0.3, density=7830.0) for e in (201e9, 206e9)]
    found = effective_modulus(young=(201e9, 206e9), poisson=(0.3, 0.3))
    assert found == pytest.approx(2.2359e11, abs=5e6)
    assert found == pytest.approx(float(reduced_modulus(*solids)), rel=1e-12)


def test_exponents_of_the_viscosity():
    z, s = roelands_exponents(**OIL)
    assert z == pytest.approx(0.6687, abs=5e-5)
    assert s == pytest.approx(1.2912, abs=5e-5)


def test_viscosity_against_temperature():
    found = viscosity(temperature=np.array([293.0, 303.0, 313.0, 333.0, 353.0]), **OIL) * 1e3
    np.testing.assert_allclose(found, [119.5, 66.6, 40.0, 17.2, 8.9], atol=0.05)
    assert viscosity(temperature=313.0, **OIL) == pytest.approx(0.04, rel=1e-14)


def test_viscosity_has_the_slopes_of_table_2():
    def log(temperature=313.0, pressure=0.0):
        return np.log(viscosity(temperature=temperature, pressure=pressure, **OIL))

    by_pressure = (log(pressure=1e4) - log(pressure=-1e4)) / 2e4
    by_temperature = (log(temperature=313.01) - log(temperature=312.99)) / 0.02
    assert by_pressure == pytest.approx(OIL["alpha"], rel=1e-6)
    assert by_temperature == pytest.approx(-OIL["beta"], rel=1e-6)


def test_printed_viscosity_is_233_times_too_high():
    ratio = printed_viscosity(temperature=313.0, **OIL) / viscosity(temperature=313.0, **OIL)
    assert ratio == pytest.approx(233.0, abs=0.5)
    assert printed_viscosity(temperature=313.0, **OIL) == pytest.approx(9.3, abs=0.05)


def test_printed_density_does_not_know_the_temperature():
    given = {"temperature": 353.0, "density_0": 870.0, "temperature_0": 313.0}
    assert density(**given) == pytest.approx(870.0 * 0.972)
    assert printed_density(**given) == pytest.approx(870.0, abs=0.03)
    cold = {**given, "temperature": 313.0, "pressure": 1e9}
    assert density(**cold) == pytest.approx(870.0 * (1.0 + 0.6 / 2.7))
    assert printed_density(**cold) == density(**cold)


def test_thresholds_in_temperature_contradict_each_other():
    """Section 3.2 needs 8.33 between 30 and 60 degC at speeds of 300 and 2500 rpm."""
    warm = [float(viscosity(temperature=value, **OIL)) for value in (303.0, 333.0)]
    assert warm[0] / warm[1] == pytest.approx(3.86, abs=0.005)
    assert warm[0] / warm[1] < 0.5 * 2500.0 / 300.0


# ------------------------------------------------------------------ the file


@pytest.mark.parametrize("variant", [*VARIANTS])
def test_inputs_carry_their_marks(variant):
    document = resolve(dict(TREE), name=NAME, variant=variant)
    values = {
        key
        for table in ("gears", "materials", "lubricant", "roughness", "operation", "models")
        for key, _ in leaves({table: document.tree[table]})
    }
    unmarked = values - document.provenance.keys() - {"gears.family"}
    assert {key for key in unmarked if not key.startswith("models.friction")} == set()
    assert "Xu" in citation_text(TREE["source"])


@pytest.mark.whole
def test_errors_of_the_paper_are_issues_of_the_case():
    found = case().issues
    assert all(one.verdict for one in found)
    assert {one.where for one in found} >= {"eq. 1", "eq. 3", "eq. 6", "eq. 12", "eq. 13"}
    counted = [one for one in found if one.where == "eq. 6"]
    assert len(counted) == 3
    assert "940.5" in counted[0].verdict
