"""Planetary trains by their contacts: independent numbers, phases, equilibrium, one pair as the smallest."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from pitchpoint._jax import jax, jnp
from pitchpoint.drive.assembly import (
    check_neighbours,
    equal_angles,
    nearest_places,
    places_around,
    planet_phases,
)
from pitchpoint.drive.kinematics import Ends, Link
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.efficiency.summary import summarise
from pitchpoint.efficiency.train import gear_train
from pitchpoint.efficiency.train_cycle import _least, train_cycle
from pitchpoint.efficiency.train_summary import _figures, train_figures
from pitchpoint.errors import InputError
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
OIL = lubricants.find("pao-vg-220").build()
POINT = Operation(*map(jnp.asarray, (100.0, 150.0, 330.0)))
TO_CARRIER = Ends({"sun": 1.0}, ("ring",), "carrier")


def models(law, rolling="none", **own):
    (chosen,) = (one for one in LAWS if one.name == law)
    values = {law: {name: jnp.asarray(value) for name, value in own.items()}} if own else {}
    return Models(
        (chosen,), jnp.asarray(0), values, LOAD_SHARING["equal"], ROLLING_RESISTANCE[rolling]
    )


def constant(mu):
    return models("constant", coefficient=mu)


@cache
def design(teeth, shift=(0.0, 0.0), *, right=False, module=2e-3, distance=None):
    pair = build_cylindrical_pair(
        teeth=teeth,
        module=module,
        pressure_angle=np.deg2rad(20.0),
        face_width=0.02,
        profile_shift=shift,
        tip_alteration=(0.0, 0.0),
        centre_distance=distance,
        right_flank=right,
    )
    return Design(pair, (STEEL, STEEL), OIL, Roughness.from_composite_rq(0.4e-6))


def meshes(sun, planet, ring, shift=0.0, *, turned=False):
    """Designs and links of a planetary; the sun pushes one flank of a planet, and the ring the other one."""
    designs = [
        design((sun, planet), (0.0, shift), right=turned),
        design((planet, -ring), (shift, 0.0), right=not turned),
    ]
    links = [
        Link(designs[0].mesh, ("sun", "planet"), "carrier"),
        Link(designs[1].mesh, ("planet", "ring"), "carrier"),
    ]
    return designs, links


def planetary(teeth, angles, ends=TO_CARRIER, *, turned=False):
    designs, links = meshes(*teeth, turned=turned)
    phases = planet_phases(links, ("planet",), angles)
    return gear_train(links, designs, ends, planets=("planet",), phases=phases)


def over_whole_period(train):
    """The same train, with planets at any phases: nothing is known to repeat within its period."""
    return replace(train, alike=False, turns=jnp.ones(()))


def solved(train, mu, point=POINT):
    return train_cycle(train, point, [constant(mu)] * len(train.meshes))


def figures(train, mu, point=POINT):
    each = train_figures([(train, point)], [constant(mu)] * len(train.meshes))
    return {name: values[0] for name, values in each.items()}


def ripple(found):
    return (found["max_input_torque"] - found["min_input_torque"]) / found["mean_input_torque"]


@pytest.mark.parametrize(("mu", "asked"), [(0.05, 0.99114646), (0.1, 0.98239193)])
def test_a_planetary_has_the_efficiency_of_a_computation_tooth_by_tooth(mu, asked):
    found = figures(planetary((24, 30, 84), equal_angles(3)), mu)
    assert found["mean_efficiency"] == pytest.approx(asked, rel=3e-6)
    assert not found["locked"]


@pytest.mark.parametrize(("teeth", "asked"), [((24, 30, 84), 0.00972), ((25, 29, 83), 0.00247)])
def test_phases_of_the_planets_make_the_ripple(teeth, asked):
    found = figures(planetary(teeth, equal_angles(3)), 0.05)
    assert ripple(found) == pytest.approx(asked, rel=0.03)


def order(found, number):
    """Part of an order of the mesh frequency in the torque of the sun, of its mean."""
    every = np.asarray(found.weight) * np.asarray(found.input_torque)
    return abs((every * np.exp(-2j * np.pi * number * np.asarray(found.phase))).sum()) / every.sum()


def test_orders_that_phases_cancel_do_not_reach_the_sun():
    """25 teeth are no multiple of 3: orders whose number is none either cancel (Parker 2000)."""
    found = solved(over_whole_period(planetary((25, 29, 83), equal_angles(3))), 0.05)
    assert max(order(found, number) for number in (1, 2, 4, 5)) < 1e-8
    assert min(order(found, number) for number in (3, 6)) > 1e-5


@pytest.mark.whole
def test_a_third_of_the_period_stands_for_all_of_it():
    """Where planets come to each other's places; forces of each over the rest are those of the others."""
    train = planetary((25, 29, 83), equal_angles(3))
    part, whole = (solved(one, 0.05) for one in (train, over_whole_period(train)))
    assert float(train.turns) == 3.0
    for name in ("input_torque", "loss"):
        means = [float(one.mean(getattr(one, name))) for one in (part, whole)]
        assert means[0] == pytest.approx(means[1], rel=1e-13)
    assert float(part.ripple) == pytest.approx(float(whole.ripple), rel=1e-11)
    first, every = (np.asarray(one.meshes[0].force)[:3] for one in (part, whole))
    at, nodes = np.asarray(part.phase)[:, None] + np.arange(3) / 3, np.asarray(whole.phase)
    for further in range(3):
        number = np.array(
            [np.argmin(abs((nodes - one + 0.5) % 1.0 - 0.5)) for one in at[:, further]]
        )
        inside = abs((nodes[number] - at[:, further] + 0.5) % 1.0 - 0.5) < 1e-12
        shifted = np.roll(first, -further * int(train.onwards), axis=0)[:, inside]
        assert inside.sum() > 20
        np.testing.assert_allclose(every[:, number[inside]], shifted, rtol=1e-9)


def test_another_number_of_planets_asks_for_no_program_more():
    """24/30/84 with two, three and four planets; five to eight have a program of their own."""
    _figures.ready.clear()
    for count in (2, 3, 4):
        found = figures(planetary((24, 30, 84), equal_angles(count)), 0.05)
        assert found["mean_efficiency"] == pytest.approx(0.99114646, rel=3e-5)
    assert len(_figures.ready) == 1


def test_torques_are_in_equilibrium_and_power_is_lost_in_contacts():
    found = solved(planetary((25, 29, 83), equal_angles(3)), 0.1)
    torques = np.array([*map(np.asarray, found.torques.values())])
    np.testing.assert_allclose(torques.sum(0), 0.0, atol=1e-12 * np.abs(torques).max())
    sliding = [np.asarray(one.sliding_loss) for one in found.meshes]
    lost = sum(one.sum((0, 1, 2)) for one in sliding)
    passing = np.asarray(found.input_power) - np.asarray(found.output_power)
    np.testing.assert_allclose(passing, lost, rtol=1e-9, atol=1e-9)
    assert set(found.torques) == {"sun", "carrier", "ring"}


@pytest.mark.whole
def test_numbers_of_planets_and_the_way_round_change_nothing():
    angles = equal_angles(3)
    found = figures(planetary((25, 29, 83), angles), 0.05)
    other = figures(planetary((25, 29, 83), angles[[0, 2, 1]]), 0.05)
    # Seen from behind all turns the other way, and the other flanks touch.
    back = Ends({"sun": -1.0}, ("ring",), "carrier")
    turned = figures(planetary((25, 29, 83), angles, back, turned=True), 0.05)
    for one in (other, turned):
        assert one["mean_efficiency"] == pytest.approx(found["mean_efficiency"], rel=1e-13)
        assert ripple(one) == pytest.approx(ripple(found), rel=1e-9)


@pytest.mark.whole
def test_driven_backwards_it_carries_on_the_same_flanks():
    """The carrier drives and the sun takes what it took before: Willis with the same meshes."""
    train = planetary((24, 30, 84), equal_angles(3))
    there, back = figures(train, 0.05), figures(train.driven_backwards(), 0.05)
    links = meshes(24, 30, 84)[1]
    ends = Ends({"carrier": 1.0}, ("ring",), "sun")
    asked = train_torques(links, ends, 1.0, there["stage_efficiency"].tolist())
    assert back["mean_efficiency"] == pytest.approx(asked.efficiency, abs=2e-5)
    again = figures(train.driven_backwards().driven_backwards(), 0.05)
    assert again["mean_efficiency"] == pytest.approx(there["mean_efficiency"], rel=1e-14)


def test_meshes_of_one_planet_stand_half_a_pitch_apart_where_its_teeth_are_even():
    """At their pitch points (pi - s/r) z/2 pi: 1/2 for even, 0 for odd numbers of teeth without shift."""
    for teeth, asked in (((24, 30, 84), 0.5), ((25, 29, 83), 0.0)):
        designs, links = meshes(*teeth)
        sun, ring = planet_phases(links, ("planet",), equal_angles(1))
        paths = [float(one.mesh.line.pitch_path) for one in designs]
        apart = ring[0] - paths[1] - (sun[0] - paths[0])
        assert np.cos(2.0 * np.pi * (apart - asked)) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.whole
def test_a_mesh_of_its_own_is_the_cycle_of_its_pair():
    pair = design((23, 61))
    law = models("xu_2007", "wu_cheng_1991")
    train = gear_train([Link(pair.mesh, ("in", "out"))], [pair], Ends({"in": 1.0}, loaded="out"))
    found, asked = train_figures([(train, POINT)], [law]), summarise([(pair, POINT)], law)
    # Six nodes between two events, in place of 24; friction bends where contacts nearly roll.
    assert found["mean_friction"] == pytest.approx(asked["mean_friction"], rel=1e-4)
    for name in ("mean_loss", "mean_input_torque", "jamming_coefficient"):
        assert found[name] == pytest.approx(asked[name], rel=3e-7)
    for name in ("min_efficiency", "max_efficiency"):
        assert found[name] == pytest.approx(asked[name], rel=1e-5)
    assert found["mean_efficiency"] == pytest.approx(asked["mean_efficiency"], rel=3e-9)
    assert found["stage_efficiency"][0] == pytest.approx(asked["mean_efficiency"], rel=1e-9)
    assert int(found["iterations"][0]) > 3


@pytest.mark.whole
def test_a_carrier_at_rest_is_a_chain_of_two_pairs():
    """Willis with the mean efficiencies of its meshes: low by order mu squared, as a chain of means is."""
    ends = Ends({"sun": 1.0}, ("carrier",), "ring")
    found = figures(planetary((24, 30, 84), equal_angles(3), ends), 0.05)
    each = found["stage_efficiency"].tolist()
    assert found["mean_efficiency"] == pytest.approx(float(np.prod(each)), abs=1e-5)
    willis = train_torques(meshes(24, 30, 84)[1], TO_CARRIER, 1.0, each)
    lost = 1.0 - figures(planetary((24, 30, 84), equal_angles(3)), 0.05)["mean_efficiency"]
    assert 1.0 - willis.efficiency == pytest.approx(lost, rel=0.01)


@cache
def three_k(turned, loaded, rate):
    """18/36/90/34/88: its second ring turns on, as the sun does, and is driven by the first one's way."""
    pushed = (False, True, False)
    designs = [
        design(teeth, right=right)
        for teeth, right in zip(((18, 36), (36, -90), (34, -88)), pushed, strict=True)
    ]
    bodies = (("sun", "planet"), ("planet", "ring"), ("planet", "output ring"))
    links = [Link(one.mesh, body, "carrier") for one, body in zip(designs, bodies, strict=True)]
    phases = planet_phases(links, ("planet",), equal_angles(2))
    ends = Ends({turned: rate}, ("ring",), loaded)
    return links, gear_train(links, designs, ends, planets=("planet",), phases=phases)


@pytest.mark.whole
def test_a_3k_agrees_with_free_bodies_and_locks_where_they_do():
    """Free bodies with mean efficiencies of the meshes are low by order mu squared."""
    _, train = three_k("sun", "output ring", 1.0)
    links, back = three_k("output ring", "sun", -1.0)
    for mu, locks in ((0.02, False), (0.05, False), (0.6, True)):
        there, returned = figures(train, mu), figures(back, mu)
        each = there["stage_efficiency"].tolist()
        for found, (turned, loaded) in (
            (there, ("sun", "output ring")),
            (returned, ("output ring", "sun")),
        ):
            asked = train_torques(links, Ends({turned: 1.0}, ("ring",), loaded), 1.0, each)
            assert found["locked"] == asked.locked == (locks and turned != "sun")
            assert (found["jamming_coefficient"] < mu) == found["locked"]
            if not asked.locked:
                lost = 1.0 - asked.efficiency
                assert 1.0 - found["mean_efficiency"] == pytest.approx(lost, rel=2.0 * mu)


def test_planets_that_do_not_fit_in_are_refused_with_what_they_miss():
    _, links = meshes(24, 30, 84)
    planet_phases(links, ("planet",), equal_angles(4))
    with pytest.raises(
        InputError,
        match=r"number 2 misses the teeth of the ring by 0\.4 of a pitch",
    ):
        planet_phases(links, ("planet",), equal_angles(5))
    # Steps of 2 pi over the teeth of sun and ring together fit wherever they end.
    steps = 2.0 * np.pi / 108.0 * np.array([0.0, 22.0, 43.0, 65.0, 86.0])
    planet_phases(links, ("planet",), steps)
    places = places_around([(30, 24), (30, -84)])
    assert nearest_places(equal_angles(5), places) == pytest.approx(steps)


@pytest.mark.parametrize(
    ("pairs", "places"), [([(18, 36), (24, -78)], 270), ([(18, 36), (36, -90), (34, -88)], 54)]
)
def test_planets_fit_in_at_as_many_places_as_are_counted(pairs, places):
    """A stepped and a 3K set: phases are found at each of their places, and at none between them."""
    bodies = (("sun", "planet"), ("planet", "ring"), ("planet", "output ring"))
    links = [
        Link(design(teeth).mesh, names, "carrier")
        for teeth, names in zip(pairs, bodies, strict=False)
    ]
    of_planets = [pairs[0][::-1], *pairs[1:]]
    assert places_around(of_planets) == places
    planet_phases(links, ("planet",), 2.0 * np.pi / places * np.arange(0.0, places, 7.0))
    with pytest.raises(InputError, match="number 2 misses"):
        planet_phases(links, ("planet",), np.array([0.0, np.pi / places]))


def test_forces_of_the_least_sum_of_squares_are_those_of_numpy():
    """Two central rows, three planets of which each has two forces of its own, and a place without one."""
    random = np.random.default_rng(9)
    arms, wanted = random.normal(size=(6, 8, 4)), random.normal(size=(6, 4))
    own = np.arange(8) % 4 == np.arange(4)[:, None]
    arms[2:] *= own[..., None]
    arms[:, 3::4], wanted[5] = 0.0, 0.0
    found = jax.jit(_least, static_argnums=2)(arms, wanted, 4)
    for node in range(4):
        expected = np.linalg.lstsq(arms[:, :, node], wanted[:, node])[0]
        np.testing.assert_allclose(found[:, node], expected, rtol=1e-12, atol=1e-12)


def test_planets_that_run_into_each_other_are_refused():
    _, links = meshes(24, 30, 84)
    check_neighbours(links, ("planet",), equal_angles(4))
    with pytest.raises(InputError, match="54 mm apart, and their tip circles measure 64 mm"):
        check_neighbours(meshes(24, 30, 84)[1], ("planet",), equal_angles(6))


def test_other_flanks_and_losses_beside_teeth_are_refused():
    designs, links = meshes(24, 30, 84, turned=True)
    with pytest.raises(InputError, match="mesh of sun and planet presses its other flanks"):
        gear_train(links, designs, TO_CARRIER)
    with pytest.raises(InputError, match="2 bodies are turned"):
        gear_train(links, designs, Ends({"sun": 1.0, "ring": 0.2}, (), "carrier"))
    with pytest.raises(InputError, match="planets are neither turned nor loaded nor held"):
        gear_train(links, designs, Ends({"sun": 1.0}, ("planet",), "carrier"), planets=("planet",))
