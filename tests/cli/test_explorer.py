"""One page with inputs on sliders: its numbers, what is not possible, and how it is driven in a browser."""

import re
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import CHROMIUM, Browser, browser
from pages import unpacked
from sound import SMOOTH, quick_first

from pitchpoint import cli
from pitchpoint.cases.document import Document
from pitchpoint.cases.keys import quantity_at
from pitchpoint.cases.library import find_case
from pitchpoint.cases.study_tables import Sweep
from pitchpoint.cases.validation import validate
from pitchpoint.gears.families import TABLES, sample_of
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.runs import explore as exploring
from pitchpoint.runs.case import Case
from pitchpoint.runs.explore import Explored, explore, usual_keys
from pitchpoint.runs.run import Outcome, run_case
from pitchpoint.views import explorer, show
from pitchpoint.views.explorer import Reader, write_explorer
from pitchpoint.views.report import packed

EXAMPLES = Path(__file__).parents[2] / "examples"
CASE = f"""
title = "A pair & <b>its</b> </script><i>loss</i>"
{SMOOTH}
[models]
friction = ["iso_tr_14179_2", "xu_2007"]
"""
OVER = (
    "gears.profile_shift.1=0.4:1.9:3",
    "operation.torque=30 N m:60 N m:2",
    "operation.speed=900 rpm:1800 rpm:2",
)
"""With the last profile shift the teeth of a gear are pointed."""

SHIFT, TORQUE, SPEED = range(3)
MAIN = ("mean_efficiency", "mean_loss", "mean_input_torque", "mean_friction", "torque_ripple")
DRAWN = "document.documentElement.dataset.drawn === 'all'"

Told = tuple[int, str, str]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("explorer")
    (folder / "pair.toml").write_text(CASE, "utf-8")
    return folder


@pytest.fixture(scope="module")
def page(folder: Path) -> Path:
    """The page, written by the command."""
    path = folder / "page.html"
    over = [part for one in OVER for part in ("--over", one)]
    with pytest.MonkeyPatch.context() as changed:
        changed.setattr(
            sys,
            "argv",
            ["pitchpoint", "explore", str(folder / "pair.toml"), "-o", str(path), *over],
        )
        with pytest.raises(SystemExit) as ended:
            cli.main()
    assert ended.value.code == 0
    return path


@pytest.fixture
def told(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Told]:
    """Exit status, output and complaint of the command."""

    def run_it(*arguments: str) -> Told:
        monkeypatch.chdir(folder)
        monkeypatch.setattr(sys, "argv", ["pitchpoint", "explore", *arguments])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        found = capsys.readouterr()
        return int(ended.value.code or 0), found.out, found.err

    return run_it


@pytest.fixture(scope="module")
def held(page: Path) -> dict[str, Any]:
    """What the script of the page reads."""
    return held_by(page)


def held_by(page: Path) -> dict[str, Any]:
    return dict(unpacked(page.read_text("utf-8"), "explored"))


def computed(folder: Path, **changes: str) -> Outcome:
    """The case run at one place, without what else it has."""
    settings = {key.replace("__", "."): value for key, value in changes.items()}
    return run_case(str(folder / "pair.toml"), settings=settings)["default"]


@pytest.fixture(scope="module")
def corner(folder: Path) -> Outcome:
    return computed(folder, operation__torque="30 N m", operation__speed="1800 rpm")


def figure(held: dict[str, Any], name: str) -> dict[str, Any]:
    return next(one for one in held["figures"] if one["name"] == name)


def test_at_a_point_of_the_grid_figures_are_those_of_a_run(
    held: dict[str, Any], corner: Outcome
) -> None:
    assert [axis["values"] for axis in held["axes"]] == [[0.4, 1.15, 1.9], [30, 60], [900, 1800]]
    data = corner.parts["operation"]
    for name in MAIN:
        for law in range(2):
            found = figure(held, name)["values"][law][0 * 4 + 0 * 2 + 1]
            value = float(data[name].values[law, 0])
            assert show.quantity(name, value, with_unit=False, of=data) == show.number_text(found)


def test_the_value_of_the_case_is_a_point_of_the_grid(folder: Path) -> None:
    """The page opens there, with figures that are computed."""
    case = Case(folder / "pair.toml")
    between, beyond, among = (
        Sweep(key=key, start=start, stop=stop, count=count)
        for key, start, stop, count in (
            ("operation.torque", "30 N m", "70 N m", 2.0),
            ("operation.speed", "1000 rpm", "1800 rpm", 2.0),
            ("gears.profile_shift.1", 0.1, 0.7, 3.0),
        )
    )
    torque, speed, shift = exploring._given(case, [between, beyond, among])
    np.testing.assert_allclose(torque.values, [30.0, 60.0, 70.0])
    assert torque.own == 60.0
    assert speed.values.size == 2
    assert speed.own == speed.values[0]
    assert shift.values.size == 3
    assert shift.own == pytest.approx(0.4)


def test_courses_over_the_cycle_are_those_of_a_run(held: dict[str, Any], corner: Outcome) -> None:
    efficiency = next(one for one in held["courses"] if one["name"] == "efficiency")
    phases, rows = efficiency["points"][1]
    cycle = corner.parts["cycle"]
    x = np.array(efficiency["phases"][phases])
    for law, row in enumerate(rows):
        for place, value in zip(x, row, strict=True):
            near = np.abs(np.mod(cycle["phase"].values - place + 0.5, 1.0) - 0.5) < 1e-4
            if value is not None and near.any():
                assert np.min(np.abs(100.0 * cycle["efficiency"].values[law, near] - value)) < 1e-3
    assert len(x) > 50


def test_what_is_not_possible_has_a_sentence_and_no_numbers(
    held: dict[str, Any], page: Path
) -> None:
    for number in range(8, 12):
        assert [held["why"][law][number] > 0 for law in range(2)] == [True, True]
        assert "lies beyond the point of the teeth" in held["sentences"][held["why"][0][number]]
        assert all(one["values"][law][number] is None for one in held["figures"] for law in (0, 1))
        assert held["drawing"][number] == []
    assert not any(held["why"][law][number] for law in (0, 1) for number in range(8))
    assert "4 of 12 points are not possible." in page.read_text("utf-8")


def test_only_the_design_changes_the_teeth(held: dict[str, Any]) -> None:
    assert held["drawing"][:8] == [[0]] * 4 + [[1]] * 4
    assert [axis["shapes"] for axis in held["axes"]] == [True, False, False]


def test_what_a_user_typed_is_text(page: Path) -> None:
    text = page.read_text("utf-8")
    assert (
        "<h1>A pair &amp; &lt;b&gt;its&lt;/b&gt; &lt;/script&gt;&lt;i&gt;loss&lt;/i&gt;</h1>"
        in text
    )
    assert text.count("<script") == text.count("</script>") == 3


def test_the_page_is_one_small_file(page: Path) -> None:
    text = page.read_text("utf-8")
    assert len(text.encode()) < 3e6
    plain = re.sub(r'<script type="text/plain".*?</script>', "", text, flags=re.S)
    assert not re.search(r"""(src|href)=["'](?!#)""", plain)
    assert "default-src 'none'" in text


@pytest.mark.whole
def test_errors_between_points_are_measured(folder: Path) -> None:
    """Along one key: the mean of both ends against a run between them."""
    over = [Sweep(key="operation.speed", start="900 rpm", stop="1800 rpm", count=2.0)]
    found: Explored[None] = explore(str(folder / "pair.toml"), over, read=lambda _, __: None)
    assert found.midpoints == 1
    data = computed(folder, operation__speed="1350 rpm").parts["operation"]
    for name in ("mean_loss", "mean_friction"):
        true = data[name].values[:, 0]
        off = np.abs(found.figures[name].values.mean(axis=1) - true) / true
        assert found.errors[name] == pytest.approx(off.max(), rel=1e-6)
        assert 1e-4 < found.errors[name] < 0.2


@pytest.mark.whole
def test_units_by_choice(folder: Path, told: Callable[..., Told], corner: Outcome) -> None:
    over = ("--over", "operation.speed=900 rpm:1800 rpm:2", "--set", "operation.torque=30 N m")
    chosen = ("--units", "rotational speed=rad/s, torque=N cm")
    assert told("pair.toml", "-o", "units.html", *over, *chosen)[0] == 0
    held = held_by(folder / "units.html")
    assert (held["axes"][0]["unit"], held["axes"][0]["values"][1]) == ("rad/s", 188.495559215)
    shown = figure(held, "mean_input_torque")
    assert shown["unit"] == "N cm"
    assert shown["axis"].endswith("[N cm]")
    whole = corner.parts["operation"]["mean_input_torque"].values[:, 0]
    np.testing.assert_allclose([one[1] for one in shown["values"]], 100.0 * whole, rtol=1e-5)


def test_errors_are_told(page: Path) -> None:
    text = " ".join(page.read_text("utf-8").split())
    (found,) = re.findall(
        r"Between grid points values are interpolated linearly; largest error at (\d) midpoint, over the "
        r"value there: ([^<]*)\. A finer grid",
        text,
    )
    assert found[0] == "1"  # the other cell has corners that are not possible
    assert re.search(r"\d % mean power loss", found[1])


def test_a_pair_has_load_speed_and_profile_shift_on_sliders(folder: Path) -> None:
    shift, torque, speed = usual_keys(Case(str(folder / "pair.toml")).held[0])
    assert (shift.key, torque.key, speed.key) == (
        "gears.profile_shift.1",
        "operation.torque",
        "operation.speed",
    )
    np.testing.assert_allclose(shift.values, [0.2, 0.3, 0.4, 0.5, 0.6], atol=1e-12)
    np.testing.assert_allclose(torque.values / 60.0, [0.25, 0.5, 0.75, 1.0, 1.25, 1.5])
    for axis in (shift, torque, speed):
        assert np.min(np.abs(axis.values - axis.own)) < 1e-12


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.__name__)
def test_every_family_names_a_key_to_explore(table: type[GearsTable]) -> None:
    name, tree = find_case(str(sample_of(table)))
    gears = validate(Document(name, tree)).gears
    assert gears.explored is not None
    key, reach = gears.explored
    quantity = quantity_at(f"gears.{key}", tree)
    assert quantity is not None
    assert 0.0 < reach < quantity.high - quantity.low


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--over", "operation.torque=5"], "is not KEY=START:STOP:COUNT"),
        (["--over", "operation.torque=5 N m:6 N m:1"], "1 value cannot be both"),
        (["--over", "operation.torqe=5 N m:6 N m:2"], "there is no such key; did you mean"),
        (["--over", "operation.torque=5 N m:6 mm:2"], "operation.torque"),
        (["--over", "operation.torque=5 N m:6 N m:601"], "a page holds 600 at most"),
        (
            ["--over", "operation.speed=5 rpm:6 rpm:2"] * 2,
            "operation.speed is given twice",
        ),
        (["--over", "loss_map.count=2:3:2"], "cannot be swept"),
        (["-o", "pair.toml"], "ends in .html"),
        (["--variant", "none"], "this case has no variants"),
        (["--set", "gears.teeth=3"], "teeth"),
    ],
)
def test_bad_input_is_one_sentence(
    told: Callable[..., Told], folder: Path, arguments: list[str], sentence: str
) -> None:
    status, out, complaint = told("pair.toml", *arguments)
    assert (status, out) == (2, "")
    last = [line for line in complaint.splitlines() if line.startswith("error: ")]
    assert len(last) == 1
    assert sentence in last[0]
    assert (folder / "pair.toml").read_text("utf-8") == CASE


def test_an_interruption_leaves_no_page(
    told: Callable[..., Told], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(exploring, "study", stop)
    status, out, complaint = told("pair.toml", "--over", OVER[TORQUE], "-o", "stopped.html")
    assert (status, out) == (130, "")
    assert complaint.splitlines()[-1] == "interrupted"
    assert not (folder / "stopped.html").exists()


in_browser = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    with browser() as one:
        yield one


@pytest.fixture(params=quick_first([1280, 500]))
def driven(request: pytest.FixtureRequest, chromium: Browser, page: Path) -> Browser:
    """The page as it opens, without motion of its own."""
    chromium.open(page, request.param, prefers_reduced_motion="reduce")
    chromium.wait(DRAWN)
    return chromium


def slide(page: Browser, number: int, value: float) -> None:
    move = "(s, value) => { s.value = value; s.dispatchEvent(new Event('input', {bubbles: true})) }"
    page.run(f"({move})(document.getElementById('slider-{number}'), {value})")
    page.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


BIG = "document.querySelector('#possible .big').textContent"
GEAR = "document.querySelector('.moving:not([hidden]) .gear').getAttribute('transform')"


def number(words: str) -> float:
    return float(words.split()[0].replace("−", "-"))


@in_browser
def test_all_is_drawn_and_the_console_is_silent(driven: Browser) -> None:
    assert driven.window is not None
    width = driven.window[0]
    assert driven.run("[...document.querySelectorAll('.plot')].every(p => p.querySelector('svg'))")
    assert driven.run("document.documentElement.scrollWidth") <= width
    assert driven.run("[...document.querySelectorAll('input')].every(i => i.labels.length === 1)")
    assert driven.console == []


@in_browser
def test_sliders_change_the_numbers(driven: Browser, held: dict[str, Any]) -> None:
    rows = figure(held, "mean_efficiency")["values"][0]
    assert (
        driven.run(BIG) == f"{show.number_text(rows[0b10])} %"
    )  # 60 N m and 900 rpm, those of the case
    slide(driven, TORQUE, 30.0)
    assert driven.run(BIG) == f"{show.number_text(rows[0])} %"
    slide(driven, SPEED, 1350.0)
    assert number(driven.run(BIG)) == pytest.approx(0.5 * (rows[0] + rows[1]), abs=0.0051)
    words = driven.run("document.getElementById('slider-2').getAttribute('aria-valuetext')")
    assert words == "1350 rpm"
    told = driven.wait(
        "(t => t.includes('= 1350 rpm') && t)(document.getElementById('spoken').textContent)"
    )
    assert "mean efficiency" in told and "torque, gear 2 = 30 N" in told
    dot = "document.getElementById('over-2').data.at(-1)"
    assert driven.run(f"{dot}.x[0]") == pytest.approx(1350.0, rel=1e-8)  # steps are a trifle short
    driven.run("document.querySelector('[type=reset]').click()")
    assert driven.wait(f"{BIG} === {f'{show.number_text(rows[0b10])} %'!r}")
    assert driven.console == []


@in_browser
def test_the_arrow_keys_move_a_slider(driven: Browser) -> None:
    driven.run("document.getElementById('slider-1').focus()")
    for kind in ("keyDown", "keyUp"):
        driven.call("Input.dispatchKeyEvent", type=kind, key="ArrowLeft", code="ArrowLeft")
    before = driven.run("document.getElementById('at-1').textContent")
    assert number(before) <= 60.0
    driven.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowLeft", windowsVirtualKeyCode=37)
    assert driven.wait("parseFloat(document.getElementById('at-1').textContent) < 60")


@in_browser
def test_another_law_has_other_numbers(driven: Browser, held: dict[str, Any]) -> None:
    choose = "(m => { m.selectedIndex = 1; m.dispatchEvent(new Event('input', {bubbles: true})) })"
    driven.run(f"{choose}(document.getElementById('law'))")
    wanted = f"{show.number_text(figure(held, 'mean_efficiency')['values'][1][2])} %"
    assert driven.wait(f"{BIG} === {wanted!r}")


@pytest.mark.parametrize(
    "values", [[20.0, 43.3, 60.0, 66.7, 90.0], [20.0, 41.3, 50.0, 90.0], [0.1, 0.4]]
)
def test_a_slider_reaches_its_last_value(values: list[float]) -> None:
    span, step = values[-1] - values[0], explorer._step(values)
    assert span - 0.01 * step < step * (span // step) <= span
    assert step <= 1.000001 * np.diff(values).min() / 20.0
    assert explorer._step([20.0, 43.3333333333, 60.0, 66.6666666667, 90.0]) == pytest.approx(
        1.0 / 3.0
    )


@in_browser
def test_what_one_law_is_warned_of_stands_under_that_law(
    chromium: Browser, page: Path, held: dict[str, Any], tmp_path: Path
) -> None:
    name, count = held["laws"][1]["name"], len(held["sentences"])
    warned = held | {
        "sentences": [*held["sentences"], f"{name}: too thin a film.", "Tips are thin."],
        "told": [[[], [count, count + 1]] for _ in held["told"]],
    }
    text = re.sub(
        r'(id="explored">)[^<]*', rf"\g<1>{packed(warned)}", page.read_text("utf-8"), count=1
    )
    (tmp_path / "warned.html").write_text(text, "utf-8")
    chromium.open(tmp_path / "warned.html", 1280, prefers_reduced_motion="reduce")
    chromium.wait(DRAWN)
    told = "document.getElementById('told').textContent"
    assert chromium.run(told) == "Warning. Tips are thin."
    choose = "(m => { m.selectedIndex = 1; m.dispatchEvent(new Event('input', {bubbles: true})) })"
    chromium.run(f"{choose}(document.getElementById('law'))")
    chromium.wait(f"{told}.includes({name!r} + ': too thin a film.')")


def half_a_phase_on(chromium: Browser, tmp_path: Path, example: str, turns: str) -> np.ndarray:
    """How far bodies of a drive of stages turn in half a phase, by a script that reads where they stand."""
    read = Reader()
    over = [Sweep(key="operation.speed", start="1000 rpm", stop="1500 rpm", count=2.0)]
    found = explore(str(EXAMPLES / f"{example}.toml"), over, read=read)
    write_explorer(found, read.drawings, tmp_path / "drive.html")
    chromium.open(tmp_path / "drive.html", 1280, prefers_reduced_motion="reduce")
    chromium.wait(DRAWN)
    before = np.array(chromium.run(turns))
    phase = "(s => { s.value = 0.5; s.dispatchEvent(new Event('input')) })"
    chromium.run(f"{phase}(document.getElementById('phase'))")
    return np.array(chromium.run(turns)) - before


@in_browser
@pytest.mark.whole
def test_stages_turn_together(chromium: Browser, tmp_path: Path) -> None:
    """The wheel of one stage and the pinion of the next are on one shaft."""
    turns = "[...document.querySelectorAll('.moving:not([hidden]) .close .gear')].map(one => "
    turns += "Number(one.getAttribute('transform').match(/rotate.([-0-9.]+)/)[1]))"
    wheel, first, other, pinion = half_a_phase_on(chromium, tmp_path, "two_stage", turns)
    assert abs(pinion) > 1.0
    assert pinion == pytest.approx(wheel, rel=1e-6)
    assert wheel * first < 0.0
    assert other * pinion < 0.0
    place = chromium.run("document.getElementById('place').textContent")
    assert place.startswith("Stage 1, phase 0.50: ")
    assert "; Stage 2, phase 0.1" in place
    assert chromium.console == []


@in_browser
@pytest.mark.whole
def test_a_wave_turns_with_the_wheel_before_it(chromium: Browser, tmp_path: Path) -> None:
    """The wheel of the spur pair and the wave generator are on one shaft."""
    wheel = "Number(document.querySelector('.moving:not([hidden]) .close .gear-2')"
    wheel += ".getAttribute('transform').match(/rotate.([-0-9.]+)/)[1])"
    wave = "(one => Math.atan2(one.getAttribute('x1'), -one.getAttribute('y1')) * 180 / Math.PI)"
    wave += "(document.querySelector('.moving:not([hidden]) .whole .axis'))"
    turns = f"[{wheel}, {wave}]"
    turned, waved = half_a_phase_on(chromium, tmp_path, "spur_and_strain_wave", turns)
    assert abs(turned) > 1.0
    assert waved == pytest.approx(turned, rel=1e-6)
    assert chromium.console == []


@in_browser
def test_teeth_move_only_when_asked_and_change_with_the_design(driven: Browser) -> None:
    before = driven.run(GEAR)
    assert driven.run("document.getElementById('play').textContent") == "Play"
    assert driven.run(f"new Promise(done => setTimeout(() => done({GEAR} === {before!r}), 300))")
    driven.run("document.getElementById('play').click()")
    driven.wait(f"{GEAR} !== {before!r}")
    driven.run("document.getElementById('play').click()")
    phase = "(s => { s.value = 0.5; s.dispatchEvent(new Event('input')) })"
    driven.run(f"{phase}(document.getElementById('phase'))")
    assert "phase 0.50: " in driven.run("document.getElementById('place').textContent")
    first = "document.querySelector('.moving:not([hidden]) svg').id"
    old = driven.run(first)
    slide(driven, SHIFT, 0.94)
    assert driven.run(first) != old
    assert "profile shift, gear 1 = 1." in driven.run(
        "document.getElementById('drawn').textContent"
    )
    assert driven.console == []


@in_browser
def test_what_is_not_possible_is_a_sentence(driven: Browser) -> None:
    sentence = "document.getElementById('impossible').textContent"
    shown = "document.getElementById('possible').offsetParent !== null"
    assert driven.run(f"[{sentence}, {shown}]") == ["", True]
    slide(driven, SHIFT, 1.9)
    assert driven.run(sentence).startswith("Not possible: ")
    assert driven.run(shown) is False
    slide(driven, SHIFT, 1.3)
    assert "at profile shift, gear 1 = 1.9" in driven.run(sentence)
    assert driven.run(shown) is False
    values = "[...document.querySelectorAll('[data-value]')].map(v => v.textContent)"
    assert set(driven.run(values)) == {"not possible"}
    slide(driven, SHIFT, 1.15)
    assert driven.run(f"[{sentence}, {shown}]") == ["", True]
    assert driven.console == []


@in_browser
def test_teeth_move_of_themselves_where_motion_is_welcome(chromium: Browser, page: Path) -> None:
    chromium.open(page, 1280, prefers_reduced_motion="no-preference", prefers_color_scheme="dark")
    chromium.wait(DRAWN)
    before = chromium.run(GEAR)
    chromium.wait(f"{GEAR} !== {before!r}")
    assert chromium.run("document.getElementById('play').textContent") == "Stop"
    assert chromium.console == []
