"""The report: complete, safe with what a user typed, and its drawn teeth really touch."""

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from html.parser import HTMLParser
from importlib.metadata import version
from math import atan2, cos, pi, sin
from pathlib import Path
from typing import Any

import bank
import numpy as np
import pytest
import xarray as xr
from pages import decoded, payload
from plotly.offline import get_plotlyjs
from records import entries
from sound import quick_first

from pitchpoint.cases.built import ALONE
from pitchpoint.doubts import as_doubt, stored
from pitchpoint.gears.bodies import drawing
from pitchpoint.gears.cylindrical.design import build_cylindrical_pair
from pitchpoint.gears.cylindrical.family import FAMILY
from pitchpoint.gears.family import Family
from pitchpoint.gears.mesh import Mesh
from pitchpoint.gears.nominal_motion import (
    mesh_ends,
    nominal_motion,
    nominal_period,
    phase_sense,
)
from pitchpoint.gears.pairs import way
from pitchpoint.gears.rack_and_pinion.family import FAMILY as RACK_FAMILY
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.programs import program
from pitchpoint.results.store import dataset
from pitchpoint.results.target_rows import TargetRow
from pitchpoint.runs.run import Outcome, open_result, run
from pitchpoint.units import convert, kind_of, kinds, parse, units_of
from pitchpoint.views import show
from pitchpoint.views.explorer import Reader
from pitchpoint.views.figures import Figure, Panel, curves, laws, line_heights, rounded
from pitchpoint.views.lines import gapped
from pitchpoint.views.outlines import visible_points
from pitchpoint.views.path import path_of
from pitchpoint.views.picture import Picture, PictureBody, picture_of
from pitchpoint.views.point import period_of
from pitchpoint.views.report import render, write_report
from pitchpoint.views.section import KeyFigure, Page, Paragraph, naming, told_of_variants
from pitchpoint.views.sections import compared as comparison
from pitchpoint.views.sections.answer import ANSWER, summary
from pitchpoint.views.sections.back_driving import back_driving_figure, margin_figure
from pitchpoint.views.sections.cycle import _mean_friction
from pitchpoint.views.sections.loss_map import map_panel
from pitchpoint.views.sections.path import loss_places, loss_sentence
from pitchpoint.views.sections.sliding import specific_sliding
from pitchpoint.views.sections.spread import spread_sentence
from pitchpoint.views.sections.studies import _warnings as study_warnings
from pitchpoint.views.sections.studies import study_panels
from pitchpoint.views.sections.teeth import dimensions

Outcomes = dict[str, Outcome]

TITLE = "<script>alert('title')</script>"
PUBLISHED = f"""
title = "{TITLE}"
[gears]
teeth = [23, 61]
module = "2 mm"
face_width = {{ value = "15 mm", status = "assumed", note = "</script><b>" }}
profile_shift = [0.4, -0.2]
addendum = 1.4
[lubricant]
base = "mineral"
viscosity_40 = "220 mm2/s"
viscosity_100 = "19 mm2/s"
[roughness]
rq = "0.1 um"
[operation]
torque = "60 N m"
speed = "900 rpm"
temperature = "60 degC"
[loss_map]
count = 3
[variants.as_published.models]
friction = ["iso_tr_14179_2", "xu_2007"]
averaging = "path"
[variants.physical.models]
friction = "constant"
[studies.point]
title = "One point"
[studies.shape]
title = "Shape"
sweep = {{ key = "gears.addendum", start = 1.0, stop = 1.4, count = 3 }}
[[targets]]
quantity = "number out of reach"
where = "Table 9"
kind = "predicted"
printed = 50.0
unit = "%"
tolerance = 0.01
study = "point"
variable = "mean_efficiency"
reason = "made to miss"
[[targets]]
quantity = "number left out"
where = "Table 9"
kind = "excluded"
printed = 1.0
reason = "never computed"
[[issues]]
where = "eq. 1"
issue = "<i>slip</i>"
verdict = "`physical` differs"
"""
IDLE = """
[gears]
teeth = 17
module = "2 mm"
face_width = "15 mm"
flank = "right"
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
torque = "0 N m"
speed = "100 rpm"
temperature = "60 degC"
[loss_map]
count = 2
"""
WHEEL = """
[gears]
teeth = [12, 120]
module = "2 mm"
face_width = "15 mm"
profile_shift = [0.5, 0.0]
[lubricant]
name = "75W90-A"
[roughness]
ra = "0.4 um"
[operation]
driver = "gear 2"
torque = "5 N m"
speed = "100 rpm"
temperature = "60 degC"
[models]
friction = "constant"
[loss_map]
count = 2
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("report")


def computed(folder: Path, name: str, text: str) -> Outcomes:
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return bank.outcomes(folder / f"{name}.toml")


@pytest.fixture(scope="module")
def published(folder: Path) -> Outcomes:
    return computed(folder, "published", PUBLISHED)


@pytest.fixture(scope="module")
def idle(folder: Path) -> Outcomes:
    return computed(folder, "idle", IDLE)


@pytest.fixture(scope="module")
def wheel(folder: Path) -> Outcomes:
    return computed(folder, "wheel", WHEEL)


@pytest.fixture(scope="module")
def page(published: Outcomes) -> str:
    return render(published)


class Words(HTMLParser):
    """What a reader sees, and the identities of the places for figures."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.plots: list[str] = []
        self.tags: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        known = dict(attrs)
        if known.get("class") == "plot" and "data-figure" not in known:
            self.plots.append(str(known["id"]))

    def handle_data(self, data: str) -> None:
        if self.tags[-1:] not in (["script"], ["style"]):
            self.words.append(data)

    def handle_endtag(self, tag: str) -> None:
        self.tags.append(f"/{tag}")

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


CHOSEN = {
    "length": "in",
    "small length": "nm",
    "torque": "N cm",
    "rotational speed": "rad/s",
    "pressure": "psi",
    "power": "mW",
    "force": "lbf",
    "velocity": "mm/s",
    "small time": "us",
    "stiffness": "N/mm",
}
ONCE = ("mm", "um", "N m", "rpm", "MPa", "W", "N", "m/s", "ms", "N/um")
"""Usual units of these kinds."""


def unit_of_axis(figure: dict[str, Any], axis: str) -> str:
    """Unit in the title of an axis; empty where there is none."""
    title = figure["layout"].get(f"{axis}axis", {}).get("title", {}).get("text", "")
    return next(iter(re.findall(r"\[([^\[\]]+)\]$", title)), "")


def in_unit(values: list[float | None], old: str, new: str) -> list[float]:
    """Values of an axis in another unit, both as printed."""
    spelled = {show.unit(one): one for kind in kinds() for one in units_of(kind)}
    old, new = spelled[old], spelled[new]
    kind = kind_of(old)
    return [
        np.nan if value is None else convert(parse(f"{value!r} {old}", kind), new, kind)
        for value in values
    ]


def finite(trace: dict[str, Any]) -> bool:
    return any(
        value is not None for value in np.ravel(np.array(trace.get("z", trace["y"]), object))
    )


def test_every_figure_has_a_place_and_data(page: str) -> None:
    figures, plots = payload(page)["figures"], Words(page).plots
    assert sorted(plots) == sorted(figures)
    # Specific sliding, path, cycle, study with both stresses, map.
    assert len(plots) == 1 + 8 + 4 + (4 + 2) + 2
    for name, figure in figures.items():
        assert figure["data"], name
        assert all(finite(trace) for trace in figure["data"]), name


def test_the_page_that_sums_up_has_gears_results_figures_and_assumptions(page: str) -> None:
    summed = page[page.index('id="one-page"') : page.index("</header>")]
    text = " ".join(Words(summed).text.split())
    for words in (
        "number of teeth z",
        "centre distance",
        "Efficiency",
        "Loss",
        "Oil",
        "Load sharing",
    ):
        assert words in text
    assert "Inputs assumed, fitted or corrected: " in text
    assert "inputs are not given and taken as usual" in text
    assert f"Computed with Pitchpoint {version('pitchpoint')}, code " in text
    assert len(re.findall(r'class="plot" id="one-page-[^"]+" data-figure=', summed)) == 2


def test_a_figure_of_one_variant_names_it() -> None:
    figure, words = Figure("name", "Title", [], {}), Paragraph("words")
    (panel, same) = naming("cold", [Panel("", [figure]), words])
    assert [one.title for one in panel.figures] == ["Title · cold"]
    assert same is words
    (panel,) = naming("", [Panel("", [figure])])
    assert panel.figures == [figure]


def test_a_course_keeps_every_point_that_can_be_seen() -> None:
    x = np.linspace(0.0, 1.0, 2001)
    y = np.where(np.abs(x - 0.5) < 0.1, np.nan, np.sin(4.0 * x))
    kept = visible_points(x, y)
    assert kept.size < 60
    assert np.count_nonzero(np.isnan(y[kept])) == 1
    left = x < 0.4
    within = kept[left[kept]]
    off = np.interp(x[left], x[within], y[within]) - y[left]
    pixel = (np.nanmax(y) - np.nanmin(y)) / 240.0
    # 0.8 pixels across the course, which is nowhere steeper than 49 degrees.
    assert np.abs(off).max() < 1.25 * pixel


def test_a_menu_changes_traces_that_exist(page: str) -> None:
    content = payload(page)
    assert {len(choices) for choices in content["menus"].values()} == {2, 3 * 3}
    for choices in content["menus"].values():
        for name, change in ((n, c) for choice in choices for n, c in choice.items()):
            traces = content["figures"][name]["data"]
            which = change[2] if len(change) > 2 else range(len(traces))
            assert all(len(values) == len(list(which)) for values in change[0].values())


def test_figures_change_with_the_units_of_their_axes(published: Outcomes) -> None:
    """Each axis whose unit is chosen has the same values in that unit; no other changes."""
    before, after = (payload(render(published, units=chosen))["figures"] for chosen in ({}, CHOSEN))
    units_seen = set()
    for name, figure in before.items():
        for axis in "xy":
            old, new = (unit_of_axis(one, axis) for one in (figure, after[name]))
            assert new not in {show.unit(unit) for unit in ONCE}, name
            pairs = zip(figure["data"], after[name]["data"], strict=True)
            for one, other in ((a.get(axis), b.get(axis)) for a, b in pairs):
                if one is None or old == new:
                    assert one == other
                    continue
                units_seen.add(new)
                told = [np.nan if value is None else value for value in other]
                np.testing.assert_allclose(told, in_unit(one, old, new), rtol=2e-3, atol=1e-9)
    assert {"N cm", "psi", "nm"} <= units_seen


def test_maps_share_one_scale_and_have_lines_with_labels(page: str, published: Outcomes) -> None:
    content = payload(page)
    drawn = content["figures"]["map_mean_loss"]["data"][0]
    every = [choice["map_mean_loss"][0]["z"][0] for choice in content["menus"]["map_mean_loss"]]
    values = np.array(every, float)
    assert len(every) == 3 * 3
    assert drawn["z"] in every
    assert (drawn["zmin"], drawn["zmax"]) == pytest.approx((values.min(), values.max()), rel=1e-4)
    for choice in content["menus"]["map_mean_loss"]:
        told = choice["map_mean_loss"][0]
        start, end, size = (told[f"contours.{key}"][0] for key in ("start", "end", "size"))
        assert np.min(told["z"][0]) < start
        assert end < np.max(told["z"][0])
        assert 3 <= round((end - start) / size) <= 10
    assert drawn["type"] == "contour"
    assert drawn["contours"]["showlabels"]
    menus = re.findall(
        r'<select data-menu="map_mean_loss" data-step="(\d)">(.*?)</select>', page, re.S
    )
    assert [(int(step), entries.count("<option")) for step, entries in menus] == [(3, 3), (1, 3)]


def test_a_map_that_four_digits_do_not_tell_apart_is_a_line(published: Outcomes) -> None:
    outcome = published["physical"]
    whole = outcome.parts["loss_map"]
    even = whole.assign(mean_efficiency=0.98 + 1e-7 * whole["mean_efficiency"])
    alike = {"physical": replace(outcome, parts={**outcome.parts, "loss_map": even})}
    panel = map_panel(alike, curves(alike))
    (loss,) = panel.figures
    assert panel.note == "Mean efficiency: 98 % throughout, to four digits."
    assert loss.data[0]["showscale"] and "throughout" not in loss.remarks
    assert {name for choice in panel.choices for name in choice.changes} == {"map_mean_loss"}
    assert "throughout, to four digits." in render(alike)


def test_maps_of_variants_that_differ_but_are_even_have_one_colour(published: Outcomes) -> None:
    outcome = published["physical"]
    whole = outcome.parts["loss_map"]

    def of(value: float) -> Outcome:
        data = whole.assign(mean_efficiency=value + 1e-7 * whole["mean_efficiency"])
        return replace(outcome, parts={**outcome.parts, "loss_map": data})

    two = {"physical": of(0.98), "other": of(0.9)}
    _, drawn = map_panel(two, curves(two)).figures
    heat = drawn.data[0]
    values = [value for row in heat["z"] for value in row if value is not None]
    assert values
    assert max(values) - min(values) < 1e-2 * (heat["zmax"] - heat["zmin"])
    assert heat["contours"]["start"] > max(values) and heat["showscale"] is False
    assert "98 % throughout, to four digits." in drawn.remarks


def test_a_pair_that_carries_nothing_has_no_friction() -> None:
    load = np.array([[[[2.0, 1.0], [0.0, 0.0]], [[0.0, 3.0], [1.0, 0.0]]]])
    friction = np.where(load > 0.0, [0.03, 0.06], 0.0)
    dims = "law", "node", "pair", "slice"
    cycle = xr.Dataset({"load": (dims, load), "friction": (dims, friction)})
    np.testing.assert_allclose(_mean_friction(cycle, 0), [[0.04, np.nan], [0.06, 0.03]])
    idle = cycle.assign(load=0.0 * cycle["load"], friction=0.0 * cycle["friction"] + 0.05)
    np.testing.assert_allclose(_mean_friction(idle, 0), 0.05)


def test_what_is_doubtful_of_a_part_counts_at_the_top(published: Outcomes) -> None:
    outcome = published["physical"]
    told = "the flank stress leaves out a point"
    strength = outcome.parts["strength"].assign_attrs(stored([told]))
    doubtful = replace(
        outcome,
        parts={**outcome.parts, "strength": strength},
        manifest={**outcome.manifest, "warnings": [told, "tips are thin"]},
    )
    assert "2 doubtful; first: The flank" in re.sub(r"<[^>]*>", "", render({"physical": doubtful}))


def test_the_scale_of_maps_is_that_of_laws_in_their_range(published: Outcomes) -> None:
    losses = {
        (name, law): float(one.parts["loss_map"]["mean_loss"].sel(law=law).max())
        for name, one in published.items()
        for law in laws(one.parts["loss_map"])
    }
    (variant, law), others = max(losses, key=lambda k: losses[k]), sorted(losses.values())[:-1]
    outside = json.dumps([{"law": law, "mean_efficiency": 0.9, "reasons": ["too thin a film"]}])
    odd = published[variant]
    told = odd.parts["laws"].assign_attrs(outside=outside)
    cut = {**published, variant: replace(odd, parts={**odd.parts, "laws": told})}
    panel = map_panel(cut, curves(cut))
    assert panel.figures[0].data[0]["zmax"] == pytest.approx(others[-1])
    assert max(losses.values()) > 1.02 * others[-1]
    assert "that of the laws in their range: under " in render(cut)


def test_an_explorer_draws_every_stage_and_turns_each_at_its_speed(
    wheel: Outcomes, published: Outcomes
) -> None:
    read = Reader()
    drive, second = wheel["default"], published["physical"]
    point = read(drive, {2: drive, 1: second})
    assert point.drawing == [0, 1]
    assert [one.title for one in read.drawings] == ["Stage 2", "Stage 1"]
    assert point.pace == pytest.approx([1.0, period_of(drive).time / period_of(second).time])
    assert read(drive).drawing == [2]
    assert read(drive, {2: drive, 1: second}).drawing == [0, 1]


@pytest.mark.whole
def test_a_drive_draws_the_teeth_of_every_stage() -> None:
    """Each with its own numbers: gear 2 of stage 1 has 61 teeth, that of stage 2 has 70."""
    text = render(bank.outcomes(Path(__file__).parents[2] / "examples" / "two_stage.toml"))
    assert [f'id="mesh{number}-close"' in text for number in range(3)] == [True, True, False]
    tables = re.findall(r"number of teeth z.*?</tr>", text, re.S)
    numbers = [re.findall(r">(\d+)<", table) for table in tables]
    assert numbers[:2] == [["23", "61"], ["19", "70"]]


def test_maps_of_the_efficiency_begin_above_rest(page: str) -> None:
    drawn = payload(page)["figures"]["map_mean_efficiency"]["data"][0]
    assert None not in np.ravel(drawn["z"]).tolist()
    assert min(drawn["x"]) == pytest.approx(675.0)
    assert "From 675\u00a0rpm and 45\u00a0N\u00a0m on, the smallest" in page


def test_sweeps_of_two_points_are_one_table(published: Outcomes) -> None:
    cut = {
        name: replace(
            one, parts={**one.parts, "study_shape": one.parts["study_shape"].isel(point=[0, 2])}
        )
        for name, one in published.items()
    }
    page = render(cut)
    assert not any(name.startswith("study_shape") for name in payload(page)["figures"])
    parts = re.findall(r"<caption[^>]*>Few values: addendum.*?</table>", page, re.S)
    assert {one.count('<th scope="row">') for one in parts} == {2 * 3}
    assert max(one.count('scope="col" class="n"') for one in parts) <= 12
    table = "".join(parts)
    assert "The same in all rows: Study Shape" in page
    data = cut["physical"].parts["study_shape"]
    for value in data["mean_efficiency"].values[0]:
        assert f'<td class="n">{show.number(100 * value)}</td>' in table


def test_tables_of_studies_leave_out_what_does_not_vary(published: Outcomes) -> None:
    """Rows without loss stand apart, and what is the same in all rows stands above them."""

    def lossless(data: xr.Dataset) -> xr.Dataset:
        none = {name: 0.0 * data[name] for name in ("mean_loss", "torque_ripple", "mean_friction")}
        full = {
            f"{end}_efficiency": 0.0 * data["mean_loss"] + 1.0 for end in ("mean", "min", "max")
        }
        return data.assign({**none, **full}).assign_attrs(title="Idle")

    cut = {}
    for name, one in published.items():
        two = one.parts["study_shape"].isel(point=[0, 2])
        cut[name] = replace(
            one, parts={**one.parts, "study_shape": two, "study_idle": lossless(two)}
        )
    page = render(cut)
    every = re.findall(
        r"<caption[^>]*>(Few values: addendum[^<]*)</caption>(.*?)</table>", page, re.S
    )
    tables: dict[str, str] = {}
    for caption, rows_of_part in every:
        tables[caption] = tables.get(caption, "") + rows_of_part
    (with_loss, without) = tables.values()
    assert "mean efficiency" in with_loss
    assert "Idle" not in with_loss
    assert not re.findall("100.00|efficiency|power loss|ripple|friction coefficient", without)
    rows = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row) for row in without.split("<tr>")[2:]]
    assert "The same in all rows: Study Idle" in page
    columns = [*zip(*rows, strict=True)]
    assert len(columns) > 2
    assert all(len({*column}) > 1 for column in columns)


def test_quantities_beyond_what_a_page_has_room_for_stand_in_a_table_of_their_own(
    published: Outcomes,
) -> None:
    """Names of studies and laws stand on the left in both, in words; every quantity once."""
    names = ("mean_stiffness", "stiffness_variation", "transmission_error_range")
    cut = {}
    for name, one in published.items():
        two = one.parts["study_shape"].isel(point=[0, 2])
        two = two.assign({more: (k + 1.0) * two["mean_loss"] for k, more in enumerate(names)})
        cut[name] = replace(one, parts={**one.parts, "study_shape": two})
    told = re.findall(r"<caption[^>]*>Few values: addendum.*?</table>", render(cut), re.S)
    heads = [re.findall(r'<th scope="col"( class="n")?>(.*?)</th>', table) for table in told]
    assert [each[0] for each in heads] == [("", "Friction law")] * 2
    assert [each[1][1] for each in heads] == ["addendum of both basic racks [modules]"] * 2
    quantities = [head for each in heads for _, head in each[2:]]
    assert len(quantities) == len({*quantities}) > 12
    assert max(map(len, heads)) < 12


def test_sweeps_of_one_key_share_their_figures(published: Outcomes) -> None:
    again = {
        name: replace(
            one,
            parts={
                **one.parts,
                "study_later": one.parts["study_shape"].assign_attrs(title="Later"),
            },
        )
        for name, one in published.items()
    }
    (panel,) = study_panels(again, curves(again))
    assert [menu.words for menu in panel.menus] == ["Study", "Shown against"]
    assert panel.menus[0].labels == ["Shape", "Later"]
    assert len(panel.choices) == 4
    names = [figure.name.removeprefix("study_shape_") for figure in panel.figures]
    assert len(names) == 6
    assert names[4:] == ["largest_contact_stress", "largest_root_stress"]  # no limits are known


def test_tables_have_captions_and_scopes(page: str) -> None:
    tables = re.findall(r"<table.*?</table>", page, re.S)
    assert len(tables) > 10
    for table in tables:
        assert re.search(r"<caption[^>]*>[^<\s]", table), table[:200]
        assert not re.search(r"<th(?! scope=)[ >]", table), table[:200]


@pytest.mark.parametrize("case", quick_first(["published", "idle", "wheel"]))
def test_no_text_is_not_a_number(case: str, request: pytest.FixtureRequest) -> None:
    page = render(request.getfixturevalue(case))
    text = Words(page).text
    assert not re.search(r"\b(nan|none|null|inf|infinity)\b", _unnamed(text), re.I)
    payload(page)


def _unnamed(text: str) -> str:
    """Text without the names of models: `none` is that of an effect that is left out."""
    absent = r"(rolling_resistance|inlet_heating|asperity_load) none|no rolling resistance none"
    return re.sub(absent, "", text)


def test_what_a_user_typed_is_text(page: str) -> None:
    assert "<script>alert" not in page
    assert "<i>slip" not in page
    assert "</script><b>" not in page
    words = Words(page)
    assert TITLE in words.text
    assert "</script><b>" in words.text
    # Figures, plotly.js and the page's own script.
    assert words.tags.count("script") == 3


def test_names_of_variants_cannot_end_the_script(published: Outcomes) -> None:
    evil = "</script><img src=x>"
    page = render({evil: published["physical"], "other": published["as_published"]})
    assert "<img" not in page.replace(_plotly(page), "")
    names = {t.get("name") for f in payload(page)["figures"].values() for t in f["data"]}
    assert any("&lt;/script&gt;" in str(name) for name in names)


def _plotly(page: str) -> str:
    (found,) = re.findall(r'<script type="text/plain" id="plotly">(.*?)</script>', page, re.S)
    return str(found)


def test_the_page_holds_plotly_without_maps_and_space_in_a_third_of_its_size(page: str) -> None:
    script, whole = decoded(_plotly(page)).decode(), get_plotlyjs()
    modules = re.compile(r"\w+=W\(\(\w*,?\w*\)=>\{")
    assert modules.findall(script) == modules.findall(whole)  # texts within them alone are cut
    # The worker of older ones is not a text of its own and stays.
    older = int(version("plotly").partition(".")[0]) < 7
    least, part, most = (1e5, 0.42, 3e6) if older else (6e5, 0.35, 2.7e6)
    assert len(whole) - len(script) > least and script.startswith(whole[:250])
    assert len(_plotly(page)) < part * len(whole)
    assert len(page.encode()) < most


def test_nothing_is_loaded_from_elsewhere(page: str) -> None:
    own = page.replace(_plotly(page), "")
    assert not re.search(r"""(src|href)=["'](?!#)""", own)
    assert "default-src 'none'" in own


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
        shown = f"{show.number(100.0 * value)} % mean efficiency, {ALONE}"
        assert (
            f"{shown} friction laws that apply {show.number(low)} to {show.number(high)} %" in text
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


@pytest.mark.parametrize("span", [0.00123, 0.9, 1.0, 4.999, 25.0, 7.7e5])
def test_heights_of_a_line_stand_on_the_fewest_levels_that_can_be_seen(span: float) -> None:
    values = np.linspace(-0.3 * span, 0.7 * span, 100_001)
    heights = np.array(line_heights([*values, np.nan], 1000)[:-1])
    levels = len(np.unique(heights))
    assert 1000 <= levels <= 2502
    assert np.max(np.abs(heights - values)) < 0.51 * span / 1000


def test_inputs_that_differ_are_shown_for_each_variant(page: str) -> None:
    rows = re.findall(r'<tr class="differs">(.*?)</tr>', page, re.S)
    keys = {re.sub(r"<[^>]*>", "", re.split("</t[dh]>", row)[0]).strip() for row in rows}
    assert keys == {"friction as_published", "averaging as_published", "physical"}


def test_reopened_results_give_the_same_report(published: Outcomes, folder: Path) -> None:
    """Beside those that the run itself gives: results of the bank are opened again too."""
    new = run(folder / "published.toml", folder=folder / "published")
    kept = open_result(folder / "published")
    write_report(kept, folder / "report.html")
    assert (folder / "report.html").read_text("utf-8") == render(new)
    for name, one in new.items():
        told, again = (
            [(text, as_doubt(text).brief) for text in outcome.manifest["warnings"]]
            for outcome in (one, kept[name])
        )
        assert told == again
        assert any(text != brief for text, brief in again)
    assert [path.name for path in folder.glob(".report*")] == []


@pytest.mark.whole
def test_without_power_the_efficiency_is_undefined(idle: Outcomes) -> None:
    page = render(idle)
    assert "undefined, no power mean efficiency" in Words(page).text
    assert "There is no loss." in page
    assert "cycle_efficiency" not in payload(page)["figures"]
    assert "inf" not in summary(idle["default"]).rows[0].values()
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
    assert "friction does not lock the mesh" in render(wheel)
    outcome = wheel["default"]
    back = outcome.parts["back_driving"].copy()
    back["locked"] = back["locked"] | True
    back["mean_efficiency"] = back["mean_efficiency"] * np.nan
    locked = replace(outcome, parts={**outcome.parts, "back_driving": back})
    assert "self-locking: friction locks the mesh" in render({"default": locked})


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
    assert "locked by ISO/TR 14179-2" in render({"default": one})


def test_laws_out_of_their_range_stand_apart_with_the_reason(wheel: Outcomes) -> None:
    (apart,) = json.loads(wheel["default"].parts["laws"].attrs["outside"])
    assert apart["law"] == "xu_2007"
    text = Words(render(wheel)).text
    assert "Out of their range here, and not counted" in text
    value = show.number(100 * apart["mean_efficiency"])
    assert f"{value} % its friction up to" in text
    told = summary(wheel["default"]).line
    assert told.startswith("One fitted friction law of the library applies, iso_tr_14179_2")
    assert (
        f"Out of its range is xu_2007 (it would give {show.number(100 * apart['mean_efficiency'])} %)"
        in told
    )


def test_no_law_in_its_range_is_said(wheel: Outcomes) -> None:
    outcome = wheel["default"]
    none = outcome.parts["laws"].isel(law=[])
    one = replace(outcome, parts={**outcome.parts, "laws": none})
    assert "none of the library is in its range" in render({"default": one})
    assert "No fitted friction law of the library is in its range here" in summary(one).line


LOCKS = "self-locking from a friction coefficient of"


def test_the_coefficient_that_locks_stands_beside_the_efficiency(wheel: Outcomes) -> None:
    data = wheel["default"].parts["operation"]
    limit = float(data["jamming_coefficient"].values[0, 0])
    assert limit > float(data["nearest_friction"].values[0, 0]) == pytest.approx(0.05)
    assert limit > 1.0
    told = Words(render(wheel)).text
    assert f"{LOCKS} above 1" in told
    assert "friction does not lock the mesh (nor would it below μ = 1)" in told
    assert summary(wheel["default"]).rows[0][LOCKS] == "above 1"
    less = data.assign(jamming_coefficient=0.3 * data["jamming_coefficient"])
    rough = replace(wheel["default"], parts={**wheel["default"].parts, "operation": less})
    assert summary(rough).rows[0][LOCKS] == show.number(0.3 * limit)
    assert f"{LOCKS} {show.number(0.3 * limit)}" in Words(render({"default": rough})).text


@pytest.mark.parametrize("kept", [(), ("teeth",), ("teeth", "cycle"), ("teeth", "operation")])
def test_an_interrupted_result_has_a_page(wheel: Outcomes, kept: tuple[str, ...]) -> None:
    outcome = wheel["default"]
    parts = {name: outcome.parts[name] for name in kept}
    manifest = {**outcome.manifest, "finished": False, "parts": list(kept)}
    page = render({"default": Outcome(manifest, parts)})
    assert "its computation was interrupted" in page
    assert sorted(Words(page).plots) == sorted(payload(page)["figures"])


PHASES = np.linspace(0.0, 0.999, 9)
OUTSIDE = {
    "helical, four teeth": {
        "teeth": (4, 51),
        "helix_angle": np.deg2rad(20.0),
        "profile_shift": (0.74, 0.05),
        "least_tip": 0.25,
    },
    "helical, right flanks": {
        "teeth": (19, 33),
        "helix_angle": np.deg2rad(15.0),
        "right_flank": True,
    },
    "ring": {"teeth": (20, -60), "addendum": (1.0, 0.8), "profile_shift": (0.3, 0.2)},
    "helical ring, gear 2 drives": {
        "teeth": (17, -50),
        "addendum": (1.0, 0.8),
        "profile_shift": (0.3, 0.2),
        "helix_angle": np.deg2rad(18.0),
        "driver": 2,
    },
}


def shown(driver: int = 1, **changes: Any) -> Outcome:
    """A result that holds nothing but the teeth of a pair."""
    pair = build_cylindrical_pair(
        module=0.002, pressure_angle=np.deg2rad(20.0), face_width=0.016, **changes
    )
    outcome = drawn_teeth(pair, FAMILY, f"gear {driver}", ["gear 1", "gear 2"])
    outcome.manifest["inputs"] += entries(
        {"gears.module": 0.002, "gears.profile_shift": [0.74, -0.05]}
    )
    return outcome


RACK = RackAndPinionGears.model_validate(
    {"teeth": 20.0, "module": "3 mm", "face_width": "25 mm", "helix_angle": "12 deg"}
)


def racked(driver: str = "pinion") -> Outcome:
    """A result that holds nothing but the teeth of a rack and pinion."""
    mesh, _ = RACK_FAMILY.build(RACK, 2)
    return drawn_teeth(mesh, RACK_FAMILY, driver, ["pinion", "rack"])


DRAWING = program(drawing)


def drawn_teeth(mesh: Mesh, family: Family, driver: str, members: list[str]) -> Outcome:
    """The part `teeth` of a mesh, and the record that a picture needs."""
    numbers = {name: np.asarray(value) for name, value in DRAWING(mesh).items()}
    teeth = dataset(
        {n: (family.drawing.get(n, ("gear",)[: v.ndim]), v) for n, v in numbers.items()},
        dict(family.coordinates),
        title="teeth",
    )
    motion = nominal_motion(mesh, *mesh_ends(mesh, driver))
    teeth["points"].attrs.update(way(mesh).attributes(members))
    inputs = {
        "operation.torque": 5.0,
        "operation.speed": 60.0 * pi,
        "operation.temperature": 333.15,
    }
    manifest = {
        "inputs": entries(inputs),
        "driver": driver,
        "members": members,
        "motion": motion.tolist(),
        "period": float(nominal_period(mesh, motion)),
        "travels": ["driver"] if driver == "rack" else [],
        "pitch": "base pitch",
        "against": f"{driver} drives" if phase_sense(mesh, motion) < 0.0 else "",
    }
    return Outcome(manifest, {"teeth": teeth})


@pytest.fixture(scope="module")
def outside() -> Outcomes:
    return {name: shown(**changes) for name, changes in OUTSIDE.items()}


@pytest.fixture(
    params=[
        "published",
        pytest.param("idle", marks=pytest.mark.whole),
        "wheel",
        *OUTSIDE,
        "rack",
    ]
)
def drawn(request: pytest.FixtureRequest, outside: Outcomes) -> Picture:
    if request.param in OUTSIDE:
        return picture_of(outside[request.param])
    if request.param == "rack":
        return picture_of(racked())
    outcomes: Outcomes = request.getfixturevalue(request.param)
    return picture_of(next(iter(outcomes.values())))


def teeth(drawn: Picture, phase: float) -> Iterator[tuple[int, np.ndarray]]:
    """Gear and corners in mm of every tooth as the page places it, y downwards."""
    for gear, placed in enumerate(drawn.svg("p")["bodies"]):
        corners = np.array([p.split(",") for p in placed["tooth"].split()], float)
        place = np.array(placed["place"]) + phase * np.array(placed["travel"])
        for repeat in placed["repeats"]:
            kind, _, numbers = repeat.rstrip(")").partition("(")
            turn = float(numbers) if kind == "rotate" else 0.0
            moved = np.array(numbers.split(), float) if kind == "translate" else np.zeros(2)
            angle = np.deg2rad(placed["turn"] + phase * placed["spin"] + turn)
            turned = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
            yield gear, (corners + moved) @ turned.T + place


def distance(point: np.ndarray, corners: np.ndarray) -> float:
    """Distance of a point from a polyline."""
    start, along = corners[:-1], np.diff(corners, axis=0)
    length = np.maximum((along**2).sum(axis=1), 1e-12)
    where = np.clip(((point - start) * along).sum(axis=1) / length, 0.0, 1.0)
    return float(np.hypot(*(start + where[:, None] * along - point).T).min())


def test_drawn_flanks_touch_where_the_contacts_are(drawn: Picture) -> None:
    motion = drawn.svg("p")["motion"]
    touched = 0
    for phase in PHASES:
        placed = list(teeth(drawn, phase))
        for lane in range(int(motion["total"]) + 1):
            if not 0.0 <= phase + lane - motion["behind"] <= motion["ratio"]:
                continue
            point = np.array(motion["start"]) + np.array(motion["step"]) * (phase + lane)
            for gear in (0, 1):
                nearest = min(distance(point, corners) for one, corners in placed if one == gear)
                assert nearest < 0.003, (phase, lane, gear)
            touched += 1
    assert touched / PHASES.size == pytest.approx(motion["ratio"], abs=0.2)


def test_contacts_are_those_that_the_page_shows(drawn: Picture) -> None:
    motion = drawn.svg("p")["motion"]
    for phase in PHASES:
        lanes = phase + np.arange(int(motion["total"]) + 2)
        inside = (lanes >= motion["behind"]) & (lanes - motion["behind"] <= motion["ratio"])
        shown = np.array(motion["start"]) + np.outer(lanes[inside], motion["step"])
        expected = np.array(drawn.contacts(phase)).reshape(-1, 2) * [1e3, -1e3]
        assert shown == pytest.approx(expected, abs=1e-3)


def test_drawn_teeth_do_not_overlap(drawn: Picture) -> None:
    for phase in PHASES:
        placed = list(teeth(drawn, phase))
        for corners in (corners for gear, corners in placed if gear == 1):
            assert depth(drawn, corners, phase) < 0.005


def depth(drawn: Picture, corners: np.ndarray, phase: float) -> float:
    """How far corners lie inside the involutes of gear 1 [mm]."""
    first = drawn.bodies[0]
    turn = first.turned + phase * first.spin
    radii = np.hypot(*corners.T) * 1e-3
    near = (first.levels["base"] < radii) & (radii < first.levels["tip"])
    deepest = 0.0
    for radius, (x, y) in zip(radii[near], corners[near], strict=True):
        half = first.pitch / 2.0
        off = abs((atan2(-x, -y) - turn + half) % first.pitch - half)
        deepest = max(deepest, 1e3 * radius * (half_angle(first, radius) - off))
    return deepest


def half_angle(body: PictureBody, radius: float) -> float:
    """Half the angle of its tooth as drawn at a radius."""
    right = body.tooth[: len(body.tooth) // 2]
    radii = np.hypot(*right.T)
    order = np.argsort(radii, kind="stable")
    angles = np.abs(np.arctan2(right[:, 0], right[:, 1]))
    return float(np.interp(radius, radii[order], angles[order]))


def test_the_line_of_action_is_tangent_to_both_base_circles(drawn: Picture) -> None:
    marks, step = dict(drawn.marks), drawn.teeth["contact_step"].values
    assert ("N2" in marks) == drawn.bodies[1].turns
    for body, mark in zip(drawn.bodies, ("N1", "N2"), strict=True):
        if body.turns:
            arm = np.array(marks[mark]) - body.place
            assert np.hypot(*arm) == pytest.approx(body.levels["base"], rel=1e-12)
            assert arm @ step == pytest.approx(0.0, abs=1e-9 * np.hypot(*arm) * np.hypot(*step))
    assert (drawn.bodies[1].place[1] < 0.0) == drawn.bodies[1].ring


def test_contact_moves_with_the_driving_flank(drawn: Picture) -> None:
    """Both flanks move along the line of action at the speed of the contact."""
    step = drawn.teeth["contact_step"].values
    along = step / np.hypot(*step)
    point = drawn.teeth["contact_start"].values
    for body in drawn.bodies:
        x, y = point - body.place
        moved = body.spin * np.array([-y, x]) + body.travel
        assert moved @ along == pytest.approx(np.hypot(*step), rel=1e-9)


@pytest.mark.parametrize("name", ["ring", "helical ring, gear 2 drives"])
def test_teeth_of_a_ring_point_inwards(outside: Outcomes, name: str) -> None:
    drawn = picture_of(outside[name])
    assert drawn.bodies[1].levels["tip"] < drawn.bodies[1].levels["root"]
    picture = drawn.svg("p")["bodies"][1]
    assert picture["ring"]
    assert picture["levels"]["rim"] > picture["levels"]["root"]
    assert picture["place"][1] > 0.0  # below: the page counts downwards
    spins = [gear["spin"] for gear in drawn.svg("p")["bodies"]]
    assert spins[0] * spins[1] > 0.0


def test_who_turns_where(outside: Outcomes) -> None:
    words = {name: picture_of(one).svg("p")["moves"] for name, one in outside.items()}
    assert words["helical, four teeth"] == "Gear 1 drives, turning counter-clockwise"
    assert words["helical, right flanks"] == "Gear 1 drives, turning clockwise"
    assert words["helical ring, gear 2 drives"] == "Gear 2 drives, turning clockwise"
    assert picture_of(racked()).svg("p")["moves"] == "Pinion drives, turning counter-clockwise"
    assert picture_of(racked("rack")).svg("p")["moves"] == "Rack drives, travelling to the right"


def test_a_pinion_with_few_teeth_is_drawn_whole(outside: Outcomes) -> None:
    drawn = picture_of(outside["helical, four teeth"])
    left, top, width, height = drawn.svg("p")["window"]
    tip = 1e3 * drawn.bodies[0].levels["tip"]
    assert left < -tip
    assert left + width > tip
    assert top + height > tip


def test_letters_that_are_close_share_a_label(outside: Outcomes) -> None:
    marks = picture_of(outside["helical, four teeth"]).svg("p")["marks"]
    names = [mark["name"] for mark in marks if mark["name"]]
    assert "A N1" in names
    assert sum(not mark["name"] for mark in marks) == 5


def test_dimensions_say_what_matters(outside: Outcomes) -> None:
    helical = {name: values for name, *values in dimensions(outside["helical, four teeth"])}
    assert helical["profile shift x"] == ["0.74", "−0.05"]
    assert "overlap ratio ε_β" in helical
    assert "tip alteration k [modules]" in helical
    ring = {name: values for name, *values in dimensions(outside["ring"])}
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
    shares = loss_places(outcome.parts["cycle"], 0, path_of(outcome))
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-6)
    assert [start + end for start, end in shares] == ["AC", "CD", "DB", "BE"]
    driven = path_of(wheel["default"])
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
    assert show.number(-0.00123456) == "−0.001235"
    assert show.number(-0.000123456) == "−1.235e−4"
    assert [show.number(value) for value in (999.96, 9999.7, 999999.6)] == ["1000", "10000", "1e6"]
    assert [show.number(value) for value in (17.0, 101325.0, 101325.4, 0.1 + 0.2 - 0.3)] == [
        "17",
        "101325",
        "101300",
        "5.551e−17",
    ]
    assert (show.number(1.0 + 1e-12), show.number(-0.0), show.number(0.9956, 2)) == ("1", "0", "1")
    assert show.number(float("nan")) == "undefined"
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
    assert told_of_variants(outcomes, "implausible") == {
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
        render({"physical": replace(one, parts=parts)})
    surroundings = one.manifest["surroundings"] | {"code": "0123456789abcdef"}
    older = Outcome(one.manifest | {"surroundings": surroundings}, parts)
    page = render({"physical": older})
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
