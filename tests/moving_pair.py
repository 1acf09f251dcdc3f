"""A spur pair in motion with all effects at once, for files that move it."""

import numpy as np

from pitchpoint._jax import array
from pitchpoint.dynamics.dynamics_registry import CONTACT_LAWS
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.passage import passage
from pitchpoint.dynamics.right_hand_side import MovingMesh
from pitchpoint.efficiency.quasi_static import Design, Models, Operation
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.loading.loading_registry import LOAD_SHARING
from pitchpoint.lubrication.lubrication_registry import LAWS, ROLLING_RESISTANCE
from pitchpoint.materials import lubricants, solids
from pitchpoint.materials.surfaces import Roughness

STEEL = solids.find("steel").build()
LAW = {law.name: law for law in LAWS}
XU = Models(
    (LAW["xu_2007"],),
    array(0),
    {},
    LOAD_SHARING["from_stiffness"],
    ROLLING_RESISTANCE["wu_cheng_1991"],
)
LOAD, SPEED = 100.0, 100.0
INERTIA = (1e-3, 6e-3)
OPERATION = Operation(*map(array, (LOAD, SPEED, 328.15)))


def design():
    mesh = build_cylindrical_pair(
        teeth=(18, 36),
        module=3e-3,
        pressure_angle=np.deg2rad(20.0),
        face_width=26.7e-3,
    )
    oil = lubricants.find("pao-vg-220").build()
    return Design(mesh, (STEEL, STEEL), oil, Roughness.from_composite_rq(0.8e-6))


PAIR = design()
WAY = passage(PAIR, OPERATION, XU.compliance)


def moving(bodies, **given):
    """Teeth that may part, with friction and rolling resistance by regressions of films."""
    values = {
        "knots": array([0.0]),
        "phase": array(0.0),
        "creep": array(1e-3),
        "relaxation": array(1e-6),
        "passage": WAY,
        "law": CONTACT_LAWS["separating"],
        "error": ErrorOrders([2e-6, 1e-6], [0.5, 1.0], [0.3, 0.0]),
        "mesh_damping": array(800.0),
    }
    return MovingMesh(PAIR, OPERATION, XU, tuple(bodies), **values | given)


def relative(found, expected):
    return np.max(np.abs(np.asarray(found) - np.asarray(expected))) / np.ptp(np.asarray(expected))
