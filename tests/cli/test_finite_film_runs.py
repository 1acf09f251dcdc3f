"""Films of finite contacts of a mesh cycle from a case file: ends, relief, resume, report, refusals."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import bank
import numpy as np
import pytest
from pages import opened, payload
from sound import PAIR
from stopped import stopped_and_gone_on

from pitchpoint.analyses import film_cycle, finite_film
from pitchpoint.analyses.analysis import silent
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.caveats import cold_warning
from pitchpoint.analyses.film_contacts import contact_states
from pitchpoint.analyses.solved_films import FILM, FINITE_FILM
from pitchpoint.analyses.whole_contacts import PLACES, one_contact, whole_contacts
from pitchpoint.core.status import Code
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.patch_films import PatchFilms, solve_patch
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, load_case
from pitchpoint.views.film_courses import film_course_panel
from pitchpoint.views.report import report_page
from pitchpoint.views.screen import head, screen_value
from pitchpoint.views.section_registry import FINITE_FILM as SECTION

MODELS = '[models]\nfriction = { name = "constant", coefficient = 0.05 }\n'
FINITE = '[film]\nsolver = "finite_line"\nphases = 3\nnodes = 33\n'
LEANING = """
misalignment = "3 um"
[gears.modifications]
crowning = ["8 um", "0 um"]
"""
EXAMPLES = Path(__file__).parents[2] / "examples"
BALL = str(EXAMPLES / "ball_on_disc_film.toml")
TORUS = str(EXAMPLES / "torus.toml")


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    """Nothing but films."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"film": FILM, "finite_film": FINITE_FILM})
        yield


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("film") / "film.toml"
    path.write_text(PAIR + MODELS + FINITE, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def outcome(case: str) -> Outcome:
    return bank.outcomes(case)["default"]


@pytest.fixture(scope="module")
def leaning(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("lean") / "lean.toml"
    path.write_text(PAIR.replace("[lubricant]", LEANING + "[lubricant]", 1) + MODELS + FINITE)
    return str(path)


@pytest.mark.whole
def test_every_loaded_contact_has_a_film(outcome: Outcome) -> None:
    assert list(outcome.parts) == ["finite_film"]
    data = outcome.parts["finite_film"]
    loaded = data["load"].values > 0.0
    assert int(data["loaded_contacts"]) == int(data["solved_contacts"]) == loaded.sum() > 0
    assert np.array_equal(np.isfinite(data["minimum_film"].values), loaded)
    assert (data["film_status"].values[loaded] == Code.SOLVED).all()
    assert np.nanmax(data["film_defect"].values) < 1e-6


@pytest.mark.whole
def test_a_contact_is_that_of_the_solver_alone_and_carries_its_load(
    outcome: Outcome, case: str
) -> None:
    data, built = outcome.parts["finite_film"], load_case(case)
    at = tuple(data["kept_at"].values[0])
    assert float(data["load"].values[at]) == data["load"].values.max()
    found = solve_patch(one_contact(built, whole_contacts(built).numbers[at]), nodes=33, cells=32)
    film = found.film
    assert float(data["central_film"].values[at]) == pytest.approx(float(film.central_film))
    assert data["near_ends"].values[at] == pytest.approx(film.near_ends)
    assert data["field_pressure"].values[0] == pytest.approx(film.pressure)
    assert data["line_length"].values[at] == pytest.approx(20e-3)
    areas = found.layout.bodies(33, 32, 32, "half_space").areas * found.layout.length**2
    carried = areas @ data["field_pressure"].values[0].sum(axis=1)
    assert carried == pytest.approx(float(data["load"].values[at]), rel=1e-8)


@pytest.mark.whole
def test_energy_is_lost_by_sliding_and_rolling(outcome: Outcome) -> None:
    data = outcome.parts["finite_film"]
    lost = (data["film_sliding_loss"] + data["film_rolling_loss"]).sum(("pair", "line"))
    assert data["film_loss"].values == pytest.approx(lost.values)
    parts = float(data["mean_film_sliding_loss"]) + float(data["mean_film_rolling_loss"])
    assert float(data["mean_film_loss"]) == pytest.approx(parts)
    slid = data["film_friction"] * data["load"] * np.abs(data["sliding_velocity"])
    loaded = data["load"].values > 0.0
    assert data["film_sliding_loss"].values[loaded] == pytest.approx(slid.values[loaded])
    rolled = 2.0 * data["rolling_resistance"] * data["entrainment"]
    assert data["film_rolling_loss"].values[loaded] == pytest.approx(rolled.values[loaded])


@pytest.mark.whole
def test_lines_without_ends_stand_beside_and_agree_in_the_middle(
    outcome: Outcome, case: str
) -> None:
    data = outcome.parts["finite_film"]
    given = {"film.solver": "line", "film.nodes": 129}
    lines = running.run_case(case, settings=given)["default"].parts["film"]
    beside = lines["central_film"].values
    known = np.isfinite(beside)
    # Oil begins where that of the patches does, and nearer than a module.
    assert (data["film_inlet"].values[known] < 2e-3).all()
    assert data["line_central_film"].values[known] == pytest.approx(beside[known], rel=5e-3)
    assert float(data["mean_line_loss"]) == pytest.approx(float(lines["mean_film_loss"]), rel=0.02)
    # 33 nodes are few for thin films; with 65 they come within 1.5 % at all phases.
    assert data["central_film"].values[known] == pytest.approx(beside[known], rel=0.16)
    at = tuple(data["kept_at"].values[0])
    ratio = data["near_ends"].values[at] / float(data["pressure"].values[at])
    assert (np.diff(ratio, axis=-1) < 0.0).all() and (ratio[:, 1] > 1.2).all()


@pytest.mark.whole
def test_friction_of_lines_across_the_pitch_line_is_that_of_their_slices(
    case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: list[dict[str, np.ndarray]] = []
    monkeypatch.setattr(film_cycle, "cold_warning", lambda _, run: heard.append(run) or "")
    helical = {"gears.helix_angle": "20 deg"}
    data = running.run_case(case, settings=helical)["default"].parts["finite_film"]
    friction, beside = data["film_friction"].values, data["line_friction"].values
    known = np.isfinite(friction)
    assert friction[known] == pytest.approx(beside[known], rel=0.2)
    assert float(data["mean_film_friction"]) == pytest.approx(
        float(data["mean_line_friction"]), rel=0.1
    )
    assert (data["boundary_part"].values[known] < friction[known]).all()
    # What is told of heat is the power, and not that of the slice that carries most.
    slides = np.full(known.shape, np.nan)
    slides[known] = heard[0]["sliding_velocity"]
    power = (friction * slides * data["load"].values)[known]
    assert power == pytest.approx(data["film_sliding_loss"].values[known])
    built = load_case(case, settings=helical)
    slices = contact_states(built)
    ahead = slices["load"] * np.sign(slices["speed_b"] - slices["speed_a"])
    turns = np.abs(ahead.sum(axis=-1)) / np.where(known, data["load"].values, np.nan)[..., 0]
    at = (*np.unravel_index(np.nanargmin(turns), turns.shape), 0)
    film = solve_patch(
        one_contact(built, whole_contacts(built).numbers[at]), nodes=33, cells=32
    ).film
    assert float(film.friction) < 0.7 * friction[at]


@pytest.mark.whole
def test_crown_and_lean_are_the_relief_along_the_line(leaning: str) -> None:
    built = load_case(leaning)
    given, slices = whole_contacts(built), contact_states(built)
    assert given.joined and given.states["load"].shape[-1] == 1
    relief = given.numbers[..., 2:].reshape(*given.states["load"].shape, 4, -1)[..., 3, :]
    at = np.unravel_index(np.argmax(given.states["load"]), given.states["load"].shape)
    assert given.states["load"][at] == pytest.approx(slices["load"][at[:2]].sum())
    across = PLACES - 0.5
    rigid = 8e-6 * (2.0 * across) ** 2
    leans = relief[at] - rigid
    # What both teeth bend is that of a load that leans the other way.
    slope = np.polyfit(across, leans, 1)[0]
    assert 0.0 < abs(slope) < 3e-6
    assert np.min(relief[at]) == 0.0


@pytest.mark.whole
def test_the_load_along_a_line_is_that_of_the_slices(leaning: str) -> None:
    built = load_case(leaning)
    given, slices = whole_contacts(built), contact_states(built)
    at = np.unravel_index(np.argmax(given.states["load"]), given.states["load"].shape)
    film = solve_patch(one_contact(built, given.numbers[at]), nodes=33, cells=32).film
    along = np.trapezoid(film.pressure, film.x, axis=1)
    middles = (np.arange(slices["load"].shape[-1]) + 0.5) / slices["load"].shape[-1] - 0.5
    own = np.interp(20e-3 * middles, film.y, along)
    shared = slices["line_load"][at[:2]]
    inner = np.abs(middles) < 0.35
    assert own[inner] == pytest.approx(shared[inner], rel=0.15)


@pytest.mark.whole
def test_ends_by_name_lower_the_pressure_there(case: str) -> None:
    built = load_case(case, settings={"film.end_profile": "dub_off", **DUB})
    numbers = whole_contacts(built).numbers
    load = whole_contacts(built).states["load"]
    at = np.unravel_index(np.argmax(load), load.shape)
    plain = load_case(case)
    sharp, soft = (
        solve_patch(one_contact(one, numbers[at]), nodes=33, cells=32).film.near_ends
        for one in (plain, built)
    )
    assert (soft[:, 0] < 0.8 * sharp[:, 0]).all()


DUB = {"film.end_length": "1 mm", "film.end_radius": "200 mm"}


@pytest.mark.whole
def test_a_ball_on_a_disc_has_an_ellipse_once_for_all_phases() -> None:
    settings = {"film.nodes": 33, "film.refractive_index": 1.47}
    outcome = running.run_case(BALL, settings=settings)["default"]
    data = outcome.parts["finite_film"]
    assert "mean_line_loss" not in data
    # An index of 1.47 under the density of Dowson and Higginson at the pressure in the middle.
    pressed = 1e-9 * float(data["film_pressure"].max())
    refraction = (1.0 + 0.6 * pressed / (1.0 + 1.7 * pressed)) * (1.47**2 - 1.0) / (1.47**2 + 2.0)
    index = np.sqrt((1.0 + 2.0 * refraction) / (1.0 - refraction))
    read = float(data["read_film"].max() / data["central_film"].max())
    assert read == pytest.approx(index / 1.47, rel=5e-3) and read > 1.03
    words = f"too thick, as compressed oil is denser: by {100.0 * (read - 1.0):.2g} % in the middle"
    page = report_page({"default": outcome}).replace("\u00a0", " ")
    assert words in data.attrs["interferometry"] and words in page
    # What does not change with time has no course, and what transmits nothing no efficiency.
    assert "Over the mesh cycle" not in page and "undefined, no power" not in page
    assert "at all of which the contact is the same" in page and "teeth by" not in page
    assert np.unique(data["central_film"].values).size == 1
    assert float(data["film_pressure"].max()) == pytest.approx(
        float(data["pressure"].max()), rel=0.02
    )
    laws = dict(zip(data["film_law"].values, data["film_deviation"].values, strict=True))
    assert abs(laws["hamrock_dowson_1977_central"]) < 0.2
    # A circle is drawn as one; without courses the first maps stand on the page that sums up.
    assert payload(page)["figures"]["patch0_0_pressure"]["layout"]["yaxis"]["scaleanchor"] == "x"
    assert 'id="one-page-patch0_0_pressure"' in page


@pytest.mark.parametrize(
    ("law", "density"),
    [
        ("dowson_higginson_1966", lambda p: 1.0 + 0.6 * p / (1.0 + 1.7 * p) - 7e-4 * 35.0),
        ("incompressible", lambda p: np.ones_like(p)),
    ],
)
def test_compressed_and_warm_oil_refracts_by_its_density(law: str, density: Any) -> None:
    """The index as the root of Lorentz and Lorenz, at pressures and an index that no example has."""
    built = load_case(BALL, settings={"film.refractive_index": 1.415, "film.density_law": law})
    pressed = np.array([0.12, 0.48, 0.93])  # GPa
    of_law = finite_film._read_over_true(built, 1e9 * pressed, np.full(3, 35.0)) * 1.415
    refraction = (of_law**2 - 1.0) / (of_law**2 + 2.0) / ((1.415**2 - 1.0) / (1.415**2 + 2.0))
    np.testing.assert_allclose(refraction, density(pressed), rtol=1e-12)


@pytest.mark.whole
def test_a_barrel_has_both_its_radii() -> None:
    built = load_case(BALL, settings={"gears.transverse_radius": "30 mm"})
    contact = one_contact(built, whole_contacts(built).numbers[0, 0, 0])
    assert float(contact.radius[0]) == pytest.approx(9.525e-3)
    assert float(1.0 / contact.bend) == pytest.approx(30e-3)
    assert contact.length is None


@pytest.mark.whole
def test_the_heat_that_films_leave_out_is_told_with_what_takes_it_along(case: str) -> None:
    built = load_case(case)
    run = {"pressure": 1e9, "radius": 0.01, "entrainment": 3.0, "sliding_velocity": 3.0}
    run |= {"friction": 0.1, "film_thickness": 1e-6}
    told = cold_warning(built, {name: np.array([value]) for name, value in run.items()})
    assert 'thermal = "mean_film" in [film] takes the heat along' in told


@pytest.fixture(scope="module")
def warm(case: str) -> Outcome:
    return bank.outcomes(case, settings={"film.thermal": "mean_film"})["default"]


@pytest.mark.whole
def test_films_with_their_heat_have_temperatures_beside_those_of_lines(
    warm: Outcome, outcome: Outcome
) -> None:
    data, cold = warm.parts["finite_film"], outcome.parts["finite_film"]
    loaded = data["load"].values > 0.0
    assert int(data["solved_contacts"]) == loaded.sum()
    rise, flash = (data[name].values[loaded] for name in ("film_rise", "flash_rise"))
    slides = np.abs(data["sliding_velocity"].values[loaded])
    assert (rise > 0.1).all() and (flash > 0.1).all()
    assert rise[np.argmax(slides)] > 3.0 * rise[np.argmin(slides)]
    # Rough flanks rub more where warm films let them closer.
    assert (data["central_film"].values[loaded] < cold["central_film"].values[loaded]).all()
    # Lines beside them have their heat too: both grids are as far apart as without.
    warm_apart, cold_apart = (
        float(one["mean_film_friction"] / one["mean_line_friction"]) for one in (data, cold)
    )
    assert warm_apart == pytest.approx(cold_apart, rel=0.02)
    assert float(data["largest_film_rise"]) == pytest.approx(rise.max())
    at = tuple(data["kept_at"].values[0])
    assert data["field_rise"].values[0].max() == pytest.approx(data["film_rise"].values[at])
    surfaces = [data[f"field_surface_rise_{body}"].values[0].max() for body in (1, 2)]
    assert max(surfaces) == pytest.approx(data["flash_rise"].values[at])
    assert "field_rise" not in cold and float(cold["largest_film_rise"]) == 0.0


@pytest.mark.whole
def test_a_report_has_the_temperatures_and_no_word_of_isothermal_films(warm: Outcome) -> None:
    report = report_page({"default": warm})
    page = opened(report)
    assert "films are isothermal" not in page.lower() and "With heat (mean film)" in page
    for words in ("Temperature above the inlet, in the warmest row", "patch0_0_rise"):
        assert words in page
    told = next(iter(SECTION.answer(warm))).words
    assert "warmer than their inlet" in told
    assert figures_by_law(warm)["finite_film"]["largest_flash_rise"] > 0.0
    drawn = [figure["data"] for figure in payload(report)["figures"].values()]
    maps = [(heat["colorscale"], rest) for heat, *rest in drawn if "colorscale" in heat]
    over = [one["line"]["color"] for _, rest in maps for one in rest]
    # Dark pages turn colours with # alone: those of a map and of the lines on it together.
    assert over and all(colour.startswith("#") for colour in over)
    assert all(colour.startswith("#") for scale, _ in maps for _, colour in scale)


@pytest.mark.whole
def test_films_that_are_not_found_are_counted_and_withhold_the_loss(
    case: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls: list[int] = []

    def lost(contact: Any, **given: Any) -> PatchFilms:
        calls.append(1)
        if len(calls) == 1:
            raise InputError("no grid shows it", key="relief")
        found = known[0] if known else solve_patch(contact, **given)
        known.append(found)
        return found if len(calls) != 2 else replace(found, ended=bad(found))

    def bad(found: PatchFilms) -> Any:
        return replace(found.ended, code=Code.UNRESOLVED)

    known: list[PatchFilms] = []
    monkeypatch.setattr(finite_film, "solve_patch", lost)
    one = running.run_case(case)["default"]
    data = one.parts["finite_film"]
    assert int(data["loaded_contacts"]) - int(data["solved_contacts"]) == 2
    assert np.isnan(float(data["mean_film_loss"])) and np.isnan(float(data["film_efficiency"]))
    told = " ".join(json.loads(data.attrs["warnings"]))
    every = int(data["loaded_contacts"])
    for why in (Code.UNRESOLVED.sentence, Code.NOT_CONVERGED.sentence):
        assert f"1 of {every} loaded contacts have no film ({why})" in told
    assert "a contact was not taken: no grid shows it" in told
    assert "2 loaded contacts have no film" in report_page({"default": one})


@pytest.mark.whole
def test_a_run_that_was_stopped_goes_on_with_what_it_has(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, outcome: Outcome
) -> None:
    def run() -> Any:
        return running.run_case(case, folder=tmp_path)["default"].parts["finite_film"]

    again, begins = stopped_and_gone_on(FINITE_FILM, run, monkeypatch)
    assert begins[:3] == [0, 2, 2]
    for name in ("film_loss", "minimum_film", "field_pressure", "near_ends", "kept_at"):
        assert np.array_equal(again[name], outcome.parts["finite_film"][name], equal_nan=True)


@pytest.mark.whole
def test_progress_tells_contacts_and_steps(case: str) -> None:
    told: list[tuple[int, str]] = []
    built = load_case(case)
    finite_film.film_part(
        built, {"first": 0, "count": 1}, lambda done, doing="": told.append((done, doing))
    )
    assert any(one[1].startswith("contact 1 of ") and "Newton step 3" in one[1] for one in told)
    assert told[-1] == (1, "")
    silent(*told[-1])


@pytest.mark.whole
def test_report_screen_and_json_have_the_films(outcome: Outcome) -> None:
    page = opened(report_page({"default": outcome}))
    for words in (
        '<section id="finite_film"',
        "The contact that carries most",
        "0.5 b from the end",
        "in the last row a number of the grid",
        "lines without ends",
        "a number of the grid, and so is the smallest film",
    ):
        assert words in page
    assert '"type": "heatmap"' in page or '"type":"heatmap"' in page
    # So coarse a grid has no estimate of its error, and no bars.
    data = outcome.parts["finite_film"]
    assert "Bars: estimated error" not in page
    told = film_course_panel(
        "f", outcome, data.assign(minimum_film_error=0.1 * (1.0 + data["load"] * 0.0))
    )
    solved = told.figures[0]
    smallest, middle, *_ = solved.data
    height, bar = (np.array(one, float) for one in (smallest["y"], smallest["error_y"]["array"]))
    assert np.isfinite(height).sum() > 3
    np.testing.assert_allclose(bar, 0.1 * height, rtol=5e-3)
    assert "error_y" not in middle and "Bars: estimated error" in solved.remarks
    (first, second) = SECTION.screen(outcome)
    assert first.title == "Films of finite contacts"
    assert head("largest_end_pressure") in first.rows[0]
    assert head("largest_film_pressure") not in first.rows[0]
    assert [row["friction by"] for row in second.rows] == [
        "films",
        "lines without ends",
        "constant",
    ]
    told = figures_by_law(outcome)["finite_film"]
    assert told["mean_line_loss"] == pytest.approx(
        float(outcome.parts["finite_film"]["mean_line_loss"])
    )
    assert told["largest_end_pressure"] > 0.0


def test_what_rounding_leaves_is_zero_on_the_screen() -> None:
    assert (
        screen_value("largest_asperity_share", 1e-15)
        == screen_value("largest_asperity_share", 0.0)
        == "0"
    )
    assert screen_value("largest_asperity_share", 1e-6) == "1e−4"


@pytest.mark.whole
def test_without_a_torque_nothing_is_loaded(case: str) -> None:
    one = running.run_case(case, settings={"operation.torque": "0 N m"})["default"]
    words = next(iter(SECTION.answer(one))).words
    first, *_ = SECTION.screen(one)
    assert words.startswith("Nothing is loaded") and first.line == words
    page = opened(report_page({"default": one}))
    assert words in page and "No film was found" not in page


@pytest.mark.whole
@pytest.mark.parametrize("lean", ["80 um", "-80 um"])
def test_lines_that_touch_at_either_end_are_told(case: str, lean: str) -> None:
    one = running.run_case(case, settings={"gears.misalignment": lean})["default"]
    data = one.parts["finite_film"]
    ends = np.isfinite(data["near_ends"].values[..., 0]).any(axis=(0, 1, 2))
    assert ends.sum() == 1
    assert data.attrs["sharp"].startswith("The lines end sharply: the largest pressure")
    first, *_ = SECTION.screen(one)
    assert all(
        head(name) not in first.rows[0]
        for name in ("largest_film_pressure", "smallest_central_film")
    )
    assert "12 of 12 contact lines touch at one end only" in first.line
    assert first.line.startswith(
        "A smallest film below zero: the mean planes of the rough flanks overlap"
    )
    words = next(iter(SECTION.answer(one))).words
    assert " at least: mean planes overlap, " in words and "undefined" not in words
    page = opened(report_page({"default": one}))
    assert "not compared" in page and "undefined, no power" not in page


@pytest.mark.whole
@pytest.mark.parametrize(
    ("settings", "key", "words"),
    [
        (
            {"solver": "elliptic"},
            "solver",
            "lines have no elliptic solver; take line or finite_line",
        ),
        ({"nodes": 100}, "nodes", "one more than a power of two"),
        ({"nodes": 513}, "nodes", "allowed are 33, 65, 129 and 257"),
        ({"cells": 48}, "cells", "allowed are 32, 64, 128 and 256"),
        ({"solver": "line", "cells": 64}, "cells", 'take solver = "finite_line"'),
        ({"thermal": "mean_fim"}, "thermal", "did you mean mean_film"),
        ({"pattern": 3.0}, "pattern", "oil flows both ways"),
        ({"ends": "free"}, "ends", "mirrored"),
        ({"end_length": "1 mm"}, "end_length", "without end_profile"),
        ({"end_profile": "chamferd"}, "end_profile", "did you mean chamfered"),
        ({"end_profile": "dub_off", "end_length": "1 mm"}, "end_radius", "dub_off asks for it"),
        ({"end_profile": "straight", "end_drop": "1 um"}, "end_drop", "it has none"),
    ],
)
def test_what_finite_contacts_cannot_be_is_told(
    case: str, settings: dict[str, Any], key: str, words: str
) -> None:
    with pytest.raises(InputError) as caught:
        load_case(case, settings={f"film.{name}": value for name, value in settings.items()})
    assert str(caught.value.key) == f"film.{key}"
    assert words in str(caught.value)


def test_ellipses_have_no_finite_line() -> None:
    with pytest.raises(InputError, match=r"touch in an ellipse.* take elliptic") as caught:
        load_case(TORUS, settings={"film.solver": "finite_line"})
    assert caught.value.key == "film.solver"


@pytest.mark.whole
def test_ends_that_do_not_fit_are_told(case: str) -> None:
    given = {"film.end_profile": "dub_off", "film.end_radius": "1 m", "film.end_length": "11 mm"}
    with pytest.raises(InputError, match="do not fit") as caught:
        whole_contacts(load_case(case, settings=given))
    assert caught.value.key == "film.end_length"


@pytest.mark.whole
def test_a_record_of_finite_films_runs_again(outcome: Outcome, tmp_path: Path) -> None:
    path = tmp_path / "manifest.json"
    path.write_text(json.dumps(outcome.manifest, default=str))
    built = load_case(str(path))
    assert built.case.film is not None and built.case.film.solver == "finite_line"
