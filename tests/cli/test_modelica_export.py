"""A drive as a package of Modelica: tables against the map, by the equations of LossyGear."""

import re
from pathlib import Path

import numpy as np
import pytest
from made_joints import Lost, locking, made_joint, plain, torsion
from scipy.optimize import brentq, linprog

from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.efficiency.friction_fit import loss_nodes
from pitchpoint.efficiency.loss_table import LossTable
from pitchpoint.exports.modelica import LossyRow, least_line_error, lossy_rows, lossy_torque
from pitchpoint.exports.modelica_map import MapTables, map_lost
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
        closed = re.findall(r"^ *end (?!for;)(\w+);", code, re.MULTILINE)
        assert sorted(opened) == sorted(closed) and path.stem == opened[0]
        plain = re.sub(r'"[^"]*"', "", code)
        assert code.count('"') % 2 == 0
        assert all(plain.count(a) == plain.count(b) for a, b in ("()", "[]"))
        for joint in ("Joint", "JointOfMap"):
            model = code[code.index(f"model {joint} ") : code.index(f"end {joint};")]
            parts = set(re.findall(r"^    (?:Modelica\.\S+|\w*Gear\w*) (\w+)", model, re.MULTILINE))
            ends = re.findall(r"connect\((\w+)\S*, (\w+)\S*\);", model)
            assert {one for both in ends for one in both} == parts
            assert ("IdealGearR2T" in model) == (name == "slides")
            assert (f"elastic = {str(name != 'bare').lower()} " in model) and "backlash = " in model
            assert "annotation(Documentation(info" in model
        stiff = re.findall(r"stiffness = (\S+)$", code, re.MULTILINE)
        assert {*map(float, stiff)} == {{"turns": 1000.0, "slides": 0.4, "bare": 1.0}[name]}


def syntax_errors(path: Path) -> list[str]:
    """What a parser of the grammar of Modelica says of a file."""
    parser = pytest.importorskip("modelica_builder.modelica_parser")
    antlr4 = pytest.importorskip("antlr4")
    found: list[str] = []

    class Listener(antlr4.error.ErrorListener.ErrorListener):  # type: ignore[misc,name-defined]
        def syntaxError(self, *told: object) -> None:  # noqa: N802
            found.append(f"{told[2]}:{told[3]}: {told[4]}")

    lexer = parser.modelicaLexer(antlr4.FileStream(str(path), "utf-8"))
    made = parser.modelicaParser(antlr4.CommonTokenStream(lexer))
    for one in (lexer, made):
        one.removeErrorListeners()
        one.addErrorListener(Listener())
    made.stored_definition()
    return found


@pytest.mark.parametrize("kind", ["turns", "slides", "locks"])
def test_a_parser_of_the_grammar_reads_it_without_an_error(kind: str, tmp_path: Path) -> None:
    """Whatever somebody typed; and the parser says where a file is wrong."""
    made = made_joint(locking) if kind == "locks" else made_joint(slides=kind == "slides")
    made.manifest["driver"] = 'a "b" \\" */ // <c>&\n'
    made.manifest["members"][0] = made.manifest["driver"]
    (path,), _ = handed(made, tmp_path)
    assert syntax_errors(path) == []
    wrong = tmp_path / "wrong.mo"
    for before, after in (
        ("equation\n", "equaton\n"),
        ("end for;\n", "end for\n"),
        ("ratio = ", "ratio == "),
    ):
        wrong.write_text(path.read_text("utf-8").replace(before, after, 1), "utf-8")
        assert syntax_errors(wrong)


def matrices(text: str) -> list[np.ndarray]:
    """Tables of the model of the map: of each temperature in motion, and that at rest."""
    found = re.findall(r"\[(0, [^\]]*)\]", text[text.index("model MapGear") :])
    return [np.array([[*map(float, row.split(","))] for row in one.split(";")]) for one in found]


@pytest.mark.parametrize("law", [plain, locking])
def test_the_model_of_the_map_has_the_map(law: Lost, tmp_path: Path) -> None:
    """At random points in and beyond it, by the tables in the file; what locks has more than its load."""
    made = made_joint(law)
    (path,), lost = handed(made, tmp_path)
    text, joint = path.read_text("utf-8"), joint_model(made)
    *moving, rest = matrices(text)
    (degrees,) = re.findall(r"degrees\[7\] = \{(.*?)\}", text)
    degree = np.array([*map(float, degrees.split(","))])
    axes = moving[0][1:, 0], moving[0][0, 1:]
    tables = MapTables(*axes, degree, np.stack([one[1:, 1:] for one in moving]), rest[1:, 1:])
    random = np.random.default_rng(6)
    points = random.uniform([-80.0, 1e-3, 10.0], [80.0, 5.0, 70.0], (2000, 3))
    found = map_lost(tables, *points.T)
    expected = joint.loss_torque(*points.T[:2], points[:, 2] + 273.15)
    (said,) = re.findall(r"largest error is (\S+) N m", " ".join(lost))
    known = np.isfinite(expected)
    assert known.all() == (law is plain) and float(said) < 1e-9
    # A node of the table counts there, one of the nodes of the law between: 50 N m of the output a N m.
    assert np.abs(found - expected)[known].max() <= 60.0 * max(float(said), 1e-11)
    assert (found[~known] >= 1.049 * np.minimum(abs(points[~known, 0]), 60.0)).all()
    for torque in (-30.0, 0.0, 30.0):
        band = joint.holding_band(torque)
        starts = np.interp(
            [torque, -torque], rest[1:, 0], rest[1:, 1 + np.argmin(abs(degree - 40.0))]
        )
        for found_end, end in (
            (torque + starts[0], band.highest),
            (torque - starts[1], band.lowest),
        ):
            assert np.isnan(end) or found_end / 50.0 == pytest.approx(end)


def steep(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    """Most of what comes back is lost, along no line."""
    back = 0.5 + 0.7 * abs(torque) + 0.004 * torque**2
    return np.where(torque < 0.0, back, 0.5 + 0.01 * abs(torque)) + 0.0 * speed + 0.0 * degree


def bent(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    return 0.5 + 0.02 * abs(torque) ** 1.5 + 0.0 * speed + 0.0 * degree


def both_bent(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    on = 0.5 + 0.1 * abs(torque) ** 1.5 + 0.0 * speed + 0.0 * degree
    return np.where(torque < 0.0, steep(torque, speed, degree), on)


def tiny(torque: np.ndarray, speed: np.ndarray, degree: np.ndarray) -> np.ndarray:
    return 1e-7 * bent(torque, speed, degree)


@pytest.mark.parametrize("law", [bent, steep, both_bent, tiny])
def test_no_table_is_nearer_than_it_says(law: Lost, tmp_path: Path) -> None:
    """A loss that is no line: that of LossyGear is off by more, of least squares not by much more."""
    (_,), lost = handed(made_joint(law), tmp_path)
    (said,) = re.findall(r"No table of LossyGear is nearer than (\S+) N m", " ".join(lost))
    rows = re.findall(r"^the map .*\) +(\S+) +\S+ +\S+ % +\d+$", "\n".join(lost), re.MULTILINE)
    assert 0.0 < float(said) < max(map(float, rows)) < 4.0 * float(said)


def test_the_least_error_of_a_line_is_that_of_a_program_of_inequalities() -> None:
    random = np.random.default_rng(4)
    for count in (3, 4, 9, 30):
        x, y = np.sort(random.normal(size=count)), random.normal(size=count)
        columns = np.stack([x, np.ones(count), np.ones(count)], axis=-1)
        both = np.concatenate([-columns, columns * [1.0, 1.0, -1.0]])
        solved = linprog(
            [0.0, 0.0, 1.0], both, np.concatenate([-y, y]), bounds=[(None, None)] * 2 + [(0, None)]
        )
        assert least_line_error(x, y) == pytest.approx(solved.x[-1], rel=1e-6)


def test_a_drive_that_locks_is_said_not_to_lock_there(tmp_path: Path) -> None:
    (path,), _ = handed(made_joint(locking), tmp_path)
    text = path.read_text("utf-8")
    assert "LossyGear cannot lock" in text.replace("\n// ", " ")
    assert all(0.0 < row.eta_mf2 < 1e-5 for row in tables(text)[40.0])
