"""Wear laws, defects of adsorbed films and the mean wear of VDI 2736: values by hand, limits, gradients."""

import inspect
import math
from itertools import pairwise

import numpy as np
import pytest
from vdi_2736_wear import flank_length, mean_wear_depth

from pitchpoint import citations
from pitchpoint._jax import array, jax
from pitchpoint.errors import InputError
from pitchpoint.lubrication.conditions import demand_shape, shape_of
from pitchpoint.sizing.three_k import mesh_efficiency
from pitchpoint.units import parse
from pitchpoint.wear.film_defect import fractional_film_defect
from pitchpoint.wear.laws import UNITS
from pitchpoint.wear.wear_registry import WEAR_LAWS
from pitchpoint.wear.wear_stages import run_in_end, severe_start

GAS = 8.31446261815324
HARDNESS = 200.0 * 9.80665e6
ROLLERS = {
    "line_load": 1e5,
    "radius": 0.01,
    "modulus": 226e9,
    "pressure_viscosity": 2e-8,
    "ra_1": 4e-7,
    "ra_2": 3e-7,
}
GIVEN = {
    "archard_1953": {"coefficient": 8.5e-6, "hardness": HARDNESS},
    "masjedi_khonsari_2015": {
        "coefficient": 8.5e-6,
        "hardness": HARDNESS,
        "asperity_share": 0.4,
        "film_defect": 2.5e-3,
    },
    "janakiraman_2013": ROLLERS,
    "vdi_2736": {"rate": 1.03e-15},
}


BARE = {
    "sliding": 0.07,
    "temperature": 313.0,
    "adsorption_heat": 36.9e3,
    "molecule_diameter": 3e-10,
    "vibration_period": 3e-12,
}
FUNCTIONS = {name: law.function for name, law in WEAR_LAWS.items()}
FUNCTIONS |= {"film_defect": fractional_film_defect}
FUNCTIONS |= {one.__name__: one for one in (flank_length, mean_wear_depth)}
VALUE = {name: jax.jit(function) for name, function in FUNCTIONS.items()}
SLOPE = {
    name: jax.jit(jax.grad(lambda given, function=function: function(**given)))
    for name, function in FUNCTIONS.items()
}


def arrays(given):
    return {name: array(value, float) for name, value in given.items()}


def value(name, **given):
    return np.asarray(VALUE[name](**arrays(given)))


def rate(law, **changed):
    return value(law, **{**GIVEN[law], **changed})


def loss_factor(teeth, parts):
    """H_V of spur gears: what is lost under a coefficient of one."""
    pairs = [tuple(np.asarray(one, float) for one in both) for both in (teeth, parts)]
    return 1.0 - mesh_efficiency(*pairs, 1.0)


def bare(**changed):
    return value("film_defect", **{**BARE, **changed})


def test_archard_by_hand():
    assert float(rate("archard_1953")) == pytest.approx(4.3337e-15, rel=1e-4)
    assert float(rate("archard_1953", hardness=1.96e9)) == pytest.approx(4.3e-15, rel=0.01)


def test_lubrication_takes_its_two_parts_of_dry_wear():
    dry = rate("archard_1953")
    assert float(rate("masjedi_khonsari_2015") / dry) == pytest.approx(1e-3, rel=1e-14)
    whole = rate("masjedi_khonsari_2015", asperity_share=1.0, film_defect=1.0)
    assert float(whole) == float(dry)
    assert float(rate("masjedi_khonsari_2015", asperity_share=0.0)) == 0.0


def test_janakiraman_by_hand():
    load, rough, viscous = 1e5 / 226e7, 5e-7 / 0.01, 2e-8 * 226e9
    expected = 3.981e29 / 226e9 * load**1.219 * viscous**-7.377 * rough**1.589
    assert float(rate("janakiraman_2013")) == pytest.approx(expected, rel=1e-12)
    thick, thin = (rate("janakiraman_2013", pressure_viscosity=value) for value in (2.5e-8, 1.5e-8))
    assert float(thin / thick) == pytest.approx(43.3, abs=0.05)
    assert float(rate("janakiraman_2013", ra_1=0.0, ra_2=5e-7)) == pytest.approx(
        expected, rel=1e-12
    )
    double = rate("janakiraman_2013", line_load=2e5)
    assert float(double) == pytest.approx(2.0**1.219 * expected, rel=1e-12)


@pytest.mark.parametrize("gone", [{"ra_1": 0.0, "ra_2": 0.0}, {"line_load": 0.0}])
def test_smooth_or_unloaded_rollers_do_not_wear(gone):
    assert float(rate("janakiraman_2013", **gone)) == 0.0
    slope = SLOPE["janakiraman_2013"](arrays({**ROLLERS, **gone}))
    assert all(np.isfinite(one) for one in slope.values())


def test_defects_by_hand():
    """Three orders below dry wear at 313 K are an adsorption heat of 36.9 kJ/mol where 0.0695 m/s slide."""
    leaving = 3e-10 / 3e-12 * math.exp(-36.9e3 / (GAS * 313.0))
    speed = -leaving / math.log1p(-1e-3)
    assert speed == pytest.approx(0.0695, abs=1e-4)
    assert float(bare(sliding=speed)) == pytest.approx(1e-3, rel=1e-12)
    typical = 1.0 - math.exp(-100.0 * math.exp(-49e3 / (GAS * 313.0)) / speed)
    usual = fractional_film_defect(sliding=speed, temperature=313.0)
    assert float(usual) == pytest.approx(typical, rel=1e-10)
    assert 0.9e-5 < float(usual) < 1.1e-5


def test_at_rest_all_is_bare_and_at_speed_nothing():
    assert float(bare(sliding=0.0)) == 1.0
    assert float(bare(sliding=0.0, adsorption_heat=1e7)) == 1.0
    fast = bare(sliding=1e12)
    assert float(fast) == pytest.approx(float(bare(sliding=1e11)) / 10.0, rel=1e-12) and fast > 0.0
    by_speed = np.asarray(bare(sliding=np.logspace(-9.0, 9.0, 181)))
    assert (np.diff(by_speed) <= 0.0).all() and by_speed[0] == 1.0
    by_heat = np.asarray(bare(temperature=np.linspace(250.0, 900.0, 181)))
    assert (np.diff(by_heat) > 0.0).all()


@pytest.mark.parametrize("speed", [0.0, 1e-300, 1e-6, 0.07, 1e300])
def test_slopes_of_defects_are_finite(speed):
    slope = SLOPE["film_defect"](arrays({**BARE, "sliding": speed}))
    assert all(np.isfinite(one) for one in slope.values())


@pytest.mark.parametrize("name", [*WEAR_LAWS, "film_defect"])
def test_gradients_are_those_of_differences(name):
    """d ln f/d ln x of every argument, by the program and by central differences."""
    given = {**GIVEN, "film_defect": BARE}[name]
    found, at = SLOPE[name](arrays(given)), float(value(name, **given))
    for key, one in given.items():
        up, down = (float(value(name, **{**given, key: one * (1.0 + by)})) for by in (1e-4, -1e-4))
        expected = math.log(up / down) / math.log(1.0001 / 0.9999)
        assert float(found[key]) * one / at == pytest.approx(expected, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("law", WEAR_LAWS.values(), ids=lambda law: law.name)
def test_what_a_law_states_about_itself(law):
    wanted = inspect.signature(law.function).parameters
    assert law.name == law.function.__name__
    assert {*wanted} <= {*UNITS} and {*law.ranges} <= {*wanted}
    assert {one.kind for one in wanted.values()} == {inspect.Parameter.KEYWORD_ONLY}
    assert {*law.sources} <= {*citations.available()}
    assert law.rivals == [*WEAR_LAWS.values()]


def test_laws_of_lines_are_refused_elsewhere():
    assert [name for name, law in WEAR_LAWS.items() if shape_of(law)] == ["janakiraman_2013"]
    with pytest.raises(
        InputError, match=r"holds for line contacts.*; choose one of archard_1953, "
    ):
        demand_shape(WEAR_LAWS["janakiraman_2013"], "ellipse")


def test_laws_broadcast():
    found = rate(
        "masjedi_khonsari_2015",
        coefficient=np.array([[1e-6], [2e-6]]),
        asperity_share=np.array([0.1, 0.2, 0.3]),
    )
    assert found.shape == (2, 3) and np.allclose(found[1], 2.0 * found[0], rtol=1e-15)


def test_an_unknown_law_gets_the_nearest():
    with pytest.raises(InputError, match="not a known wear law; did you mean archard_1953"):
        WEAR_LAWS["archard"]


def test_mean_wear_of_a_wheel_of_a_program():
    """z 51/52, m 1, of steel and plastic: a commercial program reports 0.063, 1.330 mm and 40.151 um."""
    factor = loss_factor((51, 52), (0.600, 0.554))
    assert float(factor) == pytest.approx(0.0626, abs=5e-5)
    depth = value(
        "mean_wear_depth",
        torque=8.0,
        turns=1.324e7,
        loss_factor=factor,
        rate=parse("1e-6 mm3/(N m)", "specific wear rate"),
        face_width=15e-3,
        teeth=52,
        flank_length=1.330e-3,
    )
    assert float(depth) == pytest.approx(40.151e-6, rel=1e-3)


def path(teeth, module=2e-3):
    """Base and tip radii of a standard spur pair, and how far its path reaches from its pitch point."""
    angle = math.radians(20.0)
    base = [module * z / 2.0 * math.cos(angle) for z in teeth]
    tips = [module * (z / 2.0 + 1.0) for z in teeth]
    reach = [
        math.sqrt(tip**2 - own**2) - own * math.tan(angle)
        for tip, own in zip(tips, base, strict=True)
    ]
    return base, tips, reach


def test_the_guideline_is_the_mean_of_the_local_law():
    """Force times sliding of equally shared load, added up over an engagement, over the flank in use."""
    teeth, torque, width, wear = (20, 41), 50.0, 0.02, 1e-15
    base, tips, reach = path(teeth)
    pitch = 2.0 * math.pi * base[0] / teeth[0]
    ends = np.array(sorted([-reach[1], reach[0], reach[0] - pitch, pitch - reach[1], 0.0]))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    volume = 0.0
    for low, high in pairwise(ends):
        place = 0.5 * (high + low) + 0.5 * (high - low) * nodes
        alone = (place > reach[0] - pitch) & (place < pitch - reach[1])
        force = torque / base[0] * np.where(alone, 1.0, 0.5)
        sliding = np.abs(place) * (1.0 / base[0] + 1.0 / base[1])
        volume += wear * float(0.5 * (high - low) * weights @ (force * sliding))
    along = math.tan(math.radians(20.0)) * base[0]
    lowest = math.hypot(base[0], along - reach[1])
    length = value(
        "flank_length",
        tip_diameter=2.0 * tips[0],
        root_diameter=2.0 * lowest,
        base_diameter=2.0 * base[0],
    )
    start, end = along - reach[1], along + reach[0]
    assert float(length) == pytest.approx((end**2 - start**2) / (2.0 * base[0]), rel=1e-12)
    factor = loss_factor(teeth, (reach[0] / pitch, reach[1] / pitch))
    depth = value(
        "mean_wear_depth",
        torque=torque,
        turns=1.0,
        loss_factor=factor,
        rate=wear,
        face_width=width,
        teeth=teeth[0],
        flank_length=length,
    )
    assert float(depth) == pytest.approx(volume / (width * float(length)), rel=1e-10)


def test_stages_by_the_rate_and_by_the_pressure():
    cycles = np.array([0.0, 1.0, 2.0, 3.0])
    rate, pressure = np.array([2.0, 1.0, 1.2, 1.8]), np.array([1.0, 0.8, 1.2, 1.8])
    assert run_in_end(cycles, rate) == pytest.approx(0.9)
    # 1.5 times the least rate, and the first pressure.
    assert severe_start(cycles, rate) == pytest.approx(2.5)
    assert severe_start(cycles, pressure, "pressure") == pytest.approx(2.5)
    assert severe_start(cycles, pressure) == pytest.approx(2.0)
    assert math.isnan(severe_start(cycles[:3], pressure[:3], "pressure"))


def test_no_range_is_known_of_the_regression():
    """The limits of its tests are in none of its sources at hand: the law says so, and nothing is cut."""
    law = WEAR_LAWS["janakiraman_2013"]
    assert not law.ranges and "nothing can say where it is left" in law.note
