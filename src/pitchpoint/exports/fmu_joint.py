"""A drive as a unit of FMI 2.0 with states: rotor and load, friction, wind-up, play and kinematic error."""

from pathlib import Path

import numpy as np

from pitchpoint.exports.evaluator import comment_text
from pitchpoint.exports.fmu import SimulationUnit, UnitVariable, write_unit
from pitchpoint.exports.simulators import LOCKED_SHARE, HandedOver, Simulated
from pitchpoint.runs.joint_model import AngleWaves, JointModel, WindUpTable

__all__ = ["write_joint_fmu"]

LOOP_TRAVEL = 0.03
"""Travel within which friction of wound up teeth turns, over that by which it winds them up at most."""

BESIDE = (
    "That holds in steady motion, in the mean over the angle. Lost is the change of temperature by the "
    "losses; friction ripples at any load by the part that it does at that of operation, without its jumps "
    "where teeth come to carry."
)

STEPS = (
    "Inside, fixed steps of Runge and Kutta of order four: a hundredth of the shortest period of the wind-up "
    "with the inertia of the load that is set, a thirtieth of the shortest wave of friction and of the "
    "kinematic error, at most 0.1 ms. Where the driver comes to rest within a step, it is found there."
)


def write_joint_fmu(given: Simulated, folder: Path) -> HandedOver:
    """Write the unit with states.

    Args:
        given: the joint.
        folder: of the file.

    Raises:
        InputError: the map is too large for a file of source.
    """
    unit = SimulationUnit(
        f"{given.name}_joint",
        "Joint with states for co-simulation, FMI 2.0: rotor and load, friction that sticks, wind-up, play.",
        _variables(given),
        "joint_motion.h",
        _numbers(given),
        (STEPS, *_holds(given.joint)),
    )
    return write_unit(
        given, folder, unit, "--fmu-joint", f"{BESIDE} {' '.join(_lacks(given.joint))}".strip()
    )


def _variables(given: Simulated) -> list[UnitVariable]:
    unit = given.joint.units
    torque, speed, driver, travel = (unit[name] for name in ("torque", "speed", "driver", "travel"))
    slides, inertia = given.joint.slides, (unit["inertia"], given.joint.armature)
    turning = "rad/s" if driver == "N m" else "m/s"
    turned = "rad" if driver == "N m" else "m"
    return [
        UnitVariable("motor_torque", "of the motor on the driver", driver, 0.0),
        UnitVariable("load_torque", "of the output on its load", torque, 0.0),
        UnitVariable("temperature", "of the oil", "degC", given.temperature),
        UnitVariable("inertia", "of drive and rotor at the output", *inertia, "tunable"),
        UnitVariable("load_inertia", "of the load", *inertia, "tunable"),
        UnitVariable(
            "damping", "of the wind-up", "N s/m" if slides else "N m s/rad", 0.0, "tunable"
        ),
        UnitVariable(
            "ripple",
            "of friction over the angle, 0 for none",
            "1",
            _rippling(given.joint),
            "tunable",
        ),
        UnitVariable("start_angle", "of the driver over the ratio", travel, 0.0, True),
        UnitVariable("start_speed", "of the driver over the ratio", speed, 0.0, True),
        UnitVariable("start_wind_up", "from the middle of the play", travel, 0.0, True),
        UnitVariable("start_wind_up_rate", "of the wind-up", speed, 0.0, True),
        UnitVariable("motor_angle", "of the driver, along that of the output", turned),
        UnitVariable("motor_speed", "of the driver, along that of the output", turning),
        UnitVariable("output_angle", "of the load", travel),
        UnitVariable("output_speed", "of the load", speed),
        UnitVariable("wind_up", "from the middle of the play; 0 of a rigid drive", travel),
        UnitVariable("torque", "of the drive on its output", torque),
        UnitVariable(
            "friction", "torque at the driver against its motion, or that holds it", driver
        ),
        UnitVariable("loss", "power lost to friction", "W"),
        UnitVariable("sticks", "friction holds the driver at rest"),
        UnitVariable("outside", "beyond the map, whose nearest point it is then"),
    ]


def _numbers(given: Simulated) -> str:
    """What the equations ask for, as C has it; arrays of nothing have a place that nothing reads."""
    joint = given.joint
    knots = np.zeros((4, 0)) if joint.wind_up is None else _knots(joint.wind_up)
    waves = joint.kinematic_error
    order, *error = _waves_at_output(joint, waves)
    rippling, *ripple = _waves_at_output(joint, joint.friction_waves)
    arrays = {
        "wind_up": knots[0],
        "wind_up_torque": knots[1],
        "stiffness": knots[2],
        "wave_order": order,
        "wave_amplitude": error[0],
        "wave_phase": error[1],
        "friction_order": rippling,
        "friction_amplitude": ripple[0],
        "friction_phase": ripple[1],
        "loop_torque": knots[3],
    }
    numbers = {
        "ARMATURE": joint.armature,
        "PLAY": joint.play,
        "LOCKED_SHARE": LOCKED_SHARE,
        "STIFFEST": max(knots[2], default=0.0),
        "HIGHEST_ORDER": max(abs(order), default=0.0),
        "FRICTION_ORDER": max(abs(rippling), default=0.0),
        "LOOP_TRAVEL": LOOP_TRAVEL * max(knots[3] / np.maximum(knots[2], 1e-300), default=0.0),
    }
    return (
        f"#define JOINT_MOVES\n#define JOINT_KNOTS {knots.shape[1]}\n#define JOINT_WAVES {order.size}\n"
        f"#define JOINT_FRICTION_WAVES {rippling.size}\n"
        + "".join(f"#define JOINT_{name} {float(value)!r}\n" for name, value in numbers.items())
        + "".join(f"static const double joint_{n}[] = {{{_row(v)}}};\n" for n, v in arrays.items())
    )


def _waves_at_output(joint: JointModel, waves: AngleWaves | None) -> tuple[np.ndarray, ...]:
    """Order over the driver's angle at the output, amplitude and phase; of nothing where there is none."""
    if waves is None:
        return (np.zeros(0),) * 3
    return waves.order * waves.turns * abs(joint.ratio), waves.amplitude, waves.phase


def _rippling(joint: JointModel) -> float:
    return 0.0 if joint.friction_waves is None else 1.0


def _row(values: np.ndarray) -> str:
    few = np.zeros(2) if values.size < 2 else values[:0]
    return ", ".join(map(repr, map(float, (*values, *few))))


def _knots(curve: WindUpTable) -> np.ndarray:
    """Wind-up from first touch, torque and stiffness, and height of the loop, rising from zero."""
    points = np.stack([curve.wind_up, curve.torque, curve.stiffness, curve.held])
    if points[1, 0] > 0.0:
        start = points[0, 0] - points[1, 0] / points[2, 0]
        first = [[start], [0.0], [points[2, 0]], [points[3, 0]]]
        points = np.concatenate([first, points], axis=1)
    points[0] -= points[0, 0]
    return points


def _lacks(joint: JointModel) -> list[str]:
    """What the result has not, of which the unit has none then."""
    sentences = {
        "wind_up": "The drive is rigid and has no play in it",
        "backlash": "It has no play",
        "kinematic_error": "It has no error over the angle",
        "friction_waves": "Its friction does not ripple",
    }
    still = (
        "No inertia of the drive is known: set inertia and load_inertia, without which the unit does not "
        "start."
    )
    moves = [still] if not joint.armature > 0.0 else []
    return moves + [
        f"{words}: {joint.lacks[name]}." for name, words in sentences.items() if name in joint.lacks
    ]


def _holds(joint: JointModel) -> list[str]:
    """Numbers of the joint, and what it has not, as paragraphs."""
    unit, curve = joint.units, joint.wind_up
    stiffness = "rigid"
    if curve is not None:
        slope = f"{curve.at_load:.6g} {unit['torque']}/{unit['travel']}"
        stiffness = f"stiffness {slope} at the load of operation"
    return [
        f"Inertia of drive and rotor at the output {joint.armature:.6g} {unit['inertia']}; {stiffness}; play "
        f"{joint.play:.6g} {unit['travel']}. At rest friction holds what the band of the map holds. Where "
        f"friction locks the drive against its load, friction is {LOCKED_SHARE} times the load.",
        *map(comment_text, _lacks(joint)),
    ]
