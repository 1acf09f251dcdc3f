"""The joint as a unit of FMI 2.0 with states: against map, integrator with events, and own motion."""

import math
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from documentation import block
from made_joints import RATIO, error, locking, made_joint, plain, rippling, torsion
from scipy.integrate import cumulative_trapezoid, solve_ivp

from pitchpoint._jax import array
from pitchpoint.analyses.motion import moving_of
from pitchpoint.dynamics.excitation import ErrorOrders
from pitchpoint.dynamics.joint_course import MotorRun, joint_motion
from pitchpoint.dynamics.joint_vibration import Joint, Sliding
from pitchpoint.exports.simulators import Asked, HandedOver, hand_over
from pitchpoint.gears.contact_lines import line_of_action
from pitchpoint.loading.wind_up_curve import WindUpCurve
from pitchpoint.runs.joint_model import JointModel, joint_model
from pitchpoint.runs.run import Outcome, load_case, run_case

fmpy = pytest.importorskip("fmpy")
pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="there is no gcc")
STRICT = ("gcc", "-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-shared", "-fPIC")
ROTOR, LOAD = 0.7, 1.2
WISHES = Asked(rotor_inertia=f"{ROTOR / RATIO**2} kg m2", temperature="40 degC")
NAMES = ["motor_torque", "load_torque", "temperature", "inertia", "load_inertia", "damping"]
NAMES += ["ripple"]
NAMES += ["start_angle", "start_speed", "start_wind_up", "start_wind_up_rate"]
NAMES += ["motor_angle", "motor_speed", "output_angle", "output_speed", "wind_up", "torque"]
NAMES += ["friction", "loss"]


def sticking(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """What starts the drive is half as much again as what moves it."""
    return np.asarray(plain(torque, speed, degree) * np.where(speed == 0.0, 1.5, 1.0))


def lossless(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    return 0.0 * (torque + speed + degree)


def handed(made: Outcome, folder: Path, wishes: Asked | None = None) -> HandedOver:
    return hand_over({"default": made}, folder, ["fmu_joint"], wishes or WISHES)["fmu_joint"]


class Unit:
    """A unit in a process, which starts as it is set and runs by steps of a millisecond."""

    def __init__(
        self, made: Outcome, folder: Path, wishes: Asked | None = None, **start: float
    ) -> None:
        from fmpy.fmi2 import FMU2Slave

        self.path = handed(made, folder, wishes).paths[0]
        described: Any = fmpy.read_model_description(str(self.path))
        place = fmpy.extract(str(self.path), unzipdir=str(folder / "unit"))
        name = described.coSimulation.modelIdentifier
        self.unit: Any = FMU2Slave(
            guid=described.guid, unzipDirectory=place, modelIdentifier=name, instanceName="joint"
        )
        assert [one.name for one in described.modelVariables] == [*NAMES, "sticks", "outside"]
        self.time = 0.0
        self.unit.instantiate()
        self.begin(**start)

    def begin(self, **start: float) -> None:
        self.unit.setupExperiment(startTime=0.0)
        self.unit.enterInitializationMode()
        self.put(**{"load_inertia": LOAD, **start})
        self.unit.exitInitializationMode()

    def put(self, **values: float) -> None:
        self.unit.setReal([NAMES.index(one) for one in values], [*values.values()])

    def of(self, *names: str) -> list[float]:
        return [*self.unit.getReal([NAMES.index(one) for one in names])]

    @property
    def sticks(self) -> bool:
        return bool(self.unit.getBoolean([len(NAMES)])[0])

    def run(self, duration: float, step: float = 1e-3, **values: float) -> list[list[float]]:
        """Speeds of driver and load over the ratio, and torque, after each step."""
        self.put(**values)
        found = []
        for _ in range(round(duration / step)):
            self.unit.doStep(self.time, step)
            self.time += step
            speed, *others = self.of("motor_speed", "output_speed", "torque")
            found.append([speed / abs(RATIO), *others])
        return found


def solved(
    joint: JointModel, motor: float, load: float, start: np.ndarray, times: np.ndarray
) -> np.ndarray:
    """Angle and speed of driver and load by an integrator with a search for each stop and start.

    Args:
        joint: with a wind-up of one stiffness, and play.
        motor, load: torques at the output.
        start: state.
        times: at which it is wanted, from 0.
    """
    stiffness = float(joint.wind_up.at_load) if joint.wind_up else 0.0

    def spring(state: np.ndarray) -> float:
        wind_up = state[0] - state[2]
        return stiffness * math.copysign(max(abs(wind_up) - joint.play / 2.0, 0.0), wind_up)

    def held(state: np.ndarray) -> float:
        pull = motor - spring(state)
        return joint.table.lost(math.copysign(1.0, pull) * spring(state), 0.0, 40.0) - abs(pull)

    def slopes(way: float) -> Callable[..., list[float]]:
        def of(_: float, state: np.ndarray) -> list[float]:
            torque = spring(state)
            pace = max(way * state[1], 1e-9)
            lost = way * joint.table.lost(way * torque, pace, 40.0) if way else 0.0
            gain = (motor - lost - torque) / ROTOR if way else 0.0
            return [state[1], gain, state[3], (torque - load) / LOAD]

        return of

    def stops(way: float) -> Callable[..., float]:
        def event(_: float, state: np.ndarray) -> float:
            return way * state[1] if way else held(state)

        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
        return event

    state, time, rows = np.array(start, float), 0.0, [np.array(start, float)]
    way = math.copysign(1.0, state[1])
    while len(rows) < times.size:
        run = solve_ivp(
            slopes(way), (time, times[-1]), state, t_eval=times[len(rows) :], events=stops(way),
            rtol=1e-7, atol=1e-10, max_step=4e-3,
        )  # fmt: skip
        rows += [*np.reshape(run.y, (4, -1)).T]
        if len(rows) < times.size:
            time, state = float(run.t_events[0][0]), run.y_events[0][0].copy()
            stays = way != 0.0 and held(state) >= 0.0
            way = 0.0 if stays else math.copysign(1.0, motor - spring(state))
            state[1] = way * 1e-11
    return np.array(rows)


def with_play(play: float = 2e-3) -> dict[str, xr.Dataset]:
    """A wind-up of one stiffness, and play."""
    spring = torsion()
    spring["tangent_torsional_stiffness"][:] = 1000.0
    spring["kinematic_play"] = play
    return {"torsion": spring}


def test_it_is_whole_clean_and_refuses_what_is_no_number(tmp_path: Path) -> None:
    from fmpy.validation import validate_fmu

    for number, made in enumerate(
        (
            made_joint(more={"torsion": torsion(), "kinematic_error": error()}),
            made_joint(slides=True),
        )
    ):
        folder = tmp_path / str(number)
        wishes = replace(WISHES, rotor_inertia="2 kg cm2")
        (path,), lost = hand_over({"default": made}, folder, ["fmu_joint"], wishes)["fmu_joint"]
        assert validate_fmu(str(path)) == []
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder / "unit")
        command = [*STRICT, "joint_fmu.c", "-o", "unit.so", "-lm"]
        subprocess.run(command, cwd=folder / "unit" / "sources", check=True)
        page = (folder / "unit" / "documentation" / "index.html").read_text("utf-8")
        head = (folder / "unit" / "modelDescription.xml").read_text("utf-8")
        assert "a hundredth of the shortest period" in page and "What is lost" in head
        assert ("The drive is rigid" in " ".join(lost)) == bool(number)
    unit = Unit(made_joint(), tmp_path / "other")
    for wrong in ({"motor_torque": math.nan}, {"load_torque": math.inf}, {"load_inertia": 0.0}):
        with pytest.raises(Exception, match="fmi2SetReal"):
            unit.put(**wrong)
    with pytest.raises(Exception, match="fmi2SetReal"):
        unit.put(start_speed=1.0)  # it runs


def test_without_an_inertia_it_is_handed_over_and_starts_when_it_is_set(tmp_path: Path) -> None:
    _, lost = hand_over({"default": made_joint()}, tmp_path, ["fmu_joint"])["fmu_joint"]
    assert "No inertia of the drive is known: set inertia and load_inertia" in " ".join(lost)
    with pytest.raises(Exception, match="fmi2ExitInitializationMode"):
        Unit(made_joint(), tmp_path / "a", Asked())
    unit = Unit(made_joint(), tmp_path / "b", Asked(), inertia=ROTOR)
    known = Unit(made_joint(), tmp_path / "c")
    found, expected = (one.run(0.1, motor_torque=1.0) for one in (unit, known))
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert unit.of("motor_speed")[0] > 0.1


@pytest.mark.parametrize("more", [{}, with_play()], ids=["rigid", "wound up"])
def test_steady_motion_is_that_of_the_map(more: dict[str, xr.Dataset], tmp_path: Path) -> None:
    """In all quadrants: under the torque of the driver by the map its speed is that of the map."""
    made = made_joint(more=more)
    joint, unit = joint_model(made), Unit(made, tmp_path)
    for load, speed in ((20.0, 0.5), (-20.0, 0.5), (45.0, -3.0), (-45.0, -1.0), (0.0, 2.0)):
        unit.unit.reset()
        unit.begin(start_speed=0.98 * speed, load_torque=load, damping=10.0 if more else 0.0)
        motor = joint.driver_torque(load, speed)
        (*_, (driver, output, torque)) = unit.run(6.0, 0.5, motor_torque=motor)
        assert (driver, output) == pytest.approx((speed, speed), rel=1e-3)
        assert torque == pytest.approx(load, abs=0.01)
        friction, loss = unit.of("friction", "loss")
        lost = joint.loss_torque(load, speed)
        assert abs(friction) == pytest.approx(lost / abs(RATIO), rel=1e-2)
        assert loss == pytest.approx(abs(friction * driver * RATIO), rel=1e-12)


def test_it_starts_where_the_band_ends_and_comes_to_rest(tmp_path: Path) -> None:
    """Rigid, at 20 N m: held below what starts it, then the motion of one inertia, and back to rest."""
    made = made_joint(sticking)
    joint, unit = joint_model(made), Unit(made, tmp_path, load_torque=20.0)
    starts = joint.holding_band(20.0).highest
    assert starts == pytest.approx((20.0 + 1.5 * 4.0) / 50.0)
    held = unit.run(0.5, motor_torque=0.999 * starts)
    assert unit.sticks and not np.any(np.array(held)[:, :2])
    found = np.array(unit.run(0.6, motor_torque=1.01 * starts))[:, 0]

    def gain(speed: float, motor: float) -> float:
        """Of both inertias; the load's own counts among what the drive transmits and loses by."""
        torque, share = 20.0, LOAD / ROTOR
        for _ in range(9):
            lost = joint.table.lost(torque, max(speed, 1e-9), 40.0)
            torque = (20.0 + share * (motor - lost)) / (1.0 + share)
        return (torque - 20.0) / LOAD

    motor = 1.01 * starts * 50.0
    times = np.arange(1, 601) * 1e-3
    expected = solve_ivp(
        lambda _, v: [gain(v[0], motor)], (0.0, 0.6), [0.0], t_eval=times, rtol=1e-6, atol=1e-8
    ).y[0]
    np.testing.assert_allclose(found, expected, rtol=1e-3, atol=1e-6)
    assert found[-1] > 0.2
    for speed, *_ in unit.run(1.0, motor_torque=20.0 / 50.0):
        assert speed >= 0.0
    assert unit.sticks and unit.of("motor_speed", "output_speed") == [0.0, 0.0]
    assert unit.of("torque")[0] == pytest.approx(20.0)


def test_a_reversal_through_play_is_that_of_an_integrator_with_events(tmp_path: Path) -> None:
    """The motor turns back: the driver rests, starts anew, crosses the play, and takes the load along."""
    made = made_joint(sticking, more=with_play())
    joint = joint_model(made, rotor_inertia=ROTOR / RATIO**2)
    wind_up = 1e-3 + 5.0 / 1000.0
    unit = Unit(made, tmp_path, start_speed=0.3, start_wind_up=wind_up)
    found = np.array(unit.run(0.4, motor_torque=-12.0 / 50.0, load_torque=0.0))
    times = np.arange(401) * 1e-3
    start = np.array([0.0, 0.3, -wind_up, 0.3])
    expected = solved(joint, -12.0, 0.0, start, times)[1:]
    size = np.abs(expected).max(axis=0)
    assert expected[:, 1].min() < -0.2 < 0.2 < found[0, 0]
    inside = abs(expected[:, 0] - expected[:, 2]) < 1e-3
    assert 5 < inside.sum() < 200
    np.testing.assert_allclose(found[:, 0], expected[:, 1], atol=1e-3 * size[1])
    np.testing.assert_allclose(found[:, 1], expected[:, 3], atol=1e-3 * size[3])


@pytest.mark.whole
@pytest.mark.parametrize("torque", [60.0, 2.0], ids=["loaded", "through the play"])
def test_wind_up_play_and_error_move_as_in_the_product(torque: float, tmp_path: Path) -> None:
    """Without friction of a map: against `joint_motion`, its own motion of a joint."""
    points, play = np.array([0.0, 1e-3, 3e-3]), 4e-4
    carried, slopes = np.array([0.0, 25.0, 105.0]), np.array([2e4, 3e4, 4.5e4])
    waves, wave = error(), ErrorOrders(array([1e-4]), array([2.0]), array([0.3]))
    waves["kinematic_error"][1] = 1e-4 * np.cos(2.0 * np.arange(64) * 2.0 * np.pi / 64 + 0.3)
    spring = torsion().assign_coords(torque=carried)
    spring["wind_up"], spring["tangent_torsional_stiffness"] = (
        ("torque", points),
        ("torque", slopes),
    )
    spring["torsional_stiffness"] = ("torque", slopes, {"covers": "teeth"})
    spring["kinematic_play"] = play
    made = made_joint(lossless, more={"torsion": spring, "kinematic_error": waves})
    values = map(array, (torque, ROTOR, LOAD, 12.0, abs(RATIO)))
    curve = WindUpCurve(*map(array, (points, carried, slopes, play)))
    joint = Joint(curve, *values, Sliding(array([0.0]), array([1.0])))
    rest, lag = float(joint.wind_up), 1e-4 * math.cos(0.3)
    times = np.linspace(0.0, 0.2, 41)
    start = array([0.0, 0.0, rest + 1e-3, 0.0])
    expected = joint_motion(joint, wave, MotorRun.steady(40.0), array(times), start)
    speed = 40.0 / abs(RATIO)
    turning = -1e-4 * 2.0 * abs(RATIO) * math.sin(0.3) * speed
    unit = Unit(
        made, tmp_path, damping=12.0, start_speed=speed, start_wind_up=rest + 1e-3 - lag,
        start_wind_up_rate=-turning, motor_torque=torque / abs(RATIO), load_torque=torque,
    )  # fmt: skip
    found = np.array(unit.run(0.2, 5e-3))
    if torque == 2.0:
        assert float(np.min(expected.torque)) < 0.0
    for column, values in ((2, expected.torque), (1, expected.output_rate)):
        size = float(np.ptp(values))
        np.testing.assert_allclose(found[:, column], values[1:], atol=1e-3 * size)


def test_the_program_of_the_guide_lifts_its_arm(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = tmp_path / "joint_files" / "fmu_joint"
    path = handed(made_joint(more=with_play()), place).paths[0]
    path.rename(place / "pair_joint.fmu")
    monkeypatch.chdir(tmp_path)
    values: dict[str, Any] = {}
    exec(block("guide/simulators.md", "python", "simulate_fmu"), values)
    moved = values["moved"]
    assert moved["time"][-1] == 0.5 and not moved["sticks"].all()
    speed = moved["output_speed"]
    assert speed[0] == 0.0 and speed[-1] > speed[100] > 0.0


MOVES = Path(__file__).parents[2] / "examples" / "spur_motion.toml"
STARTS = {
    "run-up": {"torque": "85 N m"},
    "load step": {"torque": "79.5 N m", "speed": "1500 rpm"},
}
PARTS = ["operation", "cycle", "torsion", "four_quadrants", "start_up"]


@pytest.mark.whole
@pytest.mark.parametrize("start", STARTS)
def test_it_moves_as_the_drive_with_the_friction_of_its_teeth(start: str, tmp_path: Path) -> None:
    """The example, whose every contact draws by itself, against the map: within 1 % at all times."""
    asked = {"duration": "40 ms", "rise": "5 ms", "count": 201.0, **STARTS[start]}
    settings = {"loss_map.quadrants": 4, "models.load_sharing": "from_stiffness"}
    settings["dynamics.motion.start_up"] = asked
    made = run_case(str(MOVES), folder=tmp_path / "run", settings=settings, analyses=PARTS)[
        "default"
    ]
    moved = made.parts["start_up"]
    work = moved["work_friction"].values[-1]
    # Without friction speeds would be off by half as much.
    assert work > 0.1 * float(moved["kinetic_energy"][-1])
    found = _started(load_case(str(MOVES), settings=settings), made, moved, tmp_path)
    times, (driver, output) = moved["time"].values, moved["body_speed"].values
    turned = cumulative_trapezoid(driver, times, initial=0.0)
    for values, expected in zip(found[:2], (turned, output), strict=True):
        np.testing.assert_allclose(values, expected, atol=1e-2 * abs(expected).max())
    assert np.trapezoid(found[2], times) == pytest.approx(work, rel=1e-2)


def _started(built: Any, made: Outcome, moved: xr.Dataset, folder: Path) -> np.ndarray:
    """Angle of the driver, speed of the output and loss of the unit under the torques of a start."""
    moving, _ = moving_of(built)
    start, joint = built.case.dynamics.motion.start_up, joint_model(made)
    motor, load = (float(body.inertia) for body in moving.bodies)
    unit = Unit(
        made, folder, Asked(), inertia=motor * joint.ratio**2, load_inertia=load,
        start_speed=start.speed / abs(joint.ratio), temperature=joint.temperature - 273.15,
        damping=float(moving.mesh_damping * line_of_action(moving.design.mesh)[1] ** 2),
    )  # fmt: skip
    rows = [unit.of("motor_angle", "output_speed", "loss")]
    for time in moved["time"].values[1:]:
        middle = (unit.time + time) / 2.0
        torque = built.case.operation.load * min(middle / start.rise, 1.0)
        unit.run(time - unit.time, time - unit.time, motor_torque=start.torque, load_torque=torque)
        rows.append(unit.of("motor_angle", "output_speed", "loss"))
    return np.abs(rows).T


def held_loop(height: float) -> dict[str, xr.Dataset]:
    """A wind-up of one stiffness whose loop is as high everywhere, without play."""
    spring = with_play(0.0)["torsion"]
    for way, sign in (("loading", 1.0), ("unloading", -1.0)):
        values = (spring["torque"].values + sign * height / 2.0)[None]
        spring[f"{way}_torque"] = (("law", "torque"), values)
    return {"torsion": spring}


@pytest.mark.whole
def test_teeth_that_hold_brake_a_vibration_as_in_the_product(tmp_path: Path) -> None:
    """The driver rests: the load swings, and each swing is shorter by the same, as in `joint_motion`."""
    held, start = 2.0, 0.05
    unit = Unit(made_joint(locking, more=held_loop(2.0 * held)), tmp_path, start_wind_up=start)
    found = np.array(unit.run(0.6, 2e-3, motor_torque=0.0, load_torque=0.0))
    assert unit.sticks
    line = map(array, ([0.0, 1.0, 2.0], [0.0, 1e3, 2e3], [1e3] * 3, 0.0))
    values = map(array, (0.0, np.inf, LOAD, 0.0, abs(RATIO)))
    joint = Joint(WindUpCurve(*line), *values, Sliding(array([held]), array([0.0])))
    still, times = ErrorOrders(array([0.0]), array([1.0]), array([0.0])), np.linspace(0.0, 0.6, 301)
    begin = array([0.0, 0.0, start, 0.0])
    expected = joint_motion(joint, still, MotorRun.steady(0.0), array(times), begin)
    swing = np.asarray(expected.wind_up)
    assert swing.min() == pytest.approx(-start + 2.0 * held / 1e3, rel=1e-2)
    rate = np.asarray(expected.output_rate)[1:]
    np.testing.assert_allclose(found[:, 1], rate, atol=1e-2 * np.ptp(rate))


def test_the_loop_of_the_wind_up_is_as_wide_as_friction_holds(tmp_path: Path) -> None:
    """Slowly loaded both ways with the driver at rest; a driver that turns sets the teeth free."""
    held = 2.0
    more = held_loop(2.0 * held)
    unit = Unit(made_joint(locking, more=more), tmp_path / "held", damping=100.0)
    wound = []
    for load in (
        *np.linspace(0.0, 30.0, 16),
        *np.linspace(28.0, -30.0, 30),
        *np.linspace(-28.0, 0.0, 15),
    ):
        unit.run(0.4, 0.1, load_torque=float(load))
        wound.append(unit.of("wind_up")[0])
    assert wound[30] - wound[-1] == pytest.approx(2.0 * held / 1e3, rel=2e-2)
    free = Unit(made_joint(more=more), tmp_path / "turns", damping=40.0)
    joint = joint_model(made_joint(more=more))
    free.run(4.0, 0.1, motor_torque=joint.driver_torque(20.0, 1.0) + 0.01, load_torque=20.0)
    assert free.of("output_speed")[0] > 0.1
    assert free.of("wind_up")[0] == pytest.approx(20.0 / 1e3, rel=1e-2)


def test_friction_ripples_over_the_angle_of_the_driver(tmp_path: Path) -> None:
    """By its waves about what the map loses, and not at all where that is not wanted."""
    made = made_joint(more=rippling())
    unit, table = Unit(made, tmp_path, start_speed=0.5), joint_model(made).table
    found = []
    unit.put(motor_torque=0.5, load_torque=20.0)
    for _ in range(200):
        unit.unit.doStep(unit.time, 1e-4)
        unit.time += 1e-4
        found.append(np.abs(unit.of("friction", "motor_angle", "torque", "output_speed")))
    friction, angle, torque, speed = np.array(found).T
    waves = 1.0 + 0.3 * np.cos(40.0 * angle - 0.7) + 0.1 * np.cos(80.0 * angle + 0.2)
    lost = [table.lost(*point, 40.0) / 50.0 for point in zip(torque, speed, strict=True)]
    assert np.ptp(friction) > 0.5 * np.mean(friction)
    np.testing.assert_allclose(friction, waves * lost, rtol=1e-6)
    unit.put(ripple=0.0)
    torque, speed, smooth = unit.of("torque", "output_speed", "friction")
    assert abs(smooth) == pytest.approx(table.lost(torque, speed, 40.0) / 50.0, rel=1e-9)


def test_a_gear_that_locks_holds_its_load_and_is_driven_down(tmp_path: Path) -> None:
    unit = Unit(made_joint(locking, more=with_play()), tmp_path, damping=5.0)
    for load in (10.0, 60.0, 500.0, -60.0):
        unit.run(2.0, load_torque=load, motor_torque=0.0)
        before = unit.of("motor_angle")
        unit.run(1.0)
        assert unit.sticks and unit.of("motor_angle") == before
    (*_, (speed, _, _)) = unit.run(0.5, load_torque=30.0, motor_torque=-8.0 / 50.0)
    assert speed < -0.01


@pytest.mark.parametrize("inertia", [30.0, 100.0])
def test_a_heavy_load_jams_a_rigid_drive_that_locks(inertia: float, tmp_path: Path) -> None:
    """Above 20 times the armature no torque brakes the load: 1.05 of it holds the driver."""
    unit = Unit(made_joint(locking), tmp_path)
    unit.unit.reset()
    unit.begin(start_speed=50.0, load_inertia=inertia)
    assert np.isfinite(unit.of(*NAMES)).all()
    rows = unit.run(0.01, motor_torque=0.0, load_torque=0.0)
    np.testing.assert_array_equal(rows, 0.0)
    assert unit.sticks and unit.of("motor_angle", "friction", "loss") == [0.0, 0.0, 0.0]
    # A motor that drives the load down against friction finds its torque, from rest and thrown.
    (*_, (speed, output, torque)) = unit.run(0.1, motor_torque=4.0 / 50.0, load_torque=-30.0)
    assert speed == pytest.approx(abs(output)) and speed > 0.0
    assert torque * np.sign(output) > 0.0


def test_a_load_beyond_the_map_is_told_at_rest(tmp_path: Path) -> None:
    unit = Unit(made_joint(locking), tmp_path)
    for load, beyond in ((0.0, 0), (59.0, 0), (61.0, 1), (-59.0, 0), (-61.0, 1)):
        unit.run(0.001, load_torque=load)
        assert unit.sticks
        assert [*unit.unit.getBoolean([len(NAMES) + 1])] == [beyond]


def test_whatever_it_is_asked_it_has_numbers(tmp_path: Path) -> None:
    """At random: at rest, locked, beyond the map, thrown, at steps of any length."""
    random = np.random.default_rng(2)
    for name, law in (("plain", sticking), ("locks", locking)):
        for kind, more in (("wound", with_play()), ("rigid", {})):
            unit = Unit(made_joint(law, more=more), tmp_path / f"{name}_{kind}")
            for _ in range(150):
                scale = 10.0 ** random.uniform(-3.0, 3.0)
                unit.put(
                    motor_torque=scale * random.choice([0.0, 1.0, -1.0]),
                    load_torque=50.0 * scale * random.choice([0.0, 1.0, -1.0]),
                    temperature=random.uniform(-50.0, 200.0),
                    load_inertia=LOAD * random.choice([1.0, 50.0]),
                )
                unit.unit.doStep(0.0, float(random.choice([0.0, 1e-7, 1e-3, 0.013])))
                assert np.isfinite(unit.of(*NAMES)).all()
            kept = unit.unit.getFMUState()
            before = unit.run(0.01)
            unit.unit.setFMUState(kept)
            unit.unit.freeFMUState(kept)
            assert unit.run(0.01) == before
