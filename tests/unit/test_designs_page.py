"""The page of a study: what it says of all designs, those that it draws, fronts, and what stays out of it."""

import html
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sound
import xarray as xr
from many_designs import KEYS, RANGES, quick_study
from pages import unpacked

import pitchpoint as pp
from pitchpoint import cli
from pitchpoint.runs.run import run_case
from pitchpoint.sizing.front import non_dominated
from pitchpoint.views import study_report
from pitchpoint.views.study_report import render_study, spread_evenly


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    with pytest.MonkeyPatch.context() as patch:
        return quick_study(patch, n=1024)


@pytest.fixture(scope="module")
def page(study: xr.Dataset) -> str:
    return render_study(study, case_file=Path("many/case.toml"))


def content_of(page: str) -> dict[str, Any]:
    return dict(unpacked(page, "content"))


def columns_of(page: str) -> dict[str, list[list[Any]]]:
    return {column["name"]: column["values"] for column in content_of(page)["columns"]}


def cells(page: str, caption: str) -> list[list[str]]:
    """Rows of a table of a page, as text."""
    table = re.search(rf"<caption[^>]*>{caption}.*?</table>", page, re.DOTALL)
    assert table is not None, caption
    rows = re.findall(r"<tr>(.*?)</tr>", table.group().partition("<tbody>")[2], re.DOTALL)
    found = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL) for row in rows]
    return [
        [html.unescape(re.sub("<[^>]+>", "", cell)).replace("\u00a0", " ") for cell in row]
        for row in found
    ]


def test_designs_without_figures_are_counted_and_not_drawn(study: xr.Dataset, page: str) -> None:
    there = np.isfinite(study["mean_loss"].values[0])
    assert 0 < there.sum() < 1024
    ((count, why),) = cells(page, f"{1024 - there.sum()} designs without figures")
    assert (int(count), why) == (1024 - there.sum(), 'the <wide> gear & its "mate" meet')
    content = content_of(page)
    assert content["labels"] == np.flatnonzero(there).tolist()
    assert f"1024 designs over 3 keys, {there.sum()} of them with figures" in page


def test_values_are_those_of_the_study(study: xr.Dataset, page: str) -> None:
    values, labels = columns_of(page), content_of(page)["labels"]
    for name in KEYS:  # with all digits: a case is run with them
        np.testing.assert_allclose(values[name][0], study[name].values[labels], rtol=1e-14)
    for name in ("mean_loss", "largest_root_stress"):
        for law, row in enumerate(values[name]):
            np.testing.assert_allclose(row, study[name].values[law][labels], rtol=1e-5)
    assert len(values["mean_loss"]) == 2
    assert len(values["largest_root_stress"]) == 1  # the same under every law
    assert "centre_distance" not in values  # it does not vary


def test_the_best_are_those_of_all_designs(study: xr.Dataset, page: str) -> None:
    rows = {(row[0], row[1]): row for row in cells(page, "The best design by each figure")}
    for law, name in enumerate(study["law"].values):
        losses = study["mean_loss"].values[law]
        row = rows["mean power loss [W]", str(name)]
        assert row[2] == "lowest" and int(row[4]) == np.nanargmin(losses)
        assert float(row[3]) == pytest.approx(np.nanmin(losses), rel=1e-4)
    film = rows["smallest film over composite Rq", "all"]
    assert film[2] == "highest"
    assert int(film[4]) == np.nanargmax(study["min_lambda_ratio"].values[0])


def test_names_are_escaped(study: xr.Dataset) -> None:
    page = render_study(study.assign_attrs(case="<b>pair</b>.toml"))
    assert "<b>pair</b>" not in page and "&lt;b&gt;pair&lt;/b&gt;" in page
    assert "<wide>" not in page
    assert not re.findall(r"(?:src|href|url)[=(]\W*https?:", page)


@pytest.mark.parametrize("how", ["sobol", "grid"])
def test_of_many_designs_some_are_drawn_with_the_fronts_of_all(
    how: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also read by blocks; fronts against every design with every other."""
    monkeypatch.setattr(study_report, "MOST_DRAWN", 40)
    monkeypatch.setattr(study_report, "TOGETHER_READ", 100)
    given: dict[str, Any] = {"n": 256}
    if how == "grid":
        steps = {"start": "500 rpm", "stop": "3000 rpm", "count": 6}
        over = {KEYS[0]: [20.0, 40.0, 60.0, 80.0], KEYS[1]: steps, KEYS[2]: [0.01, 0.02, 0.03]}
        given = {"over": over}
    study = quick_study(monkeypatch, how, **given)
    page = render_study(study)
    values, labels = columns_of(page), content_of(page)["labels"]
    there = np.isfinite(study["mean_loss"].values[0]).ravel()
    assert there[labels].all() and 40 <= len(labels) < min(there.sum(), 120)
    assert f"{len(labels)} of {there.sum()} designs with figures are drawn" in page
    costs = np.stack(
        [study["mean_loss"].values[1].ravel(), -study["min_lambda_ratio"].values[1].ravel()]
    )
    worse, bad = costs[:, :, None] > costs[:, None], costs[:, :, None] >= costs[:, None]
    beaten = worse.any(axis=0) & bad.all(axis=0)
    front = np.flatnonzero(there & ~beaten.any(axis=1))
    assert len(front) > 3 and {*front.tolist()} <= {*labels}
    order = {number: place for place, number in enumerate(labels)}
    for number in front.tolist():
        assert values["mean_loss"][1][order[number]] == pytest.approx(costs[0][number], rel=1e-5)


def test_long_fronts_are_thinned_and_keep_their_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """Over the speed alone loss and film are at odds: every design is on their front."""
    speeds = {"start": "500 rpm", "stop": "3000 rpm", "count": 12_000}
    study = quick_study(
        monkeypatch, "grid", over={KEYS[0]: [50.0], KEYS[1]: speeds, KEYS[2]: [0.02]}
    )
    page = render_study(study)
    labels = content_of(page)["labels"]
    assert 5000 <= len(labels) <= 5000 + 300 * 2 * 3 and {0, 11_999} <= {*labels}
    assert "Of a front with more than 300 designs, 300 are drawn, evenly from end to end" in page
    monkeypatch.setattr(study_report, "MOST_NUMBERS", 10_000)
    columns = content_of(render_study(study))["columns"]
    assert sum(np.size(column["values"]) for column in columns) <= 10_000


def test_a_choice_meets_every_value_of_a_grid() -> None:
    """A grid of 100 by 100 by 100 in even steps of 200 would meet two values of its last key."""
    taken = spread_evenly(1_000_000, 5000)
    assert len(taken) == 5000
    for place in np.unravel_index(taken, (100, 100, 100)):
        counts = np.bincount(place, minlength=100)
        assert counts.min() >= 25 and counts.max() <= 100


def test_two_aims_have_the_front_of_the_sorting_of_several() -> None:
    costs = np.random.default_rng(3).integers(0, 30, (2000, 2)).astype(float)
    general = non_dominated(np.column_stack([costs, np.zeros(len(costs))]))
    assert np.array_equal(non_dominated(costs), general)
    assert non_dominated(np.zeros((0, 2))).tolist() == []


def test_indices_stand_where_designs_are_those_of_saltelli(monkeypatch: pytest.MonkeyPatch) -> None:
    over = {**RANGES, KEYS[2]: ("9 mm", "26 mm")}  # all have figures
    study = quick_study(monkeypatch, "saltelli", over=over, n=64)
    rows = {
        row[0]: row[-1] for row in cells(render_study(study), "largest root stress of the teeth<")
    }
    indices = {key: float(words.split()[0].replace("−", "-")) for key, words in rows.items()}
    assert indices[f"{KEYS[1]}, with others"] == 0.0
    both = indices[f"{KEYS[0]}, alone"] + indices[f"{KEYS[2]}, alone"]
    assert 0.7 < both < 1.2


def test_ranks_stand_elsewhere_and_none_where_keys_go_together(
    monkeypatch: pytest.MonkeyPatch, page: str
) -> None:
    rows = {row[0]: row[-1] for row in cells(page, "largest root stress of the teeth<")}
    assert float(rows[KEYS[0]]) > 0.5 and float(rows[KEYS[2]].replace("−", "-")) < -0.4
    ends = ((20.0, 90.0), (50.0, 300.0), (0.01, 0.02))
    over = {key: np.linspace(*pair, 12).tolist() for key, pair in zip(KEYS, ends, strict=True)}
    together = render_study(quick_study(monkeypatch, "zip", over=over))
    assert "no figure can be put down to one of them" in together


def test_a_law_under_which_a_figure_does_not_vary_is_no_answer(study: xr.Dataset) -> None:
    """As of a drive without friction, whose efficiency is that of every design."""
    level = study.copy(deep=True)
    for name in ("mean_efficiency", "mean_loss"):
        there = np.isfinite(level[name].values[0])
        level[name].values[0] = np.where(there, 0.0, np.nan)
    page = render_study(level)
    best = int(np.nanargmax(study["mean_efficiency"].values[1]))
    assert re.search(rf"highest mean efficiency by xu_2007 is [\d.]+ %, of design {best}\.", page)
    rows = cells(page, "The best design by each figure")
    assert [row[1] for row in rows if row[0].startswith("mean efficiency")] == ["xu_2007"]


@pytest.mark.parametrize("count", [1, 2])
def test_a_design_or_two_have_a_page(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    over = {KEYS[0]: [50.0, 60.0][:count], KEYS[1]: [100.0], KEYS[2]: [0.02]}
    page = render_study(quick_study(monkeypatch, "grid", over=over))
    words = "1 design" if count == 1 else "2 designs"
    assert f"{words} over 3 keys, {count} of them with figures" in page
    assert content_of(page)["labels"] == [*range(count)]
    assert content_of(page)["effects"] == []


def test_a_folder_with_a_space_is_quoted(study: xr.Dataset) -> None:
    opening = content_of(render_study(study, case_file=Path("my drives/case.toml")))["opening"]
    assert opening["command"] == "pitchpoint run 'my drives/case.toml'"


def test_a_page_of_python_says_what_to_set(study: xr.Dataset) -> None:
    assert content_of(render_study(study))["opening"]["call"] == "case.set"


@pytest.mark.whole
@pytest.mark.parametrize(
    "drawn", [("--over", "torque=20 N m:45 N m", "--how", "sobol"), ("--tolerances", "normal")]
)
def test_a_design_of_the_page_is_the_case_beside_it_with_its_inputs_set(
    drawn: tuple[str, ...], tmp_path: Path
) -> None:
    """What the command of the page computes, of a study with settings: figures are those drawn."""
    limits = {"thickness_field": ["cd25", "d26"], "centre_distance_field": "js7"}
    pair = pp.Case(tomllib.loads(sound.PAIR)).set({"gears.inspection": limits})
    pair.to_toml(tmp_path / "pair.toml")
    out = tmp_path / "out"
    given = (*drawn, "-n", "8", "-o", str(out), "--set", "operation.speed=700 rpm")
    with pytest.MonkeyPatch.context() as patched, pytest.raises(SystemExit) as ended:
        patched.setattr(sys, "argv", ["pitchpoint", "study", str(tmp_path / "pair.toml"), *given])
        cli.main()
    assert not ended.value.code
    content = unpacked((out / "report.html").read_text("utf-8"), "content")
    columns = {column["name"]: column for column in content["columns"]}
    inputs = {
        name: f"{column['values'][0][3]} {column['written']}"
        for name, column in columns.items()
        if column["input"]
    }
    program, command, path = content["opening"]["command"].split()
    assert (program, command, path) == ("pitchpoint", "run", str(out / "case.toml"))
    parts = run_case(path, settings=inputs, analyses=("operation",))["default"].parts["operation"]
    loss, percent = (columns[name]["values"][0][3] for name in ("mean_loss", "mean_efficiency"))
    assert parts["mean_loss"].values.ravel()[0] == pytest.approx(loss, rel=1e-5)
    assert 100.0 * parts["mean_efficiency"].values.ravel()[0] == pytest.approx(percent, rel=1e-5)
    assert Path(path).read_text("utf-8").count("700 rpm") == 1
