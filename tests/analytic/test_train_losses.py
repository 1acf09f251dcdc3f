"""Losses beside the teeth of planetary trains: power, pins, a lone pair as the smallest, from rest."""

from dataclasses import replace
from math import cos, radians

import numpy as np
import pytest
from test_train import POINT, TO_CARRIER, constant, design, meshes, models

from pitchpoint._jax import array, jnp
from pitchpoint.drive.assembly import equal_angles, planet_phases
from pitchpoint.drive.kinematics import Ends, Link
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.efficiency_registry import BEARING_LOSS
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.efficiency.running_torque import torques_at_rest
from pitchpoint.efficiency.summary import summarise
from pitchpoint.efficiency.train import gear_train
from pitchpoint.efficiency.train_cycle import train_cycle
from pitchpoint.efficiency.train_summary import torques_at_rest_of_train, train_figures
from pitchpoint.loading.reactions import Bearing

WILLIS = 24 / 108
PLANET = WILLIS - 24 / 30 * (1 - WILLIS)
"""Speeds of carrier and planet for a unit speed of the sun of 24/30/84 with a held ring."""


QUIET = Drag(
    between=(1.0, -1.0),
    bearing=BEARING_LOSS["palmgren_1959"],
    mean_diameter=0.03,
    factors={"f0": 0.0, "f1": 0.0},
)
"""A bearing that loses nothing, of which the load counts."""


def point(load):
    return replace(POINT, load=jnp.asarray(load))


def bearing(between=(1.0, -1.0), seat=None, **own):
    """A place with all that brakes: a bearing under load, its seal, oil that is displaced, what holds it."""
    return Drag(
        between=between,
        bearing=BEARING_LOSS["palmgren_1959"],
        mean_diameter=0.03,
        factors={"f0": 2.0, "f1": 1e-3},
        seat=seat,
        seal_torque=0.05,
        churning_torque=0.02,
        churning_speed=100.0,
        breakaway_torque=0.03,
        **own,
    )


def planetary(drag, braked, ends=TO_CARRIER, count=3):
    designs, links = meshes(24, 30, 84)
    angles = equal_angles(count)
    phases = planet_phases(links, ("planet",), angles)
    planets = {"planets": ("planet",), "phases": phases, "angles": angles}
    return gear_train(links, designs, ends, **planets, drag=drag, braked=braked)


def figures(train, mu, load=100.0):
    laws = [constant(mu)] * len(train.meshes)
    found = train_figures([(train, point(load))], laws)
    return {name: values[0] for name, values in found.items()}


@pytest.mark.whole
def test_a_pair_on_its_bearings_is_the_same_as_a_train():
    """Bearings under the load of the teeth, loaded, lightly loaded, without load, and from rest."""
    pair, law = design((23, 61)), models("xu_2007", "wu_cheng_1991")
    seats = (bearing((1.0, 0.0), Bearing(0)), bearing((0.0, 1.0), Bearing(1)))
    alone = replace(pair, drag=seats)
    train = gear_train(
        [Link(pair.mesh, ("in", "out"))],
        [pair],
        Ends({"in": 1.0}, loaded="out"),
        drag=[bearing(), bearing()],
        braked=[("in", "housing"), ("out", "housing")],
    )
    for load in (100.0, 1.0, 0.0):
        found = train_figures([(train, point(load))], [law])
        asked = summarise([(alone, point(load))], law)
        for name in ("mean_loss", "mean_drag_loss", "mean_input_torque", "bearing_load"):
            assert found[name] == pytest.approx(asked[name], rel=3e-7)
        assert found["mean_efficiency"] == pytest.approx(asked["mean_efficiency"], nan_ok=True)
    several = Operation(*(jnp.full(1, float(value)) for value in (0.0, 0.1, 330.0)))
    found = torques_at_rest_of_train(train, several, [law])
    asked = torques_at_rest(alone, several, law)
    assert found[0] == pytest.approx(np.asarray(asked[0]), rel=1e-6)
    assert found[1] == pytest.approx(np.asarray(asked[1]), rel=1e-4)


def test_seals_take_the_power_of_the_speeds_between_their_bodies():
    """Without friction the sun gives what the carrier takes and what all seals take, loaded or not."""
    seal = Drag(between=(1.0, -1.0), seal_torque=0.2)
    places = [("planet", "carrier"), ("sun", "housing"), ("carrier", "sun"), ("ring", "housing")]
    train = planetary([seal] * 4, places)
    lost = 0.2 * (3 * (WILLIS - PLANET) + 1.0 + (1.0 - WILLIS))
    speed = float(POINT.speed)
    for load in (100.0, 0.5, 0.0):
        found = figures(train, 0.0, load)
        assert found["mean_input_torque"] == pytest.approx(load * WILLIS + lost, rel=1e-12)
        assert found["mean_drag_loss"] == pytest.approx(lost * speed, rel=1e-12)
        assert found["mean_loss"] == pytest.approx(lost * speed, rel=1e-12)
        assert not found["locked"]
    assert np.isnan(found["mean_efficiency"])


def test_flanks_that_losses_press_are_in_equilibrium_without_load():
    """A planet that its pin brakes is turned by the sun and leans on the other flanks of the ring."""
    train = planetary([replace(QUIET, seal_torque=0.2)], [("planet", "carrier")])
    found = train_cycle(train, point(0.0), [constant(0.1)] * 2)
    sun, ring = (np.asarray(mesh.force)[:3] for mesh in found.meshes)
    assert (sun > 0.0).all() and (ring < 0.0).all()
    torques = np.array([*map(np.asarray, found.torques.values())])
    np.testing.assert_allclose(torques.sum(0), 0.0, atol=1e-12 * np.abs(torques).max())
    np.testing.assert_allclose(found.input_power, found.loss, rtol=1e-9)
    # The other flank of the ring pushes back along the line on which the sun pushes on.
    np.testing.assert_allclose(found.pressed[0], (sun - np.abs(ring)).mean(axis=0), rtol=1e-9)
    free = 3 * 0.2 * (WILLIS - PLANET)
    # Forces of some newtons rub little: free bodies with a few per cent lost in each mesh.
    assert 1.0 < found.mean(found.input_torque) / free < 1.02


def test_pins_carry_what_the_carrier_takes_and_central_bearings_nothing():
    """Tangential forces F cos(alpha) of a planet add up, its radial ones and those around a sun cancel."""
    places = [("planet", "carrier"), ("sun", "housing"), ("carrier", "housing")]
    train = planetary([QUIET] * 3, places)
    mesh = train.meshes[0].design.mesh
    pin = 100.0 / 3 / float(mesh.centre_distance)
    assert figures(train, 0.0)["bearing_load"] == pytest.approx([pin, 0.0, 0.0], rel=1e-9, abs=1e-9)
    # Planets of 2 kg mm are pulled outwards at right angles to that.
    pulled = replace(train, pull=array(2e-3))
    outwards = 2e-3 * (WILLIS * float(POINT.speed)) ** 2
    both = figures(pulled, 0.0)["bearing_load"]
    assert both == pytest.approx([np.hypot(pin, outwards), 0.0, 0.0], rel=1e-9, abs=1e-9)
    assert outwards > 1.0 and float(pulled.driven_backwards().pull) == 2e-3
    # One planet alone puts its force on the sun, and that of its pin on the carrier.
    lone = figures(planetary([QUIET] * 3, places, count=1), 0.0)["bearing_load"]
    on_sun = 1.5 * pin / cos(radians(20.0))
    assert lone == pytest.approx([3 * pin, on_sun, 3 * pin], rel=1e-9)


@pytest.mark.whole
def test_beyond_the_friction_that_locks_it_a_braked_train_is_locked_too():
    seal = Drag(between=(1.0, -1.0), seal_torque=0.01)
    back = planetary([seal], [("planet", "carrier")]).driven_backwards()
    limit = float(figures(back, 0.05)["jamming_coefficient"])
    assert not figures(back, 0.9 * limit)["locked"]
    assert figures(back, 1.1 * limit)["locked"]
