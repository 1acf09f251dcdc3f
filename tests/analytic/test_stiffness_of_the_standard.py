"""Stiffness of pairs as ISO 6336-1 estimates it."""

import numpy as np
import pytest
from standard_pairs import PAIRS, number, standard_stiffness, virtual

from pitchpoint import units
from pitchpoint._jax import jnp
from pitchpoint.loading import iso_6336_stiffness as iso


def test_standard_of_a_wind_turbine_stage():
    """24/95 teeth as a commercial program prints them for ISO 6336:2006 B."""
    blank = iso.blank_factor(web_ratio=number(0.25), rim_thickness_ratio=number(5.0))
    assert float(blank) == pytest.approx(0.898, abs=5e-4)
    found = standard_stiffness((24, 95), 10.0, (0.48, 0.6691), (206e9, 206e9), 1.463, blank=0.898)
    assert found == pytest.approx([13.832, 18.632, 15.837], rel=5e-4)
    assert virtual((24, 95), 10.0) == pytest.approx([25.037, 99.104], abs=1e-3)


def test_standard_of_the_worked_example():
    """ISO/TR 6336-30:2017, example 1: 17/103 teeth, dedendum of 1.4 modules."""
    found = standard_stiffness((17, 103), 15.8, (0.145, 0.0), (206e9, 206e9), dedendum=1.4)
    assert found[0] == pytest.approx(12.3705, abs=1e-4)
    theory = 1e-9 / iso.pair_compliance(
        virtual_teeth=jnp.asarray(virtual((17, 103), 15.8)), profile_shift=jnp.asarray([0.145, 0.0])
    )
    assert float(theory) == pytest.approx(17.8558, abs=1e-4)


@pytest.mark.parametrize(
    ("name", "ratio", "single", "mesh", "low"),
    [
        ("GP1", 0.8880, 0.387, 5.67, 3.04),
        ("GP2", 0.8253, 0.398, 5.54, 2.97),
        ("GP3", 1.0786, 0.420, 7.11, 3.81),
        ("GP4", 0.9366, 0.441, 6.71, 3.60),
    ],
)
def test_standard_of_the_steel_and_plastic_pairs(name, ratio, single, mesh, low):
    z1, z2, _, x1, x2, *_ = PAIRS[name]
    young = (207e9, 3.54e9)
    full, alpha, _ = standard_stiffness((z1, z2), 20.0, (x1, x2), young, ratio)
    assert full == pytest.approx(single, abs=6e-4)
    assert 16.0 * alpha == pytest.approx(mesh, abs=6e-3)
    little = standard_stiffness((z1, z2), 20.0, (x1, x2), young, ratio, load=8.2e3)[1]
    assert 16.0 * little == pytest.approx(low, abs=1e-2)


def test_standard_says_where_it_does_not_hold():
    inside = {
        "virtual_teeth": (25.0, 99.0),
        "profile_shift": (0.5, 0.4),
        "helix_angle": np.deg2rad(10.0),
        "contact_ratio": 1.46,
    }
    assert iso.range_warnings(**inside) == ()
    assert iso.range_warnings(**{**inside, "helix_angle": units.parse("30 deg", "angle")}) == ()
    outside = {
        "virtual_teeth": ((4.75, 60.5), "4.75 virtual teeth"),
        "profile_shift": ((0.4, 0.5), "x1 >= x2"),
        "helix_angle": (np.deg2rad(35.0), "helix angle of 35 deg"),
        "contact_ratio": (0.888, "contact ratio of 0.888"),
        "internal": (True, "external gears only"),
    }
    for key, (value, words) in outside.items():
        (sentence,) = iso.range_warnings(**{**inside, key: value})
        assert words in sentence
    (sentence,) = iso.range_warnings(**{**inside, "profile_shift": (1.5, 0.9)})
    assert "sum of profile shifts of 2.4" in sentence
