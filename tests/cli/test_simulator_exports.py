"""Joints for simulators: every target of every kind of drive, with what is lost in it."""

import ast
import re
import runpy
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_joints import TITLE, error, locking, made_joint, plain, strengths, torsion
from scipy.io import loadmat

from pitchpoint.errors import InputError
from pitchpoint.exports.simulators import TARGETS, Asked, HandedOver, hand_over
from pitchpoint.runs.joint_model import joint_model
from pitchpoint.runs.run import Outcome

WISHES = Asked(torque_range="5 N m:25 N m", speed_range="2 rpm:20 rpm")
ROTOR = Asked(rotor_inertia="2 kg cm2")


def handed(made: Outcome, folder: Path, target: str, wishes: Asked | None = None) -> HandedOver:
    return hand_over({"default": made}, folder, [target], wishes)[target]


def unpacked(path: Path) -> list[Path]:
    """A file of text, or those of an archive."""
    if path.suffix != ".fmu":
        return [path]
    with zipfile.ZipFile(path) as archive:
        archive.extractall(path.parent)
        return [path.parent / one for one in archive.namelist() if not one.startswith("binaries/")]


def rows(lines: list[str]) -> np.ndarray:
    """Largest and mean error and number of points of each row of a table."""
    found = re.findall(
        r"^(?:the map|range) .*\) +(\S+) +(\S+) +\S+ % +(\d+)$", "\n".join(lines), re.MULTILINE
    )
    return np.array(found, float)


def same(lines: list[str], law: Callable[..., np.ndarray]) -> None:
    """The table is that of a law of loss, over the whole map."""
    errors = joint_model(made_joint()).errors(law)
    expected = [(one.largest, one.mean, one.points) for one in errors]
    np.testing.assert_allclose(rows(lines)[:2], expected, rtol=1e-3)


def constant(friction: float, viscous: float) -> Callable[..., np.ndarray]:
    return lambda torque, speed, degree: friction + viscous * speed


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("kind", ["plain", "locking", "slides", "several"])
def test_every_target_takes_every_drive(target: str, kind: str, tmp_path: Path) -> None:
    law = locking if kind == "locking" else plain
    made = made_joint(
        law, slides=kind == "slides", more={"torsion": torsion()} if kind == "plain" else None
    )
    outcomes = {"a": made, "b": made} if kind == "several" else {"default": made}
    written = hand_over(outcomes, tmp_path, [target], ROTOR)
    assert len(written) == len(outcomes)
    for name, files in written.items():
        assert all(path.is_file() for path in files.paths)
        assert {path.parent.name for path in files.paths} == {target}
        assert all(len(line) <= 80 for line in files.lost)
        assert kind != "several" or name in (f"a: {target}", f"b: {target}")
        for path in files.paths:
            if path.suffix in (".xml", ".urdf"):
                values = [v for one in ElementTree.parse(path).iter() for v in one.attrib.values()]
                assert not {"nan", "inf", "None"} & {
                    word for value in values for word in value.split()
                }


HOLDS_THE_MAP = ("fmu", "fmu_joint", "simscape")
"""Targets that lose nothing of the map, and have no table of it."""


@pytest.mark.parametrize("target", TARGETS)
def test_the_head_of_a_file_has_the_table_of_the_screen(target: str, tmp_path: Path) -> None:
    """Whole, with the rows of the range that somebody names, in one file of each target."""
    wishes = replace(WISHES, rotor_inertia="2 kg cm2")
    paths, lost = handed(made_joint(), tmp_path, target, wishes)
    if target in HOLDS_THE_MAP:
        assert len(rows(lost)) == 0
    else:
        assert [line.split()[0] for line in lost[2:6]] == ["the", "the", "range", "range"]
        assert all(float(row[2]) > 0 for row in rows(lost)) and len(rows(lost)) == 4
    texts = [
        "\n".join(line.removeprefix("//").removeprefix("%").strip() for line in text.splitlines())
        for one in paths
        for path in unpacked(one)
        if path.suffix != ".mat"
        for text in [path.read_text("utf-8")]
    ]
    head = "\n".join(line.strip() for line in lost[:6])
    assert any(head in text for text in texts)


@pytest.mark.parametrize("target", TARGETS)
def test_what_somebody_typed_ends_no_remark(target: str, tmp_path: Path) -> None:
    made = made_joint()
    made.manifest["members"][0] = "a -- b <c>&"
    made.manifest |= {"case": '--> 1 end; */ """ \'', "driver": "a -- b <c>&", "warnings": [TITLE]}
    paths = handed(made, tmp_path, target, ROTOR).paths
    for path in [one for each in paths for one in unpacked(each)]:
        if path.suffix == ".mat":
            continue
        text = path.read_text("utf-8")
        if path.suffix in (".xml", ".urdf"):
            root = ElementTree.fromstring(text)
            named = [one for one in root.iter() if one.tag not in ("Unit", "File")]
            names = [one.get("name") or one.get("class") or "x" for one in named]
            assert all(re.fullmatch(r"[A-Za-z]\w*", name) for name in names)
        elif path.suffix == ".py":
            compile(text, path.name, "exec")


HOSTILE = (
    '*/ int x; /* """ \\ --> ]]> & ??/ \' ; %{ \n end MadeDrive; \r\n x = 1 // é \u2028 </p> $(x)'
)


def hostile() -> Outcome:
    """Every text that a file has from a result, as somebody may have typed it."""
    made = made_joint(more={"torsion": torsion(), "kinematic_error": error()})
    made.manifest["members"][0] = HOSTILE
    made.manifest |= {
        "title": HOSTILE,
        "case": HOSTILE + "/made.toml",
        "variant": HOSTILE,
        "driver": HOSTILE,
        "warnings": [HOSTILE],
        "lacks": {"bodies": HOSTILE, "strength": HOSTILE},
    }
    data = made.parts["four_quadrants"]
    data.attrs |= dict.fromkeys(("note", "version", "fingerprint"), HOSTILE)
    made.parts["four_quadrants"] = data.assign_coords(law=[HOSTILE])
    turns = f"{HOSTILE} against circular spline"
    made.parts["kinematic_error"] = error().assign_attrs(turn_angle=turns)
    made.parts["torsion"] = made.parts["torsion"].assign_coords(law=[HOSTILE])
    made.parts["torsion"]["torsional_stiffness"].attrs["covers"] = HOSTILE
    return made


@pytest.mark.parametrize("target", TARGETS)
def test_hostile_texts_of_a_result_stay_texts(target: str, tmp_path: Path) -> None:
    """XML has the elements, C, Python, MATLAB and Modelica the statements that they have without them."""
    plain_paths, hostile_paths = (
        [
            path
            for one in handed(made, tmp_path / name, target, ROTOR).paths
            for path in unpacked(one)
        ]
        for name, made in (("plain", harmless()), ("hostile", hostile()))
    )
    for path, twin in zip(hostile_paths, plain_paths, strict=True):
        assert statements(path) == statements(twin), path.name


@pytest.mark.parametrize("target", TARGETS)
def test_a_map_of_other_temperatures_than_operation_is_taken_at_its_nearest(
    target: str, tmp_path: Path
) -> None:
    made = made_joint()
    made.parts["four_quadrants"].attrs["degree"] = 273.15 + 61.5
    paths, lost = handed(made, tmp_path, target, ROTOR)
    told = "of the 61.5 degC of operation: what has one temperature has its nearest, 60 degC"
    assert told in " ".join(lost)
    texts = [
        path.read_text("utf-8") for one in paths for path in unpacked(one) if path.suffix != ".mat"
    ]
    assert any(" the 61.5 degC of operation" in re.sub(r"[\s%/*#]+", " ", text) for text in texts)


def test_a_unit_that_somebody_made_up_is_refused(tmp_path: Path) -> None:
    made = made_joint()
    made.parts["four_quadrants"]["output_torque"].attrs["units"] = 'N m""" \nimport os'
    with pytest.raises(InputError, match="is not as this version writes it; run the case again"):
        handed(made, tmp_path, "isaac")


def harmless() -> Outcome:
    """The same result without such texts."""
    made = made_joint(more={"torsion": torsion(), "kinematic_error": error()})
    made.manifest["title"] = "joint"
    return made


def statements(path: Path) -> list[str]:
    """What a file of source does, without its remarks and the contents of its texts."""
    if path.suffix == ".mat":
        return []
    text = path.read_text("utf-8")
    if path.suffix in (".xml", ".urdf"):
        return [one.tag for one in ElementTree.fromstring(text).iter()]
    if path.suffix == ".py":
        return [
            type(one).__name__ for one in ast.walk(ast.parse(text)) if isinstance(one, ast.stmt)
        ]
    if path.suffix == ".html":
        return re.findall(r"<(/?\w+)", text)
    kind = r"'[^'\n]*'|%.*" if path.suffix == ".m" else r'"(?:[^"\\]|\\.)*"|//.*|/\*(?s:.*?)\*/'
    return re.findall(r"[^\W\d]\w+", re.sub(kind, " ", text))


def test_a_joint_of_urdf_has_the_friction_that_its_table_is_of(tmp_path: Path) -> None:
    (path,), lost = handed(made_joint(), tmp_path, "urdf", WISHES)
    joint = ElementTree.parse(path).find("joint")
    assert joint is not None
    found = [joint.find(name) for name in ("dynamics", "limit")]
    dynamics, limit = ({} if one is None else one.attrib for one in found)
    same(lost, constant(float(dynamics["friction"]), float(dynamics["damping"])))
    assert (limit["effort"], limit["velocity"], joint.get("type")) == ("60", "4", "revolute")
    assert "armature" in path.read_text("utf-8")
    (slide,), _ = handed(made_joint(slides=True), tmp_path, "urdf")
    assert 'type="prismatic"' in slide.read_text("utf-8")


def test_mujoco_reads_the_joint_of_urdf(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    (path,), _ = handed(made_joint(), tmp_path, "urdf", WISHES)
    model = mujoco.MjModel.from_xml_path(str(path))
    same_numbers = re.search(r'damping="(\S+)" friction="(\S+)"', path.read_text("utf-8"))
    assert same_numbers is not None
    found = float(model.dof_damping[0]), float(model.dof_frictionloss[0])
    assert found == pytest.approx([float(one) for one in same_numbers.groups()])


def test_friction_of_isaac_starts_the_joint_as_the_map_does(tmp_path: Path) -> None:
    """At 20 N m it starts with 2 + 2 N m on and 2 + 2.4 N m back."""
    (path,), lost = handed(made_joint(), tmp_path, "isaac", Asked(rotor_inertia="2 kg cm2"))
    made = runpy.run_path(str(path))
    values = made["ACTUATOR"]
    assert values["armature"] == pytest.approx(2e-4 * 2500.0)
    assert values["friction"] == pytest.approx(max(4.2, values["dynamic_friction"]))
    same(lost, constant(values["dynamic_friction"], values["viscous_friction"]))
    assert (
        made["LIMITS"] == {"effort_limit_sim": 60, "velocity_limit_sim": 4}
        and made["RATIO"] == -50.0
    )
    text = " ".join(path.read_text("utf-8").split())
    assert all(
        word in text for word in ("Isaac Sim 5.0", "Isaac Sim 4.5", "PhysX 5.6", "N m over rad/s")
    )
    worm = runpy.run_path(str(handed(made_joint(locking), tmp_path, "isaac").paths[0]))["ACTUATOR"]
    assert worm["friction"] >= 20.0


def test_the_envelope_of_isaac_is_that_of_a_motor_of_direct_current(tmp_path: Path) -> None:
    """0.05 N m/A, 2 ohm, 24 V behind 50: 30 N m stalled, 9.6 rad/s idle, none at the torque of the stall."""
    (path,), _ = handed(made_joint(more=strengths()), tmp_path, "isaac")
    made = runpy.run_path(str(path))
    found = made["envelope"](0.05, 2.0, 24.0, 20.0)
    assert found["max_actuator_velocity"] == pytest.approx(9.6)
    assert found["speed_effort_gradient"] * 30.0 == pytest.approx(9.6)
    assert (found["max_effort"], found["velocity_dependent_resistance"]) == (
        pytest.approx(28.8),
        0.0,
    )
    assert made["envelope"](0.05, 2.0, 24.0, 4.0)["max_effort"] == pytest.approx(10.0)


def test_every_target_that_has_limits_writes_what_parts_bear(tmp_path: Path) -> None:
    """28.8 N m, which the flanks bear; all heads name every part."""
    made = made_joint(more=strengths())
    folders = {one: handed(made, tmp_path, one, ROTOR).paths for one in TARGETS}
    for target, paths in folders.items():
        texts = [
            " ".join(one.read_text("utf-8").split())
            for path in paths
            for one in unpacked(path)
            if one.suffix != ".mat"
        ]
        said = "flanks of the teeth 28.8"
        assert any(said in re.sub(r" [%/*]+ ", " ", text) for text in texts), target
    urdf = ElementTree.parse(folders["urdf"][0]).find("joint/limit")
    assert urdf is not None and float(urdf.attrib["effort"]) == 28.8
    assert runpy.run_path(str(folders["isaac"][0]))["LIMITS"]["effort_limit_sim"] == 28.8
    assert "effort 28.8, which is the least torque" in folders["ros2_control"][0].read_text("utf-8")
    matrices = loadmat(folders["simscape"][0], simplify_cells=True)
    assert matrices["limits"]["torque"] == pytest.approx(28.8)
    motor = ElementTree.parse(folders["mujoco"][0]).find(".//motor")
    assert motor is not None
    driver = joint_model(made).driver_torque(28.8, 4.0)
    assert float(motor.attrib["ctrlrange"].split()[1]) == pytest.approx(driver, rel=1e-5)


def test_a_transmission_of_ros2_control_has_the_ratio_and_no_loss(tmp_path: Path) -> None:
    (path,), lost = handed(made_joint(), tmp_path, "ros2_control")
    root = ElementTree.parse(path).getroot()
    assert root.findtext("plugin") == "transmission_interface/SimpleTransmission"
    assert float(root.findtext("joint/mechanical_reduction") or 0.0) == -50.0
    same(lost, constant(0.0, 0.0))
