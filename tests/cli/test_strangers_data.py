"""What came from a stranger stays data, wherever it goes: tables, generated sources, files that it names."""

import ast
import builtins
import errno
import os
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from datetime import date
from decimal import Decimal
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any

import jax
import numpy as np
import openpyxl
import pandas as pd
import pytest
import sound
import xarray as xr

from pitchpoint import Case, cli, double_precision, run, study
from pitchpoint.analyses import main_figures
from pitchpoint.analyses.solved_films import (
    _BY_FILM_LAW,
    _BY_LAW,
    FILM,
    FILM_SQUEEZE,
    FINITE_FILM,
    OVERLAP,
    film_notes,
)
from pitchpoint.cases.document import read_tables
from pitchpoint.cases.height_maps import height_maps
from pitchpoint.cases.record import Manifest, Record
from pitchpoint.core.plain_files import content, digest, digest_of
from pitchpoint.dynamics.energy import relative_closure
from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import evaluator
from pitchpoint.exports.files import export
from pitchpoint.lubrication.ehl.film_tables import FilmTable
from pitchpoint.results import store
from pitchpoint.results.store import load
from pitchpoint.runs.run import Outcome, uncomputed_manifests

FORMULAS = (
    "=cmd|' /C calc'!A0",
    "+1+cmd|' /C calc'!A0",
    "-2+3+cmd|' /C calc'!A0",
    "@SUM(1+1)",
    '\t=HYPERLINK("http://x","y")',
    "  =1+1",
    "\uff1d1+1",
    "sound; =cmd|' /C calc'!A0",
    "two\n=1+1",
    "#REF!",
    "a bell\a",
)
HARMLESS = ("-5 N m", "+0.4, -0.2", "0.4, -0.2", "ISO 21771; 4.2", "a = b")


def manifest(**more: Any) -> dict[str, Any]:
    rows = [
        {
            "table": "gears",
            "key": text,
            "value": text,
            "kind": "",
            "status": "given",
            "where": text,
            "note": text,
        }
        for text in (*FORMULAS, *HARMLESS)
    ]
    return {
        "title": FORMULAS[0],
        "case": FORMULAS[0],
        "variant": "default",
        "surroundings": {},
        "warnings": [*FORMULAS],
        "inputs": rows,
        "lacks": {},
        **more,
    }


def written(folder: Path, outcome: Outcome, *formats: str) -> Path:
    export({"default": outcome}, folder, [*formats])
    return folder


def part() -> xr.Dataset:
    told = {"units": "=1+1", "long_name": "@SUM(1)"}
    return xr.Dataset({"=1+2": (("law",), [-1.5, 2.5], told)}, {"law": ["=1+3", "xu_2007"]})


def test_texts_are_no_formulas_in_tables_of_text(tmp_path: Path) -> None:
    written(tmp_path, Outcome(manifest(), {"own": part()}), "csv")
    inputs = pd.read_csv(tmp_path / "inputs.csv", keep_default_na=False)
    assert [*inputs["where"]][-len(HARMLESS) :] == [*HARMLESS]
    for told, typed in zip(inputs["where"], FORMULAS, strict=False):
        assert told.replace("'", "") == typed.replace("'", "")
        assert (told != typed) == (typed not in ("#REF!", "a bell\a"))
        for separator in ";\t\n":
            cells = told.split(separator)
            assert not any(
                cell.lstrip()[:1] in tuple("=+-@\uff1d") for cell in cells if cell.strip()
            )
    own = pd.read_csv(tmp_path / "own.csv")
    assert [*own.columns] == ["law", "'=1+2 [=1+1]"]
    assert [*own["law"]] == ["'=1+3", "xu_2007"] and [*own.iloc[:, 1]] == [-1.5, 2.5]


def test_texts_are_no_formulas_in_workbooks(tmp_path: Path) -> None:
    book = openpyxl.load_workbook(
        written(tmp_path, Outcome(manifest(), {"own": part()}), "xlsx") / "result.xlsx"
    )
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row]
    assert not {cell.data_type for cell in cells} & {"f", "e"}
    assert {FORMULAS[0], "#REF!", "=1+2 [=1+1]", "a bell\\x07"} <= {cell.value for cell in cells}
    assert [cell.value for cell in book["own"]["B"]][1:] == [-1.5, 2.5]


BREAKING = (
    'x"""\nimport os\nos.system("false")\n"""',
    "x*/ int main(void) { return 7; } /*",
    "x\\",
    "??/\nint x;",
    "\u2028__import__('os')",
)


def loss_map(text: str) -> xr.Dataset:
    """A loss map whose every text is a stranger's."""
    dims = ("law", "output_torque", "output_speed", "temperature")
    losses = np.array([[[[1.0], [2.0]], [[1.0], [2.0]], [[np.inf], [np.nan]]]])
    told = {"units": text}
    return xr.Dataset(
        {
            "mean_loss": (dims, losses),
            "locked": (dims, np.zeros(losses.shape, bool)),
            "largest_holding_torque": ((dims[0], dims[1], dims[3]), np.ones((1, 3, 1))),
            "self_locking": ((dims[0], dims[1], dims[3]), np.zeros((1, 3, 1), bool)),
            **{name: ("law", [0.1]) for name in (*main_figures.ERRORS, "mean_interpolation_error")},
            "mean_input_torque": ((), 1.0, told),
        },
        {
            "law": [text],
            "output_torque": ("output_torque", [-1.0, 0.0, 1.0], told),
            "output_speed": ("output_speed", [0.0, 1.0], told),
            "temperature": [313.15],
        },
        {"note": text, "version": text, "fingerprint": text, "speed_ratio": 0.5},
    )


def calls(path: Path) -> list[str]:
    return sorted(
        ast.unparse(one.func)
        for one in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(one, ast.Call)
    )


@pytest.mark.parametrize("text", BREAKING)
def test_nothing_from_a_result_runs_in_a_generated_source(tmp_path: Path, text: str) -> None:
    for folder, typed in (("plain", "plain"), ("own", text)):
        (tmp_path / folder).mkdir()
        told = manifest(title=typed, case=typed, variant=typed)
        evaluator(Outcome(told, {"four_quadrants": loss_map(typed)}), tmp_path / folder)
    plain, own = (tmp_path / folder / "loss_table.py" for folder in ("plain", "own"))
    assert calls(own) == calls(plain)
    assert [type(one) for one in ast.parse(own.read_text("utf-8")).body] == [
        type(one) for one in ast.parse(plain.read_text("utf-8")).body
    ]
    held: dict[str, Any] = {"__name__": "loss_table", "__builtins__": vars(builtins)}
    exec(compile(own.read_text("utf-8"), "loss_table.py", "exec"), held)
    assert held["ABOUT"]["title"] == text and held["at"](-1.0, 1.0, 40.0).loss == 2.0
    header = own.with_suffix(".h").read_text("utf-8")
    assert header.isascii() and header.count("*/") == header.count("/*") and "??" not in header
    if gcc := shutil.which("gcc"):
        (tmp_path / "use.c").write_text('#include "own/loss_table.h"\n', "utf-8")
        strict = ("-std=c99", "-Wall", "-Werror", "-Wno-unused", "-pedantic", "-fsyntax-only")
        subprocess.run([gcc, *strict, "use.c"], cwd=tmp_path, check=True, timeout=60)


def test_a_map_that_lacks_a_part_is_refused(tmp_path: Path) -> None:
    for name in ("mean_loss", "locked", "interpolation_error", "self_locking"):
        lacking = loss_map("x").drop_vars(name)
        with pytest.raises(InputError, match="run the case again"):
            evaluator(Outcome(manifest(), {"four_quadrants": lacking}), tmp_path)
    for few in ([0], [0, 2]):
        with pytest.raises(InputError, match="run the case again"):
            other = loss_map("x").isel(output_torque=few)
            evaluator(Outcome(manifest(), {"four_quadrants": other}), tmp_path)


@pytest.fixture
def endless(tmp_path: Path) -> dict[str, Path]:
    """Names behind which there is no end, or far too much, by what they are."""
    os.mkfifo(tmp_path / "pipe.csv")
    os.symlink("/dev/zero", tmp_path / "zero.csv")
    with (tmp_path / "large.csv").open("wb") as file:
        file.truncate(10**12)
    (tmp_path / "folder.csv").mkdir()
    names = ("pipe", "zero", "large", "folder", "none")
    return {name: tmp_path / f"{name}.csv" for name in names}


REASONS = {
    "pipe": "is a pipe or a device; give a file",
    "zero": "is a pipe or a device; give a file",
    "large": "has 1e+06 MB; a file has at most 64 MB",
    "folder": "is a folder; give a file",
    "none": "there is no such file",
}


def test_no_file_is_read_that_has_no_end(endless: dict[str, Path]) -> None:
    for name, path in endless.items():
        for reader in (content, digest):
            with pytest.raises(InputError) as caught:
                reader(path, 64_000_000)
            assert caught.value.message == REASONS[name]
    sound = endless["none"].with_name("sound")
    sound.write_bytes(b"heights")
    assert content(sound, 7) == b"heights" and digest(sound, 7) == sha256(b"heights").hexdigest()
    with pytest.raises(InputError, match="at most"):
        content(sound, 6)
    if Path("/proc/self/maps").exists():  # of which the system tells no size
        with pytest.raises(InputError, match="at most"):
            digest(Path("/proc/self/maps"), 100)


@pytest.mark.parametrize("name", REASONS)
def test_every_door_for_files_asks_whether_they_end(
    endless: dict[str, Path], name: str, tmp_path: Path
) -> None:
    path = endless[name]
    assert digest_of(str(path)) == ""
    for reader in (read_tables, load, Manifest.read, Record.read):
        with pytest.raises(InputError):
            reader(path)
    table = {"file": str(path), "step_along": "1 um", "step_across": "1 um"}
    film = FilmTable.model_validate({"solver": "elliptic", "heights": {"both": table}})
    with pytest.raises(InputError, match="file of heights") as caught:
        height_maps(film)
    assert caught.value.key == "film.heights.both.file"


def test_small_types_of_numbers_stay_small(tmp_path: Path) -> None:
    np.save(tmp_path / "bytes.npy", np.zeros((4001, 4000), np.int8))
    np.save(tmp_path / "sound.npy", np.full((40, 30), -7, np.int8))
    lying = (tmp_path / "sound.npy").read_bytes().replace(b"(40, 30)", b"(9999,9)")
    (tmp_path / "lies.npy").write_bytes(lying)

    def read_as(name: str) -> np.ndarray:
        table = {"file": str(tmp_path / name), "step_along": "1 um", "step_across": "1 um"}
        film = {"solver": "elliptic", "heights": {"both": table}}
        return np.asarray(height_maps(FilmTable.model_validate(film))[0].heights)

    with pytest.raises(InputError, match=r"holds 16.004 million heights; .* at most 16 million"):
        read_as("bytes.npy")
    with pytest.raises(InputError, match="cannot be read as an array"):
        read_as("lies.npy")
    assert read_as("sound.npy").dtype == float and (read_as("sound.npy") == -7.0 * 1e-6).all()


OVERLAYS = {
    "{ value = 3 }": "variants.a: 3 was given where a table belongs",
    "{ value = [1], status = 'given' }": "was given where a table belongs",
    "3": "variants.a: 3 was given where a table belongs",
    "{ value = 3, roughness = {} }": "value: is not a known key",
    "{ roughness = { value = 3 } }": "roughness",
}


@pytest.mark.parametrize("overlay", OVERLAYS)
def test_a_variant_is_a_table_behind_its_mark(overlay: str, tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    path.write_text(f"{sound.PAIR}[variants]\na = {overlay}\n", "utf-8")
    with pytest.raises(InputError) as caught:
        uncomputed_manifests(str(path))
    assert OVERLAYS[overlay] in str(caught.value).splitlines()[0]


def test_a_variant_may_carry_a_mark(tmp_path: Path) -> None:
    path = tmp_path / "pair.toml"
    path.write_text(
        f'{sound.PAIR}[variants]\na = {{ value = {{ roughness = {{ ra = "1 um" }} }}, note = "x" }}\n'
    )
    (described,) = uncomputed_manifests(str(path))
    (row,) = [
        row for row in described["inputs"] if (row["table"], row["key"]) == ("roughness", "ra")
    ]
    assert row["value"] == [1e-6, 1e-6]
    path.write_text("value = 3\n", "utf-8")
    with pytest.raises(InputError, match="value: is not a known key"):
        uncomputed_manifests(str(path))


NAMES = (".", "", "_", "~", "/", "..", "-", "%", "\u202e", "*", "\x1b[2J", "x" * 300)


@pytest.mark.parametrize("command", ["new", "docs", "models", "cite", "open", "show", "export"])
def test_names_without_a_letter_are_no_names(
    command: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in NAMES:
        monkeypatch.setattr(
            sys, "argv", ["pitchpoint", command, name, *["--csv"] * (command == "export")]
        )
        with pytest.raises(SystemExit) as ended:
            cli.main()
        told = capsys.readouterr()
        assert ended.value.code == 2 and not told.out, name
        assert told.err.startswith("error: ") and told.err.count("\n") == 1, name


@pytest.mark.parametrize("name", ["", " ", "-", "\x1b[2J", "\u202esun", "x" * 41])
def test_names_of_bodies_are_names(name: str) -> None:
    path = Path(__file__).parents[2] / "examples" / "three_k.toml"
    train = tomllib.loads(path.read_text("utf-8"))
    with pytest.raises(InputError, match=r"train.carrier: .* is not a name; use 1 to 40 signs"):
        uncomputed_manifests(Case({**train, "train": {**train["train"], "carrier": name}}))
    train["stages"][0]["bodies"][0] = name
    with pytest.raises(InputError, match=r"stages.1.bodies.*: .* is not a name; use 1 to 40 signs"):
        uncomputed_manifests(Case(train))


def nested(levels: int) -> Any:
    table: Any = 1.0
    for level in range(levels):
        table = {"a": table} if level % 2 else [table]
    return table


def holding_itself() -> dict[str, Any]:
    table: dict[str, Any] = {}
    table["a"] = [table]
    return table


def many_from_few() -> list[Any]:
    """A list of twelve levels that would hold 10^12 numbers."""
    held: list[Any] = [1.0] * 10
    for _ in range(11):
        held = [held] * 10
    return held


class Unreadable:
    """What raises whatever is asked of it."""

    def tolist(self) -> None:
        raise RuntimeError

    def __repr__(self) -> str:
        raise RuntimeError


VALUES: dict[str, Any] = {
    "a number of 400 digits": 10**400,
    "a number of 5000 digits": -(10**5000),
    "a fraction": Fraction(1, 3),
    "a decimal": Decimal("1.5"),
    "a day": date(2024, 1, 31),
    "bytes": b"50 N m",
    "a complex number": 1j,
    "complex numbers": np.array([1j, 2j]),
    "objects": np.array([object()]),
    "what raises": Unreadable(),
    "a set": {1, 2},
    "a function": len,
    "no text": "\udc80",
    "a table that holds itself": holding_itself(),
    "3000 levels": nested(3000),
    "100000 levels": nested(100_000),
    "few lists that are many": many_from_few(),
    "keys that are no texts": {(1, 2): 3.0},
}
PAIR = tomllib.loads(sound.PAIR)
DOORS: dict[str, Callable[[Any], Any]] = {
    "a value": lambda value: uncomputed_manifests(
        Case({**PAIR, "gears": {**PAIR["gears"], "module": value}})
    ),
    "a table": lambda value: uncomputed_manifests(Case({**PAIR, "roughness": value})),
    "a variant": lambda value: uncomputed_manifests(Case({**PAIR, "variants": {"a": value}})),
    "a case": lambda value: uncomputed_manifests(Case(value)),
    "set": lambda value: Case(PAIR).set(torque=value),
    "set a table": lambda value: uncomputed_manifests(Case(PAIR).set(roughness=value)),
    "settings": lambda value: run(PAIR, settings={"operation.torque": value}, analyses=["none"]),
    "study": lambda value: study(PAIR, {"torque": [1.0, value]}),
    "a file": lambda value: uncomputed_manifests(value),
}


@pytest.mark.parametrize("what", VALUES)
def test_what_python_hands_over_is_told_in_a_sentence(what: str) -> None:
    for door, taken in DOORS.items():
        with pytest.raises(InputError) as caught:
            taken(VALUES[what])
        assert all(len(line) < 600 for line in str(caught.value).splitlines()), door
        assert str(caught.value).isprintable() or "\n" in str(caught.value)


ARGUMENTS: dict[str, Callable[[], Any]] = {
    "n: .* a whole number from 1 on": lambda: study(PAIR, {"torque": [1.0, 2.0]}, n="2"),  # type: ignore[arg-type]
    "seed: -1 .* from 0 on": lambda: study(PAIR, {"torque": [1.0, 2.0]}, seed=-1),
    "variant: 1 was given where the name": lambda: study(PAIR, {"torque": [1.0]}, variant=1),  # type: ignore[arg-type]
    "over: .* a dictionary": lambda: study(PAIR, ["torque"]),  # type: ignore[arg-type]
    "how: .* name of a way": lambda: study(PAIR, {"torque": [1.0]}, how={}),  # type: ignore[arg-type]
    "was given as units": lambda: study(PAIR, {"torque": [1.0]}, units=[]),  # type: ignore[arg-type]
    "variant: 1 was": lambda: Case(PAIR, variant=1),  # type: ignore[arg-type]
    "only: .* a list of names": lambda: run(PAIR, only="default"),
    'analyses: .* a list of names of parts, \\["operation"': lambda: run(PAIR, analyses=7),  # type: ignore[arg-type]
    "settings: .* by key": lambda: run(PAIR, settings=[1]),  # type: ignore[arg-type]
    "studies: .* by name": lambda: run(PAIR, studies={"a": 1}),  # type: ignore[dict-item]
    "friction: .* a function": lambda: run(PAIR, friction=0.05),  # type: ignore[arg-type]
    "folder: .* name of a folder": lambda: run(PAIR, folder="a\0b"),
    "changes: .* by key": lambda: Case(PAIR).set(7),  # type: ignore[arg-type]
    "key: 7 was given where a key": lambda: Case(PAIR)[7],  # type: ignore[index]
    "key: None was given": lambda: Case(PAIR)[None],  # type: ignore[index]
}


@pytest.mark.parametrize("told", ARGUMENTS)
def test_arguments_of_another_kind_are_told_by_name(told: str) -> None:
    with pytest.raises(InputError, match=told):
        ARGUMENTS[told]()


def test_values_of_other_libraries_are_numbers_still() -> None:
    case = Case(PAIR)
    for value in (np.float32(7.0), np.longdouble(7.0), np.array(7.0), np.int64(7), "7 N m"):
        assert case.set(torque=value)["operation.torque"] == 7.0
    assert case.set({"gears.teeth": np.array([20, 50])})["gears.teeth"] == (20.0, 50.0)
    assert case.set({"gears.teeth": range(20, 22)})["gears.teeth"] == (20.0, 21.0)


def test_a_balance_without_numbers_is_none() -> None:
    part, none = np.array([3.0, -1.0]), np.array([np.nan, np.nan])
    closure = jax.jit(relative_closure)
    with double_precision():
        assert float(closure(part, np.stack([part, 2.0 * part]))) == 0.5
        assert np.isnan(float(closure(none, np.stack([none, none]))))
        assert np.isnan(float(closure(none, np.stack([part, none]))))


@pytest.mark.parametrize("lowest", [-2e-8, 3e-8])
def test_films_below_zero_are_told_to_machines_too(lowest: float) -> None:
    film = xr.Dataset({"smallest_film": lowest})
    assert film_notes(film) == [OVERLAP] * (lowest < 0.0)
    laws = {
        name: (axis, [0.0])
        for axis, names in (("law", _BY_LAW), ("film_law", _BY_FILM_LAW))
        for name in names
    }
    numbers = dict.fromkeys({*FILM.main, *FILM_SQUEEZE.main} - {"smallest_film"}, 1.0)
    data = film.assign({**numbers, **laws}).assign_coords(law=["a"], film_law=["b"])
    for analysis in (FILM, FINITE_FILM, FILM_SQUEEZE):
        (told,) = analysis.shown({analysis.name: data}).values()
        assert told["smallest_film"] == lowest and told["notes"] == film_notes(film)


def ended(monkeypatch: pytest.MonkeyPatch, *command: str) -> int:
    monkeypatch.setattr(sys, "argv", ["pitchpoint", *command])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    return int(str(caught.value.code))


def test_nothing_is_written_through_a_link(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    for command in (["new", "spur"], ["schema"]):
        assert ended(monkeypatch, *command, "-o", str(tmp_path / "link")) == 2
        assert capsys.readouterr().err.endswith("link: is there already; give another name\n")
    assert not (tmp_path / "nowhere").exists()
    assert ended(monkeypatch, "new", "spur", "-o", str(tmp_path / "new.toml")) == 0


def test_a_full_disk_claims_what_is_kept_of_datasets_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(descriptor: int, mode: str) -> None:
        os.close(descriptor)
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(store.os, "fdopen", full)
    for write in (store.write_text, lambda path, text: store.write_bytes(path, text.encode())):
        with pytest.raises(OSError, match=r"\] No space left on device: '.*one'$"):
            write(tmp_path / "one", "text")
    with pytest.raises(OSError, match="device; what was finished before is kept and found again"):
        store.save(xr.Dataset({"a": 1.0}), tmp_path / "one")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("number", "words"),
    [("1e400", "is too large"), ("-1e400", "is too")],
)
def test_numbers_beyond_all_numbers_are_told_as_written(
    number: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "pair.toml"
    path.write_text(sound.PAIR.replace("[23, 61]", f"[{number}, 61]"), "utf-8")
    settings = {"gears.teeth": cli._value(f"[{number}, 61]")}
    for case, changes in ((str(path), {}), (PAIR, settings)):
        with pytest.raises(InputError, match=f'gears.teeth: "{number}" {words}'):
            uncomputed_manifests(case, settings=changes)
    assert cli._value("[1e308, 0.0e9, 1e-300, inf]") == [1e308, 0.0, 1e-300, np.inf]
