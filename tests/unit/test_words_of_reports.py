"""What a report says: answers first, laws, places of loss, numbers for readers."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from pages import payload
from reported import OUTSIDE, Outcomes, Words

from pitchpoint.cases.built import ALONE
from pitchpoint.core.doubts import as_doubt, stored
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.runs.run import Outcome, open_outcomes, run_case
from pitchpoint.views import show
from pitchpoint.views.figures import laws, rounded
from pitchpoint.views.lines import gapped
from pitchpoint.views.path import contact_path
from pitchpoint.views.picture import picture_of
from pitchpoint.views.report import report_page, write_report
from pitchpoint.views.section import KeyFigure, Page, variant_warnings
from pitchpoint.views.sections import compared as comparison
from pitchpoint.views.sections.answer import ANSWER, operation_summary
from pitchpoint.views.sections.back_driving import back_driving_figure, margin_figure
from pitchpoint.views.sections.path import loss_places, loss_sentence
from pitchpoint.views.sections.sliding import specific_sliding
from pitchpoint.views.sections.spread import spread_sentence
from pitchpoint.views.sections.studies import _warnings as study_warnings
from pitchpoint.views.sections.teeth import dimension_rows


def test_oil_laws_sharing_and_misses_stand_at_the_top(page: str) -> None:
    text = Words(page).text
    top = text[: text.index("Inputs as resolved")]
    for words in (
        "mineral oil by value",
        "220 mm²/s (given) at 40 °C",
        "ISO/TR 14179-2",
        "Xu and Kahraman",
        "equal load per length of contact line",
        "gear 1 drives at 900 rpm, gear 2 carries 60 N m, oil at 60 °C",
        "1 number was not met",
        "number out of reach, Table 9: 50 % in print, 99.460 % here (made to miss)",
        "number left out, Table 9: 1 (never computed)",
        "The teeth of gear 1 are",
    ):
        assert words in top, words


def test_efficiency_and_the_spread_of_the_laws_stand_together(
    published: Outcomes, page: str
) -> None:
    outcome = published["as_published"]
    values = outcome.parts["laws"]["mean_efficiency"].values
    low, high = 100.0 * values.min(), 100.0 * values.max()
    text = Words(page).text
    for value in outcome.parts["operation"]["mean_efficiency"].values[:, 0]:
        shown = f"{show.number_text(100.0 * value)} % mean efficiency, {ALONE}"
        assert (
            f"{shown} friction laws that apply {show.number_text(low)} to {show.number_text(high)} %"
            in text
        )


def test_laws_that_nearly_agree_are_told_in_points_with_a_power_of_ten(
    published: Outcomes,
) -> None:
    """Two ends that read apart stand before what the efficiency is of, be they ever so near."""
    outcome = published["as_published"]
    holds = outcome.parts["operation"].copy(deep=True)
    laws = outcome.parts["laws"].copy(deep=True).assign_attrs(outside="[]")

    def answered(*ends: float) -> KeyFigure:
        holds["mean_efficiency"].values[:] = ends[0]
        laws["mean_efficiency"].values[:] = ends[0]
        laws["mean_efficiency"].values[-1] = ends[-1]
        parts = {**outcome.parts, "operation": holds, "laws": laws}
        figures = ANSWER.answer(replace(outcome, parts=parts))
        return next(figure for figure in figures if figure.name == "Efficiency")

    near = answered(0.9963494, 0.9963512)
    assert near.detail.endswith("; 99.63 to 99.64 % by the laws in their range; teeth alone")
    assert "; teeth alone; over the cycle " in answered(0.9963494, 0.9963495).detail


def test_laws_whose_friction_differs_are_told_with_both_coefficients(published: Outcomes) -> None:
    outcome = published["as_published"]
    ends = json.dumps([["ehl_line", 0.0214], ["xu_2007", 0.0642]])
    laws = outcome.parts["laws"].assign_attrs(friction_apart=ends)
    told = spread_sentence(replace(outcome, parts={**outcome.parts, "laws": laws}))
    sentence = "Mean friction is 0.0214 (ehl_line) to 0.0642 (xu_2007), 3 times as much."
    assert sentence in told
    known = outcome.parts["laws"]["mean_friction"].values[:, 0]
    apart = known.max() > 1.5 * known.min()
    assert ("Mean friction is" in spread_sentence(outcome)) == apart


def test_misses_come_first_and_kinds_are_counted_apart(page: str) -> None:
    text = Words(page).text
    compared = text[text.index("Printed against computed") :]
    assert compared.index("number out of reach") < compared.index("number left out")
    assert "predicted 1 miss" in compared
    assert "excluded 1 excluded" in compared
    assert "physical has no targets of its own and is not compared" in compared


def test_inputs_that_differ_are_shown_for_each_variant(page: str) -> None:
    rows = re.findall(r'<tr class="differs">(.*?)</tr>', page, re.S)
    keys = {re.sub(r"<[^>]*>", "", re.split("</t[dh]>", row)[0]).strip() for row in rows}
    assert keys == {"friction as_published", "averaging as_published", "physical"}


def test_reopened_results_give_the_same_report(published: Outcomes, report_folder: Path) -> None:
    """Beside those that the run itself gives: results of the bank are opened again too."""
    new = run_case(report_folder / "published.toml", folder=report_folder / "published")
    kept = open_outcomes(report_folder / "published")
    write_report(kept, report_folder / "report.html")
    assert (report_folder / "report.html").read_text("utf-8") == report_page(new)
    for name, one in new.items():
        told, again = (
            [(text, as_doubt(text).brief) for text in outcome.manifest["warnings"]]
            for outcome in (one, kept[name])
        )
        assert told == again
        assert any(text != brief for text, brief in again)
    assert [path.name for path in report_folder.glob(".report*")] == []


@pytest.mark.whole
def test_without_power_the_efficiency_is_undefined(idle: Outcomes) -> None:
    page = report_page(idle)
    assert "undefined, no power mean efficiency" in Words(page).text
    assert "There is no loss." in page
    assert "cycle_efficiency" not in payload(page)["figures"]
    assert "inf" not in operation_summary(idle["default"]).rows[0].values()
    assert np.isnan(idle["default"].parts["operation"]["min_efficiency"].values).all()
    cycle = idle["default"].parts["cycle"]
    for name in ("film_thickness", "lambda_ratio"):
        values = cycle[name].values[0][cycle["active"].values]
        assert np.isnan(values).all()
        assert f"along_{name}" not in payload(page)["figures"]
    assert "There is no film to compute: nothing is carried." in Words(page).text
    for heading in ("Studies", "Printed against computed", "Issues"):
        assert f"<h2>{heading}" not in page


def test_a_locked_mesh_is_said(wheel: Outcomes) -> None:
    assert "friction does not lock the mesh" in report_page(wheel)
    outcome = wheel["default"]
    back = outcome.parts["back_driving"].copy()
    back["locked"] = back["locked"] | True
    back["mean_efficiency"] = back["mean_efficiency"] * np.nan
    locked = replace(outcome, parts={**outcome.parts, "back_driving": back})
    assert "self-locking: friction locks the mesh" in report_page({"default": locked})


def test_a_drive_that_locks_or_nearly_does_is_told_among_the_first_figures(wheel: Outcomes) -> None:
    outcome = wheel["default"]
    back = outcome.parts["back_driving"].copy(deep=True)
    law = laws(back)[0]
    far = back_driving_figure(outcome, law)
    assert far.order > 60.0 and far.detail.startswith("efficiency with the output driving")
    back["nearest_friction"].values[:], back["nearest_jamming_coefficient"].values[:] = 0.25, 0.29
    near = replace(outcome, parts={**outcome.parts, "back_driving": back})
    figure = back_driving_figure(near, law)
    assert (figure.order, figure.value) == (29.0, far.value)
    assert figure.detail == "locks from μ = 0.29 on; at most 0.25 acts"
    back["locked"] = back["locked"] | True
    assert back_driving_figure(near, law).value == "self-locking"
    back["self_locking_margin"].values[:] = 0.29 / 0.25
    (margin,) = margin_figure(near, law)
    assert (margin.name, margin.value) == ("Self-locking margin", "1.16")
    assert [*margin_figure(outcome, law)] == []  # no flank has the friction that would lock it


def test_a_law_that_locks_is_named_beside_the_others(wheel: Outcomes) -> None:
    outcome = wheel["default"]
    laws = outcome.parts["laws"].copy(deep=True)
    assert laws["law"].values.tolist() == ["iso_tr_14179_2"]
    both = xr.concat([laws, laws.assign_coords(law=["xu_2007"])], "law")
    both["locked"].values[0, 0] = True
    one = replace(outcome, parts={**outcome.parts, "laws": both})
    assert "locked by ISO/TR 14179-2" in report_page({"default": one})


def test_laws_out_of_their_range_stand_apart_with_the_reason(wheel: Outcomes) -> None:
    (apart,) = json.loads(wheel["default"].parts["laws"].attrs["outside"])
    assert apart["law"] == "xu_2007"
    text = Words(report_page(wheel)).text
    assert "Out of their range here, and not counted" in text
    value = show.number_text(100 * apart["mean_efficiency"])
    assert f"{value} % its friction up to" in text
    told = operation_summary(wheel["default"]).line
    assert told.startswith("One fitted friction law of the library applies, iso_tr_14179_2")
    assert (
        f"Out of its range is xu_2007 (it would give {show.number_text(100 * apart['mean_efficiency'])} %)"
        in told
    )


def test_no_law_in_its_range_is_said(wheel: Outcomes) -> None:
    outcome = wheel["default"]
    none = outcome.parts["laws"].isel(law=[])
    one = replace(outcome, parts={**outcome.parts, "laws": none})
    assert "none of the library is in its range" in report_page({"default": one})
    assert (
        "No fitted friction law of the library is in its range here" in operation_summary(one).line
    )


LOCKS = "self-locking from a friction coefficient of"


def test_the_coefficient_that_locks_stands_beside_the_efficiency(wheel: Outcomes) -> None:
    data = wheel["default"].parts["operation"]
    limit = float(data["jamming_coefficient"].values[0, 0])
    assert limit > float(data["nearest_friction"].values[0, 0]) == pytest.approx(0.05)
    assert limit > 1.0
    told = Words(report_page(wheel)).text
    assert f"{LOCKS} above 1" in told
    assert "friction does not lock the mesh (nor would it below μ = 1)" in told
    assert operation_summary(wheel["default"]).rows[0][LOCKS] == "above 1"
    less = data.assign(jamming_coefficient=0.3 * data["jamming_coefficient"])
    rough = replace(wheel["default"], parts={**wheel["default"].parts, "operation": less})
    assert operation_summary(rough).rows[0][LOCKS] == show.number_text(0.3 * limit)
    assert f"{LOCKS} {show.number_text(0.3 * limit)}" in Words(report_page({"default": rough})).text


@pytest.mark.parametrize("kept", [(), ("teeth",), ("teeth", "cycle"), ("teeth", "operation")])
def test_an_interrupted_result_has_a_page(wheel: Outcomes, kept: tuple[str, ...]) -> None:
    outcome = wheel["default"]
    parts = {name: outcome.parts[name] for name in kept}
    manifest = {**outcome.manifest, "finished": False, "parts": list(kept)}
    page = report_page({"default": Outcome(manifest, parts)})
    assert "its computation was interrupted" in page
    assert sorted(Words(page).plots) == sorted(payload(page)["figures"])


def test_letters_that_are_close_share_a_label(outside: Outcomes) -> None:
    marks = picture_of(outside["helical, four teeth"]).svg("p")["marks"]
    names = [mark["name"] for mark in marks if mark["name"]]
    assert "A N1" in names
    assert sum(not mark["name"] for mark in marks) == 5


def test_dimensions_say_what_matters(outside: Outcomes) -> None:
    helical = {name: values for name, *values in dimension_rows(outside["helical, four teeth"])}
    assert helical["profile shift x"] == ["0.74", "−0.05"]
    assert "overlap ratio ε_β" in helical
    assert "tip alteration k [modules]" in helical
    ring = {name: values for name, *values in dimension_rows(outside["ring"])}
    assert ring["number of teeth z"] == ["20", "−60"]
    assert ring["reference diameter d [mm]"] == ["40", "120"]
    assert "overlap ratio ε_β" not in ring
    assert "base helix angle β_b [°]" not in ring
    assert ring["smallest x without undercut x_min"][1] == "not cut by a rack"


@pytest.mark.parametrize("name", OUTSIDE)
def test_specific_sliding_is_that_of_the_gears(outside: Outcomes, name: str) -> None:
    teeth = outside[name].parts["teeth"]
    places = dict(zip("ABCDE", teeth["points"].values, strict=True))
    found = specific_sliding(teeth, np.array([places["A"], places["C"], places["E"]]))
    assert found[0] == pytest.approx(teeth["specific_sliding_A"].values, rel=1e-12)
    assert found[1] == pytest.approx([0.0, 0.0], abs=1e-12)
    assert found[2] == pytest.approx(teeth["specific_sliding_E"].values, rel=1e-12)


def test_loss_places_add_up_and_follow_the_driver(published: Outcomes, wheel: Outcomes) -> None:
    outcome = published["physical"]
    shares = loss_places(outcome.parts["cycle"], 0, contact_path(outcome))
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-6)
    assert [start + end for start, end in shares] == ["AC", "CD", "DB", "BE"]
    driven = contact_path(wheel["default"])
    sentence = loss_sentence({("A", "C"): 0.25, ("C", "E"): 0.75}, driven)
    assert "75 % before the pitch point" in sentence
    assert "25 % before" in loss_sentence(
        {("A", "C"): 0.25, ("C", "E"): 0.75}, replace(driven, against="")
    )


def test_lines_stop_at_jumps() -> None:
    x, y = gapped(np.array([0.0, 0.5, 0.5 + 1e-9, 1.0]), np.array([1.0, 1.0, 2.0, 2.0]))
    assert np.isnan(y).tolist() == [False, False, True, False, False, True]
    assert x.size == 6


def test_numbers_for_readers() -> None:
    assert rounded([1.0 / 3.0, np.nan, np.inf]) == [0.33333, None, None]
    assert show.number_text(-0.00123456) == "−0.001235"
    assert show.number_text(-0.000123456) == "−1.235e−4"
    assert [show.number_text(value) for value in (999.96, 9999.7, 999999.6)] == [
        "1000",
        "10000",
        "1e6",
    ]
    assert [show.number_text(value) for value in (17.0, 101325.0, 101325.4, 0.1 + 0.2 - 0.3)] == [
        "17",
        "101325",
        "101300",
        "5.551e−17",
    ]
    assert (show.number_text(1.0 + 1e-12), show.number_text(-0.0), show.number_text(0.9956, 2)) == (
        "1",
        "0",
        "1",
    )
    assert show.number_text(float("nan")) == "undefined"
    assert show.quantity("mean_efficiency", float("nan")) == "undefined, no power"
    assert show.quantity("torque_ripple", 6e-14) == "0 N\u00a0m"
    assert show.signed(-0.00004, 3) == "0"
    assert show.pretty("98 mm2/s at 40 degC, mm2/s alone") == "98 mm²/s at 40 °C, mm2/s alone"


def test_numbers_beside_print_have_seven_digits_and_unknown_ones_are_said() -> None:
    row = TargetRow(
        "part of the time", "a table", 0.0, 0.18585924446678, "1", 1e-12, "trend", "miss", ""
    )
    assert comparison._row(row)["computed"] == "0.1858592"
    assert comparison._row(row)["deviation"] == "+0.1859"
    assert comparison._row(replace(row, computed=float("nan")))["computed"] == "not computed"
    assert comparison._row(replace(row, computed=0.0, tolerance=0.01))["computed"] == "0.000"
    whole = comparison._row(replace(row, printed=1.0, computed=1.0 + 1e-15))
    assert (whole["computed"], whole["deviation"]) == ("1", "0")
    trend = comparison._row(
        replace(row, bound="< ", unit="N/um", computed=-235.4262, tolerance=0.0)
    )
    assert (trend["computed"], trend["deviation"]) == ("−235.4 N/µm", "−235.4")
    assert (trend["printed"], trend["tolerance"]) == ("< 0 N/µm", "")


@pytest.mark.parametrize(
    ("printed", "computed", "tolerance", "told"),
    [
        (4.31e-18, 4.31002e-18, 1e-21, "4.31e−18"),
        (4e10, 4.0546758e10, 4e9, "4.055e10"),
        (2e6, 2.0123456e6, 2e4, "2.012e6"),
        (0.0, -1e-7, 0.001, "0.0000"),
    ],
)
def test_numbers_beside_print_are_written_out_as_far_as_anyone_reads(
    printed: float, computed: float, tolerance: float, told: str
) -> None:
    row = TargetRow("number", "a table", printed, computed, "1", tolerance, "reference", "pass", "")
    assert comparison._row(row)["computed"] == told


def test_what_fails_alike_in_several_variants_is_said_once() -> None:
    told = {"warm": ["Teeth melt."], "cold": ["Teeth jam."], "hot": ["Teeth melt."]}
    outcomes = {name: Outcome({"implausible": texts}, {}) for name, texts in told.items()}
    assert variant_warnings(outcomes, "implausible") == {
        "Teeth melt.": ["warm", "hot"],
        "Teeth jam.": ["cold"],
    }


def test_what_a_result_of_another_build_lacks_is_said_with_how_to_make_it_anew(
    published: Outcomes,
) -> None:
    """Whatever one of its parts lacks; a result of this build that lacks something is a fault of ours."""
    one = published["physical"]
    parts = one.parts | {
        part: one.parts[part].drop_vars(name)
        for part, name in (("strength", "mesh_load_factor"), ("cycle", "efficiency"))
    }
    with pytest.raises(KeyError, match=r"mesh_load_factor|efficiency"):
        report_page({"physical": replace(one, parts=parts)})
    surroundings = one.manifest["surroundings"] | {"code": "0123456789abcdef"}
    older = Outcome(one.manifest | {"surroundings": surroundings}, parts)
    page = report_page({"physical": older})
    assert "lacks: mesh load factor (mesh_load_factor). Make it anew: " in page
    assert "<code>pitchpoint run FOLDER/physical/manifest.json</code>" in page
    assert "(efficiency). Make it anew: " in page


def test_a_warning_of_several_studies_is_said_once() -> None:
    def with_study(title: str, *told: str) -> Outcome:
        study = xr.Dataset(attrs={"title": title, **stored(told)})
        return Outcome({"warnings": []}, {f"study_{title}": study})

    several = {"warm": with_study("Load", "Teeth jam."), "cold": with_study("Load", "Teeth jam.")}
    assert study_warnings(Page(several, {})) == ["warm and cold, Load: Teeth jam."]
    apart = {"warm": with_study("Load", "Teeth jam."), "cold": with_study("Speed", "Teeth jam.")}
    assert study_warnings(Page(apart, {})) == ["warm, Load; cold, Speed: Teeth jam."]
    alone = {"default": with_study("Load", "Teeth jam.", "Oil boils.")}
    assert study_warnings(Page(alone, {})) == ["Load: Teeth jam.", "Load: Oil boils."]
