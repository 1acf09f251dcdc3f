"""Motion of several coordinates with friction against closed forms, balances and the simpler models."""

import dataclasses

import numpy as np
import pytest
from sound import quick_first

from pitchpoint._jax import array, jnp
from pitchpoint.contact.ellipse import hertz_1881
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.moving_bodies import Body, motor, radial_bearings
from pitchpoint.dynamics.pair_vibration import Vibrating, excited, steady
from pitchpoint.dynamics.passage import passage, polynomial, tabulated
from pitchpoint.dynamics.right_hand_side import MovingMesh
from pitchpoint.dynamics.steady_motion import (
    steady_motion,
)
from pitchpoint.dynamics.transient import transient
from pitchpoint.efficiency.quasi_static import Design, Models, Operation, cycle, state
from pitchpoint.errors import InputError
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
FIRM = dataclasses.replace(STEEL, young=1e4 * STEEL.young)
LAW = {law.name: law for law in LAWS}
GRID = PeriodGrid(8, 24)
LOAD, SPEED = 100.0, 100.0
INERTIA = (1e-3, 6e-3)


def design_of(mesh, solid=STEEL):
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (solid, solid), oil, Roughness.from_composite_rq(0.8e-6))


def models(friction="constant", rolling="none", **parameters):
    values = {name: array(value) for name, value in parameters.items()}
    sharing, resistance = LOAD_SHARING["from_stiffness"], ROLLING_RESISTANCE[rolling]
    return Models((LAW[friction],), array(0), {friction: values}, sharing, resistance)


def operation(load=LOAD, speed=SPEED):
    return Operation(*map(array, (load, speed, 328.15)))


def spur(**given):
    values = {"teeth": (18, 36), "module": 3e-3, "face_width": 26.7e-3}
    return build_cylindrical_pair(pressure_angle=np.deg2rad(20.0), **values | given)


def torus():
    table = {
        "family": "torus",
        "teeth": [40, 49],
        "module": "2.5 mm",
        "face_width": ["15 mm", "20 mm"],
        "torus_radius": ["35 mm", "55 mm"],
    }
    return built_gears(TorusGears.model_validate(table), 6)[0]


SPUR = design_of(spur())
ACTION = np.asarray(line_of_action(SPUR.mesh))
MOTION = np.asarray(SPUR.motion)
ORDERS = (1, 2)


def moving(bodies, design=SPUR, own=None, **given):
    values = {
        "knots": array([0.0]),
        "phase": array(0.0),
        "creep": array(1e-4),
        "relaxation": array(0.0),
        "law": CONTACT_LAWS["linear"],
    }
    own = own or models(coefficient=0.0)
    return MovingMesh(design, operation(), own, bodies, **values | given)


def alone(driver=np.inf, **given):
    """Two gears on stiff bearings, without friction, damped along the line of action."""
    waves = ErrorOrders(np.zeros(2), ORDERS, np.zeros(2))
    values = {"error": waves, "mesh_damping": array(800.0)} | given
    return moving((Body(driver), Body(INERTIA[1], LOAD)), **values)


# ---- one coordinate: the vibration along the line of action


@pytest.mark.whole
def test_with_a_steady_driver_and_without_friction_it_is_the_vibration_along_the_line_of_action():
    vibrating = Vibrating(
        inertia=array([np.inf, INERTIA[1]]),
        damping_ratio=array(0.07),
        error=array([2e-6, 1e-6]),
        error_phase=array([0.3, -1.0]),
        orders=ORDERS,
    )
    own = models(coefficient=0.0)
    expected, damping = program(_vibration)(SPUR, operation(), own.compliance, vibrating)
    waves = ErrorOrders(vibrating.error, ORDERS, vibrating.error_phase)
    found = steady_motion(alone(error=waves, mesh_damping=damping[0, 0]), SPEED, GRID)
    assert found.status.code == expected.status.code == Code.SOLVED
    size = np.ptp(expected.transmission_error)
    np.testing.assert_allclose(
        found.transmission_error, expected.transmission_error, atol=1e-8 * size
    )
    np.testing.assert_allclose(
        found.found.force[:, 0], expected.force, atol=1e-8 * np.max(expected.force)
    )
    largest = np.sort(np.abs(found.multipliers))
    np.testing.assert_allclose(largest, np.sort(np.abs(expected.multipliers)), rtol=1e-6)
    orders = range(4)
    np.testing.assert_allclose(
        found.spectrum(found.transmission_error, orders),
        expected.spectrum(expected.transmission_error, orders),
        atol=1e-8 * size,
    )


def _vibration(design, point, terms, vibrating):
    _, moved, driven = excited(design, point, terms, vibrating)
    return steady(moved, driven, GRID), moved.damping


@pytest.mark.whole
def test_parametric_work_of_a_period_is_that_of_springs_that_change_while_pressed():
    """And of the places from which they push, since Weber's contact stiffens with its load."""
    found = steady_motion(alone(), SPEED, GRID)
    springs, stretch = found.found.stiffness[:, 0], found.found.stretch[:, 0]
    receding = springs * stretch * GRID.derivative(found.found.contacts.gap[:, 0])
    changed = GRID.integral(GRID.derivative(springs) * stretch**2 / 2.0 - receding)
    energy = springs * stretch**2 / 2.0
    jump = np.roll(energy, -1, axis=1)[..., 0] - energy[..., -1]
    # The account ends before the hand-over with which the next period begins.
    expected = np.sum(changed) + np.sum(jump[:, :-1])
    assert abs(expected) > 1e-3 * np.max(found.energy.contacts)
    missed = found.energy.mesh[-1] - expected
    assert float(missed) == pytest.approx(0.0, abs=1e-8 * float(jnp.max(found.energy.contacts)))


@pytest.mark.whole
def test_a_driver_with_inertia_keeps_its_mean_speed_under_a_constant_torque():
    found = steady_motion(alone(INERTIA[0], mesh_damping=array(2000.0)), SPEED, GRID)
    assert found.status.code == Code.SOLVED
    period = float(SPUR.period) / SPEED
    assert float(found.time[-1, -1]) == pytest.approx(period, rel=1e-10)
    assert np.ptp(found.rate[0]) > 1e-3
    assert float(found.mean(found.rate[0])) == pytest.approx(SPEED, rel=1e-10)
    assert np.ptp(found.torque[0]) < 1e-9
    assert float(found.torque[0, 0, 0]) == pytest.approx(LOAD / 2.0, rel=1e-9)
    energy = found.energy
    lost = energy.damping[-1] + (energy.contacts[-1] - energy.contacts[0])
    assert float(energy.put_in[-1] + energy.mesh[-1] - lost) == pytest.approx(0.0, abs=1e-8 * LOAD)


@pytest.mark.whole
def test_a_result_does_not_depend_on_the_tolerance():
    fine, coarse = (steady_motion(alone(), SPEED, GRID, tolerance=size) for size in (1e-11, 1e-8))
    size = np.ptp(fine.transmission_error)
    error = np.max(np.abs(fine.transmission_error - coarse.transmission_error))
    assert 0.0 < error < 1e-6 * size


# ---- the quasi-static limit


SLOW = {"spur": 0.5, "helical": 0.5, "torus": 0.03}
"""Speeds [rad/s]; elliptic contacts are softer, so that it takes longer until a hand-over is forgotten."""


@program
def quasi_static(design, point, own, phase):
    """Mean efficiency, and forces at phases."""
    return cycle(design, point, own).mean_efficiency, state(design, point, phase, own).balance.load


@pytest.mark.whole
@pytest.mark.parametrize("family", quick_first(["spur", "helical", "torus"]))
def test_a_slow_motion_is_the_quasi_static_cycle(family):
    """Of teeth so stiff that their wind-up adds nothing to the sliding."""
    mesh = {
        "spur": spur,
        "helical": lambda: spur(helix_angle=np.deg2rad(18.0), slices=4),
        "torus": torus,
    }[family]()
    own = models("constant", coefficient=0.05)
    design = design_of(mesh, FIRM)
    heavy = (Body(np.inf), Body(600.0, LOAD))
    slow = {"creep": array(1e-6), "relaxation": array(2.5e-4), "own": own, "design": design}
    slow["error"] = ErrorOrders(np.zeros(2), ORDERS, np.zeros(2))
    found = steady_motion(moving(heavy, **slow), SLOW[family], GRID)
    assert found.status.code in (Code.SOLVED, Code.UNRESOLVED)  # jumps at the pitch point
    settled, node = np.flatnonzero(np.diff(found.bounds) > 0.1), GRID.nodes // 2
    assert settled.size > 2
    mean, load = quasi_static(design, operation(), own, found.found.phase[settled, node])
    assert float(found.efficiency) == pytest.approx(float(mean), abs=1e-6)
    force = found.found.force[:, :, settled, node]
    np.testing.assert_allclose(force, load, atol=1e-6 * np.max(load))


# ---- energy of transients


def bearing(inertia, torque=0.0, mass=2.0):
    return Body(inertia, torque, support=radial_bearings(mass, 2e8, 4e3))


@pytest.mark.whole
@pytest.mark.parametrize("combination", quick_first(["separating, motor", "linear, steady driver"]))
def test_energy_of_a_transient_closes_with_every_effect(combination):
    own = models("xu_2007", rolling="wu_cheng_1991")
    curve = tabulated([0.0, 0.3, 0.8, 1.7], [1.5e8, 3e8, 3.2e8, 1e8])
    given = {
        "own": own,
        "passage": passage(SPUR, operation(), own.compliance, curve),
        "error": ErrorOrders([2e-6, 8e-6], [1.0, 2.5], [0.3, 0.1]),
        "relaxation": array(2e-6),
        "mesh_damping": array(300.0),
        "backlash": array(4e-6),
    }
    if combination == "linear, steady driver":
        bodies = bearing(np.inf), bearing(6e-3, 20.0, 4.0)
    else:
        given["law"] = CONTACT_LAWS["separating"]
        drive = motor(stall_torque=100.0, no_load_speed=1.2 * SPEED, inertia=1e-3)
        bodies = (
            dataclasses.replace(drive, support=radial_bearings(2.0, 2e8, 4e3)),
            bearing(6e-3, 20.0, 4.0),
        )
    rate = np.pad(SPEED * MOTION, (0, 4))
    times = np.linspace(0.0, 3.3 * float(SPUR.period) / SPEED, 60)
    found = transient(moving(bodies, **given), times, rate=rate)
    energy, force = found.energy, np.asarray(found.found.force)
    assert found.status.code == Code.SOLVED
    assert float(energy.closure) < 1e-8
    for part in (energy.error, energy.friction, energy.rolling, energy.damping, energy.mesh):
        assert abs(float(part[-1])) > 1e-6 * float(energy.put_in[-1])
    pushed = found.found.on_coordinates[2:]
    np.testing.assert_allclose(pushed[:2] + pushed[2:], 0.0, atol=1e-12 * np.max(np.abs(force)))
    if combination == "linear, steady driver":
        assert np.ptp(found.rate[0]) == 0.0
        assert np.any(force < 0.0)
        assert np.all(found.found.drawn[force < 0.0] == 0.0)
    else:
        assert np.any(np.all(found.found.stretch < 0.0, axis=(0, 1)))
        assert float(energy.drag[-1]) > 0.0


@pytest.mark.whole
def test_a_gear_on_a_steady_one_swings_about_its_deflection():
    stiff = 3e8
    way = passage(SPUR, operation(), models().compliance, polynomial([stiff]))
    bodies = Body(np.inf), Body(INERTIA[1], LOAD)
    own = moving(bodies, passage=way, phase=array(0.9))  # one pair alone
    frequency = ACTION[1] * np.sqrt(stiff / INERTIA[1])
    times = np.linspace(0.0, 6.0 / frequency, 41)
    found = transient(own, times)
    rest = LOAD / ACTION[1] / stiff
    assert np.sum(np.asarray(found.found.stiffness)[..., 0]) == pytest.approx(stiff)
    expected = rest * (1.0 - np.cos(frequency * times))
    np.testing.assert_allclose(found.place[1] * ACTION[1], expected, atol=1e-8 * rest)


@pytest.mark.whole
def test_an_ellipse_alone_swings_about_its_approach_at_the_slope_of_its_force():
    """Hertz: F is proportional to approach^1.5, so that dF/d(approach) is 1.5 F/approach."""
    mesh = torus()
    design = design_of(dataclasses.replace(mesh, widths=1e12 * mesh.widths))  # rigid teeth
    phase, arm = array(0.9), float(line_of_action(mesh)[1])  # one pair alone
    contacts = program(mesh.contacts)(phase)
    (at,) = np.argwhere(np.asarray(contacts.active))
    contact = hertz_1881(
        load=LOAD / abs(arm),
        radius=contacts.radius[tuple(at)],
        transverse_radius=mesh.transverse_radius,
        modulus=STEEL.plane_strain_modulus,
    )
    rest, frequency = float(contact.approach), abs(arm) * np.sqrt(contact.stiffness / INERTIA[1])
    bodies = Body(np.inf), Body(INERTIA[1], LOAD)
    way = passage(design, operation(), models().compliance)
    times = np.linspace(0.0, 6.0 / frequency, 41)
    found = transient(moving(bodies, design, passage=way, phase=phase), times)
    expected = rest * (1.0 - np.cos(frequency * times))
    np.testing.assert_allclose(found.place[1] * arm, expected, atol=1e-8 * rest)


# ---- what cannot be done


def test_stiffness_below_nothing_is_refused():
    with pytest.raises(InputError, match=r"never negative, got -.* N/m at .* on its path"):
        passage(SPUR, operation(), models().compliance, polynomial([3e8, -3e8]))


@pytest.mark.parametrize(
    ("changes", "speed", "told"),
    [
        ({}, 0.0, "mean speed of the driver above 0, got 0"),
        ({"mesh_damping": array(0.0)}, SPEED, "nothing damps the vibration"),
        (
            {"error": ErrorOrders([1e-6], [1.5], [0.0])},
            SPEED,
            "order 1.5 of the mesh does not repeat after 1 mesh cycles",
        ),
        (
            {"bodies": (Body(1.0), Body(1.0, [1.0, 2.0])), "knots": array([0.0, 1.0])},
            SPEED,
            "torques that are constant",
        ),
    ],
)
def test_a_steady_motion_that_cannot_be_is_told_in_one_sentence(changes, speed, told):
    with pytest.raises(InputError, match=told):
        steady_motion(dataclasses.replace(alone(), **changes), speed, GRID)


def test_tables_and_motors_are_checked():
    with pytest.raises(InputError, match="the places grow"):
        tabulated([0.0, 0.0], [1.0, 2.0])
    with pytest.raises(InputError, match="above 0 rad/s, got 0"):
        motor(stall_torque=1.0, no_load_speed=0.0, inertia=1.0)
