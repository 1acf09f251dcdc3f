"""Results of drives whose loss torque is a law that somebody writes down, without a computation."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.analyses.four_quadrants import both_signs
from pitchpoint.runs.run import Outcome

Lost = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]
"""Torque that is lost over torque along the motion, speed and temperature [degC]; below 0 where it locks."""

RATIO = -50.0
TITLE = 'A "joint" <b>&amp; */ -- %s\\ {x}\n\' é'


def plain(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """Constant, with the load, viscous; thinner in warm oil."""
    share = np.where(torque < 0.0, 0.12, 0.10)
    return np.asarray((2.0 + share * abs(torque) + 3.0 * speed) * (1.0 - 0.002 * (degree - 40.0)))


def locking(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """One that loads cannot turn."""
    return np.where(torque < 0.0, -1.0, 2.0 + 0.6 * abs(torque) + 0.0 * speed + 0.0 * degree)


def made_joint(
    lost: Lost = plain, *, slides: bool = False, more: dict[str, xr.Dataset] | None = None
) -> Outcome:
    """A result with the loss map of a law.

    Args:
        lost: the law.
        slides: True for an output that travels.
        more: further parts.
    """
    loads, speeds = np.array([0.0, 2.0, 10.0, 30.0, 60.0]), np.array([0.0, 0.01, 0.1, 1.0, 4.0])
    degrees, ratio = np.array([20.0, 40.0, 60.0]), 1.0 / abs(RATIO)
    torque, speed, degree = np.meshgrid(
        both_signs(loads), both_signs(speeds), degrees, indexing="ij"
    )
    way = np.where(speed < 0.0, -1.0, 1.0)
    away = lost(way * torque, abs(speed), degree)
    locked = (away < 0.0) & (speed != 0.0)
    loss = np.where(locked, np.nan, away * abs(speed))
    held, warm = np.meshgrid(both_signs(loads), degrees, indexing="ij")
    on, off = (lost(sign * held, 0.0 * held, warm) for sign in (1.0, -1.0))
    dims, rest = (
        ("law", "output_torque", "output_speed", "temperature"),
        ("law", "output_torque", "temperature"),
    )
    values: dict[str, Any] = {
        "mean_loss": (dims, loss[None], {"units": "W"}),
        "locked": (dims, locked[None]),
        "mean_input_torque": (dims, 0.0 * loss[None], {"units": "N m"}),
        "largest_holding_torque": (rest, np.where(on < 0.0, np.nan, held + on)[None] * ratio),
        "least_holding_torque": (rest, np.where(off < 0.0, np.nan, held - off)[None] * ratio),
        "self_locking": (rest, (off < 0.0)[None]),
    }
    for name in (
        "interpolation_error",
        "mean_interpolation_error",
        "light_load_error",
        "creeping_error",
    ):
        values[name] = ("law", [0.0])
    torque_unit, speed_unit = ("N", "m/s") if slides else ("N m", "rad/s")
    axes = {
        "law": ["made"],
        "output_torque": ("output_torque", both_signs(loads), {"units": torque_unit}),
        "output_speed": ("output_speed", both_signs(speeds), {"units": speed_unit}),
        "temperature": ("temperature", degrees + 273.15, {"units": "K"}),
    }
    attrs = {
        "speed_ratio": ratio,
        "load": 20.0,
        "degree": 313.15,
        "version": "0.1.0",
        "note": "Made.",
    }
    data = xr.Dataset(values, axes, {**attrs, "fingerprint": "0123456789abcdef"})
    parts = {"four_quadrants": data, **(more or {})}
    return Outcome(record(slides) | {"parts": [*parts]}, parts)


def record(slides: bool) -> dict[str, Any]:
    """What exports read of a manifest."""
    row = {"table": "operation", "key": "speed", "value": 100.0, "kind": "rotational speed"}
    return {
        "case": "made.toml",
        "variant": "default",
        "title": TITLE,
        "driver": "wave generator",
        "loaded": "flexspline",
        "stages": [],
        "period": 2.0 * np.pi / 40.0,
        "members": ["wave generator", "flexspline", "circular spline"],
        "motion": [1.0, 1.0 / RATIO, 0.0],
        "travels": ["loaded"] if slides else [],
        "inputs": [row],
        "warnings": [],
        "lacks": {"torsion": "the teeth are rigid"},
        "surroundings": {"pitchpoint": "0.1.0"},
    }


TORQUES = np.array([0.0, 20.0, 40.0])


def torsion() -> xr.Dataset:
    """Wind-up, with 1000 N m/rad at the load of operation."""
    turned = TORQUES / 1000.0
    return xr.Dataset(
        {
            "wind_up": ("torque", turned),
            "tangent_torsional_stiffness": ("torque", np.array([900.0, 1000.0, 1100.0])),
            "torsional_stiffness": ("torque", np.full(3, 1000.0), {"covers": "teeth"}),
            "angular_transmission_error_range": ("torque", 1e-5 * TORQUES),
            "kinematic_play": ((), 2e-4),
            "hysteresis_loss": ("law", [3e-5]),
        },
        {"torque": ("torque", TORQUES), "law": ["made"]},
    )


def error() -> xr.Dataset:
    """Kinematic error of the orders 2 and 7."""
    angle = np.arange(64) * 2.0 * np.pi / 64
    waves = 2e-4 * np.cos(2.0 * angle + 0.5) + 5e-5 * np.sin(7.0 * angle) + 1e-7 * np.cos(angle)
    return xr.Dataset(
        {"kinematic_error": (("curve", "state"), np.stack([0.0 * waves, waves]))},
        {"curve": ["geometry", "under load"]},
        {"turn_angle": "wave generator against circular spline"},
    )


def rippling() -> dict[str, xr.Dataset]:
    """A mesh cycle, of which 40 come in a turn of the driver, with waves of 30 and 10 % of friction."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    phase, lost = (nodes + 1.0) / 2.0, 0.1
    angle = 2.0 * np.pi * phase
    waves = (
        0.3 * np.cos(angle - 0.7) + 0.1 * np.cos(2.0 * angle + 0.2) + 0.005 * np.cos(3.0 * angle)
    )
    torque = 20.0 / abs(RATIO) + lost * (1.0 + waves)
    mean = (("law", "point"), [[20.0 / abs(RATIO) + lost]])
    return {
        "cycle": xr.Dataset(
            {
                "input_torque": (("law", "node"), torque[None]),
                "phase": ("node", phase),
                "weight": ("node", weights / 2.0),
            },
            {"law": ["made"]},
            {
                "title": "mesh cycle",
                "version": "0.1.0",
                "solve": '{"code": 0, "residual": 0.0}',
                "warnings": "[]",
            },
        ),
        "operation": xr.Dataset({"mean_input_torque": mean}, {"law": ["made"]}),
    }


def strengths() -> dict[str, xr.Dataset]:
    """Safeties under the load of operation, 20 N m: roots bear 1.5 of it, flanks 1.44, ratcheting 2."""
    margin = {"limit_margin": ("against", [2.0, np.nan]), "flexspline_torque": 20.0}
    goodman = {"goodman_torque": ("place", [70.0, 64.0])}
    safeties = {"flank_safety": ("gear", [1.3, 1.2]), "root_safety": ("gear", [1.5, 1.7])}
    return {
        "strength": xr.Dataset(safeties),
        "load_limits": xr.Dataset({**margin, **goodman}, {"against": ["ratcheting", "buckling"]}),
    }
