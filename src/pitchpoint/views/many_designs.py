"""A study on the screen: what its designs reach, and why some have no figures."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from pitchpoint.results.store import without_nan

__all__ = ["as_plain", "figures_of_many"]

SHOWN = (
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


def _spans(found: xr.Dataset) -> Iterator[tuple[str, str, Sequence[float]]]:
    """Least, median and largest value of figures by law, one of them in memory at a time."""
    for name in SHOWN:
        for law in found["law"].values if name in found else ():
            values = np.asarray(found[name].sel(law=law).values)
            values = values[np.isfinite(values)]
            if values.size:
                yield name, str(law), np.quantile(values, [0.0, 0.5, 1.0]).tolist()


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
            **{end: f"{value:.5g}" for end, value in zip(_ENDS, span, strict=True)},
        }
        for name, law, span in _spans(found)
    ]
    designs, reasons = _counts(found)
    without = sum(reasons.values())
    told = [f"{designs} designs" + (f", {without} of them without figures:" if without else "")]
    told += [f"  {count}: {why}" for why, count in [*reasons.items()][:_REASONS]]
    if len(reasons) > _REASONS:
        told.append(f"  and {len(reasons) - _REASONS} more reasons, in `reason` of the files")
    return [*told, f"every design: {folder}"], rows


_ENDS = ("least", "median", "largest")


def as_plain(found: xr.Dataset, folder: Path) -> dict[str, Any]:
    """The same as JSON has it.

    Args:
        found: a study in SI.
        folder: of its files.
    """
    figures: dict[str, Any] = {}
    for name, law, span in _spans(found):
        entry = figures.setdefault(name, {"unit": found[name].attrs["units"], "by_law": {}})
        entry["by_law"][law] = dict(zip(_ENDS, span, strict=True))
    designs, reasons = _counts(found)
    plain = {"folder": str(folder), "designs": designs, "reasons": reasons, "figures": figures}
    return dict(without_nan(plain))
