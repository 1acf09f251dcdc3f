"""The report in a real browser, wide and narrow, light and dark: drawn, driven, saved, a silent console."""

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
from browser import CHROMIUM, Browser, browser
from pages import payload
from seen import PAPER, faults_on_paper, faults_on_screen, faults_shown, pages
from sound import SMOOTH, quick_first

from pitchpoint import views
from pitchpoint.runs.run import run_case
from pitchpoint.views.figures import INK, PALETTE
from pitchpoint.views.report import write_report

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")

ALL = "document.documentElement.dataset.drawn === 'all'"
VISIBLE = "[...document.querySelectorAll('.plot')].filter(p => p.offsetParent)"
CASE = f"""
title = "A pair & <b>its</b> loss"
{SMOOTH}
[loss_map]
count = 3
[variants.one.models]
friction = ["iso_tr_14179_2", "xu_2007"]
[variants.other.models]
friction = "constant"
[studies.shape]
title = "Shape"
sweep = {{ key = "gears.addendum", start = 1.0, stop = 1.4, count = 3 }}
[studies.wide]
title = "Two points, a table wider than a narrow screen"
sweep = {{ key = "gears.addendum", values = [1.0, 1.2] }}
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("in_browser")
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    write_report(run_case(str(folder / "case.toml"), folder=folder / "out"), folder / "report.html")
    return folder / "report.html"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    with browser() as one:
        yield one


@pytest.fixture
def wide(chromium: Browser, report: Path) -> Browser:
    """The report on a wide screen, as the test before has left it."""
    if chromium.window != (1280, {}):
        chromium.open(report, 1280)
        chromium.wait(ALL)
    return chromium


def top(page: Browser, selector: str) -> float:
    return float(
        page.run(f"document.querySelector({selector!r}).getBoundingClientRect().top + scrollY")
    )


@pytest.mark.parametrize("width", quick_first([1280, 500]))
@pytest.mark.parametrize("scheme", quick_first(["light", "dark"]))
def test_all_is_drawn_and_the_console_is_silent(
    chromium: Browser, report: Path, width: int, scheme: str
) -> None:
    chromium.open(report, width, prefers_color_scheme=scheme)
    chromium.wait(ALL)
    assert chromium.run(f"{VISIBLE}.every(p => p.querySelector('svg'))")
    assert top(chromium, "main figure svg") < 1200
    assert top(chromium, ".tiles strong") < 1200
    assert chromium.run("document.documentElement.scrollWidth") <= width
    ground = chromium.run(
        "getComputedStyle(document.querySelector('.plot .main-svg')).backgroundColor"
    )
    assert (ground == "rgb(255, 255, 255)") == (scheme == "light")
    assert chromium.console == []


@pytest.mark.parametrize("scheme", quick_first(["light", "dark"]))
def test_nothing_is_cut_empty_or_overlapping_on_screens_and_on_paper(
    chromium: Browser, report: Path, scheme: str
) -> None:
    assert faults_on_screen(chromium, report, 500, scheme) == []
    assert faults_on_screen(chromium, report, 1280, scheme) == []
    before = chromium.run(_LOOKS)
    assert pages(chromium.printed()) > 1
    assert faults_on_paper(chromium) == []
    assert chromium.run(_LOOKS) == before
    chromium.window = None


_LOOKS = """[
  document.querySelector('#cycle_efficiency .main-svg').style.background,
  document.querySelector('#cycle_efficiency').clientWidth,
  document.querySelectorAll('details[open]').length,
  document.querySelectorAll('.pane[hidden]').length,
]"""
"""What printing changes for a while."""

_SPOILED = {
    "wider than its window": "document.querySelector('#models table').style.width = '2000px'",
    "wider than its place": "document.querySelector('.tiles dd').style.width = '900px'",
    "overlap": "document.querySelector('#cycle h2').style.marginBottom = '-60px'",
    "empty": "document.querySelectorAll('#cycle_friction .trace').forEach(one => one.remove())",
    "cut": "document.querySelector('#cycle_input_torque .xtitle').setAttribute('x', 9999)",
    '" on "': "Plotly.relayout('along_loss', {'yaxis.tickfont.size': 60})",
    "is broken": "document.querySelector('#models thead th').style.cssText = 'display: block; width: 30px'",
    "is parted": "document.querySelector('#sources').innerHTML += '<p style=width:3em>It is 123 µm</p>'",
    '"μ = 1" is parted': "document.querySelector('#sources').innerHTML += '<p style=width:3em>At μ = 1'",
    "alone on an axis": "Plotly.relayout('along_loss', {'yaxis.tickvals': [5]})",
    "not as printed": "document.querySelector('#sources').innerHTML += '<p>Oil at 20 degC'",
    "is not set low": "document.querySelector('#models').innerHTML += '<p>At K_A = 1'",
    "more digits than anybody reads": "document.querySelector('#models').innerHTML += '<p>31.949566 mm'",
    "could have a smaller unit": "document.querySelector('#models').innerHTML += '<p>8.2e−5 kg m²'",
    "not level": "document.querySelector('#cycle_input_torque').style.marginTop = '20px'",
    "told from its ground": "document.querySelector('#along_loss .xtitle').style.fill = '#fafafa'",
}


@pytest.mark.parametrize("fault", _SPOILED)
def test_what_is_cut_empty_or_overlapping_is_found(wide: Browser, fault: str) -> None:
    assert faults_shown(wide, 1280) == []
    wide.run(f"({_SPOILED[fault]}, null)")
    assert any(fault in words for words in faults_shown(wide, 1280))
    wide.window = None


def test_a_table_wider_than_a_narrow_window_is_found_and_widens_nothing_else(
    chromium: Browser, report: Path
) -> None:
    chromium.open(report, 500)
    chromium.wait(ALL)
    table = "<div class=scroll><table class=compact><td style=min-width:470px>1</table></div>"
    chromium.run(
        f"(document.querySelector('#models').insertAdjacentHTML('beforeend', '{table}'), null)"
    )
    (fault,) = faults_shown(chromium, 500)
    assert "behind the edge of the window" in fault


def test_a_bright_map_on_dark_paper_is_found(chromium: Browser, report: Path) -> None:
    chromium.open(report, 1280, prefers_color_scheme="dark")
    chromium.wait(ALL)
    assert faults_shown(chromium, 1280) == []
    bright = "{colorscale: [[[0, '#ffc'], [1, '#fff']]]}"
    chromium.run(f"Plotly.restyle('map_mean_loss', {bright}).then(() => null)")
    assert faults_shown(chromium, 1280) == ["figure map_mean_loss: a bright map on dark paper"]


def test_lines_stand_out_from_dark_paper_and_have_their_colours_back_on_white(
    chromium: Browser, tmp_path: Path
) -> None:
    """Reddish purple and the palest of shades would not with their lightness turned over alone."""
    templates = Path(views.__file__).parent / "templates"
    style, script = ((templates / one).read_text("utf-8") for one in ("style.css", "figures.js"))
    colours = [*PALETTE, "#a6cee3", "#9aa5ad", INK]
    lines = "".join(f'<svg><line stroke="{one}"/></svg>' for one in colours)
    given = "window.turned = { dressed, unlit };"
    page = f"""<style>{style}</style><section><div class=keys><span>{lines}</span></div></section>
        <script>(() => {{ {script} {given} }})()</script>"""
    (tmp_path / "lines.html").write_text(f"<html data-drawn=all>{page}</html>", "utf-8")
    chromium.open(tmp_path / "lines.html", 1280, prefers_color_scheme="dark")
    assert faults_shown(chromium, 1280) == []
    strokes = chromium.run(
        "[...document.querySelectorAll('line')].map(one => one.getAttribute('stroke'))"
    )
    assert strokes == chromium.run(f"{colours}.map(one => turned.dressed('color', one))")
    assert len({*strokes}) == len(colours)
    assert chromium.run(f"{strokes}.map(turned.unlit)") == colours
    chromium.run("document.querySelector('line').setAttribute('stroke', '#984874')")
    assert any("line #984874 cannot be told" in one for one in faults_shown(chromium, 1280))
    chromium.window = None


def test_figures_stay_whole_and_with_what_is_above_them_wherever_a_page_ends(
    chromium: Browser, tmp_path: Path
) -> None:
    """Wherever a panel begins on a page; a legend of flexible parts lets go of its figures."""
    figure = "<figure><figcaption>Loss</figcaption><svg width=300 height=230></svg></figure>"
    law = f"<label>{'Friction law ' * 3}</label>"
    panel = f"""<div class=above></div><h3>Study</h3><p class=note>Swept.</p><div class=legend>{4 * law}
        </div><div class=figures>{4 * figure}</div>"""
    style = (Path(views.__file__).parent / "templates" / "style.css").read_text("utf-8")
    page = f"<style>{style}</style><style></style><main><section>{panel}</section></main>"
    (tmp_path / "panel.html").write_text(f"<html data-drawn=all>{page}</html>", "utf-8")
    chromium.open(tmp_path / "panel.html", PAPER[0])
    chromium.call("Emulation.setEmulatedMedia", media="print")

    assert faults_wherever_a_page_ends(chromium, "") == set()
    for rule in (
        ".legend { display: flex !important; }",
        "h3, p { break-after: auto !important; }",
    ):
        found = faults_wherever_a_page_ends(chromium, rule)
        assert any("left behind at the end of a page" in one for one in found), rule
    chromium.call("Emulation.setEmulatedMedia", media="")
    chromium.window = None


def faults_wherever_a_page_ends(page: Browser, rule: str) -> set[str]:
    """On paper, for what stands under `.above` and a rule in the second style of the page."""
    page.run(f"document.querySelectorAll('style')[1].textContent = '{rule}'")
    found = set()
    for above in range(600, 1000, 25):
        page.run(f"document.querySelector('.above').style.height = '{above}px'")
        found.update(faults_shown(page, *PAPER))
    return found


def test_no_row_of_a_table_is_alone_on_a_page(chromium: Browser, tmp_path: Path) -> None:
    tables = "".join(
        f"<h3>{rows} keys</h3><table><thead><tr><th>Key</thead><tbody>{'<tr><td>1 mm</tr>' * rows}</table>"
        for rows in (1, 2, 3, 5)
    )
    style = (Path(views.__file__).parent / "templates" / "style.css").read_text("utf-8")
    marks = f"<p class=marks>{'<span>printed stands in the source</span> ' * 9}</p>"
    body = f"<div class=above></div><h2>Inputs</h2>{marks}{tables}"
    page = f"<style>{style}</style><style></style><main><section>{body}</section></main>"
    (tmp_path / "rows.html").write_text(f"<html data-drawn=all>{page}</html>", "utf-8")
    chromium.open(tmp_path / "rows.html", PAPER[0])
    chromium.call("Emulation.setEmulatedMedia", media="print")
    assert faults_wherever_a_page_ends(chromium, "") == set()
    found = faults_wherever_a_page_ends(chromium, "tr { break-before: auto !important; }")
    assert any("a row alone" in one for one in found)
    found = faults_wherever_a_page_ends(chromium, ".marks { display: flex !important; }")
    assert any("left behind" in one for one in found)
    chromium.call("Emulation.setEmulatedMedia", media="")
    chromium.window = None


def test_the_page_that_sums_up_fills_its_sheet_however_long_it_is(wide: Browser) -> None:
    sheet = "document.querySelector('#one-page > div')"
    rows = f"[...{sheet}.querySelectorAll('tr')].map(row => row.cloneNode(true))"
    wide.run(f"{sheet}.append(...{rows})")
    wide.run("dispatchEvent(new Event('beforeprint'))")
    box = f"(({{ width, height }}) => [width, height])({sheet}.getBoundingClientRect())"
    width, height = wide.run(box)
    scale = float(wide.run(f"{sheet}.style.zoom"))
    wide.window = None
    assert 0.3 < scale < 0.9
    assert width == pytest.approx(688, abs=2)
    assert 975 < height <= 1005


def test_the_picture_beside_the_answer_moves_with_the_teeth(wide: Browser) -> None:
    place = "document.querySelector('.mesh .gear').getAttribute('transform')"
    before = wide.run(place)
    wide.run("document.querySelector('[data-plays]').click()")
    wide.wait(f"{place} !== {before!r}")
    wide.run("document.querySelector('[data-plays]').click()")
    assert wide.run("document.querySelector('[data-plays]').textContent") == "Play"
    assert wide.run("document.querySelector('.glance svg').getBoundingClientRect().height") > 200


def test_a_slider_moves_the_teeth(wide: Browser) -> None:
    told = "document.querySelector('.mesh output').textContent"
    move = "(s => { s.value = 0.75; s.dispatchEvent(new Event('input')) })"
    wide.run(f"{move}(document.querySelector('.mesh input'))")
    assert "phase 0.75" in wide.run(told)


def test_two_menus_choose_law_and_temperature_of_a_map(wide: Browser, report: Path) -> None:
    values = "JSON.stringify(document.getElementById('map_mean_loss').data[0].z)"
    names = "[...document.querySelectorAll('#map .menu')].map(m => m.firstChild.textContent.trim())"
    assert wide.run(names) == ["Friction", "Oil at"]
    maps = payload(report.read_text("utf-8"))["menus"]["map_mean_loss"]
    choose = "(m => { m.selectedIndex = (m.selectedIndex + 1) % 3; m.dispatchEvent(new Event('input')) })"
    for menu in (0, 1, 0, 1):
        wide.run(f"{choose}(document.querySelectorAll('#map select')[{menu}])")
        law, oil = wide.run(
            "[...document.querySelectorAll('#map select')].map(m => m.selectedIndex)"
        )
        chosen = json.dumps(maps[3 * law + oil]["map_mean_loss"][0]["z"][0])
        assert wide.wait(f"JSON.stringify({chosen}) === {values}")
    ends = "(t => [t.zmin, t.zmax])(document.getElementById('map_mean_loss').data[0])"
    low, high = wide.run(ends)
    assert low == 0.0 < high
    assert wide.console == []


def test_contents_stick_and_say_where_one_is(wide: Browser) -> None:
    here = "document.querySelector('nav [aria-current]').hash"
    wide.run("scrollTo({top: 0, behavior: 'instant'})")
    wide.wait(f"{here} === '#answer'")
    wide.run("document.getElementById('map').scrollIntoView({behavior: 'instant'})")
    assert wide.wait(f"{here} === '#map'")
    assert abs(wide.run("document.querySelector('nav').getBoundingClientRect().top")) < 1


def test_inputs_are_folded_until_asked_for(wide: Browser) -> None:
    assert wide.run("document.querySelector('#inputs details').open") is False
    wide.run("document.querySelector('nav a[href=\"#inputs\"]').click()")
    assert wide.wait("document.querySelector('#inputs details').open")


def test_one_variant_at_a_time(wide: Browser) -> None:
    shown = "[...document.querySelectorAll('#answer .pane')].filter(p => !p.hidden).map(p => p.dataset.pane)"
    assert wide.run(shown) == ["one"]
    wide.run("document.querySelectorAll('#answer .tabs button')[1].click()")
    assert wide.run(shown) == ["other"]


def test_a_figure_says_its_axes_and_curves_to_a_screen_reader(wide: Browser) -> None:
    words = wide.wait("document.getElementById('cycle_efficiency').getAttribute('aria-label')")
    assert words.startswith("Instantaneous efficiency over the mesh cycle, phase of the mesh cycle")
    assert "from 0 to 1" in words
    assert "Curves: ISO/TR 14179-2" in words


@pytest.mark.parametrize("kind", ["svg", "png", "csv"])
def test_every_figure_can_be_saved(wide: Browser, kind: str, tmp_path: Path) -> None:
    wide.save_to(tmp_path)
    saves = "p.closest('figure').querySelectorAll('.save button')"
    assert wide.run(f"{VISIBLE}.every(p => {saves}.length === 3)")
    at = ["svg", "png", "csv"].index(kind)
    figure = "document.getElementById('along_film_thickness')"
    wide.run(f"{figure}.closest('figure').querySelectorAll('.save button')[{at}].click()")
    saved = wide.saved(tmp_path / f"along_film_thickness.{kind}")
    if kind == "svg":
        assert ElementTree.fromstring(saved).tag.endswith("svg")
    elif kind == "png":
        assert saved.startswith(b"\x89PNG")
    else:
        rows = list(csv.reader(saved.decode("utf-8-sig").splitlines()))
        assert len({len(row) for row in rows}) == 1
        assert all(float(x) is not None for _, x, *_ in rows[1:] if x)
    assert wide.console == []


def test_what_stands_elsewhere_stays_folded_on_paper(wide: Browser) -> None:
    list_again = "<details class=elsewhere><summary>5 numbers were not met</summary></details>"
    wide.run(
        f"(document.querySelector('#answer').insertAdjacentHTML('beforeend', '{list_again}'), null)"
    )
    wide.run("dispatchEvent(new Event('beforeprint'))")
    assert wide.run("document.querySelectorAll('#answer details[open]').length") > 0
    assert not wide.run("document.querySelector('.elsewhere').open")
    wide.run("dispatchEvent(new Event('afterprint'))")
    wide.window = None
