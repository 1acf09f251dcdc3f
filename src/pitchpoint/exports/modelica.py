"""A drive as a package of Modelica: `LossyGear`, a table for each temperature, and the loss map itself."""

from collections.abc import Iterable
from functools import partial
from html import escape
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

import numpy as np
from scipy.optimize import lsq_linear

from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports.evaluator import comment_text
from pitchpoint.exports.modelica_map import MAP_GEAR, MapTables, map_gear, map_lost, map_tables
from pitchpoint.exports.simulators import HandedOver, Simulated, heading, lost_lines
from pitchpoint.results.store import write_text

__all__ = ["LossyRow", "least_line_error", "lossy_rows", "lossy_torque", "write_modelica"]

NEAREST = 1e-9
"""How near to one an efficiency may come: LossyGear divides by eta_mf1 - 1/eta_mf2."""

LEAST_EFFICIENCY = 1e-6
"""Efficiency that stands for none where friction locks the drive, which LossyGear cannot say."""

BESIDE = (
    "Losses of LossyGear are a line over the torque of the driver, one for either way of the power, and "
    "linear over the speed. Lost are ripple and kinematic error, and the change of temperature while it runs."
)
LOSSY_WORDS = (
    "Loss of the map as lines over the torque of the driver, by least squares, one for either way of the "
    "power, at the temperature of the name."
)
JOINT_WORDS = (
    "Rotor and drive, then the gear with its losses, then wind-up and backlash, where elastic is true. "
    "Stiffness, damping and backlash are those of the shaft behind the gear."
)
LOCKS = (
    "Friction locks this drive against its load; LossyGear cannot lock, and lets the load turn it."
)


class LossyRow(NamedTuple):
    """A row of `lossTable`.

    Attributes:
        speed: of the driver, without sign [rad/s].
        eta_mf1: efficiency of the meshes where the driver drives.
        eta_mf2: where the load does.
        tau_bf1, tau_bf2: torque at the driver beside the meshes, likewise [N m].
    """

    speed: float
    eta_mf1: float
    eta_mf2: float
    tau_bf1: float
    tau_bf2: float


def lossy_rows(table: LossTable, temperature: float, law: str = "") -> list[LossyRow]:
    """Rows of `lossTable` nearest to the map, from rest on.

    Args:
        table: the map.
        temperature: [degC].
        law: of friction; the first one by default.

    LossyGear (Modelica Standard Library; Pelchen, Schweiger and Otter 2002) loses at its driver
    (1 - eta_mf1) tau_a + tau_bf1 where that drives and (1 - 1/eta_mf2) tau_a + tau_bf2 where the load does:
    two lines over tau_a for each speed, by least squares over the torques of the map.
    """
    torques, moving = np.asarray(table.torques), np.array([*table.speeds[1:]])[:, None]
    at_rest = np.array([table.lost(torque, 0.0, temperature, law) for torque in torques])
    in_motion = np.asarray(table.at_many(torques, moving, temperature, law).loss) / moving
    every = np.concatenate([np.where(at_rest >= 0.0, at_rest, np.nan)[None], in_motion])
    rows = []
    for speed, lost in zip(table.speeds, every, strict=True):
        tau, at_driver = (torques + lost) * table.speed_ratio, lost * table.speed_ratio
        share, alone = _line(tau, at_driver, torques >= 0.0, 1.0 - LEAST_EFFICIENCY)
        back, held = _line(-tau, at_driver, (torques <= 0.0) & (tau <= 0.0), 1.0 / LEAST_EFFICIENCY)
        rows.append(
            LossyRow(speed / table.speed_ratio, 1.0 - share, 1.0 / (1.0 + back), alone, held)
        )
    return rows


def _line(
    torque: np.ndarray, lost: np.ndarray, there: np.ndarray, most: float
) -> tuple[float, float]:
    """Slope and start of a line of loss; the steepest where there are no two points."""
    usable = there & np.isfinite(lost)
    if usable.sum() < 2:
        return most, 0.0
    columns = np.stack([torque[usable], np.ones(usable.sum())], axis=-1)
    size = np.abs(columns).max(axis=0)
    bounds = [NEAREST * size[0], 0.0], [most * size[0], np.inf]
    line = lsq_linear(columns / size, lost[usable], bounds, method="bvls", tol=1e-15).x / size
    return float(line[0]), float(line[1])


def least_line_error(place: np.ndarray, value: np.ndarray) -> float:
    """Largest error of that straight line whose largest error is least; 0 through two points or fewer.

    Args:
        place: of the points, ascending, shape (n,).
        value: there, shape (n,).

    Half the largest distance of a point from a chord of two others around it: no line is nearer to all three
    (Chebyshev), and one that is as near to all is between both hulls of the points.

    Example:
        >>> import numpy as np
        >>> from pitchpoint.exports.modelica import least_line_error
        >>> x = np.linspace(0.0, 1.0, 101)
        >>> round(least_line_error(x, x**2), 9)
        0.125
    """
    farthest = 0.0
    for at in range(1, place.size - 1):
        before, behind = place[at] - place[:at, None], place[None, at + 1 :] - place[at]
        chords = behind * value[:at, None] + before * value[None, at + 1 :]
        farthest = max(farthest, float(np.abs(value[at] - chords / (before + behind)).max()))
    return 0.5 * farthest


def _least_bend_error(place: np.ndarray, value: np.ndarray) -> float:
    """The same of two lines that change anywhere, by bisection: each is off by more with more points."""
    low, high = 0, place.size
    while low < high:
        middle = (low + high) // 2
        below, above = (
            least_line_error(place[part], value[part])
            for part in (slice(middle + 1), slice(middle + 1, None))
        )
        low, high = (low, middle) if below >= above else (middle + 1, high)
    return min(
        max(least_line_error(place[:at], value[:at]), least_line_error(place[at:], value[at:]))
        for at in (low, low + 1)
    )


def _least_error(table: LossTable, temperature: float, law: str) -> float:
    """Error of the driver's torque that no table of LossyGear can be without, at one temperature.

    At one speed it has that torque over the one of the output as a line where the driver drives, and another
    where the load does; its table says where one ends.
    """
    torques, errors = np.asarray(table.torques), [0.0]
    for speed in table.speeds[1:]:
        driving = torques + np.asarray(table.at_many(torques, speed, temperature, law).loss) / speed
        there = np.isfinite(driving)
        errors.append(_least_bend_error(torques[there], driving[there]))
    return max(errors) * table.speed_ratio


def lossy_torque(rows: list[LossyRow], torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Torque of the driver by LossyGear.

    Args:
        rows: of the table.
        torque: of the output along its motion, over the ratio [N m at the driver].
        speed: of the driver, without sign [rad/s].

    Of both lines the one with the larger loss holds, which they cross where the model changes between them.
    """
    speeds, *columns = np.array(rows).T
    eta1, eta2, alone, held = (np.interp(speed, speeds, column) for column in columns)
    crossing = (alone - held) / (eta1 - 1.0 / eta2)
    driver_torque: np.ndarray = np.where(
        torque >= eta1 * crossing - alone, (torque + alone) / eta1, eta2 * (torque + held)
    )
    return driver_torque


def write_modelica(given: Simulated, folder: Path) -> HandedOver:
    """Write the package: tables, gears of each temperature, and a joint with inertia, spring and backlash.

    Args:
        given: the joint.
        folder: of the file.
    """
    table, joint = given.joint.table, given.joint
    degrees = sorted({*table.temperatures[::3], given.temperature})
    tables = {degree: lossy_rows(table, degree, joint.law) for degree in degrees}

    of_map = map_tables(given)
    near = max(error.largest for error in joint.errors(partial(map_lost, of_map)))
    least = _least_error(table, given.temperature, joint.law)
    lost = lost_lines(given, partial(_lost, table, joint.law), _beside(given, least, near))
    path = folder / f"{_name(given)}.mo"
    write_text(path, _package(given, tables, of_map, lost))
    return HandedOver([path], lost)


def _lost(
    table: LossTable, law: str, torque: np.ndarray, speed: np.ndarray, degree: np.ndarray
) -> np.ndarray:
    """Torque of the output that LossyGear loses, with a table of each temperature."""
    lost = np.full(torque.shape, np.nan)
    for temperature in np.unique(degree):
        at, rows = degree == temperature, lossy_rows(table, float(temperature), law)
        driving = lossy_torque(rows, torque[at] * table.speed_ratio, speed[at] / table.speed_ratio)
        lost[at] = driving / table.speed_ratio - torque[at]
    return lost


def _name(given: Simulated) -> str:
    """Of the package, with a capital."""
    return "".join(part[:1].upper() + part[1:] for part in given.name.split("_")) + "Drive"


def _beside(given: Simulated, least: float, near: float) -> str:
    """What LossyGear cannot hold, by how much, and what the model of the map itself loses."""
    unit = given.joint.units["driver"]
    return (
        f"{BESIDE} No table of LossyGear is nearer than {least:.4g} {unit} to the map at "
        f"{given.temperature:.4g} degC. "
        f"{MAP_GEAR} and JointOfMap have the map itself: their largest error is {near:.2g} {unit}, by the "
        "digits of their tables. Where friction locks the drive they have what holds a little more than the "
        "load."
    )


def _package(
    given: Simulated, tables: dict[float, list[LossyRow]], whole: MapTables, lost: list[str]
) -> str:
    joint, name = given.joint, _name(given)
    what = (
        "Drive of Modelica, on the Modelica Standard Library 4. Gear is a LossyGear at the temperature of "
        f"its name and Joint one of them with inertia, wind-up and backlash; {MAP_GEAR} is the loss map "
        "itself and JointOfMap the same around it. Nobody compiled this file: it was made by the grammar of "
        "the language, and its tables were checked against the map."
    )
    locks = joint.holding_band(given.load, given.kelvins).locked
    paragraphs = [*heading(given, what), *([LOCKS] if locks else []), "\n".join(lost)]
    remark = "\n".join(f"// {line}" for paragraph in paragraphs for line in _lines(paragraph))
    gears = "".join(_gear(given, degree, rows) for degree, rows in tables.items())
    map_words = (
        "Torque that is lost by the loss map: bilinear over torque and logarithm of the speed, linear over "
        "the temperature. At rest the torque that holds is between the starting torques of the map."
    )
    text = comment_text(joint.title).strip()
    return (
        f'{remark}\npackage {name} "{text}"\n{gears}{map_gear(given, whole)}'
        f"{_annotation(map_words)}  end {MAP_GEAR};\n\n"
        f"{_joint(given, of_map=False)}\n{_joint(given, of_map=True)}"
        f'  annotation(uses(Modelica(version = "4.0.0")), version = "{comment_text(joint.version)}",\n'
        f"    {_documentation(paragraphs)});\nend {name};\n"
    )


def _annotation(*paragraphs: str) -> str:
    return f"    annotation({_documentation(paragraphs)});\n"


def _documentation(paragraphs: Iterable[str]) -> str:
    """Paragraphs as a page; those of several lines as they stand."""
    pages = (
        f"<pre>{_page(paragraph)}</pre>" if "\n" in paragraph else f"<p>{_page(paragraph)}</p>"
        for paragraph in paragraphs
    )
    return f'Documentation(info = "<html>{"".join(pages)}</html>")'


def _page(text: str) -> str:
    """Text of a page in a string of Modelica, whatever stands in it."""
    return escape(text, quote=False).replace("\\", "\\\\").replace('"', '\\"')


def _lines(paragraph: str) -> list[str]:
    return [*paragraph.split("\n"), ""] if "\n" in paragraph else [*wrap(paragraph, 100), ""]


def _degree(value: float) -> str:
    return f"{value:g}".replace(".", "p").replace("-", "minus")


def _gear(given: Simulated, degree: float, rows: list[LossyRow]) -> str:
    numbers = ";\n      ".join(", ".join(f"{value:.9g}" for value in row) for row in rows)
    return (
        f'  model Gear{_degree(degree)} "At {degree:g} degC"\n'
        "    extends Modelica.Mechanics.Rotational.Components.LossyGear(\n"
        f"      ratio = {_rotary_ratio(given):.12g},\n      lossTable = [{numbers}]);\n"
        f"{_annotation(LOSSY_WORDS)}"
        f"  end Gear{_degree(degree)};\n\n"
    )


def _rotary_ratio(given: Simulated) -> float:
    """Of LossyGear: that of the drive, or one before a gear that makes travel of it."""
    return 1.0 if given.joint.slides else given.joint.ratio


def _joint(given: Simulated, *, of_map: bool) -> str:
    """A joint of the gear at one temperature, or of the map itself."""
    joint, ratio = given.joint, given.joint.ratio
    per = abs(ratio) if joint.slides else 1.0
    curve, slides = joint.wind_up, joint.slides
    return _JOINT.format(
        name="JointOfMap" if of_map else "Joint",
        losses="the loss map itself" if of_map else "losses of LossyGear",
        gear=MAP_GEAR if of_map else f"Gear{_degree(given.temperature)}",
        where="Translational" if slides else "Rotational",
        elastic=str(curve is not None).lower(),
        stiffness=f"{1.0 if curve is None else curve.at_load / per**2:.9g}",
        known="not known: set it for a wind-up" if curve is None else "at the load of operation",
        backlash=f"{joint.play * per:.9g}",
        inertia=f"{joint.armature / ratio**2:.9g}",
        end="travel.flangeR" if slides else "flange_b",
        oil=_OIL[0].format(f"{given.temperature:.9g}") if of_map else "",
        oiled=_OIL[1] if of_map else "",
        travel=_TRAVEL[0].format(f"{ratio:.12g}") if slides else "",
        travels=_TRAVEL[1] if slides else "",
        annotation=_annotation(JOINT_WORDS),
    )


_JOINT = """  model {name} "Rotor and drive, {losses}, wind-up and backlash"
    Modelica.Mechanics.Rotational.Interfaces.Flange_a flange_a "Driver"
      annotation(Placement(transformation(extent = {{{{-110, -10}}, {{-90, 10}}}})));
    Modelica.Mechanics.{where}.Interfaces.Flange_b flange_b "Output"
      annotation(Placement(transformation(extent = {{{{90, -10}}, {{110, 10}}}})));
    parameter Boolean elastic = {elastic} "True with wind-up and backlash, false for a rigid drive";
    parameter Modelica.Units.SI.RotationalSpringConstant stiffness = {stiffness}
      "Of the wind-up, {known}";
    parameter Modelica.Units.SI.RotationalDampingConstant damping = 0
      "Of the wind-up, which the map does not know";
    parameter Modelica.Units.SI.Angle backlash = {backlash} "Of the teeth";
{oil}{travel}    Modelica.Mechanics.Rotational.Components.Inertia inertia(J = {inertia});
    {gear} gear;
    Modelica.Mechanics.Rotational.Components.ElastoBacklash spring(
      c = stiffness, d = damping, b = backlash) if elastic;
    Modelica.Mechanics.Rotational.Components.IdealGear rigid(ratio = 1) if not elastic;
  equation
    connect(flange_a, inertia.flange_a);
    connect(inertia.flange_b, gear.flange_a);
    connect(gear.flange_b, spring.flange_a);
    connect(gear.flange_b, rigid.flange_a);
    connect(spring.flange_b, {end});
    connect(rigid.flange_b, {end});
{travels}{oiled}{annotation}  end {name};
"""

_OIL = (
    '    parameter Real temperature = {} "Of the oil, degC";\n'
    "    Modelica.Blocks.Sources.Constant oil(k = temperature);\n",
    "    connect(oil.y, gear.temperature);\n",
)
"""The temperature of a map, and how it is joined."""

_TRAVEL = (
    "    Modelica.Mechanics.Rotational.Components.IdealGearR2T travel(ratio = {});\n",
    "    connect(travel.flangeT, flange_b);\n",
)
"""What makes travel of a rotation, and how it is joined."""
