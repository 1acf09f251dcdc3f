"""How much room the gears of a drive take: the diameter around them, and their length."""

from typing import Any, NamedTuple

import numpy as np

from pitchpoint.cases.built_drive import Ready
from pitchpoint.gears.mesh import has
from pitchpoint.gears.rated_pair import rated_pair

__all__ = ["Envelope", "gear_envelope", "set_diameter"]


class Envelope(NamedTuple):
    """Room that gears take, without housing, shafts and carriers.

    Attributes:
        diameter: of the circle around them [m].
        length: along their axes [m].
    """

    diameter: float
    length: float


def gear_envelope(built: Ready) -> Envelope | None:
    """Room for the gears of a drive; None of gears whose circles nobody knows.

    Lines of centres of pairs in a row turn back at each shaft; a row with a set or a strain wave gear is on
    one axis. Strain wave gears reach to the outside of the circular spline, and their cup is their length.

    Args:
        built: the case.
    """
    stages = (built,) if 0 in built.trains or not built.stages else built.stages
    each = [_of_stage(stage) for stage in stages]
    known = [room for room in each if room is not None]
    if len(known) < len(each):
        return None
    paired = not any(stage.trains for stage in stages) and all(
        has(mesh.design.mesh, rated_pair) for mesh in built.meshes
    )
    across = _of_pairs(stages) if paired else max(room.diameter for room in known)
    return Envelope(across, sum(room.length for room in known))


def set_diameter(train: Any) -> float:
    """Diameter around the gears of a set [m]: its rings with their rims, or its planets.

    Args:
        train: the set, as built.
    """
    reached = 0.0
    for mesh in train.meshes:
        pair = rated_pair(mesh.design.mesh)
        ring = float(pair.teeth[1]) < 0.0
        tip = float(pair.tip_radii[0 if ring else 1])
        around_planets = float(mesh.dimensions["centre_distance"]) + tip
        rim = float(np.abs(pair.root_radii[1]) + pair.rim_thickness[1]) if ring else 0.0
        reached = max(reached, around_planets, rim)
    return 2.0 * reached


def _of_stage(stage: Any) -> Envelope | None:
    if stage.trains:
        widths: dict[int, float] = {}
        for place, mesh in zip(stage.design.meshes, stage.meshes, strict=True):
            width = float(rated_pair(mesh.design.mesh).face_width)
            widths[place.planet_gear] = max(width, widths.get(place.planet_gear, 0.0))
        return Envelope(set_diameter(stage), sum(widths.values()))
    if has(stage.design.mesh, rated_pair):
        pair = rated_pair(stage.design.mesh)
        apart = float(stage.dimensions["centre_distance"])
        return Envelope(float(np.sum(pair.tip_radii)) + apart, float(pair.face_width))
    room = stage.family.envelope
    return None if room is None else Envelope(*room(stage.case.gears, stage.design.mesh))


def _of_pairs(stages: Any) -> float:
    """Diameter around pairs in a row [m]."""
    place, sense, low, high = 0.0, 1.0, np.inf, -np.inf
    for stage in stages:
        after = place + sense * float(stage.dimensions["centre_distance"])
        tips = np.abs(np.asarray(rated_pair(stage.design.mesh).tip_radii))
        for shaft, radius in zip((place, after), tips, strict=True):
            low, high = min(low, shaft - radius), max(high, shaft + radius)
        place, sense = after, -sense
    return float(high - low)
