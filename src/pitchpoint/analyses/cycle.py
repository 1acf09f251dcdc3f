"""The mesh cycle in detail."""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress
from pitchpoint.analyses.caveats import (
    OF_CYCLES,
    AtWork,
    beyond_face,
    demand_convergence,
    demand_motion,
)
from pitchpoint.analyses.plausibility import implausible
from pitchpoint.analyses.summaries import profiles
from pitchpoint.cases.built import Built
from pitchpoint.core.status import Code, locked_or_lost, solve_summary
from pitchpoint.gears.pairs import in_pairs
from pitchpoint.results.store import dataset

__all__ = [
    "CYCLE",
]


def _cycle(built: Built, _: Piece, progress: PieceProgress) -> xr.Dataset:
    runs, names = profiles(built, built.models, progress), built.law_names
    demand_motion(*_jammed(runs), [built], names)
    mesh = built.design.mesh
    demand_convergence(np.stack([run["residual"] for run in runs]), [built], names)
    lanes = ("law", "node", "pair", "slice")
    common = {
        "phase": (("node",), runs[0]["phase"]),
        "weight": (("node",), runs[0]["weight"]),
        "path": (lanes[1:], in_pairs(mesh, runs[0]["path"], 1, like_first=True)),
        "active": (lanes[1:], in_pairs(mesh, runs[0]["active"], 1)),
    }
    stacked = {
        name: np.stack([run[name] for run in runs])
        for name in runs[0]
        if name not in common and not name.startswith("outside")
    }
    by_law = {
        name: (lanes, in_pairs(mesh, values, 2)) if values.ndim == 4 else (lanes[:2], values)
        for name, values in stacked.items()
    }
    at = AtWork(built, built.laws, runs)
    code = locked_or_lost(by_law["locked"][1])
    beyond = np.stack([beyond_face(run) for run in runs])
    code = np.where(beyond & (code == Code.SOLVED), int(Code.BEYOND_FACE), code)
    data = dataset(
        {**common, **by_law},
        {"law": names},
        title="mesh cycle",
        travels=built.travels,
        warnings=[*OF_CYCLES.of(at), *implausible(at)],
        solve=solve_summary(code, by_law["residual"][1]),
        film_law=built.case.models.film_thickness,
        events=built.nominal["events"].tolist(),
    )
    data["path"].attrs.update(built.way)
    return data


def _jammed(
    runs: Sequence[Mapping[str, np.ndarray]],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether friction locks the mesh, and where it is nearest to that its coefficients [law, 1]."""
    names = ("largest_friction", "jamming_coefficient")
    nearest = [int(np.argmax(run[names[0]] / run[names[1]])) for run in runs]
    acting, limit = (
        np.array([[run[name][node]] for run, node in zip(runs, nearest, strict=True)])
        for name in names
    )
    return np.stack([run["locked"].any(keepdims=True) for run in runs]), acting, limit


CYCLE = Analysis(name="cycle", title="mesh cycle", of="mesh", under_load=True, compute=_cycle)
