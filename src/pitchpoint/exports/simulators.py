"""A drive for simulators: what all of them are told, and how far each is off the loss map."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from textwrap import fill, wrap
from typing import NamedTuple

import numpy as np

from pitchpoint.efficiency.friction_fit import (
    WAYS,
    FrictionFit,
    LawError,
    LossLaw,
    MapRange,
    fit_friction,
    loss_nodes,
)
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import SIGNS, comment_text
from pitchpoint.input.quantities import shown
from pitchpoint.results.store import make_folder
from pitchpoint.runs.joint_model import PARTS, JointModel, joint_model, part_of_map, si_quantity
from pitchpoint.runs.run import Outcome
from pitchpoint.units import degrees_celsius

__all__ = [
    "TARGETS",
    "Asked",
    "HandedOver",
    "Simulated",
    "friction_at_load",
    "hand_over",
    "heading",
    "holding_friction",
    "limit_words",
    "lost_lines",
    "lost_without_load",
    "most_torque",
    "option_of",
    "xml_comment",
]

TARGETS: Mapping[str, str] = {
    "mujoco": "pitchpoint.exports.mujoco:write_mujoco",
    "urdf": "pitchpoint.exports.urdf:write_urdf",
    "ros2_control": "pitchpoint.exports.ros2_control:write_ros2_control",
    "isaac": "pitchpoint.exports.isaac:write_isaac",
    "modelica": "pitchpoint.exports.modelica:write_modelica",
    "fmu": "pitchpoint.exports.fmu:write_fmu",
    "fmu_joint": "pitchpoint.exports.fmu_joint:write_joint_fmu",
    "simscape": "pitchpoint.exports.simscape:write_simscape",
}
"""Where each target of a hand-over is written, by the name of its folder and option."""


LOCKED_SHARE = 1.05
"""Friction over the load that holds it where friction locks the drive, of which the map has no number."""


@dataclass(frozen=True)
class Asked:
    """What somebody wants of a hand-over, as it was written.

    Attributes:
        law: of friction, by name.
        rotor_inertia: of the motor about its own axis.
        load: of the output at which friction that knows no load is right.
        temperature: of the oil, where it knows none.
        torque_range, speed_range: of the output, "LEAST:LARGEST", to which friction is fitted.
    """

    law: str | None = None
    rotor_inertia: str | None = None
    load: str | None = None
    temperature: str | None = None
    torque_range: str | None = None
    speed_range: str | None = None


class Simulated(NamedTuple):
    """What a writer is given.

    Attributes:
        outcome: the result.
        joint: of it.
        load: at which friction without load is right [torque of the output].
        temperature: as the files have it [degC].
        within: part of the map that counts, or None for all of it.
    """

    outcome: Outcome
    joint: JointModel
    load: float
    temperature: float
    within: MapRange | None

    @property
    def kelvins(self) -> float:
        """The temperature as the joint takes it [K]."""
        return self.temperature + 273.15

    @property
    def fit(self) -> FrictionFit:
        """Friction with constant, load and speed nearest to the map."""
        return self.joint.fit(temperature=self.kelvins, within=self.within)

    @property
    def name(self) -> str:
        """Of the joint, made of letters, digits and underlines: that of the case."""
        plain = re.sub(r"\W+", "_", Path(self.joint.case).stem, flags=re.ASCII).strip("_")
        return plain if plain[:1].isalpha() else f"drive_{plain}".rstrip("_")


class HandedOver(NamedTuple):
    """Files of a target, and the lines that say what is lost in them."""

    paths: list[Path]
    lost: list[str]


Writer = Callable[[Simulated, Path], HandedOver]


def hand_over(
    outcomes: Mapping[str, Outcome],
    folder: Path,
    targets: Iterable[str],
    asked: Asked | None = None,
) -> dict[str, HandedOver]:
    """Write the joint of a result for simulators, each into a folder of its name.

    Args:
        outcomes: by variant; each of several has a folder of its own.
        folder: where those go.
        targets: of `TARGETS`.
        asked: what is wanted; what the case says by default.

    Returns:
        Files and what is lost in them, by target, before it the variant of several.

    Raises:
        InputError: the result has no loss map of the output, what is asked for is not in it, or the folder
            cannot be written to.
    """
    written = {}
    for name, outcome in outcomes.items():
        several = len(outcomes) > 1
        for target in targets:
            place = (folder / name if several else folder) / target
            simulated = _simulated(outcome, asked or Asked(), option_of(target))
            make_folder(place)
            paths, lost = _writer(target)(simulated, place)
            lines = [*lost, *wrap(_beside_map(simulated), 78)]
            written[f"{name}: {target}" if several else target] = HandedOver(paths, lines)
    return written


def option_of(target: str) -> str:
    """The option of a target or a format on the command line.

    Example:
        >>> option_of("ros2_control")
        '--ros2-control'
    """
    return "--" + target.replace("_", "-")


def _writer(target: str) -> Writer:
    module, _, name = TARGETS[target].partition(":")
    writer: Writer = getattr(import_module(module), name)
    return writer


_OF_OTHERS = "the loss map of the output is not as this version writes it; run the case again"

_UNITS = {"N m", "N", "rad/s", "m/s"}
"""Units of a loss map, which stand in sources as they are."""


_OPTIONS = {"law": "--law", "rotor_inertia": "--rotor-inertia"}
"""Where somebody gave what a joint is asked for, by the name that it has in Python."""


def _simulated(outcome: Outcome, asked: Asked, key: str) -> Simulated:
    try:
        joint = joint_model(outcome, law=asked.law, rotor_inertia=asked.rotor_inertia)
    except (AttributeError, LookupError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise error.at(key=_OPTIONS.get(error.key or "", error.key or key)) from None
        raise InputError(_OF_OTHERS, key=key) from None
    if not {*joint.table.units} <= _UNITS:
        raise InputError(_OF_OTHERS, key=key)
    load = si_quantity(asked.load, joint.units["torque"], "--load")
    warm = si_quantity(asked.temperature, "K", "--temperature")
    degrees = joint.table.temperatures
    degree = _nearest_of_map(joint) if warm is None else float(degrees_celsius(np.asarray(warm)))
    for value, axis, of, text, unit in (
        (load or 0.0, joint.table.torques, "--load", asked.load, joint.units["torque"]),
        (degree, degrees, "--temperature", asked.temperature, "degC"),
    ):
        if not axis[0] <= value <= axis[-1]:
            ends = f"{max(axis[0], 0.0):.6g} to {axis[-1]:.6g} {unit}"
            raise InputError(f"{shown(text)} is beyond the map, which goes from {ends}", key=of)
    within = part_of_map(joint, asked.torque_range, asked.speed_range, warm)
    return Simulated(outcome, joint, joint.load if load is None else load, degree, within)


def _nearest_of_map(joint: JointModel) -> float:
    """The temperature of operation, or the nearest of a map that has others [degC]."""
    degrees = joint.table.temperatures
    return min(max(float(degrees_celsius(np.asarray(joint.temperature))), degrees[0]), degrees[-1])


def _beside_map(given: Simulated) -> str:
    """A sentence where the nearest of the map stands for the temperature of operation."""
    degree = float(degrees_celsius(np.asarray(given.joint.temperature)))
    edge = _nearest_of_map(given.joint)
    if edge == degree or given.temperature != edge:
        return ""
    return (
        f"The map has nothing of the {degree:.4g} degC of operation: what has one temperature has its "
        f"nearest, {edge:.4g} degC, unless --temperature says another."
    )


def heading(given: Simulated, what: str) -> Iterator[str]:
    """Paragraphs that stand at the head of every file: what it is, of which drive, and its signs."""
    joint, unit = given.joint, given.joint.units
    yield what
    yield comment_text(
        f"{joint.title}: {joint.driver} drives {joint.output}. Case {joint.case}, variant {joint.variant}, "
        f"digest {joint.digest}, friction law {joint.law}, Pitchpoint {joint.version}."
    )
    turns = "against" if joint.ratio < 0.0 else "with"
    yield SIGNS + (
        f" The ratio is {abs(joint.ratio):.9g}; {comment_text(joint.driver)} itself turns {turns} "
        "the output. "
        f"Units: {unit['torque']}, {unit['speed']}, {unit['inertia']}, {unit['driver']} at the driver, degC."
    )
    yield comment_text(
        f"The loss map goes to {joint.limits['largest_torque']:.6g} {unit['torque']} and "
        f"{joint.limits['largest_speed']:.6g} {unit['speed']} of the output, and from "
        f"{joint.table.temperatures[0]:g} to {joint.table.temperatures[-1]:g} degC. {_beside_map(given)}"
    )
    if joint.part_limits:
        yield (
            "Torque of the output at which a safety is 1, by those under the load of operation: "
            + ", ".join(f"{PARTS[name]} {value:.6g}" for name, value in joint.part_limits.items())
            + f" {unit['torque']}. Loads and lives that change are another matter: see a duty cycle."
        )
    if joint.lacks:
        yield "Not known of this drive: " + comment_text(
            "; ".join(f"{name.replace('_', ' ')} ({why})" for name, why in joint.lacks.items())
            + "."
        )


def lost_lines(given: Simulated, law: LossLaw, beside: str) -> list[str]:
    """Table of what is lost: error of the torque of the driver, over the map and where somebody asked.

    Args:
        given: the joint.
        law: lost torque of the target over torque along the motion, speed and temperature.
        beside: what else the target leaves out, in a sentence.
    """
    joint, unit = given.joint, given.joint.units["driver"]
    rows: list[tuple[str, LawError]] = [("the map", error) for error in joint.errors(law)]
    if given.within is not None:
        rows += [("range", error) for error in joint.errors(law, given.within)]
    lines = [f"What is lost: torque of the driver, this file against the loss map [{unit}]"]
    lines.append(f"{'in':8}{'quadrants':26}{'largest':>11}{'mean':>11}{'of peak':>11}{'points':>8}")
    lines += [_row(place, error) for place, error in rows]
    if given.within is not None:
        lines.append(_range_words(given))
    locked = sum(error.locked for place, error in rows if place == "the map")
    if locked:
        lines.append(
            f"Friction locks the drive at {locked} more points, where the map has no torque."
        )
    return [*lines, *wrap(beside, 78)]


def nothing_lost(beside: str) -> list[str]:
    """The same of a target that has the numbers of the map: held against themselves they would tell nothing.

    Args:
        beside: what the target leaves out, in a sentence.
    """
    sentence = "What is lost: nothing of the torque of the driver, by construction: the map itself is in it."
    return wrap(f"{sentence} {beside}", 78)


def lost_without_load(given: Simulated, fit: FrictionFit, beside: str) -> list[str]:
    """The same of a target whose friction knows no load, see `friction_at_load`."""
    return lost_lines(given, lambda torque, speed, _: fit.lost(0.0 * torque, speed), beside)


def _row(place: str, error: LawError) -> str:
    quadrants = f"{error.quadrants} ({WAYS[error.quadrants]})"
    if not error.points:
        return f"{place:8}{quadrants:26}{'none: friction locks the drive':>39}"
    numbers = f"{error.largest:>11.4g}{error.mean:>11.4g}{100.0 * error.share:>9.3g} %"
    return f"{place:8}{quadrants:26}{numbers}{error.points:>8}"


def _range_words(given: Simulated) -> str:
    within = given.within
    assert within is not None
    (low, high), (slow, fast) = within.torque, within.speed
    unit = given.joint.units
    return (
        f"The range: {low:.4g} to {high:.4g} {unit['torque']}, {slow:.4g} to {fast:.4g} {unit['speed']}, "
        f"{given.temperature:.4g} degC."
    )


def friction_at_load(given: Simulated) -> FrictionFit:
    """Constant and viscous friction nearest to the map at one load, whichever end drives.

    Where friction locks the drive against the load, the constant holds it instead.
    """
    joint, within = given.joint, given.within
    nodes = loss_nodes(joint.table, joint.law, within=within, temperature=given.kelvins)
    speeds = np.unique(nodes.speed)
    torque, speed = (
        v.ravel() for v in np.meshgrid([-given.load, given.load], speeds, indexing="ij")
    )
    lost = np.asarray(joint.loss_torque(torque, speed, given.kelvins))
    stuck = np.isnan(lost)
    alone = np.asarray(joint.loss_torque(0.0 * torque, speed, given.kelvins))
    lost = np.where(stuck, LOCKED_SHARE * given.load + np.nan_to_num(alone), lost)
    if stuck.any():
        return FrictionFit(float(lost[stuck].max()), 0.0, 0.0, 0.0)
    return fit_friction(np.zeros(torque.size), speed, lost)


def holding_friction(given: Simulated, moving: float) -> float:
    """Friction at rest under the load: the mean of what starts the output on and back [torque of the output].

    Args:
        given: the joint.
        moving: friction in motion, below which it is not, as simulators ask.
    """
    joint, ratio = given.joint, given.joint.table.speed_ratio
    band = joint.holding_band(given.load, given.kelvins)
    both = [band.highest / ratio - given.load, given.load - band.lowest / ratio]
    finite = [friction for friction in both if math.isfinite(friction)]
    stuck = [LOCKED_SHARE * given.load] if len(finite) < 2 else []
    return max(moving, sum(finite) / max(len(finite), 1), *stuck)


def limit_words(given: Simulated) -> str:
    """What the largest torque of the output in a file is, which is not what a motor gives."""
    joint = given.joint
    if joint.torque_limit < joint.limits["largest_torque"]:
        return "the least torque that a part of it bears, not what a motor gives"
    return "the end of the map, not what a motor gives" + (
        "" if joint.part_limits else " or the teeth bear, which the result does not know"
    )


def most_torque(given: Simulated) -> float:
    """Torque of the driver for the largest torque of the output that is allowed, or its load if more."""
    table, joint = given.joint.table, given.joint
    most = min(table.torques[-1], max(joint.torque_limit, given.load))
    lost = (table.lost(most, n, given.temperature, joint.law) for n in table.speeds)
    return (most + max(0.0, *lost)) * table.speed_ratio


def xml_comment(paragraphs: Iterable[str]) -> str:
    """Paragraphs as a comment of XML, in which two hyphens may not stand side by side."""
    lines = (
        paragraph if "\n" in paragraph else fill(paragraph, 100, break_long_words=False)
        for paragraph in paragraphs
    )
    text = "\n\n".join(lines).translate({38: "and", 60: "(", 62: ")"})
    return "<!--\n" + re.sub(r"-(?=-)", "- ", text).rstrip("-") + "\n-->\n"
