"""Transients against closed forms of mechanics, and against the quasi-static balance in which they end."""

import dataclasses

import numpy as np
import pytest
from scipy.optimize import brentq

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.dynamics.moving_bodies import Body, Support, radial_bearings
from pitchpoint.dynamics.right_hand_side import MovingMesh, contact_forces
from pitchpoint.dynamics.transient import CLOSED, _code, _known, transient
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, state
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import pitch_point
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.rigs.twin_disc import TwinDisc
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE, FrictionLaw
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
COUNT = 41
HELD = 1e12
"""Mass that nothing moves [kg]."""


def rising(*, sliding, line_load, level=0.05):
    """A coefficient that asks for speed and force of the moment."""
    return level * (1.0 + sliding / 0.01) * (line_load / 1e5) ** -0.1


RISING = FrictionLaw("rising", "", rising, (), ({}, 0.0))
CONSTANT = next(law for law in LAWS if law.name == "constant")


def design_of(mesh):
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.8e-6))


def models(law, **parameters):
    values = {name: array(value) for name, value in parameters.items()}
    sharing, rolling = LOAD_SHARING["from_stiffness"], ROLLING_RESISTANCE["none"]
    return Models((law,), array(0), {law.name: values}, sharing, rolling)


def operation(load=100.0, speed=1.0):
    return Operation(*map(array, (load, speed, 328.15)))


# ---- a spur pair on bearings that yield: all tests share one program


def pair(driver=0):
    mesh = build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
    )
    design = design_of(mesh)
    return design.driven_by(driver)


def gear(inertia, torque=(0.0, 0.0), held=(HELD, 0.0, 0.0), **braked):
    return Body(inertia, torque, support=radial_bearings(*held), **braked)


def moving(bodies, knots=(0.0, 1.0), level=0.0, phase=0.4, load=100.0, relaxation=0.0, design=None):
    return MovingMesh(
        design or PAIR,
        operation(load),
        models(RISING, level=level),
        bodies,
        knots=array(knots),
        phase=array(phase),
        creep=array(1e-4),
        relaxation=array(relaxation),
    )


PAIR = pair()
TIMES = np.linspace(0.0, 0.04, COUNT)
GEARS = (Body(1e-3), Body(6e-3))
RESISTANCE, VISCOUS, TORQUE = 59.0, 50.0 / 0.15, 55.0
BEARING = 2e8


def from_rest(load=100.0):
    """Torque that grows for 8 ms, against a resistance; a pair enters when it is there."""
    bodies = (
        gear(1e-3, [0.0, TORQUE], (2.0, BEARING, 4e3)),
        gear(
            6e-3,
            (0.0, 0.0),
            (4.0, BEARING, 4e3),
            resistance=RESISTANCE,
            creep=0.01,
            viscous=VISCOUS,
        ),
    )
    given = {"level": 0.05, "phase": 0.993, "relaxation": 2e-5, "load": load}
    found = transient(moving(bodies, [0.0, 8e-3], **given), TIMES)
    return jax.tree.map(np.asarray, found)


@pytest.fixture(scope="module")
def started():
    """Stiffness at the load under which it ends."""
    first = from_rest()
    return from_rest(-braking(first)[-1])


def braking(found):
    """Torque against gear 2 [N m]."""
    return RESISTANCE * np.tanh(found.rate[1] / 0.01) + VISCOUS * found.rate[1]


@program
def quasi_static(design, point, phase, laws):
    found = state(design, point, phase, laws)
    return found.balance, found.input_torque


@pytest.mark.whole
def test_a_start_from_rest_ends_in_the_quasi_static_balance(started):
    assert started.status.code == Code.SOLVED
    assert np.all(started.rate[:, 0] == 0.0)
    entered = np.sum(started.found.stiffness > 0.0, axis=(0, 1))
    assert entered[0] == 1
    assert entered[-1] == 2
    load, speed = -braking(started), np.abs(started.rate[0])
    last = np.s_[-5:]
    point = Operation(array(load[last]), array(speed[last]), array(328.15))
    found = jax.tree.map(lambda v: v[..., last], started.found)
    # The wind-up changes with phase, which the sliding feels at any speed: the coefficients are its own.
    laws = dataclasses.replace(models(RISING, level=0.05), held=array(found.friction))
    balance, torque = quasi_static(PAIR, point, array(found.phase), laws)
    np.testing.assert_allclose(np.sum(found.force, (0, 1)), balance.force, rtol=1e-6)
    np.testing.assert_allclose(found.force, balance.load, rtol=1e-6)
    np.testing.assert_allclose(torque, TORQUE, rtol=1e-6)
    assert np.all(np.abs(np.tanh(found.slip / 1e-4)) > 1.0 - 1e-5)
    assert np.all(np.diff(speed[last]) != 0.0)


@pytest.mark.whole
def test_the_friction_law_is_asked_at_the_speed_and_force_of_the_moment(started):
    found = started.found
    expected = rising(
        sliding=np.abs(found.slip), line_load=np.maximum(found.force, 1.0) / 26.7e-3, level=0.05
    )
    carries = found.force > 0.0
    assert np.ptp(found.friction[carries]) > 0.01
    np.testing.assert_allclose(found.friction, np.where(carries, expected, 0.0), rtol=1e-10)


@pytest.mark.whole
def test_energy_of_a_start_from_rest_closes(started):
    energy = started.energy
    assert energy.closure < 1e-8
    assert float(started.status.residual) == pytest.approx(
        float(energy.closure), abs=1e-13
    )  # of rounding
    for part in (energy.friction, energy.damping, energy.drag):
        assert part[-1] > 1e-4 * energy.put_in[-1]
    # The balance says that it is none without any one of its parts.
    assert dataclasses.replace(energy, friction=0.0 * energy.friction).closure > 1e-3


@pytest.mark.whole
def test_parametric_work_is_that_of_springs_that_change_while_pressed(started):
    after = np.s_[-15:]
    acts = started.found
    stretch, springs = (v[..., after] for v in (acts.stretch, acts.stiffness))
    middle = (stretch[..., 1:] ** 2 + stretch[..., :-1] ** 2) / 2.0
    pressed = springs * np.maximum(stretch, 0.0)
    receding = (pressed[..., 1:] + pressed[..., :-1]) / 2.0 * np.diff(acts.contacts.gap[..., after])
    expected = np.sum(middle * np.diff(springs)) / 2.0 - np.sum(receding)
    work = started.energy.mesh[after]
    assert work[-1] - work[0] == pytest.approx(expected, rel=1e-4)


@pytest.mark.whole
def test_bearings_give_way_to_the_teeth(started):
    contacts, drawn = started.found.contacts, started.found.drawn
    pushed = np.sum(
        started.found.force * contacts.direction + drawn * contacts.tangent, axis=(1, 2)
    )
    for member, sense in enumerate((-1.0, 1.0)):
        shift = started.place[2 + 2 * member : 4 + 2 * member]
        expected = sense * pushed[:2, -1] / BEARING
        np.testing.assert_allclose(shift[:, -1], expected, atol=1e-6 * np.max(np.abs(shift)))


@pytest.mark.whole
@pytest.mark.parametrize("driver", [1, 2])
def test_contacts_travel_with_the_flanks(driver):
    bodies = [gear(1e-3, viscous=3.0), gear(6e-3, viscous=12.0)]
    bodies[driver - 1] = gear(5e-3, (20.0, 20.0))
    given = {"design": pair(driver - 1), "phase": 0.2 if driver == 1 else 0.3}
    found = jax.tree.map(np.asarray, transient(moving(bodies, **given), TIMES / 400.0))
    contacts, turned = found.found.contacts, np.diff(found.place[driver - 1])
    moved = np.diff(contacts.point[:, 0, 0])
    along = np.sum(moved * contacts.direction[:, 0, 0, 1:], axis=0)
    assert np.all(np.diff(found.found.phase)[1:] * (1.0 if driver == 1 else -1.0) > 0.0)
    outwards = contacts.normal[driver - 1, 0, 0, 1:] * (1.0 if driver == 1 else -1.0)
    np.testing.assert_allclose(along, outwards * turned, rtol=1e-6, atol=1e-15)


@pytest.mark.whole
def test_a_pair_without_friction_swings_about_its_deflection():
    radii = np.abs(np.asarray(PAIR.mesh.base_radii))
    inertia, push = np.array([1e-3, 6e-3]), 1e-5  # so small that phase stands still
    bodies = [gear(j, [push * r] * 2) for j, r in zip(inertia, radii, strict=True)]
    taken = moving(bodies, load=push * radii[1])
    found = jax.tree.map(np.asarray, transient(taken, TIMES / 20.0))
    stiffness = np.sum(found.found.stiffness[..., 0])
    frequency = np.sqrt(stiffness * np.sum(radii**2 / inertia))
    expected = push / stiffness * (1.0 - np.cos(frequency * TIMES / 20.0))
    stretch = radii @ found.place[:2]
    np.testing.assert_allclose(stretch, expected, atol=1e-7 * push / stiffness)
    energy = found.energy
    np.testing.assert_allclose(energy.mesh, 0.0, atol=1e-8 * np.max(energy.contacts))
    assert energy.closure < 1e-8


@pytest.mark.whole
def test_bodies_apart_move_as_if_alone():
    mass, bearing, damping, brake = 2.0, 2e8, 4e3, 12.0
    bodies = (
        gear(1e-3, [-50.0] * 2, (mass, bearing, damping)),
        gear(6e-3, [-20.0] * 2, viscous=brake),
    )
    start = np.array([-0.01, 0.0, -1e-5, -1e-5, 0.0, 0.0])
    times = TIMES / 20.0
    found = jax.tree.map(np.asarray, transient(moving(bodies), times, place=start))
    assert np.all(found.found.force == 0.0)
    np.testing.assert_allclose(found.place[0], -0.01 - 50.0 / 1e-3 * times**2 / 2.0, rtol=1e-9)
    speed = -20.0 / brake * -np.expm1(-brake / 6e-3 * times)
    np.testing.assert_allclose(found.rate[1], speed, rtol=1e-8, atol=1e-12)
    decay = damping / (2.0 * mass)
    frequency = np.sqrt(bearing / mass - decay**2)
    swing = np.cos(frequency * times) + decay / frequency * np.sin(frequency * times)
    expected = -1e-5 * np.exp(-decay * times) * swing
    np.testing.assert_allclose(found.place[2:4], [expected] * 2, atol=1e-6 * 1e-5)
    assert found.energy.closure < 1e-8


def test_a_transient_that_is_not_found_is_no_number():
    bodies = gear(1e-3, [np.nan] * 2), gear(6e-3)
    found = transient(moving(bodies), TIMES)
    assert int(found.status.code) == Code.NOT_CONVERGED
    assert np.all(np.isnan(found.rate[:, 1:]))
    assert np.isnan(found.status.residual)
    for part in jax.tree.leaves((found.found, found.torque, found.energy)):
        later = np.asarray(part)[..., 1:]
        assert not np.any(later) if part.dtype == bool else np.all(np.isnan(later))


def test_a_motion_whose_energy_does_not_close_is_no_number():
    states = jnp.array([[0.0, 1.0, np.nan]]), jnp.array([[0.0, np.inf, 1.0]])
    assert np.array_equal(_known(states, array(CLOSED)), [True, False, False])
    assert np.array_equal(_known(states, array(np.nan)), [True, False, False])
    assert not np.any(_known(states, array(2.0 * CLOSED)))


@pytest.mark.parametrize(
    ("reached", "closure", "code"),
    [
        (True, CLOSED, Code.SOLVED),
        (True, 2.0 * CLOSED, Code.NOT_CONVERGED),
        (True, np.nan, Code.NOT_CONVERGED),
        (False, 0.0, Code.NOT_CONVERGED),
    ],
)
def test_solved_asks_that_the_end_is_reached_and_the_energy_closes(reached, closure, code):
    assert int(_code(jnp.asarray(reached), array(closure))) == code


@pytest.mark.whole
def test_times_may_lie_where_pairs_enter():
    """Rounding puts the same moment at two numbers, between which no step fits."""
    end = 4.0 * float(PAIR.period) / 100.0
    bodies = gear(np.inf), gear(6e-3, [100.0] * 2)
    rate = np.pad(100.0 * np.asarray(PAIR.motion), (0, 4))
    found = transient(moving(bodies, phase=0.9), np.linspace(0.0, end, COUNT), rate=rate)
    assert found.status.code == Code.SOLVED


# ---- the load of the whole mesh


def of_mesh(*, reference_line_load):
    """A coefficient that is the nominal load over the length of the lines of contact."""
    return reference_line_load


def test_laws_are_told_the_force_of_the_mesh_and_nothing_for_idle_lanes():
    mesh = build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
        helix_angle=np.deg2rad(20.0),
    )
    law = FrictionLaw("of mesh", "", of_mesh, (), ({}, 0.0))
    given = dataclasses.replace(
        moving(GEARS, design=design_of(mesh), phase=0.8),
        models=models(law),
        stiffness=array(1e6),
    )
    forces = program(contact_forces)
    found = forces(given, array([0.0, 1e-4]), array([0.0, 0.0]))
    force, carries = np.asarray(found.force), np.asarray(found.force > 0.0)
    assert np.any(carries)
    assert not np.all(carries)
    expected = np.sum(force) / float(pitch_point(mesh, given.design.driver).line_length)
    np.testing.assert_allclose(found.friction, np.where(carries, expected, 0.0), rtol=1e-12)
    parted = forces(given, array([0.0, -1e-4]), array([0.0, 0.0]))
    assert np.all(np.asarray(parted.friction) == 0.0)


# ---- discs pressed together by a force: another program


RADII, NORMAL, FRICTION = np.array([0.05, 0.08]), 100.0, 0.1
DISCS = design_of(TwinDisc(array(RADII), array(0.01), array(0.9)))


def discs(inertia, mass, held, creep, times, rate):
    shifted = Support(mass, np.array([[0.0, 1.0, 0.0]]), np.array([[held]]), np.zeros((1, 1)))
    spring = 1e6
    bodies = (Body(inertia[0]), Body(inertia[1], support=shifted), Body(1.0, [NORMAL]))
    given = MovingMesh(
        DISCS,
        operation(NORMAL),
        models(CONSTANT, coefficient=FRICTION),
        bodies,
        knots=array([0.0]),
        phase=array(0.0),
        creep=array(creep),
        relaxation=array(0.0),
        stiffness=array(spring),
    )
    pressed = [0.0, 0.0, NORMAL / spring, 0.0]
    return jax.tree.map(np.asarray, transient(given, times, place=pressed, rate=rate))


@pytest.mark.whole
def test_discs_reach_a_common_speed_in_the_time_of_the_textbook():
    inertia, speed = np.array([1e-3, 4e-3]), 20.0
    grip = FRICTION * NORMAL
    end = RADII[0] * speed / (grip * np.sum(RADII**2 / inertia))
    times = np.linspace(0.0, 1.5 * end, COUNT)
    found = discs(inertia, HELD, 0.0, 1e-4, times, [speed, 0.0, 0.0, 0.0])
    slides = times < 0.99 * end
    first, second = found.rate[:2]
    lost = grip * RADII[0] / inertia[0] * times
    gained = grip * RADII[1] / inertia[1] * times
    np.testing.assert_allclose(first[slides], (speed - lost)[slides], rtol=1e-9)
    np.testing.assert_allclose(second[slides], -gained[slides], rtol=1e-9, atol=1e-9)
    common = speed - grip * RADII[0] / inertia[0] * end
    rolls = times > 1.01 * end
    np.testing.assert_allclose(first[rolls], common, rtol=1e-3)
    np.testing.assert_allclose((RADII[0] * first + RADII[1] * second)[rolls], 0.0, atol=1e-8)
    assert found.energy.closure < 1e-8
    np.testing.assert_allclose(found.energy.mesh, 0.0, atol=1e-8 * found.energy.kinetic[0])


@pytest.mark.whole
def test_a_block_on_a_belt_slips_sticks_and_slips_the_other_way():
    mass, frequency, belt, start = 1.0, 100.0, 0.05, 0.12
    held = mass * frequency**2
    shift = FRICTION * NORMAL / held
    times = np.linspace(0.0, 0.075, COUNT)
    rates = [belt / RADII[0], 0.0, 0.0, start]
    found = discs((1e3, 1e6), mass, held, 1e-5, times, rates)

    def ahead(time):
        angle = frequency * time
        place = -shift + shift * np.cos(angle) + start / frequency * np.sin(angle)
        return place, start * np.cos(angle) - shift * frequency * np.sin(angle)

    stuck = brentq(lambda time: ahead(time)[1] - belt, 0.0, 0.01)
    carried = ahead(stuck)[0]
    freed = stuck + (shift - carried) / belt
    swing = shift + belt / frequency * np.sin(frequency * (times - freed))
    riding = carried + belt * (times - stuck)
    expected = np.where(times < stuck, ahead(times)[0], np.where(times < freed, riding, swing))
    np.testing.assert_allclose(found.place[3], expected, atol=2e-3 * shift)
    sense = np.sign(found.found.slip[0, 0])
    assert np.all(sense[times < stuck] == -1.0)
    assert np.all(sense[times > freed] == 1.0)
    assert found.energy.closure < 1e-8


# ---- what a transient cannot do


def shifting(*ways):
    held = np.eye(len(ways))
    return Body(1.0, support=Support(1.0, np.array(ways), held, held))


@pytest.mark.parametrize(
    ("changes", "times", "told"),
    [
        ({"bodies": GEARS[:1]}, TIMES, "one body for each of gear 1, gear 2; 1 bodies are given"),
        ({"bodies": (Body(0.0), GEARS[1])}, TIMES, "gear 1 needs a positive inertia, got 0"),
        (
            {"bodies": (GEARS[0], Body(1.0, support=radial_bearings(-1.0, 1.0)))},
            TIMES,
            "gear 2 needs a positive mass, got -1",
        ),
        ({}, [0.0, 1.0, 1.0], "times of a transient grow"),
        (
            {"knots": array([0.0, 2.0, 5e-5])},
            TIMES,
            "knots of the external torques grow with time, got 0, 2, 5e-05 s",
        ),
        (
            {"bodies": (GEARS[0], Body(1.0, [1.0, 2.0, 3.0]))},
            TIMES,
            "gear 2 needs one torque, or one for each of the 2 knots of time; 3 are given",
        ),
        (
            {"creep": array(0.0)},
            TIMES,
            "creep of the contacts is a sliding speed above 0 m/s, got 0",
        ),
        (
            {"bodies": (Body(1.0, creep=0.0), GEARS[1])},
            TIMES,
            "creep of gear 1 is a speed above 0, got 0",
        ),
        (
            {"bodies": (GEARS[0], shifting([0.0, 2.0, 0.0]))},
            TIMES,
            "gear 2 shifts along unit vectors at right angles to each other; .* are 2 long",
        ),
        (
            {"bodies": (GEARS[0], shifting([0.0, 1.0, 0.0], [0.0, 0.6, 0.8]))},
            TIMES,
            "or not at right angles",
        ),
        ({"design": DISCS, "bodies": (*GEARS, Body(1.0))}, TIMES, "need the stiffness"),
        (
            {"design": dataclasses.replace(PAIR, drag=(Drag([1.0, 0.0]),))},
            TIMES,
            "give them as resistance and viscous torque of the bodies",
        ),
    ],
)
def test_what_is_missing_is_told_in_one_sentence(changes, times, told):
    given = dataclasses.replace(moving(GEARS), **changes)
    with pytest.raises(InputError, match=told):
        transient(given, times)


@pytest.mark.parametrize("start", [{"place": [0.0] * 3}, {"rate": np.zeros((1, 2))}])
def test_a_start_has_one_number_for_each_coordinate(start):
    (name,) = start
    with pytest.raises(InputError, match=f"^{name} at the start .* each of the 2 coordinates"):
        transient(moving(GEARS), TIMES, **start)
