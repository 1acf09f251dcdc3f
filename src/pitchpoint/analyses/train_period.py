"""A gear train over its period: torque of the driving body, forces of every planet in every mesh."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from pitchpoint._jax import jax
from pitchpoint.analyses.analysis import Piece, Progress
from pitchpoint.cases.built_drive import BuiltTrain
from pitchpoint.drive.kinematics import Ends
from pitchpoint.drive.thrusts import axial_loads
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.quasi_static import power_ratio
from pitchpoint.efficiency.train_cycle import NODES_OF_TRAINS, train_cycle
from pitchpoint.results.store import dataset
from pitchpoint.status import Code
from pitchpoint.status import told as told_of

if TYPE_CHECKING:
    from pitchpoint.efficiency.train import Train

__all__ = ["train_period_of"]


def train_period_of(built: BuiltTrain, _: Piece, __: Progress) -> xr.Dataset:
    """States of the train at the nodes of its period, under each friction law.

    From `train_cycle`, whose means are those of the operating point.
    """
    train = built.design
    cycles = [
        jax.device_get(train_cycle(train, built.operation, acting.stages, NODES_OF_TRAINS))
        for acting in built.models
    ]
    cycle_nodes, planets = cycles[0], max(built.copies)
    turns = round(float(train.turns))
    phase = cycle_nodes.phase + np.arange(turns)[:, None] / turns

    def whole(values: Iterable[Any]) -> np.ndarray:
        """Values [law node] over all parts of the period, in which planets have each other's places."""
        return np.tile(np.stack([*values]), turns)

    forces = np.full((len(cycles), len(built.copies), planets, phase.size), np.nan)
    for law, cycle in enumerate(cycles):
        for stage, count in enumerate(built.copies):
            forces[law, stage, :count] = _over_period(train, cycle.meshes[stage].force[:count])
    codes = np.stack([cycle.status.code for cycle in cycles])
    solved = codes == Code.SOLVED
    ratios = [power_ratio(cycle.output_power, cycle.input_power) for cycle in cycles]
    driven = np.stack([cycle.input_torque for cycle in cycles])
    thrusts, tilting = _axial_loads(built)
    return dataset(
        {
            "driver_angle": (("node",), phase.ravel() * float(train.period)),
            "weight": (("node",), np.tile(cycle_nodes.weight, turns) / turns),
            "input_torque": (("law", "node"), whole(np.where(solved, driven, np.nan))),
            "efficiency": (("law", "node"), whole(ratios)),
            "loss": (("law", "node"), whole(cycle.loss for cycle in cycles)),
            "contact_force": (("law", "stage", "planet", "node"), forces),
            "body_thrust": (("body",), [*thrusts.values()]),
            "planet_tilting_moment": ((), tilting),
        },
        {
            "law": built.law_names,
            "stage": [*built.numbers],
            "planet": np.arange(1, planets + 1),
            "body": [*thrusts],
        },
        title="period of the train",
        solve=told_of(codes, np.stack([cycle.status.residual for cycle in cycles])),
        driver_period=float(train.period),
    )


def _over_period(train: "Train", forces: np.ndarray) -> np.ndarray:
    """Forces [planet node] over all parts of the period: in each, planets have those of others before it."""
    parts, further = round(float(train.turns)), round(float(train.onwards))
    return np.concatenate([np.roll(forces, -part * further, axis=0) for part in range(parts)], -1)


def _axial_loads(built: BuiltTrain) -> tuple[dict[str, float], float]:
    """Thrusts on the bodies, one planet for all, and the moment that tilts it, without losses."""
    train = built.design
    links = [mesh.link for mesh in train.meshes]
    ends = Ends({train.turned: float(train.rates[train.turned])}, train.held, train.loaded)
    ideal = train_torques(links, ends, float(built.case.operation.load), [1.0] * len(links))
    axial = axial_loads(links, train.planets, ideal.shares, built.copies)
    return dict(axial.thrusts), axial.tilting
