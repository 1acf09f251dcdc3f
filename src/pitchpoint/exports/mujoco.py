"""A drive as a joint of MuJoCo: a fragment of MJCF, friction that follows the load, an arm to try it."""

import math
import re
from importlib.resources import files
from pathlib import Path

from pitchpoint.efficiency.friction_fit import FrictionFit
from pitchpoint.exports.evaluator import (
    comment_text,
    demand_small_table,
    map_code,
    module_head,
    source_after_statements,
)
from pitchpoint.exports.mujoco_joint import HOLDS
from pitchpoint.exports.simulators import (
    HandedOver,
    Simulated,
    friction_at_load,
    heading,
    limit_words,
    lost_without_load,
    most_torque,
    xml_comment,
)
from pitchpoint.results.store import write_text

__all__ = ["write_mujoco"]

GRAVITY = 9.81

BESIDE = (
    "joint_friction.py follows load, speed and temperature, and loses nothing of this. The fragment alone "
    "knows neither load nor temperature. Ripple and kinematic error are in neither."
)


def write_mujoco(given: Simulated, folder: Path) -> HandedOver:
    """Write the fragment, the module that renews friction, and arms with and without a spring.

    Args:
        given: the joint.
        folder: of the files.

    Raises:
        InputError: the map is too large for a file of source.
    """
    demand_small_table(given.joint.table, "--mujoco")
    fit = friction_at_load(given)
    lost = lost_without_load(given, fit, BESIDE)
    texts = {
        "joint.xml": _fragment(given, fit, lost),
        "joint_friction.py": _module(given),
        "arm.xml": _arm(given),
    }
    if given.joint.wind_up is not None:
        texts["arm_with_spring.xml"] = _arm_with_spring(given)
    for name, text in texts.items():
        write_text(folder / name, text)
    return HandedOver([folder / name for name in texts], lost)


def _fragment(given: Simulated, fit: FrictionFit, lost: list[str]) -> str:
    joint, name = given.joint, given.name
    unit = joint.units
    what = (
        f"Joint of MuJoCo 4: class {name} of a joint and its motor. In a model: include file=joint.xml, then "
        f"joint class={name} and motor class={name}; ctrl is the torque of the driver in {unit['driver']}."
    )
    head = [
        *heading(given, what),
        f"frictionloss and damping are nearest to the map at {given.load:.6g} {unit['torque']} and "
        f"{given.temperature:g} degC; MuJoCo has no friction that grows with the load. armature is that of "
        f"the drive{'' if joint.rotor_inertia is None else ' and the rotor'} at the output; ctrlrange is "
        f"the torque of the driver at {limit_words(given)}. solreffriction and solimpfriction keep a "
        "joint at rest that would creep by degrees a second with the usual ones.",
        "\n".join(lost),
    ]
    return (
        f"{xml_comment(head)}<mujoco>\n  <default>\n"
        f'    <default class="{name}">\n'
        f'      <joint type="{_kind(given)}" armature="{joint.armature:.9g}" damping="{fit.viscous:.9g}" '
        f'frictionloss="{fit.constant:.9g}"\n        {_solver()}/>\n'
        f'      <motor gear="{abs(joint.ratio):.12g}" ctrllimited="true" '
        f'ctrlrange="-{most_torque(given):.6g} {most_torque(given):.6g}"/>\n'
        f"{_spring(given)}    </default>\n  </default>\n</mujoco>\n"
    )


def _solver() -> str:
    ref, imp = (" ".join(f"{number:g}" for number in values) for values in HOLDS)
    return f'solreffriction="{ref}" solimpfriction="{imp}"'


def _kind(given: Simulated) -> str:
    return "slide" if given.joint.slides else "hinge"


def _spring(given: Simulated) -> str:
    """Class of a joint behind the drive that winds up, where that is known."""
    curve = given.joint.wind_up
    if curve is None:
        return ""
    return (
        f'      <default class="{given.name}_spring">\n'
        f'        <joint type="{_kind(given)}" stiffness="{curve.at_load:.9g}" armature="0" damping="0" '
        'frictionloss="0"/>\n      </default>\n'
    )


def _mass(given: Simulated) -> float:
    """Mass on an arm of half a metre, or on the slide, whose weight is the load."""
    arm = 1.0 if given.joint.slides else 0.5
    return max(given.load, 1e-3 * given.joint.limits["largest_torque"]) / GRAVITY / arm


def _head_of_arm(given: Simulated, step: str) -> str:
    return (
        f"{xml_comment(['An arm on this drive, to try it by python joint_friction.py.'])}"
        f'<mujoco model="{given.name}">\n  <compiler angle="radian"/>\n'
        f'  <option timestep="{step}" gravity="0 0 -{GRAVITY}" integrator="implicitfast"/>\n'
        '  <include file="joint.xml"/>\n'
    )


def _weight(given: Simulated) -> tuple[str, str]:
    """Axis of the joint and the load on it."""
    place = "0 0 0" if given.joint.slides else "0.5 0 0"
    axis = "0 0 1" if given.joint.slides else "0 -1 0"
    size = max(0.02, 0.02 * math.cbrt(_mass(given)))
    return axis, f'<geom type="sphere" pos="{place}" size="{size:.4g}" mass="{_mass(given):.9g}"/>'


def _arm(given: Simulated) -> str:
    axis, weight = _weight(given)
    return (
        f"{_head_of_arm(given, '0.0005')}  <worldbody>\n    <body>\n"
        f'      <joint name="drive" class="{given.name}" axis="{axis}"/>\n      {weight}\n'
        "    </body>\n  </worldbody>\n  <actuator>\n"
        f'    <motor class="{given.name}" joint="drive"/>\n  </actuator>\n</mujoco>\n'
    )


def _arm_with_spring(given: Simulated) -> str:
    """Rotor and drive, play where there is some, the spring of the wind-up, the load."""
    axis, weight = _weight(given)
    light = f'<inertial pos="0 0 0" mass="{1e-6 * _mass(given):.3g}" diaginertia="1e-6 1e-6 1e-6"/>'
    kind = _kind(given)
    play = _play(given, axis, kind)
    return (
        f"{_head_of_arm(given, '0.0001')}  <worldbody>\n    <body>\n"
        f'      <joint name="drive" class="{given.name}" axis="{axis}"/>\n      {light}\n'
        f"      <body>\n{play}"
        f'        <joint name="wind_up" class="{given.name}_spring" axis="{axis}"/>\n        {weight}\n'
        "      </body>\n    </body>\n  </worldbody>\n  <actuator>\n"
        f'    <motor class="{given.name}" joint="drive"/>\n  </actuator>\n</mujoco>\n'
    )


def _play(given: Simulated, axis: str, kind: str) -> str:
    """Joint that is free within the backlash; a remark where there is none."""
    play = given.joint.play
    if play < 1e-9:
        words = comment_text("no backlash is known: a joint with limited range would be it")
        return f"        <!-- {words} -->\n"
    half = f"{0.5 * play:.9g}"
    return (
        f'        <joint name="play" type="{kind}" axis="{axis}" limited="true" range="-{half} {half}" '
        f'armature="{1e-3 * given.joint.armature:.9g}" solreflimit="0.0005 1"/>\n'
    )


def _module(given: Simulated) -> str:
    """The map and the class that renews friction, in a file that needs nothing else."""
    joint = given.joint
    source = files("pitchpoint.exports").joinpath("mujoco_joint.py").read_text("utf-8")
    usage = [
        "    import mujoco",
        "    from joint_friction import renewed_friction",
        '    friction = renewed_friction(model, "NAME OF THE JOINT", temperature=40.0)',
        "    while True:",
        "        friction.update(model, data)",
        "        mujoco.mj_step(model, data)",
    ]
    what = "Friction of a joint of MuJoCo that follows its load, renewed from a loss map before each step."
    closing = (
        "python joint_friction.py lifts, holds and lowers the arm of arm.xml. Python 3.10 or later."
    )
    head = module_head([*heading(given, what), "\n".join(usage), closing])
    names = ["ABOUT", "TABLE", "LoadFriction", "at", "at_many", "at_rest", "renewed_friction"]
    code = re.sub(
        r"^ *>{3} from pitchpoint.*\n", "", source_after_statements(source, 6), flags=re.M
    )
    given_text = f"temperature={given.temperature!r}, law={joint.law!a}"
    return (
        f"{head}{map_code(given.outcome, joint.table, names)}\n"
        f"from pathlib import Path\n{code}\n\n"
        "def renewed_friction(model, joint, "
        f'{given_text}):\n    """Friction of a joint by this map, see `LoadFriction`."""\n'
        "    return LoadFriction(model, joint, TABLE, temperature, law)\n\n\n"
        'if __name__ == "__main__":\n'
        f"    show_arm(TABLE, {given.temperature!r}, {joint.law!a}, Path(__file__).parent)\n"
    )
