"""A drive as a package of Modelica: tables against the map, by the equations of LossyGear."""

import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from made_joints import Lost, locking, made_joint, plain, torsion
from scipy.interpolate import RegularGridInterpolator
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
        play = re.findall(r"Angle backlash = (\S+) ", code)
        assert [*map(float, play)] == [{"turns": 2e-4, "slides": 1e-2, "bare": 0.0}[name]] * 2
        assert code.count("c = stiffness, d = damping, b = backlash) if elastic;") == 2


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


class Lookup:
    """A table of the library by its matrix: linear between its points, held beyond them."""

    def __init__(self, matrix: np.ndarray) -> None:
        self._table = RegularGridInterpolator((matrix[1:, 0], matrix[0, 1:]), matrix[1:, 1:])
        self._ends = matrix[1:, 0], matrix[0, 1:]

    @property
    def y(self) -> float:
        near = [
            min(max(u, axis[0]), axis[-1])
            for u, axis in zip((self.u1, self.u2), self._ends, strict=True)  # type: ignore[attr-defined]
        ]
        return float(self._table(near)[0])


def python(code: str) -> str:
    """An expression of Modelica as one of Python; arrays have a first element that is none."""
    code = re.sub(r"\b(der|pre)\(([\w.]+)\)", r'\1["\2"]', code)
    code = re.sub(r"for k in 1:(\d+)", lambda m: f"for k in range(1, {int(m[1]) + 1})", code)
    opened, words = [], []
    for word in re.findall(r'"[^"]*"|\w+|\s+|.', code):
        if word in ("(", "[", "if"):
            opened.append(word)
        while word in (")", "]") and opened[-1] == "if":
            opened.pop()
            words.append(")")
        if word in (")", "]"):
            opened.pop()
        words.append({"if": "choice(", "then": ",", "else": ","}.get(word, word))
    return " ".join("".join([*words, ")" * opened.count("if")]).split())


def equations(text: str) -> list[tuple[str, str]]:
    """Both sides of each equation of the model of the map."""
    model = text[text.index("model MapGear") :]
    block = model[model.index("  equation\n") + 11 : model.index("    annotation(Documentation")]

    def of_each(loop: re.Match[str]) -> str:
        return "".join(loop[2].replace("[k]", f"[{k}]") for k in range(1, int(loop[1]) + 1))

    block = re.sub(r"for k in 1:(\d+) loop(.*?)end for;", of_each, block, flags=re.DOTALL)
    sides = [one.split(" = ", 1) for one in block.split(";") if one.strip()]
    return [(python(left.strip()), python(right)) for left, right in sides]


def residuals(text: str, known: dict[str, float], names: dict[str, Any]) -> dict[str, float]:
    """What equations leave whose both sides are known; others give their left side a value, in any order."""
    *moving, rest = map(Lookup, matrices(text))
    both = Lookup(matrices(text)[-1])
    held: dict[str, Any] = {
        **names, "moving": [None, *moving], "on": rest, "back": both, "share": [None] * 8,
        "flange_a": SimpleNamespace(), "flange_b": SimpleNamespace(), "log": math.log,
        "choice": lambda which, yes, no: yes if which else no, "initial": lambda: False,
    }  # fmt: skip
    for name in ("degrees", "below", "above"):
        (found,) = re.findall(rf"{name}\[7\] = \{{(.*?)\}}", text)
        held[name] = [None, *map(float, found.split(","))]
    for name in ("ratio", "travel"):
        (held[name],) = map(float, re.findall(rf"constant Real {name} = (\S+)", text))
    for name, value in known.items():
        exec(f"{name} = {value!r}", held)
    left, seen = equations(text), {}
    while left:
        waiting = []
        for first, second in left:
            try:
                value = eval(second, held)
            except (NameError, AttributeError, TypeError):
                waiting.append((first, second))
                continue
            try:
                there = eval(first, held)
            except (NameError, AttributeError):
                there = None
            if there is None:
                exec(
                    f"{first} = value", {**held, "value": value}
                ) if "." in first or "[" in first else (held.update({first: value}))
            else:
                seen[f"{first} = {second}"] = float(there) - float(value)
        assert len(waiting) < len(left), waiting
        left = waiting
    return seen


MOTIONS = [(w, load) for w in (0.3, -0.3) for load in (25.0, -25.0)]
"""Speed and torque of the output in all quadrants."""


def unbalanced(text: str, made: Outcome) -> float:
    """Largest residual of the model of the map in motions and at rest that the product knows."""
    joint, slides = joint_model(made), made.manifest["travels"] != []
    ratio, travel = (1.0, abs(joint.ratio)) if slides else (joint.ratio, 1.0)
    worst = 0.0

    def hold(pace: float, load: float, path: float, lost: float, gain: float, **names: Any) -> None:
        nonlocal worst
        # Power: what the driver gives is what the load takes and friction loses.
        driving = (load + lost) / (ratio * travel)
        known = {
            "flange_b.phi": 0.7, "flange_a.phi": 0.7 * ratio, "flange_b.tau": -load / travel,
            "flange_a.tau": driving, "temperature": 50.0, "path": path, "friction": lost, **names,
        }  # fmt: skip
        rates = {"flange_b.phi": pace * travel, "speed": gain}
        pre = {"mode": int(np.sign(pace))}
        found = residuals(text, known, {"der": rates, "pre": pre})
        assert len(found) >= 4
        worst = max(worst, *map(abs, found.values()))

    for speed, load in MOTIONS:
        way = math.copysign(1.0, speed)
        lost = float(joint.loss_torque(way * load, abs(speed), 323.15))
        band = joint.holding_band(load, 323.15)
        starts = abs(joint.ratio) * (band.highest if way > 0.0 else -band.lowest) - way * load
        hold(speed, load, way * (starts + 0.25), way * lost, 0.25 * way, mode=int(way), speed=speed)
    for load in (25.0, -25.0):
        band = joint.holding_band(load, 323.15)
        low, high = (abs(joint.ratio) * end - load for end in (band.lowest, band.highest))
        rest = {"mode": 0, "speed": 0.0, "torque": load}
        for path in (0.99 * low + 0.01 * high, 0.01 * low + 0.99 * high):
            hold(0.0, load, path, path, 0.0, **rest, forwards=False, backwards=False)
        for path, way in ((high + 0.1, 1.0), (low - 0.1, -1.0)):
            lost = way * float(joint.loss_torque(way * load, 0.01, 323.15))
            hold(0.0, load, path, lost, 0.1 * way, **rest, forwards=way > 0, backwards=way < 0)
    return worst


@pytest.mark.parametrize("slides", [False, True])
def test_the_equations_of_the_map_are_those_of_the_product(slides: bool, tmp_path: Path) -> None:
    """In four quadrants and at rest, by power; and one that is another is seen."""
    made = made_joint(slides=slides)
    (path,), _ = handed(made, tmp_path)
    text = path.read_text("utf-8")
    assert unbalanced(text, made) < 1e-7
    for before, after in (
        ("flange_a.phi = ratio", "flange_a.phi = -ratio"),
        ("torque = -flange_b.tau", "torque = flange_b.tau"),
        ("= friction / travel", "= -friction / travel"),
        ("if backwards then -torque else torque", "torque"),
        ("if backwards then -lost", "if backwards then lost"),
        ("else if backwards then path + back.y", "else if backwards then path - back.y"),
        ("path > on.y", "path > 1.1 * on.y"),
        ("path < -back.y", "path < back.y"),
        ("share[k] * moving[k].y", "moving[k].y"),
        ("(degrees[k] - warm) / below[k]", "(degrees[k] - warm) / 20"),
        ("log(max(abs(speed)", "(max(abs(speed)"),
        ("mode = if forwards and speed > 0", "mode = if forwards and speed < 0"),
        *([("der(flange_b.phi) / travel", "der(flange_b.phi) * travel")] if slides else []),
    ):
        assert text.count(before) == 1
        assert unbalanced(text.replace(before, after), made) > 1e-3, before


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
