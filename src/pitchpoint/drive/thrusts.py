"""Axial forces of helical gears on the bodies of a train, and the moment by which they tilt its planets."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import sin

from pitchpoint.drive.kinematics import Link
from pitchpoint.gears.pairs import planet_gears

__all__ = ["AxialLoads", "axial_loads"]


@dataclass(frozen=True)
class AxialLoads:
    """What helical teeth ask of the bearings of a train.

    Attributes:
        thrusts: of the teeth along the axis of each body, by all that it meshes with, of one planet [N];
            those of one sense are positive, which one hangs on hands and sense of the torque.
        tilting: size of the moment on one planet about the tangent of the circle of the pins [N m]; bearings
            of the planet bear it as a couple, beside the force on the pin.
    """

    thrusts: Mapping[str, float]
    tilting: float


def axial_loads(
    links: Sequence[Link],
    planets: Sequence[str],
    torques: Sequence[Mapping[str, float]],
    copies: Sequence[int],
) -> AxialLoads:
    """Axial loads of a train of involute gears.

    Args:
        links: its meshes.
        planets: bodies of which there are several.
        torques: of each mesh on its two bodies, all of its copies together [N m], see `TrainTorques.shares`.
        copies: of each mesh.

    The axial force is F_t tan β = 2 T sin β / (z m_n), opposite on both gears. Gears of one planet have the
    same hand and lie in one plane: forces across the axes of stepped planets, which tilt them too, are left
    out.

    From the helix: axial over tangential force is tan(beta).
    """
    thrusts: dict[str, float] = {}
    tilting = 0.0
    for link, shares, count in zip(links, torques, copies, strict=True):
        mesh = planet_gears(link.mesh)
        if mesh is None:
            continue
        teeth = [float(number) for number in mesh.teeth]
        # The planet, else the first gear, has the hand that counts as positive.
        leading = next((k for k, body in enumerate(link.bodies) if body in planets), 0)
        both = 2.0 * shares[link.bodies[leading]] * sin(float(mesh.helix_angle))
        force = both / (count * abs(teeth[leading]) * float(mesh.module))
        for member, body in enumerate(link.bodies):
            times = (1 if body in planets else count) * (1.0 if member == leading else -1.0)
            thrusts[body] = thrusts.get(body, 0.0) + times * force
        if link.bodies[leading] in planets:
            radius = float(mesh.centre_distance) * abs(teeth[leading] / sum(teeth))
            tilting += force * (radius if mesh.internal else -radius)
    return AxialLoads(thrusts, abs(tilting))
