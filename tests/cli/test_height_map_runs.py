"""Height maps from files that a case names: the same as maps given in Python, resume, report, refusals."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sound import PAIR

from pitchpoint.analyses.analysis_registry import ANALYSES
from pitchpoint.analyses.engagement import course_of
from pitchpoint.analyses.solved_films import FILM_SQUEEZE, FINITE_FILM
from pitchpoint.analyses.whole_contacts import one_contact, whole_contacts
from pitchpoint.cases.height_maps import height_maps
from pitchpoint.errors import InputError
from pitchpoint.lubrication.ehl.patch.heights import HeightMap
from pitchpoint.lubrication.ehl.patch.patch_films import solve_patch
from pitchpoint.lubrication.ehl.patch.plan import placed_contacts
from pitchpoint.runs import run as running
from pitchpoint.runs.run import Outcome, load_case, uncomputed_manifests
from pitchpoint.views.report import report_page

BALL = (Path(__file__).parents[2] / "examples" / "ball_on_disc_film.toml").read_text("utf-8")
STEPS = 'step_along = "20 um"\nstep_across = "25 um"\n'
SPUR = """
[models]
friction = { name = "constant", coefficient = 0.05 }
[film]
solver = "finite_line"
time = "squeeze"
phases = 3
nodes = 33
moments = 3
"""
X = 20e-6 * (np.arange(41) - 20.0)
Y = 25e-6 * (np.arange(33) - 16.0)
WAVES = 0.05 * np.cos(2.0 * np.pi * X / 200e-6) * np.ones((33, 1))
"""Heights [um] of two waves over the contact."""


def written(folder: Path, heights: str, name: str = "rough.toml") -> str:
    path = folder / name
    path.write_text(f"{BALL}nodes = 33\n{heights}", "utf-8")
    return str(path)


def table(name: str, file: str, more: str = "") -> str:
    return f'[film.heights.{name}]\nfile = "{file}"\n{STEPS}{more}'


@pytest.fixture(scope="module", autouse=True)
def alone() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ANALYSES, "_entries", {"finite_film": FINITE_FILM})
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("maps")
    np.savetxt(made / "waves.csv", WAVES, delimiter=",")
    np.savetxt(made / "waves.txt", 1e3 * WAVES)
    np.save(made / "waves.npy", 1e-6 * WAVES)
    return made


@pytest.fixture(scope="module")
def outcome(folder: Path) -> Outcome:
    return running.run_case(written(folder, table("both", "waves.csv")))["default"]


@pytest.mark.whole
@pytest.mark.parametrize(
    ("file", "more"), [("csv", ""), ("txt", 'unit = "1 nm"\n'), ("npy", 'unit = "1 m"\n')]
)
def test_a_file_is_the_map_that_it_holds(folder: Path, file: str, more: str) -> None:
    more += 'middle_along = "0.1 mm"\n'
    built = load_case(written(folder, table("gear_2", f"waves.{file}", more), "one.toml"))
    assert built.case.film is not None
    (found,) = height_maps(built.case.film, moving=True)
    assert found.member == 1 and not found.periodic
    assert np.asarray(found.x) == pytest.approx(X + 1e-4) and np.asarray(found.y) == pytest.approx(
        Y
    )
    assert np.asarray(found.heights) == pytest.approx(1e-6 * WAVES)
    (still,) = height_maps(built.case.film)
    assert still.member is None


@pytest.mark.whole
def test_films_are_those_of_the_same_map_in_python(outcome: Outcome, folder: Path) -> None:
    data = outcome.parts["finite_film"]
    built = load_case(written(folder, "", "plain.toml"))
    plain = one_contact(built, whole_contacts(built).numbers[0, 0, 0])
    given = HeightMap(x=X, y=Y, heights=1e-6 * WAVES)
    rough = type(plain)(**{**vars(plain), "heights": (given,)})
    film = solve_patch(rough, nodes=33, cells=32).film
    assert data["field_film"].values[0] == pytest.approx(film.gap, rel=1e-6)
    assert data["field_heights"].values[0] == pytest.approx(film.heights, abs=1e-15)
    assert np.ptp(data["field_heights"].values) > 5e-8


@pytest.mark.whole
def test_another_content_is_another_run(folder: Path, tmp_path: Path) -> None:
    np.savetxt(folder / "own.csv", WAVES, delimiter=",")
    case = written(folder, table("both", "own.csv"), "own.toml")
    first = running.run_case(case, folder=tmp_path)["default"].parts["finite_film"]
    assert running.run_case(case, folder=tmp_path)["default"].parts["finite_film"].identical(first)
    np.savetxt(folder / "own.csv", 0.5 * WAVES, delimiter=",")
    again = running.run_case(case, folder=tmp_path)["default"].parts["finite_film"]
    half = 0.5 * first["field_heights"].values
    assert again["field_heights"].values == pytest.approx(half, abs=1e-15)


@pytest.mark.whole
def test_the_report_shows_what_the_grid_sees(outcome: Outcome) -> None:
    page = report_page({"default": outcome})
    assert "Roughness seen" in page and "Film and heights along the contact" in page


@pytest.mark.whole
def test_a_map_moves_with_its_surface_under_squeeze(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ANALYSES, "_entries", {"film_squeeze": FILM_SQUEEZE})
    wave = 0.05 * np.cos(2.0 * np.pi * np.arange(41) / 40.0) * np.ones((33, 1))
    np.savetxt(folder / "long.csv", wave, delimiter=",")
    path, heights = folder / "moves.toml", table("gear_1", "long.csv", "periodic = true\n")
    path.write_text(PAIR + SPUR + heights, "utf-8")
    data = running.run_case(str(path))["default"].parts["film_squeeze"]
    assert int(data["solved_moments"]) == int(data["loaded_moments"])
    # Speeds of involutes grow evenly along the path.
    speed = data["entrainment"].values + 0.5 * data["sliding_velocity"].values
    way = np.trapezoid(speed, data["time"].values)
    course = course_of(load_case(str(path)))
    first, last = (placed_contacts(course.contacts, course.times)[k].heights[0] for k in (0, -1))
    assert np.asarray(first.x) == pytest.approx(X)
    assert np.asarray(last.x) - X == pytest.approx(way)
    assert np.ptp(X) < way < 5e-3
    assert np.ptp(data["field_heights"].values[0]) > 1e-8


@pytest.mark.whole
def test_maps_that_take_too_long_to_pass_are_told(folder: Path) -> None:
    case = written(folder, table("gear_1", "waves.csv", "periodic = true\n"), "long.toml")
    with pytest.raises(InputError, match="mm of the surface pass") as caught:
        FILM_SQUEEZE.pieces(load_case(case, settings={"film.time": "squeeze"}))
    assert caught.value.key == "film.heights"


BAD = {
    "missing.csv": (None, "there is no such file of heights in /"),
    "other.dat": ("1 2\n3 4\n", "those end in .csv, .txt, .npy or .x3p"),
    "empty.csv": ("", "holds no heights"),
    "remarks.txt": ("# no more\n", "holds no heights"),
    "words.csv": ("1,2\n3,four\n", "no table of numbers"),
    "comma.csv": ("1,2,\n3,4,\n", "none at the end of a row"),
    "ragged.csv": ("1,2\n3\n", "no table of numbers"),
    "row.csv": ("1,2,3\n", "at least two rows"),
    "nan.csv": ("1,nan\n2,3\n", "one height that is no finite number"),
    "false.npy": ("not an array", "cannot be read as an array"),
}


@pytest.mark.whole
@pytest.mark.parametrize("name", BAD)
def test_files_without_heights_are_told(name: str, folder: Path) -> None:
    content, words = BAD[name]
    if content is not None:
        (folder / name).write_text(content, "utf-8")
    with pytest.raises(InputError, match=words) as caught:
        load_case(written(folder, table("gear_1", name), "bad.toml"))
    assert caught.value.key == "film.heights.gear_1.file"
    assert f'"{name}"' in caught.value.message


@pytest.mark.whole
@pytest.mark.parametrize(
    "settings",
    [
        {"film.heights.both.file": "waves.txt"},
        {"film.heights.both": {"file": "waves.txt", "step_along": "1 um", "step_across": "1 um"}},
    ],
)
def test_files_of_settings_lie_beside_the_case_file(settings: dict[str, Any], folder: Path) -> None:
    case = written(folder, table("both", "waves.csv"), "set.toml")
    film = load_case(case, settings=settings).case.film
    assert film is not None and film.heights is not None and film.heights.both is not None
    assert film.heights.both.file == str((folder / "waves.txt").resolve())


@pytest.mark.whole
def test_a_record_of_another_content_is_told(folder: Path, tmp_path: Path) -> None:
    np.savetxt(folder / "kept.csv", WAVES, delimiter=",")
    (described,) = uncomputed_manifests(written(folder, table("both", "kept.csv"), "kept.toml"))
    (row,) = [row for row in described["inputs"] if row["key"] == "heights.both.digest"]
    assert row["status"] == "derived" and len(row["value"]) == 64
    record = tmp_path / "manifest.json"
    record.write_text(json.dumps(described), "utf-8")
    words = 'The record was made with other heights than "kept.csv" holds now: numbers differ.'
    assert words not in load_warnings(record)
    np.savetxt(folder / "kept.csv", 0.5 * WAVES, delimiter=",")
    assert words in load_warnings(record)
    assert words not in load_warnings(record, {"film.heights.both.file": str(folder / "waves.csv")})


def load_warnings(record: Path, settings: dict[str, Any] | None = None) -> list[str]:
    (again,) = uncomputed_manifests(str(record), settings=settings)
    found: list[str] = again["warnings"]
    return found


@pytest.mark.whole
def test_an_array_of_objects_is_not_read(folder: Path) -> None:
    np.save(folder / "objects.npy", np.array([[{}, {}]], object), allow_pickle=True)
    with pytest.raises(InputError, match="cannot be read as an array"):
        load_case(written(folder, table("both", "objects.npy"), "bad.toml"))


@pytest.mark.whole
@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"film.heights.both.step_along": "2 um"}, "has to cover it"),
        ({"film.heights.both.step_across": "1 mm"}, "takes at least 4"),
    ],
)
def test_maps_that_do_not_fit_the_contact_are_told(
    folder: Path, more: dict[str, Any], words: str
) -> None:
    np.savetxt(folder / "slopes.csv", WAVES * np.linspace(0.0, 1.0, 33)[:, None], delimiter=",")
    case = written(folder, table("both", "slopes.csv"), "misfit.toml")
    with pytest.raises(InputError, match=words) as caught:
        running.run_case(case, settings=more)
    assert caught.value.key == "film.heights"


@pytest.mark.whole
def test_lines_without_ends_take_no_profiles_across(folder: Path) -> None:
    across = table("both", "waves.csv", 'direction = "across"\n')
    with pytest.raises(InputError, match="profiles along the surface speeds") as caught:
        load_case(written(folder, across, "line.toml"), settings={"film.solver": "line"})
    assert caught.value.key == "film.heights.both.direction"
