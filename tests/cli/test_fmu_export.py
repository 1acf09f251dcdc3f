"""The loss map as a unit of FMI 2.0: validated, and equal to the evaluator wherever it is asked."""

import math
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_joints import locking, made_joint, plain

from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports import fmu
from pitchpoint.exports.simulators import Asked, HandedOver, hand_over
from pitchpoint.runs.run import Outcome

fmpy = pytest.importorskip("fmpy")
needs_compiler = pytest.mark.skipif(shutil.which("gcc") is None, reason="there is no gcc")
STRICT = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-shared", "-fPIC")


def handed(made: Outcome, folder: Path) -> HandedOver:
    return hand_over({"default": made}, folder, ["fmu"], Asked(temperature="30 degC"))["fmu"]


def at_rest(table: LossTable, torque: float, degree: float) -> list[float]:
    """What the evaluator says at rest, with the stand-ins of the description."""
    rest, ideal = table.at_rest(torque, degree), torque * table.speed_ratio
    ends = [ideal if math.isnan(one) else one for one in (rest.lowest, rest.highest)]
    lowest = -1e30 if math.isnan(rest.lowest) else rest.lowest
    highest = 1e30 if math.isnan(rest.highest) else rest.highest
    return [0.5 * (ends[0] + ends[1]), lowest, highest, rest.locked]


class Unit:
    """A unit in a process, from its archive."""

    def __init__(self, path: Path, folder: Path) -> None:
        from fmpy.fmi2 import FMU2Slave

        described: Any = fmpy.read_model_description(str(path))
        place = fmpy.extract(str(path), unzipdir=str(folder))
        name = described.coSimulation.modelIdentifier
        self.unit: Any = FMU2Slave(
            guid=described.guid, unzipDirectory=place, modelIdentifier=name, instanceName="joint"
        )
        self.unit.instantiate()
        self.unit.setupExperiment(startTime=0.0)
        self.unit.enterInitializationMode()
        self.unit.exitInitializationMode()

    def at(self, *point: float) -> list[float]:
        self.unit.setReal([0, 1, 2], [*point])
        return [*self.unit.getReal([3, 4, 5, 6, 7]), *self.unit.getBoolean([8, 9])]


@needs_compiler
@pytest.mark.parametrize("law", [plain, locking])
def test_a_unit_says_what_the_evaluator_says(law: Any, tmp_path: Path) -> None:
    """At 10,000 points over four quadrants, at rest, beyond the map and where friction locks."""
    from fmpy.validation import validate_fmu

    made = made_joint(law)
    (path,), lost = handed(made, tmp_path)
    assert validate_fmu(str(path)) == []
    table, unit = table_of(made.parts["four_quadrants"]), Unit(path, tmp_path / "unit")
    points = np.random.default_rng(4).uniform([-80.0, -5.0, 10.0], [80.0, 5.0, 70.0], (10_000, 3))
    points[::10, 1] = 0.0
    points[5::10, 1] *= 1e-4
    found = np.array([unit.at(*point) for point in points.tolist()])
    assert np.isfinite(found).all()
    point = table.at_many(*points.T)
    near = {"rtol": 1e-12, "atol": 1e-15}
    for column, values in zip(
        (0, 1, 6), (point.loss, point.efficiency, point.outside), strict=True
    ):
        np.testing.assert_allclose(found[:, column], np.nan_to_num(values), **near)
    moves = points[:, 1] != 0.0
    np.testing.assert_allclose(found[moves, 2], np.nan_to_num(point.input_torque)[moves], **near)
    np.testing.assert_array_equal(found[moves, 5], point.locked[moves])
    rest = np.array([at_rest(table, *one) for one in points[~moves][:, [0, 2]].tolist()])
    np.testing.assert_allclose(found[~moves][:, [2, 3, 4, 5]], rest, **near)
    assert found[:, 5].any() == (law is locking) and found[:, 6].any()
    assert "nothing of the torque of the driver, by construction" in " ".join(lost)
    unit.unit.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    kept = unit.unit.getFMUState()
    before = unit.at(10.0, 1.0, 40.0)
    unit.at(-10.0, 1.0, 40.0)
    unit.unit.setFMUState(kept)
    unit.unit.freeFMUState(kept)
    assert unit.at(10.0, 1.0, 40.0) == before
    with pytest.raises(Exception, match="fmi2SetReal"):
        unit.at(math.nan, 1.0, 40.0)
    unit.unit.reset()
    assert unit.unit.getReal([0, 1, 2]) == [0.0, 0.0, 30.0]
    unit.unit.terminate()
    unit.unit.freeInstance()


@needs_compiler
def test_its_source_is_clean_and_builds_where_it_is_unpacked(tmp_path: Path) -> None:
    (path,), _ = handed(made_joint(slides=True), tmp_path)
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "unit")
        names = {one for one in archive.namelist() if not one.startswith("binaries/")}
    sources = {
        f"sources/{name}"
        for name in ("joint_fmu.c", "joint_map.h", "joint_of.h", "loss_table.h", "CMakeLists.txt")
    }
    assert names == {"modelDescription.xml", "documentation/index.html", *sources}
    subprocess.run(
        [*STRICT, "joint_fmu.c", "-o", "unit.so", "-lm"],
        cwd=tmp_path / "unit" / "sources",
        check=True,
    )
    description = (tmp_path / "unit" / "modelDescription.xml").read_text("utf-8")
    assert 'unit="N"' in description and 'unit="m/s"' in description


def test_the_same_joint_is_the_same_unit_without_a_compiler(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fmu.shutil, "which", lambda name: None)
    (first,), lost = handed(made_joint(), tmp_path / "a")
    (second,), _ = handed(made_joint(), tmp_path / "b")
    assert first.read_bytes() == second.read_bytes()
    assert lost[-1] == "No compiler of C (cc) made a binary: the unit has sources alone."
    assert fmpy.read_model_description(str(first)).guid
