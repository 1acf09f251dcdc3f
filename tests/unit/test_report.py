"""The report: complete, safe with what a user typed, and its drawn teeth really touch."""

import json
import re
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np
import pytest
import xarray as xr
from pages import decoded, payload
from plotly.offline import get_plotlyjs
from reported import TITLE, Outcomes, Words
from sound import quick_first

from pitchpoint.core.doubts import stored
from pitchpoint.runs.run import Outcome
from pitchpoint.units import convert, kind_of, kinds, parse, units_of
from pitchpoint.views import show
from pitchpoint.views.figures import Figure, Panel, curves, laws, line_heights
from pitchpoint.views.outlines import visible_points
from pitchpoint.views.report import report_page
from pitchpoint.views.section import Paragraph, naming
from pitchpoint.views.sections.cycle import _mean_friction
from pitchpoint.views.sections.loss_map import map_panel
from pitchpoint.views.sections.studies import study_panels

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
    spelled = {show.display_unit(one): one for kind in kinds() for one in units_of(kind)}
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
    before, after = (
        payload(report_page(published, units=chosen))["figures"] for chosen in ({}, CHOSEN)
    )
    units_seen = set()
    for name, figure in before.items():
        for axis in "xy":
            old, new = (unit_of_axis(one, axis) for one in (figure, after[name]))
            assert new not in {show.display_unit(unit) for unit in ONCE}, name
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
    assert "throughout, to four digits." in report_page(alike)


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
    assert "2 doubtful; first: The flank" in re.sub(
        r"<[^>]*>", "", report_page({"physical": doubtful})
    )


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
    assert "that of the laws in their range: under " in report_page(cut)


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
    page = report_page(cut)
    assert not any(name.startswith("study_shape") for name in payload(page)["figures"])
    parts = re.findall(r"<caption[^>]*>Few values: addendum.*?</table>", page, re.S)
    assert {one.count('<th scope="row">') for one in parts} == {2 * 3}
    assert max(one.count('scope="col" class="n"') for one in parts) <= 12
    table = "".join(parts)
    assert "The same in all rows: Study Shape" in page
    data = cut["physical"].parts["study_shape"]
    for value in data["mean_efficiency"].values[0]:
        assert f'<td class="n">{show.number_text(100 * value)}</td>' in table


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
    page = report_page(cut)
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
    told = re.findall(r"<caption[^>]*>Few values: addendum.*?</table>", report_page(cut), re.S)
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
    page = report_page(request.getfixturevalue(case))
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
    page = report_page({evil: published["physical"], "other": published["as_published"]})
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


@pytest.mark.parametrize("span", [0.00123, 0.9, 1.0, 4.999, 25.0, 7.7e5])
def test_heights_of_a_line_stand_on_the_fewest_levels_that_can_be_seen(span: float) -> None:
    values = np.linspace(-0.3 * span, 0.7 * span, 100_001)
    heights = np.array(line_heights([*values, np.nan], 1000)[:-1])
    levels = len(np.unique(heights))
    assert 1000 <= levels <= 2502
    assert np.max(np.abs(heights - values)) < 0.51 * span / 1000
