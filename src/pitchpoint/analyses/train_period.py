"""A gear train over its period: torque of the driving body, forces of every planet in every mesh."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from pitchpoint._jax import jax, jnp
from pitchpoint.analyses.analysis import Piece, PieceProgress
from pitchpoint.cases.built_drive import Acting, BuiltTrain
from pitchpoint.core.programs import program
from pitchpoint.core.status import Code, solve_summary
from pitchpoint.drive.kinematics import Ends
from pitchpoint.drive.thrusts import axial_loads
from pitchpoint.drive.torques import train_torques
from pitchpoint.efficiency.quasi_static import Models, Operation, power_ratio
from pitchpoint.efficiency.train_cycle import NODES_OF_TRAINS, train_cycle
from pitchpoint.gears.nominal_motion import nominal_period
from pitchpoint.results.store import dataset

if TYPE_CHECKING:
    from pitchpoint.efficiency.train import Train

__all__ = ["over_period", "train_period_of"]


def train_period_of(built: BuiltTrain, _: Piece, __: PieceProgress) -> xr.Dataset:
    """States of the train at the nodes of its period, under each friction law.

    From `train_cycle`, whose means are those of the operating point.
    """
    train = built.design
    cycles = [over_period(built, built.operation, acting) for acting in built.models]
    first_cycle, planets = cycles[0], max(built.copies)
    turns, driver_period = round(float(train.turns)), _driver_period(train)
    phase = first_cycle["phase"] + np.arange(turns)[:, None] / turns

    def whole(name: str) -> np.ndarray:
        """Values [law node] over all parts of the period, in which planets have each other's places."""
        return np.tile(np.stack([cycle[name] for cycle in cycles]), turns)

    forces = np.full((len(cycles), len(built.copies), planets, phase.size), np.nan)
    for law, cycle in enumerate(cycles):
        for mesh, count in enumerate(built.copies):
            forces[law, mesh, :count] = _over_period(train, cycle["forces"][mesh][:count])
    codes, residuals = (
        np.stack([cycle[name] for cycle in cycles]) for name in ("code", "residual")
    )
    thrusts, tilting = _axial_loads(built)
    outside = _from_outside(built, cycles)
    return dataset(
        {
            "driver_angle": (("node",), phase.ravel() * driver_period),
            "weight": (("node",), np.tile(first_cycle["weight"], turns) / turns),
            "input_torque": (("law", "node"), whole("input_torque")),
            "efficiency": (("law", "node"), whole("efficiency")),
            "loss": (("law", "node"), whole("loss")),
            "contact_force": (("law", "mesh", "planet", "node"), forces),
            "outside_torque": (("law", "outer_body"), np.transpose([*outside.values()])),
            "body_thrust": (("body",), [*thrusts.values()]),
            "planet_tilting_moment": ((), tilting),
        },
        {
            "law": built.law_names,
            "mesh": built.stage_bodies,
            "planet": np.arange(1, planets + 1),
            "outer_body": [*outside],
            "body": [*thrusts],
        },
        title="period of the train",
        solve=solve_summary(codes, residuals),
        driver_period=driver_period,
    )


def over_period(built: BuiltTrain, operation: Operation, acting: Acting) -> dict[str, Any]:
    """What is read of the states of a set over its period at a point, by laws that act together.

    Args:
        built: the set.
        operation: load of its output, speed of its input, temperature of the oil.
        acting: laws.
    """
    period = _period(built.design.without_names(), operation, tuple(acting.stages))
    read: dict[str, Any] = jax.device_get(period)
    return read


@program
def _period(train: "Train", operation: Operation, laws: tuple[Models, ...]) -> dict[str, Any]:
    """What is read of the states of a train over its period, whatever the names of its ends."""
    cycle = train_cycle.function(train, operation, laws, NODES_OF_TRAINS)
    solved = cycle.status.code == int(Code.SOLVED)
    return {
        "phase": cycle.phase,
        "weight": cycle.weight,
        "input_torque": jnp.where(solved, cycle.input_torque, jnp.nan),
        "efficiency": power_ratio(cycle.output_power, cycle.input_power),
        "loss": cycle.loss,
        "torques": {body: cycle.weight @ torque for body, torque in cycle.torques.items()},
        "forces": [mesh.force for mesh in cycle.meshes],
        "on_planet": cycle.on_planet @ cycle.weight,
        "code": cycle.status.code,
        "residual": cycle.status.residual,
    }


def _driver_period(train: "Train") -> float:
    """See `Train.period`; nothing is compiled for it [rad]."""
    mesh = train.meshes[0]
    rates = jax.device_get(train.rates)
    against: Any = np.array([rates[body] - rates[mesh.carrier] for body in mesh.bodies])
    period = nominal_period(jax.device_get(mesh.design.mesh), against)
    return float(mesh.periods) * float(period)


def _from_outside(built: BuiltTrain, cycles: Sequence[Mapping[str, Any]]) -> dict[str, list[float]]:
    """Mean torques from outside under each law on every body that is turned, loaded or held [N m].

    They are positive as the input turns.
    """
    train = built.design
    sense = float(np.sign(train.rates[built.driver]))
    return {
        body: [sense * float(cycle["torques"][body]) for cycle in cycles]
        for body in cycles[0]["torques"]
        if body not in train.free
    }


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
