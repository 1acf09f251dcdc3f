"""Friction of a joint of MuJoCo, renewed from the loss map of its drive before each step.

Nothing but the standard library is used, and the model and data of MuJoCo that it is given: an export hands
these lines over with the map.
"""

import math
from pathlib import Path
from typing import Any

from pitchpoint.efficiency.loss_table import LossTable

__all__ = ["LoadFriction", "show_arm"]

HOLDS = (0.002, 1.0), (0.9999, 0.9999, 0.001, 0.5, 2.0)
"""Parameters of MuJoCo's solver, solreffriction and solimpfriction, with which friction hardly creeps."""

FRICTION_DOF = 1
"""Number of MuJoCo's constraints by friction of a joint, mjCNSTR_FRICTION_DOF."""

LEAST = 1e-12
"""Friction below which MuJoCo makes no constraint, whose force would not be known then."""


class LoadFriction:
    """Friction of a joint that follows its load, speed and temperature.

    Args:
        model: of MuJoCo, mjModel; damping of the joint is set to zero, for the map has it.
        joint: its name, a hinge or a slide at the output of the drive.
        table: the loss map.
        temperature: of the oil [degC]; an attribute that may be changed at any time.
        law: of friction; the first one by default.
        rest_speed: below it the joint rests [speed of the output]; a tenth of the map's lowest by default.
        locked_share: friction over the load where it locks the drive, of which the map has no number.

    Motor torques are those of actuators; what else acts on the joint is its load. A step uses the load of the
    step before it. Where the joint rests, friction is what starts it in the direction that the motor
    pushes, from `LossTable.at_rest`.

    Example:
        >>> from types import SimpleNamespace
        >>> from pitchpoint.efficiency.loss_table import LossTable
        >>> from pitchpoint.exports.mujoco_joint import LoadFriction
        >>> lost = {"own": (((1.0,), (1.0,)), ((0.5,), (0.5,)), ((1.0,), (1.0,)))}
        >>> table = LossTable((-2.0, 0.0, 2.0), (0.0, 10.0), (40.0,), lost, 0.02)
        >>> model = SimpleNamespace(joint=lambda name: SimpleNamespace(dofadr=[0]))
        >>> model.dof_damping, model.dof_solref, model.dof_solimp = [3.0], [None], [None]
        >>> LoadFriction(model, "elbow", table, 40.0).friction(motor=5.0, load=1.0, speed=4.0)
        0.75
    """

    def __init__(
        self,
        model: Any,
        joint: str,
        table: LossTable,
        temperature: float,
        law: str = "",
        rest_speed: "float | None" = None,
        locked_share: float = 1.05,
    ) -> None:
        self.dof = int(model.joint(joint).dofadr[0])
        self.table, self.temperature, self.law = table, temperature, law
        self.rest_speed = 0.1 * table.speeds[1] if rest_speed is None else rest_speed
        self.locked_share = locked_share
        model.dof_damping[self.dof] = 0.0
        model.dof_solref[self.dof], model.dof_solimp[self.dof] = HOLDS

    def update(self, model: Any, data: Any) -> None:
        """Renew the friction; to be called before each `mj_step`.

        Args:
            model: mjModel, whose dof_frictionloss is changed.
            data: mjData after the step before.
        """
        motor, speed = float(data.qfrc_actuator[self.dof]), float(data.qvel[self.dof])
        now = self.friction(motor, self.load(model, data), speed)
        model.dof_frictionloss[self.dof] = max(now, LEAST)

    def load(self, model: Any, data: Any) -> float:
        """Torque of the output on its load in the last step, along positive speeds."""
        inertial = float(model.dof_armature[self.dof]) * float(data.qacc[self.dof])
        return float(data.qfrc_actuator[self.dof]) + self.held(data) - inertial

    def held(self, data: Any) -> float:
        """Torque of the friction on the joint in the last step, along positive speeds."""
        for row in range(data.ne, data.ne + data.nf):
            if data.efc_type[row] == FRICTION_DOF and data.efc_id[row] == self.dof:
                return float(data.efc_force[row])
        return 0.0

    def friction(self, motor: float, load: float, speed: float) -> float:
        """Largest torque of friction at the output.

        Args:
            motor: torque of the motor at the output, along positive speeds.
            load: torque of the output on its load, along positive speeds.
            speed: of the output.
        """
        if abs(speed) < self.rest_speed:
            return self._at_rest(motor, load)
        along = math.copysign(1.0, speed) * load
        lost = self.table.lost(along, abs(speed), self.temperature, self.law)
        return lost if lost >= 0.0 else self._locked(load, abs(speed))

    def _at_rest(self, motor: float, load: float) -> float:
        band = self.table.at_rest(load, self.temperature, self.law)
        bound = band.highest if motor >= load else band.lowest
        held = abs(bound / self.table.speed_ratio - load)
        return held if held >= 0.0 else self._locked(load, 0.0)

    def _locked(self, load: float, speed: float) -> float:
        """Friction that holds a load: more than it, beside what is lost without one."""
        alone = self.table.lost(0.0, speed, self.temperature, self.law)
        return self.locked_share * abs(load) + (alone if alone > 0.0 else 0.0)


def show_arm(
    table: LossTable, temperature: float, law: str, folder: Path, joint: str = "drive"
) -> None:
    """Lift, hold and lower the arm of arm.xml with MuJoCo, and print torques beside those of the map.

    Args:
        table: the loss map.
        temperature: of the oil [degC].
        law: of friction.
        folder: where arm.xml is.
        joint: its name there.
    """
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(folder / "arm.xml"))
    data, gain = mujoco.MjData(model), 200.0 * (model.dof_M0[0] + model.dof_armature[0])
    friction = LoadFriction(model, joint, table, temperature, law)
    gear = float(model.actuator_gear[0, 0])
    print(f"{'':8}{'speed':>11}{'load':>17}{'torque of the driver':>23}{'by the map':>18}")
    slow = min(0.2 * table.speeds[-1], 0.5)  # so that the arm is far from upright after all
    for what, sought in (("lifts", slow), ("holds", 0.0), ("lowers", -slow)):
        for _ in range(int(0.5 / model.opt.timestep)):
            weight = float(data.qfrc_bias[0])
            data.ctrl[0] = (weight + gain * (sought - float(data.qvel[0]))) / gear  # of a servo
            friction.update(model, data)
            mujoco.mj_step(model, data)
        here, motor = float(data.qvel[0]), float(data.actuator_force[0])  # within ctrlrange
        load = friction.load(model, data)
        point, band = table.at(load, here, temperature, law), table.at_rest(load, temperature, law)
        beside = (
            f"{point.input_torque:.6g}" if sought else f"{band.lowest:.4g} to {band.highest:.4g}"
        )
        print(f"{what:8}{here:+11.3e}{load:+17.6g}{motor:23.6g}{beside:>18}")
