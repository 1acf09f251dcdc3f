"""Formulas as Zhao et al. (2022) print them, beside what their derivation asks for."""

from math import atan, cos, pi, sin, sqrt, tan

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.gears.strain_wave.flexspline_tooth import (
    DoubleArcFlank,
    FlexsplineFlank,
    InvoluteFlank,
)
from pitchpoint.gears.strain_wave.table import StrainWaveGears
from pitchpoint.published.publication import ReadingPoint

__all__ = [
    "arc_distance",
    "closure_residual",
    "deflection_offset",
    "half_zone_forces",
    "largest_tangential_load",
    "printed_tooth_forces",
    "readings",
    "recovered_torque",
]

Array = NDArray[np.float64]

HALF_ZONE = pi / 5.0
"""Angle from the largest load to the end of a zone [rad], the swing angle of section 4.2."""

ENGAGED_HEIGHT = 2.0
"""Height of the teeth in mesh h_ad [modules]; eq. 17 gives no value."""


def largest_tangential_load(
    *, torque: float, half_zone: float, diameter: float, face_width: float
) -> float:
    """Largest tangential load q_tmax per face width and per length along the ring, eq. 16 [N/m2].

    Args:
        torque: carried by the flexspline [N m].
        half_zone: phi_2 = phi_3, from the largest load to the end of the zone [rad].
        diameter: d_d at which the teeth touch, eq. 17 [m].
        face_width: [m].
    """
    return pi * torque / (2.0 * half_zone * diameter**2 * face_width)


def half_zone_forces(
    *, load: float, half_zone: float, step: float, diameter: float, face_width: float
) -> Array:
    """Tangential force of each tooth of one half zone, eq. 19 with 1/(2 phi_2) in the cosine [N].

    Args:
        load: q_tmax [N/m2].
        half_zone: phi_2 [rad].
        step: pitch of the teeth [rad].
        diameter: d_d [m]; eqs. 18 and 19 take other diameters than eq. 16, which opens the balance.
        face_width: [m].

    Returns:
        Forces from the end of the zone to its middle, shape (tooth). The reverse order puts the
        largest force on the first point, as the text on wear of the tip asks for.
    """
    place = _places(half_zone, step)
    return face_width * diameter / 2.0 * load * np.cos(pi * place / (2.0 * half_zone)) * step


def printed_tooth_forces(
    *, load: float, half_zone: float, step: float, diameter: float, face_width: float
) -> Array:
    """The same by eq. 19 as printed: 1/(2 phi_2) multiplies the cosine, the first are negative [N]."""
    place = _places(half_zone, step)
    return face_width * diameter / 2.0 * load * np.cos(pi * place) * step / (2.0 * half_zone)


def _places(half_zone: float, step: float) -> Array:
    """Angle from the largest load to the middle of each pitch of a half zone, from its end [rad]."""
    count = round(half_zone / step)
    return np.asarray(half_zone - (np.arange(count) + 0.5) * step)


def recovered_torque(*, forces: ArrayLike, diameter: float) -> float:
    """Torque that the tooth forces of four half zones carry, by eq. 15 with a sum [N m].

    Args:
        forces: tangential, of one half zone, shape (tooth) [N].
        diameter: d_d [m].
    """
    return float(4.0 * np.sum(forces) * diameter / 2.0)


def deflection_offset(*, angle: ArrayLike, radius: float, deflection: float) -> Array:
    """Turn of a tooth by the oval shape of the ring, eq. 27 [rad].

    Args:
        angle: from the long axis of the wave generator, below pi/2, shape (...) [rad].
        radius: of the round neutral line [m].
        deflection: w0; the half axes are radius plus and minus it [m].
    """
    ratio = (radius + deflection) / (radius - deflection)
    return np.asarray(np.arctan(ratio * np.tan(angle)) - angle)


def arc_distance(*, radius: float, boundary: float, angle: ArrayLike) -> Array:
    """Distance of eqs. 22 and 24 as printed, negative within the bounds printed beside them [m].

    Args:
        radius: rho_a or rho_f [m].
        boundary: theta_B of the convex, theta_D of the concave arc [rad].
        angle: theta_k, shape (...) [rad].
    """
    return np.asarray(radius * (boundary - np.asarray(angle)))


def closure_residual(
    *, flank: DoubleArcFlank, theta_c: float, convex_offset: float | None = None
) -> float:
    """Height by which the tangent misses the concave arc in eq. 4 [m].

    Args:
        flank: its theta_B is that of the closed tangent.
        theta_c: flank angle of the concave arc's end [rad]; eq. 4 prints pi + theta_B.
        convex_offset: the centre of the convex arc stands at x = -convex_offset [m]; that of the
            flank where it is not given, its negative as eq. 1 prints it.
    """
    offset = float(flank.convex_offset) if convex_offset is None else convex_offset
    theta_b, rho_f = float(flank.tangent_angle), float(flank.concave_radius)
    start_x = float(flank.convex_radius) * cos(theta_b) - offset
    start_y = float(flank.convex_radius) * sin(theta_b) - float(flank.convex_shift)
    end_x = float(flank.pitch) / 2.0 + float(flank.concave_offset) - rho_f * cos(theta_c)
    end_y = float(flank.concave_shift) - rho_f * sin(theta_c)
    return start_y - (end_x - start_x) / tan(theta_b) - end_y


def readings(point: ReadingPoint) -> dict[str, float]:
    """What the formulas give for a case, under the names of result variables."""
    gears, design, operation = point.gears, point.design, point.operation
    mesh = design.mesh
    assert isinstance(gears, StrainWaveGears)
    assert isinstance(mesh, StrainWave)
    torque = float(operation.load)
    diameter = gears.module * (gears.teeth[0] - ENGAGED_HEIGHT)
    zone = {"half_zone": HALF_ZONE, "diameter": diameter, "face_width": gears.face_width}
    load = largest_tangential_load(torque=torque, **zone)
    step = 2.0 * pi / gears.teeth[0]
    closed = half_zone_forces(load=load, step=step, **zone)
    printed = printed_tooth_forces(load=load, step=step, **zone)
    return {
        "largest_tangential_load": load,
        "largest_tooth_force": float(closed.max()),
        "recovered_torque": recovered_torque(forces=closed, diameter=diameter),
        "printed_least_tooth_force": float(printed.min()),
        "printed_recovered_torque": recovered_torque(forces=printed, diameter=diameter),
        **_flank(mesh),
        **_offsets(mesh, HALF_ZONE - step / 2.0),
    }


def _flank(mesh: StrainWave) -> dict[str, float]:
    """Dimensions of the flank, were its tip not rounded."""
    flank = mesh.flank
    return _double_arc(flank) if isinstance(flank, DoubleArcFlank) else _involute(flank)


def _double_arc(flank: DoubleArcFlank) -> dict[str, float]:
    theta_a, theta_b = float(flank.tip_angle), float(flank.tangent_angle)
    convex = float(flank.convex_radius)
    at_tip = arc_distance(radius=convex, boundary=theta_b, angle=theta_a)
    concave = float(flank.concave_radius * (flank.root_angle - flank.tangent_angle))
    return {
        "tangent_angle": theta_b,
        "tip_land": float(flank.tip_land),
        "flank_length": convex * (theta_a - theta_b) + float(flank.tangent_length) + concave,
        "printed_sliding_distance": float(at_tip),
        "printed_closure_residual": closure_residual(flank=flank, theta_c=pi + theta_b),
    }


def _involute(flank: FlexsplineFlank) -> dict[str, float]:
    assert isinstance(flank, InvoluteFlank)
    return {
        "involute_tip_radius": float(flank.tip_radius),
        "involute_root_radius": float(flank.root_radius),
        "involute_pitch_thickness": float(flank.pitch_thickness),
        "tip_land": float(flank.tip_land),
    }


def _offsets(mesh: StrainWave, end: float) -> dict[str, float]:
    """Offset of the outermost tooth of a zone and the largest of all."""
    radius, deflection = float(mesh.line.radius), float(mesh.line.deflection)
    ring = {"radius": radius, "deflection": deflection}
    steepest = atan(sqrt((radius - deflection) / (radius + deflection)))
    return {
        "tooth_offset": float(deflection_offset(angle=end, **ring)),
        "largest_tooth_offset": float(deflection_offset(angle=steepest, **ring)),
    }
