"""Worn flanks of a case, from a result with wear of the same gears."""

import hashlib
import json
import os
from pathlib import Path

import numpy as np
import xarray as xr

from pitchpoint._jax import array
from pitchpoint.contact.worn import FLATTEST
from pitchpoint.errors import InputError, shorten, visible
from pitchpoint.gears.gears_table import GearsTable
from pitchpoint.gears.mesh import Mesh
from pitchpoint.registry import enumerated
from pitchpoint.results.by_stage import OF_STAGES, of_stage, stages_of
from pitchpoint.results.store import load
from pitchpoint.wear.history import Cells
from pitchpoint.wear.wear_tables import WornTable

__all__ = ["gears_digest", "with_wear"]

_PLACES = ("flank_ends", "across_ends", "contact_span")
_READ = ("worn_depth", "cycles", "conforming", "deepest_wear", "wear_error", *_PLACES)

ROUNDING = 1e-12
"""Part by which turns of the input, as those of a mesh, may be beyond those that a result has."""


def gears_digest(gears: GearsTable) -> str:
    """What tells gears from any others whose flanks wear elsewhere.

    Args:
        gears: as validated.
    """
    return hashlib.sha256(gears.model_dump_json().encode()).hexdigest()[:16]


def with_wear(mesh: Mesh, gears: GearsTable, worn: WornTable) -> tuple[Mesh, str]:
    """A mesh with the flanks that a result has worn, and a sentence on them.

    Depths between two steps of the march are interpolated over the cycles.

    Args:
        mesh: with flanks as new.
        gears: of which it is.
        worn: which result, and how many cycles of it.

    Raises:
        InputError: no result with wear, one of other gears, or of fewer cycles.
    """
    name = visible(shorten(os.path.basename(worn.file)))
    try:
        data = load(Path(worn.file))
    except (InputError, OSError, ValueError):
        raise _wrong(name, "cannot be read as a result; name the wear.nc of one") from None
    if data.attrs.get("title") != "wear":
        raise _wrong(name, "holds no wear; name the wear.nc of a result")
    data = _of_gears(data, gears_digest(gears), worn.stage, name)
    lacking = [one for one in _READ if one not in data]
    if lacking:
        raise _wrong(name, f"lacks {', '.join(lacking)}; compute the wear again with this version")
    cycles = data["cycles"].values
    held = float(cycles[-1])
    turns = held if worn.cycles is None else worn.cycles * worn.of_driver
    if turns > held * (1.0 + ROUNDING):
        warning = (
            f"{worn.cycles:.6g} is beyond the {held / worn.of_driver:.6g} turns that {name} holds; give at "
            "most so many"
        )
        raise InputError(warning, key="worn.cycles")
    turns = min(turns, held)
    depth = data["worn_depth"]
    at = max(int(np.searchsorted(cycles, turns)), 1) if cycles.size > 1 else 0
    part = 0.0 if at == 0 else (turns - cycles[at - 1]) / (cycles[at] - cycles[at - 1])

    def there(values: np.ndarray) -> np.ndarray:
        return np.asarray((1.0 - part) * values[at - 1] + part * values[at] if at else values[0])

    gone, most, error = (
        there(data[one].values) for one in ("worn_depth", "deepest_wear", "wear_error")
    )
    flank, across, span = (array(data[one].values) for one in _PLACES)
    cells = Cells(flank, across, span, depth.shape[2], depth.shape[3])
    cut, deepest, off = (
        " and ".join(f"{1e6 * float(one):.3g}" for one in each)
        for each in (gone.max(axis=(1, 2)), most, error)
    )
    warning = (
        f"Flanks are worn by {turns:.4g} turns of {data.attrs['driver']}: {deepest} um deep at most, within "
        f"{off} um by grid and steps, and {cut} um in the {depth.shape[2]} cells along a flank whose depths "
        "its surfaces have."
    )
    if data["conforming"].values[: at + 1].any():
        warning += (
            f" They conform; their contacts are taken to keep {FLATTEST:g} of the relative curvature they "
            "had, and pressures are a guess."
        )
    # Flanks from which nothing is gone are those as new, to the last bit.
    return cells.worn(mesh, array(gone)) if gone.any() else mesh, warning


def _of_gears(data: xr.Dataset, digest: str, stage: float | None, name: str) -> xr.Dataset:
    """The wear of some gears out of that of one mesh or of several.

    Args:
        data: of a result.
        digest: of the gears.
        stage: number of the stage that is asked for, if any is.
        name: of the file.

    Raises:
        InputError: other gears, or several stages that have them.
    """
    record = json.loads(data.attrs.get(OF_STAGES, "{}"))
    digests = {label: record[str(label)]["attributes"].get("gears") for label in stages_of(data)}
    if not digests and stage is not None:
        message = f'{stage:.0f} was given, and "{name}" has one mesh alone; leave it out'
        raise InputError(message, key="worn.stage")
    if digest not in (data.attrs.get("gears"), *digests.values()):
        raise _wrong(
            name, "holds the wear of other gears: every key of [gears] has to be as it was there"
        )
    if not digests:
        return data
    numbers = {
        label: int(str(label).partition(" ")[0])
        for label, of_label in digests.items()
        if of_label == digest
    }
    chosen = [label for label, number in numbers.items() if stage in (None, number)]
    if len(chosen) != 1:
        is_given = "is missing" if stage is None else f"{stage:.0f} was given"
        allowed = " or ".join(map(str, numbers.values()))
        advice = f"give {allowed}" if len(numbers) > 1 else "leave it out"
        message = (
            f'{is_given}, and "{name}" holds the wear of such gears in stage '
            f"{enumerated(numbers.values())}; {advice}"
        )
        raise InputError(message, key="worn.stage")
    return of_stage(data, chosen[0])


def _wrong(name: str, told: str) -> InputError:
    return InputError(f'"{name}" {told}', key="worn.file")
