"""Rheology under pressure: values worked out by hand, limits at ambient pressure, gradients, ranges."""

import math

import numpy as np
import pytest

from pitchpoint import citations
from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.materials import lubricants
from pitchpoint.materials.fluid import Fluid
from pitchpoint.materials.registry import DENSITY, LEAST_PRESSURE, SHEAR_STRESS, VISCOSITY
from pitchpoint.materials.rheology import bair_winer_1979, ree_eyring_1955, roelands_1966

OIL = {
    "viscosity": 0.04,
    "pressure_viscosity": 2.2e-8,
    "temperature": 313.15,
    "viscosity_slope": 0.037,
}
LAWS = [*VISCOSITY.values(), *DENSITY.values(), *SHEAR_STRESS.values()]
NAMES = [law.name for law in LAWS]


def arrays(given):
    return {name: jnp.asarray(value) for name, value in given.items()}


def logarithm(law, pressure, rise):
    return jnp.log(law.function(pressure=pressure, temperature_rise=rise, **arrays(OIL)))


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_value_worked_out_by_hand(law):
    given, expected = law.check
    assert float(law.function(**arrays(given))) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_sources_are_known_and_the_range_is_a_sentence(law):
    assert {*law.sources} <= {*citations.available()}
    assert law.range.endswith(".")


@pytest.mark.parametrize("law", VISCOSITY.values(), ids=VISCOSITY)
def test_viscosity_starts_at_the_value_and_the_slopes_of_the_oil(law):
    at = jnp.asarray(0.0)
    assert float(jnp.exp(logarithm(law, at, at))) == pytest.approx(0.04, rel=1e-15)
    by_pressure, by_heat = jax.grad(lambda p, t: logarithm(law, p, t), (0, 1))(at, at)
    assert float(by_pressure) == pytest.approx(2.2e-8, rel=1e-13)
    assert float(by_heat) == pytest.approx(-0.037, rel=1e-13)


def test_roelands_as_printed_with_its_bracket():
    eta0, alpha, T0, slope = 0.04, 2.2e-8, 313.15, 0.037
    Z = alpha / (5.1e-9 * (math.log(eta0) + 9.67))
    S0 = slope * (T0 - 138.0) / (math.log(eta0) + 9.67)
    for p, dT in ((0.3e9, 0.0), (0.9e9, 15.0), (0.0, 40.0)):
        power = (1.0 + 5.1e-9 * p) ** Z * ((T0 + dT - 138.0) / (T0 - 138.0)) ** -S0
        expected = eta0 * math.exp((math.log(eta0) + 9.67) * (power - 1.0))
        found = roelands_1966(**arrays({"pressure": p, "temperature_rise": dT, **OIL}))
        # 5.1e-9 rounds 1/1.96e8 by 0.04 %.
        assert float(found) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("law", [*VISCOSITY.values(), *DENSITY.values()], ids=lambda law: law.name)
def test_laws_are_finite_and_monotone_at_every_pressure(law):
    own = OIL if law.name in VISCOSITY else {}
    pressure = jnp.concatenate([jnp.linspace(-3e9, 0.0, 31), jnp.linspace(1e7, 4e9, 41)])
    value, slope = jax.vmap(
        jax.value_and_grad(
            lambda p: law.function(pressure=p, temperature_rise=jnp.asarray(0.0), **arrays(own))
        )
    )(pressure)
    assert np.isfinite(value).all() and np.isfinite(slope).all()
    assert (np.asarray(value) > 0.0).all() and (np.diff(value) >= 0.0).all()
    assert (np.asarray(slope)[np.asarray(pressure) < LEAST_PRESSURE] == 0.0).all()


@pytest.mark.parametrize("law", SHEAR_STRESS.values(), ids=SHEAR_STRESS)
def test_shear_stress_is_newtonian_at_first_and_odd(law):
    at = {"viscosity": jnp.asarray(0.02), "pressure": jnp.asarray(0.0)}
    slope = jax.grad(lambda rate: law.function(shear_rate=rate, **at))(jnp.asarray(0.0))
    assert float(slope) == pytest.approx(0.02, rel=1e-14)
    here, there = (law.function(shear_rate=jnp.asarray(r), **at) for r in (1e8, -1e8))
    assert float(here) == -float(there) > 0.0


def test_shear_stress_of_hard_sheared_oils():
    hard = arrays({"viscosity": 1e5, "shear_rate": -1e8, "pressure": 1e9})
    assert float(bair_winer_1979(**hard)) == -(2e6 + 0.08e9)
    # asinh x is the logarithm of 2 x for large x.
    assert float(ree_eyring_1955(**hard)) == pytest.approx(-5e6 * math.log(2.0 * 1e13 / 5e6))
    slopes = jax.grad(lambda given: bair_winer_1979(**given))(hard)
    assert all(np.isfinite(slope) for slope in slopes.values())


def test_slope_of_the_viscosity_against_differences():
    oil = lubricants.find("pao-vg-100").build()
    T = np.array([300.0, 330.0, 370.0])
    ahead, behind = (np.log(np.asarray(oil.viscosity(T + step))) for step in (1e-3, -1e-3))
    assert np.asarray(oil.viscosity_slope(T)) == pytest.approx((behind - ahead) / 2e-3, rel=1e-8)


def test_an_oil_of_the_catalogue_under_pressure():
    oil = lubricants.find("mineral-vg-100").build()
    T = np.array([313.15, 353.15])
    fluid = Fluid.of(oil, T, shear_law="ree_eyring_1955", shear_parameters={"eyring_stress": 7e6})
    assert np.asarray(fluid.viscosity_at(0.0)) == pytest.approx(
        np.asarray(oil.viscosity(T)), rel=1e-15
    )
    assert np.asarray(fluid.density) == pytest.approx(np.asarray(oil.density(T)), rel=1e-15)
    stress = np.asarray(fluid.shear_stress(1e6, 0.8e9, 5.0))
    drawn = np.asarray(fluid.viscosity_at(0.8e9, 5.0)) * 1e6
    assert stress == pytest.approx(7e6 * np.arcsinh(drawn / 7e6), rel=1e-13)
    assert float(fluid.density_ratio(0.0)) == 1.0


def test_heat_under_ambient_pressure_follows_the_oil():
    oil = lubricants.find("mineral-vg-100").build()
    fluid = Fluid.of(oil, 333.15)
    for rise in (-10.0, 10.0, 20.0):
        expected = float(oil.viscosity(333.15 + rise))
        assert float(fluid.viscosity_at(0.0, rise)) == pytest.approx(expected, rel=0.03)


def test_beyond_its_range_a_law_says_so():
    fluid = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8)
    assert fluid.outside(0.9e9) is None
    told = "a pressure of 1.6 GPa is outside the range of 'roelands_1966', up to 1 GPa"
    assert fluid.outside(np.array([0.1e9, 1.6e9])) == told
    steep = Fluid(viscosity=0.04, pressure_viscosity=4e-8)
    assert steep.outside(0.1e9) == (
        "a pressure-viscosity index Z of 1.22 is outside the range of 'roelands_1966', 0 to 1"
    )
    barus = Fluid(viscosity=0.04, pressure_viscosity=2.2e-8, viscosity_law="barus_1893")
    assert barus.outside(0.9e9).endswith("'barus_1893', up to 0.5 GPa")


def test_a_wrong_name_is_told_with_its_neighbours():
    oil = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8}
    with pytest.raises(InputError, match="did you mean roelands_1966"):
        Fluid(**oil, viscosity_law="roelands")
    with pytest.raises(InputError, match="'eyring' is no parameter of 'ree_eyring_1955'; did you"):
        Fluid(**oil, shear_law="ree_eyring_1955", shear_parameters={"eyring": 4e6})
