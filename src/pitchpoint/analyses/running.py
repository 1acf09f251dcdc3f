"""Torque that runs and starts a drive with losses beside its teeth, as a dataset of a case."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.analyses.analysis import Analysis, Piece, Progress, Unasked
from pitchpoint.analyses.lacking import untransmitted, without_formula
from pitchpoint.analyses.loss_map import map_axes
from pitchpoint.cases.build import Built
from pitchpoint.cases.schema import TEMPERATURE
from pitchpoint.cases.stages import BuiltDrive, Ready
from pitchpoint.doubts import Doubt
from pitchpoint.efficiency.drag import Drag
from pitchpoint.efficiency.drive_summary import drive_figures
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.efficiency.running_torque import (
    no_load_torque,
    starting_torque,
    starting_torque_of_drive,
)
from pitchpoint.efficiency.summary import engaged
from pitchpoint.results.store import dataset, without_nan
from pitchpoint.status import locked_or_lost, told

__all__ = ["RUNNING", "TORQUES", "running_axes", "running_part"]

TORQUES = ("no_load_torque", "starting_torque", "back_driving_torque")
"""Torques without load: running, and from rest either way."""

SPEEDS = 9
TEMPERATURES = 7
WARM = 353.15
"""Temperature up to which torques are shown that matter in the cold [K]."""
COLD = 243.15
"""Temperature of a cold day, -30 degC [K]."""
CREEPING = 2.0 * np.pi / 60.0
"""Speed of a driver that begins to turn, at which laws of tooth friction are taken [rad/s]."""

_DIMS = ("law", "speed", "temperature")
_AT_REST = ("law", "temperature")


def running_part(built: Ready) -> xr.Dataset:
    """Torque without load over speed and temperature, and torques that start the drive either way.

    Speed and temperature of the operating point are among them.

    Args:
        built: the case.
    """
    speeds, degrees = running_axes(built)
    back = built.backwards

    def at_rest(one: Ready) -> np.ndarray:
        return _over(one, _creeping(one), degrees, resting=True)[:, 0]

    data = {
        "no_load_torque": (_DIMS, _over(built, speeds, degrees, resting=False)),
        "starting_torque": (_AT_REST, at_rest(built)),
        "back_driving_torque": (_AT_REST, at_rest(back)),
    }
    return dataset(
        data,
        {
            "law": built.law_names,
            "speed": ("speed", speeds),
            "temperature": ("temperature", degrees),
        },
        title="running without load",
        travels=built.travels,
        warnings=_unloaded(built),
        solve=told(np.concatenate([_held(values).ravel() for _, values in data.values()])),
        note="NaN where friction holds the drive whatever the torque",
        fitted=_fitted(built),
    )


def _over(built: Ready, speeds: np.ndarray, degrees: np.ndarray, *, resting: bool) -> np.ndarray:
    """Torque of the driver without load [law, speed, temperature]: running, or at which it starts."""
    every = np.meshgrid(speeds, degrees, indexing="ij")
    if isinstance(built, BuiltDrive):
        return _of_drive(built, *every, resting=resting)
    return _of_mesh(built, *every, resting=resting)


def _of_mesh(built: Built, speeds: np.ndarray, degrees: np.ndarray, *, resting: bool) -> np.ndarray:
    idle = replace(built.operation, load=array(0.0))
    points = Operation(*map(array, (0.0 * speeds, speeds, degrees)))
    known = engaged(built.design, idle, built.models[0])
    torque = starting_torque if resting else no_load_torque
    each = [torque(built.design, points, own, known) for own in built.models]
    return np.stack([np.asarray(one) for one in each])


def _of_drive(
    built: BuiltDrive, speeds: np.ndarray, degrees: np.ndarray, *, resting: bool
) -> np.ndarray:
    """The same of stages: what one of them takes is the load of the one before."""
    drive, idle = built.design, 0.0 * speeds
    if resting:
        points = Operation(*map(array, (idle, speeds, degrees)))
        each = [starting_torque_of_drive(drive, points, own.stages) for own in built.models]
        return np.stack([np.asarray(one) for one in each])
    every = zip(idle.ravel(), speeds.ravel(), degrees.ravel(), strict=True)
    running = [(drive, Operation(*map(array, one))) for one in every]
    found = [drive_figures(running, own.stages) for own in built.models]
    torques = [np.where(one["locked"], np.nan, one["mean_input_torque"]) for one in found]
    return np.stack(torques).reshape(-1, *speeds.shape)


def _fitted(built: Ready) -> str:
    """Where the constants of the named sets of losses were fitted, in words; empty without any."""
    ranges = [one.fitted for one in built.meshes if one.fitted is not None]
    if not ranges:
        return ""
    low, high = max(low for low, _ in ranges), min(high for _, high in ranges)
    return (
        f"The losses of the set were fitted from {TEMPERATURE.show(low)} to {TEMPERATURE.show(high)}; "
        "beyond, these torques are extrapolated."
    )


def _creeping(built: Ready) -> np.ndarray:
    """Speed of a driver that begins to move; of one that travels that at which the other turns so."""
    if isinstance(built, BuiltDrive):
        turned = abs(built.motion[-1] / built.motion[0])
    else:
        turned = abs(float(built.nominal["loaded"] @ built.nominal["motion"]))
    return np.array([CREEPING / turned if "driver" in built.travels else CREEPING])


def _held(torques: np.ndarray) -> np.ndarray:
    return locked_or_lost(np.isnan(torques))


def _places(built: Ready) -> tuple[Drag, ...]:
    """Losses beside the teeth, of a drive those of its stages too."""
    stages = built.design.stages if isinstance(built, BuiltDrive) else ()
    return (*built.design.drag, *(drag for one in stages for drag in one.design.drag))


def _unloaded(built: Ready) -> list[str]:
    """Starting torques without what mostly makes them."""
    drags = _places(built)
    if any(float(drag.preload) or drag.holds for drag in drags):
        return []
    return [
        Doubt(
            "Torques to start are too low without what holds bearings at rest; measured drives take many "
            "times as much, either way, and no preload, breakaway model or breakaway_torque is given.",
            brief="Torques to start are too low: nothing holds bearings at rest.",
        )
    ]


def running_axes(built: Ready) -> tuple[np.ndarray, np.ndarray]:
    """Speeds [rad/s] and temperatures [K] with those of the operating point.

    Speeds go up to that of the loss map; of a drive of several meshes there is that of the operating
    point alone. Temperatures are those of the map where the case gives them, else they go from the oil's
    lowest to a warm one, with that of a cold day where the oil reaches it.
    """
    point, asked = built.case.operation, built.case.loss_map
    speeds, degrees = map_axes(built)[1:]
    count = 0 if isinstance(built, BuiltDrive) else SPEEDS
    speeds = np.linspace(0.0, speeds[-1], count + 1)[1:]
    if asked is None or not asked.temperatures:
        low, high = built.temperatures
        degrees = np.linspace(low, max(min(high, WARM), point.temperature), TEMPERATURES)
        degrees = _with(degrees, COLD) if low <= COLD else degrees
    return _with(speeds, point.speed), _with(degrees, point.temperature)


def _with(values: np.ndarray, one: float) -> np.ndarray:
    """Values in order with one more, in place of an equal one up to rounding."""
    others = values[~np.isclose(values, one, rtol=1e-9, atol=0.0)]
    return np.unique(np.append(others, one))


def _free(built: Ready) -> str | None:
    told = None if _places(built) else Unasked("the case has no [losses] beside its teeth")
    return untransmitted(built) or told or without_formula(built)


def _computed(built: Ready, _: Piece, __: Progress) -> xr.Dataset:
    return running_part(built)


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Torques by law, over speed and temperature; none of a part that does not exist."""
    data = parts.get("running")
    if data is None:
        return {}
    axes = {name: data[name].values.tolist() for name in ("speed", "temperature")}
    laws = enumerate(data["law"].values)
    each = {
        str(law): {n: without_nan(data[n].values[k].tolist()) for n in TORQUES} for k, law in laws
    }
    return {"running": {**axes, **each}}


RUNNING = Analysis(
    name="running",
    title="running without load",
    alone="",
    lacks=_free,
    compute=_computed,
    main=TORQUES,
    figures=_figures,
)
