"""Transients of many operating points at once, and of what cannot move so."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import array, jax, jnp
from pitchpoint.dynamics.bodies import Body
from pitchpoint.dynamics.contact_law import CONTACT_LAWS
from pitchpoint.dynamics.excitation import Waves
from pitchpoint.dynamics.grid import Grid
from pitchpoint.dynamics.passage import passage
from pitchpoint.dynamics.right_hand_side import Moving
from pitchpoint.dynamics.steady_motion import steady_motion
from pitchpoint.dynamics.transient import transient, transient_motion
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.errors import InputError
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
        "creep": array(1e-2),
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


TIMES = array(np.linspace(0.0, 0.01, 21))
RATE = SPEED * np.asarray(PAIR.mesh.motion)


def free(load=LOAD, **given):
    return moving((Body(INERTIA[0], [0.55 * load]), Body(INERTIA[1], [load])), **given)


@eqx.filter_jit
def together(own, loads):
    def one(load):
        bodies = [
            dataclasses.replace(body, torque=body.torque * load / LOAD) for body in own.bodies
        ]
        given = dataclasses.replace(own, bodies=tuple(bodies))
        return transient_motion(given, TIMES, jnp.zeros(2), jnp.asarray(RATE))

    return jax.vmap(one)(loads)


def test_transients_at_once_are_the_single_ones():
    """Where teeth meet and part rounding may shift a step, to the tolerance of 1e-10 of a state."""
    every = together(free(), array([60.0, LOAD, 140.0]))
    assert np.all(np.asarray(every.status.code) == Code.SOLVED)
    for number, load in enumerate((60.0, LOAD, 140.0)):
        single = transient(free(load), TIMES, rate=RATE)
        assert relative(every.found.force[number], single.found.force) < 1e-6
        np.testing.assert_allclose(every.place[number], single.place, rtol=1e-8, atol=1e-12)


def test_a_transient_of_no_numbers_says_so_and_is_no_number():
    found = transient(free(mesh_damping=array(np.nan)), TIMES, rate=RATE)
    assert found.status.code == Code.NOT_CONVERGED
    assert np.all(np.isnan(np.asarray(found.rate)[:, -1]))
    assert np.all(np.isnan(np.asarray(found.energy.kinetic)[-1:]))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"mesh_damping": array(-3e4)}, "damping of the mesh is not negative, got -30000"),
        (
            {"relaxation": array(-1e-2)},
            "relaxation time of the contacts is not negative, got -0.01",
        ),
    ],
)
def test_damping_that_drives_is_refused(changes, told):
    """It grew to 1e138 rad/s, energy balanced, as a solution that was found."""
    with pytest.raises(InputError, match=told):
        transient(free(**changes), TIMES, rate=RATE)
