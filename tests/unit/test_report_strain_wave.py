"""Report of a drive whose teeth are carried by a wave: drawing, figures, and nothing that is not there."""

import json
import re
from dataclasses import replace
from math import pi, radians
from typing import Any

import numpy as np
import pytest
from pages import payload
from strain_wave_outcome import (
    LANES,
    LAWS,
    NODES,
    Z1,
    Z2,
    angles,
    bell,
    cycle,
    kinematic_error,
    loss_map,
    operation,
    outcome,
    running,
    teeth,
    torsion,
)

from pitchpoint.gears.strain_wave import MEMBERS
from pitchpoint.results.by_stage import by_stage
from pitchpoint.runs.compared_designs import main_results
from pitchpoint.runs.run import Outcome
from pitchpoint.views import show
from pitchpoint.views.explorer import Reader
from pitchpoint.views.figures import Figure, Panel, curves
from pitchpoint.views.first_screen import aligned
from pitchpoint.views.outlines import simplified
from pitchpoint.views.point import operating_point, period_of
from pitchpoint.views.report import report_page
from pitchpoint.views.section import KeyFigure, Page, key_figures, panels
from pitchpoint.views.section_registry import in_order
from pitchpoint.views.sections.answer import teeth_rows
from pitchpoint.views.sections.arc import ARC, arc_panel, wave_losses, wave_sentence
from pitchpoint.views.sections.beside import drag_panel, starting_answer
from pitchpoint.views.sections.cycle import cycle_panel
from pitchpoint.views.sections.kinematic_error import kinematic_error_answer, kinematic_error_panels
from pitchpoint.views.sections.loss_map import efficiency_panel
from pitchpoint.views.sections.passing import gap_panel
from pitchpoint.views.sections.torsion import torsion_answer, torsion_facts, torsion_panels
from pitchpoint.views.sections.wave_drive import DRIVE, loaded_arcs, picture, wave_dimensions


@pytest.fixture(scope="module")
def whole() -> Outcome:
    return outcome(
        {
            "teeth": teeth(),
            "cycle": cycle(),
            "operation": operation(),
            "torsion": torsion(),
            "kinematic_error": kinematic_error(),
            "running": running(),
            "loss_map": loss_map(),
        }
    )


def test_an_explorer_keeps_one_drawing_and_which_teeth_carry_at_each_load(whole: Outcome) -> None:
    read = Reader()
    lighter = cycle()
    lighter["load"] = lighter["load"].where(lighter["load"] > 20.0, 0.0)
    heavy, light = (read(outcome({"teeth": teeth(), "cycle": one})) for one in (cycle(), lighter))
    assert (heavy.drawing, light.drawing, len(read.drawings)) == ([0], [0], 1)
    assert read.drawings[0].kind == "drive"
    (heavy_arcs,), (light_arcs,) = heavy.acting, light.acting
    assert heavy_arcs == loaded_arcs(whole)
    assert heavy_arcs[0][0] < light_arcs[0][0] < light_arcs[-1][1] < heavy_arcs[-1][1]
    assert {*heavy.courses} == {"efficiency", "input_torque"}


@pytest.fixture(scope="module")
def page(whole: Outcome) -> str:
    return report_page({"default": whole})


def words(page: str) -> str:
    body = re.sub(r"<(script|style).*?</\1>", "", page, flags=re.S)
    return " ".join(re.sub(r"<[^>]*>", " ", body).split())


def drawn(page: str) -> dict[str, Any]:
    return dict(payload(page)["figures"])


def figure(panel: Panel, ending: str) -> Figure:
    return next(one for one in panel.figures if one.name.endswith(ending))


def heights(shown: Figure, trace: int = 0) -> list[float]:
    return [y for y in shown.data[trace]["y"] if y is not None]


def test_every_figure_has_a_place_and_data(page: str) -> None:
    figures = drawn(page)
    assert sorted(figures) == sorted(re.findall(r'class="plot" id="((?!one-page-)[^"]*)"', page))
    assert 'class="empty"' not in page
    assert len(figures) == 2 + 9 + 4 + 7 + 3 + 5 + 2 + 2 * 3


def test_page_speaks_of_the_drive(page: str) -> None:
    text = words(page)
    error = show.quantity(
        "kinematic_error_range", float(kinematic_error()["kinematic_error_range"][2, 2])
    )
    for told in (
        "wave generator drives at 1000 rpm, flexspline carries 20 N m",
        "Averages run over one tooth pitch",
        "One period is one tooth pitch: 8.571° of the driver, 1.429 ms.",
        "2 W in the teeth, 3 W beside them",
        "speed ratio, wave generator to flexspline −20",
        "pairs carry in the mean",
        f"Kinematic error {error} peak to peak, under the operating torque",
    ):
        assert told in text
    for told in ("base pitch", "gear 1", "gear 2", "Plane of action", "pitch point"):
        assert told not in text
    assert not re.search(r"\b(nan|none|inf)\b", text, re.I)


def test_an_efficiency_of_the_teeth_alone_says_so(whole: Outcome, page: str) -> None:
    assert "teeth alone" not in words(page)
    alone = operation(0.0)
    alone["mean_efficiency"].attrs["covers"] = "teeth alone"
    told = words(report_page({"default": outcome({"operation": alone})}))
    assert "85 % mean efficiency, teeth alone" in told


def test_the_torsional_stiffness_says_what_yields(whole: Outcome, page: str) -> None:
    assert (
        "pairs carry in the mean; without load its flanks let it turn freely by a kinematic play of "
        "1.031 arcmin"
    ) in words(page)
    assert "Teeth and ring yield; shafts are not in it." in words(page)
    assert torsion_answer(whole).endswith("; shafts are not in it")


def test_three_slopes_stand_in_a_line_with_what_is_assumed_of_them(whole: Outcome) -> None:
    slopes = {"slope_stiffness": (("slope",), [21230.0, 35660.0, 39440.0])}
    data = whole.parts["torsion"].assign(slopes).assign_coords(slope=["K1", "K2", "K3"])
    data.attrs["brief"] = (
        "shafts are not in it; 14 dimensions of its parts are assumed, see the inputs"
    )
    (stiffness, *_) = torsion_facts(replace(whole, parts={**whole.parts, "torsion": data}))
    (line,) = aligned([stiffness, KeyFigure(75.0, "Inertia at the input", "3 kg cm²")], 80)[:1]
    assert line.text.endswith("K1–K3 21.2, 35.7, 39.4; 14 sizes assumed")


def test_what_starts_a_drive_stands_before_its_kinematic_error(whole: Outcome) -> None:
    names = [figure.name for figure in key_figures(in_order(), whole)]
    assert (
        names.index("Starting torque") < names.index("Kinematic error") < names.index("Film ratio")
    )


def test_what_a_user_typed_is_text(page: str) -> None:
    assert "<b>" not in page
    assert "&lt;/script&gt;&lt;b&gt;&amp;" in page


def test_page_stays_small(page: str) -> None:
    """One tooth and one space, not the polygons of every frame."""
    found = re.search(r'class="drive" data-motion="([^"]*)"', page)
    assert found
    assert len(found.group(1)) < 2500


@pytest.mark.parametrize("kept", [("teeth",), ("teeth", "cycle"), ("operation",), ()])
def test_sections_appear_with_their_parts(whole: Outcome, kept: tuple[str, ...]) -> None:
    part = replace(whole, parts={name: whole.parts[name] for name in kept})
    bare = report_page({"default": part})
    headings = {
        "Drive and path of the teeth": "teeth" in kept,
        "Along the wave": "cycle" in kept,
        "Torsion": False,
        "Kinematic error": False,
        "Loss map": False,
        "Losses beside the teeth": "operation" in kept,
    }
    for heading, there in headings.items():
        assert (f"<h2>{heading}" in bare) == there
    assert sorted(drawn(bare)) == sorted(
        re.findall(r'class="plot" id="((?!one-page-)[^"]*)"', bare)
    )


@pytest.mark.parametrize("fixed", MEMBERS)
@pytest.mark.parametrize("driver", MEMBERS)
def test_members_turn_by_the_law_of_the_drive(whole: Outcome, fixed: str, driver: str) -> None:
    if fixed == driver:
        return
    loaded = next(name for name in MEMBERS if name not in (fixed, driver))
    one = outcome(whole.parts, driver=driver, loaded=loaded)
    assert ("fixed member", fixed) in wave_dimensions(one)
    w, f, c = one.manifest["motion"]
    assert Z2 * c == pytest.approx(Z1 * f + (Z2 - Z1) * w, abs=1e-12)
    motion = json.loads(picture(one, "one")["motion_json"])
    w, f, c = motion["rates"]
    assert max(map(abs, (w, f, c))) >= 1.0
    assert Z2 * c == pytest.approx(Z1 * f + (Z2 - Z1) * w, abs=1e-6)
    assert wave_dimensions(one)[-1][1] == "1.1"


def test_backwards_teeth_come_from_positive_angles(whole: Outcome) -> None:
    lost = wave_losses(whole, 0)
    angle = 2.0 * pi * whole.parts["cycle"]["path"].values
    loss = 0.1 * bell(angle)
    assert lost["in"] == pytest.approx(loss[angle > 0.0].sum() / NODES)
    assert lost["in"] + lost["out"] == pytest.approx(loss.sum() / NODES)
    assert lost["beside"] == 3.0
    turned = outcome(whole.parts, driver="flexspline", loaded="wave generator")
    assert wave_losses(turned, 0)["in"] == pytest.approx(loss[angle < 0.0].sum() / NODES)


def test_where_the_loss_is_made_in_words() -> None:
    told = wave_sentence({"in": 1.0, "out": 2.0, "beside": 1.0}, "the long axis")
    assert told.startswith("75 % in the teeth: 25 % before they reach the long axis")
    assert told.endswith("25 % beside the teeth.")
    assert "beside" not in wave_sentence({"in": 1.0, "out": 2.0, "beside": 0.0}, "")
    assert wave_sentence({"in": 0.0, "out": 0.0, "beside": 0.0}, "") == "There is no loss."


def test_simplified_outlines_keep_their_shape() -> None:
    turn = np.linspace(0.0, 2.0, 400)
    arc = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    few = simplified(arc, 1e-3)
    assert len(few) < 40
    assert np.array_equal(few[[0, -1]], arc[[0, -1]])
    middles = (few[1:] + few[:-1]) / 2.0
    assert np.abs(1.0 - np.hypot(*middles.T)).max() < 1e-3
    assert len(simplified(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), 1e-9)) == 2


def test_loaded_arcs_end_where_teeth_let_go(whole: Outcome) -> None:
    (arc,) = loaded_arcs(whole)
    step = 2.0 * pi / Z1 / (NODES - 1)
    assert arc[0] == pytest.approx(-radians(15.0), abs=step)
    assert arc[1] == pytest.approx(radians(15.0), abs=step)
    assert loaded_arcs(replace(whole, parts={"teeth": whole.parts["teeth"]})) == []
    idle = whole.parts["cycle"].copy()
    idle["load"] = 0.0 * idle["load"]
    assert loaded_arcs(replace(whole, parts={**whole.parts, "cycle": idle})) == []


def test_quantities_stand_over_the_angle_of_the_tooth(whole: Outcome) -> None:
    known = curves({"default": whole})
    panel = arc_panel({"default": whole}, known)
    sliding = figure(panel, "sliding_velocity").data[0]
    for x, y in zip(sliding["x"], sliding["y"], strict=True):
        if y is not None:
            assert y == pytest.approx(radians(x), abs=1e-5)
    load = figure(panel, "arc_load").data[0]
    assert max(y for y in load["y"] if y is not None) == pytest.approx(100.0, rel=1e-3)
    ratio = figure(panel, "lambda_ratio")
    bands = [one["text"] for one in ratio.layout["annotations"]]
    assert bands == ["boundary", "mixed", "full film"]
    assert ratio.layout["yaxis"]["type"] == "log"
    assert figure(panel, "pressure").layout["yaxis"].get("type") != "log"


def test_a_law_alone_is_drawn_solid_whatever_its_place_among_others(whole: Outcome) -> None:
    """Dashed is the other contact of a tooth."""
    alone = replace(whole, parts={**whole.parts, "cycle": whole.parts["cycle"].isel(law=[0])})
    second = {key: replace(one, dash="dash") for key, one in curves({"default": alone}).items()}
    drawn = [one for one in arc_panel({"default": alone}, second).figures if one.drawn]
    assert {one.data[0]["line"].get("dash", "solid") for one in drawn} == {"solid"}


def test_an_idle_drive_says_so(whole: Outcome) -> None:
    idle = whole.parts["cycle"].copy()
    idle["load"] = 0.0 * idle["load"]
    one = replace(whole, parts={**whole.parts, "cycle": idle})
    panel = arc_panel({"default": one}, curves({"default": one}))
    assert not figure(panel, "radius").drawn
    assert figure(panel, "radius").missing == "No tooth carries."
    assert len(gap_panel(one, "x").figures[1].data) == 1


def test_teeth_that_carry_lie_on_the_clearance(whole: Outcome) -> None:
    line, dots = gap_panel(whole, "x").figures[1].data
    assert len(dots["x"]) == np.sum(np.abs(angles(np.zeros(1))[0, :LANES]) < radians(14.99))
    known = np.array([(x, y) for x, y in zip(line["x"], line["y"], strict=True) if y]).T
    for x, y in zip(dots["x"], dots["y"], strict=True):
        assert y == pytest.approx(np.interp(x, *known), rel=1e-3)
    assert min(y for y in line["y"] if y is not None) == pytest.approx(0.01)


def test_every_pair_is_counted_over_the_cycle(whole: Outcome) -> None:
    known = curves({"default": whole})
    (count,) = figure(cycle_panel({"default": whole}, known), "cycle_pairs").data
    carrying = (whole.parts["cycle"]["load"].values[0] > 0.0).sum(axis=(1, 2))
    assert [y for y in count["y"] if y is not None][:NODES] == carrying.tolist()


def test_a_cycle_that_begins_at_an_event_is_shown_from_zero(whole: Outcome) -> None:
    begun = whole.parts["cycle"].copy()
    begun["phase"] = begun["phase"] + 0.3
    one = replace(whole, parts={**whole.parts, "cycle": begun})
    panel = cycle_panel({"default": one}, curves({"default": one}))
    drawn = figure(panel, "cycle_efficiency").data[0]
    places = [x for x in drawn["x"] if x is not None]
    assert places == sorted(places)
    assert places[1] == pytest.approx(0.1)
    assert (min(places), max(places)) == (0.0, 1.0)
    values = [y for y in drawn["y"] if y is not None]
    assert values[0] == values[-1] == pytest.approx(np.mean([values[1], values[-2]]))
    over_time = panel.choices[1].changes["cycle_efficiency"][0]["x"][0]
    times = [x for x in over_time if x is not None]
    assert min(times) == 0.0
    assert max(times) == pytest.approx(2e3 * period_of(one).time, rel=1e-4)


def test_load_grows_over_more_teeth_with_torque(whole: Outcome) -> None:
    known = curves({"default": whole})
    (panel,) = torsion_panels({"default": whole}, known)
    load = figure(panel, "_load")
    assert load.keys[-1].label == "40\u00a0N\u00a0m"
    tops = [max(heights(load, k)) for k in range(len(load.data))]
    wide = [sum(y > 0.0 for y in heights(load, k)) for k in range(len(load.data))]
    assert tops == sorted(tops)
    assert wide == sorted(wide)
    assert wide[-1] > wide[0]


def test_torque_loop_lies_around_the_line_without_friction(whole: Outcome) -> None:
    known = curves({"default": whole})
    loop = figure(torsion_panels({"default": whole}, known)[0], "_loop")
    first, second, elastic = loop.data
    half = len(elastic["x"])
    assert first["x"] == [*elastic["x"], *elastic["x"][::-1]]
    assert first["y"][half - 1] == pytest.approx(1.1 * elastic["y"][-1])
    assert first["y"][half] == pytest.approx(0.9 * elastic["y"][-1])
    assert max(second["y"]) < max(first["y"])


def test_the_transmission_error_is_drawn_around_its_mean(whole: Outcome) -> None:
    """Over one period from 0 to 1, wherever the mesh cycle begins."""
    data = whole.parts["torsion"].assign_coords(phase=[0.8, 1.3])
    one = replace(whole, parts={**whole.parts, "torsion": data})
    error = figure(torsion_panels({"default": one}, curves({"default": one}))[0], "_error")
    assert error.layout["xaxis"]["range"] == [0, 1]
    (*_, last) = error.data
    half = 0.005 * float(data["wind_up"][-1]) * np.degrees(1.0) * 3600.0
    assert last["x"] == pytest.approx([0.0, 0.3, 0.8, 1.0])
    assert last["y"] == pytest.approx([-0.2 * half, half, -half, -0.2 * half], rel=1e-4)


def test_designs_have_their_results_as_rows_and_their_curves_on_the_same_axes(
    whole: Outcome,
) -> None:
    data = whole.parts["torsion"]
    stiffer = data.assign(torsional_stiffness=2.0 * data["torsional_stiffness"])
    both = {"thin": whole, "thick": replace(whole, parts={**whole.parts, "torsion": stiffer})}
    drawn = payload(report_page(both, designs=True))["figures"]
    thin, thick = drawn["torsion_of_designs_torsional_stiffness"]["data"]
    assert (thin["name"], thick["name"]) == ("thin", "thick")
    known = [(a, b) for a, b in zip(thin["y"], thick["y"], strict=True) if a is not None]
    assert len(known) > 1
    assert [b for _, b in known] == pytest.approx([2.0 * a for a, _ in known], rel=1e-4)
    assert not any(
        name.startswith("torsion_of_designs") for name in payload(report_page(both))["figures"]
    )
    rows = {(one.name, one.place): one.values["thin"] for one in main_results(both)}
    error = whole.parts["kinematic_error"]["kinematic_error_range"]
    for curve in map(str, error["curve"].values):
        told = float(error.sel(curve=curve, cause="both"))
        assert rows.get(("kinematic_error_range", curve), 0.0) == told
    operation = whole.parts["operation"]
    assert rows["mean_drag_loss", ""] == float(operation["mean_drag_loss"].values[0, 0])


@pytest.mark.parametrize("play", [1e-17, 5e-4])
def test_play_that_rounding_leaves_or_nobody_feels_is_none(whole: Outcome, play: float) -> None:
    """The play is a part of the largest wind-up."""
    data = whole.parts["torsion"].copy()
    data["kinematic_play"] = play * data["wind_up"].max()
    one = replace(whole, parts={**whole.parts, "torsion": data})
    assert "without load" not in torsion_answer(one)


@pytest.mark.parametrize(("ratio", "told"), [(2.5e-3, "0.0025"), (2e-4, "below 0.001")])
def test_a_film_thinner_than_a_molecule_has_no_digits(
    whole: Outcome, ratio: float, told: str
) -> None:
    cycle = whole.parts["cycle"]
    films = cycle.assign(lambda_ratio=ratio + 0.0 * cycle["lambda_ratio"])
    one = replace(whole, parts={**whole.parts, "cycle": films})
    values = {figure.name: figure.value for figure in key_figures(in_order(), one)}
    assert values["Film ratio"] == told


def test_both_ends_are_one_line_only_if_they_are_alike(whole: Outcome) -> None:
    known = curves({"default": whole})
    bearing = figure(torsion_panels({"default": whole}, known)[0], "_bearing")
    assert len(bearing.data) == 1
    uneven = whole.parts["torsion"].copy(deep=True)
    uneven["zone_load"].values[:, 1] *= 1.1
    one = replace(whole, parts={**whole.parts, "torsion": uneven})
    assert len(figure(torsion_panels({"default": one}, known)[0], "_bearing").data) == 2
    assert torsion_answer(outcome({})) == ""


def test_no_stiffness_is_told_where_nothing_is_carried(whole: Outcome) -> None:
    rows = [
        {**row, "value": 0.0} if row["key"] == "torque" else row for row in whole.manifest["inputs"]
    ]
    idle = replace(whole, manifest={**whole.manifest, "inputs": rows})
    assert torsion_answer(idle) == "nothing is carried at the operating point"
    data = whole.parts["torsion"].copy(deep=True)
    data["wind_up"].values[:] = np.nan
    lost = replace(whole, parts={**whole.parts, "torsion": data})
    assert torsion_answer(lost) == "no equilibrium was found at the operating point"


def test_orders_stand_over_the_spline_that_makes_them(whole: Outcome) -> None:
    (panel,) = kinematic_error_panels(Page({"default": whole}, {}))
    turn, first, second = panel.figures
    assert [len(one.data) for one in panel.figures] == [3, 3, 3]
    assert turn.data[0]["x"][-1] == pytest.approx(360.0 * (1.0 - 0.5 / Z2), abs=1e-3)
    assert first.data[2]["x"] == [1, 2, 3, 4, 5, 6]  # not as far as the mesh
    arcsec = np.degrees(1.0) * 3600.0
    assert first.data[2]["y"] == pytest.approx([0.0, 1.9e-5 * arcsec, 0, 0, 0, 0], rel=1e-4)
    assert second.data[0]["y"][2:4] == pytest.approx([1e-5 * arcsec, 1.5e-5 * arcsec], rel=1e-4)
    assert "circular spline" in second.title


def test_a_spline_without_deviations_has_no_orders(whole: Outcome) -> None:
    one = replace(whole, parts={"kinematic_error": kinematic_error(flexspline=False)})
    (panel,) = kinematic_error_panels(Page({"default": one}, {}))
    assert [shown.title for shown in panel.figures[1:]] == ["Orders by the circular spline"]
    assert kinematic_error_panels(Page({"default": outcome({})}, {})) == []
    assert kinematic_error_answer(outcome({})) == ""


def test_a_state_without_equilibrium_leaves_a_gap(whole: Outcome) -> None:
    lost = kinematic_error()
    lost["kinematic_error"].values[2, 7] = np.nan
    lost["kinematic_error_spectrum"].values[2] = np.nan
    lost["kinematic_error_range"].values[2] = np.nan
    one = replace(whole, parts={"kinematic_error": lost})
    (panel,) = kinematic_error_panels(Page({"default": one}, {}))
    assert panel.figures[0].data[2]["y"][7] is None
    assert set(panel.figures[1].data[2]["y"]) == {None}
    assert panel.figures[1].data[1]["y"][1] is not None
    assert kinematic_error_answer(one) == "no equilibrium was found at some places of the turn"


def test_losses_are_split_only_where_there_are_others(whole: Outcome) -> None:
    known = curves({"default": whole})
    teeth_loss, beside = figure(drag_panel({"default": whole}, known), "loss_split").data
    assert (teeth_loss["x"], beside["x"]) == ([2.0, 2.0], [3.0, 3.0])
    none = outcome({"operation": operation(drag=0.0)})
    assert drag_panel({"default": none}, curves({"default": none})).figures == []


def test_a_drive_that_friction_holds_is_said(whole: Outcome) -> None:
    told = dict(starting_answer(whole, "own"))
    assert told["back-driving torque"] == "friction holds the drive"
    assert dict(starting_answer(whole, "constant"))["back-driving torque"] == "2 N\u00a0m"
    assert starting_answer(whole, "another") == []


def test_efficiency_lines_are_those_of_the_map(whole: Outcome) -> None:
    known = curves({"default": whole})
    panel = efficiency_panel({"default": whole}, known)
    assert [one.name for one in panel.figures] == [
        f"efficiency_{axis}_{k}" for axis in ("torque", "speed", "temperature") for k in (0, 1)
    ]
    assert panel.figures[0].layout["yaxis"]["range"] == panel.figures[1].layout["yaxis"]["range"]
    assert panel.figures[1].title.startswith("Mean efficiency against output torque, ")
    data = whole.parts["loss_map"]
    expected = 100.0 * data["mean_efficiency"].values[0, 1:, 1, 0]
    assert heights(panel.figures[0]) == pytest.approx(expected, rel=1e-4)
    assert "At 954.9\u00a0rpm" in panel.figures[0].note


def test_what_flanks_bear_stands_in_the_answer_and_on_the_screen(whole: Outcome) -> None:
    data = whole.parts["torsion"]
    share = ("torque", np.linspace(0.0, 0.08, data.sizes["torque"]))
    one = replace(whole, parts={**whole.parts, "torsion": data.assign(edge_share=share)})
    largest = float(whole.parts["cycle"]["pressure"].values[0].max())
    (row,) = (row for row in teeth_rows(one) if row["friction law"] == LAWS[0])
    assert row["largest Hertz pressure"] == show.quantity("pressure", largest)
    at = operating_point(one).torque
    edges = show.quantity("edge_share", 0.08 * at / 40.0)
    assert row["part of the load on edges of the teeth"] == edges
    assert f"part of the load on edges of the teeth {edges}" in words(report_page({"default": one}))
    assert "part of the load on edges" not in words(report_page({"default": whole}))


def test_teeth_that_carry_name_the_variant_whose_load_they_are(whole: Outcome) -> None:
    lighter = cycle()
    lighter["load"] = lighter["load"].where(lighter["load"] > 20.0, 0.0)
    light = replace(whole, parts={**whole.parts, "cycle": lighter})
    (drawn,) = DRIVE.shows(Page({"heavy": whole, "light": light}, {}))
    assert drawn.values["d"]["of_loads"] == "heavy"
    assert {one.title.rpartition(" · ")[2] for one in drawn.panels[0].figures} == {"heavy"}
    (drawn,) = DRIVE.shows(Page({"one": whole, "two": whole}, {}))
    assert drawn.values["d"]["of_loads"] == ""
    assert not any("·" in one.title for one in drawn.panels[0].figures)


def test_a_wave_of_one_stage_names_it(whole: Outcome) -> None:
    parts = {name: by_stage({2: whole.parts[name]}) for name in ("teeth", "cycle")}
    (stage,) = [
        {"number": 2, "bodies": "", "travels": [], "speed": 1.0, "load": 1.0}
        | {key: whole.manifest[key] for key in ("driver", "loaded", "members", "motion")}
    ]
    drive = replace(whole, parts=parts, manifest={**whole.manifest, "stages": [stage]})
    titles = [
        one.title
        for panel in panels(ARC.shows(Page({"default": drive}, {})))
        for one in panel.figures
    ]
    assert titles and all(title.endswith(" · stage 2") for title in titles)
