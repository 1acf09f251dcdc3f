"""Gear trains of which the tooth numbers alone count, for tests."""

from dataclasses import replace
from functools import cache

import numpy as np

from pitchpoint._jax import array
from pitchpoint.drive.kinematics import HOUSING, Link
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair

EFFICIENCIES = (0.99, 0.995, 0.995)


@cache
def _external():
    return build_cylindrical_pair(
        teeth=(24, 30), module=2e-3, pressure_angle=np.deg2rad(20.0), face_width=0.02
    )


def pair(first, second):
    """A pair of which the tooth numbers alone count here; rings have a negative one."""
    return replace(_external(), teeth=array(np.array([first, second], float)))


def link(first, second, bodies, carrier=HOUSING):
    return Link(pair(first, second), bodies, carrier)


def planetary(sun, planet, ring):
    return [
        link(sun, planet, ("sun", "planet"), "carrier"),
        link(planet, -ring, ("planet", "ring"), "carrier"),
    ]


def stepped(first, planet, second_planet, second):
    """Two central gears, a negative number for a ring, about planets of two gears."""
    return [
        link(first, planet, ("first", "planet"), "carrier"),
        link(second_planet, second, ("planet", "second"), "carrier"),
    ]


def three_k(sun, planet, ring, second_planet, second_ring):
    return [
        *planetary(sun, planet, ring),
        link(second_planet, -second_ring, ("planet", "output ring"), "carrier"),
    ]
