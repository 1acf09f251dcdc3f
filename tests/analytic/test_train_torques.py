"""Torques of planetary, stepped and 3K trains by free bodies against Willis' formulas and closed forms."""

from math import isnan, nan

import numpy as np
import pytest
from trains import EFFICIENCIES, link, planetary, stepped, three_k

from pitchpoint.drive.kinematics import Ends
from pitchpoint.drive.torques import train_torques
from pitchpoint.errors import InputError
from pitchpoint.sizing.three_k import three_k_efficiencies

SEED = 20261127
LOAD = 100.0


def efficiency(links, turned, held, loaded, efficiencies):
    ends = Ends({turned: 1.0}, held, loaded)
    return train_torques(links, ends, LOAD, efficiencies).efficiency


SIMPLE = {
    ("sun", "carrier", "ring"): 0.9883722222,
    ("carrier", "sun", "ring"): 0.9883334634,
    ("ring", "carrier", "sun"): 0.9966777778,
    ("carrier", "ring", "sun"): 0.9966386932,
    ("sun", "ring", "carrier"): 0.98505,
}


@pytest.mark.parametrize(("turned", "loaded", "held"), SIMPLE)
def test_a_planetary_has_the_efficiency_of_its_flow(turned, loaded, held):
    found = efficiency(planetary(24, 30, 84), turned, (held,), loaded, EFFICIENCIES[:2])
    assert found == pytest.approx(SIMPLE[turned, loaded, held], abs=6e-11)


THREE_K = [
    ((18, 36, 90, 34, 88), EFFICIENCIES, 0.7699379528, 0.7056033545),
    ((18, 36, 90, 40, 92), EFFICIENCIES, 0.8844246087, 0.8716439648),
    ((12, 41, 94, 45, 98), (0.98, 0.99, 0.99), 0.7053064446, 0.5975316733),
]


@pytest.mark.parametrize(("teeth", "efficiencies", "forwards", "backwards"), THREE_K)
def test_a_3k_has_the_efficiency_of_its_flow(teeth, efficiencies, forwards, backwards):
    links, held = three_k(*teeth), ("ring",)
    there = efficiency(links, "sun", held, "output ring", efficiencies)
    back = efficiency(links, "output ring", held, "sun", efficiencies)
    assert (there, back) == pytest.approx((forwards, backwards), abs=6e-11)


def of_willis(basic, eta, turned, held, loaded, rates):
    """Efficiency of a set of two central gears and a carrier; not a number where it is locked.

    Torques of the central gears by the efficiency of the set with its carrier at rest, t_c by their sum.
    """
    for sense in (1.0, -1.0):
        first, second = 1.0, -basic * eta**sense
        torques = {"first": first, "second": second, "carrier": -first - second}
        if torques[loaded] * rates[loaded] > 0.0:
            torques = {body: -one for body, one in torques.items()}
        driving = torques["first"] * (rates["first"] - rates["carrier"])
        if driving * sense < 0.0:
            continue
        power_in = torques[turned] * rates[turned]
        if power_in > 0.0:
            return -torques[loaded] * rates[loaded] / power_in
    return nan


@pytest.mark.whole
def test_random_sets_of_two_central_gears_agree_with_willis():
    random = np.random.default_rng(SEED)
    bodies = ["first", "second", "carrier"]
    locked = signs = 0
    for number in range(1000):
        # Nearly equal steps lock: half of the sets have some.
        low, high = (15, 90) if number % 2 else (28, 33)
        teeth = random.integers(low, high, 4) * [1, 1, 1, random.choice([-1, 1])]
        basic = float(teeth[3] * teeth[1] / (teeth[0] * teeth[2]))
        if abs(basic - 1.0) < 1e-9:
            continue
        etas = random.uniform(0.93, 1.0, 2)
        turned, held, loaded = random.permutation(bodies).tolist()
        links, ends = stepped(*teeth.tolist()), Ends({turned: 1.0}, (held,), loaded)
        found = train_torques(links, ends, LOAD, etas.tolist())
        # Both meshes external: the second gear turns with the first, and the basic ratio is positive.
        asked = of_willis(basic, float(np.prod(etas)), turned, held, loaded, found.rates)
        assert found.efficiency == pytest.approx(asked, rel=1e-9, nan_ok=True)
        assert isnan(asked) == found.locked
        locked, signs = locked + isnan(asked), signs + (basic > 0.0)
        if not found.locked:
            assert 0.0 < found.efficiency <= 1.0 + 1e-12
            every = [abs(torque) for torque in found.torques.values()]
            assert abs(sum(found.torques.values())) < 1e-9 * max(every)
            power = sum(found.torques[body] * rate for body, rate in found.rates.items())
            assert sum(found.losses) == pytest.approx(power, rel=1e-9, abs=1e-9 * LOAD)
    assert locked > 20
    assert signs > 300


@pytest.mark.whole
def test_random_3k_trains_agree_with_their_closed_forms():
    random = np.random.default_rng(SEED)
    locked = above = 0
    for _ in range(1000):
        sun, planet, second_planet = random.integers(12, 60, 3).tolist()
        ring = sun + 2 * planet
        second_ring = ring + second_planet - planet
        second = ring * second_planet / (planet * second_ring)
        if second_planet == planet or second_ring <= second_planet:
            continue
        etas = random.uniform(0.95, 1.0, 3).tolist()
        teeth = sun, planet, ring, second_planet, second_ring
        ways = dict(
            zip(
                ("sun", "output ring"),
                map(float, three_k_efficiencies(np.array(teeth, float), np.array(etas))),
                strict=True,
            )
        )
        links = three_k(*teeth)
        for turned, loaded in (("sun", "output ring"), ("output ring", "sun")):
            found = train_torques(links, Ends({turned: 1.0}, ("ring",), loaded), LOAD, etas)
            asked = ways[turned] or nan
            assert found.efficiency == pytest.approx(asked, rel=1e-9, nan_ok=True)
            locked, above = locked + isnan(asked), above + (second > 1.0)
    assert locked > 50
    assert above > 300


def test_a_chain_multiplies_efficiencies():
    links = [link(23, 61, ("in", "middle")), link(19, 70, ("middle", "out"))]
    found = train_torques(links, Ends({"in": 150.0}, loaded="out"), LOAD, (0.98, 0.97))
    assert found.efficiency == pytest.approx(0.98 * 0.97, rel=1e-14)
    assert found.torques["in"] == pytest.approx(
        LOAD / (0.98 * 0.97) * (23 / 61) * (19 / 70), rel=1e-14
    )
    assert found.driving == ("in", "middle")


def test_two_bodies_may_be_turned():
    """A differential: both central gears drive, and the carrier takes the power of both."""
    ends = Ends({"sun": 10.0, "ring": 4.0}, loaded="carrier")
    found = train_torques(planetary(24, 30, 84), ends, LOAD, EFFICIENCIES[:2])
    powers = {body: found.torques[body] * found.rates[body] for body in ("sun", "ring")}
    assert min(powers.values()) > 0.0
    assert found.efficiency == pytest.approx(found.output_power / sum(powers.values()), rel=1e-12)


def test_nothing_carried_is_no_efficiency():
    found = train_torques(
        planetary(24, 30, 84), Ends({"sun": 1.0}, ("ring",), "carrier"), 0.0, (0.99, 0.99)
    )
    assert isnan(found.efficiency)
    assert not found.locked


@pytest.mark.parametrize(
    ("loaded", "load", "efficiencies", "words"),
    [
        ("", LOAD, (0.99, 0.99), "no body takes the power; name the loaded one"),
        ("carrier", LOAD, (0.99,), "1 efficiencies were given for 2 meshes"),
        ("carrier", LOAD, (0.99, 1.2), "the efficiency of a mesh is 1.2; it must be above 0"),
        ("carrier", -1.0, (0.99, 0.99), "the load is -1; it must be a number that is not negative"),
        ("ring", LOAD, (0.99, 0.99), "ring is held and takes no power"),
    ],
)
def test_what_no_train_has_is_refused_in_a_sentence(loaded, load, efficiencies, words):
    with pytest.raises(InputError, match=words):
        train_torques(
            planetary(24, 30, 84), Ends({"sun": 1.0}, ("ring",), loaded), load, efficiencies
        )
