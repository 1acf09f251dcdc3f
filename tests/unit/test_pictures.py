"""Pictures of teeth in a report: drawn flanks touch where the contacts are."""

import re
from collections.abc import Iterator
from math import atan2, cos, sin
from pathlib import Path

import bank
import numpy as np
import pytest
from reported import OUTSIDE, Outcomes, drawn_teeth

from pitchpoint.gears.rack_and_pinion.family import FAMILY as RACK_FAMILY
from pitchpoint.gears.rack_and_pinion.table import RackAndPinionGears
from pitchpoint.runs.run import Outcome
from pitchpoint.views.explorer import Reader
from pitchpoint.views.picture import Picture, PictureBody, picture_of
from pitchpoint.views.point import period_of
from pitchpoint.views.report import report_page


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
    text = report_page(bank.outcomes(Path(__file__).parents[2] / "examples" / "two_stage.toml"))
    assert [f'id="mesh{number}-close"' in text for number in range(3)] == [True, True, False]
    tables = re.findall(r"number of teeth z.*?</tr>", text, re.S)
    numbers = [re.findall(r">(\d+)<", table) for table in tables]
    assert numbers[:2] == [["23", "61"], ["19", "70"]]


PHASES = np.linspace(0.0, 0.999, 9)
RACK = RackAndPinionGears.model_validate(
    {"teeth": 20.0, "module": "3 mm", "face_width": "25 mm", "helix_angle": "12 deg"}
)


def racked(driver: str = "pinion") -> Outcome:
    """A result that holds nothing but the teeth of a rack and pinion."""
    mesh, _ = RACK_FAMILY.build(RACK, 2)
    return drawn_teeth(mesh, RACK_FAMILY, driver, ["pinion", "rack"])


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
