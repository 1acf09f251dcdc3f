"""The way of a pair through the mesh, in the coordinate that its family gave to the places of contacts."""

from typing import Any

import numpy as np
import xarray as xr

__all__ = ["at_origin", "carrying_or_next", "places_on_axis"]


def places_on_axis(data: xr.Dataset) -> np.ndarray:
    """Place of each contact in the unit of the axis along the way."""
    return np.asarray(float(data["path"].attrs["scale"]) * data["path"].values)


def at_origin() -> dict[str, Any]:
    """Line at the origin of the way."""
    return {
        "type": "line",
        "x0": 0,
        "x1": 0,
        "yref": "paper",
        "y0": 0,
        "y1": 1,
        "layer": "below",
        "line": {"color": "#b4bec5", "width": 1, "dash": "dot"},
    }


def carrying_or_next(carries: np.ndarray) -> np.ndarray:
    """True for places that carry and for their neighbours, in order."""
    wide = carries.copy()
    wide[1:] |= carries[:-1]
    wide[:-1] |= carries[1:]
    return wide
