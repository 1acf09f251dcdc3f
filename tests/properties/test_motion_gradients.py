"""Derivatives of a motion with friction against central differences."""

import dataclasses

import equinox as eqx
import numpy as np
import pytest

from pitchpoint._jax import array, jax, jnp
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.grid import PeriodGrid
from pitchpoint.dynamics.moving_bodies import Body
from pitchpoint.dynamics.passage import sampled
from pitchpoint.dynamics.right_hand_side import MovingMesh
from pitchpoint.dynamics.steady_motion import periodic_motion
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.families import built_gears
from pitchpoint.gears.torus.table import TorusGears
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
CONSTANT = next(law for law in LAWS if law.name == "constant")
OWN = Models(
    (CONSTANT,),
    array(0),
    {"constant": {"coefficient": array(0.05)}},
    LOAD_SHARING["from_stiffness"],
    ROLLING_RESISTANCE["none"],
)
OPERATION = Operation(*map(array, (100.0, 100.0, 328.15)))
TABLE = {
    "family": "torus",
    "teeth": [40, 49],
    "module": "2.5 mm",
    "face_width": ["15 mm", "20 mm"],
    "torus_radius": ["35 mm", "55 mm"],
}
STEP = 1e-3
TIGHT = 1e-13
"""Steps are those of the motion; where its friction reverses they know the derivative far worse."""


def design():
    mesh = built_gears(TorusGears.model_validate(TABLE), 6)[0]
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.8e-6))


def swing(own, factors):
    """RMS of the transmission error; factors of inertia, damping and the torus radius of gear 1."""
    inertia, damped, radius = factors
    radii = own.mesh.torus_radii * jnp.stack([radius, jnp.ones(())])
    own = dataclasses.replace(own, mesh=eqx.tree_at(lambda m: m.torus_radii, own.mesh, radii))
    moving = MovingMesh(
        own,
        OPERATION,
        OWN,
        (Body(jnp.inf), Body(6e-3 * inertia, 100.0)),
        knots=array([0.0]),
        phase=array(0.0),
        creep=array(1e-2),
        relaxation=array(0.0),
        law=CONTACT_LAWS["linear"],
        mesh_damping=800.0 * damped,
        passage=sampled(own, OPERATION, OWN.compliance),
    )
    found = periodic_motion(moving, OPERATION.speed, PeriodGrid(4, 16), tolerance=TIGHT)
    return found.rms(found.transmission_error)


@eqx.filter_jit
def with_slope(own, factors):
    def twice(given):
        value = swing(own, given)
        return value, value

    return jax.jacfwd(twice, has_aux=True)(factors)


@pytest.mark.whole
def test_derivatives_by_inertia_damping_and_torus_radius_are_those_of_differences():
    """Differences of two steps, extrapolated."""
    own, middle = design(), np.ones(3)
    slope, value = with_slope(own, middle)
    assert float(value) > 0.0

    def difference(way):
        high, low = (with_slope(own, middle + sign * way)[1] for sign in (1.0, -1.0))
        return float(high - low) / (2.0 * np.max(way))

    for one, way in zip(slope, np.eye(3), strict=True):
        near, far = difference(STEP * way), difference(2.0 * STEP * way)
        np.testing.assert_allclose(one, (4.0 * near - far) / 3.0, rtol=1e-6)
