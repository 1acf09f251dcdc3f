"""Every block of README and documentation runs, but for the two commands that set a clone up."""

import json
import re
import runpy
import shlex
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from documentation import PAGES, ROOT, block, blocks

import pitchpoint
from pitchpoint import cli
from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.comparison import compare
from pitchpoint.analyses.engagement import check_heights
from pitchpoint.cases.document import Document
from pitchpoint.cases.drive_schema import DriveCase
from pitchpoint.cases.height_maps import height_maps
from pitchpoint.cases.keys import keys
from pitchpoint.cases.schema import CaseFile
from pitchpoint.cases.study_tables import Target
from pitchpoint.cases.validation import validate
from pitchpoint.cases.variant import Variant
from pitchpoint.errors import InputError
from pitchpoint.lubrication.conditions import UNITS as CONDITIONS
from pitchpoint.published.publication_registry import PUBLICATIONS
from pitchpoint.results.store import dataset, save
from pitchpoint.results.variables import VARIABLES
from pitchpoint.runs import run
from pitchpoint.runs.compared_designs import resolved_reference
from pitchpoint.runs.jobs import jobs
from pitchpoint.runs.layouts import layout_of
from pitchpoint.runs.optimum_task import OptimiserTask
from pitchpoint.sizing.task_table import Task

PAIR, VARIANTS = blocks("README.md", "toml")
(WHOLE_WITH_VARIANTS,) = blocks("guide/variants.md", "toml")
_, MODIFIED = blocks("guide/pairs.md", "toml")
TASK_FILE, STRENGTH, SHAFT, INSPECTION, LIMITS = blocks("guide/sizing.md", "toml")
(PLASTIC,) = blocks("guide/stiffness.md", "toml")
(MOTION,) = blocks("guide/motion.md", "toml")
FILM, OIL, FINITE, HEIGHTS = blocks("guide/films.md", "toml")
WEAR, WORN = blocks("guide/wear.md", "toml")
STAGES, PLANETARY, SETS, STEPPED, THREE_K, TRAIN, OF_TRAIN = blocks("guide/stages.md", "toml")
(TARGETS,) = blocks("guide/targets.md", "toml")
(RACK,) = blocks("gears/rack_and_pinion.md", "toml")
(TORUS,) = blocks("gears/torus.md", "toml")
(WAVE,) = blocks("gears/strain_wave.md", "toml")
(UNITS,) = blocks("guide/commands.md", "toml")
(BALL,) = blocks("gears/ball_on_disc.md", "toml")
SHELL = [
    line
    for page in PAGES
    for text in blocks(page, "sh")
    for line in text.replace("\\\n", "").splitlines()
]
TASK_READ = Task.read
SET_UP = [
    "sh bootstrap && .venv/bin/pitchpoint run tian2024",
    "sh bootstrap dev && .venv/bin/pytest",
]
CASES = {
    "pair": PAIR,
    "modified": (PAIR, MODIFIED),
    "strength": (PAIR, STRENGTH),
    "shaft": (PAIR, SHAFT),
    "inspection": (PAIR, INSPECTION),
    "plastic": (PAIR, PLASTIC),
    "motion": (PAIR, MOTION),
    "film": (PAIR, FILM),
    "oil": (PAIR, OIL),
    "wear": (PAIR, WEAR),
    "finite": (PAIR, FINITE),
    "rack": (PAIR, RACK),
    "torus": (PAIR, TORUS),
    "wave": WAVE,
    "limits": (WAVE, LIMITS),
    "stages": STAGES,
    "planetary": PLANETARY,
    "sets in a row": SETS,
    "stepped": (PLANETARY, STEPPED),
    "3K set": (PLANETARY, THREE_K),
    "train": TRAIN,
    "losses of a train": (PLANETARY, OF_TRAIN),
    "ball": BALL,
    "targets": (WAVE, TARGETS),
    "units": (PAIR, UNITS),
}
"""Whole cases: a block that goes on with another stands behind it."""
PYTHON = {
    ("README.md", "result.summary"),
    ("guide/films.md", "solve_lines"),
    ("guide/films.md", "solve_patch"),
    ("guide/python.md", "write_report"),
    ("guide/python.md", "strain_wave.toml"),
    ("guide/python.md", "plot_in"),
    ("guide/python.md", "analyses="),
    ("guide/sizing.md", "def next_speed"),
    ("guide/sizing.md", "pp.size"),
    ("guide/simulators.md", "renewed_friction"),
    ("guide/simulators.md", "simulate_fmu"),
}
"""Blocks of Python by page and by what they alone hold; each is run by a test."""


def merged(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, Any]:
    both = {
        key: merged(first[key], second[key])
        for key in first.keys() & second.keys()
        if isinstance(first[key], dict)
    }
    return {**first, **second, **both}


def tree(name: str) -> dict[str, Any]:
    given = CASES[name]
    if isinstance(given, str):
        return tomllib.loads(given)
    first, second = map(tomllib.loads, given)
    if "family" in second.get("gears", {}):  # other gears, in the same oil
        first = {key: first[key] for key in ("lubricant", "roughness")}
    return merged(first, second)


OF_THE_SITE = ("{toctree}", "{cards}", "{teeth}")
"""Blocks that are run while the site is built."""


def test_every_block_is_known() -> None:
    kinds = re.findall(r"^```([^`\s]+)$", "\n".join(PAGES.values()), re.MULTILINE)
    assert set(kinds) <= {"sh", "toml", "python", "text", *OF_THE_SITE}
    assert all(block(page, "python", holding) for page, holding in PYTHON)
    assert sum(len(blocks(page, "python")) for page in PAGES) == len(PYTHON)
    assert sum(len(blocks(page, "toml")) for page in PAGES) == 33
    assert blocks("guide/pairs.md", "toml")[0] == PAIR
    assert [line for line in SHELL if "bootstrap" in line] == SET_UP


def test_every_link_leads_somewhere() -> None:
    for page, text in PAGES.items():
        folder = ROOT if page == "README.md" else (ROOT / "docs" / page).parent
        for target in re.findall(r"\]\(([^)#]+)", text):
            assert (folder / target).exists(), (page, target)


def test_what_is_wrong_with_the_links_of_a_site(tmp_path: Path) -> None:
    """`.ci/run` builds the site and asks the same of it."""
    broken = runpy.run_path(str(ROOT / "docs" / "check_links.py"))["broken"]
    (tmp_path / "b.html").write_text('<p id="here">', "utf-8")
    (tmp_path / "a.html").write_text(
        '<a href="b.html#here"></a><a href="b.html#there"></a><a href="c.html"></a><a href="#top"></a>'
        '<a href="https://a.example"></a><script src="https://a.example/x.js"></script>',
        "utf-8",
    )
    assert list(broken(tmp_path)) == [
        "a.html: b.html#there leads to no place of b.html",
        "a.html: c.html leads to no file",
        "a.html: #top leads to no place of a.html",
        "a.html: https://a.example/x.js is loaded from another site",
    ]


def test_the_reference_is_that_of_the_code(tmp_path: Path) -> None:
    """`python docs/generate.py docs/reference` writes it anew."""
    generate = runpy.run_path(str(ROOT / "docs" / "generate.py"))
    generate["write"](tmp_path)
    for path in tmp_path.iterdir():
        assert path.read_text("utf-8") == (ROOT / "docs/reference" / path.name).read_text("utf-8")


def test_every_key_and_variable_has_its_line() -> None:
    generate = runpy.run_path(str(ROOT / "docs" / "generate.py"))
    lines = [line for text in generate["keys_pages"]().values() for line in rows(text)]
    for table in (CaseFile, DriveCase):
        assert {key.rpartition(".")[2] for key in keys(table)} <= {line[0] for line in lines}
    assert "set" in {line[0] for line in rows(generate["keys_pages"]()["keys_losses.md"])}
    assert all(told.endswith(".") for _, told, *_ in lines)
    own = [one.variables for one in (*ANALYSES.values(), *PUBLICATIONS.values())]
    every = [line for text in generate["variables_pages"]().values() for line in rows(text)]
    listed = {name: line for name, *line in every}
    assert {name for each in (VARIABLES, *own) for name in each} == listed.keys()
    assert all(told and unit and shown for told, _, unit, shown, *_ in listed.values())


def test_the_guide_has_every_condition_of_a_law() -> None:
    table = PAGES["guide/python.md"].partition("may ask for\n")[2]
    told = [line.split("|")[1:3] for line in table.splitlines() if line.startswith("| `")]
    listed = [name for names, _ in told for name in re.findall(r"`(\w+)`", names)]
    assert sorted(listed) == sorted(CONDITIONS)
    for names, units in told:
        of = [CONDITIONS[name] for name in re.findall(r"`(\w+)`", names)]
        assert units.strip() in (", ".join(of), of[0]) and (len(set(of)) == 1 or ", " in units)


def test_every_public_name_stands_under_one_task() -> None:
    generate = runpy.run_path(str(ROOT / "docs" / "generate.py"))
    documented = re.findall(r"^### pp\.(\w+)$", generate["api_page"](), re.MULTILINE)
    assert sorted(documented) == sorted(pitchpoint._LAZY)
    assert "## More" not in generate["api_page"]()


GALLERY = sorted((ROOT / "docs" / "gallery").glob("*.md"))


def test_every_page_of_the_gallery_has_its_card() -> None:
    index = PAGES["index.md"]
    cards, tree = (
        re.findall(r"^gallery/(\w+)$", part, re.MULTILINE) for part in cards_and_tree(index)
    )
    assert sorted(cards) == [path.stem for path in GALLERY]
    assert cards == tree
    assert len(cards) >= 14


def cards_and_tree(index: str) -> tuple[str, str]:
    """Cards of the first page, and what stands behind them."""
    cards, _, rest = index.partition("```{cards}")[2].partition("```")
    return cards, rest


@pytest.fixture(scope="module")
def gallery() -> dict[str, Any]:
    return runpy.run_path(str(ROOT / "docs" / "notebooks.py"))


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.stem)
def test_a_page_as_a_notebook(path: Path, gallery: dict[str, Any]) -> None:
    """Its cells are those of the page, in order, and its words lead to no files."""
    page = path.read_text("utf-8")
    book = json.loads(gallery["notebook"](page))
    code = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
    assert code == [
        text.strip() for text in re.findall(r"\{code-cell\} ipython3\n(.*?)```", page, re.DOTALL)
    ]
    assert all(compile(text, path.name, "exec") for text in code)
    assert not re.search(r"\]\([^)]*\.md", json.dumps(book["cells"]))


def test_the_data_of_a_figure_are_read_from_its_page(gallery: dict[str, Any]) -> None:
    data, layout = [{"y": [1.0, None, 3.0]}], {"title": {"text": "a, \u003cb\u003e"}}
    page = f'x(1); Plotly.newPlot( "id",  {json.dumps(data)}, {json.dumps(layout)}, {{}} )'
    assert gallery["figure_of"](page) == {"data": data, "layout": layout}


def test_a_thumbnail_is_drawn_of_curves_and_of_maps(gallery: dict[str, Any]) -> None:
    thumbnail = gallery["thumbnail"]
    curve = {"x": [1.0, 10.0, 100.0], "y": [0.0, float("nan"), 2.0]}
    assert thumbnail({"data": [curve]}).count("<polyline") == 0  # two points, each alone
    curve["y"] = [0.0, 1.0, 2.0]
    drawn = thumbnail({"data": [curve], "layout": {"xaxis": {"type": "log"}}})
    assert 'points="12.0,138.0 140.0,75.0 268.0,12.0"' in drawn
    assert (
        thumbnail({"data": [{"type": "heatmap", "z": [[0.0, 1.0], [2.0, 3.0]]}]}).count("<rect")
        == 5
    )


def rows(page: str) -> list[list[str]]:
    """Cells of the tables of a page, the name of each row without its quotes."""
    lines = [line for line in page.splitlines() if line.startswith("| `")]
    return [re.findall(r"\| `?((?:\\.|[^|\\])*?)`? (?=\|)", line) for line in lines]


@pytest.mark.parametrize("name", CASES)
def test_a_case(name: str) -> None:
    """Read, built, and its parts laid out, targets and sweeps with them."""
    made = [job.name for job in jobs(Variant(tree(name), "README.md", "default"), {})]
    assert ("vibration" in made) == (name in ("plastic", "motion"))
    assert ("start_up" in made) == (name == "motion")
    assert ("film" in made) == (name in ("film", "oil"))
    assert ("wear" in made) == (name == "wear")
    assert ("finite_film" in made) == (name == "finite")
    assert ("running" in made) == (
        name in ("wave", "limits", "targets", "stages", "sets in a row", "losses of a train")
    )
    assert ("load_limits" in made) == (name in ("wave", "limits", "targets"))
    assert ("kinematic_error" in made) == (name in ("modified", "wave", "limits", "targets"))


@pytest.mark.parametrize(
    "text", [f"{PAIR}\n{VARIANTS}", WHOLE_WITH_VARIANTS], ids=["README", "guide"]
)
def test_the_variants_of_the_text(text: str) -> None:
    given = tomllib.loads(text)
    built = {name: Variant(given, "README.md", name).built({}) for name in given["variants"]}
    assert next(iter(built)) == "as_drawn"
    cold, drawn = built["cold"].operation.temperature, built["as_drawn"].operation.temperature
    assert float(drawn - cold) == pytest.approx(40.0)
    polished = built["polished"].case
    assert polished.gears.teeth == built["cold"].case.gears.teeth
    assert polished.roughness != built["cold"].case.roughness


@pytest.mark.whole
def test_the_table_of_worn_flanks(tmp_path: Path) -> None:
    """A march of few turns, and what goes on from it."""
    case = merged(tree("wear"), {"wear": {"cycles": 10.0, "cells": 8, "phases": 4}})
    (wear,) = (one for one in jobs(Variant(case, "README.md", "default"), {}) if one.name == "wear")
    parts = [wear.compute(wear.pieces[0])]
    while (further := wear.onward(parts[-1])) is not None:
        parts.append(further)
    save(wear.joined(parts), tmp_path / "wear.nc")
    given = tomllib.loads(WORN)
    assert given["worn"]["file"] == "wear.nc"
    given["worn"] |= {"file": str(tmp_path / "wear.nc"), "cycles": 5.0}
    models = {"models": {"load_sharing": "from_stiffness"}}
    built = Variant(merged(merged(tree("pair"), models), given), "README.md", "default").built({})
    assert any("worn by 5 turns" in told for told in built.told)


@pytest.mark.whole
def test_the_table_of_heights(tmp_path: Path) -> None:
    given = merged(tree("finite"), tomllib.loads(HEIGHTS))
    map_, file = given["film"]["heights"]["gear_1"], tmp_path / "flank.csv"
    assert map_["file"] == file.name
    x, y = 5.0 * np.arange(-200, 201), 20.0 * np.arange(-600, 601)
    heights = 0.1 * np.cos(0.02 * x) * np.cos(0.005 * y[:, None])
    np.savetxt(file, heights, "%.4f", delimiter=",")
    map_["file"] = str(file)
    built = Variant(given, "README.md", "default").built({})
    (found,) = height_maps(built.case.film)
    assert not found.periodic and found.heights.shape == heights.shape
    assert float(found.x[-1] - found.x[0]) == pytest.approx(2e-3)
    check_heights(built)


def test_the_involute_flexspline_of_the_text() -> None:
    (found,) = re.findall(
        r"An involute flexspline is `tooth = (\{.*?\})`",
        " ".join(PAGES["gears/strain_wave.md"].split()),
    )
    given = tree("wave")
    given["gears"]["tooth"] = tomllib.loads(f"value = {found}")["value"]
    assert Variant(given, "README.md", "default").built({}).case.gears.tooth.form == "involute"


def test_the_target_reads_what_the_block_says() -> None:
    (given,) = validate(Document("README.md", tree("targets"))).targets
    assert isinstance(given, Target)
    torque = np.linspace(0.0, 94.0, 25)
    part = dataset({"wind_up": (("torque",), torque / 100e3)}, {"torque": torque})
    (row,) = compare([given], {"torsion": part})
    assert row.computed == pytest.approx(100.0)
    assert (row.bound, row.verdict) == ("< 2 x ", "pass")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder with the files that the blocks name; a loss map of few points."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pair.toml").write_text(f"{PAIR}[loss_map]\ncount = 3\n", "utf-8")
    return tmp_path


COMPARED = [line for line in SHELL if " compare " in line]
"""Designs beside each other, computed by tests of their own."""
EXPLORED = [line for line in SHELL if " explore " in line]
STUDIED = [line for line in SHELL if " study " in line]
SIZED = [line for line in SHELL if " size " in line]
OPTIMISED = [line for line in SHELL if " optimise " in line]


@pytest.mark.parametrize(
    "line", sorted({*SHELL} - {*SET_UP, *COMPARED, *EXPLORED, *STUDIED, *SIZED, *OPTIMISED})
)
def test_a_command(line: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Parsed and laid out as far as the computation itself."""
    laid_out = []

    def prepare(
        case: str, *, folder: Path, progress: object, overwrite: bool, **options: Any
    ) -> dict[str, Any]:
        laid_out.extend(run.uncomputed_manifests(case, **options))
        return {}

    monkeypatch.setattr(run, "run_case", prepare)
    monkeypatch.setattr(cli, "_write_report", lambda outcomes, folder: None)
    monkeypatch.setattr(cli, "_first_screen", lambda outcomes, report, tables: None)
    program, *arguments = shlex.split(line)
    assert program == ".venv/bin/pitchpoint"
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *arguments])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert laid_out[0]["title"] == "First stage of a robot joint"


@pytest.mark.parametrize("line", OPTIMISED)
def test_an_optimiser(line: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Checked as far as the first design."""
    tasks = []

    def prepare(task: OptimiserTask, *_: Any) -> None:
        tasks.append(task)
        raise SystemExit(0)

    monkeypatch.setattr("pitchpoint.runs.optimise._solved", prepare)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *shlex.split(line)[1:]])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert [len(task.varied) for task in tasks] == [2]


@pytest.mark.parametrize("line", STUDIED)
def test_designs_that_are_studied(line: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    laid_out = []

    def prepare(
        case: pitchpoint.Case, over: Mapping[str, Any], how: str, *, n: int, seed: int, **_: Any
    ) -> None:
        values = {case.key(key): ends for key, ends in over.items()}
        laid_out.append(layout_of(case.held[0], values, how, n, seed))
        raise SystemExit(0)

    monkeypatch.setattr("pitchpoint.runs.study.study", prepare)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *shlex.split(line)[1:]])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert [len(layout.changes(0, layout.count)) for layout in laid_out] == [64]


@pytest.mark.parametrize("line", COMPARED)
def test_designs_that_are_compared(line: str, folder: Path) -> None:
    program, command, *references = shlex.split(line.partition(" -o ")[0])
    assert (program, command) == (".venv/bin/pitchpoint", "compare")
    found = [resolved_reference(one) for one in references]
    assert [one.variant for one in found] == [None, "physical"]
    assert all(
        run.uncomputed_manifests(one.case, only=[one.variant] if one.variant else [])
        for one in found
    )


@pytest.mark.parametrize("line", SIZED)
def test_a_drive_that_is_sized(line: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Read as far as the search itself, which `test_size.py` runs."""
    tasks = []
    monkeypatch.chdir(tmp_path)
    Path("task.toml").write_text(TASK_FILE, "utf-8")

    def read(**values: Any) -> None:
        tasks.append(TASK_READ(**values))
        raise InputError("was read")

    monkeypatch.setattr(Task, "read", read)
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *shlex.split(line)[1:]])
    with pytest.raises(SystemExit):
        cli.main()
    assert [(task.torque, task.ratio) for task in tasks] == [(60.0, 60.0)]


def test_the_guide_has_every_option_of_a_task() -> None:
    (table,) = re.findall(r"^\| option .*?\n\n", PAGES["guide/sizing.md"], re.DOTALL | re.MULTILINE)
    told = {name.replace("-", "_") for name in re.findall(r"`--([\w-]+)`", table)}
    assert told | {"torque", "ratio", "speed", "life"} == {*Task.model_fields}


@pytest.mark.parametrize("line", EXPLORED)
def test_a_page_with_sliders(line: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program, *arguments = shlex.split(line)
    assert program == ".venv/bin/pitchpoint"
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *arguments])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 0
    assert "First stage of a robot joint" in (folder / "pair.html").read_text("utf-8")


@pytest.mark.parametrize("sweep", re.findall(r"`--sweep (\S+=\S+)`", PAGES["guide/pairs.md"]))
def test_a_sweep_in_the_text(sweep: str, folder: Path) -> None:
    assert run.uncomputed_manifests("pair.toml", studies=cli._studies([sweep]))


def ran(page: str, holding: str) -> dict[str, Any]:
    """What a block of Python leaves."""
    left: dict[str, Any] = {}
    exec(compile(block(page, "python", holding), page, "exec"), left)
    return left


def test_the_python_of_the_readme(folder: Path) -> None:
    left = ran("README.md", "result.summary")
    assert left["grid"]["mean_efficiency"].dims[1:] == ("operation.torque", "gears.face_width")
    assert (folder / "again.html").is_file()


@pytest.mark.whole
def test_films_without_any_gear(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    ran("guide/films.md", "solve_lines")
    assert capsys.readouterr().out.splitlines()[-1].startswith("True ")
    assert (tmp_path / "films.nc").is_file()


@pytest.mark.whole
def test_contacts_of_finite_length(capsys: pytest.CaptureFixture[str]) -> None:
    ran("guide/films.md", "solve_patch")
    told = capsys.readouterr().out
    assert "Code.SOLVED" in told
    assert "not found" not in told
    assert "nan" not in told


@pytest.mark.whole
def test_python(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ran("guide/python.md", "write_report")
    assert (folder / "again.html").stat().st_size > 1_000_000
    out = capsys.readouterr().out
    assert "instantaneous efficiency" in out
    assert str(["teeth", "inspection", "cycle", "operation", "laws", "strength"])[:-1] in out


def test_analyses_of_ones_choice(folder: Path) -> None:
    left = ran("guide/python.md", "analyses=")
    assert set(left["result"].parts) == {"operation", "cycle"}


def test_units_of_ones_choice(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    left = ran("guide/python.md", "plot_in")
    assert left["figure"].layout.yaxis.title.text.endswith("[N cm]")
    assert capsys.readouterr().out.splitlines()[-1] == "N cm"


@pytest.mark.whole
def test_the_parts_of_a_strain_wave_drive_are_those_of_the_text() -> None:
    """What the block reads of them is run beside a drive, in `test_strain_wave_runs`."""
    (told,) = re.findall(r"print\(list\(drive\.parts\)\)\n# (.*)", PAGES["guide/python.md"])
    made = [job.name for job in jobs(Variant(tree("wave"), "README.md", "default"), {})]
    assert told.split(", ") == made
