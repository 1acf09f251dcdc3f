"""Motions with all effects at once: batches against single runs, branches, tolerance, and what diverges."""

import dataclasses

import numpy as np
import pytest

from pitchpoint._jax import array
from pitchpoint.dynamics.bodies import Body
from pitchpoint.dynamics.contact_law import CONTACT_LAWS
from pitchpoint.dynamics.excitation import Waves
from pitchpoint.dynamics.grid import Grid
from pitchpoint.dynamics.passage import passage
from pitchpoint.dynamics.right_hand_side import Moving
from pitchpoint.dynamics.steady_motion import steady_motion
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.sharing import LOAD_SHARING
from pitchpoint.lubrication.friction_coefficient import LAWS
from pitchpoint.lubrication.rolling_resistance import ROLLING_RESISTANCE
from pitchpoint.materials import Roughness, lubricants, solids
from pitchpoint.status import Code

STEEL = solids.find("steel").build()
LAW = {law.name: law for law in LAWS}
XU = Models(
    (LAW["xu_2007"],),
    array(0),
    {},
    LOAD_SHARING["from_stiffness"],
    ROLLING_RESISTANCE["wu_cheng_1991"],
)
GRID = Grid(4, 16)
FOUND = (Code.SOLVED, Code.UNRESOLVED)
"""Where teeth part a force has kinks, which its elements resolve to 1e-3."""

LOAD, SPEED = 100.0, 100.0
INERTIA = (1e-3, 6e-3)
OPERATION = Operation(*map(array, (LOAD, SPEED, 328.15)))


def design(driver=1):
    mesh = build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
        driver=driver,
    )
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.8e-6))


PAIR = design()
WAYS = {1: passage(PAIR, OPERATION, XU.compliance), 2: passage(design(2), OPERATION, XU.compliance)}


def moving(bodies, driver=1, **given):
    """Teeth that may part, with friction and rolling resistance by regressions of films."""
    values = {
        "knots": array([0.0]),
        "phase": array(0.0),
        "creep": array(1e-3),
        "relaxation": array(1e-6),
        "passage": WAYS[driver],
        "law": CONTACT_LAWS["separating"],
        "error": Waves([2e-6, 1e-6], [0.5, 1.0], [0.3, 0.0]),
        "mesh_damping": array(800.0),
    }
    own = PAIR if driver == 1 else design(2)
    return Moving(own, OPERATION, XU, tuple(bodies), **values | given)


def gears(load=LOAD):
    return Body(np.inf), Body(INERTIA[1], [load])


def waves(first, second=0.0):
    return Waves([first, second], [0.5, 1.0], [0.3, 0.0])


def found_at(speed=SPEED, load=LOAD, **given):
    tolerance = given.pop("tolerance", 1e-10)
    return steady_motion(moving(gears(load), **given), speed, GRID, cycles=2, tolerance=tolerance)


def relative(found, expected):
    return np.max(np.abs(np.asarray(found) - np.asarray(expected))) / np.ptp(np.asarray(expected))


# ---- one period of two mesh cycles


@pytest.fixture(scope="module")
def alone():
    return found_at()


def test_an_error_of_half_an_order_repeats_after_two_mesh_cycles(alone):
    assert alone.status.code in FOUND
    assert np.any(np.all(np.asarray(alone.found.stretch) < 0.0, axis=(0, 1)))  # teeth part
    assert float(alone.energy.closure) < 1e-8
    assert float(alone.turned[-1, -1]) == pytest.approx(2.0)
    error = alone.transmission_error
    half, whole = np.split(np.asarray(error), 2)
    assert np.max(np.abs(half - whole)) > 0.1 * np.ptp(error)
    orders = alone.spectrum(error, range(5))  # of the period: every second one is one of the mesh
    assert float(orders[1]) > 1e-7
    own = dataclasses.replace(moving(gears()), error=waves(0.0, 1e-6))
    without = steady_motion(own, SPEED, GRID, cycles=2)
    orders = without.spectrum(without.transmission_error, range(5))
    assert float(orders[1]) < 1e-6 * float(orders[2])


def test_the_error_of_a_motion_falls_with_its_tolerance(alone):
    """To a tenth of the tolerance or better each time; beyond 1e-6 nothing changes by more than that."""
    exact = found_at(tolerance=1e-13).transmission_error
    errors = [
        relative(found_at(tolerance=size).transmission_error, exact) for size in (1e-4, 1e-6, 1e-8)
    ]
    assert errors[1] < errors[0] / 10.0
    assert errors[2] < errors[1] / 10.0
    assert relative(found_at(tolerance=1e-7).transmission_error, exact) < 1e-6
    assert relative(alone.transmission_error, exact) < 1e-8
