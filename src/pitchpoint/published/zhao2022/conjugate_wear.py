"""Wear of the flexspline's flank where it touches its envelope: what the discrete model of the paper lacks.

Sliding is that of the conjugate kinematics, and the contact passes a point as fast as it moves over the
flank: an engagement wears k F/b times sliding over rolling. Flanks stay as they are.
"""

from math import pi

import numpy as np
from numpy.typing import NDArray

from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.conjugate import of_sharp_flank
from pitchpoint.published.publication import Point, Read
from pitchpoint.published.zhao2022.printed import (
    ENGAGED_HEIGHT,
    HALF_ZONE,
    largest_tangential_load,
)
from pitchpoint.published.zhao2022.publication import BRANCHES
from pitchpoint.published.zhao2022.table import ConjugateWear

__all__ = ["readings"]

Array = NDArray[np.float64]


def readings(point: Point) -> Read:
    """Depths along the flank on both branches, for a case with a table for them.

    Points count where the relative radius is positive and the zone of 36 degrees reaches.
    """
    given, mesh = point.formulas, point.design.mesh
    if not isinstance(given, ConjugateWear):
        return {}
    assert isinstance(mesh, StrainWave)
    found = of_sharp_flank(mesh)
    angle, along = found["angle"], found["along"][0]
    touches = (found["radius"] > 0.0) & (np.abs(angle) < HALF_ZONE)
    slides = np.abs(found["sliding"] / found["rolling"])
    worn = given.rate * given.cycles * _line_load(point, angle) / np.cos(found["lean"]) * slides
    depth, way = np.where(touches, worn, np.nan), along[-1] - along
    each = [_of_branch(*one, way) for one in zip(BRANCHES, depth, angle, strict=True)]
    return {"conjugate_way": way} | each[0] | each[1]


def _line_load(point: Point, angle: Array) -> Array:
    """Tangential force of a tooth per face width by eq. 19 closed, at any angle from the long axis [N/m]."""
    gears = point.gears
    assert isinstance(gears, StrainWaveGears)
    diameter = gears.module * (gears.teeth[0] - ENGAGED_HEIGHT)
    load = largest_tangential_load(
        torque=float(point.operation.load),
        half_zone=HALF_ZONE,
        diameter=diameter,
        face_width=gears.face_width,
    )
    pitch = 2.0 * pi / gears.teeth[0]
    return np.asarray(diameter / 2.0 * load * pitch * np.cos(pi * angle / (2.0 * HALF_ZONE)))


def _of_branch(name: str, depth: Array, angle: Array, way: Array) -> dict[str, "float | Array"]:
    """Course and largest depth of a branch, and where; NaN where nothing of it touches."""
    known = np.isfinite(depth)
    most = int(np.nanargmax(depth)) if known.any() else 0
    there = {
        "depth": depth,
        "angle": np.where(known, angle, np.nan),
        "way": np.where(known, way, np.nan),
    }
    return {
        f"conjugate_course_{name}": depth,
        **{f"conjugate_{one}_{name}": float(values[most]) for one, values in there.items()},
    }
