"""Squeeze of the film of a pair over its engagement from a case file: steady films, resume, report."""

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import bank
import numpy as np
import pytest
from pages import opened
from sound import PAIR

from pitchpoint.analyses import film_squeeze
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.engagement import _around, _shown, course_of
from pitchpoint.analyses.solved_films import FILM_SQUEEZE
from pitchpoint.analyses.whole_contacts import whole_contacts
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.layout import laid_out
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.report import report_page
from pitchpoint.views.screen import head
from pitchpoint.views.section_registry import FILM_SQUEEZE as SECTION

SQUEEZE = """
[models]
friction = { name = "constant", coefficient = 0.05 }
[gears.modifications]
tip_relief = "10 um"
crowning = ["6 um", "0 um"]
[film]
solver = "finite_line"
time = "squeeze"
phases = 12
nodes = 33
moments = 7
"""
BALL = str(Path(__file__).parents[2] / "examples" / "ball_on_disc_film.toml")


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    """Nothing but squeeze, in pieces of few moments."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"film_squeeze": FILM_SQUEEZE})
        patch.setattr(film_squeeze, "TOGETHER", 3)
        yield


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("squeeze") / "squeeze.toml"
    path.write_text(PAIR + SQUEEZE, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def outcome(case: str) -> Outcome:
    return bank.outcomes(case)["default"]


@pytest.mark.whole
def test_what_does_not_change_is_steady() -> None:
    given = {"film.time": "squeeze", "film.nodes": 33}
    data = running.run_case(BALL, settings=given)["default"].parts["film_squeeze"]
    assert int(data["solved_moments"]) == 3
    for name in ("minimum_film", "central_film", "film_pressure"):
        steady = data[f"steady_{name}"].values
        assert data[name].values == pytest.approx(steady, rel=1e-6)
        assert data[name].values == pytest.approx(float(data[name][0]), rel=1e-6)


@pytest.mark.whole
def test_one_pair_is_followed_from_moment_to_moment(outcome: Outcome, case: str) -> None:
    data, built = outcome.parts["film_squeeze"], load_case(case)
    assert data.sizes["moment"] == int(data["solved_moments"]) == 7
    # A base pitch of the pair takes the time of a pitch of the driver.
    pitch = 60.0 / 1500.0 / 23.0
    way = data["path"].values - float(data["path"][0])
    assert data["time"].values == pytest.approx(way * pitch, abs=1e-12)
    assert np.all(np.diff(data["time"].values) > 0.0)
    states, at = whole_contacts(built).states, course_of(built).places
    loads = states["load"][tuple(at.T)]
    assert data["load"].values == pytest.approx(loads)
    assert loads.max() == pytest.approx(states["load"].max(), rel=0.05)
    assert loads.min() >= 0.1 * loads.max()


@pytest.mark.whole
def test_oil_takes_time_to_leave_and_to_come(outcome: Outcome) -> None:
    # A film that has to become thinner is still thicker than a steady one, and the other way round.
    data = outcome.parts["film_squeeze"]
    load, film = data["load"].values, data["central_film"].values
    apart = film / data["steady_central_film"].values - 1.0
    assert apart[0] == pytest.approx(0.0, abs=1e-6)
    rises, falls = 1 + np.flatnonzero(np.diff(load) > 0.1 * load.max()), np.argmax(load) + 1
    assert rises.size and np.all(apart[rises] > 1e-3)
    assert np.all(apart[falls:][load[falls:] < 0.8 * load.max()] < -1e-3)
    assert np.max(np.abs(apart)) < 0.2
    largest = float(data["squeeze_change"])
    assert abs(largest) == pytest.approx(np.max(np.abs(apart)))


@pytest.mark.whole
def test_a_run_that_was_stopped_goes_on_with_what_it_has(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, outcome: Outcome
) -> None:
    begins: list[int] = []

    def stop(built: Any, first: int, *given: Any, **more: Any) -> Any:
        begins.append(first)
        if len(begins) == 2:
            raise KeyboardInterrupt
        return some(built, first, *given, **more)

    def run() -> Any:
        return running.run_case(case, folder=tmp_path)["default"].parts["film_squeeze"]

    some = film_squeeze._some
    monkeypatch.setattr(film_squeeze, "_some", stop)
    with pytest.raises(KeyboardInterrupt):
        run()
    again, whole = run(), outcome.parts["film_squeeze"]
    assert begins == [0, 3, 3, 6]
    assert again.equals(whole)
    assert json.loads(again.attrs["warnings"]) == json.loads(whole.attrs["warnings"])


@pytest.mark.whole
def test_a_film_that_is_lost_ends_the_march_and_leaves_steady_ones(
    case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def lost(*given: Any, **more: Any) -> Iterator[Any]:
        for number, one in enumerate(march(*given, **more)):
            bad = replace(one, ended=replace(one.ended, code=Code.NOT_CONVERGED))
            yield bad if number == 1 else one
            if number == 1:
                return

    march = film_squeeze.march_patches
    monkeypatch.setattr(film_squeeze, "march_patches", lost)
    one = running.run_case(case, settings={"film.moments": 4})["default"]
    data = one.parts["film_squeeze"]
    codes = [Code.SOLVED, Code.NOT_CONVERGED, Code.FILM_LOST, Code.FILM_LOST]
    assert data["film_status"].values.tolist() == codes
    assert np.isfinite(data["central_film"].values).tolist() == [True, False, False, False]
    assert np.isfinite(data["steady_central_film"].values).all()
    assert "was lost" in " ".join(json.loads(data.attrs["warnings"]))
    assert "3 moments of the engagement was not found" in report_page({"default": one})


@pytest.mark.whole
def test_report_screen_and_json_have_the_squeeze(outcome: Outcome) -> None:
    page = opened(report_page({"default": outcome}))
    for words in (
        '<section id="film_squeeze"',
        "Film over the engagement",
        "if all were steady",
        "d(ρh)/dt",
        "place on the path from A",
    ):
        assert words in page
    (printed,) = SECTION.screen(outcome)
    assert printed.line == "7 of 7 moments have a film that was found."
    names = ("smallest_film", "steady_smallest_film", "squeeze_change")
    assert {*map(head, names)} <= printed.rows[0].keys()
    (squeeze,) = SECTION.answer(outcome)
    assert "squeeze makes the film in the middle up to" in squeeze.words
    told = figures_by_law(outcome)["film_squeeze"]
    assert told["squeeze_change"] == float(outcome.parts["film_squeeze"]["squeeze_change"])


@pytest.mark.whole
@pytest.mark.parametrize(
    ("given", "key", "words"),
    [
        ({"operation.torque": "0 N m"}, "film.time", "nothing is loaded"),
        (
            {"film.solver": "line", "film.moments": 8},
            "film.time",
            "films of this solver are steady",
        ),
        ({"film.time": "steady"}, "film.moments", "was given without time"),
        ({"film.time": "slow"}, "film.time", "slow"),
        ({"film.moments": 1}, "film.moments", "1"),
        ({"film.thermal": "mean_film"}, "film.thermal", "films with squeeze are isothermal"),
    ],
)
def test_what_cannot_be_squeezed_is_told(
    case: str, given: dict[str, Any], key: str, words: str
) -> None:
    with pytest.raises(InputError, match=words) as caught:
        running.run_case(case, settings=given)
    assert caught.value.key == key


@pytest.mark.whole
def test_lines_are_followed_while_they_keep_their_length(case: str) -> None:
    built = load_case(case, settings={"gears.helix_angle": "8 deg"})
    course, states = course_of(built), whole_contacts(built).states
    lengths = course.values(states["weight_of_line"])
    assert np.ptp(lengths) < 1e-6 * lengths.max()
    assert np.ptp(states["weight_of_line"][states["loaded"]]) > 0.1 * lengths.max()
    assert any("stay on the face as they are" in text for text in course.told)
    first, last = map(
        int, re.findall(r"from (\d+) to (\d+) % of its engagement", course.told[0])[0]
    )
    assert 0 < first < last < 100
    wide = {"gears.helix_angle": "30 deg", "gears.face_width": "30 mm"}
    with pytest.raises(InputError, match="grows, shrinks or moves across the face all the time"):
        course_of(load_case(case, settings=wide))


def test_the_run_around_a_moment_has_no_gap() -> None:
    taken = np.array([1, 0, 1, 1, 1, 0, 1], bool)
    assert _around(taken, 3) == slice(2, 5)
    assert _around(np.ones(3, bool), 0) == slice(0, 3)


@pytest.mark.whole
def test_contacts_are_those_that_one_grid_shows(case: str) -> None:
    own = laid_out(course_of(load_case(case)).contacts[0], 32)
    narrow = own._replace(half_width=0.01 * own.half_width)
    every = [narrow, own, own, own, None, own, own, own, own]
    assert _shown(every, 65, 2) == slice(1, 4)
    assert _shown(every, 65, 6) == slice(5, 9)
    assert _shown([None], 65, 0) == slice(0, 0)


@pytest.mark.whole
@pytest.mark.parametrize("moments", [2, 3, 7])
def test_the_moment_that_carries_most_is_among_few(case: str, moments: int) -> None:
    built = load_case(case, settings={"film.moments": moments})
    course, loads = course_of(built), whole_contacts(built).states["load"]
    assert course.times.size == moments
    assert course.values(loads).max() == loads.max()
