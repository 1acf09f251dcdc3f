"""The case file beside a result: every given value with its mark, and the same case when it is read again."""

from pathlib import Path

import pytest

from pitchpoint.cases.document import Document, read_tables, resolve, variants
from pitchpoint.cases.handed_over import FILES, as_toml, write_case_copy
from pitchpoint.cases.library import case_names, find_case
from pitchpoint.cases.record import CASE, RUN, Record, default_folder
from pitchpoint.cases.study_tables import Study, Sweep
from pitchpoint.cases.validation import validate

EXAMPLES = Path(__file__).parents[2] / "examples"
CASES = [*case_names(), *map(str, sorted(EXAMPLES.glob("*.toml")))]


def again(text: str, folder: Path) -> Document:
    (folder / CASE).write_text(text, "utf-8")
    return resolve(read_tables(folder / CASE), name=CASE, variant="default")


@pytest.mark.parametrize("case", CASES, ids=lambda case: Path(case).stem)
def test_a_case_is_the_same_when_it_is_read_again(case: str, tmp_path: Path) -> None:
    name, tree = find_case(case)
    for variant in variants(tree):
        document = resolve(tree, name=name, variant=variant)
        other = again(as_toml(document), tmp_path)
        assert validate(other) == validate(document)
        assert dict(other.provenance) == dict(document.provenance)


def test_settings_and_studies_stand_in_it(tmp_path: Path) -> None:
    name, tree = find_case(str(EXAMPLES / "two_stage.toml"))
    settings = {"operation.torque": "150 N m", "stages.2.gears.profile_shift.1": 0.5}
    document = resolve(tree, name=name, variant="default", settings=settings)
    sweep = Sweep(key="operation.speed", start="500 rpm", stop="1500 rpm", count=3.0)
    text = as_toml(document, title="named", studies={"fast": Study(sweep=sweep)})
    assert 'torque = {value = "150 N m", status = "set"}' in text
    assert text.count("[[stages]]") == 2
    case = validate(again(text, tmp_path))
    assert case.operation.torque == 150.0
    assert case.stages["2"].gears.profile_shift == (0.5, 0.0)
    assert case.studies["fast"].sweep == sweep
    assert case.title == "Two-stage spur drive"  # its own goes before the one that stands in for it


def test_files_that_a_case_names_lie_beside_it(tmp_path: Path) -> None:
    for place in ("a", "b"):
        (tmp_path / place).mkdir()
        (tmp_path / place / "map.csv").write_text(place)
    tree = read_tables(EXAMPLES / "ball_on_disc_film.toml")
    step = {"step_along": "1 um", "step_across": "1 um"}
    tree["film"]["heights"] = {
        f"gear_{number}": {"file": str(tmp_path / place / "map.csv"), **step}
        for number, place in ((1, "a"), (2, "b"))
    }
    document = resolve(tree, name="x", variant="default")
    write_case_copy(document, tmp_path / "out")
    (tmp_path / "out").rename(tmp_path / "moved")
    case = validate(resolve(read_tables(tmp_path / "moved" / CASE), name=CASE, variant="default"))
    files = [Path(getattr(case.film.heights, f"gear_{number}").file) for number in (1, 2)]
    assert [path.read_text() for path in files] == ["a", "b"]
    assert {path.parent for path in files} == {(tmp_path / "moved" / FILES).resolve()}


def test_default_folders_do_not_collide(tmp_path: Path) -> None:
    pair = tmp_path / "pair.toml"
    pair.touch()
    root = tmp_path / "results"
    cold, warm = ({"operation.temperature": f"{degrees} degC"} for degrees in (20, 80))
    taken = {}
    for settings in ({}, cold, warm, {"a": "x" * 200}, {"a": "x" * 199 + "y"}, {"a": "1/2"}):
        folder = default_folder(str(pair), root, settings)
        assert folder not in taken
        folder.mkdir(parents=True)
        Record.of(str(pair), pair.name, folder, ["default"], settings).write(folder)
        taken[folder] = settings
    assert [default_folder(str(pair), root, settings) for settings in taken.values()] == [*taken]
    assert (root / "pair+operation.temperature=20_degC") in taken


def test_a_result_stays_that_of_its_case_when_it_is_run_again(tmp_path: Path) -> None:
    out = tmp_path / "out"
    (out / "default").mkdir(parents=True)
    Record(case="pair.toml", file="../pair.toml", variants=["default"]).write(out)
    assert default_folder(str(out), tmp_path / "results") == out
    kept = Record.of(str(out), "", out, ["default"], {"operation.torque": "7 N m"})
    assert (kept.case, kept.file) == ("pair.toml", "../pair.toml")
    assert kept.settings == {"operation.torque": "7 N m"}
    assert Record.read(out / RUN).settings == {}
    apart = default_folder(str(out / "default" / CASE), tmp_path / "results")
    assert apart == tmp_path / "results" / "out-default"
