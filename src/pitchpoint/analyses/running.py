"""Torque that runs and starts a drive with losses beside its teeth, as a dataset of a case."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress, Unasked
from pitchpoint.analyses.lacking import untransmitted, without_formula
from pitchpoint.analyses.loss_map import map_axes
from pitchpoint.cases.built_drive import Ready
from pitchpoint.core.doubts import Doubt, measured
from pitchpoint.core.status import locked_or_lost, solve_summary
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.input.kinds import TEMPERATURE
from pitchpoint.results.store import dataset, without_nan

__all__ = [
    "BANDS",
    "RUNNING",
    "TORQUES",
    "creeping_speed",
    "from_rest",
    "has_spread",
    "running_axes",
    "running_part",
]

TORQUES = ("no_load_torque", "starting_torque", "back_driving_torque")
"""Torques without load: running, and from rest either way."""

BANDS = (
    ("least_starting_torque", "largest_starting_torque"),
    ("least_back_driving_torque", "largest_back_driving_torque"),
)
"""Ends of the band of each torque from rest, where a loss says how uncertain it is there."""

SPEEDS = 9
TEMPERATURES = 7
WARM = 353.15
"""Temperature up to which torques are shown that matter in the cold [K]."""
COLD = 243.15
"""Temperature of a cold day, -30 degC [K]."""
CREEPING = 2.0 * np.pi / 60.0
"""Speed of a driver that begins to turn, at which laws of tooth friction are taken [rad/s]."""

AT_REST = 1.1
"""Least starting torque over that in slow motion, in which seals and greased bearings do not stick."""

_DIMS = ("law", "speed", "temperature")
_AT_REST = ("law", "temperature")


def running_part(built: Ready) -> xr.Dataset:
    """Torque without load over speed and temperature, and torques that start the drive either way.

    Speed and temperature of the operating point are among them.

    Args:
        built: the case.
    """
    speeds, degrees = running_axes(built)
    back, creeping = built.backwards, creeping_speed(built)
    turned = creeping * float(back.operation.speed) / float(built.operation.speed)
    running = _running(built, np.append(speeds, creeping), degrees)
    data = {
        "no_load_torque": (_DIMS, running[:, :-1]),
        "starting_torque": (_AT_REST, from_rest(built, 0.0, creeping, degrees)[1]),
        "back_driving_torque": (_AT_REST, from_rest(back, 0.0, turned, degrees)[1]),
    }
    if has_spread(built):
        for (low, high), driven, speed in zip(
            BANDS, (built, back), (creeping, turned), strict=True
        ):
            for name, sign in ((low, -1.0), (high, 1.0)):
                held = driven.held_otherwise(sign)
                data[name] = (_AT_REST, from_rest(held, 0.0, speed, degrees)[1])
    return dataset(
        data,
        {
            "law": built.law_names,
            "speed": ("speed", speeds),
            "temperature": ("temperature", degrees),
        },
        title="running without load",
        travels=built.travels,
        warnings=_easily_started(built, data["starting_torque"][1], running[:, -1], degrees),
        solve=solve_summary(np.concatenate([_held(values).ravel() for _, values in data.values()])),
        note="NaN where friction holds the drive whatever the torque",
        fitted=" ".join(filter(None, [_fitted(built), _of_set(built, data, degrees)])),
    )


def _running(built: Ready, speeds: np.ndarray, degrees: np.ndarray) -> np.ndarray:
    """Torque of the driver that runs without load [law, speed, temperature]."""
    speed, degree = np.meshgrid(speeds, degrees, indexing="ij")
    points = Operation(*map(array, (0.0 * speed, speed, degree)))
    return np.stack(built.no_load_torques(points))


def from_rest(
    built: Ready, load: float, speed: float, degrees: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Torque of the driver that starts the drive from rest under a load: mean over the phases, and largest.

    Args:
        built: the case, or the same with its output driving.
        load: that it carries [N m or N].
        speed: of the driver, a creeping one, at which laws of tooth friction are taken [rad/s or m/s].
        degrees: temperatures of the oil [K].

    Returns:
        Both [law, temperature] [N m or N]; of a drive of stages what one of them takes is the load of the one
        before. NaN where friction holds the drive whatever the torque, and under laws that solve films.
    """
    points = Operation(
        *(array(np.broadcast_to(condition, degrees.shape)) for condition in (load, speed, degrees))
    )
    mean, largest = map(np.stack, zip(*built.torques_at_rest(points), strict=True))
    return mean, largest


def has_spread(built: Ready) -> bool:
    """True if a place says by how much what holds it at rest may be more or less."""
    every: tuple[Ready, ...] = built, *built.stages
    return any(
        loss.breakaway_spread > 1.0 for drive in every for loss in drive.case.losses.values()
    )


def _fitted(built: Ready) -> str:
    """Where the constants of the named sets of losses were fitted, in words; empty without any."""
    ranges = [mesh.fitted for mesh in built.meshes if mesh.fitted is not None]
    if not ranges:
        return ""
    low, high = max(low for low, _ in ranges), min(high for _, high in ranges)
    return (
        f"The losses of the set were fitted from {TEMPERATURE.show(low)} to {TEMPERATURE.show(high)}; "
        "beyond, these torques are extrapolated."
    )


def _of_set(built: Ready, data: Mapping[str, Any], degrees: np.ndarray) -> str:
    """How the torque from rest backwards stands to that forwards, in words; empty without a set of losses."""
    if built.fitted is None:
        return ""
    at = int(np.argmin(np.abs(degrees - built.case.operation.temperature)))
    forth, back = (float(data[name][1][0, at]) for name in TORQUES[1:])
    step = float(built.backwards.operation.speed) / float(built.operation.speed)
    times = back * step / forth
    if not np.isfinite(times):
        return ""
    why = ", for teeth and bearing then carry what holds the driver" if times > 1.0 else ""
    return (
        f"Driving it backwards takes {times:.3g} times ratio and starting torque{why}. By the set of losses "
        "alone that is nearly the same at every size; drives of makers differ."
    )


def creeping_speed(built: Ready) -> float:
    """Speed of a driver that begins to move; of one that travels that at which the other turns so.

    Args:
        built: the case.
    """
    return CREEPING / built.output_rate if "driver" in built.travels else CREEPING


def _held(torques: np.ndarray) -> np.ndarray:
    return locked_or_lost(np.isnan(torques))


def _easily_started(
    built: Ready, starting: np.ndarray, slow: np.ndarray, degrees: np.ndarray
) -> list[str]:
    """Starting torques that do not exceed those of slow motion, where measured ones do by far.

    Args:
        built: the case.
        starting: from rest [law, temperature].
        slow: at a creeping speed, as `starting`.
        degrees: temperatures [K].
    """
    at = int(np.argmin(np.abs(degrees - built.case.operation.temperature)))
    some = np.isfinite(starting[:, at]) & np.isfinite(slow[:, at])
    if not some.any():
        return []
    law = int(np.argmin(np.where(some, starting[:, at] - AT_REST * slow[:, at], np.inf)))
    at_rest, moving = float(starting[law, at]), float(slow[law, at])
    if at_rest >= AT_REST * moving:
        return []
    kind = "force" if "driver" in built.travels else "torque"
    efforts = [measured(effort, "N" if kind == "force" else "N m") for effort in (at_rest, moving)]
    return [
        Doubt(
            f"A {kind} to start of {efforts[0]} beside {efforts[1]} in slow motion is a lower bound: "
            "seals and greased bearings stick at rest, and measured drives take up to many times as much, "
            "either way; a breakaway model or a breakaway_torque in [losses] says what holds them.",
            about=("starting_torque", "back_driving_torque"),
            brief=f"{efforts[0]} to start is a lower bound: no breakaway is given.",
        )
    ]


def running_axes(built: Ready) -> tuple[np.ndarray, np.ndarray]:
    """Speeds [rad/s] and temperatures [K] with those of the operating point.

    Speeds go up to that of the loss map; of a drive of stages there is that of the operating point
    alone. Temperatures are those of the map where the case gives them, else they go from the oil's
    lowest to a warm one, with that of a cold day where the oil reaches it.
    """
    point, loss_map = built.case.operation, built.case.loss_map
    speeds, degrees = map_axes(built)[1:]
    count = 0 if built.numbers else SPEEDS
    speeds = np.linspace(0.0, speeds[-1], count + 1)[1:]
    if loss_map is None or not loss_map.temperatures:
        low, high = built.temperatures
        degrees = np.linspace(low, max(min(high, WARM), point.temperature), TEMPERATURES)
        degrees = _with(degrees, COLD) if low <= COLD else degrees
    return _with(speeds, point.speed), _with(degrees, point.temperature)


def _with(values: np.ndarray, one: float) -> np.ndarray:
    """Values in order with one more, in place of an equal one up to rounding."""
    others = values[~np.isclose(values, one, rtol=1e-9, atol=0.0)]
    return np.unique(np.append(others, one))


def _free(built: Ready) -> str | None:
    reason = None if built.drags else Unasked("the case has no [losses] beside its teeth")
    return untransmitted(built) or reason or without_formula(built)


def _computed(built: Ready, _: Piece, __: PieceProgress) -> xr.Dataset:
    return running_part(built)


def _figures(parts: Mapping[str, xr.Dataset]) -> dict[str, Any]:
    """Torques by law, over speed and temperature; none of a part that does not exist."""
    data = parts.get("running")
    if data is None:
        return {}
    axes = {name: data[name].values.tolist() for name in ("speed", "temperature")}
    laws = enumerate(data["law"].values)
    names = [*TORQUES, *(name for ends in BANDS for name in ends if name in data)]
    by_law = {
        str(law): {n: without_nan(data[n].values[k].tolist()) for n in names} for k, law in laws
    }
    return {"running": {**axes, **by_law}}


RUNNING = Analysis(
    name="running",
    title="running without load",
    of="drive",
    lacks=_free,
    compute=_computed,
    main=TORQUES,
    figures=_figures,
)
