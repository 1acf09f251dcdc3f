"""Wear from a case file: steps that survive a stop, worn gears in other analyses, report, refusals."""

import errno
import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from sound import PAIR, quick_first

from pitchpoint import cli
from pitchpoint.analyses import wear_course
from pitchpoint.analyses.along_action import STIFFNESS
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.wear import WEAR
from pitchpoint.core.doubts import doubts_of
from pitchpoint.errors import InputError
from pitchpoint.results import store
from pitchpoint.results.store import load
from pitchpoint.runs import run as running
from pitchpoint.runs.catalogue import figures_by_law
from pitchpoint.runs.run import Outcome, load_case, uncomputed_manifests
from pitchpoint.views.figures import Panel
from pitchpoint.views.report import report_page
from pitchpoint.views.section import Page
from pitchpoint.views.section_registry import WEAR as SECTION
from pitchpoint.wear import history

MODELS = """
[models]
load_sharing = "from_stiffness"
friction = { name = "constant", coefficient = 0.05 }
"""
DRY = """
[wear]
law = "archard_1953"
cycles = 3e6
coefficient = 2e-7
hardness = "2 GPa"
cells = 16
phases = 8
"""


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"wear": WEAR, "stiffness": STIFFNESS})
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("wear")


def written(folder: Path, text: str, name: str = "wear.toml") -> str:
    path = folder / name
    path.write_text(PAIR + text, "utf-8")
    return str(path)


@pytest.fixture(scope="module")
def case(folder: Path) -> str:
    return written(folder, MODELS + DRY)


@pytest.fixture(scope="module")
def outcome(case: str, folder: Path) -> Outcome:
    return running.run_case(case, folder=folder / "whole")["default"]


@pytest.mark.whole
def test_the_march_ends_where_it_is_asked_to(outcome: Outcome) -> None:
    data = outcome.parts["wear"]
    assert float(data["final_cycles"]) == 3e6
    assert float(data["life_hours"]) == pytest.approx(3e6 / 1500.0 * 60.0)
    assert np.all(np.diff(data["cycles"].values) > 0.0)
    depth = data["deepest_wear"].values
    assert np.all(np.diff(depth, axis=0) > 0.0)
    assert data["wear_error"].values[-1] == pytest.approx(0.0, abs=2e-2 * depth[-1].max())
    told = figures_by_law(outcome)["wear"]
    assert told["final_depth"] == float(data["final_depth"]) == depth[-1].max()
    assert 0.0 < told["backlash_growth"] < depth[-1].sum()
    # Gear 2 meets with every third turn of gear 1.
    volumes = data["worn_volume"].values[-1]
    assert volumes[0] / volumes[1] == pytest.approx(61.0 / 23.0, rel=1e-6)


@pytest.mark.whole
def test_a_march_that_is_stopped_at_every_step_ends_with_the_same_bits(
    outcome: Outcome, case: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    further, stops = WEAR.onward, []
    assert further is not None

    def stopping(built: Any, last: xr.Dataset, progress: Any) -> xr.Dataset | None:
        if len(stops) < 20 and len(done) == 1:
            stops.append(float(last["cycles"][-1]))
            raise KeyboardInterrupt
        done.append(1)
        return further(built, last, progress)

    monkeypatch.setitem(vars(WEAR), "onward", stopping)
    found: Outcome | None = None
    while found is None:
        done: list[int] = []
        try:
            found = running.run_case(case, folder=folder / "stopped")["default"]
        except KeyboardInterrupt:
            continue
    assert len(stops) == outcome.parts["wear"].sizes["step"] - 1
    xr.testing.assert_identical(found.parts["wear"], outcome.parts["wear"])
    bits = [one.parts["wear"]["worn_depth"].values.tobytes() for one in (found, outcome)]
    assert bits[0] == bits[1]


@pytest.mark.whole
def test_a_full_disk_is_one_sentence_and_what_is_done_is_kept(
    outcome: Outcome,
    case: str,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    out, sync = folder / "full", os.fsync
    pieces = lambda: sorted(out.glob("default/wear.0*.nc"))  # noqa: E731
    monkeypatch.setattr(cli, "_write_report", lambda outcomes, folder: None)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", "run", case, "-o", str(out)])

    def full(handle: int) -> None:
        if len(pieces()) == 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(handle)

    with monkeypatch.context() as patch:
        patch.setattr(store.os, "fsync", full)
        with pytest.raises(SystemExit) as caught:
            cli.main()
    assert caught.value.code == 1
    *_, told = capsys.readouterr().err.splitlines()
    assert told.startswith("error: ")
    assert "No space left on device; what was finished before is kept and found again" in told
    kept = {path: path.stat().st_mtime_ns for path in pieces()}
    assert len(kept) == 2
    assert not [*out.glob("default/.*")]
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert not caught.value.code
    whole = load(out / "default" / "wear.nc")
    xr.testing.assert_identical(whole, outcome.parts["wear"])


@pytest.mark.whole
def test_worn_gears_are_gears(outcome: Outcome, folder: Path) -> None:
    kept = folder / "whole" / "default" / "wear.nc"
    settings = {"worn.file": str(kept), "worn.cycles": 3e6}
    case = written(folder, MODELS, "pair.toml")
    new, unworn, worn = (
        running.run_case(case, settings=more)["default"].parts["stiffness"]
        for more in ({}, {**settings, "worn.cycles": 0.0}, settings)
    )
    for name, values in new.data_vars.items():
        assert values.values.tobytes() == unworn[name].values.tobytes()
    errors = [float(np.ptp(one["static_transmission_error"].values)) for one in (new, worn)]
    assert abs(errors[1] / errors[0] - 1.0) > 0.05
    (record,) = uncomputed_manifests(case, settings=settings)
    data = outcome.parts["wear"]
    most, error = (
        " and ".join(f"{1e6 * depth:.3g}" for depth in data[name].values[-1])
        for name in ("deepest_wear", "wear_error")
    )
    told = f"worn by 3e+06 turns of gear 1: {most} um deep at most, within {error} um by grid and steps"
    assert any(told in warning for warning in record["warnings"])
    assert {row["key"] for row in record["inputs"] if row["table"] == "worn"} == {
        "file",
        "cycles",
        "digest",
    }


@pytest.mark.whole
def test_a_kept_profile_wears_in_proportion_to_the_cycles(case: str) -> None:
    both = [
        running.run_case(case, settings={"wear.profile": "kept", "wear.cycles": turns})["default"]
        for turns in (1e4, 1e7)
    ]
    short, long = (one.parts["wear"]["worn_depth"].values[-1] for one in both)
    assert long == pytest.approx(1e3 * short, rel=1e-9)


@pytest.mark.whole
def test_a_life_is_as_near_as_is_told(case: str) -> None:
    """To a depth on coarse cells and phases, against four times as many and a tenth of the tolerance."""
    limit = {"wear.depth_limit": "2 um", "wear.cycles": 1e9, "wear.sensitivities": False}
    grids = (
        {"wear.cells": 20, "wear.phases": 12},
        {"wear.cells": 80, "wear.phases": 48, "wear.tolerance": 3e-4},
    )
    coarse, fine = (
        running.run_case(case, settings={**limit, **grid})["default"].parts["wear"]
        for grid in grids
    )
    assert coarse.attrs["end"] == fine.attrs["end"] == "depth"
    error = float(coarse["final_cycles_error"])
    assert abs(float(fine["final_cycles"] - coarse["final_cycles"])) < error
    assert 0.0 < error < 0.1 * float(coarse["final_cycles"])


@pytest.mark.whole
def test_the_backlash_of_lines_that_cross_their_pitch_line_is_one_of_the_slices(case: str) -> None:
    """Nothing wears there, so that none is added where lines cross it in every position: it halves."""
    wide = {"gears.helix_angle": "15 deg", "gears.face_width": "40 mm"}
    wide |= {"wear.profile": "kept", "wear.sensitivities": False}
    few, many = (
        running.run_case(case, settings={**wide, "models.slices": slices})["default"].parts["wear"]
        for slices in (12, 24)
    )
    grown, less = (float(data["backlash_growth"][-1]) for data in (few, many))
    assert less == pytest.approx(grown / 2.0, rel=0.1)
    assert float(few["backlash_growth_error"][-1]) >= grown
    (told,) = (one for one in doubts_of(few.attrs) if "backlash that it adds" in one)
    assert "100 % off" in told and "12 slices of lines" in told


@pytest.mark.whole
def test_the_march_ends_where_flanks_move_off_their_places(case: str) -> None:
    given = {"wear.coefficient": 1e-3, "wear.cycles": 1e12, "wear.profile": "kept"}
    data = running.run_case(case, settings=given)["default"].parts["wear"]
    assert data.attrs["end"] == "module"
    assert float(data["final_depth"]) == pytest.approx(0.2 * 2e-3)
    assert any("the march ends at 0.2 modules" in one for one in json.loads(data.attrs["warnings"]))


@pytest.mark.whole
def test_a_strain_wave_gear_wears_whose_contacts_are_wide_as_new() -> None:
    """Its march ended at a nanometre; what half the grid leaves is in the error that is told."""
    settings = {
        **{"wear.law": "archard_1953", "wear.coefficient": 1e-7, "wear.hardness": "700 HV"},
        **{"wear.profile": "kept", "wear.sensitivities": False, "wear.cycles": 1e6},
        **{"models.load_sharing": "from_stiffness", "wear.cells": 20.0, "wear.phases": 12.0},
    }
    case = str(Path(__file__).parents[2] / "examples" / "strain_wave.toml")
    data = running.run_case(case, settings=settings)["default"].parts["wear"]
    assert data.attrs["end"] == "turns"
    limit = np.array([0.747e-6, 0.314e-6])  # on 160 cells and 96 phases
    deepest, error = data["deepest_wear"].values[-1], data["wear_error"].values[-1]
    assert (np.abs(deepest - limit) < error).all()
    assert (error < 0.6 * limit).all()
    told = json.loads(data.attrs["warnings"])
    assert any("of the radius of the sharper flank wide to each side" in one for one in told)


@pytest.mark.whole
def test_a_ball_that_conforms_ends_the_march(folder: Path) -> None:
    ball = Path(__file__).parents[2] / "examples" / "ball_on_disc.toml"
    settings = {
        "wear.law": "vdi_2736",
        "wear.rate": "1e-8 mm3/(N m)",
        "wear.cycles": 1e9,
        "wear.cells": 8,
        "wear.phases": 4,
    }
    outcome = running.run_case(str(ball), settings=settings)["default"]
    data = outcome.parts["wear"]
    assert data.attrs["end"] == "outgrown"
    assert json.loads(data.attrs["members"]) == ["disc", "ball"]
    assert np.all(np.isfinite(data["worn_depth"].values))
    # The deepest strip lies under the middle of the contact, not at an end of what it can reach.
    strips = data["worn_depth"].values[-1, 0].max(axis=0)
    assert abs(int(np.argmax(strips)) - strips.size / 2) <= strips.size / 4
    assert 'id="wear"' in report_page({"default": outcome})


LIMITS = {
    "depth": ({"wear.depth_limit": "2 um"}, "final_depth", 2e-6),
    "turns": ({"wear.cycles": 10.0}, "final_cycles", 10.0),
    "tip land": ({"wear.tip_land_limit": "LAND"}, "worn_tip_land", 1.0),
    "backlash": ({"wear.backlash_limit": "3 um"}, "backlash_growth", 3e-6),
}


@pytest.mark.whole
@pytest.mark.parametrize("end", quick_first(LIMITS))
def test_a_limit_ends_the_march(case: str, outcome: Outcome, end: str) -> None:
    given, name, expected = LIMITS[end]
    if end == "tip land":
        land = float(outcome.parts["wear"]["worn_tip_land"].values[0].min()) - 1e-6
        given, expected = {"wear.tip_land_limit": f"{land!r} m"}, land
    found = running.run_case(case, settings=given)["default"]
    data = found.parts["wear"]
    assert data.attrs["end"] == end
    assert float(data[name].values.reshape(data[name].shape or 1)[-1].min()) == pytest.approx(
        expected, rel=1e-3
    )
    assert float(data["final_cycles"]) < 3e6
    (printed,) = SECTION.screen(found)
    assert {"tip land": "at its tip", "backlash": "backlash"}.get(end, "") in printed.line


@pytest.mark.whole
def test_tips_that_are_narrower_as_new_are_refused(case: str) -> None:
    with pytest.raises(InputError, match=r"wear.tip_land_limit: 9 mm was given, and teeth of gear"):
        running.run_case(case, settings={"wear.tip_land_limit": "9 mm"})


STEEL = {"young": "206 GPa", "poisson": 0.3, "hardness": "2 GPa"}
MIXED = {
    "wear.cycles": 1.0,
    "wear.law": "masjedi_khonsari_2015",
    "wear.adsorption_heat": "49 kJ/mol",
    "models.asperity_load": "masjedi_khonsari_2012",
    "materials.gear_1": STEEL,
    "materials.gear_2": STEEL,
}


@pytest.mark.whole
def test_mixed_lubrication_wears_less_than_dry_flanks(folder: Path) -> None:
    dry = running.run_case(written(folder, MODELS + DRY), settings={"wear.cycles": 1.0})
    mixed = running.run_case(written(folder, MODELS + DRY, "mixed.toml"), settings=MIXED)
    depths = [float(one["default"].parts["wear"]["final_depth"]) for one in (dry, mixed)]
    assert 0.0 < depths[1] < 1e-2 * depths[0]


@pytest.mark.whole
def test_the_load_on_asperities_by_films(folder: Path) -> None:
    """Named in the case: neither a formula nor its hardness is asked for, and the report says so."""
    films = {**MIXED, "wear.load_ratio": "film", "models.asperity_load": "none"}
    outcome = running.run_case(written(folder, MODELS + DRY, "films.toml"), settings=films)[
        "default"
    ]
    formula = running.run_case(written(folder, MODELS + DRY, "mixed.toml"), settings=MIXED)[
        "default"
    ]
    depths = [float(one.parts["wear"]["final_depth"]) for one in (outcome, formula)]
    assert 0.05 < depths[0] / depths[1] < 20.0 and depths[0] != depths[1]
    page = report_page({"default": outcome})
    assert "with the load on asperities from solved films" in page
    assert "1 % more of" not in page
    (record,) = uncomputed_manifests(written(folder, MODELS + DRY, "films.toml"), settings=films)
    rows = {f"{row['table']}.{row['key']}" for row in record["inputs"]}
    assert {"wear.load_ratio", "film.nodes", "film.asperities"} <= rows


@pytest.mark.whole
def test_the_error_of_wear_has_that_of_the_grid_of_films(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Off by less than told and by more than a third of it; on the fewest, as told."""
    films = {**MIXED, "wear.load_ratio": "film", "film.solver": "line", "wear.cells": 8}
    case = written(folder, MODELS + DRY, "nodes.toml")
    of_films, told = wear_course._of_films, []
    monkeypatch.setattr(
        wear_course, "_of_films", lambda *given: told.append(of_films(*given)) or told[-1]
    )

    def wear(nodes: int) -> xr.Dataset:
        run = running.run_case(case, settings={**films, "film.nodes": nodes})
        return run["default"].parts["wear"].isel(step=-1)

    coarse, usual, fine = (wear(nodes) for nodes in (33, 65, 129))
    depths = [one["deepest_wear"].values for one in (coarse, usual, fine)]
    assert told[0] == pytest.approx(np.max(np.abs(depths[1] / depths[0] - 1.0)), rel=1e-3)
    off = np.max(np.abs(depths[2] / depths[1] - 1.0))
    assert off < told[1] < 3.0 * off
    with_films, of_them = usual["wear_error"].values, told[1] * depths[1]
    monkeypatch.setattr(wear_course, "_of_films", lambda *_: 0.0)
    assert with_films - wear(65)["wear_error"].values == pytest.approx(of_them, rel=1e-6)


@pytest.mark.whole
def test_a_film_that_is_not_solved_ends_the_march(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lost = lambda model, at, oil, temperature: np.full(at.load.shape, np.nan)  # noqa: E731
    monkeypatch.setattr(history, "asperity_share", lost)
    films = {**MIXED, "wear.load_ratio": "film"}
    outcome = running.run_case(written(folder, MODELS + DRY, "lost.toml"), settings=films)[
        "default"
    ]
    data = outcome.parts["wear"]
    assert data.attrs["end"] == "lost" and data.sizes["step"] == 1
    told = "the loads, or films, of flanks that are worn so far were not found"
    assert told in report_page({"default": outcome})


@pytest.mark.whole
def test_report_shows_the_worn_flanks(outcome: Outcome) -> None:
    page = report_page({"default": outcome})
    assert 'id="wear"' in page
    assert "not reached: 1.5 times the least rate" in page
    assert "backlash that wear adds" in page
    assert 'data-menu="wear0_flank0"' in page
    assert "Flank as new and worn, gear 2" in page
    assert "by derivatives along the steps of the march" in page
    told = json.loads(outcome.parts["wear"].attrs["sensitivities"])
    of_load = {name: f"{value:+.3f}".replace("-", "−") for name, value in told["load"].items()}
    row = f'>load</th><td class="n">{of_load["life"]}\u00a0%</td><td class="n">{of_load["depth"]}\u00a0%</td>'
    assert row in page
    (figure,) = SECTION.answer(outcome)
    assert figure.name == "Wear depth"
    assert "after 3e6 turns of gear 1" in figure.words
    (printed,) = SECTION.screen(outcome)
    assert printed.line == "The march ended after as many turns as were asked for."
    severe = outcome.parts["wear"].assign(severe_cycles=((), 1e6))
    (figure,) = SECTION.answer(Outcome(outcome.manifest, {"wear": severe}))
    assert "; severe wear (1.5 times the least rate) begins at 1e6" in figure.words


REFUSED = {
    "a table without its law": ({"wear.cycles": 1.0}, "law: is missing"),
    "hardness without unit": (
        {"wear.law": "archard_1953", "wear.cycles": 1.0, "wear.hardness": 200},
        "has no unit",
    ),
    "no hardness": (
        {"wear.law": "archard_1953", "wear.cycles": 1.0, "materials.gear_2": "PA66"},
        "asks for the hardness of both gears, and that of gear 2 is not known",
    ),
    "zero hardness": (
        {"wear.law": "archard_1953", "wear.cycles": 1.0, "wear.hardness": "0 HV"},
        "out of range",
    ),
    "negative cycles": ({"wear.law": "archard_1953", "wear.cycles": -1.0}, "out of range"),
    "no rate": ({"wear.law": "vdi_2736", "wear.cycles": 1.0}, "asks for the specific wear rate"),
    "derivatives through films": (
        {
            "wear.law": "masjedi_khonsari_2015",
            "wear.cycles": 1.0,
            "wear.load_ratio": "film",
            "wear.sensitivities": True,
        },
        "no derivatives are taken through solved films",
    ),
    "a constant of another law": (
        {
            "wear.law": "vdi_2736",
            "wear.cycles": 1.0,
            "wear.rate": "1e-15 1/Pa",
            "wear.coefficient": 1.0,
        },
        "does not ask for it",
    ),
    "no load on asperities": (
        {"wear.law": "masjedi_khonsari_2015", "wear.cycles": 1.0, "wear.hardness": "2 GPa"},
        "asks for the load on asperities",
    ),
    "a sharing that knows no gaps": (
        {
            "wear.law": "archard_1953",
            "wear.cycles": 1.0,
            "wear.hardness": "2 GPa",
            "models.load_sharing": "equal",
        },
        "knows of none",
    ),
    "films that a law does not ask for": (
        {"wear.law": "archard_1953", "wear.cycles": 1.0, "wear.load_ratio": "film"},
        "does not ask for the load on asperities",
    ),
    "films of smooth flanks": (
        {
            "wear.law": "masjedi_khonsari_2015",
            "wear.cycles": 1.0,
            "wear.load_ratio": "film",
            "film.solver": "line",
            "film.asperities": "none",
        },
        "leaves no load on asperities",
    ),
    "another way of solving": (
        {"wear.law": "masjedi_khonsari_2015", "wear.cycles": 1.0, "wear.load_ratio": "solved"},
        "formula",
    ),
    "no such stage": (
        {"wear.law": "archard_1953", "wear.cycles": 1.0, "wear.severe_by": "depth"},
        "pressure",
    ),
    "no such result": ({"worn.file": "nowhere.nc"}, "cannot be read as a result"),
}


@pytest.mark.whole
@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_is_one_sentence(what: str, folder: Path) -> None:
    settings, words = REFUSED[what]
    with pytest.raises(InputError) as caught:
        load_case(written(folder, MODELS, "bare.toml"), settings=settings)
    told = str(caught.value)
    assert words in told
    assert told.count("\n") == 0


@pytest.mark.whole
def test_worn_flanks_belong_to_their_gears(outcome: Outcome, folder: Path) -> None:
    kept = folder / "whole" / "default" / "wear.nc"
    bare = written(folder, MODELS, "bare.toml")
    for settings, words in (
        ({"worn.file": str(kept), "gears.face_width": "21 mm"}, "wear of other gears"),
        ({"worn.file": str(kept), "worn.cycles": 4e6}, "is beyond the 3e+06 turns"),
        ({"worn.file": str(kept.with_name("stiffness.nc"))}, "holds no wear"),
        ({"worn.file": str(kept), "models.load_sharing": "equal"}, "have a gap"),
    ):
        with pytest.raises(InputError, match=words.replace("+", r"\+")):
            load_case(bare, settings=settings)
    assert json.loads(load(kept).attrs["members"]) == ["gear 1", "gear 2"]


def test_what_has_no_teeth_has_no_limit_of_them() -> None:
    ball = str(Path(__file__).parents[2] / "examples" / "ball_on_disc.toml")
    wear = {"wear.law": "vdi_2736", "wear.rate": "1e-9 mm3/(N m)", "wear.cycles": 1.0}
    for key, told in (("tip_land_limit", "with a tip"), ("backlash_limit", "with a backlash")):
        with pytest.raises(InputError, match=rf"wear.{key}: .* no teeth {told}"):
            load_case(ball, settings={**wear, f"wear.{key}": "1 um"})
    films = {"wear.law": "masjedi_khonsari_2015", "wear.load_ratio": "film", "wear.cycles": 1.0}
    with pytest.raises(InputError, match=r"wear.load_ratio: 'film' is for line contacts"):
        load_case(ball, settings={**films, "wear.hardness": "2 GPa"})


@pytest.mark.whole
def test_flanks_are_drawn_where_they_are_and_their_wear_magnified(outcome: Outcome) -> None:
    """Off the new flank by so many times the depth, along its normal, at every place of the slider."""
    panel = next(
        one for one in SECTION.blocks(Page({"default": outcome}, {})) if isinstance(one, Panel)
    )
    data, (*_, driven) = outcome.parts["wear"], panel.figures
    times = float(driven.keys[1].label.rpartition(" ")[2])
    before, after = (np.array([one["x"], one["y"]]) for one in driven.data)
    off = np.hypot(*(after - before)) / times * 1e3
    deepest = data["worn_depth"].values[-1, 1, :, 0] * 1e6
    assert sorted(off) == pytest.approx(sorted(deepest), rel=0.02, abs=0.01)
    assert np.all(after[0] < before[0])
    start = panel.choices[0].changes[driven.name][0]
    assert start["x"][0] == start["x"][1] and start["y"][0] == start["y"][1]


@pytest.mark.whole
def test_severe_wear_by_the_pressure_is_told_with_its_factor(case: str) -> None:
    given = {"wear.severe_by": "pressure", "wear.cycles": 10.0}
    page = report_page({"default": running.run_case(case, settings=given)["default"]})
    assert "not reached: 1.5 times the largest pressure at the start" in page
