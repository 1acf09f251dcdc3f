"""Contacts of which a test sets what it looks at, and conditions at one."""

import numpy as np

from pitchpoint._jax import array
from pitchpoint.contact.contacts import Contacts
from pitchpoint.lubrication.conditions import Conditions


def line_contacts(**given):
    """Contacts that lie at the origin, their normals and tangents along x and y."""
    lanes = np.shape(given["path"])
    axes = np.zeros((2, 3, *lanes))
    axes[0, 0] = axes[1, 1] = 1.0
    frame = {"point": np.zeros((3, *lanes)), "direction": axes[0], "tangent": axes[1]}
    return Contacts(
        **{name: array(value) for name, value in {**frame, **given}.items()}, shape="line"
    )


def conditions(shape, **changed):
    """A steel contact of 50 N, 9.525 mm both ways, all else one but what is changed."""
    one = array(np.ones((1, 1)))
    curvature = array(np.array([[0.0, 0.0], [1.0, 1.0]])[..., None, None] / 9.525e-3)
    contacts = Contacts(
        active=array(np.ones((1, 1), bool)),
        path=one,
        width=one,
        weight=one,
        curvature=curvature,
        surface=array(np.ones((2, 3, 1, 1))),
        normal=array(np.ones((3, 1, 1))),
        gap=one,
        flank=array(np.ones((2, 1, 1))),
        **dict.fromkeys(("point", "direction", "tangent"), array(np.ones((3, 1, 1)))),
        shape=shape,
    )
    scalars = dict.fromkeys(
        ("nominal_load", "speed", "viscosity", "kinematic_viscosity", "pressure_viscosity"),
        array(1.0),
    )
    scalars |= dict.fromkeys(
        ("temperature", "viscosity_slope", "conductivity", "lubricant_factor"), array(1.0)
    )
    scalars |= dict.fromkeys(("roughness_ra", "roughness_rq", "hardness"), array(1.0))
    scalars |= {"slip": one, "roll": one, "modulus": array(226e9)}
    scalars |= {name: array(value) for name, value in changed.items()}
    load = array(np.full((1, 1), 50.0))
    return Conditions(contacts=contacts, load=load, reference=None, **scalars)
