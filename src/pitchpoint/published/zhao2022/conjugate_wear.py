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
from pitchpoint.published.publication import Read, ReadingPoint
from pitchpoint.published.zhao2022.printed import (
    ENGAGED_HEIGHT,
    HALF_ZONE,
    largest_tangential_load,
)
from pitchpoint.published.zhao2022.publication import BRANCHES
from pitchpoint.published.zhao2022.table import ConjugateWear

__all__ = ["readings"]

Array = NDArray[np.float64]


def readings(point: ReadingPoint) -> Read:
    """Depths along the flank on both branches, for a case with a table for them.

    Points count where the relative radius is positive and the zone of 36 degrees reaches.
    """
    table, mesh = point.formulas, point.design.mesh
    if not isinstance(table, ConjugateWear):
        return {}
    assert isinstance(mesh, StrainWave)
    points = of_sharp_flank(mesh)
    angle, along = points["angle"], points["along"][0]
    touches = (points["radius"] > 0.0) & (np.abs(angle) < HALF_ZONE)
    slides = np.abs(points["sliding"] / points["rolling"])
    worn = table.rate * table.cycles * _line_load(point, angle) / np.cos(points["lean"]) * slides
    depth, from_tip = np.where(touches, worn, np.nan), along[-1] - along
    branches = [
        _of_branch(*branch, from_tip) for branch in zip(BRANCHES, depth, angle, strict=True)
    ]
    return {"conjugate_way": from_tip} | branches[0] | branches[1]


def _line_load(point: ReadingPoint, angle: Array) -> Array:
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


def _of_branch(
    name: str, depth: Array, angle: Array, from_tip: Array
) -> dict[str, "float | Array"]:
    """Course and largest depth of a branch, and where; NaN where nothing of it touches."""
    touching = np.isfinite(depth)
    most = int(np.nanargmax(depth)) if touching.any() else 0
    there = {
        "depth": depth,
        "angle": np.where(touching, angle, np.nan),
        "way": np.where(touching, from_tip, np.nan),
    }
    return {
        f"conjugate_course_{name}": depth,
        **{f"conjugate_{key}_{name}": float(values[most]) for key, values in there.items()},
    }
