"""Duty cycles from the command line: energies, heat and lives by the loss map."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from mapped_pair import MOVING, PAIR, command, variant

import pitchpoint as pp
from pitchpoint.analyses.analysis_registry import DUTY as DUTY_CYCLE
from pitchpoint.analyses.analysis_registry import FOUR_QUADRANTS
from pitchpoint.analyses.four_quadrants import table_of
from pitchpoint.analyses.main_figures import duty_figures
from pitchpoint.cases.built_drive import Ready
from pitchpoint.cases.document import read_tables
from pitchpoint.cases.variant import Variant
from pitchpoint.core.doubts import doubts_of, ranked_doubts
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import header, module
from pitchpoint.runs.jobs import chosen_jobs, jobs
from pitchpoint.runs.run import Outcome, write_results
from pitchpoint.views.section_registry import DUTY as DUTY_SECTION
from pitchpoint.views.sections.duty import actuator_points, operating_points


@pytest.fixture(scope="module")
def folder(moving: tuple[Ready, Outcome], tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("result")
    write_results({"default": moving[1]}, {"default": variant(PAIR + MOVING)}, made)
    return made


def test_a_duty_cycle_is_told_by_the_map(
    folder: Path,
    moving: tuple[Ready, Outcome],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    path = tmp_path / "cycle.csv"
    head = "duration [s], torque [N m], speed [rpm], temperature [degC]\n"
    path.write_text(head + "2, 20, 60, 40\n1, 20, -60, 50\n3, 10, 0, 50\n")
    assert command("duty", folder, path) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 12 and max(map(len, lines)) <= 80
    assert lines[-1].split(maxsplit=2)[:2] == ["Fails", "first"]
    assert command("duty", folder, path, "--json", "--law", "frictionless") == 0
    told = json.loads(capsys.readouterr().out)
    table = table_of(moving[1].parts[FOUR_QUADRANTS.name])
    speed = 2.0 * np.pi
    lost = [
        table.at(20.0, sign * speed, degree, "frictionless").loss
        for sign, degree in ((1, 40), (-1, 50))
    ]
    assert told["lost_energy"] == pytest.approx(2.0 * lost[0] + lost[1], rel=1e-9)
    assert told["output_energy"] == pytest.approx(2.0 * 20.0 * speed, rel=1e-12)
    assert told["returned_energy"] == pytest.approx(20.0 * speed, rel=1e-12)
    assert command("duty", "--help") == 0
    help_ = capsys.readouterr().out
    assert all(head in help_ for head in ("time [s]", "torque [N m]", "speed [rpm]"))
    assert command("duty", folder, path, "--json") == 0
    told = json.loads(capsys.readouterr().out)
    by_law = dict(zip(told["law"], told["law_lost_energy"], strict=True))
    assert by_law["frictionless"] == pytest.approx(2.0 * lost[0] + lost[1], rel=1e-9)
    assert told["quadrant"] == ["I", "II", "III", "IV", "rest"] and "time" not in told
    assert command("duty", folder, path, "--law", "xu") == 2
    assert "is not a friction law of this result" in capsys.readouterr().err
    path.write_text(head + "2, 20, 60, 400\n")
    assert command("duty", folder, path) == 2
    assert (
        "cycle.csv: temperature: 673.15 K, which are 400 degC, is no temperature"
        in capsys.readouterr().err
    )


CYCLE = "duration [s], torque [N m], speed [rpm], temperature [degC]\n"
STEPS = "2, 20, 60, 40\n1, 20, -60, 50\n3, 10, 0, 50\n"
DUTY = """
[duty]
file = "cycle.csv"
[duty.motor]
torque_constant = "0.1 N m/A"
resistance = "0.5 ohm"
[duty.lives.output]
torque = "40 N m"
revolutions = 1e6
"""


def on_duty(folder: Path, steps: str = STEPS, more: str = "", changed: str = PAIR) -> Variant:
    """The pair with a duty cycle beside its case file."""
    (folder / "cycle.csv").write_text(CYCLE + steps)
    (folder / "pair.toml").write_text(f'title = "a joint"\n{changed}{MOVING}{DUTY}{more}')
    return Variant(read_tables(folder / "pair.toml"), "pair.toml", "default")


def test_a_run_answers_with_its_duty_cycle(
    moving: tuple[Ready, Outcome], folder: Path, tmp_path: Path
) -> None:
    built = on_duty(tmp_path).built({})
    assert DUTY_CYCLE.why_not(built) is None
    part = DUTY_CYCLE.joined(built, [moving[1].parts[FOUR_QUADRANTS.name]])
    beside = pp.duty(
        pp.open_result(folder),
        tmp_path / "cycle.csv",
        motor=pp.Motor(torque_constant=0.1, resistance=0.5),
        lives={"output": pp.RatedLife(40.0, 1e6)},
        teeth=True,
    )
    xr.testing.assert_equal(part, beside)
    assert part.attrs["first_to_fail"] == beside.attrs["first_to_fail"] == "bearing output"
    told = duty_figures({DUTY_CYCLE.name: part})[DUTY_CYCLE.name]
    assert told["lost_energy"] == float(part["lost_energy"]) and told["left_out"]
    made = replace(moving[1], parts={**moving[1].parts, DUTY_CYCLE.name: part})
    facts = {fact.name: fact for fact in DUTY_SECTION.answer(made)}
    assert facts["Fails first"].value == "bearing output"
    figure = operating_points("duty", made)
    dots = figure.data[1]
    np.testing.assert_allclose(dots["x"], [60.0, -60.0, 0.0], rtol=1e-4, atol=1e-12)
    assert dots["y"] == [20.0, 20.0, 10.0] and "oil at 40" in figure.note
    for name in ("map_actuator_efficiency", "map_electrical_power"):
        drawn = actuator_points(name, 0, made)
        assert drawn.drawn and drawn.data[1]["y"] == dots["y"] and "actuator" in drawn.title
    assert any(row[""] == "Electrical energy" for row in next(iter(DUTY_SECTION.screen(made))).rows)
    (printed,) = DUTY_SECTION.screen(made)
    assert [row[""] for row in printed.rows][-1] == "Fails first"
    # The actuator is at the mean over time, of the samples it is 50 degC.
    hot = CYCLE + "5, 20, 60, 40\n1, 20, -60, 60\n"
    (tmp_path / "hot.csv").write_text(hot)
    motor = pp.Motor(torque_constant=0.1, resistance=0.5)
    cycle = pp.duty(pp.open_result(folder), tmp_path / "hot.csv", motor=motor)
    made = replace(made, parts={**made.parts, DUTY_CYCLE.name: cycle})
    assert "oil at 43.33" in actuator_points("map_electrical_power", 0, made).note


def test_a_duty_cycle_brings_the_map_that_it_reads(tmp_path: Path) -> None:
    made = on_duty(tmp_path)
    assert [job.name for job in chosen_jobs(made, {}, ["duty"])] == ["four_quadrants", "duty"]
    assert chosen_jobs(made, {}, ["duty"])[1].pieces == ()


@pytest.mark.parametrize(
    ("steps", "more", "changed", "told"),
    [
        ("2, 20, 60, nan\n", "", PAIR, '"cycle.csv": temperature: sample 1 is nan'),
        ("2, 20, 60, 400\n", "", PAIR, '"cycle.csv": temperature: 673.15 K'),
        ("2, 900, 60, 40\n", "", PAIR, "1 of 1 samples lie beyond the loss map"),
        (
            STEPS,
            "",
            PAIR.replace("quadrants = 4", ""),
            r"duty: asks for the loss map .* quadrants = 4",
        ),
        (
            STEPS,
            '[duty.heat]\ngears = "a"\nbodies.b.heat_capacity = "1 J/K"\n'
            'resistances.c = { between = ["b", "ambient"], resistance = "1 K/W" }\n',
            PAIR,
            "duty.heat.gears: the network has no body 'a', but b",
        ),
        (
            STEPS,
            '[duty.heat]\ngears = "b"\nbodies.b.heat_capacity = "1 J/K"\n'
            'resistances.c = { between = ["a", "ambient"], resistance = "1 K/W" }\n',
            PAIR,
            "duty.heat.resistances: a resistance is between two of b, ambient",
        ),
    ],
)
def test_a_duty_cycle_that_cannot_be_is_told_before_its_map(
    tmp_path: Path, steps: str, more: str, changed: str, told: str
) -> None:
    with pytest.raises(InputError, match=told):
        jobs(on_duty(tmp_path, steps, more, changed), {})


HEAT = """
[duty.heat]
gears = "gears"
bodies.gears = { heat_capacity = "100 J/K", largest_temperature = "45 degC" }
resistances.arm = { between = ["gears", "ambient"], resistance = "%s" }
"""


def heated(
    moving: tuple[Ready, Outcome],
    folder: Path,
    resistance: str,
    ambient: str,
    steps: str = STEPS,
) -> xr.Dataset:
    """The duty cycle of the pair with a resistance to its surroundings."""
    more = (HEAT % resistance).replace("bodies", f'ambient = "{ambient}"\nbodies')
    built = on_duty(folder, steps, more).built({})
    return DUTY_CYCLE.joined(built, [moving[1].parts[FOUR_QUADRANTS.name]])


def test_heat_that_runs_away_or_is_too_much_is_told_first(
    moving: tuple[Ready, Outcome], tmp_path: Path
) -> None:
    away = heated(moving, tmp_path, "1e6 K/W", "45 degC")
    (sentence,) = ranked_doubts(doubts_of(away.attrs))["implausible"]
    assert "there is no steady temperature" in sentence and "first at gears" in sentence
    assert away.attrs["first_to_fail"] == "heat of gears" and float(away["shortest_life"]) == 0.0
    assert "body_temperature" not in away and float(away["lost_energy"]) > 0.0
    hot = heated(moving, tmp_path, "0.01 K/W", "46 degC")
    (sentence,) = ranked_doubts(doubts_of(hot.attrs))["implausible"]
    hottest = float(hot["body_temperature"].max()) - 273.15
    assert f"gears gets {hottest:.4g} degC" in sentence and "bears 45 degC" in sentence
    cool = heated(moving, tmp_path, "0.01 K/W", "42 degC")
    assert not ranked_doubts(doubts_of(cool.attrs))["implausible"]


@pytest.mark.parametrize(
    ("resistance", "ambient", "steps", "first", "edge"),
    [
        (
            "1e6 K/W",
            "45 degC",
            "2, 20, 60, 30\n",
            "no steady temperature",
            "at 30 degC is taken at 40",
        ),
        ("0.01 K/W", "74 degC", STEPS, "gears gets 76", "at 76.* degC is taken at 60"),
        ("0.01 K/W", "20 degC", STEPS, "", "at 21.* degC is taken at 40"),
    ],
)
def test_oil_beyond_the_map_does_not_end_the_run(
    moving: tuple[Ready, Outcome],
    tmp_path: Path,
    resistance: str,
    ambient: str,
    steps: str,
    first: str,
    edge: str,
) -> None:
    part = heated(moving, tmp_path, resistance, ambient, steps)
    *hot, at_edge = doubts_of(part.attrs)
    assert len(hot) == bool(first) and all(first in sentence for sentence in hot)
    assert re.search(edge, at_edge) and float(part["lost_energy"]) > 0.0


def test_a_law_of_a_duty_cycle_is_one_of_the_case(tmp_path: Path) -> None:
    made = on_duty(tmp_path)
    settings = {"duty.law": "xu_2006"}
    changed = Variant(read_tables(tmp_path / "pair.toml"), "pair.toml", "default", settings)
    with pytest.raises(InputError, match=r'duty.law: "xu_2006" is no .*did you mean xu_2007'):
        jobs(changed, {})
    assert len(jobs(made, {})) > 0


def test_files_of_the_map_say_what_is_doubtful_of_it(moving: tuple[Ready, Outcome]) -> None:
    _, made = moving
    doubtful = replace(made, manifest={**made.manifest, "warnings": ["The film */ is thin."]})
    table = table_of(made.parts[FOUR_QUADRANTS.name])
    for text in (header(doubtful, table), module(doubtful, table)):
        assert "Doubtful: The film _/ is thin." in text
        assert "Doubtful" not in text.replace("Doubtful: The film _/ is thin.", "")
