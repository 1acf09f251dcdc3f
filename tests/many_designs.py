"""Studies whose figures are closed forms and take no time, for tests of what is shown of them."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import pitchpoint as pp
from pitchpoint.analyses.design_batch import CaseDesigns

__all__ = ["KEYS", "RANGES", "quick_study"]

KEYS = ["operation.torque", "operation.speed", "gears.face_width"]
RANGES = {
    KEYS[0]: ("20 N m", "90 N m"),
    KEYS[1]: ("500 rpm", "3000 rpm"),
    KEYS[2]: ("9 mm", "30 mm"),
}

_FIGURES = {
    "mean_efficiency": ("1", "mean efficiency"),
    "mean_loss": ("W", "mean power loss"),
    "largest_root_stress": ("Pa", "largest root stress of the teeth"),
    "min_lambda_ratio": ("1", "smallest film over composite Rq"),
    "centre_distance": ("m", "centre distance"),
}


def _computed(self: CaseDesigns, progress: Any = None) -> xr.Dataset:
    """Loss and film that are at odds over the speed; designs of wide gears at low torque have no figures."""
    rows = [[float(str(value).split()[0]) for value in one.values()] for one in self.changes]
    torque, speed, width = np.array(rows).T
    loss = 0.01 * torque * speed + np.sqrt(torque)
    values = {
        "mean_efficiency": 1.0 - loss / (torque * speed),
        "mean_loss": loss,
        "largest_root_stress": 1e5 * torque / width,
        "min_lambda_ratio": 0.1 * np.sqrt(speed) * (1.0 + width),
        "centre_distance": np.full(len(torque), 0.084),
    }
    without = (width > 0.027) & (torque < 40.0)
    laws = {"iso_tr_14179_2": 1.0, "xu_2007": 2.0}
    data: dict[str, Any] = {}
    for name, row in values.items():
        unit, words = _FIGURES[name]
        by_law = [row * (factor if name == "mean_loss" else 1.0) for factor in laws.values()]
        shown = np.where(without, np.nan, np.stack(by_law))
        data[name] = (("law", "point"), shown, {"units": unit, "long_name": words})
    shape = (len(laws), len(torque))
    data["residual"] = (("law", "point"), np.zeros(shape))
    data["iterations"] = (("law", "point"), np.ones(shape, int))
    data["locked"] = (("law", "point"), np.zeros(shape, bool))
    why = np.where(without, 'the <wide> gear & its "mate" meet', "")
    data["reason"] = (("law", "point"), np.broadcast_to(why, shape).copy())
    attributes = {"solve": '{"residual": 0.0, "iterations": 1}'}
    return xr.Dataset(data, {"law": [*laws]}, attributes)


def quick_study(patch: pytest.MonkeyPatch, how: str = "sobol", **options: Any) -> xr.Dataset:
    """A study of closed forms over three keys, in the units in which it is shown."""
    patch.setattr(CaseDesigns, "compute", _computed)
    over = options.pop("over", RANGES)
    return pp.study("tian2024", over, how, variant="physical", units="shown", **options)
