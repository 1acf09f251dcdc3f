"""Cylindrical pairs, and their teeth drawn as polygons."""

import dataclasses

import equinox as eqx
import numpy as np

from pitchpoint._jax import jnp
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.nominal_motion import mesh_ends, nominal_motion

ANGLE = np.deg2rad(20.0)
MODULE = 2e-3


def pair(teeth, degrees=0.0, module=MODULE, width=20e-3, **options):
    return build_cylindrical_pair(
        teeth=teeth,
        module=module,
        pressure_angle=ANGLE,
        helix_angle=np.deg2rad(degrees),
        face_width=width,
        **options,
    )


def plain(mesh, lanes=2, slices=1):
    """The same pair with what is static made alike, so that few programs are compiled."""
    alike = {"follows": (False, False), "shortened": (False, False)}
    return dataclasses.replace(mesh, lanes=lanes, slices=slices if mesh.helical else 1, **alike)


@eqx.filter_jit
def _figures(mesh):
    names = (
        *("transverse_pressure_angle", "working_pressure_angle", "base_helix_angle"),
        *("centre_distance", "tip_alteration", "tip_radii", "base_radii", "base_pitch", "limits"),
        *("points", "tangent_length", "pitch_position", "transverse_contact_ratio"),
        *("overlap_ratio", "contact_ratio", "module", "teeth", "working_radii"),
        *("backlash", "normal_backlash", "zero_backlash_centre_distance"),
    )
    of_gears = (
        *("reference_radius", "root_radius", "form_roll_length", "tip_thickness", "undercut_limit"),
        *("profile_shift", "pitch_half_angle", "root_land_angle"),
    )
    found = {name: getattr(mesh, name) for name in names}
    found["motion"] = nominal_motion(mesh, *mesh_ends(mesh))
    return found | {name: jnp.stack([getattr(g, name) for g in mesh.gears]) for name in of_gears}


def figures(mesh):
    return {name: np.asarray(value) for name, value in _figures(plain(mesh)).items()}


@eqx.filter_jit
def _outline(gear, count):
    return gear.outline(count=count)


class Tooth:
    """Half a tooth drawn by `outline`: half its angle over the radius, from the root to the tip."""

    def __init__(self, gear, count=160):
        points = np.asarray(_outline(gear, count))[: 4 * count]
        radius, half = np.hypot(*points.T), -np.arctan2(*points.T)
        self.side, self.teeth, self.count = gear.side, round(abs(float(gear.teeth))), count
        self.root, self.tip = radius[0], radius[-1]
        self.fillet, self.flank = (
            (radius[at], half[at]) for at in (slice(count, 2 * count), slice(2 * count, 3 * count))
        )
        self.radius, self.angle = radius[count : 3 * count], half[count : 3 * count]

    def half_angle(self, radius):
        # Towards the root the fillet follows its circle: the angle grows like a square root there.
        above, given = (np.sqrt(np.abs(r - self.root)) for r in (radius, self.radius))
        order = np.argsort(given, kind="stable")
        return np.interp(above, given[order], self.angle[order])

    def corners(self, axis, count=21):
        """All points of the flanks, fillets and tips of a whole gear, whose centre is the origin."""
        across = np.linspace(-1.0, 1.0, count) * self.angle[-1]
        radius = np.concatenate([self.radius, self.radius, np.full(count, self.tip)])
        angle = np.concatenate([self.angle, -self.angle, across])
        turned = 2.0 * np.pi * np.arange(self.teeth) / self.teeth
        return (radius * np.exp(1j * (angle + axis + turned[:, None]))).ravel()

    def depth(self, points, axis):
        """How far points lie inside the gear's material; negative outside [m]."""
        radius, pitch = np.abs(points), 2.0 * np.pi / self.teeth
        points, radius = (
            points[(self.tip - radius) * self.side > 0.0],
            radius[(self.tip - radius) * self.side > 0.0],
        )
        away = np.abs(np.mod(np.angle(points) - axis + pitch / 2.0, pitch) - pitch / 2.0)
        inside = np.minimum(
            (self.half_angle(radius) - away) * radius, (self.tip - radius) * self.side
        )
        return np.maximum(inside, (self.root - radius) * self.side)


def placed(mesh, found, position):
    """Angles of a tooth axis of each gear whose flanks touch at a position, and the second centre."""
    side = np.sign(found["teeth"][1])
    direction = np.exp(-1j * found["working_pressure_angle"])
    centre = side * found["centre_distance"]
    point = direction * (found["base_radii"][0] + 1j * position)
    half = [
        float(g.half_thickness_angle(jnp.asarray(r)))
        for g, r in zip(mesh.gears, (abs(point), abs(point - centre)), strict=True)
    ]
    return np.angle(point) - half[0], np.angle(point - centre) - side * half[1], centre


def overlap(mesh, phases=6):
    """Deepest overlap of the two drawn gears over one pitch of rotation [modules]."""
    found = figures(mesh)
    first, second = (Tooth(g) for g in mesh.gears)
    deepest = -np.inf
    axes = placed(mesh, found, found["points"][2])
    side, centre = np.sign(found["teeth"][1]), axes[2]
    for phase in np.arange(phases) / phases:
        turn = 2.0 * np.pi * phase
        axis = axes[0] + turn / first.teeth, axes[1] - side * turn / second.teeth
        into_second = second.depth(first.corners(axis[0]) - centre, axis[1])
        into_first = first.depth(second.corners(axis[1]) + centre, axis[0])
        deepest = max(deepest, into_second.max(initial=-1.0), into_first.max(initial=-1.0))
    return deepest / float(found["module"])
