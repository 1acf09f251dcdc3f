"""Motion with friction from a case file: parts, the march through speeds, a start, report, refusals."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.analyses.along_action import MOTION, MOTIONS, START_UP
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.motion import moving_of, quasi_static
from pitchpoint.core.status import Code
from pitchpoint.dynamics.steady_motion import steady_motion
from pitchpoint.errors import InputError
from pitchpoint.gears.families import sample_of
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.report import report_page
from pitchpoint.views.section_registry import MOTION as SECTION

CASE = f"""{PAIR}
[models]
friction = {{ name = "constant", coefficient = 0.05 }}
tooth_contact = "separating"
[dynamics]
damping_ratio = 0.08
profile_error = [{{ order = 1, amplitude = "1 um" }}]
speeds = {{ start = "4000 rpm", stop = "8000 rpm", count = 3 }}
[dynamics.motion]
bearing_stiffness = "200 N/um"
bearing_damping = "500 N s/m"
mass = ["0.25 kg", "2 kg"]
start_up = {{ duration = "3.5 ms", torque = "30 N m", rise = "1 ms", count = 241 }}
"""
SPEED = 1500.0 * np.pi / 30.0


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    """Nothing but motion."""
    parts = {"motion": MOTION, "motion_against_speed": MOTIONS, "start_up": START_UP}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", parts)
        yield


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("motion") / "motion.toml"
    path.write_text(CASE, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def folder(case: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("out")


@pytest.fixture(scope="module")
def outcome(case: str, folder: Path) -> Outcome:
    return running.run_case(case, folder=folder)["default"]


@pytest.mark.whole
def test_a_motion_is_found_and_its_energy_closes(outcome: Outcome) -> None:
    data = outcome.parts["motion"]
    assert data.attrs["sentence"] == Code.SOLVED.sentence
    assert float(data["energy_closure"]) < 1e-8
    lost = sum(float(data[f"work_{name}"]) for name in ("friction", "rolling", "damping"))
    brought = sum(float(data[f"work_{name}"]) for name in ("put_in", "error"))
    left = brought + float(data["work_mesh"]) - lost
    assert abs(left) < 1e-8 * float(data["work_put_in"])
    assert float(data["mean_efficiency"]) == pytest.approx(
        float(data["quasi_static_efficiency"]), abs=2e-3
    )


@pytest.mark.whole
def test_speeds_and_forces_are_those_of_bodies_in_balance(outcome: Outcome) -> None:
    data = outcome.parts["motion"]
    assert data["relative_speed"].dims == ("body", "node")
    assert np.ptp(data["relative_speed"].values) > 1e-5
    # In the mean the bearing along the line of action takes the normal forces of the pairs.
    order = np.argsort(data["turned"].values)
    turned, force = data["turned"].values[order], data["load"].sum("pair").values[order]
    own, other = (
        float(np.trapezoid(data["bearing_force"].values[k][order], turned)) for k in (0, 2)
    )
    assert own == pytest.approx(-other, rel=1e-3)
    assert abs(own) == pytest.approx(float(np.trapezoid(force, turned)), rel=1e-3)


@pytest.mark.whole
def test_the_part_is_what_the_kernel_finds(case: str, outcome: Outcome) -> None:
    built = load_case(case)
    moving, modes = moving_of(built)
    data = outcome.parts["motion"]
    assert modes.frequency.size == 6
    assert np.count_nonzero(modes.frequency) == data.sizes["mode"] == 5
    np.testing.assert_allclose(quasi_static(built, [SPEED]), data["quasi_static_efficiency"])
    with pytest.raises(InputError, match="above 0, got 0"):
        steady_motion(moving, 0.0)


@pytest.mark.whole
def test_the_march_goes_up_and_down_and_is_resumed(
    case: str, folder: Path, outcome: Outcome
) -> None:
    data = outcome.parts["motion_against_speed"]
    assert data["direction"].values.tolist() == ["rising", "falling"]
    assert np.all(data["vibration_status"].values == Code.SOLVED)
    up, down = data["transmission_error_rms"].values
    np.testing.assert_allclose(up, down, rtol=1e-6)
    assert np.all(np.abs(np.diff(up)) > 1e-3 * up.max())
    assert data["spectrum"].dims == ("direction", "speed", "order")
    pieces = [path for path in folder.rglob("motion_against_speed*.nc")]
    assert len(pieces) == 1
    again = running.open_outcomes(folder)["default"].parts["motion_against_speed"]
    np.testing.assert_array_equal(again["mean_efficiency"], data["mean_efficiency"])


@pytest.mark.whole
def test_a_start_gathers_speed_by_what_its_torques_leave(outcome: Outcome) -> None:
    data = outcome.parts["start_up"]
    energy = {name: data[name].values for name in data.data_vars if "work" in str(name)}
    assert float(data["energy_closure"]) < 1e-8
    first, second = data["body_speed"].values
    assert first[0] == second[0] == 0.0
    late = slice(-120, None)  # some vibrations
    assert first[late].mean() / second[late].mean() == pytest.approx(61.0 / 23.0, rel=1e-2)
    left = energy["work_put_in"] - energy["work_friction"] - energy["work_damping"]
    assert left[-1] == pytest.approx(float(data["kinetic_energy"][-1]), rel=2e-2)


@pytest.mark.whole
def test_report_screen_and_figures_tell_it(outcome: Outcome) -> None:
    page = report_page({"default": outcome})
    assert page.count("Speed rising and falling give the same.") > 3
    assert "speed falling" not in page
    for words in ("Motion with friction", "Campbell", "Against speed", "bearings that yield"):
        assert words in page
    printed, ended = SECTION.screen(outcome)
    assert "of the teeth with vibration and friction together" in printed.line
    assert ended.line.startswith("Start, after 3")
    assert "gear 1" in ended.line
    assert "largest normal force" in ended.line
    told = figures_by_law(outcome)
    assert told["motion"]["status"] == Code.SOLVED.sentence
    assert len(told["motion"]["natural_frequency"]) == 5
    assert told["start_up"]["largest_mesh_force"] > 0.0
    for words in (
        "percentage points",
        "Width at half power",
        "Orders of the force on the bearings",
    ):
        assert words in page


@pytest.mark.whole
def test_critical_speeds_are_where_orders_meet_modes(outcome: Outcome) -> None:
    rows = figures_by_law(outcome)["critical_speeds"]
    data = outcome.parts["motion_against_speed"]
    natural, ratio = (data[one].values for one in ("natural_frequency", "modal_damping_ratio"))
    low, high = (rpm * np.pi / 30.0 for rpm in (4000.0, 8000.0))
    expected = [
        (2.0 * np.pi * frequency / (order * 23.0), order, ratio[mode])
        for mode, frequency in enumerate(natural)
        for order in range(1, 9)
    ]
    expected = sorted(one for one in expected if low <= one[0] <= high)
    assert len(rows) == len(expected) > 3
    for row, (speed, order, damped) in zip(rows, expected, strict=True):
        assert row["critical_speed"] == pytest.approx(speed, rel=1e-9)
        assert row["critical_order"] == order
        assert row["half_power_width"] == pytest.approx(2.0 * damped * speed, rel=1e-9)
        assert "line of action" in row["mode"] or row["mode"] == "teeth"
    warned = data.attrs["warnings"]
    assert "the speeds are 2000 rpm apart, and the peak at" in warned
    assert "rpm wide at half power" in warned


@pytest.mark.whole
def test_what_vibration_takes_is_the_difference_of_efficiencies(outcome: Outcome) -> None:
    data = outcome.parts["motion"]
    taken = float(data["quasi_static_efficiency"] - data["mean_efficiency"])
    assert float(data["efficiency_difference"]) == pytest.approx(taken, abs=1e-15)
    assert taken != 0.0


@pytest.mark.whole
def test_orders_of_the_bearing_forces_have_their_mean_and_their_swing(outcome: Outcome) -> None:
    data = outcome.parts["motion"]
    spectrum = data["bearing_spectrum"]
    assert spectrum.dims == ("bearing", "order")
    order = np.argsort(data["turned"].values)
    turned, force = data["turned"].values[order], data["bearing_force"].values[:, order]
    wave = np.exp(-2j * np.pi * turned)
    for own, amplitudes in zip(force, spectrum.values, strict=True):
        assert abs(np.trapezoid(own, turned)) == pytest.approx(amplitudes[0], rel=1e-2, abs=0.5)
        first = 2.0 * abs(np.trapezoid(own * wave, turned))
        assert first == pytest.approx(amplitudes[1], rel=1e-2, abs=0.5)


@pytest.mark.whole
def test_inertia_that_a_case_leaves_open_stands_among_its_inputs(outcome: Outcome) -> None:
    rows = [row for row in outcome.manifest["inputs"] if row["key"] == "inertia"]
    ((small, large),) = [row["value"] for row in rows]
    assert 0.0 < small < large / 10.0
    assert rows[0]["status"] == "derived"


@pytest.mark.whole
def test_a_rack_moves_too() -> None:
    data = running.run_case(str(sample_of(RackAndPinionGears)))["default"].parts
    assert data["motion"].attrs["sentence"] == Code.SOLVED.sentence
    assert float(data["motion"]["mean_efficiency"]) == pytest.approx(
        float(data["motion"]["quasi_static_efficiency"]), abs=2e-3
    )
    assert "leaves out the losses" in data["motion"].attrs["warnings"]
    assert float(data["start_up"]["relative_speed"][1, -1]) > 0.0


REFUSED = {
    "mass": ({"bearing_stiffness": "1 N/um"}, "mass: is missing; gears that shift"),
    "motor": ({"stall_torque": "1 N m"}, "no_load_speed: is missing; a motor"),
    "both": (
        {"stall_torque": "1 N m", "no_load_speed": "9 rpm", "prescribed_speed": True},
        "needs no motor",
    ),
    "table": ({"pair_path": [0, 1], "pair_stiffness": ["1 N/um"]}, "1 values are given for 2"),
    "negative": ({"pair_path": [0, 1], "pair_stiffness": ["1 N/um", "-1 N/um"]}, "above 0 N/um"),
    "path": (
        {"pair_path": [1, 0], "pair_stiffness": ["1 N/um", "1 N/um"]},
        "places of a pair grow",
    ),
    "entry": ({"pair_path": [0.5, 1], "pair_stiffness": ["1 N/um", "1 N/um"]}, "grow from 0"),
    "exit": ({"pair_path": [0, 1], "pair_stiffness": ["1 N/um", "1 N/um"]}, "path of a pair is 1."),
    "held": (
        {
            "prescribed_speed": True,
            "start_up": {"duration": "1 s", "torque": "1 N m", "speed": "9 rpm"},
        },
        "needs no torque",
    ),
    "undamped": ({"mesh_damping": "0 N s/m"}, "nothing that damps"),
    "no torque": ({"start_up": {"duration": "1 s"}}, "start_up.torque: is missing"),
    "rise": ({"start_up": {"duration": "1 s", "torque": "1 N m", "rise": "2 s"}}, "shorter than"),
}


@pytest.mark.parametrize("given", REFUSED)
def test_what_cannot_move_is_told_in_one_sentence(given: str, tmp_path: Path) -> None:
    asked, told = REFUSED[given]
    path = tmp_path / "case.toml"
    path.write_text(f"{PAIR}[dynamics]\nmotion = {written(asked)}\n", "utf-8")
    with pytest.raises(InputError) as error:
        load_case(str(path))
    assert told in str(error.value)


@pytest.mark.whole
def test_a_motion_without_load_is_refused(case: str) -> None:
    with pytest.raises(
        InputError, match=r"operation.torque: 0 was given; a motion asks for a torque"
    ):
        load_case(case, settings={"operation.torque": "0 N m"})


@pytest.mark.whole
def test_a_start_that_runs_backwards_says_so(case: str) -> None:
    given = {"dynamics.motion.start_up.torque": "5 N m"}
    built = load_case(case, settings=given)
    told = START_UP.compute(built, {}, lambda _: None).attrs["warnings"]
    assert "turns the driver, gear 1, backwards; it asks for 18.85 N m" in told


def written(value: Any) -> str:
    if isinstance(value, dict):
        inner = ", ".join(f"{key} = {written(one)}" for key, one in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(written, value))}]"
    return str(value).lower() if isinstance(value, bool | int) else f'"{value}"'
