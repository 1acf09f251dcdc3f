"""Rheology under pressure: values worked out by hand, limits at ambient pressure, gradients, ranges."""

import math
from dataclasses import replace

import numpy as np
import pytest

from pitchpoint import citations
from pitchpoint._jax import jax, jnp
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.doubts import of_volume
from pitchpoint.materials import lubricants
from pitchpoint.materials.fluid import Fluid
from pitchpoint.materials.materials_registry import DENSITY, LEAST_PRESSURE, SHEAR_STRESS, VISCOSITY
from pitchpoint.materials.rheology import (
    bair_2015,
    bair_winer_1979,
    carreau_1972,
    limiting_shear_stress,
    ree_eyring_1955,
    roelands_1966,
)

OIL = {
    "viscosity": 0.04,
    "pressure_viscosity": 2.2e-8,
    "temperature": 313.15,
    "viscosity_slope": 0.037,
}
PLAIN = {"viscosity": 0.04, "pressure_viscosity": 2.2e-8}
LAWS = [*VISCOSITY.values(), *DENSITY.values(), *SHEAR_STRESS.values()]
NAMES = [law.name for law in LAWS]


def arrays(given):
    return {name: jnp.asarray(value) for name, value in given.items()}


@jax.jit
def _viscosity(fluid, pressure, rise):
    return fluid.viscosity_at(pressure, rise)


@jax.jit
def _density(fluid, pressure, rise):
    return fluid.density_ratio(pressure, rise)


def viscosity_of(fluid, pressure, rise=0.0):
    return np.asarray(_viscosity(fluid, pressure, rise))


def density_of(fluid, pressure, rise=0.0):
    return np.asarray(_density(fluid, pressure, rise))


def value_of(function, **given):
    """Value of a law by one program."""
    return np.asarray(jax.jit(function)(**arrays(given)))


def logarithm(law, pressure, rise):
    return jnp.log(law.function(pressure=pressure, temperature_rise=rise, **arrays(OIL)))


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_value_worked_out_by_hand(law):
    given, expected = law.check
    assert float(value_of(law.function, **given)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=NAMES)
def test_sources_are_known_and_the_range_is_a_sentence(law):
    assert {*law.sources} <= {*citations.available()}
    assert law.range.endswith(".")


@pytest.mark.parametrize("law", VISCOSITY.values(), ids=VISCOSITY)
def test_viscosity_starts_at_the_value_and_the_slopes_of_the_oil(law):
    at = jnp.asarray(0.0)
    start, (by_pressure, by_heat) = jax.jit(
        jax.value_and_grad(lambda p, t: logarithm(law, p, t), (0, 1))
    )(at, at)
    assert math.exp(float(start)) == pytest.approx(0.04, rel=1e-15)
    assert float(by_pressure) == pytest.approx(2.2e-8, rel=1e-13)
    assert float(by_heat) == pytest.approx(-0.037, rel=1e-13)


def test_roelands_as_printed_with_its_bracket():
    eta0, alpha, T0, slope = 0.04, 2.2e-8, 313.15, 0.037
    Z = alpha / (5.1e-9 * (math.log(eta0) + 9.67))
    S0 = slope * (T0 - 138.0) / (math.log(eta0) + 9.67)
    for p, dT in ((0.3e9, 0.0), (0.9e9, 15.0), (0.0, 40.0)):
        power = (1.0 + 5.1e-9 * p) ** Z * ((T0 + dT - 138.0) / (T0 - 138.0)) ** -S0
        expected = eta0 * math.exp((math.log(eta0) + 9.67) * (power - 1.0))
        found = value_of(roelands_1966, pressure=p, temperature_rise=dT, **OIL)
        # 5.1e-9 rounds 1/1.96e8 by 0.04 %.
        assert float(found) == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("law", [*VISCOSITY.values(), *DENSITY.values()], ids=lambda law: law.name)
def test_laws_are_finite_and_monotone_at_every_pressure(law):
    own = OIL if law.name in VISCOSITY else {}
    pressure = np.concatenate([np.linspace(-3e9, 0.0, 31), np.linspace(1e7, 4e9, 41)])
    alone = lambda p: law.function(pressure=p, temperature_rise=jnp.asarray(0.0), **arrays(own))  # noqa: E731
    value, slope = jax.jit(jax.vmap(jax.value_and_grad(alone)))(pressure)
    assert np.isfinite(value).all() and np.isfinite(slope).all()
    assert (np.asarray(value) > 0.0).all() and (np.diff(value) >= 0.0).all()
    assert (np.asarray(slope)[np.asarray(pressure) < LEAST_PRESSURE] == 0.0).all()


@pytest.mark.parametrize("law", SHEAR_STRESS.values(), ids=SHEAR_STRESS)
def test_shear_stress_is_newtonian_at_first_and_odd(law):
    at = arrays({"viscosity": 0.02, "pressure": 0.0, "temperature_rise": 0.0})
    slope = jax.jit(jax.grad(lambda rate: law.function(shear_rate=rate, **at)))(jnp.asarray(0.0))
    assert float(slope) == pytest.approx(0.02, rel=1e-14)
    here, there = (value_of(law.function, shear_rate=r, **at) for r in (1e8, -1e8))
    assert float(here) == -float(there) > 0.0


def test_shear_stress_of_hard_sheared_oils():
    hard = {"viscosity": 1e5, "shear_rate": -1e8, "pressure": 1e9, "temperature_rise": 0.0}
    for law in (bair_winer_1979, carreau_1972):
        assert float(value_of(law, **hard)) == -(2e6 + 0.08e9)
    # asinh x is the logarithm of 2 x for large x.
    assert float(value_of(ree_eyring_1955, **hard)) == pytest.approx(
        -5e6 * math.log(2.0 * 1e13 / 5e6)
    )
    slopes = jax.jit(jax.grad(lambda given: bair_winer_1979(**given)))(arrays(hard))
    assert all(np.isfinite(slope) for slope in slopes.values())


def test_carreau_thins_by_its_power_up_to_the_limiting_stress():
    at = {"viscosity": 50.0, "shear_rate": 1e6, "pressure": 1e9, "temperature_rise": 0.0}
    drawn = 50e6
    expected = drawn * math.sqrt(1.0 + (drawn / 6e6) ** 2) ** (0.4 - 1.0)
    found = value_of(carreau_1972, **at, critical_stress=6e6, shear_exponent=0.4)
    assert float(found) == pytest.approx(expected, rel=1e-13)
    straight = value_of(carreau_1972, **at, critical_stress=6e6, shear_exponent=1.0)
    assert float(straight) == pytest.approx(drawn, rel=1e-15)


def test_limiting_stress_of_shell_t9_and_its_fall_with_temperature():
    # 0.083 p for Shell T9 at every temperature (Habchi 2018, page 427).
    at = {"pressure": np.array([-1e7, 0.8e9]), "temperature_rise": np.array([0.0, 30.0])}
    same = value_of(limiting_shear_stress, **at, coefficient=0.083, stress=0.0, fall=0.0)
    assert same == pytest.approx([0.0, 66.4e6], rel=1e-15)
    falls = value_of(limiting_shear_stress, **at, coefficient=0.08, stress=2e6, fall=0.01)
    assert falls == pytest.approx([2e6, 66e6 * math.exp(-0.3)], rel=1e-15)


def yasutomi(pressure, temperature):
    """Viscosity of the gear oil of Bair (2019), page 167, by another correlation: that of Yasutomi, improved.

    Pressure in GPa, temperature in K, result in Pa s.
    """
    above_glass = temperature - (201.45 + 210.6 * np.log1p(0.455 * pressure))
    widened = above_glass * (1.0 + 7.606 * pressure) ** -0.4193
    return 1e12 * 10.0 ** (-16.372 * widened / (29.99 + widened))


@pytest.mark.parametrize(
    ("inlet", "rise", "factor"), [(333.15, 0.0, 1.17), (333.15, 40.0, 1.26), (353.15, 0.0, 1.08)]
)
def test_a_gear_oil_of_two_published_correlations(inlet, rise, factor):
    """The second one is over Roelands' law by 4 and below it by 2 where these two agree."""
    pressure = np.array([0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
    oil = lubricants.find("sae-80w-90").build()
    fluid = Fluid.of(oil, inlet, viscosity_law="doolittle_1951", density_law="tait_1888")
    off = viscosity_of(fluid, pressure * 1e9, rise) / yasutomi(pressure, inlet + rise)
    assert off.max() < factor and off.min() > 1.0 / factor
    assert off[0] == pytest.approx(1.0, abs=0.13)
    assert off.max() / off.min() < 1.5
    assert np.ptp(np.log(yasutomi(pressure, inlet + rise))) > 11.0


def test_free_volume_as_printed_and_as_an_oil_carries_it():
    """Doolittle's equation with the constants of the book, against the law at another temperature."""
    B, R0, e, a = 4.336, 0.6988, -7.679e-4, 7.187e-4

    def logarithm_of(p, T):
        K = 7.232e9 * math.exp(-4.873e-3 * T)
        volume = (1.0 - math.log1p(11.65 * p / K) / 11.65) * (1.0 + a * (T - 323.0))
        occupied = R0 * (1.0 + e * (T - 323.0))
        return B * occupied / (volume - occupied)

    oil = lubricants.find("sae-80w-90").build()
    fluid = Fluid.of(oil, 353.15, viscosity_law="doolittle_1951", density_law="tait_1888")
    risen = [logarithm_of(p, 353.15) - logarithm_of(0.0, 353.15) for p in (0.3e9, 1e9)]
    found = np.log(viscosity_of(fluid, np.array([0.3e9, 1e9])) / float(fluid.viscosity))
    assert found == pytest.approx(risen, rel=1e-12)
    slope = (logarithm_of(1e4, 353.15) - logarithm_of(0.0, 353.15)) / 1e4
    assert float(oil.pressure_viscosity(353.15)) == pytest.approx(slope, rel=1e-4)
    with pytest.raises(InputError, match="'volume' is no parameter of 'roelands_1966' or 'tait"):
        Fluid(**PLAIN, density_law="tait_1888", pressure_parameters={"volume": 1.0})


GEAR_OIL = {"viscosity_law": "bair_2015", "density_law": "tait_1888"}


def test_the_hybrid_of_mcewen_and_paluch_as_one_gear_oil_has_it():
    """Its constants are fitted to the other correlation at 60 degC, and elsewhere as far off as is said."""
    pressure = np.array([0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0])
    oil = lubricants.find("sae-80w-90").build()

    def off(inlet):
        risen = yasutomi(pressure, inlet) / yasutomi(0.0, inlet)
        fluid = Fluid.of(oil, inlet, **GEAR_OIL)
        return viscosity_of(fluid, pressure * 1e9) / float(fluid.viscosity) / risen

    assert off(333.15) == pytest.approx(np.ones(7), abs=0.02)
    at_half = [np.interp(0.5, pressure, off(inlet)) for inlet in (323.15, 353.15)]
    assert at_half == pytest.approx([0.66, 1.96], abs=0.02)


def test_mcewen_alone_is_a_power_and_constants_as_printed_are_those_of_both_terms():
    a, q, c, p1, p = 14e-9, 4.0, 30.0, 4e9, 0.7e9
    alpha = a + c / p1
    oil = {**OIL, "pressure_viscosity": alpha, "pressure": p, "temperature_rise": 0.0}
    both = {"mcewen_exponent": q, "paluch_share": c / (alpha * p1), "divergence_pressure": p1}
    expected = 0.04 * (1.0 + a * p / q) ** q * math.exp(c * p / (p1 - p))
    assert float(value_of(bair_2015, **oil, **both)) == pytest.approx(expected, rel=1e-12)
    # Mineral oil 23D as the Encyclopedia of Tribology (2013) has it, by Paluch's factor with its viscosity.
    C, p1, least = 27.5, 2.73e9, 2.78e-14
    known = {"viscosity": least * math.exp(C), "pressure_viscosity": C / p1}
    paluch = {"paluch_share": 1.0, "divergence_pressure": p1}
    found = float(value_of(bair_2015, **{**oil, **known}, **paluch))
    assert found == pytest.approx(least * math.exp(C * p1 / (p1 - p)), rel=1e-12)
    assert known["viscosity"] == pytest.approx(0.0244, abs=5e-5)
    alone = value_of(bair_2015, **oil, mcewen_exponent=q, paluch_share=0.0)
    assert float(alone) == pytest.approx(0.04 * (1.0 + alpha * p / q) ** q, rel=1e-12)


def test_constants_of_the_hybrid_are_said_to_be_assumed_unless_they_are_given():
    oil = lubricants.find("sae-80w-90").build()
    assert Fluid.of(oil, 333.15, **GEAR_OIL).assumed == (
        "how the viscosity of this oil rises under pressure is not known: 'bair_2015' takes constants of one "
        "gear oil at 60 degC"
    )
    given = {"mcewen_exponent": 4.0, "paluch_share": 0.3, "divergence_pressure": 4e9}
    assert Fluid.of(oil, 333.15, **GEAR_OIL, viscosity_parameters=given).assumed is None
    with pytest.raises(InputError, match="is no parameter of 'roelands_1966' or 'dowson"):
        Fluid.of(oil, 333.15, viscosity_parameters=given)


def test_squalane_scales_as_it_was_measured():
    """Its viscosity is one function of T V^4.16 between 0 and 80 degC up to 0.38 GPa (Harris 2009)."""
    record, pressure = lubricants.find("squalane"), np.linspace(0.0, 0.38e9, 39)
    oil, known = record.build(), {key: one.value for key, one in record.free_volume.items()}
    fluid = Fluid.of(oil, 313.15, viscosity_law="doolittle_1951", density_law="tait_1888")
    modulus = known["modulus_cold"] * math.exp(-known["modulus_slope"] * 313.15)
    slope = fluid.pressure_viscosity * modulus * (known["expansion"] - known["occupied_expansion"])
    fluid = replace(fluid, viscosity_slope=slope)
    cool, hot = (np.log(viscosity_of(fluid, pressure, rise)) for rise in (0.0, 40.0))
    volumes = [1.0 / density_of(fluid, pressure, rise) for rise in (0.0, 40.0)]

    def apart(power):
        at_40, at_80 = (
            np.log(T * V**power) for T, V in zip((313.15, 353.15), volumes, strict=True)
        )
        both = at_80 < at_40[0]
        assert both.sum() > 25
        return np.abs(np.interp(-at_80, -at_40, cool) - hot)[both].max()

    assert apart(4.16) < 0.03
    assert min(apart(3.7), apart(4.6)) > 0.12


def test_a_coefficient_of_ones_own_does_away_with_the_free_volume():
    record = lubricants.find("sae-80w-90")
    s, t = lubricants.constant_alpha(18e-9)
    plain = record.with_values(gold_s=s, gold_t=t)
    assert float(plain.build().pressure_viscosity(353.15)) == pytest.approx(18e-9, rel=1e-14)
    assert "occupied_volume" in record.data() and "occupied_volume" not in plain.data()
    assert record.thickened(consistency="2").free_volume == record.free_volume
    laws = {"viscosity_law": "doolittle_1951", "density_law": "tait_1888"}
    assert Fluid.of(record.build(), 333.15, **laws).assumed is None
    assert Fluid.of(plain.build(), 333.15).assumed is None
    (told,) = of_volume(Fluid.of(plain.build(), 333.15, **laws))
    assert told.startswith(
        "the volume of this oil is not known: 'doolittle_1951' and 'tait_1888' t"
    )


@pytest.mark.whole
def test_slope_of_the_viscosity_against_differences():
    oil = lubricants.find("pao-vg-100").build()
    T = np.array([300.0, 330.0, 370.0])
    ahead, behind = (np.log(np.asarray(oil.viscosity(T + step))) for step in (1e-3, -1e-3))
    assert np.asarray(oil.viscosity_slope(T)) == pytest.approx((behind - ahead) / 2e-3, rel=1e-8)


@pytest.mark.whole
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
