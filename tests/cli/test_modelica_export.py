"""A drive as a package of Modelica: tables against the map, by the equations of LossyGear."""

import re
from pathlib import Path

import numpy as np
import pytest
from made_joints import locking, made_joint, torsion
from scipy.optimize import brentq

from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.efficiency.friction_fit import loss_nodes
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports.modelica import LossyRow, lossy_rows, lossy_torque
from pitchpoint.exports.simulators import HandedOver, hand_over
from pitchpoint.runs.joint_model import joint_model
from pitchpoint.runs.run import Outcome


def handed(made: Outcome, folder: Path) -> HandedOver:
    return hand_over({"default": made}, folder, ["modelica"])["modelica"]


def tables(text: str) -> dict[float, list[LossyRow]]:
    """Tables of a package by temperature."""
    found = re.findall(r"model Gear\w+ \"At (\S+) degC\".*?lossTable = \[(.*?)\]", text, re.DOTALL)
    return {
        float(degree): [LossyRow(*map(float, row.split(","))) for row in rows.split(";")]
        for degree, rows in found
    }


def driven(row: LossyRow, load: float) -> float:
    """Torque of the driver of LossyGear under a load at the driver, from the equations of the model."""

    def rest(tau: float) -> float:
        crossing = (row.tau_bf1 - row.tau_bf2) / (row.eta_mf1 - 1.0 / row.eta_mf2)
        forwards = (1.0 - row.eta_mf1) * tau + row.tau_bf1
        backwards = (1.0 - 1.0 / row.eta_mf2) * tau + row.tau_bf2
        return tau - (forwards if tau >= crossing else backwards) - load

    far = 10.0 * (1.0 + abs(load))
    return float(brentq(rest, -far, far, xtol=1e-15))


def test_losses_that_are_lines_come_back() -> None:
    """A loss of 2 + 0.1 T forwards and 2 + 0.3 T backwards at the output, behind a ratio of 50."""
    columns = [
        [(2.0 + (0.3 if t < 0.0 else 0.1) * abs(t),)] * 3 for t in (-60.0, -30.0, 0.0, 30.0, 60.0)
    ]
    table = LossTable(
        (-60.0, -30.0, 0.0, 30.0, 60.0), (0.0, 0.1, 4.0), (40.0,), {"made": columns}, 0.02
    )
    row = lossy_rows(table, 40.0)[-1]
    assert row.speed == pytest.approx(200.0)
    assert row.eta_mf1 == pytest.approx(1.0 / 1.1, rel=1e-9)
    assert row.tau_bf1 == pytest.approx(0.04 / 1.1, rel=1e-9)
    assert row.eta_mf2 == pytest.approx(0.7, rel=1e-9)
    assert row.tau_bf2 == pytest.approx(0.04 / 0.7, rel=1e-9)
    for load in (-60.0, -20.0, 0.0, 45.0):
        expected = table.at(load, 4.0, 40.0).input_torque
        assert driven(row, 0.02 * load) == pytest.approx(expected, rel=1e-9)


def test_tables_of_the_package_are_as_near_as_they_say(tmp_path: Path) -> None:
    """At all nodes of the map at its own temperatures, by the equations of the model."""
    made = made_joint(more={"torsion": torsion()})
    (path,), lost = handed(made, tmp_path)
    found, table = tables(path.read_text("utf-8")), table_of(made.parts["four_quadrants"])
    assert sorted(found) == [20.0, 40.0, 60.0]
    said = re.findall(r"^the map .*\) +(\S+) +(\S+) +\S+ % +\d+$", "\n".join(lost), re.MULTILINE)
    nodes = loss_nodes(table, temperature=313.15)
    rows = found[40.0]
    torque, speed = nodes.torque * 0.02, nodes.speed * 50.0
    quick = lossy_torque(rows, torque, speed)
    by_speed = {row.speed: row for row in rows}
    for at in range(0, torque.size, 41):
        row = by_speed[min(by_speed, key=lambda one, at=at: abs(one - speed[at]))]
        assert driven(row, torque[at]) == pytest.approx(quick[at], rel=1e-7, abs=1e-9)
    off = np.abs(quick - (nodes.torque + nodes.lost) * 0.02)
    for way, (largest, _) in zip((nodes.torque >= 0.0, nodes.torque < 0.0), said, strict=True):
        assert off[way].max() <= float(largest) * 1.001 < 0.01 * 1.3
    joint = joint_model(made)
    assert f"J = {joint.armature / 2500.0:.9g}" in path.read_text("utf-8")


def test_the_package_is_whole(tmp_path: Path) -> None:
    """Every model has its end, every bracket its mate, every connection two of the parts of its model."""
    for name, made in {
        "turns": made_joint(more={"torsion": torsion()}),
        "slides": made_joint(slides=True, more={"torsion": torsion()}),
        "bare": made_joint(),
    }.items():
        (path,), _ = handed(made, tmp_path / name)
        code = re.sub(r"//.*", "", path.read_text("utf-8"))
        opened = re.findall(r"^ *(?:package|model) (\w+)", code, re.MULTILINE)
        closed = re.findall(r"^ *end (\w+);", code, re.MULTILINE)
        assert sorted(opened) == sorted(closed) and path.stem == opened[0]
        plain = re.sub(r'"[^"]*"', "", code)
        assert code.count('"') % 2 == 0
        assert all(plain.count(a) == plain.count(b) for a, b in ("()", "[]"))
        parts = set(re.findall(r"^    (?:Modelica\.\S+|Gear\w+) (\w+)", code, re.MULTILINE))
        ends = re.findall(r"connect\((\w+)\S*, (\w+)\S*\);", code)
        assert {one for both in ends for one in both} == parts
        assert ("IdealGearR2T" in code) == (name == "slides")
        assert ("spring" in parts) == (name != "bare")


def test_a_drive_that_locks_is_said_not_to_lock_there(tmp_path: Path) -> None:
    (path,), _ = handed(made_joint(locking), tmp_path)
    text = path.read_text("utf-8")
    assert "LossyGear cannot lock" in text.replace("\n// ", " ")
    assert all(0.0 < row.eta_mf2 < 1e-5 for row in tables(text)[40.0])
