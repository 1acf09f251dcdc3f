"""What came from a stranger stays data, wherever it goes: into tables, into generated sources, to the screen."""

import ast
import builtins
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import openpyxl
import pandas as pd
import pytest
import xarray as xr

from pitchpoint.errors import InputError
from pitchpoint.exports.evaluator import evaluator
from pitchpoint.exports.files import export
from pitchpoint.runs.run import Outcome

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
    losses = np.array([[[[1.0], [2.0]], [[np.inf], [np.nan]]]])
    told = {"units": text}
    return xr.Dataset(
        {
            "mean_loss": (dims, losses),
            "locked": (dims, np.zeros(losses.shape, bool)),
            "interpolation_error": ("law", [0.1]),
            "mean_interpolation_error": ("law", [0.1]),
            "mean_input_torque": ((), 1.0, told),
        },
        {
            "law": [text],
            "output_torque": ("output_torque", [-1.0, 1.0], told),
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
    for name in ("mean_loss", "locked", "interpolation_error"):
        lacking = loss_map("x").drop_vars(name)
        with pytest.raises(InputError, match="run the case again"):
            evaluator(Outcome(manifest(), {"four_quadrants": lacking}), tmp_path)
