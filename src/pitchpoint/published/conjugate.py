"""Where flanks of a strain wave drive touch their envelope, for publications on its meshing zones."""

from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Array, Float

from pitchpoint._jax import jax, jnp
from pitchpoint.core.programs import program
from pitchpoint.gears.strain_wave.drive import StrainWave
from pitchpoint.published.publication import ReadingPoint

__all__ = ["of_sharp_flank", "readings"]

PLACES = 121
"""Points of the flank at which its conjugate branches are looked for."""

BRANCHES = ((-5.0, 10.0), (10.0, 65.0))
"""Angles between which the deep and the outer branch lie [deg]."""

_STEP = 0.25  # deg
_NEWTON_STEPS = 5
_TOUCHING = 1e-5  # modules

Points = Float[Array, "branch place"]


def readings(point: ReadingPoint) -> dict[str, float]:
    """Where points of the flank touch their envelope, how they roll on it, and what the groove leaves of it.

    Every point does so twice, deep in the space near the long axis and again on its way out. Ends are
    those of the flank without the rounding of its tip.
    """
    mesh = point.design.mesh
    assert isinstance(mesh, StrainWave)
    points = of_sharp_flank(mesh)
    # Where its rounded tip reaches its mate.
    clearance = jax.device_get(_branches(mesh))["clearance"]
    wave, flexspline, _ = np.asarray(point.design.motion)
    rate = abs(float(flexspline - wave))
    (deep, outer), (r_deep, r_outer) = points["angle"], points["radius"]
    entrainment = points["rolling"][0] + points["sliding"][0] / 2.0
    speed = np.abs(entrainment) * rate * float(point.operation.speed)
    return {
        "phase_rate": rate,
        "deep_angle_first": float(np.nanmin(deep)),
        "deep_angle_last": float(np.nanmax(deep)),
        "deep_radius_root": float(r_deep[0]),
        "deep_radius_tip": float(r_deep[-1]),
        "deep_entrainment_root": float(speed[0]),
        "deep_entrainment_tip": float(speed[-1]),
        "outer_angle_first": float(np.nanmin(outer)),
        "outer_angle_last": float(np.nanmax(outer)),
        "outer_radius_least": float(np.nanmin(r_outer)),
        "outer_radius_largest": float(np.nanmax(r_outer)),
        "outer_clearance_least": float(np.nanmin(clearance[1])),
        "clearance_between": _clearance_between(mesh),
    }


def _clearance_between(mesh: StrainWave) -> float:
    """Largest clearance between the first and the last angle at which rigid teeth touch [m]."""
    clearance = np.asarray(mesh.surveyed.clearance)
    (touching,) = np.nonzero(clearance < _TOUCHING * float(mesh.module))
    return float(clearance[touching[0] : touching[-1] + 1].max())


def of_sharp_flank(mesh: StrainWave) -> dict[str, np.ndarray]:
    """Points of both branches along the flank without the rounding of its tip, [branch, place].

    Args:
        mesh: drive.

    Returns:
        Their arc length from the root `along` [m], flank angle `lean` [rad], `angle` from the long axis
        [rad], relative `radius` with its sign [m], speeds of the contact over the flank and of the material
        along it, `rolling` and `sliding` [m/rad]; NaN where a branch leaves a point out.
    """
    sharp = replace(mesh, flank=replace(mesh.flank.unrelieved, tip_rounding=1e-6 * mesh.module))
    points: dict[str, np.ndarray] = jax.device_get(_branches(sharp))
    return points


@program
def _branches(mesh: StrainWave) -> dict[str, Array]:
    """Where a drive's flank moves along its tangent, and what it does there [branch, place]."""
    motion = mesh.tooth_motion
    along = jnp.linspace(0.0, 1.0, PLACES) * (mesh.flank.length - mesh.flank.lengths[-1])
    grid = jnp.deg2rad(jnp.arange(BRANCHES[0][0], BRANCHES[-1][-1], _STEP))
    closing = motion.at(along[:, None], grid).closing
    turns = closing[:, 1:] * closing[:, :-1] < 0.0
    ends = jnp.deg2rad(jnp.asarray(BRANCHES))[..., None, None]
    turns = turns & (grid[:-1] >= ends[:, 0]) & (grid[:-1] < ends[:, 1])
    along = jnp.broadcast_to(along, turns.shape[:2])

    def newton(_: Any, angle: Points) -> Points:
        at = motion.at(along, angle)
        return angle - at.closing / at.change

    start = grid[jnp.argmax(turns, axis=2)] + jnp.deg2rad(_STEP / 2.0)
    angle = jax.lax.fori_loop(0, _NEWTON_STEPS, newton, start)
    angle = jnp.where(jnp.any(turns, axis=2), angle, jnp.nan)
    at = motion.at(along, angle)
    width, _ = mesh.groove.width_and_slope(jnp.real(at.place))
    clearance = (width - jnp.imag(at.place)) * jnp.cos(at.direction)
    return {
        "angle": angle,
        "radius": 1.0 / at.relative_curvature,
        "along": along,
        "lean": mesh.flank.angle(along),
        "rolling": at.rolling,
        "sliding": at.sliding,
        "clearance": jnp.where(jnp.real(at.place) > mesh.groove.low, clearance, jnp.nan),
    }
