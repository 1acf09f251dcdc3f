"""How bodies of drives move: pairs, chains, planetary and 3K trains, and refusals of those that cannot."""

import re
from fractions import Fraction

import numpy as np
import pytest
from trains import link, planetary, three_k

from pitchpoint.drive.kinematics import Ends, Link, body_rates
from pitchpoint.errors import InputError
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears

SEED = 20261126


def ratio_of_three_k(sun, planet, ring, second_planet, second_ring):
    first, second = Fraction(ring, sun), Fraction(ring * second_planet, planet * second_ring)
    return (1 + first) / (1 - second)


def test_a_planetary_moves_as_willis_says():
    links = planetary(24, 30, 84)
    rates = body_rates(links, Ends({"sun": 1.0}, held=("ring",), loaded="carrier"))
    assert rates["carrier"] == pytest.approx(24 / 108, rel=1e-15)
    assert rates["planet"] == pytest.approx(24 / 108 * (1 - 84 / 30), rel=1e-15)
    forwards = body_rates(links, Ends({"sun": 1.0}, held=("carrier",), loaded="ring"))
    assert forwards["ring"] == pytest.approx(-24 / 84, rel=1e-15)
    both = body_rates(links, Ends({"sun": 1.0, "ring": 0.5}, loaded="carrier"))
    assert both["carrier"] == pytest.approx((24 + 0.5 * 84) / 108, rel=1e-15)


@pytest.mark.parametrize(
    ("teeth", "ratio"),
    [((18, 36, 90, 34, 88), 176), ((18, 36, 90, 40, 92), -69), ((12, 41, 94, 45, 98), -167.4167)],
)
def test_a_3k_has_the_ratio_of_its_teeth(teeth, ratio):
    ends = Ends({"sun": 1.0}, held=("ring",), loaded="output ring")
    found = 1.0 / body_rates(three_k(*teeth), ends)["output ring"]
    assert found == pytest.approx(float(ratio_of_three_k(*teeth)), rel=1e-13)
    assert found == pytest.approx(ratio, abs=5e-5)


def test_random_3k_trains_have_the_ratio_of_their_teeth():
    random = np.random.default_rng(SEED)
    met = 0
    for teeth in random.integers(12, 120, (300, 5)).tolist():
        _, planet, ring, second_planet, second_ring = teeth
        if ring * second_planet == planet * second_ring:
            continue
        ends = Ends({"sun": 1.0}, held=("ring",), loaded="output ring")
        rates = body_rates(three_k(*teeth), ends)
        assert 1.0 / rates["output ring"] == pytest.approx(
            float(ratio_of_three_k(*teeth)), rel=1e-9
        )
        met += 1
    assert met > 250


def test_equal_rings_of_a_3k_leave_its_output_at_rest():
    links = three_k(18, 36, 90, 36, 90)
    with pytest.raises(InputError, match="nothing comes from sun to output ring"):
        body_rates(links, Ends({"sun": 1.0}, held=("ring",), loaded="output ring"))


def test_a_chain_multiplies_its_ratios():
    links = [link(23, 61, ("in", "middle")), link(19, 70, ("middle", "out"))]
    rates = body_rates(links, Ends({"in": 150.0}, loaded="out"))
    assert rates["out"] == pytest.approx(150.0 * (23 / 61) * (19 / 70), rel=1e-15)
    assert body_rates(links[::-1], Ends({"out": rates["out"]}))["in"] == pytest.approx(
        150.0, rel=1e-15
    )


def test_a_rack_travels_behind_a_pair():
    table = {"family": "rack_and_pinion", "teeth": 20, "module": "2 mm", "face_width": "20 mm"}
    rack = built_gears(RackAndPinionGears.model_validate(table), 1)[0]
    links = [link(20, 40, ("motor", "pinion")), Link(rack, ("pinion", "rack"))]
    assert body_rates(links, Ends({"motor": 10.0}))["rack"] == pytest.approx(
        -10.0 / 2 * 0.02, rel=1e-14
    )
    with pytest.raises(
        InputError, match="a rack travels in the housing, and the arm would carry it"
    ):
        Link(rack, ("pinion", "rack"), "arm")


def refused(links, ends, words):
    with pytest.raises(InputError, match=re.escape(words)):
        body_rates(links, ends)


def test_trains_that_cannot_run_are_refused_in_a_sentence():
    links = planetary(24, 30, 84)
    refused(
        links,
        Ends({"sun": 1.0}),
        "settled by sun: planet, carrier, ring can still move; hold or turn one",
    )
    refused(links, Ends({"sun": 1.0}, ("ring", "carrier")), "sun turned and ring, carrier held")
    refused(links, Ends({"sun": 1.0}, ("arm",)), "no mesh of the drive has the body arm")
    refused(links, Ends({"sun": 1.0}, ("sun",)), "sun cannot be turned and held at once")
    refused(links, Ends({"sun": 1.0}, ("ring",), "ring"), "ring is held and takes no power")
    apart = [link(23, 61, ("in", "a")), link(23, 61, ("b", "out"))]
    refused(apart, Ends({"in": 1.0}, loaded="out"), "b, out can still move; hold or turn one")
    with pytest.raises(InputError, match="sun meshes with itself or carries its own axis"):
        link(24, 30, ("sun", "sun"))
    with pytest.raises(InputError, match="planet meshes with itself or carries its own axis"):
        link(24, 30, ("sun", "planet"), "planet")
    with pytest.raises(InputError, match="moves 2 bodies"):
        link(24, 30, ("sun", "planet", "ring"))
