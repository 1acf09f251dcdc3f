"""The case of Xu et al. (2021) and its curvature and speed."""

from functools import cache

import numpy as np

from pitchpoint.cases.library import find_case
from pitchpoint.cases.variant import Variant
from pitchpoint.published.xu2021.printed import (
    BETA,
    TEMPERATURE_0,
    curvature_radii,
    mapped_radius,
    mesh_point_speed,
)

NAME, TREE = find_case("xu2021")
VARIANTS = {name: Variant(TREE, NAME, name) for name in ("as_published", "physical")}
RADII = (0.1 / 2.0 * np.cos(np.pi / 9.0), 0.101 / 2.0 * np.cos(np.pi / 9.0))
END = np.pi / 8.0
OIL = {"viscosity_0": 0.04, "alpha": 2.2e-8, "beta": BETA, "temperature_0": TEMPERATURE_0}


@cache
def case(variant="as_published"):
    return VARIANTS[variant].built({}).case


# ------------------------------------------------------------------ curvature and speed


def mapped(angle):
    return mapped_radius(
        angle=angle,
        map_angle=(0.0, END),
        map_distance=(-0.9, 0.9),
        pitch_radius=50e-3,
        module=0.5e-3,
    )


def curvature(angle):
    distance = mapped(angle)
    radial = 0.5e-3 * np.cos(2.0 * np.asarray(angle))
    return curvature_radii(distance=distance, radial=radial, base_radius=RADII)


def speed(angle, sense):
    return mesh_point_speed(
        angle=angle,
        distance=mapped(angle),
        base_radius=RADII[0],
        deflection=0.5e-3,
        teeth=(200.0, 202.0),
        wave_speed=100.0 * np.pi,
        sense=sense,
    )
