"""A study on the screen: what its designs reach, and why some have no figures."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.store import without_nan, write_text
from pitchpoint.runs.sensitivity import FIGURES, indices_of_study
from pitchpoint.views import show

__all__ = ["as_plain", "figures_of_many", "indices_of_many", "write_rows"]

_OF_TOLERANCES = ("circumferential_backlash", "output_backlash", "transmission_error_range")
"""Figures that are shown first where tolerances are drawn."""

SHOWN = (
    *_OF_TOLERANCES,
    "kinematic_error_range",
    "mean_efficiency",
    "mean_loss",
    "torque_ripple",
    "min_lambda_ratio",
    "largest_contact_stress",
    "largest_root_stress",
    "least_flank_safety",
    "least_root_safety",
)
"""Figures whose ends over all designs are shown, where they have values."""

_REASONS = 3
"""Most reasons, and most warnings, that are told."""


def _spans(found: xr.Dataset) -> Iterator[tuple[str, str, Sequence[float]]]:
    """Values of figures at `_ends` by law, one of them in memory at a time."""
    by_tolerance = bool(found.attrs.get("tolerances"))
    for name in SHOWN[0 if by_tolerance else len(_OF_TOLERANCES) :]:
        for law in found["law"].values if name in found else ():
            values = np.asarray(found[name].sel(law=law).values)
            values = values[np.isfinite(values)]
            if values.size:
                yield name, str(law), np.quantile(values, [*_ends(found).values()]).tolist()


def _counts(found: xr.Dataset) -> tuple[int, dict[str, int]]:
    """Designs, and how many have no figures by reason."""
    designs = int(np.prod([size for name, size in found["reason"].sizes.items() if name != "law"]))
    return designs, json.loads(found.attrs["reasons"])


def figures_of_many(found: xr.Dataset, folder: Path) -> tuple[list[str], list[dict[str, str]]]:
    """Lines below a table, and its rows.

    Args:
        found: a study in the units in which it is shown.
        folder: of its files.
    """
    rows = [
        {
            "figure": f"{found[name].attrs['long_name']} [{found[name].attrs['units']}]",
            "law": law,
            **{end: f"{value:.5g}" for end, value in zip(_ends(found), span, strict=True)},
        }
        for name, law, span in _spans(found)
    ]
    designs, reasons = _counts(found)
    without = sum(reasons.values())
    told = [f"{designs} designs" + (f", {without} of them without figures:" if without else "")]
    told += [f"  {count}: {why}" for why, count in [*reasons.items()][:_REASONS]]
    if len(reasons) > _REASONS:
        told.append(f"  and {len(reasons) - _REASONS} more reasons, in `reason` of the files")
    files = [f"every design: {folder}", f"report: {folder / 'report.html'}"]
    return [*told, *_doubts(found), *_remarks(found), *files], rows


def _doubts(found: xr.Dataset) -> list[str]:
    """The first warnings that its page has, and how many more there are."""
    every = [str(text) for text in json.loads(str(found.attrs.get("warnings", "[]")))]
    told = [f"Doubtful: {show.pretty(text)}" for text in every[:_REASONS]]
    left = len(every) - len(told)
    return [*told, *[f"  and {left} more warnings, in the report"] * (left > 0)]


def _remarks(found: xr.Dataset) -> list[str]:
    """Sentences on figures that do not follow what changes."""
    return [str(remark) for remark in json.loads(found.attrs.get("remarks", "[]"))]


def _ends(found: xr.Dataset) -> dict[str, float]:
    """Shares of the designs that lie below what is shown: ends of a range, percentiles of tolerances."""
    if found.attrs.get("tolerances"):
        return {"1 %": 0.01, "median": 0.5, "99 %": 0.99}
    return {"least": 0.0, "median": 0.5, "largest": 1.0}


def indices_of_many(found: xr.Dataset) -> tuple[str, list[dict[str, str]]]:
    """Sobol' indices of a study whose designs have some: a line on them, and rows by figure, law and key.

    Args:
        found: a study; no rows where its designs are laid out otherwise.

    Raises:
        InputError: too few of its designs have figures.
    """
    if json.loads(found.attrs["layout"])["how"] != "saltelli":
        return "", []
    indices = indices_of_study(found, FIGURES)
    several = indices.sizes["law"] > 1
    rows = [
        {
            "figure": found[figure].attrs["long_name"],
            **({"law": law} if several else {}),
            "key": key,
            **{
                title: words
                for head, name in (("alone", "first_order"), ("with others", "total_order"))
                for title, words in _bounded(
                    indices.sel(figure=figure, law=law, key=key), head, name
                ).items()
            },
        }
        for figure in indices["figure"].values.tolist()
        for law in indices["law"].values.tolist()
        for key in indices["key"].values.tolist()
    ]
    used, asked = indices.attrs["designs"], indices.attrs["asked"]
    told = f"Sobol' indices, parts of the variance, from {used} of {asked} designs of each sample"
    return f"{told}; 95 of 100 resampled ones lie in the range beside", rows


def _bounded(index: xr.Dataset, head: str, name: str) -> dict[str, str]:
    """An index and its bounds, each a cell that no screen breaks."""
    value, low, high = (float(index[f"{name}{end}"]) for end in ("", "_low", "_high"))
    if np.isnan(value):
        return {head: "does not vary", f"{head}, 95 %": ""}
    return {head: f"{value:.2f}", f"{head}, 95 %": f"{low:.2f} to {high:.2f}"}


def write_rows(found: xr.Dataset, path: Path) -> None:
    """Every design as a row of a CSV file: its keys, friction law and figures, some thousands at a time.

    Args:
        found: a study, in whatever units.
        path: of the file; a reader never sees half of it.
    """
    dims = [str(name) for name in found["reason"].dims if name != "law"]
    sizes = [found.sizes[name] for name in dims]
    text = [""]
    for first in range(0, int(np.prod(sizes)), _ROWS):
        flat = np.arange(first, min(first + _ROWS, int(np.prod(sizes))))
        at = zip(dims, np.unravel_index(flat, sizes), strict=True)
        some = found.isel({name: xr.DataArray(index, dims="row") for name, index in at})
        table = some.assign_coords(row=flat).to_dataframe().reset_index()
        beside = {
            name: f"{name} [{some[name].attrs['units']}]"
            for name in map(str, table.columns)
            if name in some.variables and some[name].attrs.get("units", "1") != "1"
        }
        ordered = [name for name in ("row", "law") if name in table]
        ordered += [name for name in map(str, table.columns) if name not in ordered and "." in name]
        ordered += [name for name in map(str, table.columns) if name not in ordered]
        rows = table[ordered].sort_values([name for name in ("row", "law") if name in table])
        rows = rows.drop(columns=[name for name in ("design",) if name in rows]).rename(
            columns={"row": "design", **beside}
        )
        text.append(rows.to_csv(index=False, header=not first))
    write_text(path, "".join(text))


_ROWS = 4096
"""Designs that are written together."""


def as_plain(found: xr.Dataset, folder: Path) -> dict[str, Any]:
    """The same as JSON has it.

    Args:
        found: a study in SI.
        folder: of its files.
    """
    figures: dict[str, Any] = {}
    for name, law, span in _spans(found):
        entry = figures.setdefault(name, {"unit": found[name].attrs["units"], "by_law": {}})
        entry["by_law"][law] = dict(zip(_ends(found), span, strict=True))
    designs, reasons = _counts(found)
    plain: dict[str, Any] = {"folder": str(folder), "designs": designs, "reasons": reasons}
    plain |= {"figures": figures, "remarks": _remarks(found)}
    if json.loads(found.attrs["layout"])["how"] == "saltelli":
        indices = indices_of_study(found, FIGURES)
        plain["sobol_indices"] = {
            str(figure): {
                str(law): {
                    str(key): {
                        str(name): float(one)
                        for name, one in indices.sel(figure=figure, law=law, key=key).items()
                    }
                    for key in indices["key"].values
                }
                for law in indices["law"].values
            }
            for figure in indices["figure"].values
        }
    return dict(without_nan(plain))
