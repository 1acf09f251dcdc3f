"""Transients of many operating points at once, and of what cannot move so."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest
from moving_pair import INERTIA, LOAD, PAIR, SPEED, moving, relative

from pitchpoint._jax import array, jax, jnp
from pitchpoint.core.status import Code
from pitchpoint.dynamics.moving_bodies import Body
from pitchpoint.dynamics.transient import transient, transient_motion
from pitchpoint.errors import InputError

TIMES = array(np.linspace(0.0, 0.01, 21))
RATE = SPEED * np.asarray(PAIR.motion)


def free(load=LOAD, **given):
    bodies = Body(INERTIA[0], [0.55 * load]), Body(INERTIA[1], [load])
    return moving(bodies, **{"creep": array(1e-2)} | given)


@eqx.filter_jit
def together(own, loads):
    def one(load):
        bodies = [
            dataclasses.replace(body, torque=body.torque * load / LOAD) for body in own.bodies
        ]
        given = dataclasses.replace(own, bodies=tuple(bodies))
        return transient_motion(given, TIMES, jnp.zeros(2), jnp.asarray(RATE))

    return jax.vmap(one)(loads)


@pytest.mark.whole
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
