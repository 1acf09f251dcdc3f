"""Pages of many designs in a real browser: brushed by mouse and keyboard, against selections of the study."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from browser import CHROMIUM, Browser, browser
from many_designs import KEYS, quick_study
from seen import faults_on_screen
from sound import quick_first

from pitchpoint.views.study_report import render_study

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")

LOSS, STRESS = "mean_loss", "largest_root_stress"


@pytest.fixture(scope="module")
def study() -> xr.Dataset:
    with pytest.MonkeyPatch.context() as patch:
        return quick_study(patch, n=512)


@pytest.fixture(scope="module")
def path(study: xr.Dataset, tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = tmp_path_factory.mktemp("designs") / "report.html"
    page.write_text(render_study(study, case_file=Path("many/case.toml")), "utf-8")
    return page


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    with browser() as page:
        yield page


@pytest.fixture
def page(chromium: Browser, path: Path) -> Browser:
    chromium.open(path, 1200)
    chromium.wait("document.documentElement.dataset.drawn === 'all'")
    return chromium


def mouse(page: Browser, *steps: tuple[float, float]) -> None:
    """Presses at the first place, moves along, and lets go at the last one."""
    button = {"button": "left", "clickCount": 1, "pointerType": "mouse"}
    for kind, (x, y) in [
        ("mouseMoved", steps[0]),
        ("mousePressed", steps[0]),
        *(("mouseMoved", step) for step in steps[1:]),
        ("mouseReleased", steps[-1]),
    ]:
        held = {"buttons": 0} if kind == "mouseReleased" else {"buttons": 1}
        page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **button, **held)
    settled(page)


def settled(page: Browser) -> None:
    page.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def box(page: Browser, selector: str) -> Mapping[str, float]:
    """Where something is in the window, once it is in its middle."""
    page.run(
        f"document.querySelector({selector!r}).scrollIntoView({{block: 'center', behavior: 'instant'}})"
    )
    settled(page)
    return dict(page.run(f"document.querySelector({selector!r}).getBoundingClientRect().toJSON()"))


def brush(page: Browser, name: str, least: float, largest: float) -> tuple[float, float]:
    """Drags along an axis between two shares of its height; the limits that its boxes then have."""
    axis = box(page, f'[data-axis="{name}"]')
    x = axis["x"] + axis["width"] / 2.0
    ends = [axis["y"] + axis["height"] * (1.0 - share) for share in (least, largest)]
    mouse(page, (x, ends[0]), (x, sum(ends) / 2.0), (x, ends[1]))
    return limits(page, name)


def limits(page: Browser, name: str) -> tuple[float, float]:
    low, high = page.run(
        f"[...document.querySelectorAll('input[data-limit=\"{name}\"]')].map(box => box.value)"
    )
    return float(low or "-inf"), float(high or "inf")


def selected(page: Browser) -> int:
    return int(page.run("parseInt(document.getElementById('count').textContent)"))


def count(study: xr.Dataset, **ends: tuple[float, float]) -> int:
    """Designs with figures within limits, by name with two underscores for a point."""
    data = study.isel(law=0)
    chosen = np.isfinite(data[LOSS])
    for name, (low, high) in ends.items():
        values = data[name.replace("__", ".")]
        chosen = chosen & (values >= low) & (values <= high)
    return int(chosen.sum())


def test_a_key_with_one_level_has_its_name_at_both_ends_of_the_scale(
    chromium: Browser, study: xr.Dataset, tmp_path: Path
) -> None:
    one = study.assign_coords({KEYS[0]: (study[KEYS[0]].dims, np.full(512, "steel"))})
    (tmp_path / "one.html").write_text(render_study(one), "utf-8")
    chromium.open(tmp_path / "one.html", 1200)
    chromium.wait("document.documentElement.dataset.drawn === 'all'")
    chromium.run(
        f"(() => {{ const box = document.getElementById('colour'); box.value = '{KEYS[0]}';"
        "box.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    settled(chromium)
    told = chromium.run("document.getElementById('scale').textContent")
    assert told == f"{KEYS[0]}: steelsteel"


def test_a_drag_along_an_axis_selects_what_xarray_selects(page: Browser, study: xr.Dataset) -> None:
    assert selected(page) == count(study) > 400
    torque = brush(page, KEYS[0], 0.3, 0.7)
    assert 20.0 < torque[0] < torque[1] < 90.0
    assert selected(page) == count(study, operation__torque=torque) < count(study)
    loss = brush(page, LOSS, -0.1, 0.5)  # from below the axis on: no least one
    assert loss[0] == -np.inf
    both = count(study, operation__torque=torque, mean_loss=loss)
    assert selected(page) == both > 0
    shown = page.run("document.querySelectorAll('#selected tbody tr').length")
    assert shown == min(both, 12)
    # The rows are the best by what colours the lines.
    data = study.isel(law=0)
    inside = (data[KEYS[0]] >= torque[0]) & (data[KEYS[0]] <= torque[1]) & (data[LOSS] <= loss[1])
    best = np.argmax(data["mean_efficiency"].where(inside).fillna(-1.0).values)
    assert page.run("document.querySelector('#selected tbody th').textContent") == str(best)
    axis = box(page, f'[data-axis="{LOSS}"]')
    mouse(page, (axis["x"] + 18.0, axis["y"] + 40.0))  # a click takes its limits away
    assert selected(page) == count(study, operation__torque=torque)
    page.call("Input.dispatchKeyEvent", type="keyDown", key="Escape")
    settled(page)
    assert selected(page) == count(study)
    assert page.console == []


def test_limits_can_be_written(page: Browser, study: xr.Dataset) -> None:
    box(page, f'input[data-limit="{STRESS}"][data-end="1"]')
    page.run(f'document.querySelector(\'input[data-limit="{STRESS}"][data-end="1"]\').focus()')
    page.call("Input.insertText", text="300")
    settled(page)
    assert selected(page) == count(study, largest_root_stress=(-np.inf, 300.0)) < count(study)
    page.run("document.getElementById('clear').click()")
    settled(page)
    assert selected(page) == count(study)


def test_a_rectangle_selects_in_both_figures(page: Browser, study: xr.Dataset) -> None:
    names = [page.run(f"document.getElementById('{axis}').value") for axis in "xy"]
    frame = box(page, "#scatter svg")
    at = lambda x, y: (frame["x"] + x * frame["width"], frame["y"] + y * frame["height"])  # noqa: E731
    mouse(page, at(0.3, 0.3), at(0.4, 0.5), at(0.7, 0.7))
    ends = {name.replace(".", "__"): limits(page, name) for name in names}
    assert selected(page) == count(study, **ends)
    assert 0 < selected(page) < count(study)


def test_the_front_is_that_of_every_design_against_every_other(
    page: Browser, study: xr.Dataset
) -> None:
    for axis, name in (("x", LOSS), ("y", "min_lambda_ratio")):
        page.run(
            f"(document.getElementById('{axis}').value = '{name}', "
            f"document.getElementById('{axis}').dispatchEvent(new Event('change')), null)"
        )
    settled(page)
    data = study.isel(law=0)
    costs = np.stack([data[LOSS].values, -data["min_lambda_ratio"].values])
    worse, bad = costs[:, :, None] > costs[:, None], costs[:, :, None] >= costs[:, None]
    front = np.isfinite(costs[0]) & ~(worse.any(axis=0) & bad.all(axis=0)).any(axis=1)
    caption = page.run("document.querySelector('#front-table caption').textContent")
    assert re.match(rf"(\d+ of )?{front.sum()} designs on the front of all designs", caption)
    numbers = page.run(
        "[...document.querySelectorAll('#front-table tbody th')].map(cell => cell.textContent)"
    )
    assert {*map(int, numbers)} <= {*np.flatnonzero(front).tolist()}


def test_a_design_that_is_opened_says_its_command(page: Browser, study: xr.Dataset) -> None:
    button = box(page, "#selected tbody button")
    mouse(page, (button["x"] + 5.0, button["y"] + 5.0))
    number = int(page.run("document.querySelector('#selected tbody button').textContent"))
    assert page.run("document.getElementById('design-name').textContent") == f"Design {number}"
    command = page.run("document.getElementById('command').textContent")
    assert command.startswith("pitchpoint run many/case.toml --set ")
    written = dict(re.findall(r'--set "([\w.]+)=([^"]+)"', command))
    for key in KEYS:
        value, _, unit = written[key].partition(" ")
        assert float(value) == pytest.approx(float(study[key][number]), rel=1e-14)
        assert unit == study[key].attrs["units"]


def test_another_law_has_other_figures(page: Browser, study: xr.Dataset) -> None:
    page.run(
        "(document.getElementById('law').value = '1', "
        "document.getElementById('law').dispatchEvent(new Event('change')), null)"
    )
    settled(page)
    loss = brush(page, LOSS, 0.2, 0.6)
    values = study[LOSS].isel(law=1)
    assert selected(page) == int(((values >= loss[0]) & (values <= loss[1])).sum()) > 0


@pytest.mark.parametrize("width", quick_first([1200, 420]))
@pytest.mark.parametrize("scheme", quick_first(["light", "dark"]))
def test_nothing_is_cut_or_overlapping(
    chromium: Browser, path: Path, width: int, scheme: str
) -> None:
    assert faults_on_screen(chromium, path, width, scheme) == []


def test_tables_stand_without_a_script(chromium: Browser, path: Path) -> None:
    chromium.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        chromium.call("Page.navigate", url=path.resolve().as_uri())
        chromium.wait("document.querySelector('noscript') !== null")
        text = chromium.run("document.body.innerText")
    finally:
        chromium.call("Emulation.setScriptExecutionDisabled", value=False)
    for words in (
        "The best design by each figure",
        "Designs on the front",
        "rank correlation",
        "switched off",
    ):
        assert words in text
    assert "Drag along an axis" not in text
