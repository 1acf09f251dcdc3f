"""A ball on a disc from its table in a case file."""

from typing import Any

from pitchpoint._jax import array
from pitchpoint.gears.ball_on_disc.mesh import BallOnDisc
from pitchpoint.gears.ball_on_disc.table import BallOnDiscRig
from pitchpoint.gears.family import Family
from pitchpoint.gears.mesh import Mesh

__all__ = ["FAMILY"]


def _ball_on_disc(rig: BallOnDiscRig, slices: int) -> tuple[Mesh, tuple[str, ...]]:
    across = rig.transverse_radius or rig.ball_radius
    mesh = BallOnDisc(
        radius=array([rig.ball_radius, across]),
        track_radius=array(rig.track_radius),
        slide_roll_ratio=array(rig.slide_roll_ratio),
    )
    return mesh, (NARROW,) if across < rig.ball_radius else ()


NARROW = (
    "The contact is narrower across the track than along it, and laws of the film on ellipses were fitted "
    "to round and wider ones."
)


def _of_ball(rig: BallOnDiscRig, mesh: BallOnDisc) -> dict[str, Any]:
    return {"transverse_radius": mesh.radius[1]}


FAMILY = Family(_ball_on_disc, _of_ball)
