"""The loss map itself as a model of Modelica: tables over torque, speed and temperature, and rest."""

from typing import NamedTuple

import numpy as np

from pitchpoint.exports.simulators import LOCKED_SHARE, Simulated

__all__ = ["MAP_GEAR", "MapTables", "map_gear", "map_lost", "map_tables"]

MAP_GEAR = "MapGear"
"""Name of the model."""


class MapTables(NamedTuple):
    """Numbers of the model, rounded as they are written.

    Attributes:
        torque: of the output along its motion [torque].
        log_speed: logarithm of its speed [speed].
        degree: of the oil [degree] [degC].
        moving: torque that is lost in motion [degree, torque, speed].
        starts: torque beyond the load that starts the output along it [torque, degree].
    """

    torque: np.ndarray
    log_speed: np.ndarray
    degree: np.ndarray
    moving: np.ndarray
    starts: np.ndarray


def map_tables(given: Simulated) -> MapTables:
    """Tables of a joint; where friction locks it, what holds a little more than the load."""
    joint, table = given.joint, given.joint.table
    values = np.asarray(table.loss_torques[joint.law])
    torque = np.asarray(table.torques)
    alone = np.maximum(values[np.argmin(abs(torque))], 0.0)
    stuck = LOCKED_SHARE * abs(torque)[:, None, None] + alone
    lost = _rounded(np.where(values < 0.0, stuck, values))
    moving = np.moveaxis(lost[:, 1:], 2, 0)
    log_speed = _rounded(np.log(table.speeds[1:]))
    return MapTables(
        _rounded(torque), log_speed, _rounded(np.asarray(table.temperatures)), moving, lost[:, 0]
    )


def _rounded(values: np.ndarray) -> np.ndarray:
    """Numbers as they come back from a file."""
    rounded: np.ndarray = np.vectorize(lambda one: float(f"{one:.10g}"))(values)
    return rounded


def map_lost(
    tables: MapTables, torque: np.ndarray, speed: np.ndarray, degree: np.ndarray
) -> np.ndarray:
    """Torque that the model loses in motion, by its own equations.

    Args:
        tables: of the model.
        torque: of the output along its motion.
        speed: of the output, positive.
        degree: of the oil [degC].

    Source: bilinear tables of the Modelica Standard Library (CombiTable2Ds with LinearSegments and
    HoldLastPoint), weighted by how near their temperatures are.
    """
    row, row_share = _cell(tables.torque, torque)
    slow, faster = _cell(tables.log_speed, np.log(speed))
    lost = np.zeros(np.broadcast_shapes(row.shape, slow.shape))
    next_row, fast = (
        np.minimum(low + 1, count - 1)
        for low, count in zip((row, slow), tables.moving.shape[1:], strict=True)
    )
    for values, share in zip(tables.moving, _shares(tables.degree, degree), strict=True):
        at_slow, at_fast = (
            _between(values[row, n], values[next_row, n], row_share) for n in (slow, fast)
        )
        lost = lost + share * _between(at_slow, at_fast, faster)
    return lost


def _between(first: np.ndarray, second: np.ndarray, weight: np.ndarray) -> np.ndarray:
    between: np.ndarray = first + weight * (second - first)
    return between


def _cell(axis: np.ndarray, value: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Node below a value that is kept within an axis, and how far it is to the next."""
    near = np.clip(value, axis[0], axis[-1])
    low = np.clip(np.searchsorted(axis, near, "right") - 1, 0, max(axis.size - 2, 0))
    step = axis[np.minimum(low + 1, axis.size - 1)] - axis[low]
    return low, (near - axis[low]) / np.where(step > 0.0, step, 1.0)


def _shares(axis: np.ndarray, degree: np.ndarray) -> list[np.ndarray]:
    """How much the table of each temperature counts at others."""
    near = np.clip(degree, axis[0], axis[-1])
    below, above = _widths(axis)
    return [
        np.maximum(0.0, 1.0 - np.where(near < at, (at - near) / low, (near - at) / high))
        for at, low, high in zip(axis, below, above, strict=True)
    ]


def _widths(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each temperature to the one below and above; of the ends something."""
    steps = np.diff(axis)
    return np.concatenate([[1.0], steps]), np.concatenate([steps, [1.0]])


def map_gear(given: Simulated, tables: MapTables) -> str:
    """Text of the model, without its annotation and end.

    Args:
        given: the joint.
        tables: of the model.
    """
    joint = given.joint
    ratio, travel = (1.0, abs(joint.ratio)) if joint.slides else (joint.ratio, 1.0)
    below, above = _widths(tables.degree)
    moving = ",\n      ".join(
        _matrix(tables.torque, tables.log_speed, lost) for lost in tables.moving
    )
    holding = _matrix(tables.torque, tables.degree, tables.starts)
    unit = joint.units
    return _MAP_GEAR.format(
        name=MAP_GEAR, ratio=f"{ratio:.12g}", travel=f"{travel:.12g}", count=tables.degree.size,
        degrees=_vector(tables.degree), below=_vector(below), above=_vector(above),
        slowest=f"{joint.table.speeds[1]:.10g}", moving=moving, rest=holding,
        torque_unit=unit["torque"], speed_unit=unit["speed"],
    )  # fmt: skip


def _vector(values: np.ndarray) -> str:
    return ", ".join(f"{number:.10g}" for number in values)


def _matrix(rows: np.ndarray, columns: np.ndarray, values: np.ndarray) -> str:
    """A table with its axes before the rows and columns; one that is alone stands twice."""
    if columns.size == 1:
        columns, values = np.append(columns, columns + 1.0), np.repeat(values, 2, axis=1)
    lines = [_vector(np.append(0.0, columns))]
    lines += [_vector(np.append(at, row)) for at, row in zip(rows, values, strict=True)]
    return "[" + ";\n      ".join(lines) + "]"


_MAP_GEAR = """  model {name} "The loss map itself, in four quadrants and at rest"
    extends Modelica.Mechanics.Rotational.Icons.Gear;
    extends Modelica.Mechanics.Rotational.Interfaces.PartialTwoFlanges;
    Modelica.Blocks.Interfaces.RealInput temperature "Of the oil, degC"
      annotation(Placement(transformation(
        origin = {{0, 120}}, extent = {{{{-20, -20}}, {{20, 20}}}}, rotation = 270)));
    constant Real ratio = {ratio} "Speed of flange_a over that of flange_b";
    constant Real travel = {travel} "Speed of flange_b over that of the output";
    constant Real degrees[{count}] = {{{degrees}}} "Temperatures of the tables, degC";
    constant Real below[{count}] = {{{below}}} "Distance to the temperature below";
    constant Real above[{count}] = {{{above}}} "Distance to the temperature above";
    Real torque "Of the output on its load, {torque_unit}";
    Real speed "Of the output, {speed_unit}";
    Real acceleration "Of the output";
    Real friction "Against the motion, or what holds at rest, {torque_unit}";
    Real lost "In motion, {torque_unit}";
    Real path(start = 0) "Friction at rest, in motion acceleration beyond it";
    Real warm "Temperature within the tables, degC";
    Real share[{count}] "Of each table";
    Boolean starts_forwards(start = false, fixed = true);
    Boolean starts_backwards(start = false, fixed = true);
    Boolean forwards;
    Boolean backwards;
    Integer mode(start = 0, fixed = true) "1 forwards, -1 backwards, 0 at rest";
    Modelica.Blocks.Tables.CombiTable2Ds moving[{count}](
      table = {{{moving}}},
      each smoothness = Modelica.Blocks.Types.Smoothness.LinearSegments,
      each extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);
    Modelica.Blocks.Tables.CombiTable2Ds on(
      table = {rest},
      smoothness = Modelica.Blocks.Types.Smoothness.LinearSegments,
      extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);
    Modelica.Blocks.Tables.CombiTable2Ds back(
      table = on.table,
      smoothness = Modelica.Blocks.Types.Smoothness.LinearSegments,
      extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);
  equation
    flange_a.phi = ratio * flange_b.phi;
    speed = der(flange_b.phi) / travel;
    acceleration = der(speed);
    torque = -flange_b.tau * travel;
    ratio * flange_a.tau + flange_b.tau = friction / travel;
    warm = min(max(temperature, degrees[1]), degrees[{count}]);
    for k in 1:{count} loop
      share[k] = max(0, 1 - (if warm < degrees[k] then (degrees[k] - warm) / below[k]
        else (warm - degrees[k]) / above[k]));
      moving[k].u1 = if backwards then -torque else torque;
      moving[k].u2 = log(max(abs(speed), {slowest}));
    end for;
    lost = sum(share[k] * moving[k].y for k in 1:{count});
    on.u1 = torque;
    on.u2 = warm;
    back.u1 = -torque;
    back.u2 = warm;
    starts_forwards = pre(mode) == 0 and path > on.y or initial() and speed > 0;
    starts_backwards = pre(mode) == 0 and path < -back.y or initial() and speed < 0;
    forwards = pre(mode) == 1 or starts_forwards;
    backwards = pre(mode) == -1 or starts_backwards;
    acceleration = if forwards then path - on.y else if backwards then path + back.y else 0;
    friction = if forwards then lost else if backwards then -lost else path;
    mode = if forwards and speed > 0 then 1 else if backwards and speed < 0 then -1 else 0;
"""
