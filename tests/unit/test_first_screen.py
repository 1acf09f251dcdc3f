"""The first screen: a dozen lines of eighty characters that answer, with every number whole."""

import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from unittest.mock import Mock

import bank
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from screens import REPORT, faults_of_the_screen, screen

from pitchpoint.cases.built import ALONE, LACKING
from pitchpoint.core.doubts import Doubt
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.runs import run
from pitchpoint.runs.run import Outcome
from pitchpoint.views import one_page, show
from pitchpoint.views.columns import fitted
from pitchpoint.views.figures import curves
from pitchpoint.views.film_courses import contact_place, film_key_figure, films_sentence
from pitchpoint.views.first_screen import (
    FEW_LINES,
    aligned,
    beside_each_other,
    swept_beside,
)
from pitchpoint.views.point import by_bodies, by_members, member_names, of_stage_by_bodies
from pitchpoint.views.section import KeyFigure, Page, SectionTable, key_figures, variant_warnings
from pitchpoint.views.section_registry import in_order
from pitchpoint.views.sections import answer, beside
from pitchpoint.views.sections.inspection import INSPECTION
from pitchpoint.views.sections.strength import strength_rows
from pitchpoint.views.sections.studies import extrapolated_note

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="module")
def pair() -> dict[str, Outcome]:
    return bank.outcomes(EXAMPLES / "pair_23_61.toml")


def doubting(outcome: Outcome, **sentences: list[str]) -> Outcome:
    return replace(outcome, manifest={**outcome.manifest, **sentences})


def shown(outcomes: Mapping[str, Outcome], width: int = 80) -> list[str]:
    lines = screen(outcomes, width)
    assert len(lines) <= FEW_LINES
    assert all(len(line) <= width for line in lines)
    return lines


def test_a_sweep_that_was_asked_for_stands_below_the_answer(pair: dict[str, Outcome]) -> None:
    """Point by point, what is known at some of them; a long one is left to its tables."""
    known = {"mean_efficiency": [0.98, np.nan], "mean_loss": [12.5, 30.0]}
    values = {name: (("law", "point"), np.array([each])) for name, each in known.items()}
    told = {"sweep_key": "operation.speed", "axis_kind": "rotational speed", "axis_unit": "rpm"}
    speeds = {"axis": (("point",), np.array([500.0, 3000.0]) * np.pi / 30.0)}
    swept = xr.Dataset({**values, **speeds}, {"law": ["xu_2007"]}, told)

    def run(data: xr.Dataset) -> dict[str, Outcome]:
        parts = {**pair["default"].parts, "study_sweep_operation_speed": data}
        return {"default": replace(pair["default"], parts=parts)}

    assert swept_beside(run(swept)) == [
        [
            {"operation.speed": "500 rpm", "efficiency [%]": "98", "loss [W]": "12.5"},
            {"operation.speed": "3000 rpm", "efficiency [%]": "–", "loss [W]": "30"},
        ]
    ]
    beyond = swept.assign(extrapolated=(("law", "point"), np.array([[True, False]])))
    ((first, second),) = swept_beside(run(beyond))
    assert first["efficiency [%]"] == "98†" and second["efficiency [%]"] == "–"
    assert "out of its range" in extrapolated_note([first.values(), second.values()])
    assert extrapolated_note([second.values()]) == ""
    assert swept_beside(run(xr.concat([swept] * 13, "point", data_vars="all"))) == []
    assert swept_beside(pair) == []


def test_a_pair_answers_in_a_dozen_lines(pair: dict[str, Outcome]) -> None:
    data = pair["default"].parts["operation"]
    efficiency, ripple = (float(data[name][0, 0]) for name in ("mean_efficiency", "torque_ripple"))
    title, at, *figures = shown(pair)
    assert title == "pair_23_61.toml (default)"
    assert at.startswith("gear 1 at 1500 rpm, gear 2 with 50 N m, oil 60 °C, friction iso_tr")
    by_name = {line.split("  ")[0]: line for line in figures}
    assert f"{show.number_text(100 * efficiency)} %" in by_name["Efficiency"]
    assert f"{ripple:.4g} N m peak to peak" in by_name["Input"]
    assert {"Loss", "Stress of flanks", "Stress of roots", "Backlash"} <= {*by_name}
    assert "no safety: materials.gear_1 has no limits" in by_name["Stress of flanks"]
    assert figures[-1].startswith(f"Report: {REPORT}")
    assert figures[-1].endswith("; tables by --full: answer, strength")  # it has no other tables


def test_a_report_without_a_title_is_headed_by_its_gears(pair: dict[str, Outcome]) -> None:
    assert Page(pair, {}).title == "Spur pair 23/61"
    titled = {"default": doubting(pair["default"], title="A title")}  # type: ignore[arg-type]
    assert Page(titled, {}).title == "A title"
    assert (
        Page({"one": pair["default"], "two": pair["default"]}, {}, designs=True).title
        == "one · two"
    )


def test_films_that_are_solved_stand_before_what_follows_from_the_speeds_of_a_rig() -> None:
    (rig,) = bank.outcomes(EXAMPLES / "ball_on_disc.toml").values()
    place = {figure.name: figure.order for figure in key_figures(in_order(), rig)}
    solved = film_key_figure("Films of finite contacts", "0.205 µm at least").order
    assert [*place][:3] == [
        "film thickness",
        "film thickness over composite Rq",
        "largest Hertz pressure",
    ]
    assert place["largest Hertz pressure"] < solved < place["mean friction coefficient"]
    assert place["mean input torque"] < place["entrainment velocity"]


def test_what_the_grid_makes_a_film_off_stands_beside_its_value() -> None:
    known = {"smallest_film": 6.8126e-8, "smallest_lambda": 0.09, "largest_asperity_share": 0.5}
    counts = {"solved_contacts": 12, "loaded_contacts": 12, "mean_film_loss": np.nan}
    data = xr.Dataset(
        {**known, **counts}, attrs={"choices": '{"thermal": "isothermal"}', "assumed": ""}
    )
    errors = {"largest_central_film_error": 0.0234, "largest_minimum_film_error": 0.0751}
    lines = {**errors, "largest_minimum_film_error": np.nan}, errors
    unknown, told = (
        film_key_figure("Films solved", films_sentence(data.assign(one))) for one in lines
    )
    assert (unknown.value, told.value) == ("0.06813 µm", "0.06813 µm ±7.5 %")
    both = films_sentence(data.assign({**errors, "smallest_central_film": 9e-8}))
    assert both.startswith(
        "0.09 µm ±2.3 % at least in the middle of a contact, 0.06813 µm ±7.5 % anywhere"
    )


def test_a_contact_that_is_the_only_one_has_neither_phase_nor_pair() -> None:
    film = xr.DataArray(np.ones((3, 1, 1)), dims=("phase", "pair", "line"))
    rig = xr.Dataset({"minimum_film": film}, {"phase": [0.0, 0.3, 0.7]})
    assert contact_place(rig, 0, 0, 0) == "the only contact"
    gears = xr.concat([rig, rig], "pair")
    gears["minimum_film"] = gears["minimum_film"].transpose("phase", "pair", "line")
    assert contact_place(gears, 1, 1, 0) == "phase 0.300, pair II"


def test_members_of_a_train_are_inspected_by_their_names(pair: dict[str, Outcome]) -> None:
    train = replace(
        pair["default"], manifest={**pair["default"].manifest, "bodies": "sun and planet"}
    )
    tables = [
        one
        for one in INSPECTION.shows(Page({"default": train}, {}))
        if isinstance(one, SectionTable)
    ]
    assert ["dimension", "sun", "planet"] in [[*table.head] for table in tables]
    assert any("turn of planet, the other one held" in row[0] for row in tables[0].rows)


def test_variants_of_a_set_stand_beside_each_other_by_its_members(
    pair: dict[str, Outcome], monkeypatch: pytest.MonkeyPatch
) -> None:
    meshes = [
        {"number": k, "bodies": "sun and planet", "members": ["sun", "planet"]} for k in (1, 2)
    ]
    planetary = {"table": "gears", "key": "family", "value": "planetary", "status": "given"}
    outcome = doubting(pair["default"], stages=meshes, inputs=[planetary])
    known = [KeyFigure(1.0, "Safety", "2.5", "detail", beside="2.5 at sun of stage 1")]
    monkeypatch.setattr("pitchpoint.views.first_screen.key_figures", lambda *_: known)
    *_, row = beside_each_other({"first": outcome, "second": outcome})
    assert row == {"": "Safety", "first": "2.5 at sun", "second": "2.5 at sun"}


def test_a_set_without_stages_of_its_own_is_told_by_its_members(
    pair: dict[str, Outcome], monkeypatch: pytest.MonkeyPatch
) -> None:
    """On the screen, at the top of the report and on its page that prints."""
    meshes = [
        {"number": k, "bodies": bodies, "members": ["gear 1", "gear 2"]}
        for k, bodies in ((1, "sun and planet"), (2, "planet and ring"))
    ]
    planetary = {"table": "gears", "key": "family", "value": "planetary", "status": "given"}
    rows = [*pair["default"].manifest["inputs"], planetary]
    (own, of_stages) = (
        doubting(pair["default"], stages=meshes, inputs=inputs) for inputs in (rows, [])
    )
    told = {
        "at planet of stage 2; no safety": "at planet in ring mesh; no safety",
        "at sun of stage 1": "at sun",
        "Doubtful: Stage 1: xu_2007: thin": "Doubtful: Sun mesh: xu_2007: thin",
        "Stage 2: gear 2: a rim": "Ring mesh: ring: a rim",
        "Stages 1 and 2: K_A = 1": "Both meshes: K_A = 1",
        "Backlash, stages 1 and 2": "Backlash, both meshes",
        "at stage 1": "at sun mesh",
    }
    assert {text: by_members(own, text) for text in told} == told
    assert [by_members(of_stages, text) for text in told] == [*told]
    figures = [KeyFigure(10.0, "Film ratio", "0.17", "at stage 2")]
    monkeypatch.setattr(answer, "key_figures", lambda *_: figures)
    monkeypatch.setattr(one_page, "key_figures", lambda *_: figures)
    page = Page({"default": own}, curves({"default": own}))
    assert answer._variant(page, "default", own)["tiles"][0].detail == "at ring mesh"
    assert one_page._results(page, own).rows[0][2] == "at ring mesh"


def test_a_short_detail_is_whole() -> None:
    figures = [KeyFigure(0.0, "Inertia", "3.644 kg cm²", "pinion"), KeyFigure(1.0, "Loss", "2 W")]
    assert [line.text for line in aligned(figures, 80)] == [
        "Inertia  3.644 kg cm²  pinion",
        "Loss     2 W",
    ]


def test_what_a_case_asks_for_by_a_key_of_its_own_stands_before_what_follows(
    pair: dict[str, Outcome],
) -> None:
    film = {"table": "models", "key": "film_thickness", "value": "dowson_higginson_1977"}

    def names(status: str) -> list[str]:
        rows = [*pair["default"].manifest["inputs"], {**film, "status": status}]
        asked = doubting(pair["default"], inputs=rows)
        return [figure.name for figure in key_figures(in_order(), asked)]

    usual, asked = names("default"), names("given")
    assert usual.index("Stress of roots") < usual.index("Backlash") < usual.index("Film ratio")
    assert asked.index("Stress of roots") < asked.index("Film ratio") < asked.index("Backlash")


def test_safeties_stand_behind_the_efficiency_where_a_case_has_a_table_on_strength(
    pair: dict[str, Outcome],
) -> None:
    life = {"table": "strength", "key": "life", "value": 1.0, "status": "given"}
    rated = doubting(pair["default"], inputs=[*pair["default"].manifest["inputs"], life])
    names = [figure.name for figure in key_figures(in_order(), rated)]
    assert names[:3] == ["Efficiency", "Stress of flanks", "Stress of roots"]


def test_figures_that_do_not_fit_in_are_named_with_what_shows_them(
    pair: dict[str, Outcome],
) -> None:
    told = [f"Gear {place} is thin, and nothing says why that should be so." for place in "abc"]
    doubtful = {"default": doubting(pair["default"], warnings=told)}
    names = [figure.name for figure in key_figures(in_order(), doubtful["default"])]
    lines = shown(doubtful)
    left_out = names[sum(line.startswith(tuple(names)) for line in lines) :]
    assert lines[-2] == f"By --full: {', '.join(left_out).lower()}"
    assert left_out == ["Film ratio", "Back-driving", "Hertz pressure"]
    every = screen(doubtful, tables=False)
    assert all(any(line.startswith(name) for line in every) for name in names)
    assert not any(line.startswith("By --full") for line in [*every, *shown(pair)])


def test_a_law_in_the_place_of_that_of_the_case_is_told() -> None:
    """At this speed the film is too thin for the only law of the case, and one of the library answers."""
    only = {"models.friction": "xu_2007", "operation.speed": "600 rpm", "roughness.ra": "0.8 um"}
    lines = shown(bank.outcomes(EXAMPLES / "pair_23_61.toml", settings=only))
    (efficiency,) = [line for line in lines if line.startswith("Efficiency")]
    assert "friction iso_tr_14179_2" in lines[1]
    assert "% by xu_2007 of the case out of its range" in efficiency


@pytest.mark.whole
@pytest.mark.parametrize(
    "name", ["ball_on_disc", "rack_and_pinion", "spur_wear", "torus", "two_stage"]
)
def test_other_kinds_answer_on_one_screen(name: str) -> None:
    """`tests/long/every_report.py` looks at all examples."""
    assert [*faults_of_the_screen(bank.outcomes(EXAMPLES / f"{name}.toml"))] == []


def test_the_teeth_alone_are_no_headline_of_a_drive(pair: dict[str, Outcome]) -> None:
    """Where no loss stands for the bearing inside a drive, its efficiency is not known."""
    outcome = pair["default"]
    data = outcome.parts["operation"].copy(deep=True)
    told = {"covers": ALONE, "lacks": LACKING}
    data["mean_efficiency"] = data["mean_efficiency"].assign_attrs(told)
    alone = replace(outcome, parts={**outcome.parts, "operation": data})
    every, figures = key_figures(in_order(), outcome), key_figures(in_order(), alone)
    assert (figures[0].name, figures[0].value) == ("Efficiency", "not known")
    (teeth,) = [figure for figure in figures if figure.name == "Efficiency without it"]
    assert teeth.value == next(one.value for one in every if one.name == "Efficiency")
    assert "teeth alone" in teeth.detail
    assert any(
        re.match("Efficiency  +not known +lacks the bearing of the wave generator$", line)
        for line in shown({"": alone})
    )


def test_a_drive_of_stages_without_losses_has_the_efficiency_of_its_teeth(
    pair: dict[str, Outcome],
) -> None:
    outcome = doubting(pair["default"], stages=[{"number": 1, "title": "stage 1"}])
    data = outcome.parts["operation"].copy(deep=True)
    for covers, name in ((ALONE, "Efficiency of teeth"), ("", "Efficiency")):
        data["mean_efficiency"] = data["mean_efficiency"].assign_attrs(covers=covers)
        drive = replace(outcome, parts={**outcome.parts, "operation": data})
        assert key_figures(in_order(), drive)[0].name == name


@pytest.mark.parametrize("width", [40, 60, 100])
def test_no_number_is_cut(pair: dict[str, Outcome], width: int) -> None:
    assert [*faults_of_the_screen(pair, width)] == []


def test_what_fails_stands_before_what_is_doubtful_and_both_are_counted(
    pair: dict[str, Outcome],
) -> None:
    outcome = doubting(
        pair["default"],
        implausible=["Fails: teeth melt."],
        warnings=[
            f"doubt {k}, of which much is said in very many words: 1.5 mm too far" for k in "abc"
        ],
    )
    lines = shown({"default": outcome})
    assert lines[0] == "Fails: teeth melt."
    assert lines[3].startswith("Doubtful: doubt a") and "b," not in lines[3]
    assert lines[4] == "2 more of this kind are in the report."
    assert lines[5].startswith("Efficiency")


@pytest.mark.parametrize("width", [40, 80])
def test_what_is_doubtful_is_never_cut(pair: dict[str, Outcome], width: int) -> None:
    """A doubt shows its brief; what has none goes on lines of its own, or is counted where it is too long."""
    words = "off by 40 %, of which much more could be said on a screen that had more room for it"
    long = " ".join(f"word{k}" for k in range(90))
    brief = Doubt("off by 20 %, at length.", brief="off by 20 %.")
    text = " ".join(
        shown({"default": doubting(pair["default"], warnings=[brief, Doubt(words)])}, width)
    )
    assert "Doubtful: off by 20 %. Doubtful: " in text and words in text
    lines = shown({"default": doubting(pair["default"], warnings=[brief, Doubt(long)])}, width)
    assert "word1" not in " ".join(lines)
    assert "1 more of this kind is in the report." in lines


@pytest.mark.whole
def test_a_drive_of_stages_tells_ratio_output_speed_and_what_is_doubtful_of_a_stress() -> None:
    outcomes = bank.outcomes(EXAMPLES / "two_stage.toml")
    lines = shown(outcomes)
    at = "shaft 1 at 1500 rpm, shaft 3 at 153.5 rpm with 300 N m, ratio 9.77117, oil 60 °C"
    assert lines[1] == at
    (outcome,) = outcomes.values()
    by_name = {one.name: one.detail for one in key_figures(in_order(), outcome)}
    assert re.match(
        r"later losses add 0\.\d+ % \(roots 1\.1 %\); at gear 2 of stage 1; no ",
        by_name["Stress of roots"],
    )
    assert any(line.startswith("Torsional stiffness") for line in lines)
    assert not any(line.startswith("Backlash") for line in lines)  # no allowance is given
    rows = {row[""]: row["default"] for row in beside_each_other(outcomes)}
    assert rows["Ratio"] == "9.77117" and rows["Backlash at the output"].endswith(" nominal")
    manifest = {**outcome.manifest, "stages": [dict(one) for one in outcome.manifest["stages"]]}
    manifest["stages"][0]["bodies"] = "sun and planet"
    train = replace(outcome, manifest=manifest)
    assert member_names(train, 1) == {"gear 1": "sun", "gear 2": "planet"}
    assert [row["gear"] for row in strength_rows(train)] == ["sun", "planet", "gear 1", "gear 2"]


def by_another_law(outcome: Outcome) -> Outcome:
    operation = outcome.parts["operation"].isel(law=[0]).assign_coords(law=["another"])
    return replace(outcome, parts={"operation": operation})


def test_variants_stand_side_by_side(pair: dict[str, Outcome]) -> None:
    one = pair["default"]
    two = {"default": one, "bad": doubting(one, warnings=["tips are pointed."])}
    assert "Doubtful: bad: tips are pointed." in shown(two)
    rows = beside_each_other(two)
    assert [row[""] for row in rows] == [figure.name for figure in key_figures(in_order(), one)]
    assert all(row["default"] == row["bad"] for row in rows)
    first, another = one.parts["operation"], by_another_law(one).parts["operation"]
    both = replace(one, parts={**one.parts, "operation": xr.concat([first, another], "law")})
    rows = {row[""]: row for row in beside_each_other({"default": one, "both": both})}
    assert rows["by other laws"]["default"] == "–"
    efficiency = show.quantity("mean_efficiency", float(first["mean_efficiency"].values[0, 0]))
    assert rows["by other laws"]["both"].endswith(f"{efficiency} another")
    averaged = replace(one, manifest=one.manifest | {"averaging": "path"})
    law, mean, *_ = beside_each_other({"default": one, "other": by_another_law(averaged)})
    assert law[""] == "Friction" and law["default"] != law["other"] == "another"
    assert mean == {"": "Mean over", "default": "base_pitch", "other": "path"}


def test_printed_numbers_of_variants_take_a_line_each_where_there_is_no_room(
    pair: dict[str, Outcome],
) -> None:
    row = TargetRow("loss", "Table 1", 1.0, 1.0, "W", 0.1, "predicted", "pass", "").as_json()
    missed = row | {"verdict": "miss", "expected_miss": True}
    rows = [row, missed, row | {"kind": "reference"}, missed | {"kind": "reference"}]
    long = " ".join(["the film is thin at the pitch point;"] * 10)
    every = {
        name: doubting(pair["default"], rows=rows, implausible=[f"Fails: {long}"])
        for name in ("first", "second", "third", "fourth")
    }
    lines = shown(every)
    met = [line.partition(":")[0] for line in lines if "printed numbers: 1 met" in line]
    assert met == [*every]
    assert "Missed: loss" in lines


def test_rows_that_are_missed_beyond_two_lines_are_counted_with_the_command_that_lists_them(
    pair: dict[str, Outcome],
) -> None:
    row = TargetRow("", "Table 1", 1.0, 2.0, "W", 0.1, "predicted", "miss", "").as_json()
    rows = [row | {"quantity": f"efficiency by Method {k} at the pitch point"} for k in range(9)]
    lines = shown({"default": doubting(pair["default"], rows=rows)})
    (first,) = (k for k, line in enumerate(lines) if line.startswith("Missed: "))
    assert lines[first + 1].endswith("and 7 more: pitchpoint compare results/pair")


def test_rows_of_a_result_are_compared_without_another_run(
    pair: dict[str, Outcome], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where these programs wrote it and finished it; else the case is computed."""
    row = TargetRow("efficiency", "Table 1", 1.0, 2.0, "1", 0.1, "predicted", "miss", "").as_json()
    kept = doubting(pair["default"], rows=[row], finished=True, surroundings=run.surroundings())
    (tmp_path / run.RUN).write_text("{}", "utf-8")
    monkeypatch.setattr(run, "selected_variants", lambda *_: pytest.fail("computed anew"))
    for change in ({}, {"finished": False}, {"rows": []}, {"surroundings": {"code": "older"}}):
        made = {"default": doubting(kept, **change)}
        monkeypatch.setattr(run, "open_outcomes", lambda _, made=made: made)
        if change:
            with pytest.raises(pytest.fail.Exception, match="computed anew"):
                run.compare_case(str(tmp_path))
        else:
            _, variant, rows = run.compare_case(str(tmp_path))
            assert (variant, [one.as_json() for one in rows]) == ("default", [row])


def test_key_figures_are_named_once(pair: dict[str, Outcome]) -> None:
    names = [figure.name for figure in key_figures(in_order(), pair["default"])]
    assert len({*names}) == len(names)


@given(st.text("ab 1.5,;(", max_size=60), st.integers(10, 40))
def test_clauses_fit_and_end_at_a_word(sentence: str, width: int) -> None:
    whole = show.one_line(sentence)
    cut = show.first_clauses(sentence, width)
    begin = cut.removesuffix(" …")
    assert whole.startswith(begin)
    ends = (" ", "; ", ", ", ". ")  # a word, or a clause
    assert cut == whole or whole[len(begin) :].startswith(ends) or " " not in begin


CELLS = st.lists(st.text("abc 1", max_size=30), min_size=3, max_size=3)


@given(st.lists(CELLS, min_size=1, max_size=4), st.integers(8, 60))
def test_columns_fit_and_keep_words_whole(cells: list[list[str]], width: int) -> None:
    names = ["key", "a number [mm]", "note"]
    rows = [dict(zip(names, row, strict=True)) for row in cells]
    blocks = fitted(rows, names, width)
    assert [name for block in blocks for name in block if name != "key"] == names[1:]
    for block in blocks:
        assert next(iter(block)) == "key"
        assert len(block) == 2 or sum(block.values()) + len(block) - 1 <= width
        for name, size in block.items():
            words = [word for text in (name, *(row[name] for row in rows)) for word in text.split()]
            assert size == width or size >= max(map(len, words))


def test_sentences_on_a_mesh_of_a_train_name_its_bodies():
    mesh = {"number": 2, "members": ["gear 1", "gear 2"], "bodies": "planet and ring"}
    train = Mock(spec=Outcome, manifest={**mesh, "stages": [mesh]})
    assert by_bodies(train, "Gear 2 has teeth. A at the tip of gear 2; gear 1 drives.") == (
        "The ring has teeth. A at the tip of the ring; the planet drives."
    )
    rim = of_stage_by_bodies(train, "stage 2: gear 2: a rim; gear 1 too")
    assert rim == "stage 2: ring: a rim; the planet too"
    assert of_stage_by_bodies(train, "stage 1: gear 2: a rim") == "stage 1: gear 2: a rim"
    named = {**mesh, "bodies": "gear 2 and gear 3", "stages": [{**mesh, "number": "2 (of a set)"}]}
    other = Mock(spec=Outcome, manifest=named)
    assert by_bodies(other, 'gear 1 drives gear 2 of "gear 2.csv"') == (
        'gear 2 drives gear 3 of "gear 2.csv"'
    )
    assert of_stage_by_bodies(other, "stage 2 (of a set): gear 2 turns") == (
        "stage 2 (of a set): the ring turns"
    )
    pair = Mock(spec=Outcome, manifest={"members": ["gear 1", "gear 2"]})
    assert by_bodies(pair, "tip of gear 2") == "tip of gear 2"


def test_designs_beside_each_other_name_the_bodies_of_their_own():
    pair = {"number": 1, "members": ["gear 1", "gear 2"]}
    designs = {
        name: Mock(
            spec=Outcome, manifest={"stages": [stage], "warnings": ["Stage 1: gear 2 bends."]}
        )
        for name, stage in (("set", pair | {"bodies": "sun and planet"}), ("drive", pair))
    }
    assert variant_warnings(designs, "warnings", of_stage_by_bodies) == {
        "Stage 1: the planet bends.": ["set"],
        "Stage 1: gear 2 bends.": ["drive"],
    }


def test_values_and_axes_have_a_unit_without_powers_of_ten():
    assert show.handy([2.038e-8, 8.014e-5], "kg m2") == (
        [pytest.approx(0.2038), pytest.approx(801.4)],
        "g cm2",
    )
    assert show.handy([7.893e7, 85850.0, 0.0], "kg cm2")[1] == "kg m2"
    assert show.handy([0.0, 0.259], "N m") == ([0.0, 0.259], "N m")
    curves = [{"y": [2.59e-4, None], "hovertemplate": "%{y} N\u00a0m"}]
    look = {"yaxis": {"title": {"text": "T [N\u00a0m]"}}}
    beside.in_smaller_unit(curves, look, "N m")
    assert curves == [{"y": [pytest.approx(0.259), None], "hovertemplate": "%{y} mN\u00a0m"}]
    assert look["yaxis"]["title"]["text"] == "T [mN\u00a0m]"
