"""Results in files for spreadsheets, MATLAB and other programs, with a text that says what is in them."""

import io
import json
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from pitchpoint.errors import InputError, visible
from pitchpoint.exports.evaluator import evaluator
from pitchpoint.exports.result_tables import Sheet, exported, sheets
from pitchpoint.exports.simulators import TARGETS, option_of
from pitchpoint.results.chosen_units import UnitsByKind, shown_in, unit_choice
from pitchpoint.results.store import make_folder, without_nan, write_bytes, write_text
from pitchpoint.runs.run import Outcome
from pitchpoint.views.inputs import recorded_units

__all__ = ["EVALUATOR", "FORMATS", "export"]

EVALUATOR = "evaluator"
"""The format that is no table: the loss map of the output as source, see `exports.evaluator`."""

MOST_ROWS = 1_048_575
"""Rows of a sheet of a spreadsheet, under its head."""

LONGEST_NAME = 31
"""Characters of the name of a sheet."""

README = "README.txt"

_FORMULA = re.compile(r"(^|[;\t\r\n])(?=\s*[=+\-@\uff1d\uff0b\uff0d\uff20])")
"""Where a spreadsheet would begin a formula, also one whose cells end at semicolons or tabs."""

_NOT_IN_XML = re.compile("[\0-\x08\v\f\x0e-\x1f]")

_QUANTITY = re.compile(r"[+-][\d.][\w .,/%+-]*")
"""Numbers with units, which call nothing."""


def export(
    outcomes: Mapping[str, Outcome],
    folder: Path,
    formats: list[str],
    *,
    si: bool = False,
    units: UnitsByKind | None = None,
) -> list[Path]:
    """Write a result in other formats; each variant of several into a folder of its own.

    Args:
        outcomes: by variant.
        folder: where files go.
        formats: of `FORMATS`, and `EVALUATOR`.
        si: True for SI units, else those of report and screen.
        units: by kind of quantity, {"angle": "arcmin"} or "angle=arcmin"; those of the case by default.

    Returns:
        The files.

    Raises:
        InputError: no format, units that there are not, a folder that cannot be written to, a library that
            is missing.
    """
    if si and units is not None:
        raise InputError("SI was asked for, and other units too; give one of --si and --units")
    with shown_in(recorded_units(outcomes) if units is None else unit_choice(units)):
        return _exported(outcomes, folder, formats, si=si)


def _exported(
    outcomes: Mapping[str, Outcome], folder: Path, formats: list[str], *, si: bool
) -> list[Path]:
    if not formats:
        names = (*FORMATS, EVALUATOR, *TARGETS)
        options = ", ".join(map(option_of, names))
        raise InputError(f"no format was given; give one or several of {options}")
    written: list[Path] = []
    for name, outcome in outcomes.items():
        place = folder / name if len(outcomes) > 1 else folder
        make_folder(place)
        if EVALUATOR in formats:
            written += evaluator(outcome, place)
        if wanted := [format_name for format_name in formats if format_name != EVALUATOR]:
            tables = list(sheets(outcome, si=si))
            for format_name in wanted:
                written += FORMATS[format_name](outcome, tables, place, si)
            write_text(place / README, _readme(outcome, tables, si))
            written.append(place / README)
    return written


def _csv(outcome: Outcome, tables: list[Sheet], folder: Path, si: bool) -> list[Path]:
    """A file for each table."""
    paths = [folder / f"{table.name}.csv" for table in tables]
    for path, table in zip(paths, tables, strict=True):
        write_bytes(path, _texts_changed(table.frame, _inert).to_csv(index=False).encode("utf-8"))
    return paths


def _texts_changed(frame: pd.DataFrame, change: Callable[[str], str]) -> pd.DataFrame:
    """The frame with its texts and heads changed; numbers stay as they are."""
    texts = frame.select_dtypes(exclude=["number", "bool"])
    cells = {
        str(name): [change(cell) if isinstance(cell, str) else cell for cell in texts[name]]
        for name in texts
    }
    return frame.assign(**cells).rename(columns=change)


def _inert(text: str) -> str:
    """Text with an apostrophe wherever a spreadsheet would begin a formula."""
    return text if _QUANTITY.fullmatch(text) else _FORMULA.sub(r"\1'", text)


def _xlsx(outcome: Outcome, tables: list[Sheet], folder: Path, si: bool) -> list[Path]:
    """A workbook with a sheet for each table."""
    try:
        import openpyxl  # noqa: F401  # pandas writes through it
    except ImportError:
        sentence = "needs the package openpyxl, which is not installed; install pitchpoint[xlsx]"
        raise InputError(sentence, key="--xlsx") from None
    for table in tables:
        if len(table.frame) > MOST_ROWS:
            sentence = (
                f"{table.name} has {len(table.frame)} rows, more than a sheet holds; take --csv"
            )
            raise InputError(sentence, key="--xlsx")
    image = io.BytesIO()
    readme = pd.DataFrame({README: _readme(outcome, tables, si).splitlines()})
    with pd.ExcelWriter(image, engine="openpyxl") as writer:
        for name, frame in _named(
            {"README": readme, **{sheet.name: sheet.frame for sheet in tables}}
        ):
            held = _texts_changed(frame, _of_xml)
            held.to_excel(writer, sheet_name=name, index=False, freeze_panes=(1, 0))
            for row in writer.sheets[name].iter_rows():
                for cell in row:
                    if cell.data_type in "ef":  # texts that openpyxl takes for errors and formulas
                        cell.data_type = "s"
    write_bytes(folder / "result.xlsx", image.getvalue())
    return [folder / "result.xlsx"]


def _of_xml(text: str) -> str:
    """Text of signs that a workbook can hold."""
    return _NOT_IN_XML.sub(lambda sign: visible(sign[0]), text)


def _named(frames: Mapping[str, pd.DataFrame]) -> list[tuple[str, pd.DataFrame]]:
    """Frames with names that a workbook takes, each once whatever its letters' case."""
    taken: dict[str, pd.DataFrame] = {}
    for name, frame in frames.items():
        short, number = name[:LONGEST_NAME], 1
        while short.lower() in {used_name.lower() for used_name in taken}:
            number += 1
            short = f"{name[: LONGEST_NAME - 1 - len(str(number))]}~{number}"
        taken[short] = frame
    return list(taken.items())


def _json(outcome: Outcome, tables: list[Sheet], folder: Path, si: bool) -> list[Path]:
    """One file with the record of the result and its parts, arrays as nested lists."""
    parts = {name: exported(data, si=si) for name, data in outcome.parts.items()}
    content = {
        "manifest": outcome.manifest,
        "parts": {
            name: {str(variable): _array(data, str(variable)) for variable in data.variables}
            for name, data in parts.items()
        },
    }
    text = json.dumps(without_nan(content), indent=1, ensure_ascii=False, allow_nan=False)
    write_text(folder / "result.json", text)
    return [folder / "result.json"]


def _array(data: xr.Dataset, name: str) -> dict[str, Any]:
    variable = data[name]
    return {
        "long_name": variable.attrs["long_name"],
        "unit": variable.attrs["units"],
        "dims": [str(dim) for dim in variable.dims],
        "values": variable.values.tolist(),
    }


def _mat(outcome: Outcome, tables: list[Sheet], folder: Path, si: bool) -> list[Path]:
    """A file of MATLAB 5 with a struct for each part; `units` and `dims` in it are by variable."""
    from scipy.io import savemat

    content: dict[str, Any] = {"inputs": _cells(tables[0].frame)}
    for part, dataset in outcome.parts.items():
        data = exported(dataset, si=si)
        names = [str(name) for name in data.variables]
        content[part] = {
            **{name: _matlab(data[name].values) for name in names},
            "units": {name: data[name].attrs["units"] for name in names},
            "dims": {name: ", ".join(map(str, data[name].dims)) for name in names},
            "long_names": {name: data[name].attrs["long_name"] for name in names},
        }
    image = io.BytesIO()
    savemat(image, content, long_field_names=True, do_compression=True, oned_as="column")
    write_bytes(folder / "result.mat", image.getvalue())
    return [folder / "result.mat"]


def _matlab(values: np.ndarray) -> np.ndarray:
    """Array as MATLAB has it, texts as cells."""
    return values.astype(object) if values.dtype.kind in "UO" else values


def _cells(frame: pd.DataFrame) -> dict[str, np.ndarray]:
    return {str(name): frame[name].to_numpy(dtype=object) for name in frame.columns}


def _readme(outcome: Outcome, tables: list[Sheet], si: bool) -> str:
    """What was exported, and what stands in every column."""
    manifest = outcome.manifest
    lines = [
        str(manifest["title"]),
        f"Case {manifest['case']}, variant {manifest['variant']}, computed with Pitchpoint "
        f"{manifest['surroundings'].get('pitchpoint', '')}.",
        "Units are SI." if si else "Units are those of the report; --si gives SI.",
        "Values are missing (NaN, null in JSON) where no pair of teeth touches, or where there is none.",
    ]
    lines += [f"Warning: {text}" for text in manifest["warnings"]]
    for table in tables:
        rows = len(table.frame)
        lines += ["", f"{table.name}: {rows} row{'s' * (rows != 1)}"]
        lines += [f"  {column.head}: {column.words}" for column in table.columns]
    return "\n".join(lines) + "\n"


FORMATS: Mapping[str, Callable[[Outcome, list[Sheet], Path, bool], list[Path]]] = {
    "csv": _csv,
    "mat": _mat,
    "json": _json,
    "xlsx": _xlsx,
}
"""How results are written, by name of the format."""
