"""Teeth drawn to scale."""

import numpy as np
import xarray as xr

from pitchpoint._jax import jax
from pitchpoint.analyses.analysis import Analysis, Piece, PieceProgress
from pitchpoint.cases.built import Built
from pitchpoint.core.programs import program
from pitchpoint.gears.mesh_bodies import drawing
from pitchpoint.results.store import dataset

__all__ = ["TEETH", "drawing_of"]


def _teeth(built: Built, _: Piece, __: PieceProgress) -> xr.Dataset:
    """What a drawing of the teeth to scale needs."""
    numbers = drawing_of(built)
    dims, labels = built.family.drawing, built.family.coordinates
    data = {name: (dims.get(name) or _dims(name, v), v) for name, v in numbers.items()}
    used = {name for axes, _ in data.values() for name in axes}
    drawn = dataset(data, {k: v for k, v in labels.items() if k in used}, title="teeth")
    if "points" in drawn:
        drawn["points"].attrs.update(built.way)
    return drawn


def drawing_of(built: Built) -> dict[str, np.ndarray]:
    """Arrays of a drawing of the teeth, by name; empty where there are none."""
    arrays: dict[str, np.ndarray] = jax.device_get(_drawing(built.design.mesh))
    return arrays


def _dims(name: str, values: np.ndarray) -> tuple[str, ...]:
    """Dimensions of an array that the family does not name: two values are those of two gears."""
    if np.shape(values) == (2,):
        return ("gear",)
    return tuple(f"{name}_{axis}" for axis in range(np.ndim(values)))


_drawing = program(drawing)


def _undrawn(built: Built) -> str | None:
    return None if drawing_of(built) else "there are no teeth to draw"


TEETH = Analysis(name="teeth", title="teeth", of="mesh", lacks=_undrawn, compute=_teeth)
