"""A drive as a joint of URDF: friction, damping and limits; the rest in a remark."""

from pathlib import Path

from pitchpoint.exports.simulators import (
    HandedOver,
    Simulated,
    friction_at_load,
    heading,
    limit_words,
    lost_without_load,
    xml_comment,
)
from pitchpoint.results.store import write_text

__all__ = ["write_urdf"]

BESIDE = (
    "URDF holds one friction and one damping. Lost are load, temperature and direction, what holds at rest, "
    "the inertia of drive and rotor, stiffness, play, ripple and kinematic error."
)

ENDS = {"revolute": 3.141592653589793, "prismatic": 1.0}
"""Positions in which the joint of the file moves, either way [rad, m]; a robot has its own."""


def write_urdf(given: Simulated, folder: Path) -> HandedOver:
    """Write a robot of two links with the joint between them.

    Args:
        given: the joint.
        folder: of the file.
    """
    fit, joint, unit = friction_at_load(given), given.joint, given.joint.units
    lost = lost_without_load(given, fit, BESIDE)
    what = "Joint of URDF: copy dynamics and limit into the joint of your robot."
    remarks = (
        f"friction [{unit['torque']}] and damping [{unit['torque']} over {unit['speed']}] are nearest to the "
        f"loss map at {given.load:.6g} {unit['torque']} and {given.temperature:g} degC. velocity is "
        f"the end of the map, effort {limit_words(given)}. URDF has no armature: the inertia of "
        f"the drive{'' if joint.rotor_inertia is None else ' and the rotor'} at the output is "
        f"{joint.armature:.6g} {unit['inertia']}."
    )
    kind = "prismatic" if joint.slides else "revolute"
    text = (
        f'<?xml version="1.0"?>\n{xml_comment([*heading(given, what), remarks, chr(10).join(lost)])}'
        f'<robot name="{given.name}">\n  <link name="base"/>\n  <link name="output">\n    <inertial>\n'
        '      <mass value="1"/>\n      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>\n'
        f'    </inertial>\n  </link>\n  <joint name="{given.name}_joint" type="{kind}">\n'
        '    <parent link="base"/>\n    <child link="output"/>\n    <axis xyz="0 0 1"/>\n'
        f'    <limit effort="{joint.torque_limit:.9g}" '
        f'velocity="{joint.limits["largest_speed"]:.9g}" lower="{-ENDS[kind]}" upper="{ENDS[kind]}"/>\n'
        f'    <dynamics damping="{fit.viscous:.9g}" friction="{fit.constant:.9g}"/>\n'
        "  </joint>\n</robot>\n"
    )
    write_text(folder / "joint.urdf", text)
    return HandedOver([folder / "joint.urdf"], lost)
