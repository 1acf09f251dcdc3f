"""Heat by shear in the inlet: factors by hand, limits, and their place beside film and rolling laws."""

from dataclasses import replace

import numpy as np
import pytest
from bare_contacts import conditions

from pitchpoint import citations
from pitchpoint._jax import array, jax, jnp
from pitchpoint.lubrication.conditions import evaluate, law_arguments
from pitchpoint.lubrication.inlet_heating import (
    aihara_1987,
    murch_wilson_1975,
    wilson_sheu_1983,
    with_inlet_heating,
    zhu_cheng_1988,
)
from pitchpoint.lubrication.lubrication_registry import (
    FILM_THICKNESS,
    INLET_HEATING,
    ROLLING_RESISTANCE,
)

FACTORS = [murch_wilson_1975, wilson_sheu_1983, zhu_cheng_1988, aihara_1987]
AT = {"thermal_loading": 4.0, "slide_roll_ratio": 0.5, "pressure": 1e9, "modulus": 226.4e9}


ROLLING = {
    "speed": 600.0,
    "slip": np.full((1, 1), 2e-3),
    "roll": np.full((1, 1), 1e-2),
    "viscosity": 2.0,
    "pressure_viscosity": 2e-8,
    "viscosity_slope": 0.04,
    "conductivity": 0.14,
}
"""A contact that entrains at 3 m/s, with a thermal loading of 5.1."""


def value(factor, **changed):
    given = {**AT, **changed}
    asked, _ = law_arguments(factor)
    return factor(**{name: jnp.asarray(given[name], float) for name in asked})


def test_factors_by_hand():
    L = 4.0
    assert float(value(murch_wilson_1975)) == pytest.approx(1.0 / (1.0 + 0.254 * L**0.62))
    # The form in which Murch and Wilson are usually quoted.
    assert float(value(murch_wilson_1975)) == pytest.approx(3.94 / (3.94 + L**0.62), rel=1e-3)
    sliding = 1.0 + 14.8 * 0.25**0.83
    assert float(value(wilson_sheu_1983)) == pytest.approx(1.0 / (1.0 + 0.241 * sliding * L**0.64))
    pressed = 1.0 - 13.2 / 226.4 * L**0.42
    heat = 1.0 + 0.213 * (1.0 + 2.23 * 0.5**0.83) * L**0.64
    assert float(value(zhu_cheng_1988)) == pytest.approx(pressed / heat)
    assert float(value(aihara_1987)) == pytest.approx(1.0 / (1.0 + 0.29 * L**0.78))


@pytest.mark.parametrize("factor", FACTORS)
def test_factors_fall_from_one_with_finite_slopes(factor):
    loading = jnp.concatenate([jnp.zeros(1), jnp.logspace(-14.0, 4.0, 73)])
    given = {name: jnp.asarray(v) for name, v in AT.items() if name in law_arguments(factor)[0]}
    given["slide_roll_ratio"] = jnp.asarray(0.0)
    given = {name: v for name, v in given.items() if name in law_arguments(factor)[0]}

    def at(one):
        return factor(**{**given, "thermal_loading": one})

    found, slope = jax.vmap(jax.value_and_grad(at))(loading)
    assert float(found[0]) == 1.0
    assert (np.diff(found) <= 0.0).all() and (np.asarray(found) > 0.0).all()
    assert np.isfinite(slope).all()


def test_pure_rolling_factors_are_close_to_each_other():
    for loading in (0.1, 1.0, 10.0):
        factors = [
            float(value(factor, thermal_loading=loading, slide_roll_ratio=0.0, pressure=0.0))
            for factor in (murch_wilson_1975, wilson_sheu_1983, zhu_cheng_1988)
        ]
        assert max(factors) / min(factors) < 1.12


def test_a_law_is_multiplied_by_the_factor_of_its_effect():
    at = conditions("line", **ROLLING)
    loading = float(at.thermal_loading[0, 0])
    assert loading == pytest.approx(0.04 * 2.0 * 3.0**2 / 0.14, rel=1e-12)
    heating = INLET_HEATING["wilson_sheu_1983"]
    for law, factor in (
        (FILM_THICKNESS["dowson_1968"], wilson_sheu_1983),
        (ROLLING_RESISTANCE["wu_cheng_1991"], aihara_1987),
    ):
        hot = evaluate(with_inlet_heating(law, heating), at) / evaluate(law, at)
        sliding = float(at.slide_roll_ratio[0, 0])
        expected = value(factor, thermal_loading=loading, slide_roll_ratio=sliding)
        assert float(hot[0, 0]) == pytest.approx(float(expected), rel=1e-12)


def test_without_heat_a_law_is_itself_and_with_it_always_the_same():
    law = FILM_THICKNESS["dowson_1968"]
    assert with_inlet_heating(law, INLET_HEATING["none"]) is law
    heating = INLET_HEATING["zhu_cheng_1988"]
    assert with_inlet_heating(law, heating) is with_inlet_heating(law, heating)


def test_measured_resistances_level_off_with_speed_and_so_do_heated_ones():
    at = conditions("line", **ROLLING)
    law = ROLLING_RESISTANCE["wu_cheng_1991"]
    heated = with_inlet_heating(law, INLET_HEATING["murch_wilson_1975"])

    def rise(one):
        slow, fast = (
            evaluate(one, replace(at, speed=array(speed)))[0, 0] for speed in (600.0, 1200.0)
        )
        return float(fast / slow)

    assert rise(law) == pytest.approx(2.0**0.658, rel=1e-12)
    assert rise(heated) < 1.0


def test_sources_are_known():
    for heating in INLET_HEATING.values():
        assert {*heating.sources} <= {*citations.available()}
