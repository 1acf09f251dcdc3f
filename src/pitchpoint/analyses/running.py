"""Torque that runs and starts a drive with losses beside its teeth, as a dataset of a case."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Array

from pitchpoint._jax import array, jnp
from pitchpoint.analyses.analysis import Analysis, Piece, Progress, Unasked
from pitchpoint.analyses.loss_map import map_axes
from pitchpoint.analyses.operation import untransmitted
from pitchpoint.cases.build import Built
from pitchpoint.efficiency.quasi_static import Operation
from pitchpoint.efficiency.running_torque import no_load_torque, starting_torque
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
CREEPING = 2.0 * np.pi / 60.0
"""Speed of a driver that begins to turn, at which laws of tooth friction are taken [rad/s]."""

_DIMS = ("law", "speed", "temperature")
_AT_REST = ("law", "temperature")


def running_part(built: Built) -> xr.Dataset:
    """Torque without load over speed and temperature, and torques that start the drive either way.

    Speed and temperature of the operating point are among them.

    Args:
        built: the case.
    """
    speeds, degrees = running_axes(built)
    idle = replace(built.operation, load=array(0.0))

    def over(torque: Callable[..., Array], rates: np.ndarray, one: Built) -> np.ndarray:
        speed, degree = np.meshgrid(rates, degrees, indexing="ij")
        points = Operation(*map(jnp.asarray, (0.0 * speed, speed, degree)))
        known = engaged(one.design, idle, built.models[0])
        return np.stack(
            [np.asarray(torque(one.design, points, own, known)) for own in built.models]
        )

    back = built.backwards
    data = {
        "no_load_torque": (_DIMS, over(no_load_torque, speeds, built)),
        "starting_torque": (_AT_REST, over(starting_torque, _creeping(built), built)[:, 0]),
        "back_driving_torque": (
            _AT_REST,
            over(starting_torque, _creeping(back), back)[:, 0],
        ),
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
    )


def _creeping(built: Built) -> np.ndarray:
    """Speed of a driver that begins to move; of one that travels that at which the other turns so."""
    turned = abs(float(built.nominal["loaded"] @ built.nominal["motion"]))
    return np.array([CREEPING / turned if "driver" in built.travels else CREEPING])


def _held(torques: np.ndarray) -> np.ndarray:
    return locked_or_lost(np.isnan(torques))


def _unloaded(built: Built) -> list[str]:
    """Starting torques without what mostly makes them."""
    drags = built.design.drag
    if any(float(drag.preload) or drag.holds for drag in drags):
        return []
    return [
        "No preload of a bearing, no breakaway model and no breakaway_torque are given: measured drives take "
        "many times these torques to start, either way."
    ]


def running_axes(built: Built) -> tuple[np.ndarray, np.ndarray]:
    """Speeds [rad/s] and temperatures [K] with those of the operating point.

    Speeds go up to that of the loss map. Temperatures are those of the map where the case gives them,
    else they go from the oil's lowest to a warm one.
    """
    point, asked = built.case.operation, built.case.loss_map
    speeds, degrees = map_axes(built)[1:]
    speeds = np.linspace(0.0, speeds[-1], SPEEDS + 1)[1:]
    if asked is None or not asked.temperatures:
        low, high = built.temperatures
        degrees = np.linspace(low, max(min(high, WARM), point.temperature), TEMPERATURES)
    return _with(speeds, point.speed), _with(degrees, point.temperature)


def _with(values: np.ndarray, one: float) -> np.ndarray:
    """Values in order with one more, in place of an equal one up to rounding."""
    others = values[~np.isclose(values, one, rtol=1e-9, atol=0.0)]
    return np.unique(np.append(others, one))


def _free(built: Built) -> str | None:
    told = None if built.design.drag else Unasked("the case has no [losses] beside its teeth")
    return untransmitted(built) or told


def _computed(built: Built, _: Piece, __: Progress) -> xr.Dataset:
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
    lacks=_free,
    compute=_computed,
    main=TORQUES,
    figures=_figures,
)
