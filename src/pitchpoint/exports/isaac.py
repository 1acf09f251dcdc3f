"""A drive as an actuator of Isaac Lab on PhysX: efforts of friction in SI, from Isaac Sim 5.0 on."""

from pathlib import Path

from pitchpoint.exports.evaluator import module_head
from pitchpoint.exports.simulators import (
    HandedOver,
    Simulated,
    friction_at_load,
    heading,
    holding_friction,
    lost_without_load,
)
from pitchpoint.results.store import write_text

__all__ = ["write_isaac"]

BESIDE = (
    "PhysX holds one static, dynamic and viscous friction. Lost are load, temperature and direction, "
    "stiffness, play, ripple and kinematic error."
)


def write_isaac(given: Simulated, folder: Path) -> HandedOver:
    """Write the arguments of an actuator configuration of Isaac Lab.

    Args:
        given: the joint.
        folder: of the file.
    """
    joint, unit, fit = given.joint, given.joint.units, friction_at_load(given)
    lost = lost_without_load(given, fit, BESIDE)
    values = {
        "friction": holding_friction(given, fit.constant),
        "dynamic_friction": fit.constant,
        "viscous_friction": fit.viscous,
        "armature": joint.armature,
    }
    ends = {"effort": joint.limits["largest_torque"], "velocity": joint.limits["largest_speed"]}
    what = "Friction and armature of a joint of Isaac Lab, on PhysX of Isaac Sim 5.0 or later."
    remark = (
        f"friction, the static one, and dynamic_friction are efforts [{unit['torque']}], viscous_friction is "
        f"[{unit['torque']} over {unit['speed']}], armature [{unit['inertia']}]: SI, at the output. "
        "In Isaac Sim 4.5 friction was a coefficient without unit: these numbers are wrong there. In a USD "
        "file angles are degrees, and friction over speed is that over degrees in a second. Dynamic and "
        f"viscous friction are nearest to the loss map at {given.load:.6g} {unit['torque']} and "
        f"{given.temperature:g} degC, static friction is what starts the joint under that load. MAP_ENDS are "
        "the ends of the map, not what a motor or the teeth bear."
    )
    usage = (
        "    from isaac_joint import ACTUATOR\n"
        '    ImplicitActuatorCfg(joint_names_expr=["elbow"], stiffness=..., damping=..., **ACTUATOR)'
    )
    table = "\n".join(f"    {line}" for line in lost)
    text = (
        f"{module_head([*heading(given, what), remark, usage, table])}\n"
        f"ACTUATOR = {_dictionary(values)}\n"
        '"""Arguments of ActuatorBaseCfg and of what is made of it."""\n\n'
        f"MAP_ENDS = {_dictionary(ends)}\n"
        '"""Largest effort and velocity of the output in the loss map."""\n\n'
        f"RATIO = {joint.ratio!r}\n"
        '"""Speed of the driver over that of the output."""\n'
    )
    write_text(folder / "isaac_joint.py", text)
    return HandedOver([folder / "isaac_joint.py"], lost)


def _dictionary(values: dict[str, float]) -> str:
    return "{" + ", ".join(f'"{name}": {value:.9g}' for name, value in values.items()) + "}"
