"""A drive as a package of Modelica: `LossyGear` of the standard library, a table for each temperature."""

from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import NamedTuple

import numpy as np
from scipy.optimize import lsq_linear

from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports.evaluator import inert
from pitchpoint.exports.simulators import HandedOver, Simulated, heading, lost_lines
from pitchpoint.results.store import write_text

__all__ = ["LossyRow", "lossy_rows", "lossy_torque", "write_modelica"]

NEAREST = 1e-9
"""How near to one an efficiency may come: LossyGear divides by eta_mf1 - 1/eta_mf2."""

LEAST_EFFICIENCY = 1e-6
"""Efficiency that stands for none where friction locks the drive, which LossyGear cannot say."""

BESIDE = (
    "Losses of LossyGear are a line over the torque of the driver, one for either way of the power, and "
    "linear over the speed. Lost are ripple and kinematic error, and the change of temperature while it runs."
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
    known = there & np.isfinite(lost)
    if known.sum() < 2:
        return most, 0.0
    columns = np.stack([torque[known], np.ones(known.sum())], axis=-1)
    size = np.abs(columns).max(axis=0)
    bounds = [NEAREST * size[0], 0.0], [most * size[0], np.inf]
    found = lsq_linear(columns / size, lost[known], bounds, method="bvls", tol=1e-15).x / size
    return float(found[0]), float(found[1])


def lossy_torque(rows: list[LossyRow], torque: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Torque of the driver by LossyGear.

    Args:
        rows: of the table.
        torque: of the output along its motion, over the ratio [N m at the driver].
        speed: of the driver, without sign [rad/s].

    Of both lines the one with the larger loss holds, which they cross where the model changes between them.
    """
    speeds, *columns = np.array(rows).T
    eta1, eta2, alone, held = (np.interp(speed, speeds, one) for one in columns)
    crossing = (alone - held) / (eta1 - 1.0 / eta2)
    found: np.ndarray = np.where(
        torque >= eta1 * crossing - alone, (torque + alone) / eta1, eta2 * (torque + held)
    )
    return found


def write_modelica(given: Simulated, folder: Path) -> HandedOver:
    """Write the package: tables, gears of each temperature, and a joint with inertia, spring and backlash.

    Args:
        given: the joint.
        folder: of the file.
    """
    table, joint = given.joint.table, given.joint
    degrees = sorted({*table.temperatures[::3], given.temperature})
    tables = {degree: lossy_rows(table, degree, joint.law) for degree in degrees}

    lost = lost_lines(given, partial(_lost, table, joint.law), BESIDE)
    path = folder / f"{_name(given)}.mo"
    write_text(path, _package(given, tables, lost))
    return HandedOver([path], lost)


def _lost(
    table: LossTable, law: str, torque: np.ndarray, speed: np.ndarray, degree: np.ndarray
) -> np.ndarray:
    """Torque of the output that LossyGear loses, with a table of each temperature."""
    lost = np.full(torque.shape, np.nan)
    for one in np.unique(degree):
        at, rows = degree == one, lossy_rows(table, float(one), law)
        driving = lossy_torque(rows, torque[at] * table.speed_ratio, speed[at] / table.speed_ratio)
        lost[at] = driving / table.speed_ratio - torque[at]
    return lost


def _name(given: Simulated) -> str:
    """Of the package, with a capital."""
    return "".join(part[:1].upper() + part[1:] for part in given.name.split("_")) + "Drive"


def _package(given: Simulated, tables: dict[float, list[LossyRow]], lost: list[str]) -> str:
    joint, name = given.joint, _name(given)
    what = (
        "Drive of Modelica, on the Modelica Standard Library 4. Gear is the gear at the temperature of its "
        "name, Joint puts inertia, wind-up and backlash around one. Nobody compiled this file: it was "
        "made by the grammar of the language, and its tables were checked against the map."
    )
    locks = joint.holding_band(given.load, given.kelvins).locked
    paragraphs = [*heading(given, what), *([LOCKS] if locks else []), "\n".join(lost)]
    remark = "\n".join(f"// {line}" for one in paragraphs for line in _lines(one))
    gears = "".join(_gear(given, degree, rows) for degree, rows in tables.items())
    text = inert(joint.title).strip()
    return f'{remark}\npackage {name} "{text}"\n{gears}{_joint(given)}end {name};\n'


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
        f"  end Gear{_degree(degree)};\n\n"
    )


def _rotary_ratio(given: Simulated) -> float:
    """Of LossyGear: that of the drive, or one before a gear that makes travel of it."""
    return 1.0 if given.joint.slides else given.joint.ratio


def _joint(given: Simulated) -> str:
    joint, ratio = given.joint, given.joint.ratio
    inertia = joint.armature / ratio**2
    where = "Translational" if joint.slides else "Rotational"
    stiff = joint.wind_up.at_load if joint.wind_up is not None else 0.0
    play = joint.play
    after, parts, joined = "gear.flange_b", [], []
    if joint.slides:
        parts.append(
            f"    Modelica.Mechanics.Rotational.Components.IdealGearR2T travel(ratio = {ratio:.12g});\n"
        )
        joined.append(f"    connect({after}, travel.flangeR);\n")
        after = "travel.flangeT"
    if stiff > 0.0:
        values = f"c = {stiff:.9g}, d = damping"
        kind = "SpringDamper" if joint.slides else "ElastoBacklash"
        values += "" if joint.slides else f", b = {play:.9g}"
        parts.append(
            '    parameter Real damping = 0 "Of the wind-up, which the map does not know";\n'
        )
        parts.append(f"    Modelica.Mechanics.{where}.Components.{kind} spring({values});\n")
        joined += [
            f"    connect({after}, spring.flange_a);\n",
            "    connect(spring.flange_b, flange_b);\n",
        ]
    else:
        joined.append(f"    connect({after}, flange_b);\n")
    return (
        '  model Joint "Rotor and drive, its losses, wind-up and backlash"\n'
        '    Modelica.Mechanics.Rotational.Interfaces.Flange_a flange_a "Driver";\n'
        f'    Modelica.Mechanics.{where}.Interfaces.Flange_b flange_b "Output";\n'
        f"    Modelica.Mechanics.Rotational.Components.Inertia inertia(J = {inertia:.9g});\n"
        f"    Gear{_degree(given.temperature)} gear;\n{''.join(parts)}  equation\n"
        "    connect(flange_a, inertia.flange_a);\n    connect(inertia.flange_b, gear.flange_a);\n"
        f"{''.join(joined)}  end Joint;\n"
    )
