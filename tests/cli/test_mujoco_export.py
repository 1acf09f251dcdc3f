"""A joint of MuJoCo made of a loss map: in motion, at rest, and by the fragment alone."""

import ast
import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documentation import block
from made_joints import TITLE, locking, made_joint, torsion

from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.exports.mujoco_joint import show_arm
from pitchpoint.exports.simulators import Asked, hand_over
from pitchpoint.runs.joint_model import joint_model

mujoco = pytest.importorskip("mujoco")

WISHES = Asked(rotor_inertia="2 kg cm2", torque_range="5 N m:25 N m", speed_range="2 rpm:20 rpm")
MODEL = """<mujoco><option timestep="0.001" gravity="0 0 0"/><include file="joint.xml"/>
<worldbody><body><joint name="elbow" class="made" axis="0 0 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="0.5 0.5 0.5"/></body></worldbody>
<actuator><motor class="made" joint="elbow"/></actuator></mujoco>"""
POINTS = [(20.0, 0.5), (20.0, -0.5), (-20.0, 0.5), (55.0, 3.0), (55.0, -3.0), (0.0, 1.0)]
POINTS += [(33.0, 0.02), (33.0, -0.02), (5.0, 3.9), (-47.0, -1.7)]


class Elbow:
    """The joint of a folder in a model, with a constant load and a servo of its speed."""

    def __init__(self, folder: Path, temperature: float = 40.0, *, renewed: bool = True) -> None:
        path = folder / "model.xml"
        path.write_text(MODEL, "utf-8")
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        made = runpy.run_path(str(folder / "joint_friction.py"))
        self.friction = (
            made["renewed_friction"](self.model, "elbow", temperature) if renewed else None
        )

    def step(self, load: float, motor: float) -> None:
        """One step under a load at the output and a torque of the driver."""
        self.data.qfrc_applied[0], self.data.ctrl[0] = -load, motor
        if self.friction is not None:
            self.friction.update(self.model, self.data)
        mujoco.mj_step(self.model, self.data)

    def steady(self, load: float, speed: float, steps: int = 1500) -> tuple[float, float]:
        """Torque of the driver and speed in the end, of a servo with both poles at 50/s."""
        inertia = float(self.model.dof_M0[0] + self.model.dof_armature[0])
        self.data.qvel[0], added = speed, 0.0
        for _ in range(steps):
            slow = speed - float(self.data.qvel[0])
            added += 0.001 * slow
            motor = (load + inertia * (100.0 * slow + 2500.0 * added)) / 50.0
            self.step(load, motor)
        return motor, float(self.data.qvel[0])

    def held(self, load: float, motor: float, steps: int = 1000) -> float:
        """Mean speed over the second half of so many steps, from rest."""
        for step in range(steps):
            if step == steps // 2:
                start = float(self.data.qpos[0])
            self.step(load, motor)
        return (float(self.data.qpos[0]) - start) / (steps - steps // 2) / 0.001


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("handed")
    hand_over({"default": made_joint(more={"torsion": torsion()})}, made, ["mujoco"], WISHES)
    return made / "mujoco"


@pytest.fixture(scope="module")
def worm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("locking")
    hand_over({"default": made_joint(locking)}, made, ["mujoco"], Asked(rotor_inertia="2 kg cm2"))
    return made / "mujoco"


@pytest.mark.parametrize(("load", "speed"), POINTS)
def test_steady_motion_asks_the_torque_of_the_map(folder: Path, load: float, speed: float) -> None:
    motor, reached = Elbow(folder, 50.0).steady(load, speed)
    expected = table_of(made_joint().parts["four_quadrants"]).at(load, reached, 50.0).input_torque
    assert motor == pytest.approx(expected, rel=1e-9)
    assert reached == pytest.approx(speed, rel=1e-6)


def test_a_joint_at_rest_holds_and_starts_where_the_map_says(folder: Path) -> None:
    """At 30 N m what starts it is 5 N m on and 5.6 N m back, at 40 degC."""
    for load in (0.0, 30.0, -30.0, 60.0):
        assert abs(Elbow(folder).held(load, load / 50.0)) < 1e-4
    for motor, moves in ((34.8, 0), (35.2, 1), (24.6, 0), (24.2, -1)):
        found = Elbow(folder).held(30.0, motor / 50.0)
        assert found * moves > 1e-3 if moves else abs(found) < 1e-4


def test_a_gear_that_locks_holds_any_load_and_is_driven_down(worm: Path) -> None:
    for load in (10.0, 60.0, 500.0, -60.0):
        assert abs(Elbow(worm).held(load, 0.0)) < 1e-4
    rising = Elbow(worm)
    for load in (0.0, 5.0, 60.0):
        assert abs(rising.held(load, 0.0, 300)) < 1e-4
    motor, reached = Elbow(worm).steady(30.0, -0.5)
    assert motor < 0.0 > reached  # pushed down, though its load would go there
    assert motor == pytest.approx(-(0.05 * 30.0 + 2.0) / 50.0, rel=1e-6)
    motor, reached = Elbow(worm).steady(30.0, 0.5)
    assert motor == pytest.approx((30.0 + 2.0 + 18.0) / 50.0, rel=1e-9)


def test_the_fragment_alone_is_off_as_its_table_says(folder: Path) -> None:
    alone = Elbow(folder, renewed=False)
    joint = joint_model(made_joint())
    constant, viscous = (
        float(one[0]) for one in (alone.model.dof_frictionloss, alone.model.dof_damping)
    )
    text = (folder / "joint.xml").read_text("utf-8")
    rows = re.findall(
        r"^(the map|range) +(I\S*, I\S*) .*\) +(\S+) +(\S+) +(\S+) % +(\d+)$", text, re.MULTILINE
    )
    errors = joint.errors(lambda torque, speed, degree: constant + viscous * speed)
    assert [row[0] for row in rows] == ["the map"] * 2 + ["range"] * 2
    for row, error in zip(rows, errors, strict=False):
        assert row[1] == error.quadrants
        assert [float(one) for one in row[2:4]] == pytest.approx(
            [error.largest, error.mean], rel=1e-3
        )
        assert int(row[5]) == error.points
    largest = {row[1]: float(row[2]) for row in rows[:2]}
    for load, speed in POINTS:
        motor, reached = Elbow(folder, renewed=False).steady(load, speed)
        away = abs(motor - joint.driver_torque(load, reached))
        assert away <= largest["I, III" if load * speed >= 0.0 else "II, IV"] * 1.001
    # Nearest in the range at the load of operation: what is left is in the mean nothing, over speed too.
    speeds = np.geomspace(2.0, 20.0, 17) * np.pi / 30.0
    off = constant + viscous * speeds - (joint.loss_torque([[20.0], [-20.0]], speeds))
    assert abs(off.mean()) < 1e-7 and abs((off * speeds).mean()) < 1e-7
    assert abs(alone.held(20.0, 20.0 / 50.0)) < 1e-4


def test_a_spring_behind_the_drive_swings_at_its_frequency(folder: Path) -> None:
    """Against sqrt(K/J) of a load on a drive that is held, K the slope at the load of operation."""
    model = mujoco.MjModel.from_xml_path(str(folder / "arm_with_spring.xml"))
    assert model.nq == 3  # drive, play, wind-up
    model.opt.gravity[:] = 0.0
    data, place = mujoco.MjData(model), model.joint("wind_up").qposadr[0]
    assert model.jnt_stiffness[model.joint("wind_up").id] == 1000.0
    assert model.jnt_range[model.joint("play").id] == pytest.approx([-1e-4, 1e-4])
    data.qpos[place], data.qpos[model.joint("play").qposadr[0]] = 0.01, 1e-4
    inertia = float(model.dof_M0[place])
    times, before = [], 0.01
    for _ in range(20000):
        mujoco.mj_step(model, data)
        if before < 0.0 <= data.qpos[place]:
            times.append(float(data.time))
        before = float(data.qpos[place])
    period = np.diff(times)[:3].mean()
    # Half the time it crosses the play, which takes a little longer.
    assert period == pytest.approx(2.0 * np.pi * np.sqrt(inertia / 1000.0), rel=0.05)


def test_files_stand_alone_and_nothing_typed_breaks_out(folder: Path) -> None:
    for name in ("arm.xml", "arm_with_spring.xml"):
        mujoco.MjModel.from_xml_path(str(folder / name))
    text = (folder / "joint_friction.py").read_text("utf-8")
    named = [
        one for one in ast.walk(ast.parse(text)) if isinstance(one, ast.Import | ast.ImportFrom)
    ]
    assert not [one for one in named if "pitchpoint" in ast.unparse(one)]
    assert "from pitchpoint" not in text
    about: Any = next(
        ast.literal_eval(one.value)
        for one in ast.parse(text).body
        if isinstance(one, ast.Assign) and ast.unparse(one.targets[0]) == "ABOUT"
    )
    assert about["title"] == TITLE
    done = subprocess.run(
        [sys.executable, "-I", "joint_friction.py"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    told = {line.split()[0]: line.split() for line in done.stdout.splitlines()[1:]}
    assert told.keys() == {"lifts", "holds", "lowers"}
    assert float(told["lifts"][3]) == pytest.approx(float(told["lifts"][4]), rel=0.01)
    assert abs(float(told["holds"][1])) < 1e-4


def test_the_arm_of_a_fast_drive_is_lifted_and_lowered_steadily(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = table_of(made_joint().parts["four_quadrants"])
    fast = table._replace(speeds=[15.0 * speed for speed in table.speeds])
    show_arm(fast, 40.0, "", folder)
    rows = [line.split() for line in capsys.readouterr().out.splitlines()[1:]]
    for row in (rows[0], rows[2]):
        assert abs(float(row[1])) == pytest.approx(0.5, rel=0.05)
        assert float(row[3]) == pytest.approx(float(row[4]), rel=0.01)


def test_the_loop_of_the_guide_holds_the_arm(folder: Path) -> None:
    program = (
        block("guide/simulators.md", "python", "renewed_friction")
        + "print(data.qpos[0], data.qvel[0])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=folder, capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    place, speed = map(float, done.stdout.split())
    assert abs(place) < 1e-3 and abs(speed) < 1e-4
