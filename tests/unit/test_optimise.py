"""An optimiser of cases: against closed forms, a grid, and runs of the case file that it writes."""

import csv
import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import bank
import numpy as np
import pytest

import pitchpoint as pp
from pitchpoint import cli
from pitchpoint.analyses.design_batch import CaseDesigns
from pitchpoint.errors import ConvergenceError, InputError
from pitchpoint.runs import optimise as optimising
from pitchpoint.runs.check import check_case
from pitchpoint.runs.optimum_search import ConstrainedSearch
from pitchpoint.runs.optimum_task import OptimiserTask, optimiser_task
from pitchpoint.runs.run import Progress
from pitchpoint.runs.sought_figures import NO_FIGURES, SoughtFigure, value_in
from pitchpoint.views.optimum_screen import optimum_screen

SHIFT, MATE, WIDTH = "gears.profile_shift.1", "gears.profile_shift.2", "gears.face_width"
FACTORS = {"dynamic_factor": 1.0, "face_load_factor": 1.0, "transverse_load_factor": 1.0}
STEEL = {"gear_1": "case-hardened-mq", "gear_2": "case-hardened-mq"}
PAIR = pp.Case(
    title="Twins",
    gears={
        "teeth": [24, 24],
        "module": "2 mm",
        "face_width": "20 mm",
        "centre_distance": "48.5 mm",
        "profile_shift": [0.0, "from centre distance"],
    },
    materials=STEEL,
    strength={"life": "5000 h", **FACTORS},
    lubricant={"name": "pao-vg-150"},
    roughness={"ra": "0.4 um"},
    operation={"torque": "40 N m", "speed": "1200 rpm", "temperature": "50 degC"},
    models={"friction": {"name": "constant", "coefficient": 5e-4}},
)
"""Equal gears: but for terms of the second order in so little friction the loss is the same with both shifts
exchanged, and least where they are alike."""


def total_shift() -> float:
    first, second = PAIR["gears.profile_shift"]
    return float(first + second)


@pytest.fixture(scope="module")
def least_loss() -> pp.Optimum:
    return pp.optimise(PAIR, {SHIFT: "-0.2:0.6"}, minimise="mean_loss")


def test_equal_gears_lose_least_with_equal_shifts(least_loss: pp.Optimum) -> None:
    assert least_loss.best[SHIFT] == pytest.approx(total_shift() / 2.0, abs=2e-4)
    assert least_loss.derived == ("mean_loss",)
    both = least_loss.case["gears.profile_shift"]
    assert both[0] == pytest.approx(both[1], abs=4e-4)  # the centre distance is kept
    assert least_loss.value < least_loss.start["mean_loss"]
    ran = pp.run(least_loss.case, analyses=["operation"])["operation"]
    assert float(ran["mean_loss"].squeeze()) == pytest.approx(least_loss.value, rel=1e-12)


def test_an_active_limit_is_met_and_costs_what_the_closed_form_says(tmp_path: Any) -> None:
    """With load factors of 1 the flank's safety goes with the root of the width, and the mass with it."""
    found = pp.optimise(
        PAIR,
        {WIDTH: "8 mm:40 mm"},
        minimise="disc_mass.1",
        subject_to="flank_safety >= 1.3",
        starts=4,
        folder=tmp_path,
    )
    start, best = found.start, found.best
    (limit,) = found.limits
    width = start[WIDTH] * (1.3 / start["flank_safety"]) ** 2
    assert best[WIDTH] == pytest.approx(width, rel=1e-5)
    assert found.active(limit) and 1.3 <= best["flank_safety"] < 1.3 * (1.0 + 2e-6)
    assert found.value == pytest.approx(start["disc_mass.1"] * width / start[WIDTH], rel=1e-5)
    assert found.multipliers is not None
    np.testing.assert_allclose(found.multipliers.constraints, [2.0 * found.value], rtol=1e-4)
    ran = pp.run(tmp_path / "case.toml", analyses=["strength"])["strength"]
    assert float(ran["flank_safety"].min()) == best["flank_safety"]
    rows = [*csv.DictReader((tmp_path / "designs.csv").read_text().splitlines())]
    assert len(rows) == found.designs and next(iter(rows[0])) == WIDTH
    with pytest.raises(InputError, match="is there already"):
        pp.optimise(PAIR, {WIDTH: "8 mm:40 mm"}, minimise="mean_loss", folder=tmp_path)


def test_a_largest_aim_under_an_upper_limit() -> None:
    """The same the other way round: the safety goes with the root of the mass."""
    found = pp.optimise(
        PAIR,
        {WIDTH: "8 mm:40 mm"},
        maximise="flank_safety",
        subject_to="disc_mass.1 <= 0.2 kg",
        starts=4,
    )
    start, mass = found.start["flank_safety"], found.start["disc_mass.1"]
    assert 0.2 * (1.0 - 2e-6) < found.best["disc_mass.1"] <= 0.2
    assert found.value == pytest.approx(start * (0.2 / mass) ** 0.5, rel=1e-5)
    assert found.multipliers is not None
    np.testing.assert_allclose(found.multipliers.constraints, [found.value / 2.0], rtol=1e-4)


@pytest.mark.whole
def test_two_keys_against_a_grid() -> None:
    """Both shifts of equal gears: the loss falls until the contact ratio holds it, where both are alike."""
    free = free_pair()
    keys = {key: np.linspace(-0.1, 0.6, 25).tolist() for key in (SHIFT, MATE)}
    found = pp.optimise(
        free,
        dict.fromkeys(keys, (-0.1, 0.6)),
        minimise="mean_loss",
        subject_to="contact_ratio >= 1.5",
    )
    grid = pp.study(free, keys)
    kept = grid["contact_ratio"].values[0] >= 1.5
    least = grid["mean_loss"].values[0][kept].min()
    assert 0.98 * least < found.value <= least
    assert found.active(found.limits[0]) and found.best["contact_ratio"] >= 1.5
    assert found.best[SHIFT] == pytest.approx(found.best[MATE], abs=0.007)


def free_pair() -> pp.Case:
    """The same gears at the centre distance that follows from both shifts."""
    tables = PAIR.tables
    gears = {key: value for key, value in tables["gears"].items() if key != "centre_distance"}
    return pp.Case({**tables, "gears": {**gears, "profile_shift": [0.1, 0.3]}})


def test_automatic_derivatives_are_those_of_differences() -> None:
    lossy = PAIR.set(
        {"losses": {"seal": {"between": ["gear 1", "housing"], "seal_torque": "0.1 N m"}}}
    )
    for case in (PAIR, lossy):
        one = pp.Case(case, variant="default")
        stated = {"vary": {SHIFT: "0:0.5", WIDTH: "10 mm:30 mm"}, "minimise": "mean_loss"}
        with pp.double_precision():
            task = optimiser_task(one, one.held[0], stated, None, None, None)
            search, point = task.search({}), np.array([0.8, 0.3])
            automatic = search.slopes(point)
            search.derive = lambda _: np.full((1, 2), np.nan)
            np.testing.assert_allclose(automatic, search.slopes(point), rtol=1e-5, atol=1e-9)


@pytest.mark.whole
def test_lists_are_tried_with_each_other_and_with_ranges() -> None:
    modules = ["1.95 mm", "2 mm"]
    found = pp.optimise(
        PAIR, {"gears.module": {"values": modules}, SHIFT: "0:0.5"}, minimise="mean_loss", starts=6
    )
    alone = [
        pp.optimise(
            PAIR.set({"gears.module": module}), {SHIFT: "0:0.5"}, minimise="mean_loss", starts=3
        )
        for module in modules
    ]
    assert found.value == pytest.approx(min(one.value for one in alone), rel=1e-6)
    assert found.listed == {"gears.module": modules}


@pytest.mark.whole
def test_an_equality_of_a_result(least_loss: pp.Optimum) -> None:
    """Shifts that vary without a given centre distance, kept by a limit: the optimum is the same."""
    found = pp.optimise(
        free_pair(),
        {SHIFT: "-0.2:0.6", MATE: (-0.2, 0.6)},
        minimise="mean_loss",
        subject_to=["centre_distance = 48.5 mm"],
    )
    assert found.best["centre_distance"] == pytest.approx(48.5e-3, rel=1e-6)
    assert found.value == pytest.approx(least_loss.value, rel=1e-4)


def test_a_task_without_a_solution_says_which_limit_and_by_how_much() -> None:
    with pytest.raises(InputError) as caught:
        pp.optimise(
            PAIR,
            {WIDTH: "8 mm:40 mm"},
            minimise="mean_loss",
            subject_to="flank_safety >= 9",
            starts=4,
        )
    start = pp.optimise(PAIR, {WIDTH: ["40 mm"]}, minimise="flank_safety")
    told = str(caught.value)
    assert (
        "keeps all limits; the nearest, gears.face_width = 40 mm, misses flank_safety >= 9 by"
        in told
    )
    assert f"{start.value:.4g}"[:5] in told
    assert f"by {100.0 * (9.0 - start.value) / 9.0:.3g} %" in told


@pytest.mark.parametrize(
    ("vary", "given", "words"),
    [
        ({}, {}, "vary: names no key"),
        ({SHIFT: "0.6:0"}, {}, f'{SHIFT}: from 0.6 to 0 is no range; write "0:0.6"'),
        ({SHIFT: "0.1:0.1"}, {}, "is no range; give two ends"),
        ({SHIFT: "0:nan"}, {}, '"nan" does not start with a plain finite number'),
        ({SHIFT: (0.0, float("nan"))}, {}, "nan"),
        ({SHIFT: [0.0, 0.5]}, {}, "may be two ends or two values; write"),
        ({SHIFT: "0:9"}, {}, '"9" is out of range; allowed is -2 to 3'),
        ({SHIFT: 0.3}, {}, "0.3 is neither two ends"),
        ({SHIFT: {"start": 0.0}}, {}, "has neither start and stop nor values alone"),
        ({WIDTH: "1:2"}, {}, '"1" has no unit where a length is needed'),
        ({WIDTH: "1 kg:2 kg"}, {}, "kg"),
        ({"gears.teeth.1": "20:24"}, {}, "is a count, of which values are tried one by one"),
        ({"gears.teeth.1": [20.5]}, {}, "20.5 is not a whole number"),
        ({"gears.teeth": [20, 22]}, {}, "none of 2 designs has figures; 1 of them: gears.prof"),
        ({"gears.tooth.1": "0:1"}, {}, "gears.tooth.1: there is no such key"),
        ({"targets": ["a"]}, {}, "cannot be studied"),
        ({"lubricant.name": "a:b"}, {}, "has no numbers between"),
        ({"gears.teeth.1": [*range(17, 57)], "gears.teeth.2": [*range(17, 57)]}, {}, "1600 combinations"),
        ({SHIFT: "0:0.5"}, {"minimise": "mean_los"}, '"mean_los" is no result; did you mean mean_loss'),
        ({SHIFT: "0:0.5"}, {"minimise": "weight of it"}, "is no result; results are those of a study"),
        ({SHIFT: "0:0.5"}, {"minimise": "residual"}, '"residual" is no result; '),
        ({SHIFT: "0:0.5"}, {"minimise": "disc_mass"}, "has 2 values at each design; name one: disc_mass.1"),
        ({SHIFT: "0:0.5"}, {"minimise": "disc_mass.3"}, 'disc_mass has no value "3"; it has 1, 2'),
        ({SHIFT: "0:0.5"}, {"minimise": "inspection.mean_loss"}, 'inspection has no result "mean_loss"'),
        ({SHIFT: "0:0.5"}, {"minimise": "output_backlash"}, "is no result of this case: backlash, masses"),
        ({SHIFT: "0:0.5"}, {"maximise": "mean_loss"}, "minimise: give one result"),
        ({SHIFT: "0:0.5"}, {"subject_to": "rubbish"}, 'subject_to: "rubbish" is no limit'),
        ({SHIFT: "0:0.5"}, {"subject_to": "contact_ratio >= nan"}, "finite number"),
        ({SHIFT: "0:0.5"}, {"subject_to": "centre_distance = 48"}, '"48" has no unit'),
        ({SHIFT: "0:0.5"}, {"subject_to": "safety >= 2"}, "subject_to safety >= 2: "),
        ({SHIFT: "0:0.5"}, {"law": "magic"}, 'law: "magic" is no friction law of the case'),
        ({SHIFT: "0:0.5"}, {"starts": 0}, "starts: 0 is out of range"),
        ({SHIFT: "0:0.5"}, {"starts": "4"}, 'starts: "4" was given where a whole number'),
        ({SHIFT: "0:0.5"}, {"subject_to": 5}, "subject_to: 5 was given where a limit"),
        ({SHIFT: "0:0.5"}, {"law": 3}, "law: 3 was given where the name of a friction law"),
        ({SHIFT: "0:0.5"}, {"minimise": 3}, "minimise: 3 was given where the name of a result"),
        (SHIFT, {}, f'vary: "{SHIFT}" was given where a dictionary'),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_in_a_sentence(vary: Any, given: Any, words: str) -> None:
    with pytest.raises(InputError) as caught:
        pp.optimise(PAIR, vary, **{"minimise": "mean_loss", **given})
    assert words in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.whole
def test_a_key_of_gears_that_stand_for_several_meshes_has_its_value_as_given() -> None:
    shared = {key: PAIR.tables[key] for key in ("lubricant", "roughness", "operation", "models")}
    gears = {"family": "planetary", "teeth": [24, 30, 84], "planets": 3, "module": "1 mm"}
    planets = pp.Case({"gears": {**gears, "face_width": "12 mm"}, **shared})
    found = pp.optimise(planets, {WIDTH: ["10 mm", "12 mm", "14 mm"]}, minimise="drive_mass")
    assert found.start[WIDTH] == pytest.approx(0.012) and found.best[WIDTH] == pytest.approx(0.01)
    assert found.value == pytest.approx(found.start["drive_mass"] * 10 / 12, rel=1e-9)


def test_an_aim_without_a_figure_says_so() -> None:
    plain = PAIR.set({"materials.gear_1": "steel", "materials.gear_2": "steel"})
    with pytest.raises(InputError, match="flank_safety is not a number in any of 1 designs"):
        pp.optimise(plain, {"materials.gear_1": ["steel"]}, minimise="flank_safety")


def test_a_safety_that_no_design_can_have_is_refused_before_the_search(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plain = PAIR.set({"materials.gear_1": "steel", "materials.gear_2": "steel"})
    monkeypatch.setattr(OptimiserTask, "values", lambda *_: pytest.fail("a design was computed"))
    aims = {"maximise": "root_safety"}, {"minimise": "mean_loss", "subject_to": "flank_safety >= 1"}
    for aim in aims:
        with pytest.raises(InputError, match=r"safety is not known: no safety of gear 1 against "):
            pp.optimise(plain, {SHIFT: [0.1]}, **aim)
    with pytest.raises(InputError, match=r"itself: no safety of gear 1 against pitting"):
        pp.gradients(plain, of="least_flank_safety", by=SHIFT)


def test_a_folder_without_a_case_file_is_shown_without_it(tmp_path: Any) -> None:
    folder = tmp_path / "my results"
    named = {"minimise": "mean_loss", "folder": folder, "overwrite": True}
    lines = [line.text for line in optimum_screen(pp.optimise(PAIR, {SHIFT: [0.1]}, **named), 300)]
    assert f"Case: pitchpoint run '{folder / 'case.toml'}'" in lines

    def law(sliding: Any) -> Any:
        return 5e-4 + 0.0 * sliding

    found = pp.optimise(PAIR, {SHIFT: [0.1]}, friction=law, **named)
    lines = [line.text for line in optimum_screen(found, 300)]
    assert not any(line.startswith("Case:") for line in lines)
    assert [path.name for path in folder.iterdir()] == ["designs.csv"]


def test_nothing_is_returned_that_a_run_does_not_say(monkeypatch: pytest.MonkeyPatch) -> None:
    def other(*given: Any) -> float:
        return 1.001 * value_in(*given)

    value_in = optimising.value_in
    monkeypatch.setattr(optimising, "value_in", other)
    with pytest.raises(ConvergenceError, match="nothing is returned"):
        pp.optimise(PAIR, {SHIFT: [0.1]}, minimise="mean_loss")


def test_designs_that_are_refused_are_counted_with_their_sentence() -> None:
    found = pp.optimise(PAIR, {SHIFT: {"values": [0.1, 2.9]}}, minimise="mean_loss")
    assert (found.designs, found.refused) == (2, 1)
    assert found.best[SHIFT] == 0.1 and all("gears" in why for why in found.reasons)


def run_command(monkeypatch: pytest.MonkeyPatch, *given: str) -> int:
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *given])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return int(ended.value.code or 0)


def test_a_table_of_a_case_is_the_same_task(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, capsys: Any
) -> None:
    table = {"vary": {SHIFT: "-0.2:0.6"}, "minimise": "mean_loss", "starts": 4, "folder": "best"}
    path = tmp_path / "pair.toml"
    PAIR.set({"optimise": table}).to_toml(path)
    assert not check_case(str(path))
    monkeypatch.setenv("COLUMNS", "80")
    assert run_command(monkeypatch, "optimise", str(path)) == 0
    screen = capsys.readouterr().out.splitlines()
    assert len(screen) <= 20 and all(len(line) <= 80 or "/" in line for line in screen)
    assert screen[0].startswith("Least mean power loss: ")
    first = (tmp_path / "best" / "case.toml").read_text()
    assert "[optimise]" not in first
    given = ("optimise", str(path), "--overwrite", "--json", "--subject", "contact_ratio>=1.5")
    assert run_command(monkeypatch, *given) == 0
    plain = json.loads(capsys.readouterr().out)
    assert plain["limits"][0]["bound"] == 1.5 and plain["best"]["contact_ratio"] >= 1.5
    wrong = PAIR.set({"optimise": {**table, "minimise": "mean_los"}})
    wrong.to_toml(path)
    with pytest.raises(InputError, match="did you mean mean_loss"):
        check_case(str(path))
    for change in ({"minimise": ""}, {"vary": {}}, {"maximise": "mean_loss"}):
        with pytest.raises(InputError, match=r"an optimiser needs|one result is the aim"):
            pp.optimise(PAIR.set({"optimise": {**table, **change}}))


def test_the_best_so_far_is_written_where_it_is_ended_by_hand(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Any, capsys: Any
) -> None:
    PAIR.to_toml(tmp_path / "pair.toml")

    def stop(search: ConstrainedSearch, start: np.ndarray) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(ConstrainedSearch, "improve", stop)
    given = ["optimise", str(tmp_path / "pair.toml"), "--vary", f"{SHIFT}=-0.2:0.6"]
    given += ["--minimise", "mean_loss", "--starts", "4", "-o", str(tmp_path / "o")]
    assert run_command(monkeypatch, *given) == 130
    assert "ended by hand: this is the best design so far" in capsys.readouterr().out
    rows = [*csv.DictReader((tmp_path / "o" / "designs.csv").read_text().splitlines())]
    assert len(rows) == 5
    least = min(float(row["mean_loss [SI]"]) for row in rows)
    ran = pp.run(tmp_path / "o" / "case.toml", analyses=["operation"])["operation"]
    assert float(ran["mean_loss"].squeeze()) == pytest.approx(least, rel=1e-9)
    monkeypatch.setattr(OptimiserTask, "values", lambda *_: stop(*_))
    given[-1] = str(tmp_path / "nothing")
    assert run_command(monkeypatch, *given) == 130


@pytest.mark.parametrize("ends", ["by hand", "without a design"])
def test_earlier_results_stand_until_a_search_has_a_design(tmp_path: Any, ends: str) -> None:
    earlier = {"case.toml": "of before", "designs.csv": "of before too"}
    for name, text in earlier.items():
        (tmp_path / name).write_text(text)

    class Stopped(Progress):
        def part(self, *_: Any) -> None:
            if ends == "by hand":
                raise KeyboardInterrupt

    vary = {WIDTH: {"values": ["20 mm", "21 mm"]}}
    named = {"minimise": "mean_loss", "folder": tmp_path, "overwrite": True, "progress": Stopped()}
    with pytest.raises((KeyboardInterrupt, InputError)):
        pp.optimise(PAIR, vary, subject_to="flank_safety >= 9", **named)
    assert {name: (tmp_path / name).read_text() for name in earlier} == earlier
    if ends != "by hand":
        assert len((tmp_path / "designs.new.csv").read_text().splitlines()) == 3
        pp.optimise(PAIR, vary, **named)
        assert {path.name for path in tmp_path.iterdir()} == {*earlier}
        assert len((tmp_path / "designs.csv").read_text().splitlines()) == 3
        assert pp.Case(tmp_path / "case.toml")["title"] == "Twins, least mean power loss"


def test_a_design_does_not_take_the_place_of_its_case(tmp_path: Any) -> None:
    path = tmp_path / "case.toml"
    text = PAIR.to_toml(path)
    with pytest.raises(InputError, match="is the case that is varied; name another folder"):
        pp.optimise(path, {SHIFT: [0.1]}, minimise="mean_loss", folder=tmp_path, overwrite=True)
    assert path.read_text() == text


@pytest.mark.whole
def test_every_figure_of_a_study_is_a_number_in_a_run_of_the_parts_that_are_asked_for() -> None:
    path = Path(__file__).parents[2] / "examples" / "two_stage.toml"
    (outcome,) = bank.outcomes(path).values()
    (base,) = pp.Case(path).held
    with pp.double_precision():
        study, built = CaseDesigns(base.computed, [{}]).compute(), base.built({})
    law = str(study["law"].values[0])
    plain = [
        str(name)
        for name in study
        if study[name].dims == ("law", "point") and name not in NO_FIGURES
    ]
    figures = [
        SoughtFigure.named(name, study, built) for name in plain if study[name].dtype.kind == "f"
    ]
    assert {"output_backlash", "mean_loss", "largest_root_stress"} <= {one.name for one in figures}
    for figure in figures:
        asked = {"operation", "strength", figure.part_of_run} & {*outcome.parts}
        ran = replace(outcome, parts={name: outcome.parts[name] for name in asked})
        of_study = float(study[figure.name].sel(law=law).squeeze())
        expected = pytest.approx(of_study, rel=1e-9, abs=1e-12, nan_ok=True)
        assert value_in(ran, figure, law) == expected, figure.name
