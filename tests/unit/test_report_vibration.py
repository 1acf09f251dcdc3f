"""Plane of action, stiffness, vibration and design chart in the report, from results made by hand."""

import json
import re
from dataclasses import replace
from typing import Any

import equinox as eqx
import numpy as np
import pytest
import xarray as xr
from pages import payload
from vibration_outcome import (
    BESIDE,
    UNSTABLE,
    outcome,
    pair_of,
    resonance,
    stiffness,
    teeth_of,
    vibration,
)

from pitchpoint._jax import jnp
from pitchpoint.gears.cylindrical.pair import CylindricalPair
from pitchpoint.results.by_stage import by_stage, of_stage
from pitchpoint.results.store import dataset
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.figures import Figure, Panel, continued
from pitchpoint.views.path import contact_path
from pitchpoint.views.report import report_page
from pitchpoint.views.section import Page, SectionTable, panels
from pitchpoint.views.section_registry import STIFFNESS, WEAR
from pitchpoint.views.sections.cycle import CYCLE
from pitchpoint.views.sections.design_chart import design_charts
from pitchpoint.views.sections.joint import joint_panel
from pitchpoint.views.sections.path import loss_places, points_along_path
from pitchpoint.views.sections.plane_of_action import PlaneOfAction, plane_of_action
from pitchpoint.views.sections.sliding import sliding_figure
from pitchpoint.views.sections.stiffness import stiffness_answer, stiffness_panels
from pitchpoint.views.sections.vibration import (
    VIBRATION,
    _gaps,
    resonance_panels,
    vibration_answer,
    vibration_panels,
)

EVIL = "</script><img src=x>"
contacts_of = eqx.filter_jit(CylindricalPair.contacts)


@pytest.fixture(scope="module")
def helical() -> CylindricalPair:
    return pair_of(
        teeth=(4, 51),
        helix_angle=np.deg2rad(20.0),
        profile_shift=(0.74, 0.05),
        least_tip=0.25,
    )


def study(x: np.ndarray, tips: np.ndarray) -> xr.Dataset:
    names = {
        "contact_ratio": 2.0 - x,
        "module": np.full_like(x, 0.0015),
        "transmission_error_range": 1e-6 * x,
        "mean_stiffness": 4e6 * np.ones_like(x),
        "tip_thickness_1": tips,
        "undercut_limit_1": np.full_like(x, 0.72),
        "vibration_status": (x > 0.85).astype(int),
    }
    return dataset(
        {name: (("law", "point"), values[None]) for name, values in names.items()}
        | {"axis": (("point",), x)},
        {"law": ["constant"]},
        title=EVIL,
        sweep_key="gears.profile_shift",
    )


@pytest.fixture(scope="module")
def whole(helical: CylindricalPair) -> Outcome:
    return outcome(
        {
            "teeth": teeth_of(helical),
            "stiffness": stiffness(),
            "vibration": vibration(),
            "resonance": resonance(),
        }
    )


def figure(panels: list[Panel], name: str) -> Figure:
    return next(f for panel in panels for f in panel.figures if f.name.endswith(name))


def named(shown: Figure) -> dict[str, dict[str, Any]]:
    """Traces by name; spaces in units do not break lines."""
    return {trace["name"].replace("\u00a0", " "): trace for trace in shown.data}


def words(page: str) -> str:
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    return " ".join(re.sub(r"<[^>]*>", " ", body).split())


@pytest.mark.parametrize(
    ("alpha", "beta"), [(0.888, 1.161), (1.46, 1.42), (1.6, 0.3), (0.4, 0.75), (2.2, 2.9), (1.5, 0)]
)
def test_lengths_of_contact_lines_have_closed_forms(alpha: float, beta: float) -> None:
    plane = PlaneOfAction(alpha, beta, 0.005, 0.02, 0.3 * bool(beta), 0.002)
    edges = np.unique(np.array([0.0, alpha, beta, alpha + beta]) % 1.0)
    inside = [phase + step for phase in edges for step in (-1e-9, 1e-9)]
    lengths = [plane.total_length(phase) for phase in inside]
    low, high = plane.extreme_lengths
    assert min(lengths) == pytest.approx(low, rel=1e-6)
    assert max(lengths) == pytest.approx(high, rel=1e-6)
    mean = np.mean([plane.total_length(phase) for phase in (np.arange(2000) + 0.5) / 2000])
    assert mean == pytest.approx(plane.mean_length, rel=1e-4)


def test_contact_lines_are_as_long_as_the_contacts(helical: CylindricalPair) -> None:
    plane = plane_of_action(teeth_of(helical))
    phases = np.array([0.02, 0.3, 0.7, 0.95])
    contacts = contacts_of(helical, jnp.asarray(phases))
    weights = np.where(contacts.active, contacts.weight, 0.0).sum(axis=(0, 1))
    assert weights == pytest.approx([plane.total_length(phase) for phase in phases], rel=1e-6)


def test_a_line_crosses_the_plane_at_the_base_helix_angle(helical: CylindricalPair) -> None:
    plane = plane_of_action(teeth_of(helical))
    rise = plane.overlap_ratio * plane.base_pitch / plane.face_width
    assert rise == pytest.approx(np.tan(plane.base_helix_angle), rel=1e-9)
    assert plane.ends(-0.01) is None
    assert plane.ends(plane.transverse_ratio + plane.overlap_ratio + 0.01) is None
    assert plane.ends(0.5 * plane.overlap_ratio) == pytest.approx((0.0, 0.5))


def test_page_has_every_section_and_figure(whole: Outcome) -> None:
    page = report_page({"default": whole})
    text = words(page)
    for part in ("Plane of action", "Mesh stiffness", "Vibration", "Against speed"):
        assert part in text
    drawn = payload(page)["figures"]
    assert sorted(drawn) == sorted(re.findall(r'class="plot" id="((?!one-page-)[^"]*)"', page))
    assert len(drawn) == 1 + 2 + 3 + 2
    assert not re.search(r"\b(nan|none|inf)\b", text, re.I)
    for told in ("least 13.64 mm", "damping ratio ξ 0.16 0.16", "equivalent mass m e 2.2 g"):
        assert told in text


def test_top_tells_stiffness_and_transmission_error(whole: Outcome) -> None:
    page = report_page({"default": whole})
    on_paper, on_screen = page.split("<header>")
    assert BESIDE in words(on_paper)
    top, rest = words(on_screen).split("Inputs as resolved")
    assert "3.977 N/µm in the mean, varies by 16.14 %" in top
    assert "5.6 µm dynamic, peak to peak at 5.355 N m, 42 µm in the mean" in top
    assert "Of the design" in top
    # Four teeth come into mesh in each turn.
    assert f"Natural frequency 6800 Hz that of the mesh at {6800 * 60 // 4} rpm of gear 1" in top
    assert BESIDE in top  # what is doubtful of a part counts at the top
    assert BESIDE in rest


def test_sections_appear_with_their_parts(whole: Outcome) -> None:
    bare = report_page({"default": replace(whole, parts={"teeth": whole.parts["teeth"]})})
    assert "Plane of action" in bare
    for heading in ("Mesh stiffness", "Vibration", "Against speed", "Studies"):
        assert f"<h2>{heading}" not in bare
        assert f"<h3>{heading}" not in bare
    assert "Transmission error" not in words(bare)
    empty = outcome({})
    assert stiffness_answer(empty) == ""
    assert vibration_answer(empty) == []


def test_pairs_end_where_they_leave(whole: Outcome) -> None:
    panels = stiffness_panels({"default": whole})
    traces = named(figure(panels, "phase"))
    assert list(traces) == [
        "pair I",
        "pair II",
        "mesh",
        "mesh, mean",
        "mesh, estimate of ISO 6336-1, outside its range",
    ]
    second = traces["pair II"]
    assert all((y is None) == (x >= 0.5) for x, y in zip(second["x"], second["y"], strict=True))
    assert traces["mesh"]["y"][0] == pytest.approx(5.0)
    assert traces["mesh, mean"]["y"] == [3.977, 3.977]


def test_without_a_steady_state_there_are_words_and_no_lines(whole: Outcome) -> None:
    one = replace(whole, parts={**whole.parts, "vibration": vibration((0, 1))})
    panels = vibration_panels({"default": one})
    assert list(named(figure(panels, "_error"))) == [
        "3.825 N m, dynamic",
        "3.825 N m, static",
        "5.355 N m, static",
    ]
    assert list(named(figure(panels, "_spectrum"))) == ["3.825 N m"]
    assert len(figure(panels, "_factor").data) == 2
    assert vibration_answer(one)[1] == (UNSTABLE, "at 5.355 N\u00a0m")
    page = report_page({"default": one})
    assert UNSTABLE not in page
    assert "At 5.355 N m no dynamic values are shown: it &lt;b&gt;grows" in words(page)
    neither = replace(whole, parts={**whole.parts, "vibration": vibration((1, 1))})
    assert "No steady state was found that the model describes." in report_page(
        {"default": neither}
    )


def test_orders_of_the_spectrum(whole: Outcome) -> None:
    bars = figure(vibration_panels({"default": whole}), "_spectrum").data[0]
    assert bars["x"] == list(range(1, 21))
    assert bars["y"][0] == pytest.approx(0.5)  # order zero is the mean


def test_time_runs_against_the_phase_where_gear_2_drives(whole: Outcome) -> None:
    back = outcome(whole.parts, driver="gear 2")
    pages = {k: vibration_panels({"default": one}) for k, one in (("on", whole), ("back", back))}
    on, off = (figure(panels, "_error").data[0]["y"] for panels in pages.values())
    assert on == off[::-1]
    assert on != off


def test_speeds_without_a_steady_state_are_gaps(whole: Outcome) -> None:
    panels = resonance_panels({"default": whole})
    traces = named(figure(panels, "_transmission_error_range"))
    falling, rising = (traces[f"5.355 N m, {sense}"] for sense in ("falling", "rising"))
    assert [k for k, y in enumerate(falling["y"]) if y is None] == [4, 5]
    assert None not in rising["y"]
    assert falling["line"]["dash"] != rising["line"]["dash"]
    assert falling["x"][-1] == pytest.approx(8000.0 * 60.0 / (2.0 * np.pi), rel=1e-5)
    assert "2 of 12 speeds" in panels[0].note
    assert UNSTABLE in panels[0].note


def test_equal_branches_are_one_line(whole: Outcome) -> None:
    data = resonance().isel(direction=[0, 0]).assign_coords(direction=["rising", "falling"])
    same = replace(whole, parts={**whole.parts, "resonance": data})
    shown = figure(resonance_panels({"default": same}), "_transmission_error_range")
    assert len(shown.data) == 2
    assert "rising and falling give the same" in shown.note


def test_marks_of_resonance_stand_where_the_mesh_frequency_is_natural(whole: Outcome) -> None:
    shown = figure(resonance_panels({"default": whole}), "_transmission_error_range")
    marks = {a["text"]: a["x"] for a in shown.layout["annotations"]}
    # Four teeth: the mesh frequency is four times the rate of rotation.
    assert marks["f<sub>n</sub>/2"] == pytest.approx(6800.0 / 2.0 / 4.0 * 60.0)


def test_design_chart_shows_both_limits() -> None:
    x = np.array([0.6, 0.7, 0.8, 0.9])
    least = 0.25 * 0.0015
    one = outcome({"study_x": study(x, np.array([1.4, 1.2, 1.0, 1.0]) * least)})
    (chart,) = design_charts({EVIL: one, "other": one})
    shapes = figure([chart], "contact_ratio").layout["shapes"]
    undercut, edge, tip, _ = shapes
    assert (undercut["x0"], undercut["x1"], edge["x0"]) == (0.6, 0.72, 0.72)
    assert (tip["x0"], tip["x1"]) == (0.8, 0.9)
    assert "x1 below x_min1 = 0.72" in chart.note
    assert "cut back to 0.375 mm" in chart.note
    error = figure([chart], "transmission_error_range").data[0]
    assert error["y"] == [0.6, 0.7, 0.8, None]
    assert "<img" not in json.dumps([f.data for f in chart.figures])


def test_a_study_of_something_else_is_no_design_chart() -> None:
    x = np.array([0.6, 0.9])
    other = study(x, x).assign_attrs(sweep_key="operation.torque")
    listed = study(x, x).assign(axis=("point", [np.nan, np.nan]))
    assert design_charts({"default": outcome({"study_a": other, "study_b": listed})}) == []


def test_specific_sliding_near_the_base_circle_is_cut_off() -> None:
    steep = teeth_of(pair_of(teeth=(17, 40), face_width=0.01))
    shown = sliding_figure("s", outcome({"teeth": steep}))
    assert [t["name"] for t in shown.data] == ["gear 1", "gear 2"]
    lowest = min(min(t["y"]) for t in shown.data)
    assert ("range" in shown.layout["yaxis"]) == (lowest < -8.0)
    assert shown.data[0]["y"][0] < 0.0 < shown.data[0]["y"][-1]


def test_helical_values_stand_at_the_middle_of_the_face(
    helical: CylindricalPair, whole: Outcome
) -> None:
    """A quantity that is linear along the path is met exactly, whatever slices a line has."""
    path = contact_path(whole)
    phases = np.linspace(0.0, 0.999, 40)
    contacts = contacts_of(helical, jnp.asarray(phases))
    lanes = ("node", "pair", "slice")
    fields = {
        name: np.moveaxis(np.broadcast_to(values, contacts.path.shape), -1, 0)
        for name, values in (
            ("path", contacts.path),
            ("active", contacts.active),
            ("weight", contacts.weight),
        )
    }
    loss = fields["weight"] * fields["active"]
    data = xr.Dataset(
        {
            "phase": (("node",), phases),
            "weight": (("node",), np.full(40, 1.0 / 40)),
            "path": (lanes, fields["path"]),
            "active": (lanes, fields["active"]),
            "sliding_velocity": (("law", *lanes), (2.0 * fields["path"] - 1.0)[None]),
            "load_share": (("law", *lanes), (loss / loss.sum(axis=(1, 2), keepdims=True))[None]),
            "sliding_loss": (("law", *lanes), loss[None]),
            "rolling_loss": (("law", *lanes), 0.0 * loss[None]),
        }
    )
    x, y = points_along_path(data, "sliding_velocity", 0, path)
    seen = np.isfinite(y)
    assert y[seen] == pytest.approx(2.0 * x[seen] - 1.0, abs=1e-6)
    assert x.min() >= -1e-6
    assert x.max() <= path.transverse_ratio + 1e-6
    x, y = points_along_path(data, "load_share", 0, path)
    assert path.transverse_ratio < x.max() <= path.contact_ratio + 1e-6
    assert np.nanmax(y) <= 1.0
    shares = loss_places(data, 0, path)
    # The loss is even over the path here.
    assert shares["A", "C"] == pytest.approx(path.points["C"] / path.transverse_ratio, abs=0.02)
    assert sum(shares.values()) == pytest.approx(1.0, abs=1e-9)


def test_long_lines_are_thinned_and_jumps_kept() -> None:
    x = np.repeat(np.linspace(0.0, 1.0, 2001), 2)
    y = np.where(np.arange(x.size) < 2001, 1.0, 2.0)
    shown_x, shown_y = continued(x, y, most=100)
    assert shown_x.size < 250
    assert np.isnan(shown_y).sum() == 1
    gap = int(np.flatnonzero(np.isnan(shown_y))[0])
    assert (shown_y[gap - 1], shown_y[gap + 1]) == (1.0, 2.0)
    assert (shown_x[0], shown_x[-1]) == (0.0, 1.0)


OF_STAGES = {
    1: ("gear 1", np.pi / 2.0, 60.0 * np.pi, 6800.0, 120.0),
    2: ("gear 3", np.pi / 10.0, 6.0 * np.pi, 680.0, 4400.0),
}
"""What drives each stage, the period of its mesh [rad], its speed [rad/s] and frequency [Hz], life [h]."""


def joint(natural: float) -> xr.Dataset:
    motor, speed = ["held", "free"], np.linspace(20.0, 800.0, 12)
    return dataset(
        {
            "natural_frequency": (("motor",), [natural, 1.5 * natural]),
            "wave_order": (("excitation",), [2.0]),
            "critical_speed": (("motor", "excitation"), [[100.0], [150.0]]),
            "torque_amplitude": (("motor", "excitation", "speed"), np.ones((2, 1, 12))),
            "output_amplitude": (("motor", "excitation", "speed"), np.ones((2, 1, 12))),
        },
        {"motor": motor, "excitation": ["2 a turn"], "speed": speed},
        title="joint",
    )


def wear(hours: float) -> xr.Dataset:
    figures = {"final_cycles": 1e6, "life_hours": 3600.0 * hours, "severe_cycles": np.nan}
    return dataset(
        {name: ((), value) for name, value in figures.items()}
        | {"deepest_wear": (("step", "gear"), [[1e-6, 2e-6]])},
        {"gear": ["gear 1", "gear 2"]},
        title="wear",
        end="turns",
        driver="gear 1",
        members=["gear 1", "gear 2"],
    )


@pytest.fixture(scope="module")
def stages(whole: Outcome) -> Outcome:
    """A drive of two stages: the second has a motion, frequencies, damping and a life of its own."""
    parts = {
        "vibration": {
            number: vibration().assign(
                natural_frequency=("torque", [0.9 * natural, natural]),
                **{
                    name: ("torque", [1.0, 1.0])
                    for name in ("mean_stiffness", "stiffness_variation")
                },
            )
            for number, (*_, natural, _) in OF_STAGES.items()
        },
        "resonance": {
            1: resonance(),
            2: resonance().assign_coords(speed=np.linspace(20.0, 800.0, 12)),
        },
        "stiffness": {1: stiffness(), 2: stiffness().assign(mean_stiffness=((), 0.977e6))},
        "joint": {number: joint(natural) for number, (*_, natural, _) in OF_STAGES.items()},
        "wear": {number: wear(hours) for number, (*_, hours) in OF_STAGES.items()},
    }
    alike = {"bodies": "", "loaded": "", "motion": [1.0], "load": 5.355, "travels": []}
    each = [
        {"number": number, "driver": driver, "period": period, "speed": speed, **alike}
        for number, (driver, period, speed, *_) in OF_STAGES.items()
    ]
    shared = [one for one in whole.manifest["inputs"] if one["table"] != "dynamics"]
    (ratio,) = (one for one in whole.manifest["inputs"] if one["table"] == "dynamics")
    path = f"{ratio['table']}.{ratio['key']}"
    inputs = [
        {**ratio, "table": "stages", "key": f"{number}.{path}", "value": 0.05 * number}
        for number in OF_STAGES
    ] + shared
    manifest = {**whole.manifest, "stages": each, "inputs": inputs}
    return Outcome(manifest, {name: by_stage(own) for name, own in parts.items()})


@pytest.mark.parametrize("number", OF_STAGES)
def test_a_stage_is_told_by_its_own_motion(stages: Outcome, number: int) -> None:
    driver, period, _, natural, hours = OF_STAGES[number]
    sections = VIBRATION, STIFFNESS, WEAR
    facts = {one.name: one for section in sections for one in section.answers(stages)}
    own = facts[f"Natural frequency, stage {number}"]
    assert own.value.split() == [f"{natural:.0f}", "Hz"]
    met = f"{natural * period * 30.0 / np.pi:.0f}"
    assert " ".join(own.detail.split()) == f"that of the mesh at {met} rpm of {driver}"
    assert f"({hours:.0f} h)" in " ".join(facts[f"Wear depth, stage {number}"].detail.split())
    stiff = facts[f"Mesh stiffness, stage {number}"].value
    assert stiff.split()[0] == {1: "3.977", 2: "0.977"}[number]
    printed = {one.title: one.rows for one in VIBRATION.prints(stages)}[f"Stage {number}"]
    assert f"{natural:.0f}" in printed[-1].values()


@pytest.mark.parametrize("number", OF_STAGES)
def test_figures_of_a_stage_are_those_of_its_own_motion(stages: Outcome, number: int) -> None:
    """Its table and damping, the speeds at which it is excited, and the frequencies of Campbell's diagram."""
    _, period, _, natural, _ = OF_STAGES[number]
    page = Page({"default": stages}, {})
    (tabs,) = VIBRATION.shows(page)
    blocks = tabs.each[f"stage {number}"]
    rows = {row[0]: row[1:] for one in blocks if isinstance(one, SectionTable) for row in one.rows}
    assert rows["natural frequency f_n"][-1].split()[0] == f"{natural:.0f}"
    assert rows["damping ratio ξ"] == ({1: "0.05", 2: "0.1"}[number],) * 2
    marks = {1: ("f_n/2", 2.0), 2: ("f_n", 1.0)}[number]
    met = natural * period * 30.0 / np.pi / marks[1]
    shapes = blocks[-1].figures[0].layout["shapes"]
    assert met in [pytest.approx(one["x0"], rel=1e-3) for one in shapes]
    drawn = {title: one for _, title, one in page.each("joint")}[f"stage {number}"]
    levels = joint_panel("joint", "", drawn).figures[-1].data[-2:]
    assert [level["y"][0] for level in levels] == pytest.approx([natural, 1.5 * natural])


FILM_LAWS = {1: "dowson_hamrock_1977", 2: "grubin_1949"}


@pytest.mark.parametrize("number", FILM_LAWS)
def test_a_stage_is_told_by_its_own_film_law(stages: Outcome, number: int) -> None:
    """The thinnest film on the first screen is that of the stage that has it, and so is the law beside it."""
    parts = {
        own: dataset(
            {name: (("law", "node"), [[2.0, least]]) for name in ("lambda_ratio", "load")},
            {"law": ["iso_tr_14179_2"]},
            title="mesh cycle",
        )
        for own, least in ((own, 0.7 if own == number else 1.7) for own in FILM_LAWS)
    }
    like = {**stages.manifest["inputs"][0], "unit": ""}
    laws = [
        {**like, "table": "stages", "key": f"{own}.models.film_thickness", "value": law}
        for own, law in FILM_LAWS.items()
    ]
    usual = {**like, "table": "models", "key": "film_thickness", "value": "ertel_1939"}
    manifest = {**stages.manifest, "inputs": [*laws, usual, *stages.manifest["inputs"]]}
    (fact,) = CYCLE.answers(Outcome(manifest, {"cycle": by_stage(parts)}))
    assert (fact.name, fact.value) == ("Film ratio", "0.7")
    assert fact.detail.startswith(f"at stage {number}; ")
    assert f"thinnest film by {show.pretty(FILM_LAWS[number])} over" in fact.detail


def test_the_stiffness_of_one_stage_names_it(stages: Outcome) -> None:
    """Its column, its heading and its figures, though no other stage has any."""
    alone = by_stage({1: of_stage(stages.parts["stiffness"], 1)})
    page = Page({"default": replace(stages, parts={**stages.parts, "stiffness": alone})}, {})
    blocks = STIFFNESS.shows(page)
    assert next(one.head for one in blocks if isinstance(one, SectionTable)) == [
        "Stiffness",
        "stage 1",
    ]
    titles = [figure.title for panel in panels(blocks) for figure in panel.figures]
    assert titles and all(title.endswith(" · stage 1") for title in titles)


def test_speeds_that_both_directions_leave_out_are_told_once() -> None:
    swept = resonance()
    swept["vibration_status"][0, 1, 4:6] = 1
    (told,) = _gaps(swept)
    assert told.replace("\u00a0", " ").startswith(
        "At 5.355 N m, speed rising and falling: 2 of 12 speeds ("
    )
    swept["vibration_status"][0, 1, 6] = 1
    assert len([*_gaps(swept)]) == 2
