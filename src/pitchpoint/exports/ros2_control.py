"""A drive as a transmission of ros2_control: its ratio, and nothing of what it loses."""

from pathlib import Path

from pitchpoint.exports.simulators import (
    HandedOver,
    Simulated,
    heading,
    limit_words,
    lost_lines,
    xml_comment,
)
from pitchpoint.results.store import write_text

__all__ = ["write_ros2_control"]

BESIDE = (
    "ros2_control takes power through a transmission without a loss: all of it is lost, as are stiffness and "
    "play. The evaluator (--evaluator) has the torque of the driver, for a controller to add."
)


def write_ros2_control(given: Simulated, folder: Path) -> HandedOver:
    """Write the element of a transmission, to be put into ros2_control of a robot.

    Args:
        given: the joint.
        folder: of the file.
    """
    lost = lost_lines(given, lambda torque, speed, _: 0.0 * torque, BESIDE)
    what = (
        "Transmission of ros2_control: put it beside the joint in the ros2_control element of your robot, "
        "and give joint and actuator their names there."
    )
    remark = (
        "mechanical_reduction is the speed of the driver over that of the output; it is negative where they "
        "turn opposite ways. A motor that is mounted the other way round changes its sign. The joint takes "
        f"its limits as min and max of its command_interface: effort {given.joint.torque_limit:.6g}, which "
        f"is {limit_words(given)}, velocity {given.joint.limits['largest_speed']:.6g}, the end of the map."
    )
    text = (
        f"{xml_comment([*heading(given, what), remark, chr(10).join(lost)])}"
        f'<transmission name="{given.name}_transmission">\n'
        "  <plugin>transmission_interface/SimpleTransmission</plugin>\n"
        f'  <actuator name="{given.name}_motor" role="actuator1"/>\n'
        f'  <joint name="{given.name}_joint" role="joint1">\n'
        f"    <mechanical_reduction>{given.joint.ratio:.12g}</mechanical_reduction>\n"
        "  </joint>\n</transmission>\n"
    )
    write_text(folder / "transmission.xml", text)
    return HandedOver([folder / "transmission.xml"], lost)
