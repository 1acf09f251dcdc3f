"""Steady motions of one spur pair: branches where teeth part, gear 2 driving, films and modes by hand."""

import dataclasses

import numpy as np
import pytest
from moving_pair import INERTIA, LAW, LOAD, OPERATION, PAIR, XU, moving
from moving_pair import SPEED as SLOW

from pitchpoint._jax import array
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.modes import mean_stiffness, modes
from pitchpoint.dynamics.moving_bodies import Body, radial_bearings
from pitchpoint.dynamics.passage import passage
from pitchpoint.dynamics.steady_motion import film, steady_motion
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.film_thickness import dowson_higginson_1959
from pitchpoint.lubrication.lubrication_registry import FILM_THICKNESS, ROLLING_RESISTANCE

GRID = PeriodGrid(6, 20)
CONSTANT = dataclasses.replace(
    XU,
    friction=(LAW["constant"],),
    parameters={"constant": {"coefficient": array(0.05)}},
    sharing=LOAD_SHARING["from_stiffness"],
    rolling=ROLLING_RESISTANCE["none"],
)
NOMINAL = np.full(4, np.nan)
"""State of a search that begins from the nominal motion; every search of this file is one program."""


def vibrating(**given):
    """Gear 2 on a steady gear 1, damped a little."""
    held = Body(array(np.inf)), Body(array(INERTIA[1]), [LOAD])
    own = moving(held, error=ErrorOrders([1e-6], [1.0], [0.0]), relaxation=array(0.0))
    values = {"models": CONSTANT, "mesh_damping": array(4000.0)}
    return dataclasses.replace(own, **values | given)


def found_at(own, speed, start=NOMINAL):
    return steady_motion(own, float(speed), GRID, start=array(start))


# ---- both ways through the resonance


RISING = (460.0, 500.0, 540.0, 580.0)
"""The outer two lie beyond the folds; the first resonance of small vibrations is at some 560 rad/s."""


def marched(speeds):
    """Motions in turn, each begun from the one before."""
    state, found = NOMINAL, {}
    for speed in speeds:
        found[speed] = found_at(vibrating(), speed, state)
        state = found[speed].state
    return found


@pytest.fixture(scope="module")
def branches():
    return marched(RISING), marched(RISING[::-1])


def swing(motion):
    return float(motion.rms(motion.transmission_error))


@pytest.mark.whole
def test_speeds_that_rise_and_fall_find_both_branches_between_the_folds(branches):
    rising, falling = branches
    for speed in RISING[1:-1]:
        assert swing(falling[speed]) > 2.0 * swing(rising[speed])
        assert np.min(pressed(rising[speed])) > 0.0
        assert np.min(pressed(falling[speed])) == 0.0  # teeth part, which softens the mesh
    for speed in (RISING[0], RISING[-1]):
        assert swing(falling[speed]) == pytest.approx(swing(rising[speed]), rel=1e-7)


def pressed(motion):
    return np.sum(np.asarray(motion.found.force), axis=(0, 1))


@pytest.mark.whole
def test_every_branch_is_a_motion_that_repeats_itself(branches):
    for way in branches:
        for motion in way.values():
            assert motion.status.code == Code.SOLVED
            assert float(motion.energy.closure) < 1e-8
            assert np.max(np.abs(motion.multipliers)) < 1.0
            for course in (np.asarray(motion.beside[1]), np.asarray(motion.rate[1])):
                left = course[-1, -1] - course[0, 0]
                assert abs(left) < 1e-7 * np.ptp(course)


# ---- gear 2 drives


def driven_by_gear_2():
    """The wheel at constant speed, the pinion loaded."""
    mesh = build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
    )
    design = dataclasses.replace(PAIR, mesh=mesh).backwards
    point = dataclasses.replace(OPERATION, load=array(LOAD / 2.0))
    bodies = Body(array(INERTIA[0]), [LOAD / 2.0]), Body(array(np.inf))
    given = {"design": design, "operation": point, "bodies": bodies}
    return vibrating(**given, passage=passage(design, point, XU.compliance))


@pytest.mark.whole
def test_a_wheel_that_drives_loses_to_friction_and_its_energy_closes():
    own = driven_by_gear_2()
    found = found_at(own, SLOW / 2.0)
    assert found.status.code == Code.SOLVED
    assert float(found.mean(found.rate[1])) * float(own.design.motion[1]) > 0.0
    power = np.asarray(found.found.drawn * found.found.slip)
    assert np.min(power) >= 0.0
    assert np.max(power) > 0.0
    # The load takes less than the driver gives by what contacts and dampers lose; springs give back.
    energy, torque, rate = found.energy, found.torque, found.rate
    assert float(energy.closure) < 1e-8
    given = float(found.mean(torque[1] * rate[1]))
    taken = -float(found.mean(torque[0] * rate[0]))
    assert 0.0 < taken == pytest.approx(float(found.mean(found.load_power)), rel=1e-12)
    period = float(found.time[-1, -1])
    lost = float(energy.friction[-1] + energy.damping[-1]) / period
    assert lost > 0.0
    assert float(found.efficiency) == pytest.approx(taken / (taken + lost), rel=1e-12)
    assert 0.98 < float(found.efficiency) < 1.0
    assert float(energy.put_in[-1]) / period == pytest.approx(given - taken, abs=1e-4 * taken)
    brought = float(energy.put_in[-1] + energy.error[-1] - energy.pressed[-1]) / period
    assert brought == pytest.approx(lost, rel=1e-8)


# ---- film


@pytest.mark.whole
def test_films_of_a_motion_are_those_of_its_forces_and_speeds():
    own, law = vibrating(), FILM_THICKNESS["dowson_higginson_1959"]
    found = found_at(own, RISING[0])
    thickness = np.asarray(program(film)(own, found, law))
    line, oil = PAIR.mesh.line, PAIR.lubricant
    first, pitch, tangent = (
        float(one) for one in (line.limits[0], line.base_pitch, line.tangent_length)
    )
    force = np.asarray(found.found.force)
    for pair, element, node in ((0, 0, 5), (1, 0, 9), (0, 3, 4), (0, -1, 11)):
        place = first + (float(found.found.phase[element, node]) + pair) * pitch
        radii = np.array([place, tangent - place])
        speeds = radii * np.abs(np.asarray(found.rate[:2, element, node]))
        expected = dowson_higginson_1959(
            line_load=force[pair, 0, element, node] / 26.7e-3,
            entrainment=np.mean(speeds),
            radius=radii[0] * radii[1] / tangent,
            modulus=PAIR.modulus,
            viscosity=oil.viscosity(OPERATION.temperature),
            pressure_viscosity=oil.pressure_viscosity(OPERATION.temperature),
        )
        assert float(thickness[pair, 0, element, node]) == pytest.approx(float(expected), rel=1e-10)
    assert np.array_equal(np.isnan(thickness), ~(force > 0.0))


# ---- modes


@pytest.mark.whole
def test_modes_of_a_pair_on_bearings_are_those_of_springs_in_line():
    """Frequencies and damping by the roots of the whole system; across the line of action in closed form."""
    masses, spring, brake = (2.0, 4.0), 2e8, 400.0
    bodies = tuple(
        Body(array(inertia), support=radial_bearings(mass, spring, brake))
        for inertia, mass in zip(INERTIA, masses, strict=True)
    )
    own = vibrating(bodies=bodies)
    found, whole, mass = program(lambda one: (modes(one), mean_stiffness(one), one.mass))(own)
    assert np.count_nonzero(found.frequency) == 5
    arm = np.asarray(PAIR.mesh.contacts(array(0.1)).normal[:, 0, 0])
    size = np.concatenate([arm, np.zeros(4)])
    normal = np.asarray(PAIR.mesh.contacts(array(0.1)).direction[:2, 0, 0])
    size[2:4], size[4:6] = normal, -normal
    held = np.diag([0.0, 0.0, *[brake] * 4]) + 4000.0 * np.outer(size, size)
    state = np.block(
        [
            [np.zeros((6, 6)), np.eye(6)],
            [-np.asarray(whole) / mass[:, None], -held / np.asarray(mass)[:, None]],
        ]
    )
    roots = np.linalg.eigvals(state)
    roots = roots[roots.imag > 1.0]
    order = np.argsort(np.abs(roots))
    kept = np.asarray(found.frequency) > 0.0
    frequency, ratio = np.abs(roots[order]), -roots[order].real / np.abs(roots[order])
    np.testing.assert_allclose(2.0 * np.pi * found.frequency[kept], frequency, rtol=1e-3)
    np.testing.assert_allclose(found.damping[kept], ratio, rtol=2e-2)
    np.testing.assert_allclose(np.sum(found.share[kept], axis=1), 1.0, rtol=1e-9)
    for one in masses:
        own_frequency = np.sqrt(spring / one) / (2.0 * np.pi)
        place = int(np.argmin(np.abs(np.asarray(found.frequency) - own_frequency)))
        assert float(found.frequency[place]) == pytest.approx(own_frequency, rel=1e-9)
        assert float(found.damping[place]) == pytest.approx(
            brake / (2.0 * np.sqrt(spring * one)), rel=1e-9
        )
        assert float(found.share[place, 0]) == pytest.approx(0.0, abs=1e-9)
