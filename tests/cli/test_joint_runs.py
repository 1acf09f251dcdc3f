"""The torsional vibration of a joint from a case file: parts, figures for machines, report, screen."""

from collections.abc import Iterator
from pathlib import Path

import bank
import numpy as np
import pytest
from sound import WAVE

from pitchpoint.analyses.analysis_registry import ANALYSES, JOINT, TORSION
from pitchpoint.analyses.joint import RATED, TORQUES, _found, joint_part
from pitchpoint.errors import ConvergenceError
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome
from pitchpoint.views.report import report_page
from pitchpoint.views.screen import head
from pitchpoint.views.section_registry import JOINT as SECTION
from pitchpoint.views.sections.joint import critical_rows

DRIVE = f"""{WAVE}
[models]
friction = {{ name = "constant", coefficient = 0.08 }}
[dynamics]
inertia = ["0.6 kg cm2", "1 kg m2"]
speeds = {{ start = "100 rpm", stop = "2000 rpm", count = 20 }}
"""
DEVIATING = {
    "gears.deviations.flexspline": [{"order": 2, "amplitude": "1 um"}],
    "gears.deviations.circular_spline": [{"order": 2, "amplitude": "2 um"}],
    "gears.fixed": "flexspline",
    "dynamics.damping_ratio": 0.1,
}


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    """Nothing but the joint and the wind-up that it vibrates on."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"torsion": TORSION, "joint": JOINT})
        yield


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("joint") / "joint.toml"
    path.write_text(DRIVE, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def outcome(case: str) -> Outcome:
    return bank.outcomes(case)["default"]


@pytest.fixture(scope="module")
def deviating(case: str) -> Outcome:
    return bank.outcomes(case, settings=DEVIATING)["default"]


@pytest.mark.whole
def test_the_joint_vibrates_on_the_slope_of_its_wind_up(outcome: Outcome) -> None:
    torsion, joint = outcome.parts["torsion"], outcome.parts["joint"]
    slope = float(joint["tangent_torsional_stiffness"][0])
    assert slope == pytest.approx(
        float(torsion["tangent_torsional_stiffness"].sel(torque=67.0)), rel=1e-9
    )
    held, free = joint["natural_frequency"].values * 2.0 * np.pi
    assert held**2 == pytest.approx(slope, rel=1e-12)  # over 1 kg m2
    assert free**2 == pytest.approx(slope * (1.0 + 1.0 / 0.6), rel=1e-12)
    np.testing.assert_allclose(joint["joint_damping_ratio"], [0.03 / np.sqrt(1.6 / 0.6), 0.03])


@pytest.mark.whole
def test_without_deviations_the_ripple_of_the_teeth_excites(outcome: Outcome) -> None:
    joint = outcome.parts["joint"]
    assert joint["excitation"].values.tolist() == ["passing teeth, order 202"]
    assert 0.0 < float(joint["wave_amplitude"][0]) < 1e-5
    assert joint.attrs["note"].startswith("The teeth have no deviations: what excites the joint")
    crossed = 2.0 * np.pi * joint["natural_frequency"] / 202.0
    np.testing.assert_allclose(joint["critical_speed"][:, 0], crossed, rtol=1e-12)


@pytest.mark.whole
def test_waves_of_both_splines_turn_against_the_wave_generator(deviating: Outcome) -> None:
    """With the flexspline fixed its waves pass as often as the wave generator turns."""
    joint = deviating.parts["joint"]
    order = dict(zip(joint["excitation"].values, joint["wave_order"].values, strict=True))
    assert order["flexspline, order 2"] == pytest.approx(2.0, rel=1e-12)
    assert order["circular spline, order 2"] == pytest.approx(2.0 * 200.0 / 202.0, rel=1e-12)
    assert joint.attrs["strongest"] == "circular spline, order 2"
    assert joint.attrs["note"].startswith("Left out: ")


@pytest.mark.whole
def test_the_resonance_stands_at_its_critical_speed(deviating: Outcome) -> None:
    """Close to the amplitude of one degree of freedom, 1/(2 xi) times the error on the spring and more."""
    joint = deviating.parts["joint"]
    at = joint["torque_amplitude"].isel(motor=0, excitation=0)
    critical = float(joint["critical_speed"][0, 0])
    assert float(joint["speed"][int(at.argmax("speed"))]) == pytest.approx(critical, rel=1e-12)
    ratio = float(joint["joint_damping_ratio"][0])
    ratio += float(joint["flank_damping_ratio"].isel(motor=0, excitation=0).sel(speed=critical))
    spring = float(joint["tangent_torsional_stiffness"][0] * joint["wave_amplitude"][0])
    expected = spring * np.hypot(1.0, 2.0 * ratio) / (2.0 * ratio)
    assert float(at.max()) == pytest.approx(expected, rel=1e-9)


@pytest.mark.whole
def test_the_whole_curve_agrees_where_little_vibrates(deviating: Outcome) -> None:
    joint = deviating.parts["joint"]
    assert (joint["course_status"] == 0).all()
    whole, tangent = (joint[name].values[0] for name in ("course_torque", "linear_torque"))
    assert whole == pytest.approx(tangent, rel=0.02)


@pytest.mark.whole
def test_the_joint_is_told(deviating: Outcome, outcome: Outcome) -> None:
    told = figures_by_law(deviating)["joint"]
    assert [*told] == [
        "motor holds its speed",
        "motor runs free",
        "wave_order",
        "wave_amplitude",
        "excitation",
    ]
    frequency = float(deviating.parts["joint"]["natural_frequency"][0])
    assert told["motor holds its speed"]["natural_frequency"] == frequency
    row = critical_rows(deviating)[0]
    assert row["wave of the error"] == "circular spline, order 2"
    critical = float(deviating.parts["joint"]["critical_speed"][0, 0])
    assert float(row[f"{head('critical_speed', deviating.parts['joint'])}, held"]) == pytest.approx(
        critical * 30.0 / np.pi,
        rel=5e-4,  # four digits are shown
    )
    (printed,) = SECTION.screen(deviating)
    assert "on a motor that holds its speed" in printed.line
    page = report_page({"a": outcome, "b": deviating})
    assert page.count('id="joint0_campbell"') == page.count('id="joint1_torque"') == 1
    assert "The damping ratio, 0.1, is that of the free joint" in page
    assert "The damping ratio, 0.03, is that of the free joint" in page
    assert "<dt>Joint resonance</dt>" in page


@pytest.mark.whole
def test_waves_far_from_resonance_are_not_integrated(deviating: Outcome, outcome: Outcome) -> None:
    courses = [one.parts["joint"]["course"].values.tolist() for one in (deviating, outcome)]
    assert courses == [["operating speed", "critical speed"], ["critical speed"]]


def test_torques_without_equilibrium_end_the_curve() -> None:
    points = np.stack([TORQUES, TORQUES, np.ones(TORQUES.size)])
    points[0, -2:] = np.nan
    assert _found(points).shape == (3, TORQUES.size - 2)
    points[0, RATED] = np.nan
    with pytest.raises(ConvergenceError, match="no spring for the joint to vibrate on"):
        _found(points)


@pytest.mark.whole
def test_without_a_load_the_flanks_change_sides(case: str) -> None:
    built = running.load_case(case, settings={"operation.torque": "0 N m"})
    joint = joint_part(built, lambda done: None)
    assert np.isfinite(joint["torque_amplitude"]).all()
    assert "the torque swings by more than the load there" in joint.attrs["warnings"]


@pytest.mark.whole
def test_a_case_without_the_table_has_no_joint(case: str, tmp_path: Path) -> None:
    path = tmp_path / "still.toml"
    path.write_text(DRIVE.partition("[dynamics]")[0], "utf-8")
    assert JOINT.why_not(running.load_case(str(path))) == "the case has no [dynamics]"
