"""A result of a strain wave gear made by hand."""

from collections.abc import Mapping
from math import pi, radians
from typing import Any

import numpy as np
import xarray as xr
from records import entries
from sound import wave_rates

from pitchpoint.analyses.kinematic_error import _turns
from pitchpoint.gears.pairs import WAVE
from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.gears.strain_wave.family import FAMILY
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome

EVIL = "</script><b>&"
LAWS = ["constant", "own"]
Z1, Z2 = 40, 42
MODULE, RADIUS, DEFLECTION = 1e-3, 19.5e-3, 1e-3
LANES, NODES = 14, 6


def teeth() -> xr.Dataset:
    """A trapezium on a cosine wave."""
    tooth = 1e-3 * np.array([[-0.9, 0.5], [-0.4, 1.6], [0.4, 1.6], [0.9, 0.5]])
    angle = np.deg2rad(np.linspace(-90.0, 90.0, 13))
    lag = 1.0 - Z1 / Z2
    foot = RADIUS + DEFLECTION * np.cos(2.0 * angle)
    turn = np.exp(1j * lag * angle)[:, None]
    placed = (foot[:, None] + tooth[:, 1] + 1j * tooth[:, 0]) * turn
    low, high = 21e-3, 22.1e-3
    space = np.array([[-0.8e-3, low], [-0.4e-3, high], [0.4e-3, high], [0.8e-3, low]])
    around = np.deg2rad(np.linspace(-40.0, 50.0, 181))
    return dataset(
        {
            "teeth": (("gear",), [Z1, Z2]),
            "tooth": (("corner", "xy"), tooth),
            "space": (("space_corner", "xy"), space),
            "passing_angle": (("place",), angle),
            "passing": (("place", "corner", "xy"), np.stack([placed.imag, placed.real], axis=-1)),
            "neutral_radius": ((), RADIUS),
            "deflection": ((), DEFLECTION),
            "wave_weights": (("wave",), [1.0, 0.0, 0.0]),
            "rim_thickness": ((), 1e-3),
            "tip_height": ((), low),
            "clearance_angle": (("angle",), around),
            "clearance": (("angle",), np.where(around < radians(45), 5e-5 * around**2, np.nan)),
        },
        {},
        title="teeth",
    )


def bell(angle: np.ndarray, width: float = radians(15.0)) -> np.ndarray:
    return np.maximum(1.0 - (angle / width) ** 2, 0.0)


def angles(phase: np.ndarray) -> np.ndarray:
    """Angles [phase, pair] of the teeth at both ends of the long axis."""
    lane = np.tile(np.arange(LANES) - LANES // 2, 2)
    return (lane + phase[:, None]) * 2.0 * pi / Z1


def on_the_way(*args: Any, **told: Any) -> xr.Dataset:
    """A dataset whose places of contacts are those along a wave."""
    data = dataset(*args, **told)
    data["path"].attrs.update(WAVE.attributes(MEMBERS[1:]))
    return data


def cycle() -> xr.Dataset:
    phase = np.linspace(0.0, 1.0, NODES)
    angle = angles(phase)[..., None]
    share = np.stack([bell(angle), bell(angle)])
    lanes = ("law", "node", "pair", "slice")
    each = {
        "load": 100.0 * share,
        "friction": 0.08 * (share > 0.0) * np.array([1.0, 0.5])[:, None, None, None],
        "sliding_velocity": np.broadcast_to(angle, share.shape),
        "entrainment": 0.01 + 0.0 * share,
        "pressure": 4e8 * np.sqrt(share),
        "film_thickness": 1e-8 * (1.0 + 1e3 * share),
        "lambda_ratio": 0.02 * np.exp(6.0 * share),
        "sliding_loss": 0.1 * share,
        "rolling_loss": 0.0 * share,
        "radius": 1e-3 + 0.0 * share,
    }
    mesh = {
        "input_torque": 0.7 + 0.01 * phase,
        "efficiency": 0.9 - 0.01 * phase,
        "loss": 2.0 + 0.0 * phase,
    }
    both = {name: np.stack([values, 1.01 * values]) for name, values in mesh.items()}
    return on_the_way(
        {
            "phase": (("node",), phase),
            "weight": (("node",), np.full(NODES, 1.0 / NODES)),
            "path": (lanes[1:], angle / (2.0 * pi)),
            "active": (lanes[1:], np.abs(angle) < radians(40.0)),
            **{name: (lanes, values) for name, values in each.items()},
            **{name: (lanes[:2], values) for name, values in both.items()},
        },
        {"law": LAWS},
        title="mesh cycle",
        warnings=[],
    )


def operation(drag: float = 3.0) -> xr.Dataset:
    names = {
        "mean_efficiency": 0.85,
        "min_efficiency": 0.84,
        "max_efficiency": 0.86,
        "mean_loss": 5.0,
        "mean_drag_loss": drag,
        "mean_input_torque": 0.7,
        "min_input_torque": 0.69,
        "max_input_torque": 0.71,
        "torque_ripple": 0.02,
        "mean_friction": 0.05,
        "loss_factor": 1.0,
        "contact_ratio": 8.0,
    }
    names |= {f"{way}_reaction_{gear}": 0.0 for way in ("radial", "axial") for gear in (1, 2)}
    each = {name: (("law", "point"), np.full((2, 1), value)) for name, value in names.items()}
    locked = {"locked": (("law", "point"), np.zeros((2, 1), bool))}
    return dataset({**each, **locked}, {"law": LAWS}, title="operating point", warnings=[])


def torsion() -> xr.Dataset:
    torque = np.linspace(0.0, 40.0, 9)
    phase = np.array([0.0, 0.5])
    angle = angles(phase)
    width = radians(4.0) + radians(14.0) * torque / 40.0
    force = torque[:, None, None] * bell(angle, width[:, None, None])
    wind_up = 2e-4 * torque**0.8
    return on_the_way(
        {
            "wind_up": (("torque",), wind_up),
            "wind_up_range": (("torque",), 0.01 * wind_up),
            "torsional_stiffness": (("torque",), 1e4 + 100.0 * torque),
            "tangent_torsional_stiffness": (("torque",), 1.1 * (1e4 + 100.0 * torque)),
            "loaded_pairs": (("torque",), 1.0 + torque / 4.0),
            "zone_load": (("torque", "zone"), np.stack([torque, torque], axis=-1)),
            "path": (("phase", "pair"), angle / (2.0 * np.pi)),
            "kinematic_play": ((), 3e-4),
            "angular_transmission_error": (("torque", "phase"), np.outer(wind_up, [1.0, 1.01])),
            "angular_transmission_error_range": (("torque",), 0.01 * wind_up),
            "tooth_force": (("torque", "phase", "pair"), force),
            "loading_torque": (("law", "torque"), np.stack([1.1 * torque, 1.05 * torque])),
            "unloading_torque": (("law", "torque"), np.stack([0.9 * torque, 0.95 * torque])),
            "mean_friction": (("law",), [0.1, 0.05]),
        },
        {"law": LAWS, "torque": ("torque", torque), "phase": ("phase", phase)},
        title="torsion",
        note="teeth and ring yield; shafts are not in it",
        brief="shafts are not in it",
        warnings=[],
    )


def kinematic_error(*, flexspline: bool = True) -> xr.Dataset:
    """Order 2 of the flexspline and 4 of the circular spline; 3 stays where teeth do not yield."""
    angle = np.arange(2 * Z2) * pi / Z2
    parts = np.array([[3e-5], [2e-5], [1.9e-5]])
    ripple = np.array([[1e-5], [0.0], [1e-9]]) * np.cos(3.0 * angle)
    first = parts * np.cos(2.0 * Z2 / Z1 * angle) * flexspline
    second = 0.5 * parts * np.cos(4.0 * angle) + ripple
    lines = np.zeros((3, 2, Z1))
    lines[:, 0, 2], lines[:, 1, 4] = parts[:, 0] * flexspline, 0.5 * parts[:, 0]
    lines[:, 1, 3] = [1e-5, 0.0, 1e-9]
    lines[:, :, Z1 - 1] = 1e-4 * np.array([flexspline, 1.0])  # of the mesh
    size = [np.ptp(one, axis=1) for one in (first, second, first + second)]
    return dataset(
        {
            "turn_angle": (("state",), angle),
            "kinematic_error": (("curve", "state"), first + second),
            "kinematic_error_spectrum": (("curve", "member", "order"), lines),
            "kinematic_error_range": (("curve", "cause"), np.stack(size, axis=1)),
        },
        {
            "curve": ["geometry", "elastic mean", "under load"],
            "member": ["flexspline", "circular spline"],
            "cause": ["flexspline", "circular spline", "both"],
            "order": ("order", np.arange(Z1)),
        },
        title="kinematic error",
        warnings=[],
        **_turns(FAMILY.turning, "circular spline"),
    )


DEGREES = np.array([293.15, 313.15, 333.15])


def running() -> xr.Dataset:
    speed = np.linspace(20.0, 200.0, 5)
    torque = 1e-3 * speed[:, None] * np.exp(-(DEGREES - 300.0) / 30.0)
    return dataset(
        {
            "no_load_torque": (("law", "speed", "temperature"), np.stack([torque, 1.1 * torque])),
            "starting_torque": (("law", "temperature"), np.full((2, 3), 0.03)),
            "back_driving_torque": (("law", "temperature"), np.array([[2.0] * 3, [np.nan] * 3])),
        },
        {"law": LAWS, "speed": ("speed", speed), "temperature": ("temperature", DEGREES)},
        title="running without load",
        warnings=[],
    )


def loss_map() -> xr.Dataset:
    axes = ("law", "torque", "speed", "temperature")
    torque, speed = np.linspace(0.0, 30.0, 4), np.linspace(0.0, 200.0, 3)
    power = torque[:, None, None] * speed[None, :, None] + 0.0 * DEGREES
    with np.errstate(invalid="ignore", divide="ignore"):
        efficiency = np.where(power > 0.0, 1.0 - 200.0 / (400.0 + power), np.nan)
    return dataset(
        {
            "mean_loss": (axes, np.stack([power, power]) / 10.0),
            "mean_efficiency": (axes, np.stack([efficiency, 0.99 * efficiency])),
            "locked": (axes, np.zeros((2, *power.shape), bool)),
        },
        {
            "law": LAWS,
            "torque": ("torque", torque),
            "speed": ("speed", speed),
            "temperature": ("temperature", DEGREES),
        },
        title="loss map",
        warnings=[],
    )


def outcome(parts: Mapping[str, xr.Dataset], **changes: Any) -> Outcome:
    given = {
        "operation.driver": "wave generator",
        "operation.torque": 20.0,
        "operation.speed": 1000.0 * pi / 30.0,
        "operation.temperature": 313.15,
        "gears.fixed": "circular spline",
        "gears.module": 1e-3,
        "gears.face_width": 0.01,
    }
    empty: dict[str, Any] = {"sources": [], "issues": [], "rows": []}
    driver = changes.setdefault("driver", "wave generator")
    loaded = changes.setdefault("loaded", "flexspline")
    fixed = next(name for name in MEMBERS if name not in (driver, loaded))
    turning = wave_rates((Z1, Z2), *map(MEMBERS.index, (fixed, driver)))
    manifest = {
        "case": "by hand",
        "variant": "default",
        "surroundings": {},
        "title": EVIL,
        "summary": "",
        "oil": "oil",
        "members": list(MEMBERS),
        "motion": turning.tolist(),
        "period": 2.0 * pi / Z1 / abs(turning[1] - turning[0]),
        "travels": [],
        "pitch": WAVE.pitch,
        "against": WAVE.against if turning[1] < turning[0] else "",
        "averaging": "base_pitch",
        "finished": True,
        "implausible": [],
        "warnings": [],
        "inputs": entries(given),
        "laws": [{"name": "own", "title": EVIL, "note": ""}],
        "models": [{"effect": "load sharing", "name": "a", "title": "a", "note": ""}],
        **empty,
        **changes,
    }
    return Outcome(manifest, dict(parts))
