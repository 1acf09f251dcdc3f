"""A drive as an actuator of Isaac Lab on PhysX: efforts of friction in SI, from Isaac Sim 5.0 on."""

from pathlib import Path

from pitchpoint.exports.evaluator import module_head
from pitchpoint.exports.simulators import (
    HandedOver,
    Simulated,
    friction_at_load,
    heading,
    holding_friction,
    limit_words,
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
    limits = {
        "effort_limit_sim": joint.torque_limit,
        "velocity_limit_sim": joint.limits["largest_speed"],
    }
    what = "Friction and armature of a joint of Isaac Lab, on PhysX of Isaac Sim 5.0 or later."
    remark = (
        f"friction, the static one, and dynamic_friction are efforts [{unit['torque']}], viscous_friction is "
        f"[{unit['torque']} over {unit['speed']}], armature [{unit['inertia']}]: SI, at the output. "
        "In Isaac Sim 4.5 friction was a coefficient without unit: these numbers are wrong there. In a USD "
        "file angles are degrees, and friction over speed is that over degrees in a second. Dynamic and "
        f"viscous friction are nearest to the loss map at {given.load:.6g} {unit['torque']} and "
        f"{given.temperature:g} degC, static friction is what starts the joint under that load. "
        f"velocity_limit_sim is the end of the map, effort_limit_sim {limit_words(given)}. A motor limits "
        "both together: envelope() gives that for PxPerformanceEnvelope of PhysX 5.6, in USD "
        "PhysxDrivePerformanceEnvelopeAPI, where a rotation counts in degrees; friction is beside it."
    )
    usage = (
        "    from isaac_joint import ACTUATOR, LIMITS\n"
        '    of_elbow = {"joint_names_expr": ["elbow"], "stiffness": ..., "damping": ...}\n'
        "    ImplicitActuatorCfg(**of_elbow, **ACTUATOR, **LIMITS)"
    )
    table = "\n".join(f"    {line}" for line in lost)
    text = (
        f"{module_head([*heading(given, what), remark, usage, table])}\n"
        f"ACTUATOR = {_dictionary(values)}\n"
        '"""Arguments of ActuatorBaseCfg and of what is made of it."""\n\n'
        f"LIMITS = {_dictionary(limits)}\n"
        '"""Largest effort and velocity of the output, arguments likewise."""\n\n'
        f"RATIO = {joint.ratio!r}\n"
        '"""Speed of the driver over that of the output."""\n\n\n'
        f"{_ENVELOPE}"
    )
    write_text(folder / "isaac_joint.py", text)
    return HandedOver([folder / "isaac_joint.py"], lost)


_ENVELOPE = '''def envelope(torque_constant, resistance, voltage, current):
    """Performance envelope of a motor at the output, in SI.

    torque_constant [N m/A] and resistance [ohm] as of a motor of direct current, voltage [V] and the most
    current [A] of its supply. |effort| <= max_effort - velocity_dependent_resistance |velocity| and
    |velocity| <= max_actuator_velocity - speed_effort_gradient |effort|, as PhysX has them. An effort that
    LIMITS forbids is cut off.
    """
    at_output = torque_constant * abs(RATIO)
    return {
        "max_effort": min(at_output * min(current, voltage / resistance), LIMITS["effort_limit_sim"]),
        "max_actuator_velocity": voltage / at_output,
        "velocity_dependent_resistance": 0.0,
        "speed_effort_gradient": resistance / at_output**2,
    }
'''


def _dictionary(values: dict[str, float]) -> str:
    return "{" + ", ".join(f'"{name}": {value:.9g}' for name, value in values.items()) + "}"
